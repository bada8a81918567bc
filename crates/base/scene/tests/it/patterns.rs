//! Patterns of range sensors against closed forms and the formulas of manuals.

use glam::{DQuat, DVec3};
use raypencil_scene::pattern::{
    Channel, Cone, Grid, Mounting, PatternRays, Spacing, Spinning, TimedPose, TimedPoses,
};
use raypencil_scene::{CastRay, NamedRaySet, Pose, Sides};

/// Whether two numbers are the same or neighbours.
fn is_within_an_ulp(a: f64, b: f64) -> bool {
    a == b || a.next_up() == b || a.next_down() == b
}

fn vlp_16() -> Spinning {
    Spinning::preset("vlp-16").unwrap()
}

#[test]
fn channel_0_of_a_vlp_16_looks_forward_and_15_degrees_down() {
    let pattern = vlp_16().rays("rays").unwrap();
    // cos 15 = (sqrt 6 + sqrt 2) / 4, sin 15 = (sqrt 6 - sqrt 2) / 4, to 17 digits.
    let d = pattern.rays[0].direction;
    assert!(is_within_an_ulp(d.x, 0.965_925_826_289_068_3) && d.y == 0.0, "{d}");
    assert!(is_within_an_ulp(d.z, -0.258_819_045_102_520_76), "{d}");
    // Its emitter is 11.2 mm above the origin.
    assert_eq!(pattern.rays[0].origin, DVec3::new(0.0, 0.0, 11.2e-3));
    assert_eq!((pattern.rays[0].t_min, pattern.rays[0].t_max), (0.0, 100.0));
    assert_eq!(pattern.rays[0].t_blind, 0.0);
}

#[test]
fn a_vlp_16_fires_in_the_order_and_at_the_times_of_its_manual() {
    let pattern = vlp_16().rays("rays").unwrap();
    let times = pattern.times.as_ref().unwrap();
    // TimeOffset = 55.296 us * sequence + 2.304 us * data point. (VLP-16 User Manual, section 9.4)
    for (sequence, point, microseconds) in
        [(0, 0, 0.0), (0, 1, 2.304), (0, 15, 34.56), (1, 0, 55.296), (23, 15, 1306.368)]
    {
        let time = times[sequence * 16 + point] * 1e6;
        assert!((time - microseconds).abs() < 1e-9, "{sequence} {point}: {time} us");
    }
    assert!(times.is_sorted());
    // Lower and upper half by turns, each from the bottom up.
    let elevations = pattern.elevations_deg.as_ref().unwrap();
    let expected = [-15, 1, -13, 3, -11, 5, -9, 7, -7, 9, -5, 11, -3, 13, -1, 15].map(f64::from);
    assert_eq!(elevations[..], expected);
    // At 10 Hz the head turns by 3600 degrees a second, clockwise, also within a sequence.
    for (index, ray) in pattern.rays.iter().enumerate().step_by(997) {
        let azimuth = libm::atan2(ray.direction.y, ray.direction.x).to_degrees();
        let turned = (-3600.0 * times[index] - azimuth).rem_euclid(360.0);
        assert!(turned.min(360.0 - turned) < 1e-9, "ray {index}: {azimuth} degrees");
    }
    assert!((vlp_16().rate_hz() - 10.0).abs() < 1e-12);
}

#[test]
fn directions_are_units_and_presets_have_their_counts() {
    let sets = [
        (Spinning::preset("vlp-16").unwrap().rays("a").unwrap(), [1808, 16]),
        (Spinning::preset("hdl-64e").unwrap().rays("a").unwrap(), [2083, 64]),
        (Spinning::preset("os1-64").unwrap().rays("a").unwrap(), [1024, 64]),
        (Grid::preset("l515").unwrap().rays("a").unwrap(), [768, 1024]),
    ];
    for (pattern, shape) in sets {
        assert_eq!(pattern.shape, shape);
        assert_eq!(pattern.rays.len() as u64, shape[0] * shape[1]);
        assert!(pattern.rays.iter().all(|ray| (ray.direction.length() - 1.0).abs() < 4e-16));
    }
    // A shortest range is no start of the rays.
    let mut os1 = Spinning::preset("os1-64").unwrap().rays("a").unwrap().rays.into_iter();
    assert!(os1.all(|ray| (ray.t_min, ray.t_blind, ray.t_max) == (0.0, 0.8, 120.0)));
    let mut l515 = Grid::preset("l515").unwrap().rays("a").unwrap().rays.into_iter();
    assert!(l515.all(|ray| (ray.t_min, ray.t_blind, ray.t_max) == (0.0, 0.25, 9.0)));
    // The ends of the nominal tables.
    let ends = |name: &str| {
        let channels = Spinning::preset(name).unwrap().channels;
        (channels[0].elevation_deg, channels[63].elevation_deg)
    };
    let (first, last) = ends("hdl-64e");
    assert!((first - 2.0).abs() < 1e-14 && (last + 73.0 / 3.0).abs() < 1e-14);
    assert_eq!(ends("os1-64"), (16.611, -16.611));
    let of_os1 = Spinning::preset("os1-64").unwrap().channels;
    let elevations: Vec<f64> = of_os1.iter().map(|channel| channel.elevation_deg).collect();
    assert_eq!(elevations[..4], [16.611, 16.084, 15.557, 15.029]);
    assert_eq!(elevations[28..36], [1.846, 1.318, 0.791, 0.264, -0.264, -0.791, -1.318, -1.846]);
    // The first column of an OS1 looks back, its first channel 3.164 degrees clockwise from there: back and to the left.
    let first = Spinning::preset("os1-64").unwrap().rays("a").unwrap().rays[0].direction;
    let (sin, cos) = libm::sincos(3.164_f64.to_radians());
    let level = libm::cos(16.611_f64.to_radians());
    assert!(
        (first - DVec3::new(-level * cos, level * sin, libm::sin(16.611_f64.to_radians()))).length() < 1e-15
    );
}

#[test]
fn emitters_stand_off_the_axis_to_the_left_of_their_beam() {
    let channel = Channel { lateral_m: 0.5, vertical_m: 0.25, ..Channel::at_elevation(0.0) };
    let head = Spinning {
        channels: vec![channel],
        azimuth_start_deg: 90.0,
        azimuth_step_deg: 90.0,
        steps: 2,
        period_s: 1.0,
        min_range_m: 0.0,
        max_range_m: 1.0,
    };
    let rays = head.rays("head").unwrap().rays;
    // Looking to the left (y), its left is -x; looking back (-x), its left is -y.
    assert_eq!((rays[0].direction, rays[0].origin), (DVec3::Y, DVec3::new(-0.5, 0.0, 0.25)));
    assert_eq!((rays[1].direction, rays[1].origin), (DVec3::NEG_X, DVec3::new(0.0, -0.5, 0.25)));
}

#[test]
fn corners_of_a_raster_are_at_the_ends_of_the_field_of_view() {
    let grid = Grid {
        columns: 5,
        rows: 3,
        width_deg: 120.0,
        height_deg: 60.0,
        spacing: Spacing::Angle,
        min_range_m: 0.0,
        max_range_m: 1.0,
    };
    // Azimuth 60 to the left, elevation 30 up: (cos 30 cos 60, cos 30 sin 60, sin 30).
    let (half, root) = (0.5, 0.75_f64.sqrt());
    let rays = grid.rays("grid").unwrap().rays;
    let corner = DVec3::new(root * half, root * root, half);
    for (index, signs) in [
        (0, DVec3::ONE),
        (4, DVec3::new(1.0, -1.0, 1.0)),
        (10, DVec3::new(1.0, 1.0, -1.0)),
        (14, DVec3::new(1.0, -1.0, -1.0)),
    ] {
        assert!((rays[index].direction - corner * signs).length() < 4e-16, "{index}");
    }
    assert_eq!(rays[7].direction, DVec3::X);
    // Equal steps of angle: column 1 is at 30 degrees.
    assert!((rays[6].direction - DVec3::new(root, half, 0.0)).length() < 4e-16);
    // Equal steps of the tangent: column 1 is half-way on the plane x = 1.
    let flat = Grid { spacing: Spacing::Tangent, ..grid }.rays("grid").unwrap().rays;
    let d = flat[6].direction;
    assert!((d.y / d.x - 0.5 * 3.0_f64.sqrt()).abs() < 4e-16 && d.z == 0.0);
    // A single row and column is in the middle.
    let single = Grid { columns: 1, rows: 1, ..grid }.rays("grid").unwrap().rays;
    assert_eq!(single[0].direction, DVec3::X);
}

#[test]
fn a_cone_has_its_edge_at_half_its_divergence_and_weights_of_1() {
    let direction = DVec3::new(3.0, -4.0, 12.0);
    let pattern = PatternRays {
        shape: vec![1],
        rays: vec![CastRay::new(DVec3::ONE, direction)],
        times: Some(vec![0.25]),
        weights: None,
        returns: None,
        elevations_deg: None,
        mounting: Mounting::HERE,
    };
    for (rings, count) in [(1, 7), (2, 19), (3, 37)] {
        let cone = Cone { divergence_rad: 0.2, rings };
        let spread = cone.spread(&pattern, "cone").unwrap();
        assert_eq!((spread.shape, spread.rays.len()), (vec![1, count], count as usize));
        assert_eq!(spread.times, Some(vec![0.25; count as usize]));
        // The middle is the ray itself; the last ring is at 0.1 rad; all keep the length 13.
        assert_eq!(spread.rays[0], pattern.rays[0]);
        for ray in &spread.rays[count as usize - 6 * rings as usize..] {
            let angle = libm::atan2(ray.direction.cross(direction).length(), ray.direction.dot(direction));
            assert!((angle - 0.1).abs() < 1e-15, "{angle}");
            assert!((ray.direction.length() - 13.0).abs() < 1e-14);
        }
        let weights = spread.weights.unwrap();
        assert_eq!(weights.len(), count as usize);
        assert!((weights.iter().sum::<f64>() - 1.0).abs() < 1e-15);
        assert!(weights.iter().all(|&weight| weight > 0.0));
    }
    // Very short and very long directions keep their lengths too.
    for size in [1e-200, 1e20] {
        let rays = vec![CastRay::new(DVec3::ZERO, DVec3::X * size)];
        let cone = Cone { divergence_rad: 0.2, rings: 1 };
        let spread = cone.spread(&PatternRays { rays, ..pattern.clone() }, "cone").unwrap();
        assert!((spread.rays[1].direction.x / size - libm::cos(0.1)).abs() < 1e-15, "{size}");
        assert!((spread.rays[1].direction / size - DVec3::X).length() > 0.09, "{size}");
    }
    // One ring: the middle has the disc up to half the half angle, (1 - exp(-1/2)) / (1 - exp(-2)).
    let weights = Cone { divergence_rad: 0.2, rings: 1 }.weights();
    assert!((weights[0] - 0.455_054_233_9).abs() < 1e-9, "{}", weights[0]);
}

#[test]
fn a_head_at_constant_velocity_fires_each_ray_from_where_it_is() {
    let head = vlp_16();
    let (start, velocity) = (DVec3::new(10.0, -2.0, 1.5), DVec3::new(8.0, 0.5, -0.25));
    let at = |time_s: f64| TimedPose { time_s, pose: Pose::from_position(start + velocity * time_s) };
    let poses = TimedPoses::new(vec![at(0.0), at(0.04), at(0.1)], "poses").unwrap();
    let still = head.rays("head").unwrap();
    let moved = Mounting::Moving(poses).place(still.clone(), "head").unwrap();
    for (k, &time) in moved.times.as_ref().unwrap().iter().enumerate() {
        let expected = start + velocity * time + still.rays[k].origin;
        assert!((moved.rays[k].origin - expected).length() < 1e-14, "ray {k}");
        assert_eq!(moved.rays[k].direction, still.rays[k].direction);
    }
    // A firing time without a pose is named.
    let short = TimedPoses::new(vec![at(0.0), at(0.05)], "poses").unwrap();
    let error = Mounting::Moving(short).place(still, "rays 0").unwrap_err().to_string();
    // The last firings within 50 ms are of sequence 904, at 49.987584 ms + 2.304 us * point. Point 6 is at 50.001408 ms.
    assert_eq!(
        error.split_once(" is ").map(|(field, _)| field.to_string()),
        Some(format!("rays 0: time of ray {}", 904 * 16 + 6))
    );
    assert!(error.ends_with("expected 0 to 0.05 s, the times of its poses"), "{error}");
}

#[test]
fn orientations_turn_on_the_shorter_arc_at_a_constant_rate() {
    let turned = |time_s: f64, angle: f64, sign: f64| {
        let pose = Pose::from_axis_angle(DVec3::Z, angle);
        let q = pose.rotation;
        let rotation = DQuat::from_xyzw(sign * q.x, sign * q.y, sign * q.z, sign * q.w);
        TimedPose { time_s, pose: Pose { rotation, ..pose } }
    };
    // Both signs of a quaternion are the same rotation.
    for sign in [1.0, -1.0] {
        let poses = TimedPoses::new(vec![turned(0.0, 0.0, 1.0), turned(1.0, 2.0, sign)], "poses").unwrap();
        for share in [0.0, 0.125, 0.5, 0.875, 1.0] {
            let x = poses.at(share).unwrap().rotate(DVec3::X);
            let (sin, cos) = libm::sincos(2.0 * share);
            assert!((x - DVec3::new(cos, sin, 0.0)).length() < 1e-15, "{share}: {x}");
        }
    }
    // Nearly the same orientation.
    let poses = TimedPoses::new(vec![turned(0.0, 0.0, 1.0), turned(1.0, 1e-12, 1.0)], "poses").unwrap();
    let y = poses.at(0.25).unwrap().rotate(DVec3::X).y;
    assert!((y - 0.25e-12).abs() < 1e-27, "{y}");
}

#[test]
fn what_is_no_pattern_is_named() {
    let message = |head: Spinning| head.rays("rays 0").unwrap_err().to_string();
    assert_eq!(
        message(Spinning { steps: 1_000_000_000_000, ..vlp_16() }),
        "rays 0.steps is 1000000000000: expected 1 to 100000000"
    );
    assert_eq!(
        message(Spinning { steps: 100_000_000, ..vlp_16() }),
        "rays 0: number of rays is 1600000000: expected 0 to 100000000"
    );
    assert_eq!(
        message(Spinning { azimuth_step_deg: f64::NAN, ..vlp_16() }),
        "rays 0.azimuth_step is NaN: expected -360 to 360 degrees"
    );
    assert_eq!(
        message(Spinning { channels: vec![], ..vlp_16() }),
        "rays 0.channels is 0: expected 1 to 1024"
    );
    let at = |time_s: f64| TimedPose { time_s, pose: Pose::IDENTITY };
    let refused = |poses| TimedPoses::new(poses, "poses").unwrap_err().to_string();
    assert_eq!(refused(vec![]), "poses is empty: expected at least one pose");
    assert_eq!(
        refused(vec![at(0.0), at(1.0), at(1.0)]),
        "poses[2].time is 1 s: expected more than 1 s, the time before it"
    );
    let cone = Cone { divergence_rad: 0.1, rings: u64::MAX };
    let pattern = vlp_16().rays("rays").unwrap();
    let error = cone.spread(&pattern, "cone").unwrap_err().to_string();
    assert_eq!(error, format!("cone.rings is {}: expected 1 to 64", u64::MAX));
    for name in ["", "A", "a b", "a/b", "..", &"a".repeat(65)] {
        assert!(NamedRaySet::new(name, pattern.clone(), Sides::Both).is_err(), "{name}");
    }
}
