//! Sweeps: parts of one, made anywhere, and their table.

use std::path::PathBuf;

use pyo3::prelude::*;
use pyo3::types::PyDict;
use raypencil::Progress;
use raypencil::sweep::{
    Axis, Cells, Chart, Part, Sweep, SweepProgress, SweepTable, Task, default_charts, finish, has_part,
    run_part, sweep_document, write_sweep,
};

use crate::failure::Failure;
use crate::render::contenders;
use crate::watch::{Watch, watched};

/// A sweep, whose parts may be made in any process.
#[pyclass(frozen, module = "raypencil._raypencil")]
pub(crate) struct SweepCore(Sweep);

/// Reports each run as a stage.
struct Runs<'a>(&'a Watch);

impl SweepProgress for Runs<'_> {
    fn runs(&self, done: u64, of: u64, _made: u64) {
        self.0.stage(&format!("{done} of {of} runs"));
    }

    fn frames(&self, done: u64, planned: u64) {
        self.0.stage(&format!("frame {done} of {planned}"));
    }
}

/// Keys, and the values that they take together.
type Rows = (Vec<String>, Vec<Vec<String>>);

#[pymethods]
impl SweepCore {
    #[new]
    fn new(
        py: Python<'_>,
        scene: String,
        axes: Vec<Rows>,
        task: &str,
        renderers: Vec<String>,
        as_printed: bool,
    ) -> PyResult<Self> {
        let made = py.detach(|| -> Result<Sweep, Failure> {
            let task = [Task::Validate, Task::Render, Task::Drive]
                .into_iter()
                .find(|one| one.word() == task)
                .ok_or_else(|| Failure::new(format!("do is {task:?}; expected validate, render or drive")))?;
            let axes = axes.into_iter().map(|(keys, rows)| Axis { keys, rows }).collect();
            // Names that are none are told before the work.
            contenders(&renderers, &[])?;
            let mut sweep = Sweep::new(&scene, axes, task, renderers, as_printed)?;
            sweep.check_values()?;
            sweep.build = raypencil_cli::build();
            Ok(sweep)
        });
        made.map(Self).map_err(|failure| failure.into_exception(py))
    }

    /// Number of runs.
    #[getter]
    fn runs(&self) -> u64 {
        self.0.runs()
    }

    /// Makes the runs of a part in `folder`.
    #[pyo3(signature = (index, count, folder, on_stage=None))]
    fn part(
        &self,
        py: Python<'_>,
        index: u64,
        count: u64,
        folder: PathBuf,
        on_stage: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<()> {
        let sweep = self.0.clone();
        watched(py, on_stage, move |watch| {
            let contenders = contenders(&sweep.renderers, &[])?;
            Ok(run_part(&sweep, Part { index, count }, &contenders, &folder, &Runs(watch))?)
        })
    }

    /// Whether each run of a part has its results.
    fn has_part(&self, py: Python<'_>, index: u64, count: u64, folder: PathBuf) -> bool {
        py.detach(|| has_part(&self.0, Part { index, count }, &folder))
    }

    /// Joins the records of the folders and writes table and charts into `output`. Returns whether everything passes, the
    /// screen, the JSON and the table, a list for each column.
    fn finish<'py>(
        &self,
        py: Python<'py>,
        folders: Vec<PathBuf>,
        charts: Vec<String>,
        output: PathBuf,
    ) -> PyResult<(bool, String, String, Bound<'py, PyDict>)> {
        let finished = py.detach(|| -> Result<_, Failure> {
            let finished = finish(&self.0, &folders)?;
            let table = SweepTable::new(&finished);
            let mut all = default_charts(&table, finished.sweep.task);
            for chart in &charts {
                all.push(Chart::parse(chart)?);
            }
            let written = write_sweep(&finished, &table, &all, &output)?;
            let document = sweep_document(&finished, &table, &written, &[]);
            Ok(((finished.passes(), document.screen(), document.json()), table))
        });
        let ((passes, screen, json), table) = finished.map_err(|failure| failure.into_exception(py))?;
        let columns = PyDict::new(py);
        for column in table.columns {
            match column.cells {
                Cells::Integers(cells) => columns.set_item(column.name, cells)?,
                Cells::Numbers(cells) => columns.set_item(column.name, cells)?,
                Cells::Truths(cells) => columns.set_item(column.name, cells)?,
                Cells::Texts(cells) => columns.set_item(column.name, cells)?,
            }
        }
        Ok((passes, screen, json, columns))
    }
}

/// Key and values of `KEY=VALUES`, as the command takes it.
#[pyfunction]
pub(crate) fn parse_axis(py: Python<'_>, text: &str) -> PyResult<(String, Vec<String>)> {
    let axis = Axis::parse(text).map_err(|error| Failure::from(error).into_exception(py))?;
    let mut keys = axis.keys;
    Ok((keys.remove(0), axis.rows.into_iter().flatten().collect()))
}
