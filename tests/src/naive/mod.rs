//! A third, brute-force renderer: every ray is tested against every face.
//!
//! It is written from the contract alone: its own rotation, its own rays, its own triangle test, no tables, no tree,
//! no order of faces. It is slow, and its purpose is to be wrong: a [`Fault`] can be injected into it, and a
//! comparison with the other renderers must find it.

mod fault;
mod light;
mod quaternion;

use std::time::Instant;

use glam::{DQuat, DVec3};
use raypencil::{
    Beam, Camera, FaceId, Hit, Mesh, Pose, Precision, Quantities, RenderOutput, Renderer, Request, Scene,
    SensorId, SensorMap, Stage,
};

pub use fault::{Fault, FaultKind};
use quaternion::{conjugate, rotate};

/// The naive renderer.
///
/// ```
/// use raypencil::{Renderer, Request};
/// use raypencil_tests::injected_faults::geometry::range_cut_wall;
/// use raypencil_tests::naive::{Fault, Naive};
/// use raypencil_tests::{cells_hit, hit};
///
/// // The wall is at the depth 2 m. The range of an oblique ray is greater, unless the fault reports the depth.
/// let scene = range_cut_wall();
/// for (fault, is_greater) in [(None, true), (Some(Fault::DepthForRange), false)] {
///     let camera = Naive { fault }.render(&scene, &Request::MAPS).camera.unwrap();
///     let (i, j) = cells_hit(&camera)[0];
///     assert_eq!(hit(&camera, i, j).unwrap().range > 2.0, is_greater);
/// }
/// ```
#[derive(Debug, Clone, Copy, Default)]
pub struct Naive {
    /// The fault that is injected, if any.
    pub fault: Option<Fault>,
}

/// Rounding error of a side function, relative to the product of the three lengths.
///
/// Each component of a x b is two products and a difference, 2 u (|a_x b_y| + |a_y b_x|) <= 2 u |a| |b|, so
/// the vector is off by at most 2 sqrt 3 u |a| |b|; the dot product with q adds 3 u |q| |a x b|. That makes
/// 6.5 u |q| |a| |b|, rounded up. The differences a and b are rounded too, but alike in every face: the rays meet
/// a mesh whose vertices are displaced by that rounding, and this mesh has no holes either.
const MAX_SIDE_ERROR: f64 = 8.0 * (f64::EPSILON / 2.0);

/// A camera or a beam, with its pose and its rays.
struct PosedSensor<'a> {
    id: SensorId,
    pose: Pose,
    size: (u32, u32),
    /// Distance of the SPP along the normal axis, f_c or g, metres.
    plane: f64,
    max_range: f64,
    /// Origin and direction of the ray of cell (i, j), sensor frame.
    ray: &'a dyn Fn(u32, u32) -> [DVec3; 2],
}

/// A ray in the scene.
struct SceneRay {
    origin: DVec3,
    /// From the origin to the crossing of the SPP. Not a unit vector.
    q: DVec3,
    /// Whether the ray crosses the SPP right of and below the normal axis.
    is_lower_right: bool,
}

impl Renderer for Naive {
    fn name(&self) -> &str {
        "naive"
    }

    fn precision(&self) -> Precision {
        Precision::F64
    }

    fn render(&self, scene: &Scene, request: &Request) -> RenderOutput {
        let faces = self.faces(scene.mesh());
        let mut stages = Vec::new();
        let mut timed = |sensor: &PosedSensor<'_>| {
            let start = Instant::now();
            let map = self.map(&faces, sensor, request.quantities);
            stages.push(Stage { name: sensor.id.to_string(), time: start.elapsed() });
            map
        };
        let camera = request.camera.then(|| {
            let camera = &scene.camera().sensor;
            timed(&PosedSensor {
                id: SensorId::Camera,
                pose: self.camera_pose(scene.camera().scene_from_sensor),
                size: (camera.width, camera.height),
                plane: camera.focal_length,
                max_range: camera.max_range,
                ray: &|i, j| self.pixel_ray(camera, i, j),
            })
        });
        let mut beams = Vec::new();
        if request.beams {
            for (index, mounted) in scene.beams().iter().enumerate() {
                let beam = &mounted.sensor;
                beams.push(timed(&PosedSensor {
                    id: SensorId::Beam(index),
                    pose: mounted.scene_from_sensor,
                    size: (beam.columns, beam.rows),
                    plane: beam.grid_distance,
                    max_range: beam.max_range,
                    ray: &|i, j| self.pencil_ray(beam, i, j),
                }));
            }
        }
        let (mut returns, mut flux) = (Vec::new(), Vec::new());
        if request.returns {
            for (index, map) in beams.iter().enumerate() {
                let (of_beam, image) = light::returns(self.fault, scene, &faces, index, map);
                returns.push(of_beam);
                flux.push(image);
            }
        }
        RenderOutput { camera, beams, returns, flux, stages }
    }
}

impl Naive {
    /// Whether this fault is injected.
    fn has(&self, fault: Fault) -> bool {
        self.fault == Some(fault)
    }

    /// The three corners of every face.
    fn faces(&self, mesh: &Mesh) -> Vec<[DVec3; 3]> {
        let corner = |index: u32| {
            let [x, y, z] = mesh.vertices()[index as usize];
            let vertex = DVec3::new(f64::from(x), f64::from(y), f64::from(z));
            if self.has(Fault::OriginTakenOffTwice) { vertex - mesh.origin() } else { vertex }
        };
        mesh.faces().iter().map(|face| face.map(corner)).collect()
    }

    /// The pose of the camera.
    fn camera_pose(&self, pose: Pose) -> Pose {
        let rotation =
            if self.has(Fault::CameraPoseConjugated) { conjugate(pose.rotation) } else { pose.rotation };
        Pose { rotation, ..pose }
    }

    /// Column, row and the position of the ray in its cell, as a share from the corner.
    fn sample(&self, i: u32, j: u32, height: u32) -> (f64, f64, f64) {
        let i = if self.has(Fault::ColumnOffByOne) { i + 1 } else { i };
        let j = if self.has(Fault::RowsBottomUp) { height - 1 - j } else { j };
        let middle = if self.has(Fault::HalfCellShift) { 0.0 } else { 0.5 };
        (f64::from(i), f64::from(j), middle)
    }

    /// A pixel's ray: from the projection centre along ((i + 1/2 - c_x) p_x, (j + 1/2 - c_y) p_y, f_c).
    fn pixel_ray(&self, camera: &Camera, i: u32, j: u32) -> [DVec3; 2] {
        let (i, j, middle) = self.sample(i, j, camera.height);
        let [mut centre_x, mut centre_y] = camera.principal_point;
        if self.has(Fault::PrincipalPointRounded) {
            (centre_x, centre_y) = (centre_x.round(), centre_y.round());
        }
        let [mut pitch_x, mut pitch_y] = camera.pixel_pitch;
        if self.has(Fault::PitchesSwapped) {
            (pitch_x, pitch_y) = (pitch_y, pitch_x);
        }
        let x = (i + middle - centre_x) * pitch_x;
        let y = (j + middle - centre_y) * pitch_y;
        [DVec3::ZERO, DVec3::new(x, y, camera.focal_length)]
    }

    /// A pencil's ray: from (0, y_j, 0) on the focal axis along (x_i, 0, g), where x_i = w (2i + 1 - columns) /
    /// columns and y_j = T (2j + 1 - rows) / (2 rows).
    fn pencil_ray(&self, beam: &Beam, i: u32, j: u32) -> [DVec3; 2] {
        let (i, j, middle) = self.sample(i, j, beam.rows);
        let g = beam.grid_distance;
        let (mut half_width, mut half_thickness) = (beam.half_width, 0.5 * beam.thickness);
        if self.has(Fault::FanAndThicknessSwapped) {
            (half_width, half_thickness) = (half_thickness, half_width);
        }
        if self.has(Fault::GridOfWholeFan) {
            // tan(2 a) = 2 tan(a) / (1 - tan(a)^2)
            let tangent = half_width / g;
            half_width = g * 2.0 * tangent / (1.0 - tangent * tangent);
        }
        let (mut columns, rows) = (f64::from(beam.columns), f64::from(beam.rows));
        if self.has(Fault::ColumnsCountedAsRows) {
            columns = rows;
        }
        let x = half_width * (2.0 * (i + middle) - columns) / columns;
        let y = half_thickness * (2.0 * (j + middle) - rows) / rows;
        if self.has(Fault::PencilsFromCentre) {
            return [DVec3::ZERO, DVec3::new(x, y, g)];
        }
        [DVec3::new(0.0, y, 0.0), DVec3::new(x, 0.0, g)]
    }

    /// The vector `p` rotated by `q`.
    fn rotate(&self, q: DQuat, p: DVec3) -> DVec3 {
        rotate(q, p, self.has(Fault::QuaternionTakenAsUnit))
    }

    /// The map of a sensor, cell by cell.
    fn map(&self, faces: &[[DVec3; 3]], sensor: &PosedSensor<'_>, quantities: Quantities) -> SensorMap {
        let (width, height) = sensor.size;
        let mut map = SensorMap::empty(sensor.id, width, height, quantities);
        let faces = self.clipped(faces, sensor);
        for mut row in map.rows_mut() {
            for i in 0..width {
                // The ray, from the sensor into the scene.
                let [start, q] = (sensor.ray)(i, row.j);
                let mut ray = SceneRay {
                    origin: sensor.pose.position + self.rotate(sensor.pose.rotation, start),
                    q: self.rotate(sensor.pose.rotation, q),
                    is_lower_right: q.x > 0.0 && start.y + q.y > 0.0,
                };
                if self.has(Fault::DirectionsInSinglePrecision) {
                    ray.q = ray.q.as_vec3().as_dvec3();
                }
                if let Some((index, t)) = self.first_hit(&faces, sensor, &ray) {
                    let mut hit = self.describe(&faces, sensor, &ray, index, t);
                    if self.has(Fault::TieOfTwoRecords) {
                        let ties = |face: &[DVec3; 3]| self.meets(face, &ray) == Some(t);
                        hit.face = FaceId(faces.iter().rposition(ties).unwrap_or(index) as u32);
                    }
                    row.put(i, &hit);
                }
            }
        }
        map
    }

    /// The faces that a sensor's rays are tested against. None needs to be clipped, because every hit must have
    /// t >= 1. The fault replaces the faces that it loses by faces without area.
    fn clipped(&self, faces: &[[DVec3; 3]], sensor: &PosedSensor<'_>) -> Vec<[DVec3; 3]> {
        if !self.has(Fault::ClipCaseLost) {
            return faces.to_vec();
        }
        let axis = self.rotate(sensor.pose.rotation, DVec3::Z);
        let is_behind = |corner: &&DVec3| axis.dot(**corner - sensor.pose.position) < sensor.plane;
        let one_behind = |face: &[DVec3; 3]| face.iter().filter(is_behind).count() == 1;
        faces.iter().map(|face| if one_behind(face) { [face[0]; 3] } else { *face }).collect()
    }

    /// The nearest hit with t >= 1 and R = t |q| <= the maximum range. Among equals, the face of the lowest index.
    fn first_hit(
        &self,
        faces: &[[DVec3; 3]],
        sensor: &PosedSensor<'_>,
        ray: &SceneRay,
    ) -> Option<(usize, f64)> {
        let min_t = if self.has(Fault::HitsBeforePlane) { 0.0 } else { 1.0 };
        let metres = if self.has(Fault::MaxRangeLimitsDepth) { sensor.plane } else { ray.q.length() };
        let mut best: Option<(usize, f64)> = None;
        for (index, face) in faces.iter().enumerate() {
            let Some(t) = self.meets(face, ray) else { continue };
            if t < min_t || t * metres > sensor.max_range {
                continue;
            }
            if let Some((_, of_best)) = best
                && self.has(Fault::TiesCancel)
                && t == of_best
            {
                best = None;
                continue;
            }
            let is_better = match best {
                None => true,
                Some(_) if self.has(Fault::FirstInOrderWins) => false,
                Some((_, of_best)) if self.has(Fault::FarthestWins) => t > of_best,
                Some((_, of_best)) => t < of_best,
            };
            if is_better {
                best = Some((index, t));
            }
        }
        best
    }

    /// The parameter t at which a ray meets the front of a closed triangle.
    fn meets(&self, &[a, b, c]: &[DVec3; 3], ray: &SceneRay) -> Option<f64> {
        // The front faces the ray: n.q < 0.
        let n = (b - a).cross(c - a);
        let n_dot_q = n.dot(ray.q);
        let faces_ray = if self.has(Fault::BackFacesHit) {
            n_dot_q != 0.0
        } else if self.has(Fault::WindingOfOneQuadrant) && ray.is_lower_right {
            n_dot_q > 0.0
        } else {
            n_dot_q < 0.0
        };
        if !faces_ray || (self.has(Fault::SmallDeterminantsDropped) && n_dot_q.abs() < 1e-6) {
            return None;
        }

        // The ray passes on the inner side of each edge from p to p', or through it: q.(p' x p) >= 0 with corners
        // relative to its origin. For a back face the sign is reversed.
        let mut corners = [a - ray.origin, b - ray.origin, c - ray.origin];
        if self.has(Fault::VerticesInSinglePrecision) {
            corners = corners.map(|corner| corner.as_vec3().as_dvec3());
        }
        let [a, b, c] = corners;
        if self.has(Fault::EdgesComputedApart) {
            let (ab, ac) = (b - a, c - a);
            let p = ray.q.cross(ac);
            let determinant = ab.dot(p);
            let u = -a.dot(p) / determinant;
            let v = ray.q.dot((-a).cross(ab)) / determinant;
            return (u >= 0.0 && v >= 0.0 && u + v <= 1.0).then(|| n.dot(a) / n_dot_q);
        }
        let edges = if n_dot_q < 0.0 { [(a, b), (b, c), (c, a)] } else { [(b, a), (c, b), (a, c)] };
        let sides = edges.map(|(from, to)| ray.q.dot(to.cross(from)));
        for ((from, to), side) in edges.into_iter().zip(sides) {
            let is_inside = if self.has(Fault::EdgesExcluded) {
                side > 0.0
            } else if self.has(Fault::EdgesWidened) {
                side >= -1e-6 * (sides[0] + sides[1] + sides[2])
            } else {
                side >= -MAX_SIDE_ERROR * ray.q.length() * from.length() * to.length()
            };
            if !is_inside {
                return None;
            }
        }

        // The plane of the face: n.(o + t q) = n.a.
        Some(n.dot(a) / n_dot_q)
    }

    /// Every quantity of a hit, each by its definition.
    fn describe(
        &self,
        faces: &[[DVec3; 3]],
        sensor: &PosedSensor<'_>,
        ray: &SceneRay,
        index: usize,
        t: f64,
    ) -> Hit {
        let [a, b, c] = faces[index];
        let n = (b - a).cross(c - a);
        let rotation = sensor.pose.rotation;

        let depth = t * sensor.plane;
        let range = if self.has(Fault::DepthForRange) {
            depth
        } else if self.has(Fault::RangeFromPlane) {
            (t - 1.0) * ray.q.length()
        } else {
            t * ray.q.length()
        };
        let normal = if self.has(Fault::NormalNotNormalised) {
            n
        } else if self.has(Fault::NormalInSensorFrame) {
            self.rotate(conjugate(rotation), n / n.length())
        } else {
            n / n.length()
        };
        let towards =
            if self.has(Fault::IncidenceAgainstAxis) { self.rotate(rotation, DVec3::Z) } else { ray.q };
        Hit {
            face: FaceId(index as u32),
            range,
            point: ray.origin + ray.q * t,
            normal,
            depth,
            cos_incidence: -n.dot(towards) / (n.length() * towards.length()),
        }
    }
}
