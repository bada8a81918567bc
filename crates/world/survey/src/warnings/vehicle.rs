//! Rules on the vehicle and the ground at its place.

use raypencil_scene::{Mesh, Pose};
use raypencil_terrain::height_at;

use crate::warning::{Warning, WarningCode};

/// Largest distance of the vehicle's origin from the ground, metres, tuned: the radius of the default rover's wheel.
/// Above it no wheel reaches the ground, and below it the hubs are in the ground. Rocks and slopes under a vehicle that
/// stands on its wheels change the distance by less.
const MAX_GROUND_DISTANCE_M: f64 = 0.35;

/// Height of the vehicle's origin above the ground at its place, metres. `None` if there is no ground.
pub(crate) fn height_above_ground(mesh: &Mesh, vehicle: &Pose) -> Option<f64> {
    let place = vehicle.position;
    height_at(mesh, place.x, place.y).map(|ground| place.z - ground)
}

/// Warns if the vehicle floats. `vehicle` is its pose in the global frame.
pub fn vehicle_above_ground(mesh: &Mesh, vehicle: &Pose) -> Option<Warning> {
    height_above_ground(mesh, vehicle).and_then(too_high)
}

/// Warns if the vehicle is buried. `vehicle` is its pose in the global frame.
pub fn vehicle_below_ground(mesh: &Mesh, vehicle: &Pose) -> Option<Warning> {
    height_above_ground(mesh, vehicle).and_then(too_low)
}

pub(crate) fn too_high(height: f64) -> Option<Warning> {
    (height > MAX_GROUND_DISTANCE_M).then(|| {
        let sentence = format!("the vehicle is {height:.2} m above the ground at its place.");
        Warning::of_scene(WarningCode::VehicleAboveGround, sentence)
    })
}

pub(crate) fn too_low(height: f64) -> Option<Warning> {
    (height < -MAX_GROUND_DISTANCE_M).then(|| {
        let sentence = format!("the vehicle is {:.2} m below the ground at its place.", -height);
        Warning::of_scene(WarningCode::VehicleBelowGround, sentence)
    })
}
