//! The contract's rays, formed in the scene frame for tracing. (Contract: camera and beam rays)

use glam::{DVec3, Vec3A};
use obvhs::ray::Ray as BoxRay;
use raypencil_scene::{Beam, Camera, Mounted, Pose, Sampling};

/// One ray, made ready for many triangle tests.
#[derive(Debug, Clone, Copy)]
pub(crate) struct TracedRay {
    /// Where it starts, scene frame, metres.
    pub(crate) origin: DVec3,
    /// From the origin to the SPP, scene frame, metres.
    pub(crate) direction: DVec3,
    /// |direction|: metres per unit of t.
    pub(crate) metres_per_t: f64,
    /// The axis along which the direction is longest, and the two others, in the order in which a face
    /// whose front the ray meets runs counter-clockwise: see `triangle`.
    pub(crate) axes: [usize; 3],
}

impl TracedRay {
    pub(crate) fn new(origin: DVec3, direction: DVec3) -> Self {
        let along = direction.abs();
        let longest = if along.x >= along.y && along.x >= along.z {
            0
        } else if along.y >= along.z {
            1
        } else {
            2
        };
        let (next, last) = ((longest + 1) % 3, (longest + 2) % 3);
        // Seen along +z, with x to the right, y runs down; seen along -z it runs up.
        let axes = if direction[longest] < 0.0 { [next, last, longest] } else { [last, next, longest] };
        Self { origin, direction, metres_per_t: direction.length(), axes }
    }

    /// The ray as obvhs knows it: f32, unit direction, so that its t is the range in metres.
    pub(crate) fn for_boxes(&self, longest: f32) -> BoxRay {
        let unit = self.direction / self.metres_per_t;
        let narrow = |v: DVec3| Vec3A::new(v.x as f32, v.y as f32, v.z as f32);
        BoxRay::new(narrow(self.origin), narrow(unit), 0.0, longest)
    }
}

/// Where the rays of a beam's pencils cross its grid plane.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Grid {
    pub(crate) beam: Beam,
    /// Of the beam in the scene: jittered rays are drawn by it.
    index: usize,
    sampling: Sampling,
}

impl Grid {
    pub(crate) fn new(beam: Beam, index: usize, sampling: Sampling) -> Self {
        Self { beam, index, sampling }
    }

    /// x and y of the ray of pencil (i, j) on the grid plane, beam frame, metres. Its cell's middle, or the
    /// place drawn in it: offsets are multiples of 2^-33, so i + dx is exact for every i.
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
    scene_from_sensor: Turn,
    position: DVec3,
    kind: Kind,
    max_range: f64,
}

#[derive(Debug)]
enum Kind {
    Camera(Camera),
    Beam(Grid),
}

impl SensorRays {
    pub(crate) fn of_camera(mounted: &Mounted<Camera>) -> Self {
        Self::new(mounted.scene_from_sensor, Kind::Camera(mounted.sensor), mounted.sensor.max_range)
    }

    /// The rays that stand for the pencils of a beam, in its `grid`.
    pub(crate) fn of_beam(mounted: &Mounted<Beam>, grid: Grid) -> Self {
        Self::new(mounted.scene_from_sensor, Kind::Beam(grid), mounted.sensor.max_range)
    }

    fn new(pose: Pose, kind: Kind, max_range: f64) -> Self {
        Self { scene_from_sensor: Turn::of(&pose), position: pose.position, kind, max_range }
    }

    /// Columns and rows.
    pub(crate) fn size(&self) -> (u32, u32) {
        match &self.kind {
            Kind::Camera(camera) => (camera.width, camera.height),
            Kind::Beam(Grid { beam, .. }) => (beam.columns, beam.rows),
        }
    }

    /// Longest range along a ray, metres.
    pub(crate) fn max_range(&self) -> f64 {
        self.max_range
    }

    /// How far one unit of t leads along the sensor's normal axis, metres: f_c or g.
    pub(crate) fn depth_per_t(&self) -> f64 {
        match &self.kind {
            Kind::Camera(camera) => camera.focal_length,
            Kind::Beam(Grid { beam, .. }) => beam.grid_distance,
        }
    }

    /// The ray of cell (i, j).
    pub(crate) fn ray(&self, i: u32, j: u32) -> TracedRay {
        match &self.kind {
            // From the projection centre through the middle of the pixel.
            Kind::Camera(camera) => {
                let [pitch_x, pitch_y] = camera.pixel_pitch;
                let [centre_x, centre_y] = camera.principal_point;
                let x = (f64::from(i) + 0.5 - centre_x) * pitch_x;
                let y = (f64::from(j) + 0.5 - centre_y) * pitch_y;
                let q = DVec3::new(x, y, camera.focal_length);
                TracedRay::new(self.position, self.scene_from_sensor.apply(q))
            }
            // From the focal axis at the height of the crossing, level through the grid plane. The two are
            // kept apart: the origin of a ray is not on the projection centre.
            Kind::Beam(grid) => {
                let (x, y) = grid.crossing(i, j);
                let q = DVec3::new(x, 0.0, grid.beam.grid_distance);
                let start = self.scene_from_sensor.apply(DVec3::new(0.0, y, 0.0));
                TracedRay::new(self.position + start, self.scene_from_sensor.apply(q))
            }
        }
    }
}

/// The rotation of a pose, (q p q*) / (q . q), expanded as
/// `((w^2 - u.u) p + 2 (u.p) u + 2 w (u x p)) / (w^2 + u.u)` for q = (u, w).
#[derive(Debug)]
pub(crate) struct Turn {
    u: DVec3,
    w: f64,
    along: f64,
    norm_squared: f64,
}

impl Turn {
    pub(crate) fn of(pose: &Pose) -> Self {
        let q = pose.rotation;
        let u = DVec3::new(q.x, q.y, q.z);
        let (ww, uu) = (q.w * q.w, u.dot(u));
        Self { u, w: q.w, along: ww - uu, norm_squared: ww + uu }
    }

    pub(crate) fn apply(&self, p: DVec3) -> DVec3 {
        let sum = p * self.along + self.u * (2.0 * self.u.dot(p)) + self.u.cross(p) * (2.0 * self.w);
        sum / self.norm_squared
    }
}
