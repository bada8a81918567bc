//! Causes of wrong hits.

use rayon::prelude::*;

use crate::answer::StatedHit;
use crate::attribution::cause::Cause;
use crate::attribution::context::{AttributionContext, sets_of};
use raypencil_referee::{Approximations, Explained, Ruling};
use raypencil_scene::{FaceId, Fidelity, Place, Quantities, RenderOutput, Request, SensorMap, Switches};

/// The face and the range that a map states for a ray.
#[derive(Clone, Copy)]
struct Answer {
    face: Option<FaceId>,
    range: Option<f64>,
}

impl Answer {
    fn of(map: &SensorMap, i: u32, j: u32) -> Self {
        let StatedHit { face, range, .. } = StatedHit::of(map, i, j);
        Self { face, range }
    }
}

/// A ray whose hit is not the contract's.
struct WrongHit {
    place: Place,
    answer: Answer,
    /// The answers that are still wrong with other switches on `exact`, and those switches.
    without: Vec<(Switches, Answer)>,
    cause: Option<Cause>,
}

impl AttributionContext<'_> {
    fn is_wrong(&self, place: Place, answer: Answer) -> bool {
        self.judge.rule(place, answer.face, answer.range, self.precision) == Ruling::Wrong
    }

    /// Explains an answer that was made with the renderer's switches but for `exact`.
    fn explain(&self, place: Place, answer: Answer, exact: Switches) -> Option<Vec<Explained>> {
        let with = approximations(self.switches.without(exact));
        self.judge.explain(place, answer.face, answer.range, with, self.precision)
    }
}

/// The rays of an output whose errors have a confirmed cause.
pub(super) fn causes(context: AttributionContext<'_>, output: &RenderOutput) -> Vec<(Place, Cause)> {
    let of_geometry = context.switches.without(Switches {
        beam_edges: Fidelity::Exact,
        skip_rules: Fidelity::Exact,
        ..Switches::PAPER
    });
    if of_geometry == Switches::EXACT {
        return Vec::new();
    }
    let request = Request {
        camera: output.camera.is_some(),
        beams: !output.beams.is_empty(),
        quantities: Quantities::RANGE_MAP,
        ..Request::MAPS
    };

    // The rays that differ from the same algorithm without any approximation, and are wrong.
    let exact = context.render(Switches::EXACT, request);
    let mut wrong: Vec<WrongHit> = output
        .maps()
        .filter_map(|map| Some((map, exact.map(map.sensor)?)))
        .flat_map(|(map, of_exact)| wrong_hits(context, map, of_exact))
        .collect();

    for cause in sets_of(of_geometry) {
        let mut open: Vec<&mut WrongHit> = wrong.iter_mut().filter(|ray| ray.cause.is_none()).collect();
        if open.is_empty() {
            break;
        }
        let without = context.render(context.switches.without(cause), request);
        open.par_iter_mut().for_each(|ray| ray.attribute_to(cause, &without, context));
    }
    wrong.into_iter().filter_map(|ray| Some((ray.place, ray.cause?))).collect()
}

/// The rays of a map that differ from what the same algorithm gives without approximations, and are wrong.
fn wrong_hits(context: AttributionContext<'_>, map: &SensorMap, of_exact: &SensorMap) -> Vec<WrongHit> {
    let rows = (0..map.height).into_par_iter().flat_map_iter(|j| {
        (0..map.width).filter_map(move |i| {
            let (answer, place) = (Answer::of(map, i, j), Place { sensor: map.sensor, i, j });
            let differs = answer.face != Answer::of(of_exact, i, j).face;
            (differs && context.is_wrong(place, answer)).then(|| WrongHit {
                place,
                answer,
                without: Vec::new(),
                cause: None,
            })
        })
    });
    rows.collect()
}

impl WrongHit {
    /// Takes `cause` for the cause if the output `without` it restores this ray and the referee confirms it.
    fn attribute_to(&mut self, cause: Switches, without: &RenderOutput, context: AttributionContext<'_>) {
        let Place { sensor, i, j } = self.place;
        let Some(map) = without.map(sensor) else { return };
        let restored = Answer::of(map, i, j);
        if context.is_wrong(self.place, restored) {
            self.without.push((cause, restored));
            return;
        }
        let Some(explained) = context.explain(self.place, self.answer, Switches::EXACT) else { return };
        let mut open = cause.without(reasons(&explained));
        let mut explained_without = Vec::new();
        for &(part, answer) in &self.without {
            if open != Switches::EXACT
                && cause.contains(part)
                && let Some(explained) = context.explain(self.place, answer, part)
            {
                open = open.without(reasons(&explained));
                explained_without.push((part, explained));
            }
        }
        if open == Switches::EXACT {
            let restored_range = restored.range;
            self.cause = Some(Cause { switches: cause, explained, explained_without, restored_range });
        }
    }
}

/// The switches as the referee's type.
fn approximations(switches: Switches) -> Approximations {
    Approximations {
        beam_edges: switches.beam_edges == Fidelity::Paper,
        skip_rules: switches.skip_rules == Fidelity::Paper,
    }
}

/// The switches that are a reason for one of the faces.
fn reasons(explained: &[Explained]) -> Switches {
    let any = |of_beam_edges: bool| {
        let mut reasons = explained.iter().flat_map(|one| &one.reasons);
        if reasons.any(|reason| reason.belongs_to_beam_edges() == of_beam_edges) {
            Fidelity::Paper
        } else {
            Fidelity::Exact
        }
    };
    Switches { beam_edges: any(true), skip_rules: any(false), ..Switches::EXACT }
}
