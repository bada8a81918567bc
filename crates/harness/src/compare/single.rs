//! Single rays of two frames: the class of one, and the first ray of a class.

use raypencil_scene::SensorId;

use super::pencil::PencilLight;
use super::pixel::PixelLight;
use super::ray::compare_ray;
use super::{Class, Gathered, Place, Quantity, Side, compare_beams, light_of, says_hit};
use crate::judge::Judge;

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

/// The class of one ray of the judge's scene and the quantity that is worst, as [`super::compare_judged`] has it;
/// `None` if there is no such ray or one side does not say what it hits.
pub fn class_at(judge: &Judge<'_>, a: Side<'_>, b: Side<'_>, place: Place) -> Option<(Class, Quantity)> {
    let (of_a, of_b) = (a.frame.map(place.sensor)?, b.frame.map(place.sensor)?);
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
    let maps = (a.frame.map(sensor), b.frame.map(sensor), judge.scene().size(sensor));
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compare::compare_judged;
    use crate::judge::JudgeShare;
    use crate::output::fixtures::approximate;

    #[test]
    fn single_rays_have_the_classes_that_a_comparison_counts() {
        let validation = approximate();
        let scene = &validation.subject.scene;
        let judge = Judge::new(scene, JudgeShare::Sample);
        let [a, b] = [0, 1].map(|index| validation.rendered[index].side());
        let whole = compare_judged(&judge, a, b);
        let mut first: Option<First> = None;
        let mut before = 0;
        // In the order of `first_of`: the camera last.
        for sensor in whole[1..].iter().chain(&whole[..1]) {
            // A row of the camera is enough: each of its pixels compares all beams.
            let (width, height) = scene.size(sensor.sensor).unwrap();
            let rows = if sensor.sensor == SensorId::Camera { 20..21 } else { 0..height };
            let mut by_class = [0; 6];
            for (i, j) in rows.flat_map(|j| (0..width).map(move |i| (i, j))) {
                let place = Place { sensor: sensor.sensor, i, j };
                let (class, quantity) = class_at(&judge, a, b, place).unwrap();
                by_class[class as usize] += 1;
                before += 1;
                if class == Class::Approximation && first.is_none() {
                    first = Some(First { place, quantity, compared: before });
                }
            }
            if sensor.sensor != SensorId::Camera {
                assert_eq!(by_class, sensor.by_class, "{}", sensor.sensor);
            }
            let outside = Place { sensor: sensor.sensor, i: width, j: 0 };
            assert_eq!(class_at(&judge, a, b, outside), None);
        }
        assert!(first.is_some());
        assert_eq!(first_of(&judge, a, b, Class::Approximation), first);
        assert_eq!(first_of(&judge, a, b, Class::Undecided), None);
    }
}
