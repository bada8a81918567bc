//! One terrain of a campaign: drawn, rendered, compared, judged.

use std::path::Path;

use proptest::strategy::{Strategy, ValueTree};
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};
use raypencil_scanline::Switches;
use raypencil_scene::{Mounted, Request, Resolution, Scene, SensorId};
use raypencil_scene_io::write_resolved;

use super::record::{PartName, PartRecord, TerrainRecord};
use super::{Campaign, CampaignError};
use crate::attribution::Attributions;
use crate::cases::lattice::{Lattice, Sensor, hash};
use crate::cases::random::{Case, campaign_cases};
use crate::cases::{aimed, at_origin, rig, scene};
use crate::compare::{Class, Side, compare_judged};
use crate::judge::{Judge, JudgeShare};
use crate::output::create;
use crate::renderers::{Contender, contender};

/// The case of a terrain.
fn case(campaign: &Campaign, terrain: u64) -> Case {
    let mut seed = [0; 32];
    seed[..8].copy_from_slice(&campaign.seed.to_le_bytes());
    seed[8..16].copy_from_slice(&terrain.to_le_bytes());
    let rng = TestRng::from_seed(RngAlgorithm::ChaCha, &seed);
    let mut runner = TestRunner::new_with_rng(Config::default(), rng);
    campaign_cases().new_tree(&mut runner).expect("a strategy that rejects little").current()
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
            create(folder)?;
            let name = format!("terrain-{number:06}-{}", part.word());
            write_resolved(folder.join(format!("{name}.toml")), scene, &format!("{name}.glb"))?;
        }
        records.push(record);
    }
    Ok(TerrainRecord { terrain: number, faces: mesh.faces().len() as u64, parts: records })
}

/// Both renderers on one scene.
fn compared(part: PartName, scene: &Scene, share: JudgeShare, tracer: &Contender) -> PartRecord {
    let scanline = Contender::scanline(match part {
        PartName::Paper => Switches::PAPER,
        _ => Switches::EXACT,
    });
    // Aimed sensors are narrow and blind: nobody asks what the camera sees of them.
    let request = match part {
        PartName::Aimed => Request::MAPS,
        _ => Request::EVERYTHING,
    };
    let [of_scanline, of_tracer] =
        [&scanline, tracer].map(|contender| contender.renderer.render(scene, &request));
    let judge = Judge::new(scene, share);
    let attributions = (part == PartName::Paper)
        .then(|| Attributions::find(&judge, &of_scanline, Switches::PAPER, Resolution::F64));
    let name = |contender: &Contender| contender.renderer.name().to_string();
    let names = [name(&scanline), name(tracer)];
    let a = Side {
        name: &names[0],
        frame: &of_scanline,
        resolution: Resolution::F64,
        attributions: attributions.as_ref(),
    };
    let b = Side { name: &names[1], frame: &of_tracer, resolution: Resolution::F64, attributions: None };
    let mut sensors = compare_judged(&judge, a, b);
    if part == PartName::Aimed {
        // The camera that had to be there.
        sensors.retain(|sensor| sensor.sensor != SensorId::Camera);
    }
    PartRecord::of(part, &sensors)
}
