//! `[[rays]]` in a scene: rays of a LiDAR beside camera and beams.

use std::fs;

use raypencil::io::{Limits, read_npy_numbers, write_npy_numbers};
use raypencil_tests::schema::schema_faults;
use serde_json::Value;
use tempfile::TempDir;

use super::{assert_trouble, raypencil, screen};

/// A small camera and no beams on the pyramids, and two sets: one ray straight down from 2 m above the vehicle, and a
/// raster to the front.
const SCENE: &str = "version = 1
beam = []
[vehicle]
position_m = [0.5, 0.25, 0]
heading_deg = 90
[camera]
width_px = 16
height_px = 12
pixel_pitch_um = 500
[[rays]]
name = \"down\"
spinning = { elevations_deg = [-90], steps = 1 }
position_m = [1, 0, 2]
[[rays]]
name = \"front\"
grid = { columns = 12, rows = 8, width_deg = 60, height_deg = 40 }
position_m = [0, 0, 1]
pitch_down_deg = 20
sides = \"fronts\"
";

fn folder(scene: &str) -> TempDir {
    let folder = TempDir::new().expect("a temporary folder");
    fs::write(folder.path().join("lidar.toml"), scene).expect("a file");
    folder
}

#[test]
fn validate_holds_the_tracer_to_the_exact_answers() {
    let folder = folder(SCENE);
    let shown = screen(folder.path(), &["validate", "lidar.toml", "-o", "out"], 0);
    for line in [
        "rays down: 1 ray, 1 hit; tracer: 1 same, 0 rounding, 0 wrong",
        "rays front: 96 rays, ",
        // 16 x 12 pixels, 1 ray and 12 x 8.
        "All 289 rays agree.",
    ] {
        assert!(shown.contains(line), "{shown}");
    }
    let summary = fs::read_to_string(folder.path().join("out/summary.json")).expect("a summary");
    let summary: Value = serde_json::from_str(&summary).expect("JSON");
    let schema = include_str!("../../../../../../docs/formats/summary.schema.json");
    let schema: Value = serde_json::from_str(schema).expect("JSON");
    assert_eq!(schema_faults(&schema, &summary), Vec::<String>::new());
    assert_eq!((&summary["compared"], &summary["ray_sets"][0]["hits"]), (&289.into(), &1.into()));
    // The vehicle stands at (0.5, 0.25) and looks along y: one metre before it is (0.5, 1.25). The ground is z = 0 there, or
    // a pyramid's side; the ray starts 2 m above the vehicle.
    let read = |path: &str| read_npy_numbers(folder.path().join(path), &Limits::default()).expect("an array");
    let (point, range) = (read("out/rays/down/point.npy"), read("out/rays/down/range.npy"));
    let below = [0.5, 1.25, 2.0 - range.values[0]];
    assert!(point.values.iter().zip(below).all(|(a, b)| (a - b).abs() < 1e-12), "{point:?}");
    assert_eq!(read("out/rays/front/face.npy").shape, [8, 12]);
    for file in ["summary.md", "junit.xml", "report.html"] {
        let text = fs::read_to_string(folder.path().join("out").join(file)).expect("a file");
        assert!(text.contains("96 rays") || text.contains("rays front"), "{file}");
    }
    assert!(folder.path().join("out/rays/front/cloud.ply").is_file());
}

#[test]
fn without_the_tracer_the_sets_are_not_compared() {
    let folder = folder(SCENE);
    let shown =
        screen(folder.path(), &["validate", "lidar.toml", "--with", "scanline,referee", "-o", "out"], 0);
    assert!(shown.contains("not compared, only the tracer answers them"), "{shown}");
    assert!(shown.contains("All 192 rays agree."), "{shown}");
}

#[test]
fn render_writes_the_sets_of_a_renderer_that_answers_them() {
    let folder = folder(SCENE);
    let read =
        |path: &str| read_npy_numbers(folder.path().join(path), &Limits::default()).expect("an array").values;
    let shown = screen(folder.path(), &["render", "lidar.toml", "--with", "tracer", "-o", "traced"], 0);
    assert!(shown.contains("traced/rays/front/summary.json"), "{shown}");
    screen(folder.path(), &["render", "lidar.toml", "--with", "referee", "-o", "exact"], 0);
    let [traced, exact] = ["traced", "exact"].map(|name| read(&format!("{name}/rays/front/t.npy")));
    assert!(traced.iter().any(|t| t.is_finite()));
    assert!(traced.iter().zip(&exact).all(|(a, b)| a == b || (a - b).abs() < 1e-12));
    let shown = screen(folder.path(), &["render", "lidar.toml", "--with", "scanline", "-o", "drawn"], 0);
    assert!(
        shown.contains("scanline answers rays of cameras and beams only; not answered: 2 sets of rays"),
        "{shown}"
    );
    assert!(!folder.path().join("drawn/rays").exists());
}

/// Makes the range and t of one ray of the set `front` longer by a thousandth.
fn lengthen_a_ray(candidate: &std::path::Path) {
    for name in ["t", "range"] {
        let path = candidate.join(format!("rays/front/{name}.npy"));
        let mut array = read_npy_numbers(&path, &Limits::default()).expect("an array");
        let hit = array.values.iter_mut().find(|t| t.is_finite()).expect("a hit");
        *hit *= 1.001;
        write_npy_numbers(&path, &array.shape, &array.values).expect("a file");
    }
}

#[test]
fn a_pack_has_the_sets_and_a_check_rules_on_them() {
    let folder = folder(SCENE);
    let at = folder.path();
    let shown = screen(at, &["pack", "lidar.toml", "--no-bench", "-o", "pack"], 0);
    assert!(shown.contains("rays down: 1 ray; 1 hit, 0 of them at a tie, 0 miss"), "{shown}");
    screen(at, &["render", "lidar.toml", "--with", "tracer", "-o", "traced"], 0);
    let shown = screen(at, &["check", "pack", "traced"], 0);
    assert!(shown.contains("289 rays agree with the exact answers"), "{shown}");
    assert!(shown.lines().any(|line| line.starts_with("rays/front ") && line.contains(" 96 ")), "{shown}");
    // One wrong ray of a set fails the check, though all pixels agree.
    lengthen_a_ray(&at.join("traced"));
    let shown = screen(at, &["check", "pack", "traced", "-o", "checked"], 1);
    assert!(shown.contains("1 of 289 rays is wrong") && shown.contains("rays/front "), "{shown}");
    let document: Value =
        serde_json::from_str(&screen(at, &["--json", "check", "pack", "traced"], 1)).expect("JSON");
    let schema: Value =
        serde_json::from_str(include_str!("../../../../../../docs/formats/check.schema.json")).expect("JSON");
    assert_eq!(schema_faults(&schema, &document), Vec::<String>::new());
    let bundle = |name: &str| {
        let bundles = document["bundles"].as_array().expect("bundles");
        bundles.iter().find(|bundle| bundle["name"] == name).expect("a bundle").clone()
    };
    assert_eq!(bundle("rays/front")["classes"]["defects"], 1);
    assert_eq!(bundle("rays/down")["classes"]["agree"], 1);
    assert_eq!(bundle("rays/front")["worst_defects"].as_array().map(Vec::len), Some(1));
    let junit = fs::read_to_string(at.join("checked/junit.xml")).expect("a file");
    assert!(junit.contains("rays/front") && junit.contains("rays/down"), "{junit}");
    assert!(at.join("checked/rays/front/check.json").is_file());
    // What is not given is told, and is no mistake.
    fs::remove_dir_all(at.join("traced/rays/front")).expect("a folder");
    let shown = screen(at, &["check", "pack", "traced"], 0);
    assert!(shown.contains("Not compared, because not given: rays/front"), "{shown}");
    // A set that was changed is found, by its own list or by that of the pack.
    let rays = at.join("pack/rays/front/rays.npy");
    let mut bytes = fs::read(&rays).expect("a file");
    *bytes.last_mut().expect("a byte") ^= 1;
    fs::write(&rays, bytes).expect("a file");
    screen(at, &["render", "lidar.toml", "--with", "tracer", "-o", "traced"], 0);
    assert_trouble(&raypencil(at, &["check", "pack", "traced"]), &["pack/rays/front/rays.npy"]);
    fs::remove_file(at.join("pack/rays/down/raypack.json")).expect("a file");
    assert_trouble(&raypencil(at, &["check", "pack", "traced"]), &["rays/down/raypack.json"]);
}

#[test]
fn validate_judges_the_sets_of_a_candidate_as_check_does() {
    let folder = folder(SCENE);
    let at = folder.path();
    screen(at, &["pack", "lidar.toml", "--no-bench", "-o", "pack"], 0);
    screen(at, &["render", "lidar.toml", "--with", "tracer", "-o", "traced"], 0);
    let validated = ["validate", "lidar.toml", "--candidate", "traced", "-o", "out"];
    let shown = screen(at, &validated, 0);
    // 16 x 12 pixels, 1 ray and 12 x 8.
    assert!(shown.contains("candidate traced agrees on 289 rays"), "{shown}");
    lengthen_a_ray(&at.join("traced"));
    let checked = screen(at, &["check", "pack", "traced"], 1);
    let shown = screen(at, &validated, 1);
    assert!(shown.contains("Candidate traced is wrong on 1 of 289 rays"), "{shown}");
    // The place and the words of the wrong ray are those of `check`.
    let words = |shown: &str| {
        let line =
            shown.lines().find(|line| line.trim_start().starts_with("rays/front ") && line.contains(" t "));
        line.or(shown.lines().find(|line| line.contains("first hit:"))).map(str::trim).map(String::from)
    };
    assert!(words(&shown).is_some() && words(&checked).is_some(), "{shown}\n{checked}");
    let summary = fs::read_to_string(at.join("out/summary.json")).expect("a summary");
    let summary: Value = serde_json::from_str(&summary).expect("JSON");
    let schema = include_str!("../../../../../../docs/formats/summary.schema.json");
    let schema: Value = serde_json::from_str(schema).expect("JSON");
    assert_eq!(schema_faults(&schema, &summary), Vec::<String>::new());
    let theirs = summary["panel"]["renderers"].as_array().and_then(|all| all.last()).expect("a candidate");
    assert_eq!(
        (&theirs["compared"], &theirs["wrong"], &theirs["passes"]),
        (&289.into(), &1.into(), &false.into())
    );
    let document: Value =
        serde_json::from_str(&screen(at, &["--json", "check", "pack", "traced"], 1)).expect("JSON");
    let bundle = document["bundles"].as_array().and_then(|all| all.last()).expect("a bundle");
    assert_eq!(theirs["ray_sets"][1]["classes"], bundle["classes"]);
    assert_eq!(theirs["ray_sets"][1]["quantities"][0]["classes"], bundle["quantities"][0]["classes"]);
    for file in ["summary.md", "junit.xml", "report.html"] {
        let text = fs::read_to_string(at.join("out").join(file)).expect("a file");
        assert!(text.contains("rays/front") || text.contains("rays front"), "{file}");
    }
    // The command of the wrong ray shows it, by a pack that it makes itself.
    let command = theirs["ray_sets"][1]["worst_defects"][0]["command"].as_str().expect("a command");
    let (first, then) = command.split_once(" && ").expect("two commands");
    for line in [first.replace("-o pack", "-o again"), then.replace("pack/rays", "again/rays")] {
        let words: Vec<&str> = line.split(' ').skip(1).collect();
        screen(at, &words, 0);
    }
    // A set of another shape is refused before anything is rendered, and one that is not there is told.
    write_npy_numbers(at.join("traced/rays/front/t.npy"), &[5], &[1.0; 5]).expect("a file");
    assert_trouble(&raypencil(at, &validated), &["traced/rays/front/t.npy: shape: [5]; expected [8, 12]"]);
    fs::remove_dir_all(at.join("traced/rays/front")).expect("a folder");
    let shown = screen(at, &validated, 0);
    assert!(shown.contains("agrees on 193 rays") && shown.contains("not given: rays/front"), "{shown}");
}

/// Answers that nobody would judge: to a set under another name, and to the sets of a pack by its scene, which has none.
#[test]
fn answers_to_a_set_that_is_not_asked_for_are_refused() {
    let folder = folder(SCENE);
    screen(folder.path(), &["pack", "lidar.toml", "--no-bench", "-o", "pack"], 0);
    screen(folder.path(), &["render", "lidar.toml", "--with", "tracer", "--format", "npy", "-o", "mine"], 0);
    screen(folder.path(), &["check", "pack", "mine"], 0);
    screen(folder.path(), &["validate", "lidar.toml", "--candidate", "mine"], 0);
    let refused = |line: &[&str], words: &[&str]| assert_trouble(&raypencil(folder.path(), line), words);
    refused(
        &["validate", "pack/scene.toml", "--candidate", "mine"],
        &["answers to a set `down`", "expected no sets of rays", "raypencil check PACK CANDIDATE"],
    );
    let sets = folder.path().join("mine/rays");
    fs::rename(sets.join("front"), sets.join("Front")).expect("another name");
    for line in [&["check", "pack", "mine"][..], &["validate", "lidar.toml", "--candidate", "mine"]] {
        refused(line, &["mine/rays/Front", "answers to a set `Front`", "expected answers to down, front"]);
    }
    // What has no arrays answers nothing.
    fs::rename(sets.join("Front"), sets.join("front")).expect("its name");
    fs::create_dir(sets.join("notes")).expect("a folder");
    fs::write(sets.join("notes/read.txt"), "mine").expect("a file");
    screen(folder.path(), &["check", "pack", "mine"], 0);
}

#[test]
fn a_candidate_of_sets_of_rays_alone_is_judged() {
    let folder = folder(SCENE);
    let at = folder.path();
    screen(at, &["pack", "lidar.toml", "--no-bench", "-o", "pack"], 0);
    screen(at, &["render", "lidar.toml", "--with", "tracer", "-o", "traced"], 0);
    fs::create_dir_all(at.join("mine/rays/front")).expect("a folder");
    fs::copy(at.join("traced/rays/front/t.npy"), at.join("mine/rays/front/t.npy")).expect("a file");
    let shown = screen(at, &["check", "pack", "mine"], 0);
    assert!(shown.contains("96 rays agree") && shown.contains("not given: rays/down"), "{shown}");
    let shown = screen(at, &["validate", "lidar.toml", "--candidate", "mine", "-o", "out"], 0);
    assert!(shown.contains("candidate mine agrees on 96 rays"), "{shown}");
    let shown = screen(at, &["diff", "mine", "traced", "--shared-only"], 0);
    assert!(shown.contains("1 channel"), "{shown}");
    // Of a pack without sets, and of sets of other names, nothing is given.
    fs::rename(at.join("mine/rays/front"), at.join("mine/rays/other")).expect("a folder");
    assert_trouble(
        &raypencil(at, &["validate", "lidar.toml", "--candidate", "mine"]),
        &["mine/rays/other", "answers to a set `other`; expected answers to down, front"],
    );
    let pyramids = super::check::pack("pyramids").to_string_lossy().into_owned();
    assert_trouble(&raypencil(at, &["check", &pyramids, "mine"]), &["mine: folder: no maps"]);
}

#[test]
fn diff_compares_the_sets_too() {
    let folder = folder(SCENE);
    let at = folder.path();
    for name in ["a", "b"] {
        screen(at, &["render", "lidar.toml", "--with", "tracer", "-o", name], 0);
    }
    let shown = screen(at, &["--json", "diff", "a", "b"], 0);
    assert!(shown.contains("rays/front/point.X") && shown.contains("rays/down/face"), "{shown}");
    lengthen_a_ray(&at.join("b"));
    let shown = screen(at, &["diff", "a", "b", "-o", "difference"], 1);
    assert!(shown.contains("rays/front/range") && shown.contains("rays/front/t "), "{shown}");
    // The scene's sensors are ruled on; sets are compared all the same.
    screen(at, &["diff", "a", "b", "--scene", "lidar.toml"], 1);
    // A set by itself: its arrays, not its pictures, which two programs draw in other colours and sizes.
    assert!(at.join("a/rays/front/top.png").is_file());
    fs::write(at.join("b/rays/front/top.png"), fs::read(at.join("b/rays/front/range.png")).expect("a file"))
        .expect("a file");
    screen(at, &["diff", "a/rays/front", "a/rays/front"], 0);
    let shown = screen(at, &["diff", "a/rays/front", "b/rays/front", "--fail-relative", "0.01"], 0);
    assert!(!shown.contains("top") && !shown.contains("range.X"), "{shown}");
    // With margins: arrays of four dimensions; flat ones too.
    fs::write(at.join("g.obj"), "v -9 -9 0\nv 9 -9 0\nv 0 9 0\nf 1 2 3\n").expect("a file");
    fs::write(at.join("rays.csv"), "0,0,1,0,0,-1\n0,1,1,0,0,-1\n").expect("a file");
    let grid = "[[rays]]\nname = \"one\"\ngrid = { columns = 4, rows = 3, width_deg = 9, height_deg = 9 }\npitch_down_deg = 90\nposition_m = [0, 0, 2]\n";
    fs::write(at.join("grid.toml"), grid).expect("a file");
    for (rays, out) in [("rays.csv", "flat"), ("grid.toml", "raster")] {
        screen(at, &["cast", "g.obj", rays, "--margins", "--all", "-o", out], 0);
        let shown = screen(at, &["--json", "diff", out, out], 0);
        assert!(shown.contains("across.1.Z") && shown.contains("all.face"), "{shown}");
    }
    // All hits are compared, too.
    fs::create_dir(at.join("other")).expect("a folder");
    for name in ["t.npy", "all.t.npy"] {
        fs::copy(at.join("flat").join(name), at.join("other").join(name)).expect("a file");
    }
    write_npy_numbers(at.join("other/all.t.npy"), &[2], &[1.0, 2.0]).expect("a file");
    let shown = screen(at, &["diff", "flat", "other", "--shared-only"], 1);
    assert!(shown.contains("all.t"), "{shown}");
    // Sets on one side only are named.
    fs::remove_dir_all(at.join("b/rays")).expect("a folder");
    let shown = screen(at, &["diff", "a", "b"], 1);
    assert!(shown.contains("rays/down/cos_incidence"), "{shown}");
}

#[test]
fn a_wrong_set_is_an_error_with_its_place() {
    let folder = folder(&format!("{SCENE}[[rays]]\nname = \"front\"\ngrid = {{ preset = \"l515\" }}\n"));
    let output = raypencil(folder.path(), &["validate", "lidar.toml"]);
    assert_trouble(&output, &["lidar.toml:21:8", "`rays 2.name` is \"front\", the name of another set"]);
}

#[test]
fn patterns_become_packs_of_rays() {
    let folder = TempDir::new().expect("a temporary folder");
    let cube = "v 0 0 0\nv 4 0 0\nv 0 4 0\nf 1 2 3\n";
    fs::write(folder.path().join("floor.obj"), cube).expect("a file");
    let set = |name: &str, sides: &str| {
        format!(
            "[[rays]]\nname = \"{name}\"\nspinning = {{ elevations_deg = [-90], steps = 1 }}\nposition_m = [1, 1, 2]\n\
             roll_right_deg = 0\nsides = \"{sides}\"\n"
        )
    };
    fs::write(folder.path().join("one.toml"), set("down", "both")).expect("a file");
    fs::write(folder.path().join("two.toml"), set("a", "both") + &set("b", "fronts")).expect("a file");
    let shown = screen(folder.path(), &["pack", "floor.obj", "--rays", "one.toml", "-o", "one"], 0);
    assert!(shown.starts_with("one: the pack of 1 ray; 1 hit"), "{shown}");
    let shown = screen(folder.path(), &["pack", "floor.obj", "--rays", "two.toml", "-o", "two"], 0);
    assert!(
        shown.contains("two/a: the pack of 1 ray; 1 hit") && shown.contains("two/b: the pack of 1 ray"),
        "{shown}"
    );
    // What `cast` answers to the same pattern passes each of them.
    screen(folder.path(), &["cast", "floor.obj", "one.toml", "-o", "answers"], 0);
    for pack in ["one", "two/a"] {
        screen(folder.path(), &["check", pack, "answers"], 0);
    }
    let sides = |pack: &str| {
        let document: Value =
            serde_json::from_slice(&fs::read(folder.path().join(pack).join("raypack.json")).expect("a pack"))
                .expect("a document");
        document["sides"].as_str().expect("sides").to_string()
    };
    assert_eq!(["one", "two/a", "two/b"].map(sides), ["both", "both", "fronts"]);
    let shown =
        screen(folder.path(), &["pack", "floor.obj", "--rays", "two.toml", "-o", "json", "--json"], 0);
    let document: Value = serde_json::from_str(&shown).expect("a document");
    assert_eq!(document["packs"][1]["pack"], "json/b");
    let wrong = raypencil(folder.path(), &["pack", "floor.obj", "--rays", "none.toml", "-o", "none"]);
    assert_trouble(&wrong, &["none.toml"]);
}

#[test]
fn clouds_of_cast_are_right_in_their_own_frame_and_told_in_another() {
    let folder = folder(SCENE);
    let at = |name: &str, text: &str| fs::write(folder.path().join(name), text).expect("a file");
    // A prism that lies along no axis, and a head that drives past it.
    at("prism.obj", "v 3 -2 -1\nv 3.5 4 -1\nv 4 0 3\nv -4 -3 -1\nf 1 2 3\nf 1 4 2\n");
    let head = "spinning = { elevations_deg = [2, -20, -9], steps = 40, firing_times_us = [0, 500, 900] }\n";
    let poses = "poses = [{ time_s = 0, position_m = [0, 0, 0.5] }, \
                 { time_s = 0.1, position_m = [1, 0.25, 0.5], yaw_left_deg = 20 }]\n";
    at("moving.toml", &format!("[[rays]]\nname = \"moving\"\n{head}{poses}"));
    screen(folder.path(), &["pack", "prism.obj", "--rays", "moving.toml", "-o", "pack"], 0);
    screen(folder.path(), &["cast", "prism.obj", "moving.toml", "--bag", "velodyne", "-o", "cast"], 0);
    let of_frames = [
        ("cloud.pcd", "mesh"),
        ("cloud-sensor.pcd", "sensor"),
        ("cloud-start.pcd", "start"),
        ("cloud-end.pcd", "end"),
    ];
    for (file, frame) in of_frames {
        let file = format!("cast/{file}");
        let shown = screen(folder.path(), &["check", "pack", &file, "--frame", frame], 0);
        assert!(shown.contains("laid on the rays by ring and time. Judged: x, y, z, which rays have a point, and the fields ring, time, range"), "{shown}");
    }
    // Compressed, the same clouds; and scan by scan.
    let packed = ["--pcd", "binary_compressed", "-o", "packed"];
    screen(folder.path(), &[&["cast", "prism.obj", "moving.toml"][..], &packed].concat(), 0);
    screen(folder.path(), &["check", "pack", "packed/cloud-end.pcd", "--frame", "end"], 0);
    let text = fs::read(folder.path().join("packed/cloud-end.pcd")).expect("a file");
    assert!(String::from_utf8_lossy(&text).contains("\nDATA binary_compressed\n"));
    screen(folder.path(), &["cast", "prism.obj", "moving.toml", "--scans", "40", "-o", "scans"], 0);
    let [of_scan, alone] = ["scans/scans/000000.pcd", "cast/cloud-sensor.pcd"]
        .map(|name| fs::read(folder.path().join(name)).expect("a file"));
    assert!(of_scan == alone, "a scan of all is the set");
    let bag = "cast/rosbag/rosbag_0.mcap";
    let of_bag = ["check", "pack", bag, "--frame", "sensor"];
    let shown = screen(folder.path(), &[&of_bag[..], &["--topic", "/points", "--message", "1"]].concat(), 0);
    assert!(shown.contains(" points of message 1 of /points in the frame of the sensor"), "{shown}");
    assert_trouble(
        &raypencil(folder.path(), &[&of_bag[..], &["--topic", "/scan"]].concat()),
        &[bag, "topic /scan: no point cloud", "the file has /points (1)"],
    );
    assert_trouble(
        &raypencil(folder.path(), &["check", "pack", "cast/cloud.pcd", "--message", "1"]),
        &["--topic, --message: cast/cloud.pcd is no bag (.mcap); expected neither"],
    );
    assert_trouble(
        &raypencil(folder.path(), &["--max-memory", "10MB", "check", "pack", bag]),
        &["check: 120 rays, 2 faces, 120 points take about"],
    );
    let shown = screen(folder.path(), &["check", "pack", "cast/cloud-start.pcd", "-o", "report"], 1);
    assert!(shown.contains("declare --frame start"), "{shown}");
    let report = fs::read_to_string(folder.path().join("report/check.json")).expect("a file");
    let report: Value = serde_json::from_str(&report).expect("JSON");
    let schema: Value =
        serde_json::from_str(include_str!("../../../../../../docs/formats/check.schema.json")).expect("JSON");
    assert_eq!(schema_faults(&schema, &report), Vec::<String>::new());
    // The points alone, of a sensor that moves: their rays are not known.
    assert_trouble(
        &raypencil(folder.path(), &["check", "pack", "cast/cloud.ply"]),
        &["cloud.ply", "belong to no ray that is known", "`ring` (or `channel`) and `time`"],
    );
    assert_trouble(
        &raypencil(folder.path(), &["check", "pack", "cast", "--frame", "mesh"]),
        &["cast is no point cloud (.pcd, .ply, .mcap)"],
    );
    // A bag's folder, a pack that is not there, and a pack that takes no clouds.
    assert_trouble(
        &raypencil(folder.path(), &["check", "pack", "cast/rosbag", "--frame", "sensor"]),
        &["cast/rosbag is no point cloud", "give rosbag_0.mcap in it"],
    );
    assert_trouble(
        &raypencil(folder.path(), &["check", "nothing", "cast/cloud.pcd", "--frame", "mesh"]),
        &["nothing"],
    );
    at("rays.csv", "0,0,0, 1,0,0\n");
    screen(folder.path(), &["pack", "prism.obj", "--rays", "rays.csv", "-o", "rays"], 0);
    assert_trouble(
        &raypencil(folder.path(), &["check", "rays", "cast/cloud.pcd", "--frame", "sensor"]),
        &["--frame sensor", "a pack of a sensor's scan"],
    );
    // A scan whose poses were changed is another one.
    let poses = folder.path().join("pack/pose.npy");
    let mut bytes = fs::read(&poses).expect("a file");
    *bytes.last_mut().expect("a byte") ^= 1;
    fs::write(&poses, bytes).expect("a file");
    assert_trouble(&raypencil(folder.path(), &["check", "pack", "cast/cloud.pcd"]), &["pose.npy", "SHA-256"]);
}
