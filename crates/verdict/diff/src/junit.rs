//! A comparison for CI: one test case per channel.

use raypencil_report::{JunitCase, JunitSuite, count, counted, number, quantity};

use crate::difference::{ChannelDifference, Difference, Sides};
use crate::rulings::RuledCell;
use crate::words::{allowed, at};

/// The suite of a difference.
pub(crate) fn suite(difference: &Difference, sides: &Sides) -> JunitSuite {
    let [a, b] = sides.names;
    let mut suite = JunitSuite::new(format!("{a} against {b}"));
    for channel in &difference.channels {
        suite.push(case(difference, channel));
    }
    for (keys, side) in difference.only.iter().zip(["A", "B"]) {
        for key in keys {
            let message = format!("only in {side}");
            suite.push(match difference.thresholds.shared_only {
                true => JunitCase::skipped(key.as_str(), message).with_kind("missing"),
                false => JunitCase::failed(key.as_str(), "missing", message),
            });
        }
    }
    suite
}

/// The outcome of one channel.
fn case(difference: &Difference, channel: &ChannelDifference) -> JunitCase {
    let name = channel.key.as_str();
    if !channel.fails {
        return JunitCase::passed(name);
    }
    let cells = counted(channel.cells(), "cell", "cells");
    let message = format!("{} of {cells} differ", count(channel.differing));
    let mut lines = vec![format!("Allowed: {}.", allowed(&difference.thresholds))];
    lines.extend(channel.worst.map(|worst| at(&worst)));
    if let (Some(largest), Some(ulp)) = (channel.largest, channel.largest_ulp) {
        let largest = quantity(largest, &channel.unit);
        lines.push(format!(
            "Largest difference: {largest}, {} ulp of {} precision.",
            number(ulp),
            channel.storage
        ));
    }
    if let Some(ruling) = difference.rulings.as_ref().and_then(|rulings| rulings.channels.get(&channel.key)) {
        let of = |cell: &RuledCell| format!("{}, {}: {}", cell.who, cell.place, cell.what);
        lines.extend(ruling.wrong.iter().map(of));
    }
    JunitCase::failed(name, "difference", message).with_text(lines.join("\n"))
}
