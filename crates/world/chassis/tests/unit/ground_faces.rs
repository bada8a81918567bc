//! The tree of boxes: its size, and that no face is missed.

use raypencil_scene::Material;

use super::*;

fn mesh(vertices: Vec<DVec3>, faces: Vec<[u32; 3]>) -> Mesh {
    let sand = Material { name: "sand".into(), reflectivity: 0.25 };
    let materials = vec![0; faces.len()];
    Mesh::from_global(&vertices, faces, materials, vec![sand]).unwrap()
}

/// Counts what it is shown.
#[derive(Default)]
struct Shown(Vec<u32>);

impl Search for Shown {
    fn can_matter(&self, _top: f64) -> bool {
        true
    }

    fn visit(&mut self, face: &Face) {
        self.0.push(face.index);
    }
}

#[test]
fn two_huge_faces_and_many_tiny_ones_take_no_more_memory_and_no_longer_search() {
    // A square of 1e6 m, and n triangles of 1 mm, 1 cm apart, in a row. A wheel's rectangle of 0.7 m x 0.25 m sees the
    // huge faces, at most 72 of the tiny ones, and the rest of two leaves at the ends: 3 each.
    let side = 5e5;
    let mut vertices = [(-side, -side), (side, -side), (side, side), (-side, side)]
        .map(|(x, y)| DVec3::new(x, y, 0.0))
        .to_vec();
    let mut faces = vec![[0, 1, 2], [0, 2, 3]];
    for tiny in 0..50_000_u32 {
        let first = vertices.len() as u32;
        let corner = DVec3::new(0.01 * f64::from(tiny), 0.0, 0.1);
        vertices.extend([corner, corner + 1e-3 * DVec3::X, corner + 1e-3 * DVec3::Y]);
        faces.push([first, first + 1, first + 2]);
    }
    // Around the middle, where f32 tells millimetres apart.
    let mesh = mesh(vertices, faces);
    let ground = GroundFaces::new(&mesh);
    assert_eq!(ground.faces.len(), 50_002);
    assert!(ground.boxes.len() <= ground.faces.len());
    let forward = DVec2::X;
    let place = DVec2::new(100.0, 0.0);
    let rectangle = Rectangle { place, offset: DVec2::ZERO, forward, half_length: 0.35, half_width: 0.125 };
    let mut shown = Shown::default();
    ground.search(&rectangle, &mut shown);
    assert!(shown.0.contains(&0) && shown.0.contains(&1));
    assert!((71..=80).contains(&shown.0.len()), "{}", shown.0.len());
}

#[test]
fn every_number_of_faces_has_at_most_as_many_boxes_and_each_face_once() {
    assert!(GroundFaces::new(&mesh(vec![DVec3::ZERO], vec![])).faces.is_empty());
    for count in 1..100_u32 {
        // All in one place: halving by position alone would never end.
        let corners = vec![DVec3::ZERO, DVec3::X, DVec3::Y];
        let ground = GroundFaces::new(&mesh(corners, vec![[0, 1, 2]; count as usize]));
        assert!(ground.boxes.len() <= ground.faces.len());
        let (place, offset, forward) = (DVec2::splat(0.1), DVec2::ZERO, DVec2::X);
        let rectangle = Rectangle { place, offset, forward, half_length: 0.01, half_width: 0.01 };
        let mut shown = Shown::default();
        ground.search(&rectangle, &mut shown);
        shown.0.sort_unstable();
        assert_eq!(shown.0, (0..count).collect::<Vec<u32>>());
    }
}
