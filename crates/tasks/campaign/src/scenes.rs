//! The scenes of a terrain, from the campaign's seed and the terrain's number.

use std::sync::Arc;

use proptest::strategy::{Strategy, ValueTree};
use proptest::test_runner::{RngAlgorithm, TestRng};
use raypencil_scene::{Mesh, Mounted, Scene, rig};

use crate::cases::lattice::{Lattice, Sensor};
use crate::cases::random::{Case, campaign_cases};
use crate::cases::split_mix::hash;
use crate::cases::{aimed, at_origin, drawing, scene};
use crate::error::CampaignError;
use crate::plan::Campaign;
use crate::record::PartName;

/// The ground and the random rig of a terrain.
pub(crate) fn case(campaign: &Campaign, terrain: u64) -> Case {
    let mut seed = [0; 32];
    seed[..8].copy_from_slice(&campaign.seed.to_le_bytes());
    seed[8..16].copy_from_slice(&terrain.to_le_bytes());
    let rng = TestRng::from_seed(RngAlgorithm::ChaCha, &seed);
    let mut runner = drawing(rng);
    campaign_cases(terrain).new_tree(&mut runner).expect("a strategy that rejects little").current()
}

/// One of the scenes of a terrain.
///
/// ```
/// use raypencil_campaign::{Campaign, PartName, scene_of};
///
/// let campaign = Campaign::new(5, 10);
/// // Equal campaigns have equal scenes; terrains differ.
/// let scene = scene_of(&campaign, 3, PartName::Lattice)?;
/// assert_eq!(scene, scene_of(&Campaign::new(5, 10), 3, PartName::Lattice)?);
/// assert_ne!(scene, scene_of(&campaign, 4, PartName::Lattice)?);
/// # Ok::<(), raypencil_campaign::CampaignError>(())
/// ```
///
/// # Errors
/// One of one's own scenes that cannot be loaded.
pub fn scene_of(campaign: &Campaign, terrain: u64, part: PartName) -> Result<Scene, CampaignError> {
    Ok(match part {
        PartName::Own | PartName::Paper => own_scene(campaign, terrain)?,
        PartName::Aimed => aimed_scene(campaign, terrain, own_scene(campaign, terrain)?.mesh()),
        PartName::Lattice => lattice_scene(campaign, terrain),
    })
}

/// The scene of a terrain: a random one, or one's own.
pub(crate) fn own_scene(campaign: &Campaign, terrain: u64) -> Result<Scene, CampaignError> {
    match &campaign.scenes {
        Some(scenes) => Ok(scenes.load(terrain)?.scene),
        None => Ok(case(campaign, terrain).scene()),
    }
}

/// Narrow beams aimed at the ground of a terrain.
pub(crate) fn aimed_scene(campaign: &Campaign, terrain: u64, ground: &Arc<Mesh>) -> Scene {
    aimed::scene(ground, hash(campaign.seed, terrain), aimed::MAX_BEAMS)
}

/// A lattice in front of a camera or a beam, whose vertices lie exactly on rays.
pub(crate) fn lattice_scene(campaign: &Campaign, terrain: u64) -> Scene {
    let seed = hash(!campaign.seed, terrain);
    // The t of vertices are dyadic. Below 1 a vertex lies in front of the sensor projection plane.
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
