//! The judge: the true answer for any ray of the contract, and how far that answer is from changing.
//!
//! Two f64 programs that agree prove only that they share their mistakes. All that the contract says of a ray
//! is a sign of a polynomial in stored f64 numbers, so it can be known without error: by an interval if
//! that is certain, else by exact dyadic rationals. Proofs and bounds are in `docs/referee.md`.
//!
//! ```text
//! number, vector   intervals and exact dyadic rationals
//! pencil           the contract's rays, multiplied by their denominators
//! face             the contract's conditions, as signs of polynomials
//! cull             a tree of boxes of its own
//! verdict          the nearest faces of a ray
//! forms, region    the conditions as functions of a small displacement, in f64 with proven errors
//! near             all faces near a ray, and the verdict on any ray beside it
//! margin, surface  how far a verdict is from changing, with a witness
//! sheet, divide    where the range is continuous; what to do where one square does not tell
//! ruling           whether an answer is right, or admissible
//! sight            what the camera sees of a pencil's hit
//! sight_margin     how far that is from changing
//! sight_ruling     whether an answer about that is right, or admissible
//! values           what a ray meets, correctly rounded
//! light            what comes back of a pencil, correctly rounded
//! rounding         exact quotients and roots, rounded
//! twofold          pairs of f64 with a proven error: the fast way
//! enclosure        any precision: the certain way
//! arithmetic       one formula for both
//! certified        the values of a whole sensor
//! paper            whether an approximation of the paper explains an answer
//! paper_sight      the same of what the camera sees
//! truth            yes, no, or either, of what is known up to an interval
//! render           the verdicts of a whole sensor
//! ```
//!
//! It depends on `raypencil-scene` alone, and no renderer may call it.

mod approximations;
mod arithmetic;
mod bvh;
mod certified;
mod displacement;
mod double_double;
mod enclosure;
mod face;
mod face_forms;
mod face_margin;
mod flux;
mod form;
mod intersection;
mod kleene;
mod light;
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
mod rounding;
mod ruling;
mod shares;
mod sheet;
mod subdivision;
mod surface_margin;
mod through_point;
mod values;
mod vector;
mod verdict;
mod visibility;
mod visibility_margin;
mod visibility_ruling;

#[cfg(test)]
#[path = "../tests/common/splitmix.rs"]
mod splitmix;

pub use approximations::{Approximations, Explained, Reason};
pub use arithmetic::Undecided;
pub use certified::{CertifiedLight, CertifiedMap, PixelSum};
pub use displacement::Displacement;
pub use flux::Flux;
pub use light::{Contribution, Light, RoundedReturn};
pub use margin::Margin;
pub use margins::Margins;
pub use paper_visibility::{ExplainedSight, SightApproximations, SightReason};
pub use render::ExactRenderer;
pub use rounding::{Format, Rounded};
pub use ruling::{Ruling, Tolerance};
pub use values::RoundedHit;
pub use verdict::{Referee, Verdict};
pub use visibility::Visibility;
pub use visibility_margin::SightMargins;
pub use visibility_ruling::SightRuling;
