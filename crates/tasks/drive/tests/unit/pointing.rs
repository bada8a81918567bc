use raypencil_rover::{SheetPlane, Triangulation};
use raypencil_scene_io::{Overrides, load};

use super::*;

fn job(name: &str) -> DriveJob {
    let loaded = load(name, &Overrides::default()).unwrap();
    DriveJob::new(&loaded, None, name.into()).unwrap()
}

#[test]
fn the_sensitivity_on_level_ground_by_hand() {
    let rig = job("pyramids").plan.rig;
    // Beam 0: d = 1.8 / tan 31 = 2.9957 m, a = atan(1.5 / d) = 26.598 degrees. dd/da = d^2 / (0.3 cos^2 a) = 37.42
    // m/rad; p / f_c = 1.125e-3, cos^2(6.598) = 0.98680: 41.54 mm, times tan 31 24.96 mm.
    let near = StripeSensitivity::on_level_ground(&rig, 0);
    assert!((near.ahead - 3.2957).abs() < 1e-4);
    assert!(
        (near.range_per_pixel - 0.04154).abs() < 1e-5 && (near.elevation_per_pixel - 0.02496).abs() < 1e-5
    );
    // Beam 1: d = 2 / tan 22 = 4.9502 m, a = 16.858 degrees, 4.9502^2 / (0.5 * 0.91591) = 53.51 m/rad, cos^2(3.142) =
    // 0.99700: 60.02 mm, times tan 22 24.25 mm.
    let far = StripeSensitivity::on_level_ground(&rig, 1);
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
    let renderer = raypencil_tracer::Tracer::new();
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
    let sensitivity = StripeSensitivity::on_level_ground(&job.plan.rig, 0);
    let moved = shift(0, &level, &tilted, |_, point| point.x * pitch);
    assert!((moved.elevation / sensitivity.elevation_of_pitch(pitch) - 1.0).abs() < 0.01, "{moved:?}");
    assert!((moved.formula / moved.elevation - 1.0).abs() < 2e-3, "{moved:?}");
    assert!((moved.as_pitch() / pitch - 1.0).abs() < 2e-3, "{moved:?}");
}
