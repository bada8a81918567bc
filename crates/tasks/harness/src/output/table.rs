//! The table of quantities and classes, ready to be printed.

use raypencil_judge::{
    ApproximationTallies, ApproximationTally, Class, ItemTally, Largest, Quantity, SensorResult,
};
use raypencil_report::{count, quantity};
use raypencil_scene::{SensorMap, Switches};
use raypencil_scene_io::{Subject, probe_command};

/// One quantity, summed over one or more sensors.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Row {
    pub(crate) quantity: Quantity,
    pub(crate) agree: String,
    pub(crate) tie: String,
    pub(crate) rounding: String,
    pub(crate) approximation: String,
    pub(crate) defects: String,
    /// Whether the quantity has defects.
    pub(crate) fails: bool,
    pub(crate) not_compared: String,
    pub(crate) error: Option<Extreme>,
    pub(crate) ratio: Option<Extreme>,
}

/// A worst value in words, with the command that shows its ray.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Extreme {
    pub(crate) value: String,
    pub(crate) place: String,
    pub(crate) command: String,
}

/// The rows of `sensors`, each quantity summed over them.
pub(crate) fn rows<'a>(subject: &Subject, sensors: impl IntoIterator<Item = &'a SensorResult>) -> Vec<Row> {
    totals(sensors)
        .into_iter()
        .map(|(quantity, tally)| Row {
            quantity,
            agree: count(tally.of(Class::Agree)),
            tie: count(tally.of(Class::Tie)),
            rounding: count(tally.of(Class::Rounding)),
            approximation: count(tally.of(Class::Approximation)),
            defects: count(tally.of(Class::Defect)),
            fails: tally.of(Class::Defect) > 0,
            not_compared: count(tally.not_compared),
            error: extreme(subject, &tally.worst_error, quantity.unit(subject.scene.flux_model())),
            ratio: extreme(subject, &tally.worst_ratio, ""),
        })
        .collect()
}

/// The effects of one set of the paper's approximations.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct CauseRow {
    pub(crate) cause: String,
    pub(crate) rays: String,
    pub(crate) lost: String,
    pub(crate) added: String,
    pub(crate) error: Option<Extreme>,
}

pub(crate) fn causes(subject: &Subject, approximations: &ApproximationTallies) -> Vec<CauseRow> {
    let row = |(cause, tally): (&Switches, &ApproximationTally)| CauseRow {
        cause: cause.to_string(),
        rays: count(tally.rays),
        lost: count(tally.lost),
        added: count(tally.added),
        error: extreme(subject, &tally.worst_range, "m"),
    };
    approximations.iter().map(row).collect()
}

fn extreme(subject: &Subject, worst: &Option<Largest>, unit: &str) -> Option<Extreme> {
    worst.as_ref().map(|&Largest { value, place, .. }| Extreme {
        value: quantity(value, unit),
        place: place.to_string(),
        command: probe_command(subject, place),
    })
}

/// The tally of each quantity, summed over `sensors`.
pub(crate) fn totals<'a>(sensors: impl IntoIterator<Item = &'a SensorResult>) -> Vec<(Quantity, ItemTally)> {
    let mut totals = Quantity::ALL.map(|quantity| (quantity, ItemTally::default()));
    for (item, tally) in sensors.into_iter().flat_map(|sensor| sensor.items.iter()) {
        totals[item.quantity as usize].1.add(tally);
    }
    // A quantity that no sensor has, or that was not requested, has no row.
    let is_there = |(_, tally): &(Quantity, ItemTally)| {
        tally.not_compared > 0 || tally.by_class.iter().any(|rays| *rays > 0)
    };
    totals.into_iter().filter(is_there).collect()
}

/// Number of rays that hit; `None` if the map has neither ranges nor faces.
pub(crate) fn hits(map: &SensorMap) -> Option<u64> {
    let ranges =
        || map.range.as_ref().map(|map| map.cells().iter().filter(|cell| cell.get().is_some()).count());
    let faces =
        || map.face.as_ref().map(|map| map.cells().iter().filter(|cell| cell.get().is_some()).count());
    ranges().or_else(faces).map(|hits| hits as u64)
}

/// A worst value without its place; empty if there is none.
pub(crate) fn worst(worst: &Option<Largest>, unit: &str) -> String {
    worst.as_ref().map_or(String::new(), |worst| quantity(worst.value, unit))
}
