//! The camera and the beams on the vehicle, and their panning. (Paper, §2, figure 1)

use std::sync::Arc;

use glam::DVec3;
use raypencil_scene::{Atmosphere, Beam, Camera, FluxModel, Mesh, Mounted, Pose, Scene, SceneError};

/// A sensor (camera or beam) mounted on the vehicle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OnVehicle<S> {
    /// Pose of the sensor in the vehicle frame.
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
    /// The beams, in order of their stripes, the nearest first.
    pub beams: Vec<OnVehicle<Beam>>,
}

/// Angles by which the sensors are turned downwards from their mounted direction, radians.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Pan {
    /// Angle of the camera.
    pub camera: f64,
    /// Angle of every beam.
    pub beams: f64,
}

impl Rig {
    /// Pose of a sensor at `position` (vehicle frame, metres) that points `pitch_down` radians below straight ahead.
    pub fn mount(position: DVec3, pitch_down: f64) -> Pose {
        let turn = Pose::from_axis_angle(DVec3::Y, pitch_down);
        Pose { position, ..turn * Pose::VEHICLE_FROM_FORWARD_SENSOR }
    }

    /// Rig of a scene whose vehicle has the pose `scene_from_vehicle`.
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

    /// This rig with its sensors panned vertically. Each turns about its own origin, around an axis parallel to the
    /// vehicle's y axis. "If the vehicle is at rest, the beams can be panned vertically." (§2)
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

    /// Scene of this rig on a vehicle with the pose `global_from_vehicle`.
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
        // Subtract the origin first: at 1e6 m, offsets added to global coordinates would lose seven digits.
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

    /// Checks every sensor. The error names the first field that is out of range.
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
