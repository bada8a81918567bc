//! Drawings as PNG: polygons, letters, cells.

use raypencil_report::{Anchor, Colour, Drawing, INK, Mark};

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
