//! Slacks: a clause that is kept, but not to the last digits. Each has a size, from 0 for an honest renderer.
//!
//! A [`Fault`](crate::Fault) ignores a clause. A slack keeps it by so much: a bias of shadow rays, a far plane that is a little
//! too far, edges a little too wide. How large it may be before a pack notices it is the pack's sharpness.

use glam::DVec2;

use crate::clause::Clause;

/// The unit of a slack's size.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SlackUnit {
    /// Cells of the sensor.
    Cells,
    /// Pixels of the camera.
    Pixels,
    /// A share of the quantity itself.
    Share,
    /// A cosine.
    Cosine,
}

impl SlackUnit {
    /// The unit in words, for a table.
    pub fn words(self) -> &'static str {
        match self {
            Self::Cells => "of a cell",
            Self::Pixels => "of a pixel",
            Self::Share => "as a share",
            Self::Cosine => "as a cosine",
        }
    }
}

/// Defines the slacks in one list: each with its key, clause, unit and what a renderer with it does.
macro_rules! slacks {
    ($($name:ident: $key:literal, $clause:ident, $unit:ident, $what:literal;)*) => {
        /// A clause of the contract that is kept with a tolerance of some size.
        ///
        /// ```
        /// use raypencil_naive::{Clause, Slack};
        ///
        /// let slack = Slack::ShadowStartsAway;
        /// assert_eq!((slack.key(), slack.clause()), ("shadow-starts-away", Clause::UpToThePoint));
        /// ```
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
        pub enum Slack {
            $(#[doc = $what] $name,)*
        }

        impl Slack {
            /// All slacks.
            pub const ALL: &'static [Self] = &[$(Self::$name,)*];

            /// Name in manifests: words joined by `-`.
            pub fn key(self) -> &'static str {
                match self {
                    $(Self::$name => $key,)*
                }
            }

            /// The clause that is kept by so much only.
            pub fn clause(self) -> Clause {
                match self {
                    $(Self::$name => Clause::$clause,)*
                }
            }

            /// The unit of its size.
            pub fn unit(self) -> SlackUnit {
                match self {
                    $(Self::$name => SlackUnit::$unit,)*
                }
            }

            /// What a renderer with a slack of the size x does.
            pub fn what(self) -> &'static str {
                match self {
                    $(Self::$name => $what,)*
                }
            }
        }
    };
}

slacks! {
    ShiftRight: "shift-right", CellCentres, Cells, "Faces are decided by a ray x to the right.";
    ShiftLeft: "shift-left", CellCentres, Cells, "Faces are decided by a ray x to the left.";
    ShiftDown: "shift-down", CellCentres, Cells, "Faces are decided by a ray x below.";
    ShiftUp: "shift-up", CellCentres, Cells, "Faces are decided by a ray x above.";
    ShiftRightDown: "shift-right-down", CellCentres, Cells, "Faces are decided by a ray x to the right and below.";
    ShiftRightUp: "shift-right-up", CellCentres, Cells, "Faces are decided by a ray x to the right and above.";
    ShiftLeftDown: "shift-left-down", CellCentres, Cells, "Faces are decided by a ray x to the left and below.";
    ShiftLeftUp: "shift-left-up", CellCentres, Cells, "Faces are decided by a ray x to the left and above.";
    EdgesWider: "edges-wider", NothingBesideTheFace, Share, "Barycentric coordinates from -x on are taken.";
    EdgesNarrower: "edges-narrower", Edges, Share, "Barycentric coordinates below x are not taken.";
    PlaneEarlier: "plane-earlier", NotBeforeThePlane, Share, "Hits from t = 1 - x on count.";
    PlaneLater: "plane-later", OnThePlane, Share, "Hits before t = 1 + x do not count.";
    RangeLonger: "range-longer", MaximumRange, Share, "The maximum range is (1 + x) times as long.";
    RangeShorter: "range-shorter", MaximumRangeIncluded, Share, "The maximum range is (1 - x) times as long.";
    FartherFace: "farther-face", NearestFace, Share, "Of faces within a share x of the nearest the farthest is taken.";
    GrazingLost: "grazing-lost", SmallFaces, Cosine, "Faces met at a cosine below x are lost.";
    GrazingBacksMet: "grazing-backs-met", FrontsOnly, Cosine, "Backs at a cosine below x are met.";
    RangeScaled: "range-scaled", RangeAlongTheRay, Share, "Ranges are (1 + x) times as long.";
    DepthScaled: "depth-scaled", DepthAlongTheAxis, Share, "Depths are (1 + x) times as long.";
    PointMoved: "point-moved", PointInTheScene, Share, "Points lie (1 + x) times as far along their rays.";
    NormalTurned: "normal-turned", NormalOfTheFront, Cosine, "Normals are turned by x, radians.";
    IncidenceScaled: "incidence-scaled", IncidenceOfTheRay, Share, "The incidence is (1 + x) times as large.";
    ShadowStartsAway: "shadow-starts-away", UpToThePoint, Share,
        "Shadow rays start at a share x of the way from the point to the camera.";
    ShadowFromBehind: "shadow-from-behind", FacesAtThePoint, Share,
        "Faces behind the point by a share up to x of the way hide it.";
    ShadowStopsShort: "shadow-stops-short", BacksHide, Share,
        "Shadow rays stop at a share x of the way before the camera's projection plane.";
    ShadowPastPlane: "shadow-past-plane", UpToThePlane, Share,
        "Shadow rays run on beyond the camera's projection plane, by a share x of its distance.";
    OccludersWider: "occluders-wider", UpToThePoint, Share,
        "Faces hide points whose barycentric coordinates on the way are from -x on.";
    OccludersNarrower: "occluders-narrower", BacksHide, Share,
        "Faces hide no point whose barycentric coordinates on the way are below x.";
    SeenFromBehindALittle: "seen-from-behind", SeenFromTheFront, Cosine, "Faces seen from behind at cosines above -x are seen.";
    UnseenAtGrazing: "unseen-at-grazing", SeenFromTheFront, Cosine, "Faces seen from before at cosines below x are not seen.";
    LandsRight: "lands-right", PixelOfThePoint, Pixels, "Points land x to the right.";
    LandsLeft: "lands-left", PixelOfThePoint, Pixels, "Points land x to the left.";
    LandsBelow: "lands-below", PixelOfThePoint, Pixels, "Points land x below.";
    LandsAbove: "lands-above", PixelOfThePoint, Pixels, "Points land x above.";
    ImageWider: "image-wider", OnTheImage, Pixels, "The image is wider by x on every side.";
    ImageNarrower: "image-narrower", OnTheImage, Pixels, "The image is narrower by x on every side.";
    FluxScaled: "flux-scaled", Reflectivity, Share, "The flux is (1 + x) times as large.";
}

impl Slack {
    /// The direction in which it shifts rays, in cells to the right and down, if it does.
    pub(crate) fn shift(self) -> Option<DVec2> {
        Some(match self {
            Self::ShiftRight => DVec2::new(1.0, 0.0),
            Self::ShiftLeft => DVec2::new(-1.0, 0.0),
            Self::ShiftDown => DVec2::new(0.0, 1.0),
            Self::ShiftUp => DVec2::new(0.0, -1.0),
            Self::ShiftRightDown => DVec2::new(1.0, 1.0),
            Self::ShiftRightUp => DVec2::new(1.0, -1.0),
            Self::ShiftLeftDown => DVec2::new(-1.0, 1.0),
            Self::ShiftLeftUp => DVec2::new(-1.0, -1.0),
            _ => return None,
        })
    }

    /// The largest size that is worth trying: by then the clause is ignored.
    pub fn largest(self) -> f64 {
        match self.unit() {
            SlackUnit::Cells | SlackUnit::Pixels => 0.25,
            SlackUnit::Share | SlackUnit::Cosine => 0.5,
        }
    }
}
