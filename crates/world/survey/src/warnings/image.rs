//! Rules on the camera's image.

use raypencil_scene::{Camera, SensorId, rig};

use crate::warning::{Warning, WarningCode};

/// Largest distance of the principal point from the middle, as a share of the image's side, tuned. Lenses of real
/// cameras are off by a few hundredths. A quarter and more is left from an image of another size.
const MAX_OFF_CENTRE: f64 = 0.25;

/// Warns if the principal point is outside the image.
pub fn principal_point_outside(camera: &Camera) -> Option<Warning> {
    let [x, y] = camera.principal_point;
    let (width, height) = (f64::from(camera.width), f64::from(camera.height));
    let is_outside = !(0.0..=width).contains(&x) || !(0.0..=height).contains(&y);
    is_outside.then(|| {
        let sentence =
            format!("its principal point ({x}, {y}) is outside its image of {width} x {height} pixels.");
        Warning::of_sensor(WarningCode::PrincipalPointOutside, SensorId::Camera, sentence)
    })
}

/// Warns if the principal point is inside the image and far from its middle, or at the middle of the default image in
/// an image of another size: somebody changed the size and left the point behind.
pub fn principal_point_off_centre(camera: &Camera) -> Option<Warning> {
    if principal_point_outside(camera).is_some() {
        return None;
    }
    let sides = [camera.width, camera.height].map(f64::from);
    let is_far = (0..2)
        .any(|axis| (camera.principal_point[axis] - 0.5 * sides[axis]).abs() > MAX_OFF_CENTRE * sides[axis]);
    let default = rig::default_camera();
    let is_left_behind = camera.principal_point == default.principal_point
        && [camera.width, camera.height] != [default.width, default.height];
    (is_far || is_left_behind).then(|| {
        let ([x, y], [width, height]) = (camera.principal_point, sides);
        let sentence = format!(
            "its principal point ({x}, {y}) is not near the middle of its image, ({}, {}): was it left from an image \
             of another size?",
            0.5 * width,
            0.5 * height
        );
        Warning::of_sensor(WarningCode::PrincipalPointOffCentre, SensorId::Camera, sentence)
    })
}
