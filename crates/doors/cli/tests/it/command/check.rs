//! `pack` and `check`: what passes, what fails and where, and what is refused.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Output;

use raypencil::Image;
use raypencil::io::{
    ExrMap, Limits, Raster, Values, read_channels, read_exr, write_exr, write_npy, write_pfm,
};
use tempfile::TempDir;

use super::{assert_trouble, raypencil, screen, text};

/// A pack of this repository.
pub(crate) fn pack(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../data/packs").join(name)
}

/// A folder with `mine`: the tracer's maps of a pack's scene.
pub(crate) fn folder(name: &str) -> TempDir {
    let folder = TempDir::new().expect("a temporary folder");
    let scene = pack(name).join("scene.toml");
    let output =
        raypencil(folder.path(), &["render", &scene.to_string_lossy(), "--with", "tracer", "-o", "mine"]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    folder
}

pub(crate) fn check(folder: &Path, name: &str, more: &[&str]) -> Output {
    let pack = pack(name);
    let mut arguments = vec!["check".to_string(), pack.to_string_lossy().into_owned(), "mine".into()];
    arguments.extend(more.iter().map(ToString::to_string));
    raypencil(folder, &arguments.iter().map(String::as_str).collect::<Vec<_>>())
}

/// Changes one EXR of the candidate.
pub(crate) fn edit(folder: &TempDir, file: &str, change: impl FnOnce(&mut ExrMap)) {
    let path = folder.path().join("mine").join(file);
    let mut map = read_exr(&path, &Limits::default()).expect("what was rendered");
    change(&mut map);
    write_exr(&path, &map).expect("written");
}

pub(crate) fn reals<'a>(map: &'a mut ExrMap, channel: &str) -> &'a mut Image<f32> {
    match map.channels.get_mut(channel) {
        Some(Raster::F32(image)) => image,
        _ => panic!("no reals in {channel}"),
    }
}

#[track_caller]
pub(crate) fn assert_passes(output: &Output) {
    assert_eq!(output.status.code(), Some(0), "{}{}", text(&output.stdout), text(&output.stderr));
}

#[track_caller]
pub(crate) fn assert_fails(output: &Output, words: &[&str]) {
    let screen = text(&output.stdout);
    assert_eq!(output.status.code(), Some(1), "{screen}{}", text(&output.stderr));
    for word in words {
        assert!(screen.contains(word), "`{word}` is not in:\n{screen}");
    }
}

#[test]
fn an_error_of_two_ulp_is_found_and_named() {
    let folder = folder("pyramids");
    assert_passes(&check(folder.path(), "pyramids", &[]));
    edit(&folder, "camera.exr", |map| {
        let range = reals(map, "range.T");
        let value = range.at(40, 50);
        assert!(value.is_finite());
        range.set(40, 50, value.next_up().next_up());
    });
    let output = check(folder.path(), "pyramids", &["--arithmetic", "f64", "-o", "out"]);
    assert_fails(&output, &["camera pixel 40,50, range", "--pixel 40,50", "1 of 10,482 rays is wrong"]);
    let probe = format!("raypencil probe {}", pack("pyramids").join("scene.toml").display());
    assert_fails(&output, &[&probe]);

    let json: serde_json::Value =
        serde_json::from_str(&fs::read_to_string(folder.path().join("out/check.json")).unwrap()).unwrap();
    assert_eq!(json["verdict"], "defects");
    assert_eq!(json["classes"]["defects"], 1);
    assert_eq!(json["bundles"][0]["worst_defects"][0]["quantity"], "range");
    let junit = fs::read_to_string(folder.path().join("out/junit.xml")).unwrap();
    assert!(junit.contains("failures=\"1\"") && junit.contains("camera pixel 40,50"), "{junit}");
    let page = fs::read_to_string(folder.path().join("out/report.html")).unwrap();
    assert!(page.contains("1 of 10,482 rays is wrong") && page.contains("camera pixel 40,50"), "{page}");
    // The printed command shows the ray.
    let repro = raypencil(
        folder.path(),
        &["probe", &pack("pyramids").join("scene.toml").to_string_lossy(), "--pixel", "40,50"],
    );
    assert_passes(&repro);
    // In single precision an error of two ulp is within the bound.
    assert_passes(&check(folder.path(), "pyramids", &["--arithmetic", "f32"]));
}

#[test]
fn every_quantity_is_checked() {
    let spoil: [(&str, &str, f32); 10] = [
        ("camera.exr", "depth.Z", 1.0 + 1e-6),
        ("camera.exr", "P.X", 1.0 + 1e-6),
        ("camera.exr", "N.Z", 1.0 + 1e-6),
        ("camera.exr", "incidence.V", 1.0 + 1e-6),
        ("camera.exr", "flux.beam1", 1.0 + 1e-6),
        ("beam-0.exr", "range.T", 1.0 + 1e-6),
        ("beam-0.exr", "view.Z", 1.0 + 1e-6),
        ("beam-1.exr", "offAxis.V", 1.0 + 1e-6),
        ("beam-1.exr", "emission.V", 1.0 + 1e-6),
        ("beam-1.exr", "flux.V", 1.0 + 1e-6),
    ];
    let folder = folder("facets");
    let clean = folder.path().join("clean");
    fs::rename(folder.path().join("mine"), &clean).unwrap();
    for (file, channel, factor) in spoil {
        let mine = folder.path().join("mine");
        let _ = fs::remove_dir_all(&mine);
        fs::create_dir(&mine).unwrap();
        for entry in fs::read_dir(&clean).unwrap() {
            let entry = entry.unwrap();
            fs::copy(entry.path(), mine.join(entry.file_name())).unwrap();
        }
        edit(&folder, file, |map| {
            let image = reals(map, channel);
            let at = image.cells().iter().position(|value| value.is_finite() && *value != 0.0).unwrap();
            image.cells_mut()[at] *= factor;
        });
        let output = check(folder.path(), "facets", &[]);
        assert_fails(&output, &[" wrong."]);
    }
    // Discrete quantities: a wrong face, a neighbour of the true pixel, a visible hit that is called hidden.
    for (file, change) in [
        ("camera.exr", (|map| shift(map, "face.I")) as Change),
        ("beam-0.exr", |map| shift(map, "pixel.I")),
        ("beam-0.exr", |map| {
            let image = reals(map, "visible.V");
            let at = image.cells().iter().position(|value| *value == 1.0).unwrap();
            image.cells_mut()[at] = 0.0;
        }),
    ] {
        let mine = folder.path().join("mine");
        fs::copy(clean.join("camera.exr"), mine.join("camera.exr")).unwrap();
        fs::copy(clean.join("beam-0.exr"), mine.join("beam-0.exr")).unwrap();
        fs::copy(clean.join("beam-1.exr"), mine.join("beam-1.exr")).unwrap();
        edit(&folder, file, change);
        assert_fails(&check(folder.path(), "facets", &[]), &[" wrong."]);
    }
}

/// A change of a recording.
type Change = fn(&mut ExrMap);

/// Changes the first index of a channel to its neighbour.
fn shift(map: &mut ExrMap, channel: &str) {
    let Some(Raster::U32(image)) = map.channels.get_mut(channel) else { panic!("no wholes in {channel}") };
    let at = image.cells().iter().position(|index| *index != u32::MAX).unwrap();
    let index = &mut image.cells_mut()[at];
    *index = if *index > 0 { *index - 1 } else { 1 };
}

#[test]
fn absent_channels_are_not_compared_and_unknown_ones_are_named() {
    let folder = folder("pyramids");
    edit(&folder, "camera.exr", |map| {
        map.channels.remove("incidence.V");
        let range = map.channels["range.T"].clone();
        map.insert("rangeOfMine", range);
    });
    fs::remove_file(folder.path().join("mine/beam-1.exr")).unwrap();
    let output = check(folder.path(), "pyramids", &[]);
    assert_passes(&output);
    let screen = text(&output.stdout);
    assert!(screen.contains("Unknown channel, not compared: camera/rangeOfMine"), "{screen}");
    // 6,912 pixels without incidence, 512 pencils without anything.
    let row = |name: &str| screen.lines().find(|line| line.starts_with(name)).unwrap().to_string();
    assert!(row("incidence").contains("7,424"), "{screen}");
    assert!(row("range").contains(" 512 "), "{screen}");

    // An unknown channel alone leaves nothing to compare: an error, not a pass.
    let only = folder.path().join("mine/camera.exr");
    let mut map = read_exr(&only, &Limits::default()).unwrap();
    map.channels.retain(|name, _| name == "rangeOfMine");
    write_exr(&only, &map).unwrap();
    for beam in [0, 2, 3, 4, 5, 6, 7, 8] {
        fs::remove_file(folder.path().join(format!("mine/beam-{beam}.exr"))).unwrap();
    }
    assert_trouble(
        &check(folder.path(), "pyramids", &[]),
        &["no channel of this scene", "found camera.exr (96 x 72): rangeOfMine (single)"],
    );
}

#[test]
fn any_value_that_is_not_finite_means_no_hit() {
    let folder = folder("pyramids");
    // The sky of the pack's camera: +Inf in ranges and depths, NaN in the others.
    let others = [f32::NAN, f32::NEG_INFINITY, f32::INFINITY];
    let mut changed = 0;
    edit(&folder, "camera.exr", |map| {
        for channel in ["range.T", "depth.Z", "P.X", "P.Y", "P.Z", "incidence.V"] {
            for (index, cell) in reals(map, channel).cells_mut().iter_mut().enumerate() {
                if !cell.is_finite() {
                    (*cell, changed) = (others[index % 3], changed + 1);
                }
            }
        }
    });
    assert!(changed > 6 * 100, "{changed} cells of the sky");
    let exact = "✓ 10,482 rays agree with the exact answers";
    let output = check(folder.path(), "pyramids", &[]);
    assert_passes(&output);
    assert!(text(&output.stdout).contains(exact), "{}", text(&output.stdout));
    // Without faces the ranges themselves tell which rays hit.
    edit(&folder, "camera.exr", |map| {
        map.channels.remove("face.I");
    });
    let output = check(folder.path(), "pyramids", &[]);
    assert_passes(&output);
    assert!(text(&output.stdout).contains(exact), "{}", text(&output.stdout));
    // A hit that is declared a miss this way is still found.
    edit(&folder, "camera.exr", |map| {
        for channel in ["range.T", "depth.Z", "P.X", "P.Y", "P.Z", "incidence.V", "N.X", "N.Y", "N.Z"] {
            reals(map, channel).set(40, 50, f32::NAN);
        }
    });
    assert_fails(&check(folder.path(), "pyramids", &[]), &["camera pixel 40,50"]);
}

#[test]
fn broken_conventions_are_named_with_their_cell() {
    let cases: [(Change, &[&str]); 6] = [
        (
            |map| reals(map, "range.T").set(40, 50, f32::NAN),
            &["camera.exr", "`range.T` at 40,50", "NaN", "face.I"],
        ),
        (|map| reals(map, "P.Y").set(40, 50, f32::NAN), &["`P.Y` at 40,50", "NaN"]),
        (|map| reals(map, "range.T").set(40, 50, f32::INFINITY), &["`range.T` at 40,50", "inf"]),
        (|map| reals(map, "range.T").set(0, 0, 3.0), &["`range.T` at 0,0", "3", "+Inf"]),
        (|map| reals(map, "flux.beam0").set(1, 2, f32::NAN), &["`flux.beam0` at 1,2", "NaN"]),
        (
            |map| {
                map.channels.remove("N.Y");
            },
            &["camera/N.Y", "absent", "N.X, N.Y, N.Z"],
        ),
    ];
    let folder = folder("pyramids");
    let file = folder.path().join("mine/camera.exr");
    let clean = fs::read(&file).unwrap();
    for (change, words) in cases {
        fs::write(&file, &clean).unwrap();
        edit(&folder, "camera.exr", change);
        assert_trouble(&check(folder.path(), "pyramids", &[]), words);
    }
    // Another size, a truncated file, a missing folder.
    let small = Image::filled(95, 72, 1.0_f32);
    let mut map = ExrMap::new(95, 72);
    map.insert("range.T", Raster::F32(small));
    write_exr(&file, &map).unwrap();
    assert_trouble(&check(folder.path(), "pyramids", &[]), &["95 x 72", "96 x 72"]);
    fs::write(&file, &clean[..clean.len() / 2]).unwrap();
    assert_trouble(&check(folder.path(), "pyramids", &[]), &["camera.exr"]);
    fs::remove_dir_all(folder.path().join("mine")).unwrap();
    assert_trouble(&check(folder.path(), "pyramids", &[]), &["mine"]);
}

#[test]
fn a_folder_of_several_recordings_is_refused_by_name() {
    let folder = folder("pyramids");
    let scene = pack("pyramids").join("scene.toml");
    let scene = scene.to_string_lossy();
    fs::rename(folder.path().join("mine"), folder.path().join("tracer")).unwrap();
    fs::create_dir(folder.path().join("mine")).unwrap();
    fs::rename(folder.path().join("tracer"), folder.path().join("mine/tracer")).unwrap();
    raypencil(folder.path(), &["render", &scene, "--with", "scanline", "-o", "mine/scanline"]);
    assert_trouble(&check(folder.path(), "pyramids", &[]), &["2 recordings, scanline, tracer", "name one"]);
}

#[test]
fn a_changed_pack_is_refused() {
    let folder = folder("pyramids");
    let copy = folder.path().join("pack");
    copy_tree(&pack("pyramids"), &copy);
    let check = || raypencil(folder.path(), &["check", "pack", "mine"]);
    // Files that the manifest does not list are ignored.
    fs::write(copy.join("camera/rubbish.exr"), b"rubbish").unwrap();
    fs::write(copy.join("camera/range.T.pfm"), b"rubbish").unwrap();
    assert_passes(&check());
    let range = copy.join("camera/range.T.npy");
    let clean = fs::read(&range).unwrap();
    let mut bytes = clean.clone();
    *bytes.last_mut().unwrap() ^= 1;
    fs::write(&range, &bytes).unwrap();
    assert_trouble(&check(), &["range.T.npy", "changed after it was written"]);
    fs::remove_file(&range).unwrap();
    assert_trouble(&check(), &["range.T.npy"]);
    fs::write(&range, &clean).unwrap();

    // If the manifest is changed as well, the referee notices: every range is the next number up.
    let shape = read_channels(&range, &Limits::default()).unwrap();
    let Values::Reals(image) = &shape.by_key["range.T"].values else { panic!("reals") };
    let up = image.cells().iter().map(|x| if x.is_finite() { x.next_up() } else { *x }).collect();
    write_npy(&range, &[&Image::from_cells(96, 72, up)]).unwrap();
    let manifest = copy.join("manifest.json");
    let document = fs::read_to_string(&manifest).unwrap();
    let mut json: serde_json::Value = serde_json::from_str(&document).unwrap();
    let digest =
        raypencil::pack::ManifestFile::of(&copy, "camera/range.T.npy", raypencil::pack::FileRole::Answers);
    for file in json["files"].as_array_mut().unwrap() {
        if file["path"] == "camera/range.T.npy" {
            file["sha256"] = digest.as_ref().unwrap().sha256.clone().into();
        }
    }
    fs::write(&manifest, json.to_string()).unwrap();
    // It still calls itself the published version.
    assert_trouble(&check(), &["says that it is pyramids 2.0.0", "as it is published, or another version"]);
    json["version"] = "1.0.1".into();
    fs::write(&manifest, json.to_string()).unwrap();
    assert_trouble(&check(), &["is not the referee's", "camera pixel"]);
    fs::remove_file(&manifest).unwrap();
    assert_trouble(&check(), &["manifest.json"]);
}

fn copy_tree(from: &Path, to: &Path) {
    fs::create_dir_all(to).unwrap();
    for entry in fs::read_dir(from).unwrap() {
        let entry = entry.unwrap();
        let target = to.join(entry.file_name());
        if entry.path().is_dir() {
            copy_tree(&entry.path(), &target)
        } else {
            fs::copy(entry.path(), target).map(|_| ()).unwrap()
        }
    }
}

#[test]
fn a_blind_pack_has_no_answers_and_can_be_checked() {
    let folder = TempDir::new().unwrap();
    let blind = folder.path().join("blind");
    // A blind pack that replaces a pack with answers removes those answers.
    copy_tree(&pack("pyramids"), &blind);
    assert!(blind.join("camera/range.T.npy").exists() && blind.join("camera.exr").exists());
    // It does so only if it is told to.
    let replaced = raypencil(folder.path(), &["pack", "--blind", "7", "-o", "blind"]);
    assert_trouble(&replaced, &["blind: it has results of a pack of pyramids, version 2.0.0", "--force"]);
    assert!(blind.join("camera/range.T.npy").exists());
    assert_passes(&raypencil(folder.path(), &["pack", "--blind", "7", "-o", "blind", "--force"]));
    assert!(!blind.join("camera/range.T.npy").exists());
    let mut names: Vec<String> = fs::read_dir(&blind)
        .unwrap()
        .map(Result::unwrap)
        .filter(|entry| entry.path().is_file())
        .map(|entry| entry.file_name().into_string().unwrap())
        .collect();
    names.sort();
    let expected = [
        "manifest.json",
        "rays-beam-0.npy",
        "rays-beam-1.npy",
        "rays-beam-2.npy",
        // The beams of the bench.
        "rays-beam-3.npy",
        "rays-beam-4.npy",
        "rays-beam-5.npy",
        "rays-beam-6.npy",
        "rays-beam-7.npy",
        "rays-beam-8.npy",
        "rays-beam-9.npy",
        "rays-camera.npy",
        "scene.toml",
        "terrain.glb",
    ];
    assert_eq!(names, expected);
    // That both renderers pass blind packs is held by `clauses`; here it is the command's way that counts.
    let render = ["render", "blind/scene.toml", "--with", "tracer", "-o", "tracer"];
    assert_passes(&raypencil(folder.path(), &render));
    let output = raypencil(folder.path(), &["check", "blind", "tracer"]);
    assert_passes(&output);
    assert!(text(&output.stdout).contains("blind-7 (blind)"), "{}", text(&output.stdout));
    // A seed that does not give this terrain is noticed.
    let manifest = fs::read_to_string(blind.join("manifest.json")).unwrap();
    let lied = manifest.replace("\"blindSeed\": 7", "\"blindSeed\": 8");
    assert_ne!(lied, manifest);
    fs::write(blind.join("manifest.json"), lied).unwrap();
    assert_trouble(&raypencil(folder.path(), &["check", "blind", "tracer"]), &["seed 8"]);
    assert_trouble(&raypencil(folder.path(), &["pack", "--blind", "8", "facets", "-o", "x"]), &["--blind"]);
}

#[test]
fn arrays_are_judged_by_their_stored_type() {
    let folder = folder("pyramids");
    let channels = read_channels(pack("pyramids"), &Limits::default()).unwrap();
    let mine = folder.path().join("mine");
    fs::remove_dir_all(&mine).unwrap();
    fs::create_dir_all(mine.join("camera")).unwrap();
    let reals = |key: &str| match &channels.by_key[key].values {
        Values::Reals(image) => image.clone(),
        Values::Wholes(_) => panic!("{key} is whole"),
    };
    // The exact answers in double precision; then one cell with a relative error of 1e-13, which nothing explains.
    let range = reals("camera/range.T");
    write_npy(mine.join("camera/range.T.npy"), &[&range]).unwrap();
    assert_passes(&check(folder.path(), "pyramids", &[]));
    let mut off = range.clone();
    off.set(40, 50, range.at(40, 50) * (1.0 + 1e-13));
    write_npy(mine.join("camera/range.T.npy"), &[&off]).unwrap();
    assert_fails(&check(folder.path(), "pyramids", &[]), &["camera pixel 40,50, range"]);
    fs::remove_file(mine.join("camera/range.T.npy")).unwrap();
    // In single precision as PFM, which stores the bottom row first.
    let single = |image: &Image<f64>| {
        Image::from_cells(image.width(), image.height(), image.cells().iter().map(|x| *x as f32).collect())
    };
    write_pfm(mine.join("camera/range.T.pfm"), &[&single(&range)]).unwrap();
    assert_passes(&check(folder.path(), "pyramids", &[]));
    // The flux image without the pencils: compared with the sums over the exact pencils.
    fs::remove_file(mine.join("camera/range.T.pfm")).unwrap();
    let flux = reals("camera/flux.beam0");
    write_npy(mine.join("camera/flux.beam0.npy"), &[&single(&flux)]).unwrap();
    let output = check(folder.path(), "pyramids", &[]);
    assert_passes(&output);
    let mut off = single(&flux);
    let at = off.cells().iter().position(|value| *value > 0.0).unwrap();
    off.cells_mut()[at] *= 1.001;
    write_npy(mine.join("camera/flux.beam0.npy"), &[&off]).unwrap();
    assert_fails(&check(folder.path(), "pyramids", &[]), &["pixel flux"]);
}

#[test]
fn the_pack_is_a_candidate_for_itself() {
    let folder = TempDir::new().unwrap();
    let pack = pack("facets");
    let output = raypencil(folder.path(), &["check", &pack.to_string_lossy(), &pack.to_string_lossy()]);
    assert_passes(&output);
    let screen = text(&output.stdout);
    // Everything is there, for both flux models, without an error of even one ulp.
    assert!(!screen.contains("Not compared") && !screen.contains("Unknown"), "{screen}");
    let range = screen.lines().find(|line| line.starts_with("range")).unwrap();
    assert!(range.split_whitespace().any(|cell| cell == "0"), "{screen}");
    let json =
        raypencil(folder.path(), &["check", &pack.to_string_lossy(), &pack.to_string_lossy(), "--json"]);
    let json: serde_json::Value = serde_json::from_str(&text(&json.stdout)).unwrap();
    for sensor in json["bundles"].as_array().unwrap() {
        for quantity in sensor["quantities"].as_array().unwrap() {
            let ulps = &quantity["worst_ulp"]["value"];
            assert!(ulps.is_null() || *ulps == 0.0, "{quantity}");
            assert_eq!(quantity["not_compared"], 0, "{quantity}");
        }
    }
}

#[test]
fn the_referee_rules_on_a_difference_of_two_recordings() {
    let folder = folder("pyramids");
    let scene = pack("pyramids").join("scene.toml");
    let scene = scene.to_string_lossy();
    raypencil(folder.path(), &["render", &scene, "--with", "scanline", "-o", "theirs"]);
    let diff = |more: &[&str]| {
        let all: Vec<&str> = ["diff", "mine", "theirs"].into_iter().chain(more.iter().copied()).collect();
        raypencil(folder.path(), &all)
    };
    // Heights near 0 may differ by any number of ulps, and neither side is wrong.
    assert_fails(&diff(&["--fail-ulp", "1"]), &["P.Z"]);
    assert_passes(&diff(&["--fail-ulp", "1", "--scene", &scene]));
    // A wrong range is a fault of one side, which is named.
    edit(&folder, "camera.exr", |map| {
        let range = reals(map, "range.T");
        let value = range.at(40, 50);
        range.set(40, 50, value * 1.001);
    });
    // The hard limit applies whichever side is right.
    assert_fails(&diff(&["--fail-ulp", "1e9", "--hard-fail", "0", "--scene", &scene]), &["P.Z"]);
    let output = diff(&["--fail-ulp", "1", "--scene", &scene, "-o", "out"]);
    assert_fails(&output, &["referee on camera/range.T: 1 A wrong, B right", "A, camera pixel 40,50"]);
    let json: serde_json::Value =
        serde_json::from_str(&fs::read_to_string(folder.path().join("out/summary.json")).unwrap()).unwrap();
    let ruled = json["rulings"]["channels"].as_array().unwrap();
    let range = ruled.iter().find(|channel| channel["key"] == "camera/range.T").unwrap();
    assert_eq!(range["faults"], 1);
}

/// A candidate of this repository: the recording of a scene by another renderer.
fn recording(renderer: &str, scene: &str) -> String {
    let candidates = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../data/candidates");
    candidates.join(renderer).join(scene).to_string_lossy().into_owned()
}

#[test]
fn candidate_json_states_the_precision() {
    let folder = TempDir::new().expect("a temporary folder");
    let (pack, embree) = (pack("pyramids").to_string_lossy().into_owned(), recording("embree", "pyramids"));
    let found = screen(folder.path(), &["check", &pack, &embree], 0);
    assert!(found.contains("arithmetic f32"), "{found}");
    screen(folder.path(), &["check", &pack, &embree, "--arithmetic", "f64"], 1);
}

#[test]
fn a_recording_of_another_scene_or_with_a_broken_candidate_json_is_refused() {
    let folder = TempDir::new().expect("a temporary folder");
    let (pack, facets) = (pack("pyramids").to_string_lossy().into_owned(), recording("embree", "facets"));
    let other_scene = ["candidates/embree/facets", "candidate.json is of the scene", "expected"];
    assert_trouble(&raypencil(folder.path(), &["check", &pack, &facets]), &other_scene);
    let scene = format!("{pack}/scene.toml");
    let validate = ["validate", &scene, "--candidate", &facets, "-o", "out"];
    assert_trouble(&raypencil(folder.path(), &validate), &other_scene);
    assert!(!folder.path().join("out").exists(), "nothing was written");

    let mine = folder.path().join("mine/camera");
    fs::create_dir_all(&mine).expect("a folder");
    fs::copy(
        Path::new(&recording("embree", "pyramids")).join("camera/range.T.npy"),
        mine.join("range.T.npy"),
    )
    .expect("a file");
    fs::write(folder.path().join("mine/candidate.json"), r#"{"format": 1, "arithmetic": 32}"#)
        .expect("a file");
    assert_trouble(
        &raypencil(folder.path(), &["check", &pack, "mine"]),
        &["mine/candidate.json", "arithmetic: 32; expected \"f32\" or \"f64\""],
    );
}

#[test]
fn candidates_are_evaluated_beside_the_renderers() {
    let folder = TempDir::new().expect("a temporary folder");
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../data/scenes/facets-small.toml");
    let scene = scene.to_string_lossy().into_owned();
    let (embree, mitsuba) = (recording("embree", "facets-small"), recording("mitsuba", "facets-small"));
    let found = screen(
        folder.path(),
        &["validate", &scene, "--candidate", &embree, "--candidate", &mitsuba, "-o", "out"],
        // Mitsuba loses a shadow, and its images by one integrator are biased: a wrong candidate fails.
        1,
    );
    let wrong = "1 of 2 candidates is wrong: Mitsuba 3 on 1 of 7,936 rays, 2 of 4 images";
    assert!(found.contains(wrong), "{found}");
    assert!(found.contains("Embree 4: 0 of 7,936 rays wrong"), "{found}");
    assert!(
        found.contains("Mitsuba 3: 1 of 7,936 rays wrong; 2 of 4 images, 4 of 4 radiances fit"),
        "{found}"
    );
    // The missed ray is written as a pack.
    let miss = folder.path().join("out/misses/mitsuba-3-1");
    assert!(miss.join("README.md").exists() && miss.join("manifest.json").exists());
    assert!(!folder.path().join("out/misses/mitsuba-3-2").exists());

    // Candidates may fail: the verdict stays, the exit code is 0. A right candidate passes.
    let may_fail = ["validate", &scene, "--candidate", &mitsuba, "--candidates-must-pass=false", "-o", "may"];
    let found = screen(folder.path(), &may_fail, 0);
    assert!(found.contains("Candidate Mitsuba 3 is wrong on 1 of 7,936 rays, 2 of 4 images, and may be"));
    let right = ["validate", &scene, "--candidate", &embree, "--candidates-must-pass", "-o", "right"];
    let found = screen(folder.path(), &right, 0);
    assert!(found.contains("candidate Embree 4 agrees on 7,936 rays"), "{found}");
}

#[test]
fn a_probe_shows_what_a_candidate_says_and_what_is_true() {
    let folder = folder("pyramids");
    edit(&folder, "camera.exr", |map| {
        map.channels.remove("incidence.V");
        let range = reals(map, "range.T");
        range.set(40, 64, range.at(40, 64) + 0.5);
    });
    let scene = pack("pyramids").join("scene.toml").to_string_lossy().into_owned();
    let pixel = ["probe", &scene, "--pixel", "40,64", "--with", "tracer", "--candidate", "mine"];
    let said = screen(folder.path(), &pixel, 0);
    // docs/guide/for-implementers.md derives the range of this pixel. The file holds 3.0014... in single precision.
    let line =
        |words: &str| said.lines().find(|line| line.contains(words)).unwrap_or_else(|| panic!("{said}"));
    assert!(line("mine (candidate)").ends_with("defect (the true hit)"), "{said}");
    let range = line("    range: says 3.0014");
    assert!(range.contains("true is 2.501464924112324 m, off by 5.000e-1 m") && range.ends_with(": defect"));
    assert!(line("    depth: says 2.386").ends_with(": agrees"), "{said}");
    assert!(line("    incidence: not given, true is 0.59").contains("not given"), "{said}");
    assert!(said.ends_with("--candidate mine\n"), "{said}");

    let json = raypencil(folder.path(), &[&pixel[..], &["--json"]].concat());
    let json: serde_json::Value = serde_json::from_slice(&json.stdout).expect("JSON");
    let mine = &json["candidates"][0];
    assert_eq!((&mine["name"], &mine["class"]), (&"mine".into(), &"defect".into()));
    assert_eq!(
        (&mine["quantities"][2]["quantity"], &mine["quantities"][2]["class"]),
        (&"range".into(), &"defect".into())
    );
    assert_eq!(mine["quantities"][6]["said"], serde_json::Value::Null);

    // A pencil, by every quantity of its return.
    let pencil = ["probe", &scene, "--beam", "0", "--pencil", "37,2", "--candidate", "mine"];
    let said = screen(folder.path(), &pencil, 0);
    for words in [
        "mine (candidate): agrees",
        "pixel: says pixel 25,46, true is pixel 25,46: agrees",
        "visible: says seen",
    ] {
        assert!(said.contains(words), "{words}: {said}");
    }
    let other = recording("embree", "facets");
    let refused = raypencil(folder.path(), &["probe", &scene, "--pixel", "1,1", "--candidate", &other]);
    assert_trouble(&refused, &["candidate.json is of the scene"]);
}
