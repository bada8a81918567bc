//! Unit tests of `hierarchy`.

use std::sync::Arc;

use glam::DVec3;
use obvhs::bvh2::node::Bvh2Node;
use raypencil_scene::{Atmosphere, Camera, FluxModel, Lens, Material, Pose, Profile};

use super::*;

#[test]
fn the_reach_is_the_longest_way_of_any_ray() {
    let camera = |max_range: f64| Camera {
        width: 2,
        height: 2,
        pixel_pitch: [1e-3; 2],
        focal_length: 1e-2,
        principal_point: [1.0; 2],
        aperture: 1e-3,
        lens: Lens::CLEAR,
        max_range,
    };
    let beam = |max_range: f64| Beam {
        columns: 1,
        rows: 1,
        thickness: 0.5,
        grid_distance: 0.1,
        half_width: 0.1,
        max_range,
        power: 1.0,
        wavelength: 8e-7,
        profile: Profile::Paper,
    };
    let reach = |of_camera: f64, of_beams: [f64; 2]| {
        let ground = vec![Material { name: "ground".into(), reflectivity: 0.5 }];
        let mesh = Mesh::new(DVec3::ZERO, vec![[0.0; 3]; 3], vec![[0, 1, 2]], vec![0], ground).unwrap();
        let at = Pose::from_position(DVec3::new(1.0, 1.0, 1.0));
        // sqrt(4 + 4 + 1) = 3 m from the camera, and 9 m.
        let apart = [DVec3::new(3.0, -1.0, 2.0), DVec3::new(1.0, 10.0, 1.0)].map(Pose::from_position);
        let beams = [0, 1].map(|k| Mounted { scene_from_sensor: apart[k], sensor: beam(of_beams[k]) });
        let camera = Mounted { scene_from_sensor: at, sensor: camera(of_camera) };
        let air = Atmosphere { attenuation: 0.0 };
        reach_of(&Scene::new(Arc::new(mesh), camera, beams.into(), air, FluxModel::Radiometric).unwrap())
    };
    // The camera's own; a beam's range, half its sheet, and the way between the two.
    assert_eq!(reach(20.0, [5.0, 5.0]), 20.0);
    assert_eq!(reach(10.0, [8.0, 1.0]), 11.25);
    assert_eq!(reach(10.0, [1.0, 8.0]), 17.25);
}

#[test]
fn a_box_is_as_much_wider_as_was_derived() {
    // 9 x 2^-24 of the largest coordinate, 9, and the reach, 100.
    let padded = padded_box(&[[1.0, 2.0, 3.0], [-4.0, 5.0, 6.0], [7.0, -8.0, 9.0]], 100.0);
    let padding = 9.0 / f64::from(1 << 24) * 109.0;
    // Rounded outward, by no more than two steps of f32 below 16.
    let outward = |wider: f64| (padding..=padding + 2.0 / f64::from(1 << 20)).contains(&wider);
    for (axis, low, high) in [(0, -4.0, 7.0), (1, -8.0, 5.0), (2, 3.0, 9.0)] {
        let (min, max) = (f64::from(padded.min[axis]), f64::from(padded.max[axis]));
        assert!(outward(low - min) && outward(max - high), "{axis}: {min} to {max}");
    }
    // The largest may be a negative one.
    let other = padded_box(&[[-1.0, -2.0, -3.0], [4.0, -5.0, -6.0], [-7.0, 8.0, -9.0]], 100.0);
    assert_eq!((other.min, other.max), (-padded.max, -padded.min));
}

#[test]
fn the_stack_holds_the_longest_way_down() {
    let leaf = Bvh2Node::new(Aabb::INVALID, 1, 0);
    let inner = |first: u32| Bvh2Node::new(Aabb::INVALID, 0, first);
    let tree = |nodes: Vec<Bvh2Node>| Bvh2 { nodes, ..Bvh2::default() };
    assert_eq!(deepest(&Bvh2::default()), 0);
    assert_eq!(deepest(&tree(vec![leaf])), 0);
    assert_eq!(deepest(&tree(vec![inner(1), leaf, leaf])), 1);
    // The longest way by the first child, and by the second.
    assert_eq!(deepest(&tree(vec![inner(1), inner(3), leaf, inner(5), leaf, leaf, leaf])), 3);
    assert_eq!(deepest(&tree(vec![inner(1), leaf, inner(3), leaf, inner(5), leaf, leaf])), 3);
}
