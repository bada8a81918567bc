//! Panned sensors, and the conversion of a rig to a scene and back.

use std::sync::Arc;

use glam::DVec3;
use raypencil_rover::{Pan, Rig};
use raypencil_scene::{Atmosphere, FluxModel, Pose};

use super::common;

fn default_rig() -> Rig {
    common::rig(1024, 16)
}

#[test]
fn panning_turns_down_about_the_sensors_own_place() {
    // Mounted 31 degrees down and panned by 14 degrees, the beam points 45 degrees down. Its position stays.
    let rig = default_rig();
    let panned = rig.panned(Pan { camera: 0.0, beams: 14.0_f64.to_radians() });
    assert_eq!(panned.camera, rig.camera);
    let pose = panned.beams[0].vehicle_from_sensor;
    assert_eq!(pose.position, DVec3::new(0.3, 0.0, 1.8));
    let half = 0.5_f64.sqrt();
    assert!((pose.rotate(DVec3::Z) - DVec3::new(half, 0.0, -half)).length() < 1e-15);
    // The beam's x axis, across the fan, still points to the vehicle's right.
    assert!((pose.rotate(DVec3::X) + DVec3::Y).length() < 1e-15);
}

#[test]
fn a_scene_of_the_rig_gives_the_rig_back() {
    let rig = default_rig();
    let mesh = raypencil_terrain::builtin("pyramids", 0.25).unwrap().into_mesh().unwrap();
    let stand = Pose { position: DVec3::new(2.0, -1.0, 0.3), ..Pose::from_axis_angle(DVec3::Z, 0.7) };
    let air = Atmosphere { attenuation: 0.0 };
    let scene = rig.scene(Arc::new(mesh), stand, air, FluxModel::Radiometric).unwrap();
    let again = Rig::from_scene(&scene, stand);
    for (a, b) in again.beams.iter().zip(&rig.beams) {
        let p = DVec3::new(0.2, 0.1, 3.0);
        assert!((a.vehicle_from_sensor * p - b.vehicle_from_sensor * p).length() < 1e-14);
    }
    assert!(rig.validate("rig").is_ok());
}
