//! Faults to plant in the naive renderer, each the likeness of one that real renderers had or could have.

use std::fmt;

/// What a fault gets wrong.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Kind {
    /// Rays, poses, which face is nearest, and the values of a hit.
    Geometry,
    /// What the SPP and the maximum range cut off.
    Clipping,
    /// Rays through edges, and faces met at one point.
    Ties,
    /// Whether the camera sees a pencil's hit, and where.
    Visibility,
    /// How much light arrives.
    Flux,
    /// What is written, not what is computed.
    Files,
}

impl Kind {
    /// All of them.
    pub const ALL: [Self; 6] =
        [Self::Geometry, Self::Clipping, Self::Ties, Self::Visibility, Self::Flux, Self::Files];
}

impl fmt::Display for Kind {
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

/// The faults, each with its kind and the real mistake that it imitates: one list for all that goes through them.
macro_rules! faults {
    ($($(#[$doc:meta])* $name:ident: $kind:ident, $imitates:literal;)*) => {
        /// A way to be wrong. Each changes one step, at the place that asks for it by name.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
        pub enum Fault {
            $($(#[$doc])* $name,)*
        }

        impl Fault {
            /// All of them.
            pub const ALL: &'static [Self] = &[$(Self::$name,)*];

            /// What it gets wrong.
            pub fn kind(self) -> Kind {
                match self {
                    $(Self::$name => Kind::$kind,)*
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
    /// Whether it is of light, not of what a ray meets.
    pub fn is_of_light(self) -> bool {
        matches!(self.kind(), Kind::Visibility | Kind::Flux)
    }
}

faults! {
    /// Cells are sampled at their upper left corner.
    HalfCellShift: Geometry, "the forgotten `+ 0.5` of a pixel loop";
    /// Column i is rendered as column i + 1.
    ColumnOffByOne: Geometry, "columns counted from 1, as in MATLAB and Fortran";
    /// Row 0 is at the bottom.
    RowsBottomUp: Geometry, "OpenGL's image order, or a y axis that points up";
    /// Pixel pitches exchanged, p_y across and p_x down.
    PitchesSwapped: Geometry, "width for height: unseen as long as pixels are square";
    /// The principal point is rounded to whole pixels.
    PrincipalPointRounded: Geometry, "an `int` in a calibration file";
    /// A beam's grid is as wide as the sheet is thick, and as thick as it should be wide.
    FanAndThicknessSwapped: Geometry, "two lengths of one type in the wrong order";
    /// x_i divides the grid by its rows, not by its columns.
    ColumnsCountedAsRows: Geometry, "one name for both counts";
    /// The grid's half width is g tan(fan), not g tan(fan / 2).
    GridOfWholeFan: Geometry, "a whole angle given for a half";
    /// Pencils start in the beam's centre and spread in both directions.
    PencilsFromCentre: Geometry, "a projector modelled as a camera turned round, without the cylindrical lens";
    /// The camera's quaternion is conjugated.
    CameraPoseConjugated: Geometry, "`scene_from_camera` taken for `camera_from_scene`, or a library of the other handedness";
    /// q p q* is not divided by q.q.
    QuaternionTakenAsUnit: Geometry, "a quaternion from a file taken for a unit";
    /// The scene origin is taken off vertices that are offsets from it already.
    OriginTakenOffTwice: Geometry, "one offset taken off by the loader and by the renderer";
    /// Vertices, seen from where the ray starts, are rounded once to `f32`.
    VerticesInSinglePrecision: Geometry, "a vertex buffer in single precision";
    /// Ray directions are rounded once to `f32`.
    DirectionsInSinglePrecision: Geometry, "the ray type of a tracing library in single precision";
    /// Fronts and backs are met alike.
    BackFacesKept: Geometry, "culling left off";
    /// In the lower right quadrant of the sensor backs are met and fronts are not.
    WindingOfOneQuadrant: Geometry, "a change of axes by the signs of the direction that forgets to exchange two in one case";
    /// Faces with exactly one vertex behind the SPP are left out.
    ClipCaseLost: Clipping, "the clip case that leaves a quadrilateral was never written";
    /// A ray exactly on an edge meets neither face.
    EdgesExcluded: Ties, "`u > 0` where it should be `u >= 0`";
    /// Two neighbours reckon their common edge each from a corner of its own, so that rounding opens a crack.
    EdgesReckonedApart: Ties, "the published test of Moeller and Trumbore as it stands";
    /// Faces are widened by a millionth of their size.
    EdgesWidened: Ties, "barycentric coordinates from `-EPSILON` on";
    /// Of faces met at one point the last is named, with the normal of the first.
    TieOfTwoRecords: Ties, "`<=` where the face is kept and `<` where its normal is";
    /// Two faces met at one point count as none.
    TiesCancel: Ties, "crossings counted by parity, as in tests of points in solids";
    /// Faces with |n.q| below 1e-6 count as parallel to the ray, so that small faces and short directions are lost.
    SmallDeterminantsDropped: Geometry, "the `EPSILON` of the published test of Moeller and Trumbore, which has a unit";
    /// Hits from t = 0 on count, before the SPP.
    HitsBeforePlane: Clipping, "a near plane left out";
    /// The maximum range limits the depth, not the range.
    MaxRangeLimitsDepth: Clipping, "a far plane for a range";
    /// The first face in the file that is hit wins.
    FirstInOrderWins: Geometry, "a search for any hit where the nearest was meant";
    /// The farthest face wins.
    FarthestWins: Geometry, "a comparison the wrong way round";
    /// The depth is reported as the range.
    DepthForRange: Geometry, "a z buffer read as distances";
    /// Ranges count from the SPP: t - 1 for t.
    RangeFromPlane: Geometry, "rays that start on the near plane";
    /// Normals are as long as twice the face's area.
    NormalNotNormalised: Geometry, "a cross product taken for a normal";
    /// Normals along the sensor's axes, not the scene's.
    NormalInSensorFrame: Geometry, "normals in view space, as shaders have them";
    /// The incidence is reckoned against the sensor's axis, not against the ray.
    IncidenceAgainstAxis: Geometry, "one direction of light for all rays: right for a distant sun";
    /// cos(psi) where cos(theta) should be.
    IncidenceForEmission: Flux, "the light's angle for the camera's";
    /// cos(theta) left out.
    EmissionForgotten: Flux, "a face taken to be as bright from every side";
    /// The air weakens light on its way to the ground only.
    AttenuationOnce: Flux, "one way of two";
    /// 1 / R^2 for 1 / r^2.
    RangeForCameraDepth: Flux, "the wrong one of two distances";
    /// Shares of power from the first beam's profile for all.
    StaleShares: Flux, "a table made for the first beam and kept";
    /// phi of the pixel's centre in the radiometric model too.
    PhiOfPixelCentre: Flux, "a table by pixel for what belongs to the point";
    /// cos^4(phi) where a pencil's flux has cos^3(phi).
    FourthPower: Flux, "the law of a lens's image taken for a point's";
    /// Four times as bright.
    ApertureAsRadius: Flux, "a diameter taken for a radius";
    /// The filter's pass band does not move with the angle.
    FilterAlongAxis: Flux, "a filter's data sheet, which is for light along the axis";
    /// A normalised profile is not divided by its sum.
    ProfileNotNormalised: Flux, "weights taken for shares";
    /// All ground has the reflectivity of the first material.
    ReflectivityOfFirst: Flux, "one material bound for the whole mesh";
    /// Faces within a millimetre of the point do not hide it.
    ShadowEpsilon: Visibility, "the epsilon of a shadow ray";
    /// Only fronts cast shadows.
    ShadowsOfFronts: Visibility, "culling left on for shadow rays";
    /// Shadow rays go on beyond the point.
    ShadowsFromBehind: Visibility, "a shadow ray without an end";
    /// Faces at the point itself hide it.
    DoublesHide: Visibility, "the shadow acne of ground that is doubled";
    /// What is hidden is lit all the same.
    HiddenLit: Visibility, "a flag that is computed and not asked";
    /// The camera's maximum range limits what it sees of the stripes.
    CameraRangeLimits: Visibility, "a limit of one map applied to another";
    /// A pixel's row for its column.
    PixelTransposed: Visibility, "`image[x][y]` for `image[y][x]`";
    /// A point lands in the pixel whose centre is nearest by coordinates that count from corners.
    PixelRounded: Visibility, "`round` where coordinates that count from corners want `floor`";
    /// A pixel keeps the flux of its last pencil.
    LastPencilWins: Flux, "`=` for `+=`";
}
