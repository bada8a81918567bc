//! A drawing: a page of marks, and that page as SVG.

use crate::colour::{Colour, css_hex};
use crate::png;
use crate::text::escaped;

/// Colour of text and of the main lines.
pub const INK: Colour = [29, 31, 34];

/// Colour of axes, ticks and secondary text.
pub const SOFT: Colour = [110, 115, 122];

/// Fonts of all text: first the one that is compiled in for PNG, then those that readers of the SVG may have.
const FONTS: &str = "Ubuntu, 'Noto Sans', 'DejaVu Sans', Helvetica, Arial, sans-serif";

/// Part of a text that is at its place.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Anchor {
    /// The start of the text.
    Start,
    /// The middle of the text.
    Middle,
    /// The end of the text.
    End,
}

/// A mark on the page. Places are x and y in pixels from the upper left corner of the page.
#[derive(Debug, Clone, PartialEq)]
pub enum Mark {
    /// A filled polygon.
    Polygon {
        /// Corners in order; the last is joined to the first.
        points: Vec<[f64; 2]>,
        /// Colour inside.
        fill: Colour,
        /// Colour of a thin line around it, if there is one.
        edge: Option<Colour>,
    },
    /// A line of several pieces.
    Line {
        /// Ends of the pieces, in order.
        points: Vec<[f64; 2]>,
        /// Colour of the line.
        colour: Colour,
        /// Width, pixels.
        width: f64,
    },
    /// A line of text.
    Text {
        /// Place of its anchor, on the base line.
        at: [f64; 2],
        /// The text, not escaped.
        text: String,
        /// Part of the text that is at its place.
        anchor: Anchor,
        /// Colour of the letters.
        colour: Colour,
        /// Rotation about its place, clockwise, degrees.
        turn: f64,
    },
    /// A picture of rectangular cells.
    Cells {
        /// Upper left corner.
        at: [f64; 2],
        /// Width and height, pixels of the page.
        size: [f64; 2],
        /// Number of cells in a row.
        columns: usize,
        /// Colours, row by row from the top; cells without a colour are transparent.
        cells: Vec<Option<Colour>>,
    },
}

/// Width of the line around a polygon, pixels.
pub(crate) const POLYGON_EDGE: f64 = 0.5;

/// Font size of all text, pixels.
pub const LETTERS: f64 = 13.0;

/// A page of marks with a white background.
///
/// ```
/// use raypencil_report::{Anchor, Drawing, INK};
///
/// let mut drawing = Drawing::new(80, 40, "one < two");
/// drawing.polygon(vec![[10.0, 10.0], [30.0, 10.0], [30.0, 30.0]], [0, 90, 200], None);
/// drawing.text([40.0, 25.0], "a & b", Anchor::Start, INK);
/// let svg = drawing.svg();
/// assert!(svg.contains("<path d=\"M10.0,10.0L30.0,10.0L30.0,30.0z\" fill=\"#005ac8\"/>"));
/// // Texts are escaped, in the title too.
/// assert!(svg.contains("<title>one &lt; two</title>") && svg.contains(">a &amp; b</text>"));
/// // A PNG begins with these eight bytes. (PNG specification, section 5.2)
/// assert!(drawing.png().starts_with(b"\x89PNG\r\n\x1a\n"));
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Drawing {
    /// Width of the page, pixels.
    pub width: u32,
    /// Height of the page, pixels.
    pub height: u32,
    /// Title, for those who do not see the page.
    pub title: String,
    /// Marks; later ones cover earlier ones.
    pub marks: Vec<Mark>,
}

impl Drawing {
    /// An empty page of this size, pixels.
    pub fn new(width: u32, height: u32, title: &str) -> Self {
        Self { width, height, title: title.to_string(), marks: Vec::new() }
    }

    /// Adds a filled polygon.
    pub fn polygon(&mut self, points: Vec<[f64; 2]>, fill: Colour, edge: Option<Colour>) {
        self.marks.push(Mark::Polygon { points, fill, edge });
    }

    /// Adds a line; `width` is in pixels.
    pub fn line(&mut self, points: Vec<[f64; 2]>, colour: Colour, width: f64) {
        self.marks.push(Mark::Line { points, colour, width });
    }

    /// Adds a line of text.
    pub fn text(&mut self, at: [f64; 2], text: impl Into<String>, anchor: Anchor, colour: Colour) {
        self.turned_text(at, text, anchor, colour, 0.0);
    }

    /// Adds a line of text that is rotated about its place by `turn` degrees, clockwise.
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

    /// The page as SVG without references to other files.
    pub fn svg(&self) -> String {
        let (width, height, title) = (self.width, self.height, escaped(&self.title));
        let mut out = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" width=\"{width}\" \
             height=\"{height}\" role=\"img\" aria-label=\"{title}\" font-family=\"{FONTS}\" \
             font-size=\"{LETTERS}\">\n<title>{title}</title>\n\
             <rect width=\"{width}\" height=\"{height}\" fill=\"#ffffff\"/>\n"
        );
        for mark in &self.marks {
            match mark {
                Mark::Polygon { points, fill, edge } => {
                    let edge = edge.map_or(String::new(), |edge| {
                        format!(" stroke=\"{}\" stroke-width=\"{POLYGON_EDGE}\"", css_hex(edge))
                    });
                    out += &format!("<path d=\"{}z\" fill=\"{}\"{edge}/>\n", path(points), css_hex(*fill));
                }
                Mark::Line { points, colour, width } => {
                    out += &format!(
                        "<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{width}\"/>\n",
                        path(points),
                        css_hex(*colour)
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
                        css_hex(*colour),
                        escaped(text)
                    );
                }
                Mark::Cells { at: [x, y], size: [w, h], columns, cells } => {
                    let picture = png::data_uri(&png::rgba(*columns as u32, cells));
                    out += &format!(
                        "<image x=\"{x:.1}\" y=\"{y:.1}\" width=\"{w:.1}\" height=\"{h:.1}\" \
                         preserveAspectRatio=\"none\" style=\"image-rendering:pixelated\" \
                         href=\"{picture}\"/>\n"
                    );
                }
            }
        }
        out + "</svg>\n"
    }
}

/// Path data of SVG for these points.
fn path(points: &[[f64; 2]]) -> String {
    let mut out = String::new();
    for (index, [x, y]) in points.iter().enumerate() {
        out += &format!("{}{x:.1},{y:.1}", if index == 0 { 'M' } else { 'L' });
    }
    out
}
