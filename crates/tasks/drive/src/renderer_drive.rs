//! One renderer's drive: the rover, the camera's pipeline from flux to digital numbers, and the time that each part
//! takes.

use std::sync::Arc;
use std::time::{Duration, Instant};

use raypencil_rover::{CameraImage, Drive, DriveFrame, DrivePlan, ElevationMap, Exposure, StripeExtractor};
use raypencil_scene::{Image, Pose, Renderer, Scene, SceneError, Stage};
use raypencil_sensor::FixedPattern;
use raypencil_terrain::HeightIndex;

use crate::background::Background;
use crate::exact_map::ExactMap;
use crate::job::DriveJob;
use crate::keys::in_keys;
use crate::recorded_exposure::{MAX_LIT_PIXELS, RecordedExposure};
use crate::start::check_height;
use crate::sun::Sun;
use crate::swept_ground::SweptGround;
use crate::through_optics::ThroughOptics;
use crate::warnings::with_hint;

/// Drive in progress with one renderer.
pub(crate) struct RendererDrive<'a> {
    job: &'a DriveJob,
    renderer: ThroughOptics<'a>,
    drive: Drive,
    /// Number of exposures so far.
    exposures: u64,
    /// Noise that is the same in all of them.
    pattern: Option<FixedPattern>,
    /// Scenes of the last exposure and their light of sun and sky: beams that are lit at once have the same.
    sunlit: Vec<(Scene, Image<f64>)>,
    /// What the stripes swept, if the drive is to be held to the truth.
    swept: Option<SweptGround>,
    /// The map that a rover with exact eyes would have of it; likewise.
    exact: Option<ExactMap>,
    /// Whether the last exposure belonged to a scan.
    was_scan: bool,
    /// Time of the sensor, steps 7 and 8.
    exposing: Duration,
    /// Time of all steps, rendering and sensor included.
    stepping: Duration,
}

/// One frame of a drive with its exposures.
pub(crate) struct ExposedFrame {
    pub frame: DriveFrame,
    /// Records of all exposures, if they were requested.
    pub recorded: Vec<RecordedExposure>,
    /// Lit beam and digital numbers of each exposure, without those of a scan. No beam: all are lit.
    pub images: Vec<(Option<usize>, Image<i32>)>,
}

impl<'a> RendererDrive<'a> {
    /// Drive of a job at its start.
    ///
    /// # Errors
    /// As [`Drive::new`], with the keys of a scene file; names `vehicle.position_m` for a height at which the vehicle does not stand.
    pub(crate) fn new(
        job: &'a DriveJob,
        renderer: &'a dyn Renderer,
        sun: Option<&'a Sun>,
    ) -> Result<Self, SceneError> {
        let drive = Drive::new(job.plan.clone(), Arc::clone(&job.mesh))
            .map_err(|error| in_keys(with_hint(error, &job.mesh)))?;
        if let Some(given) = job.height_off_ground {
            check_height(given, &drive)?;
        }
        Ok(Self {
            job,
            renderer: ThroughOptics::new(renderer, job).in_sunlight(sun),
            drive,
            exposures: 0,
            pattern: None,
            sunlit: Vec::new(),
            swept: None,
            exact: None,
            was_scan: false,
            exposing: Duration::ZERO,
            stepping: Duration::ZERO,
        })
    }

    /// The same drive with another extraction of stripes.
    pub(crate) fn with_extractor(self, extractor: Option<&Arc<dyn StripeExtractor>>) -> Self {
        let Some(extractor) = extractor else { return self };
        Self { drive: self.drive.with_extractor(Arc::clone(extractor)), ..self }
    }

    /// The same drive, which also keeps what its stripes swept.
    pub(crate) fn keeping_swept(self) -> Self {
        let DrivePlan { map, route, .. } = &self.job.plan;
        let swept = SweptGround::new(*map, route.start);
        let exact = ExactMap::new(&self.job.plan);
        Self { swept: Some(swept), exact: Some(exact), renderer: self.renderer.keeping_lit(), ..self }
    }

    /// What the stripes swept so far; `None` if it is not kept.
    pub(crate) fn swept(&self) -> Option<&SweptGround> {
        self.swept.as_ref()
    }

    /// Adds to the map of exact points what the stripes swept so far.
    pub(crate) fn fill_exact_map(&mut self) {
        if let (Some(exact), Some(swept)) = (&mut self.exact, &self.swept) {
            exact.fill(swept, self.drive.ground());
        }
    }

    /// Map of the exact points so far; `None` if it is not kept.
    pub(crate) fn exact_map(&self) -> Option<&ElevationMap> {
        self.exact.as_ref().map(ExactMap::map)
    }

    /// Next frame; `None` at the end of the route. `record`: keep records of its exposures. `look` sees every image that the
    /// stripe extraction gets.
    ///
    /// # Errors
    /// As [`Drive::step`].
    pub(crate) fn step(
        &mut self,
        record: bool,
        look: &mut dyn FnMut(&Exposure, &CameraImage),
    ) -> Result<Option<ExposedFrame>, SceneError> {
        let (mut recorded, mut images, mut room) = (Vec::new(), Vec::new(), MAX_LIT_PIXELS);
        let (job, renderer) = (self.job, &self.renderer);
        let (exposures, exposing, pattern) = (&mut self.exposures, &mut self.exposing, &mut self.pattern);
        let sunlit = &mut self.sunlit;
        let (swept, exact, was_scan) = (&mut self.swept, &mut self.exact, &mut self.was_scan);
        let (heights, clears) =
            (Arc::clone(self.drive.ground()), job.plan.scans.is_some_and(|scans| scans.clear_map));
        let mut camera_pipeline = |exposure: Exposure, flux: Image<f64>| {
            let start = Instant::now();
            if let (Some(swept), Some((scene, lit))) = (swept.as_mut(), renderer.take_lit()) {
                let camera = scene.camera().scene_from_sensor.position + scene.mesh().origin();
                swept.recentre(camera.truncate(), &heights);
                let forgets = exposure.step == Some(0) && clears;
                if forgets {
                    swept.clear();
                }
                if let Some(exact) = exact.as_mut() {
                    if forgets {
                        exact.clear();
                    }
                    exact.add(&scene, &lit);
                }
                let is_scan = exposure.step.is_some();
                swept.add(&scene, &lit, exposure.step == Some(0) || is_scan != *was_scan);
                *was_scan = is_scan;
            }
            // Steps 7 and 8.
            let new = renderer.take_backgrounds();
            if !new.is_empty() {
                *sunlit = new;
            }
            let times = &job.plan.times;
            let has_moved = exposure.step.is_none() && !times.is_at_once() && times.has_unlit;
            let of_lit = if has_moved { sunlit.len() / 2 } else { sunlit.len() };
            let backgrounds: Vec<_> = sunlit.iter().map(|(_, image)| image).collect();
            let light = Background::new(&backgrounds, of_lit, times);
            let numbers = match job.is_flux_only() {
                true => lit_mask(&flux, job.threshold_share),
                false => job.expose(&flux, light.as_ref(), *exposures, pattern),
            };
            if record {
                let scenes = (sunlit.iter().map(|(scene, _)| scene.clone()).collect(), of_lit);
                let record = RecordedExposure::new(exposure, *exposures, scenes, &flux, &numbers, room);
                room -= record.lit_pixels();
                recorded.push(record);
            }
            *exposures += 1;
            if exposure.step.is_none() {
                images.push((exposure.beam, numbers.clone()));
            }
            let image =
                if job.is_flux_only() { CameraImage::Flux(flux) } else { CameraImage::Numbers(numbers) };
            *exposing += start.elapsed();
            look(&exposure, &image);
            image
        };
        let start = Instant::now();
        let frame = self.drive.step(renderer, &mut camera_pipeline).map_err(in_keys)?;
        self.stepping += start.elapsed();
        if let (Some(frame), Some(exact), Some(mapper)) = (&frame, &mut self.exact, self.drive.mapper()) {
            exact.end_frame(mapper.map(), self.drive.ground(), frame.stance.position.truncate());
        }
        Ok(frame.map(|frame| ExposedFrame { frame, recorded, images }))
    }

    /// Elevation map after the last frame.
    pub(crate) fn map(&self) -> &ElevationMap {
        self.drive.mapper().expect("at least one frame was driven").map()
    }

    /// Estimated pose after the last frame.
    pub(crate) fn believed(&self) -> Pose {
        self.drive.mapper().expect("at least one frame was driven").pose()
    }

    /// True ground.
    pub(crate) fn ground(&self) -> &Arc<HeightIndex> {
        self.drive.ground()
    }

    /// Time of each part of the work, without parts that took none.
    pub(crate) fn stages(&self) -> Vec<Stage> {
        let times = self.renderer.times();
        let name = self.renderer.name();
        let rest = self.stepping.saturating_sub(times.rendering + times.optics + times.sun + self.exposing);
        [
            ("steps 1 to 5, rendering", times.rendering),
            ("step 6, optics", times.optics),
            ("the sun behind the stripes", times.sun),
            ("steps 7 and 8, camera", self.exposing),
            ("step 9, points and maps", rest),
        ]
        .into_iter()
        .filter(|(_, time)| *time > Duration::ZERO)
        .map(|(stage, time)| Stage { name: format!("{name}: {stage}"), time })
        .collect()
    }
}

/// What stands for digital numbers where the image is one of flux: 1 at or above a share of its maximum, otherwise 0.
fn lit_mask(flux: &Image<f64>, share: f64) -> Image<i32> {
    let largest = flux.cells().iter().copied().fold(0.0, f64::max);
    let is_lit = |&flux: &f64| i32::from(largest > 0.0 && flux >= share * largest);
    Image::from_cells(flux.width(), flux.height(), flux.cells().iter().map(is_lit).collect())
}

#[cfg(test)]
#[path = "../tests/unit/motion.rs"]
mod motion_tests;
