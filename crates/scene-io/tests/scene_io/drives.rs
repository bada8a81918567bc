//! Drives of scene files: defaults that depend on other keys, and what follows from the resolved scene.

use glam::DVec2;

use raypencil_rover::{Detection, RadialGrid, TraversabilityRules, Vehicle};
use raypencil_scene_io::{DriveSetup, LoadedScene, default_threshold, load_text};
use raypencil_sensor::{Psf, preset};

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
    assert_eq!((plan.route.start, plan.route.waypoints[0]), (DVec2::new(1.0, 2.0), DVec2::new(4.0, 5.0)));
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
    let plan = drive("wheelbase_m = 2\ncross_gaps = true\ngrid_sectors = 7\nslope_rear = 0.5").plan;
    let vehicle = Vehicle { wheelbase: 2.0, ..Vehicle::default() };
    assert_eq!(plan.vehicle, vehicle);
    let mut rules = TraversabilityRules::for_vehicle(&vehicle).crossing_gaps(&vehicle);
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
