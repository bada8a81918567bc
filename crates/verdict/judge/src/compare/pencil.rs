//! One pencil's return on two sides: whether the camera sees the hit, in which pixel it lands, and its flux.

use crate::answer::StatedReturn;
use crate::bounds::{HitBounds, ReturnBounds, ReturnValues};
use crate::class::Class;
use crate::compare::flux_pair::FluxPair;
use crate::compare::hit::HitComparison;
use crate::compare::side::Side;
use crate::difference::{Difference, StatedValue, return_values};
use crate::entry::RayEntry;
use crate::judge::Judge;
use crate::quantity::{Item, Quantity, RETURN_QUANTITIES};
use raypencil_scene::{FaceId, Place, Precision, Returns, SensorId};

/// Compares the return of one pencil, whose hit is compared already.
pub(super) fn compare_return(
    judge: &Judge<'_>,
    entry: &mut RayEntry<'_>,
    hit: HitComparison<'_>,
    returns: [Option<&Returns>; 2],
    sides: [Side<'_>; 2],
) -> FluxPair {
    let place = entry.place;
    let mut pair = FluxPair::NOTHING;
    let stated = returns.map(|returns| Some(StatedReturn::of(returns?, None, place.i, place.j)));
    let [Some(of_a), Some(of_b)] = stated else {
        RETURN_QUANTITIES.into_iter().for_each(|quantity| entry.missing(quantity));
        return pair;
    };
    // Both are answers about the same point, or about two that have nothing to do with each other.
    let both_hit = hit.both_hit();
    let is_one_point = both_hit && (hit.same_face || hit.class == Class::Tie);
    let differ = of_a.visible != of_b.visible || of_a.pixel != of_b.pixel;

    // Visibility and pixel: each side is ruled on by the face that it names itself.
    let [mut of_visible, mut of_pixel] = [Class::Agree; 2];
    let any_hits = hit.answers.iter().any(|answer| answer.hits());
    if differ || !is_one_point && any_hits || judge.samples(place) {
        entry.judged();
        for ((stated, answer), side) in [of_a, of_b].iter().zip(hit.answers).zip(sides) {
            let Some(face) = answer.face.filter(|_| answer.hits()) else { continue };
            match rule(judge, entry, side, face, answer.range, stated) {
                Some([visible, pixel]) => {
                    (of_visible, of_pixel) = (of_visible.max(visible), of_pixel.max(pixel));
                }
                // Answers without a ruling agree only if they are the same.
                None if differ => (of_visible, of_pixel) = (Class::Defect, Class::Defect),
                None => {}
            }
        }
    }
    if !is_one_point {
        // At two points, visibility and pixel may differ: that is of the class of the hits.
        of_visible = of_visible.max(if of_a.visible == of_b.visible { Class::Agree } else { hit.class });
        of_pixel = of_pixel.max(if of_a.pixel == of_b.pixel { Class::Agree } else { hit.class });
    }
    for (stated, answer) in [of_a, of_b].iter().zip(hit.answers) {
        // A visible hit lands in a pixel; a hidden one, or none, delivers nothing.
        let delivers = stated.flux[0].is_some_and(|flux| flux != 0.0);
        let is_visible = stated.visible == Some(true);
        let contradicts = is_visible && (stated.pixel == Some(None) || !answer.hits())
            || delivers && (stated.visible == Some(false) || !answer.hits());
        if contradicts {
            of_visible = Class::Defect;
        }
    }
    match of_a.visible.zip(of_b.visible) {
        Some(_) => entry.class(Quantity::Visible, of_visible),
        None => entry.missing(Quantity::Visible),
    }
    match of_a.pixel.zip(of_b.pixel) {
        Some(_) => entry.class(Quantity::Pixel, of_pixel),
        None => entry.missing(Quantity::Pixel),
    }

    // The values of one point.
    let bounds = is_one_point.then(|| bounds_of_both(judge, &hit, [&of_a, &of_b], place, sides)).flatten();
    let scalars = [
        (Quantity::CameraDepth, of_a.depth, of_b.depth, bounds.map(|bounds| bounds.depth), true),
        (
            Quantity::CosOffAxis,
            of_a.cos_off_axis,
            of_b.cos_off_axis,
            bounds.map(|bounds| bounds.cos_off_axis),
            true,
        ),
        (
            Quantity::CosView,
            of_a.cos_view,
            of_b.cos_view,
            bounds.map(|bounds| bounds.cos_view),
            hit.same_face,
        ),
    ];
    for (quantity, x, y, bound, is_comparable) in scalars {
        match (x, y) {
            (Some(x), Some(y)) if is_one_point && is_comparable => {
                entry.difference(&Difference::computed(quantity, (x - y).abs(), bound), Class::Agree);
            }
            _ if both_hit && (x.is_none() || y.is_none()) => entry.missing(quantity),
            _ => {}
        }
    }

    if let (Some(x), Some(y)) = (of_a.flux[0], of_b.flux[0]) {
        let bound = bounds.map_or(0.0, |bounds| bounds.of_flux(x.abs().max(y.abs())));
        pair.bound = bound;
        let difference = Difference::computed(Quantity::PencilFlux, (x - y).abs(), Some(bound));
        // Tied faces have cosines of their own: the difference of their fluxes is no error of either.
        if difference.error == 0.0 || hit.same_face && difference.is_within() {
            entry.difference(&difference, Class::Agree);
        } else {
            // It is of the class of the hit, the visibility or the pixel; without such an excuse a defect.
            let of_face = if is_one_point && hit.same_face { Class::Agree } else { hit.class };
            let excuse = of_visible.max(of_pixel).max(of_face);
            entry.class(Quantity::PencilFlux, if excuse == Class::Agree { Class::Defect } else { excuse });
        }
    } else {
        entry.missing(Quantity::PencilFlux);
    }
    pair.class = entry.worst();
    if pair.class == Class::Approximation {
        for attributions in sides.iter().filter_map(|side| side.attributions) {
            let of_hit = attributions.cause(place).map(|cause| cause.switches);
            let of_visibility = attributions.visibility_cause(place).map(|cause| cause.switches);
            for switches in of_hit.into_iter().chain(of_visibility) {
                pair.causes = pair.causes.union(switches);
            }
        }
    }
    pair.delivered = [of_a, of_b].map(|stated| {
        let flux = stated.flux[0].filter(|_| stated.visible != Some(false))?;
        stated.pixel.flatten().map(|pixel| (pixel, flux))
    });
    pair
}

/// The classes of one side's visibility and pixel; `None` if it does not state both. Its values are held to the
/// referee's for the face, the visibility and the pixel that it states.
fn rule(
    judge: &Judge<'_>,
    entry: &mut RayEntry<'_>,
    side: Side<'_>,
    face: FaceId,
    range: Option<f64>,
    stated: &StatedReturn,
) -> Option<[Class; 2]> {
    let place = entry.place;
    let (visible, pixel) = (stated.visible?, stated.pixel?);
    entry.force_defect(item_off_its_face(judge, place, side, face, stated));
    let has_cause = side.attributions.is_some_and(|causes| causes.visibility_cause(place).is_some());
    Some(match judge.rule_visibility(place, face, range, visible, pixel, side.precision) {
        Some(ruling) => [Class::of(ruling.visible, has_cause), Class::of(ruling.pixel, false)],
        None => [Class::Defect; 2],
    })
}

/// The item of a return, if any, that is not within its bound of the return from the face that is named.
fn item_off_its_face(
    judge: &Judge<'_>,
    place: Place,
    side: Side<'_>,
    face: FaceId,
    stated: &StatedReturn,
) -> Option<Item> {
    let (scene, SensorId::Beam(beam)) = (judge.scene(), place.sensor) else { return None };
    let hit = judge.plane_hit(place, face)?;
    let exact = judge.returned_as(place, face, stated.visible?, stated.pixel?)?;
    let ray = scene.ray(place.sensor, place.i, place.j)?;
    let values = ReturnValues::of_exact(scene, &hit, &exact);
    let bounds = |precision| {
        let of_hit = HitBounds::of_exact(scene, &ray, &hit, precision);
        ReturnBounds::of(scene, (beam, place.i), &of_hit, values, precision, scene.flux_model())
    };
    // The referee's values are rounded to f64.
    let bounds = bounds(side.precision).plus(&bounds(Precision::F64));
    // A back that rule 1b adds has a negative cos(psi), and delivers nothing by equation (1). CHOICE: see
    // `docs/theory/radiometry.md`.
    let flux = exact.flux.max(0.0);
    let flux = StatedValue::scalar(Quantity::PencilFlux, stated.flux[0], flux, bounds.of_flux(flux));
    let mut values = return_values(stated, &exact, &bounds).chain(flux);
    values.find(|value| !value.difference().is_within()).map(|value| value.item)
}

/// How far the values of two returns from one point may differ; `None` if a side leaves out what that depends on.
fn bounds_of_both(
    judge: &Judge<'_>,
    hit: &HitComparison<'_>,
    stated: [&StatedReturn; 2],
    place: Place,
    sides: [Side<'_>; 2],
) -> Option<ReturnBounds> {
    let (scene, SensorId::Beam(beam)) = (judge.scene(), place.sensor) else { return None };
    let bounds = hit.bounds?;
    let of = |k: usize| {
        let values = ReturnValues::of_stated(scene, &hit.answers[k], stated[k])?;
        let (pencil, precision) = ((beam, place.i), sides[k].precision);
        Some(ReturnBounds::of(scene, pencil, &bounds[k], values, precision, scene.flux_model()))
    };
    Some(of(0)?.plus(&of(1)?))
}
