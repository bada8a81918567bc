//! Cuts: lines of cells that are lost, and hits that are lost beyond a length. Found by an interval search over all rays.

use std::collections::BTreeMap;

use crate::case::Case;
use crate::channel::{Channel, Value};
use crate::correction::Correction;
use crate::forward::{cut_number, holds};
use crate::mistake::{CutBy, Held, Mistake};
use crate::numbers::plainest_between;
use crate::sample::{Key, WrongRays, key};
use raypencil_scene::{Place, SensorId};

/// Share of the wrong rays that may be on the other side of a cut, or right on its own: one in so many.
const OFF_ONE_IN: usize = 50;

/// Hits that are right, at least: else nothing shows where a cut is.
const MIN_RIGHT_HITS: usize = 12;

/// Lines that may be called wrong without saying what stands in them.
const MAX_LINES_OF_ANYTHING: u32 = 1;

/// A ray that hits something: the number by which it may be cut, whether it is wrong, and its true face.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Ray {
    pub(crate) number: f64,
    pub(crate) is_wrong: bool,
    pub(crate) face: u32,
}

/// The place between numbers that separates wrong rays from right ones.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Split {
    pub(crate) is_above: bool,
    /// The largest number below it, and the smallest above.
    pub(crate) between: [f64; 2],
    /// Rays on the wrong side.
    pub(crate) off: usize,
}

/// Separates wrong rays from right ones by their number: those beyond it are wrong, and hardly any other. A cut that
/// runs between faces is none: these faces are wrong, and nobody knows why.
pub(crate) fn split(rays: &mut [Ray], is_above: bool) -> Option<Split> {
    rays.sort_by(|a, b| if is_above { b.number.total_cmp(&a.number) } else { a.number.total_cmp(&b.number) });
    let wrong = rays.iter().filter(|ray| ray.is_wrong).count();
    if wrong == 0 || rays.len() - wrong < MIN_RIGHT_HITS {
        return None;
    }
    // The rays beyond the cut come first. At the cut after `count` rays, `off` are on the wrong side.
    let (mut off, mut best) = (wrong, (usize::MAX, 0));
    for (index, ray) in rays.iter().enumerate() {
        off = if ray.is_wrong { off - 1 } else { off + 1 };
        let is_end = rays.get(index + 1).is_none_or(|next| next.number != ray.number);
        if is_end && off < best.0 {
            best = (off, index + 1);
        }
    }
    let (off, count) = best;
    if off * OFF_ONE_IN > wrong || count == rays.len() {
        return None;
    }
    let mut sides: BTreeMap<u32, [bool; 2]> = BTreeMap::new();
    for (index, ray) in rays.iter().enumerate() {
        sides.entry(ray.face).or_default()[usize::from(index < count)] = true;
    }
    let is_through_a_face = sides.values().any(|sides| sides[0] && sides[1]);
    let [inner, outer] = [rays[count].number, rays[count - 1].number];
    let between = if is_above { [inner, outer] } else { [outer, inner] };
    is_through_a_face.then_some(Split { is_above, between, off })
}

/// The rays of a sensor that hit something, by a number.
pub(crate) fn hits(
    case: Case<'_>,
    sensor: SensorId,
    wrong: &WrongRays,
    number: impl Fn(Place) -> Option<f64>,
) -> Vec<Ray> {
    let (width, height) = case.truth.scene().size(sensor).unwrap_or((0, 0));
    let faces = case.truth.answers().map(sensor).face.as_ref();
    let cells = (0..height).flat_map(|j| (0..width).map(move |i| Place { sensor, i, j }));
    cells
        .filter_map(|place| {
            let face = faces?.at(place.i, place.j).get()?.0;
            Some(Ray { number: number(place)?, is_wrong: wrong.of_hits.contains(&key(place)), face })
        })
        .collect()
}

/// Cuts that separate the wrong rays of a sensor from the others.
pub(crate) fn cuts(case: Case<'_>, wrong: &WrongRays) -> Vec<Correction> {
    let [sensor] = *case.sensors else { return Vec::new() };
    if wrong.of_hits.is_empty() {
        return Vec::new();
    }
    let lines = lines(case, sensor, wrong);
    let mut by_length = Vec::new();
    for by in [CutBy::Range, CutBy::Depth] {
        let mut rays = hits(case, sensor, wrong, |place| cut_number(case, by, place));
        for is_above in [true, false] {
            if let Some(Split { between: [low, high], off, .. }) = split(&mut rays, is_above) {
                by_length.push((by, is_above, low, high, off));
            }
        }
    }
    // What two numbers explain alike is explained by neither, unless it is a single line; but a range and the depth that goes with it
    // say the same, and it is said of both. If one of them leaves no ray on the wrong side, and the other does, it is that one.
    let is_single = lines.iter().any(|(_, _, _, lines)| *lines == 1);
    match *by_length.as_slice() {
        [(CutBy::Range, is_above, low, high, of_range), (CutBy::Depth, other, _, _, of_depth)]
            if is_above == other =>
        {
            match (of_range, of_depth) {
                (0, 0) => by_length = vec![(CutBy::RangeOrDepth, is_above, low, high, 0)],
                (0, _) => by_length.truncate(1),
                (_, 0) => by_length = by_length.split_off(1),
                _ => by_length.clear(),
            }
        }
        [_, _, ..] => by_length.clear(),
        _ => {}
    }
    let mut found = Vec::new();
    if by_length.is_empty() || is_single {
        for &(by, is_above, at, lines) in &lines {
            for held in held(case, sensor, wrong, (by, is_above)) {
                if held != Held::Anything || lines <= MAX_LINES_OF_ANYTHING {
                    found.push(Mistake::Cut { by, is_above, at, lines, held });
                }
            }
        }
    }
    if lines.is_empty() {
        for &(by, is_above, low, high, _) in &by_length {
            let held = held(case, sensor, wrong, (by, is_above));
            // A length that stands there is a range or a depth, and no matter of both.
            let is_told = |held: &Held| match held {
                Held::NoHit => true,
                Held::Constant(_) => by != CutBy::RangeOrDepth,
                Held::Neighbour | Held::Anything => false,
            };
            for held in held.into_iter().filter(is_told) {
                let at = match held {
                    // Clipped lengths say where.
                    Held::Constant(length) if (low..=high).contains(&length) => length,
                    _ => plainest_between(low, high),
                };
                found.push(Mistake::Cut { by, is_above, at, lines: 0, held });
            }
        }
    }
    found.into_iter().map(Correction::from).collect()
}

/// Rows or columns at the border that hold all wrong rays, and hardly a right hit.
fn lines(case: Case<'_>, sensor: SensorId, wrong: &WrongRays) -> Vec<(CutBy, bool, f64, u32)> {
    let Some((width, height)) = case.truth.scene().size(sensor) else { return Vec::new() };
    let mut found = Vec::new();
    for (by, count) in [(CutBy::Row, height), (CutBy::Column, width)] {
        let line = |&(_, j, i): &Key| if by == CutBy::Row { j } else { i };
        let all = wrong.of_hits.iter().map(line);
        let (Some(first), Some(last)) = (all.clone().min(), all.max()) else { continue };
        let mut rays = hits(case, sensor, wrong, |place| cut_number(case, by, place));
        for (is_above, at, lines) in [(true, first, count - first), (false, last, last + 1)] {
            let is_beyond = |ray: &&Ray| {
                if is_above { ray.number >= f64::from(at) } else { ray.number <= f64::from(at) }
            };
            let right = rays.iter().filter(is_beyond).filter(|ray| !ray.is_wrong).count();
            let is_border = 2 * lines <= count && right * OFF_ONE_IN <= wrong.of_hits.len();
            // Hits alone show whether the cut runs through a face.
            if is_border && split(&mut rays, is_above).is_some() {
                found.push((by, is_above, f64::from(at), lines));
            }
        }
    }
    found
}

/// What stands in the wrong cells: the plainest first.
fn held(case: Case<'_>, sensor: SensorId, wrong: &WrongRays, (by, is_above): (CutBy, bool)) -> Vec<Held> {
    let channels: Vec<Channel> = case.channels().into_iter().filter(|channel| channel.is_of_hit()).collect();
    let mut found = Vec::new();
    for channel in channels {
        let places = || wrong.of_hits.iter().map(|&(_, j, i)| Place { sensor, i, j });
        let stated = |place: Place| channel.at(&case.recorded.answers, place);
        let constant = places().find_map(|place| match stated(place) {
            Value::Number(number) => Some(number),
            Value::Vector(vector) => Some(vector.x),
            Value::Face(face) => Some(f64::from(face.0)),
            _ => None,
        });
        let all = [Some(Held::NoHit), constant.map(Held::Constant), Some(Held::Neighbour)];
        for held in all.into_iter().flatten() {
            let count = places()
                .filter(|place| {
                    let stated = stated(*place);
                    let is_right = stated == channel.at(case.truth.answers(), *place);
                    is_right || holds(case, channel, *place, stated, (by, is_above, held))
                })
                .count();
            if (wrong.of_hits.len() - count) * OFF_ONE_IN <= wrong.of_hits.len() && !found.contains(&held) {
                found.push(held);
            }
        }
    }
    found.push(Held::Anything);
    found
}

#[cfg(test)]
#[path = "../tests/unit/cuts.rs"]
mod tests;
