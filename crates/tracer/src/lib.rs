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
//! ```

mod grouped;
mod hierarchy;
mod nearest;
mod rays;
mod triangle;

use std::sync::{Arc, Mutex, PoisonError};
use std::time::Instant;

use rayon::prelude::*;
use raypencil_scene::{
    Frame, Mesh, Quantities, Renderer, Request, Resolution, Scene, SensorId, SensorMap, Stage,
};

use hierarchy::Hierarchy;
use rays::SensorRays;

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
        let hierarchy = Arc::new(Hierarchy::build(mesh, reach));
        *kept = Some(Kept { mesh: Arc::clone(mesh), hierarchy: Arc::clone(&hierarchy) });
        hierarchy
    }
}

impl Renderer for Tracer {
    fn name(&self) -> &str {
        "tracer"
    }

    fn resolution(&self) -> Resolution {
        Resolution::F64
    }

    fn render(&self, scene: &Scene, request: &Request) -> Frame {
        let start = Instant::now();
        let reach = scene.sensors().filter_map(|sensor| scene.max_range(sensor)).fold(0.0, f64::max);
        let hierarchy = self.hierarchy(scene.mesh(), reach);
        let mut stages = vec![Stage { name: "hierarchy".into(), time: start.elapsed() }];

        let mut timed = |sensor, rays: &SensorRays| {
            let start = Instant::now();
            let map = trace_sensor(&hierarchy, sensor, rays, request.quantities);
            stages.push(Stage { name: sensor.to_string(), time: start.elapsed() });
            map
        };
        let camera = request.camera.then(|| timed(SensorId::Camera, &SensorRays::of_camera(scene.camera())));
        let beams = if request.beams { scene.beams() } else { &[] };
        let beams = beams
            .iter()
            .enumerate()
            .map(|(index, beam)| timed(SensorId::Beam(index), &SensorRays::of_beam(beam)))
            .collect();
        Frame { camera, beams, returns: Vec::new(), flux: Vec::new(), stages }
    }
}

/// Traces every cell of a sensor. Rows are independent, so threads cannot change a bit.
fn trace_sensor(
    hierarchy: &Hierarchy,
    sensor: SensorId,
    rays: &SensorRays,
    quantities: Quantities,
) -> SensorMap {
    let (width, height) = rays.size();
    let mut map = SensorMap::empty(sensor, width, height, quantities);
    map.rows_mut().into_par_iter().for_each(|mut row| {
        let mut search = nearest::Search::new(hierarchy);
        for i in 0..width {
            let ray = rays.ray(i, row.j);
            if let Some(found) = search.nearest(&ray, rays.max_range()) {
                row.put(i, &found.hit(&ray, rays.depth_per_t()));
            }
        }
    });
    map
}
