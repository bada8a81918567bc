//! Reports of a check: for people at a terminal, for programs, and for CI.
//!
//! ```text
//! verdict    the words that the reports share
//! screen     one terminal screen
//! json       check.json
//! junit      junit.xml
//! explorer   the part of report.html that answers when asked
//! page       report.html
//! folder     all files in a folder
//! ```

mod explorer;
mod folder;
mod json;
mod junit;
mod page;
mod screen;
mod verdict;

pub use folder::write_check;
pub use json::check_json;
pub use junit::check_suite;
pub use page::check_page;
pub use screen::check_screen;
pub use verdict::{items_not_given, not_given, rays_not_given};
