//! What holds for a ray with every displacement of a square, told without trying any of them.
//!
//! Such a ray is a ray in intervals: what an interval says with certainty holds for each displacement of the square. Interval
//! arithmetic is monotone, so it also holds for the rounded t of each moved ray, which lies in the interval of the square.
//!
//! So it is known of most rays that their answer is the same for all displacements: all rays of the square meet one face, clearly
//! before all others.

use std::cmp::Ordering;

use raypencil_scene::{CastRay, FaceId, Side, Sides};

use super::query_ray::RayNumbers;
use super::triangle::Triangle;
use super::{ExactCast, moved_bundle};
use crate::numbers::number::{Interval, Number};
use crate::trees::bvh::RayBundle;

/// A ray with all displacements of a square.
pub(super) struct Square(RayNumbers<Interval>);

impl Square {
    /// All displacements whose parts are at most `most`.
    pub(super) fn new(ray: &CastRay, most: f64) -> Self {
        Self(RayNumbers::moved(ray, [Interval::between(-most, most); 2]))
    }

    /// On which side of each edge all rays pass; `None` where that is not certain.
    fn sides(&self, face: &Triangle) -> [Option<Ordering>; 3] {
        [0, 1, 2].map(|k| face.edge::<Interval>(k, &self.0).sign())
    }

    /// Whether all rays pass certainly outside of the face.
    pub(super) fn is_outside(&self, face: &Triangle) -> bool {
        let sides = self.sides(face);
        sides.contains(&Some(Ordering::Less)) && sides.contains(&Some(Ordering::Greater))
    }

    /// Whether all rays pass certainly inside the three edges.
    pub(super) fn is_inside(&self, face: &Triangle) -> bool {
        let sides = self.sides(face);
        [Ordering::Less, Ordering::Greater].iter().any(|&side| sides == [Some(side); 3])
    }

    /// Whether all rays see a side of the face that does not count.
    fn is_unseen(&self, face: &Triangle, sides: Sides) -> bool {
        let side = match face.approach(&self.0).sign() {
            Some(Ordering::Less) => Side::Front,
            Some(Ordering::Greater) => Side::Back,
            _ => return false,
        };
        !sides.include(side)
    }

    /// What contains the t of a face's plane for every ray.
    pub(super) fn t(&self, face: &Triangle) -> Interval {
        face.height(&self.0).over(face.approach(&self.0))
    }
}

impl ExactCast<'_> {
    /// Whether the ray certainly meets the same face, clearly before all others, wherever it is moved by at most `most` along both
    /// vectors of [`CastRay::across`]; or misses everywhere. A sensor's ray must also be clearly not, or clearly, too near.
    ///
    /// This looks once at the faces around, in intervals, and says less than [`margins`](Self::margins): `false` is no statement.
    ///
    /// ```
    /// use glam::DVec3;
    /// use raypencil_referee::ExactCast;
    /// use raypencil_scene::{CastRay, Sides, Triangles};
    ///
    /// let corners = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    /// let triangle = Triangles::new(corners, vec![[0, 1, 2]])?;
    /// let ray = CastRay::new(DVec3::new(0.25, 0.25, 1.0), DVec3::NEG_Z);
    /// let is_steady = |most: f64| ExactCast::new(&triangle).is_steady(&ray, Sides::Both, most);
    /// // The nearest edges are 0.25 away.
    /// assert!(is_steady(0.2));
    /// assert!(!is_steady(0.3));
    /// # Ok::<(), raypencil_scene::SceneError>(())
    /// ```
    pub fn is_steady(&self, ray: &CastRay, sides: Sides, most: f64) -> bool {
        let square = Square::new(ray, most);
        let first = self.nearest(ray, sides);
        let nearest = match first.as_slice() {
            [] => None,
            [face] => Some((face.id, square.t(face))),
            // Copies of a face, or a seam.
            _ => return false,
        };
        if let Some((_, t)) = nearest {
            let is_within = t.low >= ray.t_min && t.high <= ray.t_max;
            let is_clearly_near_or_far = t.low > ray.t_blind || t.high < ray.t_blind;
            if !is_within || !is_clearly_near_or_far || !square.is_inside(&first[0]) {
                return false;
            }
        }
        let up_to = nearest.map_or(ray.t_max, |(_, t)| t.high);
        let around = around(&CastRay { t_max: up_to, ..*ray }, most);
        let mut is_alone = true;
        self.bvh().visit(&around, |face| {
            let is_nearest = nearest.is_some_and(|(id, _)| id == face.id);
            if is_alone && !is_nearest && !square.is_outside(face) && !square.is_unseen(face, sides) {
                let t = square.t(face);
                is_alone = t.high < ray.t_min || t.low > up_to;
            }
            if is_alone { around.max_range } else { -1.0 }
        });
        is_alone
    }

    /// The faces that the ray may meet between its ends where it is moved by at most `most` along both vectors of
    /// [`CastRay::across`], in the order of their numbers. None that it can meet is left out; some that it cannot may be among them.
    ///
    /// ```
    /// use glam::DVec3;
    /// use raypencil_referee::ExactCast;
    /// use raypencil_scene::{CastRay, FaceId, Sides, Triangles};
    ///
    /// let corners = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]];
    /// let square = Triangles::new(corners, vec![[0, 1, 2], [1, 3, 2]])?;
    /// let (exact, ray) = (ExactCast::new(&square), CastRay::new(DVec3::new(0.25, 0.25, 1.0), DVec3::NEG_Z));
    /// assert_eq!(exact.faces_near(&ray, Sides::Both, 0.2), [FaceId(0)]);
    /// assert_eq!(exact.faces_near(&ray, Sides::Both, 0.3), [FaceId(0), FaceId(1)]);
    /// # Ok::<(), raypencil_scene::SceneError>(())
    /// ```
    pub fn faces_near(&self, ray: &CastRay, sides: Sides, most: f64) -> Vec<FaceId> {
        let (square, around) = (Square::new(ray, most), around(ray, most));
        let mut near = Vec::new();
        self.bvh().visit(&around, |face| {
            if !square.is_outside(face) && !square.is_unseen(face, sides) {
                let t = square.t(face);
                if !(t.high < ray.t_min || t.low > ray.t_max) {
                    near.push(face.id);
                }
            }
            around.max_range
        });
        near.sort_unstable();
        near
    }
}

/// The ray with all displacements of at most `most`, for the hierarchy.
pub(super) fn around(ray: &CastRay, most: f64) -> RayBundle {
    let bundle = moved_bundle(ray, [0.0; 2]);
    // The displacement has two parts at right angles. Moved rays are parallel, so faces at the ray's end are as far beside it.
    RayBundle {
        start_radius: bundle.start_radius + 2.0 * most,
        max_range: bundle.max_range + 2.0 * most,
        ..bundle
    }
}

#[cfg(test)]
#[path = "../../tests/unit/square.rs"]
mod tests;
