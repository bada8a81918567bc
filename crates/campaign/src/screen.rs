//! A campaign on one terminal screen. Nothing in it depends on time or machine.

use std::fmt::Write as _;

use raypencil_judge::Class;
use raypencil_report::{count, number};

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
    let in_class = |by_class: &[u64; 6], class: Class| count(by_class[class as usize]);
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
            in_class(by_class, Class::Agree),
            in_class(by_class, Class::Tie),
            in_class(by_class, Class::Rounding),
            in_class(by_class, Class::Approximation),
            in_class(by_class, Class::Undecided),
            in_class(by_class, Class::Defect)
        );
    };
    for part in PartName::ALL {
        let total = CampaignTotal::of(merged, Some(part));
        line(part.word(), total.compared, &total.by_class);
    }
    line("all", all.compared, &all.by_class);
    let _ = writeln!(text, "\n{} rays were judged exactly.\n", count(all.judged));
    let _ = writeln!(text, "{:<14}{:>12}{:>10}  where", "", "error", "/bound");
    for (quantity, total) in &all.quantities {
        let (Some(error), Some(ratio)) = (total.worst_error, total.worst_ratio) else { continue };
        let value = |worst: WorstRay<'_>| worst.record.value.map_or("NaN".into(), number);
        let _ = writeln!(
            text,
            "{:<14}{:>12}{:>10}  terrain {} {} {} {},{}",
            quantity.to_string(),
            value(error),
            value(ratio),
            ratio.terrain,
            ratio.part.word(),
            ratio.record.sensor,
            ratio.record.i,
            ratio.record.j
        );
    }
    text.push('\n');
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
    let defects = all.by_class[Class::Defect as usize] + all.by_class[Class::Undecided as usize];
    let verdict = if merged.passes() {
        format!("✓ {} rays, no defect, none undecided.", count(all.compared))
    } else {
        format!("✗ {} of {} rays are wrong or undecided.", count(defects), count(all.compared))
    };
    let _ = writeln!(text, "{verdict}");
    text
}
