//! The judge of raypencil: it says of every ray whether an answer is right, and how far its values are from right.
//!
//! Internal to raypencil: any version may change its items. The crate `raypencil` is the door.
//!
//! Answers come from renderers of this project or from files of other programs. Faces, visibility and pixels are ruled
//! on by the referee in exact arithmetic (`docs/theory/referee.md`). Values are held to bounds of rounding errors,
//! which `bounds` derives. Nothing in this crate renders.
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
//! use raypencil_judge::{Class, GroundTruth, Recorded, check};
//! use raypencil_referee::ExactRenderer;
//! use raypencil_scene::{FaceId, Maybe, Precision, Renderer, Request, Silent};
//!
//! // Pixel (5, 4) passes the wall at x = 1/4 m. A program that hits the wall there is wrong on one of 81 rays.
//! let mut output = ExactRenderer.render(&scene, &Request::MAPS);
//! let camera = output.camera.as_mut().unwrap();
//! camera.face.as_mut().unwrap().set(5, 4, Maybe::some(FaceId(0)));
//! let recorded = Recorded::of_output("wrong", &scene, &output, Precision::F64);
//! let found = check(&GroundTruth::certified(&scene, &Silent), &recorded, &Silent);
//! assert_eq!((found.of(Class::Agree), found.of(Class::Defect)), (80, 1));
//! # Ok::<(), raypencil_scene::SceneError>(())
//! ```
//!
//! There are two ways in. [`compare()`] holds two renderers against each other; the referee rules where they differ,
//! and on a sample of the rays on which they agree. [`check()`] holds one recording against the [`GroundTruth`], every
//! exact answer. Both make the same results of the same parts. The files, from the parts up:
//!
//! ```text
//! class, quantity        what a difference is, and of what
//! answer                 what a side states of one hit and of one return
//! bounds                 how far rounding may displace the values of a hit or a return
//! difference             a stated value beside another one, and whether rounding explains the error
//! tally                  results: counts, largest errors with their places, defects
//! entry                  one ray being judged, entered into its sensor's result
//! scene_answers          all answers about a scene
//! item_value, listed*    the defects that reports list: said, true, difference, margin
//! recorded/              answers read from files
//! judge                  when the referee is asked, and with what tolerance
//! attribution/           which of the paper's approximations causes an error
//! compare/               two renderers: hit, pencil, pixel, ray, sensor, single rays
//! check/                 a recording: the truth, hit, pencil, pixel, storage, uncertain light, single rays
//! ```
//!
//! # Two rules
//!
//! The parts are shared; the following rules differ between the two ways in, each for the reason given.
//!
//! * **Whether a ray hits.** `compare` asks for a face or a range, which every renderer gives. `check` takes any value
//!   for a hit, since a recording may hold one channel alone.
//! * **Bound of a value.** `compare` adds the bounds of two roundings: of both sides, or of one side and of the
//!   referee's f64. `check` adds half a unit in the last place of the storage and of f64 to one bound, since its truth
//!   is correctly rounded and its values went through a file.
//! * **Values of tied faces.** `compare` leaves out the quantities in which two tied faces differ (normal, cosines,
//!   flux). `check` has one side only, and judges all of its values by the face that this names.
//! * **Flux of 0.** `compare` allows what a subnormal share of the power may leave, since both sides compute. `check`
//!   allows no flux at all where the exact flux is 0, in any storage.
//! * **Classes.** `compare` knows a renderer's causes, so it has [`Class::Approximation`]. `check` knows none; but it
//!   asks for rounded fluxes, so it has [`Class::Undecided`].
//! * **Order of blame.** Of several values of a hit that are off the face named, `compare` blames the first number
//!   before any vector. `check` enters all of them in the order range, depth, point, normal, incidence.
//! * **Units in the last place, lists of places.** `check` tallies them, since a file has a last place and `diff` asks
//!   for single cells. `compare` leaves both out, and tallies approximations by cause instead.
//! * **Rulings in words.** `check` keeps them for its reports. `compare` gives a place, which `raypencil probe`
//!   explains.
//! * **NaN.** It counts as the largest value. `compare` keeps the first ray with a NaN and `check` the last: nothing
//!   depends on it but the place that is printed, and published results keep theirs.
//! * **Flux of a pixel.** `compare` enters one class for all beams, since a pixel's cause may be in any of them.
//!   `check` enters an item for each beam and model, as files hold them.

mod answer;
mod attribution;
mod bounds;
mod check;
mod class;
mod compare;
mod difference;
mod entry;
mod item_value;
mod judge;
mod listed;
mod listed_defect;
mod quantity;
mod recorded;
mod scene_answers;
mod tally;

/// The example of README.md, compiled.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

pub use attribution::cause::{Attributions, Cause, VisibilityCause};
pub use attribution::context::Rerender;
pub use bounds::range_bound;
pub use check::ground_truth::{GroundTruth, UncertifiedAnswer};
pub use check::single::{CheckedItem, CheckedRay, check_ray, check_ray_against};
pub use check::{Check, check, check_rays};
pub use class::{CHECK_CLASSES, COMPARE_CLASSES, Class, ClassCounts, class_counts_json};
pub use compare::side::Side;
pub use compare::single::{FirstOfClass, class_of_ray, first_of_class};
pub use compare::{compare, compare_judged};
pub use judge::{Judge, JudgeShare};
pub use listed::listed_defects;
pub use listed_defect::{DefectMargin, ListedDefect};
pub use quantity::{Item, Quantity, key_of, name_of, unit_of};
pub use recorded::Recorded;
pub use recorded::conventions::Conventions;
pub use recorded::error::{Help, RecordingError};
pub use recorded::names::{flux_channel, image_channel, item_of_channel};
pub use scene_answers::{Answers, BeamLight, Certified};
pub use tally::{
    ApproximationTallies, ApproximationTally, Defect, DifferingRay, ItemTallies, ItemTally, Largest,
    SensorResult, WrongRay,
};

// The tests by public items are in the program of the unit tests: one executable for the crate.
#[cfg(test)]
extern crate self as raypencil_judge;
#[cfg(test)]
#[path = "../tests/it/mod.rs"]
mod it;
