//! Faults to plant in the naive renderer, each the likeness of one that real renderers had or could have.

/// A way to be wrong. Each changes one step, at the place that asks for it by name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Fault {
    /// Cells are sampled at their upper left corner: the forgotten `+ 0.5` of a pixel loop.
    HalfCellShift,
    /// Column i is rendered as column i + 1: columns counted from 1, as in MATLAB and Fortran.
    ColumnOffByOne,
    /// Row 0 is at the bottom: OpenGL's image order, or a y axis that points up.
    RowsBottomUp,
    /// Pixel pitches exchanged, p_y across and p_x down: unseen as long as pixels are square.
    PitchesSwapped,
    /// The principal point is rounded to whole pixels: an `int` in a calibration file.
    PrincipalPointRounded,
    /// A beam's fan and thickness exchanged: the grid is as wide as the sheet is thick, and as thick as it
    /// should be wide.
    FanAndThicknessSwapped,
    /// x_i divides the grid by its rows, not by its columns: one name for both counts.
    ColumnsCountedAsRows,
    /// The grid's half width is g tan(fan), not g tan(fan / 2): a whole angle given for a half.
    GridOfWholeFan,
    /// Pencils start in the beam's centre and spread in both directions: a projector modelled as a camera
    /// turned round, without the cylindrical lens.
    PencilsFromCentre,
    /// The camera's quaternion is conjugated: `scene_from_camera` taken for `camera_from_scene`, or a
    /// library of the other handedness.
    CameraPoseConjugated,
    /// q p q* is not divided by q.q: a quaternion taken for a unit.
    QuaternionTakenAsUnit,
    /// The scene origin is taken off vertices that are offsets from it already.
    OriginTakenOffTwice,
    /// Vertices, seen from where the ray starts, are rounded once to `f32`: a vertex buffer.
    VerticesInSinglePrecision,
    /// Ray directions are rounded once to `f32`: the ray type of a tracing library.
    DirectionsInSinglePrecision,
    /// Fronts and backs are met alike: culling left off.
    BackFacesKept,
    /// In the lower right quadrant of the sensor backs are met and fronts are not: a change of axes by the
    /// signs of the direction that forgets to exchange two of them in one case.
    WindingOfOneQuadrant,
    /// Faces with exactly one vertex behind the SPP are left out: the clip case that leaves a quadrilateral
    /// was never written.
    ClipCaseLost,
    /// A ray exactly on an edge meets neither face: `u > 0` where it should be `u >= 0`.
    EdgesExcluded,
    /// The published test of Moeller and Trumbore as it stands: two neighbours reckon their common edge each
    /// from a corner of its own, so that rounding opens a crack between them.
    EdgesReckonedApart,
    /// Faces are widened by a millionth of their size: barycentric coordinates from `-EPSILON` on.
    EdgesWidened,
    /// Faces with |n.q| below 1e-6 count as parallel to the ray: the `EPSILON` of the published test of
    /// Moeller and Trumbore, which has a unit, so that small faces and short directions are lost.
    SmallDeterminantsDropped,
    /// Hits from t = 0 on count, before the SPP: a near plane left out.
    HitsBeforePlane,
    /// The maximum range limits the depth, not the range: a far plane.
    MaxRangeLimitsDepth,
    /// The first face in the file that is hit wins: a search for any hit where the nearest was meant.
    FirstInOrderWins,
    /// The farthest face wins: a comparison the wrong way round.
    FarthestWins,
    /// The depth is reported as the range: a z buffer.
    DepthForRange,
    /// Ranges count from the SPP: t - 1 for t.
    RangeFromPlane,
    /// Normals are as long as twice the face's area.
    NormalNotNormalised,
    /// Normals along the sensor's axes, not the scene's.
    NormalInSensorFrame,
    /// The incidence is reckoned against the sensor's axis, not against the ray: right for a distant sun.
    IncidenceAgainstAxis,
    /// cos(psi) where cos(theta) should be: the light's angle for the camera's.
    IncidenceForEmission,
    /// cos(theta) left out: a face as bright from every side.
    EmissionForgotten,
    /// The air weakens light on its way to the ground only.
    AttenuationOnce,
    /// 1 / R^2 for 1 / r^2: the wrong one of two distances.
    RangeForCameraDepth,
    /// Shares of power from a table that was made for the first beam.
    StaleShares,
    /// phi of the pixel's centre in the radiometric model too.
    PhiOfPixelCentre,
    /// cos^4(phi), the law of a lens's image, where a pencil's flux has cos^3(phi).
    FourthPower,
    /// The aperture taken for its radius: four times as bright.
    ApertureAsRadius,
    /// The filter's pass band does not move with the angle.
    FilterAlongAxis,
    /// A normalised profile is not divided by its sum.
    ProfileNotNormalised,
    /// All ground has the reflectivity of the first material.
    ReflectivityOfFirst,
    /// Faces within a millimetre of the point do not hide it: the epsilon of a shadow ray.
    ShadowEpsilon,
    /// Only fronts cast shadows: culling left on.
    ShadowsOfFronts,
    /// Shadow rays go on beyond the point.
    ShadowsFromBehind,
    /// Faces at the point itself hide it: the shadow acne of ground that is doubled.
    DoublesHide,
    /// What is hidden is lit all the same.
    HiddenLit,
    /// The camera's maximum range limits what it sees of the stripes.
    CameraRangeLimits,
    /// A pixel's row for its column.
    PixelTransposed,
    /// The nearest pixel centre by rounding coordinates that count from corners.
    PixelRounded,
    /// A pixel keeps the flux of its last pencil: `=` for `+=`.
    LastPencilWins,
}

impl Fault {
    /// Whether it is of light, not of what a ray meets.
    pub fn is_of_light(self) -> bool {
        self >= Self::IncidenceForEmission
    }

    /// All of them.
    pub const ALL: [Self; 50] = [
        Self::HalfCellShift,
        Self::ColumnOffByOne,
        Self::RowsBottomUp,
        Self::PitchesSwapped,
        Self::PrincipalPointRounded,
        Self::FanAndThicknessSwapped,
        Self::ColumnsCountedAsRows,
        Self::GridOfWholeFan,
        Self::PencilsFromCentre,
        Self::CameraPoseConjugated,
        Self::QuaternionTakenAsUnit,
        Self::OriginTakenOffTwice,
        Self::VerticesInSinglePrecision,
        Self::DirectionsInSinglePrecision,
        Self::BackFacesKept,
        Self::WindingOfOneQuadrant,
        Self::ClipCaseLost,
        Self::EdgesExcluded,
        Self::EdgesReckonedApart,
        Self::EdgesWidened,
        Self::SmallDeterminantsDropped,
        Self::HitsBeforePlane,
        Self::MaxRangeLimitsDepth,
        Self::FirstInOrderWins,
        Self::FarthestWins,
        Self::DepthForRange,
        Self::RangeFromPlane,
        Self::NormalNotNormalised,
        Self::NormalInSensorFrame,
        Self::IncidenceAgainstAxis,
        Self::IncidenceForEmission,
        Self::EmissionForgotten,
        Self::AttenuationOnce,
        Self::RangeForCameraDepth,
        Self::StaleShares,
        Self::PhiOfPixelCentre,
        Self::FourthPower,
        Self::ApertureAsRadius,
        Self::FilterAlongAxis,
        Self::ProfileNotNormalised,
        Self::ReflectivityOfFirst,
        Self::ShadowEpsilon,
        Self::ShadowsOfFronts,
        Self::ShadowsFromBehind,
        Self::DoublesHide,
        Self::HiddenLit,
        Self::CameraRangeLimits,
        Self::PixelTransposed,
        Self::PixelRounded,
        Self::LastPencilWins,
    ];
}
