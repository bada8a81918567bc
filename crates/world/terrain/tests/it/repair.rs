//! Repairs of meshes made by hand, and of random grounds whose faults are known.

use glam::DVec3;
use proptest::prelude::*;
use raypencil_scene::{Material, Mesh};
use raypencil_terrain::{RandomGround, Repairs, height_at, inspect, repair};

fn kinds() -> Vec<Material> {
    ["sand", "rock"].map(|name| Material { name: name.into(), reflectivity: 0.25 }).to_vec()
}

#[test]
fn all_that_was_promised_is_done_and_nothing_else() {
    // A tetrahedron with face 3 turned, a duplicate of face 1 in another material, a face without area on
    // vertices of its own, a vertex without a face, and vertex 4 in the place of vertex 3.
    let vertices = vec![
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [9.0, 9.0, 9.0],
        [0.0, 1.0, 0.0],
        [0.0, 1.0, -0.0],
        [0.0, 0.0, 1.0],
        [5.0, 0.0, 0.0],
        [6.0, 0.0, 0.0],
    ];
    let faces = vec![[0, 3, 1], [0, 1, 5], [0, 6, 7], [0, 5, 4], [1, 5, 3], [5, 0, 1]];
    let origin = DVec3::new(1e6, 0.0, 0.0);
    let mesh = Mesh::new(origin, vertices, faces, vec![0, 0, 0, 1, 0, 1], kinds()).unwrap();
    let (repaired, repairs) = repair(&mesh);
    let expected = Repairs {
        zero_area_faces: 1,
        duplicate_faces: 1,
        duplicate_faces_of_other_material: 1,
        turned_faces: 1,
        welded_vertices: 1,
        unused_vertices: 3,
    };
    assert_eq!(repairs, expected);
    assert_eq!(repaired.faces(), [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]);
    assert_eq!(repaired.vertices(), [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);
    assert_eq!(repaired.face_materials(), [0, 0, 1, 0]);
    assert_eq!((repaired.origin(), repaired.materials()), (origin, mesh.materials()));
    assert!(inspect(&repaired).passes());
    assert!(!repair(&repaired).1.any());
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 32, failure_persistence: None, ..Default::default() })]

    #[test]
    fn promised_faults_are_counted_and_mended(
        seed: u64,
        faces in 250_usize..3_000,
        far in -1e6..1e6,
        turn in proptest::option::of(0_u64..97),
    ) {
        let nasty = RandomGround { offset: DVec3::new(far, -far, far), ..RandomGround::nasty(seed, faces) };
        let mut ground = nasty.build();
        // One face in 97 is turned, duplicates or not.
        for (face, corners) in ground.faces.iter_mut().enumerate() {
            if turn.is_some_and(|turn| (face as u64).wrapping_add(turn).is_multiple_of(97)) {
                corners.swap(1, 2);
            }
        }
        let mesh = ground.into_mesh().unwrap();
        let found = inspect(&mesh);
        prop_assert_eq!(found.unused_vertices.count, nasty.unreferenced_vertices);
        prop_assert_eq!(found.zero_area.count, mesh.zero_area_faces());
        prop_assert!(found.zero_area.count >= nasty.zero_area_faces);
        let kinds = found.zero_area_kinds;
        let of_kinds = kinds.repeated_vertex + kinds.coincident_vertices + kinds.collinear;
        prop_assert_eq!(of_kinds, found.zero_area.count);
        // The duplicate of a sliver that lost its area in rounding counts as a face without area, not as a
        // duplicate. A face that was turned alone makes a double-sided sheet with its duplicate.
        let lost = found.zero_area.count - nasty.zero_area_faces;
        prop_assert!(found.duplicates.count <= nasty.duplicate_faces);
        if turn.is_none() {
            prop_assert!(found.duplicates.count + lost >= nasty.duplicate_faces);
            prop_assert_eq!(found.inverted.count, 0);
        }

        let (repaired, repairs) = repair(&mesh);
        let left = inspect(&repaired);
        for none in [&left.unused_vertices, &left.split_vertices, &left.zero_area, &left.duplicates, &left.inverted] {
            prop_assert_eq!(none.count, 0);
        }
        prop_assert_eq!(left.inside_out_components, 0);
        // Quantities that no repair changes, to the last bit.
        prop_assert_eq!(&left.open_edges.count, &found.open_edges.count);
        prop_assert_eq!(left.open_edges.length, found.open_edges.length);
        prop_assert_eq!(left.open_edges.loops, found.open_edges.loops);
        prop_assert_eq!((left.components, left.closed_components), (found.components, found.closed_components));
        prop_assert_eq!((left.area, left.volume), (found.area, found.volume));
        prop_assert_eq!(left.non_manifold_edges.count, found.non_manifold_edges.count);
        prop_assert_eq!(left.double_sided_sheets.count, found.double_sided_sheets.count);
        prop_assert_eq!(left.faces, found.faces - repairs.zero_area_faces - repairs.duplicate_faces);
        prop_assert_eq!(left.vertices, found.vertices - repairs.welded_vertices - repairs.unused_vertices);
        let (again, none) = repair(&repaired);
        prop_assert!(again == repaired && !none.any());
    }

    #[test]
    fn the_ground_stays_where_it_is(seed: u64, x in -10.0..10.0, y in -10.0..10.0) {
        let mesh = RandomGround::nasty(seed, 600).build().into_mesh().unwrap();
        let (repaired, repairs) = repair(&mesh);
        prop_assert!(repairs.any() && repairs.turned_faces == 0);
        prop_assert_eq!(height_at(&repaired, x, y).map(f64::to_bits), height_at(&mesh, x, y).map(f64::to_bits));
    }
}
