//! `junit.xml` of a comparison for CI: one test case per channel.

use quick_junit::{NonSuccessKind, Report, SerializeError, TestCase, TestCaseStatus, TestSuite};
use raypencil_report::{count, counted, number, quantity};

use crate::difference::{ChannelDifference, Difference, Sides};
use crate::rulings::RuledCell;
use crate::words::{allowed, at};

/// The document.
pub(crate) fn junit(difference: &Difference, sides: &Sides) -> Result<String, SerializeError> {
    let [a, b] = sides.names;
    let mut report = Report::new(format!("raypencil diff {a} {b}"));
    let mut suite = TestSuite::new(format!("{a} against {b}"));
    for channel in &difference.channels {
        suite.add_test_case(TestCase::new(channel.key.as_str(), status(difference, channel)));
    }
    for (keys, side) in difference.only.iter().zip(["A", "B"]) {
        for key in keys {
            let mut status = match difference.thresholds.shared_only {
                true => TestCaseStatus::skipped(),
                false => TestCaseStatus::non_success(NonSuccessKind::Failure),
            };
            status.set_message(format!("only in {side}")).set_type("missing");
            suite.add_test_case(TestCase::new(key.as_str(), status));
        }
    }
    report.add_test_suite(suite);
    report.to_string()
}

/// The outcome of one channel.
fn status(difference: &Difference, channel: &ChannelDifference) -> TestCaseStatus {
    if !channel.fails {
        return TestCaseStatus::success();
    }
    let mut status = TestCaseStatus::non_success(NonSuccessKind::Failure);
    let cells = counted(channel.cells(), "cell", "cells");
    status.set_message(format!("{} of {cells} differ", count(channel.differing))).set_type("difference");
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
    status.set_description(lines.join("\n"));
    status
}
