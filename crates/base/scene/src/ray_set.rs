//! Rays given as numbers, which belong to no sensor.

use glam::DVec3;

use crate::SceneError;
use crate::triangles::MAX_COORDINATE;

/// Least size of a direction's largest component: t, a length over this, stays a finite number, for any two points within 1e30.
const MIN_DIRECTION: f64 = 1e-270;

/// A ray with both ends given: the points origin + t direction, `t_min <= t <= t_max`, exactly. And the t before which a
/// sensor is blind, if the ray is one of a sensor.
///
/// ```
/// use glam::DVec3;
/// use raypencil_scene::CastRay;
///
/// let ray = CastRay::new(DVec3::ZERO, DVec3::new(0.0, 0.0, 2.0));
/// assert_eq!((ray.t_min, ray.t_max), (0.0, f64::INFINITY));
/// assert!(ray.validate("ray").is_ok());
/// assert!(CastRay { direction: DVec3::ZERO, ..ray }.validate("ray").is_err());
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CastRay {
    /// Origin, in the mesh's frame and unit.
    pub origin: DVec3,
    /// Direction: not a unit vector, not 0. Distances along the ray are t times its length.
    pub direction: DVec3,
    /// Least t of a hit, not negative.
    pub t_min: f64,
    /// Greatest t of a hit; infinite for a ray without an end.
    pub t_max: f64,
    /// The shortest range of a sensor, as a t: a nearest hit before it is too near, one at it is measured. 0 for a ray of no
    /// such sensor. It is no end of the ray, which a surface before it stops like any other.
    pub t_blind: f64,
}

impl CastRay {
    /// The ray from its origin, without an end.
    pub fn new(origin: DVec3, direction: DVec3) -> Self {
        Self { origin, direction, t_min: 0.0, t_max: f64::INFINITY, t_blind: 0.0 }
    }

    /// Whether a nearest hit at this t is too near for the sensor.
    pub fn is_too_near(&self, t: f64) -> bool {
        t < self.t_blind
    }

    /// Two vectors across the ray, along which it is moved sideways: u, v and the direction d are at right angles and
    /// right-handed, and u and v are 1 long, up to the rounding of `f64`. What is measured along them, margins for one,
    /// refers to these stored numbers.
    ///
    /// With m = d / max |d_k| and e the unit vector of the smallest |m_k| (the first of several): u = e x m / |e x m|,
    /// v = m x u / |m x u|.
    ///
    /// ```
    /// use glam::DVec3;
    /// use raypencil_scene::CastRay;
    ///
    /// let ray = CastRay::new(DVec3::ZERO, DVec3::new(0.0, 0.0, 4.0));
    /// assert_eq!(ray.across(), [DVec3::NEG_Y, DVec3::X]);
    /// ```
    pub fn across(&self) -> [DVec3; 2] {
        let along = self.direction / self.direction.abs().max_element();
        let smallest = DVec3::AXES[along.abs().min_position()];
        let u = smallest.cross(along).normalize();
        [u, along.cross(u).normalize()]
    }

    /// Refuses what is no ray. `field` names it.
    ///
    /// # Errors
    /// Names the first part that is wrong: an origin that is not finite or beyond 1e30, a direction that is 0 or shorter than 1e-270,
    /// not finite or beyond 1e30, a `t_min` that is negative or not finite, a `t_max` below it, a `t_blind` that is negative or beyond
    /// `t_max`.
    pub fn validate(&self, field: &str) -> Result<(), SceneError> {
        let refuse = |part: &str, value: String, expected: &str| {
            Err(SceneError::new(format!("{field}.{part}"), value, expected))
        };
        // Very small and very large numbers without their hundreds of zeros.
        let short = |x: f64| match x.abs() {
            0.0 | 1e-5..1e17 => x.to_string(),
            _ => format!("{x:e}"),
        };
        let shown = |v: DVec3| format!("[{}]", v.to_array().map(short).join(", "));
        let is_within = |v: DVec3| v.to_array().iter().all(|coordinate| coordinate.abs() <= MAX_COORDINATE);
        if !is_within(self.origin) {
            return refuse("origin", shown(self.origin), "three finite numbers within 1e30");
        }
        if !is_within(self.direction) || self.direction.abs().max_element() < MIN_DIRECTION {
            return refuse(
                "direction",
                shown(self.direction),
                "three finite numbers within 1e30, not all 0: the largest at least 1e-270",
            );
        }
        if !(self.t_min >= 0.0 && self.t_min <= MAX_COORDINATE) {
            return refuse("t_min", self.t_min.to_string(), "0 to 1e30");
        }
        if !(self.t_max >= self.t_min && (self.t_max <= MAX_COORDINATE || self.t_max == f64::INFINITY)) {
            let expected = format!("{} (t_min) to 1e30, or infinity for no end", self.t_min);
            return refuse("t_max", self.t_max.to_string(), &expected);
        }
        let most = self.t_max.min(MAX_COORDINATE);
        if !(self.t_blind >= 0.0 && self.t_blind <= most) {
            let end = if self.t_max <= MAX_COORDINATE { format!("{most} (t_max)") } else { "1e30".into() };
            return refuse("t_blind", self.t_blind.to_string(), &format!("0 to {end}"));
        }
        Ok(())
    }
}

/// The side of a face that a ray meets.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Side {
    /// The side from which the vertices are seen counter-clockwise: n.d < 0.
    Front,
    /// The other: n.d > 0.
    Back,
}

/// The sides of the faces that rays can hit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sides {
    /// Fronts only: rays pass through backs.
    Fronts,
    /// Both.
    Both,
}

impl Sides {
    /// Whether a side is hit.
    pub fn include(self, side: Side) -> bool {
        self == Self::Both || side == Side::Front
    }
}

/// Any number of rays, and which sides of faces they hit. Valid by construction.
#[derive(Debug, Clone, PartialEq)]
pub struct RaySet {
    rays: Vec<CastRay>,
    sides: Sides,
}

impl RaySet {
    /// A set of rays.
    ///
    /// # Errors
    /// As [`CastRay::validate`], for the first ray that is wrong: `rays[17].direction`.
    pub fn new(rays: Vec<CastRay>, sides: Sides) -> Result<Self, SceneError> {
        rays.iter().enumerate().try_for_each(|(index, ray)| {
            // The name costs time only where it is needed.
            ray.validate("").or_else(|_| ray.validate(&format!("rays[{index}]")))
        })?;
        Ok(Self { rays, sides })
    }

    /// The rays.
    pub fn rays(&self) -> &[CastRay] {
        &self.rays
    }

    /// The sides that they hit.
    pub fn sides(&self) -> Sides {
        self.sides
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_wrong_part_of_a_ray_is_named() {
        let good = CastRay::new(DVec3::ZERO, DVec3::X);
        let message = |ray: CastRay| RaySet::new(vec![good, ray], Sides::Both).unwrap_err().to_string();
        let origin = DVec3::new(0.0, f64::INFINITY, 0.0);
        assert!(message(CastRay { origin, ..good }).starts_with("rays[1].origin is [0, inf, 0]"));
        assert!(
            message(CastRay { direction: DVec3::ZERO, ..good }).starts_with("rays[1].direction is [0, 0, 0]")
        );
        // The t of a hit would be beyond all numbers, which means a miss.
        let short = message(CastRay { direction: DVec3::X * 9e-271, ..good });
        assert!(short.starts_with("rays[1].direction is [9e-271, 0, 0]: expected"), "{short}");
        assert!(short.ends_with("the largest at least 1e-270"), "{short}");
        assert!(RaySet::new(vec![CastRay { direction: DVec3::X * 1.1e-270, ..good }], Sides::Both).is_ok());
        assert!(
            message(CastRay { direction: DVec3::splat(f64::NAN), ..good }).starts_with("rays[1].direction")
        );
        assert_eq!(message(CastRay { t_min: -0.5, ..good }), "rays[1].t_min is -0.5: expected 0 to 1e30");
        assert!(message(CastRay { t_min: f64::INFINITY, ..good }).starts_with("rays[1].t_min is inf"));
        assert!(
            message(CastRay { t_min: 2.0, t_max: 1.0, ..good }).starts_with("rays[1].t_max is 1: expected 2")
        );
        assert!(message(CastRay { t_max: f64::NAN, ..good }).starts_with("rays[1].t_max is NaN"));
        assert_eq!(message(CastRay { t_blind: -1.0, ..good }), "rays[1].t_blind is -1: expected 0 to 1e30");
        assert!(message(CastRay { t_blind: f64::NAN, ..good }).starts_with("rays[1].t_blind is NaN"));
        assert!(message(CastRay { t_blind: f64::INFINITY, ..good }).starts_with("rays[1].t_blind is inf"));
        assert_eq!(
            message(CastRay { t_max: 2.0, t_blind: 3.0, ..good }),
            "rays[1].t_blind is 3: expected 0 to 2 (t_max)"
        );
        assert!(RaySet::new(vec![CastRay { t_max: 2.0, t_blind: 2.0, ..good }], Sides::Both).is_ok());
        // A single point of a ray is a ray.
        assert!(RaySet::new(vec![CastRay { t_min: 2.0, t_max: 2.0, ..good }], Sides::Both).is_ok());
    }
}
