//! Sentences and numbers that the screen, the page and the test cases share.

use libm::trunc;
use raypencil_judge::Class;
use raypencil_report::{count, counted};

use crate::cells::{CellDifference, Thresholds};
use crate::difference::{ChannelDifference, Difference};

/// Maximum number of keys that a sentence lists.
const MAX_NAMED_KEYS: usize = 6;

/// Start of the keys of channels of sets of rays.
const OF_RAY_SETS: &str = "rays/";

/// Maximum number of wrong cells that are described for a channel.
const MAX_SHOWN_WRONG_CELLS: usize = 2;

/// The referee's rulings, one line for each channel and one for each of its first wrong cells.
pub(crate) fn rulings(difference: &Difference) -> Vec<String> {
    let Some(rulings) = &difference.rulings else { return Vec::new() };
    let mut lines = Vec::new();
    for (key, ruling) in &rulings.channels {
        let by_classes = |(a, b): &(Class, Class), cells: &u64| {
            format!("{} A {}, B {}", count(*cells), class_name(*a), class_name(*b))
        };
        let classes: Vec<String> =
            ruling.by_class.iter().map(|(both, cells)| by_classes(both, cells)).collect();
        let unknown = match ruling.not_judged {
            0 => String::new(),
            cells => format!("; {} could not be judged", count(cells)),
        };
        lines.push(format!("referee on {key}: {}{unknown}", classes.join("; ")));
        lines.extend(
            ruling
                .wrong
                .iter()
                .take(MAX_SHOWN_WRONG_CELLS)
                .map(|cell| format!("    {}, {}: {}", cell.who, cell.place, cell.what)),
        );
    }
    let (of_sets, others): (Vec<String>, Vec<String>) =
        rulings.not_ruled.iter().cloned().partition(|key| key.starts_with(OF_RAY_SETS));
    if !of_sets.is_empty() {
        lines.push(format!(
            "not ruled on: {}; diff rules on the camera and the beams. Sets of rays are ruled on by check, with a pack of the scene \
             (raypencil pack SCENE -o PACK; raypencil check PACK A)",
            first_keys(&of_sets)
        ));
    }
    if !others.is_empty() {
        lines.push(format!("not ruled on, since the scene has no such channel: {}", first_keys(&others)));
    }
    lines
}

pub(crate) fn class_name(class: Class) -> &'static str {
    match class {
        Class::Agree => "right",
        Class::Tie => "tie",
        Class::Rounding => "rounding",
        Class::Approximation => "approximation",
        Class::Undecided => "undecided",
        Class::Defect => "wrong",
    }
}

/// The channels with an unequal cell; those that fail come first.
pub(crate) fn unequal(difference: &Difference) -> Vec<&ChannelDifference> {
    let mut unequal: Vec<_> = difference.channels.iter().filter(|channel| channel.unequal > 0).collect();
    // A stable sort keeps the order of the keys.
    unequal.sort_by_key(|channel| !channel.fails);
    unequal
}

/// The verdict in a sentence, without its full stop.
pub(crate) fn headline(difference: &Difference) -> String {
    let all = difference.channels.len() as u64;
    let failing = difference.failing().count() as u64;
    let compared = counted(all, "channel", "channels");
    let missing: usize = difference.only.iter().map(Vec::len).sum();
    let missing = match missing {
        channels if channels > 0 && difference.fails_by_missing_channels() => {
            format!("; {} on one side only", counted(channels as u64, "channel is", "channels are"))
        }
        _ => String::new(),
    };
    let unequal = unequal(difference).len() as u64;
    match (failing, unequal) {
        (0, 0) => format!("{compared} compared, the same in every cell{missing}"),
        (0, _) => format!("{compared} compared, {} within what is allowed{missing}", count(unequal)),
        _ => format!(
            "{} of {compared} {}{missing}",
            count(failing),
            if failing == 1 { "differs" } else { "differ" }
        ),
    }
}

/// The allowed differences, in words.
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
    if let Some(limit) = hard_fail {
        text.push_str(&format!(", none by more than {limit}"));
    }
    text
}

/// A cell and the values of both sides, with all digits.
pub(crate) fn at(cell: &CellDifference) -> String {
    format!("at {},{}: A {}, B {}", cell.i, cell.j, exact(cell.a), exact(cell.b))
}

/// A number with all digits.
pub(crate) fn exact(value: f64) -> String {
    match value {
        // Whole numbers without ".0", also 4294967295, which stands for "none" in channels of indices.
        whole if whole.abs() < 1e15 && whole == trunc(whole) => format!("{whole}"),
        other => format!("{other:?}"),
    }
}

/// The first keys of a list, and how many more there are.
pub(crate) fn first_keys(keys: &[String]) -> String {
    let first = keys.iter().take(MAX_NAMED_KEYS).map(String::as_str).collect::<Vec<_>>().join(", ");
    match keys.len().saturating_sub(MAX_NAMED_KEYS) {
        0 => first,
        more => format!("{first} and {more} more"),
    }
}
