//! `summary.json`: a campaign for programs. Nothing in it depends on time or machine.

use std::collections::BTreeMap;

use raypencil_judge::{COMPARE_CLASSES, class_counts_json};
use serde_json::{Map, Value, json};

use crate::merge::Merged;
use crate::reasons::campaign_reasons;
use crate::record::{PartName, probe_arguments};
use crate::totals::{CampaignTotal, WorstRay, wrong_rays};

/// Maximum number of wrong rays that are listed.
const MAX_LISTED_RAYS: usize = 100;

/// What the document says to programs. Its schema is `docs/formats/campaign.schema.json`.
pub(crate) fn campaign_data(merged: &Merged) -> Map<String, Value> {
    let worst = |worst: &Option<WorstRay<'_>>| {
        worst.map(|WorstRay { record, terrain, part }| {
            json!({
                "value": record.value,
                "terrain": terrain,
                "part": part,
                "sensor": record.sensor, "i": record.i, "j": record.j,
                "replay": merged.replay_commands(terrain, part, &record.probe_arguments()),
            })
        })
    };
    let total = |total: &CampaignTotal<'_>| {
        let quantities = total.quantities.iter().map(|(quantity, one)| {
            json!({
                "quantity": quantity,
                "classes": class_counts_json(&one.by_class, &COMPARE_CLASSES),
                "not_compared": one.not_compared,
                "worst_error": worst(&one.worst_error),
                "worst_ratio": worst(&one.worst_ratio),
            })
        });
        json!({
            "compared": total.compared,
            "hits": total.hits,
            "classes": class_counts_json(&total.by_class, &COMPARE_CLASSES),
            "not_compared": total.not_compared,
            "judged": total.judged,
            "quantities": quantities.collect::<Vec<_>>(),
        })
    };
    let wrong = wrong_rays(merged).map(|(terrain, part, ray)| {
        json!({
            "terrain": terrain, "part": part,
            "sensor": ray.sensor, "i": ray.i, "j": ray.j,
            "quantity": ray.quantity, "what": ray.what,
            "replay": merged.replay_commands(terrain, part, &probe_arguments(&ray.sensor, ray.i, ray.j)),
        })
    });
    let all = CampaignTotal::of(merged, None);
    let faces: Vec<u64> = merged.terrains.iter().map(|terrain| terrain.faces).collect();
    let parts: BTreeMap<&str, Value> = PartName::ALL
        .into_iter()
        .map(|part| (part.word(), total(&CampaignTotal::of(merged, Some(part)))))
        .collect();
    let found = merged.warnings();
    let warnings = found
        .iter()
        .map(|(part, warning)| json!({ "code": warning.code, "part": part, "sentence": warning.sentence }));
    let failures: Vec<Value> = merged
        .failures()
        .map(|(terrain, part, why)| json!({ "terrain": terrain, "part": part, "message": why }))
        .collect();
    let document = json!({
        "version": merged.campaign.version,
        "seed": merged.campaign.seed,
        "terrains": merged.campaign.terrains,
        "faces": { "least": faces.iter().min(), "most": faces.iter().max(), "total": faces.iter().sum::<u64>() },
        "warnings": warnings.collect::<Vec<_>>(),
        "all": total(&all),
        "parts": parts,
        "candidate": merged.campaign.candidate,
        "no_answer": failures,
        "reasons": campaign_reasons(merged),
        "first_wrong": wrong.take(MAX_LISTED_RAYS).collect::<Vec<_>>(),
    });
    match document {
        Value::Object(keys) => keys,
        _ => Map::new(),
    }
}
