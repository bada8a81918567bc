//! Resolved scenes: they come back bit for bit, and errors are marked.

use glam::{DQuat, DVec3};
use proptest::prelude::*;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use raypencil_scene::{
    Atmosphere, Beam, Camera, Filter, FluxModel, Lens, Material, Mesh, Mounted, Pose, Profile, Scene,
};
use raypencil_scene_io::{Overrides, SceneIoError, TomlProblem, load, scene_sha256, write_resolved};

use super::load_path;

/// A folder with the resolved scene of a built-in ground.
fn written() -> (tempfile::TempDir, PathBuf, Scene) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.toml");
    let scene = load("facets", &Overrides::default()).unwrap().scene;
    write_resolved(&path, &scene, "terrain.glb").unwrap();
    (folder, path, scene)
}

#[test]
fn a_built_in_scene_comes_back() {
    let (folder, path, scene) = written();
    let back = load_path(&path, &Overrides::default()).unwrap();
    assert_eq!(back.scene, scene);
    assert_eq!(back.scene_sha256, scene_sha256(&scene));
    assert_eq!(back.vehicle, Pose::from_position(scene.mesh().origin()));
    // Written again, it gives the same two files.
    let second = folder.path().join("again.toml");
    write_resolved(&second, &back.scene, "again.glb").unwrap();
    let text = |path: &Path| std::fs::read_to_string(path).unwrap();
    assert_eq!(text(&second).replace("again.glb", "terrain.glb"), text(&path));
    assert_eq!(
        std::fs::read(folder.path().join("again.glb")).unwrap(),
        std::fs::read(folder.path().join("terrain.glb")).unwrap()
    );
}

#[test]
fn the_ground_takes_part_in_the_source_digest() {
    let (folder, path, _) = written();
    let first = load_path(&path, &Overrides::default()).unwrap().source_sha256;
    // The name of the program that wrote it, which readers ignore.
    let ground = folder.path().join("terrain.glb");
    let mut bytes = std::fs::read(&ground).unwrap();
    let name = bytes.windows(9).position(|word| word == b"raypencil").unwrap();
    bytes[name] = b'R';
    std::fs::write(&ground, bytes).unwrap();
    assert_ne!(load_path(&path, &Overrides::default()).unwrap().source_sha256, first);
}

#[test]
fn overrides_of_light_apply_and_those_of_a_vehicle_do_not() {
    let (_folder, path, scene) = written();
    let overrides = Overrides {
        fan_deg: Some(90.0),
        thickness_mm: Some(80.0),
        flux_model: Some(FluxModel::Eq1),
        ..Overrides::default()
    };
    let changed = load_path(&path, &overrides).unwrap();
    // w = 0.1 m tan(45 degrees); the double of tan may be one ulp off 1.
    for beam in changed.scene.beams() {
        assert!((beam.sensor.half_width - 0.1).abs() < 1e-15);
        assert_eq!(beam.sensor.thickness, 0.08);
    }
    assert_eq!(changed.scene.flux_model(), FluxModel::Eq1);
    assert_eq!(changed.scene.camera(), scene.camera());
    let plain = load_path(&path, &Overrides::default()).unwrap();
    assert_ne!(changed.source_sha256, plain.source_sha256);
    let refused = |overrides| load_path(&path, &overrides).unwrap_err().to_string();
    let why = "expected none: a resolved scene has no vehicle to place, only sensors";
    assert_eq!(
        refused(Overrides { at: Some([1.0, -2.5]), ..Overrides::default() }),
        format!("override at is 1,-2.5; {why}")
    );
    assert_eq!(
        refused(Overrides { heading_deg: Some(45.0), ..Overrides::default() }),
        format!("override heading is 45; {why}")
    );
}

/// Problem of the written text with `to` in place of `from`.
fn problem(from: &str, to: &str) -> TomlProblem {
    let (_folder, path, _) = written();
    let text = std::fs::read_to_string(&path).unwrap();
    assert!(text.contains(from), "{from}");
    std::fs::write(&path, text.replacen(from, to, 1)).unwrap();
    match load_path(&path, &Overrides::default()).unwrap_err() {
        SceneIoError::Toml(problem) => *problem,
        other => panic!("not a problem of a line: {other}"),
    }
}

#[test]
fn every_key_is_required_but_two() {
    let (_folder, path, _) = written();
    let text = std::fs::read_to_string(&path).unwrap();
    let keys = text.lines().filter(|line| line.contains(" = ") && !line.starts_with('#'));
    let mut checked = 0;
    for line in keys.filter(|line| !line.starts_with("version") && !line.starts_with("kind")) {
        let key = line.split_once(' ').unwrap().0;
        let problem = problem(&format!("{line}\n"), "");
        assert_eq!(problem.message, format!("the key `{key}` is missing"), "{line}");
        // The table without the key is marked.
        assert!(problem.line > 3 && !problem.marked().is_empty(), "{line}: {problem}");
        checked += 1;
    }
    // Nine keys of the camera, ten of each of the two beams, two of the ground, one of the air, one of the flux.
    assert_eq!(checked, 9 + 2 * 10 + 2 + 1 + 1);
    assert_eq!(problem("[flux]\nmodel = \"radiometric\"\n", "").message, "the key `flux` is missing");
    let pose = problem("position_m = ", "position = ");
    assert!(pose.message.starts_with("unknown key `position`"), "{pose}");
    assert_eq!(pose.marked(), "position");
}

#[test]
fn wrong_keys_and_values_are_marked() {
    let cases = [
        (
            "width_px = ",
            "widht_px = 3\nwidth_px = ",
            "widht_px",
            "unknown key `widht_px`; did you mean `width_px`, in pixels?",
        ),
        ("[flux]", "[vehicle]\n[flux]", "vehicle", "unknown key `vehicle`"),
        (
            "kind = \"resolved\"",
            "kind = \"baked\"",
            "\"baked\"",
            "`kind` is \"baked\"; expected \"resolved\"",
        ),
        ("kind = \"resolved\"", "kind = 7", "7", "`kind` is 7; expected \"resolved\""),
        ("width_px = 1024", "width_px = -5", "-5", "`camera.width_px` is -5; expected 1 to 1048576"),
        ("height_px = 1024", "height_px = 0", "0", "`camera.height_px` is 0; expected 1 to 1048576"),
        (
            "focal_length_m = 0.008",
            "focal_length_m = nan",
            "nan",
            "`camera.focal_length_m` is NaN; expected 0.00001 to 100 m",
        ),
        (
            "half_width_m = ",
            "half_width_m = inf #",
            "inf",
            "`beam 0.half_width_m` is inf; expected 0.0000001 to ",
        ),
        ("transmission = 1.0", "transmission = 1.5", "1.5", "`camera.transmission` is 1.5; expected 0 to 1"),
        (
            "max_range_m = 20.0",
            "filter = { centre_m = 8e-7, width_m = 1e-8, index = 0.5 }\nmax_range_m = 20.0",
            "0.5",
            "`camera.filter.index` is 0.5; expected 1 to 10",
        ),
        (
            "profile = \"paper\"",
            "profile = \"flat\"",
            "\"flat\"",
            "`beam 0.profile` is \"flat\"; expected one of",
        ),
        (
            "profile = \"paper\"",
            "profile = \"gaussian\"",
            "\"gaussian\"",
            "`beam 0.profile` is \"gaussian\" without a width; expected `gaussian_half_width_rad` too",
        ),
        (
            "profile = \"paper\"",
            "profile = \"gaussian\"\ngaussian_half_width_rad = -1",
            "-1",
            "`beam 0.gaussian_half_width_rad` is -1; expected 0.000001 to 1000 rad",
        ),
        (
            "attenuation_per_m = 0.0",
            "attenuation_per_m = -1",
            "-1",
            "`atmosphere.attenuation_per_m` is -1; expected 0 to 1000 1/m",
        ),
        ("model = \"radiometric\"", "model = \"lux\"", "\"lux\"", "`flux.model` is \"lux\"; expected one of"),
        (
            "file = \"terrain.glb\"",
            "file = \"ground.obj\"",
            "\"ground.obj\"",
            "`terrain.file` is \"ground.obj\"",
        ),
        ("file = \"terrain.glb\"", "file = \"no.glb\"", "\"no.glb\"", "`terrain.file`: there is no file"),
        (
            "origin_m = [0.0, 0.0, 0.0]",
            "origin_m = [0, inf, 0]",
            "[0, inf, 0]",
            "`terrain.origin_m` is inf; expected -1e12 to 1e12 metres",
        ),
        ("origin_m = [0.0, 0.0, 0.0]", "origin_m = [0, 0]", "[0, 0]", "a list of 2; expected"),
    ];
    for (from, to, marked, message) in cases {
        let problem = problem(from, to);
        assert!(problem.message.starts_with(message), "{to}: {problem}");
        assert_eq!(problem.marked(), marked, "{to}: {problem}");
    }
    // A quaternion that is no rotation; a sensor too far away.
    let (_folder, path, _) = written();
    let text = std::fs::read_to_string(&path).unwrap();
    for (key, value, expected) in [
        ("quaternion_xyzw = ", "[0.0, 0.0, 0.0, 0.0]", "a quaternion (x, y, z, w) of length 1e-3 to 1e3"),
        ("position_m = ", "[0.0, 0.0, 2e7]", "three numbers within 1e7 m of the scene origin"),
    ] {
        let start = text.find(key).unwrap() + key.len();
        let end = start + text[start..].find(']').unwrap() + 1;
        let problem = problem(&text[start..end], value);
        assert!(problem.message.ends_with(expected), "{problem}");
        assert!(problem.message.starts_with("`camera.scene_from_camera."), "{problem}");
        assert_eq!(problem.marked(), value);
    }
}

#[test]
fn a_mesh_name_that_leads_elsewhere_is_refused() {
    let (folder, path, scene) = written();
    for name in ["../x.glb", "a/b.glb", "x.gltf", "a\"b.glb", "c:\\x.glb", ""] {
        let message = write_resolved(&path, &scene, name).unwrap_err().to_string();
        assert!(message.contains("expected a plain file name that ends in .glb"), "{message}");
    }
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 2);
}

/// Any double within the bounds, with all its digits, or one of the bounds, or a tiny one.
fn real(low: f64, high: f64) -> impl Strategy<Value = f64> {
    let small = (low > -1.0).then_some(low.max(1e-300));
    prop_oneof![4 => low..=high, 1 => Just(low), 1 => Just(high), 1 => Just(small.unwrap_or(-0.0))]
}

fn pose() -> impl Strategy<Value = Pose> {
    let position = prop::array::uniform3(real(-1e7, 1e7));
    let rotation = prop::array::uniform4(real(-1.0, 1.0));
    (position, rotation).prop_filter_map("a rotation", |(position, rotation)| {
        let pose = Pose { position: DVec3::from_array(position), rotation: DQuat::from_array(rotation) };
        pose.validate("pose").is_ok().then_some(pose)
    })
}

fn camera() -> impl Strategy<Value = Mounted<Camera>> {
    let filter = prop_oneof![
        Just(Filter::None),
        (real(1e-8, 1e-3), real(1e-12, 1e-3), real(1.0, 10.0))
            .prop_map(|(centre, width, index)| Filter::Interference { centre, width, index }),
    ];
    let lens = (real(0.0, 1.0), filter).prop_map(|(transmission, filter)| Lens { transmission, filter });
    let lengths = (real(1e-5, 1e2), real(1e-6, 1e1), real(1e-3, 1e7));
    let pairs = (prop::array::uniform2(real(1e-8, 1e-1)), prop::array::uniform2(real(-1e6, 1e6)));
    ((1_u32..=8192, 1_u32..=8192), lens, lengths, pairs, pose()).prop_map(
        |((width, height), lens, (focal_length, aperture, max_range), pairs, scene_from_sensor)| {
            let (pixel_pitch, principal_point) = pairs;
            let sensor = Camera {
                width,
                height,
                pixel_pitch,
                focal_length,
                principal_point,
                aperture,
                lens,
                max_range,
            };
            Mounted { scene_from_sensor, sensor }
        },
    )
}

fn beam() -> impl Strategy<Value = Mounted<Beam>> {
    let profile = prop_oneof![
        Just(Profile::Paper),
        Just(Profile::UniformAngle),
        real(1e-6, 1e3).prop_map(|half_width| Profile::Gaussian { half_width }),
    ];
    let lengths = (real(1e-6, 1e2), real(1e-4, 1e2), 1e-5..1e3, real(1e-3, 1e7));
    let light = (real(0.0, 1e6), real(1e-8, 1e-3), profile);
    ((1_u32..=1024, 1_u32..=64), lengths, light, pose()).prop_map(
        |((columns, rows), lengths, (power, wavelength, profile), scene_from_sensor)| {
            let (thickness, grid_distance, fan, max_range) = lengths;
            let half_width = grid_distance * fan;
            let sensor = Beam {
                columns,
                rows,
                thickness,
                grid_distance,
                half_width,
                max_range,
                power,
                wavelength,
                profile,
            };
            Mounted { scene_from_sensor, sensor }
        },
    )
}

fn mesh() -> impl Strategy<Value = Mesh> {
    let coordinate = prop_oneof![
        4 => -1e6_f32..1e6,
        1 => prop::sample::select(vec![0.0_f32, -0.0, f32::MIN_POSITIVE, -1e-45, 1e7]),
    ];
    let vertices = prop::collection::vec(prop::array::uniform3(coordinate), 1..12);
    let kinds = prop::collection::vec((real(0.0, 1.0), ".{0,8}"), 1..4);
    let faces = prop::collection::vec((prop::array::uniform3(any::<u32>()), any::<u16>()), 1..20);
    let origin = prop::array::uniform3(prop_oneof![Just(0.0), Just(1e6), real(-1e12, 1e12)]);
    (origin, vertices, kinds, faces).prop_map(|(origin, vertices, kinds, faces)| {
        let (count, of_kinds) = (vertices.len() as u32, kinds.len() as u16);
        let corners = faces.iter().map(|(face, _)| face.map(|corner| corner % count)).collect();
        let face_kinds = faces.iter().map(|(_, kind)| kind % of_kinds).collect();
        let kind = |(reflectivity, name)| Material { name, reflectivity };
        let kinds = kinds.into_iter().map(kind).collect();
        Mesh::new(DVec3::from_array(origin), vertices, corners, face_kinds, kinds).unwrap()
    })
}

fn scene() -> impl Strategy<Value = Scene> {
    let beams = prop::collection::vec(beam(), 0..4);
    let model = prop::sample::select(vec![FluxModel::Radiometric, FluxModel::Eq1]);
    (mesh(), camera(), beams, real(0.0, 1e3), model).prop_map(|(mesh, camera, beams, attenuation, model)| {
        Scene::new(Arc::new(mesh), camera, beams, Atmosphere { attenuation }, model).unwrap()
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_scene_comes_back_bit_for_bit(scene in scene()) {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("scene.toml");
        write_resolved(&path, &scene, "terrain.glb").unwrap();
        let back = load_path(&path, &Overrides::default()).unwrap();
        prop_assert_eq!(back.scene_sha256, scene_sha256(&scene));
    }
}
