//! `[drive]`: where the rover goes, and what of it is not as the rover's own defaults have it.

use serde::Deserialize;
use std::ops::RangeInclusive;
use toml::Spanned;

use crate::drive::camera_keys::{ElectronicsKeys, KernelPart, OpticsKeys};
use crate::drive::settings::{DetectionWord, DriveSettings, PlaceWord, SensorWord, SunSettings};
use crate::keys::Key;
use crate::parse::{GLOBAL_M, Source};
use crate::scene_error::SceneIoError;

/// Metres of a vehicle: what the rover itself takes.
const VEHICLE_M: RangeInclusive<f64> = 1e-2..=1e2;

/// Waypoints of a route.
const MOST_WAYPOINTS: usize = 10_000;

/// The keys as they stand in the file.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct DriveKeys {
    waypoints_m: Spanned<Vec<Spanned<Vec<f64>>>>,
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
    detection: Key<String>,
    threshold_dn: Key<f64>,
    place: Key<String>,
    least_rows: Key<i64>,
    map_spacing_m: Key<f64>,
    map_points: Key<i64>,
    obstacles_every_frames: Key<i64>,
    cross_gaps: Option<bool>,
    slope_front: Key<f64>,
    slope_rear: Key<f64>,
    slope_length: Key<f64>,
    slope_closer: Key<f64>,
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

/// `sun`.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct SunKeys {
    elevation_deg: Spanned<f64>,
    azimuth_deg: Key<f64>,
    optical_depth: Key<f64>,
    irradiance_w_per_m2_nm: Key<f64>,
}

impl Source<'_> {
    /// The drive, and the files of its optics' kernels.
    pub(crate) fn drive(&self, keys: DriveKeys) -> Result<(DriveSettings, Vec<KernelPart>), SceneIoError> {
        let mut drive = DriveSettings { waypoints: self.waypoints(&keys.waypoints_m)?, ..Default::default() };
        let real = |key: Key<f64>, name: &str, range, unit: &str| self.drive_number(key, name, range, unit);
        let whole = |key: Key<i64>, name: &str, range| self.whole(key, name, range);
        let degrees = |value: Option<f64>| value.map(f64::to_radians);

        drive.speed = real(keys.speed_m_per_s, "speed_m_per_s", 1e-4..=1e2, "metres per second")?;
        let turn = real(keys.turn_deg_per_s, "turn_deg_per_s", 1e-2..=3600.0, "degrees per second")?;
        drive.turn_rate = degrees(turn);
        drive.frame_rate = real(keys.frames_per_s, "frames_per_s", 1e-3..=1e4, "per second")?;
        drive.seed = whole(keys.seed, "seed", 0..=i64::MAX)?;

        let sensors = [SensorWord::Ideal, SensorWord::Ccd1989, SensorWord::Cmos].map(|one| (one.word(), one));
        drive.sensor = self.one_of(keys.sensor, "sensor", &sensors)?;
        drive.sensor_seed = whole(keys.sensor_seed, "sensor_seed", 0..=i64::MAX)?;
        drive.sun = keys.sun.map(|sun| self.sun(sun)).transpose()?;
        drive.subtract_unlit = keys.subtract_unlit;
        drive.pencils_per_pixel = real(keys.pencils_per_pixel, "pencils_per_pixel", 0.1..=64.0, "pencils")?;
        let exposures = [("in_turn", false), ("together", true)];
        drive.lit_together = self.one_of(keys.exposures, "exposures", &exposures)?;

        let detections = [
            ("fixed", DetectionWord::Fixed),
            ("otsu", DetectionWord::Otsu),
            ("gradient", DetectionWord::Gradient),
        ];
        drive.detection = self.one_of(keys.detection, "detection", &detections)?;
        if let (Some(DetectionWord::Otsu), Some(threshold)) = (drive.detection, &keys.threshold_dn) {
            let message = "`drive.threshold_dn` is given; expected none with detection = \"otsu\"";
            return Err(self.error(threshold.span(), message));
        }
        drive.threshold = real(keys.threshold_dn, "threshold_dn", 1e-3..=65535.0, "digital numbers")?;
        let places = [
            ("pixel", PlaceWord::Pixel),
            ("sub_pixel", PlaceWord::SubPixel),
            ("centroid", PlaceWord::Centroid),
        ];
        drive.place = self.one_of(keys.place, "place", &places)?;
        drive.least_rows = self.drive_count(keys.least_rows, "least_rows", 1..=1_000_000)?;

        drive.map_spacing = real(keys.map_spacing_m, "map_spacing_m", 1e-3..=1e3, "metres")?;
        drive.map_points = self.odd(keys.map_points)?;
        drive.obstacles_every = whole(keys.obstacles_every_frames, "obstacles_every_frames", 1..=i64::MAX)?;
        drive.cross_gaps = keys.cross_gaps;

        let slope = |key, name: &str| real(key, name, 0.0..=1e3, "of rise over distance");
        drive.slopes = [
            slope(keys.slope_front, "slope_front")?,
            slope(keys.slope_rear, "slope_rear")?,
            slope(keys.slope_length, "slope_length")?,
            slope(keys.slope_closer, "slope_closer")?,
        ];
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
        drive.grid_radii = [
            real(keys.grid_first_m, "grid_first_m", 0.0..=1e3, "metres")?,
            real(keys.grid_last_m, "grid_last_m", 0.0..=1e3, "metres")?,
            real(keys.grid_step_m, "grid_step_m", 1e-3..=1e3, "metres")?,
        ];
        let half_angle = real(keys.grid_half_angle_deg, "grid_half_angle_deg", 0.0..=180.0, "degrees")?;
        drive.grid_half_angle = degrees(half_angle);
        drive.grid_sectors = self.drive_count(keys.grid_sectors, "grid_sectors", 1..=100_000)?;
        drive.vector_large = real(keys.vector_large_m, "vector_large_m", 0.0..=1e3, "metres")?;
        drive.vector_small = real(keys.vector_small_m, "vector_small_m", 0.0..=1e3, "metres")?;

        let of_scans = [
            span(&keys.scan_every_m),
            span(&keys.scan_steps),
            span(&keys.scan_from_deg),
            span(&keys.scan_to_deg),
            span(&keys.scan_inconsistency_m),
            span(&keys.scan_least_points),
        ];
        if let (Some(false), Some(span)) = (keys.scans, of_scans.into_iter().flatten().next()) {
            return Err(self.error(span, "a scan's number beside `scans = false`; expected one of the two"));
        }
        drive.scans = keys.scans;
        drive.scan_every = real(keys.scan_every_m, "scan_every_m", 1e-3..=1e9, "metres")?;
        drive.scan_steps = self.drive_count(keys.scan_steps, "scan_steps", 1..=1000)?;
        drive.scan_angles = [
            degrees(real(keys.scan_from_deg, "scan_from_deg", -180.0..=180.0, "degrees")?),
            degrees(real(keys.scan_to_deg, "scan_to_deg", -180.0..=180.0, "degrees")?),
        ];
        drive.scan_inconsistency =
            real(keys.scan_inconsistency_m, "scan_inconsistency_m", 0.0..=1e3, "metres")?;
        drive.scan_least_points =
            self.drive_count(keys.scan_least_points, "scan_least_points", 1..=1_000_000)?;

        drive.wheelbase = real(keys.wheelbase_m, "wheelbase_m", VEHICLE_M, "metres")?;
        drive.track = real(keys.track_m, "track_m", VEHICLE_M, "metres")?;
        drive.wheel_radius = real(keys.wheel_radius_m, "wheel_radius_m", VEHICLE_M, "metres")?;
        drive.wheel_width = real(keys.wheel_width_m, "wheel_width_m", VEHICLE_M, "metres")?;
        drive.clearance = real(keys.clearance_m, "clearance_m", VEHICLE_M, "metres")?;

        if let Some(drift) = keys.position_drift_m_per_s {
            let name = "drive.position_drift_m_per_s";
            let numbers = self.list(&drift, name, &[2], -1e2..=1e2, "metres per second")?;
            drive.position_drift = Some([numbers[0], numbers[1]]);
        }
        drive.position_walk = real(keys.position_walk_m, "position_walk_m", 0.0..=1e2, "metres")?;
        let bias = |key, name: &str| real(key, name, -50.0..=50.0, "degrees").map(degrees);
        drive.attitude_bias = [
            bias(keys.heading_bias_deg, "heading_bias_deg")?,
            bias(keys.pitch_bias_deg, "pitch_bias_deg")?,
            bias(keys.roll_bias_deg, "roll_bias_deg")?,
        ];
        let drift = keys.heading_drift_deg_per_s;
        drive.heading_drift =
            degrees(real(drift, "heading_drift_deg_per_s", -50.0..=50.0, "degrees per second")?);
        drive.attitude_noise =
            degrees(real(keys.attitude_noise_deg, "attitude_noise_deg", 0.0..=50.0, "degrees")?);
        drive.proximity_noise = real(keys.proximity_noise_m, "proximity_noise_m", 0.0..=1e2, "metres")?;
        if let (None, Some(noise)) = (&keys.fix_every_frames, &keys.fix_noise_m) {
            let message = "`drive.fix_noise_m` is given; expected it only with `fix_every_frames`";
            return Err(self.error(noise.span(), message));
        }
        drive.fix_every = whole(keys.fix_every_frames, "fix_every_frames", 1..=i64::MAX)?;
        drive.fix_noise = real(keys.fix_noise_m, "fix_noise_m", 0.0..=1e3, "metres")?;
        let mut kernels = Vec::new();
        if let Some(keys) = keys.optics {
            (drive.optics, kernels) = self.optics(keys)?;
        }
        if let Some(keys) = keys.electronics {
            drive.electronics = self.electronics(keys)?;
        }
        Ok((drive, kernels))
    }

    fn sun(&self, keys: SunKeys) -> Result<SunSettings, SceneIoError> {
        let elevation = keys.elevation_deg;
        self.check(*elevation.get_ref(), elevation.span(), "drive.sun.elevation_deg", 0.0..=90.0, "degrees")?;
        let azimuth = self.drive_number(keys.azimuth_deg, "sun.azimuth_deg", -360.0..=360.0, "degrees")?;
        let depth = self.drive_number(keys.optical_depth, "sun.optical_depth", 0.0..=10.0, "of dust")?;
        let name = "sun.irradiance_w_per_m2_nm";
        let irradiance = self.drive_number(keys.irradiance_w_per_m2_nm, name, 0.0..=100.0, "W/m^2 per nm")?;
        Ok(SunSettings {
            elevation: elevation.get_ref().to_radians(),
            azimuth: azimuth.unwrap_or(0.0).to_radians(),
            // CHOICE: a clear day on Mars.
            optical_depth: depth.unwrap_or(0.5),
            spectral_irradiance: irradiance.map(|watts| watts * 1e9),
        })
    }

    fn waypoints(&self, list: &Spanned<Vec<Spanned<Vec<f64>>>>) -> Result<Vec<[f64; 2]>, SceneIoError> {
        let count = list.get_ref().len();
        if !(1..=MOST_WAYPOINTS).contains(&count) {
            let message = format!("`drive.waypoints_m` has {count} places; expected 1 to {MOST_WAYPOINTS}");
            return Err(self.error(list.span(), message));
        }
        let place = |key| {
            let numbers = self.list(key, "drive.waypoints_m", &[2], GLOBAL_M, "metres")?;
            Ok([numbers[0], numbers[1]])
        };
        list.get_ref().iter().map(place).collect()
    }

    /// A number in range, if it is given.
    pub(super) fn drive_number(
        &self,
        key: Key<f64>,
        name: &str,
        range: RangeInclusive<f64>,
        unit: &str,
    ) -> Result<Option<f64>, SceneIoError> {
        let Some(key) = key else { return Ok(None) };
        self.check(*key.get_ref(), key.span(), &format!("drive.{name}"), range, unit)?;
        Ok(Some(key.into_inner()))
    }

    /// A whole number in range, none of which is below zero.
    fn whole(
        &self,
        key: Key<i64>,
        name: &str,
        range: RangeInclusive<i64>,
    ) -> Result<Option<u64>, SceneIoError> {
        let Some(key) = key else { return Ok(None) };
        if !range.contains(key.get_ref()) {
            let (low, high) = (range.start(), range.end());
            let message = format!("`drive.{name}` is {}; expected {low} to {high}", key.get_ref());
            return Err(self.error(key.span(), message));
        }
        Ok(Some(key.into_inner().unsigned_abs()))
    }

    /// A small whole number in range, if it is given.
    pub(super) fn drive_count(
        &self,
        key: Key<i64>,
        name: &str,
        range: RangeInclusive<i64>,
    ) -> Result<Option<u32>, SceneIoError> {
        Ok(small(self.whole(key, name, range)?))
    }

    /// Points along a side of the map: an odd number, so that there is a middle one.
    fn odd(&self, key: Key<i64>) -> Result<Option<u32>, SceneIoError> {
        let Some(key) = key else { return Ok(None) };
        let points = *key.get_ref();
        if !(3..=2001).contains(&points) || points % 2 == 0 {
            let message = format!("`drive.map_points` is {points}; expected an odd number from 3 to 2001");
            return Err(self.error(key.span(), message));
        }
        Ok(small(Some(points.unsigned_abs())))
    }

    fn one_of<T: Copy>(
        &self,
        key: Key<String>,
        name: &str,
        words: &[(&str, T)],
    ) -> Result<Option<T>, SceneIoError> {
        key.map(|key| self.word(&key, &format!("drive.{name}"), words)).transpose()
    }
}

/// Where a key's value stands in the file, if it is given.
fn span<T>(key: &Key<T>) -> Option<std::ops::Range<usize>> {
    key.as_ref().map(Spanned::span)
}

/// A number that is known to be small.
fn small(value: Option<u64>) -> Option<u32> {
    value.map(|value| u32::try_from(value).unwrap_or(u32::MAX))
}
