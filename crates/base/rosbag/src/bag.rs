//! The bag: one MCAP file that grows message by message, and its `metadata.yaml`.

use std::collections::BTreeMap;
use std::io;
use std::path::{Path, PathBuf};

use byteorder::LittleEndian;
use mcap::records::MessageHeader;
use mcap::{Attachment, Compression, McapError, WriteOptions, Writer};
use raypencil_files::{FileError, GrowingFile, create_dir_all, remove_file, write_atomically};

use crate::definitions::definition;
use crate::messages::{Message, Stamp};
use crate::metadata::{TopicLine, metadata, qos};

/// Name of a topic, and what a player does with it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Topic {
    name: String,
    latched: bool,
}

impl Topic {
    /// Topic of a name, which needs no quotes in YAML: letters, digits, `_` and `/`, and a `/` first.
    pub fn new(name: impl Into<String>) -> Self {
        Self { name: name.into(), latched: false }
    }

    /// Topic whose last message later listeners get too, as that of fixed transforms.
    pub fn latched(name: impl Into<String>) -> Self {
        Self { name: name.into(), latched: true }
    }
}

/// Topic with its messages so far.
#[derive(Debug)]
struct Channel {
    topic: Topic,
    kind: &'static str,
    id: u16,
    messages: u32,
}

/// Bag in progress. Dropped before it is finished, it leaves an empty folder.
pub struct BagWriter {
    folder: PathBuf,
    name: String,
    file: Writer<GrowingFile>,
    channels: Vec<Channel>,
    /// Earliest and latest time of a message, nanoseconds.
    span: Option<(u64, u64)>,
}

impl std::fmt::Debug for BagWriter {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("BagWriter").field("folder", &self.folder).field("channels", &self.channels).finish()
    }
}

impl BagWriter {
    /// New bag: a folder of this path, and in it `NAME_0.mcap`, where NAME is the folder's. Earlier files of these names
    /// are replaced; the mark of a complete bag, `metadata.yaml`, is removed at once.
    ///
    /// # Errors
    /// The file or folder that could not be made, and the reason.
    pub fn create(folder: &Path) -> Result<Self, FileError> {
        let name = folder.file_name().and_then(|name| name.to_str()).unwrap_or("bag").to_string();
        create_dir_all(folder).map_err(|error| FileError::io(folder, "create", error))?;
        let mark = folder.join("metadata.yaml");
        match remove_file(&mark) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => {
                return Err(FileError::io(&mark, "remove", error));
            }
            _ => {}
        }
        let path = folder.join(format!("{name}_0.mcap"));
        let options =
            WriteOptions::new().profile("ros2").library("raypencil").compression(Some(Compression::Lz4));
        let file = options.create(GrowingFile::create(&path)?).map_err(|error| failed(&path, error))?;
        Ok(Self { folder: folder.to_path_buf(), name, file, channels: Vec::new(), span: None })
    }

    /// Name of the MCAP file.
    fn file_name(&self) -> String {
        format!("{}_0.mcap", self.name)
    }

    /// Path of the MCAP file.
    fn path(&self) -> PathBuf {
        self.folder.join(self.file_name())
    }

    /// Adds a message at a time. A topic has messages of one type.
    ///
    /// # Errors
    /// The error of the file system, with the path.
    ///
    /// # Panics
    /// If the topic has messages of another type already.
    pub fn write<M: Message>(&mut self, topic: &Topic, at: Stamp, message: &M) -> Result<(), FileError> {
        let index = match self.channels.iter().position(|channel| channel.topic.name == topic.name) {
            Some(index) => index,
            None => self.add_channel::<M>(topic)?,
        };
        let channel = &mut self.channels[index];
        assert_eq!(channel.kind, M::TYPE, "messages of {}", topic.name);
        // Representation identifier of CDR, little endian, and two bytes of options.
        let mut data = vec![0, 1, 0, 0];
        data.extend(cdr_encoding::to_vec::<M, LittleEndian>(message).expect("a message has a CDR"));
        let time = at.nanoseconds();
        let (sequence, log_time, publish_time) = (channel.messages, time, time);
        let header = MessageHeader { channel_id: channel.id, sequence, log_time, publish_time };
        channel.messages += 1;
        self.span = Some(self.span.map_or((time, time), |(first, last)| (first.min(time), last.max(time))));
        let path = self.path();
        self.file.write_to_known_channel(&header, &data).map_err(|error| failed(&path, error))
    }

    /// Adds a topic and gives its index.
    fn add_channel<M: Message>(&mut self, topic: &Topic) -> Result<usize, FileError> {
        let path = self.path();
        let text = definition(M::TYPE);
        let mut add = || {
            let schema = self.file.add_schema(M::TYPE, "ros2msg", text.as_bytes())?;
            let about = BTreeMap::from([("offered_qos_profiles".to_string(), qos(topic.latched))]);
            self.file.add_channel(schema, &topic.name, "cdr", &about)
        };
        let id = add().map_err(|error| failed(&path, error))?;
        self.channels.push(Channel { topic: topic.clone(), kind: M::TYPE, id, messages: 0 });
        Ok(self.channels.len() - 1)
    }

    /// Puts a whole file into the bag, beside the messages: readers that know nothing of it leave it alone.
    ///
    /// # Errors
    /// The error of the file system, with the path.
    pub fn attach(&mut self, name: &str, media_type: &str, at: Stamp, data: &[u8]) -> Result<(), FileError> {
        let path = self.path();
        let time = at.nanoseconds();
        let attachment = Attachment {
            log_time: time,
            create_time: time,
            name: name.into(),
            media_type: media_type.into(),
            data: data.into(),
        };
        self.file.attach(&attachment).map_err(|error| failed(&path, error))
    }

    /// Puts the complete bag in its place: the MCAP file, then `metadata.yaml`.
    ///
    /// # Errors
    /// The error of the file system, with the path.
    pub fn finish(mut self) -> Result<(), FileError> {
        let path = self.path();
        self.file.finish().map_err(|error| failed(&path, error))?;
        let topics: Vec<TopicLine> = self
            .channels
            .iter()
            .map(|channel| TopicLine {
                name: &channel.topic.name,
                kind: channel.kind,
                qos: qos(channel.topic.latched),
                messages: channel.messages.into(),
            })
            .collect();
        let (first, last) = self.span.unwrap_or_default();
        let text = metadata(&self.file_name(), &topics, first, last);
        let mark = self.folder.join("metadata.yaml");
        self.file.into_inner().finish()?;
        write_atomically(mark, |file| file.write_all(text.as_bytes()))
    }
}

/// Error of the container at a path. Whatever is not the file system's cannot happen: channels are known, and sizes
/// small.
fn failed(path: &Path, error: McapError) -> FileError {
    let source = match error {
        McapError::Io(source) => source,
        other => io::Error::other(other),
    };
    FileError::io(path, "write", source)
}
