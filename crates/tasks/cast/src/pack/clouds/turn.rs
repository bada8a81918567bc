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
