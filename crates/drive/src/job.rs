//! What is driven: a scene and its drive become a rover's plan and a camera that turns light into numbers.

use glam::DVec2;
use std::sync::Arc;

use crate::warnings::{beams_out_of_order, blind_threshold, with_columns};
use raypencil_files::FolderError;
use raypencil_rover::{DrivePlan, Rig};
use raypencil_scene::{FluxModel, Image, Mesh, SceneError};
use raypencil_scene_io::{DriveSetup, LoadedScene, SceneSource};
use raypencil_sensor::{ImageSensor, Optics, Sunlight};

/// A drive has no more frames: an hour of them at ten a second. Each leaves some two thousand edge points in memory.
pub(super) const MOST_FRAMES: u64 = 36_000;

/// Why there is no drive.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum DriveError {
    /// A scene that says nothing of where to go.
    #[error(
        "there is no drive; expected --to X,Y, a scene file with a [drive] table (docs/guide/drive.md), or a built-in ground: \
         pyramids, facets"
    )]
    NoDrive,
    /// Light in a unit that no camera can expose.
    #[error("flux model eq1 is in W/m, which no camera can expose; expected radiometric")]
    Unit,
    /// A route without end.
    #[error(
        "the route has more than {MOST_FRAMES} frames; expected fewer: a shorter way, more speed or fewer frames per second"
    )]
    Frames,
    /// A number that the rover does not take.
    #[error(transparent)]
    Plan(#[from] SceneError),
    /// A file that could not be written.
    #[error(transparent)]
    Folder(#[from] FolderError),
}

/// A drive, ready to be driven.
#[derive(Debug, Clone)]
pub struct DriveJob {
    /// A short name, fit for a folder.
    pub name: String,
    /// The words after `raypencil drive` that give it again.
    pub arguments: String,
    /// SHA-256 of what defines the scene.
    pub sha256: String,
    /// The ground.
    pub mesh: Arc<Mesh>,
    /// The rover's plan.
    pub plan: DrivePlan,
    /// Name of the sensor preset.
    pub preset: &'static str,
    /// Step 6.
    pub optics: Optics,
    /// Steps 7 and 8.
    pub sensor: ImageSensor,
    /// The sun behind the stripes.
    pub sunlight: Option<Sunlight>,
    /// Whether a second image without the laser is taken off each.
    pub subtract_unlit: bool,
    /// What people should know of how it was set up.
    pub notes: Vec<String>,
    /// What may spoil it.
    pub warnings: Vec<String>,
}

/// Start of the drive of a built-in ground, global x and y, metres; all of them end at the origin.
fn builtin_start(name: &str) -> Option<DVec2> {
    match name {
        // "The vehicle starts at 7.5 meters from where the view from the camera in Figure 11 was taken." (§8)
        "pyramids" => Some(DVec2::new(-7.5, 0.0)),
        // CHOICE: 6 m up to where the ground is calm and the scene's own view is from. The near stripe is 3.3 m ahead and the
        // vehicle's wheels reach 0.95 m back: only after 4.2 m has it seen what it stands on.
        "facets" => Some(DVec2::new(-6.0, 0.0)),
        _ => None,
    }
}

/// Drive of a rig on a built-in ground.
fn builtin(rig: Rig) -> DriveSetup {
    let mut drive = DriveSetup::new(rig, vec![DVec2::ZERO]);
    // CHOICE: a frame each 0.1 m, a grid spacing, which its own extrapolation closes; ten frames a second would be one each
    // 3 cm.
    drive.plan.route.frame_rate = BUILTIN_FRAMES_PER_S;
    // Twice each metre, and at the very end.
    drive.plan.obstacles_every = 5;
    // CHOICE: no scans: what figures 12 and 15 leave open, stripes alone could not see.
    drive.plan.scans = None;
    drive
}

/// At 0.3 m/s a frame each 0.1 m.
const BUILTIN_FRAMES_PER_S: f64 = 3.0;

impl DriveJob {
    /// The drive that a scene file describes, or that of a built-in ground, starting at `at` if that is given.
    ///
    /// # Errors
    /// A scene without a drive; numbers that make none, by their field.
    pub fn new(loaded: &LoadedScene, at: Option<[f64; 2]>, arguments: String) -> Result<Self, DriveError> {
        let scene = &loaded.scene;
        if scene.flux_model() == FluxModel::Eq1 {
            return Err(DriveError::Unit);
        }
        let mut notes = Vec::new();
        let (mut drive, start) = match (&loaded.drive, &loaded.source) {
            (Some(drive), _) => (drive.clone(), None),
            (None, SceneSource::Builtin(name)) => {
                let start = builtin_start(name).ok_or(DriveError::NoDrive)?;
                notes.push(
                    "built-in drive: a frame each 0.1 m, not ten a second, and no vertical scans".to_string(),
                );
                (builtin(loaded.rig()), Some(at.map_or(start, DVec2::from_array)))
            }
            (None, _) => return Err(DriveError::NoDrive),
        };
        // A drive from a file was placed by the loader, but the scene may have changed since.
        drive.place(scene, &loaded.vehicle);
        drive.validate_camera()?;
        let mut plan = drive.plan;
        plan.route.start = start.unwrap_or(plan.route.start);

        let (rig, mut warnings) = with_columns(plan.rig, drive.pencils_per_pixel, &mut notes);
        plan.rig = rig;
        warnings.extend(drive.threshold_ignores.map(blind_threshold));
        warnings.extend(beams_out_of_order(&plan));
        plan.validate("drive")?;
        Ok(Self {
            name: loaded.name.clone(),
            arguments,
            sha256: loaded.source_sha256.clone(),
            mesh: Arc::clone(scene.mesh()),
            plan,
            preset: drive.preset,
            optics: drive.optics,
            sensor: drive.sensor,
            sunlight: drive.sunlight,
            subtract_unlit: drive.subtract_unlit,
            notes,
            warnings,
        })
    }

    /// Steps 7 and 8: the digital numbers of one exposure, without those of the background if a second one is taken off.
    pub(super) fn digital(
        &self,
        light: &Image<f64>,
        background: Option<&Image<f64>>,
        number: u64,
    ) -> Image<i32> {
        if self.subtract_unlit {
            return self.sensor.lit_minus_unlit(light, background, number);
        }
        self.sensor.numbers(light, background, number)
    }

    /// How many frames the route has.
    pub(super) fn frames(&self) -> Result<u64, DriveError> {
        let over = |index| self.plan.route.frame(index).is_none();
        if !over(MOST_FRAMES) {
            return Err(DriveError::Frames);
        }
        // Once it is over it stays so: halving finds the first frame that is not.
        let (mut driven, mut end) = (0, MOST_FRAMES);
        while driven < end {
            let middle = driven + (end - driven) / 2;
            if over(middle) { end = middle } else { driven = middle + 1 }
        }
        Ok(end)
    }
}
