//! `check.json`: a check for programs.

use raypencil_judge::{
    CHECK_CLASSES, Item, ItemTally, Largest, SensorResult, class_counts_json, key_of, unit_of,
};
use raypencil_scene::SensorId;
use serde_json::json;

use crate::check::{Checked, RaySetOutcome};
use crate::check_report::verdict::{arithmetic, not_given, verdict};

/// Number of the format. It grows when a key changes its meaning or goes away.
const FORMAT: u32 = 2;

/// The JSON document. Its schema is `docs/formats/check.schema.json`.
pub fn check_json(checked: &Checked) -> String {
    let Checked { subject, recorded, check, diagnosis, is_blind, .. } = checked;
    let model = subject.scene.flux_model();
    let largest = |largest: &Option<Largest>| {
        largest.as_ref().map(|Largest { value, place, ruling }| {
            json!({
                "value": value.is_finite().then_some(*value),
                "sensor": place.sensor.to_string(), "i": place.i, "j": place.j,
                "ruling": ruling,
                "probe": checked.repro(*place),
            })
        })
    };
    let quantity_json = |sensor: SensorId, (item, tally): (Item, &ItemTally)| {
        let storage = recorded.storage.get(&(sensor, item)).map(ToString::to_string);
        json!({
            "quantity": key_of(model, item),
            "unit": unit_of(model, item),
            "storage": storage,
            "not_given": not_given(tally),
            "compared": tally.compared(),
            "classes": class_counts_json(&tally.by_class, &CHECK_CLASSES),
            "not_compared": tally.not_compared,
            "worst_ulp": largest(&tally.worst_ulps),
            "worst_error": largest(&tally.worst_error),
            "worst_ratio": largest(&tally.worst_ratio),
        })
    };
    let sensor_json = |sensor: &SensorResult| {
        let wrong = sensor.listed.iter().map(|one| one.to_json(model, &checked.repro(one.place)));
        json!({
            "sensor": sensor.sensor.to_string(),
            "compared": sensor.compared(),
            "classes": class_counts_json(&sensor.by_class, &CHECK_CLASSES),
            "not_compared": sensor.not_compared,
            "ruled": sensor.judged,
            "quantities": sensor.items.iter().map(|of| quantity_json(sensor.sensor, of)).collect::<Vec<_>>(),
            "worst_defects": wrong.collect::<Vec<_>>(),
        })
    };
    let set_json = |set: &RaySetOutcome| json!({ "name": set.name, "passes": set.passes, "what": set.words });
    let diagnosis_json = diagnosis.as_ref().map(|found| {
        let mistakes = found.mistakes.iter().map(|mistake| {
            let (file, place) = mistake.docs();
            json!({ "name": mistake.key(), "what": mistake.to_string(), "docs": format!("{file}, {place}") })
        });
        json!({
            "sentence": found.sentence(),
            "agree": found.agree,
            "tried": found.tried,
            "mistakes": mistakes.collect::<Vec<_>>(),
        })
    });
    let all: [u64; 6] = std::array::from_fn(|k| check.sensors.iter().map(|sensor| sensor.by_class[k]).sum());
    let document = json!({
        "format": FORMAT,
        "version": env!("CARGO_PKG_VERSION"),
        "verdict": verdict(checked),
        "candidate": recorded.name,
        "arithmetic": arithmetic(recorded.precision),
        "scene": { "name": subject.name, "sha256": subject.sha256 },
        "pack": {
            "sha256": checked.pack.sha256,
            "version": checked.pack.label.version,
            "licence": checked.pack.label.licence,
            "published": checked.pack.is_published(),
        },
        "blind": is_blind,
        "verified": {
            "answers": checked.verified.answers, "of": checked.verified.of, "ray_files": checked.verified.rays
        },
        "compared": check.compared(),
        "classes": class_counts_json(&all, &CHECK_CLASSES),
        "diagnosis": diagnosis_json,
        "unknown_channels": recorded.unknown,
        "sensors": check.sensors.iter().map(sensor_json).collect::<Vec<_>>(),
        "ray_sets": checked.ray_sets.iter().map(set_json).collect::<Vec<_>>(),
    });
    format!("{document:#}\n")
}
