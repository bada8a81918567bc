//! Warnings about a drive: beams that the camera cannot tell apart, a threshold that does not fit the light, sensors
//! that do not see the ground at the start, nothing measured.

use glam::DVec3;
use raypencil_rover::{DrivePlan, ExposureMode, OnVehicle};
use raypencil_scene::Scene;
use raypencil_survey::{Warning, WarningCode, warnings};

/// Warns if beams are lit together and a beam is not steeper than the next one. Stripes of one image are told apart by
/// their order: the lowest is taken for that of beam 0, the steepest.
pub(crate) fn beams_out_of_order(plan: &DrivePlan) -> Option<Warning> {
    let down = |beam: &OnVehicle<_>| -beam.vehicle_from_sensor.rotate(DVec3::Z).z;
    let steeper = plan.rig.beams.windows(2).position(|pair| down(&pair[0]) <= down(&pair[1]))?;
    (plan.exposures == ExposureMode::Together).then(|| {
        let sentence = format!(
            "beam {steeper} is not steeper than beam {}: with both in one image, the lowest stripe counts as beam 0's.",
            steeper + 1
        );
        Warning::of_scene(WarningCode::BeamsOutOfOrder, sentence)
    })
}

/// Warns that the default threshold does not account for `ignored`: light or electronics that the file changes.
///
/// With an unlit image subtracted, the sun's light is gone but its noise is not: the warning is given there, too.
pub(crate) fn blind_threshold(ignored: &str) -> Warning {
    let sentence =
        format!("the default threshold is for the preset alone, without {ignored}: give threshold_dn.");
    Warning::of_scene(WarningCode::BlindThreshold, sentence)
}

/// Warnings about the scene of the first frame. The vehicle stands on its wheels there, whatever the scene file says.
pub(crate) fn at_the_start(scene: &Scene) -> Vec<Warning> {
    warnings(scene, None, None)
}

/// Warns if a whole drive found no edge of a stripe: then its maps know nothing.
pub(crate) fn nothing_measured(edge_points: u64) -> Option<Warning> {
    let sentence = "no image has an edge of a stripe, so no point of the ground was measured.";
    (edge_points == 0).then(|| Warning::of_scene(WarningCode::NothingMeasured, sentence))
}
