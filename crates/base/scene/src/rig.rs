//! The default rig, and plain sensors on a level vehicle. Definitions alone: a scene file without sensors means these.

use crate::{Beam, Camera, Lens, Mounted, Pose, Profile};
use glam::DVec3;

/// A camera of dyadic numbers: its principal point is the middle of the image.
pub fn camera(width: u32, height: u32, pitch: f64, focal_length: f64) -> Camera {
    Camera {
        width,
        height,
        pixel_pitch: [pitch, pitch],
        focal_length,
        principal_point: [0.5 * f64::from(width), 0.5 * f64::from(height)],
        aperture: 2e-3,
        lens: Lens::CLEAR,
        max_range: 1e3,
    }
}

/// A beam whose grid cells are `cell[0]` metres wide on the grid plane and whose rows are `cell[1]` metres
/// apart: exactly so if the numbers are dyadic.
pub fn beam(columns: u32, rows: u32, cell: [f64; 2], grid_distance: f64) -> Beam {
    Beam {
        columns,
        rows,
        thickness: f64::from(rows) * cell[1],
        grid_distance,
        half_width: 0.5 * f64::from(columns) * cell[0],
        max_range: 1e3,
        power: 1.0,
        wavelength: 810e-9,
        profile: Profile::Paper,
    }
}

/// A sensor on a level vehicle at the scene's origin: at `position` metres, looking along x, turned down
/// by `pitch_down` radians. (Global frame and vehicle: x forward, y left, z up.)
///
/// ```
/// use glam::DVec3;
/// use raypencil_scene::rig;
///
/// // Turned down by 90 degrees, the normal axis (z of the sensor) points to the ground.
/// let mounted = rig::pitched(DVec3::new(0.0, 0.0, 2.0), std::f64::consts::FRAC_PI_2, ());
/// let down = mounted.scene_from_sensor.rotate(DVec3::Z);
/// assert!((down - DVec3::NEG_Z).length() < 1e-15);
/// ```
pub fn pitched<S>(position: DVec3, pitch_down: f64, sensor: S) -> Mounted<S> {
    let vehicle_from_pitched = Pose { position, ..Pose::from_axis_angle(DVec3::Y, pitch_down) };
    Mounted { scene_from_sensor: vehicle_from_pitched * Pose::VEHICLE_FROM_FORWARD_SENSOR, sensor }
}

/// Place and pitch of a sensor of the default rig in the vehicle frame, looking ahead.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DefaultMount {
    /// Position in the vehicle frame (x forward, y left, z up), metres.
    pub position: DVec3,
    /// Angle by which the sensor looks down from the horizon, degrees.
    pub pitch_down_deg: f64,
}

/// Mount of the default camera.
///
/// CHOICE: the paper prints no rig. This one sees stripes about 2.5 and 5 m ahead of a rover of a metre or
/// two, well inside the camera's view, with both beams above the camera as in figure 1.
pub const DEFAULT_CAMERA_MOUNT: DefaultMount =
    DefaultMount { position: DVec3::new(0.3, 0.0, 1.5), pitch_down_deg: 20.0 };

/// Mounts of the two default beams. The second is higher and flatter.
pub const DEFAULT_BEAM_MOUNTS: [DefaultMount; 2] = [
    DefaultMount { position: DVec3::new(0.3, 0.0, 1.8), pitch_down_deg: 31.0 },
    DefaultMount { position: DVec3::new(0.3, 0.0, 2.0), pitch_down_deg: 22.0 },
];

/// Angle of the default fan, degrees.
pub const DEFAULT_FAN_DEG: f64 = 60.0;

/// The default camera: 1024 x 1024 pixels of 9 um behind a lens of 8 mm.
pub fn default_camera() -> Camera {
    Camera { max_range: 20.0, ..camera(1024, 1024, 9e-6, 8e-3) }
}

/// The default beam: 1024 columns and 16 rows over a fan of 60 degrees, 5 mm thick, 1 W at 810 nm.
pub fn default_beam() -> Beam {
    let grid_distance = 0.1;
    Beam {
        columns: 1024,
        rows: 16,
        thickness: 5e-3,
        grid_distance,
        half_width: Beam::half_width_of(grid_distance, DEFAULT_FAN_DEG.to_radians()),
        max_range: 20.0,
        power: 1.0,
        wavelength: 810e-9,
        profile: Profile::Paper,
    }
}

/// The default rig's camera and beams, all rasters made `scale` times coarser (beams keep 2 rows at least), on a
/// vehicle at `position` metres that is turned to `heading` radians.
pub fn default_rig(scale: u32, position: DVec3, heading: f64) -> (Mounted<Camera>, Vec<Mounted<Beam>>) {
    let scene_from_vehicle = Pose { position, ..Pose::from_axis_angle(DVec3::Z, heading) };
    let mounted = |mount: DefaultMount| {
        let vehicle = pitched(mount.position, mount.pitch_down_deg.to_radians(), ());
        scene_from_vehicle * vehicle.scene_from_sensor
    };
    let size = 1024 / scale;
    let camera = Camera { max_range: 20.0, ..camera(size, size, 9e-6 * f64::from(scale), 8e-3) };
    let beam = Beam { columns: size, rows: (16 / scale).max(2), ..default_beam() };
    let beams = DEFAULT_BEAM_MOUNTS.map(|mount| Mounted { scene_from_sensor: mounted(mount), sensor: beam });
    (Mounted { scene_from_sensor: mounted(DEFAULT_CAMERA_MOUNT), sensor: camera }, beams.to_vec())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_default_rig_looks_down_ahead_of_a_turned_vehicle() {
        // At (1, 2, 3), turned to the left by 90 degrees: the vehicle's x axis is the global y axis. All sensors are
        // 0.3 m ahead of its origin; their heights and pitches are those of the mounts.
        let (camera, beams) = default_rig(64, DVec3::new(1.0, 2.0, 3.0), std::f64::consts::FRAC_PI_2);
        let poses = [camera.scene_from_sensor, beams[0].scene_from_sensor, beams[1].scene_from_sensor];
        for (pose, (height, down_deg)) in poses.into_iter().zip([(1.5, 20.0_f64), (1.8, 31.0), (2.0, 22.0)]) {
            assert!((pose.position - DVec3::new(1.0, 2.3, 3.0 + height)).length() < 1e-15, "{pose:?}");
            let (sin, cos) = libm::sincos(down_deg.to_radians());
            assert!((pose.rotate(DVec3::Z) - DVec3::new(0.0, cos, -sin)).length() < 1e-15, "{pose:?}");
            // The sensor's x axis points to the right, along the global x axis.
            assert!((pose.rotate(DVec3::X) - DVec3::X).length() < 1e-15, "{pose:?}");
        }
    }
}
