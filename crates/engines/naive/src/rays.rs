//! The rays of the camera and of the beams, by their definitions.

use glam::DVec3;
use raypencil_scene::{Beam, Camera, Pose, SensorId};

use crate::fault::Fault;
use crate::injected::Injected;
use crate::quaternion::{conjugate, rotate};

/// A camera or a beam, with its pose and its rays.
pub(crate) struct PosedSensor<'a> {
    pub(crate) id: SensorId,
    pub(crate) pose: Pose,
    pub(crate) size: (u32, u32),
    /// Distance of the SPP along the normal axis, f_c or g, metres.
    pub(crate) plane: f64,
    pub(crate) max_range: f64,
    /// Origin and direction of the ray of cell (i, j), shifted by so many cells to the right and down, sensor frame.
    pub(crate) ray: &'a (dyn Fn(u32, u32, [f64; 2]) -> [DVec3; 2] + Sync),
}

/// A ray in the scene.
pub(crate) struct SceneRay {
    pub(crate) origin: DVec3,
    /// From the origin to the crossing of the SPP. Not a unit vector.
    pub(crate) q: DVec3,
    /// Whether the ray crosses the SPP right of and below the normal axis.
    pub(crate) is_lower_right: bool,
}

impl PosedSensor<'_> {
    /// The ray of cell (i, j), shifted by so many cells, from the sensor into the scene.
    pub(crate) fn scene_ray(&self, faults: Injected, (i, j): (u32, u32), shift: [f64; 2]) -> SceneRay {
        let [start, q] = (self.ray)(i, j, shift);
        let is_taken_as_unit = faults.has(Fault::QuaternionTakenAsUnit);
        let rotated = |vector| rotate(self.pose.rotation, vector, is_taken_as_unit);
        let ray = SceneRay {
            origin: self.pose.position + rotated(start),
            q: rotated(q),
            is_lower_right: q.x > 0.0 && start.y + q.y > 0.0,
        };
        if faults.has(Fault::DirectionsInSinglePrecision) {
            return SceneRay { q: ray.q.as_vec3().as_dvec3(), ..ray };
        }
        ray
    }
}

/// The pose of the camera.
pub(crate) fn camera_pose(faults: Injected, pose: Pose) -> Pose {
    let rotation =
        if faults.has(Fault::CameraPoseConjugated) { conjugate(pose.rotation) } else { pose.rotation };
    Pose { rotation, ..pose }
}

/// Column, row and the position of the ray in its cell across and down, as shares from the corner.
fn sample(
    faults: Injected,
    (i, j): (u32, u32),
    (width, height): (u32, u32),
    shift: [f64; 2],
) -> (f64, f64, [f64; 2]) {
    let i = if faults.has(Fault::ColumnOffByOne) {
        i + 1
    } else if faults.has(Fault::ColumnsReversed) {
        width - 1 - i
    } else {
        i
    };
    let j = if faults.has(Fault::RowsBottomUp) { height - 1 - j } else { j };
    let middle = if faults.has(Fault::HalfCellShift) { 0.0 } else { 0.5 };
    (f64::from(i), f64::from(j), shift.map(|shift| middle + shift))
}

/// A pixel's ray: from the projection centre along ((i + 1/2 - c_x) p_x, (j + 1/2 - c_y) p_y, f_c).
pub(crate) fn pixel_ray(faults: Injected, camera: &Camera, cell: (u32, u32), shift: [f64; 2]) -> [DVec3; 2] {
    let (i, j, [across, down]) = sample(faults, cell, (camera.width, camera.height), shift);
    let [mut centre_x, mut centre_y] = camera.principal_point;
    if faults.has(Fault::PrincipalPointRounded) {
        (centre_x, centre_y) = (centre_x.round(), centre_y.round());
    }
    let [mut pitch_x, mut pitch_y] = camera.pixel_pitch;
    if faults.has(Fault::PitchesSwapped) {
        (pitch_x, pitch_y) = (pitch_y, pitch_x);
    }
    let x = (i + across - centre_x) * pitch_x;
    let y = (j + down - centre_y) * pitch_y;
    [DVec3::ZERO, DVec3::new(x, y, camera.focal_length)]
}

/// A pencil's ray: from (0, y_j, 0) on the focal axis along (x_i, 0, g), where x_i = w (2i + 1 - columns) /
/// columns and y_j = T (2j + 1 - rows) / (2 rows).
pub(crate) fn pencil_ray(faults: Injected, beam: &Beam, cell: (u32, u32), shift: [f64; 2]) -> [DVec3; 2] {
    let (i, j, [across, down]) = sample(faults, cell, (beam.columns, beam.rows), shift);
    let g = beam.grid_distance;
    let (mut half_width, mut half_thickness) = (beam.half_width, 0.5 * beam.thickness);
    if faults.has(Fault::FanAndThicknessSwapped) {
        (half_width, half_thickness) = (half_thickness, half_width);
    }
    if faults.has(Fault::GridOfWholeFan) {
        // tan(2 a) = 2 tan(a) / (1 - tan(a)^2)
        let tangent = half_width / g;
        half_width = g * 2.0 * tangent / (1.0 - tangent * tangent);
    }
    let (mut columns, rows) = (f64::from(beam.columns), f64::from(beam.rows));
    if faults.has(Fault::ColumnsCountedAsRows) {
        columns = rows;
    }
    let (x, y) = if faults.has(Fault::GridToTheEdges) {
        let from_edge_to_edge =
            |k: f64, count: f64| if count > 1.0 { 2.0 * k / (count - 1.0) - 1.0 } else { 0.0 };
        (half_width * from_edge_to_edge(i, columns), half_thickness * from_edge_to_edge(j, rows))
    } else {
        (
            half_width * (2.0 * (i + across) - columns) / columns,
            half_thickness * (2.0 * (j + down) - rows) / rows,
        )
    };
    if faults.has(Fault::PencilsFromCentre) {
        return [DVec3::ZERO, DVec3::new(x, y, g)];
    }
    [DVec3::new(0.0, y, 0.0), DVec3::new(x, 0.0, g)]
}
