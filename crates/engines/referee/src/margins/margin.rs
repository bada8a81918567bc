//! Margin: an interval that contains the least displacement which changes an answer.

use crate::rays::displacement::{Displacement, max_norm};

/// The least displacement that changes an answer lies in `lo..=hi`, by the larger of |dx| and |dy|.
///
/// Of a sensor's ray it is in cells, capped at 1. Of a ray of no sensor it is in the mesh's unit, capped at the diagonal of the
/// mesh's bounding box. Where both ends are equal to the cap, no displacement up to it changes the answer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Margin {
    /// Proven: no ray displaced by less than this changes the answer.
    pub lo: f64,
    /// Some displacements of this size, or larger by as little as is wanted, change it; the cap if none was found.
    pub hi: f64,
    /// A displaced ray with another answer, judged exactly. `None` if none was found: the margin is capped, or the places where
    /// the answer differs are too narrow for two `f64` numbers.
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

/// Both margins of a ray. Of a ray with [`CastRay::t_blind`](raypencil_scene::CastRay::t_blind) a change from too near to
/// measured, or back, counts in both.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Margins {
    /// Of the set of nearest faces: any change of it counts, also from one face to the next of a plane.
    pub face: Margin,
    /// Of the surface: the ray changes between hit and miss, or its range jumps.
    pub surface: Margin,
}
