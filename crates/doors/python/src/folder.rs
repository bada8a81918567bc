//! Output folders of the functions, by the rules of the commands: locked, listed, and never mixed with what is somebody else's.

use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use pyo3::prelude::*;
use raypencil::io::{FolderError, MIN_ABANDONED_AGE, OutputFolder, SharedFolder, remove_abandoned};
use raypencil_cli::overwriting;

use crate::failure::Failure;

/// The folder that a function is to write, and whether it may replace what is not its own.
#[derive(Debug, Clone)]
pub(crate) struct Output {
    /// `None`: nothing is written.
    pub(crate) folder: Option<PathBuf>,
    pub(crate) force: bool,
}

impl Output {
    /// Begins the folder, as the command of this name does on the same scene, mesh or pack.
    pub(crate) fn begin(
        &self,
        command: &str,
        of: &str,
        inputs: &[&Path],
    ) -> Result<Option<OutputFolder>, Failure> {
        overwriting::begin(self.force);
        let begin = |folder| overwriting::output_folder(folder, command, of, inputs);
        self.folder.as_deref().map(begin).transpose().map_err(failure)
    }
}

/// Ends a folder that was begun.
pub(crate) fn end(output: Option<OutputFolder>) -> Result<(), Failure> {
    output.map_or(Ok(()), OutputFolder::finish).map_err(failure)
}

/// An error of a folder, with the argument in place of the option.
pub(crate) fn failure(error: FolderError) -> Failure {
    match error {
        FolderError::IsOfOther { path, of } => Failure::new(format!(
            "{}: it has results of {of}; expected another folder, or force=True to replace them",
            path.display()
        )),
        error => error.into(),
    }
}

/// The folder of a campaign or a sweep, which its parts share: no other command begins in it until it is let go of.
#[pyclass(frozen, module = "raypencil._raypencil")]
pub(crate) struct SharedCore(Mutex<Option<SharedFolder>>);

#[pymethods]
impl SharedCore {
    /// `sweep`: scene and task of a sweep; without them the folder is a campaign's.
    #[new]
    #[pyo3(signature = (folder, force, sweep=None))]
    fn new(py: Python<'_>, folder: PathBuf, force: bool, sweep: Option<(String, String)>) -> PyResult<Self> {
        let begun = py.detach(|| {
            overwriting::begin(force);
            match &sweep {
                Some((scene, task)) => overwriting::ask_sweep(&folder, scene, task)?,
                None => overwriting::ask_campaign(&folder)?,
            }
            let shared = SharedFolder::begin(&folder)?;
            remove_abandoned(&folder, MIN_ABANDONED_AGE);
            Ok(shared)
        });
        begun.map(|shared| Self(Mutex::new(Some(shared)))).map_err(|error| failure(error).into_exception(py))
    }

    /// Lets go of the folder.
    fn release(&self) {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).take();
    }
}
