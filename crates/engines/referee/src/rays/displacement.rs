//! Displacements of a ray, and the norm in which margins are measured.

/// The displacement of a ray: from a cell's own ray in cells of its sensor, or of a ray of no sensor along the two vectors of
/// [`CastRay::across`](raypencil_scene::CastRay::across), in the mesh's unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Displacement {
    /// To the right, or along the first vector.
    pub dx: f64,
    /// Downwards, or along the second vector. In a beam this moves the ray's origin along the focal axis.
    pub dy: f64,
}

impl Displacement {
    /// No displacement.
    pub const ZERO: Self = Self { dx: 0.0, dy: 0.0 };

    /// Both parts.
    pub fn to_array(self) -> [f64; 2] {
        [self.dx, self.dy]
    }

    /// The larger of |dx| and |dy|: the norm in which margins are measured.
    pub fn max_norm(&self) -> f64 {
        max_norm([self.dx, self.dy])
    }
}

/// The larger of |dx| and |dy|.
pub(crate) fn max_norm(at: [f64; 2]) -> f64 {
    at[0].abs().max(at[1].abs())
}

impl From<[f64; 2]> for Displacement {
    fn from([dx, dy]: [f64; 2]) -> Self {
        Self { dx, dy }
    }
}
