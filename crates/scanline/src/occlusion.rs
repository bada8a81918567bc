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
mod tests {
    use super::*;
    use glam::DVec3;
    use raypencil_scene::{Beam, Camera, Lens, Mesh, Mounted, Pose, Profile, Quantities, SensorId};
    use raypencil_terrain::{BUILTIN_NAMES, RandomGround, builtin, height_at};

    use crate::cylindrical::Cylindrical;
    use crate::fixtures::{camera, mesh};
    use crate::occluders::Facing;
    use crate::perspective::Perspective;
    use crate::points::{self, Pixels};
    use crate::rounding::PointError;
    use crate::tables::CameraTables;
    use crate::{Options, Switches, bands};

    /// What is hidden of the default rig's stripes, its rasters four times coarser and 2 cm thick, if those faces
    /// occlude.
    fn hidden_by(mesh: &Mesh, facing: Facing) -> Vec<bool> {
        let z = height_at(mesh, 0.0, 0.0).expect("ground under the vehicle");
        let mount = |height: f64, pitch_down_deg: f64| {
            Pose::from_position(DVec3::new(0.3, 0.0, z + height) - mesh.origin())
                * Pose::from_axis_angle(DVec3::Y, pitch_down_deg.to_radians())
                * Pose::VEHICLE_FROM_FORWARD_SENSOR
        };
        let camera = Camera {
            width: 256,
            height: 256,
            pixel_pitch: [36e-6; 2],
            focal_length: 8e-3,
            principal_point: [128.0; 2],
            aperture: 2e-3,
            lens: Lens::CLEAR,
            max_range: 20.0,
        };
        let beam = Beam {
            columns: 256,
            rows: 4,
            thickness: 2e-2,
            grid_distance: 0.1,
            half_width: Beam::half_width_of(0.1, 60_f64.to_radians()),
            max_range: 20.0,
            power: 1.0,
            wavelength: 810e-9,
            profile: Profile::Paper,
        };
        let tables = CameraTables::of(&camera);
        let mounted = Mounted { scene_from_sensor: mount(1.5, 20.0), sensor: camera };
        let perspective = Perspective::new(&mounted, &tables);
        let pixels = Pixels::of(&camera);
        let mut stripes = Vec::new();
        for (height, down) in [(1.8, 31.0), (2.0, 22.0)] {
            let beam = Mounted { scene_from_sensor: mount(height, down), sensor: beam };
            let cylindrical = Cylindrical::new(&beam, Switches::EXACT);
            let of = SensorId::Beam(0);
            let map = bands::render(mesh, &cylindrical, of, Quantities::RANGE_MAP, Options::EXACT);
            let hits = map.face.expect("asked for");
            stripes.extend(points::of_beam(mesh, &cylindrical, &perspective, pixels, &hits));
        }
        let bins = Bins::of(pixels, stripes.iter().map(Option::as_ref));
        assert!(bins.points().len() > 500);
        hidden(&Occluders::new(mesh, &perspective, facing, f64::INFINITY), &bins, true)
    }

    /// Hills, rocks, mushrooms, floating slabs and walls: all of it closed.
    fn closed(seed: u64) -> RandomGround {
        RandomGround { slivers: 0, duplicate_faces: 0, zero_area_faces: 0, ..RandomGround::nasty(seed, 4000) }
    }

    #[test]
    fn a_face_holds_a_point_within_rounding_of_its_plane() {
        // Sides of 3, 4 and 5 m in the plane z = 2, d = -12 * 2 or 24; the farthest corner (3, 0, 2) or (0, 4, 2) is
        // sqrt 20 m from the camera.
        let ground = mesh(&[[[0.0, 0.0, 2.0], [3.0, 0.0, 2.0], [0.0, 4.0, 2.0]]]);
        let tables = CameraTables::of(&camera());
        let mounted = Mounted { scene_from_sensor: Pose::IDENTITY, sensor: camera() };
        let perspective = Perspective::new(&mounted, &tables);
        let occluders = Occluders::new(&ground, &perspective, Facing::Every, f64::INFINITY);
        let holds_at = |beyond: f64, error: PointError| {
            let mut answers = Vec::new();
            occluders.pieces(
                FaceId(0),
                |_| true,
                |occluder| {
                    // |d| (1/t - 1/t_P) / (1/t_P) = |d| beyond.
                    let inverse_t = 0.5;
                    let point = Binned {
                        at: Corner { x: 0.0, y: 0.0 },
                        inverse_t: inverse_t / (1.0 + beyond),
                        distance: 3.0,
                        error,
                        face: FaceId(1),
                        index: 0,
                    };
                    answers.push(holds(&occluders, occluder, &point, inverse_t));
                },
            );
            answers
        };
        let exact = PointError { along: DVec3::ZERO, anywhere: 0.0 };
        let bound = ROUNDING * 20.0 * (20_f64.sqrt() + 3.0) / 24.0;
        assert_eq!((holds_at(0.99 * bound, exact), holds_at(1.01 * bound, exact)), (vec![true], vec![false]));
        // And the point's own error, |n| = 12 times 1e-9 m: as much again as 1e-9 12 / 24.
        let inexact = PointError { along: DVec3::ZERO, anywhere: 1e-9 };
        assert_eq!((holds_at(4.99e-10, inexact), holds_at(5.01e-10, inexact)), (vec![true], vec![false]));
    }

    #[test]
    fn faces_turned_away_suffice_on_closed_ground() {
        // §6: "a ray from the camera to a stripe is occluded by the terrain if the ray passes through a triangle on
        // the back side of the terrain." True if the ground is closed, camera and laser are outside of it, the
        // camera is on the front side of the face hit, and facing is judged from the camera's position: the ray
        // starts outside and ends at a front from outside, so each time it goes in it must come out by a back.
        let grounds = (0..6).map(|seed| closed(seed).build());
        let mut count = 0;
        for ground in grounds.chain(BUILTIN_NAMES.iter().map(|name| builtin(name, 0.25).unwrap())) {
            let mesh = ground.into_mesh().unwrap();
            let hidden = hidden_by(&mesh, Facing::Every);
            assert_eq!(hidden, hidden_by(&mesh, Facing::AwayFromCamera));
            count += hidden.iter().filter(|hidden| **hidden).count();
        }
        assert!(count > 300, "{count}");
    }

    #[test]
    fn faces_turned_away_do_not_suffice_on_open_ground() {
        // With loose slivers, every second of which shows the camera its front.
        let differs = |seed| {
            let mesh = RandomGround { slivers: 600, ..closed(seed) }.build().into_mesh().unwrap();
            hidden_by(&mesh, Facing::Every) != hidden_by(&mesh, Facing::AwayFromCamera)
        };
        assert!((0..6).any(differs));
    }
}
