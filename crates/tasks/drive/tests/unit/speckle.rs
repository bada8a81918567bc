//! What speckle does to the rows of stripes, by the formulas of docs/theory/sensor.md.

use std::collections::BTreeMap;

use glam::{DQuat, DVec3};
use raypencil_rover::{CameraImage, Detection, Drive, Extraction, StripeLocation};
use raypencil_scene_io::load_text;
use raypencil_sensor::Speckle;
use raypencil_tracer::Tracer;

use super::*;
use crate::common::{FLAT, SHORT, driven, job, scene_text};

/// |z| of a law that is obeyed exceeds this once in 5,000 drives; all seeds are fixed.
const LEVEL: f64 = 3.72;

/// Mean covariance of the lattice points of two pixels, `apart` pixels from each other along one axis, for a grain in
/// pixels.
fn covariance(apart: f64, grain: f64) -> f64 {
    let points = (1.0 / grain).ceil() as i32;
    let share = |k: i32| f64::from(k) / f64::from(points);
    let pairs = (0..points).flat_map(|a| (0..points).map(move |b| share(a - b)));
    let sum: f64 = pairs.map(|between| gaussian((apart + between) / grain)).sum();
    sum / f64::from(points * points)
}

fn gaussian(x: f64) -> f64 {
    libm::exp(-0.5 * x * x)
}

/// Variance of the middle of a column's light, square rows, to the first order in the contrast.
fn variance(light: &[f64], contrast: f64, grain: f64) -> f64 {
    let total: f64 = light.iter().sum();
    let middle = light.iter().enumerate().map(|(j, watts)| j as f64 * watts).sum::<f64>() / total;
    let lit: Vec<(f64, f64)> = light
        .iter()
        .enumerate()
        .filter(|(_, watts)| **watts > 0.0)
        .map(|(j, watts)| (j as f64, watts * (j as f64 - middle) / total))
        .collect();
    let pairs = lit.iter().flat_map(|a| lit.iter().map(move |b| (a, b)));
    let near = pairs.filter(|(a, b)| (a.0 - b.0).abs() < 2.0 + 6.0 * grain);
    let sum: f64 = near.map(|(a, b)| a.1 * b.1 * covariance(a.0 - b.0, grain)).sum();
    contrast * contrast * covariance(0.0, grain) * sum
}

#[test]
fn the_middle_of_a_stripe_errs_by_dorschs_limit_times_the_root_of_its_width() {
    // Columns of 9 um, whose light is a Gaussian of s rows. The docs: variance q (C s^2)^2 / (g^2 (1 + 2 s^2 / g^2)^(3/2)), and
    // for s above g about C lambda N / pi times pi^(1/4) sqrt(s / p), which is 1.33 sqrt(s / p) of C lambda / (2 pi sin u').
    const COLUMNS: u32 = 4096;
    let loaded = load_text(&scene_text("", 1, FLAT, SHORT), "small").unwrap();
    let small = loaded.scene.camera().sensor;
    for (aperture, s, contrast) in
        [(2e-3, 1.0, 0.25), (1e-3, 1.0, 0.25), (2e-3, 2.0, 0.25), (2e-3, 2.0, 0.125)]
    {
        let camera =
            raypencil_scene::Camera { width: COLUMNS, height: 40, pixel_pitch: [9e-6; 2], aperture, ..small };
        let speckle = Speckle::behind(&camera, 810e-9, contrast);
        let grain = speckle.grain / 9e-6;
        let at = |j: u32| gaussian((f64::from(j) + 0.5 - 20.0) / s);
        let cells = (0..40).flat_map(|j| (0..COLUMNS).map(move |_| at(j))).collect();
        let optics = Optics { speckle: Some(speckle), ..Optics::PERFECT };
        let image = optics.filter(&camera, Image::from_cells(COLUMNS, 40, cells), Default::default()).optical;
        let extraction = Extraction { place: StripeLocation::Centroid, ..Extraction::thresholding(1e-12) };
        let edges = extraction.edges(&image);
        assert_eq!(edges.len(), COLUMNS as usize);
        let found =
            edges.iter().map(|edge| (edge.row - 20.0) * (edge.row - 20.0)).sum::<f64>() / f64::from(COLUMNS);

        let q = speckle.contrast_in([9e-6; 2]) / contrast;
        let by_docs = q * (contrast * s * s / grain) * (contrast * s * s / grain)
            / libm::pow(1.0 + 2.0 * (s / grain) * (s / grain), 1.5);
        let column: Vec<f64> = (0..40).map(at).collect();
        let exact = variance(&column, contrast, grain);
        // The docs' stripe is a Gaussian everywhere, that of the image one on pixels, whose own variance of 1/12 changes the
        // factor s^2 / (1 + 2 s^2 / g^2)^(3/2) by less than 1/12 / s^2, and whose lattice has the kink of 1/(6 n^2).
        assert!((by_docs / exact - 1.0).abs() < 1.0 / (12.0 * s * s) + 0.02, "{by_docs} {exact}");
        // A mean of squares over columns. Neighbours share less than a fifth. The next order in the contrast is
        // some C^2 over the number of speckles in a column, which is at least 1 / 0.35 / 0.16.
        let error = exact * (2.0 * 1.2 / f64::from(COLUMNS)).sqrt();
        let next = 5.0 * contrast * contrast * 0.35 * 0.16 * exact;
        assert!((found - exact).abs() < LEVEL * error + next, "{found} {exact} {error}");
        // sin u' = D / (2 f_c).
        let limit = contrast * 810e-9 / (2.0 * std::f64::consts::PI * (aperture / (2.0 * 8e-3))) / 9e-6;
        let factor = exact.sqrt() / limit;
        // Before the limit of a small grain g: q is less by the share sqrt(2 / pi) g, and the stripe is not much wider than g.
        let narrow = (1.0 - std::f64::consts::FRAC_2_SQRT_PI * std::f64::consts::FRAC_1_SQRT_2 * grain)
            .sqrt()
            * libm::pow(1.0 + 0.5 * (grain / s) * (grain / s), -0.75);
        let by_limit = 1.331 * s.sqrt() * narrow;
        assert!((factor / by_limit - 1.0).abs() < 0.5 * (1.0 / (12.0 * s * s) + 0.02), "{factor} {by_limit}");
    }
}

#[test]
fn the_rows_of_a_drive_err_by_the_contrast_and_the_grain() {
    // f/32: a grain of 11.7 um on pixels of 72 um, and a sheet of 100 mm, which is a few rows wide.
    let rows = |optics: &str| {
        let text = scene_text("aperture_mm = 0.25", 1, FLAT, &format!("{SHORT}\n{optics}"));
        let text = text.replace("rows = 4", "rows = 64\nthickness_mm = 100");
        let job = DriveJob::new(&load_text(&text, "small").unwrap(), None, String::new()).unwrap();
        let mut plan = job.plan.clone();
        plan.extraction.detection = Detection::Fixed(1e-30);
        let renderer = Tracer::new();
        let mut drive = Drive::new(plan, job.mesh.clone()).unwrap();
        let through_optics = ThroughOptics::new(&renderer, &job);
        let mut images = Vec::new();
        let mut edges = BTreeMap::new();
        while let Some(frame) = drive
            .step(&through_optics, &mut |_, flux| {
                images.push(flux.clone());
                CameraImage::Flux(flux)
            })
            .unwrap()
        {
            edges.extend(frame.edges.iter().map(|one| ((frame.index, one.edge.i), one.edge.row)));
        }
        (images, edges)
    };
    let (light, plain) = rows("");
    let (_, again) = rows("optics = { speckle_contrast = 0 }");
    assert_eq!(again, plain);
    let (speckled, found) = rows("optics = { speckle_contrast = 0.4 }");
    assert_eq!(found.len(), plain.len());
    assert!(plain.len() > 500, "{}", plain.len());
    let mut squares = 0.0;
    for (&(frame, i), row) in &found {
        let image = &light[frame as usize];
        let column: Vec<f64> = (0..image.height()).map(|j| image.at(i, j)).collect();
        let shift = row - plain[&(frame, i)];
        squares += shift * shift / variance(&column, 0.4, 0.162_056_937);
    }
    // A mean of squares of normal numbers; the next order as above.
    let count = found.len() as f64;
    let bound = LEVEL * (2.4 / count).sqrt() + 5.0 * 0.16 * 0.35 * 0.16;
    assert!((squares / count - 1.0).abs() < bound, "{} of {count}, {bound}", squares / count);
    // Each frame has a pattern of its own: the factors of the brightest row are not correlated.
    let factors = |frame: usize| -> Vec<f64> {
        let image = &light[frame];
        let brightest = |i: u32| {
            (0..image.height()).max_by(|&a, &b| image.at(i, a).total_cmp(&image.at(i, b))).expect("rows")
        };
        let of = |i: u32| speckled[frame].at(i, brightest(i)) / image.at(i, brightest(i)) - 1.0;
        (0..image.width()).filter(|&i| image.at(i, brightest(i)) > 0.0).map(of).collect()
    };
    let (a, b) = (factors(0), factors(1));
    let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let correlation = product(&a, &b) / (product(&a, &a) * product(&b, &b)).sqrt();
    assert!(correlation.abs() < LEVEL / (a.len().min(b.len()) as f64).sqrt(), "{correlation}");
}

#[test]
fn both_sides_see_the_same_speckle() {
    let job = job(FLAT, &format!("{SHORT}\nsensor = \"cmos\"\noptics = {{ speckle_contrast = 1 }}"));
    let run = driven(&job, &["scanline", "tracer"]);
    assert!(run.passes());
    let other = driven(&job, &["scanline"]);
    assert_eq!(run.points.len(), other.points.len());
    assert!(run.points.iter().zip(&other.points).all(|(a, b)| a.point == b.point));
    // Another seed of the sensor is another pattern, here of a camera without any other noise.
    let quiet = "electronics = { shot_noise = false, read_noise_e = 0, prnu = 0, dsnu_e = 0 }";
    let seeded = |seed: u32| {
        let keys = format!(
            "{SHORT}\nsensor = \"cmos\"\nsensor_seed = {seed}\noptics = {{ speckle_contrast = 1 }}\n{quiet}"
        );
        driven(&crate::common::job(FLAT, &keys), &["tracer"]).points
    };
    let (first, second) = (seeded(0), seeded(1));
    assert!(first.iter().zip(&second).any(|(a, b)| a.point != b.point));
}

#[test]
fn a_pattern_belongs_to_a_place_of_camera_and_beam() {
    let at = |x: f64| Pose::from_position(DVec3::new(x, -2.0, 1.5));
    let turned = |angle: f64| Pose { rotation: DQuat::from_rotation_y(angle), ..at(1.0) };
    let beam = at(7.0);
    let here = pattern_number([at(1.0), beam]);
    // A fifth of a millimetre, and a twentieth of a milliradian.
    assert_eq!(here, pattern_number([at(1.0002), beam]));
    assert_eq!(here, pattern_number([turned(5e-5), beam]));
    let others =
        [[at(1.002), beam], [at(1.0), at(7.002)], [beam, at(1.0)], [turned(2e-3), beam], [at(-1.0), beam]];
    let mut numbers: Vec<u64> = others.map(pattern_number).to_vec();
    numbers.push(here);
    numbers.sort_unstable();
    numbers.dedup();
    assert_eq!(numbers.len(), 6);
}
