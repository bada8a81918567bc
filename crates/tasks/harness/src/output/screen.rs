//! What a screen shows of a validation: on a terminal at most 80 columns and 40 lines.

use std::fmt::Write;
use std::path::Path;

use raypencil_judge::{Class, ListedDefect, SensorResult, name_of};
use raypencil_report::{Block, DefectLine, Grid, VERSION, count, counted, list, time};
use raypencil_scene::{SensorId, Stage};
use raypencil_scene_io::{probe_command, scene_sha256};
use raypencil_survey::Whereabouts;

use crate::output::candidates;
use crate::output::table::{hits, quantities_of_screen, short, worst};
use crate::output::verdict::{Ruled, Verdict, defects, rays};
use crate::validation::Validation;

/// Maximum columns of a line. Only paths and commands, which are for copying, may be longer.
pub(super) const MAX_COLUMNS: usize = 80;

/// Maximum lines of sensors.
const MAX_SENSORS: usize = 5;

/// Maximum lines of sets of rays.
const MAX_RAY_SETS: usize = 2;

/// Maximum lines of stage times.
const MAX_TIME_LINES: usize = 4;

/// Maximum lines of causes.
const MAX_CAUSES: usize = 4;

/// Maximum lines of candidates.
const MAX_CANDIDATES: usize = 4;

const MAX_WARNINGS: usize = 2;

/// Maximum described defects.
const MAX_DEFECTS: usize = 3;

/// Maximum described defects of candidates: the worst of each.
const MAX_CANDIDATE_DEFECTS: usize = 2;

/// Maximum lines of a described defect.
const MAX_DEFECT_LINES: usize = 2;

/// How much a screen shows, and the folder that it names.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Extent<'a> {
    /// One screen of a terminal: what does not fit is cut.
    Terminal(Option<&'a Path>),
    /// As much as the text needs; nothing was written.
    Whole,
    /// The same, with the folder that was written.
    WholeOf(&'a Path),
}

impl<'a> Extent<'a> {
    fn room(self) -> Room {
        if matches!(self, Self::Terminal(_)) { Room::Terminal } else { Room::Unlimited }
    }

    fn folder(self) -> Option<&'a Path> {
        match self {
            Self::Terminal(folder) => folder,
            Self::Whole => None,
            Self::WholeOf(folder) => Some(folder),
        }
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Room {
    Terminal,
    Unlimited,
}

/// What a document has for its screen alone.
pub(super) struct ScreenBlocks {
    /// The first lines.
    pub(super) question: String,
    pub(super) blocks: Vec<Block>,
    /// What is said below the verdict.
    pub(super) remarks: Vec<String>,
    /// The worst defects.
    pub(super) worst: Vec<DefectLine>,
}

pub(super) fn screen_blocks(ruled: &Ruled<'_>, extent: Extent<'_>) -> ScreenBlocks {
    let validation = ruled.validation;
    let room = extent.room();
    let warnings = warnings(validation, room);
    let worst = worst_defects(validation, warnings.lines().count(), room);
    let text = |text: String| Block::Text {
        title: "",
        lines: text.lines().map(str::to_string).collect(),
        room: raypencil_report::Room::Screen,
    };
    let blocks = vec![
        Block::Table { title: "", grid: quantities(ruled, room) },
        text(sensors(validation, room)),
        text(ray_sets(validation, room)),
        text(approximations(validation, room)),
        text(candidates(validation, room)),
        text(times(validation, room, warnings.is_empty())),
        text(files(validation, extent.folder(), room)),
        text(warnings),
    ];
    ScreenBlocks { question: head(validation, room), blocks, remarks: remarks(ruled), worst }
}

/// The scene, its renderers, where vehicle and terrain are, and what was rounded.
fn head(validation: &Validation, room: Room) -> String {
    let subject = &validation.subject;
    let names: Vec<&str> = validation.rendered.iter().map(|rendered| rendered.name.as_str()).collect();
    // The program's name and version stand before it.
    let before = format!("raypencil {VERSION}: ").chars().count();
    let who = cut_to(&format!("{} by {}", subject.name, list(&names)), MAX_COLUMNS - before, room);
    let stands = Whereabouts::of(&subject.scene, subject.vehicle.as_ref());
    let [vehicle, terrain] = [stands.vehicle_line(), stands.terrain_line()].map(|line| cut(&line, room));
    // On a terminal warnings take its room; the report has it all the same.
    let is_told = room == Room::Unlimited || validation.warnings.is_empty();
    let rounding = match stands.rounded_vertices.count {
        1.. if is_told => cut(&stands.rounding_line(), room) + "\n",
        _ => String::new(),
    };
    let file = match &subject.file_facts.units {
        Some(units) => cut(&format!("Its file: {}", units.words()), room) + "\n",
        None => String::new(),
    };
    format!("{who}\nScene SHA-256 {}\n{vehicle}\n{terrain}\n{file}{rounding}", scene_sha256(&subject.scene))
}

/// The table of quantities and classes over all sensors.
fn quantities(ruled: &Ruled<'_>, room: Room) -> Grid {
    let whole = quantities_of_screen(ruled, true);
    // With huge counts there is no room for the places; the report has them.
    let is_too_wide = room == Room::Terminal && whole.to_table().with_gap(1).width() > MAX_COLUMNS;
    if is_too_wide { quantities_of_screen(ruled, false) } else { whole }
}

/// A line for each sensor, over all pairs.
fn sensors(validation: &Validation, room: Room) -> String {
    let mut text = String::new();
    let sensors: Vec<SensorId> = validation.subject.scene.sensors().collect();
    for &sensor in sensors.iter().take(MAX_SENSORS) {
        let (width, height) = validation.subject.scene.size(sensor).expect("a sensor of this scene");
        let hit: Vec<String> = validation
            .rendered
            .iter()
            .map(|rendered| rendered.output.map(sensor).and_then(hits).map_or("?".into(), count))
            .collect();
        // One number if all renderers have the same.
        let hit = if hit.windows(2).all(|two| two[0] == two[1]) {
            hit.into_iter().next().unwrap_or_default()
        } else {
            hit.join("/")
        };
        let comparisons =
            || validation.pairs.iter().flat_map(|pair| &pair.sensors).filter(|found| found.sensor == sensor);
        let of = |class| comparisons().map(|comparison| comparison.of(class)).sum::<u64>();
        let missing: u64 = comparisons().map(|SensorResult { not_compared, .. }| not_compared).sum();
        let mut line = format!(
            "{:<7} {} rays: {} agree, {} tie, {} defect",
            sensor.to_string(),
            count(u64::from(width) * u64::from(height)),
            count(of(Class::Agree)),
            count(of(Class::Tie)),
            count(of(Class::Defect)),
        );
        if of(Class::Rounding) > 0 {
            let _ = write!(line, ", {} rounding", count(of(Class::Rounding)));
        }
        if of(Class::Approximation) > 0 {
            let _ = write!(line, ", {} approximation", count(of(Class::Approximation)));
        }
        if missing > 0 {
            let _ = write!(line, ", {} not compared", count(missing));
        }
        let _ = write!(line, "; {hit} hit");
        let _ = writeln!(text, "{}", cut(&line, room));
    }
    if sensors.len() > MAX_SENSORS {
        let _ = writeln!(text, "... and {} more sensors in the summary", sensors.len() - MAX_SENSORS);
    }
    text
}

/// A line for each set of rays.
fn ray_sets(validation: &Validation, room: Room) -> String {
    let sets = &validation.ray_sets;
    let most = if room == Room::Terminal { MAX_RAY_SETS } else { usize::MAX };
    let mut text = String::new();
    for set in sets.iter().take(most) {
        let _ = writeln!(text, "{}", cut(&format!("rays {}: {}", set.name, set.words()), room));
    }
    if let Some(more) = sets.len().checked_sub(most).filter(|more| *more > 0) {
        let _ = writeln!(text, "and {more} more sets of rays");
    }
    text
}

/// A line for each set of the paper's approximations that changed a ray.
fn approximations(validation: &Validation, room: Room) -> String {
    let mut text = String::new();
    let all = validation.approximations();
    for (cause, tally) in all.iter().take(MAX_CAUSES) {
        let mut line = format!(
            "{cause}: {}, {} lost, {} added",
            counted(tally.rays, "ray", "rays"),
            count(tally.lost),
            count(tally.added)
        );
        if let Some(found) = &tally.worst_range {
            let _ =
                write!(line, "; range off by {} at {}", worst(&tally.worst_range, "m"), short(found.place));
        }
        let _ = writeln!(text, "{}", cut(&line, room));
    }
    if all.len() > MAX_CAUSES {
        let _ = writeln!(text, "... and {} more causes in the summary", all.len() - MAX_CAUSES);
    }
    text
}

/// A line for each candidate, and one for what it does not give.
fn candidates(validation: &Validation, room: Room) -> String {
    let mut text = String::new();
    for report in validation.candidates().iter().take(MAX_CANDIDATES) {
        let _ = writeln!(text, "{}", cut(&candidates::line(report), room));
        let names = candidates::names_not_given(report);
        if !names.is_empty() {
            text.push_str(&wrap("  not given: ", names, 1, room));
        }
    }
    text
}

/// Stage times: a line for each renderer, then the other stages. Warnings take the room of some, if the times are not alone.
fn times(validation: &Validation, room: Room, alone: bool) -> String {
    let mut text = String::new();
    for rendered in &validation.rendered {
        let stages =
            rendered.output.stages.iter().map(|stage| format!("{} {}", stage.name, time(stage.time)));
        text.push_str(&wrap(&format!("{} {}: ", rendered.name, time(rendered.time)), stages, 1, room));
    }
    // Stages of a renderer are named `renderer: stage`; the others are not.
    let of_renderer = |stage: &&Stage| {
        let stage = stage.name.split_once(": ").map(|(renderer, _)| renderer);
        validation.rendered.iter().any(|rendered| stage == Some(rendered.name.as_str()))
    };
    let others = validation.stages.iter().filter(|stage| !of_renderer(stage));
    let others: Vec<String> = others.map(|stage| format!("{} {}", stage.name, time(stage.time))).collect();
    if !others.is_empty() {
        text.push_str(&wrap("", others, 1, room));
    }
    let most = match room {
        Room::Terminal if alone => MAX_TIME_LINES,
        Room::Terminal => MAX_TIME_LINES / 2,
        Room::Unlimited => usize::MAX,
    };
    text.lines().take(most).map(|line| format!("{line}\n")).collect()
}

/// The files that were written.
fn files(validation: &Validation, folder: Option<&Path>, room: Room) -> String {
    let Some(folder) = folder else { return String::new() };
    let mut text = format!("{}\n", folder.join("report.html").display());
    let maps: Vec<String> =
        validation.rendered.iter().map(|rendered| format!("{}/*.exr", rendered.name)).collect();
    let beside = ["summary.json", "summary.md", "junit.xml"].map(String::from);
    text.push_str(&wrap("  beside it: ", beside.into_iter().chain(maps), 2, room));
    text
}

/// The warnings, wrapped at the edge of the screen.
fn warnings(validation: &Validation, room: Room) -> String {
    let most = if room == Room::Terminal { MAX_WARNINGS } else { usize::MAX };
    let mut text = String::new();
    for warning in validation.warnings.iter().take(most) {
        let mut line = "warning:".to_string();
        for word in warning.to_string().split_whitespace() {
            if line.chars().count() + 1 + word.chars().count() > MAX_COLUMNS {
                let _ = writeln!(text, "{}", cut(&line, room));
                line = " ".repeat("warning:".len());
            }
            line.push(' ');
            line.push_str(word);
        }
        let _ = writeln!(text, "{}", cut(&line, room));
    }
    if let Some(more) = validation.warnings.len().checked_sub(most).filter(|more| *more > 0) {
        let _ = writeln!(
            text,
            "... and {} in the summary",
            counted(more as u64, "more warning", "more warnings")
        );
    }
    text
}

/// What was not compared, why the verdict is none, and why candidates are wrong.
fn remarks(Ruled { validation, counts, verdict, explanation, .. }: &Ruled<'_>) -> Vec<String> {
    let mut remarks = match verdict {
        Verdict::Agree if counts.not_compared > 0 => {
            vec![format!("{} not compared: one side has no maps.", rays(validation, counts.not_compared))]
        }
        Verdict::NothingCompared | Verdict::NothingHit => vec![explanation.clone()],
        _ => Vec::new(),
    };
    remarks.extend(candidates::whys(validation));
    remarks
}

/// The worst defects, with the commands that show them.
fn worst_defects(validation: &Validation, lines_of_warnings: usize, room: Room) -> Vec<DefectLine> {
    // Warnings take the room of the last defects, which have up to three lines each.
    let taken = match (room, lines_of_warnings) {
        (Room::Unlimited, _) | (_, 0) => 0,
        // With the blank line between the blocks.
        (Room::Terminal, lines) => (lines + 1).div_ceil(3),
    };
    let max_lines = if taken > 0 { 1 } else { MAX_DEFECT_LINES };
    // Words that do not fit at the end of a line leave some room there.
    let most = max_lines * MAX_COLUMNS - 16 * (max_lines - 1);
    let of_renderers = defects(validation).into_iter().take(MAX_DEFECTS.saturating_sub(taken));
    let of_candidates = validation.candidates().iter().flat_map(|report| report.misses().take(1));
    let line = |defect: &ListedDefect| {
        let (place, quantity) = (defect.place.to_string(), name_of(defect.item));
        // The place and the quantity stand before the words.
        let before = place.chars().count() + quantity.chars().count() + "indent".len();
        let words = cut_to(&defect.words(), most.saturating_sub(before), room);
        let command = probe_command(&validation.subject, defect.place);
        DefectLine { place, quantity, words, command, ..DefectLine::default() }
    };
    let of_sets = validation.candidates().iter().flat_map(|report| {
        report.ray_sets.iter().filter_map(|set| Some(set.bundle().listed.first()?.line.clone()))
    });
    let of_candidates: Vec<DefectLine> = of_candidates.map(line).chain(of_sets).collect();
    of_renderers.map(line).chain(of_candidates.into_iter().take(MAX_CANDIDATE_DEFECTS)).collect()
}

/// Joins `parts` with commas on lines that begin with `head` or as many blanks. Parts beyond `max_lines` lines are
/// counted, if there is no more room.
fn wrap(head: &str, parts: impl IntoIterator<Item = String>, max_lines: usize, room: Room) -> String {
    let max_lines = if room == Room::Terminal { max_lines } else { usize::MAX };
    let parts: Vec<String> = parts.into_iter().collect();
    let (mut lines, mut line) = (Vec::new(), head.to_string());
    for (index, part) in parts.iter().enumerate() {
        let part = if index + 1 < parts.len() { format!("{part},") } else { part.clone() };
        // All parts but the last leave room for the count of the parts that do not fit.
        let most = if index + 1 == parts.len() { MAX_COLUMNS } else { MAX_COLUMNS - 12 };
        let needed = line.chars().count() + 1 + part.chars().count();
        if index == 0 {
            line.push_str(&part);
        } else if needed <= most {
            line.push(' ');
            line.push_str(&part);
        } else if lines.len() + 1 < max_lines {
            lines.push(std::mem::replace(&mut line, format!("{}{part}", " ".repeat(head.chars().count()))));
        } else {
            line.push_str(&format!(" {} more", parts.len() - index));
            break;
        }
    }
    lines.push(line);
    lines.into_iter().map(|line| cut(&line, room) + "\n").collect()
}

/// A line cut at the edge of the screen.
fn cut(line: &str, room: Room) -> String {
    cut_to(line, MAX_COLUMNS, room)
}

/// A line cut after so many characters.
fn cut_to(line: &str, most: usize, room: Room) -> String {
    if room == Room::Unlimited || line.chars().count() <= most {
        return line.into();
    }
    let mut short: String = line.chars().take(most - 3).collect();
    short.push_str("...");
    short
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_lists_are_wrapped_and_counted() {
        let parts = (0..40).map(|index| format!("stage number {index} 12.3 ms"));
        let text = wrap("times: ", parts, 3, Room::Terminal);
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines.len(), 3);
        assert!(lines.iter().all(|line| line.chars().count() <= MAX_COLUMNS), "{text}");
        assert!(lines[0].starts_with("times: stage number 0 12.3 ms, stage"), "{text}");
        assert!(lines[1].starts_with("       stage"), "{text}");
        assert!(lines[2].ends_with("more"), "{text}");
    }

    #[test]
    fn short_lists_stay_on_one_line() {
        assert_eq!(
            wrap("times: ", ["a 1 s".into(), "b 2 s".into()], 3, Room::Terminal),
            "times: a 1 s, b 2 s\n"
        );
    }
}
