//! A scene as numbers, before any terrain is loaded; and the default rig.

use glam::DVec3;
use std::ops::Range;
use std::path::PathBuf;

use crate::drive::camera_keys::KernelPart;
use crate::drive::settings::DriveSettings;
use raypencil_scene::{Beam, Camera, FluxModel, Lens, Profile};
use raypencil_terrain::MarsGround;

/// Everything a scene needs but its mesh.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Plan {
    pub vehicle: Vehicle,
    pub camera: (Mount, Camera),
    pub beams: Vec<(Mount, Beam)>,
    pub terrain: Terrain,
    /// As given in the file: for materials that bring none of their own.
    pub reflectivity: Option<f64>,
    pub attenuation: f64,
    pub flux_model: FluxModel,
    /// Where the vehicle drives, if the file says so.
    pub drive: Option<DriveSettings>,
    /// The files of kernels that belong among its optics' blurs, in their order.
    pub kernels: Vec<KernelPart>,
    /// Where the file says where the vehicle and the terrain are.
    pub position_span: Range<usize>,
    pub terrain_span: Range<usize>,
}

/// Where the vehicle stands, global frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Vehicle {
    pub position: [f64; 2],
    /// `None`: on the ground.
    pub height: Option<f64>,
    pub heading_deg: f64,
    pub pitch_down_deg: f64,
    pub roll_right_deg: f64,
}

/// Where a sensor is mounted, vehicle frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Mount {
    pub position: DVec3,
    pub pitch_down_deg: f64,
    pub yaw_left_deg: f64,
    pub roll_right_deg: f64,
}

/// Where the ground comes from.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Terrain {
    Builtin(String),
    /// Relative to the scene file.
    File(PathBuf),
    Dem(DemPart),
    Generate {
        nasty: bool,
        seed: u64,
        faces: usize,
        /// `None`: the generator's own.
        extent: Option<f64>,
        offset: DVec3,
    },
    Mars {
        ground: Box<MarsGround>,
        /// An elevation model whose posts it passes through, relative to the scene file, and where the file says so.
        coarse: Option<(PathBuf, Range<usize>)>,
    },
}

/// What is taken of an elevation model.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct DemPart {
    /// Relative to the scene file.
    pub file: PathBuf,
    /// x and y of the lower left corner, width and height; `None`: all of it.
    pub window: Option<[f64; 4]>,
    /// How far the ground may be from a post; `None`: it goes through all.
    pub max_error: Option<f64>,
}

/// CHOICE: the paper prints no rig. This one sees stripes about 2.5 and 5 m ahead of a rover of a metre or
/// two, well inside the camera's view, with both beams above the camera as in figure 1.
pub(crate) fn default_rig(terrain: Terrain) -> Plan {
    let camera = Camera {
        width: 1024,
        height: 1024,
        pixel_pitch: [9.0 / 1e6; 2],
        focal_length: 8.0 / 1e3,
        principal_point: [512.0; 2],
        aperture: 2.0 / 1e3,
        lens: Lens::CLEAR,
        max_range: 20.0,
    };
    Plan {
        vehicle: Vehicle {
            position: [0.0; 2],
            height: None,
            heading_deg: 0.0,
            pitch_down_deg: 0.0,
            roll_right_deg: 0.0,
        },
        camera: (Mount::new(DVec3::new(0.3, 0.0, 1.5), 20.0), camera),
        beams: (0..2).map(default_beam).collect(),
        terrain,
        reflectivity: None,
        attenuation: 0.0,
        flux_model: FluxModel::Radiometric,
        drive: None,
        kernels: Vec::new(),
        position_span: 0..0,
        terrain_span: 0..0,
    }
}

/// The default beam of that index. The second is higher and flatter; any other is as the first.
pub(crate) fn default_beam(index: usize) -> (Mount, Beam) {
    let mount = match index {
        1 => Mount::new(DVec3::new(0.3, 0.0, 2.0), 22.0),
        _ => Mount::new(DVec3::new(0.3, 0.0, 1.8), 31.0),
    };
    let grid_distance = 100.0 / 1e3;
    let beam = Beam {
        columns: 1024,
        rows: 16,
        thickness: 5.0 / 1e3,
        grid_distance,
        half_width: Beam::half_width_of(grid_distance, DEFAULT_FAN_DEG.to_radians()),
        max_range: 20.0,
        power: 1.0,
        wavelength: 810.0 / 1e9,
        profile: Profile::Paper,
    };
    (mount, beam)
}

/// The default fan, degrees.
pub(crate) const DEFAULT_FAN_DEG: f64 = 60.0;

impl Mount {
    fn new(position: DVec3, pitch_down_deg: f64) -> Self {
        Self { position, pitch_down_deg, yaw_left_deg: 0.0, roll_right_deg: 0.0 }
    }
}
