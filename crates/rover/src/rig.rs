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
    pub fn from_scene(scene: &Scene, scene_from_vehicle: Pose) -> Self {
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
