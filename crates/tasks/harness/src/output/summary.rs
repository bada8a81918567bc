//! `summary.json`: the validation for programs. Its schema is `docs/formats/summary.schema.json`.

use std::collections::BTreeMap;

use raypencil_cast::comparison_json;
use raypencil_judge::{ApproximationTallies, ApproximationTally, Class, Largest, Quantity, SensorResult};
use raypencil_scene::Switches;
use raypencil_scene_io::{Subject, probe_command, scene_sha256};
use raypencil_survey::{Warning, Whereabouts};
use serde::Serialize;
use serde_json::{Map, Value, json};

use crate::output::panel::{ScoreboardSummary, scoreboard_summary};
use crate::output::table::hits;
use crate::output::verdict::Ruled;
use crate::ray_sets::RaySetResult;
use crate::rendered::Rendered;
use crate::validation::{Pair, Validation};

/// Version of the schema; it grows when a key changes its meaning or is removed. Since 2 `scene.sha256` is the digest of
/// the resolved scene.
pub(super) const FORMAT: u32 = 2;

#[derive(Serialize)]
struct Summary<'a> {
    /// Whether the exit code is 0.
    passes: bool,
    candidates: CandidateCounts,
    #[serde(flatten)]
    classes: Classes,
    /// Rays that each set of the paper's approximations changed, by the names of its switches.
    approximations: BTreeMap<String, u64>,
    causes: Vec<CauseSummary>,
    warnings: &'a [Warning],
    scene: SceneName<'a>,
    whereabouts: Whereabouts,
    renderers: Vec<RendererSummary<'a>>,
    pairs: Vec<PairSummary<'a>>,
    ray_sets: Vec<Value>,
    /// Renderers and candidates checked against the exact answers; null without candidates.
    #[serde(rename = "panel")]
    scoreboard: Option<ScoreboardSummary>,
    stages: Vec<StageSummary<'a>>,
}

/// Candidates, and what is asked of them.
#[derive(Serialize)]
struct CandidateCounts {
    count: usize,
    wrong: usize,
    must_pass: bool,
}

/// Rays by class. Together with all approximations they add up to `compared`.
#[derive(Debug, Clone, Copy, Serialize)]
struct Classes {
    compared: u64,
    agree: u64,
    tie: u64,
    rounding: u64,
    undecided: u64,
    defects: u64,
    not_compared: u64,
    /// Rays that the referee ruled on.
    judged: u64,
}

#[derive(Serialize)]
struct SceneName<'a> {
    name: &'a str,
    /// Digest of the resolved scene, which candidates and packs have.
    sha256: String,
    /// Digest of the files or the input that define the scene.
    source_sha256: &'a str,
    arguments: &'a str,
    /// What the terrain's file says of its units and axes, and what holds; null: the terrain has no file.
    terrain_file: Option<Value>,
}

#[derive(Serialize)]
struct RendererSummary<'a> {
    name: &'a str,
    unit_roundoff: Option<f64>,
    seconds: f64,
    /// Flux of each beam, summed over the camera's pixels.
    flux: Vec<f64>,
    sensors: Vec<MapSummary>,
}

#[derive(Serialize)]
struct MapSummary {
    sensor: String,
    columns: u32,
    rows: u32,
    hits: Option<u64>,
    file: String,
}

#[derive(Serialize)]
struct PairSummary<'a> {
    a: &'a str,
    b: &'a str,
    sensors: Vec<SensorSummary>,
}

#[derive(Serialize)]
struct CauseSummary {
    switches: String,
    rays: u64,
    lost: u64,
    added: u64,
    worst_range_error_m: Option<WorstSummary>,
    flux_changed: f64,
}

#[derive(Serialize)]
struct SensorSummary {
    sensor: String,
    #[serde(flatten)]
    classes: Classes,
    approximations: BTreeMap<String, u64>,
    causes: Vec<CauseSummary>,
    quantities: Vec<QuantitySummary>,
    worst_defects: Vec<Value>,
}

#[derive(Serialize)]
struct QuantitySummary {
    quantity: Quantity,
    unit: &'static str,
    agree: u64,
    tie: u64,
    rounding: u64,
    approximation: u64,
    undecided: u64,
    defects: u64,
    not_compared: u64,
    worst_error: Option<WorstSummary>,
    worst_ratio: Option<WorstSummary>,
}

#[derive(Serialize)]
struct WorstSummary {
    /// `None` if not finite: JSON has finite numbers only.
    value: Option<f64>,
    sensor: String,
    i: u32,
    j: u32,
    probe: String,
}

#[derive(Serialize)]
struct StageSummary<'a> {
    name: &'a str,
    seconds: f64,
}

/// The keys of `summary.json`, but those that every document has.
pub(super) fn summary_keys(Ruled { validation, counts, .. }: &Ruled<'_>) -> Map<String, Value> {
    let Validation { subject, rendered, pairs, candidates_may_fail, stages, .. } = validation;
    let approximations = validation.approximations();
    let summary = Summary {
        passes: validation.passes(),
        candidates: CandidateCounts {
            count: validation.candidates().len(),
            wrong: validation.candidates().iter().filter(|report| !report.passes()).count(),
            must_pass: !candidates_may_fail,
        },
        classes: Classes {
            compared: counts.compared,
            agree: counts.agree,
            tie: counts.tie,
            rounding: counts.rounding,
            undecided: counts.undecided,
            defects: counts.defects,
            not_compared: counts.not_compared,
            judged: counts.judged,
        },
        approximations: rays_by_cause(&approximations),
        causes: cause_summaries(subject, &approximations),
        warnings: &validation.warnings,
        scene: SceneName {
            name: &subject.name,
            sha256: scene_sha256(&subject.scene),
            source_sha256: &subject.sha256,
            arguments: &subject.arguments,
            terrain_file: subject.file_facts.units.as_ref().map(|units| units.to_json()),
        },
        whereabouts: Whereabouts::of(&subject.scene, subject.vehicle.as_ref()),
        renderers: rendered.iter().map(renderer_summary).collect(),
        pairs: pairs.iter().map(|pair| pair_summary(validation, pair)).collect(),
        ray_sets: validation.ray_sets.iter().map(ray_set_summary).collect(),
        scoreboard: scoreboard_summary(validation),
        stages: stages
            .iter()
            .map(|stage| StageSummary { name: &stage.name, seconds: stage.time.as_secs_f64() })
            .collect(),
    };
    match serde_json::to_value(&summary) {
        Ok(Value::Object(keys)) => keys,
        _ => unreachable!("a struct of numbers, texts and lists of them is an object"),
    }
}

fn ray_set_summary(set: &RaySetResult) -> Value {
    let compared = set.comparison.as_ref().map(|comparison| comparison_json("tracer", comparison));
    json!({
        "name": set.name,
        "rays": set.rays(),
        "hits": set.hits(),
        "too_near": set.too_near(),
        "compared": compared,
    })
}

fn renderer_summary(rendered: &Rendered) -> RendererSummary<'_> {
    let sensors = rendered.output.maps().map(|map| MapSummary {
        sensor: map.sensor.to_string(),
        columns: map.width,
        rows: map.height,
        hits: hits(map),
        file: rendered.map_file(map.sensor),
    });
    RendererSummary {
        name: &rendered.name,
        unit_roundoff: finite(rendered.precision.unit_roundoff),
        seconds: rendered.time.as_secs_f64(),
        flux: rendered.output.flux.iter().map(|image| image.cells().iter().sum()).collect(),
        sensors: sensors.collect(),
    }
}

fn pair_summary<'a>(validation: &'a Validation, pair: &'a Pair) -> PairSummary<'a> {
    let name = |index: usize| validation.rendered[index].name.as_str();
    let sensors = pair.sensors.iter().map(|sensor| sensor_summary(&validation.subject, sensor)).collect();
    PairSummary { a: name(pair.a), b: name(pair.b), sensors }
}

fn sensor_summary(subject: &Subject, comparison: &SensorResult) -> SensorSummary {
    let quantities = comparison.items.iter().map(|(item, tally)| QuantitySummary {
        quantity: item.quantity,
        unit: item.quantity.unit(subject.scene.flux_model()),
        agree: tally.of(Class::Agree),
        tie: tally.of(Class::Tie),
        rounding: tally.of(Class::Rounding),
        approximation: tally.of(Class::Approximation),
        undecided: tally.of(Class::Undecided),
        defects: tally.of(Class::Defect),
        not_compared: tally.not_compared,
        worst_error: worst(subject, &tally.worst_error),
        worst_ratio: worst(subject, &tally.worst_ratio),
    });
    let model = subject.scene.flux_model();
    let defects = comparison.listed.iter();
    let defects = defects.map(|defect| defect.to_json(model, &probe_command(subject, defect.place)));
    SensorSummary {
        sensor: comparison.sensor.to_string(),
        classes: Classes {
            compared: comparison.compared(),
            agree: comparison.of(Class::Agree),
            tie: comparison.of(Class::Tie),
            rounding: comparison.of(Class::Rounding),
            undecided: comparison.of(Class::Undecided),
            defects: comparison.of(Class::Defect),
            not_compared: comparison.not_compared,
            judged: comparison.judged,
        },
        approximations: rays_by_cause(&comparison.approximations),
        causes: cause_summaries(subject, &comparison.approximations),
        quantities: quantities.collect(),
        worst_defects: defects.collect(),
    }
}

fn rays_by_cause(approximations: &ApproximationTallies) -> BTreeMap<String, u64> {
    approximations.iter().map(|(cause, tally)| (cause.to_string(), tally.rays)).collect()
}

fn cause_summaries(subject: &Subject, approximations: &ApproximationTallies) -> Vec<CauseSummary> {
    let summary = |(cause, tally): (&Switches, &ApproximationTally)| CauseSummary {
        switches: cause.to_string(),
        rays: tally.rays,
        lost: tally.lost,
        added: tally.added,
        worst_range_error_m: worst(subject, &tally.worst_range),
        flux_changed: tally.flux_changed,
    };
    approximations.iter().map(summary).collect()
}

fn worst(subject: &Subject, worst: &Option<Largest>) -> Option<WorstSummary> {
    worst.as_ref().map(|&Largest { value, place, .. }| WorstSummary {
        value: finite(value),
        sensor: place.sensor.to_string(),
        i: place.i,
        j: place.j,
        probe: probe_command(subject, place),
    })
}

fn finite(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}
