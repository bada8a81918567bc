//! A face as it is traced, and a hit with its values.

use std::cell::OnceCell;

use glam::DVec3;
use raypencil_scene::{CastRay, FaceId, Side, Sides, Triangles};

use super::frame::{Frame, ScaledRay};
use super::in_box::{doubtful_below, moved_into_box};
use crate::triangle::{PlaneCrossing, intersect};

/// A face in the scaled frame.
#[derive(Debug, Clone, Copy)]
pub(super) struct CastFace {
    pub(super) id: FaceId,
    pub(super) corners: [DVec3; 3],
    /// Which of the face's corners is the first here.
    first: u8,
}

impl CastFace {
    /// The cycle starts at the lexicographically lowest position. Two faces with the same vertices then give the same
    /// bits and tie exactly, wherever their cycles start in the file.
    pub(super) fn of(mesh: &Triangles, id: FaceId, scale: f64) -> Self {
        let corners = mesh.corners(id).map(|corner| corner * scale);
        let key = |k: usize| corners[k].to_array();
        let first = (1..3).fold(0, |least, k| if key(k) < key(least) { k } else { least });
        Self { id, corners: [0, 1, 2].map(|k| corners[(first + k) % 3]), first: first as u8 }
    }

    /// Whether f64 sees an area. A face without one is never met: its normal is 0.
    pub(super) fn has_area(&self) -> bool {
        let [a, b, c] = self.corners;
        (b - a).cross(c - a) != DVec3::ZERO
    }

    /// The side that a ray in this direction meets, if it meets the face.
    pub(super) fn side_towards(&self, direction: DVec3) -> Side {
        let [a, b, c] = self.corners;
        side_of((b - a).cross(c - a).dot(direction))
    }

    /// The crossing of the ray with this face, within the ray's ends and on a side that counts.
    #[inline(always)]
    pub(super) fn crossing(&self, given: &CastRay, scaled: &ScaledRay, sides: Sides) -> Option<Crossing<'_>> {
        let crossing = intersect::<true>(self.corners, &scaled.ray)?;
        if crossing.n_dot_q == 0.0 || sides == Sides::Fronts && crossing.n_dot_q > 0.0 {
            return None;
        }
        let ScaledRay { ray, .. } = scaled;
        let mut scaled_t = crossing.n_dot_offset / crossing.n_dot_q;
        let offset = self.corners[0] - ray.origin;
        if crossing.n_dot_q.abs() <= doubtful_below(self.corners, offset) * ray.metres_per_t {
            scaled_t = moved_into_box(scaled_t, self.corners, ray.origin, ray.direction);
        }
        // -0 becomes 0: they are the same t, and are written the same.
        scaled_t += 0.0;
        let t = scaled_t * scaled.t_per_t;
        (t >= given.t_min && t <= given.t_max).then_some(Crossing { face: self, crossing, scaled_t, t })
    }
}

/// The side of a face that is met with this n.q.
fn side_of(n_dot_q: f64) -> Side {
    if n_dot_q < 0.0 { Side::Front } else { Side::Back }
}

/// A ray's crossing with a face.
#[derive(Debug, Clone, Copy)]
pub(super) struct Crossing<'f> {
    pub(super) face: &'f CastFace,
    crossing: PlaneCrossing,
    pub(super) scaled_t: f64,
    pub(super) t: f64,
}

/// The face that a ray meets first.
#[derive(Debug, Clone, Copy)]
pub(super) struct FirstMet<'t> {
    pub(super) face: &'t CastFace,
    /// Of the given ray.
    pub(super) t: f64,
    pub(super) side: Side,
}

impl<'f> Crossing<'f> {
    pub(super) fn met(&self) -> FirstMet<'f> {
        FirstMet { face: self.face, t: self.t, side: side_of(self.crossing.n_dot_q) }
    }

    /// Whether this crossing is reported rather than `other`: it is nearer, or as near with a lower face index.
    pub(super) fn is_before(&self, other: &Self) -> bool {
        self.t < other.t || (self.t == other.t && self.face.id < other.face.id)
    }

    /// The values of the hit.
    pub(super) fn hit(&self, given: &CastRay, scaled: &ScaledRay) -> TracedHit {
        let n = self.crossing.normal;
        // By the largest part first: the square of a small one may be 0.
        let normal = (n / n.abs().max_element()).normalize();
        let [ab, bc, ca] = self.crossing.edges;
        let area = ab + bc + ca;
        // A corner's weight is the share of the edge opposite to it. Corner k is here corner k - first.
        let shares = [bc / area, ca / area, ab / area].map(|share| share + 0.0);
        let barycentric = [0, 1, 2].map(|k: usize| shares[(k + 3 - usize::from(self.face.first)) % 3]);
        TracedHit {
            face: self.face.id,
            side: side_of(self.crossing.n_dot_q),
            t: self.t,
            range: self.scaled_t * scaled.ray.metres_per_t * scaled.unit,
            point: given.origin + given.direction * self.t,
            normal,
            barycentric,
            cos_incidence: -normal.dot(scaled.ray.direction) / scaled.ray.metres_per_t,
        }
    }
}

/// The face that a ray meets first, whose values are formed when they are asked for.
#[derive(Debug, Clone)]
pub struct TracedMeeting<'t, 'r> {
    met: FirstMet<'t>,
    ray: &'r CastRay,
    frame: &'t Frame,
    hit: OnceCell<TracedHit>,
}

impl<'t, 'r> TracedMeeting<'t, 'r> {
    pub(super) fn new(met: FirstMet<'t>, ray: &'r CastRay, frame: &'t Frame) -> Self {
        Self { met, ray, frame, hit: OnceCell::new() }
    }

    /// The face; of several at the same t, the lowest index.
    pub fn face(&self) -> FaceId {
        self.met.face.id
    }

    /// The side that is met.
    pub fn side(&self) -> Side {
        self.met.side
    }

    /// The ray's parameter.
    pub fn t(&self) -> f64 {
        self.met.t
    }

    /// Every value.
    pub fn hit(&self) -> &TracedHit {
        self.hit.get_or_init(|| {
            let scaled = self.frame.ray(self.ray);
            let crossing =
                self.met.face.crossing(self.ray, &scaled, Sides::Both).expect("the ray meets the face");
            crossing.hit(self.ray, &scaled)
        })
    }
}

/// Where a ray meets a face.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TracedHit {
    /// The face; of several at the same t, the lowest index.
    pub face: FaceId,
    /// The side that is met.
    pub side: Side,
    /// The ray's parameter.
    pub t: f64,
    /// Distance from the ray's origin, in the mesh's unit.
    pub range: f64,
    /// The point.
    pub point: DVec3,
    /// The unit normal to the face's front, whichever side is met.
    pub normal: DVec3,
    /// The weights of the face's corners, in their order.
    pub barycentric: [f64; 3],
    /// Cosine of the angle between the normal and the reversed ray: negative where the back is met.
    pub cos_incidence: f64,
}
