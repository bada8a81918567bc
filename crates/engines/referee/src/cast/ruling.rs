//! Whether the answer that a program in rounded arithmetic states for a ray can be excused by its rounding.
//!
//! # The rule
//!
//! A program whose numbers have the unit roundoff u, and whose coordinates are at most S from the ray's origin, sees a
//! vertex within 8 u S of where it is (three subtractions and a product for each coordinate, and the rounding of vertices
//! and ray when they are stored), so it decides an edge as for a ray that is moved sideways by as much. It is charged
//! twice that, delta = 16 u S. It finds the t of a face from n.a' / n.d: the range is then wrong by at most 36 kappa u S / c,
//! with kappa the [aspect] of the face and c the cosine between ray and normal. It is charged twice that too. Where c is below
//! (5 kappa + 15) u, charged twice, it may take the front of the face [for its back](crate::hits::rounded_face).
//!
//! So a stated face F is excused if there is *one* displacement of at most delta at which the moved ray meets F exactly,
//! within the ray's ends, and every face that it meets before F is as near to F as the errors of both ranges. A stated miss
//! is excused if there is one displacement at which nothing is met. Ends of the ray are moved by the error of a range. (Of a
//! face that is edge-on this error is more than 2 S, so it is never in the way.)
//!
//! The shortest range of a sensor, `t_blind`, is moved by the error of a range as the ends are: a face whose t differs from it by no
//! more may be measured, and may be too near. (The program rounds `t_blind` itself by u t, at most 2 u S in ranges of its mesh,
//! and may compare the range of a unit direction in place of t, which is as much again. The 36 that are charged twice cover it.)
//! So a stated face is excused only if it may lie at `t_blind` or beyond, and 'too near' if there is one displacement at
//! which a face is met that may lie before it. Whoever looks through a face that is too near is not excused: that face is clearly
//! before the one behind it. Nor is a miss: something is clearly met.
//!
//! The displacement is the witness: it can be put into [`ExactCast::first_moved`] (but for that of a needle's corner, below).
//!
//! A ray cannot slip through an edge that two faces share in this rule, as it can in one that excuses face by face: the
//! moved ray meets one of the two.
//!
//! # The search
//!
//! What is clearly out of the reach of a whole [square](super::square) of displacements is wrong at once. For the rest,
//! displacements are tried, exactly: none; onto the stated face, into the middle of what is near; off the faces that are in the way,
//! over their nearest edge; and around, in 16 directions and three sizes. The displacements that meet a needle form a strip about
//! as thin as the spacing of f64 numbers: there its corners are tried, too, exactly. (The witness of a corner is the displacement
//! to it, rounded.) Only what is found is excused: a missed witness makes the ruling stricter, never milder.

use glam::{DVec2, DVec3};
use raypencil_scene::{CastRay, FaceId, Precision, Reading, Sides};

use super::margin::{Frame, onto_face};
use super::query_ray::QueryRay;
use super::square::{Square, around};
use super::triangle::Triangle;
use super::{ExactCast, moved_bundle};
use crate::hits::rounded_face::least_cosine;
use crate::hits::ruling::Ruling;
use crate::{RANGE_ROUNDINGS, aspect};

/// How often the errors of the rule are charged, sideways: 8 u S twice.
const LATERAL: f64 = 16.0;
/// The same along the ray: 36 kappa u S / c twice.
const ALONG: f64 = 2.0 * RANGE_ROUNDINGS;

/// From this aspect on a face is a needle: f64 has lost six digits of its normal, and of the strip of displacements that meet it.
const LEAST_ASPECT_OF_NEEDLES: f64 = (1 << 20) as f64;

impl ExactCast<'_> {
    /// Rules on the first hit that a program of this precision states, or on what it states in place of one. A displacement is
    /// along the two vectors of [`CastRay::across`], each part at most [`Self::lateral_error`].
    ///
    /// ```
    /// use glam::DVec3;
    /// use raypencil_referee::{ExactCast, Ruling};
    /// use raypencil_scene::{CastRay, FaceId, Precision, Reading, Sides, Triangles};
    ///
    /// let corners = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    /// let triangle = Triangles::new(corners, vec![[0, 1, 2]])?;
    /// let cast = ExactCast::new(&triangle);
    /// let rule = |x: f64, stated: Reading<FaceId>| {
    ///     let ray = CastRay::new(DVec3::new(x, 0.25, 1.0), DVec3::NEG_Z);
    ///     cast.rule(&ray, Sides::Both, stated, Precision::F64)
    /// };
    /// assert_eq!(rule(0.0, Reading::Hit(FaceId(0))), Ruling::Exact);
    /// // It may be missed on its border, and not a micrometre inside.
    /// assert!(matches!(rule(0.0, Reading::Miss), Ruling::Rounding(_)));
    /// assert_eq!(rule(1e-6, Reading::Miss), Ruling::Wrong);
    /// assert_eq!(rule(-1e-6, Reading::Hit(FaceId(0))), Ruling::Wrong);
    /// # Ok::<(), raypencil_scene::SceneError>(())
    /// ```
    pub fn rule(&self, ray: &CastRay, sides: Sides, stated: Reading<FaceId>, precision: Precision) -> Ruling {
        let first = self.nearest(ray, sides);
        match (stated, self.read(ray, &first)) {
            (Reading::Hit(face), Reading::Hit(met)) if met.iter().any(|met| met.id == face) => {
                return if met.len() == 1 { Ruling::Exact } else { Ruling::Tie };
            }
            (Reading::TooNear, Reading::TooNear) | (Reading::Miss, Reading::Miss) => return Ruling::Exact,
            _ => {}
        }
        let stated = match stated {
            Reading::Hit(face) => match self.triangle(face).filter(Triangle::has_area) {
                Some(face) => Reading::Hit(face),
                None => return Ruling::Wrong,
            },
            // Nothing is too near for a ray of no such sensor.
            Reading::TooNear if ray.t_blind == 0.0 => return Ruling::Wrong,
            Reading::TooNear => Reading::TooNear,
            Reading::Miss => Reading::Miss,
        };
        let trial = Trial { cast: self, ray, sides, precision, frame: Frame::new(ray), stated };
        let most = self.lateral_error(ray, precision);
        if trial.is_out_of_reach(&first, most) {
            return Ruling::Wrong;
        }
        let mut usual = trial.displacements(&first, most).into_iter();
        let witness = usual.find(|&by| trial.excuses(by));
        let witness = witness.or_else(|| {
            trial.corners_of_needle(most).find(|corner| trial.excuses_at(corner)).map(|corner| corner.by)
        });
        witness.map_or(Ruling::Wrong, |moved| Ruling::Rounding(moved.into()))
    }

    /// How far sideways the edges of faces may seem to be moved for a program of this precision: 16 u S, in the
    /// mesh's unit.
    pub fn lateral_error(&self, ray: &CastRay, precision: Precision) -> f64 {
        LATERAL * precision.unit_roundoff * self.size(ray)
    }

    /// How far the range of a face may be wrong for a program of this precision: 72 kappa u S / c, in the mesh's
    /// unit. Infinite for a face that is parallel to the ray or has no area, and where there is no such face.
    pub fn range_error(&self, ray: &CastRay, face: FaceId, precision: Precision) -> f64 {
        ALONG * precision.unit_roundoff * self.size(ray) * self.aspect_over_cosine(ray, face)
    }

    /// Whether a program of this precision may take the front of a face for its back: it is edge-on, or so thin that its normal is
    /// rounding alone.
    pub fn may_turn_side(&self, ray: &CastRay, face: FaceId, precision: Precision) -> bool {
        self.triangle(face).is_some_and(|face| is_edge_on(ray, &face, precision))
    }

    /// S: no coordinate seen from the ray's origin is larger.
    fn size(&self, ray: &CastRay) -> f64 {
        self.tree.largest_coordinate + ray.origin.abs().max_element()
    }
}

/// Whether a program of this precision may take the front of a face for its back: c <= 2 (5 kappa + 15) u.
fn is_edge_on(ray: &CastRay, face: &Triangle, precision: Precision) -> bool {
    let kappa = aspect(face.corners);
    let cosine = kappa / face.aspect_over_cosine(ray);
    cosine <= 2.0 * least_cosine(kappa, precision.unit_roundoff)
}

/// A corner of a face beside the ray.
struct Corner {
    place: DVec3,
    /// The displacement that brings the ray there, to a few roundings.
    by: [f64; 2],
}

/// One stated answer.
struct Trial<'a> {
    cast: &'a ExactCast<'a>,
    ray: &'a CastRay,
    sides: Sides,
    precision: Precision,
    frame: Frame<'a>,
    stated: Reading<Triangle>,
}

impl Trial<'_> {
    /// Whether certainly none of the displacements up to `most` excuses the answer; `first` is what the ray meets where it is. All
    /// moved rays pass outside of the stated face; or all meet another one, which is clearly in the way of the stated face, or of a
    /// miss. Most wrong answers are of these kinds.
    fn is_out_of_reach(&self, first: &[Triangle], most: f64) -> bool {
        let square = Square::new(self.ray, most);
        let CastRay { t_min, t_max, .. } = *self.ray;
        let (stated, error_of_stated) = match &self.stated {
            Reading::Hit(stated) if square.is_outside(stated) => return true,
            Reading::Hit(stated) => (square.t(stated).low, self.range_error_in_t(stated)),
            Reading::Miss => (f64::INFINITY, 0.0),
            Reading::TooNear => return false,
        };
        first.iter().any(|face| {
            let (t, error) = (square.t(face), self.range_error_in_t(face));
            let is_within_ends = t.low - error >= t_min && t.high + error <= t_max;
            is_within_ends && t.high + error + error_of_stated < stated && square.is_inside(face)
        })
    }

    /// Displacements that may excuse the answer, none larger than `most`.
    fn displacements(&self, first: &[Triangle], most: f64) -> Vec<[f64; 2]> {
        let mut tried = vec![DVec2::ZERO];
        let query = QueryRay::new(self.ray);
        for face in self.sought(most) {
            let Some(side) = face.seen_side(&query) else { continue };
            let onto = |share: f64| onto_face(&self.frame, &face, side, share * most);
            tried.extend([0.0625, 0.25, 1.0].into_iter().filter_map(onto).map(DVec2::from_array));
        }
        for face in first {
            let corners = self.flat(face);
            for k in 0..3 {
                let (from, to) = (corners[k], corners[(k + 1) % 3]);
                let nearest = nearest_on_segment(from, to);
                let along = (to - from).normalize_or_zero();
                let sideways = [along.perp(), -along.perp()];
                for outward in sideways {
                    tried.extend([0.0625, 0.25, 0.5].map(|share| nearest + outward * (share * most)));
                }
            }
        }
        for direction in AROUND {
            tried.extend([0.25, 0.5, 1.0].map(|share| DVec2::from_array(direction) * (share * most)));
        }
        let is_small = |by: &DVec2| by.abs().max_element() <= most;
        tried.into_iter().filter(is_small).map(|by| by.to_array()).collect()
    }

    /// The stated face, if it is a needle.
    fn needle(&self) -> Option<&Triangle> {
        self.stated.hit().filter(|face| aspect(face.corners) >= LEAST_ASPECT_OF_NEEDLES)
    }

    /// The corners of the stated face that a ray may be moved to, if it is a needle.
    fn corners_of_needle(&self, most: f64) -> impl Iterator<Item = Corner> + '_ {
        let corners = self.needle().into_iter().flat_map(|face| face.corners);
        let corners = corners.map(|place| Corner { place, by: self.frame.displacement_to(place).to_array() });
        corners.filter(move |corner| corner.by.iter().all(|part| part.abs() <= most))
    }

    /// The faces of which a moved ray must meet one: the stated face, or all that are too near and no farther beside the ray
    /// than is charged.
    fn sought(&self, most: f64) -> Vec<Triangle> {
        match self.stated {
            Reading::Hit(face) => vec![face],
            Reading::Miss => Vec::new(),
            Reading::TooNear => {
                let around = around(self.ray, most);
                let query = QueryRay::new(self.ray);
                let mut beside = Vec::new();
                self.cast.bvh().visit(&around, |face| {
                    let (t, error) = self.t_and_error(face, &query);
                    if t - error < self.ray.t_blind && t + error >= self.ray.t_min {
                        beside.push(*face);
                    }
                    around.max_range
                });
                beside
            }
        }
    }

    /// The corners as displacements that bring the ray to them.
    fn flat(&self, face: &Triangle) -> [DVec2; 3] {
        face.corners.map(|corner| self.frame.displacement_to(corner))
    }

    /// The t of a face, rounded, and the error that its range is charged with, as a part of t.
    fn t_and_error(&self, face: &Triangle, query: &QueryRay<'_>) -> (f64, f64) {
        (face.t_of_plane(query), self.range_error_in_t(face))
    }

    /// The error that the range of a face is charged with, as a part of t.
    fn range_error_in_t(&self, face: &Triangle) -> f64 {
        self.cast.range_error(self.ray, face.id, self.precision) / QueryRay::length(self.ray)
    }

    /// The ray without its ends. No face is farther behind the origin than where it begins; faces a little before t_min are asked too.
    fn without_ends(&self) -> CastRay {
        let behind = -4.0 * self.cast.size(self.ray) / QueryRay::length(self.ray);
        CastRay { t_min: behind, t_max: f64::INFINITY, ..*self.ray }
    }

    /// Whether the answer is right for the ray moved by this.
    fn excuses(&self, by: [f64; 2]) -> bool {
        self.is_right_for(&QueryRay::moved(&self.without_ends(), by), by)
    }

    /// Whether the answer is right for the ray moved to a corner.
    fn excuses_at(&self, corner: &Corner) -> bool {
        self.is_right_for(&QueryRay::through(&self.without_ends(), corner.place), corner.by)
    }

    /// Whether the answer is right for a moved ray without ends; `by` is its displacement, to a few roundings.
    fn is_right_for(&self, query: &QueryRay<'_>, by: [f64; 2]) -> bool {
        let CastRay { t_min, t_max, t_blind, .. } = *self.ray;
        // Its t and the error of it, if the moved ray meets a face that may lie within the ray's ends.
        let met = |face: &Triangle| {
            let sides = if is_edge_on(self.ray, face, self.precision) { Sides::Both } else { self.sides };
            let (t, error) = self.t_and_error(face, query);
            let is_met = face.met_side(query, sides).is_some() && t + error >= t_min && t - error <= t_max;
            is_met.then_some((t, error))
        };
        let stated = match &self.stated {
            Reading::Miss => None,
            Reading::Hit(face) => match met(face) {
                Some((t, error)) if t + error >= t_blind => Some((t, error)),
                _ => return false,
            },
            Reading::TooNear => return self.is_any_too_near(by, met),
        };
        let bundle = moved_bundle(self.ray, by);
        let mut is_excused = true;
        self.cast.bvh().visit(&bundle, |face| {
            if is_excused && face.met_side(query, self.sides).is_some() {
                let (t, error) = self.t_and_error(face, query);
                // Clearly within the ray's ends, and clearly before the stated face.
                let is_met = t - error >= t_min && t + error <= t_max;
                let is_before = stated.is_none_or(|(stated, of_stated)| t + error + of_stated < stated);
                let is_stated = self.stated.hit().is_some_and(|stated| stated.id == face.id);
                if is_met && is_before && !is_stated {
                    is_excused = false;
                }
            }
            bundle.max_range
        });
        is_excused
    }
}

impl Trial<'_> {
    /// Whether the ray moved by this meets a face that may lie before the shortest range. What is met before that face is too
    /// near all the more.
    fn is_any_too_near(&self, by: [f64; 2], met: impl Fn(&Triangle) -> Option<(f64, f64)>) -> bool {
        let bundle = moved_bundle(self.ray, by);
        let mut is_any = false;
        self.cast.bvh().visit(&bundle, |face| {
            is_any = is_any || met(face).is_some_and(|(t, error)| t - error < self.ray.t_blind);
            bundle.max_range
        });
        is_any
    }
}

/// The place of a segment that is nearest to 0.
fn nearest_on_segment(from: DVec2, to: DVec2) -> DVec2 {
    let along = to - from;
    let share = -from.dot(along) / along.length_squared();
    if share.is_nan() { from } else { from + along * share.clamp(0.0, 1.0) }
}

/// Sixteen directions on the square around 0.
const AROUND: [[f64; 2]; 16] = [
    [1.0, 0.0],
    [1.0, 0.5],
    [1.0, 1.0],
    [0.5, 1.0],
    [0.0, 1.0],
    [-0.5, 1.0],
    [-1.0, 1.0],
    [-1.0, 0.5],
    [-1.0, 0.0],
    [-1.0, -0.5],
    [-1.0, -1.0],
    [-0.5, -1.0],
    [0.0, -1.0],
    [0.5, -1.0],
    [1.0, -1.0],
    [1.0, -0.5],
];

#[cfg(test)]
#[path = "../../tests/unit/cast_ruling.rs"]
mod tests;
