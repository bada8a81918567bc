//! A plan before the judge: the corrected recording, and how many of its rays are right.

use std::collections::BTreeSet;

use rayon::prelude::*;

use crate::agree::absorbed;
use crate::case::Case;
use crate::channel::{Channel, Value};
use crate::correction::{Correction, before_rounding, corrected};
use crate::sample::{Key, WrongRays, key, place, some_of};
use crate::tally::Tally;
use crate::trial::Plan;
use raypencil_files::{Step, Storage};
use raypencil_judge::{Quantity, Recorded, check_rays};
use raypencil_scene::{Place, Precision, Scene, SensorId, Silent};

/// Rays of one sensor that the judge is asked about for each diagnosis, at most; of more, whole rows are left out. A
/// ray costs microseconds, so that a diagnosis takes seconds.
const MAX_JUDGED_RAYS: u64 = 1 << 14;

/// Wrong rays that the judge is asked about beside these rows, at most.
const MAX_JUDGED_WRONG_RAYS: usize = 1 << 13;

/// The rays that the judge is asked about: every so many rows of each sensor, and wrong rays.
#[derive(Debug)]
pub(crate) struct Asked {
    camera: u32,
    beams: Vec<u32>,
    /// Wrong rays that are asked about.
    wrong: BTreeSet<Key>,
    /// Whether the camera's flux is judged: all pencils are asked for then.
    needs_beams: bool,
    sensors: Vec<SensorId>,
}

impl Asked {
    pub(crate) fn of(case: Case<'_>, wrong: &WrongRays) -> Self {
        let scene: &Scene = case.truth.scene();
        let step = |sensor: SensorId| {
            let (width, height) = scene.size(sensor).unwrap_or((1, 1));
            (u64::from(width) * u64::from(height)).div_ceil(MAX_JUDGED_RAYS).max(1) as u32
        };
        let beams = (0..scene.beams().len()).map(|beam| step(SensorId::Beam(beam))).collect();
        let needs_beams = case.channels().iter().any(|channel| channel.item.quantity == Quantity::PixelFlux);
        let mut asked = Self {
            camera: step(SensorId::Camera),
            beams,
            wrong: BTreeSet::new(),
            needs_beams,
            sensors: case.sensors.to_vec(),
        };
        let of_rows = wrong.all.iter().filter(|ray| asked.is_of_rows(**ray)).copied();
        let more = some_of(&wrong.all, MAX_JUDGED_WRONG_RAYS).into_iter().map(key);
        asked.wrong = of_rows.chain(more).collect();
        asked
    }

    fn is_of_rows(&self, (sensor, j, _): Key) -> bool {
        let step = match sensor {
            SensorId::Camera => self.camera,
            SensorId::Beam(beam) => self.beams[beam],
        };
        j % step == 0
    }

    fn is_asked(&self, ray: Key) -> bool {
        if self.sensors.contains(&ray.0) {
            self.is_of_rows(ray) || self.wrong.contains(&ray)
        } else {
            self.needs_beams && self.is_of_rows(ray)
        }
    }

    /// Whether all pencils of a beam are asked for: without them, the flux of its image cannot be judged.
    fn is_whole(&self, beam: usize) -> bool {
        self.beams[beam] == 1
    }
}

/// Judges a recording after the corrections of a plan. Rays that no cell holds then are left out: whether they are
/// right, nobody can tell.
pub(crate) fn judge(
    case: Case<'_>,
    plan: &Plan,
    asked: &Asked,
    wrong: &WrongRays,
    precision: Precision,
) -> Tally {
    let mut recorded = corrected_recording(case, plan);
    recorded.precision = precision;
    for (beam, light) in recorded.answers.light.iter_mut().enumerate() {
        if !asked.is_whole(beam) {
            light.image = None;
            light.other_image = None;
        }
    }
    // Pencils of beams that are not looked at have their true light: the camera's flux is judged by itself.
    let scene = case.truth.scene();
    let others = (0..scene.beams().len()).filter(|beam| !case.sensors.contains(&SensorId::Beam(*beam)));
    for beam in others {
        let exact = case.truth.answers();
        recorded.answers.maps[beam + 1] = exact.maps[beam + 1].clone();
        recorded.answers.light[beam].returns = exact.light[beam].returns.clone();
        recorded.answers.light[beam].other_flux = exact.light[beam].other_flux.clone();
    }
    let check = check_rays(case.truth, &recorded, &|place| asked.is_asked(key(place)), &Silent);
    let after = WrongRays::of(&check, case.sensors);
    let is_held = |ray: &&Key| is_held(case, plan, place(**ray));
    let before: BTreeSet<Key> = asked.wrong.iter().filter(is_held).copied().collect();
    let explained = before.iter().filter(|ray| !after.all.contains(ray)).count() as u64;
    let broken = after.all.iter().filter(|ray| !wrong.all.contains(ray)).filter(is_held).count() as u64;
    let right = after.compared.saturating_sub(asked.wrong.len() as u64);
    // Hardly any ray is left to tell: that explains nothing.
    if 2 * before.len() < asked.wrong.len() {
        return Tally { explained: 0, wrong: asked.wrong.len() as u64, broken, right };
    }
    Tally { explained, wrong: before.len() as u64, broken, right }
}

/// Whether some cell holds each value of a ray after the corrections of a plan.
fn is_held(case: Case<'_>, plan: &Plan, place: Place) -> bool {
    let of_sensor = plan.applied.iter().filter(|(channel, _)| channel.sensor == place.sensor);
    of_sensor.into_iter().all(|(_, subset)| {
        let all = plan.corrections.iter().enumerate().filter(|(index, _)| subset >> index & 1 == 1);
        all.into_iter().try_fold(place, |place, (_, one)| one.source(case, place)).is_some()
    })
}

fn corrected_recording(case: Case<'_>, plan: &Plan) -> Recorded {
    let mut recorded = case.recorded.clone();
    for (channel, subset) in plan.applied.iter().filter(|(_, subset)| *subset != 0) {
        let all = plan.corrections.iter().enumerate();
        let own: Vec<&Correction> =
            all.filter(|(index, _)| subset >> index & 1 == 1).map(|(_, one)| one).collect();
        let size = case.truth.scene().size(channel.sensor).expect("a sensor of this scene");
        let cells = corrected_cells(case, *channel, size, &own);
        channel.replace(&mut recorded.answers, size, &cells);
    }
    recorded
}

/// A corrected value of a channel that is stored in steps, for the judge, who allows half a step to any value: the exact one if the steps
/// explain what is left, and else one that half a step does not excuse. A step of the file is no step of a length that was made of it: of
/// metres that are read as kilometres it is a thousand times as long.
fn in_steps(
    step: Step,
    [stated, corrected, exact]: [Value; 3],
    between: impl FnOnce() -> Option<[f64; 2]>,
) -> Value {
    match (stated, corrected, exact) {
        (Value::Number(stated), Value::Number(number), Value::Number(own)) if stated != number => {
            let slack = 8.0 * f64::EPSILON * own.abs();
            let is_within = |[least, most]: [f64; 2]| (least - slack..=most + slack).contains(&own);
            if between().is_some_and(is_within) {
                return exact;
            }
            let half = (0.5 * step.get()).copysign(number - own);
            Value::Number(if number == own { number } else { number + half })
        }
        _ => absorbed(Storage::Steps(step), stated, corrected, exact),
    }
}

fn corrected_cells(
    case: Case<'_>,
    channel: Channel,
    (width, height): (u32, u32),
    corrections: &[&Correction],
) -> Vec<Value> {
    let storage = case.recorded.storage.get(&(channel.sensor, channel.item)).copied().unwrap_or(Storage::F64);
    let is_flux = matches!(channel.item.quantity, Quantity::PencilFlux | Quantity::PixelFlux);
    (0..height)
        .into_par_iter()
        .flat_map_iter(|j| {
            (0..width).map(move |i| {
                let place = Place { sensor: channel.sensor, i, j };
                let exact = channel.at(case.truth.answers(), place);
                // A ray that no cell holds counts neither way: it gets its exact value.
                let Some(value) = corrected(case, channel, place, corrections) else { return exact };
                let source = corrections.iter().try_fold(place, |source, one| one.source(case, source));
                let stated = channel.at(&case.recorded.answers, source.unwrap_or(place));
                let between = || before_rounding(case, channel, place, corrections, 0.5);
                let settled = match storage {
                    Storage::Steps(step) => in_steps(step, [stated, value, exact], between),
                    _ => absorbed(storage, stated, value, exact),
                };
                match (settled, exact) {
                    // What no correction makes right must be a number: one that is missing beside a face is not compared.
                    (Value::Number(number), Value::Number(exact)) if !number.is_finite() => {
                        Value::Number(2.0 * exact.abs() + 1.0)
                    }
                    (Value::Vector(vector), Value::Vector(exact)) if !vector.is_finite() => {
                        Value::Vector(-exact - 1.0)
                    }
                    // A flux is never anything else than a number.
                    (Value::Number(number), _) if is_flux && !number.is_finite() => Value::Number(0.0),
                    (value, _) => value,
                }
            })
        })
        .collect()
}
