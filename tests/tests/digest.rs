//! The same bits for any number of threads, optimisation level and machine: digests of whole frames, committed
//! here. (Contract: same bits)
//!
//! Run with `--profile unoptimised` and with `--release` too. A digest changes with any change of a ground, a
//! rig, or the order of a renderer's operations. When it does, say in the change why, and print the new ones
//! with `cargo test -p raypencil-tests --test digest -- --nocapture`.

use glam::DVec3;
use raypencil_scene::{Renderer, Request, Scene};
use raypencil_terrain::{RandomGround, builtin, height_at};
use raypencil_tests::{bits, renderers, rig, scene};
use sha2::{Digest, Sha256};

/// Scene, renderer and SHA-256 of all bits of all its maps.
const DIGESTS: &[[&str; 3]] = &[
    ["pyramids", "scanline", "7b629a8e4df0ba1bdfeceb5aef350a3d800583773a898091367e69faef4ba7f0"],
    ["pyramids", "tracer", "dd31d1b2a3e579423aedfb2311d707c9012fa71fc56e6e5b2f90265b1254ee56"],
    ["facets", "scanline", "caaca6f9e1fd170ce68342623fb2131048fa6fe3cd6153c003a70a1408daa397"],
    ["facets", "tracer", "1905cb7cbc43982c40074f170e880b19e76abe463e25b39d83e80d7ba874070a"],
    ["nasty", "scanline", "86d097bed95fc548bf11874b108a3ec07712782defa47d67fcfa584d29eaf014"],
    ["nasty", "tracer", "bebd1d66b54614459e73653cf8184770ac5d30228a93099da1063a6ba5f2b9c6"],
];

/// The scenes under digest, by name: small, since this runs without optimisation too.
fn scenes() -> Vec<(&'static str, Scene)> {
    let grounds = [
        ("pyramids", builtin("pyramids", 0.25).expect("a built-in name")),
        ("facets", builtin("facets", 0.25).expect("a built-in name")),
        ("nasty", RandomGround { offset: DVec3::splat(1e6), ..RandomGround::nasty(20, 1500) }.build()),
    ];
    let built = grounds.map(|(name, ground)| {
        let mesh = std::sync::Arc::new(ground.into_mesh().expect("a mesh"));
        // At the middle of the ground, on its surface, turned a little: no ray is along an axis.
        let ground_height = height_at(&mesh, 0.0, 0.0).unwrap_or(0.0);
        let (camera, beams) = rig::default_rig(16, DVec3::new(0.0, 0.0, ground_height), 0.4);
        (name, scene(mesh, camera, beams))
    });
    built.into()
}

fn digest(renderer: &dyn Renderer, scene: &Scene) -> String {
    let frame = renderer.render(scene, &Request::EVERYTHING);
    let mut sha256 = Sha256::new();
    for bits in bits(&frame) {
        sha256.update(bits.to_le_bytes());
    }
    sha256.finalize().iter().map(|byte| format!("{byte:02x}")).collect()
}

#[test]
fn every_number_of_threads_and_every_build_gives_the_committed_bits() {
    let mut found = Vec::new();
    for (name, scene) in scenes() {
        for renderer in renderers() {
            let digests = [1, 2, 8].map(|threads| {
                let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
                pool.install(|| digest(&*renderer, &scene))
            });
            assert!(digests.iter().all(|d| *d == digests[0]), "{name}, {}: {digests:?}", renderer.name());
            let [digest, ..] = digests;
            println!("    [\"{name}\", \"{}\", \"{digest}\"],", renderer.name());
            found.push([name.to_string(), renderer.name().to_string(), digest]);
        }
    }
    assert!(found == DIGESTS, "the digests are now {found:#?}");
}

#[test]
fn the_scenes_under_digest_are_seen() {
    // A digest of empty maps would hold nothing.
    for (name, scene) in scenes() {
        for (renderer, frame) in raypencil_tests::render_both(&scene) {
            for map in frame.maps() {
                let hits = raypencil_tests::cells_hit(map).len();
                assert!(2 * hits >= map.cell_count(), "{name}, {renderer} {}: {hits} hits", map.sensor);
            }
        }
    }
}
