//! The start of a drive against the pose of `[vehicle]`: a drive's vehicle stands on its wheels, on the highest ground.

use glam::DVec3;
use raypencil_rover::Drive;
use raypencil_scene::{Mesh, Pose, SceneError};
use raypencil_survey::{Warning, WarningCode};
use raypencil_terrain::height_at;

/// Difference of two heights that are told apart, metres. CHOICE: people write heights to a millimetre.
const SAME_HEIGHT_M: f64 = 1e-3;

/// Difference of two directions that are told apart, radians. CHOICE: people write angles to a tenth of a degree.
const SAME_DIRECTION: f64 = 1.8e-3;

/// Height at which a scene puts its vehicle, global, metres; `None` if that is the ground, as it is without a z. `vehicle` is the
/// pose of `[vehicle]`, global.
pub(crate) fn height_off_ground(vehicle: &Pose, mesh: &Mesh) -> Option<f64> {
    let DVec3 { x, y, z } = vehicle.position;
    let is_on_ground = height_at(mesh, x, y).is_some_and(|ground| is_same(ground, z));
    (!is_on_ground).then_some(z)
}

/// Refuses a drive of a scene that says that the vehicle is at this height, global, metres, if it stands at another: it would be on
/// other ground than was meant.
///
/// # Errors
/// Names `vehicle.position_m`, with the height at which the vehicle would stand.
pub(crate) fn check_height(given: f64, drive: &Drive) -> Result<(), SceneError> {
    // On rough ground the middle of the wheels is not at the height of the ground below it. Either is right.
    let Some(stands) = drive.start_stance().filter(|stance| !is_same(stance.position.z, given)) else {
        return Ok(());
    };
    let DVec3 { x, y, z } = stands.position;
    let below = match given < z {
        true => ". To drive below a roof, leave the roof out of the mesh",
        false => "",
    };
    let value = format!("{given} m high");
    let expected = format!(
        "no z, or {z:.3} m: at ({x}, {y}) a drive's vehicle stands on its wheels, on the highest ground{below}"
    );
    Err(SceneError::new("vehicle.position_m", value, expected))
}

fn is_same(a: f64, b: f64) -> bool {
    (a - b).abs() <= SAME_HEIGHT_M
}

/// Warns if `[vehicle]` leans and the vehicle stands otherwise. Both poses are global.
pub(crate) fn leans_otherwise(given: &Pose, stands: &Pose) -> Option<Warning> {
    let [up, stands_up] = [given, stands].map(|pose| pose.rotate(DVec3::Z));
    // Upright is the default: who says nothing of it is not contradicted by a slope.
    if up.z >= 1.0 - 1e-12 || (up - stands_up).length() <= SAME_DIRECTION {
        return None;
    }
    let words = |pose: &Pose| {
        // To a tenth of a degree, and 0 in place of -0.
        let tenths = |sine: f64| (libm::asin(sine.clamp(-1.0, 1.0)).to_degrees() * 10.0).round() / 10.0 + 0.0;
        let [nose, left] = [-DVec3::X, DVec3::Y].map(|axis| tenths(pose.rotate(axis).z));
        format!("nose {nose:.1}° down and left side {left:.1}° up")
    };
    let sentence = format!(
        "[vehicle] leans, {}, and the vehicle of a drive stands on its wheels: {}. Leave pitch_down_deg and roll_right_deg out.",
        words(given),
        words(stands)
    );
    Some(Warning::of_scene(WarningCode::VehicleLeansOtherwise, sentence))
}
