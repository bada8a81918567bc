//! A drive on one screen.

use std::path::Path;

use crate::figures::word;
use crate::job::DriveJob;
use crate::run::{DriveRun, frame_step};
use crate::summary::{cells, sectors};
use raypencil_report::{count, counted, number, time};

/// What was driven and found; `folder` is where it was written.
pub fn drive_screen(job: &DriveJob, run: &DriveRun, folder: Option<&Path>) -> String {
    let mut out =
        facts(job, run).iter().map(|(name, words)| format!("{name:10}{words}\n")).collect::<String>();
    for warning in &job.warnings {
        out += &format!("\nwarning: {warning}\n");
    }
    out += "\ntime\n";
    for stage in &run.stages {
        out += &format!("  {:44} {:>8}\n", stage.name, time(stage.time));
    }
    if !run.trace_lines().is_empty() {
        out += "\nboth sides\n";
        for line in run.trace_lines() {
            out += &format!("  {line}\n");
        }
    }
    if let Some(folder) = folder {
        out += &format!("\n{}\n", folder.join("report.html").display());
        out += "  beside it: figures (svg, png), drive.png, maps (npy, tif, ply, geojson, csv, nav2), summary.json\n";
    }
    out += &format!("\n{}\n", headline(run));
    out
}

/// The verdict in one sentence.
pub(crate) fn headline(run: &DriveRun) -> String {
    let frames = counted(run.frames.len() as u64, "frame", "frames");
    match &run.trace {
        None => format!("{frames} driven."),
        Some(trace) if trace.is_identical() => {
            format!(
                "Both sides are identical over {frames}: every digital pixel, edge point, map cell and label."
            )
        }
        Some(trace) => {
            let parts: Vec<String> = trace
                .stages()
                .iter()
                .filter(|(_, stage)| stage.differ > 0)
                .map(|(name, stage)| format!("{} {name}", count(stage.differ)))
                .collect();
            format!("The two sides differ in {}.", parts.join(", "))
        }
    }
}

/// Names and words of what was driven.
pub(crate) fn facts(job: &DriveJob, run: &DriveRun) -> Vec<(&'static str, String)> {
    let (cells, route) = (cells(run), &job.plan.route);
    let scans = run.frames.iter().filter(|frame| frame.scan.is_some()).count() as u64;
    let scans = if scans > 0 {
        format!(", {} of them", counted(scans, "vertical scan", "vertical scans"))
    } else {
        String::new()
    };
    let short = if (run.frames.len() as u64) < run.planned {
        format!(" of {} (the route leads off the ground)", run.planned)
    } else {
        String::new()
    };
    let sectors: Vec<String> =
        sectors(run).iter().map(|(label, sectors)| format!("{sectors} {}", word(*label))).collect();
    let mut points = format!("{} on stripe edges", count(run.edge_points));
    if run.edge_points > run.points.len() as u64 {
        points
            .push_str(&format!(", the first {} of them in edge-points.ply", count(run.points.len() as u64)));
    }
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
        ("camera", job.preset.to_string()),
        ("frames", format!("{}{short}{scans}, one each {} m", run.frames.len(), number(frame_step(route)))),
        ("driven", format!("{:.2} m at {} m/s", run.driven(), number(route.speed))),
        ("points", points),
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
        facts.extend(run.truth.words().map(|words| ("truth", words)));
    }
    facts.extend(job.notes.iter().map(|note| ("note", note.clone())));
    facts
}

impl DriveRun {
    /// What was compared, stage by stage; nothing with one side alone.
    pub(super) fn trace_lines(&self) -> Vec<String> {
        let Some(trace) = &self.trace else { return Vec::new() };
        let flux = trace.flux;
        let mut lines = vec![format!(
            "flux: {} of {} lit pixels differ in their last bits, by {} of themselves at most",
            count(flux.differ),
            count(flux.lit),
            number(flux.largest_relative)
        )];
        for (name, stage) in trace.stages() {
            let first = stage.first.as_ref().map_or(String::new(), |first| format!("; first: {first}"));
            lines.push(format!("{name}: {} of {} differ{first}", count(stage.differ), count(stage.compared)));
        }
        lines
    }
}
