//! One ray on two sides: its hit, then its light.

use crate::answer::StatedHit;
use crate::attribution::cause::Cause;
use crate::class::Class;
use crate::compare::flux_pair::FluxPair;
use crate::compare::hit::compare_hit;
use crate::compare::pencil::compare_return;
use crate::compare::pixel::{BeamImages, compare_pixel};
use crate::compare::side::Side;
use crate::entry::RayEntry;
use crate::judge::Judge;
use crate::quantity::Quantity;
use crate::tally::{ApproximationTally, Largest, SensorResult};
use raypencil_scene::{HitQuantity, Maybe, Place, SensorId, SensorMap, Switches};

/// Results of some rays of a sensor, in reading order.
pub(super) struct ComparedRays {
    pub(super) result: SensorResult,
    /// Flux of the pencils that deliver any on either side.
    pub(super) light: Vec<FluxPair>,
    /// Difference of the ranges of each ray, metres.
    pub(super) range_differences: Vec<Maybe<f64>>,
}

impl ComparedRays {
    /// No rays yet.
    pub(super) fn none(sensor: SensorId) -> Self {
        let result = SensorResult::with_all_quantities(sensor);
        Self { result, light: Vec::new(), range_differences: Vec::new() }
    }
}

/// Compares one ray and enters it into `rays`. Its class, and the quantity that is worst.
pub(super) fn compare_ray(
    judge: &Judge<'_>,
    place: Place,
    (map_a, a): (&SensorMap, Side<'_>),
    (map_b, b): (&SensorMap, Side<'_>),
    light: &[BeamImages<'_>],
    rays: &mut ComparedRays,
) -> (Class, Quantity) {
    let Place { sensor, i, j } = place;
    let answers = [StatedHit::of(map_a, i, j), StatedHit::of(map_b, i, j)];
    let [of_a, of_b] = answers;
    rays.range_differences.push(of_a.range.zip(of_b.range).map(|(a, b)| b - a).into());
    let mut entry = RayEntry::compared(place, &mut rays.result);
    let hit = compare_hit(judge, &mut entry, answers, [a, b]);
    if map_a.face.is_none() || map_b.face.is_none() {
        entry.missing(Quantity::Face);
    }
    for quantity in HitQuantity::ALL {
        if map_a.raster(quantity).is_none() || map_b.raster(quantity).is_none() {
            entry.missing(Quantity::from(quantity));
        }
    }
    let mut flux_difference = 0.0;
    match sensor {
        SensorId::Camera => compare_pixel(&mut entry, light, judge.scene().beams().len()),
        SensorId::Beam(index) => {
            let returns = [a, b].map(|side| side.output.returns.get(index));
            let pair = compare_return(judge, &mut entry, hit, returns, [a, b]);
            flux_difference = pair.difference();
            rays.light.extend(pair.if_any());
        }
    }

    let (class, item) =
        entry.finish(|| format!("{}: {}; {}: {}", a.name, words(&of_a), b.name, words(&of_b)));
    if class == Class::Approximation {
        let mut causes = Switches::EXACT;
        let mut tally =
            ApproximationTally { rays: 1, flux_changed: flux_difference, ..ApproximationTally::default() };
        for (answer, side) in answers.iter().zip([a, b]) {
            let Some(attributions) = side.attributions else { continue };
            if let Some(cause) = attributions.cause(place) {
                causes = causes.union(cause.switches);
                enter_error(&mut tally, answer, cause, place);
            }
            if let Some(cause) = attributions.visibility_cause(place) {
                causes = causes.union(cause.switches);
            }
        }
        for images in light {
            causes = causes.union(images.causes(i, j));
        }
        rays.result.approximations.entry(causes).or_default().add(&tally);
        rays.result.differing.last_mut().expect("this ray differs").causes = causes;
    }
    (class, item.quantity)
}

/// Enters one side's error of a hit.
fn enter_error(tally: &mut ApproximationTally, answer: &StatedHit<'_>, cause: &Cause, place: Place) {
    match (answer.hits(), cause.restored_range) {
        (false, Some(_)) => tally.lost = 1,
        (true, None) => tally.added = 1,
        _ => {}
    }
    if let (Some(range), Some(restored)) = (answer.range, cause.restored_range) {
        Largest::update(&mut tally.worst_range, (range - restored).abs(), place, None);
    }
}

/// One side's answer in words.
fn words(answer: &StatedHit<'_>) -> String {
    if !answer.hits() {
        return "no hit".into();
    }
    let face = answer.face.map_or("a face".into(), |face| format!("face {}", face.0));
    let range = answer.range.map_or("unknown range".into(), |range| format!("range {range} m"));
    format!("{face} at {range}")
}
