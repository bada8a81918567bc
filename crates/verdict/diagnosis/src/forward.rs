//! Mistakes that nothing undoes, since a number was rounded or lost: what they make of the exact value is compared with what is
//! stated.

use crate::agree::is_near;
use crate::case::Case;
use crate::channel::{Channel, Value};
use crate::mistake::{CutBy, Held, Mistake};
use glam::DVec3;
use raypencil_files::Storage;
use raypencil_judge::{Item, Quantity};
use raypencil_scene::{Place, SensorId};

/// Relative error allowed to a few operations of doubles.
const FEW_ROUNDINGS: f64 = 8.0 * f64::EPSILON;

/// The value that a recording with this mistake would have had: the exact one, if what is stated is what the mistake
/// makes of it; the stated one, if the mistake leaves this ray alone; else one that is wrong.
pub(crate) fn foretold(
    mistake: Mistake,
    case: Case<'_>,
    channel: Channel,
    place: Place,
    stated: Value,
) -> Value {
    let exact = channel.at(case.truth.answers(), place);
    let is_foretold = match mistake {
        Mistake::Rounded { quantum, down, .. } => match (stated, exact) {
            (Value::Number(stated), Value::Number(exact)) => {
                let storage = case.recorded.storage.get(&(channel.sensor, channel.item));
                is_rounded(storage.copied().unwrap_or(Storage::F64), stated, exact, quantum, down)
            }
            _ => return stated,
        },
        Mistake::PointsRounded(quantum) => match (stated, exact) {
            (Value::Vector(stated), Value::Vector(exact)) => {
                let storage = case.recorded.storage.get(&(channel.sensor, channel.item));
                let storage = storage.copied().unwrap_or(Storage::F64);
                (0..3).all(|k| is_rounded(storage, stated[k], exact[k], quantum, false))
            }
            _ => return stated,
        },
        Mistake::HalfPrecision(_) => match (stated, exact) {
            (Value::Number(stated), Value::Number(exact)) => is_half(stated, exact),
            _ => return stated,
        },
        Mistake::ZBuffer { low, low_at, one_at } => match (stated, exact) {
            (Value::Number(stated), Value::Number(exact)) => {
                let storage = case.recorded.storage.get(&(channel.sensor, channel.item));
                let slack = z_buffer_slack(storage.copied().unwrap_or(Storage::F64));
                (z_buffer(exact, low, [low_at, one_at]) - stated).abs() <= slack
            }
            _ => return stated,
        },
        Mistake::Cut { by, is_above, at, held, .. } => {
            let is_beyond = cut_number(case, by, place).is_some_and(|number| match (by, is_above) {
                (CutBy::Row | CutBy::Column, true) => number >= at,
                (CutBy::Row | CutBy::Column, false) => number <= at,
                (_, true) => number > at,
                (_, false) => number < at,
            });
            if !is_beyond || stated == exact {
                return stated;
            }
            holds(case, channel, place, stated, (by, is_above, held))
        }
        Mistake::HoldsBeam(beam) => {
            let sensor = SensorId::Beam(beam);
            let other = Channel { sensor, ..channel };
            let other = other.at(case.truth.answers(), Place { sensor, ..place });
            is_near(case, channel, place, stated, other)
        }
        Mistake::BeamFluxExchanged => {
            let item = Item { beam: channel.item.beam.map(|beam| 1 - beam.min(1)), ..channel.item };
            let other = Channel { item, ..channel }.at(case.truth.answers(), place);
            is_near(case, channel, place, stated, other)
        }
        // At a miss nothing is seen, whatever is said.
        Mistake::VisibleReversed => match (stated, exact) {
            (Value::Flag(stated), Value::Flag(exact)) => stated != exact || case.truth.hit(place).is_none(),
            _ => return stated,
        },
        Mistake::NoShadowTest | Mistake::HitsVisible => {
            let is_asked = match mistake {
                Mistake::NoShadowTest => would_be_seen(case, place),
                _ => case.truth.hit(place).is_some(),
            };
            let is_hidden = is_asked && !case.truth.visibility(place).0;
            match (stated, is_hidden) {
                (_, false) => return stated,
                // A hit that is hidden, and said to be, speaks against it.
                (Value::Flag(is_visible), true) => is_visible,
                (Value::Number(flux), true) => flux >= 0.0,
                _ => false,
            }
        }
        _ => return stated,
    };
    if is_foretold { exact } else { wrong(exact, stated) }
}

/// A value that no other correction makes right.
fn wrong(exact: Value, stated: Value) -> Value {
    match exact {
        Value::Nothing => stated,
        Value::Face(_) | Value::Pixel(_) => Value::Nothing,
        Value::Number(_) => Value::Number(f64::NAN),
        Value::Vector(_) => Value::Vector(DVec3::NAN),
        Value::Flag(flag) => Value::Flag(!flag),
    }
}

/// Whether the camera would see a hit if no face lay between them: its front is turned to the camera, it is deeper than the
/// camera's plane, and it lands on a pixel.
fn would_be_seen(case: Case<'_>, place: Place) -> bool {
    let of = |quantity: Quantity| {
        let channel = Channel { sensor: place.sensor, item: quantity.into() };
        channel.at(case.truth.answers(), place)
    };
    let is_more =
        |quantity: Quantity, least: f64| matches!(of(quantity), Value::Number(number) if number > least);
    is_more(Quantity::CosView, 0.0)
        && is_more(Quantity::CameraDepth, case.truth.scene().camera().sensor.focal_length)
        && case.truth.visibility(place).1.is_some()
}

/// The number of a ray by which a recording may be cut; `None` without a hit.
pub(crate) fn cut_number(case: Case<'_>, by: CutBy, place: Place) -> Option<f64> {
    let map = case.truth.answers().map(place.sensor);
    let length = |image: &Option<raypencil_scene::Image<raypencil_scene::Maybe<f64>>>| {
        image.as_ref().and_then(|image| image.at(place.i, place.j).get())
    };
    match by {
        CutBy::Range | CutBy::RangeOrDepth => length(&map.range),
        CutBy::Depth => length(&map.depth),
        CutBy::Row => Some(f64::from(place.j)),
        CutBy::Column => Some(f64::from(place.i)),
    }
}

/// Whether a stated length is a multiple of a quantum, and the one that the exact length is rounded to.
pub(crate) fn is_rounded(storage: Storage, stated: f64, exact: f64, quantum: f64, down: bool) -> bool {
    let slack = storage.ulp(stated) + FEW_ROUNDINGS * exact.abs();
    let multiple = (stated / quantum).round() * quantum;
    let error = exact - stated;
    let is_next =
        if down { (-slack..quantum + slack).contains(&error) } else { error.abs() <= 0.5 * quantum + slack };
    (stated - multiple).abs() <= slack && is_next
}

/// What a z-buffer holds for a depth: linear in its reciprocal, `low` and 1 at these depths, which may be infinite.
pub(crate) fn z_buffer(depth: f64, low: f64, [low_at, one_at]: [f64; 2]) -> f64 {
    low + (1.0 - low) * ((1.0 / low_at - 1.0 / depth) / (1.0 / low_at - 1.0 / one_at))
}

/// How far a number of a z-buffer may be from what it should be: a program computes it in a few steps of its own arithmetic, of numbers
/// up to 1. Tuned.
pub(crate) fn z_buffer_slack(storage: Storage) -> f64 {
    4.0 * storage.ulp(1.0).max(f64::EPSILON)
}

/// Whether a stated length is a number of half precision, and the one that the exact length is rounded to.
pub(crate) fn is_half(stated: f64, exact: f64) -> bool {
    let ulp = Storage::F16.ulp(stated);
    (stated / ulp).fract() == 0.0 && (stated - exact).abs() <= 0.5 * ulp * (1.0 + f64::EPSILON)
}

/// Whether a cell beyond a cut has what stands there.
pub(crate) fn holds(
    case: Case<'_>,
    channel: Channel,
    place: Place,
    stated: Value,
    (by, is_above, held): (CutBy, bool, Held),
) -> bool {
    let is_flux = matches!(channel.item.quantity, Quantity::PencilFlux | Quantity::PixelFlux);
    match held {
        Held::NoHit => match stated {
            Value::Nothing | Value::Flag(false) => true,
            Value::Number(number) => is_flux && number == 0.0,
            _ => false,
        },
        Held::Constant(constant) => is_constant(stated, constant),
        Held::Neighbour => beside(case, place, by, is_above)
            .is_some_and(|place| channel.at(&case.recorded.answers, place) == stated),
        Held::Anything => true,
    }
}

/// Whether each number of a value is this one.
fn is_constant(value: Value, constant: f64) -> bool {
    match value {
        Value::Nothing => false,
        Value::Face(face) => f64::from(face.0) == constant,
        Value::Number(number) => number == constant,
        Value::Vector(vector) => vector.to_array().iter().all(|one| *one == constant),
        Value::Flag(flag) => f64::from(u8::from(flag)) == constant,
        Value::Pixel(pixel) => f64::from(pixel.i) == constant && f64::from(pixel.j) == constant,
    }
}

/// The cell on the other side of a cut that a line next to it repeats.
fn beside(case: Case<'_>, place: Place, by: CutBy, is_above: bool) -> Option<Place> {
    let (width, height) = case.truth.scene().size(place.sensor)?;
    let step = if is_above { -1 } else { 1 };
    let Place { i, j, .. } = place;
    Some(match by {
        CutBy::Column => Place { i: i.checked_add_signed(step).filter(|i| *i < width)?, ..place },
        _ => Place { j: j.checked_add_signed(step).filter(|j| *j < height)?, ..place },
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_rounded_down_lies_below_the_truth() {
        let is = |stated: f64, exact: f64, down: bool| is_rounded(Storage::F64, stated, exact, 0.125, down);
        // 1.25 is a multiple of an eighth: down from anything up to 1.375, nearest up to a sixteenth away.
        for (exact, is_down, is_nearest) in [
            (1.25, true, true),
            (1.3, true, true),
            (1.37, true, false),
            (1.38, false, false),
            (1.2, false, true),
            (1.1, false, false),
        ] {
            assert_eq!((is(1.25, exact, true), is(1.25, exact, false)), (is_down, is_nearest), "{exact}");
        }
        assert!(!is(1.26, 1.27, true) && !is(1.26, 1.26, false));
    }

    #[test]
    fn without_a_shadow_test_a_hidden_pencil_has_any_flux_but_a_negative_one() {
        let bench = crate::it::candidates::pyramids();
        let sensors = [0, 1].map(SensorId::Beam);
        let case = Case { truth: &bench.truth, recorded: &bench.exact, sensors: &sensors, tolerance: 1e-9 };
        let cells = (0..4).flat_map(|j| (0..48).map(move |i| (i, j)));
        let mut places =
            sensors.iter().flat_map(|&sensor| cells.clone().map(move |(i, j)| Place { sensor, i, j }));
        let is_hidden = |place: &Place| would_be_seen(case, *place) && !bench.truth.visibility(*place).0;
        let place = places.find(is_hidden).expect("a hidden hit");
        let flux = Channel { sensor: place.sensor, item: Quantity::PencilFlux.into() };
        let made_right = |stated: f64| {
            let value = foretold(Mistake::NoShadowTest, case, flux, place, Value::Number(stated));
            value == flux.at(bench.truth.answers(), place)
        };
        assert!(made_right(0.0) && made_right(1e-9) && !made_right(-1e-9));
    }
}
