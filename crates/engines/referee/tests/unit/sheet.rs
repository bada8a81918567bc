//! Sheets by hand. Pixel (4, 4) of the camera looks along z from the origin; a cell is 1/8 m for each metre of depth.

use std::sync::Arc;

use glam::DVec3;
use raypencil_scene::{Atmosphere, FluxModel, Material, Mesh, Mounted, Pose, Scene, SensorId};

use super::*;
use crate::hits::verdict::Referee;
use crate::rays::ray::{Aim, MountedSensor};
use crate::small_camera::small_camera;

type Corners = [[f32; 3]; 3];

/// What the middle pixel's neighbourhood of these faces says.
fn around<T>(faces: &[Corners], says: impl Fn(Neighbourhood<'_>) -> T) -> T {
    let vertices = faces.iter().flatten().copied().collect();
    let indices = (0..faces.len() as u32).map(|face| [3 * face, 3 * face + 1, 3 * face + 2]).collect();
    let material = Material { name: "ground".into(), reflectivity: 0.25 };
    let mesh =
        Mesh::new(DVec3::ZERO, vertices, indices, vec![0; faces.len()], vec![material]).expect("a mesh");
    let camera = Mounted { scene_from_sensor: Pose::IDENTITY, sensor: small_camera() };
    let air = Atmosphere { attenuation: 0.0 };
    let scene = Scene::new(Arc::new(mesh), camera, vec![], air, FluxModel::Radiometric).expect("a scene");
    let referee = Referee::new(&scene);
    let sensor = MountedSensor::of(&scene, SensorId::Camera).expect("a camera");
    says(Neighbourhood::new(&referee, &sensor, Aim { i: 4, j: 4, dx: 0.0, dy: 0.0 }))
}

/// Where two faces go on from an edge, the one is followed that shows its front in more of the square.
#[test]
fn of_two_faces_at_an_edge_that_is_followed_which_holds_farther() {
    let start = [[-4.0, 0.0, 2.0], [0.0625, 4.0, 2.0], [0.0625, -4.0, 2.0]];
    let level = [[4.0, 0.0, 2.0], [0.0625, -4.0, 2.0], [0.0625, 4.0, 2.0]];
    // 16 m deeper for 1 m to the right: rays of x = z / 16, half a cell away, are parallel to it.
    let steep = [[1.0625, 0.0, 18.0], [0.0625, -4.0, 2.0], [0.0625, 4.0, 2.0]];
    for faces in [[start, level, steep], [start, steep, level]] {
        let followed: Vec<Corners> = around(&faces, |mut near| {
            let [first] = near.nearest_at([0.0; 2])[..] else { panic!("one face") };
            let sheet = near.covering_sheet([0.0; 2], first, 0.75).expect("a sheet without an end");
            sheet.into_iter().map(|index| near.faces[index].face.corners).collect()
        });
        assert_eq!(followed, [start, level]);
    }
}

/// All rays around one that misses miss up to the nearest face, which is half a cell to the right here.
#[test]
fn all_rays_miss_up_to_the_nearest_face() {
    let beside = [[4.0, 0.0, 2.0], [0.125, -4.0, 2.0], [0.125, 4.0, 2.0]];
    let radius = around(&[beside], |mut near| {
        assert!(near.nearest_at([0.0; 2]).is_empty());
        near.continuous_within([0.0; 2], &[], 1.0)
    });
    assert!(radius <= 0.5 && radius > 0.5 - 1e-9, "{radius}");
}

/// A face through the sensor's projection plane: it is beyond it from the line dx + dy = 1.2 on, and its image ends at dy = 0.1. The line
/// alone leaves 0.6 cells; of both together nothing is left for less than 1.1.
#[test]
fn a_face_is_absent_where_two_conditions_exclude_each_other() {
    // The plane z = 0.35 + 2 x + 2 y, by places x / z and y / z of the image; the projection plane is at z = 1/2.
    let corner = |x: f64, y: f64| {
        let z = 0.35 / (1.0 - 2.0 * (x + y));
        [x * z, y * z, z].map(|part| part as f32)
    };
    let face = [corner(-0.3, 0.0125), corner(0.3, 0.0125), corner(0.0, -0.4)];
    let [alone, absent] = around(&[face], |near| {
        let face = &near.faces[0];
        let [p, q, r] = &face.corners;
        let alone = face.conditions().iter().map(Form::fails_within);
        [alone.fold(beside([p, q, r], [0.0; 2]), f64::max), ProvenRadii::of(face, [0.0; 2]).absent]
    });
    assert!((alone - 0.6).abs() < 1e-6 && absent == 1.0, "{alone} {absent}");
}
