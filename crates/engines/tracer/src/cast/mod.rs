//! Any rays on any triangles, traced in `f64`: obvhs proposes, the watertight test of `triangle` decides.
//!
//! Vertices are `f64` numbers, and a mesh may be a micrometre or a million kilometres wide. So everything is traced in a
//! *scaled* frame: coordinates times a power of two, which is exact, so that the mesh's box is about 1 wide on either
//! side; and directions times a power of two, so that their largest component is from 1/2 to 1. Only the `f32` boxes are
//! also moved to the middle of the mesh.
//!
//! ```text
//! frame     the scaled frame, its boxes, and how wide these must be
//! in_box    t of a ray that runs nearly in a face's plane
//! quad      four faces at a time, asked in `f32`
//! tracer    [`TracerCast`]: first, any and all hits
//! packet    many rays from one point, together
//! traced    a hit with its values
//! tree      boxes, quads and faces of a mesh
//! turns     many rays that share nothing
//! ```

mod frame;
mod in_box;
mod packet;
mod quad;
mod traced;
mod tracer;
mod tree;
mod turns;

pub use traced::{TracedHit, TracedMeeting};
pub use tracer::{CastTraverser, TracerCast};
