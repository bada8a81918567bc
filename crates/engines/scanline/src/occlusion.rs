//! Step 5: the stripe points that terrain hides from the camera. (§3, step 5; §6)
//!
//! The algorithm "works in a backward fashion, taking each triangle of the terrain data base and finding all the raster
//! points that see the triangle" (§6). Here the raster points are the stripe points, sorted by pixel in `bins`. A face
//! is projected onto the camera's SPP and clipped there, like a face of the camera's own map. Every point in *all*
//! pixels that the face touches is then tested at its own position: is it within the projected triangle, and is 1/t of
//! the face's plane larger there than the point's own?
//!
//! Why nothing slips between two faces: the row through a point cuts the sides of a face as any row of a map does
//! (`scan`), in an interval that leaves no gap to the neighbour's, whatever the rounding.
//!
//! With `place = paper` the pixel's centre is tested instead: see `printed_occlusion`.

use std::ops::Range;
use std::sync::atomic::{AtomicBool, Ordering};

use rayon::prelude::*;

use crate::bins::{BinnedPoint, Bins, ProjectedBounds};
use crate::occluders::{Occluder, Occluders};
use crate::perspective::StraightLine;
use crate::rounding::{RELATIVE_ROUNDING, longest_edges_product, max_vertex_distance};
use crate::scan::SplitTriangle;
use crate::spp::SppPoint;
use crate::spp::widen;
use crate::transformation::Transformation;

/// Number of clusters whose faces one task scans.
const CLUSTERS_PER_TASK: usize = 16;

/// Up to this many points in a row are all tested; of more, the triangle's span first narrows them down. Tuned: 4 to 64
/// are alike.
const MAX_POINTS_NOT_NARROWED: usize = 16;

/// Which of the binned points are hidden, in the order of [`Bins::points`].
///
/// With `skip_unseen` a face is tested only against points that it may hide. Without it, every face is tested against
/// every point, which takes long and gives the same.
pub(crate) fn hidden(occluders: &Occluders<'_>, bins: &Bins, skip_unseen: bool) -> Vec<bool> {
    let visit = |occluder: &Occluder, hidden: &[AtomicBool]| {
        let triangle = SplitTriangle::new(occluder.triangle.corners, occluder.triangle.lines);
        let test = |range: Range<usize>| {
            for (point, hidden) in bins.points()[range.clone()].iter().zip(&hidden[range]) {
                if !hidden.load(Ordering::Relaxed) && hides(occluders, occluder, &triangle, point) {
                    hidden.store(true, Ordering::Relaxed);
                }
            }
        };
        if !skip_unseen {
            test(0..bins.points().len());
            return;
        }
        for row_points in bins.rows_touched(&occluder.bounds) {
            let few = row_points.points.len() <= MAX_POINTS_NOT_NARROWED;
            test(if few { row_points.points } else { bins.narrow(row_points, &triangle) });
        }
    };
    scan_occluders(occluders, bins, skip_unseen, visit, |bounds| {
        !skip_unseen || bins.rows_touched(bounds).next().is_some()
    })
}

/// Calls `visit` with every occluder whose bounds are `relevant`, and with a flag per point; returns the flags. The
/// faces are visited in parallel. A flag is only ever set, so their order does not matter.
pub(crate) fn scan_occluders(
    occluders: &Occluders<'_>,
    bins: &Bins,
    skip_unseen: bool,
    visit: impl Fn(&Occluder, &[AtomicBool]) + Sync,
    relevant: impl Fn(&ProjectedBounds) -> bool + Sync,
) -> Vec<bool> {
    let hidden: Vec<AtomicBool> = bins.points().iter().map(|_| AtomicBool::new(false)).collect();
    if !hidden.is_empty() {
        let clusters = if skip_unseen { occluders.clusters(&relevant) } else { occluders.all_clusters() };
        clusters.par_chunks(CLUSTERS_PER_TASK).for_each(|clusters| {
            let transformed = occluders.transformed(clusters);
            for &face in &transformed.faces {
                let vertices = transformed.vertices_of(face);
                occluders.visit_face(face.id, vertices, &relevant, |occluder| visit(occluder, &hidden));
            }
        });
    }
    hidden.into_iter().map(AtomicBool::into_inner).collect()
}

/// Whether a face stands between a point and the SPP.
#[inline]
fn hides(
    occluders: &Occluders<'_>,
    occluder: &Occluder,
    triangle: &SplitTriangle<StraightLine>,
    point: &BinnedPoint,
) -> bool {
    let SppPoint { x, y } = point.on_spp;
    if y < triangle.top() || y > triangle.bottom() || point.face == occluder.face {
        return false;
    }
    let (left, right) = triangle.span(y);
    if x < left || x > right {
        return false;
    }
    // 1/t = n.q / d at q = (x, y, f_c). On the face it stays within the 1/t of its corners. This bound is the tighter
    // one where the face is seen edge-on, and it ensures t >= 1.
    let m = occluder.plane.normal_over_offset;
    let inverse_t = m.x * x + (m.y * y + m.z * occluders.camera.spp_distance());
    let inverse_t = inverse_t.max(occluder.min_inverse_t).min(occluder.bounds.max_inverse_t);
    inverse_t > point.inverse_t && !plane_contains(occluders, occluder, point, inverse_t)
}

/// Whether the plane of a face may contain the point, within rounding. By its 1/t the face is nearer than the point.
///
/// The point P is beyond the plane by n.P - d = d (1/t - 1/t_P) / (1/t_P). The error of this has two parts: that of n
/// and d, which grows with the distances of the vertices and of the point; and that of the point.
#[cold]
fn plane_contains(
    occluders: &Occluders<'_>,
    occluder: &Occluder,
    point: &BinnedPoint,
    inverse_t: f64,
) -> bool {
    let mesh = occluders.mesh;
    let vertices = mesh.faces()[occluder.face.0 as usize].map(|v| widen(mesh.vertices()[v as usize]));
    let lengths = max_vertex_distance(&vertices, occluders.camera.sensor_from_scene()) + point.distance;
    let error = RELATIVE_ROUNDING * longest_edges_product(&vertices) * lengths
        + point.error.bound_on_dot(occluder.plane.normal);
    let beyond = occluder.plane.offset.abs() * (inverse_t - point.inverse_t);
    !(beyond > error * point.inverse_t)
}

#[cfg(test)]
#[path = "../tests/unit/occlusion.rs"]
mod tests;
