//! Markdown table of the obstacle maps against the truth: a row for each drive.

use raypencil::drive::SectorTruth;
use raypencil::report::count;

/// Head of the table.
pub const HEAD: &str = "\
| drive | | sectors | found | passed | missed: errors, spacing, rule | not seen: hidden, not swept, outside | false | unknown: not measured, may hide, near limit | clear | clear way | exact eyes: found, passed, false, clear way |
| --- | --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |";

/// Row of the table: the drive, the settings that were changed, the counts, and those of the upper bound.
pub fn row(truth: &SectorTruth, bound: &SectorTruth, drive: &str, settings: &str) -> String {
    let SectorTruth { missed, not_found, .. } = truth;
    format!(
        "| {drive} | {settings} | {} | {} | {} | {} = {} + {} + {} ({}) | {} + {} + {} | {} ({}) | {} + {} + {} | {} | {:.2} m | {}, {}, {}, {:.2} m |",
        count(truth.sectors),
        count(truth.found),
        count(truth.passed()),
        count(missed.all()),
        count(missed.by_errors),
        count(missed.by_spacing),
        count(missed.by_rule),
        percent(missed.all(), truth.found + missed.all()),
        count(not_found.hidden),
        // No stripe has come to the top of what was met lower down.
        count(not_found.not_swept + not_found.in_part),
        count(not_found.outside),
        count(truth.false_obstacle),
        percent(truth.false_obstacle, truth.sectors),
        count(truth.unknown_not_measured + truth.unknown_beyond_map),
        count(truth.unknown_may_hide),
        count(truth.unknown_near_limit),
        count(truth.clear),
        truth.mean_clear_way(),
        count(bound.found),
        count(bound.passed()),
        count(bound.false_obstacle),
        bound.mean_clear_way(),
    )
}

/// Percentage of a part, with a tenth of a percent below 9.95 %. "0 %" and "100 %" mean exactly none and exactly all.
fn percent(part: u64, all: u64) -> String {
    let share = 100.0 * part as f64 / all.max(1) as f64;
    match share {
        _ if part == 0 => "0 %".into(),
        ..0.05 => "< 0.1 %".into(),
        ..9.95 => format!("{share:.1} %"),
        // A part that is not all is never 100 %.
        99.5.. if part < all => format!("{:.1} %", share.min(99.9)),
        _ => format!("{share:.0} %"),
    }
}
