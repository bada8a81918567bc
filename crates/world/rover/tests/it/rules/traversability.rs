//! The printed tests of a point, each on a map made by hand.

use glam::DVec2;
use raypencil_rover::{
    ElevationMap, MapSize, MapWithShadows, Traversability, TraversabilityRules, TraversabilityTest, Vehicle,
};

/// A map of 61 by 61 points 0.1 m apart with the `elevation` of grid point (i, j); `None`: not known.
fn map(elevation: impl Fn(i64, i64) -> Option<f64>) -> ElevationMap {
    let mut map = ElevationMap::new(MapSize { spacing: 0.1, points: 61 }, DVec2::ZERO);
    for point in map.points() {
        if let Some(z) = elevation(point.i, point.j) {
            map.set_proximity(point, z);
        }
    }
    map
}

/// The default vehicle with heading +x and its front axle at (1, 0) m. Its front wheels are at grid points (10, +-5),
/// its rear wheels at (-2, +-5), its centre at (4, 0), the two closer points at (7, 0) and (1, 0).
fn judge(rules: &TraversabilityRules, map: &ElevationMap) -> Traversability {
    let map = MapWithShadows::of(map);
    rules.classify_points(&map, &Vehicle::default(), DVec2::new(1.0, 0.0), DVec2::X)
}

fn is_unknown(traversability: Traversability) -> bool {
    matches!(traversability, Traversability::Unknown(_))
}

fn rules() -> TraversabilityRules {
    TraversabilityRules::as_printed(&Vehicle::default())
}

/// Level ground, except for some grid points (i, j, elevation).
fn except(changed: &'static [(i64, i64, f64)]) -> ElevationMap {
    map(move |i, j| {
        Some(changed.iter().find(|change| (change.0, change.1) == (i, j)).map_or(0.0, |change| change.2))
    })
}

/// Level ground, except for some unknown grid points.
fn without(unknown: &'static [(i64, i64)]) -> ElevationMap {
    map(move |i, j| (!unknown.contains(&(i, j))).then_some(0.0))
}

#[test]
fn level_ground_is_clear() {
    assert_eq!(judge(&rules(), &map(|_, _| Some(0.0))), Traversability::Clear);
    assert!(is_unknown(judge(&rules(), &map(|_, _| None))));
}

#[test]
fn test_a_front_wheels() {
    // The wheels are 1.0 m apart and the limit is 0.35: a rise of 0.36 m fails, one of 0.34 m passes.
    let fails = except(&[(10, 5, 0.36)]);
    assert_eq!(judge(&rules(), &fails), Traversability::Obstacle(TraversabilityTest::Front));
    assert_eq!(judge(&rules(), &except(&[(10, 5, 0.34)])), Traversability::Clear);
    assert_eq!(
        judge(&rules(), &except(&[(10, -5, -0.36)])),
        Traversability::Obstacle(TraversabilityTest::Front)
    );
}

#[test]
fn test_b_rear_wheels() {
    assert_eq!(
        judge(&rules(), &except(&[(-2, -5, 0.36)])),
        Traversability::Obstacle(TraversabilityTest::Rear)
    );
    assert_eq!(judge(&rules(), &except(&[(-2, -5, 0.34)])), Traversability::Clear);
}

#[test]
fn test_c_from_axle_to_axle() {
    // The midpoints are 1.2 m apart and the limit is 0.35 / 1.2: again 0.36 m fails and 0.34 m passes, up or down. The
    // wheels stay level.
    assert_eq!(
        judge(&rules(), &except(&[(10, 0, 0.36)])),
        Traversability::Obstacle(TraversabilityTest::Length)
    );
    assert_eq!(
        judge(&rules(), &except(&[(-2, 0, 0.36)])),
        Traversability::Obstacle(TraversabilityTest::Length)
    );
    assert_eq!(judge(&rules(), &except(&[(10, 0, -0.34)])), Traversability::Clear);
    // A slope of 0.29 is below the limit of 0.2917, one of 0.30 above it, wherever the vehicle stands.
    for (slope, verdict) in
        [(0.29, Traversability::Clear), (0.30, Traversability::Obstacle(TraversabilityTest::Length))]
    {
        let hill = map(|i, _| Some(slope * 0.1 * i as f64));
        for shift in [0.0, 0.03, 0.07] {
            let front = DVec2::new(1.0 + shift, shift);
            let hill = MapWithShadows::of(&hill);
            assert_eq!(rules().classify_points(&hill, &Vehicle::default(), front, DVec2::X), verdict);
        }
    }
}

#[test]
fn a_slope_at_its_limit_passes() {
    // 0.35 m over 1.0 m is exactly the limit.
    assert_eq!(judge(&rules(), &except(&[(10, 5, 0.35)])), Traversability::Clear);
}

#[test]
fn the_closer_pair_stands_in_for_unknown_rear_wheels() {
    // One rear wheel is unknown: c) is not tested, so that 0.36 m at the rear midpoint does not fail. The closer points
    // are 0.6 m apart and their limit is 0.35 / 0.6: 0.36 m fails there.
    let of = |changed: (i64, i64)| {
        map(move |i, j| (!(i == -2 && j == 5)).then_some(if (i, j) == changed { 0.36 } else { 0.0 }))
    };
    assert!(is_unknown(judge(&rules(), &of((-2, 0)))));
    assert_eq!(judge(&rules(), &of((1, 0))), Traversability::Obstacle(TraversabilityTest::Closer));
    assert_eq!(judge(&rules(), &of((7, 0))), Traversability::Obstacle(TraversabilityTest::Closer));
    // With all wheels known, a bump between the axles fails no slope test.
    assert_eq!(judge(&rules(), &except(&[(7, 0, 0.34)])), Traversability::Clear);
}

#[test]
fn belly() {
    // The belly is midway between the four wheels, 0.35 m above their mean of 0: ground at 0.35 hits it, ground at 0.34
    // does not. No slope point is there.
    assert_eq!(
        judge(&rules(), &except(&[(4, 0, 0.35)])),
        Traversability::Obstacle(TraversabilityTest::Belly)
    );
    assert_eq!(judge(&rules(), &except(&[(4, 0, 0.34)])), Traversability::Clear);
    // One wheel at 0.2 raises the mean by 0.05 m: 0.39 passes, 0.41 does not.
    assert_eq!(judge(&rules(), &except(&[(4, 0, 0.39), (10, 5, 0.2)])), Traversability::Clear);
    assert_eq!(
        judge(&rules(), &except(&[(4, 0, 0.41), (10, 5, 0.2)])),
        Traversability::Obstacle(TraversabilityTest::Belly)
    );
    // A ditch below the belly is no obstacle.
    assert_eq!(judge(&rules(), &except(&[(4, 0, -3.0)])), Traversability::Clear);
}

#[test]
fn every_unknown_slope_point_makes_the_point_unknown() {
    for needed in [(10, 5), (10, -5), (-2, 5), (-2, -5), (10, 0), (-2, 0), (4, 0)] {
        let but_one = map(move |i, j| ((i, j) != needed).then_some(0.0));
        assert!(is_unknown(judge(&rules(), &but_one)), "{needed:?}");
    }
    // Other points are not needed; nor are the closer points while the rear wheels are known.
    assert_eq!(judge(&rules(), &without(&[(3, 3), (1, 0), (7, 0)])), Traversability::Clear);
    // If unknown rear wheels are allowed, the closer points are needed.
    let excusing = TraversabilityRules { rear_needed: false, ..rules() };
    assert_eq!(judge(&excusing, &without(&[(-2, 5), (-2, -5), (-2, 0)])), Traversability::Clear);
    assert!(is_unknown(judge(&excusing, &without(&[(-2, 5), (1, 0)]))));
}

#[test]
fn an_obstacle_outweighs_an_unknown_point() {
    // The rear wheels are unknown, and the front wheels fail.
    let both = map(|i, j| (i != -2).then_some(if (i, j) == (10, 5) { 0.5 } else { 0.0 }));
    assert_eq!(judge(&rules(), &both), Traversability::Obstacle(TraversabilityTest::Front));
}

#[test]
fn narrow_gaps_are_crossed_if_the_rule_is_set() {
    // A crack of unknown ground under the front axle is two grid points wide: 0.2 m, and the wheels are 0.25 m wide. If
    // both sides are level it may be crossed. If the far side is at 0.4 m, the crack may hide ground of that height.
    let crack =
        |far: f64| map(move |i, _| (!(9..=10).contains(&i)).then_some(if i > 10 { far } else { 0.0 }));
    let crossing = rules().crossing_gaps(&Vehicle::default());
    assert!(is_unknown(judge(&rules(), &crack(0.0))));
    assert_eq!(judge(&crossing, &crack(0.0)), Traversability::Clear);
    assert_eq!(judge(&crossing, &crack(0.4)), Traversability::Obstacle(TraversabilityTest::Length));
    // Three grid points, 0.3 m, are too wide.
    let wide = map(|i, _| (!(9..=11).contains(&i)).then_some(0.0));
    assert!(is_unknown(judge(&crossing, &wide)));
}

#[test]
fn thresholds_out_of_range_are_named() {
    assert!(rules().crossing_gaps(&Vehicle::default()).validate("rules").is_ok());
    let wrong = TraversabilityRules { closer_share: 0.0, ..rules() };
    assert!(wrong.validate("rules").unwrap_err().to_string().starts_with("rules.closer_share is 0"));
}

#[test]
fn the_maximum_slope_is_a_step_of_one_wheel_radius() {
    // 0.35 m over the track of 1 m, the wheelbase of 1.2 m, and half of it.
    let slopes = TraversabilityRules::for_vehicle(&Vehicle::default()).slopes;
    assert_eq!((slopes.front, slopes.rear), (0.35, 0.35));
    assert!((slopes.length - 0.35 / 1.2).abs() < 1e-15 && (slopes.closer - 0.35 / 0.6).abs() < 1e-15);
}

#[test]
fn slopes_fail_a_thousandth_above_their_limits_and_pass_a_thousandth_below() {
    // All limits are a rise of 0.35 m between the points of the pair, up or down.
    use TraversabilityTest::{Closer, Front, Length, Rear};
    for (test, at) in
        [(Front, (10, 5)), (Front, (10, -5)), (Rear, (-2, 5)), (Length, (10, 0)), (Length, (-2, 0))]
    {
        for sign in [1.0, -1.0] {
            let ground = |rise: f64| map(move |i, j| Some(if (i, j) == at { sign * rise } else { 0.0 }));
            assert_eq!(judge(&rules(), &ground(0.3496)), Traversability::Clear, "{at:?}");
            assert_eq!(judge(&rules(), &ground(0.3504)), Traversability::Obstacle(test), "{at:?}");
        }
    }
    // The closer pair, without a rear wheel.
    let ground =
        |rise: f64| map(move |i, j| ((i, j) != (-2, 5)).then_some(if (i, j) == (7, 0) { rise } else { 0.0 }));
    assert!(is_unknown(judge(&rules(), &ground(0.3496))));
    assert_eq!(judge(&rules(), &ground(0.3504)), Traversability::Obstacle(Closer));
}
