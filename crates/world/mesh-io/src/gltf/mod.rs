//! Meshes from glTF 2.0 and GLB, and to GLB. Every reference, length and number is checked before it is used.
//!
//! The `gltf` crate gives the JSON its types. Its own validation is not used: it stops at the first unknown texture,
//! and does not look at the numbers in the buffers.

mod accessors;
mod assemble;
mod buffers;
mod container;
mod elements;
mod exact;
mod instances;
mod json;
mod limits;
mod materials;
mod nodes;
mod placement;
mod primitives;
mod read;
mod stated_origin;
mod transform;
mod write;

pub(crate) use assemble::WITHOUT_MATERIAL;
pub(crate) use exact::exact_triangles;
pub use limits::MAX_BUFFER_FILES_BYTES;
pub(crate) use limits::MAX_FACES_OR_VERTICES;
pub use read::{DEFAULT_REFLECTIVITY, Vertices, load_mesh, mesh_from_bytes, read_mesh};
pub(crate) use read::{buffer_files, terrain_from_bytes};
pub use write::{glb_bytes, write_glb, write_terrain_glb};
