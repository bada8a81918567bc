//! Scenes from files: a built-in name, a scene TOML, a glTF terrain or an elevation model becomes a
//! [`raypencil_scene::Scene`], and a scene becomes a file again.
//!
//! Internal to raypencil: any version may change its items. The crate `raypencil` is the door.
//!
//! Source: the paper describes its scenes by pictures; the keys are this project's own, described in
//! `docs/guide/scene.md` and `docs/guide/drive.md`. The files follow each other from floor to top:
//!
//! 1. `scene_error`, `toml_problem`: errors, which name the file, the line, the value found and the values expected;
//! 2. `parse/key`, `parse/source`, `parse/shared`: values with their places, and the readers that check them;
//! 3. `camera_info`: calibrations of ROS, which `parse/camera` takes a camera from; `drive`: keys of `[drive]`, written straight into a [`DriveSetup`];
//! 4. `plan`: a scene as checked numbers; `parse/kind`, `parse/rig`, `parse/camera`, `parse/terrain` (with `dem`, `generate`) and
//!    `parse/scene` fill it in;
//! 5. `resolve`: a plan and a mesh become a scene; `resolved`: files that hold the scene's own numbers;
//! 6. `digest`: SHA-256 of a scene's numbers;
//! 7. `settings`: keys given outside of the file; `file_warnings`, `scene_source`, `overrides`, `ground`, `load`: from a name or path to a [`LoadedScene`];
//! 8. `inputs`: the files whose bytes decide a scene.
//!
//! `parse/rays` reads tables `[[rays]]` into named ray sets, with poses from files (`trajectory`), `ray_sets` a file that has nothing else, `ray_scene` a scene of
//! them without a camera.
//!
//! `subject` stands alone: a scene under test, and the commands that show it.
//!
//! ```
//! use raypencil_scene_io::load_text;
//!
//! // Beam 0 stands at x = 0.3 m, 2 m up, and looks down by 45 degrees: it meets level ground at x = 2.3 m.
//! let text = "version = 1
//! [vehicle]
//! position_m = [0, 0, 0]
//! [[beam]]
//! position_m = [0.3, 0, 2]
//! pitch_down_deg = 45
//! ";
//! let beam = load_text(text, "steep")?.scene.beams()[0];
//! let (position, axis) = (beam.scene_from_sensor.position, beam.scene_from_sensor.rotate(glam::DVec3::Z));
//! let meets = position + axis * (position.z / -axis.z);
//! assert!((meets - glam::DVec3::new(2.3, 0.0, 0.0)).length() < 1e-12);
//! # Ok::<(), raypencil_scene_io::SceneIoError>(())
//! ```

mod camera_info;
mod digest;
mod drive;
mod file_warnings;
mod ground;
mod grounds;
mod inputs;
mod load;
mod original_place;
mod overrides;
mod parse;
mod plan;
mod ray_scene;
mod ray_sets;
mod resolve;
mod resolved;
mod scene_error;
mod scene_source;
mod settings;
mod subject;
mod toml_problem;
mod trajectory;

/// A scene file with every key and what it means: the default rig on the built-in pyramids.
///
/// ```
/// use raypencil_scene_io::{Overrides, SCENE_TEMPLATE, load, load_text};
///
/// let [written, builtin] = [load_text(SCENE_TEMPLATE, "template")?, load("pyramids", &Overrides::default())?];
/// assert_eq!(written.scene, builtin.scene);
/// # Ok::<(), raypencil_scene_io::SceneIoError>(())
/// ```
pub const SCENE_TEMPLATE: &str = include_str!("template.toml");

pub use camera_info::{CameraInfo, camera_info_from_text};
pub use digest::scene_sha256;
pub use drive::setup::{DriveSetup, WaypointFrame, default_threshold};
pub use file_warnings::file_warnings;
pub use grounds::Grounds;
pub use inputs::{InputFile, SceneInputs};
pub use load::{LoadedScene, MAX_TOML_BYTES, check_settings, load, load_sharing, load_text, load_text_with};
pub use overrides::Overrides;
pub use ray_scene::{RayScene, load_ray_scene};
pub use ray_sets::{LoadedRaySets, LoadedSweeps, ray_sets_from_text, read_ray_sets, read_sweeps};
pub use raypencil_files::quoted;
pub use raypencil_rosbag::PoseChoice;
pub use resolved::write::write_resolved;
pub use scene_error::SceneIoError;
pub use scene_source::{MESH_ENDINGS, SceneSource};
pub use settings::{Setting, refuse_contradictions};
pub use subject::{Subject, probe_command};
pub use toml_problem::TomlProblem;
pub use trajectory::{MAX_TRAJECTORY_BYTES, poses_from_bag, poses_from_text};

/// The README's example, compiled.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

// The tests by public items are in the program of the unit tests: one executable for the crate.
#[cfg(test)]
extern crate self as raypencil_scene_io;
#[cfg(test)]
#[path = "../tests/it/mod.rs"]
mod it;
