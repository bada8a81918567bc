//! Obstacle maps of elevation maps made by hand.

use glam::{DVec2, DVec3};
use raypencil_rover::{
    ElevationMap, FRAMES_PER_OBSTACLE_MAP, Label, MapSize, ObstacleMap, RadialGrid, TraversabilityRules,
    TraversabilityTest, VectorRules, Vehicle, navigator_map, obstacle_map_due,
};
use raypencil_scene::Pose;

fn map(elevation: impl Fn(f64, f64) -> Option<f64>) -> ElevationMap {
    let mut map = ElevationMap::new(MapSize::default(), DVec2::ZERO);
    for point in map.points() {
        let place = map.place(point);
        if let Some(z) = elevation(place.x, place.y) {
            map.set_proximity(point, z);
        }
    }
    map
}

fn obstacles(map: &ElevationMap, heading: f64) -> ObstacleMap {
    let vehicle = Vehicle::default();
    let (rules, grid) = (TraversabilityRules::as_printed(&vehicle), RadialGrid::for_vehicle(&vehicle));
    let pose = Pose::from_axis_angle(DVec3::Z, heading);
    ObstacleMap::extract(map, &vehicle, &rules, &grid, &pose)
}

#[test]
fn on_level_ground_every_sector_ends_at_the_visibility_limit() {
    let all = obstacles(&map(|_, _| Some(0.0)), 0.0);
    assert_eq!(all.sectors.len(), 31);
    for sector in &all.sectors {
        assert_eq!((sector.label, sector.failed), (Label::Visibility, None));
        assert!((sector.radius - 4.8).abs() < 1e-12);
    }
    // The sectors go from right to left, 2 degrees apart; the middle one is straight ahead.
    assert!((all.sectors[0].direction + 30.0_f64.to_radians()).abs() < 1e-12);
    assert!(all.sectors[15].direction.abs() < 1e-12);
    assert!((all.sectors[30].point - DVec2::new(4.8 * 0.75_f64.sqrt(), 2.4)).length() < 1e-12);
}

#[test]
fn a_step_of_0_4_m_is_an_obstacle_and_one_of_0_1_m_is_not() {
    // The step is at x = 3. Straight ahead, c) from axle to axle fails when the front axle's grid point is at 3 or
    // beyond and the rear one's is not: 0.4 over 1.2 m; the limit is 0.35 over 1.2 m. Radius 3.0 is 0.7 + 23 * 0.1.
    let high = map(|x, _| Some(if x > 2.95 { 0.4 } else { 0.0 }));
    let ahead = obstacles(&high, 0.0).sectors[15];
    assert_eq!((ahead.label, ahead.failed), (Label::Obstacle, Some(TraversabilityTest::Length)));
    assert!((ahead.radius - 3.0).abs() < 1e-9);
    // At an angle, one front wheel meets the step first: a), 0.4 over 1.0 m. At 30 degrees to the left it is the right
    // wheel: 3 = r cos 30 + 0.5 sin 30.
    let aside = obstacles(&high, 0.0).sectors[30];
    assert_eq!((aside.label, aside.failed), (Label::Obstacle, Some(TraversabilityTest::Front)));
    let r = 2.75 / 0.75_f64.sqrt();
    assert!((aside.radius - r).abs() <= 0.16, "{} for {r}", aside.radius);
    let low = map(|x, _| Some(if x > 2.95 { 0.1 } else { 0.0 }));
    assert!(obstacles(&low, 0.0).sectors.iter().all(|sector| sector.label == Label::Visibility));
}

#[test]
fn testing_stops_at_the_first_point_that_is_not_clear() {
    // The ground is unknown from x = 2 on, with a wall from x = 3 on: testing does not reach the wall.
    let hidden = map(|x, _| (x < 1.95).then_some(0.0).or((x > 2.95).then_some(2.0)));
    let ahead = obstacles(&hidden, 0.0).sectors[15];
    assert_eq!((ahead.label, ahead.failed), (Label::Unknown, None));
    assert!((ahead.radius - 2.0).abs() < 1e-9);
}

#[test]
fn the_grid_turns_with_the_vehicle_and_the_map_does_not() {
    // A wall beyond y = 3 is ahead of a vehicle with heading +y.
    let wall = map(|_, y| Some(if y > 2.95 { 1.0 } else { 0.0 }));
    let north = obstacles(&wall, std::f64::consts::FRAC_PI_2);
    assert_eq!(north.sectors[15].label, Label::Obstacle);
    assert!((north.sectors[15].point - DVec2::new(0.0, 3.0)).length() < 1e-9);
    assert_eq!(obstacles(&wall, 0.0).sectors[15].label, Label::Visibility);
}

#[test]
fn every_tenth_frame() {
    let due: Vec<u64> = (0..35).filter(|&frame| obstacle_map_due(frame, FRAMES_PER_OBSTACLE_MAP)).collect();
    assert_eq!(due, [0, 10, 20, 30]);
}

#[test]
fn a_grid_out_of_range_is_named() {
    let grid = RadialGrid::for_vehicle(&Vehicle::default());
    assert!(grid.validate("grid").is_ok());
    let short = RadialGrid { last: 0.1, ..grid };
    assert!(short.validate("grid").unwrap_err().to_string().starts_with("grid.last is 0.1"));
}

#[test]
fn a_grid_of_too_many_points_is_refused() {
    // Radii from 1 to 100.75 in steps of 1/4: 400. With 25,000 sectors these are ten million points.
    let grid = RadialGrid { sectors: 25_000, half_angle: 1.0, first: 1.0, step: 0.25, last: 100.75 };
    assert_eq!(grid.radii(), 400);
    assert!(grid.validate("grid").is_ok());
    let error = RadialGrid { sectors: 25_001, ..grid }.validate("grid").unwrap_err().to_string();
    assert_eq!(
        error,
        "grid.sectors is 25001: expected 1 to 25000 (at most 10000000 grid points, 400 per sector)"
    );
    // The maximum number of radii, 1,000,001, allows 9 sectors.
    let long = RadialGrid { sectors: 10, first: 0.0, step: 1e-3, last: 1e3, ..grid };
    assert!(long.validate("grid").unwrap_err().to_string().contains("expected 1 to 9 ("));
    assert!(RadialGrid { sectors: 9, ..long }.validate("grid").is_ok());
}

#[test]
fn a_rock_on_the_left_is_an_obstacle_on_the_left_and_nowhere_else() {
    // A vehicle at (1.5, -0.5) with a heading of 35 degrees. A rock, 1 m high, is a disc of 0.2 m radius, 2.5 m away and
    // 20 degrees to the left: sector 25, since sector k is 2 (k - 15) degrees to the left.
    let (heading, centre) = (35.0_f64.to_radians(), DVec2::new(1.5, -0.5));
    let unit = |degrees: f64| {
        let (sin, cos) = libm::sincos(heading + degrees.to_radians());
        DVec2::new(cos, sin)
    };
    let rock = centre + unit(20.0) * 2.5;
    let ground = map(|x, y| Some(if (DVec2::new(x, y) - rock).length() < 0.2 { 1.0 } else { 0.0 }));
    let pose = Pose { position: centre.extend(0.0), ..Pose::from_axis_angle(DVec3::Z, heading) };
    let vehicle = Vehicle::default();
    let grid = RadialGrid::for_vehicle(&vehicle);
    let mended = TraversabilityRules::for_vehicle(&vehicle);
    let obstacles = ObstacleMap::extract(&ground, &vehicle, &mended, &grid, &pose);
    for (sector, end) in obstacles.sectors.iter().enumerate() {
        let degrees = 2.0 * (sector as f64 - 15.0);
        // Each point lies at its radius in the direction of its own sector.
        assert!((end.point - centre - unit(degrees) * end.radius).length() < 1e-12, "{sector}");
        // The rock in the axes of the sector. A vehicle 1.25 m wide meets it for certain if its middle is less than
        // 0.625 m aside, when its rims, 0.35 m before the front axle, reach it; a cell of 0.1 m and a step of 0.1 m
        // either way. It passes for certain if the rock is more than 0.625 + 0.2 + 0.15 m aside.
        let offset = rock - centre;
        let (ahead, aside) = (offset.dot(unit(degrees)), offset.perp_dot(unit(degrees)).abs());
        if aside < 0.6 {
            assert_eq!(end.label, Label::Obstacle, "{sector}");
            let met = ahead - 0.2 - 0.35;
            assert!(end.radius > met - 0.2 && end.radius < ahead + 0.2, "{sector}: {} for {met}", end.radius);
        } else if aside > 0.975 {
            assert_eq!(end.label, Label::Visibility, "{sector}");
            assert!((end.radius - 4.8).abs() < 1e-12, "{sector}: {}", end.radius);
        }
    }
    // Both kinds are there, and not in a mirror: 20 degrees to the right the way is free.
    assert_eq!(
        [5, 25].map(|sector: usize| obstacles.sectors[sector].label),
        [Label::Visibility, Label::Obstacle]
    );

    // The navigator map: from right to left, each vector from the end of its sector to that of the next.
    let rules = VectorRules::for_vehicle(&vehicle);
    let vectors = navigator_map(&obstacles, &rules);
    assert_eq!(vectors.len(), 30);
    for (index, vector) in vectors.iter().enumerate() {
        let ends = [obstacles.sectors[index].point, obstacles.sectors[index + 1].point];
        assert_eq!([vector.from, vector.to], ends, "{index}");
        // To the left: counter-clockwise about the vehicle.
        assert!((vector.from - centre).perp_dot(vector.to - centre) > 0.0, "{index}");
        if vector.label == Label::Obstacle {
            let middle = 0.5 * (vector.from + vector.to) - centre;
            assert!(unit(0.0).perp_dot(middle) > 0.0, "{index}: the rock is to the left");
        }
    }
    assert!(vectors.iter().any(|vector| vector.label == Label::Obstacle));
}
