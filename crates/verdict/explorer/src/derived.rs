//! The values of a hit from its face and its ray, in the operations that the page's script does in the same order.
//!
//! A page stores the faces that are hit. The script computes range, depth, point, normal and incidence from them, and
//! rounds these to single precision, as files have them. f64 and its square root are correctly rounded in both languages,
//! so both get the same bits; where a recording has others, the page stores these ([`crate::channels`]).
//!
//! This is no evaluation to trust: the judge holds renderers to the referee, and this module only saves bytes.

use glam::DVec3;
use raypencil_scene::{FaceId, HitQuantity, Mesh, Ray};

/// Values of a hit: t = n·(a - o) / n·q, with the ray o + t q and the plane through a with the normal n = (b - a) x
/// (c - a).
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct DerivedHit {
    range: f64,
    depth: f64,
    point: DVec3,
    normal: DVec3,
    cos_incidence: f64,
}

impl DerivedHit {
    /// The hit of `ray` on the plane of `face`. `local_z` is the ray's direction along the sensor's axis.
    pub(crate) fn of(mesh: &Mesh, face: FaceId, ray: &Ray, local_z: f64) -> Self {
        let [a, b, c] = mesh.faces()[face.0 as usize].map(|vertex| {
            let [x, y, z] = mesh.vertices()[vertex as usize].map(f64::from);
            DVec3::new(x, y, z)
        });
        let n = (b - a).cross(c - a);
        let Ray { origin, direction } = *ray;
        let n_q = n.dot(direction);
        let t = n.dot(a - origin) / n_q;
        let q_length = direction.dot(direction).sqrt();
        let n_length = n.dot(n).sqrt();
        Self {
            range: t * q_length,
            depth: t * local_z,
            point: origin + direction * t,
            normal: n / n_length,
            cos_incidence: -n_q / (n_length * q_length),
        }
    }

    /// One component of a quantity, in single precision.
    pub(crate) fn component(&self, quantity: HitQuantity, axis: usize) -> f32 {
        let value = match quantity {
            HitQuantity::Range => self.range,
            HitQuantity::Depth => self.depth,
            HitQuantity::Point => self.point[axis],
            HitQuantity::Normal => self.normal[axis],
            HitQuantity::CosIncidence => self.cos_incidence,
        };
        value as f32
    }
}
