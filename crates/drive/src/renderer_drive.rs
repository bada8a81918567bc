//! One renderer's drive: the rover, the camera's pipeline from flux to digital numbers, and the time that each part
//! takes.

use std::sync::Arc;
use std::time::{Duration, Instant};

use raypencil_rover::{CameraImage, Drive, DriveFrame, ElevationMap, Exposure};
use raypencil_scene::{Image, Pose, Renderer, SceneError, Stage};
use raypencil_sensor::FixedPattern;
use raypencil_terrain::HeightIndex;

use crate::job::DriveJob;
use crate::recorded_exposure::{MAX_LIT_PIXELS, RecordedExposure};
use crate::sun::Sun;
use crate::through_optics::ThroughOptics;

/// Drive in progress with one renderer.
pub(crate) struct RendererDrive<'a> {
    job: &'a DriveJob,
    renderer: ThroughOptics<'a>,
    drive: Drive,
    /// Number of exposures so far.
    exposures: u64,
    /// Noise that is the same in all of them.
    pattern: Option<FixedPattern>,
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
    /// As [`Drive::new`].
    pub(crate) fn new(
        job: &'a DriveJob,
        renderer: &'a dyn Renderer,
        sun: Option<&'a Sun>,
    ) -> Result<Self, SceneError> {
        Ok(Self {
            job,
            renderer: ThroughOptics::new(renderer, job, sun),
            drive: Drive::new(job.plan.clone(), Arc::clone(&job.mesh))?,
            exposures: 0,
            pattern: None,
            exposing: Duration::ZERO,
            stepping: Duration::ZERO,
        })
    }

    /// Next frame; `None` at the end of the route. `record`: keep records of its exposures.
    ///
    /// # Errors
    /// As [`Drive::step`].
    pub(crate) fn step(&mut self, record: bool) -> Result<Option<ExposedFrame>, SceneError> {
        let (mut recorded, mut images, mut room) = (Vec::new(), Vec::new(), MAX_LIT_PIXELS);
        let (job, renderer) = (self.job, &self.renderer);
        let (exposures, exposing, pattern) = (&mut self.exposures, &mut self.exposing, &mut self.pattern);
        let mut camera_pipeline = |exposure: Exposure, flux: Image<f64>| {
            let start = Instant::now();
            // Steps 7 and 8.
            let background = renderer.background();
            let light = background.as_ref().map(|(_, flux)| flux);
            let numbers = job.expose(&flux, light, *exposures, pattern);
            if record {
                let scene = background.map(|(scene, _)| scene);
                let record = RecordedExposure::new(exposure, *exposures, scene, &flux, &numbers, room);
                room -= record.lit_pixels();
                recorded.push(record);
            }
            *exposures += 1;
            if exposure.step.is_none() {
                images.push((exposure.beam, numbers.clone()));
            }
            *exposing += start.elapsed();
            CameraImage::Numbers(numbers)
        };
        let start = Instant::now();
        let frame = self.drive.step(renderer, &mut camera_pipeline)?;
        self.stepping += start.elapsed();
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
    pub(crate) fn ground(&self) -> &HeightIndex {
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
