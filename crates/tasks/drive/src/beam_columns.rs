//! Columns of the beams: as many pencils as the camera's pixels need.

use raypencil_report::number;
use raypencil_rover::{OnVehicle, Rig};
use raypencil_scene::{Camera, SensorId};
use raypencil_survey::{Warning, WarningCode};

/// Pencils per pixel below which a warning is given: the stripe has gaps.
const MIN_PENCILS_PER_PIXEL: f64 = 2.0;

/// Upper limit of `Beam::columns`, enforced by `scene`.
const MAX_COLUMNS: f64 = 1_048_576.0;

/// Upper limit of columns times rows of a beam, 2^26, enforced by `scene`.
const MAX_CELLS: f64 = 67_108_864.0;

/// Pencils of a beam per pixel of the camera, where both look in the same direction: the columns, divided by the number
/// of pixels that the fan would fill.
fn pencils_per_pixel(camera: &Camera, columns: f64, half_width_over_distance: f64) -> f64 {
    columns / (2.0 * half_width_over_distance * camera.focal_length / camera.pixel_pitch[0])
}

/// Raises the columns of each beam to `wanted` pencils per pixel, to an even number; never lowers them. A note tells each change.
/// Returns the rig and the warnings about beams that stay too coarse.
///
/// An odd number has a middle pencil. Of a beam above the camera it lands exactly between two pixels of an even image, where two
/// correct renderers may choose one each.
pub(crate) fn with_columns(mut rig: Rig, wanted: f64, notes: &mut Vec<String>) -> (Rig, Vec<Warning>) {
    let camera = rig.camera.sensor;
    let mut warnings = Vec::new();
    for (index, OnVehicle { sensor: beam, .. }) in rig.beams.iter_mut().enumerate() {
        let spread = beam.half_width / beam.grid_distance;
        let needed = wanted / pencils_per_pixel(&camera, 1.0, spread);
        let max_columns = MAX_COLUMNS.min(MAX_CELLS / f64::from(beam.rows));
        let columns = (2.0 * (0.5 * needed).ceil()).min(2.0 * (0.5 * max_columns).floor()).max(1.0) as u32;
        if columns > beam.columns {
            notes.push(format!(
                "beam {index}: {columns} columns in place of {}, {} pencils per pixel",
                beam.columns,
                number(pencils_per_pixel(&camera, f64::from(columns), spread))
            ));
            beam.columns = columns;
        }
        let reached = pencils_per_pixel(&camera, f64::from(beam.columns), spread);
        if reached < MIN_PENCILS_PER_PIXEL {
            let sentence = format!(
                "{} pencils per pixel of the camera: below {MIN_PENCILS_PER_PIXEL} its stripe has gaps.",
                number(reached)
            );
            warnings.push(Warning::of_sensor(WarningCode::StripeHasGaps, SensorId::Beam(index), sentence));
        }
    }
    (rig, warnings)
}
