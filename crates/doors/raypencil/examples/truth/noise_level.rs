//! Noise levels of the truth table: how well a rover sees, and how well it knows where it is.

use glam::DVec2;
use raypencil::drive::DriveJob;
use raypencil::io::default_threshold;
use raypencil::rover::{Detection, LocalisationErrors, PositionFixes, Route};
use raypencil::sensor::{ImageSensor, preset};

/// Noise level of a rover: its image sensor and the errors of its localisation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NoiseLevel {
    /// Sensor `ideal`; position and attitude without errors.
    None,
    /// Sensor `cmos`, and good inertial sensors.
    Modest,
    /// Sensor `ccd_1989`, and bad inertial sensors.
    Coarse,
}

impl NoiseLevel {
    /// Name of the level in the table.
    pub fn word(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Modest => "modest",
            Self::Coarse => "coarse",
        }
    }

    /// Name of the sensor preset.
    fn preset(self) -> &'static str {
        match self {
            Self::None => "ideal",
            Self::Modest => "cmos",
            Self::Coarse => "ccd_1989",
        }
    }

    /// Errors of the localisation at `speed`, metres per second.
    ///
    /// CHOICE: all numbers; the paper gives none. The position drifts by 1 % or 4 % of the distance driven, along the
    /// global x and y axes in the ratio 4 to 3. Position fixes from beacons come every 10 s, or never.
    fn errors(self, route: &Route) -> LocalisationErrors {
        let every_frames = ((10.0 * route.frame_rate).round() as u64).max(1);
        let drift = |share: f64| DVec2::new(0.8, 0.6) * (share * route.speed);
        match self {
            Self::None => LocalisationErrors::default(),
            Self::Modest => LocalisationErrors {
                position_drift: drift(0.01),
                position_walk: 0.005,
                heading_drift: 0.002_f64.to_radians(),
                attitude_noise: 0.1_f64.to_radians(),
                proximity_noise: 0.01,
                fixes: Some(PositionFixes { every_frames, noise: 0.05 }),
                ..LocalisationErrors::default()
            },
            Self::Coarse => LocalisationErrors {
                position_drift: drift(0.04),
                position_walk: 0.02,
                heading_drift: 0.02_f64.to_radians(),
                attitude_noise: 0.5_f64.to_radians(),
                proximity_noise: 0.03,
                fixes: None,
                ..LocalisationErrors::default()
            },
        }
    }

    /// Job with this level's sensor and errors in place of its own, and with seeds 0.
    #[must_use]
    pub fn applied(self, mut job: DriveJob) -> DriveJob {
        let wavelength = job.sensor.wavelength;
        job.preset = self.preset();
        let (optics, sensor) = preset(job.preset).expect("the name of a preset");
        job.optics = optics;
        job.sensor = ImageSensor { wavelength, seed: 0, ..sensor };
        job.plan.extraction.detection = Detection::Fixed(default_threshold(job.preset));
        job.plan.errors = self.errors(&job.plan.route);
        job.plan.seed = 0;
        job
    }
}
