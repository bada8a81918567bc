//! A page of marks, written as SVG; its PNG is that SVG, drawn by `paint`.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;

use crate::colour::Colour;
use crate::paint;
use crate::text::escaped;

pub const INK: Colour = [29, 31, 34];

pub const SOFT: Colour = [110, 115, 122];

/// The fonts of all text: first the one that `paint` carries along, then what readers of the SVG may have.
const FONTS: &str = "Ubuntu, 'Noto Sans', 'DejaVu Sans', Helvetica, Arial, sans-serif";

/// Where a text hangs on its place.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Anchor {
    Start,
    Middle,
    End,
}

/// A mark on the page; places are pixels from its upper left corner.
#[derive(Debug, Clone, PartialEq)]
pub enum Mark {
    Polygon {
        points: Vec<[f64; 2]>,
        fill: Colour,
        edge: Option<Colour>,
    },
    Line {
        points: Vec<[f64; 2]>,
        colour: Colour,
        width: f64,
    },
    Text {
        at: [f64; 2],
        text: String,
        anchor: Anchor,
        colour: Colour,
        /// About its place, clockwise, degrees.
        turn: f64,
    },
    /// A picture of `columns` cells to a row, each a rectangle of its own colour; without one it shows what is below.
    Cells {
        at: [f64; 2],
        size: [f64; 2],
        columns: usize,
        cells: Vec<Option<Colour>>,
    },
}

/// Height of letters, pixels.
pub const LETTERS: f64 = 13.0;

/// A page.
#[derive(Debug, Clone, PartialEq)]
pub struct Drawing {
    pub width: u32,
    pub height: u32,
    pub title: String,
    pub marks: Vec<Mark>,
}

impl Drawing {
    pub fn new(width: u32, height: u32, title: &str) -> Self {
        Self { width, height, title: title.to_string(), marks: Vec::new() }
    }

    pub fn polygon(&mut self, points: Vec<[f64; 2]>, fill: Colour, edge: Option<Colour>) {
        self.marks.push(Mark::Polygon { points, fill, edge });
    }

    pub fn line(&mut self, points: Vec<[f64; 2]>, colour: Colour, width: f64) {
        self.marks.push(Mark::Line { points, colour, width });
    }

    pub fn text(&mut self, at: [f64; 2], text: impl Into<String>, anchor: Anchor, colour: Colour) {
        self.turned_text(at, text, anchor, colour, 0.0);
    }

    /// A text that is turned about its place, clockwise, degrees.
    pub fn turned_text(
        &mut self,
        at: [f64; 2],
        text: impl Into<String>,
        anchor: Anchor,
        colour: Colour,
        turn: f64,
    ) {
        self.marks.push(Mark::Text { at, text: text.into(), anchor, colour, turn });
    }

    /// The page as SVG that refers to nothing outside of it.
    pub fn svg(&self) -> String {
        let (width, height, title) = (self.width, self.height, escaped(&self.title));
        let mut out = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" width=\"{width}\" \
             height=\"{height}\" role=\"img\" aria-label=\"{title}\" font-family=\"{FONTS}\" font-size=\"{LETTERS}\">\n<title>{title}</title>\n\
             <rect width=\"{width}\" height=\"{height}\" fill=\"#ffffff\"/>\n"
        );
        for mark in &self.marks {
            match mark {
                Mark::Polygon { points, fill, edge } => {
                    let edge = edge.map_or(String::new(), |edge| {
                        format!(" stroke=\"{}\" stroke-width=\"0.5\"", hex(edge))
                    });
                    out += &format!("<path d=\"{}z\" fill=\"{}\"{edge}/>\n", path(points), hex(*fill));
                }
                Mark::Line { points, colour, width } => {
                    out += &format!(
                        "<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{width}\"/>\n",
                        path(points),
                        hex(*colour)
                    );
                }
                Mark::Text { at: [x, y], text, anchor, colour, turn } => {
                    let anchor = match anchor {
                        Anchor::Start => "start",
                        Anchor::Middle => "middle",
                        Anchor::End => "end",
                    };
                    let turn = if *turn == 0.0 {
                        String::new()
                    } else {
                        format!(" transform=\"rotate({turn:.1} {x:.1} {y:.1})\"")
                    };
                    out += &format!(
                        "<text x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"{anchor}\" fill=\"{}\"{turn}>{}</text>\n",
                        hex(*colour),
                        escaped(text)
                    );
                }
                Mark::Cells { at: [x, y], size: [w, h], columns, cells } => {
                    let picture = STANDARD.encode(paint::cells(*columns as u32, cells));
                    out += &format!(
                        "<image x=\"{x:.1}\" y=\"{y:.1}\" width=\"{w:.1}\" height=\"{h:.1}\" \
                         preserveAspectRatio=\"none\" style=\"image-rendering:pixelated\" \
                         href=\"data:image/png;base64,{picture}\"/>\n"
                    );
                }
            }
        }
        out + "</svg>\n"
    }

    /// The page as PNG.
    pub fn png(&self) -> Vec<u8> {
        paint::page(&self.svg(), self.width, self.height)
    }
}

fn path(points: &[[f64; 2]]) -> String {
    let mut out = String::new();
    for (index, [x, y]) in points.iter().enumerate() {
        out += &format!("{}{x:.1},{y:.1}", if index == 0 { 'M' } else { 'L' });
    }
    out
}

fn hex([r, g, b]: Colour) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}
