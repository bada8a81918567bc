//! Why a renderer that follows the paper into error differs from the contract, ray by ray.
//!
//! A difference is put down to an approximation only if two things hold:
//!
//! 1. *It restores.* With the switches of the cause on `exact`, and all others as they are, the same
//!    algorithm gives an answer that the referee admits.
//! 2. *It is confirmed.* The referee finds, from the paper's text and by itself, that the approximations lose
//!    every face of which the answer is silent and add the one that it names
//!    ([`raypencil_referee::Referee::explain`]), and each switch of the set is the reason for one of them.
//!    Where one approximation hides what another does (the true face is lost by either alone, say), the reason
//!    is sought in the answers that are left wrong when only a part of the set is exact.
//!
//! Of the sets that do both, one of the smallest is the cause. (A smaller one may restore an answer by luck, as
//! where the one rule skips what the other adds; it is not confirmed then.) What no set satisfies has no cause,
//! and is a defect.

use std::collections::HashMap;

use rayon::prelude::*;
use raypencil_referee::{Approximations, Explained, Ruling};
use raypencil_scanline::{Fidelity, Options, Scanline, Switches};
use raypencil_scene::{FaceId, Frame, Quantities, Renderer, Request, Resolution, SensorId, SensorMap};

use crate::compare::Place;
use crate::judge::Judge;

/// What explains one answer.
#[derive(Debug, Clone, PartialEq)]
pub struct Cause {
    /// The smallest set of switches that restores an exact answer and is confirmed.
    pub switches: Switches,
    /// The faces that are seen or not seen against the contract, and why.
    pub explained: Vec<Explained>,
    /// The same of the answers that are still wrong with only these switches exact, if it takes them to
    /// find a reason for each switch.
    pub explained_without: Vec<(Switches, Vec<Explained>)>,
    /// The range of the restored answer, metres; `None` if that is a miss.
    pub restored_range: Option<f64>,
}

/// The causes of all answers of one frame that the contract does not give.
#[derive(Debug, Clone, Default)]
pub struct Attributions {
    by_ray: HashMap<(SensorId, u32, u32), Cause>,
    of_sight: HashMap<(SensorId, u32, u32), SightCause>,
}

/// What explains one answer about what the camera sees.
#[derive(Debug, Clone, PartialEq)]
pub struct SightCause {
    /// The smallest set of switches that restores an exact answer and is confirmed.
    pub switches: Switches,
}

impl Attributions {
    /// Finds the causes of `frame`, which the scanline renderer made of the judge's scene with `switches`.
    pub fn find(judge: &Judge<'_>, frame: &Frame, switches: Switches, resolution: Resolution) -> Self {
        let by_ray = causes(judge, frame, switches, resolution).into_iter();
        Self {
            by_ray: by_ray.map(|(Place { sensor, i, j }, cause)| ((sensor, i, j), cause)).collect(),
            of_sight: HashMap::new(),
        }
    }

    /// The cause of the answer about what the camera sees of one pencil's hit, if it has one.
    pub fn sight_cause(&self, Place { sensor, i, j }: Place) -> Option<&SightCause> {
        self.of_sight.get(&(sensor, i, j))
    }

    /// The cause of the answer to one ray, if it has one.
    pub fn cause(&self, Place { sensor, i, j }: Place) -> Option<&Cause> {
        self.by_ray.get(&(sensor, i, j))
    }
}

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

/// Whom to ask about the answers of one renderer.
#[derive(Clone, Copy)]
struct Court<'a> {
    judge: &'a Judge<'a>,
    switches: Switches,
    resolution: Resolution,
}

impl Court<'_> {
    fn is_wrong(&self, place: Place, answer: Answer) -> bool {
        self.judge.rule(place, answer.face, answer.range, self.resolution) == Ruling::Wrong
    }

    /// Explains an answer that was made with the renderer's switches but for `exact`.
    fn explain(&self, place: Place, answer: Answer, exact: Switches) -> Option<Vec<Explained>> {
        let with = approximations(self.switches.without(exact));
        self.judge.explain(place, answer.face, answer.range, with, self.resolution)
    }
}

/// The rays of a frame whose errors have a confirmed cause.
fn causes(
    judge: &Judge<'_>,
    frame: &Frame,
    switches: Switches,
    resolution: Resolution,
) -> Vec<(Place, Cause)> {
    if switches == Switches::EXACT {
        return Vec::new();
    }
    let request = Request {
        camera: frame.camera.is_some(),
        beams: !frame.beams.is_empty(),
        quantities: Quantities::RANGE_MAP,
        ..Request::MAPS
    };
    let render = |switches: Switches| {
        Scanline::new(Options { switches, ..Options::EXACT }).render(judge.scene(), &request)
    };

    // What differs from the same algorithm without any approximation, and is wrong.
    let court = Court { judge, switches, resolution };
    let exact = render(Switches::EXACT);
    let mut wrong: Vec<Wrong> = frame
        .maps()
        .filter_map(|map| Some((map, exact.map(map.sensor)?)))
        .flat_map(|(map, of_exact)| wrong_answers(court, map, of_exact))
        .collect();

    // From the smallest sets to the largest, in the order of the switches.
    let mut causes: Vec<Switches> = Switches::subsets().filter(|cause| switches.contains(*cause)).collect();
    causes.sort_by_key(|cause| cause.count());
    for cause in causes.into_iter().filter(|cause| *cause != Switches::EXACT) {
        let mut open: Vec<&mut Wrong> = wrong.iter_mut().filter(|ray| ray.cause.is_none()).collect();
        if open.is_empty() {
            break;
        }
        let without = render(switches.without(cause));
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
    fn attribute_to(&mut self, cause: Switches, without: &Frame, court: Court<'_>) {
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
        if reasons.any(|reason| reason.is_of_beam_edges() == of_beam_edges) {
            Fidelity::Paper
        } else {
            Fidelity::Exact
        }
    };
    Switches { beam_edges: any(true), skip_rules: any(false) }
}
