//! How far a blur and a wrong pitch move the points of a stripe.

use raypencil::Tracer;
use raypencil::drive::DriveJob;
use raypencil::io::load_text;
use raypencil::rover::{Rig, SheetPlane, Triangulation};

use super::job;
use super::pointing::{first_frame, pointing_table, shift};
use super::sensitivity::StripeSensitivity;

/// Sensitivity where a beam of the default rig meets level ground: both are 0.3 m ahead, beam 0 is 1.8 m up and points 31
/// degrees down, beam 1 is 2 m up and points 22 degrees down.
fn on_level_ground(rig: &Rig, beam: usize) -> StripeSensitivity {
    let (height, down) = [(1.8, 31.0_f64), (2.0, 22.0)][beam];
    StripeSensitivity::at(rig, beam, 0.3 + height / libm::tan(down.to_radians()))
}

#[test]
fn the_sensitivity_on_level_ground_by_hand() {
    let rig = job("pyramids").plan.rig;
    // Beam 0: d = 1.8 / tan 31 = 2.9957 m, a = atan(1.5 / d) = 26.598 degrees. dd/da = d^2 / (0.3 cos^2 a) = 37.42
    // m/rad; p / f_c = 1.125e-3, cos^2(6.598) = 0.98680: 41.54 mm, times tan 31 24.96 mm.
    let near = on_level_ground(&rig, 0);
    assert!((near.ahead - 3.2957).abs() < 1e-4);
    // A pitch error of 0.1 degrees = 1.7453e-3 rad lowers the point by 3.2957 m times that.
    assert!((near.elevation_of_pitch(0.1_f64.to_radians()) - 5.752e-3).abs() < 1e-6);
    assert!(
        (near.range_per_pixel - 0.04154).abs() < 1e-5 && (near.elevation_per_pixel - 0.02496).abs() < 1e-5
    );
    // Beam 1: d = 2 / tan 22 = 4.9502 m, a = 16.858 degrees, 4.9502^2 / (0.5 * 0.91591) = 53.51 m/rad, cos^2(3.142) =
    // 0.99700: 60.02 mm, times tan 22 24.25 mm.
    let far = on_level_ground(&rig, 1);
    assert!((far.range_per_pixel - 0.06002).abs() < 1e-5 && (far.elevation_per_pixel - 0.02425).abs() < 1e-5);
}

#[test]
fn the_sensitivity_to_rows_is_the_derivative_of_the_triangulation() {
    let rig = job("pyramids").plan.rig;
    // About the rows of level ground, 615 and 463.
    for (beam, rows) in [(0, [560.0, 615.0, 640.0]), (1, [430.0, 463.0, 500.0])] {
        let triangulation = Triangulation::new(&rig, beam, SheetPlane::Middle);
        // Central difference over a hundredth of a pixel to either side: its error is of second order.
        for (u, v) in [200.0, 512.0, 800.0].into_iter().zip(rows) {
            let at = |v| triangulation.at(u, v).unwrap();
            let (point, moved) = (at(v), at(v + 0.01) - at(v - 0.01));
            let sensitivity = StripeSensitivity::at(&rig, beam, point.x);
            let near = |a: f64, b: f64| (a / b - 1.0).abs() < 1e-6;
            assert!(
                near(moved.x / 0.02, sensitivity.range_per_pixel),
                "beam {beam} {u} {v}: {moved} {sensitivity:?}"
            );
            assert!(
                near(-moved.z / 0.02, sensitivity.elevation_per_pixel),
                "beam {beam} {u} {v}: {moved} {sensitivity:?}"
            );
        }
    }
}

#[test]
fn a_pitch_error_shifts_points_in_proportion_to_their_distance() {
    let mut job = job("pyramids");
    let renderer = Tracer::new();
    let level = first_frame(&job, &renderer).unwrap();
    // Without a change there is no shift.
    let same = shift(0, &level, &level, |rows, _| rows);
    assert!(same.columns > 500);
    assert_eq!((same.rows, same.elevation, same.formula), (0.0, 0.0, 0.0));
    // 0.1 degrees, on level ground except for the pyramids: 3.2957 m * 1.7453e-3 = 5.752 mm, up to the square of the
    // angle, and to 1 % since points may be off by half a pixel.
    let pitch = 0.1_f64.to_radians();
    job.plan.errors.attitude_bias.pitch_down = pitch;
    let tilted = first_frame(&job, &renderer).unwrap();
    let sensitivity = on_level_ground(&job.plan.rig, 0);
    let moved = shift(0, &level, &tilted, |_, point| point.x * pitch);
    assert!((moved.elevation / sensitivity.elevation_of_pitch(pitch) - 1.0).abs() < 0.01, "{moved:?}");
    assert!((moved.formula / moved.elevation - 1.0).abs() < 2e-3, "{moved:?}");
    assert!((moved.as_pitch() / pitch - 1.0).abs() < 2e-3, "{moved:?}");
}

#[test]
fn the_table_has_a_row_for_each_error_and_its_formula_agrees() {
    // A small camera with beams to match, on the paper's pyramids.
    let scene = "version = 1
        vehicle = { position_m = [-0.6, 0] }
        camera = { width_px = 96, height_px = 96, pixel_pitch_um = 96 }
        beam = [{ rows = 2, columns = 128 }, { rows = 2, columns = 128 }]
        terrain = { builtin = 'pyramids' }
        drive = { waypoints_m = [[0.6, 0]], frames_per_s = 3, scans = false }";
    let job = DriveJob::new(&load_text(scene, "small").unwrap(), None, "small.toml".into()).unwrap();
    let table = pointing_table(&job, &Tracer::new()).unwrap();
    let rows: Vec<Vec<&str>> =
        table.lines().map(|line| line.trim_matches('|').split('|').map(str::trim).collect()).collect();
    assert!(rows.iter().all(|row| row.len() == 6), "{table}");
    // Two extractions with four rows each, and four pitches.
    assert_eq!(rows.len(), 2 + 2 * 4 + 4, "{table}");
    let pitches = &rows[10..];
    for (row, degrees) in pitches.iter().zip([0.01, 0.1, 0.5, 1.0]) {
        assert_eq!(row[1], format!("pitch, {degrees} deg"));
        // The edges stay where they are; a point falls by its distance times the angle, and that is the angle itself.
        assert_eq!(row[2], "0, 0");
        let pair =
            |cell: &str| -> Vec<f64> { cell.split(", ").map(|number| number.parse().unwrap()).collect() };
        let (measured, formula) = (pair(row[3]), pair(row[4]));
        let as_pitch = pair(row[5].strip_suffix(" deg").unwrap());
        for beam in [0, 1] {
            assert!((measured[beam] / formula[beam] - 1.0).abs() < 0.02, "{table}");
            assert!((as_pitch[beam] / degrees - 1.0).abs() < 0.02, "{table}");
        }
    }
}
