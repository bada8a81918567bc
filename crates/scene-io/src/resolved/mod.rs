//! Resolved scenes: scene files with the numbers of a scene itself, poses and all. Keys: `docs/scene.md`.

mod read;
mod write;

pub(crate) use read::parse;
pub use write::write_resolved;
