//! `metadata.yaml` of a bag. (rosbag2_storage, BagMetadata version 5: read by ROS 2 Humble and later)

use std::fmt::Write as _;

/// What a topic is, as rosbag2 tells a player.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct TopicLine<'a> {
    pub name: &'a str,
    pub kind: &'static str,
    pub qos: String,
    pub messages: u64,
}

/// Text of `metadata.yaml`. `first` and `last` are the earliest and the latest time of a message, nanoseconds.
pub(crate) fn metadata(file: &str, topics: &[TopicLine], first: u64, last: u64) -> String {
    let (duration, count) = (last - first, topics.iter().map(|topic| topic.messages).sum::<u64>());
    let mut lines = String::from("rosbag2_bagfile_information:\n  version: 5\n  storage_identifier: mcap\n");
    // Writing into a text cannot fail.
    let _ = write!(
        lines,
        "  duration:\n    nanoseconds: {duration}\n  starting_time:\n    nanoseconds_since_epoch: {first}\n  \
         message_count: {count}\n  topics_with_message_count:\n"
    );
    for TopicLine { name, kind, qos, messages } in topics {
        let qos: String = qos.lines().map(|line| format!("          {line}\n")).collect();
        let _ = write!(
            lines,
            "    - topic_metadata:\n        name: {name}\n        type: {kind}\n        serialization_format: cdr\n        \
             offered_qos_profiles: |\n{qos}      message_count: {messages}\n"
        );
    }
    let _ = write!(
        lines,
        "  compression_format: \"\"\n  compression_mode: \"\"\n  relative_file_paths:\n    - {file}\n  files:\n    - path: \
         {file}\n      starting_time:\n        nanoseconds_since_epoch: {first}\n      duration:\n        nanoseconds: \
         {duration}\n      message_count: {count}\n"
    );
    lines
}

/// Quality of service of a topic, as a player needs it to publish again. `latched`: later listeners get the last message
/// too.
pub(crate) fn qos(latched: bool) -> String {
    let durability = if latched { 1 } else { 2 };
    let forever = "sec: 9223372036\n    nsec: 854775807";
    format!(
        "- history: 1\n  depth: 10\n  reliability: 1\n  durability: {durability}\n  deadline:\n    {forever}\n  lifespan:\n    \
         {forever}\n  liveliness: 1\n  liveliness_lease_duration:\n    {forever}\n  avoid_ros_namespace_conventions: false\n"
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_text_has_the_lines_that_rosbag2_writes() {
        let topic = TopicLine {
            name: "/tf_static",
            kind: "tf2_msgs/msg/TFMessage",
            qos: "- durability: 1\n  depth: 10\n".into(),
            messages: 1,
        };
        let text = metadata("drive_0.mcap", &[topic], 1_000_000_000, 3_500_000_000);
        let expected = "\
rosbag2_bagfile_information:
  version: 5
  storage_identifier: mcap
  duration:
    nanoseconds: 2500000000
  starting_time:
    nanoseconds_since_epoch: 1000000000
  message_count: 1
  topics_with_message_count:
    - topic_metadata:
        name: /tf_static
        type: tf2_msgs/msg/TFMessage
        serialization_format: cdr
        offered_qos_profiles: |
          - durability: 1
            depth: 10
      message_count: 1
  compression_format: \"\"
  compression_mode: \"\"
  relative_file_paths:
    - drive_0.mcap
  files:
    - path: drive_0.mcap
      starting_time:
        nanoseconds_since_epoch: 1000000000
      duration:
        nanoseconds: 2500000000
      message_count: 1
";
        assert_eq!(text, expected);
        assert!(qos(true).contains("durability: 1\n") && qos(false).contains("durability: 2\n"));
    }
}
