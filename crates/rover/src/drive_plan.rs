//! The plan of a drive: all its settings. (Paper, §7 and §8)

use raypencil_scene::{Atmosphere, FluxModel, SceneError, check_count};

use crate::elevation_map::MapSize;
use crate::localisation::LocalisationErrors;
use crate::navigator_map::VectorRules;
use crate::obstacle_map::{FRAMES_PER_OBSTACLE_MAP, RadialGrid};
use crate::rig::Rig;
use crate::route::Route;
use crate::scan::{ScanRule, Sweep};
use crate::stripe::Extraction;
use crate::traversability::TraversabilityRules;
use crate::vehicle::Vehicle;

/// Assignment of exposures to beams, which tells the stripes of the beams apart.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ExposureMode {
    /// Each beam is lit alone, in its own exposure. CHOICE: the paper does not say; here no assignment is guessed.
    #[default]
    InTurn,
    /// All beams are lit in one exposure, and distinguished by their order in the image.
    Together,
}

/// All settings of a drive, except for the ground and the renderer.
#[derive(Debug, Clone, PartialEq)]
pub struct DrivePlan {
    /// Dimensions of the vehicle.
    pub vehicle: Vehicle,
    /// Camera and beams on the vehicle.
    pub rig: Rig,
    /// Commanded route.
    pub route: Route,
    /// Settings of the stripe extraction.
    pub extraction: Extraction,
    /// Exposures of the beams: in turn or together.
    pub exposures: ExposureMode,
    /// Errors of the localisation sensors.
    pub errors: LocalisationErrors,
    /// Seed of these errors.
    pub seed: u64,
    /// Size of the elevation map.
    pub map: MapSize,
    /// Conditions for a vertical scan. `None`: no scans.
    pub scans: Option<ScanRule>,
    /// Angles of a scan.
    pub sweep: Sweep,
    /// Number of frames from one obstacle map to the next.
    pub obstacles_every: u64,
    /// Settings of the traversability tests.
    pub rules: TraversabilityRules,
    /// Radial grid of the obstacle map.
    pub grid: RadialGrid,
    /// Thresholds of the navigator map.
    pub vectors: VectorRules,
    /// Attenuation of the air.
    pub atmosphere: Atmosphere,
    /// Model of the flux, for the renderer.
    pub flux_model: FluxModel,
}

impl DrivePlan {
    /// Plan with the default vehicle and all other settings at their defaults.
    pub fn new(rig: Rig, route: Route, extraction: Extraction) -> Self {
        let vehicle = Vehicle::default();
        Self {
            rules: TraversabilityRules::for_vehicle(&vehicle),
            grid: RadialGrid::for_vehicle(&vehicle),
            vectors: VectorRules::for_vehicle(&vehicle),
            vehicle,
            rig,
            route,
            extraction,
            exposures: ExposureMode::InTurn,
            errors: LocalisationErrors::default(),
            seed: 0,
            map: MapSize::default(),
            scans: Some(ScanRule::default()),
            sweep: Sweep::default(),
            obstacles_every: FRAMES_PER_OBSTACLE_MAP,
            atmosphere: Atmosphere { attenuation: 0.0 },
            flux_model: FluxModel::Radiometric,
        }
    }

    /// Checks every field. The error names the first one that is out of range.
    pub fn validate(&self, field: &str) -> Result<(), SceneError> {
        let name = |part: &str| format!("{field}.{part}");
        self.vehicle.validate(&name("vehicle"))?;
        self.rig.validate(&name("rig"))?;
        self.route.validate(&name("route"))?;
        self.extraction.validate(&name("extraction"))?;
        self.errors.validate(&name("errors"))?;
        self.map.validate(&name("map"))?;
        if let Some(scans) = self.scans {
            scans.validate(&name("scans"))?;
        }
        self.sweep.validate(&name("sweep"))?;
        check_count(|| format!("{field}.obstacles_every"), self.obstacles_every, 1, u64::MAX)?;
        self.rules.validate(&name("rules"))?;
        self.grid.validate(&name("grid"))?;
        self.vectors.validate(&name("vectors"))
    }
}
