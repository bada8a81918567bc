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
mod tests {
    use glam::DVec3;
    use raypencil_scene::{FaceId, Pixel, Pose};

    use super::*;
    use crate::fixtures::{beam, camera, mesh};
    use crate::occluders::Facing;
    use crate::perspective::Perspective;
    use crate::points::{Landing, Pixels};
    use crate::rounding::PointError;
    use crate::scan::Corner;
    use crate::tables::CameraTables;

    fn point(depth: f64) -> Option<StripePoint> {
        Some(StripePoint {
            face: FaceId(0),
            range: 1.0,
            cos_incidence: 1.0,
            cos_view: 1.0,
            depth,
            distance: 1.0,
            cos_off_axis: 1.0,
            sin_squared: 0.0,
            landing: None,
            error: PointError { along: DVec3::ZERO, anywhere: 0.0 },
        })
    }

    #[test]
    fn a_face_deeper_than_a_point_may_be_nearer_at_the_centre_of_its_pixel() {
        // The point is at (0.24, 0.24) of pixel (4, 4), whose centre is (0.125, 0.125), at z = 2: 2.112 m away. At the
        // centre a wall at z = 2.05 is 2.082 m away, one at 2.1 is 2.133 m.
        let (x, z) = (0.24_f64, 2.0);
        let distance = z * (1.0 + 2.0 * x * x).sqrt();
        let landing = Landing { pixel: Pixel { i: 4, j: 4 }, at: Corner { x, y: x }, inverse_t: 1.0 / z };
        let point = StripePoint { distance, landing: Some(landing), ..point(z).unwrap() };
        let tables = CameraTables::of(&camera());
        let mounted = Mounted { scene_from_sensor: Pose::IDENTITY, sensor: camera() };
        let perspective = Perspective::new(&mounted, &tables);
        let bins = Bins::of(Pixels::of(&camera()), [Some(&point)].into_iter());
        for (wall, is_hidden) in [(2.05, true), (2.1, false)] {
            let ground = mesh(&[[[-9.0, -9.0, wall], [9.0, -9.0, wall], [0.0, 9.0, wall]]]);
            let occluders = Occluders::new(&ground, &perspective, Facing::Every, f64::INFINITY);
            for skip_unseen in [true, false] {
                assert_eq!(hidden_at_centres(&occluders, &bins, skip_unseen), [is_hidden], "{wall}");
            }
        }
    }

    #[test]
    fn the_upper_beam_is_the_last_of_the_highest() {
        let camera_from_scene = SensorFromScene::of(&Pose::IDENTITY);
        let at =
            |position: DVec3| Mounted { scene_from_sensor: Pose::from_position(position), sensor: beam() };
        let extent = |beams: [DVec3; 2]| {
            let stripes = [vec![point(3.0), None, point(5.0), point(4.0)], vec![point(7.0), point(6.0)]];
            upper_extent(&camera_from_scene, &beams.map(at), &stripes)
        };
        // The camera's y is down.
        let (low, high) = (DVec3::new(0.0, 1.0, 0.0), DVec3::new(0.0, -1.0, 0.0));
        assert_eq!((extent([high, low]), extent([low, high]), extent([low, low])), (5.0, 7.0, 7.0));
        // Heights of +0 and -0: seen from the camera, y of the first is -0 - 0 - 0, of the second +0.
        let (plus, minus) = (DVec3::new(-1.0, -0.0, -1.0), DVec3::new(1.0, 0.0, 1.0));
        assert_eq!((extent([plus, minus]), extent([minus, plus])), (7.0, 7.0));
        // No hit, no limit.
        let nothing = [vec![None], vec![point(6.0)]];
        assert_eq!(upper_extent(&camera_from_scene, &[at(high), at(low)], &nothing), f64::INFINITY);
    }
}
