//! What a ray meets, as values that are correctly rounded to f64 and to f32.
//!
//! With the ray (O, s, D, sigma) of `pencil`, h = n.a' and a = n.D of `face`, and k the distance of the SPP:
//!
//! | | | exactly |
//! | --- | --- | --- |
//! | range | R = h / (s a) abs(D) | root of h^2 D^2 / (s a)^2 |
//! | depth | t k, t = h sigma / (s a) | quotient |
//! | point | P = (O a + h D) / (s a) | quotients |
//! | normal | n / abs(n) | roots of n_k^2 / n^2 |
//! | incidence | cos(psi) = -a / (abs(n) abs(D)) | root of a^2 / (n^2 D^2) |
//!
//! Each is first evaluated in pairs of f64 with a proven error; where that does not decide the rounding, the
//! exact polynomials do (`rounding`).

use std::cell::OnceCell;
use std::cmp::Ordering;

use dashu_int::Sign;
use glam::DVec3;
use raypencil_scene::{FaceId, Hit, Mounted};

use crate::face::{ExactRay, Face};
use crate::number::{Dyadic, Number};
use crate::pencil::{Aim, ScaledRay, Sensor};
use crate::rounding::{Format, Rounded, quotient, root};
use crate::twofold::Twofold;
use crate::vector::Vector;

/// A [`Hit`] whose values are correctly rounded.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RoundedHit {
    /// The face.
    pub face: FaceId,
    /// Distance from the ray's origin along the ray, metres.
    pub range: Rounded,
    /// The point, scene frame, metres.
    pub point: [Rounded; 3],
    /// The unit normal, scene frame.
    pub normal: [Rounded; 3],
    /// Distance along the sensor's normal axis, metres.
    pub depth: Rounded,
    /// cos(psi).
    pub incidence: Rounded,
}

impl RoundedHit {
    /// The nearest numbers of a format.
    pub fn in_format(&self, format: Format) -> Hit {
        let of = |rounded: Rounded| rounded.in_format(format);
        Hit {
            face: self.face,
            range: of(self.range),
            point: DVec3::from_array(self.point.map(of)),
            normal: DVec3::from_array(self.normal.map(of)),
            depth: of(self.depth),
            incidence: of(self.incidence),
        }
    }
}

/// A ray and a face's plane, as the values need them.
#[derive(Debug, Clone)]
pub(crate) struct Meeting<T> {
    pub(crate) ray: ScaledRay<T>,
    pub(crate) normal: Vector<T>,
    /// h.
    pub(crate) height: T,
    /// a.
    pub(crate) approach: T,
    /// s a.
    pub(crate) scale: T,
    /// D^2.
    pub(crate) direction_squared: T,
    /// n^2.
    pub(crate) normal_squared: T,
}

impl<T: Number> Meeting<T> {
    pub(crate) fn new(ray: ScaledRay<T>, face: &Face) -> Self {
        let (normal, height, approach) = (face.normal::<T>(), face.height(&ray), face.approach(&ray));
        Self {
            scale: ray.origin_scale.mul(&approach),
            direction_squared: ray.direction.length_squared(),
            normal_squared: normal.length_squared(),
            ray,
            normal,
            height,
            approach,
        }
    }

    /// s a P.
    fn point(&self) -> Vector<T> {
        self.ray.origin.scaled(&self.approach).add(&self.ray.direction.scaled(&self.height))
    }
}

/// The values without any doubt, and slowly.
impl Meeting<Dyadic> {
    fn range(&self) -> Rounded {
        let sign = sign_of(&self.height.mul(&self.scale));
        root(sign, &self.height.square().mul(&self.direction_squared), &self.scale.square())
    }

    fn depth(&self, spp: f64) -> Rounded {
        quotient(&self.height.mul(&self.ray.direction_scale).mul(&Dyadic::of(spp)), &self.scale)
    }

    fn normal_part(&self, k: usize) -> Rounded {
        let part = &self.normal.0[k];
        root(sign_of(part), &part.square(), &self.normal_squared)
    }

    fn incidence(&self) -> Rounded {
        let lengths = self.normal_squared.mul(&self.direction_squared);
        root(sign_of(&minus(&self.approach)), &self.approach.square(), &lengths)
    }
}

/// The sign of a root with the sign of `x`.
pub(crate) fn sign_of(x: &Dyadic) -> Sign {
    if x.sign() == Some(Ordering::Less) { Sign::Negative } else { Sign::Positive }
}

/// Minus a number.
pub(crate) fn minus<T: Number>(x: &T) -> T {
    T::of(0.0).sub(x)
}

/// Where the ray of an aim meets the plane of `face`, whether or not it passes between its sides; `None` if they are
/// parallel, or the face has no area.
pub(crate) fn values(sensor: &Sensor, aim: Aim, face: &Face) -> Option<RoundedHit> {
    let fast = Meeting::new(sensor.ray::<Twofold>(aim), face);
    let exact_ray = ExactRay::new(sensor, aim);
    let exact = OnceCell::new();
    let exact = || exact.get_or_init(|| Meeting::new(exact_ray.exact().clone(), face));
    if fast.approach.sign().is_none_or(Ordering::is_eq) && exact().approach.sign() == Some(Ordering::Equal) {
        return None;
    }

    let spp = match sensor {
        Sensor::Camera(Mounted { sensor, .. }) => sensor.focal_length,
        Sensor::Beam(Mounted { sensor, .. }) => sensor.grid_distance,
    };
    let along = fast.height.over(&fast.scale);
    let length = fast.direction_squared.sqrt();
    let range = along.mul(&length).rounded().unwrap_or_else(|| exact().range());
    let depth_per_length = fast.ray.direction_scale.mul(&Twofold::of(spp));
    let depth = along.mul(&depth_per_length).rounded().unwrap_or_else(|| exact().depth(spp));
    let point = fast.point();
    let exact_point = OnceCell::new();
    let point = [0, 1, 2].map(|k: usize| {
        point.0[k].over(&fast.scale).rounded().unwrap_or_else(|| {
            let point = exact_point.get_or_init(|| exact().point());
            quotient(&point.0[k], &exact().scale)
        })
    });
    let normal_length = fast.normal_squared.sqrt();
    let normal = [0, 1, 2].map(|k: usize| {
        fast.normal.0[k].over(&normal_length).rounded().unwrap_or_else(|| exact().normal_part(k))
    });
    let towards = minus(&fast.approach).over(&normal_length.mul(&length));
    let incidence = towards.rounded().unwrap_or_else(|| exact().incidence());
    Some(RoundedHit { face: face.id, range, point, normal, depth, incidence })
}

#[cfg(test)]
#[path = "../tests/unit/values.rs"]
mod tests;
