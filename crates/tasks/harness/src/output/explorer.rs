//! The part of the report that answers when asked: the validation as the model of a page.

use rayon::prelude::*;
use raypencil_explorer::{
    ComparedMaps, DescribedRay, ExplorerPage, RayMargins, RayToDescribe, SensorPair, SideKind, SideMaps,
    rays_to_describe,
};
use raypencil_judge::{Answers, GroundTruth, Judge, JudgeShare};
use raypencil_report::described_words;
use raypencil_scene::{Image, Pose, RenderOutput, SensorId, Switches};

use crate::probe::{Probe, probe_rendered};
use crate::validation::Validation;

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

/// The rays that are described in full, and which these are in words: of renderers beside each other, and of candidates
/// beside the exact answers.
fn described(validation: &Validation, judge: &Judge<'_>) -> (Vec<DescribedRay>, String) {
    let mut all: Vec<RayToDescribe> = Vec::new();
    for (pair, of_pair) in validation.pairs.iter().enumerate() {
        for result in &of_pair.sensors {
            let maps = [of_pair.a, of_pair.b].map(|side| validation.rendered[side].output.map(result.sensor));
            all.extend(RayToDescribe::of(pair, result, maps));
        }
    }
    let first_candidate = validation.pairs.len();
    let truth = validation.scoreboard.as_ref().map(|scoreboard| {
        let exact = &scoreboard.exact;
        for (index, report) in scoreboard.candidates.iter().enumerate() {
            for result in &report.check.sensors {
                let answers = [exact, &report.candidate.recorded.answers];
                let maps = answers.map(|answers| Some(answers.map(result.sensor)));
                all.extend(RayToDescribe::of(first_candidate + index, result, maps));
            }
        }
        GroundTruth::borrowing(&validation.subject.scene, exact)
    });
    let total = all.len();
    let chosen = rays_to_describe(all);
    let words = described_words(chosen.len() as u64, total as u64);
    let rays = chosen
        .par_iter()
        .filter_map(|ray| {
            let mut probe = probe_rendered(judge, &validation.subject, ray.place, &validation.rendered)?;
            if let (Some(truth), Some(index)) = (&truth, ray.pair.checked_sub(first_candidate)) {
                probe.ask_one(truth, &validation.candidates()[index].candidate);
            }
            Some(describe(&probe, ray.pair))
        })
        .collect();
    (rays, words)
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
