//! A difference as the document that every report prints.

use raypencil_report::{Block, Column, Document, Grid, Outcome, Room, count, counted, number, quantity};

use crate::difference::{ChannelDifference, Difference, Sides};
use crate::explorer::explorer;
use crate::junit::suite;
use crate::pictures::pictures;
use crate::summary::diff_data;
use crate::words::{allowed, at, exact, first_keys, headline, rulings, unequal};

/// Number of the format of `summary.json`. It grows when a key changes its meaning or goes away.
const FORMAT: u32 = 1;

/// Maximum number of channels that a screen lists.
const MAX_LISTED_CHANNELS: usize = 12;

/// How to read the numbers.
const READING: [&str; 2] = [
    "Two recordings are compared cell by cell, under the names that both have; no scene is needed. NaN is the same as NaN, an \
     infinity as itself. NaN or an infinity against a number is a difference that no threshold allows. Whole numbers are the same or \
     not.",
    "Differ counts cells that no threshold allows; not finite are those of them with NaN or an infinity on one side alone. Largest is the largest absolute difference of two finite numbers, ulp the largest \
     in units of the last place of the coarser of the two files. RMS and mean are over all cells that are finite on both sides.",
];

/// The difference for a screen and for programs.
///
/// ```
/// use std::path::PathBuf;
///
/// use raypencil_diff::{Sides, Thresholds, diff, diff_document};
/// use raypencil_files::{Channel, Channels, Storage, Values};
/// use raypencil_scene::Image;
///
/// let values = Values::Reals(Image::filled(4, 3, 2.5));
/// let channel = Channel { file: PathBuf::new(), name: String::new(), storage: Storage::F32, values };
/// let a = Channels { by_key: [("camera/range.T".into(), channel)].into(), ..Channels::default() };
/// // A recording is equal to itself.
/// let difference = diff(&a, &a, &Thresholds::default())?;
/// let document = diff_document(&difference, &Sides { names: ["mine", "yours"], channels: [&a, &a] });
/// assert!(document.screen().contains("✓ 1 channel compared, the same in every cell."));
/// # Ok::<(), raypencil_diff::DiffError>(())
/// ```
pub fn diff_document(difference: &Difference, sides: &Sides) -> Document {
    let [a, b] = sides.names;
    let verdict = match (difference.passes(), difference.channels.iter().all(|channel| channel.unequal == 0))
    {
        (false, _) => "differs",
        (true, true) => "equal",
        (true, false) => "within_thresholds",
    };
    let text = |title, lines, room| Block::Text { title, lines, room };
    Document {
        run: format!("raypencil diff {a} {b}"),
        question: format!("two recordings\nA {a}\nB {b}"),
        outcome: if difference.passes() { Outcome::Agrees } else { Outcome::Fails },
        headline: format!("{}.", headline(difference)),
        remarks: vec![format!("Allowed: {}.", allowed(&difference.thresholds))],
        explanation: Vec::new(),
        counts: Vec::new(),
        facts: vec![("A", a.to_string()), ("B", b.to_string())],
        blocks: vec![
            Block::Table { title: "Every channel", grid: grid(difference) },
            text("", worst_cells(difference), Room::Screen),
            text("Who is right", rulings(difference), Room::Everywhere),
            text("", others(difference, first_keys), Room::Screen),
            text("", others(difference, |keys| keys.join(", ")), Room::Wide),
            text("How to read this page", READING.map(String::from).into(), Room::Wide),
        ],
        suites: vec![suite(difference, sides)],
        format: FORMAT,
        verdict,
        data: diff_data(difference, sides),
        explorer: String::new(),
    }
}

/// The same with the pictures of its page, and the part that answers when asked.
///
/// # Errors
/// An error of the template of pictures.
pub fn diff_document_with_pictures(
    difference: &Difference,
    sides: &Sides,
) -> Result<Document, askama::Error> {
    let mut document = diff_document(difference, sides);
    let (explorer, left_out) = explorer(difference, sides);
    let (html, more) = pictures(difference, sides)?;
    let notes = [left_out, more].into_iter().filter(|words| !words.is_empty()).collect();
    document.blocks.insert(1, Block::Pictures { title: "Channels that are not the same", html, stays: true });
    document.blocks.insert(2, Block::Text { title: "", lines: notes, room: Room::Wide });
    document.explorer = explorer;
    Ok(document)
}

/// The channels in rows: those that are not the same first, and for pages the others.
fn grid(difference: &Difference) -> Grid {
    let mut grid = Grid::new([
        Column::text("channel"),
        Column::number("cells"),
        Column::number("differ"),
        Column::number("share"),
        Column::number("not finite"),
        Column::number("largest"),
        Column::number("ulp"),
        Column::number("RMS"),
        Column::number("mean"),
        Column::text("where (column, row)").wide(),
        Column::text("A").wide(),
        Column::text("B").wide(),
    ]);
    let equal = difference.channels.iter().filter(|channel| channel.unequal == 0);
    for (index, channel) in unequal(difference).into_iter().chain(equal).enumerate() {
        let is_listed = channel.unequal > 0 && index < MAX_LISTED_CHANNELS;
        let room = if is_listed { Room::Everywhere } else { Room::Wide };
        grid.row_with_room(row(channel), channel.fails, room);
    }
    grid
}

fn row(channel: &ChannelDifference) -> [String; 12] {
    let optional = |value: Option<f64>| value.map_or(String::new(), number);
    let [place, a, b] = channel.worst.map_or([const { String::new() }; 3], |worst| {
        [format!("{},{}", worst.i, worst.j), exact(worst.a), exact(worst.b)]
    });
    [
        channel.key.clone(),
        count(channel.cells()),
        count(channel.differing),
        format!("{} %", number(channel.percent())),
        // Empty, where there is none: such cells are rare, and they have no part in the numbers that follow.
        if channel.incomparable == 0 { String::new() } else { count(channel.incomparable) },
        channel.largest.map_or(String::new(), |largest| quantity(largest, &channel.unit)),
        optional(channel.largest_ulp),
        optional(channel.rms),
        optional(channel.mean),
        place,
        a,
        b,
    ]
}

/// The worst cell of each listed channel, with a mark where it fails, and how many channels are not listed.
fn worst_cells(difference: &Difference) -> Vec<String> {
    let unequal = unequal(difference);
    let line = |channel: &&ChannelDifference| {
        let mark = if channel.fails { "!" } else { " " };
        Some(format!("{mark} {} {}", channel.key, at(&channel.worst?)))
    };
    let mut lines: Vec<String> = unequal.iter().take(MAX_LISTED_CHANNELS).filter_map(line).collect();
    if let Some(more @ 1..) = unequal.len().checked_sub(MAX_LISTED_CHANNELS) {
        let more = counted(more as u64, "channel", "channels");
        lines.push(format!("and {more} that are not the same in every cell"));
    }
    lines
}

/// Channels that are the same, and those of one side only.
fn others(difference: &Difference, named: impl Fn(&[String]) -> String) -> Vec<String> {
    let equal = difference.channels.iter().filter(|channel| channel.unequal == 0).count() as u64;
    let verb = if equal == 1 { "is" } else { "are" };
    let mut lines = Vec::new();
    if equal > 0 {
        lines.push(format!("{} {verb} the same in every cell.", counted(equal, "channel", "channels")));
    }
    let ignored = if difference.thresholds.shared_only { " (not counted: --shared-only)" } else { "" };
    for (keys, side) in difference.only.iter().zip(["A", "B"]) {
        if !keys.is_empty() {
            lines.push(format!("Only in {side}: {}{ignored}", named(keys)));
        }
    }
    lines
}
