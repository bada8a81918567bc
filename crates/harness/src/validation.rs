use std::time::Instant;

use crate::candidate::Outsider;
use crate::panel::{Panel, panel};
use crate::rendered::Rendered;
use raypencil_judge::{ApproximationTallies, Class, SensorResult};
use raypencil_scene::{Progress, Stage};
use raypencil_scene_io::Subject;

/// Two renderers compared.
#[derive(Debug)]
pub struct Pair {
    /// Index of the one side in [`Validation::rendered`].
    pub a: usize,
    /// Index of the other side.
    pub b: usize,
    /// Sensor by sensor, the camera first.
    pub sensors: Vec<SensorResult>,
}

/// A scene rendered by several renderers, and every pair of them compared.
#[derive(Debug)]
pub struct Validation {
    /// The scene.
    pub subject: Subject,
    /// Each renderer's frame, in the order asked for.
    pub rendered: Vec<Rendered>,
    /// Every pair.
    pub pairs: Vec<Pair>,
    /// Everyone's answers held to the truth, if others were asked as well.
    pub panel: Option<Panel>,
    /// How long each part of the work took, in order.
    pub stages: Vec<Stage>,
}

/// Rays by what became of them, over all sensors and pairs.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Counts {
    /// Rays compared; the classes add up to it.
    pub compared: u64,
    /// Rays that agree.
    pub agree: u64,
    /// Rays on which two faces tie.
    pub tie: u64,
    /// Rays answered as a displaced ray would be.
    pub rounding: u64,
    /// Rays on which one side follows the paper into error, for a confirmed cause.
    pub approximation: u64,
    /// Rays on which the referee gave up.
    pub undecided: u64,
    /// Rays that differ beyond doubt.
    pub defects: u64,
    /// Rays that one side does not have.
    pub not_compared: u64,
    /// Rays that the referee ruled on.
    pub judged: u64,
}

impl Validation {
    /// All rays of all pairs.
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
        counts
    }

    /// What each set of the paper's approximations did, over all sensors and pairs.
    pub fn approximations(&self) -> ApproximationTallies {
        let mut all = ApproximationTallies::new();
        for sensor in self.pairs.iter().flat_map(|pair| &pair.sensors) {
            for (cause, tally) in &sensor.approximations {
                all.entry(*cause).or_default().add(tally);
            }
        }
        all
    }

    /// Holds the renderers and what others recorded of the same scene to the truth about every ray.
    pub fn hold(&mut self, outsiders: Vec<Outsider>, progress: &dyn Progress) {
        let start = Instant::now();
        self.panel = Some(panel(&self.subject, &self.rendered, outsiders, progress));
        self.stages.push(Stage { name: "holding all to the truth".into(), time: start.elapsed() });
    }

    /// Whether everything that was compared agrees or has a confirmed cause, and something was.
    pub fn passes(&self) -> bool {
        let counts = self.counts();
        counts.defects == 0 && counts.undecided == 0 && counts.compared > 0
    }
}
