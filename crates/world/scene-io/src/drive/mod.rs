//! `[drive]`: route, rover and camera of a drive.

pub(crate) mod camera;
pub(crate) mod kernel;
pub(crate) mod read;
pub(crate) mod setup;
