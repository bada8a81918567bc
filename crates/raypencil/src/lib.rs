//! raypencil simulates a Mars rover's structured-light vision system twice, by two unlike algorithms, and proves what
//! the right answer is wherever they differ. This crate is the one door to all of it.

pub use raypencil_scene::*;

pub use raypencil_harness::validate;
pub use raypencil_judge::check;
pub use raypencil_referee::{ExactRenderer, Referee};
pub use raypencil_scanline::Scanline;
pub use raypencil_scene_io::{LoadedScene, Overrides, load};
pub use raypencil_tracer::Tracer;

pub use {
    raypencil_campaign as campaign, raypencil_diff as diff, raypencil_drive as drive,
    raypencil_harness as harness, raypencil_judge as judge, raypencil_minimise as minimise,
    raypencil_pack as pack, raypencil_referee as referee, raypencil_report as report,
    raypencil_rover as rover, raypencil_scanline as scanline, raypencil_sensor as sensor,
    raypencil_terrain as terrain, raypencil_tracer as tracer,
};

/// Every file format, in and out: numbers (NPY, PFM, EXR), meshes (glTF, GeoTIFF), scenes (TOML).
pub mod io {
    pub use raypencil_files::*;
    pub use raypencil_mesh_io::*;
    pub use raypencil_scene_io::*;
}

/// The README's example, compiled and run with the documentation tests.
#[cfg(doctest)]
#[doc = include_str!("../../../README.md")]
struct Readme;
