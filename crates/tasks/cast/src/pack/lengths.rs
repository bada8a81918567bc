//! Lengths of arrays that are a constant factor or a constant length off: numbers that are found from a trial.

use glam::DVec3;
use raypencil_referee::ExactCast;
use raypencil_scene::{CastRay, Sides};

use super::clouds::fit::{median, rounded};
use super::mistakes::{Extra, Group};
use super::trial::Trial;

/// Rays from which a number is found, at least: of fewer, a number fits whatever is wrong.
const MIN_FITTED: usize = 12;

/// The same, at most.
const MAX_FITTED: usize = 200;

/// A length of a ray without the mistake: of the ray's own length by the stated one.
type Undone = fn(length: f64, by: f64) -> f64;

/// The factor and the length by which most rays are off, with few decimals and with more.
pub(super) fn lengths(trial: &Trial, exact: &ExactCast<'_>, sides: Sides) -> Vec<Extra<'static>> {
    let pair = |k: usize| -> Option<[f64; 2]> {
        let ray = &trial.rays[k];
        let stated = match (&trial.stated.t, &trial.stated.range) {
            (Some(t), _) => t[k] * ray.direction.length(),
            (None, Some(range)) => range[k],
            (None, None) => return None,
        };
        let face = *exact.reading(ray, sides).hit()?.first()?;
        let length = exact.values(ray, face)?.range.double;
        (stated.is_finite() && length > 0.0).then_some([stated, length])
    };
    let every = trial.rays.len().div_ceil(MAX_FITTED).max(1);
    let pairs: Vec<[f64; 2]> = (0..trial.rays.len()).step_by(every).filter_map(pair).collect();
    if pairs.len() < MIN_FITTED {
        return Vec::new();
    }
    let found =
        |of: fn(&[f64; 2]) -> f64| median(pairs.iter().map(of).collect()).map_or_else(Vec::new, rounded);
    let mut list = Vec::new();
    // Points may follow the lengths, or be right.
    let mut add = |words: String, by: f64, undone: Undone, group: Group| {
        for with_points in [true, false] {
            let undo = move |trial: &mut Trial| undo(trial, by, undone, with_points);
            list.push(Extra { words: words.clone(), undo: Box::new(undo), is_common: false, group });
        }
    };
    for by in found(|[stated, exact]| stated - exact) {
        let way = if by > 0.0 { "long" } else { "short" };
        add(format!("lengths are {} too {way}", by.abs()), by, |length, by| length - by, Group::Others);
    }
    for by in found(|[stated, exact]| stated / exact).into_iter().filter(|by| *by > 0.0 && *by != 1.0) {
        add(format!("lengths are {by} times what they are"), by, |length, by| length / by, Group::Factors);
    }
    list
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
