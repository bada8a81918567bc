//! Maps as pictures: colour maps, reduction, PNG.
//!
//! A picture is indexed. It has 253 colours of a colour map, one colour for a hit on one side only, and one transparent
//! index for no hit, through which the page's hatching shows.

use colorous::Gradient;
use raypencil_scene::{Image, Maybe};

use crate::colour::{Colour, css_hex};
use crate::png;
use crate::scale::Scale;

/// Number of colours of a colour map. It is odd, so that the middle of a symmetric scale has a colour of its own.
const COLOURS: u8 = 253;

/// Index of a cell that only one side hits.
const ONE_SIDED: u8 = 254;

/// Index of a cell without a hit; it is transparent.
const NO_HIT: u8 = 255;

/// Colour of [`ONE_SIDED`]; neither colour map has it.
const ONE_SIDED_COLOUR: Colour = [0xff, 0x00, 0xe6];

/// A perceptual colour map.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ColourMap {
    /// For ranges: viridis, dark for small values and bright for large ones.
    Sequential,
    /// For signed differences: blue below zero, near white at zero, red above.
    Diverging,
}

impl ColourMap {
    /// The colour at a place from 0 to 1.
    pub fn at(self, place: f64) -> Colour {
        const SEQUENTIAL: Gradient = colorous::VIRIDIS;
        const DIVERGING: Gradient = colorous::RED_BLUE;
        let colour = match self {
            Self::Sequential => SEQUENTIAL.eval_continuous(place),
            Self::Diverging => DIVERGING.eval_continuous(1.0 - place),
        };
        [colour.r, colour.g, colour.b]
    }

    /// The whole map as a CSS gradient from left to right.
    pub fn css(self) -> String {
        const STOPS: u32 = 32;
        let stops: Vec<String> =
            (0..=STOPS).map(|stop| css_hex(self.at(f64::from(stop) / f64::from(STOPS)))).collect();
        format!("linear-gradient(to right,{})", stops.join(","))
    }
}

/// Columns and rows of a map that become one cell of a picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Reduction {
    /// Columns of the map per column of the picture.
    pub columns: u32,
    /// Rows of the map per row of the picture.
    pub rows: u32,
}

impl Reduction {
    /// The smallest reduction by which a map of this size has at most `max_side` columns and rows.
    ///
    /// ```
    /// use raypencil_report::Reduction;
    ///
    /// // Two columns become one: 1280 / 2 = 640 are at most 1024. The 720 rows stay.
    /// let reduction = Reduction::to_fit(1280, 720, 1024);
    /// assert_eq!(reduction, Reduction { columns: 2, rows: 1 });
    /// assert_eq!(reduction.size_of(1280, 720), (640, 720));
    /// ```
    pub fn to_fit(width: u32, height: u32, max_side: u32) -> Self {
        Self { columns: width.div_ceil(max_side), rows: height.div_ceil(max_side) }
    }

    /// Columns and rows of the picture of a map of this size.
    pub fn size_of(self, width: u32, height: u32) -> (u32, u32) {
        (width.div_ceil(self.columns), height.div_ceil(self.rows))
    }
}

/// One map as a picture.
///
/// ```
/// use raypencil_report::{Picture, Reduction, Scale};
/// use raypencil_scene::{Image, Maybe};
///
/// // Ranges of 1 and 3 m and a miss; the two rows become one.
/// let cells = [Some(1.0), Some(3.0), None, None, None, None].map(Maybe::from);
/// let map = Image::from_cells(3, 2, cells.to_vec());
/// let scale = Scale::of_ranges(map.cells().iter().filter_map(|cell| cell.get())).expect("two values");
/// let picture = Picture::of_map(&map, scale, Reduction { columns: 1, rows: 2 });
/// assert_eq!((picture.width, picture.height), (3, 1));
/// // "iVBOR" is how every PNG begins in base64.
/// assert!(picture.data_uri().starts_with("data:image/png;base64,iVBOR"));
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Picture {
    /// Columns of the picture, after its reduction.
    pub width: u32,
    /// Rows of the picture, after its reduction.
    pub height: u32,
    /// The picture as the bytes of a PNG file.
    pub png: Vec<u8>,
}

impl Picture {
    /// A range map. Each block of cells is drawn as its middle cell.
    pub fn of_map(map: &Image<Maybe<f64>>, scale: Scale, reduction: Reduction) -> Self {
        let Reduction { columns, rows } = reduction;
        Self::draw(map.width(), map.height(), reduction, ColourMap::Sequential, |i, j| {
            let (i, j) = ((i + columns / 2).min(map.width() - 1), (j + rows / 2).min(map.height() - 1));
            map.at(i, j).get().map_or(NO_HIT, |value| index(scale.fraction(value)))
        })
    }

    /// A map of light. Each block of cells is drawn as its brightest cell, so that no lit cell is lost.
    pub fn of_light(map: &Image<Maybe<f64>>, scale: Scale, reduction: Reduction) -> Self {
        let (width, height) = (map.width(), map.height());
        Self::draw(width, height, reduction, ColourMap::Sequential, |left, top| {
            let rows = top..(top + reduction.rows).min(height);
            let cells = rows.flat_map(|j| (left..(left + reduction.columns).min(width)).map(move |i| (i, j)));
            let brightest = cells.filter_map(|(i, j)| map.at(i, j).get()).reduce(f64::max);
            brightest.map_or(NO_HIT, |value| index(scale.fraction(value)))
        })
    }

    /// A map of signed differences. Each block of cells is drawn as the cell that differs most, so that no difference
    /// is lost. A cell that is `one_sided`, a hit on one side only, differs more than any value.
    pub fn of_differences(
        differences: &Image<Maybe<f64>>,
        one_sided: impl Fn(u32, u32) -> bool,
        scale: Scale,
        reduction: Reduction,
    ) -> Self {
        Self::farthest(differences, one_sided, scale, reduction, ColourMap::Diverging)
    }

    /// A map of absolute differences, drawn as [`Picture::of_differences`] does, on a sequential colour map.
    pub fn of_errors(
        errors: &Image<Maybe<f64>>,
        one_sided: impl Fn(u32, u32) -> bool,
        scale: Scale,
        reduction: Reduction,
    ) -> Self {
        Self::farthest(errors, one_sided, scale, reduction, ColourMap::Sequential)
    }

    /// Draws each block as its value that is farthest from zero.
    fn farthest(
        values: &Image<Maybe<f64>>,
        one_sided: impl Fn(u32, u32) -> bool,
        scale: Scale,
        reduction: Reduction,
        colours: ColourMap,
    ) -> Self {
        let (width, height) = (values.width(), values.height());
        Self::draw(width, height, reduction, colours, |left, top| {
            let mut worst: Option<f64> = None;
            for j in top..(top + reduction.rows).min(height) {
                for i in left..(left + reduction.columns).min(width) {
                    if one_sided(i, j) {
                        return ONE_SIDED;
                    }
                    if let Some(value) = values.at(i, j).get()
                        && worst.is_none_or(|worst| value.abs() > worst.abs())
                    {
                        worst = Some(value);
                    }
                }
            }
            worst.map_or(NO_HIT, |value| index(scale.fraction(value)))
        })
    }

    /// Draws each block by its index, which `index` gives for its top left cell.
    fn draw(
        width: u32,
        height: u32,
        reduction: Reduction,
        colours: ColourMap,
        index: impl Fn(u32, u32) -> u8,
    ) -> Self {
        let (drawn_width, drawn_height) = reduction.size_of(width, height);
        let cells: Vec<u8> = (0..drawn_height)
            .flat_map(|j| (0..drawn_width).map(move |i| (i, j)))
            .map(|(i, j)| index(i * reduction.columns, j * reduction.rows))
            .collect();
        let png = png::indexed(drawn_width, drawn_height, &cells, palette(colours), NO_HIT);
        Self { width: drawn_width, height: drawn_height, png }
    }

    /// The picture as a `data:` address, which holds its PNG.
    pub fn data_uri(&self) -> String {
        png::data_uri(&self.png)
    }
}

/// Colour index of a place from 0 to 1.
fn index(place: f64) -> u8 {
    (place * f64::from(COLOURS - 1)).round() as u8
}

/// Colours of all indices, three bytes a colour.
fn palette(colours: ColourMap) -> Vec<u8> {
    let mut palette = Vec::with_capacity(3 * 256);
    for colour in 0..COLOURS {
        palette.extend(colours.at(f64::from(colour) / f64::from(COLOURS - 1)));
    }
    palette.extend([0; 3]);
    palette.extend(ONE_SIDED_COLOUR);
    palette.extend([0x80; 3]);
    palette
}
