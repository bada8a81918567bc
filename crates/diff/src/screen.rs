//! The screen of a comparison: at most 40 lines of 100 characters, however many channels there are.

use std::fmt::Write as _;
use std::path::Path;

use crate::cells::{CellDifference, Thresholds};
use crate::difference::{ChannelDifference, Difference, Sides};
use raypencil_judge::Class;
use raypencil_report::{count, counted, number, quantity};

/// Channels that are listed, two lines each.
const LISTED: usize = 12;

/// Keys that are listed of those that only one side has.
const NAMED: usize = 6;

/// Characters of a line.
const WIDTH: usize = 100;

/// What people see at a terminal; `folder` is where the report went.
pub fn diff_screen(difference: &Difference, sides: &Sides, folder: Option<&Path>) -> String {
    let mut text = String::new();
    // Writing to a string cannot fail.
    let mut line = |words: &str| {
        let _ = writeln!(text, "{}", words.trim_end());
    };
    line(&shortened(&format!("A {}", sides.names[0]), WIDTH));
    line(&shortened(&format!("B {}", sides.names[1]), WIDTH));
    line("");
    let listed = unequal(difference);
    if !listed.is_empty() {
        line(
            &row(["channel", "cells", "differ", "share", "largest", "ulp", "RMS", "mean"].map(String::from)),
        );
        for channel in listed.iter().take(LISTED) {
            let [at_least, then] = lines(channel);
            line(&at_least);
            line(&then);
        }
        if listed.len() > LISTED {
            let more = (listed.len() - LISTED) as u64;
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
            let ignored =
                if difference.thresholds.shared_only { " (not counted: --shared-only)" } else { "" };
            line(&shortened(&format!("only in {side}: {}{ignored}", named(keys)), WIDTH));
        }
    }
    line("");
    line(&format!("{} {}.", if difference.passes() { "PASS" } else { "FAIL" }, headline(difference)));
    line(&shortened(&format!("Allowed: {}.", allowed(&difference.thresholds)), WIDTH));
    if let Some(folder) = folder {
        line(&format!("Report: {}", folder.join("report.html").display()));
    }
    text
}

/// What the referee says of each channel that differs.
pub(crate) fn rulings(difference: &Difference) -> Vec<String> {
    let Some(rulings) = &difference.rulings else { return Vec::new() };
    let mut lines = Vec::new();
    for (key, ruling) in &rulings.channels {
        let of = |(a, b): &(Class, Class), cells: &u64| {
            format!("{} A {}, B {}", count(*cells), name(*a), name(*b))
        };
        let classes: Vec<String> = ruling.by_class.iter().map(|(both, cells)| of(both, cells)).collect();
        let unknown = match ruling.not_judged {
            0 => String::new(),
            cells => format!("; {} cannot be told", count(cells)),
        };
        lines.push(format!("referee on {key}: {}{unknown}", classes.join("; ")));
        lines.extend(
            ruling
                .wrong
                .iter()
                .take(2)
                .map(|cell| format!("    {}, {}: {}", cell.who, cell.place, cell.what)),
        );
    }
    if !rulings.not_ruled.is_empty() {
        lines.push(format!("not the scene's, so not ruled on: {}", named(&rulings.not_ruled)));
    }
    if !lines.is_empty() {
        lines.push(String::new());
    }
    lines
}

/// A class in a word.
pub(crate) fn name(class: Class) -> &'static str {
    match class {
        Class::Agree => "right",
        Class::Tie => "tie",
        Class::Rounding => "rounding",
        Class::Approximation => "approximation",
        Class::Undecided => "undecided",
        Class::Defect => "wrong",
    }
}

/// The channels that are not the same in every cell, those that fail first.
pub(crate) fn unequal(difference: &Difference) -> Vec<&ChannelDifference> {
    let mut unequal: Vec<_> = difference.channels.iter().filter(|channel| channel.unequal > 0).collect();
    // A stable sort: keys stay in their order.
    unequal.sort_by_key(|channel| !channel.fails);
    unequal
}

/// The verdict in a sentence, without its full stop.
pub(crate) fn headline(difference: &Difference) -> String {
    let all = difference.channels.len() as u64;
    let failing = difference.failing().count() as u64;
    let compared = counted(all, "channel", "channels");
    let lacking: usize = difference.only.iter().map(Vec::len).sum();
    let lacking = match lacking {
        some if some > 0 && difference.lacks() => {
            format!("; {} on one side only", counted(some as u64, "channel is", "channels are"))
        }
        _ => String::new(),
    };
    let unequal = unequal(difference).len() as u64;
    match (failing, unequal) {
        (0, 0) => format!("{compared} compared, the same in every cell{lacking}"),
        (0, _) => format!("{compared} compared, {} within what is allowed{lacking}", count(unequal)),
        _ => format!(
            "{} of {compared} {}{lacking}",
            count(failing),
            if failing == 1 { "differs" } else { "differ" }
        ),
    }
}

/// What the thresholds allow, in words.
pub(crate) fn allowed(thresholds: &Thresholds) -> String {
    let Thresholds { fail, fail_relative, fail_ulp, fail_percent, hard_fail, .. } = *thresholds;
    let mut words = Vec::new();
    for (value, unit) in [(fail, " absolute"), (fail_relative, " relative"), (fail_ulp, " ulp")] {
        if value > 0.0 {
            words.push(format!("{value}{unit}"));
        }
    }
    let mut text = if words.is_empty() { "no difference".to_string() } else { words.join(" or ") };
    if fail_percent > 0.0 {
        text.push_str(&format!(", beyond it {fail_percent} % of the cells"));
    }
    if let Some(most) = hard_fail {
        text.push_str(&format!(", none by more than {most}"));
    }
    text
}

/// A channel's numbers, and the cell to look at.
fn lines(channel: &ChannelDifference) -> [String; 2] {
    let optional = |value: Option<f64>| value.map_or("-".into(), number);
    let numbers = row([
        shortened(&channel.key, 26),
        count(channel.cells()),
        count(channel.differing),
        format!("{} %", number(channel.percent())),
        channel.largest.map_or("-".into(), |largest| quantity(largest, &channel.unit)),
        optional(channel.largest_ulp),
        optional(channel.rms),
        optional(channel.mean),
    ]);
    let mark = if channel.fails { "!" } else { " " };
    let there = channel.worst.map_or(String::new(), |worst| at(&worst));
    [numbers, format!("{mark}   {there}")]
}

/// A cell and its values with all their digits.
pub(crate) fn at(cell: &CellDifference) -> String {
    format!("at {},{}: A {}, B {}", cell.i, cell.j, exact(cell.a), exact(cell.b))
}

/// A number with all its digits.
pub(crate) fn exact(value: f64) -> String {
    match value {
        // What whole channels hold where there is nothing, and what is simply whole.
        whole if whole.abs() < 1e15 && whole == libm::trunc(whole) => format!("{whole}"),
        other => format!("{other:?}"),
    }
}

fn row([name, cells, differ, share, largest, ulp, rms, mean]: [String; 8]) -> String {
    format!("{name:<26} {cells:>10} {differ:>9} {share:>9} {largest:>14} {ulp:>8} {rms:>8} {mean:>8}")
}

fn named(keys: &[String]) -> String {
    let some = keys.iter().take(NAMED).map(String::as_str).collect::<Vec<_>>().join(", ");
    match keys.len().saturating_sub(NAMED) {
        0 => some,
        more => format!("{some} and {more} more"),
    }
}

/// At most `most` characters; the end of a name tells more than its beginning.
fn shortened(text: &str, most: usize) -> String {
    let length = text.chars().count();
    if length <= most {
        return text.to_string();
    }
    format!("…{}", text.chars().skip(length - most + 1).collect::<String>())
}
