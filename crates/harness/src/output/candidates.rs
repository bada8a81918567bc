//! The scoreboard, ready to be printed: raypencil's renderers beside candidates, for the page, the screen and programs.

use std::collections::BTreeMap;

use raypencil_judge::{Check, Class, Defect, Item, ItemTally, Largest, key_of, name_of, unit_of};
use raypencil_report::{count, counted, number, quantity};
use raypencil_scene_io::{Subject, probe_command, quoted};
use serde::Serialize;

use crate::monte_carlo::{ImageComparison, Z_TEST_LIMITS};
use crate::radiance::RadianceComparison;
use crate::scoreboard::{CandidateReport, Scoreboard};
use crate::validation::Validation;

/// Maximum listed misses per candidate.
const MAX_LISTED: usize = 10;

/// The page's section about candidates; empty if there are none.
#[derive(Debug, Default)]
pub(crate) struct CandidatesSection {
    pub(crate) names: Vec<String>,
    pub(crate) rows: Vec<QuantityRow>,
    pub(crate) images: Vec<ImageRow>,
    pub(crate) radiance: Vec<RadianceRow>,
    pub(crate) misses: Vec<Misses>,
}

/// One quantity: a cell for each renderer and candidate.
#[derive(Debug)]
pub(crate) struct QuantityRow {
    pub(crate) quantity: String,
    pub(crate) cells: Vec<Option<Cell>>,
}

/// Classes and worst errors of one renderer in one quantity.
#[derive(Debug)]
pub(crate) struct Cell {
    pub(crate) is_wrong: bool,
    pub(crate) wrong: String,
    pub(crate) classes: String,
    /// Largest error; empty if no numbers were compared.
    pub(crate) error: String,
    /// Largest ratio of an error to its bound; empty if no numbers were compared.
    pub(crate) ratio: String,
    pub(crate) place: String,
}

/// A candidate's Monte Carlo image.
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

/// A candidate's radiance map.
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

/// The misses of a candidate.
#[derive(Debug)]
pub(crate) struct Misses {
    pub(crate) title: String,
    pub(crate) listed: Vec<Miss>,
    pub(crate) more: String,
}

/// One miss.
#[derive(Debug)]
pub(crate) struct Miss {
    pub(crate) place: String,
    pub(crate) quantity: String,
    pub(crate) what: String,
    pub(crate) command: String,
    pub(crate) folder: String,
}

/// Rays that are wrong or could not be decided.
fn wrong(tally: &ItemTally) -> u64 {
    tally.of(Class::Defect) + tally.of(Class::Undecided)
}

/// Path of a miss's folder, relative to the folder of the validation.
fn miss_folder(report: &CandidateReport, index: usize) -> String {
    format!("misses/{}", report.miss_name(index))
}

/// The page's section about a validation's candidates.
pub(crate) fn candidates_section(validation: &Validation) -> CandidatesSection {
    let Some(scoreboard) = &validation.scoreboard else { return CandidatesSection::default() };
    let subject = &validation.subject;
    let checks: Vec<(&str, &Check)> = all_checks(scoreboard);
    let totals: Vec<BTreeMap<Item, ItemTally>> = checks.iter().map(|(_, check)| check.totals()).collect();
    let mut items: Vec<Item> = totals.iter().flat_map(|totals| totals.keys().copied()).collect();
    items.sort();
    items.dedup();
    let row = |item: Item| QuantityRow {
        quantity: name_of(item),
        cells: totals.iter().map(|totals| cell(subject, item, totals.get(&item)?)).collect(),
    };
    let rows = items.into_iter().map(row);
    CandidatesSection {
        names: checks.iter().map(|(name, _)| name.to_string()).collect(),
        // A quantity that nobody provides has no row.
        rows: rows.filter(|row| row.cells.iter().any(Option::is_some)).collect(),
        images: of_candidates(scoreboard, |report| {
            report.images.iter().map(|image| image_row(report, image)).collect()
        }),
        radiance: of_candidates(scoreboard, |report| {
            report.radiance.iter().map(|map| radiance_row(report, map)).collect()
        }),
        misses: scoreboard.candidates.iter().map(|report| misses(subject, report)).collect(),
    }
}

fn of_candidates<T>(scoreboard: &Scoreboard, rows: impl Fn(&CandidateReport) -> Vec<T>) -> Vec<T> {
    scoreboard.candidates.iter().flat_map(rows).collect()
}

/// Names and checks, raypencil's renderers first.
fn all_checks(scoreboard: &Scoreboard) -> Vec<(&str, &Check)> {
    let ours = scoreboard.ours.iter().map(|report| (report.name.as_str(), &report.check));
    ours.chain(scoreboard.candidates.iter().map(|report| (report.candidate.name.as_str(), &report.check)))
        .collect()
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

/// A number with its sign.
fn signed(value: f64) -> String {
    if value > 0.0 { format!("+{}", number(value)) } else { number(value) }
}

fn image_row(report: &CandidateReport, image: &ImageComparison) -> ImageRow {
    // The error is relative: an absolute one would be beyond the printed digits of the value.
    let with_error =
        |[value, error]: [f64; 2]| format!("{} W (1 ± {})", number(value), number(error / value));
    let at = image.at.map_or(String::new(), |at| format!(" at {at}"));
    ImageRow {
        who: report.candidate.name.clone(),
        what: format!("{}, beam {}", image.integrator, image.beam),
        is_wrong: !image.is_within(&Z_TEST_LIMITS),
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

fn radiance_row(report: &CandidateReport, map: &RadianceComparison) -> RadianceRow {
    RadianceRow {
        who: report.candidate.name.clone(),
        what: format!("{} rays, beam {}", map.sensor, map.beam),
        is_wrong: map.wrong > 0,
        lit: count(map.lit),
        dark: count(map.dark),
        others: count(map.shadowed + map.doubtful),
        worst: map.worst.map_or(String::new(), |(off, place)| format!("{} at {place}", number(off))),
        wrong: count(map.wrong),
    }
}

fn misses(subject: &Subject, report: &CandidateReport) -> Misses {
    let total = report.check.of(Class::Defect) + report.check.of(Class::Undecided);
    let listed: Vec<Miss> = report
        .misses()
        .take(MAX_LISTED)
        .enumerate()
        .map(|(index, wrong)| Miss {
            place: wrong.place.to_string(),
            quantity: name_of(wrong.item),
            what: wrong.what.clone(),
            command: probe_command(subject, wrong.place),
            folder: miss_folder(report, index),
        })
        .collect();
    let more = total - total.min(listed.len() as u64);
    Misses {
        title: format!("{}: {} wrong", report.candidate.name, counted(total, "ray", "rays")),
        listed,
        more: if more > 0 { counted(more, "more ray", "more rays") } else { String::new() },
    }
}

/// Command-line arguments that name the candidates: ` --candidate DIR` for each.
pub(crate) fn typed(validation: &Validation) -> String {
    let candidates = validation.scoreboard.iter().flat_map(|scoreboard| &scoreboard.candidates);
    candidates
        .map(|report| format!(" --candidate {}", quoted(&report.candidate.folder.to_string_lossy())))
        .collect()
}

/// A line of the screen for each candidate.
pub(crate) fn lines(scoreboard: &Scoreboard) -> Vec<String> {
    scoreboard.candidates.iter().map(line).collect()
}

fn line(report: &CandidateReport) -> String {
    let wrong = report.check.of(Class::Defect) + report.check.of(Class::Undecided);
    let rays = format!(
        "{}: {} of {} rays wrong",
        report.candidate.name,
        count(wrong),
        count(report.check.compared())
    );
    let of = |kind: &str, fit: usize, all: usize| (all > 0).then(|| format!("{fit} of {all} {kind}"));
    let images = report.images.iter().filter(|image| image.is_within(&Z_TEST_LIMITS)).count();
    let radiance = report.radiance.iter().filter(|map| map.wrong == 0).count();
    let fit = [of("images", images, report.images.len()), of("radiances", radiance, report.radiance.len())];
    match fit.into_iter().flatten().collect::<Vec<_>>().as_slice() {
        [] => rays,
        some => format!("{rays}; {} fit", some.join(", ")),
    }
}

/// The scoreboard in `summary.json`, under the key `panel`.
#[derive(Serialize)]
pub(crate) struct ScoreboardSummary {
    renderers: Vec<CheckSummary>,
}

#[derive(Serialize)]
struct CheckSummary {
    name: String,
    #[serde(rename = "outside")]
    is_candidate: bool,
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
    #[serde(rename = "way")]
    integrator: String,
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
    #[serde(rename = "within_limits")]
    is_within_limits: bool,
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

/// The scoreboard of a validation for `summary.json`; `None` without candidates.
pub(crate) fn scoreboard_summary(validation: &Validation) -> Option<ScoreboardSummary> {
    let scoreboard = validation.scoreboard.as_ref()?;
    let subject = &validation.subject;
    let ours = scoreboard.ours.iter().map(|report| check_summary(subject, &report.name, &report.check));
    let theirs = scoreboard.candidates.iter().map(|report| {
        let mut summary = check_summary(subject, &report.candidate.name, &report.check);
        summary.is_candidate = true;
        summary.images = report.images.iter().map(image_summary).collect();
        summary.radiance = report.radiance.iter().map(radiance_summary).collect();
        let of_miss = |(index, wrong): (usize, &Defect)| MissSummary {
            sensor: wrong.place.sensor.to_string(),
            i: wrong.place.i,
            j: wrong.place.j,
            quantity: key_of(subject.scene.flux_model(), wrong.item),
            what: wrong.what.clone(),
            probe: probe_command(subject, wrong.place),
            reproducer: miss_folder(report, index),
        };
        summary.misses = report.misses().take(MAX_LISTED).enumerate().map(of_miss).collect();
        summary
    });
    Some(ScoreboardSummary { renderers: ours.chain(theirs).collect() })
}

fn check_summary(subject: &Subject, name: &str, check: &Check) -> CheckSummary {
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
    CheckSummary {
        name: name.into(),
        is_candidate: false,
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

fn image_summary(image: &ImageComparison) -> ImageSummary {
    ImageSummary {
        integrator: image.integrator.clone(),
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
        is_within_limits: image.is_within(&Z_TEST_LIMITS),
    }
}

fn radiance_summary(map: &RadianceComparison) -> RadianceSummary {
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
