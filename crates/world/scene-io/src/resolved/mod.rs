//! Resolved scenes: scene files of `kind = "resolved"`, with all numbers and poses of a scene.

pub(crate) mod read;
pub(crate) mod write;
