//! Any rays on any mesh, answered.

use numpy::PyReadonlyArray2;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use raypencil::cast::{Answers, FirstHit, GroupAtT, Questions, cast_warnings, cast_with};
use raypencil::referee::{ExactCast, Margin};
use raypencil::survey::WarningCode;
use raypencil::{CastRay, Progress, Side, Sides};

use crate::array::Arrays;
use crate::failure::Failure;
use crate::mesh::MeshCore;
use crate::rays::{rays_of, sides};
use crate::watch::{Watch, watched};

/// Rays that are answered before Ctrl-C is heard again: a few tenths of a second.
const RAYS_AT_A_TIME: usize = 1 << 16;

/// What stands for no face.
const NO_FACE: u32 = u32::MAX;

/// Answers rays of (n, 9) on a mesh: the arrays of `docs/guide/cast.md`, flat, and what looks wrong.
#[pyfunction]
#[pyo3(signature = (mesh, rays, by_tracer, fronts_only, any, all, margins, on_stage=None))]
pub(crate) fn cast<'py>(
    py: Python<'py>,
    mesh: &MeshCore,
    rays: PyReadonlyArray2<'py, f64>,
    by_tracer: bool,
    fronts_only: bool,
    any: bool,
    all: bool,
    margins: bool,
    on_stage: Option<&Bound<'py, PyAny>>,
) -> PyResult<(Bound<'py, PyDict>, Vec<String>)> {
    let sides = sides(fronts_only);
    let set = rays_of(&rays, sides).map_err(|failure| failure.into_exception(py))?;
    drop(rays);
    let (mesh, questions) = (mesh.clone(), Questions { any, all, margins });
    let (arrays, warnings) = watched(py, on_stage, move |watch| {
        let answers = match by_tracer {
            true => traced(&mesh, set.rays(), sides, watch),
            false => exact(&mesh, set.rays(), sides, questions, watch),
        };
        let mut warnings = cast_warnings(&mesh.triangles, set.rays(), sides, None, &answers);
        if set.rays().len() == 1 {
            // A miss is the answer to a question.
            warnings.retain(|warning| warning.code != WarningCode::NoHits);
        }
        let warnings = warnings.iter().map(ToString::to_string).collect::<Vec<_>>();
        Ok::<_, Failure>((arrays_of(&answers, set.rays()), warnings))
    })?;
    Ok((arrays.into_dict(py)?, warnings))
}

/// Says how far it is, and hears Ctrl-C.
fn at_a_time<'r>(rays: &'r [CastRay], watch: &Watch) -> impl Iterator<Item = &'r [CastRay]> {
    let all = rays.len();
    rays.chunks(RAYS_AT_A_TIME)
        .enumerate()
        .inspect(move |(index, _)| match all {
            0..=RAYS_AT_A_TIME => watch.pause(),
            _ => watch.stage(&format!("rays: {} of {all}", index * RAYS_AT_A_TIME)),
        })
        .map(|(_, chunk)| chunk)
}

/// The exact answers.
pub(crate) fn exact(
    mesh: &MeshCore,
    rays: &[CastRay],
    sides: Sides,
    questions: Questions,
    watch: &Watch,
) -> Answers {
    watch.stage(&format!("building a tree of {} faces", mesh.triangles.faces().len()));
    let exact = ExactCast::new(&mesh.triangles);
    let mut answers = Answers {
        first: Vec::with_capacity(rays.len()),
        any: questions.any.then(Vec::new),
        all: questions.all.then(Vec::new),
        margins: questions.margins.then(Vec::new),
    };
    for chunk in at_a_time(rays, watch) {
        let more = cast_with(&exact, chunk, sides, questions, &raypencil::Silent);
        answers.first.extend(more.first);
        answers.any = answers.any.zip(more.any).map(|(all, more)| [all, more].concat());
        extend(&mut answers.all, more.all);
        extend(&mut answers.margins, more.margins);
    }
    answers
}

fn extend<T>(all: &mut Option<Vec<T>>, more: Option<Vec<T>>) {
    if let (Some(all), Some(more)) = (all, more) {
        all.extend(more);
    }
}

/// The tracer's first hits.
fn traced(mesh: &MeshCore, rays: &[CastRay], sides: Sides, watch: &Watch) -> Answers {
    watch.stage(&format!("building a tree of {} faces", mesh.triangles.faces().len()));
    let tracer = mesh.tracer();
    let first =
        at_a_time(rays, watch).flat_map(|chunk| Answers::traced(tracer, chunk, sides).first).collect();
    Answers { first, any: None, all: None, margins: None }
}

fn side_number(side: Side) -> i8 {
    match side {
        Side::Front => 1,
        Side::Back => -1,
    }
}

/// The arrays of some answers; of first hits with a row for each ray. Names and values are those of the command's files.
pub(crate) fn arrays_of(answers: &Answers, rays: &[CastRay]) -> Arrays {
    let (count, mut arrays) = (answers.first.len(), Arrays::default());
    let vectors =
        |value: fn(&FirstHit) -> [f64; 3]| -> Vec<f64> { answers.values(value, [f64::NAN; 3]).concat() };
    arrays.add("face", &[count], answers.values(|hit| hit.face.0, NO_FACE));
    arrays.add("side", &[count], answers.values(|hit| side_number(hit.side), 0));
    arrays.add("ties", &[count], answers.values(|hit| hit.ties, 0));
    arrays.add("t", &[count], answers.distances(|hit| hit.t));
    arrays.add("range", &[count], answers.distances(|hit| hit.range));
    arrays.add("cos_incidence", &[count], answers.values(|hit| hit.cos_incidence, f64::NAN));
    arrays.add("point", &[count, 3], vectors(|hit| hit.point.to_array()));
    arrays.add("normal", &[count, 3], vectors(|hit| hit.normal.to_array()));
    arrays.add("barycentric", &[count, 3], vectors(|hit| hit.barycentric));
    if let Some(any) = &answers.any {
        arrays.add("any", &[count], any.iter().map(|&is_hit| u8::from(is_hit)).collect::<Vec<_>>());
    }
    if let Some(all) = &answers.all {
        add_all(&mut arrays, all);
    }
    if let Some(margins) = &answers.margins {
        let both = |margin: &Margin| [margin.lo, margin.hi];
        let faces: Vec<f64> = margins.iter().flat_map(|margins| both(&margins.face)).collect();
        let surfaces: Vec<f64> = margins.iter().flat_map(|margins| both(&margins.surface)).collect();
        let across: Vec<f64> =
            rays.iter().flat_map(CastRay::across).flat_map(|vector| vector.to_array()).collect();
        arrays.add("margin.face", &[count, 2], faces);
        arrays.add("margin.surface", &[count, 2], surfaces);
        arrays.add("across", &[count, 2, 3], across);
    }
    arrays
}

/// All hits of all rays, one after the other.
fn add_all(arrays: &mut Arrays, all: &[Vec<GroupAtT>]) {
    let mut start = vec![0_u64];
    let (mut faces, mut sides, mut t) = (Vec::new(), Vec::new(), Vec::new());
    let (mut of_groups, mut crossings) = (Vec::new(), Vec::new());
    for groups in all {
        for (index, group) in groups.iter().enumerate() {
            for met in &group.faces {
                faces.push(met.face.0);
                sides.push(side_number(met.side));
                t.push(group.t);
                of_groups.push(index as u32);
                crossings.push(group.crossing);
            }
        }
        start.push(faces.len() as u64);
    }
    let count = [faces.len()];
    arrays.add("all.start", &[start.len()], start);
    arrays.add("all.face", &count, faces);
    arrays.add("all.side", &count, sides);
    arrays.add("all.t", &count, t);
    arrays.add("all.group", &count, of_groups);
    arrays.add("all.crossing", &count, crossings);
}
