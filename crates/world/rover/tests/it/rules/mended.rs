//! What the mended rules mend: each test fails with the printed rule put back.

use glam::{DVec2, DVec3};
use raypencil_chassis::GroundFaces;
use raypencil_rover::{
    Attitude, ElevationMap, ElevationSource, ErrorMargins, GridPoint, Inconsistency, Label,
    LocalisationReading, MapPoint, MapRules, MapSize, MapWithShadows, Mapper, Missing, MissingReason,
    ObstacleMap, RadialGrid, Rule, ScanReason, ScanRule, Sight, StartRule, StripePoint, Traversability,
    TraversabilityRules, TraversabilityTest, Vehicle, VehiclePart,
};
use raypencil_scene::{Material, Pose};
use raypencil_terrain::{Ground, HeightIndex};

/// A reading of perfect sensors.
fn sensed(place: DVec2, attitude: Attitude, proximity: f64) -> LocalisationReading {
    LocalisationReading { position: place, attitude, proximity: Some(proximity) }
}

/// Attitude of a vehicle with heading 0 on a plane that rises by `slope` along x and y: its up vector is the plane's
/// normal. R_y(pitch) R_x(roll) turns z to (sin p cos r, -sin r, cos p cos r).
fn on_plane(slope: DVec2) -> Attitude {
    let normal = DVec3::new(-slope.x, -slope.y, 1.0).normalize();
    let roll_right = libm::asin(-normal.y);
    Attitude { heading: 0.0, pitch_down: libm::asin(normal.x / libm::cos(roll_right)), roll_right }
}

/// Both stripes of the default rig on a plane that carries the vehicle: in the vehicle frame they are always here.
fn stripes() -> impl Iterator<Item = DVec3> {
    [(3.3, 1.7), (5.25, 2.8)].into_iter().flat_map(|(ahead, half_width)| {
        (-150..=150).map(move |n| DVec3::new(ahead, half_width * f64::from(n) / 150.0, 0.0))
    })
}

/// A drive along x over a plane with perfect sensors. Returns the mapper and the largest error of the vehicle's elevation,
/// metres.
fn drive_over_plane(slope: DVec2, way: f64, rules: MapRules) -> (Mapper, f64) {
    let attitude = on_plane(slope);
    // The proximity sensor measures straight down from the origin, which is on the plane.
    let reading = |x: f64| sensed(DVec2::new(x, 0.013), attitude, 0.0);
    let truth = |x: f64| slope.dot(DVec2::new(x, 0.013));
    let size = MapSize { spacing: 0.1, points: 161 };
    let mut mapper = Mapper::with_rules(Vehicle::default(), size, rules, &reading(0.0), truth(0.0));
    let mut largest: f64 = 0.0;
    let frames = (way / 0.03) as u32;
    for frame in 0..=frames {
        let x = 0.03 * f64::from(frame);
        mapper.update(&reading(x), stripes());
        largest = largest.max((mapper.pose().position.z - truth(x)).abs());
    }
    (mapper, largest)
}

/// Largest error of the measured cells against the plane, metres: at the grid points, and at the measured points.
fn map_errors(mapper: &Mapper, slope: DVec2) -> [f64; 2] {
    let map = mapper.map();
    let mut errors = [0.0_f64; 2];
    for point in map.points().filter(|&point| map.source(point) == ElevationSource::Measured) {
        let sample = map.sample(point).unwrap();
        let at_point = (sample.z - slope.dot(map.place(point))).abs();
        let at_sample = (sample.z - slope.dot(sample.truncate())).abs();
        errors = [errors[0].max(at_point), errors[1].max(at_sample)];
    }
    errors
}

/// Share of the cells that both stripes have swept that hold a measurement.
fn measured_share(mapper: &Mapper, way: f64) -> f64 {
    let map = mapper.map();
    let swept = map.points().filter(|&point| {
        let place = map.place(point);
        place.x > way && place.x < way + 3.2 && place.y.abs() < 1.6
    });
    let all: Vec<bool> = swept.map(|point| map.source(point) == ElevationSource::Measured).collect();
    all.iter().filter(|measured| **measured).count() as f64 / all.len() as f64
}

#[test]
fn on_a_plane_of_any_slope_the_map_is_the_plane() {
    // Half a cell's diagonal is 0.05 sqrt(2) m: a cell holds the elevation of a point at most that far away. The measured
    // points themselves are on the plane, but for rounding: a hundred metres have a few hundred frames that hand it on.
    for (slope, way) in
        [(0.1, 0.0, 10.0), (0.3, 0.1, 10.0), (-0.25, 0.2, 10.0), (0.0, -0.35, 10.0), (0.1, 0.05, 100.0)]
            .map(|(x, y, way)| (DVec2::new(x, y), way))
    {
        let (mapper, elevation) = drive_over_plane(slope, way, MapRules::MENDED);
        let [at_points, at_samples] = map_errors(&mapper, slope);
        assert!(elevation < 1e-9, "{slope}: elevation off by {elevation}");
        assert!(at_samples < 1e-9, "{slope}: measured points off by {at_samples}");
        assert!(
            at_points <= slope.length() * 0.05 * 2.0_f64.sqrt() + 1e-9,
            "{slope}: map off by {at_points}"
        );
        assert_eq!(measured_share(&mapper, way), 1.0);
    }
}

#[test]
fn printed_rules_put_back_spoil_the_map_of_a_plane() {
    let slope = DVec2::new(0.1, 0.05);
    let bound = slope.length() * 0.05 * 2.0_f64.sqrt();
    // The elevation of one cell belongs to a point up to half a diagonal away, and what it spoils is read again 3.3 m on.
    let elevation = MapRules { elevation: Rule::Paper, several: Rule::Paper, ..MapRules::MENDED };
    let [short, long] = [10.0, 100.0].map(|way| drive_over_plane(slope, way, elevation).1);
    assert!(short > 1e-3 && long > 1.5 * short && long > bound, "{short} and {long}");
    // A new stripe overwrites what earlier ones measured beside it.
    let extrapolate = MapRules { extrapolate: Rule::Paper, ..MapRules::MENDED };
    let (mapper, _) = drive_over_plane(slope, 10.0, extrapolate);
    assert!(measured_share(&mapper, 10.0) < 0.9, "{}", measured_share(&mapper, 10.0));
    // As printed throughout, a slope of 0.1 has sunk or risen by some centimetres after 60 m.
    let (_, printed) = drive_over_plane(DVec2::new(0.1, 0.0), 60.0, MapRules::AS_PRINTED);
    assert!(printed > 0.05, "{printed}");
}

#[test]
fn what_was_invented_at_the_start_is_not_read_back() {
    // A ridge under the origin only, 0.15 m above the plane of the wheels. The footprint makes a plateau of it.
    let drive = |start| {
        let rules = MapRules { start, ..MapRules::AS_PRINTED };
        let at = |x, proximity| sensed(DVec2::new(x, 0.0), Attitude::default(), proximity);
        let size = MapSize::default();
        let mut mapper = Mapper::with_rules(Vehicle::default(), size, rules, &at(0.0, -0.15), 0.0);
        let no_points: [DVec3; 0] = [];
        for step in 1..=9 {
            mapper.update(&at(0.1 * f64::from(step), 0.0), no_points);
        }
        mapper.pose().position.z
    };
    assert!(drive(StartRule::Origin).abs() < 1e-12);
    assert!((drive(StartRule::Footprint) - 0.15).abs() < 1e-12);
}

/// A map of 61 by 61 points with these rules.
fn map_with(rules: MapRules) -> ElevationMap {
    ElevationMap::with_rules(MapSize { spacing: 0.1, points: 61 }, DVec2::ZERO, rules)
}

/// A stripe across the map at x, at this elevation: 21 cells.
fn stripe_at(x: f64, z: f64) -> impl Iterator<Item = DVec3> {
    (-10..=10).map(move |n| DVec3::new(x, 0.1 * f64::from(n), z))
}

#[test]
fn a_contradiction_is_seen_against_what_was_measured_long_ago() {
    // Ground at 0, swept in steps of 0.03 m as a drive sweeps it; then a stripe over it that is 0.195 m higher.
    let contradicted = |rules| {
        let mut map = map_with(rules);
        let mut found = Inconsistency::default();
        for step in 0..40 {
            map.insert(stripe_at(0.03 * f64::from(step), 0.0));
        }
        for step in 0..3 {
            found = map.insert(stripe_at(0.5 + 0.03 * f64::from(step), 0.195));
        }
        found
    };
    // The mended rule remembers the range of all measurements of a cell, whatever lies over it. The third new stripe, at
    // x = 0.56 m, is the first in the cells of x = 0.6 m.
    let found = contradicted(MapRules::MENDED);
    assert!(found.count == 21 && (found.mean - 0.195).abs() < 1e-12, "{found:?}");
    assert_eq!(ScanRule::default().due(1.0, Some(0.0), &found), Some(ScanReason::Inconsistency));
    let over_printed = contradicted(MapRules { inconsistency: Rule::Mended, ..MapRules::AS_PRINTED });
    assert!((over_printed.mean - 0.195).abs() < 1e-12, "{over_printed:?}");
    assert_eq!(contradicted(MapRules::AS_PRINTED), Inconsistency::default());
}

#[test]
fn the_top_of_a_wall_stays_and_not_its_foot() {
    // A sweep from far to near meets the top first. Of later frames the foot does not lower the top either, and a slope's
    // points are blended: 0.1 and 0.11 m with equal errors are 0.105 m.
    let wall = [0.5, 0.3, 0.1, 0.0].map(|z| DVec3::new(1.0, 0.0, z));
    let at = GridPoint { i: 10, j: 0 };
    let kept = |rules| {
        let mut map = map_with(rules);
        map.insert(wall);
        map.elevation(at).unwrap()
    };
    assert_eq!(kept(MapRules::MENDED), 0.5);
    assert_eq!(kept(MapRules { several: Rule::Paper, ..MapRules::MENDED }), 0.0);
    let mut map = map_with(MapRules::MENDED);
    map.insert(wall);
    map.insert([DVec3::new(1.0, 0.0, 0.0)]);
    assert_eq!(map.elevation(at), Some(0.5));
    let mut map = map_with(MapRules::MENDED);
    map.insert([DVec3::new(1.0, 0.0, 0.1)]);
    map.insert([DVec3::new(1.0, 0.0, 0.11)]);
    assert!((map.elevation(at).unwrap() - 0.105).abs() < 1e-12);
}

#[test]
fn a_guess_never_covers_a_measurement() {
    let mut map = map_with(MapRules::MENDED);
    map.insert([DVec3::new(1.0, 0.0, 0.2)]);
    map.insert([DVec3::new(1.1, 0.0, 0.9), DVec3::new(1.3, 0.0, 0.4)]);
    let at = |i, j| (map.elevation(GridPoint { i, j }), map.source(GridPoint { i, j }));
    assert_eq!(at(10, 0), (Some(0.2), ElevationSource::Measured));
    // Between two new points the higher one is guessed; where only the old one was near, its guess stays.
    assert_eq!(at(12, 1), (Some(0.9), ElevationSource::Extrapolated));
    assert_eq!(at(9, 1), (Some(0.2), ElevationSource::Extrapolated));
}

/// Level ground of measured cells, except for those of which `change` says otherwise: `None` is not measured.
fn measured(change: impl Fn(i64, i64) -> Option<f64>) -> ElevationMap {
    let mut map = map_with(MapRules { extrapolate: Rule::Mended, ..MapRules::MENDED });
    let points: Vec<DVec3> =
        map.points().filter_map(|point| Some(map.place(point).extend(change(point.i, point.j)?))).collect();
    map.insert(points);
    map
}

/// The default vehicle with heading +x and its front axle at (1, 0) m: its front wheels are at (1, +-0.5), its rear wheels
/// at (-0.2, +-0.5).
fn judge(rules: &TraversabilityRules, map: &ElevationMap) -> Traversability {
    rules.classify(&MapWithShadows::of(map), &Vehicle::default(), DVec2::new(1.0, 0.0), DVec2::X)
}

#[test]
fn wheels_and_belly_meet_what_no_point_meets() {
    let mended = TraversabilityRules::for_vehicle(&Vehicle::default());
    let printed = TraversabilityRules { tests: Rule::Paper, ..mended };
    assert_eq!(judge(&mended, &measured(|_, _| Some(0.0))), Traversability::Clear);
    // A rock of 0.5 m at (0.4, 0.2): between the centre line and the wheels' tracks, under a belly at 0.35 m.
    let rock = measured(|i, j| Some(if (i, j) == (4, 2) { 0.5 } else { 0.0 }));
    assert_eq!(judge(&printed, &rock), Traversability::Clear);
    assert_eq!(judge(&mended, &rock), Traversability::Obstacle(TraversabilityTest::Belly));
    // One of 0.32 m passes under it.
    let low = measured(|i, j| Some(if (i, j) == (4, 2) { 0.32 } else { 0.0 }));
    assert_eq!(judge(&mended, &low), Traversability::Clear);
    // A stone of 0.4 m one cell before the left front wheel's centre, within its rim: the contact is at the stone, 0.4 m
    // above that of the right wheel, 1 m and a little away.
    let stone = measured(|i, j| Some(if (i, j) == (11, 5) { 0.4 } else { 0.0 }));
    assert_eq!(judge(&printed, &stone), Traversability::Clear);
    assert_eq!(judge(&mended, &stone), Traversability::Obstacle(TraversabilityTest::Front));
    // Outside the wheel's width, which ends at 0.625 m, it is no obstacle: the ground between two cells falls to 0.3 m
    // there.
    let beside = measured(|i, j| Some(if (i, j) == (11, 7) { 0.4 } else { 0.0 }));
    assert_eq!(judge(&mended, &beside), Traversability::Clear);
}

#[test]
fn a_rock_under_the_belly_is_unknown_within_its_errors() {
    // All points have a standard error of 1 cm. The underside is at 0.35 m. Over (0.4, 0.2), 0.2 m left of its middle, a left
    // wheel has a share of 1/4 + 0.2 / 2 = 0.35 in its height and a right one of 0.15: the standard error is
    // sqrt(2 (0.35^2 + 0.15^2)) = 0.539 cm, with that of the rock 1.136 cm. So a rock is no obstacle below 0.35 - 0.0227 m and
    // one from 0.35 + 0.0057 m on.
    let rules = TraversabilityRules::for_vehicle(&Vehicle::default());
    let rock =
        |height: f64| judge(&rules, &measured(|i, j| Some(if (i, j) == (4, 2) { height } else { 0.0 })));
    assert_eq!(rock(0.3270), Traversability::Clear);
    for height in [0.3276, 0.3554] {
        let Traversability::Unknown(missing) = rock(height) else { panic!("{height}: {:?}", rock(height)) };
        assert_eq!((missing.part, missing.reason), (VehiclePart::Belly, MissingReason::NearLimit));
        assert!((missing.place - DVec2::new(0.4, 0.2)).length() < 1e-9);
    }
    assert_eq!(rock(0.3560), Traversability::Obstacle(TraversabilityTest::Belly));
}

#[test]
fn the_belly_is_not_held_up_by_what_may_stand_under_a_wheel() {
    // Under the middle of the left front wheel one cell is not measured. The ground behind it was seen over it by a line of 1.5:
    // up to 1.5 (0.1 + 0.1) = 0.3 m may stand there, and the wheel on it. The underside over the rock would then be at
    // 0.35 + 0.35 * 0.3 = 0.455 m. But the gap may be empty: then it is at 0.35 m.
    let rules = TraversabilityRules::for_vehicle(&Vehicle::default());
    let judged = |rock: f64| {
        let mut map = map_with(MapRules::MENDED);
        let sight = Some(Sight { towards: DVec2::NEG_X, slope: 1.5 });
        let points: Vec<MapPoint> = map
            .points()
            .filter(|point| (point.i, point.j) != (10, 5))
            .map(|point| {
                let z = if (point.i, point.j) == (4, 2) { rock } else { 0.0 };
                MapPoint { point: map.place(point).extend(z), standard_error: 0.001, sight }
            })
            .collect();
        map.insert(points);
        judge(&rules, &map)
    };
    assert_eq!(judged(0.34), Traversability::Clear);
    let Traversability::Unknown(missing) = judged(0.4) else { panic!("{:?}", judged(0.4)) };
    assert_eq!((missing.part, missing.reason), (VehiclePart::Belly, MissingReason::NearLimit));
    // Higher than the underside can be: an obstacle whatever stands there.
    assert_eq!(judged(0.46), Traversability::Obstacle(TraversabilityTest::Belly));
}

#[test]
fn a_slope_at_its_limit_passes_and_one_above_it_does_not() {
    let margins = ErrorMargins { obstacle: 0.0, clear: 0.0 };
    let rules = TraversabilityRules { margins, ..TraversabilityRules::for_vehicle(&Vehicle::default()) };
    for (slope, is_clear) in [(0.29, true), (0.30, false)] {
        let hill = measured(|i, _| Some(slope * 0.1 * i as f64));
        let expected = Traversability::Obstacle(TraversabilityTest::Length);
        let expected = if is_clear { Traversability::Clear } else { expected };
        assert_eq!(judge(&rules, &hill), expected);
    }
}

#[test]
fn a_slope_near_its_limit_is_unknown_within_its_errors() {
    // Points have a standard error of 1 cm. A rise between two wheels has 1.41 cm, one between two axles 1 cm: the mean of
    // two wheels has half of their variance. The limit is 0.35 m each. So a rise across is clear up to 0.35 - 0.0283 m
    // and an obstacle from 0.35 + 0.0071 m on, one along up to 0.33 m and from 0.355 m on.
    let rules = TraversabilityRules::for_vehicle(&Vehicle::default());
    let said = |ground: ElevationMap, test| match judge(&rules, &ground) {
        Traversability::Clear => "clear",
        Traversability::Obstacle(failed) if failed == test => "obstacle",
        Traversability::Unknown(Missing { reason: MissingReason::NearLimit, .. }) => "unknown",
        other => panic!("{other:?}"),
    };
    for (rise, expected) in
        [(0.3215, "clear"), (0.3219, "unknown"), (0.3569, "unknown"), (0.3573, "obstacle")]
    {
        // The left half of the ground is higher: both left wheels.
        let ground = measured(|_, j| Some(if j > 0 { rise } else { 0.0 }));
        assert_eq!(said(ground, TraversabilityTest::Front), expected, "{rise}");
    }
    for (rise, expected) in
        [(0.3298, "clear"), (0.3302, "unknown"), (0.3548, "unknown"), (0.3552, "obstacle")]
    {
        let ground = measured(|i, _| Some(if i > 4 { rise } else { 0.0 }));
        assert_eq!(said(ground, TraversabilityTest::Length), expected, "{rise}");
    }
}

#[test]
fn an_obstacle_begins_where_it_is_too_near_a_limit_to_tell() {
    // A wall across the way, straight ahead, at x = 3 m. The front wheels meet its upper edge 0.3 m before their axle:
    // they are lifted by h - 0.35 + sqrt(0.35^2 - 0.3^2) = h - 0.1697 m, and one step farther by h - 0.0628 m. The limit is
    // 0.35 m over the wheelbase, an obstacle from 0.355 m on, clear up to 0.33 m.
    let (vehicle, pose) = (Vehicle::default(), Pose::IDENTITY);
    let (rules, grid) = (TraversabilityRules::for_vehicle(&vehicle), RadialGrid::for_vehicle(&vehicle));
    let ahead = |map: &ElevationMap| {
        let sector = ObstacleMap::extract(map, &vehicle, &rules, &grid, &pose).sectors[15];
        (sector.label, sector.failed, (sector.radius * 100.0).round())
    };
    let wall = |h: f64| measured(move |i, _| Some(if i >= 30 { h } else { 0.0 }));
    let by_length = Some(TraversabilityTest::Length);
    // At the first touch 0.36 m; 0.345 m, too near to tell, and 0.452 m next; 0.32 m, clear, and 0.427 m next.
    for (h, radius) in [(0.5297, 270.0), (0.5147, 270.0), (0.4897, 280.0)] {
        assert_eq!(ahead(&wall(h)), (Label::Obstacle, by_length, radius), "{h}");
    }
    // On a slope of 0.343 m over the wheelbase the next point is as near to the limit as this one.
    let slope = measured(|i, _| Some(0.343 / 1.2 * 0.1 * i as f64));
    assert_eq!(ahead(&slope), (Label::Unknown, None, 70.0));
    // Ground that was never measured stays unknown. The left half ends at x = 2.8 m, under the left wheel at 2.6 m; at
    // 2.7 m the right one meets a wall of 1.2 m, which lifts the middle of the axle by half of 1.03 m.
    let half = measured(|i, j| match (i, j) {
        (29.., 1..) => None,
        (30.., _) => Some(1.2),
        _ => Some(0.0),
    });
    assert_eq!(ahead(&half), (Label::Unknown, None, 260.0));
}

#[test]
fn what_may_stand_in_a_narrow_gap_is_told_from_a_slope_near_its_limit() {
    // On the left, columns 12 and 13 are a gap of 0.2 m before ground at 0.45 m: it may hide ground of that height, 0.2 m
    // before the axle. The left front wheel would be lifted by 0.45 - 0.35 + sqrt(0.35^2 - 0.2^2) = 0.387 m, more than 0.35.
    let rules = TraversabilityRules::for_vehicle(&Vehicle::default());
    let ground = measured(|i, j| match i {
        12..=13 if j > 0 => None,
        14.. if j > 0 => Some(0.45),
        _ => Some(0.0),
    });
    let Traversability::Unknown(missing) = judge(&rules, &ground) else { panic!("crossed") };
    assert_eq!((missing.part, missing.reason), (VehiclePart::FrontWheel, MissingReason::MayHide));
}

#[test]
fn which_of_two_points_carries_a_wheel_changes_no_verdict() {
    // Level ground, and a stone 0.3 m before the right front wheel's axle that touches its rim within a millimetre: it
    // carries the wheel, or the ground below it does. The left wheels stand 0.3 or 0.4 m higher, against 0.35 m.
    let rules = TraversabilityRules::for_vehicle(&Vehicle::default());
    let tie = 0.35 - (0.1225_f64 - 0.09).sqrt();
    for (rise, expected) in
        [(0.3, Traversability::Clear), (0.4, Traversability::Obstacle(TraversabilityTest::Front))]
    {
        for more in [-0.001, 0.001] {
            let stone = |i, j| (i, j) == (13, -5);
            let ground = measured(|i, j| {
                Some(if j > 0 { rise } else { 0.0 } + if stone(i, j) { tie + more } else { 0.0 })
            });
            assert_eq!(judge(&rules, &ground), expected, "{rise} {more}");
        }
    }
}

#[test]
fn a_wheel_does_not_cross_what_is_wider_than_itself() {
    let rules = TraversabilityRules::for_vehicle(&Vehicle::default());
    // Columns 11 and 12 are 0.2 m: bridged. 11 to 13 are 0.3 m, more than the wheel's 0.25 m.
    let gap = |last: i64| measured(move |i, _| (!(11..=last).contains(&i)).then_some(0.0));
    assert_eq!(judge(&rules, &gap(12)), Traversability::Clear);
    let Traversability::Unknown(Missing { reason, .. }) = judge(&rules, &gap(13)) else { panic!("crossed") };
    assert_eq!(reason, MissingReason::NotMeasured);
    // Extrapolation has filled columns 11 and 13 on both sides: with the printed rule the rest is a gap of 0.1 m.
    assert_eq!(gap(13).source(GridPoint { i: 11, j: 0 }), ElevationSource::Extrapolated);
}

#[test]
fn a_shadow_hides_what_is_below_the_line_of_sight() {
    // A point at (2, 0), z = 0.1, seen by a line that rises by 0.3 towards -x. Half a cell of way lifts it by 0.015 m. The
    // cell at x = 1.5 is at most 0.1 + 0.3 (0.55 + 0.05) m high at its far side; steps of half a cell and one cell beyond
    // make it at most 0.05 m more of way.
    let mut map = map_with(MapRules::MENDED);
    let sight = Some(Sight { towards: DVec2::NEG_X, slope: 0.3 });
    map.insert([MapPoint { point: DVec3::new(2.0, 0.0, 0.1), standard_error: 0.01, sight }]);
    let shadows = MapWithShadows::of(&map);
    let ceiling = shadows.ceiling(GridPoint { i: 15, j: 0 }).unwrap();
    assert!((0.1 + 0.3 * 0.55..=0.1 + 0.3 * 0.65 + 1e-12).contains(&ceiling), "{ceiling}");
    // Beside the line, beyond the point and more than 2 m before it nothing is said.
    for (i, j) in [(15, 2), (21, 0), (-2, 0)] {
        assert_eq!(shadows.ceiling(GridPoint { i, j }), None, "({i}, {j})");
    }
    // A measured cell on the way ends the shadow.
    map.insert([DVec3::new(1.7, 0.0, 0.0)]);
    let shadows = MapWithShadows::of(&map);
    assert!(shadows.ceiling(GridPoint { i: 18, j: 0 }).is_some());
    assert_eq!(shadows.ceiling(GridPoint { i: 15, j: 0 }), None);
}

#[test]
fn a_low_shadow_under_the_belly_is_clear_and_a_high_one_is_not() {
    // Cells (3..=5, -1..=1) under the belly are not measured: 0.3 m, wider than any gap for a wheel. The ground behind them
    // was seen over them by a line of this slope: over 0.4 m it rises by 0.4 times as much.
    let rules = TraversabilityRules::for_vehicle(&Vehicle::default());
    let judged = |slope: f64| {
        let hole = |i: i64, j: i64| (3..=5).contains(&i) && (-1..=1).contains(&j);
        let mut map = map_with(MapRules::MENDED);
        let sight = Some(Sight { towards: DVec2::NEG_X, slope });
        let points: Vec<MapPoint> = map
            .points()
            .filter(|point| !hole(point.i, point.j))
            .map(|point| MapPoint { point: map.place(point).extend(0.0), standard_error: 0.01, sight })
            .collect();
        map.insert(points);
        judge(&rules, &map)
    };
    assert_eq!(judged(0.5), Traversability::Clear);
    let Traversability::Unknown(missing) = judged(1.5) else { panic!("a rock of 0.35 m may hide there") };
    assert_eq!(missing.reason, MissingReason::MayHide);
}

#[test]
fn the_vehicle_stands_the_same_after_one_more_step() {
    // Level ground at 0 and at 0.3 m from x = 1.3 on. The printed iteration swings where a front wheel meets the edge.
    let corner = |x: f64, y: f64, z: f64| DVec3::new(x, y, z);
    let ground = Ground {
        vertices: vec![
            corner(-9.0, -9.0, 0.0),
            corner(1.3, -9.0, 0.0),
            corner(1.3, 9.0, 0.0),
            corner(-9.0, 9.0, 0.0),
            corner(1.3, -9.0, 0.3),
            corner(9.0, -9.0, 0.3),
            corner(9.0, 9.0, 0.3),
            corner(1.3, 9.0, 0.3),
        ],
        faces: vec![[0, 1, 2], [0, 2, 3], [1, 4, 7], [1, 7, 2], [4, 5, 6], [4, 6, 7]],
        face_materials: vec![0; 6],
        materials: vec![Material { name: "ground".into(), reflectivity: 0.25 }],
    };
    let mesh = ground.into_mesh().unwrap();
    let (heights, faces, vehicle) = (HeightIndex::new(&mesh), GroundFaces::new(&mesh), Vehicle::default());
    let places: Vec<DVec2> = (0..60).map(|n| DVec2::new(0.3 + 0.02 * f64::from(n), 0.0)).collect();
    let swings = |place: &&DVec2| vehicle.settle(&heights, **place, 0.0).unwrap().residual > 0.01;
    let swinging: Vec<&DVec2> = places.iter().filter(swings).collect();
    assert!(!swinging.is_empty(), "the printed iteration converges everywhere");
    for place in &places {
        let stance = vehicle.stand(&faces, *place, 0.0).unwrap();
        assert!(stance.residual < 1e-9, "{place}: {}", stance.residual);
    }
    // On its way over the edge it never jumps: 2 cm of way turn it by at most a few degrees.
    for pair in places.windows(2) {
        let [before, after] =
            [pair[0], pair[1]].map(|place| vehicle.stand(&faces, place, 0.0).unwrap().attitude);
        assert!((before.pitch_down - after.pitch_down).abs() < 0.1, "{before:?} {after:?}");
    }
}

#[test]
fn an_elevation_that_is_off_is_seen_by_the_ground_that_stripes_meet_again() {
    // Level ground, measured from x = 0. Then the vehicle drives 1 m with an inclinometer that is wrong by 2 degrees, and
    // believes to have risen by up to 1 m tan 2 = 0.035 m; its stripes meet the same ground again. Points are given as the
    // true, level vehicle measures them, so that only the elevation is wrong.
    let believed = |elevation| {
        let rules = MapRules { elevation, ..MapRules::MENDED };
        let level = |x| sensed(DVec2::new(x, 0.0), Attitude::default(), 0.0);
        let size = MapSize::default();
        let mut mapper = Mapper::with_rules(Vehicle::default(), size, rules, &level(0.0), 0.0);
        let swath = |x: f64| {
            (0..40).flat_map(move |i| {
                (-15..=15).map(move |j| DVec3::new(3.0 - x + 0.1 * f64::from(i), 0.1 * f64::from(j), 0.0))
            })
        };
        mapper.update(&level(0.0), swath(0.0).map(StripePoint::from));
        let tilted = Attitude { pitch_down: -2.0_f64.to_radians(), ..Attitude::default() };
        let no_points: [DVec3; 0] = [];
        for step in 1..=10 {
            mapper.update(&sensed(DVec2::new(0.1 * f64::from(step), 0.0), tilted, 0.0), no_points);
        }
        let risen = mapper.pose().position.z;
        mapper.update(&level(1.0), swath(1.0).map(StripePoint::from));
        (risen, mapper.pose().position.z)
    };
    let (risen, corrected) = believed(Rule::Mended);
    assert!((risen - 0.0332).abs() < 0.002, "{risen}");
    // The prediction's standard error after 1 m is 2 cm, that of the registration 1 cm: a fifth of the error is left.
    assert!(corrected.abs() < 0.25 * risen, "{corrected}");
    let (risen, kept) = believed(Rule::Paper);
    assert!((kept - risen).abs() < 1e-12 && kept > 0.03, "{kept}");
}

/// Elevation that a vehicle believes on level ground at 0: it measured these cells (of 0.1 m) some 4 m ahead, drove 0.4 m, and now
/// its stripe meets the middle one at this height, 30 times.
fn believed_after(cells: &[(i32, i32, f64)], height: f64) -> f64 {
    let at = |x: f64| sensed(DVec2::new(x, 0.0), Attitude::default(), 0.0);
    let mut mapper =
        Mapper::with_rules(Vehicle::default(), MapSize::default(), MapRules::MENDED, &at(0.0), 0.0);
    let place = |&(i, j, z): &(i32, i32, f64)| DVec3::new(4.0 + 0.1 * f64::from(i), 0.1 * f64::from(j), z);
    mapper.update(&at(0.0), cells.iter().map(place).map(StripePoint::from));
    let no_points: [DVec3; 0] = [];
    for step in 1..4 {
        mapper.update(&at(0.1 * f64::from(step)), no_points);
    }
    let met = (-15..15).map(|n| DVec3::new(3.6, 0.003 * f64::from(n), height));
    mapper.update(&at(0.4), met.map(StripePoint::from));
    mapper.pose().position.z
}

#[test]
fn a_stripe_that_climbs_a_thing_is_no_error_of_the_vehicle() {
    // A post 0.1 m wide and 1 m high: the far stripe met its face near the top, and the ground before it and at its corners. The plane
    // through these cells is not steeper than 1. 0.4 m on, the stripe meets the face 0.36 m lower.
    let post = [(-1, -1, 0.0), (-1, 0, 0.0), (-1, 1, 0.0), (0, 0, 0.99), (1, -1, 0.0), (1, 1, 0.0)];
    let believed = believed_after(&post, 0.63);
    assert!(believed.abs() < 1e-12, "{believed}");
}

/// What [`believed_after`] gives where the middle one of nine level cells is higher by `step`, and the stripe is so far off their plane.
fn believed_over_a_step(step: f64, off: f64) -> f64 {
    let around = (-1..=1).flat_map(|i| (-1..=1).map(move |j| (i, j)));
    let cells: Vec<_> = around.map(|(i, j)| (i, j, if (i, j) == (0, 0) { step } else { 0.0 })).collect();
    believed_after(&cells, step / 9.0 + off)
}

#[test]
fn an_unexpected_error_is_taken_from_ground_up_to_its_limit_of_roughness() {
    // Of nine cells the middle one is higher by h: they lie off their plane by h sqrt(8) / 9 = 0.3143 h. The limit is 0.35 of
    // their spacing, that is h = 0.1114 m. A stripe 0.3 m above that plane says that the vehicle believes to be too high.
    for (step, is_corrected) in [(0.0, true), (0.111, true), (0.112, false), (1.0, false)] {
        let believed = believed_over_a_step(step, 0.3);
        assert_eq!(believed < -0.1, is_corrected, "{step}: {believed}");
        assert!(is_corrected || believed.abs() < 1e-12, "{step}: {believed}");
    }
}

#[test]
fn an_error_is_expected_up_to_three_deviations_and_a_step() {
    // After 0.4 m the variance is 0.4 (2 cm)^2, that of the stripe (1 cm)^2: three deviations are 0.0484 m. A surface may hold a
    // step of 0.1114 m. So 0.1597 m of error are taken from any ground, and more from one surface alone.
    for (off, is_corrected) in [(0.1592, true), (0.1602, false), (-0.1592, true), (-0.1602, false)] {
        let believed = believed_over_a_step(0.5, off);
        assert_eq!(believed.abs() > 0.05, is_corrected, "{off}: {believed}");
    }
}

#[test]
fn slopes_fail_a_thousandth_above_their_limits_and_pass_a_thousandth_below() {
    // Without margins the errors of the points do not matter. All limits are a rise of 0.35 m: between the front wheels,
    // between the rear ones, and between the axles. The wheels stand on level ground each, so that their centres are R
    // above it. Under the rear wheel alone, from x = -0.6 m to 0.2 m, the ground is higher, but not under the belly,
    // which ends at y = 0.375 m.
    let margins = ErrorMargins { obstacle: 0.0, clear: 0.0 };
    let rules = TraversabilityRules { margins, ..TraversabilityRules::for_vehicle(&Vehicle::default()) };
    type Cells = fn(i64, i64) -> bool;
    let is_higher: [(TraversabilityTest, Cells); 3] = [
        (TraversabilityTest::Front, |_, j| j > 0),
        (TraversabilityTest::Rear, |i, j| (-6..=2).contains(&i) && (4..=7).contains(&j)),
        (TraversabilityTest::Length, |i, _| i > 4),
    ];
    for (test, is_higher) in is_higher {
        let ground = |rise: f64| measured(move |i, j| Some(if is_higher(i, j) { rise } else { 0.0 }));
        assert_eq!(judge(&rules, &ground(0.3496)), Traversability::Clear, "{test:?}");
        assert_eq!(judge(&rules, &ground(0.3504)), Traversability::Obstacle(test), "{test:?}");
    }
}

#[test]
fn a_wheel_that_is_measured_at_its_rim_alone_is_not_therefore_low() {
    // A plane that falls by 0.2 to the left; the limit across is 0.35. The vehicle stood at x = 0 and 0.1 m, and by the rule
    // `Circle` the ground around it is taken to be the plane of its wheels. Points were measured from x = 0.4 m on the right, from 1.1 m on
    // the left. With the front axle at 2 m the rear wheels are at 0.8 m. On the left only points at the front end of the
    // rim are measured, 0.3 m before the hub, which by them is sqrt(0.35^2 - 0.3^2) = 0.18 m above the ground and not
    // 0.35 m: the rise from left to right would be 0.37 m. By the plane of the wheels it is 0.2 m.
    let (attitude, vehicle) = (on_plane(DVec2::new(0.0, -0.2)), Vehicle::default());
    let verdict = |step: f64| {
        let at = |x: f64| sensed(DVec2::new(x, 0.0), attitude, 0.0);
        let size = MapSize { spacing: 0.1, points: 61 };
        let rules = MapRules { start: StartRule::Circle, ..MapRules::MENDED };
        let mut mapper = Mapper::with_rules(vehicle, size, rules, &at(0.0), 0.0);
        let no_points: [DVec3; 0] = [];
        mapper.update(&at(0.0), no_points);
        let vehicle_from_global = attitude.at(DVec3::new(0.1, 0.0, 0.0)).inverse();
        let places = (4..=29).flat_map(|i| (-15..=15).map(move |j| (i, j)));
        let points = places.filter(|&(i, j)| j < -2 || i >= 11).map(|(i, j)| {
            let (x, y) = (0.1 * f64::from(i), 0.1 * f64::from(j));
            let raised = if i < 13 && j < -2 { step } else { 0.0 };
            vehicle_from_global * DVec3::new(x, y, -0.2 * y + raised)
        });
        mapper.update(&at(0.1), points);
        let rules = TraversabilityRules::for_vehicle(&vehicle);
        rules.classify(&MapWithShadows::of(mapper.map()), &vehicle, DVec2::new(2.0, 0.0), DVec2::X)
    };
    let Traversability::Unknown(missing) = verdict(0.0) else { panic!("{:?}", verdict(0.0)) };
    assert_eq!((missing.part, missing.reason), (VehiclePart::RearWheel, MissingReason::NotMeasured));
    let place = missing.place;
    assert!((0.4..1.05).contains(&place.x) && (0.35..0.65).contains(&place.y), "{place}");
    // With the right wheel on a step of 0.2 m the rise is 0.4 m by the plane of the wheels, too.
    assert_eq!(verdict(0.2), Traversability::Obstacle(TraversabilityTest::Rear));
}

/// Labels and first radii of all sectors of a vehicle at the origin, by a map with this rule, of level ground that was measured
/// by a scan from x = 0.95 m on, before the front wheels.
fn after_a_scan(start: StartRule) -> Vec<(Label, Option<MissingReason>, f64)> {
    let vehicle = Vehicle::default();
    let rules = MapRules { start, ..MapRules::MENDED };
    let at = sensed(DVec2::ZERO, Attitude::default(), 0.0);
    let mut mapper = Mapper::with_rules(vehicle, MapSize { spacing: 0.1, points: 161 }, rules, &at, 0.0);
    let seen = (10..60)
        .flat_map(|i| (-40..=40).map(move |j| DVec3::new(0.1 * f64::from(i), 0.1 * f64::from(j), 0.0)));
    mapper.update_from_scan(&at, seen, true);
    let (rules, grid) = (TraversabilityRules::for_vehicle(&vehicle), RadialGrid::for_vehicle(&vehicle));
    let map = ObstacleMap::extract(mapper.map(), &vehicle, &rules, &grid, &mapper.pose());
    map.sectors.iter().map(|end| (end.label, end.missing.map(|missing| missing.reason), end.radius)).collect()
}

#[test]
fn no_sector_is_clear_past_ground_that_was_never_measured() {
    // The imaginary vehicle's rear wheels are where the real one stands, or beside it. No scan sees that ground: a rock may
    // stand there beside the body.
    for (label, reason, radius) in after_a_scan(StartRule::Origin) {
        assert_eq!((label, reason), (Label::Unknown, Some(MissingReason::NotMeasured)));
        assert!((radius - 0.7).abs() < 1e-9, "{radius}");
    }
    // Who knows that the start is levelled may say so: then the ahead is clear to the end.
    let assumed = after_a_scan(StartRule::Circle);
    assert_eq!(assumed[15].0, Label::Visibility, "{assumed:?}");
}

#[test]
fn by_driving_over_a_steep_plane_it_is_clear_to_the_end() {
    // 6 m along planes that fall to one side by 0.30 and 0.33, with the limit at 0.35 and perfect sensors. A point is good to
    // 2.5 mm, as those of the default rig. What was measured some metres before is as good as ever.
    for slope in [0.30, 0.33] {
        let slope = DVec2::new(0.0, slope);
        let attitude = on_plane(slope);
        let reading = |x: f64| sensed(DVec2::new(x, 0.013), attitude, 0.0);
        let truth = |x: f64| slope.dot(DVec2::new(x, 0.013));
        let size = MapSize { spacing: 0.1, points: 161 };
        let mut mapper = Mapper::start(Vehicle::default(), size, &reading(0.0), truth(0.0));
        for frame in 0..=200 {
            let points =
                stripes().map(|point| StripePoint { point, standard_error: 0.0025, seen_from: None });
            mapper.update(&reading(0.03 * f64::from(frame)), points);
        }
        let vehicle = Vehicle::default();
        let (rules, grid) = (TraversabilityRules::for_vehicle(&vehicle), RadialGrid::for_vehicle(&vehicle));
        let obstacles = ObstacleMap::extract(mapper.map(), &vehicle, &rules, &grid, &mapper.pose());
        for sector in &obstacles.sectors[8..=22] {
            assert_eq!(sector.label, Label::Visibility, "{slope}: {sector:?}");
        }
    }
}

#[test]
fn a_map_at_its_grid_points_is_the_plane_without_bias() {
    // The map keeps the mean of a cell's points, which lie beside the grid point: on a slope of 0.3 by up to 15 mm. At the grid points
    // themselves, guesses beside the last stripe among them, it is the plane.
    for slope in [DVec2::new(0.0, 0.30), DVec2::new(0.3, 0.1), DVec2::new(-0.25, 0.2)] {
        let (mapper, _) = drive_over_plane(slope, 3.0, MapRules::MENDED);
        let map = mapper.map();
        let mean = |of: &dyn Fn(GridPoint) -> Option<f64>, source| {
            let points = map.points().filter(|&point| map.source(point) == source);
            let off: Vec<f64> =
                points.filter_map(|point| Some(of(point)? - slope.dot(map.place(point)))).collect();
            let largest = off.iter().fold(0.0_f64, |most, off| most.max(off.abs()));
            (off.iter().sum::<f64>() / off.len() as f64, largest)
        };
        let kept = |point| map.elevation(point);
        let carried = |point| map.estimate(point).map(|estimate| estimate.elevation);
        assert!(mean(&kept, ElevationSource::Measured).1 > 2e-3);
        for source in [ElevationSource::Measured, ElevationSource::Extrapolated] {
            let (bias, largest) = mean(&carried, source);
            // A few guesses at the ends of stripes have too few points around for a plane, and stay as they are.
            let is_guess = source == ElevationSource::Extrapolated;
            assert!(bias.abs() < if is_guess { 5e-3 } else { 1e-3 }, "{slope}, {source:?}: {bias}");
            assert!(is_guess || largest < 1e-9, "{slope}, {source:?}: {largest}");
        }
        // The points have a standard error of 1 cm, and less where several were blended. Carried to the grid point it is
        // larger, and larger still for a guess beyond them.
        let mean_error = |source| {
            let points = map.points().filter(|&point| map.source(point) == source);
            let errors: Vec<f64> = points.filter_map(|point| map.estimate(point)?.standard_error).collect();
            errors.iter().sum::<f64>() / errors.len() as f64
        };
        let [measured, guessed] = [ElevationSource::Measured, ElevationSource::Extrapolated].map(mean_error);
        assert!(measured > 2e-3 && measured < guessed && guessed < 0.1, "{measured} {guessed}");
    }
    // As printed, a grid point "inherits the elevation" of its point.
    let (mapper, _) = drive_over_plane(DVec2::new(0.1, 0.0), 1.0, MapRules::AS_PRINTED);
    let map = mapper.map();
    assert!(map.points().all(|at| map.estimate(at).map(|estimate| estimate.elevation) == map.elevation(at)));
}

#[test]
fn the_top_of_a_stone_is_not_lowered_by_its_flank() {
    // Level ground, and in the cell of the left front wheel's centre a stone of which one frame sees the top, 0.36 m high, and ten
    // later ones the flank, 2 cm lower at the same place: less than three standard deviations, no step. Their mean is
    // 0.342 m, below the limit of 0.35 m between the wheels; the wheel stands on the top.
    let margins = ErrorMargins { obstacle: 0.0, clear: 0.0 };
    let rules = TraversabilityRules { margins, ..TraversabilityRules::for_vehicle(&Vehicle::default()) };
    let mut map =
        measured(|i, j| Some(if (9..=11).contains(&i) && (4..=6).contains(&j) { 0.33 } else { 0.0 }));
    map.insert([DVec3::new(1.0, 0.5, 0.36)]);
    for _ in 0..10 {
        map.insert([DVec3::new(1.0, 0.5, 0.34)]);
    }
    let mean = map.elevation(GridPoint { i: 10, j: 5 }).unwrap();
    assert!((0.335..0.345).contains(&mean), "{mean}");
    assert_eq!(judge(&rules, &map), Traversability::Obstacle(TraversabilityTest::Front));
    // Without that one frame, and level with what is around it, it may pass.
    let mut map =
        measured(|i, j| Some(if (9..=11).contains(&i) && (4..=6).contains(&j) { 0.34 } else { 0.0 }));
    for _ in 0..10 {
        map.insert([DVec3::new(1.0, 0.5, 0.34)]);
    }
    assert_eq!(judge(&rules, &map), Traversability::Clear);
}
