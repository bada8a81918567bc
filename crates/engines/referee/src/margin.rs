//! Margin: an interval that contains the least displacement which changes an answer.

use crate::displacement::{Displacement, max_norm};

/// The least displacement that changes an answer lies in `lo..=hi`, cells by the larger of |dx| and |dy|, capped at
/// 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Margin {
    /// Proven: no ray displaced by less than this changes the answer.
    pub lo: f64,
    /// The witness's displacement; 1 if there is no witness.
    pub hi: f64,
    /// A displaced ray with another answer, judged exactly.
    pub witness: Option<Displacement>,
}

impl Margin {
    /// The margin of an answer that does not change within a cell.
    pub(crate) const CAPPED: Self = Self { lo: 1.0, hi: 1.0, witness: None };

    /// A margin from the proven radius and the nearest witness found.
    pub(crate) fn of(lo: f64, witness: Option<[f64; 2]>) -> Self {
        match witness {
            Some(at) => {
                Self { lo, hi: max_norm(at).min(1.0), witness: Some(Displacement { dx: at[0], dy: at[1] }) }
            }
            None => Self { lo, hi: 1.0, witness: None },
        }
    }
}
