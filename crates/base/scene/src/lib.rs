//! The definitions that all renderers share.
//!
//! Internal to raypencil: any version may change its items. The crate `raypencil` is the door.
//!
//! Two renderers must mean the same by a pose, the terrain mesh, the camera, the laser beams, a ray and a hit; these
//! stand here as *definitions*, with the [`Renderer`] trait and the form of its results. They must not share how they
//! compute: there is no intersection code here and no IO. A test holds the public items of this crate to a list, so
//! that no kernel can hide in it.
//!
//! ```text
//! error         refused fields; check_range, check_count
//! pose mesh camera beam ray      the world as numbers
//! world         Scene: all of it, checked once
//! image output returns           rasters of results
//! hit_quantity  the values of a hit, and their channels in files
//! renderer      the trait
//! sampling      the ray that represents a pencil
//! rig           the default rig
//! approximations  the paper's approximations, by name
//! place progress  names of rays; who is told what is being done
//! triangles ray_set  meshes and rays of no sensor, as their files give them
//! reading       what a range sensor reads along a ray: a hit, too near, a miss
//! pattern named_ray_set  patterns of range sensors (LiDAR) as rays, and ray sets with names
//! head_sweep             sets of spinning heads whose rays are made part by part
//! ```
//!
//! ```
//! use raypencil_scene::{SensorId, rig};
//!
//! // The default rig: one camera 1.5 m up, two beams above it.
//! let (camera, beams) = rig::default_rig(1, glam::DVec3::ZERO, 0.0);
//! assert_eq!((camera.sensor.width, beams.len()), (1024, 2));
//! assert_eq!(SensorId::Beam(1).to_string(), "beam-1");
//! ```
//!
//! Units are SI: metres, radians, watts. Geometry is `f64` throughout; only mesh vertices are stored
//! as `f32` offsets from one `f64` origin.
//!
//! # Frames
//!
//! All right-handed; a pose is named `a_from_b`, so that `p_a = a_from_b * p_b`.
//!
//! * *global*: z up.
//! * *scene*: the global frame moved to [`Mesh::origin`]; every renderer works in it.
//! * *vehicle*: x forward, y left, z up (REP-103).
//! * *sensor* (camera and beam alike): z forward along the normal axis, x right, y down. In a beam, y is
//!   the focal axis of the cylindrical lens and x runs across the fan.

mod approximations;
mod beam;
mod camera;
mod error;
mod head_sweep;
mod hit_quantity;
mod image;
mod mesh;
mod named_ray_set;
mod output;
pub mod pattern;
mod place;
mod pose;
mod progress;
mod ray;
mod ray_set;
mod reading;
mod renderer;
mod returns;
pub mod rig;
mod sampling;
mod triangles;
mod world;

pub use approximations::{Fidelity, Switches, UnknownSwitch};
pub use beam::{Beam, Profile};
pub use camera::{Camera, Filter, Lens};
pub use error::{SceneError, check_count, check_range};
pub use head_sweep::HeadSweep;
pub use hit_quantity::{HitQuantity, HitRaster, HitRasterMut, HitValue};
pub use image::{Image, Maybe, Sample};
pub use mesh::{Material, Mesh, VertexRounding};
pub use named_ray_set::NamedRaySet;
pub use output::{Quantities, RenderOutput, Request, SensorMap, SensorRow, Stage};
pub use place::Place;
pub use pose::Pose;
pub use progress::{Progress, Silent};
pub use ray::{FaceId, Hit, Ray, SensorId};
pub use ray_set::{CastRay, RaySet, Side, Sides};
pub use reading::Reading;
pub use renderer::{Precision, Renderer};
pub use returns::{Pixel, Return, Returns};
pub use sampling::{Sampling, philox};
pub use triangles::Triangles;
pub use world::{Atmosphere, FluxModel, Mounted, Scene};

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

// The tests by public items are in the program of the unit tests: one executable for the crate.
#[cfg(test)]
extern crate self as raypencil_scene;
#[cfg(test)]
#[path = "../tests/it/mod.rs"]
mod it;
