//! Packs with one byte after the other changed: of the manifest, of the maps, and of the note beside a recording.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::sync::{Arc, OnceLock};

use raypencil::Silent;
use raypencil::harness::write_pack_with_ray_sets;
use raypencil::io::load_text;
use raypencil::pack::PackLabel;
use serde_json::{Value, json};
use tempfile::TempDir;

use super::Family;
use super::edits::with_each_byte;
use crate::malformed::case::{Case, Item};

const SCENE: &str = "version = 1\n[camera]\nwidth_px = 4\nheight_px = 3\npixel_pitch_um = 2000\npitch_down_deg = \
                     40\n[terrain]\nbuiltin = \"pyramids\"\n[[beam]]\ncolumns = 4\nrows = 1\n";

/// One in so many changes of the manifest, and of each map, is tried.
const MANIFEST_STRIDE: usize = 31;
const MAP_STRIDE: usize = 11;

type Files = BTreeMap<String, Vec<u8>>;

/// The files of a small pack.
fn pack() -> &'static Arc<Files> {
    static PACK: OnceLock<Arc<Files>> = OnceLock::new();
    PACK.get_or_init(|| {
        let folder = TempDir::new().expect("a folder");
        let subject = load_text(SCENE, "small").expect("a scene").into_subject("small.toml".into());
        write_pack_with_ray_sets(&subject, None, &PackLabel::default(), folder.path(), &Silent)
            .expect("a pack");
        let mut files = Files::new();
        collect(folder.path(), "", &mut files);
        Arc::new(files)
    })
}

fn collect(folder: &Path, prefix: &str, files: &mut Files) {
    for entry in fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry")) {
        let name = format!("{prefix}{}", entry.file_name().to_string_lossy());
        match entry.path().is_dir() {
            true => collect(&entry.path(), &format!("{name}/"), files),
            false => drop(files.insert(name, fs::read(entry.path()).expect("a file"))),
        }
    }
}

/// The right answers to the pack, of which a file of the pack, or of the answers, is another one.
fn checked(name: String, what: &'static str, file: &str, bytes: Vec<u8>, words: &[&str]) -> Case {
    let files = || Item::Files(pack().clone());
    let case = Case::new(name, what, "check pack mine -o out", words);
    case.item("pack", files()).item("mine", files()).file(file, bytes)
}

/// Manifests. Whatever one says, right answers are never called wrong: it is refused, or the answers pass.
pub fn manifests() -> Family {
    let changed = with_each_byte(&pack()["manifest.json"]).into_iter().step_by(MANIFEST_STRIDE);
    let case = |(name, bytes): (String, Vec<u8>)| {
        checked(format!("manifest-{name}"), "a changed byte of a manifest", "pack/manifest.json", bytes, &[])
    };
    Family {
        is_good: |name| name.ends_with("unchanged"),
        open: &[0],
        ..Family::of(changed.map(case).collect())
    }
}

/// Maps of a pack, whose digests its manifest has: each is refused.
pub fn packed_maps() -> Family {
    let mut cases = Vec::new();
    let is_map = |name: &&String| name.ends_with(".npy") || name.ends_with(".exr");
    for (number, file) in pack().keys().filter(is_map).enumerate() {
        // Some places of each.
        for (name, bytes) in
            with_each_byte(&pack()[file]).into_iter().skip(1 + number % MAP_STRIDE).step_by(MAP_STRIDE)
        {
            let (name, place) = (format!("packed-{number}-{name}"), format!("pack/{file}"));
            cases.push(checked(name, "a changed byte of a map", &place, bytes, &["pack"]));
        }
    }
    Family::of(cases)
}

/// Notes of a recording. What one declares may make right answers wrong, such as another number for a miss.
pub fn notes() -> Family {
    let manifest: Value = serde_json::from_slice(&pack()["manifest.json"]).expect("JSON");
    let note = json!({
        "format": 1, "program": "P 1", "arithmetic": "f64",
        "scene": { "name": "small", "sha256": manifest["scene"]["sha256"] },
        "totals": [{ "way": "direct", "beam": 0, "mean": 1.0, "error": 0.1 }],
    });
    let case = |(name, bytes): (String, Vec<u8>)| {
        checked(format!("note-{name}"), "a changed byte of a note", "mine/candidate.json", bytes, &[])
    };
    let changed = with_each_byte(format!("{note:#}").as_bytes()).into_iter();
    Family { open: &[0, 1], ..Family::of(changed.map(case).collect()) }
}
