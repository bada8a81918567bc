//! Random grounds: sizes, features, reproducibility, and meshes for any seed.

use proptest::prelude::*;

use super::*;
use crate::ground::tests::{assert_closed_and_outward, normal};
use crate::height_at;

#[test]
fn plain_ground_has_the_size_asked_for_and_looks_up() {
    for faces in [2, 50, 2_000, 200_000] {
        let plain = RandomGround::plain(11, faces, 40.0);
        let ground = plain.build();
        // n x n cells for the largest n that fits.
        let cells = (faces as f64 / 2.0).sqrt() as usize;
        assert_eq!(ground.faces.len(), 2 * cells * cells);
        assert!(ground.faces.iter().all(|&face| normal(&ground, face).z > 0.0));
        let on_border = |c: f64| c.abs() <= 20.0;
        assert!(ground.vertices.iter().all(|v| on_border(v.x) && on_border(v.y) && v.z.abs() <= 1.0));
        assert_eq!(ground.into_mesh().unwrap().zero_area_faces(), 0);
    }
}

#[test]
fn nasty_ground_has_about_the_size_asked_for() {
    for faces in [1_000, 10_000, 100_000] {
        let count = RandomGround::nasty(4, faces).build().faces.len() as f64;
        assert!((count / faces as f64 - 1.0).abs() < 0.06, "{count} of {faces}");
    }
}

#[test]
fn the_same_seed_gives_the_same_bytes_and_another_seed_others() {
    let build = |seed| RandomGround::nasty(seed, 1_500).build();
    assert_eq!(build(1), build(1));
    assert_ne!(build(1).vertices, build(2).vertices);
    // Each kind of feature has its own stream: without walls all other features stay.
    let with = RandomGround::nasty(1, 1_500);
    let without = RandomGround { walls: 0, faces: with.faces - BOX_FACES * with.walls, ..with.clone() };
    let (with, without) = (with.build(), without.build());
    assert!(without.vertices.iter().all(|v| with.vertices.contains(v)));
}

#[test]
fn the_bytes_are_these() {
    // A digest (FNV-1a, 64 bits) of all coordinates: it changes if a seed changes its meaning.
    let ground = RandomGround::nasty(2024, 3_000).build();
    let mut digest = 0xcbf2_9ce4_8422_2325_u64;
    for byte in ground.vertices.iter().flat_map(|v| v.to_array()).flat_map(f64::to_le_bytes) {
        digest = (digest ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3);
    }
    assert_eq!(format!("{digest:016x}"), "1355a55db8eff14d");
}

#[test]
fn nasty_ground_holds_what_it_promises() {
    let nasty = RandomGround::nasty(5, 5_000);
    let ground = nasty.build();
    let features = nasty.slivers + nasty.duplicate_faces + nasty.zero_area_faces;
    let bodies_end = ground.faces.len() - features;
    let overhang_faces = nasty.overhangs / 2 * (MUSHROOM_FACES + BOX_FACES);
    let body_faces = nasty.boulders * ROCK_FACES + overhang_faces + nasty.walls * BOX_FACES;
    assert_eq!(nasty.overhangs % 2, 0);

    // The height field comes first, then closed bodies.
    let mut at = bodies_end - body_faces;
    assert!(ground.faces[..at].iter().all(|&face| normal(&ground, face).z > 0.0));
    let overhangs = (0..nasty.overhangs).map(|i| if i % 2 == 0 { MUSHROOM_FACES } else { BOX_FACES });
    let bodies = std::iter::repeat_n(ROCK_FACES, nasty.boulders)
        .chain(overhangs)
        .chain(std::iter::repeat_n(BOX_FACES, nasty.walls));
    for faces in bodies {
        assert_closed_and_outward(&ground, at..at + faces);
        at += faces;
    }
    assert_eq!(at, bodies_end);

    // Walls are vertical: eight of the twelve normals of each are exactly horizontal.
    let walls = &ground.faces[bodies_end - nasty.walls * BOX_FACES..bodies_end];
    let level = walls.iter().filter(|&&face| normal(&ground, face).z == 0.0).count();
    assert_eq!(level, 8 * nasty.walls);

    // Slivers: the longest side squared over twice the area is length / width.
    for &face in &ground.faces[bodies_end..bodies_end + nasty.slivers] {
        let [a, b, _] = face.map(|v| ground.vertices[v as usize]);
        let aspect = (b - a).length_squared() / normal(&ground, face).length();
        assert!((0.99e3..1.2e6).contains(&aspect), "{aspect}");
    }

    // Every duplicate equals an earlier face.
    let sorted = |face: [u32; 3]| {
        let mut face = face;
        face.sort_unstable();
        face
    };
    let duplicates = bodies_end + nasty.slivers;
    for &face in &ground.faces[duplicates..duplicates + nasty.duplicate_faces] {
        assert!(ground.faces[..duplicates].iter().any(|&other| sorted(other) == sorted(face)));
    }
    assert_eq!(ground.materials.len(), 5);
    let mesh = ground.into_mesh().unwrap();
    assert!(mesh.zero_area_faces() >= nasty.zero_area_faces);
}

#[test]
fn an_overhang_counts_with_its_upper_side() {
    // One mushroom, found by its top: the last vertex. The ground below is lower.
    let one = RandomGround { overhangs: 1, ..RandomGround::plain(8, 500, 20.0) };
    let ground = one.build();
    let top = *ground.vertices.last().unwrap();
    let below = RandomGround { overhangs: 0, ..one }.build().into_mesh().unwrap();
    let mesh = ground.into_mesh().unwrap();
    let z = height_at(&mesh, top.x, top.y).unwrap();
    assert!((z - top.z).abs() < 1e-5, "{z} against {top}");
    assert!(height_at(&below, top.x, top.y).unwrap() < z - 0.3);
}

#[test]
fn offsets_of_a_million_metres_keep_sub_millimetre_precision() {
    let near = RandomGround::nasty(6, 1_000);
    let offset = DVec3::new(1e6, -1e6, 1e6);
    let far = RandomGround { offset, ..near.clone() };
    let (near, far) = (near.build(), far.build().into_mesh().unwrap());
    for (v, stored) in near.vertices.iter().zip(far.vertices()) {
        let [x, y, z] = stored.map(f64::from);
        // f32 offsets of up to 14 m are rounded by at most 2^-21 m, the sum in f64 by 2^-34 m.
        let error = (far.origin() + DVec3::new(x, y, z) - offset - *v).abs().max_element();
        assert!(error < 1e-6, "{error}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 48, failure_persistence: None, ..Default::default() })]

    #[test]
    fn every_random_ground_is_a_mesh(seed: u64, faces in 0_usize..3_000, far in -1e6..1e6) {
        let ground = RandomGround { offset: DVec3::new(far, -far, far), ..RandomGround::nasty(seed, faces) };
        let mesh = ground.build().into_mesh();
        prop_assert!(mesh.is_ok(), "{:?}", mesh.err());
        // The rover's place is free of bodies, and it is on the ground.
        let z = height_at(&mesh.unwrap(), far, -far);
        prop_assert!(z.is_some_and(|z| (z - far).abs() <= ground.relief + 3.0));
    }
}
