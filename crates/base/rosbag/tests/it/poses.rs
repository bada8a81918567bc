//! Poses of other programs' bags, and of broken ones.

use std::collections::BTreeMap;

use mcap::records::MessageHeader;
use mcap::{Compression, WriteOptions};
use raypencil_rosbag::{BagPoses, PoseChoice, read_poses};

/// Written by `rosbags` (reference/rosbag/write_poses.py): `/odom`, `/pose`, and `/tf` with two pairs of frames.
const OF_ROSBAGS: [&[u8]; 2] =
    [include_bytes!("../data/poses.mcap"), include_bytes!("../data/poses-zstd.mcap")];

fn read(bytes: &[u8], topic: Option<&str>, frames: Option<[&str; 2]>) -> Result<BagPoses, String> {
    read_poses(bytes, bytes.len() as u64, &PoseChoice { topic, frames }).map_err(|fault| fault.to_string())
}

#[test]
fn poses_of_rosbags_are_read_with_and_without_zstandard() {
    for bytes in OF_ROSBAGS {
        let choices = [
            (Some("/odom"), None, 1.0),
            (Some("/pose"), None, 1.0),
            (None, Some(["map", "lidar"]), 1.0),
            (Some("/tf"), Some(["base_link", "wheel"]), 2.0),
        ];
        for (topic, frames, scale) in choices {
            let found = read(bytes, topic, frames).expect("poses");
            assert_eq!(found.topic, topic.unwrap_or("/tf"));
            assert_eq!(found.poses.len(), 3);
            for (k, pose) in found.poses.iter().enumerate() {
                let at = k as f64;
                assert_eq!((pose.message, pose.time_s), (k as u64 + 1, 1.7e9 + 0.25 * at));
                assert_eq!(pose.position, [scale * at, -at / 2.0, 1.5]);
                // Turned by 60 degrees a pose: sine and cosine of the half angle.
                let half = [(0.0, 1.0), (0.5, 0.75_f64.sqrt()), (0.75_f64.sqrt(), 0.5)][k];
                let [x, y, z, w] = pose.rotation;
                assert!(x == 0.0 && y == 0.0 && (z - half.0).abs() < 1e-15 && (w - half.1).abs() < 1e-15);
            }
        }
    }
}

#[test]
fn several_series_of_poses_are_told_apart_by_topic_or_frames() {
    let refused = |topic, frames| read(OF_ROSBAGS[0], topic, frames).expect_err("no single series");
    assert_eq!(
        refused(None, None),
        "file: poses of /odom (base_link in odom), /pose (in map), /tf (wheel in base_link), /tf (lidar in map); expected one: \
         `poses_topic` and `poses_frames` = [parent, child] choose it"
    );
    assert!(
        refused(Some("/tf"), None)
            .starts_with("topic /tf: poses of /tf (wheel in base_link), /tf (lidar in map)")
    );
    assert_eq!(
        refused(Some("/gps"), None),
        "topic /gps: no pose; expected messages of nav_msgs/msg/Odometry, geometry_msgs/msg/PoseStamped or tf2_msgs/msg/TFMessage; \
         the file has /odom, /pose, /tf"
    );
    // The beginning of a name is another name.
    assert!(refused(Some("/od"), None).starts_with("topic /od: no pose"));
    assert!(refused(None, Some(["lidar", "map"])).starts_with("file: no pose of \"map\" in \"lidar\""));
}

/// A bag with these messages of one topic.
pub(super) fn bag(schema: &str, encoding: &str, messages: &[Vec<u8>]) -> Vec<u8> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    let options = WriteOptions::new().compression(Some(Compression::Lz4));
    let mut writer = options.create(&mut bytes).expect("a bag");
    let schema = writer.add_schema(schema, "ros2msg", b"").expect("a schema");
    let id = writer.add_channel(schema, "/at", encoding, &BTreeMap::new()).expect("a channel");
    for (sequence, data) in (0..).zip(messages) {
        let header = MessageHeader { channel_id: id, sequence, log_time: 1, publish_time: 1 };
        writer.write_to_known_channel(&header, data).expect("a message");
    }
    writer.finish().expect("a bag");
    drop(writer);
    bytes.into_inner()
}

/// A `PoseStamped` in big or little endian: frame `map` at 2.5 s, position (1, 2, 3), no turn.
fn pose(is_big: bool) -> Vec<u8> {
    pose_at([2, 500_000_000], is_big)
}

/// The same at a time of seconds and nanoseconds.
fn pose_at(stamp: [u32; 2], is_big: bool) -> Vec<u8> {
    let word = |value: u32| if is_big { value.to_be_bytes() } else { value.to_le_bytes() };
    let real = |value: f64| if is_big { value.to_be_bytes() } else { value.to_le_bytes() };
    let mut data = vec![0, u8::from(!is_big), 0, 0];
    data.extend([word(stamp[0]), word(stamp[1]), word(4)].concat());
    data.extend(b"map\0");
    data.extend([1.0, 2.0, 3.0, 0.0, 0.0, 0.0, 1.0].map(real).concat());
    data
}

const POSE: &str = "geometry_msgs/msg/PoseStamped";

#[test]
fn either_byte_order_is_read() {
    let found = read(&bag(POSE, "cdr", &[pose(false), pose(true)]), None, None).expect("poses");
    for pose in &found.poses {
        assert_eq!((pose.time_s, pose.position, pose.rotation), (2.5, [1.0, 2.0, 3.0], [0.0, 0.0, 0.0, 1.0]));
    }
    assert_eq!(found.poses.len(), 2);
}

#[test]
fn nanoseconds_count_forwards_and_stay_below_a_second() {
    let times = |stamp: [u32; 2]| {
        let found = read(&bag(POSE, "cdr", &[pose_at(stamp, false)]), None, None)?;
        Ok::<f64, String>(found.poses[0].time_s)
    };
    // Half a second after two seconds before the epoch.
    assert_eq!(times([(-2_i32).cast_unsigned(), 500_000_000]), Ok(-1.5));
    assert_eq!(times([0, 999_999_999]), Ok(0.999_999_999));
    let fault = times([0, 1_000_000_000]).expect_err("a second and more");
    assert!(fault.contains("a stamp of 1000000000 nanoseconds"), "{fault}");
}

#[test]
fn what_is_no_bag_of_poses_is_refused() {
    let changed = |at: usize, value: u8| {
        let mut data = pose(false);
        data[at] = value;
        data
    };
    let broken = bag(POSE, "cdr", &[pose(false), pose(false)[..40].to_vec()]);
    // A transform that claims four billion others behind it.
    let many = [&[0, 1, 0, 0, 255, 255, 255, 255][..], &pose(false)[4..]].concat();
    for (bytes, message) in [
        (
            bag(POSE, "ros1", &[pose(false)]),
            "message 1 of /at: the encoding \"ros1\"; expected cdr, that of ROS 2",
        ),
        (
            broken,
            "message 2 of /at: 40 bytes, which end within a value; expected the CDR of geometry_msgs/msg/PoseStamped",
        ),
        (bag(POSE, "cdr", &[vec![0, 1]]), "message 1 of /at: 2 bytes; expected the CDR of"),
        (bag(POSE, "cdr", &[changed(1, 7)]), "message 1 of /at: the representation 0x00 0x07"),
        (bag(POSE, "cdr", &[changed(11, 0xff)]), "a stamp of "),
        (bag(POSE, "cdr", &[changed(17, 0xff)]), "a name that is no text"),
        (bag(POSE, "cdr", &[changed(15, 0xff)]), "which end within a value"),
        (bag("tf2_msgs/msg/TFMessage", "cdr", &[many]), "which end within a value"),
        (
            bag("sensor_msgs/msg/Imu", "cdr", &[pose(false)]),
            "file: no pose; expected messages of nav_msgs/msg/Odometry",
        ),
        (bag(POSE, "cdr", &[]), "file: no pose; expected messages of nav_msgs/msg/Odometry"),
        (
            b"# timestamp tx ty tz qx qy qz qw\n".to_vec(),
            "file: Bad magic number; expected a whole MCAP file",
        ),
        (Vec::new(), "expected a whole MCAP file"),
    ] {
        let found = read(&bytes, None, None).expect_err(message);
        assert!(found.contains(message), "{found}: {message}");
    }
    let of_imu =
        read(&bag("sensor_msgs/msg/Imu", "cdr", &[pose(false)]), Some("/at"), None).expect_err("no poses");
    assert!(of_imu.contains("topic /at: messages of \"sensor_msgs/msg/Imu\""), "{of_imu}");
}

/// A bag that was cut off anywhere, or of which a byte is another, is read or refused, and asks for no memory that the file does not
/// make plausible.
#[test]
fn cut_and_changed_bags_are_read_or_refused() {
    for bytes in OF_ROSBAGS {
        for end in (0..bytes.len()).step_by(7) {
            assert!(read(&bytes[..end], Some("/odom"), None).is_err(), "cut at {end}");
        }
        for at in 0..bytes.len() {
            let mut changed = bytes.to_vec();
            changed[at] ^= 0xff;
            if let Ok(found) = read(&changed, Some("/odom"), None) {
                assert!(found.poses.len() <= 3);
            }
        }
    }
}

#[test]
fn texts_that_claim_more_than_their_record_has_are_refused_before_there_is_room_for_them() {
    let whole = OF_ROSBAGS[0];
    assert!(read(whole, Some("/odom"), None).is_ok());
    // The last byte of a length of four: of names, encodings and metadata.
    for at in [2628, 9977, 11877, 11973] {
        let mut bytes = whole.to_vec();
        bytes[at] = 0x7f;
        let fault = read(&bytes, Some("/odom"), None).expect_err("a text of two thousand million bytes");
        assert!(fault.contains("MCAP"), "{at}: {fault}");
    }
}

#[test]
fn a_record_that_is_longer_than_its_chunk_is_refused() {
    const MAGIC: &[u8] = b"\x89MCAP0\r\n";
    // A message, of which the chunk has so many bytes and which says another length; behind the chunk there are bytes enough.
    let bag = |bytes: usize, length: u64| {
        let message = [&[5][..], &length.to_le_bytes(), &vec![0; bytes]].concat();
        let size = message.len() as u64;
        let times = [0; 16];
        let header = [&times[..], &size.to_le_bytes(), &[0; 4], &[0; 4], &size.to_le_bytes()].concat();
        let chunk =
            [&[6][..], &((header.len() + message.len()) as u64).to_le_bytes(), &header, &message].concat();
        let footer = [&[2][..], &20_u64.to_le_bytes(), &[0; 20]].concat();
        [MAGIC, &chunk, &footer, MAGIC].concat()
    };
    let refused = |bytes, length| read(&bag(bytes, length), None, None).expect_err("no poses");
    let longer = "file: a record of a chunk is longer than the chunk; expected a whole MCAP file, as rosbag2 writes it";
    for (bytes, length) in [(22, 23), (22, 40), (22, u64::MAX), (22, u64::MAX - 8), (0, 1)] {
        assert_eq!(refused(bytes, length), longer, "{length} for {bytes} bytes");
    }
    // Of the length that it says, it is a message of a channel that is not there.
    assert!(!refused(22, 22).contains("longer than the chunk"), "{}", refused(22, 22));
}
