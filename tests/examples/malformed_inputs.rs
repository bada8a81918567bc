//! The malformed inputs: `just malformed-inputs` writes their table to `docs/evidence/malformed-inputs.md`. With a
//! folder as its argument the example writes the files there, as seeds for the fuzz targets (`just fuzz`).

use std::fs;
use std::path::Path;

use raypencil_tests::malformed::hostile::seeds;
use raypencil_tests::malformed::{Item, all, good, table, tiffs};

fn main() -> std::io::Result<()> {
    let Some(folder) = std::env::args().nth(1) else {
        print!("{}", table());
        return Ok(());
    };
    for case in all().into_iter().chain(good()).chain(tiffs()) {
        for (path, item) in &case.items {
            let Item::File(bytes) = item else { continue };
            // Larger files slow a fuzzer down and add no coverage.
            if let Some(target) = target(Path::new(path)).filter(|_| bytes.len() <= 1 << 14) {
                let folder = Path::new(&folder).join(target);
                fs::create_dir_all(&folder)?;
                fs::write(folder.join(&case.name), bytes)?;
            }
        }
    }
    for (target, name, bytes) in seeds() {
        let folder = Path::new(&folder).join(target);
        fs::create_dir_all(&folder)?;
        fs::write(folder.join(name), bytes)?;
    }
    Ok(())
}

/// The fuzz target for a file.
fn target(path: &Path) -> Option<&'static str> {
    match (path.file_name()?.to_str()?, path.extension()?.to_str()?) {
        ("manifest.json", _) => Some("manifest"),
        ("candidate.json", _) => Some("candidate"),
        ("my.pcd" | "my.ply", _) => Some("cloud"),
        (_, "tum") => Some("trajectory"),
        (_, "mcap") => Some("bag_poses"),
        (_, "glb" | "gltf") => Some("glb"),
        (_, "toml") => Some("scene_toml"),
        (_, "exr") => Some("exr"),
        (_, "npy") => Some("npy"),
        (_, "pfm") => Some("pfm"),
        (_, "tif") => Some("dem"),
        (_, "stl") => Some("stl"),
        (_, "obj") => Some("obj"),
        (_, "ply") => Some("ply"),
        _ => None,
    }
}
