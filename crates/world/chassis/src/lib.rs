//! The simulated vehicle itself, on the true triangle mesh: where its wheels touch, how it stands, what it can pass.
//!
//! Internal to raypencil: any version may change its items. The crate `raypencil` is the door.
//!
//! This is the truth to which a rover's own obstacle tests are held. It shares no code with them: it knows no grid of
//! heights and no map, only triangles.
//!
//! ```text
//! chassis        the dimensions of the vehicle
//! rectangle      a turned rectangle in plan, and the part of a triangle over it
//! ground_faces   the faces that carry a vehicle, in a tree of boxes
//! wheel          where a wheel touches
//! belly          how far the ground rises above a plane
//! rest           how the vehicle stands
//! passage        what it can pass
//! ```
//!
//! ```
//! use glam::{DVec2, DVec3};
//! use raypencil_chassis::{Chassis, GroundFaces};
//! use raypencil_scene::{Material, Mesh};
//!
//! // Level ground at 2 m, 8 m wide.
//! let corners = [(-4.0, -4.0), (4.0, -4.0), (4.0, 4.0), (-4.0, 4.0)].map(|(x, y)| DVec3::new(x, y, 2.0));
//! let sand = Material { name: "sand".into(), reflectivity: 0.25 };
//! let mesh = Mesh::from_global(&corners, vec![[0, 1, 2], [0, 2, 3]], vec![0, 0], vec![sand])?;
//! let rest = Chassis::default().rest(&GroundFaces::new(&mesh), DVec2::ZERO, 0.5).unwrap();
//! assert_eq!((rest.position, rest.pitch_down, rest.roll_right), (DVec3::new(0.0, 0.0, 2.0), 0.0, 0.0));
//! # Ok::<(), raypencil_scene::SceneError>(())
//! ```
//!
//! Units are SI: metres and radians. Results are deterministic and have the same bits on every machine.

mod belly;
mod chassis;
mod ground_faces;
mod passage;
mod rectangle;
mod rest;
mod wheel;

pub use chassis::Chassis;
pub use ground_faces::GroundFaces;
pub use passage::{Obstruction, ObstructionKind, Passage, PassageLimits};
pub use rest::Rest;
pub use wheel::WheelContact;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

// The tests by public items are in the program of the unit tests: one executable for the crate.
#[cfg(test)]
extern crate self as raypencil_chassis;
#[cfg(test)]
#[path = "../tests/it/mod.rs"]
mod it;
