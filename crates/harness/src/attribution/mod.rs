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

mod geometry;
mod sight;

use std::collections::HashMap;

use raypencil_referee::{Explained, ExplainedSight};
use raypencil_scanline::{Options, Scanline, Switches};
use raypencil_scene::{Frame, Renderer, Request, Resolution, SensorId};

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
    /// The faces that hide the point, or do not, against the contract, and why.
    pub explained: Vec<ExplainedSight>,
    /// The same of the answers that are still wrong with only these switches exact.
    pub explained_without: Vec<(Switches, Vec<ExplainedSight>)>,
}

impl Attributions {
    /// Finds the causes of `frame`, which the scanline renderer made of the judge's scene with `switches`.
    pub fn find(judge: &Judge<'_>, frame: &Frame, switches: Switches, resolution: Resolution) -> Self {
        let court = Court { judge, switches, resolution };
        let key = |Place { sensor, i, j }: Place| (sensor, i, j);
        let by_ray = geometry::causes(court, frame).into_iter().map(|(at, cause)| (key(at), cause)).collect();
        let mut found = Self { by_ray, of_sight: HashMap::new() };
        let of_sight = sight::causes(court, frame, &found);
        found.of_sight = of_sight.into_iter().map(|(at, cause)| (key(at), cause)).collect();
        found
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

/// Whom to ask about the answers of one renderer.
#[derive(Clone, Copy)]
struct Court<'a> {
    judge: &'a Judge<'a>,
    switches: Switches,
    resolution: Resolution,
}

impl Court<'_> {
    /// Renders the scene as the renderer would with these switches.
    fn render(&self, switches: Switches, request: Request) -> Frame {
        Scanline::new(Options { switches, ..Options::EXACT }).render(self.judge.scene(), &request)
    }
}

/// The non-empty sets of some switches, from the smallest to the largest.
fn sets_of(switches: Switches) -> Vec<Switches> {
    let mut sets: Vec<Switches> =
        Switches::subsets().filter(|set| *set != Switches::EXACT && switches.contains(*set)).collect();
    sets.sort_by_key(|set| set.count());
    sets
}
