//! One pencil of two frames: whether the camera sees its hit, where, and what it delivers.

use crate::bounds::{Bounds, ReturnBounds, Returned};
use crate::class::{Class, Quantity};
use crate::compare::answer::Back;
use crate::compare::entry::{Entry, Geometry};
use crate::compare::light::PencilLight;
use crate::compare::side::Side;
use crate::judge::Judge;
use raypencil_scene::Place;
use raypencil_scene::{FaceId, Precision, Returns, SensorId, Switches};

/// The quantities of a pencil's return.
const QUANTITIES: [Quantity; 6] = [
    Quantity::Visible,
    Quantity::Pixel,
    Quantity::CameraDepth,
    Quantity::CosOffAxis,
    Quantity::CosView,
    Quantity::PencilFlux,
];

/// Compares what comes back of one pencil.
pub(crate) fn compare_pencil(
    judge: &Judge<'_>,
    entry: &mut Entry<'_>,
    geometry: Geometry,
    returns: [Option<&Returns>; 2],
    sides: [Side<'_>; 2],
) -> PencilLight {
    let place = entry.place;
    let mut light =
        PencilLight { class: Class::Agree, causes: Switches::EXACT, delivered: [None; 2], bound: 0.0 };
    let [Some(of_a), Some(of_b)] = returns.map(|returns| Some(Back::of(returns?, place.i, place.j))) else {
        QUANTITIES.into_iter().for_each(|quantity| entry.missing(quantity));
        return light;
    };
    // Both are answers about the same point, or about two that have nothing to do with each other.
    let both_hit = geometry.answers.iter().all(|answer| answer.hit);
    let is_one_point = both_hit && (geometry.same_face || geometry.class == Class::Tie);
    let differ = of_a.visible != of_b.visible || of_a.pixel != of_b.pixel;

    // Whether it is seen, and where it lands: each side by the face that it names itself.
    let [mut of_visible, mut of_pixel] = [Class::Agree; 2];
    if differ || !is_one_point && geometry.answers.iter().any(|answer| answer.hit) || judge.samples(place) {
        entry.judged();
        for ((back, answer), side) in [of_a, of_b].iter().zip(geometry.answers).zip(sides) {
            let Some(face) = answer.face.filter(|_| answer.hit) else { continue };
            match ruled(judge, entry, side, face, answer.range, back) {
                Some([visible, pixel]) => {
                    (of_visible, of_pixel) = (of_visible.max(visible), of_pixel.max(pixel));
                }
                // Answers that cannot be named can only be compared by being the same.
                None if differ => (of_visible, of_pixel) = (Class::Defect, Class::Defect),
                None => {}
            }
        }
    }
    if !is_one_point {
        // Two points have nothing to do with each other: what differs goes with what is hit.
        of_visible = of_visible.max(if of_a.visible == of_b.visible { Class::Agree } else { geometry.class });
        of_pixel = of_pixel.max(if of_a.pixel == of_b.pixel { Class::Agree } else { geometry.class });
    }
    for (back, answer) in [of_a, of_b].iter().zip(geometry.answers) {
        // What is seen lands somewhere; what is not seen, or not hit, delivers nothing.
        let delivers = back.flux.is_some_and(|flux| flux != 0.0);
        let is_seen = back.visible == Some(true);
        let contradicts = is_seen && (back.pixel == Some(None) || !answer.hit)
            || delivers && (back.visible == Some(false) || !answer.hit);
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
    let bounds =
        is_one_point.then(|| return_bounds(judge, &geometry, [&of_a, &of_b], place, sides)).flatten();
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
            geometry.same_face,
        ),
    ];
    for (quantity, x, y, bound, comparable) in scalars {
        match (x, y) {
            (Some(x), Some(y)) if is_one_point && comparable => {
                entry.value(quantity, (x - y).abs(), bound);
            }
            _ if both_hit && (x.is_none() || y.is_none()) => entry.missing(quantity),
            _ => {}
        }
    }

    // What it delivers.
    if let (Some(x), Some(y)) = (of_a.flux, of_b.flux) {
        let bound = bounds.map_or(0.0, |bounds| bounds.flux * x.abs().max(y.abs()) + bounds.least_flux);
        light.bound = bound;
        let difference = (x - y).abs();
        // Tied faces have cosines of their own: by how much their fluxes differ is no error of either.
        if difference == 0.0 || geometry.same_face && difference <= bound {
            entry.value(Quantity::PencilFlux, difference, Some(bound));
        } else {
            // It goes with whether and where the point is seen, and with what is hit.
            let of_face = if is_one_point && geometry.same_face { Class::Agree } else { geometry.class };
            let excuse = of_visible.max(of_pixel).max(of_face);
            entry.class(Quantity::PencilFlux, if excuse == Class::Agree { Class::Defect } else { excuse });
        }
    } else {
        entry.missing(Quantity::PencilFlux);
    }
    light.class = entry.worst();
    if light.class == Class::Approximation {
        for attributions in sides.iter().filter_map(|side| side.attributions) {
            let of_geometry = attributions.cause(place).map(|cause| cause.switches);
            let of_visibility = attributions.visibility_cause(place).map(|cause| cause.switches);
            for switches in of_geometry.into_iter().chain(of_visibility) {
                light.causes = light.causes.union(switches);
            }
        }
    }
    light.delivered = [of_a, of_b].map(|back| {
        let flux = back.flux.filter(|_| back.visible != Some(false))?;
        back.pixel.flatten().map(|pixel| (pixel, flux))
    });
    light
}

/// The classes of one side's answers about visibility and pixel; `None` if they cannot be named. Its values are held to
/// the referee's for the face, the visibility and the pixel that it says.
fn ruled(
    judge: &Judge<'_>,
    entry: &mut Entry<'_>,
    side: Side<'_>,
    face: FaceId,
    range: Option<f64>,
    back: &Back,
) -> Option<[Class; 2]> {
    let place = entry.place;
    let (visible, pixel) = (back.visible?, back.pixel?);
    entry.spoil(off_its_face(judge, place, side, face, back));
    let has_cause = side.attributions.is_some_and(|causes| causes.visibility_cause(place).is_some());
    Some(match judge.rule_visibility(place, face, range, visible, pixel, side.precision) {
        Some(ruling) => [Class::of(ruling.visible, has_cause), Class::of(ruling.pixel, false)],
        None => [Class::Defect; 2],
    })
}

/// The quantity of what comes back, if any, that is not within its bound of what comes back of the face named.
fn off_its_face(
    judge: &Judge<'_>,
    place: Place,
    side: Side<'_>,
    face: FaceId,
    back: &Back,
) -> Option<Quantity> {
    let (scene, SensorId::Beam(beam)) = (judge.scene(), place.sensor) else { return None };
    let hit = judge.plane_hit(place, face)?;
    let exact = judge.returned_as(place, face, back.visible?, back.pixel?)?;
    let ray = scene.ray(place.sensor, place.i, place.j)?;
    let values = Returned {
        range: hit.range,
        cos_incidence: hit.cos_incidence,
        depth: exact.depth,
        cos_off_axis: exact.cos_off_axis,
        cos_view: exact.cos_view,
        distance: hit.point.distance(scene.camera().scene_from_sensor.position),
    };
    let bounds = |precision| {
        let of_hit = Bounds::of(scene.mesh(), face, &ray, hit.range, precision);
        ReturnBounds::of(scene, (beam, place.i), &of_hit, values, precision, scene.flux_model())
    };
    // The referee's values are rounded to f64.
    let bounds = bounds(side.precision).plus(&bounds(Precision::F64));
    // A negative cos(psi), of a back that rule 1b adds, delivers nothing by equation (1). CHOICE: see `docs/theory/radiometry.md`.
    let flux = exact.flux.max(0.0);
    let all = [
        (Quantity::CameraDepth, back.depth, exact.depth, bounds.depth),
        (Quantity::CosOffAxis, back.cos_off_axis, exact.cos_off_axis, bounds.cos_off_axis),
        (Quantity::CosView, back.cos_view, exact.cos_view, bounds.cos_view),
        (Quantity::PencilFlux, back.flux, flux, bounds.flux * flux + bounds.least_flux),
    ];
    // What is not a number is off.
    let off = |said: f64, exact: f64, bound: f64| !(said == exact || (said - exact).abs() <= bound);
    all.into_iter()
        .find(|(_, said, exact, bound)| said.is_some_and(|said| off(said, *exact, *bound)))
        .map(|(quantity, ..)| quantity)
}

fn return_bounds(
    judge: &Judge<'_>,
    geometry: &Geometry,
    backs: [&Back; 2],
    place: Place,
    sides: [Side<'_>; 2],
) -> Option<ReturnBounds> {
    let SensorId::Beam(beam) = place.sensor else { return None };
    let bounds = geometry.bounds?;
    let of = |k: usize| {
        let (answer, back) = (&geometry.answers[k], backs[k]);
        let values = Returned {
            range: answer.range?,
            cos_incidence: answer.cos_incidence?,
            depth: back.depth?,
            cos_off_axis: back.cos_off_axis?,
            cos_view: back.cos_view?,
            distance: match answer.point {
                Some(point) => point.distance(judge.scene().camera().scene_from_sensor.position),
                None => (back.depth? / back.cos_off_axis?).abs(),
            },
        };
        let model = judge.scene().flux_model();
        Some(ReturnBounds::of(judge.scene(), (beam, place.i), &bounds[k], values, sides[k].precision, model))
    };
    Some(of(0)?.plus(&of(1)?))
}
