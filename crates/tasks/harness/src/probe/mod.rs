//! One ray: the answers of the renderers and of the referee, with the margins of the exact answer.

mod text;

use std::borrow::Cow;

use raypencil_judge::{
    Attributions, Cause, CheckedRay, Class, GroundTruth, Judge, JudgeShare, Quantity, VisibilityCause,
    check_ray, check_ray_against,
};
use raypencil_referee::{Format, Margin, Margins, Ruling, Verdict, VisibilityMargins, VisibilityRuling};
use raypencil_scene::{
    Hit, Place, Precision, Progress, Ray, RenderOutput, Request, Return, Sampling, SensorId,
};
use raypencil_scene_io::{Subject, probe_command, quoted};

use crate::candidate::Candidate;
use crate::rendered::Rendered;
use crate::renderers::{Contender, attribute};

/// One ray with every renderer's answer and the exact one.
#[derive(Debug, Clone)]
pub struct Probe {
    /// The ray's sensor and cell.
    pub place: Place,
    /// The command that shows this ray.
    pub command: String,
    /// The ray in the scene frame, rounded to f64, metres.
    pub ray: Ray,
    /// Maximum range along the ray, metres.
    pub max_range: f64,
    /// Each renderer's answer.
    pub answers: Vec<ProbedAnswer>,
    /// The answer of each candidate, after [`Probe::ask`].
    pub candidates: Vec<ProbedCandidate>,
    /// The exact verdict.
    pub verdict: Verdict,
    /// The exact hit with its values rounded to f64; on a tie, that of the face with the lowest index.
    pub exact: Option<Hit>,
    /// The exact return of a pencil that hits, rounded to f64; `None` for a camera.
    pub exact_return: Option<Return>,
    /// Unit of the flux.
    pub flux_unit: &'static str,
    /// Smallest displacement that changes the set of nearest faces, cells.
    pub face_margin: Margin,
    /// Smallest displacement at which the range is discontinuous, cells.
    pub surface_margin: Margin,
    /// Smallest displacements that change a pencil's visibility; `None` for a camera or a pencil that hits nothing.
    pub visibility_margins: Option<VisibilityMargins>,
}

/// A candidate's answer to a ray, judged as by `check`.
#[derive(Debug, Clone)]
pub struct ProbedCandidate {
    /// The candidate's name.
    pub name: String,
    /// What it says of each quantity, what is true, and the class.
    pub ray: CheckedRay,
}

impl Probe {
    /// Adds the answers of candidates, recordings of the same scene, to those of the renderers.
    pub fn ask(&mut self, subject: &Subject, candidates: &[Candidate]) {
        for candidate in candidates {
            self.add(candidate, check_ray(&subject.scene, &candidate.recorded, self.place));
        }
    }

    /// Adds the answer of one candidate, judged by exact answers that are there already.
    pub(crate) fn ask_one(&mut self, truth: &GroundTruth<'_>, candidate: &Candidate) {
        self.add(candidate, check_ray_against(truth, &candidate.recorded, self.place));
    }

    fn add(&mut self, candidate: &Candidate, ray: Option<CheckedRay>) {
        self.candidates.extend(ray.map(|ray| ProbedCandidate { name: candidate.name.clone(), ray }));
        self.command += &format!(" --candidate {}", quoted(&candidate.folder.to_string_lossy()));
    }
}

/// One renderer's answer to a ray, with the referee's ruling.
#[derive(Debug, Clone)]
pub struct ProbedAnswer {
    /// The renderer's name.
    pub renderer: String,
    /// The hit; `None` if the renderer says that the ray hits nothing.
    pub hit: Option<Hit>,
    /// The referee's ruling on the hit.
    pub ruling: Ruling,
    /// The class of that ruling. The values of an agreeing answer are not judged here and may still exceed their
    /// bounds.
    pub class: Class,
    /// The confirmed cause of a wrong hit.
    pub cause: Option<Cause>,
    /// The return of a pencil; `None` for a camera, and for a pencil that hits nothing by this answer.
    pub back: Option<ProbedReturn>,
}

/// One renderer's return of a pencil, with the referee's ruling.
#[derive(Debug, Clone)]
pub struct ProbedReturn {
    /// The return.
    pub back: Return,
    /// The referee's ruling on the visibility of the point and on its pixel.
    pub ruling: VisibilityRuling,
    /// The confirmed cause of a wrong visibility.
    pub cause: Option<VisibilityCause>,
}

/// The scene does not have the requested ray.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum NoSuchRay {
    /// The scene does not have that beam.
    #[error("there is no beam {index}: the scene has {count}, counted from 0")]
    Beam {
        /// Index of the requested beam.
        index: usize,
        /// Number of beams.
        count: usize,
    },
    /// The sensor does not have that cell.
    #[error("{sensor} has no cell {i},{j}: it is {width} x {height}, counted from 0,0")]
    Cell {
        /// The requested sensor.
        sensor: SensorId,
        /// The requested column.
        i: u32,
        /// The requested row.
        j: u32,
        /// Number of columns.
        width: u32,
        /// Number of rows.
        height: u32,
    },
}

/// Asks every renderer and the referee about one ray.
///
/// # Errors
/// The scene does not have this ray.
///
/// ```
/// # use std::sync::Arc;
/// # use glam::DVec3;
/// use raypencil_harness::{contender, probe};
/// use raypencil_scene::{Place, SensorId};
/// # use raypencil_scene::{Atmosphere, FluxModel, Scene, Silent, rig};
/// # use raypencil_scene_io::Subject;
///
/// # let mesh = raypencil_terrain::builtin("pyramids", 0.25).expect("a built-in name").into_mesh()?;
/// # let (camera, beams) = rig::default_rig(64, DVec3::ZERO, 0.0);
/// # let air = Atmosphere { attenuation: 0.0 };
/// # let scene = Scene::new(Arc::new(mesh), camera, beams, air, FluxModel::Radiometric)?;
/// # let subject = Subject {
/// #     scene,
/// #     name: "small".into(),
/// #     arguments: "small.toml".into(),
/// #     sha256: "0".repeat(64),
/// #     vehicle: None,
/// #     file_facts: Default::default(),
/// # };
/// // The lowest row of the camera's 16 x 16 pixels looks at the ground.
/// let place = Place { sensor: SensorId::Camera, i: 8, j: 15 };
/// let found = probe(&subject, place, &[contender("tracer").expect("a name")], &Silent)?;
/// assert!(found.exact.is_some());
/// assert_eq!(found.answers[0].hit.map(|hit| hit.face), found.exact.map(|hit| hit.face));
/// assert_eq!(found.command, "raypencil probe small.toml --pixel 8,15");
/// // Rows are counted from 0, so there is no row 16.
/// assert!(probe(&subject, Place { j: 16, ..place }, &[], &Silent).is_err());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn probe(
    subject: &Subject,
    place: Place,
    contenders: &[Contender],
    progress: &dyn Progress,
) -> Result<Probe, NoSuchRay> {
    let Place { sensor, i, j } = place;
    let scene = &subject.scene;
    let Some((width, height)) = scene.size(sensor) else {
        let SensorId::Beam(index) = sensor else { unreachable!("every scene has a camera") };
        return Err(NoSuchRay::Beam { index, count: scene.beams().len() });
    };
    let no_such_cell = NoSuchRay::Cell { sensor, i, j, width, height };
    if i >= width || j >= height {
        return Err(no_such_cell);
    }
    progress.stage("referee: preparing");
    let judge = Judge::new(scene, JudgeShare::Sample);
    let answers: Vec<ProbedAnswer> = contenders
        .iter()
        .map(|contender| {
            progress.stage(&format!("{}: rendering", contender.renderer.name()));
            ask(&judge, place, contender)
        })
        .collect();
    with_exact_answer(&judge, subject, place, answers).ok_or(no_such_cell)
}

/// One ray of outputs that are there already: no renderer runs again. `None` if the scene does not have the ray.
pub(crate) fn probe_rendered(
    judge: &Judge<'_>,
    subject: &Subject,
    place: Place,
    rendered: &[Rendered],
) -> Option<Probe> {
    let answers = rendered.iter().map(|side| {
        let Rendered { name, precision, attributions, output, .. } = side;
        answer(judge, place, name, *precision, output, |_| Cow::Borrowed(attributions))
    });
    let answers = answers.collect();
    with_exact_answer(judge, subject, place, answers)
}

/// Adds the exact answer and its margins. `None` if the scene does not have the ray.
fn with_exact_answer(
    judge: &Judge<'_>,
    subject: &Subject,
    place: Place,
    answers: Vec<ProbedAnswer>,
) -> Option<Probe> {
    let Place { sensor, i, j } = place;
    let scene = &subject.scene;
    let (ray, max_range) = (scene.ray(sensor, i, j)?, scene.max_range(sensor)?);
    let referee = judge.referee();
    let (verdict, Margins { face, surface }) = referee.verdict_with_margins(sensor, i, j)?;
    let exact = verdict.faces.first().and_then(|face| referee.hit(sensor, i, j, *face));
    let exact = exact.map(|hit| hit.in_format(Format::Double));
    let exact_return = match sensor {
        SensorId::Camera => None,
        SensorId::Beam(index) => {
            let back = referee.light(index, Sampling::Centres).and_then(|light| light.returned(i, j));
            back.map(|back| back.in_format(Format::Double, scene.flux_model()))
        }
    };
    let visibility_margins = match sensor {
        SensorId::Camera => None,
        SensorId::Beam(index) => referee.visibility_margins(index, i, j),
    };
    let command = probe_command(subject, place);
    Some(Probe {
        place,
        command,
        ray,
        max_range,
        answers,
        candidates: Vec::new(),
        verdict,
        exact,
        exact_return,
        flux_unit: Quantity::PencilFlux.unit(scene.flux_model()),
        face_margin: face,
        surface_margin: surface,
        visibility_margins,
    })
}

/// One renderer's answer, for which it runs.
fn ask(judge: &Judge<'_>, place: Place, contender: &Contender) -> ProbedAnswer {
    let sensor = place.sensor;
    // The whole sensor is rendered for one ray, so that the answer is the one that `validate` compares.
    let request = Request {
        camera: sensor == SensorId::Camera,
        beams: sensor != SensorId::Camera,
        returns: sensor != SensorId::Camera,
        ..Request::EVERYTHING
    };
    let renderer = &contender.renderer;
    let output = renderer.render(judge.scene(), &request);
    let attributions =
        |output: &_| Cow::Owned(attribute(judge, output, contender.approximations(), renderer.precision()));
    answer(judge, place, renderer.name(), renderer.precision(), &output, attributions)
}

/// The answer of an output to one ray. `attributions` are asked for if the answer is wrong.
fn answer<'a>(
    judge: &Judge<'_>,
    place: Place,
    name: &str,
    precision: Precision,
    output: &RenderOutput,
    attributions: impl FnOnce(&RenderOutput) -> Cow<'a, Attributions>,
) -> ProbedAnswer {
    let Place { sensor, i, j } = place;
    let hit = output.map(sensor).and_then(|map| map.hit(i, j));
    let (face, range) = (hit.map(|hit| hit.face), hit.map(|hit| hit.range));
    let ruling = judge.rule(place, face, range, precision);
    let mut back = returned(judge, place, precision, output, hit);
    let is_wrong =
        ruling == Ruling::Wrong || back.as_ref().is_some_and(|back| back.ruling.visible == Ruling::Wrong);
    let attributions = is_wrong.then(|| attributions(output));
    let cause = attributions.as_ref().and_then(|attributions| attributions.cause(place).cloned());
    if let Some(back) = &mut back {
        back.cause =
            attributions.as_ref().and_then(|attributions| attributions.visibility_cause(place).cloned());
    }
    let class = Class::of(ruling, cause.is_some());
    ProbedAnswer { renderer: name.to_string(), hit, ruling, class, cause, back }
}

/// One renderer's return of a pencil.
fn returned(
    judge: &Judge<'_>,
    place: Place,
    precision: Precision,
    output: &RenderOutput,
    hit: Option<Hit>,
) -> Option<ProbedReturn> {
    let Place { sensor: SensorId::Beam(index), i, j } = place else { return None };
    let (hit, returns) = (hit?, output.returns.get(index)?);
    let back = Return {
        visible: returns.visible.as_ref()?.at(i, j),
        pixel: returns.pixel.as_ref()?.at(i, j).get(),
        depth: returns.depth.as_ref()?.at(i, j).get()?,
        cos_off_axis: returns.cos_off_axis.as_ref()?.at(i, j).get()?,
        cos_view: returns.cos_view.as_ref()?.at(i, j).get()?,
        flux: returns.flux.as_ref()?.at(i, j),
    };
    let ruling =
        judge.rule_visibility(place, hit.face, Some(hit.range), back.visible, back.pixel, precision)?;
    Some(ProbedReturn { back, ruling, cause: None })
}
