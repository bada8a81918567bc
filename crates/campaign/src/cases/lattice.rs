//! Lattice meshes whose vertices lie exactly on every second ray of a sensor, and exact counts of the rays
//! that pass through their vertices and edges.
//!
//! A vertex stands at `origin + t q` on the ray of an even column and an even row, t one of few dyadic
//! numbers. With dyadic sensors all of this is exact in `f32`. What the rays between meet:
//!
//! * camera: the image of an edge is the straight line between two pixel centres two apart, horizontal,
//!   vertical or diagonal; the pixel centre between them lies on it. Every ray meets a vertex or an edge.
//!   1/t is affine on the image: between t and t' it is (1/t + 1/t') / 2.
//! * beam: along a row the same. Along a column both ends lie in the plane x / z = x_i / g, and the row
//!   between meets the edge at (t + t') / 2. A diagonal is met where its ends have one t, else missed by a
//!   little.

use glam::{DQuat, DVec3};
use std::sync::Arc;

use crate::cases::{mesh, scene};
use raypencil_scene::{Beam, Camera, Mesh, Mounted, Pose, Scene, rig};

/// A sensor of dyadic numbers, in its own frame.
#[derive(Debug, Clone, Copy)]
pub enum Sensor {
    /// Rays are pixels.
    Camera(Camera),
    /// Rays are pencils.
    Beam(Beam),
}

impl Sensor {
    /// Columns and rows.
    pub fn size(&self) -> (u32, u32) {
        match self {
            Self::Camera(camera) => (camera.width, camera.height),
            Self::Beam(beam) => (beam.columns, beam.rows),
        }
    }

    /// Origin and direction of the ray in column `i` of row `j`, also beyond the sensor's border: the
    /// contract's formulas, exact for dyadic numbers.
    pub fn ray(&self, i: i64, j: i64) -> [DVec3; 2] {
        let (i, j) = (i as f64, j as f64);
        match self {
            Self::Camera(camera) => {
                let [x, y] = [i + 0.5 - camera.principal_point[0], j + 0.5 - camera.principal_point[1]];
                let [pitch_x, pitch_y] = camera.pixel_pitch;
                [DVec3::ZERO, DVec3::new(x * pitch_x, y * pitch_y, camera.focal_length)]
            }
            Self::Beam(beam) => {
                let (columns, rows) = (f64::from(beam.columns), f64::from(beam.rows));
                let x = beam.half_width * (2.0 * i + 1.0 - columns) / columns;
                let y = beam.thickness * (2.0 * j + 1.0 - rows) / (2.0 * rows);
                [DVec3::new(0.0, y, 0.0), DVec3::new(x, 0.0, beam.grid_distance)]
            }
        }
    }
}

/// A lattice before a sensor with odd columns and rows, whose corners it meets exactly.
#[derive(Debug, Clone)]
pub struct Lattice {
    sensor: Sensor,
    /// Rings of cells beyond the sensor's border.
    rings: u32,
    /// Vertices across and down.
    size: [usize; 2],
    /// The t of each vertex, row by row.
    t: Vec<f64>,
    /// Whether a cell's diagonal falls from the upper left to the lower right.
    falling: Vec<bool>,
}

/// Hills before a camera of `size` x `size` pixels, turned by (1, 2, 3, 4) / sqrt 30, all of whose rays pass within
/// 1e-16 of themselves of a vertex, an edge or a diagonal.
///
/// # Panics
/// If `size` is even.
pub fn turned(size: u32) -> Scene {
    let (x, y, z, w) = (1.0, 2.0, 3.0, 4.0);
    let factor = (x * x + y * y + z * z + w * w) / 32.0;
    let pose = Pose { position: DVec3::new(0.25, -0.75, 0.5), rotation: DQuat::from_xyzw(x, y, z, w) };
    let plain = rig::camera(size, size, 1.0 / 1024.0, 1.0 / 16.0);
    let camera = Camera {
        pixel_pitch: plain.pixel_pitch.map(|pitch| pitch * factor),
        focal_length: plain.focal_length * factor,
        ..plain
    };
    let lattice = Lattice::before(Sensor::Camera(camera), 1, 5, &[24.0, 26.0, 30.0, 32.0]);
    let (mesh, moved) = lattice.mesh(&pose);
    assert!(moved <= 1e-14, "vertices are exact in f32, not {moved} m off");
    // A third as large, the rays are the same but for rounding.
    let sensor = Camera {
        pixel_pitch: camera.pixel_pitch.map(|pitch| pitch / 3.0),
        focal_length: camera.focal_length / 3.0,
        ..camera
    };
    scene(mesh, Mounted { scene_from_sensor: pose, sensor }, Vec::new())
}

/// What a ray is known to do.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Fate {
    /// It hits.
    Hit,
    /// All of the mesh that it meets lies before the SPP.
    Miss,
    /// It passes beside a diagonal, on one of two faces that the SPP may cut.
    Unknown,
}

impl Lattice {
    /// A lattice with `rings` rings of cells beyond the sensor. The t of a vertex and the way of each cell's
    /// diagonal come from hashes of `seed`: one of `ts`, at random.
    ///
    /// # Panics
    /// If the sensor's columns or rows are even.
    pub fn before(sensor: Sensor, rings: u32, seed: u64, ts: &[f64]) -> Self {
        let (width, height) = sensor.size();
        assert!(width % 2 == 1 && height % 2 == 1, "{width} x {height}");
        let size = [width, height].map(|cells| (cells / 2 + 1 + 2 * rings) as usize);
        let count = size[0] * size[1];
        let t = (0..count).map(|index| ts[hash(seed, index as u64) as usize % ts.len()]).collect();
        let falling = (0..count).map(|index| hash(!seed, index as u64).is_multiple_of(2)).collect();
        Self { sensor, rings, size, t, falling }
    }

    /// Vertex (u, v) in the sensor's frame.
    fn vertex(&self, u: usize, v: usize) -> DVec3 {
        let [i, j] = [u, v].map(|index| 2 * (index as i64 - i64::from(self.rings)));
        let [origin, q] = self.sensor.ray(i, j);
        origin + q * self.t[v * self.size[0] + u]
    }

    /// Corners of the two faces of cell (u, v), their fronts to the sensor: counter-clockwise as seen.
    fn faces(&self, u: usize, v: usize) -> [[[usize; 2]; 3]; 2] {
        let (a, b, c, d) = ([u, v], [u, v + 1], [u + 1, v + 1], [u + 1, v]);
        if self.falling[v * self.size[0] + u] { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] }
    }

    /// The mesh, in the scene, and how far the farthest vertex moved when it was rounded to `f32`, metres.
    pub fn mesh(&self, scene_from_sensor: &Pose) -> (Arc<Mesh>, f64) {
        let [across, down] = self.size;
        let mut moved = 0.0_f64;
        let mut vertices = Vec::with_capacity(across * down);
        for v in 0..down {
            for u in 0..across {
                let exact = *scene_from_sensor * self.vertex(u, v);
                // What is a whole multiple of 2^-24 m but for the rounding of the turn, is made one.
                let whole = (exact * f64::from(1 << 24)).round() / f64::from(1 << 24);
                let is_whole = (whole - exact).abs().max_element() < 1e-14;
                let rounded = if is_whole { whole.as_vec3() } else { exact.as_vec3() };
                moved = moved.max((rounded.as_dvec3() - exact).length());
                vertices.push(rounded.to_array());
            }
        }
        let index = |[u, v]: [usize; 2]| (v * across + u) as u32;
        let mut faces = Vec::with_capacity(2 * (across - 1) * (down - 1));
        for v in 0..down - 1 {
            for u in 0..across - 1 {
                faces.extend(self.faces(u, v).map(|face| face.map(index)));
            }
        }
        (mesh(vertices, faces), moved)
    }

    /// The t of the vertex that ray (i, j) goes through, if any.
    pub fn t_at(&self, i: u32, j: u32) -> Option<f64> {
        let [u, v] = [i, j].map(|index| (index / 2 + self.rings) as usize);
        (i.is_multiple_of(2) && j.is_multiple_of(2)).then(|| self.t[v * self.size[0] + u])
    }

    /// What ray (i, j) does, from the t of the vertices around it.
    pub fn fate(&self, i: u32, j: u32) -> Fate {
        let [u, v] = [i, j].map(|index| (index / 2 + self.rings) as usize);
        let t = |u: usize, v: usize| self.t[v * self.size[0] + u];
        let of = |t: f64| if t >= 1.0 { Fate::Hit } else { Fate::Miss };
        let harmonic = |t: f64, other: f64| 2.0 / (1.0 / t + 1.0 / other);
        let falling = self.falling[v * self.size[0] + u];
        let diagonal = || if falling { (t(u, v), t(u + 1, v + 1)) } else { (t(u, v + 1), t(u + 1, v)) };
        match (i % 2, j % 2, &self.sensor) {
            (0, 0, _) => of(t(u, v)),
            (1, 0, _) => of(harmonic(t(u, v), t(u + 1, v))),
            (0, 1, Sensor::Camera(_)) => of(harmonic(t(u, v), t(u, v + 1))),
            (0, 1, Sensor::Beam(_)) => of(0.5 * (t(u, v) + t(u, v + 1))),
            (_, _, Sensor::Camera(_)) => of(harmonic(diagonal().0, diagonal().1)),
            (_, _, Sensor::Beam(_)) => {
                let corners = [t(u, v), t(u + 1, v), t(u, v + 1), t(u + 1, v + 1)];
                let beyond = corners.iter().filter(|t| **t >= 1.0).count();
                [Fate::Miss, Fate::Unknown, Fate::Unknown, Fate::Unknown, Fate::Hit][beyond]
            }
        }
    }

    /// Counts the sensor's rays that pass exactly through a vertex or an edge of the mesh, in integers.
    ///
    /// # Panics
    /// If a number is not a multiple of 2^-20, so that the count would not be exact.
    pub fn count_rays_on_edges(&self) -> u64 {
        let (width, height) = self.sensor.size();
        let mut count = 0;
        for j in 0..height {
            for i in 0..width {
                let [origin, q] = self.sensor.ray(i64::from(i), i64::from(j));
                let (origin, q) = (integers(origin), integers(q));
                // The cells that touch the ray's place.
                let cells = |index: u32, vertices: usize| {
                    let cell = (index / 2 + self.rings) as usize;
                    let first = if index.is_multiple_of(2) { cell.saturating_sub(1) } else { cell };
                    first..=cell.min(vertices - 2)
                };
                let on_cell = |u: usize, v: usize| {
                    self.faces(u, v).iter().any(|face| {
                        let corners = face.map(|[u, v]| {
                            let p = integers(self.vertex(u, v));
                            [0, 1, 2].map(|axis| p[axis] - origin[axis])
                        });
                        (0..3).any(|k| is_between(&q, &corners[k], &corners[(k + 1) % 3]))
                    })
                };
                let on_edge = cells(j, self.size[1]).any(|v| cells(i, self.size[0]).any(|u| on_cell(u, v)));
                count += u64::from(on_edge);
            }
        }
        count
    }
}

/// A vector in units of 2^-20, exactly.
fn integers(v: DVec3) -> [i128; 3] {
    v.to_array().map(|coordinate| {
        let scaled = coordinate * f64::from(1 << 20);
        assert!(scaled == scaled.trunc() && scaled.abs() < 1e15, "{coordinate} is not a multiple of 2^-20");
        scaled as i128
    })
}

/// Whether the half line along `q` meets the segment from `a` to `b`, all seen from its origin.
fn is_between(q: &[i128; 3], a: &[i128; 3], b: &[i128; 3]) -> bool {
    let dot = |a: &[i128; 3], b: &[i128; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let cross = |a: &[i128; 3], b: &[i128; 3]| {
        [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    };
    // q lies in the plane of a and b, not beyond either.
    let n = cross(a, b);
    dot(&n, q) == 0 && dot(&n, &cross(a, q)) >= 0 && dot(&n, &cross(q, b)) >= 0
}

/// A hash of two numbers. (S. Vigna, SplitMix64)
pub fn hash(seed: u64, index: u64) -> u64 {
    let mut z = seed.wrapping_add((index.wrapping_add(1)).wrapping_mul(0x9e37_79b9_7f4a_7c15));
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// A hash of two numbers, as a number from -1 to 1.
pub fn hash_unit(seed: u64, index: u64) -> f64 {
    (hash(seed, index) >> 11) as f64 / f64::from(1u32 << 31) / f64::from(1 << 21) - 1.0
}
