//! Margin.

use crate::displacement::{Displacement, max_norm};

/// The least displacement that changes a verdict, in cells, somewhere in `lo..=hi`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Margin {
    /// No displaced ray within this changes the verdict.
    pub lo: f64,
    /// The witness's displacement; 1 if there is none because the margin is capped.
    pub hi: f64,
    /// A displaced ray whose verdict is another.
    pub witness: Option<Displacement>,
}

impl Margin {
    /// A verdict that does not change within a cell.
    pub(crate) const CAPPED: Self = Self { lo: 1.0, hi: 1.0, witness: None };

    /// EventKind is proven, and the nearest displacement that was found to change the verdict.
    pub(crate) fn of(lo: f64, witness: Option<[f64; 2]>) -> Self {
        match witness {
            Some(at) => {
                Self { lo, hi: max_norm(at).min(1.0), witness: Some(Displacement { dx: at[0], dy: at[1] }) }
            }
            None => Self { lo, hi: 1.0, witness: None },
        }
    }
}
