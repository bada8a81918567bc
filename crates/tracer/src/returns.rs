//! The returns of a beam's pencils, one pencil at a time: ground, line of sight, flux. (Paper, §3, steps 2 to 5; §5
//! and §6)

use rayon::prelude::*;
use raypencil_scene::{FaceId, Image, Mesh, Return, Returns, Scene};

use crate::camera::PosedCamera;
use crate::closest_hit::Intersection;
use crate::flux::{FluxEquation, LightPath};
use crate::hierarchy::Hierarchy;
use crate::occlusion::{LineOfSight, OcclusionTraverser};
use crate::rays::{PencilGrid, SensorRays};
use crate::shares::PowerShares;
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

    let cell = |pencil: usize| ((pencil % columns as usize) as u32, (pencil / columns as usize) as u32);
    let mut batch = Vec::new();
    for (start, hits) in (0..).step_by(PENCILS_PER_BATCH).zip(hits.chunks(PENCILS_PER_BATCH)) {
        // Pencils are independent: the number of threads changes no bit.
        hits.par_iter()
            .enumerate()
            .with_min_len(64)
            .map_init(
                || OcclusionTraverser::new(hierarchy),
                |traverser, (index, hit)| {
                    let (i, j) = cell(start + index);
                    hit.map(|hit| tracer.trace_return(traverser, i, j, hit))
                },
            )
            .collect_into_vec(&mut batch);
        // Row by row on one thread: the additions of each pixel's sum have one order.
        for (index, pencil_return) in batch.iter().enumerate() {
            let Some(pencil_return) = pencil_return else { continue };
            let (i, j) = cell(start + index);
            returns.put(i, j, pencil_return);
            if let (true, Some(pixel)) = (pencil_return.visible, pencil_return.pixel) {
                image.set(pixel.i, pixel.j, image.at(pixel.i, pixel.j) + pencil_return.flux);
            }
        }
    }
    (returns, image)
}

impl BeamTracer<'_> {
    /// The return of pencil (i, j), which has the given hit.
    fn trace_return(&self, traverser: &mut OcclusionTraverser, i: u32, j: u32, hit: PencilHit) -> Return {
        let pencil = self.rays.ray(i, j);
        let vertices = self.mesh.faces()[hit.face.0 as usize].map(|v| self.mesh.vertices()[v as usize]);
        let intersection = Intersection { triangle: Triangle::new(vertices, hit.face), t: hit.t };
        let hit = intersection.hit(&pencil, self.rays.depth_per_t());

        // The camera's angles. A point exactly in the projection centre has none; both cosines are 0 there.
        let observed = self.camera.observe(hit.point);
        let (depth, distance) = (observed.in_camera.z, observed.distance);
        let (cos_phi, cos_theta) = if distance == 0.0 {
            (0.0, 0.0)
        } else {
            // cos(theta) = n.(c - P) / (|n| d), and n.(c - P) = n.(c - a). The vertex a is not rounded, so a camera
            // in the face's own plane gets exactly 0 wherever the numbers are dyadic.
            let normal = intersection.triangle.normal();
            let n_dot_offset = normal.dot(self.camera.centre - widen(intersection.triangle.vertices[0]));
            (depth / distance, n_dot_offset / normal.length() / distance)
        };

        // Visible: from the front, beyond the image plane and on the image, with nothing in between. (Contract)
        let focal_length = self.camera.intrinsics.focal_length;
        let front_pixel = observed.pixel.filter(|_| cos_theta > 0.0);
        let visible_pixel = front_pixel.filter(|_| {
            let centre = self.camera.centre;
            let line_of_sight =
                LineOfSight::new(centre, focal_length, hit.point, depth, &pencil, &intersection);
            !traverser.is_occluded(&line_of_sight)
        });
        let flux = visible_pixel.map_or(0.0, |pixel| {
            let material = self.mesh.face_materials()[hit.face.0 as usize];
            self.flux_equation.flux(&LightPath {
                power: self.shares.power(i, j),
                range: hit.range,
                cos_psi: hit.cos_incidence,
                reflectivity: self.mesh.materials()[usize::from(material)].reflectivity,
                cos_theta,
                depth,
                distance,
                point: observed.in_camera,
                pixel_ray: self.camera.pixel_ray(pixel),
            })
        });
        Return {
            visible: visible_pixel.is_some(),
            pixel: observed.pixel,
            depth,
            cos_off_axis: cos_phi,
            cos_view: cos_theta,
            flux,
        }
    }
}
