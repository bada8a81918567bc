//! The index against the search through all faces.

use proptest::prelude::*;

use super::*;
use crate::{RandomGround, builtin, height_at};

#[test]
fn the_same_as_going_through_all_faces() {
    let mesh = builtin("pyramids", 0.25).unwrap().into_mesh().unwrap();
    let index = HeightIndex::new(&mesh);
    for row in -60..60 {
        for column in -60..60 {
            let (x, y) = (0.413 * f64::from(column), 0.397 * f64::from(row));
            assert_eq!(index.height_at(x, y), height_at(&mesh, x, y), "at {x}, {y}");
        }
    }
    assert_eq!(index.height_at(f64::NAN, 0.0), None);
    assert_eq!(index.height_at(1e9, 0.0), None);
}

#[test]
fn a_long_strip_has_its_heights_everywhere() {
    // A ramp z = x / 4, 40 m long and 4 m wide: the index has far more columns than rows.
    let posts = crate::HeightGrid {
        columns: 41,
        rows: 5,
        corner: DVec2::ZERO,
        spacing: DVec2::ONE,
        heights: (0..205).map(|post| 0.25 * f64::from(post % 41)).collect(),
    };
    let material = raypencil_scene::Material { name: "ground".into(), reflectivity: 0.25 };
    let index = HeightIndex::new(&posts.ground(material).into_mesh().unwrap());
    for row in 0..8 {
        for column in 0..80 {
            let (x, y) = (0.25 + 0.5 * f64::from(column), 0.25 + 0.5 * f64::from(row));
            assert_eq!(index.height_at(x, y), Some(0.25 * x), "at {x}, {y}");
        }
    }
}

#[test]
fn faces_over_one_another_take_larger_cells() {
    // 3000 squares of 10 m, one over the other, 1 mm apart.
    let mut posts = Vec::new();
    let mut faces = Vec::new();
    for layer in 0..3000_u32 {
        let z = 1e-3 * f64::from(layer);
        posts.extend([(0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0)].map(|(x, y)| DVec3::new(x, y, z)));
        let a = 4 * layer;
        faces.extend([[a, a + 1, a + 2], [a, a + 2, a + 3]]);
    }
    let materials = vec![raypencil_scene::Material { name: "ground".into(), reflectivity: 0.25 }];
    let mesh = Mesh::from_global(&posts, faces, vec![0; 6000], materials).unwrap();
    let index = HeightIndex::new(&mesh);
    assert!(index.faces.len() <= 32 * 6000, "{} entries", index.faces.len());
    assert_eq!(index.height_at(3.0, 4.0), height_at(&mesh, 3.0, 4.0));
}

#[test]
fn a_ground_without_faces_has_no_height() {
    let mesh = Mesh::from_global(&[], Vec::new(), Vec::new(), Vec::new()).unwrap();
    assert_eq!(HeightIndex::new(&mesh).height_at(0.0, 0.0), None);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 32, failure_persistence: None, ..Default::default() })]

    #[test]
    fn the_same_on_random_ground_and_at_its_vertices(seed: u64, x in -7.0..7.0, y in -7.0..7.0) {
        let mesh = RandomGround::plain(seed, 400, 12.0).build().into_mesh().unwrap();
        let index = HeightIndex::new(&mesh);
        prop_assert_eq!(index.height_at(x, y), height_at(&mesh, x, y));
        for v in mesh.vertices().iter().take(50) {
            let (x, y) = (f64::from(v[0]), f64::from(v[1]));
            prop_assert_eq!(index.height_at(x, y), height_at(&mesh, x, y));
        }
    }
}
