//! The part of the page that answers when asked: both recordings, channel by channel, cell by cell.

use std::collections::{BTreeMap, BTreeSet};

use raypencil_explorer::{DifferingCell, RasterChannel, RasterGroup, RasterPage, SideKind};
use raypencil_files::Values;
use raypencil_judge::Class;

use crate::cells::{Comparison, compare_numbers, number};
use crate::difference::{ChannelDifference, Difference, Sides};
use crate::words::unequal;

/// Maximum number of cells of all channels together that keeps the page to some twenty megabytes.
const MAX_CELLS: u64 = 6_000_000;

/// The elements of the page that the explorer needs, and which channels it leaves out, in words.
pub(crate) fn explorer(difference: &Difference, sides: &Sides) -> (String, String) {
    let unequal = unequal(difference);
    let equal = difference.channels.iter().filter(|channel| channel.unequal == 0);
    let mut room = MAX_CELLS;
    let mut groups: BTreeMap<(String, u32, u32), RasterGroup> = BTreeMap::new();
    let mut left_out = 0_u64;
    for channel in unequal.iter().copied().chain(equal) {
        let Some(left) = room.checked_sub(channel.cells()) else {
            left_out += 1;
            continue;
        };
        room = left;
        add(&mut groups, channel, sides);
    }
    let groups: Vec<RasterGroup> = groups.into_values().collect();
    let title = format!("{} and {}", sides.names[0], sides.names[1]);
    let words = match left_out {
        0 => String::new(),
        left_out => format!(
            "{left_out} channels are not among the maps above, which have at most {MAX_CELLS} cells; the table has all."
        ),
    };
    let page = RasterPage {
        kind: "diff",
        title: &title,
        sides: &sides.names.map(|name| (name, SideKind::Candidate)),
        classes: ["equal", "tie", "rounding", "approximation", "undecided", "differs"],
        groups: &groups,
        described_words: "",
        solid: None,
    };
    (page.html(), words)
}

/// Adds a channel to the group of its folder and size.
fn add(groups: &mut BTreeMap<(String, u32, u32), RasterGroup>, channel: &ChannelDifference, sides: &Sides) {
    let (group, name) = channel.key.rsplit_once('/').unwrap_or(("", &channel.key));
    let size = (channel.width, channel.height);
    let values = sides.channels.map(|side| &side.by_key[&channel.key].values);
    let numbers = [numbers_of(values[0], values[1]), numbers_of(values[1], values[0])];
    let packed = match values {
        [Values::Wholes(a), Values::Wholes(b)] => {
            RasterChannel::Wholes([a, b].map(|image| Some(image.cells().to_vec())).into())
        }
        _ => {
            let single = |cells: &Vec<f64>| Some(cells.iter().map(|cell| *cell as f32).collect());
            RasterChannel::Reals(numbers.each_ref().map(single).into())
        }
    };
    let key = (group.to_string(), size.0, size.1);
    let entry = groups.entry(key).or_insert_with(|| RasterGroup {
        name: if group.is_empty() { format!("{} x {}", size.0, size.1) } else { group.to_string() },
        size,
        axes: None,
        channels: Vec::new(),
        differing: Vec::new(),
        described: Vec::new(),
    });
    let index = entry.channels.len();
    let earlier: BTreeSet<u32> = entry.differing.iter().map(|differing| differing.cell).collect();
    let [a, b] = &numbers;
    let apart =
        a.iter().zip(b).zip(0_u32..).filter(|((a, b), _)| compare_numbers(**a, **b) != Comparison::Equal);
    let new: Vec<DifferingCell> = apart
        .map(|(_, cell)| cell)
        .filter(|cell| !earlier.contains(cell))
        .map(|cell| DifferingCell { cell, channel: index, class: Class::Defect })
        .collect();
    entry.differing.extend(new);
    entry.channels.push((name.to_string(), channel.unit.clone(), packed));
}

/// The cells as numbers, as they are compared with those beside them; whole numbers are exact.
fn numbers_of(values: &Values, beside: &Values) -> Vec<f64> {
    let (width, height) = values.size();
    (0..width as usize * height as usize).map(|index| number(values, beside, index)).collect()
}

#[cfg(test)]
mod tests {
    use std::path::PathBuf;

    use raypencil_files::{Channel, Channels, Storage};
    use raypencil_scene::Image;

    use super::*;
    use crate::{Thresholds, diff};

    #[test]
    fn cells_differ_on_the_page_where_they_differ_in_the_table() {
        let (none, nan) = (f64::from(u32::MAX), f64::NAN);
        let channel =
            |storage, values| Channel { file: PathBuf::new(), name: String::new(), storage, values };
        let wholes = |cells: &[f64]| {
            let cells = cells.iter().map(|cell| *cell as u32).collect();
            channel(Storage::Whole, Values::Wholes(Image::from_cells(5, 1, cells)))
        };
        let reals =
            |cells: &[f64]| channel(Storage::F32, Values::Reals(Image::from_cells(5, 1, cells.to_vec())));
        let all = [
            // Of whole numbers 4294967295 is "none", which reals write as NaN, or as the number itself.
            (wholes(&[7.0, 8.0, none, none, none]), reals(&[7.0, 9.0, nan, none, 3.0])),
            (wholes(&[7.0, 8.0, none, none, 4.0]), wholes(&[7.0, 9.0, none, 5.0, 4.0])),
            (reals(&[1.0, nan, nan, 0.0, f64::INFINITY]), reals(&[1.0, nan, 2.0, -0.0, f64::INFINITY])),
        ];
        for (one, other) in all {
            for [a, b] in [[&one, &other], [&other, &one]] {
                let [a, b] = [a, b].map(|channel| Channels {
                    by_key: [("camera/face.I".to_string(), channel.clone())].into(),
                    ..Channels::default()
                });
                let difference = diff(&a, &b, &Thresholds::default()).expect("one channel");
                let mut groups = BTreeMap::new();
                add(&mut groups, &difference.channels[0], &Sides { names: ["a", "b"], channels: [&a, &b] });
                let group = groups.values().next().expect("a group");
                assert_eq!(
                    group.differing.len() as u64,
                    difference.channels[0].unequal,
                    "{:?}",
                    group.channels
                );
            }
        }
    }
}
