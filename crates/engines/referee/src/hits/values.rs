//! Values of a hit, correctly rounded to f64 and to f32.
//!
//! Each is first evaluated in pairs of f64 with a proven error. Where that does not decide the rounding, the exact
//! polynomials of `intersection` do.

use std::cell::{LazyCell, OnceCell};
use std::cmp::Ordering;

use glam::DVec3;
use raypencil_scene::{FaceId, Hit, Mounted, SensorId};

use crate::hits::face::{ExactRay, Face};
use crate::hits::intersection::{Intersection, minus};
use crate::hits::verdict::Referee;
use crate::numbers::double_double::DoubleDouble;
use crate::numbers::number::{Dyadic, Number};
use crate::numbers::rounding::{Format, Rounded, quotient};
use crate::rays::ray::{Aim, MountedSensor};

/// A [`Hit`] whose values are correctly rounded.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RoundedHit {
    /// The face.
    pub face: FaceId,
    /// Distance from the ray's origin along the ray, metres.
    pub range: Rounded,
    /// The point, scene frame, metres.
    pub point: [Rounded; 3],
    /// The unit normal, scene frame.
    pub normal: [Rounded; 3],
    /// Distance along the sensor's normal axis, metres.
    pub depth: Rounded,
    /// cos(psi), psi being the angle between the normal and the reversed ray.
    pub cos_incidence: Rounded,
}

impl RoundedHit {
    /// The values in a format.
    pub fn in_format(&self, format: Format) -> Hit {
        let of = |rounded: Rounded| rounded.in_format(format);
        Hit {
            face: self.face,
            range: of(self.range),
            point: DVec3::from_array(self.point.map(of)),
            normal: DVec3::from_array(self.normal.map(of)),
            depth: of(self.depth),
            cos_incidence: of(self.cos_incidence),
        }
    }
}

/// The values where the ray of an aim meets the plane of `face`, inside its edges or not; `None` if they are
/// parallel, or the face has no area.
pub(crate) fn values(sensor: &MountedSensor, aim: Aim, face: &Face) -> Option<RoundedHit> {
    let fast = Intersection::new(sensor.ray::<DoubleDouble>(aim), face);
    let exact = OnceCell::new();
    let exact = || exact.get_or_init(|| Intersection::new(sensor.ray::<Dyadic>(aim), face));
    if fast.approach.sign().is_none_or(Ordering::is_eq) && exact().approach.sign() == Some(Ordering::Equal) {
        return None;
    }

    let spp = match sensor {
        MountedSensor::Camera(Mounted { sensor, .. }, _) => sensor.focal_length,
        MountedSensor::Beam(Mounted { sensor, .. }, _) => sensor.grid_distance,
    };
    // Products with two inverses: a division costs four times as much, and no value needs its last bits.
    let one = DoubleDouble::of(1.0);
    let per_scale = one.over(&fast.scale);
    let along = fast.height.mul(&per_scale);
    let length = fast.direction_squared.sqrt();
    let range = along.mul(&length).rounded().unwrap_or_else(|| exact().range());
    let depth_per_length = fast.ray.direction_scale.mul(&DoubleDouble::of(spp));
    let depth = along.mul(&depth_per_length).rounded().unwrap_or_else(|| exact().depth(spp));
    let point = fast.point();
    let exact_point = OnceCell::new();
    let point = [0, 1, 2].map(|k: usize| {
        point.0[k].mul(&per_scale).rounded().unwrap_or_else(|| {
            let point = exact_point.get_or_init(|| exact().point());
            quotient(&point.0[k], &exact().scale)
        })
    });
    let per_normal = one.over(&fast.normal_squared.sqrt());
    let normal = [0, 1, 2].map(|k: usize| {
        fast.normal.0[k].mul(&per_normal).rounded().unwrap_or_else(|| exact().normal_part(k))
    });
    let towards = minus(&fast.approach).mul(&per_normal).over(&length);
    let cos_incidence = towards.rounded().unwrap_or_else(|| exact().cos_incidence());
    Some(RoundedHit { face: face.id, range, point, normal, depth, cos_incidence })
}

impl Referee<'_> {
    /// The values of the first hit of cell (i, j)'s ray, correctly rounded; `None` if there is no such cell, or no
    /// hit.
    ///
    /// ```
    /// # mod wall { include!(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/common/wall.rs")); }
    /// # use wall::wall_scene;
    /// use raypencil_referee::Referee;
    /// use raypencil_scene::SensorId;
    ///
    /// let scene = wall_scene();
    /// let hit = Referee::new(&scene).values(SensorId::Camera, 0, 4).unwrap();
    /// // q = (-4/16, 0, 1/2): at a depth of 2 m the ray is at x = -1 m.
    /// assert_eq!(hit.point.map(|part| part.double), [-1.0, 0.0, 2.0]);
    /// assert_eq!(hit.depth.double, 2.0);
    /// // R = sqrt(1 + 4) m, to the nearest f64.
    /// assert_eq!(hit.range.double, 5.0_f64.sqrt());
    /// ```
    pub fn values(&self, id: SensorId, i: u32, j: u32) -> Option<RoundedHit> {
        let (sensor, aim) = self.sensor_and_aim(id, i, j)?;
        let nearest = self.nearest(&sensor, aim);
        values(&sensor, aim, nearest.first()?)
    }

    /// The ray of cell (i, j): origin, metres, and direction, scene frame. The direction is not a unit vector: t = 1
    /// is on the SPP. `None` if there is no such cell.
    ///
    /// ```
    /// # mod wall { include!(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/common/wall.rs")); }
    /// # use wall::wall_scene;
    /// use raypencil_referee::Referee;
    /// use raypencil_scene::SensorId;
    ///
    /// let scene = wall_scene();
    /// let [origin, direction] = Referee::new(&scene).ray(SensorId::Camera, 0, 4).unwrap();
    /// assert_eq!(origin.map(|part| part.double), [0.0; 3]);
    /// // ((i + 1/2 - c_x) p_x, (j + 1/2 - c_y) p_y, f) = (-4/16, 0, 1/2).
    /// assert_eq!(direction.map(|part| part.double), [-0.25, 0.0, 0.5]);
    /// ```
    pub fn ray(&self, id: SensorId, i: u32, j: u32) -> Option<[[Rounded; 3]; 2]> {
        let (sensor, aim) = self.sensor_and_aim(id, i, j)?;
        let (fast, exact) = (sensor.ray::<DoubleDouble>(aim), LazyCell::new(|| sensor.ray::<Dyadic>(aim)));
        let part = |k: usize| {
            let rounded = fast.origin.0[k].over(&fast.origin_scale).rounded();
            rounded.unwrap_or_else(|| quotient(&exact.origin.0[k], &exact.origin_scale))
        };
        let along = |k: usize| {
            let rounded = fast.direction.0[k].over(&fast.direction_scale).rounded();
            rounded.unwrap_or_else(|| quotient(&exact.direction.0[k], &exact.direction_scale))
        };
        Some([[0, 1, 2].map(part), [0, 1, 2].map(along)])
    }

    /// The values where the ray of cell (i, j) meets `face`; `None` if there is no such cell or face, or the ray does
    /// not meet it. The face need not be the nearest.
    pub fn hit(&self, id: SensorId, i: u32, j: u32, face: FaceId) -> Option<RoundedHit> {
        let (sensor, aim) = self.sensor_and_aim(id, i, j)?;
        let face = self.face(face)?;
        let is_met = face.is_met_by(&ExactRay::new(&sensor, aim), sensor.max_range());
        is_met.then(|| values(&sensor, aim, &face)).flatten()
    }

    /// The values where the ray of cell (i, j) meets the plane of `face`, inside its edges or not; `None` if there is
    /// no such cell or face, or they are parallel.
    pub fn plane_hit(&self, id: SensorId, i: u32, j: u32, face: FaceId) -> Option<RoundedHit> {
        let (sensor, aim) = self.sensor_and_aim(id, i, j)?;
        values(&sensor, aim, &self.face(face)?)
    }
}

#[cfg(test)]
#[path = "../../tests/unit/values.rs"]
mod tests;
