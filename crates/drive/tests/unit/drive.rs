//! Drives small enough to be known beforehand, and drives of two renderers.

use glam::{DVec2, DVec3};
use proptest::prelude::*;
use std::sync::Arc;

use crate::folder::{occupancy, posts};
use crate::maps::occupancy::Occupancy;
use crate::sun::Sun;
use crate::view::View;
use crate::{DriveError, DriveJob, DriveRun, drive, drive_json, drive_screen, write_drive};
use raypencil_files::write_npy;
use raypencil_mesh_io::read_dem;
use raypencil_rover::{
    CameraImage, Drive, EdgePoint, ElevationMap, Label, MapSize, MeasuredPoint, ObstacleMap, RadialGrid,
    TraversabilityRules, Vehicle,
};
use raypencil_scene::{
    Image, Material, Mesh, Pose, Precision, RenderOutput, Renderer, Request, Scene, Silent,
};
use raypencil_scene_io::{LoadedScene, load, load_text};
use raypencil_sensor::{DarkCurrent, Dust, ImageLength, ImageSensor, Optics, Psf};
use raypencil_tests::schema::{assert_keys_are_closed, schema_faults};
use raypencil_tracer::Tracer;

/// A small camera, beams to match, and a drive of a few frames.
fn scene(terrain: &str, drive: &str) -> LoadedScene {
    let text = format!(
        "version = 1\n[camera]\nwidth_px = 128\nheight_px = 128\npixel_pitch_um = 72\n\
         [[beam]]\nrows = 4\ncolumns = 64\n[[beam]]\nrows = 4\ncolumns = 64\n{terrain}\n[drive]\n{drive}\n"
    );
    load_text(&text, "small").unwrap()
}

fn job(terrain: &str, drive: &str) -> DriveJob {
    DriveJob::new(&scene(terrain, drive), None, "small.toml".into()).unwrap()
}

fn renderer(name: &str) -> Box<dyn Renderer> {
    match name {
        "scanline" => Box::new(raypencil_scanline::Scanline::default()),
        "tracer" => Box::new(Tracer::new()),
        other => panic!("no renderer is called {other}"),
    }
}

fn driven(job: &DriveJob, names: &[&str]) -> DriveRun {
    let renderers: Vec<Box<dyn Renderer>> = names.iter().map(|name| renderer(name)).collect();
    let renderers: Vec<_> = renderers.iter().map(AsRef::as_ref).collect();
    drive(job, &renderers, &Silent).unwrap()
}

/// Ground that rises nowhere by a micrometre.
const FLAT: &str = "[terrain]\ngenerate = { preset = \"viking1\", seed = 3, extent_m = 30, post_spacing_m = 5, \
                    roughness_m = 1e-9, rock_coverage = 0, crater_density = 0 }";

const SHORT: &str = "waypoints_m = [[0.6, 0]]\nframes_per_s = 3\nscans = false\nobstacles_every_frames = 3";

#[test]
fn on_flat_ground_stripes_are_where_trigonometry_has_them() {
    let job = job(FLAT, SHORT);
    // 4 pencils to a pixel over 2 tan(30) 8 mm / 72 um = 128.3 pixels.
    assert_eq!(job.plan.rig.beams.iter().map(|beam| beam.sensor.columns).collect::<Vec<_>>(), [514, 514]);
    assert!(job.warnings.is_empty() && job.notes.len() == 2, "{:?}", job.notes);
    let run = driven(&job, &["tracer"]);
    // 2 s at 3 frames a second, both ends included.
    assert_eq!((run.frames.len(), run.planned), (7, 7));
    assert!((run.driven() - 0.6).abs() < 1e-12);
    // Beam 0 is 1.8 m up and 31 degrees down at x = 0.3: its middle meets the ground at 0.3 + 1.8 / tan 31 = 3.296 m. A
    // ray of the camera, 0.3 m below, that looks down by a meets the sheet at d = 0.3 / (tan 31 - tan a): a row of pixels,
    // 9 mrad, is 0.4 m of d there, and the middle of the right one is 0.2 m off at most.
    let first: Vec<_> = run.points.iter().filter(|point| point.frame == 0 && point.beam == 0).collect();
    assert!(first.len() > 100, "{} points", first.len());
    let middle = first.iter().min_by(|a, b| a.point.y.abs().total_cmp(&b.point.y.abs())).unwrap();
    assert!((middle.point.x - 3.296).abs() < 0.2, "{middle:?}");
    // All on the ground: by 0.2 m times tan 31 and, of beam 1, by 0.3 m times tan 22.
    assert!(run.points.iter().all(|point| point.point.z.abs() < 0.2), "off the ground");
    // The map's last place is the vehicle's.
    assert!((run.believed.position - DVec3::new(0.6, 0.0, 0.0)).length() < 0.02, "{:?}", run.believed);
    // Between the wheels and the first stripe nobody has looked.
    let (frame, obstacles, vectors) = run.obstacles.as_ref().unwrap();
    assert_eq!((*frame, vectors.len()), (6, obstacles.sectors.len() - 1));
    assert!(obstacles.sectors.iter().all(|sector| sector.label == Label::Unknown));
    // Maps of frames 0, 3 and 6, each of 31 sectors of 44 points, all clear in truth.
    let truth = &run.truth;
    assert_eq!((truth.maps, truth.sectors, truth.past, truth.beyond), (3, 93, 0, 0));
    assert_eq!((truth.obstacle.points(), truth.clear.points()), (0, 4092));
    let screen = drive_screen(&job, &run, None);
    assert!(screen.contains("truth     of 0 obstacle points 0 % found, "), "{screen}");
    let json: serde_json::Value = serde_json::from_str(&drive_json(&job, &run)).unwrap();
    // It still stands on what the proximity sensor told of the start.
    assert!(json["largest_elevation_error_m"].as_f64().unwrap() < 1e-6);
    let clear = &json["truth"]["clear_points"];
    assert_eq!(clear["found_unknown"].as_u64().unwrap(), truth.clear.unknown);
}

/// A mesh of one material.
pub(super) fn mesh(vertices: &[DVec3], faces: Vec<[u32; 3]>) -> Arc<Mesh> {
    let materials = vec![Material { name: "ground".into(), reflectivity: 0.25 }];
    let of_faces = vec![0; faces.len()];
    Arc::new(Mesh::from_global(vertices, faces, of_faces, materials).unwrap())
}

/// A filter of 10 nm about the laser's 810.
const FILTER: &str = "filter = { centre_nm = 810, width_nm = 10, index = 2.0 }";

/// A sun that leaves the wide pixels of the small camera some room: 2 degrees high, behind.
const LOW_SUN: &str = "sun = { elevation_deg = 2, azimuth_deg = 180, optical_depth = 1 }";

fn filtered(drive: &str) -> DriveJob {
    let text = format!(
        "version = 1\n[camera]\nwidth_px = 128\nheight_px = 128\npixel_pitch_um = 72\n{FILTER}\n\
         [[beam]]\nrows = 4\ncolumns = 64\n[[beam]]\nrows = 4\ncolumns = 64\n{FLAT}\n[drive]\n{drive}\n"
    );
    DriveJob::new(&load_text(&text, "small").unwrap(), None, "small.toml".into()).unwrap()
}

#[test]
fn the_sun_hides_stripes_from_a_low_threshold_and_an_unlit_image_brings_them_back() {
    let dark = driven(&filtered(SHORT), &["tracer"]);
    let sunny = driven(&filtered(&format!("{SHORT}\n{LOW_SUN}")), &["tracer"]);
    let cleaned =
        driven(&filtered(&format!("{SHORT}\n{LOW_SUN}\nsubtract_unlit = true")), &["scanline", "tracer"]);
    let above = driven(&filtered(&format!("{SHORT}\n{LOW_SUN}\nthreshold_dn = 40000")), &["tracer"]);
    let dark_above = driven(&filtered(&format!("{SHORT}\nthreshold_dn = 40000")), &["tracer"]);
    // All of the ground is above 400 DN: its last lit row is that of the image, not of a stripe.
    assert_ne!(sunny.points, dark.points);
    // Numbers are whole: rounding moves a pixel at the very threshold.
    assert!(cleaned.passes(), "{:?}", cleaned.trace);
    let same = |a: &DriveRun, b: &DriveRun| {
        let hits = a.points.iter().filter(|point| b.points.contains(point)).count();
        hits as f64 / a.points.len().max(b.points.len()) as f64
    };
    assert!(same(&dark, &cleaned) > 0.95, "{}", same(&dark, &cleaned));
    // Behind a narrow filter the ground is some 5000 DN and the sky, of which ground throws back a quarter, some 20,000; a
    // stripe is more than both.
    // A pixel at the threshold is lit now that was not: an edge moves by a row, 0.4 m, at most.
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
fn ground_in_shadow_is_darker() {
    // The camera is at x = 0.3 m, 1.5 m up, and looks 20 degrees down; the sun is 10 degrees high behind it, a wall of 0.5 m
    // at x = 3 m: in its shadow, which ends at 3 + 0.5 / tan 10 = 5.84 m.
    let mut job = job(
        FLAT,
        &format!("{SHORT}\nsun = {{ elevation_deg = 10, azimuth_deg = 180, optical_depth = 0.1 }}"),
    );
    let p = DVec3::new;
    let ground = [p(-30.0, -30.0, 0.0), p(30.0, -30.0, 0.0), p(30.0, 30.0, 0.0), p(-30.0, 30.0, 0.0)];
    let wall = [p(3.0, -9.0, 0.0), p(3.0, 9.0, 0.0), p(3.0, 9.0, 0.5), p(3.0, -9.0, 0.5)];
    job.mesh = mesh(&[ground, wall].concat(), vec![[0, 1, 2], [0, 2, 3], [4, 6, 5], [4, 7, 6]]);
    let sun = Sun::of(&job).unwrap().unwrap();
    let place = Pose::IDENTITY;
    let scene =
        job.plan.rig.scene(Arc::clone(&job.mesh), place, job.plan.atmosphere, job.plan.flux_model).unwrap();
    let background = sun.background(&job, &scene);
    // x = 5 m is atan(1.5 / 4.7) = 17.7 degrees down: 4.5 rows of 72 um above the middle at 8 mm; x = 8 m 11 degrees, 17.6.
    let (shadow, lit) = (background.at(64, 59), background.at(64, 46));
    // Sky alone is 0.35 of sun and sky.
    assert!(shadow > 0.0 && (0.25..0.45).contains(&(shadow / lit)), "{shadow} and {lit}");
}

#[test]
fn too_few_pencils_are_warned_of() {
    let few = job(FLAT, &format!("{SHORT}\npencils_per_pixel = 1"));
    assert_eq!(few.warnings.len(), 2);
    assert!(few.warnings[0].contains("beam 0 has 1.01 pencils to a pixel"), "{:?}", few.warnings);
    // So is a threshold that knows nothing of the light.
    let warned = |more: &str| job(FLAT, &format!("{SHORT}\n{more}")).warnings;
    let sun = "sun = { elevation_deg = 45 }";
    assert!(warned(sun)[0].contains("is for the preset alone and knows nothing of a sun"));
    assert!(warned("electronics = { bias_dn = 9 }")[0].contains("other electronics"));
    assert_eq!(warned(&format!("{sun}\nsubtract_unlit = true")).len(), 1);
    for fine in ["threshold_dn = 3000", "detection = \"otsu\""] {
        assert!(warned(&format!("{sun}\n{fine}")).is_empty(), "{fine}");
    }
    // Columns that are enough stay as they are.
    let own = job(FLAT, &format!("{SHORT}\npencils_per_pixel = 0.3"));
    assert!(own.notes.is_empty() && own.plan.rig.beams[0].sensor.columns == 64);
}

#[test]
fn the_built_in_drives_are_the_papers() {
    let of = |name: &str| {
        let loaded = load(name, &Default::default()).unwrap();
        DriveJob::new(&loaded, None, name.into()).unwrap()
    };
    let pyramids = of("pyramids");
    assert_eq!((pyramids.plan.route.start, pyramids.plan.route.heading), (DVec2::new(-7.5, 0.0), 0.0));
    assert_eq!(pyramids.plan.route.waypoints, [DVec2::ZERO]);
    // 7.5 m, a frame each 0.1 m.
    assert_eq!(pyramids.frames().unwrap(), 76);
    assert_eq!(pyramids.plan.rig.beams[0].sensor.columns, 4106);
    assert!(pyramids.plan.scans.is_none());
    assert_eq!(of("facets").frames().unwrap(), 61);
}

#[test]
fn the_file_says_what_is_driven() {
    let all = "waypoints_m = [[1, 0], [1, 2]]\nspeed_m_per_s = 0.5\nturn_deg_per_s = 90\nframes_per_s = 5\nseed = 9\n\
        sensor = \"cmos\"\nsensor_seed = 4\nexposures = \"together\"\ndetection = \"gradient\"\nthreshold_dn = 30\n\
        place = \"sub_pixel\"\nleast_rows = 2\nmap_spacing_m = 0.2\nmap_points = 101\nobstacles_every_frames = 4\n\
        cross_gaps = true\nscans = true\nscan_every_m = 3\nscan_steps = 21\nwheelbase_m = 1.5\ntrack_m = 1.1\n\
        wheel_radius_m = 0.4\nwheel_width_m = 0.3\nclearance_m = 0.45\nposition_drift_m_per_s = [0.01, 0]\n\
        position_walk_m = 0.02\nheading_drift_deg_per_s = 1\nattitude_noise_deg = 2\nproximity_noise_m = 0.03\n\
        fix_every_frames = 50\nfix_noise_m = 0.1\nslope_front = 0.3\nslope_length = 0.25\ngrid_first_m = 0.9\n\
        grid_last_m = 4\ngrid_step_m = 0.2\ngrid_half_angle_deg = 45\ngrid_sectors = 19\nvector_large_m = 1\n\
        vector_small_m = 0.4\nscan_from_deg = -5\nscan_to_deg = 30\nscan_inconsistency_m = 0.2\n\
        scan_least_points = 40\nheading_bias_deg = 1\npitch_bias_deg = -2\nroll_bias_deg = 3";
    let job = job(FLAT, all);
    let plan = &job.plan;
    let route = &plan.route;
    assert_eq!((route.speed, route.frame_rate, route.waypoints.len()), (0.5, 5.0, 2));
    assert_eq!(route.turn_rate, 90.0_f64.to_radians());
    assert_eq!((job.preset, job.sensor.seed, job.sensor.bits), ("cmos", 4, 12));
    assert_eq!((plan.seed, plan.map.points, plan.map.spacing, plan.obstacles_every), (9, 101, 0.2, 4));
    assert_eq!(plan.exposures, raypencil_rover::ExposureMode::Together);
    assert_eq!(plan.extraction.detection, raypencil_rover::Detection::Gradient(30.0));
    assert_eq!(
        (plan.extraction.place, plan.extraction.least_rows),
        (raypencil_rover::StripeLocation::SubPixel, 2)
    );
    assert_eq!((plan.sweep.steps, plan.scans.unwrap().every), (21, Some(3.0)));
    assert_eq!((plan.vehicle.wheelbase, plan.vehicle.track, plan.vehicle.clearance), (1.5, 1.1, 0.45));
    // What follows from the vehicle's measures follows from these.
    let mut rules = TraversabilityRules::for_vehicle(&plan.vehicle).crossing_gaps(&plan.vehicle);
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
fn the_file_says_what_camera_it_is() {
    // Nothing said: the preset, but for its diffraction, which is that of this camera. Default: 8 mm / 2 mm.
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

    // All of it said.
    let all = format!(
        "{SHORT}\nsensor = \"ccd_1989\"\nsensor_seed = 3\n[drive.optics]\noversampling = 2\nfocus_m = 5\n\
         blurs = [{{ gaussian_um = 2 }}, {{ airy_rings = 3 }}, {{ gaussian_px = 0.5 }}]\n\
         dust = {{ transmission = 0.8, halo_share = 0.1, halo_px = 7 }}\n[drive.electronics]\nexposure_ms = 3\n\
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
    assert_eq!(own.optics, Optics { oversampling: 2, focus: Some(5.0), blurs, dust: Some(dust) });
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

    // A bias that the converter cannot give; a fine image of 8192 x 8192 pixels, each of 8 x 8 cells.
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
fn a_kernel_from_a_file_moves_the_stripe() {
    // All light two rows down, of pixels that are not divided: the image is that without a kernel, two rows lower.
    let folder = tempfile::tempdir().unwrap();
    let mut kernel = Image::filled(1, 5, 0.0);
    kernel.set(0, 4, 3.0);
    write_npy(folder.path().join("down.npy"), &[&kernel]).unwrap();
    let text = |optics: &str| {
        format!(
            "version = 1\n[camera]\nwidth_px = 128\nheight_px = 128\npixel_pitch_um = 72\n\
             [[beam]]\nrows = 4\ncolumns = 64\n{FLAT}\n[drive]\n{SHORT}\n{optics}"
        )
    };
    let path = folder.path().join("scene.toml");
    let edges = |optics: &str| {
        std::fs::write(&path, text(optics)).unwrap();
        let loaded = load(path.to_str().unwrap(), &Default::default()).unwrap();
        let job = DriveJob::new(&loaded, None, String::new()).unwrap();
        let renderer = Tracer::new();
        let mut drive = Drive::new(job.plan.clone(), job.mesh.clone()).unwrap();
        let eye = crate::eye::Eye::new(&renderer, &job, None);
        let frame =
            drive.step(&eye, &mut |_, light| CameraImage::Numbers(job.sensor.numbers(&light, None, 0)));
        let measured = frame.unwrap().unwrap().measured;
        (measured.iter().map(|one| (one.edge.i, one.edge.j)).collect::<Vec<_>>(), loaded.source_sha256)
    };
    let (plain, sha) = edges("");
    let (moved, other) = edges("[drive.optics]\nblurs = [{ kernel = \"down.npy\" }]");
    assert!(plain.len() > 100 && moved == plain.iter().map(|&(i, j)| (i, j + 2)).collect::<Vec<_>>());
    // Other numbers in the file are another scene.
    assert_ne!(sha, other);
    kernel.set(0, 4, 4.0);
    kernel.set(0, 0, 4.0);
    write_npy(folder.path().join("down.npy"), &[&kernel]).unwrap();
    assert_ne!(edges("[drive.optics]\nblurs = [{ kernel = \"down.npy\" }]").1, other);
}

#[test]
fn points_of_a_scan_are_drawn_where_the_camera_sees_them() {
    // 4 m along the axis of the camera as it is mounted, measured by one that looked elsewhere: the middle of the view.
    let job = job(FLAT, SHORT);
    let mount = job.plan.rig.camera.vehicle_from_sensor;
    let edge = EdgePoint { i: 3, j: 5, row: 5.5 };
    let measured = MeasuredPoint { step: Some(7), beam: 1, edge, point: mount * DVec3::new(1e-6, 1e-6, 4.0) };
    let behind = MeasuredPoint { point: mount * DVec3::new(0.0, 0.0, -1.0), ..measured };
    let blank = [9; 3];
    let view =
        View { width: 128, height: 128, pixels: vec![blank; 128 * 128], reduction: 1, camera: [128, 128] };
    let view = view.with_edges(&job.plan.rig, &[measured, behind]);
    let painted: Vec<usize> = (0..128 * 128).filter(|&index| view.pixels[index] != blank).collect();
    assert_eq!(painted, [64 * 128 + 64]);
}

#[test]
fn cameras_of_the_widest_pixels_have_figures() {
    // 512 pixels of 0.1 m: the views for figures have fewer, and none may be wider.
    let text = format!(
        "version = 1\n[camera]\nwidth_px = 512\nheight_px = 512\npixel_pitch_um = 100000\n\
         [[beam]]\nrows = 4\ncolumns = 64\n{FLAT}\n[drive]\nwaypoints_m = [[0.1, 0]]\nscans = false\n"
    );
    let job = DriveJob::new(&load_text(&text, "wide").unwrap(), None, String::new()).unwrap();
    assert!(driven(&job, &["tracer"]).passes());
}

#[test]
fn an_unlit_image_takes_the_bias_along() {
    let job = job(FLAT, &format!("{SHORT}\nsensor = \"cmos\"\nsubtract_unlit = true"));
    // 100 DN, of which 60 are bias.
    assert_eq!(job.plan.extraction.detection, raypencil_rover::Detection::Fixed(40.0));
    let mut light = Image::filled(9, 7, 0.0);
    light.set(4, 4, 2e-11);
    let background = Image::filled(9, 7, 1e-12);
    let pair = job.sensor.expose_pair(&light, Some(&background), 5);
    assert_eq!(job.digital(&light, Some(&background), 5), pair.difference);
}

#[test]
fn beams_out_of_order_are_warned_of() {
    let beams = |first: f64, second: f64| {
        let text = format!(
            "version = 1\n[[beam]]\npitch_down_deg = {first}\n[[beam]]\npitch_down_deg = {second}\n{FLAT}\n[drive]\n{SHORT}\n\
             exposures = \"together\"\n"
        );
        DriveJob::new(&load_text(&text, "beams").unwrap(), None, String::new()).unwrap().warnings
    };
    assert!(beams(31.0, 22.0).is_empty());
    assert!(beams(22.0, 31.0)[0].starts_with("beam 0 looks down no more than beam 1"));
}

#[test]
fn what_cannot_be_driven_is_refused() {
    let still = load_text(&format!("version = 1\n{FLAT}\n"), "still").unwrap();
    let error = DriveJob::new(&still, None, String::new()).unwrap_err();
    assert!(matches!(error, DriveError::NoDrive), "{error}");
    let mut unit = scene(FLAT, SHORT);
    unit.scene = Scene::new(
        unit.scene.mesh().clone(),
        *unit.scene.camera(),
        unit.scene.beams().to_vec(),
        unit.scene.atmosphere(),
        raypencil_scene::FluxModel::Eq1,
    )
    .unwrap();
    assert!(matches!(DriveJob::new(&unit, None, String::new()), Err(DriveError::Unit)));
    let endless = job(FLAT, "waypoints_m = [[1e9, 0]]\nscans = false");
    assert!(matches!(endless.frames(), Err(DriveError::Frames)));
}

#[test]
fn optics_and_noise_leave_the_stripes_where_they_are() {
    let clear = driven(&job(FLAT, SHORT), &["tracer"]);
    let drive = format!("{SHORT}\nsensor = \"cmos\"\n");
    let noisy = driven(&job(FLAT, &drive), &["tracer"]);
    // Blur of a fraction of a pixel does not move an edge by more than a row, 0.4 m; and towards it, since pixels of 72 um
    // gather 64 times the light, of which a low threshold sees the tail.
    let mean = |run: &DriveRun| {
        let near: Vec<f64> = run.points.iter().filter(|one| one.beam == 0).map(|one| one.point.x).collect();
        near.iter().sum::<f64>() / near.len() as f64
    };
    assert!((mean(&clear) - mean(&noisy)).abs() < 0.4, "{} and {}", mean(&clear), mean(&noisy));
    // The same seed is the same drive.
    let again = driven(&job(FLAT, &drive), &["tracer"]);
    assert_eq!(noisy.points, again.points);
}

/// A renderer that sees a little too much light in one frame.
struct Faulty(Tracer);

impl Renderer for Faulty {
    fn name(&self) -> &str {
        "faulty"
    }

    fn precision(&self) -> Precision {
        Precision::F64
    }

    fn render(&self, scene: &Scene, request: &Request) -> RenderOutput {
        let mut frame = self.0.render(scene, request);
        let camera_x = scene.camera().scene_from_sensor.position.x;
        // The third frame: 0.2 m on. Above the stripe, in row 77, light would be of something above the ground.
        if let Some(image) = frame.flux.first_mut().filter(|_| (camera_x - 0.5).abs() < 0.01) {
            image.set(40, 70, 1e-9);
        }
        frame
    }
}

#[test]
fn a_false_pixel_is_traced_to_the_map() {
    let job = job(FLAT, SHORT);
    let (good, bad) = (Tracer::new(), Faulty(Tracer::new()));
    let run = drive(&job, &[&good, &bad], &Silent).unwrap();
    assert!(!run.passes());
    let trace = run.trace.as_ref().unwrap();
    assert_eq!((trace.flux.differ, trace.flux.largest_relative), (1, 1.0));
    assert_eq!(trace.pixels.differ, 1);
    let first = trace.pixels.first.as_deref().unwrap();
    assert!(first.starts_with("frame 2, beam 0, pixel 40,70: 0 DN against "), "{first}");
    assert_eq!(trace.edges.differ, 1);
    let first = trace.edges.first.as_deref().unwrap();
    assert!(first.starts_with("frame 2, beam 0, column 40: row 70.5 on the second side only"), "{first}");
    // It stays on the map in all frames after: nine cells, but for those that are new data points.
    assert!(trace.cells.differ > 0 && trace.cells.first.as_deref().unwrap().starts_with("frame 2, cell at "));
    let screen = drive_screen(&job, &run, None);
    assert!(
        screen.contains("The two sides differ in 1 pixels of the digital images, 1 edge points, "),
        "{screen}"
    );
    let json: serde_json::Value = serde_json::from_str(&drive_json(&job, &run)).unwrap();
    assert_eq!((&json["passes"], &json["differences"]["pixels"]["differ"]), (&false.into(), &1.into()));
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 12, ..ProptestConfig::default() })]

    /// What scanline and tracer make of random ground reaches the map alike.
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
        let trace = run.trace.as_ref().expect("two sides");
        prop_assert!(run.passes(), "{trace:#?}");
        prop_assert!(trace.edges.compared > 100 && trace.labels.compared > 0);
    }
}

#[test]
fn the_folder_holds_everything_and_the_summary_comes_last() {
    let job = job(FLAT, SHORT);
    let run = driven(&job, &["scanline", "tracer"]);
    let folder = tempfile::tempdir().unwrap();
    let written = write_drive(&job, &run, folder.path(), &Silent).unwrap();
    let names: Vec<_> =
        written.files.iter().map(|file| file.file_name().unwrap().to_string_lossy().into_owned()).collect();
    assert_eq!(names.last().map(String::as_str), Some("summary.json"));
    for file in &written.files {
        assert!(file.is_file(), "{}", file.display());
    }
    // Nothing else, and nothing half written.
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), names.len());
    let page = std::fs::read_to_string(&written.report).unwrap();
    assert!(page.contains("Both sides are identical over 7 frames") && page.matches("<svg").count() == 4);
    assert!(!page.contains("src=\"http") && !page.contains("href=\"http"));
    // The map reads back as an elevation model of the same posts.
    let dem = read_dem(folder.path().join("local-map.tif"), None).unwrap();
    let posts = posts(&run.map);
    assert_eq!((dem.posts.columns, dem.posts.rows), (201, 201));
    assert!(dem.posts.heights.iter().zip(&posts.heights).all(|(a, b)| a.to_bits() == b.to_bits()));
    assert!((dem.posts.corner - posts.corner).length() < 1e-9);
    // The animation moves: as many pictures as frames.
    let bytes = std::fs::read(folder.path().join("drive.png")).unwrap();
    let reader = png::Decoder::new(std::io::Cursor::new(bytes)).read_info().unwrap();
    assert_eq!(reader.info().animation_control().map(|control| control.num_frames), Some(7));
}

#[test]
fn the_summary_keeps_to_its_schema() {
    let schema: serde_json::Value =
        serde_json::from_str(include_str!("../../../../docs/formats/drive.schema.json")).unwrap();
    assert_keys_are_closed(&schema);
    let sunny = format!("{SHORT}\n{LOW_SUN}\nsubtract_unlit = true");
    for (drive, names) in [(SHORT, &["tracer"][..]), (sunny.as_str(), &["scanline", "tracer"])] {
        let job = job(FLAT, drive);
        let summary = serde_json::from_str(&drive_json(&job, &driven(&job, names))).unwrap();
        assert_eq!(schema_faults(&schema, &summary), Vec::<String>::new());
    }
}

#[test]
fn a_wall_is_occupied_what_is_before_it_free_and_what_is_behind_it_unknown() {
    let mut map = ElevationMap::new(MapSize::default(), DVec2::ZERO);
    for point in map.points() {
        let z = if map.place(point).x > 2.95 { 1.0 } else { 0.0 };
        map.set_proximity(point, z);
    }
    let vehicle = Vehicle::default();
    let (rules, grid) = (TraversabilityRules::for_vehicle(&vehicle), RadialGrid::for_vehicle(&vehicle));
    let obstacles = ObstacleMap::extract(&map, &vehicle, &rules, &grid, &Pose::IDENTITY);
    let cells = occupancy(&map, &obstacles, &grid, &vehicle, &Pose::IDENTITY);
    // 201 cells of 0.1 m about the origin.
    assert_eq!((cells.columns, cells.resolution), (201, 0.1));
    assert!((cells.origin[0] + 10.05).abs() < 1e-12 && (cells.origin[1] + 10.05).abs() < 1e-12);
    let at =
        |x: f64, y: f64| cells.cells[(((y + 10.05) / 0.1) as usize) * 201 + ((x + 10.05) / 0.1) as usize];
    assert_eq!(at(0.0, 0.0), Occupancy::Free);
    assert_eq!(at(2.0, 0.0), Occupancy::Free);
    assert_eq!(at(3.0, 0.0), Occupancy::Occupied);
    assert_eq!(at(4.0, 0.0), Occupancy::Unknown);
    // Beside the fan of 30 degrees to either side, and behind.
    assert_eq!((at(2.0, 2.0), at(-3.0, 0.0)), (Occupancy::Unknown, Occupancy::Unknown));
    // A grid that begins at 2 m has tested nothing that is nearer.
    let far = RadialGrid { first: 2.0, ..grid };
    let obstacles = ObstacleMap::extract(&map, &vehicle, &rules, &far, &Pose::IDENTITY);
    let cells = occupancy(&map, &obstacles, &far, &vehicle, &Pose::IDENTITY);
    let at =
        |x: f64, y: f64| cells.cells[(((y + 10.05) / 0.1) as usize) * 201 + ((x + 10.05) / 0.1) as usize];
    assert_eq!((at(0.0, 0.0), at(1.5, 0.0)), (Occupancy::Free, Occupancy::Unknown));
    assert_eq!((at(2.5, 0.0), at(3.0, 0.0)), (Occupancy::Free, Occupancy::Occupied));
}
