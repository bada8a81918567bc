//! Two recordings, compared channel by channel.

use std::path::{Path, PathBuf};

use pyo3::prelude::*;
use raypencil::Progress;
use raypencil::diff::{Sides, Thresholds, diff as compare, diff_document, rule, write_diff};
use raypencil::harness::{Side, read_sides};
use raypencil::judge::{GroundTruth, check as judge};
use raypencil::pack::CheckError;

use crate::declared::declared;
use crate::failure::Failure;
use crate::folder::{Output, end};
use crate::judge::precision;
use crate::scene::SceneCore;
use crate::watch::watched;

/// Compares two files or folders: whether they pass, the screen of the command, and its JSON.
#[pyfunction]
#[pyo3(signature = (
    a, b, channels, scale, fail, fail_relative, fail_ulp, fail_percent, hard_fail, shared_only, scene=None,
    arithmetic=None, output=None, force=false, on_stage=None
))]
pub(crate) fn diff(
    py: Python<'_>,
    a: PathBuf,
    b: PathBuf,
    channels: Vec<(String, String)>,
    scale: Option<f64>,
    fail: f64,
    fail_relative: f64,
    fail_ulp: f64,
    fail_percent: f64,
    hard_fail: Option<f64>,
    shared_only: bool,
    scene: Option<&Bound<'_, SceneCore>>,
    arithmetic: Option<&str>,
    output: Option<PathBuf>,
    force: bool,
    on_stage: Option<&Bound<'_, PyAny>>,
) -> PyResult<(bool, String, String)> {
    let precision = arithmetic.map(precision).transpose().map_err(|failure| failure.into_exception(py))?;
    let scene = scene.map(|scene| scene.get().clone());
    watched(py, on_stage, move |watch| {
        if let Some(folder) = &output {
            let same = |path: &Path| {
                path.canonicalize().ok().is_some_and(|path| folder.canonicalize().ok() == Some(path))
            };
            if same(&a) || same(&b) {
                let folder = folder.display();
                return Err(Failure::new(format!(
                    "output {folder}: is one of the folders to compare; expected another folder"
                )));
            }
        }
        let wished = Output { folder: output, force };
        let begun = wished.begin("diff", &a.to_string_lossy(), &[&b])?;
        let [of_a, of_b] = read_sides([&a, &b], &declared(&channels, scale)?, watch)?;
        let thresholds = Thresholds { fail, fail_relative, fail_ulp, fail_percent, hard_fail, shared_only };
        watch.stage("comparing");
        let mut difference = compare(&of_a.channels, &of_b.channels, &thresholds)?;
        let names = [&a, &b].map(|path| path.display().to_string());
        let sides = Sides { names: [&names[0], &names[1]], channels: [&of_a.channels, &of_b.channels] };
        if let Some(scene) = &scene {
            let scene = &scene.loaded.scene;
            let helped = |error: CheckError| Failure::with_help(&error, error.help());
            let recorded = |side: &Side| side.recorded(scene, precision).map_err(helped);
            let (of_a, of_b) = (recorded(&of_a)?, recorded(&of_b)?);
            let truth = GroundTruth::certified(scene, watch);
            let [of_a, of_b] = [of_a, of_b].map(|recorded| judge(&truth, &recorded, watch));
            let rulings = rule(&difference, &sides, &truth, [&of_a, &of_b]);
            difference = difference.with_rulings(rulings);
        }
        if let Some(folder) = &wished.folder {
            write_diff(&difference, &sides, folder, watch)?;
        }
        end(begun)?;
        let document = diff_document(&difference, &sides);
        Ok((difference.passes(), document.screen(), document.json()))
    })
}
