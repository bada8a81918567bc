//! Work on another thread. Python's lock is free meanwhile, stages are reported, and Ctrl-C is heard.

use std::panic::resume_unwind;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::thread::Builder;
use std::time::Duration;

use pyo3::prelude::*;
use rayon::ThreadPoolBuilder;
use raypencil::Progress;

use crate::failure::Failure;

/// How long Ctrl-C may go unheard.
pub(crate) const PATIENCE: Duration = Duration::from_millis(100);

/// Stack of a thread that works, bytes: that of a program's first thread.
const STACK_BYTES: usize = 8 << 20;

/// What unwinds the stack of work that is told to stop.
struct Stop;

/// Sees the stages of some work, and may stop it between two of them.
#[derive(Debug)]
pub(crate) struct Watch {
    stop: Arc<AtomicBool>,
    stages: Sender<String>,
}

impl Watch {
    /// Ends the work here if it was told to stop.
    pub(crate) fn pause(&self) {
        if self.stop.load(Ordering::Relaxed) {
            // No hook of a panic runs: this is no error, and prints nothing.
            resume_unwind(Box::new(Stop));
        }
    }
}

impl Progress for Watch {
    fn stage(&self, what: &str) {
        self.pause();
        // Nobody may be listening.
        let _ = self.stages.send(what.into());
    }
}

/// Runs `work` on a thread of its own. `on_stage` is called with the name of each stage; what it raises ends the call.
///
/// Ctrl-C ends the call within a tenth of a second, and the work at its next stage.
pub(crate) fn watched<T: Send + 'static>(
    py: Python<'_>,
    on_stage: Option<&Bound<'_, PyAny>>,
    work: impl FnOnce(&Watch) -> Result<T, Failure> + Send + 'static,
) -> PyResult<T> {
    let stop = Arc::new(AtomicBool::new(false));
    let (stages, mut heard) = channel();
    let watch = Watch { stop: Arc::clone(&stop), stages };
    let thread = Builder::new()
        .name("raypencil".into())
        .stack_size(STACK_BYTES)
        .spawn(move || work(&watch))
        .map_err(|error| Failure::from(error).into_exception(py))?;
    let given_up = |error: PyErr| {
        stop.store(true, Ordering::Relaxed);
        error
    };
    loop {
        // The work's end drops its side of the channel.
        let (stage, heard_again) = py.detach(move || (heard.recv_timeout(PATIENCE), heard));
        match stage {
            Ok(stage) => {
                if let Some(on_stage) = on_stage {
                    on_stage.call1((stage,)).map_err(given_up)?;
                }
            }
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => break,
        }
        py.check_signals().map_err(given_up)?;
        heard = heard_again;
    }
    let ended = py.detach(move || thread.join());
    let result = ended.unwrap_or_else(|payload| match payload.downcast::<Stop>() {
        Ok(_) => Err(Failure::Cancelled),
        Err(payload) => Err(Failure::new(format!("an error of raypencil itself: {}", words(&*payload)))),
    });
    result.map_err(|failure| failure.into_exception(py))
}

/// Runs `work` on so many threads; 0: on all.
pub(crate) fn on_threads<T: Send>(threads: usize, work: impl FnOnce() -> T + Send) -> Result<T, Failure> {
    match threads {
        0 => Ok(work()),
        _ => Ok(ThreadPoolBuilder::new().num_threads(threads).build()?.install(work)),
    }
}

/// What a panic says.
fn words(payload: &(dyn std::any::Any + Send)) -> String {
    let text = payload.downcast_ref::<&str>().map(ToString::to_string);
    text.or_else(|| payload.downcast_ref::<String>().cloned()).unwrap_or_else(|| "no words".into())
}
