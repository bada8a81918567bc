//! What may spoil a drive, and what is done about it: beams too coarse for the camera, a threshold that knows nothing of
//! the light, beams that cannot be told apart.

use glam::DVec3;

use raypencil_report::number;
use raypencil_rover::{DrivePlan, ExposureMode, OnVehicle, Rig};
use raypencil_scene::Camera;

/// Below this a stripe is broken, and the run says so.
const FEWEST_PENCILS_PER_PIXEL: f64 = 2.0;

/// A beam has no more columns. (`scene`)
const MOST_COLUMNS: f64 = 1_048_576.0;

/// How many pencils of a beam lie across a pixel of the camera where both look the same way: columns over the pixels that
/// the fan would fill.
fn pencils_per_pixel(camera: &Camera, columns: f64, half_width_over_distance: f64) -> f64 {
    columns / (2.0 * half_width_over_distance * camera.focal_length / camera.pixel_pitch[0])
}

/// Raises the columns of beams that are too coarse for the camera; never lowers them.
pub(crate) fn with_columns(mut rig: Rig, wanted: f64, notes: &mut Vec<String>) -> (Rig, Vec<String>) {
    let camera = rig.camera.sensor;
    let mut warnings = Vec::new();
    for (index, OnVehicle { sensor: beam, .. }) in rig.beams.iter_mut().enumerate() {
        let spread = beam.half_width / beam.grid_distance;
        let needed = wanted / pencils_per_pixel(&camera, 1.0, spread);
        // The cells of a sensor are limited too: 2^26.
        let most = MOST_COLUMNS.min(67_108_864.0 / f64::from(beam.rows));
        let columns = needed.ceil().min(most.floor()).max(1.0) as u32;
        if columns > beam.columns {
            notes.push(format!(
                "beam {index}: {columns} columns in place of {}, {} pencils to a pixel",
                beam.columns,
                number(pencils_per_pixel(&camera, f64::from(columns), spread))
            ));
            beam.columns = columns;
        }
        let reached = pencils_per_pixel(&camera, f64::from(beam.columns), spread);
        if reached < FEWEST_PENCILS_PER_PIXEL {
            warnings.push(format!(
                "beam {index} has {} pencils to a pixel of the camera: below {FEWEST_PENCILS_PER_PIXEL} its stripe \
                 has gaps",
                number(reached)
            ));
        }
    }
    (rig, warnings)
}

/// A warning where beams that are told apart by their order, the lowest in the image first, look down the other way round.
pub(crate) fn beams_out_of_order(plan: &DrivePlan) -> Option<String> {
    let down = |beam: &OnVehicle<_>| -beam.vehicle_from_sensor.rotate(DVec3::Z).z;
    let steeper = plan.rig.beams.windows(2).position(|pair| down(&pair[0]) <= down(&pair[1]))?;
    (plan.exposures == ExposureMode::Together).then(|| {
        format!("beam {steeper} looks down no more than beam {}: together, the lowest stripe is taken for beam 0's", steeper + 1)
    })
}

/// A warning that the default threshold does not account for light or electronics that the file changes. Where a sun is
/// subtracted its noise is not.
pub(crate) fn blind_threshold(ignored: &str) -> String {
    format!("the usual threshold is for the preset alone and knows nothing of {ignored}: give threshold_dn")
}
