//! The resolved scene: terrain, posed camera and beams. Valid by construction.

use std::sync::Arc;

use crate::error::check_range;
use crate::{Beam, Camera, Mesh, NamedRaySet, Pose, Ray, SceneError, SensorId};

/// A sensor and its pose.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mounted<S> {
    /// The sensor's frame in the scene frame.
    pub scene_from_sensor: Pose,
    /// The sensor.
    pub sensor: S,
}

/// The atmosphere between the sensors and the terrain.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Atmosphere {
    /// Attenuation coefficient sigma, 1/m.
    pub attenuation: f64,
}

/// The equation for a pencil's flux on the camera.
///
/// ```
/// use raypencil_scene::FluxModel;
///
/// assert_eq!(FluxModel::Radiometric.word(), "radiometric");
/// assert_eq!(FluxModel::Radiometric.other(), FluxModel::Eq1);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FluxModel {
    /// Flux that conserves energy, watts.
    Radiometric,
    /// Equation (1) of the paper as printed, in W/m.
    Eq1,
}

impl FluxModel {
    /// The other of the two models.
    pub fn other(self) -> Self {
        match self {
            Self::Radiometric => Self::Eq1,
            Self::Eq1 => Self::Radiometric,
        }
    }

    /// The model's name in files and on the command line.
    pub fn word(self) -> &'static str {
        match self {
            Self::Radiometric => "radiometric",
            Self::Eq1 => "eq1",
        }
    }
}

/// Everything that a renderer needs to know. It is checked once, when it is built.
///
/// ```
/// use glam::DVec3;
/// use raypencil_scene::{Atmosphere, FluxModel, Material, Mesh, Scene, SensorId, rig};
///
/// let sand = Material { name: "sand".into(), reflectivity: 0.25 };
/// let corners = [[-9.0, -9.0, 0.0], [9.0, -9.0, 0.0], [0.0, 9.0, 0.0]].map(DVec3::from_array);
/// let mesh = Mesh::from_global(&corners, vec![[0, 1, 2]], vec![0], vec![sand])?;
/// let (camera, beams) = rig::default_rig(16, DVec3::ZERO, 0.0);
/// let scene = Scene::new(mesh.into(), camera, beams, Atmosphere { attenuation: 0.0 }, FluxModel::Radiometric)?;
/// // 1024 / 16 columns, 16 / 16 rows but two at least.
/// assert_eq!(scene.size(SensorId::Beam(0)), Some((64, 2)));
/// assert_eq!(scene.ray(SensorId::Beam(0), 64, 0), None);
/// # Ok::<(), raypencil_scene::SceneError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Scene {
    mesh: Arc<Mesh>,
    camera: Mounted<Camera>,
    beams: Vec<Mounted<Beam>>,
    atmosphere: Atmosphere,
    flux_model: FluxModel,
    ray_sets: Vec<NamedRaySet>,
}

impl Scene {
    /// Puts a scene together.
    ///
    /// # Errors
    /// Names the first field that no renderer could work with.
    pub fn new(
        mesh: Arc<Mesh>,
        camera: Mounted<Camera>,
        beams: Vec<Mounted<Beam>>,
        atmosphere: Atmosphere,
        flux_model: FluxModel,
    ) -> Result<Self, SceneError> {
        camera.scene_from_sensor.validate("camera")?;
        camera.sensor.validate("camera")?;
        if beams.len() > 64 {
            return Err(SceneError::new("beams", beams.len(), "at most 64"));
        }
        for (index, beam) in beams.iter().enumerate() {
            let field = format!("beam {index}");
            beam.scene_from_sensor.validate(&field)?;
            beam.sensor.validate(&field)?;
        }
        check_range(|| "atmosphere.attenuation".into(), atmosphere.attenuation, 0.0, 1e3, "1/m")?;
        Ok(Self { mesh, camera, beams, atmosphere, flux_model, ray_sets: Vec::new() })
    }

    /// The scene with sets of rays that belong to no camera and no beam, in the scene frame.
    ///
    /// # Errors
    /// Two sets of one name.
    pub fn with_ray_sets(self, ray_sets: Vec<NamedRaySet>) -> Result<Self, SceneError> {
        for (index, set) in ray_sets.iter().enumerate() {
            if ray_sets[..index].iter().any(|other| other.name == set.name) {
                return Err(SceneError::new(format!("rays {index}.name"), &set.name, "a name of its own"));
            }
        }
        Ok(Self { ray_sets, ..self })
    }

    /// Sets of rays that belong to no camera and no beam, in the scene frame.
    pub fn ray_sets(&self) -> &[NamedRaySet] {
        &self.ray_sets
    }

    /// The terrain. Shared, so that a renderer can keep what it built for it.
    pub fn mesh(&self) -> &Arc<Mesh> {
        &self.mesh
    }

    /// The camera.
    pub fn camera(&self) -> &Mounted<Camera> {
        &self.camera
    }

    /// The laser beams.
    pub fn beams(&self) -> &[Mounted<Beam>] {
        &self.beams
    }

    /// The air.
    pub fn atmosphere(&self) -> Atmosphere {
        self.atmosphere
    }

    /// The equation of flux.
    pub fn flux_model(&self) -> FluxModel {
        self.flux_model
    }

    /// All sensors, the camera first.
    pub fn sensors(&self) -> impl Iterator<Item = SensorId> {
        std::iter::once(SensorId::Camera).chain((0..self.beams.len()).map(SensorId::Beam))
    }

    /// Columns and rows of a sensor's maps, or `None` if the scene has no such sensor.
    pub fn size(&self, sensor: SensorId) -> Option<(u32, u32)> {
        match sensor {
            SensorId::Camera => Some((self.camera.sensor.width, self.camera.sensor.height)),
            SensorId::Beam(index) => {
                self.beams.get(index).map(|beam| (beam.sensor.columns, beam.sensor.rows))
            }
        }
    }

    /// The longest range of a sensor along its rays, metres, or `None` if the scene has no such sensor.
    pub fn max_range(&self, sensor: SensorId) -> Option<f64> {
        match sensor {
            SensorId::Camera => Some(self.camera.sensor.max_range),
            SensorId::Beam(index) => self.beams.get(index).map(|beam| beam.sensor.max_range),
        }
    }

    /// The contract's ray of cell (i, j) of a sensor, rounded to `f64`, or `None` if there is no such cell.
    ///
    /// This is the definition for people and files. Each renderer forms its rays by itself.
    pub fn ray(&self, sensor: SensorId, i: u32, j: u32) -> Option<Ray> {
        let (width, height) = self.size(sensor)?;
        if i >= width || j >= height {
            return None;
        }
        Some(match sensor {
            SensorId::Camera => {
                let Mounted { scene_from_sensor, sensor } = self.camera;
                Ray {
                    origin: scene_from_sensor.position,
                    direction: scene_from_sensor.rotate(sensor.direction(i, j)),
                }
            }
            SensorId::Beam(index) => {
                let Mounted { scene_from_sensor, sensor } = self.beams[index];
                Ray {
                    origin: scene_from_sensor * sensor.origin(j),
                    direction: scene_from_sensor.rotate(sensor.direction(i)),
                }
            }
        })
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::rig;

    #[test]
    fn rays_of_a_beam_start_on_its_focal_axis() {
        // Two rows 4 mm apart on a level beam at (1, 2, 3) that looks along the global x axis. Its y axis points down,
        // so that row 0 starts 2 mm above its origin. Column 3 of 4, each 1/16 m wide on the grid, runs 1.5 cells to
        // the right of the axis: right is the negative global y.
        let beam = rig::beam(4, 2, [0.0625, 0.004], 0.125);
        let pose = Pose { position: DVec3::new(1.0, 2.0, 3.0), ..Pose::VEHICLE_FROM_FORWARD_SENSOR };
        let mesh = Mesh::new(DVec3::ZERO, vec![], vec![], vec![], vec![]).unwrap();
        let camera = Mounted { scene_from_sensor: pose, sensor: rig::camera(2, 2, 0.0625, 0.5) };
        let beams = vec![Mounted { scene_from_sensor: pose, sensor: beam }];
        let air = Atmosphere { attenuation: 0.0 };
        let scene = Scene::new(mesh.into(), camera, beams, air, FluxModel::Radiometric).unwrap();
        let ray = scene.ray(SensorId::Beam(0), 3, 0).unwrap();
        assert_eq!(ray.direction, DVec3::new(0.125, -0.09375, 0.0));
        assert!((ray.origin - DVec3::new(1.0, 2.0, 3.002)).length() < 1e-15);
        // A ray of the camera starts in the projection centre.
        let ray = scene.ray(SensorId::Camera, 1, 0).unwrap();
        assert_eq!((ray.origin, ray.direction), (pose.position, DVec3::new(0.5, -0.03125, 0.03125)));
    }
}
