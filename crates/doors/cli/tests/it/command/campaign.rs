//! `campaign`: shards, interruptions, damaged files.

use std::fs;
use std::path::Path;
use std::process::Stdio;

use tempfile::TempDir;

use super::{assert_trouble, command, raypencil, screen};

/// The words of a command line without quotes.
fn words(text: &str) -> Vec<&str> {
    text.split_whitespace().collect()
}

#[track_caller]
fn passes(folder: &Path, line: &str) -> String {
    screen(folder, &words(line), 0)
}

#[track_caller]
fn is_trouble(folder: &Path, line: &str, expected: &[&str]) {
    assert_trouble(&raypencil(folder, &words(line)), expected);
}

fn summary(folder: &Path, name: &str) -> String {
    fs::read_to_string(folder.join(name).join("summary.json")).expect("a summary")
}

#[test]
fn the_variables_of_proptest_change_nothing() {
    let folder = TempDir::new().unwrap();
    let folder = folder.path();
    // A runner of proptest's own would draw by the seed that is set here, and would print a line about a value that is none.
    for (name, value) in [("plain", None), ("zero", Some("0")), ("malformed", Some("abc"))] {
        let line = format!("campaign replay --seed 11 --terrain 3 -o {name}");
        let mut command = command(folder, &words(&line));
        for variable in [
            "CASES",
            "MAX_LOCAL_REJECTS",
            "MAX_GLOBAL_REJECTS",
            "MAX_FLAT_MAP_REGENS",
            "MAX_SHRINK_TIME",
            "MAX_SHRINK_ITERS",
            "MAX_DEFAULT_SIZE_RANGE",
            "FORK",
            "TIMEOUT",
            "VERBOSE",
            "RNG_ALGORITHM",
            "RNG_SEED",
            "DISABLE_FAILURE_PERSISTENCE",
            "SUCH_AS_NONE_KNOWS",
        ] {
            let variable = format!("PROPTEST_{variable}");
            match value {
                Some(value) => command.env(variable, value),
                None => command.env_remove(variable),
            };
        }
        let output = command.output().expect("the binary runs");
        assert_eq!(output.status.code(), Some(0), "{}", super::text(&output.stderr));
        assert!(output.stderr.is_empty(), "{}", super::text(&output.stderr));
    }
    let read = |name: &str, file: &str| fs::read(folder.join(name).join(file)).expect("a file of the scene");
    assert!(read("plain", "scene.toml") == read("zero", "scene.toml"));
    assert!(read("plain", "scene.toml") == read("malformed", "scene.toml"));
}

#[test]
fn shards_in_any_order_are_the_whole_campaign() {
    let folder = TempDir::new().unwrap();
    let folder = folder.path();
    let screen = passes(folder, "campaign --terrains 4 --seed 11 -o whole");
    assert!(
        screen.contains("4 terrains of seed 11")
            && screen.contains("\nseed 11")
            && screen.contains("no defect, none undecided"),
        "{screen}"
    );
    let whole = summary(folder, "whole");
    let json: serde_json::Value = serde_json::from_str(&whole).unwrap();
    assert_eq!(json["all"]["classes"]["defects"], 0);
    // Every kind of scene has rays, and the aimed ones are difficult: some tie.
    for part in ["own", "paper", "aimed", "lattice"] {
        assert!(json["parts"][part]["compared"].as_u64().unwrap() > 1000, "{part}");
    }
    assert!(json["parts"]["aimed"]["classes"]["tie"].as_u64().unwrap() > 0);

    passes(folder, "campaign --terrains 4 --seed 11 --shard 2/2 -o b");
    is_trouble(folder, "campaign merge b", &["no shard 1 of 2", "all of them"]);
    passes(folder, "campaign --terrains 4 --seed 11 --shard 1/2 -o a");
    passes(folder, "campaign merge b a -o merged");
    assert_eq!(summary(folder, "merged"), whole);
    passes(folder, "campaign merge a b -o merged");
    assert_eq!(summary(folder, "merged"), whole);

    // The same shard twice, one of another campaign, one that was changed.
    is_trouble(folder, "campaign merge a b a", &["shard 1 of 2 again", "each shard once"]);
    passes(folder, "campaign --terrains 4 --seed 12 --shard 1/2 -o foreign");
    is_trouble(folder, "campaign merge foreign b", &["seed 11", "seed 12"]);
    is_trouble(folder, "campaign --terrains 4 --seed 12 -o a", &["seed 11", "a folder of its own"]);
    let file = folder.join("a/shard-1-of-2.json");
    let clean = fs::read_to_string(&file).unwrap();
    fs::write(&file, clean.replacen("\"compared\":", "\"compared\":1", 1)).unwrap();
    is_trouble(folder, "campaign merge a b", &["shard-1-of-2.json", "digest"]);
    fs::write(&file, &clean[..clean.len() / 2]).unwrap();
    is_trouble(folder, "campaign merge a b", &["shard-1-of-2.json"]);
    is_trouble(folder, "campaign merge whole/terrains", &["no result in"]);
    is_trouble(folder, "campaign --shard 3/2", &["such as 2/4"]);
}

#[test]
fn a_campaign_of_some_parts_or_of_small_grounds_is_one_of_its_own() {
    let folder = TempDir::new().unwrap();
    let folder = folder.path();
    let rays_of = |name: &str| {
        let json: serde_json::Value = serde_json::from_str(&summary(folder, name)).unwrap();
        ["own", "paper", "aimed", "lattice"].map(|part| json["parts"][part]["compared"].as_u64().unwrap())
    };
    passes(folder, "campaign --terrains 2 --seed 11 -o all");
    passes(folder, "campaign --terrains 2 --seed 11 --parts lattice,aimed -o some");
    let page = fs::read_to_string(folder.join("some/report.html")).unwrap();
    assert!(page.contains("campaign --terrains 2 --parts aimed,lattice --seed 11 -o DIR"), "{page}");
    let [_, _, aimed, lattice] = rays_of("all");
    assert_eq!(rays_of("some"), [0, 0, aimed, lattice]);
    // Of a ground that is too large only the lattice is left.
    passes(folder, "campaign --terrains 2 --seed 11 --max-faces 1 -o small");
    assert_eq!(rays_of("small"), [0, 0, 0, lattice]);
    is_trouble(
        folder,
        "campaign --terrains 2 --seed 11 -o some",
        &["--parts aimed,lattice", "a folder of its own"],
    );
    is_trouble(
        folder,
        "campaign --parts paper --candidate-command true{pack}{out}",
        &["--parts paper", "scanline alone"],
    );
    is_trouble(folder, "campaign --parts all", &["own, paper, aimed, lattice"]);
}

#[test]
fn an_interrupted_campaign_is_resumed() {
    let folder = TempDir::new().unwrap();
    let folder = folder.path();
    let line = "campaign --terrains 5 --seed 3 -o broken";
    let mut child =
        command(folder, &words(line)).stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
    // Killed, as by kill -9, once the first records exist.
    let records = || fs::read_dir(folder.join("broken/terrains")).map_or(0, Iterator::count);
    while records() < 2 && child.try_wait().unwrap().is_none() {
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    child.kill().unwrap();
    child.wait().unwrap();
    let kept: Vec<_> =
        fs::read_dir(folder.join("broken/terrains")).unwrap().map(|one| one.unwrap().path()).collect();
    // A record that the interruption damaged is computed again.
    if let Some(last) = kept.iter().filter(|path| path.extension().is_some_and(|end| end == "json")).max() {
        let text = fs::read_to_string(last).unwrap();
        fs::write(last, &text[..text.len() - 9]).unwrap();
    }
    passes(folder, line);
    passes(folder, "campaign --terrains 5 --seed 3 -o straight");
    assert_eq!(summary(folder, "broken"), summary(folder, "straight"));
    // A finished campaign is not run again and gives the same summary.
    passes(folder, line);
    assert_eq!(summary(folder, "broken"), summary(folder, "straight"));
}

#[test]
fn a_scene_of_a_campaign_can_be_replayed() {
    let folder = TempDir::new().unwrap();
    let folder = folder.path();
    for part in ["own", "aimed", "lattice"] {
        passes(folder, &format!("campaign replay --seed 11 --terrain 2 --part {part} -o replay"));
        passes(folder, "validate replay/scene.toml -o out");
    }
}

/// A program under test, in a shell: it copies the answers that `raypencil` gives to a pack's scene, with one of them changed.
#[cfg(unix)]
fn program(folder: &Path, name: &str, change: &str) -> String {
    let text = format!(
        "#!/bin/sh\nset -e\n{} render \"$1/scene.toml\" --with tracer -o \"$2\" >/dev/null\n{change}\n",
        env!("CARGO_BIN_EXE_raypencil")
    );
    let file = folder.join(name);
    fs::write(&file, text).unwrap();
    format!("sh {} {{pack}} {{out}}", file.display())
}

#[cfg(unix)]
#[test]
fn another_program_is_hunted() {
    let folder = TempDir::new().unwrap();
    let folder = folder.path();
    let scenes = folder.join("scenes");
    fs::create_dir(&scenes).unwrap();
    let small = "version = 1\ncamera = { width_px = 48, height_px = 40, pixel_pitch_um = 200 }\n\
                 beam = [{ columns = 64, rows = 2, thickness_mm = 60 }]\n";
    fs::write(scenes.join("small.toml"), small).unwrap();
    let hunt = |command: &str, out: &str| {
        raypencil(folder, &["campaign", "--scenes", "scenes", "--candidate-command", command, "-o", out])
    };
    let json = |out: &str| serde_json::from_str::<serde_json::Value>(&summary(folder, out)).unwrap();
    // A right program: every ray of every part is compared with the exact answer.
    let right = program(folder, "right.sh", "");
    let output = hunt(&right, "right");
    assert_eq!(output.status.code(), Some(0), "{}", super::text(&output.stdout));
    let right = json("right");
    for part in ["own", "aimed"] {
        assert!(right["parts"][part]["compared"].as_u64().unwrap() > 500, "{part}");
        assert!(right["parts"][part]["hits"].as_u64().unwrap() > 0, "{part}");
    }
    assert_eq!(right["parts"]["paper"]["compared"], 0);
    // Random terrains have lattices too.
    let words =
        ["campaign", "--terrains", "1", "--seed", "2", "--candidate-command", &program(folder, "r.sh", "")];
    let output = raypencil(folder, &[&words[..], &["-o", "random"]].concat());
    assert_eq!(output.status.code(), Some(0), "{}", super::text(&output.stdout));
    assert!(json("random")["parts"]["lattice"]["hits"].as_u64().unwrap() > 0);
    assert!(!folder.join("right/misses").exists());
    // One with the paper's approximations: its wrong rays are left as packs that show them again.
    let wrong = program(folder, "wrong.sh", "");
    let text = fs::read_to_string(folder.join("wrong.sh")).unwrap().replace("tracer", "scanline-paper");
    fs::write(folder.join("wrong.sh"), text).unwrap();
    let output = hunt(&wrong, "wrong");
    let screen = super::text(&output.stdout);
    assert_eq!(output.status.code(), Some(1), "{screen}");
    assert!(screen.contains("under test: sh ") && screen.contains("rays are wrong or undecided"), "{screen}");
    let misses: Vec<_> = walk(&folder.join("wrong/misses"));
    let pack = misses.iter().find(|path| path.ends_with("manifest.json")).expect("a pack of a miss");
    let pack = pack.parent().unwrap();
    assert!(fs::read_to_string(pack.join("README.md")).unwrap().contains("raypencil check . CANDIDATE"));
    // The pack of the miss shows the same program wrong again, and a right one right.
    let answer = folder.join("again");
    let status = std::process::Command::new("sh")
        .args([folder.join("wrong.sh").as_os_str(), pack.as_os_str(), answer.as_os_str()])
        .status()
        .unwrap();
    assert!(status.success());
    let check =
        |answers: &Path| raypencil(folder, &["check", pack.to_str().unwrap(), answers.to_str().unwrap()]);
    assert_eq!(check(&answer).status.code(), Some(1));
    let answer = folder.join("right-again");
    let words =
        ["render", &pack.join("scene.toml").display().to_string(), "--with", "tracer", "-o", "right-again"]
            .map(String::from);
    screen_of(folder, &words);
    assert_eq!(check(&answer).status.code(), Some(0));
    // A program in single precision is right by its own bounds, and wrong by those of double precision.
    let single = program(folder, "single.sh", "");
    let off = "scene.toml\" --format npy --set \"camera.principal_point_px=[24.0000001,20]\"";
    let text = fs::read_to_string(folder.join("single.sh")).unwrap().replace("scene.toml\"", off);
    fs::write(folder.join("single.sh"), text).unwrap();
    let words = ["campaign", "--scenes", "scenes", "--candidate-command", &single, "--parts", "own"];
    for (arithmetic, code) in [("f64", 1), ("f32", 0)] {
        // The same folder: its record is made again.
        let output = raypencil(folder, &[&words[..], &["-o", "double", "--arithmetic", arithmetic]].concat());
        assert_eq!(output.status.code(), Some(code), "{}", super::text(&output.stdout));
    }
    // One that dies says why; one that answers nothing; one that is no program.
    let output = hunt(&program(folder, "dies.sh", "echo out of luck >&2\nexit 3"), "dies");
    assert_eq!(output.status.code(), Some(1));
    assert!(
        super::text(&output.stdout)
            .contains("terrain 0 own: no answer: it ended with exit status: 3: out of luck")
    );
    assert_eq!(json("dies")["no_answer"].as_array().unwrap().len(), 2);
    let output = hunt("true {pack} {out}", "empty");
    assert!(super::text(&output.stdout).contains("no answer: {out}"), "{}", super::text(&output.stdout));
    // One that leaves out a whole sensor is right about the others, and does not pass.
    let output = hunt(&program(folder, "blind.sh", "rm \"$2/camera.exr\""), "blind");
    assert_eq!(output.status.code(), Some(1));
    let screen = super::text(&output.stdout);
    assert!(screen.contains("terrain 0 own: no answer: it answers no ray of camera"), "{screen}");
    assert!(json("blind")["parts"]["own"]["compared"].as_u64().unwrap() > 0);
    assert_trouble(
        &hunt("no-such-program {pack} {out}", "none"),
        &["not found", "expected a program that can be run"],
    );
    assert_trouble(&hunt("tracer {pack}", "none"), &["it has no {out}"]);
}

/// Each file that decides a terrain is changed, and each time its record is made again, and no other.
#[cfg(unix)]
#[test]
fn a_terrain_whose_files_change_is_hunted_again() {
    let folder = TempDir::new().unwrap();
    let folder = folder.path();
    let scenes = folder.join("scenes");
    fs::create_dir(&scenes).unwrap();
    let write = |name: &str, text: &str| fs::write(folder.join(name), text).unwrap();
    let scene = "version = 1\nvehicle = { position_m = [0, 0] }\ncamera = { width_px = 4, height_px = 4 }\nbeam = []\n";
    let ground = |height: f64| format!("v -9 -9 {height}\nv 9 -9 0\nv 9 9 0\nv -9 9 0\nf 1 2 3 4\n");
    write("scenes/a.toml", &format!("{scene}terrain = {{ file = \"../g.obj\" }}\n"));
    write("scenes/b.toml", scene);
    write("g.obj", &ground(0.0));
    // A program that counts how often it is asked, and answers nothing.
    write("prog", "#!/bin/sh\necho >>\"$3\"\ncat \"$4\" >/dev/null\nexit 3\n");
    write("config", "1");
    let mode = std::os::unix::fs::PermissionsExt::from_mode(0o755);
    fs::set_permissions(folder.join("prog"), mode).unwrap();
    write("count", "");
    let count = || fs::read_to_string(folder.join("count")).unwrap().len();
    let asked = |more: &str| {
        let before = count();
        let counter = folder.join("count");
        // What it writes is no word of the command.
        let command = format!(
            "C={} && ./prog {{pack}} {{out}} \"$C\" config {more}",
            counter.parent().unwrap().display()
        );
        let command = command.replace("\"$C\"", "\"$C\"/count");
        let words = ["campaign", "--scenes", "scenes", "--candidate-command", &command, "-o", "out"];
        let output = raypencil(folder, &words);
        assert_eq!(output.status.code(), Some(1), "{}", super::text(&output.stderr));
        count() - before
    };
    // Two scenes, of each the own part and the aimed one.
    assert_eq!(asked(""), 4);
    assert_eq!(asked(""), 0);
    write("g.obj", &ground(0.5));
    assert_eq!(asked(""), 2);
    write("scenes/b.toml", &format!("{scene}flux = {{ model = \"eq1\" }}\n"));
    assert_eq!(asked(""), 2);
    write("config", "2");
    assert_eq!(asked(""), 4);
    let program = fs::read_to_string(folder.join("prog")).unwrap();
    write("prog", &program.replace("exit 3", "exit 4"));
    assert_eq!(asked(""), 4);
    assert!(fs::read_to_string(folder.join("out/summary.md")).unwrap().contains("exit status: 4"));
    assert_eq!(asked(""), 0);
    // Other words are another question.
    let words =
        ["campaign", "--scenes", "scenes", "--candidate-command", "./prog {pack} {out} x y", "-o", "out"];
    assert_trouble(&raypencil(folder, &words), &["own terrains", "folder of its own"]);
}

/// However the campaign ends, nothing of a program and of its files is left.
#[cfg(unix)]
#[test]
fn a_campaign_that_is_killed_leaves_no_program_behind() {
    let folder = TempDir::new().unwrap();
    let folder = folder.path();
    fs::create_dir(folder.join("scenes")).unwrap();
    fs::create_dir(folder.join("tmp")).unwrap();
    let small = "version = 1\ncamera = { width_px = 4, height_px = 4 }\nbeam = []\n";
    fs::write(folder.join("scenes/small.toml"), small).unwrap();
    fs::write(folder.join("prog"), "sleep 300 & echo $! $$ >pids.part; mv pids.part pids; wait\n").unwrap();
    let words =
        ["campaign", "--scenes", "scenes", "--candidate-command", "sh prog {pack} {out}", "-o", "out"];
    let mut campaign = command(folder, &words).env("TMPDIR", folder.join("tmp")).spawn().unwrap();
    let until = |is_so: &dyn Fn() -> bool| {
        let start = std::time::Instant::now();
        while !is_so() {
            assert!(start.elapsed().as_secs() < 20, "it does not come to that");
            std::thread::sleep(std::time::Duration::from_millis(5));
        }
    };
    until(&|| folder.join("pids").exists());
    assert!(fs::read_dir(folder.join("tmp")).unwrap().count() > 0);
    // As by kill -9: no code of its own runs any more.
    campaign.kill().unwrap();
    campaign.wait().unwrap();
    let pids = fs::read_to_string(folder.join("pids")).unwrap();
    let lives = |pid: &str| {
        // One that is dead and that nobody has asked for yet is an entry of a table.
        if fs::read_to_string(format!("/proc/{pid}/stat")).is_ok_and(|stat| stat.contains(") Z ")) {
            return false;
        }
        let sent = std::process::Command::new("kill").args(["-0", pid]).stderr(Stdio::null()).status();
        sent.unwrap().success()
    };
    until(&|| !pids.split_whitespace().any(lives));
    until(&|| fs::read_dir(folder.join("tmp")).unwrap().count() == 0);
    // One that takes too long is ended, and told so.
    let words = [&words[..], &["--timeout", "0.05"]].concat();
    let output = command(folder, &words).env("TMPDIR", folder.join("tmp")).output().unwrap();
    let shown = super::text(&output.stdout);
    assert_eq!(output.status.code(), Some(1), "{shown}");
    assert!(shown.contains("no answer: it ran for more than 0.05 s"), "{shown}");
    assert_eq!(fs::read_dir(folder.join("tmp")).unwrap().count(), 0);
    is_trouble(folder, "campaign --timeout 5", &["--candidate-command"]);
}

/// Right numbers that do not say what is hit are no answer, unless that is what was wanted.
#[cfg(unix)]
#[test]
fn a_harmless_channel_is_no_answer() {
    let folder = TempDir::new().unwrap();
    let folder = folder.path();
    fs::create_dir(folder.join("scenes")).unwrap();
    let small = "version = 1\ncamera = { width_px = 24, height_px = 20, pixel_pitch_um = 400 }\n\
                 beam = [{ columns = 32, rows = 1 }]\n";
    fs::write(folder.join("scenes/small.toml"), small).unwrap();
    let left = |keep: &str| format!("find \"$2\" -name '*.npy' ! -name '{keep}' -delete");
    let command = program(folder, "prog.sh", &left("incidence.V.npy"));
    let text = fs::read_to_string(folder.join("prog.sh")).unwrap().replace("--with", "--format npy --with");
    fs::write(folder.join("prog.sh"), &text).unwrap();
    let hunt = |more: &[&str], code: i32| {
        let words = ["campaign", "--scenes", "scenes", "--candidate-command", &command, "-o", "out"];
        let output = raypencil(folder, &[&words[..], more].concat());
        let shown = super::text(&output.stdout);
        assert_eq!(output.status.code(), Some(code), "{shown}{}", super::text(&output.stderr));
        shown
    };
    let shown = hunt(&[], 1);
    assert!(shown.contains("own: no answer: it says of no ray of camera, beam-0 what it hits"), "{shown}");
    hunt(&["--partial"], 0);
    fs::write(folder.join("prog.sh"), text.replace("incidence.V", "range.T")).unwrap();
    hunt(&[], 0);
}

/// What a program was wrong in is gone once it is mended.
#[cfg(unix)]
#[test]
fn misses_of_a_mended_program_are_removed() {
    let folder = TempDir::new().unwrap();
    let folder = folder.path();
    fs::create_dir(folder.join("scenes")).unwrap();
    let small = "version = 1\ncamera = { width_px = 48, height_px = 40, pixel_pitch_um = 200 }\n\
                 beam = [{ columns = 64, rows = 2, thickness_mm = 60 }]\n";
    fs::write(folder.join("scenes/small.toml"), small).unwrap();
    let command = program(folder, "prog.sh", "");
    let right = fs::read_to_string(folder.join("prog.sh")).unwrap();
    fs::write(folder.join("prog.sh"), right.replace("tracer", "scanline-paper")).unwrap();
    let hunt = |code: i32| {
        let words = ["campaign", "--scenes", "scenes", "--candidate-command", &command, "-o", "out"];
        let output = raypencil(folder, &words);
        assert_eq!(output.status.code(), Some(code), "{}", super::text(&output.stdout));
    };
    hunt(1);
    assert!(walk(&folder.join("out/misses")).iter().any(|path| path.ends_with("manifest.json")));
    let mine = folder.join("out/misses/mine.txt");
    fs::write(&mine, "mine").unwrap();
    fs::write(folder.join("prog.sh"), right).unwrap();
    hunt(0);
    assert_eq!(walk(&folder.join("out/misses")), [mine]);
}

#[cfg(unix)]
fn screen_of(folder: &Path, words: &[String]) {
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    screen(folder, &words, 0);
}

/// All files below a folder.
#[cfg(unix)]
fn walk(folder: &Path) -> Vec<std::path::PathBuf> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() { found.extend(walk(&path)) } else { found.push(path) }
    }
    found
}

#[test]
fn a_campaign_takes_scenes_of_ones_own() {
    let folder = TempDir::new().unwrap();
    let folder = folder.path();
    let scenes = folder.join("scenes");
    fs::create_dir(&scenes).unwrap();
    let small = "version = 1\ncamera = { width_px = 48, height_px = 40, pixel_pitch_um = 200 }\n\
                 beam = [{ columns = 64, rows = 2 }]\n";
    fs::write(scenes.join("a.toml"), format!("{small}terrain = {{ builtin = \"facets\" }}\n")).unwrap();
    fs::write(scenes.join("b.toml"), small).unwrap();
    fs::write(scenes.join("notes.txt"), "no scene").unwrap();
    let screen = passes(folder, "campaign --scenes scenes -o own");
    assert!(screen.contains("2 terrains"), "{screen}");
    let json: serde_json::Value = serde_json::from_str(&summary(folder, "own")).unwrap();
    // Two cameras of 48 x 40 pixels and two beams of 64 x 2 pencils.
    assert_eq!(json["parts"]["own"]["compared"], 2 * (48 * 40 + 64 * 2));
    assert_eq!(json["parts"]["lattice"]["compared"], 0);
    assert!(json["parts"]["aimed"]["compared"].as_u64().unwrap() > 1000);
    let probe = json["all"]["quantities"].to_string();
    assert!(probe.contains("raypencil probe scenes/"), "{probe}");
    // Terrains under a rig; a scene file among them is no terrain.
    passes(folder, "terrain generate --preset smooth --extent 6 --post-spacing 0.5 -o scenes/c.glb");
    fs::write(folder.join("rig.toml"), small).unwrap();
    passes(folder, "campaign --scenes scenes --rig rig.toml -o rig");
    let json: serde_json::Value = serde_json::from_str(&summary(folder, "rig")).unwrap();
    assert_eq!(
        (&json["terrains"], &json["parts"]["own"]["compared"]),
        (&1.into(), &(48 * 40 + 64 * 2).into())
    );
    // Axes and unit of the rig's file hold for every mesh: a floor of 12 m in millimetres, y up.
    let meshes = folder.join("meshes");
    fs::create_dir(&meshes).unwrap();
    let floor = "v -6000 0 6000\nv 6000 0 6000\nv 6000 0 -6000\nv -6000 0 -6000\nf 1 2 3 4\n";
    fs::write(meshes.join("floor.obj"), floor).unwrap();
    let rig = |scale: &str| format!("{small}terrain = {{ up = \"y\", scale = {scale} }}\n");
    fs::write(folder.join("rig-mm.toml"), rig("0.001")).unwrap();
    passes(folder, "campaign --scenes meshes --rig rig-mm.toml -o meshed");
    let json: serde_json::Value = serde_json::from_str(&summary(folder, "meshed")).unwrap();
    assert_eq!(
        (&json["terrains"], &json["parts"]["own"]["compared"]),
        (&1.into(), &(48 * 40 + 64 * 2).into())
    );
    // Another unit is another scene: it is run again.
    let half = summary(folder, "meshed");
    fs::write(folder.join("rig-mm.toml"), rig("0.0005")).unwrap();
    passes(folder, "campaign --scenes meshes --rig rig-mm.toml -o meshed");
    passes(folder, "campaign --scenes meshes --rig rig-mm.toml -o meshed-anew");
    assert_ne!(summary(folder, "meshed"), half);
    assert_eq!(summary(folder, "meshed"), summary(folder, "meshed-anew"));
    passes(folder, "campaign replay --scenes scenes --seed 1 --terrain 2 --part aimed -o again");
    assert!(folder.join("again/scene.toml").is_file());
    // Other scenes are another campaign.
    is_trouble(folder, "campaign --scenes meshes -o own", &["own terrains", "folder of its own"]);
    is_trouble(folder, "campaign --scenes nowhere", &["nowhere"]);
    fs::create_dir(folder.join("empty")).unwrap();
    is_trouble(folder, "campaign --scenes empty", &["no scene is there", ".toml"]);
    is_trouble(folder, "campaign replay --scenes scenes --seed 1 --terrain 9 -o x", &["expected 0 to 2"]);
}
