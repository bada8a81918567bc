//! One ray's place: its sensor and its cell.

use std::fmt;

use crate::SensorId;

/// A ray, by its sensor and cell. Written as `camera pixel 412,300` or `beam-0 pencil 412,3`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Place {
    /// The sensor that the ray belongs to.
    pub sensor: SensorId,
    /// Column.
    pub i: u32,
    /// Row.
    pub j: u32,
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let cell = if self.sensor == SensorId::Camera { "pixel" } else { "pencil" };
        write!(f, "{} {cell} {},{}", self.sensor, self.i, self.j)
    }
}
