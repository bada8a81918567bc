//! The plan of a drive: all its settings. (Paper, §7 and §8)

use raypencil_scene::{Atmosphere, FluxModel, SceneError, check_count};

use crate::elevation_map::MapSize;
use crate::exposure_times::ExposureTimes;
use crate::localisation::LocalisationErrors;
use crate::navigator_map::VectorRules;
use crate::obstacle_map::{FRAMES_PER_OBSTACLE_MAP, RadialGrid};
use crate::rig::Rig;
use crate::route::Route;
use crate::rules::{MapRules, Rule, StartRule};
use crate::scan::{ScanRule, Sweep};
use crate::stripe::{Extraction, StripeLocation};
use crate::traversability::TraversabilityRules;
use crate::true_limits::TrueLimits;
use crate::vehicle::Vehicle;

/// Assignment of exposures to beams, which tells the stripes of the beams apart.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ExposureMode {
    /// Each beam is lit alone, in its own exposure. CHOICE: the paper does not say; here no assignment is guessed.
    #[default]
    InTurn,
    /// All beams are lit in one exposure, and distinguished by the planes on which their stripes can lie
    /// ([`Extraction::edges_by_plane`]).
    Together,
}

/// How an edge in the image becomes a point.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum PointLookup {
    /// The point at the measured row, computed for each edge.
    #[default]
    Computed,
    /// The point of the edge's pixel, from a table of all pixels: "A table holds the local vehicle coordinates of the
    /// edge plane point seen by any given camera pixel" (§7). A scan needs another table at each of its positions.
    Table,
}

/// Names of the rules that [`DrivePlan::set_rule`] puts in force.
pub const RULE_NAMES: [&str; 8] =
    ["start", "elevation", "extrapolate", "several", "inconsistency", "gap", "settle", "tests"];

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
    /// Times of the exposures of a frame, and the motion in each.
    pub times: ExposureTimes,
    /// How edges become points.
    pub lookup: PointLookup,
    /// Errors of the localisation sensors.
    pub errors: LocalisationErrors,
    /// Seed of these errors.
    pub seed: u64,
    /// Size of the elevation map.
    pub map: MapSize,
    /// Rules of the elevation map and of the vehicle.
    pub map_rules: MapRules,
    /// Conditions for a vertical scan. `None`: no scans.
    pub scans: Option<ScanRule>,
    /// Angles of a scan.
    pub sweep: Sweep,
    /// Number of frames from one obstacle map to the next.
    pub obstacles_every: u64,
    /// Settings of the traversability tests.
    pub rules: TraversabilityRules,
    /// What the vehicle can truly do, which the rover does not know.
    pub truth: TrueLimits,
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
    /// The same plan with all rules as the paper prints them: ten frames a second, both beams lit together, points from
    /// the table, and the printed rules of the maps. "Current plans for the real system are for the edges to be extracted
    /// every tenth of a second. Since only two lines of stripe data are produced by the SLVS every cycle ..." (§7)
    pub fn as_printed(self) -> Self {
        let TraversabilityRules { slopes, rear_needed, .. } = self.rules;
        Self {
            route: Route { frame_rate: 10.0, ..self.route },
            exposures: ExposureMode::Together,
            extraction: Extraction { place: StripeLocation::Pixel, ..self.extraction },
            lookup: PointLookup::Table,
            map_rules: MapRules::AS_PRINTED,
            rules: TraversabilityRules {
                slopes,
                rear_needed,
                ..TraversabilityRules::as_printed(&self.vehicle)
            },
            ..self
        }
    }

    /// Puts one rule in force by its name, one of [`RULE_NAMES`], and a word: `paper` or `mended`; for `start` also
    /// `footprint` and `circle`.
    ///
    /// # Errors
    /// The words that are expected instead.
    ///
    /// ```
    /// # use glam::DVec2;
    /// # use raypencil_rover::{DrivePlan, Extraction, OnVehicle, Rig, Route, Rule, RULE_NAMES};
    /// # use raypencil_scene::{Camera, Lens, Pose};
    /// # let camera = Camera {
    /// #     width: 8, height: 8, pixel_pitch: [9e-6; 2], focal_length: 8e-3, principal_point: [4.0; 2],
    /// #     aperture: 2e-3, lens: Lens::CLEAR, max_range: 20.0,
    /// # };
    /// # let rig =
    /// #     Rig { camera: OnVehicle { vehicle_from_sensor: Pose::IDENTITY, sensor: camera }, beams: Vec::new() };
    /// # let route = Route::through(DVec2::ZERO, vec![DVec2::X]);
    /// let mut plan = DrivePlan::new(rig, route, Extraction::thresholding(1.0));
    /// assert_eq!(plan.map_rules.elevation, Rule::Mended);
    /// plan.set_rule("elevation", "paper").unwrap();
    /// assert_eq!(plan.map_rules.elevation, Rule::Paper);
    /// assert_eq!(plan.set_rule("gap", "wide").unwrap_err(), "paper, mended");
    /// assert!(RULE_NAMES.iter().all(|name| plan.set_rule(name, "mended").is_ok()));
    /// ```
    pub fn set_rule(&mut self, name: &str, word: &str) -> Result<(), String> {
        if name == "start" {
            self.map_rules.start = match word {
                "paper" | "mended" => StartRule::Origin,
                "footprint" => StartRule::Footprint,
                "circle" => StartRule::Circle,
                _ => return Err("paper, mended, footprint, circle".into()),
            };
            return Ok(());
        }
        let rule = match word {
            "paper" => Rule::Paper,
            "mended" => Rule::Mended,
            _ => return Err("paper, mended".into()),
        };
        let map = &mut self.map_rules;
        match name {
            "elevation" => map.elevation = rule,
            "extrapolate" => map.extrapolate = rule,
            "several" => map.several = rule,
            "inconsistency" => map.inconsistency = rule,
            "settle" => map.settle = rule,
            "tests" => self.rules.tests = rule,
            "gap" => {
                self.rules = match rule {
                    Rule::Paper => TraversabilityRules { gaps: None, ..self.rules },
                    Rule::Mended => self.rules.crossing_gaps(&self.vehicle),
                }
            }
            _ => return Err(format!("one of {}", RULE_NAMES.join(", "))),
        }
        Ok(())
    }

    /// Plan with the default vehicle and all other settings at their defaults.
    pub fn new(rig: Rig, route: Route, extraction: Extraction) -> Self {
        let vehicle = Vehicle::default();
        Self {
            rules: TraversabilityRules::for_vehicle(&vehicle),
            truth: TrueLimits::default(),
            grid: RadialGrid::for_vehicle(&vehicle),
            vectors: VectorRules::for_vehicle(&vehicle),
            vehicle,
            rig,
            route,
            extraction,
            exposures: ExposureMode::InTurn,
            times: ExposureTimes::default(),
            lookup: PointLookup::Computed,
            errors: LocalisationErrors::default(),
            seed: 0,
            map: MapSize::default(),
            map_rules: MapRules::MENDED,
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
        let lit = match self.exposures {
            ExposureMode::InTurn => self.rig.beams.len(),
            ExposureMode::Together => 1,
        };
        let height = self.rig.camera.sensor.height;
        self.times.validate(&name("times"), lit, 1.0 / self.route.frame_rate, height)?;
        self.errors.validate(&name("errors"))?;
        self.map.validate(&name("map"))?;
        if let Some(scans) = self.scans {
            scans.validate(&name("scans"))?;
        }
        self.sweep.validate(&name("sweep"))?;
        check_count(|| format!("{field}.obstacles_every"), self.obstacles_every, 1, u64::MAX)?;
        self.rules.validate(&name("rules"))?;
        self.truth.validate(&name("truth"), &self.vehicle)?;
        self.grid.validate(&name("grid"))?;
        if self.map.spacing > self.vehicle.width() {
            let expected =
                format!("at most {} m, the width of the vehicle over its wheels", self.vehicle.width());
            return Err(SceneError::new(name("map.spacing"), format!("{} m", self.map.spacing), expected));
        }
        if self.map.reach() < self.grid.first {
            let value = format!("{}, which reach {} m from the middle", self.map.points, self.map.reach());
            let expected = format!("enough for the first radius of the grid, {} m", self.grid.first);
            return Err(SceneError::new(name("map.points"), value, expected));
        }
        self.vectors.validate(&name("vectors"))
    }
}
