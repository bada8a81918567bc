//! All hits in exact order, and how often the surface is crossed.
//!
//! A ray through an edge meets two faces at one t, but crosses the surface once; where it touches a ridge it meets two
//! faces and crosses nothing. The number of crossings is that of the ray displaced by an infinitely small vector
//! e U + e^2 V, the same for all faces of a ray: with d_k the largest part of d, k + 1 and k + 2 the other two, U is the
//! direction of the coordinate k + 1 and V that of k + 2. Neither is parallel to the ray, nor is any sum of them. The
//! displaced ray passes through no edge: E changes by
//!
//! ```text
//! dE = -d.(delta x (b - a)) = -delta.((b - a) x d)
//! ```
//!
//! and its sign is that of the first number that is not 0 of E, -U.((b - a) x d), -V.((b - a) x d). All three are 0 only
//! if (b - a) x d has no part along U and V. It is perpendicular to d, whose part k is not 0; so its part k would be 0
//! too, and the edge parallel to the ray, and with it the face.
//!
//! A face of a group counts +1 if the displaced ray enters by its front, -1 if it leaves by its back, 0 if it passes
//! beside it. In a closed mesh that does not meet itself the sum up to some t is 1 inside and 0 outside, and elsewhere it is
//! the winding number, relative to the start. Where a ray runs along a face or an edge, it is on neither side; the
//! displaced ray decides, always in the same way.

use std::cmp::Ordering;

use raypencil_scene::{CastRay, FaceId, Side, Sides};

use super::ExactCast;
use super::query_ray::{Polynomial, QueryRay, RayNumbers};
use super::triangle::{Met, Triangle};
use super::wide_tree::Next;
use crate::numbers::number::Number;

/// A face that is met, and the side that is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct SidedFace {
    /// The face.
    pub face: FaceId,
    /// The side of it.
    pub side: Side,
}

/// All faces that a ray meets at exactly the same t.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct HitGroup {
    /// The faces, in ascending order; at least one.
    pub faces: Vec<SidedFace>,
    /// How often the surface is crossed here to its inside, less how often to its outside: a shared edge or vertex counts
    /// once, and what is only touched counts 0. Over fronts and backs alike, whichever sides were asked for.
    pub crossing: i32,
}

impl ExactCast<'_> {
    /// All faces that the ray meets, in the exact order of t, grouped where t is the same. With
    /// [`Sides::Fronts`], only groups with a front are listed, and only fronts in them.
    pub fn all(&self, ray: &CastRay, sides: Sides) -> Vec<HitGroup> {
        let query = QueryRay::new(ray);
        let mut met: Vec<(Triangle, Side, [f64; 2])> = Vec::new();
        self.walk(ray, |face| {
            if let Some(Met { side, t }) = face.met(&query, Sides::Both) {
                met.push((*face, side, [t.low, t.high]));
            }
            Next::On
        });
        // By the intervals of t where these are apart, else exactly.
        let order = |(a, _, of_a): &(Triangle, Side, [f64; 2]), (b, _, of_b): &(Triangle, Side, [f64; 2])| {
            if of_a[1] < of_b[0] {
                Ordering::Less
            } else if of_a[0] > of_b[1] {
                Ordering::Greater
            } else {
                a.compare(b, &query)
            }
        };
        met.sort_by(|a, b| order(a, b).then(a.0.id.cmp(&b.0.id)));
        met.chunk_by(|a, b| order(a, b).is_eq())
            .filter_map(|group| {
                let faces: Vec<SidedFace> = group
                    .iter()
                    .filter(|(_, side, _)| sides.include(*side))
                    .map(|(face, side, _)| SidedFace { face: face.id, side: *side })
                    .collect();
                let crossing = group.iter().map(|(face, side, _)| crossing(face, *side, &query)).sum();
                (!faces.is_empty()).then_some(HitGroup { faces, crossing })
            })
            .collect()
    }
}

/// +1, -1 or 0: how the displaced ray passes a face that the ray itself meets on `side`.
fn crossing(face: &Triangle, side: Side, ray: &QueryRay<'_>) -> i32 {
    let largest = ray.largest_part();
    let (inside, count) = match side {
        Side::Front => (Ordering::Less, 1),
        Side::Back => (Ordering::Greater, -1),
    };
    let is_inside = |k: usize| {
        let sign = face.edge_sign(k, ray);
        let displaced = |along: usize| ray.sign(&DisplacedEdge { face, k, part: (largest + along) % 3 });
        sign.then_with(|| displaced(1)).then_with(|| displaced(2)) == inside
    };
    if (0..3).all(is_inside) { count } else { 0 }
}

/// The change of E by a displacement along one coordinate: -((b - a) x d), its part along it.
struct DisplacedEdge<'a> {
    face: &'a Triangle,
    k: usize,
    part: usize,
}

impl Polynomial for DisplacedEdge<'_> {
    fn value<T: Number>(&self, ray: &RayNumbers<T>) -> T {
        let edge = self.face.corner::<T>(self.k + 1).sub(&self.face.corner(self.k));
        let across = ray.direction.cross(&edge);
        across.0[self.part].clone()
    }
}
