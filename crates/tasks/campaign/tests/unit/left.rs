//! What the terrains of a shard leave beside their records, and what of it is removed when one runs again.

use super::*;
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
