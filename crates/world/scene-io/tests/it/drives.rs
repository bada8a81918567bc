//! Drives of scene files: defaults that depend on other keys, and what follows from the resolved scene.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, FRAC_PI_6, PI};

use glam::{DVec2, DVec3};

use raypencil_rover::{
    Detection, ExposureMode, ExposureTimes, Extraction, RadialGrid, SlopeLimits, StripeLocation,
    TraversabilityRules, TrueLimits, Vehicle,
};
use raypencil_scene_io::{DriveSetup, LoadedScene, default_threshold, load_text};
use raypencil_sensor::{ImageLength, ImageSensor, Psf, Speckle, preset};

/// A scene whose vehicle stands at (1, 2) and looks along global y, with these keys of `[drive]`.
fn scene(camera: &str, drive: &str) -> LoadedScene {
    let text = format!(
        "version = 1\n[vehicle]\nposition_m = [1, 2, 3]\nheading_deg = 90\n[camera]\n{camera}\n\
         [[beam]]\nwavelength_nm = 800\n[drive]\nwaypoints_m = [[4, 5]]\n{drive}\n"
    );
    load_text(&text, "drive").unwrap()
}

fn drive(keys: &str) -> DriveSetup {
    scene("", keys).drive.unwrap()
}

#[test]
fn a_drive_starts_where_the_vehicle_stands() {
    let loaded = scene("", "");
    let plan = &loaded.drive.as_ref().unwrap().plan;
    assert_eq!(plan.rig, loaded.rig());
    assert_eq!(plan.route.start, DVec2::new(1.0, 2.0));
    // 4 m ahead along global y and 5 m to the left of (1, 2); in the global frame it is what it says.
    assert!((plan.route.waypoints[0] - DVec2::new(-4.0, 6.0)).length() < 1e-12);
    let global = drive("waypoints_frame = \"global\"").plan;
    assert_eq!(global.route.waypoints, [DVec2::new(4.0, 5.0)]);
    assert!((plan.route.heading - 90.0_f64.to_radians()).abs() < 1e-15);
    assert_eq!(plan.flux_model, loaded.scene.flux_model());
}

#[test]
fn the_default_threshold_follows_the_preset() {
    let detection = |keys: &str| drive(keys).plan.extraction.detection;
    for name in ["ideal", "ccd_1989", "cmos"] {
        let level = default_threshold(name);
        assert_eq!(detection(&format!("sensor = \"{name}\"")), Detection::Fixed(level));
        // The preset's own bias is subtracted with the unlit image, whatever the bias of the file.
        let bias = preset(name).unwrap().1.bias;
        let keys = format!("sensor = \"{name}\"\nsubtract_unlit = true\nelectronics = {{ bias_dn = 7 }}");
        assert_eq!(detection(&keys), Detection::Fixed(level - bias));
    }
    assert_eq!(detection("detection = \"gradient\""), Detection::Gradient(400.0));
    assert_eq!(detection("detection = \"gradient\"\nthreshold_dn = 9"), Detection::Gradient(9.0));
    assert_eq!(detection("sensor = \"cmos\"\ndetection = \"otsu\""), Detection::Otsu);
}

#[test]
fn default_thresholds_are_those_of_the_guide() {
    // docs/guide/drive.md. An unknown preset has that of `ideal`.
    let found = ["ideal", "ccd_1989", "cmos", "film"].map(default_threshold);
    assert_eq!(found, [400.0, 4.0, 100.0, 400.0]);
}

#[test]
fn a_focus_lies_beyond_the_focal_length_and_a_fine_image_has_a_limit() {
    let mut drive = drive("optics = { blurs = [] }");
    let refused = |drive: &DriveSetup| drive.validate_camera().err().map(|error| error.field);
    // The default camera has 8 mm.
    for (focus, is_refused) in [(7e-3, true), (8e-3, true), (9e-3, false), (4.0, false)] {
        drive.optics.focus = Some(focus);
        assert_eq!(refused(&drive).as_deref(), is_refused.then_some("drive.optics.focus"), "{focus}");
    }
    // 1024 x 1024 pixels of 16 x 16 cells are 2^28 cells, the limit.
    for (oversampling, is_refused) in [(16, false), (17, true)] {
        drive.optics.oversampling = oversampling;
        assert_eq!(refused(&drive).as_deref(), is_refused.then_some("drive.optics.oversampling"));
    }
}

#[test]
fn speckle_is_that_of_the_camera_and_of_the_first_beam() {
    // 8 mm / 1 mm = f/8 at 800 nm: sqrt 2 / pi of 6.4 um.
    let speckle = |keys: &str| scene("aperture_mm = 1", keys).drive.unwrap();
    let found = speckle("optics = { speckle_contrast = 0.5 }").optics.speckle.unwrap();
    assert_eq!(found.contrast, 0.5);
    near(found.grain, 0.450_158_158_078_553 * 6.4e-6);
    // Off by default, with every preset and with a contrast of 0.
    for keys in ["", "sensor = \"cmos\"", "sensor = \"ccd_1989\"", "optics = { speckle_contrast = 0 }"] {
        assert_eq!(speckle(keys).optics.speckle, None, "{keys}");
    }
    // A pixel of 9 um with one cell takes a grain of 9/64 = 0.140625 um to 288 um.
    let mut drive = speckle("optics = { speckle_contrast = 0.5 }");
    for (grain, is_refused) in [(0.1406e-6, true), (0.1407e-6, false), (287.9e-6, false), (288.1e-6, true)] {
        drive.optics.speckle = Some(Speckle { contrast: 0.5, grain });
        let field = drive.validate_camera().err().map(|error| error.field);
        assert_eq!(field.as_deref(), is_refused.then_some("drive.optics.speckle.grain"), "{grain}");
    }
}

#[test]
fn only_a_default_threshold_ignores_what_the_file_changes() {
    let ignored = |keys: &str| drive(keys).threshold_ignores;
    let (sun, electronics) = ("sun = { elevation_deg = 30 }", "electronics = { bits = 16 }");
    assert_eq!(ignored(""), None);
    assert_eq!(ignored("electronics = {}"), None);
    assert_eq!(ignored(electronics), Some("other electronics"));
    assert_eq!(ignored(&format!("{sun}\n{electronics}")), Some("a sun behind the stripes"));
    // 400 DN is the default, but now the file says so.
    assert_eq!(ignored(&format!("{sun}\nthreshold_dn = 400")), None);
    assert_eq!(ignored(&format!("{sun}\ndetection = \"otsu\"")), None);
}

#[test]
fn rules_follow_from_the_vehicle_of_the_file() {
    let plan = drive("wheelbase_m = 2\nrules = { gap = \"paper\" }\ngrid_sectors = 7\nslope_rear = 0.5").plan;
    let vehicle = Vehicle { wheelbase: 2.0, ..Vehicle::default() };
    assert_eq!(plan.vehicle, vehicle);
    let mut rules = TraversabilityRules::for_vehicle(&vehicle);
    rules.gaps = None;
    rules.slopes.rear = 0.5;
    assert_eq!(plan.rules, rules);
    assert_eq!(plan.grid, RadialGrid { sectors: 7, ..RadialGrid::for_vehicle(&vehicle) });
}

#[test]
fn diffraction_is_that_of_the_camera_and_of_the_first_beam() {
    // 8 mm / 1 mm = f/8, in place of the preset's f/4 at 810 nm.
    let camera = "aperture_mm = 1";
    let airy = |rings| Psf::Airy { wavelength: 800e-9, f_number: 8.0, rings };
    let by_preset = scene(camera, "sensor = \"cmos\"").drive.unwrap();
    assert_eq!((&by_preset.optics.blurs[0], by_preset.sensor.wavelength), (&airy(8), 800e-9));
    let own = scene(camera, "optics = { blurs = [{ airy_rings = 2 }] }").drive.unwrap();
    assert_eq!(own.optics.blurs, [airy(2)]);
}

#[test]
fn every_number_of_the_electronics_has_its_field_and_its_unit() {
    // Numbers of which no two are alike: two that are exchanged show. 20 ms are 0.02 s; 0 degrees Celsius are 273.15 K.
    let keys = "electronics = { exposure_ms = 20, quantum_efficiency = 0.5, dark_e_per_s = 30, dark_at_c = 20, \
        dark_doubling_k = 8, temperature_c = -10, read_noise_e = 12, prnu = 0.01, dsnu_e = 3, full_well_e = 40000, \
        gain_dn_per_e = 0.25, bias_dn = 16, bits = 10 }";
    let sensor = drive(keys).sensor;
    assert!((sensor.exposure - 0.02).abs() < 1e-17, "{}", sensor.exposure);
    let dark = sensor.dark_current;
    assert_eq!((dark.rate, dark.doubling_kelvins), (30.0, 8.0));
    assert!((dark.reference_temperature - 293.15).abs() < 1e-12 && (dark.temperature - 263.15).abs() < 1e-12);
    assert_eq!((sensor.quantum_efficiency, sensor.read_noise, sensor.prnu), (0.5, 12.0, 0.01));
    assert_eq!((sensor.dsnu, sensor.full_well, sensor.gain), (3.0, 40_000.0, 0.25));
    assert_eq!((sensor.bias, sensor.bits), (16.0, 10));
}

#[test]
fn a_sun_has_its_angles_in_radians_and_its_irradiance_per_metre() {
    // 2 W/m^2 per nanometre are 2e9 W/m^2 per metre. Without dust all of it is direct light, at any elevation.
    let keys =
        "sun = { elevation_deg = 30, azimuth_deg = 90, optical_depth = 0, irradiance_w_per_m2_nm = 2 }";
    let sun = drive(keys).sunlight.unwrap();
    assert!((sun.direct - 2e9).abs() < 1e-5 && sun.sky == 0.0, "{sun:?}");
    // Half way up on the left: (cos 30 cos 90, cos 30 sin 90, sin 30).
    let expected = DVec3::new(0.0, 0.75_f64.sqrt(), 0.5);
    assert!((sun.direction() - expected).length() < 1e-15, "{}", sun.direction());
}

/// Equal to a few roundings.
#[track_caller]
fn near(found: f64, expected: f64) {
    assert!((found - expected).abs() <= 1e-14 * expected.abs(), "{found} is not {expected}");
}

#[test]
fn keys_of_the_route_and_of_the_images_set_their_numbers() {
    let drive = drive(
        "speed_m_per_s = 0.5\nturn_deg_per_s = 90\nframes_per_s = 4\nseed = 11\nsensor = \"ccd_1989\"\n\
         sensor_seed = 12\nsubtract_unlit = true\npencils_per_pixel = 3\nexposures = \"together\"\n\
         place = \"sub_pixel\"\nleast_rows = 2",
    );
    let route = &drive.plan.route;
    assert_eq!((route.speed, route.frame_rate, drive.plan.seed), (0.5, 4.0, 11));
    near(route.turn_rate, FRAC_PI_2);
    assert_eq!((drive.preset, drive.sensor.seed, drive.subtract_unlit), ("ccd_1989", 12, true));
    assert_eq!((drive.pencils_per_pixel, drive.plan.exposures), (3.0, ExposureMode::Together));
    // 4 DN by default, and 2 DN of bias that the unlit image takes away.
    let expected =
        Extraction { detection: Detection::Fixed(2.0), place: StripeLocation::SubPixel, least_rows: 2 };
    assert_eq!(drive.plan.extraction, expected);
}

#[test]
fn times_of_exposures_follow_from_their_keys_and_from_the_sensor() {
    let keys = "sensor = \"cmos\"\nsubtract_unlit = true\nexposure_interval_ms = 20\nmotion_blur_samples = 5";
    let rolling = "row_time_us = 10";
    let expected = ExposureTimes {
        interval: 0.02,
        has_unlit: true,
        duration: 0.4e-3,
        samples: 5,
        row_time: 1e-6 * 10.0,
        // 64 images of an exposure in all.
        bands: 12,
    };
    assert_eq!(drive(&format!("{keys}\n{rolling}")).plan.times, expected);
    assert_eq!(drive(&format!("{rolling}\nrow_bands = 64")).plan.times.bands, 64);
    assert_eq!(drive(rolling).plan.times.bands, 16);
    let default = drive("").plan.times;
    assert!(default.is_at_once());
    assert_eq!(default, ExposureTimes { duration: 2e-3, ..ExposureTimes::default() });
}

#[test]
fn keys_of_the_maps_and_scans_set_their_numbers() {
    let plan = drive(
        "map_spacing_m = 0.2\nmap_points = 51\nobstacles_every_frames = 5\nslope_front = 0.1\nslope_rear = 0.2\n\
         slope_length = 0.3\nslope_closer = 0.4\ngrid_first_m = 1.5\ngrid_last_m = 1.5\ngrid_step_m = 0.25\n\
         grid_half_angle_deg = 90\nvector_large_m = 3\nvector_small_m = 2\nscan_every_m = 7\nscan_steps = 9\n\
         scan_step_s = 0.5\n\
         scan_from_deg = -90\nscan_to_deg = 90\nscan_inconsistency_m = 0.5\nscan_least_points = 3",
    )
    .plan;
    assert_eq!((plan.map.spacing, plan.map.points, plan.obstacles_every), (0.2, 51, 5));
    assert_eq!(plan.rules.slopes, SlopeLimits { front: 0.1, rear: 0.2, length: 0.3, closer: 0.4 });
    // A grid of one radius: the last is the first.
    assert_eq!((plan.grid.first, plan.grid.last, plan.grid.step), (1.5, 1.5, 0.25));
    near(plan.grid.half_angle, FRAC_PI_2);
    assert_eq!((plan.vectors.large, plan.vectors.small), (3.0, 2.0));
    let scans = plan.scans.unwrap();
    assert_eq!((scans.every, scans.inconsistency, scans.least_points), (Some(7.0), Some(0.5), 3));
    near(plan.sweep.from, -FRAC_PI_2);
    near(plan.sweep.to, FRAC_PI_2);
    assert_eq!((plan.sweep.steps, plan.sweep.step_time), (9, 0.5));
    assert_eq!(drive("scans = false").plan.scans, None);
}

#[test]
fn keys_of_the_truth_set_the_vehicles_limits_and_not_the_rovers() {
    let keys = "true_slope_front = 0.5\ntrue_slope_rear = 0.6\ntrue_slope_length = 0.7\ntrue_clearance_m = 0.2\n\
        true_step_m = 0.25\ntrue_centre_of_mass_m = [0.1, -0.2, 0.9]";
    let plan = drive(keys).plan;
    let expected = TrueLimits {
        front: Some(0.5),
        rear: Some(0.6),
        length: Some(0.7),
        clearance: Some(0.2),
        step: Some(0.25),
        centre_of_mass: Some(DVec3::new(0.1, -0.2, 0.9)),
    };
    assert_eq!(plan.truth, expected);
    let default = drive("").plan;
    assert_eq!((plan.rules, plan.vehicle), (default.rules, default.vehicle));
    assert_eq!(default.truth, TrueLimits::default());
    // The rover's own limits are the vehicle's, too, until it has others.
    let own = drive("slope_rear = 0.5\ntrue_slope_length = 0.7").plan;
    assert_eq!(own.truth.slopes(&own.rules.slopes), [0.35, 0.5, 0.7]);
}

#[test]
fn keys_of_the_vehicle_and_its_errors_set_their_numbers() {
    let plan = drive(
        "wheelbase_m = 2\ntrack_m = 1.5\nwheel_radius_m = 0.5\nwheel_width_m = 0.125\nclearance_m = 0.25\n\
         position_drift_m_per_s = [0.1, -0.2]\nposition_walk_m = 0.3\nheading_bias_deg = -45\npitch_bias_deg = -30\n\
         roll_bias_deg = 45\nheading_drift_deg_per_s = -50\nattitude_noise_deg = 18\nproximity_noise_m = 0.4\n\
         fix_every_frames = 6\nfix_noise_m = 0.5",
    )
    .plan;
    let vehicle = Vehicle {
        wheelbase: 2.0,
        track: 1.5,
        wheel_radius: 0.5,
        wheel_width: 0.125,
        clearance: 0.25,
        ..Vehicle::default()
    };
    assert_eq!(plan.vehicle, vehicle);
    let errors = plan.errors;
    assert_eq!((errors.position_drift, errors.position_walk), (DVec2::new(0.1, -0.2), 0.3));
    near(errors.attitude_bias.heading, -FRAC_PI_4);
    near(errors.attitude_bias.pitch_down, -FRAC_PI_6);
    near(errors.attitude_bias.roll_right, FRAC_PI_4);
    near(errors.heading_drift, -PI / 3.6);
    near(errors.attitude_noise, PI / 10.0);
    assert_eq!((errors.proximity_noise, errors.fixes.unwrap().every_frames), (0.4, 6));
    assert_eq!(errors.fixes.unwrap().noise, 0.5);
}

#[test]
fn keys_of_the_sun_set_its_light() {
    // 0.5 W/m^2 per nm above the air, at 30 degrees through tau = 1/4: exp(-1/2) of it is left, and the sky has 0.7 of
    // the rest of what would fall on level ground.
    let sun =
        "sun = { elevation_deg = 30, azimuth_deg = 45, optical_depth = 0.25, irradiance_w_per_m2_nm = 0.5 }";
    let light = drive(sun).sunlight.unwrap();
    near(light.elevation, FRAC_PI_6);
    near(light.azimuth, FRAC_PI_4);
    let left = libm::exp(-0.5);
    let close =
        |found: f64, expected: f64| assert!((found / expected - 1.0).abs() < 1e-13, "{found} {expected}");
    close(light.direct, 0.5e9 * left);
    close(light.sky, 0.7 * 0.5e9 * 0.5 * (1.0 - left));
    assert_eq!(drive("").sunlight, None);
}

#[test]
fn keys_of_the_camera_set_its_numbers() {
    let drive = drive(
        "optics = { oversampling = 2, focus_m = 6, blurs = [{ gaussian_px = 0.5 }, { gaussian_um = 3 }], \
         dust = { transmission = 0.8, halo_share = 0.1, halo_px = 7 } }\n\
         electronics = { exposure_ms = 4, quantum_efficiency = 0.25, shot_noise = true, dark_e_per_s = 50, \
         dark_at_c = 10, dark_doubling_k = 5, temperature_c = 20, read_noise_e = 6, prnu = 0.125, dsnu_e = 8, \
         full_well_e = 900, gain_dn_per_e = 0.5, bias_dn = 11, bits = 12 }",
    );
    let optics = &drive.optics;
    assert_eq!((optics.oversampling, optics.focus), (2, Some(6.0)));
    let gaussian = |sigma| Psf::Gaussian { sigma };
    assert_eq!(optics.blurs[0], gaussian(ImageLength::Pixels(0.5)));
    let Psf::Gaussian { sigma: ImageLength::Metres(sigma) } = optics.blurs[1] else {
        panic!("a length in metres")
    };
    near(sigma, 3e-6);
    let dust = optics.dust.unwrap();
    assert_eq!((dust.transmission, dust.halo_share), (0.8, 0.1));
    assert_eq!(dust.halo_sigma, ImageLength::Pixels(7.0));

    let ImageSensor { exposure, dark_current: dark, .. } = drive.sensor;
    near(exposure, 4e-3);
    near(dark.reference_temperature, 283.15);
    near(dark.temperature, 293.15);
    assert_eq!((dark.rate, dark.doubling_kelvins), (50.0, 5.0));
    let expected = ImageSensor {
        exposure,
        wavelength: 800e-9,
        quantum_efficiency: 0.25,
        shot_noise: true,
        dark_current: dark,
        read_noise: 6.0,
        prnu: 0.125,
        dsnu: 8.0,
        full_well: 900.0,
        gain: 0.5,
        bias: 11.0,
        bits: 12,
        seed: 0,
    };
    assert_eq!(drive.sensor, expected);
}

#[test]
fn sixteen_blurs_and_no_more() {
    let blurs = |count: usize| {
        let list = vec!["{ gaussian_px = 0.5 }"; count].join(", ");
        let keys = format!("optics = {{ blurs = [{list}] }}");
        load_text(&format!("version = 1\n[drive]\nwaypoints_m = [[4, 5]]\n{keys}\n"), "drive")
    };
    assert_eq!(blurs(16).unwrap().drive.unwrap().optics.blurs.len(), 16);
    assert!(blurs(17).is_err());
}
