//! The intersection of a ray with a face's plane, as polynomials, and its exact values.
//!
//! With the ray (O, s, D, sigma) of `ray`, h = n.a' and a = n.D of `face`, and k the distance of the SPP:
//!
//! | | | exactly |
//! | --- | --- | --- |
//! | range | R = h / (s a) abs(D) | root of h^2 D^2 / (s a)^2 |
//! | depth | t k, t = h sigma / (s a) | quotient |
//! | point | P = (O a + h D) / (s a) | quotients |
//! | normal | n / abs(n) | roots of n_k^2 / n^2 |
//! | incidence | cos(psi) = -a / (abs(n) abs(D)) | root of a^2 / (n^2 D^2) |

use std::cmp::Ordering;

use dashu_int::Sign;

use crate::hits::face::{Crossing, Face};
use crate::numbers::number::{Dyadic, Number};
use crate::numbers::rounding::{Rounded, quotient, root};
use crate::numbers::vector::Vector;
use crate::rays::ray::ScaledRay;

/// The polynomials of a ray and a face's plane from which all values follow.
#[derive(Debug, Clone)]
pub(crate) struct Intersection<T> {
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

impl<T: Number> Intersection<T> {
    pub(crate) fn new(ray: ScaledRay<T>, face: &Face) -> Self {
        let Crossing { normal, height, approach } = face.crossing(&ray);
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
    pub(crate) fn point(&self) -> Vector<T> {
        self.ray.origin.scaled(&self.approach).add(&self.ray.direction.scaled(&self.height))
    }
}

/// The values by exact arithmetic alone, which is slow.
impl Intersection<Dyadic> {
    pub(crate) fn range(&self) -> Rounded {
        let sign = sign_of(&self.height.mul(&self.scale));
        root(sign, &self.height.square().mul(&self.direction_squared), &self.scale.square())
    }

    pub(crate) fn depth(&self, spp: f64) -> Rounded {
        quotient(&self.height.mul(&self.ray.direction_scale).mul(&Dyadic::of(spp)), &self.scale)
    }

    pub(crate) fn normal_part(&self, k: usize) -> Rounded {
        let part = &self.normal.0[k];
        root(sign_of(part), &part.square(), &self.normal_squared)
    }

    pub(crate) fn cos_incidence(&self) -> Rounded {
        let lengths = self.normal_squared.mul(&self.direction_squared);
        root(sign_of(&minus(&self.approach)), &self.approach.square(), &lengths)
    }
}

/// The sign of `x`, for a root; 0 counts as positive.
pub(crate) fn sign_of(x: &Dyadic) -> Sign {
    if x.sign() == Some(Ordering::Less) { Sign::Negative } else { Sign::Positive }
}

/// -x.
pub(crate) fn minus<T: Number>(x: &T) -> T {
    T::of(0.0).sub(x)
}
