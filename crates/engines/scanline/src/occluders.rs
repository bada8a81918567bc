//! The faces that may stand between a stripe and the camera, clipped to their part at or beyond the SPP. (§6)

use glam::DVec3;
use raypencil_scene::{FaceId, Mesh};

use crate::bins::ProjectedBounds;
use crate::clip::{AddedLines, ClippedTriangle, clip_at_spp};
use crate::clusters::Clusters;
use crate::edges;
use crate::perspective::{Perspective, StraightLine};
use crate::plane::Plane;
use crate::skip::{self, BEHIND_SPP};
use crate::spp::SppPoint;
use crate::spp::widen;
use crate::transformation::Transformation;
use crate::vertices::{SensorVertex, TransformedClusters};
use crate::{Fidelity, Switches};

/// The faces that occlude, by the side that they show.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Facing {
    /// Every face, from either side.
    Every,
    /// Faces that show the camera's position their back.
    AwayFromCamera,
    /// `facing = paper`: faces whose normal makes "an angle of less than 90 degrees with respect to the camera axis
    /// vector, or, equivalently, the dot product of these two vectors is a positive number".
    AwayFromAxis,
}

impl Facing {
    pub(crate) fn from_switches(switches: Switches) -> Self {
        match (switches.facing, switches.place) {
            (Fidelity::Paper, _) => Self::AwayFromAxis,
            // With `place = paper` a point is compared at its pixel's centre. There its own face is nearer than the
            // point or not, by chance, so faces that show their front must not occlude.
            (Fidelity::Exact, Fidelity::Paper) => Self::AwayFromCamera,
            (Fidelity::Exact, Fidelity::Exact) => Self::Every,
        }
    }
}

/// The terrain's faces, ready to be tested as occluders.
pub(crate) struct Occluders<'a> {
    pub(crate) mesh: &'a Mesh,
    pub(crate) camera: &'a Perspective<'a>,
    clusters: &'a Clusters,
    facing: Facing,
    /// An occluder needs a vertex no deeper than this, metres.
    extent: f64,
}

/// An occluding face, or one triangle of its part at or beyond the SPP.
pub(crate) struct Occluder {
    pub(crate) face: FaceId,
    pub(crate) triangle: ClippedTriangle<StraightLine>,
    pub(crate) plane: Plane,
    pub(crate) bounds: ProjectedBounds,
    /// 1/t of the deepest corner.
    pub(crate) min_inverse_t: f64,
}

impl<'a> Occluders<'a> {
    pub(crate) fn new(
        mesh: &'a Mesh,
        clusters: &'a Clusters,
        camera: &'a Perspective<'a>,
        facing: Facing,
        extent: f64,
    ) -> Self {
        Self { mesh, camera, clusters, facing, extent }
    }

    /// The clusters of which a face may occlude anything: those with a part at or beyond the SPP, if that part's bounds are
    /// `relevant`. The bounds of a cluster are those of its box, within which are those of all its faces.
    pub(crate) fn clusters(&self, relevant: impl Fn(&ProjectedBounds) -> bool + Sync) -> Vec<u32> {
        let (spp, sensor_from_scene) = (self.camera.spp_distance(), self.camera.sensor_from_scene());
        self.clusters.seen(sensor_from_scene.position(), |corners| {
            let points = corners.map(|corner| sensor_from_scene.in_sensor_axes(corner));
            if points.iter().all(|p| p.z < spp) {
                return true;
            }
            if points.iter().any(|p| p.z < spp) {
                return false;
            }
            let mut bounds = ProjectedBounds {
                low: SppPoint { x: f64::INFINITY, y: f64::INFINITY },
                high: SppPoint { x: f64::NEG_INFINITY, y: f64::NEG_INFINITY },
                max_inverse_t: 0.0,
            };
            for p in points {
                let SppPoint { x, y } = self.camera.project(p);
                bounds.low = SppPoint { x: bounds.low.x.min(x), y: bounds.low.y.min(y) };
                bounds.high = SppPoint { x: bounds.high.x.max(x), y: bounds.high.y.max(y) };
                bounds.max_inverse_t = bounds.max_inverse_t.max(spp / p.z);
            }
            !relevant(&bounds)
        })
    }

    /// All clusters.
    pub(crate) fn all_clusters(&self) -> Vec<u32> {
        self.clusters.all()
    }

    /// Step 2 for some clusters. The camera's maximum range and the borders of its screen do not matter here.
    pub(crate) fn transformed(&self, clusters: &[u32]) -> TransformedClusters {
        let (spp, sensor_from_scene) = (self.camera.spp_distance(), self.camera.sensor_from_scene());
        TransformedClusters::new(self.mesh, self.clusters, clusters, false, |in_scene| {
            let offset = sensor_from_scene.offset_of(widen(in_scene));
            let position = sensor_from_scene.in_sensor_axes(offset);
            let outside = skip::outside_bits(position.z < spp, false, false, false, false, false);
            SensorVertex { in_scene, position, projection: self.camera.project(position), outside }
        })
    }

    /// Calls `visit` with each triangle of a face, if the face occludes. Triangles whose bounds are not `relevant` are
    /// left out.
    #[inline]
    pub(crate) fn visit_face(
        &self,
        face: FaceId,
        vertices: [&SensorVertex; 3],
        relevant: impl Fn(&ProjectedBounds) -> bool,
        mut visit: impl FnMut(&Occluder),
    ) {
        if vertices.iter().any(|vertex| vertex.outside & BEHIND_SPP != 0) {
            // 1a: no part of it is beyond the SPP.
            if !vertices.iter().all(|vertex| vertex.outside & BEHIND_SPP != 0) {
                self.visit_cut_face(face, vertices, relevant, visit);
            }
            return;
        }
        let points = vertices.map(|vertex| vertex.position);
        let corners = vertices.map(|vertex| vertex.projection);
        let (bounds, min_inverse_t) = self.bounds(&points, &corners);
        if relevant(&bounds)
            && let Some(plane) = self.occluding_plane(&vertices)
        {
            let lines = edges::edges(self.camera, &vertices).map(|edge| edge.line);
            let triangle = ClippedTriangle { points, corners, lines };
            visit(&Occluder { face, triangle, plane, bounds, min_inverse_t });
        }
    }

    /// `visit_face` for a face that the SPP cuts. Few are: it is kept out of line of the others.
    #[inline(never)]
    fn visit_cut_face(
        &self,
        face: FaceId,
        vertices: [&SensorVertex; 3],
        relevant: impl Fn(&ProjectedBounds) -> bool,
        mut visit: impl FnMut(&Occluder),
    ) {
        let points = vertices.map(|vertex| vertex.position);
        let Some(plane) = self.occluding_plane(&vertices) else { return };
        let added_lines = AddedLines {
            along_spp: |from, to| self.camera.project_spp_cut(from, to, &plane),
            diagonal: |from: DVec3, to: DVec3| self.camera.project_edge(from, to, to - from),
        };
        let corners = vertices.map(|vertex| vertex.projection);
        let edges = edges::edges(self.camera, &vertices);
        clip_at_spp(self.camera.spp_distance(), points, corners, &edges, added_lines, |triangle| {
            let (bounds, min_inverse_t) = self.bounds(&triangle.points, &triangle.corners);
            if relevant(&bounds) {
                visit(&Occluder { face, triangle: *triangle, plane, bounds, min_inverse_t });
            }
        });
    }

    /// The plane of a face, if the face occludes.
    #[inline]
    fn occluding_plane(&self, vertices: &[&SensorVertex; 3]) -> Option<Plane> {
        // "only considering triangles with a least one vertex not past the furthest extent of the upper laser
        // beam". The extent is infinite, and culls nothing, unless `extent = paper`.
        if !vertices.iter().any(|vertex| vertex.position.z <= self.extent) {
            return None;
        }
        let plane =
            Plane::new(&vertices.map(|vertex| widen(vertex.in_scene)), self.camera.sensor_from_scene());
        let occludes = match self.facing {
            // d = 0: the plane contains the projection centre. Every ray meets it in that centre alone, or is parallel
            // to it. Faces without area have d = 0 too.
            Facing::Every => plane.offset != 0.0,
            Facing::AwayFromCamera => plane.offset > 0.0,
            Facing::AwayFromAxis => plane.normal.z > 0.0 && plane.offset != 0.0,
        };
        occludes.then_some(plane)
    }

    /// The bounds of a triangle, and 1/t of its deepest corner.
    #[inline]
    fn bounds(&self, points: &[DVec3; 3], [a, b, c]: &[SppPoint; 3]) -> (ProjectedBounds, f64) {
        let spp = self.camera.spp_distance();
        let min = |a: f64, b: f64, c: f64| a.min(b).min(c);
        let max = |a: f64, b: f64, c: f64| a.max(b).max(c);
        let [p, q, r] = points.map(|point| point.z);
        let bounds = ProjectedBounds {
            low: SppPoint { x: min(a.x, b.x, c.x), y: min(a.y, b.y, c.y) },
            high: SppPoint { x: max(a.x, b.x, c.x), y: max(a.y, b.y, c.y) },
            max_inverse_t: spp / min(p, q, r),
        };
        (bounds, spp / max(p, q, r))
    }
}

#[cfg(test)]
#[path = "../tests/unit/occluders.rs"]
mod tests;
