//! Displacements of a ray from the centre of its cell, and the norm in which margins are measured.

/// The displacement of a ray from a cell's own ray.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Displacement {
    /// To the right, cells of the sensor.
    pub dx: f64,
    /// Downwards, cells of the sensor. In a beam this moves the ray's origin along the focal axis.
    pub dy: f64,
}

impl Displacement {
    /// No displacement.
    pub const ZERO: Self = Self { dx: 0.0, dy: 0.0 };

    /// The larger of |dx| and |dy|, cells: the norm in which margins are measured.
    pub fn max_norm(&self) -> f64 {
        max_norm([self.dx, self.dy])
    }
}

/// The larger of |dx| and |dy|.
pub(crate) fn max_norm(at: [f64; 2]) -> f64 {
    at[0].abs().max(at[1].abs())
}
