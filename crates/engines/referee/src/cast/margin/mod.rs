//! How far a ray may be moved sideways, parallel to itself, before its answer changes.
//!
//! A displacement is a pair (a, b): the ray from o + a u + b v with the same direction and ends, where u and v are the two
//! stored vectors across the ray (`CastRay::across`). Its size is the larger of |a| and |b|, in the mesh's unit.
//!
//! ```text
//! frame      the ray's own frame, in which faces are triangles in a plane, and t is linear on each
//! flat       a face in it, and its conditions as linear functions of the displacement
//! region     the least displacement at which some linear conditions hold
//! looks      counts faces that are looked at, for the tests
//! copies     faces that lie in the place of another: of these one counts
//! seams      which edges two faces continue, and in which parts of the mesh there are only such
//! view       which sides of faces the ray sees
//! nearby     faces in the order of the displacement that they need
//! faces      the margin of the set of nearest faces
//! segment    a piece of a face's border, and what of it is hidden
//! screen     whether a surface hides an edge wholly, in plain f64
//! hidden     how far a surface hides such a piece, without exact arithmetic
//! surface    the margin of the surface: the nearest t jumps
//! ```
//!
//! The answer of a sensor's ray is its nearest faces and whether these are too near ([`CastRay::t_blind`]). As long as they are not,
//! they are also the first that the ray meets from `t_blind` on; as long as they are too near, the first that it meets up to
//! there. So the least displacement that changes the answer is the smaller one of two rays: of the whole ray, and of the ray
//! that begins, or ends, at `t_blind`.
//!
//! Everything is decided by signs of polynomials of stored numbers, in intervals first and exactly where these are in
//! doubt. So a margin is the exact least size but for its rounding to f64, and no search can fail to find it.

mod copies;
mod faces;
mod flat;
mod frame;
mod hidden;
mod looks;
mod nearby;
mod region;
mod screen;
mod seams;
mod segment;
mod surface;
mod view;

use raypencil_scene::{CastRay, Reading, Sides};

use super::ExactCast;
use crate::margins::margin::{Margin, Margins};
use crate::rays::displacement::Displacement;
pub(super) use faces::onto_face;
pub(super) use frame::Frame;
use screen::Screen;
pub(super) use seams::Seams;
use view::View;

/// The margin of an answer that changes if either of two does.
fn of_either(one: Margin, other: Margin) -> Margin {
    let witness = if other.hi < one.hi { other.witness } else { one.witness };
    Margin { lo: one.lo.min(other.lo), hi: one.hi.min(other.hi), witness }
}

/// From a proven interval of the least size. A witness counts if it is as small but for a hundredth, or for `least`, a size
/// below which `f64` numbers hardly tell rays apart.
fn within([lo, hi]: [f64; 2], witness: Option<[f64; 2]>, least: f64, cap: f64) -> Margin {
    if lo >= cap {
        return Margin { lo: cap, hi: cap, witness: None };
    }
    let witness = witness.map(Displacement::from).filter(|by| by.max_norm() <= (hi * 1.01).max(hi + least));
    Margin { lo, hi: witness.as_ref().map_or(hi, Displacement::max_norm).max(hi).min(cap), witness }
}

impl ExactCast<'_> {
    /// How far the ray may be moved sideways before the nearest faces, or the surface, change.
    ///
    /// The first call of any ray looks at all edges of the mesh once.
    ///
    /// ```
    /// use glam::DVec3;
    /// use raypencil_referee::ExactCast;
    /// use raypencil_scene::{CastRay, Sides, Triangles};
    ///
    /// // A square from 0 to 1 of two faces, met from above a quarter beside its diagonal.
    /// let corners = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    /// let square = Triangles::new(corners, vec![[0, 1, 2], [0, 2, 3]])?;
    /// let ray = CastRay::new(DVec3::new(0.5, 0.25, 3.0), DVec3::NEG_Z);
    /// let margins = ExactCast::new(&square).margins(&ray, Sides::Both);
    /// // The diagonal is reached by 1/8 in x and in y, the square's border by 1/4 in y.
    /// assert!(margins.face.lo <= 0.125 && 0.125 <= margins.face.hi && margins.face.hi < 0.126);
    /// assert!(margins.surface.lo <= 0.25 && 0.25 <= margins.surface.hi && margins.surface.hi < 0.251);
    /// # Ok::<(), raypencil_scene::SceneError>(())
    /// ```
    pub fn margins(&self, ray: &CastRay, sides: Sides) -> Margins {
        let whole = self.margins_between_ends(ray, sides);
        if ray.t_blind <= ray.t_min {
            return whole;
        }
        let on_its_side = match self.reading(ray, sides) {
            Reading::Miss => return whole,
            Reading::Hit(_) => CastRay { t_min: ray.t_blind, ..*ray },
            Reading::TooNear => CastRay { t_max: ray.t_blind, ..*ray },
        };
        let cut = self.margins_between_ends(&on_its_side, sides);
        Margins { face: of_either(whole.face, cut.face), surface: of_either(whole.surface, cut.surface) }
    }

    /// The margins of the nearest hit between the ray's ends, wherever it is.
    fn margins_between_ends(&self, ray: &CastRay, sides: Sides) -> Margins {
        let frame = Frame::new(ray);
        let nearest = self.nearest(ray, sides);
        let view = View::new(self.mesh, self.seams(), ray, sides);
        let face = self.face_margin(&frame, &nearest, &view);
        // Where nothing is hit, what changes the faces changes the surface.
        if nearest.is_empty() {
            return Margins { face, surface: face };
        }
        let screen = Screen::new(&frame, self.tree.largest_coordinate);
        let surface = self.surface_margin(&frame, face.lo, &view, screen.as_ref());
        Margins { face, surface }
    }
}

#[cfg(test)]
#[path = "../../../tests/unit/cast_margin_paths.rs"]
mod tests;
