//! The arithmetic of a program: `f32` or `f64`, and vectors of it.

use std::ops::{Add, Div, Mul, Neg, Sub};

use glam::DVec3;

/// A floating-point number in which a whole program computes.
pub(crate) trait Real:
    Copy
    + PartialOrd
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// u, the largest relative error of one rounding.
    const UNIT_ROUNDOFF: f64;

    fn of(number: f64) -> Self;
    fn to_double(self) -> f64;
    fn sqrt(self) -> Self;
}

impl Real for f64 {
    const UNIT_ROUNDOFF: f64 = f64::EPSILON / 2.0;

    fn of(number: f64) -> Self {
        number
    }

    fn to_double(self) -> f64 {
        self
    }

    fn sqrt(self) -> Self {
        f64::sqrt(self)
    }
}

impl Real for f32 {
    const UNIT_ROUNDOFF: f64 = f32::EPSILON as f64 / 2.0;

    fn of(number: f64) -> Self {
        number as f32
    }

    fn to_double(self) -> f64 {
        f64::from(self)
    }

    fn sqrt(self) -> Self {
        f32::sqrt(self)
    }
}

/// A vector, or a point.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Vector<T>(pub(crate) [T; 3]);

impl<T: Real> Vector<T> {
    pub(crate) fn of(vector: DVec3) -> Self {
        Self(vector.to_array().map(T::of))
    }

    pub(crate) fn plus(self, other: Self) -> Self {
        Self(std::array::from_fn(|k| self.0[k] + other.0[k]))
    }

    pub(crate) fn minus(self, other: Self) -> Self {
        Self(std::array::from_fn(|k| self.0[k] - other.0[k]))
    }

    pub(crate) fn times(self, factor: T) -> Self {
        Self(self.0.map(|part| part * factor))
    }

    pub(crate) fn dot(self, other: Self) -> T {
        self.0[0] * other.0[0] + self.0[1] * other.0[1] + self.0[2] * other.0[2]
    }

    pub(crate) fn cross(self, other: Self) -> Self {
        let ([a, b, c], [x, y, z]) = (self.0, other.0);
        Self([b * z - c * y, c * x - a * z, a * y - b * x])
    }

    pub(crate) fn length(self) -> T {
        self.dot(self).sqrt()
    }
}
