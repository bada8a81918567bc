//! One ray of two frames: what it meets.

use crate::attribution::cause::Cause;
use crate::bounds::Bounds;
use crate::class::{Class, Quantity};
use crate::compare::answer::Answer;
use crate::compare::entry::{Entry, Gathered, Geometry};
use crate::compare::pencil::compare_pencil;
use crate::compare::pixel::{PixelLight, compare_pixel};
use crate::compare::side::Side;
use crate::judge::Judge;
use crate::tally::{ApproximationTally, DEFECTS_DESCRIBED, Defect, Worst};
use raypencil_scene::Place;
use raypencil_scene::{Precision, SensorId, SensorMap, Switches};

/// Compares one ray and enters it into `row`. Its class, and the quantity that is worst.
pub(crate) fn compare_ray(
    judge: &Judge<'_>,
    place: Place,
    (map_a, a): (&SensorMap, Side<'_>),
    (map_b, b): (&SensorMap, Side<'_>),
    light: &[PixelLight<'_>],
    row: &mut Gathered,
) -> (Class, Quantity) {
    let Place { sensor, i, j } = place;
    let answers = [Answer::of(map_a, i, j), Answer::of(map_b, i, j)];
    let mut entry =
        Entry { place, row, worst: (Class::Agree, Quantity::Hit), is_judged: false, spoilt: None };
    let geometry = compare_geometry(judge, &mut entry, answers, [a, b]);
    for quantity in Quantity::ALL {
        let missing = match quantity {
            Quantity::Face => map_a.face.is_none() || map_b.face.is_none(),
            Quantity::Range => map_a.range.is_none() || map_b.range.is_none(),
            Quantity::Depth => map_a.depth.is_none() || map_b.depth.is_none(),
            Quantity::Point => map_a.point.is_none() || map_b.point.is_none(),
            Quantity::Normal => map_a.normal.is_none() || map_b.normal.is_none(),
            Quantity::CosIncidence => map_a.cos_incidence.is_none() || map_b.cos_incidence.is_none(),
            _ => false,
        };
        if missing {
            entry.missing(quantity);
        }
    }
    let mut flux_difference = 0.0;
    match sensor {
        SensorId::Camera => compare_pixel(&mut entry, light, judge.scene().beams().len()),
        SensorId::Beam(index) => {
            let returns = [a, b].map(|side| side.output.returns.get(index));
            let delivered = compare_pencil(judge, &mut entry, geometry, returns, [a, b]);
            flux_difference = delivered.difference();
            entry.row.light.extend(delivered.if_any());
        }
    }

    if let Some(quantity) = entry.spoilt
        && entry.worst.0 < Class::Defect
    {
        // Nothing of that quantity was compared between the sides.
        entry.class(quantity, Class::Defect);
    }
    let Entry { worst: (class, quantity), row, .. } = entry;
    row.by_class[class as usize] += 1;
    if class == Class::Approximation {
        let mut causes = Switches::EXACT;
        let mut tally =
            ApproximationTally { rays: 1, flux_changed: flux_difference, ..ApproximationTally::default() };
        for (answer, side) in answers.iter().zip([a, b]) {
            let Some(attributions) = side.attributions else { continue };
            if let Some(cause) = attributions.cause(place) {
                causes = causes.union(cause.switches);
                tally.enter(answer, cause, place);
            }
            if let Some(cause) = attributions.visibility_cause(place) {
                causes = causes.union(cause.switches);
            }
        }
        for light in light {
            causes = causes.union(light.causes(i, j));
        }
        row.approximations.entry(causes).or_default().add(&tally);
    }
    if class == Class::Defect && row.defects.len() < DEFECTS_DESCRIBED {
        let [of_a, of_b] = answers;
        let what = format!("{}: {}; {}: {}", a.name, describe(&of_a), b.name, describe(&of_b));
        row.defects.push(Defect { place, quantity, what });
    }
    (class, quantity)
}

/// Compares what one ray meets.
fn compare_geometry(
    judge: &Judge<'_>,
    entry: &mut Entry<'_>,
    answers: [Answer; 2],
    [a, b]: [Side<'_>; 2],
) -> Geometry {
    let Place { sensor, i, j } = entry.place;
    let [of_a, of_b] = answers;
    entry.row.differences.push(of_a.range.zip(of_b.range).map(|(a, b)| b - a).into());
    let same_face = of_a.face.zip(of_b.face).map(|(x, y)| x == y);
    let differ = of_a.hit != of_b.hit || same_face == Some(false);

    // What the referee says of both answers, if it is asked and they can be named.
    let place = entry.place;
    let named = |answer: &Answer| !answer.hit || answer.face.is_some();
    let ruled = (named(&of_a) && named(&of_b) && (differ || judge.samples(place))).then(|| {
        entry.judged();
        let class_of = |answer: &Answer, side: Side<'_>| {
            let ruling = judge.rule(place, answer.face, answer.range, side.precision);
            Class::of(ruling, side.attributions.is_some_and(|causes| causes.cause(place).is_some()))
        };
        class_of(&of_a, a).max(class_of(&of_b, b))
    });
    // Answers that cannot be named can only be compared by being the same.
    let class = ruled.unwrap_or(if differ { Class::Defect } else { Class::Agree });
    let both_hit = of_a.hit && of_b.hit;
    entry.class(Quantity::Hit, if both_hit { Class::Agree } else { class });
    let mut geometry = Geometry { answers, class, same_face: same_face == Some(true), bounds: None };
    if !both_hit {
        return geometry;
    }

    let scene = judge.scene();
    let ray = scene.ray(sensor, i, j).expect("a cell of this sensor");
    // Without faces or ranges there is nothing to derive a bound from: only exactness agrees.
    let mesh = scene.mesh();
    let known = |answer: &Answer| answer.face.filter(|face| (face.0 as usize) < mesh.faces().len());
    let bounds_of = |answer: &Answer, other: &Answer, precision| {
        let face = known(answer).or(known(other));
        let range = answer.range.or(other.range);
        face.zip(range).map(|(face, range)| Bounds::of(mesh, face, &ray, range, precision))
    };
    geometry.bounds = bounds_of(&of_a, &of_b, a.precision)
        .zip(bounds_of(&of_b, &of_a, b.precision))
        .map(|(of_a, of_b)| [of_a, of_b]);
    let bounds = geometry.bounds.map(|[of_a, of_b]| of_a.plus(&of_b));
    // Each side's values must be those of the face that it names itself, whatever the other says.
    if ruled.is_some() {
        for (answer, side) in answers.iter().zip([a, b]) {
            entry.spoil(off_its_face(judge, place, answer, side));
        }
    }
    if same_face.is_some() {
        entry.class(Quantity::Face, class);
    }
    // Two faces at one point have the same range, and each its own normal. The values of two faces at different
    // points have nothing to do with each other.
    let is_one_point = same_face != Some(false) || class == Class::Tie;
    let is_one_face = same_face != Some(false);
    let scalars = [
        (Quantity::Range, of_a.range.zip(of_b.range), bounds.map(|bounds| bounds.range), is_one_point),
        (Quantity::Depth, of_a.depth.zip(of_b.depth), bounds.map(|bounds| bounds.range), is_one_point),
        (
            Quantity::CosIncidence,
            of_a.cos_incidence.zip(of_b.cos_incidence),
            bounds.map(|bounds| bounds.cos_incidence),
            is_one_face,
        ),
    ];
    for (quantity, values, bound, _) in scalars.into_iter().filter(|(.., comparable)| *comparable) {
        if let Some((x, y)) = values {
            entry.value(quantity, (x - y).abs(), bound);
        }
    }
    let vectors = [
        (Quantity::Point, of_a.point.zip(of_b.point), bounds.map(|bounds| bounds.point), is_one_point),
        (Quantity::Normal, of_a.normal.zip(of_b.normal), bounds.map(|bounds| bounds.normal), is_one_face),
    ];
    for (quantity, values, bound, _) in vectors.into_iter().filter(|(.., comparable)| *comparable) {
        if let Some((x, y)) = values {
            entry.value(quantity, (x - y).length(), bound);
        }
    }
    geometry
}

/// The quantity of an answer, if any, that is not within its bound of the values of the face that it names.
fn off_its_face(judge: &Judge<'_>, place: Place, answer: &Answer, side: Side<'_>) -> Option<Quantity> {
    let (face, scene) = (answer.face?, judge.scene());
    let exact = judge.plane_hit(place, face)?;
    let ray = scene.ray(place.sensor, place.i, place.j)?;
    let bounds = |precision| Bounds::of(scene.mesh(), face, &ray, exact.range, precision);
    // The values are the referee's in f64.
    let bounds = bounds(side.precision).plus(&bounds(Precision::F64));
    let scalars = [
        (Quantity::Range, answer.range, exact.range, bounds.range),
        (Quantity::Depth, answer.depth, exact.depth, bounds.range),
        (Quantity::CosIncidence, answer.cos_incidence, exact.cos_incidence, bounds.cos_incidence),
    ];
    let vectors = [
        (Quantity::Point, answer.point, exact.point, bounds.point),
        (Quantity::Normal, answer.normal, exact.normal, bounds.normal),
    ];
    // What is not a number is off.
    let scalar = scalars.into_iter().find(|(_, said, exact, bound)| {
        said.is_some_and(|said| !(said == *exact || (said - exact).abs() <= *bound))
    });
    let vector = vectors
        .into_iter()
        .find(|(_, said, exact, bound)| said.is_some_and(|said| !((said - *exact).length() <= *bound)));
    scalar.map(|(quantity, ..)| quantity).or(vector.map(|(quantity, ..)| quantity))
}

impl ApproximationTally {
    /// Enters one side's error.
    fn enter(&mut self, answer: &Answer, cause: &Cause, place: Place) {
        match (answer.hit, cause.restored_range) {
            (false, Some(_)) => self.lost = 1,
            (true, None) => self.added = 1,
            _ => {}
        }
        if let (Some(range), Some(restored)) = (answer.range, cause.restored_range) {
            Worst::keep(&mut self.worst_range, (range - restored).abs(), place);
        }
    }
}

/// One side's answer in words.
fn describe(answer: &Answer) -> String {
    if !answer.hit {
        return "no hit".into();
    }
    let face = answer.face.map_or("a face".into(), |face| format!("face {}", face.0));
    let range = answer.range.map_or("unknown range".into(), |range| format!("range {range} m"));
    format!("{face} at {range}")
}
