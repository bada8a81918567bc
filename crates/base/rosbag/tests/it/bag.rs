//! A bag, read back by the container's own reader, byte by byte.

use std::collections::BTreeMap;
use std::path::Path;

use raypencil_rosbag::{
    BagWriter, CameraInfo, Clock, Header, Image, MapMetaData, Message, OccupancyGrid, Odometry, Point,
    PointCloud2, PointField, Pose, PoseWithCovariance, Quaternion, RegionOfInterest, Stamp, TfMessage, Topic,
    Transform, TransformStamped, Twist, TwistWithCovariance, Vector3,
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

/// The numbers of a message by the names of its definition, as a reader finds them that knows the definition alone: `pose.position.x`.
fn by_names<M: Message>(message: &M) -> BTreeMap<String, f64> {
    let folder = tempfile::tempdir().unwrap();
    let bag = folder.path().join("one");
    let mut writer = BagWriter::create(&bag).unwrap();
    writer.write(&Topic::new("/one"), at(1), message).unwrap();
    writer.finish().unwrap();
    let bytes = std::fs::read(bag.join("one_0.mcap")).unwrap();
    let message = mcap::MessageStream::new(&bytes).unwrap().next().unwrap().unwrap();
    let text = String::from_utf8(message.channel.schema.as_ref().unwrap().data.to_vec()).unwrap();
    let mut parts = BTreeMap::new();
    for (index, part) in text.split(&format!("{:=<80}\nMSG: ", "")).enumerate() {
        let (name, fields) = if index == 0 { ("", part) } else { part.split_once('\n').unwrap() };
        parts.insert(name, fields);
    }
    let (mut found, mut place) = (BTreeMap::new(), 4);
    read_numbers((&parts, ""), &message.data, &mut place, "", &mut found);
    assert_eq!(place, message.data.len());
    found
}

/// Reads the numbers of a type's fields. Those of lists are numbered: `k.4`.
fn read_numbers(
    (parts, of): (&BTreeMap<&str, &str>, &str),
    data: &[u8],
    place: &mut usize,
    within: &str,
    found: &mut BTreeMap<String, f64>,
) {
    for line in parts[of].lines().filter(|line| !line.contains('=')) {
        let mut words = line.split(' ');
        let (kind, name) = (words.next().unwrap(), words.next().unwrap());
        let (element, count) = match kind.split_once('[') {
            None => (kind, None),
            Some((element, "]")) => (element, Some(number(data, place))),
            Some((element, length)) => (element, Some(length.trim_end_matches(']').parse().unwrap())),
        };
        for index in 0..count.unwrap_or(1) {
            let name = count.map_or(format!("{within}{name}"), |_| format!("{within}{name}.{index}"));
            let mut bytes = |size: usize| -> Vec<u8> {
                if size == 1 {
                    *place += 1
                } else {
                    align(place, size)
                }
                data[*place - size..*place].to_vec()
            };
            let value = match element {
                "string" => {
                    *place += number(data, place);
                    continue;
                }
                "bool" | "uint8" => f64::from(bytes(1)[0]),
                "int8" => f64::from(i8::from_le_bytes(bytes(1).try_into().unwrap())),
                "int32" => f64::from(i32::from_le_bytes(bytes(4).try_into().unwrap())),
                "uint32" => f64::from(u32::from_le_bytes(bytes(4).try_into().unwrap())),
                "float32" => f64::from(f32::from_le_bytes(bytes(4).try_into().unwrap())),
                "float64" => f64::from_le_bytes(bytes(8).try_into().unwrap()),
                other => {
                    read_numbers((parts, other), data, place, &format!("{name}."), found);
                    continue;
                }
            };
            found.insert(name, value);
        }
    }
}

/// Names and fields are those of ROS 2's common_interfaces, and each field has what the struct says of it.
#[test]
fn each_field_is_where_its_definition_says() {
    let header = || Header { stamp: at(3_000_000_004), frame_id: "eye".into() };
    let is = |found: &BTreeMap<String, f64>, expected: &[(&str, f64)]| {
        for (name, value) in expected {
            assert_eq!(found.get(*name), Some(value), "{name} of {found:?}");
        }
    };
    let data = vec![1; 6].into();
    let image = Image {
        header: header(),
        height: 2,
        width: 3,
        encoding: "mono8".into(),
        is_bigendian: 0,
        step: 5,
        data,
    };
    let of_image = [
        ("header.stamp.sec", 3.0),
        ("header.stamp.nanosec", 4.0),
        ("height", 2.0),
        ("width", 3.0),
        ("step", 5.0),
    ];
    is(&by_names(&image), &of_image);
    let roi = RegionOfInterest { x_offset: 1, y_offset: 2, height: 3, width: 4, do_rectify: true };
    let info = CameraInfo {
        header: header(),
        height: 7,
        width: 8,
        d: vec![0.5, 0.25],
        k: std::array::from_fn(|at| at as f64 + 10.0),
        r: std::array::from_fn(|at| at as f64 + 30.0),
        p: std::array::from_fn(|at| at as f64 + 50.0),
        binning_x: 5,
        binning_y: 6,
        roi,
        ..CameraInfo::default()
    };
    let of_info = [
        ("height", 7.0),
        ("width", 8.0),
        ("d.1", 0.25),
        ("k.2", 12.0),
        ("r.8", 38.0),
        ("p.3", 53.0),
        ("binning_x", 5.0),
        ("binning_y", 6.0),
        ("roi.x_offset", 1.0),
        ("roi.y_offset", 2.0),
        ("roi.height", 3.0),
        ("roi.width", 4.0),
        ("roi.do_rectify", 1.0),
    ];
    is(&by_names(&info), &of_info);
    let field = PointField { name: "z".into(), offset: 8, datatype: PointField::FLOAT64, count: 1 };
    let (height, width, point_step, row_step) = (2, 3, 16, 48);
    let cloud = PointCloud2 {
        header: header(),
        height,
        width,
        fields: vec![field],
        point_step,
        row_step,
        is_dense: true,
        ..PointCloud2::default()
    };
    let of_cloud = [
        ("height", 2.0),
        ("width", 3.0),
        ("fields.0.offset", 8.0),
        ("fields.0.count", 1.0),
        ("is_bigendian", 0.0),
        ("point_step", 16.0),
        ("row_step", 48.0),
        ("is_dense", 1.0),
    ];
    is(&by_names(&cloud), &of_cloud);
    let (position, orientation) =
        (Point { x: 1.0, y: 2.0, z: 3.0 }, Quaternion { x: 0.5, y: -0.5, z: 0.25, w: 0.75 });
    let pose = Pose { position, orientation };
    let origin = pose;
    let map = MapMetaData { map_load_time: at(9), resolution: 0.5, width: 4, height: 6, origin };
    let grid = OccupancyGrid { header: header(), info: map, data: vec![255, 100].into() };
    let of_grid = [
        ("info.map_load_time.nanosec", 9.0),
        ("info.resolution", 0.5),
        ("info.width", 4.0),
        ("info.height", 6.0),
        ("info.origin.position.y", 2.0),
        ("info.origin.orientation.w", 0.75),
        ("data.0", -1.0),
        ("data.1", 100.0),
    ];
    is(&by_names(&grid), &of_grid);
    let (linear, angular) = (Vector3 { x: 4.0, y: 5.0, z: 6.0 }, Vector3 { x: 7.0, y: 8.0, z: 9.0 });
    let covariance = [[0.0; 6]; 6];
    let odometry = Odometry {
        header: header(),
        child_frame_id: "rover".into(),
        pose: PoseWithCovariance { pose, covariance },
        twist: TwistWithCovariance { twist: Twist { linear, angular }, covariance },
    };
    let of_odometry = [
        ("pose.pose.position.z", 3.0),
        ("pose.pose.orientation.x", 0.5),
        ("twist.twist.linear.y", 5.0),
        ("twist.twist.angular.x", 7.0),
    ];
    is(&by_names(&odometry), &of_odometry);
    let transform = Transform { translation: Vector3 { x: 1.0, y: 2.0, z: 3.0 }, rotation: orientation };
    let transforms = vec![TransformStamped { header: header(), child_frame_id: "a".into(), transform }];
    let of_transform =
        [("transforms.0.transform.translation.y", 2.0), ("transforms.0.transform.rotation.w", 0.75)];
    is(&by_names(&TfMessage { transforms }), &of_transform);
}

#[test]
fn types_of_numbers_have_the_codes_of_their_definition() {
    let folder = tempfile::tempdir().unwrap();
    let bag = folder.path().join("one");
    let mut writer = BagWriter::create(&bag).unwrap();
    writer.write(&Topic::new("/cloud"), at(1), &PointCloud2::default()).unwrap();
    writer.finish().unwrap();
    let bytes = std::fs::read(bag.join("one_0.mcap")).unwrap();
    let message = mcap::MessageStream::new(&bytes).unwrap().next().unwrap().unwrap();
    let text = String::from_utf8(message.channel.schema.as_ref().unwrap().data.to_vec()).unwrap();
    // sensor_msgs/PointField numbers them INT8, UINT8, INT16, UINT16, INT32, UINT32, FLOAT32, FLOAT64 from 1.
    for (name, code, expected) in [
        ("UINT8", PointField::UINT8, 2),
        ("UINT16", PointField::UINT16, 4),
        ("INT32", PointField::INT32, 5),
        ("UINT32", PointField::UINT32, 6),
        ("FLOAT32", PointField::FLOAT32, 7),
        ("FLOAT64", PointField::FLOAT64, 8),
    ] {
        assert_eq!(code, expected, "{name}");
        assert!(text.lines().any(|line| line == format!("uint8 {name}={expected}")), "{name}: {text}");
    }
}

#[test]
fn a_bag_begins_with_its_earliest_message_and_ends_with_its_latest() {
    let times = [5_000_000_000, 2_000_000_000, 9_000_000_000, 3_000_000_000];
    let folder = tempfile::tempdir().unwrap();
    for turned in [false, true] {
        let bag = folder.path().join(format!("bag-{turned}"));
        let mut writer = BagWriter::create(&bag).unwrap();
        for index in 0..times.len() {
            let time = at(times[if turned { times.len() - 1 - index } else { index }]);
            writer.write(&Topic::new("/clock"), time, &Clock { clock: time }).unwrap();
        }
        writer.attach("setup.json", "application/json", at(4_000_000_000), b"{}").unwrap();
        writer.finish().unwrap();
        let metadata = std::fs::read_to_string(bag.join("metadata.yaml")).unwrap();
        for words in ["duration:\n    nanoseconds: 7000000000\n", "nanoseconds_since_epoch: 2000000000\n"] {
            assert!(metadata.contains(words), "{metadata}");
        }
        // What rosbag2 is told is what the container itself knows.
        let bytes = std::fs::read(bag.join(format!("bag-{turned}_0.mcap"))).unwrap();
        let summary = mcap::Summary::read(&bytes).unwrap().unwrap();
        let known = summary.stats.unwrap();
        assert_eq!((known.message_start_time, known.message_end_time), (2_000_000_000, 9_000_000_000));
        let attached = &summary.attachment_indexes[0];
        assert_eq!((attached.log_time, attached.create_time), (4_000_000_000, 4_000_000_000));
    }
}

#[test]
fn a_stamp_has_its_time_up_to_the_latest_that_it_holds() {
    let latest = i32::MAX as u64 * 1_000_000_000 + 999_999_999;
    for time in [0, 1, 999_999_999, 1_000_000_000, 1_700_000_000_123_456_789, latest] {
        let stamp = at(time);
        assert_eq!((stamp.nanoseconds(), u64::from(stamp.nanosec)), (time, time % 1_000_000_000));
    }
    for time in [latest + 1, u64::MAX] {
        assert_eq!(at(time).nanoseconds(), latest);
    }
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
