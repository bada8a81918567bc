//! A warning: what looks wrong in a scene or a run, with a code for programs.

use std::fmt;

use raypencil_scene::SensorId;
use serde::{Serialize, Serializer};

/// Code of a warning. Its word stays the same from version to version; the sentence may change.
///
/// ```
/// use raypencil_survey::WarningCode;
///
/// assert_eq!(WarningCode::NoHits.word(), "no_hits");
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum WarningCode {
    /// No ray of a sensor meets the terrain.
    NoHits,
    /// Few rays of a sensor meet the terrain.
    FewHits,
    /// Most rays of a sensor that meet the terrain meet the back of a face first.
    BacksFirst,
    /// The terrain stands upright, like a ground whose file has z up where y up is expected.
    TerrainOnItsSide,
    /// The terrain is coarse and kilometres wide, like one in millimetres.
    TerrainTooLarge,
    /// The vehicle is above the ground below it.
    VehicleAboveGround,
    /// The vehicle is below the ground at its place.
    VehicleBelowGround,
    /// The camera's principal point is outside its image.
    PrincipalPointOutside,
    /// The camera's principal point is far from the middle of its image.
    PrincipalPointOffCentre,
    /// A drive's beam has so few pencils that its stripe has gaps.
    StripeHasGaps,
    /// A drive's default threshold does not account for the light or the electronics.
    BlindThreshold,
    /// A drive's beams are lit together and not ordered from steep to flat.
    BeamsOutOfOrder,
    /// Sectors or radii of a drive's obstacle maps are so far apart that ground between them is not tested.
    SectorsFarApart,
    /// The points of a drive's map are so far apart that a wheel may stand between them.
    MapCoarserThanWheel,
    /// A scene's vehicle leans otherwise than that of its drive, which stands on its wheels.
    VehicleLeansOtherwise,
    /// A drive has measured no point of the ground.
    NothingMeasured,
    /// Edges of stripes were given for images that the drive did not take.
    StripesLeftOver,
    /// A drive starts where the vehicle stands steeper than it may.
    StartTooSteep,
    /// On its way the vehicle stands steeper than its own obstacle tests allow.
    WayTooSteep,
    /// Polygons of the terrain's file cross themselves.
    PolygonsCross,
    /// Polygons of the terrain's file are not planar.
    PolygonsNotPlanar,
    /// Heights of an elevation model stand out by more than the rest of it is high.
    PostsStandOut,
    /// Posts of an elevation model lie nearer to each other than any survey has them: degrees that are taken as metres.
    PostsTooDense,
    /// Crossings are asked for of a mesh that is not closed.
    OpenMesh,
    /// Rays would hit if their coordinates of the map were moved into the frame of the scene.
    RaysInMap,
}

impl WarningCode {
    /// All codes.
    pub const ALL: [Self; 25] = [
        Self::NoHits,
        Self::FewHits,
        Self::BacksFirst,
        Self::TerrainOnItsSide,
        Self::TerrainTooLarge,
        Self::VehicleAboveGround,
        Self::VehicleBelowGround,
        Self::PrincipalPointOutside,
        Self::PrincipalPointOffCentre,
        Self::StripeHasGaps,
        Self::BlindThreshold,
        Self::BeamsOutOfOrder,
        Self::SectorsFarApart,
        Self::MapCoarserThanWheel,
        Self::VehicleLeansOtherwise,
        Self::NothingMeasured,
        Self::StripesLeftOver,
        Self::StartTooSteep,
        Self::WayTooSteep,
        Self::PolygonsCross,
        Self::PolygonsNotPlanar,
        Self::PostsStandOut,
        Self::PostsTooDense,
        Self::OpenMesh,
        Self::RaysInMap,
    ];

    /// The code as files have it.
    pub fn word(self) -> &'static str {
        match self {
            Self::NoHits => "no_hits",
            Self::FewHits => "few_hits",
            Self::BacksFirst => "backs_first",
            Self::TerrainOnItsSide => "terrain_on_its_side",
            Self::TerrainTooLarge => "terrain_too_large",
            Self::VehicleAboveGround => "vehicle_above_ground",
            Self::VehicleBelowGround => "vehicle_below_ground",
            Self::PrincipalPointOutside => "principal_point_outside",
            Self::PrincipalPointOffCentre => "principal_point_off_centre",
            Self::StripeHasGaps => "stripe_has_gaps",
            Self::BlindThreshold => "blind_threshold",
            Self::BeamsOutOfOrder => "beams_out_of_order",
            Self::SectorsFarApart => "sectors_far_apart",
            Self::MapCoarserThanWheel => "map_coarser_than_wheel",
            Self::VehicleLeansOtherwise => "vehicle_leans_otherwise",
            Self::NothingMeasured => "nothing_measured",
            Self::StripesLeftOver => "stripes_left_over",
            Self::StartTooSteep => "start_too_steep",
            Self::WayTooSteep => "way_too_steep",
            Self::PolygonsCross => "polygons_cross",
            Self::PolygonsNotPlanar => "polygons_not_planar",
            Self::PostsStandOut => "posts_stand_out",
            Self::PostsTooDense => "posts_too_dense",
            Self::OpenMesh => "open_mesh",
            Self::RaysInMap => "rays_in_map",
        }
    }
}

impl Serialize for WarningCode {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.word())
    }
}

/// A warning.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Warning {
    /// Its code.
    pub code: WarningCode,
    /// The sensor that it is about, if it is about one.
    #[serde(serialize_with = "sensor_or_null")]
    pub sensor: Option<SensorId>,
    /// What looks wrong, and what to look at, without the sensor's name.
    pub sentence: String,
}

impl Warning {
    /// A warning about a sensor.
    pub fn of_sensor(code: WarningCode, sensor: SensorId, sentence: impl Into<String>) -> Self {
        Self { code, sensor: Some(sensor), sentence: sentence.into() }
    }

    /// A warning about the scene or the run.
    pub fn of_scene(code: WarningCode, sentence: impl Into<String>) -> Self {
        Self { code, sensor: None, sentence: sentence.into() }
    }
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.sensor {
            Some(sensor) => write!(f, "{sensor}: {}", self.sentence),
            None => f.write_str(&self.sentence),
        }
    }
}

fn sensor_or_null<S: Serializer>(sensor: &Option<SensorId>, serializer: S) -> Result<S::Ok, S::Error> {
    match sensor {
        Some(sensor) => serializer.serialize_some(&sensor.to_string()),
        None => serializer.serialize_none(),
    }
}
