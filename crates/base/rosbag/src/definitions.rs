//! Definitions of the messages as texts (encoding `ros2msg`): a reader needs no ROS, and no version of it, to decode a
//! bag. (ROS 2 common_interfaces; MCAP registry of schema encodings)

/// Types by package and name, and their fields, in the order in which they are encoded.
const TYPES: &[(&str, &str)] = &[
    ("builtin_interfaces/Time", "int32 sec\nuint32 nanosec\n"),
    ("rosgraph_msgs/Clock", "builtin_interfaces/Time clock\n"),
    ("std_msgs/Header", "builtin_interfaces/Time stamp\nstring frame_id\n"),
    (
        "sensor_msgs/Image",
        "std_msgs/Header header\nuint32 height\nuint32 width\nstring encoding\nuint8 is_bigendian\nuint32 step\n\
         uint8[] data\n",
    ),
    (
        "sensor_msgs/RegionOfInterest",
        "uint32 x_offset\nuint32 y_offset\nuint32 height\nuint32 width\nbool do_rectify\n",
    ),
    (
        "sensor_msgs/CameraInfo",
        "std_msgs/Header header\nuint32 height\nuint32 width\nstring distortion_model\nfloat64[] d\nfloat64[9] k\n\
         float64[9] r\nfloat64[12] p\nuint32 binning_x\nuint32 binning_y\nsensor_msgs/RegionOfInterest roi\n",
    ),
    (
        "sensor_msgs/PointField",
        "uint8 INT8=1\nuint8 UINT8=2\nuint8 INT16=3\nuint8 UINT16=4\nuint8 INT32=5\nuint8 UINT32=6\n\
         uint8 FLOAT32=7\nuint8 FLOAT64=8\nstring name\nuint32 offset\nuint8 datatype\nuint32 count\n",
    ),
    (
        "sensor_msgs/PointCloud2",
        "std_msgs/Header header\nuint32 height\nuint32 width\nsensor_msgs/PointField[] fields\nbool is_bigendian\n\
         uint32 point_step\nuint32 row_step\nuint8[] data\nbool is_dense\n",
    ),
    ("geometry_msgs/Vector3", "float64 x\nfloat64 y\nfloat64 z\n"),
    ("geometry_msgs/Point", "float64 x\nfloat64 y\nfloat64 z\n"),
    ("geometry_msgs/Quaternion", "float64 x 0\nfloat64 y 0\nfloat64 z 0\nfloat64 w 1\n"),
    ("geometry_msgs/Pose", "geometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n"),
    ("geometry_msgs/Transform", "geometry_msgs/Vector3 translation\ngeometry_msgs/Quaternion rotation\n"),
    (
        "geometry_msgs/TransformStamped",
        "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/Transform transform\n",
    ),
    ("tf2_msgs/TFMessage", "geometry_msgs/TransformStamped[] transforms\n"),
    ("geometry_msgs/PoseWithCovariance", "geometry_msgs/Pose pose\nfloat64[36] covariance\n"),
    ("geometry_msgs/Twist", "geometry_msgs/Vector3 linear\ngeometry_msgs/Vector3 angular\n"),
    ("geometry_msgs/TwistWithCovariance", "geometry_msgs/Twist twist\nfloat64[36] covariance\n"),
    (
        "nav_msgs/Odometry",
        "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/PoseWithCovariance pose\n\
         geometry_msgs/TwistWithCovariance twist\n",
    ),
    (
        "nav_msgs/MapMetaData",
        "builtin_interfaces/Time map_load_time\nfloat32 resolution\nuint32 width\nuint32 height\n\
         geometry_msgs/Pose origin\n",
    ),
    ("nav_msgs/OccupancyGrid", "std_msgs/Header header\nnav_msgs/MapMetaData info\nint8[] data\n"),
];

/// Definition of a type, `sensor_msgs/msg/Image`, followed by those of all types that it is made of.
///
/// # Panics
/// For a type that no message here has.
pub(crate) fn definition(of: &str) -> String {
    let name = of.replace("/msg/", "/");
    let mut names = vec![name.as_str()];
    let mut text = fields(&name).to_string();
    let mut next = 0;
    while next < names.len() {
        for line in fields(names[next]).lines() {
            let field = line.split([' ', '[']).next().unwrap_or_default();
            if field.contains('/') && !names.contains(&field) {
                text += &format!("{:=<80}\nMSG: {field}\n{}", "", fields(field));
                names.push(field);
            }
        }
        next += 1;
    }
    text
}

/// Fields of a type by package and name.
fn fields(name: &str) -> &'static str {
    let found = TYPES.iter().find(|(other, _)| *other == name);
    found.unwrap_or_else(|| panic!("no definition of {name}")).1
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_definition_brings_along_each_part_once() {
        let text = definition("nav_msgs/msg/Odometry");
        let parts: Vec<&str> = text.lines().filter_map(|line| line.strip_prefix("MSG: ")).collect();
        let expected = [
            "std_msgs/Header",
            "geometry_msgs/PoseWithCovariance",
            "geometry_msgs/TwistWithCovariance",
            "builtin_interfaces/Time",
            "geometry_msgs/Pose",
            "geometry_msgs/Twist",
            "geometry_msgs/Point",
            "geometry_msgs/Quaternion",
            "geometry_msgs/Vector3",
        ];
        assert_eq!(parts, expected);
        assert!(text.starts_with("std_msgs/Header header\nstring child_frame_id\n"));
        // Each part stands below a line of 80 equal signs, as rosbag2 has it.
        assert_eq!(text.matches(&format!("{:=<80}\nMSG: ", "")).count(), expected.len());
    }

    #[test]
    fn every_type_has_all_its_parts() {
        for (name, _) in TYPES {
            assert!(!definition(name).is_empty());
        }
    }
}
