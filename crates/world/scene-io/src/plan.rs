//! A scene as checked numbers, before its terrain is loaded.

use glam::DVec3;
use std::ops::Range;
use std::path::PathBuf;

use raypencil_mesh_io::{DemOptions, FileFrame};
use raypencil_scene::rig::{self, DEFAULT_BEAM_MOUNTS, DEFAULT_CAMERA_MOUNT, DefaultMount};
use raypencil_scene::{Beam, Camera, FluxModel, NamedRaySet};
use raypencil_terrain::MarsGround;

use crate::digest::NamedDigest;
use crate::drive::setup::DriveSetup;

/// All numbers of a scene except for its mesh.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct ScenePlan {
    pub vehicle: VehiclePlacement,
    pub camera: (Mount, Camera),
    pub beams: Vec<(Mount, Beam)>,
    pub terrain: Terrain,
    /// Reflectivity that the file gives, for materials without one of their own.
    pub reflectivity: Option<f64>,
    pub attenuation: f64,
    pub flux_model: FluxModel,
    pub drive: Option<DriveSetup>,
    /// Digest of the camera's calibration, if the file names one.
    pub camera_digest: Option<NamedDigest>,
    /// Digests of the files of the drive's kernels, in their order.
    pub kernel_digests: Vec<NamedDigest>,
    /// Sets of rays, in the vehicle frame.
    pub ray_sets: Vec<NamedRaySet>,
    /// Digests of the files that they name, in their order.
    pub ray_digests: Vec<NamedDigest>,
    /// Places of the vehicle's position and of the terrain in the file.
    pub position_span: Range<usize>,
    pub terrain_span: Range<usize>,
}

impl ScenePlan {
    /// The files that were read for anything but the ground, in their order.
    pub(crate) fn named_files(&self) -> impl Iterator<Item = &NamedDigest> {
        self.camera_digest.iter().chain(&self.kernel_digests).chain(&self.ray_digests)
    }
}

/// Placement of the vehicle in the global frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct VehiclePlacement {
    pub position: [f64; 2],
    /// `None`: on the ground.
    pub height: Option<f64>,
    pub heading_deg: f64,
    pub pitch_down_deg: f64,
    pub roll_right_deg: f64,
}

/// Mount of a sensor in the vehicle frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Mount {
    pub position: DVec3,
    pub pitch_down_deg: f64,
    pub yaw_left_deg: f64,
    pub roll_right_deg: f64,
}

/// Origin of the ground.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Terrain {
    Builtin(String),
    File(MeshPart),
    Dem(DemPart),
    Generate {
        nasty: bool,
        seed: u64,
        faces: usize,
        /// `None`: the default of the kind.
        extent: Option<f64>,
        offset: DVec3,
    },
    Mars {
        ground: Box<MarsGround>,
        /// Elevation model whose posts the ground passes through: its path relative to the scene file, and the place of
        /// the key.
        coarse: Option<(PathBuf, Range<usize>)>,
    },
}

/// A mesh file.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct MeshPart {
    /// Path relative to the scene file.
    pub file: PathBuf,
    /// Its axes and unit.
    pub frame: FileFrame,
}

/// Part of an elevation model.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct DemPart {
    /// Path relative to the scene file.
    pub file: PathBuf,
    /// What to read of it, and what it does not say itself.
    pub options: DemOptions,
    /// Maximum distance from the ground to a post, metres; `None`: the ground passes through all posts.
    pub max_error: Option<f64>,
}

/// The default rig on a terrain, with the vehicle at the origin.
pub(crate) fn default_rig(terrain: Terrain) -> ScenePlan {
    ScenePlan {
        vehicle: VehiclePlacement {
            position: [0.0; 2],
            height: None,
            heading_deg: 0.0,
            pitch_down_deg: 0.0,
            roll_right_deg: 0.0,
        },
        camera: (Mount::ahead(DEFAULT_CAMERA_MOUNT), rig::default_camera()),
        beams: (0..DEFAULT_BEAM_MOUNTS.len()).map(default_beam).collect(),
        terrain,
        reflectivity: None,
        attenuation: 0.0,
        flux_model: FluxModel::Radiometric,
        drive: None,
        camera_digest: None,
        kernel_digests: Vec::new(),
        ray_sets: Vec::new(),
        ray_digests: Vec::new(),
        position_span: 0..0,
        terrain_span: 0..0,
    }
}

/// The default beam of that index. A third one and any later one is mounted as the first.
pub(crate) fn default_beam(index: usize) -> (Mount, Beam) {
    let mount = DEFAULT_BEAM_MOUNTS.get(index).unwrap_or(&DEFAULT_BEAM_MOUNTS[0]);
    (Mount::ahead(*mount), rig::default_beam())
}

impl Mount {
    fn ahead(DefaultMount { position, pitch_down_deg }: DefaultMount) -> Self {
        Self { position, pitch_down_deg, yaw_left_deg: 0.0, roll_right_deg: 0.0 }
    }
}
