//! Warnings about a drive: beams that the camera cannot tell apart, a threshold that does not fit the light, sensors
//! that do not see the ground at the start, nothing measured.

use glam::DVec3;
use raypencil_rover::{DrivePlan, ExposureMode, OnVehicle, StripeExtractor};
use raypencil_scene::{Pose, Scene};
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

/// Warns if the vehicle stands steeper at the start, with the pose `stance`, than its own obstacle tests let it.
pub(crate) fn start_too_steep(plan: &DrivePlan, stance: &Pose) -> Option<Warning> {
    // Rise over distance of the vehicle's own axes.
    let rise = |axis: DVec3| {
        let along = stance.rotate(axis);
        along.z.abs() / along.truncate().length().max(f64::MIN_POSITIVE)
    };
    let (along, across) = (rise(DVec3::X), rise(DVec3::Y));
    let limits = plan.rules.slopes;
    let across_limit = limits.front.min(limits.rear);
    (along > limits.length || across > across_limit).then(|| {
        let degrees = |slope: f64| libm::atan(slope).to_degrees();
        let sentence = format!(
            "the vehicle starts on too steep ground: {:.0} degrees along its length and {:.0} across, where its own tests \
             allow {:.0} and {:.0}.",
            degrees(along),
            degrees(across),
            degrees(limits.length),
            degrees(across_limit)
        );
        Warning::of_scene(WarningCode::StartTooSteep, sentence)
    })
}

/// Warns if a whole drive found no edge of a stripe: then its maps know nothing.
pub(crate) fn nothing_measured(edge_points: u64) -> Option<Warning> {
    let sentence = "no image gave an edge of a stripe, so no point of the ground was measured.";
    (edge_points == 0).then(|| Warning::of_scene(WarningCode::NothingMeasured, sentence))
}

/// Warns of stripes that were given for images that the drive did not take: those of another drive, or counted otherwise.
pub(crate) fn stripes_left_over(extractor: Option<&dyn StripeExtractor>) -> Option<Warning> {
    let sentence = extractor?.left_over()?;
    Some(Warning::of_scene(WarningCode::StripesLeftOver, sentence))
}

#[cfg(test)]
mod tests {
    use raypencil_rover::Attitude;

    use super::*;
    use crate::common::{FLAT, SHORT, job};

    #[test]
    fn a_start_steeper_than_the_vehicle_may_stand_is_told() {
        let plan = job(FLAT, SHORT).plan;
        let said = |pitch_down: f64, roll_right: f64| {
            let attitude = Attitude { heading: 0.7, pitch_down, roll_right };
            start_too_steep(&plan, &attitude.at(DVec3::ZERO)).map(|warning| warning.to_string())
        };
        // The limits are 0.35 / 1.2 along, 16.3 degrees, and 0.35 across, 19.3 degrees.
        assert_eq!((said(0.28, 0.0), said(0.0, -0.33)), (None, None));
        let along = said(-0.29, 0.0).unwrap();
        assert!(
            along.contains("17 degrees along its length and 0 across") && along.contains("16 and 19"),
            "{along}"
        );
        assert!(said(0.0, 0.96).unwrap().contains("0 degrees along its length and 55 across"));
    }
}
