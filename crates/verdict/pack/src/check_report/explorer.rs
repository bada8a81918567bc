//! The part of the page that answers when asked: the candidate beside the exact answers.

use rayon::prelude::*;
use raypencil_explorer::{
    DescribedRay, ExplorerPage, RayMargins, RayToDescribe, SensorPair, SideKind, SideMaps, rays_to_describe,
};
use raypencil_judge::{
    Answers, Class, GroundTruth, Judge, JudgeShare, Quantity, SensorResult, check_ray_against,
};
use raypencil_referee::Format;
use raypencil_report::described_words;
use raypencil_scene::{Image, Place, Sampling, SensorId};

use crate::check::Checked;
use crate::check_report::findings::arithmetic;

/// Indices of the sides.
const EXACT: usize = 0;
const CANDIDATE: usize = 1;

/// The elements of the page that the explorer needs, with all that it shows.
pub(super) fn explorer(checked: &Checked) -> String {
    let Checked { subject, recorded, check, exact, .. } = checked;
    let scene = &subject.scene;
    let judge = Judge::new(scene, JudgeShare::Sample);
    let probe = format!("raypencil probe {}", subject.arguments);
    let title = format!("{} on {}", recorded.name, subject.name);
    let mut page = ExplorerPage::new("check", scene, &title, &probe);
    page.add_side("exact", SideKind::Exact, "the pack's answers, correctly rounded");
    page.add_side(&recorded.name, SideKind::Candidate, arithmetic(recorded.precision));
    for result in &check.sensors {
        let sensor = result.sensor;
        let fluxes = [exact, &recorded.answers].map(|answers| flux_on(answers, sensor));
        let sides = [exact, &recorded.answers].map(|answers| {
            let returns = match sensor {
                SensorId::Camera => None,
                SensorId::Beam(beam) => Some(&answers.light[beam].returns),
            };
            SideMaps { map: answers.map(sensor), returns, flux: &[] }
        });
        let [of_exact, of_candidate] = [0, 1].map(|k| Some(SideMaps { flux: &fluxes[k], ..sides[k] }));
        let pair = SensorPair { sides: [EXACT, CANDIDATE], result, compared: None };
        let margins = RayMargins::of_judged(&judge, sensor, &[pair]);
        page.add_sensor(sensor, &[of_exact, of_candidate], &[pair], Some(&margins));
    }
    let differing = check.sensors.iter().flat_map(|result| {
        let maps = [exact, &recorded.answers].map(|answers| Some(answers.map(result.sensor)));
        RayToDescribe::of(0, result, maps)
    });
    let all: Vec<RayToDescribe> = differing.collect();
    let total = all.len() as u64;
    let chosen = rays_to_describe(all);
    let truth = GroundTruth::borrowing(scene, exact);
    let rays: Vec<DescribedRay> = chosen.par_iter().map(|ray| describe(checked, &truth, ray.place)).collect();
    let words = described_words(rays.len() as u64, total);
    page.set_rays(&rays, &words);
    if let Some(opening) = opening(checked) {
        page.insert("opening", opening.into());
    }
    page.html()
}

/// The address of the worst ray of the sensor with the most wrong rays, and the difference of what is wrong there; `None` if
/// nothing is wrong.
fn opening(checked: &Checked) -> Option<String> {
    let wrong = |result: &&SensorResult| result.of(Class::Defect);
    let sensors = checked.check.sensors.iter().filter(|result| wrong(result) > 0);
    // Among equals the first.
    let worst = sensors.reduce(|worst, other| if wrong(&other) > wrong(&worst) { other } else { worst })?;
    let ray = worst.listed.first()?;
    let channel = match ray.item.quantity {
        Quantity::Face => "face.I",
        Quantity::Depth => "depth.Z",
        Quantity::CosIncidence => "incidence.V",
        Quantity::Visible => "visible.V",
        Quantity::PencilFlux => "flux.V",
        _ => "range.T",
    };
    Some(format!("{}/{},{}/{channel}/diff", worst.sensor, ray.place.i, ray.place.j))
}

/// The images of the beams, which belong to the camera.
fn flux_on(answers: &Answers, sensor: SensorId) -> Vec<Option<&Image<f64>>> {
    let images = answers.light.iter().map(|light| light.image.as_ref());
    if sensor == SensorId::Camera { images.collect() } else { Vec::new() }
}

fn describe(checked: &Checked, truth: &GroundTruth<'_>, place: Place) -> DescribedRay {
    let referee = truth.judge().referee();
    let (verdict, margins) = referee.verdict_with_margins(place.sensor, place.i, place.j).unzip();
    let hit = referee.values(place.sensor, place.i, place.j).map(|hit| hit.in_format(Format::Double));
    let (back, of_view) = match place.sensor {
        SensorId::Camera => (None, None),
        SensorId::Beam(beam) => {
            let light = referee.light(beam, Sampling::Centres);
            let back = light.and_then(|light| light.returned(place.i, place.j));
            let back = back.map(|back| back.in_format(Format::Double, checked.subject.scene.flux_model()));
            (back, referee.visibility_margins(beam, place.i, place.j))
        }
    };
    let faces = verdict.map(|verdict| verdict.faces.iter().map(|face| face.0).collect());
    let said = check_ray_against(truth, &checked.recorded, place);
    let said = said.map_or(String::new(), |ray| ray.text(&checked.recorded.name));
    let text = format!("{place}\n{said}  again: {}\n", checked.repro(place));
    let witness = |margin: Option<raypencil_referee::Margin>| margin?.witness.map(|by| [by.dx, by.dy]);
    let [of_face, of_surface] = match margins {
        Some(margins) => [Some(margins.face), Some(margins.surface)],
        None => [None, None],
    };
    DescribedRay {
        place,
        pair: 0,
        text,
        faces: faces.unwrap_or_default(),
        hit: hit.map(|hit| (hit.point.to_array(), hit.range)),
        visible: back.map(|back| (back.visible, back.pixel)),
        witnesses: [
            witness(of_face),
            witness(of_surface),
            witness(of_view.map(|margins| margins.visibility)),
        ],
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use raypencil_judge::ListedDefect;
    use raypencil_scene::Silent;

    use super::*;
    use crate::check_pack;

    #[test]
    fn the_page_opens_on_the_sensor_with_the_most_wrong_rays_and_on_what_is_wrong() {
        let pack = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../data/packs/hard");
        let mut checked = check_pack(&pack, &pack, None, &Silent).expect("a pack as it was written");
        assert_eq!(opening(&checked), None);
        // The camera, beam-0, beam-1 and beam-2. Of the two with the most the first is shown.
        for (at, wrong) in [1, 3, 3, 2].into_iter().enumerate() {
            let sensor = checked.check.sensors[at].sensor;
            checked.check.sensors[at].by_class[Class::Defect as usize] = wrong;
            checked.check.sensors[at].listed.push(ListedDefect {
                place: Place { sensor, i: 5, j: 1 },
                item: Quantity::Range.into(),
                said: Vec::new(),
                truth: String::new(),
                difference: None,
                difference_unit: "m",
                ratio: None,
                margin: None,
                what: String::new(),
            });
        }
        for (quantity, channel) in [
            (Quantity::Hit, "range.T"),
            (Quantity::Range, "range.T"),
            (Quantity::Face, "face.I"),
            (Quantity::Depth, "depth.Z"),
            (Quantity::CosIncidence, "incidence.V"),
            (Quantity::Visible, "visible.V"),
            (Quantity::PencilFlux, "flux.V"),
        ] {
            checked.check.sensors[1].listed[0].item = quantity.into();
            assert_eq!(opening(&checked), Some(format!("beam-0/5,1/{channel}/diff")));
        }
    }
}
