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
fn no_command_replaces_a_file_that_it_reads() {
    let folder = TempDir::new().unwrap();
    let at = folder.path();
    let write = |name: &str, text: &str| fs::write(at.join(name), text).unwrap();
    for inner in ["u", "w", "mesh", "set", "mine"] {
        fs::create_dir(at.join(inner)).unwrap();
    }
    write("floor.obj", "v -4 -4 0\nv 4 -4 0\nv 4 4 0\nv -4 4 0\nf 1 2 3\nf 1 3 4\n");
    write("rays.csv", "1,0.5,3,0,0,-2\n-1,0.25,3,0.125,0,-2\n9,0,3,0,0,-1\n");
    write("set/set.toml", "[[rays]]\nname = \"a\"\nfile = \"../u/point.npy\"\n");
    screen(at, &["pack", "floor.obj", "--rays", "rays.csv", "-o", "pack"], 0);
    fs::copy(at.join("pack/rays.npy"), at.join("u/point.npy")).unwrap();
    fs::copy(at.join("pack/rays.npy"), at.join("w/rays.npy")).unwrap();
    fs::copy(at.join("pack/t.npy"), at.join("mine/t.npy")).unwrap();
    for name in ["vertices.npy", "faces.npy"] {
        fs::copy(at.join("pack").join(name), at.join("mesh").join(name)).unwrap();
    }
    let mesh = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
                element face 1\nproperty list uchar int vertex_indices\nend_header\n-4 -4 0\n4 -4 0\n4 4 0\n3 0 1 2\n";
    write("set/cloud.ply", mesh);
    for (line, read) in [
        (&["cast", "floor.obj", "u/point.npy", "-o", "u"][..], "u/point.npy"),
        (&["cast", "floor.obj", "u/point.npy", "-o", "u", "--force"], "u/point.npy"),
        (&["cast", "set/cloud.ply", "set/set.toml", "-o", "set"], "set/cloud.ply"),
        (&["pack", "floor.obj", "--rays", "w/rays.npy", "-o", "w"], "w/rays.npy"),
        (&["pack", "mesh", "--rays", "rays.csv", "-o", "mesh"], "mesh/vertices.npy"),
    ] {
        let before = fs::read(at.join(read)).unwrap();
        let words = ["this run reads it", "expected another output folder"];
        assert_trouble(&raypencil(at, line), &[&[read][..], &words].concat());
        assert_eq!(fs::read(at.join(read)).unwrap(), before, "{line:?}");
    }
    // What has another name than all that is written stays beside it.
    screen(at, &["cast", "set/cloud.ply", "u/point.npy", "-o", "set"], 0);
    screen(at, &["cast", "floor.obj", "w/rays.npy", "-o", "w"], 0);
    // A report among answers would be taken for one of them by the next check.
    let own = ["--output mine: is the folder of the answers to check; expected another folder"];
    assert_trouble(&raypencil(at, &["check", "pack", "mine", "-o", "mine"]), &own);
    assert_eq!(names(&at.join("mine")), ["t.npy"]);
}

#[test]
fn all_arrays_that_cast_and_pack_write_are_known_as_theirs() {
    let folder = TempDir::new().unwrap();
    let at = folder.path();
    fs::write(at.join("floor.obj"), "v -4 -4 0\nv 4 -4 0\nv 4 4 0\nv -4 4 0\nf 1 2 3\nf 1 3 4\n").unwrap();
    fs::write(at.join("rays.csv"), "1,0.5,3,0,0,-2\n9,0,3,0,0,-1\n").unwrap();
    let head = "spinning = { elevations_deg = [-40, -50], steps = 3 }";
    let cone = format!(
        "cone = {{ of = {{ {head} }}, divergence_mrad = 9, rings = 1, returns = {{ keep = 2, separation_m = 1 }} }}"
    );
    fs::write(at.join("set.toml"), format!("[[rays]]\nname = \"a\"\n{cone}\nposition_m = [0, 0, 2]\n"))
        .unwrap();
    let questions = ["--any", "--all", "--margins", "--with", "tracer"];
    screen(at, &[&["cast", "floor.obj", "rays.csv", "-o", "answers"][..], &questions].concat(), 0);
    screen(at, &["pack", "floor.obj", "--rays", "rays.csv", "-o", "rays"], 0);
    screen(at, &["pack", "floor.obj", "--rays", "set.toml", "-o", "scan"], 0);
    fs::create_dir(at.join("own")).unwrap();
    for (made, command) in [("answers", "cast"), ("rays", "pack"), ("scan", "pack")] {
        let arrays: Vec<String> =
            names(&at.join(made)).into_iter().filter(|name| name.ends_with(".npy")).collect();
        assert!(arrays.len() > 15, "{arrays:?}");
        for name in arrays {
            let own = format!("own/{name}");
            fs::copy(at.join("rays/rays.npy"), at.join(&own)).unwrap();
            let line = match command {
                "cast" => ["cast", "floor.obj", &own, "-o", "own"].to_vec(),
                _ => ["pack", "floor.obj", "--rays", &own, "-o", "own"].to_vec(),
            };
            assert_trouble(&raypencil(at, &line), &[&own, "this run reads it"]);
            fs::remove_file(at.join(&own)).unwrap();
        }
    }
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
