//! Marks as pixels: polygons row by row on a canvas of twice the size, of which four pixels become one.

use super::drawing::{Anchor, Colour, Mark, PAPER};
use super::letters::{COLUMNS, ROWS, letter};

/// Pixels of the canvas to one of the page, along either side.
const FINE: f64 = 2.0;

/// A page under way.
pub(super) struct Canvas {
    width: usize,
    height: usize,
    pixels: Vec<Colour>,
}

impl Canvas {
    pub(super) fn new(width: u32, height: u32) -> Self {
        let (width, height) = (2 * width as usize, 2 * height as usize);
        Self { width, height, pixels: vec![PAPER; width * height] }
    }

    pub(super) fn draw(&mut self, mark: &Mark) {
        match mark {
            Mark::Polygon { points, fill, edge } => {
                self.fill(points, *fill);
                if let Some(edge) = edge {
                    let closed: Vec<_> = points.iter().chain(points.first()).copied().collect();
                    self.line(&closed, *edge, 0.5);
                }
            }
            Mark::Line { points, colour, width } => self.line(points, *colour, *width),
            Mark::Text { at, text, anchor, colour } => self.text(*at, text, *anchor, *colour),
            Mark::Cells { at: [x, y], size: [w, h], columns, cells } => {
                let rows = cells.len() / (*columns).max(1);
                let (dx, dy) = (w / *columns as f64, h / rows.max(1) as f64);
                for (index, colour) in cells.iter().enumerate() {
                    let Some(colour) = colour else { continue };
                    let (i, j) = ((index % columns) as f64, (index / columns) as f64);
                    self.rectangle(
                        [x + i * dx, y + j * dy],
                        [x + (i + 1.0) * dx, y + (j + 1.0) * dy],
                        *colour,
                    );
                }
            }
        }
    }

    /// Canvas pixels whose middles lie in a rectangle.
    fn rectangle(&mut self, low: [f64; 2], high: [f64; 2], colour: Colour) {
        let bound = |value: f64, most: usize| ((FINE * value - 0.5).ceil().max(0.0) as usize).min(most);
        let (left, right) = (bound(low[0], self.width), bound(high[0], self.width));
        for row in bound(low[1], self.height)..bound(high[1], self.height) {
            self.pixels[row * self.width + left.min(right)..row * self.width + right].fill(colour);
        }
    }

    /// Even-odd: the pixels whose middles lie inside.
    fn fill(&mut self, points: &[[f64; 2]], colour: Colour) {
        let fine: Vec<[f64; 2]> = points.iter().map(|[x, y]| [FINE * x, FINE * y]).collect();
        let low = fine.iter().fold(f64::INFINITY, |low, point| low.min(point[1]));
        let high = fine.iter().fold(f64::NEG_INFINITY, |high, point| high.max(point[1]));
        let first = (low - 0.5).ceil().max(0.0) as usize;
        let last = ((high - 0.5).floor().max(-1.0) as i64 + 1).max(0) as usize;
        for row in first..last.min(self.height) {
            let y = row as f64 + 0.5;
            let mut crossings: Vec<f64> = (0..fine.len())
                .filter_map(|k| {
                    let ([x0, y0], [x1, y1]) = (fine[k], fine[(k + 1) % fine.len()]);
                    ((y0 <= y) != (y1 <= y)).then(|| x0 + (x1 - x0) * ((y - y0) / (y1 - y0)))
                })
                .collect();
            crossings.sort_by(f64::total_cmp);
            for pair in crossings.chunks_exact(2) {
                let bound = |x: f64| ((x - 0.5).ceil().max(0.0) as usize).min(self.width);
                let (left, right) = (bound(pair[0]), bound(pair[1]));
                if left < right {
                    self.pixels[row * self.width + left..row * self.width + right].fill(colour);
                }
            }
        }
    }

    /// Each piece as a rectangle, at least a canvas pixel wide.
    fn line(&mut self, points: &[[f64; 2]], colour: Colour, width: f64) {
        let half = 0.5 * width.max(1.0 / FINE) + 0.05;
        for pair in points.windows(2) {
            let ([x0, y0], [x1, y1]) = (pair[0], pair[1]);
            let length = libm::hypot(x1 - x0, y1 - y0);
            if length == 0.0 {
                continue;
            }
            let (u, v) = ((x1 - x0) / length * half, (y1 - y0) / length * half);
            self.fill(
                &[
                    [x0 - u - v, y0 - v + u],
                    [x1 + u - v, y1 + v + u],
                    [x1 + u + v, y1 + v - u],
                    [x0 - u + v, y0 - v - u],
                ],
                colour,
            );
        }
    }

    /// Letters of five by seven dots; all are capitals. The place is the left, middle or right of the line they stand on.
    fn text(&mut self, [x, y]: [f64; 2], text: &str, anchor: Anchor, colour: Colour) {
        const DOT: f64 = 1.25;
        let advance = DOT * (COLUMNS as f64 + 1.0);
        let length = advance * text.chars().count() as f64 - DOT;
        let left = match anchor {
            Anchor::Start => x,
            Anchor::Middle => x - 0.5 * length,
            Anchor::End => x - length,
        };
        for (index, character) in text.chars().enumerate() {
            for (row, bits) in letter(character).iter().enumerate() {
                for column in (0..COLUMNS).filter(|column| bits >> (COLUMNS - 1 - column) & 1 == 1) {
                    let across = left + advance * index as f64 + DOT * column as f64;
                    let down = y - DOT * (ROWS - row) as f64;
                    self.rectangle([across, down], [across + DOT, down + DOT], colour);
                }
            }
        }
    }

    /// Four pixels to one.
    pub(super) fn png(&self) -> Vec<u8> {
        let (width, height) = (self.width / 2, self.height / 2);
        let mut out = Vec::with_capacity(3 * width * height);
        for j in 0..height {
            for i in 0..width {
                let at = |di: usize, dj: usize| self.pixels[(2 * j + dj) * self.width + 2 * i + di];
                let four = [at(0, 0), at(1, 0), at(0, 1), at(1, 1)];
                for part in 0..3 {
                    let sum: u32 = four.iter().map(|pixel| u32::from(pixel[part])).sum();
                    out.push(((sum + 2) / 4) as u8);
                }
            }
        }
        encode(width as u32, height as u32, png::ColorType::Rgb, &out)
    }
}

/// A picture as PNG, cells without a colour transparent.
pub(super) fn png(columns: u32, cells: &[Option<Colour>]) -> Vec<u8> {
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
    use crate::drive::drawing::{Drawing, INK};

    /// The pixels of a page.
    fn pixels(drawing: &Drawing) -> (usize, Vec<Colour>) {
        let bytes = drawing.png();
        let mut reader = png::Decoder::new(std::io::Cursor::new(&bytes)).read_info().unwrap();
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        let info = reader.next_frame(&mut pixels).unwrap();
        (info.width as usize, pixels.chunks_exact(3).map(|part| part.try_into().unwrap()).collect())
    }

    #[test]
    fn a_polygon_covers_its_pixels_and_half_covers_others() {
        let mut drawing = Drawing::new(10, 8, "a square");
        // From (2, 1) to (5.5, 4): pixels 2 to 4 wholly, 5 by half.
        drawing.polygon(vec![[2.0, 1.0], [5.5, 1.0], [5.5, 4.0], [2.0, 4.0]], [0, 0, 0], None);
        let (width, pixels) = pixels(&drawing);
        let at = |i: usize, j: usize| pixels[j * width + i];
        assert_eq!((at(2, 1), at(4, 3)), ([0; 3], [0; 3]));
        assert_eq!((at(1, 1), at(2, 4), at(6, 2)), (PAPER, PAPER, PAPER));
        assert_eq!(at(5, 2), [128; 3]);
    }

    #[test]
    fn letters_stand_on_their_line_and_cells_may_be_open() {
        let mut drawing = Drawing::new(40, 20, "a letter");
        drawing.text([20.0, 15.0], "1", Anchor::Middle, INK);
        drawing.marks.push(Mark::Cells {
            at: [0.0, 0.0],
            size: [4.0, 2.0],
            columns: 2,
            cells: vec![Some([9, 9, 9]), None],
        });
        let (width, pixels) = pixels(&drawing);
        let dark = |i: usize, j: usize| pixels[j * width + i] != PAPER;
        assert!((0..40).any(|i| (7..15).any(|j| dark(i, j))));
        assert!((0..40).all(|i| (15..20).all(|j| !dark(i, j))));
        assert_eq!((pixels[0], pixels[3]), ([9; 3], PAPER));
    }
}
