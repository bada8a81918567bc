//! The scoreboard, ready to be printed: raypencil's renderers beside candidates, for the page and the screen.

use std::collections::BTreeMap;

use raypencil_files::Storage;
use raypencil_judge::{Check, Class, Item, ItemTally, Largest, Recorded, name_of, unit_of};
use raypencil_pack::{items_not_given, not_given, rays_not_given};
use raypencil_report::{DefectGroup, DefectLine, count, counted, number, quantity};
use raypencil_scene_io::{Subject, probe_command, quoted};

use crate::monte_carlo::{ImageComparison, Z_TEST_LIMITS};
use crate::radiance::RadianceComparison;
use crate::scoreboard::{CandidateReport, Scoreboard};
use crate::validation::Validation;

/// Maximum listed misses per candidate.
pub(super) const MAX_LISTED: usize = 10;

/// What stands in the place of a quantity that is not given.
const NOT_GIVEN: &str = "not given";

/// The page's section about candidates; empty if there are none.
#[derive(Debug, Default)]
pub(crate) struct CandidatesSection {
    pub(crate) names: Vec<String>,
    pub(crate) rows: Vec<QuantityRow>,
    pub(crate) images: Vec<ImageRow>,
    pub(crate) radiance: Vec<RadianceRow>,
    /// What is stored more coarsely than in single precision, a line for each candidate and storage.
    pub(crate) coarse: Vec<String>,
}

/// One quantity: a cell for each renderer and candidate.
#[derive(Debug)]
pub(crate) struct QuantityRow {
    pub(crate) quantity: String,
    pub(crate) cells: Vec<Cell>,
}

/// Classes and worst errors of one renderer in one quantity.
#[derive(Debug, Default)]
pub(crate) struct Cell {
    /// Why there is nothing else in the cell: `not given`; empty if something was compared.
    pub(crate) absent: &'static str,
    pub(crate) is_wrong: bool,
    pub(crate) wrong: String,
    pub(crate) classes: String,
    /// Largest error; empty if no numbers were compared.
    pub(crate) error: String,
    /// Largest ratio of an error to its bound; empty if no numbers were compared.
    pub(crate) ratio: String,
    pub(crate) place: String,
}

impl Cell {
    pub(crate) fn words(&self) -> String {
        if self.absent.is_empty() { format!("{}, {}", self.wrong, self.classes) } else { self.absent.into() }
    }
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

/// Rays that are wrong or could not be decided.
pub(super) fn wrong(tally: &ItemTally) -> u64 {
    tally.of(Class::Defect) + tally.of(Class::Undecided)
}

/// Path of a miss's folder, relative to the folder of the validation.
pub(super) fn miss_folder(report: &CandidateReport, index: usize) -> String {
    format!("misses/{}", report.miss_name(index))
}

/// The page's section about a validation's candidates.
pub(crate) fn candidates_section(validation: &Validation) -> CandidatesSection {
    let Some(scoreboard) = &validation.scoreboard else { return CandidatesSection::default() };
    let subject = &validation.subject;
    let checks = all_checks(scoreboard);
    let totals: Vec<BTreeMap<Item, ItemTally>> = checks.iter().map(|(_, check, _)| check.totals()).collect();
    let mut items: Vec<Item> = totals.iter().flat_map(|totals| totals.keys().copied()).collect();
    items.sort();
    items.dedup();
    let row = |item: Item| QuantityRow {
        quantity: name_of(item),
        cells: totals
            .iter()
            .zip(&checks)
            .map(|(totals, (_, _, recorded))| match totals.get(&item) {
                Some(tally) => cell(subject, item, tally, *recorded),
                None => Cell { absent: NOT_GIVEN, ..Cell::default() },
            })
            .collect(),
    };
    let rows = items.into_iter().map(row);
    CandidatesSection {
        names: checks.iter().map(|(name, _, _)| name.to_string()).collect(),
        // A quantity that nobody provides has no row.
        rows: rows.filter(|row| row.cells.iter().any(|cell| cell.absent != NOT_GIVEN)).collect(),
        images: of_candidates(scoreboard, |report| {
            report.images.iter().map(|image| image_row(report, image)).collect()
        }),
        radiance: of_candidates(scoreboard, |report| {
            report.radiance.iter().map(|map| radiance_row(report, map)).collect()
        }),
        coarse: scoreboard.candidates.iter().flat_map(coarse_storages).collect(),
    }
}

fn of_candidates<T>(scoreboard: &Scoreboard, rows: impl Fn(&CandidateReport) -> Vec<T>) -> Vec<T> {
    scoreboard.candidates.iter().flat_map(rows).collect()
}

/// What a candidate stores more coarsely than in single precision.
fn coarse_storages(report: &CandidateReport) -> Vec<String> {
    let name = &report.candidate.name;
    let line = |(how, items): (Storage, Vec<Item>)| {
        let digits = if how == Storage::F16 { " (11 binary digits)" } else { "" };
        let how = how.coarse_words().unwrap_or_default();
        let names: Vec<String> = items.into_iter().map(name_of).collect();
        format!("{name} stores in {how}{digits}: {}", names.join(", "))
    };
    report.candidate.recorded.coarse_items().into_iter().map(line).collect()
}

/// Names, checks and recordings, raypencil's renderers first; these are no recordings.
fn all_checks(scoreboard: &Scoreboard) -> Vec<(&str, &Check, Option<&Recorded>)> {
    let ours = scoreboard.ours.iter().map(|report| (report.name.as_str(), &report.check, None));
    let theirs = scoreboard.candidates.iter().map(|report| {
        let candidate = &report.candidate;
        (candidate.name.as_str(), &report.check, Some(&candidate.recorded))
    });
    ours.chain(theirs).collect()
}

fn cell(subject: &Subject, item: Item, tally: &ItemTally, recorded: Option<&Recorded>) -> Cell {
    if tally.compared() == 0 {
        let absent = not_given(tally).unwrap_or("no ray has it");
        return Cell { absent, ..Cell::default() };
    }
    let storage = recorded.and_then(|recorded| recorded.storage_of_item(item));
    let agree = match storage.and_then(Storage::coarse_words) {
        Some(coarse) => format!("agree at {coarse}"),
        None => "agree".into(),
    };
    let mut classes = vec![format!("{} {agree}", count(tally.of(Class::Agree)))];
    for (class, word) in [(Class::Tie, "tie"), (Class::Rounding, "rounding")] {
        if tally.of(class) > 0 {
            classes.push(format!("{} {word}", count(tally.of(class))));
        }
    }
    if rays_not_given(tally) > 0 {
        classes.push(format!("{} not given", count(rays_not_given(tally))));
    }
    let unit = unit_of(subject.scene.flux_model(), item);
    let largest = |largest: &Option<Largest>, unit: &str| largest.as_ref().map(|it| quantity(it.value, unit));
    let ratio =
        largest(&tally.worst_ratio, "").map_or(String::new(), |ratio| format!("{ratio} of its bound"));
    Cell {
        absent: "",
        is_wrong: wrong(tally) > 0,
        wrong: format!("{} wrong", count(wrong(tally))),
        classes: classes.join(", "),
        error: largest(&tally.worst_error, unit).unwrap_or_default(),
        ratio,
        place: tally.worst_error.as_ref().map_or(String::new(), |it| it.place.to_string()),
    }
}

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

/// The listed misses of each candidate that has any.
pub(crate) fn all_misses(validation: &Validation) -> Vec<DefectGroup> {
    let wrong = validation.candidates().iter().filter(|report| report.wrong_rays() > 0);
    wrong.map(|report| misses(&validation.subject, report)).collect()
}

fn misses(subject: &Subject, report: &CandidateReport) -> DefectGroup {
    let total = report.wrong_rays();
    let lines: Vec<DefectLine> = report
        .misses()
        .take(MAX_LISTED)
        .enumerate()
        .map(|(index, wrong)| DefectLine {
            place: wrong.place.to_string(),
            quantity: name_of(wrong.item),
            words: wrong.words(),
            what: wrong.what.clone(),
            folder: miss_folder(report, index),
            command: probe_command(subject, wrong.place),
            ..DefectLine::default()
        })
        .collect();
    let more = match total - total.min(lines.len() as u64) {
        0 => String::new(),
        more => format!("{} not listed here.", counted(more, "more ray", "more rays")),
    };
    let title = format!("Candidate {}: {} wrong", report.candidate.name, counted(total, "ray", "rays"));
    DefectGroup { title, lines, more }
}

/// Command-line arguments that name the candidates: ` --candidate DIR` for each.
pub(crate) fn typed(validation: &Validation) -> String {
    let folder = |report: &CandidateReport| quoted(&report.candidate.folder.to_string_lossy());
    let words = validation.candidates().iter().map(|report| format!(" --candidate {}", folder(report)));
    let may_fail = if validation.candidates_may_fail { " --candidates-must-pass=false" } else { "" };
    // What is declared concerns all candidates alike.
    let declared =
        validation.candidates().first().map_or(String::new(), |one| one.candidate.declared.typed());
    words.chain([declared, may_fail.to_string()]).collect()
}

/// Names of what a candidate does not give.
pub(crate) fn names_not_given(report: &CandidateReport) -> Vec<String> {
    items_not_given(&report.check).into_iter().map(|(item, _)| name_of(item)).collect()
}

/// A candidate in one line: the rays, images and radiance maps that are wrong or fit.
pub(crate) fn line(report: &CandidateReport) -> String {
    let coarse = report.candidate.recorded.coarseness();
    let rays = format!(
        "{}: {} of {} rays wrong{}",
        report.candidate.name,
        count(report.wrong_rays()),
        count(report.check.compared()),
        coarse.map_or(String::new(), |coarse| format!(" at {coarse}"))
    );
    let of = |kind: &str, fit: usize, all: usize| (all > 0).then(|| format!("{fit} of {all} {kind}"));
    let images = report.images.len() - report.wrong_images();
    let radiance = report.radiance.len() - report.wrong_radiance();
    let fit = [of("images", images, report.images.len()), of("radiances", radiance, report.radiance.len())];
    match fit.into_iter().flatten().collect::<Vec<_>>().as_slice() {
        [] => rays,
        some => format!("{rays}; {} fit", some.join(", ")),
    }
}
