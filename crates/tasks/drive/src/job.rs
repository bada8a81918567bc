//! Job of a drive: a loaded scene and its route become a rover's plan and a camera that turns light into numbers.

use std::sync::Arc;

use glam::DVec2;
use raypencil_mesh_io::DemFacts;
use raypencil_rover::{Detection, DrivePlan, Rig};
use raypencil_scene::{Camera, FluxModel, Image, Mesh, Pose};
use raypencil_scene_io::{DriveSetup, LoadedScene, SceneSource, WaypointFrame};
use raypencil_sensor::{FixedPattern, ImageSensor, Optics, Speckle, Sunlight};
use raypencil_survey::Warning;

use crate::background::Background;
use crate::beam_columns::with_columns;
use crate::error::{DriveError, MAX_FRAMES};
use crate::keys::in_keys;
use crate::start::height_off_ground;
use crate::warnings::{beams_out_of_order, blind_threshold, map_coarser_than_wheel, sectors_far_apart};

/// The renderer that makes every approximation of the paper.
const PAPERS_RENDERER: &str = "scanline-paper";

/// Name of the renderer of a drive for which none is named. Of the exact ones, `scanline` takes half the time of `tracer`, both
/// on 224 and on 225,280 faces.
pub fn drive_renderer(is_as_printed: bool) -> &'static str {
    if is_as_printed { PAPERS_RENDERER } else { "scanline" }
}

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
/// // 7.5 m at 0.3 m/s take 25 s: 251 frames at ten per second, both ends included.
/// assert!(route.frame(250).is_some() && route.frame(251).is_none());
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
    /// Pose of the scene's `[vehicle]`, global; `None`: the scene has no vehicle. A drive takes place and heading of it, and warns
    /// if the vehicle leans otherwise.
    pub vehicle_of_scene: Option<Pose>,
    /// Height at which the scene puts the vehicle, global, metres; `None`: on the ground. Refused if it does not stand there.
    pub height_off_ground: Option<f64>,
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
    /// EPSG code of the map in which the ground lies, if it has one in metres.
    pub map_code: Option<u16>,
    /// Whether the scene asks for a camera: a sensor preset, optics, electronics or a sun.
    pub has_camera: bool,
    /// Threshold of images of flux, as a share of their maximum.
    pub threshold_share: f64,
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
    let mut drive = DriveSetup::new(rig, vec![DVec2::ZERO], WaypointFrame::Global);
    // CHOICE: no scans. Figures 12 and 15 show the cells that the stripes alone do not see.
    drive.plan.scans = None;
    drive
}

fn speckle_note(speckle: &Speckle, camera: &Camera) -> String {
    format!(
        "speckle: contrast {} at a point and {:.3} on a pixel, grain {:.3} um",
        speckle.contrast,
        speckle.contrast_in(camera.pixel_pitch),
        1e6 * speckle.grain
    )
}

impl DriveJob {
    /// Job of the drive that a scene file describes, or of the route of a built-in ground. A built-in route starts at
    /// `at` (global x and y, metres) if it is given. `arguments` are the words for [`DriveJob::arguments`].
    ///
    /// # Errors
    /// [`DriveError::NoDrive`] and [`DriveError::NoWaypoints`] for a scene without a route, [`DriveError::NoBeams`] for one
    /// without a beam, [`DriveError::Unit`] for the flux model `eq1` with a camera, [`DriveError::Plan`] with the field of a number out of range.
    pub fn new(loaded: &LoadedScene, at: Option<[f64; 2]>, arguments: String) -> Result<Self, DriveError> {
        let scene = &loaded.scene;
        let mut notes = Vec::new();
        let (mut drive, start) = match (&loaded.drive, &loaded.source) {
            (Some(drive), _) if !drive.waypoints.is_empty() => (drive.clone(), None),
            // A built-in ground has a route of its own; settings say how it is driven.
            (drive, SceneSource::Builtin(name)) => {
                let start = builtin_start(name).ok_or(DriveError::NoDrive)?;
                // A place that the settings give takes the place of the route's own start. Without one it is the origin, the
                // route's end.
                let placed = Some(loaded.vehicle.position.truncate()).filter(|&place| place != DVec2::ZERO);
                let start = Some(at.map(DVec2::from_array).or(placed).unwrap_or(start));
                match drive {
                    None => {
                        notes.push("built-in drive: no vertical scans".to_string());
                        (builtin_drive(loaded.rig()), start)
                    }
                    Some(drive) => {
                        notes.push("built-in route".to_string());
                        let (waypoints, waypoint_frame) = (vec![DVec2::ZERO], WaypointFrame::Global);
                        (DriveSetup { waypoints, waypoint_frame, ..drive.clone() }, start)
                    }
                }
            }
            (Some(_), _) => return Err(DriveError::NoWaypoints),
            (None, _) => return Err(DriveError::NoDrive),
        };
        if scene.beams().is_empty() {
            return Err(DriveError::NoBeams);
        }
        // A drive from a file was placed by the loader, but the scene may have changed since.
        drive.place(scene, &loaded.vehicle);
        drive.validate_camera().map_err(in_keys)?;
        let mut plan = drive.plan;
        if plan.flux_model == FluxModel::Eq1 {
            if drive.has_camera {
                return Err(DriveError::Unit);
            }
            plan.extraction.detection = Detection::Share(drive.threshold_share);
        }
        plan.route.start = start.unwrap_or(plan.route.start);

        let mut warnings = loaded.file_warnings();
        let (rig, of_columns) = with_columns(plan.rig, drive.pencils_per_pixel, &mut notes);
        plan.rig = rig;
        warnings.extend(of_columns);
        warnings.extend(drive.threshold_ignores.map(blind_threshold));
        warnings.extend(beams_out_of_order(&plan));
        notes.extend(drive.optics.speckle.map(|speckle| speckle_note(&speckle, &plan.rig.camera.sensor)));
        plan.validate("drive").map_err(in_keys)?;
        warnings.extend(sectors_far_apart(&plan));
        warnings.extend(map_coarser_than_wheel(&plan));
        Ok(Self {
            name: loaded.name.clone(),
            arguments,
            sha256: loaded.source_sha256.clone(),
            mesh: Arc::clone(scene.mesh()),
            plan,
            vehicle_of_scene: loaded.standing_vehicle(),
            height_off_ground: loaded
                .standing_vehicle()
                .and_then(|vehicle| height_off_ground(&vehicle, scene.mesh())),
            preset: drive.preset,
            optics: drive.optics,
            sensor: drive.sensor,
            sunlight: drive.sunlight,
            subtract_unlit: drive.subtract_unlit,
            map_code: loaded.file_facts.dem().and_then(DemFacts::metric_map_code),
            has_camera: drive.has_camera,
            threshold_share: drive.threshold_share,
            notes,
            warnings,
        })
    }

    /// The same drive by the paper's own rules: [`DrivePlan::as_printed`], with the flux of its equation 1. The image stays
    /// in W/m: no photons, no noise, and a threshold as a share of its maximum. `renderers` are the names of the renderers, for
    /// a note that says whether they are the paper's ([`drive_renderer`]).
    ///
    /// # Errors
    /// [`DriveError::Unit`] if the scene asks for a camera that exposes photons.
    pub fn as_printed(mut self, renderers: &str) -> Result<Self, DriveError> {
        if self.has_camera {
            return Err(DriveError::Unit);
        }
        self.plan = self.plan.as_printed();
        self.plan.flux_model = FluxModel::Eq1;
        self.plan.extraction.detection = Detection::Share(self.threshold_share);
        self.notes
            .push("as printed: ten frames a second, both beams together, eq1, table, printed rules".into());
        self.notes.push(match renderers {
            PAPERS_RENDERER => format!("rendered by {PAPERS_RENDERER}, with all of the paper's approximations"),
            _ => format!(
                "rendered by {renderers}, as asked for, and not by {PAPERS_RENDERER}, the default as printed: \
                 without the paper's approximations"
            ),
        });
        Ok(self)
    }

    /// Whether images are the flux itself, in W/m: no camera exposes that.
    pub fn is_flux_only(&self) -> bool {
        self.plan.flux_model == FluxModel::Eq1
    }

    /// Digital numbers of one exposure, steps 7 and 8. `flux` is the laser's light and `background` that of sun and
    /// sky, both in watts per pixel; `number` selects the noise. With `subtract_unlit`, the numbers of a second
    /// exposure without the laser are subtracted.
    /// `pattern` keeps the noise that is the same in every exposure.
    pub(crate) fn expose(
        &self,
        flux: &Image<f64>,
        background: Option<&Background>,
        number: u64,
        pattern: &mut Option<FixedPattern>,
    ) -> Image<i32> {
        let size = (flux.width(), flux.height());
        if !pattern.as_ref().is_some_and(|pattern| pattern.is_of(&self.sensor, size)) {
            *pattern = Some(self.sensor.fixed_pattern(size.0, size.1));
        }
        let (lit, unlit) = (background.map(|light| &light.lit), background.map(Background::unlit));
        if self.subtract_unlit {
            return self.sensor.lit_minus_unlit(pattern.as_ref(), flux, [lit, unlit], number);
        }
        self.sensor.numbers_with(pattern.as_ref(), flux, lit, number)
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
