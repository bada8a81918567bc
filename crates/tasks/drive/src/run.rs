//! Drive from its first frame to its last, with one renderer or with two in lockstep.

use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};

use raypencil_chassis::GroundFaces;
use raypencil_files::{FolderError, OutputFolder};
use raypencil_report::Drawing;
use raypencil_rover::{
    Detection, DriveFrame, DrivePlan, ElevationMap, LabelledVector, ObstacleMap, StripeExtractor,
};
use raypencil_scene::{Pose, Renderer, Scene, SceneError, Silent, Stage};
use raypencil_survey::{Warning, Whereabouts, plan as survey_plan};

use crate::animation_frame::{AnimationFrame, HALF_SIDE_PX, MapThumbnail};
use crate::camera_view::{CameraView, camera_view};
use crate::differences::Differences;
use crate::error::DriveError;
use crate::history::DriveHistory;
use crate::job::DriveJob;
use crate::maps::ply::MarkedPoint;
use crate::point_errors::PointErrors;
use crate::recording::{RecordContents, Recording};
use crate::renderer_drive::{ExposedFrame, RendererDrive};
use crate::sector_truth::{SectorTruth, TrueGround, first_obstacles};
use crate::start::leans_otherwise;
use crate::sun::Sun;
use crate::warnings::{at_the_start, nothing_measured, start_too_steep, stripes_left_over, way_too_steep};

/// Maximum number of animation frames: a few megabytes.
const MAX_ANIMATION_FRAMES: u64 = 60;

/// Maximum number of edge points that are kept: half a gigabyte.
const MAX_EDGE_POINTS: usize = 1 << 24;

/// Longest side of the camera's view in the figure, pixels.
const FIGURE_VIEW_SIDE_PX: u32 = 640;

/// Receiver of progress messages.
pub trait DriveProgress: Sync {
    /// `done` frames of `planned` are done.
    fn frames(&self, done: u64, planned: u64);

    /// `done` stripes of the `planned` ones of a vertical scan are done. The frame of the scan goes on.
    fn scan(&self, done: u64, planned: u64);
}

/// Discards them.
impl DriveProgress for Silent {
    fn frames(&self, _done: u64, _planned: u64) {}

    fn scan(&self, _done: u64, _planned: u64) {}
}

/// What may be added to a drive.
#[derive(Debug, Default)]
pub struct DriveExtras {
    /// Extraction of stripes in place of the rover's own, for all renderers.
    pub extractor: Option<Arc<dyn StripeExtractor>>,
    /// Folder of the drive, and what is recorded there of the first renderer's drive. The recording begins when the drive
    /// has been accepted.
    pub record: Option<(PathBuf, RecordContents)>,
    /// The run that has the folder. When the recording begins, it removes what earlier drives have made in the folder: nobody
    /// takes their maps for those of a drive that goes on, or that was stopped. `None`: they stay, as with
    /// [`OutputFolder::finish`] alone, until the end.
    pub output: Option<Arc<OutputFolder>>,
}

/// Result of a drive.
#[derive(Debug)]
pub struct DriveRun {
    /// Camera's view at the end.
    pub(crate) last_view: CameraView,
    /// At most 60 frames of the animation.
    pub(crate) animation: Vec<AnimationFrame>,
    /// Names of the renderers. Maps, points and views are those of the first.
    pub renderers: Vec<String>,
    /// All frames, without their points and obstacle maps.
    pub frames: Vec<DriveFrame>,
    /// Number of frames of the route: more than were driven if it leads off the ground.
    pub planned: u64,
    /// Elevation map at the end.
    pub map: ElevationMap,
    /// Estimated pose at the end, `global_from_vehicle`.
    pub believed: Pose,
    /// Frame of the last obstacle map, that map, and its navigator map.
    pub obstacles: Option<(u64, ObstacleMap, Vec<LabelledVector>)>,
    /// All obstacle maps against what the vehicle can pass on the true ground.
    pub truth: SectorTruth,
    /// The same of a rover with exact eyes, which knows where it stands: its map holds the true points that stripes lit and the
    /// camera saw, and its rules are the drive's own. No better image and no better sensor would find more.
    pub upper_bound: SectorTruth,
    /// Edge points against the true ground.
    pub point_errors: PointErrors,
    /// Number of edge points of all frames.
    pub edge_points: u64,
    /// Edge points, global: the first 16,777,216.
    pub points: Vec<MarkedPoint>,
    /// Warnings about the scene at the start, and about a drive that measured nothing.
    pub warnings: Vec<Warning>,
    /// Where vehicle, sensors and terrain are at the start.
    pub whereabouts: Whereabouts,
    /// The same from above.
    pub(crate) plan: Drawing,
    /// Ground and rig at the start.
    pub(crate) scene_at_start: Scene,
    /// The drive frame by frame.
    pub(crate) history: DriveHistory,
    /// Differences between the two sides; `None` with one renderer.
    pub differences: Option<Differences>,
    /// Time of each part of the work.
    pub stages: Vec<Stage>,
}

impl DriveRun {
    /// Distance driven, metres.
    pub fn driven(&self) -> f64 {
        self.frames.last().map_or(0.0, |frame| frame.place.driven)
    }

    /// Whether both sides are identical, or there is only one.
    pub fn passes(&self) -> bool {
        self.differences.as_ref().is_none_or(Differences::is_identical)
    }
}

/// Drives a job with one renderer, or with two in lockstep: on the same plan and with the same seeds.
///
/// # Errors
/// [`DriveError::Frames`] for a route that is too long; [`DriveError::Plan`] for a start off the ground, or at another height
/// than the scene says, and for scenes that `scene` refuses.
///
/// # Panics
/// If there are no renderers, or more than two.
///
/// ```
/// use raypencil_drive::{DriveJob, drive};
/// use raypencil_scanline::Scanline;
/// use raypencil_scene::Silent;
/// use raypencil_scene_io::load_text;
/// use raypencil_tracer::Tracer;
///
/// let scene = "version = 1
///     vehicle = { position_m = [-0.6, 0] }
///     camera = { width_px = 96, height_px = 96, pixel_pitch_um = 96 }
///     beam = [{ rows = 2 }, { rows = 2 }]
///     terrain = { builtin = 'pyramids' }
///     drive = { waypoints_m = [[0.6, 0]], frames_per_s = 3, scans = false }";
/// let job = DriveJob::new(&load_text(scene, "small")?, None, "small.toml".into())?;
/// let run = drive(&job, &[&Scanline::default(), &Tracer::new()], &Silent)?;
/// // 0.6 m at 0.3 m/s take 2 s: 7 frames at 3 per second, both ends included.
/// assert_eq!((run.frames.len(), run.planned), (7, 7));
/// assert!((run.driven() - 0.6).abs() < 1e-12);
/// // The two renderers round differently, but their stripes are the same to the last pixel.
/// assert!(run.passes());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn drive(
    job: &DriveJob,
    renderers: &[&dyn Renderer],
    progress: &dyn DriveProgress,
) -> Result<DriveRun, DriveError> {
    drive_with(job, renderers, DriveExtras::default(), progress)
}

/// The same with extras: another extraction of stripes, and a recording.
///
/// # Errors
/// As [`drive`]; [`DriveError::Folder`] for a recording that cannot be written.
///
/// # Panics
/// As [`drive`].
pub fn drive_with(
    job: &DriveJob,
    renderers: &[&dyn Renderer],
    extras: DriveExtras,
    progress: &dyn DriveProgress,
) -> Result<DriveRun, DriveError> {
    let DriveExtras { extractor, record, output } = extras;
    assert!((1..=2).contains(&renderers.len()), "{} renderers", renderers.len());
    let planned = job.frames()?;
    let animation_step = planned.div_ceil(MAX_ANIMATION_FRAMES).max(1);
    let sun = Sun::of(job)?;
    let start = |at: usize| -> Result<Option<RendererDrive>, SceneError> {
        let Some(&renderer) = renderers.get(at) else { return Ok(None) };
        let drive = RendererDrive::new(job, renderer, sun.as_ref())?;
        Ok(Some(drive.with_extractor(extractor.as_ref())))
    };
    let mut first = start(0)?.expect("there is a renderer").keeping_swept();
    let mut second = start(1)?;
    let begin =
        |(folder, contents): (PathBuf, _)| Recording::begin(&folder, job, contents, output.as_deref());
    let mut recording = record.map(begin).transpose()?;
    let stripes = u64::from(job.plan.sweep.steps);
    progress.frames(0, planned);
    let mut differences = second.as_ref().map(|_| Differences::default());
    let (mut frames, mut points, mut animation) = (Vec::new(), Vec::new(), Vec::new());
    let (mut obstacles, mut edge_points, mut point_errors) = (None, 0, PointErrors::default());
    let mut history = DriveHistory::new(planned);
    let start = Instant::now();
    let faces = GroundFaces::new(&job.mesh);
    let (mut truth, mut upper_bound, mut judging) =
        (SectorTruth::default(), SectorTruth::default(), start.elapsed());
    let mut last: Option<(ExposedFrame, Pose)> = None;
    let (mut comparing, mut drawing) = (Duration::ZERO, Duration::ZERO);

    loop {
        let exposed = first.step(second.is_some(), &mut |exposure, image| {
            if let Some(step) = exposure.step {
                progress.scan(u64::from(step), stripes);
            }
            if let Some(recording) = &mut recording {
                recording.image(job, exposure, image);
            }
        })?;
        if let (Some(second), Some(differences)) = (&mut second, &mut differences) {
            let other = second.step(true, &mut |_, _| {})?;
            let start = Instant::now();
            if let (Some(exposed), Some(other)) = (&exposed, &other) {
                differences.add_exposures(job, sun.as_ref(), &exposed.recorded, &other.recorded);
                differences.add_frame(&exposed.frame, &other.frame, [first.map(), second.map()]);
            }
            comparing += start.elapsed();
        }
        let Some(mut exposed) = exposed else { break };

        let frame = &mut exposed.frame;
        let believed = frame.believed;
        let start = Instant::now();
        if frame.obstacles.is_some() {
            first.fill_exact_map();
        }
        let judged = match (&frame.obstacles, first.swept(), first.exact_map()) {
            (Some((map, _)), Some(swept), Some(exact)) => {
                let ground = TrueGround { heights: first.ground(), swept };
                let stance = frame.stance.pose();
                let firsts = first_obstacles(&faces, &job.plan, &stance);
                let DrivePlan { vehicle, rules, grid, .. } = &job.plan;
                let bound = ObstacleMap::extract(exact, vehicle, rules, grid, &stance);
                upper_bound.add(&bound.sectors, first.map(), &ground, &job.plan, &stance, &firsts);
                truth.add(&map.sectors, first.map(), &ground, &job.plan, &stance, &firsts)
            }
            _ => Vec::new(),
        };
        judging += start.elapsed();
        if let Some(recording) = &mut recording {
            recording.frame(job, frame, &judged, first.map()).map_err(FolderError::from)?;
        }
        history.add(frame, &judged, first.map());
        edge_points += frame.measured.len() as u64;
        point_errors.add(&frame.measured, &frame.stance.pose(), first.ground());
        let room = MAX_EDGE_POINTS - points.len();
        points.extend(frame.measured.iter().take(room).map(|measured| MarkedPoint {
            point: believed * measured.point,
            frame: frame.index as u32,
            beam: measured.beam as u8,
        }));
        if let Some((map, vectors)) = &frame.obstacles {
            obstacles = Some((frame.index, map.clone(), vectors.clone()));
        }
        let start = Instant::now();
        if frame.index % animation_step == 0 || frame.index + 1 == planned {
            let view = camera_view(job, renderers[0], &frame.stance.pose(), HALF_SIDE_PX)?
                .with_edges(&job.plan.rig, &frame.measured);
            animation.push(AnimationFrame { view, map: MapThumbnail::of(first.map()) });
        }
        drawing += start.elapsed();
        let index = frame.index;
        let edges = Vec::new();
        frames.push(DriveFrame { edges, measured: Vec::new(), obstacles: None, ..*frame });
        let pose = frame.stance.pose();
        last = Some((exposed, pose));
        progress.frames(index + 1, planned);
    }

    if let Some(recording) = recording {
        recording.finish(job)?;
    }
    // There is always a first frame: its stance was found when the drive was made.
    let (exposed, pose) = last.ok_or(DriveError::Frames)?;
    let start = Instant::now();
    let last_view = camera_view(job, renderers[0], &pose, FIGURE_VIEW_SIDE_PX)?;
    let last_view = match job.plan.extraction.detection {
        Detection::Fixed(threshold) if !exposed.images.is_empty() => {
            last_view.with_lit_pixels(&exposed.images, threshold)
        }
        Detection::Share(_) if !exposed.images.is_empty() => last_view.with_lit_pixels(&exposed.images, 0.5),
        _ => last_view.with_edges(&job.plan.rig, &exposed.frame.measured),
    };
    drawing += start.elapsed();

    // Every drive has a first frame, and its vehicle stands on the ground.
    let start = Instant::now();
    let at_start = frames[0].stance.pose();
    let (air, model) = (job.plan.atmosphere, job.plan.flux_model);
    let scene = job.plan.rig.scene(Arc::clone(&job.mesh), at_start, air, model)?;
    let mut warnings = at_the_start(&scene);
    warnings.extend(job.vehicle_of_scene.and_then(|given| leans_otherwise(&given, &at_start)));
    warnings.extend(start_too_steep(&job.plan, &at_start));
    let stances: Vec<Pose> = frames.iter().map(|frame| frame.stance.pose()).collect();
    warnings.extend(way_too_steep(&job.plan, &stances));
    let whereabouts = Whereabouts::of(&scene, Some(&at_start));
    let plan = survey_plan(&scene, Some(&at_start));
    warnings.extend(stripes_left_over(extractor.as_deref()));
    warnings.extend(nothing_measured(edge_points));
    let looking = start.elapsed();

    let mut stages = first.stages();
    stages.extend(second.iter().flat_map(RendererDrive::stages));
    if second.is_some() {
        stages.push(Stage { name: "comparing".into(), time: comparing });
    }
    stages.push(Stage { name: "what the vehicle can truly pass".into(), time: judging });
    stages.push(Stage { name: "views for figures, warnings".into(), time: drawing + looking });
    Ok(DriveRun {
        last_view,
        animation,
        renderers: renderers.iter().map(|renderer| renderer.name().to_string()).collect(),
        frames,
        planned,
        map: first.map().clone(),
        believed: first.believed(),
        obstacles,
        truth,
        upper_bound,
        point_errors,
        edge_points,
        points,
        warnings,
        whereabouts,
        plan,
        scene_at_start: scene,
        history,
        differences,
        stages,
    })
}

#[cfg(test)]
#[path = "../tests/unit/run.rs"]
mod tests;
