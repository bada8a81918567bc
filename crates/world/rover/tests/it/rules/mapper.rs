//! The estimated elevation of the vehicle, and the order of a map update.

use glam::{DVec2, DVec3};
use raypencil_rover::{
    Attitude, ElevationSource, KnownDrift, KnownNoise, LocalisationReading, MapRules, MapSize, Mapper,
    StartRule, Vehicle,
};

const NO_POINTS: [DVec3; 0] = [];

fn sensed(x: f64, proximity: Option<f64>) -> LocalisationReading {
    LocalisationReading { position: DVec2::new(x, 0.0), attitude: Attitude::default(), proximity }
}

/// The printed rules, with all ground under the vehicle known at the start.
const RULES: MapRules = MapRules { start: StartRule::Footprint, ..MapRules::AS_PRINTED };

fn mapper_on(sensed: &LocalisationReading, rules: MapRules) -> Mapper {
    Mapper::with_rules(Vehicle::default(), MapSize::default(), rules, sensed, 5.0)
}

fn mapper() -> Mapper {
    mapper_on(&sensed(0.0, Some(0.0)), RULES)
}

/// Number of grid points with a known elevation.
fn known_count(mapper: &Mapper) -> usize {
    let map = mapper.map();
    map.points().filter(|&point| map.source(point) != ElevationSource::Unknown).count()
}

#[test]
fn at_the_start_the_map_knows_the_point_under_the_origin() {
    // 0.05 m below an origin at 5 m.
    for rules in [MapRules::AS_PRINTED, MapRules::MENDED] {
        let mapper = mapper_on(&sensed(0.0, Some(0.05)), rules);
        assert_eq!(known_count(&mapper), 1);
        assert_eq!(mapper.map().elevation(mapper.map().centre()), Some(4.95));
    }
    assert_eq!(known_count(&mapper_on(&sensed(0.0, None), MapRules::MENDED)), 0);
}

#[test]
fn by_the_footprint_the_map_knows_what_is_under_the_vehicle() {
    // The half length is 0.6 + 0.35 = 0.95 m, the half width 0.625 m: 19 columns of 13 grid points.
    let mapper = mapper();
    assert_eq!(known_count(&mapper), 19 * 13);
    let map = mapper.map();
    assert_eq!(map.elevation(map.nearest(DVec2::new(0.9, -0.6))), Some(5.0));
    assert_eq!(map.source(map.nearest(DVec2::new(1.0, 0.0))).key(), 's');
    // The vehicle is 5 cm above the ground, which is therefore at 4.95 m.
    let start = sensed(0.0, Some(0.05));
    let raised = mapper_on(&start, RULES);
    assert_eq!(raised.map().elevation(raised.map().centre()), Some(4.95));
}

#[test]
fn under_a_tilted_vehicle_the_ground_is_tilted() {
    // The vehicle pitches up by atan 1/4: 0.4 m ahead, the ground is 0.1 m higher.
    let attitude = Attitude { pitch_down: -libm::atan(0.25), ..Attitude::default() };
    let start = LocalisationReading { attitude, ..sensed(0.0, Some(0.0)) };
    let mapper = mapper_on(&start, RULES);
    let map = mapper.map();
    let ahead = map.elevation(map.nearest(DVec2::new(0.4, 0.3))).unwrap();
    assert!((ahead - 5.1).abs() < 1e-12, "{ahead}");
}

#[test]
fn elevation_comes_from_the_old_map_before_new_points() {
    let mut mapper = mapper();
    // The old map has 5.0 m below the vehicle, and the proximity sensor measures 0.2 m: the vehicle is at 5.2 m. The
    // new point in the same cell, 3.8 m above the vehicle, is at 9 m.
    let update = mapper.update(&sensed(0.4, Some(0.2)), [DVec3::new(0.0, 0.0, 3.8)]);
    assert!(update.elevation_read && update.moved == (4, 0));
    assert_eq!(mapper.pose().position, DVec3::new(0.4, 0.0, 5.2));
    assert_eq!(mapper.map().elevation(mapper.map().centre()), Some(9.0));
}

#[test]
fn points_turn_with_the_vehicle() {
    // Turned to the left by 90 degrees, the vehicle looks along global y and has global -x on its left: a point 3 m
    // ahead, 1 m to the left and 0.5 m up is at (-1, 3), 0.5 m above the vehicle's 5 m.
    let attitude = Attitude { heading: std::f64::consts::FRAC_PI_2, ..Attitude::default() };
    let turned = LocalisationReading { attitude, ..sensed(0.0, Some(0.0)) };
    let point = [DVec3::new(3.0, 1.0, 0.5)];
    let by: [fn(&mut Mapper, &LocalisationReading, [DVec3; 1]); 2] = [
        |mapper, sensed, point| _ = mapper.update(sensed, point),
        |mapper, sensed, point| _ = mapper.update_from_scan(sensed, point, true),
    ];
    for update in by {
        let mut mapper = mapper();
        update(&mut mapper, &turned, point);
        let map = mapper.map();
        let at = map.nearest(DVec2::new(-1.0, 3.0));
        assert_eq!(map.source(at), ElevationSource::Measured);
        assert!((map.elevation(at).unwrap() - 5.5).abs() < 1e-12);
    }
}

#[test]
fn over_unknown_ground_the_vehicle_moves_in_the_plane_of_its_wheels() {
    let mut mapper = mapper();
    let attitude = Attitude { pitch_down: -libm::atan(0.25), ..Attitude::default() };
    let update = mapper.update(&LocalisationReading { attitude, ..sensed(4.0, Some(0.3)) }, NO_POINTS);
    assert!(!update.elevation_read);
    assert!((mapper.pose().position.z - 6.0).abs() < 1e-12);
}

#[test]
fn a_scan_clears_the_map() {
    let mut mapper = mapper();
    mapper.update(&sensed(0.0, Some(0.0)), [DVec3::new(4.0, 1.0, 0.5)]);
    assert_eq!(known_count(&mapper), 19 * 13 + 9);
    // Two stripes: (3.0, 0) and (3.1, 0), which are neighbours. With theirs these are 4 columns of 3 points.
    let stripes = [DVec3::new(3.1, 0.0, 0.2), DVec3::new(3.0, 0.0, 0.1)];
    mapper.update_from_scan(&sensed(0.0, Some(0.0)), stripes, true);
    assert_eq!(known_count(&mapper), 19 * 13 + 12);
    let map = mapper.map();
    assert_eq!(map.elevation(map.nearest(DVec2::new(3.1, 0.0))), Some(5.2));
    // Without `clear_map` the other elevations stay.
    mapper.update_from_scan(&sensed(0.0, Some(0.0)), [DVec3::new(-4.0, 0.0, 0.0)], false);
    assert_eq!(known_count(&mapper), 19 * 13 + 21);
}

#[test]
fn a_pause_ages_measurements_as_so_much_time_between_frames_does() {
    // 5 mm a second: in 8 s a point of 1 cm gets another 4 cm of error, and the new point counts nearly alone.
    let elevation = |frame_time: f64, pause: f64| {
        let drift = KnownDrift { frame_time, position: 5e-3, ..KnownDrift::default() };
        let noise = KnownNoise { drift, ..KnownNoise::default() };
        let here = sensed(0.0, Some(0.0));
        let mut mapper = mapper_on(&here, MapRules::MENDED).with_noise(noise);
        let at = |z: f64| [DVec3::new(3.0, 0.0, z)];
        mapper.update(&here, at(0.0));
        mapper.pause(pause);
        mapper.update(&here, at(0.02));
        let map = mapper.map();
        map.elevation(map.nearest(DVec2::new(3.0, 0.0))).unwrap() - mapper.pose().position.z
    };
    let (paused, slow, none) = (elevation(0.1, 7.9), elevation(8.0, 0.0), elevation(0.1, 0.0));
    assert!((paused - slow).abs() < 1e-12, "{paused} {slow}");
    assert!(paused - none > 5e-3, "{paused} {none}");
}
