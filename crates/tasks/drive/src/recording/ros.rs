//! The house's things as messages of ROS 2. Frames of reference are those of REP-103 and REP-105: x ahead, y to the left,
//! z up; of cameras z ahead, x to the right, y down.

use raypencil_rosbag::{self as ros, Bytes, CameraInfo, Header, MapMetaData, PointCloud2, PointField, Stamp};
use raypencil_rover::{CameraImage, MeasuredPoint};
use raypencil_scene::{Camera, Image, Pose};

use crate::maps::camera_info::camera_matrices;
use crate::maps::occupancy::{Occupancy, OccupancyGrid};
use crate::recording::poses::numbers;

/// Pose of a frame in another.
pub(super) fn transform(parent: &str, child: &str, at: Stamp, pose: &Pose) -> ros::TransformStamped {
    let [x, y, z, qx, qy, qz, qw] = numbers(pose);
    ros::TransformStamped {
        header: Header { stamp: at, frame_id: parent.into() },
        child_frame_id: child.into(),
        transform: ros::Transform {
            translation: ros::Vector3 { x, y, z },
            rotation: ros::Quaternion { x: qx, y: qy, z: qz, w: qw },
        },
    }
}

fn pose(pose: &Pose) -> ros::Pose {
    let [x, y, z, qx, qy, qz, qw] = numbers(pose);
    ros::Pose {
        position: ros::Point { x, y, z },
        orientation: ros::Quaternion { x: qx, y: qy, z: qz, w: qw },
    }
}

/// Pose and mean twist since the frame before, `elapsed` seconds ago, in the vehicle's own axes. `variances` are those of
/// x, y, z and of the rotations about them.
pub(super) fn odometry(
    header: Header,
    child: &str,
    now: &Pose,
    before: Option<&Pose>,
    elapsed: f64,
    variances: [f64; 6],
) -> ros::Odometry {
    let mut covariance = [[0.0; 6]; 6];
    for (place, variance) in variances.into_iter().enumerate() {
        covariance[place][place] = variance;
    }
    let twist = before.map_or(ros::Twist::default(), |before| twist(before, now, elapsed));
    ros::Odometry {
        header,
        child_frame_id: child.into(),
        pose: ros::PoseWithCovariance { pose: pose(now), covariance },
        twist: ros::TwistWithCovariance { twist, ..ros::TwistWithCovariance::default() },
    }
}

/// Constant velocity and rotation that lead from one pose to another, in the axes of the later one.
fn twist(before: &Pose, now: &Pose, elapsed: f64) -> ros::Twist {
    let axes = now.rotation.normalize();
    let linear = axes.inverse() * ((now.position - before.position) / elapsed);
    let turn = before.rotation.normalize().inverse() * axes;
    // Of the two quaternions of a rotation the one by at most half a turn.
    let turn = if turn.w < 0.0 { -turn } else { turn };
    let (sine, cosine) = (turn.xyz().length(), turn.w);
    // The axis of the rotation is the same in both frames. For small angles the angle is twice the sine.
    let rate = if sine > 0.0 { 2.0 * libm::atan2(sine, cosine) / sine / elapsed } else { 0.0 };
    let vector = |v: glam::DVec3| ros::Vector3 { x: v.x, y: v.y, z: v.z };
    ros::Twist { linear: vector(linear), angular: vector(turn.xyz() * rate) }
}

/// Digital numbers as `mono16`, differences as `32SC1`, flux as `64FC1`.
pub(super) fn image(header: Header, image: &CameraImage, is_signed: bool) -> ros::Image {
    let (size, encoding, bytes) = match image {
        CameraImage::Flux(flux) => (size(flux), "64FC1", bytes(flux, |flux| flux.to_le_bytes())),
        CameraImage::Numbers(numbers) if is_signed => {
            (size(numbers), "32SC1", bytes(numbers, |number| number.to_le_bytes()))
        }
        // Without subtraction numbers are of at most 16 bits.
        CameraImage::Numbers(numbers) => {
            let word = |number: i32| (number.clamp(0, i32::from(u16::MAX)) as u16).to_le_bytes();
            (size(numbers), "mono16", bytes(numbers, word))
        }
    };
    let (width, height) = size;
    let step = (bytes.len() / height as usize) as u32;
    ros::Image { header, height, width, encoding: encoding.into(), is_bigendian: 0, step, data: bytes.into() }
}

fn size<T: Copy>(image: &Image<T>) -> (u32, u32) {
    (image.width(), image.height())
}

fn bytes<T: Copy, const N: usize>(image: &Image<T>, of: impl Fn(T) -> [u8; N]) -> Vec<u8> {
    image.cells().iter().flat_map(|&cell| of(cell)).collect()
}

/// Calibration of a camera without distortion.
pub(super) fn camera_info(header: Header, camera: &Camera) -> CameraInfo {
    let (k, p) = camera_matrices(camera);
    CameraInfo {
        header,
        height: camera.height,
        width: camera.width,
        distortion_model: "plumb_bob".into(),
        d: vec![0.0; 5],
        k,
        r: [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0],
        p,
        ..CameraInfo::default()
    }
}

/// Bytes of a point: seven numbers of four bytes.
const POINT_STEP: u32 = 28;

/// Points in the vehicle frame, in single precision, as viewers expect: x, y, z, the standard error of the elevation by
/// the image alone (m), beam, column, and row (pixels from the upper border).
pub(super) fn cloud(header: Header, points: &[MeasuredPoint]) -> PointCloud2 {
    let field = |(index, (name, datatype)): (u32, (&str, u8))| PointField {
        name: name.into(),
        offset: 4 * index,
        datatype,
        count: 1,
    };
    let (real, whole) = (PointField::FLOAT32, PointField::INT32);
    let names = [
        ("x", real),
        ("y", real),
        ("z", real),
        ("standard_error", real),
        ("beam", whole),
        ("column", whole),
        ("row", real),
    ];
    let mut data = Vec::with_capacity(points.len() * POINT_STEP as usize);
    for measured in points {
        let [x, y, z] = measured.point.to_array();
        data.extend(
            [x, y, z, measured.standard_error].map(|real| (real as f32).to_le_bytes()).as_flattened(),
        );
        data.extend((measured.beam as i32).to_le_bytes());
        data.extend((measured.edge.i as i32).to_le_bytes());
        data.extend((measured.edge.row as f32).to_le_bytes());
    }
    PointCloud2 {
        header,
        height: 1,
        width: points.len() as u32,
        fields: (0..).zip(names).map(field).collect(),
        is_bigendian: false,
        point_step: POINT_STEP,
        row_step: data.len() as u32,
        data: data.into(),
        is_dense: true,
    }
}

/// Occupancy by the middle of the front axle.
pub(super) fn occupancy(header: Header, grid: &OccupancyGrid) -> ros::OccupancyGrid {
    let value = |cell: &Occupancy| match cell {
        Occupancy::Free => 0,
        Occupancy::Occupied => 100,
        // -1
        Occupancy::Unknown => 255,
    };
    let [x, y] = grid.origin;
    ros::OccupancyGrid {
        info: MapMetaData {
            map_load_time: header.stamp,
            resolution: grid.resolution as f32,
            width: grid.columns,
            height: grid.rows,
            origin: ros::Pose { position: ros::Point { x, y, z: 0.0 }, ..ros::Pose::default() },
        },
        header,
        data: Bytes(grid.cells.iter().map(value).collect()),
    }
}

#[cfg(test)]
mod tests {
    use glam::{DQuat, DVec3};

    use super::*;

    #[test]
    fn a_twist_leads_from_one_pose_to_the_next() {
        // A quarter of a turn to the left in half a second, and one metre along the new heading.
        let before = Pose { position: DVec3::new(1.0, 2.0, 0.5), rotation: DQuat::from_rotation_z(0.25) };
        let heading = 0.25 + std::f64::consts::FRAC_PI_2;
        let rotation = DQuat::from_rotation_z(heading);
        let now = Pose { position: before.position + rotation * DVec3::X, rotation };
        for now in [now, Pose { rotation: -rotation, ..now }] {
            let ros::Twist { linear, angular } = twist(&before, &now, 0.5);
            let off =
                [linear.x - 2.0, linear.y, linear.z, angular.x, angular.y, angular.z - std::f64::consts::PI];
            assert!(off.iter().all(|off| off.abs() < 1e-12), "{off:?}");
        }
        assert_eq!(twist(&before, &before, 0.5), ros::Twist::default());
    }
}
