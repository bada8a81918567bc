//! Reports of a validation: the folder that it leaves behind and the screen that the command prints.
//! `docs/guide/report.md` describes both.

mod candidates;
pub(crate) mod document;
mod explorer;
pub(crate) mod folder;
pub(crate) mod formats;
mod junit;
mod light;
mod panel;
mod pictures;
mod plots;
mod reading;
mod screen;
mod summary;
mod table;
mod verdict;
