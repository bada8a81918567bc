//! Rotation by quaternions of any length.

use glam::{DQuat, DVec3};

/// The vector `p` rotated: (q p q*) / (q . q). With the fault `is_taken_as_unit` the division is left out.
pub(crate) fn rotate(q: DQuat, p: DVec3, is_taken_as_unit: bool) -> DVec3 {
    let rotated = product(product(q, DQuat::from_xyzw(p.x, p.y, p.z, 0.0)), conjugate(q));
    let rotated = DVec3::new(rotated.x, rotated.y, rotated.z);
    if is_taken_as_unit {
        return rotated;
    }
    rotated / (q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w)
}

/// The Hamilton product of two quaternions.
fn product(p: DQuat, q: DQuat) -> DQuat {
    DQuat::from_xyzw(
        p.w * q.x + p.x * q.w + p.y * q.z - p.z * q.y,
        p.w * q.y - p.x * q.z + p.y * q.w + p.z * q.x,
        p.w * q.z + p.x * q.y - p.y * q.x + p.z * q.w,
        p.w * q.w - p.x * q.x - p.y * q.y - p.z * q.z,
    )
}

/// The conjugate q*.
pub(crate) fn conjugate(q: DQuat) -> DQuat {
    DQuat::from_xyzw(-q.x, -q.y, -q.z, q.w)
}
