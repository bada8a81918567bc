//! Runs one terrain: its scenes are made, rendered by both renderers, compared and judged.

use std::path::Path;

use raypencil_files::create_folder;
use raypencil_harness::{
    Contender, Reproducer, attribute, contender, first_interesting_ray, is_interesting_in_class,
    typed_contenders, write_reproducer,
};
use raypencil_judge::{Class, Judge, JudgeShare, SensorResult, Side, compare_judged};
use raypencil_minimise::{MINIMISE_BUDGET, minimise};
use raypencil_scene::{Precision, Request, Scene, SensorId, Silent, Switches};
use raypencil_scene_io::{Subject, scene_sha256, write_resolved};
use raypencil_survey::SensorHits;

use crate::candidate::hunt;
use crate::error::CampaignError;
use crate::plan::Campaign;
use crate::record::{PartName, PartRecord, TerrainRecord};
use crate::scenes::{aimed_scene, lattice_scene, own_scene};

/// Runs a terrain. If a folder `found` is given, scenes with a wrong ray are written to `found/wrong`, and rays that a program
/// under test answers wrongly to `found/misses`.
///
/// # Errors
/// A file or folder that cannot be written.
pub fn terrain(
    campaign: &Campaign,
    number: u64,
    found: Option<&Path>,
) -> Result<TerrainRecord, CampaignError> {
    let own = own_scene(campaign, number)?;
    let faces = own.mesh().faces().len() as u64;
    let asked: Vec<PartName> = campaign.parts_of(faces).collect();
    let aimed = asked.contains(&PartName::Aimed).then(|| aimed_scene(campaign, number, own.mesh()));
    // A lattice has a ground of its own.
    let lattice = asked.contains(&PartName::Lattice).then(|| lattice_scene(campaign, number));
    let parts = [
        (PartName::Own, Some(&own), JudgeShare::Sample),
        (PartName::Paper, Some(&own), JudgeShare::Sample),
        (PartName::Aimed, aimed.as_ref(), JudgeShare::All),
        (PartName::Lattice, lattice.as_ref(), JudgeShare::All),
    ];
    let parts = parts.into_iter().filter_map(|(part, scene, share)| Some((part, scene?, share)));
    let parts = parts.filter(|(part, ..)| asked.contains(part));
    let mut records = Vec::new();
    if let Some(command) = &campaign.candidate {
        for (part, scene, _) in parts {
            let name = format!("terrain-{number:06}-{}", part.word());
            let subject = Subject {
                scene: scene.clone(),
                sha256: scene_sha256(scene),
                arguments: campaign.arguments(number, part),
                name: name.clone(),
                vehicle: None,
                file_facts: Default::default(),
            };
            let misses = found.map(|folder| folder.join("misses").join(name));
            records.push(hunt(campaign, command, part, &subject, misses.as_deref())?);
        }
        return Ok(TerrainRecord { terrain: number, faces, parts: records });
    }
    // One tracer for all scenes, since it keeps the hierarchy of a ground that several scenes share.
    let tracer = contender("tracer").expect("the name of a renderer");
    for (part, scene, share) in parts {
        let record = compare_renderers(part, scene, share, &tracer);
        if let (false, Some(folder)) = (record.wrong.is_empty(), found) {
            write_wrong_scene(
                &folder.join("wrong"),
                &format!("terrain-{number:06}-{}", part.word()),
                scene,
                [&scanline_of(part), &tracer],
            )?;
        }
        records.push(record);
    }
    Ok(TerrainRecord { terrain: number, faces, parts: records })
}

/// Writes a scene with a wrong ray into `folder`, and the simplest scene that still has such a ray.
fn write_wrong_scene(
    folder: &Path,
    name: &str,
    scene: &Scene,
    contenders: [&Contender; 2],
) -> Result<(), CampaignError> {
    create_folder(folder)?;
    write_resolved(folder.join(format!("{name}.toml")), scene, &format!("{name}.glb"))?;
    for class in [Class::Defect, Class::Undecided] {
        let Some(first) = first_interesting_ray(contenders, scene, class, JudgeShare::All) else { continue };
        let is_interesting = is_interesting_in_class(contenders, class);
        let Ok(minimised) = minimise(scene, Some(first.place), &is_interesting, MINIMISE_BUDGET, &Silent)
        else {
            continue;
        };
        let [a, b] = contenders.map(|contender| contender.renderer.name());
        let what = match class {
            Class::Undecided => format!("{a} and {b} differ, undecided."),
            _ => format!("{a} or {b} is wrong beyond doubt."),
        };
        let name = format!("{name}-smallest");
        let with = typed_contenders(&contenders);
        write_reproducer(folder, &minimised, Reproducer { name: &name, what: &what, with: &with })?;
        break;
    }
    Ok(())
}

/// The scanline renderer for a scene.
fn scanline_of(part: PartName) -> Contender {
    Contender::scanline(match part {
        PartName::Paper => Switches::PAPER,
        _ => Switches::EXACT,
    })
}

/// Renders a scene with both renderers, and compares them.
fn compare_renderers(part: PartName, scene: &Scene, share: JudgeShare, tracer: &Contender) -> PartRecord {
    let scanline = scanline_of(part);
    // The camera of an aimed scene looks away, so that it receives nothing of the beams.
    let request = match part {
        PartName::Aimed => Request::MAPS,
        _ => Request::EVERYTHING,
    };
    let [of_scanline, of_tracer] =
        [&scanline, tracer].map(|contender| contender.renderer.render(scene, &request));
    let judge = Judge::new(scene, share);
    let attributions =
        (part == PartName::Paper).then(|| attribute(&judge, &of_scanline, Switches::PAPER, Precision::F64));
    let name = |contender: &Contender| contender.renderer.name().to_string();
    let names = [name(&scanline), name(tracer)];
    let a = Side {
        name: &names[0],
        output: &of_scanline,
        precision: Precision::F64,
        attributions: attributions.as_ref(),
    };
    let b = Side { name: &names[1], output: &of_tracer, precision: Precision::F64, attributions: None };
    let mut sensors = compare_judged(&judge, a, b);
    if part == PartName::Aimed {
        // Every scene has a camera; that of an aimed scene is of no interest.
        sensors.retain(|sensor| sensor.sensor != SensorId::Camera);
    }
    let hits_of = |sensor: &SensorResult| of_tracer.map(sensor.sensor).and_then(SensorHits::of_map);
    let hits = sensors.iter().filter_map(hits_of).map(|of| of.hits).sum();
    PartRecord::of(part, hits, &sensors)
}

#[cfg(test)]
mod tests {
    use raypencil_scene::{Maybe, RenderOutput, Renderer};
    use raypencil_tests::fixtures::subject;

    use super::*;

    /// The tracer with ranges that are 0.1 % too long.
    struct Farther(Contender);

    impl Renderer for Farther {
        fn name(&self) -> &str {
            "tracer"
        }

        fn precision(&self) -> Precision {
            Precision::F64
        }

        fn render(&self, scene: &Scene, request: &Request) -> RenderOutput {
            let mut output = self.0.renderer.render(scene, request);
            for map in output.camera.iter_mut().chain(&mut output.beams) {
                for range in map.range.iter_mut().flat_map(|ranges| ranges.cells_mut()) {
                    *range = range.get().map_or(Maybe::NONE, |range| Maybe::some(1.001 * range));
                }
            }
            output
        }
    }

    #[test]
    fn a_scene_with_a_wrong_ray_is_written_and_reduced() {
        let folder = tempfile::TempDir::new().unwrap();
        let scene = subject().scene;
        let farther = Contender::from(Farther(contender("tracer").unwrap()));
        write_wrong_scene(
            folder.path(),
            "terrain-000007-own",
            &scene,
            [&scanline_of(PartName::Own), &farther],
        )
        .unwrap();
        let load = |name: &str| {
            let file = folder.path().join(name).display().to_string();
            raypencil_scene_io::load(&file, &raypencil_scene_io::Overrides::default()).unwrap().scene
        };
        assert_eq!(load("terrain-000007-own.toml").mesh().faces(), scene.mesh().faces());
        assert_eq!(load("terrain-000007-own-smallest.toml").mesh().faces().len(), 1);
        let words = std::fs::read_to_string(folder.path().join("terrain-000007-own-smallest.md")).unwrap();
        assert!(words.contains("scanline or tracer is wrong beyond doubt."), "{words}");
    }

    #[test]
    fn a_scene_without_a_wrong_ray_is_not_reduced() {
        let folder = tempfile::TempDir::new().unwrap();
        let contenders = [&scanline_of(PartName::Own), &contender("tracer").unwrap()];
        write_wrong_scene(folder.path(), "scene", &subject().scene, contenders).unwrap();
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 2);
    }
}
