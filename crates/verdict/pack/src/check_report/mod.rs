//! A check in its one form for all packs, from which every report is made.
//!
//! ```text
//! findings   bundles, items and wrong rays, and the verdict on them
//! document   the same as the document that `raypencil-report` prints
//! given      what a candidate gives, what it does not, and in which type
//! sharpness  how large a mistake would have been noticed
//! sensors    a check of sensors in that form
//! explorer   the part of its page that answers when asked
//! folder     the files of a check
//! ```

mod document;
mod explorer;
mod findings;
mod folder;
mod given;
mod sensors;
mod sharpness;

pub use findings::{BundleFindings, CheckFindings, ItemFindings, PackForm, Said, WorstOf, WrongRay};
pub use folder::write_document;
pub use given::{half_precision_note, items_not_given, not_given, rays_not_given};
pub use sensors::check_suite;
