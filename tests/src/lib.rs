//! Code that the tests of the whole workspace share: scenes, outputs, wrong renderers and malformed files.
//!
//! The tests themselves are in `tests/tests`, one file for each question. The modules follow each other from the floor
//! to the top:
//!
//! * [`draws`]: seeded random numbers. [`quadrature`]: Gauss-Legendre integration.
//! * `meshes`: the same ground in other meshes ([`remeshed`], [`unindexed`]). [`glb`]: GLB files from any JSON.
//! * `outputs`: both renderers ([`renderers`], [`render_both`]), the hits of a map ([`hit`], [`cells_hit`]), all bits
//!   of an output ([`bits`], [`light_bits`]). `agreement`: a comparison without defects ([`agreement()`]).
//! * [`light`]: every renderer that computes light, and short access to its results.
//! * [`naive`]: a third renderer, into which one [`Fault`](naive::Fault) at a time is injected (a crate of its own).
//! * [`single`]: an honest program in single precision.
//! * [`injected_faults`]: small scenes that reveal such faults, faults of files, and the search that writes
//!   `docs/evidence/injected-faults.md`.
//! * [`planted`]: faults planted in the sources of products, listed in `docs/evidence/shared-faults.md`.
//! * [`malformed`]: malformed files for every reader, listed in `docs/evidence/malformed-inputs.md`.
//! * [`stands_on`]: what the tables and figures of the documents stand on, and the stamps that say so.
//! * [`reproducers`]: what a failing property leaves behind. [`fixtures`]: small validations for reports.
//!   [`schema`]: JSON documents against their schemas.
//!
//! ```
//! use raypencil::{Beam, rig};
//! use raypencil_tests::{at_origin, for_each_map, hit, mesh, scene};
//!
//! // A triangle at z = 2 m around the axis, its front to the sensors. The middle of 3 x 3 rays runs along the axis.
//! let triangle = mesh(vec![[-8.0, -8.0, 2.0], [0.0, 8.0, 2.0], [8.0, -8.0, 2.0]], vec![[0, 1, 2]]);
//! let (camera, beam) = (rig::camera(3, 3, 1e-3, 8e-3), rig::beam(3, 3, [1e-3, 1e-3], 0.1));
//! for_each_map(&scene(triangle, at_origin(camera), vec![at_origin(beam)]), |what, map| {
//!     assert_eq!(hit(map, 1, 1).map(|hit| hit.range), Some(2.0), "{what}");
//! });
//! # let _: Beam = beam;
//! ```

mod agreement;
pub mod draws;
pub mod fixtures;
pub mod glb;
pub mod injected_faults;
pub mod light;
pub mod malformed;
mod meshes;
pub mod naive_loader;
pub use raypencil::naive;
mod outputs;
pub mod planted;
pub mod quadrature;
pub mod reproducers;
pub mod schema;
pub mod single;
pub mod stands_on;

pub use agreement::agreement;
pub use meshes::{remeshed, unindexed};
pub use outputs::{
    bits, cells_hit, cells_missed, first_difference, for_each_map, for_each_map_of, hit, light_bits,
    render_both, renderers,
};
pub use raypencil::campaign::cases::{at_origin, lattice, mesh, random, scene};
pub use raypencil::rig;
