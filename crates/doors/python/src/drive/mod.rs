//! A drive, frame by frame.
//!
//! ```text
//! tee       the extraction of stripes, which also tells what it saw
//! replay    a second rover that makes the same points and maps of it
//! frame     a frame as arrays
//! ```
//!
//! The drive runs on one thread, the second rover on another, and Python takes the frames. Each waits for the next: a drive
//! is never more than a few exposures ahead of the frame that Python has.

mod frame;
mod replay;
mod tee;

use std::path::PathBuf;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, sync_channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::{Builder, JoinHandle};

use pyo3::prelude::*;
use pyo3::types::PyDict;
use raypencil::Silent;
use raypencil::drive::{
    DriveExtras, DriveJob, DriveProgress, DriveRun, RecordContents, StripeFile, drive_document,
    drive_renderer, drive_with, write_drive,
};
use raypencil::io::{DriveSetup, WaypointFrame};
use raypencil::rover::{RigExtraction, StripeExtractor};

use crate::failure::Failure;
use crate::folder::{Output, end};
use crate::render::{contenders, renderer_words};
use crate::scene::SceneCore;
use crate::watch::{PATIENCE, watched};
use frame::frame_dict;
use replay::{ReplayedFrame, replay};
use tee::Tee;

/// Exposures that may be ahead of the second rover, and frames that may be ahead of Python.
const AHEAD: usize = 2;

/// What is left of a drive at its end.
struct Ended {
    passes: bool,
    text: String,
    json: String,
}

type DriveThread = JoinHandle<Result<Ended, Failure>>;

/// A drive that goes on as its frames are taken.
#[pyclass(frozen, module = "raypencil._raypencil")]
pub(crate) struct DriveCore {
    frames: Mutex<Option<Receiver<Box<ReplayedFrame>>>>,
    thread: Mutex<Option<DriveThread>>,
    planned: Arc<AtomicU64>,
    is_signed: bool,
    ended: Mutex<Option<Ended>>,
}

/// Notes how many frames there will be.
struct Planned(Arc<AtomicU64>);

impl DriveProgress for Planned {
    fn frames(&self, _done: u64, planned: u64) {
        self.0.store(planned, Ordering::Relaxed);
    }

    fn scan(&self, _done: u64, _planned: u64) {}
}

/// What is asked of a drive.
struct Wish {
    to: Vec<(f64, f64)>,
    to_global: bool,
    as_printed: bool,
    rules: Vec<(String, String)>,
    record: Vec<String>,
    names: Vec<String>,
    switches: Vec<(String, String)>,
    output: Output,
    /// The folder of stripes in place of the rover's own, and whether it is the user's and is named.
    stripes: Option<(PathBuf, bool)>,
}

impl Wish {
    /// The words after `raypencil drive`.
    fn words(&self, scene: &SceneCore) -> String {
        let mut words = scene.words().to_string();
        for (x, y) in &self.to {
            words += &format!(" --to {x},{y}");
        }
        for (flag, is_set) in [(" --to-global", self.to_global), (" --as-printed", self.as_printed)] {
            words += if is_set { flag } else { "" };
        }
        for (name, word) in &self.rules {
            words += &format!(" --rule {name}={word}");
        }
        if !self.record.is_empty() {
            words += &format!(" --record {}", self.record.join(","));
        }
        if let Some((folder, true)) = &self.stripes {
            words += &format!(" --stripes {}", folder.display());
        }
        if self.names == ["scanline", "tracer"] {
            words += " --both";
            return words + &renderer_words(&[], &self.switches, &[]);
        }
        words + &renderer_words(&self.names, &self.switches, &[drive_renderer(self.as_printed)])
    }

    /// The drive, ready to start.
    fn job(&self, scene: &SceneCore) -> Result<DriveJob, Failure> {
        if !(1..=2).contains(&self.names.len()) {
            return Err(Failure::new(format!(
                "with_: {:?}; expected one renderer, or two in lockstep",
                self.names
            )));
        }
        // Renderers stay on one thread: these are looked at and thrown away.
        contenders(&self.names, &self.switches)?;
        let mut loaded = scene.loaded.as_ref().clone();
        if !self.to.is_empty() {
            let rig = loaded.rig();
            let new = || DriveSetup::new(rig, Vec::new(), WaypointFrame::Vehicle);
            let drive = loaded.drive.get_or_insert_with(new);
            drive.waypoints = self.to.iter().map(|&(x, y)| [x, y].into()).collect();
            drive.waypoint_frame =
                if self.to_global { WaypointFrame::Global } else { WaypointFrame::Vehicle };
        }
        let named = |error: raypencil::drive::DriveError| match Failure::from(error) {
            Failure::Words { text, class } => {
                Failure::Words { text: format!("{}: {text}", loaded.name), class }
            }
            failure => failure,
        };
        let mut job = DriveJob::new(&loaded, None, self.words(scene)).map_err(named)?;
        if self.as_printed {
            job = job.as_printed(&self.names.join(",")).map_err(named)?;
        }
        for (name, word) in &self.rules {
            job.plan
                .set_rule(name, word)
                .map_err(|expected| Failure::new(format!("rule {name}={word}: expected {expected}")))?;
        }
        Ok(job)
    }

    fn contents(&self) -> Result<RecordContents, Failure> {
        let mut contents = RecordContents::default();
        for word in &self.record {
            contents.add(word).map_err(|words| Failure::new(format!("record {word}: expected {words}")))?;
        }
        Ok(contents)
    }
}

/// The end of a drive: its folder, its screen, its summary.
fn finish(job: &DriveJob, run: &DriveRun, output: Option<&PathBuf>) -> Result<Ended, Failure> {
    if let Some(folder) = output {
        write_drive(job, run, folder, &Silent)?;
    }
    let document = drive_document(job, run);
    Ok(Ended { passes: run.passes(), text: document.screen(), json: document.json() })
}

#[pymethods]
impl DriveCore {
    #[new]
    #[pyo3(signature = (
        scene, to, to_global, as_printed, rules, record, names, switches, images, output=None, stripes=None,
        force=false, on_stage=None
    ))]
    fn new(
        py: Python<'_>,
        scene: &SceneCore,
        to: Vec<(f64, f64)>,
        to_global: bool,
        as_printed: bool,
        rules: Vec<(String, String)>,
        record: Vec<String>,
        names: Vec<String>,
        switches: Vec<(String, String)>,
        images: bool,
        output: Option<PathBuf>,
        stripes: Option<(PathBuf, bool)>,
        force: bool,
        on_stage: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let output = Output { folder: output, force };
        let wish = Wish { to, to_global, as_printed, rules, record, names, switches, output, stripes };
        let scene = scene.clone();
        watched(py, on_stage, move |_| {
            let job = wish.job(&scene)?;
            let contents = wish.contents()?;
            let named =
                wish.stripes.as_ref().filter(|(_, is_named)| *is_named).map(|(folder, _)| folder.as_path());
            let begun = wish.output.begin("drive", scene.of(), named.as_slice())?.map(Arc::new);
            let (job, planned) = (Arc::new(job), Arc::default());
            let is_signed = job.subtract_unlit;
            let (listener, seen) = sync_channel(AHEAD);
            let (taker, frames) = sync_channel(AHEAD);
            let plan = &job.plan;
            let extraction: Box<dyn StripeExtractor> = match &wish.stripes {
                Some((folder, _)) => Box::new(StripeFile::read(folder, plan.rig.beams.len())?),
                None => Box::new(RigExtraction::new(plan.extraction, &plan.rig, &plan.sweep)),
            };
            let tee = Tee::new(extraction, images, listener);
            let extras = DriveExtras {
                extractor: Some(Arc::new(tee) as _),
                record: wish.output.folder.clone().map(|folder| (folder, contents)),
                output: begun.clone(),
            };
            let progress = Planned(Arc::clone(&planned));
            let of_replay = Arc::clone(&job);
            let replaying = Builder::new()
                .name("raypencil replay".into())
                .spawn(move || replay(&of_replay, seen, &taker))?;
            let thread =
                Builder::new().name("raypencil drive".into()).stack_size(8 << 20).spawn(move || {
                    let contenders = contenders(&wish.names, &wish.switches)?;
                    let renderers: Vec<_> =
                        contenders.iter().map(|contender| contender.renderer.as_ref()).collect();
                    let driven = drive_with(&job, &renderers, extras, &progress);
                    // The extraction is gone, so the second rover ends as well; why the first one ended says more.
                    let replayed = replaying.join();
                    let run = driven?;
                    replayed
                        .map_err(|_| Failure::new("an error of raypencil itself: the second rover"))??;
                    let ended = finish(&job, &run, wish.output.folder.as_ref())?;
                    // The drive has let go of it.
                    end(begun.and_then(Arc::into_inner))?;
                    Ok(ended)
                })?;
            Ok(Self {
                frames: Mutex::new(Some(frames)),
                thread: Mutex::new(Some(thread)),
                planned,
                is_signed,
                ended: Mutex::default(),
            })
        })
    }

    /// The next frame; `None` at the end.
    fn next<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyDict>>> {
        loop {
            let taken = py.detach(|| {
                let frames = self.frames.lock().unwrap_or_else(PoisonError::into_inner);
                frames.as_ref().map(|frames| frames.recv_timeout(PATIENCE))
            });
            match taken {
                Some(Ok(frame)) => return frame_dict(py, &frame, self.is_signed).map(Some),
                Some(Err(RecvTimeoutError::Timeout)) => {}
                Some(Err(RecvTimeoutError::Disconnected)) | None => return self.end(py).map(|()| None),
            }
            py.check_signals().inspect_err(|_| self.close())?;
        }
    }

    /// Gives the drive up. Its threads end with their next exposure.
    fn close(&self) {
        self.frames.lock().unwrap_or_else(PoisonError::into_inner).take();
        // Nobody waits for it.
        self.thread.lock().unwrap_or_else(PoisonError::into_inner).take();
    }

    /// Number of frames of the route; 0 until it is known.
    #[getter]
    fn planned(&self) -> u64 {
        self.planned.load(Ordering::Relaxed)
    }

    /// Whether both sides are identical, the screen and the summary, after the last frame.
    fn summary(&self) -> Option<(bool, String, String)> {
        let ended = self.ended.lock().unwrap_or_else(PoisonError::into_inner);
        ended.as_ref().map(|ended| (ended.passes, ended.text.clone(), ended.json.clone()))
    }
}

impl DriveCore {
    /// Waits for the end of the drive, with its folder, and keeps what is left of it.
    fn end(&self, py: Python<'_>) -> PyResult<()> {
        loop {
            let is_finished = {
                let thread = self.thread.lock().unwrap_or_else(PoisonError::into_inner);
                thread.as_ref().is_none_or(DriveThread::is_finished)
            };
            if is_finished {
                break;
            }
            py.detach(|| std::thread::sleep(PATIENCE / 10));
            py.check_signals()?;
        }
        let Some(thread) = self.thread.lock().unwrap_or_else(PoisonError::into_inner).take() else {
            return Ok(());
        };
        let ended = py.detach(move || thread.join());
        let ended = ended.unwrap_or_else(|_| Err(Failure::new("an error of raypencil itself: the drive")));
        let ended = ended.map_err(|failure| failure.into_exception(py))?;
        *self.ended.lock().unwrap_or_else(PoisonError::into_inner) = Some(ended);
        Ok(())
    }
}
