//! The pinhole camera: its numbers and the rays they define. No distortion is modelled.

use glam::DVec3;

use crate::SceneError;
use crate::error::check_range;
use crate::image::check_cells;

/// A pinhole camera. Pixel (i, j) is the square `[i, i+1) x [j, j+1)` in units of the pixel pitch, row 0 on
/// top; its ray runs from the projection centre through the pixel's middle.
///
/// ```
/// use glam::DVec3;
/// use raypencil_scene::rig;
///
/// // 4 x 2 pixels of 1/8 m behind a focal length of 1/2 m; the principal point is the middle, (2, 1).
/// let camera = rig::camera(4, 2, 0.125, 0.5);
/// // Pixel (3, 0): (3.5 - 2)/8 to the right, (0.5 - 1)/8 down, which is up.
/// assert_eq!(camera.direction(3, 0), DVec3::new(0.1875, -0.0625, 0.5));
/// ```
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
    /// Point where the normal axis meets the image, in pixels from the outer corner of pixel (0, 0).
    pub principal_point: [f64; 2],
    /// Diameter of the aperture, metres. Geometry is a pinhole's; this is for radiometry.
    pub aperture: f64,
    /// Losses of the lens and its filter.
    pub lens: Lens,
    /// Longest range, along the ray, of the camera's own range map, metres. It does not limit the pencils.
    pub max_range: f64,
}

/// Losses between the aperture and the image.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lens {
    /// The share C_loss that the lens transmits, 0 to 1.
    pub transmission: f64,
    /// The loss F(phi) by the filter before it.
    pub filter: Filter,
}

impl Lens {
    /// A lens without losses.
    pub const CLEAR: Self = Self { transmission: 1.0, filter: Filter::None };
}

/// Share of a beam's light that a filter transmits, by the angle phi between a ray and the camera's normal axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Filter {
    /// All of it: F = 1.
    None,
    /// An interference filter. Seen aslant its pass band moves to shorter wavelengths, centre(phi) = centre
    /// sqrt(1 - (sin(phi) / index)^2), and F(phi) = exp(-4 ln 2 ((wavelength - centre(phi)) / width)^2).
    Interference {
        /// Wavelength at the middle of the pass band for light along the axis, metres.
        centre: f64,
        /// Full width of the pass band at half its height, metres.
        width: f64,
        /// Effective refractive index n_eff of its layers.
        index: f64,
    },
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
        check_range(|| name("lens.transmission"), self.lens.transmission, 0.0, 1.0, "")?;
        if let Filter::Interference { centre, width, index } = self.lens.filter {
            check_range(|| name("lens.filter.centre"), centre, 1e-8, 1e-3, "m")?;
            check_range(|| name("lens.filter.width"), width, 1e-12, 1e-3, "m")?;
            check_range(|| name("lens.filter.index"), index, 1.0, 10.0, "")?;
        }
        check_range(|| name("max_range"), self.max_range, 1e-3, 1e7, "m")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rays_pass_through_the_middles_of_pixels_row_0_on_top() {
        // Pixels 1/8 m wide and 1/4 m high; the axis meets the image at (1, 1.5), which is not its middle. The middle of
        // pixel (3, 0) is 2.5 pixels to the right of the axis and one pixel above it: up is negative, since y is down.
        let camera = Camera {
            width: 4,
            height: 2,
            pixel_pitch: [0.125, 0.25],
            focal_length: 0.5,
            principal_point: [1.0, 1.5],
            aperture: 1e-3,
            lens: Lens::CLEAR,
            max_range: 10.0,
        };
        assert_eq!(camera.direction(3, 0), DVec3::new(0.3125, -0.25, 0.5));
        // The middle of pixel (0, 1) is half a pixel to the left of the axis, at its height.
        assert_eq!(camera.direction(0, 1), DVec3::new(-0.0625, 0.0, 0.5));
    }
}
