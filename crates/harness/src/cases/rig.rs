//! Cameras, beams and their poses: the default rig, and plain sensors for derived scenes.

use glam::DVec3;
use raypencil_scene::{Beam, Camera, Lens, Mounted, Pose, Profile};

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
pub fn pitched<S>(position: DVec3, pitch_down: f64, sensor: S) -> Mounted<S> {
    let vehicle_from_pitched = Pose { position, ..Pose::from_axis_angle(DVec3::Y, pitch_down) };
    Mounted { scene_from_sensor: vehicle_from_pitched * Pose::VEHICLE_FROM_FORWARD_SENSOR, sensor }
}

/// The default rig's camera and beams, all rasters made `scale` times coarser, on a vehicle at `position`
/// that is turned to `heading` radians.
pub fn default_rig(scale: u32, position: DVec3, heading: f64) -> (Mounted<Camera>, Vec<Mounted<Beam>>) {
    let scene_from_vehicle = Pose { position, ..Pose::from_axis_angle(DVec3::Z, heading) };
    let mount = |height: f64, pitch_deg: f64| {
        let vehicle = pitched(DVec3::new(0.3, 0.0, height), pitch_deg.to_radians(), ());
        scene_from_vehicle * vehicle.scene_from_sensor
    };
    let size = 1024 / scale;
    let camera =
        Camera { aperture: 2e-3, max_range: 20.0, ..camera(size, size, 9e-6 * f64::from(scale), 8e-3) };
    let beam = Beam {
        columns: size,
        rows: (16 / scale).max(2),
        thickness: 5e-3,
        grid_distance: 0.1,
        half_width: Beam::half_width_of(0.1, 60.0_f64.to_radians()),
        max_range: 20.0,
        power: 1.0,
        wavelength: 810e-9,
        profile: Profile::Paper,
    };
    let beams = [(1.8, 31.0), (2.0, 22.0)]
        .map(|(height, pitch_deg)| Mounted { scene_from_sensor: mount(height, pitch_deg), sensor: beam });
    (Mounted { scene_from_sensor: mount(1.5, 20.0), sensor: camera }, beams.to_vec())
}
