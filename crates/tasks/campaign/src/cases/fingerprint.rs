//! A digest of sample scenes: it changes when scenes are drawn in another way.

use std::sync::OnceLock;

use proptest::strategy::{Strategy, ValueTree};
use proptest::test_runner::{RngAlgorithm, TestRng, TestRunner};
use raypencil_files::{hex_digits, sha256};
use raypencil_scene_io::scene_sha256;

use super::aimed;
use super::drawing;
use super::lattice::{Lattice, Sensor};
use super::random::{Case, lit_cases, mars_cases};

/// SHA-256 of sample scenes of every kind, in hexadecimal digits.
///
/// The samples are small, so that the digest costs less than one terrain. They are the same for every campaign: the digest
/// says how a program draws scenes, not which.
pub(crate) fn fingerprint() -> &'static str {
    static DIGEST: OnceLock<String> = OnceLock::new();
    DIGEST.get_or_init(|| hex_digits(&sha256(samples().join(" ").as_bytes())))
}

/// Digests of the sample scenes.
fn samples() -> Vec<String> {
    let rng = TestRng::from_seed(RngAlgorithm::ChaCha, &[7; 32]);
    let mut runner = drawing(rng);
    let mut drawn = |strategy: &dyn Fn(&mut TestRunner) -> Case| strategy(&mut runner).scene();
    let lit = drawn(&|runner| lit_cases().new_tree(runner).expect("a case").current());
    let mars = drawn(&|runner| mars_cases().new_tree(runner).expect("a case").current());
    let aimed = aimed::scene(lit.mesh(), 7, aimed::MAX_BEAMS);
    let camera = raypencil_scene::rig::camera(17, 17, 1.0 / 1024.0, 1.0 / 16.0);
    let at = super::at_origin(camera);
    let (mesh, _) = Lattice::before(Sensor::Camera(camera), 1, 7, &[24.0, 26.0]).mesh(&at.scene_from_sensor);
    let lattice = super::scene(mesh, at, Vec::new());
    [lit, mars, aimed, lattice].iter().map(scene_sha256).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_sample_counts() {
        let samples = samples();
        assert_eq!(samples.len(), 4);
        for (at, one) in samples.iter().enumerate() {
            assert!(!samples[..at].contains(one), "two samples are the same scene");
        }
        // With other scenes the records of a campaign are of another program, and its terrains are run again.
        assert_eq!(fingerprint(), "3efe7f87f5f108bb066d6a7b665c9d95ec1bae74c4fbca74a90b0978279c9f7e");
    }
}
