//! Honest renderers: the contract, as four programs compute it that have nothing but rounded numbers.

use glam::DVec3;
use raypencil_referee::aspect;
use raypencil_scene::{FaceId, Pixel, Place, Scene};

use super::real::{Real, Vector};

/// How a program finds the point of a face that a line meets.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Method {
    /// Two edges from the first corner, one determinant. (T. Moeller and B. Trumbore 1997)
    MoellerTrumbore,
    /// Corners sheared along the line, three products in its plane. (S. Woop, C. Benthin and I. Wald 2013)
    Woop,
    /// The point of the plane first, then its side of each edge.
    PlaneThenEdge,
    /// Three volumes that the line spans with the edges; the range from the plane.
    SignedVolumes,
}

impl Method {
    pub(crate) const ALL: [Self; 4] =
        [Self::MoellerTrumbore, Self::Woop, Self::PlaneThenEdge, Self::SignedVolumes];
}

/// A face that a line crosses.
#[derive(Debug, Clone, Copy)]
struct Crossing<T> {
    /// The line is at o + t q.
    t: T,
    is_back: bool,
}

/// What a program says about a pencil.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Answer {
    pub(crate) face: FaceId,
    pub(crate) range: f64,
    pub(crate) visible: bool,
    pub(crate) pixel: Option<Pixel>,
}

/// One program in one arithmetic.
pub(crate) struct Program<T> {
    method: Method,
    corners: Vec<[Vector<T>; 3]>,
    aspects: Vec<f64>,
    /// Times what rounding explains: how near the point a face's plane is taken to contain it.
    slack: f64,
}

/// Roundings by which a hit point may seem to be off a face's plane that contains it, metres per u S: those that grow with the
/// aspect of the face that is hit, of the other face, and the rest.
const ROUNDINGS_OF_HIT: f64 = 10.0;
const ROUNDINGS_OF_OTHER: f64 = 5.0;
const OTHER_ROUNDINGS: f64 = 51.0;

impl<T: Real> Program<T> {
    pub(crate) fn new(scene: &Scene, method: Method, slack: f64) -> Self {
        let mesh = scene.mesh();
        let corner = |v: u32| Vector(mesh.vertices()[v as usize].map(|part| T::of(f64::from(part))));
        let corners: Vec<_> = mesh.faces().iter().map(|face| face.map(corner)).collect();
        let in_doubles = |corner: Vector<T>| DVec3::from_array(corner.0.map(Real::to_double));
        let aspects = corners.iter().map(|face| aspect(face.map(in_doubles))).collect();
        Self { method, corners, aspects, slack }
    }

    /// The first hit of a ray, and t.
    fn first_hit(&self, o: Vector<T>, q: Vector<T>, max_range: f64) -> Option<(usize, T)> {
        let (one, most) = (T::of(1.0), T::of(max_range));
        let length = q.length();
        let mut first: Option<(usize, T)> = None;
        for (index, corners) in self.corners.iter().enumerate() {
            let Some(Crossing { t, is_back: false }) = self.crosses(corners, o, q) else { continue };
            if t >= one && t * length <= most && first.is_none_or(|(_, nearest)| t < nearest) {
                first = Some((index, t));
            }
        }
        first
    }

    /// What the program says about a ray of a sensor: the face that it meets and the range.
    pub(crate) fn hit(&self, scene: &Scene, place: Place) -> Option<(FaceId, f64)> {
        let ray = scene.ray(place.sensor, place.i, place.j)?;
        let (o, q) = (Vector::<T>::of(ray.origin), Vector::<T>::of(ray.direction));
        let (index, t) = self.first_hit(o, q, scene.max_range(place.sensor)?)?;
        Some((FaceId(index as u32), (t * q.length()).to_double()))
    }

    /// What the program says about a pencil.
    pub(crate) fn answer(&self, scene: &Scene, place: Place) -> Option<Answer> {
        let ray = scene.ray(place.sensor, place.i, place.j)?;
        let (o, q) = (Vector::<T>::of(ray.origin), Vector::<T>::of(ray.direction));
        let (index, t) = self.first_hit(o, q, scene.max_range(place.sensor)?)?;
        let point = o.plus(q.times(t));
        let mounted = scene.camera();
        let (pose, camera) = (mounted.scene_from_sensor, &mounted.sensor);
        let centre = Vector::<T>::of(pose.position);
        let to_point = point.minus(centre);
        // The rows of the rotation into the camera's frame are the camera's axes.
        let axis = |k: DVec3| Vector::<T>::of(pose.rotate(k)).dot(to_point);
        let [x, y, z] = [DVec3::X, DVec3::Y, DVec3::Z].map(axis);
        let focal = T::of(camera.focal_length);
        let at = |across: T, k: usize| {
            focal * across / z / T::of(camera.pixel_pitch[k]) + T::of(camera.principal_point[k])
        };
        let [i, j] = [at(x, 0), at(y, 1)].map(Real::to_double);
        let is_on = |at: f64, size: u32| at >= 0.0 && at < f64::from(size);
        let lands = z > focal && is_on(i, camera.width) && is_on(j, camera.height);
        let pixel = lands.then_some(Pixel { i: i as u32, j: j as u32 });
        let [a, b, c] = self.corners[index];
        let normal = b.minus(a).cross(c.minus(a));
        let faces_camera = normal.dot(centre.minus(point)) > T::of(0.0);
        let size =
            (point.minus(o).length() + b.minus(a).length() + c.minus(b).length() + o.length()).to_double();
        let visible = lands && faces_camera && !self.is_hidden(index, point, centre, focal / z, size);
        Some(Answer { face: FaceId(index as u32), range: (t * q.length()).to_double(), visible, pixel })
    }

    /// Whether a face is between the camera and a point: a shadow ray from the point on.
    fn is_hidden(&self, own: usize, point: Vector<T>, centre: Vector<T>, image_plane: T, size: f64) -> bool {
        let way = centre.minus(point);
        let end = T::of(1.0) - image_plane;
        self.corners.iter().enumerate().any(|(index, corners)| {
            index != own
                && self.crosses(corners, point, way).is_some_and(|Crossing { t, .. }| {
                    t > T::of(0.0) && t <= end && !self.contains([own, index], point, size)
                })
        })
    }

    /// Whether a point may lie on a face's plane.
    fn contains(&self, [own, other]: [usize; 2], point: Vector<T>, size: f64) -> bool {
        let [a, b, c] = self.corners[other];
        if self.slack == 0.0 {
            return false;
        }
        let normal = b.minus(a).cross(c.minus(a));
        let apart = (normal.dot(point.minus(a)) / normal.length()).to_double().abs();
        let roundings =
            ROUNDINGS_OF_HIT * self.aspects[own] + ROUNDINGS_OF_OTHER * self.aspects[other] + OTHER_ROUNDINGS;
        apart <= self.slack * roundings * T::UNIT_ROUNDOFF * size
    }

    /// Where a line crosses a face, from either side.
    fn crosses(&self, corners: &[Vector<T>; 3], o: Vector<T>, q: Vector<T>) -> Option<Crossing<T>> {
        match self.method {
            Method::MoellerTrumbore => moeller_trumbore(corners, o, q),
            Method::Woop => woop(corners, o, q),
            Method::PlaneThenEdge => plane_then_edge(corners, o, q),
            Method::SignedVolumes => signed_volumes(corners, o, q),
        }
    }
}

fn is_on_one_side<T: Real>(sides: [T; 3]) -> bool {
    let zero = T::of(0.0);
    sides.iter().all(|side| *side >= zero) || sides.iter().all(|side| *side <= zero)
}

fn moeller_trumbore<T: Real>(&[a, b, c]: &[Vector<T>; 3], o: Vector<T>, q: Vector<T>) -> Option<Crossing<T>> {
    let (e1, e2) = (b.minus(a), c.minus(a));
    let p = q.cross(e2);
    // -n.q.
    let determinant = e1.dot(p);
    let zero = T::of(0.0);
    if determinant == zero {
        return None;
    }
    let from = o.minus(a);
    let u = from.dot(p) / determinant;
    let r = from.cross(e1);
    let v = q.dot(r) / determinant;
    let is_inside = u >= zero && v >= zero && u + v <= T::of(1.0);
    is_inside.then(|| Crossing { t: e2.dot(r) / determinant, is_back: determinant < zero })
}

fn woop<T: Real>(corners: &[Vector<T>; 3], o: Vector<T>, q: Vector<T>) -> Option<Crossing<T>> {
    let zero = T::of(0.0);
    let magnitude = |k: usize| if q.0[k] < zero { -q.0[k] } else { q.0[k] };
    let z = (0..3).fold(0, |best, k| if magnitude(k) > magnitude(best) { k } else { best });
    let (mut x, mut y) = ((z + 1) % 3, (z + 2) % 3);
    if q.0[z] < zero {
        (x, y) = (y, x);
    }
    let shear = [q.0[x] / q.0[z], q.0[y] / q.0[z], T::of(1.0) / q.0[z]];
    let sheared = corners.map(|corner| {
        let from = corner.minus(o).0;
        [from[x] - shear[0] * from[z], from[y] - shear[1] * from[z], shear[2] * from[z]]
    });
    let [a, b, c] = sheared;
    let sides = [c[0] * b[1] - c[1] * b[0], a[0] * c[1] - a[1] * c[0], b[0] * a[1] - b[1] * a[0]];
    let determinant = sides[0] + sides[1] + sides[2];
    if !is_on_one_side(sides) || determinant == zero {
        return None;
    }
    let t = (sides[0] * a[2] + sides[1] * b[2] + sides[2] * c[2]) / determinant;
    Some(Crossing { t, is_back: determinant < zero })
}

fn plane_then_edge<T: Real>(&[a, b, c]: &[Vector<T>; 3], o: Vector<T>, q: Vector<T>) -> Option<Crossing<T>> {
    let normal = b.minus(a).cross(c.minus(a));
    let (approach, zero) = (normal.dot(q), T::of(0.0));
    if approach == zero {
        return None;
    }
    let t = normal.dot(a.minus(o)) / approach;
    let point = o.plus(q.times(t));
    let sides =
        [(a, b), (b, c), (c, a)].map(|(from, to)| normal.dot(to.minus(from).cross(point.minus(from))));
    sides.iter().all(|side| *side >= zero).then_some(Crossing { t, is_back: approach > zero })
}

fn signed_volumes<T: Real>(corners: &[Vector<T>; 3], o: Vector<T>, q: Vector<T>) -> Option<Crossing<T>> {
    let [a, b, c] = corners.map(|corner| corner.minus(o));
    let sides = [(a, b), (b, c), (c, a)].map(|(from, to)| q.dot(from.cross(to)));
    if !is_on_one_side(sides) {
        return None;
    }
    let normal = corners[1].minus(corners[0]).cross(corners[2].minus(corners[0]));
    let (approach, zero) = (normal.dot(q), T::of(0.0));
    (approach != zero).then(|| Crossing { t: normal.dot(a) / approach, is_back: approach > zero })
}
