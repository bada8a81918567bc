//! Warnings about a drive's settings: beams that the camera cannot tell apart, a threshold that does not fit the light.

use glam::DVec3;
use raypencil_rover::{DrivePlan, ExposureMode, OnVehicle};

/// Warns if beams are lit together and a beam is not steeper than the next one. Stripes of one image are told apart by
/// their order: the lowest is taken for that of beam 0, the steepest.
pub(crate) fn beams_out_of_order(plan: &DrivePlan) -> Option<String> {
    let down = |beam: &OnVehicle<_>| -beam.vehicle_from_sensor.rotate(DVec3::Z).z;
    let steeper = plan.rig.beams.windows(2).position(|pair| down(&pair[0]) <= down(&pair[1]))?;
    (plan.exposures == ExposureMode::Together).then(|| {
        format!(
            "beam {steeper} is not steeper than beam {}: with both in one image, the lowest stripe counts as beam 0's",
            steeper + 1
        )
    })
}

/// Warns that the default threshold does not account for `ignored`: light or electronics that the file changes.
///
/// With an unlit image subtracted, the sun's light is gone but its noise is not: the warning is given there, too.
pub(crate) fn blind_threshold(ignored: &str) -> String {
    format!("the default threshold is for the preset alone, without {ignored}: give threshold_dn")
}
