//! A check on one terminal screen.

use std::fmt::Write as _;

use raypencil_judge::{Class, Largest, listed_defects, name_of, unit_of};
use raypencil_report::{Align, Table, count, counted, quantity};

use crate::check::{Checked, Verified};
use crate::check_report::verdict::{
    MAX_SHOWN_DEFECTS, arithmetic, coarse_storages, headline, items_not_given, listed_totals, not_given, sign,
};
use crate::published::PackIdentity;

/// The screen: a table of all quantities, the worst defects with their `probe` commands, the verdict, and the mistake that
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
    for (item, tally) in listed_totals(check) {
        let largest = |largest: &Option<Largest>, unit: &str| {
            largest.as_ref().map_or("-".into(), |largest| quantity(largest.value, unit))
        };
        let of = |class| count(tally.of(class));
        let counts = match not_given(&tally) {
            // Never 0: a quantity that is not given is not one without errors.
            Some(_) => ["not given".to_string(), "-".into(), "-".into(), "-".into(), "-".into()],
            None => [
                count(tally.compared()),
                of(Class::Agree),
                of(Class::Tie),
                of(Class::Rounding),
                of(Class::Defect),
            ],
        };
        let rest = [
            count(tally.not_compared),
            largest(&tally.worst_ulps, ""),
            largest(&tally.worst_error, unit_of(model, item)),
            largest(&tally.worst_ratio, ""),
            tally.worst_ratio.as_ref().map_or("-".into(), |largest| {
                let place = largest.place;
                format!("{} {},{}", place.sensor, place.i, place.j)
            }),
        ];
        table.row([name_of(item)].into_iter().chain(counts).chain(rest));
    }
    let _ = writeln!(text, "{table}");
    for name in &recorded.unknown {
        let _ = writeln!(text, "Unknown channel, not compared: {name}");
    }
    if !recorded.unknown.is_empty() {
        let _ = writeln!(
            text,
            "Say which map a channel is by --channel MAP=CHANNEL, such as --channel depth.Z=CHANNEL."
        );
    }
    for remark in coarse_storages(recorded) {
        let _ = writeln!(text, "{remark}");
    }
    for why in ["not given", "stored in a type that cannot hold it"] {
        let names: Vec<String> = items_not_given(check)
            .into_iter()
            .filter(|(_, reason)| *reason == why)
            .map(|(item, _)| name_of(item))
            .collect();
        if !names.is_empty() {
            let _ = writeln!(text, "Not compared, because {why}: {}", names.join(", "));
        }
    }
    for one in listed_defects(&check.sensors).into_iter().take(MAX_SHOWN_DEFECTS) {
        let _ = writeln!(text, "{}, {}: {}", one.place, name_of(one.item), one.words());
        let _ = writeln!(text, "    {}", one.what);
        let _ = writeln!(text, "    {}", checked.repro(one.place));
    }
    let _ = writeln!(text, "{}", pack_words(&checked.pack, checked.verified));
    let _ = writeln!(text, "{} {}", sign(checked), headline(checked));
    if let Some(why) = checked.why() {
        let _ = writeln!(text, "  Why: {why}.");
    }
    text
}

/// Which pack it was and what of it was verified, in a sentence.
fn pack_words(pack: &PackIdentity, Verified { answers, of, rays }: Verified) -> String {
    let all = if answers == of { "all " } else { "" };
    let hint = if answers == of { "" } else { " (all: --verify)" };
    let rays = counted(rays, "array of rays is that", "arrays of rays are those");
    format!(
        "The pack ({}): {all}{} of {} answers are the referee's{hint}, and so is each by which a ray is wrong; {rays} of its scene.",
        pack.words(),
        count(answers),
        count(of)
    )
}
