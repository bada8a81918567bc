//! Plots of a sensor's maps for the page: pictures with axes, colour bars and marks.

use raypencil_report::{
    Bar, ColourMap, Picture, Plot, Reduction, Ring, Scale, Spread, Tick, cells_axis, count,
    max_side_of_pictures, number, reduced_to, shape, stretch,
};
use raypencil_scene::{Image, Maybe, Place, SensorId};

use crate::rendered::Rendered;
use crate::validation::{Pair, Validation};

/// Maximum marked defects in a picture.
const MAX_MARKS: usize = 100;

/// The pictures of one sensor and their axes.
#[derive(Debug)]
pub(crate) struct Plots {
    /// Aspect ratio of a picture, in the notation of CSS.
    pub(crate) aspect: String,
    /// Whether a picture is as wide as the page.
    pub(crate) wide: bool,
    pub(crate) columns: Vec<Tick>,
    pub(crate) rows: Vec<Tick>,
    pub(crate) column: &'static str,
    /// Remark if the pictures are stretched or reduced.
    pub(crate) note: String,
    pub(crate) plots: Vec<Plot>,
}

/// Maximum columns and rows of a picture that keep the page to a few megabytes.
pub(crate) fn max_columns(validation: &Validation) -> u32 {
    let pictures = (validation.rendered.len() + validation.pairs.len()) as u64;
    let scene = &validation.subject.scene;
    let sizes: Vec<(u32, u32)> = scene.sensors().filter_map(|sensor| scene.size(sensor)).collect();
    max_side_of_pictures(&sizes, pictures)
}

/// The plots of one sensor, each picture with at most `max_columns` columns and rows.
pub(crate) fn plots(validation: &Validation, sensor: SensorId, max_columns: u32) -> Plots {
    let (width, height) = validation.subject.scene.size(sensor).expect("a sensor of this scene");
    let reduction = Reduction::to_fit(width, height, max_columns);
    let (wide, drawn_height) = shape(width, height);
    Plots {
        aspect: format!("{width} / {drawn_height}"),
        wide,
        columns: cells_axis(width, if wide { 8 } else { 6 }),
        rows: cells_axis(height, if wide { 3 } else { 6 }),
        column: if sensor == SensorId::Camera { "pixel column" } else { "pencil column" },
        note: note(reduction, stretch(width, height)),
        plots: range_plots(validation, sensor, reduction, wide)
            .into_iter()
            .chain(
                validation
                    .pairs
                    .iter()
                    .filter_map(|pair| difference_plot(validation, pair, sensor, reduction)),
            )
            .collect(),
    }
}

/// Plots of the range maps of all renderers, on one scale.
fn range_plots(validation: &Validation, sensor: SensorId, reduction: Reduction, wide: bool) -> Vec<Plot> {
    let maps: Vec<_> = validation
        .rendered
        .iter()
        .filter_map(|rendered| Some((rendered, rendered.output.map(sensor)?.range.as_ref()?)))
        .collect();
    let ranges = maps.iter().flat_map(|(_, map)| map.cells()).filter_map(|cell| cell.get());
    let scale = Scale::of_ranges(ranges);
    let bar = scale.map(|scale| Bar {
        gradient: ColourMap::Sequential.css(),
        ticks: scale.ticks(6),
        label: match scale.spread {
            Spread::Reciprocal => "range, m (even steps of 1/range)",
            _ => "range, m",
        },
        one_sided: false,
        marked: false,
    });
    let last = maps.len().saturating_sub(1);
    maps.iter()
        .enumerate()
        .map(|(index, (Rendered { name, .. }, map))| {
            let shown = scale.map_or("no hit anywhere".into(), |Scale { low, high, .. }| {
                format!("{} to {} m", number(low), number(high))
            });
            let picture = Picture::of_map(map, scale.unwrap_or(Scale::linear(0.0, 0.0)), reduction);
            Plot {
                title: name.clone(),
                alt: format!("Range map of {sensor} by {name}: {shown}"),
                source: picture.data_uri(),
                width: picture.width,
                height: picture.height,
                of_differences: false,
                // Pictures below one another share the colour bar of the last.
                bar: bar.clone().filter(|_| !wide || index == last),
                note: String::new(),
                marks: Vec::new(),
            }
        })
        .collect()
}

/// Plot of the difference of two range maps, with its defects marked.
fn difference_plot(
    validation: &Validation,
    pair: &Pair,
    sensor: SensorId,
    reduction: Reduction,
) -> Option<Plot> {
    let comparison = pair.sensors.iter().find(|comparison| comparison.sensor == sensor)?;
    let differences = comparison.range_difference.as_ref()?;
    let [a, b] = [pair.a, pair.b].map(|index| &validation.rendered[index]);
    let [of_a, of_b] = [a, b].map(|side| side.output.map(sensor).and_then(|map| map.range.as_ref()));
    let (of_a, of_b) = (of_a?, of_b?);
    let hit = |map: &Image<Maybe<f64>>, i, j| map.at(i, j).get().is_some();
    let one_sided = |i, j| hit(of_a, i, j) != hit(of_b, i, j);
    let cells = of_a.cells().iter().zip(of_b.cells());
    let any_one_sided = cells.clone().any(|(x, y)| x.get().is_some() != y.get().is_some());

    let values = || differences.cells().iter().filter_map(|cell| cell.get());
    let scale = Scale::symmetric(values());
    let (all, same) = (values().count() as u64, values().filter(|&value| value == 0.0).count() as u64);
    let limit = scale.map_or(0.0, |scale| scale.high);
    let note = if all == 0 {
        "No ray hits on both sides.".into()
    } else if limit == 0.0 {
        format!("All {} ranges are equal to the last bit.", count(all))
    } else {
        format!(
            "Colours span ±{} m, the largest difference. {} of {} ranges ({}\u{a0}%) are equal to the last bit.",
            number(limit),
            count(same),
            count(all),
            number(100.0 * same as f64 / all as f64)
        )
    };
    let picture =
        Picture::of_differences(differences, one_sided, scale.unwrap_or(Scale::linear(0.0, 0.0)), reduction);
    let marks = marks(comparison.defects.iter().map(|defect| defect.place), differences);
    Some(Plot {
        title: format!("{} minus {}", b.name, a.name),
        alt: format!("Difference of the range maps of {sensor}, {} minus {}. {note}", b.name, a.name),
        source: picture.data_uri(),
        width: picture.width,
        height: picture.height,
        of_differences: true,
        bar: Some(Bar {
            gradient: ColourMap::Diverging.css(),
            ticks: scale.map_or(Vec::new(), |scale| scale.ticks(5)),
            label: "difference, m (even steps of its square root)",
            one_sided: any_one_sided,
            marked: !marks.is_empty(),
        }),
        note,
        marks,
    })
}

/// Marks of the first places; a place so near to a mark that the rings would overlap gets none of its own.
fn marks(places: impl Iterator<Item = Place>, map: &Image<Maybe<f64>>) -> Vec<Ring> {
    let middle = |cell: u32, cells: u32| (f64::from(cell) + 0.5) / f64::from(cells);
    let (wide, drawn_height) = shape(map.width(), map.height());
    // A ring is 18 CSS pixels across, a picture about 1100 or 360.
    let (apart, height) = (if wide { 0.02 } else { 0.05 }, drawn_height as f64 / f64::from(map.width()));
    let mut marks: Vec<Ring> = Vec::new();
    for place in places.take(MAX_MARKS) {
        let (across, down) = (middle(place.i, map.width()), middle(place.j, map.height()));
        let near = |mark: &Ring| (mark.across - across).abs().max((mark.down - down).abs() * height) < apart;
        if !marks.iter().any(near) {
            marks.push(Ring { across, down, title: place.to_string() });
        }
    }
    marks
}

/// Remark on how a picture differs from its map.
fn note(reduction: Reduction, stretch: u32) -> String {
    let mut notes = Vec::new();
    if stretch > 1 {
        notes.push(format!("Rows are drawn {stretch} times as high as columns are wide."));
    }
    notes.extend(reduced_to(reduction));
    notes.join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cells_axis_counts_whole_cells() {
        let labels = |cells, most| -> Vec<String> {
            cells_axis(cells, most).into_iter().map(|tick| tick.label).collect()
        };
        assert_eq!(labels(1024, 6), ["0", "200", "400", "600", "800", "1000"]);
        assert_eq!(labels(16, 3), ["0", "10"]);
        assert_eq!(labels(3, 6), ["0", "1", "2"]);
        assert_eq!(labels(1, 6), ["0"]);
    }

    #[test]
    fn near_defects_share_a_mark() {
        let map = Image::filled(1024, 16, Maybe::some(0.0));
        let places = [(400, 3), (401, 3), (410, 9), (430, 3)];
        let places = places.map(|(i, j)| Place { sensor: SensorId::Beam(0), i, j });
        let marks = marks(places.into_iter(), &map);
        let titles: Vec<&str> = marks.iter().map(|mark| mark.title.as_str()).collect();
        // 48 columns' widths lie between rows 3 and 9, drawn 8 times as high; a ring is 20 of them.
        assert_eq!(titles, ["beam-0 pencil 400,3", "beam-0 pencil 410,9", "beam-0 pencil 430,3"]);
    }

    #[test]
    fn a_note_says_what_was_done_to_the_picture() {
        let note_of = |columns, rows, stretch| note(Reduction { columns, rows }, stretch);
        assert_eq!(note_of(1, 1, 1), "");
        assert_eq!(note_of(1, 1, 8), "Rows are drawn 8 times as high as columns are wide.");
        assert!(note_of(4, 1, 1).contains("4 × 1 cells become one"));
    }
}
