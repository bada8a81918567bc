//! Sensitivity of a stripe's points to errors, to first order. (Paper, §5)

use glam::DVec3;
use raypencil::rover::Rig;

/// Sensitivity of a point of a stripe to errors of the edge's row and of the vehicle's pitch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StripeSensitivity {
    /// Distance of the point before the vehicle's origin, metres.
    pub ahead: f64,
    /// Distance by which the point moves away if its image moves down by one pixel, metres. (The camera is below the
    /// beam.)
    pub range_per_pixel: f64,
    /// Distance by which the point then falls, metres.
    pub elevation_per_pixel: f64,
}

impl StripeSensitivity {
    /// Sensitivity of a point on the plane of a beam, `ahead` metres before the vehicle's origin. The camera and the
    /// beams must look straight ahead and down, as in the default rig. The distance of the point to the side does not
    /// matter.
    ///
    /// The plane points down by beta and passes at a height b above the camera. At a horizontal distance d before the
    /// camera, a point of the plane appears at an angle a below the horizon, and d = b / (tan(beta) - tan(a)). So
    /// dd/da = d^2 / (b cos^2(a)) metres per radian. There, a pixel p is da = (p / f_c) cos^2(a - gamma) radians, for a
    /// camera that looks down by gamma. The point stays on the plane: farther by dd, it is lower by dd tan(beta).
    pub fn at(rig: &Rig, beam: usize, ahead: f64) -> Self {
        let SideView { camera: eye, gamma, slope, source } = SideView::of(rig, beam);
        let d = ahead - eye.x;
        let b = source.z - eye.z + slope * (source.x - eye.x);
        let a = libm::atan2(slope * d - b, d);
        let (cos_a, cos_off) = (libm::cos(a), libm::cos(a - gamma));
        let camera = &rig.camera.sensor;
        let pixel = camera.pixel_pitch[1] / camera.focal_length * cos_off * cos_off;
        let range_per_pixel = d * d / (b * cos_a * cos_a) * pixel;
        Self { ahead, range_per_pixel, elevation_per_pixel: range_per_pixel * slope }
    }

    /// Distance by which the point falls if the vehicle's estimated pitch is too far nose-down by `pitch` radians,
    /// metres.
    pub fn elevation_of_pitch(&self, pitch: f64) -> f64 {
        self.ahead * pitch
    }
}

/// Camera and beam plane in the vehicle frame, seen from the side.
struct SideView {
    camera: DVec3,
    /// Angle by which the camera looks down, radians.
    gamma: f64,
    /// Tangent of the angle by which the plane points down.
    slope: f64,
    /// Position of the beam's source.
    source: DVec3,
}

impl SideView {
    fn of(rig: &Rig, beam: usize) -> Self {
        let (camera, beam) = (rig.camera.vehicle_from_sensor, rig.beams[beam].vehicle_from_sensor);
        let (axis, sheet) = (camera.rotate(DVec3::Z), beam.rotate(DVec3::Z));
        Self {
            camera: camera.position,
            gamma: libm::atan2(-axis.z, axis.x),
            slope: -sheet.z / sheet.x,
            source: beam.position,
        }
    }
}
