//! Faults of the naive renderer. Each imitates a mistake that real renderers made or could make.

use std::fmt;

/// The part of a result that a fault changes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum FaultKind {
    /// Rays, poses, the choice of the nearest face, and the values of a hit.
    Geometry,
    /// Clipping by the SPP and by the maximum range.
    Clipping,
    /// Rays through edges, and faces that a ray meets at the same point.
    Ties,
    /// Visibility of a pencil's hit, and the pixel that it lands in.
    Visibility,
    /// The amount of light that arrives.
    Flux,
    /// Writing, not computing.
    Files,
}

impl FaultKind {
    /// All kinds.
    pub const ALL: [Self; 6] =
        [Self::Geometry, Self::Clipping, Self::Ties, Self::Visibility, Self::Flux, Self::Files];
}

impl fmt::Display for FaultKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Geometry => "geometry",
            Self::Clipping => "clipping",
            Self::Ties => "edges and ties",
            Self::Visibility => "visibility",
            Self::Flux => "flux",
            Self::Files => "files",
        })
    }
}

/// Defines the faults in one list: each with its kind and the real mistake that it imitates.
macro_rules! faults {
    ($($(#[$doc:meta])* $name:ident: $kind:ident, $imitates:literal;)*) => {
        /// An error of the naive renderer. Each changes one step of it.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
        pub enum Fault {
            $($(#[$doc])* $name,)*
        }

        impl Fault {
            /// All faults.
            pub const ALL: &'static [Self] = &[$(Self::$name,)*];

            /// The part of a result that it changes.
            pub fn kind(self) -> FaultKind {
                match self {
                    $(Self::$name => FaultKind::$kind,)*
                }
            }

            /// The real mistake that it imitates.
            pub fn imitates(self) -> &'static str {
                match self {
                    $(Self::$name => $imitates,)*
                }
            }
        }
    };
}

impl Fault {
    /// Whether it concerns light, not the hits of rays.
    pub fn is_of_light(self) -> bool {
        matches!(self.kind(), FaultKind::Visibility | FaultKind::Flux)
    }
}

faults! {
    /// Cells are sampled at their upper left corner.
    HalfCellShift: Geometry, "a forgotten `+ 0.5` in a pixel loop";
    /// Column i is rendered as column i + 1.
    ColumnOffByOne: Geometry, "columns counted from 1, as in MATLAB and Fortran";
    /// Row 0 is at the bottom.
    RowsBottomUp: Geometry, "OpenGL's image order, or a y axis that points up";
    /// Column 0 is at the right.
    ColumnsReversed: Geometry, "a mirrored image, or an x axis that points to the left";
    /// The outermost pencils run along the edges of the sheet.
    GridToTheEdges: Geometry, "`linspace` with both ends in place of cell centres";
    /// Pixel pitches exchanged, p_y across and p_x down.
    PitchesSwapped: Geometry, "width in place of height: invisible while pixels are square";
    /// The principal point is rounded to whole pixels.
    PrincipalPointRounded: Geometry, "an `int` in a calibration file";
    /// A beam's grid is as wide as the sheet is thick, and as thick as it should be wide.
    FanAndThicknessSwapped: Geometry, "two arguments of the same type in the wrong order";
    /// x_i divides the grid by its rows, not by its columns.
    ColumnsCountedAsRows: Geometry, "one variable for both counts";
    /// The grid's half width is g tan(fan), not g tan(fan / 2).
    GridOfWholeFan: Geometry, "a full angle in place of a half";
    /// Pencils start in the beam's centre and spread in both directions.
    PencilsFromCentre: Geometry, "a projector modelled as an inverse camera, without the cylindrical lens";
    /// The camera's quaternion is conjugated.
    CameraPoseConjugated: Geometry, "`scene_from_camera` in place of `camera_from_scene`, or a library of the other handedness";
    /// q p q* is not divided by q.q.
    QuaternionTakenAsUnit: Geometry, "a quaternion from a file, assumed to be a unit";
    /// The scene origin is subtracted from vertices that are offsets from it already.
    OriginTakenOffTwice: Geometry, "one offset subtracted by the loader and by the renderer";
    /// Vertices relative to the origin of the ray are rounded once to `f32`.
    VerticesInSinglePrecision: Geometry, "a vertex buffer in single precision";
    /// Ray directions are rounded once to `f32`.
    DirectionsInSinglePrecision: Geometry, "the ray type of a tracing library in single precision";
    /// Rays meet backs as well as fronts.
    BackFacesHit: Geometry, "back-face culling switched off";
    /// In the lower right quadrant of the sensor, rays meet backs and not fronts.
    WindingOfOneQuadrant: Geometry, "a permutation of axes by the signs of the direction, with one exchange forgotten";
    /// Faces with exactly one vertex behind the SPP are left out.
    ClipCaseLost: Clipping, "the clip case that leaves a quadrilateral was never written";
    /// A ray exactly on an edge meets neither face.
    EdgesExcluded: Ties, "`u > 0` where it should be `u >= 0`";
    /// Two neighbours compute their common edge from different corners, so that rounding opens a crack.
    EdgesComputedApart: Ties, "the published test of Moeller and Trumbore, unchanged";
    /// Faces are enlarged by a millionth of their size.
    EdgesWidened: Ties, "barycentric coordinates accepted from `-EPSILON`";
    /// Among faces met at the same point the last is reported, with the normal of the first.
    TieOfTwoRecords: Ties, "`<=` in the update of the face and `<` in that of its normal";
    /// Two faces met at the same point cancel.
    TiesCancel: Ties, "the parity rule of point-in-solid tests";
    /// Faces with |n.q| below 1e-6 count as parallel to the ray, so that small faces and short directions are lost.
    SmallDeterminantsDropped: Geometry, "the `EPSILON` of the published test of Moeller and Trumbore, which has a unit";
    /// A ray through two edges of a face at once, that is through a vertex, misses the face.
    VerticesExcluded: Ties, "a crossing count that skips vertices";
    /// Of the edges of a face only the one from its first corner to its second belongs to it.
    EdgesOpenOnOneSide: Ties, "`u >= 0` beside `v > 0` and `u + v < 1`";
    /// Faces without area are met as lines.
    ZeroAreaHit: Ties, "a determinant of zero that no test excludes";
    /// Hits at t = 1, on the SPP, do not count.
    PlaneExcluded: Clipping, "`t > t_min` where it should be `t >= t_min`";
    /// A hit exactly at the maximum range does not count.
    MaxRangeExcluded: Clipping, "`t < t_max` where it should be `t <= t_max`";
    /// Hits beyond the maximum range count.
    MaxRangeIgnored: Clipping, "a limit that is read from the file and never used";
    /// Hits from t = 0 on count, before the SPP.
    HitsBeforePlane: Clipping, "a near plane that is not applied";
    /// The maximum range limits the depth, not the range.
    MaxRangeLimitsDepth: Clipping, "a far plane in place of a maximum range";
    /// The first face in the file that is hit wins.
    FirstInOrderWins: Geometry, "an any-hit query in place of a closest-hit query";
    /// The farthest face wins.
    FarthestWins: Geometry, "a reversed comparison";
    /// The depth is reported as the range.
    DepthForRange: Geometry, "a z buffer read as distances";
    /// Ranges are measured from the SPP: t - 1 in place of t.
    RangeFromPlane: Geometry, "rays that start on the near plane";
    /// t is reported as the range.
    TForRange: Geometry, "the parameter of a ray whose direction is not a unit";
    /// The range is reported as the depth.
    RangeForDepth: Geometry, "distances written into a z buffer";
    /// Points are in the sensor frame, not in the scene frame.
    PointInSensorFrame: Geometry, "points in view space, as a depth camera gives them";
    /// Normals point into the ground.
    NormalReversed: Geometry, "clockwise corners taken for the front";
    /// Normals are as long as twice the face's area.
    NormalNotNormalised: Geometry, "a cross product used as a normal";
    /// Normals are in the sensor frame, not in the scene frame.
    NormalInSensorFrame: Geometry, "normals in view space, as shaders have them";
    /// The incidence is measured against the sensor's axis, not against the ray.
    IncidenceAgainstAxis: Geometry, "one direction of light for all rays, as for a distant sun";
    /// The flux is that of the other model.
    FluxOfOtherModel: Flux, "equation (1) in place of the radiometric model, or the reverse";
    /// The lens takes no light away.
    LensTransmissionOmitted: Flux, "a loss that is left out";
    /// The air takes no light away.
    AttenuationOmitted: Flux, "air that is left out";
    /// cos(alpha) is left out of the paper's share; the angular profiles are constant.
    ProfileFlat: Flux, "the same power in every pencil";
    /// 1 / d^2 in place of 1 / r^2.
    DistanceForDepth: Flux, "the length of a line in place of its part along the axis";
    /// Equation (1) without cos(psi).
    IncidenceOmitted: Flux, "a factor of the irradiance that is left out";
    /// Equation (1) without 1 / R.
    RangeOmitted: Flux, "a sheet of light that does not fan out";
    /// Equation (1) with phi of the point in place of the pixel's centre.
    PhiOfPoint: Flux, "the angle of the point in place of the pixel's";
    /// Equation (1) without the area of a pixel.
    PixelAreaOmitted: Flux, "an irradiance in place of a flux";
    /// cos(psi) in place of cos(theta).
    IncidenceForViewCosine: Flux, "the angle of incidence in place of the viewing angle";
    /// cos(theta) is left out.
    ViewCosineOmitted: Flux, "a face that is equally bright from every side";
    /// The air attenuates light on its way to the ground only.
    AttenuationOnce: Flux, "one of two paths";
    /// 1 / R^2 in place of 1 / r^2.
    RangeForCameraDepth: Flux, "the wrong one of two distances";
    /// All beams use the shares of power of the first.
    StaleShares: Flux, "a table cached for the first beam";
    /// phi of the pixel's centre, in the radiometric model too.
    PhiOfPixelCentre: Flux, "a table for each pixel of a quantity of the point";
    /// cos^4(phi) in place of cos^3(phi) in a pencil's flux.
    FourthPower: Flux, "the law of image irradiance applied to a point";
    /// Flux four times too large.
    ApertureAsRadius: Flux, "a diameter used as a radius";
    /// The filter's pass band does not move with the angle.
    FilterAlongAxis: Flux, "the data sheet of a filter, which holds along the axis";
    /// A normalised profile is not divided by its sum.
    ProfileNotNormalised: Flux, "weights used as shares";
    /// All ground has the reflectivity of the first material.
    ReflectivityOfFirst: Flux, "one material for the whole mesh";
    /// The backs of faces are seen too: cos(theta) may be negative.
    SeenFromBehind: Visibility, "the absolute value of a cosine";
    /// Points behind the camera are projected like those before it.
    BehindCameraLands: Visibility, "a division by a depth whose sign is not tested";
    /// Faces between the projection centre and the SPP hide points.
    OccludersBeforePlane: Visibility, "a shadow ray that goes on to the pinhole";
    /// Only visible points have a pixel.
    PixelOfVisibleOnly: Visibility, "the projection skipped for hidden points";
    /// Points beside the image land in the pixels of its border.
    OffImageClamped: Visibility, "coordinates clamped to the image";
    /// Faces within a millimetre of the point do not hide it.
    ShadowEpsilon: Visibility, "the epsilon of a shadow ray";
    /// Only front faces cast shadows.
    ShadowsOfFronts: Visibility, "back-face culling left on for shadow rays";
    /// Shadow rays continue beyond the point.
    ShadowsFromBehind: Visibility, "a shadow ray without a maximum distance";
    /// Faces through the point hide it.
    FacesAtPointHide: Visibility, "shadow acne on doubled faces";
    /// Hidden points deliver light too.
    HiddenLit: Visibility, "a flag that is computed and never read";
    /// The camera's maximum range limits the visibility of stripes.
    CameraRangeLimits: Visibility, "a limit of one map applied to another";
    /// Row and column of a pixel are exchanged.
    PixelTransposed: Visibility, "`image[x][y]` in place of `image[y][x]`";
    /// A coordinate that counts from pixel corners is rounded to the nearest integer.
    PixelRounded: Visibility, "`round` in place of `floor`";
    /// A pixel holds the flux of its last pencil only.
    LastPencilWins: Flux, "`=` in place of `+=`";
}
