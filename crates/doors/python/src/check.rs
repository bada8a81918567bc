//! A folder of answers against a reference pack.

use std::path::PathBuf;

use pyo3::prelude::*;
use pyo3::types::PyDict;
use raypencil::cast::{CloudChoice, CloudConventions, CloudFrame, is_bag_of_clouds, no_cloud};
use raypencil::harness::{CheckedPack, check_any_pack, pack_form};
use raypencil::pack::{CheckError, Declarations, PackForm, Verification};

use crate::array::Arrays;
use crate::declared::declared;
use crate::failure::Failure;
use crate::folder::{Output, end};
use crate::judge::{precision, verdict_arrays};
use crate::watch::{Watch, watched};

/// A pack, a folder, and how its answers are to be understood.
struct Question {
    pack: PathBuf,
    candidate: PathBuf,
    declared: Declarations,
    /// The frame of a point cloud.
    frame: Option<CloudFrame>,
    /// The topic of a bag, and which of its clouds.
    topic: Option<String>,
    message: Option<u64>,
    share: Verification,
    output: Output,
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

/// Refuses what a pack of this form has no use for.
fn refuse_declared(question: &Question) -> Result<(), Failure> {
    let Question { pack, declared, candidate, frame, topic, message, .. } = question;
    let form = pack_form(pack);
    let pack = pack.display();
    let of_bag = topic.is_some() || message.is_some();
    if (frame.is_some() || of_bag) && form != PackForm::Rays {
        return Err(Failure::new(format!(
            "frame, topic, message: {pack} is no pack of rays, which alone takes point clouds; expected none of them"
        )));
    }
    if (frame.is_some() || of_bag)
        && let Some(words) = no_cloud(candidate)
    {
        return Err(Failure::new(words));
    }
    if of_bag && !is_bag_of_clouds(candidate) {
        return Err(Failure::new(format!(
            "topic, message: {} is no bag (.mcap); expected neither",
            candidate.display()
        )));
    }
    match form {
        PackForm::Triangles if *declared != Declarations::default() => Err(Failure::new(format!(
            "{pack} is an input pack: arithmetic, miss, no_faces, channels and scale declare how rays are answered; expected none \
             of them"
        ))),
        PackForm::Rays if !declared.channels.is_empty() || declared.scale.is_some() => {
            Err(Failure::new(format!(
                "{pack} is a pack of rays, whose answers have fixed names: expected neither channels nor scale"
            )))
        }
        PackForm::Triangles | PackForm::Rays | PackForm::Sensors => Ok(()),
    }
}

fn answer(question: &Question, watch: &Watch) -> Result<Answer, Failure> {
    refuse_declared(question)?;
    let Question { pack, candidate, declared, frame, topic, message, share, output } = question;
    let choice = CloudChoice { topic: topic.as_deref(), message: *message };
    let cloud = CloudConventions { frame: frame.unwrap_or_default(), choice };
    let begun = output.begin("check", &pack.to_string_lossy(), &[candidate])?;
    let helped = |error: CheckError| Failure::with_help(&error, error.help());
    let checked = check_any_pack(pack, candidate, (declared, cloud), *share, watch).map_err(helped)?;
    if let Some(folder) = &output.folder {
        checked.write(folder)?;
    }
    end(begun)?;
    let document = checked.document();
    let (kind, arrays, shape) = match &checked {
        CheckedPack::Sensors { .. } => ("sensors", Arrays::default(), Vec::new()),
        CheckedPack::Rays(of) => ("rays", verdict_arrays(&of.comparison), of.rays.shape.clone()),
        CheckedPack::Triangles(_) => ("triangles", Arrays::default(), Vec::new()),
    };
    Ok(Answer {
        kind,
        passes: checked.passes(),
        text: document.screen(),
        json: document.json(),
        why: checked.why(),
        arrays,
        shape,
    })
}

/// Checks a folder of answers against a pack of any kind.
#[pyfunction]
#[pyo3(signature = (
    pack, candidate, channels, scale, arithmetic=None, miss=None, no_faces=false, frame=None, topic=None, message=None,
    verify=false, output=None, force=false, on_stage=None
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
    frame: Option<String>,
    topic: Option<String>,
    message: Option<u64>,
    verify: bool,
    output: Option<PathBuf>,
    force: bool,
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
        let share = if verify { Verification::All } else { Verification::Drawn { seed: None } };
        let of_word = |word: String| {
            let found = CloudFrame::ALL.into_iter().find(|frame| frame.option() == word);
            found.ok_or_else(|| {
                Failure::new(format!("frame is {word:?}; expected mesh, sensor, start or end"))
            })
        };
        let frame = frame.map(of_word).transpose()?;
        let named = declared(&channels, scale)?;
        let declared = Declarations { precision, miss, ignores_faces: no_faces, ..named };
        let output = Output { folder: output, force };
        let question = Question { pack, candidate, declared, frame, topic, message, share, output };
        answer(&question, watch)
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
