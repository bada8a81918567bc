//! Cameras by field of view, by numbers in pixels and by calibrations of ROS, against values derived by hand.

use glam::DVec3;
use std::path::Path;

use raypencil_scene::{Camera, Scene};
use raypencil_scene_io::{Overrides, Setting, load_text, load_text_with};

fn scene(keys: &str) -> Result<Scene, String> {
    load_text(&format!("version = 1\n[camera]\n{keys}\n"), "rig")
        .map(|loaded| loaded.scene)
        .map_err(|error| error.to_string())
}

fn camera(keys: &str) -> Camera {
    scene(keys).unwrap_or_else(|error| panic!("{keys}: {error}")).camera().sensor
}

/// Direction of a ray, scaled so that its z is 1.
fn slopes(camera: &Camera, i: u32, j: u32) -> [f64; 2] {
    let DVec3 { x, y, z } = camera.direction(i, j);
    [x / z, y / z]
}

fn near(value: f64, expected: f64) {
    assert!((value - expected).abs() <= 4.0 * f64::EPSILON * expected.abs(), "{value} is not {expected}");
}

#[test]
fn a_field_of_view_is_from_edge_to_edge() {
    // tan(90/2) = 1: half the image, 256 pixels of 9 um, is as long as the focal length.
    let square = camera("width_px = 512\nheight_px = 256\nfield_of_view_deg = 90");
    near(square.focal_length, 256.0 * 9e-6);
    assert_eq!((square.pixel_pitch, square.principal_point), ([9e-6, 9e-6], [256.0, 128.0]));
    // The edge is half a pixel beyond the middle of the last one: (511.5 - 256) / 256.
    near(slopes(&square, 511, 0)[0], 255.5 / 256.0);
    // Two angles: pixels that are not square. tan(53.13.../2) = 1/2, so that 128 pixels are half a focal length long.
    let down = 2.0 * libm::atan(0.5).to_degrees();
    let oblong = camera(&format!("width_px = 512\nheight_px = 256\nfield_of_view_deg = [90, {down:?}]"));
    near(oblong.focal_length, 256.0 * 9e-6);
    near(oblong.pixel_pitch[1], oblong.focal_length / 256.0);
    near(slopes(&oblong, 0, 255)[1], 127.5 / 256.0);
    // The width of the image of the default camera, and pixels of another size: the same rays.
    near(
        slopes(&camera("field_of_view_deg = 60"), 1000, 3)[0],
        slopes(&camera("field_of_view_deg = 60\npixel_pitch_um = 3"), 1000, 3)[0],
    );
}

#[test]
fn numbers_in_pixels_count_from_the_middle_of_the_first_pixel() {
    let keys =
        "width_px = 640\nheight_px = 480\nintrinsics_px = { fx = 600, fy = 480, cx = 300, cy = 250.5 }";
    let camera_of_file = camera(keys);
    assert_eq!(camera_of_file.principal_point, [300.5, 251.0]);
    // Pixel (300, 250) looks along the axis but for half a pixel down; pixel (600, 10) 300/600 to the right and 240.5/480 up.
    let [right, down] = slopes(&camera_of_file, 300, 250);
    assert_eq!(right, 0.0);
    near(down, -0.5 / 480.0);
    let [right, down] = slopes(&camera_of_file, 600, 10);
    near(right, 0.5);
    near(down, -240.5 / 480.0);
    // Without fy pixels are square, and without cx and cy the axis is in the middle.
    let square = camera("width_px = 640\nheight_px = 480\nintrinsics_px = { fx = 600 }\npixel_pitch_um = 3");
    assert_eq!((square.pixel_pitch, square.principal_point), ([3e-6, 3e-6], [320.0, 240.0]));
    near(square.focal_length, 600.0 * 3e-6);
}

#[test]
fn a_calibration_of_ros_is_a_camera() {
    let folder = tempfile::tempdir().unwrap();
    let calibration = "image_width: 640\nimage_height: 480\ncamera_name: left\n\
        camera_matrix: {rows: 3, cols: 3, data: [600, 0, 300, 0, 480, 250.5, 0, 0, 1]}\n\
        distortion_model: plumb_bob\ndistortion_coefficients: {rows: 1, cols: 5, data: [-0.25, 0, 0, 0, 0]}\n\
        projection_matrix: {rows: 3, cols: 4, data: [500, 0, 320, -50, 0, 500, 240, 0, 0, 0, 1, 0]}\n";
    let load = |calibration: &str, keys: &str| {
        std::fs::write(folder.path().join("left.yaml"), calibration).unwrap();
        let text = format!("version = 1\n[camera]\ncamera_info = \"left.yaml\"\n{keys}\n");
        let path = folder.path().join("scene.toml");
        std::fs::write(&path, text).unwrap();
        super::load_path(&path, &Overrides::default())
    };
    let pinhole = calibration.replace("-0.25", "0");
    let own = load(&pinhole, "").unwrap();
    let by_hand =
        "width_px = 640\nheight_px = 480\nintrinsics_px = { fx = 600, fy = 480, cx = 300, cy = 250.5 }";
    assert_eq!(own.scene.camera().sensor, camera(by_hand));
    // Another calibration is another scene, though the scene file is the same.
    let other = load(&pinhole.replace("camera_name: left", "camera_name: right"), "").unwrap();
    assert_eq!(other.scene_sha256, own.scene_sha256);
    assert_ne!(other.source_sha256, own.source_sha256);
    // Distorted images are refused in the calibration's own line; rectified ones are those of the projection.
    let error = load(calibration, "").unwrap_err().to_string();
    assert!(error.contains("left.yaml:6:26: the images are distorted, plumb_bob [-0.25, "), "{error}");
    let rectified = load(calibration, "camera_info_rectified = true").unwrap();
    assert_eq!(
        rectified.scene.camera().sensor,
        camera("width_px = 640\nheight_px = 480\nintrinsics_px = { fx = 500, cx = 320, cy = 240 }")
    );
    for (calibration, words) in [
        (pinhole.replace("640", "0"), "`camera.width_px` is 0; expected 1 to 1048576 pixels"),
        (pinhole.replace("[600, ", "[-600, "), "`camera.camera_info: fx and fy` is -600"),
        (pinhole.replace("[600, ", "[.nan, "), "`camera.camera_info: fx and fy` is NaN"),
        (pinhole.replace("[600, ", "[1e-3, "), "`camera.camera_info` gives a focal length of"),
    ] {
        let error = load(&calibration, "").unwrap_err().to_string();
        assert!(error.contains(words), "{error}");
    }
    let error = super::load_path(Path::new("/dev/null/scene.toml"), &Overrides::default()).unwrap_err();
    assert!(error.to_string().contains("/dev/null/scene.toml"), "{error}");
}

#[test]
fn an_image_has_one_description() {
    for (keys, words) in [
        (
            "field_of_view_deg = 60\nfocal_length_mm = 8",
            "rig.toml:4:19: `camera.focal_length_mm` is given beside `camera.field_of_view_deg`",
        ),
        (
            "intrinsics_px = { fx = 600 }\nfield_of_view_deg = 60",
            "`camera.field_of_view_deg` is given beside `camera.intrinsics_px`",
        ),
        (
            "intrinsics_px = { fx = 600 }\nprincipal_point_px = [1, 2]",
            "`camera.principal_point_px` is given beside",
        ),
        (
            "intrinsics_px = { fx = 600 }\npixel_pitch_um = [9, 9]",
            "`camera.pixel_pitch_um = [x, y]` is given beside",
        ),
        (
            "field_of_view_deg = [60, 40]\npixel_pitch_um = [9, 9]",
            "`camera.pixel_pitch_um = [x, y]` is given beside",
        ),
        (
            "field_of_view_deg = 60\nprincipal_point_px = [1, 2]",
            "`camera.principal_point_px` is given beside",
        ),
        ("camera_info = \"a.yaml\"\nwidth_px = 8", "`camera.width_px` is given beside `camera.camera_info`"),
        ("camera_info_rectified = true", "expected it only beside `camera_info`"),
        ("camera_info = \"a.yaml\"", "there is no file \"a.yaml\"; expected a calibration of ROS as YAML"),
        ("field_of_view_deg = 180", "`camera.field_of_view_deg` is 180; expected 0.001 to 179.9 degrees"),
        ("field_of_view_deg = [60, nan]", "`camera.field_of_view_deg` is NaN"),
        ("intrinsics_px = { fx = 0 }", "`camera.intrinsics_px.fx` is 0; expected 0.001 to 1e9 pixels"),
        ("intrinsics_px = { fx = 600, fy = 1e8 }", "gives a height of a pixel of"),
        ("intrinsics_px = { fy = 600 }", "the key `fx` is missing"),
        ("fov = 60", "did you mean `field_of_view_deg`, in degrees?"),
    ] {
        let error = scene(keys).unwrap_err();
        assert!(error.contains(words), "{error} has no {words:?}");
    }
    // A pair of pitches goes with one angle.
    assert_eq!(camera("field_of_view_deg = 60\npixel_pitch_um = [9, 4]").pixel_pitch, [9e-6, 4e-6]);
}

#[test]
fn a_set_description_takes_the_place_of_the_one_before() {
    let written = "version = 1\n[camera]\nfocal_length_mm = 8\nprincipal_point_px = [512, 512]\n";
    let changed = |text: &str, settings: &[&str]| {
        let settings = settings.iter().map(|setting| Setting::parse(setting).unwrap()).collect();
        load_text_with(text, "rig", &Overrides { settings, ..Overrides::default() })
            .unwrap()
            .scene
            .camera()
            .sensor
    };
    assert_eq!(changed(written, &["camera.field_of_view_deg=90"]), camera("field_of_view_deg = 90"));
    assert_eq!(
        changed(written, &["camera.intrinsics_px.fx=900", "camera.intrinsics_px.cx=500"]),
        camera("intrinsics_px = { fx = 900, cx = 500 }")
    );
    let by_angle = "version = 1\n[camera]\nfield_of_view_deg = 90\n";
    assert_eq!(changed(by_angle, &["camera.focal_length_mm=6"]), camera("focal_length_mm = 6"));
}
