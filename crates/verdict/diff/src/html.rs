//! `report.html` of a comparison: one file without links, with pictures of the channels that are not equal.

use askama::Template;
use raypencil_files::{Storage, Values};
use raypencil_report::{
    ColourMap, Picture, Reduction, Scale, Tick, VERSION, cells_axis, count, counted, max_side_of_pictures,
    number, page_head, quantity, reduced_to, shape, stretch,
};
use raypencil_scene::{Image, Maybe};

use crate::cells::{Comparison, compare_numbers};
use crate::difference::{ChannelDifference, Difference, Sides};
use crate::explorer::explorer;
use crate::words::{allowed, exact, headline, rulings, unequal};

/// CSS rules of this page, beside those of every report.
const STYLE: &str = "table.classes td { white-space: nowrap; }\n";

/// Maximum number of channels with pictures; the table has all channels.
const MAX_PICTURED_CHANNELS: usize = 24;

/// Pictures of a channel: the difference, A and B.
const PICTURES_PER_CHANNEL: u64 = 3;

#[derive(Template)]
#[template(path = "diff.html")]
struct Page<'a> {
    /// Everything before the page's first line, with the styles.
    head: String,
    passes: bool,
    headline: String,
    names: [&'a str; 2],
    allowed: String,
    version: &'static str,
    rows: Vec<Row>,
    only: Vec<(&'static str, &'a [String])>,
    /// Lines of the referee's rulings; empty without a scene.
    rulings: Vec<String>,
    channels: Vec<Section>,
    /// How many more channels are not equal but have no pictures; else empty.
    more: String,
    /// Which channels the explorer leaves out; empty if none.
    left_out: String,
    /// Data, style and script of the part that answers when asked, as HTML.
    explorer: String,
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
    /// Legend of cells that cannot be compared; empty if there are none.
    one_sided: &'static str,
    /// Legend of cells without a colour; empty if there are none.
    empty: &'static str,
}

/// The page.
pub(crate) fn html(difference: &Difference, sides: &Sides) -> Result<String, askama::Error> {
    let unequal = unequal(difference);
    let pictured = &unequal[..unequal.len().min(MAX_PICTURED_CHANNELS)];
    let sizes: Vec<(u32, u32)> = pictured.iter().map(|channel| (channel.width, channel.height)).collect();
    let max_side = max_side_of_pictures(&sizes, PICTURES_PER_CHANNEL);
    let equal = difference.channels.iter().filter(|channel| channel.unequal == 0);
    let more = unequal.len() - pictured.len();
    let headline = headline(difference);
    let sign = if difference.passes() { "PASS" } else { "FAIL" };
    let (explorer, left_out) = explorer(difference, sides);
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
        channels: pictured.iter().map(|channel| section(channel, sides, max_side)).collect(),
        more: if more > 0 { counted(more as u64, "more channel", "more channels") } else { String::new() },
        left_out,
        explorer,
    };
    page.render()
}

/// A channel's line of the table.
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

/// A channel's pictures.
fn section(channel: &ChannelDifference, sides: &Sides, max_side: u32) -> Section {
    let (width, height) = (channel.width, channel.height);
    let reduction = Reduction::to_fit(width, height, max_side);
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
    let mut pictures = vec![difference_figure(channel, values, reduction)];
    pictures.extend(side_figures(channel, sides, values, reduction));
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

/// The heat map of |B - A|.
fn difference_figure(channel: &ChannelDifference, [a, b]: [&Values; 2], reduction: Reduction) -> Figure {
    let (width, height) = a.size();
    let cells = width as usize * height as usize;
    let is_whole = channel.storage == Storage::Whole;
    let incomparable = |index: usize| match compare_numbers(a.real(index), b.real(index)) {
        Comparison::Incomparable => true,
        Comparison::Apart(_) => is_whole,
        Comparison::Equal => false,
    };
    let difference = |index: usize| match compare_numbers(a.real(index), b.real(index)) {
        Comparison::Apart(difference) if difference.is_finite() => Some(difference),
        Comparison::Equal if a.real(index).is_finite() => Some(0.0),
        _ => None,
    };
    let differences: Vec<Maybe<f64>> = (0..cells).map(|index| difference(index).into()).collect();
    // No scale for whole numbers, whose differences have no meaning, and none if all differences are 0.
    let scale = Scale::from_zero(differences.iter().filter_map(|cell| cell.get()));
    let scale = scale.filter(|scale| !is_whole && scale.high > 0.0);
    let image = Image::from_cells(width, height, differences);
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
        one_sided: match (is_whole, channel.incomparable) {
            (true, _) => "not the same",
            (false, 0) => "",
            _ => "NaN or infinite on one side",
        },
        empty: if any_empty(&image) { "the same NaN or infinity" } else { "" },
    }
}

/// A and B on the same scale.
fn side_figures(
    channel: &ChannelDifference,
    sides: &Sides,
    values: [&Values; 2],
    reduction: Reduction,
) -> [Figure; 2] {
    let images = values.map(|values| {
        let (width, height) = values.size();
        let cells = 0..width as usize * height as usize;
        let is_whole = matches!(values, Values::Wholes(_));
        let shown = |value: f64| value.is_finite() && !(is_whole && value == f64::from(u32::MAX));
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

/// Whether a cell has no value.
fn any_empty(image: &Image<Maybe<f64>>) -> bool {
    image.cells().iter().any(|cell| cell.get().is_none())
}
