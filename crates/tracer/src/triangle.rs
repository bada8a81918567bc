//! Does a ray meet a face, its front or either side, and at which t? Watertight, in f64.
//!
//! After S. Woop, C. Benthin, I. Wald, "Watertight Ray/Triangle Intersection", JCGT 2(1), 2013: the
//! vertices are projected along the ray onto the plane of the two shorter axes, and three 2D edge
//! functions say on which side of each edge the ray passes. Two things differ from their paper.
//! Their division by the longest component is replaced by a multiplication of the other side, so that rays
//! of dyadic numbers stay exact. And t comes from the face's plane, whose edges are exact differences of
//! f32 numbers, not from the edge functions: at grazing incidence on a small face that is the more accurate.
//!
//! Why no ray slips between two faces: each vertex has *one* projected position per ray, whichever face it
//! is reached from. The sign of `fl(fl(ax by) - fl(ay bx))` is never wrong, only sometimes 0, because
//! rounding is monotonic; and it is exactly reversed when a and b change places. A test that admits 0
//! therefore loses no point of the projected mesh.

use glam::DVec3;
use raypencil_scene::FaceId;

use crate::rays::TracedRay;

/// A face as stored beside the tree: its corners, unrounded, and its name.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Triangle {
    pub(crate) vertices: [[f32; 3]; 3],
    pub(crate) face: FaceId,
}

impl Triangle {
    /// Starts the cycle at the lowest position, so that two faces of the same corners get the same bits and
    /// tie exactly, wherever their cycles start in the file.
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

    /// n = (b - a) x (c - a), not a unit, scene frame.
    pub(crate) fn normal(&self) -> DVec3 {
        let [a, b, c] = self.vertices.map(widen);
        (b - a).cross(c - a)
    }

    /// The t at which `ray` meets the front of this face, on any line of it, edges and vertices included.
    /// Only t says where: that it is at least 1 and within the range is for the caller to ask.
    #[inline]
    pub(crate) fn meets(&self, ray: &TracedRay) -> Option<f64> {
        // n.q < 0: the ray meets the front.
        let at = self.crossing::<false>(ray)?;
        if at.along < 0.0 { Some(at.to_plane / at.along) } else { None }
    }

    /// How `ray` meets this face from its front or from its back, edges and vertices included; not if it
    /// is parallel to it. A face and the same face reversed answer with the same bits but for the signs.
    ///
    /// Nothing slips between two faces here either, whichever sides they show: what lies on their common edge
    /// has the sign 0 or exactly opposite signs in the two, and 0 is admitted by front and by back.
    #[inline]
    pub(crate) fn crosses(&self, ray: &TracedRay) -> Option<Crossing> {
        self.crossing::<true>(ray).filter(|at| at.along != 0.0)
    }

    /// The crossing of the face's plane, if the ray passes on the inner side of all three edges, or on them:
    /// as one sees the face's front or, with `BACKS`, as one sees either side.
    #[inline(always)]
    fn crossing<const BACKS: bool>(&self, ray: &TracedRay) -> Option<Crossing> {
        let [a, b, c] = self.vertices.map(widen);
        let [a0, b0, c0] = [a - ray.origin, b - ray.origin, c - ray.origin];

        // Project along the ray; both coordinates come out multiplied by its longest component.
        let [kx, ky, kz] = ray.axes;
        let (qx, qy, qz) = (ray.direction[kx], ray.direction[ky], ray.direction[kz]);
        let project = |v: DVec3| (v[kx] * qz - v[kz] * qx, v[ky] * qz - v[kz] * qy);
        let ((ax, ay), (bx, by), (cx, cy)) = (project(a0), project(b0), project(c0));

        // All >= 0: inside as seen from the front; all <= 0: from the back; all 0: it is seen edge-on.
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
        Some(Crossing { normal, to_plane: normal.dot(a0), along: normal.dot(ray.direction) })
    }
}

/// Where a ray o + t q crosses the plane of a face: at t = `to_plane` / `along`.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Crossing {
    /// n, not a unit.
    pub(crate) normal: DVec3,
    /// n.(a - o).
    pub(crate) to_plane: f64,
    /// n.q: below 0 if the ray meets the front.
    pub(crate) along: f64,
}

pub(crate) fn widen([x, y, z]: [f32; 3]) -> DVec3 {
    DVec3::new(f64::from(x), f64::from(y), f64::from(z))
}
