//! Grounds for a rover: the paper's two scenes (§9), random grounds, Mars-like grounds, elevation grids.
//!
//! Internal to raypencil: any version may change its items. The crate `raypencil` is the door.
//!
//! The crate also measures the height of any ground, and finds and repairs faults of a mesh. It reads and writes no
//! files. Each generator names its source in its own file.
//!
//! ```text
//! ground                         triangles under construction, and the shapes they are added as
//! builtin, random_ground, mars   generators of grounds; random_stream has their random numbers
//! height_grid -> simplify        posts of an elevation model, and a ground of fewer faces through them
//! height -> height_index         height above a point, for few points and for many
//! inspect -> repair              faults of a mesh, and what can be mended without a guess
//! ```
//!
//! ```
//! use raypencil_terrain::{RandomGround, builtin, height_at};
//!
//! // The rover stands at (0, 0), on the plane z = 0.
//! let pyramids = builtin("pyramids", 0.25).expect("a built-in name").into_mesh()?;
//! assert_eq!(height_at(&pyramids, 0.0, 0.0), Some(0.0));
//!
//! // A square of 40 m about the origin: (3, -1) is on it, (300, -1) is not.
//! let hills = RandomGround::plain(7, 2_000, 40.0).build().into_mesh()?;
//! assert!(height_at(&hills, 3.0, -1.0).is_some());
//! assert!(height_at(&hills, 300.0, -1.0).is_none());
//! # Ok::<(), raypencil_scene::SceneError>(())
//! ```
//!
//! Every ground has the same bytes on every machine: it is made of polynomials, square roots, `libm`, and random
//! numbers keyed by (seed, purpose).
//!
//! Faces are counter-clockwise from outside, n = (b - a) x (c - a): the normals of a height field point up, those of
//! a body outward.

mod builtin;
mod ground;
mod height;
mod height_grid;
mod height_index;
mod inspect;
mod mars;
mod random_ground;
mod random_stream;
mod repair;
mod simplify;

pub use builtin::{BUILTIN_NAMES, builtin};
pub use ground::Ground;
pub use height::height_at;
pub use height_grid::{HeightGrid, indices_within};
pub use height_index::HeightIndex;
pub use inspect::{
    Inspection, MeshElement, Occurrence, Occurrences, OpenEdgePiece, OpenEdges, ZeroAreaKinds, inspect,
};
pub use mars::{Crater, Craters, Crevasses, MarsGround, PRESET_NAMES, Rim, Rocks, Roughness};
pub use random_ground::RandomGround;
pub use repair::{Repairs, repair};
pub use simplify::simplify;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

// The tests by public items are in the program of the unit tests: one executable for the crate.
#[cfg(test)]
extern crate self as raypencil_terrain;
#[cfg(test)]
#[path = "../tests/it/mod.rs"]
mod it;
