//! Why a renderer that follows the paper into error differs from the contract, ray by ray.
//!
//! A difference is put down to an approximation only if two things hold:
//!
//! 1. *It restores.* With the switches of the cause on `exact`, and all others as they are, the same
//!    algorithm gives an answer that the referee admits. Of the sets that do, the smallest count.
//! 2. *It is confirmed.* The referee finds, from the paper's text and by itself, that the approximations lose
//!    every face of which the answer is silent and add the one that it names
//!    ([`raypencil_referee::Referee::explain`]), and each switch of the set is the reason for one of them.
//!
//! What no set satisfies has no cause, and is a defect.

use std::collections::HashMap;

use rayon::prelude::*;
use raypencil_referee::{Approximations, Explained, Ruling};
use raypencil_scanline::{Options, Scanline, Switches};
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
    /// The range of the restored answer, metres; `None` if that is a miss.
    pub restored_range: Option<f64>,
}

/// The causes of all answers of one frame that the contract does not give.
#[derive(Debug, Clone, Default)]
pub struct Attributions {
    by_ray: HashMap<(SensorId, u32, u32), Cause>,
}

impl Attributions {
    /// Finds the causes of `frame`, which the scanline renderer made of the judge's scene with `switches`.
    pub fn find(judge: &Judge<'_>, frame: &Frame, switches: Switches, resolution: Resolution) -> Self {
        let by_ray = causes(judge, frame, switches, resolution).into_iter();
        Self { by_ray: by_ray.map(|(Place { sensor, i, j }, cause)| ((sensor, i, j), cause)).collect() }
    }

    /// The cause of the answer to one ray, if it has one.
    pub fn cause(&self, Place { sensor, i, j }: Place) -> Option<&Cause> {
        self.by_ray.get(&(sensor, i, j))
    }
}

/// A ray whose answer is not the contract's.
struct Wrong {
    place: Place,
    answer: Option<FaceId>,
    range: Option<f64>,
    /// What the referee found, once it has been asked.
    explained: Option<Option<Vec<Explained>>>,
    /// Whether some set of switches has restored it, confirmed or not.
    is_restored: bool,
    cause: Option<Cause>,
}

/// One side's answer to a ray.
fn answer(map: &SensorMap, i: u32, j: u32) -> (Option<FaceId>, Option<f64>) {
    let face = map.face.as_ref().and_then(|faces| faces.at(i, j).get());
    let range = map.range.as_ref().and_then(|ranges| ranges.at(i, j).get());
    (face, range)
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
    };
    let render = |switches: Switches| {
        Scanline::new(Options { switches, ..Options::EXACT }).render(judge.scene(), &request)
    };

    // What differs from the same algorithm without any approximation, and is wrong.
    let exact = render(Switches::EXACT);
    let mut wrong: Vec<Wrong> = frame
        .maps()
        .filter_map(|map| Some((map, exact.map(map.sensor)?)))
        .flat_map(|(map, of_exact)| wrong_answers(judge, map, of_exact, resolution))
        .collect();

    // From the smallest sets to the largest, in the order of the switches.
    let mut causes: Vec<Switches> = Switches::subsets().filter(|cause| switches.contains(*cause)).collect();
    causes.sort_by_key(|cause| cause.count());
    for causes in causes.chunk_by(|a, b| a.count() == b.count()) {
        // What a smaller set restores, confirmed or not, is no matter of a larger one.
        let mut open: Vec<&mut Wrong> = wrong.iter_mut().filter(|ray| !ray.is_restored).collect();
        for &cause in causes {
            if cause == Switches::EXACT || open.is_empty() {
                continue;
            }
            let without = render(switches.without(cause));
            open.par_iter_mut().for_each(|ray| {
                ray.attribute_to(
                    cause,
                    &without,
                    |ray| {
                        let with = approximations(switches);
                        judge.explain(ray.place, ray.answer, ray.range, with, resolution)
                    },
                    |place, face, range| judge.rule(place, face, range, resolution) != Ruling::Wrong,
                );
            });
        }
    }
    wrong.into_iter().filter_map(|ray| Some((ray.place, ray.cause?))).collect()
}

/// The rays of a map that differ from what the same algorithm gives without approximations, and are wrong.
fn wrong_answers(
    judge: &Judge<'_>,
    map: &SensorMap,
    of_exact: &SensorMap,
    resolution: Resolution,
) -> Vec<Wrong> {
    let rows = (0..map.height).into_par_iter().flat_map_iter(|j| {
        (0..map.width).filter_map(move |i| {
            let (face, range) = answer(map, i, j);
            let place = Place { sensor: map.sensor, i, j };
            let is_wrong = face != answer(of_exact, i, j).0
                && judge.rule(place, face, range, resolution) == Ruling::Wrong;
            is_wrong.then_some(Wrong {
                place,
                answer: face,
                range,
                explained: None,
                is_restored: false,
                cause: None,
            })
        })
    });
    rows.collect()
}

impl Wrong {
    /// Takes `cause` for the cause if the frame `without` it restores this ray and the referee confirms it.
    fn attribute_to(
        &mut self,
        cause: Switches,
        without: &Frame,
        explain: impl Fn(&Self) -> Option<Vec<Explained>>,
        admits: impl Fn(Place, Option<FaceId>, Option<f64>) -> bool,
    ) {
        let Place { sensor, i, j } = self.place;
        let Some(map) = without.map(sensor).filter(|_| self.cause.is_none()) else { return };
        let (face, restored_range) = answer(map, i, j);
        if !admits(self.place, face, restored_range) {
            return;
        }
        self.is_restored = true;
        let explained = match self.explained.take() {
            Some(explained) => explained,
            None => explain(self),
        };
        if let Some(explained) = explained.as_ref().filter(|explained| is_reason(cause, explained)) {
            self.cause = Some(Cause { switches: cause, explained: explained.clone(), restored_range });
        }
        self.explained = Some(explained);
    }
}

/// The switches in the referee's own words.
fn approximations(switches: Switches) -> Approximations {
    use raypencil_scanline::Fidelity::Paper;
    Approximations { beam_edges: switches.beam_edges == Paper, skip_rules: switches.skip_rules == Paper }
}

/// Whether each switch of a cause is a reason for one of the faces.
fn is_reason(cause: Switches, explained: &[Explained]) -> bool {
    let Approximations { beam_edges, skip_rules } = approximations(cause);
    let any = |of_beam_edges: bool| {
        explained.iter().flat_map(|one| &one.reasons).any(|reason| reason.is_of_beam_edges() == of_beam_edges)
    };
    (!beam_edges || any(true)) && (!skip_rules || any(false))
}
