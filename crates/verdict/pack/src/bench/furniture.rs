//! Plates before the camera and the ordinary beams, so that their rays too meet what a contract of hits and visibility
//! speaks of: faces before the SPP, backs, doubled faces, faces that the camera sees from behind.

use glam::DVec3;
use raypencil_scene::{Beam, Camera, Mounted, Pose, Profile};

use crate::bench::faces::{AddedFaces, Side, Triangle, halves, showing};

/// Depth of the plates before the camera that show their backs, metres.
const BACK_PLATE_DEPTH_M: f64 = 0.6;

/// Range of the plates before a beam, metres: nearer than the ground, which a mast of 1.5 m or more sees at 2 m at least.
const PLATE_RANGE_M: f64 = 1.25;

/// The plates before the camera.
pub(super) fn before_camera(camera: &Mounted<Camera>, faces: &mut AddedFaces) {
    let Mounted { scene_from_sensor: pose, sensor } = camera;
    // The part of the image between two columns, from 0 to 1, at a depth.
    let plate = |[left, right]: [f64; 2], depth: f64, side: Side| {
        let x = |part: f64| {
            (part * f64::from(sensor.width) - sensor.principal_point[0]) * sensor.pixel_pitch[0] * depth
                / sensor.focal_length
        };
        let y = |part: f64| {
            (part * f64::from(sensor.height) - sensor.principal_point[1]) * sensor.pixel_pitch[1] * depth
                / sensor.focal_length
        };
        let at = |column: f64, row: f64| DVec3::new(x(column), y(row), depth);
        halves([at(left, -0.1), at(left, 1.1), at(right, 1.1), at(right, -0.1)])
            .map(|one| showing(side, one, DVec3::ZERO))
    };
    // Before the SPP it is not met, nor does it hide what is behind it.
    faces.extend(pose, plate([0.05, 0.35], sensor.focal_length / 2.0, Side::Front));
    // A back is not met, but hides.
    faces.extend(pose, plate([0.6, 0.7], BACK_PLATE_DEPTH_M, Side::Back));
}

/// The plates before an ordinary beam.
pub(super) fn before_beam(beam: &Mounted<Beam>, camera: &Mounted<Camera>, faces: &mut AddedFaces) {
    let Mounted { scene_from_sensor: pose, sensor } = beam;
    let seen_from = in_sensor(pose, camera.scene_from_sensor.position);
    let before = Plates { beam: sensor, camera: seen_from };
    let plane = sensor.grid_distance / 2.0;
    faces.extend(pose, before.at_depth([0.05, 0.15], plane, Side::Front));
    faces.extend(pose, before.at_depth([0.2, 0.3], PLATE_RANGE_M, Side::Back));
    let doubled = before.facing([0.4, 0.5], [1.0, 1.0]);
    for plate in [doubled, doubled, before.facing([0.55, 0.65], [1.0, -1.0])].into_iter().flatten() {
        faces.extend(pose, plate);
    }
}

/// A point of the scene in a sensor's frame.
fn in_sensor(pose: &Pose, point: DVec3) -> DVec3 {
    Pose { position: DVec3::ZERO, ..pose.inverse() }.rotate(point - pose.position)
}

/// Plates between two columns of a beam, in its frame.
struct Plates<'a> {
    beam: &'a Beam,
    /// The camera's position.
    camera: DVec3,
}

impl Plates<'_> {
    /// Direction of the rays at a part of the fan, from 0 to 1, as x / z.
    fn slope(&self, part: f64) -> f64 {
        self.beam.half_width * (2.0 * part - 1.0) / self.beam.grid_distance
    }

    /// A plate that stands upright to the axis.
    fn at_depth(&self, [left, right]: [f64; 2], depth: f64, side: Side) -> [Triangle; 2] {
        let half = 0.6 * self.beam.thickness;
        let at = |part: f64, y: f64| DVec3::new(self.slope(part) * depth, y, depth);
        halves([at(left, -half), at(left, half), at(right, half), at(right, -half)])
            .map(|one| showing(side, one, DVec3::ZERO))
    }

    /// A plate whose normal is `towards[0]` times the direction to the beam and `towards[1]` times that to the camera. It
    /// shows its front to the beam. `None`: the two directions are so alike, or so opposite, that this is no direction.
    fn facing(&self, [left, right]: [f64; 2], towards: [f64; 2]) -> Option<[Triangle; 2]> {
        let slope = self.slope(0.5 * (left + right));
        let centre = DVec3::new(slope, 0.0, 1.0) * (PLATE_RANGE_M / (1.0 + slope * slope).sqrt());
        let [to_beam, to_camera] = [-centre, self.camera - centre].map(|way| way / way.length());
        let normal = towards[0] * to_beam + towards[1] * to_camera;
        // Tuned: at a hundredth of a radian the plate is seen edge-on.
        let is_clear = normal.length() > 0.01;
        if !is_clear {
            return None;
        }
        // Where the ray (0, y, 0) + u (slope, 0, 1) meets the plate's plane.
        let half = 0.6 * self.beam.thickness;
        let at = |part: f64, y: f64| {
            let (origin, way) = (DVec3::new(0.0, y, 0.0), DVec3::new(self.slope(part), 0.0, 1.0));
            origin + way * (normal.dot(centre - origin) / normal.dot(way))
        };
        let plate = halves([at(left, -half), at(left, half), at(right, half), at(right, -half)]);
        Some(plate.map(|one| showing(Side::Front, one, DVec3::ZERO)))
    }
}

/// Distance of the plate behind the camera, metres.
const BEHIND_M: f64 = 1.0;

/// A beam beside the camera that looks backwards at a plate: its points are behind the camera, where a projection that
/// does not test the depth puts them on the image.
pub(super) fn backward_beam(camera: &Mounted<Camera>, faces: &mut AddedFaces) -> Mounted<Beam> {
    let turned = Pose { position: DVec3::ZERO, rotation: glam::DQuat::from_xyzw(0.0, 1.0, 0.0, 0.0) };
    let scene_from_sensor = camera.scene_from_sensor * turned;
    // Within the image: 2/5 of its narrower half.
    let Camera { width, height, pixel_pitch, focal_length, .. } = camera.sensor;
    let narrow = (f64::from(width) * pixel_pitch[0]).min(f64::from(height) * pixel_pitch[1]);
    let grid_distance = 0.125;
    let half_width = grid_distance * 0.2 * narrow / focal_length;
    let beam = Beam {
        columns: 16,
        rows: 2,
        thickness: 1.0 / 64.0,
        grid_distance,
        half_width,
        max_range: 2.0 * BEHIND_M,
        power: 1.0,
        wavelength: 810e-9,
        profile: Profile::Paper,
    };
    let reach = 2.0 * BEHIND_M * half_width / grid_distance + 0.1;
    let at = |x: f64, y: f64| DVec3::new(x, y, BEHIND_M);
    let plate = halves([at(-reach, -0.1), at(-reach, 0.1), at(reach, 0.1), at(reach, -0.1)]);
    faces.extend(&scene_from_sensor, plate.map(|one| showing(Side::Front, one, DVec3::ZERO)));
    Mounted { scene_from_sensor, sensor: beam }
}
