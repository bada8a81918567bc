//! `terrain import`: reports, options, errors.

use serde_json::Value;
use tempfile::TempDir;

use super::super::{assert_trouble, raypencil, screen, text};

/// A folder with `hill.tif`: 5 x 4 pixels of 2 m. The tie point is their north-west corner at (1000000, 500), heights
/// are 10 column + row, and one height is unknown.
fn folder() -> TempDir {
    let folder = TempDir::new().expect("a temporary folder");
    let heights: Vec<f32> = (0..20_u8)
        .map(|k| match k {
            19 => -9999.0,
            k => f32::from(10 * (k % 5) + k / 5),
        })
        .collect();
    std::fs::write(folder.path().join("hill.tif"), geotiff(5, 4, &heights)).expect("a file");
    folder
}

/// A little-endian TIFF of one strip. (TIFF 6.0, section 2)
pub(crate) fn geotiff(width: u32, height: u32, heights: &[f32]) -> Vec<u8> {
    let mut file = b"II*\0\0\0\0\0".to_vec();
    let samples_at = file.len() as u32;
    file.extend(heights.iter().flat_map(|height| height.to_le_bytes()));
    let doubles = |file: &mut Vec<u8>, values: &[f64]| {
        let at = file.len() as u32;
        file.extend(values.iter().flat_map(|value| value.to_le_bytes()));
        at
    };
    let scale_at = doubles(&mut file, &[2.0, 2.0, 0.0]);
    let tie_at = doubles(&mut file, &[0.0, 0.0, 0.0, 1e6, 500.0, 0.0]);
    let nodata_at = file.len() as u32;
    file.extend(b"-9999\0");
    let directory_at = file.len() as u32;
    file[4..8].copy_from_slice(&directory_at.to_le_bytes());
    let (short, long, double, ascii) = (3_u16, 4_u16, 12_u16, 2_u16);
    let tags: [(u16, u16, u32, u32); 13] = [
        (256, long, 1, width),
        (257, long, 1, height),
        (258, short, 1, 32),
        (259, short, 1, 1),
        (262, short, 1, 1),
        (273, long, 1, samples_at),
        (277, short, 1, 1),
        (278, long, 1, height),
        (279, long, 1, 4 * width * height),
        (339, short, 1, 3),
        (33550, double, 3, scale_at),
        (33922, double, 6, tie_at),
        (42113, ascii, 6, nodata_at),
    ];
    file.extend((tags.len() as u16).to_le_bytes());
    for (tag, kind, count, value) in tags {
        file.extend([tag.to_le_bytes(), kind.to_le_bytes()].concat());
        file.extend([count.to_le_bytes(), value.to_le_bytes()].concat());
    }
    file.extend([0; 4]);
    file
}

#[test]
fn an_elevation_model_becomes_a_terrain() {
    let folder = folder();
    let out = screen(folder.path(), &["terrain", "import", "hill.tif", "-o", "hill.glb"], 0);
    // Posts are 1 m inside the border: x 1000001 to 1000009, y 493 to 499. There are 12 cells, and the unknown corner
    // removes one: 22 faces. Heights are 0 to 10 * 4 + 2; the south-east post, 43, is unknown. The middle is at x
    // 1000005, y 496, z 21.
    for line in [
        "extent         x 1000001.0 to 1000009.0, y 493.0 to 499.0 m",
        "posts          5 x 4, 2.0 x 2.0 m apart",
        "map            the file does not say",
        "unit           metre (EPSG:9001), by default: the file does not say",
        "z unit         metre (EPSG:9001), by default: the file does not say",
        "unknown posts  1 (NaN; -9999 as the file says)",
        "registration   a pixel is an area, by default: the file does not say",
        "heights        0.0 to 42.0 m",
        "faces          22, through all posts",
        "scene origin   (1000005.0, 496.0, 21.0) m",
        "hill.glb",
    ] {
        assert!(out.contains(line), "{line} is not in:\n{out}");
    }
    let json = screen(
        folder.path(),
        &[
            "terrain",
            "import",
            "hill.tif",
            "-o",
            "part.glb",
            "--window",
            "1000000,492,6,20",
            "--max-error",
            "100",
            "--reflectivity",
            "0.4",
            "--json",
        ],
        0,
    );
    let report: Value = serde_json::from_str(&json).expect("JSON");
    // Columns at x 1000001, 3, 5: 2 x 3 cells, that is one and a half squares of 2 x 2 cells.
    assert_eq!((&report["posts"], &report["unknown_posts"]), (&serde_json::json!([3, 4]), &0.into()));
    assert_eq!(report["registration_is_stated"], false);
    assert!(report["faces"].as_u64().is_some_and(|faces| faces < 12), "{report}");
    // The file is a terrain that other commands accept.
    let probe = screen(folder.path(), &["probe", "hill.glb", "--pixel", "512,900", "--with", "tracer"], 0);
    assert!(probe.contains("hill"), "{probe}");
}

#[test]
fn errors_are_named_and_leave_no_file() {
    let folder = folder();
    let import = |arguments: &[&str]| {
        let output = raypencil(folder.path(), &[&["terrain", "import"], arguments].concat());
        assert!(!folder.path().join("out.glb").exists());
        output
    };
    let to = ["-o", "out.glb"];
    assert_trouble(
        &import(&[&["hill.tif", "--window", "0,0,5,5"], &to[..]].concat()),
        &["hill.tif", "window", "no post in x 0 to 5", "x 1000001 to 1000009"],
    );
    assert_trouble(&import(&[&["none.tif"], &to[..]].concat()), &["none.tif", "cannot read"]);
    assert_trouble(
        &import(&[&["hill.tif", "--max-error", "0"], &to[..]].concat()),
        &["largest error", "0 m", "1e-6"],
    );
    assert_trouble(
        &import(&[&["hill.tif", "--reflectivity", "2"], &to[..]].concat()),
        &["reflectivity", "2"],
    );
    assert_trouble(&import(&["hill.tif", "-o", "out.obj"]), &["out.obj", ".glb"]);
    let usage = import(&[&["hill.tif", "--window", "1,2,3"], &to[..]].concat());
    assert_eq!(usage.status.code(), Some(2));
    assert!(text(&usage.stderr).contains("expected 4 numbers"), "{}", text(&usage.stderr));
}

/// A level floor of 4 m by 2 m at a height of 1 m, in centimetres and with y up: z of the file from -300 to -100 is y from 1 m
/// to 3 m.
const FLOOR_CM: &str = "v 0 100 -100\nv 400 100 -100\nv 400 100 -300\nv 0 100 -300\nf 1 2 3 4\n";

#[test]
fn a_mesh_becomes_a_terrain() {
    let folder = TempDir::new().expect("a temporary folder");
    let path = folder.path();
    std::fs::write(path.join("floor.obj"), FLOOR_CM).expect("a file");
    let words = ["terrain", "import", "floor.obj", "--up", "y", "--scale", "0.01", "-o", "floor.glb"];
    let out = screen(path, &words, 0);
    for line in [
        "extent         x 0.000 to 4.000, y 1.000 to 3.000 m",
        "heights        z 1.000 to 1.000 m",
        "up axis        y, as is given",
        "scale          0.01 m for each unit of the file, as is given",
        "vertices       4",
        "faces          2",
        "floor.glb",
    ] {
        assert!(out.contains(line), "{line} is not in:\n{out}");
    }
    let json = screen(path, &["terrain", "import", "floor.obj", "-o", "plain.glb", "--json"], 0);
    let report: Value = serde_json::from_str(&json).expect("JSON");
    // Neither turned nor scaled: z of the file is the height.
    assert_eq!(report["z_m"], serde_json::json!([-300.0, -100.0]));
    assert_eq!((&report["up"], &report["scale"]), (&Value::Null, &1.0.into()));
    assert_eq!(report["file_states"], serde_json::json!({ "unit": null, "up": null }));
    // The GLB is the terrain: the same as the mesh under these words, to the bit.
    let digest = |arguments: &[&str]| {
        let arguments =
            [&["validate"], arguments, &["-o", "out", "--json", "--fan", "5", "--force"]].concat();
        let report: Value = serde_json::from_str(&screen(path, &arguments, 0)).expect("JSON");
        report["scene"]["sha256"].as_str().map(String::from).expect("a digest")
    };
    let set = ["--set", "terrain.up=y", "--set", "terrain.scale=0.01", "--set", "camera.width_px=8"];
    let small = ["--set", "camera.width_px=8"];
    assert_eq!(digest(&[&["floor.glb"], &small[..]].concat()), digest(&[&["floor.obj"], &set[..]].concat()));
    let inspected = screen(path, &["terrain", "inspect", "floor.obj"], 0);
    assert!(inspected.contains("floor.obj: 2 faces, 4 vertices"), "{inspected}");
}

#[test]
fn options_of_meshes_and_models_are_kept_apart() {
    let folder = folder();
    std::fs::write(folder.path().join("floor.obj"), FLOOR_CM).expect("a file");
    std::fs::write(folder.path().join("cut.stl"), [b' '; 90]).expect("a file");
    let import = |arguments: &[&str]| {
        let output = raypencil(folder.path(), &[&["terrain", "import", "-o", "out.glb"], arguments].concat());
        assert!(!folder.path().join("out.glb").exists());
        output
    };
    assert_trouble(&import(&["hill.tif", "--up", "y"]), &["--up", "hill.tif is no mesh", ".stl"]);
    assert_trouble(&import(&["hill.tif", "--scale", "2"]), &["--scale", "hill.tif is no mesh"]);
    assert_trouble(
        &import(&["floor.obj", "--window", "0,0,1,1"]),
        &["--window", "floor.obj is a mesh", ".tif"],
    );
    assert_trouble(&import(&["floor.obj", "--max-error", "1"]), &["--max-error", "floor.obj is a mesh"]);
    for option in ["--nodata", "--unit", "--z-unit"] {
        let value = if option == "--nodata" { "-1" } else { "m" };
        assert_trouble(&import(&["floor.obj", option, value]), &[option, "floor.obj is a mesh", "--scale"]);
        let inspect = ["terrain", "inspect", "floor.obj", option, value];
        assert_trouble(&raypencil(folder.path(), &inspect), &[option, "floor.obj is no elevation model"]);
    }
    for scale in ["0", "-1", "nan", "inf", "1e7"] {
        assert_trouble(
            &import(&["floor.obj", "--scale", scale]),
            &["--scale", "expected 1e-6 to 1e6 metres"],
        );
    }
    assert_trouble(&import(&["cut.stl"]), &["cut.stl: byte 80", "is it cut off?"]);
    assert_trouble(&import(&["none.ply"]), &["none.ply", "cannot read"]);
    let same = ["terrain", "import", "copy.glb", "-o", "copy.glb"];
    screen(folder.path(), &["terrain", "import", "floor.obj", "-o", "copy.glb"], 0);
    assert_trouble(&raypencil(folder.path(), &same), &["copy.glb", "is the mesh itself"]);
}

#[test]
fn what_a_model_does_not_say_is_said_by_options() {
    let folder = folder();
    let path = folder.path();
    let words = ["--unit", "ft", "--z-unit", "-ftUS", "--nodata", "42"];
    let out = screen(path, &[&["terrain", "import", "hill.tif", "-o", "feet.glb"], &words[..]].concat(), 0);
    // x 1000001 ft are 304800.3048 m; heights of 0 to 41 become depths. The sample 42 is unknown, and the one that the file declares.
    for line in [
        "extent         x 304800.3048 to 304802.7",
        "heights        -12.4968",
        "unit           foot (EPSG:9002), 0.3048 m, as is given",
        "z unit         US survey foot (EPSG:9003), 0.3048006096012192 m, as is given; depths, which became heights",
        "unknown posts  2 (NaN; -9999 as the file says; 42 as is given)",
    ] {
        assert!(out.contains(line), "{line} is not in:\n{out}");
    }
    let json = screen(
        path,
        &[&["terrain", "import", "hill.tif", "-o", "feet.glb", "--json"], &words[..]].concat(),
        0,
    );
    let report: Value = serde_json::from_str(&json).expect("JSON");
    let [map, vertical] = [&report["map"], &report["vertical"]];
    assert_eq!(
        (&map["unit"], &map["unit_epsg"], &map["unit_from"]),
        (&"foot".into(), &9002.into(), &"option".into())
    );
    assert_eq!(
        (&vertical["is_depth"], &vertical["metres_per_unit"]),
        (&true.into(), &(1200.0 / 3937.0).into())
    );
    assert_eq!((&report["nodata"], &report["spikes"]), (&(-9999.0).into(), &Value::Null));
    for (option, wrong, expected) in [
        ("--unit", "feet", "expected m, km, cm, mm, ft (0.3048 m)"),
        ("--z-unit", "-9102", "a minus before it for depths"),
        ("--nodata", "nought", "such as -9999, or none"),
    ] {
        let output = raypencil(path, &["terrain", "import", "hill.tif", "-o", "x.glb", option, wrong]);
        assert_eq!(output.status.code(), Some(2));
        assert!(text(&output.stderr).contains(expected), "{}", text(&output.stderr));
    }
}

/// 24 x 24 heights around 100 m, with so many posts of a constant.
fn with_constant(path: &std::path::Path, value: f32, count: usize) {
    let heights: Vec<f32> =
        (0..24 * 24).map(|k| if k < count { value } else { 100.0 + (k % 97) as f32 / 10.0 }).collect();
    std::fs::write(path.join("hole.tif"), geotiff(24, 24, &heights)).expect("a file");
}

#[test]
fn a_constant_that_nobody_declared_is_refused_wherever_a_model_is_read() {
    let folder = TempDir::new().expect("a temporary folder");
    let path = folder.path();
    with_constant(path, -32768.0, 30);
    let words = ["hole.tif", "-32768 in 30 of 576 posts", "--nodata -32768", "--nodata none", "dem_nodata"];
    for command in [
        &["terrain", "import", "hole.tif", "-o", "out.glb"][..],
        &["terrain", "inspect", "hole.tif"],
        &["validate", "hole.tif", "-o", "out"],
        &["terrain", "generate", "--coarse", "hole.tif", "-o", "out.glb"],
    ] {
        assert_trouble(&raypencil(path, command), &words);
        assert!(!path.join("out.glb").exists() && !path.join("out").exists());
    }
    let inspected = screen(path, &["terrain", "inspect", "hole.tif", "--nodata", "-32768", "--json"], 0);
    let report: Value = serde_json::from_str(&inspected).expect("JSON");
    assert_eq!((&report["file"]["unknown_posts"], &report["file"]["spikes"]), (&30.into(), &Value::Null));
    // As heights they are a pit, which both commands tell.
    for command in
        [&["terrain", "import", "hole.tif", "-o", "pit.glb"][..], &["terrain", "inspect", "hole.tif"]]
    {
        let out = screen(path, &[command, &["--nodata", "none"]].concat(), 0);
        assert!(out.contains("30 of the posts stand out: the worst, at ("), "{out}");
    }
    // One post of it is a spike.
    with_constant(path, -32768.0, 1);
    let out = screen(path, &["terrain", "inspect", "hole.tif"], 0);
    assert!(
        out.contains(
            "1 of the posts stands out: the worst, at (1000001, 499), is 32868.0 m below all others"
        ),
        "{out}"
    );
}

#[test]
fn degrees_that_are_taken_as_metres_are_warned_of() {
    let folder = TempDir::new().expect("a temporary folder");
    let path = folder.path();
    let mut file = geotiff(5, 4, &[7.0; 20]);
    // The distances of the posts stand behind the heights.
    let scale_at = 8 + 4 * 20;
    for at in [scale_at, scale_at + 8] {
        assert_eq!(file[at..at + 8], 2.0_f64.to_le_bytes());
        file[at..at + 8].copy_from_slice(&0.0003_f64.to_le_bytes());
    }
    std::fs::write(path.join("degrees.tif"), file).expect("a file");
    let question =
        "the posts are 0.0003 x 0.0003 m apart: are the coordinates degrees, which are taken as metres?";
    let imported = screen(path, &["terrain", "import", "degrees.tif", "-o", "x.glb"], 0);
    assert!(imported.contains(question), "{imported}");
    let out = raypencil(path, &["validate", "degrees.tif", "-o", "out"]);
    let said = String::from_utf8_lossy(&out.stdout);
    // The screen breaks lines.
    let said = said.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(said.contains(question), "{said}");
    let summary = std::fs::read(path.join("out/summary.json")).expect("a summary");
    let summary: Value = serde_json::from_slice(&summary).expect("JSON");
    let codes: Vec<&Value> =
        summary["warnings"].as_array().expect("a list").iter().map(|one| &one["code"]).collect();
    assert!(codes.contains(&&Value::from("posts_too_dense")), "{codes:?}");
}

#[test]
fn a_scene_on_a_model_says_what_its_file_says() {
    let folder = TempDir::new().expect("a temporary folder");
    let path = folder.path();
    with_constant(path, -32768.0, 30);
    let text = "version = 1\n[terrain]\ndem = \"hole.tif\"\ndem_nodata = \"none\"\ndem_z_unit = \"ft\"\n[vehicle]\nposition_m = [1000024, 476]\n\
                [camera]\nwidth_px = 12\nheight_px = 12\n[[beam]]\ncolumns = 16\nrows = 2\n";
    std::fs::write(path.join("scene.toml"), text).expect("a file");
    let inspected = screen(path, &["terrain", "inspect", "scene.toml"], 0);
    assert!(inspected.contains("  z unit        foot (EPSG:9002), 0.3048 m, as is given\n"), "{inspected}");
    let out = raypencil(path, &["validate", "scene.toml", "-o", "out"]);
    let said = String::from_utf8_lossy(&out.stdout);
    assert!(said.contains("Its file: map in metre (EPSG:9001), by default"), "{said}");
    assert!(said.contains("heights in foot (EPSG:9002), 0.3048 m, as is given"), "{said}");
    assert!(said.contains("30 of the posts stand out: the worst, at ("), "{said}");
    let summary = std::fs::read(path.join("out/summary.json")).expect("a summary");
    let summary: Value = serde_json::from_slice(&summary).expect("JSON");
    let file = &summary["scene"]["terrain_file"];
    assert_eq!((&file["vertical"]["unit_epsg"], &file["spikes"]["count"]), (&9002.into(), &30.into()));
    assert_eq!(summary["warnings"][0]["code"], "posts_stand_out");
    let page = std::fs::read_to_string(path.join("out/report.html")).expect("a page");
    assert!(page.contains("heights in foot (EPSG:9002)"), "the page says it");
    // A mesh in STL says nothing, and a ground without a file has none.
    let built_in = raypencil(path, &["validate", "pyramids", "--set", "camera.width_px=12", "-o", "other"]);
    assert!(!String::from_utf8_lossy(&built_in.stdout).contains("Its file"));
}
