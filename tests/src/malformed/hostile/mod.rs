//! Hostile inputs by rule: a good file, in which one place after the other is cut, replaced, doubled or left out.
//!
//! The cases of the other modules were written one by one, each for a check that a reader must have. These cover every place
//! of a small file, so that no check is forgotten. `crates/doors/cli/tests/it/malformed` runs them under the same limits.
//!
//! * [`Family`]: the cases of a reader, and those of them that are good files after all.
//! * `edits`: cuts, and values in place of others. `calibrations`, `campaign`, `rays`, `meshes`, `generate`: the families.

mod calibrations;
mod campaign;
mod edits;
mod generate;
mod meshes;
mod rays;

pub use calibrations::calibrations;
pub use campaign::{campaign_records, hostile_record};
pub use generate::generators;
pub use meshes::meshes;
pub use rays::rays;

use super::case::Case;

/// The hostile cases of a reader.
#[derive(Debug)]
pub struct Family {
    /// The cases, each with a name of its own.
    pub cases: Vec<Case>,
    /// Whether the case of this name is right to be accepted: by its format, the change left a good file.
    pub is_good: fn(&str) -> bool,
}

/// Good files for fuzz targets whose first byte is a choice: the target, a name and the bytes.
pub fn seeds() -> Vec<(&'static str, String, Vec<u8>)> {
    let mut seeds = Vec::new();
    for (at, (ending, bytes)) in meshes::good().into_iter().enumerate() {
        let kind = ["stl", "obj", "ply"].iter().position(|one| *one == ending).expect("a mesh format") as u8;
        // As `fuzz/fuzz_targets/terrain.rs` reads it: axes and scale of the file, and others.
        for choice in [kind, kind + 5 + 15, kind + 10 + 30] {
            seeds.push(("terrain", format!("{ending}-{at}-{choice}"), [&[choice], &bytes[..]].concat()));
        }
    }
    seeds.push(("terrain", "gltf".into(), [&[3], &super::glb::good()[..]].concat()));
    seeds.push(("camera_info", "message".into(), calibrations::MESSAGE.into()));
    for (name, bytes) in campaign::good() {
        // As `fuzz/fuzz_targets/campaign.rs` reads it: of this program and sealed there, or as it is.
        for choice in [0, 3] {
            seeds.push(("campaign", format!("{name}-{choice}"), [&[choice], &bytes[..]].concat()));
        }
    }
    seeds
}
