//! The contract's ray of a cell, and the rays displaced from it, without any division.
//!
//! All that the contract says of a ray is rational in stored f64 numbers; multiplied by its positive denominators it
//! is polynomial. A ray here is (O, s, D, sigma) with s > 0 and sigma > 0: the ray from O / s along q = D / sigma.
//!
//! | | s | sigma | O | D |
//! | --- | --- | --- | --- | --- |
//! | camera | 1 | N | p | M ((i + 1/2 + dx - c_x) p_x, (j + 1/2 + dy - c_y) p_y, f_c) |
//! | beam |2 rows N | columns N | s p + M (0, T (2j + 1 - rows + 2 dy), 0) | M (w (2i + 1 - columns + 2 dx), 0, columns g) |
//!
//! p and q are the pose's position and quaternion, N = q . q, and M is the matrix of q p q*, which is N times the
//! rotation. (dx, dy) displaces the ray in cells: in a beam, dy moves its origin along the focal axis.

use raypencil_scene::{Beam, Camera, Mounted, Pose, Scene, SensorId};

use crate::numbers::number::{Interval, Number};
use crate::numbers::vector::{ScaledRotation, Vector};

/// A cell of a sensor and a displacement from its centre, cells.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Aim {
    pub(crate) i: u32,
    pub(crate) j: u32,
    pub(crate) dx: f64,
    pub(crate) dy: f64,
}

/// The ray (O, s, D, sigma).
#[derive(Debug, Clone)]
pub(crate) struct ScaledRay<T> {
    pub(crate) origin: Vector<T>,
    pub(crate) origin_scale: T,
    pub(crate) direction: Vector<T>,
    pub(crate) direction_scale: T,
}

/// One sensor of a scene with its pose, and the [parts](ScaledRotation::parts) of the pose's rotation in intervals: a search for a margin asks for the rays of one
/// sensor some thousand times.
#[derive(Debug, Clone, Copy)]
pub(crate) enum MountedSensor {
    Camera(Mounted<Camera>, [Interval; 10]),
    Beam(Mounted<Beam>, [Interval; 10]),
}

impl MountedSensor {
    /// The sensor, if the scene has it.
    pub(crate) fn of(scene: &Scene, id: SensorId) -> Option<Self> {
        match id {
            SensorId::Camera => Some(Self::camera(*scene.camera())),
            SensorId::Beam(index) => scene.beams().get(index).copied().map(Self::beam),
        }
    }

    pub(crate) fn camera(mounted: Mounted<Camera>) -> Self {
        Self::Camera(mounted, ScaledRotation::of(mounted.scene_from_sensor.rotation).parts())
    }

    pub(crate) fn beam(mounted: Mounted<Beam>) -> Self {
        Self::Beam(mounted, ScaledRotation::of(mounted.scene_from_sensor.rotation).parts())
    }

    /// The rotation of the pose.
    pub(crate) fn rotation<T: Number>(&self) -> ScaledRotation<T> {
        let (Self::Camera(_, in_intervals) | Self::Beam(_, in_intervals)) = self;
        let formed = T::of_intervals(*in_intervals);
        formed.map_or_else(|| ScaledRotation::of(self.pose().rotation), ScaledRotation::of_parts)
    }

    pub(crate) fn pose(&self) -> Pose {
        match self {
            Self::Camera(mounted, _) => mounted.scene_from_sensor,
            Self::Beam(mounted, _) => mounted.scene_from_sensor,
        }
    }

    /// Columns and rows.
    pub(crate) fn size(&self) -> (u32, u32) {
        match self {
            Self::Camera(mounted, _) => (mounted.sensor.width, mounted.sensor.height),
            Self::Beam(mounted, _) => (mounted.sensor.columns, mounted.sensor.rows),
        }
    }

    /// Maximum range along a ray, metres.
    pub(crate) fn max_range(&self) -> f64 {
        match self {
            Self::Camera(mounted, _) => mounted.sensor.max_range,
            Self::Beam(mounted, _) => mounted.sensor.max_range,
        }
    }

    /// The ray of an aim, as polynomials.
    pub(crate) fn ray<T: Number>(&self, aim: Aim) -> ScaledRay<T> {
        let pose = self.pose();
        let rotation = self.rotation::<T>();
        let position = Vector::<T>::of(pose.position);
        match self {
            Self::Camera(Mounted { sensor, .. }, _) => {
                let along = |index: u32, displaced: f64, centre: f64, pitch: f64| {
                    let from_centre = T::of_integer(index).add(&T::of(0.5)).add(&T::of(displaced));
                    from_centre.sub(&T::of(centre)).mul(&T::of(pitch))
                };
                let q = Vector([
                    along(aim.i, aim.dx, sensor.principal_point[0], sensor.pixel_pitch[0]),
                    along(aim.j, aim.dy, sensor.principal_point[1], sensor.pixel_pitch[1]),
                    T::of(sensor.focal_length),
                ]);
                ScaledRay {
                    origin: position,
                    origin_scale: T::of(1.0),
                    direction: rotation.apply(&q),
                    direction_scale: rotation.norm_squared,
                }
            }
            Self::Beam(Mounted { sensor, .. }, _) => {
                // 2k + 1 - n + 2 displaced: the cell's centre in half cells from the middle.
                let half_cells = |index: u32, displaced: f64, count: u32| {
                    let whole = T::of(2.0 * f64::from(index) + 1.0 - f64::from(count));
                    whole.add(&T::of(displaced).doubled())
                };
                let (columns, rows) = (T::of_integer(sensor.columns), T::of_integer(sensor.rows));
                let zero = || T::of(0.0);
                let q = Vector([
                    T::of(sensor.half_width).mul(&half_cells(aim.i, aim.dx, sensor.columns)),
                    zero(),
                    columns.mul(&T::of(sensor.grid_distance)),
                ]);
                let height = T::of(sensor.thickness).mul(&half_cells(aim.j, aim.dy, sensor.rows));
                let origin_scale = rows.doubled().mul(&rotation.norm_squared);
                let start = rotation.apply(&Vector([zero(), height, zero()]));
                ScaledRay {
                    origin: position.scaled(&origin_scale).add(&start),
                    origin_scale,
                    direction: rotation.apply(&q),
                    direction_scale: columns.mul(&rotation.norm_squared),
                }
            }
        }
    }

    /// The change of D by a cell to the right and of O by a cell down, in a beam; 0 in a camera.
    pub(crate) fn steps<T: Number>(&self) -> [Vector<T>; 2] {
        let zero = || T::of(0.0);
        let rotation = self.rotation::<T>();
        match self {
            Self::Beam(Mounted { sensor, .. }, _) => {
                let across = T::of(sensor.half_width).doubled();
                let down = T::of(sensor.thickness).doubled();
                [[across, zero(), zero()], [zero(), down, zero()]].map(|v| rotation.apply(&Vector(v)))
            }
            Self::Camera(..) => [(); 2].map(|()| Vector([zero(), zero(), zero()])),
        }
    }
}
