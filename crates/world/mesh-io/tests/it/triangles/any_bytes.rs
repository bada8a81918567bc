//! Damaged files never panic, and never ask for much more memory than they have bytes.

use proptest::prelude::*;

use super::memory::peak_bytes;
use super::samples::{self, all, npy_faces, npy_vertices};
use super::*;

/// Most memory for each byte of a file. A list of corners of one byte each takes most: a face of 12 bytes and its
/// polygon of 4, twice over while they grow, and the corners themselves.
const BYTES_PER_BYTE: usize = 64;

/// Memory whatever the file: messages, and tables of a glTF file.
const CONSTANT_BYTES: usize = 1 << 16;

/// Mesh or message; a panic fails the test, and so does a hunger for memory.
fn survives(name: &str, bytes: &[u8]) {
    let (_, peak) = peak_bytes(|| parse(&format!("no/such/folder/{name}"), bytes).map(drop));
    let limit = BYTES_PER_BYTE * bytes.len() + CONSTANT_BYTES;
    assert!(peak <= limit, "{name}: {peak} bytes of memory for {} of the file", bytes.len());
}

#[test]
fn a_file_cut_anywhere_is_read_or_refused() {
    for (name, bytes) in all() {
        let mut meshes = 0;
        for end in 0..bytes.len() {
            survives(name, &bytes[..end]);
            meshes += usize::from(parse(name, &bytes[..end]).is_ok());
        }
        // The end of a text may be cut off without harm: a line feed, a name. Binary files have no such end. OBJ has
        // no end at all: a part of it is a smaller mesh.
        let allowed = match name {
            "any.obj" => bytes.len(),
            "text.stl" => "solid any name\n".len() + 1,
            "text.ply" => 2,
            _ => 0,
        };
        assert!(meshes <= allowed, "{name}: {meshes}");
    }
}

#[test]
fn a_pair_of_arrays_cut_anywhere_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let [vertices, faces] = ["vertices.npy", "faces.npy"].map(|name| folder.path().join(name));
    for cut_faces in [false, true] {
        let bytes = if cut_faces { npy_faces() } else { npy_vertices() };
        std::fs::write(&vertices, npy_vertices()).unwrap();
        std::fs::write(&faces, npy_faces()).unwrap();
        for end in 0..bytes.len() {
            std::fs::write(if cut_faces { &faces } else { &vertices }, &bytes[..end]).unwrap();
            assert!(raypencil_mesh_io::load_triangles(folder.path()).is_err(), "{end}");
        }
    }
}

#[test]
fn large_files_take_a_multiple_of_their_size() {
    // Where each byte of the file costs most.
    let header = "ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty uchar x\nproperty uchar y\n\
                  property uchar z\nelement face 1\nproperty list uint uchar vertex_index\nend_header\n";
    let corners = 1_u32 << 18;
    let fan = [header.as_bytes(), &[1, 2, 3], &corners.to_le_bytes(), &vec![0; corners as usize]].concat();
    let points = header.replace("vertex 1", "vertex 100000").replace("face 1", "face 0");
    let points = [points.as_bytes(), &vec![7; 300_000]].concat();
    let mut stl = vec![b'x'; 84];
    stl[80..].copy_from_slice(&10_000_u32.to_le_bytes());
    stl.extend((0..10_000_u32).flat_map(|face| {
        let mut bytes = [0; 50];
        (12..48)
            .step_by(4)
            .for_each(|at| bytes[at..at + 2].copy_from_slice(&(face as u16 ^ at as u16).to_le_bytes()));
        // The exponents keep all corners apart.
        (15..48).step_by(4).for_each(|at| bytes[at] = at as u8);
        bytes
    }));
    let obj = format!("v 0 0 0\nf{}\n", " 1".repeat(100_000));
    let files: [(&str, &[u8], usize); 4] = [
        ("fan.ply", &fan, corners as usize - 2),
        ("points.ply", &points, 0),
        ("corners.stl", &stl, 10_000),
        ("fan.obj", obj.as_bytes(), 99_998),
    ];
    for (name, bytes, faces) in files {
        assert_eq!(parse(name, bytes).unwrap().faces().len(), faces, "{name}");
        survives(name, bytes);
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 4000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn changed_bytes_never_panic(
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..8),
        end in prop::option::of(any::<prop::sample::Index>()),
    ) {
        for (name, mut bytes) in all() {
            for (at, byte) in &changes {
                let at = at.index(bytes.len());
                bytes[at] = *byte;
            }
            if let Some(end) = &end {
                bytes.truncate(end.index(bytes.len()));
            }
            survives(name, &bytes);
        }
    }

    // Changed digits leave a text valid and change its numbers: counts, indices and types.
    #[test]
    fn changed_digits_never_panic(
        changes in prop::collection::vec((any::<prop::sample::Index>(), b'0'..=b'9'), 1..6),
    ) {
        for (name, mut bytes) in all() {
            let digits: Vec<usize> = (20..bytes.len()).filter(|&at| bytes[at].is_ascii_digit()).collect();
            if digits.is_empty() {
                continue;
            }
            for (at, digit) in &changes {
                bytes[digits[at.index(digits.len())]] = *digit;
            }
            survives(name, &bytes);
        }
    }

    #[test]
    fn any_bytes_after_a_valid_start_never_panic(rest in prop::collection::vec(any::<u8>(), 0..200)) {
        let starts: [(&str, Vec<u8>); 6] = [
            ("a.stl", vec![]),
            ("a.stl", b"solid\nfacet normal 0 0 0 outer loop vertex ".to_vec()),
            ("a.obj", b"v 0 0 0\nf ".to_vec()),
            ("a.ply", b"ply\n".to_vec()),
            ("a.ply", samples::ply_header("binary_big_endian", "double", "char", "short").into_bytes()),
            ("a.bin", vec![]),
        ];
        for (name, start) in starts {
            survives(name, &[start, rest.clone()].concat());
        }
    }
}
