//! The camera's view of a terrain point: its position in the camera frame and on the image. (Contract: camera)

use glam::DVec3;
use raypencil_scene::{Camera, Mounted, Pixel};

use crate::rays::Rotation;

/// A camera with its pose in the scene.
#[derive(Debug)]
pub(crate) struct PosedCamera {
    pub(crate) intrinsics: Camera,
    /// The projection centre c, scene frame, metres.
    pub(crate) centre: DVec3,
    /// The camera's unit axes in the scene frame: x right, y down, z forward.
    right: DVec3,
    down: DVec3,
    forward: DVec3,
}

/// A terrain point P as the camera sees it. P may be behind the camera.
#[derive(Debug, Clone, Copy)]
pub(crate) struct CameraPoint {
    /// P in the camera frame, (X, Y, Z), metres. Z is the depth r.
    pub(crate) in_camera: DVec3,
    /// d = |P - c|, metres. It is at least |Z| to the last bit, so that |cos(phi)| is at most 1.
    pub(crate) distance: f64,
    /// The pixel that P projects to; `None` if P is off the image or at most f_c deep.
    pub(crate) pixel: Option<Pixel>,
}

impl PosedCamera {
    pub(crate) fn new(mounted: &Mounted<Camera>) -> Self {
        let pose = &mounted.scene_from_sensor;
        let scene_from_camera = Rotation::from_pose(pose);
        let [right, down, forward] = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| scene_from_camera.apply(axis));
        Self { intrinsics: mounted.sensor, centre: pose.position, right, down, forward }
    }

    /// Transforms and projects a point of the scene frame.
    pub(crate) fn observe(&self, point: DVec3) -> CameraPoint {
        let from_centre = point - self.centre;
        let [x, y, z] = [self.right, self.down, self.forward].map(|axis| axis.dot(from_centre));
        let in_camera = DVec3::new(x, y, z);
        CameraPoint { in_camera, distance: in_camera.length(), pixel: self.pixel(in_camera) }
    }

    /// The pixel that a point of the camera frame projects to. A point at or behind the image plane has none.
    fn pixel(&self, DVec3 { x, y, z }: DVec3) -> Option<Pixel> {
        let Camera { width, height, focal_length, pixel_pitch, principal_point, .. } = self.intrinsics;
        if !(z > focal_length) {
            return None;
        }
        let across = focal_length * x / z / pixel_pitch[0] + principal_point[0];
        let down = focal_length * y / z / pixel_pitch[1] + principal_point[1];
        let on_image = (0.0..f64::from(width)).contains(&across) && (0.0..f64::from(height)).contains(&down);
        on_image.then_some(Pixel { i: across as u32, j: down as u32 })
    }

    /// The vector q from the projection centre through the centre of a pixel, camera frame, metres. It ends on the
    /// image plane.
    pub(crate) fn pixel_ray(&self, pixel: Pixel) -> DVec3 {
        let Camera { focal_length, pixel_pitch, principal_point, .. } = self.intrinsics;
        let x = (f64::from(pixel.i) + 0.5 - principal_point[0]) * pixel_pitch[0];
        let y = (f64::from(pixel.j) + 0.5 - principal_point[1]) * pixel_pitch[1];
        DVec3::new(x, y, focal_length)
    }
}
