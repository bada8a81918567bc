//! Reports of a check: for people at a terminal, for programs, and for CI.
//!
//! ```text
//! verdict    the words that the reports share
//! screen     one terminal screen
//! json       check.json
//! junit      junit.xml
//! folder     both files in a folder
//! ```

mod folder;
mod json;
mod junit;
mod screen;
mod verdict;

pub use folder::write_check;
pub use json::check_json;
pub use screen::check_screen;
