//! Inspections of meshes made by hand, with results derived by hand.

use glam::DVec3;
use raypencil_scene::{FaceId, Material, Mesh};

use super::*;
use crate::ground::Ground;
use crate::{RandomGround, builtin};

fn ground() -> Vec<Material> {
    vec![Material { name: "ground".into(), reflectivity: 0.25 }]
}

fn mesh(vertices: &[[f64; 3]], faces: &[[u32; 3]]) -> Mesh {
    let vertices: Vec<DVec3> = vertices.iter().map(|&v| DVec3::from_array(v)).collect();
    Mesh::from_global(&vertices, faces.to_vec(), vec![0; faces.len()], ground()).unwrap()
}

/// Corners at the origin and 1 m along each axis, counter-clockwise from outside.
const TETRAHEDRON: [[f64; 3]; 4] = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
const ITS_FACES: [[u32; 3]; 4] = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];

/// Numbers of the faces found; the tests find no more than are kept as examples.
fn faces(found: &Occurrences) -> Vec<u32> {
    assert_eq!(found.count, found.examples.len());
    let number = |example: &Occurrence| match example.item {
        MeshElement::Face(FaceId(face)) => face,
        MeshElement::Vertex(vertex) => panic!("vertex {vertex}"),
    };
    found.examples.iter().map(number).collect()
}

fn vertices(found: &Occurrences) -> Vec<u32> {
    let number = |example: &Occurrence| match example.item {
        MeshElement::Vertex(vertex) => vertex,
        MeshElement::Face(face) => panic!("{face:?}"),
    };
    found.examples.iter().map(number).collect()
}

#[test]
fn a_tetrahedron_is_closed_and_sound() {
    let found = inspect(&mesh(&TETRAHEDRON, &ITS_FACES));
    assert!(found.passes(), "{found:?}");
    assert_eq!((found.faces, found.vertices), (4, 4));
    assert_eq!((found.components, found.closed_components), (1, 1));
    assert_eq!(found.open_edges, OpenEdges::default());
    // The volume is a sixth of the cube. The area is three right triangles and an equilateral one of side sqrt 2:
    // 3/2 + sqrt(3)/2.
    assert!((found.volume - 1.0 / 6.0).abs() < 1e-15, "{}", found.volume);
    assert!((found.area - (1.5 + 3.0_f64.sqrt() / 2.0)).abs() < 1e-15, "{}", found.area);
    assert_eq!(found.bounds, Some([DVec3::ZERO, DVec3::ONE]));
    // Only the base looks down. Its longest side is sqrt 2, and twice its area is 1: the ratio is 2.
    assert_eq!((faces(&found.down), found.downward_area, found.worst_aspect), (vec![0], 0.5, 2.0));
}

#[test]
fn a_face_the_wrong_way_round_contradicts_its_three_neighbours() {
    for wrong in 0..4 {
        let mut turned = ITS_FACES;
        turned[wrong].swap(1, 2);
        let found = inspect(&mesh(&TETRAHEDRON, &turned));
        assert_eq!(faces(&found.inverted), [wrong as u32]);
        assert_eq!(
            (found.inconsistent_edges.count, found.inside_out_components, found.fault_kinds()),
            (3, 0, 2)
        );
        assert!((found.volume - 1.0 / 6.0).abs() < 1e-15);
    }
}

#[test]
fn the_volume_of_a_closed_body_decides_and_not_the_majority() {
    // Three of the four faces are turned: they are wrong despite their majority.
    let turned = ITS_FACES.map(|[a, b, c]| if [a, b, c] == [0, 2, 1] { [a, b, c] } else { [a, c, b] });
    let found = inspect(&mesh(&TETRAHEDRON, &turned));
    assert_eq!((faces(&found.inverted), found.inside_out_components), (vec![1, 2, 3], 0));
    // All four are turned: inside out, although no two contradict each other. The same holds a hundred kilometres
    // away.
    let far = TETRAHEDRON.map(|[x, y, z]| [x + 1e5, y - 1e5, z]);
    for corners in [TETRAHEDRON, far] {
        let found = inspect(&mesh(&corners, &ITS_FACES.map(|[a, b, c]| [a, c, b])));
        assert_eq!(
            (found.inverted.count, found.inside_out_components, found.inconsistent_edges.count),
            (4, 1, 0)
        );
        assert_eq!(found.fault_kinds(), 1);
    }
}

#[test]
fn a_flat_bag_has_no_volume_to_be_judged_by() {
    // Two faces back to back are closed: a double-sided sheet.
    let found = inspect(&mesh(&TETRAHEDRON[..3], &[[0, 1, 2], [0, 2, 1]]));
    assert!(found.passes(), "{found:?}");
    assert_eq!((faces(&found.double_sided_sheets), found.duplicates.count), (vec![0], 0));
    assert_eq!((found.components, found.closed_components, found.volume), (1, 1, 0.0));
    // In the same sense they are duplicates. The remaining one is open all round: 1 + 1 + sqrt 2 metres.
    let found = inspect(&mesh(&TETRAHEDRON[..3], &[[0, 1, 2], [2, 0, 1], [1, 2, 0]]));
    assert_eq!((faces(&found.duplicates), found.double_sided_sheets.count), (vec![1, 2], 0));
    assert_eq!((found.open_edges.count, found.open_edges.loops, found.fault_kinds()), (3, 1, 1));
    assert!((found.open_edges.length - (2.0 + 2.0_f64.sqrt())).abs() < 1e-15);
}

#[test]
fn two_cubes_that_share_a_wall_are_crowded_there() {
    // Two cubes of 1 m beside each other along x, each with all its 12 faces. Each edge of the wall between them
    // has two faces of either cube: 4. The diagonal of the first cube's wall joins its corners 1 and 7, that of
    // the second's its corners 0 and 6. These are the same two places, so the diagonal has four faces again.
    // Hence 5 edges are crowded, and both halves of the wall occur in both senses.
    let half = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| axis * 0.5);
    let mut cubes = Ground { materials: ground(), ..Ground::default() };
    cubes.add_box(DVec3::ZERO, half, 0);
    cubes.add_box(DVec3::X, half, 0);
    let found = inspect(&cubes.into_mesh().unwrap());
    // The four corners of the wall occur twice.
    assert_eq!((found.split_vertices.count, found.components, found.closed_components), (4, 1, 0));
    assert_eq!((found.non_manifold_edges.count, faces(&found.double_sided_sheets).len()), (5, 2));
    assert_eq!((found.area, found.open_edges.count, found.inverted.count), (12.0, 0, 0));
    assert_eq!(found.fault_kinds(), 1);
}

#[test]
fn three_faces_fan_out_from_one_edge() {
    let tips = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 1.0]];
    let found = inspect(&mesh(&tips, &[[0, 1, 2], [1, 0, 3], [0, 1, 4]]));
    assert_eq!(faces(&found.non_manifold_edges), [0]);
    assert_eq!(found.non_manifold_edges.examples[0].place, DVec3::new(0.5, 0.0, 0.0));
    // Six open edges on five vertices in one piece: 6 - 5 + 1 = 2 loops. The orientation at an edge of three
    // faces is not compared.
    let open = &found.open_edges;
    assert_eq!((open.count, open.pieces, open.loops), (6, 1, 2));
    assert_eq!((found.inconsistent_edges.count, found.components, found.closed_components), (0, 1, 0));
}

/// A square of 3 x 3 cells of 1 m, as a height field.
fn square() -> Ground {
    let mut square = Ground { materials: ground(), ..Ground::default() };
    let place = |column, row| DVec3::new(f64::from(column), f64::from(row), 0.0);
    square.add_height_field(3, 3, place, || false, || 0);
    square
}

#[test]
fn a_hole_is_a_second_loop() {
    let whole = inspect(&square().into_mesh().unwrap());
    // The border is 12 m long. One loop is normal for a ground.
    assert!(whole.passes(), "{whole:?}");
    let open = &whole.open_edges;
    assert_eq!((open.count, open.length, open.loops, open.pieces), (12, 12.0, 1, 1));
    assert_eq!((whole.components, whole.closed_components), (1, 0));

    // Without the middle cell (faces 8 and 9) the open edges are 4 m longer.
    let mut holed = square();
    holed.faces.drain(8..10);
    holed.face_materials.drain(8..10);
    let found = inspect(&holed.into_mesh().unwrap());
    let open = &found.open_edges;
    assert_eq!((open.count, open.length, open.loops, open.pieces), (16, 16.0, 2, 2));
    assert_eq!((found.fault_kinds(), found.excess_loops()), (1, 1));
    let of_hole = open.longest[1];
    assert_eq!((open.longest[0].edges, of_hole.edges, of_hole.length), (12, 4, 4.0));
    assert!((1.0..=2.0).contains(&of_hole.example.place.x) && (1.0..=2.0).contains(&of_hole.example.place.y));

    // Without a second cell that touches the hole at a corner: one piece, two loops.
    let mut holed = square();
    for cell in [4, 2] {
        holed.faces.drain(2 * cell..2 * cell + 2);
    }
    holed.face_materials.truncate(14);
    let found = inspect(&holed.into_mesh().unwrap());
    // The border is still 12 m long, and touches the hole at the vertex (2, 1).
    let open = &found.open_edges;
    assert_eq!((open.count, open.length, open.loops, open.pieces), (16, 16.0, 2, 1));
}

#[test]
fn in_an_open_patch_the_minority_is_wrong() {
    let mut ground = square();
    for face in [3, 16] {
        ground.faces[face].swap(0, 1);
    }
    let found = inspect(&ground.into_mesh().unwrap());
    assert_eq!(faces(&found.inverted), [3, 16]);
    assert!(!found.upside_down);

    // One face against one: no majority, and nothing is turned, but the edge between them is counted.
    let strip = [[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    let found = inspect(&mesh(&strip, &[[0, 1, 2], [0, 3, 2]]));
    assert_eq!((found.inconsistent_edges.count, found.inverted.count), (1, 0));
    assert_eq!((faces(&found.undecided_patches), found.fault_kinds()), (vec![0], 1));
}

#[test]
fn a_moebius_strip_has_no_two_sides() {
    // Five vertices, five faces (i, i+1, i+2) modulo 5: the smallest Moebius strip. (Moebius 1886) Every face
    // shares its sides (i, i+1) and (i+1, i+2) with others. The sides (i, i+2) are the border, one loop of 5.
    let strip = [[0.0, 0.0, 0.0], [3.0, 0.0, 1.0], [1.0, 2.0, 0.0], [-1.0, 1.0, 2.0], [2.0, -1.0, 3.0]];
    let turned: Vec<[u32; 3]> = (0..5).map(|i| [i, (i + 1) % 5, (i + 2) % 5]).collect();
    let found = inspect(&mesh(&strip, &turned));
    assert_eq!((faces(&found.non_orientable_patches), found.inverted.count), (vec![0], 0));
    assert_eq!((found.open_edges.count, found.open_edges.loops), (5, 1));
    // However the faces are turned, some neighbours contradict each other.
    for choice in 0..32_u32 {
        let some: Vec<[u32; 3]> = (0..5_u32)
            .map(|i| turned[i as usize])
            .enumerate()
            .map(|(i, [a, b, c])| if choice >> i & 1 == 1 { [a, c, b] } else { [a, b, c] })
            .collect();
        let found = inspect(&mesh(&strip, &some));
        assert_eq!(found.non_orientable_patches.count, 1);
        assert!(found.inconsistent_edges.count % 2 == 1, "{}", found.inconsistent_edges.count);
    }
}

#[test]
fn faces_without_area_are_told_by_their_cause() {
    let line = [[0.0; 3], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [-0.0; 3], [0.0, 1.0, 0.0]];
    let found = inspect(&mesh(&line, &[[0, 1, 4], [0, 1, 1], [0, 3, 4], [0, 1, 2]]));
    assert_eq!(faces(&found.zero_area), [1, 2, 3]);
    let one = ZeroAreaKinds { repeated_vertex: 1, coincident_vertices: 1, collinear: 1 };
    assert_eq!(found.zero_area_kinds, one);
    // Vertex 3 is at -0 and vertex 0 at 0: one place. Each of the five vertices is used by some face.
    assert_eq!((vertices(&found.split_vertices), found.unused_vertices.count), (vec![3], 0));
    // Only face 0 belongs to the surface.
    assert_eq!((found.open_edges.count, found.components, found.area), (3, 1, 0.5));
}

#[test]
fn vertices_of_no_face_do_not_widen_the_bounds() {
    let mut spare = TETRAHEDRON.to_vec();
    spare.extend([[7.0, 0.0, 0.0], [0.0, 0.0, 1.0]]);
    let found = inspect(&mesh(&spare, &ITS_FACES));
    assert_eq!(vertices(&found.unused_vertices), [4, 5]);
    assert_eq!(found.unused_vertices.examples[0].place, DVec3::new(7.0, 0.0, 0.0));
    assert_eq!(vertices(&found.split_vertices), [5]);
    assert_eq!((found.bounds, found.fault_kinds()), (Some([DVec3::ZERO, DVec3::ONE]), 1));
}

#[test]
fn a_slender_face_is_a_fact() {
    // A face of 1 m with its third corner h above the middle: the ratio is 1 / h.
    let needle = |h: f64| mesh(&[[0.0; 3], [1.0, 0.0, 0.0], [0.5, h, 0.0]], &[[0, 1, 2]]);
    let found = inspect(&needle(1.0 / 8192.0));
    assert_eq!((found.slender.count, found.worst_aspect), (0, 8192.0));
    let found = inspect(&needle(1.0 / 16384.0));
    assert_eq!((faces(&found.slender), found.worst_aspect, found.passes()), (vec![0], 16384.0, true));
}

#[test]
fn a_ground_that_shows_its_back_is_upside_down() {
    let mut ground = square();
    ground.faces.iter_mut().for_each(|face| face.swap(0, 1));
    let found = inspect(&ground.into_mesh().unwrap());
    // No face contradicts another: nothing is proven, and nothing would be turned.
    assert_eq!((found.upside_down, found.inverted.count, found.fault_kinds()), (true, 0, 1));
    assert_eq!((found.down.count, found.downward_area), (18, 9.0));
    // A vertical wall shows no area from above, however its normals are rounded.
    let wall = [[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1e-9, 1.0]];
    assert!(!inspect(&mesh(&wall, &[[0, 1, 2]])).upside_down);
    assert!(!inspect(&mesh(&wall, &[[0, 2, 1]])).upside_down);
}

#[test]
fn no_faces_at_all_are_no_trouble() {
    let found = inspect(&mesh(&[], &[]));
    assert!(found.passes() && found.bounds.is_none());
    assert_eq!(found, Inspection::default());
}

#[test]
fn our_own_grounds_are_sound() {
    for name in crate::BUILTIN_NAMES {
        let found = inspect(&builtin(name, 0.25).unwrap().into_mesh().unwrap());
        assert_eq!((found.inverted.count, found.inconsistent_edges.count), (0, 0), "{name}");
        assert_eq!((found.zero_area.count, found.duplicates.count), (0, 0), "{name}");
    }
    let found = inspect(&RandomGround::plain(3, 20_000, 40.0).build().into_mesh().unwrap());
    assert!(found.passes());
    // 100 x 100 cells of 0.4 m: the border has 400 edges and, in the plane, a length of 160 m.
    assert_eq!((found.open_edges.count, found.open_edges.loops, found.components), (400, 1, 1));
    assert!(found.open_edges.length > 160.0 && found.open_edges.length < 170.0);
}

#[test]
fn areas_places_and_volumes_of_faces_that_are_not_unit_ones() {
    // A right triangle of 6 m by 3 m, 10 m up, from above and from below. The centroid is at (2, 1).
    let corners = [[0.0, 0.0, 10.0], [6.0, 0.0, 10.0], [0.0, 3.0, 10.0]];
    let up = inspect(&mesh(&corners, &[[0, 1, 2]]));
    assert_eq!((up.area, up.downward_area, up.down.count), (9.0, 0.0, 0));
    let down = inspect(&mesh(&corners, &[[0, 2, 1]]));
    assert_eq!((down.area, down.downward_area), (9.0, 9.0));
    assert_eq!(faces(&down.down), [0]);
    assert!((down.down.examples[0].place - DVec3::new(2.0, 1.0, 10.0)).length() < 1e-14);
    // A tetrahedron without a face is open: it has no volume.
    assert_eq!(inspect(&mesh(&TETRAHEDRON, &ITS_FACES[1..])).volume, 0.0);
}
