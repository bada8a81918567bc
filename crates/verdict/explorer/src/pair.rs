//! Two sides of a sensor beside each other: the class of every ray, and how far the ranges differ.

use rayon::prelude::*;
use raypencil_judge::{Class, DifferingRay, Quantity, SensorResult, range_bound};
use raypencil_scene::{Place, Precision, Scene, SensorMap, Switches};
use serde_json::{Value, json};

use crate::arrays::{Arrays, Change};

/// Code of a cell without class, cause or quantity.
const NONE: u8 = u8::MAX;

/// The result of the judge on one pair of sides.
#[derive(Debug, Clone, Copy)]
pub struct SensorPair<'a> {
    /// Indices of the sides, in the order in which they were added to the page.
    pub sides: [usize; 2],
    /// What the judge found.
    pub result: &'a SensorResult,
    /// Maps and precisions, if both sides have ranges: for their difference in f64.
    pub compared: Option<ComparedMaps<'a>>,
}

/// The ranges of two sides.
#[derive(Debug, Clone, Copy)]
pub struct ComparedMaps<'a> {
    /// Maps of both sides.
    pub maps: [&'a SensorMap; 2],
    /// Precision of the arithmetic of both.
    pub precisions: [Precision; 2],
}

/// What the judge found on one sensor, for the page model. `causes` lists the sets of approximations that the page knows.
pub(crate) fn pair_model(
    arrays: &mut Arrays,
    scene: &Scene,
    &SensorPair { sides, result, compared }: &SensorPair<'_>,
    causes: &[Switches],
) -> Value {
    let (width, height) = scene.size(result.sensor).expect("a sensor of this scene");
    let cells = width as usize * height as usize;
    let is_compared = result.compared() > 0;
    let mut classes = vec![if is_compared { Class::Agree as u8 } else { NONE }; cells];
    let mut quantities = vec![NONE; cells];
    let mut cause_of = vec![NONE; cells];
    for DifferingRay { i, j, class, item, causes: of_ray } in &result.differing {
        let cell = (*j * width + *i) as usize;
        classes[cell] = *class as u8;
        quantities[cell] = index_of(item.quantity);
        let cause = causes.iter().position(|known| known == of_ray && *class == Class::Approximation);
        cause_of[cell] = cause.map_or(NONE, |cause| cause as u8);
    }
    let [range_ulps, range_bound] = match compared {
        Some(compared) => ranges(arrays, scene, result, compared),
        None => [Value::Null, Value::Null],
    };
    json!({
        "a": sides[0], "b": sides[1],
        "class": arrays.u8(&classes),
        "cause": arrays.u8(&cause_of),
        "quantity": arrays.u8(&quantities),
        "range_ulps": range_ulps,
        "range_bound": range_bound,
    })
}

/// Index of a quantity in [`Quantity::ALL`].
pub(crate) fn index_of(quantity: Quantity) -> u8 {
    Quantity::ALL.iter().position(|known| *known == quantity).expect("a quantity") as u8
}

/// Difference of the ranges in units in the last place of f64, and the bound of that difference.
fn ranges(
    arrays: &mut Arrays,
    scene: &Scene,
    result: &SensorResult,
    ComparedMaps { maps, precisions }: ComparedMaps<'_>,
) -> [Value; 2] {
    let [Some(of_a), Some(of_b)] = maps.map(|map| map.range.as_ref()) else {
        return [Value::Null, Value::Null];
    };
    let (width, height) = (of_a.width(), of_a.height());
    let cells: Vec<(u32, u32)> = (0..height).flat_map(|j| (0..width).map(move |i| (i, j))).collect();
    let both: Vec<(i32, u8)> = cells
        .into_par_iter()
        .map(|(i, j)| {
            let (Some(a), Some(b)) = (of_a.at(i, j).get(), of_b.at(i, j).get()) else { return (0, 0) };
            let face = maps.iter().find_map(|map| map.face.as_ref()?.at(i, j).get());
            let place = Place { sensor: result.sensor, i, j };
            let bound = face.and_then(|face| range_bound(scene, place, face, a, precisions));
            (ulps_between(a, b), bound.map_or(0, code_of_bound))
        })
        .collect();
    let ulps: Vec<i32> = both.iter().map(|(ulps, _)| *ulps).collect();
    let bounds: Vec<u8> = both.iter().map(|(_, bound)| *bound).collect();
    [arrays.i32(&ulps, Change::None).reference, arrays.u8(&bounds)]
}

/// Steps from one f64 to the other, in the order of numbers; at most `i32::MAX` either way.
fn ulps_between(from: f64, to: f64) -> i32 {
    // The bits of numbers of one sign are in the order of the numbers; ranges are positive.
    let order = |x: f64| x.to_bits().cast_signed();
    if from.is_nan() || to.is_nan() {
        return i32::MAX;
    }
    let steps = order(to).saturating_sub(order(from));
    steps.clamp(-i64::from(i32::MAX), i64::from(i32::MAX)) as i32
}

/// Code of a bound of a length, metres: 2^((code - 1) / 4 - 60) is at most 9 % off. 0 stands for none.
fn code_of_bound(bound: f64) -> u8 {
    if !(bound > 0.0) {
        return 0;
    }
    let quarters = (4.0 * (libm::log2(bound) + 60.0)).round();
    1 + quarters.clamp(0.0, 253.0) as u8
}

#[cfg(test)]
#[path = "../tests/unit/pair.rs"]
mod tests;
