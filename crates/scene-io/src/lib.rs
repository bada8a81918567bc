//! Every file format of raypencil, in and out. Nothing else below the harness touches files.
//!
//! * [`load`]: a built-in name, a scene TOML or a glTF terrain becomes a [`LoadedScene`]. The keys of a
//!   scene file are described in `docs/guide/scene.md`.
//! * [`write_resolved`]: a scene's own numbers, which [`load`] gives back bit for bit.
//! * [`load_mesh`]: a `.glb` or `.gltf` file becomes a [`raypencil_scene::Mesh`]; [`write_glb`] and [`mesh_of_offsets`]
//!   keep one bit for bit, [`write_terrain_glb`] does so for people, with the ground where it belongs.
//! * [`read_dem`]: the heights of a GeoTIFF, all or a part of them, and the mesh that they make.
//! * [`write_exr_map`], [`read_exr_map`]: the maps of one sensor as OpenEXR; [`ExrMap`] for files of any
//!   channels. Conventions are in `docs/formats/files.md`.
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

pub mod digest;
mod drive;
mod keys;
mod load;
mod parse;
mod plan;
mod resolve;
mod resolved;
mod scene_error;
mod subject;
mod toml_problem;

pub use digest::scene_sha256;
pub use drive::camera::{MOST_FINE_CELLS, camera_chain, sunlight};
pub use drive::camera_settings::{BlurSettings, ElectronicsSettings, OpticsSettings};
pub use drive::plan::{plan, threshold};
pub use drive::settings::{DetectionWord, DriveSettings, PlaceWord, SensorWord, SunSettings};
pub use load::{LoadedScene, MAX_TOML_BYTES, Overrides, SceneSource, load, load_text};
pub use resolved::write::write_resolved;
pub use scene_error::SceneIoError;
pub use subject::{Subject, probe_command, quoted};
pub use toml_problem::TomlProblem;
