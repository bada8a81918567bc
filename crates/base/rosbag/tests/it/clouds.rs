//! Point clouds of other programs' bags, and of broken ones.

use raypencil_rosbag::{
    BagCloud, BagWriter, Clock, CloudChoice, PointCloud2, PointField, Stamp, Topic, largest_point_cloud,
    read_point_cloud,
};

use crate::it::poses::bag;

/// Written by `rosbags` (reference/rosbag/write_clouds.py): two clouds of `/lidar/points`, one of `/map`.
const OF_ROSBAGS: &[u8] = include_bytes!("../data/clouds.mcap");

fn read(bytes: &[u8], topic: Option<&str>, message: Option<u64>) -> Result<BagCloud, String> {
    read_point_cloud(bytes, bytes.len() as u64, &CloudChoice { topic, message })
        .map_err(|fault| fault.to_string())
}

#[test]
fn clouds_of_rosbags_are_read() {
    let first = read(OF_ROSBAGS, Some("/lidar/points"), Some(1)).expect("a cloud");
    assert_eq!((first.topic.as_str(), first.message), ("/lidar/points", 1));
    let PointCloud2 { header, height, width, fields, point_step, row_step, data, .. } = first.cloud;
    assert_eq!(
        (header.frame_id.as_str(), header.stamp.sec, header.stamp.nanosec),
        ("lidar", 1_700_000_000, 0)
    );
    assert_eq!(([height, width], [point_step, row_step], data.0.len()), ([2, 3], [28, 92], 184));
    let names: Vec<(&str, u32, u8)> =
        fields.iter().map(|field| (field.name.as_str(), field.offset, field.datatype)).collect();
    assert_eq!(names, [("x", 0, 7), ("y", 4, 7), ("z", 8, 7), ("ring", 16, 4), ("time", 20, 7)]);
    // The third point of the second row: x is 2.5.
    assert_eq!(data.0[92 + 56..92 + 60], 2.5_f32.to_le_bytes());

    let second = read(OF_ROSBAGS, Some("/lidar/points"), Some(2)).expect("a cloud");
    assert_eq!((second.message, second.cloud.is_bigendian), (2, true));
    assert_eq!(second.cloud.header.stamp.nanosec, 100_000_000);
    assert_eq!(second.cloud.data.0[..8], 100.0_f64.to_be_bytes());

    let map = read(OF_ROSBAGS, Some("/map"), None).expect("a cloud");
    assert_eq!((map.message, map.cloud.width, map.cloud.height), (1, 1, 1));
    assert_eq!(largest_point_cloud(OF_ROSBAGS, OF_ROSBAGS.len() as u64), Some(6));
}

#[test]
fn several_clouds_are_told_apart_by_topic_and_number() {
    let refused = |topic, message| read(OF_ROSBAGS, topic, message).expect_err("no single cloud");
    assert_eq!(
        refused(None, None),
        "file: clouds of /lidar/points (2), /map (1); expected one topic: `--topic` chooses it"
    );
    assert_eq!(refused(None, Some(1)), refused(None, None));
    assert_eq!(
        refused(Some("/lidar/points"), None),
        "topic /lidar/points: 2 clouds; expected one: `--message` 1 to 2 chooses it"
    );
    assert_eq!(
        refused(Some("/lidar/points"), Some(3)),
        "topic /lidar/points: 2 clouds, and none of number 3; expected 1 to 2"
    );
    assert_eq!(
        refused(Some("/odom"), None),
        "topic /odom: no point cloud; expected a cloud, as messages of sensor_msgs/msg/PointCloud2; the file has \
         /lidar/points (2), /map (1)"
    );
}

#[test]
fn what_the_writer_writes_is_read_again() {
    let field = |(name, offset, datatype): (&str, u32, u8)| PointField {
        name: name.into(),
        offset,
        datatype,
        count: 1,
    };
    let cloud = PointCloud2 {
        height: 1,
        width: 2,
        fields: [("x", 0, PointField::FLOAT32), ("y", 4, PointField::INT32), ("z", 8, PointField::UINT8)]
            .map(field)
            .into(),
        point_step: 9,
        row_step: 18,
        data: (0..18).collect::<Vec<u8>>().into(),
        is_dense: true,
        ..PointCloud2::default()
    };
    let folder = tempfile::tempdir().expect("a folder");
    let mut writer = BagWriter::create(&folder.path().join("one")).expect("a bag");
    writer.write(&Topic::new("/points"), Stamp::from_nanoseconds(5), &cloud).expect("a message");
    writer.write(&Topic::new("/clock"), Stamp::from_nanoseconds(3), &Clock::default()).expect("a message");
    writer.write(&Topic::new("/clock"), Stamp::from_nanoseconds(7), &Clock::default()).expect("a message");
    writer.finish().expect("a bag");
    let bytes = std::fs::read(folder.path().join("one/one_0.mcap")).expect("bytes");
    let found = read(&bytes, None, None).expect("a cloud");
    assert_eq!(found, BagCloud { topic: "/points".into(), message: 1, begin_ns: 3, cloud });
}

const CLOUD: &str = "sensor_msgs/msg/PointCloud2";

/// The head of a message with these numbers of rows, columns and fields.
fn head(rows: u32, columns: u32, fields: u32) -> Vec<u8> {
    let words = |words: &[u32]| words.iter().flat_map(|word| word.to_le_bytes()).collect::<Vec<u8>>();
    [vec![0, 1, 0, 0], words(&[1, 2, 4]), b"map\0".to_vec(), words(&[rows, columns, fields])].concat()
}

#[test]
fn what_is_no_bag_of_clouds_is_refused() {
    for (bytes, message) in [
        (bag(CLOUD, "ros1", &[head(1, 1, 0)]), "message 1 of /at: the encoding \"ros1\"; expected cdr"),
        (bag(CLOUD, "cdr", &[head(1, 1, 0)]), "which end within a value; expected the CDR of sensor_msgs"),
        (bag(CLOUD, "cdr", &[head(1, 1, u32::MAX)]), "message 1 of /at: 4294967295 fields, more than 1024"),
        (bag(CLOUD, "cdr", &[head(1, 1, 1025)]), "message 1 of /at: 1025 fields, more than 1024"),
        (bag(CLOUD, "cdr", &[head(1, 1, 1024)]), "which end within a value; expected the CDR of sensor_msgs"),
        (bag(CLOUD, "cdr", &[vec![0, 1]]), "message 1 of /at: 2 bytes; expected the CDR of"),
        (
            bag("sensor_msgs/msg/Imu", "cdr", &[head(1, 1, 0)]),
            "file: no point cloud; expected a cloud, as messages of",
        ),
        (bag(CLOUD, "cdr", &[]), "file: no point cloud; expected a cloud, as messages of"),
        (b"VERSION .7\n".to_vec(), "file: Bad magic number; expected a whole MCAP file"),
    ] {
        let found = read(&bytes, None, None).expect_err(message);
        assert!(found.contains(message), "{found}: {message}");
    }
    // Memory is asked for by what a message claims, but not for points that its bytes cannot hold.
    for heads in [[head(1, 5, 0), head(70_000, 70_000, 0)], [head(70_000, 70_000, 0), head(1, 5, 0)]] {
        let claims = bag(CLOUD, "cdr", &heads);
        assert_eq!(largest_point_cloud(claims.as_slice(), claims.len() as u64), Some(32 / 3));
    }
}

/// A bag that was cut off anywhere, or of which a byte is another, is read or refused.
#[test]
fn cut_and_changed_bags_of_clouds_are_read_or_refused() {
    for end in (0..OF_ROSBAGS.len()).step_by(7) {
        assert!(read(&OF_ROSBAGS[..end], Some("/map"), None).is_err(), "cut at {end}");
    }
    for at in 0..OF_ROSBAGS.len() {
        let mut changed = OF_ROSBAGS.to_vec();
        changed[at] ^= 0xff;
        if let Ok(found) = read(&changed, Some("/lidar/points"), Some(1)) {
            assert!(found.cloud.data.0.len() <= 184);
        }
    }
}
