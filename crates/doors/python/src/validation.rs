//! Two or more renderers, compared ray by ray.

use std::path::PathBuf;

use pyo3::prelude::*;
use pyo3::types::PyDict;
use raypencil::Progress;
use raypencil::harness::{Candidate, Validation, validate as run, whole_screen, write_validation};
use raypencil::judge::JudgeShare;
use raypencil::pack::Declarations;

use crate::declared::declared;
use crate::failure::Failure;
use crate::folder::{Output, end};
use crate::maps::{into_dict, sensor_arrays};
use crate::render::{contenders, renderer_words};
use crate::scene::SceneCore;
use crate::watch::watched;

/// A validation that is done.
#[pyclass(frozen, module = "raypencil._raypencil")]
pub(crate) struct ValidationCore {
    validation: Validation,
    output: Option<PathBuf>,
}

#[pymethods]
impl ValidationCore {
    #[getter]
    fn passes(&self) -> bool {
        self.validation.passes()
    }

    /// The document of `summary.json`.
    fn json(&self, py: Python<'_>) -> String {
        py.detach(|| self.validation.document().json())
    }

    /// The screen of the command.
    fn text(&self) -> String {
        whole_screen(&self.validation, self.output.as_deref())
    }

    /// The page of `report.html`.
    fn report(&self, py: Python<'_>) -> PyResult<String> {
        py.detach(|| self.validation.document_with_pictures()?.page())
            .map_err(|error| Failure::from(error).into_exception(py))
    }

    /// The names of the renderers.
    #[getter]
    fn renderers(&self) -> Vec<String> {
        self.validation.rendered.iter().map(|rendered| rendered.name.clone()).collect()
    }

    /// The arrays of a renderer.
    fn maps<'py>(&self, py: Python<'py>, index: usize) -> PyResult<Bound<'py, PyDict>> {
        let sensors = py.detach(|| sensor_arrays(&self.validation.rendered[index].output));
        into_dict(py, sensors)
    }
}

/// Validates a scene. With `output` the folder of the command is written, too.
#[pyfunction]
#[pyo3(signature = (
    scene, names, switches, judge_all, candidates, channels, scale, allow_empty, output=None, force=false,
    on_stage=None
))]
#[allow(clippy::too_many_arguments, reason = "the arguments of a Python function by their names")]
pub(crate) fn validate(
    py: Python<'_>,
    scene: &SceneCore,
    names: Vec<String>,
    switches: Vec<(String, String)>,
    judge_all: bool,
    candidates: Vec<PathBuf>,
    channels: Vec<(String, String)>,
    scale: Option<f64>,
    allow_empty: bool,
    output: Option<PathBuf>,
    force: bool,
    on_stage: Option<&Bound<'_, PyAny>>,
) -> PyResult<ValidationCore> {
    let scene = scene.clone();
    let wished = Output { folder: output, force };
    watched(py, on_stage, move |watch| {
        if names.len() < 2 {
            return Err(Failure::new(format!("with_: {names:?}; expected at least 2 renderers to compare")));
        }
        let contenders = contenders(&names, &switches)?;
        let subject = scene.subject(&renderer_words(&names, &switches, &["scanline", "tracer"]));
        let begun = wished.begin("validate", scene.of(), &[])?;
        // Candidates first, so that an error in their files is reported before the rendering.
        let declared = declared(&channels, scale)?;
        if candidates.is_empty() && declared != Declarations::default() {
            let text = "channels, scale: there is no candidate that they concern; expected candidates";
            return Err(Failure::new(text));
        }
        let read = |folder: &PathBuf| {
            Candidate::read_as(folder, &subject.scene, &declared)
                .map_err(|error| Failure::with_help(&error, error.help()))
        };
        let candidates: Vec<Candidate> = candidates.iter().map(read).collect::<Result<_, _>>()?;
        let share = if judge_all { JudgeShare::All } else { JudgeShare::Sample };
        let mut validation = run(subject, &contenders, share, watch);
        validation.allow_empty = allow_empty;
        if !candidates.is_empty() {
            watch.stage("evaluating candidates");
            validation.evaluate(candidates, watch);
        }
        if let Some(folder) = &wished.folder {
            write_validation(&validation, folder, watch)?;
        }
        end(begun)?;
        Ok(ValidationCore { validation, output: wished.folder })
    })
}
