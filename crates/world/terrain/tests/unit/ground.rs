//! Shapes: closed bodies with outward normals, and height fields that look up.

use proptest::prelude::*;

use super::*;
use crate::random_stream::StreamPurpose;

/// Normal (b - a) x (c - a) of a face.
pub(crate) fn normal(ground: &Ground, face: [u32; 3]) -> DVec3 {
    let [a, b, c] = face.map(|v| ground.vertices[v as usize]);
    (b - a).cross(c - a)
}

/// Asserts that `faces` of the ground form a closed body with outward normals: every directed edge occurs once,
/// its reverse once, and the signed volume, the sum of a . (b x c) / 6 over the faces, is positive. (Gauss)
pub(crate) fn assert_closed_and_outward(ground: &Ground, faces: std::ops::Range<usize>) {
    let faces = &ground.faces[faces];
    let mut edges: Vec<[u32; 2]> = faces.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]).collect();
    edges.sort_unstable();
    assert!(edges.windows(2).all(|pair| pair[0] != pair[1]), "a directed edge twice");
    for &[a, b] in &edges {
        assert!(edges.binary_search(&[b, a]).is_ok(), "edge {a} {b} has no partner");
    }
    // Relative to a vertex, so that a far body is not lost in rounding.
    let from = ground.vertices[faces[0][0] as usize];
    let volume: f64 = faces
        .iter()
        .map(|face| {
            let [a, b, c] = face.map(|v| ground.vertices[v as usize] - from);
            a.dot(b.cross(c)) / 6.0
        })
        .sum();
    assert!(volume > 0.0, "volume {volume}");
}

#[test]
fn a_box_has_the_volume_of_a_box() {
    // Sides of 2, 4 and 6 m. The top is at z = 1 + 3. All twelve faces together measure 2 (2*4 + 4*6 + 6*2) = 88
    // square metres.
    let mut ground = Ground::default();
    ground.add_box(DVec3::Z, [DVec3::X, DVec3::Y * 2.0, DVec3::Z * 3.0], 0);
    assert_closed_and_outward(&ground, 0..12);
    let area: f64 = ground.faces.iter().map(|&face| normal(&ground, face).length() / 2.0).sum();
    assert_eq!(area, 88.0);
    assert_eq!(ground.vertices.iter().fold(0.0_f64, |top, v| top.max(v.z)), 4.0);
}

#[test]
fn a_pyramid_is_closed_and_its_flanks_lean_up() {
    let mut ground = Ground::default();
    ground.add_pyramid(DVec3::new(3.0, -1.0, 0.5), 0.5, 0.8, 0.3, 0);
    assert_closed_and_outward(&ground, 0..6);
    assert!(ground.faces[..4].iter().all(|&face| normal(&ground, face).z > 0.0));
    assert!(ground.faces[4..].iter().all(|&face| normal(&ground, face).z < 0.0));
}

#[test]
fn a_pyramid_turns_to_the_left() {
    // A right-handed turn about z by the angle of cosine 4/5 and sine 3/5 takes the corner (1, 1) of the base to
    // (4/5 - 3/5, 3/5 + 4/5).
    let mut ground = Ground::default();
    ground.add_pyramid(DVec3::new(10.0, 20.0, 0.0), 1.0, 2.0, libm::atan(0.75), 0);
    assert!((ground.vertices[2] - DVec3::new(10.2, 21.4, 0.0)).length() < 1e-14, "{}", ground.vertices[2]);
}

#[test]
fn a_height_field_looks_up_on_either_diagonal() {
    for falling in [false, true] {
        let mut ground = Ground::default();
        let place = |column, row| DVec3::new(f64::from(column), f64::from(row), 0.0);
        ground.add_height_field(3, 2, place, || falling, || 0);
        assert_eq!((ground.vertices.len(), ground.faces.len()), (12, 12));
        assert!(ground.faces.iter().all(|&face| normal(&ground, face) == DVec3::Z));
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, failure_persistence: None, ..Default::default() })]

    #[test]
    fn rocks_are_closed_and_outward(seed: u64, a in 0.05..2.0, b in 0.05..2.0, c in 0.05..2.0) {
        let mut ground = Ground::default();
        let centre = DVec3::new(10.0, -20.0, 0.3);
        let half_axes = DVec3::new(a, b, c);
        ground.add_rock(centre, half_axes, &mut RandomStream::new(seed, StreamPurpose::Boulders), 0);
        prop_assert_eq!((ground.vertices.len(), ground.faces.len()), (18, 32));
        assert_closed_and_outward(&ground, 0..32);
        // Star-shaped: every face looks away from the centre.
        for &face in &ground.faces {
            let middle = face.map(|v| ground.vertices[v as usize] - centre).iter().sum::<DVec3>();
            prop_assert!(normal(&ground, face).dot(middle) > 0.0);
        }
    }

    #[test]
    fn mushrooms_are_closed_and_outward(seed: u64, height in 0.2..2.0, radius in 0.2..2.0, sides in 3_u32..12) {
        let mut ground = Ground::default();
        let mut random = RandomStream::new(seed, StreamPurpose::Overhangs);
        ground.add_mushroom(DVec3::new(1.0, 2.0, -0.1), height, radius, sides, &mut random, 0);
        prop_assert_eq!(ground.faces.len(), 8 * sides as usize);
        assert_closed_and_outward(&ground, 0..ground.faces.len());
    }
}
