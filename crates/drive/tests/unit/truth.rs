use glam::DVec3;

use super::*;
use raypencil_rover::{Extraction, MapSize, OnVehicle, RadialGrid, Rig, Route};
use raypencil_scene::{Camera, Lens, Material, Mesh};
use raypencil_scene_io::{Overrides, load};

/// Ground at 0 up to x = 2.94 m and at 0.4 m from 2.96 to 4.53 m, where it ends: of grid points 0.1 m apart, those from
/// x = 3.0 to 4.5 m stand on the step.
fn step() -> HeightIndex {
    let profile = [(-12.0, 0.0), (2.94, 0.0), (2.96, 0.4), (4.53, 0.4)];
    let vertices: Vec<DVec3> =
        profile.iter().flat_map(|&(x, z)| [DVec3::new(x, -12.0, z), DVec3::new(x, 12.0, z)]).collect();
    let faces: Vec<[u32; 3]> =
        (0..3).flat_map(|i| [[2 * i, 2 * i + 2, 2 * i + 3], [2 * i, 2 * i + 3, 2 * i + 1]]).collect();
    let materials = vec![Material { name: String::new(), reflectivity: 0.25 }];
    HeightIndex::new(&Mesh::from_global(&vertices, faces, vec![0; 6], materials).unwrap())
}

/// One sector straight ahead, of 44 points from 0.7 to 5.0 m.
fn plan() -> DrivePlan {
    let camera = Camera {
        width: 8,
        height: 8,
        pixel_pitch: [9e-6; 2],
        focal_length: 8e-3,
        principal_point: [4.0; 2],
        aperture: 2e-3,
        lens: Lens::CLEAR,
        max_range: 20.0,
    };
    let rig =
        Rig { camera: OnVehicle { vehicle_from_sensor: Pose::IDENTITY, sensor: camera }, beams: Vec::new() };
    let route = Route::through(DVec2::ZERO, vec![DVec2::X]);
    let plan = DrivePlan::new(rig, route, Extraction::thresholding(1.0));
    DrivePlan { grid: RadialGrid { sectors: 1, ..plan.grid }, ..plan }
}

/// The matrix of a map that holds these elevations at these x.
fn matrix(elevation: impl Fn(f64) -> Option<f64>) -> TruthMatrix {
    let mut map = ElevationMap::new(MapSize::default(), DVec2::ZERO);
    for point in map.points() {
        if let Some(z) = elevation(map.place(point).x) {
            map.set_proximity(point, z);
        }
    }
    let mut matrix = TruthMatrix::default();
    matrix.add(&map, &step(), &plan(), &Pose::IDENTITY);
    matrix
}

fn said(obstacle: u64, unknown: u64, clear: u64) -> Said {
    Said { obstacle, unknown, clear }
}

// In truth: axle to axle rises 0.4 over 1.2 m, more than 0.35 over 1.2 m, while the front axle is on the step and the rear
// one, 1.2 m behind, is not: Q from 3.0 to 4.1 m, 12 obstacle points, the first of index 23. Of the other 32, Q from 4.6
// to 5.0 m, 5 points, has no ground below its front wheels; 27 are clear, 23 before the step and 4 on it.

#[test]
fn a_map_that_is_the_truth_finds_it_all() {
    let all = matrix(|x| (x < 4.55).then_some(if x > 2.95 { 0.4 } else { 0.0 }));
    assert_eq!((all.maps, all.beyond, all.sectors, all.past), (1, 5, 1, 0));
    assert_eq!((all.obstacle, all.clear), (said(12, 0, 0), said(0, 0, 27)));
}

#[test]
fn a_map_that_knows_nothing_leaves_all_unknown() {
    let nothing = matrix(|_| None);
    assert_eq!((nothing.obstacle, nothing.clear), (said(0, 12, 0), said(0, 27, 0)));
    assert_eq!((nothing.beyond, nothing.past), (5, 0));
}

#[test]
fn a_map_without_the_step_misses_it_and_drives_on() {
    let flat = matrix(|_| Some(0.0));
    assert_eq!((flat.obstacle, flat.clear), (said(0, 0, 12), said(0, 0, 27)));
    assert_eq!((flat.beyond, flat.past), (5, 1));
}

#[test]
fn what_a_step_hides_is_unknown() {
    // Known before the step only: from Q = 3.0 m on the front wheels are unknown, and no test fails.
    let before = matrix(|x| (x < 2.95).then_some(0.0));
    assert_eq!((before.obstacle, before.clear), (said(0, 12, 0), said(0, 4, 23)));
    assert_eq!(before.past, 0);
}

#[test]
fn a_step_in_the_wrong_place_is_missed_here_and_false_there() {
    // 0.3 m farther: obstacle from 3.3 to 4.4 m. 3.0 to 3.2 are missed, 4.2 to 4.4 false; free up to 3.2 m, two steps past.
    let far = matrix(|x| Some(if x > 3.25 { 0.4 } else { 0.0 }));
    assert_eq!((far.obstacle, far.clear), (said(9, 0, 3), said(3, 0, 24)));
    assert_eq!(far.past, 1);
    // 0.2 m farther: free up to 3.1 m, past by a step and no more.
    let near = matrix(|x| Some(if x > 3.15 { 0.4 } else { 0.0 }));
    assert_eq!((near.obstacle, near.clear, near.past), (said(10, 0, 2), said(2, 0, 25), 0));
}

#[test]
fn a_vehicle_that_is_wrong_of_its_place_is_judged_where_it_believes_to_be() {
    // The map is right, and the vehicle believes to be at x = 1 m: the truth is that of there. Q from 1.7 to 6.0 m: 12 points
    // at the step as before; before it 13, and on it 4 as before; 4.6 to 6.0 m, 15 points, off the ground.
    let mut map = ElevationMap::new(MapSize::default(), DVec2::ZERO);
    for point in map.points() {
        let x = map.place(point).x;
        map.set_proximity(point, if x > 2.95 { 0.4 } else { 0.0 });
    }
    let mut matrix = TruthMatrix::default();
    matrix.add(&map, &step(), &plan(), &Pose::from_position(DVec3::X));
    assert_eq!((matrix.obstacle, matrix.clear, matrix.beyond), (said(12, 0, 0), said(0, 0, 17), 15));
}

#[test]
fn shares_are_neither_none_nor_all_unless_they_are() {
    let shares = [(0, 7), (1, 10_000), (1, 1000), (5, 100), (99, 100), (9_999, 10_000), (3, 3), (0, 0)];
    let words = shares.map(|(part, all)| percent(part, all));
    assert_eq!(words, ["0 %", "< 0.1 %", "0.1 %", "5.0 %", "99 %", "99.9 %", "100 %", "0 %"]);
}

#[test]
fn noise_levels_are_plans_that_can_be_driven() {
    let loaded = load("pyramids", &Overrides::default()).unwrap();
    let job = DriveJob::new(&loaded, None, "pyramids".into()).unwrap();
    for level in NoiseLevel::ALL {
        let noisy = level.applied(job.clone());
        noisy.plan.validate("drive").unwrap();
        assert_eq!(noisy.plan.rules.gaps, None);
        // 1 % of the way at 0.3 m/s is 3 mm a second.
        let drift = noisy.plan.errors.position_drift.length();
        let expected = [0.0, 0.003, 0.012][level as usize];
        assert!((drift - expected).abs() < 1e-15, "{}", level.word());
    }
    assert_eq!(NoiseLevel::None.applied(job.clone()).plan, job.plan);
}
