//! One terrain of a campaign: drawn, rendered, compared, judged.

use proptest::strategy::{Strategy, ValueTree};
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};
use std::path::Path;

use crate::campaign::{Campaign, CampaignError};
use crate::cases::aimed;
use crate::cases::lattice::{Lattice, Sensor, hash};
use crate::cases::random::{Case, campaign_cases};
use crate::cases::{at_origin, scene};
use crate::record::{PartName, PartRecord, TerrainRecord};
use raypencil_files::create_folder;
use raypencil_harness::attribute;
use raypencil_harness::{
    Contender, Reproducer, contender, first_shown, shows_class, typed_contenders, write_reproducer,
};
use raypencil_judge::{Class, Judge, JudgeShare, Side, compare_judged};
use raypencil_minimise::{MINIMISE_BUDGET, minimise};
use raypencil_scene::{Mounted, Precision, Request, Scene, SensorId, Silent, Switches, rig};
use raypencil_scene_io::write_resolved;

/// The case of a terrain.
fn case(campaign: &Campaign, terrain: u64) -> Case {
    let mut seed = [0; 32];
    seed[..8].copy_from_slice(&campaign.seed.to_le_bytes());
    seed[8..16].copy_from_slice(&terrain.to_le_bytes());
    let rng = TestRng::from_seed(RngAlgorithm::ChaCha, &seed);
    let mut runner = TestRunner::new_with_rng(Config::default(), rng);
    campaign_cases(terrain).new_tree(&mut runner).expect("a strategy that rejects little").current()
}

/// One of a terrain's scenes.
pub fn scene_of(campaign: &Campaign, terrain: u64, part: PartName) -> Scene {
    match part {
        PartName::Own | PartName::Paper => case(campaign, terrain).scene(),
        PartName::Aimed => {
            aimed::scene(&case(campaign, terrain).mesh(), hash(campaign.seed, terrain), aimed::MOST)
        }
        PartName::Lattice => lattice(hash(!campaign.seed, terrain)),
    }
}

/// Hills before a camera or a beam, by turns, that meet it exactly.
fn lattice(seed: u64) -> Scene {
    // Their t are dyadic; the lowest reaches before the near plane now and then.
    let ts: &[f64] = if seed & 2 == 0 { &[24.0, 26.0, 30.0, 32.0] } else { &[0.5, 1.0, 1.5, 2.0, 64.0] };
    let size = 17 + 2 * (seed >> 8 & 15) as u32;
    let camera = rig::camera(size, size, 1.0 / 1024.0, 1.0 / 16.0);
    let beam = rig::beam(size, 9, [1.0 / 1024.0, 1.0 / 256.0], 1.0 / 16.0);
    let is_beam = seed & 1 == 1;
    let sensor = if is_beam { Sensor::Beam(beam) } else { Sensor::Camera(camera) };
    let pose = at_origin(()).scene_from_sensor;
    let (mesh, _) = Lattice::before(sensor, 1, seed, ts).mesh(&pose);
    let beams = if is_beam { vec![Mounted { scene_from_sensor: pose, sensor: beam }] } else { Vec::new() };
    scene(mesh, at_origin(camera), beams)
}

/// Runs a terrain. Scenes with a wrong ray are left in the folder `wrong`, if one is given.
///
/// # Errors
/// What the file system says of that folder.
pub fn terrain(
    campaign: &Campaign,
    number: u64,
    wrong: Option<&Path>,
) -> Result<TerrainRecord, CampaignError> {
    let case = case(campaign, number);
    let mesh = case.mesh();
    let own = case.scene_of(&mesh, &mesh);
    let aimed = aimed::scene(&mesh, hash(campaign.seed, number), aimed::MOST);
    let lattice = lattice(hash(!campaign.seed, number));
    let parts = [
        (PartName::Own, &own, JudgeShare::Sample),
        (PartName::Paper, &own, JudgeShare::Sample),
        (PartName::Aimed, &aimed, JudgeShare::All),
        (PartName::Lattice, &lattice, JudgeShare::All),
    ];
    // The hierarchy of the ground serves all its scenes.
    let tracer = contender("tracer").expect("a renderer of this house");
    let mut records = Vec::new();
    for (part, scene, share) in parts {
        let record = compared(part, scene, share, &tracer);
        let is_wrong = record.of_class(Class::Defect) + record.of_class(Class::Undecided) > 0;
        if let (true, Some(folder)) = (is_wrong, wrong) {
            leave(
                folder,
                &format!("terrain-{number:06}-{}", part.word()),
                scene,
                [&scanline_of(part), &tracer],
            )?;
        }
        records.push(record);
    }
    Ok(TerrainRecord { terrain: number, faces: mesh.faces().len() as u64, parts: records })
}

/// Leaves a scene with a wrong ray in `folder`: as it is, and the smallest that still shows one.
pub(super) fn leave(
    folder: &Path,
    name: &str,
    scene: &Scene,
    contenders: [&Contender; 2],
) -> Result<(), CampaignError> {
    create_folder(folder)?;
    write_resolved(folder.join(format!("{name}.toml")), scene, &format!("{name}.glb"))?;
    for (class, is) in [(Class::Defect, "differ beyond doubt"), (Class::Undecided, "differ, undecided")] {
        let Some(first) = first_shown(contenders, scene, class, JudgeShare::All) else { continue };
        let shows = shows_class(contenders, class);
        let Ok(minimised) = minimise(scene, Some(first.place), &shows, MINIMISE_BUDGET, &Silent) else {
            continue;
        };
        let [a, b] = contenders.map(|contender| contender.renderer.name());
        let (name, what) = (format!("{name}-smallest"), format!("{a} and {b} {is}."));
        let with = typed_contenders(&contenders);
        write_reproducer(folder, &minimised, Reproducer { name: &name, what: &what, with: &with })?;
        break;
    }
    Ok(())
}

/// The scanline renderer that looks at a part.
fn scanline_of(part: PartName) -> Contender {
    Contender::scanline(match part {
        PartName::Paper => Switches::PAPER,
        _ => Switches::EXACT,
    })
}

/// Both renderers on one scene.
fn compared(part: PartName, scene: &Scene, share: JudgeShare, tracer: &Contender) -> PartRecord {
    let scanline = scanline_of(part);
    // Aimed sensors are narrow and blind: nobody asks what the camera sees of them.
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
        // The camera that had to be there.
        sensors.retain(|sensor| sensor.sensor != SensorId::Camera);
    }
    PartRecord::of(part, &sensors)
}

#[cfg(test)]
mod tests {
    use raypencil_scene::{Maybe, RenderOutput, Renderer};

    use super::*;
    use raypencil_tests::fixtures::subject;

    /// The tracer, but for ranges.
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
    fn a_scene_with_a_wrong_ray_is_left_whole_and_at_its_smallest() {
        let folder = tempfile::TempDir::new().unwrap();
        let scene = subject().scene;
        let farther = Contender::from(Farther(contender("tracer").unwrap()));
        leave(folder.path(), "terrain-000007-own", &scene, [&scanline_of(PartName::Own), &farther]).unwrap();
        let load = |name: &str| {
            let file = folder.path().join(name).display().to_string();
            raypencil_scene_io::load(&file, &raypencil_scene_io::Overrides::default()).unwrap().scene
        };
        assert_eq!(load("terrain-000007-own.toml").mesh().faces(), scene.mesh().faces());
        assert_eq!(load("terrain-000007-own-smallest.toml").mesh().faces().len(), 1);
        let words = std::fs::read_to_string(folder.path().join("terrain-000007-own-smallest.md")).unwrap();
        assert!(words.contains("scanline and tracer differ beyond doubt."), "{words}");
    }

    #[test]
    fn a_scene_without_one_has_no_smallest() {
        let folder = tempfile::TempDir::new().unwrap();
        let contenders = [&scanline_of(PartName::Own), &contender("tracer").unwrap()];
        leave(folder.path(), "scene", &subject().scene, contenders).unwrap();
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 2);
    }
}
