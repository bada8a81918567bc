//! Bags of ROS 2: an MCAP file with the definitions of its messages, and the `metadata.yaml` of rosbag2 beside it.
//! Nothing of ROS is needed to write them, and `ros2 bag`, RViz, Foxglove and Python read them. The poses and the point clouds of any program's bag are read.
//!
//! Internal to raypencil: any version may change its items. The crate `raypencil` is the door.
//!
//! ```text
//! messages       the messages, field by field as ROS 2 defines them
//! definitions    their texts, which the bag carries along
//! bag            the bag itself
//! metadata       its metadata.yaml
//! records, cdr   what is in the bag of any program, and the values of its messages
//! poses          where a frame is, by such a bag
//! clouds         a point cloud of such a bag
//! ```
//!
//! ```
//! use raypencil_rosbag::{BagWriter, Header, Image, Stamp, Topic};
//!
//! let folder = tempfile::tempdir()?;
//! let mut bag = BagWriter::create(&folder.path().join("drive"))?;
//! let stamp = Stamp::from_nanoseconds(1_000_000_000);
//! let image = Image {
//!     header: Header { stamp, frame_id: "camera".into() },
//!     height: 1,
//!     width: 2,
//!     encoding: "mono16".into(),
//!     is_bigendian: 0,
//!     step: 4,
//!     data: vec![1, 0, 2, 0].into(),
//! };
//! bag.write(&Topic::new("/camera/image_raw"), stamp, &image)?;
//! bag.finish()?;
//! assert!(folder.path().join("drive/drive_0.mcap").exists() && folder.path().join("drive/metadata.yaml").exists());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! (MCAP specification 1.0; OMG CDR 1.0 as ROS 2 encodes it, little endian; rosbag2 metadata, version 5)

mod bag;
mod cdr;
mod clouds;
mod definitions;
mod messages;
mod metadata;
mod poses;
mod records;

pub use bag::{BagWriter, Topic};
pub use clouds::{BagCloud, CloudChoice, largest_point_cloud, read_point_cloud};
pub use messages::{
    Bytes, CameraInfo, Clock, Header, Image, MapMetaData, Message, OccupancyGrid, Odometry, Point,
    PointCloud2, PointField, Pose, PoseWithCovariance, Quaternion, RegionOfInterest, Stamp, TfMessage,
    Transform, TransformStamped, Twist, TwistWithCovariance, Vector3,
};
pub use poses::{BagPose, BagPoses, PoseChoice, read_poses};

// The tests by public items are in the program of the unit tests: one executable for the crate.
#[cfg(test)]
extern crate self as raypencil_rosbag;
#[cfg(test)]
#[path = "../tests/it/mod.rs"]
mod it;
