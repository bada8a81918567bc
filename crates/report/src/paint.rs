//! SVG as PNG, by `resvg`, with the font that is compiled in: the fonts of the machine are never read, so that a picture
//! has the same letters everywhere.

use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::fontdb::{Database, Source};
use resvg::usvg::{Options, Tree};
use std::sync::{Arc, LazyLock};

use crate::colour::Colour;

/// Pixels to one of the page, along either side. CHOICE: thin lines and letters read well when printed.
const FINE: u32 = 2;

/// What `FONTS` of a drawing begins with.
const FONT: &[u8] = epaint_default_fonts::UBUNTU_LIGHT;

static FONTS: LazyLock<Arc<Database>> = LazyLock::new(|| {
    let mut fonts = Database::new();
    fonts.load_font_source(Source::Binary(Arc::new(FONT)));
    Arc::new(fonts)
});

/// A page of this size as PNG.
///
/// # Panics
/// If this is no SVG: a fault of `drawing`, which wrote it.
pub fn page(svg: &str, width: u32, height: u32) -> Vec<u8> {
    let options = Options { fontdb: Arc::clone(&FONTS), ..Options::default() };
    let tree = Tree::from_str(svg, &options).expect("a page as SVG");
    let mut pixels = Pixmap::new(FINE * width, FINE * height).expect("a page of at least one pixel");
    resvg::render(&tree, Transform::from_scale(FINE as f32, FINE as f32), &mut pixels.as_mut());
    // Every page has a ground, so nothing of it is transparent.
    let colours: Vec<u8> =
        pixels.pixels().iter().flat_map(|pixel| [pixel.red(), pixel.green(), pixel.blue()]).collect();
    encode(pixels.width(), pixels.height(), png::ColorType::Rgb, &colours)
}

/// A picture as PNG, cells without a colour transparent.
pub fn cells(columns: u32, cells: &[Option<Colour>]) -> Vec<u8> {
    let rows = (cells.len() / columns.max(1) as usize) as u32;
    let bytes: Vec<u8> =
        cells.iter().flat_map(|cell| cell.map_or([0; 4], |[r, g, b]| [r, g, b, 0xff])).collect();
    encode(columns, rows, png::ColorType::Rgba, &bytes)
}

/// Encoding into memory cannot fail once sizes match.
fn encode(width: u32, height: u32, colour: png::ColorType, bytes: &[u8]) -> Vec<u8> {
    let mut out = Vec::new();
    let mut encoder = png::Encoder::new(&mut out, width, height);
    encoder.set_color(colour);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(png::Compression::Balanced);
    let mut writer = encoder.write_header().expect("a picture of at least one cell");
    writer.write_image_data(bytes).expect("as many cells as the picture has");
    writer.finish().expect("writing to memory");
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drawing::{Anchor, Drawing, INK, Mark};

    const PAPER: Colour = [255; 3];

    /// The pixels of a page, two for each of its own.
    fn pixels(drawing: &Drawing) -> (usize, Vec<Colour>) {
        let bytes = drawing.png();
        let mut reader = png::Decoder::new(std::io::Cursor::new(&bytes)).read_info().unwrap();
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        let info = reader.next_frame(&mut pixels).unwrap();
        (info.width as usize, pixels.chunks_exact(3).map(|part| part.try_into().unwrap()).collect())
    }

    #[test]
    fn a_polygon_covers_its_pixels() {
        let mut drawing = Drawing::new(10, 8, "a square");
        drawing.polygon(vec![[2.0, 1.0], [5.0, 1.0], [5.0, 4.0], [2.0, 4.0]], [0, 0, 0], None);
        let (width, pixels) = pixels(&drawing);
        assert_eq!((width, pixels.len()), (20, 20 * 16));
        let at = |i: usize, j: usize| pixels[j * width + i];
        assert_eq!((at(4, 2), at(9, 7)), ([0; 3], [0; 3]));
        assert_eq!((at(3, 2), at(10, 7), at(9, 8)), (PAPER, PAPER, PAPER));
    }

    #[test]
    fn letters_come_from_the_font_and_stand_on_their_line() {
        let dark = |text: &str| {
            let mut drawing = Drawing::new(40, 20, "a letter");
            drawing.text([20.0, 15.0], text, Anchor::Middle, INK);
            let (width, pixels) = pixels(&drawing);
            let dark = pixels.iter().enumerate().filter(|(_, pixel)| **pixel != PAPER);
            dark.map(|(index, _)| (index % width, index / width)).collect::<Vec<_>>()
        };
        let (capital, small) = (dark("X"), dark("x"));
        assert!(small.len() > 10 && capital.len() > small.len());
        // A letter is some 9 high, and a minus sign and a sign for times are in the font.
        assert!(capital.iter().all(|&(i, j)| (26..54).contains(&i) && (8..=30).contains(&j)), "{capital:?}");
        assert!(!dark("\u{2212}").is_empty() && dark("\u{2212}") != dark("\u{d7}"));
    }

    #[test]
    fn cells_have_sharp_borders_and_may_be_open() {
        let mut drawing = Drawing::new(4, 2, "two cells");
        let cells = vec![Some([9, 9, 9]), None];
        drawing.marks.push(Mark::Cells { at: [0.0, 0.0], size: [4.0, 2.0], columns: 2, cells });
        let (width, pixels) = pixels(&drawing);
        for row in pixels.chunks_exact(width) {
            assert_eq!((&row[..4], &row[4..]), (&[[9; 3]; 4][..], &[PAPER; 4][..]));
        }
    }
}
