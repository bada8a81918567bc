//! Output folders: of two runs, of a run with fewer files, of packs, and folders that cannot be written.

use std::fs;
use std::path::Path;

use tempfile::TempDir;

use super::{assert_trouble, raypencil, screen};

/// A folder with a scene of this many beams.
fn scene(folder: &Path, beams: usize) {
    let beam = "[[beam]]\ncolumns = 8\nrows = 2\n";
    let text = format!(
        "version = 1\n[camera]\nwidth_px = 8\nheight_px = 6\npixel_pitch_um = 1000\npitch_down_deg = \
         40\n[terrain]\nbuiltin = \"pyramids\"\n{}",
        beam.repeat(beams)
    );
    fs::write(folder.join("scene.toml"), text).unwrap();
}

fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> =
        fs::read_dir(folder).unwrap().map(|one| one.unwrap().file_name().into_string().unwrap()).collect();
    names.retain(|name| !name.starts_with('.'));
    names.sort();
    names
}

#[test]
fn a_run_leaves_nothing_of_an_earlier_one_and_all_of_others() {
    let folder = TempDir::new().unwrap();
    let folder = folder.path();
    for line in [
        &["render", "scene.toml", "--with", "tracer", "-o", "out"][..],
        &["validate", "scene.toml", "-o", "all"],
    ] {
        let out = folder.join(line[line.len() - 1]);
        let maps = if line[0] == "render" { out.clone() } else { out.join("tracer") };
        scene(folder, 3);
        screen(folder, line, 0);
        assert!(maps.join("beam-2.exr").exists());
        fs::write(maps.join("beam-7.exr"), "of somebody else").unwrap();
        scene(folder, 2);
        screen(folder, line, 0);
        let left: Vec<String> = names(&maps).into_iter().filter(|name| name.starts_with("beam-")).collect();
        assert_eq!(left, ["beam-0.exr", "beam-1.exr", "beam-7.exr"], "{line:?}");
    }
}

#[test]
fn a_folder_into_which_another_run_writes_is_refused() {
    let folder = TempDir::new().unwrap();
    let folder = folder.path();
    scene(folder, 1);
    let run = raypencil::io::OutputFolder::begin(&folder.join("out")).unwrap();
    for line in [
        &["render", "scene.toml", "--with", "tracer", "-o", "out"][..],
        &["validate", "scene.toml", "-o", "out"],
        &["drive", "scene.toml", "--to", "1,0", "-o", "out"],
        &["minimise", "scene.toml", "-o", "out"],
        &["check", "nowhere", "nowhere", "-o", "out"],
        &["diff", "scene.toml", "scene.toml", "-o", "out"],
        &["pack", "scene.toml", "--no-bench", "-o", "out"],
        &["pack", "--input", "-o", "out"],
    ] {
        assert_trouble(&raypencil(folder, line), &["out: another run is writing into it"]);
    }
    assert_eq!(names(&folder.join("out")), Vec::<String>::new());
    run.finish().unwrap();
    screen(folder, &["render", "scene.toml", "--with", "tracer", "-o", "out"], 0);
}

#[test]
fn a_pack_is_not_mixed_with_maps() {
    let folder = TempDir::new().unwrap();
    let folder = folder.path();
    scene(folder, 1);
    screen(folder, &["pack", "scene.toml", "--no-bench", "-o", "pack"], 0);
    let before = names(&folder.join("pack"));
    for line in [
        &["render", "scene.toml", "--with", "tracer", "-o", "pack"][..],
        &["validate", "scene.toml", "-o", "pack"],
        &["check", "pack", "pack", "-o", "pack"],
    ] {
        assert_trouble(&raypencil(folder, line), &["pack: it is a pack", "expected another folder"]);
    }
    assert_eq!(names(&folder.join("pack")), before);
    screen(folder, &["check", "pack", "pack"], 0);
}

#[test]
fn a_folder_that_cannot_be_written_is_found_before_anything_is_computed() {
    let folder = TempDir::new().unwrap();
    let folder = folder.path();
    scene(folder, 1);
    // A candidate that is not there is found later than the folder, and a rendering later still.
    let line = ["validate", "scene.toml", "--candidate", "nowhere", "-o", "scene.toml/out"];
    assert_trouble(&raypencil(folder, &line), &["scene.toml/out: cannot create the folder"]);
    let line = ["check", "nowhere", "nowhere", "-o", "scene.toml/out"];
    assert_trouble(&raypencil(folder, &line), &["scene.toml/out: cannot create the folder"]);
}
