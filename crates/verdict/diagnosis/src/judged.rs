//! A plan before the judge: the corrected recording, and how many of its rays are right.

use rayon::prelude::*;

use crate::agree::absorbed;
use crate::channel::{Channel, Value};
use crate::correction::{Case, Correction, corrected};
use crate::sample::{Key, WrongRays, key};
use crate::trial::Plan;
use raypencil_files::Storage;
use raypencil_judge::{Quantity, Recorded, check_rays};
use raypencil_scene::{Place, Precision, Scene, SensorId, Silent};

/// Rays of one sensor that the judge is asked about for each diagnosis, at most; of more, whole rows are left out. A
/// ray costs microseconds, so that a diagnosis takes seconds.
const MAX_JUDGED_RAYS: u64 = 1 << 16;

/// The rays that the judge is asked about: every so many rows of each sensor.
#[derive(Debug)]
pub(crate) struct Asked {
    camera: u32,
    beams: Vec<u32>,
}

impl Asked {
    pub(crate) fn of(scene: &Scene) -> Self {
        let step = |sensor: SensorId| {
            let (width, height) = scene.size(sensor).unwrap_or((1, 1));
            (u64::from(width) * u64::from(height)).div_ceil(MAX_JUDGED_RAYS).max(1) as u32
        };
        let beams = (0..scene.beams().len()).map(|beam| step(SensorId::Beam(beam))).collect();
        Self { camera: step(SensorId::Camera), beams }
    }

    pub(crate) fn is_asked(&self, (sensor, j, _): Key) -> bool {
        let step = match sensor {
            SensorId::Camera => self.camera,
            SensorId::Beam(beam) => self.beams[beam],
        };
        j % step == 0
    }

    /// Whether all pencils of a beam are asked for: without them, the flux of its image cannot be judged.
    fn is_whole(&self, beam: usize) -> bool {
        self.beams[beam] == 1
    }
}

/// A plan that was judged.
#[derive(Debug)]
pub(crate) struct Judged {
    /// Rays that are not wrong after it.
    pub(crate) right: u64,
    /// Rays that are wrong after it.
    pub(crate) wrong: u64,
}

/// Judges a recording after the corrections of a plan.
pub(crate) fn judge(case: Case<'_>, plan: &Plan, asked: &Asked, precision: Precision) -> Judged {
    let mut recorded = corrected_recording(case, plan);
    recorded.precision = precision;
    for (beam, light) in recorded.answers.light.iter_mut().enumerate() {
        if !asked.is_whole(beam) {
            light.image = None;
            light.other_image = None;
        }
    }
    let check = check_rays(case.truth, &recorded, &|place| asked.is_asked(key(place)), &Silent);
    let wrong = WrongRays::of(&check).all.len() as u64;
    Judged { right: check.compared().saturating_sub(wrong), wrong }
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
                match absorbed(storage, stated, value, exact) {
                    // A flux is never negative, nor anything else than a number.
                    Value::Number(number) if is_flux && !number.is_finite() => Value::Number(0.0),
                    value => value,
                }
            })
        })
        .collect()
}
