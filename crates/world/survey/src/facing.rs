//! Fronts and backs: which side of the terrain the rays of a sensor meet first.
//!
//! A renderer sees fronts only. So the terrain is rendered twice: as it is, and with every face turned over. Along a ray
//! the nearer of the two hits is a front in the first case, a back in the second.
//!
//! The scanline renderer is used, since it looks at each face once. A hierarchy over half a million faces takes longer to
//! build than all other checks together.

use std::sync::Arc;

use raypencil_scanline::Scanline;
use raypencil_scene::{Camera, Mounted, Quantities, Renderer, Request, Scene, SensorId, SensorMap};

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

/// Looks along a sample of the rays of each sensor: a coarser raster over the same field of view.
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
    BothSides::default().facings(scene)
}

/// A renderer of both sides of a terrain, with what it keeps of it.
#[derive(Debug, Default)]
pub(crate) struct BothSides {
    renderer: Scanline,
}

impl BothSides {
    /// What the rays of each sensor meet first.
    pub(crate) fn facings(&self, scene: &Scene) -> Vec<Facing> {
        let mut beams = scene.beams().to_vec();
        for Mounted { sensor: beam, .. } in &mut beams {
            (beam.columns, beam.rows) = (beam.columns.min(SAMPLE_COLUMNS), beam.rows.min(SAMPLE_ROWS));
        }
        let with = |sensor: Camera| {
            let camera = Mounted { sensor, ..*scene.camera() };
            let mesh = Arc::clone(scene.mesh());
            Scene::new(mesh, camera, beams.clone(), scene.atmosphere(), scene.flux_model())
        };
        let own = scene.camera().sensor;
        // Pixels that are large already cannot be larger: then all of them are looked at.
        let sample = with(coarse_camera(own)).or_else(|_| with(own)).expect("the sensors of a scene");
        let ranges = Request { quantities: Quantities { range: true, ..Quantities::NONE }, ..Request::MAPS };
        let fronts = self.renderer.render(&sample, &ranges);
        let backs = self.renderer.ranges_of_backs(&sample);
        fronts.maps().zip(&backs).map(|(fronts, backs)| facing(fronts, backs)).collect()
    }
}

/// What the rays of a sensor meet first, by the ranges of the terrain and of the same terrain turned over.
fn facing(fronts: &SensorMap, backs: &SensorMap) -> Facing {
    let mut found = Facing { sensor: fronts.sensor, rays: fronts.cell_count() as u64, fronts: 0, backs: 0 };
    for pair in ranges(fronts).zip(ranges(backs)) {
        match pair {
            (None, None) => {}
            (Some(front), Some(back)) if back < front => found.backs += 1,
            (None, Some(_)) => found.backs += 1,
            (Some(_), _) => found.fronts += 1,
        }
    }
    found
}

/// The ranges of a map, cell by cell.
fn ranges(map: &SensorMap) -> impl Iterator<Item = Option<f64>> {
    map.range.iter().flat_map(|ranges| ranges.cells()).map(|range| range.get())
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
