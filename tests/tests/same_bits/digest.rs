//! Committed digests of whole outputs: the bits are the same for any number of threads, optimisation level and machine.
//! (Contract: same bits)
//!
//! CI runs the tests with `--profile unoptimised` too, and compares that program with the optimised one. A digest changes
//! with any change of a ground, of a rig, or of the order of a renderer's operations. Such a commit must state the reason. The command
//! `cargo test -p raypencil-tests --test same_bits digest -- --nocapture` prints the new digests.

use glam::DVec3;
use raypencil::terrain::{Crevasses, MarsGround, RandomGround, Rocks, builtin, height_at};
use raypencil::tracer::Instructions;
use raypencil::{Atmosphere, Filter, FluxModel, Lens, Profile, Renderer, Request, Sampling, Scene, Tracer};
use raypencil_tests::{bits, light_bits, renderers, rig, scene};
use sha2::{Digest, Sha256};

/// Scene, renderer and SHA-256 of the bits of all maps.
const DIGESTS: &[[&str; 3]] = &[
    ["pyramids", "scanline", "7b629a8e4df0ba1bdfeceb5aef350a3d800583773a898091367e69faef4ba7f0"],
    ["pyramids", "tracer", "dd31d1b2a3e579423aedfb2311d707c9012fa71fc56e6e5b2f90265b1254ee56"],
    ["facets", "scanline", "caaca6f9e1fd170ce68342623fb2131048fa6fe3cd6153c003a70a1408daa397"],
    ["facets", "tracer", "1905cb7cbc43982c40074f170e880b19e76abe463e25b39d83e80d7ba874070a"],
    ["nasty", "scanline", "86d097bed95fc548bf11874b108a3ec07712782defa47d67fcfa584d29eaf014"],
    ["nasty", "tracer", "bebd1d66b54614459e73653cf8184770ac5d30228a93099da1063a6ba5f2b9c6"],
    ["worst", "scanline", "faf8d03526591774ff6e6f5186285969618d85073d9f5e62a86bdff2f9e5d6e9"],
    ["worst", "tracer", "23df2c0733f1510fa2c97dc8c77f35c20c5c101157ac196ece92defbf4037bdb"],
];

/// Scene, renderer, sampling and SHA-256 of the bits of all light.
const DIGESTS_OF_LIGHT: &[[&str; 4]] = &[
    [
        "radiometric",
        "scanline",
        "centres",
        "1e118ea2eaa81a549053de75216c4561d4c392b8cd5ceccb100912eb4ac5b14f",
    ],
    ["radiometric", "tracer", "centres", "3405c18dbc310eb1f82c887ccc63ee88b56237694603b6416bce0084d8fbf020"],
    ["radiometric", "tracer", "jittered", "242aacb0aec79b6953310f6305f491ca5cb4eb56a8486e90813ec170f8f6c8d1"],
    ["eq1", "scanline", "centres", "a75ebcf24ce53b8230b7e6f34ed337296882896e41fd45b0278d3a7d813fe6f0"],
    ["eq1", "tracer", "centres", "106f35b693623eb7e2cefef535f034275761dd7bdef64142d95b9dab17e592b4"],
    ["eq1", "tracer", "jittered", "f2bad6dd3b9831a676a414c1d227d221ebbdca2a719f4f0bd5a2d1698499a339"],
];

/// The scenes with their names. They are small, because the test runs without optimisation too.
fn scenes() -> Vec<(&'static str, Scene)> {
    let grounds = [
        ("pyramids", builtin("pyramids", 0.25).expect("a built-in name")),
        ("facets", builtin("facets", 0.25).expect("a built-in name")),
        ("nasty", RandomGround { offset: DVec3::splat(1e6), ..RandomGround::nasty(20, 1500) }.build()),
        ("worst", worst().build().expect("a ground")),
    ];
    let built = grounds.map(|(name, ground)| {
        let mesh = std::sync::Arc::new(ground.into_mesh().expect("a mesh"));
        // The rig is on the surface in the middle, turned by 0.4 rad, so that no ray is parallel to an axis.
        let ground_height = height_at(&mesh, 0.0, 0.0).unwrap_or(0.0);
        let (camera, beams) = rig::default_rig(16, DVec3::new(0.0, 0.0, ground_height), 0.4);
        (name, scene(mesh, camera, beams))
    });
    built.into()
}

/// Generated ground with all features, as large as the stripes reach.
fn worst() -> MarsGround {
    let worst = MarsGround::preset("worst", 20).expect("a preset");
    let crevasses = Crevasses { count: 2, width: 0.4, ..worst.crevasses };
    let rocks = Rocks { smallest: 0.2, ..worst.rocks };
    MarsGround { extent: 16.0, post_spacing: 0.8, crevasses, rocks, ..worst }
}

/// SHA-256 of the bits of all maps.
fn digest(renderer: &dyn Renderer, scene: &Scene) -> String {
    let output = renderer.render(scene, &Request::EVERYTHING);
    let mut sha256 = Sha256::new();
    for bits in bits(&output) {
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
fn wide_lanes_change_no_bit() {
    // On a processor without them the two are one; CI's has them.
    let [detected, baseline] =
        [Instructions::Detected, Instructions::Baseline].map(Tracer::with_instructions);
    for (name, scene) in scenes().into_iter().chain(lit_scenes()) {
        assert_eq!(digest(&detected, &scene), digest(&baseline, &scene), "{name}");
        for sampling in [Sampling::Centres, Sampling::Jittered { seed: 3 }] {
            let request = Request { sampling, ..Request::EVERYTHING };
            let [wide, plain] =
                [&detected, &baseline].map(|renderer| light_bits(&renderer.render(&scene, &request)));
            assert!(wide == plain, "{name}, {sampling:?}");
        }
    }
}

/// The pyramids in both flux models, through a filter in attenuating air, with beams of two profiles.
fn lit_scenes() -> Vec<(&'static str, Scene)> {
    let mesh =
        std::sync::Arc::new(builtin("pyramids", 0.25).expect("a built-in name").into_mesh().expect("a mesh"));
    let (mut camera, mut beams) = rig::default_rig(16, DVec3::ZERO, 0.4);
    let filter = Filter::Interference { centre: 815e-9, width: 15e-9, index: 2.0 };
    camera.sensor.lens = Lens { transmission: 0.8, filter };
    beams[0].sensor.profile = Profile::UniformAngle;
    beams[1].sensor.profile = Profile::Gaussian { half_width: 0.3 };
    [("radiometric", FluxModel::Radiometric), ("eq1", FluxModel::Eq1)]
        .map(|(name, model)| {
            let air = Atmosphere { attenuation: 0.02 };
            let mesh = std::sync::Arc::clone(&mesh);
            (name, Scene::new(mesh, camera, beams.clone(), air, model).expect("a scene"))
        })
        .into()
}

#[test]
fn light_has_the_committed_bits_too() {
    let mut found = Vec::new();
    for (name, scene) in lit_scenes() {
        for renderer in renderers() {
            for (how, sampling) in
                [("centres", Sampling::Centres), ("jittered", Sampling::Jittered { seed: 3 })]
            {
                // The scanline renderer does not support jittered rays.
                if how == "jittered" && renderer.name() == "scanline" {
                    continue;
                }
                let request = Request { sampling, ..Request::EVERYTHING };
                let digests = [1, 2, 8].map(|threads| {
                    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
                    let bits = pool.install(|| light_bits(&renderer.render(&scene, &request)));
                    let bytes: Vec<u8> = bits.iter().flat_map(|bits| bits.to_le_bytes()).collect();
                    let digest = Sha256::digest(&bytes);
                    digest.iter().map(|byte| format!("{byte:02x}")).collect::<String>()
                });
                assert!(digests.iter().all(|d| *d == digests[0]), "{name}, {}: {digests:?}", renderer.name());
                let [digest, ..] = digests;
                println!("    [\"{name}\", \"{}\", \"{how}\", \"{digest}\"],", renderer.name());
                found.push([name.to_string(), renderer.name().to_string(), how.to_string(), digest]);
            }
        }
    }
    assert!(found == DIGESTS_OF_LIGHT, "the digests are now {found:#?}");
}

#[test]
fn at_least_half_of_the_rays_hit() {
    // A digest of empty maps would prove nothing.
    for (name, scene) in scenes() {
        for (renderer, output) in raypencil_tests::render_both(&scene) {
            for map in output.maps() {
                let hits = raypencil_tests::cells_hit(map).len();
                assert!(2 * hits >= map.cell_count(), "{name}, {renderer} {}: {hits} hits", map.sensor);
            }
        }
    }
}
