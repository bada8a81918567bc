//! The tables of a validation.

use raypencil_judge::{
    ApproximationTallies, ApproximationTally, Class, ItemTally, Largest, Quantity, SensorResult,
};
use raypencil_report::{Column, Grid, Room, count, quantity, time};
use raypencil_scene::{Place, SensorMap, Stage, Switches};
use raypencil_scene_io::{Subject, probe_command};

use crate::output::verdict::Ruled;
use crate::rendered::Rendered;
use crate::validation::{Pair, Validation};

/// The names of a pair.
pub(super) fn title(validation: &Validation, pair: &Pair) -> String {
    format!("{} against {}", validation.rendered[pair.a].name, validation.rendered[pair.b].name)
}

/// The heads of a table of quantities by classes.
fn columns() -> Vec<Column> {
    vec![
        Column::text("quantity"),
        Column::text("sensor"),
        Column::text("renderers"),
        Column::number("agree"),
        Column::number("tie"),
        Column::number("rounding"),
        Column::number("approximation"),
        Column::number("defect"),
        Column::number("not compared"),
        Column::number("worst error"),
        Column::text("at"),
        Column::number("worst error / bound"),
        Column::text("at"),
        Column::code("the worst error"),
    ]
}

/// Each quantity, summed over the sensors of a pair.
pub(super) fn quantities(validation: &Validation) -> Grid {
    let mut grid = Grid::new(columns());
    for pair in &validation.pairs {
        add(&mut grid, &validation.subject, "", &name_among(validation, pair), &pair.sensors);
    }
    grid
}

/// Each quantity of each sensor of a pair.
pub(super) fn sensor_by_sensor(validation: &Validation) -> Grid {
    let mut grid = Grid::new(columns());
    for pair in &validation.pairs {
        for sensor in &pair.sensors {
            let name = sensor.sensor.to_string();
            add(&mut grid, &validation.subject, &name, &name_among(validation, pair), [sensor]);
        }
    }
    grid
}

/// The names of a pair; empty if it is the only one.
fn name_among(validation: &Validation, pair: &Pair) -> String {
    if validation.pairs.len() > 1 { title(validation, pair) } else { String::new() }
}

fn add<'a>(
    grid: &mut Grid,
    subject: &Subject,
    sensor: &str,
    renderers: &str,
    results: impl IntoIterator<Item = &'a SensorResult>,
) {
    for (quantity, tally) in totals(results) {
        let unit = quantity.unit(subject.scene.flux_model());
        // A class that nothing belongs to leaves its column out, if it is rare.
        let if_any = |number: u64| if number > 0 { count(number) } else { String::new() };
        let cells = [
            quantity.to_string(),
            sensor.to_string(),
            renderers.to_string(),
            count(tally.of(Class::Agree)),
            count(tally.of(Class::Tie)),
            count(tally.of(Class::Rounding)),
            if_any(tally.of(Class::Approximation)),
            count(tally.of(Class::Defect)),
            if_any(tally.not_compared),
            worst(&tally.worst_error, unit),
            place(&tally.worst_error, Place::to_string),
            worst(&tally.worst_ratio, ""),
            place(&tally.worst_ratio, Place::to_string),
            place(&tally.worst_error, |place| probe_command(subject, *place)),
        ];
        grid.row_with_room(cells, tally.of(Class::Defect) > 0, Room::Wide);
    }
}

/// The same sum in few columns for a screen, with or without the places.
pub(super) fn quantities_of_screen(Ruled { validation, counts, .. }: &Ruled<'_>, with_places: bool) -> Grid {
    // The paper's approximations have a column only if there are any.
    let any_approximation = counts.approximation > 0;
    let mut grid = Grid::new([
        Column::text(""),
        Column::number("agree"),
        Column::number("tie"),
        Column::number("rounding"),
        Column::number("approx."),
        Column::number("defect"),
        Column::number("error"),
        Column::text("at"),
        Column::number("/bound"),
    ]);
    for (quantity, tally) in totals(validation.pairs.iter().flat_map(|pair| &pair.sensors)) {
        let cells = [
            quantity.to_string(),
            count(tally.of(Class::Agree)),
            count(tally.of(Class::Tie)),
            count(tally.of(Class::Rounding)),
            if any_approximation { count(tally.of(Class::Approximation)) } else { String::new() },
            count(tally.of(Class::Defect)),
            worst(&tally.worst_error, quantity.unit(validation.subject.scene.flux_model())),
            if with_places { place(&tally.worst_error, |place| short(*place)) } else { String::new() },
            worst(&tally.worst_ratio, ""),
        ];
        grid.row_with_room(cells, tally.of(Class::Defect) > 0, Room::Screen);
    }
    grid
}

/// A place in few letters.
pub(super) fn short(Place { sensor, i, j }: Place) -> String {
    format!("{sensor} {i},{j}")
}

/// What became of the rays of each sensor.
pub(super) fn sensors(validation: &Validation) -> Grid {
    let mut grid = Grid::new([
        Column::text("sensor"),
        Column::text("renderers"),
        Column::number("rays compared"),
        Column::number("hits"),
        Column::number("agree"),
        Column::number("tie"),
        Column::number("rounding"),
        Column::number("approximation"),
        Column::number("defect"),
    ]);
    for pair in &validation.pairs {
        let [a, b] = [pair.a, pair.b].map(|index| &validation.rendered[index]);
        for sensor in &pair.sensors {
            let of = |side: &Rendered| {
                side.output.map(sensor.sensor).and_then(hits).map_or("unknown".into(), count)
            };
            let class = |class| count(sensor.of(class));
            let cells = [
                sensor.sensor.to_string(),
                title(validation, pair),
                count(sensor.compared()),
                format!("{} / {}", of(a), of(b)),
                class(Class::Agree),
                class(Class::Tie),
                class(Class::Rounding),
                class(Class::Approximation),
                class(Class::Defect),
            ];
            grid.row_with_room(cells, sensor.of(Class::Defect) > 0, Room::Wide);
        }
    }
    grid
}

/// The effects of each set of the paper's approximations.
pub(super) fn causes(validation: &Validation) -> Grid {
    let subject = &validation.subject;
    let mut grid = Grid::new([
        Column::text("cause"),
        Column::number("rays"),
        Column::number("hits lost"),
        Column::number("hits added"),
        Column::number("largest range error"),
        Column::text("at"),
        Column::code("the largest error"),
    ]);
    let approximations: ApproximationTallies = validation.approximations();
    for (cause, tally) in &approximations {
        let (cause, tally): (&Switches, &ApproximationTally) = (cause, tally);
        let cells = [
            cause.to_string(),
            count(tally.rays),
            count(tally.lost),
            count(tally.added),
            worst(&tally.worst_range, "m"),
            place(&tally.worst_range, Place::to_string),
            place(&tally.worst_range, |place| probe_command(subject, *place)),
        ];
        grid.row_with_room(cells, false, Room::Wide);
    }
    grid
}

/// The stages and their times.
pub(super) fn times(stages: &[Stage]) -> Grid {
    let mut grid = Grid::new([Column::text("stage"), Column::number("wall clock")]);
    for stage in stages {
        grid.row_with_room([stage.name.clone(), time(stage.time)], false, Room::Wide);
    }
    grid
}

/// The tally of each quantity, summed over `sensors`.
fn totals<'a>(sensors: impl IntoIterator<Item = &'a SensorResult>) -> Vec<(Quantity, ItemTally)> {
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
pub(super) fn worst(worst: &Option<Largest>, unit: &str) -> String {
    worst.as_ref().map_or(String::new(), |worst| quantity(worst.value, unit))
}

/// The place of a worst value in some words; empty if there is none.
fn place(worst: &Option<Largest>, words: impl Fn(&Place) -> String) -> String {
    worst.as_ref().map_or(String::new(), |worst| words(&worst.place))
}
