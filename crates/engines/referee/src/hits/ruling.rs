//! Rulings on a hit or a miss: whether an answer is right, or one that a correct renderer of finite precision may
//! give.
//!
//! The renderer sees a ray displaced by at most delta; finds ranges up to their errors; and cannot tell the front of a face from
//! its back where [both look alike](crate::hits::rounded_face) in its arithmetic. So an answer is admissible if *one* such displacement
//! makes it right:
//!
//! * a face F, if the displaced ray meets it, and no other face clearly before F: nearer by more than the errors of both ranges;
//! * a miss, if it meets no face clearly within its ends: farther from both than the error of the face's range. (A face that it
//!   meets exactly at an end is within: the contract says so, and round numbers have no error.)
//!
//! A face that is not clearly within the ends is not in the way of F either. An edge-on face never is: the error of its range
//! is larger than the range. The ruling contains the displacement. So a miss at an edge shared by two faces is not admissible,
//! unless both are edge-on or at an end of the ray: each displaced ray meets one of the two.

use std::cmp::Ordering;

use raypencil_scene::{FaceId, SensorId};

use crate::hits::face::{ExactRay, Face};
use crate::hits::face_forms::FaceForms;
use crate::hits::region::Region;
use crate::hits::rounded_face::RoundedFace;
use crate::hits::through_point::{displacements_between_sides, displacements_inside_corners};
use crate::hits::verdict::{Referee, bundle};
use crate::rays::displacement::Displacement;
use crate::rays::moving_ray::MovingRay;
use crate::rays::ray::{Aim, MountedSensor};

/// The tolerances that follow from a renderer's arithmetic.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tolerance {
    /// delta: displacement of a ray, cells of the sensor; clamped to 0..=1.
    pub lateral: f64,
    /// epsilon: error of the range of the face that is named, metres.
    pub depth: f64,
    /// Error of a terrain point's position, metres. Rulings on visibility use it, and explanations by the paper's
    /// approximations, whose sides and limits are computed themselves.
    pub position: f64,
    /// u: the largest relative error of one rounding. The errors of other faces' ranges and normals follow from it.
    pub unit_roundoff: f64,
}

/// The referee's ruling on one answer to one ray, of a sensor or of none.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Ruling {
    /// The exact answer.
    Exact,
    /// One of several faces met at exactly the same point.
    Tie,
    /// The answer of the ray displaced by this, but for errors of ranges, and for faces whose front the renderer cannot tell
    /// from their back.
    Rounding(Displacement),
    /// No ray within the tolerance has this answer.
    Wrong,
}

impl Referee<'_> {
    /// The ruling on `answer`, a face or a miss, to the ray of cell (i, j); `None` if there is no such cell or face.
    ///
    /// ```
    /// # mod wall { include!(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/common/wall.rs")); }
    /// # use wall::wall_scene;
    /// use raypencil_referee::{Referee, Ruling, Tolerance};
    /// use raypencil_scene::SensorId;
    ///
    /// let scene = wall_scene();
    /// let referee = Referee::new(&scene);
    /// let rule_on_miss = |lateral: f64| {
    ///     let tolerance = Tolerance { lateral, depth: 0.0, position: 0.0, unit_roundoff: 0.0 };
    ///     referee.rule(SensorId::Camera, 4, 4, None, tolerance).unwrap()
    /// };
    /// // Pixel (4, 4) hits the wall, which ends half a cell to the right: a miss is excused only beyond that.
    /// assert_eq!(rule_on_miss(0.4), Ruling::Wrong);
    /// assert!(matches!(rule_on_miss(0.6), Ruling::Rounding(by) if by.dx > 0.5));
    /// ```
    pub fn rule(
        &self,
        sensor: SensorId,
        i: u32,
        j: u32,
        answer: Option<FaceId>,
        tolerance: Tolerance,
    ) -> Option<Ruling> {
        self.rule_within(sensor, i, j, answer, || tolerance)
    }

    /// The same, the tolerance being asked for only where the answer is not the exact one.
    pub fn rule_within(
        &self,
        sensor: SensorId,
        i: u32,
        j: u32,
        answer: Option<FaceId>,
        tolerance: impl FnOnce() -> Tolerance,
    ) -> Option<Ruling> {
        let (sensor, aim) = self.sensor_and_aim(sensor, i, j)?;
        let nearest = self.nearest(&sensor, aim);
        match answer {
            None if nearest.is_empty() => return Some(Ruling::Exact),
            Some(face) if nearest.iter().any(|kept| kept.id == face) => {
                return Some(if nearest.len() == 1 { Ruling::Exact } else { Ruling::Tie });
            }
            _ => {}
        }
        let tolerance = tolerance();
        let lateral = tolerance.lateral.clamp(0.0, 1.0);
        let witness = match answer {
            None => self.displaced_miss(&sensor, aim, &nearest, Tolerance { lateral, ..tolerance }),
            Some(id) => {
                let mesh = self.scene.mesh();
                if id.0 as usize >= mesh.faces().len() {
                    return None;
                }
                let face = Face::of(mesh, id);
                self.displaced_hit(&sensor, aim, &face, Tolerance { lateral, ..tolerance })
            }
        };
        Some(witness.map_or(Ruling::Wrong, Ruling::Rounding))
    }

    /// A ray within the tolerance that may be said to miss everything; searched for where a nearest face ends.
    fn displaced_miss(
        &self,
        sensor: &MountedSensor,
        aim: Aim,
        nearest: &[&Face],
        tolerance: Tolerance,
    ) -> Option<Displacement> {
        let lateral = tolerance.lateral;
        let ray = MovingRay::new(sensor, aim);
        let mut tried = vec![[0.0, 0.0]];
        for face in nearest {
            for form in FaceForms::new(&ray, face).conditions() {
                if form.holds_within() < lateral {
                    let away = |slope: f64| if slope > 0.0 { -lateral } else { lateral };
                    tried.push([away(form.x), away(form.y)]);
                }
            }
        }
        // Where two ends meet, the gap may lie in another direction than either.
        for x in [-1.0, 0.0, 1.0] {
            for y in [-1.0, 0.0, 1.0] {
                tried.push([x * lateral, y * lateral]);
            }
        }
        let missed =
            |[dx, dy]: &[f64; 2]| self.is_right_for(sensor, Aim { dx: *dx, dy: *dy, ..aim }, None, tolerance);
        tried.into_iter().find(missed).map(|[dx, dy]| Displacement { dx, dy })
    }

    /// A ray within the tolerance for which `face` may be named.
    fn displaced_hit(
        &self,
        sensor: &MountedSensor,
        aim: Aim,
        face: &Face,
        tolerance: Tolerance,
    ) -> Option<Displacement> {
        let ray = MovingRay::new(sensor, aim);
        let forms = FaceForms::new(&ray, face).conditions().map(|form| form.scaled(tolerance.lateral));
        let mut tried = vec![[0.0, 0.0]];
        if let Some(region) = Region::of(&forms) {
            // Rounding may put the region's nearest point just outside: also try points towards its middle, and its
            // corners.
            for inward in [0.0, 1e-6, 1e-3, 0.1, 1.0] {
                tried.push(
                    [0, 1].map(|k: usize| region.near[k] + inward * (region.middle[k] - region.near[k])),
                );
            }
            tried.extend(region.corners);
        }
        let scaled = |at: [f64; 2]| {
            at.map(|part| (part * tolerance.lateral).clamp(-tolerance.lateral, tolerance.lateral))
        };
        // Lazily: they are exact and hardly ever needed.
        let (most, once) = (tolerance.lateral, || std::iter::once(()));
        let corners = once().flat_map(|()| displacements_inside_corners(sensor, aim, face, most));
        let sides = once().flat_map(|()| displacements_between_sides(sensor, aim, face, most));
        tried
            .into_iter()
            .map(scaled)
            .chain(corners)
            .chain(sides)
            .find(|&[dx, dy]| self.is_right_for(sensor, Aim { dx, dy, ..aim }, Some(face), tolerance))
            .map(|[dx, dy]| Displacement { dx, dy })
    }

    /// Whether a face, or a miss, is the answer of this ray up to the errors of ranges and normals.
    fn is_right_for(
        &self,
        sensor: &MountedSensor,
        aim: Aim,
        answer: Option<&Face>,
        tolerance: Tolerance,
    ) -> bool {
        let ray = ExactRay::new(sensor, aim);
        let (start, end) = (ray.start_range(), sensor.max_range());
        let seen = |face: &Face| RoundedFace::of(face, &ray, tolerance.unit_roundoff);
        // Of a face too thin for f64 the error is not a number: its range is anything.
        let depth = if tolerance.depth.is_nan() { f64::INFINITY } else { tolerance.depth };
        let named = match answer {
            None => None,
            Some(face) => {
                // A face exactly parallel to the ray is never met. That is strict: rounding may turn its normal.
                let Some(named) = seen(face).filter(|_| face.is_crossed_by(&ray)) else { return false };
                let is_within = named.range + depth >= start && named.range - depth <= end;
                if !is_within || (named.is_back && !named.is_edge_on) {
                    return false;
                }
                Some((face, named))
            }
        };
        let mut is_right = true;
        self.bvh.visit(&bundle(sensor, aim, 0.0), |face| {
            if is_right
                && face.is_met_by(&ray, end)
                && let Some(met) = seen(face)
            {
                let may_be_beyond = met.range + met.range_error > end || met.range - met.range_error < start;
                is_right = (may_be_beyond && !face.is_at_an_end(&ray, end))
                    || named.is_some_and(|(named, at)| {
                        let is_before = at.is_back || named.compare(face, &ray) == Ordering::Greater;
                        !is_before || at.range - met.range <= depth + met.range_error
                    });
            }
            if is_right { end } else { f64::NEG_INFINITY }
        });
        is_right
    }
}
