//! Line of sight from the camera to a point of a pencil's hit, as polynomials: the contract's conditions for
//! visibility, and the pixel.
//!
//! With the pencil's ray (O, s, D, sigma) and the face it meets, P = O / s + (n.a' / (s n.D)) D. Multiplied by W = -s
//! n.D > 0 it is polynomial, and so is the vector to it from the projection centre c:
//!
//! ```text
//! V = W (P - c) = -(O n.D + n.a' D) - W c
//! ```
//!
//! (For the plane of a face that shows the ray its back, which a renderer may name, W and V have the other sign.)
//!
//! With M^T V = (X, Y, Z) in the camera's frame, which is N W times metres, and a' = a - c for another face:
//!
//! | condition | as a sign |
//! | --- | --- |
//! | the camera is on the front side of the face | n.V < 0 |
//! | the point is beyond the focal length | Z - f N W > 0 |
//! | it lands right of the border at column k, or on it | f X - (k - c_x) p_x Z >= 0 |
//! | the segment passes between the other face's sides | all V.(a' x (b - a)) <= 0, or all >= 0 |
//! | the other face is met before the point, u < 1 | n.a' W - n.V has the sign opposite to n.V |
//! | at or beyond the image plane, u >= f / r | n.a' Z - f N n.V is 0 or has the sign of n.V |
//!
//! A face that contains P has u = 1. So neither the face that is hit, nor one that ties with it, nor a back at the
//! same point hides P.

use std::cell::OnceCell;
use std::cmp::Ordering;

use glam::DVec3;
use raypencil_scene::{Camera, Mounted, Pixel};

use crate::hits::edge_filter::EdgeFilter;
use crate::hits::face::{Crossing, ExactRay, Face};
use crate::numbers::number::{Dyadic, Interval, Number};
use crate::numbers::rounding;
use crate::numbers::vector::{ScaledRotation, Vector};
use crate::rays::ray::{Aim, MountedSensor, ScaledRay};
use crate::trees::bvh::{InBox, RayBundle};

/// The line of sight from the camera to a point, as polynomials.
#[derive(Debug, Clone)]
pub(crate) struct LineOfSight<T> {
    /// c, the projection centre.
    centre: Vector<T>,
    /// V.
    pub(crate) direction: Vector<T>,
    /// W.
    pub(crate) scale: T,
    /// (X, Y, Z).
    pub(crate) in_camera: Vector<T>,
    /// N.
    pub(crate) frame_scale: T,
    /// f N.
    focal: T,
}

impl<T: Number> LineOfSight<T> {
    pub(crate) fn new(ray: &ScaledRay<T>, face: &Face, camera: &Mounted<Camera>, is_back: bool) -> Self {
        let pose = camera.scene_from_sensor;
        let (centre, rotation) = (Vector::of(pose.position), ScaledRotation::<T>::of(pose.rotation));
        let Crossing { approach, height, .. } = face.crossing(ray);
        let minus_scale = approach.mul(&ray.origin_scale);
        // V = -(O n.D + n.a' D) + s n.D c.
        let point = ray.origin.scaled(&approach).add(&ray.direction.scaled(&height));
        let (direction, scale) = if is_back {
            (point.sub(&centre.scaled(&minus_scale)), minus_scale)
        } else {
            (centre.scaled(&minus_scale).sub(&point), T::of(0.0).sub(&minus_scale))
        };
        let in_camera = rotation.apply_inverse(&direction);
        let focal = T::of(camera.sensor.focal_length).mul(&rotation.norm_squared);
        Self { centre, direction, scale, in_camera, focal, frame_scale: rotation.norm_squared }
    }
}

impl LineOfSight<Interval> {
    /// The parts of the line to the plane of `face` as a function of the displacement from an aim, which is bilinear:
    /// V = V_0 + V_1 dx + V_2 dy + V_3 dx dy, and W and (X, Y, Z) likewise. Every [`LinePolynomial`] is linear in
    /// them, so its values for the four parts are the coefficients of its form.
    pub(crate) fn parts(
        sensor: &MountedSensor,
        aim: Aim,
        face: &Face,
        camera: &Mounted<Camera>,
    ) -> [Self; 4] {
        type I = Interval;
        let ray = sensor.ray::<I>(aim);
        let [across, down] = sensor.steps::<I>();
        let pose = camera.scene_from_sensor;
        let (centre, rotation) = (Vector::<I>::of(pose.position), ScaledRotation::<I>::of(pose.rotation));
        let focal = I::of(camera.sensor.focal_length).mul(&rotation.norm_squared);
        let crossing = face.crossing(&ray);
        let normal = &crossing.normal;
        // O - s c and n.a' with their slopes in dy, D and n.D with theirs in dx.
        let start = [ray.origin.sub(&centre.scaled(&ray.origin_scale)), down.clone()];
        let height = [crossing.height, normal.dot(&down).negated()];
        let approach = [crossing.approach, normal.dot(&across)];
        let ray_direction = [ray.direction.clone(), across];
        [0, 1, 2, 3].map(|part: usize| {
            let (x, y) = (part & 1, part >> 1);
            let minus = start[y].scaled(&approach[x]).add(&ray_direction[x].scaled(&height[y]));
            let direction = Vector(minus.0.map(Interval::negated));
            let scale = match y {
                0 => ray.origin_scale.mul(&approach[x]).negated(),
                _ => I::of(0.0),
            };
            let in_camera = rotation.apply_inverse(&direction);
            Self {
                centre: centre.clone(),
                direction,
                scale,
                in_camera,
                frame_scale: rotation.norm_squared,
                focal,
            }
        })
    }

    /// The coefficients of the landing conditions: the point lies beyond the focal length and within each border of
    /// the image. It lands if all are positive; 0 suffices at the left and upper borders alone.
    pub(crate) fn lands(parts: &[Self; 4], camera: &Camera) -> [[Interval; 4]; 5] {
        let border = |axis: usize, border: u32| {
            let border = Border { camera, axis, border };
            [0, 1, 2, 3].map(|part: usize| border.value(&parts[part]))
        };
        let before = |coefficients: [Interval; 4]| coefficients.map(Interval::negated);
        [
            [0, 1, 2, 3].map(|part: usize| BeyondFocal.value(&parts[part])),
            border(0, 0),
            before(border(0, camera.width)),
            border(1, 0),
            before(border(1, camera.height)),
        ]
    }

    /// f N.
    pub(crate) fn focal(&self) -> Interval {
        self.focal
    }

    /// c.
    pub(crate) fn centre(&self) -> &Vector<Interval> {
        &self.centre
    }
}

/// A polynomial of a line of sight, of which only the sign matters.
trait LinePolynomial {
    fn value<T: Number>(&self, line: &LineOfSight<T>) -> T;
}

/// A line of sight in both numbers; the exact one is formed when it is first needed.
pub(crate) struct ExactLineOfSight<'a> {
    ray: &'a ExactRay<'a>,
    face: &'a Face,
    camera: &'a Mounted<Camera>,
    /// Whether the ray comes from behind the face: W has the other sign then.
    is_back: bool,
    fast: LineOfSight<Interval>,
    exact: OnceCell<LineOfSight<Dyadic>>,
    filter: EdgeFilter,
}

impl<'a> ExactLineOfSight<'a> {
    /// The line to the point where `ray` meets `face`; it must meet it.
    pub(crate) fn new(ray: &'a ExactRay<'a>, face: &'a Face, camera: &'a Mounted<Camera>) -> Self {
        let is_back = face.shows_back_to(ray);
        let fast = LineOfSight::new(ray.fast(), face, camera, is_back);
        let filter = EdgeFilter::new(&ScaledRay {
            origin: fast.centre.clone(),
            origin_scale: Interval::of(1.0),
            direction: fast.direction.clone(),
            direction_scale: fast.scale,
        });
        Self { ray, face, camera, is_back, fast, exact: OnceCell::new(), filter }
    }

    /// The line without rounding.
    pub(crate) fn exact(&self) -> &LineOfSight<Dyadic> {
        self.exact.get_or_init(|| LineOfSight::new(self.ray.exact(), self.face, self.camera, self.is_back))
    }

    #[inline]
    fn sign(&self, question: &impl LinePolynomial) -> Ordering {
        match question.value(&self.fast).sign() {
            Some(sign) => sign,
            None => self.exact_sign(question),
        }
    }

    #[cold]
    fn exact_sign(&self, question: &impl LinePolynomial) -> Ordering {
        question.value(self.exact()).sign().unwrap_or(Ordering::Equal)
    }

    /// Whether the camera is on the front side of the face that is hit.
    pub(crate) fn is_front_seen(&self) -> bool {
        self.sign(&Facing(self.face)) == Ordering::Less
    }

    /// The pixel in which the point lands, if any.
    pub(crate) fn pixel(&self) -> Option<Pixel> {
        if self.sign(&BeyondFocal) != Ordering::Greater {
            return None;
        }
        let size = [self.camera.sensor.width, self.camera.sensor.height];
        let [i, j] = [0, 1].map(|axis: usize| {
            let is_at_or_after = |border: u32| {
                let border = Border { camera: &self.camera.sensor, axis, border };
                self.sign(&border) != Ordering::Less
            };
            if !is_at_or_after(0) || is_at_or_after(size[axis]) {
                return None;
            }
            // Start at the index in f64, and step to the exact one.
            let mut index = (self.landing()[axis].max(0.0) as u32).min(size[axis] - 1);
            while !is_at_or_after(index) {
                index -= 1;
            }
            while is_at_or_after(index + 1) {
                index += 1;
            }
            Some(index)
        });
        Some(Pixel { i: i?, j: j? })
    }

    /// The point's image in pixels, to f64 rounding.
    pub(crate) fn landing(&self) -> [f64; 2] {
        let camera = &self.camera.sensor;
        let [x, y, z] = [0, 1, 2].map(|k: usize| self.fast.in_camera.0[k].middle());
        let at = |part: f64, axis: usize| {
            camera.focal_length * part / z / camera.pixel_pitch[axis] + camera.principal_point[axis]
        };
        [at(x, 0), at(y, 1)]
    }

    /// The distance of the point's image from the nearest border of its pixel, pixels: an interval.
    pub(crate) fn border_distance(&self, pixel: Pixel) -> [f64; 2] {
        let (line, camera) = (self.exact(), &self.camera.sensor);
        let least = [(0, pixel.i), (1, pixel.j)]
            .into_iter()
            .flat_map(|(axis, index)| [(axis, index), (axis, index + 1)])
            .map(|(axis, border)| {
                let across = Border { camera, axis, border }.value(line);
                let per_pixel = Dyadic::of(camera.pixel_pitch[axis]).mul(&line.in_camera.0[2]);
                rounding::quotient(&across, &per_pixel).double.abs()
            })
            .fold(f64::INFINITY, f64::min);
        // Each quotient is correct to 2^-53 of itself, and so is the least of them.
        let off = f64::EPSILON;
        [least * (1.0 - off), least * (1.0 + off)]
    }

    /// P - c, to f64 rounding, metres.
    pub(crate) fn centre_to_point(&self) -> DVec3 {
        let [x, y, z] = [0, 1, 2].map(|k: usize| self.fast.direction.0[k].middle());
        DVec3::new(x, y, z) / self.fast.scale.middle()
    }

    /// r, to f64 rounding, metres.
    pub(crate) fn depth(&self) -> f64 {
        let line = &self.fast;
        line.in_camera.0[2].middle() / (line.frame_scale.middle() * line.scale.middle())
    }

    /// Whether `other` meets the segment from the point to the image plane.
    pub(crate) fn is_hidden_by(&self, other: &Face) -> bool {
        // The point lies in its own plane, so the same triangle again never lies before it.
        if other.corners == self.face.corners || self.filter.passes_beside(other.corners()) {
            return false;
        }
        let facing = self.sign(&Facing(other));
        if facing == Ordering::Equal {
            return false;
        }
        // The line is on the inner side of every edge, as seen from the side that faces the camera.
        let outer = facing.reverse();
        (0..3).all(|k| self.sign(&Side { face: other, k }) != outer)
            && self.sign(&Before(other)) == outer
            && self.sign(&AtOrBeyondImage(other)) != outer
    }

    /// The ray bundle of the segment, for the hierarchy.
    pub(crate) fn bundle(&self) -> RayBundle {
        let along = self.centre_to_point();
        let length = along.length();
        RayBundle {
            origin: self.camera.scene_from_sensor.position,
            direction: along / length,
            // Covers a dozen roundings of 2^-53 each; the hierarchy has its own slack.
            max_range: length * (1.0 + 64.0 * f64::EPSILON),
            start_radius: 0.0,
            spread: 0.0,
        }
    }
}

/// n.V.
struct Facing<'a>(&'a Face);

impl LinePolynomial for Facing<'_> {
    fn value<T: Number>(&self, line: &LineOfSight<T>) -> T {
        self.0.normal().dot(&line.direction)
    }
}

/// Z - f N W.
struct BeyondFocal;

impl LinePolynomial for BeyondFocal {
    fn value<T: Number>(&self, line: &LineOfSight<T>) -> T {
        line.in_camera.0[2].sub(&line.focal.mul(&line.scale))
    }
}

/// f X - (k - c_x) p_x Z, or the same in y.
struct Border<'a> {
    camera: &'a Camera,
    axis: usize,
    border: u32,
}

impl LinePolynomial for Border<'_> {
    fn value<T: Number>(&self, line: &LineOfSight<T>) -> T {
        let from_centre = T::of_integer(self.border).sub(&T::of(self.camera.principal_point[self.axis]));
        let metres = from_centre.mul(&T::of(self.camera.pixel_pitch[self.axis]));
        let across = T::of(self.camera.focal_length).mul(&line.in_camera.0[self.axis]);
        across.sub(&metres.mul(&line.in_camera.0[2]))
    }
}

/// V.(a' x (b - a)) for the edge from corner k.
struct Side<'a> {
    face: &'a Face,
    k: usize,
}

impl LinePolynomial for Side<'_> {
    #[inline]
    fn value<T: Number>(&self, line: &LineOfSight<T>) -> T {
        let (a, b) = (self.face.corner::<T>(self.k), self.face.corner::<T>((self.k + 1) % 3));
        line.direction.dot(&a.sub(&line.centre).cross(&b.sub(&a)))
    }
}

/// n.a' W - n.V.
struct Before<'a>(&'a Face);

impl LinePolynomial for Before<'_> {
    fn value<T: Number>(&self, line: &LineOfSight<T>) -> T {
        let n = self.0.normal::<T>();
        let height = n.dot(&self.0.corner(0).sub(&line.centre));
        height.mul(&line.scale).sub(&n.dot(&line.direction))
    }
}

/// n.a' Z - f N n.V.
struct AtOrBeyondImage<'a>(&'a Face);

impl LinePolynomial for AtOrBeyondImage<'_> {
    fn value<T: Number>(&self, line: &LineOfSight<T>) -> T {
        let n = self.0.normal::<T>();
        let height = n.dot(&self.0.corner(0).sub(&line.centre));
        height.mul(&line.in_camera.0[2]).sub(&line.focal.mul(&n.dot(&line.direction)))
    }
}
