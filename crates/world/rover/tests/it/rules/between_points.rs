//! What a cell keeps of a frame's points, and what may stand where no stripe came.

use glam::{DVec2, DVec3};
use raypencil_rover::{
    Attitude, ElevationMap, ErrorMargins, GridPoint, LocalisationReading, MapPoint, MapRules, MapSize,
    MapWithShadows, Mapper, Missing, MissingReason, StripePoint, Traversability, TraversabilityRules,
    Vehicle,
};

/// Measured cells where `z` gives an elevation.
fn ground(z: impl Fn(i64, i64) -> Option<f64>) -> ElevationMap {
    let mut map =
        ElevationMap::with_rules(MapSize { spacing: 0.1, points: 81 }, DVec2::ZERO, MapRules::MENDED);
    let points: Vec<DVec3> =
        map.points().filter_map(|point| Some(map.place(point).extend(z(point.i, point.j)?))).collect();
    map.insert(points);
    map
}

/// The default vehicle with heading +x and its front axle at (1, 0) m, without margins.
fn judge(map: &ElevationMap) -> Traversability {
    let margins = ErrorMargins { obstacle: 0.0, clear: 0.0 };
    let rules = TraversabilityRules { margins, ..TraversabilityRules::for_vehicle(&Vehicle::default()) };
    rules.classify(&MapWithShadows::of(map), &Vehicle::default(), DVec2::new(1.0, 0.0), DVec2::X)
}

fn may_hide(said: Traversability) -> bool {
    matches!(said, Traversability::Unknown(Missing { reason: MissingReason::MayHide, .. }))
}

#[test]
fn the_mean_of_a_frames_points_stands_for_a_cell_and_a_wheel_rests_on_the_highest() {
    // Four points at one elevation but for their errors of 1 cm: the mean is 0.34 m, at the mean of their places.
    let mut map = ground(|i, j| Some(if (9..=11).contains(&i) && (4..=6).contains(&j) { 0.33 } else { 0.0 }));
    map.clear();
    let z = [0.33, 0.36, 0.345, 0.325];
    map.insert(z.iter().enumerate().map(|(n, z)| DVec3::new(0.98 + 0.01 * n as f64, 0.5, *z)));
    let sample = map.sample(GridPoint { i: 10, j: 5 }).unwrap();
    assert!((sample - DVec3::new(0.995, 0.5, 0.34)).length() < 1e-12, "{sample}");
    // Beside a step the points below it do not count: the foot of a wall is no part of its top.
    map.clear();
    map.insert([DVec3::new(1.0, 0.5, 0.4), DVec3::new(1.01, 0.5, 0.4), DVec3::new(1.0, 0.5, 0.0)]);
    let sample = map.sample(GridPoint { i: 10, j: 5 }).unwrap();
    assert!((sample - DVec3::new(1.005, 0.5, 0.4)).length() < 1e-12, "{sample}");
}

#[test]
fn a_vehicle_does_not_climb_by_the_errors_of_its_points() {
    // Level ground, measured with errors of 1 cm either way, in each cell several points of each frame, 3 m and more. The
    // highest of a cell would lie 1 cm above the ground, and each frame would put the next ones on top of it.
    let level = |x: f64| LocalisationReading {
        position: DVec2::new(x, 0.0),
        attitude: Attitude::default(),
        proximity: None,
    };
    let mut mapper =
        Mapper::with_rules(Vehicle::default(), MapSize::default(), MapRules::MENDED, &level(0.0), 0.0);
    let random = raypencil_scene::Sampling::Jittered { seed: 3 };
    for frame in 0..60_u32 {
        let stripe = |ahead: f64, beam: usize| {
            (-60..=60_i32).map(move |n| {
                let [error, _] = random.offset(beam, frame, (n + 60) as u32);
                StripePoint::from(DVec3::new(ahead, 0.02 * f64::from(n), 0.02 * error))
            })
        };
        mapper.update(&level(0.05 * f64::from(frame)), stripe(3.3, 0).chain(stripe(5.25, 1)));
    }
    let risen = mapper.pose().position.z;
    assert!(risen.abs() < 0.003, "{risen}");
}

#[test]
fn a_stone_whose_top_lies_between_two_stripes_may_be_higher_than_all_that_was_measured() {
    // Under the left front wheel a ridge across the way, met at 0.31 m on both flanks, which rise by 0.06 m over the 0.1 m before
    // it: they meet 0.03 m higher, half way. 0.34 m passes the limit of 0.35 m, and from 0.33 m on, 0.36 m, may not.
    let ridge = |top: f64| {
        move |i: i64, j: i64| {
            let flank = |n: f64| Some(top - 0.06 * n);
            match i {
                _ if j <= 0 => Some(0.0),
                10 | 11 => flank(0.0),
                9 | 12 => flank(1.0),
                8 | 13 => flank(2.0),
                _ => flank(3.0),
            }
        }
    };
    // The axle is over (1, 0): 5 cm before the ridge's line the wheel's hub is at z + sqrt(0.35^2 - 0.05^2), 3.6 mm less.
    assert_eq!(judge(&ground(ridge(0.31))), Traversability::Clear);
    assert!(may_hide(judge(&ground(ridge(0.33)))), "{:?}", judge(&ground(ridge(0.33))));
    // The lines before and behind a level step of that height never meet.
    let step = |i: i64, j: i64| Some(if i >= 10 && j > 0 { 0.33 } else { 0.0 });
    assert_eq!(judge(&ground(step)), Traversability::Clear);
    // As a plane of the same slope is.
    assert_eq!(judge(&ground(|i, _| Some(0.028 * i as f64))), Traversability::Clear);
    // Over a gap of one cell, in which the ridge's line lies, likewise.
    let gap = |i: i64, j: i64| match i {
        _ if j <= 0 => Some(0.0),
        10 => None,
        _ => Some(0.36 - 0.06 * (i - 10).abs() as f64),
    };
    assert!(may_hide(judge(&ground(gap))), "{:?}", judge(&ground(gap)));
}

#[test]
fn what_may_hide_under_the_lower_side_does_not_lift_it() {
    // Such a ridge under both sides of the vehicle, 0.33 m higher on the left. If both have a top that was not met, the rise stays
    // 0.33 m; if only the left one has, it is 0.356 m.
    let map = ground(|i, j| {
        let ridge = -0.06 * ((2 * i - 21).abs() - 1).min(6) as f64 / 2.0;
        Some(ridge + if j > 0 { 0.33 } else { 0.0 })
    });
    assert!(may_hide(judge(&map)), "{:?}", judge(&map));
}

#[test]
fn the_edge_of_a_plateau_between_two_stripes_may_carry_a_wheel() {
    // On the left a plateau 0.355 m high, whose edge is at y = 0.61 m, with a slope of 1 from there to level ground at 0. The straight
    // line from y = 0.7 to 0.6 m enters the left wheels, at y = 0.625 m, 7.5 mm below the plateau: 0.3475 m passes the limit of 0.35 m.
    let plateau = |_: i64, j: i64| Some((0.355 - (0.61 - 0.1 * j as f64).max(0.0)).max(0.0));
    assert!(may_hide(judge(&ground(plateau))), "{:?}", judge(&ground(plateau)));
    // A plateau 6 mm lower passes as a whole.
    let lower = |i: i64, j: i64| plateau(i, j).map(|z| (z - 0.006).max(0.0));
    assert_eq!(judge(&ground(lower)), Traversability::Clear);
}

#[test]
fn the_foot_of_a_slope_between_two_stripes_does_not_lift_a_wheel() {
    // The right wheels stand on level ground up to the foot of a slope of 1, at y = -0.35 m. The straight line from y = -0.4 to
    // -0.3 m leaves them, at y = -0.375 m, 12.5 mm above the ground. The left wheels stand at 0.355 m: by the straight line
    // 0.3425 m higher, in truth by more than the limit of 0.35 m.
    let foot = |top: f64| move |_: i64, j: i64| Some((0.1 * j as f64 + 0.35).clamp(0.0, top));
    assert!(may_hide(judge(&ground(foot(0.355)))), "{:?}", judge(&ground(foot(0.355))));
    assert_eq!(judge(&ground(foot(0.349))), Traversability::Clear);
}

#[test]
fn a_rise_is_clear_both_by_the_tilt_and_by_the_ground() {
    // The left half lies 0.33 m higher, 0.02 m below the limit. The points err by 1 mm, two sides by 1.4 mm; by two of these the
    // left half is clear. It was measured after the vehicle's elevation was corrected by -0.02 m: by its tilt alone the left half would
    // be 0.35 m higher. Corrected by +0.02 m, 0.31 m.
    let judged = |by: f64| {
        let mut map =
            ElevationMap::with_rules(MapSize { spacing: 0.1, points: 81 }, DVec2::ZERO, MapRules::MENDED);
        let points: Vec<GridPoint> = map.points().collect();
        for (is_left, z) in [(false, 0.0), (true, 0.33)] {
            let half = points.iter().filter(|point| (point.j > 0) == is_left);
            let half: Vec<MapPoint> = half
                .map(|point| map.place(*point).extend(z))
                .map(|point| MapPoint { point, standard_error: 0.001, sight: None })
                .collect();
            map.insert(half);
            map.correct(by);
        }
        let rules = TraversabilityRules::for_vehicle(&Vehicle::default());
        rules.classify(&MapWithShadows::of(&map), &Vehicle::default(), DVec2::new(1.0, 0.0), DVec2::X)
    };
    // 0.33 + 0.017 + 2 * 0.0014 m is just below 0.35 m, but less than 0.5 mm.
    for by in [0.0, 0.02, -0.0168] {
        assert_eq!(judged(by), Traversability::Clear, "{by}");
    }
    let far = judged(-0.0175);
    assert!(
        matches!(far, Traversability::Unknown(Missing { reason: MissingReason::NearLimit, .. })),
        "{far:?}"
    );
}

#[test]
fn an_edge_between_two_points_may_stand_half_way() {
    // On the left a block from y = 0.7 m on; at y = 0.6 m the ground is 0. The straight line enters the left wheels, at
    // y = 0.625 m, at a quarter of its height, but the block may reach to y = 0.65 m and there fall at once: the line from there is half as
    // high at the wheels.
    let block = |top: f64| move |_: i64, j: i64| Some(if j >= 7 { top } else { 0.0 });
    assert!(may_hide(judge(&ground(block(0.72)))), "{:?}", judge(&ground(block(0.72))));
    assert_eq!(judge(&ground(block(0.68))), Traversability::Clear);
    // A pit on the right from y = -0.4 m on; its edge was met at y = -0.3 m, beside the wheels. The straight line leaves them, at
    // y = -0.375 m, three quarters down, and a pit that begins at y = -0.35 m leaves them on its ground.
    let pit = |depth: f64| move |_: i64, j: i64| Some(if j <= -4 { -depth } else { 0.0 });
    assert!(may_hide(judge(&ground(pit(0.36)))), "{:?}", judge(&ground(pit(0.36))));
    assert_eq!(judge(&ground(pit(0.34))), Traversability::Clear);
}
