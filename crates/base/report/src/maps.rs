//! Range maps of a sensor side by side, and their differences: pictures with axes, colour bars and rings, as HTML.

use askama::Template;
use raypencil_scene::{Image, Maybe, Place, SensorId};

use crate::picture::{ColourMap, Picture, Reduction};
use crate::plot::{Bar, Plot, Ring, cells_axis, reduced_to, shape, stretch};
use crate::scale::{Scale, Spread, Tick};
use crate::text::{count, escaped, number};

/// Maximum marked defects in a picture.
const MAX_MARKS: usize = 100;

/// The pictures of one sensor and their axes.
#[derive(Debug, Template)]
#[template(path = "maps.html")]
pub struct SensorPlots {
    /// Aspect ratio of a picture, in the notation of CSS.
    aspect: String,
    /// Whether a picture is as wide as the page.
    wide: bool,
    columns: Vec<Tick>,
    rows: Vec<Tick>,
    column: &'static str,
    /// Remark if the pictures are stretched or reduced.
    pub note: String,
    /// The pictures, in order.
    pub plots: Vec<Plot>,
    sensor: SensorId,
    reduction: Reduction,
}

/// Two range maps whose difference is drawn: `b - a`.
#[derive(Debug, Clone, Copy)]
pub struct MapPair<'a> {
    /// Name and map that are subtracted.
    pub a: (&'a str, &'a Image<Maybe<f64>>),
    /// Name and map from which they are subtracted.
    pub b: (&'a str, &'a Image<Maybe<f64>>),
}

impl SensorPlots {
    /// No pictures yet, each of which will have at most `max_side` columns and rows.
    pub fn new(sensor: SensorId, (width, height): (u32, u32), max_side: u32) -> Self {
        let reduction = Reduction::to_fit(width, height, max_side);
        let (wide, drawn_height) = shape(width, height);
        Self {
            aspect: format!("{width} / {drawn_height}"),
            wide,
            columns: cells_axis(width, if wide { 8 } else { 6 }),
            rows: cells_axis(height, if wide { 3 } else { 6 }),
            column: if sensor == SensorId::Camera { "pixel column" } else { "pencil column" },
            note: note(reduction, stretch(width, height)),
            plots: Vec::new(),
            sensor,
            reduction,
        }
    }

    /// The pictures as HTML.
    ///
    /// # Errors
    /// An error of the template.
    pub fn html(&self) -> Result<String, askama::Error> {
        self.render()
    }

    /// The pictures as HTML, below a title, the size of the maps and some words.
    ///
    /// # Errors
    /// An error of the template.
    pub fn section(&self, title: &str, size: &str, words: &str) -> Result<String, askama::Error> {
        let [title, size, words, note] = [title, size, words, &self.note].map(escaped);
        let note = if note.is_empty() { note } else { format!("<div class=\"soft\">{note}</div>\n") };
        let pictures = self.html()?;
        Ok(format!(
            "<section class=\"sensor\">\n<h3>{title} <span class=\"soft\">{size}</span></h3>\n\
             <div class=\"soft\">{words}</div>\n{note}{pictures}\n</section>\n"
        ))
    }

    /// Adds the pictures of some range maps, on one scale.
    ///
    /// ```
    /// use raypencil_report::{MapPair, SensorPlots};
    /// use raypencil_scene::{Image, Maybe, SensorId};
    ///
    /// let exact = Image::filled(4, 3, Maybe::some(2.0));
    /// let mut mine = exact.clone();
    /// mine.set(1, 1, Maybe::some(2.5));
    /// let mut plots = SensorPlots::new(SensorId::Camera, (4, 3), 1024);
    /// plots.add_ranges(&[("exact", &exact), ("mine", &mine)]);
    /// plots.add_difference(MapPair { a: ("exact", &exact), b: ("mine", &mine) }, None, [].into_iter());
    /// // 11 of the 12 ranges are equal; the other one is 0.5 m too long.
    /// assert!(plots.plots[2].note.starts_with("Colours span ±0.500 m, the largest difference. 11 of 12"));
    /// assert_eq!(plots.html()?.matches("<img").count(), 3);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn add_ranges(&mut self, maps: &[(&str, &Image<Maybe<f64>>)]) {
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
        for (index, (name, map)) in maps.iter().enumerate() {
            let shown = scale.map_or("no hit anywhere".into(), |Scale { low, high, .. }| {
                format!("{} to {} m", number(low), number(high))
            });
            let picture = Picture::of_map(map, scale.unwrap_or(Scale::linear(0.0, 0.0)), self.reduction);
            self.plots.push(Plot {
                title: (*name).to_string(),
                alt: format!("Range map of {} by {name}: {shown}", self.sensor),
                source: picture.data_uri(),
                width: picture.width,
                height: picture.height,
                of_differences: false,
                // Pictures below one another share the colour bar of the last.
                bar: bar.clone().filter(|_| !self.wide || index == last),
                note: String::new(),
                marks: Vec::new(),
            });
        }
    }

    /// Adds the picture of a difference, with rings around `defects`. `differences`: `b - a`, if it is known already.
    pub fn add_difference(
        &mut self,
        MapPair { a: (name_a, of_a), b: (name_b, of_b) }: MapPair<'_>,
        differences: Option<&Image<Maybe<f64>>>,
        defects: impl Iterator<Item = Place>,
    ) {
        let subtracted;
        let differences = match differences {
            Some(differences) => differences,
            None => {
                let cells = of_a.cells().iter().zip(of_b.cells());
                let cells = cells.map(|(a, b)| a.get().zip(b.get()).map(|(a, b)| b - a).into());
                subtracted = Image::from_cells(of_a.width(), of_a.height(), cells.collect());
                &subtracted
            }
        };
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
        let scale_of_picture = scale.unwrap_or(Scale::linear(0.0, 0.0));
        let picture = Picture::of_differences(differences, one_sided, scale_of_picture, self.reduction);
        let marks = marks(defects, differences);
        self.plots.push(Plot {
            title: format!("{name_b} minus {name_a}"),
            alt: format!("Difference of the range maps of {}, {name_b} minus {name_a}. {note}", self.sensor),
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
        });
    }
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
