//! `summary.json`: what was driven and found, for programs. SI throughout, units in the names.
//! `docs/formats/drive.schema.json` describes it.

use serde_json::{Value, json};

use crate::figures::word;
use crate::job::DriveJob;
use crate::run::DriveRun;
use crate::trace::{StageTrace, Trace};
use crate::truth::{Said, TruthMatrix};
use raypencil_report::VERSION;
use raypencil_rover::{ElevationSource, Label};

/// Grid points of a map by what is known of them.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) struct Cells {
    pub known: u64,
    pub unknown: u64,
    pub measured: u64,
}

pub(crate) fn cells(run: &DriveRun) -> Cells {
    let mut cells = Cells::default();
    for point in run.map.points() {
        match run.map.source(point) {
            ElevationSource::Unknown => cells.unknown += 1,
            ElevationSource::Measured => {
                (cells.known, cells.measured) = (cells.known + 1, cells.measured + 1)
            }
            _ => cells.known += 1,
        }
    }
    cells
}

/// Sectors of the last obstacle map by their labels.
pub(crate) fn sectors(run: &DriveRun) -> [(Label, u64); 3] {
    [Label::Obstacle, Label::Unknown, Label::Visibility].map(|label| {
        let sectors = run.obstacles.iter().flat_map(|(_, map, _)| &map.sectors);
        (label, sectors.filter(|sector| sector.label == label).count() as u64)
    })
}

/// A drive as JSON.
pub fn drive_json(job: &DriveJob, run: &DriveRun) -> String {
    let cells = cells(run);
    let labels: serde_json::Map<String, Value> =
        sectors(run).iter().map(|(label, count)| (word(*label).to_string(), json!(count))).collect();
    let seconds: Vec<Value> = run
        .stages
        .iter()
        .map(|stage| json!({ "name": stage.name, "seconds": stage.time.as_secs_f64() }))
        .collect();
    let scans = run.frames.iter().filter(|frame| frame.scan.is_some()).count();
    let route = &job.plan.route;
    let all = json!({
        "format": "raypencil-drive",
        "format_version": 1,
        "version": VERSION,
        "scene": job.name,
        "arguments": job.arguments,
        "source_sha256": job.sha256,
        "renderers": run.renderers,
        "sensor": job.preset,
        "sun": job.sunlight.map(|sun| json!({
            "elevation_rad": sun.elevation,
            "azimuth_rad": sun.azimuth,
            "direct_w_per_m3": sun.direct,
            "sky_w_per_m3": sun.sky,
        })),
        "subtract_unlit": job.subtract_unlit,
        "frames": run.frames.len(),
        "frames_planned": run.planned,
        "frames_per_s": route.frame_rate,
        "speed_m_per_s": route.speed,
        "driven_m": run.driven(),
        "vertical_scans": scans,
        "edge_points": run.edge_points,
        "columns_left_out": run.frames.iter().map(|frame| frame.columns_left_out as u64).sum::<u64>(),
        "map": {
            "spacing_m": job.plan.map.spacing,
            "points": job.plan.map.points,
            "known": cells.known,
            "unknown": cells.unknown,
            "measured": cells.measured,
        },
        "obstacle_map_frame": run.obstacles.as_ref().map(|(frame, _, _)| frame),
        "sectors": labels,
        "largest_elevation_error_m": elevation_error(run),
        "truth": truth(&run.truth),
        "passes": run.passes(),
        "differences": run.trace.as_ref().map(differences),
        "notes": job.notes,
        "warnings": job.warnings,
        "stages": seconds,
    });
    format!("{all:#}\n")
}

/// By how much the vehicle was ever wrong of its own elevation, metres.
fn elevation_error(run: &DriveRun) -> f64 {
    let errors = run.frames.iter().map(|frame| (frame.believed.position.z - frame.stance.position.z).abs());
    errors.fold(0.0, f64::max)
}

fn truth(matrix: &TruthMatrix) -> Value {
    let said = |said: Said| json!({ "found_obstacle": said.obstacle, "found_unknown": said.unknown, "found_clear": said.clear });
    json!({
        "obstacle_maps": matrix.maps,
        "obstacle_points": said(matrix.obstacle),
        "clear_points": said(matrix.clear),
        "points_off_the_ground": matrix.beyond,
        "sectors": matrix.sectors,
        "sectors_free_past_an_obstacle": matrix.past,
    })
}

fn differences(trace: &Trace) -> Value {
    let stage = |StageTrace { compared, differ, first }: &StageTrace| json!({ "compared": compared, "differ": differ, "first": first });
    json!({
        "flux": {
            "lit_pixels": trace.flux.lit,
            "differ": trace.flux.differ,
            "largest_relative": trace.flux.largest_relative,
        },
        "pixels": stage(&trace.pixels),
        "edges": stage(&trace.edges),
        "cells": stage(&trace.cells),
        "labels": stage(&trace.labels),
    })
}
