//! The elevation map by the printed rules: inheritance, extrapolation and motion.

use std::collections::HashMap;

use glam::{DVec2, DVec3};
use raypencil_rover::{ElevationMap, ElevationSource, GridPoint, MapRules, MapSize};

fn map() -> ElevationMap {
    ElevationMap::with_rules(MapSize::default(), DVec2::new(100.03, -50.02), MapRules::AS_PRINTED)
}

fn at(i: i64, j: i64) -> GridPoint {
    GridPoint { i, j }
}

#[test]
fn a_new_map_knows_nothing_and_is_the_papers() {
    let map = map();
    assert_eq!(map.points().count(), 201 * 201);
    // Row by row from the lowest x and y.
    let first: Vec<GridPoint> = map.points().take(2).collect();
    assert_eq!((&first[..], map.points().last()), (&[at(-100, -100), at(-99, -100)][..], Some(at(100, 100))));
    assert!(map.points().all(|point| map.source(point).key() == 's'));
    assert_eq!(map.place(at(0, 0)), DVec2::new(100.03, -50.02));
    // The side is 20 m.
    let corners = map.place(at(100, 100)) - map.place(at(-100, -100));
    assert!((corners - DVec2::splat(20.0)).length() < 1e-12);
    assert!(map.contains(at(100, -100)) && !map.contains(at(101, 0)));
}

#[test]
fn the_nearest_grid_point_inherits_and_its_neighbours_are_extrapolated() {
    let mut map = map();
    // Points 3 cm beside grid points (10, 0) and (11, 0).
    let edge = |i: f64, z: f64| (DVec2::new(100.03 + 0.1 * i + 0.03, -50.02)).extend(z);
    let found = map.insert([edge(10.0, 0.5), edge(11.0, 0.8)]);
    assert_eq!(found.count, 0);
    assert_eq!((map.elevation(at(10, 0)), map.source(at(10, 0))), (Some(0.5), ElevationSource::Measured));
    assert_eq!(map.elevation(at(11, 0)), Some(0.8));
    // (9, j) is a neighbour of the first point only, and (12, j) of the second. (10, 1) and (11, 1) are neighbours of
    // both: the later one counts.
    assert_eq!(map.elevation(at(9, 1)), Some(0.5));
    assert_eq!(map.elevation(at(10, 1)), Some(0.8));
    assert_eq!(map.elevation(at(11, -1)), Some(0.8));
    assert_eq!((map.elevation(at(12, 0)), map.source(at(12, 0))), (Some(0.8), ElevationSource::Extrapolated));
    assert_eq!(map.points().filter(|point| map.source(*point).key() == 'u').count(), 3 * 4);
    // New data overwrite a measured neighbour of an earlier update. Of several points in a cell the last one counts.
    map.insert([edge(12.0, 0.1), edge(12.0, 0.2)]);
    assert_eq!(map.elevation(at(12, 0)), Some(0.2));
    assert_eq!((map.elevation(at(11, 0)), map.source(at(11, 0))), (Some(0.2), ElevationSource::Extrapolated));
    // The paper says that there is inconsistency, and not how to see it: nothing is compared.
    let found = map.insert([edge(12.0, 0.5), edge(40.0, 7.0)]);
    assert_eq!(found.count, 0);
}

#[test]
fn points_beyond_the_map_and_points_that_are_not_finite_are_ignored() {
    let mut map = map();
    map.insert([DVec3::new(0.0, 0.0, 1.0), DVec3::NAN]);
    assert!(map.points().all(|point| map.source(point) == ElevationSource::Unknown));
    // Neighbours beyond the border do not appear at the opposite side.
    map.insert([map.place(at(100, 0)).extend(1.0)]);
    assert_eq!(map.points().filter(|point| map.source(*point).key() == 'u').count(), 6);
    assert_eq!(map.source(at(-100, 0)), ElevationSource::Unknown);
}

#[test]
fn the_map_moves_in_whole_steps() {
    let mut map = map();
    // 0.44 m and -0.26 m are 4.4 and -2.6 spacings: 4 and -3 steps.
    let start = DVec2::new(100.03, -50.02);
    assert_eq!(map.recentre(start + DVec2::new(0.44, -0.26)), (4, -3));
    assert_eq!(map.recentre(start + DVec2::new(0.41, -0.34)), (0, 0));
    assert!((map.place(map.centre()) - start - DVec2::new(0.4, -0.3)).length() < 1e-12);
}

#[test]
fn no_cell_moves_in_global_coordinates() {
    // A random walk of 10000 steps on a map of 41 by 41 points (4 m), with a measured point in some steps. A hash map
    // of known points is the reference: a point that left the map is unknown from then on.
    let mut map = ElevationMap::new(MapSize { spacing: 0.1, points: 41 }, DVec2::new(1e6, -2e5));
    let mut known: HashMap<GridPoint, (DVec2, f64)> = HashMap::new();
    let random = raypencil_scene::Sampling::Jittered { seed: 5 };
    let (mut place, mut heading, mut compared) = (DVec2::new(1e6, -2e5), 0.0, 0);
    for step in 0..10_000 {
        let [way, turn] = random.offset(0, step, 0);
        heading += 2.0 * turn;
        place += DVec2::new(libm::cos(heading), libm::sin(heading)) * (way + 0.5);
        map.recentre(place);
        known.retain(|point, _| map.contains(*point));
        if step % 3 == 0 {
            // No known point is near it, so that no other elevation changes.
            let [x, y] = random.offset(1, step, 0);
            let point = map.nearest(place + DVec2::new(x, y) * 3.9);
            let around = |other: &GridPoint| (other.i - point.i).abs() <= 1 && (other.j - point.j).abs() <= 1;
            if map.contains(point) && !known.keys().any(around) {
                map.insert([map.place(point).extend(f64::from(step))]);
                for other in map.points().filter(around) {
                    known.insert(other, (map.place(other), f64::from(step)));
                }
            }
        }
        if step % 50 == 0 || step > 9_990 {
            for point in map.points() {
                let held = map.elevation(point).map(|z| (map.place(point), z));
                assert_eq!(held, known.get(&point).copied(), "step {step}");
            }
            compared += known.len();
        }
    }
    assert!(map.centre() != at(0, 0) && compared > 1000, "{compared} known points compared");
}

#[test]
fn a_size_out_of_range_is_named() {
    let even = MapSize { points: 200, ..MapSize::default() };
    assert!(even.validate("map").unwrap_err().to_string().contains("map.points is 200"));
    assert!(MapSize { spacing: 0.0, ..even }.validate("map").is_err());
}
