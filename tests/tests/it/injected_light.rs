//! Faults of light, injected into the naive renderer one by one: a comparison with either renderer must report defects.
//! Without a fault it must report none.

use std::collections::BTreeMap;
use std::sync::LazyLock;

use raypencil::judge::{Class, SensorResult, Side, compare};
use raypencil::pack::with_bench;
use raypencil::scanline::Scanline;
use raypencil::tracer::Tracer;
use raypencil::{FluxModel, RenderOutput, Renderer, Request, Scene, SensorId};
use raypencil_tests::injected_faults::light::{doubled, lit, screened};
use raypencil_tests::naive::{Fault, Naive};

/// The scenes that must reveal a fault.
fn scenes(fault: Fault) -> Vec<(&'static str, Scene)> {
    let both = || [FluxModel::Radiometric, FluxModel::Eq1].map(|model| ("lit pyramids", lit(model))).to_vec();
    match fault {
        // These faults concern one model only.
        Fault::PhiOfPixelCentre | Fault::FourthPower => vec![("lit pyramids", lit(FluxModel::Radiometric))],
        Fault::IncidenceOmitted | Fault::RangeOmitted | Fault::PhiOfPoint | Fault::PixelAreaOmitted => {
            vec![("lit pyramids", lit(FluxModel::Eq1))]
        }
        // A bench has plates before the SPP, plates that the camera sees from behind, and a beam that looks backwards.
        Fault::SeenFromBehind
        | Fault::BehindCameraLands
        | Fault::OccludersBeforePlane
        | Fault::PixelOfVisibleOnly
        | Fault::OffImageClamped => {
            static BENCHED: LazyLock<[Scene; 2]> = LazyLock::new(|| {
                let benched = |model| with_bench(&lit(model)).expect("a scene");
                [FluxModel::Radiometric, FluxModel::Eq1].map(benched)
            });
            BENCHED.clone().map(|scene| ("a bench", scene)).to_vec()
        }
        Fault::ShadowEpsilon => vec![("a plate 0.5 mm before a wall", screened(1.0 / 2048.0, false))],
        Fault::FacesAtPointHide => vec![("a wall of doubled faces", doubled())],
        Fault::ShadowsOfFronts => vec![("a plate that shows its back to the camera", screened(0.25, true))],
        _ => both(),
    }
}

fn side<'a>(renderer: &dyn Renderer, name: &'a str, output: &'a RenderOutput) -> Side<'a> {
    Side { name, output, precision: renderer.precision(), attributions: None }
}

/// A scene, and what both honest renderers make of it.
struct Rendered {
    honest: [RenderOutput; 2],
}

impl Rendered {
    fn of(scene: &Scene) -> Self {
        let renderers: [Box<dyn Renderer>; 2] = [Box::new(Scanline::default()), Box::new(Tracer::new())];
        Self { honest: renderers.each_ref().map(|honest| honest.render(scene, &Request::EVERYTHING)) }
    }

    /// Both beside another renderer.
    fn beside(&self, scene: &Scene, naive: Naive) -> [Vec<SensorResult>; 2] {
        let other = naive.render(scene, &Request::EVERYTHING);
        let precision = Scanline::default().precision();
        let of_honest = |output| Side { name: "honest", output, precision, attributions: None };
        self.honest.each_ref().map(|honest| compare(scene, of_honest(honest), side(&naive, "naive", &other)))
    }
}

#[test]
fn every_fault_of_light_is_found() {
    println!("{:<24} {:<42} {:<9} {:>9} {:>9}", "fault", "scene", "sensor", "scanline", "tracer");
    let mut wrong = Vec::new();
    // Most faults are tried on the same scenes.
    let mut known: BTreeMap<String, Rendered> = BTreeMap::new();
    for fault in Fault::ALL.iter().copied().filter(|fault| fault.is_of_light()) {
        for (name, scene) in scenes(fault) {
            let count = |sensors: &[SensorResult], which: fn(SensorId) -> bool| -> u64 {
                sensors.iter().filter(|of| which(of.sensor)).map(|of| of.of(Class::Defect)).sum()
            };
            let is_camera = |sensor| sensor == SensorId::Camera;
            let is_beam = |sensor| sensor != SensorId::Camera;
            let rendered = known.entry(format!("{name}, {:?}", scene.flux_model())).or_insert_with(|| {
                let rendered = Rendered::of(&scene);
                for of in rendered.beside(&scene, Naive::default()).iter().flatten() {
                    if of.of(Class::Defect) + of.of(Class::Undecided) != 0 {
                        wrong.push(format!("{name} without a fault: {:?}", of.defects.first()));
                    }
                }
                rendered
            });
            let with = rendered.beside(&scene, Naive { fault: Some(fault) });
            let found = with.map(|with| [count(&with, is_camera), count(&with, is_beam)]);
            for (index, sensor) in ["camera", "beams"].into_iter().enumerate() {
                let [by_scanline, by_tracer] = found.map(|counts| counts[index]);
                println!(
                    "{:<24} {name:<42} {sensor:<9} {by_scanline:>9} {by_tracer:>9}",
                    format!("{fault:?}")
                );
            }
            // A wrong flux of a pencil shows on the image too. A wrong sum shows on the image alone, a wrong pixel of a
            // pencil that delivers nothing not at all.
            let only_image = fault == Fault::LastPencilWins;
            let only_beams = fault == Fault::PixelOfVisibleOnly;
            for [on_camera, on_beams] in found {
                if (on_camera == 0) != only_beams || (on_beams == 0) != only_image {
                    wrong.push(format!("{fault:?} on {name}: {found:?}"));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
