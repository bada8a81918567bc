//! Letters as outlines: one line of text in one font. (OpenType specification 1.9, tables `hmtx`, `GPOS`)

use tiny_skia::{Path, PathBuilder, Transform};
use ttf_parser::gpos::{PairAdjustment, PositioningSubtable};
use ttf_parser::opentype_layout::LayoutTable;
use ttf_parser::{Face, GlyphId, OutlineBuilder, Tag};

/// A font.
pub(crate) struct Letters {
    face: Face<'static>,
}

impl Letters {
    /// The font in these bytes of a TrueType file.
    ///
    /// # Panics
    /// If the bytes are no font: they are compiled in.
    pub(crate) fn new(bytes: &'static [u8]) -> Self {
        Self { face: Face::parse(bytes, 0).expect("a font") }
    }

    /// The outlines of a line of text whose letters are `size` pixels high (the em), from (0, 0) to the right along the
    /// base line, y down; and its width in pixels. There are no outlines if the text is blank.
    ///
    /// A letter that the font lacks is drawn as the font's sign for it, an empty frame.
    pub(crate) fn line(&self, text: &str, size: f32) -> (Option<Path>, f32) {
        let scale = size / f32::from(self.face.units_per_em());
        let mut outlines = Outlines::default();
        let mut before: Option<GlyphId> = None;
        // Where the next letter begins, units of the font.
        let mut x = 0.0;
        for letter in text.chars() {
            let glyph = self.face.glyph_index(letter).unwrap_or_default();
            x += before.map_or(0.0, |before| f32::from(self.kerning(before, glyph)));
            outlines.x = x;
            self.face.outline_glyph(glyph, &mut outlines);
            x += f32::from(self.face.glyph_hor_advance(glyph).unwrap_or_default());
            before = Some(glyph);
        }
        let path =
            outlines.path.finish().and_then(|path| path.transform(Transform::from_scale(scale, -scale)));
        (path, x * scale)
    }

    /// How much farther apart than their widths say two neighbouring letters stand, units of the font; below zero where
    /// they fit into each other, as in `AV`.
    fn kerning(&self, left: GlyphId, right: GlyphId) -> i16 {
        let Some(table) = self.face.tables().gpos else { return 0 };
        // The first entry for the pair counts. (OpenType, `GPOS` lookup type 2)
        pair_adjustments(table).find_map(|pairs| advance(&pairs, left, right)).unwrap_or(0)
    }
}

/// The tables of pairs of the feature `kern`.
fn pair_adjustments<'a>(table: LayoutTable<'a>) -> impl Iterator<Item = PairAdjustment<'a>> {
    let kern = table.features.find(Tag::from_bytes(b"kern"));
    let lookups = kern.into_iter().flat_map(|feature| feature.lookup_indices);
    lookups.filter_map(move |index| table.lookups.get(index)).flat_map(|lookup| {
        lookup.subtables.into_iter::<PositioningSubtable<'a>>().filter_map(|subtable| match subtable {
            PositioningSubtable::Pair(pairs) => Some(pairs),
            _ => None,
        })
    })
}

/// What one table says of a pair, if it says anything.
fn advance(pairs: &PairAdjustment<'_>, left: GlyphId, right: GlyphId) -> Option<i16> {
    let row = pairs.coverage().get(left)?;
    let (first, _) = match pairs {
        PairAdjustment::Format1 { sets, .. } => sets.get(row)?.get(right)?,
        PairAdjustment::Format2 { classes, matrix, .. } => {
            matrix.get((classes.0.get(left), classes.1.get(right)))?
        }
    };
    Some(first.x_advance)
}

/// Outlines of letters one after another, in units of the font, y up.
#[derive(Default)]
struct Outlines {
    path: PathBuilder,
    /// Where the present letter begins.
    x: f32,
}

impl OutlineBuilder for Outlines {
    fn move_to(&mut self, x: f32, y: f32) {
        self.path.move_to(self.x + x, y);
    }

    fn line_to(&mut self, x: f32, y: f32) {
        self.path.line_to(self.x + x, y);
    }

    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        self.path.quad_to(self.x + x1, y1, self.x + x, y);
    }

    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        self.path.cubic_to(self.x + x1, y1, self.x + x2, y2, self.x + x, y);
    }

    fn close(&mut self) {
        self.path.close();
    }
}
