//! The renderer: the maps of all sensors, then the returns of the beams.

use std::sync::{Arc, Mutex, PoisonError};
use std::time::Instant;

use glam::DVec3;
use rayon::prelude::*;
use raypencil_scene::{
    FaceId, Mesh, Precision, Quantities, RenderOutput, Renderer, Request, Scene, SensorId, SensorMap,
    SensorRow, Stage,
};

use crate::closest_hit::ClosestHitTraverser;
use crate::hierarchy::{self, Hierarchy};
use crate::lanes::{self, Instructions, Work};
use crate::rays::{PencilGrid, SensorRays};
use crate::returns::{self, PencilHit};
use crate::tile::{BLOCK, BLOCKS, Nearest, Tile};
use crate::triangle::Triangle;

/// Factor by which a new hierarchy's maximum trace distance exceeds the one asked for.
const DISTANCE_HEADROOM: f64 = 1.0 + 1.0 / 64.0;

/// The ray tracer.
///
/// It caches the hierarchy of the last terrain that it rendered: the frames of a drive share one build.
/// Its [name](Renderer::name) is `tracer`.
///
/// # Maps of a beam
///
/// ```
/// # mod doc { include!(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/doc/scene.rs")); }
/// # use doc::scene_above;
/// use raypencil_scene::{Renderer, Request};
/// use raypencil_tracer::Tracer;
///
/// // Camera and beam are 10 m above the triangle and look straight down.
/// let scene = scene_above([[-40.0, -40.0, 0.0], [40.0, -40.0, 0.0], [0.0, 40.0, 0.0]]);
/// let frame = Tracer::new().render(&scene, &Request::MAPS);
/// let range = frame.beams[0].range.as_ref().expect("asked for");
/// assert_eq!(range.at(0, 0).get(), Some(10.0));
/// ```
///
/// # Light
///
/// ```
/// # mod doc { include!(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/doc/scene.rs")); }
/// # use doc::scene_above;
/// use raypencil_scene::{Renderer, Request};
/// use raypencil_tracer::Tracer;
///
/// let scene = scene_above([[-40.0, -40.0, 0.0], [40.0, -40.0, 0.0], [0.0, 40.0, 0.0]]);
/// let frame = Tracer::new().render(&scene, &Request::FLUX);
/// // One pencil of P = 4 W on ground of r_d = 1/4, seen at right angles from r = 10 m through an aperture of D = 2 mm:
/// // P r_d (D^2 / 4) / r^2 = 4 * 0.25 * 1e-6 / 100 = 1e-8 W. It arrives in the middle one of three pixels.
/// let flux = &frame.flux[0];
/// assert!((flux.at(1, 0) / 1e-8 - 1.0).abs() < 1e-14);
/// assert_eq!((flux.at(0, 0), flux.at(2, 0)), (0.0, 0.0));
/// ```
#[derive(Debug, Default)]
pub struct Tracer {
    cached: Mutex<Option<CachedHierarchy>>,
    instructions: Instructions,
}

#[derive(Debug)]
struct CachedHierarchy {
    mesh: Arc<Mesh>,
    hierarchy: Arc<Hierarchy>,
}

impl Tracer {
    /// A tracer with an empty cache.
    ///
    /// ```
    /// # mod doc { include!(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/doc/scene.rs")); }
    /// # use doc::scene_above;
    /// use raypencil_scene::{Renderer, Request};
    /// use raypencil_tracer::Tracer;
    ///
    /// let tracer = Tracer::new();
    /// let scene = scene_above([[-40.0, -40.0, 0.0], [40.0, -40.0, 0.0], [0.0, 40.0, 0.0]]);
    /// // The second frame takes the hierarchy from the cache. It has the same bits.
    /// let [first, second] = [(); 2].map(|()| tracer.render(&scene, &Request::EVERYTHING));
    /// assert_eq!((first.camera, first.returns), (second.camera, second.returns));
    /// ```
    pub fn new() -> Self {
        Self::default()
    }

    /// A tracer that uses these instructions of the processor. They change the speed, and no bit of a frame.
    ///
    /// ```
    /// # mod doc { include!(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/doc/scene.rs")); }
    /// # use doc::scene_above;
    /// use raypencil_scene::{Renderer, Request};
    /// use raypencil_tracer::{Instructions, Tracer};
    ///
    /// let scene = scene_above([[-40.0, -40.0, 0.0], [40.0, -40.0, 0.0], [0.0, 40.0, 0.0]]);
    /// let [wide, plain] = [Instructions::Detected, Instructions::Baseline]
    ///     .map(|instructions| Tracer::with_instructions(instructions).render(&scene, &Request::EVERYTHING));
    /// assert_eq!((wide.camera, wide.returns), (plain.camera, plain.returns));
    /// ```
    pub fn with_instructions(instructions: Instructions) -> Self {
        Self { instructions, ..Self::default() }
    }

    /// A hierarchy of `mesh` for rays of up to `max_trace_distance` metres: the cached one if it serves, else a
    /// new one.
    fn hierarchy(&self, mesh: &Arc<Mesh>, max_trace_distance: f64) -> Arc<Hierarchy> {
        // A poisoned lock still holds a complete hierarchy: it is stored in one assignment.
        let mut cached = self.cached.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(CachedHierarchy { mesh: cached_mesh, hierarchy }) = cached.as_ref()
            && Arc::ptr_eq(cached_mesh, mesh)
            && hierarchy.max_trace_distance() >= max_trace_distance
        {
            return Arc::clone(hierarchy);
        }
        // With headroom: on a drive the distances between the sensors differ by rounding from frame to frame.
        let hierarchy = Arc::new(Hierarchy::build(mesh, DISTANCE_HEADROOM * max_trace_distance));
        *cached = Some(CachedHierarchy { mesh: Arc::clone(mesh), hierarchy: Arc::clone(&hierarchy) });
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
        let mesh = scene.mesh();
        let hierarchy = self.hierarchy(mesh, hierarchy::max_trace_distance(scene));
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
            let (map, _) = trace_sensor(
                mesh,
                &hierarchy,
                SensorId::Camera,
                &rays,
                request.quantities,
                false,
                self.instructions,
            );
            frame.camera = Some(map);
            frame.stages.push(Stage { name: SensorId::Camera.to_string(), time: start.elapsed() });
        }
        let beams = if request.beams || request.returns { scene.beams() } else { &[] };
        for (index, beam) in beams.iter().enumerate() {
            // The pencils' hits, for the maps and for the returns.
            let start = Instant::now();
            let sensor = SensorId::Beam(index);
            let grid = PencilGrid::new(beam.sensor, index, request.sampling);
            let rays = SensorRays::of_beam(beam, grid);
            let quantities = if request.beams { request.quantities } else { Quantities::NONE };
            let (map, hits) =
                trace_sensor(mesh, &hierarchy, sensor, &rays, quantities, request.returns, self.instructions);
            frame.stages.push(Stage { name: sensor.to_string(), time: start.elapsed() });
            if request.beams {
                frame.beams.push(map);
            }
            if request.returns {
                let start = Instant::now();
                let (returns, flux) =
                    returns::trace_returns(scene, &hierarchy, &rays, grid, &hits, self.instructions);
                frame.returns.push(returns);
                frame.flux.push(flux);
                frame.stages.push(Stage { name: format!("{sensor} returns"), time: start.elapsed() });
            }
        }
        frame
    }
}

/// Traces every cell of a sensor into its maps. With `collect_hits` it also returns the hit of every cell, row by
/// row; otherwise that list is empty.
///
/// Tiles of cells are independent: the number of threads changes no bit.
fn trace_sensor(
    mesh: &Mesh,
    hierarchy: &Hierarchy,
    sensor: SensorId,
    rays: &SensorRays,
    quantities: Quantities,
    collect_hits: bool,
    instructions: Instructions,
) -> (SensorMap, Vec<Option<PencilHit>>) {
    let (width, height) = rays.size();
    let mut map = SensorMap::unwritten(sensor, width, height, quantities);
    let mut hits = vec![None; if collect_hits { map.cell_count() } else { 0 }];
    let mut hit_rows = hits.chunks_exact_mut(width as usize);
    let mut rows: Vec<_> = map.rows_mut().into_iter().map(|row| (row, hit_rows.next())).collect();
    let rows_per_band = rays.tile_size().map_or(1, |[_, rows]| rows) as usize;
    rows.par_chunks_mut(rows_per_band).for_each_init(
        || ClosestHitTraverser::new(hierarchy),
        |traverser, rows| lanes::run(instructions, Band { mesh, rays, traverser, rows }),
    );
    drop(rows);
    (map, hits)
}

/// Some neighbouring rows of a sensor.
struct Band<'a, 'r, 'm, 'h> {
    mesh: &'a Mesh,
    rays: &'a SensorRays,
    traverser: &'r mut ClosestHitTraverser<'h>,
    /// Each with the hits of its cells, if they are collected.
    rows: &'r mut [(SensorRow<'m>, Option<&'m mut [Option<PencilHit>]>)],
}

impl Work for Band<'_, '_, '_, '_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { mesh, rays, traverser, rows } = self;
        let (width, _) = rays.size();
        let first_row = rows[0].0.j;
        let Some([columns, _]) = rays.tile_size() else {
            for (row, hits) in rows {
                for i in 0..width {
                    let ray = rays.ray(i, row.j);
                    if let Some(intersection) = traverser.closest_hit(&ray, rays.max_range()) {
                        row.put(i, &intersection.hit(&ray, rays.depth_per_t()));
                        if let Some(hits) = hits {
                            hits[i as usize] =
                                Some(PencilHit { face: intersection.triangle.face, t: intersection.t });
                        }
                    } else {
                        row.put_miss(i);
                    }
                }
            }
            return;
        };
        let (mut tile, mut nearest) = (Tile::EMPTY, [Nearest::NOTHING; BLOCKS]);
        // The face of the cell before, and its normal: neighbours often share it.
        let mut last: Option<(FaceId, DVec3)> = None;
        for i in (0..width).step_by(columns as usize) {
            let active = rays.fill(&mut tile, i, first_row);
            traverser.closest_hits(&mut tile, active, rays.max_range(), &mut nearest);
            for (row, hits) in rows.iter_mut() {
                for column in i..(i + columns).min(width) {
                    let lane = ((row.j - first_row) * columns + (column - i)) as usize;
                    let (of_block, k) = (&nearest[lane / BLOCK], lane % BLOCK);
                    let Ok(face) = u32::try_from(of_block.face[k]) else {
                        row.put_miss(column);
                        continue;
                    };
                    let (face, t) = (FaceId(face), of_block.t[k]);
                    let (direction, metres_per_t) = (tile.q(lane), tile.blocks[lane / BLOCK].metres_per_t[k]);
                    let (range, depth) = (t * metres_per_t, t * rays.depth_per_t());
                    row.put_place(column, face, range, depth, tile.origin + direction * t);
                    if row.wants_the_plane() {
                        let normal = match last {
                            Some((last, normal)) if last == face => normal,
                            _ => Triangle::of(mesh, face).normal().normalize(),
                        };
                        last = Some((face, normal));
                        row.put_plane(column, normal, -normal.dot(direction) / metres_per_t);
                    }
                    if let Some(hits) = hits {
                        hits[column as usize] = Some(PencilHit { face, t });
                    }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use raypencil_terrain::RandomGround;

    use super::*;

    #[test]
    fn a_cached_hierarchy_serves_the_same_mesh_only() {
        let mesh = Arc::new(RandomGround::plain(1, 200, 10.0).build().into_mesh().unwrap());
        let tracer = Tracer::new();
        let first = tracer.hierarchy(&mesh, 10.0);
        // The headroom is 1/64: 10 m * 65 / 64, exactly.
        assert_eq!(first.max_trace_distance(), 10.15625);
        assert!(Arc::ptr_eq(&first, &tracer.hierarchy(&mesh, 5.0)), "a shorter distance needs no new boxes");
        assert!(!Arc::ptr_eq(&first, &tracer.hierarchy(&mesh, 20.0)), "a longer distance needs wider boxes");
        let other = Arc::new(Mesh::clone(&mesh));
        assert!(!Arc::ptr_eq(&first, &tracer.hierarchy(&other, 5.0)));
    }
}
