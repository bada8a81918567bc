//! Two frames of one scene, ray by ray: what agrees, and what each difference is.
//!
//! A ray is a cell of a sensor: a pencil or a pixel. Its class is the worst of its quantities', and the
//! classes of all rays add up to those compared. The referee rules on every ray whose two answers differ, and
//! on a sample of those that agree: two renderers may share a mistake.

pub(crate) mod answer;
pub(crate) mod entry;
pub(crate) mod light;
pub(crate) mod pencil;
pub(crate) mod pixel;
pub(crate) mod ray;
pub(crate) mod side;
pub(crate) mod single;

use rayon::prelude::*;
use std::collections::BTreeMap;

use crate::class::{CLASSES, Quantity};
use crate::compare::entry::Gathered;
use crate::compare::light::PencilLight;
use crate::compare::pixel::PixelLight;
use crate::compare::ray::compare_ray;
use crate::compare::side::Side;
use crate::judge::{Judge, JudgeShare};
use crate::tally::{DEFECTS_DESCRIBED, SensorComparison, Tally};
use raypencil_scene::{Image, Place, Scene, SensorId, SensorMap};

pub use crate::compare::single::{First, class_at, first_of};

/// Compares two frames of `scene`, sensor by sensor, with a judge of its own.
pub fn compare(scene: &Scene, a: Side<'_>, b: Side<'_>) -> Vec<SensorComparison> {
    compare_judged(&Judge::new(scene, JudgeShare::Sample), a, b)
}

/// Compares two frames of the judge's scene, sensor by sensor, the camera first.
pub fn compare_judged(judge: &Judge<'_>, a: Side<'_>, b: Side<'_>) -> Vec<SensorComparison> {
    let (beams, light) = compare_beams(judge, a, b);
    let (camera, _) = compare_sensor(judge, SensorId::Camera, a, b, &light);
    std::iter::once(camera).chain(beams).collect()
}

/// The beams, which come first: a pixel's flux is judged by the pencils that contribute to it.
pub(crate) fn compare_beams<'f>(
    judge: &Judge<'_>,
    a: Side<'f>,
    b: Side<'f>,
) -> (Vec<SensorComparison>, Vec<PixelLight<'f>>) {
    let mut light = Vec::new();
    let mut beams = Vec::new();
    for index in 0..judge.scene().beams().len() {
        let (comparison, pencils) = compare_sensor(judge, SensorId::Beam(index), a, b, &[]);
        beams.push(comparison);
        light.extend(light_of(judge, index, [a, b], pencils));
    }
    (beams, light)
}

/// The light of a beam on the image, if both sides have an image of it and pencils to judge that by.
pub(crate) fn light_of<'f>(
    judge: &Judge<'_>,
    beam: usize,
    sides: [Side<'f>; 2],
    pencils: Vec<PencilLight>,
) -> Option<PixelLight<'f>> {
    let tells_pencils = sides.iter().all(|side| {
        let returns = side.output.returns.get(beam);
        returns.is_some_and(|returns| returns.pixel.is_some() && returns.flux.is_some())
    });
    let [of_a, of_b] = sides.map(|side| side.output.flux.get(beam));
    let images = [of_a?, of_b?];
    let [a, b] = sides.map(|side| side.precision.unit_roundoff);
    tells_pencils.then(|| PixelLight::new(judge.scene(), images, pencils, a.max(b)))
}

fn compare_sensor(
    judge: &Judge<'_>,
    sensor: SensorId,
    a: Side<'_>,
    b: Side<'_>,
    light: &[PixelLight<'_>],
) -> (SensorComparison, Vec<PencilLight>) {
    if let (Some(of_a), Some(of_b)) = (a.output.map(sensor), b.output.map(sensor))
        && says_hit(of_a)
        && says_hit(of_b)
    {
        return compare_maps(judge, sensor, (of_a, a), (of_b, b), light);
    }
    let (width, height) = judge.scene().size(sensor).expect("a sensor of this scene");
    let not_compared = u64::from(width) * u64::from(height);
    let tally = |quantity: Quantity| {
        let not_compared = if quantity.is_of(sensor) { not_compared } else { 0 };
        (quantity, Tally { not_compared, ..Tally::default() })
    };
    let comparison = SensorComparison {
        sensor,
        compared: 0,
        not_compared,
        by_class: [0; CLASSES],
        judged: 0,
        approximations: BTreeMap::new(),
        quantities: Quantity::ALL.map(tally).to_vec(),
        defects: Vec::new(),
        range_difference: None,
    };
    (comparison, Vec::new())
}

/// Whether a map says of each ray if it hits.
pub(crate) fn says_hit(map: &SensorMap) -> bool {
    map.range.is_some() || map.face.is_some()
}

fn compare_maps(
    judge: &Judge<'_>,
    sensor: SensorId,
    (map_a, a): (&SensorMap, Side<'_>),
    (map_b, b): (&SensorMap, Side<'_>),
    light: &[PixelLight<'_>],
) -> (SensorComparison, Vec<PencilLight>) {
    let (width, height) = judge.scene().size(sensor).expect("a sensor of this scene");
    // Rows in parallel, added up in their order: the result does not depend on threads.
    let rows: Vec<Gathered> = (0..height)
        .into_par_iter()
        .map(|j| {
            let mut row = Gathered::default();
            for i in 0..width {
                compare_ray(judge, Place { sensor, i, j }, (map_a, a), (map_b, b), light, &mut row);
            }
            row
        })
        .collect();
    let mut all = Gathered::default();
    for row in rows {
        for (mine, theirs) in all.by_class.iter_mut().zip(row.by_class) {
            *mine += theirs;
        }
        all.judged += row.judged;
        for (cause, tally) in row.approximations {
            all.approximations.entry(cause).or_default().add(&tally);
        }
        for (mine, theirs) in all.tallies.iter_mut().zip(&row.tallies) {
            mine.add(theirs);
        }
        let room = DEFECTS_DESCRIBED.saturating_sub(all.defects.len());
        all.defects.extend(row.defects.into_iter().take(room));
        all.differences.extend(row.differences);
        all.light.extend(row.light);
    }
    let comparison = SensorComparison {
        sensor,
        compared: u64::from(width) * u64::from(height),
        not_compared: 0,
        by_class: all.by_class,
        judged: all.judged,
        approximations: all.approximations,
        quantities: Quantity::ALL.into_iter().zip(all.tallies).collect(),
        defects: all.defects,
        range_difference: Some(Image::from_cells(width, height, all.differences)),
    };
    (comparison, all.light)
}
