//! `poses.csv` and the files of TUM against the closed form of a vehicle that stands on a plane.

use std::collections::BTreeMap;

use super::driven::{CLEAN, Driven, NOISY};
use super::geometry::{Pose, apart, attitude, length, minus};
use super::ground::{FRAME_RATE, START, frames, route, stance, true_pose};
use super::readers::{csv, npy, number, numbers};

/// Rounding of a pose: the vehicle's stance is solved to 1e-12 m, and a turn of a quaternion has a few roundings.
const ROUNDING: f64 = 1e-10;

pub(crate) type Row = BTreeMap<String, String>;

pub(crate) fn rows(of: &Driven) -> Vec<Row> {
    csv(&of.recorded("poses.csv"), "\n")
}

/// The pose in the columns `KIND_x_m` ... `KIND_qw`.
pub(crate) fn pose(row: &Row, kind: &str) -> Pose {
    let names = ["x_m", "y_m", "z_m", "qx", "qy", "qz", "qw"];
    Pose::of(&names.map(|name| number(row, &format!("{kind}_{name}"))))
}

#[test]
fn the_vehicle_stands_on_the_plane_where_its_way_leads() {
    let rows = rows(&CLEAN);
    assert_eq!(rows.len() as u64, frames());
    for (frame, row) in (0..).zip(&rows) {
        let (driven, ..) = route(frame);
        let expected = [frame as f64, frame as f64 / FRAME_RATE, driven];
        let given = numbers(row, ["frame", "time_s", "driven_m"]);
        assert!(length(minus(given, expected)) < ROUNDING, "{given:?} {expected:?}");
        let apart = pose(row, "true").apart(&true_pose(frame));
        assert!(apart < ROUNDING, "frame {frame}: {apart}");
    }
    // On the way it drives, turns to either side on the spot, and drives again.
    let headings: Vec<f64> = (0..frames()).map(|frame| route(frame).2).collect();
    let turns = |by: f64| headings.windows(2).any(|pair| (pair[1] - pair[0] - by).abs() < 1e-9);
    assert!(turns(0.15) && turns(-0.15) && turns(0.0), "{headings:?}");
}

#[test]
fn sensors_without_errors_read_the_stance_and_the_vehicle_believes_them() {
    let rows = rows(&CLEAN);
    for (frame, row) in (0..).zip(&rows) {
        let (_, place, heading) = route(frame);
        let ([heading, pitch, roll], above) = stance(heading);
        let names = [
            "sensed_x_m",
            "sensed_y_m",
            "sensed_heading_rad",
            "sensed_pitch_down_rad",
            "sensed_roll_right_rad",
        ];
        for (given, expected) in
            numbers(row, names).into_iter().zip([place[0], place[1], heading, pitch, roll])
        {
            assert!((given - expected).abs() < ROUNDING, "frame {frame}: {given} for {expected}");
        }
        assert!((number(row, "proximity_m") - above).abs() < 1e-6, "frame {frame}: {row:?}");
        let (believed, truth) = (pose(row, "believed"), true_pose(frame));
        assert!(apart(&believed.rotation, &truth.rotation) < ROUNDING, "frame {frame}");
        let [x, y, z] = minus(believed.position, truth.position);
        // Its elevation is read from the map. Tuned: the points are off by 1 to 2 cm.
        assert!(x.abs() < ROUNDING && y.abs() < ROUNDING && z.abs() < 0.02, "frame {frame}: {x} {y} {z}");
        assert!((0.0..0.05).contains(&number(row, "elevation_error_m")), "frame {frame}: {row:?}");
        assert_eq!(row["scan"], if frame == 0 { "start" } else { "" });
    }
}

#[test]
fn sensors_with_errors_read_them_on_top_and_the_vehicle_believes_what_they_read() {
    let degree = std::f64::consts::PI / 180.0;
    for (frame, row) in (0..).zip(&rows(&NOISY)) {
        let (time, (_, [x, y], heading)) = (frame as f64 / FRAME_RATE, route(frame));
        let ([heading, pitch, roll], _) = stance(heading);
        assert!(pose(row, "true").apart(&true_pose(frame)) < ROUNDING, "frame {frame}");
        let sensed = numbers(
            row,
            [
                "sensed_x_m",
                "sensed_y_m",
                "sensed_heading_rad",
                "sensed_pitch_down_rad",
                "sensed_roll_right_rad",
            ],
        );
        let expected = [
            x + 0.02 * time,
            y - 0.01 * time,
            heading + (1.0 + 0.1 * time) * degree,
            pitch - 0.5 * degree,
            roll + 0.75 * degree,
        ];
        for (given, expected) in sensed.into_iter().zip(expected) {
            assert!((given - expected).abs() < ROUNDING, "frame {frame}: {given} for {expected}");
        }
        let believed = pose(row, "believed");
        let angles = attitude([sensed[2], sensed[3], sensed[4]]);
        assert!(apart(&believed.rotation, &angles) < ROUNDING, "frame {frame}");
        let [x, y, _] = believed.position;
        assert!((x - sensed[0]).abs() < ROUNDING && (y - sensed[1]).abs() < ROUNDING, "frame {frame}");
    }
}

#[test]
fn the_files_of_tum_have_the_same_poses() {
    for of in [&*CLEAN, &*NOISY] {
        for kind in ["true", "believed"] {
            let text = std::fs::read_to_string(of.recorded(&format!("poses-{kind}.tum"))).unwrap();
            let rows = rows(of);
            assert_eq!(text.lines().count(), rows.len());
            for (line, row) in text.lines().zip(&rows) {
                let words: Vec<f64> = line.split(' ').map(|word| word.parse().unwrap()).collect();
                assert_eq!(words[0], number(row, "time_s"));
                assert!(Pose::of(&words[1..]).apart(&pose(row, kind)) == 0.0, "{line}");
            }
        }
    }
}

#[test]
fn counts_and_steps_of_the_map_add_up() {
    let [edges, points] = ["stripes.npy", "points.npy"].map(|name| npy(&CLEAN.recorded(name)));
    let mut centre = [0.0; 2];
    for (frame, row) in rows(&CLEAN).iter().enumerate() {
        let of_frame = |table: &super::readers::Array| {
            (0..table.shape[0]).filter(|&line| table.row(line)[0] == frame as f64).count() as f64
        };
        assert_eq!(numbers(row, ["edges", "points"]), [of_frame(&edges), of_frame(&points)]);
        assert!(of_frame(&points) > 200.0, "frame {frame} saw something");
        let moved = numbers(row, ["moved_i", "moved_j"]);
        // The centre is the grid point nearest to the vehicle; the grid begins at the start.
        let [x, y, _] = pose(row, "believed").position;
        for (axis, at) in [x, y].into_iter().enumerate() {
            centre[axis] += moved[axis];
            let steps = (at - START[axis]) / 0.1;
            assert!((centre[axis] - steps).abs() <= 0.5 + 1e-9, "frame {frame}: {centre:?} for {x} {y}");
        }
    }
    assert!(centre[0] > 5.0 && centre[1] > 4.0, "the map moved in both axes");
}
