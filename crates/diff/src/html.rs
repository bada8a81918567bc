//! `report.html` of a comparison: one file that links to nothing, with pictures of the channels that differ.

use askama::Template;

use crate::cells::{Differs, differs};
use crate::difference::{ChannelDifference, Difference, Sides};
use crate::screen::{allowed, exact, headline, rulings, unequal};
use raypencil_files::{Storage, Values};
use raypencil_report::{
    ColourMap, Picture, Reduction, Scale, Tick, cells_axis, count, counted, number, quantity, shape, stretch,
};
use raypencil_report::{VERSION, page_head, reduced_to};
use raypencil_scene::{Image, Maybe};

/// What this page alone needs.
const STYLE: &str = "table.classes td { white-space: nowrap; }\n";

/// Channels that have pictures; the table has all.
const PICTURED: usize = 24;

/// All pictures together have at most this many cells: a few megabytes of page.
const MOST_CELLS: u64 = 3_300_000;

/// No picture has more columns or rows; more than a page shows.
const MOST_ACROSS: u32 = 1024;

#[derive(Template)]
#[template(path = "diff.html")]
struct Page<'a> {
    /// The start of the page.
    head: String,
    passes: bool,
    headline: String,
    names: [&'a str; 2],
    allowed: String,
    version: &'static str,
    rows: Vec<Row>,
    only: Vec<(&'static str, &'a [String])>,
    /// Lines of what the referee says, if it was asked.
    rulings: Vec<String>,
    channels: Vec<Section>,
    more: String,
}

/// A channel in the table.
struct Row {
    key: String,
    fails: bool,
    numbers: [String; 7],
    worst: Option<[String; 3]>,
}

/// A channel in pictures.
struct Section {
    key: String,
    size: String,
    words: String,
    aspect: String,
    wide: bool,
    columns: Vec<Tick>,
    rows: Vec<Tick>,
    note: String,
    pictures: Vec<Figure>,
}

/// One picture and its scale bar.
struct Figure {
    title: String,
    alt: String,
    source: String,
    width: u32,
    height: u32,
    gradient: String,
    ticks: Vec<Tick>,
    label: String,
    /// What the colour of one side means, if it is there.
    one_sided: &'static str,
    /// What a cell without a colour means, if there is one.
    empty: &'static str,
}

/// The whole page.
pub(super) fn html(difference: &Difference, sides: &Sides) -> Result<String, askama::Error> {
    let unequal = unequal(difference);
    let pictured = &unequal[..unequal.len().min(PICTURED)];
    let most = most_across(pictured);
    let equal = difference.channels.iter().filter(|channel| channel.unequal == 0);
    let more = unequal.len() - pictured.len();
    let headline = headline(difference);
    let sign = if difference.passes() { "PASS" } else { "FAIL" };
    let page = Page {
        head: page_head(&format!("{sign} {headline}"), STYLE),
        passes: difference.passes(),
        headline,
        names: sides.names,
        allowed: allowed(&difference.thresholds),
        version: VERSION,
        rows: unequal.iter().copied().chain(equal).map(row).collect(),
        only: ["A", "B"]
            .into_iter()
            .zip(difference.only.iter().map(Vec::as_slice))
            .filter(|(_, keys)| !keys.is_empty())
            .collect(),
        rulings: rulings(difference).into_iter().filter(|line| !line.is_empty()).collect(),
        channels: pictured.iter().map(|channel| section(channel, sides, most)).collect(),
        more: if more > 0 { counted(more as u64, "more channel", "more channels") } else { String::new() },
    };
    page.render()
}

/// The most columns and rows of a picture that keep all of them within [`MOST_CELLS`].
fn most_across(channels: &[&ChannelDifference]) -> u32 {
    let cells = |most: u32| -> u64 {
        let drawn = channels.iter().map(|channel| {
            let Reduction { columns, rows } = Reduction::to_fit(channel.width, channel.height, most);
            u64::from(channel.width.div_ceil(columns)) * u64::from(channel.height.div_ceil(rows))
        });
        3 * drawn.sum::<u64>()
    };
    let mut most = MOST_ACROSS;
    while most > 32 && cells(most) > MOST_CELLS {
        most /= 2;
    }
    most
}

fn row(channel: &ChannelDifference) -> Row {
    let optional = |value: Option<f64>| value.map_or("–".into(), number);
    Row {
        key: channel.key.clone(),
        fails: channel.fails,
        numbers: [
            count(channel.cells()),
            count(channel.differing),
            format!("{} %", number(channel.percent())),
            channel.largest.map_or("–".into(), |largest| quantity(largest, &channel.unit)),
            optional(channel.largest_ulp),
            optional(channel.rms),
            optional(channel.mean),
        ],
        worst: channel
            .worst
            .map(|worst| [format!("{},{}", worst.i, worst.j), exact(worst.a), exact(worst.b)]),
    }
}

fn section(channel: &ChannelDifference, sides: &Sides, most: u32) -> Section {
    let (width, height) = (channel.width, channel.height);
    let reduction = Reduction::to_fit(width, height, most);
    let (wide, drawn_height) = shape(width, height);
    let values = sides.channels.map(|channels| &channels.by_key[&channel.key].values);
    let mut notes = Vec::new();
    if stretch(width, height) > 1 {
        notes.push(format!("Rows are drawn {} times as high as columns are wide.", stretch(width, height)));
    }
    notes.extend(reduced_to(reduction));
    let words = format!(
        "{} of {} beyond what is allowed, {} not the same",
        count(channel.differing),
        counted(channel.cells(), "cell", "cells"),
        count(channel.unequal)
    );
    let mut pictures = vec![errors(channel, values, reduction)];
    pictures.extend(both(channel, sides, values, reduction));
    Section {
        key: channel.key.clone(),
        size: format!("{width} × {height}"),
        words,
        aspect: format!("{width} / {drawn_height}"),
        wide,
        columns: cells_axis(width, if wide { 8 } else { 6 }),
        rows: cells_axis(height, if wide { 3 } else { 6 }),
        note: notes.join(" "),
        pictures,
    }
}

/// The heat map of |difference|.
fn errors(channel: &ChannelDifference, [a, b]: [&Values; 2], reduction: Reduction) -> Figure {
    let (width, height) = a.size();
    let cells = width as usize * height as usize;
    let wholes = channel.storage == Storage::Whole;
    let incomparable = |index: usize| match differs(a.real(index), b.real(index)) {
        Differs::Incomparable => true,
        Differs::By(_) => wholes,
        Differs::Same => false,
    };
    let error = |index: usize| match differs(a.real(index), b.real(index)) {
        Differs::By(by) if by.is_finite() => Some(by),
        Differs::Same if a.real(index).is_finite() => Some(0.0),
        _ => None,
    };
    let errors: Vec<Maybe<f64>> = (0..cells).map(|index| error(index).into()).collect();
    // How far apart whole numbers are means nothing, and where all numbers are the same nothing has a size.
    let scale = Scale::from_zero(errors.iter().filter_map(|cell| cell.get()));
    let scale = scale.filter(|scale| !wholes && scale.high > 0.0);
    let image = Image::from_cells(width, height, errors);
    let at = |i: u32, j: u32| incomparable(j as usize * width as usize + i as usize);
    let drawn = scale.unwrap_or(Scale::linear(0.0, f64::INFINITY));
    let picture = Picture::of_errors(&image, at, drawn, reduction);
    let unit = if channel.unit.is_empty() { String::new() } else { format!(", {}", channel.unit) };
    Figure {
        title: "|B − A|".into(),
        alt: format!("Absolute difference of {}", channel.key),
        source: picture.data_uri(),
        width: picture.width,
        height: picture.height,
        gradient: ColourMap::Sequential.css(),
        ticks: scale.map_or(Vec::new(), |scale| scale.ticks(5)),
        label: format!("difference{unit} (even steps of its root)"),
        one_sided: match (wholes, channel.incomparable) {
            (true, _) => "not the same",
            (false, 0) => "",
            _ => "NaN or infinite on one side",
        },
        empty: if any_empty(&image) { "the same NaN or infinity" } else { "" },
    }
}

/// A and B on one scale.
fn both(
    channel: &ChannelDifference,
    sides: &Sides,
    values: [&Values; 2],
    reduction: Reduction,
) -> [Figure; 2] {
    let images = values.map(|values| {
        let (width, height) = values.size();
        let cells = 0..width as usize * height as usize;
        let wholes = matches!(values, Values::Wholes(_));
        let shown = |value: f64| value.is_finite() && !(wholes && value == f64::from(u32::MAX));
        let cells = cells.map(|index| Some(values.real(index)).filter(|&value| shown(value)).into());
        Image::from_cells(width, height, cells.collect())
    });
    let numbers =
        images.iter().flat_map(|image: &Image<Maybe<f64>>| image.cells()).filter_map(|cell| cell.get());
    let scale = Scale::of(numbers);
    let figure = |side: usize| {
        let picture = Picture::of_map(&images[side], scale.unwrap_or(Scale::linear(0.0, 0.0)), reduction);
        let letter = ["A", "B"][side];
        Figure {
            title: letter.into(),
            alt: format!("{} of {letter}, {}", channel.key, sides.names[side]),
            source: picture.data_uri(),
            width: picture.width,
            height: picture.height,
            gradient: ColourMap::Sequential.css(),
            ticks: scale.map_or(Vec::new(), |scale| scale.ticks(5)),
            label: channel.unit.clone(),
            one_sided: "",
            empty: if any_empty(&images[side]) { "NaN, infinite or none" } else { "" },
        }
    };
    [figure(0), figure(1)]
}

fn any_empty(image: &Image<Maybe<f64>>) -> bool {
    image.cells().iter().any(|cell| cell.get().is_none())
}
