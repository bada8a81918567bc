//! A bag, read back by the container's own reader, byte by byte.

use std::collections::BTreeMap;
use std::path::Path;

use raypencil_rosbag::{
    BagWriter, CameraInfo, Clock, Header, Image, MapMetaData, OccupancyGrid, Odometry, PointCloud2,
    PointField, Stamp, TfMessage, Topic, Transform, TransformStamped, Vector3,
};

fn at(nanoseconds: u64) -> Stamp {
    Stamp::from_nanoseconds(nanoseconds)
}

/// A bag of two images and a transform.
fn write(folder: &Path) {
    let mut bag = BagWriter::create(folder).unwrap();
    let header = |stamp| Header { stamp, frame_id: "eye".into() };
    let transform = TransformStamped {
        header: header(at(2_000_000_001)),
        child_frame_id: "a".into(),
        transform: Transform { translation: Vector3 { x: 1.0, y: -2.0, z: 0.5 }, ..Transform::default() },
    };
    bag.write(&Topic::latched("/tf_static"), at(2_000_000_001), &TfMessage { transforms: vec![transform] })
        .unwrap();
    for (time, value) in [(2_000_000_001, 7), (3_500_000_000, 9)] {
        let image = Image {
            header: header(at(time)),
            height: 1,
            width: 2,
            encoding: "mono16".into(),
            is_bigendian: 0,
            step: 4,
            data: vec![value, 1, 0, 2].into(),
        };
        bag.write(&Topic::new("/eye/image_raw"), at(time), &image).unwrap();
    }
    bag.attach("setup.json", "application/json", at(0), b"{}").unwrap();
    bag.finish().unwrap();
}

#[test]
fn the_bytes_of_a_message_are_those_of_cdr() {
    let folder = tempfile::tempdir().unwrap();
    let bag = folder.path().join("drive");
    write(&bag);
    let bytes = std::fs::read(bag.join("drive_0.mcap")).unwrap();
    let messages: Vec<_> = mcap::MessageStream::new(&bytes).unwrap().map(Result::unwrap).collect();
    assert_eq!(messages.len(), 3);
    let image = &messages[2];
    assert_eq!((image.channel.topic.as_str(), image.sequence), ("/eye/image_raw", 1));
    assert_eq!((image.log_time, image.publish_time), (3_500_000_000, 3_500_000_000));
    // By hand: CDR, little endian; each number stands at a multiple of its size after the first four bytes; a text has
    // its length with the closing zero.
    let mut expected = vec![0, 1, 0, 0];
    expected.extend(3_i32.to_le_bytes());
    expected.extend(500_000_000_u32.to_le_bytes());
    expected.extend([4, 0, 0, 0]);
    expected.extend(b"eye\0");
    expected.extend([1, 0, 0, 0, 2, 0, 0, 0]);
    expected.extend([7, 0, 0, 0]);
    expected.extend(b"mono16\0");
    // One byte for the order of bytes ends at 36: the next number needs no filling.
    expected.extend([0]);
    expected.extend([4, 0, 0, 0, 4, 0, 0, 0, 9, 1, 0, 2]);
    assert_eq!(&image.data[..], expected);
    // A transform: its doubles begin at a multiple of 8 bytes.
    let mut expected = vec![0, 1, 0, 0, 1, 0, 0, 0];
    expected.extend(2_i32.to_le_bytes());
    expected.extend(1_u32.to_le_bytes());
    expected.extend([4, 0, 0, 0]);
    expected.extend(b"eye\0");
    expected.extend([2, 0, 0, 0]);
    expected.extend(b"a\0");
    // 4 + 8 + 8 + 6 = 26 bytes so far without the first four: six fill up to 32.
    expected.extend([0; 6]);
    for number in [1.0_f64, -2.0, 0.5, 0.0, 0.0, 0.0, 1.0] {
        expected.extend(number.to_le_bytes());
    }
    assert_eq!(&messages[0].data[..], expected);
    let schema = image.channel.schema.as_ref().unwrap();
    assert_eq!((schema.name.as_str(), schema.encoding.as_str()), ("sensor_msgs/msg/Image", "ros2msg"));
    assert_eq!(image.channel.message_encoding, "cdr");
    let summary = mcap::Summary::read(&bytes).unwrap().unwrap();
    assert_eq!(summary.stats.unwrap().message_count, 3);
    assert_eq!(summary.attachment_indexes[0].name, "setup.json");
    // What marks a complete bag counts the same.
    let metadata = std::fs::read_to_string(bag.join("metadata.yaml")).unwrap();
    assert!(
        metadata.contains("  message_count: 3\n") && metadata.contains("    nanoseconds: 1499999999\n"),
        "{metadata}"
    );
}

/// Length of each message, by its definition: a schema that does not say what the bytes are is found.
#[test]
fn every_message_is_as_long_as_its_definition_says() {
    let folder = tempfile::tempdir().unwrap();
    let bag = folder.path().join("all");
    let mut writer = BagWriter::create(&bag).unwrap();
    let header = Header { stamp: at(1), frame_id: String::new() };
    let field = PointField { name: "x".into(), offset: 0, datatype: PointField::FLOAT32, count: 1 };
    let cloud = PointCloud2 { header: header.clone(), fields: vec![field], ..PointCloud2::default() };
    writer
        .write(&Topic::new("/image"), at(1), &Image { header: header.clone(), ..Image::default() })
        .unwrap();
    writer
        .write(&Topic::new("/info"), at(1), &CameraInfo { header: header.clone(), ..CameraInfo::default() })
        .unwrap();
    writer.write(&Topic::new("/cloud"), at(1), &cloud).unwrap();
    let info = MapMetaData::default();
    let grid = OccupancyGrid { header: header.clone(), info, data: vec![255, 100].into() };
    writer.write(&Topic::new("/grid"), at(1), &grid).unwrap();
    writer.write(&Topic::new("/odometry"), at(1), &Odometry { header, ..Odometry::default() }).unwrap();
    writer.write(&Topic::new("/tf"), at(1), &TfMessage::default()).unwrap();
    writer.write(&Topic::new("/clock"), at(1), &Clock { clock: at(1) }).unwrap();
    writer.finish().unwrap();

    let bytes = std::fs::read(bag.join("all_0.mcap")).unwrap();
    let mut seen = 0;
    for message in mcap::MessageStream::new(&bytes).unwrap().map(Result::unwrap) {
        let schema = message.channel.schema.as_ref().unwrap();
        let text = std::str::from_utf8(&schema.data).unwrap();
        let mut parts = BTreeMap::new();
        for (index, part) in text.split(&format!("{:=<80}\nMSG: ", "")).enumerate() {
            let (name, fields) = if index == 0 { ("", part) } else { part.split_once('\n').unwrap() };
            parts.insert(name, fields);
        }
        let mut place = 4;
        read(&parts, "", &message.data, &mut place);
        assert_eq!(place, message.data.len(), "{}", schema.name);
        seen += 1;
    }
    assert_eq!(seen, 7);
}

/// Goes over a type's fields in the bytes of a message, which begin with four bytes that alignment does not count.
fn read(parts: &BTreeMap<&str, &str>, of: &str, data: &[u8], place: &mut usize) {
    for line in parts[of].lines().filter(|line| !line.contains('=')) {
        let kind = line.split(' ').next().unwrap();
        let (element, count) = match kind.split_once('[') {
            None => (kind, 1),
            Some((element, "]")) => (element, number(data, place)),
            Some((element, length)) => (element, length.trim_end_matches(']').parse().unwrap()),
        };
        for _ in 0..count {
            match element {
                "string" => *place += number(data, place),
                "bool" | "uint8" | "int8" => *place += 1,
                "int32" | "uint32" | "float32" => align(place, 4),
                "float64" => align(place, 8),
                other => read(parts, other, data, place),
            }
        }
    }
}

/// Goes to a multiple of the size, and over one number.
fn align(place: &mut usize, size: usize) {
    *place = (*place - 4).next_multiple_of(size) + 4 + size;
}

/// Length before a text or a list.
fn number(data: &[u8], place: &mut usize) -> usize {
    align(place, 4);
    u32::from_le_bytes(data[*place - 4..*place].try_into().unwrap()) as usize
}

#[test]
fn the_same_messages_make_the_same_bytes_and_an_unfinished_bag_has_no_mark() {
    let folder = tempfile::tempdir().unwrap();
    let [a, b] = ["a", "b"].map(|name| folder.path().join(name).join("drive"));
    write(&a);
    write(&b);
    for name in ["drive_0.mcap", "metadata.yaml"] {
        assert_eq!(std::fs::read(a.join(name)).unwrap(), std::fs::read(b.join(name)).unwrap(), "{name}");
    }
    drop(BagWriter::create(&a).unwrap());
    assert!(!a.join("metadata.yaml").exists());
    // A file where the folder should be.
    std::fs::write(folder.path().join("file"), "").unwrap();
    let error = BagWriter::create(&folder.path().join("file/drive")).unwrap_err();
    assert!(error.to_string().contains("file"), "{error}");
}

#[test]
#[should_panic(expected = "messages of /a")]
fn a_topic_has_messages_of_one_type() {
    let folder = tempfile::tempdir().unwrap();
    let mut bag = BagWriter::create(&folder.path().join("drive")).unwrap();
    bag.write(&Topic::new("/a"), at(1), &Image::default()).unwrap();
    let _ = bag.write(&Topic::new("/a"), at(2), &TfMessage::default());
}
