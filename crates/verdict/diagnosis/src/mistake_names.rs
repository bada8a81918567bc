//! What programs call a mistake, and the page of the documentation that states the convention.

use crate::mistake::{AngleUnit, CutBy, Held, LengthUnit, Mistake, Turn};

const FILES: &str = "docs/formats/files.md";
const GUIDE: &str = "docs/guide/for-implementers.md";
const LIGHT: &str = "docs/theory/radiometry.md";
const REASONS: &str = "docs/guide/reasons.md";

impl Mistake {
    /// A name for programs.
    pub fn key(&self) -> &'static str {
        match self {
            Self::RowsReversed => "rows_reversed",
            Self::ColumnsReversed => "columns_reversed",
            Self::Transposed => "transposed",
            Self::Shifted { .. } => "shifted",
            Self::MissWritten(_) => "miss_written",
            Self::MissAtMaximumRange => "miss_at_maximum_range",
            Self::FacesShifted(_) => "faces_shifted",
            Self::FacesReordered => "faces_reordered",
            Self::DepthForRange => "depth_for_range",
            Self::ParameterForRange => "parameter_for_range",
            Self::RangeForDepth => "range_for_depth",
            Self::ParameterForDepth => "parameter_for_depth",
            Self::Unit(LengthUnit::Millimetres) => "millimetres",
            Self::Unit(LengthUnit::Centimetres) => "centimetres",
            Self::Unit(LengthUnit::Kilometres) => "kilometres",
            Self::Unit(LengthUnit::Feet) => "feet",
            Self::AxesYUp => "axes_y_up",
            Self::AxesYUpInverse => "axes_y_up_inverse",
            Self::Axes { .. } => "axes",
            Self::SensorFrame { .. } => "sensor_frame",
            Self::PointsRounded(_) => "points_rounded",
            Self::DistanceForView => "distance_for_view",
            Self::PointsFromSensor => "points_from_sensor",
            Self::PointsMoved(_) => "points_moved",
            Self::GlobalFrame => "global_frame",
            Self::Inverse(_) => "inverse",
            Self::Squared(_) => "squared",
            Self::ZBuffer { .. } => "z_buffer",
            Self::HoldsBeam(_) => "other_beam",
            Self::BeamFluxExchanged => "beam_flux_exchanged",
            Self::VisibleReversed => "visible_reversed",
            Self::NoShadowTest => "no_shadow_test",
            Self::HitsVisible => "hits_visible",
            Self::FluxOfWrongPencils => "flux_of_wrong_pencils",
            Self::NormalsReversed => "normals_reversed",
            Self::NormalsNotUnit => "normals_not_unit",
            Self::CosinesNegated => "cosines_negated",
            Self::AngleForCosine(AngleUnit::Radians) => "radians_for_cosine",
            Self::AngleForCosine(AngleUnit::Degrees) => "degrees_for_cosine",
            Self::CosinesExchanged(_) => "cosines_exchanged",
            Self::PixelRowsFromBottom => "pixel_rows_from_bottom",
            Self::PixelColumnsFromRight => "pixel_columns_from_right",
            Self::PixelsExchanged => "pixels_exchanged",
            Self::OtherFluxModel => "other_flux_model",
            Self::AttenuationOn(_) => "attenuation",
            Self::FluxFactor(_) => "flux_factor",
            Self::SinglePrecision => "single_precision",
            Self::BacksHit => "backs_hit",
            Self::NearPlaneIgnored => "near_plane_ignored",
            Self::MaximumRangeIgnored => "maximum_range_ignored",
            Self::MaximumRangeAsDepth => "maximum_range_as_depth",
            Self::NearLimit(_) => "near_limit",
            Self::EdgesOpen => "edges_open",
            Self::CornerRays { columns, rows } => {
                if columns.abs() == 0.5 && rows.abs() == 0.5 {
                    "corner_rays"
                } else {
                    "ray_offset"
                }
            }
            Self::Affine { factor: 1.0, .. } => "offset",
            Self::Affine { offset: 0.0, .. } => "factor",
            Self::Affine { .. } => "factor_and_offset",
            Self::FromPlane(_) => "from_plane",
            Self::Rounded { .. } => "rounded",
            Self::HalfPrecision(_) => "half_precision",
            Self::Cut { by: CutBy::Row | CutBy::Column, held: Held::Neighbour, .. } => "line_doubled",
            Self::Cut { by: CutBy::Row | CutBy::Column, held: Held::Anything, .. } => "lines_wrong",
            Self::Cut { by: CutBy::Row | CutBy::Column, .. } => "lines_lost",
            Self::Cut { .. } => "cut_off",
            Self::PrincipalPoint { .. } => "principal_point",
            Self::FocalLength { .. } => "focal_length",
            Self::PixelPitch { .. } => "pixel_pitch",
            Self::Thickness { .. } => "thickness",
            Self::PoseInverted => "pose_inverted",
            Self::QuaternionOrder => "quaternion_order",
            Self::Fan { .. } => "fan",
            Self::Turned { about: Turn::Pitch, .. } => "pitch",
            Self::Turned { about: Turn::Yaw, .. } => "yaw",
            Self::Turned { about: Turn::Roll, .. } => "roll",
            Self::Moved(_) => "position",
            Self::Posed { .. } => "pose",
        }
    }

    /// The place of the documentation that states the convention: a file, and a word that its text or heading has.
    pub fn docs(&self) -> (&'static str, &'static str) {
        match self {
            Self::RowsReversed | Self::ColumnsReversed | Self::Transposed | Self::Shifted { .. } => {
                (FILES, "Orientation")
            }
            Self::MissWritten(_) | Self::MissAtMaximumRange => (FILES, "No hit"),
            Self::FacesShifted(_) | Self::FacesReordered => (FILES, "FaceId"),
            Self::AxesYUp | Self::AxesYUpInverse | Self::Axes { .. } => (FILES, "Axes"),
            Self::DepthForRange
            | Self::ParameterForRange
            | Self::RangeForDepth
            | Self::ParameterForDepth
            | Self::Unit(_)
            | Self::SensorFrame { .. }
            | Self::PointsRounded(_)
            | Self::DistanceForView
            | Self::PointsFromSensor
            | Self::PointsMoved(_)
            | Self::GlobalFrame
            | Self::NormalsReversed
            | Self::NormalsNotUnit
            | Self::CosinesNegated
            | Self::AngleForCosine(_)
            | Self::CosinesExchanged(_)
            | Self::PixelRowsFromBottom
            | Self::PixelColumnsFromRight
            | Self::PixelsExchanged
            | Self::HoldsBeam(_)
            | Self::BeamFluxExchanged
            | Self::VisibleReversed => (FILES, "Maps: OpenEXR"),
            Self::NoShadowTest | Self::HitsVisible | Self::FluxOfWrongPencils => {
                (LIGHT, "Pixel and visibility")
            }
            Self::OtherFluxModel | Self::AttenuationOn(_) | Self::FluxFactor(_) => (LIGHT, "radiometric"),
            Self::SinglePrecision => (GUIDE, "raypencil check"),
            Self::BacksHit | Self::NearPlaneIgnored | Self::MaximumRangeIgnored => {
                (GUIDE, "The contract for rays")
            }
            Self::MaximumRangeAsDepth | Self::NearLimit(_) | Self::EdgesOpen => {
                (GUIDE, "The contract for rays")
            }
            Self::CornerRays { .. } => (FILES, "Cells"),
            Self::Affine { .. }
            | Self::FromPlane(_)
            | Self::Rounded { .. }
            | Self::HalfPrecision(_)
            | Self::Inverse(_)
            | Self::Squared(_)
            | Self::ZBuffer { .. } => (REASONS, "Lengths"),
            Self::Cut { .. } => (REASONS, "Cuts and borders"),
            Self::PrincipalPoint { .. }
            | Self::FocalLength { .. }
            | Self::PixelPitch { .. }
            | Self::Thickness { .. }
            | Self::PoseInverted
            | Self::QuaternionOrder
            | Self::Fan { .. }
            | Self::Turned { .. }
            | Self::Moved(_)
            | Self::Posed { .. } => (REASONS, "Numbers of a sensor"),
        }
    }
}
