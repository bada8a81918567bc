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
    // A plane behind a wall, as above, seen at 1.2 m/s. 128 rows, 1.9 ms apart: row j is seen 1.2 x 1.9 mm x j farther on, the last
    // one 0.29 m. With all rows at once the wall's upper edge is seen in row 64.6; from 0.147 m farther on, where the vehicle is
    // for row 64.6, in row 66.6.
    let p = DVec3::new;
    let ground = [p(-30.0, -30.0, 0.0), p(30.0, -30.0, 0.0), p(30.0, 30.0, 0.0), p(-30.0, 30.0, 0.0)];
    let wall = [p(3.0, -9.0, 0.0), p(3.0, 9.0, 0.0), p(3.0, 9.0, 0.5), p(3.0, -9.0, 0.5)];
    let walled = mesh(&[ground, wall].concat(), vec![[0, 1, 2], [0, 2, 3], [4, 6, 5], [4, 7, 6]]);
    let first_dark = |more: &str| {
        let keys =
            MOVING.replace("subtract_unlit = true\n", "").replace("\nexposure_interval_ms = 250", more);
        let mut job = filtered(&keys);
        job.mesh = walled.clone();
        let sun = Sun::of(&job).unwrap();
        let renderer = Tracer::new();
        let mut drive = RendererDrive::new(&job, &renderer, sun.as_ref()).unwrap();
        let image = drive.step(false, &mut |_, _| {}).unwrap().unwrap().images.swap_remove(0).1;
        // Ground before the wall's top is bright, the wall below it dark; above the ground is the sky.
        let first = (60..128).find(|&j| image.at(64, j) < image.at(64, j - 1) / 2).unwrap();
        // Two rows beside the edge all is bright or dark. This does not tell bands from a mean over all places, which passes it too.
        let [bright, dark, before, next] = [61, 72, first - 2, first + 1].map(|j| image.at(64, j));
        let tenth = (bright - dark) / 10;
        assert!(bright - before < tenth && next - dark < tenth, "{bright} {before} {next} {dark}");
        first
    };
    // Row 64 holds the edge and row 65 is all wall.
    let still = first_dark("");
    let rolling = first_dark("\nrow_time_us = 1900\nrow_bands = 64");
    let row = |x: f64| 64.0 + 8e-3 / 72e-6 * libm::tan(libm::atan2(1.0, 2.7 - x) - 20.0_f64.to_radians());
    // The edge is in the row j where the vehicle is at 1.2 x 1.9 mm x j.
    let expected = (0..128).find(|&j| f64::from(j) > row(1.2 * 1.9e-3 * f64::from(j))).unwrap();
    assert!(still.abs_diff(row(0.0).ceil() as u32) <= 1, "{still}");
    assert!(rolling.abs_diff(expected) <= 1 && rolling >= still + 2, "{rolling} {expected} {still}");
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
    assert!(error.contains("drive.times.interval is 0.07 s between 4 exposures"), "{error}");
    let kept = job(FLAT, &format!("{route}\nexposure_interval_ms = 70\nmotion_blur_samples = 2"));
    let times = kept.plan.times;
    assert_eq!((times.has_unlit, times.duration, times.samples), (false, 2e-3, 2));
    // An exposure of the ideal sensor takes 2 ms.
    let error = refused(&format!("{route}\nexposure_interval_ms = 1"));
    assert!(error.contains("drive.times.interval") && error.contains("0.002 s"), "{error}");
}
