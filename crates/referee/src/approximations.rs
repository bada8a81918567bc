//! Approximations.

use std::fmt;

use raypencil_scene::FaceId;

/// Which of the paper's approximations an answer was made with.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Approximations {
    /// A beam's faces are clipped to the stripe, their sides drawn straight. (§5, figures 8 and 9)
    pub beam_edges: bool,
    /// Faces are skipped by rules 1b, 3b and 3c as printed. (§4)
    pub skip_rules: bool,
}

/// Why a face is seen, or not seen, where the contract says otherwise.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Reason {
    /// The pencil lies between a side of the face and the straight line drawn for it.
    StraightSide,
    /// Rule 1b: the middle of the sheet and the pencil's own row see different sides of the face.
    FacingOfMiddle,
    /// Rule 3b: all vertices of what clipping leaves are in the screen and beyond the maximum range.
    VerticesTooFar,
    /// Rule 3c: the straight lines between its vertices do not come into the screen, its true sides do.
    SidesApart,
}

impl Reason {
    /// Whether it belongs to [`Approximations::beam_edges`]; else to [`Approximations::skip_rules`].
    pub fn is_of_beam_edges(self) -> bool {
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

/// A face that is seen or not seen against the contract, and why.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Explained {
    /// Which face.
    pub face: FaceId,
    /// Whether the approximations add it; else they lose it.
    pub added: bool,
    /// All reasons that hold; at least one.
    pub reasons: Vec<Reason>,
}
