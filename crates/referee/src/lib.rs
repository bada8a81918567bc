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

mod arithmetic;
mod certified;
mod cull;
mod divide;
mod enclosure;
mod face;
mod forms;
mod light;
mod margin;
mod near;
mod number;
mod paper;
mod paper_sight;
mod pencil;
mod region;
mod render;
mod rounding;
mod ruling;
mod sheet;
mod sight;
mod sight_margin;
mod sight_ruling;
mod surface;
mod through;
mod truth;
mod twofold;
mod values;
mod vector;
mod verdict;

pub use arithmetic::Undecided;
pub use certified::{CertifiedLight, CertifiedMap, PixelSum};
pub use light::{Contribution, Flux, Light, RoundedReturn};
pub use margin::{Margin, Margins};
pub use paper::{Approximations, Explained, Reason};
pub use paper_sight::{ExplainedSight, SightApproximations, SightReason};
pub use render::ExactRenderer;
pub use rounding::{Format, Rounded};
pub use ruling::{Ruling, Tolerance};
pub use sight::Sight;
pub use sight_margin::SightMargins;
pub use sight_ruling::SightRuling;
pub use values::RoundedHit;
pub use verdict::{Displacement, Referee, Verdict};
