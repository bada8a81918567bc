//! Sentences about a drive, for the screen and for the HTML report.

use raypencil_report::{count, counted, number};

use crate::counts::{CellCounts, scans, sector_counts};
use crate::job::DriveJob;
use crate::labels::label_word;
use crate::point_errors::PointErrors;
use crate::run::DriveRun;

/// Verdict in one sentence.
pub(crate) fn headline(run: &DriveRun) -> String {
    let frames = counted(run.frames.len() as u64, "frame", "frames");
    let passes = passes(run);
    match &run.differences {
        None => format!("{frames} driven{passes}."),
        Some(differences) if differences.is_identical() => {
            format!("Both sides are identical over {frames}, in every pixel, edge, cell and label{passes}.")
        }
        Some(differences) => {
            let parts: Vec<String> = differences
                .stages()
                .iter()
                .filter(|(_, stage)| stage.differ > 0)
                .map(|(name, stage)| format!("{} {name}", count(stage.differ)))
                .collect();
            format!("The two sides differ in {}{passes}.", parts.join(", "))
        }
    }
}

/// How many sectors pass an obstacle, as the end of the headline; empty without an obstacle map.
fn passes(run: &DriveRun) -> String {
    let (passed, sectors) = (run.truth.passed(), run.truth.sectors);
    if sectors == 0 {
        return String::new();
    }
    // Who measures nothing passes nothing: that is no success.
    let [_, (_, unknown), _] = sector_counts(run);
    if passed == 0 && unknown == sectors {
        return format!("; all {} end unknown", counted(sectors, "sector", "sectors"));
    }
    let verb = if passed == 1 { "passes" } else { "pass" };
    format!("; {} of {} {verb} an obstacle", count(passed), counted(sectors, "sector", "sectors"))
}

/// Facts of a drive: each a name and its words.
pub(crate) fn facts(job: &DriveJob, run: &DriveRun) -> Vec<(&'static str, String)> {
    let (cells, route) = (CellCounts::of(run), &job.plan.route);
    let scans = match scans(run) {
        0 => String::new(),
        scans => format!(", {} of them", counted(scans, "vertical scan", "vertical scans")),
    };
    let sectors: Vec<String> = sector_counts(run)
        .iter()
        .map(|(label, sectors)| format!("{sectors} {}", label_word(*label)))
        .collect();
    let mut points = format!("{} on stripe edges", count(run.edge_points));
    if run.edge_points > run.points.len() as u64 {
        points
            .push_str(&format!(", the first {} of them in edge-points.ply", count(run.points.len() as u64)));
    }
    // Distance between frames on a straight leg, metres.
    let frame_step = route.speed / route.frame_rate;
    let mut facts = vec![
        (
            "scene",
            format!(
                "{} ({} faces), {}",
                job.name,
                count(job.mesh.faces().len() as u64),
                run.renderers.join(" and ")
            ),
        ),
        ("start", run.whereabouts.vehicle_line().replacen("vehicle at ", "", 1)),
        ("terrain", run.whereabouts.terrain_line().replacen("terrain ", "", 1)),
        ("camera", job.preset.to_string()),
        ("frames", format!("{}{scans}, one per {} m", run.frames.len(), number(frame_step))),
        ("driven", format!("{:.2} m at {} m/s", run.driven(), number(route.speed))),
        ("points", points),
        ("points", off_ground(&run.point_errors)),
        (
            "map",
            format!(
                "{} cells known ({} measured), {} unknown; {} m apart",
                count(cells.known),
                count(cells.measured),
                count(cells.unknown),
                job.plan.map.spacing
            ),
        ),
    ];
    if let Some((frame, _, _)) = &run.obstacles {
        facts.push(("sectors", format!("{} (frame {frame})", sectors.join(", "))));
    }
    if run.truth.maps > 0 {
        facts.extend(run.truth.sentences().into_iter().map(|sentence| ("truth", sentence)));
        facts.extend(run.truth.true_rules.sentence().map(|sentence| ("truth", sentence)));
        facts.push(("bound", run.upper_bound.sentence_of_bound()));
    }
    facts.extend(job.notes.iter().map(|note| ("note", note.clone())));
    facts
}

/// How far the points are off the true ground.
fn off_ground(errors: &PointErrors) -> String {
    if errors.points == 0 {
        return "none over the true ground".into();
    }
    format!(
        "{:.1} mm rms off the true ground below them, {:.1} % of them less than 1 cm",
        1e3 * errors.rms(),
        100.0 * errors.share_within_1cm()
    )
}

/// Lines about the differences, stage by stage; none with one renderer.
pub(crate) fn difference_lines(run: &DriveRun) -> Vec<String> {
    let Some(differences) = &run.differences else { return Vec::new() };
    let flux = differences.flux;
    let mut lines = vec![format!(
        "flux: {} of {} lit pixels differ, relatively by {} at most",
        count(flux.differ),
        count(flux.lit),
        number(flux.largest_relative)
    )];
    for (name, stage) in differences.stages() {
        let first = stage.first.as_ref().map_or(String::new(), |first| format!("; first: {first}"));
        lines.push(format!("{name}: {} of {} differ{first}", count(stage.differ), count(stage.compared)));
    }
    lines
}
