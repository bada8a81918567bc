//! Everything about one ray, from every renderer.

pub(crate) mod words;

use crate::renderers::{Contender, attribute};
use raypencil_judge::{Cause, Class, Judge, JudgeShare, Quantity, VisibilityCause};
use raypencil_referee::{Format, Margin, Margins, Ruling, Verdict, VisibilityMargins, VisibilityRuling};
use raypencil_scene::Place;
use raypencil_scene::{Hit, Progress, Ray, RenderOutput, Request, Return, Sampling, SensorId};
use raypencil_scene_io::{Subject, probe_command};

/// One ray and what each renderer says of it.
#[derive(Debug, Clone)]
pub struct Probe {
    /// Which ray.
    pub place: Place,
    /// The command that repeats this.
    pub command: String,
    /// The contract's ray, rounded to f64, scene frame.
    pub ray: Ray,
    /// The longest range along it, metres.
    pub max_range: f64,
    /// Each renderer's answer.
    pub answers: Vec<ProbedAnswer>,
    /// The exact verdict.
    pub verdict: Verdict,
    /// What is hit exactly, its values rounded; the lowest face of a tie.
    pub exact: Option<Hit>,
    /// What comes back of the exact hit of a pencil.
    pub exact_return: Option<Return>,
    /// Unit of a flux.
    pub flux_unit: &'static str,
    /// The least displacement that changes the set of nearest faces.
    pub face_margin: Margin,
    /// The least displacement at which the range jumps.
    pub surface_margin: Margin,
    /// Of a pencil that hits: how far the camera's view of it is from changing.
    pub visibility_margins: Option<VisibilityMargins>,
}

/// One renderer's answer to a ray, and what it is.
#[derive(Debug, Clone)]
pub struct ProbedAnswer {
    /// The renderer's name.
    pub renderer: String,
    /// What it says; `None` for a miss.
    pub hit: Option<Hit>,
    /// What the referee rules on it.
    pub ruling: Ruling,
    /// What `validate` makes of that; an agreeing answer's values may still be out of bounds.
    pub class: Class,
    /// Why it is wrong, if a cause is confirmed.
    pub cause: Option<Cause>,
    /// What it says comes back of a pencil that it says hits.
    pub back: Option<ProbedReturn>,
}

/// What one renderer says comes back of a pencil, and what that is.
#[derive(Debug, Clone)]
pub struct ProbedReturn {
    /// What it says.
    pub back: Return,
    /// What the referee rules on whether the point is seen, and on where it lands.
    pub ruling: VisibilityRuling,
    /// Why it is wrong about being seen, if a cause is confirmed.
    pub cause: Option<VisibilityCause>,
}

/// Why there is no such ray.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum NoSuchRay {
    /// The scene has fewer beams.
    #[error("there is no beam {index}: the scene has {count}, counted from 0")]
    Beam {
        /// The beam asked for.
        index: usize,
        /// How many there are.
        count: usize,
    },
    /// The sensor has fewer cells.
    #[error("{sensor} has no cell {i},{j}: it is {width} x {height}, counted from 0,0")]
    Cell {
        /// The sensor asked for.
        sensor: SensorId,
        /// The column asked for.
        i: u32,
        /// The row asked for.
        j: u32,
        /// Its columns.
        width: u32,
        /// Its rows.
        height: u32,
    },
}

/// Asks every renderer about one ray.
///
/// # Errors
/// If the scene has no such ray.
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
    let (Some(ray), Some(max_range)) = (scene.ray(sensor, i, j), scene.max_range(sensor)) else {
        return Err(no_such_cell);
    };
    progress.stage("referee: preparing");
    let judge = Judge::new(scene, JudgeShare::Sample);
    let answers = contenders
        .iter()
        .map(|contender| {
            progress.stage(&format!("{}: rendering", contender.renderer.name()));
            ask(&judge, place, contender)
        })
        .collect();
    let referee = judge.referee();
    let Some(Margins { verdict, face, surface }) = referee.margins(sensor, i, j) else {
        return Err(no_such_cell);
    };
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
    Ok(Probe {
        place,
        command,
        ray,
        max_range,
        answers,
        verdict,
        exact,
        exact_return,
        flux_unit: Quantity::PencilFlux.unit(scene.flux_model()),
        face_margin: face,
        surface_margin: surface,
        visibility_margins,
    })
}

/// One renderer's answer.
fn ask(judge: &Judge<'_>, place: Place, contender: &Contender) -> ProbedAnswer {
    let Place { sensor, i, j } = place;
    // A whole sensor is rendered for one ray: the answer must be the one that `validate` compares.
    let request = Request {
        camera: sensor == SensorId::Camera,
        beams: sensor != SensorId::Camera,
        returns: sensor != SensorId::Camera,
        ..Request::EVERYTHING
    };
    let renderer = &contender.renderer;
    let output = renderer.render(judge.scene(), &request);
    let hit = output.map(sensor).and_then(|map| {
        Some(Hit {
            face: map.face.as_ref()?.at(i, j).get()?,
            range: map.range.as_ref()?.at(i, j).get()?,
            point: map.point.as_ref()?.at(i, j).get()?,
            normal: map.normal.as_ref()?.at(i, j).get()?,
            depth: map.depth.as_ref()?.at(i, j).get()?,
            cos_incidence: map.cos_incidence.as_ref()?.at(i, j).get()?,
        })
    });
    let (face, range) = (hit.map(|hit| hit.face), hit.map(|hit| hit.range));
    let ruling = judge.rule(place, face, range, renderer.precision());
    let mut back = returned(judge, place, contender, &output, hit);
    let is_wrong =
        ruling == Ruling::Wrong || back.as_ref().is_some_and(|back| back.ruling.visible == Ruling::Wrong);
    let attributions =
        is_wrong.then(|| attribute(judge, &output, contender.approximations(), renderer.precision()));
    let cause = attributions.as_ref().and_then(|attributions| attributions.cause(place).cloned());
    if let Some(back) = &mut back {
        back.cause =
            attributions.as_ref().and_then(|attributions| attributions.visibility_cause(place).cloned());
    }
    let class = Class::of(ruling, cause.is_some());
    ProbedAnswer { renderer: renderer.name().to_string(), hit, ruling, class, cause, back }
}

/// What one renderer says comes back of a pencil.
fn returned(
    judge: &Judge<'_>,
    place: Place,
    contender: &Contender,
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
    let precision = contender.renderer.precision();
    let ruling =
        judge.rule_visibility(place, hit.face, Some(hit.range), back.visible, back.pixel, precision)?;
    Some(ProbedReturn { back, ruling, cause: None })
}
