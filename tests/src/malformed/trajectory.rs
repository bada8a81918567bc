//! Malformed poses of a moving sensor: TUM, CSV, and bags.

use super::case::{Case, Item};

const RUN: &str = "cast mesh.obj rays.toml -o out";

/// A triangle.
pub(super) const MESH: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

/// Written by `rosbags` (reference/rosbag/write_poses.py): three messages of each kind, without compression and check sums.
pub(super) const BAG: &[u8] = include_bytes!("../../../crates/base/rosbag/tests/data/poses.mcap");

pub(super) fn set(file: &str, more: &str) -> String {
    format!(
        "[[rays]]\nname = \"a\"\ngrid = {{ preset = \"l515\", columns = 2, rows = 2 }}\nposes_file = \"{file}\"\n{more}"
    )
}

/// The bag with each of these words in place of another of the same length.
fn bag_with(from: &[u8], to: &[u8]) -> Vec<u8> {
    assert_eq!(from.len(), to.len());
    let mut bytes = BAG.to_vec();
    let places: Vec<usize> =
        (0..=bytes.len() - from.len()).filter(|&at| bytes[at..].starts_with(from)).collect();
    assert!(!places.is_empty(), "{from:?} is in the bag");
    for at in places {
        bytes[at..at + to.len()].copy_from_slice(to);
    }
    bytes
}

pub(super) fn cases() -> Vec<Case> {
    let on_mesh = |case: Case, set: String| case.file("mesh.obj", MESH).file("rays.toml", set);
    let tum = |name: &str, what, text: &str, place: &str| {
        let case = Case::of_file(&format!("poses-{name}"), what, RUN, "walk.tum", text.into(), place);
        on_mesh(case, set("walk.tum", ""))
    };
    let bag = |name: &str, what, bytes: Vec<u8>, more: &str, place: &str| {
        let case = Case::of_file(&format!("poses-bag-{name}"), what, RUN, "walk.mcap", bytes, place);
        on_mesh(case, set("walk.mcap", more))
    };
    let odom = "poses_topic = \"/odom\"";
    // Opcode 6 is a chunk; its length, and its uncompressed size behind two times. (MCAP specification, "Chunk")
    let long_chunk = {
        let mut bytes = BAG.to_vec();
        bytes[44..52].copy_from_slice(&u64::MAX.to_le_bytes());
        bytes
    };
    let long_record = {
        let mut bytes = BAG.to_vec();
        bytes[9..17].copy_from_slice(&(1_u64 << 40).to_le_bytes());
        bytes
    };
    let row = "0 0 0 0 0 0 0 1\n";
    vec![
        tum("empty", "an empty file", "", "no pose"),
        tum("seven", "a row of seven numbers", "0 0 0 0 0 0 1\n", "line 1: 7 fields"),
        tum("word", "a word for a number", "0 0 0 up 0 0 0 1\n", "line 1: field 4"),
        tum("nan", "a position that is not a number", "0 0 0 nan 0 0 0 1\n", "line 1: field 4"),
        tum("infinite", "an infinite position", "0 0 0 inf 0 0 0 1\n", "line 1: field 4"),
        tum("far", "a position beyond all maps", "0 0 0 1e300 0 0 0 1\n", "line 1: a coordinate"),
        tum("times", "times that do not ascend", &row.repeat(2), "line 2: a time of 0"),
        tum(
            "nanoseconds",
            "times in nanoseconds since 1970",
            "1700000000000000000 0 0 0 0 0 0 1\n",
            "line 1: a time",
        ),
        tum("long", "a quaternion that is no unit", "0 0 0 0 0 0 0 2\n", "line 1: a quaternion of length 2"),
        tum("zero", "a quaternion of zeros", "0 0 0 0 0 0 0 0\n", "line 1: a quaternion of length 0"),
        tum(
            "order",
            "a heading with the scalar first",
            "# t x y z qw qx qy qz\n0 0 0 0 1 0 0 0\n",
            "line 1: t x y z qw",
        ),
        tum("semicolons", "semicolons between the numbers", "0;0;0;0;0;0;0;1\n", "line 1: 1 fields"),
        tum("early", "poses that end before the rays", "-9 0 0 0 0 0 0 1\n-8 0 0 0 0 0 0 1\n", "rays.toml")
            .says(&["rays.toml"]),
        on_mesh(
            Case::of_file(
                "poses-binary",
                "bytes that are no text",
                RUN,
                "walk.tum",
                vec![0xff; 64],
                "byte 0",
            ),
            set("walk.tum", ""),
        ),
        on_mesh(Case::new("poses-missing", "no file", RUN, &["rays.toml", "walk.tum"]), set("walk.tum", "")),
        on_mesh(
            Case::new("poses-folder", "a folder in place of the file", RUN, &["rays.toml", "walk.tum"])
                .item("walk.tum", Item::Folder),
            set("walk.tum", ""),
        ),
        on_mesh(
            Case::new("poses-pipe", "a pipe in place of the file", RUN, &["rays.toml", "walk.mcap"])
                .item("walk.mcap", Item::Pipe),
            set("walk.mcap", odom),
        ),
        on_mesh(
            Case::new("poses-hole", "a file of a million million bytes", RUN, &["walk.tum"])
                .item("walk.tum", Item::Hole(row.into(), 1 << 40)),
            set("walk.tum", ""),
        ),
        bag("empty", "an empty bag", Vec::new(), odom, "a whole MCAP file"),
        bag("text", "poses as text in place of a bag", row.into(), odom, "a whole MCAP file"),
        bag("cut", "a bag that is cut off", BAG[..5000].to_vec(), odom, "a whole MCAP file"),
        bag(
            "chunk",
            "a chunk of eighteen million million million bytes",
            long_chunk,
            odom,
            "a whole MCAP file",
        ),
        bag("record", "a record of a million million bytes", long_record, odom, "a whole MCAP file"),
        bag("topics", "three topics with poses, and none is chosen", BAG.to_vec(), "", "poses_topic"),
        bag("topic", "a topic that is not there", BAG.to_vec(), "poses_topic = \"/gps\"", "topic /gps"),
        bag(
            "frames",
            "frames that are not there",
            BAG.to_vec(),
            "poses_frames = [\"map\", \"sky\"]",
            "\"sky\"",
        ),
        bag("one-frame", "one frame", BAG.to_vec(), "poses_frames = [\"map\"]", "rays 0.poses_frames")
            .says(&["rays.toml", "rays 0.poses_frames"]),
        bag("ros1", "messages in another encoding", bag_with(b"cdr", b"xml"), odom, "message 1 of /odom"),
        bag(
            "kind",
            "a topic of another kind of messages",
            bag_with(b"nav_msgs/msg/Odometry", b"nav_msgs/msg/MapGrids"),
            odom,
            "topic /odom",
        ),
        bag(
            "turn",
            "a quaternion that is no unit",
            bag_with(&1.0_f64.to_le_bytes(), &3.0_f64.to_le_bytes()),
            odom,
            "message 1 of /odom",
        ),
        bag(
            "stamps",
            "stamps that do not ascend",
            bag_with(&500_000_000_u32.to_le_bytes(), &0_u32.to_le_bytes()),
            odom,
            "message 3 of /odom",
        ),
    ]
}
