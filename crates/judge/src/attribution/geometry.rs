//! Causes of what a ray is said to meet.

use rayon::prelude::*;

use crate::attribution::cause::Cause;
use crate::attribution::court::{Court, sets_of};
use raypencil_referee::{Approximations, Explained, Ruling};
use raypencil_scene::Place;
use raypencil_scene::{FaceId, Fidelity, Quantities, RenderOutput, Request, SensorMap, Switches};

/// A ray whose answer is not the contract's.
struct Wrong {
    place: Place,
    answer: Answer,
    /// The answers that are wrong with other switches on `exact`, by which.
    without: Vec<(Switches, Answer)>,
    cause: Option<Cause>,
}

/// One side's answer to a ray.
#[derive(Debug, Clone, Copy)]
struct Answer {
    face: Option<FaceId>,
    range: Option<f64>,
}

impl Answer {
    fn of(map: &SensorMap, i: u32, j: u32) -> Self {
        Self {
            face: map.face.as_ref().and_then(|faces| faces.at(i, j).get()),
            range: map.range.as_ref().and_then(|ranges| ranges.at(i, j).get()),
        }
    }
}

impl Court<'_> {
    fn is_wrong(&self, place: Place, answer: Answer) -> bool {
        self.judge.rule(place, answer.face, answer.range, self.precision) == Ruling::Wrong
    }

    /// Explains an answer that was made with the renderer's switches but for `exact`.
    fn explain(&self, place: Place, answer: Answer, exact: Switches) -> Option<Vec<Explained>> {
        let with = approximations(self.switches.without(exact));
        self.judge.explain(place, answer.face, answer.range, with, self.precision)
    }
}

/// The rays of a frame whose errors have a confirmed cause.
pub(super) fn causes(court: Court<'_>, output: &RenderOutput) -> Vec<(Place, Cause)> {
    let of_geometry = court.switches.without(Switches {
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

    // What differs from the same algorithm without any approximation, and is wrong.
    let exact = court.render(Switches::EXACT, request);
    let mut wrong: Vec<Wrong> = output
        .maps()
        .filter_map(|map| Some((map, exact.map(map.sensor)?)))
        .flat_map(|(map, of_exact)| wrong_answers(court, map, of_exact))
        .collect();

    for cause in sets_of(of_geometry) {
        let mut open: Vec<&mut Wrong> = wrong.iter_mut().filter(|ray| ray.cause.is_none()).collect();
        if open.is_empty() {
            break;
        }
        let without = court.render(court.switches.without(cause), request);
        open.par_iter_mut().for_each(|ray| ray.attribute_to(cause, &without, court));
    }
    wrong.into_iter().filter_map(|ray| Some((ray.place, ray.cause?))).collect()
}

/// The rays of a map that differ from what the same algorithm gives without approximations, and are wrong.
fn wrong_answers(court: Court<'_>, map: &SensorMap, of_exact: &SensorMap) -> Vec<Wrong> {
    let rows = (0..map.height).into_par_iter().flat_map_iter(|j| {
        (0..map.width).filter_map(move |i| {
            let (answer, place) = (Answer::of(map, i, j), Place { sensor: map.sensor, i, j });
            let differs = answer.face != Answer::of(of_exact, i, j).face;
            (differs && court.is_wrong(place, answer)).then(|| Wrong {
                place,
                answer,
                without: Vec::new(),
                cause: None,
            })
        })
    });
    rows.collect()
}

impl Wrong {
    /// Takes `cause` for the cause if the frame `without` it restores this ray and the referee confirms it.
    fn attribute_to(&mut self, cause: Switches, without: &RenderOutput, court: Court<'_>) {
        let Place { sensor, i, j } = self.place;
        let Some(map) = without.map(sensor) else { return };
        let restored = Answer::of(map, i, j);
        if court.is_wrong(self.place, restored) {
            self.without.push((cause, restored));
            return;
        }
        let Some(explained) = court.explain(self.place, self.answer, Switches::EXACT) else { return };
        let mut open = cause.without(reasons(&explained));
        let mut explained_without = Vec::new();
        for &(part, answer) in &self.without {
            if open != Switches::EXACT
                && cause.contains(part)
                && let Some(explained) = court.explain(self.place, answer, part)
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

/// The switches in the referee's own words.
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
