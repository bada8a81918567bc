//! The mistakes that are looked for, with their numbers.

/// A unit of length that is not the metre.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LengthUnit {
    /// Millimetres.
    Millimetres,
    /// Centimetres.
    Centimetres,
    /// Kilometres.
    Kilometres,
    /// International feet: 0.3048 m.
    Feet,
}

impl LengthUnit {
    /// Metres of one unit, as a quotient: it is the nearest number to the exact one after a multiplication.
    pub fn to_metres(self, value: f64) -> f64 {
        match self {
            Self::Millimetres => value / 1e3,
            Self::Centimetres => value / 1e2,
            Self::Kilometres => value * 1e3,
            Self::Feet => value * 0.3048,
        }
    }
}

/// A unit of angle.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AngleUnit {
    /// Radians.
    Radians,
    /// Degrees.
    Degrees,
}

impl AngleUnit {
    /// The cosine of an angle in this unit.
    pub(crate) fn cosine(self, angle: f64) -> f64 {
        match self {
            Self::Radians => libm::cos(angle),
            Self::Degrees => libm::cos(angle.to_radians()),
        }
    }
}

/// The three cosines of a recording.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Cosine {
    /// cos(psi), of incidence: `incidence.V`.
    Incidence,
    /// cos(phi), off the camera's axis: `offAxis.V`.
    OffAxis,
    /// cos(theta), of emission to the camera: `emission.V`.
    Emission,
}

impl Cosine {
    pub(crate) const ALL: [Self; 3] = [Self::Incidence, Self::OffAxis, Self::Emission];

    pub(crate) fn channel(self) -> &'static str {
        match self {
            Self::Incidence => "incidence.V",
            Self::OffAxis => "offAxis.V",
            Self::Emission => "emission.V",
        }
    }

    pub(crate) fn angle(self) -> &'static str {
        match self {
            Self::Incidence => "cos(psi)",
            Self::OffAxis => "cos(phi)",
            Self::Emission => "cos(theta)",
        }
    }
}

/// The part of the light's way on which the air attenuates it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Leg {
    /// From the beam to the ground.
    Out,
    /// From the ground to the camera.
    Back,
    /// No part.
    Neither,
}

/// Lengths of a hit that a mistake may change.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Length {
    /// `range.T`.
    Range,
    /// `depth.Z`.
    Depth,
    /// Every length that the recording has, and points where a factor changes them too.
    All,
}

/// Vectors of a hit that a mistake may change.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Vectors {
    /// Hit points alone.
    Points,
    /// Normals alone.
    Normals,
    /// Both.
    Both,
}

/// Axes of a sensor's frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FrameAxes {
    /// z ahead, x to the right, y down: the contract's.
    Optical,
    /// -z ahead, x to the right, y up: OpenGL's.
    OpenGl,
    /// x ahead, y to the left, z up: a vehicle's.
    Body,
}

impl FrameAxes {
    pub(crate) const ALL: [Self; 3] = [Self::Optical, Self::OpenGl, Self::Body];

    /// A vector in these axes, in the contract's.
    pub(crate) fn to_optical(self, [x, y, z]: [f64; 3]) -> [f64; 3] {
        match self {
            Self::Optical => [x, y, z],
            Self::OpenGl => [x, -y, -z],
            Self::Body => [-y, -z, x],
        }
    }
}

/// What a recording is cut by: the number of a ray that decides whether its answer is lost.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CutBy {
    /// The true range, metres.
    Range,
    /// The true depth, metres.
    Depth,
    /// The true range, metres; a depth tells the lost rays from the others as well.
    RangeOrDepth,
    /// The row of the cell.
    Row,
    /// The column of the cell.
    Column,
}

/// What stands in place of the answers beyond a cut.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Held {
    /// "No hit".
    NoHit,
    /// One number.
    Constant(f64),
    /// The answer of the cell beside the cut: a line is there twice.
    Neighbour,
    /// Something else: all that is known is that these lines are wrong, and no other.
    Anything,
}

/// An axis about which a sensor is turned.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Turn {
    /// Up and down: positive looks further down.
    Pitch,
    /// Left and right: positive looks further to the right.
    Yaw,
    /// About the normal axis: positive is clockwise, as the sensor sees it.
    Roll,
}

/// A convention that a recording may have broken, or a number of a sensor that it may have had otherwise.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Mistake {
    /// The bottom row is stored first.
    RowsReversed,
    /// The right column is stored first.
    ColumnsReversed,
    /// The cells are stored column by column.
    Transposed,
    /// Each cell holds the ray of a neighbour.
    Shifted {
        /// The cell (i, j) holds the ray of column `i - columns`.
        columns: i32,
        /// The cell (i, j) holds the ray of row `j - rows`.
        rows: i32,
    },
    /// A constant stands where nothing is hit.
    MissWritten(f64),
    /// The maximum range stands where nothing is hit.
    MissAtMaximumRange,
    /// Face indices are larger than `FaceId` by this number.
    FacesShifted(i32),
    /// Faces are numbered in an order of their own.
    FacesReordered,
    /// `range.T` holds the depth.
    DepthForRange,
    /// `range.T` holds t, the parameter of the ray.
    ParameterForRange,
    /// `depth.Z` holds the range.
    RangeForDepth,
    /// `depth.Z` holds t, the parameter of the ray.
    ParameterForDepth,
    /// Lengths are in another unit.
    Unit(LengthUnit),
    /// Points and normals are in glTF's axes: (x, z, -y) of the scene's (x, y, z).
    AxesYUp,
    /// Points and normals had the change of glTF's axes once too often or in the wrong direction: (x, -z, y).
    AxesYUpInverse,
    /// Points and normals are in other axes. Component k of the scene is `sign` times component `from` of the
    /// recording.
    Axes {
        /// Of which vectors.
        of: Vectors,
        /// Component of the recording, for x, y and z.
        from: [usize; 3],
        /// 1 or -1, for x, y and z.
        sign: [i8; 3],
    },
    /// Points or normals are in the sensor's frame.
    SensorFrame {
        /// Which vectors.
        of: Vectors,
        /// The axes of that frame.
        axes: FrameAxes,
    },
    /// The components of points are rounded to multiples of a quantum, metres.
    PointsRounded(f64),
    /// `view.Z` is the distance from the camera to the hit.
    DistanceForView,
    /// Points are counted from the sensor, in the axes of the scene.
    PointsFromSensor,
    /// Points are off by one vector, metres, in the axes of the scene.
    PointsMoved([f64; 3]),
    /// Points are in the global frame: the scene origin is added.
    GlobalFrame,
    /// A length is one over the true one.
    Inverse(Length),
    /// A length is the square of the true one.
    Squared(Length),
    /// `depth.Z` is what a z-buffer holds, which is linear in the reciprocal of the depth; that of what is infinite is 0.
    ZBuffer {
        /// The number at one end: 0, or -1 as OpenGL has it.
        low: f64,
        /// The depth there, metres.
        low_at: f64,
        /// The depth at which it is 1, metres.
        one_at: f64,
    },
    /// A beam's cells hold what is true of the beam with this index.
    HoldsBeam(usize),
    /// `flux.beam0` and `flux.beam1` are exchanged.
    BeamFluxExchanged,
    /// `visible.V` is 1 where it should be 0.
    VisibleReversed,
    /// No face hides a hit from the camera.
    NoShadowTest,
    /// Every hit is called visible.
    HitsVisible,
    /// The camera's flux is the sum of what the pencils of the recording state, and these are wrong.
    FluxOfWrongPencils,
    /// Normals point inward.
    NormalsReversed,
    /// Normals are not unit vectors.
    NormalsNotUnit,
    /// Cosines are negative where they should be positive.
    CosinesNegated,
    /// Angles stand in place of their cosines.
    AngleForCosine(AngleUnit),
    /// The cosine of the first holds that of the second, and so on: `incidence.V`, `offAxis.V`, `emission.V`.
    CosinesExchanged([Cosine; 3]),
    /// `pixel.J` counts rows from the bottom.
    PixelRowsFromBottom,
    /// `pixel.I` counts columns from the right.
    PixelColumnsFromRight,
    /// `pixel.I` holds the row and `pixel.J` the column.
    PixelsExchanged,
    /// The flux is that of the other model.
    OtherFluxModel,
    /// The air attenuates light on this part of its way alone.
    AttenuationOn(Leg),
    /// The flux is this number times the true one.
    FluxFactor(f64),
    /// The arithmetic is of single precision and was not declared.
    SinglePrecision,
    /// Rays hit the backs of faces.
    BacksHit,
    /// Rays hit faces before the sensor projection plane (t < 1).
    NearPlaneIgnored,
    /// Rays hit faces beyond the maximum range.
    MaximumRangeIgnored,
    /// The maximum range limits the depth.
    MaximumRangeAsDepth,
    /// A hit needs t of at least this number, which is more than 1.
    NearLimit(f64),
    /// A ray that meets an edge of a face exactly passes it.
    EdgesOpen,
    /// Rays go through another point of their cell, as through its corner. In cells from the middle: -1/2 is left or
    /// above.
    CornerRays {
        /// Columns from the middle of the cell.
        columns: f64,
        /// Rows from the middle of the cell.
        rows: f64,
    },
    /// A length is `factor` times the true one plus `offset` metres.
    Affine {
        /// Which length.
        of: Length,
        /// The factor.
        factor: f64,
        /// The number that is added, metres.
        offset: f64,
    },
    /// A length is counted from the sensor's plane, t = 1.
    FromPlane(Length),
    /// A length is rounded to multiples of a quantum.
    Rounded {
        /// Which length.
        of: Length,
        /// The quantum, metres.
        quantum: f64,
        /// Whether it is rounded down; else to the nearest multiple.
        down: bool,
    },
    /// A length went through half precision: 11 significant bits.
    HalfPrecision(Length),
    /// Answers beyond a number are lost.
    Cut {
        /// By what.
        by: CutBy,
        /// Whether those above the number are lost; else those below.
        is_above: bool,
        /// The number: metres, or the first or last line that is lost.
        at: f64,
        /// Number of lines that are lost; 0 if it is not cut by lines.
        lines: u32,
        /// What stands in their place.
        held: Held,
    },
    /// The camera's principal point is another one.
    PrincipalPoint {
        /// The one of the recording's rays, pixels.
        stated: [f64; 2],
        /// The scene's.
        truth: [f64; 2],
    },
    /// The camera's focal length is another one.
    FocalLength {
        /// The one of the recording's rays, metres.
        stated: f64,
        /// The scene's.
        truth: f64,
    },
    /// The camera's pixels have another pitch.
    PixelPitch {
        /// The one of the recording's rays, across and down, metres.
        stated: [f64; 2],
        /// The scene's.
        truth: [f64; 2],
    },
    /// The beam has another thickness: its rows start at other places.
    Thickness {
        /// The one of the recording's rays, metres.
        stated: f64,
        /// The scene's.
        truth: f64,
    },
    /// The sensor's pose is used the wrong way round: as that of the scene in the sensor's frame.
    PoseInverted,
    /// The four numbers of the sensor's rotation are read in the order w, x, y, z.
    QuaternionOrder,
    /// The beam's fan has another angle.
    Fan {
        /// The one of the recording's rays, degrees.
        stated: f64,
        /// The scene's.
        truth: f64,
    },
    /// The sensor is turned.
    Turned {
        /// About which of its axes.
        about: Turn,
        /// By how much too far, degrees.
        degrees: f64,
    },
    /// The sensor stands elsewhere: this vector of the scene frame too far, metres.
    Moved([f64; 3]),
    /// The sensor has another pose.
    Posed {
        /// Turns about its x, y and z axes (right, down, forward), as one rotation vector, degrees.
        degrees: [f64; 3],
        /// This vector of the scene frame too far, metres.
        metres: [f64; 3],
    },
}
