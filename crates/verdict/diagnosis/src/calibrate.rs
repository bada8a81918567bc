//! Numbers of a sensor that a recording was made with, by least squares: the pose, the principal point, the focal length, the fan.
//!
//! Each ray says how far the plane of its face is. A ray that meets another face than the scene's says something else, and
//! is left out as an outlier. The cast has the last word: it asks which face is met.

use glam::DVec3;
use raypencil_scene::{FaceId, HitQuantity, Place, Scene, SensorId};

use crate::case::Case;
use crate::channel::{Channel, Value, hit_quantity};
use crate::lengths::MAX_COSINE_OF_TWO_PLANES;
use crate::mistake::{Mistake, Turn};
use crate::numbers::{middle, plainest};
use crate::rules::{Numbers, Rules, ray};

/// Rays from which numbers are found, at least for each number, and at most in all.
const MIN_RAYS_PER_NUMBER: usize = 8;
const MAX_RAYS: usize = 384;

/// Steps of Gauss and Newton. Each squares what is left, so that few are needed.
const MAX_STEPS: usize = 14;

/// A residual larger than so many medians is an outlier: of numbers with a normal distribution one in a thousand is.
const OUTLIER_MEDIANS: f64 = 5.0;

/// The numbers leave at most this part of the errors that the rays have without them. Chance leaves nearly all: k numbers
/// fitted to n rays take away one part in n/k.
const MAX_LEFT: f64 = 1.0 / 32.0;

/// More numbers leave at most this part of what fewer leave. Tuned: of noise they leave nearly all.
const MORE_NUMBERS_LEAVE: f64 = 1.0 / 8.0;

/// Residuals that a few roundings leave: what leaves no more than that, more numbers do not better.
const ROUNDINGS: f64 = 1e-13;

/// Of two explanations by as many numbers, the worse leaves so many times more; else neither is told.
const MIN_RATIO: f64 = 3.0;

/// Numbers that are told, at most: a turn by a right angle is no pose that is a little off. Half of the image; a factor of
/// two; radians; metres.
const MAX_OFFSET_SHARE: f64 = 0.5;
const MAX_FACTOR: f64 = 2.0;
const MAX_TURN: f64 = 0.5;
const MAX_SHIFT: f64 = 10.0;

/// One number that may be wrong.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Parameter {
    OffsetX,
    OffsetY,
    Focal,
    PitchX,
    PitchY,
    Fan,
    Thickness,
    TurnX,
    TurnY,
    TurnZ,
    ShiftX,
    ShiftY,
    ShiftZ,
}

use Parameter::{
    Fan, Focal, OffsetX, OffsetY, PitchX, PitchY, ShiftX, ShiftY, ShiftZ, Thickness, TurnX, TurnY, TurnZ,
};

impl Parameter {
    /// A size at which rays change much: its thousandth is a step of a derivative.
    fn unit(self) -> f64 {
        match self {
            OffsetX | OffsetY | Thickness => 1.0,
            Focal | PitchX | PitchY | Fan | TurnX | TurnY | TurnZ | ShiftX | ShiftY | ShiftZ => 1e-2,
        }
    }

    fn of(self, numbers: &mut Numbers) -> &mut f64 {
        match self {
            OffsetX => &mut numbers.offset[0],
            OffsetY => &mut numbers.offset[1],
            Focal => &mut numbers.focal,
            PitchX => &mut numbers.pitch[0],
            PitchY => &mut numbers.pitch[1],
            Fan => &mut numbers.fan,
            Thickness => &mut numbers.thickness,
            TurnX => &mut numbers.turn.x,
            TurnY => &mut numbers.turn.y,
            TurnZ => &mut numbers.turn.z,
            ShiftX => &mut numbers.shift.x,
            ShiftY => &mut numbers.shift.y,
            ShiftZ => &mut numbers.shift.z,
        }
    }
}

/// The sets of numbers that are tried for a sensor, the plainest first.
fn models(sensor: SensorId) -> Vec<Vec<Parameter>> {
    let own: &[&[Parameter]] = match sensor {
        SensorId::Camera => &[&[OffsetX], &[OffsetY], &[Focal], &[PitchX], &[PitchY], &[PitchX, PitchY]],
        SensorId::Beam(_) => &[&[OffsetX], &[OffsetY], &[Fan], &[Thickness]],
    };
    let pose: [&[Parameter]; 10] = [
        &[TurnX],
        &[TurnY],
        &[TurnZ],
        &[ShiftZ],
        &[ShiftX],
        &[ShiftY],
        &[OffsetX, OffsetY],
        &[TurnX, TurnY, TurnZ],
        &[ShiftX, ShiftY, ShiftZ],
        &[TurnX, TurnY, TurnZ, ShiftX, ShiftY, ShiftZ],
    ];
    own.iter().copied().chain(pose).map(<[Parameter]>::to_vec).collect()
}

/// A ray, the plane of its face, and the length that is stated.
#[derive(Debug, Clone, Copy)]
struct Sight {
    place: Place,
    corner: DVec3,
    normal: DVec3,
    stated: f64,
    /// Whether the stated length is a depth; else it is a range.
    is_depth: bool,
}

impl Sight {
    /// Whether its plane and another one count as one, up to a turn by some degrees.
    fn is_parallel_to(&self, other: &Self) -> bool {
        let cosine = self.normal.dot(other.normal) / (self.normal.length() * other.normal.length());
        cosine >= MAX_COSINE_OF_TWO_PLANES
    }

    /// Relative difference of the stated length and that of the ray by some numbers.
    fn residual(&self, scene: &Scene, numbers: &Numbers) -> f64 {
        let Some(ray) = ray(scene, self.place, numbers) else { return f64::NAN };
        let t = self.normal.dot(self.corner - ray.origin) / self.normal.dot(ray.direction);
        let length = if self.is_depth { t * ray.axis } else { t * ray.direction.length() };
        (self.stated - length) / self.stated
    }
}

/// Numbers that were found, with what each may be off by.
#[derive(Debug, Clone)]
struct Fit {
    model: Vec<Parameter>,
    numbers: Numbers,
    uncertainty: Vec<f64>,
    /// Median size of the residuals.
    left: f64,
}

/// Mistakes in the numbers of a sensor that explain its lengths, and the rules by which its rays are cast then. Several
/// if a cast must decide.
pub(crate) fn calibrations(case: Case<'_>, places: &[Place]) -> Vec<(Mistake, Rules)> {
    let [sensor] = *case.sensors else { return Vec::new() };
    let scene = case.truth.scene();
    let sights = sights(case, sensor, places);
    let residuals = |numbers: &Numbers| -> Vec<f64> {
        sights.iter().map(|sight| sight.residual(scene, numbers)).collect()
    };
    let Some(before) = median_size(&residuals(&Numbers::SCENE)) else { return Vec::new() };
    let mut best: Vec<Fit> = Vec::new();
    // Lengths that all end in one plane are as much longer from another place as by a factor.
    let has_planes = sights.iter().any(|sight| !sight.is_parallel_to(&sights[0]));
    for model in models(sensor) {
        let has_shift = model.iter().any(|one| matches!(one, ShiftX | ShiftY | ShiftZ));
        if sights.len() < MIN_RAYS_PER_NUMBER * model.len() || has_shift && !has_planes {
            continue;
        }
        let is_good = |fit: &Fit| fit.left <= MAX_LEFT * before && is_small(scene, sensor, &fit.numbers);
        if let Some(fit) = fit(scene, &sights, model).filter(is_good) {
            // More numbers are told only if they leave much less.
            if best.iter().all(|one| {
                one.model.len() == fit.model.len()
                    || one.left > ROUNDINGS && fit.left < MORE_NUMBERS_LEAVE * one.left
            }) {
                best.retain(|one| one.model.len() == fit.model.len());
                best.push(fit);
            }
        }
    }
    best.sort_by(|a, b| a.left.total_cmp(&b.left));
    if let [first, second, ..] = best.as_slice()
        && second.left < MIN_RATIO * first.left
    {
        return Vec::new();
    }
    best.truncate(1);
    best.into_iter().filter_map(|fit| told(scene, sensor, &fit)).collect()
}

/// Whether numbers are a little off, and not quite other ones.
fn is_small(scene: &Scene, sensor: SensorId, numbers: &Numbers) -> bool {
    let (width, height) = scene.size(sensor).unwrap_or((1, 1));
    let [dx, dy] = numbers.offset;
    let is_factor = |factor: f64| (1.0 / MAX_FACTOR..=MAX_FACTOR).contains(&factor);
    dx.abs() <= MAX_OFFSET_SHARE * f64::from(width)
        && dy.abs() <= MAX_OFFSET_SHARE * f64::from(height)
        && is_factor(numbers.focal)
        && is_factor(numbers.fan)
        && numbers.pitch.iter().all(|one| is_factor(*one))
        // A beam may be taken for a plane: then the factor is 0 up to rounding. It is thin, so that twice as much is little.
        && (-1e-6..=2.0 * MAX_FACTOR).contains(&numbers.thickness)
        && numbers.turn.length() <= MAX_TURN
        && numbers.shift.length() <= MAX_SHIFT
}

/// What each ray says of its face's plane.
fn sights(case: Case<'_>, sensor: SensorId, places: &[Place]) -> Vec<Sight> {
    let channels = case.channels();
    let length = |wanted| {
        let mut of_hit = channels.iter().filter(|one| hit_quantity(one.item.quantity) == Some(wanted));
        of_hit.next().map(|channel| (*channel, wanted == HitQuantity::Depth))
    };
    let Some((channel, is_depth)) = length(HitQuantity::Range).or_else(|| length(HitQuantity::Depth)) else {
        return Vec::new();
    };
    let map = case.recorded.answers.map(sensor);
    let mesh = case.truth.scene().mesh();
    let vertex = |index: u32| DVec3::from_array(mesh.vertices()[index as usize].map(f64::from));
    let face_of = |place: Place| -> Option<FaceId> {
        let faces = map.face.as_ref().or(case.truth.answers().map(sensor).face.as_ref())?;
        faces.at(place.i, place.j).get()
    };
    let sight = |place: Place| {
        let Value::Number(stated) = Channel::at(channel, &case.recorded.answers, place) else { return None };
        let [a, b, c] = (*mesh.faces().get(face_of(place)?.0 as usize)?).map(vertex);
        let normal = (b - a).cross(c - a);
        (stated > 0.0).then_some(Sight { place, corner: a, normal, stated, is_depth })
    };
    let own = || places.iter().copied().filter(|place| place.sensor == sensor);
    let step = own().count().div_ceil(MAX_RAYS).max(1);
    own().step_by(step).filter_map(sight).collect()
}

fn median_size(residuals: &[f64]) -> Option<f64> {
    let mut sizes: Vec<f64> = residuals.iter().map(|one| one.abs()).filter(|one| one.is_finite()).collect();
    middle(&mut sizes, MIN_RAYS_PER_NUMBER).map(|(median, _)| median)
}

/// Gauss and Newton, without outliers.
fn fit(scene: &Scene, sights: &[Sight], model: Vec<Parameter>) -> Option<Fit> {
    let mut numbers = Numbers::SCENE;
    let mut uncertainty = vec![0.0; model.len()];
    let residuals = |numbers: &Numbers| -> Vec<f64> {
        sights.iter().map(|sight| sight.residual(scene, numbers)).collect()
    };
    let mut now = residuals(&numbers);
    for _ in 0..MAX_STEPS {
        let most = OUTLIER_MEDIANS * median_size(&now)? + 1e-15;
        let derivatives: Vec<Vec<f64>> = model
            .iter()
            .map(|parameter| {
                let step = 1e-3 * parameter.unit();
                let [mut more, mut less] = [numbers; 2];
                *parameter.of(&mut more) += step;
                *parameter.of(&mut less) -= step;
                let [more, less] = [residuals(&more), residuals(&less)];
                more.iter().zip(less).map(|(more, less)| (more - less) / (2e-3)).collect()
            })
            .collect();
        let (mut matrix, mut right) = (vec![vec![0.0; model.len()]; model.len()], vec![0.0; model.len()]);
        let (mut kept, mut squares) = (0_usize, 0.0);
        for (index, residual) in now.iter().enumerate().filter(|(_, residual)| residual.abs() <= most) {
            let row: Vec<f64> = derivatives.iter().map(|of| of[index]).collect();
            if row.iter().any(|one| !one.is_finite()) {
                continue;
            }
            kept += 1;
            squares += residual * residual;
            for (a, of_a) in row.iter().enumerate() {
                right[a] -= of_a * residual;
                for (b, of_b) in row.iter().enumerate() {
                    matrix[a][b] += of_a * of_b;
                }
            }
        }
        if kept < MIN_RAYS_PER_NUMBER * model.len() {
            return None;
        }
        let (step, variances) = solved(matrix, right)?;
        let error = (squares / kept as f64).sqrt();
        for (index, parameter) in model.iter().enumerate() {
            *parameter.of(&mut numbers) += step[index] * parameter.unit();
            uncertainty[index] = (error * variances[index].sqrt() + 1e-13) * parameter.unit();
        }
        now = residuals(&numbers);
    }
    let left = median_size(&now)?;
    Some(Fit { model, numbers, uncertainty, left })
}

/// The solution of a symmetric system, and the diagonal of its inverse; `None` if it has none.
fn solved(mut matrix: Vec<Vec<f64>>, right: Vec<f64>) -> Option<(Vec<f64>, Vec<f64>)> {
    let size = right.len();
    // The right side and the unit matrix beside it, by Gauss and Jordan with pivots.
    for (index, row) in matrix.iter_mut().enumerate() {
        row.push(right[index]);
        row.extend((0..size).map(|k| f64::from(u8::from(k == index))));
    }
    let largest = matrix.iter().flatten().fold(0.0_f64, |most, one| most.max(one.abs()));
    for k in 0..size {
        let pivot = (k..size).max_by(|a, b| matrix[*a][k].abs().total_cmp(&matrix[*b][k].abs()))?;
        matrix.swap(k, pivot);
        if !(matrix[k][k].abs() > 1e-13 * largest) {
            return None;
        }
        let row: Vec<f64> = matrix[k].iter().map(|one| one / matrix[k][k]).collect();
        for (index, other) in matrix.iter_mut().enumerate() {
            if index == k {
                other.clone_from(&row);
            } else {
                let factor = other[k];
                other.iter_mut().zip(&row).for_each(|(own, one)| *own -= factor * one);
            }
        }
    }
    let solution = matrix.iter().map(|row| row[size]).collect();
    let variances = (0..size).map(|k| matrix[k][size + 1 + k].abs()).collect();
    Some((solution, variances))
}

/// The mistake with the plainest numbers that say the same, and its rules.
fn told(scene: &Scene, sensor: SensorId, fit: &Fit) -> Option<(Mistake, Rules)> {
    let mut numbers = fit.numbers;
    // A number in the unit in which it is told, and back.
    let off = |parameter: Parameter| {
        let index = fit.model.iter().position(|one| *one == parameter)?;
        Some((*parameter.of(&mut fit.numbers.clone()), 5.0 * fit.uncertainty[index]))
    };
    let degrees = |parameter: Parameter| {
        let (number, uncertainty) = off(parameter)?;
        Some(plainest(number.to_degrees(), uncertainty.to_degrees()))
    };
    let metres = |parameter: Parameter| {
        let (number, uncertainty) = off(parameter)?;
        Some(plainest(number, uncertainty))
    };
    let mistake = match fit.model.as_slice() {
        [OffsetX | OffsetY, ..] => {
            let camera = &scene.camera().sensor;
            let mut stated = camera.principal_point;
            for (k, parameter) in [OffsetX, OffsetY].into_iter().enumerate() {
                let Some((offset, uncertainty)) = off(parameter) else { continue };
                if sensor == SensorId::Camera {
                    // A ray further to the right is one of a principal point further to the left.
                    stated[k] = plainest(camera.principal_point[k] - offset, uncertainty);
                    numbers.offset[k] = camera.principal_point[k] - stated[k];
                } else {
                    numbers.offset[k] = plainest(offset, uncertainty);
                }
            }
            let [columns, rows] = numbers.offset;
            let is_corner = columns.abs() == 0.5 && rows.abs() == 0.5;
            if sensor == SensorId::Camera && !is_corner {
                Mistake::PrincipalPoint { stated, truth: camera.principal_point }
            } else {
                Mistake::CornerRays { columns, rows }
            }
        }
        [Focal] => {
            let truth = scene.camera().sensor.focal_length;
            let (factor, uncertainty) = off(Focal)?;
            let stated = plainest(1e3 * truth * factor, 1e3 * truth * uncertainty) / 1e3;
            numbers.focal = stated / truth;
            Mistake::FocalLength { stated, truth }
        }
        [PitchX | PitchY, ..] => {
            let truth = scene.camera().sensor.pixel_pitch;
            let mut stated = truth;
            for (k, parameter) in [PitchX, PitchY].into_iter().enumerate() {
                let Some((factor, uncertainty)) = off(parameter) else { continue };
                stated[k] = plainest(1e6 * truth[k] * factor, 1e6 * truth[k] * uncertainty) / 1e6;
                numbers.pitch[k] = stated[k] / truth[k];
            }
            Mistake::PixelPitch { stated, truth }
        }
        [Thickness] => {
            let SensorId::Beam(beam) = sensor else { return None };
            let truth = scene.beams()[beam].sensor.thickness;
            let (factor, uncertainty) = off(Thickness)?;
            // 0 in place of -0.
            let stated = plainest(1e3 * truth * factor, 1e3 * truth * uncertainty) / 1e3 + 0.0;
            numbers.thickness = stated / truth;
            Mistake::Thickness { stated, truth }
        }
        [Fan] => {
            let SensorId::Beam(beam) = sensor else { return None };
            let beam = &scene.beams()[beam].sensor;
            let tangent = beam.half_width / beam.grid_distance;
            let (factor, uncertainty) = off(Fan)?;
            let angle = |tangent: f64| 2.0 * libm::atan(tangent).to_degrees();
            // The derivative of the angle is at most that of the tangent.
            let stated = plainest(angle(tangent * factor), 2.0 * (tangent * uncertainty).to_degrees());
            numbers.fan = libm::tan(0.5 * stated.to_radians()) / tangent;
            Mistake::Fan { stated, truth: plainest(angle(tangent), 1e-12) }
        }
        [one @ (TurnX | TurnY | TurnZ)] => {
            let turn = degrees(*one)?;
            *one.of(&mut numbers) = turn.to_radians();
            match one {
                // A turn about x, which points to the right, lifts the view.
                TurnX => Mistake::Turned { about: Turn::Pitch, degrees: -turn },
                TurnY => Mistake::Turned { about: Turn::Yaw, degrees: turn },
                _ => Mistake::Turned { about: Turn::Roll, degrees: turn },
            }
        }
        [ShiftX | ShiftY | ShiftZ, ..] => {
            let by = [ShiftX, ShiftY, ShiftZ].map(|one| metres(one).unwrap_or(0.0));
            numbers.shift = DVec3::from_array(by);
            Mistake::Moved(by)
        }
        [TurnX, TurnY, TurnZ, ..] => {
            let turns = [TurnX, TurnY, TurnZ].map(|one| degrees(one).unwrap_or(0.0));
            let by = [ShiftX, ShiftY, ShiftZ].map(|one| metres(one).unwrap_or(0.0));
            numbers.turn = DVec3::from_array(turns.map(f64::to_radians));
            numbers.shift = DVec3::from_array(by);
            Mistake::Posed { degrees: turns, metres: by }
        }
        _ => return None,
    };
    Some((mistake, Rules { numbers, ..Rules::CONTRACT }))
}

#[cfg(test)]
#[path = "../tests/unit/calibrate.rs"]
mod tests;
