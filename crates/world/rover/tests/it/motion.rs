//! The vehicle drives on while the camera exposes: where each image is taken, and what that does to stripes.

use std::sync::{Arc, Mutex};

use glam::DVec2;
use raypencil_rover::{
    CameraImage, Drive, DriveFrame, DrivePlan, ExposureMode, ExposureTimes, Extraction, LocalisationErrors,
    Route, ScanRule, StripeLocation, Sweep,
};
use raypencil_scanline::Scanline;
use raypencil_scene::{Image, Mesh, Precision, RenderOutput, Renderer, Request, Scene};

use super::common::{extruded, rig};

const SPEED: f64 = 0.3;
const LEVEL: [(f64, f64); 2] = [(-20.0, 0.0), (20.0, 0.0)];

/// Level up to here, and beyond a ramp of this slope.
const RAMP_FROM: f64 = 2.7;
const SLOPE: f64 = 0.5;
const RAMP: [(f64, f64); 3] = [(-20.0, 0.0), (RAMP_FROM, 0.0), (12.7, 5.0)];

/// A drive along x, one frame a second, with these times of exposures.
fn plan(times: ExposureTimes) -> DrivePlan {
    let route = Route { frame_rate: 1.0, ..Route::through(DVec2::ZERO, vec![DVec2::new(0.6, 0.0)]) };
    let extraction = Extraction { place: StripeLocation::Centroid, ..Extraction::thresholding(1e-30) };
    DrivePlan { scans: None, times, ..DrivePlan::new(rig(256, 16), route, extraction) }
}

/// Frames and images of a drive.
fn driven(plan: DrivePlan, mesh: &Arc<Mesh>) -> (Vec<DriveFrame>, Vec<Image<f64>>) {
    let mut drive = Drive::new(plan, Arc::clone(mesh)).unwrap();
    let (mut frames, mut images) = (Vec::new(), Vec::new());
    let mut pipeline = |_, flux: Image<f64>| {
        images.push(flux.clone());
        CameraImage::Flux(flux)
    };
    while let Some(frame) = drive.step(&Scanline::exact(), &mut pipeline).unwrap() {
        frames.push(frame);
    }
    (frames, images)
}

/// A renderer that keeps what it is asked for: the camera's x, and whether anything was requested.
#[derive(Default)]
struct Witness(Mutex<Vec<(f64, bool)>>);

impl Renderer for Witness {
    fn name(&self) -> &str {
        "witness"
    }

    fn precision(&self) -> Precision {
        Precision::F64
    }

    fn render(&self, scene: &Scene, request: &Request) -> RenderOutput {
        let x = scene.camera().scene_from_sensor.position.x + scene.mesh().origin().x;
        self.0.lock().unwrap().push((x, *request != Request::NOTHING));
        let flux = scene.beams().iter().map(|_| Image::filled(1024, 1024, 0.0));
        let flux = if request.returns { flux.collect() } else { Vec::new() };
        RenderOutput { camera: None, beams: Vec::new(), returns: Vec::new(), flux, stages: Vec::new() }
    }
}

#[test]
fn every_image_is_taken_where_the_vehicle_is_then() {
    let mesh = extruded(&LEVEL);
    let places = |plan: DrivePlan| {
        let witness = Witness::default();
        let mut drive = Drive::new(plan, Arc::clone(&mesh)).unwrap();
        while drive.step(&witness, &mut |_, flux| CameraImage::Flux(flux)).unwrap().is_some() {}
        witness.0.into_inner().unwrap()
    };
    let times = ExposureTimes {
        interval: 0.2,
        has_unlit: true,
        duration: 0.1,
        samples: 2,
        ..ExposureTimes::default()
    };
    let found = places(plan(times));
    // The camera is 0.3 m before the vehicle's middle. Exposures at 0, 0.2, 0.4 and 0.6 s, each of two images 25 ms before and
    // after its middle; at the start the vehicle stands, and after 2 s it is at the end of its way.
    let mut expected = Vec::new();
    for frame in 0..3 {
        for (offset, is_lit) in [(0.0, true), (0.2, false), (0.4, true), (0.6, false)] {
            for shift in [-0.025, 0.025] {
                let time = f64::from(frame) + offset + shift;
                expected.push((0.3 + SPEED * time.clamp(0.0, 2.0), is_lit));
            }
        }
    }
    assert_eq!(found.len(), expected.len());
    for (index, (a, b)) in found.iter().zip(&expected).enumerate() {
        assert!((a.0 - b.0).abs() < 1e-12 && a.1 == b.1, "image {index}: {a:?} is not {b:?}");
    }
    // Both beams in one exposure: lit at 0, unlit after 0.2 s.
    let together = DrivePlan { exposures: ExposureMode::Together, ..plan(times) };
    let found = places(together);
    let lit: Vec<bool> = found.iter().map(|(_, is_lit)| *is_lit).collect();
    assert_eq!(lit, [true, true, false, false].repeat(3));
    // By default a frame is one scene.
    let found = places(plan(ExposureTimes::default()));
    let expected = [0.3, 0.6, 0.9].map(|x| (x, true));
    assert!(found.iter().zip(&expected).all(|(a, b)| (a.0 - b.0).abs() < 1e-12 && a.1 == b.1));
    assert_eq!(found.len(), 3);
}

#[test]
fn on_a_plane_nothing_is_smeared() {
    // The sheets move along with the camera, and a plane along which they move stays under them.
    let mesh = extruded(&LEVEL);
    let (_, still) = driven(plan(ExposureTimes::default()), &mesh);
    let times = ExposureTimes { duration: 0.8, samples: 4, ..ExposureTimes::default() };
    let (_, moved) = driven(plan(times), &mesh);
    assert_eq!(moved.len(), still.len());
    for (a, b) in moved.iter().zip(&still) {
        let differ: f64 = a.cells().iter().zip(b.cells()).map(|(a, b)| (a - b).abs()).sum();
        let all: f64 = b.cells().iter().sum();
        assert!(all > 0.0 && differ < 1e-9 * all, "{differ} of {all}");
    }
}

/// Row of the image at which beam 0 meets the ramp straight ahead, with the vehicle's middle at x. The beam is 1.8 m up and points
/// 31 degrees down; it meets the ramp at the distance d with 1.8 - d tan 31 = SLOPE (0.3 + x + d - RAMP_FROM). The camera is
/// 1.5 m up, points 20 degrees down and has 8 mm / 9 um pixels of focal length.
fn row(x: f64) -> f64 {
    let down = libm::tan(31.0_f64.to_radians());
    let d = (1.8 - SLOPE * (0.3 + x - RAMP_FROM)) / (down + SLOPE);
    let z = 1.8 - d * down;
    512.0 + 8e-3 / 9e-6 * libm::tan(libm::atan2(1.5 - z, d) - 20.0_f64.to_radians())
}

#[test]
fn on_a_ramp_the_smear_of_a_stripe_is_its_way_over_the_image() {
    let mesh = extruded(&RAMP);
    let lit_rows = |image: &Image<f64>| -> Vec<f64> {
        let is_lit = |j: u32| (480..544).any(|i| image.at(i, j) > 0.0);
        (0..1024).filter(|&j| is_lit(j)).map(|j| f64::from(j) + 0.5).collect()
    };
    // 0.9 m/s, and sheets of 1 mm.
    let fast = |samples| {
        let times = ExposureTimes { duration: 0.8, samples, ..ExposureTimes::default() };
        let mut plan = plan(times);
        plan.route.speed = 0.9;
        plan.route.waypoints = vec![DVec2::new(1.8, 0.0)];
        plan.rig.beams.iter_mut().for_each(|beam| beam.sensor.thickness = 1e-3);
        plan
    };
    // Frame 1: the middle of its exposure is at x = 0.9 m.
    let at = |share: f64| row(0.9 * (1.0 + 0.8 * share));
    let smear = (at(0.5) - at(-0.5)).abs();
    assert!(smear > 9.0, "{smear}");
    for samples in [1, 2, 4] {
        // Beam 0 of frame 1.
        let rows = lit_rows(&driven(fast(samples), &mesh).1[2]);
        let parts = f64::from(samples);
        let expected: Vec<f64> =
            (0..samples).map(|sample| at((f64::from(sample) + 0.5) / parts - 0.5)).collect();
        // Half of the sheet is a quarter of a row at 2 m; a row is lit as a whole, and its middle stands for it.
        let bound = 0.25 + 0.5;
        let is_near = |a: f64, b: f64| (a - b).abs() < bound;
        assert!(expected.iter().all(|at| rows.iter().any(|row| is_near(*row, *at))), "{rows:?} {expected:?}");
        assert!(rows.iter().all(|row| expected.iter().any(|at| is_near(*row, *at))), "{rows:?} {expected:?}");
        // Between the first and the last image lie all but one of k equal parts of the way, but for its bend.
        let between = (expected[0] - expected[expected.len() - 1]).abs();
        assert!((between - smear * (parts - 1.0) / parts).abs() < 0.05 * smear, "{between} {smear}");
    }
    // Light is averaged, not added: one image has as much of it as five.
    let total = |samples| -> f64 {
        let times = ExposureTimes { duration: 1e-6, samples, ..ExposureTimes::default() };
        driven(plan(times), &mesh).1[2].cells().iter().sum()
    };
    assert!((total(5) / total(1) - 1.0).abs() < 1e-3);
}

#[test]
fn the_beams_in_turn_see_the_ramp_from_different_places() {
    // The rover takes both stripes for those of one pose. The second is of v interval farther on: by it the ramp begins so much
    // nearer, and its points lie SLOPE v interval above it.
    let mesh = extruded(&RAMP);
    for (interval, has_unlit, farther) in [(0.0, false, 0.0), (0.4, false, 0.12), (0.2, true, 0.12)] {
        let times = ExposureTimes { interval, has_unlit, ..ExposureTimes::default() };
        let (frames, _) = driven(plan(times), &mesh);
        let frame = &frames[1];
        for (beam, farther) in [(0, 0.0), (1, farther)] {
            let of_beam = frame.measured.iter().filter(|one| one.beam == beam && one.point.y.abs() < 0.3);
            let above: Vec<f64> =
                of_beam.map(|one| one.point.z - SLOPE * (one.point.x + 0.3 - RAMP_FROM)).collect();
            assert!(above.len() > 20, "{}", above.len());
            let mean = above.iter().sum::<f64>() / above.len() as f64;
            // A quarter of a row of the image, at 3 m less than 5 mm of height, for pixels that are lit in part.
            assert!((mean - SLOPE * farther).abs() < 5e-3, "beam {beam}: {mean} for {}", SLOPE * farther);
        }
    }
}

/// A renderer whose light is the camera's x in every pixel.
struct PlaceAsLight;

impl Renderer for PlaceAsLight {
    fn name(&self) -> &str {
        "place as light"
    }

    fn precision(&self) -> Precision {
        Precision::F64
    }

    fn render(&self, scene: &Scene, _request: &Request) -> RenderOutput {
        let x = scene.camera().scene_from_sensor.position.x + scene.mesh().origin().x;
        let flux = scene.beams().iter().map(|_| Image::filled(1024, 1024, x)).collect();
        RenderOutput { camera: None, beams: Vec::new(), returns: Vec::new(), flux, stages: Vec::new() }
    }
}

#[test]
fn each_row_of_a_rolling_shutter_is_seen_from_where_the_vehicle_is_then() {
    // 0.3 m/s over a plane, 0.25 ms from row to row: row j is seen 0.3 x 0.25 mm x j farther on. Frame 1 begins at x = 0.3 m, and
    // the camera is 0.3 m before the vehicle's middle. A row is at most half a band's rows off.
    let mesh = extruded(&LEVEL);
    let image = |times: ExposureTimes| {
        let mut drive = Drive::new(plan(times), Arc::clone(&mesh)).unwrap();
        let mut images = Vec::new();
        for _ in 0..2 {
            drive
                .step(&PlaceAsLight, &mut |_, flux| {
                    images.push(flux.clone());
                    CameraImage::Flux(flux)
                })
                .unwrap();
        }
        images.swap_remove(2)
    };
    for (bands, samples) in [(1, 1), (4, 1), (16, 4), (64, 1), (21, 3)] {
        let times =
            ExposureTimes { row_time: 2.5e-4, bands, samples, duration: 0.1, ..ExposureTimes::default() };
        let found = image(times);
        let row = |j: u32| found.at(7, j) - 0.6;
        let way = SPEED * 2.5e-4;
        for j in 0..1024 {
            assert!(
                (row(j) - way * f64::from(j)).abs() < way * 512.0 / f64::from(bands) + 1e-12,
                "{bands} {j}"
            );
        }
        // The middle row of a band is exact: with 4 bands of 256 rows the middles are rows 127.5, 383.5, ...
        if bands == 4 {
            for band in 0..4 {
                let middle = 256.0 * f64::from(band) + 127.5;
                for j in [256 * band, 256 * band + 255] {
                    assert!((row(j) - way * middle).abs() < 1e-12, "{j}");
                }
            }
        }
    }
    // Off, an image is that of one pose, bit for bit, whatever the number of bands.
    let off = image(ExposureTimes { bands: 64, ..ExposureTimes::default() });
    assert_eq!(off, image(ExposureTimes::default()));
    assert_eq!(off.at(3, 1000), 0.6);
}

#[test]
fn a_rolling_shutter_lifts_what_rises_by_the_way_until_its_row() {
    // The rover takes all rows for those of one pose. A stripe in row j is seen v j t farther on, by which the ramp begins nearer:
    // its points lie SLOPE v j t above it. 0.9 ms from row to row, 0.92 s for all; with 64 bands a row is off by 7.2 ms, 2.2 mm of way.
    let mesh = extruded(&RAMP);
    let times = ExposureTimes { row_time: 9e-4, bands: 64, ..ExposureTimes::default() };
    let (frames, _) = driven(plan(times), &mesh);
    for beam in [0, 1] {
        let seen: Vec<_> = frames[1]
            .measured
            .iter()
            .filter(|one| one.beam == beam && one.point.y.abs() < 0.3)
            .map(|one| (one.edge.j, one.point.z - SLOPE * (one.point.x + 0.3 - RAMP_FROM)))
            .collect();
        assert!(seen.len() > 20, "{}", seen.len());
        let expected = |j: u32| SLOPE * SPEED * 9e-4 * f64::from(j);
        let mean = seen.iter().map(|&(j, above)| above - expected(j)).sum::<f64>() / seen.len() as f64;
        // The bound of pixels lit in part, as above, and half a band: SLOPE 2.2 mm.
        assert!(mean.abs() < 5e-3 + 1.1e-3, "beam {beam}: {mean}");
        // The displacement itself is many times that.
        assert!(seen.iter().all(|&(j, _)| expected(j) > 0.05), "{seen:?}");
    }
}

#[test]
fn a_scan_takes_the_time_of_its_positions_and_sensors_drift_meanwhile() {
    // One frame a second for 3 s, 0.3 m each; scans in frame 0 and, after 0.5 m, in frame 2. Each takes 3 x 4 s.
    let mesh = extruded(&LEVEL);
    let errors = LocalisationErrors {
        position_drift: DVec2::new(0.01, -0.02),
        heading_drift: 0.001,
        ..LocalisationErrors::default()
    };
    let scans = Some(ScanRule { every: Some(0.5), inconsistency: None, ..ScanRule::default() });
    let sweep = Sweep { steps: 3, step_time: 4.0, ..Sweep::default() };
    let mut plan = DrivePlan { scans, sweep, errors, ..plan(ExposureTimes::default()) };
    plan.route.waypoints = vec![DVec2::new(0.9, 0.0)];
    let (frames, _) = driven(plan.clone(), &mesh);
    let is_scan: Vec<bool> = frames.iter().map(|frame| frame.scan.is_some()).collect();
    assert_eq!(is_scan, [true, false, true, false]);
    for (frame, time) in frames.iter().zip([0.0, 13.0, 14.0, 27.0]) {
        assert_eq!(frame.time, time);
        // The route does not go on meanwhile, the drift does.
        assert!((frame.place.driven - 0.3 * frame.index as f64).abs() < 1e-12);
        let off = frame.sensed.position - frame.stance.position.truncate();
        assert!((off - errors.position_drift * time).length() < 1e-12, "{off} at {time}");
        let turned = frame.sensed.attitude.heading - frame.stance.attitude.heading;
        assert!((turned - 0.001 * time).abs() < 1e-12, "{turned} at {time}");
    }
    // Without a time of its positions a scan is as short as a frame.
    plan.sweep.step_time = 0.0;
    let times: Vec<f64> = driven(plan.clone(), &mesh).0.iter().map(|frame| frame.time).collect();
    assert_eq!(times, [0.0, 1.0, 2.0, 3.0]);
    for (step_time, is_refused) in [(-1.0, true), (1e4, false), (1.1e4, true)] {
        plan.sweep.step_time = step_time;
        let field = plan.validate("drive").err().map(|error| error.field);
        assert_eq!(field.as_deref(), is_refused.then_some("drive.sweep.step_time"), "{step_time}");
    }
}

#[test]
fn times_are_checked() {
    let refused = |times: ExposureTimes| plan(times).validate("drive").map_err(|error| error.field);
    let default = ExposureTimes::default();
    assert_eq!(refused(default), Ok(()));
    // Two beams in a second, each with an unlit image: four exposures of a quarter.
    assert_eq!(refused(ExposureTimes { interval: 0.25, has_unlit: true, ..default }), Ok(()));
    let interval = Err("drive.times.interval".to_string());
    assert_eq!(refused(ExposureTimes { interval: 0.26, has_unlit: true, ..default }), interval);
    assert_eq!(refused(ExposureTimes { interval: -0.1, ..default }), interval);
    assert_eq!(refused(ExposureTimes { interval: f64::NAN, ..default }), interval);
    // An exposure ends before the next.
    assert_eq!(refused(ExposureTimes { interval: 1e-3, duration: 2e-3, ..default }), interval);
    assert_eq!(refused(ExposureTimes { interval: 2e-3, duration: 2e-3, ..default }), Ok(()));
    for samples in [0, 65] {
        let field = refused(ExposureTimes { samples, ..default });
        assert_eq!(field, Err("drive.times.samples".into()), "{samples}");
    }
    assert_eq!(refused(ExposureTimes { samples: 64, ..default }), Ok(()));
    // 1024 rows: 1023 times from row to row in a frame of a second, and before the next exposure.
    let rolling = ExposureTimes { row_time: 1.0 / 1023.0, ..default };
    assert_eq!(refused(rolling), Ok(()));
    let row_time = Err("drive.times.row_time".to_string());
    assert_eq!(refused(ExposureTimes { row_time: 1.0 / 1022.0, ..default }), row_time);
    assert_eq!(refused(ExposureTimes { row_time: -1e-6, ..default }), row_time);
    let pair = |interval| ExposureTimes { interval, row_time: 1e-4, duration: 2e-3, ..default };
    assert_eq!((refused(pair(0.1043)), refused(pair(0.1042))), (Ok(()), interval));
    for (bands, samples, fits) in
        [(0, 1, false), (65, 1, false), (64, 1, true), (17, 4, false), (16, 4, true)]
    {
        let field = refused(ExposureTimes { bands, samples, ..rolling });
        assert_eq!(field, if fits { Ok(()) } else { Err("drive.times.bands".into()) }, "{bands} {samples}");
    }
}
