//! Points at which the search for a face margin looks for witnesses.

use std::sync::Arc;

use glam::DVec3;
use raypencil_scene::{Atmosphere, FluxModel, Material, Mesh, Mounted, Pose, Scene, SensorId};

use super::*;
use crate::hits::verdict::Referee;
use crate::rays::ray::{Aim, MountedSensor};
use crate::small_camera::small_camera;

#[test]
fn witnesses_are_looked_for_in_the_face_by_a_part_of_its_width() {
    // Pixel (4, 4) looks along z; at a depth of 2 m a cell is 1/4 m.
    let corners = [[-0.125, -0.125, 2.0], [0.0, 0.125, 2.0], [0.125, -0.0625, 2.0]];
    let material = Material { name: "ground".into(), reflectivity: 0.25 };
    let mesh =
        Mesh::new(DVec3::ZERO, corners.to_vec(), vec![[0, 1, 2]], vec![0], vec![material]).expect("a mesh");
    let camera = Mounted { scene_from_sensor: Pose::IDENTITY, sensor: small_camera() };
    let air = Atmosphere { attenuation: 0.0 };
    let scene = Scene::new(Arc::new(mesh), camera, vec![], air, FluxModel::Radiometric).expect("a scene");
    let referee = Referee::new(&scene);
    let sensor = MountedSensor::of(&scene, SensorId::Camera).expect("a camera");
    let near = Neighbourhood::new(&referee, &sensor, Aim { i: 4, j: 4, dx: 0.0, dy: 0.0 });
    assert_eq!(near.faces.len(), 1);
    let nearest = near.nearest_at([0.0; 2]);
    let search = FaceMarginSearch::of(&near, &nearest, [0.0; 2], 1.0);
    // A witness at the limit is near enough.
    let limit = search.lo * 1.01 + 1e-12;
    assert!(search.lo > 0.0 && search.is_near_enough([-limit, 0.0]));
    assert!(!search.is_near_enough([0.0, limit.next_up()]));
    let threads = search.threads(0);
    assert_eq!(threads.len(), 3 * 15 * 3);
    assert!(threads.windows(2).all(|two| max_norm(two[0]) <= max_norm(two[1])));
    // Along each side from each corner, by weights that add up to 1.
    for k in 0..3 {
        for (s, inward) in [(0.0, 0.03), (0.5, 1e-3), (0.96, 1e-6), (0.2, 0.03)] {
            let mut weights = [inward / 3.0; 3];
            weights[k] += (1.0 - inward) * (1.0 - s);
            weights[(k + 1) % 3] += (1.0 - inward) * s;
            let place =
                |axis: usize| (0..3).map(|c| weights[c] * f64::from(corners[c][axis])).sum::<f64>() * 4.0;
            let is_there =
                |at: &[f64; 2]| (at[0] - place(0)).abs() < 1e-12 && (at[1] - place(1)).abs() < 1e-12;
            assert!(threads.iter().any(is_there), "{k} {s} {inward}");
        }
    }
}
