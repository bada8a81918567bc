//! The sensors as they are mounted on the vehicle, and how they are panned. (Paper, §2, figure 1)

use std::sync::Arc;

use glam::DVec3;
use raypencil_scene::{Atmosphere, Beam, Camera, FluxModel, Mesh, Mounted, Pose, Scene, SceneError};

/// A sensor and where it stands on the vehicle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OnVehicle<S> {
    /// The sensor's frame in the vehicle frame.
    pub vehicle_from_sensor: Pose,
    /// The sensor.
    pub sensor: S,
}

/// One camera and the beams above it. "The camera and the beams have their own local coordinate systems defined
/// with respect to a local vehicle coordinate system." (§2)
#[derive(Debug, Clone, PartialEq)]
pub struct Rig {
    /// The camera.
    pub camera: OnVehicle<Camera>,
    /// The beams, the nearest stripe's first.
    pub beams: Vec<OnVehicle<Beam>>,
}

/// How far the sensors are turned downwards from where they are mounted, radians.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Pan {
    /// The camera.
    pub camera: f64,
    /// Every beam.
    pub beams: f64,
}

impl Rig {
    /// Mounts a sensor at `position` (vehicle frame, metres), turned down by `pitch_down` radians from looking
    /// straight ahead.
    pub fn mount(position: DVec3, pitch_down: f64) -> Pose {
        let turn = Pose::from_axis_angle(DVec3::Y, pitch_down);
        Pose { position, ..turn * Pose::VEHICLE_FROM_FORWARD_SENSOR }
    }

    /// The rig of a scene whose vehicle stands at `scene_from_vehicle`.
    pub fn of_scene(scene: &Scene, scene_from_vehicle: Pose) -> Self {
        let vehicle_from_scene = scene_from_vehicle.inverse();
        let beams = scene.beams().iter().map(|beam| OnVehicle {
            vehicle_from_sensor: vehicle_from_scene * beam.scene_from_sensor,
            sensor: beam.sensor,
        });
        let Mounted { scene_from_sensor, sensor } = *scene.camera();
        Self {
            camera: OnVehicle { vehicle_from_sensor: vehicle_from_scene * scene_from_sensor, sensor },
            beams: beams.collect(),
        }
    }

    /// This rig with its sensors panned vertically: each turns about the line through its own origin that is
    /// parallel to the vehicle's y axis. "If the vehicle is at rest, the beams can be panned vertically." (§2)
    pub fn panned(&self, pan: Pan) -> Self {
        fn turned<S>(mount: OnVehicle<S>, angle: f64) -> OnVehicle<S> {
            let turn = Pose::from_axis_angle(DVec3::Y, angle);
            let pose = mount.vehicle_from_sensor;
            let turned = turn * Pose { position: DVec3::ZERO, ..pose };
            OnVehicle { vehicle_from_sensor: Pose { position: pose.position, ..turned }, ..mount }
        }
        Self {
            camera: turned(self.camera, pan.camera),
            beams: self.beams.iter().map(|&beam| turned(beam, pan.beams)).collect(),
        }
    }

    /// The scene that this rig sees from a vehicle at `global_from_vehicle`.
    ///
    /// # Errors
    /// As [`Scene::new`].
    pub fn scene(
        &self,
        mesh: Arc<Mesh>,
        global_from_vehicle: Pose,
        atmosphere: Atmosphere,
        flux_model: FluxModel,
    ) -> Result<Scene, SceneError> {
        // The origin is taken off first: at 1e6 m, offsets added to global coordinates would lose seven digits.
        let position = global_from_vehicle.position - mesh.origin();
        let scene_from_vehicle = Pose { position, ..global_from_vehicle };
        let camera = Mounted {
            scene_from_sensor: scene_from_vehicle * self.camera.vehicle_from_sensor,
            sensor: self.camera.sensor,
        };
        let beams = self.beams.iter().map(|beam| Mounted {
            scene_from_sensor: scene_from_vehicle * beam.vehicle_from_sensor,
            sensor: beam.sensor,
        });
        Scene::new(mesh, camera, beams.collect(), atmosphere, flux_model)
    }

    /// Refuses a rig that no scene could be made of, naming the field.
    pub fn validate(&self, field: &str) -> Result<(), SceneError> {
        let name = format!("{field}.camera");
        self.camera.vehicle_from_sensor.validate(&name)?;
        self.camera.sensor.validate(&name)?;
        for (index, beam) in self.beams.iter().enumerate() {
            let name = format!("{field}.beams[{index}]");
            beam.vehicle_from_sensor.validate(&name)?;
            beam.sensor.validate(&name)?;
        }
        Ok(())
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use raypencil_scene::{Lens, Profile};

    use super::*;

    /// The project's default rig: camera 1.5 m up and 20 degrees down, beams 1.8 and 2.0 m up, 31 and 22 degrees
    /// down.
    pub(crate) fn default_rig() -> Rig {
        let camera = Camera {
            width: 1024,
            height: 1024,
            pixel_pitch: [9e-6; 2],
            focal_length: 8e-3,
            principal_point: [512.0; 2],
            aperture: 2e-3,
            lens: Lens::CLEAR,
            max_range: 20.0,
        };
        let beam = Beam {
            columns: 1024,
            rows: 16,
            thickness: 5e-3,
            grid_distance: 0.1,
            half_width: Beam::half_width_of(0.1, 60.0_f64.to_radians()),
            max_range: 20.0,
            power: 1.0,
            wavelength: 810e-9,
            profile: Profile::Paper,
        };
        let mount = |height, down: f64| Rig::mount(DVec3::new(0.3, 0.0, height), down.to_radians());
        Rig {
            camera: OnVehicle { vehicle_from_sensor: mount(1.5, 20.0), sensor: camera },
            beams: [(1.8, 31.0), (2.0, 22.0)]
                .map(|(height, down)| OnVehicle { vehicle_from_sensor: mount(height, down), sensor: beam })
                .to_vec(),
        }
    }

    #[test]
    fn panning_turns_down_about_the_sensors_own_place() {
        // Mounted 31 degrees down and panned 14 more, the beam looks 45 degrees down from where it was.
        let rig = default_rig();
        let panned = rig.panned(Pan { camera: 0.0, beams: 14.0_f64.to_radians() });
        assert_eq!(panned.camera, rig.camera);
        let pose = panned.beams[0].vehicle_from_sensor;
        assert_eq!(pose.position, DVec3::new(0.3, 0.0, 1.8));
        let half = 0.5_f64.sqrt();
        assert!((pose.rotate(DVec3::Z) - DVec3::new(half, 0.0, -half)).length() < 1e-15);
        // Its x axis, across the fan, still points to the vehicle's right.
        assert!((pose.rotate(DVec3::X) + DVec3::Y).length() < 1e-15);
    }

    #[test]
    fn a_scene_of_the_rig_gives_the_rig_back() {
        let rig = default_rig();
        let mesh = raypencil_terrain::builtin("pyramids", 0.25).unwrap().into_mesh().unwrap();
        let stand = Pose { position: DVec3::new(2.0, -1.0, 0.3), ..Pose::from_axis_angle(DVec3::Z, 0.7) };
        let air = Atmosphere { attenuation: 0.0 };
        let scene = rig.scene(Arc::new(mesh), stand, air, FluxModel::Radiometric).unwrap();
        let again = Rig::of_scene(&scene, stand);
        for (a, b) in again.beams.iter().zip(&rig.beams) {
            let p = DVec3::new(0.2, 0.1, 3.0);
            assert!((a.vehicle_from_sensor * p - b.vehicle_from_sensor * p).length() < 1e-14);
        }
        assert!(rig.validate("rig").is_ok());
    }
}
