//! Sheets by hand.

use std::sync::Arc;

use glam::DVec3;
use raypencil_scene::{Atmosphere, Camera, FluxModel, Lens, Material, Mesh, Mounted, Pose, Scene, SensorId};

use super::*;
use crate::hits::verdict::Referee;
use crate::rays::ray::{Aim, MountedSensor};

/// Where two faces go on from an edge, the one is followed that shows its front in more of the square. Pixel (4, 4) looks along z from the
/// origin; at a depth of 2 m, where the faces meet, a cell is 1/4 m.
#[test]
fn of_two_faces_at_an_edge_that_is_followed_which_holds_farther() {
    let start = [[-4.0, 0.0, 2.0], [0.0625, 4.0, 2.0], [0.0625, -4.0, 2.0]];
    let level = [[4.0, 0.0, 2.0], [0.0625, -4.0, 2.0], [0.0625, 4.0, 2.0]];
    // 16 m deeper for 1 m to the right: rays of x = z / 16, half a cell away, are parallel to it.
    let steep = [[1.0625, 0.0, 18.0], [0.0625, -4.0, 2.0], [0.0625, 4.0, 2.0]];
    for faces in [[start, level, steep], [start, steep, level]] {
        let vertices: Vec<[f32; 3]> = faces.into_iter().flatten().collect();
        let material = Material { name: "ground".into(), reflectivity: 0.25 };
        let mesh = Mesh::new(
            DVec3::ZERO,
            vertices,
            vec![[0, 1, 2], [3, 4, 5], [6, 7, 8]],
            vec![0; 3],
            vec![material],
        )
        .expect("a mesh");
        let camera = Camera {
            width: 9,
            height: 9,
            pixel_pitch: [0.0625; 2],
            focal_length: 0.5,
            principal_point: [4.5; 2],
            aperture: 0.01,
            lens: Lens::CLEAR,
            max_range: 20.0,
        };
        let camera = Mounted { scene_from_sensor: Pose::IDENTITY, sensor: camera };
        let air = Atmosphere { attenuation: 0.0 };
        let scene = Scene::new(Arc::new(mesh), camera, vec![], air, FluxModel::Radiometric).expect("a scene");
        let referee = Referee::new(&scene);
        let sensor = MountedSensor::of(&scene, SensorId::Camera).expect("a camera");
        let mut near = Neighbourhood::new(&referee, &sensor, Aim { i: 4, j: 4, dx: 0.0, dy: 0.0 });
        let [first] = near.nearest_at([0.0; 2])[..] else { panic!("one face") };
        let sheet = near.covering_sheet([0.0; 2], first, 0.75).expect("a sheet without an end");
        let corners = |index: usize| near.faces[index].face.corners;
        assert_eq!(sheet.into_iter().map(corners).collect::<Vec<_>>(), [start, level]);
    }
}
