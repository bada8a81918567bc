//! The referee: the exact answer to any ray of the contract, and how far that answer is from changing.
//!
//! Internal to raypencil: any version may change its items. The crate `raypencil` is the door.
//!
//! Two f64 programs that agree prove only that they share their mistakes. All that the contract says of a ray is a
//! sign of a polynomial in stored f64 numbers, so it can be known without error: by an interval if that is certain,
//! else by exact dyadic rationals. `docs/theory/referee.md` has the proofs and the bounds.
//!
//! ```
//! use std::sync::Arc;
//!
//! use glam::DVec3;
//! use raypencil_referee::Referee;
//! use raypencil_scene::{
//!     Atmosphere, Camera, FluxModel, Lens, Material, Mesh, Mounted, Pose, Scene, SensorId,
//! };
//!
//! // A wall at z = 2 m that ends at x = 1/8 m, and a camera at the origin that looks along z.
//! let wall = vec![[0.125, -40.0, 2.0], [-90.0, 0.0, 2.0], [0.125, 40.0, 2.0]];
//! let plaster = Material { name: "plaster".into(), reflectivity: 0.5 };
//! let mesh = Mesh::new(DVec3::ZERO, wall, vec![[0, 1, 2]], vec![0], vec![plaster])?;
//! let camera = Camera {
//!     width: 9,
//!     height: 9,
//!     pixel_pitch: [0.0625; 2],
//!     focal_length: 0.5,
//!     principal_point: [4.5; 2],
//!     aperture: 0.01,
//!     lens: Lens::CLEAR,
//!     max_range: 20.0,
//! };
//! let camera = Mounted { scene_from_sensor: Pose::IDENTITY, sensor: camera };
//! let air = Atmosphere { attenuation: 0.0 };
//! let scene = Scene::new(Arc::new(mesh), camera, vec![], air, FluxModel::Radiometric)?;
//!
//! let referee = Referee::new(&scene);
//! // Pixel (4, 4) looks exactly along z. At 2 m the next pixel looks 2 (1/16) / (1/2) = 1/4 m to the right.
//! assert!(referee.verdict(SensorId::Camera, 4, 4).unwrap().is_hit());
//! assert!(!referee.verdict(SensorId::Camera, 5, 4).unwrap().is_hit());
//! # Ok::<(), raypencil_scene::SceneError>(())
//! ```
//!
//! The folders, from the numbers up to the answers. None uses one that stands below it in this list:
//!
//! ```text
//! lanes       what the processor has beyond safe code: fused operations, hints to memory
//! numbers     intervals, exact dyadic rationals, pairs of f64 with a proven error; their correct rounding
//! trees       boxes of a hierarchy: the faces that a ray may meet
//! rays        the contract's rays, multiplied by their denominators, and rays displaced from them
//! hits        the contract's conditions on a face, the verdict on a ray, exact values, and rulings on answers
//! margins     how far a verdict or a surface is from changing, with a witness
//! visibility  the line of sight from the camera to a point; its verdict, margins and rulings
//! light       a pencil's share of the power, its flux, and the values of its return
//! paper       whether an approximation of the paper explains a wrong answer
//! whole       the answers of a whole sensor, and as a renderer
//! cast        any rays on any triangles: a kernel of its own, on the numbers, boxes and bounds above
//! ```
//!
//! The crate depends on `raypencil-scene` alone, and no renderer may call it.

mod cast;
mod hits;
mod lanes;
mod light;
mod margins;
mod numbers;
mod paper;
mod rays;
mod trees;
mod visibility;
mod whole;

#[cfg(test)]
#[path = "../tests/common/small_camera.rs"]
mod small_camera;
#[cfg(test)]
#[path = "../tests/common/soup.rs"]
mod soup;
#[cfg(test)]
#[path = "../tests/common/splitmix.rs"]
mod splitmix;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

pub use cast::{CastHit, CastMeeting, CastTree, DecidedBy, ExactCast, HitGroup, SidedFace};
pub use hits::aspect::aspect;
pub use hits::rounded_face::{RANGE_ROUNDINGS, edge_slip};
pub use hits::ruling::{Ruling, Tolerance};
pub use hits::values::RoundedHit;
pub use hits::verdict::{Referee, RefereeTree, Verdict};
pub use light::beam_returns::{BeamReturns, Contribution, RoundedReturn};
pub use light::flux::Flux;
pub use margins::margin::{Margin, Margins};
pub use numbers::arithmetic::Undecided;
pub use numbers::rounding::{Format, Rounded};
pub use paper::approximations::{Approximations, Explained, Reason};
pub use paper::visibility::{ExplainedVisibility, VisibilityApproximations, VisibilityReason};
pub use rays::displacement::Displacement;
pub use visibility::margin::VisibilityMargins;
pub use visibility::ruling::VisibilityRuling;
pub use visibility::seen::Visibility;
pub use whole::certified::{CertifiedMap, CertifiedReturns, PixelSum};
pub use whole::render::ExactRenderer;

// The tests by public items are in the program of the unit tests: one executable for the crate.
#[cfg(test)]
extern crate self as raypencil_referee;
#[cfg(test)]
#[path = "../tests/it/mod.rs"]
mod it;
