//! Somebody's first hits against the exact ones.

use std::collections::BTreeMap;

use glam::DVec3;
use numpy::{PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use raypencil::cast::{
    Comparison, RayVerdict, Stated, StoredErrors, compare_with, comparison_headline, comparison_json,
    comparison_text,
};
use raypencil::io::ray_rows;
use raypencil::referee::ExactCast;
use raypencil::{CastRay, FaceId, Precision, Progress, Side};

use crate::array::Arrays;
use crate::failure::Failure;
use crate::mesh::MeshCore;
use crate::rays::{rays_of, sides};
use crate::watch::watched;

/// Rays that are compared before Ctrl-C is heard again.
const RAYS_AT_A_TIME: usize = 1 << 16;

/// The precision of an arithmetic by its name.
pub(crate) fn precision(name: &str) -> Result<Precision, Failure> {
    match name {
        "f64" => Ok(Precision::F64),
        "f32" => Ok(Precision::F32),
        _ => Err(Failure::new(format!("arithmetic is {name:?}; expected \"f64\" or \"f32\""))),
    }
}

/// The verdict of each ray (u1) and its witness (f8, (n, 2)), named as the command's files.
pub(crate) fn verdict_arrays(comparison: &Comparison) -> Arrays {
    let number = |verdict: &RayVerdict| match verdict {
        RayVerdict::Same { is_tie } => u8::from(*is_tie),
        RayVerdict::Rounding { .. } => 2,
        RayVerdict::Wrong(_) => 3,
    };
    let moved = |verdict: &RayVerdict| match verdict {
        RayVerdict::Rounding { moved } => *moved,
        _ => [f64::NAN; 2],
    };
    let (verdicts, mut arrays) = (&comparison.verdicts, Arrays::default());
    arrays.add("verdict", &[verdicts.len()], verdicts.iter().map(number).collect::<Vec<_>>());
    arrays.add("moved", &[verdicts.len(), 2], verdicts.iter().flat_map(moved).collect::<Vec<_>>());
    arrays
}

/// The rays in pieces, each judged by itself: its worst values and their rays are joined.
fn compared(
    exact: &ExactCast<'_>,
    mesh: &MeshCore,
    (rays, sides): (&[CastRay], raypencil::Sides),
    stated: &Stated,
    precision: Precision,
    progress: &dyn Progress,
) -> Comparison {
    let piece = |from: usize, to: usize| stated.some_of(&(from..to).collect::<Vec<_>>());
    let mut whole: Option<Comparison> = None;
    let mut from = 0;
    loop {
        let to = (from + RAYS_AT_A_TIME).min(rays.len());
        progress.stage(&format!("comparing rays: {from} of {}", rays.len()));
        let part = compare_with(exact, &mesh.triangles, &rays[from..to], sides, &piece(from, to), precision);
        match &mut whole {
            None => whole = Some(part),
            Some(whole) => whole.append(part),
        }
        from = to;
        if from == rays.len() {
            return whole.expect("a piece was compared");
        }
    }
}

/// Compares first hits with the exact ones. `face` is -1 where nothing is hit; `t` and `range` are +Inf there, and -Inf where what
/// is hit is too near. `hit` has to say the same. `stored` is how far storing may have moved the values of each ray, by the value's name.
#[pyfunction]
#[pyo3(signature = (
    mesh, rays, name, arithmetic, fronts_only, face=None, t=None, range=None, hit=None, side=None, point=None, normal=None,
    barycentric=None, cos_incidence=None, stored=None, on_stage=None
))]
pub(crate) fn judge<'py>(
    py: Python<'py>,
    mesh: &MeshCore,
    rays: PyReadonlyArray2<'py, f64>,
    name: String,
    arithmetic: &str,
    fronts_only: bool,
    face: Option<PyReadonlyArray1<'py, i64>>,
    t: Option<PyReadonlyArray1<'py, f64>>,
    range: Option<PyReadonlyArray1<'py, f64>>,
    hit: Option<PyReadonlyArray1<'py, bool>>,
    side: Option<PyReadonlyArray1<'py, f64>>,
    point: Option<PyReadonlyArray2<'py, f64>>,
    normal: Option<PyReadonlyArray2<'py, f64>>,
    barycentric: Option<PyReadonlyArray2<'py, f64>>,
    cos_incidence: Option<PyReadonlyArray1<'py, f64>>,
    stored: Option<BTreeMap<String, PyReadonlyArray1<'py, f64>>>,
    on_stage: Option<&Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyDict>> {
    let failed = |failure: Failure| failure.into_exception(py);
    let sides = sides(fronts_only);
    let precision = precision(arithmetic).map_err(failed)?;
    let set = rays_of(&rays, sides).map_err(failed)?;
    let numbers = |array: Option<PyReadonlyArray1<'_, f64>>| array.map(|array| array.as_array().to_vec());
    let vectors = |array: Option<PyReadonlyArray2<'_, f64>>| {
        let of = |array: PyReadonlyArray2<'_, f64>| {
            array
                .as_array()
                .rows()
                .into_iter()
                .map(|row| DVec3::new(row[0], row[1], row[2]))
                .collect::<Vec<_>>()
        };
        array.map(of)
    };
    let mut stored = stored.unwrap_or_default();
    let mut errors = |name: &str| stored.remove(name).map(|array| array.as_array().to_vec());
    let of_side = |number: f64| match number {
        number if number > 0.0 => Some(Side::Front),
        number if number < 0.0 => Some(Side::Back),
        _ => None,
    };
    let stated = Stated {
        face: face
            .map(|array| array.as_array().iter().map(|&face| u32::try_from(face).ok().map(FaceId)).collect()),
        t: numbers(t),
        range: numbers(range),
        hit: hit.map(|array| array.as_array().to_vec()),
        side: numbers(side).map(|numbers| numbers.into_iter().map(of_side).collect()),
        point: vectors(point),
        normal: vectors(normal),
        barycentric: vectors(barycentric),
        cos_incidence: numbers(cos_incidence),
        stored: StoredErrors {
            t: errors("t"),
            range: errors("range"),
            point: errors("point"),
            normal: errors("normal"),
            barycentric: errors("barycentric"),
            cos_incidence: errors("cos_incidence"),
            // What is said of a comparison calls nothing exact.
            coarse: Vec::new(),
        },
    };
    let mesh = mesh.clone();
    let (comparison, text, json) = watched(py, on_stage, move |watch| {
        mesh.build_tree(false, watch);
        let exact = mesh.exact();
        let comparison = compared(&exact, &mesh, (set.rays(), sides), &stated, precision, watch);
        let command = |index: usize| {
            let (width, numbers) = ray_rows(&set.rays()[index..=index]);
            let numbers: Vec<String> = numbers.iter().map(ToString::to_string).collect();
            let blind = if width == 9 { ", t_blind" } else { "" };
            format!("origin, direction, t_min, t_max{blind}: {}", numbers.join(", "))
        };
        let text = comparison_text(&name, &comparison, command);
        let json = comparison_json(&name, &comparison).to_string();
        Ok::<_, Failure>((comparison, text, json))
    })?;
    let dict = verdict_arrays(&comparison).into_dict(py)?;
    dict.set_item("passes", comparison.passes())?;
    dict.set_item("headline", comparison_headline(&comparison))?;
    dict.set_item("text", text)?;
    dict.set_item("json", json)?;
    Ok(dict)
}
