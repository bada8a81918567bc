//! §6 as printed: `extent = paper` and `place = paper`. (`facing = paper` is one line of `occluders`.)
//!
//! | switch | as printed | what it costs |
//! | --- | --- | --- |
//! | `extent` | "only considering triangles with a least one vertex not past the furthest extent of the upper laser beam" | shadows on points deeper than that extent. No shadow on the upper beam's own points is lost: what hides a point is nearer than the point |
//! | `place` | "tracing the rays from each camera pixel [...] If the ray intersects the terrain at a point closer to the camera than the point on the line stripe the pixel intensity is zeroed" | an error of up to half a pixel along the outlines of occluders, either way |
//!
//! **`place`.** The range map of the faces turned away is not stored. Its nearest face is nearer than a point if and
//! only if some face is. So each face is tested at the centres of those pixels that contain points.
//!
//! CHOICE: ranges are compared, along the pixel's own ray and along the point's, since the paper's map is a *range*
//! raster map. The map does not store faces. So a face that is turned away from the camera's axis, and yet shows the
//! camera its front, may hide a stripe on itself.

use std::sync::atomic::{AtomicBool, Ordering};

use raypencil_scene::{Beam, Mounted};

use crate::bins::{Bins, ProjectedBounds};
use crate::occluders::{Occluder, Occluders};
use crate::occlusion::scan_occluders;
use crate::points::StripePoint;
use crate::scan::SplitTriangle;
use crate::sensor_from_scene::SensorFromScene;
use crate::transformation::Transformation;

/// The "furthest extent of the upper laser beam": the greatest depth of its hits along the camera's axis, metres. It is
/// infinite, and culls nothing, if that beam has no hit.
///
/// CHOICE: the upper beam is the one whose origin is highest along the camera's vertical image axis; of several, the
/// last. (A scene has no vehicle that could define "up".) "Past" compares depth, not range: depth needs no square root,
/// and a face all of whose vertices are deeper than a point cannot hide it.
pub(crate) fn upper_extent(
    camera_from_scene: &SensorFromScene,
    beams: &[Mounted<Beam>],
    stripes: &[Vec<Option<StripePoint>>],
) -> f64 {
    // The camera's y axis points down.
    let height = |beam: &Mounted<Beam>| {
        -camera_from_scene.in_sensor_axes(camera_from_scene.offset_of(beam.scene_from_sensor.position)).y
    };
    // `max_by` returns the last of equals. Adding 0 makes -0 equal to +0.
    let upper =
        beams.iter().zip(stripes).max_by(|(a, _), (b, _)| (height(a) + 0.0).total_cmp(&(height(b) + 0.0)));
    let depths = upper.iter().flat_map(|(_, points)| points.iter().flatten()).map(|point| point.depth);
    depths.reduce(f64::max).unwrap_or(f64::INFINITY)
}

/// Which of the binned points are hidden at the centres of their pixels, in the order of [`Bins::points`].
pub(crate) fn hidden_at_centres(occluders: &Occluders<'_>, bins: &Bins, skip_unseen: bool) -> Vec<bool> {
    let visit = |occluder: &Occluder, hidden: &[AtomicBool]| {
        let camera = occluders.camera;
        let (x, y) = (camera.columns(), camera.rows());
        let triangle = SplitTriangle::new(occluder.triangle.corners, occluder.triangle.lines);
        // §4, step 4: the rows of the projected triangle.
        for j in y.first_at_or_after(triangle.top())..y.end_at_or_before(triangle.bottom()) {
            let (left, right) = triangle.span(y.centre(j));
            let columns = x.first_at_or_after(left)..x.end_at_or_before(right);
            if columns.is_empty() || bins.in_row(j, columns.clone()).is_empty() {
                continue;
            }
            // 1/t = n.q / d, affine along the row.
            let m = occluder.plane.normal_over_offset;
            let start = m.y * y.centre(j) + m.z * camera.spp_distance();
            for i in columns {
                // t >= 1, whichever way 1/t is rounded: the face was clipped there.
                let inverse_t = (m.x * x.centre(i) + start).min(1.0);
                if !(inverse_t > 0.0) {
                    continue;
                }
                let range = camera.q_lengths(j)[i as usize] / inverse_t;
                let points = bins.in_row(j, i..i + 1);
                for (point, hidden) in bins.points()[points.clone()].iter().zip(&hidden[points]) {
                    if range < point.distance {
                        hidden.store(true, Ordering::Relaxed);
                    }
                }
            }
        }
    };
    // The bins know the depth of points at their own positions, not at the pixels' centres. So no row is left out
    // because its points are nearer.
    let relevant = |bounds: &ProjectedBounds| {
        let at_any_depth = ProjectedBounds { max_inverse_t: f64::INFINITY, ..*bounds };
        !skip_unseen || bins.rows_touched(&at_any_depth).next().is_some()
    };
    scan_occluders(occluders, bins, skip_unseen, visit, relevant)
}

#[cfg(test)]
#[path = "../tests/unit/printed_occlusion.rs"]
mod tests;
