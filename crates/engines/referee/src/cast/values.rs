//! The values of a hit, correctly rounded to f64 and to f32.
//!
//! With h = n.a' and g = n.d, and E_ab the edge's polynomial:
//!
//! | value | exactly |
//! | --- | --- |
//! | t | h / g |
//! | range | t abs(d), root of h^2 d^2 / g^2 |
//! | point | (o g + d h) / g |
//! | normal | n / abs(n), roots of n_k^2 / n^2 |
//! | barycentric weights of a, b, c | E_bc / g, E_ca / g, E_ab / g; their sum is 1, for E_ab + E_bc + E_ca = g |
//! | cosine of incidence | -g / (abs(n) abs(d)), negative where the back is met |

use std::cell::OnceCell;

use raypencil_scene::{CastRay, FaceId, Side, Sides};

use super::ExactCast;
use super::query_ray::{QueryRay, RayNumbers};
use super::triangle::Triangle;
use crate::double_double::DoubleDouble;
use crate::intersection::{minus, sign_of};
use crate::number::Number;
use crate::rounding::{Rounded, quotient, root};
use crate::vector::Vector;

/// Where a ray meets a face. Values are correctly rounded.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CastHit {
    /// The face.
    pub face: FaceId,
    /// The side that is met.
    pub side: Side,
    /// The ray's parameter.
    pub t: Rounded,
    /// Distance from the ray's origin: t times the length of its direction, in the mesh's unit.
    pub range: Rounded,
    /// The point.
    pub point: [Rounded; 3],
    /// The unit normal to the face's front, whichever side is met.
    pub normal: [Rounded; 3],
    /// The weights of the face's corners, in their order: the point is their weighted sum.
    pub barycentric: [Rounded; 3],
    /// Cosine of the angle between the normal and the reversed ray: negative where the back is met.
    pub cos_incidence: Rounded,
}

impl ExactCast<'_> {
    /// The values where the ray meets a face, which need not be the nearest; `None` if there is no such face, or the
    /// ray does not meet it within its ends.
    pub fn values(&self, ray: &CastRay, face: FaceId) -> Option<CastHit> {
        let face = self.triangle(face).filter(Triangle::has_area)?;
        let query = QueryRay::new(ray);
        let side = face.met_side(&query, Sides::Both)?;
        Some(values(ray, &query, &face, side))
    }

    /// The values of the first hit: of the lowest of its faces, if these tie. `None` if nothing is met.
    pub fn first_values(&self, ray: &CastRay, sides: Sides) -> Option<CastHit> {
        let face = *self.nearest(ray, sides).first()?;
        let query = QueryRay::new(ray);
        let side = face.met_side(&query, sides)?;
        Some(values(ray, &query, face, side))
    }
}

/// The polynomials of a ray and a face from which all values follow.
struct Meeting<T> {
    ray: RayNumbers<T>,
    normal: Vector<T>,
    /// h.
    height: T,
    /// g.
    approach: T,
    direction_squared: T,
    normal_squared: T,
}

impl<T: Number> Meeting<T> {
    fn new(ray: RayNumbers<T>, face: &Triangle) -> Self {
        let normal = face.normal::<T>();
        Self {
            height: face.height(&ray),
            approach: face.approach(&ray),
            direction_squared: ray.direction.length_squared(),
            normal_squared: normal.length_squared(),
            ray,
            normal,
        }
    }

    /// g P.
    fn point(&self, k: usize) -> T {
        self.ray.origin.0[k].mul(&self.approach).add(&self.ray.direction.0[k].mul(&self.height))
    }
}

/// The values of a hit, first in pairs of f64 with a proven error, and exactly where these do not decide the rounding.
fn values(ray: &CastRay, query: &QueryRay<'_>, face: &Triangle, side: Side) -> CastHit {
    let fast = Meeting::new(RayNumbers::<DoubleDouble>::of(ray), face);
    let exact = OnceCell::new();
    let exact = || exact.get_or_init(|| Meeting::new(query.exact().clone(), face));

    let t = fast.height.over(&fast.approach);
    let (length, normal_length) = (fast.direction_squared.sqrt(), fast.normal_squared.sqrt());
    let range = t.mul(&length).rounded().unwrap_or_else(|| {
        let Meeting { height, approach, direction_squared, .. } = exact();
        // t is not negative.
        root(dashu_int::Sign::Positive, &height.square().mul(direction_squared), &approach.square())
    });
    let point = [0, 1, 2].map(|k: usize| {
        let rounded = fast.point(k).over(&fast.approach).rounded();
        rounded.unwrap_or_else(|| quotient(&exact().point(k), &exact().approach))
    });
    let normal = [0, 1, 2].map(|k: usize| {
        fast.normal.0[k].over(&normal_length).rounded().unwrap_or_else(|| {
            let part = &exact().normal.0[k];
            root(sign_of(part), &part.square(), &exact().normal_squared)
        })
    });
    // The edge opposite of corner k starts at corner k + 1.
    let barycentric = [0, 1, 2].map(|k: usize| {
        let rounded = face.edge(k + 1, &fast.ray).over(&fast.approach).rounded();
        rounded.unwrap_or_else(|| quotient(&face.edge(k + 1, query.exact()), &exact().approach))
    });
    let towards = minus(&fast.approach).over(&normal_length.mul(&length));
    let cos_incidence = towards.rounded().unwrap_or_else(|| {
        let Meeting { approach, normal_squared, direction_squared, .. } = exact();
        let lengths = normal_squared.mul(direction_squared);
        root(sign_of(&minus(approach)), &approach.square(), &lengths)
    });
    let t = t.rounded().unwrap_or_else(|| quotient(&exact().height, &exact().approach));
    CastHit { face: face.id, side, t, range, point, normal, barycentric, cos_incidence }
}
