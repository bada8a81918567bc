//! Triangles in the frame of their file, with its numbers as they are: glTF, STL, OBJ, PLY, and pairs of NPY files.
//!
//! CHOICE: STL, OBJ and PLY have small parsers of their own. `stl_io` rounds the decimals of a text to single
//! precision, and so does `ply-rs`; an element without properties lets the latter fill the memory from a file of a
//! hundred bytes. `tobj` numbers vertices anew, object by object, and its errors name no line.

mod npy_pair;
mod obj;
mod parts;
mod ply;
mod polygon;
mod polygon_facts;
mod read;
mod stl;
mod text;

pub(crate) use parts::MAX_COORDINATE;
pub(crate) use ply::cloud as ply_cloud;
pub use polygon_facts::{BentPolygons, CrossingPolygons, PolygonFacts, PolygonPlace};
pub(crate) use read::{Format, format, parse, read_bytes};
pub use read::{TriangleFile, load_triangles, read_triangles, triangles_from_bytes};
