//! Everyone's answers held to the truth, ready to be printed: the renderers of this house beside those of others.

use serde::Serialize;
use std::collections::BTreeMap;

use crate::monte_carlo::{CHANCE_LIMITS, ImageComparison};
use crate::panel::{HeldOutsider, Panel};
use crate::radiance::RadianceComparison;
use crate::validation::Validation;
use raypencil_judge::{Check, Class, Item, ItemTally, Largest, key_of, name_of, unit_of};
use raypencil_report::{count, counted, number, quantity};
use raypencil_scene_io::{Subject, probe_command, quoted};

/// How many misses of an outsider are listed.
const LISTED: usize = 10;

/// The section of the page; empty if there is no outsider.
#[derive(Debug, Default)]
pub(crate) struct Outside {
    pub(crate) names: Vec<String>,
    pub(crate) rows: Vec<QuantityRow>,
    pub(crate) images: Vec<ImageRow>,
    pub(crate) radiance: Vec<RadianceRow>,
    pub(crate) misses: Vec<Misses>,
}

/// One quantity, and how each renderer fares.
#[derive(Debug)]
pub(crate) struct QuantityRow {
    pub(crate) quantity: String,
    pub(crate) cells: Vec<Option<Cell>>,
}

/// How a renderer fares in a quantity.
#[derive(Debug)]
pub(crate) struct Cell {
    pub(crate) is_wrong: bool,
    pub(crate) wrong: String,
    pub(crate) classes: String,
    /// The worst error, and that as a part of its bound; empty where there is no number.
    pub(crate) error: String,
    pub(crate) ratio: String,
    pub(crate) place: String,
}

/// An image by chance.
#[derive(Debug)]
pub(crate) struct ImageRow {
    pub(crate) who: String,
    pub(crate) what: String,
    pub(crate) is_wrong: bool,
    pub(crate) pixels: String,
    pub(crate) theirs: String,
    pub(crate) ours: String,
    pub(crate) total: String,
    pub(crate) z: String,
}

/// Radiance along rays.
#[derive(Debug)]
pub(crate) struct RadianceRow {
    pub(crate) who: String,
    pub(crate) what: String,
    pub(crate) is_wrong: bool,
    pub(crate) lit: String,
    pub(crate) dark: String,
    pub(crate) others: String,
    pub(crate) worst: String,
    pub(crate) wrong: String,
}

/// The misses of an outsider.
#[derive(Debug)]
pub(crate) struct Misses {
    pub(crate) title: String,
    pub(crate) listed: Vec<Miss>,
    pub(crate) more: String,
}

/// One of them.
#[derive(Debug)]
pub(crate) struct Miss {
    pub(crate) place: String,
    pub(crate) quantity: String,
    pub(crate) what: String,
    pub(crate) command: String,
    pub(crate) folder: String,
}

fn wrong(tally: &ItemTally) -> u64 {
    tally.of(Class::Defect) + tally.of(Class::Undecided)
}

/// Where the reproducer of a miss is, from the folder of the validation.
fn miss_folder(held: &HeldOutsider, index: usize) -> String {
    format!("misses/{}", held.miss_name(index))
}

/// What the page says of a validation's outsiders.
pub(crate) fn outside(validation: &Validation) -> Outside {
    let Some(panel) = &validation.panel else { return Outside::default() };
    let subject = &validation.subject;
    let who: Vec<(&str, &Check)> = everyone(panel);
    let totals: Vec<BTreeMap<Item, ItemTally>> = who.iter().map(|(_, check)| check.totals()).collect();
    let mut items: Vec<Item> = totals.iter().flat_map(|totals| totals.keys().copied()).collect();
    items.sort();
    items.dedup();
    let row = |item: Item| QuantityRow {
        quantity: name_of(item),
        cells: totals.iter().map(|totals| cell(subject, item, totals.get(&item)?)).collect(),
    };
    let rows = items.into_iter().map(row);
    Outside {
        names: who.iter().map(|(name, _)| name.to_string()).collect(),
        // What nobody says has no row.
        rows: rows.filter(|row| row.cells.iter().any(Option::is_some)).collect(),
        images: of_outsiders(panel, |held| held.images.iter().map(|image| image_row(held, image)).collect()),
        radiance: of_outsiders(panel, |held| {
            held.radiance.iter().map(|map| radiance_row(held, map)).collect()
        }),
        misses: panel.outsiders.iter().map(|held| misses(subject, held)).collect(),
    }
}

fn of_outsiders<T>(panel: &Panel, rows: impl Fn(&HeldOutsider) -> Vec<T>) -> Vec<T> {
    panel.outsiders.iter().flat_map(rows).collect()
}

fn everyone(panel: &Panel) -> Vec<(&str, &Check)> {
    let ours = panel.ours.iter().map(|held| (held.name.as_str(), &held.check));
    ours.chain(panel.outsiders.iter().map(|held| (held.outsider.name.as_str(), &held.check))).collect()
}

fn cell(subject: &Subject, item: Item, tally: &ItemTally) -> Option<Cell> {
    if tally.compared() == 0 {
        return None;
    }
    let mut classes = vec![format!("{} agree", count(tally.of(Class::Agree)))];
    for (class, word) in [(Class::Tie, "tie"), (Class::Rounding, "rounding")] {
        if tally.of(class) > 0 {
            classes.push(format!("{} {word}", count(tally.of(class))));
        }
    }
    let unit = unit_of(subject.scene.flux_model(), item);
    let largest = |largest: &Option<Largest>, unit: &str| largest.as_ref().map(|it| quantity(it.value, unit));
    let ratio =
        largest(&tally.worst_ratio, "").map_or(String::new(), |ratio| format!("{ratio} of its bound"));
    Some(Cell {
        is_wrong: wrong(tally) > 0,
        wrong: format!("{} wrong", count(wrong(tally))),
        classes: classes.join(", "),
        error: largest(&tally.worst_error, unit).unwrap_or_default(),
        ratio,
        place: tally.worst_error.as_ref().map_or(String::new(), |it| it.place.to_string()),
    })
}

fn signed(value: f64) -> String {
    if value > 0.0 { format!("+{}", number(value)) } else { number(value) }
}

fn image_row(held: &HeldOutsider, image: &ImageComparison) -> ImageRow {
    // As a part of it: an absolute error would end beyond the digits that are shown.
    let with_error =
        |[value, error]: [f64; 2]| format!("{} W (1 ± {})", number(value), number(error / value));
    let at = image.at.map_or(String::new(), |at| format!(" at {at}"));
    ImageRow {
        who: held.outsider.name.clone(),
        what: format!("{}, beam {}", image.way, image.beam),
        is_wrong: !image.is_within(&CHANCE_LIMITS),
        pixels: count(image.pixels as u64),
        theirs: with_error(image.theirs),
        ours: with_error(image.ours),
        total: format!("{}, {} standard errors", signed(image.total_off()), signed(image.total_z())),
        z: format!(
            "rms {}, mean {}, largest {}{at}",
            number(image.z_rms),
            signed(image.z_mean),
            signed(image.z_largest)
        ),
    }
}

fn radiance_row(held: &HeldOutsider, map: &RadianceComparison) -> RadianceRow {
    RadianceRow {
        who: held.outsider.name.clone(),
        what: format!("{} rays, beam {}", map.sensor, map.beam),
        is_wrong: map.wrong > 0,
        lit: count(map.lit),
        dark: count(map.dark),
        others: count(map.shadowed + map.doubtful),
        worst: map.worst.map_or(String::new(), |(off, place)| format!("{} at {place}", number(off))),
        wrong: count(map.wrong),
    }
}

fn misses(subject: &Subject, held: &HeldOutsider) -> Misses {
    let total = held.check.of(Class::Defect) + held.check.of(Class::Undecided);
    let listed: Vec<Miss> = held
        .misses()
        .take(LISTED)
        .enumerate()
        .map(|(index, wrong)| Miss {
            place: wrong.place.to_string(),
            quantity: name_of(wrong.item),
            what: wrong.what.clone(),
            command: probe_command(subject, wrong.place),
            folder: miss_folder(held, index),
        })
        .collect();
    let more = total - total.min(listed.len() as u64);
    Misses {
        title: format!("{}: {} wrong", held.outsider.name, counted(total, "ray", "rays")),
        listed,
        more: if more > 0 { counted(more, "more ray", "more rays") } else { String::new() },
    }
}

/// The words that name the recordings again on the command line.
pub(crate) fn typed(validation: &Validation) -> String {
    let outsiders = validation.panel.iter().flat_map(|panel| &panel.outsiders);
    outsiders
        .map(|held| format!(" --candidate {}", quoted(&held.outsider.folder.to_string_lossy())))
        .collect()
}

/// A line of the screen for each outsider.
pub(crate) fn lines(panel: &Panel) -> Vec<String> {
    panel.outsiders.iter().map(line).collect()
}

fn line(held: &HeldOutsider) -> String {
    let wrong = held.check.of(Class::Defect) + held.check.of(Class::Undecided);
    let rays =
        format!("{}: {} of {} rays wrong", held.outsider.name, count(wrong), count(held.check.compared()));
    let of = |kind: &str, fit: usize, all: usize| (all > 0).then(|| format!("{fit} of {all} {kind}"));
    let images = held.images.iter().filter(|image| image.is_within(&CHANCE_LIMITS)).count();
    let radiance = held.radiance.iter().filter(|map| map.wrong == 0).count();
    let fit = [of("images", images, held.images.len()), of("radiances", radiance, held.radiance.len())];
    match fit.into_iter().flatten().collect::<Vec<_>>().as_slice() {
        [] => rays,
        some => format!("{rays}; {} fit", some.join(", ")),
    }
}

/// Everyone in `summary.json`.
#[derive(Serialize)]
pub(crate) struct PanelSummary {
    renderers: Vec<HeldSummary>,
}

#[derive(Serialize)]
struct HeldSummary {
    name: String,
    outside: bool,
    compared: u64,
    tie: u64,
    rounding: u64,
    wrong: u64,
    quantities: Vec<ItemSummary>,
    images: Vec<ImageSummary>,
    radiance: Vec<RadianceSummary>,
    misses: Vec<MissSummary>,
}

#[derive(Serialize)]
struct ItemSummary {
    quantity: String,
    unit: &'static str,
    compared: u64,
    tie: u64,
    rounding: u64,
    wrong: u64,
    worst_error: Option<f64>,
    worst_ratio: Option<f64>,
}

#[derive(Serialize)]
struct ImageSummary {
    way: String,
    beam: usize,
    pixels: usize,
    total_w: Option<f64>,
    total_error_w: Option<f64>,
    expected_w: f64,
    expected_error_w: f64,
    total_relative: Option<f64>,
    total_z: Option<f64>,
    z_rms: Option<f64>,
    z_mean: Option<f64>,
    z_largest: Option<f64>,
    within_limits: bool,
}

#[derive(Serialize)]
struct RadianceSummary {
    sensor: String,
    beam: usize,
    lit: u64,
    dark: u64,
    shadowed: u64,
    doubtful: u64,
    wrong: u64,
    worst_relative: Option<f64>,
}

#[derive(Serialize)]
struct MissSummary {
    sensor: String,
    i: u32,
    j: u32,
    quantity: String,
    what: String,
    probe: String,
    reproducer: String,
}

fn finite(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}

/// What `summary.json` says of a validation's outsiders.
pub(crate) fn summary(validation: &Validation) -> Option<PanelSummary> {
    let panel = validation.panel.as_ref()?;
    let subject = &validation.subject;
    let ours = panel.ours.iter().map(|held| of_check(subject, &held.name, &held.check));
    let theirs = panel.outsiders.iter().map(|held| {
        let mut summary = of_check(subject, &held.outsider.name, &held.check);
        summary.outside = true;
        summary.images = held.images.iter().map(of_image).collect();
        summary.radiance = held.radiance.iter().map(of_radiance).collect();
        let of_miss = |(index, wrong): (usize, &raypencil_judge::Defect)| MissSummary {
            sensor: wrong.place.sensor.to_string(),
            i: wrong.place.i,
            j: wrong.place.j,
            quantity: key_of(subject.scene.flux_model(), wrong.item),
            what: wrong.what.clone(),
            probe: probe_command(subject, wrong.place),
            reproducer: miss_folder(held, index),
        };
        summary.misses = held.misses().take(LISTED).enumerate().map(of_miss).collect();
        summary
    });
    Some(PanelSummary { renderers: ours.chain(theirs).collect() })
}

fn of_check(subject: &Subject, name: &str, check: &Check) -> HeldSummary {
    let model = subject.scene.flux_model();
    let of_item = |(item, tally): (Item, ItemTally)| ItemSummary {
        quantity: key_of(model, item),
        unit: unit_of(model, item),
        compared: tally.compared(),
        tie: tally.of(Class::Tie),
        rounding: tally.of(Class::Rounding),
        wrong: wrong(&tally),
        worst_error: tally.worst_error.as_ref().and_then(|largest| finite(largest.value)),
        worst_ratio: tally.worst_ratio.as_ref().and_then(|largest| finite(largest.value)),
    };
    HeldSummary {
        name: name.into(),
        outside: false,
        compared: check.compared(),
        tie: check.of(Class::Tie),
        rounding: check.of(Class::Rounding),
        wrong: check.of(Class::Defect) + check.of(Class::Undecided),
        quantities: check.totals().into_iter().map(of_item).collect(),
        images: Vec::new(),
        radiance: Vec::new(),
        misses: Vec::new(),
    }
}

fn of_image(image: &ImageComparison) -> ImageSummary {
    ImageSummary {
        way: image.way.clone(),
        beam: image.beam,
        pixels: image.pixels,
        total_w: finite(image.theirs[0]),
        total_error_w: finite(image.theirs[1]),
        expected_w: image.ours[0],
        expected_error_w: image.ours[1],
        total_relative: finite(image.total_off()),
        total_z: finite(image.total_z()),
        z_rms: finite(image.z_rms),
        z_mean: finite(image.z_mean),
        z_largest: finite(image.z_largest),
        within_limits: image.is_within(&CHANCE_LIMITS),
    }
}

fn of_radiance(map: &RadianceComparison) -> RadianceSummary {
    RadianceSummary {
        sensor: map.sensor.to_string(),
        beam: map.beam,
        lit: map.lit,
        dark: map.dark,
        shadowed: map.shadowed,
        doubtful: map.doubtful,
        wrong: map.wrong,
        worst_relative: map.worst.and_then(|(off, _)| finite(off)),
    }
}
