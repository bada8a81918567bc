//! `report.html`: a campaign for people, as one file. Nothing in it depends on time or machine.

use askama::Template;
use raypencil_judge::Class;
use raypencil_report::{count, counted, number, page_head};

use crate::merge::Merged;
use crate::own_scenes::OwnScenes;
use crate::record::{PartName, PartRecord, TerrainRecord, probe_arguments};
use crate::totals::{CampaignTotal, QuantityTotal, WorstRay, wrong_rays};

/// Maximum number of wrong rays that are listed.
const MAX_LISTED_RAYS: usize = 100;

/// Maximum number of terrains that are listed.
const MAX_LISTED_TERRAINS: usize = 30;

/// Names of the classes, in the order of [`Class`].
const CLASSES: [&str; Class::COUNT] = ["agree", "tie", "rounding", "approximation", "undecided", "defect"];

/// CSS that only this page needs. The colours of the classes differ in lightness, too.
const STYLE: &str = "\
.bars { margin: 14px 0 0; } .bar-row { display: grid; grid-template-columns: 70px minmax(0, 1fr); gap: 10px; align-items: center; margin: 4px 0; }
.stack { display: flex; height: 16px; border-radius: 3px; overflow: hidden; background: var(--faint); } .stack i { display: block; }
.bars figcaption { margin: 8px 0 0; font-weight: 400; font-size: 0.86rem; color: var(--soft); } .bars .key { display: inline-flex; margin-right: 10px; }
.class-0 { background: #9aa4b0; } .class-1 { background: #56b4e9; } .class-2 { background: #f0e442; } .class-3 { background: #0072b2; } .class-4 { background: #cc79a7; } .class-5 { background: #d55e00; }
";

#[derive(Template)]
#[template(path = "campaign.html")]
struct Page {
    /// The head of the page, as HTML.
    head: String,
    verdict: &'static str,
    sign: &'static str,
    headline: String,
    explanation: &'static str,
    warnings: Vec<String>,
    terrains: String,
    seed: u64,
    faces: String,
    command: String,
    /// Command of the program under test; empty: the two renderers.
    candidate: String,
    /// Names of one's own scenes; empty: random ones.
    own: String,
    failures: Vec<String>,
    version: String,
    classes: [&'static str; Class::COUNT],
    parts: Vec<PartRow>,
    wrong: Vec<WrongRow>,
    more_wrong: String,
    hardest: Vec<TerrainRow>,
    quantities: Vec<QuantityRow>,
}

struct PartRow {
    name: &'static str,
    compared: String,
    counts: [String; Class::COUNT],
    judged: String,
    shares: Vec<Share>,
    fails: bool,
}

/// Share of a class among the rays that do not agree.
struct Share {
    class: usize,
    percent: String,
}

struct WrongRow {
    terrain: u64,
    part: &'static str,
    place: String,
    quantity: String,
    what: String,
    /// Path of the smallest scene's description and of the whole scene, relative to the page; empty if not there.
    reproducer: String,
    scene: String,
    replay: String,
}

struct TerrainRow {
    terrain: u64,
    faces: String,
    compared: String,
    wrong: String,
    rounding: String,
    tie: String,
    approximation: String,
    ratio: String,
    replay: String,
    fails: bool,
}

struct QuantityRow {
    name: String,
    counts: [String; Class::COUNT],
    error: String,
    ratio: String,
    place: String,
    replay: String,
    fails: bool,
}

/// The contents of `report.html`. `has` tells whether the campaign's folder has a file: after a merge, scenes with a wrong
/// ray are in the folders of the shards.
pub(crate) fn campaign_html(merged: &Merged, has: impl Fn(&str) -> bool) -> Result<String, askama::Error> {
    let all = CampaignTotal::of(merged, None);
    let defects = wrong(&all.by_class);
    let (verdict, sign, headline, explanation) = if merged.passes() {
        let headline = format!("{} rays, no defect, none undecided", count(all.compared));
        let explanation = match merged.campaign.candidate {
            None => "Every ray on which the renderers differ was judged in exact arithmetic.",
            Some(_) => "Every answer of the program under test was compared with the exact one.",
        };
        ("agree", "✓", headline, explanation)
    } else if let (0, Some(_)) = (defects, merged.failures().next()) {
        let headline = "The program under test gave no answer for some scenes".to_string();
        ("defects", "✗", headline, "They are listed below, each with the reason.")
    } else if defects == 0 {
        let headline = format!("Nothing is hit: all {} rays miss the terrain", count(all.compared));
        ("nothing", "?", headline, "Such an agreement proves nothing.")
    } else {
        let headline = format!("{} of {} rays are wrong or undecided", count(defects), count(all.compared));
        ("defects", "✗", headline, "Each is listed below, with the commands that show it again.")
    };
    let linked = |path: String| if has(&path) { path } else { String::new() };
    let listed: Vec<WrongRow> = wrong_rays(merged)
        .take(MAX_LISTED_RAYS)
        .map(|(terrain, part, ray)| WrongRow {
            terrain,
            part: part.word(),
            place: format!("{} {},{}", ray.sensor, ray.i, ray.j),
            quantity: ray.quantity.to_string(),
            what: ray.what.clone(),
            reproducer: linked(format!("wrong/terrain-{terrain:06}-{}-smallest.md", part.word())),
            scene: linked(format!("wrong/terrain-{terrain:06}-{}.toml", part.word())),
            replay: merged.replay_commands(terrain, part, &probe_arguments(&ray.sensor, ray.i, ray.j)),
        })
        .collect();
    let more = defects.saturating_sub(listed.len() as u64);
    let faces: u64 = merged.terrains.iter().map(|terrain| terrain.faces).sum();
    let mut parts: Vec<PartRow> = PartName::ALL
        .into_iter()
        .map(|part| part_row(part.word(), &CampaignTotal::of(merged, Some(part))))
        .collect();
    parts.push(part_row("all", &all));
    let quantities =
        all.quantities.iter().map(|(quantity, total)| quantity_row(merged, quantity.to_string(), total));
    let page = Page {
        head: page_head(&format!("{sign} {headline}"), STYLE),
        verdict,
        sign,
        headline,
        explanation,
        warnings: merged
            .warnings()
            .into_iter()
            .map(|(part, warning)| format!("Warning: scenes {}: {warning}", part.word()))
            .collect(),
        terrains: count(merged.campaign.terrains),
        seed: merged.campaign.seed,
        faces: count(faces),
        command: merged.campaign.command(),
        candidate: merged.campaign.candidate.clone().unwrap_or_default(),
        own: merged.campaign.scenes.as_ref().map_or(String::new(), OwnScenes::names),
        failures: merged
            .failures()
            .take(MAX_LISTED_RAYS)
            .map(|(terrain, part, why)| format!("terrain {terrain} {}: {why}", part.word()))
            .collect(),
        version: merged.campaign.version.clone(),
        classes: CLASSES,
        parts,
        wrong: listed,
        more_wrong: match more {
            0 => String::new(),
            more => format!("{} not listed here.", counted(more, "more ray", "more rays")),
        },
        hardest: hardest(merged),
        quantities: quantities.collect(),
    };
    page.render()
}

/// Rays that are wrong or undecided.
fn wrong(by_class: &[u64; Class::COUNT]) -> u64 {
    by_class[Class::Defect as usize] + by_class[Class::Undecided as usize]
}

fn part_row(name: &'static str, total: &CampaignTotal<'_>) -> PartRow {
    let by_class = total.by_class;
    let others: u64 = by_class[1..].iter().sum();
    let share = |class: usize| Share {
        class,
        percent: format!("{:.2}", 100.0 * by_class[class] as f64 / others as f64),
    };
    PartRow {
        name,
        compared: count(total.compared),
        counts: by_class.map(count),
        judged: count(total.judged),
        shares: (1..Class::COUNT).filter(|class| by_class[*class] > 0).map(share).collect(),
        fails: wrong(&by_class) > 0,
    }
}

fn quantity_row(merged: &Merged, name: String, total: &QuantityTotal<'_>) -> QuantityRow {
    let value = |worst: &Option<WorstRay<'_>>| {
        worst.map_or(String::new(), |worst| worst.record.value.map_or("NaN".into(), number))
    };
    let place = total.worst_ratio.or(total.worst_error);
    QuantityRow {
        name,
        counts: total.by_class.map(count),
        error: value(&total.worst_error),
        ratio: value(&total.worst_ratio),
        place: place.map_or(String::new(), |WorstRay { record, terrain, part }| {
            format!("terrain {terrain} {}, {} {},{}", part.word(), record.sensor, record.i, record.j)
        }),
        replay: place.map_or(String::new(), |WorstRay { record, terrain, part }| {
            merged.replay_commands(terrain, part, &record.probe_arguments())
        }),
        fails: wrong(&total.by_class) > 0,
    }
}

/// What the terrains are sorted by.
fn sums(terrain: &TerrainRecord) -> [u64; Class::COUNT] {
    let mut sums = [0; Class::COUNT];
    for part in &terrain.parts {
        for (sum, count) in sums.iter_mut().zip(part.by_class) {
            *sum += count;
        }
    }
    sums
}

/// The terrains with the most rays that do not simply agree: wrong ones first, then rounding, then ties.
fn hardest(merged: &Merged) -> Vec<TerrainRow> {
    let mut terrains: Vec<(&TerrainRecord, [u64; Class::COUNT])> =
        merged.terrains.iter().map(|terrain| (terrain, sums(terrain))).collect();
    let of = |sums: &[u64; Class::COUNT], class: Class| sums[class as usize];
    // Stable: of equals the first terrain stays first.
    terrains.sort_by_key(|(_, sums)| {
        std::cmp::Reverse([wrong(sums), of(sums, Class::Rounding), of(sums, Class::Tie)])
    });
    let rows = terrains.into_iter().take(MAX_LISTED_TERRAINS).map(|(terrain, sums)| {
        let part = hardest_part(terrain);
        let replay = format!(
            "raypencil campaign replay --seed {} --terrain {} --part {} -o DIR",
            merged.campaign.seed,
            terrain.terrain,
            part.word()
        );
        let ratios = terrain
            .parts
            .iter()
            .flat_map(|part| &part.quantities)
            .filter_map(|quantity| Some(quantity.worst_ratio.as_ref()?.value.unwrap_or(f64::INFINITY)));
        TerrainRow {
            terrain: terrain.terrain,
            faces: count(terrain.faces),
            compared: count(terrain.parts.iter().map(|part| part.compared).sum()),
            wrong: count(wrong(&sums)),
            rounding: count(of(&sums, Class::Rounding)),
            tie: count(of(&sums, Class::Tie)),
            approximation: count(of(&sums, Class::Approximation)),
            ratio: ratios.reduce(f64::max).map_or(String::new(), number),
            replay,
            fails: wrong(&sums) > 0,
        }
    });
    rows.collect()
}

/// The scene of a terrain with the most rays that do not simply agree.
fn hardest_part(terrain: &TerrainRecord) -> PartName {
    let rank = |part: &PartRecord| {
        [wrong(&part.by_class), part.by_class[Class::Rounding as usize], part.by_class[Class::Tie as usize]]
    };
    let mut hardest: Option<&PartRecord> = None;
    for part in &terrain.parts {
        if hardest.is_none_or(|earlier| rank(part) > rank(earlier)) {
            hardest = Some(part);
        }
    }
    hardest.map_or(PartName::Own, |part| part.part)
}
