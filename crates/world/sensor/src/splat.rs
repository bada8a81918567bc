//! Points of light on an image finer than the camera's: sharp, or as the disc of a defocused lens.

use std::f64::consts::PI;

use glam::DVec3;
use raypencil_scene::{Camera, Image, SceneError, check_range};

use crate::disc;

/// Light that converges in one point of the image, from one pencil.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PointSource {
    /// Position in pixels to the right of the image's left side.
    pub x: f64,
    /// Position in pixels down from the image's upper side.
    pub y: f64,
    /// Flux, watts.
    pub watts: f64,
    /// Depth of the emitting point along the camera's normal axis, metres.
    pub depth: f64,
}

impl PointSource {
    /// Projects a point of the camera frame: (c_x + f_c x / (z p_x), c_y + f_c y / (z p_y)).
    pub fn project(camera: &Camera, point: DVec3, watts: f64) -> Self {
        let place = |axis: usize, across: f64| {
            camera.principal_point[axis] + camera.focal_length * across / (point.z * camera.pixel_pitch[axis])
        };
        Self { x: place(0, point.x), y: place(1, point.y), watts, depth: point.z }
    }
}

/// Image of points of light, on fine cells.
#[derive(Debug, Clone, PartialEq)]
pub struct SplatImage {
    /// Watts per cell.
    pub image: Image<f64>,
    /// Flux that falls beside the image, watts.
    pub lost: f64,
}

/// Adds each source to the cell it falls into, of a `width x height` image with `oversampling` cells along the
/// side of a pixel. Sources are added in their order.
pub fn splat(
    width: u32,
    height: u32,
    oversampling: u32,
    sources: impl IntoIterator<Item = PointSource>,
) -> SplatImage {
    let mut image = Image::filled(width * oversampling, height * oversampling, 0.0);
    let mut lost = 0.0;
    for source in sources {
        add_point(&mut image, &mut lost, oversampling, source);
    }
    SplatImage { image, lost }
}

/// Adds each source to the image as the disc that the lens makes of it at its depth. The disc is evenly lit, and
/// cells at its edge get their exact fraction of its area. Sources are added in their order. `pixel_pitch` is the
/// camera's, metres.
pub fn splat_defocused(
    width: u32,
    height: u32,
    oversampling: u32,
    pixel_pitch: [f64; 2],
    lens: &ThinLens,
    sources: impl IntoIterator<Item = PointSource>,
) -> SplatImage {
    let mut image = Image::filled(width * oversampling, height * oversampling, 0.0);
    let mut lost = 0.0;
    let s = f64::from(oversampling);
    for source in sources {
        let radius = 0.5 * lens.blur_diameter(source.depth);
        let radii = pixel_pitch.map(|pitch| radius / pitch * s);
        // In focus, or without a depth that a lens can image.
        if !(radii[0] > 0.0 && radii[1] > 0.0 && radius.is_finite()) {
            add_point(&mut image, &mut lost, oversampling, source);
            continue;
        }
        let [x, y] = [source.x * s, source.y * s];
        // Border number `k` of the cells, in radii from the centre.
        let across = |k: u32| (f64::from(k) - x) / radii[0];
        let down = |k: u32| (f64::from(k) - y) / radii[1];
        let range = |middle: f64, radius: f64, count: u32| {
            let first = (middle - radius).floor().clamp(0.0, f64::from(count)) as u32;
            let end = (middle + radius).ceil().clamp(0.0, f64::from(count)) as u32;
            first..end
        };
        let columns = range(x, radii[0], image.width());
        for j in range(y, radii[1], image.height()) {
            for i in columns.clone() {
                let share = disc::area(across(i), across(i + 1), down(j), down(j + 1)) / PI;
                // Rounding may give a cell that the disc hardly touches a fraction of -1e-17.
                image.set(i, j, image.at(i, j) + source.watts * share.max(0.0));
            }
        }
        let inside = disc::area(across(0), across(image.width()), down(0), down(image.height())) / PI;
        lost += source.watts * (1.0 - inside).max(0.0);
    }
    SplatImage { image, lost }
}

fn add_point(image: &mut Image<f64>, lost: &mut f64, oversampling: u32, source: PointSource) {
    let s = f64::from(oversampling);
    let (right, bottom) = (f64::from(image.width()) / s, f64::from(image.height()) / s);
    if !(source.x >= 0.0 && source.x < right && source.y >= 0.0 && source.y < bottom) {
        *lost += source.watts;
        return;
    }
    // The product may round up to the far side.
    let i = ((source.x * s) as u32).min(image.width() - 1);
    let j = ((source.y * s) as u32).min(image.height() - 1);
    image.set(i, j, image.at(i, j) + source.watts);
}

/// Thin lens, focused at some depth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ThinLens {
    /// Diameter D of its aperture, metres.
    pub aperture: f64,
    /// Focal length f of the lens, metres. This is *not* the camera's f_c, the distance of its image plane.
    pub focal_length: f64,
    /// Depth z_f at which it is in focus, metres; may be infinite.
    pub focus: f64,
}

impl ThinLens {
    /// Lens that images depth `focus` sharply on the image plane of this camera, f_c behind it: 1 / f = 1 / f_c +
    /// 1 / z_f.
    ///
    /// ```
    /// # use raypencil_scene::{Camera, Lens};
    /// use raypencil_sensor::ThinLens;
    ///
    /// # let camera = Camera {
    /// #     width: 8, height: 8, pixel_pitch: [9e-6; 2], focal_length: 8e-3, principal_point: [4.0; 2],
    /// #     aperture: 2e-3, lens: Lens::CLEAR, max_range: 20.0,
    /// # };
    /// // f_c = 8 mm, D = 2 mm, focus at 4 m. At 2 m the disc is D f_c |1/2 - 1/4| = 2e-3 * 8e-3 / 4 = 4 um wide.
    /// let lens = ThinLens::for_camera(&camera, 4.0);
    /// assert!((lens.blur_diameter(2.0) - 4e-6).abs() < 1e-18);
    /// ```
    pub fn for_camera(camera: &Camera, focus: f64) -> Self {
        let focal_length = camera.focal_length / (1.0 + camera.focal_length / focus);
        Self { aperture: camera.aperture, focal_length, focus }
    }

    /// Diameter of the blur disc on the image plane for a point at this depth, metres: c = D f |z - z_f| / (z
    /// (z_f - f)), written so that z_f may be infinite.
    pub fn blur_diameter(&self, depth: f64) -> f64 {
        self.aperture * self.focal_length * (1.0 / depth - 1.0 / self.focus).abs()
            / (1.0 - self.focal_length / self.focus)
    }

    /// Checks that all values are in their ranges.
    ///
    /// # Errors
    /// Names the first invalid field, as a part of `field`.
    pub fn validate(&self, field: &str) -> Result<(), SceneError> {
        check_range(|| format!("{field}.aperture"), self.aperture, 1e-6, 1e1, "m")?;
        check_range(|| format!("{field}.focal_length"), self.focal_length, 1e-5, 1e2, "m")?;
        let nearest = 1.001 * self.focal_length;
        check_range(|| format!("{field}.focus"), self.focus, nearest, f64::INFINITY, "m")
    }
}
