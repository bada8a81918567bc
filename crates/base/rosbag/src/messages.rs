//! Messages of ROS 2, with the fields and names of `common_interfaces`. Lengths are in metres, angles in radians.
//! (ROS 2 common_interfaces; REP-103 for units and axes)

use serde::{Serialize, Serializer};

/// A message that can stand in a bag by itself. The order of its fields is that of its definition.
pub trait Message: Serialize {
    /// Package and name: `sensor_msgs/msg/Image`.
    const TYPE: &'static str;
}

/// Bytes, of `uint8[]` or `int8[]`. They are written at once, where a list would go byte by byte.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Bytes(pub Vec<u8>);

impl From<Vec<u8>> for Bytes {
    fn from(bytes: Vec<u8>) -> Self {
        Self(bytes)
    }
}

impl Serialize for Bytes {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_bytes(&self.0)
    }
}

/// `builtin_interfaces/msg/Time`: time since the clock's beginning.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord, Serialize)]
pub struct Stamp {
    /// Whole seconds.
    pub sec: i32,
    /// The rest, below 10^9 nanoseconds.
    pub nanosec: u32,
}

impl Stamp {
    /// Latest time that a stamp can hold, nanoseconds.
    const LATEST: u64 = i32::MAX as u64 * 1_000_000_000 + 999_999_999;

    /// Stamp of a number of nanoseconds; the latest stamp if it is later.
    pub fn from_nanoseconds(nanoseconds: u64) -> Self {
        let nanoseconds = nanoseconds.min(Self::LATEST);
        // Both fit: the seconds by the bound above, the rest by the remainder.
        Self { sec: (nanoseconds / 1_000_000_000) as i32, nanosec: (nanoseconds % 1_000_000_000) as u32 }
    }

    /// Nanoseconds; 0 for a stamp before the clock's beginning.
    pub fn nanoseconds(self) -> u64 {
        u64::try_from(self.sec).unwrap_or(0) * 1_000_000_000 + u64::from(self.nanosec)
    }
}

/// `rosgraph_msgs/msg/Clock`: the time that a player tells, for programs that follow simulated time.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize)]
pub struct Clock {
    /// The time now.
    pub clock: Stamp,
}

impl Message for Clock {
    const TYPE: &'static str = "rosgraph_msgs/msg/Clock";
}

/// `std_msgs/msg/Header`.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize)]
pub struct Header {
    /// Time of what the message says.
    pub stamp: Stamp,
    /// Frame of reference of its coordinates.
    pub frame_id: String,
}

/// `sensor_msgs/msg/Image`.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize)]
pub struct Image {
    /// Time of the exposure, and frame of the camera: z ahead, x to the right, y down.
    pub header: Header,
    /// Rows.
    pub height: u32,
    /// Columns.
    pub width: u32,
    /// Type of a pixel: `mono16`, `32SC1`, `64FC1`.
    pub encoding: String,
    /// 0: little endian.
    pub is_bigendian: u8,
    /// Bytes of a row.
    pub step: u32,
    /// Row by row from the top, `height * step` bytes.
    pub data: Bytes,
}

impl Message for Image {
    const TYPE: &'static str = "sensor_msgs/msg/Image";
}

/// `sensor_msgs/msg/RegionOfInterest`; all zeros: the whole image.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize)]
pub struct RegionOfInterest {
    /// First column.
    pub x_offset: u32,
    /// First row.
    pub y_offset: u32,
    /// Rows.
    pub height: u32,
    /// Columns.
    pub width: u32,
    /// Whether a rectified region is wanted.
    pub do_rectify: bool,
}

/// `sensor_msgs/msg/CameraInfo`.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct CameraInfo {
    /// Time and frame of the image that it belongs to.
    pub header: Header,
    /// Rows.
    pub height: u32,
    /// Columns.
    pub width: u32,
    /// `plumb_bob` for a camera without distortion too.
    pub distortion_model: String,
    /// Coefficients of the distortion.
    pub d: Vec<f64>,
    /// Matrix of the camera, row by row, pixels. The middle of pixel (0, 0) is at (0, 0).
    pub k: [f64; 9],
    /// Rectification.
    pub r: [f64; 9],
    /// Projection, three rows of four, pixels.
    pub p: [f64; 12],
    /// Columns that make a pixel; 0 means 1.
    pub binning_x: u32,
    /// Rows that make a pixel; 0 means 1.
    pub binning_y: u32,
    /// Part of the sensor.
    pub roi: RegionOfInterest,
}

impl Message for CameraInfo {
    const TYPE: &'static str = "sensor_msgs/msg/CameraInfo";
}

/// `sensor_msgs/msg/PointField`.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize)]
pub struct PointField {
    /// Its name: `x`.
    pub name: String,
    /// Its place in a point, bytes.
    pub offset: u32,
    /// Type of number: [`PointField::INT32`] and so on.
    pub datatype: u8,
    /// Numbers in the field.
    pub count: u32,
}

impl PointField {
    /// Signed whole number of a byte.
    pub const INT8: u8 = 1;
    /// Whole number of a byte.
    pub const UINT8: u8 = 2;
    /// Signed whole number of two bytes.
    pub const INT16: u8 = 3;
    /// Whole number of two bytes.
    pub const UINT16: u8 = 4;
    /// Signed whole number of four bytes.
    pub const INT32: u8 = 5;
    /// Whole number of four bytes.
    pub const UINT32: u8 = 6;
    /// Real number of four bytes.
    pub const FLOAT32: u8 = 7;
    /// Real number of eight bytes.
    pub const FLOAT64: u8 = 8;
}

/// `sensor_msgs/msg/PointCloud2`.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize)]
pub struct PointCloud2 {
    /// Time and frame of the points.
    pub header: Header,
    /// 1 for a cloud without order.
    pub height: u32,
    /// Number of points.
    pub width: u32,
    /// What a point consists of.
    pub fields: Vec<PointField>,
    /// Whether the numbers are big endian.
    pub is_bigendian: bool,
    /// Bytes of a point.
    pub point_step: u32,
    /// Bytes of all.
    pub row_step: u32,
    /// Point by point.
    pub data: Bytes,
    /// Whether no number is NaN or infinite.
    pub is_dense: bool,
}

impl Message for PointCloud2 {
    const TYPE: &'static str = "sensor_msgs/msg/PointCloud2";
}

/// `geometry_msgs/msg/Vector3`.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct Vector3 {
    /// Ahead.
    pub x: f64,
    /// To the left.
    pub y: f64,
    /// Up.
    pub z: f64,
}

/// `geometry_msgs/msg/Point`: as ROS has it, a type of its own beside [`Vector3`].
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct Point {
    /// Metres along x.
    pub x: f64,
    /// Metres along y.
    pub y: f64,
    /// Metres along z.
    pub z: f64,
}

/// `geometry_msgs/msg/Quaternion`: unit quaternion of a rotation.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Quaternion {
    /// i.
    pub x: f64,
    /// j.
    pub y: f64,
    /// k.
    pub z: f64,
    /// Real part.
    pub w: f64,
}

/// No rotation.
impl Default for Quaternion {
    fn default() -> Self {
        Self { x: 0.0, y: 0.0, z: 0.0, w: 1.0 }
    }
}

/// `geometry_msgs/msg/Pose`.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct Pose {
    /// Place of the origin, metres.
    pub position: Point,
    /// Rotation.
    pub orientation: Quaternion,
}

/// `geometry_msgs/msg/Transform`: turns coordinates of the child frame into those of its parent.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct Transform {
    /// Place of the child's origin, metres.
    pub translation: Vector3,
    /// Rotation.
    pub rotation: Quaternion,
}

/// `geometry_msgs/msg/TransformStamped`.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct TransformStamped {
    /// Time, and parent frame.
    pub header: Header,
    /// Child frame.
    pub child_frame_id: String,
    /// Its pose in the parent frame.
    pub transform: Transform,
}

/// `tf2_msgs/msg/TFMessage`.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct TfMessage {
    /// Any number of transforms.
    pub transforms: Vec<TransformStamped>,
}

impl Message for TfMessage {
    const TYPE: &'static str = "tf2_msgs/msg/TFMessage";
}

/// Covariance of x, y, z and of the rotations about them: 6 x 6, row by row.
type Covariance = [[f64; 6]; 6];

/// `geometry_msgs/msg/PoseWithCovariance`.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct PoseWithCovariance {
    /// The pose.
    pub pose: Pose,
    /// Its covariance, m^2 and rad^2.
    pub covariance: Covariance,
}

/// `geometry_msgs/msg/Twist`.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct Twist {
    /// Velocity, m/s.
    pub linear: Vector3,
    /// Rotation, rad/s.
    pub angular: Vector3,
}

/// `geometry_msgs/msg/TwistWithCovariance`.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct TwistWithCovariance {
    /// The twist.
    pub twist: Twist,
    /// Its covariance.
    pub covariance: Covariance,
}

/// `nav_msgs/msg/Odometry`.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Odometry {
    /// Time, and frame of the pose.
    pub header: Header,
    /// Frame that has the pose, and in which the twist is given.
    pub child_frame_id: String,
    /// The pose.
    pub pose: PoseWithCovariance,
    /// The twist.
    pub twist: TwistWithCovariance,
}

impl Message for Odometry {
    const TYPE: &'static str = "nav_msgs/msg/Odometry";
}

/// `nav_msgs/msg/MapMetaData`.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct MapMetaData {
    /// Time at which the map was made.
    pub map_load_time: Stamp,
    /// Side of a cell, metres.
    pub resolution: f32,
    /// Cells along x.
    pub width: u32,
    /// Cells along y.
    pub height: u32,
    /// Pose of the outer corner of cell (0, 0).
    pub origin: Pose,
}

/// `nav_msgs/msg/OccupancyGrid`.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct OccupancyGrid {
    /// Time, and frame of the map.
    pub header: Header,
    /// Its size and place.
    pub info: MapMetaData,
    /// Row by row from the smallest y: 0 free, 100 occupied, -1 (a byte of 255) unknown.
    pub data: Bytes,
}

impl Message for OccupancyGrid {
    const TYPE: &'static str = "nav_msgs/msg/OccupancyGrid";
}
