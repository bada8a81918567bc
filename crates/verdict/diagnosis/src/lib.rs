//! Why rays of a recording are wrong: the mistake that explains it, or the two, sensor by sensor.
//!
//! Internal to raypencil: any version may change its items. The crate `raypencil` is the door.
//!
//! A renderer that breaks one convention (rows reversed, depth for range, millimetres) is wrong on all rays, and its
//! list of wrong rays does not say why. This crate undoes each known mistake on the recording's own numbers, singly and
//! then in pairs, and asks the judge again. Mistakes of the rays themselves (hits on backs, another focal length) cannot
//! be undone; there the rays are cast otherwise, and the answers must be those of the recording. Nor can lengths that
//! were rounded or lost; what the mistake makes of the exact ones is compared. `docs/guide/reasons.md` has the rules by
//! which a reason is told.
//!
//! ```
//! # use std::sync::Arc;
//! # use glam::DVec3;
//! # use raypencil_scene::{Atmosphere, Camera, FluxModel, Lens, Material, Mesh, Mounted, Pose, Scene};
//! # let corners = vec![[0.125, -40.0, 2.0], [-90.0, 0.0, 2.0], [0.125, 40.0, 2.0]];
//! # let plaster = Material { name: "plaster".into(), reflectivity: 0.5 };
//! # let wall = Mesh::new(DVec3::ZERO, corners, vec![[0, 1, 2]], vec![0], vec![plaster])?;
//! # let camera = Camera {
//! #     width: 9, height: 9, pixel_pitch: [0.0625; 2], focal_length: 0.5, principal_point: [4.5; 2],
//! #     aperture: 0.01, lens: Lens::CLEAR, max_range: 20.0,
//! # };
//! # let camera = Mounted { scene_from_sensor: Pose::IDENTITY, sensor: camera };
//! # let air = Atmosphere { attenuation: 0.0 };
//! # let scene = Scene::new(Arc::new(wall), camera, vec![], air, FluxModel::Radiometric)?;
//! // A wall at z = 2 m that ends at x = 1/8 m, before a camera of 9 x 9 pixels at the origin that looks along z.
//! use raypencil_diagnosis::{Mistake, diagnose};
//! use raypencil_judge::{GroundTruth, Recorded, check};
//! use raypencil_referee::ExactRenderer;
//! use raypencil_scene::{Maybe, Precision, Renderer, Request, Silent};
//!
//! // A program that writes the depth, which is 2 m everywhere, as the range.
//! let mut output = ExactRenderer.render(&scene, &Request::MAPS);
//! let camera = output.camera.as_mut().unwrap();
//! camera.range = camera.depth.clone();
//! let recorded = Recorded::of_output("mine", &scene, &output, Precision::F64);
//! let truth = GroundTruth::certified(&scene, &Silent);
//! let found = check(&truth, &recorded, &Silent);
//!
//! // 45 rays hit the wall, and the one along the axis is right: its range is its depth.
//! let diagnosis = diagnose(&truth, &recorded, &found).unwrap();
//! let reason = &diagnosis.reasons[0];
//! assert_eq!(reason.mistakes, [Mistake::DepthForRange]);
//! assert_eq!((reason.explained, reason.wrong), (44, 44));
//! assert_eq!((reason.broken, reason.right), (0, 37));
//! # Ok::<(), raypencil_scene::SceneError>(())
//! ```
//!
//! The files, from the parts up:
//!
//! ```text
//! mistake        the mistakes
//! mistake_names  their names for programs, and the pages of the documentation
//! words          the mistakes in words
//! numbers        the plainest number that says the same
//! channel        channels of a recording, cell by cell
//! case           what a reason is looked for in
//! correction     what undoes a mistake
//! forward        what a mistake that nothing undoes makes of an exact value
//! agree          values that are near enough to be tried further
//! agree_after    the same after some corrections
//! sample         the rays on which mistakes are tried
//! tally          what a reason explains and breaks, and when that is enough
//! trial          what a correction leaves off, and which channels it helps
//! lengths        factor, offset and quantum of lengths
//! cuts           lost lines and lost lengths, by an interval search
//! fit            the corrections to try, and numbers found from the recording
//! judged         a corrected recording before the judge
//! image          the camera's image as the sum of wrong pencils
//! landing        what another camera does to the light of beams
//! rules          rules and numbers of rays that may differ
//! cast           rays cast by other rules
//! calibrate      numbers of a sensor, by least squares
//! rays           what a renderer with other rules explains
//! search         the search for one sensor, or for several together
//! diagnosis      the result
//! diagnose       each sensor, then together
//! ```

mod agree;
mod agree_after;
mod calibrate;
mod case;
mod cast;
mod channel;
mod correction;
mod cuts;
mod diagnose;
mod diagnosis;
mod fit;
mod forward;
mod image;
mod judged;
mod landing;
mod lengths;
mod mistake;
mod mistake_names;
mod numbers;
mod rays;
mod rules;
mod sample;
mod search;
mod tally;
mod trial;
mod words;

/// The example of README.md, compiled.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

pub use diagnose::diagnose;
pub use diagnosis::{Diagnosis, Reason};
pub use mistake::{
    AngleUnit, Cosine, CutBy, FrameAxes, Held, Leg, Length, LengthUnit, Mistake, Turn, Vectors,
};

// The tests by public items are in the program of the unit tests: one executable for the crate.
#[cfg(test)]
extern crate self as raypencil_diagnosis;
#[cfg(test)]
#[path = "../tests/it/mod.rs"]
mod it;
