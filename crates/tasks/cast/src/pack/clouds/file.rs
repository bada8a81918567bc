//! The file of a cloud: PCD, PLY, or a bag of ROS 2 that has it as a message.

use std::fs::File;
use std::io::{BufReader, Read};
use std::path::Path;

use raypencil_files::{Fault, FileError};
use raypencil_mesh_io::{
    Cloud, PackedField, PackedKind, PackedPoints, claimed_points, is_cloud_file, read_cloud,
};
use raypencil_rosbag::{BagCloud, CloudChoice, PointField, largest_point_cloud, read_point_cloud};

/// The time at which a bag of the set begins that would begin earlier, nanoseconds: the time 0 means "no time" in ROS.
const FIRST_NS: u64 = 1_000_000_000;

/// Whether a file's name ends as that of a bag does: `.mcap`.
pub fn is_bag_of_clouds(path: &Path) -> bool {
    path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("mcap"))
}

/// Whether a file's name ends as that of a cloud does: `.pcd`, `.ply` or `.mcap`.
pub fn is_cloud(path: &Path) -> bool {
    is_cloud_file(path) || is_bag_of_clouds(path)
}

/// What is wrong with a file that should be a cloud, by its name, and of a folder by the bag in it; `None`: it may be one.
///
/// ```
/// use raypencil_cast::no_cloud;
///
/// assert_eq!(no_cloud("mine.pcd".as_ref()), None);
/// let words = no_cloud("mine_0.db3".as_ref()).expect("words");
/// assert!(words.starts_with("mine_0.db3 is no point cloud (.pcd, .ply, .mcap): `ros2 bag convert`"));
/// ```
pub fn no_cloud(path: &Path) -> Option<String> {
    if is_cloud(path) {
        return None;
    }
    let of_bag = path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("db3"));
    let help = match bag_within(path) {
        Some(bag) => format!(": give {bag} in it"),
        None if of_bag => ": `ros2 bag convert` makes MCAP of a bag in SQLite".into(),
        None => String::new(),
    };
    Some(format!("{} is no point cloud (.pcd, .ply, .mcap){help}", path.display()))
}

/// The name of a bag in a folder, such as that of `ros2 bag record`.
pub(in crate::pack) fn bag_within(folder: &Path) -> Option<String> {
    let entries = std::fs::read_dir(folder).ok()?.flatten().map(|entry| entry.path());
    let bag = entries.filter(|path| is_bag_of_clouds(path)).min()?;
    Some(bag.file_name()?.to_string_lossy().into_owned())
}

/// The number of points that a file says it has, before anything is made of them, and of a bag that of its largest cloud; `None` if it names none,
/// or the file cannot be read.
pub fn stated_points(path: &Path) -> Option<u64> {
    if !is_bag_of_clouds(path) {
        return claimed_points(path);
    }
    let (stream, length) = opened(path).ok()?;
    largest_point_cloud(stream, length)
}

/// Opens a file. Opening a pipe would wait for its writer, so that what it is, is asked before.
fn opened(path: &Path) -> std::io::Result<(impl Read, u64)> {
    let facts = std::fs::metadata(path)?;
    if !facts.is_file() {
        return Err(std::io::Error::other("not a regular file"));
    }
    Ok((BufReader::new(File::open(path)?), facts.len()))
}

/// Where the cloud of a bag stands in it.
pub(super) struct BagPlace {
    /// Which message it is, in words.
    pub(super) words: String,
    /// Its stamp, nanoseconds.
    stamp_ns: u64,
    /// When the earliest message of the bag was recorded, nanoseconds.
    begin_ns: u64,
}

impl BagPlace {
    /// How much later the bag tells its times than a set whose first ray is fired at a time, seconds. A set that begins before 1 s is told
    /// from 1 s on (docs/formats/rosbag.md): then the bag begins at 1 s, and its stamp is that of the first ray.
    pub(super) fn later_s(&self, first_s: f64) -> f64 {
        if self.begin_ns != FIRST_NS {
            return 0.0;
        }
        let later_s = self.stamp_ns as f64 * 1e-9 - first_s;
        if later_s > 0.0 { later_s } else { 0.0 }
    }
}

/// Reads those fields of a cloud that `keeps` names, and x, y and z; of a bag beside it which message it is, in words.
pub(super) fn read(
    path: &Path,
    choice: &CloudChoice<'_>,
    keeps: impl Fn(&str) -> bool,
) -> Result<(Cloud, Option<BagPlace>), FileError> {
    if !is_bag_of_clouds(path) {
        return Ok((read_cloud(path, keeps)?, None));
    }
    let (stream, length) = opened(path).map_err(|error| FileError::io(path, "read", error))?;
    let of_bag = || -> Result<_, Fault> {
        let BagCloud { topic, message, begin_ns, cloud } = read_point_cloud(stream, length, choice)?;
        let words = format!("message {message} of {topic}");
        let within = |fault: Fault| fault.inside(&words);
        let fields = cloud.fields.iter().map(packed).collect::<Result<Vec<_>, _>>().map_err(within)?;
        let points = PackedPoints {
            fields: &fields,
            size: [u64::from(cloud.width), u64::from(cloud.height)],
            point_step: cloud.point_step as usize,
            row_step: cloud.row_step as usize,
            is_big_endian: cloud.is_bigendian,
            data: &cloud.data.0,
        };
        let read = points.cloud(|name| ["x", "y", "z"].contains(&name) || keeps(name)).map_err(within)?;
        Ok((read, Some(BagPlace { words, stamp_ns: cloud.header.stamp.nanoseconds(), begin_ns })))
    };
    of_bag().map_err(|fault| FileError::Cloud(fault.in_file(path)))
}

/// A field of a message. (`sensor_msgs/msg/PointField`, the constants of `datatype`)
fn packed(field: &PointField) -> Result<PackedField, Fault> {
    let (kind, size) = match field.datatype {
        PointField::INT8 => (PackedKind::Signed, 1),
        PointField::UINT8 => (PackedKind::Unsigned, 1),
        PointField::INT16 => (PackedKind::Signed, 2),
        PointField::UINT16 => (PackedKind::Unsigned, 2),
        PointField::INT32 => (PackedKind::Signed, 4),
        PointField::UINT32 => (PackedKind::Unsigned, 4),
        PointField::FLOAT32 => (PackedKind::Real, 4),
        PointField::FLOAT64 => (PackedKind::Real, 8),
        other => {
            let expected = "1 to 8, a type of sensor_msgs/msg/PointField";
            return Err(Fault::new(format!("field `{}`", field.name), format!("datatype {other}"), expected));
        }
    };
    let (name, offset, count) = (field.name.clone(), field.offset as usize, field.count as usize);
    Ok(PackedField { name, offset, kind, size, count })
}
