//! Hostile inputs by rule: a good file, in which one place after the other is cut, replaced, doubled or left out.
//!
//! The cases of the other modules were written one by one, each for a check that a reader must have. These cover every place
//! of a small file, so that no check is forgotten. `crates/doors/cli/tests/it/malformed` runs them under the same limits.
//!
//! * [`Family`]: the cases of a reader, and those of them that are good files after all.
//! * `edits`: cuts, and values in place of others. The other modules: the families, which [`families`] lists.

mod arrays;
mod calibrations;
mod campaign;
mod edits;
mod generate;
mod meshes;
mod packs;
mod poses;
mod rays;
mod sealed;
mod settings;

pub use arrays::ray_arrays;
pub use calibrations::calibrations;
pub use campaign::{campaign_records, hostile_record};
pub use generate::generators;
pub use meshes::meshes;
pub use packs::{manifests, notes, packed_maps};
pub use poses::{bags, trajectories};
pub use rays::{patterns, rays};
pub use sealed::{sealed_campaigns, sealed_sweeps};
pub use settings::{lists, settings};

use serde_json::Value;

use super::case::Case;

/// The hostile cases of a reader.
#[derive(Debug)]
pub struct Family {
    /// The cases, each with a name of its own.
    pub cases: Vec<Case>,
    /// Whether the case of this name is right to be accepted: by its format, the change left a good file.
    pub is_good: fn(&str) -> bool,
    /// Of cases of which the rule cannot tell whether they are good: the exit codes besides 2 that are right. Empty: it can tell.
    pub open: &'static [i32],
}

impl Family {
    /// Cases that must all be refused.
    pub fn of(cases: Vec<Case>) -> Self {
        Self { cases, is_good: |_| false, open: &[] }
    }
}

/// The name of a family, and what makes it for a program that writes this into its results.
pub type NamedFamily = (&'static str, fn(&Value) -> Family);

/// All families by what they are, each made when it is asked for, for a program that writes `campaign` into its results.
pub fn families() -> [NamedFamily; 16] {
    [
        ("results of campaigns, re-sealed", campaign_records),
        ("results of campaigns, byte by byte", sealed_campaigns),
        ("records and plans of sweeps, byte by byte", |_| sealed_sweeps()),
        ("keys and values of `--set`", |_| settings()),
        ("keys and values of `sweep --list`", |_| lists()),
        ("patterns of rays, value by value, CSV and NPY", |_| rays()),
        ("patterns of rays, byte by byte", |_| patterns()),
        ("arrays of rays by type and shape, sparse and huge", |_| ray_arrays()),
        ("manifests of packs, byte by byte", |_| manifests()),
        ("NPY and EXR of packs, byte by byte", |_| packed_maps()),
        ("`candidate.json`, byte by byte", |_| notes()),
        ("trajectories", |_| trajectories()),
        ("bags, byte by byte", |_| bags()),
        ("meshes", |_| meshes()),
        ("calibrations of cameras", |_| calibrations()),
        ("generated ground", |_| generators()),
    ]
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
    for (name, bytes) in sealed::good() {
        // As `fuzz/fuzz_targets/sweep.rs` reads it.
        for choice in [0, 1] {
            seeds.push(("sweep", format!("{name}-{choice}"), [&[choice], bytes].concat()));
        }
    }
    for (at, text) in settings::good().into_iter().enumerate() {
        seeds.push(("settings", format!("setting-{at}"), text.into_bytes()));
    }
    for (name, bytes) in campaign::good() {
        // As `fuzz/fuzz_targets/campaign.rs` reads it: of this program and sealed there, or as it is.
        for choice in [0, 3] {
            seeds.push(("campaign", format!("{name}-{choice}"), [&[choice], &bytes[..]].concat()));
        }
    }
    seeds
}
