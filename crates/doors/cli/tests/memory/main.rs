//! `--max-memory`: what a command says that it takes is what it takes, and it is asked before the work begins.
//!
//! A program of its own, because Linux begins the count of a new program's memory at the peak of the one that started it: started
//! by a program that runs other tests as well, each command would seem to take what those took.

use std::path::Path;
use std::process::{Command, Output, Stdio};

use wait4::Wait4;

/// The binary, to be run in `folder`.
fn command(folder: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_raypencil"));
    command.args(arguments).current_dir(folder).env("NO_COLOR", "1").stdin(Stdio::null());
    command
}

/// What a command says that it cannot do, in one line. It prints nothing else.
fn refusal(folder: &Path, arguments: &[&str]) -> String {
    let Output { status, stdout, stderr } = command(folder, arguments).output().expect("the binary runs");
    // The message is wrapped, with a bar before each line.
    let message = String::from_utf8(stderr).expect("a message");
    let words: Vec<&str> = message.split_whitespace().filter(|word| *word != "│").collect();
    assert_eq!((status.code(), stdout.len()), (Some(2), 0), "{arguments:?}: {message}");
    words.join(" ")
}

/// Most bytes that the program held in memory while it ran.
fn peak(folder: &Path, arguments: &[&str]) -> u64 {
    assert_small();
    let mut child = command(folder, arguments)
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .expect("the binary runs");
    let used = child.wait4().expect("the resources of a child");
    assert!(matches!(used.status.code(), Some(0 | 1)), "{arguments:?}: {}", used.status);
    used.rusage.maxrss
}

/// This program itself has never held more than the least that a command says: else the peaks would be its own.
fn assert_small() {
    let Ok(status) = std::fs::read_to_string("/proc/self/status") else { return };
    let peak = status.lines().find_map(|line| line.strip_prefix("VmHWM:")).expect("the peak");
    let kib: u64 = peak.trim().trim_end_matches(" kB").parse().expect("a size in KiB");
    assert!(kib << 10 < BASE, "this program took {kib} KiB itself: it cannot measure others");
}

/// Bytes that the program says it would take.
fn said(folder: &Path, arguments: &[&str]) -> u64 {
    // Less than any command says, and more than any file here has.
    let message = refusal(folder, &[arguments, &["--max-memory", "8MB"]].concat());
    assert!(message.contains(", the limit of --max-memory"), "{message}");
    let (_, size) = message.split_once("take about ").expect("a size");
    let (size, _) = size.split_once(';').expect("what was expected");
    let bytes: bytesize::ByteSize = size.parse().unwrap_or_else(|error| panic!("{size}: {error}"));
    bytes.as_u64()
}

/// Writes a scene with so many faces, pixels to a side, and pencils across and along.
fn scene(folder: &Path, name: &str, faces: u32, side: u32, pencils: [u32; 2]) -> String {
    let [columns, rows] = pencils;
    let text = format!(
        "version = 1\n[camera]\nwidth_px = {side}\nheight_px = {side}\n[[beam]]\ncolumns = {columns}\nrows = {rows}\n\
         [terrain]\ngenerate = {{ kind = \"plain\", seed = 1, faces = {faces} }}\n"
    );
    let file = format!("{name}.toml");
    std::fs::write(folder.join(&file), text).expect("a file");
    file
}

/// What the program itself takes and every run needs, bytes; the numbers of the scene come on top.
const BASE: u64 = 28 << 20;

/// The memory that a command says is what it takes, and at most four times as much.
fn assert_said_is_taken(folder: &Path, arguments: &[&str]) {
    let (said, taken) = (said(folder, arguments), peak(folder, arguments));
    assert!(taken <= said, "{arguments:?}: takes {taken} bytes, and says {said}");
    let least = 4 * taken.saturating_sub(BASE / 4);
    assert!(said <= BASE + least, "{arguments:?}: says {said} bytes, and takes {taken}");
}

/// Every command that takes a scene keeps to what it says for this one.
fn assert_commands_take_what_they_say(faces: u32, side: u32, pencils: [u32; 2]) {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let scene = scene(folder, "scene", faces, side, pencils);
    for (output, arguments) in [
        ("scanline", vec!["render", &scene, "--with", "scanline"]),
        ("tracer", vec!["render", &scene, "--with", "tracer"]),
        ("referee", vec!["render", &scene, "--with", "referee"]),
        ("validate", vec!["validate", &scene]),
        ("pack", vec!["pack", &scene, "--no-bench"]),
    ] {
        assert_said_is_taken(folder, &[arguments.as_slice(), &["-o", output]].concat());
    }
    assert_said_is_taken(folder, &["check", "pack", "pack"]);
    assert_said_is_taken(folder, &["probe", &scene, "--pixel", "3,3"]);
    assert_said_is_taken(folder, &["drive", &scene, "--to", "0.1,0", "--both", "-o", "both"]);
}

// One test each, so that they run at the same time.

#[test]
fn many_faces_take_the_memory_that_is_said() {
    assert_commands_take_what_they_say(100_000, 16, [16, 2]);
}

#[test]
fn many_pixels_take_the_memory_that_is_said() {
    assert_commands_take_what_they_say(1000, 384, [16, 2]);
}

#[test]
fn many_pencils_take_the_memory_that_is_said() {
    assert_commands_take_what_they_say(1000, 16, [1024, 32]);
}

#[test]
fn cells_of_optics_take_the_memory_that_is_said() {
    let folder = tempfile::tempdir().unwrap();
    // 256 x 256 pixels of 16 x 16 cells, and a blur that brings light to most of them.
    let text = "version = 1\nvehicle = { position_m = [-0.6, 0] }\n\
                camera = { width_px = 256, height_px = 256, pixel_pitch_um = 36 }\n[terrain]\nbuiltin = \"pyramids\"\n[drive]\n\
                waypoints_m = [[0.1, 0]]\nscans = false\nsensor = \"cmos\"\n\
                optics = { oversampling = 16, blurs = [{ gaussian_px = 30 }] }\n";
    std::fs::write(folder.path().join("fine.toml"), text).unwrap();
    assert_said_is_taken(folder.path(), &["drive", "fine.toml", "-o", "out"]);
}

#[test]
fn casting_takes_the_memory_that_it_says() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    std::fs::write(folder.join("ground.obj"), "v 0 0 0\nv 9 0 0\nv 0 9 0\nf 1 2 3\n").unwrap();
    let rays = "0,0,1,0,0,-1\n".repeat(50_000);
    std::fs::write(folder.join("rays.csv"), rays).unwrap();
    for more in [vec!["--margins"], vec!["-o", "cast"]] {
        assert_said_is_taken(folder, &[&["cast", "ground.obj", "rays.csv"], more.as_slice()].concat());
    }
    assert_said_is_taken(folder, &["pack", "ground.obj", "--rays", "rays.csv", "-o", "pack"]);

    // Many faces, and few rays.
    let mut strip = String::from("v 0 0 0\nv 0 1 0\n");
    for post in 1..=50_000 {
        strip += &format!("v {post} 0 0\nv {post} 1 0\nf -4 -3 -2\nf -3 -1 -2\n");
    }
    std::fs::write(folder.join("strip.obj"), strip).unwrap();
    std::fs::write(folder.join("few.csv"), "0.5,0.5,1,0,0,-1\n").unwrap();
    assert_said_is_taken(folder, &["cast", "strip.obj", "few.csv", "-o", "few"]);
}

#[test]
fn checking_a_cloud_takes_the_memory_that_it_says() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    std::fs::write(folder.join("floor.obj"), "v -99 -99 0\nv 99 -99 0\nv 0 99 0\nf 1 2 3\n").unwrap();
    let scan = "[[rays]]\nname = \"a\"\nspinning = { preset = \"vlp-16\", steps = 4000 }\nposition_m = [0, 0, 1.2]\n";
    std::fs::write(folder.join("scan.toml"), scan).unwrap();
    for arguments in [
        ["pack", "floor.obj", "--rays", "scan.toml", "-o", "pack"].as_slice(),
        ["cast", "floor.obj", "scan.toml", "-o", "cast"].as_slice(),
    ] {
        assert!(command(folder, arguments).output().unwrap().status.success(), "{arguments:?}");
    }
    assert_said_is_taken(folder, &["check", "pack", "cast/cloud-sensor.pcd", "--frame", "sensor"]);
    // What a header claims is asked before a point is read.
    let header = "VERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 90000000000\nHEIGHT 1\nPOINTS 90000000000\nDATA binary\n";
    std::fs::write(folder.join("huge.pcd"), header).unwrap();
    let message = refusal(folder, &["check", "pack", "huge.pcd"]);
    assert!(message.contains("90,000,000,000 points take about 18"), "{message}");
}

#[test]
fn a_refusal_comes_before_the_work_and_leaves_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    // 2^26 pixels: nobody has answered them after the second that this takes.
    let large = scene(folder, "large", 1000, 8192, [16, 2]);
    for arguments in [
        vec!["render", large.as_str(), "--with", "scanline", "-o", "out"],
        vec!["validate", large.as_str(), "-o", "out"],
        vec!["pack", large.as_str(), "-o", "out"],
        vec!["drive", large.as_str(), "--to", "1,0", "-o", "out"],
    ] {
        let message = refusal(folder, &[arguments.as_slice(), &["--max-memory", "100MB"]].concat());
        for words in [
            "67,108,864 pixels, 32 pencils take about",
            "expected at most 100.0 MB, the limit of --max-memory",
        ] {
            assert!(message.contains(words), "`{words}` is not in: {message}");
        }
        let left = std::fs::read_dir(folder.join("out")).map_or(0, Iterator::count);
        assert_eq!(left, 0, "{arguments:?} left something");
    }
    let message = refusal(folder, &["probe", "pyramids", "--pixel", "3,3", "--max-memory", "much"]);
    assert!(message.contains("expected a size, such as 2GB, 512MiB or a number of bytes"), "{message}");
}
