//! The scoreboard as tables and lines: raypencil's renderers beside candidates.

use std::collections::BTreeMap;

use raypencil_files::Storage;
use raypencil_judge::{Check, Class, Item, ItemTally, Recorded, name_of, unit_of};
use raypencil_pack::{items_not_given, not_given, rays_not_given};
use raypencil_report::{
    Block, Column, DefectGroup, DefectLine, Grid, Room, count, counted, number, quantity,
};
use raypencil_scene_io::{Subject, probe_command, quoted};

use crate::monte_carlo::Z_TEST_LIMITS;
use crate::scoreboard::{CandidateReport, Scoreboard};
use crate::validation::Validation;

/// Maximum listed misses per candidate.
pub(super) const MAX_LISTED: usize = 10;

/// What stands in the place of a quantity that is not given.
const NOT_GIVEN: &str = "not given";

/// Rays that are wrong or could not be decided.
pub(super) fn wrong(tally: &ItemTally) -> u64 {
    tally.of(Class::Defect) + tally.of(Class::Undecided)
}

/// Path of a miss's folder, relative to the folder of the validation.
pub(super) fn miss_folder(report: &CandidateReport, index: usize) -> String {
    format!("misses/{}", report.miss_name(index))
}

/// The tables of a validation's candidates; none without them.
pub(super) fn grids(validation: &Validation) -> Vec<Block> {
    let Some(scoreboard) = &validation.scoreboard else { return Vec::new() };
    let text = |line: &str| Block::Text { title: "", lines: vec![line.into()], room: Room::Wide };
    let lines = validation.candidates().iter().map(line).collect();
    let mut blocks = vec![
        Block::Text { title: "Candidates", lines, room: Room::Wide },
        text(
            "The maps of all renderers and candidates, compared with the exact answer to every ray. An error counts as wrong \
             if the renderer's own arithmetic does not explain it.",
        ),
        Block::Table {
            title: "Every quantity beside the exact answers",
            grid: panel(validation, scoreboard),
        },
    ];
    let coarse: Vec<String> = scoreboard.candidates.iter().flat_map(coarse_storages).collect();
    blocks.push(Block::Text {
        title: "",
        lines: coarse
            .into_iter()
            .map(|line| format!("{line}. These values are judged as rounded so, and are known no better."))
            .collect(),
        room: Room::Wide,
    });
    if scoreboard.candidates.iter().any(|report| !report.images.is_empty()) {
        blocks.push(Block::Table { title: "Monte Carlo images", grid: images(scoreboard) });
        blocks.push(text(
            "Watts in each pixel by a renderer that samples light at random, against pencils drawn at random: both have the \
             expectation of the camera equation. z is the difference in combined standard errors, over pixels with an \
             expected flux above 1 % of the brightest pixel's.",
        ));
    }
    if scoreboard.candidates.iter().any(|report| !report.radiance.is_empty()) {
        blocks.push(Block::Table { title: "Radiance along single rays", grid: radiance(scoreboard) });
        blocks.push(text(
            "The radiance of one beam's light along each ray, against the closed form at the exact hit point. These numbers \
             are not random.",
        ));
    }
    blocks
}

/// A row for each quantity that somebody provides, and a column for each renderer and candidate.
fn panel(validation: &Validation, scoreboard: &Scoreboard) -> Grid {
    let subject = &validation.subject;
    let checks = all_checks(scoreboard);
    let totals: Vec<BTreeMap<Item, ItemTally>> = checks.iter().map(|(_, check, _)| check.totals()).collect();
    let mut items: Vec<Item> = totals.iter().flat_map(|totals| totals.keys().copied()).collect();
    items.sort();
    items.dedup();
    let names = checks.iter().map(|(name, _, _)| Column::text(name.to_string()));
    let mut grid = Grid::new([Column::text("quantity")].into_iter().chain(names));
    for item in items {
        let tallies: Vec<Option<&ItemTally>> = totals.iter().map(|totals| totals.get(&item)).collect();
        let cell = |(tally, (_, _, recorded)): (&Option<&ItemTally>, &(&str, &Check, Option<&Recorded>))| {
            tally.map_or(NOT_GIVEN.into(), |tally| cell(subject, item, tally, *recorded))
        };
        let cells: Vec<String> = tallies.iter().zip(&checks).map(cell).collect();
        if cells.iter().all(|cell| cell == NOT_GIVEN) {
            continue;
        }
        let fails = tallies.iter().flatten().any(|tally| wrong(tally) > 0);
        grid.row_with_room([name_of(item)].into_iter().chain(cells), fails, Room::Wide);
    }
    grid
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

/// The classes and the worst error of one renderer in one quantity.
fn cell(subject: &Subject, item: Item, tally: &ItemTally, recorded: Option<&Recorded>) -> String {
    if tally.compared() == 0 {
        return not_given(tally).unwrap_or("no ray has it").into();
    }
    let storage = recorded.and_then(|recorded| recorded.storage_of_item(item));
    let agree = match storage.and_then(Storage::coarse_words) {
        Some(coarse) => format!("agree at {coarse}"),
        None => "agree".into(),
    };
    let mut words = format!("{} wrong, {} {agree}", count(wrong(tally)), count(tally.of(Class::Agree)));
    for (class, word) in [(Class::Tie, "tie"), (Class::Rounding, "rounding")] {
        if tally.of(class) > 0 {
            words += &format!(", {} {word}", count(tally.of(class)));
        }
    }
    if rays_not_given(tally) > 0 {
        words += &format!(", {} not given", count(rays_not_given(tally)));
    }
    let unit = unit_of(subject.scene.flux_model(), item);
    if let Some(error) = &tally.worst_error {
        words += &format!("; at most {}", quantity(error.value, unit));
    }
    if let Some(ratio) = &tally.worst_ratio {
        words += &format!(", {} of its bound", quantity(ratio.value, ""));
    }
    words
}

fn signed(value: f64) -> String {
    if value > 0.0 { format!("+{}", number(value)) } else { number(value) }
}

/// The candidates' Monte Carlo images.
fn images(scoreboard: &Scoreboard) -> Grid {
    let mut grid = Grid::new([
        Column::text("renderer"),
        Column::text("image"),
        Column::number("pixels"),
        Column::number("total"),
        Column::number("expected"),
        Column::number("off by"),
        Column::text("z"),
    ]);
    // The error is relative: an absolute one would be beyond the printed digits of the value.
    let with_error =
        |[value, error]: [f64; 2]| format!("{} W (1 ± {})", number(value), number(error / value));
    for report in &scoreboard.candidates {
        for image in &report.images {
            let at = image.at.map_or(String::new(), |at| format!(" at {at}"));
            let cells = [
                report.candidate.name.clone(),
                format!("{}, beam {}", image.integrator, image.beam),
                count(image.pixels as u64),
                with_error(image.theirs),
                with_error(image.ours),
                format!("{}, {} standard errors", signed(image.total_off()), signed(image.total_z())),
                format!(
                    "rms {}, mean {}, largest {}{at}",
                    number(image.z_rms),
                    signed(image.z_mean),
                    signed(image.z_largest)
                ),
            ];
            grid.row_with_room(cells, !image.is_within(&Z_TEST_LIMITS), Room::Wide);
        }
    }
    grid
}

/// The candidates' radiance maps.
fn radiance(scoreboard: &Scoreboard) -> Grid {
    let mut grid = Grid::new([
        Column::text("renderer"),
        Column::text("rays"),
        Column::number("lit"),
        Column::number("dark"),
        Column::number("hidden, in shadow or on a border"),
        Column::text("worst relative error"),
        Column::number("wrong"),
    ]);
    for report in &scoreboard.candidates {
        for map in &report.radiance {
            let cells = [
                report.candidate.name.clone(),
                format!("{} rays, beam {}", map.sensor, map.beam),
                count(map.lit),
                count(map.dark),
                count(map.shadowed + map.doubtful),
                map.worst.map_or(String::new(), |(off, place)| format!("{} at {place}", number(off))),
                count(map.wrong),
            ];
            grid.row_with_room(cells, map.wrong > 0, Room::Wide);
        }
    }
    grid
}

/// The listed misses of each candidate that has any.
pub(crate) fn all_misses(validation: &Validation) -> Vec<DefectGroup> {
    let of_candidate = |report: &CandidateReport| {
        let of_sensors = report.check.of(Class::Defect) + report.check.of(Class::Undecided) > 0;
        let of_sensors = of_sensors.then(|| misses(&validation.subject, report));
        let of_sets = report.ray_sets.iter().filter_map(|set| set.bundle().group()).map(|group| {
            let title = format!("Candidate {}, {}", report.candidate.name, group.title);
            DefectGroup { title, ..group }
        });
        of_sensors.into_iter().chain(of_sets).collect::<Vec<_>>()
    };
    validation.candidates().iter().flat_map(of_candidate).collect()
}

fn misses(subject: &Subject, report: &CandidateReport) -> DefectGroup {
    let total = report.check.of(Class::Defect) + report.check.of(Class::Undecided);
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
    let of_sensors = items_not_given(&report.check).into_iter().map(|(item, _)| name_of(item));
    let sets = report.ray_sets.iter().filter(|set| set.checked.is_none());
    of_sensors.chain(sets.map(|set| format!("rays/{}", set.name))).collect()
}

/// The mistakes that explain why candidates are wrong, a sentence for each that has any.
pub(crate) fn whys(validation: &Validation) -> impl Iterator<Item = String> {
    validation.candidates().iter().flat_map(|report| {
        let name = &report.candidate.name;
        let of_sensors = report.diagnosis.as_ref();
        let of_sensors =
            of_sensors.map(|diagnosis| format!("Why {name} is wrong: {}.", diagnosis.sentence()));
        let of_sets = report.given_sets().filter_map(|(set, checked)| {
            Some(format!("Why {name} is wrong about rays {set}: {}.", checked.why.as_ref()?))
        });
        of_sensors.into_iter().chain(of_sets).collect::<Vec<_>>()
    })
}

/// A candidate in one line: the rays, images and radiance maps that are wrong or fit.
pub(crate) fn line(report: &CandidateReport) -> String {
    let coarse = report.candidate.recorded.coarseness();
    let rays = format!(
        "{}: {} of {} rays wrong{}",
        report.candidate.name,
        count(report.wrong_rays()),
        count(report.compared()),
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
