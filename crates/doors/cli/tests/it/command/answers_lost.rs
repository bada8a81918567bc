//! Answers that cannot be written, and threads that cannot be started.

use std::fs::File;
use std::path::Path;
use std::process::Stdio;

use tempfile::TempDir;

use super::{assert_trouble, command, raypencil, text};

/// A scene that takes no time.
const SMALL: &str = "version = 1\nbeam = []\n[camera]\nwidth_px = 8\nheight_px = 6\npixel_pitch_um = 1000\npitch_down_deg = \
                     40\n[terrain]\nbuiltin = \"pyramids\"\n";

fn folder() -> TempDir {
    let folder = TempDir::new().unwrap();
    std::fs::write(folder.path().join("small.toml"), SMALL).unwrap();
    folder
}

/// Linux has a device that is always full.
#[cfg(target_os = "linux")]
#[test]
fn an_answer_that_cannot_be_written_is_an_error() {
    let folder = folder();
    assert_eq!(
        raypencil(folder.path(), &["pack", "small.toml", "--no-bench", "-o", "p"]).status.code(),
        Some(0)
    );
    for line in [
        &["--help"][..],
        &["--version"],
        &["validate", "--help"],
        &["probe", "small.toml", "--pixel", "3,3"],
        &["probe", "small.toml", "--pixel", "3,3", "--json"],
        &["validate", "small.toml", "-o", "out", "--json"],
        &["validate", "small.toml", "-o", "out", "--quiet"],
        &["check", "p", "p"],
        &["check", "p", "p", "--json"],
        &["terrain", "inspect", "pyramids"],
    ] {
        let full = File::options().write(true).open("/dev/full").unwrap();
        let output = command(folder.path(), line).stdout(full).output().unwrap();
        let message = text(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{line:?}: {message}");
        assert!(message.contains("standard output: cannot write"), "{line:?}: {message}");
    }
}

/// `>&-`. An output that is thrown away on purpose is none of this, however it was opened.
#[cfg(target_os = "linux")]
#[test]
fn a_closed_standard_output_is_an_error_and_the_null_device_is_none() {
    let folder = folder();
    for line in ["--version", "probe small.toml --pixel 3,3", "probe small.toml --pixel 3,3 --json"] {
        let with = |output: &str| {
            let line = format!("exec {} {line} {output}", env!("CARGO_BIN_EXE_raypencil"));
            std::process::Command::new("sh").args(["-c", &line]).current_dir(folder.path()).output().unwrap()
        };
        let closed = with(">&-");
        let message = text(&closed.stderr);
        assert_eq!(closed.status.code(), Some(2), "{line}: {message}");
        assert!(message.contains("standard output: cannot write"), "{line}: {message}");
        for thrown_away in [">/dev/null", "1<>/dev/null"] {
            let status = with(thrown_away).status;
            assert_eq!(status.code(), Some(0), "{line} {thrown_away}");
        }
    }
}

#[test]
fn a_reader_who_has_seen_enough_is_no_error() {
    let folder = folder();
    for line in [&["--help"][..], &["probe", "small.toml", "--pixel", "3,3"]] {
        let mut child =
            command(folder.path(), line).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        // As `| head -0` does.
        drop(child.stdout.take());
        let output = child.wait_with_output().unwrap();
        assert_eq!(output.status.code(), Some(0), "{line:?}: {}", text(&output.stderr));
    }
}

#[test]
fn numbers_of_threads_are_checked() {
    let folder = folder();
    let with = |threads: &str| {
        command(folder.path(), &["probe", "small.toml", "--pixel", "3,3"])
            .env("RAYON_NUM_THREADS", threads)
            .output()
            .unwrap()
    };
    for wrong in ["65536", "-1", "many"] {
        assert_trouble(
            &with(wrong),
            &[&format!("RAYON_NUM_THREADS={wrong}"), "expected a number of threads"],
        );
    }
    for right in ["1", "3", "0", ""] {
        assert_eq!(with(right).status.code(), Some(0), "{right}");
    }
}

/// With too little memory for their stacks, the system refuses to start threads. A stack is asked for that does not fit even once:
/// with small ones those that run already would be short of memory too.
#[cfg(target_os = "linux")]
#[test]
fn refused_threads_are_an_error() {
    let folder = folder();
    let line = format!(
        "ulimit -v 600000; RUST_MIN_STACK=536870912 exec {} probe small.toml --pixel 3,3 --threads 1024",
        env!("CARGO_BIN_EXE_raypencil")
    );
    let output =
        std::process::Command::new("sh").args(["-c", &line]).current_dir(folder.path()).output().unwrap();
    let output = std::process::Output { stdout: Vec::new(), ..output };
    assert_trouble(&output, &["1024 threads cannot be started", "--threads 1"]);
}

#[cfg(unix)]
#[test]
fn an_argument_that_is_not_utf_8_is_named() {
    use std::os::unix::ffi::OsStrExt;
    let folder = folder();
    let name = std::ffi::OsStr::from_bytes(b"sc\xffne.toml");
    std::fs::write(folder.path().join(name), SMALL).unwrap();
    // One rule for all commands that take a scene or a mesh.
    for words in [
        &["validate"][..],
        &["pack", "-o", "out", "--rays", "rays.csv"],
        &["cast", "--ray", "0,0,3,0,0,-1"],
        &["terrain", "import", "-o", "out.glb"],
        &["terrain", "inspect"],
    ] {
        let output = command(folder.path(), words).arg(Path::new(name)).output().unwrap();
        assert_trouble(&output, &["sc\u{fffd}ne.toml", "not UTF-8", "another name"]);
    }
}
