//! The highest excess against sampling.

use glam::DVec2;
use raypencil_scene::{Material, Mesh};

use super::*;

/// Height of the rolling ground, metres; no slope is above 0.6 sqrt(2) = 0.85.
fn height(place: DVec2) -> f64 {
    0.2 * libm::sin(3.0 * place.x) + 0.2 * libm::cos(3.0 * place.y)
}

#[test]
fn no_sample_of_rolling_ground_is_higher_above_a_leaning_plane() {
    // Posts 1/16 m apart from -3 m to 3 m. Between them the triangles are below or above the formula by at most 1/2 x
    // 1.8 x (1/16)^2 (second derivatives are up to 9 x 0.2 = 1.8 along either axis; both axes: twice), and f32 heights
    // by 1e-7.
    let posts = (0..97 * 97).map(|post| {
        let place = DVec2::new(f64::from(post % 97), f64::from(post / 97)) / 16.0 - 3.0;
        place.extend(height(place))
    });
    let squares = (0..96).flat_map(|row| (0..96).map(move |column| 97 * row + column));
    let faces: Vec<[u32; 3]> = squares.flat_map(|a| [[a, a + 1, a + 98], [a, a + 98, a + 97]]).collect();
    let sand = Material { name: "sand".into(), reflectivity: 0.25 };
    let materials = vec![0; faces.len()];
    let mesh = Mesh::from_global(&posts.collect::<Vec<_>>(), faces, materials, vec![sand]).unwrap();
    let ground = GroundFaces::new(&mesh);
    let triangles = 1.8 / 256.0 + 1e-6;
    for case in 0..60 {
        let turn = f64::from(case);
        let (sin, cos) = libm::sincos(turn);
        let rectangle = Rectangle {
            place: DVec2::new(0.7 * sin, 0.5 * libm::sin(3.0 * turn)),
            offset: DVec2::new(0.2, 0.1),
            forward: DVec2::new(cos, sin),
            half_length: 0.75,
            half_width: 0.5,
        };
        let plane =
            Plane { middle: 0.3, along: 0.8 * libm::cos(5.0 * turn), across: 0.6 * libm::sin(7.0 * turn) };
        let found = highest_excess(&ground, &rectangle, plane).unwrap();
        // The point is where its height says.
        let scene = rectangle.scene(found.point);
        assert!((height(scene.truncate()) - scene.z).abs() <= triangles, "{case}");
        // Samples on a grid of 101 x 101.
        let mut highest = f64::NEG_INFINITY;
        for i in -50..=50 {
            for j in -50..=50 {
                let (a, b) = (0.015 * f64::from(i), 0.01 * f64::from(j));
                let z = height(rectangle.scene(DVec3::new(a, b, 0.0)).truncate());
                highest = highest.max(z - (plane.middle + plane.along * a + plane.across * b));
            }
        }
        assert!(highest <= found.height + triangles, "{case}: {highest} {}", found.height);
        // The highest point is within 0.0075 m and 0.005 m of a sample, and slopes against the plane are up to 0.85 +
        // 1.
        let bound = triangles + 1.85 * 0.0091;
        assert!(found.height <= highest + bound, "{case}: {highest} {}", found.height);
    }
}
