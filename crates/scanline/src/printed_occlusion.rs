//! §6 as printed: `extent = paper` and `place = paper`. (`facing = paper` is one line of `occluders`.)
//!
//! | switch | as printed | what it costs |
//! | --- | --- | --- |
//! | `extent` | "only considering triangles with a least one vertex not past the furthest extent of the upper laser beam" | shadows on points deeper than that; none on the upper beam's own: what hides a point is nearer than the point |
//! | `place` | "tracing the rays from each camera pixel [...] If the ray intersects the terrain at a point closer to the camera than the point on the line stripe the pixel intensity is zeroed" | up to half a pixel along the outlines of what hides, either way |
//!
//! **`place`.** The range map of the faces turned away is never kept: its nearest face is nearer than a point if
//! and only if some face is, so each face is asked at the centres of those pixels that hold points.
//!
//! CHOICE: what is compared is ranges, along the pixel's own ray and along the point's: it is a *range* raster map.
//! And the map knows no faces: one that is turned away from the camera's axis and yet shows the camera its front
//! may hide a stripe on itself.

use std::sync::atomic::Ordering;

use raypencil_scene::{Beam, Mounted};

use crate::bins::{Bins, Reach};
use crate::occluders::{Occluder, Occluders};
use crate::occlusion::scan;
use crate::points::StripePoint;
use crate::raster::Transformation;
use crate::scan::SplitTriangle;
use crate::vertices::SensorFromScene;

/// The "furthest extent of the upper laser beam": the greatest depth of its hits along the camera's axis, metres;
/// infinite if it has none, and so culls nothing.
///
/// CHOICE: the upper beam is the one whose origin is highest in the direction of the camera's image, of several the
/// last: a scene has no vehicle whose up it could be. And depth, not range, is what "past" means: it needs no square
/// root, and a face all of whose vertices are deeper than a point cannot hide it.
pub(crate) fn upper_extent(
    camera_from_scene: &SensorFromScene,
    beams: &[Mounted<Beam>],
    stripes: &[Vec<Option<StripePoint>>],
) -> f64 {
    // The camera's y is down.
    let height = |beam: &Mounted<Beam>| {
        -camera_from_scene.turn(camera_from_scene.relative(beam.scene_from_sensor.position)).y
    };
    // The last of equals, as `max_by` has it, -0 being equal to +0.
    let upper =
        beams.iter().zip(stripes).max_by(|(a, _), (b, _)| (height(a) + 0.0).total_cmp(&(height(b) + 0.0)));
    let depths = upper.iter().flat_map(|(_, points)| points.iter().flatten()).map(|point| point.depth);
    depths.reduce(f64::max).unwrap_or(f64::INFINITY)
}

/// Which of the binned points are hidden at the centres of their pixels, in the order of [`Bins::points`].
pub(crate) fn hidden_at_centres(occluders: &Occluders<'_>, bins: &Bins, skip_unseen: bool) -> Vec<bool> {
    let visit = |occluder: &Occluder, hidden: &[std::sync::atomic::AtomicBool]| {
        let camera = occluders.camera;
        let (x, y) = (camera.columns(), camera.rows());
        let triangle = SplitTriangle::new(occluder.piece.corners, occluder.piece.lines);
        // Step 4: the rows of the projected triangle.
        for j in y.first_at_or_after(triangle.top())..y.end_at_or_before(triangle.bottom()) {
            let (left, right) = triangle.span(y.centre(j));
            let columns = x.first_at_or_after(left)..x.end_at_or_before(right);
            if columns.is_empty() || bins.within(j, columns.clone()).is_empty() {
                continue;
            }
            // 1/t = n.q / d, affine along the row.
            let m = occluder.plane.normal_over_distance;
            let start = m.y * y.centre(j) + m.z * camera.plane_distance();
            for i in columns {
                // t >= 1: the face was clipped there, whichever way 1/t is rounded.
                let inverse_t = (m.x * x.centre(i) + start).min(1.0);
                if !(inverse_t > 0.0) {
                    continue;
                }
                let range = camera.q_lengths(j)[i as usize] / inverse_t;
                let points = bins.within(j, i..i + 1);
                for (point, hidden) in bins.points()[points.clone()].iter().zip(&hidden[points]) {
                    if range < point.distance {
                        hidden.store(true, Ordering::Relaxed);
                    }
                }
            }
        }
    };
    // A face between two pixels' centres is on no map: nearer than the points of a row is not asked, since that is
    // said of their own places.
    let concerns = |reach: &Reach| {
        !skip_unseen || bins.touched(&Reach { nearest: f64::INFINITY, ..*reach }).next().is_some()
    };
    scan(occluders, bins, visit, concerns)
}

#[cfg(test)]
#[path = "../tests/unit/printed_occlusion.rs"]
mod tests;
