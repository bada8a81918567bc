//! Terrain in files: glTF, GLB and GeoTIFF, in and out.

pub mod dem;
pub mod gltf;

pub use dem::write::write_geotiff;
pub use dem::{Dem, Registration, dem_from_bytes, read_dem};
pub use gltf::write::{glb_bytes, write_glb, write_terrain_glb};
pub use gltf::{DEFAULT_REFLECTIVITY, Vertices, load_mesh, mesh_from_bytes, mesh_of_offsets};
