//! The returns of a beam's pencils, one pencil at a time: ground, line of sight, flux. (Paper, §3, steps 2 to 5; §5
//! and §6)

use rayon::prelude::*;
use raypencil_scene::{FaceId, Hit, Image, Mesh, Return, Returns, Scene};

use crate::camera::{CameraPoint, PosedCamera};
use crate::closest_hit::Intersection;
use crate::flux::{FluxEquation, LightPath};
use crate::hierarchy::Hierarchy;
use crate::lanes::{self, Instructions, Work};
use crate::occlusion::{LineOfSight, OcclusionTraverser};
use crate::rays::{PencilGrid, SensorRays};
use crate::shares::PowerShares;
use crate::tile::TILE;
use crate::triangle::{Triangle, widen};

/// The face that a pencil hits, and the t of the hit.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PencilHit {
    pub(crate) face: FaceId,
    pub(crate) t: f64,
}

/// Number of pencils that are traced before their returns are written. Tuned: enough for any number of threads, and
/// a memory of some megabytes however large the beam.
const PENCILS_PER_BATCH: usize = 1 << 17;

/// Everything that the returns of one beam depend on.
struct BeamTracer<'a> {
    mesh: &'a Mesh,
    rays: &'a SensorRays,
    shares: PowerShares,
    flux_equation: FluxEquation,
    camera: PosedCamera,
}

/// The returns of a beam, and their flux on the camera's image. `hits` holds the hits of its pencils, row by row.
pub(crate) fn trace_returns(
    scene: &Scene,
    hierarchy: &Hierarchy,
    rays: &SensorRays,
    grid: PencilGrid,
    hits: &[Option<PencilHit>],
    instructions: Instructions,
) -> (Returns, Image<f64>) {
    let tracer = BeamTracer {
        mesh: scene.mesh(),
        rays,
        shares: PowerShares::new(grid),
        flux_equation: FluxEquation::new(scene, grid.beam.wavelength),
        camera: PosedCamera::new(scene.camera()),
    };
    let (columns, rows) = rays.size();
    let camera = scene.camera().sensor;
    let mut returns = Returns::empty(columns, rows);
    let mut image = Image::filled(camera.width, camera.height, 0.0);

    let rows_per_batch = (PENCILS_PER_BATCH / columns as usize).max(1);
    let mut batch = vec![None; rows_per_batch.min(rows as usize) * columns as usize];
    for (first_row, hits) in (0..).step_by(rows_per_batch).zip(hits.chunks(rows_per_batch * columns as usize))
    {
        let batch = &mut batch[..hits.len()];
        // Pencils are independent: the number of threads changes no bit.
        let rows = batch.par_chunks_mut(columns as usize).zip(hits.par_chunks(columns as usize));
        rows.enumerate().for_each(|(row, (returns, hits))| {
            let tiles = returns.par_chunks_mut(TILE).zip(hits.par_chunks(TILE));
            tiles.enumerate().for_each_init(
                || OcclusionTraverser::new(hierarchy),
                |traverser, (tile, (returns, hits))| {
                    let first = ((tile * TILE) as u32, (first_row + row) as u32);
                    lanes::run(
                        instructions,
                        TileOfPencils { tracer: &tracer, traverser, first, hits, returns },
                    );
                },
            );
        });
        // Row by row on one thread: the additions of each pixel's sum have one order.
        for (index, pencil_return) in batch.iter().enumerate() {
            let Some(pencil_return) = pencil_return else { continue };
            let (i, j) = ((index % columns as usize) as u32, (first_row + index / columns as usize) as u32);
            returns.put(i, j, pencil_return);
            if let (true, Some(pixel)) = (pencil_return.visible, pencil_return.pixel) {
                image.set(pixel.i, pixel.j, image.at(pixel.i, pixel.j) + pencil_return.flux);
            }
        }
    }
    (returns, image)
}

/// Neighbouring pencils of a row, whose lines of sight run close to one another.
struct TileOfPencils<'a, 't, 'h> {
    tracer: &'a BeamTracer<'a>,
    traverser: &'t mut OcclusionTraverser<'h>,
    /// Column and row of the first pencil.
    first: (u32, u32),
    hits: &'a [Option<PencilHit>],
    returns: &'t mut [Option<Return>],
}

impl Work for TileOfPencils<'_, '_, '_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { tracer, traverser, first: (i, j), hits, returns } = self;
        let mut views = [const { None }; TILE];
        let mut lines = [const { None }; TILE];
        for (lane, hit) in hits.iter().enumerate() {
            if let Some(hit) = hit {
                let (view, line_of_sight) = tracer.view(i + lane as u32, j, *hit);
                views[lane] = Some(view);
                lines[lane] = line_of_sight;
            }
        }
        let occluded = traverser.occluded(&lines);
        for (lane, pencil_return) in returns.iter_mut().enumerate() {
            *pencil_return = views[lane].as_ref().map(|view| {
                let visible = lines[lane].is_some() && occluded & (1 << lane) == 0;
                tracer.pencil_return(i + lane as u32, j, view, visible)
            });
        }
    }
}

/// A pencil's hit as the camera sees it, if nothing is in between.
struct View {
    hit: Hit,
    observed: CameraPoint,
    /// cos(phi)
    cos_off_axis: f64,
    /// cos(theta)
    cos_view: f64,
}

impl BeamTracer<'_> {
    /// The view of pencil (i, j), which has the given hit; and the line of sight to it, if the camera sees the front of the
    /// face and the point is on its image.
    #[inline(always)]
    fn view(&self, i: u32, j: u32, hit: PencilHit) -> (View, Option<LineOfSight>) {
        let pencil = self.rays.ray(i, j);
        let vertices = self.mesh.faces()[hit.face.0 as usize].map(|v| self.mesh.vertices()[v as usize]);
        let intersection = Intersection { triangle: Triangle::new(vertices, hit.face), t: hit.t };
        let hit = intersection.hit(&pencil, self.rays.depth_per_t());

        // The camera's angles. A point exactly in the projection centre has none; both cosines are 0 there.
        let observed = self.camera.observe(hit.point);
        let (depth, distance) = (observed.in_camera.z, observed.distance);
        let (cos_off_axis, cos_view) = if distance == 0.0 {
            (0.0, 0.0)
        } else {
            // cos(theta) = n.(c - P) / (|n| d), and n.(c - P) = n.(c - a). The vertex a is not rounded, so a camera
            // in the face's own plane gets exactly 0 wherever the numbers are dyadic.
            let normal = intersection.triangle.normal();
            let n_dot_offset = normal.dot(self.camera.centre - widen(intersection.triangle.vertices[0]));
            (depth / distance, n_dot_offset / normal.length() / distance)
        };

        // From the front, beyond the image plane and on the image. (Contract: visible)
        let line_of_sight = (cos_view > 0.0 && observed.pixel.is_some()).then(|| {
            let focal_length = self.camera.intrinsics.focal_length;
            LineOfSight::new(self.camera.centre, focal_length, hit.point, depth, pencil, intersection)
        });
        (View { hit, observed, cos_off_axis, cos_view }, line_of_sight)
    }

    /// The return of pencil (i, j).
    #[inline(always)]
    fn pencil_return(&self, i: u32, j: u32, view: &View, visible: bool) -> Return {
        let View { hit, observed, cos_off_axis, cos_view } = *view;
        let depth = observed.in_camera.z;
        let flux = observed.pixel.filter(|_| visible).map_or(0.0, |pixel| {
            let material = self.mesh.face_materials()[hit.face.0 as usize];
            self.flux_equation.flux(&LightPath {
                power: self.shares.power(i, j),
                range: hit.range,
                cos_psi: hit.cos_incidence,
                reflectivity: self.mesh.materials()[usize::from(material)].reflectivity,
                cos_theta: cos_view,
                depth,
                distance: observed.distance,
                point: observed.in_camera,
                pixel_ray: self.camera.pixel_ray(pixel),
            })
        });
        Return { visible, pixel: observed.pixel, depth, cos_off_axis, cos_view, flux }
    }
}
