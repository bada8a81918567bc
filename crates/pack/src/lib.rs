//! Reference packs: a scene with every answer correctly rounded, and the check of another program's answers.
//!
//! A pack lets other people test their renderer without running ours. The formats are described in
//! `docs/formats/files.md`, `docs/formats/pack.schema.json` and `docs/formats/check.schema.json`. The answers come from
//! the exact referee (`raypencil-referee`) by way of `raypencil-judge`.
//!
//! ```text
//! split_mix -> blind                 scenes from a seed
//! canonical_nan, units               values and units of channels
//! manifest/                          manifest.json: structure, paths, consistency, reading, writing
//! margins                            how far each ray is from another answer
//! arrays, exr_map, rays -> write     the files of a pack
//! provenance -> check                the candidate's note, and the check of a candidate
//! check_report/                      a check as screen, page, JSON and JUnit
//! ```
//!
//! ```
//! use std::path::Path;
//!
//! use raypencil_pack::{check_pack, check_screen};
//! use raypencil_scene::Silent;
//!
//! // A pack is a perfect candidate: all 96 x 72 + 2 x 128 x 4 = 7936 rays agree exactly.
//! let pack = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../data/packs/pyramids");
//! let checked = check_pack(&pack, &pack, None, &Silent)?;
//! assert_eq!(checked.check.compared(), 96 * 72 + 2 * 128 * 4);
//! assert!(check_screen(&checked).contains("✓ 7,936 rays agree with the exact answers: 7,936 exact"));
//! # Ok::<(), raypencil_pack::CheckError>(())
//! ```

mod arrays;
mod bench;
mod blind;
mod canonical_nan;
mod check;
mod check_report;
mod clauses;
mod exr_map;
mod manifest;
mod margins;
mod provenance;
mod rays;
mod split_mix;
mod units;
mod write;

pub use bench::{BENCH_BEAMS, with_bench};
pub use blind::{blind_scene, blind_subject};
pub use check::{CheckError, Checked, check_pack, check_pack_by};
pub use check_report::{
    check_json, check_page, check_screen, check_suite, items_not_given, not_given, rays_not_given,
    write_check,
};
pub use clauses::{ClauseRays, MIN_RAYS_PER_CLAUSE, clause_rays};
pub use manifest::{
    ChannelType, FileRole, FileType, MANIFEST_FORMAT, Manifest, ManifestChannel, ManifestClause,
    ManifestFile, ManifestScene, ManifestSensor, PackKind,
};
pub use provenance::{Arithmetic, MonteCarloTotal, Provenance, ProvenanceError, note, precision_of};
pub use write::{PackError, write_pack};

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
