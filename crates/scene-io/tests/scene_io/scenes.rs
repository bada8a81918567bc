//! Scenes from files and names, against values derived by hand.

use glam::DVec3;
use std::path::{Path, PathBuf};

use raypencil_scene::{FluxModel, Profile, SensorId};
use raypencil_scene_io::{LoadedScene, Overrides, SceneIoError, SceneSource, load};

use crate::load_path;

fn scenes() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../data/scenes")
}

fn load_text(text: &str) -> Result<LoadedScene, SceneIoError> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.toml");
    std::fs::write(&path, text).unwrap();
    load_path(&path, &Overrides::default())
}

fn near(a: DVec3, b: DVec3, tolerance: f64) {
    assert!((a - b).length() <= tolerance, "{a} is not {b}");
}

#[test]
fn the_written_out_defaults_are_the_defaults() {
    let written = load_path(&scenes().join("default.toml"), &Overrides::default()).unwrap();
    let named = load("pyramids", &Overrides::default()).unwrap();
    assert_eq!(written.scene, named.scene);
    assert_eq!(written.scene_sha256, named.scene_sha256);
    assert_eq!((written.name.as_str(), named.name.as_str()), ("default", "pyramids"));
    let least = load_text("version = 1\n").unwrap();
    assert_eq!(least.scene, named.scene);
    // A table may be empty.
    let empty =
        load_text("version = 1\n[vehicle]\n[camera]\n[[beam]]\n[[beam]]\n[atmosphere]\n[flux]\n").unwrap();
    assert_eq!(empty.scene, named.scene);
}

#[test]
fn default_numbers_are_the_doubles_nearest_their_decimals() {
    let loaded = load("pyramids", &Overrides::default()).unwrap();
    let camera = loaded.scene.camera().sensor;
    assert_eq!(camera.pixel_pitch, [9e-6, 9e-6]);
    assert_eq!((camera.focal_length, camera.aperture, camera.max_range), (8e-3, 2e-3, 20.0));
    assert_eq!(camera.principal_point, [512.0, 512.0]);
    let [upper, _] = loaded.scene.beams() else { panic!("two beams") };
    let beam = upper.sensor;
    assert_eq!((beam.thickness, beam.grid_distance, beam.wavelength), (5e-3, 0.1, 810e-9));
    // w = 0.1 tan(30 degrees) = 0.1 / sqrt(3).
    assert!((beam.half_width - 0.1 / 3.0_f64.sqrt()).abs() < 1e-16);
    assert_eq!((beam.columns, beam.rows, beam.power), (1024, 16, 1.0));
}

#[test]
fn sensors_look_where_their_angles_say() {
    let text = "version = 1\n[vehicle]\nposition_m = [1, 2, 3]\nheading_deg = 90\n\
        [camera]\nposition_m = [0.5, 0.25, 1]\npitch_down_deg = 30\n\
        [[beam]]\npitch_down_deg = 0\nyaw_left_deg = 30\n\
        [[beam]]\nposition_m = [0, 0, 0]\npitch_down_deg = 0\nroll_right_deg = 90\n";
    let scene = load_text(text).unwrap().scene;
    // Heading 90 degrees: vehicle x is global y, vehicle y (left) is global -x.
    let camera = scene.camera().scene_from_sensor;
    near(camera.position, DVec3::new(1.0 - 0.25, 2.0 + 0.5, 4.0), 1e-15);
    // 30 degrees down: (cos 30, -sin 30) in the vertical plane of the heading.
    let (cos, sin) = (0.75_f64.sqrt(), 0.5);
    near(camera.rotate(DVec3::Z), DVec3::new(0.0, cos, -sin), 1e-15);
    // x of the image is to the right (global +x), y down.
    near(camera.rotate(DVec3::X), DVec3::X, 1e-15);
    near(camera.rotate(DVec3::Y), DVec3::new(0.0, -sin, -cos), 1e-15);
    // 30 degrees to the left of the heading, level.
    near(scene.beams()[0].scene_from_sensor.rotate(DVec3::Z), DVec3::new(-sin, cos, 0.0), 1e-15);
    // Rolled to the right by 90 degrees: the fan, which lay along -left = right, points down; the sheet's
    // normal y, which was down, points left (global -x).
    let rolled = scene.beams()[1].scene_from_sensor;
    near(rolled.rotate(DVec3::Z), DVec3::Y, 1e-15);
    near(rolled.rotate(DVec3::X), -DVec3::Z, 1e-15);
    near(rolled.rotate(DVec3::Y), -DVec3::X, 1e-15);
}

#[test]
fn turns_are_yaw_then_pitch_then_roll() {
    let text = "version = 1\n[vehicle]\nposition_m = [0, 0, 5]\npitch_down_deg = 30\nroll_right_deg = 90\n\
        [camera]\nposition_m = [1, 2, 4]\npitch_down_deg = 0\n";
    let loaded = load_text(text).unwrap();
    // First pitch: x is (cos, 0, -sin), z is (sin, 0, cos), y is itself. Then the roll by 90 degrees about
    // the new x takes y to the pitched z and z to -y.
    let (cos, sin) = (0.75_f64.sqrt(), 0.5);
    near(loaded.vehicle.rotate(DVec3::X), DVec3::new(cos, 0.0, -sin), 1e-15);
    near(loaded.vehicle.rotate(DVec3::Y), DVec3::new(sin, 0.0, cos), 1e-15);
    near(loaded.vehicle.rotate(DVec3::Z), -DVec3::Y, 1e-15);
    let expected = DVec3::new(cos + 2.0 * sin, -4.0, 5.0 - sin + 2.0 * cos);
    near(loaded.scene.camera().scene_from_sensor.position, expected, 4e-15);
}

#[test]
fn a_ramp_from_a_file_beside_the_scene() {
    let loaded = load_path(&scenes().join("ramp.toml"), &Overrides::default()).unwrap();
    // z = x / 4 at x = 4.
    near(loaded.vehicle.position, DVec3::new(4.0, 2.0, 1.0), 1e-12);
    // The vehicle's up is the slope's normal (-1, 0, 4) / sqrt(17).
    near(loaded.vehicle.rotate(DVec3::Z), DVec3::new(-1.0, 0.0, 4.0) / 17.0_f64.sqrt(), 1e-15);
    let mesh = loaded.scene.mesh();
    assert_eq!(mesh.faces(), [[0, 1, 2], [0, 2, 3]]);
    assert_eq!(
        mesh.vertices(),
        [[-16.0, -16.0, -4.0], [16.0, -16.0, 4.0], [16.0, 16.0, 4.0], [-16.0, 16.0, -4.0]]
    );
    // The file's own reflectivity wins.
    assert_eq!((mesh.materials()[0].name.as_str(), mesh.materials()[0].reflectivity), ("sand", 0.3));
    let [beam] = loaded.scene.beams() else { panic!("one beam") };
    assert_eq!((beam.sensor.columns, beam.sensor.rows), (256, 4));
    assert_eq!(beam.sensor.profile, Profile::Gaussian { half_width: 25.0_f64.to_radians() });
}

#[test]
fn far_ground_keeps_its_precision() {
    let loaded = load_path(&scenes().join("random.toml"), &Overrides::default()).unwrap();
    let scene = &loaded.scene;
    assert_eq!(scene.flux_model(), FluxModel::Eq1);
    let origin = scene.mesh().origin();
    near(origin, DVec3::new(1e6, -2e6, 100.0), 20.0);
    // The sensors' offsets from the vehicle are those of the default rig to 1e-14 m: nothing was added to a coordinate
    // of 1e6 m, whose spacing of doubles is 1e-10 m.
    let vehicle = loaded.vehicle.position - origin;
    let camera = scene.camera().scene_from_sensor.position;
    near(camera - vehicle, DVec3::new(0.3, 0.0, 1.5), 1e-14);
    // The vehicle stands on the same mesh.
    let z = raypencil_terrain::height_at(scene.mesh(), 1_000_003.0, -1_999_998.0).unwrap();
    assert_eq!(loaded.vehicle.position.z, z);
}

#[test]
fn a_reflectivity_is_for_materials_without_their_own() {
    let ground = |terrain: &str| {
        let text = format!("version = 1\n[terrain]\n{terrain}\n");
        load_text(&text).unwrap().scene.mesh().materials().to_vec()
    };
    assert_eq!(ground("builtin = \"facets\"\nreflectivity = 0.5")[0].reflectivity, 0.5);
    let generated = ground("generate = { kind = \"nasty\", faces = 500 }\nreflectivity = 0.5");
    assert!(generated.iter().all(|kind| kind.reflectivity == 0.5) && generated.len() > 1);
    let own = ground("generate = { kind = \"nasty\", faces = 500 }");
    assert!(own.iter().any(|kind| kind.reflectivity != own[0].reflectivity));
    assert_eq!(ground("generate = { faces = 500 }").len(), 1);
    let mars = "generate = { preset = \"worst\", extent_m = 8, post_spacing_m = 0.5, crevasses = 0 }";
    let names: Vec<String> = ground(mars).into_iter().map(|kind| kind.name).collect();
    assert_eq!(names, ["soil", "rock", "crevasse wall"]);
    assert!(ground(&format!("{mars}\nreflectivity = 0.5")).iter().all(|kind| kind.reflectivity == 0.5));
}

#[test]
fn a_terrain_alone_gets_the_default_rig_at_its_centre() {
    let loaded = load_path(&scenes().join("ramp.gltf"), &Overrides::default()).unwrap();
    near(loaded.vehicle.position, DVec3::ZERO, 1e-12);
    assert_eq!(loaded.name, "ramp");
    let named = load("pyramids", &Overrides::default()).unwrap();
    assert_eq!(loaded.scene.camera().sensor, named.scene.camera().sensor);
    assert_eq!(loaded.scene.beams().len(), 2);
    // `sha256sum ramp.gltf`.
    let bytes = std::fs::read(scenes().join("ramp.gltf")).unwrap();
    use sha2::Digest;
    let sum: String = sha2::Sha256::digest(&bytes).iter().map(|byte| format!("{byte:02x}")).collect();
    assert_eq!(loaded.source_sha256, sum);
}

#[test]
fn around_a_hole_the_vehicle_stands_on_the_nearest_face_that_looks_up() {
    // Two ramps, 40 m to either side of the centre, which has no ground. The nearest middles of faces are
    // ((-56 - 24 - 24) / 3, -16 / 3) = (-104 / 3, -16 / 3) of face 0 and its mirror image of face 3. They are equally
    // near: the first face wins. There z = (x + 40) / 4 = 4 / 3.
    let text = std::fs::read_to_string(scenes().join("ramp.gltf")).unwrap();
    let mut json: serde_json::Value = serde_json::from_str(&text).unwrap();
    json["nodes"] =
        serde_json::json!([{"mesh": 0, "translation": [-40, 0, 0]}, {"mesh": 0, "translation": [40, 0, 0]}]);
    json["scenes"][0]["nodes"] = serde_json::json!([0, 1]);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("two.gltf");
    std::fs::write(&path, json.to_string()).unwrap();
    let loaded = load_path(&path, &Overrides::default()).unwrap();
    near(loaded.vehicle.position, DVec3::new(-104.0 / 3.0, -16.0 / 3.0, 4.0 / 3.0), 1e-5);
    // Turned over, it has no face on which a vehicle can stand.
    json["nodes"][0]["scale"] = serde_json::json!([1, -1, -1]);
    json["scenes"][0]["nodes"] = serde_json::json!([0]);
    std::fs::write(&path, json.to_string()).unwrap();
    let message = load_path(&path, &Overrides::default()).unwrap_err().to_string();
    assert!(message.contains("two.gltf: no ground under the vehicle"), "{message}");
    assert!(
        message.ends_with("expected a place within x -56.000 to -24.000, y -16.000 to 16.000 m"),
        "{message}"
    );
}

#[test]
fn the_documented_example_is_the_file() {
    let docs = std::fs::read_to_string(scenes().join("../../docs/guide/scene.md")).unwrap();
    let text = std::fs::read_to_string(scenes().join("default.toml")).unwrap();
    let (_, body) = text.split_once("version = 1\n").unwrap();
    assert!(docs.ends_with(&format!("```toml\nversion = 1\n{body}```\n")));
}

#[test]
fn overrides_change_the_scene_and_its_digests() {
    let path = scenes().join("ramp.toml");
    let plain = load_path(&path, &Overrides::default()).unwrap();
    let moved = Overrides {
        at: Some([-8.0, 0.5]),
        heading_deg: Some(180.0),
        fan_deg: Some(90.0),
        thickness_mm: Some(80.0),
        flux_model: Some(FluxModel::Eq1),
    };
    let moved = load_path(&path, &moved).unwrap();
    near(moved.vehicle.position, DVec3::new(-8.0, 0.5, -2.0), 1e-12);
    assert!((moved.scene.beams()[0].sensor.half_width - 0.1).abs() < 1e-15);
    assert_ne!(plain.source_sha256, moved.source_sha256);
    assert_ne!(plain.scene_sha256, moved.scene_sha256);
    let again = load_path(&path, &Overrides::default()).unwrap();
    assert_eq!((plain.source_sha256, plain.scene_sha256), (again.source_sha256, again.scene_sha256));
}

#[test]
fn overrides_out_of_range_are_named() {
    let refuse = |overrides| load("pyramids", &overrides).unwrap_err().to_string();
    let message = refuse(Overrides { thickness_mm: Some(0.0), ..Overrides::default() });
    assert!(message.contains("thickness") && message.contains("0.001 to 100000 millimetres"), "{message}");
    let message = refuse(Overrides { fan_deg: Some(180.0), ..Overrides::default() });
    assert_eq!(message, "override fan is 180; expected 0.001 to 179.9 degrees");
    let message = refuse(Overrides { at: Some([0.0, f64::NAN]), ..Overrides::default() });
    assert!(message.starts_with("override at y is NaN"), "{message}");
    let message = refuse(Overrides { heading_deg: Some(f64::INFINITY), ..Overrides::default() });
    assert!(message.starts_with("override heading is inf"), "{message}");
    let message = refuse(Overrides { at: Some([1e6, 0.0]), ..Overrides::default() });
    assert!(message.starts_with("pyramids: no ground under the vehicle at (1000000, 0) m"), "{message}");
    assert!(message.contains("expected a place within x "), "{message}");
}

#[test]
fn an_unknown_source_lists_the_known_ones() {
    let refuse = |source: &str| load(source, &Overrides::default()).unwrap_err().to_string();
    let message = refuse("pyramid");
    assert!(message.starts_with("`pyramid` is neither a built-in name nor a file; expected"), "{message}");
    assert!(
        message.contains("pyramids, facets") && message.contains(".toml, .glb, .gltf, .tif or .tiff"),
        "{message}"
    );
    assert!(refuse("nowhere/mars.glb").starts_with("`nowhere/mars.glb` does not exist"));
    let folder = tempfile::tempdir().unwrap();
    assert!(refuse(folder.path().to_str().unwrap()).contains("is a folder"));
    let other = folder.path().join("mars.obj");
    std::fs::write(&other, "v 0 0 0").unwrap();
    assert!(refuse(other.to_str().unwrap()).contains("is a file of an unknown kind"));
    assert_eq!(SceneSource::parse("facets").unwrap(), SceneSource::Builtin("facets".into()));
}

#[test]
fn every_limit_of_every_key_is_within_the_limits_of_the_scene() {
    // The smallest and the largest value of each key, as docs/guide/scene.md gives them.
    let least = "version = 1\n[vehicle]\nposition_m = [0, 0]\nheading_deg = -360\n\
        [camera]\nposition_m = [-1000, -1000, -1000]\npitch_down_deg = -360\nwidth_px = 1\nheight_px = 1\n\
        pixel_pitch_um = 0.01\nfocal_length_mm = 0.01\naperture_mm = 0.001\nmax_range_m = 0.001\n\
        principal_point_px = [-1e6, -1e6]\n\
        [[beam]]\nfan_deg = 0.001\nthickness_mm = 0.001\ngrid_distance_mm = 0.1\ncolumns = 1\nrows = 1\n\
        power_w = 0\nwavelength_nm = 10\nprofile = \"gaussian\"\ngaussian_half_width_deg = 0.001\n\
        max_range_m = 0.001\n[terrain]\nbuiltin = \"facets\"\nreflectivity = 0\n\
        [atmosphere]\nattenuation_per_m = 0\n";
    load_text(least).unwrap();
    let most = "version = 1\n[vehicle]\nposition_m = [0, 0]\nheading_deg = 360\n\
        [camera]\nposition_m = [1000, 1000, 1000]\npitch_down_deg = 360\nwidth_px = 1048576\nheight_px = 64\n\
        pixel_pitch_um = [1e5, 1e5]\nfocal_length_mm = 1e5\naperture_mm = 1e4\nmax_range_m = 1e7\n\
        principal_point_px = [1e6, 1e6]\n\
        [[beam]]\nfan_deg = 179.9\nthickness_mm = 1e5\ngrid_distance_mm = 1e5\ncolumns = 64\nrows = 1048576\n\
        power_w = 1e6\nwavelength_nm = 1e6\nprofile = \"gaussian\"\ngaussian_half_width_deg = 1e4\n\
        max_range_m = 1e7\n[terrain]\nbuiltin = \"facets\"\nreflectivity = 1\n\
        [atmosphere]\nattenuation_per_m = 1000\n";
    let scene = load_text(most).unwrap().scene;
    assert_eq!(scene.size(SensorId::Beam(0)), Some((64, 1_048_576)));
}

/// The mesh of MarsYard 2021 is not part of the project: the test needs RAYPENCIL_EXTRA_DATA, the folder with it.
#[test]
fn a_mesh_of_a_real_yard_is_a_scene_of_its_name() {
    let path = std::env::var_os("RAYPENCIL_EXTRA_DATA")
        .map(|folder| Path::new(&folder).join("marsyard2021.glb"))
        .filter(|path| path.exists());
    let Some(path) = path else {
        eprintln!("skipped: RAYPENCIL_EXTRA_DATA names no folder with marsyard2021.glb");
        return;
    };
    assert_eq!(load(path.to_str().unwrap(), &Overrides::default()).unwrap().name, "marsyard2021");
}
