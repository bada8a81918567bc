//! The vehicle drives on between the image with the laser and the one without.

use glam::DVec3;
use raypencil_tracer::Tracer;

use super::*;
use crate::common::{FLAT, driven, filtered, job, mesh};

/// 1.2 m/s and a quarter of a second between exposures: 0.3 m. The sun is overhead.
const MOVING: &str = "waypoints_m = [[1.2, 0]]\nspeed_m_per_s = 1.2\nframes_per_s = 1\nscans = false\nsubtract_unlit = true\n\
    sun = { elevation_deg = 90, optical_depth = 0.1 }\nexposure_interval_ms = 250";

#[test]
fn the_unlit_image_is_taken_farther_on() {
    // A wall 0.5 m high stands at x = 3 m. The sun overhead lights the ground and not the wall.
    let p = DVec3::new;
    let ground = [p(-30.0, -30.0, 0.0), p(30.0, -30.0, 0.0), p(30.0, 30.0, 0.0), p(-30.0, 30.0, 0.0)];
    let wall = [p(3.0, -9.0, 0.0), p(3.0, 9.0, 0.0), p(3.0, 9.0, 0.5), p(3.0, -9.0, 0.5)];
    let walled = mesh(&[ground, wall].concat(), vec![[0, 1, 2], [0, 2, 3], [4, 6, 5], [4, 7, 6]]);
    let image = |keys: &str| {
        let mut job = filtered(keys);
        job.mesh = walled.clone();
        let sun = Sun::of(&job).unwrap();
        let renderer = Tracer::new();
        let mut drive = RendererDrive::new(&job, &renderer, sun.as_ref()).unwrap();
        let mut frame = drive.step(false, &mut |_, _| {}).unwrap().unwrap();
        frame.images.swap_remove(0).1
    };
    // The wall's upper edge is seen at 64 + 8 mm / 72 um tan(atan(1 / d) - 20 degrees) rows, at the distance d from the camera.
    let row = |d: f64| 64.0 + 8e-3 / 72e-6 * libm::tan(libm::atan2(1.0, d) - 20.0_f64.to_radians());
    let (far, near) = (row(2.7), row(2.4));
    assert!((far - 64.6).abs() < 0.1 && (near - 69.1).abs() < 0.1, "{far} {near}");
    let moved = image(MOVING);
    // Between both edges the lit image has sunny ground less the dark wall, of the unlit one: far from the stripe's columns alone.
    let column = 64;
    let expected = |j: u32| f64::from(j) > far && f64::from(j + 1) < near;
    let rows: Vec<u32> = (0..128).filter(|&j| expected(j)).collect();
    assert_eq!(rows, [65, 66, 67, 68]);
    for &j in &rows {
        // In the lit image the wall is there already below row 64.6; in the unlit one only below row 69.1.
        assert!(moved.at(column, j) < -100, "{} in row {j}", moved.at(column, j));
    }
    // Sky, ground behind the wall and ground near the vehicle are as before.
    for j in (0..60).chain(110..128) {
        assert_eq!(moved.at(column, j), 0, "row {j}");
    }
    let still = image(&MOVING.replace("exposure_interval_ms = 250", "exposure_interval_ms = 0"));
    assert!(rows.iter().all(|&j| still.at(column, j) == 0));
}

#[test]
fn both_sides_agree_on_a_moving_vehicle() {
    // 128 rows in 64 ms.
    for more in ["", "\nrow_time_us = 500\nrow_bands = 4"] {
        let keys = format!("{MOVING}\nmotion_blur_samples = 3\noptics = {{ speckle_contrast = 0.5 }}{more}");
        let run = driven(&filtered(&keys), &["scanline", "tracer"]);
        assert!(run.passes(), "{:?}", run.differences);
    }
}

#[test]
fn the_sunlight_of_a_rolling_shutter_is_that_of_each_row() {
    // A dark wall 2.2 m wide stands across sunny ground at x = 3 m, 2.7 m before the camera, and grows as the vehicle nears it. 128 rows,
    // 1.9 ms apart, at 1.2 m/s: row j sees it from 1.2 x 1.9 mm x j nearer. A mean over all rows would see it from 0.145 m
    // nearer in each row: 2.5 columns wider in row 34, and 1.3 narrower in row 80.
    let p = DVec3::new;
    let ground = [p(-30.0, -30.0, 0.0), p(30.0, -30.0, 0.0), p(30.0, 30.0, 0.0), p(-30.0, 30.0, 0.0)];
    let wall = [p(3.0, -1.1, 0.0), p(3.0, 1.1, 0.0), p(3.0, 1.1, 3.0), p(3.0, -1.1, 3.0)];
    let walled = mesh(&[ground, wall].concat(), vec![[0, 1, 2], [0, 2, 3], [4, 6, 5], [4, 7, 6]]);
    let widths = |more: &str| {
        let keys =
            MOVING.replace("subtract_unlit = true\n", "").replace("\nexposure_interval_ms = 250", more);
        let mut job = filtered(&keys);
        job.mesh = walled.clone();
        let sun = Sun::of(&job).unwrap();
        let renderer = Tracer::new();
        let mut drive = RendererDrive::new(&job, &renderer, sun.as_ref()).unwrap();
        let image = drive.step(false, &mut |_, _| {}).unwrap().unwrap().images.swap_remove(0).1;
        // The ground at both sides is bright.
        [34, 80].map(|j| (0..128).filter(|&i| 2 * image.at(i, j) < image.at(0, j)).count() as f64)
    };
    // The camera stands 1.5 m high and looks 20 degrees down. A row looks `below` the horizon, and its point of the wall has the depth
    // d cos(below - 20 degrees) / cos(below).
    let width = |d: f64, j: f64| {
        let in_image = libm::atan2((j + 0.5 - 64.0) * 72e-6, 8e-3);
        let below = in_image + 20.0_f64.to_radians();
        2.2 * 8e-3 / 72e-6 * libm::cos(below) / (d * libm::cos(in_image))
    };
    let at = |advance: [f64; 2]| [width(2.7 - advance[0], 34.0), width(2.7 - advance[1], 80.0)];
    let step = 1.2 * 1.9e-3;
    let rolling_at = at([34.0 * step, 80.0 * step]);
    let still_at = at([0.0; 2]);
    assert!((rolling_at[0] - 96.1).abs() < 0.1 && (rolling_at[1] - 86.3).abs() < 0.1, "{rolling_at:?}");
    // Two edges, each half a cell off at most.
    let is_near = |seen: [f64; 2], expected: [f64; 2]| (0..2).all(|k| (seen[k] - expected[k]).abs() <= 1.0);
    let still = widths("");
    assert!(is_near(still, still_at), "{still:?} {still_at:?}");
    let rolling = widths("\nrow_time_us = 1900\nrow_bands = 64");
    assert!(is_near(rolling, rolling_at), "{rolling:?} {rolling_at:?}");
}

#[test]
fn exposures_that_do_not_fit_in_a_frame_are_refused() {
    let refused = |keys: &str| {
        let loaded = crate::common::scene(FLAT, keys);
        DriveJob::new(&loaded, None, String::new()).unwrap_err().to_string()
    };
    let route = "waypoints_m = [[0.6, 0]]\nframes_per_s = 4";
    // Two beams with an unlit image each: four exposures in a quarter of a second.
    let error = refused(&format!("{route}\nsubtract_unlit = true\nexposure_interval_ms = 70"));
    assert!(error.contains("drive.exposure_interval_ms is 70 ms between 4 exposures"), "{error}");
    let kept = job(FLAT, &format!("{route}\nexposure_interval_ms = 70\nmotion_blur_samples = 2"));
    let times = kept.plan.times;
    assert_eq!((times.has_unlit, times.duration, times.samples), (false, 2e-3, 2));
    // An exposure of the ideal sensor takes 2 ms.
    let error = refused(&format!("{route}\nexposure_interval_ms = 1"));
    assert!(
        error.contains("drive.exposure_interval_ms is 1 ms") && error.contains("an exposure, 2 ms"),
        "{error}"
    );
}
