//! `pack`: with and without a bench, of a scene in which nothing is hit, and the input pack.

use std::fs;

use raypencil::Image;
use raypencil::io::write_npy;
use raypencil_tests::schema::schema_faults;
use tempfile::TempDir;

use super::check::{assert_fails, assert_passes, pack};
use super::{assert_trouble, raypencil, screen, text};

/// A camera of a few pixels that looks up or down, and no beams.
fn scene(pitch_down_deg: f64) -> String {
    format!(
        "version = 1\nbeam = []\n[camera]\nwidth_px = 8\nheight_px = 6\npixel_pitch_um = 1000\npitch_down_deg = \
         {pitch_down_deg}\n[terrain]\nbuiltin = \"pyramids\"\n"
    )
}

#[test]
fn a_pack_has_a_bench_and_says_which_clauses_its_rays_decide() {
    let folder = TempDir::new().expect("a temporary folder");
    fs::write(folder.path().join("down.toml"), scene(40.0)).expect("a file");
    let said = screen(folder.path(), &["pack", "down.toml", "-o", "benched"], 0);
    assert!(said.contains("clauses of the contract decide 3 or more of its rays each; fewer: "), "{said}");
    // The camera alone has one pitch for both axes; backs and edges are those of the bench.
    assert!(said.contains("pixel-pitches (0)") && !said.contains("fronts-only"), "{said}");
    let sensors = |name: &str| {
        let manifest = fs::read(folder.path().join(name).join("manifest.json")).expect("a manifest");
        let manifest: serde_json::Value = serde_json::from_slice(&manifest).expect("JSON");
        manifest["sensors"].as_array().expect("sensors").len()
    };
    assert_eq!(sensors("benched"), 1 + 7);

    let plain = raypencil(folder.path(), &["pack", "down.toml", "--no-bench", "-o", "plain", "--json"]);
    let plain: serde_json::Value = serde_json::from_slice(&plain.stdout).expect("JSON");
    let rays = |clause: &str| {
        let clauses = plain["clauses"].as_array().expect("clauses");
        clauses.iter().find(|one| one["clause"] == clause).expect("a clause of hits")["rays"].clone()
    };
    assert_eq!((sensors("plain"), rays("fronts-only"), rays("rows-from-the-top")), (1, 0.into(), 48.into()));
    let conflict = ["pack", "--blind", "3", "--no-bench", "-o", "x"];
    assert_trouble(&raypencil(folder.path(), &conflict), &["--no-bench"]);
}

#[test]
fn a_pack_in_which_nothing_is_hit_is_passed_by_nobody() {
    let folder = TempDir::new().expect("a temporary folder");
    fs::write(folder.path().join("up.toml"), scene(-60.0)).expect("a file");
    let packed = raypencil(folder.path(), &["pack", "up.toml", "--no-bench", "-o", "sky"]);
    assert_passes(&packed);
    assert!(text(&packed.stderr).contains("none of its 48 rays hits"), "{}", text(&packed.stderr));
    let checked = raypencil(folder.path(), &["check", "sky", "sky", "-o", "out"]);
    assert_fails(&checked, &["? No ray of this pack, or of one of its sets, hits anything"]);
    let json = fs::read_to_string(folder.path().join("out/check.json")).expect("a file");
    assert!(json.contains("\"verdict\": \"nothing_hit\""), "{json}");
    let junit = fs::read_to_string(folder.path().join("out/junit.xml")).expect("a file");
    assert!(
        junit.contains("failures=\"1\"") && junit.contains("no ray of this pack hits anything"),
        "{junit}"
    );
}

#[test]
fn an_input_pack_tests_a_loader() {
    let folder = TempDir::new().expect("a temporary folder");
    let said = screen(folder.path(), &["pack", "--input", "-o", "input"], 0);
    assert_eq!(said, "input: the input pack, 28 faces\n");
    let right = screen(folder.path(), &["check", "input", "input"], 0);
    assert!(right.ends_with("✓ 28 faces: all are right.\n"), "{right}");

    fs::create_dir(folder.path().join("mine")).expect("a folder");
    write_npy(folder.path().join("mine/triangles.npy"), &[&Image::filled(9, 29, 0.5)]).expect("a file");
    let wrong = raypencil(folder.path(), &["check", "input", "mine", "-o", "out"]);
    let words = ["✗ 28 of 28 faces are wrong; 29 are given.", "face 0, axes: is given as [", "glTF is y up"];
    assert_fails(&wrong, &words);
    let json = fs::read(folder.path().join("out/check.json")).expect("a file");
    let json: serde_json::Value = serde_json::from_slice(&json).expect("JSON");
    let triangles = &json["bundles"][0];
    assert_eq!(
        (&json["kind"], &json["verdict"], &triangles["worst_defects"][3]["quantity"]),
        (&"triangles".into(), &"defects".into(), &"scale".into())
    );
    assert_eq!((&triangles["classes"]["defects"], &triangles["classes"]["agree"]), (&29.into(), &0.into()));
    let schema =
        serde_json::from_str(include_str!("../../../../../../docs/formats/check.schema.json")).unwrap();
    assert_eq!(schema_faults(&schema, &json), Vec::<String>::new());
    let junit = fs::read_to_string(folder.path().join("out/junit.xml")).expect("a file");
    assert!(junit.contains("failures=\"22\""), "each clause, and the scene by a face too many: {junit}");

    let declared = ["check", "input", "mine", "--miss", "0"];
    assert_trouble(&raypencil(folder.path(), &declared), &["input is an input pack", "--miss"]);
    assert_trouble(&raypencil(folder.path(), &["check", "input", "nowhere"]), &["nowhere/triangles.npy"]);
    let both = ["pack", "pyramids", "--input", "-o", "x"];
    assert_trouble(&raypencil(folder.path(), &both), &["--input"]);
    // A pack of rays is no input pack.
    let rays = pack("hard").to_string_lossy().into_owned();
    assert_trouble(&raypencil(folder.path(), &["check", &rays, "mine"]), &["mine"]);
}

/// What an output folder has of something else is named, and goes only by `--force`.
#[test]
fn results_of_something_else_are_not_replaced_unasked() {
    let folder = TempDir::new().unwrap();
    let folder = folder.path();
    let write = |name: &str, text: &str| fs::write(folder.join(name), text).unwrap();
    let small = "version = 1\ncamera = { width_px = 4, height_px = 4 }\nbeam = [{ columns = 4, rows = 1 }]\n";
    write("a.toml", small);
    write("b.toml", small);
    write("g.obj", "v -9 -9 0\nv 9 -9 0\nv 0 9 0\nf 1 2 3\n");
    write("rays.csv", "0,0,1,0,0,-1\n");
    let run = |line: &str| raypencil(folder, &line.split(' ').collect::<Vec<_>>());
    let refused = |line: &str, of: &str| {
        assert_trouble(
            &run(line),
            &["it has results of ", of, "expected another folder, or --force to replace them"],
        );
        assert_passes(&run(&format!("{line} --force")));
    };
    // Of each command: the same again, and with other settings; then another subject.
    assert_passes(&run("render a.toml --with tracer -o r"));
    assert_passes(&run("render ./a.toml --with tracer -o r --set camera.width_px=5"));
    refused("render b.toml --with tracer -o r", "a.toml");
    refused("cast g.obj --ray 0,0,1,0,0,-1 -o r", "b.toml");
    refused("validate a.toml -o r", "g.obj");
    refused("pack a.toml --no-bench -o r", "a.toml");
    // Packs: the same again, another version, another scene, another kind.
    assert_passes(&run("pack a.toml --no-bench --pack-version 1.0.0 -o p"));
    assert_passes(&run("pack a.toml --no-bench --pack-version 1.0.0 -o p"));
    refused("pack a.toml --no-bench --pack-version 1.0.1 -o p", "a pack of a, version 1.0.0");
    refused("pack b.toml --no-bench -o p", "a pack of a, version 1.0.1");
    assert_passes(&run("pack g.obj --rays rays.csv -o q"));
    assert_passes(&run("pack g.obj --rays rays.csv -o q"));
    assert_trouble(&run("pack a.toml --no-bench -o q"), &["a pack of rays on g.obj"]);
    assert_trouble(&run("pack --input -o p"), &["a pack of b"]);
    // A check is of its pack, a sweep of its scene.
    assert_passes(&run("check p p -o c"));
    assert_passes(&run("check p p -o c"));
    assert_trouble(&run("check q q -o c"), &["it has results of ", "/p;"]);
    assert_passes(&run("sweep a.toml --do render -o s"));
    assert_passes(&run("sweep a.toml --do render --set camera.width_px=5,6 -o s"));
    refused("sweep b.toml --do render -o s", "a sweep of a.toml");
    assert_trouble(&run("sweep a.toml --do render -o c"), &["it has results of ", "/p;"]);
}

/// A file of more rays than there may be is refused by its size. It has no bytes on the disk, but to read it for a digest takes seconds.
#[cfg(target_os = "linux")]
#[test]
fn rays_that_are_too_many_are_refused_before_they_are_read() {
    let folder = TempDir::new().unwrap();
    fs::write(folder.path().join("one.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").unwrap();
    let rays = fs::File::create(folder.path().join("rays.npy")).unwrap();
    rays.set_len(16 << 30).unwrap();
    let line = format!(
        "ulimit -t 3; exec {} pack one.obj --rays rays.npy -o out --max-memory 256MB",
        env!("CARGO_BIN_EXE_raypencil")
    );
    let output =
        std::process::Command::new("sh").args(["-c", &line]).current_dir(folder.path()).output().unwrap();
    assert_trouble(&output, &["rays.npy: cannot read: 17179869184 bytes", "256000000"]);
}
