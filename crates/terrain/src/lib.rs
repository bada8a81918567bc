//! Grounds for a rover to look at: the paper's two scenes (§9), random ones, those of elevation models, and the
//! height of any.
//! Grounds for a rover to look at: the paper's two scenes (§9), random ones, the height of any, and what may be
//! wrong with one.
//!
//! ```
//! use raypencil_terrain::{RandomGround, builtin, height_at};
//!
//! let pyramids = builtin("pyramids", 0.25).expect("a built-in name").into_mesh()?;
//! assert_eq!(height_at(&pyramids, 0.0, 0.0), Some(0.0));
//!
//! let hills = RandomGround::plain(7, 2_000, 40.0).build().into_mesh()?;
//! assert!(height_at(&hills, 3.0, -1.0).is_some());
//! assert!(height_at(&hills, 300.0, -1.0).is_none());
//! # Ok::<(), raypencil_scene::SceneError>(())
//! ```
//!
//! Every ground is the same bytes on every machine: polynomials, square roots and `libm` only, and random
//! numbers keyed by (seed, purpose, index).
//!
//! Faces are counter-clockwise from outside, n = (b - a) x (c - a): a height field's normals point up, a
//! body's outward.

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
pub use height_grid::{Posts, indices_within};
pub use height_index::HeightIndex;
pub use inspect::{Example, Found, Inspection, Item, OpenEdges, OpenPiece, ZeroAreaKinds, inspect};
pub use mars::{Crater, Craters, Crevasses, MarsGround, PRESET_NAMES, Rocks, Roughness};
pub use random_ground::RandomGround;
pub use repair::{Repairs, repair};
pub use simplify::simplify;
