//! `[vehicle]` and `[[beam]]`, and what cameras and beams share.

use glam::DVec3;
use serde::Deserialize;
use std::ops::RangeInclusive;
use toml::Spanned;

use raypencil_scene::rig::DEFAULT_FAN_DEG;
use raypencil_scene::{Beam, Profile};

use crate::parse::key::{Key, span};
use crate::parse::shared::{FAN_DEG, GLOBAL_M, THICKNESS_MM, TURN_DEG};
use crate::parse::source::Source;
use crate::plan::{Mount, ScenePlan, default_beam};
use crate::scene_error::SceneIoError;

/// Coordinate of a sensor on the vehicle, metres.
const MOUNT_M: RangeInclusive<f64> = -1e3..=1e3;

/// Maximum range of a sensor, metres.
pub(super) const MAX_RANGE_M: RangeInclusive<f64> = 1e-3..=1e7;

/// Columns or rows of a sensor: the limits of the `scene` crate.
const COLUMNS_OR_ROWS: RangeInclusive<i64> = 1..=1 << 20;

/// Maximum cells of a sensor: the limit of the `scene` crate.
const MAX_CELLS: u64 = 1 << 26;

#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct VehicleKeys {
    position_m: Key<Vec<f64>>,
    heading_deg: Key<f64>,
    pitch_down_deg: Key<f64>,
    roll_right_deg: Key<f64>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct BeamKeys {
    position_m: Key<Vec<f64>>,
    pitch_down_deg: Key<f64>,
    yaw_left_deg: Key<f64>,
    roll_right_deg: Key<f64>,
    fan_deg: Key<f64>,
    thickness_mm: Key<f64>,
    grid_distance_mm: Key<f64>,
    columns: Key<i64>,
    rows: Key<i64>,
    power_w: Key<f64>,
    wavelength_nm: Key<f64>,
    profile: Key<String>,
    gaussian_half_width_deg: Key<f64>,
    max_range_m: Key<f64>,
}

// Divisions by a power of ten round once: 9 micrometres are the double nearest 9e-6. A product with 1e-6 rounds twice.

pub(super) fn from_millimetres(length: f64) -> f64 {
    length / 1e3
}

pub(super) fn from_micrometres(length: f64) -> f64 {
    length / 1e6
}

pub(super) fn from_nanometres(length: f64) -> f64 {
    length / 1e9
}

impl Source<'_> {
    pub(super) fn vehicle(&self, keys: &VehicleKeys, plan: &mut ScenePlan) -> Result<(), SceneIoError> {
        let vehicle = &mut plan.vehicle;
        if let Some(position) = &keys.position_m {
            plan.position_span = position.span();
            match *self.list(position, "vehicle.position_m", &[2, 3], GLOBAL_M, "metres")? {
                [x, y] => vehicle.position = [x, y],
                [x, y, z] => (vehicle.position, vehicle.height) = ([x, y], Some(z)),
                _ => unreachable!("two or three numbers"),
            }
        }
        self.number(&keys.heading_deg, "vehicle.heading_deg", &mut vehicle.heading_deg, TURN_DEG, "degrees")?;
        let pitch = &mut vehicle.pitch_down_deg;
        self.number(&keys.pitch_down_deg, "vehicle.pitch_down_deg", pitch, TURN_DEG, "degrees")?;
        let roll = &mut vehicle.roll_right_deg;
        self.number(&keys.roll_right_deg, "vehicle.roll_right_deg", roll, TURN_DEG, "degrees")
    }

    /// Keys that cameras and beams share. `turns` are those of pitch, yaw and roll.
    pub(super) fn mount(
        &self,
        sensor: &str,
        position: &Key<Vec<f64>>,
        turns: [&Key<f64>; 3],
        mount: &mut Mount,
    ) -> Result<(), SceneIoError> {
        if let Some(position) = position {
            let name = format!("{sensor}.position_m");
            mount.position = DVec3::from_slice(self.list(position, &name, &[3], MOUNT_M, "metres")?);
        }
        let slots = [
            ("pitch_down_deg", &mut mount.pitch_down_deg),
            ("yaw_left_deg", &mut mount.yaw_left_deg),
            ("roll_right_deg", &mut mount.roll_right_deg),
        ];
        for (key, (name, slot)) in turns.into_iter().zip(slots) {
            self.number(key, &format!("{sensor}.{name}"), slot, TURN_DEG, "degrees")?;
        }
        Ok(())
    }

    pub(super) fn beam(&self, index: usize, keys: &BeamKeys) -> Result<(Mount, Beam), SceneIoError> {
        let (mut mount, mut beam) = default_beam(index);
        let name = format!("beam.{index}");
        let key = |key: &str| format!("{name}.{key}");
        let turns = [&keys.pitch_down_deg, &keys.yaw_left_deg, &keys.roll_right_deg];
        self.mount(&name, &keys.position_m, turns, &mut mount)?;
        let mut fan_deg = DEFAULT_FAN_DEG;
        self.number(&keys.fan_deg, &key("fan_deg"), &mut fan_deg, FAN_DEG, "degrees")?;
        self.converted(
            &keys.thickness_mm,
            &key("thickness_mm"),
            &mut beam.thickness,
            THICKNESS_MM,
            "millimetres",
            from_millimetres,
        )?;
        self.converted(
            &keys.grid_distance_mm,
            &key("grid_distance_mm"),
            &mut beam.grid_distance,
            0.1..=1e5,
            "millimetres",
            from_millimetres,
        )?;
        beam.half_width = Beam::half_width_of(beam.grid_distance, fan_deg.to_radians());
        let sides = [("columns", &keys.columns), ("rows", &keys.rows)];
        self.cells(&name, sides, [&mut beam.columns, &mut beam.rows], "pencils")?;
        self.number(&keys.power_w, &key("power_w"), &mut beam.power, 0.0..=1e6, "watts")?;
        self.converted(
            &keys.wavelength_nm,
            &key("wavelength_nm"),
            &mut beam.wavelength,
            10.0..=1e6,
            "nanometres",
            from_nanometres,
        )?;
        self.number(&keys.max_range_m, &key("max_range_m"), &mut beam.max_range, MAX_RANGE_M, "metres")?;
        beam.profile = self.profile(&name, keys)?;
        Ok((mount, beam))
    }

    fn profile(&self, beam: &str, keys: &BeamKeys) -> Result<Profile, SceneIoError> {
        let paper = Spanned::new(0..0, "paper".to_string());
        let width = &keys.gaussian_half_width_deg;
        let width_key = "gaussian_half_width_deg";
        match self.profile_word(beam, keys.profile.as_ref().unwrap_or(&paper), width, width_key)? {
            Profile::Gaussian { half_width } => {
                let place = span(width).unwrap_or(0..0);
                self.check(half_width, place, &format!("{beam}.{width_key}"), 1e-3..=1e4, "degrees")?;
                Ok(Profile::Gaussian { half_width: half_width.to_radians() })
            }
            other => Ok(other),
        }
    }

    /// Columns and rows of a sensor: each in range, and their product too.
    pub(super) fn cells(
        &self,
        sensor: &str,
        keys: [(&str, &Key<i64>); 2],
        mut slots: [&mut u32; 2],
        unit: &str,
    ) -> Result<(), SceneIoError> {
        for ((name, key), slot) in keys.into_iter().zip(&mut slots) {
            self.integer(key, &format!("{sensor}.{name}"), *slot, COLUMNS_OR_ROWS, unit)?;
        }
        let [across, down] = slots.map(|side| *side);
        if u64::from(across) * u64::from(down) > MAX_CELLS {
            let [(columns, _), (rows, _)] = keys;
            let message = format!(
                "`{sensor}.{columns} x {rows}` is {across} x {down}; expected at most {MAX_CELLS} {unit}"
            );
            // The later of the two is marked.
            let place = keys.iter().rev().find_map(|(_, key)| span(key)).unwrap_or(0..0);
            return Err(self.error(place, message));
        }
        Ok(())
    }
}
