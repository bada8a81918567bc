//! Memory for buffers in files beside a glTF file: each file once, and at most 512 MiB of all.

use std::fs::File;
use std::path::PathBuf;

use raypencil_files::sha256;
use raypencil_mesh_io::{MAX_BUFFER_FILES_BYTES, load_mesh, read_triangles};
use serde_json::json;
use tempfile::TempDir;

use super::memory::peak_bytes;
use super::*;

/// Writes a glTF file with one square for each of `uris`, whose buffers are in these files.
fn gltf(folder: &TempDir, uris: &[&str]) -> PathBuf {
    let (mut json, _) = square();
    let count = uris.len();
    json["buffers"] = uris.iter().map(|uri| json!({"byteLength": 60, "uri": uri})).collect();
    json["bufferViews"] = (0..count)
        .flat_map(|buffer| {
            [(0, 48), (48, 12)]
                .map(|(at, length)| json!({"buffer": buffer, "byteOffset": at, "byteLength": length}))
        })
        .collect();
    json["accessors"] = (0..count)
        .flat_map(|buffer| {
            [
                json!({"bufferView": 2 * buffer, "componentType": 5126, "count": 4, "type": "VEC3"}),
                json!({"bufferView": 2 * buffer + 1, "componentType": 5123, "count": 6, "type": "SCALAR"}),
            ]
        })
        .collect();
    let primitive =
        |buffer: usize| json!({"attributes": {"POSITION": 2 * buffer}, "indices": 2 * buffer + 1});
    json["meshes"][0]["primitives"] = (0..count).map(primitive).collect();
    let path = folder.path().join("ground.gltf");
    std::fs::write(&path, json.to_string()).unwrap();
    path
}

/// Creates a file of this length that takes no space on the disk: all but its beginning is a hole.
fn hole(folder: &TempDir, name: &str, bytes: &[u8], length: u64) {
    let path = folder.path().join(name);
    std::fs::write(&path, bytes).unwrap();
    File::options().write(true).open(path).unwrap().set_len(length).unwrap();
}

#[test]
fn a_file_that_many_buffers_name_is_read_once() {
    let folder = TempDir::new().unwrap();
    let (_, bin) = square();
    let length = 8 << 20;
    hole(&folder, "a.bin", &bin, length);
    std::fs::create_dir(folder.path().join("b")).unwrap();
    #[cfg(unix)]
    std::os::unix::fs::symlink("../a.bin", folder.path().join("b/c.bin")).unwrap();
    #[cfg(not(unix))]
    hole(&folder, "b/c.bin", &bin, 60);
    // Several names of one file.
    let uris: Vec<&str> = ["a.bin", "./a.bin", "%61.bin", "b/c.bin"].repeat(10);
    let path = gltf(&folder, &uris);
    let (mesh, peak) = peak_bytes(|| load_mesh(&path));
    assert_eq!(mesh.unwrap().faces().len(), 2 * 40);
    assert!(peak < 3 * length as usize / 2, "{peak} bytes for a buffer of {length}");
    // The digest of the file counts for each buffer, as it always has.
    let digests = read_triangles(&path).unwrap().digests;
    let digest = sha256(&std::fs::read(folder.path().join("a.bin")).unwrap());
    assert_eq!(digests.len(), 41);
    assert!(digests[1..].iter().all(|other| *other == digest));
}

#[test]
fn files_of_buffers_have_a_limit_together() {
    assert_eq!(MAX_BUFFER_FILES_BYTES, 512 << 20);
    let folder = TempDir::new().unwrap();
    let (_, bin) = square();
    let refused = |uris: &[&str], words: &str| {
        let path = gltf(&folder, uris);
        let (result, peak) = peak_bytes(|| load_mesh(&path));
        let error = result.unwrap_err().to_string();
        assert!(error.ends_with(words), "{error}");
        // The files are not read.
        assert!(peak < 1 << 20, "{peak}");
    };
    hole(&folder, "large.bin", &bin, MAX_BUFFER_FILES_BYTES + 1);
    refused(
        &["large.bin"],
        "buffer 0: a file of 536870913 bytes after 0 bytes of others; expected at most 536870912 bytes in all files of \
         buffers",
    );
    std::fs::write(folder.path().join("small.bin"), &bin).unwrap();
    hole(&folder, "rest.bin", &bin, MAX_BUFFER_FILES_BYTES - 59);
    refused(
        &["small.bin", "small.bin", "rest.bin"],
        "buffer 2: a file of 536870853 bytes after 60 bytes of others; expected at most 536870912 bytes in all files of \
         buffers",
    );
}
