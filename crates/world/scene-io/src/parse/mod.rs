//! Scene TOML to a [`crate::plan::ScenePlan`]. Each key is checked alone; each error points to its place in the file.

pub(crate) mod camera;
pub(crate) mod dem;
pub(crate) mod file_frame;
pub(crate) mod generate;
pub(crate) mod key;
pub(crate) mod kind;
mod plain_words;
pub(crate) mod rays;
pub(crate) mod rig;
pub(crate) mod scene;
pub(crate) mod shared;
pub(crate) mod source;
pub(crate) mod terrain;
