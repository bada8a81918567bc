//! Unit tests of `closest_hit`, against an exhaustive search.

use std::f64::consts::PI;

use glam::DVec3;
use proptest::prelude::*;
use raypencil_scene::{FaceId, Material, Mesh};
use raypencil_terrain::RandomGround;

use super::*;

/// The same answer by testing every face, without a tree.
fn exhaustive(mesh: &Mesh, ray: &TracedRay, max_range: f64) -> Option<Intersection> {
    let mut closest = None;
    for (index, face) in mesh.faces().iter().enumerate() {
        let corners = face.map(|v| mesh.vertices()[v as usize]);
        let triangle = Triangle::new(corners, FaceId(index as u32));
        update_closest(&mut closest, &triangle, ray, max_range);
    }
    closest
}

fn bits(intersection: Option<Intersection>) -> Option<(FaceId, u64)> {
    intersection.map(|intersection| (intersection.triangle.face, intersection.t.to_bits()))
}

/// A point on a face, given by two numbers from 0 to 1. `kind` 0: a vertex; 1: on an edge; others: inside.
fn point_on(mesh: &Mesh, face: usize, kind: u8, u: f64, v: f64) -> DVec3 {
    let [a, b, c] = mesh.faces()[face].map(|v| crate::triangle::widen(mesh.vertices()[v as usize]));
    match kind {
        0 => a,
        1 => a + (b - a) * u,
        _ if u + v <= 1.0 => a + (b - a) * u + (c - a) * v,
        _ => a + (b - a) * (1.0 - u) + (c - a) * (1.0 - v),
    }
}

proptest! {
    #![proptest_config(ProptestConfig { max_shrink_iters: 200, ..ProptestConfig::default() })]

    // Rays from anywhere, aimed at vertices, edges and insides of faces. Some run along an axis: their other
    // components are 0. Expected: the same face and the same bits of t.
    #[test]
    fn the_tree_finds_what_an_exhaustive_search_finds(
        seed in any::<u64>(),
        faces in 2usize..3000,
        offset in prop_oneof![Just(0.0), Just(1e3), Just(1e6)],
        local_offset in prop_oneof![Just(0.0f32), Just(3e4), Just(2e6)],
        // Metres per unit of t: as for a camera, and lengths for which a range cannot be mistaken for its t.
        length in prop_oneof![Just(0.01), Just(0.7), Just(3.0)],
        aims in prop::collection::vec(
            (any::<prop::sample::Index>(), 0u8..4, 0.0f64..1.0, 0.0f64..1.0, -1.0f64..1.0, 0.0f64..1.0, 0.1f64..30.0),
            60,
        ),
    ) {
        let ground = RandomGround {
            offset: DVec3::new(offset, -offset, 0.0),
            ..RandomGround::nasty(seed, faces)
        };
        let mesh = ground.build().into_mesh().unwrap();
        // Far from the scene origin f32 boxes are coarse: the padding must make up for it.
        let moved = mesh.vertices().iter().map(|[x, y, z]| [x + local_offset, *y, *z]).collect();
        let mesh = Mesh::new(
            mesh.origin(),
            moved,
            mesh.faces().to_vec(),
            mesh.face_materials().to_vec(),
            mesh.materials().to_vec(),
        )
        .unwrap();
        let max_range = 20.0;
        let hierarchy = Hierarchy::build(&mesh, max_range);
        let mut traverser = ClosestHitTraverser::new(&hierarchy);
        for (face, kind, u, v, z, turn, distance) in aims {
            let target = point_on(&mesh, face.index(mesh.faces().len()), kind, u, v);
            let away = if kind == 3 {
                [DVec3::X, DVec3::NEG_X, DVec3::Y, DVec3::NEG_Y, DVec3::Z, DVec3::NEG_Z][(turn * 6.0) as usize]
            } else {
                let (sin, cos) = libm::sincos(2.0 * PI * turn);
                let r = (1.0 - z * z).sqrt();
                DVec3::new(r * cos, r * sin, z)
            };
            let ray = TracedRay::new(target + away * distance, -away * length);
            prop_assert_eq!(
                bits(traverser.closest_hit(&ray, max_range)),
                bits(exhaustive(&mesh, &ray, max_range)),
                "face {} of seed {}", face.index(mesh.faces().len()), seed
            );
        }
    }
}

fn ground() -> Vec<Material> {
    vec![Material { name: "ground".into(), reflectivity: 0.25 }]
}

#[test]
fn a_hit_on_the_projection_plane_counts_and_has_its_depth() {
    let corners = [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [0.0, 1.0, 0.0]];
    let triangle = Triangle::new(corners, FaceId(4));
    let hit_from = |z: f64| {
        let ray = TracedRay::new(DVec3::new(0.0, 0.0, z), DVec3::new(0.0, 0.0, -2.0));
        let mut closest = None;
        update_closest(&mut closest, &triangle, &ray, 6.0).then(|| closest.unwrap().hit(&ray, 5.0))
    };
    // t = 1 is on the plane; t = 3 is at the greatest range.
    let [near, far] = [2.0, 6.0].map(|z| hit_from(z).unwrap());
    assert_eq!((near.face, near.range, near.depth), (FaceId(4), 2.0, 5.0));
    assert_eq!((far.range, far.depth, far.cos_incidence), (6.0, 15.0, 1.0));
    assert!(hit_from(2.0_f64.next_down()).is_none() && hit_from(6.0_f64.next_up()).is_none());
}

#[test]
fn faces_of_the_same_corners_tie_for_the_lowest_index() {
    // The same triangle three times, its cycle started at each vertex; seen from 2 m above.
    let vertices = vec![[-0.9, -1.1, 0.03], [1.3, -0.8, 0.1], [0.1, 1.7, -0.2]];
    let faces = vec![[2, 0, 1], [0, 1, 2], [1, 2, 0]];
    let mesh = Mesh::new(DVec3::ZERO, vertices, faces, vec![0; 3], ground()).unwrap();
    let hierarchy = Hierarchy::build(&mesh, 10.0);
    let ray = TracedRay::new(DVec3::new(0.1, 0.05, 2.0), DVec3::new(0.003, 0.001, -0.01));
    let hit = ClosestHitTraverser::new(&hierarchy).closest_hit(&ray, 10.0).unwrap();
    assert_eq!(hit.triangle.face, FaceId(0));
    assert_eq!(bits(Some(hit)), bits(exhaustive(&mesh, &ray, 10.0)));
}

#[test]
fn a_million_identical_boxes_build_quickly() {
    // Faces with identical boxes are one entry of their group. (As separate entries they would make the build of
    // the group quadratic.)
    let vertices = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let count = 1_000_000;
    let mesh = Mesh::new(DVec3::ZERO, vertices, vec![[0, 1, 2]; count], vec![0; count], ground()).unwrap();
    let hierarchy = Hierarchy::build(&mesh, 10.0);
    // A node for each of some 500 groups, and those above them.
    let nodes = hierarchy.boxes().node_count();
    assert!((400..1000).contains(&nodes), "{nodes} nodes");
}

#[test]
fn nested_faces_build_quickly_and_are_hit() {
    // 100,000 triangles around one centre, each a little larger and a little lower than the one before it.
    // (As one group they take obvhs minutes to build.)
    let count = 100_000;
    let corner = |k: u32, x: f32, y: f32| {
        let size = 1.0 + k as f32 * 1e-4;
        [x * size, y * size, -1e-5 * k as f32]
    };
    let vertices =
        (0..count).flat_map(|k| [corner(k, -1.0, -1.0), corner(k, 1.0, -1.0), corner(k, 0.0, 1.0)]);
    let faces: Vec<[u32; 3]> = (0..count).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
    let materials = vec![0; faces.len()];
    let mesh = Mesh::new(DVec3::ZERO, vertices.collect(), faces, materials, ground()).unwrap();
    let hierarchy = Hierarchy::build(&mesh, 20.0);
    let mut traverser = ClosestHitTraverser::new(&hierarchy);
    // Straight down beside the first k faces: the next one is hit.
    for x in [0.0, 0.9, 1.7, 3.3, 5.2] {
        let ray = TracedRay::new(DVec3::new(x, -0.3, 2.0), DVec3::new(0.0, 0.0, -0.01));
        let hit = bits(traverser.closest_hit(&ray, 20.0));
        assert!(hit.is_some());
        assert_eq!(hit, bits(exhaustive(&mesh, &ray, 20.0)));
    }
}

#[test]
fn a_mesh_without_faces_and_faces_without_area_are_never_hit() {
    let vertices = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0]];
    for faces in [vec![], vec![[0, 1, 2], [0, 0, 1]]] {
        let materials = vec![0; faces.len()];
        let mesh = Mesh::new(DVec3::ZERO, vertices.clone(), faces, materials, ground()).unwrap();
        let hierarchy = Hierarchy::build(&mesh, 10.0);
        let ray = TracedRay::new(DVec3::new(0.5, 0.0, 1.0), DVec3::new(0.0, 0.0, -0.1));
        assert!(ClosestHitTraverser::new(&hierarchy).closest_hit(&ray, 10.0).is_none());
    }
}
