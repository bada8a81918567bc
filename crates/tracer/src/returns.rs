//! What comes back of a beam's pencils, each followed by itself: ground, line of sight, flux. (Paper, §5 and §6)

use rayon::prelude::*;
use raypencil_scene::{FaceId, Image, Mesh, Return, Returns, Scene};

use crate::flux::{Light, Path};
use crate::hierarchy::Hierarchy;
use crate::nearest::Found;
use crate::occlusion::{Occlusion, Sight};
use crate::rays::{Grid, SensorRays};
use crate::shares::Shares;
use crate::triangle::{Triangle, widen};
use crate::view::Eye;

/// Which face a pencil hits, and at which t: what is kept of a search.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Met {
    pub(crate) face: FaceId,
    pub(crate) t: f64,
}

/// How many pencils are followed before their returns are written. Tuned: enough for any number of threads,
/// and a memory of some megabytes however large the beam.
const BATCH: usize = 1 << 17;

/// All that it takes to follow the pencils of one beam.
struct Follower<'a> {
    mesh: &'a Mesh,
    rays: &'a SensorRays,
    shares: Shares,
    light: Light,
    eye: Eye,
}

/// The returns of a beam and their flux on the camera's image. `met` is what its pencils hit, row by row.
pub(crate) fn of_beam(
    scene: &Scene,
    hierarchy: &Hierarchy,
    rays: &SensorRays,
    grid: Grid,
    met: &[Option<Met>],
) -> (Returns, Image<f64>) {
    let follower = Follower {
        mesh: scene.mesh(),
        rays,
        shares: Shares::new(grid),
        light: Light::new(scene, grid.beam.wavelength),
        eye: Eye::new(scene.camera()),
    };
    let (columns, rows) = rays.size();
    let camera = scene.camera().sensor;
    let mut returns = Returns::empty(columns, rows);
    let mut image = Image::filled(camera.width, camera.height, 0.0);

    let place = |pencil: usize| ((pencil % columns as usize) as u32, (pencil / columns as usize) as u32);
    let mut batch = Vec::new();
    for (start, met) in (0..).step_by(BATCH).zip(met.chunks(BATCH)) {
        // Pencils are independent, so threads cannot change a bit.
        met.par_iter()
            .enumerate()
            .with_min_len(64)
            .map_init(
                || Occlusion::new(hierarchy),
                |occlusion, (index, met)| {
                    let (i, j) = place(start + index);
                    met.map(|met| follower.follow(occlusion, i, j, met))
                },
            )
            .collect_into_vec(&mut batch);
        // One after another, in row-major order: each pixel's sum has one order of additions.
        for (index, back) in batch.iter().enumerate() {
            let Some(back) = back else { continue };
            let (i, j) = place(start + index);
            returns.put(i, j, back);
            if let (true, Some(pixel)) = (back.visible, back.pixel) {
                image.set(pixel.i, pixel.j, image.at(pixel.i, pixel.j) + back.flux);
            }
        }
    }
    (returns, image)
}

impl Follower<'_> {
    /// What comes back of pencil (i, j), which has `met` a face.
    fn follow(&self, occlusion: &mut Occlusion, i: u32, j: u32, met: Met) -> Return {
        let pencil = self.rays.ray(i, j);
        let corners = self.mesh.faces()[met.face.0 as usize].map(|v| self.mesh.vertices()[v as usize]);
        let met = Found { triangle: Triangle::new(corners, met.face), t: met.t };
        let hit = met.hit(&pencil, self.rays.depth_per_t());

        // The camera's side of it. A point in the very projection centre has no angles: it counts as seen at
        // right angles to everything.
        let view = self.eye.view(hit.point);
        let (depth, distance) = (view.in_camera.z, view.distance);
        let (cos_off_axis, cos_view) = if distance == 0.0 {
            (0.0, 0.0)
        } else {
            // cos(theta) = n.(c - P) / (|n| d), and n.(c - P) = n.(c - a): a corner is not rounded, so that a
            // camera in the face's own plane gets its 0 wherever the numbers are dyadic.
            let normal = met.triangle.normal();
            let above = normal.dot(self.eye.centre - widen(met.triangle.vertices[0]));
            (depth / distance, above / normal.length() / distance)
        };

        // Seen: from the front, beyond the image plane and on the image, with nothing in between.
        let focal_length = self.eye.camera.focal_length;
        let lands = view.pixel.filter(|_| cos_view > 0.0);
        let seen = lands.filter(|_| {
            let sight = Sight::new(self.eye.centre, focal_length, hit.point, depth, &pencil, &met);
            !occlusion.hides(&sight)
        });
        let flux = seen.map_or(0.0, |pixel| {
            let material = self.mesh.face_materials()[hit.face.0 as usize];
            self.light.flux(&Path {
                power: self.shares.of(i, j),
                range: hit.range,
                cos_incidence: hit.cos_incidence,
                reflectivity: self.mesh.materials()[usize::from(material)].reflectivity,
                cos_view,
                depth,
                distance,
                point: view.in_camera,
                through_middle: self.eye.through_middle(pixel),
            })
        });
        Return { visible: seen.is_some(), pixel: view.pixel, depth, cos_off_axis, cos_view, flux }
    }
}
