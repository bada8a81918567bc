//! The contract's conditions on one ray and one face, as signs of polynomials.
//!
//! With a' = s a - O for a vertex a (which is s (a - o)) and n = (b - a) x (c - a):
//!
//! * the ray passes on the inner side of the edge from a to b, or on it: D.(a' x b') <= 0
//! * the ray meets the front: n.D < 0
//! * t = sigma n.a' / (s n.D), so t >= 1 is sigma n.a' <= s n.D (both negative)
//! * R = n.a' |D| / (s n.D), so R <= M is (n.a')^2 |D|^2 <= (M s n.D)^2
//! * t < t' is n.a' n'.D < n'.a'' n.D (each the product of two negative numbers)
//!
//! a' x b' is evaluated as a' x s (b - a), whose terms are smaller where the edge is short.

use std::cell::OnceCell;
use std::cmp::Ordering;

use glam::DVec3;
use raypencil_scene::{FaceId, Mesh};

use crate::hits::edge_filter::{EdgeFilter, Passes};
use crate::numbers::number::{Dyadic, Interval, Number};
use crate::numbers::vector::Vector;
use crate::rays::ray::{Aim, MountedSensor, ScaledRay};
use crate::trees::bvh::InBox;

/// A polynomial of a ray, of which only the sign matters.
trait Polynomial {
    fn value<T: Number>(&self, ray: &ScaledRay<T>) -> T;
}

/// One ray in both numbers; the exact one is formed when it is first needed.
pub(crate) struct ExactRay<'a> {
    sensor: &'a MountedSensor,
    aim: Aim,
    fast: ScaledRay<Interval>,
    filter: EdgeFilter,
    exact: OnceCell<ScaledRay<Dyadic>>,
}

impl<'a> ExactRay<'a> {
    pub(crate) fn new(sensor: &'a MountedSensor, aim: Aim) -> Self {
        let fast = sensor.ray(aim);
        Self { sensor, aim, filter: EdgeFilter::new(&fast), fast, exact: OnceCell::new() }
    }

    /// The ray in intervals.
    pub(crate) fn fast(&self) -> &ScaledRay<Interval> {
        &self.fast
    }

    /// The range at which the ray begins, at its cell's centre: t = 1, metres, to f64 rounding.
    pub(crate) fn start_range(&self) -> f64 {
        self.fast.direction.length_squared().middle().sqrt() / self.fast.direction_scale.middle()
    }

    /// The ray without rounding.
    pub(crate) fn exact(&self) -> &ScaledRay<Dyadic> {
        self.exact.get_or_init(|| self.sensor.ray(self.aim))
    }

    /// The exact sign: by the interval if that is certain, else by exact arithmetic.
    #[inline]
    fn sign(&self, polynomial: &impl Polynomial) -> Ordering {
        match polynomial.value(&self.fast).sign() {
            Some(sign) => sign,
            None => self.exact_sign(polynomial),
        }
    }

    #[cold]
    fn exact_sign(&self, polynomial: &impl Polynomial) -> Ordering {
        polynomial.value(self.exact()).sign().unwrap_or(Ordering::Equal)
    }
}

/// A face's corners, unrounded.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Face {
    pub(crate) id: FaceId,
    pub(crate) corners: [[f32; 3]; 3],
}

impl InBox for Face {
    #[inline]
    fn id(&self) -> FaceId {
        self.id
    }

    #[inline]
    fn corners(&self) -> [DVec3; 3] {
        self.corners.map(|[x, y, z]| DVec3::new(f64::from(x), f64::from(y), f64::from(z)))
    }

    #[inline]
    fn middle(&self, axis: usize) -> f64 {
        self.corners.iter().map(|corner| f64::from(corner[axis])).sum()
    }
}

impl Face {
    pub(crate) fn of(mesh: &Mesh, id: FaceId) -> Self {
        Self { id, corners: mesh.faces()[id.0 as usize].map(|v| mesh.vertices()[v as usize]) }
    }

    /// Whether the face has an area, exactly. A face without one is never met.
    pub(crate) fn has_area(&self) -> bool {
        let certainly = self.normal::<Interval>().0.iter().any(|part| part.low > 0.0 || part.high < 0.0);
        certainly || self.normal::<Dyadic>().0.iter().any(|part| part.sign() != Some(Ordering::Equal))
    }

    /// Corner `k`.
    pub(crate) fn corner<T: Number>(&self, k: usize) -> Vector<T> {
        Vector::of_f32(self.corners[k])
    }

    /// The longest edge, metres, to f64 rounding.
    pub(crate) fn longest_edge(&self) -> f64 {
        let [a, b, c] = self.corners();
        a.distance(b).max(b.distance(c)).max(c.distance(a))
    }

    /// The normal n, not a unit vector.
    pub(crate) fn normal<T: Number>(&self) -> Vector<T> {
        let a = self.corner::<T>(0);
        self.corner(1).sub(&a).cross(&self.corner(2).sub(&a))
    }

    /// What the ray and the face's plane have in common.
    #[inline]
    pub(crate) fn crossing<T: Number>(&self, ray: &ScaledRay<T>) -> Crossing<T> {
        let normal = self.normal();
        Crossing {
            height: normal.dot(&self.corner(0).scaled(&ray.origin_scale).sub(&ray.origin)),
            approach: normal.dot(&ray.direction),
            normal,
        }
    }

    /// Whether the ray meets this face's front, edges and corners included, at or beyond the SPP and within
    /// `max_range`. Other faces are not considered.
    pub(crate) fn is_met_by(&self, ray: &ExactRay<'_>, max_range: f64) -> bool {
        self.met_by(ray, max_range).is_some()
    }

    /// The crossing of a ray [that meets this face](Self::is_met_by).
    #[inline]
    pub(crate) fn met_by(&self, ray: &ExactRay<'_>, max_range: f64) -> Option<Crossing<Interval>> {
        // The cheapest conditions, and those most likely to fail, come first.
        let is_inside = match ray.filter.passes(self.corners()) {
            Passes::Outside => false,
            Passes::Inside => true,
            Passes::Near => (0..3).all(|k| ray.sign(&EdgeSide { face: self, k }) != Ordering::Greater),
        };
        if !is_inside {
            return None;
        }
        // One crossing serves all conditions; where one is in doubt, so does the exact crossing.
        let crossing = self.crossing(&ray.fast);
        let exact = OnceCell::new();
        let exact = || exact.get_or_init(|| self.crossing(ray.exact()));
        let sign = |fast: Option<Ordering>, slow: &dyn Fn() -> Option<Ordering>| {
            fast.or_else(slow).unwrap_or(Ordering::Equal)
        };
        let is_met = sign(crossing.approach.sign(), &|| exact().approach.sign()) == Ordering::Less
            && sign(crossing.before_plane(&ray.fast), &|| exact().before_plane(ray.exact()))
                != Ordering::Greater
            && sign(crossing.beyond(max_range, &ray.fast), &|| exact().beyond(max_range, ray.exact()))
                != Ordering::Greater;
        is_met.then_some(crossing)
    }

    /// Whether a ray that meets this face meets it exactly where it begins, t = 1, or exactly at `max_range`.
    pub(crate) fn is_at_an_end(&self, ray: &ExactRay<'_>, max_range: f64) -> bool {
        let ends = |crossing: [Option<Ordering>; 2]| crossing.map(|sign| sign.is_none_or(Ordering::is_eq));
        let fast = self.crossing(&ray.fast);
        let may_be = ends([fast.before_plane(&ray.fast), fast.beyond(max_range, &ray.fast)]);
        may_be.contains(&true) && {
            let exact = self.crossing(ray.exact());
            ends([exact.before_plane(ray.exact()), exact.beyond(max_range, ray.exact())]).contains(&true)
        }
    }

    /// Whether the line of the ray passes this face's inside, edges and corners included, from either side and at any
    /// distance. A line in the face's plane may be said to pass it.
    pub(crate) fn is_crossed_by(&self, ray: &ExactRay<'_>) -> bool {
        let sides = [0, 1, 2].map(|k| ray.sign(&EdgeSide { face: self, k }));
        [Ordering::Less, Ordering::Greater].iter().any(|outside| !sides.contains(outside))
    }

    /// Whether `other` lies in this face's plane and faces the same way, exactly.
    pub(crate) fn is_coplanar_with(&self, other: &Self) -> bool {
        let (n, a) = (self.normal::<Dyadic>(), self.corner::<Dyadic>(0));
        let on_plane = |k: usize| n.dot(&other.corner(k).sub(&a)).sign() == Some(Ordering::Equal);
        (0..3).all(on_plane) && n.dot(&other.normal()).sign() == Some(Ordering::Greater)
    }

    /// Whether the ray comes from behind the face's plane.
    pub(crate) fn shows_back_to(&self, ray: &ExactRay<'_>) -> bool {
        ray.sign(&Approach(self)) == Ordering::Greater
    }

    /// Whether this face lies in the plane of `other`, exactly, whichever way either faces.
    pub(crate) fn is_in_plane_of(&self, other: &Self) -> bool {
        // Nearly all faces that are asked for are certainly not: intervals prove it, and exact numbers cost far more.
        let is_certainly_off =
            |side: &Option<Ordering>| matches!(side, Some(Ordering::Less | Ordering::Greater));
        !self.sides_of_plane::<Interval>(other).iter().any(is_certainly_off)
            && self.sides_of_plane::<Dyadic>(other) == [Some(Ordering::Equal); 3]
    }

    /// On which side of the plane of `other` each corner lies, where the arithmetic is certain of it.
    fn sides_of_plane<T: Number>(&self, other: &Self) -> [Option<Ordering>; 3] {
        let (normal, corner) = (other.normal::<T>(), other.corner::<T>(0));
        [0, 1, 2].map(|k| normal.dot(&self.corner(k).sub(&corner)).sign())
    }

    /// The range at which the ray meets the face's plane, metres, to f64 rounding.
    pub(crate) fn range(&self, ray: &ExactRay<'_>) -> f64 {
        let Crossing { height, approach, .. } = self.crossing(&ray.fast);
        let length = ray.fast.direction.length_squared().middle().sqrt();
        height.middle() * length / (approach.middle() * ray.fast.origin_scale.middle())
    }

    /// The order in which `ray` meets two faces; it must meet both.
    pub(crate) fn compare(&self, other: &Self, ray: &ExactRay<'_>) -> Ordering {
        // The same triangle. Of a thousand at one place, each would need the exact polynomials to be no nearer.
        if self.corners == other.corners {
            return Ordering::Equal;
        }
        ray.sign(&Nearness { face: self, other })
    }
}

/// D.(a' x b') for the edge from corner k: positive outside.
struct EdgeSide<'a> {
    face: &'a Face,
    k: usize,
}

impl Polynomial for EdgeSide<'_> {
    #[inline]
    fn value<T: Number>(&self, ray: &ScaledRay<T>) -> T {
        let (a, b) = (self.face.corner::<T>(self.k), self.face.corner::<T>((self.k + 1) % 3));
        let relative = a.scaled(&ray.origin_scale).sub(&ray.origin);
        ray.direction.dot(&relative.cross(&b.sub(&a)))
    }
}

/// n.D: negative where the front is met.
struct Approach<'a>(&'a Face);

impl Polynomial for Approach<'_> {
    fn value<T: Number>(&self, ray: &ScaledRay<T>) -> T {
        self.0.normal().dot(&ray.direction)
    }
}

/// n.a' n'.D - n'.a'' n.D: negative where the face is met before the other.
struct Nearness<'a> {
    face: &'a Face,
    other: &'a Face,
}

impl Polynomial for Nearness<'_> {
    fn value<T: Number>(&self, ray: &ScaledRay<T>) -> T {
        self.face.crossing(ray).before(&self.other.crossing(ray))
    }
}

/// A ray and the plane of a face.
#[derive(Debug, Clone)]
pub(crate) struct Crossing<T> {
    /// The face's normal n, not a unit vector.
    pub(crate) normal: Vector<T>,
    /// n.a' = s n.(a - o).
    pub(crate) height: T,
    /// n.D = sigma n.q: negative where the front is met.
    pub(crate) approach: T,
}

impl<T: Number> Crossing<T> {
    /// The sign of sigma n.a' - s n.D: positive where t < 1.
    #[inline]
    fn before_plane(&self, ray: &ScaledRay<T>) -> Option<Ordering> {
        let height = self.height.mul(&ray.direction_scale);
        height.sub(&self.approach.mul(&ray.origin_scale)).sign()
    }

    /// The sign of (n.a')^2 |D|^2 - (M s n.D)^2: positive where the range exceeds M.
    #[inline]
    fn beyond(&self, max_range: f64, ray: &ScaledRay<T>) -> Option<Ordering> {
        let range = self.height.square().mul(&ray.direction.length_squared());
        let limit = T::of(max_range).mul(&ray.origin_scale).mul(&self.approach);
        range.sub(&limit.square()).sign()
    }

    /// n.a' n'.D - n'.a'' n.D: negative where this plane is met before the other.
    pub(crate) fn before(&self, other: &Self) -> T {
        self.height.mul(&other.approach).sub(&other.height.mul(&self.approach))
    }
}

impl Crossing<Interval> {
    /// An upper bound of the range at which the ray meets the face, metres.
    #[inline]
    pub(crate) fn farthest_range(&self, ray: &ExactRay<'_>, max_range: f64) -> f64 {
        // R = n.a' |D| / (s n.D). Where n.D may be 0, only the sensor's own range bounds it.
        let scale = ray.fast.origin_scale.low * -self.approach.high;
        if !(scale > 0.0) {
            return max_range;
        }
        let length = ray.fast.direction.length_squared().high.sqrt();
        // Four roundings, each below 2^-52.
        (self.height.magnitude() * length / scale * (1.0 + 8.0 * f64::EPSILON)).min(max_range)
    }
}

#[cfg(test)]
#[path = "../../tests/unit/face.rs"]
mod tests;
