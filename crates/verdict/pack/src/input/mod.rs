//! Input packs: a glTF file with all that a loader can get wrong, and the triangles that it must become.
//!
//! Every renderer of a pack reads a terrain in which nothing is left to do: one list of vertices, no transforms. So an
//! input pack tests the step before, in which a file becomes triangles. Its numbers are dyadic and its rotations exact: a
//! loader in single or double precision gets every coordinate exactly, in whatever order it multiplies.
//!
//! ```text
//! clause                       what a loader must do, one clause for each part of the file
//! gltf_document -> ground      the file; the triangles of each part, by a closed form of its own
//! write, check -> report       the files of an input pack; a loader's triangles against them, in the form of every check
//! ```

mod check;
mod clause;
mod gltf_document;
mod ground;
mod report;
mod write;

pub use check::{InputChecked, WrongFace, check_input, is_input_pack};
pub use clause::LoadingClause;
pub use ground::{InputFace, input_faces, input_glb};
pub use write::write_input;
