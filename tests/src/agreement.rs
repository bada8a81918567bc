//! A comparison of two outputs as a test asserts it.

use raypencil::Scene;
use raypencil::judge::{Class, SensorResult, Side, compare};

/// Compares two outputs of a scene.
///
/// # Errors
/// The first five defects, or the sensor whose rays were not all compared.
pub fn agreement(scene: &Scene, a: Side<'_>, b: Side<'_>) -> Result<Vec<SensorResult>, String> {
    let sensors = compare(scene, a, b);
    for sensor in &sensors {
        let classes: u64 = sensor.by_class.iter().sum();
        let (width, height) = scene.size(sensor.sensor).expect("a sensor of this scene");
        let cells = u64::from(width) * u64::from(height);
        if classes != sensor.compared() || sensor.compared() != cells || sensor.not_compared != 0 {
            return Err(format!(
                "{}: of {cells} rays {} compared, {} not; the classes hold {classes}",
                sensor.sensor,
                sensor.compared(),
                sensor.not_compared
            ));
        }
    }
    let defects: u64 = sensors.iter().map(|sensor| sensor.of(Class::Defect)).sum();
    if defects == 0 {
        return Ok(sensors);
    }
    let mut message = format!("{defects} defects\n");
    for defect in sensors.iter().flat_map(|sensor| &sensor.defects).take(5) {
        message += &format!("  {}, {}: {}\n", defect.place, defect.item.quantity, defect.what);
    }
    Err(message)
}
