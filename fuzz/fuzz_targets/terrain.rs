//! Fuzz target: any bytes as terrain in any mesh format. The first byte chooses the ending, the axes and the scale.

#![no_main]

use std::path::Path;

use libfuzzer_sys::fuzz_target;
use raypencil::io::{FileFrame, UpAxis, terrain_from_bytes};

const NAMES: [&str; 5] = ["any.stl", "any.obj", "any.ply", "any.gltf", "any"];

fuzz_target!(|bytes: &[u8]| {
    let Some((&choice, bytes)) = bytes.split_first() else { return };
    let choice = usize::from(choice);
    // The folder does not exist: external buffers are missing.
    let file = Path::new("no-such-folder").join(NAMES[choice % 5]);
    let up = [None, Some(UpAxis::Y), Some(UpAxis::Z)][choice / 5 % 3];
    let scale = [1.0, 0.001, 1e6][choice / 15 % 3];
    if let Ok(mesh) = terrain_from_bytes(bytes, &file, 0.25, &FileFrame { up, scale }) {
        assert!(!mesh.faces().is_empty());
        assert_eq!(mesh.faces().len(), mesh.face_materials().len());
    }
});
