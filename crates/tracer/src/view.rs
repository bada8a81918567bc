//! Where a point of the terrain stands for the camera: in its frame, and on its image. (Contract: camera)

use glam::DVec3;
use raypencil_scene::{Camera, Mounted, Pixel};

use crate::rays::Turn;

/// The camera, as seen from the terrain.
#[derive(Debug)]
pub(crate) struct Eye {
    pub(crate) camera: Camera,
    /// The projection centre c, scene frame, metres.
    pub(crate) centre: DVec3,
    /// The camera's unit axes in the scene frame: x right, y down, z forward.
    right: DVec3,
    down: DVec3,
    forward: DVec3,
}

/// A point P before the camera, or behind it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct View {
    /// P in the camera frame, (X, Y, Z), metres: Z is the depth r.
    pub(crate) in_camera: DVec3,
    /// d = |P - c|, metres. No less than |Z| to the last bit, so that no cosine of phi exceeds 1.
    pub(crate) distance: f64,
    /// Where it lands on the image.
    pub(crate) pixel: Option<Pixel>,
}

impl Eye {
    pub(crate) fn new(mounted: &Mounted<Camera>) -> Self {
        let pose = &mounted.scene_from_sensor;
        let scene_from_camera = Turn::of(pose);
        let [right, down, forward] = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| scene_from_camera.apply(axis));
        Self { camera: mounted.sensor, centre: pose.position, right, down, forward }
    }

    pub(crate) fn view(&self, point: DVec3) -> View {
        let from_centre = point - self.centre;
        let [x, y, z] = [self.right, self.down, self.forward].map(|axis| axis.dot(from_centre));
        let in_camera = DVec3::new(x, y, z);
        View { in_camera, distance: in_camera.length(), pixel: self.pixel(in_camera) }
    }

    /// The pixel where a point of the camera frame lands. One at or behind the image plane lands nowhere.
    fn pixel(&self, DVec3 { x, y, z }: DVec3) -> Option<Pixel> {
        let Camera { width, height, focal_length, pixel_pitch, principal_point, .. } = self.camera;
        if !(z > focal_length) {
            return None;
        }
        let across = focal_length * x / z / pixel_pitch[0] + principal_point[0];
        let down = focal_length * y / z / pixel_pitch[1] + principal_point[1];
        let lands = (0.0..f64::from(width)).contains(&across) && (0.0..f64::from(height)).contains(&down);
        lands.then_some(Pixel { i: across as u32, j: down as u32 })
    }

    /// The ray through the middle of a pixel, camera frame, metres; at the image plane.
    pub(crate) fn through_middle(&self, pixel: Pixel) -> DVec3 {
        let Camera { focal_length, pixel_pitch, principal_point, .. } = self.camera;
        let x = (f64::from(pixel.i) + 0.5 - principal_point[0]) * pixel_pitch[0];
        let y = (f64::from(pixel.j) + 0.5 - principal_point[1]) * pixel_pitch[1];
        DVec3::new(x, y, focal_length)
    }
}
