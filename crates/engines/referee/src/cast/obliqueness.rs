//! How obliquely a ray meets a thin face: by how much rounding changes where it meets it.

use std::cmp::Ordering;

use dashu_int::Sign;
use raypencil_scene::{CastRay, FaceId};

use super::ExactCast;
use super::query_ray::QueryRay;
use super::triangle::Triangle;
use crate::hits::aspect::{LEAST_SHARE, exact_parts, is_in_range};
use crate::numbers::number::{Dyadic, Number};
use crate::numbers::rounding::{quotient, root};
use crate::numbers::vector::Vector;

/// An interval is taken for its middle if it is narrower than this share of it. CHOICE: far less than what rounding is charged with.
const SHARP: f64 = 1e-9;

impl ExactCast<'_> {
    /// kappa / c of a face: its [aspect](crate::aspect) over the cosine between ray and normal. It is the product of the two longest
    /// edges over twice the area that the ray sees. Infinite for a face that is parallel to the ray or has no area, and where there is
    /// no such face.
    ///
    /// ```
    /// use glam::DVec3;
    /// use raypencil_referee::ExactCast;
    /// use raypencil_scene::{CastRay, FaceId, Triangles};
    ///
    /// // Edges of 3, 4 and 5; seen square to it, and at 60 degrees.
    /// let corners = vec![[0.0, 0.0, 0.0], [3.0, 0.0, 0.0], [0.0, 4.0, 0.0]];
    /// let triangle = Triangles::new(corners, vec![[0, 1, 2]])?;
    /// let cast = ExactCast::new(&triangle);
    /// let along = |direction: DVec3| cast.aspect_over_cosine(&CastRay::new(DVec3::Z, direction), FaceId(0));
    /// assert!((along(DVec3::NEG_Z) - 20.0 / 12.0).abs() < 1e-15);
    /// assert!((along(DVec3::new(3f64.sqrt(), 0.0, -1.0)) - 40.0 / 12.0).abs() < 1e-14);
    /// assert_eq!(along(DVec3::X), f64::INFINITY);
    /// # Ok::<(), raypencil_scene::SceneError>(())
    /// ```
    pub fn aspect_over_cosine(&self, ray: &CastRay, face: FaceId) -> f64 {
        self.triangle(face).map_or(f64::INFINITY, |face| face.aspect_over_cosine(ray))
    }

    /// The t at which a ray's line meets the plane of a face, to a few roundings; not a number where it does not, or there is no such
    /// face.
    pub fn t_of_plane(&self, ray: &CastRay, face: FaceId) -> f64 {
        self.triangle(face).map_or(f64::NAN, |face| face.t_of_plane(&QueryRay::new(ray)))
    }
}

impl Triangle {
    /// kappa / c; infinite if the face is parallel to the ray or has no area.
    pub(super) fn aspect_over_cosine(&self, ray: &CastRay) -> f64 {
        let [a, b, c] = self.corners;
        let [ab, bc, ca] = [b - a, c - b, a - c].map(glam::DVec3::length);
        let product = (ab * bc).max(bc * ca).max(ca * ab);
        let length = QueryRay::length(ray);
        let approach = (b - a).cross(c - a).dot(ray.direction).abs();
        if is_in_range(product) && is_in_range(length) && approach >= LEAST_SHARE * product * length {
            return product / (approach / length);
        }
        let (product, normal) = exact_parts(self.corners);
        let direction = Vector::<Dyadic>::of(ray.direction);
        let approach = normal.dot(&direction);
        if approach.sign() == Some(Ordering::Equal) {
            return f64::INFINITY;
        }
        let squares = (product.mul(&direction.length_squared()), approach.mul(&approach));
        root(Sign::Positive, &squares.0, &squares.1).double
    }

    /// The t at which the ray's line meets the face's plane, rounded; not a number where it is parallel to it.
    pub(super) fn t_of_plane(&self, query: &QueryRay<'_>) -> f64 {
        let fast = query.fast();
        let t = self.height(fast).over(self.approach(fast));
        if t.high - t.low <= SHARP * t.magnitude() && t.magnitude().is_finite() {
            return t.middle();
        }
        let exact = query.exact();
        let approach: Dyadic = self.approach(exact);
        match approach.sign() {
            Some(Ordering::Equal) => f64::NAN,
            _ => quotient(&self.height(exact), &approach).double,
        }
    }
}
