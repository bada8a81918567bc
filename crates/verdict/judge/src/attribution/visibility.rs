//! Causes of wrong visibility.

use rayon::prelude::*;

use crate::attribution::cause::{Attributions, VisibilityCause};
use crate::attribution::context::{AttributionContext, sets_of};
use raypencil_referee::{ExplainedVisibility, Ruling, VisibilityApproximations, VisibilityReason};
use raypencil_scene::{
    FaceId, Fidelity, Pixel, Place, Quantities, RenderOutput, Request, SensorId, Switches,
};

/// Visibility of one pencil's hit as an output states it.
#[derive(Debug, Clone, Copy)]
struct StatedVisibility {
    face: FaceId,
    range: Option<f64>,
    visible: bool,
    pixel: Option<Pixel>,
}

impl StatedVisibility {
    /// `None` where there is no hit, or where the output leaves out a part.
    fn of(output: &RenderOutput, Place { sensor, i, j }: Place) -> Option<Self> {
        let SensorId::Beam(index) = sensor else { return None };
        let (map, returns) = (output.map(sensor)?, output.returns.get(index)?);
        Some(Self {
            face: map.face.as_ref()?.at(i, j).get()?,
            range: map.range.as_ref().and_then(|ranges| ranges.at(i, j).get()),
            visible: returns.visible.as_ref()?.at(i, j),
            pixel: returns.pixel.as_ref()?.at(i, j).get(),
        })
    }
}

/// A pencil whose visibility is not the contract's for the face that it is stated to hit: an admissible face, or one
/// that has a cause.
struct WrongVisibility {
    place: Place,
    answer: StatedVisibility,
    /// The answers that are still wrong with other switches on `exact`, and those switches.
    without: Vec<(Switches, StatedVisibility)>,
    cause: Option<VisibilityCause>,
}

/// The pencils of an output whose visibility is wrong for a confirmed cause.
pub(super) fn causes(
    context: AttributionContext<'_>,
    output: &RenderOutput,
    of_geometry: &Attributions,
) -> Vec<(Place, VisibilityCause)> {
    let Switches { facing, extent, place, .. } = context.switches;
    let of_visibility = Switches { facing, extent, place, ..Switches::EXACT };
    if of_visibility == Switches::EXACT || output.returns.is_empty() {
        return Vec::new();
    }
    let request = Request { camera: false, quantities: Quantities::RANGE_MAP, ..Request::EVERYTHING };
    let extent_m = upper_extent(context, output);

    // The pencils that differ from the same algorithm without any approximation of visibility, and are wrong.
    let exact = context.render(context.switches.without(of_visibility), request);
    let mut wrong: Vec<WrongVisibility> = output
        .beams
        .iter()
        .flat_map(|map| wrong_visibilities(context, output, &exact, map.sensor, of_geometry))
        .collect();
    for cause in sets_of(of_visibility) {
        let mut open: Vec<&mut WrongVisibility> =
            wrong.iter_mut().filter(|ray| ray.cause.is_none()).collect();
        if open.is_empty() {
            break;
        }
        let without = context.render(context.switches.without(cause), request);
        open.par_iter_mut().for_each(|ray| ray.attribute_to(cause, &without, extent_m, context));
    }
    wrong.into_iter().filter_map(|ray| Some((ray.place, ray.cause?))).collect()
}

/// The greatest camera depth of the upper beam's hits, metres. The upper beam is the one whose origin is highest in the
/// camera's image; of several the last.
fn upper_extent(context: AttributionContext<'_>, output: &RenderOutput) -> Option<f64> {
    let scene = context.judge.scene();
    let camera_from_scene = scene.camera().scene_from_sensor.inverse();
    let down = |index: usize| (camera_from_scene * scene.beams()[index].scene_from_sensor.position).y;
    let upper = (0..scene.beams().len()).min_by(|&a, &b| down(a).total_cmp(&down(b)).then(b.cmp(&a)))?;
    let depths = output.returns.get(upper)?.depth.as_ref()?.cells().iter().filter_map(|depth| depth.get());
    depths.reduce(f64::max)
}

fn wrong_visibilities(
    context: AttributionContext<'_>,
    output: &RenderOutput,
    exact: &RenderOutput,
    sensor: SensorId,
    of_geometry: &Attributions,
) -> Vec<WrongVisibility> {
    let (columns, rows) = context.judge.scene().size(sensor).expect("a sensor of this scene");
    let rows = (0..rows).into_par_iter().flat_map_iter(|j| {
        (0..columns).filter_map(move |i| {
            let place = Place { sensor, i, j };
            let (answer, of_exact) =
                (StatedVisibility::of(output, place)?, StatedVisibility::of(exact, place)?);
            let differs = answer.visible != of_exact.visible;
            let face_is_accounted_for = || {
                let (face, range) = (Some(answer.face), answer.range);
                of_geometry.cause(place).is_some()
                    || context.judge.rule(place, face, range, context.precision) != Ruling::Wrong
            };
            (differs && face_is_accounted_for() && context.is_visibility_wrong(place, answer))
                .then(|| WrongVisibility { place, answer, without: Vec::new(), cause: None })
        })
    });
    rows.collect()
}

impl AttributionContext<'_> {
    /// Whether a pencil's stated visibility is wrong.
    fn is_visibility_wrong(&self, place: Place, answer: StatedVisibility) -> bool {
        let StatedVisibility { face, range, visible, pixel } = answer;
        let ruling = self.judge.rule_visibility(place, face, range, visible, pixel, self.precision);
        ruling.is_none_or(|ruling| ruling.visible == Ruling::Wrong)
    }

    /// Explains an answer that was made with the renderer's switches but for `exact`.
    fn explain_visibility(
        &self,
        place: Place,
        answer: StatedVisibility,
        exact: Switches,
        extent_m: Option<f64>,
    ) -> Option<Vec<ExplainedVisibility>> {
        let switches = self.switches.without(exact);
        let with = VisibilityApproximations {
            facing: switches.facing == Fidelity::Paper,
            extent: extent_m.filter(|_| switches.extent == Fidelity::Paper),
            place: switches.place == Fidelity::Paper,
        };
        self.judge.explain_visibility(place, answer.face, answer.range, answer.visible, with, self.precision)
    }
}

impl WrongVisibility {
    /// Takes `cause` for the cause if the output `without` it restores this pencil and the referee confirms it.
    fn attribute_to(
        &mut self,
        cause: Switches,
        without: &RenderOutput,
        extent_m: Option<f64>,
        context: AttributionContext<'_>,
    ) {
        let Some(restored) = StatedVisibility::of(without, self.place) else { return };
        if context.is_visibility_wrong(self.place, restored) {
            self.without.push((cause, restored));
            return;
        }
        let Some(explained) = context.explain_visibility(self.place, self.answer, Switches::EXACT, extent_m)
        else {
            return;
        };
        let mut open = cause.without(reasons(&explained));
        let mut explained_without = Vec::new();
        for &(part, answer) in &self.without {
            if open != Switches::EXACT
                && cause.contains(part)
                && let Some(explained) = context.explain_visibility(self.place, answer, part, extent_m)
            {
                open = open.without(reasons(&explained));
                explained_without.push((part, explained));
            }
        }
        if open == Switches::EXACT {
            self.cause = Some(VisibilityCause { switches: cause, explained, explained_without });
        }
    }
}

/// The switches that are a reason for one of the faces.
fn reasons(explained: &[ExplainedVisibility]) -> Switches {
    let has = |reason: VisibilityReason| {
        let any = explained.iter().any(|one| one.reasons.contains(&reason));
        if any { Fidelity::Paper } else { Fidelity::Exact }
    };
    Switches {
        facing: has(VisibilityReason::Facing),
        extent: has(VisibilityReason::Extent),
        place: has(VisibilityReason::Place),
        ..Switches::EXACT
    }
}
