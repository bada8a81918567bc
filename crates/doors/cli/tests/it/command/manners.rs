//! `--quiet` and `--color`; arguments that would be passed over without a word.

use std::path::{Path, PathBuf};

use super::{assert_trouble, command, raypencil, text};

/// A file of the repository.
fn data(name: &str) -> String {
    let path: PathBuf = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../data").join(name);
    path.canonicalize().expect("a file of the repository").display().to_string()
}

#[test]
fn quiet_leaves_the_last_line_of_a_result() {
    let folder = tempfile::TempDir::new().unwrap();
    let (mesh, rays) = (data("rays/cube.obj"), data("rays/cube.npy"));
    let loud = raypencil(folder.path(), &["cast", &mesh, &rays]);
    let quiet = raypencil(folder.path(), &["cast", &mesh, &rays, "--quiet"]);
    assert!(text(&loud.stdout).lines().count() > 1);
    assert_eq!(text(&quiet.stdout), "25 rays: 9 hit, 3 of them at a tie; 16 miss\n");
    assert_eq!((quiet.status.code(), text(&quiet.stderr)), (Some(0), String::new()));
    // What is indented below a line belongs to it.
    let quiet = raypencil(folder.path(), &["cast", &mesh, &rays, "-o", "out", "--quiet"]);
    assert_eq!(text(&quiet.stdout), "out/summary.json\n");
    // A result of several parts has one last line too.
    let small = data("scenes/pyramids-small.toml");
    let quiet = raypencil(folder.path(), &["--quiet", "validate", &small]);
    assert_eq!(text(&quiet.stdout), "✓ All 7,936 rays agree.\n");
}

#[test]
fn quiet_keeps_json_errors_and_exit_codes() {
    let folder = tempfile::TempDir::new().unwrap();
    let (mesh, rays) = (data("rays/cube.obj"), data("rays/cube.npy"));
    let loud = raypencil(folder.path(), &["cast", &mesh, &rays, "--json"]);
    let quiet = raypencil(folder.path(), &["cast", &mesh, &rays, "--json", "--quiet"]);
    assert!(loud.stdout == quiet.stdout && loud.stdout.len() > 100, "{}", text(&quiet.stdout));
    let wrong = raypencil(folder.path(), &["cast", &mesh, "nowhere.npy", "--quiet"]);
    assert_eq!((wrong.status.code(), text(&wrong.stdout)), (Some(2), String::new()));
    assert!(text(&wrong.stderr).contains("nowhere.npy"), "{}", text(&wrong.stderr));
    let differs =
        raypencil(folder.path(), &["diff", &mesh.replace("cube.obj", "cube.npy"), &rays, "--quiet"]);
    assert_eq!(differs.status.code(), Some(0), "{}", text(&differs.stderr));
}

#[test]
fn quiet_drops_warnings() {
    let folder = tempfile::TempDir::new().unwrap();
    // The vehicle is 500 m beside the ground, so that each sensor warns.
    let scene = "version = 1\n[vehicle]\nposition_m = [500, 0, 0]\n\
        [camera]\nwidth_px = 64\nheight_px = 48\npixel_pitch_um = 144\n[[beam]]\ncolumns = 64\nrows = 4\n";
    std::fs::write(folder.path().join("aside.toml"), scene).unwrap();
    let render = |more: &[&str]| {
        let words = ["render", "aside.toml", "--with", "tracer", "-o", "out"];
        let output = raypencil(folder.path(), &[&words, more].concat());
        (text(&output.stdout), text(&output.stderr))
    };
    assert!(render(&[]).1.contains("warning:"));
    assert_eq!(render(&["--quiet"]), ("out/beam-0.exr\n".into(), String::new()));
}

#[test]
fn colours_are_asked_for_and_refused() {
    // A pipe is no terminal: colours come only if they are asked for, and then whatever NO_COLOR says.
    let errors = |words: &[&str], no_color: Option<&str>| {
        let mut command = command(Path::new("."), words);
        command.env_remove("NO_COLOR");
        command.envs(no_color.map(|value| ("NO_COLOR", value)));
        let output = command.output().expect("the binary runs");
        assert_eq!(output.status.code(), Some(2));
        text(&output.stderr)
    };
    // The first error is ours, the second is clap's.
    for wrong in [&["cast", "cube.obj"][..], &["cast", "--exactly"]] {
        let with = |color: &[&str], no_color| errors(&[wrong, color].concat(), no_color).contains('\u{1b}');
        assert!(!with(&[], None) && !with(&["--color", "auto"], None) && !with(&[], Some("1")));
        assert!(!with(&["--color=never"], None));
        assert!(with(&["--color", "always"], None) && with(&["--color=always"], Some("1")), "{wrong:?}");
    }
}

#[test]
fn as_many_threads_as_there_may_be_are_taken_from_the_environment() {
    let folder = tempfile::TempDir::new().unwrap();
    let run = |threads: &str| {
        command(folder.path(), &["completions", "bash"]).env("RAYON_NUM_THREADS", threads).output().unwrap()
    };
    for threads in ["", "0", "1", "1024"] {
        assert_eq!(run(threads).status.code(), Some(0), "{threads:?}");
    }
    for threads in ["1025", "-1", "many"] {
        assert_trouble(&run(threads), &[threads, "expected a number of threads from 1 to 1024"]);
    }
}

#[test]
fn no_argument_is_passed_over_because_another_one_displaces_what_it_needs() {
    // Each of these needs one that cannot stand beside the other argument given, so that "it needs" alone would not be asked.
    let folder = tempfile::TempDir::new().unwrap();
    for (line, words) in [
        ("campaign --terrains 1 --rig nowhere.toml", ["--rig", "--terrains"]),
        ("terrain generate --extent 6 --window 1,2,3,4 -o g.glb", ["--window", "--extent"]),
        ("pack pyramids --no-bench --fronts-only -o p", ["--fronts-only", "--no-bench"]),
        ("pack --input --fronts-only -o p", ["--fronts-only", "--input"]),
        ("pack pyramids --fan 60 --fronts-only -o p", ["--fronts-only", "--fan"]),
    ] {
        let output = raypencil(folder.path(), &line.split(' ').collect::<Vec<_>>());
        assert_trouble(&output, &[&["cannot be used with"], &words[..]].concat());
    }
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
}

#[test]
fn a_setting_beside_the_option_of_a_drive_for_the_same_is_refused() {
    let folder = tempfile::TempDir::new().unwrap();
    for (line, words) in [
        (
            "drive pyramids --rule gap=paper --set drive.rules.gap=mended",
            ["drive.rules.gap=mended", "--rule gap=paper"],
        ),
        (
            "drive pyramids --to 1,0 --set drive.waypoints_m=[[1,0]]",
            ["drive.waypoints_m=[[1,0]]", "--to 1,0"],
        ),
    ] {
        let output = raypencil(folder.path(), &line.split(' ').collect::<Vec<_>>());
        assert_trouble(&output, &[&["sets the same; expected one of the two"], &words[..]].concat());
    }
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
}
