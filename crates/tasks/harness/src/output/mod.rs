//! Reports of a validation: the folder that it leaves behind and the screen that the command prints.
//! `docs/guide/report.md` describes both.

pub(crate) mod candidates;
pub(crate) mod explorer;
pub(crate) mod folder;
pub(crate) mod formats;
pub(crate) mod junit;
pub(crate) mod light;
pub(crate) mod markdown;
pub(crate) mod panel;
pub(crate) mod plots;
pub(crate) mod report;
pub(crate) mod screen;
pub(crate) mod summary;
pub(crate) mod table;
pub(crate) mod verdict;
