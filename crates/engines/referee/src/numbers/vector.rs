//! Vectors of any [`Number`], and the rotation by a quaternion without its division.

use glam::{DQuat, DVec3};

use crate::numbers::number::Number;

/// Three coordinates.
#[derive(Debug, Clone)]
pub(crate) struct Vector<T>(pub(crate) [T; 3]);

impl<T: Number> Vector<T> {
    #[inline]
    pub(crate) fn of(v: DVec3) -> Self {
        Self([T::of(v.x), T::of(v.y), T::of(v.z)])
    }

    #[inline]
    pub(crate) fn of_f32([x, y, z]: [f32; 3]) -> Self {
        Self([T::of(f64::from(x)), T::of(f64::from(y)), T::of(f64::from(z))])
    }

    #[inline]
    pub(crate) fn add(&self, other: &Self) -> Self {
        Self(std::array::from_fn(|k| self.0[k].add(&other.0[k])))
    }

    #[inline]
    pub(crate) fn sub(&self, other: &Self) -> Self {
        Self(std::array::from_fn(|k| self.0[k].sub(&other.0[k])))
    }

    #[inline]
    pub(crate) fn scaled(&self, factor: &T) -> Self {
        Self(std::array::from_fn(|k| self.0[k].mul(factor)))
    }

    #[inline]
    pub(crate) fn dot(&self, other: &Self) -> T {
        let product = |k: usize| self.0[k].mul(&other.0[k]);
        product(0).add(&product(1)).add(&product(2))
    }

    #[inline]
    pub(crate) fn cross(&self, other: &Self) -> Self {
        let minor = |k: usize, l: usize| self.0[k].mul(&other.0[l]).sub(&self.0[l].mul(&other.0[k]));
        Self([minor(1, 2), minor(2, 0), minor(0, 1)])
    }

    #[inline]
    pub(crate) fn length_squared(&self) -> T {
        self.0[0].square().add(&self.0[1].square()).add(&self.0[2].square())
    }
}

/// The rotation p -> q p q* as a matrix: a polynomial of the stored quaternion q. It is q . q times the pose's
/// rotation.
#[derive(Debug, Clone)]
pub(crate) struct ScaledRotation<T> {
    rows: [Vector<T>; 3],
    /// q . q: the factor to the pose's rotation.
    pub(crate) norm_squared: T,
}

impl<T: Number> ScaledRotation<T> {
    pub(crate) fn of(q: DQuat) -> Self {
        let [x, y, z, w] = q.to_array().map(T::of);
        let [xx, yy, zz, ww] = [&x, &y, &z, &w].map(T::square);
        let twice = |a: &T, b: &T| a.mul(b).doubled();
        let (xy, xz, yz) = (twice(&x, &y), twice(&x, &z), twice(&y, &z));
        let (wx, wy, wz) = (twice(&w, &x), twice(&w, &y), twice(&w, &z));
        Self {
            rows: [
                Vector([ww.add(&xx).sub(&yy).sub(&zz), xy.sub(&wz), xz.add(&wy)]),
                Vector([xy.add(&wz), ww.sub(&xx).add(&yy).sub(&zz), yz.sub(&wx)]),
                Vector([xz.sub(&wy), yz.add(&wx), ww.sub(&xx).sub(&yy).add(&zz)]),
            ],
            norm_squared: xx.add(&yy).add(&zz).add(&ww),
        }
    }

    /// Its nine numbers row by row, and the factor.
    #[inline]
    pub(crate) fn of_parts([a, b, c, d, e, f, g, h, i, norm_squared]: [T; 10]) -> Self {
        Self { rows: [Vector([a, b, c]), Vector([d, e, f]), Vector([g, h, i])], norm_squared }
    }

    /// The parts of [`Self::of_parts`].
    #[inline]
    pub(crate) fn parts(&self) -> [T; 10] {
        let [[a, b, c], [d, e, f], [g, h, i]] = self.rows.clone().map(|row| row.0);
        [a, b, c, d, e, f, g, h, i, self.norm_squared.clone()]
    }

    #[inline]
    pub(crate) fn apply(&self, v: &Vector<T>) -> Vector<T> {
        Vector(std::array::from_fn(|k| self.rows[k].dot(v)))
    }

    /// Applies the inverse rotation, times the same factor.
    pub(crate) fn apply_inverse(&self, v: &Vector<T>) -> Vector<T> {
        let [a, b, c] = std::array::from_fn(|k| self.rows[k].scaled(&v.0[k]));
        a.add(&b).add(&c)
    }
}
