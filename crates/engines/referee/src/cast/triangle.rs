//! One face of a mesh, and the conditions under which a ray meets it, as signs of polynomials.

use std::cmp::Ordering;

use glam::DVec3;
use raypencil_scene::{FaceId, Side, Sides, Triangles};

use super::query_ray::{Path, Polynomial, QueryRay, RayNumbers};
use crate::numbers::number::{Dyadic, Interval, Number};
use crate::numbers::vector::Vector;
use crate::trees::bvh::InBox;

/// A face's corners, as stored.
#[derive(Debug, Clone, Copy)]
pub(super) struct Triangle {
    pub(super) id: FaceId,
    pub(super) corners: [DVec3; 3],
}

impl InBox for Triangle {
    #[inline]
    fn id(&self) -> FaceId {
        self.id
    }

    #[inline]
    fn corners(&self) -> [DVec3; 3] {
        self.corners
    }

    #[inline]
    fn middle(&self, axis: usize) -> f64 {
        self.corners.iter().map(|corner| corner[axis]).sum()
    }
}

impl Triangle {
    pub(super) fn of(mesh: &Triangles, id: FaceId) -> Self {
        Self { id, corners: mesh.corners(id) }
    }

    /// Whether the face has an area, exactly. A face without one is never met.
    pub(super) fn has_area(&self) -> bool {
        fn has_normal<T: Number>(face: &Triangle) -> bool {
            face.normal::<T>().0.iter().any(|part| part.sign().is_some_and(Ordering::is_ne))
        }
        has_normal::<Interval>(self) || has_normal::<Dyadic>(self)
    }

    pub(super) fn corner<T: Number>(&self, k: usize) -> Vector<T> {
        Vector::of(self.corners[k % 3])
    }

    /// The normal n, not a unit vector.
    pub(super) fn normal<T: Number>(&self) -> Vector<T> {
        let a = self.corner::<T>(0);
        self.corner(1).sub(&a).cross(&self.corner(2).sub(&a))
    }

    /// n.a'.
    pub(super) fn height<T: Number>(&self, ray: &RayNumbers<T>) -> T {
        self.normal().dot(&self.corner(0).sub(&ray.origin))
    }

    /// n.d.
    pub(super) fn approach<T: Number>(&self, ray: &RayNumbers<T>) -> T {
        self.normal().dot(&ray.direction)
    }

    /// d.(a' x (b - a)) for the edge from corner k.
    pub(super) fn edge<T: Number>(&self, k: usize, ray: &RayNumbers<T>) -> T {
        let (a, b) = (self.corner::<T>(k), self.corner::<T>(k + 1));
        ray.direction.dot(&a.sub(&ray.origin).cross(&b.sub(&a)))
    }

    /// The exact sign of [`Edge`] from corner k: in plain f64 if that is certain.
    #[inline]
    pub(super) fn edge_sign(&self, k: usize, ray: &QueryRay<'_>) -> Ordering {
        ray.certain_side(self.corners, k).unwrap_or_else(|| ray.sign(&Edge { face: self, k }))
    }

    /// The side that the ray meets, edges and corners included, within both ends of the ray; `None` if it does not
    /// meet the face, or on no side that counts.
    pub(super) fn met_side(&self, ray: &QueryRay<'_>, sides: Sides) -> Option<Side> {
        self.met(ray, sides).map(|met| met.side)
    }

    /// How the ray meets the face, as [`met_side`](Self::met_side).
    #[inline]
    pub(super) fn met(&self, ray: &QueryRay<'_>, sides: Sides) -> Option<Met> {
        // The cheapest conditions, and those most likely to fail, come first: edges of both signs are no hit.
        let (mut front, mut back) = (false, false);
        for k in 0..3 {
            match self.edge_sign(k, ray) {
                Ordering::Greater => back = true,
                Ordering::Less => front = true,
                Ordering::Equal => {}
            }
            if back && (front || !sides.include(Side::Back)) {
                return None;
            }
        }
        // The sum of the three is n.d. If all are 0, the face is parallel.
        let (side, towards) = match (front, back) {
            (true, _) => (Side::Front, Ordering::Less),
            (_, true) => (Side::Back, Ordering::Greater),
            _ => return None,
        };
        if let Some(met) = self.certainly_met(side, ray) {
            return met;
        }
        let (height, approach) = self.height_and_approach(ray.fast());
        let beyond = |t: f64| {
            let fast = if t == 0.0 { height } else { height.sub(&approach.mul(&Interval::of(t))) };
            ray.sign_or(fast, &Beyond { face: self, t })
        };
        let from = beyond(ray.t_min());
        if from != towards && from != Ordering::Equal {
            return None;
        }
        if ray.t_max() < f64::INFINITY && beyond(ray.t_max()) == towards {
            return None;
        }
        Some(Met { side, t: height.over(approach) })
    }

    /// How the ray, which passes inside all edges, meets the face, if at all: in plain f64, if both ends of the ray are certain.
    #[inline]
    fn certainly_met(&self, side: Side, ray: &QueryRay<'_>) -> Option<Option<Met>> {
        let t = ray.t_of_plane(self.corners)?;
        if t.low >= ray.t_min() && t.high <= ray.t_max() {
            ray.took(Path::Plane);
            return Some(Some(Met { side, t }));
        }
        if t.high < ray.t_min() || t.low > ray.t_max() {
            ray.took(Path::Plane);
            return Some(None);
        }
        None
    }

    /// n.a' and n.d.
    #[inline]
    fn height_and_approach(&self, ray: &RayNumbers<Interval>) -> (Interval, Interval) {
        let normal = self.normal::<Interval>();
        (normal.dot(&self.corner(0).sub(&ray.origin)), normal.dot(&ray.direction))
    }

    /// Whether the plane is met before this t, exactly; at exactly this t it is not.
    pub(super) fn is_before(&self, t: f64, ray: &QueryRay<'_>) -> bool {
        // The sign of (t_hit - t) n.d against that of n.d.
        let beyond = ray.sign(&Beyond { face: self, t });
        beyond != Ordering::Equal && beyond != ray.sign(&Approach(self))
    }

    /// The side that rays of this direction see; `None` if the face is parallel to them.
    pub(super) fn seen_side(&self, ray: &QueryRay<'_>) -> Option<Side> {
        match ray.sign(&Approach(self)) {
            Ordering::Less => Some(Side::Front),
            Ordering::Greater => Some(Side::Back),
            Ordering::Equal => None,
        }
    }

    /// The order in which the ray meets two faces; it must meet both.
    pub(super) fn compare(&self, other: &Self, ray: &QueryRay<'_>) -> Ordering {
        let product = ray.sign(&Approach(self)) == ray.sign(&Approach(other));
        let nearness = ray.sign(&Nearness { face: self, other });
        if product { nearness } else { nearness.reverse() }
    }
}

/// How a ray meets a face.
#[derive(Debug, Clone, Copy)]
pub(super) struct Met {
    pub(super) side: Side,
    /// What contains t.
    pub(super) t: Interval,
}

/// d.(a' x (b - a)) for the edge from corner k.
pub(super) struct Edge<'a> {
    pub(super) face: &'a Triangle,
    pub(super) k: usize,
}

impl Polynomial for Edge<'_> {
    #[inline]
    fn value<T: Number>(&self, ray: &RayNumbers<T>) -> T {
        self.face.edge(self.k, ray)
    }
}

/// n.d: negative where the front is met.
struct Approach<'a>(&'a Triangle);

impl Polynomial for Approach<'_> {
    fn value<T: Number>(&self, ray: &RayNumbers<T>) -> T {
        self.0.approach(ray)
    }
}

/// n.a' - t n.d = (t_hit - t) n.d: has the sign of n.d where the face is met beyond t.
struct Beyond<'a> {
    face: &'a Triangle,
    t: f64,
}

impl Polynomial for Beyond<'_> {
    fn value<T: Number>(&self, ray: &RayNumbers<T>) -> T {
        self.face.height(ray).sub(&self.face.approach(ray).mul(&T::of(self.t)))
    }
}

/// n.a' n'.d - n'.a'' n.d = (t - t') n.d n'.d.
struct Nearness<'a> {
    face: &'a Triangle,
    other: &'a Triangle,
}

impl Polynomial for Nearness<'_> {
    fn value<T: Number>(&self, ray: &RayNumbers<T>) -> T {
        let first = self.face.height(ray).mul(&self.other.approach(ray));
        first.sub(&self.other.height(ray).mul(&self.face.approach(ray)))
    }
}

#[cfg(test)]
#[path = "../../tests/unit/cast_paths.rs"]
mod tests;
