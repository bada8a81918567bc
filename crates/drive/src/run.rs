//! A drive from its first frame to its last, on one side or on two in lockstep, as one readable pass.

use std::sync::Arc;
use std::time::{Duration, Instant};

use crate::eye::Eye;
use crate::job::{DriveError, DriveJob};
use crate::maps::ply::MarkedPoint;
use crate::picture::{MapPicture, Picture};
use crate::sun::Sun;
use crate::trace::{Kept, MOST_LIT, Trace};
use crate::truth::TruthMatrix;
use crate::view::{View, view};
use raypencil_rover::{
    CameraImage, Detection, Drive, DriveFrame, ElevationMap, Exposure, LabelledVector, ObstacleMap, Route,
};
use raypencil_scene::{Image, Pose, Renderer, SceneError, Stage};

/// The animation has no more pictures: a few megabytes.
const MOST_PICTURES: u64 = 60;

/// No more edge points are kept: half a gigabyte.
pub(super) const MOST_POINTS: usize = 1 << 24;

/// Columns of the camera's view in the animation, and in the figure.
const SMALL: u32 = 256;

const LARGE: u32 = 640;

/// Who wants to hear how far it is.
pub trait DriveProgress: Sync {
    /// So many frames of so many are done.
    fn frames(&self, done: u64, of: u64);
}

impl DriveProgress for raypencil_scene::Silent {
    fn frames(&self, _done: u64, _of: u64) {}
}

/// What a drive found.
#[derive(Debug)]
pub struct DriveRun {
    /// The renderers, the one whose maps these are first.
    pub renderers: Vec<String>,
    /// Every frame, without its points and maps.
    pub frames: Vec<DriveFrame>,
    /// How many frames the route has: more than were driven if it leads off the ground.
    pub planned: u64,
    /// The map at the end.
    pub map: ElevationMap,
    /// Where the vehicle believes to be at the end.
    pub believed: Pose,
    /// The last obstacle map and navigator map, and their frame.
    pub obstacles: Option<(u64, ObstacleMap, Vec<LabelledVector>)>,
    /// All obstacle maps against the true ground.
    pub truth: TruthMatrix,
    /// How many edge points there were in all frames.
    pub edge_points: u64,
    /// They themselves, global: the first 16,777,216.
    pub points: Vec<MarkedPoint>,
    /// Where two sides part, if there were two.
    pub trace: Option<Trace>,
    /// How long each part of the work took.
    pub stages: Vec<Stage>,
    /// The camera's view at the end.
    pub(super) last_view: View,
    pub(super) pictures: Vec<Picture>,
}

impl DriveRun {
    /// The way driven, metres.
    pub fn driven(&self) -> f64 {
        self.frames.last().map_or(0.0, |frame| frame.place.driven)
    }

    /// Whether two sides are the same, or there is one side alone.
    pub fn passes(&self) -> bool {
        self.trace.as_ref().is_none_or(Trace::is_identical)
    }
}

/// One renderer's drive.
pub(crate) struct Side<'a> {
    eye: Eye<'a>,
    drive: Drive,
    /// How many exposures there were.
    exposures: u64,
    exposing: Duration,
    stepping: Duration,
}

/// What a side saw in a frame.
struct Seen {
    frame: DriveFrame,
    kept: Vec<Kept>,
    /// Digital numbers of each exposure, but in a scan.
    images: Vec<(Option<usize>, Image<i32>)>,
}

impl<'a> Side<'a> {
    fn new(job: &'a DriveJob, renderer: &'a dyn Renderer, sun: Option<&'a Sun>) -> Result<Self, SceneError> {
        Ok(Self {
            eye: Eye::new(renderer, job, sun),
            drive: Drive::new(job.plan.clone(), Arc::clone(&job.mesh))?,
            exposures: 0,
            exposing: Duration::ZERO,
            stepping: Duration::ZERO,
        })
    }

    fn step(&mut self, job: &DriveJob, keep: bool) -> Result<Option<Seen>, SceneError> {
        let (mut kept, mut images, mut room) = (Vec::new(), Vec::new(), MOST_LIT);
        let (exposures, exposing) = (&mut self.exposures, &mut self.exposing);
        let eye = &self.eye;
        let mut develop = |exposure: Exposure, light: Image<f64>| {
            let start = Instant::now();
            // Steps 7 and 8.
            let behind = eye.behind();
            let numbers = job.digital(&light, behind.as_ref().map(|(_, light)| light), *exposures);
            if keep {
                let scene = behind.map(|(scene, _)| scene);
                let of_frame = Kept::new(exposure, *exposures, scene, &light, &numbers, room);
                room -= of_frame.lit();
                kept.push(of_frame);
            }
            *exposures += 1;
            if exposure.step.is_none() {
                images.push((exposure.beam, numbers.clone()));
            }
            *exposing += start.elapsed();
            CameraImage::Numbers(numbers)
        };
        let start = Instant::now();
        let frame = self.drive.step(&self.eye, &mut develop)?;
        self.stepping += start.elapsed();
        Ok(frame.map(|frame| Seen { frame, kept, images }))
    }

    fn map(&self) -> &ElevationMap {
        self.drive.mapper().expect("a frame was driven").map()
    }

    /// How long each part of its work took.
    fn stages(&self) -> Vec<Stage> {
        let times = self.eye.times();
        let name = self.eye.name();
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

/// Drives a job with one renderer, or with two in lockstep: on the same plan and the same seeds.
///
/// # Errors
/// A route that is too long; a start off the ground.
///
/// # Panics
/// If there are no renderers, or more than two.
pub fn drive(
    job: &DriveJob,
    renderers: &[&dyn Renderer],
    progress: &dyn DriveProgress,
) -> Result<DriveRun, DriveError> {
    assert!((1..=2).contains(&renderers.len()), "{} renderers", renderers.len());
    let planned = job.frames()?;
    let each = planned.div_ceil(MOST_PICTURES).max(1);
    let sun = Sun::of(job)?;
    let mut first = Side::new(job, renderers[0], sun.as_ref())?;
    let mut second = renderers.get(1).map(|&renderer| Side::new(job, renderer, sun.as_ref())).transpose()?;
    let mut trace = second.as_ref().map(|_| Trace::default());
    let (mut frames, mut points, mut pictures) = (Vec::new(), Vec::new(), Vec::new());
    let (mut obstacles, mut edge_points) = (None, 0);
    let (mut truth, mut judging) = (TruthMatrix::default(), Duration::ZERO);
    let mut last: Option<(Seen, Pose)> = None;
    let (mut comparing, mut drawing) = (Duration::ZERO, Duration::ZERO);

    loop {
        let seen = first.step(job, second.is_some())?;
        if let (Some(second), Some(trace)) = (&mut second, &mut trace) {
            let other = second.step(job, true)?;
            let start = Instant::now();
            if let (Some(seen), Some(other)) = (&seen, &other) {
                trace.exposures(job, sun.as_ref(), &seen.kept, &other.kept);
                trace.frames(&seen.frame, &other.frame, [first.map(), second.map()]);
            }
            comparing += start.elapsed();
        }
        let Some(mut seen) = seen else { break };

        let frame = &mut seen.frame;
        let believed = frame.believed;
        edge_points += frame.measured.len() as u64;
        let room = MOST_POINTS - points.len();
        points.extend(frame.measured.iter().take(room).map(|measured| MarkedPoint {
            point: believed * measured.point,
            frame: frame.index as u32,
            beam: measured.beam as u8,
        }));
        if let Some((map, vectors)) = &frame.obstacles {
            obstacles = Some((frame.index, map.clone(), vectors.clone()));
            let start = Instant::now();
            truth.add(first.map(), first.drive.ground(), &job.plan, &believed);
            judging += start.elapsed();
        }
        let start = Instant::now();
        if frame.index % each == 0 || frame.index + 1 == planned {
            let view = view(job, renderers[0], &frame.stance.pose(), SMALL)?
                .with_edges(&job.plan.rig, &frame.measured);
            pictures.push(Picture { view, map: MapPicture::of(first.map()) });
        }
        drawing += start.elapsed();
        let index = frame.index;
        frames.push(DriveFrame { measured: Vec::new(), obstacles: None, ..*frame });
        let pose = frame.stance.pose();
        last = Some((seen, pose));
        progress.frames(index + 1, planned);
    }

    // The first frame is always driven: its stance was tried when the drive was made.
    let (seen, pose) = last.ok_or(DriveError::Frames)?;
    let start = Instant::now();
    let last_view = view(job, renderers[0], &pose, LARGE)?;
    let last_view = match job.plan.extraction.detection {
        Detection::Fixed(level) if !seen.images.is_empty() => last_view.with_light(&seen.images, level),
        _ => last_view.with_edges(&job.plan.rig, &seen.frame.measured),
    };
    drawing += start.elapsed();

    let mut stages = first.stages();
    stages.extend(second.iter().flat_map(Side::stages));
    if second.is_some() {
        stages.push(Stage { name: "comparing".into(), time: comparing });
    }
    stages.push(Stage { name: "obstacle maps of the true ground".into(), time: judging });
    stages.push(Stage { name: "views for figures".into(), time: drawing });
    let mapper = first.drive.mapper().expect("a frame was driven");
    Ok(DriveRun {
        renderers: renderers.iter().map(|renderer| renderer.name().to_string()).collect(),
        frames,
        planned,
        map: mapper.map().clone(),
        believed: mapper.pose(),
        obstacles,
        truth,
        edge_points,
        points,
        trace,
        stages,
        last_view,
        pictures,
    })
}

/// How far apart the frames of a route are on a straight leg, metres.
pub(crate) fn frame_step(route: &Route) -> f64 {
    route.speed / route.frame_rate
}
