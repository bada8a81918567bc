//! Single rays of two outputs: the class of one, and the first ray of a class.

use crate::class::Class;
use crate::compare::flux_pair::FluxPair;
use crate::compare::pixel::BeamImages;
use crate::compare::ray::{ComparedRays, compare_ray};
use crate::compare::side::Side;
use crate::compare::{compare_beams, images_of, tells_hits};
use crate::judge::Judge;
use crate::quantity::Quantity;
use raypencil_scene::{Place, SensorId};

/// The first ray of a class.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FirstOfClass {
    /// The ray.
    pub place: Place,
    /// The quantity that has that class.
    pub quantity: Quantity,
    /// Rays compared until it was found, itself among them.
    pub compared: u64,
}

/// The class of one ray of the judge's scene and the quantity that is worst, as [`crate::compare_judged`] has them;
/// `None` if there is no such ray, or if one side does not tell whether it hits.
pub fn class_of_ray(judge: &Judge<'_>, a: Side<'_>, b: Side<'_>, place: Place) -> Option<(Class, Quantity)> {
    let (of_a, of_b) = (a.output.map(place.sensor)?, b.output.map(place.sensor)?);
    let (width, height) = judge.scene().size(place.sensor)?;
    if place.i >= width || place.j >= height || !tells_hits(of_a) || !tells_hits(of_b) {
        return None;
    }
    let light = match place.sensor {
        SensorId::Camera => compare_beams(judge, a, b).1,
        SensorId::Beam(_) => Vec::new(),
    };
    let mut ray = ComparedRays::none(place.sensor);
    Some(compare_ray(judge, place, (of_a, a), (of_b, b), &light, &mut ray))
}

/// The first ray of a class, in the order of comparison: beam by beam, then the camera, each in reading order.
///
/// The beams come first since their pencils judge the image. Later rays are not compared.
pub fn first_of_class(judge: &Judge<'_>, a: Side<'_>, b: Side<'_>, class: Class) -> Option<FirstOfClass> {
    let (mut compared, mut light) = (0, Vec::new());
    for beam in 0..judge.scene().beams().len() {
        match first_on(judge, SensorId::Beam(beam), [a, b], &[], class, &mut compared) {
            Ok(pencils) => light.extend(images_of(judge, beam, [a, b], pencils)),
            Err(first) => return Some(first),
        }
    }
    first_on(judge, SensorId::Camera, [a, b], &light, class, &mut compared).err()
}

/// The first ray of a class on one sensor as an error, or else the flux of its pencils.
fn first_on(
    judge: &Judge<'_>,
    sensor: SensorId,
    [a, b]: [Side<'_>; 2],
    light: &[BeamImages<'_>],
    class: Class,
    compared: &mut u64,
) -> Result<Vec<FluxPair>, FirstOfClass> {
    let mut rays = ComparedRays::none(sensor);
    let maps = (a.output.map(sensor), b.output.map(sensor), judge.scene().size(sensor));
    let (Some(of_a), Some(of_b), Some((width, height))) = maps else { return Ok(Vec::new()) };
    if !tells_hits(of_a) || !tells_hits(of_b) {
        return Ok(Vec::new());
    }
    for (i, j) in (0..height).flat_map(|j| (0..width).map(move |i| (i, j))) {
        let place = Place { sensor, i, j };
        let (of_ray, quantity) = compare_ray(judge, place, (of_a, a), (of_b, b), light, &mut rays);
        *compared += 1;
        if of_ray == class {
            return Err(FirstOfClass { place, quantity, compared: *compared });
        }
    }
    Ok(rays.light)
}
