//! A head that spins about z and fires its channels one after the other.

use std::ops::Range;

use glam::DVec3;

use super::{Mounting, PatternRays, check_ranges, check_rays, direction, sincos_deg};
use crate::error::{check_count, check_range};
use crate::{CastRay, SceneError};

/// One laser of a spinning head.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Channel {
    /// Angle up from the horizontal plane, degrees.
    pub elevation_deg: f64,
    /// Angle from the head's azimuth to the left, degrees.
    pub azimuth_offset_deg: f64,
    /// Height of the emitter above the pattern's origin, metres.
    pub vertical_m: f64,
    /// Distance of the emitter from the axis, to the left of the beam, metres.
    pub lateral_m: f64,
    /// Time from the start of the firing sequence, seconds.
    pub firing_s: f64,
}

impl Channel {
    /// A channel that fires at once, from the axis.
    pub fn at_elevation(elevation_deg: f64) -> Self {
        Self { elevation_deg, azimuth_offset_deg: 0.0, vertical_m: 0.0, lateral_m: 0.0, firing_s: 0.0 }
    }
}

/// A head that spins about z. Firing sequence k starts at k periods, and the channels fire within it at their own
/// times. The head turns on meanwhile: a channel that fires at the time t of the pattern stands at the azimuth
/// start + step t / period, plus its own offset.
///
/// ```
/// use raypencil_scene::pattern::Spinning;
///
/// let spinning = Spinning::preset("vlp-16").expect("a preset");
/// let pattern = spinning.rays("rays")?;
/// assert_eq!(pattern.shape, [1808, 16]);
/// // Channel 0 fires first: forward and 15 degrees down. Channel 1 fires 2.304 us later, 1 degree up, a little to the right:
/// // this head turns clockwise.
/// let [first, second] = [pattern.rays[0].direction, pattern.rays[1].direction];
/// assert!((first.z - -0.25881904510252074).abs() < 1e-16 && first.y == 0.0);
/// assert!(second.z > 0.0 && second.y < 0.0);
/// # Ok::<(), raypencil_scene::SceneError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Spinning {
    /// The channels, in the order of the sensor's manual.
    pub channels: Vec<Channel>,
    /// Azimuth at time 0, degrees.
    pub azimuth_start_deg: f64,
    /// Turn of the head from one firing sequence to the next, degrees: positive to the left, negative clockwise.
    pub azimuth_step_deg: f64,
    /// Number of firing sequences.
    pub steps: u64,
    /// Time from one firing sequence to the next, seconds.
    pub period_s: f64,
    /// Shortest range, metres: a nearest hit before it is too near ([`CastRay::t_blind`]), and nothing is seen behind it.
    pub min_range_m: f64,
    /// Longest range, metres.
    pub max_range_m: f64,
}

impl Spinning {
    /// Turns of the head in a second.
    pub fn rate_hz(&self) -> f64 {
        self.azimuth_step_deg.abs() / (360.0 * self.period_s)
    }

    /// Refuses a head that no sensor has. `field` names it.
    ///
    /// # Errors
    /// Names the first part that is wrong, its value and what is expected.
    pub fn validate(&self, field: &str) -> Result<(), SceneError> {
        let name = |part: &str| format!("{field}.{part}");
        check_count(|| name("channels"), self.channels.len() as u64, 1, 1024)?;
        check_count(|| name("steps"), self.steps, 1, super::MAX_RAYS)?;
        check_range(|| name("azimuth_start"), self.azimuth_start_deg, -360.0, 360.0, "degrees")?;
        check_range(|| name("azimuth_step"), self.azimuth_step_deg, -360.0, 360.0, "degrees")?;
        check_range(|| name("period"), self.period_s, 1e-12, 1e6, "s")?;
        for (index, channel) in self.channels.iter().enumerate() {
            let name = |part: &str| format!("{field}.channels[{index}].{part}");
            check_range(|| name("elevation"), channel.elevation_deg, -90.0, 90.0, "degrees")?;
            check_range(|| name("azimuth_offset"), channel.azimuth_offset_deg, -360.0, 360.0, "degrees")?;
            check_range(|| name("vertical"), channel.vertical_m, -1e3, 1e3, "m")?;
            check_range(|| name("lateral"), channel.lateral_m, -1e3, 1e3, "m")?;
            check_range(|| name("firing"), channel.firing_s, 0.0, self.period_s, "s")?;
        }
        check_ranges(field, self.min_range_m, self.max_range_m)?;
        check_rays(field, &[self.steps, self.channels.len() as u64])
    }

    /// The rays, of shape (steps, channels), with their times. `field` names the head in messages.
    ///
    /// # Errors
    /// As [`Spinning::validate`].
    pub fn rays(&self, field: &str) -> Result<PatternRays, SceneError> {
        self.rays_of(0..self.steps, field)
    }

    /// The rays of some firing sequences alone, as they are among those of all.
    ///
    /// # Errors
    /// As [`Spinning::validate`].
    pub fn rays_of(&self, sequences: Range<u64>, field: &str) -> Result<PatternRays, SceneError> {
        self.validate(field)?;
        let sequences = sequences.start.min(self.steps)..sequences.end.min(self.steps);
        let steps = sequences.end.saturating_sub(sequences.start);
        let count = steps as usize * self.channels.len();
        let (mut rays, mut times) = (Vec::with_capacity(count), Vec::with_capacity(count));
        for step in sequences {
            for channel in &self.channels {
                let turns = step as f64 + channel.firing_s / self.period_s;
                let azimuth =
                    self.azimuth_start_deg + self.azimuth_step_deg * turns + channel.azimuth_offset_deg;
                let (sin, cos) = sincos_deg(azimuth);
                rays.push(CastRay {
                    origin: DVec3::new(-channel.lateral_m * sin, channel.lateral_m * cos, channel.vertical_m),
                    direction: direction(azimuth, channel.elevation_deg),
                    t_min: 0.0,
                    t_max: self.max_range_m,
                    t_blind: self.min_range_m,
                });
                times.push(step as f64 * self.period_s + channel.firing_s);
            }
        }
        Ok(PatternRays {
            shape: vec![steps, self.channels.len() as u64],
            rays,
            times: Some(times),
            weights: None,
            returns: None,
            elevations_deg: Some(self.channels.iter().map(|channel| channel.elevation_deg).collect()),
            mounting: Mounting::HERE,
        })
    }
}
