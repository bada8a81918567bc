//! Fronts and backs: which side of the terrain the rays of a sensor meet first.
//!
//! A renderer sees fronts only. Here each face is there twice, once as it is and once turned over. The first face that
//! a ray meets on this mesh is a face as it is (a front), or a face turned over (a back).

use std::sync::Arc;

use raypencil_scene::{Camera, Mesh, Mounted, Quantities, Renderer, Request, Scene, SensorId, SensorMap};
use raypencil_tracer::Tracer;

/// Most columns and rows of the camera in a sample: shares of the image are then good to one in 16,384.
const SAMPLE_PIXELS: u32 = 128;

/// Most columns of a beam in a sample.
const SAMPLE_COLUMNS: u32 = 512;

/// Most rows of a beam in a sample: the rows of a sheet are millimetres apart and see nearly the same.
const SAMPLE_ROWS: u32 = 4;

/// What the rays of a sensor meet first.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Facing {
    /// The sensor.
    pub sensor: SensorId,
    /// Number of its rays that were traced.
    pub rays: u64,
    /// Number of rays that meet the front of a face first.
    pub fronts: u64,
    /// Number of rays that meet the back of a face first.
    pub backs: u64,
}

/// Traces a sample of the rays of all sensors against both sides of the terrain: a coarser raster over the same field
/// of view. The list is empty for a terrain with more than two
/// thousand million faces, which cannot be there twice.
///
/// ```
/// use std::sync::Arc;
///
/// use glam::DVec3;
/// use raypencil_scene::{Atmosphere, FluxModel, Scene, rig};
/// use raypencil_survey::facings;
///
/// let mesh = raypencil_terrain::builtin("pyramids", 0.25).expect("a built-in name").into_mesh()?;
/// // 5 m below the ground a camera of 16 x 16 pixels that looks straight up sees the back of the ground.
/// let sensor = rig::camera(16, 16, 1e-4, 8e-3);
/// let camera = rig::pitched(DVec3::new(0.0, 0.0, -5.0), -std::f64::consts::FRAC_PI_2, sensor);
/// let air = Atmosphere { attenuation: 0.0 };
/// let scene = Scene::new(Arc::new(mesh), camera, Vec::new(), air, FluxModel::Radiometric)?;
/// let facing = facings(&scene)[0];
/// assert_eq!((facing.rays, facing.fronts, facing.backs), (256, 0, 256));
/// # Ok::<(), raypencil_scene::SceneError>(())
/// ```
pub fn facings(scene: &Scene) -> Vec<Facing> {
    let Some(two_sided) = two_sided(scene) else { return Vec::new() };
    let own_faces = scene.mesh().faces().len() as u32;
    let face_alone = Quantities { face: true, ..Quantities::NONE };
    let request = Request { quantities: face_alone, ..Request::MAPS };
    let output = Tracer::new().render(&two_sided, &request);
    let of_map = |map: &SensorMap| {
        let faces = map.face.iter().flat_map(|faces| faces.cells()).filter_map(|face| face.get());
        let (mut fronts, mut backs) = (0, 0);
        for face in faces {
            *(if face.0 < own_faces { &mut fronts } else { &mut backs }) += 1;
        }
        Facing { sensor: map.sensor, rays: map.cell_count() as u64, fronts, backs }
    };
    output.maps().map(of_map).collect()
}

/// The scene with each face twice: as it is, then all of them turned over.
fn two_sided(scene: &Scene) -> Option<Scene> {
    let mesh = scene.mesh();
    let over = mesh.faces().iter().map(|&[a, b, c]| [a, c, b]);
    let faces = mesh.faces().iter().copied().chain(over).collect();
    let kinds = mesh.face_materials().repeat(2);
    let mesh = Mesh::new(mesh.origin(), mesh.vertices().to_vec(), faces, kinds, mesh.materials().to_vec());
    let (mut camera, mut beams) = (*scene.camera(), scene.beams().to_vec());
    camera.sensor = coarse_camera(camera.sensor);
    for Mounted { sensor: beam, .. } in &mut beams {
        (beam.columns, beam.rows) = (beam.columns.min(SAMPLE_COLUMNS), beam.rows.min(SAMPLE_ROWS));
    }
    Scene::new(Arc::new(mesh.ok()?), camera, beams, scene.atmosphere(), scene.flux_model()).ok()
}

/// A camera with fewer, larger pixels over the same image.
fn coarse_camera(camera: Camera) -> Camera {
    let [width, height] = [camera.width, camera.height].map(|side| side.min(SAMPLE_PIXELS));
    let ratios = [f64::from(camera.width) / f64::from(width), f64::from(camera.height) / f64::from(height)];
    let axis =
        |axis: usize| (camera.pixel_pitch[axis] * ratios[axis], camera.principal_point[axis] / ratios[axis]);
    let [(pitch_x, centre_x), (pitch_y, centre_y)] = [axis(0), axis(1)];
    Camera { width, height, pixel_pitch: [pitch_x, pitch_y], principal_point: [centre_x, centre_y], ..camera }
}
