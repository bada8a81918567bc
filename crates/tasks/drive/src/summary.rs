//! Summary of a drive for programs, `summary.json`, in SI units. Schema: `docs/formats/drive.schema.json`.

use raypencil_report::VERSION;
use serde_json::{Map, Value, json};

use crate::counts::{CellCounts, scans, sector_counts};
use crate::differences::{Differences, StageDifferences};
use crate::job::DriveJob;
use crate::labels::label_word;
use crate::run::DriveRun;
use crate::sector_truth::SectorTruth;

/// The keys of the summary.
pub(crate) fn drive_data(job: &DriveJob, run: &DriveRun) -> Map<String, Value> {
    let cells = CellCounts::of(run);
    let labels: Map<String, Value> = sector_counts(run)
        .iter()
        .map(|(label, count)| (label_word(*label).to_string(), json!(count)))
        .collect();
    let seconds: Vec<Value> = run
        .stages
        .iter()
        .map(|stage| json!({ "name": stage.name, "seconds": stage.time.as_secs_f64() }))
        .collect();
    let route = &job.plan.route;
    let all = json!({
        "format": "raypencil-drive",
        "format_version": 3,
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
        "vertical_scans": scans(run),
        "edge_points": run.edge_points,
        "points_off_ground": {
            "points": run.point_errors.points,
            "beyond_ground": run.point_errors.beyond,
            "within_1cm": run.point_errors.within_1cm,
            "rms_m": run.point_errors.rms(),
            "largest_m": run.point_errors.largest,
        },
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
        "truth": truth(&run.truth, &run.upper_bound),
        "passes": run.passes(),
        "differences": run.differences.as_ref().map(differences),
        "whereabouts": run.whereabouts,
        "notes": job.notes,
        "warnings": job.warnings.iter().chain(&run.warnings).collect::<Vec<_>>(),
        "stages": seconds,
    });
    match all {
        Value::Object(keys) => keys,
        _ => Map::new(),
    }
}

/// Largest error of the vehicle's estimated elevation over all frames, metres.
fn elevation_error(run: &DriveRun) -> f64 {
    let errors = run.frames.iter().map(|frame| (frame.believed.position.z - frame.stance.position.z).abs());
    errors.fold(0.0, f64::max)
}

fn truth(truth: &SectorTruth, bound: &SectorTruth) -> Value {
    json!({
        "obstacle_maps": truth.maps,
        "sectors": truth.sectors,
        "with_obstacle": truth.with_obstacle,
        "true_rules": truth.true_rules.all().into_iter().map(|(word, sectors)| (word.to_string(), json!(sectors))).collect::<Map<_, _>>(),
        "found": truth.found,
        "passed": truth.passed(),
        "missed": {
            "by_errors": truth.missed.by_errors,
            "by_spacing": truth.missed.by_spacing,
            "by_rule": truth.missed.by_rule,
        },
        "not_seen": {
            "hidden": truth.not_found.hidden,
            "in_part": truth.not_found.in_part,
            "not_swept": truth.not_found.not_swept,
            "outside": truth.not_found.outside,
        },
        "false_obstacle": truth.false_obstacle,
        "false_before_a_true_one": truth.false_before,
        "unknown": {
            "not_measured": truth.unknown_not_measured,
            "may_hide": truth.unknown_may_hide,
            "near_limit": truth.unknown_near_limit,
            "beyond_map": truth.unknown_beyond_map,
        },
        "clear": truth.clear,
        "off_ground": truth.off_ground,
        "clear_way_m": truth.clear_mm as f64 / 1000.0,
        "upper_bound": {
            "found": bound.found,
            "passed": bound.passed(),
            "false_obstacle": bound.false_obstacle,
            "clear": bound.clear,
            "clear_way_m": bound.clear_mm as f64 / 1000.0,
        },
    })
}

fn differences(differences: &Differences) -> Value {
    let stage = |stage: &StageDifferences| json!({ "compared": stage.compared, "differ": stage.differ, "first": stage.first });
    json!({
        "flux": {
            "lit_pixels": differences.flux.lit,
            "differ": differences.flux.differ,
            "largest_relative": differences.flux.largest_relative,
        },
        "pixels": stage(&differences.pixels),
        "edges": stage(&differences.edges),
        "cells": stage(&differences.cells),
        "labels": stage(&differences.labels),
    })
}
