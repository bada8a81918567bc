//! A channel as it was found in a file: its key, and the names by which it may be declared to be a map.

use std::collections::BTreeMap;
use std::path::Path;

use raypencil_scene::Image;

use crate::channels::channel::Channel;
use crate::channels::find::{RecordingFile, stem};
use crate::exr::{ExrPart, Raster, convert};
use crate::values::{Array, Storage, Values};

/// A channel of a file.
#[derive(Debug)]
pub(super) struct Found {
    /// Its key.
    pub key: String,
    /// The first folder of its key; `None` if it is in none.
    pub head: Option<String>,
    /// The names by which it may be declared to be a map; the first is the one that messages show.
    pub names: Vec<String>,
    pub channel: Channel,
}

impl Found {
    /// A component of an array whose key is `stem`.
    fn of_array(stem: &str, file: &Path, component: &str, storage: Storage, values: Values) -> Self {
        let key = if component.is_empty() { stem.to_string() } else { format!("{stem}.{component}") };
        let channel = Channel { file: file.to_path_buf(), name: component.to_string(), storage, values };
        Self::of_channel(key, channel)
    }

    /// A channel of an array, or a component of one, that has this key.
    pub(super) fn of_channel(key: String, channel: Channel) -> Self {
        let head = key.split_once('/').map(|(head, _)| head.to_string());
        let own = key.rsplit('/').next().unwrap_or(&key).to_string();
        let names = [vec![own], tails(&key)].concat();
        Self { key, head, names, channel }
    }
}

/// The ends of a path, the shortest first: `b/c` and `a/b/c` of `a/b/c`, and its last part too.
fn tails(path: &str) -> Vec<String> {
    let starts = path.match_indices('/').map(|(at, _)| at + 1).chain([0]);
    let mut tails: Vec<String> = starts.map(|at| path[at..].to_string()).collect();
    tails.sort_by_key(String::len);
    tails
}

/// The components of an array: `key` is that of a single one.
pub(super) fn of_array(key: &str, file: &Path, array: Array) -> Vec<Found> {
    let Array { storage, planes } = array;
    let count = planes.len();
    let found = |(index, values)| Found::of_array(key, file, &component(index, count), storage, values);
    planes.into_iter().enumerate().map(found).collect()
}

/// Name of a component: empty if it is the only one; X, Y, Z if there are two or three; else its number.
fn component(index: usize, count: usize) -> String {
    match count {
        1 => String::new(),
        2 | 3 => ["X", "Y", "Z"][index].to_string(),
        _ => index.to_string(),
    }
}

/// The key of a file that holds one array.
pub(super) fn array_key(file: &RecordingFile) -> String {
    match &file.stem {
        Some(stem) => stem.clone(),
        None => stem(&file.path),
    }
}

/// The channels of an OpenEXR file.
pub(super) fn of_exr(file: &RecordingFile, parts: Vec<ExrPart>) -> Vec<Found> {
    let has_parts = parts.len() > 1;
    // The parts of two eyes or cameras do not make one recording, whatever their channels are called.
    let has_views = parts.iter().any(|part| part.view != parts[0].view);
    let mut count: BTreeMap<String, usize> = BTreeMap::new();
    for name in parts.iter().flat_map(|part| part.map.channels.keys()) {
        *count.entry(name.clone()).or_default() += 1;
    }
    let as_array = components_of_array(file, &parts);
    let mut found = Vec::new();
    for ExrPart { name: part, map, .. } in parts {
        for (name, raster) in map.channels {
            let (storage, values) = match raster {
                Raster::U32(image) => (Storage::Whole, Values::Wholes(image)),
                Raster::F32(image) => {
                    let storage = if map.halves.contains(&name) { Storage::F16 } else { Storage::F32 };
                    (storage, Values::Reals(convert(&image, f64::from)))
                }
            };
            let of_part = format!("{part}/{name}");
            let inner = match has_parts && (has_views || count[&name] > 1) {
                true => &of_part,
                false => &name,
            };
            let shown = if has_parts { of_part.clone() } else { name.clone() };
            let key = match (&file.stem, as_array.iter().find(|(channel, _)| *channel == name)) {
                (Some(stem), Some((_, ""))) => stem.clone(),
                (Some(stem), Some((_, component))) => format!("{stem}.{component}"),
                (Some(stem), None) => format!("{stem}/{inner}"),
                (None, _) => inner.clone(),
            };
            // Programs put the layer of a part before the name with a point, too.
            let mut all = vec![shown.clone(), name.clone()];
            if has_parts {
                all.push(format!("{part}.{name}"));
            }
            let mut names = all.clone();
            for end in file.stem.iter().flat_map(|stem| tails(stem)) {
                names.extend(all.iter().map(|name| format!("{end}/{name}")));
            }
            names.extend(tails(&key));
            let head = file.stem.as_ref().and_then(|stem| stem.split('/').next()).map(String::from);
            let channel = Channel { file: file.path.clone(), name: shown, storage, values };
            found.push(Found { key, head, names, channel });
        }
    }
    found
}

/// The channels of a file in a folder of its own that is an array by its name, such as `camera/range.T.exr`, with their
/// components: the only channel `Y`, or the channels `R`, `G` and `B`. So viewers and OpenCV have them.
fn components_of_array(file: &RecordingFile, parts: &[ExrPart]) -> &'static [(&'static str, &'static str)] {
    let [part] = parts else { return &[] };
    if !file.stem.as_ref().is_some_and(|stem| stem.contains('/')) {
        return &[];
    }
    match part.map.channels.keys().map(String::as_str).collect::<Vec<_>>().as_slice() {
        ["Y"] => &[("Y", "")],
        ["B", "G", "R"] => &[("R", "X"), ("G", "Y"), ("B", "Z")],
        _ => &[],
    }
}

/// Lengths in metres of whole numbers that count `scale` metres; 0, "none" and `miss` mean that nothing is hit.
pub(super) fn in_metres(image: &Image<u32>, scale: f64, miss: Option<f64>) -> Values {
    let length = |number: u32| match number {
        0 | u32::MAX => f64::INFINITY,
        number if miss == Some(f64::from(number)) => f64::INFINITY,
        number => f64::from(number) * scale,
    };
    Values::Reals(convert(image, length))
}
