//! What the vehicle knows of where it is: inertial sensors with their errors, beacons, and the proximity sensor
//! below. (Paper, §7)

use glam::DVec2;
use raypencil_scene::SceneError;
use raypencil_terrain::HeightIndex;

use crate::check::{check_count, check_range};
use crate::noise_stream::{NoiseStream, Purpose};
use crate::vehicle::{Attitude, Stance};

/// The errors of the sensors. "The x and y coordinates can be obtained directly from inertial guidance sensors and
/// corrected, possibly, by periodic updates from satellite sightings of the Rover's beacons. The pitch, roll, and
/// yaw angles of the vehicle can also be measured from on-board sensors." (§7)
///
/// CHOICE: the paper gives no figures: the default has no errors at all.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct LocalisationErrors {
    /// The measured position runs away by this, global, metres per second.
    pub position_drift: DVec2,
    /// And wanders: after a second, by this standard deviation in x and in y, metres.
    pub position_walk: f64,
    /// Constant errors of heading, pitch and roll, radians.
    pub attitude_bias: Attitude,
    /// The heading runs away by this, radians per second. No beacon sees it.
    pub heading_drift: f64,
    /// Standard deviation of each angle in each frame, radians.
    pub attitude_noise: f64,
    /// Standard deviation of the proximity sensor, metres.
    pub proximity_noise: f64,
    /// Sightings of the beacons, if there are any.
    pub fixes: Option<PositionFixes>,
}

/// PositionFixes of the position.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PositionFixes {
    /// One every so many frames; the first with frame 0.
    pub every_frames: u64,
    /// Standard deviation in x and in y, metres.
    pub noise: f64,
}

/// What the sensors say in one frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LocalisationReading {
    /// The vehicle's origin as the inertial sensors have it, global, metres.
    pub position: DVec2,
    /// Its attitude likewise.
    pub attitude: Attitude,
    /// From the vehicle's origin straight down to the ground, metres: negative where the ground stands above the
    /// plane of the wheels. "A proximity sensor is mounted under the vehicle to measure the distance from the
    /// local vehicle origin to the ground surface." (§7) `None` where there is no ground.
    pub proximity: Option<f64>,
}

/// The sensors of one drive.
#[derive(Debug, Clone, PartialEq)]
pub struct Localisation {
    errors: LocalisationErrors,
    noise_stream: NoiseStream,
    frame_rate: f64,
    /// Measured minus true position.
    error: DVec2,
    frame: u64,
}

impl Localisation {
    /// Localisation with these errors, read `frame_rate` times a second. Other seeds give other noise.
    pub fn new(errors: LocalisationErrors, seed: u64, frame_rate: f64) -> Self {
        Self { errors, noise_stream: NoiseStream { seed }, frame_rate, error: DVec2::ZERO, frame: 0 }
    }

    /// Reads all sensors of a vehicle that stands so, once per frame.
    pub fn read(&mut self, stance: &Stance, ground: &HeightIndex) -> LocalisationReading {
        let Self { errors, noise_stream, frame, .. } = *self;
        if frame > 0 {
            let dt = 1.0 / self.frame_rate;
            let walk = DVec2::from_array(noise_stream.gaussians(Purpose::PositionWalk, frame));
            self.error += errors.position_drift * dt + walk * (errors.position_walk * dt.sqrt());
        }
        if let Some(PositionFixes { every_frames, noise }) = errors.fixes
            && frame % every_frames.max(1) == 0
        {
            self.error = DVec2::from_array(noise_stream.gaussians(Purpose::PositionFix, frame)) * noise;
        }
        let [pitch, roll] = noise_stream.gaussians(Purpose::Tilt, frame);
        let [heading, _] = noise_stream.gaussians(Purpose::Heading, frame);
        let drifted = errors.heading_drift * (frame as f64 / self.frame_rate);
        let (bias, noise, truth) = (errors.attitude_bias, errors.attitude_noise, stance.attitude);
        let attitude = Attitude {
            heading: truth.heading + bias.heading + drifted + noise * heading,
            pitch_down: truth.pitch_down + bias.pitch_down + noise * pitch,
            roll_right: truth.roll_right + bias.roll_right + noise * roll,
        };
        let [proximity, _] = noise_stream.gaussians(Purpose::Proximity, frame);
        let below = ground.height_at(stance.position.x, stance.position.y);
        self.frame += 1;
        LocalisationReading {
            position: stance.position.truncate() + self.error,
            attitude,
            proximity: below.map(|z| stance.position.z - z + errors.proximity_noise * proximity),
        }
    }
}

impl LocalisationErrors {
    /// Refuses errors that are none, naming the field.
    pub fn validate(&self, field: &str) -> Result<(), SceneError> {
        check_range(field, "position_drift.x", self.position_drift.x, -1e3, 1e3, "m/s")?;
        check_range(field, "position_drift.y", self.position_drift.y, -1e3, 1e3, "m/s")?;
        check_range(field, "position_walk", self.position_walk, 0.0, 1e3, "m")?;
        let bias = self.attitude_bias;
        for (name, angle) in [
            ("attitude_bias.heading", bias.heading),
            ("attitude_bias.pitch_down", bias.pitch_down),
            ("attitude_bias.roll_right", bias.roll_right),
            ("heading_drift", self.heading_drift),
        ] {
            check_range(field, name, angle, -10.0, 10.0, "rad")?;
        }
        check_range(field, "attitude_noise", self.attitude_noise, 0.0, 10.0, "rad")?;
        check_range(field, "proximity_noise", self.proximity_noise, 0.0, 1e2, "m")?;
        if let Some(fixes) = self.fixes {
            check_count(field, "fixes.every_frames", fixes.every_frames, 1, u64::MAX)?;
            check_range(field, "fixes.noise", fixes.noise, 0.0, 1e3, "m")?;
        }
        Ok(())
    }
}
