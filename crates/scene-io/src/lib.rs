//! Every file format of raypencil, in and out. Nothing else below the harness touches files.
//!
//! * [`load`]: a built-in name, a scene TOML or a glTF terrain becomes a [`LoadedScene`]. The keys of a
//!   scene file are described in `docs/scene.md`.
//! * [`write_resolved`]: a scene's own numbers, which [`load`] gives back bit for bit.
//! * [`load_mesh`]: a `.glb` or `.gltf` file becomes a [`raypencil_scene::Mesh`]; [`write_glb`] and [`mesh_of_offsets`]
//!   keep one bit for bit, [`write_terrain_glb`] does so for people, with the ground where it belongs.
//! * [`read_dem`]: the heights of a GeoTIFF, all or a part of them, and the mesh that they make.
//! * [`write_exr_map`], [`read_exr_map`]: the maps of one sensor as OpenEXR; [`ExrMap`] for files of any
//!   channels. Conventions are in `docs/files.md`.
//! * [`read_npy`], [`write_npy`], [`read_pfm`], [`write_pfm`]: arrays of numbers, as NumPy and image programs
//!   have them.
//! * [`read_channels`]: a recording of any program, in any of these formats, as [`Channels`].
//! * [`write_geotiff`], [`write_occupancy`], [`write_ply`], [`vectors_geojson`], [`vectors_csv`], [`camera_info`]: what a
//!   drive leaves behind, as map servers, geographers and robots have it.
//! * [`Manifest`]: what belongs to a pack, each file by its digest.
//! * [`write_atomically`]: a file is either the old one or the whole new one, never a part.
//!
//! Every error names the file, the place in it, what was found there and what was expected.
//!
//! ```no_run
//! use raypencil_scene_io::{Overrides, load};
//! let loaded = load("data/scenes/default.toml", &Overrides::default())?;
//! println!("{}: {} faces", loaded.name, loaded.scene.mesh().faces().len());
//! # Ok::<(), raypencil_scene_io::SceneIoError>(())
//! ```

mod array;
mod atomic;
mod bytes;
mod chain_settings;
mod channels;
mod dem;
mod digest;
mod drive_settings;
mod error;
mod exr_map;
mod gltf_mesh;
mod keys;
mod load;
mod manifest;
mod maps;
mod npy;
mod parse;
mod pfm;
mod plan;
mod provenance;
mod resolve;
mod resolved;
mod toml_problem;

pub use array::{Array, ArrayNumber, Storage, Values};
pub use atomic::write_atomically;
pub use chain_settings::{BlurSettings, ElectronicsSettings, OpticsSettings};
pub use channels::{Channel, Channels, read_channels, read_listed};
pub use dem::{Dem, Registration, dem_from_bytes, read_dem};
pub use digest::scene_sha256;
pub use drive_settings::{DetectionWord, DriveSettings, PlaceWord, SensorWord, SunSettings};
pub use error::{Problem, SceneIoError};
pub use exr_map::{
    Attributes, ExrMap, Limits, Raster, exr_from_bytes, read_exr, read_exr_map, write_exr, write_exr_map,
};
pub use gltf_mesh::{
    DEFAULT_REFLECTIVITY, glb_bytes, load_mesh, mesh_from_bytes, mesh_of_offsets, write_glb,
    write_terrain_glb,
};
pub use load::{LoadedScene, Overrides, SceneSource, load, load_text};
pub use manifest::{
    ChannelType, FileRole, FileType, FluxWord, MANIFEST_FORMAT, Manifest, ManifestChannel, ManifestFile,
    ManifestScene, ManifestSensor, PackKind,
};
pub use maps::{
    MarkedPoint, Occupancy, OccupancyGrid, VectorOnMap, camera_info, occupancy_files, vectors_csv,
    vectors_geojson, write_geotiff, write_occupancy, write_ply,
};
pub use npy::{npy_from_bytes, read_npy, write_npy};
pub use pfm::{pfm_from_bytes, read_pfm, write_pfm};
pub use provenance::{Arithmetic, Provenance, Total};
pub use resolved::write_resolved;
pub use toml_problem::TomlProblem;
