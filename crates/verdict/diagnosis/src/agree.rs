//! Whether two values are near enough to be tried further. The judge has the last word.

use glam::DVec3;
use raypencil_files::Storage;
use raypencil_judge::{GroundTruth, Quantity, Recorded};
use raypencil_scene::{HitQuantity, Place};

use crate::case::Case;
use crate::channel::{Channel, Value};
use crate::numbers::middle;

/// Relative difference of values that count as equal while corrections are tried. Tuned: single precision leaves less
/// on nearly all rays, and neighbouring rays differ by more.
const TRIAL_TOLERANCE: f64 = 1e-5;

/// Part of the median error of the wrong values that may be left: what is left is not what was wrong.
const LEFT_OF_ERROR: f64 = 1.0 / 64.0;

/// Relative errors that a few operations of doubles leave.
const LEAST_TOLERANCE: f64 = 1e-13;

/// Wrong values from which the tolerance is found, at most.
const MAX_VALUES: usize = 4096;

/// The relative tolerance for a channel's storage: half precision rounds by up to 2^-11, single precision by 2^-24, which a
/// correction may double twice.
pub(crate) fn tolerance(case: Case<'_>, channel: Channel) -> f64 {
    match case.recorded.storage.get(&(channel.sensor, channel.item)) {
        Some(Storage::F16) => 1.0 / 1024.0,
        Some(Storage::F32) => case.tolerance.max(1.0 / f64::from(1 << 22)),
        _ => case.tolerance,
    }
}

/// The tolerance for trials: a small part of the errors that are to be explained, where they are small themselves.
pub(crate) fn tolerance_of(truth: &GroundTruth<'_>, recorded: &Recorded, wrong: &[(Channel, Place)]) -> f64 {
    let step = wrong.len().div_ceil(MAX_VALUES).max(1);
    let error = |(channel, place): &(Channel, Place)| {
        let [stated, exact] = [&recorded.answers, truth.answers()].map(|answers| channel.at(answers, *place));
        match (stated, exact) {
            (Value::Number(stated), Value::Number(exact)) => Some(((stated - exact) / exact).abs()),
            (Value::Vector(stated), Value::Vector(exact)) => Some((stated - exact).length() / exact.length()),
            _ => None,
        }
    };
    let mut errors: Vec<f64> = wrong.iter().step_by(step).filter_map(error).collect();
    let median = middle(&mut errors, 1).map_or(1.0, |(median, _)| median);
    (median * LEFT_OF_ERROR).clamp(LEAST_TOLERANCE, TRIAL_TOLERANCE)
}

/// The absolute tolerance for a channel that is stored in steps: half a step is rounded away.
fn step(case: Case<'_>, channel: Channel) -> f64 {
    match case.recorded.storage.get(&(channel.sensor, channel.item)) {
        Some(Storage::Steps(step)) => step.get(),
        _ => 0.0,
    }
}

/// The absolute tolerance for a number.
pub(crate) fn of_number(case: Case<'_>, channel: Channel, exact: f64) -> f64 {
    let is_cosine =
        matches!(channel.item.quantity, Quantity::CosIncidence | Quantity::CosOffAxis | Quantity::CosView);
    let scale = if is_cosine { 1.0 } else { exact.abs() };
    tolerance(case, channel) * scale
}

pub(crate) fn is_near(case: Case<'_>, channel: Channel, place: Place, stated: Value, exact: Value) -> bool {
    let tolerance = tolerance(case, channel);
    match (stated, exact) {
        (Value::Number(stated), Value::Number(exact)) => {
            (stated - exact).abs() <= of_number(case, channel, exact) + step(case, channel)
        }
        (Value::Vector(stated), Value::Vector(exact)) => {
            let scale = if channel.item.quantity == Quantity::Point {
                exact.length() + range(case, place)
            } else {
                1.0
            };
            (stated - exact).length() <= tolerance * scale
        }
        (stated, exact) => stated == exact,
    }
}

/// The exact range of a ray, metres; 0 without a hit.
fn range(case: Case<'_>, place: Place) -> f64 {
    let map = case.truth.answers().map(place.sensor);
    let value = map.raster(HitQuantity::Range).and_then(|raster| raster.at(place.i, place.j));
    value.and_then(|value| value.scalar()).unwrap_or(0.0)
}

/// The exact value, if the storage of the stated one explains what is left after a correction; else the corrected one.
///
/// A number that was stored in another unit was rounded in that unit. Eight roundings of doubles are allowed to the
/// correction itself.
pub(crate) fn absorbed(storage: Storage, stated: Value, corrected: Value, exact: Value) -> Value {
    let ulp = |number: f64| 0.5 * storage.ulp(number);
    let near = match (stated, corrected, exact) {
        (Value::Number(stated), Value::Number(corrected), Value::Number(exact)) if stated != corrected => {
            let scale = if stated == 0.0 { 1.0 } else { (corrected / stated).abs() };
            (corrected - exact).abs() <= ulp(stated) * scale + 8.0 * f64::EPSILON * exact.abs()
        }
        (Value::Vector(stated), Value::Vector(corrected), Value::Vector(exact)) if stated != corrected => {
            let rounding = DVec3::from_array(stated.to_array().map(ulp)).length();
            let scale = (corrected.length() / stated.length()).min(1e3);
            let size = stated.length() * scale + exact.length();
            (corrected - exact).length() <= rounding * scale + 8.0 * f64::EPSILON * size
        }
        _ => false,
    };
    if near { exact } else { corrected }
}

#[cfg(test)]
#[path = "../tests/unit/agree.rs"]
mod tests;
