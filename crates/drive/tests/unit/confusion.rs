use glam::{DVec2, DVec3};
use raypencil_rover::{Extraction, MapSize, OnVehicle, RadialGrid, Rig, Route};
use raypencil_scene::{Camera, Lens, Material, Mesh};

use super::*;

/// Ground at 0 up to x = 2.94 m and at 0.4 m from 2.96 to 4.53 m, where it ends. On a grid with a spacing of 0.1 m, the
/// points from x = 3.0 to 4.5 m lie on the step.
fn step() -> HeightIndex {
    let profile = [(-12.0, 0.0), (2.94, 0.0), (2.96, 0.4), (4.53, 0.4)];
    let vertices: Vec<DVec3> =
        profile.iter().flat_map(|&(x, z)| [DVec3::new(x, -12.0, z), DVec3::new(x, 12.0, z)]).collect();
    let faces: Vec<[u32; 3]> =
        (0..3).flat_map(|i| [[2 * i, 2 * i + 2, 2 * i + 3], [2 * i, 2 * i + 3, 2 * i + 1]]).collect();
    let materials = vec![Material { name: String::new(), reflectivity: 0.25 }];
    HeightIndex::new(&Mesh::from_global(&vertices, faces, vec![0; 6], materials).unwrap())
}

/// Plan whose grid has one sector straight ahead, with 44 points from 0.7 to 5.0 m.
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

/// Matrix of a map with these elevations, metres, at x in metres; `None` is unknown.
fn matrix(elevation: impl Fn(f64) -> Option<f64>) -> ConfusionMatrix {
    let mut map = ElevationMap::new(MapSize::default(), DVec2::ZERO);
    for point in map.points() {
        if let Some(z) = elevation(map.place(point).x) {
            map.set_proximity(point, z);
        }
    }
    let mut matrix = ConfusionMatrix::default();
    matrix.add(&map, &step(), &plan(), &Pose::IDENTITY);
    matrix
}

fn predicted(obstacle: u64, unknown: u64, clear: u64) -> Predicted {
    Predicted { obstacle, unknown, clear }
}

// True classes of the sector's points, by the position Q of the front axle's middle:
// * The slope from axle to axle is 0.4 / 1.2, more than 0.35 / 1.2, while the front axle is on the step and the rear
//   axle, 1.2 m behind, is not: Q from 3.0 to 4.1 m, 12 obstacle points, the first with index 23.
// * From Q = 4.6 to 5.0 m, 5 points, there is no ground below the front wheels.
// * The other 27 points are clear: 23 before the step and 4 on it.

#[test]
fn a_true_map_predicts_every_class() {
    let all = matrix(|x| (x < 4.55).then_some(if x > 2.95 { 0.4 } else { 0.0 }));
    assert_eq!((all.maps, all.off_ground, all.sectors, all.free_past_obstacle), (1, 5, 1, 0));
    assert_eq!((all.obstacle, all.clear), (predicted(12, 0, 0), predicted(0, 0, 27)));
}

#[test]
fn an_empty_map_leaves_every_point_unknown() {
    let nothing = matrix(|_| None);
    assert_eq!((nothing.obstacle, nothing.clear), (predicted(0, 12, 0), predicted(0, 27, 0)));
    assert_eq!((nothing.off_ground, nothing.free_past_obstacle), (5, 0));
}

#[test]
fn a_map_without_the_step_misses_it_and_is_free_past_it() {
    let flat = matrix(|_| Some(0.0));
    assert_eq!((flat.obstacle, flat.clear), (predicted(0, 0, 12), predicted(0, 0, 27)));
    assert_eq!((flat.off_ground, flat.free_past_obstacle), (5, 1));
}

#[test]
fn ground_that_a_step_hides_is_unknown() {
    // The map is known only before the step: from Q = 3.0 m on, the ground of the front wheels is unknown, and no test
    // fails.
    let before = matrix(|x| (x < 2.95).then_some(0.0));
    assert_eq!((before.obstacle, before.clear), (predicted(0, 12, 0), predicted(0, 4, 23)));
    assert_eq!(before.free_past_obstacle, 0);
}

#[test]
fn a_step_in_the_wrong_place_is_missed_at_one_end_and_false_at_the_other() {
    // 0.3 m too far, the obstacle is from 3.3 to 4.4 m: 3.0 to 3.2 m are missed and 4.2 to 4.4 m are false. The sector
    // is free up to 3.2 m, two steps past the obstacle.
    let far = matrix(|x| Some(if x > 3.25 { 0.4 } else { 0.0 }));
    assert_eq!((far.obstacle, far.clear), (predicted(9, 0, 3), predicted(3, 0, 24)));
    assert_eq!(far.free_past_obstacle, 1);
    // 0.2 m too far: free up to 3.1 m, one step past the obstacle, which is allowed.
    let near = matrix(|x| Some(if x > 3.15 { 0.4 } else { 0.0 }));
    assert_eq!(
        (near.obstacle, near.clear, near.free_past_obstacle),
        (predicted(10, 0, 2), predicted(2, 0, 25), 0)
    );
}

#[test]
fn a_vehicle_with_a_wrong_position_is_judged_at_its_estimated_position() {
    // The map is right and the estimated position is x = 1 m: the true classes are those of Q from 1.7 to 6.0 m. As
    // before, 12 points are at the step and 4 on it; 13 are before it; 15, from 4.6 to 6.0 m, are off the ground.
    let mut map = ElevationMap::new(MapSize::default(), DVec2::ZERO);
    for point in map.points() {
        let x = map.place(point).x;
        map.set_proximity(point, if x > 2.95 { 0.4 } else { 0.0 });
    }
    let mut matrix = ConfusionMatrix::default();
    matrix.add(&map, &step(), &plan(), &Pose::from_position(DVec3::X));
    assert_eq!(
        (matrix.obstacle, matrix.clear, matrix.off_ground),
        (predicted(12, 0, 0), predicted(0, 0, 17), 15)
    );
}

#[test]
fn percentages_are_0_and_100_only_for_none_and_all() {
    let parts = [(0, 7), (1, 10_000), (1, 1000), (5, 100), (99, 100), (9_999, 10_000), (3, 3), (0, 0)];
    let words = parts.map(|(part, all)| percent(part, all));
    assert_eq!(words, ["0 %", "< 0.1 %", "0.1 %", "5.0 %", "99 %", "99.9 %", "100 %", "0 %"]);
}
