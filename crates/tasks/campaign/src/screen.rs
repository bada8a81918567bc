//! A campaign on one terminal screen. Nothing in it depends on time or machine.

use std::fmt::Write as _;

use raypencil_judge::Class;
use raypencil_report::{Align, Table, count, number};

use crate::merge::Merged;
use crate::record::{PartName, probe_arguments};
use crate::totals::{CampaignTotal, WorstRay, wrong_rays};

/// Maximum number of wrong rays that are listed.
const MAX_LISTED_RAYS: usize = 10;

/// The screen: counts by scene and class, the worst error of each quantity, the first wrong rays, and the verdict.
pub fn campaign_screen(merged: &Merged) -> String {
    let mut text = String::new();
    let all = CampaignTotal::of(merged, None);
    let faces: u64 = merged.terrains.iter().map(|terrain| terrain.faces).sum();
    let _ = writeln!(
        text,
        "raypencil {}: {} terrains of seed {}, {} faces in all\n",
        merged.campaign.version,
        count(merged.campaign.terrains),
        merged.campaign.seed,
        count(faces)
    );
    if let Some(command) = &merged.campaign.candidate {
        let _ = writeln!(text, "under test: {command}\n");
    }
    let mut table = Table::new([Align::Left].into_iter().chain([Align::Right; 7]))
        .with_gap(0)
        .with_min_widths([14, 15, 15, 10, 10, 10, 10, 8]);
    table.row(["", "compared", "agree", "tie", "rounding", "approx.", "undecided", "defect"]);
    let mut line = |name: &str, compared: u64, by_class: &[u64; 6]| {
        let classes = [
            Class::Agree,
            Class::Tie,
            Class::Rounding,
            Class::Approximation,
            Class::Undecided,
            Class::Defect,
        ];
        let counts = classes.map(|class| count(by_class[class as usize]));
        table.row([name.to_string(), count(compared)].into_iter().chain(counts));
    };
    for part in PartName::ALL {
        let total = CampaignTotal::of(merged, Some(part));
        line(part.word(), total.compared, &total.by_class);
    }
    line("all", all.compared, &all.by_class);
    let _ = writeln!(text, "{table}\n{} rays were judged exactly.\n", count(all.judged));
    let columns = [Align::Left, Align::Right, Align::Right, Align::Left];
    let mut table = Table::new(columns).with_gap(0).with_min_widths([14, 12, 10, 0]);
    table.row(["", "error", "/bound", "  where"]);
    for (quantity, total) in &all.quantities {
        let (Some(error), Some(ratio)) = (total.worst_error, total.worst_ratio) else { continue };
        let value = |worst: WorstRay<'_>| worst.record.value.map_or("NaN".into(), number);
        let WorstRay { terrain, part, record } = ratio;
        let place = format!("{} {},{}", record.sensor, record.i, record.j);
        let place = format!("  terrain {terrain} {} {place}", part.word());
        table.row([quantity.to_string(), value(error), value(ratio), place]);
    }
    let _ = writeln!(text, "{table}");
    for (terrain, part, ray) in wrong_rays(merged).take(MAX_LISTED_RAYS) {
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
        let _ = writeln!(
            text,
            "    {}",
            merged.replay_commands(terrain, part, &probe_arguments(&ray.sensor, ray.i, ray.j))
        );
    }
    let failures: Vec<_> = merged.failures().collect();
    for (terrain, part, why) in failures.iter().take(MAX_LISTED_RAYS) {
        let _ = writeln!(text, "terrain {terrain} {}: no answer: {why}", part.word());
    }
    for (part, warning) in merged.warnings() {
        let _ = writeln!(text, "warning: scenes `{}`: {warning}", part.word());
    }
    let defects = all.by_class[Class::Defect as usize] + all.by_class[Class::Undecided as usize];
    let verdict = if merged.passes() {
        format!("✓ {} rays, no defect, none undecided.", count(all.compared))
    } else if !failures.is_empty() {
        format!(
            "✗ {} of {} rays are wrong or undecided; {} scenes have no answer.",
            count(defects),
            count(all.compared),
            count(failures.len() as u64)
        )
    } else if defects == 0 && all.compared > 0 {
        format!("? Nothing is hit: all {} rays miss the terrain.", count(all.compared))
    } else {
        format!("✗ {} of {} rays are wrong or undecided.", count(defects), count(all.compared))
    };
    let _ = writeln!(text, "{verdict}");
    text
}
