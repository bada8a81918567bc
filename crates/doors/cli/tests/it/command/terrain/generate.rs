//! `terrain generate`: reports, determinism, errors.

use raypencil::io::load_mesh;
use raypencil::terrain::height_at;
use serde_json::Value;
use tempfile::TempDir;

use super::super::{assert_trouble, raypencil, screen};
use super::import::geotiff;

/// `terrain generate` of a small terrain, with more arguments.
fn generate<'a>(more: &[&'a str]) -> Vec<&'a str> {
    [&["terrain", "generate", "--extent", "6", "--post-spacing", "0.3"], more].concat()
}

#[test]
fn a_terrain_is_generated_reported_and_written_with_its_parameters() {
    let folder = TempDir::new().expect("a temporary folder");
    let arguments = generate(&["--preset", "pathfinder", "--seed", "3", "-o", "made/ground.glb"]);
    let shown = screen(folder.path(), &arguments, 0);
    for line in [
        "pathfinder, seed 3",
        "  rocks  ",
        "of the ground (the law: 0.",
        "craters        none",
        "made/ground.glb",
    ] {
        assert!(shown.contains(line), "{line} is not in:\n{shown}");
    }
    // The same seed gives the same bytes; another seed gives others.
    let bytes = |name: &str| std::fs::read(folder.path().join("made").join(name)).expect("a file");
    screen(folder.path(), &generate(&["--preset", "pathfinder", "--seed", "3", "-o", "made/again.glb"]), 0);
    screen(folder.path(), &generate(&["--preset", "pathfinder", "--seed", "4", "-o", "made/other.glb"]), 0);
    assert_eq!(bytes("ground.glb"), bytes("again.glb"));
    assert_ne!(bytes("ground.glb"), bytes("other.glb"));

    // The file states its parameters. The JSON chunk begins after 20 bytes.
    let glb = bytes("ground.glb");
    let length = u32::from_le_bytes([glb[12], glb[13], glb[14], glb[15]]) as usize;
    let document: Value = serde_json::from_slice(&glb[20..20 + length]).expect("JSON");
    let extras = &document["nodes"][0]["extras"];
    assert_eq!((&extras["preset"], &extras["seed"]), (&"pathfinder".into(), &3.into()));
    assert_eq!(extras["rock_coverage"], 0.19);
    let names: Vec<&str> = document["materials"]
        .as_array()
        .expect("materials")
        .iter()
        .filter_map(|m| m["name"].as_str())
        .collect();
    assert_eq!(names, ["soil", "rock", "crevasse wall"]);
    // The terrain has no faults.
    assert!(screen(folder.path(), &["terrain", "inspect", "made/ground.glb"], 0).contains("PASS"));
}

#[test]
fn the_surface_interpolates_the_coarse_posts() {
    let folder = TempDir::new().expect("a temporary folder");
    // 5 x 4 posts 2 m apart, the north-west one at (1000001, 499); rows from the north.
    let heights: Vec<f32> = (0..20_u16).map(|k| f32::from(k * k % 7) * 0.25).collect();
    std::fs::write(folder.path().join("mola.tif"), geotiff(5, 4, &heights)).expect("a file");
    let arguments = [
        "terrain",
        "generate",
        "--preset",
        "smooth",
        "--rock-coverage",
        "0",
        "--post-spacing",
        "0.3",
        "--fine-radius",
        "0",
        "--coarse",
        "mola.tif",
        "-o",
        "fine.glb",
    ];
    screen(folder.path(), &arguments, 0);
    let mesh = load_mesh(folder.path().join("fine.glb")).expect("a mesh");
    // 2 m halved three times is 0.25 m: 32 x 24 cells.
    assert_eq!(mesh.faces().len(), 2 * 32 * 24);
    for (k, height) in heights.iter().enumerate() {
        let (x, y) = (1_000_001.0 + 2.0 * (k % 5) as f64, 499.0 - 2.0 * (k / 5) as f64);
        // Heights of a few metres as offsets in single precision: 2^-23 m.
        let z = height_at(&mesh, x, y).expect("ground there");
        assert!((z - f64::from(*height)).abs() < 2e-7, "{z} for {height} at {x}, {y}");
    }
    // A part of the model: the posts from x = 1000003 to 1000007 m and y = 495 to 499 m.
    let part = [&arguments[..arguments.len() - 1], &["part.glb", "--window", "1000003,495,4,4"]].concat();
    screen(folder.path(), &part, 0);
    assert_eq!(load_mesh(folder.path().join("part.glb")).expect("a mesh").faces().len(), 2 * 16 * 16);
    // The whole of it is too much at a millimetre; the part is offered.
    let fine = ["terrain", "generate", "--coarse", "mola.tif", "--post-spacing", "0.001", "-o", "x.glb"];
    assert_trouble(
        &raypencil(folder.path(), &fine),
        &["faces in all", "--window X,Y,WIDTH,HEIGHT", "--post-spacing"],
    );
    assert_trouble(
        &raypencil(folder.path(), &[&fine[..], &["--window", "1,2,3"]].concat()),
        &["x, y, width and height"],
    );
    // The same parameters in a scene give the same terrain.
    let scene = "version = 1\n[vehicle]\nposition_m = [1000005, 496]\n[terrain]\n\
        generate = { preset = \"smooth\", rock_coverage = 0, post_spacing_m = 0.3, fine_radius_m = 0, coarse = \"mola.tif\" }\n";
    std::fs::write(folder.path().join("fine.toml"), scene).expect("a file");
    let same = screen(folder.path(), &["terrain", "inspect", "fine.toml", "--json"], 0);
    let same: Value = serde_json::from_str(&same).expect("JSON");
    let direct = screen(folder.path(), &["terrain", "inspect", "fine.glb", "--json"], 0);
    let direct: Value = serde_json::from_str(&direct).expect("JSON");
    assert_eq!(same["bounds_m"], direct["bounds_m"]);
}

#[test]
fn errors_are_named_and_leave_no_file() {
    let folder = TempDir::new().expect("a temporary folder");
    let trouble = |more: &[&str], words: &[&str]| {
        assert_trouble(&raypencil(folder.path(), &generate(more)), words);
        assert_eq!(std::fs::read_dir(folder.path()).expect("a folder").count(), 1);
    };
    let mut heights = vec![1.0; 20];
    heights[7] = -9999.0;
    std::fs::write(folder.path().join("hole.tif"), geotiff(5, 4, &heights)).expect("a file");
    trouble(&["--preset", "venus", "-o", "x.glb"], &["--preset venus", "viking1, pathfinder"]);
    trouble(
        &["--preset", "worst", "--crevasses", "40", "-o", "x.glb"],
        &["crevasses is 40", "there is no place for more of 0.8 m"],
    );
    trouble(&["--rock-coverage", "NaN", "-o", "x.glb"], &["rock_coverage is NaN", "0 to 0.4"]);
    trouble(&["--rock-smallest", "1e-9", "-o", "x.glb"], &["rock_smallest_m"]);
    trouble(&["--fine-radius", "-1", "-o", "x.glb"], &["fine_radius_m is -1", "0 to 10000"]);
    trouble(&["-o", "x.ply"], &["x.ply", "ends in .glb"]);
    let coarse = ["terrain", "generate", "--coarse", "hole.tif", "-o", "x.glb"];
    // Rows of posts count from the south: the second row from the north is the third of four.
    assert_trouble(
        &raypencil(folder.path(), &coarse),
        &["--coarse hole.tif: 1 of its posts is unknown", "--window X,Y,WIDTH,HEIGHT"],
    );
    let absurd = ["terrain", "generate", "--extent", "1e5", "--post-spacing", "0.001", "-o", "x.glb"];
    assert_trouble(&raypencil(folder.path(), &absurd), &["post_spacing_m", "at most 33554432 faces"]);
}
