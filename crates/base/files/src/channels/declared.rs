//! What somebody declares about a recording: which of its channels is which map, and the unit of its whole numbers.

use std::collections::BTreeSet;
use std::path::Path;
use std::str::FromStr;

use crate::channels::channel::{Used, inventory};
use crate::channels::found::{Found, in_metres};
use crate::error::{Fault, FileError};
use crate::values::{Step, Storage, Values};

/// A channel of a file that is declared to be a map.
///
/// ```
/// use raypencil_files::DeclaredChannel;
///
/// let declared: DeclaredChannel = "depth.Z=ViewLayer.Depth.Z".parse()?;
/// assert_eq!((declared.map.as_str(), declared.channel.as_str()), ("depth.Z", "ViewLayer.Depth.Z"));
/// assert!("depth.Z".parse::<DeclaredChannel>().is_err());
/// # Ok::<(), String>(())
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct DeclaredChannel {
    /// The map: the end of its key such as `depth.Z`, for every folder that has the channel; or the whole of it, such as
    /// `camera/depth.Z`.
    pub map: String,
    /// The channel as its file calls it; with as much of its path before it as is needed to tell it from others.
    pub channel: String,
}

impl FromStr for DeclaredChannel {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text.split_once('=') {
            Some((map, channel)) => Self::new(map, channel),
            None => Err(format!("{text:?}; expected MAP=CHANNEL, such as depth.Z=ViewLayer.Depth.Z")),
        }
    }
}

impl DeclaredChannel {
    /// A map and its channel.
    ///
    /// # Errors
    /// What is wrong with one of the names, in words.
    pub fn new(map: &str, channel: &str) -> Result<Self, String> {
        let is_path = |text: &str| !text.is_empty() && text.split('/').all(|part| !part.is_empty());
        if !is_path(map) || map.split('/').count() > 2 {
            return Err(format!("{map:?}; expected a map such as depth.Z or camera/depth.Z"));
        }
        if !is_path(channel) {
            return Err(format!("{channel:?}; expected the name of a channel"));
        }
        Ok(Self { map: map.to_string(), channel: channel.to_string() })
    }
}

/// What is declared about a recording.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Declared {
    /// Channels that are maps of another name.
    pub channels: Vec<DeclaredChannel>,
    /// Metres that a unit of the whole numbers in maps of lengths stands for; 0 then means that nothing is hit.
    pub scale: Option<f64>,
    /// One more whole number that means the same, as the file has it.
    pub miss: Option<f64>,
    /// Whether what is declared may be of another recording: a channel that is not there is passed over.
    pub may_be_absent: bool,
}

/// Maps of lengths that may be whole numbers: those of a depth image.
const LENGTHS: [&str; 3] = ["range.T", "depth.Z", "view.Z"];

impl Declared {
    /// The same without what concerned nothing in a recording, as its [`Channels`](crate::Channels) say.
    pub fn used(mut self, used: &Used) -> Self {
        self.channels.retain(|one| used.maps.contains(&one.map));
        self.scale = self.scale.filter(|_| used.scale);
        self
    }

    /// Gives the declared channels the keys of their maps, and whole numbers their unit.
    pub(super) fn apply(&self, found: &mut [Found], root: &Path) -> Result<Used, FileError> {
        let mut used = Used { maps: self.rename(found, root)?, scale: false };
        let Some(scale) = self.scale else { return Ok(used) };
        let refuse = |found: String, expected: &str| {
            Err(FileError::recording(root, Fault::new(format!("scale {scale}"), found, expected)))
        };
        let Some(step) = Step::new(scale) else {
            return refuse("no length of a unit".into(), "metres for each unit, such as 0.001");
        };
        for one in found.iter_mut() {
            let is_length = LENGTHS.contains(&one.key.rsplit('/').next().unwrap_or_default());
            if let (true, Values::Wholes(image)) = (is_length, &one.channel.values) {
                one.channel.values = in_metres(image, scale, self.miss);
                one.channel.storage = Storage::Steps(step);
                used.scale = true;
            }
        }
        if !used.scale && !self.may_be_absent {
            let all = inventory(found.iter().map(|one| (one.key.as_str(), &one.channel)), root);
            let expected =
                "a map of whole numbers called range.T, depth.Z or view.Z, by its file or as declared";
            return refuse(format!("no map that it concerns in {all}"), expected);
        }
        Ok(used)
    }

    /// Whether a channel is declared to be some map.
    fn concerns(&self, found: &Found) -> bool {
        self.channels.iter().any(|one| found.names.contains(&one.channel))
    }

    /// Returns the maps that were given.
    fn rename(&self, found: &mut [Found], root: &Path) -> Result<BTreeSet<String>, FileError> {
        let mut maps = BTreeSet::new();
        let mut keys: Vec<Option<String>> = found.iter().map(|_| None).collect();
        let mut given = BTreeSet::new();
        for DeclaredChannel { map, channel } in &self.channels {
            let refuse = |found: String, expected: String| {
                let place = format!("channel {channel:?}, declared to be {map}");
                Err(FileError::recording(root, Fault::new(place, found, expected)))
            };
            let is_called = |index: &usize| found[*index].names.contains(channel);
            let all: Vec<usize> = (0..found.len()).filter(is_called).collect();
            if all.is_empty() && self.may_be_absent {
                continue;
            }
            maps.insert(map.clone());
            if all.is_empty() {
                let there = inventory(found.iter().map(|one| (one.names[0].as_str(), &one.channel)), root);
                return refuse("not there".into(), format!("one of {there}"));
            }
            // In which folder the map is, and which channels are called so there.
            let mut folders: Vec<(Option<&str>, Vec<usize>)> = Vec::new();
            let name = match map.split_once('/') {
                Some((folder, name)) => {
                    let own: Vec<usize> = all
                        .iter()
                        .copied()
                        .filter(|&index| found[index].head.as_deref() == Some(folder))
                        .collect();
                    folders.push((Some(folder), if own.is_empty() { all } else { own }));
                    name
                }
                None => {
                    for index in all {
                        let head = found[index].head.as_deref();
                        match folders.iter_mut().find(|(other, _)| *other == head) {
                            Some((_, channels)) => channels.push(index),
                            None => folders.push((head, vec![index])),
                        }
                    }
                    map.as_str()
                }
            };
            for (folder, channels) in folders {
                let [index] = channels.as_slice() else {
                    let paths: Vec<&str> = channels
                        .iter()
                        .filter_map(|&index| {
                            found[index].names.iter().rev().max_by_key(|name| name.len()).map(String::as_str)
                        })
                        .collect();
                    return refuse(
                        format!("{} channels of that name", channels.len()),
                        format!("one of {}", paths.join(", ")),
                    );
                };
                let key = folder.map_or(name.to_string(), |folder| format!("{folder}/{name}"));
                if let Some(other) = &keys[*index] {
                    return refuse(
                        format!("declared to be {other} as well"),
                        "one map for each channel".into(),
                    );
                }
                if !given.insert(key.clone()) {
                    return refuse(format!("{key} is declared twice"), "one channel for each map".into());
                }
                let is_own =
                    |other: &&Found| other.key == key && other.channel.file == found[*index].channel.file;
                if let Some(other) = found.iter().find(is_own).filter(|other| !self.concerns(other)) {
                    let words = format!("its file has a channel of that name, {}", other.names[0]);
                    return refuse(words, "another map for one of them".into());
                }
                keys[*index] = Some(key);
            }
        }
        for (one, key) in found.iter_mut().zip(keys) {
            if let Some(key) = key {
                one.key = key;
            }
        }
        Ok(maps)
    }
}
