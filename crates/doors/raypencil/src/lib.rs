//! raypencil simulates a Mars rover's structured-light vision system twice, by two unlike algorithms, and proves in exact
//! arithmetic which answer is right wherever the two differ. This crate is the one door to all of it.
//!
//! The words of the simulation ([`Scene`], [`Renderer`], [`RenderOutput`], [`Place`] ...) stand at the top, with the
//! functions that a user calls first. Everything else is in modules:
//!
//! ```text
//! load, validate, check              a scene from a file; two renderers compared; a recording against the truth
//! Scanline, Tracer, ExactRenderer    the renderers; Referee, the exact judge
//! io                                 files: scenes, meshes, NPY, PFM, EXR
//! survey                             warnings about a scene; where everything stands
//! harness  judge  report             a validation: run, judged, reported; candidates; probe
//! cast                               any rays on any mesh, answered exactly
//! pack  diff  minimise  campaign     reference packs; any two recordings; the simplest scene; random terrains
//! sweep                              one scene with many settings, one table
//! diagnosis                          the mistake that explains why a recording is wrong
//! drive  rover  sensor  terrain      the rover: drives, maps, its image sensor, its ground
//! ```
//!
//! ```
//! use raypencil::harness::contender;
//! use raypencil::io::{Subject, load_text};
//! use raypencil::judge::JudgeShare;
//! use raypencil::{Silent, validate};
//!
//! // The pyramids through a small camera and two small beams.
//! let loaded = load_text(
//!     "version = 1\n[terrain]\nbuiltin = \"pyramids\"\n[camera]\nwidth_px = 32\nheight_px = 24\npixel_pitch_um = 300\n\
//!      [[beam]]\ncolumns = 64\nrows = 4\n[[beam]]\ncolumns = 64\nrows = 4\n",
//!     "small",
//! )?;
//! let subject = loaded.into_subject("small.toml".into());
//! let renderers = ["scanline", "tracer"].map(|name| contender(name).expect("a renderer's name"));
//! let validation = validate(subject, &renderers, JudgeShare::Sample, &Silent);
//! // Every pixel and every pencil was compared, and nothing is wrong.
//! assert_eq!(validation.counts().compared, 32 * 24 + 2 * 64 * 4);
//! assert!(validation.passes());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub use raypencil_scene::*;

pub use raypencil_cast::cast;
pub use raypencil_harness::validate;
pub use raypencil_judge::check;
pub use raypencil_referee::{ExactRenderer, Referee};
pub use raypencil_scanline::Scanline;
pub use raypencil_scene_io::{LoadedScene, Overrides, load};
pub use raypencil_tracer::Tracer;

#[cfg(feature = "campaign")]
pub use raypencil_campaign as campaign;
pub use {
    raypencil_cast as cast, raypencil_diagnosis as diagnosis, raypencil_diff as diff,
    raypencil_drive as drive, raypencil_harness as harness, raypencil_judge as judge,
    raypencil_minimise as minimise, raypencil_naive as naive, raypencil_pack as pack,
    raypencil_referee as referee, raypencil_report as report, raypencil_rover as rover,
    raypencil_scanline as scanline, raypencil_sensor as sensor, raypencil_survey as survey,
    raypencil_sweep as sweep, raypencil_terrain as terrain, raypencil_tracer as tracer,
};

/// Every file format, in and out: numbers (NPY, PFM, EXR), meshes (glTF, GeoTIFF), scenes (TOML).
///
/// ```
/// use raypencil::io::{Overrides, load};
///
/// // The default rig on the built-in pyramids: 1024 x 1024 pixels, two beams of 1024 x 16 pencils.
/// let scene = load("pyramids", &Overrides::default())?.scene;
/// assert_eq!(scene.camera().sensor.width, 1024);
/// assert_eq!(scene.beams().len(), 2);
/// # Ok::<(), raypencil::io::SceneIoError>(())
/// ```
pub mod io {
    pub use raypencil_files::*;
    pub use raypencil_mesh_io::*;
    pub use raypencil_scene_io::*;
}

/// The examples of the project's README, of this crate's and of a guide, compiled and run with the documentation tests.
#[cfg(doctest)]
mod readme {
    #[doc = include_str!("../../../../README.md")]
    struct OfTheProject;
    #[doc = include_str!("../README.md")]
    struct OfTheCrate;
    #[doc = include_str!("../../../../docs/guide/cast.md")]
    struct OfTheGuideToCast;
    #[doc = include_str!("../../../../docs/guide/lidar.md")]
    struct OfTheGuideToLidar;
}
