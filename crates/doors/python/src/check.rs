//! A folder of answers against a reference pack.

use std::path::PathBuf;

use pyo3::prelude::*;
use pyo3::types::PyDict;
use raypencil::cast::{
    CandidateConventions, check_ray_pack, is_ray_pack, ray_check_json, ray_check_text, write_ray_check,
};
use raypencil::harness::{CheckedRaySet, check_packed_ray_sets};
use raypencil::judge::JudgeShare;
use raypencil::pack::{
    CheckError, Declarations, check_input, check_json, check_pack_by, check_screen, input_json, input_screen,
    is_input_pack, write_check, write_input_check,
};

use crate::array::Arrays;
use crate::declared::declared;
use crate::failure::Failure;
use crate::judge::{precision, verdict_arrays};
use crate::watch::{Watch, watched};

/// A pack, a folder, and how its answers are to be understood.
struct Question {
    pack: PathBuf,
    candidate: PathBuf,
    declared: Declarations,
    share: JudgeShare,
    output: Option<PathBuf>,
}

/// What became of it.
struct Answer {
    kind: &'static str,
    passes: bool,
    text: String,
    json: String,
    why: Option<String>,
    /// The verdicts of the rays of a pack of rays.
    arrays: Arrays,
    shape: Vec<u64>,
}

fn of_input(question: &Question) -> Result<Answer, Failure> {
    let Question { pack, candidate, output, declared, .. } = question;
    if *declared != Declarations::default() {
        return Err(Failure::new(format!(
            "{} is an input pack: arithmetic, miss, no_faces, channels and scale declare how rays are answered; expected none \
             of them",
            pack.display()
        )));
    }
    let checked = check_input(pack, candidate)?;
    if let Some(folder) = output {
        write_input_check(&checked, folder)?;
    }
    Ok(Answer {
        kind: "input",
        passes: checked.passes(),
        text: input_screen(&checked),
        json: input_json(&checked),
        why: None,
        arrays: Arrays::default(),
        shape: Vec::new(),
    })
}

fn of_rays(question: &Question, watch: &Watch) -> Result<Answer, Failure> {
    let Question { pack, candidate, output, declared, .. } = question;
    if !declared.channels.is_empty() || declared.scale.is_some() {
        return Err(Failure::new(format!(
            "{} is a pack of rays, whose answers have fixed names: expected neither channels nor scale",
            pack.display()
        )));
    }
    let conventions = CandidateConventions { miss: declared.miss, ignores_faces: declared.ignores_faces };
    let precision = declared.precision();
    let checked = check_ray_pack(pack, candidate, precision, conventions, watch)?;
    if let Some(folder) = output {
        write_ray_check(&checked, folder)?;
    }
    Ok(Answer {
        kind: "rays",
        passes: checked.passes(),
        text: ray_check_text(&checked),
        json: ray_check_json(&checked).to_string(),
        arrays: verdict_arrays(&checked.comparison),
        shape: checked.rays.shape.clone(),
        why: checked.why,
    })
}

fn of_scene(question: &Question, watch: &Watch) -> Result<Answer, Failure> {
    let Question { pack, candidate, output, declared, share } = question;
    let helped = |error: CheckError| Failure::with_help(&error, error.help());
    let mut checked = check_pack_by(pack, candidate, declared, *share, watch).map_err(helped)?;
    // The sets of rays that the pack has besides, if there are any.
    let precision = checked.recorded.precision;
    let declared = &checked.declared;
    let of_rays = CandidateConventions { miss: declared.miss, ignores_faces: declared.ignores_faces };
    let sets = check_packed_ray_sets(pack, candidate, precision, of_rays, watch)?;
    checked.ray_sets = sets.iter().map(CheckedRaySet::outcome).collect();
    let mut text = check_screen(&checked);
    for CheckedRaySet { name, checked } in &sets {
        text += &match checked {
            Some(checked) => format!("\nrays {}", ray_check_text(checked)),
            None => format!("\nrays {name}: not given\n"),
        };
    }
    if let Some(folder) = output {
        write_check(&checked, folder)?;
        for CheckedRaySet { name, checked } in &sets {
            if let Some(checked) = checked {
                write_ray_check(checked, &folder.join("rays").join(name))?;
            }
        }
    }
    Ok(Answer {
        kind: "scene",
        passes: checked.passes(),
        text,
        json: check_json(&checked),
        why: checked.why(),
        arrays: Arrays::default(),
        shape: Vec::new(),
    })
}

/// Checks a folder of answers against a pack of any kind.
#[pyfunction]
#[pyo3(signature = (
    pack, candidate, channels, scale, arithmetic=None, miss=None, no_faces=false, verify=false, output=None,
    on_stage=None
))]
#[allow(clippy::too_many_arguments, reason = "the arguments of a Python function by their names")]
pub(crate) fn check<'py>(
    py: Python<'py>,
    pack: PathBuf,
    candidate: PathBuf,
    channels: Vec<(String, String)>,
    scale: Option<f64>,
    arithmetic: Option<String>,
    miss: Option<f64>,
    no_faces: bool,
    verify: bool,
    output: Option<PathBuf>,
    on_stage: Option<&Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyDict>> {
    let answer = watched(py, on_stage, move |watch| {
        let precision = arithmetic.as_deref().map(precision).transpose()?;
        if !pack.is_dir() {
            return Err(Failure::missing(format!(
                "{}: is no folder; expected that of a pack",
                pack.display()
            )));
        }
        let share = if verify { JudgeShare::All } else { JudgeShare::Sample };
        let named = declared(&channels, scale)?;
        let declared = Declarations { precision, miss, ignores_faces: no_faces, ..named };
        let question = Question { pack, candidate, declared, share, output };
        if is_input_pack(&question.pack) {
            of_input(&question)
        } else if is_ray_pack(&question.pack) {
            of_rays(&question, watch)
        } else {
            of_scene(&question, watch)
        }
    })?;
    let dict = PyDict::new(py);
    dict.set_item("kind", answer.kind)?;
    dict.set_item("passes", answer.passes)?;
    dict.set_item("text", answer.text)?;
    dict.set_item("json", answer.json)?;
    dict.set_item("why", answer.why)?;
    dict.set_item("arrays", answer.arrays.into_dict(py)?)?;
    dict.set_item("shape", answer.shape)?;
    Ok(dict)
}
