//! Resolved scenes: scene files with the numbers of a scene itself, poses and all. Keys: `docs/guide/scene.md`.

pub(crate) mod read;
pub(crate) mod write;

pub(crate) use crate::resolved::read::parse;
