//! The point clouds of a bag, of any program: `sensor_msgs/PointCloud2`.

use std::collections::{BTreeMap, HashMap};
use std::io::Read;

use mcap::records::Record;
use raypencil_files::Fault;

use crate::cdr::Cdr;
use crate::messages::{Header, Message as _, PointCloud2, PointField, Stamp};
use crate::records::{MAX_LISTED, each_record};

/// Maximum number of fields of a cloud.
const MAX_FIELDS: u32 = 1024;

/// Bytes of a point, at least: x, y and z.
const MIN_POINT_BYTES: usize = 3;

/// Which of a bag's clouds is meant.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct CloudChoice<'a> {
    /// Its topic; `None`: the only one with clouds.
    pub topic: Option<&'a str>,
    /// Its number among the clouds of the topic, from 1; `None`: the only one.
    pub message: Option<u64>,
}

/// A cloud of a bag.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct BagCloud {
    /// Its topic.
    pub topic: String,
    /// Its number among the clouds of the topic, from 1.
    pub message: u64,
    /// When the earliest message of the bag was recorded, nanoseconds.
    pub begin_ns: u64,
    /// The cloud. Its numbers are as the bag has them: nothing of `data` was looked at.
    pub cloud: PointCloud2,
}

/// Reads one point cloud of an MCAP file of `length` bytes. Chunks may be compressed with LZ4 or Zstandard.
///
/// # Errors
/// No MCAP file, or a broken one; no cloud, or none of the choice; several topics or clouds and no choice; a message that is not CDR, or ends
/// too early. The fault says where.
pub fn read_point_cloud(stream: impl Read, length: u64, choice: &CloudChoice<'_>) -> Result<BagCloud, Fault> {
    let mut found = Found::default();
    each_record(stream, length, |record| found.take(record, choice))?;
    found.only(choice)
}

/// The number of points of the largest cloud of an MCAP file of `length` bytes, by the words of its messages, but of no more than their bytes can
/// hold; `None` if it has none, or cannot be read.
pub fn largest_point_cloud(stream: impl Read, length: u64) -> Option<u64> {
    let (mut clouds, mut largest) = (Clouds::default(), None);
    let read = each_record(stream, length, |record| {
        if let Some((_, data)) = clouds.take(record)
            && let Ok(points) = Cdr::new(&data).and_then(|mut cdr| size(&mut cdr))
        {
            largest = largest.max(Some(points.min((data.len() / MIN_POINT_BYTES) as u64)));
        }
        Ok(())
    });
    read.ok()?;
    largest
}

/// Points by the head of a message.
fn size(cdr: &mut Cdr<'_>) -> Result<u64, String> {
    let Head { height, width, .. } = head(cdr)?;
    Ok(u64::from(height) * u64::from(width))
}

/// The topics of a bag, and which of them have clouds.
#[derive(Default)]
struct Clouds {
    schemas: HashMap<u16, String>,
    topics: HashMap<u16, Topic>,
}

/// A topic, and how its messages are encoded.
struct Topic {
    name: String,
    encoding: String,
    has_clouds: bool,
}

impl Clouds {
    /// A message of a topic with clouds, and its bytes.
    fn take<'a, 'b>(&'a mut self, record: Record<'b>) -> Option<(&'a Topic, std::borrow::Cow<'b, [u8]>)> {
        match record {
            Record::Schema { header, .. } => drop(self.schemas.insert(header.id, header.name)),
            Record::Channel(channel) => {
                let schema = self.schemas.get(&channel.schema_id).map_or("", String::as_str);
                let has_clouds = [PointCloud2::TYPE, "sensor_msgs/PointCloud2"].contains(&schema);
                let topic = Topic { name: channel.topic, encoding: channel.message_encoding, has_clouds };
                self.topics.insert(channel.id, topic);
            }
            Record::Message { header, data } => {
                let topic = self.topics.get(&header.channel_id).filter(|topic| topic.has_clouds)?;
                return Some((topic, data));
            }
            _ => {}
        }
        None
    }
}

/// What was found so far: of each topic the number of its clouds, and the one that is meant.
#[derive(Default)]
struct Found {
    clouds: Clouds,
    topics: BTreeMap<String, u64>,
    chosen: Option<BagCloud>,
    /// When the earliest message of any topic was recorded, nanoseconds.
    begin_ns: Option<u64>,
}

impl Found {
    fn take(&mut self, record: Record<'_>, choice: &CloudChoice<'_>) -> Result<(), Fault> {
        if let Record::Message { header, .. } = &record {
            let at = header.log_time;
            self.begin_ns = Some(self.begin_ns.map_or(at, |begin| begin.min(at)));
        }
        let Some((topic, data)) = self.clouds.take(record) else { return Ok(()) };
        let message = self.topics.entry(topic.name.clone()).or_default();
        *message += 1;
        let is_meant = choice.topic.is_none_or(|chosen| chosen == topic.name);
        if self.chosen.is_some() || !is_meant || *message != choice.message.unwrap_or(1) {
            return Ok(());
        }
        let place = || format!("message {message} of {}", topic.name);
        if topic.encoding != "cdr" {
            let found = format!("the encoding {:?}", topic.encoding);
            return Err(Fault::new(place(), found, "cdr, that of ROS 2"));
        }
        let cloud = point_cloud(&data)
            .map_err(|found| Fault::new(place(), found, format!("the CDR of {}", PointCloud2::TYPE)))?;
        self.chosen = Some(BagCloud { topic: topic.name.clone(), message: *message, begin_ns: 0, cloud });
        Ok(())
    }

    /// The cloud, if it is the only one of the choice.
    fn only(self, choice: &CloudChoice<'_>) -> Result<BagCloud, Fault> {
        let listed = || {
            let words: Vec<String> = self
                .topics
                .iter()
                .take(MAX_LISTED)
                .map(|(topic, count)| format!("{topic} ({count})"))
                .collect();
            words.join(", ") + if self.topics.len() > MAX_LISTED { ", ..." } else { "" }
        };
        let place = choice.topic.map_or("file".to_string(), |topic| format!("topic {topic}"));
        let expected = "a cloud, as messages of sensor_msgs/msg/PointCloud2";
        if self.topics.is_empty() {
            return Err(Fault::new(place, "no point cloud", expected));
        }
        if choice.topic.is_none() && self.topics.len() > 1 {
            return Err(Fault::new(
                place,
                format!("clouds of {}", listed()),
                "one topic: `--topic` chooses it",
            ));
        }
        let named = match choice.topic {
            Some(topic) => self.topics.get_key_value(topic),
            None => self.topics.first_key_value(),
        };
        let Some((topic, &count)) = named else {
            return Err(Fault::new(
                place,
                "no point cloud",
                format!("{expected}; the file has {}", listed()),
            ));
        };
        let place = format!("topic {topic}");
        let counted = if count == 1 { "1 cloud".to_string() } else { format!("{count} clouds") };
        match self.chosen {
            Some(_) if choice.message.is_none() && count > 1 => {
                Err(Fault::new(place, counted, format!("one: `--message` 1 to {count} chooses it")))
            }
            // Messages need not be in the order of time: the earliest one may follow the cloud.
            Some(chosen) => Ok(BagCloud { begin_ns: self.begin_ns.unwrap_or_default(), ..chosen }),
            None => {
                let number = choice.message.unwrap_or(1);
                Err(Fault::new(
                    place,
                    format!("{counted}, and none of number {number}"),
                    format!("1 to {count}"),
                ))
            }
        }
    }
}

/// The first values of a cloud.
struct Head {
    header: Header,
    height: u32,
    width: u32,
}

fn head(cdr: &mut Cdr<'_>) -> Result<Head, String> {
    let stamp = Stamp { sec: cdr.word()?.cast_signed(), nanosec: cdr.word()? };
    let header = Header { stamp, frame_id: cdr.text()? };
    Ok(Head { header, height: cdr.word()?, width: cdr.word()? })
}

/// The cloud of a message; in words what is wrong with it.
fn point_cloud(data: &[u8]) -> Result<PointCloud2, String> {
    let mut cdr = Cdr::new(data)?;
    let Head { header, height, width } = head(&mut cdr)?;
    let count = cdr.word()?;
    if count > MAX_FIELDS {
        return Err(format!("{count} fields, more than {MAX_FIELDS}"));
    }
    let field = |_| -> Result<PointField, String> {
        Ok(PointField { name: cdr.text()?, offset: cdr.word()?, datatype: cdr.byte()?, count: cdr.word()? })
    };
    let fields = (0..count).map(field).collect::<Result<_, _>>()?;
    let is_bigendian = cdr.byte()? != 0;
    let (point_step, row_step) = (cdr.word()?, cdr.word()?);
    let length = cdr.word()? as usize;
    let data = cdr.bytes(length)?.to_vec().into();
    let is_dense = cdr.byte()? != 0;
    Ok(PointCloud2 { header, height, width, fields, is_bigendian, point_step, row_step, data, is_dense })
}
