//! `drive`: exit codes, the screen, the folder, errors.

use std::process::ExitCode;

use raypencil::harness::contender;
use raypencil::{Precision, RenderOutput, Renderer, Request, Scene};
use tempfile::TempDir;

use super::{assert_trouble, raypencil, screen, text};

/// A folder with `small.toml`: a short drive with a small camera on level ground.
fn folder() -> TempDir {
    let folder = TempDir::new().expect("a temporary folder");
    let scene = "version = 1\n\
        [vehicle]\nposition_m = [-0.6, 0]\n\
        [camera]\nwidth_px = 96\nheight_px = 96\npixel_pitch_um = 96\n\
        [[beam]]\nrows = 2\ncolumns = 16\n[[beam]]\nrows = 2\ncolumns = 16\n\
        [terrain]\nbuiltin = \"pyramids\"\n\
        [drive]\nwaypoints_m = [[0.6, 0]]\nframes_per_s = 3\nscans = false\n";
    std::fs::write(folder.path().join("small.toml"), scene).expect("a scene file");
    folder
}

/// A drive with a camera that exposes photons.
const CAMERA: &str = "version = 1\n[terrain]\nbuiltin = \"pyramids\"\n[drive]\nwaypoints_m = [[1, 0]]\n\
    sensor = \"cmos\"\n";

const FILES: [&str; 22] = [
    "summary.json",
    "report.html",
    "drive.png",
    "camera-view.svg",
    "camera-view.png",
    "local-map.svg",
    "local-map.png",
    "obstacle-map.svg",
    "obstacle-map.png",
    "navigator-map.svg",
    "navigator-map.png",
    "local-map.npy",
    "local-map-error.npy",
    "local-map-keys.txt",
    "local-map-source.npy",
    "local-map.tif",
    "obstacle-map-nav2.yaml",
    "obstacle-map-nav2.pgm",
    "navigator-map.geojson",
    "navigator-map.csv",
    "edge-points.ply",
    "camera_info.yaml",
];

#[test]
fn both_renderers_drive_identically_and_write_every_file() {
    let folder = folder();
    let said = screen(folder.path(), &["drive", "small.toml", "--both", "-o", "here"], 0);
    assert!(said.contains("Both sides are identical over 7 frames"), "{said}");
    assert!(said.contains("driven   0.60 m at 0.300 m/s"), "{said}");
    assert!(said.lines().count() <= 40 && said.lines().all(|line| line.chars().count() <= 120), "{said}");
    for file in FILES {
        assert!(folder.path().join("here").join(file).is_file(), "{file} is missing");
    }
    let image = std::fs::read_to_string(folder.path().join("here/obstacle-map-nav2.yaml")).unwrap();
    assert!(image.starts_with("image: obstacle-map-nav2.pgm\nmode: trinary\nresolution: 0.1\n"), "{image}");
}

#[test]
fn json_is_the_summary_that_was_written_and_the_folder_has_the_scenes_name() {
    let folder = folder();
    let said = screen(folder.path(), &["drive", "small.toml", "--with", "tracer", "--json"], 0);
    let said: serde_json::Value = serde_json::from_str(&said).expect("JSON");
    let written = std::fs::read(folder.path().join("out/small-drive/summary.json")).unwrap();
    let written: serde_json::Value = serde_json::from_slice(&written).expect("JSON");
    assert_eq!(said, written);
    assert_eq!((&said["frames"], &said["renderers"][0]), (&7.into(), &"tracer".into()));
    assert_eq!(said["differences"], serde_json::Value::Null);
    assert_eq!(said["arguments"], "small.toml --with tracer");
}

#[test]
fn waypoints_of_the_command_line_replace_those_of_the_scene() {
    let folder = folder();
    let path = folder.path();
    // The scene's drive with other waypoints: 0.8 m ahead and back to 0.6 m, with half a turn in between.
    let there = ["drive", "small.toml", "--to", "0.8,0", "--to", "0.6,0", "--json"];
    let said: serde_json::Value = serde_json::from_str(&screen(path, &there, 0)).expect("JSON");
    assert!((said["driven_m"].as_f64().unwrap() - 1.0).abs() < 1e-9, "{}", said["driven_m"]);
    assert_eq!(
        (&said["arguments"], &said["frames_per_s"]),
        (&"small.toml --to 0.8,0 --to 0.6,0".into(), &3.0.into())
    );
    // The same places in the global frame: the vehicle starts at x = -0.6 m.
    let global = ["drive", "small.toml", "--to", "0.2,0", "--to", "0,0", "--to-global", "--json"];
    let said: serde_json::Value = serde_json::from_str(&screen(path, &global, 0)).expect("JSON");
    assert!((said["driven_m"].as_f64().unwrap() - 1.0).abs() < 1e-9, "{}", said["driven_m"]);
    assert_eq!(said["arguments"], "small.toml --to 0.2,0 --to 0,0 --to-global");
    // A scene without a drive uses the defaults: ten frames per second, and a vertical scan first.
    let text = std::fs::read_to_string(path.join("small.toml")).unwrap();
    let still = text.split("[drive]").next().unwrap();
    std::fs::write(path.join("still.toml"), still).unwrap();
    let said = screen(path, &["drive", "still.toml", "--at", "0,0", "--to", "0.06,0", "--json"], 0);
    let said: serde_json::Value = serde_json::from_str(&said).expect("JSON");
    assert_eq!((&said["frames"], &said["vertical_scans"]), (&3.into(), &1.into()));
    assert_trouble(&raypencil(path, &["drive", "still.toml", "--to", "inf,0"]), &["waypoints"]);
    assert_trouble(&raypencil(path, &["drive", "still.toml", "--to", "1"]), &["--to"]);
}

#[test]
fn a_drive_as_printed_is_one_word_and_a_rule_another() {
    let folder = folder();
    let summary = |words: &[&str]| -> serde_json::Value {
        let words = [&["drive", "small.toml"], words, &["--json"]].concat();
        serde_json::from_str(&screen(folder.path(), &words, 0)).expect("JSON")
    };
    let printed = summary(&["--as-printed", "--both"]);
    // 0.6 m at 0.3 m/s and ten frames a second.
    assert_eq!((&printed["frames"], &printed["frames_per_s"]), (&21.into(), &10.0.into()));
    assert_eq!(printed["arguments"], "small.toml --as-printed --both");
    assert!(printed["notes"].to_string().contains("eq1"), "{}", printed["notes"]);
    let one = summary(&["--rule", "start=footprint"]);
    assert_eq!(one["arguments"], "small.toml --rule start=footprint");
    // The footprint of the vehicle is known from the start, and nothing else of it is here.
    let known = |summary: &serde_json::Value| summary["map"]["known"].as_u64().unwrap();
    assert!(known(&one) > known(&summary(&[])) + 100);
}

#[test]
fn errors_leave_no_folder_that_looks_complete() {
    let folder = folder();
    let path = folder.path();
    let still = "version = 1\n[terrain]\nbuiltin = \"pyramids\"\n";
    std::fs::write(path.join("still.toml"), still).unwrap();
    assert_trouble(
        &raypencil(path, &["drive", "still.toml", "-o", "out"]),
        &["still.toml: there is no drive", "[drive] table"],
    );
    std::fs::write(path.join("camera.toml"), CAMERA).unwrap();
    for unit in [["--flux", "eq1"].as_slice(), &["--as-printed"]] {
        let words = [&["drive", "camera.toml"], unit].concat();
        assert_trouble(&raypencil(path, &words), &["eq1 is in W/m"]);
    }
    assert_trouble(
        &raypencil(path, &["drive", "small.toml", "--to", "60,0"]),
        &[
            "the route (drive.waypoints_m, --to) is off the ground after 23.70 m, at (23.10, 0.00) m",
            "ground under every wheel",
        ],
    );
    assert_trouble(
        &raypencil(path, &["drive", "small.toml", "--rule", "gaps=paper"]),
        &["expected one of start"],
    );
    assert_trouble(
        &raypencil(path, &["drive", "small.toml", "--rule", "gap=exact"]),
        &["gap=paper or gap=mended"],
    );
    assert_trouble(
        &raypencil(path, &["drive", "small.toml", "--rule", "gap=paper", "--rule", "gap=mended"]),
        &["--rule gap is given twice"],
    );
    assert_trouble(
        &raypencil(path, &["drive", "small.toml", "--at", "100,0"]),
        &["no ground under the vehicle"],
    );
    // A height would put the vehicle above the ground that is missing, and a drive needs ground.
    let off = raypencil(path, &["drive", "small.toml", "--set", "vehicle.position_m=[100,0]"]);
    assert_trouble(&off, &["no ground under (100, 0); expected a place within x"]);
    assert!(!String::from_utf8_lossy(&off.stderr).contains("third number"));
    let off = raypencil(path, &["validate", "small.toml", "--set", "vehicle.position_m=[100,0]"]);
    assert_trouble(&off, &["no ground under (100, 0)", "or a height as the third number"]);
    assert_trouble(
        &raypencil(path, &["drive", "small.toml", "--with", "nobody"]),
        &["there is no such renderer"],
    );
    assert_trouble(
        &raypencil(path, &["drive", "small.toml", "--both", "--with", "tracer"]),
        &["cannot be used with"],
    );
    assert!(!path.join("out").exists());
    // A file cannot be written: the summary of an earlier run is gone, and no file is half written.
    screen(path, &["drive", "small.toml", "-o", "here"], 0);
    std::fs::remove_file(path.join("here/local-map.npy")).unwrap();
    std::fs::create_dir(path.join("here/local-map.npy")).unwrap();
    assert_trouble(
        &raypencil(path, &["drive", "small.toml", "-o", "here"]),
        &["local-map.npy: cannot write"],
    );
    assert!(!path.join("here/summary.json").exists());
    let left = std::fs::read_dir(path.join("here")).unwrap();
    let names: Vec<_> = left.map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned()).collect();
    assert!(names.iter().all(|name| !name.ends_with(".part")), "{names:?}");
}

/// A tracer with light in a pixel that has none.
struct Bright(raypencil::harness::Contender);

impl Renderer for Bright {
    fn name(&self) -> &str {
        "tracer"
    }

    fn precision(&self) -> Precision {
        Precision::F64
    }

    fn render(&self, scene: &Scene, request: &Request) -> RenderOutput {
        let mut output = self.0.renderer.render(scene, request);
        output.flux.iter_mut().for_each(|image| image.set(30, 10, 1e-9));
        output
    }
}

#[test]
fn a_difference_is_exit_code_1() {
    let folder = folder();
    let registry = |name: &str| {
        let own = contender(name)?;
        Some(if name == "tracer" { Bright(own).into() } else { own })
    };
    let scene = folder.path().join("small.toml");
    let here = folder.path().join("here");
    let words = ["raypencil", "drive", scene.to_str().unwrap(), "--both", "-o", here.to_str().unwrap()];
    let code = raypencil_cli::main_with(words.map(Into::into), &registry);
    assert_eq!(code, ExitCode::from(1));
    let summary = std::fs::read(here.join("summary.json")).unwrap();
    let summary: serde_json::Value = serde_json::from_slice(&summary).unwrap();
    // Two beams in seven frames.
    assert_eq!(summary["differences"]["pixels"]["differ"], 14);
    let first = summary["differences"]["pixels"]["first"].as_str().unwrap();
    assert!(first.starts_with("frame 0, beam 0, pixel 30,10: 0 DN against"), "{first}");
}

#[test]
fn a_wrong_drive_is_marked_in_the_scene_file() {
    let folder = folder();
    let path = folder.path().join("wrong.toml");
    std::fs::write(&path, "version = 1\n[drive]\nwaypoints_m = [[1, 0]]\nspeed_m_per_s = -1\n").unwrap();
    let output = raypencil(folder.path(), &["drive", "wrong.toml"]);
    assert_trouble(&output, &["wrong.toml:4:17", "`drive.speed_m_per_s` is -1; expected"]);
    assert!(!text(&output.stderr).contains("panicked"));
}

#[test]
fn a_recording_is_driven_again_by_its_own_stripes() {
    let folder = folder();
    let path = folder.path();
    let said = |words: &[&str]| -> serde_json::Value {
        let words = [&["drive", "small.toml"], words, &["--json"]].concat();
        serde_json::from_str(&screen(path, &words, 0)).expect("JSON")
    };
    let first = said(&["--record", "points,png", "-o", "a"]);
    assert_eq!(first["arguments"], "small.toml --record points,png");
    assert!(first["edge_points"].as_u64().unwrap() > 100, "{}", first["edge_points"]);
    let again = said(&["--stripes", "a/recording", "-o", "b"]);
    for key in ["edge_points", "points_off_ground", "map", "sectors", "truth"] {
        assert_eq!(first[key], again[key], "{key}");
    }
    let images = std::fs::read_dir(path.join("a/recording/images")).unwrap().count();
    assert_eq!(images, 2 * 7);
    // What was not asked for is not written; the small files are.
    assert!(!path.join("b/recording/images").exists() && path.join("b/recording/poses.csv").is_file());
    assert_trouble(&raypencil(path, &["drive", "small.toml", "--record", "film"]), &["film", "images"]);
    assert_trouble(&raypencil(path, &["drive", "small.toml", "--stripes", "none"]), &["none", "stripes.npy"]);
    // Rubbish in place of stripes.
    std::fs::write(path.join("a/recording/stripes.npy"), "frame,step").unwrap();
    assert_trouble(&raypencil(path, &["drive", "small.toml", "--stripes", "a/recording"]), &["stripes.npy"]);
}
