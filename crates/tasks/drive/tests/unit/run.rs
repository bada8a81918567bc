use glam::DVec3;
use proptest::prelude::*;
use raypencil_rover::Label;
use raypencil_scene::{Precision, RenderOutput, Request, Scene};
use raypencil_scene_io::load_text;
use raypencil_tracer::Tracer;

use super::*;
use crate::common::{FLAT, LOW_SUN, SHORT, driven, filtered, job};

#[test]
fn stripes_on_flat_ground_are_where_trigonometry_predicts() {
    let job = job(FLAT, SHORT);
    // 4 pencils per pixel over 2 tan(30 deg) 8 mm / 72 um = 128.3 pixels.
    assert_eq!(job.plan.rig.beams.iter().map(|beam| beam.sensor.columns).collect::<Vec<_>>(), [514, 514]);
    assert!(job.warnings.is_empty() && job.notes.len() == 2, "{:?}", job.notes);
    let run = driven(&job, &["tracer"]);
    // 2 s at 3 frames per second, both ends included.
    assert_eq!((run.frames.len(), run.planned), (7, 7));
    assert!((run.driven() - 0.6).abs() < 1e-12);
    // Beam 0 is at x = 0.3 m, 1.8 m up, and points 31 degrees down: its middle meets the ground at 0.3 + 1.8 / tan 31 =
    // 3.296 m. A ray of the camera, 0.3 m below, at an angle a below the horizon meets the plane of the beam at d = 0.3
    // / (tan 31 - tan a). There, a row of pixels, 9 mrad, is 0.4 m of d: the middle of the right row is off by at most
    // 0.2 m.
    let first: Vec<_> = run.points.iter().filter(|point| point.frame == 0 && point.beam == 0).collect();
    assert!(first.len() > 100, "{} points", first.len());
    let middle = first.iter().min_by(|a, b| a.point.y.abs().total_cmp(&b.point.y.abs())).unwrap();
    assert!((middle.point.x - 3.296).abs() < 0.2, "{middle:?}");
    // All points are on the ground, up to 0.2 m times tan 31 for beam 0 and 0.3 m times tan 22 for beam 1.
    assert!(run.points.iter().all(|point| point.point.z.abs() < 0.2), "off the ground");
    // The estimated pose follows the vehicle.
    assert!((run.believed.position - DVec3::new(0.6, 0.0, 0.0)).length() < 0.02, "{:?}", run.believed);
    // The ground between the wheels and the first stripe was never seen.
    let (frame, obstacles, vectors) = run.obstacles.as_ref().unwrap();
    assert_eq!((*frame, vectors.len()), (6, obstacles.sectors.len() - 1));
    assert!(obstacles.sectors.iter().all(|sector| sector.label == Label::Unknown));
    // Obstacle maps of frames 0, 3 and 6, each with 31 sectors that end unknown; the plane has no obstacle.
    let truth = &run.truth;
    assert_eq!((truth.maps, truth.sectors, truth.with_obstacle, truth.off_ground), (3, 93, 0, 0));
    assert_eq!((truth.unknown_not_measured, truth.clear, truth.false_obstacle), (93, 0, 0));
    let json: serde_json::Value = serde_json::from_str(&crate::drive_json(&job, &run)).unwrap();
    // The vehicle still stands on cells that the proximity sensor measured at the start.
    assert!(json["largest_elevation_error_m"].as_f64().unwrap() < 1e-6);
    assert_eq!(json["truth"]["unknown"]["not_measured"].as_u64().unwrap(), 93);
}

#[test]
fn the_sun_hides_stripes_from_a_low_threshold_and_an_unlit_image_brings_them_back() {
    let dark = driven(&filtered(SHORT), &["tracer"]);
    let sunny = driven(&filtered(&format!("{SHORT}\n{LOW_SUN}")), &["tracer"]);
    let cleaned =
        driven(&filtered(&format!("{SHORT}\n{LOW_SUN}\nsubtract_unlit = true")), &["scanline", "tracer"]);
    let above = driven(&filtered(&format!("{SHORT}\n{LOW_SUN}\nthreshold_dn = 40000")), &["tracer"]);
    let dark_above = driven(&filtered(&format!("{SHORT}\nthreshold_dn = 40000")), &["tracer"]);
    // All of the ground is above 400 DN: the last lit row is that of the image, not that of a stripe.
    assert_ne!(sunny.points, dark.points);
    // Digital numbers are integers: rounding moves only pixels exactly at the threshold.
    assert!(cleaned.passes(), "{:?}", cleaned.differences);
    let same = |a: &DriveRun, b: &DriveRun| {
        let hits = a.points.iter().filter(|point| b.points.contains(point)).count();
        hits as f64 / a.points.len().max(b.points.len()) as f64
    };
    assert!(same(&dark, &cleaned) > 0.95, "{}", same(&dark, &cleaned));
    // Behind a narrow filter the ground has some 5000 DN, the sky some 20,000 DN (the ground reflects a quarter of it),
    // and a stripe more than both. Pixels that the sun lifts over the threshold move an edge by at most one row, 0.4 m.
    let middle = |run: &DriveRun| {
        let mut near: Vec<f64> =
            run.points.iter().filter(|one| one.beam == 0).map(|one| one.point.x).collect();
        near.sort_by(f64::total_cmp);
        near[near.len() / 2]
    };
    assert!(
        (middle(&dark_above) - middle(&above)).abs() < 0.4,
        "{} and {}",
        middle(&dark_above),
        middle(&above)
    );
    assert!(above.points.len() > 300, "{} points", above.points.len());
}

#[test]
fn cameras_with_the_largest_pixels_have_figures() {
    // 512 pixels of 0.1 m, the largest pitch: the views for figures have fewer pixels, but no larger ones.
    let text = format!(
        "version = 1\n[camera]\nwidth_px = 512\nheight_px = 512\npixel_pitch_um = 100000\n\
         [[beam]]\nrows = 4\ncolumns = 64\n{FLAT}\n[drive]\nwaypoints_m = [[0.1, 0]]\nscans = false\n"
    );
    let job = DriveJob::new(&load_text(&text, "wide").unwrap(), None, String::new()).unwrap();
    assert!(driven(&job, &["tracer"]).passes());
}

#[test]
fn optics_and_noise_leave_the_stripes_where_they_are() {
    let clear = driven(&job(FLAT, SHORT), &["tracer"]);
    let drive = format!("{SHORT}\nsensor = \"cmos\"\n");
    let noisy = driven(&job(FLAT, &drive), &["tracer"]);
    // A blur of a fraction of a pixel moves an edge by at most one row, 0.4 m. (It does move it: pixels of 72 um gather
    // 64 times the light of pixels of 9 um, and a low threshold passes the tail of the blur.)
    let mean = |run: &DriveRun| {
        let near: Vec<f64> = run.points.iter().filter(|one| one.beam == 0).map(|one| one.point.x).collect();
        near.iter().sum::<f64>() / near.len() as f64
    };
    assert!((mean(&clear) - mean(&noisy)).abs() < 0.4, "{} and {}", mean(&clear), mean(&noisy));
    // The same seed gives the same drive.
    let again = driven(&job(FLAT, &drive), &["tracer"]);
    assert_eq!(noisy.points, again.points);
}

/// Tracer with one false lit pixel in the third frame.
struct Faulty(Tracer);

impl Renderer for Faulty {
    fn name(&self) -> &str {
        "faulty"
    }

    fn precision(&self) -> Precision {
        Precision::F64
    }

    fn render(&self, scene: &Scene, request: &Request) -> RenderOutput {
        let mut output = self.0.render(scene, request);
        let camera_x = scene.camera().scene_from_sensor.position.x;
        // The third frame is 0.2 m from the start. The stripe is in row 77; light above it belongs to a point above the
        // ground.
        if let Some(image) = output.flux.first_mut().filter(|_| (camera_x - 0.5).abs() < 0.01) {
            image.set(40, 70, 1e-9);
        }
        output
    }
}

#[test]
fn a_false_pixel_is_traced_to_the_map() {
    let job = job(FLAT, SHORT);
    let (good, bad) = (Tracer::new(), Faulty(Tracer::new()));
    let run = drive(&job, &[&good, &bad], &Silent).unwrap();
    assert!(!run.passes());
    let differences = run.differences.as_ref().unwrap();
    assert_eq!((differences.flux.differ, differences.flux.largest_relative), (1, 1.0));
    assert_eq!(differences.pixels.differ, 1);
    let first = differences.pixels.first.as_deref().unwrap();
    assert!(first.starts_with("frame 2, beam 0, pixel 40,70: 0 DN against "), "{first}");
    assert_eq!(differences.edges.differ, 1);
    let first = differences.edges.first.as_deref().unwrap();
    assert!(first.starts_with("frame 2, beam 0, column 40: row 70.5 on the second side only"), "{first}");
    // The false point stays on the map in all later frames: nine cells, without those that get new data points.
    assert!(
        differences.cells.differ > 0
            && differences.cells.first.as_deref().unwrap().starts_with("frame 2, cell at ")
    );
    insta::with_settings!({ filters => [(r" +\d+(\.\d+)? (µs|ms|s)\b", " [time]")] }, {
        insta::assert_snapshot!("screen_with_differences", crate::drive_document(&job, &run).screen());
    });
    let json: serde_json::Value = serde_json::from_str(&crate::drive_json(&job, &run)).unwrap();
    assert_eq!((&json["passes"], &json["differences"]["pixels"]["differ"]), (&false.into(), &1.into()));
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 12, ..ProptestConfig::default() })]

    /// On random ground, both renderers lead to the same maps.
    #[test]
    fn both_renderers_drive_alike(seed in 0_u64..1 << 32, roughness in 0.02..0.2_f64, noisy in any::<bool>()) {
        let terrain = format!(
            "[terrain]\ngenerate = {{ preset = \"viking1\", seed = {seed}, extent_m = 16, post_spacing_m = 0.5, \
             roughness_m = {roughness}, rock_smallest_m = 0.3 }}"
        );
        let sensor = if noisy { "cmos" } else { "ideal" };
        let drive = format!("{SHORT}\nsensor = \"{sensor}\"\nscans = true\nscan_steps = 3");
        let drive = drive.replace("scans = false\n", "");
        let run = driven(&job(&terrain, &drive), &["scanline", "tracer"]);
        let differences = run.differences.as_ref().expect("two sides");
        prop_assert!(run.passes(), "{differences:#?}");
        prop_assert!(differences.edges.compared > 100 && differences.labels.compared > 0);
    }
}
