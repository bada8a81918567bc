//! Values of a recording that are near enough after some corrections, by what its file rounds away.

use raypencil_files::Storage;
use raypencil_scene::Place;

use crate::agree::{is_near, of_number};
use crate::case::Case;
use crate::channel::{Channel, Value};
use crate::correction::{Correction, before_rounding};

/// Whether the value that some corrections make is near: what the file rounds grows and shrinks with the number.
pub(crate) fn is_near_after(
    case: Case<'_>,
    channel: Channel,
    place: Place,
    corrections: &[&Correction],
    [value, exact]: [Value; 2],
) -> bool {
    let (Value::Number(number), Value::Number(own)) = (value, exact) else {
        return is_near(case, channel, place, value, exact);
    };
    let near = |allowed: [f64; 2]| {
        let slack = of_number(case, channel, own);
        (allowed[0] - slack..=allowed[1] + slack).contains(&own)
    };
    let rounded = || before_rounding(case, channel, place, corrections, 1.0);
    match case.recorded.storage.get(&(channel.sensor, channel.item)) {
        // A whole step, where half of it is rounded away; and the smallest numbers of half precision have fewer digits than its tolerance
        // takes for granted.
        Some(Storage::Steps(_) | Storage::F16) => near([number; 2]) || rounded().is_some_and(near),
        _ => near([number; 2]),
    }
}
