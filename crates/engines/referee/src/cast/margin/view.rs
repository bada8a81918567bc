//! Which sides of faces a ray sees: by the faces' normals in `f32` where these are certain, else exactly.

use glam::DVec3;
use raypencil_scene::{CastRay, FaceId, Side, Sides, Triangles};

use super::super::query_ray::QueryRay;
use super::super::triangle::Triangle;
use super::seams::Seams;

/// A ray's look at the faces of a mesh.
pub(super) struct View<'v> {
    mesh: &'v Triangles,
    seams: &'v Seams,
    query: QueryRay<'v>,
    /// The ray's direction, 1 long up to rounding.
    direction: DVec3,
    sides: Sides,
}

impl<'v> View<'v> {
    pub(super) fn new(mesh: &'v Triangles, seams: &'v Seams, ray: &'v CastRay, sides: Sides) -> Self {
        let direction = super::super::bundle(ray).direction;
        Self { mesh, seams, query: QueryRay::new(ray), direction, sides }
    }

    /// Which sides are hit.
    pub(super) fn sides(&self) -> Sides {
        self.sides
    }

    /// The side that is seen; `None` if the face is parallel to the ray.
    #[inline]
    pub(super) fn side(&self, face: &Triangle) -> Option<Side> {
        self.seams.certain_side(face.id, self.direction).or_else(|| face.seen_side(&self.query))
    }

    /// The side that is seen, if it is hit.
    #[inline]
    pub(super) fn side_hit(&self, face: &Triangle) -> Option<Side> {
        self.side(face).filter(|side| self.sides.include(*side))
    }

    /// Whether the face shows this side.
    #[inline]
    pub(super) fn shows(&self, face: FaceId, side: Side) -> bool {
        let certain = self.seams.certain_side(face, self.direction);
        certain.or_else(|| Triangle::of(self.mesh, face).seen_side(&self.query)) == Some(side)
    }

    /// Whether all faces of a node of the hierarchy, and those behind their edges, certainly show the same side: -1 fronts, 1 backs, 0
    /// if that is not certain.
    #[inline]
    pub(super) fn side_shown(&self, node: u32) -> i32 {
        self.seams.side_shown(node, self.direction)
    }
}
