use raypencil_rover::{
    Detection, ExposureMode, MapRules, PointLookup, RadialGrid, Rule, StartRule, StripeLocation,
    TraversabilityRules,
};
use raypencil_scene::{Beam, Scene};
use raypencil_scene_io::{Overrides, Setting, load, load_text};
use raypencil_sensor::{DarkCurrent, Dust, ImageLength, Psf, Speckle};

use super::*;
use crate::common::{FLAT, SHORT, driven, job, scene, scene_text};

#[test]
fn the_built_in_drives_are_the_papers() {
    let of = |name: &str| {
        let loaded = load(name, &Default::default()).unwrap();
        DriveJob::new(&loaded, None, name.into()).unwrap()
    };
    let pyramids = of("pyramids");
    assert_eq!((pyramids.plan.route.start, pyramids.plan.route.heading), (DVec2::new(-7.5, 0.0), 0.0));
    assert_eq!(pyramids.plan.route.waypoints, [DVec2::ZERO]);
    // 7.5 m at 0.3 m/s and ten frames a second, both ends included.
    assert_eq!(pyramids.frames().unwrap(), 251);
    assert_eq!(pyramids.plan.rig.beams[0].sensor.columns, 4106);
    assert!(pyramids.plan.scans.is_none());
    assert_eq!(of("facets").frames().unwrap(), 201);
}

#[test]
fn every_key_of_the_drive_is_read() {
    let all = "waypoints_m = [[1, 0], [1, 2]]\nspeed_m_per_s = 0.5\nturn_deg_per_s = 90\nframes_per_s = 5\nseed = 9\n\
        sensor = \"cmos\"\nsensor_seed = 4\nexposures = \"together\"\ndetection = \"gradient\"\nthreshold_dn = 30\n\
        place = \"sub_pixel\"\nleast_rows = 2\nmap_spacing_m = 0.2\nmap_points = 101\nobstacles_every_frames = 4\n\
        scans = true\nscan_every_m = 3\nscan_steps = 21\nwheelbase_m = 1.5\ntrack_m = 1.1\n\
        wheel_radius_m = 0.4\nwheel_width_m = 0.3\nclearance_m = 0.45\nposition_drift_m_per_s = [0.01, 0]\n\
        position_walk_m = 0.02\nheading_drift_deg_per_s = 1\nattitude_noise_deg = 2\nproximity_noise_m = 0.03\n\
        fix_every_frames = 50\nfix_noise_m = 0.1\nslope_front = 0.3\nslope_length = 0.25\ngrid_first_m = 0.9\n\
        grid_last_m = 4\ngrid_step_m = 0.2\ngrid_half_angle_deg = 45\ngrid_sectors = 19\nvector_large_m = 1\n\
        vector_small_m = 0.4\nscan_from_deg = -5\nscan_to_deg = 30\nscan_inconsistency_m = 0.2\n\
        scan_least_points = 40\nheading_bias_deg = 1\npitch_bias_deg = -2\nroll_bias_deg = 3\nlookup = \"table\"\n\
        waypoints_frame = \"global\"\nrear_needed = false\n[drive.rules]\nstart = \"footprint\"\nelevation = \"paper\"\ntests = \"paper\"";
    let job = job(FLAT, all);
    let plan = &job.plan;
    let route = &plan.route;
    assert_eq!((route.speed, route.frame_rate, route.waypoints.len()), (0.5, 5.0, 2));
    assert_eq!(route.turn_rate, 90.0_f64.to_radians());
    assert_eq!((job.preset, job.sensor.seed, job.sensor.bits), ("cmos", 4, 12));
    assert_eq!((plan.seed, plan.map.points, plan.map.spacing, plan.obstacles_every), (9, 101, 0.2, 4));
    assert_eq!(route.waypoints, [DVec2::new(1.0, 0.0), DVec2::new(1.0, 2.0)]);
    assert_eq!((plan.exposures, plan.lookup), (ExposureMode::Together, PointLookup::Table));
    let of_the_map = MapRules { start: StartRule::Footprint, elevation: Rule::Paper, ..MapRules::MENDED };
    assert_eq!(plan.map_rules, of_the_map);
    assert_eq!(plan.extraction.detection, Detection::Gradient(30.0));
    assert_eq!((plan.extraction.place, plan.extraction.least_rows), (StripeLocation::SubPixel, 2));
    assert_eq!((plan.sweep.steps, plan.scans.unwrap().every), (21, Some(3.0)));
    assert_eq!((plan.vehicle.wheelbase, plan.vehicle.track, plan.vehicle.clearance), (1.5, 1.1, 0.45));
    // Rules that follow from the vehicle's measures follow from the given ones.
    let mended = TraversabilityRules::for_vehicle(&plan.vehicle);
    let mut rules = TraversabilityRules { tests: Rule::Paper, rear_needed: false, ..mended };
    (rules.slopes.front, rules.slopes.length) = (0.3, 0.25);
    assert_eq!(plan.rules, rules);
    let half_angle = 45.0_f64.to_radians();
    assert_eq!(plan.grid, RadialGrid { sectors: 19, half_angle, first: 0.9, step: 0.2, last: 4.0 });
    assert_eq!((plan.vectors.large, plan.vectors.small), (1.0, 0.4));
    assert_eq!((plan.sweep.from, plan.sweep.to), ((-5.0_f64).to_radians(), 30.0_f64.to_radians()));
    let scans = plan.scans.unwrap();
    assert_eq!((scans.inconsistency, scans.least_points), (Some(0.2), 40));
    let bias = plan.errors.attitude_bias;
    let degrees = [bias.heading, bias.pitch_down, bias.roll_right].map(f64::to_degrees);
    assert_eq!(degrees.map(f64::round), [1.0, -2.0, 3.0]);
    assert_eq!(plan.errors.attitude_noise, 2.0_f64.to_radians());
    assert_eq!(plan.errors.fixes.map(|fixes| (fixes.every_frames, fixes.noise)), Some((50, 0.1)));
}

#[test]
fn every_key_of_the_camera_is_read() {
    // Without keys: the preset, with the diffraction of this camera. Its f-number is 8 mm / 2 mm by default.
    let preset = |name| raypencil_sensor::preset(name).unwrap();
    let plain = job(FLAT, &format!("{SHORT}\nsensor = \"cmos\""));
    assert_eq!((&plain.optics, plain.sensor), (&preset("cmos").0, preset("cmos").1));
    let mut loaded = scene(FLAT, &format!("{SHORT}\nsensor = \"cmos\""));
    let mut camera = *loaded.scene.camera();
    camera.sensor.aperture = 1e-3;
    let mesh = loaded.scene.mesh().clone();
    let (beams, air) = (loaded.scene.beams().to_vec(), loaded.scene.atmosphere());
    loaded.scene = Scene::new(mesh, camera, beams, air, loaded.scene.flux_model()).unwrap();
    let small = DriveJob::new(&loaded, None, String::new()).unwrap();
    assert_eq!(small.optics.blurs[0], Psf::Airy { wavelength: 810e-9, f_number: 8.0, rings: 8 });

    // All keys.
    let all = format!(
        "{SHORT}\nsensor = \"ccd_1989\"\nsensor_seed = 3\n[drive.optics]\noversampling = 2\nfocus_m = 5\n\
         blurs = [{{ gaussian_um = 2 }}, {{ airy_rings = 3 }}, {{ gaussian_px = 0.5 }}]\n\
         dust = {{ transmission = 0.8, halo_share = 0.1, halo_px = 7 }}\nspeckle_contrast = 0.7\n[drive.electronics]\nexposure_ms = 3\n\
         quantum_efficiency = 0.6\nshot_noise = false\ndark_e_per_s = 9\ndark_at_c = 20\ndark_doubling_k = 5\n\
         temperature_c = -40\nread_noise_e = 4\nprnu = 0.01\ndsnu_e = 2\nfull_well_e = 5e4\ngain_dn_per_e = 0.02\n\
         bias_dn = 8\nbits = 10"
    );
    let own = job(FLAT, &all);
    let blurs = vec![
        Psf::Gaussian { sigma: ImageLength::Metres(1e-6 * 2.0) },
        Psf::Airy { wavelength: 810e-9, f_number: 4.0, rings: 3 },
        Psf::Gaussian { sigma: ImageLength::Pixels(0.5) },
    ];
    let dust = Dust { transmission: 0.8, halo_share: 0.1, halo_sigma: ImageLength::Pixels(7.0) };
    let speckle = Speckle::behind(&own.plan.rig.camera.sensor, 810e-9, 0.7);
    let optics =
        Optics { oversampling: 2, focus: Some(5.0), blurs, dust: Some(dust), speckle: Some(speckle) };
    assert_eq!(own.optics, optics);
    // The grain is 0.4502 of 3.24 um; on a pixel of 72 um, which is 49.4 times as wide, q is sqrt(2 pi) / 49.4 - 2 / 49.4^2.
    assert!(
        own.notes
            .iter()
            .any(|note| note == "speckle: contrast 0.7 at a point and 0.035 on a pixel, grain 1.459 um")
    );
    let dark_current = DarkCurrent {
        rate: 9.0,
        reference_temperature: 293.15,
        doubling_kelvins: 5.0,
        temperature: -40.0 + 273.15,
    };
    let sensor = ImageSensor {
        exposure: 1e-3 * 3.0,
        wavelength: 810e-9,
        quantum_efficiency: 0.6,
        shot_noise: false,
        dark_current,
        read_noise: 4.0,
        prnu: 0.01,
        dsnu: 2.0,
        full_well: 5e4,
        gain: 0.02,
        bias: 8.0,
        bits: 10,
        seed: 3,
    };
    assert_eq!(own.sensor, sensor);

    // A bias above 2^8 - 1; a focus at the focal length; a fine image of 1024 x 1024 pixels with 64 x 64 cells each.
    let text = format!("{SHORT}\n[drive.electronics]\nbias_dn = 300\nbits = 8");
    let error = DriveJob::new(&scene(FLAT, &text), None, String::new()).unwrap_err().to_string();
    assert!(error.contains("drive.electronics.bias") && error.contains("300"), "{error}");
    let text = format!("{SHORT}\n[drive.optics]\nfocus_m = 0.008");
    let error = DriveJob::new(&scene(FLAT, &text), None, String::new()).unwrap_err().to_string();
    assert!(error.contains("drive.optics.focus") && error.contains("beyond the focal length"), "{error}");
    let huge = format!("{SHORT}\n[drive.optics]\noversampling = 64\n");
    let mut loaded = scene(FLAT, &huge);
    let mut camera = *loaded.scene.camera();
    (camera.sensor.width, camera.sensor.height) = (1024, 1024);
    let mesh = loaded.scene.mesh().clone();
    let (beams, air) = (loaded.scene.beams().to_vec(), loaded.scene.atmosphere());
    loaded.scene = Scene::new(mesh, camera, beams, air, loaded.scene.flux_model()).unwrap();
    let error = DriveJob::new(&loaded, None, String::new()).unwrap_err();
    assert!(error.to_string().contains("65536 x 65536 cells"), "{error}");
}

#[test]
fn too_few_pencils_and_a_blind_threshold_give_warnings() {
    let few = job(FLAT, &format!("{SHORT}\npencils_per_pixel = 1"));
    assert_eq!(few.warnings.len(), 2);
    assert!(few.warnings[0].to_string().starts_with("beam-0: 1.01 pencils per pixel"), "{:?}", few.warnings);
    // The default threshold does not take the sun or other electronics into account.
    let warned = |more: &str| job(FLAT, &format!("{SHORT}\n{more}")).warnings;
    let sun = "sun = { elevation_deg = 45 }";
    assert!(warned(sun)[0].sentence.contains("is for the preset alone, without a sun"));
    assert!(warned("electronics = { bias_dn = 9 }")[0].sentence.contains("other electronics"));
    assert_eq!(warned(&format!("{sun}\nsubtract_unlit = true")).len(), 1);
    for fine in ["threshold_dn = 3000", "detection = \"otsu\""] {
        assert!(warned(&format!("{sun}\n{fine}")).is_empty(), "{fine}");
    }
    // A beam with enough columns keeps them.
    let own = job(FLAT, &format!("{SHORT}\npencils_per_pixel = 0.3"));
    assert!(own.notes.is_empty() && own.plan.rig.beams[0].sensor.columns == 64);
}

#[test]
fn beams_out_of_order_give_a_warning() {
    let beams = |first: f64, second: f64| {
        let text = format!(
            "version = 1\n[[beam]]\npitch_down_deg = {first}\n[[beam]]\npitch_down_deg = {second}\n{FLAT}\n\
             [drive]\n{SHORT}\nexposures = \"together\"\n"
        );
        DriveJob::new(&load_text(&text, "beams").unwrap(), None, String::new()).unwrap().warnings
    };
    assert!(beams(31.0, 22.0).is_empty());
    assert!(beams(22.0, 31.0)[0].sentence.starts_with("beam 0 is not steeper than beam 1"));
}

#[test]
fn subtracting_an_unlit_image_removes_the_bias() {
    let job = job(FLAT, &format!("{SHORT}\nsensor = \"cmos\"\nsubtract_unlit = true"));
    // The threshold of 100 DN minus the bias of 60 DN.
    assert_eq!(job.plan.extraction.detection, Detection::Fixed(40.0));
    let mut flux = Image::filled(9, 7, 0.0);
    flux.set(4, 4, 2e-11);
    let background = Image::filled(9, 7, 1e-12);
    let pair = job.sensor.expose_pair(&flux, Some(&background), 5);
    let light = Background { lit: background.clone(), unlit: None };
    assert_eq!(job.expose(&flux, Some(&light), 5, &mut None), pair.difference);
}

#[test]
fn a_scene_without_a_beam_has_no_drive() {
    let dark = load_text(&format!("version = 1\nbeam = []\n{FLAT}\n[drive]\n{SHORT}\n"), "dark").unwrap();
    let error = DriveJob::new(&dark, None, String::new()).unwrap_err();
    assert!(error.to_string().contains("no beam: no stripe is lit"), "{error}");
}

#[test]
fn scenes_without_a_drive_are_refused() {
    let still = load_text(&format!("version = 1\n{FLAT}\n"), "still").unwrap();
    let error = DriveJob::new(&still, None, String::new()).unwrap_err();
    assert!(matches!(error, DriveError::NoDrive), "{error}");
    // Settings of a drive alone give no route, but on a built-in ground, which has one.
    let set = load_text(&format!("version = 1\n{FLAT}\n[drive]\nscans = false\n"), "set").unwrap();
    let error = DriveJob::new(&set, None, String::new()).unwrap_err();
    assert!(error.to_string().contains("no waypoints; expected --to X,Y, or waypoints_m"), "{error}");
    let settings = vec![Setting::parse("drive.speed_m_per_s=0.6").unwrap()];
    let built_in = load("pyramids", &Overrides { settings, ..Overrides::default() }).unwrap();
    let built_in = DriveJob::new(&built_in, None, String::new()).unwrap();
    assert_eq!((built_in.plan.route.start.x, built_in.plan.route.speed), (-7.5, 0.6));
    assert_eq!(built_in.plan.route.waypoints, [DVec2::ZERO]);
    // Without a camera a drive by eq1 takes the flux itself, with a threshold that is a share of its maximum. With one it
    // is refused.
    let mut unit = scene(FLAT, SHORT);
    unit.scene = Scene::new(
        unit.scene.mesh().clone(),
        *unit.scene.camera(),
        unit.scene.beams().to_vec(),
        unit.scene.atmosphere(),
        FluxModel::Eq1,
    )
    .unwrap();
    let by_eq1 = DriveJob::new(&unit, None, String::new()).unwrap();
    assert!(by_eq1.is_flux_only() && by_eq1.plan.extraction.detection == Detection::Share(0.02));
    unit.drive.as_mut().unwrap().has_camera = true;
    assert!(matches!(DriveJob::new(&unit, None, String::new()), Err(DriveError::Unit)));
    for camera in
        ["sensor = \"cmos\"", "sun = { elevation_deg = 9 }", "subtract_unlit = true", "electronics = {}"]
    {
        let with_camera = job(FLAT, &format!("{SHORT}\n{camera}"));
        assert!(matches!(with_camera.as_printed("scanline"), Err(DriveError::Unit)), "{camera}");
    }
    let endless = job(FLAT, "waypoints_m = [[1e9, 0]]\nscans = false");
    assert!(matches!(endless.frames(), Err(DriveError::Frames)));
}

#[test]
fn a_drive_as_printed_is_the_papers_in_all_its_rules() {
    let printed =
        job(FLAT, &format!("{SHORT}\nthreshold_share = 0.1")).as_printed("scanline,tracer").unwrap();
    let plan = &printed.plan;
    assert_eq!((plan.route.frame_rate, plan.exposures), (10.0, ExposureMode::Together));
    assert_eq!((plan.lookup, plan.flux_model), (PointLookup::Table, FluxModel::Eq1));
    assert_eq!(plan.extraction.detection, Detection::Share(0.1));
    assert_eq!((plan.extraction.place, plan.map_rules), (StripeLocation::Pixel, MapRules::AS_PRINTED));
    assert_eq!((plan.rules.gaps, plan.rules.tests), (None, Rule::Paper));
    let notes = |renderers: &str| job(FLAT, SHORT).as_printed(renderers).unwrap().notes.concat();
    assert!(notes("scanline-paper").contains("with all of the paper's approximations"));
    assert!(
        printed
            .notes
            .concat()
            .contains("rendered by scanline,tracer, as asked for, and not by scanline-paper")
    );
    assert_eq!((drive_renderer(true), drive_renderer(false)), ("scanline-paper", "scanline"));
    // It can be driven, by both renderers alike, and finds its stripes: beam 0 is 3.296 m ahead.
    let run = driven(&printed, &["scanline", "tracer"]);
    assert!(run.passes(), "{:?}", run.differences);
    // 0.6 m take 2 s: 21 frames at ten a second.
    assert_eq!((run.frames.len(), run.truth.missed.all()), (21, 0));
    let first: Vec<_> = run.points.iter().filter(|point| point.frame == 0 && point.beam == 0).collect();
    assert!(
        first.len() > 50 && first.iter().all(|point| (point.point.x - 3.296).abs() < 0.4),
        "{}",
        first.len()
    );
}

/// A small scene with these keys of `[drive]` and of `[vehicle]`.
fn small(drive: &str, vehicle: &str) -> LoadedScene {
    let text = scene_text("", 2, &format!("{FLAT}\n[vehicle]\n{vehicle}"), &format!("{SHORT}\n{drive}"));
    load_text(&text, "small").expect("a scene")
}

#[test]
fn errors_of_several_keys_together_name_the_keys() {
    for (keys, message) in [
        ("wheel_width_m = 2", "drive.wheel_width_m is 2: expected 0.01 to "),
        ("wheel_radius_m = 1.5", "drive.wheel_radius_m is 1.5: expected "),
        ("wheelbase_m = 30", "drive.grid_last_m is "),
        (
            "wheelbase_m = 30\ngrid_last_m = 20",
            "drive.map_points is 201, which reach 10 m from the middle: expected ",
        ),
        ("row_time_us = 5e5", "drive.row_time_us is 500000 us, thus "),
        (
            "exposure_interval_ms = 0.0001",
            "drive.exposure_interval_ms is 0.0001 ms: expected 0, or at least the duration",
        ),
        (
            "grid_first_m = 0.7\ngrid_last_m = 900\ngrid_step_m = 0.01\ngrid_sectors = 100000",
            "drive.grid_sectors is 100000",
        ),
        ("electronics = { bias_dn = 300, bits = 8 }", "drive.electronics.bias_dn is 300"),
        (
            "motion_blur_samples = 2\nelectronics = { exposure_ms = 334 }",
            "drive.electronics.exposure_ms is 334 ms: expected an exposure within the 333.3",
        ),
        (
            "row_time_us = 100\nelectronics = { exposure_ms = 333 }",
            "drive.electronics.exposure_ms is 333 ms, and 12.7 ms for 128 rows",
        ),
        ("true_centre_of_mass_m = [0.7, 0, 1]", "drive.true_centre_of_mass_m is 0.7: expected -0.6 to 0.6 m"),
        (
            "true_centre_of_mass_m = [0, -0.6, 1]",
            "drive.true_centre_of_mass_m is -0.6: expected -0.5 to 0.5 m",
        ),
    ] {
        let error = DriveJob::new(&small(keys, ""), None, "small.toml".into()).unwrap_err().to_string();
        assert!(error.starts_with(message), "{error}");
    }
}

#[test]
fn an_exposure_as_long_as_a_frame_is_taken() {
    // 3 frames a second.
    for keys in [
        "motion_blur_samples = 2\nelectronics = { exposure_ms = 333.3 }",
        // All is at once: the paper has no word of how long an exposure takes.
        "electronics = { exposure_ms = 334 }",
    ] {
        assert!(DriveJob::new(&small(keys, ""), None, "small.toml".into()).is_ok(), "{keys}");
    }
}

#[test]
fn a_vehicle_that_leans_in_its_file_stands_on_its_wheels_and_is_told_so() {
    let said = |vehicle: &str| {
        let job = DriveJob::new(&small("", vehicle), None, "small.toml".into()).expect("a drive");
        let warnings = driven(&job, &["scanline"]).warnings;
        let told = warnings.into_iter().find(|warning| warning.code.word() == "vehicle_leans_otherwise");
        told.map(|warning| warning.sentence)
    };
    assert_eq!(said("heading_deg = 40"), None);
    let nose = said("heading_deg = 40\npitch_down_deg = 3").unwrap();
    assert!(nose.contains("leans, nose 3.0° down and left side 0.0° up, and"), "{nose}");
    assert!(nose.contains("stands on its wheels: nose 0.0° down and left side 0.0° up"), "{nose}");
    assert!(said("roll_right_deg = -3").unwrap().contains("left side -3.0° up"));
    // Less than a tenth of a degree.
    assert_eq!(said("pitch_down_deg = 0.09"), None);
}

#[test]
fn a_height_at_which_the_vehicle_does_not_stand_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    // Level ground, and a hall's roof 3 m over it, 12 m long.
    let plate = |x: [f64; 2], z: f64| {
        let [low, high] = x;
        format!("v {low} -9 {z}\nv {high} -9 {z}\nv {high} 9 {z}\nv {low} 9 {z}\n")
    };
    let faces = "f 1 2 3 4\nf 5 6 7 8\n";
    let hall = plate([-30.0, 30.0], 0.0) + &plate([-6.0, 6.0], 3.0) + faces;
    std::fs::write(folder.path().join("hall.obj"), hall).unwrap();
    let driven = |position: &str| {
        let file = folder.path().join("hall.obj");
        let ground = format!("[terrain]\nfile = '{}'\n[vehicle]\nposition_m = {position}", file.display());
        let loaded = load_text(&scene_text("", 2, &ground, SHORT), "hall").expect("a scene");
        let job = DriveJob::new(&loaded, None, "hall.toml".into()).expect("a job");
        let run = crate::drive(&job, &[&raypencil_scanline::Scanline::default()], &raypencil_scene::Silent);
        run.map(|run| run.frames[0].stance.position.z).map_err(|error| error.to_string())
    };
    for (position, height) in
        [("[0, 0]", 3.0), ("[0, 0, 3]", 3.0), ("[0, 0, 3.0005]", 3.0), ("[-20, 0, 0]", 0.0)]
    {
        assert_eq!(driven(position), Ok(height), "{position}");
    }
    let below = driven("[0, 0, 0]").unwrap_err();
    assert!(
        below.starts_with("vehicle.position_m is 0 m high: expected no z, or 3.000 m: at (0, 0)"),
        "{below}"
    );
    assert!(below.ends_with("leave the roof out of the mesh"), "{below}");
    let above = driven("[-20, 0, 5]").unwrap_err();
    assert!(above.contains("5 m high: expected no z, or 0.000 m") && !above.contains("roof"), "{above}");
}

#[test]
fn a_place_that_is_set_takes_the_place_of_a_built_in_start() {
    let start = |setting: &str, at: Option<[f64; 2]>| {
        let settings = vec![Setting::parse(setting).unwrap()];
        let loaded = load("pyramids", &Overrides { settings, ..Overrides::default() }).unwrap();
        DriveJob::new(&loaded, at, String::new()).unwrap().plan.route.start
    };
    assert_eq!(start("vehicle.position_m=[-3, 1]", None), DVec2::new(-3.0, 1.0));
    assert_eq!(start("camera.pitch_down_deg=25", None), DVec2::new(-7.5, 0.0));
    assert_eq!(start("camera.pitch_down_deg=25", Some([-2.0, 0.5])), DVec2::new(-2.0, 0.5));
}

#[test]
fn columns_that_a_drive_chooses_are_even() {
    let rig = load("pyramids", &Default::default()).unwrap().rig();
    let camera = rig.camera.sensor;
    for wanted in [1.01, 1.3, 1.37, 4.0, 5.55] {
        let (raised, _) = with_columns(rig.clone(), wanted, &mut Vec::new());
        for beam in raised.beams {
            let Beam { columns, half_width, grid_distance, .. } = beam.sensor;
            // As many as are wanted, and no two more.
            let needed =
                wanted * 2.0 * half_width / grid_distance * camera.focal_length / camera.pixel_pitch[0];
            assert!(
                columns % 2 == 0 && (0.0..2.0).contains(&(f64::from(columns) - needed)),
                "{columns}, {needed}"
            );
        }
    }
}

#[test]
fn the_code_of_the_grounds_map_is_that_of_the_drive() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("ground.tif");
    let corner = DVec2::new(500_000.0, 5_400_000.0);
    let posts = raypencil_terrain::HeightGrid {
        columns: 31,
        rows: 31,
        corner,
        spacing: DVec2::ONE,
        heights: vec![0.0; 31 * 31],
    };
    for code in [Some(32633), None] {
        raypencil_mesh_io::write_geotiff(&file, &posts, code).unwrap();
        let ground =
            format!("[vehicle]\nposition_m = [500015, 5400015]\n[terrain]\ndem = '{}'", file.display());
        let loaded = load_text(&scene_text("", 2, &ground, SHORT), "map").expect("a scene");
        let job = DriveJob::new(&loaded, None, "map.toml".into()).expect("a drive");
        assert_eq!(job.map_code, code);
    }
}
