//! A page about two recordings without a scene: rasters of any channels, side by side.

use serde_json::{Map, Value, json};

use crate::arrays::{Arrays, Change};
use crate::page::html_of;

/// Class of a cell that is equal on both sides, and of one that is not, as numbers of the page's classes.
const EQUAL: u8 = 0;
const DIFFERS: u8 = 5;

/// Cells of one channel on both sides.
#[derive(Debug, Clone, PartialEq)]
pub enum RasterChannel {
    /// Numbers, in single precision.
    Reals([Vec<f32>; 2]),
    /// Whole numbers.
    Wholes([Vec<u32>; 2]),
}

/// Channels of one size that belong together, such as those of one sensor.
#[derive(Debug, Clone)]
pub struct RasterGroup {
    /// Name of the group.
    pub name: String,
    /// Columns and rows.
    pub size: (u32, u32),
    /// Name, unit and cells of each channel.
    pub channels: Vec<(String, String, RasterChannel)>,
    /// Cells that differ in some channel: number of the cell, and index of the first such channel.
    pub differing: Vec<(u32, usize)>,
}

/// The elements of a page about two recordings with these names, with style and script.
///
/// ```
/// use raypencil_explorer::{RasterChannel, RasterGroup, raster_page};
///
/// let range = RasterChannel::Reals([vec![1.0, 2.0], vec![1.0, 2.5]]);
/// let group = RasterGroup {
///     name: "camera".into(),
///     size: (2, 1),
///     channels: vec![("range.T".into(), "m".into(), range)],
///     differing: vec![(1, 0)],
/// };
/// let html = raster_page("diff", "mine and theirs", ["mine", "theirs"], &[group]);
/// assert!(html.contains(r#""name":"theirs""#));
/// ```
pub fn raster_page(kind: &str, title: &str, names: [&str; 2], groups: &[RasterGroup]) -> String {
    let mut arrays = Arrays::default();
    let mut quantities: Vec<Value> = Vec::new();
    let sensors: Vec<Value> = groups
        .iter()
        .map(|group| {
            let first_quantity = quantities.len();
            let known = group.channels.iter().map(|(name, unit, _)| json!({ "name": name, "unit": unit }));
            quantities.extend(known);
            group_model(&mut arrays, group, first_quantity)
        })
        .collect();
    let sides = names.map(|name| json!({ "name": name, "kind": "candidate", "words": "" }));
    let model = json!({
        "version": 1, "kind": kind, "title": title, "probe": "", "flux_unit": "", "mesh": null, "vehicle": null,
        "sides": sides, "sensors": sensors,
        "classes": ["equal", "tie", "rounding", "approximation", "undecided", "differs"],
        "quantities": quantities, "causes": [], "switches": {}, "rays": null, "rays_words": "",
    });
    html_of(&model, &arrays)
}

fn group_model(arrays: &mut Arrays, group: &RasterGroup, first_quantity: usize) -> Value {
    let (width, height) = group.size;
    let cells = width as usize * height as usize;
    let mut sides = [Map::new(), Map::new()];
    for (name, _, channel) in &group.channels {
        let packed = match channel {
            RasterChannel::Reals([a, b]) => {
                let of_a = arrays.f32(a, Change::None);
                let of_b = arrays.f32_beside(b, &of_a);
                [of_a, of_b]
            }
            RasterChannel::Wholes([a, b]) => {
                let of_a = arrays.u32(a, Change::Delta);
                let of_b = arrays.u32_beside(b, &of_a);
                [of_a, of_b]
            }
        };
        for (side, packed) in sides.iter_mut().zip(packed) {
            side.insert(name.clone(), json!({ "stored": packed.reference }));
        }
    }
    let mut classes = vec![EQUAL; cells];
    let mut quantities = vec![u8::MAX; cells];
    for (cell, channel) in &group.differing {
        classes[*cell as usize] = DIFFERS;
        quantities[*cell as usize] = u8::try_from(first_quantity + channel).unwrap_or(u8::MAX);
    }
    let pair = json!({
        "a": 0, "b": 1,
        "class": arrays.u8(&classes),
        "cause": arrays.u8(&vec![u8::MAX; cells]),
        "quantity": arrays.u8(&quantities),
        "range_ulps": null, "range_bound": null,
    });
    json!({
        "name": group.name, "kind": "raster", "beam": null, "width": width, "height": height, "max_range": null,
        "pose": null, "camera": null, "grid": null,
        "sides": sides.map(|channels| json!({ "channels": channels })),
        "pairs": [pair], "margins": null,
    })
}
