//! A scene before its rays are trusted: warnings about what looks wrong in it, and where everything stands.
//!
//! Internal to raypencil: any version may change its items. The crate `raypencil` is the door.
//!
//! Two renderers agree on a scene in which nothing is hit, and the result tells nothing. This crate looks at the scene
//! itself: does each sensor see the terrain, from its front; does the terrain have the right axes and unit; does the
//! vehicle stand on it. A warning changes no answer of a renderer.
//!
//! ```text
//! warning              Warning and its code, which stays the same from version to version
//! facing               fronts and backs that the rays of a sensor meet, by the scanline renderer
//! warnings/hits        rules: no hits, few hits, backs first
//! warnings/terrain     rules: terrain on its side, terrain too large
//! warnings/vehicle     rules: vehicle above or below the ground
//! warnings/image       rules: principal point outside the image or far from its middle
//! warnings/file        rules: polygons of the terrain's file that cross themselves or are not planar; heights that stand out
//! warnings/mod         all rules on one scene
//! whereabouts          poses, fields of view and bounds in the global frame
//! plan                 the same as a drawing from above
//! ```
//!
//! Each rule is a function with its threshold named and its reason beside it. The thresholds are tuned: a scene beyond
//! one may be meant so.
//!
//! ```
//! use std::sync::Arc;
//!
//! use glam::DVec3;
//! use raypencil_scene::{Atmosphere, FluxModel, Scene, rig};
//! use raypencil_survey::{WarningCode, warnings};
//!
//! let mesh = Arc::new(raypencil_terrain::builtin("pyramids", 0.25).expect("a built-in name").into_mesh()?);
//! let air = Atmosphere { attenuation: 0.0 };
//! let scene_at = |position| {
//!     let (camera, beams) = rig::default_rig(32, position, 0.0);
//!     Scene::new(Arc::clone(&mesh), camera, beams, air, FluxModel::Radiometric)
//! };
//! // On the ground all is well. 500 m to the side there is no ground: the camera and both beams see nothing.
//! assert!(warnings(&scene_at(DVec3::ZERO)?, None, None).is_empty());
//! let found = warnings(&scene_at(DVec3::new(500.0, 0.0, 0.0))?, None, None);
//! assert_eq!(found.len(), 3);
//! assert!(found.iter().all(|warning| warning.code == WarningCode::NoHits));
//! # Ok::<(), raypencil_scene::SceneError>(())
//! ```

mod facing;
mod plan;
mod warning;
mod warnings;
mod whereabouts;

pub use facing::{Facing, facings};
pub use plan::plan;
pub use warning::{Warning, WarningCode};
pub use warnings::file::{polygons_cross, polygons_not_planar, posts_stand_out, posts_too_dense};
pub use warnings::hits::{SensorHits, few_hits, mostly_backs, no_hits};
pub use warnings::image::{principal_point_off_centre, principal_point_outside};
pub use warnings::terrain::{TerrainShape, lies_on_its_side, terrain_on_its_side, terrain_too_large};
pub use warnings::vehicle::{vehicle_above_ground, vehicle_below_ground};
pub use warnings::{Surveyor, warnings};
pub use whereabouts::{Attitude, RoundedVertices, SensorPlace, Whereabouts};

/// The README's example, compiled.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
