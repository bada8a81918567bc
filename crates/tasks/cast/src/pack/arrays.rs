//! Mistakes of arrays that follow from their numbers or their shape: orders of rays, axes, and constants for no hit.

use glam::DVec3;
use raypencil_referee::ExactCast;
use raypencil_scene::{Reading, Sides};

use super::mistakes::{Extra, Group, declare_miss};
use super::trial::Trial;
use crate::comparison::Stated;

/// Rays among which constants are looked for, at most.
const MAX_LOOKED: usize = 400;

/// Misses that have one number, at least: of fewer it is no constant.
const MIN_MISSES: usize = 3;

/// Different answers that an order moves, at least. Fewer are exchanged by many orders alike.
const MIN_DIFFERENT: usize = 3;

/// Orders in which the answers may lie, other than that of the rays. `stated` are the answers to all rays, of this shape.
pub(super) fn orders<'a>(stated: &'a Stated, shape: &[u64]) -> Vec<Extra<'a>> {
    let all: usize = shape.iter().product::<u64>() as usize;
    let lengths: Vec<usize> =
        shape.iter().map(|&length| length as usize).filter(|&length| length > 1).collect();
    let mut list = Vec::new();
    // The place of the answer to each ray.
    let mut add = |words: &str, place: Box<dyn Fn(usize) -> usize + 'a>| {
        if !moves_several(stated, all, &place) {
            return;
        }
        let undo = move |trial: &mut Trial| {
            let places: Vec<usize> = trial.indices.iter().map(|&index| place(index)).collect();
            trial.stated = stated.some_of(&places);
        };
        list.push(Extra {
            words: words.into(),
            undo: Box::new(undo),
            is_common: false,
            group: Group::Others,
        });
    };
    match lengths[..] {
        [] => {}
        [_] => add("answers run from the last ray to the first", Box::new(move |index| all - 1 - index)),
        [rows, ..] => {
            let of_row = all / rows;
            let last = lengths[lengths.len() - 1];
            add(
                "rows of answers run from the last to the first",
                Box::new(move |index| (rows - 1 - index / of_row) * of_row + index % of_row),
            );
            add(
                "the answers of each row run from the last to the first",
                Box::new(move |index| index / last * last + last - 1 - index % last),
            );
            add("all answers run from the last ray to the first", Box::new(move |index| all - 1 - index));
            add(
                "answers are in column order (F): the last dimension runs fastest (C)",
                Box::new(move |index| {
                    // The digits of the index, from the fastest dimension on; of column order the first dimension is the fastest.
                    let (mut rest, mut place, mut stride) = (index, 0, all);
                    for &length in lengths.iter().rev() {
                        stride /= length;
                        place += rest % length * stride;
                        rest /= length;
                    }
                    place
                }),
            );
        }
    }
    list
}

/// Whether an order moves several different answers. Of fewer it is the same as an exchange of two answers, or of two parts of equal
/// ones, and nothing says which of these it was.
fn moves_several(stated: &Stated, all: usize, place: &dyn Fn(usize) -> usize) -> bool {
    let mut different: Vec<usize> = Vec::new();
    for ray in (0..all).filter(|&ray| !stated.is_same_answer(ray, place(ray))) {
        if different.iter().all(|&other| !stated.is_same_answer(ray, other)) {
            different.push(ray);
            if different.len() == MIN_DIFFERENT {
                return true;
            }
        }
    }
    false
}

/// A vector by the components of another one, each with its sign.
type Axes = ([usize; 3], [f64; 3]);

/// All ways to name and turn three axes but the right one, for points and normals, and for either alone.
pub(super) fn axes(stated: &Stated) -> Vec<Extra<'static>> {
    let orders = [[0, 1, 2], [1, 0, 2], [0, 2, 1], [2, 1, 0], [1, 2, 0], [2, 0, 1]];
    let sign = |bits: u32| [0, 1, 2].map(|axis| if bits >> axis & 1 == 1 { -1.0 } else { 1.0 });
    let all = orders.into_iter().flat_map(|order| (0..8).map(move |bits| (order, sign(bits))));
    let others: Vec<Axes> = all.filter(|one| *one != ([0, 1, 2], [1.0; 3])).collect();
    let whose: &[(&str, [bool; 2])] = match (&stated.point, &stated.normal) {
        (Some(_), Some(_)) => {
            &[("points and normals", [true, true]), ("points", [true, false]), ("normals", [false, true])]
        }
        (Some(_), None) => &[("points", [true, false])],
        (None, Some(_)) => &[("normals", [false, true])],
        (None, None) => &[],
    };
    let of = |&(name, [points, normals]): &(&str, [bool; 2])| {
        let extra = move |(order, signs): &Axes| {
            let part =
                |k: usize| format!("{}{}", if signs[k] < 0.0 { "-" } else { "" }, ["x", "y", "z"][order[k]]);
            let words = format!("{name} are ({}, {}, {}) of the mesh's (x, y, z)", part(0), part(1), part(2));
            let (order, signs) = (*order, *signs);
            let undo = move |trial: &mut Trial| {
                let stated = &mut trial.stated;
                let of_points = stated.point.iter_mut().filter(|_| points).flatten();
                for vector in of_points.chain(stated.normal.iter_mut().filter(|_| normals).flatten()) {
                    let mut right = [0.0; 3];
                    (0..3).for_each(|k| right[order[k]] = signs[k] * vector[k]);
                    *vector = DVec3::from_array(right);
                }
            };
            Extra { words, undo: Box::new(undo), is_common: false, group: Group::Others }
        };
        others.iter().map(extra).collect::<Vec<_>>()
    };
    whose.iter().flat_map(of).collect()
}

/// Constants that all rays have which meet nothing.
pub(super) fn constants(trial: &Trial, exact: &ExactCast<'_>, sides: Sides) -> Vec<Extra<'static>> {
    let looked = 0..trial.rays.len().min(MAX_LOOKED);
    let misses: Vec<usize> =
        looked.filter(|&k| matches!(exact.reading(&trial.rays[k], sides), Reading::Miss)).collect();
    let one = |number: &dyn Fn(usize) -> Option<f64>| {
        let first = number(*misses.first()?)?;
        let is_one = misses.len() >= MIN_MISSES && misses.iter().all(|&k| number(k) == Some(first));
        // 0 and -1 have reasons of their own.
        (is_one && first.is_finite() && first != 0.0 && first != -1.0).then_some(first)
    };
    let stated = &trial.stated;
    let distance = |array: &Option<Vec<f64>>, k: usize| array.as_ref().map(|array| array[k]);
    let face = |k: usize| stated.face.as_ref().and_then(|faces| faces[k]).map(|face| f64::from(face.0));
    let point = |k: usize| {
        let [x, y, z] = stated.point.as_ref()?[k].to_array();
        (x == y && y == z).then_some(x)
    };
    let of_arrays = [
        one(&|k| distance(&stated.t, k)),
        one(&|k| distance(&stated.range, k)),
        one(&face),
        one(&point),
        one(&|k| distance(&stated.cos_incidence, k)),
    ];
    let mut found: Vec<f64> = of_arrays.into_iter().flatten().collect();
    found.dedup();
    let extra = |number: f64| {
        let text = if number.abs() < 1e15 { number.to_string() } else { format!("{number:e}") };
        let words = format!("{text} means no hit: declare --miss {text}");
        let undo = move |trial: &mut Trial| declare_miss(trial, number);
        Extra { words, undo: Box::new(undo), is_common: true, group: Group::Others }
    };
    found.into_iter().map(extra).collect()
}
