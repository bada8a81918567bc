//! Calibration file of a camera for ROS, `camera_info` in YAML. (ROS REP-104; sensor_msgs/CameraInfo;
//! camera_calibration_parsers)

use raypencil_scene::Camera;

use crate::maps::yaml::{quoted, real};

/// Camera matrix (3 x 3) and projection (3 x 4), row by row, pixels. In ROS, as in OpenCV, the *middle* of pixel (0, 0) is at (0, 0); here, that is the
/// pixel's outer corner. The principal point therefore moves by half a pixel.
pub(crate) fn camera_matrices(camera: &Camera) -> ([f64; 9], [f64; 12]) {
    let [fx, fy] = camera.pixel_pitch.map(|pitch| camera.focal_length / pitch);
    let [cx, cy] = camera.principal_point.map(|point| point - 0.5);
    let matrix = [fx, 0.0, cx, 0.0, fy, cy, 0.0, 0.0, 1.0];
    let projection = [fx, 0.0, cx, 0.0, 0.0, fy, cy, 0.0, 0.0, 0.0, 1.0, 0.0];
    (matrix, projection)
}

/// Calibration file of a camera. A camera without distortion has the model `plumb_bob` with zeros.
pub fn camera_info(camera: &Camera, name: &str) -> String {
    let (camera_matrix, projection) = camera_matrices(camera);
    let matrix = |name: &str, rows: u32, columns: u32, data: &[f64]| {
        let data: Vec<String> = data.iter().map(|&value| real(value)).collect();
        format!("{name}:\n  rows: {rows}\n  cols: {columns}\n  data: [{}]\n", data.join(", "))
    };
    let mut text = format!(
        "# A pinhole: pixels square to the axis, no distortion. The middle of pixel (0, 0) is at (0, 0).\n\
         image_width: {}\nimage_height: {}\ncamera_name: {}\n",
        camera.width,
        camera.height,
        quoted(name)
    );
    text += &matrix("camera_matrix", 3, 3, &camera_matrix);
    text += "distortion_model: plumb_bob\n";
    text += &matrix("distortion_coefficients", 1, 5, &[0.0; 5]);
    text += &matrix("rectification_matrix", 3, 3, &[1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]);
    text + &matrix("projection_matrix", 3, 4, &projection)
}

#[cfg(test)]
mod tests {
    use raypencil_scene::Lens;

    use super::*;

    #[test]
    fn the_principal_point_is_that_of_opencv() {
        let camera = Camera {
            width: 1024,
            height: 768,
            pixel_pitch: [1.0 / 131_072.0, 1.0 / 65_536.0],
            focal_length: 1.0 / 128.0,
            principal_point: [512.0, 384.0],
            aperture: 2e-3,
            lens: Lens::CLEAR,
            max_range: 20.0,
        };
        let text = camera_info(&camera, "rover");
        // The focal length of 2^-7 m is 1024 pixels of 2^-17 m and 512 pixels of 2^-16 m.
        for line in [
            "image_width: 1024",
            "image_height: 768",
            "camera_name: \"rover\"",
            "  data: [1024.0, 0.0, 511.5, 0.0, 512.0, 383.5, 0.0, 0.0, 1.0]",
            "distortion_model: plumb_bob",
            "  data: [1024.0, 0.0, 511.5, 0.0, 0.0, 512.0, 383.5, 0.0, 0.0, 0.0, 1.0, 0.0]",
        ] {
            assert!(text.lines().any(|other| other == line), "{line} is not in:\n{text}");
        }
    }

    #[test]
    fn every_number_is_one_and_the_name_is_a_text() {
        // 2^20 / 2^-40 = 2^60 = 1152921504606846976, and 2^20 / 2^60 = 2^-40.
        let camera = Camera {
            width: 2,
            height: 1,
            pixel_pitch: [1.0 / (1_u64 << 40) as f64, (1_u64 << 60) as f64],
            focal_length: (1_u64 << 20) as f64,
            principal_point: [1.0, 0.5],
            aperture: 2e-3,
            lens: Lens::CLEAR,
            max_range: 20.0,
        };
        let text = camera_info(&camera, "-");
        assert!(text.contains("\ncamera_name: \"-\"\n"), "{text}");
        let matrix = "[1.152921504606847e+18, 0.0, 0.5, 0.0, 9.094947017729282e-13, 0.0, 0.0, 0.0, 1.0]";
        assert!(text.contains(matrix), "{text}");
    }
}
