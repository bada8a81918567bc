//! Packs of rays, and what people give to be checked against them.

use std::fs;
use std::path::Path;

use raypencil::io::{Limits, read_npy_numbers, write_npy_numbers};
use tempfile::TempDir;

use super::{assert_trouble, raypencil, screen};

/// A floor of 8 m by 8 m, and a pack of four rays of which three hit it, with answers in the folder `answers`.
fn folder() -> TempDir {
    let folder = TempDir::new().expect("a temporary folder");
    let at = |name: &str, text: &str| fs::write(folder.path().join(name), text).expect("a file");
    at("floor.obj", "v -4 -4 0\nv 4 -4 0\nv 4 4 0\nv -4 4 0\nf 1 2 3\nf 1 3 4\n");
    at("rays.csv", "1,0.5,3,0,0,-2\n-1,0.25,3,0.125,0,-2\n9,0,3,0,0,-1\n0.7,-0.3,5,0.1,0.2,-3\n");
    screen(folder.path(), &["pack", "floor.obj", "--rays", "rays.csv", "-o", "pack"], 0);
    screen(folder.path(), &["cast", "floor.obj", "rays.csv", "-o", "answers"], 0);
    folder
}

/// Changes the numbers of an array of the answers.
fn change(folder: &Path, name: &str, by: impl Fn(f64) -> f64) {
    let path = folder.join("answers").join(format!("{name}.npy"));
    let array = read_npy_numbers(&path, &Limits::default()).expect("an array");
    let numbers: Vec<f64> = array.values.into_iter().map(by).collect();
    write_npy_numbers(&path, &array.shape, &numbers).expect("a file");
}

#[test]
fn the_note_of_answers_to_rays_is_followed() {
    let folder = folder();
    let at = folder.path();
    let note = |keys: &str| {
        let text = format!("{{\"format\": 1, \"program\": \"mine 2\", \"arithmetic\": \"f32\"{keys}}}");
        fs::write(at.join("answers/candidate.json"), text).expect("a file");
    };
    let check = ["check", "pack", "answers"];
    screen(at, &check, 0);
    // What single precision computes, -5 where nothing is hit, and faces of another order.
    for name in ["t", "range"] {
        change(at, name, |length| if length.is_finite() { length * (1.0 + 1e-7) } else { -5.0 });
    }
    change(at, "face", |face| 1.0 - face.min(1.0));
    let plain = [&check[..], &["--miss", "-5", "--no-faces"]].concat();
    screen(at, &check, 1);
    screen(at, &plain, 1);
    screen(at, &[&plain[..], &["--arithmetic", "f32"]].concat(), 0);
    note(", \"miss\": -5, \"no_faces\": true");
    let shown = screen(at, &check, 0);
    assert!(shown.contains("✓ 4 rays agree with the exact answers"), "{shown}");
    // An option counts more.
    screen(at, &[&check[..], &["--arithmetic", "f64"]].concat(), 1);
    screen(at, &[&check[..], &["--miss", "-6"]].concat(), 1);
    for (keys, words) in [
        (", \"miss\": \"high\"", "miss; expected a number or \"nan\""),
        (", \"scale\": 0.001", "scale: 0.001; expected no channels and no scale"),
        (", \"channels\": {\"range.T\": \"V\"}", "channels: range.T: V; expected no channels and no scale"),
    ] {
        note(keys);
        assert_trouble(&raypencil(at, &check), &["candidate.json", words]);
    }
}
