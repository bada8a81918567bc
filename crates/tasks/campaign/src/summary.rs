//! `summary.json`: a campaign for programs. Nothing in it depends on time or machine.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use raypencil_files::{FileError, FolderError, begin_output_folder, write_atomically};
use raypencil_judge::{COMPARE_CLASSES, class_counts_json};
use serde_json::{Value, json};

use crate::merge::Merged;
use crate::page::campaign_html;
use crate::record::{PartName, probe_arguments};
use crate::totals::{CampaignTotal, WorstRay, wrong_rays};

/// Number of the format. It grows when a key changes its meaning or goes away.
const FORMAT: u32 = 1;

/// Maximum number of wrong rays that are listed.
const MAX_LISTED_RAYS: usize = 100;

/// The JSON document. Its schema is `docs/formats/campaign.schema.json`.
pub fn campaign_json(merged: &Merged) -> String {
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
    let verdict = match (merged.passes(), all.compared > 0 && all.hits == 0) {
        (true, _) => "agree",
        (false, true) => "nothing_hit",
        (false, false) => "defects",
    };
    let failures: Vec<Value> = merged
        .failures()
        .map(|(terrain, part, why)| json!({ "terrain": terrain, "part": part, "message": why }))
        .collect();
    let document = json!({
        "format": FORMAT,
        "version": merged.campaign.version,
        "seed": merged.campaign.seed,
        "terrains": merged.campaign.terrains,
        "faces": { "least": faces.iter().min(), "most": faces.iter().max(), "total": faces.iter().sum::<u64>() },
        "verdict": verdict,
        "warnings": warnings.collect::<Vec<_>>(),
        "all": total(&all),
        "parts": parts,
        "candidate": merged.campaign.candidate,
        "no_answer": failures,
        "first_wrong": wrong.take(MAX_LISTED_RAYS).collect::<Vec<_>>(),
    });
    format!("{document:#}\n")
}

/// Writes `report.html`, and last `summary.json`, into a folder. Returns the path of the summary.
///
/// # Errors
/// Names the file or folder that could not be written, and why.
pub fn write_campaign(merged: &Merged, folder: &Path) -> Result<PathBuf, FolderError> {
    let path = begin_output_folder(folder, "summary.json")?;
    let report = folder.join("report.html");
    let page = campaign_html(merged, |path| folder.join(path).is_file()).map_err(|error| FileError::Io {
        path: report.clone(),
        action: "write",
        source: std::io::Error::other(error),
    })?;
    write_atomically(&report, |file| file.write_all(page.as_bytes()))?;
    write_atomically(&path, |file| file.write_all(campaign_json(merged).as_bytes()))?;
    Ok(path)
}
