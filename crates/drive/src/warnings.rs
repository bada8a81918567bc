//! Warnings about a drive's settings: beams that the camera cannot tell apart, a threshold that does not fit the light.

use glam::DVec3;
use raypencil_rover::{OnVehicle, Rig};
use raypencil_scene_io::{DetectionWord, DriveSettings, ElectronicsSettings};

/// Warns if beams are lit together and a beam is not steeper than the next one. Stripes of one image are told apart by
/// their order: the lowest is taken for that of beam 0, the steepest.
pub(crate) fn beams_out_of_order(settings: &DriveSettings, rig: &Rig) -> Option<String> {
    let down = |beam: &OnVehicle<_>| -beam.vehicle_from_sensor.rotate(DVec3::Z).z;
    let steeper = rig.beams.windows(2).position(|pair| down(&pair[0]) <= down(&pair[1]))?;
    (settings.lit_together == Some(true)).then(|| {
        format!(
            "beam {steeper} is not steeper than beam {}: with both in one image, the lowest stripe counts as beam 0's",
            steeper + 1
        )
    })
}

/// Warns if the default threshold is used although the file changes the light or the electronics.
///
/// With an unlit image subtracted, the sun's light is gone but its noise is not: the warning is given there, too.
pub(crate) fn blind_threshold(settings: &DriveSettings) -> Option<String> {
    let changed = if settings.sun.is_some() {
        "a sun behind the stripes"
    } else if settings.electronics != ElectronicsSettings::default() {
        "other electronics"
    } else {
        return None;
    };
    let usual = settings.threshold.is_none() && settings.detection != Some(DetectionWord::Otsu);
    usual.then(|| {
        format!("the default threshold is for the preset alone, without {changed}: give threshold_dn")
    })
}
