//! `spinning = { ... }`: a preset, or elevations of one's own.

use serde::Deserialize;
use std::ops::RangeInclusive;
use toml::Spanned;

use raypencil_scene::pattern::{Channel, SPINNING_PRESETS, Spinning};

use crate::parse::key::{Key, span};
use crate::parse::rays::grid::{COUNT, RANGE_M};
use crate::parse::rays::keys::in_keys;
use crate::parse::source::Source;
use crate::scene_error::SceneIoError;

/// Turns of a head in a second.
const RATE_HZ: RangeInclusive<f64> = 1e-3..=1e3;

/// Relative difference of two rates, one of them from the step of the azimuth, that rounding to seven digits may leave.
const MAX_RATE_ERROR: f64 = 1e-6;

/// Turns of a head in a second, if the file gives none.
const DEFAULT_RATE_HZ: f64 = 10.0;

/// Azimuth, and its step, either way.
const AZIMUTH_DEG: RangeInclusive<f64> = -360.0..=360.0;

/// Maximum number of channels.
const MAX_CHANNELS: usize = 1024;

/// A list with one number for each channel: its key, its value, the range and the unit of its numbers, and where a number
/// belongs.
type ChannelList<'k> =
    (&'static str, &'k Key<Vec<f64>>, RangeInclusive<f64>, &'static str, fn(&mut Channel, f64));

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct SpinningKeys {
    preset: Key<String>,
    elevations_deg: Key<Vec<f64>>,
    azimuth_offsets_deg: Key<Vec<f64>>,
    vertical_offsets_mm: Key<Vec<f64>>,
    lateral_offsets_mm: Key<Vec<f64>>,
    firing_times_us: Key<Vec<f64>>,
    azimuth_start_deg: Key<f64>,
    azimuth_end_deg: Key<f64>,
    azimuth_step_deg: Key<f64>,
    steps: Key<i64>,
    rate_hz: Key<f64>,
    min_range_m: Key<f64>,
    max_range_m: Key<f64>,
}

impl Source<'_> {
    pub(super) fn spinning(
        &self,
        name: &str,
        table: &Spanned<SpinningKeys>,
    ) -> Result<Spinning, SceneIoError> {
        let keys = table.get_ref();
        let key = |key: &str| format!("{name}.{key}");
        let mut rate = DEFAULT_RATE_HZ;
        self.number(&keys.rate_hz, &key("rate_hz"), &mut rate, RATE_HZ, "turns a second")?;
        let mut head = match (&keys.preset, &keys.elevations_deg) {
            (Some(preset), None) => {
                let words = SPINNING_PRESETS.map(|name| (name, name));
                let word = self.word(preset, &key("preset"), &words)?;
                let Some(head) = Spinning::preset_at(word, rate) else { unreachable!("a word of the list") };
                head
            }
            (None, Some(_)) => Spinning {
                channels: Vec::new(),
                azimuth_start_deg: 0.0,
                azimuth_step_deg: f64::NAN,
                steps: 0,
                period_s: f64::NAN,
                min_range_m: 0.0,
                max_range_m: f64::INFINITY,
            },
            (given, _) => {
                let found = if given.is_some() { "both" } else { "none" };
                let message =
                    format!("`{name}` has {found} of `preset` and `elevations_deg`; expected exactly one");
                return Err(self.error(table.span(), message));
            }
        };
        self.channels(name, keys, &mut head.channels)?;
        let start = &mut head.azimuth_start_deg;
        self.number(&keys.azimuth_start_deg, &key("azimuth_start_deg"), start, AZIMUTH_DEG, "degrees")?;
        self.integer(&keys.steps, &key("steps"), &mut head.steps, COUNT, "")?;
        self.steps(name, table, rate, &mut head)?;
        self.number(&keys.min_range_m, &key("min_range_m"), &mut head.min_range_m, RANGE_M, "metres")?;
        self.number(&keys.max_range_m, &key("max_range_m"), &mut head.max_range_m, RANGE_M, "metres")?;
        head.validate(name).map_err(|error| self.refused(table.span(), &in_keys(error)))?;
        Ok(head)
    }

    /// Numbers of the channels. Each list has one number for each channel.
    fn channels(
        &self,
        name: &str,
        keys: &SpinningKeys,
        channels: &mut Vec<Channel>,
    ) -> Result<(), SceneIoError> {
        let key = |key: &str| format!("{name}.{key}");
        if let Some(list) = &keys.elevations_deg {
            let counts: Vec<usize> = (1..=MAX_CHANNELS).collect();
            if !counts.contains(&list.get_ref().len()) {
                let found = list.get_ref().len();
                let message = format!(
                    "`{}` has {found} numbers; expected 1 to {MAX_CHANNELS}, one for each channel",
                    key("elevations_deg")
                );
                return Err(self.error(list.span(), message));
            }
            let elevations = self.list(list, &key("elevations_deg"), &counts, -90.0..=90.0, "degrees")?;
            *channels = elevations.iter().map(|&elevation| Channel::at_elevation(elevation)).collect();
        }
        let count = channels.len();
        let lists: [ChannelList<'_>; 4] = [
            ("azimuth_offsets_deg", &keys.azimuth_offsets_deg, AZIMUTH_DEG, "degrees", |channel, value| {
                channel.azimuth_offset_deg = value
            }),
            (
                "vertical_offsets_mm",
                &keys.vertical_offsets_mm,
                -1e6..=1e6,
                "millimetres",
                |channel, value| channel.vertical_m = value / 1e3,
            ),
            ("lateral_offsets_mm", &keys.lateral_offsets_mm, -1e6..=1e6, "millimetres", |channel, value| {
                channel.lateral_m = value / 1e3
            }),
            ("firing_times_us", &keys.firing_times_us, 0.0..=1e9, "microseconds", |channel, value| {
                channel.firing_s = value / 1e6
            }),
        ];
        for (word, list, range, unit, put) in lists {
            let Some(list) = list else { continue };
            let numbers = self.list(list, &key(word), &[count], range, unit)?;
            channels.iter_mut().zip(numbers).for_each(|(channel, &number)| put(channel, number));
        }
        Ok(())
    }

    /// Step of the azimuth, number of steps and time between them.
    fn steps(
        &self,
        name: &str,
        table: &Spanned<SpinningKeys>,
        rate: f64,
        head: &mut Spinning,
    ) -> Result<(), SceneIoError> {
        let keys = table.get_ref();
        let key = |key: &str| format!("{name}.{key}");
        let step = self.optional(&keys.azimuth_step_deg, &key("azimuth_step_deg"), AZIMUTH_DEG, "degrees")?;
        // An end may be a whole turn from the start.
        let end = self.optional(&keys.azimuth_end_deg, &key("azimuth_end_deg"), -720.0..=720.0, "degrees")?;
        let is_free = keys.preset.is_none();
        let message = match (step, end) {
            (Some(_), Some(_)) => {
                Some("has `azimuth_step_deg` and `azimuth_end_deg`; expected one of the two")
            }
            (None, Some(_)) if keys.steps.is_none() => {
                Some("has `azimuth_end_deg` without `steps`; expected both")
            }
            _ if is_free && keys.steps.is_none() => Some("has no `steps`; expected their number"),
            _ => None,
        };
        if let Some(message) = message {
            let place = span(&keys.azimuth_end_deg).unwrap_or(table.span());
            return Err(self.error(place, format!("`{name}` {message}")));
        }
        let new = match (step, end) {
            (Some(step), _) => step,
            (_, Some(end)) => (end - head.azimuth_start_deg) / head.steps as f64,
            // A whole turn to the left.
            _ if is_free => 360.0 / head.steps as f64,
            _ => return Ok(()),
        };
        if new == 0.0 {
            let message = format!(
                "`{name}`: the step of the azimuth is 0; expected a step to the left or to the right"
            );
            return Err(self.error(table.span(), message));
        }
        head.azimuth_step_deg = new;
        let of_preset = keys.preset.as_ref().map(|preset| preset.get_ref().as_str());
        if !of_preset.is_some_and(Spinning::fires_at_its_own_pace) {
            head.period_s = new.abs() / (360.0 * rate);
            return Ok(());
        }
        // The period stays: the step says how fast the head turns.
        let turned = new.abs() / 360.0 / head.period_s;
        let period_us = head.period_s * 1e6;
        let message = match keys.rate_hz {
            Some(_) if (turned / rate - 1.0).abs() > MAX_RATE_ERROR => {
                let expected = 360.0 * rate * head.period_s;
                format!(
                    "a step of {} degrees at {rate} turns a second; expected {expected:.7}, for the preset has a firing sequence every \
                     {period_us:.3} µs",
                    new.abs()
                )
            }
            None if !RATE_HZ.contains(&turned) => {
                let (low, high) = (RATE_HZ.start(), RATE_HZ.end());
                format!(
                    "a step of {} degrees every {period_us:.3} µs is {turned:.0} turns a second; expected {low} to {high}",
                    new.abs()
                )
            }
            _ => return Ok(()),
        };
        Err(self.error(table.span(), format!("`{name}`: {message}")))
    }
}
