//! The vehicle's elevation, and the order of a map update.

use glam::{DVec2, DVec3};
use raypencil_rover::{Attitude, LocalisationReading, MapSize, Mapper, Vehicle};

fn sensed(x: f64, proximity: Option<f64>) -> LocalisationReading {
    LocalisationReading { position: DVec2::new(x, 0.0), attitude: Attitude::default(), proximity }
}

fn mapper() -> Mapper {
    Mapper::start(Vehicle::default(), MapSize::default(), &sensed(0.0, Some(0.0)), 5.0)
}

#[test]
fn at_the_start_the_map_knows_what_is_under_the_vehicle() {
    // Half length 0.6 + 0.35 = 0.95 m, half width 0.625 m: 19 columns of 13 grid points.
    let mapper = mapper();
    assert_eq!(mapper.known_count(), 19 * 13);
    let map = mapper.map();
    assert_eq!(map.elevation(map.nearest(DVec2::new(0.9, -0.6))), Some(5.0));
    assert_eq!(map.source(map.nearest(DVec2::new(1.0, 0.0))).key(), 's');
    // Standing 5 cm above the ground, which is then at 4.95 m.
    let start = sensed(0.0, Some(0.05));
    let raised = Mapper::start(Vehicle::default(), MapSize::default(), &start, 5.0);
    assert_eq!(raised.map().elevation(raised.map().centre()), Some(4.95));
}

#[test]
fn under_a_tilted_vehicle_the_ground_is_tilted() {
    // Nose up by atan 1/4: 0.4 m ahead it is 0.1 m higher.
    let attitude = Attitude { pitch_down: -libm::atan(0.25), ..Attitude::default() };
    let start = LocalisationReading { attitude, ..sensed(0.0, Some(0.0)) };
    let mapper = Mapper::start(Vehicle::default(), MapSize::default(), &start, 5.0);
    let map = mapper.map();
    let ahead = map.elevation(map.nearest(DVec2::new(0.4, 0.3))).unwrap();
    assert!((ahead - 5.1).abs() < 1e-12, "{ahead}");
}

#[test]
fn elevation_comes_from_the_old_map_before_new_points() {
    let mut mapper = mapper();
    // The old map has 5.0 below; the proximity sensor says 0.2 m above it. The new point at 9 m, on the very same
    // cell, was measured from that elevation: 5.2 + 3.8.
    let update = mapper.update(&sensed(0.4, Some(0.2)), [DVec3::new(0.0, 0.0, 3.8)]);
    assert!(update.elevation_read && update.moved == (4, 0));
    assert_eq!(mapper.pose().position, DVec3::new(0.4, 0.0, 5.2));
    assert_eq!(mapper.map().elevation(mapper.map().centre()), Some(9.0));
}

#[test]
fn where_the_map_does_not_know_the_vehicle_goes_on_along_its_plane() {
    let mut mapper = mapper();
    let attitude = Attitude { pitch_down: -libm::atan(0.25), ..Attitude::default() };
    let update = mapper.update(&LocalisationReading { attitude, ..sensed(4.0, Some(0.3)) }, []);
    assert!(!update.elevation_read);
    assert!((mapper.pose().position.z - 6.0).abs() < 1e-12);
}

#[test]
fn a_scan_forgets_what_was_there() {
    let mut mapper = mapper();
    mapper.update(&sensed(0.0, Some(0.0)), [DVec3::new(4.0, 1.0, 0.5)]);
    assert_eq!(mapper.known_count(), 19 * 13 + 9);
    // Two stripes: (3.0, 0) and its eight neighbours, of which (3.1, 0) is measured itself.
    let stripes = [DVec3::new(3.1, 0.0, 0.2), DVec3::new(3.0, 0.0, 0.1)];
    mapper.update_from_scan(&sensed(0.0, Some(0.0)), stripes, true);
    assert_eq!(mapper.known_count(), 19 * 13 + 12);
    let map = mapper.map();
    assert_eq!(map.elevation(map.nearest(DVec2::new(3.1, 0.0))), Some(5.2));
    // Without forgetting, the rest stays.
    mapper.update_from_scan(&sensed(0.0, Some(0.0)), [DVec3::new(-4.0, 0.0, 0.0)], false);
    assert_eq!(mapper.known_count(), 19 * 13 + 21);
}
