//! One pencil of two frames: whether the camera sees its hit, where, and what it delivers.

use raypencil_scanline::Switches;
use raypencil_scene::{FaceId, Pixel, Returns, SensorId};

use super::ray::{Entry, Geometry};
use super::{Class, Place, Quantity, Side};
use crate::bounds::{ReturnBounds, Returned};
use crate::judge::Judge;

/// What one side says comes back of a pencil.
#[derive(Debug, Clone, Copy)]
struct Back {
    visible: Option<bool>,
    /// `Some(None)`: it lands on no pixel.
    pixel: Option<Option<Pixel>>,
    depth: Option<f64>,
    off_axis: Option<f64>,
    emission: Option<f64>,
    flux: Option<f64>,
}

impl Back {
    fn of(returns: &Returns, i: u32, j: u32) -> Self {
        Self {
            visible: returns.visible.as_ref().map(|image| image.at(i, j)),
            pixel: returns.pixel.as_ref().map(|image| image.at(i, j).get()),
            depth: returns.depth.as_ref().and_then(|image| image.at(i, j).get()),
            off_axis: returns.off_axis.as_ref().and_then(|image| image.at(i, j).get()),
            emission: returns.emission.as_ref().and_then(|image| image.at(i, j).get()),
            flux: returns.flux.as_ref().map(|image| image.at(i, j)),
        }
    }
}

/// What a pencil delivers on each side.
#[derive(Debug, Clone, Copy)]
pub(super) struct PencilLight {
    /// The worst class of the pencil's quantities.
    pub(super) class: Class,
    /// The switches that are its cause, if that is an approximation.
    pub(super) causes: Switches,
    /// Where, and how much.
    pub(super) delivered: [Option<(Pixel, f64)>; 2],
    /// How far the two amounts may differ.
    pub(super) bound: f64,
}

impl PencilLight {
    /// This, if either side delivers anything.
    pub(super) fn if_any(self) -> Option<Self> {
        self.delivered.iter().any(Option::is_some).then_some(self)
    }

    /// By how much the two amounts differ.
    pub(super) fn difference(&self) -> f64 {
        let [a, b] = self.delivered.map(|delivered| delivered.map_or(0.0, |(_, flux)| flux));
        (a - b).abs()
    }
}

/// The quantities of a pencil's return.
const QUANTITIES: [Quantity; 6] = [
    Quantity::Visible,
    Quantity::Pixel,
    Quantity::CameraDepth,
    Quantity::OffAxis,
    Quantity::Emission,
    Quantity::PencilFlux,
];

/// Compares what comes back of one pencil.
pub(super) fn compare_pencil(
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
    let faces = geometry.answers.map(|answer| answer.face);

    // Whether it is seen, and where it lands.
    let [mut of_visible, mut of_pixel] = [Class::Agree; 2];
    if is_one_point {
        if differ || judge.samples(place) {
            for ((back, face), (side, answer)) in
                [of_a, of_b].iter().zip(faces).zip(sides.iter().zip(geometry.answers))
            {
                let [visible, pixel] = ruled(judge, entry, *side, face, answer.range, back);
                (of_visible, of_pixel) = (of_visible.max(visible), of_pixel.max(pixel));
            }
        }
    } else {
        // What is said of nothing must be nothing; of another face, it is as right as that face.
        let unlike = |same: bool| if same { Class::Agree } else { geometry.class };
        of_visible = unlike(of_a.visible == of_b.visible);
        of_pixel = unlike(of_a.pixel == of_b.pixel);
        for (back, answer) in [of_a, of_b].iter().zip(geometry.answers) {
            if !answer.hit && (back.visible == Some(true) || back.flux.is_some_and(|flux| flux != 0.0)) {
                of_visible = Class::Defect;
            }
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
        (Quantity::OffAxis, of_a.off_axis, of_b.off_axis, bounds.map(|bounds| bounds.off_axis), true),
        (
            Quantity::Emission,
            of_a.emission,
            of_b.emission,
            bounds.map(|bounds| bounds.emission),
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
        if difference == 0.0 || difference <= bound {
            entry.value(Quantity::PencilFlux, difference, Some(bound));
        } else {
            // It goes with whether and where the point is seen, and with what is hit.
            let excuse = of_visible.max(of_pixel).max(if is_one_point && geometry.same_face {
                Class::Agree
            } else {
                geometry.class
            });
            entry.class(Quantity::PencilFlux, if excuse == Class::Agree { Class::Defect } else { excuse });
        }
    } else {
        entry.missing(Quantity::PencilFlux);
    }
    light.class = entry.worst();
    if light.class == Class::Approximation {
        for attributions in sides.iter().filter_map(|side| side.attributions) {
            let of_geometry = attributions.cause(place).map(|cause| cause.switches);
            let of_sight = attributions.sight_cause(place).map(|cause| cause.switches);
            for switches in of_geometry.into_iter().chain(of_sight) {
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

/// The classes of one side's answers about visibility and pixel.
fn ruled(
    judge: &Judge<'_>,
    entry: &Entry<'_>,
    side: Side<'_>,
    face: Option<FaceId>,
    range: Option<f64>,
    back: &Back,
) -> [Class; 2] {
    let (Some(face), Some(visible), Some(pixel)) = (face, back.visible, back.pixel) else {
        // What cannot be named cannot be ruled on.
        return [Class::Agree; 2];
    };
    let has_cause = side.attributions.is_some_and(|causes| causes.sight_cause(entry.place).is_some());
    match judge.rule_sight(entry.place, face, range, visible, pixel, side.resolution) {
        Some(ruling) => [Class::of(ruling.visible, has_cause), Class::of(ruling.pixel, false)],
        None => [Class::Defect; 2],
    }
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
            incidence: answer.incidence?,
            depth: back.depth?,
            off_axis: back.off_axis?,
            emission: back.emission?,
            distance: match answer.point {
                Some(point) => point.distance(judge.scene().camera().scene_from_sensor.position),
                None => (back.depth? / back.off_axis?).abs(),
            },
        };
        Some(ReturnBounds::of(judge.scene(), (beam, place.i), &bounds[k], values, sides[k].resolution))
    };
    Some(of(0)?.plus(&of(1)?))
}
