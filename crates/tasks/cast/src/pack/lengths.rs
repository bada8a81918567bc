//! Lengths of arrays that are a constant factor or a constant length off: numbers that are found from a trial.

use glam::DVec3;
use raypencil_referee::ExactCast;
use raypencil_scene::{CastRay, Sides};

use super::clouds::fit::{median, rounded_to_all};
use super::mistakes::{Extra, Group};
use super::trial::Trial;

/// Rays from which a number is found, at least: of fewer, a number fits whatever is wrong.
const MIN_FITTED: usize = 12;

/// The same, at most.
const MAX_FITTED: usize = 200;

/// A length of a ray without the mistake: of the ray's own length by the stated one.
type Undone = fn(length: f64, by: f64) -> f64;

/// What most rays are off by, with few decimals and with more. `right` is what no ray is off by.
fn found(pairs: &[[f64; 2]], of: fn(&[f64; 2]) -> f64, right: f64) -> Vec<f64> {
    let Some(middle) = median(pairs.iter().map(of).collect()) else { return Vec::new() };
    // Few rays are off alike where no number explains them.
    let is_alike = |pair: &&[f64; 2]| (of(pair) - middle).abs() <= 0.5 * (middle - right).abs();
    match 2 * pairs.iter().filter(is_alike).count() >= pairs.len() && middle != right {
        true => rounded_to_all(middle),
        false => Vec::new(),
    }
}

/// The factor and the length by which most rays are off.
pub(super) fn lengths(trial: &Trial, exact: &ExactCast<'_>, sides: Sides) -> Vec<Extra<'static>> {
    let every = trial.rays.len().div_ceil(MAX_FITTED).max(1);
    // A ray, with its exact t and range.
    let known = |k: usize| -> Option<(usize, [f64; 2])> {
        let face = *exact.reading(&trial.rays[k], sides).hit()?.first()?;
        let hit = exact.meeting(&trial.rays[k], face)?;
        let range = hit.range().double;
        (range > 0.0).then(|| (k, [hit.t().double, range]))
    };
    let known: Vec<(usize, [f64; 2])> = (0..trial.rays.len()).step_by(every).filter_map(known).collect();
    let pairs_of = |stated: &dyn Fn(usize) -> f64, which: usize| -> Vec<[f64; 2]> {
        let pairs = known.iter().map(|(k, exact)| [stated(*k), exact[which]]);
        pairs.filter(|[stated, _]| stated.is_finite()).collect()
    };
    let (t, range) = (&trial.stated.t, &trial.stated.range);
    let pairs = match (t, range) {
        (Some(t), _) => pairs_of(&|k| t[k] * trial.rays[k].direction.length(), 1),
        (None, Some(range)) => pairs_of(&|k| range[k], 1),
        (None, None) => return Vec::new(),
    };
    if pairs.len() < MIN_FITTED {
        return Vec::new();
    }
    let mut list = Vec::new();
    for (by, is_factor) in numbers_of(&pairs) {
        let (words, undone, group): (String, Undone, Group) = match is_factor {
            true => {
                (format!("lengths are {by} times what they are"), |length, by| length / by, Group::Factors)
            }
            false => {
                let way = if by > 0.0 { "long" } else { "short" };
                (format!("lengths are {} too {way}", by.abs()), |length, by| length - by, Group::Others)
            }
        };
        // Points may follow the lengths, or be right.
        for with_points in [true, false] {
            let undo = move |trial: &mut Trial| undo(trial, by, undone, with_points);
            list.push(Extra { words: words.clone(), undo: Box::new(undo), is_common: false, group });
        }
    }
    // One of two arrays, or t of directions that are not equally long.
    if let Some(t) = t {
        let pairs = pairs_of(&|k| t[k], 0);
        for by in found(&pairs, |[stated, exact]| stated - exact, 0.0) {
            let way = if by > 0.0 { "large" } else { "small" };
            list.push(of_t(format!("t is {} too {way}", by.abs()), Group::Others, move |t, _| *t -= by));
        }
        for by in factors(&pairs).into_iter().filter(|_| range.is_some()) {
            list.push(of_t(format!("t is {by} times what it is"), Group::Factors, move |t, error| {
                (*t, *error) = (*t / by, *error / by);
            }));
        }
    }
    if let (Some(_), Some(range)) = (t, range) {
        let pairs = pairs_of(&|k| range[k], 1);
        for by in found(&pairs, |[stated, exact]| stated - exact, 0.0) {
            let way = if by > 0.0 { "long" } else { "short" };
            let words = format!("the range is {} too {way}", by.abs());
            list.push(of_range(words, Group::Others, move |range, _| *range -= by));
        }
        for by in factors(&pairs) {
            list.push(of_range(
                format!("the range is {by} times what it is"),
                Group::Factors,
                move |range, error| {
                    (*range, *error) = (*range / by, *error / by);
                },
            ));
        }
    }
    if t.is_some() && trial.stated.point.is_some() {
        list.extend(UNITS.into_iter().flat_map(|(unit, by)| beside_t(unit, by, range.is_some())));
    }
    list
}

/// Units of ranges and points beside a right t: where mesh and rays are in that unit both, t is the same.
const UNITS: [(&str, f64); 4] = [
    ("thousandths of the mesh's unit", 1e-3),
    ("hundredths of the mesh's unit", 1e-2),
    ("thousands of the mesh's unit", 1e3),
    ("feet", 0.3048),
];

/// Points in another unit, and ranges with them if there are any; or points alone.
fn beside_t(unit: &str, by: f64, has_range: bool) -> impl Iterator<Item = Extra<'static>> {
    let with_range = has_range.then_some((format!("ranges and points are in {unit}, and t is right"), true));
    let list = with_range.into_iter().chain([(format!("points are in {unit}"), false)]);
    list.map(move |(words, is_range)| {
        let undo = move |trial: &mut Trial| {
            let stated = &mut trial.stated;
            stated.point.iter_mut().flatten().for_each(|point| *point *= by);
            stated.stored.point.iter_mut().flatten().for_each(|error| *error *= by);
            if is_range {
                stated.range.iter_mut().flatten().for_each(|range| *range *= by);
                stated.stored.range.iter_mut().flatten().for_each(|error| *error *= by);
            }
        };
        Extra { words, undo: Box::new(undo), is_common: false, group: Group::Factors }
    })
}

/// Factors and lengths by which most rays are off, in pairs of the stated and the exact one, and whether each is a factor. Those of few decimals come first, and of
/// these the factors: where all lengths are equal, either explains the other.
pub(super) fn numbers_of(pairs: &[[f64; 2]]) -> Vec<(f64, bool)> {
    let offsets = found(pairs, |[stated, exact]| stated - exact, 0.0).into_iter().map(|by| (by, false));
    let mut all: Vec<(f64, bool)> = factors(pairs).into_iter().map(|by| (by, true)).chain(offsets).collect();
    let decimals = |by: f64| by.to_string().split_once('.').map_or(0, |(_, decimals)| decimals.len());
    all.sort_by_key(|(by, _)| decimals(*by));
    all
}

/// Factors by which most rays are off.
fn factors(pairs: &[[f64; 2]]) -> Vec<f64> {
    let all = found(pairs, |[stated, exact]| stated / exact, 1.0).into_iter();
    all.filter(|by| *by > 0.0 && *by != 1.0).collect()
}

/// A mistake of t alone: `undo` changes a finite one, and how far storing may have moved it.
fn of_t(words: String, group: Group, undo: impl Fn(&mut f64, &mut f64) + 'static) -> Extra<'static> {
    let undo = move |trial: &mut Trial| {
        let stated = &mut trial.stated;
        each(&mut stated.t, &mut stated.stored.t, &undo);
    };
    Extra { words, undo: Box::new(undo), is_common: false, group }
}

/// The same of the range alone.
fn of_range(words: String, group: Group, undo: impl Fn(&mut f64, &mut f64) + 'static) -> Extra<'static> {
    let undo = move |trial: &mut Trial| {
        let stated = &mut trial.stated;
        each(&mut stated.range, &mut stated.stored.range, &undo);
    };
    Extra { words, undo: Box::new(undo), is_common: false, group }
}

fn each(numbers: &mut Option<Vec<f64>>, errors: &mut Option<Vec<f64>>, undo: &dyn Fn(&mut f64, &mut f64)) {
    for (k, number) in numbers.iter_mut().flatten().enumerate().filter(|(_, number)| number.is_finite()) {
        let mut none = 0.0;
        undo(number, errors.as_mut().map_or(&mut none, |errors| &mut errors[k]));
    }
}

fn undo(trial: &mut Trial, by: f64, undone: Undone, with_points: bool) {
    let rays: &[CastRay] = &trial.rays;
    let stated = &mut trial.stated;
    for (t, ray) in stated.t.iter_mut().flatten().zip(rays).filter(|(t, _)| t.is_finite()) {
        let size = ray.direction.length();
        *t = undone(*t * size, by) / size;
    }
    stated
        .range
        .iter_mut()
        .flatten()
        .filter(|range| range.is_finite())
        .for_each(|range| *range = undone(*range, by));
    // What storing did changes as the difference of two lengths does.
    let slope = undone(1.0, by) - undone(0.0, by);
    let stored = &mut stated.stored;
    let of_points = stored.point.as_mut().filter(|_| with_points);
    let errors = [stored.t.as_mut(), stored.range.as_mut(), of_points];
    errors.into_iter().flatten().flatten().for_each(|error| *error *= slope);
    if with_points {
        for (point, ray) in stated.point.iter_mut().flatten().zip(rays).filter(|(point, _)| point.is_finite())
        {
            let way: DVec3 = *point - ray.origin;
            *point = ray.origin + way * (undone(way.length(), by) / way.length());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_is_found_if_half_of_the_rays_are_off_by_half_of_it_to_once_and_a_half() {
        let found_of = |offsets: &[f64]| {
            let pairs: Vec<[f64; 2]> = offsets.iter().map(|off| [8.0 + off, 8.0]).collect();
            found(&pairs, |[stated, exact]| stated - exact, 0.0)
        };
        // The one in the middle is off by 1. Exactly half of it is enough.
        assert_eq!(found_of(&[0.5, 0.5, 0.5, 1.0, 3.0, 3.0]), [1.0]);
        assert_eq!(found_of(&[0.5, 0.5, 1.0, 1.5, 3.0]), [1.0]);
        // Two of five are fewer than half, and two of four are not.
        assert_eq!(found_of(&[0.25, 0.5, 1.0, 3.0, 3.0]), [0.0; 0]);
        assert_eq!(found_of(&[0.25, 0.5, 1.0, 3.0]), [1.0]);
        assert_eq!(found_of(&[0.0; 5]), [0.0; 0]);
    }
}
