//! Values of arrays that are rounded to decimals, or to multiples of another step.

use super::mistakes::{Extra, Group};
use super::steps::{is_multiple, step, steps_of_ten, steps_of_two};
use super::trial::Trial;
use crate::comparison::{CastValue, Stated};
use raypencil_scene::Precision;

/// Decimals that values may be rounded to.
const DECIMALS: std::ops::RangeInclusive<i32> = 1..=12;

/// Powers of ten of which parts are steps, and negative powers of two that are. Coarser ones are steps of many scenes themselves.
const POWERS_OF_TEN: std::ops::RangeInclusive<i32> = -8..=-3;
const POWERS_OF_TWO: std::ops::RangeInclusive<i32> = 8..=20;

/// Rays that are looked at, at most.
const MAX_LOOKED: usize = 400;

/// Which values are rounded, in words.
const GROUPS: [(&str, &[CastValue]); 8] = [
    ("all values are", &CastValue::ALL),
    ("lengths and points are", &[CastValue::T, CastValue::Range, CastValue::Point]),
    ("t is", &[CastValue::T]),
    ("the range is", &[CastValue::Range]),
    ("points are", &[CastValue::Point]),
    ("normals are", &[CastValue::Normal]),
    ("barycentric weights are", &[CastValue::Barycentric]),
    ("cosines of incidence are", &[CastValue::CosIncidence]),
];

/// The numbers of a value of a ray, and how far storing may have moved each.
fn numbers(stated: &Stated, value: CastValue, ray: usize) -> impl Iterator<Item = [f64; 2]> {
    let parts = stated.part(value, ray).filter(|_| value != CastValue::Side);
    let error = stated.stored.of(value, ray);
    let count = if value.is_vector() { 3 } else { 1 };
    let all = parts.into_iter().flat_map(move |parts| parts.into_iter().take(count));
    all.filter(|number| number.is_finite()).map(move |number| [number, error])
}

/// The fewest decimals, or the largest step, to which values are rounded, if they are.
pub(super) fn decimals(trial: &Trial) -> Vec<Extra<'static>> {
    let of_decimals: Vec<f64> = DECIMALS.map(|decimals| libm::pow(10.0, f64::from(-decimals))).collect();
    let every = trial.rays.len().div_ceil(MAX_LOOKED).max(1);
    let mut found: Vec<Extra<'static>> = Vec::new();
    for (whose, values) in GROUPS {
        let given = |value: &&CastValue| trial.stated.part(**value, 0).is_some();
        if trial.rays.is_empty() || (values.len() > 1 && values.iter().filter(given).count() < 2) {
            continue;
        }
        let some = (0..trial.rays.len()).step_by(every);
        let of_ray = |ray| values.iter().flat_map(move |value| numbers(&trial.stated, *value, ray));
        let mut numbers_of_some: Vec<[f64; 2]> = some.flat_map(of_ray).collect();
        let of_ten = step(&numbers_of_some, &of_decimals);
        let of_part = step(&numbers_of_some, &steps_of_ten(POWERS_OF_TEN).collect::<Vec<_>>());
        // A number of single precision is a multiple of its own last place: that says nothing.
        for [number, error] in &mut numbers_of_some {
            *error = error.max(Precision::F32.unit_roundoff * number.abs());
        }
        let of_two = step(&numbers_of_some, &steps_of_two(POWERS_OF_TWO).collect::<Vec<_>>());
        let larger = |a: f64, b: f64| if b > a { b } else { a };
        let Some(step) = [of_ten, of_part, of_two].into_iter().flatten().reduce(larger) else { continue };
        let decimals = -libm::log10(step).round();
        let undo = move |trial: &mut Trial| {
            for value in values {
                for ray in 0..trial.rays.len() {
                    let is_rounded = numbers(&trial.stated, *value, ray)
                        .all(|[number, error]| is_multiple(number, error, step));
                    if is_rounded {
                        trial.stated.stored.widen(*value, (ray, trial.rays.len()), 0.5 * step);
                    }
                }
            }
            trial.allowance = step;
        };
        let noun = if decimals == 1.0 { "decimal" } else { "decimals" };
        let words = match of_ten == Some(step) {
            true => format!("{whose} rounded to {decimals} {noun}"),
            false => format!("{whose} rounded to multiples of {step}"),
        };
        found.push(Extra { words, undo: Box::new(undo), is_common: false, group: Group::Others });
    }
    found
}
