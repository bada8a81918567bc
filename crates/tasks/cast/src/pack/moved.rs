//! Errors of lengths that follow from another mesh or from other origins: what moves the corners of a face moves all points on it by one
//! rule, and what moves the mesh as a whole moves all faces by one rule. Rounding of each ray's own arithmetic follows no rule.

use std::collections::BTreeMap;

use glam::DVec3;
use raypencil_referee::ExactCast;
use raypencil_scene::Precision;

use super::clouds::fit::median;
use super::mistakes::{Extra, Group};
use super::steps::MIN_FITTED;
use super::trial::Trial;
use crate::comparison::CastValue;

/// Rays from which a shift is found, at most.
const MAX_FITTED: usize = 200;

/// Errors beyond so many medians are left out: such a ray meets another face, or has another fault.
const MEDIANS: f64 = 20.0;

/// Roundings of single precision that a right length may be off by, at most: a few of double precision.
const RIGHT: f64 = 1e-7;

/// What a rule leaves of the mean square of the errors, for each ray that is not needed to find the rule, at most. Errors
/// without a rule leave all of it, and of a dozen such rays never so little: chi squared of 12 is below 0.75 once in 10^7 times.
const MAX_LEFT: f64 = 1.0 / 16.0;

/// The same for a rule that is told with its numbers.
const MAX_LEFT_OF_SHIFT: f64 = 1e-4;

/// What is added to the diagonal of a fit, as a part of it: rays may leave some unknowns open.
const RIDGE: f64 = 1e-10;

/// Digits of a shift.
const DIGITS: std::ops::RangeInclusive<i32> = 1..=6;

/// A length that is off.
pub(super) struct Length {
    /// Index of its face.
    face: u32,
    /// Weights of the point on it.
    weights: [f64; 3],
    point: DVec3,
    /// The unit normal of the face.
    normal: DVec3,
    /// How far the stated point lies from the face's plane, along the normal.
    rise: f64,
    /// The rise that one rounding of single precision may give, u S.
    rounding: f64,
}

impl Length {
    /// The rise as a part of one rounding of single precision.
    pub(super) fn roundings(&self) -> f64 {
        (self.rise / self.rounding).abs()
    }
}

/// The lengths of some rays of a trial that are off: t or range.
pub(super) fn lengths_off(
    trial: &Trial,
    exact: &ExactCast<'_>,
    value: CastValue,
    rays: impl Iterator<Item = usize>,
) -> Vec<Length> {
    let of = |index: usize| {
        let ray = &trial.rays[index];
        let [stated, ..] = trial.stated.part(value, index).filter(|parts| parts[0].is_finite())?;
        let named = trial.stated.face.as_ref().and_then(|faces| faces[index]);
        let face = named.or_else(|| exact.reading(ray, trial.sides).hit().map(|faces| faces[0]))?;
        let hit = exact.meeting(ray, face)?;
        let vector =
            |parts: [raypencil_referee::Rounded; 3]| DVec3::from_array(parts.map(|part| part.double));
        let per_length = if value == CastValue::T { 1.0 } else { ray.direction.length().recip() };
        let normal = vector(hit.normal());
        let off = (stated - value.exact(&hit)[0]) * per_length;
        Some(Length {
            face: face.0,
            weights: hit.barycentric().map(|weight| weight.double),
            point: vector(hit.point()),
            normal,
            rise: off * normal.dot(ray.direction),
            rounding: exact.lateral_error(ray, Precision::F32) / 16.0,
        })
    };
    let mut all: Vec<Length> = rays.filter_map(of).filter(|length| length.rise.is_finite()).collect();
    // Lengths that are right, as those on faces along a shift, are no measure of the others.
    let is_off = |length: &&Length| length.roundings() > RIGHT;
    if let Some(middle) = median(all.iter().filter(is_off).map(|length| length.rise.abs()).collect()) {
        all.retain(|length| length.rise.abs() <= MEDIANS * middle);
    }
    all
}

/// The numbers of a linear rule that leaves the least squares.
fn fitted<const N: usize>(rows: &[([f64; N], f64)]) -> [f64; N] {
    let mut system = [[0.0; N]; N];
    let mut right = [0.0; N];
    for (row, number) in rows {
        for i in 0..N {
            right[i] += row[i] * number;
            (0..N).for_each(|j| system[i][j] += row[i] * row[j]);
        }
    }
    let ridge = RIDGE * (0..N).map(|i| system[i][i]).fold(f64::MIN_POSITIVE, f64::max);
    (0..N).for_each(|i| system[i][i] += ridge);
    for i in 0..N {
        for below in i + 1..N {
            let factor = system[below][i] / system[i][i];
            (i..N).for_each(|j| system[below][j] -= factor * system[i][j]);
            right[below] -= factor * right[i];
        }
    }
    let mut found = [0.0; N];
    for i in (0..N).rev() {
        let known: f64 = (i + 1..N).map(|j| system[i][j] * found[j]).sum();
        found[i] = (right[i] - known) / system[i][i];
    }
    found
}

/// The squares that a rule leaves.
fn left<const N: usize>(rows: &[([f64; N], f64)], rule: &[f64; N]) -> f64 {
    let of = |(row, number): &([f64; N], f64)| {
        let said: f64 = row.iter().zip(rule).map(|(part, by)| part * by).sum();
        (number - said) * (number - said)
    };
    rows.iter().map(of).sum()
}

/// What is left of the mean square, for each ray beyond those that find the rule; `None` if these are too few.
fn share_left(left: f64, free: usize, lengths: &[Length]) -> Option<f64> {
    let all: f64 = lengths.iter().map(|length| length.rise * length.rise).sum();
    (free >= MIN_FITTED && all > 0.0).then(|| left / free as f64 / (all / lengths.len() as f64))
}

/// Whether lengths are off by a rule: each face has its corners elsewhere, or the whole mesh is moved, turned or scaled.
/// `None`: too few rays share a face to tell.
pub(super) fn follow_a_rule(lengths: &[Length]) -> Option<bool> {
    let mut faces: BTreeMap<u32, Vec<([f64; 3], f64)>> = BTreeMap::new();
    lengths.iter().for_each(|one| faces.entry(one.face).or_default().push((one.weights, one.rise)));
    let of_faces: f64 = faces.values().map(|rows| left(rows, &fitted(rows))).sum();
    let free = faces.values().map(|rows| rows.len().saturating_sub(3)).sum();
    let row = |one: &Length| {
        let ([x, y, z], turn) = (one.normal.to_array(), one.point.cross(one.normal));
        ([x, y, z, turn.x, turn.y, turn.z, one.normal.dot(one.point)], one.rise)
    };
    let rows: Vec<([f64; 7], f64)> = lengths.iter().map(row).collect();
    let of_mesh = share_left(left(&rows, &fitted(&rows)), rows.len().saturating_sub(7), lengths);
    let is_rule = |share: f64| share <= MAX_LEFT;
    let of_faces = share_left(of_faces, free, lengths).map(is_rule);
    if of_mesh.is_some_and(is_rule) { Some(true) } else { of_faces }
}

/// A vector with so many digits of its largest part.
fn with_digits(vector: DVec3, digits: i32) -> DVec3 {
    let power = libm::floor(libm::log10(vector.abs().max_element())) as i32 + 1 - digits;
    // Parsed, so that it is the double nearest to a few decimals.
    let part = |part: f64| {
        let units = (part / libm::pow(10.0, f64::from(power))).round();
        format!("{units}e{power}").parse::<f64>().unwrap_or(f64::NAN)
    };
    DVec3::from_array(vector.to_array().map(part))
}

/// A shift of the mesh against the rays, if lengths are off by one. Points tell whether the mesh or the origins are moved.
pub(super) fn shifts(trial: &Trial, exact: &ExactCast<'_>) -> Vec<Extra<'static>> {
    let every = trial.rays.len().div_ceil(MAX_FITTED).max(1);
    let value = if trial.stated.t.is_some() { CastValue::T } else { CastValue::Range };
    let lengths = lengths_off(trial, exact, value, (0..trial.rays.len()).step_by(every));
    let rows: Vec<([f64; 3], f64)> =
        lengths.iter().map(|length| (length.normal.to_array(), length.rise)).collect();
    let rule = fitted(&rows);
    let share = share_left(left(&rows, &rule), rows.len().saturating_sub(3), &lengths);
    if share.is_none_or(|share| share > MAX_LEFT_OF_SHIFT) {
        return Vec::new();
    }
    let mut found: Vec<DVec3> = Vec::new();
    for digits in DIGITS {
        let shift = with_digits(DVec3::from_array(rule), digits);
        if shift.is_finite() && shift != DVec3::ZERO && !found.contains(&shift) {
            found.push(shift);
        }
    }
    let has_points = trial.stated.point.is_some();
    let words = |of: &str, by: DVec3| {
        let [x, y, z] = (by + DVec3::ZERO).to_array();
        format!("{of} shifted by ({x}, {y}, {z})")
    };
    let extra = |words: String, shift: DVec3, of_points: DVec3| {
        let undo = move |trial: &mut Trial| {
            trial.rays.iter_mut().for_each(|ray| ray.origin -= shift);
            trial.stated.point.iter_mut().flatten().for_each(|point| *point -= of_points);
        };
        Extra { words, undo: Box::new(undo), is_common: false, group: Group::Others }
    };
    let extras = |shift: DVec3| {
        let mesh = words("the mesh is", shift) + " against the rays";
        if !has_points {
            return vec![extra(mesh + ", or their origins by as much the other way", shift, DVec3::ZERO)];
        }
        let origins = words("the origins of the rays are", -shift) + " against the mesh";
        // The points of a shifted mesh are shifted with it.
        vec![extra(mesh, shift, shift), extra(origins, shift, DVec3::ZERO)]
    };
    found.into_iter().flat_map(extras).collect()
}
