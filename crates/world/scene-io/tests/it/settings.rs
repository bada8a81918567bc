//! Keys set outside of the file: as if they stood in it, and errors that name the setting.

use raypencil_scene_io::{
    LoadedScene, Overrides, SceneIoError, Setting, check_settings, load, load_ray_scene, load_text,
    load_text_with,
};

use super::scenes::scenes;

fn with(texts: &[&str]) -> Overrides {
    let settings = texts.iter().map(|text| Setting::parse(text).unwrap()).collect();
    Overrides { settings, ..Overrides::default() }
}

fn set(text: &str, settings: &[&str]) -> Result<LoadedScene, SceneIoError> {
    load_text_with(text, "scene", &with(settings))
}

fn refused(source: &str, settings: &[&str]) -> String {
    load(source, &with(settings)).unwrap_err().to_string()
}

/// Every key of a file, with its value as TOML.
fn keys(table: &toml::Table, before: &str, found: &mut Vec<(String, String)>) {
    for (key, value) in table {
        let key = format!("{before}{key}");
        match value {
            toml::Value::Table(table) => keys(table, &format!("{key}."), found),
            toml::Value::Array(tables) if tables.first().is_some_and(toml::Value::is_table) => {
                for (index, table) in tables.iter().enumerate() {
                    keys(table.as_table().unwrap(), &format!("{key}.{index}."), found);
                }
            }
            value => found.push((key, value.to_string())),
        }
    }
}

#[test]
fn every_key_of_the_documented_scene_can_be_set() {
    let path = scenes().join("default.toml");
    let file = path.to_str().unwrap();
    let table: toml::Table = std::fs::read_to_string(&path).unwrap().parse().unwrap();
    let mut all = Vec::new();
    keys(&table, "", &mut all);
    assert!(all.len() > 40, "{all:?}");
    let plain = load(file, &Overrides::default()).unwrap();
    for (key, value) in &all {
        let own = load(file, &with(&[&format!("{key}={value}")])).unwrap();
        assert_eq!(own.scene_sha256, plain.scene_sha256, "{key}");
        assert_eq!(own.drive, plain.drive, "{key}");
        // No key takes a list of lists: the reader sees the setting, and says that it was one.
        let message = refused(file, &[&format!("{key}=[[]]")]);
        if key != "version" {
            assert!(message.starts_with(&format!("set {key}=[[]]: ")), "{message}");
        }
    }
}

#[test]
fn a_setting_is_as_if_it_stood_in_the_file() {
    let by_hand = |text: &str| load_text(text, "scene").unwrap();
    for (text, settings, hand) in [
        ("version = 1\n", vec!["camera.pitch_down_deg=25"], "version = 1\n[camera]\npitch_down_deg = 25\n"),
        // A file without beams has the two default ones, and one setting takes neither away.
        (
            "version = 1\n",
            vec!["beam.1.thickness_mm=4"],
            "version = 1\n[[beam]]\n[[beam]]\nthickness_mm = 4\n",
        ),
        (
            "version = 1\n[[beam]]\npitch_down_deg = 20\n[[beam]]\n[[beam]]\n",
            vec!["beam.pitch_down_deg=30", "beam.2.fan_deg=90"],
            "version = 1\n[[beam]]\npitch_down_deg = 30\n[[beam]]\npitch_down_deg = 30\n[[beam]]\npitch_down_deg = 30\n\
             fan_deg = 90\n",
        ),
        // The same twice is no contradiction.
        ("version = 1\n", vec!["flux.model=eq1", "flux.model=eq1"], "version = 1\n[flux]\nmodel = \"eq1\"\n"),
        (
            "version = 1\n[vehicle]\nposition_m = [1, 2, 3]\n",
            vec!["vehicle.position_m.1=-2"],
            "version = 1\n[vehicle]\nposition_m = [1, -2, 3]\n",
        ),
        // A table within a line, and a ground that takes the place of another.
        (
            "version = 1\nterrain = { generate = { kind = \"plain\", faces = 200 } }\n",
            vec!["terrain.generate.seed=7"],
            "version = 1\nterrain = { generate = { kind = \"plain\", faces = 200, seed = 7 } }\n",
        ),
        (
            "version = 1\n[terrain]\nfile = \"lost.glb\"\nreflectivity = 0.3\n",
            vec!["terrain.builtin=facets"],
            "version = 1\n[terrain]\nbuiltin = \"facets\"\nreflectivity = 0.3\n",
        ),
    ] {
        let (found, expected) = (set(text, &settings).unwrap(), by_hand(hand));
        assert_eq!(found.scene_sha256, expected.scene_sha256, "{settings:?}");
        assert_ne!(found.source_sha256, by_hand("version = 1\n").source_sha256, "{settings:?}");
    }
}

#[test]
fn a_builtin_ground_and_a_lone_terrain_take_settings() {
    let plain = load("facets", &Overrides::default()).unwrap();
    let same = load("facets", &with(&["camera.roll_right_deg=0"])).unwrap();
    // What defines a built-in scene is its numbers.
    assert_eq!((&same.source_sha256, &same.scene_sha256), (&plain.source_sha256, &plain.scene_sha256));
    assert_eq!(same.name, "facets");
    // A lone terrain still has its vehicle in its middle.
    let text = std::fs::read_to_string(scenes().join("ramp.gltf")).unwrap();
    let mut json: serde_json::Value = serde_json::from_str(&text).unwrap();
    json["nodes"] = serde_json::json!([{"mesh": 0, "translation": [2000, 0, -3000]}]);
    json["scenes"][0]["nodes"] = serde_json::json!([0]);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("far.gltf");
    std::fs::write(&path, json.to_string()).unwrap();
    let path = path.to_str().unwrap();
    let plain = load(path, &Overrides::default()).unwrap();
    assert_eq!(plain.vehicle.position.x, 2000.0);
    let same = load(path, &with(&["camera.roll_right_deg=0"])).unwrap();
    assert_eq!((same.vehicle, &same.scene_sha256), (plain.vehicle, &plain.scene_sha256));
    let moved = load(path, &with(&["vehicle.position_m=[1992, 3000.5]"])).unwrap();
    assert_eq!(moved.vehicle.position.x, 1992.0);
    assert_ne!(moved.scene_sha256, plain.scene_sha256);
}

#[test]
fn errors_name_the_setting_or_the_line() {
    assert_eq!(
        refused("pyramids", &["camera.focal_length_mm=-6"]),
        "set camera.focal_length_mm=-6: `camera.focal_length_mm` is -6; expected 0.01 to 100000 millimetres"
    );
    // A key that does not exist, at any depth.
    for key in ["camera.pitch", "beam.0.power", "camrea.pitch_down_deg"] {
        let message = refused("pyramids", &[&format!("{key}=1")]);
        assert!(
            message.contains("unknown key") && message.contains(key.split('.').next().unwrap()),
            "{message}"
        );
    }
    let message = refused("pyramids", &["beam.2.power_w=1"]);
    assert_eq!(message, "set beam.2.power_w=1: `beam.2` is not there; expected 0 to 1, for the scene has 2");
    // A list that the scene leaves to its default has no single numbers.
    let message = refused("pyramids", &["camera.position_m.2=2"]);
    let expected = "`camera.position_m` is not in the scene, so that it has no `2`; expected the whole of it: camera.position_m=[...]";
    assert_eq!(message, format!("set camera.position_m.2=2: {expected}"));
    // A whole table has keys, and one place has one name.
    let message = refused("pyramids", &["beam.0=1"]);
    assert_eq!(message, "set beam.0=1: `beam.0` is 1; expected a table of keys, { ... }");
    assert!(refused("pyramids", &["beam.00.power_w=1"]).contains("unknown key"));
    let text = "version = 1\n[terrain]\nbuiltin = \"pyramids\"\n[[beam]]\npower_w = 2\nrows = 3\n[[beam]]\nrows = 5\n";
    let whole = set(text, &["beam.0={ columns = 7 }"]).unwrap();
    let sizes = whole.scene.beams().iter().map(|beam| (beam.sensor.columns, beam.sensor.rows));
    assert_eq!(sizes.collect::<Vec<_>>(), [(7, 16), (1024, 5)]);
    let message = refused("pyramids", &["terrain.builtin.seed=1"]);
    assert!(message.contains("`builtin` is \"pyramids\" in the scene; expected a table"), "{message}");
    let message = refused("pyramids", &["vehicle.position_m=[1e6, 0]"]);
    assert!(
        message.starts_with("set vehicle.position_m=[1e6, 0]: ") && message.contains("no ground under"),
        "{message}"
    );
    // The file's own errors keep their place.
    let message = set("version = 1\n[camera]\nfocal_length_mm = -6\n", &["camera.pitch_down_deg=1"]);
    assert!(message.unwrap_err().to_string().starts_with("scene.toml:3:19: "));
    // Also one that stands behind the setting.
    let text = "version = 1\n[vehicle]\nheading_deg = 0\n[camera]\nfocal_length_mm = -6\n";
    let message = set(text, &["vehicle.heading_deg=90"]).unwrap_err().to_string();
    assert!(message.starts_with("scene.toml:5:19: "), "{message}");
    // Behind lines that settings put there: the line is that of the file, which has six.
    let text = "version = 1\n[camera]\nwidth_px = 256\nheight_px = 256\n[drive]\nspeed_m_per_s = -3\n";
    let error = set(text, &["camera.pitch_down_deg=25", "camera.yaw_left_deg=3"]).unwrap_err();
    assert!(error.to_string().starts_with("scene.toml:6:17: "), "{error}");
    let SceneIoError::Toml(problem) = &error else { panic!("{error:?}") };
    assert_eq!(problem.marked(), "-3");
    // A table that the setting made, and in which something is missing.
    let message = set(text, &["drive.speed_m_per_s=1", "drive.sun.optical_depth=1"]).unwrap_err().to_string();
    assert!(
        message.starts_with("set drive.sun.optical_depth=1: ") && message.contains("missing"),
        "{message}"
    );
    let message = set("version = ", &["camera.pitch_down_deg=1"]).unwrap_err().to_string();
    assert!(message.starts_with("scene.toml:1:"), "{message}");
    for text in ["camera", "=3", "camera..x=3", "camera.p q=3", ".=1"] {
        let message = Setting::parse(text).unwrap_err().to_string();
        assert!(
            message.starts_with(&format!("set {text}: ")) && message.contains("camera.pitch_down_deg"),
            "{message}"
        );
    }
}

#[test]
fn sets_of_rays_take_settings() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("rays.toml");
    let text = "version = 1\n[terrain]\nbuiltin = \"facets\"\n[[rays]]\nname = \"down\"\nspinning = { elevations_deg = [-90], \
                steps = 1 }\nposition_m = [0, 0, 2]\n";
    std::fs::write(&path, text).unwrap();
    let height = |settings: &[&str]| {
        let scene = load_ray_scene(&path, &with(settings).settings).unwrap();
        scene.sets[0].set.rays()[0].origin.z
    };
    assert!((height(&["rays.position_m=[0, 0, 3]"]) - height(&[]) - 1.0).abs() < 1e-12);
}

#[test]
fn a_key_of_many_parts_is_refused_before_it_becomes_tables() {
    for parts in [17, 85, 100_000] {
        let error = Setting::new(&vec!["a"; parts].join("."), "1").unwrap_err().to_string();
        assert!(error.contains(&format!("the key has {parts} parts; expected at most 16")), "{parts}");
    }
    assert!(Setting::new(&["a"; 16].join("."), "1").is_ok());
}

#[test]
fn settings_that_contradict_one_another_are_refused_with_both_named() {
    for [earlier, later] in [
        // One key twice; one for all beams and one for one of them, in both orders; a table and a key in it.
        ["flux.model=radiometric", "flux.model=eq1"],
        ["beam.0.pitch_down_deg=20", "beam.pitch_down_deg=25"],
        ["beam.pitch_down_deg=25", "beam.1.pitch_down_deg=20"],
        ["camera.filter={ centre_nm = 600, width_nm = 10 }", "camera.filter.index=2"],
        ["vehicle.position_m.1=2", "vehicle.position_m=[0, 0]"],
        ["beam.0.position_m=[0, 0, 1]", "beam.position_m.2=2"],
        // Two descriptions of the image, of which one would go without a word; two grounds; what belongs to another ground.
        ["camera.field_of_view_deg=60", "camera.focal_length_mm=8"],
        ["camera.principal_point_px=[3, 4]", "camera.field_of_view_deg=60"],
        ["camera.field_of_view_deg=60", "camera.principal_point_px=[3, 4]"],
        ["terrain.builtin=facets", "terrain.file=a.obj"],
        ["terrain.up=y", "terrain.builtin=facets"],
    ] {
        let text = "version = 1\n[[beam]]\n[[beam]]\n";
        let message = set(text, &["camera.pitch_down_deg=3", earlier, later]).unwrap_err().to_string();
        assert!(message.starts_with(&format!("set {later}: ")), "{message}");
        assert!(message.contains(earlier) && message.ends_with("; expected one of the two"), "{message}");
    }
    // Different beams, different keys: none overwrites another.
    let text = "version = 1\n[[beam]]\n[[beam]]\n";
    set(
        text,
        &["beam.0.fan_deg=60", "beam.1.fan_deg=70", "beam.pitch_down_deg=20", "camera.pitch_down_deg=20"],
    )
    .unwrap();
    // Whatever takes settings refuses them.
    let pair = ["camera.field_of_view_deg=60", "camera.focal_length_mm=8"];
    assert!(refused("pyramids", &pair).contains(pair[0]));
    let settings = with(&pair).settings;
    assert!(check_settings("pyramids", &settings).unwrap_err().to_string().contains(pair[0]));
    // Of changes that come one after the other the later holds.
    let later: Vec<Setting> = settings.into_iter().map(Setting::replacing).collect();
    let scene = load("pyramids", &Overrides { settings: later, ..Overrides::default() }).unwrap().scene;
    assert_eq!(scene.camera().sensor.focal_length, 0.008);
}

#[test]
fn a_number_given_as_an_option_and_as_a_setting_is_refused() {
    let message = |overrides: Overrides, setting: &str| {
        let overrides = Overrides { settings: with(&[setting]).settings, ..overrides };
        load("pyramids", &overrides).unwrap_err().to_string()
    };
    let plain = Overrides::default;
    // Out of range: a number that people can read.
    let far = load("pyramids", &Overrides { at: Some([1e300, 0.0]), ..plain() }).unwrap_err().to_string();
    assert_eq!(far, "override at x is 1e300; expected -1e12 to 1e12 metres");
    for (overrides, name, setting) in [
        (Overrides { at: Some([1.0, 2.0]), ..plain() }, "--at", "vehicle.position_m=[0, 0]"),
        (Overrides { heading_deg: Some(9.0), ..plain() }, "--heading", "vehicle.heading_deg=8"),
        (Overrides { fan_deg: Some(9.0), ..plain() }, "--fan", "beam.1.fan_deg=8"),
        (Overrides { thickness_mm: Some(9.0), ..plain() }, "--thickness", "beam.thickness_mm=8"),
        (
            Overrides { flux_model: Some(raypencil_scene::FluxModel::Eq1), ..plain() },
            "--flux",
            "flux.model=eq1",
        ),
    ] {
        let message = message(overrides, setting);
        assert!(message.contains(setting) && message.contains(name), "{message}");
    }
}

#[test]
fn of_settings_of_one_value_the_last_holds_wherever_the_others_stand() {
    let last_of = |texts: &[&str]| -> Vec<String> {
        let settings = texts.iter().map(|text| Setting::parse(text).unwrap()).collect();
        Setting::last_of(settings).iter().map(ToString::to_string).collect()
    };
    let apart = ["beam.fan_deg=60", "camera.focal_length_mm=8", "vehicle.heading_deg=5", "beam.fan_deg=70"];
    assert_eq!(last_of(&apart), apart[1..]);
    // All beams after one, and one after all: the second is a part of what the first sets.
    assert_eq!(
        last_of(&["beam.0.fan_deg=60", "camera.width_px=8", "beam.fan_deg=70"]),
        ["camera.width_px=8", "beam.fan_deg=70"]
    );
    let part = ["beam.fan_deg=70", "camera.width_px=8", "beam.0.fan_deg=60"];
    assert_eq!(last_of(&part), part);
    // A focal length and a field of view say one thing.
    let two_ways = ["camera.focal_length_mm=8", "camera.width_px=8", "camera.field_of_view_deg=50"];
    assert_eq!(last_of(&two_ways), two_ways[1..]);
}
