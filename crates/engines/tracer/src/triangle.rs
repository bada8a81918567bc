//! The watertight ray-triangle test, in f64.
//!
//! After S. Woop, C. Benthin, I. Wald, "Watertight Ray/Triangle Intersection", JCGT 2(1), 2013. The vertices
//! are projected along the ray onto the plane of the two shorter axes. Three 2D edge functions then say on which
//! side of each edge the ray passes. Two things differ from their paper:
//!
//! * They divide by the longest component of the direction. Here the other side of the equation is multiplied by
//!   it, so that rays of dyadic numbers stay exact.
//! * They compute t from the edge functions. Here t comes from the plane of the face, whose edge vectors are exact
//!   differences of f32 numbers. On a small face at grazing incidence this is more accurate.
//!
//! Why no ray slips between two faces: each vertex has *one* projected position per ray, the same in every face.
//! The sign of `fl(fl(ax by) - fl(ay bx))` is never wrong, only sometimes 0, because rounding is monotonic. It is
//! exactly reversed when a and b change places. A test that admits 0 therefore loses no point of the projected
//! mesh.

use glam::DVec3;
use raypencil_scene::{FaceId, Mesh};

use crate::traced_ray::TracedRay;

/// A face as stored beside the tree: its unrounded vertices and its index in the mesh.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Triangle {
    pub(crate) vertices: [[f32; 3]; 3],
    pub(crate) face: FaceId,
}

impl Triangle {
    /// Starts the vertex cycle at the lexicographically lowest position. Two faces with the same vertices then
    /// give the same bits and tie exactly, wherever their cycles start in the file.
    pub(crate) fn new([a, b, c]: [[f32; 3]; 3], face: FaceId) -> Self {
        let vertices = if a <= b && a <= c {
            [a, b, c]
        } else if b <= c {
            [b, c, a]
        } else {
            [c, a, b]
        };
        Self { vertices, face }
    }

    /// A face of `mesh`.
    pub(crate) fn of(mesh: &Mesh, face: FaceId) -> Self {
        Self::new(mesh.faces()[face.0 as usize].map(|v| mesh.vertices()[v as usize]), face)
    }

    /// The vertices in f64, exactly.
    #[inline(always)]
    pub(crate) fn corners(&self) -> [DVec3; 3] {
        self.vertices.map(widen)
    }

    /// The normal n = (b - a) x (c - a), scene frame, square metres; not a unit vector.
    pub(crate) fn normal(&self) -> DVec3 {
        let [a, b, c] = self.corners();
        (b - a).cross(c - a)
    }

    /// The t at which the line of `ray` meets the front of this face; edges and vertices belong to the face.
    ///
    /// The caller checks that t is at least 1 and within the maximum range.
    #[inline]
    pub(crate) fn intersect_front(&self, ray: &TracedRay) -> Option<f64> {
        // n.q < 0: the ray meets the front.
        let crossing = self.intersect::<false>(ray)?;
        if crossing.n_dot_q < 0.0 { Some(crossing.n_dot_offset / crossing.n_dot_q) } else { None }
    }

    /// The crossing of the line of `ray` with this face, from the front or from the back; edges and vertices
    /// belong to the face. `None` if the ray is parallel to the face. A face and the same face reversed give the
    /// same bits but for the signs.
    ///
    /// Nothing slips between two faces here either, whichever sides they show. A ray through their common edge has
    /// the sign 0 there, or exactly opposite signs in the two faces; and both the front and the back test admit 0.
    #[inline]
    pub(crate) fn intersect_either_side(&self, ray: &TracedRay) -> Option<PlaneCrossing> {
        self.intersect::<true>(ray).filter(|crossing| crossing.n_dot_q != 0.0)
    }

    #[inline(always)]
    fn intersect<const BACKS: bool>(&self, ray: &TracedRay) -> Option<PlaneCrossing> {
        intersect::<BACKS>(self.corners(), ray)
    }
}

/// The crossing of a face's plane if the ray passes inside all three edges, or on them. Without `BACKS` only the edge
/// signs of the front count; with it those of the back count too.
#[inline(always)]
pub(crate) fn intersect<const BACKS: bool>([a, b, c]: [DVec3; 3], ray: &TracedRay) -> Option<PlaneCrossing> {
    let [a0, b0, c0] = [a - ray.origin, b - ray.origin, c - ray.origin];

    // Project along the ray. Both coordinates come out multiplied by the longest component of the direction.
    let [kx, ky, kz] = ray.axes;
    let (qx, qy, qz) = (ray.direction[kx], ray.direction[ky], ray.direction[kz]);
    let project = |v: DVec3| (v[kx] * qz - v[kz] * qx, v[ky] * qz - v[kz] * qy);
    let ((ax, ay), (bx, by), (cx, cy)) = (project(a0), project(b0), project(c0));

    // The edge functions. All >= 0: inside, seen from the front. All <= 0: inside, seen from the back.
    // All 0: the face is seen edge-on.
    let ab = ax * by - ay * bx;
    let bc = bx * cy - by * cx;
    let ca = cx * ay - cy * ax;
    let as_front = ab >= 0.0 && bc >= 0.0 && ca >= 0.0;
    let as_back = BACKS && ab <= 0.0 && bc <= 0.0 && ca <= 0.0;
    if !(as_front || as_back) || (ab == 0.0 && bc == 0.0 && ca == 0.0) {
        return None;
    }

    // t = n.(a - o) / n.q.
    let normal = (b - a).cross(c - a);
    let edges = [ab, bc, ca];
    Some(PlaneCrossing { normal, n_dot_offset: normal.dot(a0), n_dot_q: normal.dot(ray.direction), edges })
}

/// The crossing of a ray o + t q with the plane of a face, at t = `n_dot_offset` / `n_dot_q`.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PlaneCrossing {
    /// The normal n of the face, not a unit vector.
    pub(crate) normal: DVec3,
    /// n.(a - o), with a vertex a of the face.
    pub(crate) n_dot_offset: f64,
    /// n.q; negative if the ray meets the front.
    pub(crate) n_dot_q: f64,
    /// The edge functions of a b, b c and c a: each is a share of the face's projected area, which is their sum.
    pub(crate) edges: [f64; 3],
}

/// A vertex in f64, exactly.
pub(crate) fn widen([x, y, z]: [f32; 3]) -> DVec3 {
    DVec3::new(f64::from(x), f64::from(y), f64::from(z))
}
