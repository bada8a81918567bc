//! Every file format of raypencil, in and out. Nothing else below the harness touches files.
//!
//! * [`load`]: a built-in name, a scene TOML or a glTF terrain becomes a [`LoadedScene`]. The keys of a
//!   scene file are described in `docs/scene.md`.
//! * [`load_mesh`]: a `.glb` or `.gltf` file becomes a [`raypencil_scene::Mesh`].
//! * [`write_exr_map`], [`read_exr_map`]: the maps of one sensor as OpenEXR; [`ExrMap`] for files of any
//!   channels. Conventions are in `docs/files.md`.
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

mod atomic;
mod bytes;
mod digest;
mod error;
mod exr_map;
mod gltf_mesh;
mod keys;
mod load;
mod parse;
mod plan;
mod resolve;

pub use atomic::write_atomically;
pub use digest::scene_sha256;
pub use error::{Problem, SceneIoError, TomlProblem};
pub use exr_map::{Attributes, ExrMap, Limits, Raster, read_exr, read_exr_map, write_exr, write_exr_map};
pub use gltf_mesh::{DEFAULT_REFLECTIVITY, load_mesh, mesh_from_bytes};
pub use load::{LoadedScene, Overrides, SceneSource, load};
