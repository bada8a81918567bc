//! The nearest hit with its ties, what a sensor reads of it, and whether anything is hit.

use std::cmp::Ordering;

use raypencil_scene::{CastRay, FaceId, Reading, Sides};

use super::query_ray::QueryRay;
use super::triangle::{Met, Triangle};
use super::values::CastMeeting;
use super::{ExactCast, bundle, moved_bundle};
use crate::bvh::{RayBundle, Traversal};
use crate::number::Interval;

impl ExactCast<'_> {
    /// The faces met at the smallest t, in ascending order: several if they are met at exactly the same t, none if the
    /// ray meets nothing. They may be too near for a sensor: [`reading`](Self::reading) tells.
    pub fn first(&self, ray: &CastRay, sides: Sides) -> Vec<FaceId> {
        self.nearest(ray, sides).iter().map(|face| face.id).collect()
    }

    /// What the ray's sensor reads: the faces of [`first`](Self::first), unless they are met before [`CastRay::t_blind`],
    /// exactly.
    ///
    /// ```
    /// use glam::DVec3;
    /// use raypencil_referee::ExactCast;
    /// use raypencil_scene::{CastRay, FaceId, Reading, Sides, Triangles};
    ///
    /// let corners = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    /// let triangle = Triangles::new(corners, vec![[0, 1, 2]])?;
    /// let cast = ExactCast::new(&triangle);
    /// // Met at t = 1: a sensor that measures from there on sees it, one that is blind a step of f64 farther does not.
    /// let read = |t_blind: f64| {
    ///     let ray = CastRay { t_blind, ..CastRay::new(DVec3::new(0.25, 0.25, 1.0), DVec3::NEG_Z) };
    ///     cast.reading(&ray, Sides::Both)
    /// };
    /// assert_eq!(read(1.0), Reading::Hit(vec![FaceId(0)]));
    /// assert_eq!(read(1.0_f64.next_up()), Reading::TooNear);
    /// # Ok::<(), raypencil_scene::SceneError>(())
    /// ```
    pub fn reading(&self, ray: &CastRay, sides: Sides) -> Reading<Vec<FaceId>> {
        self.read(ray, &self.nearest(ray, sides)).map(|faces| faces.iter().map(|face| face.id).collect())
    }

    /// The first hit as the ray's sensor reads it, whose values are formed when they are asked for, and the number of faces at
    /// its t. Of several faces it is on the lowest.
    ///
    /// ```
    /// use glam::DVec3;
    /// use raypencil_referee::ExactCast;
    /// use raypencil_scene::{CastRay, FaceId, Sides, Triangles};
    ///
    /// let corners = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    /// let triangle = Triangles::new(corners, vec![[0, 1, 2]])?;
    /// let ray = CastRay::new(DVec3::new(0.25, 0.25, 1.0), DVec3::new(0.0, 0.0, -2.0));
    /// let cast = ExactCast::new(&triangle);
    /// let read = cast.first_meeting(&ray, Sides::Both);
    /// let (meeting, ties) = read.hit().unwrap();
    /// assert_eq!((meeting.face(), *ties, meeting.t().double), (FaceId(0), 1, 0.5));
    /// # Ok::<(), raypencil_scene::SceneError>(())
    /// ```
    pub fn first_meeting<'r>(&self, ray: &'r CastRay, sides: Sides) -> Reading<(CastMeeting<'r>, u32)> {
        let query = QueryRay::new(ray);
        let nearest = self.nearest_of(&query, &bundle(ray), sides);
        let Some(&face) = nearest.first() else { return Reading::Miss };
        if ray.t_blind > 0.0 && face.is_before(ray.t_blind, &query) {
            return Reading::TooNear;
        }
        let side = face.seen_side(&query).expect("a face that is met is not parallel");
        Reading::Hit((CastMeeting::new(ray, query, *face, side), nearest.len() as u32))
    }

    /// What the ray's sensor reads of the nearest faces.
    pub(super) fn read<'f>(&self, ray: &CastRay, nearest: &'f [&'f Triangle]) -> Reading<&'f [&'f Triangle]> {
        let met = (!nearest.is_empty()).then_some(nearest);
        // Most rays have no shortest range; the faces of a tie are all at one t.
        let is_too_near =
            |met: &&[&Triangle]| ray.t_blind > 0.0 && met[0].is_before(ray.t_blind, &QueryRay::new(ray));
        Reading::of(met, is_too_near)
    }

    /// The faces that [`first`](Self::first) would give for the ray moved sideways, parallel to itself: its origin is
    /// exactly o + a u + b v, with `by` = \[a, b\] and u, v of [`CastRay::across`].
    ///
    /// ```
    /// use glam::DVec3;
    /// use raypencil_referee::ExactCast;
    /// use raypencil_scene::{CastRay, FaceId, Sides, Triangles};
    ///
    /// let corners = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    /// let triangle = Triangles::new(corners, vec![[0, 1, 2]])?;
    /// let ray = CastRay::new(DVec3::new(0.25, 0.25, 1.0), DVec3::NEG_Z);
    /// // Across this ray, u is y and v is x. On the border the triangle is met, one step of f64 farther it is not.
    /// let cast = ExactCast::new(&triangle);
    /// assert_eq!(cast.first_moved(&ray, Sides::Both, [0.5, 0.0]), [FaceId(0)]);
    /// assert!(cast.first_moved(&ray, Sides::Both, [0.5_f64.next_up(), 0.0]).is_empty());
    /// # Ok::<(), raypencil_scene::SceneError>(())
    /// ```
    pub fn first_moved(&self, ray: &CastRay, sides: Sides, by: [f64; 2]) -> Vec<FaceId> {
        let query = QueryRay::moved(ray, by);
        self.nearest_of(&query, &moved_bundle(ray, by), sides).iter().map(|face| face.id).collect()
    }

    /// Whether the ray meets anything.
    pub fn any(&self, ray: &CastRay, sides: Sides) -> bool {
        let (query, bundle) = (QueryRay::new(ray), bundle(ray));
        let mut walk = Traversal::new(&self.tree.bvh, &bundle);
        while let Some(leaf) = walk.next_leaf(bundle.max_range) {
            if leaf.iter().any(|face| face.met_side(&query, sides).is_some()) {
                return true;
            }
        }
        false
    }

    /// The nearest faces, in ascending order.
    pub(super) fn nearest(&self, ray: &CastRay, sides: Sides) -> Vec<&Triangle> {
        self.nearest_of(&QueryRay::new(ray), &bundle(ray), sides)
    }

    fn nearest_of(&self, query: &QueryRay<'_>, bundle: &RayBundle, sides: Sides) -> Vec<&Triangle> {
        let mut nearest: Vec<&Triangle> = Vec::new();
        // What contains the t of all of them.
        let mut of_nearest = Interval::between(f64::INFINITY, f64::INFINITY);
        let length = query.fast().direction.length_squared().high.sqrt();
        let mut farthest = bundle.max_range;
        self.tree.bvh.visit(bundle, |face| {
            let Some(Met { t, .. }) = face.met(query, sides) else { return farthest };
            // By the intervals of t where these are apart, else exactly.
            let order = match nearest.first() {
                None => Ordering::Less,
                Some(_) if t.low > of_nearest.high => Ordering::Greater,
                Some(_) if t.high < of_nearest.low => Ordering::Less,
                Some(kept) => face.compare(kept, query),
            };
            match order {
                Ordering::Less => {
                    nearest.clear();
                    nearest.push(face);
                    of_nearest = t;
                    // From here on only faces up to the nearest matter. Two roundings, each below 2^-52.
                    farthest = (t.high * length * (1.0 + 8.0 * f64::EPSILON)).min(bundle.max_range);
                }
                Ordering::Equal => nearest.push(face),
                Ordering::Greater => {}
            }
            farthest
        });
        nearest.sort_by_key(|face| face.id);
        nearest
    }
}
