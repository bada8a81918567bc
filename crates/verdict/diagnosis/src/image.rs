//! The camera's image of wrong pencils: each of its pixels is right if the pencils were.

use raypencil_judge::{Check, GroundTruth, Quantity, Recorded};
use raypencil_scene::{Image, Pixel, Place, SensorId};

use crate::agree::{is_near, tolerance_of};
use crate::case::Case;
use crate::channel::{Channel, Value, channels_of};
use crate::sample::{Key, WrongRays, key};
use crate::tally::{LEFT_ONE_IN, MIN_CONFIRMING_RAYS, Tally};

/// What is explained of the camera's wrong flux if it is the sum of what the pencils of the recording state.
///
/// Where a pixel is that sum, and wrong, some of its pencils are wrong. `None`: it is not, or the camera's hits are wrong, too.
pub(crate) fn explained_by_pencils(
    truth: &GroundTruth<'_>,
    recorded: &Recorded,
    check: &Check,
) -> Option<Tally> {
    let camera = [SensorId::Camera];
    let wrong = WrongRays::of(check, &camera);
    if wrong.of_hits.len() as u64 * LEFT_ONE_IN > wrong.all.len() as u64 {
        return None;
    }
    let tolerance = tolerance_of(truth, recorded, &wrong.values);
    let case = Case { truth, recorded, sensors: &camera, tolerance };
    let channels = channels_of(recorded, &camera);
    let of_flux = channels.iter().filter(|channel| channel.item.quantity == Quantity::PixelFlux);
    let sums: Vec<(Channel, Image<f64>)> =
        of_flux.filter_map(|channel| Some((*channel, sum_of_pencils(case, *channel)?))).collect();
    let (width, height) = truth.scene().size(SensorId::Camera)?;
    let is_sum = |place: Place| {
        sums.iter().all(|(channel, sum)| {
            let stated = channel.at(&recorded.answers, place);
            is_near(case, *channel, place, stated, Value::Number(sum.at(place.i, place.j)))
        })
    };
    let has_sum = |(channel, _): &(Channel, Place)| sums.iter().any(|(of, _)| of == channel);
    if sums.is_empty() || !wrong.values.iter().all(has_sum) {
        return None;
    }
    let cells = (0..height).flat_map(|j| (0..width).map(move |i| (SensorId::Camera, j, i)));
    let (mut explained, mut broken) = (0, 0);
    for (sensor, j, i) in cells {
        let place = Place { sensor, i, j };
        let ray: Key = key(place);
        match (wrong.all.contains(&ray), is_sum(place)) {
            (true, true) => explained += 1,
            (false, false) => broken += 1,
            _ => {}
        }
    }
    let tally = Tally { explained, wrong: wrong.all.len() as u64, broken, right: wrong.right() };
    tally.is_enough(MIN_CONFIRMING_RAYS, [tally.wrong, tally.right]).then_some(tally)
}

/// The flux that the stated pencils of a channel's beam bring to each pixel; `None` without stated flux.
///
/// A pencil lands where the recording says, or where it truly does if the recording does not say.
fn sum_of_pencils(case: Case<'_>, channel: Channel) -> Option<Image<f64>> {
    let beam = channel.beam()?;
    let light = case.recorded.answers.light.get(beam)?;
    let flux = if channel.item.is_other_model { &light.other_flux } else { &light.returns.flux };
    let flux = flux.as_ref()?;
    let (width, height) = case.truth.scene().size(SensorId::Camera)?;
    let mut sum = Image::filled(width, height, 0.0);
    for j in 0..flux.height() {
        for i in 0..flux.width() {
            let place = Place { sensor: SensorId::Beam(beam), i, j };
            let pixel: Option<Pixel> = match &light.returns.pixel {
                Some(stated) => stated.at(i, j).get(),
                None => case.truth.visibility(place).1,
            };
            let pencil = flux.at(i, j);
            if let Some(pixel) = pixel.filter(|pixel| pixel.i < width && pixel.j < height) {
                sum.set(pixel.i, pixel.j, sum.at(pixel.i, pixel.j) + pencil);
            }
        }
    }
    Some(sum)
}
