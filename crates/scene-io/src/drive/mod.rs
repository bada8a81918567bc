//! drive

pub(crate) mod camera;
pub(crate) mod camera_keys;
pub(crate) mod camera_settings;
pub(crate) mod keys;
pub(crate) mod plan;
pub(crate) mod settings;
