//! What became of stated first hits.

use raypencil_scene::{FaceId, Precision, Reading};

/// A value of a first hit.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum CastValue {
    /// The ray's parameter.
    T,
    /// Distance from the origin.
    Range,
    /// The side that is met.
    Side,
    /// The point.
    Point,
    /// The unit normal.
    Normal,
    /// The weights of the corners.
    Barycentric,
    /// Cosine of incidence.
    CosIncidence,
}

impl CastValue {
    /// All of them, in the order of reports.
    pub const ALL: [Self; 7] =
        [Self::T, Self::Range, Self::Side, Self::Point, Self::Normal, Self::Barycentric, Self::CosIncidence];

    /// The name, which is that of the value's array.
    pub fn name(self) -> &'static str {
        match self {
            Self::T => "t",
            Self::Range => "range",
            Self::Side => "side",
            Self::Point => "point",
            Self::Normal => "normal",
            Self::Barycentric => "barycentric",
            Self::CosIncidence => "cos_incidence",
        }
    }
}

/// What is wrong with one ray.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Wrong {
    /// What is stated is not the answer to the ray, nor to one nearby.
    Hit {
        /// The face that is stated, or what stands in its place.
        stated: Reading<FaceId>,
        /// The exact one; of several the lowest.
        exact: Reading<FaceId>,
    },
    /// A hit is stated where no face is met at that distance.
    Distance {
        /// The t that is stated, or the range if only that is given.
        stated: f64,
        /// The exact one.
        exact: Reading<f64>,
    },
    /// It is stated that something is hit, not what, and nothing is hit, nor by a ray nearby.
    Something {
        /// The exact answer.
        exact: Reading<FaceId>,
    },
    /// One of t and range says that what is hit is too near, the other that nothing is hit.
    Contradiction,
    /// One array says that the ray hits something, another that it does not.
    Disagreement {
        /// The array that says which rays hit.
        by: &'static str,
        /// Whether that one says so.
        is_hit: bool,
        /// The other one.
        of: &'static str,
        /// What it has; of a vector the first part, of a truth value 1 or 0.
        number: f64,
    },
    /// The face is right and a value is not.
    Value {
        /// Which value.
        value: CastValue,
        /// The largest difference of its parts.
        error: f64,
        /// What rounding may do.
        bound: f64,
    },
}

/// What became of one ray.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum RayVerdict {
    /// The same; of a tie one of its faces.
    Same {
        /// Whether several faces are met at exactly this t.
        is_tie: bool,
    },
    /// The answer of a ray that is moved sideways by `moved` along the two vectors of `CastRay::across`.
    Rounding {
        /// The displacement, in the mesh's unit.
        moved: [f64; 2],
    },
    /// Wrong.
    Wrong(Wrong),
}

/// How often a value was compared, and the worst of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ValueTally {
    /// The value.
    pub value: CastValue,
    /// Number of rays with the same face on which it was compared.
    pub compared: u64,
    /// Number of rays with the same face on which it was not: the face is too thin for the program's arithmetic, and rounding may make
    /// anything of it.
    pub not_compared: u64,
    /// Number of the compared rays on which it is beyond its bound.
    pub wrong: u64,
    /// The largest error as a part of its bound, and the index of its ray; `None` if nothing was compared.
    pub worst: Option<(f64, usize)>,
}

/// Stated first hits, ray by ray.
#[derive(Debug, Clone, PartialEq)]
pub struct Comparison {
    /// One for each ray.
    pub verdicts: Vec<RayVerdict>,
    /// One for each value that is given.
    pub values: Vec<ValueTally>,
    /// Number of rays that meet something, too near or not, by the exact answer.
    pub met: u64,
    /// Precision of the program's arithmetic.
    pub precision: Precision,
}

impl Comparison {
    /// Numbers of rays: the same, of these ties, rounding, wrong.
    pub fn counts(&self) -> CastCounts {
        let mut counts = CastCounts::default();
        for verdict in &self.verdicts {
            match verdict {
                RayVerdict::Same { is_tie } => {
                    counts.same += 1;
                    counts.ties += u64::from(*is_tie);
                }
                RayVerdict::Rounding { .. } => counts.rounding += 1,
                RayVerdict::Wrong(_) => counts.wrong += 1,
            }
        }
        counts
    }

    /// Whether no ray is wrong, and some ray meets something.
    pub fn passes(&self) -> bool {
        self.met > 0 && self.counts().wrong == 0
    }

    /// Appends the comparison of the rays that follow in the same answers, so that many rays can be compared piece by piece.
    pub fn append(&mut self, later: Self) {
        let before = self.verdicts.len();
        self.verdicts.extend(later.verdicts);
        self.met += later.met;
        for (tally, more) in self.values.iter_mut().zip(later.values) {
            tally.compared += more.compared;
            tally.not_compared += more.not_compared;
            tally.wrong += more.wrong;
            // Of equal errors the first ray stays.
            let is_worse = |(error, _): &(f64, usize)| tally.worst.is_none_or(|(known, _)| *error > known);
            if let Some((error, ray)) = more.worst.filter(is_worse) {
                tally.worst = Some((error, before + ray));
            }
        }
    }

    /// The wrong rays, by index.
    pub fn wrong(&self) -> impl Iterator<Item = (usize, Wrong)> + '_ {
        self.verdicts.iter().enumerate().filter_map(|(index, verdict)| match verdict {
            RayVerdict::Wrong(wrong) => Some((index, *wrong)),
            _ => None,
        })
    }
}

/// Numbers of rays by what became of them.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct CastCounts {
    /// The same, ties among them.
    pub same: u64,
    /// Of the same, those on which several faces are met at exactly the same t.
    pub ties: u64,
    /// Excused by rounding, with a witness.
    pub rounding: u64,
    /// Wrong.
    pub wrong: u64,
}

impl CastCounts {
    /// All rays.
    pub fn all(&self) -> u64 {
        self.same + self.rounding + self.wrong
    }
}
