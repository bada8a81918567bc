//! All results of one scene: what was rendered, every pair compared, candidates evaluated.

use std::time::Instant;

use raypencil_judge::{ApproximationTallies, Class, SensorResult};
use raypencil_referee::RefereeTree;
use raypencil_scene::{Progress, Stage};
use raypencil_scene_io::Subject;
use raypencil_survey::{SensorHits, Warning};

use crate::candidate::Candidate;
use crate::ray_sets::RaySetResult;
use crate::rendered::Rendered;
use crate::scoreboard::{CandidateReport, Scoreboard, evaluate};

/// The comparison of two renderers.
#[derive(Debug)]
pub struct Pair {
    /// Index of the first side in [`Validation::rendered`].
    pub a: usize,
    /// Index of the second side.
    pub b: usize,
    /// One comparison per sensor, the camera first.
    pub sensors: Vec<SensorResult>,
}

/// A scene rendered by several renderers, with every pair of them compared.
#[derive(Debug)]
pub struct Validation {
    /// The scene.
    pub subject: Subject,
    /// Each renderer's output, in the order of the contenders.
    pub rendered: Vec<Rendered>,
    /// Every pair of renderers: (0, 1), (0, 2), ..., (1, 2), ...
    pub pairs: Vec<Pair>,
    /// The referee's hierarchy of the terrain, for reports that ask it again.
    pub tree: RefereeTree,
    /// Every set of rays of the scene.
    pub ray_sets: Vec<RaySetResult>,
    /// Renderers and candidates checked against the exact answers; `None` until [`Validation::evaluate`].
    pub scoreboard: Option<Scoreboard>,
    /// Whether the validation passes although a candidate is wrong: `--candidates-must-pass=false`. Reports call the
    /// candidate wrong all the same.
    pub candidates_may_fail: bool,
    /// Warnings about the scene. They change no class and no verdict but that of a scene in which nothing is hit.
    pub warnings: Vec<Warning>,
    /// Whether a validation in which nothing is hit may pass.
    pub allow_empty: bool,
    /// Wall-clock time of each step, in order.
    pub stages: Vec<Stage>,
}

/// Rays that hit, for each sensor: the most of any renderer. A sensor without a map is left out.
pub(crate) fn most_hits(rendered: &[Rendered]) -> Vec<SensorHits> {
    let mut most: Vec<SensorHits> = Vec::new();
    for of in rendered.iter().flat_map(|side| side.output.maps()).filter_map(SensorHits::of_map) {
        match most.iter_mut().find(|earlier| earlier.sensor == of.sensor) {
            Some(earlier) => earlier.hits = earlier.hits.max(of.hits),
            None => most.push(of),
        }
    }
    most
}

/// Numbers of rays by class, summed over all sensors and pairs.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Counts {
    /// Rays compared: the sum of all classes.
    pub compared: u64,
    /// Rays on which both sides agree.
    pub agree: u64,
    /// Rays that meet several faces at exactly the same point.
    pub tie: u64,
    /// Rays with the exact answer of a ray displaced within the renderer's precision.
    pub rounding: u64,
    /// Rays on which one side makes an error of the paper, for a confirmed cause.
    pub approximation: u64,
    /// Rays that the referee could not decide.
    pub undecided: u64,
    /// Rays on which a side is wrong.
    pub defects: u64,
    /// Rays missing from one side's output.
    pub not_compared: u64,
    /// Rays that the referee ruled on.
    pub judged: u64,
}

impl Validation {
    /// Numbers of rays by class, over all pairs and all sets of rays.
    pub fn counts(&self) -> Counts {
        let mut counts = Counts::default();
        for sensor in self.pairs.iter().flat_map(|pair| &pair.sensors) {
            counts.compared += sensor.compared();
            counts.agree += sensor.of(Class::Agree);
            counts.tie += sensor.of(Class::Tie);
            counts.rounding += sensor.of(Class::Rounding);
            counts.approximation += sensor.of(Class::Approximation);
            counts.undecided += sensor.of(Class::Undecided);
            counts.judged += sensor.judged;
            counts.defects += sensor.of(Class::Defect);
            counts.not_compared += sensor.not_compared;
        }
        for set in &self.ray_sets {
            if set.comparison.is_none() {
                counts.not_compared += set.rays();
                continue;
            }
            let of_set = set.counts();
            counts.compared += set.rays();
            counts.agree += of_set.same - of_set.ties;
            counts.tie += of_set.ties;
            counts.rounding += of_set.rounding;
            counts.defects += of_set.wrong;
            counts.judged += set.rays();
        }
        counts
    }

    /// Effects of each set of the paper's approximations, over all sensors and pairs.
    pub fn approximations(&self) -> ApproximationTallies {
        let mut all = ApproximationTallies::new();
        for sensor in self.pairs.iter().flat_map(|pair| &pair.sensors) {
            for (cause, tally) in &sensor.approximations {
                all.entry(*cause).or_default().add(tally);
            }
        }
        all
    }

    /// Checks the renderers and `candidates`, recordings of the same scene, against the exact answer to every ray.
    pub fn evaluate(&mut self, candidates: Vec<Candidate>, progress: &dyn Progress) {
        let start = Instant::now();
        self.scoreboard = Some(evaluate(&self.subject, &self.rendered, candidates, progress));
        self.stages.push(Stage { name: "evaluating candidates".into(), time: start.elapsed() });
    }

    /// The candidates; empty until [`Validation::evaluate`].
    pub fn candidates(&self) -> &[CandidateReport] {
        self.scoreboard.as_ref().map_or(&[], |scoreboard| &scoreboard.candidates)
    }

    /// Whether a ray of any sensor hits the terrain, by any renderer.
    pub fn hits_something(&self) -> bool {
        let is_hit_by_a_set = self.ray_sets.iter().any(|set| set.hits() + set.too_near() > 0);
        is_hit_by_a_set || most_hits(&self.rendered).iter().any(|of| of.hits > 0)
    }

    /// Whether at least one ray of the renderers was compared, none is a defect or undecided, and a ray hits, unless
    /// [`Validation::allow_empty`].
    pub fn renderers_pass(&self) -> bool {
        let counts = self.counts();
        let is_fine = counts.defects == 0 && counts.undecided == 0 && counts.compared > 0;
        is_fine && (self.allow_empty || self.hits_something())
    }

    /// Whether the renderers pass, and every candidate, unless [`Validation::candidates_may_fail`].
    pub fn passes(&self) -> bool {
        let candidates_pass = self.candidates().iter().all(CandidateReport::passes);
        self.renderers_pass() && (self.candidates_may_fail || candidates_pass)
    }
}
