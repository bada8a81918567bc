//! Limits and steps of a sensor that a simulator has in another way: its longest and shortest range, what it tells of misses, the step of
//! its numbers.

use glam::DVec3;
use raypencil_referee::ExactCast;
use raypencil_scene::{CastRay, Reading, Sides};

use super::fit::{median, rounded};
use super::list::{List, along_of};
use crate::pack::steps::{self, MIN_FITTED, is_multiple, steps_of_ten, steps_of_two};
use crate::pack::trial::{CloudPart, Trial};

/// Rays without a point that are looked at, at most.
const MAX_MISSING: usize = 400;

/// Roundings of a length that was computed and compared with another.
const ROUNDINGS: f64 = 16.0;

/// Steps of numbers: parts of these powers of ten, and negative powers of two.
const POWERS_OF_TEN: std::ops::RangeInclusive<i32> = -8..=0;
const POWERS_OF_TWO: std::ops::RangeInclusive<i32> = 1..=14;

/// Length of a point along its ray, and how far storing and rounding may have moved it; `None` without a point.
fn length(trial: &Trial, cloud: &CloudPart, k: usize) -> Option<[f64; 2]> {
    let (point, error) = cloud.point(k);
    let ray = &trial.rays[k];
    let from = (point - ray.origin).length();
    let of_rounding = ROUNDINGS * trial.precision.unit_roundoff * (from + ray.origin.length());
    from.is_finite().then_some([from, error + of_rounding])
}

/// The number with the fewest decimals from `low` to below `high`.
fn shortest(low: f64, high: f64) -> Option<f64> {
    (0..=7).find_map(|decimals| {
        let ten = libm::pow(10.0, f64::from(decimals));
        let number = libm::ceil(low * ten) / ten;
        (low <= number && number < high).then_some(number)
    })
}

/// The longest range of a sensor in words, without the rounding of its rays' directions.
fn longest_words(range: f64) -> String {
    match range.is_finite() {
        true => format!("the sensor's longest range is {}", (range * 1e9).round() / 1e9),
        false => "the sensor has no longest range".into(),
    }
}

/// Ranges at which a simulator ends: what it tells of no surface, and of none beyond them.
pub(super) fn of_ranges<'a>(list: &mut List<'a>, trial: &Trial, exact: &'a ExactCast<'a>, sides: Sides) {
    let Some(cloud) = &trial.cloud else { return };
    of_misses(list, trial, cloud, exact, sides);
    let lengths = || (0..trial.rays.len()).filter_map(|k| Some(length(trial, cloud, k)?[0]));
    let (nearest, farthest) = (lengths().fold(f64::INFINITY, f64::min), lengths().fold(0.0, f64::max));
    if lengths().count() < MIN_FITTED {
        return;
    }
    // Rays of no length stand for returns that are none.
    let is_missing = |k: &usize| !cloud.raw[*k].is_finite() && trial.rays[*k].t_max > 0.0;
    let range = |k: usize| {
        let endless = CastRay { t_max: f64::INFINITY, t_blind: 0.0, ..trial.rays[k] };
        let face = *exact.first(&endless, sides).first()?;
        Some(exact.meeting(&endless, face)?.range().double)
    };
    let all: Vec<usize> = (0..trial.rays.len()).filter(is_missing).collect();
    let every = all.len().div_ceil(MAX_MISSING).max(1);
    let missing: Vec<f64> = all.into_iter().step_by(every).filter_map(range).collect();
    let asked = |of: fn(&CastRay) -> f64, ray: &CastRay| of(ray) * ray.direction.length();
    let longest = trial.rays.iter().map(|ray| asked(|ray| ray.t_max, ray)).fold(0.0, f64::max);
    let shortest_asked = trial.rays.iter().map(|ray| asked(|ray| ray.t_blind, ray)).fold(0.0, f64::max);
    let told_shortest = (shortest_asked * 1e9).round() / 1e9;
    let beyond = missing.iter().copied().filter(|range| *range > farthest).fold(f64::INFINITY, f64::min);
    let has_more = |from: f64| missing.iter().filter(|range| **range >= from).count() >= MIN_FITTED;
    if beyond.is_finite()
        && has_more(beyond)
        && (farthest > longest || beyond <= longest)
        && let Some(by) = shortest(farthest, beyond)
    {
        let words = format!(
            "points end at {by}, or at any distance from {farthest:.4} to {beyond:.4}: {}",
            longest_words(longest)
        );
        list.add(words, true, move |trial| {
            for ray in trial.rays.iter_mut().filter(|ray| ray.t_max > 0.0) {
                ray.t_max = by / ray.direction.length();
                ray.t_blind = ray.t_blind.min(ray.t_max);
            }
        });
    }
    let before = missing.iter().copied().filter(|range| *range < nearest).fold(0.0, f64::max);
    let has_nearer = missing.iter().filter(|range| **range <= before).count() >= MIN_FITTED;
    if has_nearer
        && before > shortest_asked
        && let Some(by) = shortest(before * (1.0 + f64::EPSILON), nearest)
    {
        let words = format!(
            "points begin at {by}, or at any distance from {before:.4} to {nearest:.4}: the sensor's shortest range is {told_shortest}"
        );
        list.add(words, true, move |trial| {
            for ray in trial.rays.iter_mut().filter(|ray| ray.t_max > 0.0) {
                ray.t_blind = (by / ray.direction.length()).min(ray.t_max);
            }
        });
    }
}

/// Misses that have a point at one distance.
fn of_misses<'a>(list: &mut List<'a>, trial: &Trial, cloud: &CloudPart, exact: &ExactCast<'_>, sides: Sides) {
    // Points where nothing is hit.
    let every = trial.rays.len().div_ceil(MAX_MISSING).max(1);
    let invented = (0..trial.rays.len()).step_by(every).filter_map(|k| {
        let [from, _] = length(trial, cloud, k)?;
        let is_empty = trial.rays[k].t_max == 0.0;
        (!is_empty && exact.reading(&trial.rays[k], sides) == Reading::Miss).then_some(from)
    });
    let invented: Vec<f64> = invented.collect();
    if invented.len() < MIN_FITTED {
        return;
    }
    let longest = trial.rays.iter().map(|ray| ray.t_max * ray.direction.length()).fold(0.0, f64::max);
    for by in median(invented).map_or_else(Vec::new, rounded).into_iter().filter(|by| *by > 0.0) {
        let is_nearer = by < longest * (1.0 - 1e-9);
        let words = match is_nearer {
            false if by <= longest * (1.0 + 1e-9) => {
                format!("rays that meet nothing have a point at the longest range, {by}: they have none")
            }
            false => format!("rays that meet nothing have a point at {by}: they have none"),
            true => format!(
                "rays that meet nothing before {by} have a point there: they have none, and {}",
                longest_words(longest)
            ),
        };
        list.add(words, true, move |trial| {
            let Some(cloud) = &trial.cloud else { return };
            let is_there: Vec<bool> = (0..trial.rays.len())
                .map(|k| length(trial, cloud, k).is_some_and(|[from, error]| (from - by).abs() <= error))
                .collect();
            if let Some(cloud) = &mut trial.cloud {
                let at = cloud.raw.iter_mut().zip(&is_there).filter(|(_, is_there)| **is_there);
                at.for_each(|(point, _)| *point = DVec3::NAN);
            }
            if let Some(ranges) = &mut trial.stated.range {
                let at = ranges.iter_mut().zip(&is_there).filter(|(_, is_there)| **is_there);
                at.for_each(|(range, _)| *range = f64::NAN);
            }
            if is_nearer {
                for ray in &mut trial.rays {
                    ray.t_max = ray.t_max.min(by / ray.direction.length());
                    ray.t_blind = ray.t_blind.min(ray.t_max);
                }
            }
        });
    }
}

/// The largest step of which nearly all numbers are multiples, each within its error, if that is no chance.
fn step(numbers: &[[f64; 2]]) -> Option<f64> {
    let all = steps_of_ten(POWERS_OF_TEN).chain(steps_of_two(POWERS_OF_TWO));
    steps::step(numbers, &all.collect::<Vec<f64>>())
}

/// Numbers that are multiples of a step: lengths, the field `range`, and coordinates. `pairs` are indices with exact ranges.
pub(super) fn of_steps(list: &mut List<'_>, trial: &Trial, pairs: &[(usize, f64)]) {
    let Some(cloud) = &trial.cloud else { return };
    let lengths: Vec<([f64; 2], f64)> =
        pairs.iter().filter_map(|(k, exact)| Some((length(trial, cloud, *k)?, *exact))).collect();
    let numbers: Vec<[f64; 2]> = lengths.iter().map(|(length, _)| *length).collect();
    if let Some(step) = step(&numbers) {
        let off = median(lengths.iter().map(|([length, _], exact)| length - exact).collect());
        // Numbers that are cut are half a step too short in the middle.
        let is_cut = off.is_some_and(|off| off < -0.25 * step);
        let words = match is_cut {
            true => format!("ranges are cut to multiples of {step}"),
            false => format!("ranges are rounded to multiples of {step}"),
        };
        list.add(words, false, move |trial| {
            let is_of_step = multiples(trial, step);
            if is_cut {
                along_of(trial, |k| is_of_step[k], |_, _, length| length + 0.5 * step);
            }
            if let Some(cloud) = &mut trial.cloud {
                widen(&mut cloud.error, &is_of_step, 0.5 * step);
            }
            undo_in_field(trial, step, is_cut);
        });
    }
    if let (Some(ranges), Some(errors)) = (&trial.stated.range, &trial.stated.stored.range) {
        let some: Vec<(f64, f64, f64)> =
            pairs.iter().map(|(k, exact)| (ranges[*k], errors[*k], *exact)).collect();
        let numbers: Vec<[f64; 2]> = some
            .iter()
            .filter(|(range, ..)| range.is_finite())
            .map(|(range, error, _)| [*range, *error])
            .collect();
        if let Some(step) = step(&numbers) {
            let off = median(some.iter().map(|(range, _, exact)| range - exact).collect());
            let is_cut = off.is_some_and(|off| off < -0.25 * step);
            let how = if is_cut { "cut" } else { "rounded" };
            list.add(format!("the field range is {how} to multiples of {step}"), false, move |trial| {
                undo_in_field(trial, step, is_cut);
            });
        }
    }
    let coordinates: Vec<[f64; 2]> = pairs
        .iter()
        .flat_map(|(k, _)| cloud.raw[*k].to_array().map(|part| [part, cloud.error[*k]]))
        .collect();
    if let Some(step) = step(&coordinates) {
        list.add(format!("x, y and z are rounded to multiples of {step}"), false, move |trial| {
            let Some(cloud) = &mut trial.cloud else { return };
            let is_of_step: Vec<bool> = cloud
                .raw
                .iter()
                .zip(&cloud.error)
                .map(|(point, error)| point.to_array().iter().all(|part| is_multiple(*part, *error, step)))
                .collect();
            // Half a step along each axis.
            widen(&mut cloud.error, &is_of_step, 0.5 * step * libm::sqrt(3.0));
            trial.allowance = step;
        });
    }
}

/// Which points stand at a multiple of a step along their rays.
fn multiples(trial: &Trial, step: f64) -> Vec<bool> {
    let of = |k: usize| {
        let [from, error] = length(trial, trial.cloud.as_ref()?, k)?;
        Some(is_multiple(from, error, step))
    };
    (0..trial.rays.len()).map(|k| of(k).unwrap_or(false)).collect()
}

/// Takes a step out of the field `range`, if there is one: a multiple may be off by half of it, after half of it is added where it was cut.
fn undo_in_field(trial: &mut Trial, step: f64, is_cut: bool) {
    if let (Some(ranges), Some(errors)) = (&mut trial.stated.range, &mut trial.stated.stored.range) {
        let is_of_step: Vec<bool> =
            ranges.iter().zip(&*errors).map(|(range, error)| is_multiple(*range, *error, step)).collect();
        if is_cut {
            shifted(ranges, &is_of_step, 0.5 * step);
        }
        widen(errors, &is_of_step, 0.5 * step);
    }
    trial.allowance = step;
}

fn shifted(numbers: &mut [f64], which: &[bool], by: f64) {
    numbers.iter_mut().zip(which).filter(|(_, which)| **which).for_each(|(number, _)| *number += by);
}

fn widen(errors: &mut [f64], which: &[bool], by: f64) {
    errors.iter_mut().zip(which).filter(|(_, which)| **which).for_each(|(error, _)| *error += by);
}
