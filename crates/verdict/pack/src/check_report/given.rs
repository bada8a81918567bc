//! What a candidate gives, what it does not, and in which type it stores it.

use raypencil_files::Storage;
use raypencil_judge::{Check, Item, ItemTally, Recorded, name_of};

/// A remark for each storage that is coarser than single precision: what is stored so, and which errors it hides.
pub(crate) fn coarse_storages(recorded: &Recorded) -> Vec<String> {
    let remark = |(how, items): (Storage, Vec<Item>)| {
        let names = items.into_iter().map(name_of).collect::<Vec<_>>().join(", ");
        match how {
            Storage::Steps(step) => format!(
                "Stored in {how} and judged as such: {names}. Errors below half a step, {} m, cannot be seen",
                0.5 * step.get()
            ),
            _ => half_precision_note(&names),
        }
    };
    recorded.coarse_items().into_iter().map(remark).collect()
}

/// The remark for half precision, of these names.
pub fn half_precision_note(names: &str) -> String {
    format!(
        "Stored in half precision (11 binary digits, up to {}) and judged as such: {names}. Errors below a 2048th of a \
         number, 1 mm at 2 m, cannot be seen",
        Storage::F16.max()
    )
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

#[cfg(test)]
mod tests {
    use std::path::Path;

    use raypencil_files::Step;
    use raypencil_judge::Quantity;
    use raypencil_scene::{Place, Precision, SensorId};
    use raypencil_scene_io::{Overrides, load};

    use super::*;

    #[test]
    fn a_remark_on_a_coarse_storage_says_which_errors_it_hides() {
        let scene = load("pyramids", &Overrides::default()).expect("a built-in scene").scene;
        let of = |how: Storage| {
            let mut recorded = Recorded::without_maps(Path::new("mine"), &scene, Precision::F64);
            recorded.storage.insert((SensorId::Camera, Quantity::Range.into()), how);
            coarse_storages(&recorded)
        };
        let millimetres = Storage::Steps(Step::new(0.001).expect("a step"));
        let [remark] = of(millimetres).try_into().expect("one remark");
        assert!(
            remark
                .ends_with(" and judged as such: range. Errors below half a step, 0.0005 m, cannot be seen")
        );
        assert_eq!(of(Storage::F16), [half_precision_note("range")]);
        assert_eq!(of(Storage::F32), Vec::<String>::new());
    }

    #[test]
    fn a_ray_whose_type_cannot_hold_an_item_is_given_nevertheless() {
        let unjudged = |count: u32| (0..count).map(|i| Place { sensor: SensorId::Camera, i, j: 0 }).collect();
        let tally = |not_compared, of_type| ItemTally {
            not_compared,
            unjudged: unjudged(of_type),
            ..ItemTally::default()
        };
        assert_eq!([tally(7, 2), tally(7, 0), tally(7, 7)].map(|tally| rays_not_given(&tally)), [5, 7, 0]);
        assert_eq!(not_given(&tally(7, 0)), Some("not given"));
        assert_eq!(not_given(&tally(7, 2)), Some("stored in a type that cannot hold it"));
        assert_eq!(not_given(&tally(0, 0)), None);
    }
}
