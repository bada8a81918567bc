//! A question and its stated answers, as mistakes change them.

use glam::DVec3;
use raypencil_referee::ExactCast;
use raypencil_scene::{CastRay, Pose, Precision, Sides, Triangles};

use crate::comparison::{Stated, compare_with};

/// Rays that are judged first: a mistake that explains nothing is given up after them.
const FIRST_RAYS: usize = 64;

/// Rays that are judged at a time after them.
const NEXT_RAYS: usize = 4096;

/// A question and its stated answers.
#[derive(Clone)]
pub(super) struct Trial {
    pub(super) rays: Vec<CastRay>,
    pub(super) sides: Sides,
    pub(super) stated: Stated,
    pub(super) precision: Precision,
    /// Half of it is what a mistake adds to the bounds of points that follow it, in the mesh's unit; 0 without such a mistake.
    pub(super) allowance: f64,
    /// The index in the pack of each ray.
    pub(super) indices: Vec<usize>,
    /// The points of a cloud, from which t and point of `stated` follow.
    pub(super) cloud: Option<CloudPart>,
}

/// The points of a cloud, one for each ray.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct CloudPart {
    /// As the file has them, in its own frame; NaN where there is none.
    pub(super) raw: Vec<DVec3>,
    /// How far storing may have moved each.
    pub(super) error: Vec<f64>,
    /// The pose of the file's frame in the mesh's; `None`: it is the mesh's.
    pub(super) pose: Vec<Option<Pose>>,
}

impl CloudPart {
    /// The points of the rays with these indices.
    pub(super) fn some_of(&self, indices: &[usize]) -> Self {
        Self {
            raw: indices.iter().map(|&index| self.raw[index]).collect(),
            error: indices.iter().map(|&index| self.error[index]).collect(),
            pose: indices.iter().map(|&index| self.pose[index]).collect(),
        }
    }

    /// A point in the mesh's frame, and how far rounding may have moved it.
    pub(super) fn point(&self, k: usize) -> (DVec3, f64) {
        match self.pose[k] {
            None => (self.raw[k], self.error[k]),
            Some(pose) => {
                // A pose rounds each part at most 16 times, by the unit roundoff of what it adds; the program's and this one.
                let size = self.raw[k].length() + pose.position.length();
                (pose * self.raw[k], self.error[k] + 32.0 * Precision::F64.unit_roundoff * size)
            }
        }
    }

    /// Puts t and point of these rays in their place.
    pub(super) fn state(&self, rays: &[CastRay], stated: &mut Stated) {
        let points: Vec<(DVec3, f64)> = (0..rays.len()).map(|k| self.point(k)).collect();
        let t = |(ray, (point, _)): (&CastRay, &(DVec3, f64))| {
            (*point - ray.origin).dot(ray.direction) / ray.direction.length_squared()
        };
        stated.t = Some(rays.iter().zip(&points).map(t).collect());
        stated.point = Some(points.iter().map(|(point, _)| *point).collect());
        let lengths = rays.iter().map(|ray| ray.direction.length());
        stated.stored.t = Some(lengths.zip(&points).map(|(length, (_, error))| error / length).collect());
        stated.stored.point = Some(points.iter().map(|(_, error)| *error).collect());
    }
}

impl Trial {
    /// The trial without a mistake; `None` if that changes nothing.
    pub(super) fn without(&self, undo: &dyn Fn(&mut Self)) -> Option<Self> {
        let mut trial = self.clone();
        undo(&mut trial);
        if let Some(cloud) = &trial.cloud {
            cloud.state(&trial.rays, &mut trial.stated);
        }
        (!trial.has_the_bits_of(self)).then_some(trial)
    }

    /// Whether every number is the same, NaN included.
    fn has_the_bits_of(&self, other: &Self) -> bool {
        let numbers = |a: &Option<Vec<f64>>, b: &Option<Vec<f64>>| match (a, b) {
            (Some(a), Some(b)) => a.iter().zip(b).all(|(a, b)| a.to_bits() == b.to_bits()),
            (a, b) => a.is_none() && b.is_none(),
        };
        let bits = |v: &DVec3| v.to_array().map(f64::to_bits);
        let vectors = |a: &Option<Vec<DVec3>>, b: &Option<Vec<DVec3>>| match (a, b) {
            (Some(a), Some(b)) => a.iter().zip(b).all(|(a, b)| bits(a) == bits(b)),
            (a, b) => a.is_none() && b.is_none(),
        };
        let (a, b) = (&self.stated, &other.stated);
        self.sides == other.sides
            && self.precision == other.precision
            && self.allowance == other.allowance
            && self.rays == other.rays
            && a.face == b.face
            && a.side == b.side
            && numbers(&a.t, &b.t)
            && numbers(&a.range, &b.range)
            && numbers(&a.cos_incidence, &b.cos_incidence)
            && vectors(&a.point, &b.point)
            && vectors(&a.normal, &b.normal)
            && vectors(&a.barycentric, &b.barycentric)
    }

    /// Number of wrong rays, or `None` as soon as there are more than `most`.
    pub(super) fn wrong(&self, exact: &ExactCast<'_>, mesh: &Triangles, most: usize) -> Option<usize> {
        let (mut wrong, mut judged) = (0, 0);
        while judged < self.rays.len() {
            let end = judged + if judged == 0 { FIRST_RAYS } else { NEXT_RAYS };
            let chunk: Vec<usize> = (judged..end.min(self.rays.len())).collect();
            let rays = &self.rays[judged..judged + chunk.len()];
            let stated = self.stated.some_of(&chunk);
            wrong +=
                compare_with(exact, mesh, rays, self.sides, &stated, self.precision).counts().wrong as usize;
            if wrong > most {
                return None;
            }
            judged += chunk.len();
        }
        Some(wrong)
    }

    /// Whether a ray is one of a sensor with a shortest range, or an answer says that it is.
    pub(super) fn is_about_sensors(&self) -> bool {
        let says = |distances: &Option<Vec<f64>>| distances.iter().flatten().any(|t| *t == f64::NEG_INFINITY);
        self.rays.iter().any(|ray| ray.t_blind > 0.0) || says(&self.stated.t) || says(&self.stated.range)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_storing_did_to_a_point_is_less_of_t_along_a_longer_direction() {
        // 12 m along x, by directions 1 m and 4 m long; a micrometre of each may have been rounded away.
        let (raw, error) = (vec![DVec3::new(14.0, 1.0, 0.0); 2], vec![1e-6; 2]);
        let cloud = CloudPart { raw: raw.clone(), error: error.clone(), pose: vec![None; 2] };
        let rays = [1.0, 4.0].map(|length| CastRay::new(DVec3::new(2.0, 1.0, 0.0), length * DVec3::X));
        let mut stated = Stated::default();
        cloud.state(&rays, &mut stated);
        assert_eq!((stated.t, stated.point), (Some(vec![12.0, 3.0]), Some(raw)));
        assert_eq!((stated.stored.t, stated.stored.point), (Some(vec![1e-6, 2.5e-7]), Some(error)));
    }
}
