//! The shared vocabulary of raypencil.
//!
//! Everything that two renderers must mean alike stands here, and nothing that they must do apart:
//! poses, the terrain mesh, the camera, the laser beams, rays and hits as *definitions*, frames of
//! results and the [`Renderer`] trait. There is no IO here and no intersection code; a test holds the
//! public items of this crate to a list, so that no kernel can hide in it.
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
mod image;
mod mesh;
mod output;
mod place;
mod pose;
mod progress;
mod ray;
mod renderer;
mod returns;
pub mod rig;
mod sampling;
mod world;

pub use approximations::{Fidelity, Switches, UnknownSwitch};
pub use beam::{Beam, Profile};
pub use camera::{Camera, Filter, Lens};
pub use error::{SceneError, check_count, check_range};
pub use image::{Image, Maybe, Sample};
pub use mesh::{Material, Mesh};
pub use output::{Quantities, RenderOutput, Request, SensorMap, SensorRow, Stage};
pub use place::Place;
pub use pose::Pose;
pub use progress::{Progress, Silent};
pub use ray::{FaceId, Hit, Ray, SensorId};
pub use renderer::{Precision, Renderer};
pub use returns::{Pixel, Return, Returns};
pub use sampling::{Sampling, philox};
pub use world::{Atmosphere, FluxModel, Mounted, Scene};
