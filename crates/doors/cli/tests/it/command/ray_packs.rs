//! Packs of rays, and what people give to be checked against them.

use std::fs;
use std::path::Path;

use raypencil::io::{Limits, read_npy_numbers, write_npy_numbers};
use tempfile::TempDir;

use super::{assert_trouble, raypencil, screen};

/// A floor of 8 m by 8 m, and a pack of four rays of which three hit it, with answers in the folder `answers`.
fn folder() -> TempDir {
    let folder = TempDir::new().expect("a temporary folder");
    let at = |name: &str, text: &str| fs::write(folder.path().join(name), text).expect("a file");
    at("floor.obj", "v -4 -4 0\nv 4 -4 0\nv 4 4 0\nv -4 4 0\nf 1 2 3\nf 1 3 4\n");
    at("rays.csv", "1,0.5,3,0,0,-2\n-1,0.25,3,0.125,0,-2\n9,0,3,0,0,-1\n0.7,-0.3,5,0.1,0.2,-3\n");
    screen(folder.path(), &["pack", "floor.obj", "--rays", "rays.csv", "-o", "pack"], 0);
    screen(folder.path(), &["cast", "floor.obj", "rays.csv", "-o", "answers"], 0);
    folder
}

/// Changes the numbers of an array of the answers.
fn change(folder: &Path, name: &str, by: impl Fn(f64) -> f64) {
    let path = folder.join("answers").join(format!("{name}.npy"));
    let array = read_npy_numbers(&path, &Limits::default()).expect("an array");
    let numbers: Vec<f64> = array.values.into_iter().map(by).collect();
    write_npy_numbers(&path, &array.shape, &numbers).expect("a file");
}

#[test]
fn hits_alone_are_not_called_exact_answers() {
    let folder = folder();
    let at = folder.path();
    fs::create_dir(at.join("hits")).expect("a folder");
    let hits = |hits: &[u8]| write_npy_numbers(at.join("hits/hit.npy"), &[4], hits).expect("a file");
    hits(&[1, 1, 0, 1]);
    let note = "Not compared, because not given: face, t, range";
    let said = "4 rays hit or miss as the exact answers say; nothing is known about face, t and range, which were not given.";
    let shown = screen(at, &["check", "pack", "hits", "-o", "out"], 0);
    assert!(shown.contains(said) && shown.contains(note) && !shown.contains(" exact, "), "{shown}");
    let summary = fs::read_to_string(at.join("out/check.json")).expect("a summary");
    let summary: serde_json::Value = serde_json::from_str(&summary).expect("JSON");
    let told: Vec<_> = summary["bundles"][0]["quantities"].as_array().expect("a list").iter().collect();
    let not_given =
        |key: &str| told.iter().any(|item| item["quantity"] == key && item["not_given"] == "not given");
    assert!(["face", "t", "range"].into_iter().all(not_given) && !not_given("hit"), "{summary:#}");
    for file in ["report.html", "summary.md"] {
        let text = fs::read_to_string(at.join("out").join(file)).expect("a file");
        assert!(text.contains(said) && text.contains(note), "{file}: {text}");
    }
    hits(&[1, 1, 1, 1]);
    let shown = screen(at, &["check", "pack", "hits"], 1);
    assert!(shown.contains("1 of 4 rays is wrong") && shown.contains(note), "{shown}");
    // With distances too, these are.
    hits(&[1, 1, 0, 1]);
    fs::copy(at.join("answers/t.npy"), at.join("hits/t.npy")).expect("a file");
    let shown = screen(at, &["check", "pack", "hits"], 0);
    assert!(shown.contains("4 rays agree with the exact answers") && !shown.contains(note), "{shown}");
}

#[test]
fn one_ray_agrees_alone() {
    let folder = folder();
    let at = folder.path();
    fs::write(at.join("one.csv"), "1,0.5,3,0,0,-2\n").expect("a file");
    screen(at, &["pack", "floor.obj", "--rays", "one.csv", "-o", "one"], 0);
    screen(at, &["cast", "floor.obj", "one.csv", "-o", "one-answers"], 0);
    let shown = screen(at, &["check", "one", "one-answers"], 0);
    assert!(shown.contains("1 ray agrees with the exact answers"), "{shown}");
}

#[test]
fn the_note_of_answers_to_rays_is_followed() {
    let folder = folder();
    let at = folder.path();
    let note = |keys: &str| {
        let text = format!("{{\"format\": 1, \"program\": \"mine 2\", \"arithmetic\": \"f32\"{keys}}}");
        fs::write(at.join("answers/candidate.json"), text).expect("a file");
    };
    let check = ["check", "pack", "answers"];
    screen(at, &check, 0);
    // What single precision computes, -5 where nothing is hit, and faces of another order.
    for name in ["t", "range"] {
        change(at, name, |length| if length.is_finite() { length * (1.0 + 1e-7) } else { -5.0 });
    }
    change(at, "face", |face| 1.0 - face.min(1.0));
    let plain = [&check[..], &["--miss", "-5", "--no-faces"]].concat();
    screen(at, &check, 1);
    screen(at, &plain, 1);
    screen(at, &[&plain[..], &["--arithmetic", "f32"]].concat(), 0);
    note(", \"miss\": -5, \"no_faces\": true");
    let shown = screen(at, &check, 0);
    assert!(shown.contains("✓ 4 rays agree with the exact answers"), "{shown}");
    // An option counts more.
    screen(at, &[&check[..], &["--arithmetic", "f64"]].concat(), 1);
    screen(at, &[&check[..], &["--miss", "-6"]].concat(), 1);
    for (keys, words) in [
        (", \"miss\": \"high\"", "miss: \"high\"; expected a number or \"nan\""),
        (", \"scale\": 0.001", "scale: 0.001; expected no channels and no scale"),
        (", \"channels\": {\"range.T\": \"V\"}", "channels: range.T: V; expected no channels and no scale"),
    ] {
        note(keys);
        assert_trouble(&raypencil(at, &check), &["candidate.json", words]);
    }
}

#[test]
fn what_is_no_answer_to_rays_is_told_by_its_kind() {
    let folder = folder();
    let at = folder.path();
    fs::copy(at.join("rays.csv"), at.join("cloud.xyz")).expect("a file");
    fs::copy(at.join("answers/t.npy"), at.join("t.npy")).expect("a file");
    for (candidate, found) in [
        ("rays.csv", "rays.csv: candidate: a file that ends in .csv; expected a folder with face.npy, t.npy"),
        ("cloud.xyz", "cloud.xyz: candidate: a file that ends in .xyz; expected a folder"),
        (
            "t.npy",
            "t.npy: candidate: one array; expected a folder with face.npy, t.npy, range.npy or hit.npy, or a point cloud",
        ),
        ("pack/raypack.json", "candidate: the list of a pack of rays; expected a folder"),
        ("gone", "gone: cannot read"),
    ] {
        assert_trouble(&raypencil(at, &["check", "pack", candidate]), &[found]);
    }
    // And what is one, where maps of sensors are asked for.
    fs::write(at.join("one.toml"), "[[rays]]\nname = \"a\"\nfile = \"rays.csv\"\n").expect("a file");
    screen(at, &["cast", "floor.obj", "one.toml", "-o", "one"], 0);
    let scenes = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../data/packs/pyramids");
    let scenes = scenes.to_str().expect("a path");
    for (candidate, found) in [
        ("one/cloud.pcd", "one/cloud.pcd: candidate: a point cloud; expected maps of its sensors"),
        ("pack", "pack: candidate: a pack of rays; expected maps of its sensors"),
        ("pack/raypack.json", "candidate: a pack of rays; expected maps of its sensors"),
    ] {
        assert_trouble(&raypencil(at, &["check", scenes, candidate]), &[found, "`pack MESH --rays RAYS`"]);
    }
    let told = "candidate: a pack of a scene, or its input; expected a folder with face.npy";
    assert_trouble(&raypencil(at, &["check", "pack", scenes]), &[told]);
}

#[test]
fn a_file_without_rays_is_refused_with_a_sentence() {
    let folder = folder();
    let at = folder.path();
    write_npy_numbers(at.join("none.npy"), &[0, 6], &[] as &[f64]).expect("a file");
    let told = "none.npy: shape: [0, 6]; expected one ray or more";
    assert_trouble(&raypencil(at, &["cast", "floor.obj", "none.npy"]), &[told]);
    assert_trouble(&raypencil(at, &["cast", "floor.obj", "none.npy", "--allow-empty", "-o", "out"]), &[told]);
    assert_trouble(&raypencil(at, &["pack", "floor.obj", "--rays", "none.npy", "-o", "empty"]), &[told]);
    assert!(!at.join("out").exists() && !at.join("empty/raypack.json").exists());
    // Columns are told by their names.
    let text =
        "dx,dy,dz,ox,oy,oz\n0,0,-2,1,0.5,3\n0.125,0,-2,-1,0.25,3\n0,0,-1,9,0,3\n0.1,0.2,-3,0.7,-0.3,5\n";
    fs::write(at.join("named.csv"), text).expect("a file");
    screen(at, &["cast", "floor.obj", "named.csv", "-o", "named"], 0);
    screen(at, &["check", "pack", "named"], 0);
    fs::write(at.join("named.csv"), text.replace("dx", "u")).expect("a file");
    let told = "named.csv: line 1: \"u\"; expected a heading of the names ox,oy,oz,dx,dy,dz";
    assert_trouble(&raypencil(at, &["cast", "floor.obj", "named.csv"]), &[told]);
}

/// The shipped patterns over a floor: each form of bag that `cast` writes agrees with the pack of the same pattern. So does a later scan of a
/// bag, whose times are later by what brought the first to 1 s. Seconds, for each form of a pattern has an order and numbers of its own.
#[test]
fn bags_of_a_pattern_agree_with_its_own_pack() {
    let folder = TempDir::new().unwrap();
    let at = folder.path();
    fs::write(at.join("floor.obj"), "v -9 -9 0\nv 9 -9 0\nv 9 9 0.5\nv -9 9 0\nf 1 2 3\nf 1 3 4\n").unwrap();
    let shipped = |name: &str| {
        fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../data/rays").join(name))
            .unwrap()
    };
    let mixed = |start_s: f64, azimuth_deg: f64, steps: u32| {
        format!(
            "[[rays]]\nname = \"mixed\"\nstart_s = {start_s}\nposition_m = [0, 0, 1.2]\nspinning = {{ elevations_deg = [-15, 1, -13, -3], \
             firing_times_us = [0, 20, 30, 50], steps = {steps}, azimuth_step_deg = -3.6, azimuth_start_deg = {azimuth_deg}, rate_hz = 20 }}\n"
        )
    };
    // A part of the turn has each channel as well.
    let head = shipped("vlp16.toml").replace("rate_hz = 10", "rate_hz = 10, steps = 120");
    assert!(head.contains("steps = 120"));
    let patterns = [head, shipped("wide.toml")];
    let agrees = |pack: &str, bag: &str, more: &[&str]| {
        let shown = screen(at, &[&["check", pack, bag, "--frame", "sensor"], more].concat(), 0);
        assert!(shown.contains("rays agree with the exact answers"), "{shown}");
    };
    for (k, pattern) in patterns.iter().enumerate() {
        fs::write(at.join("rays.toml"), pattern).unwrap();
        let pack = format!("pack-{k}");
        screen(at, &["pack", "floor.obj", "--rays", "rays.toml", "-o", &pack], 0);
        for fields in ["velodyne", "ouster", "livox"] {
            let out = format!("{fields}-{k}");
            screen(at, &["cast", "floor.obj", "rays.toml", "--bag", fields, "-o", &out], 0);
            agrees(&pack, &format!("{out}/rosbag/rosbag_0.mcap"), &[]);
        }
    }
    fs::write(at.join("rays.toml"), mixed(0.0, 0.0, 40)).unwrap();
    screen(at, &["cast", "floor.obj", "rays.toml", "--scans", "20", "--bag", "livox", "-o", "scans"], 0);
    fs::write(at.join("second.toml"), mixed(0.01, -72.0, 20)).unwrap();
    screen(at, &["pack", "floor.obj", "--rays", "second.toml", "-o", "second"], 0);
    agrees("second", "scans/rosbag/rosbag_0.mcap", &["--message", "2"]);
}
