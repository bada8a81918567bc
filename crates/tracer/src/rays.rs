//! The contract's rays, formed in the scene frame for tracing. (Contract: camera and beam rays)

use glam::{DVec3, Vec3A};
use raypencil_scene::{Beam, Camera, Mounted, Pose, Sampling};

use crate::tile::{BLOCK, BLOCKS, TILE, Tile};
use crate::wide_tree::Bundle;

/// One ray, prepared for many triangle tests.
#[derive(Debug, Clone, Copy)]
pub(crate) struct TracedRay {
    /// Start of the ray, scene frame, metres.
    pub(crate) origin: DVec3,
    /// Vector from the origin to the SPP, scene frame, metres.
    pub(crate) direction: DVec3,
    /// |direction|: metres per unit of t.
    pub(crate) metres_per_t: f64,
    /// The two shorter axes of the direction, then the longest. The first two are ordered so that a face whose
    /// front the ray meets runs counter-clockwise in them: see `triangle`.
    pub(crate) axes: [usize; 3],
}

impl TracedRay {
    pub(crate) fn new(origin: DVec3, direction: DVec3) -> Self {
        let axes = Self::axes_of(direction);
        Self { origin, direction, metres_per_t: direction.length(), axes }
    }

    /// The axes of a ray along `direction`, as in [`TracedRay::axes`].
    #[inline(always)]
    pub(crate) fn axes_of(direction: DVec3) -> [usize; 3] {
        let size = direction.abs();
        let longest = if size.x >= size.y && size.x >= size.z {
            0
        } else if size.y >= size.z {
            1
        } else {
            2
        };
        let (next, last) = ((longest + 1) % 3, (longest + 2) % 3);
        // Seen along +z, with x to the right, y runs down; seen along -z it runs up.
        if direction[longest] < 0.0 { [next, last, longest] } else { [last, next, longest] }
    }

    /// The ray for the boxes: f32, with a unit direction, so that its t is the range in metres. It ends at `max_range`.
    pub(crate) fn bundle(&self, max_range: f32) -> Bundle {
        let unit = self.direction / self.metres_per_t;
        let narrow = |v: DVec3| Vec3A::new(v.x as f32, v.y as f32, v.z as f32);
        Bundle::new(narrow(self.origin), narrow(unit), narrow(unit), max_range)
    }
}

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
        let Beam { half_width, thickness, .. } = self.beam;
        let (columns, rows) = (f64::from(self.beam.columns), f64::from(self.beam.rows));
        let [dx, dy] = self.sampling.offset(self.index, i, j);
        let x = (2.0 * (f64::from(i) + dx) + 1.0 - columns) * half_width / columns;
        let y = (2.0 * (f64::from(j) + dy) + 1.0 - rows) * thickness / (2.0 * rows);
        (x, y)
    }
}

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

    /// Columns and rows of cells whose rays start in one point; `None` if each has a point of its own.
    pub(crate) fn tile_size(&self) -> Option<(u32, u32)> {
        match &self.source {
            RaySource::Camera(_) => Some((8, TILE as u32 / 8)),
            RaySource::Beam(PencilGrid { sampling: Sampling::Centres, .. }) => Some((TILE as u32, 1)),
            RaySource::Beam(PencilGrid { sampling: Sampling::Jittered { .. }, .. }) => None,
        }
    }

    /// Makes `tile` that of the cells from (i, j) to before the `end` column and row, its rows `columns` lanes apart. Returns
    /// which lanes have a ray.
    #[inline(always)]
    pub(crate) fn fill(&self, tile: &mut Tile, [i, j]: [u32; 2], end: [u32; 2], columns: u32) -> u64 {
        let mut active = 0;
        for b in 0..BLOCKS {
            let mut cells = [[0_u32; 2]; BLOCK];
            for k in 0..BLOCK {
                let lane = (b * BLOCK + k) as u32;
                let cell = [i + lane % columns, j + lane / columns];
                // A lane beyond the end has a ray too, but does not take part.
                cells[k] = [cell[0].min(end[0] - 1), cell[1].min(end[1] - 1)];
                active |= u64::from(cell == cells[k]) << lane;
            }
            let mut directions = [[0.0; BLOCK]; 3];
            match &self.source {
                RaySource::Camera(camera) => {
                    for k in 0..BLOCK {
                        let q = pixel_direction(camera, cells[k][0], cells[k][1]);
                        let direction = self.scene_from_sensor.apply(q);
                        directions[0][k] = direction.x;
                        directions[1][k] = direction.y;
                        directions[2][k] = direction.z;
                    }
                }
                RaySource::Beam(grid) => {
                    let columns = f64::from(grid.beam.columns);
                    for k in 0..BLOCK {
                        let x =
                            (2.0 * f64::from(cells[k][0]) + 1.0 - columns) * grid.beam.half_width / columns;
                        let direction =
                            self.scene_from_sensor.apply(DVec3::new(x, 0.0, grid.beam.grid_distance));
                        directions[0][k] = direction.x;
                        directions[1][k] = direction.y;
                        directions[2][k] = direction.z;
                    }
                }
            }
            tile.blocks[b].direction = directions;
        }
        tile.origin = self.origin(self.q(i, j).0);
        tile.prepare();
        active
    }

    /// The ray of cell (i, j).
    #[inline(always)]
    pub(crate) fn ray(&self, i: u32, j: u32) -> TracedRay {
        let (y, q) = self.q(i, j);
        TracedRay::new(self.origin(y), self.scene_from_sensor.apply(q))
    }

    /// The start of a ray `y` along the sensor's y axis, scene frame, metres.
    #[inline(always)]
    fn origin(&self, y: f64) -> DVec3 {
        match &self.source {
            RaySource::Camera(_) => self.position,
            RaySource::Beam(_) => self.position + self.scene_from_sensor.apply(DVec3::new(0.0, y, 0.0)),
        }
    }

    /// Where the ray of cell (i, j) starts along the sensor's y axis, and its vector q to the SPP, sensor frame, metres.
    #[inline(always)]
    fn q(&self, i: u32, j: u32) -> (f64, DVec3) {
        match &self.source {
            RaySource::Camera(camera) => (0.0, pixel_direction(camera, i, j)),
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
fn pixel_direction(camera: &Camera, i: u32, j: u32) -> DVec3 {
    let [pitch_x, pitch_y] = camera.pixel_pitch;
    let [centre_x, centre_y] = camera.principal_point;
    let x = (f64::from(i) + 0.5 - centre_x) * pitch_x;
    let y = (f64::from(j) + 0.5 - centre_y) * pitch_y;
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
