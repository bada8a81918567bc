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
//! The files, from the numbers up to the answers:
//!
//! ```text
//! number, vector        intervals and exact dyadic rationals
//! double_double         pairs of f64 with a proven error
//! elementary            exp and atan of such pairs
//! rounding, enclosure   exact quotients and roots, rounded; intervals of any precision
//! arithmetic            one formula in pairs of f64 and in enclosures
//! aspect                how badly the normal of a triangle may be rounded
//! kleene                three-valued logic of intervals
//! displacement          displacements of a ray, in cells
//! ray                   the contract's rays, multiplied by their denominators
//! edge_filter           on which side of a face's edges a ray passes, in f64
//! face                  the contract's conditions, as signs of polynomials
//! form, moving_ray      bilinear forms in a displacement; a ray as it is displaced
//! face_forms, region    the conditions of a face as forms, and where they hold
//! wide_boxes            boxes of a hierarchy, four a node, as rays walk through them
//! bvh                   bounding volume hierarchy: the faces that a ray may meet
//! verdict               the referee and the nearest faces of a ray
//! through_point         the displacement whose ray passes through a point
//! neighbourhood         all faces near a ray, and the verdict on any ray beside it
//! subdivision           the unit square of displacements, subdivided
//! margin, margins       how far a verdict is from changing, with a witness
//! face_margin           the margin of the nearest faces
//! sheet, surface_margin where the range is continuous, and the margin of that
//! rounded_face          how wrong an honest program may be about one face
//! rounded_line          how wrong it may be about a line of sight
//! ruling                whether an answer is right, or admissible
//! line_of_sight         the line from the camera to a point, as polynomials
//! visibility            what the camera sees of a pencil's hit
//! occluder              faces that may hide points of another
//! visibility_margin     how far the visibility is from changing
//! visibility_ruling     whether an answer about it is right, or admissible
//! approximations        the paper's approximations and their effects
//! paper, paper_raster   whether they explain a wrong hit, and how they draw a face
//! paper_visibility      whether they explain a wrong visibility
//! intersection, values  values of a hit, correctly rounded
//! shares, flux          a pencil's share of the power, and its flux
//! beam_returns          values of a pencil's return, correctly rounded
//! certified, render     the answers of a whole sensor, and as a renderer
//! cast                  any rays on any triangles: a kernel of its own
//! ```
//!
//! The crate depends on `raypencil-scene` alone, and no renderer may call it.

mod approximations;
mod arithmetic;
mod aspect;
mod beam_returns;
mod bvh;
mod cast;
mod certified;
mod displacement;
mod double_double;
mod edge_filter;
mod elementary;
mod enclosure;
mod face;
mod face_forms;
mod face_margin;
mod flux;
mod form;
mod intersection;
mod kleene;
mod line_of_sight;
mod margin;
mod margins;
mod moving_ray;
mod neighbourhood;
mod number;
mod occluder;
mod paper;
mod paper_raster;
mod paper_visibility;
mod ray;
mod region;
mod render;
mod rounded_face;
mod rounded_line;
mod rounding;
mod ruling;
mod shares;
mod sheet;
mod short_integer;
mod subdivision;
mod surface_margin;
mod through_point;
mod values;
mod vector;
mod verdict;
mod visibility;
mod visibility_margin;
mod visibility_ruling;
mod wide_boxes;

#[cfg(test)]
#[path = "../tests/common/splitmix.rs"]
mod splitmix;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

pub use approximations::{Approximations, Explained, Reason};
pub use arithmetic::Undecided;
pub use aspect::aspect;
pub use beam_returns::{BeamReturns, Contribution, RoundedReturn};
pub use cast::{CastHit, CastMeeting, CastTree, DecidedBy, ExactCast, HitGroup, SidedFace};
pub use certified::{CertifiedMap, CertifiedReturns, PixelSum};
pub use displacement::Displacement;
pub use flux::Flux;
pub use margin::{Margin, Margins};
pub use paper_visibility::{ExplainedVisibility, VisibilityApproximations, VisibilityReason};
pub use render::ExactRenderer;
pub use rounded_face::{RANGE_ROUNDINGS, edge_slip};
pub use rounding::{Format, Rounded};
pub use ruling::{Ruling, Tolerance};
pub use values::RoundedHit;
pub use verdict::{Referee, RefereeTree, Verdict};
pub use visibility::Visibility;
pub use visibility_margin::VisibilityMargins;
pub use visibility_ruling::VisibilityRuling;

// The tests by public items are in the program of the unit tests: one executable for the crate.
#[cfg(test)]
extern crate self as raypencil_referee;
#[cfg(test)]
#[path = "../tests/it/mod.rs"]
mod it;
