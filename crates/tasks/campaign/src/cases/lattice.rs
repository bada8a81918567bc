//! Lattice meshes whose vertices lie exactly on every second ray of a sensor, and exact counts of the rays
//! that pass through their vertices and edges.
//!
//! A vertex is at `origin + t q` on the ray of an even column and an even row; t is one of a few dyadic numbers. With
//! dyadic sensors all vertices are exact in `f32`. The rays in between meet the mesh as follows:
//!
//! * camera: the image of an edge is the straight line between two pixel centres two apart, horizontal,
//!   vertical or diagonal; the pixel centre between them lies on it. Every ray meets a vertex or an edge.
//!   1/t is affine on the image: between t and t' it is (1/t + 1/t') / 2.
//! * beam: along a row it is the same. Along a column both ends lie in the plane x / z = x_i / g, and the row
//!   between meets the edge at (t + t') / 2. A diagonal is met if its ends have the same t; otherwise the ray
//!   passes beside it.

use std::sync::Arc;

use glam::{DQuat, DVec3};
use raypencil_scene::{Beam, Camera, Mesh, Mounted, Pose, Scene, rig};

use crate::cases::{mesh, scene};

pub use crate::cases::split_mix::{hash, hash_unit};

/// A sensor whose numbers are dyadic, in its own frame.
#[derive(Debug, Clone, Copy)]
pub enum Sensor {
    /// A camera; its rays are those of pixels.
    Camera(Camera),
    /// A beam; its rays are those of pencils.
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

    /// Origin and direction of the ray in column `i` of row `j`, also beyond the sensor's border. The formulas are
    /// those of the contract, and exact for dyadic numbers.
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

/// A lattice in front of a sensor with odd numbers of columns and rows, whose rays meet its vertices exactly.
#[derive(Debug, Clone)]
pub struct Lattice {
    sensor: Sensor,
    /// Number of rings of cells beyond the sensor's border.
    rings: u32,
    /// Numbers of vertices across and down.
    size: [usize; 2],
    /// The t of each vertex, row by row.
    t: Vec<f64>,
    /// Whether a cell's diagonal falls from the upper left to the lower right.
    falling: Vec<bool>,
}

/// A lattice in front of a camera of `size` x `size` pixels that is turned by the quaternion (1, 2, 3, 4) / sqrt 30.
/// Each ray passes a vertex, an edge or a diagonal at a distance of about 1e-16 of its own length.
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
    // A camera a third as large has the same rays, except for rounding.
    let sensor = Camera {
        pixel_pitch: camera.pixel_pitch.map(|pitch| pitch / 3.0),
        focal_length: camera.focal_length / 3.0,
        ..camera
    };
    scene(mesh, Mounted { scene_from_sensor: pose, sensor }, Vec::new())
}

/// The known outcome of a ray.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ExpectedHit {
    /// The ray hits the mesh.
    Hit,
    /// The ray misses: it meets the mesh only in front of the sensor projection plane (SPP).
    Miss,
    /// Not known: the ray passes beside a diagonal, through one of two faces that the SPP may cut.
    Unknown,
}

impl Lattice {
    /// A lattice with `rings` rings of cells beyond the sensor's border. `seed` chooses the t of each vertex from `ts`,
    /// and the direction of each cell's diagonal.
    ///
    /// # Panics
    /// If the number of the sensor's columns or rows is even.
    pub fn before(sensor: Sensor, rings: u32, seed: u64, ts: &[f64]) -> Self {
        let (width, height) = sensor.size();
        assert!(width % 2 == 1 && height % 2 == 1, "{width} x {height}");
        let size = [width, height].map(|cells| (cells / 2 + 1 + 2 * rings) as usize);
        let count = size[0] * size[1];
        let t = (0..count).map(|index| ts[hash(seed, index as u64) as usize % ts.len()]).collect();
        let falling = (0..count).map(|index| hash(!seed, index as u64).is_multiple_of(2)).collect();
        Self { sensor, rings, size, t, falling }
    }

    /// Vertex (u, v) in the sensor's frame, metres.
    fn vertex(&self, u: usize, v: usize) -> DVec3 {
        let [i, j] = [u, v].map(|index| 2 * (index as i64 - i64::from(self.rings)));
        let [origin, q] = self.sensor.ray(i, j);
        origin + q * self.t[v * self.size[0] + u]
    }

    /// Corners of the two faces of cell (u, v), counter-clockwise as seen from the sensor.
    fn faces(&self, u: usize, v: usize) -> [[[usize; 2]; 3]; 2] {
        let (a, b, c, d) = ([u, v], [u, v + 1], [u + 1, v + 1], [u + 1, v]);
        if self.falling[v * self.size[0] + u] { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] }
    }

    /// The mesh in the scene frame, and the largest distance that the rounding to `f32` moved a vertex, metres.
    pub fn mesh(&self, scene_from_sensor: &Pose) -> (Arc<Mesh>, f64) {
        let [across, down] = self.size;
        let mut moved = 0.0_f64;
        let mut vertices = Vec::with_capacity(across * down);
        for v in 0..down {
            for u in 0..across {
                let exact = *scene_from_sensor * self.vertex(u, v);
                // A coordinate that is a multiple of 2^-24 m, up to the rounding of the turn, becomes one exactly.
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

    /// The t of the vertex on ray (i, j). `None`: the ray goes through no vertex.
    pub fn t_at(&self, i: u32, j: u32) -> Option<f64> {
        let [u, v] = [i, j].map(|index| (index / 2 + self.rings) as usize);
        (i.is_multiple_of(2) && j.is_multiple_of(2)).then(|| self.t[v * self.size[0] + u])
    }

    /// The outcome of ray (i, j), from the t of the vertices around it.
    pub fn fate(&self, i: u32, j: u32) -> ExpectedHit {
        let [u, v] = [i, j].map(|index| (index / 2 + self.rings) as usize);
        let t = |u: usize, v: usize| self.t[v * self.size[0] + u];
        let at = |t: f64| if t >= 1.0 { ExpectedHit::Hit } else { ExpectedHit::Miss };
        let harmonic = |t: f64, other: f64| 2.0 / (1.0 / t + 1.0 / other);
        let falling = self.falling[v * self.size[0] + u];
        let diagonal = || if falling { (t(u, v), t(u + 1, v + 1)) } else { (t(u, v + 1), t(u + 1, v)) };
        match (i % 2, j % 2, &self.sensor) {
            (0, 0, _) => at(t(u, v)),
            (1, 0, _) => at(harmonic(t(u, v), t(u + 1, v))),
            (0, 1, Sensor::Camera(_)) => at(harmonic(t(u, v), t(u, v + 1))),
            (0, 1, Sensor::Beam(_)) => at(0.5 * (t(u, v) + t(u, v + 1))),
            (_, _, Sensor::Camera(_)) => at(harmonic(diagonal().0, diagonal().1)),
            (_, _, Sensor::Beam(_)) => {
                let corners = [t(u, v), t(u + 1, v), t(u, v + 1), t(u + 1, v + 1)];
                let beyond = corners.iter().filter(|t| **t >= 1.0).count();
                [
                    ExpectedHit::Miss,
                    ExpectedHit::Unknown,
                    ExpectedHit::Unknown,
                    ExpectedHit::Unknown,
                    ExpectedHit::Hit,
                ][beyond]
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
                // The cells that touch the ray.
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

/// Whether the half line along `q` meets the segment from `a` to `b`. The origin is that of the half line.
fn is_between(q: &[i128; 3], a: &[i128; 3], b: &[i128; 3]) -> bool {
    let dot = |a: &[i128; 3], b: &[i128; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let cross = |a: &[i128; 3], b: &[i128; 3]| {
        [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    };
    // q lies in the plane of a and b, not beyond either.
    let n = cross(a, b);
    dot(&n, q) == 0 && dot(&n, &cross(a, q)) >= 0 && dot(&n, &cross(q, b)) >= 0
}

#[cfg(test)]
mod tests {
    use raypencil_referee::{Format, Referee};
    use raypencil_scene::SensorId;
    use raypencil_scene_io::scene_sha256;

    use super::*;
    use crate::cases::at_origin;

    /// A camera and a beam, each before a lattice of which a part lies in front of the sensor projection plane.
    fn cut() -> [(SensorId, Sensor, Lattice); 2] {
        let camera = Sensor::Camera(rig::camera(9, 9, 1.0 / 1024.0, 1.0 / 16.0));
        let beam = Sensor::Beam(rig::beam(9, 7, [1.0 / 1024.0, 1.0 / 256.0], 1.0 / 16.0));
        [(SensorId::Camera, camera, 1), (SensorId::Beam(0), beam, 0)].map(|(id, sensor, rings)| {
            (id, sensor, Lattice::before(sensor, rings, 3, &[0.5, 0.75, 1.0, 1.5, 64.0]))
        })
    }

    #[test]
    fn the_fate_of_each_ray_and_the_range_of_each_vertex_are_the_referee_s() {
        for (id, sensor, lattice) in cut() {
            let (mesh, moved) = lattice.mesh(&Pose::IDENTITY);
            assert_eq!(moved, 0.0);
            let scene = match sensor {
                Sensor::Camera(camera) => scene(mesh, at_origin(camera), Vec::new()),
                Sensor::Beam(beam) => {
                    scene(mesh, at_origin(rig::camera(1, 1, 0.01, 0.01)), vec![at_origin(beam)])
                }
            };
            let referee = Referee::new(&scene);
            let (width, height) = sensor.size();
            let mut fates = [0; 3];
            for (i, j) in (0..height).flat_map(|j| (0..width).map(move |i| (i, j))) {
                let hit = referee.values(id, i, j).map(|hit| hit.in_format(Format::Double));
                let fate = lattice.fate(i, j);
                fates[fate as usize] += 1;
                if fate != ExpectedHit::Unknown {
                    assert_eq!(hit.is_some(), fate == ExpectedHit::Hit, "{id} {i},{j}");
                }
                let on_vertex = i.is_multiple_of(2) && j.is_multiple_of(2);
                assert_eq!(lattice.t_at(i, j).is_some(), on_vertex);
                if let Some((t, hit)) = lattice.t_at(i, j).zip(hit) {
                    let [_, q] = sensor.ray(i.into(), j.into());
                    assert!((hit.range - t * q.length()).abs() <= 1e-15 * hit.range, "{id} {i},{j}");
                }
            }
            let [hits, misses, unknown] = fates;
            assert!(hits > 10 && misses > 10 && (unknown > 0) == (id != SensorId::Camera), "{fates:?}");
        }
    }

    #[test]
    fn a_ray_passes_beside_a_diagonal_of_a_beam_unless_its_ends_have_the_same_t() {
        let [(_, camera, before_camera), (_, beam, before_beam)] = cut();
        let (width, height) = camera.size();
        assert_eq!(before_camera.count_rays_on_edges(), u64::from(width * height));
        let (width, height) = beam.size();
        let mut expected = 0;
        for (i, j) in (0..height).flat_map(|j| (0..width).map(move |i| (i, j))) {
            let cell = (j / 2 * width.div_ceil(2) + i / 2) as usize;
            let t = |di: u32, dj: u32| before_beam.t_at(i - 1 + 2 * di, j - 1 + 2 * dj);
            expected += u64::from(match (i % 2, j % 2) {
                (1, 1) if before_beam.falling[cell] => t(0, 0) == t(1, 1),
                (1, 1) => t(0, 1) == t(1, 0),
                _ => true,
            });
        }
        assert!(expected < u64::from(width * height) && expected > u64::from(width * height) * 3 / 4);
        assert_eq!(before_beam.count_rays_on_edges(), expected);
    }

    #[test]
    fn every_ray_hits_a_lattice_beyond_the_projection_plane_and_none_one_before_it() {
        for (id, sensor, _) in cut() {
            let (width, height) = sensor.size();
            for (t, expected) in
                [(1.0, ExpectedHit::Hit), (64.0, ExpectedHit::Hit), (0.75, ExpectedHit::Miss)]
            {
                let lattice = Lattice::before(sensor, 1, 3, &[t]);
                for (i, j) in (0..height).flat_map(|j| (0..width).map(move |i| (i, j))) {
                    assert_eq!(lattice.fate(i, j), expected, "{id} {i},{j} at {t}");
                }
            }
        }
    }

    #[test]
    fn a_turn_by_a_quarter_keeps_every_coordinate_exact() {
        let [(_, camera, lattice), _] = cut();
        let half = std::f64::consts::FRAC_1_SQRT_2;
        let pose = Pose { position: DVec3::ZERO, rotation: DQuat::from_xyzw(0.0, 0.0, half, half) };
        // Products with this quaternion are rounded, and 0 would be some 1e-17 m.
        let (turned, _) = lattice.mesh(&pose);
        let (plain, _) = lattice.mesh(&Pose::IDENTITY);
        let expected: Vec<[f32; 3]> = plain.vertices().iter().map(|&[x, y, z]| [-y, x, z]).collect();
        assert_eq!(turned.vertices(), expected);
        assert!(expected.iter().any(|vertex| vertex[0] == 0.0), "{camera:?}");
    }

    #[test]
    fn a_half_line_meets_a_segment_at_its_ends_too_and_never_behind_its_origin() {
        let meets = |q: [i128; 3]| is_between(&q, &[2, 0, 4], &[-2, 0, 4]);
        for q in [[0, 0, 1], [1, 0, 2], [-1, 0, 2], [1, 0, 3]] {
            assert!(meets(q), "{q:?}");
        }
        // Beyond either end, beside the plane, and behind.
        for q in [[3, 0, 4], [-3, 0, 4], [0, 1, 9], [0, 0, -1], [-1, 0, -2]] {
            assert!(!meets(q), "{q:?}");
        }
    }

    #[test]
    fn a_turned_lattice_stays_what_it_is() {
        let digest = "0835e1a128346ceea27b99e5399682017d29baee5250e6fafcac4c9ec9dc4df1";
        assert_eq!(scene_sha256(&turned(5)), digest);
    }
}
