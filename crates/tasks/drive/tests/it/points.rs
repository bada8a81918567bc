//! Points against the rows of their stripes, the believed poses, and the ground.

use super::driven::{CLEAN, Driven, NOISY};
use super::geometry::{length, minus};
use super::ground::{START, THICKNESS, ahead_and_left, distance, height, true_pose};
use super::images::triangulated;
use super::poses::{pose, rows};
use super::readers::{csv, npy, numbers};

/// Frame, step, beam, column, row, x, y, z and global x, y, z of all points.
fn points(of: &Driven) -> Vec<[f64; 11]> {
    let table = npy(&of.recorded("points.npy"));
    assert_eq!((table.shape[1], table.kind.as_str()), (11, "<f8"));
    (0..table.shape[0]).map(|line| table.row(line).try_into().unwrap()).collect()
}

/// Step and beam.
fn key(point: &[f64; 11]) -> (i64, usize) {
    (point[1] as i64, point[2] as usize)
}

#[test]
fn a_point_is_where_its_ray_meets_the_sheet_and_where_the_vehicle_believes_it() {
    for of in [&*CLEAN, &*NOISY] {
        let (points, poses) = (points(of), rows(of));
        assert!(points.len() > 2000, "{}", points.len());
        for point in &points {
            let [frame, _, _, column, row, x, y, z, global @ ..] = *point;
            let (step, beam) = key(point);
            let expected = triangulated(step, beam, column + 0.5, row);
            assert!(length(minus([x, y, z], expected)) < 1e-9, "{point:?} for {expected:?}");
            // By the believed pose of this very frame.
            let believed = pose(&poses[frame as usize], "believed").point([x, y, z]);
            assert!(length(minus(global, believed)) < 1e-9, "{point:?} for {believed:?}");
        }
    }
}

#[test]
fn a_point_lies_on_the_ground() {
    let (mut off, mut sum) = (Vec::new(), 0.0);
    let (points, mut ahead, mut aside) = (points(&CLEAN), [0_usize; 2], [0_usize; 2]);
    for point in &points {
        let [frame, _, _, column, row, x, y, z, ..] = *point;
        let (step, beam) = key(point);
        let truly = true_pose(frame as u64).point([x, y, z]);
        // The light is somewhere within a row of the measured one, and within half the thickness of the sheet.
        let one_row_off = triangulated(step, beam, column + 0.5, row + 1.0);
        let tolerance = length(minus([x, y, z], one_row_off)) + 0.5 * THICKNESS;
        if distance(truly) > tolerance {
            off.push((*point, distance(truly), tolerance));
        }
        let height = truly[2] - height(truly[0], truly[1]);
        sum += height * height;
        let [u, v, _] = ahead_and_left(truly);
        ahead[usize::from(u > 4.0)] += 1;
        aside[usize::from(v > 0.0)] += 1;
    }
    assert!(ahead.iter().chain(&aside).all(|&count| count > 500), "{ahead:?} {aside:?}");
    // Tuned: at edges of the blocks a run of lit pixels may hold light of two surfaces.
    assert!(off.len() * 200 < points.len(), "{} of {}: {:?}", off.len(), points.len(), &off[..5]);
    // The summary counts heights over the ground below each point. Points beyond an edge of a block are above or below
    // it by rounding: two of them may count the other way.
    let summary = CLEAN.json("summary.json");
    let rms = (sum / points.len() as f64).sqrt();
    let given = summary["points_off_ground"]["rms_m"].as_f64().unwrap();
    assert!((given - rms).abs() < 1e-6, "{given} for {rms}");
    assert_eq!(summary["edge_points"], points.len());
}

#[test]
fn the_tables_and_the_cloud_have_the_same_points() {
    for of in [&*CLEAN, &*NOISY] {
        let (points, text) = (points(of), csv(&of.recorded("points.csv"), "\n"));
        assert_eq!(points.len(), text.len());
        let names = [
            "frame",
            "step",
            "beam",
            "column",
            "row_px",
            "x_m",
            "y_m",
            "z_m",
            "global_x_m",
            "global_y_m",
            "global_z_m",
        ];
        for (point, row) in points.iter().zip(&text) {
            assert_eq!(numbers(row, names), *point);
            // A tenth of a row, for centroids, by the larger of both ways. One lit row says no more than its pixel: 1 / sqrt(12).
            let is_one_row = (point[4].fract() - 0.5).abs() < 1e-9;
            let rows = if is_one_row { (1.0_f64 / 12.0).sqrt() } else { 0.1 };
            let (step, beam) = key(point);
            let off =
                |rows: f64| (triangulated(step, beam, point[3] + 0.5, point[4] + rows)[2] - point[7]).abs();
            let expected = off(rows).max(off(-rows));
            let [given] = numbers(row, ["standard_error_m"]);
            assert!((given - expected).abs() < 1e-9, "{given} for {expected}");
        }

        let bytes = std::fs::read(of.file("edge-points.ply")).unwrap();
        let end = b"end_header\n";
        let at = bytes.windows(end.len()).position(|part| part == end).unwrap() + end.len();
        let header = std::str::from_utf8(&bytes[..at]).unwrap();
        assert!(header.contains(&format!("element vertex {}\n", points.len())), "{header}");
        // Three doubles, the frame, the beam.
        let records = bytes[at..].chunks_exact(29);
        assert_eq!(records.len(), points.len());
        for (record, point) in records.zip(&points) {
            let real = |index: usize| f64::from_le_bytes(record[8 * index..][..8].try_into().unwrap());
            assert_eq!([real(0), real(1), real(2)], point[8..]);
            let frame = u32::from_le_bytes(record[24..28].try_into().unwrap());
            assert_eq!([f64::from(frame), f64::from(record[28])], [point[0], point[2]]);
        }
    }
    // Global coordinates are of the start's surroundings, not of the vehicle's.
    assert!(points(&CLEAN).iter().all(|point| libm::hypot(point[8] - START[0], point[9] - START[1]) < 20.0));
}
