//! Any rays on any mesh, answered.

use numpy::PyReadonlyArray2;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use raypencil::cast::{
    AllColumns, Answers, CastSeen, Caster, FirstColumns, GroupAtT, MeshHome, Questions, ReadingCounts,
    Values, cast_beside_first, cast_warnings_of, traced_beside_first,
};
use raypencil::referee::Margin;
use raypencil::{CastRay, Progress, Sides, Silent};

use crate::array::Arrays;
use crate::failure::Failure;
use crate::mesh::MeshCore;
use crate::rays::{rays_from, sides};
use crate::watch::{Watch, on_threads, watched};

/// Rays that are answered before Ctrl-C is heard again: a few tenths of a second.
const RAYS_AT_A_TIME: usize = 1 << 16;

/// Rays of which the answers are there before a thread for them would be.
const FEW_RAYS: usize = 64;

/// `hits`, `too_near` and `backs`.
type Counts = (u64, u64, u64);

/// Of how many rays plain f64, intervals and exact arithmetic decided the first hit.
type Decided = (u64, u64, u64);

/// Arrays, counts, what decided if the referee was asked for first hits, and warnings.
type Told<'py> = (Bound<'py, PyDict>, Counts, Option<Decided>, Vec<String>);

/// What is asked.
#[derive(Debug, Clone, Copy)]
struct Asked {
    values: Values,
    questions: Questions,
    by_tracer: bool,
    sides: Sides,
}

/// Answers to rays.
struct Answered {
    columns: FirstColumns,
    /// `first` is empty.
    beside: Answers,
    counts: ReadingCounts,
}

/// Answers rays of (n, 9) on a mesh: arrays by the names of `docs/guide/cast.md`, of this shape, how many rays read what,
/// what decided it if the referee was asked for first hits, and what looks wrong. The bits of `values` are the names of `raypencil::cast::Values`; in messages the first ray has the index `first`.
#[pyfunction]
#[pyo3(signature = (
    mesh, rays, shape, first, values, by_tracer, fronts_only, any, all, margins, threads, warn, on_stage=None
))]
pub(crate) fn cast<'py>(
    py: Python<'py>,
    mesh: &Bound<'py, MeshCore>,
    rays: PyReadonlyArray2<'py, f64>,
    shape: Vec<usize>,
    first: usize,
    values: u32,
    by_tracer: bool,
    fronts_only: bool,
    any: bool,
    all: bool,
    margins: bool,
    threads: usize,
    warn: bool,
    on_stage: Option<&Bound<'py, PyAny>>,
) -> PyResult<Told<'py>> {
    let failed = |failure: Failure| failure.into_exception(py);
    let set = rays_from(&rays, first).map_err(failed)?;
    drop(rays);
    if shape.iter().product::<usize>() != set.len() {
        return Err(failed(Failure::new(format!("{} rays have no shape {shape:?}", set.len()))));
    }
    let questions = Questions { any, all, margins };
    let asked = Asked { values: Values::of_bits(values), questions, by_tracer, sides: sides(fronts_only) };
    let mesh = mesh.get();
    let is_quick = set.len() <= FEW_RAYS && !margins && on_stage.is_none() && mesh.is_built(by_tracer);
    let (rays, answered, warnings) = if is_quick {
        // A thread of its own takes longer to begin than all of this.
        py.detach(|| {
            let answered = answer(mesh, &set, asked, &Silent, |_| ());
            let warnings = if warn { warnings(mesh, &set, asked, answered.counts) } else { Vec::new() };
            (set, answered, warnings)
        })
    } else {
        let mesh = mesh.clone();
        watched(py, on_stage, move |watch| {
            on_threads(threads, || {
                mesh.build_tree(by_tracer, watch);
                watch.stage(&format!("casting {} rays", set.len()));
                let answered = answer(&mesh, &set, asked, watch, |at| on_the_way(watch, at, set.len()));
                let warnings = if warn { warnings(&mesh, &set, asked, answered.counts) } else { Vec::new() };
                (set, answered, warnings)
            })
        })?
    };
    let ReadingCounts { hits, too_near, backs, decided } = answered.counts;
    let is_exact = !by_tracer && asked.values != Values::default();
    let decided = is_exact.then_some((decided.filter, decided.intervals, decided.exact));
    let arrays = arrays_of(answered, &rays, &shape, by_tracer);
    Ok((arrays.into_dict(py)?, (hits, too_near, backs), decided, warnings))
}

/// Says nothing, unless one of the rays of (n, 9) is none. The first one has the index `first`.
#[pyfunction]
pub(crate) fn check_rays(py: Python<'_>, rays: PyReadonlyArray2<'_, f64>, first: usize) -> PyResult<()> {
    rays_from(&rays, first).map(drop).map_err(|failure| failure.into_exception(py))
}

/// What looks wrong in rays that were answered in parts, of which so many read what. Where some hit, the rays need not be given.
#[pyfunction]
pub(crate) fn cast_warnings(
    py: Python<'_>,
    mesh: &Bound<'_, MeshCore>,
    rays: PyReadonlyArray2<'_, f64>,
    fronts_only: bool,
    all: bool,
    counts: Counts,
) -> PyResult<Vec<String>> {
    let set = rays_from(&rays, 0).map_err(|failure| failure.into_exception(py))?;
    let (hits, too_near, backs) = counts;
    let asked = Asked {
        values: Values::ALL,
        questions: Questions { all, ..Questions::default() },
        by_tracer: false,
        sides: sides(fronts_only),
    };
    let mesh = mesh.get().clone();
    let counts = ReadingCounts { hits, too_near, backs, ..ReadingCounts::default() };
    watched(py, None, move |_| Ok(warnings(&mesh, &set, asked, counts)))
}

/// Says how far it is, and hears Ctrl-C.
fn on_the_way(watch: &Watch, at: usize, all: usize) {
    match all {
        0..=RAYS_AT_A_TIME => watch.pause(),
        _ => watch.stage(&format!("rays: {at} of {all}")),
    }
}

/// The answers; `on_the_way` is called with the index of the next ray.
fn answer(
    mesh: &MeshCore,
    rays: &[CastRay],
    asked: Asked,
    progress: &dyn Progress,
    on_the_way: impl Fn(usize),
) -> Answered {
    let Asked { values, questions, by_tracer, sides } = asked;
    let exact = (!by_tracer).then(|| mesh.exact());
    let caster = exact.as_ref().map_or_else(|| Caster::Tracer(mesh.tracer()), Caster::Referee);
    let asks_first = values != Values::default();
    let mut columns = FirstColumns::new(rays.len(), values);
    let mut counts = ReadingCounts::default();
    let mut beside = Answers {
        first: Vec::new(),
        any: questions.any.then(Vec::new),
        all: questions.all.then(Vec::new),
        margins: questions.margins.then(Vec::new),
        decided: None,
    };
    for (index, part) in rays.chunks(RAYS_AT_A_TIME).enumerate() {
        let at = index * RAYS_AT_A_TIME;
        on_the_way(at);
        let mut more = if asks_first {
            columns.part(at..at + part.len()).ask(caster, part, sides)
        } else {
            ReadingCounts::default()
        };
        if questions != Questions::default() {
            let further = match caster {
                // Where it has stages, a ray takes long.
                Caster::Referee(exact) if questions.margins => {
                    cast_beside_first(exact, part, sides, questions, progress)
                }
                Caster::Referee(exact) => cast_beside_first(exact, part, sides, questions, &Silent),
                Caster::Tracer(tracer) => traced_beside_first(tracer, part, sides, questions),
            };
            if !asks_first {
                more.hits = hits_of(&further);
            }
            extend(&mut beside.any, further.any);
            extend(&mut beside.all, further.all);
            extend(&mut beside.margins, further.margins);
        }
        counts = counts.and(more);
    }
    Answered { columns, beside, counts }
}

/// Number of rays that hit anything, of whose first hits nothing is known.
fn hits_of(answers: &Answers) -> u64 {
    let by_any = answers.any.as_ref().map(|any| any.iter().filter(|&&is_hit| is_hit).count());
    let by_all = answers.all.as_ref().map(|all| all.iter().filter(|groups| !groups.is_empty()).count());
    by_any.or(by_all).unwrap_or(0) as u64
}

fn extend<T>(all: &mut Option<Vec<T>>, more: Option<Vec<T>>) {
    if let (Some(all), Some(more)) = (all, more) {
        all.extend(more);
    }
}

/// What looks wrong. A miss of one ray is the answer to a question.
fn warnings(mesh: &MeshCore, rays: &[CastRay], asked: Asked, counts: ReadingCounts) -> Vec<String> {
    let Questions { any, all, .. } = asked.questions;
    let knows_hits = asked.values != Values::default() || any || all;
    let rays = if knows_hits && rays.len() != 1 { rays } else { &[] };
    let seen = CastSeen { counts, open_edges: all.then(|| mesh.open_edges()) };
    let found = cast_warnings_of(
        (&mesh.triangles, MeshHome::default()),
        || mesh.exact(),
        rays,
        asked.sides,
        None,
        seen,
    );
    found.iter().map(ToString::to_string).collect()
}

/// The arrays of some answers. Names and values are those of the command's files.
fn arrays_of(answered: Answered, rays: &[CastRay], shape: &[usize], by_tracer: bool) -> Arrays {
    let Answered { columns, beside: Answers { any, all, margins, .. }, .. } = answered;
    let FirstColumns { face, side, ties, t, range, cos_incidence, point, normal, barycentric } = columns;
    let with = |last: &[usize]| [shape, last].concat();
    let of_three = with(&[3]);
    let mut arrays = Arrays::default();
    arrays.add_some("face", shape, face);
    arrays.add_some("side", shape, side);
    arrays.add_some("ties", shape, ties);
    arrays.add_some("t", shape, t);
    arrays.add_some("range", shape, range);
    arrays.add_some("cos_incidence", shape, cos_incidence);
    arrays.add_some("point", &of_three, point.map(Vec::into_flattened));
    arrays.add_some("normal", &of_three, normal.map(Vec::into_flattened));
    arrays.add_some("barycentric", &of_three, barycentric.map(Vec::into_flattened));
    arrays.add_some("any", shape, any.map(|any| any.into_iter().map(u8::from).collect::<Vec<_>>()));
    if let Some(all) = &all {
        add_all(&mut arrays, all, !by_tracer);
    }
    if let Some(margins) = &margins {
        let both = |margin: &Margin| [margin.lo, margin.hi];
        let faces: Vec<f64> = margins.iter().flat_map(|margins| both(&margins.face)).collect();
        let surfaces: Vec<f64> = margins.iter().flat_map(|margins| both(&margins.surface)).collect();
        let across: Vec<f64> =
            rays.iter().flat_map(CastRay::across).flat_map(|vector| vector.to_array()).collect();
        arrays.add("margin.face", &with(&[2]), faces);
        arrays.add("margin.surface", &with(&[2]), surfaces);
        arrays.add("across", &with(&[2, 3]), across);
    }
    arrays
}

/// All hits of all rays, one after the other.
fn add_all(arrays: &mut Arrays, all: &[Vec<GroupAtT>], with_crossings: bool) {
    let AllColumns { start, face, side, t, group, crossing } = AllColumns::of(all);
    let count = [face.len()];
    arrays.add("all.start", &[start.len()], start);
    arrays.add("all.face", &count, face);
    arrays.add("all.side", &count, side);
    arrays.add("all.t", &count, t);
    arrays.add("all.group", &count, group);
    if with_crossings {
        arrays.add("all.crossing", &count, crossing);
    }
}
