//! The ground, the vehicle's way over it and its sensors, in closed form.
//!
//! u and v are metres ahead of the start and to its left, in plan.

use std::sync::Arc;

use glam::DVec3;
use raypencil_scene::{Material, Mesh};

use super::geometry::{Matrix, Pose, Vector, attitude, pitch_down, product, sin_cos};

/// Start, global x and y, metres; heading there, radians.
pub(crate) const START: [f64; 2] = [3.25, -1.75];
pub(crate) const HEADING: f64 = 35.0 * std::f64::consts::PI / 180.0;

/// z = HEIGHT + SLOPE_X x + SLOPE_Y y.
const HEIGHT: f64 = 0.375;
const SLOPE_X: f64 = 7.0 / 64.0;
const SLOPE_Y: f64 = -5.0 / 64.0;

/// Box with a level top that stands in the plane: from and to u, from and to v, height of its top over the plane in the
/// middle, metres.
#[derive(Debug)]
pub(crate) struct Block {
    pub u: [f64; 2],
    pub v: [f64; 2],
    height: f64,
}

/// Rock ahead on the left.
pub(crate) const ROCK: Block = Block { u: [3.6, 4.3], v: [0.5, 1.3], height: 0.62 };

/// Step farther ahead on the right.
pub(crate) const STEP: Block = Block { u: [4.3, 7.5], v: [-3.0, -0.35], height: 0.55 };

const BLOCKS: [Block; 2] = [ROCK, STEP];

/// Waypoints: u and v, metres. The vehicle turns on the spot to the left at the first, and to the right at the second.
const WAYPOINTS: [[f64; 2]; 3] = [[0.6, 0.0], [1.0, 0.15], [1.2, 0.15]];
pub(crate) const SPEED: f64 = 0.3;
const TURN_RATE: f64 = 0.3;
pub(crate) const FRAME_RATE: f64 = 2.0;

/// Camera: columns, rows, pitch of a pixel in x and y, focal length (m), principal point (pixels).
pub(crate) const SIZE: [usize; 2] = [240, 144];
pub(crate) const PITCH: [f64; 2] = [36e-6, 40e-6];
pub(crate) const FOCAL: f64 = 8e-3;
pub(crate) const PRINCIPAL: [f64; 2] = [118.5, 70.25];

/// Thickness of the sheets, metres.
pub(crate) const THICKNESS: f64 = 6e-3;

/// The first and the last turn of a vertical scan, radians downwards, and its number of steps.
pub(crate) const SCAN: ([f64; 2], u32) =
    ([-8.0 * std::f64::consts::PI / 180.0, 24.0 * std::f64::consts::PI / 180.0], 17);

/// An obstacle map after so many frames. The last one is made during a turn, and the drive ends with another heading.
pub(crate) const OBSTACLES_EVERY: u64 = 5;

/// The scene, with further keys of its drive.
pub(crate) fn scene_text(drive: &str) -> String {
    format!(
        "version = 1\n\
        [vehicle]\nposition_m = [3.25, -1.75, 0]\nheading_deg = 35\n\
        [camera]\nposition_m = [0.4, 0.1, 0.8]\npitch_down_deg = 18\nyaw_left_deg = 3\nroll_right_deg = -2\n\
        width_px = 240\nheight_px = 144\npixel_pitch_um = [36, 40]\nfocal_length_mm = 8\n\
        principal_point_px = [118.5, 70.25]\n\
        [[beam]]\nposition_m = [0.2, -0.1, 1.9]\npitch_down_deg = 33\nrows = 3\nthickness_mm = 6\npower_w = 0.2\n\
        [[beam]]\nposition_m = [0.25, 0.05, 2]\npitch_down_deg = 24\nyaw_left_deg = 2\nroll_right_deg = 1\nrows = 3\n\
        thickness_mm = 6\npower_w = 0.2\n\
        [drive]\nwaypoints_m = [[0.6, 0], [1, 0.15], [1.2, 0.15]]\nframes_per_s = 2\nspeed_m_per_s = 0.3\n\
        turn_deg_per_s = 17.188733853924695\nobstacles_every_frames = 5\nrules = {{ start = \"circle\" }}\n{drive}\n"
    )
}

/// Sensor on the vehicle: position, then yaw, pitch and roll in degrees. Its z is ahead, x to the right, y down.
fn mounted(position: Vector, degrees: [f64; 3]) -> Pose {
    const FORWARD: Matrix = [[0.0, 0.0, 1.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0]];
    Pose { position, rotation: product(&attitude(degrees.map(f64::to_radians)), &FORWARD) }
}

/// `vehicle_from_camera` and `vehicle_from_beam` of both beams.
pub(crate) fn sensors() -> [Pose; 3] {
    [
        mounted([0.4, 0.1, 0.8], [3.0, 18.0, -2.0]),
        mounted([0.2, -0.1, 1.9], [0.0, 33.0, 0.0]),
        mounted([0.25, 0.05, 2.0], [2.0, 24.0, 1.0]),
    ]
}

/// A sensor in a position of a scan: turned about its own origin and an axis parallel to the vehicle's y. Step -1: as it is
/// mounted.
pub(crate) fn panned(sensor: &Pose, step: i64) -> Pose {
    if step < 0 {
        return *sensor;
    }
    let ([from, to], steps) = SCAN;
    let angle = from + (to - from) * step as f64 / f64::from(steps - 1);
    Pose { rotation: product(&pitch_down(angle), &sensor.rotation), ..*sensor }
}

/// u, v and z of a global point.
pub(crate) fn ahead_and_left([x, y, z]: Vector) -> Vector {
    let (sin, cos) = sin_cos(HEADING);
    let (x, y) = (x - START[0], y - START[1]);
    [x * cos + y * sin, y * cos - x * sin, z]
}

fn global([u, v]: [f64; 2]) -> [f64; 2] {
    let (sin, cos) = sin_cos(HEADING);
    [START[0] + u * cos - v * sin, START[1] + u * sin + v * cos]
}

fn plane(x: f64, y: f64) -> f64 {
    HEIGHT + SLOPE_X * x + SLOPE_Y * y
}

impl Block {
    pub(crate) fn top(&self) -> f64 {
        let [x, y] = global([0.5 * (self.u[0] + self.u[1]), 0.5 * (self.v[0] + self.v[1])]);
        plane(x, y) + self.height
    }

    /// Global x and y of the corners, in turn, counter-clockwise from above.
    pub(crate) fn corners(&self) -> [[f64; 2]; 4] {
        let ([near, far], [right, left]) = (self.u, self.v);
        [[near, right], [far, right], [far, left], [near, left]].map(global)
    }

    /// Distance in plan from a point (u, v); 0 inside.
    pub(crate) fn distance_in_plan(&self, [u, v]: [f64; 2]) -> f64 {
        let beyond = |at: f64, [from, to]: [f64; 2]| (from - at).max(at - to).max(0.0);
        libm::hypot(beyond(u, self.u), beyond(v, self.v))
    }

    /// Distance from the surface of the block, as if it had no bottom.
    fn distance(&self, [u, v, z]: Vector) -> f64 {
        let aside = self.distance_in_plan([u, v]);
        let above = z - self.top();
        if aside > 0.0 || above > 0.0 {
            return libm::hypot(aside, above.max(0.0));
        }
        let walls = [u - self.u[0], self.u[1] - u, v - self.v[0], self.v[1] - v];
        walls.into_iter().fold(-above, f64::min)
    }

    /// Distance along a ray in u, v, z at which it enters the block.
    fn entered(&self, from: Vector, direction: Vector) -> Option<f64> {
        let sides = [self.u, self.v, [-1e3, self.top()]];
        let (mut enter, mut leave) = (0.0_f64, f64::INFINITY);
        for (axis, [low, high]) in sides.into_iter().enumerate() {
            let ends = [low, high].map(|side| (side - from[axis]) / direction[axis]);
            enter = enter.max(ends[0].min(ends[1]));
            leave = leave.min(ends[0].max(ends[1]));
        }
        (enter > 0.0 && enter < leave).then_some(enter)
    }
}

/// Height of the ground, global z.
pub(crate) fn height(x: f64, y: f64) -> f64 {
    let [u, v, _] = ahead_and_left([x, y, 0.0]);
    let tops = BLOCKS.iter().filter(|block| block.distance_in_plan([u, v]) == 0.0).map(Block::top);
    tops.fold(plane(x, y), f64::max)
}

/// Lowest and highest ground within a distance in plan.
pub(crate) fn heights_within([x, y]: [f64; 2], distance: f64) -> [f64; 2] {
    let [u, v, _] = ahead_and_left([x, y, 0.0]);
    let rise = distance * libm::hypot(SLOPE_X, SLOPE_Y);
    let (mut low, mut high) = (plane(x, y) - rise, plane(x, y) + rise);
    for block in BLOCKS.iter().filter(|block| block.distance_in_plan([u, v]) <= distance) {
        high = high.max(block.top());
        let is_inside = block.u[0] + distance < u
            && u < block.u[1] - distance
            && block.v[0] + distance < v
            && v < block.v[1] - distance;
        if is_inside {
            low = block.top();
        }
    }
    [low, high]
}

/// Distance of a global point from the nearest surface of the ground, metres.
pub(crate) fn distance(point: Vector) -> f64 {
    let upright = (1.0 + SLOPE_X * SLOPE_X + SLOPE_Y * SLOPE_Y).sqrt();
    let from_plane = (point[2] - plane(point[0], point[1])).abs() / upright;
    let at = ahead_and_left(point);
    BLOCKS.iter().map(|block| block.distance(at)).fold(from_plane, f64::min)
}

/// Where a ray first meets the ground: the distance in units of `direction`, and whether it is the plane.
pub(crate) fn hit(from: Vector, direction: Vector) -> Option<(f64, bool)> {
    let fall = SLOPE_X * direction[0] + SLOPE_Y * direction[1] - direction[2];
    let to_plane = (from[2] - plane(from[0], from[1])) / fall;
    let mut nearest = (to_plane > 0.0).then_some((to_plane, true));
    let far = ahead_and_left(std::array::from_fn(|axis| from[axis] + direction[axis]));
    let from = ahead_and_left(from);
    let turned = std::array::from_fn(|axis| far[axis] - from[axis]);
    for block in &BLOCKS {
        if let Some(to_block) = block.entered(from, turned)
            && nearest.is_none_or(|(to, _)| to_block < to)
        {
            nearest = Some((to_block, false));
        }
    }
    nearest
}

/// Parts of the way: its duration in seconds, then the direction (from u to v, radians) and its length, or the turn.
fn parts() -> Vec<(f64, f64, f64, f64)> {
    let (mut at, mut direction, mut parts) = ([0.0, 0.0], 0.0, Vec::new());
    for [u, v] in WAYPOINTS {
        let towards = libm::atan2(v - at[1], u - at[0]);
        let (turn, length) = (towards - direction, libm::hypot(u - at[0], v - at[1]));
        parts.push((turn.abs() / TURN_RATE, direction, 0.0, turn));
        parts.push((length / SPEED, towards, length, 0.0));
        (at, direction) = ([u, v], towards);
    }
    parts
}

/// Way driven, global x and y, and heading of a frame.
pub(crate) fn route(frame: u64) -> (f64, [f64; 2], f64) {
    let mut time = frame as f64 / FRAME_RATE;
    let (mut driven, mut at, mut heading) = (0.0, [0.0, 0.0], HEADING);
    for (duration, direction, length, turn) in parts() {
        // 1 at the end of a part, or if there is none.
        let share = if duration > 0.0 { (time / duration).clamp(0.0, 1.0) } else { 1.0 };
        let (sin, cos) = sin_cos(direction);
        driven += share * length;
        at = [at[0] + share * length * cos, at[1] + share * length * sin];
        heading += share * turn;
        time -= duration;
        if time < 0.0 {
            break;
        }
    }
    (driven, global(at), heading)
}

/// Number of frames: the last one is the first at or after the end of the way.
pub(crate) fn frames() -> u64 {
    (parts().iter().map(|part| part.0).sum::<f64>() * FRAME_RATE).ceil() as u64 + 1
}

/// How the default vehicle stands on the plane: heading, pitch and roll, and the height of its origin above the plane.
///
/// The plane rises by m along the heading and by n to its left: tan pitch = -m and sin roll = n / sqrt(1 + m^2 + n^2). A
/// wheel is an upright disc of radius R and width w: its hub is |n| w / 2 + R sqrt(1 + m^2) above the plane, and the
/// origin is R along the normal below the hubs' plane.
pub(crate) fn stance(heading: f64) -> ([f64; 3], f64) {
    let (sin, cos) = sin_cos(heading);
    let (m, n) = (SLOPE_X * cos + SLOPE_Y * sin, SLOPE_Y * cos - SLOPE_X * sin);
    let upright = (1.0 + m * m + n * n).sqrt();
    let above = 0.125 * n.abs() + 0.35 * ((1.0 + m * m).sqrt() - upright);
    ([heading, -libm::atan(m), libm::asin(n / upright)], above)
}

/// True pose in a frame, `global_from_vehicle`.
pub(crate) fn true_pose(frame: u64) -> Pose {
    let (_, [x, y], heading) = route(frame);
    let (angles, above) = stance(heading);
    Pose { position: [x, y, plane(x, y) + above], rotation: attitude(angles) }
}

/// The same ground as triangles.
pub(crate) fn mesh() -> Arc<Mesh> {
    let (mut vertices, mut faces) = (Vec::new(), Vec::new());
    let mut quad = |corners: [Vector; 4]| {
        let first = vertices.len() as u32;
        vertices.extend(corners.map(DVec3::from_array));
        faces.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
    };
    quad([[-13.0, -18.0], [19.0, -18.0], [19.0, 14.0], [-13.0, 14.0]].map(|[x, y]| [x, y, plane(x, y)]));
    for block in &BLOCKS {
        let (corners, top) = (block.corners(), block.top());
        quad(corners.map(|[x, y]| [x, y, top]));
        for side in 0..4 {
            let [[ax, ay], [bx, by]] = [corners[side], corners[(side + 1) % 4]];
            // Seen from outside, counter-clockwise; the foot is below the plane.
            quad([[ax, ay, top - 2.0], [bx, by, top - 2.0], [bx, by, top], [ax, ay, top]]);
        }
    }
    let face_materials = vec![0; faces.len()];
    let materials = vec![Material { name: "sand".into(), reflectivity: 0.25 }];
    Arc::new(Mesh::from_global(&vertices, faces, face_materials, materials).expect("a mesh"))
}
