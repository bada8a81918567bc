//! Renders one scene with several renderers, compares every ray, and reports the result.
//!
//! Internal to raypencil: any version may change its items. The crate `raypencil` is the door.
//!
//! A *validation* renders a scene with two or more renderers, compares each pair of them ray by ray, and has the
//! referee rule on every ray whose answers differ (and on a sample of the others). *Candidates*, recordings that other
//! people's renderers made of the same scene, can be evaluated beside them. The paper simulates its vision system once;
//! this crate is how two simulations check each other.
//!
//! ```
//! use std::sync::Arc;
//!
//! use glam::DVec3;
//! use raypencil_harness::{contender, one_screen, validate};
//! use raypencil_judge::JudgeShare;
//! use raypencil_scene::{Atmosphere, FluxModel, Scene, Silent, rig};
//! use raypencil_scene_io::Subject;
//!
//! // The pyramids under the default rig, 32 times coarser: 32 x 32 pixels and two beams of 32 x 2 pencils.
//! let mesh = raypencil_terrain::builtin("pyramids", 0.25).expect("a built-in name").into_mesh()?;
//! let (camera, beams) = rig::default_rig(32, DVec3::ZERO, 0.0);
//! let air = Atmosphere { attenuation: 0.0 };
//! let scene = Scene::new(Arc::new(mesh), camera, beams, air, FluxModel::Radiometric)?;
//! let subject = Subject {
//!     scene,
//!     name: "small".into(),
//!     arguments: "small.toml".into(),
//!     sha256: "0".repeat(64),
//!     vehicle: None,
//!     file_facts: Default::default(),
//! };
//!
//! let contenders = ["scanline", "tracer"].map(|name| contender(name).expect("a renderer's name"));
//! let validation = validate(subject, &contenders, JudgeShare::Sample, &Silent);
//! // 32 x 32 + 2 (32 x 2) = 1152 rays, each compared once: there is one pair.
//! assert_eq!(validation.counts().compared, 1152);
//! assert!(validation.passes());
//! assert!(one_screen(&validation, None).ends_with("\n✓ All 1,152 rays agree.\n"));
//! # Ok::<(), raypencil_scene::SceneError>(())
//! ```
//!
//! The files, from the floor to the top:
//!
//! ```text
//! renderers            raypencil's own renderers by name, with their switches
//! rendered             what one renderer computed
//! interestingness      do two renderers still differ by a class? (for test-case reduction)
//! reproducer           a reduced scene as files, with the commands that show the difference
//! probe                one ray, as every renderer and the referee answer it
//! estimate             a Monte Carlo image: mean and standard error
//! candidate            what another program recorded of a scene
//! sides                two recordings that are to be compared, as what is declared says
//! monte_carlo          a candidate's Monte Carlo images against pencils drawn at random (z-test)
//! radiance             a candidate's radiance along single rays against the closed form
//! scoreboard           every renderer and candidate, checked against the exact answers
//! hunt                 one candidate of one scene, checked without rendering
//! misses               a ray that a candidate answers wrongly, as a pack of that ray
//! ray_sets             rays of no sensor: the tracer against the exact answers
//! ray_set_packs        the same in packs of scenes
//! any_pack             a candidate against a pack of any form
//! validation           all results of one scene
//! run                  `validate`: from a scene to its validation
//! output/table         the tables of quantities, sensors, causes and times
//! output/verdict       the verdict in words
//! output/candidates    the scoreboard as tables
//! output/panel         the scoreboard for programs
//! output/plots, light  range maps, differences and flux as pictures
//! output/pictures      all of them, section by section
//! output/explorer      the part of the page that answers when asked
//! output/screen        the lines of a screen, which has 40 of them on a terminal
//! output/summary       the keys of summary.json
//! output/junit         the test cases
//! output/document      all of these as the document that every report prints
//! output/formats       maps as NPY, NPZ, Zarr and single EXRs
//! output/folder        the folder with the maps and every report
//! ```

mod any_pack;
mod candidate;
mod estimate;
mod hunt;
mod interestingness;
mod misses;
mod monte_carlo;
mod output;
mod probe;
mod radiance;
mod ray_set_packs;
mod ray_sets;
mod rendered;
mod renderers;
mod reproducer;
mod run;
mod scene_view;
mod scoreboard;
mod sides;
mod validation;

pub use any_pack::{CheckedPack, check_any_pack, pack_form};
pub use candidate::{Candidate, CandidateError, RadianceMap, StatedRaySet};
pub use estimate::{Estimate, MonteCarloImage};
pub use hunt::{JudgedCandidate, judge_candidate};
pub use interestingness::{first_interesting_ray, is_interesting_in_class};
pub use monte_carlo::{ImageComparison, Z_TEST_LIMITS, ZTestLimits, compare_images, expected_images};
pub use output::document::{one_screen, whole_screen};
pub use output::folder::{HarnessError, Written, write_maps, write_validation};
pub use output::formats::{MapFormat, arrays as map_arrays, write_maps_as};
pub use probe::{NoSuchRay, Probe, ProbedAnswer, ProbedCandidate, ProbedReturn, probe};
pub use radiance::{RadianceComparison, compare_radiance};
pub use ray_set_packs::{CheckedRaySet, PackedRaySet, write_pack_with_ray_sets};
pub use ray_sets::{RaySetResult, write_ray_sets};
pub use rendered::Rendered;
pub use renderers::{Contender, RENDERER_NAMES, attribute, contender, typed_contenders};
pub use reproducer::{Reproducer, write_reproducer};
pub use run::{Validator, validate};
pub use scene_view::{scene_json, scene_picture, scene_words};
pub use scoreboard::{CandidateReport, RendererReport, Scoreboard};
pub use sides::{Side, read_sides};
pub use validation::{Counts, Pair, Validation};

/// The README's example, compiled and run with the documentation tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
