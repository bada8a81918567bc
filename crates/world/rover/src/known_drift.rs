//! How far measured ground moves away from where the vehicle believes it to be: by the declared drift of its sensors.

use crate::localisation::{LocalisationErrors, PositionFixes};

/// Drift of the vehicle's position and heading, as its makers state it. The default has none.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct KnownDrift {
    /// Time from one frame to the next, seconds.
    pub frame_time: f64,
    /// Drift of the measured position, metres per second, in any direction.
    pub position: f64,
    /// Random walk of the measured position: standard deviation in x and in y after one second, metres.
    pub walk: f64,
    /// Drift of the measured heading, radians per second, either way.
    pub heading: f64,
    /// Position fixes, which end the drift of the position so far.
    pub fixes: Option<PositionFixes>,
}

impl KnownDrift {
    /// The drift of sensors with these errors, of which a data sheet has the sizes but not the directions.
    pub fn of(errors: &LocalisationErrors, frame_rate: f64) -> Self {
        Self {
            frame_time: 1.0 / frame_rate,
            position: errors.position_drift.length(),
            walk: errors.position_walk,
            heading: errors.heading_drift.abs(),
            fixes: errors.fixes,
        }
    }

    /// Variance of the displacement in plan, in any one direction, of ground that was measured in frame `then` against the
    /// vehicle in frame `now`, square metres. Since then it has driven `way` metres, and the ground is now `away` metres from it.
    /// `paused`: time of all pauses before a frame, seconds.
    pub(crate) fn displacement_variance(
        &self,
        then: u64,
        now: u64,
        way: f64,
        away: f64,
        paused: impl Fn(u64) -> f64,
    ) -> f64 {
        let square = |x: f64| x * x;
        let seconds = |from: u64, to: u64| {
            to.saturating_sub(from) as f64 * self.frame_time + (paused(to) - paused(from))
        };
        let since = seconds(then, now);
        let drifted = |time: f64| square(self.position * time) + square(self.walk) * time;
        let by_position = match self.fixes {
            // Both positions have the error of their own fix, and what was added since.
            Some(PositionFixes { every_frames, noise })
                if last_fix(then, every_frames) != last_fix(now, every_frames) =>
            {
                let error =
                    |frame: u64| square(noise) + drifted(seconds(last_fix(frame, every_frames), frame));
                error(then) + error(now)
            }
            _ => drifted(since),
        };
        // The heading was wrong by its drift since the start. The ground was placed beside its place by that angle over the
        // distance from which it was seen; what is left of it now is the angle over the way, and the drift since over the rest.
        by_position + square(self.heading * (way * seconds(0, then) + away * since))
    }
}

/// The last frame with a fix, up to this one. Frame 0 has one.
fn last_fix(frame: u64, every: u64) -> u64 {
    frame - frame % every.max(1)
}

#[cfg(test)]
mod tests {
    use glam::DVec2;

    use super::*;

    /// The standard deviation of the displacement, metres, at ten frames a second.
    fn displaced(errors: LocalisationErrors, then: u64, now: u64, way: f64, away: f64) -> f64 {
        KnownDrift::of(&errors, 10.0).displacement_variance(then, now, way, away, |_| 0.0).sqrt()
    }

    #[test]
    fn perfect_sensors_displace_nothing() {
        assert_eq!(displaced(LocalisationErrors::default(), 3, 1000, 30.0, 5.0), 0.0);
    }

    #[test]
    fn positions_drift_with_time_and_walk_with_its_root() {
        // 5 mm a second, for 20 s. A walk of 5 mm in a second: in 16 s four times that.
        let drift = LocalisationErrors { position_drift: DVec2::new(-0.003, 0.004), ..Default::default() };
        assert!((displaced(drift, 50, 250, 6.0, 1.0) - 0.1).abs() < 1e-12);
        let walk = LocalisationErrors { position_walk: 0.005, ..Default::default() };
        assert!((displaced(walk, 50, 210, 6.0, 1.0) - 0.02).abs() < 1e-12);
        // With a fix every 10 s, of 3 cm: one second after a fix, and two seconds after a later one, each position has the
        // error of its fix and 5 or 10 mm of drift. Between fixes they change nothing.
        let fixed =
            LocalisationErrors { fixes: Some(PositionFixes { every_frames: 100, noise: 0.03 }), ..drift };
        let expected = (2.0 * 0.03_f64 * 0.03 + 0.005 * 0.005 + 0.01 * 0.01).sqrt();
        assert!((displaced(fixed, 110, 920, 6.0, 1.0) - expected).abs() < 1e-12);
        assert!((displaced(fixed, 110, 120, 6.0, 1.0) - 0.005).abs() < 1e-12);
    }

    #[test]
    fn a_pause_is_time_that_drifts() {
        // 5 mm a second; a pause of 8 s after frame 60 makes 28 s of 20 s. Nothing before it is older by it, nor what is
        // measured after it. The heading was wrong by 6 s of drift before the pause, and by 14 s after it.
        let errors = LocalisationErrors { position_drift: DVec2::new(-0.003, 0.004), ..Default::default() };
        let paused = |frame: u64| if frame > 60 { 8.0 } else { 0.0 };
        let moved = |errors: &LocalisationErrors, then, now, way, away| {
            KnownDrift::of(errors, 10.0).displacement_variance(then, now, way, away, paused).sqrt()
        };
        for (then, now, expected) in [(50, 250, 0.14), (60, 61, 0.0405), (20, 60, 0.02), (61, 101, 0.02)] {
            let found = moved(&errors, then, now, 6.0, 1.0);
            assert!((found - expected).abs() < 1e-12, "{found} from {then} to {now}");
        }
        let turned = LocalisationErrors { heading_drift: -0.001, ..Default::default() };
        assert!((moved(&turned, 60, 60, 4.0, 0.0) - 0.024).abs() < 1e-12);
        assert!((moved(&turned, 70, 70, 4.0, 0.0) - 0.06).abs() < 1e-12);
        // A fix every 10 s ends the drift: of 2 s after the fix of frame 0, and of 3 s and the pause.
        let fixes = Some(PositionFixes { every_frames: 100, noise: 0.03 });
        let fixed = LocalisationErrors { fixes, ..errors };
        let paused = |frame: u64| if frame > 110 { 8.0 } else { 0.0 };
        let found = KnownDrift::of(&fixed, 10.0).displacement_variance(20, 130, 1.0, 1.0, paused);
        let expected = 2.0 * 0.03_f64 * 0.03 + 0.01 * 0.01 + 0.055 * 0.055;
        assert!((found - expected).abs() < 1e-12, "{found}");
    }

    #[test]
    fn a_heading_that_drifts_displaces_by_the_way_and_by_the_distance() {
        // 1 mrad a second. After 10 s it is 10 mrad: ground 5 m ahead is placed 50 mm aside. 4 m and 20 s later the heading is
        // wrong by 30 mrad, and the ground, 1 m ahead, is expected 30 mm aside: 20 mm from where it was placed.
        let turned = LocalisationErrors { heading_drift: -0.001, ..Default::default() };
        let bound = displaced(turned, 100, 300, 4.0, 1.0);
        // The signs of both parts are not known to be opposite: 40 mm and 20 mm are added.
        assert!((bound - 0.06).abs() < 1e-12, "{bound}");
        // Just measured: nothing.
        assert_eq!(displaced(turned, 100, 100, 0.0, 5.0), 0.0);
    }
}
