//! The screen of a comparison: at most 40 lines of 100 characters, for any number of channels.

use std::fmt::Write as _;
use std::path::Path;

use raypencil_report::{count, counted, number, quantity};

use crate::difference::{ChannelDifference, Difference, Sides};
use crate::words::{allowed, at, first_keys, headline, rulings, unequal};

/// Maximum number of channels that are listed, two lines each.
const MAX_LISTED_CHANNELS: usize = 12;

/// Length of a line on a terminal, characters.
const LINE_CHARS: usize = 100;

/// Length of a channel's key on a terminal, characters.
const KEY_CHARS: usize = 26;

/// The screen as text. `folder` is where [`crate::write_diff`] wrote the report.
///
/// ```
/// use std::path::PathBuf;
///
/// use raypencil_diff::{Sides, Thresholds, diff, diff_screen};
/// use raypencil_files::{Channel, Channels, Storage, Values};
/// use raypencil_scene::Image;
///
/// let values = Values::Reals(Image::filled(4, 3, 2.5));
/// let channel = Channel { file: PathBuf::new(), name: String::new(), storage: Storage::F32, values };
/// let a = Channels { by_key: [("camera/range.T".into(), channel)].into(), ..Channels::default() };
/// // A recording is equal to itself.
/// let difference = diff(&a, &a, &Thresholds::default())?;
/// let screen = diff_screen(&difference, &Sides { names: ["mine", "yours"], channels: [&a, &a] }, None);
/// assert!(screen.contains("PASS 1 channel compared, the same in every cell."));
/// # Ok::<(), raypencil_diff::DiffError>(())
/// ```
pub fn diff_screen(difference: &Difference, sides: &Sides, folder: Option<&Path>) -> String {
    screen(difference, sides, folder, LINE_CHARS, KEY_CHARS)
}

/// The same text for a file or another program: no name is shortened, whatever its length.
pub fn diff_text(difference: &Difference, sides: &Sides, folder: Option<&Path>) -> String {
    let longest = difference.channels.iter().map(|channel| channel.key.chars().count()).max().unwrap_or(0);
    screen(difference, sides, folder, usize::MAX, longest.max(KEY_CHARS))
}

/// The text in lines of at most `line_chars` characters, with keys of at most `key_chars`.
fn screen(
    difference: &Difference,
    sides: &Sides,
    folder: Option<&Path>,
    line_chars: usize,
    key_chars: usize,
) -> String {
    let mut text = String::new();
    // Writing to a string cannot fail.
    let mut line = |words: &str| {
        let _ = writeln!(text, "{}", words.trim_end());
    };
    line(&shortened(&format!("A {}", sides.names[0]), line_chars));
    line(&shortened(&format!("B {}", sides.names[1]), line_chars));
    line("");
    let listed = unequal(difference);
    if !listed.is_empty() {
        let heads = ["channel", "cells", "differ", "share", "largest", "ulp", "RMS", "mean"];
        line(&row(heads.map(String::from), key_chars));
        for channel in listed.iter().take(MAX_LISTED_CHANNELS) {
            for words in channel_lines(channel, key_chars) {
                line(&words);
            }
        }
        if listed.len() > MAX_LISTED_CHANNELS {
            let more = (listed.len() - MAX_LISTED_CHANNELS) as u64;
            line(&format!(
                "  and {} that are not the same in every cell",
                counted(more, "channel", "channels")
            ));
        }
        line("");
    }
    for words in rulings(difference) {
        line(&words);
    }
    let equal = (difference.channels.len() - listed.len()) as u64;
    if equal > 0 {
        let verb = if equal == 1 { "is" } else { "are" };
        line(&format!("{} {verb} the same in every cell.", counted(equal, "channel", "channels")));
    }
    for (keys, side) in difference.only.iter().zip(["A", "B"]) {
        if !keys.is_empty() {
            let ignored = if difference.thresholds.shared_only { "(not counted: --shared-only)" } else { "" };
            // The names are what the line is about: it is wrapped, never cut.
            for words in only_lines(&format!("only in {side}: "), keys, ignored) {
                line(&words);
            }
        }
    }
    line("");
    line(&format!("{} {}.", if difference.passes() { "PASS" } else { "FAIL" }, headline(difference)));
    line(&shortened(&format!("Allowed: {}.", allowed(&difference.thresholds)), line_chars));
    if let Some(folder) = folder {
        line(&format!("Report: {}", folder.join("report.html").display()));
    }
    text
}

/// Lines that name the first keys of one side in full. Later lines are indented below the first name.
fn only_lines(head: &str, keys: &[String], end: &str) -> Vec<String> {
    let indent = head.chars().count();
    let keys = first_keys(keys);
    let (mut lines, mut line) = (Vec::new(), String::new());
    for part in keys.split(' ').chain((!end.is_empty()).then_some(end)) {
        if !line.is_empty() && indent + line.chars().count() + 1 + part.chars().count() > LINE_CHARS {
            lines.push(std::mem::take(&mut line));
        }
        if !line.is_empty() {
            line.push(' ');
        }
        line.push_str(part);
    }
    lines.push(line);
    let head_of = |index: usize| if index == 0 { head.to_string() } else { " ".repeat(indent) };
    lines.iter().enumerate().map(|(index, line)| head_of(index) + line).collect()
}

/// Two lines for a channel: its statistics and its worst cell.
fn channel_lines(channel: &ChannelDifference, key_chars: usize) -> [String; 2] {
    let optional = |value: Option<f64>| value.map_or("-".into(), number);
    let numbers = [
        shortened(&channel.key, key_chars),
        count(channel.cells()),
        count(channel.differing),
        format!("{} %", number(channel.percent())),
        channel.largest.map_or("-".into(), |largest| quantity(largest, &channel.unit)),
        optional(channel.largest_ulp),
        optional(channel.rms),
        optional(channel.mean),
    ];
    let numbers = row(numbers, key_chars);
    let mark = if channel.fails { "!" } else { " " };
    let worst = channel.worst.map_or(String::new(), |worst| at(&worst));
    [numbers, format!("{mark}   {worst}")]
}

/// A line of the table.
fn row([name, cells, differ, share, largest, ulp, rms, mean]: [String; 8], key_chars: usize) -> String {
    format!("{name:<key_chars$} {cells:>10} {differ:>9} {share:>9} {largest:>14} {ulp:>8} {rms:>8} {mean:>8}")
}

/// The last `max_chars` characters of a text, since the end of a path tells more than its beginning.
fn shortened(text: &str, max_chars: usize) -> String {
    let length = text.chars().count();
    if length <= max_chars {
        return text.to_string();
    }
    format!("…{}", text.chars().skip(length - max_chars + 1).collect::<String>())
}
