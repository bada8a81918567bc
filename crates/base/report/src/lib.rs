//! What reports are made of: numbers as text, tables, pictures, drawings, HTML pages and JUnit documents.
//!
//! Internal to raypencil: any version may change its items. The crate `raypencil` is the door.
//!
//! The crate knows nothing of rays or judgements. The same input gives the same bytes on every machine: PNG pictures
//! are drawn with a font that is compiled in.
//!
//! ```text
//! text, table                     numbers, times and lists as text, and aligned columns for screens
//! colour, png                     colours, and PNG in memory
//! scale -> picture -> plot        ticks at round values, maps as pictures, pictures with axes and rings
//! maps                            range maps of a sensor beside their differences, as HTML
//! letters, drawing -> paint       polygons, lines, text and cells on a page: as SVG, and as PNG
//! drawing -> axes                 axes of a plot
//! version -> page                 head and end of an HTML page
//! junit                           test results for continuous integration
//! document                        what a command found, as a screen, a page, Markdown, JUnit and JSON
//! ```
//!
//! Sources: the colour maps are viridis (van der Walt and Smith) and ColorBrewer's RdBu (Brewer), by `colorous`. SVG is
//! painted by `tiny-skia`.
//!
//! ```
//! use raypencil_report::{Align, Table, count, quantity};
//!
//! let mut table = Table::new([Align::Left, Align::Right, Align::Right]);
//! table.row(["", "rays", "error"]);
//! table.row(["range".to_string(), count(1_081_344), quantity(6.394e-14, "m")]);
//! // Thousands are separated, numbers have three digits.
//! assert_eq!(table.lines()[1], "range  1,081,344  6.39e-14 m");
//! ```

mod axes;
mod colour;
mod defect_list;
mod document;
mod drawing;
mod junit;
mod letters;
mod maps;
mod page;
mod paint;
mod picture;
mod plot;
mod png;
mod scale;
mod table;
mod text;
mod version;

pub use axes::{TICK_LENGTH_PX, apart_in_row, axis_from_offset, draw_axes, widest};
pub use colour::Colour;
pub use defect_list::{DefectGroup, DefectLine, defect_list};
pub use document::{Block, Column, Count, Document, Grid, Outcome, Room, markdown_code, markdown_text};
pub use drawing::{Anchor, Drawing, INK, LETTERS, Mark, SOFT};
pub use junit::{JunitCase, JunitReport, JunitSuite};
pub use maps::{MapPair, SensorPlots};
pub use page::{PAGE_END, page_head};
pub use paint::text_width;
pub use picture::{ColourMap, Picture, Reduction};
pub use plot::{
    Bar, MAX_PICTURE_CELLS, MAX_PICTURE_SIDE, Plot, Ring, cells_axis, max_side_of_pictures, reduced_to,
    shape, stretch,
};
pub use scale::{Scale, Spread, Tick};
pub use table::{Align, Table};
pub use text::{count, counted, described_words, escaped, list, number, quantity, time};
pub use version::VERSION;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

// The tests by public items are in the program of the unit tests: one executable for the crate.
#[cfg(test)]
extern crate self as raypencil_report;
#[cfg(test)]
#[path = "../tests/it/mod.rs"]
mod it;
