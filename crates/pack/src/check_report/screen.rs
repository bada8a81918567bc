//! A check on one terminal screen.

use std::fmt::Write as _;

use raypencil_judge::{Class, Defect, Largest, name_of, unit_of};
use raypencil_report::{Align, Table, count, quantity};

use crate::check::Checked;
use crate::check_report::verdict::{MAX_SHOWN_DEFECTS, arithmetic, verdict};

/// The screen: a table of all quantities, the first defects with their `probe` commands, the verdict, and the mistake that
/// explains it, if one does.
pub fn check_screen(checked: &Checked) -> String {
    let Checked { subject, recorded, check, is_blind, .. } = checked;
    let model = subject.scene.flux_model();
    let blind = if *is_blind { " (blind)" } else { "" };
    let mut text = format!(
        "raypencil {}: {} against the answers to {}{blind}, arithmetic {}\n\n",
        env!("CARGO_PKG_VERSION"),
        recorded.name,
        subject.name,
        arithmetic(recorded.precision)
    );
    let heads = [
        "",
        "compared",
        "agree",
        "tie",
        "rounding",
        "defect",
        "not compared",
        "ulp",
        "error",
        "/bound",
        "at",
    ];
    // Names and places are texts, the rest numbers.
    let is_text = |head: &str| head.is_empty() || head == "at";
    let mut table = Table::new(heads.map(|head| if is_text(head) { Align::Left } else { Align::Right }));
    table.row(heads);
    for (item, tally) in check.totals() {
        let largest = |largest: &Option<Largest>, unit: &str| {
            largest.as_ref().map_or("-".into(), |largest| quantity(largest.value, unit))
        };
        table.row([
            name_of(item),
            count(tally.compared()),
            count(tally.of(Class::Agree)),
            count(tally.of(Class::Tie)),
            count(tally.of(Class::Rounding)),
            count(tally.of(Class::Defect)),
            count(tally.not_compared),
            largest(&tally.worst_ulps, ""),
            largest(&tally.worst_error, unit_of(model, item)),
            largest(&tally.worst_ratio, ""),
            tally.worst_ratio.as_ref().map_or("-".into(), |largest| {
                let place = largest.place;
                format!("{} {},{}", place.sensor, place.i, place.j)
            }),
        ]);
    }
    let _ = writeln!(text, "{table}");
    for name in &recorded.unknown {
        let _ = writeln!(text, "Unknown channel, not compared: {name}");
    }
    let is_partial = check.totals().values().any(|tally| tally.not_compared > 0);
    let not_compared: Vec<String> = check
        .totals()
        .into_iter()
        .filter(|(_, tally)| tally.compared() == 0 && tally.not_compared > 0)
        .map(|(item, _)| name_of(item))
        .collect();
    if !not_compared.is_empty() {
        let _ = writeln!(
            text,
            "Not compared, because absent or stored in a type that cannot hold it: {}",
            not_compared.join(", ")
        );
    }
    let wrong: Vec<&Defect> = check.sensors.iter().flat_map(|sensor| &sensor.defects).collect();
    for one in wrong.iter().take(MAX_SHOWN_DEFECTS) {
        let _ = writeln!(text, "{}, {}: {}", one.place, name_of(one.item), one.what);
        let _ = writeln!(text, "    {}", checked.repro(one.place));
    }
    let rays = count(check.compared());
    let _ = match verdict(check) {
        "agrees" => writeln!(
            text,
            "✓ {rays} rays agree with the exact answers: {} exact, {} tie, {} rounding{}.",
            count(check.of(Class::Agree)),
            count(check.of(Class::Tie)),
            count(check.of(Class::Rounding)),
            if is_partial { "; nothing is known about what was not compared" } else { "" }
        ),
        "defects" => writeln!(
            text,
            "✗ {} of {rays} rays are wrong, {} undecided.",
            count(check.of(Class::Defect)),
            count(check.of(Class::Undecided))
        ),
        _ => writeln!(text, "? Nothing was compared."),
    };
    if let Some(why) = checked.why() {
        let _ = writeln!(text, "  Why: {why}.");
    }
    text
}
