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

#[cfg(test)]
mod tests {
    use raypencil_files::{hex_digits, sha256};
    use raypencil_scene_io::scene_sha256;

    use super::*;

    /// The text of a case has all of its numbers, and takes no ground of a million faces to write.
    #[test]
    fn the_scenes_of_a_seed_stay_what_they_are() {
        let campaign = Campaign::new(5, 64);
        let cases: String = (0..64).map(|terrain| format!("{:?}\n", case(&campaign, terrain))).collect();
        let digest = "6c93486920e7908820c4bc2e46a5884fb41b9f88dd7ace560f1d7c5dce6ed8d7";
        assert_eq!(hex_digits(&sha256(cases.as_bytes())), digest);
        // Cameras and beams, with and without vertices in front of the sensor projection plane.
        let lattices: Vec<Scene> = (0..8).map(|terrain| lattice_scene(&campaign, terrain)).collect();
        assert!([0, 1].iter().all(|beams| lattices.iter().any(|scene| scene.beams().len() == *beams)));
        let digests: Vec<String> = lattices.iter().map(scene_sha256).collect();
        let digest = "a05ff612d1b8f771b449d2b87bb66d8b1ac5343ad86ea3944f0defc7c0051482";
        assert_eq!(hex_digits(&sha256(digests.join(" ").as_bytes())), digest);
    }
}
