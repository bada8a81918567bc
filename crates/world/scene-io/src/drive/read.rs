//! Keys of `[drive]`, written straight into a [`DriveSetup`].

use glam::{DVec2, DVec3};
use serde::Deserialize;
use std::ops::RangeInclusive;
use toml::Spanned;

use raypencil_rover::{
    Detection, DrivePlan, ExposureMode, MAX_BLUR_SAMPLES, PointLookup, PositionFixes, RULE_NAMES, RadialGrid,
    Rig, Rule, ScanRule, StripeLocation, TraversabilityRules, TrueLimits, VectorRules, Vehicle,
};
use raypencil_sensor::{MARS_SEMI_MAJOR_AXIS_AU, PRESET_NAMES, SOLAR_IRRADIANCE_810_NM, Sunlight};

use crate::digest::NamedDigest;
use crate::drive::camera::{ElectronicsKeys, OpticsKeys};
use crate::drive::setup::{DriveSetup, WaypointFrame, default_threshold};
use crate::parse::key::{Key, span};
use crate::parse::shared::GLOBAL_M;
use crate::parse::source::Source;
use crate::scene_error::SceneIoError;

/// Length of the vehicle, metres: the limits of `rover`.
const VEHICLE_M: RangeInclusive<f64> = 1e-2..=1e2;

/// Maximum number of waypoints of a route.
const MAX_WAYPOINTS: usize = 10_000;

/// CHOICE: a clear day on Mars.
const DEFAULT_OPTICAL_DEPTH: f64 = 0.5;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct DriveKeys {
    waypoints_m: Key<Vec<Spanned<Vec<f64>>>>,
    waypoints_frame: Key<String>,
    speed_m_per_s: Key<f64>,
    turn_deg_per_s: Key<f64>,
    frames_per_s: Key<f64>,
    seed: Key<i64>,
    sensor: Key<String>,
    sensor_seed: Key<i64>,
    sun: Option<SunKeys>,
    subtract_unlit: Option<bool>,
    pencils_per_pixel: Key<f64>,
    exposures: Key<String>,
    exposure_interval_ms: Key<f64>,
    motion_blur_samples: Key<i64>,
    row_time_us: Key<f64>,
    row_bands: Key<i64>,
    detection: Key<String>,
    threshold_dn: Key<f64>,
    threshold_share: Key<f64>,
    lookup: Key<String>,
    place: Key<String>,
    least_rows: Key<i64>,
    map_spacing_m: Key<f64>,
    map_points: Key<i64>,
    obstacles_every_frames: Key<i64>,
    rules: Option<RuleKeys>,
    rear_needed: Option<Spanned<bool>>,
    slope_front: Key<f64>,
    slope_rear: Key<f64>,
    slope_length: Key<f64>,
    slope_closer: Key<f64>,
    true_slope_front: Key<f64>,
    true_slope_rear: Key<f64>,
    true_slope_length: Key<f64>,
    true_clearance_m: Key<f64>,
    true_step_m: Key<f64>,
    true_centre_of_mass_m: Key<Vec<f64>>,
    grid_first_m: Key<f64>,
    grid_last_m: Key<f64>,
    grid_step_m: Key<f64>,
    grid_half_angle_deg: Key<f64>,
    grid_sectors: Key<i64>,
    vector_large_m: Key<f64>,
    vector_small_m: Key<f64>,
    scans: Option<bool>,
    scan_every_m: Key<f64>,
    scan_steps: Key<i64>,
    scan_step_s: Key<f64>,
    scan_from_deg: Key<f64>,
    scan_to_deg: Key<f64>,
    scan_inconsistency_m: Key<f64>,
    scan_least_points: Key<i64>,
    wheelbase_m: Key<f64>,
    track_m: Key<f64>,
    wheel_radius_m: Key<f64>,
    wheel_width_m: Key<f64>,
    clearance_m: Key<f64>,
    position_drift_m_per_s: Key<Vec<f64>>,
    position_walk_m: Key<f64>,
    heading_bias_deg: Key<f64>,
    pitch_bias_deg: Key<f64>,
    roll_bias_deg: Key<f64>,
    heading_drift_deg_per_s: Key<f64>,
    attitude_noise_deg: Key<f64>,
    proximity_noise_m: Key<f64>,
    fix_every_frames: Key<i64>,
    fix_noise_m: Key<f64>,
    optics: Option<OpticsKeys>,
    electronics: Option<ElectronicsKeys>,
}

/// `[drive.rules]`: a word for each of `rover::RULE_NAMES`.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RuleKeys {
    start: Key<String>,
    elevation: Key<String>,
    extrapolate: Key<String>,
    several: Key<String>,
    inconsistency: Key<String>,
    gap: Key<String>,
    settle: Key<String>,
    tests: Key<String>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct SunKeys {
    elevation_deg: Spanned<f64>,
    azimuth_deg: Key<f64>,
    optical_depth: Key<f64>,
    irradiance_w_per_m2_nm: Key<f64>,
}

impl Source<'_> {
    /// Drive of a rig, and the digests of the files of its kernels.
    ///
    /// The order matters where a default depends on other keys: the preset comes before seed, threshold, optics and
    /// electronics, and the vehicle before the rules of traversability, the radial grid and the navigator map.
    pub(crate) fn drive(
        &self,
        keys: &DriveKeys,
        rig: Rig,
    ) -> Result<(DriveSetup, Vec<NamedDigest>), SceneIoError> {
        let mut frame = WaypointFrame::Vehicle;
        let frames = [("vehicle", WaypointFrame::Vehicle), ("global", WaypointFrame::Global)];
        self.choice(&keys.waypoints_frame, "drive.waypoints_frame", &mut frame, &frames)?;
        // Without any the table only sets how a route is driven that is given elsewhere.
        let waypoints = keys.waypoints_m.as_ref().map(|list| self.waypoints(list)).transpose()?;
        let mut drive = DriveSetup::new(rig, waypoints.unwrap_or_default(), frame);
        self.route(keys, &mut drive.plan)?;
        self.light(keys, &mut drive)?;
        self.extraction(keys, &mut drive)?;
        self.vehicle_lengths(keys, &mut drive.plan.vehicle)?;
        self.maps(keys, &mut drive.plan)?;
        self.true_limits(keys, &mut drive.plan.truth)?;
        self.scans(keys, &mut drive.plan)?;
        self.localisation(keys, &mut drive.plan)?;
        let mut kernel_digests = Vec::new();
        if let Some(keys) = &keys.optics {
            kernel_digests = self.optics(keys, &mut drive)?;
        }
        if let Some(keys) = &keys.electronics {
            self.electronics(keys, &mut drive.sensor)?;
        }
        self.threshold_is_reached(keys, &drive)?;
        drive.has_camera |= keys.optics.is_some()
            || keys.electronics.is_some()
            || keys.sun.is_some()
            || keys.subtract_unlit == Some(true);
        let is_fixed =
            matches!(drive.plan.extraction.detection, Detection::Fixed(_) | Detection::Gradient(_));
        let by_default = keys.threshold_dn.is_none() && is_fixed;
        drive.threshold_ignores = if !by_default {
            None
        } else if keys.sun.is_some() {
            Some("a sun behind the stripes")
        } else if keys.electronics.as_ref().is_some_and(|keys| !keys.is_empty()) {
            Some("other electronics")
        } else {
            None
        };
        Ok((drive, kernel_digests))
    }

    fn waypoints(&self, list: &Spanned<Vec<Spanned<Vec<f64>>>>) -> Result<Vec<DVec2>, SceneIoError> {
        let count = list.get_ref().len();
        if !(1..=MAX_WAYPOINTS).contains(&count) {
            let message = format!("`drive.waypoints_m` has {count} places; expected 1 to {MAX_WAYPOINTS}");
            return Err(self.error(list.span(), message));
        }
        let waypoint = |key| {
            let numbers = self.list(key, "drive.waypoints_m", &[2], GLOBAL_M, "metres")?;
            Ok(DVec2::from_slice(numbers))
        };
        let places: Vec<DVec2> = list.get_ref().iter().map(waypoint).collect::<Result<_, SceneIoError>>()?;
        match places.windows(2).position(|pair| pair[0] == pair[1]) {
            Some(twice) => {
                let message =
                    "`drive.waypoints_m` has this place twice in a row; expected another one after it";
                Err(self.error(list.get_ref()[twice + 1].span(), message))
            }
            None => Ok(places),
        }
    }

    fn route(&self, keys: &DriveKeys, plan: &mut DrivePlan) -> Result<(), SceneIoError> {
        let route = &mut plan.route;
        let (speed, name) = (&keys.speed_m_per_s, "drive.speed_m_per_s");
        self.number(speed, name, &mut route.speed, 1e-4..=1e2, "metres per second")?;
        let (turn, name) = (&keys.turn_deg_per_s, "drive.turn_deg_per_s");
        let range = 1e-2..=3600.0;
        self.converted(turn, name, &mut route.turn_rate, range, "degrees per second", f64::to_radians)?;
        let (rate, name) = (&keys.frames_per_s, "drive.frames_per_s");
        self.number(rate, name, &mut route.frame_rate, 1e-3..=1e4, "per second")?;
        self.integer(&keys.seed, "drive.seed", &mut plan.seed, 0..=i64::MAX, "")
    }

    /// Sensor, sun and exposures.
    fn light(&self, keys: &DriveKeys, drive: &mut DriveSetup) -> Result<(), SceneIoError> {
        if let Some(sensor) = &keys.sensor {
            let presets: Vec<_> = PRESET_NAMES.iter().map(|name| (*name, *name)).collect();
            drive.use_preset(self.word(sensor, "drive.sensor", &presets)?);
            drive.has_camera = true;
        }
        self.integer(&keys.sensor_seed, "drive.sensor_seed", &mut drive.sensor.seed, 0..=i64::MAX, "")?;
        drive.sunlight = keys.sun.as_ref().map(|sun| self.sun(sun)).transpose()?;
        drive.subtract_unlit = keys.subtract_unlit == Some(true);
        let (pencils, name) = (&keys.pencils_per_pixel, "drive.pencils_per_pixel");
        self.number(pencils, name, &mut drive.pencils_per_pixel, 0.1..=64.0, "pencils")?;
        let modes = [("in_turn", ExposureMode::InTurn), ("together", ExposureMode::Together)];
        self.choice(&keys.exposures, "drive.exposures", &mut drive.plan.exposures, &modes)?;
        let (times, milli) = (&mut drive.plan.times, |ms| 1e-3 * ms);
        let (interval, name) = (&keys.exposure_interval_ms, "drive.exposure_interval_ms");
        self.converted(interval, name, &mut times.interval, 0.0..=1e6, "milliseconds", milli)?;
        let (samples, name) = (&keys.motion_blur_samples, "drive.motion_blur_samples");
        self.integer(samples, name, &mut times.samples, 1..=MAX_BLUR_SAMPLES.into(), "")?;
        let (row, name) = (&keys.row_time_us, "drive.row_time_us");
        self.converted(row, name, &mut times.row_time, 0.0..=1e6, "microseconds", |us| 1e-6 * us)?;
        match &keys.row_bands {
            Some(bands) if keys.row_time_us.is_none() => {
                let message = "`drive.row_bands` is given; expected it only with `row_time_us`";
                Err(self.error(bands.span(), message))
            }
            Some(_) => {
                let why = match times.samples {
                    1 => String::new(),
                    samples => {
                        format!("beside {samples} of `motion_blur_samples`, {MAX_BLUR_SAMPLES} images in all")
                    }
                };
                let most = i64::from(MAX_BLUR_SAMPLES / times.samples);
                self.integer(&keys.row_bands, "drive.row_bands", &mut times.bands, 1..=most, &why)
            }
            None => {
                times.bands = times.bands.min(MAX_BLUR_SAMPLES / times.samples);
                Ok(())
            }
        }
    }

    /// Light on Mars, its sun as bright as the file says.
    fn sun(&self, keys: &SunKeys) -> Result<Sunlight, SceneIoError> {
        let elevation = &keys.elevation_deg;
        self.check(*elevation.get_ref(), elevation.span(), "drive.sun.elevation_deg", 0.0..=90.0, "degrees")?;
        let mut azimuth_deg = 0.0;
        let (key, name) = (&keys.azimuth_deg, "drive.sun.azimuth_deg");
        self.number(key, name, &mut azimuth_deg, -360.0..=360.0, "degrees")?;
        let mut optical_depth = DEFAULT_OPTICAL_DEPTH;
        let (key, name) = (&keys.optical_depth, "drive.sun.optical_depth");
        self.number(key, name, &mut optical_depth, 0.0..=10.0, "of dust")?;
        let (key, name) = (&keys.irradiance_w_per_m2_nm, "drive.sun.irradiance_w_per_m2_nm");
        let irradiance = self.optional(key, name, 0.0..=100.0, "W/m^2 per nm")?;

        let mars = Sunlight::mars(elevation.get_ref().to_radians(), azimuth_deg.to_radians(), optical_depth);
        // W/m^2 per metre of wavelength, above the air.
        let usual = SOLAR_IRRADIANCE_810_NM / (MARS_SEMI_MAJOR_AXIS_AU * MARS_SEMI_MAJOR_AXIS_AU);
        let share = irradiance.map_or(1.0, |per_nm| per_nm * 1e9 / usual);
        Ok(Sunlight { direct: share * mars.direct, sky: share * mars.sky, ..mars })
    }

    fn extraction(&self, keys: &DriveKeys, drive: &mut DriveSetup) -> Result<(), SceneIoError> {
        // The difference to an unlit image has no bias.
        let bias = if drive.subtract_unlit { drive.sensor.bias } else { 0.0 };
        let by_default = default_threshold(drive.preset) - bias;
        let level = keys.threshold_dn.as_ref().map_or(by_default, |key| *key.get_ref());
        let extraction = &mut drive.plan.extraction;
        extraction.detection = Detection::Fixed(level);
        let detections = [
            ("fixed", Detection::Fixed(level)),
            ("otsu", Detection::Otsu),
            ("gradient", Detection::Gradient(level)),
        ];
        self.choice(&keys.detection, "drive.detection", &mut extraction.detection, &detections)?;
        if let (Detection::Otsu, Some(threshold)) = (extraction.detection, &keys.threshold_dn) {
            let message = "`drive.threshold_dn` is given; expected none with detection = \"otsu\"";
            return Err(self.error(threshold.span(), message));
        }
        self.optional(&keys.threshold_dn, "drive.threshold_dn", 1e-3..=65535.0, "digital numbers")?;
        let (share, name) = (&keys.threshold_share, "drive.threshold_share");
        self.number(share, name, &mut drive.threshold_share, 1e-9..=1.0, "of the image's maximum")?;
        if let Some(share) = share {
            if extraction.detection != Detection::Fixed(level) || keys.threshold_dn.is_some() {
                let message =
                    "`drive.threshold_share` is given; expected no threshold_dn and no other detection";
                return Err(self.error(share.span(), message));
            }
            extraction.detection = Detection::Share(drive.threshold_share);
        }
        let lookups = [("computed", PointLookup::Computed), ("table", PointLookup::Table)];
        self.choice(&keys.lookup, "drive.lookup", &mut drive.plan.lookup, &lookups)?;
        let extraction = &mut drive.plan.extraction;
        let places = [
            ("pixel", StripeLocation::Pixel),
            ("sub_pixel", StripeLocation::SubPixel),
            ("centroid", StripeLocation::Centroid),
        ];
        self.choice(&keys.place, "drive.place", &mut extraction.place, &places)?;
        self.integer(&keys.least_rows, "drive.least_rows", &mut extraction.least_rows, 1..=1_000_000, "")
    }

    /// A pixel is bright above the threshold: the camera's largest number must be.
    fn threshold_is_reached(&self, keys: &DriveKeys, drive: &DriveSetup) -> Result<(), SceneIoError> {
        let Some(threshold) = &keys.threshold_dn else { return Ok(()) };
        let of_converter = ((1_u64 << drive.sensor.bits) - 1) as f64;
        let (largest, less) = if drive.subtract_unlit {
            (of_converter - drive.sensor.bias, ", less the bias")
        } else {
            (of_converter, "")
        };
        if *threshold.get_ref() < largest {
            return Ok(());
        }
        let message = format!(
            "`drive.threshold_dn` is {}; expected less than {largest}, the largest number of the camera's {} bits{less}: no \
             pixel would be bright",
            threshold.get_ref(),
            drive.sensor.bits
        );
        Err(self.error(threshold.span(), message))
    }

    fn vehicle_lengths(&self, keys: &DriveKeys, vehicle: &mut Vehicle) -> Result<(), SceneIoError> {
        let lengths = [
            ("wheelbase_m", &keys.wheelbase_m, &mut vehicle.wheelbase),
            ("track_m", &keys.track_m, &mut vehicle.track),
            ("wheel_radius_m", &keys.wheel_radius_m, &mut vehicle.wheel_radius),
            ("wheel_width_m", &keys.wheel_width_m, &mut vehicle.wheel_width),
            ("clearance_m", &keys.clearance_m, &mut vehicle.clearance),
        ];
        for (name, key, slot) in lengths {
            self.number(key, &format!("drive.{name}"), slot, VEHICLE_M, "metres")?;
        }
        Ok(())
    }

    /// Elevation map, obstacle map and navigator map.
    fn maps(&self, keys: &DriveKeys, plan: &mut DrivePlan) -> Result<(), SceneIoError> {
        self.number(&keys.map_spacing_m, "drive.map_spacing_m", &mut plan.map.spacing, 1e-3..=1e3, "metres")?;
        if let Some(points) = &keys.map_points {
            plan.map.points = self.odd(points)?;
        }
        let (every, name) = (&keys.obstacles_every_frames, "drive.obstacles_every_frames");
        self.integer(every, name, &mut plan.obstacles_every, 1..=i64::MAX, "")?;

        plan.rules = TraversabilityRules::for_vehicle(&plan.vehicle);
        if let Some(rules) = &keys.rules {
            self.rules(rules, plan)?;
        }
        if let Some(needed) = &keys.rear_needed {
            plan.rules.rear_needed = *needed.get_ref();
            if !plan.rules.rear_needed && plan.rules.tests == Rule::Mended {
                let message = "`drive.rear_needed` is false; expected it only with the paper's tests, rules = { tests = \
                               \"paper\" }: the mended ones need the ground under every wheel";
                return Err(self.error(needed.span(), message));
            }
        }
        let limits = &mut plan.rules.slopes;
        let slopes = [
            ("slope_front", &keys.slope_front, &mut limits.front),
            ("slope_rear", &keys.slope_rear, &mut limits.rear),
            ("slope_length", &keys.slope_length, &mut limits.length),
            ("slope_closer", &keys.slope_closer, &mut limits.closer),
        ];
        for (name, key, slot) in slopes {
            self.number(key, &format!("drive.{name}"), slot, 0.0..=1e3, "of rise over distance")?;
        }

        if let (Some(first), Some(last)) = (&keys.grid_first_m, &keys.grid_last_m)
            && last.get_ref() < first.get_ref()
        {
            let message = format!(
                "`drive.grid_last_m` is {}; expected `grid_first_m` or more, {}",
                last.get_ref(),
                first.get_ref()
            );
            return Err(self.error(last.span(), message));
        }
        plan.grid = RadialGrid::for_vehicle(&plan.vehicle);
        let grid = &mut plan.grid;
        self.number(&keys.grid_first_m, "drive.grid_first_m", &mut grid.first, 0.0..=1e3, "metres")?;
        self.number(&keys.grid_last_m, "drive.grid_last_m", &mut grid.last, 0.0..=1e3, "metres")?;
        self.number(&keys.grid_step_m, "drive.grid_step_m", &mut grid.step, 1e-3..=1e3, "metres")?;
        let (angle, name) = (&keys.grid_half_angle_deg, "drive.grid_half_angle_deg");
        self.converted(angle, name, &mut grid.half_angle, 0.0..=180.0, "degrees", f64::to_radians)?;
        self.integer(&keys.grid_sectors, "drive.grid_sectors", &mut grid.sectors, 1..=100_000, "")?;

        let degenerate = match keys.grid_half_angle_deg.as_ref().map(|angle| (angle, *angle.get_ref())) {
            Some((angle, 0.0)) => Some((angle, "more than 0", "all sectors")),
            Some((angle, 180.0)) => Some((angle, "less than 180", "the first sector and the last")),
            _ => None,
        };
        if let (Some((angle, expected, which)), true) = (degenerate, grid.sectors > 1) {
            let message = format!(
                "`drive.grid_half_angle_deg` is {}; expected {expected}, or `grid_sectors` 1: {which} have one direction",
                angle.get_ref()
            );
            return Err(self.error(angle.span(), message));
        }
        // Beyond the limit the wheels of a side, or all four, would stand on one grid point: no slope is between them.
        let (spacing, width) = (plan.map.spacing, plan.vehicle.width());
        let widths = [span(&keys.map_spacing_m), span(&keys.track_m), span(&keys.wheel_width_m)];
        if let (Some(span), true) = (widths.into_iter().flatten().next(), spacing > width) {
            let message = format!(
                "`drive.map_spacing_m` is {spacing}; expected at most the width of the vehicle over its wheels, {width} m \
                 (`drive.track_m` plus `drive.wheel_width_m`): a cell of the map would be wider than the vehicle"
            );
            return Err(self.error(span, message));
        }
        let reach = plan.map.reach();
        let sizes = [span(&keys.map_points), span(&keys.map_spacing_m), span(&keys.grid_first_m)];
        if let (Some(span), true) = (sizes.into_iter().flatten().next(), reach < plan.grid.first) {
            let message = format!(
                "the map reaches {reach} m from its middle; expected the first radius or more, {} m: nothing can be tested on it \
                 (`drive.map_points`, `drive.map_spacing_m`, `drive.grid_first_m`)",
                plan.grid.first
            );
            return Err(self.error(span, message));
        }

        plan.vectors = VectorRules::for_vehicle(&plan.vehicle);
        let vectors = &mut plan.vectors;
        self.number(&keys.vector_large_m, "drive.vector_large_m", &mut vectors.large, 0.0..=1e3, "metres")?;
        self.number(&keys.vector_small_m, "drive.vector_small_m", &mut vectors.small, 0.0..=1e3, "metres")?;
        let given = span(&keys.vector_large_m).or(span(&keys.vector_small_m));
        match given {
            Some(span) if vectors.large < vectors.small => {
                let message = format!(
                    "`drive.vector_large_m` is {}; expected `vector_small_m` or more, {}",
                    vectors.large, vectors.small
                );
                Err(self.error(span, message))
            }
            _ => Ok(()),
        }
    }

    /// What the vehicle can truly do.
    fn true_limits(&self, keys: &DriveKeys, truth: &mut TrueLimits) -> Result<(), SceneIoError> {
        const SLOPE: RangeInclusive<f64> = 0.0..=1e3;
        let limits = [
            ("slope_front", &keys.true_slope_front, &mut truth.front, SLOPE, "of rise over distance"),
            ("slope_rear", &keys.true_slope_rear, &mut truth.rear, SLOPE, "of rise over distance"),
            ("slope_length", &keys.true_slope_length, &mut truth.length, SLOPE, "of rise over distance"),
            ("clearance_m", &keys.true_clearance_m, &mut truth.clearance, VEHICLE_M, "metres"),
            ("step_m", &keys.true_step_m, &mut truth.step, 1e-3..=1e2, "metres"),
        ];
        for (name, key, slot, range, unit) in limits {
            *slot = self.optional(key, &format!("drive.true_{name}"), range, unit)?;
        }
        if let Some(mass) = &keys.true_centre_of_mass_m {
            let mass = self.list(mass, "drive.true_centre_of_mass_m", &[3], -1e2..=1e2, "metres")?;
            truth.centre_of_mass = Some(DVec3::from_slice(mass));
        }
        Ok(())
    }

    fn rules(&self, keys: &RuleKeys, plan: &mut DrivePlan) -> Result<(), SceneIoError> {
        let words = [
            &keys.start,
            &keys.elevation,
            &keys.extrapolate,
            &keys.several,
            &keys.inconsistency,
            &keys.gap,
            &keys.settle,
            &keys.tests,
        ];
        for (name, key) in RULE_NAMES.iter().zip(words) {
            let Some(key) = key else { continue };
            plan.set_rule(name, key.get_ref()).map_err(|expected| {
                let message =
                    format!("`drive.rules.{name}` is \"{}\"; expected one of {expected}", key.get_ref());
                self.error(key.span(), message)
            })?;
        }
        Ok(())
    }

    /// Number of points along a side of the map: odd, so that one is in the middle.
    fn odd(&self, key: &Spanned<i64>) -> Result<u32, SceneIoError> {
        match u32::try_from(*key.get_ref()) {
            Ok(points) if (3..=2001).contains(&points) && points % 2 == 1 => Ok(points),
            _ => {
                let points = key.get_ref();
                let message =
                    format!("`drive.map_points` is {points}; expected an odd number from 3 to 2001");
                Err(self.error(key.span(), message))
            }
        }
    }

    fn scans(&self, keys: &DriveKeys, plan: &mut DrivePlan) -> Result<(), SceneIoError> {
        let of_scans = [
            span(&keys.scan_every_m),
            span(&keys.scan_steps),
            span(&keys.scan_step_s),
            span(&keys.scan_from_deg),
            span(&keys.scan_to_deg),
            span(&keys.scan_inconsistency_m),
            span(&keys.scan_least_points),
        ];
        if keys.scans == Some(false) {
            plan.scans = None;
            return match of_scans.into_iter().flatten().next() {
                Some(span) => {
                    Err(self.error(span, "a scan's number beside `scans = false`; expected one of the two"))
                }
                None => Ok(()),
            };
        }
        let mut rule = ScanRule::default();
        let every = self.optional(&keys.scan_every_m, "drive.scan_every_m", 1e-3..=1e9, "metres")?;
        rule.every = every.or(rule.every);
        let sweep = &mut plan.sweep;
        self.integer(&keys.scan_steps, "drive.scan_steps", &mut sweep.steps, 1..=1000, "")?;
        self.number(&keys.scan_step_s, "drive.scan_step_s", &mut sweep.step_time, 0.0..=1e4, "seconds")?;
        let angles = [
            ("scan_from_deg", &keys.scan_from_deg, &mut sweep.from),
            ("scan_to_deg", &keys.scan_to_deg, &mut sweep.to),
        ];
        for (name, key, slot) in angles {
            let name = format!("drive.{name}");
            self.converted(key, &name, slot, -180.0..=180.0, "degrees", f64::to_radians)?;
        }
        let (key, name) = (&keys.scan_inconsistency_m, "drive.scan_inconsistency_m");
        rule.inconsistency = self.optional(key, name, 0.0..=1e3, "metres")?.or(rule.inconsistency);
        let (key, name) = (&keys.scan_least_points, "drive.scan_least_points");
        self.integer(key, name, &mut rule.least_points, 1..=1_000_000, "")?;
        plan.scans = Some(rule);
        Ok(())
    }

    fn localisation(&self, keys: &DriveKeys, plan: &mut DrivePlan) -> Result<(), SceneIoError> {
        let errors = &mut plan.errors;
        if let Some(drift) = &keys.position_drift_m_per_s {
            let name = "drive.position_drift_m_per_s";
            let drift = self.list(drift, name, &[2], -1e2..=1e2, "metres per second")?;
            errors.position_drift = DVec2::from_slice(drift);
        }
        let (walk, name) = (&keys.position_walk_m, "drive.position_walk_m");
        self.number(walk, name, &mut errors.position_walk, 0.0..=1e2, "metres")?;
        let bias = &mut errors.attitude_bias;
        let angles = [
            ("heading_bias_deg", &keys.heading_bias_deg, &mut bias.heading, -50.0, "degrees"),
            ("pitch_bias_deg", &keys.pitch_bias_deg, &mut bias.pitch_down, -50.0, "degrees"),
            ("roll_bias_deg", &keys.roll_bias_deg, &mut bias.roll_right, -50.0, "degrees"),
            (
                "heading_drift_deg_per_s",
                &keys.heading_drift_deg_per_s,
                &mut errors.heading_drift,
                -50.0,
                "degrees per second",
            ),
            ("attitude_noise_deg", &keys.attitude_noise_deg, &mut errors.attitude_noise, 0.0, "degrees"),
        ];
        for (name, key, slot, low, unit) in angles {
            self.converted(key, &format!("drive.{name}"), slot, low..=50.0, unit, f64::to_radians)?;
        }
        let (noise, name) = (&keys.proximity_noise_m, "drive.proximity_noise_m");
        self.number(noise, name, &mut errors.proximity_noise, 0.0..=1e2, "metres")?;

        if keys.fix_every_frames.is_none() {
            let Some(noise) = &keys.fix_noise_m else { return Ok(()) };
            let message = "`drive.fix_noise_m` is given; expected it only with `fix_every_frames`";
            return Err(self.error(noise.span(), message));
        }
        let mut fixes = PositionFixes { every_frames: 1, noise: 0.0 };
        let (every, name) = (&keys.fix_every_frames, "drive.fix_every_frames");
        self.integer(every, name, &mut fixes.every_frames, 1..=i64::MAX, "")?;
        self.number(&keys.fix_noise_m, "drive.fix_noise_m", &mut fixes.noise, 0.0..=1e3, "metres")?;
        errors.fixes = Some(fixes);
        Ok(())
    }
}
