//! Step 2: vertices in the sensor's frame and on the SPP. (§4, 2; figure 7)

use glam::{DMat3, DVec3};
use rayon::prelude::*;
use raypencil_scene::{Mesh, Pose};

use crate::scan::Corner;

/// From the scene into a sensor's frame: `R^T (p - position)`, with the matrix R of the pose's quaternion.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SensorFromScene {
    position: DVec3,
    /// Columns are the sensor's axes in the scene frame.
    axes: DMat3,
}

impl SensorFromScene {
    /// The matrix of `(q p q*) / (q . q)`, term by term.
    pub(crate) fn of(pose: &Pose) -> Self {
        let [x, y, z, w] = pose.rotation.to_array();
        let (xx, yy, zz, ww) = (x * x, y * y, z * z, w * w);
        let (xy, xz, yz) = (2.0 * x * y, 2.0 * x * z, 2.0 * y * z);
        let (wx, wy, wz) = (2.0 * w * x, 2.0 * w * y, 2.0 * w * z);
        let norm_squared = xx + yy + zz + ww;
        let axes = DMat3 {
            x_axis: DVec3::new(ww + xx - yy - zz, xy + wz, xz - wy) / norm_squared,
            y_axis: DVec3::new(xy - wz, ww - xx + yy - zz, yz + wx) / norm_squared,
            z_axis: DVec3::new(xz + wy, yz - wx, ww - xx - yy + zz) / norm_squared,
        };
        Self { position: pose.position, axes }
    }

    /// A vector, turned into the sensor's frame.
    #[inline]
    pub(crate) fn turn(&self, v: DVec3) -> DVec3 {
        DVec3::new(self.axes.x_axis.dot(v), self.axes.y_axis.dot(v), self.axes.z_axis.dot(v))
    }

    /// A scene point seen from the sensor's origin, still along the scene's axes.
    #[inline]
    pub(crate) fn relative(&self, point: DVec3) -> DVec3 {
        point - self.position
    }

    /// A point `p` of another sensor's frame in this one's. By way of the distance between the sensors, not of
    /// the scene's origin, which may be far from both.
    #[inline]
    pub(crate) fn point_of(&self, other: &Self, p: DVec3) -> DVec3 {
        self.turn((other.position - self.position) + other.turn_back(p))
    }

    /// A vector `v` of another sensor's frame in this one's.
    #[inline]
    pub(crate) fn vector_of(&self, other: &Self, v: DVec3) -> DVec3 {
        self.turn(other.turn_back(v))
    }

    /// A vector of the sensor's frame, turned into the scene's.
    #[inline]
    fn turn_back(&self, v: DVec3) -> DVec3 {
        self.axes.x_axis * v.x + self.axes.y_axis * v.y + self.axes.z_axis * v.z
    }

    /// A point of the sensor's frame in the scene.
    #[inline]
    pub(crate) fn back(&self, p: DVec3) -> DVec3 {
        self.position + self.turn_back(p)
    }
}

/// A vertex in the sensor's frame.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Vertex {
    pub(crate) position: DVec3,
    /// Its projection; only meaningful at or beyond the SPP.
    pub(crate) corner: Corner,
    /// On which sides of the screen it lies outside: see `skip`.
    pub(crate) outside: u8,
}

/// Transforms all vertices, in parallel: each is independent of the others.
pub(crate) fn transform(mesh: &Mesh, into: impl Fn(DVec3) -> Vertex + Sync) -> Vec<Vertex> {
    mesh.vertices().par_iter().with_min_len(4096).map(|&v| into(widen(v))).collect()
}

#[inline]
pub(crate) fn widen([x, y, z]: [f32; 3]) -> DVec3 {
    DVec3::new(f64::from(x), f64::from(y), f64::from(z))
}
