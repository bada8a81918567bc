//! Fewer beams and smaller sensors, down to the one ray in question, which stays the very same.

use crate::draft::Draft;
use crate::exact::{cropped, narrowed};
use crate::trials::Trials;
use raypencil_scene::Place;
use raypencil_scene::SensorId;

/// Columns, then rows.
const AXES: [usize; 2] = [0, 1];

/// No beam that is not needed, and of the sensor in question the one ray, the very same: a few calls.
pub(super) fn cut_to_ray(trials: &mut Trials<'_>) {
    trials.stage("fewer beams, a single ray");
    drop_beams(trials);
    match trials.best().place {
        Some(Place { sensor: SensorId::Camera, i, j }) => {
            trials.plainest_of([()], |draft, ()| crop(draft, [i, j], [1, 1]));
        }
        Some(Place { sensor: SensorId::Beam(index), i, j }) => {
            let beams = narrowed(&trials.best().beams[index].sensor, [i, j]);
            trials.plainest_of(beams, |draft, (beam, [i, j])| {
                let mut draft = draft.clone();
                draft.beams[index].sensor = beam;
                draft.place = Some(Place { sensor: SensorId::Beam(index), i, j });
                Some(draft)
            });
        }
        None => {}
    }
}

/// The other sensors as small as can be, and that of the ray in question if it could not be cut to it: some twenty calls
/// each.
pub(super) fn cut_others(trials: &mut Trials<'_>) {
    trials.stage("smaller sensors");
    trim_camera(trials);
    coarsen_beams(trials);
}

/// Leaves out every beam that is not needed. Those after it get other indices, that of the ray in question too.
fn drop_beams(trials: &mut Trials<'_>) {
    let own = |draft: &Draft| match draft.place.map(|place| place.sensor) {
        Some(SensorId::Beam(index)) => Some(index),
        _ => None,
    };
    let without = |draft: &Draft, beams: &[usize]| {
        let mut rest = draft.clone();
        let mut index = 0;
        rest.beams.retain(|_| {
            index += 1;
            !beams.contains(&(index - 1))
        });
        if let (Some(own), Some(place)) = (own(draft), &mut rest.place) {
            place.sensor = SensorId::Beam(own - beams.iter().filter(|beam| **beam < own).count());
        }
        rest
    };
    let best = trials.best();
    let others: Vec<usize> = (0..best.beams.len()).filter(|index| Some(*index) != own(best)).collect();
    if others.is_empty() || trials.keep(without(best, &others)) {
        return;
    }
    for &beam in others.iter().rev() {
        trials.keep(without(trials.best(), &[beam]));
    }
}

/// The image from pixel `first` on, of `size` pixels; `None` if the rays or the place would not be the same.
fn crop(draft: &Draft, first: [u32; 2], size: [u32; 2]) -> Option<Draft> {
    let mut draft = draft.clone();
    draft.camera.sensor = cropped(&draft.camera.sensor, first, size)?;
    if let Some(place) = draft.place.as_mut().filter(|place| place.sensor == SensorId::Camera) {
        (place.i, place.j) = (place.i.checked_sub(first[0])?, place.j.checked_sub(first[1])?);
        if place.i >= size[0] || place.j >= size[1] {
            return None;
        }
    }
    Some(draft)
}

/// Cuts strips off the image, on either side: halves first, then ever thinner ones.
fn trim_camera(trials: &mut Trials<'_>) {
    let size = |draft: &Draft| [draft.camera.sensor.width, draft.camera.sensor.height];
    for axis in AXES {
        let mut strip = size(trials.best())[axis] / 2;
        while strip > 0 && !trials.is_spent() {
            let rest = size(trials.best());
            if strip >= rest[axis] {
                strip = rest[axis] / 2;
                continue;
            }
            let mut smaller = rest;
            smaller[axis] -= strip;
            let mut left = [0; 2];
            left[axis] = strip;
            let is_cut = [[0; 2], left]
                .into_iter()
                .any(|first| crop(trials.best(), first, smaller).is_some_and(|draft| trials.keep(draft)));
            if !is_cut {
                strip /= 2;
            }
        }
    }
}

/// Gives each beam but that of the ray in question fewer columns and rows: other rays, over the same fan.
fn coarsen_beams(trials: &mut Trials<'_>) {
    let own = trials.best().place.map(|place| place.sensor);
    for index in (0..trials.best().beams.len()).filter(|index| own != Some(SensorId::Beam(*index))) {
        for axis in AXES {
            let beam = &trials.best().beams[index].sensor;
            let count = [beam.columns, beam.rows][axis];
            let fewer = std::iter::successors(Some(1), |count: &u32| Some(2 * count));
            trials.plainest_of(fewer.take_while(|fewer| *fewer < count), |draft, fewer| {
                let mut draft = draft.clone();
                let beam = &mut draft.beams[index].sensor;
                *(if axis == 0 { &mut beam.columns } else { &mut beam.rows }) = fewer;
                Some(draft)
            });
        }
    }
}
