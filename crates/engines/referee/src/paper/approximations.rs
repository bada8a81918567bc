//! The paper's approximations of geometry, and the reasons for which they change an answer.

use std::fmt;

use raypencil_scene::FaceId;

/// The paper's approximations that an answer was made with.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Approximations {
    /// A beam's faces are clipped to the stripe and their sides drawn straight. (§5, figures 8 and 9)
    pub beam_edges: bool,
    /// Rules 1b, 3b and 3c skip faces as printed. (§4)
    pub skip_rules: bool,
}

/// The reason why an approximation adds or loses a face.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Reason {
    /// The pencil lies between a side of the face and the straight line drawn for it.
    StraightSide,
    /// Rule 1b: the middle of the sheet and the pencil's own row see different sides of the face.
    FacingOfMiddle,
    /// Rule 3b: all vertices of the clipped face are in the screen and beyond the maximum range.
    VerticesTooFar,
    /// Rule 3c: the straight lines between the vertices do not meet the screen, the true sides do.
    SidesApart,
}

impl Reason {
    /// Whether the reason belongs to [`Approximations::beam_edges`]; otherwise it belongs to
    /// [`Approximations::skip_rules`].
    pub fn belongs_to_beam_edges(self) -> bool {
        self == Self::StraightSide
    }
}

impl fmt::Display for Reason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::StraightSide => "the pencil lies between a true side and the straight line drawn for it",
            Self::FacingOfMiddle => {
                "rule 1b: the middle of the sheet and the pencil's row see different sides"
            }
            Self::VerticesTooFar => {
                "rule 3b: all vertices are in the screen and beyond the maximum range, the hit is not"
            }
            Self::SidesApart => {
                "rule 3c: the straight lines between the vertices do not meet the screen, the true sides do"
            }
        })
    }
}

/// A face that the approximations add or lose against the contract, and why.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Explained {
    /// The face.
    pub face: FaceId,
    /// Whether the approximations add it; otherwise they lose it.
    pub added: bool,
    /// All reasons that hold; at least one.
    pub reasons: Vec<Reason>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_straight_sides_belong_to_beam_edges() {
        assert!(Reason::StraightSide.belongs_to_beam_edges());
        for of_rules in [Reason::FacingOfMiddle, Reason::VerticesTooFar, Reason::SidesApart] {
            assert!(!of_rules.belongs_to_beam_edges());
        }
    }
}
