//! Another program's first hits against the exact ones.
//!
//! ```text
//! stated     first hits as another program states them
//! verdict    what became of them: ray by ray, value by value
//! compare    the judge
//! text       the result on a screen and for programs
//! files      the result as arrays
//! ```

mod compare;
mod files;
mod stated;
mod text;
mod verdict;

pub(crate) use compare::normal_error;
pub use compare::{compare, compare_with};
pub use files::write_comparison;
pub use stated::{Stated, StoredErrors};
pub(crate) use text::wrong_text;
pub use text::{comparison_headline, comparison_json, comparison_text};
pub use verdict::{CastCounts, CastValue, Comparison, RayVerdict, ValueTally, Wrong};
