//! The faces that may stand between a stripe and the camera, clipped to the part at or beyond the SPP. (§6)

use glam::DVec3;
use raypencil_scene::{FaceId, Mesh};

use crate::bins::Reach;
use crate::clip::{NewLines, Piece, clip_at_plane};
use crate::perspective::{Perspective, StraightLine};
use crate::raster::{Plane, Transformation};
use crate::scan::Corner;
use crate::skip::{self, BEHIND_PLANE};
use crate::vertices::{self, Vertex, widen};
use crate::{Fidelity, Switches, sides};

/// Which faces occlude.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Facing {
    /// Every face, from either side.
    Every,
    /// Those that show the camera's position their back.
    AwayFromCamera,
    /// "an angle of less than 90 degrees with respect to the camera axis vector, or, equivalently, the dot product
    /// of these two vectors is a positive number": `facing = paper`.
    AwayFromAxis,
}

impl Facing {
    pub(crate) fn by(switches: Switches) -> Self {
        match (switches.facing, switches.place) {
            (Fidelity::Paper, _) => Self::AwayFromAxis,
            // At the centre of its pixel a point's own face is nearer than the point, or not, by chance.
            (Fidelity::Exact, Fidelity::Paper) => Self::AwayFromCamera,
            (Fidelity::Exact, Fidelity::Exact) => Self::Every,
        }
    }
}

/// The terrain as what may hide a stripe from the camera.
pub(crate) struct Occluders<'a> {
    pub(crate) mesh: &'a Mesh,
    pub(crate) camera: &'a Perspective<'a>,
    vertices: Vec<Vertex>,
    facing: Facing,
    /// A face needs a vertex no deeper than this, metres.
    extent: f64,
}

/// A face, or a triangle of what the SPP leaves of it.
pub(crate) struct Occluder {
    pub(crate) face: FaceId,
    pub(crate) piece: Piece<StraightLine>,
    pub(crate) plane: Plane,
    pub(crate) reach: Reach,
    /// 1/t of its deepest corner.
    pub(crate) farthest: f64,
}

impl<'a> Occluders<'a> {
    pub(crate) fn new(mesh: &'a Mesh, camera: &'a Perspective<'a>, facing: Facing, extent: f64) -> Self {
        let spp = camera.plane_distance();
        // Step 2. The camera's maximum range and the borders of its screen play no role here.
        let vertices = vertices::transform(mesh, |scene_point| {
            let sensor_from_scene = camera.sensor_from_scene();
            let position = sensor_from_scene.turn(sensor_from_scene.relative(scene_point));
            let outside = skip::bits(position.z < spp, false, false, false, false, false);
            Vertex { position, corner: camera.project(position), outside }
        });
        Self { mesh, camera, vertices, facing, extent }
    }

    pub(crate) fn count(&self) -> usize {
        self.mesh.faces().len()
    }

    /// Calls `visit` with each triangle of a face that occludes, unless `concerns` says beforehand that its reach
    /// concerns nobody.
    #[inline]
    pub(crate) fn pieces(
        &self,
        face: FaceId,
        concerns: impl Fn(&Reach) -> bool,
        mut visit: impl FnMut(&Occluder),
    ) {
        let seen = self.mesh.faces()[face.0 as usize].map(|v| &self.vertices[v as usize]);
        if seen.iter().any(|vertex| vertex.outside & BEHIND_PLANE != 0) {
            // 1a: all of it in front of the SPP.
            if !seen.iter().all(|vertex| vertex.outside & BEHIND_PLANE != 0) {
                self.pieces_beyond_spp(face, concerns, visit);
            }
            return;
        }
        let points = seen.map(|vertex| vertex.position);
        let corners = seen.map(|vertex| vertex.corner);
        let (reach, farthest) = self.reach(&points, &corners);
        if concerns(&reach)
            && let Some(plane) = self.occludes(face, &points)
        {
            let stored = self.mesh.faces()[face.0 as usize].map(|v| self.mesh.vertices()[v as usize]);
            let lines = sides::edges(self.camera, &stored, &seen).map(|edge| edge.line);
            visit(&Occluder { face, piece: Piece { points, corners, lines }, plane, reach, farthest });
        }
    }

    /// For a face that the SPP cuts. Few are: kept out of line of the others.
    #[inline(never)]
    fn pieces_beyond_spp(
        &self,
        face: FaceId,
        concerns: impl Fn(&Reach) -> bool,
        mut visit: impl FnMut(&Occluder),
    ) {
        let indices = self.mesh.faces()[face.0 as usize];
        let seen = indices.map(|v| &self.vertices[v as usize]);
        let stored = indices.map(|v| self.mesh.vertices()[v as usize]);
        let points = seen.map(|vertex| vertex.position);
        let Some(plane) = self.occludes(face, &points) else { return };
        let new_lines = NewLines {
            along_plane: |from, to| self.camera.line_along_plane(from, to, &plane),
            diagonal: |from: DVec3, to: DVec3| self.camera.line(from, to, to - from),
        };
        let corners = seen.map(|vertex| vertex.corner);
        let edges = sides::edges(self.camera, &stored, &seen);
        clip_at_plane(self.camera.plane_distance(), points, corners, &edges, new_lines, |piece| {
            let (reach, farthest) = self.reach(&piece.points, &piece.corners);
            if concerns(&reach) {
                visit(&Occluder { face, piece: *piece, plane, reach, farthest });
            }
        });
    }

    /// The plane of a face, if it is one of those that occlude.
    #[inline]
    fn occludes(&self, face: FaceId, points: &[DVec3; 3]) -> Option<Plane> {
        // "only considering triangles with a least one vertex not past the furthest extent of the upper laser
        // beam": no cull unless `extent = paper`.
        if !points.iter().any(|p| p.z <= self.extent) {
            return None;
        }
        let stored = self.mesh.faces()[face.0 as usize].map(|v| widen(self.mesh.vertices()[v as usize]));
        let plane = Plane::of(&stored, self.camera.sensor_from_scene());
        let occludes = match self.facing {
            // A plane through the projection centre is met by every ray there and nowhere else, or parallel to it.
            // A face without area has no other plane.
            Facing::Every => plane.distance != 0.0,
            Facing::AwayFromCamera => plane.distance > 0.0,
            Facing::AwayFromAxis => plane.normal.z > 0.0 && plane.distance != 0.0,
        };
        occludes.then_some(plane)
    }

    /// Reach of a triangle, and 1/t of its deepest corner.
    #[inline]
    fn reach(&self, points: &[DVec3; 3], [a, b, c]: &[Corner; 3]) -> (Reach, f64) {
        let spp = self.camera.plane_distance();
        let least = |a: f64, b: f64, c: f64| a.min(b).min(c);
        let most = |a: f64, b: f64, c: f64| a.max(b).max(c);
        let [p, q, r] = points.map(|point| point.z);
        let reach = Reach {
            low: Corner { x: least(a.x, b.x, c.x), y: least(a.y, b.y, c.y) },
            high: Corner { x: most(a.x, b.x, c.x), y: most(a.y, b.y, c.y) },
            nearest: spp / least(p, q, r),
        };
        (reach, spp / most(p, q, r))
    }
}
