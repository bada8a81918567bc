//! A whole campaign, for people and for programs. Nothing in it depends on time or machine.

use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use crate::merge::Merged;
use crate::record::{PartName, PartRecord, TerrainRecord, WorstRecord, probe_words};
use raypencil_files::{FolderError, begin_output_folder};
use raypencil_judge::{Class, Quantity};
use raypencil_report::{count, number};

/// The number of the summary's form.
const FORMAT: u32 = 1;

/// Wrong rays that are listed.
const LISTED: usize = 10;

/// Counts and worst errors over some parts.
#[derive(Debug, Default)]
struct Total<'a> {
    compared: u64,
    by_class: [u64; 6],
    not_compared: u64,
    judged: u64,
    quantities: BTreeMap<Quantity, QuantityTotal<'a>>,
}

#[derive(Debug, Default)]
struct QuantityTotal<'a> {
    by_class: [u64; 6],
    not_compared: u64,
    error: Option<Found<'a>>,
    ratio: Option<Found<'a>>,
}

/// The worst of something, and in which scene.
#[derive(Debug, Clone, Copy)]
struct Found<'a> {
    worst: &'a WorstRecord,
    terrain: u64,
    part: PartName,
}

impl<'a> Total<'a> {
    fn of(merged: &'a Merged, part: Option<PartName>) -> Self {
        let mut total = Self::default();
        for TerrainRecord { terrain, parts, .. } in &merged.terrains {
            for record in parts.iter().filter(|record| part.is_none_or(|part| record.part == part)) {
                total.add(*terrain, record);
            }
        }
        total
    }

    fn add(&mut self, terrain: u64, record: &'a PartRecord) {
        self.compared += record.compared;
        self.not_compared += record.not_compared;
        self.judged += record.judged;
        for (mine, theirs) in self.by_class.iter_mut().zip(record.by_class) {
            *mine += theirs;
        }
        for quantity in &record.quantities {
            let mine = self.quantities.entry(quantity.quantity).or_default();
            for (mine, theirs) in mine.by_class.iter_mut().zip(quantity.by_class) {
                *mine += theirs;
            }
            mine.not_compared += quantity.not_compared;
            for (slot, worst) in
                [(&mut mine.error, &quantity.worst_error), (&mut mine.ratio, &quantity.worst_ratio)]
            {
                let Some(worst) = worst else { continue };
                // What is no finite number is worse than any; of equals the first stays.
                let size = |worst: &WorstRecord| worst.value.unwrap_or(f64::INFINITY);
                if slot.is_none_or(|kept| size(worst) > size(kept.worst)) {
                    *slot = Some(Found { worst, terrain, part: record.part });
                }
            }
        }
    }
}

impl Merged {
    /// Whether nothing is wrong or undecided, and something was compared.
    pub fn passes(&self) -> bool {
        let total = Total::of(self, None);
        total.compared > 0
            && total.by_class[Class::Defect as usize] == 0
            && total.by_class[Class::Undecided as usize] == 0
    }

    /// Rays compared.
    pub fn compared(&self) -> u64 {
        Total::of(self, None).compared
    }

    /// The command that shows a ray of it again.
    fn replay(&self, terrain: u64, part: PartName, cell: &str) -> String {
        format!(
            "raypencil campaign replay --seed {} --terrain {terrain} --part {} -o DIR, then raypencil probe DIR/scene.toml {cell}",
            self.campaign.seed,
            part.word()
        )
    }
}

fn classes(by_class: &[u64; 6]) -> Value {
    json!({
        "agree": by_class[Class::Agree as usize],
        "tie": by_class[Class::Tie as usize],
        "rounding": by_class[Class::Rounding as usize],
        "approximation": by_class[Class::Approximation as usize],
        "undecided": by_class[Class::Undecided as usize],
        "defects": by_class[Class::Defect as usize],
    })
}

/// The campaign for programs.
pub fn campaign_json(merged: &Merged) -> String {
    let found = |found: &Option<Found<'_>>| {
        found.map(|Found { worst, terrain, part }| {
            json!({
                "value": worst.value,
                "terrain": terrain,
                "part": part,
                "sensor": worst.sensor, "i": worst.i, "j": worst.j,
                "replay": merged.replay(terrain, part, &worst.cell()),
            })
        })
    };
    let of_total = |total: &Total<'_>| {
        let quantities = total.quantities.iter().map(|(quantity, one)| {
            json!({
                "quantity": quantity,
                "classes": classes(&one.by_class),
                "not_compared": one.not_compared,
                "worst_error": found(&one.error),
                "worst_ratio": found(&one.ratio),
            })
        });
        json!({
            "compared": total.compared,
            "classes": classes(&total.by_class),
            "not_compared": total.not_compared,
            "judged": total.judged,
            "quantities": quantities.collect::<Vec<_>>(),
        })
    };
    let wrong = wrong(merged).map(|(terrain, part, ray)| {
        json!({
            "terrain": terrain, "part": part,
            "sensor": ray.sensor, "i": ray.i, "j": ray.j,
            "quantity": ray.quantity, "what": ray.what,
            "replay": merged.replay(terrain, part, &probe_words(&ray.sensor, ray.i, ray.j)),
        })
    });
    let faces: Vec<u64> = merged.terrains.iter().map(|terrain| terrain.faces).collect();
    let parts: BTreeMap<&str, Value> = PartName::ALL
        .into_iter()
        .map(|part| (part.word(), of_total(&Total::of(merged, Some(part)))))
        .collect();
    let document = json!({
        "format": FORMAT,
        "version": merged.campaign.version,
        "seed": merged.campaign.seed,
        "terrains": merged.campaign.terrains,
        "faces": { "least": faces.iter().min(), "most": faces.iter().max(), "total": faces.iter().sum::<u64>() },
        "verdict": if merged.passes() { "agree" } else { "defects" },
        "all": of_total(&Total::of(merged, None)),
        "parts": parts,
        "first_wrong": wrong.take(LISTED * 10).collect::<Vec<_>>(),
    });
    format!("{document:#}\n")
}

fn wrong(merged: &Merged) -> impl Iterator<Item = (u64, PartName, &crate::record::WrongRay)> {
    let parts = merged.terrains.iter().flat_map(|of| of.parts.iter().map(|part| (of.terrain, part)));
    parts.flat_map(|(terrain, part)| part.wrong.iter().map(move |ray| (terrain, part.part, ray)))
}

/// The campaign on one screen.
pub fn campaign_screen(merged: &Merged) -> String {
    let mut text = String::new();
    let all = Total::of(merged, None);
    let faces: u64 = merged.terrains.iter().map(|terrain| terrain.faces).sum();
    let _ = writeln!(
        text,
        "raypencil {}: {} terrains of seed {}, {} faces in all\n",
        merged.campaign.version,
        count(merged.campaign.terrains),
        merged.campaign.seed,
        count(faces)
    );
    let of = |by_class: &[u64; 6], class: Class| count(by_class[class as usize]);
    let _ = writeln!(
        text,
        "{:<14}{:>15}{:>15}{:>10}{:>10}{:>10}{:>10}{:>8}",
        "", "compared", "agree", "tie", "rounding", "approx.", "undecided", "defect"
    );
    let mut line = |name: &str, compared: u64, by_class: &[u64; 6]| {
        let _ = writeln!(
            text,
            "{name:<14}{:>15}{:>15}{:>10}{:>10}{:>10}{:>10}{:>8}",
            count(compared),
            of(by_class, Class::Agree),
            of(by_class, Class::Tie),
            of(by_class, Class::Rounding),
            of(by_class, Class::Approximation),
            of(by_class, Class::Undecided),
            of(by_class, Class::Defect)
        );
    };
    for part in PartName::ALL {
        let total = Total::of(merged, Some(part));
        line(part.word(), total.compared, &total.by_class);
    }
    line("all", all.compared, &all.by_class);
    let _ = writeln!(text, "\n{} rays were judged exactly.\n", count(all.judged));
    let _ = writeln!(text, "{:<14}{:>12}{:>10}  where", "", "error", "/bound");
    for (quantity, total) in &all.quantities {
        let (Some(error), Some(ratio)) = (total.error, total.ratio) else { continue };
        let words = |found: Found<'_>| found.worst.value.map_or("NaN".into(), number);
        let _ = writeln!(
            text,
            "{:<14}{:>12}{:>10}  terrain {} {} {} {},{}",
            quantity.to_string(),
            words(error),
            words(ratio),
            ratio.terrain,
            ratio.part.word(),
            ratio.worst.sensor,
            ratio.worst.i,
            ratio.worst.j
        );
    }
    text.push('\n');
    for (terrain, part, ray) in wrong(merged).take(LISTED) {
        let _ = writeln!(
            text,
            "terrain {terrain} {}, {} {},{}, {}: {}",
            part.word(),
            ray.sensor,
            ray.i,
            ray.j,
            ray.quantity,
            ray.what
        );
        let _ =
            writeln!(text, "    {}", merged.replay(terrain, part, &probe_words(&ray.sensor, ray.i, ray.j)));
    }
    let defects = all.by_class[Class::Defect as usize] + all.by_class[Class::Undecided as usize];
    let verdict = if merged.passes() {
        format!("✓ {} rays, no defect, none undecided.", count(all.compared))
    } else {
        format!("✗ {} of {} rays are wrong or undecided.", count(defects), count(all.compared))
    };
    let _ = writeln!(text, "{verdict}");
    text
}

/// Writes `summary.json` into a folder.
///
/// # Errors
/// Names the file or folder that could not be written, and why.
pub fn write_campaign(merged: &Merged, folder: &Path) -> Result<PathBuf, FolderError> {
    let path = begin_output_folder(folder, "summary.json")?;
    raypencil_files::write_atomically(&path, |file| file.write_all(campaign_json(merged).as_bytes()))?;
    Ok(path)
}
