//! Elevation maps, each cell against the ground at its own global place.

use std::path::Path;

use raypencil_mesh_io::read_dem;

use super::driven::CLEAN;
use super::ground::{OBSTACLES_EVERY, START, ahead_and_left, frames, heights_within};
use super::poses::{pose, rows};
use super::readers::{csv, npy, numbers, yaml};

/// Points along a side, and the distance between them.
const SIDE: usize = 201;
const SPACING: f64 = 0.1;

/// Frames with an obstacle map.
pub(crate) fn map_frames() -> Vec<u64> {
    (0..frames()).step_by(OBSTACLES_EVERY as usize).collect()
}

/// Holds the cells of a map, whose first one is at this global x and y, to the ground. Returns the numbers of cells by their
/// sources: unknown, proximity, extrapolated, measured.
fn assert_is_the_ground(elevation: &Path, source: &Path, first: [f64; 2]) -> [usize; 4] {
    let (elevations, sources) = (npy(elevation), npy(source));
    for (array, kind) in [(&elevations, "<f8"), (&sources, "|u1")] {
        assert_eq!((&array.shape[..], array.kind.as_str()), (&[SIDE, SIDE][..], kind));
    }
    let mut counts = [0; 4];
    let (mut off, mut sides) = (Vec::new(), [0; 4]);
    for row in 0..SIDE {
        for column in 0..SIDE {
            // Columns go east, rows north.
            let place = [first[0] + SPACING * column as f64, first[1] + SPACING * row as f64];
            let (elevation, source) = (elevations.row(row)[column], sources.row(row)[column] as usize);
            counts[source] += 1;
            assert_eq!(elevation.is_nan(), source == 0, "{row} {column}");
            // A point is in the cell of the nearest grid point, half a diagonal away at most, and was itself off by the
            // error of its row: along the ground by up to 7 cm, in height by 3 cm (`a_point_lies_on_the_ground` has
            // the bounds of each). An extrapolated cell has the height of a neighbour, a diagonal away, or that of the
            // plane through several up to two cells away, which can double their errors (tuned).
            let (aside, tolerance) = match source {
                0 => continue,
                1 | 3 => (0.071 + 0.07, 0.03),
                _ => (0.071 + 0.07 + 0.2, 0.06),
            };
            let [low, high] = heights_within(place, aside);
            if elevation < low - tolerance || elevation > high + tolerance {
                off.push((row, column, source, elevation, low, high));
            }
            let [u, v, _] = ahead_and_left([place[0], place[1], 0.0]);
            sides[usize::from(u > 4.0) + 2 * usize::from(v > 0.0)] += 1;
        }
    }
    assert!(sides.iter().all(|&count| count > 50), "known cells in all quarters: {sides:?}");
    assert!(off.is_empty(), "{} cells: {:?}", off.len(), &off[..off.len().min(5)]);
    counts
}

#[test]
fn every_snapshot_is_the_ground_where_its_table_says() {
    let (table, poses) = (csv(&CLEAN.recorded("maps.csv"), "\n"), rows(&CLEAN));
    let mut taken = Vec::new();
    for row in &table {
        let [frame, west, south, spacing, points] =
            numbers(row, ["frame", "west_m", "south_m", "spacing_m", "points"]);
        assert_eq!([spacing, points], [SPACING, SIDE as f64]);
        taken.push(frame as u64);
        // The central grid point is the one nearest to the vehicle in this frame, in whole steps from the start.
        let [x, y, _] = pose(&poses[frame as usize], "believed").position;
        for (first, at, start) in [(west, x, START[0]), (south, y, START[1])] {
            let centre = first + SPACING * 100.0;
            assert!((centre - at).abs() <= 0.5 * SPACING + 1e-9, "frame {frame}: {centre} for {at}");
            let steps = (centre - start) / SPACING;
            assert!((steps - steps.round()).abs() < 1e-9, "frame {frame}: {steps}");
        }
        let named = |what: &str| CLEAN.recorded(&format!("maps/{frame:06}-{what}.npy"));
        assert_is_the_ground(&named("elevation"), &named("source"), [west, south]);
    }
    assert_eq!(taken, map_frames());
}

#[test]
fn the_map_at_the_end_is_the_ground_in_all_its_files() {
    let text = std::fs::read_to_string(CLEAN.file("obstacle-map-nav2.yaml")).unwrap();
    // The outer corner of the first cell.
    let corner = yaml(&text, "origin");
    let first = [corner[0] + 0.5 * SPACING, corner[1] + 0.5 * SPACING];
    let [x, y, _] = pose(rows(&CLEAN).last().unwrap(), "believed").position;
    assert!((first[0] + 10.0 - x).abs() < 0.051 && (first[1] + 10.0 - y).abs() < 0.051, "{first:?}");
    let named = ["local-map.npy", "local-map-source.npy"].map(|name| CLEAN.file(name));
    let [unknown, _, _, measured] = assert_is_the_ground(&named[0], &named[1], first);
    let summary = &CLEAN.json("summary.json")["map"];
    let counts = ["unknown", "measured", "known"].map(|name| summary[name].as_u64().unwrap() as usize);
    assert_eq!(counts, [unknown, measured, SIDE * SIDE - unknown], "{summary}");

    // The reader of GeoTIFF is the house's own: it turns the rows, which begin in the north, about.
    let dem = read_dem(CLEAN.file("local-map.tif"), None).unwrap().posts;
    assert_eq!((dem.columns, dem.rows), (201, 201));
    assert!((dem.corner.x - first[0]).abs() < 1e-9 && (dem.corner.y - first[1]).abs() < 1e-9);
    let elevations = npy(&named[0]).values;
    assert!(dem.heights.iter().zip(&elevations).all(|(a, b)| a.to_bits() == b.to_bits()));
}
