//! Job of a drive: a loaded scene and its route become a rover's plan and a camera that turns light into numbers.

use std::sync::Arc;

use glam::DVec2;
use raypencil_rover::{DrivePlan, Rig};
use raypencil_scene::{FluxModel, Image, Mesh};
use raypencil_scene_io::{DriveSetup, LoadedScene, SceneSource};
use raypencil_sensor::{FixedPattern, ImageSensor, Optics, Sunlight};
use raypencil_survey::Warning;

use crate::beam_columns::with_columns;
use crate::error::{DriveError, MAX_FRAMES};
use crate::warnings::{beams_out_of_order, blind_threshold};

/// Frame rate of the built-in drives, frames per second: one frame per 0.1 m at 0.3 m/s.
const BUILTIN_FRAMES_PER_S: f64 = 3.0;

/// Drive, ready to start: ground, plan of the rover and camera.
///
/// ```
/// use raypencil_drive::DriveJob;
/// use raypencil_scene_io::{Overrides, load};
///
/// let job = DriveJob::new(&load("pyramids", &Overrides::default())?, None, "pyramids".into())?;
/// // "The vehicle starts at 7.5 meters from where the view from the camera in Figure 11 was taken." (Paper, section 8)
/// let route = &job.plan.route;
/// assert_eq!((route.start.x, route.waypoints[0].x), (-7.5, 0.0));
/// // One frame per 0.1 m, from the start to the end: 76 frames.
/// assert!(route.frame(75).is_some() && route.frame(76).is_none());
/// // 4 pencils per pixel, where the fan of 60 degrees fills 2 tan(30 deg) 8 mm / 9 um = 1026.4 pixels.
/// assert_eq!(job.plan.rig.beams[0].sensor.columns, 4106);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct DriveJob {
    /// Short name of the scene, usable as a folder name.
    pub name: String,
    /// Command-line arguments after `raypencil drive` that repeat this drive.
    pub arguments: String,
    /// SHA-256 of the files that define the scene.
    pub sha256: String,
    /// Ground.
    pub mesh: Arc<Mesh>,
    /// Plan of the rover: route, rig, rules and errors.
    pub plan: DrivePlan,
    /// Name of the preset of the image sensor.
    pub preset: &'static str,
    /// Optics, step 6 of section 3.
    pub optics: Optics,
    /// Image sensor, steps 7 and 8.
    pub sensor: ImageSensor,
    /// Sun and sky behind the stripes; `None`: darkness.
    pub sunlight: Option<Sunlight>,
    /// Whether an image without the laser is subtracted from each image.
    pub subtract_unlit: bool,
    /// Notes on how the drive was set up.
    pub notes: Vec<String>,
    /// Warnings about settings that may spoil the drive.
    pub warnings: Vec<Warning>,
}

/// Start of the drive of a built-in ground, global x and y, metres. All of them end at the origin.
fn builtin_start(name: &str) -> Option<DVec2> {
    match name {
        // "The vehicle starts at 7.5 meters from where the view from the camera in Figure 11 was taken." (§8)
        "pyramids" => Some(DVec2::new(-7.5, 0.0)),
        // CHOICE: 6 m, which end at the scene's own viewpoint, on calm ground. The near stripe is 3.3 m ahead and the
        // wheels reach 0.95 m back: only after 4.2 m has the vehicle seen the ground under it.
        "facets" => Some(DVec2::new(-6.0, 0.0)),
        _ => None,
    }
}

/// Drive of a rig on a built-in ground.
fn builtin_drive(rig: Rig) -> DriveSetup {
    let mut drive = DriveSetup::new(rig, vec![DVec2::ZERO]);
    // CHOICE: one frame per 0.1 m, the spacing of the map: the map's own extrapolation closes the space between.
    // Ten frames per second would be one per 3 cm.
    drive.plan.route.frame_rate = BUILTIN_FRAMES_PER_S;
    // Every 0.5 m, and at the very end.
    drive.plan.obstacles_every = 5;
    // CHOICE: no scans. Figures 12 and 15 show the cells that the stripes alone do not see.
    drive.plan.scans = None;
    drive
}

impl DriveJob {
    /// Job of the drive that a scene file describes, or of the route of a built-in ground. A built-in route starts at
    /// `at` (global x and y, metres) if it is given. `arguments` are the words for [`DriveJob::arguments`].
    ///
    /// # Errors
    /// [`DriveError::NoDrive`] for a scene without a route, [`DriveError::Unit`] for the flux model `eq1`,
    /// [`DriveError::Plan`] with the field of a number out of range.
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
                    "built-in drive: one frame per 0.1 m, not ten per second, and no vertical scans"
                        .to_string(),
                );
                (builtin_drive(loaded.rig()), Some(at.map_or(start, DVec2::from_array)))
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

    /// Digital numbers of one exposure, steps 7 and 8. `flux` is the laser's light and `background` that of sun and
    /// sky, both in watts per pixel; `number` selects the noise. With `subtract_unlit`, the numbers of a second
    /// exposure without the laser are subtracted.
    /// `pattern` keeps the noise that is the same in every exposure.
    pub(crate) fn expose(
        &self,
        flux: &Image<f64>,
        background: Option<&Image<f64>>,
        number: u64,
        pattern: &mut Option<FixedPattern>,
    ) -> Image<i32> {
        let size = (flux.width(), flux.height());
        if !pattern.as_ref().is_some_and(|pattern| pattern.is_of(&self.sensor, size)) {
            *pattern = Some(self.sensor.fixed_pattern(size.0, size.1));
        }
        if self.subtract_unlit {
            return self.sensor.lit_minus_unlit(pattern.as_ref(), flux, background, number);
        }
        self.sensor.numbers_with(pattern.as_ref(), flux, background, number)
    }

    /// Number of frames of the route.
    ///
    /// # Errors
    /// [`DriveError::Frames`] if there are more than [`MAX_FRAMES`].
    pub(crate) fn frames(&self) -> Result<u64, DriveError> {
        let is_over = |index| self.plan.route.frame(index).is_none();
        if !is_over(MAX_FRAMES) {
            return Err(DriveError::Frames);
        }
        // No frame follows the first one that is missing: bisection finds it.
        let (mut driven, mut end) = (0, MAX_FRAMES);
        while driven < end {
            let middle = driven + (end - driven) / 2;
            if is_over(middle) { end = middle } else { driven = middle + 1 }
        }
        Ok(end)
    }
}

#[cfg(test)]
#[path = "../tests/unit/job.rs"]
mod tests;
