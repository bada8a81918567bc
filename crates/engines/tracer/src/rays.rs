//! The contract's rays, formed in the scene frame for tracing. (Contract: camera and beam rays)

use glam::DVec3;
use raypencil_scene::{Beam, Camera, Mounted, Pose, Sampling};

use crate::tile::{BLOCK, BLOCKS, TILE, Tile};
use crate::traced_ray::TracedRay;

/// A beam's grid: the points in which the rays of its pencils cross the grid plane.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PencilGrid {
    pub(crate) beam: Beam,
    /// Index of the beam in the scene. Jittered rays are drawn by it.
    index: usize,
    sampling: Sampling,
}

impl PencilGrid {
    pub(crate) fn new(beam: Beam, index: usize, sampling: Sampling) -> Self {
        Self { beam, index, sampling }
    }

    /// x and y at which the ray of pencil (i, j) crosses the grid plane, beam frame, metres. This is the centre of
    /// its cell, or the point drawn in the cell. Offsets are multiples of 2^-33, so i + dx is exact for every i.
    pub(crate) fn crossing(&self, i: u32, j: u32) -> (f64, f64) {
        let Beam { thickness, rows, .. } = self.beam;
        let rows = f64::from(rows);
        let [dx, dy] = self.sampling.offset(self.index, i, j);
        let x = self.across(f64::from(i) + dx);
        let y = (2.0 * (f64::from(j) + dy) + 1.0 - rows) * thickness / (2.0 * rows);
        (x, y)
    }

    /// x of a point `i` columns to the right of the centre of the first, beam frame, metres.
    #[inline(always)]
    fn across(&self, i: f64) -> f64 {
        let columns = f64::from(self.beam.columns);
        (2.0 * i + 1.0 - columns) * self.beam.half_width / columns
    }
}

/// Columns and rows of the pixels that are traced together.
const PIXEL_TILE: [u32; 2] = [8, TILE as u32 / 8];

/// Columns and rows of the pencils that are traced together: their rows start in different points.
const PENCIL_TILE: [u32; 2] = [TILE as u32, 1];

/// All rays of one sensor.
#[derive(Debug)]
pub(crate) struct SensorRays {
    scene_from_sensor: Rotation,
    position: DVec3,
    source: RaySource,
    max_range: f64,
}

#[derive(Debug)]
enum RaySource {
    Camera(Camera),
    Beam(PencilGrid),
}

impl SensorRays {
    pub(crate) fn of_camera(mounted: &Mounted<Camera>) -> Self {
        Self::new(mounted.scene_from_sensor, RaySource::Camera(mounted.sensor), mounted.sensor.max_range)
    }

    /// The rays of a beam's pencils, one for each cell of its `grid`.
    pub(crate) fn of_beam(mounted: &Mounted<Beam>, grid: PencilGrid) -> Self {
        Self::new(mounted.scene_from_sensor, RaySource::Beam(grid), mounted.sensor.max_range)
    }

    fn new(pose: Pose, source: RaySource, max_range: f64) -> Self {
        Self { scene_from_sensor: Rotation::from_pose(&pose), position: pose.position, source, max_range }
    }

    /// Columns and rows.
    pub(crate) fn size(&self) -> (u32, u32) {
        match &self.source {
            RaySource::Camera(camera) => (camera.width, camera.height),
            RaySource::Beam(PencilGrid { beam, .. }) => (beam.columns, beam.rows),
        }
    }

    /// Maximum range along a ray, metres.
    pub(crate) fn max_range(&self) -> f64 {
        self.max_range
    }

    /// Depth along the sensor's normal axis per unit of t, metres: f_c or g.
    pub(crate) fn depth_per_t(&self) -> f64 {
        match &self.source {
            RaySource::Camera(camera) => camera.focal_length,
            RaySource::Beam(PencilGrid { beam, .. }) => beam.grid_distance,
        }
    }

    /// Columns and rows of cells whose rays start in one point and run close to one another; `None` if each starts in a point
    /// of its own.
    pub(crate) fn tile_size(&self) -> Option<[u32; 2]> {
        match &self.source {
            RaySource::Camera(_) => Some(PIXEL_TILE),
            RaySource::Beam(PencilGrid { sampling: Sampling::Centres, .. }) => Some(PENCIL_TILE),
            RaySource::Beam(PencilGrid { sampling: Sampling::Jittered { .. }, .. }) => None,
        }
    }

    /// Makes `tile` that of the cells from (i, j) on, row by row, as wide as a [tile](Self::tile_size). Returns which lanes
    /// have a ray; the others are beyond the last cell.
    #[inline(always)]
    pub(crate) fn fill(&self, tile: &mut Tile, i: u32, j: u32) -> u64 {
        let (width, height) = self.size();
        // A lane beyond the last cell has that cell's ray, but does not take part.
        let cell = |i: u32, j: u32| (f64::from(i.min(width - 1)), f64::from(j.min(height - 1)));
        let [columns, rows] = match &self.source {
            RaySource::Camera(camera) => {
                let [columns, rows] = PIXEL_TILE;
                for b in 0..BLOCKS {
                    let [dx, dy, dz] = &mut tile.blocks[b].direction;
                    for k in 0..BLOCK {
                        let lane = (b * BLOCK + k) as u32;
                        let (i, j) = cell(i + lane % columns, j + lane / columns);
                        let direction = self.scene_from_sensor.apply(pixel_direction(camera, i, j));
                        (dx[k], dy[k], dz[k]) = (direction.x, direction.y, direction.z);
                    }
                }
                [columns, rows]
            }
            RaySource::Beam(grid) => {
                for b in 0..BLOCKS {
                    let [dx, dy, dz] = &mut tile.blocks[b].direction;
                    for k in 0..BLOCK {
                        let (i, _) = cell(i + (b * BLOCK + k) as u32, j);
                        let q = DVec3::new(grid.across(i), 0.0, grid.beam.grid_distance);
                        let direction = self.scene_from_sensor.apply(q);
                        (dx[k], dy[k], dz[k]) = (direction.x, direction.y, direction.z);
                    }
                }
                PENCIL_TILE
            }
        };
        tile.origin = self.start(self.q(i, j).0);
        tile.prepare();
        if i + columns <= width && j + rows <= height {
            return u64::MAX;
        }
        let is_cell = |lane: &u32| i + lane % columns < width && j + lane / columns < height;
        (0..TILE as u32).filter(is_cell).fold(0, |active, lane| active | 1 << lane)
    }

    /// The ray of cell (i, j).
    #[inline(always)]
    pub(crate) fn ray(&self, i: u32, j: u32) -> TracedRay {
        let (y, q) = self.q(i, j);
        TracedRay::new(self.start(y), self.scene_from_sensor.apply(q))
    }

    /// The start of a ray `y` along the sensor's y axis, scene frame, metres.
    #[inline(always)]
    fn start(&self, y: f64) -> DVec3 {
        match &self.source {
            RaySource::Camera(_) => self.position,
            RaySource::Beam(_) => self.position + self.scene_from_sensor.apply(DVec3::new(0.0, y, 0.0)),
        }
    }

    /// Where the ray of cell (i, j) starts along the sensor's y axis, and its vector q to the SPP, sensor frame, metres.
    #[inline(always)]
    fn q(&self, i: u32, j: u32) -> (f64, DVec3) {
        match &self.source {
            RaySource::Camera(camera) => (0.0, pixel_direction(camera, f64::from(i), f64::from(j))),
            // From the focal axis at the height y of the crossing, through the grid plane at the same height. (§5,
            // figure 6: the thickness is constant.) The origin of the ray is not the origin of the beam.
            RaySource::Beam(grid) => {
                let (x, y) = grid.crossing(i, j);
                (y, DVec3::new(x, 0.0, grid.beam.grid_distance))
            }
        }
    }
}

/// The vector from the projection centre through the centre of a pixel to the image plane, camera frame, metres.
#[inline(always)]
fn pixel_direction(camera: &Camera, i: f64, j: f64) -> DVec3 {
    let [pitch_x, pitch_y] = camera.pixel_pitch;
    let [centre_x, centre_y] = camera.principal_point;
    let x = (i + 0.5 - centre_x) * pitch_x;
    let y = (j + 0.5 - centre_y) * pitch_y;
    DVec3::new(x, y, camera.focal_length)
}

/// The rotation of a pose, (q p q*) / (q . q), expanded as
/// `((w^2 - u.u) p + 2 (u.p) u + 2 w (u x p)) / (w^2 + u.u)` for q = (u, w).
#[derive(Debug)]
pub(crate) struct Rotation {
    u: DVec3,
    w: f64,
    /// w^2 - u.u
    ww_minus_uu: f64,
    /// w^2 + u.u
    norm_squared: f64,
}

impl Rotation {
    pub(crate) fn from_pose(pose: &Pose) -> Self {
        let q = pose.rotation;
        let u = DVec3::new(q.x, q.y, q.z);
        let (ww, uu) = (q.w * q.w, u.dot(u));
        Self { u, w: q.w, ww_minus_uu: ww - uu, norm_squared: ww + uu }
    }

    #[inline(always)]
    pub(crate) fn apply(&self, p: DVec3) -> DVec3 {
        let sum = p * self.ww_minus_uu + self.u * (2.0 * self.u.dot(p)) + self.u.cross(p) * (2.0 * self.w);
        sum / self.norm_squared
    }
}

#[cfg(test)]
#[path = "../tests/unit/rays.rs"]
mod tests;
