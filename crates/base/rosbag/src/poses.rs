//! Where frames are by the word of a bag, of any program: `nav_msgs/Odometry`, `geometry_msgs/PoseStamped`, `tf2_msgs/TFMessage`.

use std::collections::BTreeMap;
use std::io::Read;

use mcap::records::Record;
use raypencil_files::Fault;

use crate::cdr::Cdr;
use crate::records::{MAX_LISTED, each_record};

/// Maximum number of poses of all topics together.
const MAX_POSES: usize = 1 << 22;

/// Pose of one frame in another, and when.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BagPose {
    /// Number of the message among those of its topic, from 1.
    pub message: u64,
    /// Its stamp, seconds.
    pub time_s: f64,
    /// Origin of the child frame in the parent, metres.
    pub position: [f64; 3],
    /// Rotation from the child's axes to the parent's: x, y, z, w.
    pub rotation: [f64; 4],
}

/// Which of a bag's poses are meant.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct PoseChoice<'a> {
    /// Their topic; `None`: any.
    pub topic: Option<&'a str>,
    /// Parent and child frame; `None`: any.
    pub frames: Option<[&'a str; 2]>,
}

/// Poses of one frame in another by one topic, in the order of the bag.
#[derive(Debug, Clone, PartialEq)]
pub struct BagPoses {
    /// The topic.
    pub topic: String,
    /// The poses, at least one.
    pub poses: Vec<BagPose>,
}

/// The kinds of messages that have poses.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Odometry,
    PoseStamped,
    Tf,
}

impl Kind {
    const NAMES: &str = "nav_msgs/msg/Odometry, geometry_msgs/msg/PoseStamped or tf2_msgs/msg/TFMessage";

    /// The kind of a schema, with or without the `msg` of ROS 2.
    fn of(schema: &str) -> Option<Self> {
        match schema {
            "nav_msgs/msg/Odometry" | "nav_msgs/Odometry" => Some(Self::Odometry),
            "geometry_msgs/msg/PoseStamped" | "geometry_msgs/PoseStamped" => Some(Self::PoseStamped),
            "tf2_msgs/msg/TFMessage" | "tf2_msgs/TFMessage" => Some(Self::Tf),
            _ => None,
        }
    }
}

struct Channel {
    topic: String,
    encoding: String,
    schema: String,
    kind: Option<Kind>,
}

/// Topic, parent and child frame. The child of a `PoseStamped` has no name.
type Key = (String, String, String);

/// Reads the poses of an MCAP file of `length` bytes; all of them belong to one topic and one pair of frames. Chunks may be compressed
/// with LZ4 or Zstandard.
///
/// # Errors
/// No MCAP file, or a broken one; no message of these kinds, or none of the choice; several topics or pairs of frames; messages that
/// are not CDR, or end too early. The fault says where.
pub fn read_poses(stream: impl Read, length: u64, choice: &PoseChoice<'_>) -> Result<BagPoses, Fault> {
    let mut found = Found::default();
    each_record(stream, length, |record| found.take(record, choice))?;
    found.only(choice)
}

/// What was found so far.
#[derive(Default)]
struct Found {
    schemas: BTreeMap<u16, String>,
    channels: BTreeMap<u16, Channel>,
    messages: BTreeMap<u16, u64>,
    poses: BTreeMap<Key, Vec<BagPose>>,
    count: usize,
}

impl Found {
    fn take(&mut self, record: Record<'_>, choice: &PoseChoice<'_>) -> Result<(), Fault> {
        match record {
            Record::Schema { header, .. } => drop(self.schemas.insert(header.id, header.name)),
            Record::Channel(channel) => {
                let schema = self.schemas.get(&channel.schema_id).cloned().unwrap_or_default();
                let kind = Kind::of(&schema);
                let mcap::records::Channel { id, topic, message_encoding: encoding, .. } = channel;
                self.channels.insert(id, Channel { topic, encoding, schema, kind });
            }
            Record::Message { header, data } => {
                let Some(channel) = self.channels.get(&header.channel_id) else { return Ok(()) };
                let (Some(kind), true) =
                    (channel.kind, choice.topic.is_none_or(|topic| topic == channel.topic))
                else {
                    return Ok(());
                };
                let number = self.messages.entry(header.channel_id).or_default();
                *number += 1;
                let place = || format!("message {number} of {}", channel.topic);
                if channel.encoding != "cdr" {
                    return Err(Fault::new(
                        place(),
                        format!("the encoding {:?}", channel.encoding),
                        "cdr, that of ROS 2",
                    ));
                }
                let poses = poses_of(kind, &data, *number)
                    .map_err(|found| Fault::new(place(), found, format!("the CDR of {}", channel.schema)))?;
                self.count += poses.len();
                if self.count > MAX_POSES {
                    return Err(Fault::new(
                        place(),
                        "more poses than there is room for",
                        format!("at most {MAX_POSES}"),
                    ));
                }
                for (parent, child, pose) in poses {
                    if choice.frames.is_none_or(|frames| frames == [parent.as_str(), child.as_str()]) {
                        self.poses.entry((channel.topic.clone(), parent, child)).or_default().push(pose);
                    }
                }
            }
            _ => {}
        }
        Ok(())
    }

    /// The poses, if they are of one topic and of one pair of frames.
    fn only(mut self, choice: &PoseChoice<'_>) -> Result<BagPoses, Fault> {
        let place = choice.topic.map_or("file".to_string(), |topic| format!("topic {topic}"));
        let listed = |keys: &BTreeMap<Key, Vec<BagPose>>| {
            let words = |(topic, parent, child): &Key| match child.as_str() {
                "" => format!("{topic} (in {parent})"),
                child => format!("{topic} ({child} in {parent})"),
            };
            let more = if keys.len() > MAX_LISTED { ", ..." } else { "" };
            keys.keys().take(MAX_LISTED).map(words).collect::<Vec<_>>().join(", ") + more
        };
        if self.poses.len() > 1 {
            let found = format!("poses of {}", listed(&self.poses));
            return Err(Fault::new(
                place,
                found,
                "one: `poses_topic` and `poses_frames` = [parent, child] choose it",
            ));
        }
        if let Some(((topic, ..), poses)) = self.poses.pop_first() {
            return Ok(BagPoses { topic, poses });
        }
        let of_topic =
            choice.topic.and_then(|topic| self.channels.values().find(|channel| channel.topic == topic));
        let found = match (of_topic, choice.frames) {
            (Some(Channel { kind: None, schema, .. }), _) => format!("messages of {schema:?}"),
            (_, Some([parent, child])) => format!("no pose of {child:?} in {parent:?}"),
            _ => "no pose".to_string(),
        };
        let with_poses = self.channels.values().filter(|channel| channel.kind.is_some());
        let topics: Vec<&str> = with_poses.map(|channel| channel.topic.as_str()).take(MAX_LISTED).collect();
        let there = match topics.as_slice() {
            [] => String::new(),
            topics => format!("; the file has {}", topics.join(", ")),
        };
        Err(Fault::new(place, found, format!("messages of {}{there}", Kind::NAMES)))
    }
}

/// The poses of a message with their frames; in words what is wrong with it.
fn poses_of(kind: Kind, data: &[u8], message: u64) -> Result<Vec<(String, String, BagPose)>, String> {
    let mut cdr = Cdr::new(data)?;
    let mut poses = Vec::new();
    let count = if kind == Kind::Tf { cdr.word()? } else { 1 };
    for _ in 0..count {
        let time_s = cdr.stamp()?;
        let parent = cdr.text()?;
        let child = if kind == Kind::PoseStamped { String::new() } else { cdr.text()? };
        let numbers = [(); 7].map(|()| cdr.real());
        let mut pose = [0.0; 7];
        for (number, read) in pose.iter_mut().zip(numbers) {
            *number = read?;
        }
        let [x, y, z, qx, qy, qz, qw] = pose;
        poses.push((
            parent,
            child,
            BagPose { message, time_s, position: [x, y, z], rotation: [qx, qy, qz, qw] },
        ));
    }
    Ok(poses)
}
