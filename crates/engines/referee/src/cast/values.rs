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
use crate::hits::intersection::{minus, sign_of};
use crate::numbers::double_double::{DoubleDouble, PlaneCrossing};
use crate::numbers::number::{Dyadic, Number};
use crate::numbers::rounding::{Rounded, quotient, root};
use crate::numbers::vector::Vector;

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
        Some(self.meeting(ray, face)?.hit())
    }

    /// The same, with values that are formed when they are asked for.
    pub fn meeting<'r>(&self, ray: &'r CastRay, face: FaceId) -> Option<CastMeeting<'r>> {
        let face = self.triangle(face).filter(Triangle::has_area)?;
        let query = QueryRay::new(ray);
        let side = face.met_side(&query, Sides::Both)?;
        Some(CastMeeting::new(ray, query, face, side))
    }

    /// The values of the first hit: of the lowest of its faces, if these tie. `None` if nothing is met.
    pub fn first_values(&self, ray: &CastRay, sides: Sides) -> Option<CastHit> {
        let face = *self.nearest(ray, sides).first()?;
        let query = QueryRay::new(ray);
        let side = face.met_side(&query, sides)?;
        Some(CastMeeting::new(ray, query, face, side).hit())
    }
}

/// The polynomials of a ray and a face from which all values follow. Each is formed when it is first asked for.
struct Meeting<T> {
    ray: RayNumbers<T>,
    face: Triangle,
    normal: Vector<T>,
    height: OnceCell<T>,
    approach: OnceCell<T>,
    direction_squared: OnceCell<T>,
    normal_squared: OnceCell<T>,
}

impl<T: Number> Meeting<T> {
    fn new(ray: RayNumbers<T>, face: &Triangle) -> Self {
        Self {
            face: *face,
            normal: face.normal::<T>(),
            height: OnceCell::new(),
            approach: OnceCell::new(),
            direction_squared: OnceCell::new(),
            normal_squared: OnceCell::new(),
            ray,
        }
    }

    /// h.
    fn height(&self) -> &T {
        self.height.get_or_init(|| {
            // a' = a - o.
            self.normal.dot(&self.face.corner(0).sub(&self.ray.origin))
        })
    }

    /// g.
    fn approach(&self) -> &T {
        self.approach.get_or_init(|| self.normal.dot(&self.ray.direction))
    }

    fn direction_squared(&self) -> &T {
        self.direction_squared.get_or_init(|| self.ray.direction.length_squared())
    }

    fn normal_squared(&self) -> &T {
        self.normal_squared.get_or_init(|| self.normal.length_squared())
    }

    /// g P.
    fn point(&self, k: usize) -> T {
        self.ray.origin.0[k].mul(self.approach()).add(&self.ray.direction.0[k].mul(self.height()))
    }
}

impl Meeting<DoubleDouble> {
    /// The same with [`PlaneCrossing`], which is quick, where that knows the crossing.
    fn quickly(ray: &CastRay, face: &Triangle) -> Self {
        let numbers = RayNumbers::of(ray);
        let Some(crossing) = PlaneCrossing::of(ray.origin, ray.direction, face.corners) else {
            return Self::new(numbers, face);
        };
        Self {
            ray: numbers,
            face: *face,
            normal: Vector(crossing.normal),
            height: OnceCell::from(crossing.height),
            approach: OnceCell::from(crossing.approach),
            direction_squared: OnceCell::new(),
            normal_squared: OnceCell::new(),
        }
    }
}

/// Where a ray meets a face. Each value is formed when it is asked for, correctly rounded: first in pairs of f64 with a proven
/// error, and exactly where these do not decide the rounding.
pub struct CastMeeting<'r> {
    query: QueryRay<'r>,
    face: Triangle,
    side: Side,
    fast: OnceCell<Meeting<DoubleDouble>>,
    /// Apart, for it is large and rare.
    exact: OnceCell<Box<Meeting<Dyadic>>>,
    ray: &'r CastRay,
    /// |d| and |n|.
    length: OnceCell<DoubleDouble>,
    normal_length: OnceCell<DoubleDouble>,
}

impl std::fmt::Debug for CastMeeting<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { ray, face, side, .. } = self;
        f.debug_struct("CastMeeting")
            .field("ray", ray)
            .field("face", &face.id)
            .field("side", side)
            .finish_non_exhaustive()
    }
}

impl<'r> CastMeeting<'r> {
    pub(super) fn new(ray: &'r CastRay, query: QueryRay<'r>, face: Triangle, side: Side) -> Self {
        Self {
            query,
            face,
            side,
            fast: OnceCell::new(),
            exact: OnceCell::new(),
            ray,
            length: OnceCell::new(),
            normal_length: OnceCell::new(),
        }
    }

    fn fast(&self) -> &Meeting<DoubleDouble> {
        self.fast.get_or_init(|| Meeting::quickly(self.ray, &self.face))
    }

    fn exact(&self) -> &Meeting<Dyadic> {
        self.exact.get_or_init(|| Box::new(Meeting::new(self.query.exact().clone(), &self.face)))
    }

    fn length(&self) -> &DoubleDouble {
        self.length.get_or_init(|| self.fast().direction_squared().sqrt())
    }

    fn normal_length(&self) -> &DoubleDouble {
        self.normal_length.get_or_init(|| self.fast().normal_squared().sqrt())
    }

    /// The face.
    pub fn face(&self) -> FaceId {
        self.face.id
    }

    /// The side that is met.
    pub fn side(&self) -> Side {
        self.side
    }

    /// The ray's parameter.
    pub fn t(&self) -> Rounded {
        let t = self.fast().height().over(self.fast().approach());
        t.rounded().unwrap_or_else(|| quotient(self.exact().height(), self.exact().approach()))
    }

    /// Distance from the ray's origin: t times the length of its direction, in the mesh's unit.
    pub fn range(&self) -> Rounded {
        let t = self.fast().height().over(self.fast().approach());
        t.mul(self.length()).rounded().unwrap_or_else(|| {
            let exact = self.exact();
            // t is not negative.
            let squared = exact.height().square().mul(exact.direction_squared());
            root(dashu_int::Sign::Positive, &squared, &exact.approach().square())
        })
    }

    /// The point.
    pub fn point(&self) -> [Rounded; 3] {
        [0, 1, 2].map(|k: usize| {
            let rounded = self.fast().point(k).over(self.fast().approach()).rounded();
            rounded.unwrap_or_else(|| quotient(&self.exact().point(k), self.exact().approach()))
        })
    }

    /// The unit normal to the face's front, whichever side is met.
    pub fn normal(&self) -> [Rounded; 3] {
        [0, 1, 2].map(|k: usize| {
            self.fast().normal.0[k].over(self.normal_length()).rounded().unwrap_or_else(|| {
                let part = &self.exact().normal.0[k];
                root(sign_of(part), &part.square(), self.exact().normal_squared())
            })
        })
    }

    /// The weights of the face's corners, in their order: the point is their weighted sum.
    pub fn barycentric(&self) -> [Rounded; 3] {
        // The edge opposite of corner k starts at corner k + 1.
        [0, 1, 2].map(|k: usize| {
            let rounded = self.face.edge(k + 1, &self.fast().ray).over(self.fast().approach()).rounded();
            rounded.unwrap_or_else(|| {
                quotient(&self.face.edge(k + 1, self.query.exact()), self.exact().approach())
            })
        })
    }

    /// Cosine of the angle between the normal and the reversed ray: negative where the back is met.
    pub fn cos_incidence(&self) -> Rounded {
        let lengths = self.normal_length().mul(self.length());
        minus(self.fast().approach()).over(&lengths).rounded().unwrap_or_else(|| {
            let exact = self.exact();
            let lengths = exact.normal_squared().mul(exact.direction_squared());
            root(sign_of(&minus(exact.approach())), &exact.approach().square(), &lengths)
        })
    }

    /// All values.
    pub fn hit(&self) -> CastHit {
        CastHit {
            face: self.face(),
            side: self.side(),
            t: self.t(),
            range: self.range(),
            point: self.point(),
            normal: self.normal(),
            barycentric: self.barycentric(),
            cos_incidence: self.cos_incidence(),
        }
    }
}
