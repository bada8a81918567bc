//! Words that the reports of a check share.

use raypencil_files::Storage;
use raypencil_judge::{Check, Class, Item, ItemTally, Recorded, name_of};
use raypencil_report::count;
use raypencil_scene::Precision;

use crate::check::Checked;

/// Maximum number of defects that a screen or a test case describes; all are counted.
pub(crate) const MAX_SHOWN_DEFECTS: usize = 5;

/// The name of an arithmetic.
pub(crate) fn arithmetic(precision: Precision) -> &'static str {
    if precision == Precision::F32 { "f32" } else { "f64" }
}

/// The outcome of a check.
pub(crate) fn verdict(checked: &Checked) -> &'static str {
    match (checked.check.compared(), checked.check.passes(), checked.hits_anything()) {
        (0, ..) => "nothing_compared",
        (_, false, _) => "defects",
        (_, true, true) => "agrees",
        (_, true, false) => "nothing_hit",
    }
}

/// A sign that does not depend on colour.
pub(crate) fn sign(checked: &Checked) -> &'static str {
    match verdict(checked) {
        "agrees" => "✓",
        "defects" => "✗",
        _ => "?",
    }
}

/// The outcome in one sentence. A recording in half precision, or in steps, is never said to be exact.
pub(crate) fn headline(checked: &Checked) -> String {
    let Checked { check, recorded, .. } = checked;
    let rays = count(check.compared());
    let of = |class| count(check.of(class));
    let is_partial = check.totals().values().any(|tally| tally.not_compared > 0);
    let partial = if is_partial { "; nothing is known about what was not compared" } else { "" };
    let (tie, rounding) = (of(Class::Tie), of(Class::Rounding));
    match verdict(checked) {
        "agrees" => match recorded.coarseness() {
            None => format!(
                "{rays} rays agree with the exact answers: {} exact, {tie} tie, {rounding} rounding{partial}.",
                of(Class::Agree)
            ),
            Some(coarse) => format!(
                "{rays} rays agree to {coarse}: {} agree, {tie} tie, {rounding} rounding{partial}.",
                of(Class::Agree)
            ),
        },
        "defects" => {
            format!("{} of {rays} rays are wrong, {} undecided.", of(Class::Defect), of(Class::Undecided))
        }
        "nothing_hit" => {
            format!(
                "No ray of this pack hits anything: that the candidate says so on {rays} rays proves little."
            )
        }
        _ => "Nothing was compared.".into(),
    }
}

/// A remark for each storage that is coarser than single precision: what is stored so, and which errors it hides.
pub(crate) fn coarse_storages(recorded: &Recorded) -> Vec<String> {
    let remark = |(how, items): (Storage, Vec<Item>)| {
        let names = items.into_iter().map(name_of).collect::<Vec<_>>().join(", ");
        match how {
            Storage::Steps(step) => format!(
                "Stored in {how} and judged as such: {names}. Errors below half a step, {} m, cannot be seen",
                0.5 * step.get()
            ),
            _ => format!(
                "Stored in half precision (11 binary digits, up to {}) and judged as such: {names}. Errors below a 2048th of a \
                 number, 1 mm at 2 m, cannot be seen",
                Storage::F16.max()
            ),
        }
    };
    recorded.coarse_items().into_iter().map(remark).collect()
}

/// Why nothing of an item was compared: it was not given, or its type cannot hold it. `None` if it was compared, or if
/// no ray has it, such as a range where nothing is hit.
pub fn not_given(tally: &ItemTally) -> Option<&'static str> {
    match (tally.compared(), tally.not_compared, tally.unjudged.is_empty()) {
        (1.., _, _) | (0, 0, _) => None,
        (0, _, true) => Some("not given"),
        (0, _, false) => Some("stored in a type that cannot hold it"),
    }
}

/// Rays of which an item was not given. Rays whose storage cannot hold it are not among them.
pub fn rays_not_given(tally: &ItemTally) -> u64 {
    tally.not_compared - tally.unjudged.len() as u64
}

/// The tallies of a check as reports list them. A flux on the image that is given for no beam is one item, and not one for
/// each beam.
pub(crate) fn listed_totals(check: &Check) -> Vec<(Item, ItemTally)> {
    let totals = check.totals();
    let is_absent_of_all = |item: &Item| {
        let alike =
            |other: &&Item| other.quantity == item.quantity && other.is_other_model == item.is_other_model;
        totals.keys().filter(alike).all(|other| not_given(&totals[other]).is_some())
    };
    let mut listed: Vec<(Item, ItemTally)> = Vec::new();
    for (item, tally) in &totals {
        let item = if is_absent_of_all(item) { Item { beam: None, ..*item } } else { *item };
        if listed.iter().all(|(other, _)| *other != item) {
            listed.push((item, tally.clone()));
        }
    }
    listed
}

/// Names of the items of a check that were not given, or that their type cannot hold.
pub fn items_not_given(check: &Check) -> Vec<(Item, &'static str)> {
    listed_totals(check).into_iter().filter_map(|(item, tally)| Some((item, not_given(&tally)?))).collect()
}
