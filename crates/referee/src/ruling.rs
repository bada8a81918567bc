//! Rulings on a hit or a miss: whether an answer is right, or one that a correct renderer of finite precision may
//! give.
//!
//! A renderer with lateral tolerance delta and depth tolerance epsilon may give the exact answer of *some* ray
//! displaced by at most delta, or name a face that such a ray meets within epsilon of its true range. The ruling
//! contains that displacement. So a miss at an edge shared by two faces is never admissible: no displaced ray misses
//! there.

use raypencil_scene::{FaceId, SensorId};

use crate::displacement::Displacement;
use crate::face::{ExactRay, Face};
use crate::face_forms::FaceForms;
use crate::moving_ray::MovingRay;
use crate::ray::{Aim, MountedSensor};
use crate::region::Region;
use crate::through_point::{displacements_between_sides, displacements_inside_corners};
use crate::verdict::Referee;

/// The tolerances that follow from a renderer's arithmetic.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tolerance {
    /// delta: displacement of a ray, cells of the sensor; clamped to 0..=1.
    pub lateral: f64,
    /// epsilon: error of a range, metres.
    pub depth: f64,
    /// Error of a terrain point's position, metres. Rulings on visibility use it, and explanations by the paper's
    /// approximations, whose sides and limits are computed themselves.
    pub position: f64,
}

/// The referee's ruling on one answer to one ray.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Ruling {
    /// The exact answer.
    Exact,
    /// One of several faces met at exactly the same point.
    Tie,
    /// The answer of the ray displaced by this, or a face which that ray meets within epsilon of its range.
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
    ///     let tolerance = Tolerance { lateral, depth: 0.0, position: 0.0 };
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
            None => self.displaced_miss(&sensor, aim, &nearest, lateral),
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

    /// A ray within `lateral` cells that misses everything; searched for where a nearest face ends.
    fn displaced_miss(
        &self,
        sensor: &MountedSensor,
        aim: Aim,
        nearest: &[&Face],
        lateral: f64,
    ) -> Option<Displacement> {
        let ray = MovingRay::new(sensor, aim);
        let mut tried = vec![];
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
        let missed = |[dx, dy]: &[f64; 2]| self.nearest(sensor, Aim { dx: *dx, dy: *dy, ..aim }).is_empty();
        tried.into_iter().find(missed).map(|[dx, dy]| Displacement { dx, dy })
    }

    /// A ray within the tolerance that meets `face` first, or within epsilon of the face that it meets first.
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
            .find(|&[dx, dy]| {
                let aim = Aim { dx, dy, ..aim };
                let exact = ExactRay::new(sensor, aim);
                if !face.is_met_by(&exact, sensor.max_range()) {
                    return false;
                }
                let first = self.nearest(sensor, aim);
                let Some(first) = first.first() else { return false };
                first.id == face.id || face.range(&exact) - first.range(&exact) <= tolerance.depth
            })
            .map(|[dx, dy]| Displacement { dx, dy })
    }
}
