//! One validation, from a scene to its verdict, as one readable pass.

use std::time::{Duration, Instant};

use raypencil_scanline::Switches;
use raypencil_scene::{Frame, Request, Resolution, Scene, Stage};

use crate::attribution::Attributions;
use crate::compare::{ApproximationTallies, Class, SensorComparison, Side, compare_judged};
use crate::judge::{Judge, JudgeShare};
use crate::outside::{Outsider, Panel, panel};
use crate::renderers::Contender;

/// The scene under test, and how people name it.
#[derive(Debug, Clone)]
pub struct Subject {
    /// The resolved scene.
    pub scene: Scene,
    /// A short name, fit for a folder.
    pub name: String,
    /// The words after `raypencil validate` or `raypencil probe` that give this scene and its renderers again.
    pub arguments: String,
    /// SHA-256 of what defines the scene, in hexadecimal digits.
    pub sha256: String,
}

/// What one renderer made of the scene.
#[derive(Debug)]
pub struct Rendered {
    /// The renderer's name.
    pub name: String,
    /// How finely it computes.
    pub resolution: Resolution,
    /// The paper's approximations that it makes.
    pub approximations: Switches,
    /// What they did.
    pub attributions: Attributions,
    /// Its maps.
    pub frame: Frame,
    /// Wall-clock time of the whole render.
    pub time: Duration,
}

/// Two renderers compared.
#[derive(Debug)]
pub struct Pair {
    /// Index of the one side in [`Validation::rendered`].
    pub a: usize,
    /// Index of the other side.
    pub b: usize,
    /// Sensor by sensor, the camera first.
    pub sensors: Vec<SensorComparison>,
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

/// Who wants to hear what is being done.
pub trait Progress: Sync {
    /// A new stage begins.
    fn stage(&self, what: &str);
}

/// Nobody does.
#[derive(Debug, Clone, Copy)]
pub struct Silent;

impl Progress for Silent {
    fn stage(&self, _what: &str) {}
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
            counts.compared += sensor.compared;
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

/// Renders `subject` with each of `contenders`, compares every pair, and has the referee judge what differs and
/// that `share` of what agrees.
pub fn validate(
    subject: Subject,
    contenders: &[Contender],
    share: JudgeShare,
    progress: &dyn Progress,
) -> Validation {
    let mut stages = Vec::new();

    // Render.
    let mut rendered = Vec::new();
    for contender in contenders {
        let renderer = &contender.renderer;
        let name = renderer.name().to_string();
        progress.stage(&format!("{name}: rendering"));
        let start = Instant::now();
        let frame = renderer.render(&subject.scene, &Request::EVERYTHING);
        let time = start.elapsed();
        stages.extend(
            frame
                .stages
                .iter()
                .map(|stage| Stage { name: format!("{name}: {}", stage.name), ..stage.clone() }),
        );
        rendered.push(Rendered {
            name,
            resolution: renderer.resolution(),
            approximations: contender.approximations(),
            attributions: Attributions::default(),
            frame,
            time,
        });
    }

    // The referee reads the scene by itself.
    progress.stage("referee: preparing");
    let start = Instant::now();
    let judge = Judge::new(&subject.scene, share);
    stages.push(Stage { name: "referee: preparing".into(), time: start.elapsed() });

    // Find what the paper's approximations did.
    for side in rendered.iter_mut().filter(|side| side.approximations != Switches::EXACT) {
        let what = format!("attributing {}", side.name);
        progress.stage(&what);
        let start = Instant::now();
        side.attributions = Attributions::find(&judge, &side.frame, side.approximations, side.resolution);
        stages.push(Stage { name: what, time: start.elapsed() });
    }

    // Compare every pair, and judge.
    let mut pairs = Vec::new();
    for a in 0..rendered.len() {
        for b in a + 1..rendered.len() {
            let what = format!("{} against {}: comparing", rendered[a].name, rendered[b].name);
            progress.stage(&what);
            let start = Instant::now();
            let sensors = compare_judged(&judge, rendered[a].side(), rendered[b].side());
            stages.push(Stage { name: what, time: start.elapsed() });
            pairs.push(Pair { a, b, sensors });
        }
    }
    drop(judge);
    Validation { subject, rendered, pairs, panel: None, stages }
}

impl Rendered {
    pub(crate) fn side(&self) -> Side<'_> {
        Side {
            name: &self.name,
            frame: &self.frame,
            resolution: self.resolution,
            attributions: Some(&self.attributions),
        }
    }
}
