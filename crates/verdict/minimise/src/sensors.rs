//! Fewer beams and smaller sensors, down to the one ray in question, which stays exactly the same.

use raypencil_scene::{Place, SensorId};

use crate::reducer::Reducer;
use crate::reduction::Reduction;
use crate::same_ray::{cropped, narrowed};

/// Columns, then rows.
const AXES: [usize; 2] = [0, 1];

/// Removes beams, and cuts the sensor in question down to the ray in question. Takes a few calls.
pub(super) fn cut_to_ray(reducer: &mut Reducer<'_>) {
    reducer.stage("fewer beams, a single ray");
    drop_beams(reducer);
    match reducer.best().place {
        Some(Place { sensor: SensorId::Camera, i, j }) => {
            reducer.accept_simplest([()], |reduction, ()| crop(reduction, [i, j], [1, 1]));
        }
        Some(Place { sensor: SensorId::Beam(index), i, j }) => {
            let beams = narrowed(&reducer.best().beams[index].sensor, [i, j]);
            reducer.accept_simplest(beams, |reduction, (beam, [i, j])| {
                let mut reduction = reduction.clone();
                reduction.beams[index].sensor = beam;
                reduction.place = Some(Place { sensor: SensorId::Beam(index), i, j });
                Some(reduction)
            });
        }
        None => {}
    }
}

/// Makes the sensors as small as possible that [`cut_to_ray`] did not cut down. Takes about twenty calls each.
pub(super) fn cut_others(reducer: &mut Reducer<'_>) {
    reducer.stage("smaller sensors");
    trim_camera(reducer);
    coarsen_beams(reducer);
}

/// Removes every beam that is not needed. The indices of later beams change, also in the ray in question.
fn drop_beams(reducer: &mut Reducer<'_>) {
    let beam_in_question = |reduction: &Reduction| match reduction.place.map(|place| place.sensor) {
        Some(SensorId::Beam(index)) => Some(index),
        _ => None,
    };
    let without = |reduction: &Reduction, beams: &[usize]| {
        let mut rest = reduction.clone();
        let mut index = 0;
        rest.beams.retain(|_| {
            index += 1;
            !beams.contains(&(index - 1))
        });
        if let (Some(own), Some(place)) = (beam_in_question(reduction), &mut rest.place) {
            place.sensor = SensorId::Beam(own - beams.iter().filter(|beam| **beam < own).count());
        }
        rest
    };
    let best = reducer.best();
    let others: Vec<usize> =
        (0..best.beams.len()).filter(|index| Some(*index) != beam_in_question(best)).collect();
    if others.is_empty() || reducer.try_variant(without(best, &others)) {
        return;
    }
    for &beam in others.iter().rev() {
        reducer.try_variant(without(reducer.best(), &[beam]));
    }
}

/// A copy with the image's part of `size` pixels from pixel `first` on. `None`: the rays would change, or the ray in
/// question would be lost.
fn crop(reduction: &Reduction, first: [u32; 2], size: [u32; 2]) -> Option<Reduction> {
    let mut reduction = reduction.clone();
    reduction.camera.sensor = cropped(&reduction.camera.sensor, first, size)?;
    if let Some(place) = reduction.place.as_mut().filter(|place| place.sensor == SensorId::Camera) {
        (place.i, place.j) = (place.i.checked_sub(first[0])?, place.j.checked_sub(first[1])?);
        if place.i >= size[0] || place.j >= size[1] {
            return None;
        }
    }
    Some(reduction)
}

/// Cuts strips off both sides of the image: first halves, then thinner and thinner strips.
fn trim_camera(reducer: &mut Reducer<'_>) {
    let size = |reduction: &Reduction| [reduction.camera.sensor.width, reduction.camera.sensor.height];
    for axis in AXES {
        let mut strip = size(reducer.best())[axis] / 2;
        while strip > 0 && !reducer.is_spent() {
            let rest = size(reducer.best());
            if strip >= rest[axis] {
                strip = rest[axis] / 2;
                continue;
            }
            let mut smaller = rest;
            smaller[axis] -= strip;
            let mut left = [0; 2];
            left[axis] = strip;
            let is_cut = [[0; 2], left].into_iter().any(|first| {
                crop(reducer.best(), first, smaller).is_some_and(|reduction| reducer.try_variant(reduction))
            });
            if !is_cut {
                strip /= 2;
            }
        }
    }
}

/// Gives each beam fewer columns and rows, which makes other rays over the same fan. The beam of the ray in question
/// stays.
fn coarsen_beams(reducer: &mut Reducer<'_>) {
    let in_question = reducer.best().place.map(|place| place.sensor);
    for index in (0..reducer.best().beams.len()).filter(|index| in_question != Some(SensorId::Beam(*index))) {
        for axis in AXES {
            let beam = &reducer.best().beams[index].sensor;
            let count = [beam.columns, beam.rows][axis];
            let fewer = std::iter::successors(Some(1), |count: &u32| Some(2 * count));
            reducer.accept_simplest(fewer.take_while(|fewer| *fewer < count), |reduction, fewer| {
                let mut reduction = reduction.clone();
                let beam = &mut reduction.beams[index].sensor;
                *(if axis == 0 { &mut beam.columns } else { &mut beam.rows }) = fewer;
                Some(reduction)
            });
        }
    }
}
