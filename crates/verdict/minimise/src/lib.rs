//! Reduces a scene to the simplest one that is still interesting, for example one on which two renderers still differ.
//!
//! Internal to raypencil: any version may change its items. The crate `raypencil` is the door.
//!
//! Method: test-case reduction, as in ddmin (A. Zeller and R. Hildebrandt 2002) and C-Reduce (J. Regehr et al. 2012).
//! The caller supplies the *interestingness test*; the crate knows no renderer. Simplest means the fewest faces, then
//! the simplest rig, then numbers of the fewest digits.
//!
//! ```text
//! reduction         a scene being reduced
//! reducer           the simplest scene so far, and the test that each simpler one must pass
//! same_ray          smaller sensors that have exactly the same ray
//! nearest_faces     faces sorted by their distance from the ray
//! sensors           fewer beams, smaller sensors
//! faces             fewer faces: near the ray, then ddmin
//! simplest_values   no profile, filter, air, second material
//! short_numbers     poses, sensors and vertices in fewer binary digits
//! minimise          the whole search
//! ```
//!
//! ```
//! use std::sync::Arc;
//!
//! use raypencil_minimise::{MINIMISE_BUDGET, minimise};
//! use raypencil_scene::{Atmosphere, FluxModel, Mounted, Pose, Scene, Silent, rig};
//! use raypencil_terrain::RandomGround;
//!
//! let mesh = Arc::new(RandomGround::plain(7, 500, 20.0).build().into_mesh()?);
//! let camera = Mounted { scene_from_sensor: Pose::IDENTITY, sensor: rig::camera(64, 48, 1e-5, 1e-2) };
//! let air = Atmosphere { attenuation: 0.0 };
//! let scene = Scene::new(mesh, camera, Vec::new(), air, FluxModel::Radiometric)?;
//! // Interesting: at least three faces. ddmin leaves exactly three.
//! let found = minimise(&scene, None, &|scene, _| scene.mesh().faces().len() >= 3, MINIMISE_BUDGET, &Silent)?;
//! assert_eq!((found.faces_before, found.faces_after), (scene.mesh().faces().len(), 3));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod faces;
mod minimise;
mod nearest_faces;
mod reducer;
mod reduction;
mod same_ray;
mod sensors;
mod short_numbers;
mod simplest_values;

pub use minimise::{MINIMISE_BUDGET, Minimised, minimise, reduce_to_ray};
pub use reducer::{InterestingnessTest, NotInteresting};

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

#[cfg(test)]
#[path = "../tests/unit/minimise.rs"]
mod tests;
