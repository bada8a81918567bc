//! Rays, hits and the names of faces and sensors.

use std::fmt;

use glam::DVec3;

/// The index of a face in [`crate::Mesh::faces`]. A renderer's own orders never show.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, bytemuck::Zeroable)]
pub struct FaceId(pub u32);

/// A half line `origin + t direction` in the scene frame, t >= 1. At t = 1 it crosses the sensor
/// projection plane (SPP); the direction is not a unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ray {
    /// Origin of the ray, metres.
    pub origin: DVec3,
    /// From the origin to the crossing of the SPP, metres.
    pub direction: DVec3,
}

/// Where a ray first meets the front of a face, at or beyond the SPP and within the sensor's range.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hit {
    /// The face met; of several at the same distance, the lowest index.
    pub face: FaceId,
    /// Distance from the ray's origin *along the ray*, not depth, metres.
    pub range: f64,
    /// The point, scene frame, metres.
    pub point: DVec3,
    /// The face's unit normal, to the outside, scene frame.
    pub normal: DVec3,
    /// Distance of the point from the ray's origin along the sensor's normal axis, metres.
    pub depth: f64,
    /// cos(psi): cosine of the angle between the reversed ray and the normal.
    pub cos_incidence: f64,
}

/// One of a scene's sensors: something with a raster of rays.
///
/// The paper calls a beam a sensor too, since it computes "a range raster map from a sensor" for both. (§4)
///
/// ```
/// use raypencil_scene::{Place, SensorId};
///
/// let place = Place { sensor: SensorId::Beam(1), i: 412, j: 3 };
/// assert_eq!(place.to_string(), "beam-1 pencil 412,3");
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum SensorId {
    /// The camera, whose cells are pixels.
    Camera,
    /// The laser beam of that index, whose cells are ray pencils.
    Beam(usize),
}

impl fmt::Display for SensorId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Camera => f.write_str("camera"),
            Self::Beam(index) => write!(f, "beam-{index}"),
        }
    }
}
