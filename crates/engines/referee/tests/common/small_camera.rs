//! The camera of tests by hand.

use raypencil_scene::{Camera, Lens};

/// 9 x 9 pixels. Pixel (4, 4) looks along z, and a cell is 1/8 m for each metre of depth.
pub(crate) fn small_camera() -> Camera {
    Camera {
        width: 9,
        height: 9,
        pixel_pitch: [0.0625; 2],
        focal_length: 0.5,
        principal_point: [4.5; 2],
        aperture: 0.01,
        lens: Lens::CLEAR,
        max_range: 20.0,
    }
}
