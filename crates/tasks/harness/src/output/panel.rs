//! The scoreboard for programs: the key `panel` of `summary.json`.

use raypencil_diagnosis::Diagnosis;
use raypencil_judge::{Check, Class, Item, ItemTally, ListedDefect, Recorded, key_of, unit_of};
use raypencil_pack::{BundleFindings, not_given, rays_not_given};
use raypencil_scene_io::{Subject, probe_command};
use serde::Serialize;
use serde_json::Value;

use crate::monte_carlo::{ImageComparison, Z_TEST_LIMITS};
use crate::output::candidates::{MAX_LISTED, miss_folder, wrong};
use crate::radiance::RadianceComparison;
use crate::ray_set_packs::CheckedRaySet;
use crate::validation::Validation;

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
    passes: bool,
    compared: u64,
    agree: u64,
    tie: u64,
    rounding: u64,
    wrong: u64,
    not_given: u64,
    quantities: Vec<ItemSummary>,
    images: Vec<ImageSummary>,
    radiance: Vec<RadianceSummary>,
    /// A candidate's sets of rays, as bundles of `check.json`.
    ray_sets: Vec<Value>,
    misses: Vec<Value>,
    diagnosis: Option<Value>,
}

#[derive(Serialize)]
struct ItemSummary {
    quantity: String,
    unit: &'static str,
    /// Why nothing was compared, `not given` as a rule; null if something was.
    absent: Option<&'static str>,
    /// Type in which a candidate stores it: half, single, double or whole.
    storage: Option<String>,
    compared: u64,
    // Null, never 0, if nothing was compared.
    agree: Option<u64>,
    tie: Option<u64>,
    rounding: Option<u64>,
    wrong: Option<u64>,
    not_given: u64,
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

fn finite(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}

/// The scoreboard of a validation for `summary.json`; `None` without candidates.
pub(crate) fn scoreboard_summary(validation: &Validation) -> Option<ScoreboardSummary> {
    let scoreboard = validation.scoreboard.as_ref()?;
    let subject = &validation.subject;
    let ours = scoreboard.ours.iter().map(|report| check_summary(subject, &report.name, &report.check, None));
    let theirs = scoreboard.candidates.iter().map(|report| {
        let (name, recorded) = (&report.candidate.name, Some(&report.candidate.recorded));
        let mut summary = check_summary(subject, name, &report.check, recorded);
        summary.is_candidate = true;
        summary.passes = report.passes();
        let bundles: Vec<BundleFindings> = report.ray_sets.iter().map(CheckedRaySet::bundle).collect();
        for bundle in &bundles {
            let of = |class: Class| bundle.by_class[class as usize];
            summary.compared += bundle.compared();
            summary.agree += of(Class::Agree);
            summary.tie += of(Class::Tie);
            summary.rounding += of(Class::Rounding);
            summary.wrong += of(Class::Defect) + of(Class::Undecided);
            summary.not_given += bundle.not_compared;
        }
        summary.ray_sets = bundles.iter().map(BundleFindings::to_json).collect();
        summary.diagnosis = report.diagnosis.as_ref().map(Diagnosis::to_json);
        summary.images = report.images.iter().map(image_summary).collect();
        summary.radiance = report.radiance.iter().map(radiance_summary).collect();
        let of_miss = |(index, wrong): (usize, &ListedDefect)| {
            let mut miss = wrong.to_json(subject.scene.flux_model(), &probe_command(subject, wrong.place));
            miss["reproducer"] = miss_folder(report, index).into();
            miss
        };
        summary.misses = report.misses().take(MAX_LISTED).enumerate().map(of_miss).collect();
        summary
    });
    Some(ScoreboardSummary { renderers: ours.chain(theirs).collect() })
}

fn check_summary(subject: &Subject, name: &str, check: &Check, recorded: Option<&Recorded>) -> CheckSummary {
    let model = subject.scene.flux_model();
    let if_compared = |tally: &ItemTally, rays: u64| (tally.compared() > 0).then_some(rays);
    let of_item = |(item, tally): (Item, ItemTally)| ItemSummary {
        quantity: key_of(model, item),
        unit: unit_of(model, item),
        absent: not_given(&tally),
        storage: recorded.and_then(|recorded| recorded.storage_of_item(item)).map(|how| how.to_string()),
        compared: tally.compared(),
        agree: if_compared(&tally, tally.of(Class::Agree)),
        tie: if_compared(&tally, tally.of(Class::Tie)),
        rounding: if_compared(&tally, tally.of(Class::Rounding)),
        wrong: if_compared(&tally, wrong(&tally)),
        not_given: rays_not_given(&tally),
        worst_error: tally.worst_error.as_ref().and_then(|largest| finite(largest.value)),
        worst_ratio: tally.worst_ratio.as_ref().and_then(|largest| finite(largest.value)),
    };
    CheckSummary {
        name: name.into(),
        is_candidate: false,
        passes: check.passes(),
        compared: check.compared(),
        agree: check.of(Class::Agree),
        tie: check.of(Class::Tie),
        rounding: check.of(Class::Rounding),
        wrong: check.of(Class::Defect) + check.of(Class::Undecided),
        not_given: check.sensors.iter().map(|sensor| sensor.not_compared).sum(),
        quantities: check.totals().into_iter().map(of_item).collect(),
        images: Vec::new(),
        radiance: Vec::new(),
        ray_sets: Vec::new(),
        misses: Vec::new(),
        diagnosis: None,
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
