//! Scenes from files and names, against values derived by hand.

use glam::DVec3;
use std::path::{Path, PathBuf};

use raypencil_scene::{Filter, FluxModel, Lens, Profile, SensorId};
use raypencil_scene_io::{LoadedScene, Overrides, SceneIoError, SceneSource, load};

use super::load_path;

pub(crate) fn scenes() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../data/scenes")
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
fn every_number_of_a_camera_has_its_field_and_its_unit() {
    // Numbers of which no two are alike: two that are exchanged show. 9 um are 9e-6 m, 8 mm are 8e-3 m, 810 nm are
    // 810e-9 m.
    let text = "version = 1\n[vehicle]\nposition_m = [0, 0, 5]\n\
        [camera]\nwidth_px = 640\nheight_px = 480\npixel_pitch_um = [9, 7]\nprincipal_point_px = [300, 250]\n\
        focal_length_mm = 8\naperture_mm = 4\ntransmission = 0.75\nmax_range_m = 30\n\
        filter = { centre_nm = 810, width_nm = 10, index = 1.5 }\n";
    let camera = load_text(text).unwrap().scene.camera().sensor;
    assert_eq!((camera.width, camera.height), (640, 480));
    assert_eq!((camera.pixel_pitch, camera.principal_point), ([9e-6, 7e-6], [300.0, 250.0]));
    assert_eq!((camera.focal_length, camera.aperture, camera.max_range), (8e-3, 4e-3, 30.0));
    let filter = Filter::Interference { centre: 810e-9, width: 10e-9, index: 1.5 };
    assert_eq!(camera.lens, Lens { transmission: 0.75, filter });
}

#[test]
fn every_number_of_a_beam_has_its_field_and_its_unit() {
    // A fan of 90 degrees is as wide to either side as its grid is far: w = 0.25 m tan(45 degrees).
    let text = "version = 1\n[vehicle]\nposition_m = [0, 0, 5]\n\
        [[beam]]\nfan_deg = 90\nthickness_mm = 4\ngrid_distance_mm = 250\ncolumns = 64\nrows = 8\npower_w = 0.5\n\
        wavelength_nm = 780\nprofile = \"gaussian\"\ngaussian_half_width_deg = 18\nmax_range_m = 15\n";
    let beam = load_text(text).unwrap().scene.beams()[0].sensor;
    assert!((beam.half_width - 0.25).abs() < 1e-15, "{}", beam.half_width);
    assert_eq!((beam.thickness, beam.grid_distance), (4e-3, 0.25));
    assert_eq!((beam.columns, beam.rows), (64, 8));
    assert_eq!((beam.power, beam.wavelength, beam.max_range), (0.5, 780e-9, 15.0));
    // 18 degrees are a tenth of pi.
    let Profile::Gaussian { half_width } = beam.profile else { panic!("{:?}", beam.profile) };
    assert!((half_width - 0.1 * std::f64::consts::PI).abs() < 1e-15, "{half_width}");
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
fn a_far_terrain_alone_gets_the_default_rig_at_its_own_centre() {
    // The ramp z = x / 4 around (0, 0), moved by (2000, 0, -3000) m in the axes of the file. There y is up, so that the
    // global frame has it at (2000, 3000, 0), and the scene has an origin of its own.
    let text = std::fs::read_to_string(scenes().join("ramp.gltf")).unwrap();
    let mut json: serde_json::Value = serde_json::from_str(&text).unwrap();
    json["nodes"] = serde_json::json!([{"mesh": 0, "translation": [2000, 0, -3000]}]);
    json["scenes"][0]["nodes"] = serde_json::json!([0]);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("far.gltf");
    std::fs::write(&path, json.to_string()).unwrap();
    let loaded = load_path(&path, &Overrides::default()).unwrap();
    assert_eq!(loaded.scene.mesh().origin(), DVec3::new(2000.0, 3000.0, 0.0));
    near(loaded.vehicle.position, DVec3::new(2000.0, 3000.0, 0.0), 1e-9);
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
    // Away from the origin, and beside a ramp of twice the size: its face 3 is the nearest then. The ground reaches from
    // x - 56 to x + 112, so that the centre is at x + 28. glTF has y up: the global y is its -z.
    for (x, y) in [(140.0, 200.0), (1e6, -2e6)] {
        let mut moved = json.clone();
        moved["nodes"] = serde_json::json!([
            {"mesh": 0, "translation": [x - 40.0, 0, -y]},
            {"mesh": 0, "translation": [x + 80.0, 0, -y], "scale": [2, 1, 2]}
        ]);
        std::fs::write(&path, moved.to_string()).unwrap();
        let loaded = load_path(&path, &Overrides::default()).unwrap();
        let expected = DVec3::new(x + 80.0 - 32.0 / 3.0, y + 32.0 / 3.0, -4.0 / 3.0);
        near(loaded.vehicle.position, expected, 1e-5);
    }
    // Both coordinates count: half a ramp at x = -58 m, and two ramps at x = 30 m, 200 m to either side. The centre is at
    // (-10, 0). Where the near one is so steep that no vehicle can stand on it, a face of a far one is the nearest.
    for (height, expected) in [
        (1.0, DVec3::new(-58.0 + 8.0 / 3.0, -8.0 / 3.0, 4.0 / 3.0)),
        (5.0, DVec3::new(30.0 - 16.0 / 3.0, -200.0 + 16.0 / 3.0, -4.0 / 3.0)),
    ] {
        let mut three = json.clone();
        three["nodes"] = serde_json::json!([
            {"mesh": 0, "translation": [-58, 0, 0], "scale": [0.5, height, 0.5]},
            {"mesh": 0, "translation": [30, 0, -200]},
            {"mesh": 0, "translation": [30, 0, 200]}
        ]);
        three["scenes"][0]["nodes"] = serde_json::json!([0, 1, 2]);
        std::fs::write(&path, three.to_string()).unwrap();
        near(load_path(&path, &Overrides::default()).unwrap().vehicle.position, expected, 1e-5);
    }
    // Turned over, it has no face on which a vehicle can stand.
    json["nodes"][0]["scale"] = serde_json::json!([1, -1, -1]);
    json["scenes"][0]["nodes"] = serde_json::json!([0]);
    std::fs::write(&path, json.to_string()).unwrap();
    let message = load_path(&path, &Overrides::default()).unwrap_err().to_string();
    assert!(message.contains("two.gltf: no ground under the vehicle"), "{message}");
    assert!(
        message.ends_with(
            "expected a place within x -56.000 to -24.000, y -16.000 to 16.000 m, and faces whose fronts are up (here \
             none is: are corners clockwise seen from above?)"
        ),
        "{message}"
    );
    json["nodes"][0]["translation"] = serde_json::json!([1e6, 0, -2e6]);
    std::fs::write(&path, json.to_string()).unwrap();
    let message = load_path(&path, &Overrides::default()).unwrap_err().to_string();
    let expected = "x 999984.000 to 1000016.000, y 1999984.000 to 2000016.000 m";
    assert!(message.contains(expected), "{message}");
}

#[test]
fn a_scene_has_a_standing_vehicle_and_a_digest_of_its_numbers() {
    let plain = load("pyramids", &Overrides::default()).unwrap();
    assert_eq!(plain.standing_vehicle(), Some(plain.vehicle));
    // What defines a built-in scene is its numbers: other numbers are another source.
    let wide = load("pyramids", &Overrides { fan_deg: Some(90.0), ..Overrides::default() }).unwrap();
    assert_ne!(wide.source_sha256, plain.source_sha256);
    assert_eq!(load("pyramids", &Overrides::default()).unwrap().source_sha256, plain.source_sha256);
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
        ..Overrides::default()
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
        message.contains("pyramids, facets")
            && message.contains(".toml, .glb, .gltf, .stl, .obj, .ply, .tif or .tiff"),
        "{message}"
    );
    assert!(refuse("nowhere/mars.glb").starts_with("`nowhere/mars.glb` does not exist"));
    let folder = tempfile::tempdir().unwrap();
    assert!(refuse(folder.path().to_str().unwrap()).contains("is a folder"));
    let other = folder.path().join("mars.off");
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

#[test]
fn the_template_is_the_documented_default_scene() {
    let written = std::fs::read_to_string(scenes().join("default.toml")).unwrap();
    assert_eq!(raypencil_scene_io::SCENE_TEMPLATE, written);
}

#[test]
fn a_ground_that_lies_on_its_side_is_told_from_one_that_is_turned_over() {
    let folder = tempfile::tempdir().unwrap();
    // A square of 20 x 20 m whose y is up in its file: it faces along y.
    let path = folder.path().join("side.obj");
    let vertices = "v -10 0 -10\nv 10 0 -10\nv 10 0 10\nv -10 0 10\n";
    std::fs::write(&path, format!("{vertices}f 1 3 2\nf 1 4 3\n")).unwrap();
    let message = load_path(&path, &Overrides::default()).unwrap_err().to_string();
    assert!(message.ends_with("(here none is: does its file have y up? Then set terrain.up=y)"), "{message}");
    let settings = vec![raypencil_scene_io::Setting::parse("terrain.up=y").unwrap()];
    let up = Overrides { settings, ..Overrides::default() };
    assert!(load_path(&path, &up).is_ok());
}
