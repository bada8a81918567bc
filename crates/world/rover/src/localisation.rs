//! Localisation of the vehicle: inertial sensors with their errors, beacons, and the proximity sensor. (Paper, §7)

use glam::DVec2;
use raypencil_scene::{SceneError, check_count, check_range};
use raypencil_terrain::HeightIndex;

use crate::noise_stream::{NoiseStream, Purpose};
use crate::vehicle::{Attitude, Stance};

/// Errors of the localisation sensors. "The x and y coordinates can be obtained directly from inertial guidance sensors
/// and corrected, possibly, by periodic updates from satellite sightings of the Rover's beacons. The pitch, roll, and
/// yaw angles of the vehicle can also be measured from on-board sensors." (§7)
///
/// CHOICE: the paper gives no figures. The default has no errors.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct LocalisationErrors {
    /// Drift of the measured position, global x and y, metres per second.
    pub position_drift: DVec2,
    /// Random walk of the measured position: standard deviation in x and in y after one second, metres.
    pub position_walk: f64,
    /// Constant errors of heading, pitch and roll, radians.
    pub attitude_bias: Attitude,
    /// Drift of the measured heading, radians per second. Position fixes do not correct it.
    pub heading_drift: f64,
    /// Noise of each angle in each frame: standard deviation, radians.
    pub attitude_noise: f64,
    /// Noise of the proximity sensor: standard deviation, metres.
    pub proximity_noise: f64,
    /// Position fixes by satellite sightings of the beacons. `None`: no fixes.
    pub fixes: Option<PositionFixes>,
}

/// Periodic fixes of the position.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PositionFixes {
    /// Number of frames from one fix to the next; the first is in frame 0.
    pub every_frames: u64,
    /// Error of a fix: standard deviation in x and in y, metres.
    pub noise: f64,
}

/// Reading of all localisation sensors in one frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LocalisationReading {
    /// Measured position of the vehicle's origin, global x and y, metres.
    pub position: DVec2,
    /// Measured attitude.
    pub attitude: Attitude,
    /// Measured distance from the vehicle's origin straight down to the ground, metres. Negative if the ground is above
    /// the plane of the wheels. `None` if there is no ground. "A proximity sensor is mounted under the vehicle to
    /// measure the distance from the local vehicle origin to the ground surface." (§7)
    pub proximity: Option<f64>,
}

/// Simulated localisation sensors of one drive.
#[derive(Debug, Clone, PartialEq)]
pub struct Localisation {
    errors: LocalisationErrors,
    noise_stream: NoiseStream,
    frame_rate: f64,
    /// Measured minus true position, global x and y, metres.
    error: DVec2,
    frame: u64,
    /// Time of all pauses so far, and of those since the last reading, seconds.
    paused: [f64; 2],
}

impl Localisation {
    /// Sensors with these errors that are read `frame_rate` times per second. The seed determines the noise.
    pub fn new(errors: LocalisationErrors, seed: u64, frame_rate: f64) -> Self {
        Self {
            errors,
            noise_stream: NoiseStream { seed },
            frame_rate,
            error: DVec2::ZERO,
            frame: 0,
            paused: [0.0; 2],
        }
    }

    /// Time goes on by so many seconds while the vehicle stands and no sensor is read: position and heading drift.
    pub fn pause(&mut self, seconds: f64) {
        self.paused = self.paused.map(|so_far| so_far + seconds);
    }

    /// Reads all sensors of a vehicle with this true pose. Call it once per frame, in order.
    ///
    /// ```
    /// use glam::{DVec2, DVec3};
    /// use raypencil_rover::{Attitude, Localisation, LocalisationErrors, Stance};
    /// use raypencil_terrain::{HeightIndex, builtin};
    ///
    /// // A drift of 0.5 m/s at 10 frames per second is 0.05 m per frame; frame 0 has none yet.
    /// let errors = LocalisationErrors { position_drift: DVec2::new(0.5, 0.0), ..LocalisationErrors::default() };
    /// let mut localisation = Localisation::new(errors, 1, 10.0);
    /// let ground = HeightIndex::new(&builtin("pyramids", 0.25).unwrap().into_mesh()?);
    /// let stance = Stance { position: DVec3::new(-9.0, 0.0, 0.0), attitude: Attitude::default(), residual: 0.0 };
    /// let drift = [0, 1].map(|_| localisation.read(&stance, &ground).position.x + 9.0);
    /// assert!(drift[0] == 0.0 && (drift[1] - 0.05).abs() < 1e-12);
    /// # Ok::<(), raypencil_scene::SceneError>(())
    /// ```
    pub fn read(&mut self, stance: &Stance, ground: &HeightIndex) -> LocalisationReading {
        let Self { errors, noise_stream, frame, paused: [paused, since], .. } = *self;
        self.paused[1] = 0.0;
        if frame > 0 {
            let dt = 1.0 / self.frame_rate + since;
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
        let drifted = errors.heading_drift * (frame as f64 / self.frame_rate + paused);
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
    /// Checks every field. The error names the first one that is out of range.
    pub fn validate(&self, field: &str) -> Result<(), SceneError> {
        check_range(|| format!("{field}.position_drift.x"), self.position_drift.x, -1e3, 1e3, "m/s")?;
        check_range(|| format!("{field}.position_drift.y"), self.position_drift.y, -1e3, 1e3, "m/s")?;
        check_range(|| format!("{field}.position_walk"), self.position_walk, 0.0, 1e3, "m")?;
        let bias = self.attitude_bias;
        for (name, angle) in [
            ("attitude_bias.heading", bias.heading),
            ("attitude_bias.pitch_down", bias.pitch_down),
            ("attitude_bias.roll_right", bias.roll_right),
            ("heading_drift", self.heading_drift),
        ] {
            check_range(|| format!("{field}.{name}"), angle, -10.0, 10.0, "rad")?;
        }
        check_range(|| format!("{field}.attitude_noise"), self.attitude_noise, 0.0, 10.0, "rad")?;
        check_range(|| format!("{field}.proximity_noise"), self.proximity_noise, 0.0, 1e2, "m")?;
        if let Some(fixes) = self.fixes {
            check_count(|| format!("{field}.fixes.every_frames"), fixes.every_frames, 1, u64::MAX)?;
            check_range(|| format!("{field}.fixes.noise"), fixes.noise, 0.0, 1e3, "m")?;
        }
        Ok(())
    }
}
