//! What a scene file says of a drive: `[drive]`, in SI. What it leaves out has the rover's own default.

use crate::drive::camera_settings::{ElectronicsSettings, OpticsSettings};

/// The words for what tells light from dark.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DetectionWord {
    /// A fixed number.
    Fixed,
    /// Otsu's.
    Otsu,
    /// Differences of neighbours.
    Gradient,
}

/// The words for which place of a stripe is measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PlaceWord {
    /// The last lit pixel.
    Pixel,
    /// The crossing of the threshold.
    SubPixel,
    /// The middle of the light.
    Centroid,
}

/// The words for sensors with their optics.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SensorWord {
    /// No noise, no blur.
    Ideal,
    /// A CCD camera of the paper's time.
    Ccd1989,
    /// A camera of today.
    Cmos,
}

impl SensorWord {
    /// The word as files have it.
    pub fn word(self) -> &'static str {
        match self {
            Self::Ideal => "ideal",
            Self::Ccd1989 => "ccd_1989",
            Self::Cmos => "cmos",
        }
    }
}

/// The sun of a drive.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SunSettings {
    /// Above the horizontal, radians.
    pub elevation: f64,
    /// To the left of the global x axis, radians.
    pub azimuth: f64,
    /// Of the air's dust.
    pub optical_depth: f64,
    /// Of the sun above the air near the laser's wavelength, W/m^2 per metre of wavelength; that of Mars if it is not given.
    pub spectral_irradiance: Option<f64>,
}

/// A drive as a scene file has it: only what was given, each in SI and in range. Where it starts is where the scene's
/// vehicle stands.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct DriveSettings {
    /// Where it goes, global x and y, metres.
    pub waypoints: Vec<[f64; 2]>,
    /// Metres per second.
    pub speed: Option<f64>,
    /// Radians per second.
    pub turn_rate: Option<f64>,
    /// Frames per second.
    pub frame_rate: Option<f64>,
    /// Of what the inertial sensors get wrong.
    pub seed: Option<u64>,
    /// How the light becomes numbers.
    pub sensor: Option<SensorWord>,
    /// Of the camera's noise.
    pub sensor_seed: Option<u64>,
    /// The sun, if it shines.
    pub sun: Option<SunSettings>,
    /// Whether a second image without the laser is taken off each.
    pub subtract_unlit: Option<bool>,
    /// Pencils across each pixel of the camera.
    pub pencils_per_pixel: Option<f64>,
    /// Whether all beams are lit in one exposure.
    pub lit_together: Option<bool>,
    /// What is lit.
    pub detection: Option<DetectionWord>,
    /// The level or the least difference, digital numbers.
    pub threshold: Option<f64>,
    /// What is measured of a stripe.
    pub place: Option<PlaceWord>,
    /// Fewer lit rows are noise.
    pub least_rows: Option<u32>,
    /// Between points of the map, metres.
    pub map_spacing: Option<f64>,
    /// Points along a side of the map.
    pub map_points: Option<u32>,
    /// An obstacle map every so many frames.
    pub obstacles_every: Option<u64>,
    /// Whether gaps no wider than a wheel is thick are crossed.
    pub cross_gaps: Option<bool>,
    /// Greatest slopes, rise over distance: of the front wheels, the rear wheels, along the vehicle, and of the pair closer
    /// to its centre.
    pub slopes: [Option<f64>; 4],
    /// First and last radius of the radial grid and what is between two, metres.
    pub grid_radii: [Option<f64>; 3],
    /// From the heading to the outermost sector, radians.
    pub grid_half_angle: Option<f64>,
    /// Sectors of the radial grid.
    pub grid_sectors: Option<u32>,
    /// A difference of radii above this is large, metres.
    pub vector_large: Option<f64>,
    /// One up to this is small, metres.
    pub vector_small: Option<f64>,
    /// Whether it stops for vertical scans.
    pub scans: Option<bool>,
    /// Between scans, metres.
    pub scan_every: Option<f64>,
    /// Stripes of each beam in a scan.
    pub scan_steps: Option<u32>,
    /// First and last turn of the beams in a scan, downwards, radians.
    pub scan_angles: [Option<f64>; 2],
    /// A scan when new points contradict old ones by more on average, metres.
    pub scan_inconsistency: Option<f64>,
    /// On fewer grid points they do not.
    pub scan_least_points: Option<u32>,
    /// Between the axles, metres.
    pub wheelbase: Option<f64>,
    /// Between the sides, metres.
    pub track: Option<f64>,
    /// Metres.
    pub wheel_radius: Option<f64>,
    /// Metres.
    pub wheel_width: Option<f64>,
    /// Under the belly, metres.
    pub clearance: Option<f64>,
    /// Metres per second, global.
    pub position_drift: Option<[f64; 2]>,
    /// Metres after a second.
    pub position_walk: Option<f64>,
    /// Radians per second.
    pub heading_drift: Option<f64>,
    /// Constant errors of heading (to the left), pitch (nose down) and roll (right side down), radians.
    pub attitude_bias: [Option<f64>; 3],
    /// Radians.
    pub attitude_noise: Option<f64>,
    /// Metres.
    pub proximity_noise: Option<f64>,
    /// A fix of the position every so many frames.
    pub fix_every: Option<u64>,
    /// Of a fix, metres.
    pub fix_noise: Option<f64>,
    /// What of the optics is not the preset's.
    pub optics: OpticsSettings,
    /// What of the sensor is not the preset's.
    pub electronics: ElectronicsSettings,
}
