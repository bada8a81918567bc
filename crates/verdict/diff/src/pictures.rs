//! Pictures of the channels that are not equal: their difference, and both sides on one scale.

use askama::Template;
use raypencil_files::{Storage, Values};
use raypencil_report::{
    ColourMap, Picture, Reduction, Scale, Tick, cells_axis, count, counted, max_side_of_pictures, reduced_to,
    shape, stretch,
};
use raypencil_scene::{Image, Maybe};

use crate::cells::{Comparison, compare_numbers, number};
use crate::difference::{ChannelDifference, Difference, Sides};
use crate::words::unequal;

/// Maximum number of channels with pictures; the table has all channels.
const MAX_PICTURED_CHANNELS: usize = 24;

/// Pictures of a channel: the difference, A and B.
const PICTURES_PER_CHANNEL: u64 = 3;

#[derive(Template)]
#[template(path = "pictures.html")]
struct Pictures {
    channels: Vec<Section>,
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

/// The pictures as HTML, and in words how many more channels are not equal; empty if none.
pub(crate) fn pictures(difference: &Difference, sides: &Sides) -> Result<(String, String), askama::Error> {
    let unequal = unequal(difference);
    let pictured = &unequal[..unequal.len().min(MAX_PICTURED_CHANNELS)];
    let sizes: Vec<(u32, u32)> = pictured.iter().map(|channel| (channel.width, channel.height)).collect();
    let max_side = max_side_of_pictures(&sizes, PICTURES_PER_CHANNEL);
    let more = match unequal.len() - pictured.len() {
        0 => String::new(),
        more => format!("{} without pictures.", counted(more as u64, "more channel", "more channels")),
    };
    let channels = pictured.iter().map(|channel| section(channel, sides, max_side)).collect();
    Ok((Pictures { channels }.render()?, more))
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
    let compared = |index: usize| compare_numbers(number(a, b, index), number(b, a, index));
    let incomparable = |index: usize| match compared(index) {
        Comparison::Incomparable => true,
        Comparison::Apart(_) => is_whole,
        Comparison::Equal => false,
    };
    let difference = |index: usize| match compared(index) {
        Comparison::Apart(difference) if difference.is_finite() => Some(difference),
        Comparison::Equal if number(a, b, index).is_finite() => Some(0.0),
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
