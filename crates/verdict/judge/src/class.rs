//! Class of a ray or of one value: what a difference is.

use serde::Serialize;
use serde_json::Value;

use raypencil_referee::Ruling;

/// What a difference is, from the best to the worst.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Class {
    /// The exact face, or no hit; every value within its bound.
    Agree,
    /// One of several faces that the ray meets at exactly the same point.
    Tie,
    /// Not the exact answer, but the answer of a ray that the declared arithmetic may have displaced.
    Rounding,
    /// One side follows the paper into error, for a cause that the referee confirms.
    Approximation,
    /// The referee's budget of bits ran out. Rulings on faces and visibility need no budget, so `compare` never
    /// enters this class. In `check`, a flux by transcendental functions may lie so near a midpoint of two numbers
    /// that thousands of bits do not decide its rounding.
    Undecided,
    /// Anything else.
    Defect,
}

impl Class {
    /// Number of classes.
    pub const COUNT: usize = 6;

    /// The class of an answer by its ruling. `has_cause`: an approximation of the paper explains the answer.
    pub fn of(ruling: Ruling, has_cause: bool) -> Self {
        match ruling {
            Ruling::Exact => Self::Agree,
            Ruling::Tie => Self::Tie,
            Ruling::Rounding(_) => Self::Rounding,
            Ruling::Wrong if has_cause => Self::Approximation,
            Ruling::Wrong => Self::Defect,
        }
    }

    /// Key of the class's count in JSON documents.
    fn key(self) -> &'static str {
        match self {
            Self::Agree => "agree",
            Self::Tie => "tie",
            Self::Rounding => "rounding",
            Self::Approximation => "approximation",
            Self::Undecided => "undecided",
            Self::Defect => "defects",
        }
    }
}

/// Number of rays in each class, in the order of [`Class`].
pub type ClassCounts = [u64; Class::COUNT];

/// The classes that `check` can give: it knows no cause, so it has no approximation.
pub const CHECK_CLASSES: [Class; 5] =
    [Class::Agree, Class::Tie, Class::Rounding, Class::Undecided, Class::Defect];

/// All classes, as `compare` gives them.
pub const COMPARE_CLASSES: [Class; Class::COUNT] =
    [Class::Agree, Class::Tie, Class::Rounding, Class::Approximation, Class::Undecided, Class::Defect];

/// The counts of `classes` as a JSON object.
///
/// ```
/// use raypencil_judge::{CHECK_CLASSES, class_counts_json};
///
/// // Seven rays agree, two are defects: the counts stand in the order of `Class`.
/// let counts = class_counts_json(&[7, 0, 0, 0, 0, 2], &CHECK_CLASSES);
/// assert_eq!(counts["agree"], 7);
/// assert_eq!(counts["defects"], 2);
/// // `check` gives no approximations, so its documents do not count them.
/// assert_eq!(counts.get("approximation"), None);
/// ```
pub fn class_counts_json(counts: &ClassCounts, classes: &[Class]) -> Value {
    let count = |class: &Class| (class.key().to_string(), Value::from(counts[*class as usize]));
    Value::Object(classes.iter().map(count).collect())
}
