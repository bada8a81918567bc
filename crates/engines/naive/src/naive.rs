//! The renderer: every ray against every face.

use std::time::Instant;

use glam::DVec3;
use rayon::prelude::*;
use raypencil_scene::{
    FaceId, Mesh, Precision, Quantities, RenderOutput, Renderer, Request, Sampling, Scene, SensorId,
    SensorMap, Stage,
};

use crate::fault::Fault;
use crate::hits::{Spheres, clipped, describe, first_hit, meets, plane_parameter};
use crate::injected::Injected;
use crate::light;
use crate::rays::{PosedSensor, camera_pose, pencil_ray, pixel_ray};
use crate::slack::Slack;

/// The naive renderer.
///
/// ```
/// use raypencil_naive::{Fault, Naive};
/// use raypencil_scene::{Renderer, Request};
/// # use std::sync::Arc;
/// # use glam::DVec3;
/// # use raypencil_scene::{Atmosphere, FluxModel, Material, Mesh, Mounted, Pose, Scene, rig};
/// # let corners = vec![[-40.0, -40.0, 2.0], [-40.0, 40.0, 2.0], [80.0, 0.0, 2.0]];
/// # let plaster = Material { name: "plaster".into(), reflectivity: 0.5 };
/// # let wall = Mesh::new(DVec3::ZERO, corners, vec![[0, 1, 2]], vec![0], vec![plaster])?;
/// # let camera = rig::camera(3, 3, 0.09375, 0.125);
/// # let camera = Mounted { scene_from_sensor: Pose::IDENTITY, sensor: camera };
/// # let air = Atmosphere { attenuation: 0.0 };
/// # let scene = Scene::new(Arc::new(wall), camera, vec![], air, FluxModel::Radiometric)?;
///
/// // A wall at z = 2 m. The ray of pixel (0, 1) runs along (-3/32, 0, 1/8): at z = 2 m its range is 2.5 m.
/// for (fault, range) in [(None, 2.5), (Some(Fault::DepthForRange), 2.0)] {
///     let camera = Naive { fault }.render(&scene, &Request::MAPS).camera.unwrap();
///     assert_eq!(camera.hit(0, 1).unwrap().range, range);
/// }
/// # Ok::<(), raypencil_scene::SceneError>(())
/// ```
#[derive(Debug, Clone, Copy, Default)]
pub struct Naive {
    /// The fault that is injected, if any.
    pub fault: Option<Fault>,
}

impl Renderer for Naive {
    fn name(&self) -> &str {
        "naive"
    }

    fn precision(&self) -> Precision {
        Precision::F64
    }

    fn render(&self, scene: &Scene, request: &Request) -> RenderOutput {
        render(Injected { fault: self.fault, slack: None }, scene, request)
    }
}

/// The naive renderer with a slack of some size; with the size 0 it is the honest one.
///
/// ```
/// use raypencil_naive::{Lax, Slack};
/// use raypencil_scene::{Renderer, Request};
/// # use std::sync::Arc;
/// # use glam::DVec3;
/// # use raypencil_scene::{Atmosphere, FluxModel, Material, Mesh, Mounted, Pose, Scene, rig};
/// # let corners = vec![[-40.0, -40.0, 2.0], [-40.0, 40.0, 2.0], [80.0, 0.0, 2.0]];
/// # let plaster = Material { name: "plaster".into(), reflectivity: 0.5 };
/// # let wall = Mesh::new(DVec3::ZERO, corners, vec![[0, 1, 2]], vec![0], vec![plaster])?;
/// # let camera = rig::camera(3, 3, 0.09375, 0.125);
/// # let camera = Mounted { scene_from_sensor: Pose::IDENTITY, sensor: camera };
/// # let air = Atmosphere { attenuation: 0.0 };
/// # let scene = Scene::new(Arc::new(wall), camera, vec![], air, FluxModel::Radiometric)?;
///
/// // A wall at a range of 2.5 m.
/// let lax = Lax { slack: Slack::RangeScaled, size: 0.5 };
/// let camera = lax.render(&scene, &Request::MAPS).camera.unwrap();
/// assert_eq!(camera.hit(0, 1).unwrap().range, 3.75);
/// # Ok::<(), raypencil_scene::SceneError>(())
/// ```
#[derive(Debug, Clone, Copy)]
pub struct Lax {
    /// The clause that it keeps with a tolerance.
    pub slack: Slack,
    /// The size of the tolerance, in the slack's unit.
    pub size: f64,
}

impl Renderer for Lax {
    fn name(&self) -> &str {
        "lax"
    }

    fn precision(&self) -> Precision {
        Precision::F64
    }

    fn render(&self, scene: &Scene, request: &Request) -> RenderOutput {
        render(Injected { fault: None, slack: Some((self.slack, self.size)) }, scene, request)
    }
}

fn render(faults: Injected, scene: &Scene, request: &Request) -> RenderOutput {
    let faces = corners(faults, scene.mesh());
    let mut stages = Vec::new();
    let mut timed = |sensor: &PosedSensor<'_>| {
        let start = Instant::now();
        let map = map(faults, &faces, sensor, request.quantities);
        stages.push(Stage { name: sensor.id.to_string(), time: start.elapsed() });
        map
    };
    let camera = request.camera.then(|| {
        let camera = &scene.camera().sensor;
        timed(&PosedSensor {
            id: SensorId::Camera,
            pose: camera_pose(faults, scene.camera().scene_from_sensor),
            size: (camera.width, camera.height),
            plane: camera.focal_length,
            max_range: camera.max_range,
            ray: &|i, j, shift| pixel_ray(faults, camera, (i, j), shift),
        })
    });
    let mut beams = Vec::new();
    // Pencils are rays through the centres of their cells; jittered ones it does not know.
    if request.beams && request.sampling == Sampling::Centres {
        for (index, mounted) in scene.beams().iter().enumerate() {
            let beam = &mounted.sensor;
            beams.push(timed(&PosedSensor {
                id: SensorId::Beam(index),
                pose: mounted.scene_from_sensor,
                size: (beam.columns, beam.rows),
                plane: beam.grid_distance,
                max_range: beam.max_range,
                ray: &|i, j, shift| pencil_ray(faults, beam, (i, j), shift),
            }));
        }
    }
    let (mut returns, mut flux) = (Vec::new(), Vec::new());
    if request.returns {
        let spheres = Spheres::around(&faces);
        for (index, map) in beams.iter().enumerate() {
            let (of_beam, image) = light::returns(faults, scene, (&faces, &spheres), index, map);
            returns.push(of_beam);
            flux.push(image);
        }
    }
    RenderOutput { camera, beams, returns, flux, stages }
}

/// The three corners of every face.
fn corners(faults: Injected, mesh: &Mesh) -> Vec<[DVec3; 3]> {
    let corner = |index: u32| {
        let [x, y, z] = mesh.vertices()[index as usize];
        let vertex = DVec3::new(f64::from(x), f64::from(y), f64::from(z));
        if faults.has(Fault::OriginTakenOffTwice) { vertex - mesh.origin() } else { vertex }
    };
    mesh.faces().iter().map(|face| face.map(corner)).collect()
}

/// The map of a sensor, cell by cell.
fn map(
    faults: Injected,
    faces: &[[DVec3; 3]],
    sensor: &PosedSensor<'_>,
    quantities: Quantities,
) -> SensorMap {
    let (width, height) = sensor.size;
    let mut map = SensorMap::empty(sensor.id, width, height, quantities);
    let faces = clipped(faults, faces, sensor);
    let spheres = Spheres::around(&faces);
    // Rows do not know of one another: the result does not depend on threads.
    map.rows_mut().into_par_iter().for_each(|mut row| {
        for i in 0..width {
            let ray = sensor.scene_ray(faults, (i, row.j), [0.0; 2]);
            let found = match faults.shift() {
                None => first_hit(faults, &faces, &spheres, sensor, &ray),
                // Another ray decides the face; the values are those of this one.
                Some(shift) => {
                    let shifted = sensor.scene_ray(faults, (i, row.j), shift);
                    let found = first_hit(faults, &faces, &spheres, sensor, &shifted);
                    found.map(|(index, _)| (index, plane_parameter(&faces[index], &ray)))
                }
            };
            if let Some((index, t)) = found {
                let mut hit = describe(faults, &faces, sensor, &ray, index, t);
                if faults.has(Fault::TieOfTwoRecords) {
                    let ties = |face: &[DVec3; 3]| meets(faults, face, &ray) == Some(t);
                    hit.face = FaceId(faces.iter().rposition(ties).unwrap_or(index) as u32);
                }
                row.put(i, &hit);
            }
        }
    });
    map
}
