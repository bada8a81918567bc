//! How a spinning head turns, from its rays and their times.

use glam::DVec3;
use raypencil_scene::{CastRay, Pose};

use crate::pack::scan::Scan;

/// The turn of a spinning head about its z axis.
pub(super) struct Turn {
    /// Number of channels.
    pub(super) channels: usize,
    /// Turn from one firing sequence to the next, degrees, positive to the left.
    pub(super) step_deg: f64,
    /// Time of the first firing, seconds.
    start_s: f64,
    /// Time from one sequence to the next, seconds.
    period_s: f64,
}

impl Turn {
    /// The turn of a head of two sequences or more; `None` for any other pattern.
    pub(super) fn of(scan: &Scan, shape: &[u64], rays: &[CastRay]) -> Option<Self> {
        let times = scan.times.as_ref()?;
        let &[sequences, channels] = shape else { return None };
        if sequences < 2 || scan.elevations_deg.is_none() {
            return None;
        }
        let channels = channels as usize;
        // A channel that looks straight up has no azimuth.
        let level = |channel: &usize| {
            let direction = scan.in_pattern(*channel, &rays[*channel]).direction;
            direction.x * direction.x + direction.y * direction.y > 1e-6 * direction.length_squared()
        };
        let channel = (0..channels).find(level)?;
        let azimuth = |index: usize| azimuth_deg(scan.in_pattern(index, &rays[index]).direction);
        // Over many sequences the rounding of the directions is divided by their number, as long as the turn stays below half a
        // round.
        let one = wrapped_deg(azimuth(channel + channels) - azimuth(channel));
        let many = ((90.0 / one.abs()) as u64).clamp(1, sequences - 1);
        let rest =
            wrapped_deg(azimuth(channel + many as usize * channels) - azimuth(channel) - one * many as f64);
        let step_deg = one + rest / many as f64;
        let last = (sequences as usize - 1) * channels;
        let period_s = (times[last] - times[0]) / (sequences - 1) as f64;
        let start_s = times.iter().copied().fold(f64::INFINITY, f64::min);
        (step_deg != 0.0 && period_s > 0.0).then_some(Self { channels, step_deg, start_s, period_s })
    }

    /// Sequences from the start to a time, with the part of one.
    pub(super) fn sequences(&self, time_s: f64) -> f64 {
        (time_s - self.start_s) / self.period_s
    }
}

/// Azimuth of a vector, to the left of x, degrees.
pub(super) fn azimuth_deg(v: DVec3) -> f64 {
    libm::atan2(v.y, v.x).to_degrees()
}

/// The same angle from -180 to 180 degrees.
pub(super) fn wrapped_deg(angle: f64) -> f64 {
    angle - 360.0 * (angle / 360.0).round()
}

/// A ray turned about z to the left, degrees.
pub(super) fn turned(ray: &CastRay, by_deg: f64) -> CastRay {
    let pose = Pose::from_axis_angle(DVec3::Z, by_deg.to_radians());
    crate::pack::scan::moved(&pose, ray)
}

#[cfg(test)]
mod tests {
    use super::*;
    use raypencil_scene::pattern::Mounting;

    /// A head of three channels and eight sequences, a thousandth of a second each, from 178 degrees on. Its first channel looks
    /// straight up, but for rounding.
    fn head(step_deg: f64, channels: usize) -> (Scan, Vec<CastRay>) {
        let direction = |sequence: usize, channel: usize| {
            let azimuth = (178.0 + step_deg * sequence as f64).to_radians();
            let level = DVec3::new(libm::cos(azimuth), libm::sin(azimuth), 0.0);
            match channel {
                0 => DVec3::new(1e-17, if sequence.is_multiple_of(2) { 1e-17 } else { -1e-17 }, 1.0),
                _ => level + 0.1 * channel as f64 * DVec3::Z,
            }
        };
        let each = (0..8).flat_map(|sequence| (0..channels).map(move |channel| (sequence, channel)));
        let rays =
            each.clone().map(|(sequence, channel)| CastRay::new(DVec3::ZERO, direction(sequence, channel)));
        let times = each.map(|(sequence, channel)| 0.25 + 1e-3 * sequence as f64 + 1e-5 * channel as f64);
        let scan = Scan {
            times: Some(times.collect()),
            elevations_deg: Some(vec![90.0, 6.0, 11.0]),
            mounting: Mounting::HERE,
            ends: [Pose::IDENTITY; 2],
            returns: None,
        };
        (scan, rays.collect())
    }

    #[test]
    fn a_turn_is_that_of_a_channel_that_has_an_azimuth() {
        for step_deg in [5.0, -3.0] {
            let (scan, rays) = head(step_deg, 3);
            let turn = Turn::of(&scan, &[8, 3], &rays).expect("a turn");
            assert!((turn.step_deg - step_deg).abs() < 1e-12, "{} {step_deg}", turn.step_deg);
            assert_eq!(turn.channels, 3);
            // Half of the way from the third sequence to the next.
            assert!((turn.sequences(0.2535) - 3.5).abs() < 1e-9, "{}", turn.sequences(0.2535));
        }
        // Nothing that looks elsewhere than up, and nothing that turns.
        let (scan, rays) = head(5.0, 1);
        assert!(Turn::of(&scan, &[8, 1], &rays).is_none());
        let (scan, rays) = head(0.0, 3);
        assert!(Turn::of(&scan, &[8, 3], &rays).is_none());
    }

    #[test]
    fn angles_are_wrapped_to_half_a_turn_on_either_side() {
        for (angle, wrapped) in [(10.0, 10.0), (-170.0, -170.0), (358.0, -2.0), (-190.0, 170.0), (725.0, 5.0)]
        {
            assert_eq!(wrapped_deg(angle), wrapped, "{angle}");
        }
    }
}
