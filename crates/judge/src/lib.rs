//! One judging engine: two renderers against each other, or a recording against the truth.

mod answers;
mod attribution;
mod bounds;
pub mod check;
mod class;
pub mod compare;
mod judge;
mod recorded;
mod tally;

pub use answers::{Answers, BeamLight, Certified};
pub use attribution::cause::{Attributions, Cause, VisibilityCause};
pub use attribution::court::Rerender;
pub use bounds::Bounds;
pub use check::tally::{ItemTally, Largest, SensorCheck, Wrong};
pub use check::truth::{NotOurs, Truth};
pub use check::{Check, check};
pub use class::{Class, Item, Quantity, key_of, name_of, unit_of};
pub use compare::side::Side;
pub use compare::single::{First, class_at, first_of};
pub use compare::{compare, compare_judged};
pub use judge::{Judge, JudgeShare};
pub use recorded::Recorded;
pub use recorded::error::RecordingError;
pub use recorded::names::{flux_channel, image_channel, is_of_outsiders, item_of_channel};
pub use tally::{ApproximationTallies, ApproximationTally, Defect, SensorComparison, Tally, Worst};
