//! Single rays of two frames: the class of one, and the first ray of a class.

use crate::class::{Class, Quantity};
use crate::compare::entry::Gathered;
use crate::compare::light::PencilLight;
use crate::compare::pixel::PixelLight;
use crate::compare::ray::compare_ray;
use crate::compare::side::Side;
use crate::compare::{compare_beams, light_of, says_hit};
use crate::judge::Judge;
use raypencil_scene::Place;
use raypencil_scene::SensorId;

/// The first ray of a class.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct First {
    /// Which ray.
    pub place: Place,
    /// The quantity that put it there.
    pub quantity: Quantity,
    /// Rays compared until it was found, itself among them.
    pub compared: u64,
}

/// The class of one ray of the judge's scene and the quantity that is worst, as [`crate::compare::compare::compare_judged`] has it;
/// `None` if there is no such ray or one side does not say what it hits.
pub fn class_at(judge: &Judge<'_>, a: Side<'_>, b: Side<'_>, place: Place) -> Option<(Class, Quantity)> {
    let (of_a, of_b) = (a.output.map(place.sensor)?, b.output.map(place.sensor)?);
    let (width, height) = judge.scene().size(place.sensor)?;
    if place.i >= width || place.j >= height || !says_hit(of_a) || !says_hit(of_b) {
        return None;
    }
    let light = match place.sensor {
        SensorId::Camera => compare_beams(judge, a, b).1,
        SensorId::Beam(_) => Vec::new(),
    };
    Some(compare_ray(judge, place, (of_a, a), (of_b, b), &light, &mut Gathered::default()))
}

/// The first ray of a class, in the order of comparison: beam by beam, which the light on the image is judged by,
/// then the camera, each in reading order. What follows is not looked at.
pub fn first_of(judge: &Judge<'_>, a: Side<'_>, b: Side<'_>, class: Class) -> Option<First> {
    let (mut compared, mut light) = (0, Vec::new());
    for beam in 0..judge.scene().beams().len() {
        match first_on(judge, SensorId::Beam(beam), [a, b], &[], class, &mut compared) {
            Ok(pencils) => light.extend(light_of(judge, beam, [a, b], pencils)),
            Err(first) => return Some(first),
        }
    }
    first_on(judge, SensorId::Camera, [a, b], &light, class, &mut compared).err()
}

/// The first ray of a class on one sensor as an error, or else what its pencils deliver.
fn first_on(
    judge: &Judge<'_>,
    sensor: SensorId,
    [a, b]: [Side<'_>; 2],
    light: &[PixelLight<'_>],
    class: Class,
    compared: &mut u64,
) -> Result<Vec<PencilLight>, First> {
    let mut gathered = Gathered::default();
    let maps = (a.output.map(sensor), b.output.map(sensor), judge.scene().size(sensor));
    let (Some(of_a), Some(of_b), Some((width, height))) = maps else { return Ok(Vec::new()) };
    if !says_hit(of_a) || !says_hit(of_b) {
        return Ok(Vec::new());
    }
    for (i, j) in (0..height).flat_map(|j| (0..width).map(move |i| (i, j))) {
        let place = Place { sensor, i, j };
        let (of_ray, quantity) = compare_ray(judge, place, (of_a, a), (of_b, b), light, &mut gathered);
        *compared += 1;
        if of_ray == class {
            return Err(First { place, quantity, compared: *compared });
        }
    }
    Ok(gathered.light)
}
