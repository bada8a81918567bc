//! Patterns of sensors on the market, by name. `docs/guide/lidar.md` has the table of figures with their sources, and says
//! which of them were not found in a manual.

use super::{Channel, Grid, Spacing, Spinning};

/// Names of the presets of spinning heads.
pub const SPINNING_PRESETS: [&str; 3] = ["vlp-16", "hdl-64e", "os1-64"];

/// Names of the presets of rasters.
pub const GRID_PRESETS: [&str; 1] = ["l515"];

/// Elevation, degrees, and vertical correction, millimetres, of each laser of a VLP-16, by laser ID.
///
/// Velodyne, VLP-16 User Manual, 63-9243 Rev. D (2018), table 9-1, <https://www.easymanua.ls/velodyne/vlp-16/manual?p=54>: the
/// lasers 7 to 15 were read there. All 16 stand in `velodyne_pointcloud/params/VLP16db.yaml` of the ROS driver,
/// <https://github.com/ros-drivers/velodyne>.
const VLP_16: [(f64, f64); 16] = [
    (-15.0, 11.2),
    (1.0, -0.7),
    (-13.0, 9.7),
    (3.0, -2.2),
    (-11.0, 8.1),
    (5.0, -3.7),
    (-9.0, 6.6),
    (7.0, -5.1),
    (-7.0, 5.1),
    (9.0, -6.6),
    (-5.0, 3.7),
    (11.0, -8.1),
    (-3.0, 2.2),
    (13.0, -9.7),
    (-1.0, 0.7),
    (15.0, -11.2),
];

impl Spinning {
    /// The head of one of [`SPINNING_PRESETS`] at 10 turns a second, for one turn; `None` for another name.
    ///
    /// ```
    /// use raypencil_scene::pattern::{SPINNING_PRESETS, Spinning};
    ///
    /// let sizes = SPINNING_PRESETS.map(|name| {
    ///     let head = Spinning::preset(name).expect("a preset");
    ///     (head.steps, head.channels.len())
    /// });
    /// assert_eq!(sizes, [(1808, 16), (2083, 64), (1024, 64)]);
    /// assert!(Spinning::preset("vlp-17").is_none());
    /// ```
    pub fn preset(name: &str) -> Option<Self> {
        Self::preset_at(name, 10.0)
    }

    /// As [`Spinning::preset`], at another rate, turns a second. The heads of Velodyne fire at their own pace: they have
    /// fewer steps in a faster turn. That of Ouster has the same columns in any turn.
    ///
    /// ```
    /// use raypencil_scene::pattern::Spinning;
    ///
    /// // 1 / (20 Hz * 55.296 us) = 904.2 firing sequences.
    /// assert_eq!(Spinning::preset_at("vlp-16", 20.0).map(|head| head.steps), Some(904));
    /// assert_eq!(Spinning::preset_at("os1-64", 20.0).map(|head| head.steps), Some(1024));
    /// ```
    pub fn preset_at(name: &str, rate_hz: f64) -> Option<Self> {
        match name {
            "vlp-16" => Some(vlp_16(rate_hz)),
            "hdl-64e" => Some(hdl_64e(rate_hz)),
            "os1-64" => Some(os1_64(rate_hz)),
            _ => None,
        }
    }

    /// Whether the head of this preset fires at its own pace, at whatever rate it turns: those of Velodyne do.
    pub fn fires_at_its_own_pace(name: &str) -> bool {
        matches!(name, "vlp-16" | "hdl-64e")
    }
}

impl Grid {
    /// The raster of one of [`GRID_PRESETS`]; `None` for another name.
    ///
    /// ```
    /// use raypencil_scene::pattern::{GRID_PRESETS, Grid};
    ///
    /// let grid = Grid::preset(GRID_PRESETS[0]).expect("a preset");
    /// assert_eq!((grid.columns, grid.rows), (1024, 768));
    /// ```
    pub fn preset(name: &str) -> Option<Self> {
        // Intel RealSense L515: 70 x 55 degrees, 1024 x 768 depths, 0.25 to 9 m. Nominal, not verified against the data sheet.
        (name == "l515").then_some(Self {
            columns: 1024,
            rows: 768,
            width_deg: 70.0,
            height_deg: 55.0,
            spacing: Spacing::Tangent,
            min_range_m: 0.25,
            max_range_m: 9.0,
        })
    }
}

/// Number of whole periods in a turn. The turn ends within the next one.
fn whole_periods(rate_hz: f64, period_s: f64) -> u64 {
    (1.0 / (rate_hz * period_s)).floor() as u64
}

fn vlp_16(rate_hz: f64) -> Spinning {
    // The manual, section 9.4, <https://manualshive.com/ru/manual/velodyne/vlp-16/863557?page=62>: a firing every 2.304 us in
    // the order of laser IDs, a sequence of 16 firings every 55.296 us.
    const FIRING_US: f64 = 2.304;
    const SEQUENCE_US: f64 = 55.296;
    let channels = VLP_16.iter().enumerate().map(|(id, &(elevation_deg, vertical_mm))| Channel {
        vertical_m: vertical_mm / 1e3,
        firing_s: id as f64 * FIRING_US / 1e6,
        ..Channel::at_elevation(elevation_deg)
    });
    Spinning {
        channels: channels.collect(),
        azimuth_start_deg: 0.0,
        // Clockwise seen from above.
        azimuth_step_deg: -360.0 * rate_hz * SEQUENCE_US / 1e6,
        steps: whole_periods(rate_hz, SEQUENCE_US / 1e6),
        period_s: SEQUENCE_US / 1e6,
        min_range_m: 0.0,
        // Nominal, not verified against the manual.
        max_range_m: 100.0,
    }
}

/// Nominal, not verified against the manual: 32 upper lasers from 2 degrees down in steps of 1/3 degree, 32 lower ones on
/// from -8 5/6 degrees in steps of 1/2 degree. The measured angles and offsets of a device are in its own calibration.
fn hdl_64e(rate_hz: f64) -> Spinning {
    // 0.1728 degrees at 10 turns a second.
    const PERIOD_S: f64 = 48e-6;
    let upper = (0..32).map(|k| 2.0 - f64::from(k) / 3.0);
    let lower = (0..32).map(|k| -53.0 / 6.0 - f64::from(k) / 2.0);
    Spinning {
        channels: upper.chain(lower).map(Channel::at_elevation).collect(),
        azimuth_start_deg: 0.0,
        azimuth_step_deg: -360.0 * rate_hz * PERIOD_S,
        steps: whole_periods(rate_hz, PERIOD_S),
        period_s: PERIOD_S,
        min_range_m: 0.0,
        max_range_m: 120.0,
    }
}

/// Ouster, OS1 datasheet of the first generation, <https://www.scribd.com/document/672435817/Ouster-OS1-Datasheet>: 64
/// channels over 33.2 degrees, 512, 1024 or 2048 columns at 10 to 20 Hz, 0.8 to 120 m.
///
/// Beam angles are the design values of Ouster's SDK (`gen1_altitude_angles` and `gen1_azimuth_angles` of `ouster_client`):
/// even steps from 16.6113 to -16.6113 degrees, rounded to three decimals, and four azimuths by turns. The OS1 User Guide, page 12,
/// <https://www.easymanua.ls/ouster/os1/manual?p=12>, counts the encoder and these azimuths clockwise.
fn os1_64(rate_hz: f64) -> Spinning {
    const COLUMNS: u64 = 1024;
    /// By turns, counted to the left.
    const AZIMUTHS_DEG: [f64; 4] = [-3.164, -1.055, 1.055, 3.164];
    let channels = (0..64_u8).map(|k| Channel {
        azimuth_offset_deg: AZIMUTHS_DEG[usize::from(k % 4)],
        ..Channel::at_elevation((16611.3 * (63.0 - 2.0 * f64::from(k)) / 63.0).round() / 1e3)
    });
    Spinning {
        channels: channels.collect(),
        // Frames start at the back of the sensor. (Ouster sensor documentation, "Lidar Coordinate Frame")
        azimuth_start_deg: 180.0,
        azimuth_step_deg: -360.0 / COLUMNS as f64,
        steps: COLUMNS,
        period_s: 1.0 / (rate_hz * COLUMNS as f64),
        min_range_m: 0.8,
        max_range_m: 120.0,
    }
}
