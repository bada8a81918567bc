//! `sweep`, and `--set` on every command that takes a scene.

use std::fs;
use std::path::Path;

use serde_json::Value;
use tempfile::TempDir;

use super::{assert_trouble, raypencil, screen, text};

const SCENE: &str = "version = 1
vehicle = { position_m = [-0.6, 0] }
camera = { width_px = 48, height_px = 40, pixel_pitch_um = 200 }
beam = [{ columns = 64, rows = 2 }, { columns = 64, rows = 2 }]
drive = { waypoints_m = [[0.4, 0]], frames_per_s = 3, scans = false }
";

fn house() -> TempDir {
    let folder = TempDir::new().unwrap();
    fs::write(folder.path().join("scene.toml"), SCENE).unwrap();
    folder
}

fn table(folder: &Path, name: &str) -> Vec<u8> {
    fs::read(folder.join(name).join("table.csv")).unwrap()
}

#[test]
fn a_sweep_leaves_a_table_and_charts() {
    let house = house();
    let house = house.path();
    let words = [
        "sweep",
        "scene.toml",
        "--set",
        "beam.pitch_down_deg=20:30:5",
        "--set",
        "terrain.builtin=pyramids,facets",
        "--do",
        "render",
        "--chart",
        "beam-0.hits,beam.pitch_down_deg,terrain.builtin",
        "-o",
        "whole",
    ];
    let shown = screen(house, &words, 0);
    assert!(
        shown.contains(": render of scene.toml with scanline: 6 runs\n")
            && shown.contains("✓ 6 runs, all made."),
        "{shown}"
    );
    assert!(shown.contains("4 charts"), "{shown}");
    let lines = String::from_utf8(table(house, "whole")).unwrap();
    assert_eq!(lines.lines().count(), 7);
    assert!(lines.starts_with("run,beam.pitch_down_deg,terrain.builtin,camera.hits,"), "{lines}");
    // Run 3 is the second angle on the second ground; its maps are those of the scene by itself.
    screen(
        house,
        &[
            "render",
            "scene.toml",
            "--set",
            "beam.pitch_down_deg=25",
            "--set",
            "terrain.builtin=facets",
            "--with",
            "scanline",
            "-o",
            "alone",
        ],
        0,
    );
    screen(house, &["diff", "whole/maps/000003", "alone"], 0);
    screen(house, &["diff", "whole/maps/000002", "alone"], 1);
    assert!(house.join("whole/charts/beam-0.hits-over-beam.pitch_down_deg-by-terrain.builtin.svg").is_file());

    // In parts, joined in another order.
    for part in ["1/2", "2/2"] {
        let folder = format!("part-{}", &part[..1]);
        let words = [&words[..8], &["--shard", part, "-o", &folder]].concat();
        let said = screen(house, &words, 0);
        assert!(said.contains("join all parts with `raypencil sweep merge`"), "{said}");
        assert!(said.contains(&format!("part {} of 2 is finished", &part[..1])), "{said}");
    }
    let refused = raypencil(house, &["sweep", "merge", "part-2", "-o", "merged"]);
    assert_trouble(&refused, &["3 of 6 runs have no record", "run 0"]);
    screen(house, &["sweep", "merge", "part-2", "part-1", "-o", "merged"], 0);
    assert_eq!(table(house, "merged"), table(house, "whole"));
    screen(house, &["sweep", "scene.toml", "--do", "render", "-o", "other"], 0);
    assert_trouble(&raypencil(house, &["sweep", "merge", "part-1", "other"]), &["is of another sweep"]);
}

#[test]
fn a_sweep_of_drives_and_one_of_validations() {
    let house = house();
    let house = house.path();
    let words =
        ["sweep", "scene.toml", "--set", "drive.speed_m_per_s=0.3,0.6", "--do", "drive", "-o", "drives"];
    screen(house, &words, 0);
    let json: Value = serde_json::from_str(&screen(house, &[&words[..], &["--json"]].concat(), 0)).unwrap();
    assert_eq!(json["runs"][1]["arguments"], "scene.toml --set drive.speed_m_per_s=0.6");
    fs::write(house.join("list.csv"), "vehicle.position_m\n\"[0, 0]\"\n\"[500, 0]\"\n").unwrap();
    // One run is refused, for its place is beside the ground: the others are made, and the exit code says it.
    let shown = screen(house, &["sweep", "scene.toml", "--list", "list.csv", "-o", "list"], 1);
    assert!(shown.contains("run 1 could not be made: set vehicle.position_m=[500, 0]: "), "{shown}");
    let table = String::from_utf8(table(house, "list")).unwrap();
    assert!(table.lines().next().unwrap().ends_with(",refused"), "{table}");
}

#[test]
fn sweeps_that_make_no_sense_are_refused() {
    let house = house();
    let house = house.path();
    let sweep = |more: &[&str]| raypencil(house, &[&["sweep", "scene.toml"], more].concat());
    assert_trouble(&sweep(&["--set", "a=1:2:0"]), &["1:2:0 does not come to its end"]);
    assert_trouble(&sweep(&["--set", "a"]), &["expected KEY=VALUES"]);
    assert_trouble(&sweep(&["--chart", "a"]), &["expected RESULT,KEY"]);
    assert_trouble(&sweep(&["--list", "none.csv"]), &["none.csv"]);
    assert_trouble(
        &sweep(&["--do", "drive", "--with", "scanline,tracer"]),
        &["expected one renderer to drive"],
    );
    // Two settings of which one overwrites a part of the other: each row would be labelled with both.
    assert_trouble(
        &sweep(&["--set", "beam.0.pitch_down_deg=20,30", "--set", "beam.pitch_down_deg=25"]),
        &["beam.pitch_down_deg=25", "beam.0.pitch_down_deg=20 sets the same", "nothing was written"],
    );
    // A value that its key does not take, anywhere in a list, a range or a file: nothing is begun.
    fs::write(house.join("list.csv"), "beam.thickness_mm,camera.pitch_down_deg\n4,20\n4,20:35:5\n").unwrap();
    for (more, run, words) in [
        (&["--set", "beam.thickness_mm=4,-4"][..], "run 1 of", "beam.thickness_mm=-4"),
        (&["--set", "beam.thickness_mm=4,2", "--set", "camera.pitch_down_deg=20,x,30"], "run 1 of", "=x"),
        (&["--set", "beam.thickness_mm=-4:4:4", "--set", "camera.pitch_down_deg=20,30"], "run 0 of", "=-4"),
        (&["--set", "beam.thickness_mm=4,2,-1", "--set", "camera.pitch_down_deg=20,30"], "run 4 of", "=-1"),
        (&["--set", "camera.pitch_down_deg=20:35"], "20:35: a range needs a step", "20:35:5"),
        (&["--list", "list.csv"], "run 1 of", "camera.pitch_down_deg=20:35:5"),
    ] {
        assert_trouble(&sweep(&[more, &["-o", "none"]].concat()), &[run, words]);
        assert!(!house.join("none").exists(), "{more:?}");
    }
    assert_trouble(&sweep(&["--as-printed"]), &["expected it with --do drive"]);
    assert_trouble(&sweep(&["--with", "tracer"]), &["at least 2 renderers"]);
    assert_trouble(&sweep(&["--do", "render", "--chart", "a,b"]), &["the table has no result `a`"]);
    assert_trouble(&raypencil(house, &["sweep", "merge", "nowhere"]), &["nowhere"]);
}

fn with<'a>(set: &[&'a str], words: &[&'a str]) -> Vec<&'a str> {
    [words, set].concat()
}

#[test]
fn every_command_that_takes_a_scene_takes_settings() {
    let house = house();
    let house = house.path();
    fs::write(house.join("by-hand.toml"), SCENE.replace("rows = 2 }]", "rows = 2, thickness_mm = 60 }]"))
        .unwrap();
    let set = ["--set", "beam.1.thickness_mm=60"];
    // probe: the same answers, and another one without the setting.
    let probe = ["--beam", "1", "--pencil", "20,1", "--json"];
    let of = |scene: &str, more: &[&str]| {
        screen(house, &[&["probe", scene], &probe[..], more].concat(), 0)
            .replace("by-hand.toml", "scene.toml")
    };
    assert_eq!(of("scene.toml", &set).replace(" --set beam.1.thickness_mm=60", ""), of("by-hand.toml", &[]));
    assert_ne!(of("scene.toml", &[]), of("by-hand.toml", &[]));
    // validate: the report repeats the setting.
    screen(house, &with(&set, &["validate", "scene.toml", "-o", "v"]), 0);
    let summary = fs::read_to_string(house.join("v/summary.json")).unwrap();
    assert!(summary.contains("scene.toml --set beam.1.thickness_mm=60"), "{summary}");
    // render, and diff with the scene of both.
    screen(house, &with(&set, &["render", "scene.toml", "--with", "tracer", "-o", "r"]), 0);
    screen(house, &["render", "by-hand.toml", "--with", "scanline", "-o", "h"], 0);
    screen(house, &with(&set, &["diff", "r", "h", "--scene", "scene.toml"]), 0);
    // pack, check of the render against it, minimise, drive.
    screen(house, &with(&set, &["pack", "scene.toml", "--no-bench", "-o", "p"]), 0);
    screen(house, &["check", "p", "r"], 0);
    screen(house, &with(&set, &["minimise", "scene.toml", "-o", "m"]), 1);
    screen(house, &with(&set, &["drive", "scene.toml", "-o", "d"]), 0);
    assert!(
        fs::read_to_string(house.join("d/summary.json")).unwrap().contains("--set beam.1.thickness_mm=60")
    );
    // terrain inspect, of another ground.
    let inspected =
        screen(house, &["terrain", "inspect", "scene.toml", "--set", "terrain.builtin=facets"], 0);
    assert_ne!(inspected, screen(house, &["terrain", "inspect", "scene.toml"], 0));
    // cast, with rays of the scene.
    fs::write(
        house.join("rays.toml"),
        format!("{SCENE}[[rays]]\nname = \"down\"\nspinning = {{ elevations_deg = [-90], steps = 1 }}\nposition_m = [0, 0, 2]\n"),
    )
    .unwrap();
    let cast = |more: &[&str]| screen(house, &[&["cast", "rays.toml", "--json"], more].concat(), 0);
    assert_ne!(cast(&["--set", "rays.0.position_m=[0, 0, 3]"]), cast(&[]));
    let mesh = raypencil(house, &["cast", "scene.glb", "--ray", "0,0,1,0,0,-1", "--set", "a=1"]);
    assert_trouble(&mesh, &["expected a MESH that ends in .toml"]);
    // An error names the setting, on every one of them.
    for command in [
        vec!["validate", "scene.toml"],
        vec!["render", "scene.toml", "--with", "tracer", "-o", "x"],
        vec!["probe", "scene.toml", "--pixel", "1,1"],
        vec!["pack", "scene.toml", "-o", "x"],
        vec!["minimise", "scene.toml"],
        vec!["drive", "scene.toml"],
        vec!["terrain", "inspect", "scene.toml"],
        vec!["diff", "r", "h", "--scene", "scene.toml"],
        vec!["cast", "rays.toml"],
    ] {
        let output = raypencil(house, &[&command[..], &["--set", "camera.width_px=-3"]].concat());
        assert_trouble(&output, &["set camera.width_px=-3: `camera.width_px` is -3; expected"]);
        let output = raypencil(house, &[&command[..], &["--set", "camera"]].concat());
        assert!(text(&output.stderr).contains("expected KEY=VALUE"), "{command:?}");
    }
}
