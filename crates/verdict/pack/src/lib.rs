//! Reference packs: a scene with every answer correctly rounded, and the check of another program's answers.
//!
//! Internal to raypencil: any version may change its items. The crate `raypencil` is the door.
//!
//! A pack lets other people test their renderer without running ours. The formats are described in
//! `docs/formats/files.md`, `docs/formats/pack.schema.json` and `docs/formats/check.schema.json`. The answers come from
//! the exact referee (`raypencil-referee`) by way of `raypencil-judge`.
//!
//! ```text
//! bench/                             rays at the limits of the contract, added to a scene
//! split_mix -> blind                 scenes from a seed
//! clauses                            how many rays decide each clause of the contract
//! sharpness                          how large a tolerance of each clause is noticed
//! canonical_nan, units               values and units of channels
//! manifest/                          manifest.json: structure, paths, consistency, reading, writing
//! margins                            how far each ray is from another answer
//! arrays, exr_map, rays -> write     the files of a pack
//! note_values -> provenance          the candidate's note
//! declarations -> check              what is declared about a candidate, also in its note; the check of a candidate
//! published                          version and licence of a pack, and the packs that are published
//! labels                             types, shapes, names and units of a pack's arrays and maps
//! verification, claims               which answers are compared with the referee's; what else a manifest says of its scene
//! input/                             a glTF file, the triangles that it must become, and the check of a loader
//! check_report/                      a check in its one form, which every report prints
//! ```
//!
//! ```
//! use std::path::Path;
//!
//! use raypencil_pack::check_pack;
//! use raypencil_scene::Silent;
//!
//! // A pack is a perfect candidate: all rays agree exactly. 7,936 are those of the scene, and 2,546 of the bench.
//! let pack = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../data/packs/pyramids");
//! let checked = check_pack(&pack, &pack, None, &Silent)?;
//! assert_eq!(checked.check.compared(), 96 * 72 + 2 * 128 * 4 + 2546);
//! assert!(checked.document().screen().contains("✓ 10,482 rays agree with the exact answers: 10,482 exact"));
//! # Ok::<(), raypencil_pack::CheckError>(())
//! ```

mod arrays;
mod bench;
mod blind;
mod canonical_nan;
mod check;
mod check_report;
mod claims;
mod clauses;
mod declarations;
mod exr_map;
mod input;
mod labels;
mod manifest;
mod margins;
mod note_values;
mod provenance;
mod published;
mod rays;
mod sharpness;
mod split_mix;
mod units;
mod verification;
mod write;

pub use bench::{BENCH_BEAMS, BITING_BEAMS, with_bench};
pub use blind::{blind_scene, blind_subject};
pub use check::{CheckError, Checked, Verified, check_pack, check_pack_by};
pub use check_report::{
    BundleFindings, CheckFindings, ItemFindings, PackForm, Said, WorstOf, WrongRay, check_suite,
    half_precision_note, items_not_given, not_given, rays_not_given, write_document,
};
pub use claims::Found;
pub use clauses::{ClauseRays, MIN_RAYS_PER_CLAUSE, can_count_clauses, clause_rays};
pub use declarations::Declarations;
pub use input::{
    InputChecked, InputFace, LoadingClause, WrongFace, check_input, input_faces, input_glb, is_input_pack,
    write_input,
};
pub use manifest::{
    ChannelType, FileRole, FileType, MANIFEST_FORMAT, Manifest, ManifestChannel, ManifestClause,
    ManifestFile, ManifestScene, ManifestSensor, ManifestSharpness, PackKind,
};
pub use note_values::{ChannelNames, MissNumber};
pub use provenance::{Arithmetic, MonteCarloTotal, Provenance, ProvenanceError, note, precision_of};
pub use published::{PUBLISHED, PackIdentity, PackLabel, PublishedPack};
pub use sharpness::{Sharpness, sharpness};
pub use verification::{DRAWN, MAX_ALL, Verification};
pub use write::{PackError, benched, write_pack, write_pack_of_ray, write_questions};

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

// The tests by public items are in the program of the unit tests: one executable for the crate.
#[cfg(test)]
extern crate self as raypencil_pack;
#[cfg(test)]
#[path = "../tests/it/mod.rs"]
mod it;
