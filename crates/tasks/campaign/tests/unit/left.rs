//! What the terrains of a shard leave, what of it is removed when one runs again, and which of them run again.

use std::sync::Mutex;

use super::*;
use crate::merge::merge;
use crate::record::PartName;
use tempfile::TempDir;

/// What this program made.
fn made(left: Vec<InputFile>) -> Option<Made> {
    Some(Made { program: program_sha256().to_string(), left })
}

/// A file with its digest.
fn input(folder: &Path, name: &str) -> InputFile {
    InputFile { name: name.into(), sha256: file_sha256_hex(&folder.join(name)).unwrap().1 }
}

#[test]
fn what_a_terrain_left_is_removed_where_it_is_as_it_was_and_nowhere_else() {
    let parent = TempDir::new().unwrap();
    let folder = parent.path().join("campaign");
    let names = [
        "wrong/terrain-000003-own/a",
        "wrong/changed",
        "misses/b",
        "terrains/c",
        "other/d",
        "../outside",
        "wrong/../../beside",
    ];
    let mut left = Vec::new();
    for name in names {
        let path = folder.join(name);
        create_folder(path.parent().unwrap()).unwrap();
        std::fs::write(&path, name).unwrap();
        left.push(input(&folder, name));
    }
    std::fs::write(folder.join("wrong/changed"), "by hand").unwrap();
    remove_left(&folder, made(left));
    let is_there = names.map(|name| folder.join(name).exists());
    assert_eq!(is_there, [false, true, false, true, true, true, true]);
    // Folders that became empty go too.
    assert!(!folder.join("misses").exists() && !folder.join("wrong/terrain-000003-own").exists());
}

#[cfg(unix)]
#[test]
fn a_link_in_the_place_of_what_a_terrain_left_stays() {
    let folder = TempDir::new().unwrap();
    let folder = folder.path();
    create_folder(&folder.join("wrong")).unwrap();
    std::fs::write(folder.join("mine"), "mine").unwrap();
    std::os::unix::fs::symlink("../mine", folder.join("wrong/a")).unwrap();
    // The bytes behind it are those that were noted.
    remove_left(folder, made(vec![input(folder, "wrong/a")]));
    assert!(std::fs::symlink_metadata(folder.join("wrong/a")).is_ok());
}

#[test]
fn a_terrain_leaves_files_of_its_number_in_two_folders() {
    let is_of_3 = |path: &str| is_left(Path::new(path), 3);
    for path in [
        "wrong/terrain-000003-own.toml",
        "wrong/terrain-000003-own/mesh.glb",
        "misses/terrain-000003-own/0/a",
    ] {
        assert!(is_of_3(path), "{path}");
    }
    for path in [
        "wrong/terrain-000004-own.toml",
        "wrong/terrain-0000031-own.toml",
        "terrains/terrain-000003-own.toml",
        "terrain-000003-own/wrong",
        "wrong",
        "../wrong/terrain-000003-own.toml",
    ] {
        assert!(!is_of_3(path), "{path}");
    }
}

/// What a run says of its progress.
#[derive(Default)]
struct Said(Mutex<Vec<[u64; 3]>>);

impl CampaignProgress for Said {
    fn done(&self, terrains: u64, of: u64, rays: u64) {
        self.0.lock().unwrap().push([terrains, of, rays]);
    }
}

#[test]
fn a_run_that_goes_on_takes_the_records_of_before_and_counts_its_own_rays() {
    let folder = TempDir::new().unwrap();
    let folder = folder.path();
    let campaign = Campaign::new(5, 2).with_parts(&[PartName::Lattice]).unwrap();
    let run = || {
        let said = Said::default();
        run_shard(&campaign, Shard::WHOLE, folder, &said).unwrap();
        said.0.into_inner().unwrap()
    };
    let first = run();
    let merged = merge(&[folder.to_path_buf()], None).unwrap();
    let [a, b] = [0, 1].map(|k: usize| merged.terrains[k].parts[0].compared);
    assert!(a > 0 && b > 0);
    assert_eq!(first, [[1, 2, a], [2, 2, a + b]]);
    assert_eq!(run(), [[1, 2, 0], [2, 2, 0]]);
    std::fs::remove_file(folder.join("terrains/terrain-000000.json")).unwrap();
    assert_eq!(run(), [[1, 2, a], [2, 2, a]]);
}
