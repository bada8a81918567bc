//! Step 5: which points of the stripes are hidden from the camera by terrain. (§3, step 5; §6)
//!
//! It "works in a backward fashion, taking each triangle of the terrain data base and finding all the raster
//! points that see the triangle" (§6). Here the points are those of the stripes, sorted by pixel (`bins`): a face
//! is projected onto the camera's SPP and clipped there like one of the camera's own map, the pixels it can touch
//! are scanned, *all* of each pixel, and every point in them is asked at its own place: is it within the projected
//! triangle, and is 1/t of the face's plane larger there than the point's own?
//!
//! Why nothing slips between two faces: the row through a point cuts the sides of a face like any row of a map
//! does (`scan`), in an interval that leaves no gap to the neighbour's, whatever rounding does.
//!
//! With `place = paper` the pixel's centre is asked instead: see `printed_occlusion`.

use std::ops::Range;
use std::sync::atomic::{AtomicBool, Ordering};

use rayon::prelude::*;
use raypencil_scene::FaceId;

use crate::bins::{Binned, Bins, Reach};
use crate::occluders::{Occluder, Occluders};
use crate::raster::Transformation;
use crate::rounding::{ROUNDING, farthest_corner, largest_product_of_sides};
use crate::scan::{Corner, SplitTriangle};
use crate::vertices::widen;

/// Faces that one task scans.
const FACES_PER_TASK: usize = 4096;

/// So many points in a row are asked sooner than where a face's sides cross the row. Tuned: 4 to 64 are alike.
const FEW_POINTS: usize = 16;

/// Which of the binned points are hidden, in the order of [`Bins::points`].
///
/// `skip_unseen`: meet only the points that a face can hide. Without it every point meets every face, which takes
/// long and gives the same.
pub(crate) fn hidden(occluders: &Occluders<'_>, bins: &Bins, skip_unseen: bool) -> Vec<bool> {
    let visit = |occluder: &Occluder, hidden: &[AtomicBool]| {
        let triangle = SplitTriangle::new(occluder.piece.corners, occluder.piece.lines);
        let ask = |range: Range<usize>| {
            for (point, hidden) in bins.points()[range.clone()].iter().zip(&hidden[range]) {
                if !hidden.load(Ordering::Relaxed) && hides(occluders, occluder, &triangle, point) {
                    hidden.store(true, Ordering::Relaxed);
                }
            }
        };
        if !skip_unseen {
            ask(0..bins.points().len());
            return;
        }
        for touched in bins.touched(&occluder.reach) {
            let few = touched.points.len() <= FEW_POINTS;
            ask(if few { touched.points } else { bins.narrowed(touched, &triangle) });
        }
    };
    scan(occluders, bins, visit, |reach| !skip_unseen || bins.touched(reach).next().is_some())
}

/// Calls `visit` with every occluder that concerns anybody and a flag per point. In parallel: a flag is only ever
/// set, so that it does not matter in which order.
pub(crate) fn scan(
    occluders: &Occluders<'_>,
    bins: &Bins,
    visit: impl Fn(&Occluder, &[AtomicBool]) + Sync,
    concerns: impl Fn(&Reach) -> bool + Sync,
) -> Vec<bool> {
    let hidden: Vec<AtomicBool> = bins.points().iter().map(|_| AtomicBool::new(false)).collect();
    if !hidden.is_empty() {
        (0..occluders.count()).into_par_iter().with_min_len(FACES_PER_TASK).for_each(|index| {
            occluders.pieces(FaceId(index as u32), &concerns, |occluder| visit(occluder, &hidden));
        });
    }
    hidden.into_iter().map(AtomicBool::into_inner).collect()
}

/// Whether a face stands between a point and the SPP.
#[inline]
fn hides(
    occluders: &Occluders<'_>,
    occluder: &Occluder,
    triangle: &SplitTriangle<crate::perspective::StraightLine>,
    point: &Binned,
) -> bool {
    let Corner { x, y } = point.at;
    if y < triangle.top() || y > triangle.bottom() || point.face == occluder.face {
        return false;
    }
    let (left, right) = triangle.span(y);
    if x < left || x > right {
        return false;
    }
    // 1/t = n.q / d at q = (x, y, f_c). Nowhere on the face is it beyond that of its corners, which says more
    // where the face is seen edge on, and that t >= 1.
    let m = occluder.plane.normal_over_distance;
    let inverse_t = m.x * x + (m.y * y + m.z * occluders.camera.plane_distance());
    let inverse_t = inverse_t.max(occluder.farthest).min(occluder.reach.nearest);
    inverse_t > point.inverse_t && !holds(occluders, occluder, point, inverse_t)
}

/// Whether the plane of a face that is nearer by its 1/t holds the point, for all that rounding can tell.
///
/// The point P is beyond the plane by n.P - d = d (1/t - 1/t_P) / (1/t_P), which is off by that error of n and d,
/// which comes with the distance of the corners and of the point, and by that of the point.
#[cold]
fn holds(occluders: &Occluders<'_>, occluder: &Occluder, point: &Binned, inverse_t: f64) -> bool {
    let mesh = occluders.mesh;
    let corners = mesh.faces()[occluder.face.0 as usize].map(|v| widen(mesh.vertices()[v as usize]));
    let reach = farthest_corner(&corners, occluders.camera.sensor_from_scene()) + point.distance;
    let error =
        ROUNDING * largest_product_of_sides(&corners) * reach + point.error.across(occluder.plane.normal);
    let beyond = occluder.plane.distance.abs() * (inverse_t - point.inverse_t);
    !(beyond > error * point.inverse_t)
}

#[cfg(test)]
#[path = "../tests/unit/occlusion.rs"]
mod tests;
