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
use crate::numbers::double_double::{DoubleDouble, PlaneCrossing, crossing_parameter};
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
        Some(CastMeeting::new(ray, face, side))
    }

    /// The values of the first hit: of the lowest of its faces, if these tie. `None` if nothing is met.
    pub fn first_values(&self, ray: &CastRay, sides: Sides) -> Option<CastHit> {
        let face = *self.nearest(ray, sides).first()?;
        let query = QueryRay::new(ray);
        let side = face.met_side(&query, sides)?;
        Some(CastMeeting::new(ray, face, side).hit())
    }
}

/// The polynomials of a ray and a face from which all values follow. Each is formed when it is first asked for.
struct Meeting<T> {
    normal: Vector<T>,
    height: OnceCell<T>,
    approach: OnceCell<T>,
    direction_squared: OnceCell<T>,
    normal_squared: OnceCell<T>,
}

impl<T: Number> Meeting<T> {
    fn of(face: &Triangle) -> Self {
        Self {
            normal: face.normal::<T>(),
            height: OnceCell::new(),
            approach: OnceCell::new(),
            direction_squared: OnceCell::new(),
            normal_squared: OnceCell::new(),
        }
    }

    /// h.
    fn height(&self, ray: &RayNumbers<T>, face: &Triangle) -> &T {
        self.height.get_or_init(|| {
            // a' = a - o.
            self.normal.dot(&face.corner(0).sub(&ray.origin))
        })
    }

    /// g.
    fn approach(&self, ray: &RayNumbers<T>) -> &T {
        self.approach.get_or_init(|| self.normal.dot(&ray.direction))
    }

    fn direction_squared(&self, ray: &RayNumbers<T>) -> &T {
        self.direction_squared.get_or_init(|| ray.direction.length_squared())
    }

    fn normal_squared(&self) -> &T {
        self.normal_squared.get_or_init(|| self.normal.length_squared())
    }

    /// g P.
    fn point(&self, k: usize, ray: &RayNumbers<T>, face: &Triangle) -> T {
        ray.origin.0[k].mul(self.approach(ray)).add(&ray.direction.0[k].mul(self.height(ray, face)))
    }
}

impl Meeting<DoubleDouble> {
    /// The same with [`PlaneCrossing`], which is quick, where that knows the crossing.
    fn quickly(ray: &CastRay, face: &Triangle) -> Self {
        let Some(crossing) = PlaneCrossing::of(ray.origin, ray.direction, face.corners) else {
            return Self::of(face);
        };
        Self {
            normal: Vector(crossing.normal),
            height: OnceCell::from(crossing.height),
            approach: OnceCell::from(crossing.approach),
            direction_squared: OnceCell::new(),
            normal_squared: OnceCell::new(),
        }
    }
}

/// Numbers of one arithmetic.
struct Numbers<T> {
    ray: RayNumbers<T>,
    meeting: Meeting<T>,
}

/// Where a ray meets a face. Each value is formed when it is asked for, correctly rounded: first in pairs of f64 with a proven
/// error, and exactly where these do not decide the rounding.
pub struct CastMeeting<'r> {
    ray: &'r CastRay,
    face: Triangle,
    side: Side,
    t: OnceCell<DoubleDouble>,
    fast: OnceCell<Meeting<DoubleDouble>>,
    /// Apart, for it is large and rare.
    exact: OnceCell<Box<Numbers<Dyadic>>>,
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
    #[inline]
    pub(super) fn new(ray: &'r CastRay, face: Triangle, side: Side) -> Self {
        Self {
            ray,
            face,
            side,
            t: OnceCell::new(),
            fast: OnceCell::new(),
            exact: OnceCell::new(),
            length: OnceCell::new(),
            normal_length: OnceCell::new(),
        }
    }

    fn fast(&self) -> &Meeting<DoubleDouble> {
        self.fast.get_or_init(|| Meeting::quickly(self.ray, &self.face))
    }

    /// The ray in pairs of f64.
    fn fast_ray(&self) -> RayNumbers<DoubleDouble> {
        RayNumbers::of(self.ray)
    }

    fn exact(&self) -> &Numbers<Dyadic> {
        self.exact.get_or_init(|| {
            Box::new(Numbers { ray: RayNumbers::of(self.ray), meeting: Meeting::of(&self.face) })
        })
    }

    fn length(&self) -> &DoubleDouble {
        self.length.get_or_init(|| self.fast().direction_squared(&self.fast_ray()).sqrt())
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

    /// t in pairs of f64.
    fn quick_t(&self) -> DoubleDouble {
        *self.t.get_or_init(|| {
            let quickly = crossing_parameter(self.ray.origin, self.ray.direction, self.face.corners);
            quickly.unwrap_or_else(|| {
                let (fast, ray) = (self.fast(), self.fast_ray());
                fast.height(&ray, &self.face).over(fast.approach(&ray))
            })
        })
    }

    /// The ray's parameter.
    pub fn t(&self) -> Rounded {
        self.quick_t().rounded().unwrap_or_else(|| {
            let Numbers { ray, meeting } = self.exact();
            quotient(meeting.height(ray, &self.face), meeting.approach(ray))
        })
    }

    /// Distance from the ray's origin: t times the length of its direction, in the mesh's unit.
    pub fn range(&self) -> Rounded {
        self.quick_t().mul(self.length()).rounded().unwrap_or_else(|| {
            let Numbers { ray, meeting } = self.exact();
            // t is not negative.
            let squared = meeting.height(ray, &self.face).square().mul(meeting.direction_squared(ray));
            root(dashu_int::Sign::Positive, &squared, &meeting.approach(ray).square())
        })
    }

    /// The point.
    pub fn point(&self) -> [Rounded; 3] {
        let (fast, of_ray) = (self.fast(), self.fast_ray());
        [0, 1, 2].map(|k: usize| {
            let rounded = fast.point(k, &of_ray, &self.face).over(fast.approach(&of_ray)).rounded();
            rounded.unwrap_or_else(|| {
                let Numbers { ray, meeting } = self.exact();
                quotient(&meeting.point(k, ray, &self.face), meeting.approach(ray))
            })
        })
    }

    /// The unit normal to the face's front, whichever side is met.
    pub fn normal(&self) -> [Rounded; 3] {
        [0, 1, 2].map(|k: usize| {
            self.fast().normal.0[k].over(self.normal_length()).rounded().unwrap_or_else(|| {
                let Numbers { meeting, .. } = self.exact();
                let part = &meeting.normal.0[k];
                root(sign_of(part), &part.square(), meeting.normal_squared())
            })
        })
    }

    /// The weights of the face's corners, in their order: the point is their weighted sum.
    pub fn barycentric(&self) -> [Rounded; 3] {
        let (fast, of_ray) = (self.fast(), self.fast_ray());
        // The edge opposite of corner k starts at corner k + 1.
        [0, 1, 2].map(|k: usize| {
            let rounded = self.face.edge(k + 1, &of_ray).over(fast.approach(&of_ray)).rounded();
            rounded.unwrap_or_else(|| {
                let Numbers { ray, meeting } = self.exact();
                quotient(&self.face.edge(k + 1, ray), meeting.approach(ray))
            })
        })
    }

    /// Cosine of the angle between the normal and the reversed ray: negative where the back is met.
    pub fn cos_incidence(&self) -> Rounded {
        let lengths = self.normal_length().mul(self.length());
        minus(self.fast().approach(&self.fast_ray())).over(&lengths).rounded().unwrap_or_else(|| {
            let Numbers { ray, meeting } = self.exact();
            let lengths = meeting.normal_squared().mul(meeting.direction_squared(ray));
            root(sign_of(&minus(meeting.approach(ray))), &meeting.approach(ray).square(), &lengths)
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
