//! The clauses of the contract, and the faults that break each.

use raypencil_scene::FluxModel;

use crate::fault::Fault;

/// What a clause is about.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ClauseKind {
    /// The rays of pixels and pencils.
    Rays,
    /// Which face a ray meets, and the values there.
    Hits,
    /// Whether the camera sees a pencil's hit, and in which pixel.
    Visibility,
    /// A factor of the flux. Some factors belong to one model only.
    Flux(Option<FluxModel>),
}

impl ClauseKind {
    /// Whether a pack whose flux follows `model` has to test clauses of this kind.
    pub fn is_in_packs_of(self, model: FluxModel) -> bool {
        match self {
            Self::Rays | Self::Hits | Self::Visibility | Self::Flux(None) => true,
            Self::Flux(Some(own)) => own == model,
        }
    }
}

/// Defines the clauses in one list: each with its key, its kind, its sentence and the faults that break it.
macro_rules! clauses {
    ($($name:ident: $key:literal, $kind:expr, $sentence:literal, [$($fault:ident),+];)*) => {
        /// A clause of the contract (`docs/theory/contract.md`). A renderer that breaks one of its faults' ways fails a
        /// reference pack.
        ///
        /// ```
        /// use raypencil_naive::{Clause, Fault};
        ///
        /// let clause = Clause::FrontsOnly;
        /// assert_eq!(clause.key(), "fronts-only");
        /// assert_eq!(clause.faults(), [Fault::BackFacesHit, Fault::WindingOfOneQuadrant]);
        /// ```
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum Clause {
            $(#[doc = $sentence] $name,)*
        }

        impl Clause {
            /// All clauses that a pack can test, in the order of the contract.
            pub const ALL: &'static [Self] = &[$(Self::$name,)*];

            /// Name in manifests: words joined by `-`.
            pub fn key(self) -> &'static str {
                match self {
                    $(Self::$name => $key,)*
                }
            }

            /// What it is about.
            pub fn kind(self) -> ClauseKind {
                match self {
                    $(Self::$name => $kind,)*
                }
            }

            /// The clause in one sentence.
            pub fn sentence(self) -> &'static str {
                match self {
                    $(Self::$name => $sentence,)*
                }
            }

            /// The faults that break this clause and no other one.
            pub fn faults(self) -> &'static [Fault] {
                match self {
                    $(Self::$name => &[$(Fault::$fault,)+],)*
                }
            }
        }
    };
}

use ClauseKind::{Flux, Hits, Rays, Visibility};

clauses! {
    CellCentres: "cell-centres", Rays,
        "A ray runs through the centre of its cell: (i + 1/2, j + 1/2).", [HalfCellShift];
    RowsFromTheTop: "rows-from-the-top", Rays,
        "Row 0 is the top row, and rows count downwards.", [RowsBottomUp];
    ColumnsFromTheLeft: "columns-from-the-left", Rays,
        "Column 0 is at the left, and columns count from 0.", [ColumnsReversed, ColumnOffByOne];
    PixelPitches: "pixel-pitches", Rays,
        "The pixel pitch p_x is the one across, p_y the one down.", [PitchesSwapped];
    PrincipalPoint: "principal-point", Rays,
        "The principal point is a real number of pixels.", [PrincipalPointRounded];
    GridOfTheFan: "grid-of-the-fan", Rays,
        "The grid of a beam is w wide to either side, w = g tan(a), and T thick.",
        [GridOfWholeFan, FanAndThicknessSwapped];
    GridCells: "grid-cells", Rays,
        "The cells of a beam divide its grid evenly: x_i = w (2i + 1 - columns) / columns.",
        [GridToTheEdges, ColumnsCountedAsRows];
    FocalAxis: "focal-axis", Rays,
        "A pencil starts on the focal axis, at (0, y_j, 0), along (x_i, 0, g).", [PencilsFromCentre];
    PoseOfTheSensor: "pose-of-the-sensor", Rays,
        "A pose takes the sensor's frame to the scene's frame.", [CameraPoseConjugated];
    QuaternionOfAnyLength: "quaternion-of-any-length", Rays,
        "A rotation is (q p q*) / (q.q): a quaternion may have any length.", [QuaternionTakenAsUnit];
    FrontsOnly: "fronts-only", Hits,
        "A ray meets fronts only: n.q < 0.", [BackFacesHit, WindingOfOneQuadrant];
    NotBeforeThePlane: "not-before-the-plane", Hits,
        "A hit is at or beyond the sensor projection plane: t >= 1.", [HitsBeforePlane];
    OnThePlane: "on-the-plane", Hits,
        "A hit exactly on the sensor projection plane counts: t = 1.", [PlaneExcluded];
    FacesAcrossThePlane: "faces-across-the-plane", Hits,
        "Of a face that crosses the sensor projection plane the part beyond it is met.", [ClipCaseLost];
    MaximumRange: "maximum-range", Hits,
        "A hit beyond the maximum range is none.", [MaxRangeIgnored];
    MaximumRangeAlongTheRay: "maximum-range-along-the-ray", Hits,
        "The maximum range limits the distance along the ray, not the depth.", [MaxRangeLimitsDepth];
    MaximumRangeIncluded: "maximum-range-included", Hits,
        "A hit exactly at the maximum range counts: R = the maximum range.", [MaxRangeExcluded];
    Edges: "edges", Hits,
        "An edge belongs to its face: no ray passes between two faces that share one.",
        [EdgesExcluded, EdgesOpenOnOneSide];
    Vertices: "vertices", Hits,
        "A vertex belongs to its faces.", [VerticesExcluded];
    NothingBesideTheFace: "nothing-beside-the-face", Hits,
        "A ray beside a face misses it, however close.", [EdgesWidened];
    NoArea: "no-area", Hits,
        "A face without area is never hit.", [ZeroAreaHit];
    SmallFaces: "small-faces", Hits,
        "A small face is a face.", [SmallDeterminantsDropped];
    NearestFace: "nearest-face", Hits,
        "The nearest face is the one that is hit, whatever its place in the file.", [FirstInOrderWins, FarthestWins];
    Ties: "ties", Hits,
        "Of faces met at the same point one is reported, with its own values.", [TieOfTwoRecords, TiesCancel];
    RangeAlongTheRay: "range-along-the-ray", Hits,
        "The range is the distance along the ray from its origin, metres.", [DepthForRange, TForRange, RangeFromPlane];
    DepthAlongTheAxis: "depth-along-the-axis", Hits,
        "The depth is the distance along the normal axis.", [RangeForDepth];
    PointInTheScene: "point-in-the-scene", Hits,
        "The point is in the scene's frame.", [PointInSensorFrame];
    NormalOfTheFront: "normal-of-the-front", Hits,
        "The normal is a unit vector to the outside, in the scene's frame.",
        [NormalReversed, NormalNotNormalised, NormalInSensorFrame];
    IncidenceOfTheRay: "incidence-of-the-ray", Hits,
        "The incidence is the cosine between the normal and the reversed ray.", [IncidenceAgainstAxis];
    SeenFromTheFront: "seen-from-the-front", Visibility,
        "A pencil is visible only if the camera is before the front of its face: cos(theta) > 0.", [SeenFromBehind];
    BeforeTheCamera: "before-the-camera", Visibility,
        "A point behind the camera has no pixel.", [BehindCameraLands];
    OnTheImage: "on-the-image", Visibility,
        "A point beside the image has no pixel.", [OffImageClamped];
    PixelOfThePoint: "pixel-of-the-point", Visibility,
        "Pixel (i, j) is [i, i + 1) x [j, j + 1).", [PixelRounded, PixelTransposed];
    PixelOfHiddenPoints: "pixel-of-hidden-points", Visibility,
        "A point that is hidden has its pixel all the same.", [PixelOfVisibleOnly];
    BacksHide: "backs-hide", Visibility,
        "Any face on the way to the camera hides a point, its front or its back.", [ShadowsOfFronts];
    FacesAtThePoint: "faces-at-the-point", Visibility,
        "The face of the point, and the faces that tie with it, do not hide it.", [FacesAtPointHide];
    UpToThePoint: "up-to-the-point", Visibility,
        "A face beyond the point does not hide it.", [ShadowsFromBehind];
    UpToThePlane: "up-to-the-plane", Visibility,
        "A face between the projection centre and the sensor projection plane does not hide a point.",
        [OccludersBeforePlane];
    NoRangeOfTheCamera: "no-range-of-the-camera", Visibility,
        "The camera's maximum range does not limit what it sees of the pencils.", [CameraRangeLimits];
    HiddenIsDark: "hidden-is-dark", Flux(None),
        "A pencil that is not visible delivers nothing.", [HiddenLit];
    SumOfPencils: "sum-of-pencils", Flux(None),
        "A pixel receives the sum of its pencils.", [LastPencilWins];
    ModelOfTheScene: "model-of-the-scene", Flux(None),
        "The flux follows the scene's model.", [FluxOfOtherModel];
    ShareOfThePencil: "share-of-the-pencil", Flux(None),
        "The power of a pencil is its share of its own beam's profile.",
        [ProfileFlat, ProfileNotNormalised, StaleShares];
    Reflectivity: "reflectivity", Flux(None),
        "The reflectivity is that of the face's material.", [ReflectivityOfFirst];
    Transmission: "transmission", Flux(None),
        "The lens lets C_loss through.", [LensTransmissionOmitted];
    FilterOfTheAngle: "filter-of-the-angle", Flux(None),
        "The pass band of the filter moves with the angle.", [FilterAlongAxis];
    Aperture: "aperture", Flux(None),
        "D is the diameter of the aperture.", [ApertureAsRadius];
    ViewCosine: "view-cosine", Flux(None),
        "The flux falls with cos(theta), the angle to the camera.", [ViewCosineOmitted, IncidenceForViewCosine];
    CameraDepth: "camera-depth", Flux(None),
        "The flux falls with r squared, r the depth along the camera's axis.", [RangeForCameraDepth, DistanceForDepth];
    Attenuation: "attenuation", Flux(None),
        "The air attenuates light on its way to the ground and on its way to the camera.",
        [AttenuationOmitted, AttenuationOnce];
    OffAxisOfThePoint: "off-axis-of-the-point", Flux(Some(FluxModel::Radiometric)),
        "The radiometric flux has cos(phi) to the third power, phi the angle of the point.",
        [PhiOfPixelCentre, FourthPower];
    OffAxisOfThePixel: "off-axis-of-the-pixel", Flux(Some(FluxModel::Eq1)),
        "In equation (1) phi is the angle of the pixel's centre.", [PhiOfPoint];
    IncidenceInEquation1: "incidence-in-equation-1", Flux(Some(FluxModel::Eq1)),
        "Equation (1) has the factor cos(psi).", [IncidenceOmitted];
    RangeInEquation1: "range-in-equation-1", Flux(Some(FluxModel::Eq1)),
        "Equation (1) has the factor 1 / R.", [RangeOmitted];
    AreaInEquation1: "area-in-equation-1", Flux(Some(FluxModel::Eq1)),
        "Equation (1) has the factor A_cp, the area of a pixel.", [PixelAreaOmitted];
}
