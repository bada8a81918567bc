//! Step 2: the vertices in the sensor's frame and on the SPP. (§4, 2; figure 7)

use glam::DVec3;
use rayon::prelude::*;
use raypencil_scene::Mesh;

use crate::spp::SppPoint;

/// A vertex in the sensor's frame.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SensorVertex {
    /// Position in the sensor's frame, metres.
    pub(crate) position: DVec3,
    /// Projection onto the SPP. Meaningful only for a vertex at or beyond the SPP.
    pub(crate) projection: SppPoint,
    /// The sides of the screen that the vertex is outside of: bits of `skip`.
    pub(crate) outside: u8,
}

/// Transforms all vertices in parallel; each is independent of the others.
pub(crate) fn transform(
    mesh: &Mesh,
    transform_one: impl Fn(DVec3) -> SensorVertex + Sync,
) -> Vec<SensorVertex> {
    mesh.vertices().par_iter().with_min_len(4096).map(|&v| transform_one(widen(v))).collect()
}

/// A vertex in f64, exactly.
#[inline]
pub(crate) fn widen([x, y, z]: [f32; 3]) -> DVec3 {
    DVec3::new(f64::from(x), f64::from(y), f64::from(z))
}
