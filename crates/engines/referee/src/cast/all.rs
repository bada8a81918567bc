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
use std::iter::Enumerate;
use std::slice;

use raypencil_scene::{CastRay, FaceId, Side, Sides};

use super::ExactCast;
use super::query_ray::{Polynomial, QueryRay, RayNumbers};
use super::triangle::{Met, Triangle};
use super::wide_tree::{FrameRay, Next, Rays, TOGETHER, how_many_together};
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

/// A face that is met, the side that is, and bounds of its t.
#[derive(Debug, Clone, Copy)]
struct MetFace {
    face: Triangle,
    side: Side,
    t: [f64; 2],
}

impl MetFace {
    fn new(face: &Triangle, query: &QueryRay<'_>) -> Option<Self> {
        face.met(query, Sides::Both).map(|Met { side, t }| Self { face: *face, side, t: [t.low, t.high] })
    }

    /// By the bounds of t where these are apart, else exactly.
    fn order(&self, other: &Self, query: &QueryRay<'_>) -> Ordering {
        if self.t[1] < other.t[0] {
            Ordering::Less
        } else if self.t[0] > other.t[1] {
            Ordering::Greater
        } else {
            self.face.compare(&other.face, query)
        }
    }
}

impl ExactCast<'_> {
    /// All faces that the ray meets, in the exact order of t, grouped where t is the same. With
    /// [`Sides::Fronts`], only groups with a front are listed, and only fronts in them.
    pub fn all(&self, ray: &CastRay, sides: Sides) -> Vec<HitGroup> {
        let query = QueryRay::new(ray);
        let mut met = Vec::new();
        self.walk(ray, |face| {
            met.extend(MetFace::new(face, &query));
            Next::On
        });
        groups(&mut met, &query, sides)
    }

    /// [`all`](Self::all) of many rays, which is quicker than one after the other: `each` gets the index of every ray, in no
    /// particular order.
    ///
    /// ```
    /// use glam::DVec3;
    /// use raypencil_referee::ExactCast;
    /// use raypencil_scene::{CastRay, Sides, Triangles};
    ///
    /// let corners = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    /// let triangle = Triangles::new(corners, vec![[0, 1, 2]])?;
    /// let rays = [0.25, 2.0].map(|x| CastRay::new(DVec3::new(x, 0.25, 1.0), DVec3::NEG_Z));
    /// let mut groups = [usize::MAX; 2];
    /// ExactCast::new(&triangle).all_of_each(&rays, Sides::Both, |k, all| groups[k] = all.len());
    /// assert_eq!(groups, [1, 0]);
    /// # Ok::<(), raypencil_scene::SceneError>(())
    /// ```
    pub fn all_of_each(&self, rays: &[CastRay], sides: Sides, mut each: impl FnMut(usize, Vec<HitGroup>)) {
        self.walk_to_all(rays, sides, &mut each);
    }

    /// [`all_of_each`](Self::all_of_each), compiled once, with this crate's optimisation.
    #[inline(never)]
    fn walk_to_all(&self, rays: &[CastRay], sides: Sides, each: &mut dyn FnMut(usize, Vec<HitGroup>)) {
        let mut walks = AllWalks {
            cast: self,
            sides,
            rays: rays.iter().enumerate(),
            places: [const { None }; TOGETHER],
            met: [const { Vec::new() }; TOGETHER],
            each,
        };
        self.tree.wide.walk_together(self.mesh.vertices(), &mut walks, how_many_together(rays));
    }
}

/// Many rays on their way through everything.
struct AllWalks<'c, 'r, 'e> {
    cast: &'c ExactCast<'c>,
    sides: Sides,
    rays: Enumerate<slice::Iter<'r, CastRay>>,
    places: [Option<(usize, QueryRay<'r>)>; TOGETHER],
    /// What the ray of each place has met.
    met: [Vec<MetFace>; TOGETHER],
    each: &'e mut dyn FnMut(usize, Vec<HitGroup>),
}

impl Rays for AllWalks<'_, '_, '_> {
    #[inline]
    fn begin(&mut self, place: usize) -> Option<FrameRay> {
        loop {
            let (index, ray) = self.rays.next()?;
            match self.cast.tree.wide.ray(ray) {
                Some(in_frame) => {
                    self.places[place] = Some((index, QueryRay::new(ray)));
                    self.met[place].clear();
                    return Some(in_frame);
                }
                None => (self.each)(index, self.cast.all(ray, self.sides)),
            }
        }
    }

    #[inline]
    fn see(&mut self, place: usize, face: &Triangle) -> Next {
        let Some((_, query)) = &self.places[place] else { return Next::Stop };
        self.met[place].extend(MetFace::new(face, query));
        Next::On
    }

    #[inline]
    fn end(&mut self, place: usize) {
        if let Some((index, query)) = &self.places[place] {
            (self.each)(*index, groups(&mut self.met[place], query, self.sides));
        }
    }
}

/// What is met, in its order and in groups.
fn groups(met: &mut [MetFace], query: &QueryRay<'_>, sides: Sides) -> Vec<HitGroup> {
    met.sort_by(|a, b| a.order(b, query).then(a.face.id.cmp(&b.face.id)));
    met.chunk_by(|a, b| a.order(b, query).is_eq())
        .filter_map(|group| {
            let faces: Vec<SidedFace> = group
                .iter()
                .filter(|met| sides.include(met.side))
                .map(|met| SidedFace { face: met.face.id, side: met.side })
                .collect();
            let crossing = group.iter().map(|met| crossing(&met.face, met.side, query)).sum();
            (!faces.is_empty()).then_some(HitGroup { faces, crossing })
        })
        .collect()
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
