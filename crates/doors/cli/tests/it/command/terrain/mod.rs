//! `terrain`: terrains as files.

mod generate;
pub(super) mod import;
mod inspect;
