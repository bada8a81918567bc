//! The second renderer: one ray per pencil or pixel, backward, through a bounding volume hierarchy.
//!
//! `obvhs` proposes which faces a ray may meet; a watertight triangle test of our own in `f64` decides.
//! The tree is `f32`, so its boxes are widened by a bound derived in `hierarchy`, and no hit is lost to
//! them: a test compares every answer with an exhaustive search. What the two searches share is the
//! triangle test, in `triangle`.
//!
//! ```text
//! rays       the contract's rays, formed in the scene frame
//! hierarchy  padded boxes -> obvhs Bvh2
//! grouped    the tree's building, in bounded time for any input
//! triangle   is this face met, and where
//! nearest    the search: smallest t, lowest face on ties
//! occlusion  does anything stand between a point and the camera
//! view       where a point stands for the camera, and on its image
//! shares     the power of each pencil
//! flux       what of it arrives in the pixel
//! returns    all pencils of a beam: the four above, one pencil after another
//! ```

mod flux;
mod grouped;
mod hierarchy;
mod nearest;
mod occlusion;
mod rays;
mod returns;
mod shares;
mod triangle;
mod view;

use std::sync::{Arc, Mutex, PoisonError};
use std::time::Instant;

use rayon::prelude::*;
use raypencil_scene::{
    Mesh, Precision, Quantities, RenderOutput, Renderer, Request, Scene, SensorId, SensorMap, Stage,
};

use hierarchy::Hierarchy;
use rays::{Grid, SensorRays};
use returns::Met;

/// How much farther than asked a hierarchy is built for.
const SPARE: f64 = 1.0 + 1.0 / 64.0;

/// The ray tracer. It keeps the hierarchy of the last terrain it saw, so that the frames of a drive build
/// it once.
#[derive(Debug, Default)]
pub struct Tracer {
    kept: Mutex<Option<Kept>>,
}

#[derive(Debug)]
struct Kept {
    mesh: Arc<Mesh>,
    hierarchy: Arc<Hierarchy>,
}

impl Tracer {
    /// A tracer that has seen no terrain yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// The hierarchy for a mesh whose hits lie within `reach` metres of their sensor, built if the one
    /// kept does not serve.
    fn hierarchy(&self, mesh: &Arc<Mesh>, reach: f64) -> Arc<Hierarchy> {
        // A panic elsewhere cannot leave half a hierarchy here: it is stored whole.
        let mut kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(Kept { mesh: of, hierarchy }) = kept.as_ref()
            && Arc::ptr_eq(of, mesh)
            && hierarchy.reach() >= reach
        {
            return Arc::clone(hierarchy);
        }
        // A little wider than asked: on a drive the sensors' distances differ by rounding from frame to frame.
        let hierarchy = Arc::new(Hierarchy::build(mesh, SPARE * reach));
        *kept = Some(Kept { mesh: Arc::clone(mesh), hierarchy: Arc::clone(&hierarchy) });
        hierarchy
    }
}

impl Renderer for Tracer {
    fn name(&self) -> &str {
        "tracer"
    }

    fn precision(&self) -> Precision {
        Precision::F64
    }

    fn render(&self, scene: &Scene, request: &Request) -> RenderOutput {
        let start = Instant::now();
        let hierarchy = self.hierarchy(scene.mesh(), hierarchy::reach_of(scene));
        let mut frame = RenderOutput {
            camera: None,
            beams: Vec::new(),
            returns: Vec::new(),
            flux: Vec::new(),
            stages: vec![Stage { name: "hierarchy".into(), time: start.elapsed() }],
        };

        if request.camera {
            let start = Instant::now();
            let rays = SensorRays::of_camera(scene.camera());
            let (map, _) = trace_sensor(&hierarchy, SensorId::Camera, &rays, request.quantities, false);
            frame.camera = Some(map);
            frame.stages.push(Stage { name: SensorId::Camera.to_string(), time: start.elapsed() });
        }
        let beams = if request.beams || request.returns { scene.beams() } else { &[] };
        for (index, beam) in beams.iter().enumerate() {
            // What the pencils hit, for the maps and for the returns.
            let start = Instant::now();
            let sensor = SensorId::Beam(index);
            let grid = Grid::new(beam.sensor, index, request.sampling);
            let rays = SensorRays::of_beam(beam, grid);
            let quantities = if request.beams { request.quantities } else { Quantities::NONE };
            let (map, met) = trace_sensor(&hierarchy, sensor, &rays, quantities, request.returns);
            frame.stages.push(Stage { name: sensor.to_string(), time: start.elapsed() });
            if request.beams {
                frame.beams.push(map);
            }
            if request.returns {
                let start = Instant::now();
                let (returns, flux) = returns::of_beam(scene, &hierarchy, &rays, grid, &met);
                frame.returns.push(returns);
                frame.flux.push(flux);
                frame.stages.push(Stage { name: format!("{sensor} returns"), time: start.elapsed() });
            }
        }
        frame
    }
}

/// Traces every cell of a sensor, into its maps and, if they are to be `kept`, a list of the faces met, row by
/// row. Rows are independent, so threads cannot change a bit.
fn trace_sensor(
    hierarchy: &Hierarchy,
    sensor: SensorId,
    rays: &SensorRays,
    quantities: Quantities,
    kept: bool,
) -> (SensorMap, Vec<Option<Met>>) {
    let (width, height) = rays.size();
    let mut map = SensorMap::empty(sensor, width, height, quantities);
    let mut met = vec![None; if kept { map.cell_count() } else { 0 }];
    let mut rows_met = met.chunks_exact_mut(width as usize);
    let rows: Vec<_> = map.rows_mut().into_iter().map(|row| (row, rows_met.next())).collect();
    rows.into_par_iter().for_each(|(mut row, mut met)| {
        let mut search = nearest::Search::new(hierarchy);
        for i in 0..width {
            let ray = rays.ray(i, row.j);
            if let Some(found) = search.nearest(&ray, rays.max_range()) {
                row.put(i, &found.hit(&ray, rays.depth_per_t()));
                if let Some(met) = &mut met {
                    met[i as usize] = Some(Met { face: found.triangle.face, t: found.t });
                }
            }
        }
    });
    (map, met)
}
