//! Intersection.

use std::cmp::Ordering;

use dashu_int::Sign;

use crate::face::Face;
use crate::number::{Dyadic, Number};
use crate::ray::ScaledRay;
use crate::rounding::{Rounded, quotient, root};
use crate::vector::Vector;

/// A ray and a face's plane, as the values need them.
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
    pub(crate) fn point(&self) -> Vector<T> {
        self.ray.origin.scaled(&self.approach).add(&self.ray.direction.scaled(&self.height))
    }
}

/// The values without any doubt, and slowly.
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

    pub(crate) fn incidence(&self) -> Rounded {
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
