//! A drawing as PNG: `tiny-skia` fills the shapes, and the letters come from a font that is compiled in. The fonts of
//! the machine are never read, so that a picture has the same letters everywhere.

use std::sync::LazyLock;

use tiny_skia::{
    Color, FillRule, FilterQuality, Paint, Path, PathBuilder, Pattern, Pixmap, Rect, SpreadMode, Stroke,
    Transform,
};

use crate::colour::Colour;
use crate::drawing::{Anchor, Drawing, LETTERS, Mark, POLYGON_EDGE};
use crate::letters::Letters;
use crate::png;

/// Pixels of the PNG per pixel of the page, along either side. CHOICE: at 2 thin lines and letters read well in print.
const PIXELS_PER_PAGE_PIXEL: u32 = 2;

static FONT: LazyLock<Letters> = LazyLock::new(|| Letters::new(epaint_default_fonts::UBUNTU_LIGHT));

/// Width of a line of text on a page, pixels, in the font of the PNG.
pub fn text_width(text: &str) -> f64 {
    let (_, width) = FONT.line(text, LETTERS as f32);
    width.into()
}

impl Drawing {
    /// The page as PNG, two of its pixels for each of the page along either side.
    pub fn png(&self) -> Vec<u8> {
        let scale = PIXELS_PER_PAGE_PIXEL;
        let mut pixels =
            Pixmap::new(scale * self.width, scale * self.height).expect("a page of at least one pixel");
        pixels.fill(Color::WHITE);
        let page = Transform::from_scale(scale as f32, scale as f32);
        for mark in &self.marks {
            paint(mark, page, &mut pixels);
        }
        // Every page has a white background, so that no pixel is transparent.
        let colours: Vec<u8> =
            pixels.pixels().iter().flat_map(|pixel| [pixel.red(), pixel.green(), pixel.blue()]).collect();
        png::rgb(pixels.width(), pixels.height(), &colours)
    }

    /// [`Self::png`] as an address that holds the picture itself, for a page.
    pub fn data_uri(&self) -> String {
        png::data_uri(&self.png())
    }
}

/// Paints one mark over those before it.
fn paint(mark: &Mark, page: Transform, pixels: &mut Pixmap) {
    match mark {
        Mark::Polygon { points, fill, edge } => {
            let Some(path) = path(points, true) else { return };
            pixels.fill_path(&path, &ink(*fill), FillRule::Winding, page, None);
            if let Some(edge) = edge {
                pixels.stroke_path(&path, &ink(*edge), &stroke(POLYGON_EDGE), page, None);
            }
        }
        Mark::Line { points, colour, width } => {
            let Some(path) = path(points, false) else { return };
            pixels.stroke_path(&path, &ink(*colour), &stroke(*width), page, None);
        }
        Mark::Text { at, text, anchor, colour, turn } => {
            let (letters, width) = FONT.line(text, LETTERS as f32);
            let Some(letters) = letters else { return };
            let before = match anchor {
                Anchor::Start => 0.0,
                Anchor::Middle => width / 2.0,
                Anchor::End => width,
            };
            let [x, y] = at.map(place);
            let line = page.pre_translate(x, y).pre_concat(Transform::from_rotate(place(*turn)));
            let line = line.pre_translate(-before, 0.0);
            pixels.fill_path(&letters, &ink(*colour), FillRule::Winding, line, None);
        }
        Mark::Cells { at, size, columns, cells } => {
            let rows = cells.len() / (*columns).max(1);
            let Some(mut picture) = Pixmap::new(*columns as u32, rows as u32) else { return };
            for (pixel, cell) in picture.pixels_mut().iter_mut().zip(cells) {
                if let Some([r, g, b]) = *cell {
                    *pixel = tiny_skia::ColorU8::from_rgba(r, g, b, u8::MAX).premultiply();
                }
            }
            let ([x, y], [width, height]) = (at.map(place), size.map(place));
            let Some(whole) = Rect::from_xywh(0.0, 0.0, *columns as f32, rows as f32) else { return };
            let cells_of_page =
                page.pre_translate(x, y).pre_scale(width / *columns as f32, height / rows as f32);
            let shader = Pattern::new(
                picture.as_ref(),
                SpreadMode::Pad,
                FilterQuality::Nearest,
                1.0,
                Transform::identity(),
            );
            let paint = Paint { shader, anti_alias: false, ..Paint::default() };
            pixels.fill_rect(whole, &paint, cells_of_page, None);
        }
    }
}

/// A place on the page as the SVG writes it, with one decimal, so that both pictures are the same.
fn place(value: f64) -> f32 {
    ((value * 10.0).round() / 10.0) as f32
}

/// A path through points; nothing if they are fewer than two.
fn path(points: &[[f64; 2]], closed: bool) -> Option<Path> {
    let mut path = PathBuilder::new();
    for (index, point) in points.iter().enumerate() {
        let [x, y] = point.map(place);
        if index == 0 {
            path.move_to(x, y);
        } else {
            path.line_to(x, y);
        }
    }
    if closed {
        path.close();
    }
    path.finish()
}

/// An opaque colour, with smooth edges.
fn ink([r, g, b]: Colour) -> Paint<'static> {
    let mut paint = Paint::default();
    paint.set_color_rgba8(r, g, b, u8::MAX);
    paint
}

/// A line of this width, pixels of the page; the rest is as in SVG.
fn stroke(width: f64) -> Stroke {
    Stroke { width: width as f32, ..Stroke::default() }
}
