//! Resolved scenes: scene files of `kind = "resolved"` with all numbers of a scene and all poses. Keys: `docs/guide/scene.md`.

pub(crate) mod read;
pub(crate) mod write;
