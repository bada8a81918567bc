//! Terrain in files: glTF, GLB and GeoTIFF, in and out; STL, OBJ and PLY, in. Triangles of any mesh in glTF, STL, OBJ, PLY and
//! NPY, in.
//!
//! Internal to raypencil: any version may change its items. The crate `raypencil` is the door.
//!
//! A reader checks every reference, length and number of a file before it uses it, and every size against the length of
//! the file before it asks for memory. An error names the file, the place in it, what was found and what was expected.
//!
//! ```text
//! gltf  limits, container, json               the chunks of a GLB, and its JSON as far as it can be trusted
//!       buffers -> elements -> accessors      bytes, elements of views, typed numbers
//!       primitives                            triangles
//!       placement -> transform
//!       instances -> nodes                    transforms in double precision, and where each mesh stands
//!       nodes, materials -> assemble          one list of vertices and faces
//!       stated_origin -> read                 a mesh with its scene origin
//!       exact                                 triangles in the axes of the file, in double precision
//!       write                                 a mesh to GLB
//! dem   tags, codec, target -> blocks         tags of a TIFF, and the samples in its strips or tiles
//!       registration -> geo_keys -> citation  what a pixel is; codes and names of coordinate systems
//!       unit -> epsg, gdal_metadata           units of length, and what the codes of EPSG say
//!       coordinate_system -> georeference     the units of map and heights, and where pixels are on the map
//!       nodata, outliers -> heights           samples that are no heights, and those that can hardly be any
//!       lattice, model, facts                 the posts inside a window, the ground through them, and what the file says
//!       read                                  the steps one after the other
//!       write                                 a grid of heights to GeoTIFF
//! triangles  text, polygon, polygon_facts     lines and decimal numbers of a text; a polygon's triangles; what is told of it
//!       parts                                 vertices and faces
//!       stl, obj, npy_pair                    a format each
//!       ply: header -> numbers                elements and types, and the numbers of either kind
//!       read                                  which format a file has, and triangles as `f64`
//! cloud  columns -> packed                    fields of a point cloud, and their numbers in bytes
//!       lzf -> pcd, read                      PCD, and PLY by the parts above
//! file_frame, file_facts -> terrain           axes and units of a file, what it says of them, and terrain from any mesh
//! ```
//!
//! The formats are described in `docs/formats/files.md`, elevation models in `docs/guide/dem.md` and `docs/formats/terrain.md`. Sources: glTF 2.0
//! (Khronos), TIFF 6.0, BigTIFF, GeoTIFF 1.1 (OGC 19-008r4), STL (3D Systems), OBJ (Wavefront), PLY (Greg Turk), NPY
//! (NumPy Enhancement Proposal 1).
//!
//! ```
//! use glam::DVec3;
//! use raypencil_mesh_io::{load_mesh, write_terrain_glb};
//! use raypencil_scene::{Material, Mesh};
//!
//! // One triangle around (100, 200): its scene origin is a whole metre, its vertices are offsets from there.
//! let corners = [[100.5, 200.0, 1.0], [101.5, 200.0, 1.0], [100.5, 201.0, 1.0]].map(DVec3::from_array);
//! let dust = Material { name: "dust".into(), reflectivity: 0.25 };
//! let mesh = Mesh::from_global(&corners, vec![[0, 1, 2]], vec![0], vec![dust])?;
//!
//! let folder = tempfile::tempdir()?;
//! let path = folder.path().join("terrain.glb");
//! write_terrain_glb(&path, &mesh, &serde_json::json!({}))?;
//! // The file states the origin, so that the same mesh comes back bit for bit.
//! assert_eq!(load_mesh(&path)?, mesh);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod cloud;
pub mod dem;
mod file_facts;
mod file_frame;
pub mod gltf;
mod terrain;
pub mod triangles;

pub use cloud::{
    Cloud, CloudColumn, CloudStorage, PackedField, PackedKind, PackedPoints, claimed_points,
    cloud_from_bytes, is_cloud_file, lzf_compressed, read_cloud,
};
pub use dem::{
    AxisSystem, Dem, DemFacts, DemOptions, HeightUnit, LengthUnit, NoData, Registration, SpikeFacts, Spikes,
    UnitSource, dem_from_bytes, read_dem, read_dem_with, write_geotiff,
};
pub use file_facts::{FileFacts, FileUnits};
pub use file_frame::{FileFrame, SCALE_RANGE, UpAxis};
pub use gltf::{
    DEFAULT_REFLECTIVITY, MAX_BUFFER_FILES_BYTES, Vertices, glb_bytes, load_mesh, mesh_from_bytes, write_glb,
    write_terrain_glb,
};
pub use terrain::{TerrainFile, read_dem_terrain, read_terrain, terrain_files, terrain_from_bytes};
pub use triangles::{
    BentPolygons, CrossingPolygons, PolygonFacts, PolygonPlace, TriangleFile, load_triangles, read_triangles,
    triangles_from_bytes,
};

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

// The tests by public items are in the program of the unit tests: one executable for the crate.
#[cfg(test)]
extern crate self as raypencil_mesh_io;
#[cfg(test)]
#[path = "../tests/it/mod.rs"]
mod it;
