//! The answers of a whole sensor.

pub(crate) mod certified;
pub(crate) mod render;
