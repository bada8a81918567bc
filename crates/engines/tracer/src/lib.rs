//! The second renderer: one ray per pencil or pixel, traced backward through a bounding volume hierarchy.
//!
//! Internal to raypencil: any version may change its items. The crate `raypencil` is the door.
//!
//! `obvhs` proposes the faces that a ray may meet; a watertight triangle test in `f64`, in `triangle`, decides.
//! The tree is `f32`. Its boxes are padded by a bound that is derived in `hierarchy`, so that no hit is lost to
//! them: tests compare the answers with an exhaustive search. Sources: S. Woop, C. Benthin, I. Wald (2013) for the
//! triangle test; the paper's §5 and equation (1) for the light.
//!
//! The files, each using only those above it:
//!
//! ```text
//! distinct       equal boxes of faces
//! grouped_build  the obvhs trees of groups of faces, built in bounded time for any input
//! wide_tree      the same trees as one with eight boxes a node; the walks of many rays at once and of one
//! traced_ray     one ray, for triangles and for boxes
//! triangle       the watertight test: does a ray meet a face, and at which t
//! hierarchy      the terrain's faces in padded boxes
//! lanes          work compiled for wide lanes too
//! tile           64 rays from one point, tested together
//! rays           the contract's rays, formed in the scene frame
//! closest_hit    the hit of a ray: smallest t, lowest face index on ties
//! occlusion      does any face stand between a hit point and the camera
//! camera         a point in the camera frame and on the image
//! shares         the power of each pencil
//! flux           the flux that arrives in the pixel
//! returns        all pencils of a beam: occlusion, camera, shares and flux
//! renderer       [`Tracer`]: maps of all sensors, then returns
//! cast           [`TracerCast`]: any rays on any triangles
//! ```
//!
//! # Example
//!
//! A camera of three pixels looks straight down from 10 m at a horizontal triangle. (The README of this crate has
//! the whole scene.)
//!
//! ```
//! # mod doc { include!(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/doc/scene.rs")); }
//! # use doc::scene_above;
//! use raypencil_scene::{Renderer, Request};
//! use raypencil_tracer::Tracer;
//!
//! let scene = scene_above([[-40.0, -40.0, 0.0], [40.0, -40.0, 0.0], [0.0, 40.0, 0.0]]);
//! let frame = Tracer::new().render(&scene, &Request::MAPS);
//!
//! // The pixels look along x/z = -3/4, 0 and 3/4. The depth is 10 m; the range is measured along the ray:
//! // 10 m sqrt(1 + 9/16) = 12.5 m.
//! let maps = frame.camera.expect("asked for");
//! let (depth, range) = (maps.depth.expect("asked for"), maps.range.expect("asked for"));
//! assert_eq!([0, 1, 2].map(|i| depth.at(i, 0).get()), [Some(10.0); 3]);
//! assert_eq!([0, 1, 2].map(|i| range.at(i, 0).get()), [Some(12.5), Some(10.0), Some(12.5)]);
//! ```

mod camera;
mod cast;
mod closest_hit;
mod distinct;
mod flux;
mod grouped_build;
mod hierarchy;
mod lanes;
mod occlusion;
mod rays;
mod renderer;
mod returns;
mod shares;
mod tile;
mod traced_ray;
mod triangle;
mod wide_tree;

pub use cast::{CastTraverser, TracedHit, TracedMeeting, TracerCast};
pub use lanes::Instructions;
pub use renderer::Tracer;

/// Compiles the README's example.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

// The tests by public items are in the program of the unit tests: one executable for the crate.
#[cfg(test)]
extern crate self as raypencil_tracer;
#[cfg(test)]
#[path = "../tests/it/mod.rs"]
mod it;
