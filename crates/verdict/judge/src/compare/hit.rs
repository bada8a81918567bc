//! One ray's hit on two sides.

use crate::answer::StatedHit;
use crate::bounds::HitBounds;
use crate::class::Class;
use crate::compare::side::Side;
use crate::difference::{Difference, distance, hit_values};
use crate::entry::RayEntry;
use crate::judge::Judge;
use crate::quantity::{Item, Quantity};
use raypencil_referee::Ruling;
use raypencil_scene::{FaceId, Hit, HitQuantity, Place, Precision};

/// One ray's hit on two sides, compared.
#[derive(Debug, Clone, Copy)]
pub(crate) struct HitComparison<'m> {
    /// The hit that each side states.
    pub(super) answers: [StatedHit<'m>; 2],
    /// The class of hit and face.
    pub(super) class: Class,
    /// Whether both sides name the same face.
    pub(super) same_face: bool,
    /// How far each side may be off; `None` if nothing is known that a bound could be derived from.
    pub(super) bounds: Option<[HitBounds; 2]>,
}

impl HitComparison<'_> {
    /// Whether both sides hit.
    pub(super) fn both_hit(&self) -> bool {
        self.answers.iter().all(StatedHit::hits)
    }
}

/// Compares one ray's hit on two sides, and enters each of its quantities that both state.
pub(super) fn compare_hit<'m>(
    judge: &Judge<'_>,
    entry: &mut RayEntry<'_>,
    answers: [StatedHit<'m>; 2],
    [a, b]: [Side<'_>; 2],
) -> HitComparison<'m> {
    let place = entry.place;
    let [of_a, of_b] = answers;
    let same_face = of_a.face.zip(of_b.face).map(|(x, y)| x == y);
    let differ = of_a.hits() != of_b.hits() || same_face == Some(false);

    // The referee rules on answers that differ and on a sample of the others. An answer that hits a face without
    // naming it cannot be ruled on.
    let is_named = |answer: &StatedHit<'_>| !answer.hits() || answer.face.is_some();
    let ruled = (is_named(&of_a) && is_named(&of_b) && (differ || judge.samples(place))).then(|| {
        entry.judged();
        let rule = |answer: &StatedHit<'_>, side: Side<'_>| {
            judge.rule(place, answer.face, answer.range, side.precision)
        };
        let of_first = rule(&of_a, a);
        // The exact answer and a tie are so for any arithmetic.
        let is_settled = matches!(of_first, Ruling::Exact | Ruling::Tie) && of_a.face == of_b.face && !differ;
        let rulings = [of_first, if is_settled { of_first } else { rule(&of_b, b) }];
        let class_of = |(ruling, side): (Ruling, Side<'_>)| {
            Class::of(ruling, side.attributions.is_some_and(|causes| causes.cause(place).is_some()))
        };
        let [of_a, of_b] = [(rulings[0], a), (rulings[1], b)].map(class_of);
        of_a.max(of_b)
    });
    // Answers without a ruling agree only if they are the same.
    let class = ruled.unwrap_or(if differ { Class::Defect } else { Class::Agree });
    let mut compared = HitComparison { answers, class, same_face: same_face == Some(true), bounds: None };
    entry.class(Quantity::Hit, if compared.both_hit() { Class::Agree } else { class });
    if !compared.both_hit() {
        return compared;
    }

    let scene = judge.scene();
    let ray = scene.ray(place.sensor, place.i, place.j).expect("a cell of this sensor");
    // Without a face or a range there is nothing to derive a bound from: only equal values agree.
    let mesh = scene.mesh();
    let known = |answer: &StatedHit<'_>| answer.face.filter(|face| (face.0 as usize) < mesh.faces().len());
    let bounds_of = |answer: &StatedHit<'_>, other: &StatedHit<'_>, precision| {
        let face = known(answer).or(known(other));
        let range = answer.range.or(other.range);
        face.zip(range).map(|(face, range)| HitBounds::of(mesh, face, &ray, range, precision))
    };
    compared.bounds = bounds_of(&of_a, &of_b, a.precision)
        .zip(bounds_of(&of_b, &of_a, b.precision))
        .map(|(of_a, of_b)| [of_a, of_b]);
    let bounds = compared.bounds.map(|[of_a, of_b]| of_a.plus(&of_b));
    // Each side's values must be those of the face that it names itself, whatever the other side states.
    if ruled.is_some() {
        let mut exact: Option<(FaceId, Option<Hit>)> = None;
        for (answer, side) in answers.iter().zip([a, b]) {
            let Some(face) = answer.face else { continue };
            let hit = match exact {
                Some((of, hit)) if of == face => hit,
                _ => judge.plane_hit(place, face),
            };
            exact = Some((face, hit));
            entry.force_defect(hit.and_then(|hit| item_off_its_face(judge, place, answer, side, &hit)));
        }
    }
    if same_face.is_some() {
        entry.class(Quantity::Face, class);
    }
    // Two faces at one point have the same range, and each its own normal. The values of two faces at different
    // points have nothing to do with each other.
    let is_one_point = same_face != Some(false) || class == Class::Tie;
    let is_one_face = same_face != Some(false);
    // Numbers come before vectors, as in `item_off_its_face`.
    let in_order =
        |are_vectors: bool| HitQuantity::ALL.into_iter().filter(move |one| one.is_vector() == are_vectors);
    for quantity in in_order(false).chain(in_order(true)) {
        let is_comparable = if quantity.is_of_point() { is_one_point } else { is_one_face };
        let values = of_a.value(quantity).zip(of_b.value(quantity)).filter(|_| is_comparable);
        if let Some((of_a, of_b)) = values {
            let bound = bounds.map(|bounds| bounds.of_quantity(quantity));
            let item = Quantity::from(quantity);
            entry.difference(&Difference::computed(item, distance(&of_a, &of_b), bound), Class::Agree);
        }
    }
    compared
}

/// The item of an answer, if any, that is not within its bound of the `exact` values of the face that it names. Numbers
/// come before vectors.
fn item_off_its_face(
    judge: &Judge<'_>,
    place: Place,
    answer: &StatedHit<'_>,
    side: Side<'_>,
    exact: &Hit,
) -> Option<Item> {
    let scene = judge.scene();
    let ray = scene.ray(place.sensor, place.i, place.j)?;
    let bounds = |precision| HitBounds::of_exact(scene, &ray, exact, precision);
    // The exact values are the referee's, rounded to f64.
    let bounds = bounds(side.precision).plus(&bounds(Precision::F64));
    let values = hit_values(answer, exact, &bounds);
    let is_off = |is_scalar: bool| {
        values.iter().find(move |value| value.is_scalar() == is_scalar && !value.difference().is_within())
    };
    is_off(true).or(is_off(false)).map(|value| value.item)
}
