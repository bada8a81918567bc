//! The pinhole camera: its numbers and the rays they define. No distortion is modelled.

use glam::DVec3;

use crate::SceneError;
use crate::error::check_range;
use crate::image::check_cells;

/// A pinhole camera. Pixel (i, j) is the square `[i, i+1) x [j, j+1)` in units of the pixel pitch, row 0 on
/// top; its ray runs from the projection centre through the pixel's middle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Camera {
    /// Columns of the image.
    pub width: u32,
    /// Rows of the image.
    pub height: u32,
    /// Size of a pixel in x and y, metres.
    pub pixel_pitch: [f64; 2],
    /// Distance of the image plane (the SPP) from the projection centre, metres.
    pub focal_length: f64,
    /// Where the normal axis meets the image, in pixels from the outer corner of pixel (0, 0).
    pub principal_point: [f64; 2],
    /// Diameter of the aperture, metres. Geometry is a pinhole's; this is for radiometry.
    pub aperture: f64,
    /// Longest range, along the ray, of the camera's own range map, metres. It does not limit the pencils.
    pub max_range: f64,
}

impl Camera {
    /// Direction of the ray of pixel (i, j) in the camera frame, not a unit:
    /// `((i + 1/2 - c_x) p_x, (j + 1/2 - c_y) p_y, f_c)`. At t = 1 the ray crosses the image plane.
    pub fn direction(&self, i: u32, j: u32) -> DVec3 {
        DVec3::new(
            (f64::from(i) + 0.5 - self.principal_point[0]) * self.pixel_pitch[0],
            (f64::from(j) + 0.5 - self.principal_point[1]) * self.pixel_pitch[1],
            self.focal_length,
        )
    }

    /// Refuses a camera that no renderer could work with, naming the field.
    pub fn validate(&self, field: &str) -> Result<(), SceneError> {
        let name = |part: &str| format!("{field}.{part}");
        check_cells(field, "width", self.width, "height", self.height)?;
        for (axis, label) in ["x", "y"].into_iter().enumerate() {
            let pitch = self.pixel_pitch[axis];
            check_range(|| name(&format!("pixel_pitch.{label}")), pitch, 1e-8, 1e-1, "m")?;
            let centre = self.principal_point[axis];
            check_range(|| name(&format!("principal_point.{label}")), centre, -1e6, 1e6, "pixels")?;
        }
        check_range(|| name("focal_length"), self.focal_length, 1e-5, 1e2, "m")?;
        check_range(|| name("aperture"), self.aperture, 1e-6, 1e1, "m")?;
        check_range(|| name("max_range"), self.max_range, 1e-3, 1e7, "m")
    }
}
