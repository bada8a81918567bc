//! The part of the report that answers when asked: the validation as the model of a page.

use rayon::prelude::*;
use raypencil_explorer::{
    ComparedMaps, DescribedRay, ExplorerPage, RayMargins, SensorPair, SideKind, SideMaps,
};
use raypencil_judge::{Answers, Class, Judge, JudgeShare, SensorResult};
use raypencil_report::count;
use raypencil_scene::{Image, Place, Pose, RenderOutput, SensorId, SensorMap, Switches};

use crate::probe::{Probe, probe_rendered};
use crate::validation::Validation;

/// Maximum number of rays that a page describes in full. Each takes about 1.5 kB before it is deflated.
const MAX_DESCRIBED_RAYS: usize = 1000;

/// The elements of the page that the explorer needs, with all that it shows.
pub(crate) fn explorer(validation: &Validation) -> String {
    let subject = &validation.subject;
    let scene = &subject.scene;
    let judge = Judge::on(scene, &validation.tree, JudgeShare::Sample);
    let probe = format!("raypencil probe {}", subject.arguments);
    let mut page = ExplorerPage::new("validate", scene, &subject.name, &probe);
    if let Some(vehicle) = &subject.vehicle {
        // The scene frame is the global frame, moved to the scene's origin.
        page.set_vehicle(&Pose { position: vehicle.position - scene.mesh().origin(), ..*vehicle });
    }
    for rendered in &validation.rendered {
        let words = match rendered.approximations {
            Switches::EXACT => "exact".to_string(),
            switches => format!("with the paper's {switches}"),
        };
        page.add_side(&rendered.name, SideKind::Renderer, &words);
    }
    let exact_side = validation.rendered.len();
    if validation.scoreboard.is_some() {
        page.add_side("exact", SideKind::Exact, "the referee's answers, correctly rounded");
        for report in validation.candidates() {
            page.add_side(&report.candidate.name, SideKind::Candidate, "files of another program");
        }
    }
    page.set_causes(&validation.approximations());

    for sensor in scene.sensors() {
        let fluxes: Vec<Vec<Option<&Image<f64>>>> =
            validation
                .rendered
                .iter()
                .map(|side| flux_on(sensor, side.output.flux.iter().map(Some)))
                .chain(answers_of(validation).map(|answers| {
                    flux_on(sensor, answers.light.iter().map(|of_beam| of_beam.image.as_ref()))
                }))
                .collect();
        let renderers = validation.rendered.iter().map(|side| side_of_output(&side.output, sensor));
        let others = answers_of(validation).map(|answers| {
            let returns = match sensor {
                SensorId::Camera => None,
                SensorId::Beam(beam) => Some(&answers.light[beam].returns),
            };
            Some(SideMaps { map: answers.map(sensor), returns, flux: &[] })
        });
        let sides: Vec<Option<SideMaps<'_>>> = renderers
            .chain(others)
            .zip(&fluxes)
            .map(|(side, flux)| side.map(|side| SideMaps { flux, ..side }))
            .collect();
        let pairs = pairs_on(validation, sensor, exact_side);
        let margins = RayMargins::of_judged(&judge, sensor, &pairs);
        page.add_sensor(sensor, &sides, &pairs, Some(&margins));
    }
    let (rays, words) = described(validation, &judge);
    page.set_rays(&rays, &words);
    page.html()
}

/// The exact answers, then those of each candidate; nothing without candidates.
fn answers_of(validation: &Validation) -> impl Iterator<Item = &Answers> {
    let scoreboard = validation.scoreboard.iter();
    scoreboard.flat_map(|scoreboard| {
        let candidates = scoreboard.candidates.iter().map(|report| &report.candidate.recorded.answers);
        std::iter::once(&scoreboard.exact).chain(candidates)
    })
}

/// A renderer's maps of a sensor, without the images of the beams.
fn side_of_output(output: &RenderOutput, sensor: SensorId) -> Option<SideMaps<'_>> {
    let returns = match sensor {
        SensorId::Camera => None,
        SensorId::Beam(beam) => output.returns.get(beam),
    };
    Some(SideMaps { map: output.map(sensor)?, returns, flux: &[] })
}

/// The images of the beams, which belong to the camera.
fn flux_on<'v>(
    sensor: SensorId,
    images: impl Iterator<Item = Option<&'v Image<f64>>>,
) -> Vec<Option<&'v Image<f64>>> {
    if sensor == SensorId::Camera { images.collect() } else { Vec::new() }
}

/// The pairs of renderers on a sensor, then the exact answers beside each candidate.
fn pairs_on(validation: &Validation, sensor: SensorId, exact_side: usize) -> Vec<SensorPair<'_>> {
    let of_renderers = validation.pairs.iter().filter_map(|pair| {
        let result = pair.sensors.iter().find(|result| result.sensor == sensor)?;
        let [a, b] = [pair.a, pair.b].map(|side| &validation.rendered[side]);
        let compared = a
            .output
            .map(sensor)
            .zip(b.output.map(sensor))
            .map(|(of_a, of_b)| ComparedMaps { maps: [of_a, of_b], precisions: [a.precision, b.precision] });
        Some(SensorPair { sides: [pair.a, pair.b], result, compared })
    });
    let of_candidates = validation.candidates().iter().enumerate().filter_map(|(index, report)| {
        let result = report.check.sensors.iter().find(|result| result.sensor == sensor)?;
        Some(SensorPair { sides: [exact_side, exact_side + 1 + index], result, compared: None })
    });
    of_renderers.chain(of_candidates).collect()
}

/// A ray that a pair of renderers answers differently.
struct Differing {
    place: Place,
    pair: usize,
    class: Class,
    /// Difference of the ranges, metres; where one side hits nothing, the range of the other.
    size: f64,
}

/// The rays that are described in full, and which these are in words.
fn described(validation: &Validation, judge: &Judge<'_>) -> (Vec<DescribedRay>, String) {
    let mut all: Vec<Differing> = Vec::new();
    for (pair, of_pair) in validation.pairs.iter().enumerate() {
        for result in &of_pair.sensors {
            let maps = [of_pair.a, of_pair.b].map(|side| validation.rendered[side].output.map(result.sensor));
            all.extend(differing_rays(pair, result, maps));
        }
    }
    let total = all.len();
    let chosen = chosen(all);
    let words = if chosen.len() == total {
        format!("Every ray that is not 'agree' is described in full: {}.", count(total as u64))
    } else {
        format!(
            "{} of the {} rays that are not 'agree' are described in full: the worst half by class and size, and a fair \
             sample of the others. The command of each ray prints the rest.",
            count(chosen.len() as u64),
            count(total as u64)
        )
    };
    let rays = chosen
        .par_iter()
        .filter_map(|ray| {
            let probe = probe_rendered(judge, &validation.subject, ray.place, &validation.rendered)?;
            Some(describe(&probe, ray.pair))
        })
        .collect();
    (rays, words)
}

fn differing_rays<'r>(
    pair: usize,
    result: &'r SensorResult,
    maps: [Option<&'r SensorMap>; 2],
) -> impl Iterator<Item = Differing> + 'r {
    result.differing.iter().map(move |ray| {
        let ranges = maps.map(|map| map?.range.as_ref()?.at(ray.i, ray.j).get());
        let size = match ranges {
            [Some(a), Some(b)] => (a - b).abs(),
            [Some(one), None] | [None, Some(one)] => one,
            [None, None] => 0.0,
        };
        let place = Place { sensor: result.sensor, i: ray.i, j: ray.j };
        Differing { place, pair, class: ray.class, size }
    })
}

/// At most [`MAX_DESCRIBED_RAYS`]: the worst half, and a sample of the others, spread evenly in reading order.
fn chosen(mut all: Vec<Differing>) -> Vec<Differing> {
    if all.len() <= MAX_DESCRIBED_RAYS {
        return all;
    }
    // Stable: of equals the first in reading order.
    all.sort_by(|a, b| b.class.cmp(&a.class).then(b.size.total_cmp(&a.size)));
    let mut others = all.split_off(MAX_DESCRIBED_RAYS / 2);
    others.sort_by_key(|ray| (ray.pair, ray.place.sensor, ray.place.j, ray.place.i));
    let room = MAX_DESCRIBED_RAYS - all.len();
    let count = others.len();
    let mut next = 0;
    all.extend(others.into_iter().enumerate().filter_map(|(index, ray)| {
        let is_due = index * room >= next * count && next < room;
        next += usize::from(is_due);
        is_due.then_some(ray)
    }));
    all
}

fn describe(probe: &Probe, pair: usize) -> DescribedRay {
    let of_view = probe.visibility_margins.as_ref().map(|margins| &margins.visibility);
    let witness = |margin: Option<&raypencil_referee::Margin>| margin?.witness.map(|by| [by.dx, by.dy]);
    DescribedRay {
        place: probe.place,
        pair,
        text: probe.to_string(),
        faces: probe.verdict.faces.iter().map(|face| face.0).collect(),
        hit: probe.exact.map(|hit| (hit.point.to_array(), hit.range)),
        visible: probe.exact_return.as_ref().map(|back| (back.visible, back.pixel)),
        witnesses: [
            witness(Some(&probe.face_margin)),
            witness(Some(&probe.surface_margin)),
            witness(of_view),
        ],
    }
}
