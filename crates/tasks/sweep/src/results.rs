//! Results of a run, as numbers with names: the columns of the table.

use raypencil_harness::Validation;
use raypencil_scene::{FluxModel, RenderOutput, SensorId};
use raypencil_survey::SensorHits;
use serde_json::{Value, json};

use crate::plan::Task;

/// A result and its name.
pub type Named = (String, Value);

/// Parts of the summary of a drive that are no results: what was set, where it was written, how long it took.
const NO_RESULTS_OF_A_DRIVE: [&str; 18] = [
    "verdict",
    "headline",
    "format",
    "format_version",
    "version",
    "scene",
    "arguments",
    "source_sha256",
    "renderers",
    "sensor",
    "sun",
    "subtract_unlit",
    "frames_per_s",
    "speed_m_per_s",
    "notes",
    "stages",
    "whereabouts",
    "differences",
];

/// Results that a screen and the default charts show.
pub(crate) fn main_results(task: Task) -> &'static [&'static str] {
    match task {
        Task::Validate => &["compared", "tie", "rounding", "approximation", "undecided", "defects"],
        Task::Render => &["camera.hits", "beam-0.visible_share", "beam-0.lit_pixels", "beam-0.flux_w"],
        Task::Drive => &[
            "truth.found_share",
            "truth.passed",
            "truth.missed_share",
            "truth.false_share",
            "truth.clear_way_mean_m",
            "truth.upper_bound.found_share",
            "truth.upper_bound.clear_way_mean_m",
            "driven_m",
        ],
    }
}

/// Results of a drive: the numbers of its `summary.json`, and shares of them.
pub(crate) fn drive_results(summary: &Value) -> Vec<Named> {
    let mut results = Vec::new();
    if let Value::Object(all) = summary {
        for (key, value) in all.iter().filter(|(key, _)| !NO_RESULTS_OF_A_DRIVE.contains(&key.as_str())) {
            flatten(key, value, &mut results);
        }
    }
    let number = |name: &str| {
        results.iter().find(|(own, _)| own == name).and_then(|(_, value)| value.as_f64()).unwrap_or(0.0)
    };
    let missed: f64 =
        ["errors", "spacing", "rule"].iter().map(|why| number(&format!("truth.missed.by_{why}"))).sum();
    let (found, sectors) = (number("truth.found"), number("truth.sectors"));
    let clear_way = number("truth.clear_way_m");
    let shares = [
        // Of the sectors with an obstacle, how many end at it.
        ("truth.found_share", share(found, number("truth.with_obstacle"))),
        // Of the sectors with an obstacle, how many are called clear beyond it, for whatever reason.
        ("truth.passed_share", share(number("truth.passed"), number("truth.with_obstacle"))),
        // Of the obstacles that were swept and decided, how many the rover would have driven into.
        ("truth.missed_share", share(missed, found + missed)),
        ("truth.false_share", share(number("truth.false_obstacle"), sectors)),
        // How far a sector was truly clear and called so, on average.
        ("truth.clear_way_mean_m", share(clear_way, sectors)),
        // The same of a rover with exact eyes.
        (
            "truth.upper_bound.found_share",
            share(number("truth.upper_bound.found"), number("truth.with_obstacle")),
        ),
        ("truth.upper_bound.clear_way_mean_m", share(number("truth.upper_bound.clear_way_m"), sectors)),
    ];
    results.extend(shares.map(|(name, value)| (name.to_string(), value)));
    results
}

/// A part of a whole. Of nothing there is no share: what is divided by 0 is no number of JSON, and becomes null.
fn share(part: f64, whole: f64) -> Value {
    json!(part / whole)
}

/// Results of a rendering: what each sensor hits, and the light of each beam that the camera sees.
pub(crate) fn light_results(output: &RenderOutput, model: FluxModel) -> Vec<Named> {
    let unit = match model {
        FluxModel::Radiometric => "w",
        FluxModel::Eq1 => "w_per_m",
    };
    let mut results = Vec::new();
    for hits in output.maps().filter_map(SensorHits::of_map) {
        results.push((format!("{}.hits", hits.sensor), json!(hits.hits)));
    }
    for (index, returns) in output.returns.iter().enumerate() {
        let sensor = SensorId::Beam(index);
        if let Some(visible) = &returns.visible {
            let count = visible.cells().iter().filter(|visible| **visible).count();
            results.push((format!("{sensor}.visible"), json!(count)));
            results
                .push((format!("{sensor}.visible_share"), share(count as f64, visible.cells().len() as f64)));
        }
    }
    for (index, flux) in output.flux.iter().enumerate() {
        let sensor = SensorId::Beam(index);
        let lit = flux.cells().iter().filter(|flux| **flux > 0.0).count();
        // One after the other, from the first pixel to the last: the same bits everywhere.
        let sum: f64 = flux.cells().iter().sum();
        results.push((format!("{sensor}.lit_pixels"), json!(lit)));
        results.push((format!("{sensor}.flux_{unit}"), json!(sum)));
        results.push((format!("{sensor}.flux_per_lit_pixel_{unit}"), share(sum, lit as f64)));
    }
    results
}

/// Results of a validation: rays by class, and the light that the first renderer sees.
pub(crate) fn validation_results(validation: &Validation) -> Vec<Named> {
    let counts = validation.counts();
    let mut results: Vec<Named> = [
        ("passes", json!(validation.passes())),
        ("compared", json!(counts.compared)),
        ("agree", json!(counts.agree)),
        ("tie", json!(counts.tie)),
        ("rounding", json!(counts.rounding)),
        ("approximation", json!(counts.approximation)),
        ("undecided", json!(counts.undecided)),
        ("defects", json!(counts.defects)),
        ("not_compared", json!(counts.not_compared)),
        ("judged", json!(counts.judged)),
        ("warnings", json!(validation.warnings.len())),
    ]
    .map(|(name, value)| (name.to_string(), value))
    .into();
    if let Some(first) = validation.rendered.first() {
        results.extend(light_results(&first.output, validation.subject.scene.flux_model()));
    }
    results
}

/// The numbers, truths and texts of a document, by their path.
fn flatten(path: &str, value: &Value, found: &mut Vec<Named>) {
    match value {
        Value::Object(all) => {
            all.iter().for_each(|(key, value)| flatten(&format!("{path}.{key}"), value, found))
        }
        // Lists are of warnings: their number counts.
        Value::Array(all) => found.push((path.to_string(), json!(all.len()))),
        value => found.push((path.to_string(), value.clone())),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_drive_has_its_counts_and_their_shares() {
        let summary = json!({
            "format": "raypencil-drive", "stages": [{ "seconds": 1.5 }], "frames": 7, "warnings": ["a", "b"],
            "truth": {
                "sectors": 50, "with_obstacle": 40, "found": 30, "passed": 12, "false_obstacle": 5, "clear_way_m": 100.0,
                "missed": { "by_errors": 4, "by_spacing": 5, "by_rule": 1 },
                "upper_bound": { "found": 36, "clear_way_m": 125.0 }
            }
        });
        let results = drive_results(&summary);
        let of = |name: &str| results.iter().find(|(own, _)| own == name).map(|(_, value)| value.clone());
        assert_eq!(
            (of("frames"), of("warnings"), of("truth.found")),
            (Some(json!(7)), Some(json!(2)), Some(json!(30)))
        );
        assert_eq!(of("truth.found_share"), Some(json!(0.75)));
        assert_eq!(of("truth.passed_share"), Some(json!(0.3)));
        assert_eq!(of("truth.missed_share"), Some(json!(0.25)));
        assert_eq!(of("truth.false_share"), Some(json!(0.1)));
        assert_eq!(of("truth.clear_way_mean_m"), Some(json!(2.0)));
        assert_eq!(of("truth.upper_bound.found_share"), Some(json!(0.9)));
        assert_eq!(of("truth.upper_bound.clear_way_mean_m"), Some(json!(2.5)));
        // No times, and nothing of what was set.
        assert!(results.iter().all(|(name, _)| !name.contains("seconds") && !name.starts_with("format")));
        // A ground without obstacles has no share of them.
        assert_eq!(drive_results(&json!({ "truth": { "with_obstacle": 0 } }))[1].1, Value::Null);
        assert_eq!(
            [share(0.0, 0.0), share(1.0, 0.0), share(0.0, 2.0)],
            [Value::Null, Value::Null, json!(0.0)]
        );
    }
}
