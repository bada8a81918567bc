//! Obstacle maps and navigator maps against where the rock and the step are.

use serde_json::Value;

use super::driven::{CLEAN, Driven};
use super::geometry::sin_cos;
use super::ground::{Block, ROCK, STEP, ahead_and_left};
use super::maps::map_frames;
use super::poses::{Row, pose, rows};
use super::readers::{csv, number, numbers, pgm, yaml};

const SECTORS: usize = 31;
const FIRST: f64 = 0.7;
const LAST: f64 = 4.8;
const STEP_M: f64 = 0.1;

/// Sectors of the obstacle map of a frame, from right to left.
pub(crate) fn sectors(of: &Driven, frame: u64) -> Vec<Row> {
    let all = csv(&of.recorded("sectors.csv"), "\n");
    all.into_iter().filter(|row| number(row, "frame") == frame as f64).collect()
}

/// Global x and y where the vehicle believes to be in a frame, and its heading there.
pub(crate) fn believed(of: &Driven, frame: u64) -> ([f64; 2], f64) {
    let pose = pose(&rows(of)[frame as usize], "believed");
    let [x, y, _] = pose.direction([1.0, 0.0, 0.0]);
    ([pose.position[0], pose.position[1]], libm::atan2(y, x))
}

/// Distance ahead, in a direction, of the nearest part of a block within a distance aside.
fn nearest(block: &Block, from: [f64; 2], direction: f64, aside: f64) -> Option<f64> {
    let (sin, cos) = sin_cos(direction);
    let corners = block.corners();
    let mut nearest: Option<f64> = None;
    for side in 0..4 {
        let [[ax, ay], [bx, by]] = [corners[side], corners[(side + 1) % 4]];
        for share in (0..=1000).map(|n| f64::from(n) / 1000.0) {
            let [x, y] = [ax + share * (bx - ax) - from[0], ay + share * (by - ay) - from[1]];
            let (ahead, left) = (x * cos + y * sin, y * cos - x * sin);
            if left.abs() <= aside && ahead > 0.0 {
                nearest = Some(nearest.map_or(ahead, |least: f64| least.min(ahead)));
            }
        }
    }
    nearest
}

#[test]
fn sectors_lie_in_their_directions_and_end_at_what_is_there() {
    let mut at = [0; 2];
    for frame in map_frames() {
        let (sectors, (place, heading)) = (sectors(&CLEAN, frame), believed(&CLEAN, frame));
        assert_eq!(sectors.len(), SECTORS);
        for (index, row) in sectors.iter().enumerate() {
            let [sector, direction, radius, x, y] =
                numbers(row, ["sector", "direction_rad", "radius_m", "x_m", "y_m"]);
            assert_eq!(sector, index as f64);
            // 2 degrees apart, from the right to the left.
            let expected = heading + (2.0 * sector - 30.0).to_radians();
            assert!((direction - expected).abs() < 1e-9, "{row:?}: {expected}");
            let (sin, cos) = sin_cos(direction);
            let off = libm::hypot(x - place[0] - radius * cos, y - place[1] - radius * sin);
            assert!(off < 1e-9, "{row:?}");
            let steps = (radius - FIRST) / STEP_M;
            assert!((steps - steps.round()).abs() < 1e-9 && radius < LAST + 1e-9, "{row:?}");
            assert_eq!(row["label"] == "visibility", row["reason"].is_empty(), "{row:?}");

            // Blocks are higher than a wheel can climb. The vehicle is 1.25 m wide, and its rims are 0.35 m before its
            // front axle. Two cells of the map, by which points and wheels may be off, leave a sector open.
            let met = |aside: f64| [&ROCK, &STEP].map(|block| nearest(block, place, direction, aside));
            let certain = met(0.625 - 0.2).into_iter().flatten().reduce(f64::min);
            if let Some(ahead) = certain.filter(|ahead| *ahead < LAST) {
                assert!(radius < ahead + 0.2 && row["label"] != "visibility", "{row:?}: {ahead}");
            }
            let possible = met(0.625 + 0.2);
            let [rock, step] = possible
                .map(|ahead| ahead.is_some_and(|ahead| (ahead - 0.35 - 0.3..ahead + 0.2).contains(&radius)));
            if row["label"] == "obstacle" {
                assert!(rock || step, "{row:?} in frame {frame}: {possible:?}");
            }
            // Behind the edge of the step the ground is hidden, and may be higher still.
            if row["label"] == "obstacle" || row["reason"] == "may_hide" {
                at[0] += usize::from(rock);
                at[1] += usize::from(step);
            }
        }
    }
    assert!(at[0] >= 6 && at[1] >= 3, "{at:?} sectors end at the rock and at the step");
}

#[test]
fn vectors_join_the_ends_of_neighbouring_sectors() {
    let setup = CLEAN.json("recording/setup.json");
    let limit = |name: &str| setup["vectors"][name].as_f64().unwrap();
    let (large, small) = (limit("large"), limit("small"));
    let all = csv(&CLEAN.recorded("vectors.csv"), "\n");
    let mut last = Vec::new();
    for frame in map_frames() {
        let sectors = sectors(&CLEAN, frame);
        let vectors: Vec<&Row> = all.iter().filter(|row| number(row, "frame") == frame as f64).collect();
        assert_eq!(vectors.len(), SECTORS - 1);
        last.clear();
        for (vector, pair) in vectors.iter().zip(sectors.windows(2)) {
            let [from, to] = [0, 1].map(|index: usize| numbers(&pair[index], ["x_m", "y_m"]));
            assert_eq!(numbers(vector, ["from_x_m", "from_y_m"]), from);
            assert_eq!(numbers(vector, ["to_x_m", "to_y_m"]), to);
            // The paper's rules, in its order.
            let [a, b] = [0, 1].map(|index: usize| pair[index]["label"].as_str());
            let difference = (number(&pair[0], "radius_m") - number(&pair[1], "radius_m")).abs();
            let label = match () {
                () if a == b => a,
                () if [a, b].contains(&"obstacle") && difference <= large => "obstacle",
                () if [a, b].contains(&"visibility") && difference <= small => "visibility",
                () => "unknown",
            };
            assert_eq!(vector["label"], label, "{vector:?} {pair:?}");
            last.push((from, to, label.to_string()));
        }
    }

    // The files of the folder have the last map.
    let table = csv(&CLEAN.file("navigator-map.csv"), "\r\n");
    assert_eq!(table.len(), last.len());
    for (row, (from, to, label)) in table.iter().zip(&last) {
        assert_eq!(
            numbers(row, ["from_x_m", "from_y_m", "to_x_m", "to_y_m"]),
            [from[0], from[1], to[0], to[1]]
        );
        assert_eq!(row["label"], *label);
    }
    let map: Value = CLEAN.json("navigator-map.geojson");
    let frame = *map_frames().last().unwrap();
    assert_eq!(CLEAN.json("summary.json")["obstacle_map_frame"], frame);
    for (feature, (from, to, label)) in map["features"].as_array().unwrap().iter().zip(&last) {
        assert_eq!(feature["geometry"]["coordinates"], serde_json::json!([from, to]));
        assert_eq!(
            (&feature["properties"]["label"], &feature["properties"]["frame"]),
            (&label[..].into(), &frame.into())
        );
    }
    let counts = &CLEAN.json("summary.json")["sectors"];
    for label in ["obstacle", "unknown", "visibility"] {
        let count = sectors(&CLEAN, frame).iter().filter(|row| row["label"] == label).count();
        assert_eq!(counts[label].as_u64().unwrap_or(0), count as u64, "{label}: {counts}");
    }
}

/// Whether the middle of the front axle at a global place meets an obstacle, by the sectors of a frame. `None` if rounding
/// decides.
pub(crate) fn is_occupied(of: &Driven, frame: u64) -> impl Fn([f64; 2]) -> Option<bool> {
    let (sectors, (place, heading)) = (sectors(of, frame), believed(of, frame));
    let (sin, cos) = sin_cos(heading);
    move |[x, y]: [f64; 2]| {
        let [x, y] = [x - place[0], y - place[1]];
        let (ahead, left) = (x * cos + y * sin, y * cos - x * sin);
        let (radius, degrees) = (libm::hypot(ahead, left), libm::atan2(left, ahead).to_degrees());
        let sector = (degrees + 30.0) / 2.0;
        if sector.round() < 0.0 || sector.round() > 30.0 {
            return Some(false);
        }
        let row = &sectors[sector.round() as usize];
        let from_end = (radius - number(row, "radius_m")).abs();
        // Half way between two sectors, at three quarters of a step, or at the border of the vehicle in plan, which the
        // attitude moves by millimetres.
        let under = (ahead.abs() - 0.95, left.abs() - 0.625);
        let tie = ((sector - sector.floor()) - 0.5).abs() < 1e-6
            || (from_end - 0.075).abs() < 1e-9
            || (under.0 < 0.03 && under.1 < 0.03);
        let is_occupied = row["label"] == "obstacle" && from_end <= 0.075 && radius > 0.65;
        (!tie).then_some(is_occupied)
    }
}

#[test]
fn the_occupancy_grid_is_occupied_where_sectors_end_at_obstacles() {
    let text = std::fs::read_to_string(CLEAN.file("obstacle-map-nav2.yaml")).unwrap();
    assert!(text.starts_with("image: obstacle-map-nav2.pgm\n"), "{text}");
    let (origin, resolution) = (yaml(&text, "origin"), yaml(&text, "resolution")[0]);
    let (columns, rows, pixels) = pgm(&CLEAN.file("obstacle-map-nav2.pgm"));
    let expected = is_occupied(&CLEAN, *map_frames().last().unwrap());
    let mut left = 0;
    for (index, pixel) in pixels.iter().enumerate() {
        // The first row of the image is the northernmost.
        let (column, row) = (index % columns, rows - 1 - index / columns);
        let place = [(origin[0], column), (origin[1], row)]
            .map(|(from, cell)| from + resolution * (cell as f64 + 0.5));
        if let Some(is_occupied) = expected(place) {
            assert_eq!(*pixel == 0, is_occupied, "{place:?}: {pixel}");
        }
        left += usize::from(*pixel == 0 && ahead_and_left([place[0], place[1], 0.0])[1] > 0.3);
    }
    assert!(left > 5, "{left} cells before the rock on the left");
}
