//! Compares two recordings of anything, channel by channel: what differs, by how much, and whether that is allowed.
//!
//! Internal to raypencil: any version may change its items. The crate `raypencil` is the door.
//!
//! A recording is a set of named channels, as `raypencil-files` reads them from folders and files; no scene is needed.
//! If there is one, the referee's checks (`raypencil-judge`) tell which side is right. `docs/guide/diff.md` has the
//! rules.
//!
//! ```text
//! cells                          the rule for one cell, the statistics of one channel
//! rulings -> difference          the structure of a difference, with the referee's rulings
//! unit -> compare                compares two recordings
//! rule                           which side is right, where there is a scene
//! words, junit, summary          sentences, test results, and what programs read
//! explorer, pictures             the part of the page that answers when asked, and its pictures
//! document                       all of it as one document, which every report prints
//! folder                         the reports as files
//! ```
//!
//! ```
//! use std::path::PathBuf;
//!
//! use raypencil_diff::{Thresholds, diff};
//! use raypencil_files::{Channel, Channels, Storage, Values};
//! use raypencil_scene::Image;
//!
//! let recording = |range: f64| {
//!     let values = Values::Reals(Image::filled(2, 1, range));
//!     let channel = Channel { file: PathBuf::new(), name: String::new(), storage: Storage::F32, values };
//!     Channels { by_key: [("camera/range.T".into(), channel)].into(), ..Channels::default() }
//! };
//! // One ulp of f32 at 1 is 2^-23 = 1 / 8388608.
//! let (a, b) = (recording(1.0), recording(1.0 + 1.0 / 8_388_608.0));
//! assert!(!diff(&a, &b, &Thresholds::default())?.passes());
//! assert!(diff(&a, &b, &Thresholds { fail_ulp: 1.0, ..Thresholds::default() })?.passes());
//! # Ok::<(), raypencil_diff::DiffError>(())
//! ```

mod cells;
mod compare;
mod difference;
mod document;
mod explorer;
mod folder;
mod junit;
mod pictures;
mod rule;
mod rulings;
mod summary;
mod unit;
mod words;

pub use cells::{CellDifference, Thresholds};
pub use compare::{DiffError, diff};
pub use difference::{ChannelDifference, Difference, Sides};
pub use document::{diff_document, diff_document_with_pictures};
pub use folder::write_diff;
pub use rule::rule;
pub use rulings::{ChannelRuling, RuledCell, Rulings};

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

// The tests by public items are in the program of the unit tests: one executable for the crate.
#[cfg(test)]
extern crate self as raypencil_diff;
#[cfg(test)]
#[path = "../tests/it/mod.rs"]
mod it;
