//! One document for all reports: what a command found, and five writers that print it.
//!
//! A command that compares or checks makes a [`Document`] and prints nothing itself. So the same words stand on the
//! screen, on the page, in Markdown, in JUnit and in JSON.
//!
//! ```text
//! room       where a part is printed
//! grid       a table whose columns may be left out where room is short
//! model      the document and its parts; JUnit and JSON
//! screen     a terminal: blocks, then the verdict as the last lines
//! page       HTML: the verdict, facts, blocks
//! markdown   the same as a comment on a pull request
//! ```

mod grid;
mod markdown;
mod model;
mod page;
mod room;
mod screen;

pub use grid::{Column, Grid};
pub use markdown::{markdown_code, markdown_text};
pub use model::{Block, Count, Document, Outcome};
pub use room::Room;
