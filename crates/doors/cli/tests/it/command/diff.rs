//! `diff`: thresholds, reports, errors.

use std::path::Path;

use raypencil::Image;
use raypencil::io::{Limits, Raster, read_exr, write_exr, write_npy};
use tempfile::TempDir;

use super::{assert_trouble, raypencil, screen, text};

/// A folder with `scanline/` and `tracer/`: the maps of both renderers of the facets with small sensors.
fn rendered() -> TempDir {
    rendered_on("facets")
}

/// The same for any built-in terrain.
fn rendered_on(ground: &str) -> TempDir {
    let folder = TempDir::new().expect("a temporary folder");
    let scene = format!(
        "version = 1\n\
        [camera]\nwidth_px = 64\nheight_px = 48\npixel_pitch_um = 144\n\
        [[beam]]\ncolumns = 64\nrows = 4\n\
        [terrain]\nbuiltin = \"{ground}\"\n"
    );
    std::fs::write(folder.path().join("small.toml"), scene).expect("a scene file");
    for renderer in ["scanline", "tracer"] {
        screen(folder.path(), &["render", "small.toml", "--with", renderer, "-o", renderer], 0);
    }
    folder
}

#[test]
fn a_folder_is_the_same_as_itself() {
    let folder = rendered();
    let screen = screen(folder.path(), &["diff", "tracer", "tracer"], 0);
    // Camera: range, depth, P, N, face, incidence and one beam's flux; the beam: no depth, but visible,
    // pixel I and J and flux.
    assert!(screen.contains("✓ 28 channels compared, the same in every cell."), "{screen}");
    let one = raypencil(folder.path(), &["diff", "tracer/camera.exr", "tracer/camera.exr"]);
    assert!(text(&one.stdout).contains("✓ 11 channels compared"), "{}", text(&one.stdout));
}

#[test]
fn two_renderers_agree_to_a_rounding() {
    let folder = rendered();
    let screen = screen(folder.path(), &["diff", "scanline", "tracer", "--fail-ulp", "1"], 0);
    assert!(screen.contains("✓ 28 channels compared"), "{screen}");
    assert!(screen.contains("Allowed: 1 ulp."), "{screen}");
}

#[test]
fn heights_about_zero_need_an_absolute_threshold() {
    // The pyramids stand on a plane at z = 0. There both renderers compute z with an absolute error of some ulps of
    // the maximum range of 20 m, 20 x 2^-52 = 4.4e-15. Relative to such a small z that can be any number of ulps.
    let folder = rendered_on("pyramids");
    let shown = screen(folder.path(), &["diff", "scanline", "tracer", "--fail-ulp", "1"], 1);
    let failing: Vec<&str> = shown
        .lines()
        .filter(|line| line.contains('/') && !line.starts_with(['!', ' ']))
        .filter_map(|line| line.split_whitespace().next())
        .collect();
    assert_eq!(failing, ["beam-0/P.Z", "camera/P.Z"], "{shown}");
    screen(folder.path(), &["diff", "scanline", "tracer", "--fail-ulp", "1", "--fail", "1e-14"], 0);
}

/// Changes one number of the tracer's `camera.exr`.
fn plant(folder: &Path, channel: &str, i: u32, j: u32, value: f32) {
    let path = folder.join("tracer/camera.exr");
    let mut map = read_exr(&path, &Limits::default()).unwrap();
    let Some(Raster::F32(image)) = map.channels.get_mut(channel) else { panic!("{channel} is of reals") };
    image.set(i, j, value);
    write_exr(&path, &map).unwrap();
}

#[test]
fn no_threshold_allows_a_nan() {
    let folder = rendered();
    plant(folder.path(), "depth.Z", 12, 34, f32::NAN);
    let allow =
        ["diff", "scanline", "tracer", "--fail", "1e9", "--fail-relative", "1e9", "--fail-ulp", "1e9"];
    let shown = screen(folder.path(), &allow, 1);
    assert!(shown.contains("✗ 1 of 28 channels differs."), "{shown}");
    assert!(
        shown.contains("camera/depth.Z")
            && shown.contains("! camera/depth.Z at 12,34: A ")
            && shown.contains("B NaN"),
        "{shown}"
    );
    // One of 3072 cells is 0.0326 percent.
    let with = |more: &[&'static str]| [&allow[..], more].concat();
    screen(folder.path(), &with(&["--fail-percent", "0.033"]), 0);
    screen(folder.path(), &with(&["--fail-percent", "0.032"]), 1);
    screen(folder.path(), &with(&["--fail-percent", "0.033", "--hard-fail", "1e9"]), 1);
}

#[test]
fn a_report_is_written() {
    let folder = rendered();
    plant(folder.path(), "range.T", 3, 40, 1.0);
    let shown = screen(folder.path(), &["diff", "scanline", "tracer", "--fail-ulp", "1", "-o", "out/d"], 1);
    assert!(shown.contains("Report: out/d/report.html"), "{shown}");
    assert!(shown.lines().count() <= 40 && shown.lines().all(|line| line.chars().count() <= 100), "{shown}");
    let read = |name: &str| std::fs::read_to_string(folder.path().join("out/d").join(name)).unwrap();
    assert!(read("report.html").contains("data:image/png;base64,"));
    assert!(read("junit.xml").contains("failures=\"1\""));
    let summary = read("summary.json");
    let json = screen(folder.path(), &["diff", "scanline", "tracer", "--fail-ulp", "1", "--json"], 1);
    assert_eq!(json, summary);
    let summary: serde_json::Value = serde_json::from_str(&summary).unwrap();
    let channels = summary["channels"].as_array().unwrap();
    let range = channels.iter().find(|channel| channel["key"] == "camera/range.T").unwrap();
    assert_eq!(
        (&range["differing"], &range["fails"], &range["unit"]),
        (&1.into(), &true.into(), &"m".into())
    );
    let worst = &range["worst"];
    assert_eq!((&worst["column"], &worst["row"], &worst["b"]), (&3.into(), &40.into(), &1.0.into()));
}

#[test]
fn arrays_and_maps_can_be_compared() {
    let folder = rendered();
    // The tracer's ranges as a NumPy array, and nothing else.
    let map = read_exr(folder.path().join("tracer/camera.exr"), &Limits::default()).unwrap();
    let image = map.channels["range.T"].as_f32().unwrap();
    std::fs::create_dir_all(folder.path().join("mine/camera")).unwrap();
    write_npy(folder.path().join("mine/camera/range.T.npy"), &[image]).unwrap();
    let shown = screen(folder.path(), &["diff", "mine", "tracer"], 1);
    assert!(shown.contains("Only in B: ") && shown.contains("; 27 channels are on one side only"), "{shown}");
    let shown = screen(folder.path(), &["diff", "mine", "tracer", "--shared-only"], 0);
    assert!(shown.contains("✓ 1 channel compared, the same in every cell."), "{shown}");
}

#[test]
fn errors_are_one_clear_message() {
    let folder = rendered();
    assert_trouble(&raypencil(folder.path(), &["diff", "nowhere", "tracer"]), &["nowhere: cannot read"]);
    assert_trouble(
        &raypencil(folder.path(), &["diff", "small.toml", "tracer"]),
        &["small.toml", "expected a folder, or a file"],
    );
    for option in ["--fail", "--fail-relative", "--fail-ulp", "--fail-percent", "--hard-fail"] {
        let out = raypencil(folder.path(), &["diff", "scanline", "tracer", option, "-1"]);
        let said = String::from_utf8_lossy(&out.stderr);
        assert!(out.status.code() == Some(2) && said.contains("'-1'") && said.contains(option), "{said}");
        assert!(!said.contains("-- -1") && !said.contains("unexpected"), "{said}");
    }
    let none = ["no channel is in both", "A has N.X", "B has beam-0/N.X"];
    assert_trouble(&raypencil(folder.path(), &["diff", "tracer/camera.exr", "tracer"]), &none);
    std::fs::create_dir_all(folder.path().join("mine/camera")).unwrap();
    let small = Image::filled(8, 8, 1.0_f64);
    write_npy(folder.path().join("mine/camera/range.T.npy"), &[&small]).unwrap();
    let sizes = ["camera/range.T.npy has 8 x 8", "tracer/camera.exr has 64 x 48", "expected the same size"];
    assert_trouble(&raypencil(folder.path(), &["diff", "mine", "tracer"]), &sizes);
    let own = ["--output tracer: is one of the folders to compare"];
    assert_trouble(&raypencil(folder.path(), &["diff", "scanline", "tracer", "-o", "tracer"]), &own);
    let number = "expected a number of at least 0";
    let share = "expected a percentage from 0 to 100";
    for (option, value, expected) in [
        ("--fail", "-1", number),
        ("--fail-ulp", "nan", number),
        ("--hard-fail", "inf", number),
        ("--fail-percent", "x", share),
        ("--fail-percent", "150", share),
    ] {
        let output = raypencil(folder.path(), &["diff", "scanline", "tracer", &format!("{option}={value}")]);
        assert_eq!(output.status.code(), Some(2));
        assert!(text(&output.stderr).contains(expected), "{}", text(&output.stderr));
    }
}

/// The note of a side is followed: single precision is rounding, and a recording of another scene is none of this one.
#[test]
fn the_referee_follows_the_note_of_each_side() {
    let folder = TempDir::new().expect("a temporary folder");
    let at = folder.path();
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../data");
    let theirs = data.join("candidates/embree/pyramids");
    let mine = at.join("mine");
    let mut folders = vec![theirs.clone()];
    while let Some(from) = folders.pop() {
        let to = mine.join(from.strip_prefix(&theirs).expect("a folder within"));
        std::fs::create_dir(&to).expect("a folder");
        for entry in std::fs::read_dir(&from).expect("a folder").flatten() {
            match entry.path().is_dir() {
                true => folders.push(entry.path()),
                false => drop(std::fs::copy(entry.path(), to.join(entry.file_name())).expect("a file")),
            }
        }
    }
    let scene = data.join("packs/pyramids/scene.toml").to_string_lossy().into_owned();
    let pack = data.join("packs/pyramids").to_string_lossy().into_owned();
    let line = ["diff", pack.as_str(), "mine", "--scene", scene.as_str(), "--shared-only"];
    let told = |more: &[&str], code: i32| screen(at, &[&line[..], more].concat(), code);
    let by_note = told(&[], 0);
    assert!(by_note.contains("B rounding"), "{by_note}");
    assert_eq!(told(&["--arithmetic", "f32"], 0), by_note);
    let doubles = told(&["--arithmetic", "f64"], 1);
    assert!(doubles.contains("B wrong"), "{doubles}");
    let note = mine.join("candidate.json");
    let text = std::fs::read_to_string(&note).expect("a note");
    let (before, after) = text.split_once("\"sha256\": \"").expect("the digest of its scene");
    std::fs::write(&note, format!("{before}\"sha256\": \"{}{}", "0".repeat(64), &after[64..]))
        .expect("a file");
    assert_trouble(&raypencil(at, &line), &["candidate.json"]);
}
