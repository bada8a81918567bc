//! What is driven: a scene and its drive become the rover's plan, with a camera that turns light into numbers.

use std::sync::Arc;

use glam::{DVec2, DVec3};
use raypencil_rover::{
    Attitude, Detection, DrivePlan, Exposures, Extraction, Fixes, MapSize, OnVehicle, PassableRules, Place,
    RadialGrid, Rig, Route, ScanRule, SensorErrors, SlopeLimits, Sweep, VectorRules, Vehicle,
};
use raypencil_scene::{Camera, FluxModel, Image, Mesh, Pose, SceneError};
use raypencil_scene_io::{
    DetectionWord, DriveSettings, ElectronicsSettings, LoadedScene, PlaceWord, SceneSource, SensorWord,
    SunSettings,
};
use raypencil_sensor::{MARS_ORBIT, Optics, SOLAR_SPECTRUM_810, Sensor, Sunlight, preset};

use super::chain::{MOST_FINE_CELLS, camera_chain};
use crate::output::OutputError;
use crate::output::text::number;

/// Pencils across each pixel of the camera, along the fan. CHOICE: with fewer than two some columns of the image see no
/// pencil and the stripe has gaps; four leave it unbroken on slanted ground too.
const PENCILS_PER_PIXEL: f64 = 4.0;
/// Below this a stripe is broken, and the run says so.
const FEWEST_PENCILS_PER_PIXEL: f64 = 2.0;
/// A beam has no more columns. (`scene`)
const MOST_COLUMNS: f64 = 1_048_576.0;
/// A drive has no more frames: an hour of them at ten a second. Each leaves some two thousand edge points in memory.
pub(super) const MOST_FRAMES: u64 = 36_000;

/// Why there is no drive.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum DriveError {
    /// A scene that says nothing of where to go.
    #[error(
        "there is no drive; expected a scene file with a [drive] table (docs/drive.md), or a built-in ground: pyramids, \
         facets"
    )]
    NoDrive,
    /// Light in a unit that no camera can expose.
    #[error("flux model eq1 is in W/m, which no camera can expose; expected radiometric")]
    Unit,
    /// More memory than a blur is worth.
    #[error(
        "drive.optics: the fine image would have {columns} x {rows} cells; expected up to {MOST_FINE_CELLS} in all: a \
         smaller oversampling, or a camera of fewer pixels"
    )]
    FineImage {
        /// Cells across.
        columns: u64,
        /// Cells down.
        rows: u64,
    },
    /// A route without end.
    #[error(
        "the route has more than {MOST_FRAMES} frames; expected fewer: a shorter way, more speed or fewer frames per second"
    )]
    Frames,
    /// A number that the rover does not take.
    #[error(transparent)]
    Plan(#[from] SceneError),
    /// A file that could not be written.
    #[error(transparent)]
    Output(#[from] OutputError),
}

/// A drive, ready to be driven.
#[derive(Debug, Clone)]
pub struct DriveJob {
    /// A short name, fit for a folder.
    pub name: String,
    /// The words after `raypencil drive` that give it again.
    pub arguments: String,
    /// SHA-256 of what defines the scene.
    pub sha256: String,
    /// The ground.
    pub mesh: Arc<Mesh>,
    /// The rover's plan.
    pub plan: DrivePlan,
    /// Which sensor.
    pub sensor_word: SensorWord,
    /// Step 6.
    pub optics: Optics,
    /// Steps 7 and 8.
    pub sensor: Sensor,
    /// The sun behind the stripes.
    pub sunlight: Option<Sunlight>,
    /// Whether a second image without the laser is taken off each.
    pub subtract_unlit: bool,
    /// What people should know of how it was set up.
    pub notes: Vec<String>,
    /// What may spoil it.
    pub warnings: Vec<String>,
}

/// The drive of a built-in ground: where it starts, and the rest.
fn builtin(name: &str) -> Option<(DVec2, DriveSettings)> {
    let drive = |waypoint: [f64; 2]| DriveSettings {
        waypoints: vec![waypoint],
        // CHOICE: a frame each 0.1 m, a grid spacing, which its own extrapolation closes; ten frames a second would be one
        // each 3 cm.
        frame_rate: Some(BUILTIN_FRAMES_PER_S),
        // Twice each metre, and at the very end.
        obstacles_every: Some(5),
        // CHOICE: no scans: what figures 12 and 15 leave open, stripes alone could not see.
        scans: Some(false),
        ..DriveSettings::default()
    };
    match name {
        // "The vehicle starts at 7.5 meters from where the view from the camera in Figure 11 was taken." (§8)
        "pyramids" => Some((DVec2::new(-7.5, 0.0), drive([0.0, 0.0]))),
        // CHOICE: 6 m up to where the ground is calm and the scene's own view is from. The near stripe is 3.3 m ahead and the
        // vehicle's wheels reach 0.95 m back: only after 4.2 m has it seen what it stands on.
        "facets" => Some((DVec2::new(-6.0, 0.0), drive([0.0, 0.0]))),
        _ => None,
    }
}

/// At 0.3 m/s a frame each 0.1 m.
const BUILTIN_FRAMES_PER_S: f64 = 3.0;

impl DriveJob {
    /// The drive that a scene file describes, or that of a built-in ground, starting at `at` if that is given.
    ///
    /// # Errors
    /// A scene without a drive; numbers that make none, by their field.
    pub fn new(loaded: &LoadedScene, at: Option<[f64; 2]>, arguments: String) -> Result<Self, DriveError> {
        let scene = &loaded.scene;
        if scene.flux_model() == FluxModel::Eq1 {
            return Err(DriveError::Unit);
        }
        let mut notes = Vec::new();
        let vehicle = loaded.vehicle;
        let (start, settings) = match (&loaded.drive, &loaded.source) {
            (Some(settings), _) => (vehicle.position.truncate(), settings.clone()),
            (None, SceneSource::Builtin(name)) => {
                let (start, settings) = builtin(name).ok_or(DriveError::NoDrive)?;
                notes.push(
                    "built-in drive: a frame each 0.1 m, not ten a second, and no vertical scans".to_string(),
                );
                (at.map_or(start, DVec2::from_array), settings)
            }
            (None, _) => return Err(DriveError::NoDrive),
        };
        // Sensors are on the vehicle wherever it stands.
        let position = vehicle.position - scene.mesh().origin();
        let rig = Rig::of_scene(scene, Pose { position, ..vehicle });
        let forward = vehicle.rotate(DVec3::X);
        let heading = libm::atan2(forward.y, forward.x);

        let sensor_word = settings.sensor.unwrap_or(SensorWord::Ideal);
        let (optics, sensor) = camera_chain(&settings, sensor_word, &rig)?;

        let (rig, mut warnings) =
            with_columns(rig, settings.pencils_per_pixel.unwrap_or(PENCILS_PER_PIXEL), &mut notes);
        warnings.extend(blind_threshold(&settings, sensor_word));
        warnings.extend(beams_out_of_order(&settings, &rig));
        let mut plan = plan(&settings, rig, start, heading, sensor_word);
        plan.atmosphere = scene.atmosphere();
        plan.flux_model = scene.flux_model();
        plan.validate("drive")?;
        Ok(Self {
            name: loaded.name.clone(),
            arguments,
            sha256: loaded.source_sha256.clone(),
            mesh: Arc::clone(scene.mesh()),
            plan,
            sensor_word,
            optics,
            sensor,
            sunlight: settings.sun.map(sunlight),
            subtract_unlit: settings.subtract_unlit == Some(true),
            notes,
            warnings,
        })
    }

    /// Steps 7 and 8: the digital numbers of one exposure, without those of the background if a second one is taken off.
    pub(super) fn digital(
        &self,
        light: &Image<f64>,
        background: Option<&Image<f64>>,
        number: u64,
    ) -> Image<i32> {
        if self.subtract_unlit {
            // As `Sensor::expose_pair` has it.
            let unlit = Image::filled(light.width(), light.height(), 0.0);
            let mut lit: Image<i32> = self.sensor.numbers(light, background, 2 * number);
            let unlit: Image<i32> = self.sensor.numbers(&unlit, background, 2 * number + 1);
            for (lit, unlit) in lit.cells_mut().iter_mut().zip(unlit.cells()) {
                *lit -= unlit;
            }
            return lit;
        }
        self.sensor.numbers(light, background, number)
    }

    /// How many frames the route has.
    pub(super) fn frames(&self) -> Result<u64, DriveError> {
        let over = |index| self.plan.route.frame(index).is_none();
        if !over(MOST_FRAMES) {
            return Err(DriveError::Frames);
        }
        // Once it is over it stays so: halving finds the first frame that is not.
        let (mut driven, mut end) = (0, MOST_FRAMES);
        while driven < end {
            let middle = driven + (end - driven) / 2;
            if over(middle) { end = middle } else { driven = middle + 1 }
        }
        Ok(end)
    }
}

/// How many pencils of a beam lie across a pixel of the camera where both look the same way: columns over the pixels that
/// the fan would fill.
fn pencils_per_pixel(camera: &Camera, columns: f64, half_width_over_distance: f64) -> f64 {
    columns / (2.0 * half_width_over_distance * camera.focal_length / camera.pixel_pitch[0])
}

/// Raises the columns of beams that are too coarse for the camera; never lowers them.
fn with_columns(mut rig: Rig, wanted: f64, notes: &mut Vec<String>) -> (Rig, Vec<String>) {
    let camera = rig.camera.sensor;
    let mut warnings = Vec::new();
    for (index, OnVehicle { sensor: beam, .. }) in rig.beams.iter_mut().enumerate() {
        let spread = beam.half_width / beam.grid_distance;
        let needed = wanted / pencils_per_pixel(&camera, 1.0, spread);
        // The cells of a sensor are limited too: 2^26.
        let most = MOST_COLUMNS.min(67_108_864.0 / f64::from(beam.rows));
        let columns = needed.ceil().min(most.floor()).max(1.0) as u32;
        if columns > beam.columns {
            notes.push(format!(
                "beam {index}: {columns} columns in place of {}, {} pencils to a pixel",
                beam.columns,
                number(pencils_per_pixel(&camera, f64::from(columns), spread))
            ));
            beam.columns = columns;
        }
        let reached = pencils_per_pixel(&camera, f64::from(beam.columns), spread);
        if reached < FEWEST_PENCILS_PER_PIXEL {
            warnings.push(format!(
                "beam {index} has {} pencils to a pixel of the camera: below {FEWEST_PENCILS_PER_PIXEL} its stripe \
                 has gaps",
                number(reached)
            ));
        }
    }
    (rig, warnings)
}

/// Light on Mars, its sun as bright as the file says.
fn sunlight(settings: SunSettings) -> Sunlight {
    let mars = Sunlight::mars(settings.elevation, settings.azimuth, settings.optical_depth);
    let usual = SOLAR_SPECTRUM_810 / (MARS_ORBIT * MARS_ORBIT);
    let share = settings.spectral_irradiance.map_or(1.0, |irradiance| irradiance / usual);
    Sunlight { direct: share * mars.direct, sky: share * mars.sky, ..mars }
}

/// The level that tells light from dark where the file names none, digital numbers.
///
/// CHOICE: about a fiftieth of a stripe of the default rig (24,000, 84 and 1620 DN, docs/sensor.md) above the bias, so that
/// a stripe 10 m away still passes; several times what noise reaches.
pub(super) fn threshold(sensor: SensorWord) -> f64 {
    match sensor {
        SensorWord::Ideal => 400.0,
        SensorWord::Ccd1989 => 4.0,
        SensorWord::Cmos => 100.0,
    }
}

/// A warning where beams that are told apart by their order, the lowest in the image first, look down the other way round.
fn beams_out_of_order(settings: &DriveSettings, rig: &Rig) -> Option<String> {
    let down = |beam: &OnVehicle<_>| -beam.vehicle_from_sensor.rotate(DVec3::Z).z;
    let steeper = rig.beams.windows(2).position(|pair| down(&pair[0]) <= down(&pair[1]))?;
    (settings.lit_together == Some(true)).then(|| {
        format!("beam {steeper} looks down no more than beam {}: together, the lowest stripe is taken for beam 0's", steeper + 1)
    })
}

/// A warning where the usual threshold knows nothing of what the file changes.
fn blind_threshold(settings: &DriveSettings, sensor: SensorWord) -> Option<String> {
    let sun = settings.sun.is_some() && settings.subtract_unlit != Some(true);
    let changed = if sun {
        "a sun behind the stripes"
    } else if settings.electronics != ElectronicsSettings::default() {
        "other electronics"
    } else {
        return None;
    };
    let usual = settings.threshold.is_none() && settings.detection != Some(DetectionWord::Otsu);
    let level = number(threshold(sensor));
    usual.then(|| {
        format!(
            "the threshold of {level} DN is for the preset alone and knows nothing of {changed}: threshold_dn"
        )
    })
}

/// The rover's plan: its own defaults, but for what the file says.
fn plan(settings: &DriveSettings, rig: Rig, start: DVec2, heading: f64, sensor: SensorWord) -> DrivePlan {
    let usual = Vehicle::default();
    let vehicle = Vehicle {
        wheelbase: settings.wheelbase.unwrap_or(usual.wheelbase),
        track: settings.track.unwrap_or(usual.track),
        wheel_radius: settings.wheel_radius.unwrap_or(usual.wheel_radius),
        wheel_width: settings.wheel_width.unwrap_or(usual.wheel_width),
        clearance: settings.clearance.unwrap_or(usual.clearance),
        ..usual
    };
    let waypoints = settings.waypoints.iter().map(|&waypoint| DVec2::from_array(waypoint)).collect();
    let mut route = Route { heading, ..Route::through(start, waypoints) };
    route.speed = settings.speed.unwrap_or(route.speed);
    route.turn_rate = settings.turn_rate.unwrap_or(route.turn_rate);
    route.frame_rate = settings.frame_rate.unwrap_or(route.frame_rate);

    let level = settings.threshold.unwrap_or_else(|| {
        // An unlit image takes the bias along.
        let bias = preset(sensor.word()).map_or(0.0, |(_, sensor)| sensor.bias);
        threshold(sensor) - if settings.subtract_unlit == Some(true) { bias } else { 0.0 }
    });
    let mut extraction = Extraction::thresholding(level);
    extraction.detection = match settings.detection.unwrap_or(DetectionWord::Fixed) {
        DetectionWord::Fixed => Detection::Fixed(level),
        DetectionWord::Otsu => Detection::Otsu,
        DetectionWord::Gradient => Detection::Gradient(level),
    };
    extraction.place = match settings.place.unwrap_or(PlaceWord::Pixel) {
        PlaceWord::Pixel => Place::Pixel,
        PlaceWord::SubPixel => Place::SubPixel,
        PlaceWord::Centroid => Place::Centroid,
    };
    extraction.least_rows = settings.least_rows.unwrap_or(extraction.least_rows);

    let mut plan = DrivePlan::new(rig, route, extraction);
    let rules = PassableRules::of(&vehicle);
    plan.rules = if settings.cross_gaps == Some(true) { rules.crossing_gaps(&vehicle) } else { rules };
    let ([front, rear, length, closer], usual) = (settings.slopes, plan.rules.slopes);
    plan.rules.slopes = SlopeLimits {
        front: front.unwrap_or(usual.front),
        rear: rear.unwrap_or(usual.rear),
        length: length.unwrap_or(usual.length),
        closer: closer.unwrap_or(usual.closer),
    };
    let ([first, last, step], usual) = (settings.grid_radii, RadialGrid::of(&vehicle));
    plan.grid = RadialGrid {
        sectors: settings.grid_sectors.unwrap_or(usual.sectors),
        half_angle: settings.grid_half_angle.unwrap_or(usual.half_angle),
        first: first.unwrap_or(usual.first),
        step: step.unwrap_or(usual.step),
        last: last.unwrap_or(usual.last),
    };
    let usual = VectorRules::of(&vehicle);
    plan.vectors = VectorRules {
        large: settings.vector_large.unwrap_or(usual.large),
        small: settings.vector_small.unwrap_or(usual.small),
    };
    plan.vehicle = vehicle;
    plan.seed = settings.seed.unwrap_or(plan.seed);
    if settings.lit_together == Some(true) {
        plan.exposures = Exposures::Together;
    }
    plan.map = MapSize {
        spacing: settings.map_spacing.unwrap_or(plan.map.spacing),
        points: settings.map_points.unwrap_or(plan.map.points),
    };
    plan.obstacles_every = settings.obstacles_every.unwrap_or(plan.obstacles_every);
    plan.scans = match settings.scans {
        Some(false) => None,
        _ => {
            let rule = ScanRule::default();
            Some(ScanRule {
                every: settings.scan_every.or(rule.every),
                inconsistency: settings.scan_inconsistency.or(rule.inconsistency),
                least_points: settings.scan_least_points.unwrap_or(rule.least_points),
                ..rule
            })
        }
    };
    let ([from, to], usual) = (settings.scan_angles, plan.sweep);
    plan.sweep = Sweep {
        from: from.unwrap_or(usual.from),
        to: to.unwrap_or(usual.to),
        steps: settings.scan_steps.unwrap_or(usual.steps),
        ..usual
    };
    let [heading, pitch_down, roll_right] = settings.attitude_bias.map(|bias| bias.unwrap_or(0.0));
    plan.errors = SensorErrors {
        position_drift: settings.position_drift.map_or(DVec2::ZERO, DVec2::from_array),
        position_walk: settings.position_walk.unwrap_or(0.0),
        attitude_bias: Attitude { heading, pitch_down, roll_right },
        heading_drift: settings.heading_drift.unwrap_or(0.0),
        attitude_noise: settings.attitude_noise.unwrap_or(0.0),
        proximity_noise: settings.proximity_noise.unwrap_or(0.0),
        fixes: settings
            .fix_every
            .map(|every_frames| Fixes { every_frames, noise: settings.fix_noise.unwrap_or(0.0) }),
    };
    plan
}
