//! Which side is met first.

use std::sync::Arc;

use glam::DVec3;
use raypencil_scene::{Atmosphere, FluxModel, Material, Mesh, Mounted, Pose, Scene, rig};
use raypencil_survey::facings;

/// A camera of 8 x 8 pixels that looks along z at walls at these depths, each with its front to the camera or its back.
fn seen(walls: &[(f32, bool)]) -> [u64; 3] {
    let corners = walls.iter().flat_map(|(z, _)| [[-90.0, -90.0, *z], [90.0, -90.0, *z], [0.0, 90.0, *z]]);
    let faces = walls.iter().zip(0..).map(|((_, shows_front), k): (_, u32)| {
        if *shows_front { [3 * k, 3 * k + 2, 3 * k + 1] } else { [3 * k, 3 * k + 1, 3 * k + 2] }
    });
    let stone = Material { name: "stone".into(), reflectivity: 0.5 };
    let mesh = Mesh::new(DVec3::ZERO, corners.collect(), faces.collect(), vec![0; walls.len()], vec![stone])
        .unwrap();
    let camera = Mounted { scene_from_sensor: Pose::IDENTITY, sensor: rig::camera(8, 8, 1e-3, 8e-3) };
    let air = Atmosphere { attenuation: 0.0 };
    let scene = Scene::new(Arc::new(mesh), camera, Vec::new(), air, FluxModel::Radiometric).unwrap();
    let found = facings(&scene)[0];
    [found.rays, found.fronts, found.backs]
}

#[test]
fn the_nearer_side_counts_and_at_one_place_the_front() {
    let (front, back) = (true, false);
    assert_eq!(seen(&[(2.0, front)]), [64, 64, 0]);
    assert_eq!(seen(&[(2.0, back)]), [64, 0, 64]);
    assert_eq!(seen(&[(2.0, front), (3.0, back)]), [64, 64, 0]);
    assert_eq!(seen(&[(3.0, front), (2.0, back)]), [64, 0, 64]);
    // Two-sided: the front and the back are met at one range, in either order.
    assert_eq!(seen(&[(2.0, front), (2.0, back)]), [64, 64, 0]);
    assert_eq!(seen(&[(2.0, back), (2.0, front)]), [64, 64, 0]);
    assert_eq!(seen(&[]), [64, 0, 0]);
}
