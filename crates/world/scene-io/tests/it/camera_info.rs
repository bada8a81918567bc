//! Calibrations of ROS: the models of distortion that are a pinhole, and shapes beside numbers.

use std::path::Path;

use raypencil_scene_io::{CameraInfo, camera_info_from_text};

/// The file of a calibrator, whose coefficients are zero.
const FILE: &str = "image_width: 640\nimage_height: 480\n\
    camera_matrix:\n  rows: 3\n  cols: 3\n  data: [600, 0, 319.5, 0, 610.5, 239.5, 0, 0, 1]\n\
    distortion_model: plumb_bob\n\
    distortion_coefficients:\n  rows: 1\n  cols: 5\n  data: [0, 0, 0, 0, 0]\n\
    rectification_matrix:\n  rows: 3\n  cols: 3\n  data: [1, 0, 0, 0, 1, 0, 0, 0, 1]\n\
    projection_matrix:\n  rows: 3\n  cols: 4\n  data: [580, 0, 320, 0, 0, 590, 240, 0, 0, 0, 1, 0]\n";

/// What is read of the file with one change.
fn changed(from: &str, to: &str, is_rectified: bool) -> Result<CameraInfo, String> {
    assert!(FILE.contains(from), "{from}");
    camera_info_from_text(&FILE.replace(from, to), Path::new("left.yaml"), is_rectified)
        .map_err(|error| error.to_string())
}

const OWN: CameraInfo =
    CameraInfo { size: [640, 480], focal_length: [600.0, 610.5], principal_point: [319.5, 239.5] };

const RECTIFIED: CameraInfo =
    CameraInfo { size: [640, 480], focal_length: [580.0, 590.0], principal_point: [320.0, 240.0] };

#[test]
fn models_whose_zeros_are_a_pinhole_are_taken() {
    for model in ["rational_polynomial", "plumb_bob", "\"\"", ""] {
        assert_eq!(changed("plumb_bob", model, false), Ok(OWN), "{model}");
    }
    assert_eq!(changed("distortion_model: plumb_bob\n", "", false), Ok(OWN));
    // Of rectified images P says all, by whatever model they were made.
    assert_eq!(changed("plumb_bob", "equidistant", true), Ok(RECTIFIED));
}

/// r = f theta of `equidistant` is no pinhole where the four coefficients of theta are zero.
#[test]
fn any_other_model_is_refused_even_with_zeros() {
    for model in ["equidistant", "fisheye", "kannala_brandt", "banana", "Plumb_Bob"] {
        let error = changed("plumb_bob", model, false).unwrap_err();
        let words = format!(
            "left.yaml:7:19: the model of distortion is {model:?}; expected plumb_bob or rational_polynomial, which are"
        );
        assert!(error.contains(&words), "{error}");
    }
}

#[test]
fn a_shape_that_is_not_that_of_its_numbers_is_refused() {
    for (from, to, words) in [
        (
            "camera_matrix:\n  rows: 3\n  cols: 3",
            "camera_matrix:\n  rows: 9\n  cols: 1",
            "left.yaml:4:3: the camera matrix K says 9 x 1 and has 9 numbers; expected 3 rows of 3",
        ),
        (
            "camera_matrix:\n  rows: 3\n  cols: 3",
            "camera_matrix:\n  cols: 4",
            "left.yaml:4:3: the camera matrix K says ? x 4 and has 9 numbers; expected 3 rows of 3",
        ),
        (
            "rows: 1\n  cols: 5",
            "rows: 1\n  cols: 4",
            "left.yaml:9:3: the list of coefficients says 1 x 4 and has 5 numbers; expected as many as it says",
        ),
        (
            "[1, 0, 0, 0, 1, 0,",
            "[1, 0, 0, 1, 0,",
            "left.yaml:13:3: the rectification R says 3 x 3 and has 8 numbers; expected 3 rows of 3",
        ),
        (
            "cols: 4",
            "cols: 3",
            "left.yaml:17:3: the projection P says 3 x 3 and has 12 numbers; expected 3 rows of 4",
        ),
    ] {
        for is_rectified in [false, true] {
            let error = changed(from, to, is_rectified).unwrap_err();
            assert!(error.contains(words), "{error} has no {words:?}");
        }
    }
    // Half a shape that is right, and the R of a stereo pair: the pose in the scene is that of the rectified camera.
    assert_eq!(changed("  rows: 1\n", "", false), Ok(OWN));
    assert_eq!(changed("[1, 0, 0, 0, 1, 0, 0, 0, 1]", "[0, -1, 0, 1, 0, 0, 0, 0, 1]", true), Ok(RECTIFIED));
}
