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
fn a_folder_in_place_of_a_record_is_named_before_anything_is_computed() {
    let folder = TempDir::new().unwrap();
    let folder = folder.path();
    scene(folder, 1);
    let sweep =
        ["sweep", "scene.toml", "--set", "camera.pitch_down_deg=30,40", "--do", "render", "-o", "out"];
    screen(folder, &sweep, 0);
    let records = names(&folder.join("out/runs"));
    let last = folder.join("out/runs").join(&records[1]);
    for record in &records {
        fs::remove_file(folder.join("out/runs").join(record)).unwrap();
    }
    fs::create_dir(&last).unwrap();
    let words = [".json: cannot write: it is a folder; expected a file, or nothing: remove it"];
    assert_trouble(&raypencil(folder, &sweep), &words);
    // Nor was the other run made.
    assert_eq!(names(&folder.join("out/runs")), records[1..]);
    fs::remove_dir(&last).unwrap();
    screen(folder, &sweep, 0);
    fs::create_dir_all(folder.join("campaign/terrains/terrain-000000.json")).unwrap();
    let campaign = ["campaign", "--terrains", "1", "-o", "campaign"];
    assert_trouble(&raypencil(folder, &campaign), &words);
}

#[cfg(unix)]
#[test]
fn a_file_beyond_the_limit_of_the_shell_is_an_error() {
    let folder = TempDir::new().unwrap();
    let folder = folder.path();
    scene(folder, 1);
    let program = env!("CARGO_BIN_EXE_raypencil");
    let line = format!("ulimit -f 8; exec '{program}' validate scene.toml -o out");
    let output = std::process::Command::new("sh").args(["-c", &line]).current_dir(folder).output().unwrap();
    assert_trouble(&output, &["out/report.html: cannot write: File too large"]);
    // What was written is listed; nothing is half-written, and there is no mark.
    let mut left: Vec<String> = fs::read_dir(folder.join("out"))
        .unwrap()
        .map(|one| one.unwrap().file_name().into_string().unwrap())
        .collect();
    left.sort();
    assert_eq!(left, [".raypencil-made", "scanline", "tracer"]);
}

#[test]
fn a_sweep_has_its_folder_with_those_who_share_it_alone() {
    let folder = TempDir::new().unwrap();
    let folder = folder.path();
    scene(folder, 1);
    let sweep =
        ["sweep", "scene.toml", "--set", "camera.pitch_down_deg=30", "--do", "render", "-o", "out/sub"];
    let other = raypencil::io::SharedFolder::begin(&folder.join("out/sub")).unwrap();
    let line = ["validate", "scene.toml", "-o", "out/sub"];
    assert_trouble(&raypencil(folder, &line), &["sub: another run is writing into it"]);
    screen(folder, &sweep, 0);
    // One above leaves it alone.
    screen(folder, &["validate", "scene.toml", "-o", "out"], 0);
    drop(other);
    let above = raypencil::io::OutputFolder::begin(&folder.join("out")).unwrap();
    assert_trouble(&raypencil(folder, &sweep), &["out: another run is writing into it"]);
    drop(above);
    screen(folder, &sweep, 0);
}

#[test]
fn results_of_a_sweep_and_of_a_campaign_are_not_replaced_unasked() {
    let folder = TempDir::new().unwrap();
    let folder = folder.path();
    scene(folder, 1);
    let into = |out| {
        let sweep = ["sweep", "scene.toml", "--set", "camera.pitch_down_deg=30", "--do", "render", "-o", out]
            .to_vec();
        let campaign = ["campaign", "--terrains", "1", "-o", out].to_vec();
        let validate = ["validate", "scene.toml", "-o", out].to_vec();
        let pack = ["pack", "scene.toml", "--no-bench", "-o", out].to_vec();
        [sweep, campaign, validate, pack]
    };
    let held = ["results of a sweep of scene.toml", "results of a campaign", "results of `validate` on "];
    for first in 0..3 {
        let out = ["sweep", "campaign", "validate"][first];
        screen(folder, &into(out)[first], 0);
        for other in (0..4).filter(|other| *other != first) {
            let words = [held[first], "expected another folder, or --force"];
            assert_trouble(&raypencil(folder, &into(out)[other]), &words);
        }
        // The same again is no other.
        screen(folder, &into(out)[first], 0);
    }
    let forced = [into("sweep")[2].clone(), vec!["--force"]].concat();
    screen(folder, &forced, 0);
}

#[test]
fn a_sweep_of_another_task_is_not_written_over_one() {
    let folder = TempDir::new().unwrap();
    let folder = folder.path();
    scene(folder, 1);
    let sweep =
        |task| ["sweep", "scene.toml", "--set", "camera.pitch_down_deg=30", "--do", task, "-o", "out"];
    screen(folder, &sweep("render"), 0);
    let words = ["results of a sweep of scene.toml, --do render", "expected another folder, or --force"];
    assert_trouble(&raypencil(folder, &sweep("validate")), &words);
    screen(folder, &sweep("render"), 0);
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
fn a_run_does_not_remove_what_it_reads() {
    let folder = TempDir::new().unwrap();
    let folder = folder.path();
    scene(folder, 1);
    let drive = ["drive", "scene.toml", "--to", "0.3,0", "-o", "out"];
    screen(folder, &[&drive[..], &["--record", "points"]].concat(), 0);
    let stripes = folder.join("out/recording/stripes.npy");
    assert!(stripes.exists());
    let read = ["--stripes", "out/recording"];
    assert_trouble(
        &raypencil(folder, &[&drive[..], &read].concat()),
        &["out/recording: an earlier run has made it in the output folder out", "expected another folder"],
    );
    // All is as it was, and elsewhere it is what was asked for.
    assert!(stripes.exists() && folder.join("out/summary.json").exists());
    screen(folder, &[&drive[..5], &["other"], &read[..]].concat(), 0);
    screen(folder, &drive, 0);
    assert!(!stripes.exists(), "of an earlier run, and read by none");
}

#[test]
fn a_pack_is_not_written_over_the_scene_that_it_is_made_of() {
    let folder = TempDir::new().unwrap();
    let folder = folder.path();
    scene(folder, 1);
    screen(folder, &["pack", "scene.toml", "--no-bench", "-o", "pack"], 0);
    let before = fs::read(folder.join("pack/manifest.json")).unwrap();
    let words = ["pack", "pack/scene.toml", "--no-bench", "-o", "pack", "--force"];
    assert_trouble(&raypencil(folder, &words), &["pack/scene.toml: an earlier run has made it"]);
    assert_eq!(fs::read(folder.join("pack/manifest.json")).unwrap(), before);
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

/// Files below a folder, by their paths in it.
fn all_files(folder: &Path) -> Vec<String> {
    let mut found = Vec::new();
    let mut folders = vec![folder.to_path_buf()];
    while let Some(inner) = folders.pop() {
        for entry in fs::read_dir(inner).unwrap().map(|entry| entry.unwrap().path()) {
            match entry.is_dir() {
                true => folders.push(entry),
                false => found.push(entry.strip_prefix(folder).unwrap().display().to_string()),
            }
        }
    }
    found.sort();
    found
}

#[test]
fn results_of_another_command_on_the_same_scene_are_not_replaced_unasked() {
    let folder = TempDir::new().unwrap();
    let folder = folder.path();
    scene(folder, 1);
    fs::write(folder.join("g.obj"), "v -9 -9 0\nv 9 -9 0\nv 0 9 0\nf 1 2 3\n").unwrap();
    screen(folder, &["pack", "scene.toml", "--no-bench", "-o", "pack"], 0);
    screen(folder, &["render", "scene.toml", "--with", "tracer", "-o", "maps"], 0);
    let sweep =
        |task| ["sweep", "scene.toml", "--set", "camera.pitch_down_deg=30", "--do", task, "-o"].to_vec();
    let commands = [
        vec!["validate", "scene.toml", "-o"],
        vec!["render", "scene.toml", "--with", "tracer", "-o"],
        vec!["drive", "scene.toml", "--to", "0.3,0", "--record", "points", "-o"],
        vec!["cast", "g.obj", "--ray", "0,0,1,0,0,-1", "-o"],
        vec!["check", "pack", "maps", "-o"],
        vec!["diff", "maps", "maps", "-o"],
        sweep("validate"),
        sweep("render"),
    ];
    for (index, command) in commands.iter().enumerate() {
        let out = format!("out{index}");
        let line = |command: &Vec<&str>| -> Vec<String> {
            command.iter().map(ToString::to_string).chain([out.clone()]).collect()
        };
        let run = |line: &[String]| raypencil(folder, &line.iter().map(String::as_str).collect::<Vec<_>>());
        assert_eq!(run(&line(command)).status.code(), Some(0), "{command:?}");
        let before = all_files(&folder.join(&out));
        // The next command, and the one after: each pair of neighbours, and of some others.
        for step in [1, 2, 5] {
            let other = line(&commands[(index + step) % commands.len()]);
            assert_trouble(&run(&other), &["it has results of ", "expected another folder, or --force"]);
        }
        let replay =
            ["campaign", "replay", "--seed", "1", "--terrain", "0", "--part", "lattice", "-o", out.as_str()];
        assert_trouble(&raypencil(folder, &replay), &["it has results of "]);
        assert_eq!(all_files(&folder.join(&out)), before, "nothing goes");
        // The same again is as it was.
        assert_eq!(run(&line(command)).status.code(), Some(0), "{command:?}");
        assert_eq!(all_files(&folder.join(&out)), before);
        let forced = [line(&commands[(index + 1) % commands.len()]), vec!["--force".into()]].concat();
        assert_eq!(run(&forced).status.code(), Some(0), "{forced:?}");
    }
    // Parts of a sweep are not joined among results of another command, nor one of them twice.
    let merge = ["sweep", "merge", "out7", "-o", "out3"];
    screen(folder, &[&sweep("render")[..], &["out7", "--force"]].concat(), 0);
    screen(folder, &["validate", "scene.toml", "-o", "out3", "--force"], 0);
    assert_trouble(&raypencil(folder, &merge), &["out3: it has results of `validate` on "]);
    let twice = ["sweep", "merge", "out7", "./out7", "-o", "merged"];
    assert_trouble(&raypencil(folder, &twice), &["out7 is given twice; expected each folder once"]);
    assert!(!folder.join("merged").exists());
}
