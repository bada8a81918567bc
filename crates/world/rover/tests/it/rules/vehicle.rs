//! The stance of a vehicle on planes and steps.

use glam::{DVec2, DVec3};
use raypencil_chassis::GroundFaces;
use raypencil_rover::{Attitude, Stance, Vehicle};
use raypencil_scene::Material;
use raypencil_terrain::{Ground, HeightIndex};

/// A square of 40 m around (0, 0) with z = height(x, y) at its corners, divided along x = y.
fn plane(height: impl Fn(f64, f64) -> f64) -> Ground {
    let corner = |x: f64, y: f64| DVec3::new(x, y, height(x, y));
    Ground {
        vertices: vec![corner(-20.0, -20.0), corner(20.0, -20.0), corner(20.0, 20.0), corner(-20.0, 20.0)],
        faces: vec![[0, 1, 2], [0, 2, 3]],
        face_materials: vec![0, 0],
        materials: vec![Material { name: "ground".into(), reflectivity: 0.25 }],
    }
}

fn settled(ground: Ground, heading: f64) -> Option<Stance> {
    let index = HeightIndex::new(&ground.into_mesh().unwrap());
    Vehicle::default().settle(&index, DVec2::new(1.0, 2.0), heading)
}

#[test]
fn on_level_ground_it_stands_level() {
    let stance = settled(plane(|_, _| 0.5), 0.7).unwrap();
    assert!((stance.position - DVec3::new(1.0, 2.0, 0.5)).length() < 1e-9);
    let Attitude { heading, pitch_down, roll_right } = stance.attitude;
    assert_eq!(heading, 0.7);
    assert!(pitch_down.abs() < 1e-9 && roll_right.abs() < 1e-9);
}

#[test]
fn it_stands_on_deep_ground_too() {
    let stance = settled(plane(|_, _| -10.0), 0.0).unwrap();
    assert!((stance.position - DVec3::new(1.0, 2.0, -10.0)).length() < 1e-9, "{stance:?}");
}

#[test]
fn on_a_slope_it_is_parallel_to_the_slope() {
    // z = 0.25 x. Driving up: pitch of atan 0.25, no roll. Driving across (heading +y): the right side is uphill and
    // up. The rim's 17 points miss the true contact by at most half their spacing, in height by (r / 17)^2 / (2 r) = r
    // / 578 = 0.6 mm, the same at every wheel.
    let rise = libm::atan(0.25);
    let up = settled(plane(|x, _| 0.25 * x), 0.0).unwrap();
    assert!((up.attitude.pitch_down + rise).abs() < 1e-6, "{up:?}");
    assert!(up.attitude.roll_right.abs() < 1e-9 && up.residual < 1e-9);
    assert!((up.position.z - 0.25).abs() < 1e-3, "{up:?}");
    let across = settled(plane(|x, _| 0.25 * x), std::f64::consts::FRAC_PI_2).unwrap();
    assert!((across.attitude.roll_right + rise).abs() < 1e-6, "{across:?}");
    assert!(across.attitude.pitch_down.abs() < 1e-9);
}

/// Level ground at 0, and a block 0.2 m high whose middle is at (x, y).
fn block_at(x: f64, y: f64) -> Ground {
    let mut ground = plane(|_, _| 0.0);
    let block = plane(|_, _| 0.2);
    let first = ground.vertices.len() as u32;
    ground.vertices.extend(block.vertices.iter().map(|v| *v + DVec3::new(x, y, 0.0)));
    ground.faces.extend(block.faces.iter().map(|face| face.map(|v| v + first)));
    ground.face_materials.extend([0, 0]);
    ground
}

#[test]
fn a_narrow_vehicle_stands_beside_a_block() {
    // The block begins at y = 2.5. The vehicle's middle is at y = 2; its left wheels reach from y = 2.375 to 2.425.
    let index = HeightIndex::new(&block_at(0.0, 22.5).into_mesh().unwrap());
    let narrow = Vehicle { track: 0.8, wheel_width: 0.05, ..Vehicle::default() };
    let stance = narrow.settle(&index, DVec2::new(1.0, 2.0), 0.0).unwrap();
    assert!(stance.position.z.abs() < 1e-9 && stance.attitude.roll_right.abs() < 1e-9, "{stance:?}");
    // Those of a track of 1.2 m are on the block. The vehicle leans by asin(0.2 / 1.2).
    let wide = Vehicle { track: 1.2, ..narrow };
    let stance = wide.settle(&index, DVec2::new(1.0, 2.0), 0.0).unwrap();
    assert!((stance.attitude.roll_right - libm::asin(0.2 / 1.2)).abs() < 1e-3, "{stance:?}");
}

#[test]
fn front_wheels_on_a_step_lift_the_nose() {
    // A block 0.2 m high begins at x = 1.3. The vehicle's centre is at x = 1.0; its hubs are at 1.6 and 0.4 while
    // level. It pitches up by asin(0.2 / 1.2), and the centre of the hubs rises by 0.1 m.
    let stance = settled(block_at(21.3, 0.0), 0.0).unwrap();
    assert!((stance.attitude.pitch_down + libm::asin(0.2 / 1.2)).abs() < 1e-3, "{stance:?}");
    // The origin is in the wheels' plane, r cos(pitch) below the centre of the hubs: a little less than r.
    assert!((stance.position.z - 0.1 - 0.35 * (1.0 - 35.0_f64.sqrt() / 6.0)).abs() < 1e-3);
}

#[test]
fn a_kerb_lifts_the_wheels_that_stand_on_it_alone() {
    // The vehicle's centre is at y = 2.0 and its track is 1.0 m: the left wheels are at y = 2.5, and end at 2.625 m. A
    // kerb 0.2 m high from y = 2.7 on is beside them. One from y = 2.3 on carries them: the right side is lower by
    // asin(0.2 / 1.0).
    let roll = |begin: f64| {
        let mut ground = plane(|_, _| 0.0);
        let kerb = plane(|_, _| 0.2);
        let first = ground.vertices.len() as u32;
        ground.vertices.extend(kerb.vertices.iter().map(|v| *v + DVec3::new(0.0, 20.0 + begin, 0.0)));
        ground.faces.extend(kerb.faces.iter().map(|face| face.map(|v| v + first)));
        ground.face_materials.extend([0, 0]);
        settled(ground, 0.0).unwrap().attitude.roll_right
    };
    assert!(roll(2.7).abs() < 1e-9, "{}", roll(2.7));
    assert!((roll(2.3) - libm::asin(0.2)).abs() < 1e-3, "{}", roll(2.3));
}

#[test]
fn beyond_the_ground_there_is_no_stance() {
    let index = HeightIndex::new(&plane(|_, _| 0.0).into_mesh().unwrap());
    assert!(Vehicle::default().settle(&index, DVec2::new(20.5, 0.0), 0.0).is_none());
}

#[test]
fn the_default_vehicle_is_valid_and_fields_out_of_range_are_named() {
    assert!(Vehicle::default().validate("vehicle").is_ok());
    let wide = Vehicle { wheel_width: 1.5, ..Vehicle::default() };
    assert!(wide.validate("vehicle").unwrap_err().to_string().starts_with("vehicle.wheel_width is 1.5"));
    // Wheels of more than half the wheelbase, 0.6 m, would touch.
    assert!(Vehicle { wheel_radius: 0.59, ..Vehicle::default() }.validate("vehicle").is_ok());
    assert!(Vehicle { wheel_radius: 0.61, ..Vehicle::default() }.validate("vehicle").is_err());
}

#[test]
fn an_attitude_is_heading_then_pitch_then_roll() {
    // R = R_z(h) R_y(p) R_x(r), multiplied out by hand: the columns are where x, y and z of the vehicle point.
    let (heading, pitch_down, roll_right) = (0.7, 0.3, -0.4);
    let ([sh, ch], [sp, cp], [sr, cr]) = (sin_cos(heading), sin_cos(pitch_down), sin_cos(roll_right));
    let pose = Attitude { heading, pitch_down, roll_right }.at(DVec3::new(3.0, -2.0, 1.0));
    assert_eq!(pose.position, DVec3::new(3.0, -2.0, 1.0));
    for (axis, expected) in [
        (DVec3::X, DVec3::new(ch * cp, sh * cp, -sp)),
        (DVec3::Y, DVec3::new(ch * sp * sr - sh * cr, sh * sp * sr + ch * cr, cp * sr)),
        (DVec3::Z, DVec3::new(ch * sp * cr + sh * sr, sh * sp * cr - ch * sr, cp * cr)),
    ] {
        assert!((pose.rotate(axis) - expected).length() < 1e-15, "{axis}: {}", pose.rotate(axis));
    }
}

fn sin_cos(angle: f64) -> [f64; 2] {
    let (sin, cos) = libm::sincos(angle);
    [sin, cos]
}

#[test]
fn on_a_plane_that_leans_both_ways_its_angles_are_the_planes() {
    // The plane rises by m along the heading and by n to the left of it. The vehicle's z axis is the normal, in the axes
    // of the heading (-m, -n, 1) / s with s = sqrt(1 + m^2 + n^2). R_y(p) R_x(r) turns z to (sin p cos r, -sin r,
    // cos p cos r): so tan p = -m and sin r = n / s. With roll before pitch it would be tan r = n and sin p = -m / s.
    let (p, q, heading) = (0.25, -0.375, 0.6);
    let [sin, cos] = sin_cos(heading);
    let (m, n) = (p * cos + q * sin, q * cos - p * sin);
    let s = (1.0 + m * m + n * n).sqrt();
    let place = DVec2::new(1.0, 2.0);
    let mesh = plane(|x, y| p * x + q * y).into_mesh().unwrap();
    let vehicle = Vehicle::default();
    let mended = vehicle.stand(&GroundFaces::new(&mesh), place, heading).unwrap();
    // The printed rule ends by iteration, as for one slope alone.
    let printed = vehicle.settle(&HeightIndex::new(&mesh), place, heading).unwrap();
    for (stance, tolerance) in [(mended, 1e-12), (printed, 1e-6)] {
        let Attitude { pitch_down, roll_right, .. } = stance.attitude;
        assert!((pitch_down + libm::atan(m)).abs() < tolerance, "{stance:?}");
        assert!((roll_right - libm::asin(n / s)).abs() < tolerance, "{stance:?}");
        let up = stance.pose().rotate(DVec3::Z);
        assert!((up - DVec3::new(-p, -q, 1.0).normalize()).length() < 2.0 * tolerance, "{up}");
    }
}
