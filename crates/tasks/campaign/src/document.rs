//! A campaign as the document that every report prints. Nothing in it depends on time or machine.

use raypencil_judge::{COMPARE_CLASSES, Class};
use raypencil_report::{
    Block, Column, DefectGroup, DefectLine, Document, Grid, JunitCase, JunitSuite, Outcome, Room, count,
    counted, number,
};

use crate::merge::Merged;
use crate::own_scenes::OwnScenes;
use crate::reasons::{campaign_reasons, scenes_with_wrong_rays};
use crate::record::{PartName, PartRecord, TerrainRecord, WrongRay, probe_arguments};
use crate::summary::campaign_data;
use crate::totals::{CampaignTotal, QuantityTotal, WorstRay, wrong_rays};

/// Number of the format of `summary.json`. It grows when a key changes its meaning or goes away.
const FORMAT: u32 = 1;

/// Maximum number of wrong rays and of scenes without an answer that a page lists.
const MAX_LISTED_RAYS: usize = 100;

/// The same for a screen.
const MAX_RAYS_ON_SCREEN: usize = 10;

/// Maximum number of terrains that are listed.
const MAX_LISTED_TERRAINS: usize = 30;

/// Maximum number of reasons that are told in words.
const MAX_REASONS: usize = 3;

/// Heads of the columns of classes, in the order of [`COMPARE_CLASSES`].
const CLASSES: [&str; Class::COUNT] = ["agree", "tie", "rounding", "approximation", "undecided", "defect"];

/// What the scenes of a terrain are.
const PARTS: &str = "own: a random rig, or a scene of one's own; both renderers exact. paper: the same, scanline with the paper's \
                     approximations. aimed: narrow beams through vertices, edges and silhouettes. lattice: vertices that lie exactly \
                     on rays, beside random terrains. The referee rules on every ray of aimed and lattice.";

/// What makes a terrain hard.
const HARD: &str = "Hard for a renderer is what is near a decision: edges that rays pass within rounding, corners that several faces \
                    share. The terrains with the most rays that do not simply agree are listed, wrong ones first.";

/// The campaign for every report. `has` tells whether the campaign's folder has a file: after a merge, scenes with a wrong ray are
/// in the folders of the shards.
pub fn campaign_document(merged: &Merged, has: impl Fn(&str) -> bool) -> Document {
    let all = CampaignTotal::of(merged, None);
    let defects = wrong(&all.by_class);
    let faces: u64 = merged.terrains.iter().map(|terrain| terrain.faces).sum();
    let (outcome, headline, explanation) = verdict(merged, &all);
    let mut facts = vec![("Terrains", terrains_words(merged, faces))];
    facts.extend(merged.campaign.candidate.clone().map(|command| ("Under test", command)));
    facts.push(("Again", merged.campaign.command()));
    facts.push(("Records by", format!("raypencil {}", merged.campaign.version)));
    let lines: Vec<DefectLine> =
        wrong_rays(merged).take(MAX_LISTED_RAYS).map(|found| wrong_line(merged, found, &has)).collect();
    let more = defects.saturating_sub(lines.len() as u64);
    let worst = lines.iter().take(MAX_RAYS_ON_SCREEN).cloned().collect();
    let group = DefectGroup {
        title: format!("{} wrong or undecided", counted(defects, "ray", "rays")),
        lines,
        more: match more {
            0 => String::new(),
            more => format!("{} not listed here.", counted(more, "more ray", "more rays")),
        },
    };
    let compared_with = match merged.campaign.candidate {
        None => "The two renderers are compared with each other.",
        Some(_) => "The program under test is compared with the exact answers; paper has no rays for it.",
    };
    let text = |title, lines, room| Block::Text { title, lines, room };
    let question = match &merged.campaign.candidate {
        None => terrains_words(merged, faces),
        Some(command) => format!("{}; under test: {command}", terrains_words(merged, faces)),
    };
    let mut parts = parts_grid();
    for part in PartName::ALL {
        part_row(&mut parts, part.word(), &CampaignTotal::of(merged, Some(part)));
    }
    part_row(&mut parts, "all", &all);
    Document {
        run: merged.campaign.command(),
        question,
        outcome,
        headline,
        remarks: explanation.into_iter().chain(whys(merged)).collect(),
        explanation: Vec::new(),
        counts: Vec::new(),
        facts,
        blocks: vec![
            text("", warnings(merged), Room::Everywhere),
            Block::Table { title: "Rays by class", grid: parts },
            Block::Pictures { title: "Rays that do not simply agree", html: bars(merged), stays: true },
            text("", vec![compared_with.into(), PARTS.into()], Room::Wide),
            text("", vec![format!("{} rays were judged exactly.", count(all.judged))], Room::Screen),
            text("No answer", failures(merged, MAX_LISTED_RAYS), Room::Wide),
            text("No answer", failures(merged, MAX_RAYS_ON_SCREEN), Room::Screen),
            text("", folders(merged, defects), Room::Wide),
            Block::Findings {
                title: "Wrong rays",
                worst,
                groups: if group.lines.is_empty() { Vec::new() } else { vec![group] },
            },
            Block::Table { title: "Every quantity", grid: quantities(merged, &all) },
            Block::Table { title: "Hardest terrains", grid: hardest(merged) },
            text("", vec![HARD.into()], Room::Wide),
        ],
        suites: PartName::ALL.into_iter().map(|part| suite(merged, part)).chain([whole(&all)]).collect(),
        format: FORMAT,
        verdict: match (merged.passes(), outcome) {
            (true, _) => "agree",
            (false, Outcome::Open) if all.compared == 0 => "nothing_compared",
            (false, Outcome::Open) => "nothing_hit",
            (false, _) => "defects",
        },
        data: campaign_data(merged),
        explorer: String::new(),
    }
}

/// The outcome, in one sentence, and what it stands on.
fn verdict(merged: &Merged, all: &CampaignTotal<'_>) -> (Outcome, String, Option<String>) {
    let compared = count(all.compared);
    let defects = wrong(&all.by_class);
    let failures = merged.failures().count() as u64;
    if merged.passes() {
        let explanation = match merged.campaign.candidate {
            None => "Every ray on which the renderers differ was judged in exact arithmetic.",
            Some(_) => "Every answer of the program under test was compared with the exact one.",
        };
        (Outcome::Agrees, format!("{compared} rays, no defect, none undecided."), Some(explanation.into()))
    } else if failures > 0 {
        let have = counted(failures, "scene has", "scenes have");
        let headline =
            format!("{} of {compared} rays are wrong or undecided; {have} no answer.", count(defects));
        (Outcome::Fails, headline, None)
    } else if all.compared == 0 {
        (Outcome::Open, "Nothing is compared.".into(), Some(nothing_compared(merged)))
    } else if defects == 0 {
        let headline = format!("Nothing is hit: all {compared} rays miss the terrain.");
        (Outcome::Open, headline, Some("Such an agreement proves nothing.".into()))
    } else {
        (Outcome::Fails, format!("{} of {compared} rays are wrong or undecided.", count(defects)), None)
    }
}

/// Why no ray was compared, of a campaign in which every scene has its answer.
fn nothing_compared(merged: &Merged) -> String {
    let left_out = merged.terrains.iter().filter(|terrain| terrain.parts.is_empty()).count();
    match merged.campaign.max_faces {
        Some(most) if left_out > 0 => {
            let fewest = merged.terrains.iter().map(|terrain| terrain.faces).min().unwrap_or(0);
            format!(
                "--max-faces {most} leaves out {left_out} of {} terrains; the smallest has {} faces.",
                merged.terrains.len(),
                count(fewest)
            )
        }
        _ => "None of the scenes has a ray to compare.".into(),
    }
}

fn terrains_words(merged: &Merged, faces: u64) -> String {
    let of = match merged.campaign.scenes.as_ref().map(OwnScenes::names) {
        None => format!("of seed {}", merged.campaign.seed),
        Some(names) => format!("of one's own: {names}"),
    };
    format!("{} terrains {of}, {} faces in all", count(merged.campaign.terrains), count(faces))
}

/// Where the scenes of wrong rays lie.
fn folders(merged: &Merged, defects: u64) -> Vec<String> {
    let words = match (defects, &merged.campaign.candidate) {
        (0, _) => return Vec::new(),
        (_, None) => {
            "Each scene with a wrong ray is in the folder wrong of its shard, beside the smallest scene that still shows one."
        }
        (_, Some(_)) => "The most telling ones are packs of single rays in the folder misses of their shard.",
    };
    vec![words.into()]
}

fn warnings(merged: &Merged) -> Vec<String> {
    let warnings = merged.warnings();
    warnings.iter().map(|(part, warning)| format!("Warning: scenes {}: {warning}", part.word())).collect()
}

/// Why the program under test is wrong, in words.
fn whys(merged: &Merged) -> Vec<String> {
    let reasons = campaign_reasons(merged);
    let of = scenes_with_wrong_rays(merged);
    let told = reasons.iter().take(MAX_REASONS).map(|reason| reason.sentence(of));
    let more = reasons.len().saturating_sub(MAX_REASONS);
    let more = (more > 0)
        .then(|| format!("{} in summary.json.", counted(more as u64, "more reason", "more reasons")));
    told.chain(more).collect()
}

fn failures(merged: &Merged, most: usize) -> Vec<String> {
    let words = |(terrain, part, why): (u64, PartName, &str)| {
        format!("terrain {terrain} {}: no answer: {why}", part.word())
    };
    merged.failures().take(most).map(words).collect()
}

/// Rays that are wrong or undecided.
fn wrong(by_class: &[u64; Class::COUNT]) -> u64 {
    by_class[Class::Defect as usize] + by_class[Class::Undecided as usize]
}

fn wrong_line(
    merged: &Merged,
    (terrain, part, ray): (u64, PartName, &WrongRay),
    has: &impl Fn(&str) -> bool,
) -> DefectLine {
    let scene = format!("wrong/terrain-{terrain:06}-{}", part.word());
    let links =
        [("smallest scene", format!("{scene}-smallest.md")), ("whole scene", format!("{scene}.toml"))];
    DefectLine {
        place: format!("terrain {terrain} {}, {} {},{}", part.word(), ray.sensor, ray.i, ray.j),
        quantity: ray.quantity.to_string(),
        words: ray.what.clone(),
        links: links.into_iter().filter(|(_, path)| has(path)).collect(),
        command: merged.replay_commands(terrain, part, &probe_arguments(&ray.sensor, ray.i, ray.j)),
        ..DefectLine::default()
    }
}

fn parts_grid() -> Grid {
    let columns = CLASSES.map(Column::number);
    let first = [Column::text(""), Column::number("compared")];
    Grid::new(first.into_iter().chain(columns).chain([Column::number("judged").wide()]))
}

fn part_row(grid: &mut Grid, name: &str, total: &CampaignTotal<'_>) {
    let counts = COMPARE_CLASSES.map(|class| count(total.by_class[class as usize]));
    let first = [name.to_string(), count(total.compared)];
    grid.row(first.into_iter().chain(counts).chain([count(total.judged)]), wrong(&total.by_class) > 0);
}

/// The share of each class among the rays that do not simply agree, as bars.
fn bars(merged: &Merged) -> String {
    let classes = || COMPARE_CLASSES.into_iter().filter(|class| *class != Class::Agree);
    let bar = |part: PartName| {
        let by_class = CampaignTotal::of(merged, Some(part)).by_class;
        let others: u64 = classes().map(|class| by_class[class as usize]).sum();
        let shares = classes().map(|class| (class as usize, by_class[class as usize]));
        let shares = shares.filter(|(_, rays)| *rays > 0).map(|(class, rays)| {
            let percent = 100.0 * rays as f64 / others as f64;
            format!("<i class=\"class-{class}\" style=\"width:{percent:.2}%\"></i>")
        });
        let shares: String = shares.collect();
        format!(
            "<div class=\"bar-row\"><span>{}</span><div class=\"stack\">{shares}</div></div>\n",
            part.word()
        )
    };
    let key = |class: Class| {
        format!(
            "<span class=\"key\"><b class=\"class-{}\"></b>{}</span> ",
            class as usize, CLASSES[class as usize]
        )
    };
    let bars: String = PartName::ALL.into_iter().map(bar).collect();
    let keys: String = classes().map(key).collect();
    format!(
        "<figure class=\"bars\" aria-hidden=\"true\">\n{bars}<figcaption>{keys}</figcaption>\n</figure>\n"
    )
}

/// Every quantity, with its worst rays.
fn quantities(merged: &Merged, all: &CampaignTotal<'_>) -> Grid {
    let mut grid = Grid::new(
        [Column::text("")]
            .into_iter()
            .chain(CLASSES.map(|head| Column::number(head).wide()))
            .chain([Column::number("error"), Column::number("/bound"), Column::text("where")])
            .chain([Column::code("again").wide()]),
    );
    for (quantity, total) in &all.quantities {
        let QuantityTotal { by_class, worst_error, worst_ratio, .. } = total;
        let value = |worst: &Option<WorstRay<'_>>, of_none: &str| {
            worst.map_or(String::new(), |worst| worst.record.value.map_or(of_none.into(), number))
        };
        // A record keeps no number that is not finite. Such a ratio counts as infinite; an error may also be none.
        let [error, ratio] = [value(worst_error, "not finite"), value(worst_ratio, "infinite")];
        let place = worst_ratio.or(*worst_error);
        let [where_, again] =
            place.map_or([const { String::new() }; 2], |WorstRay { record, terrain, part }| {
                [
                    format!("terrain {terrain} {} {} {},{}", part.word(), record.sensor, record.i, record.j),
                    merged.replay_commands(terrain, part, &record.probe_arguments()),
                ]
            });
        let counts = COMPARE_CLASSES.map(|class| count(by_class[class as usize]));
        let row = [quantity.to_string()].into_iter().chain(counts);
        // On a screen only what has an error to tell.
        let room = if worst_error.is_some() && worst_ratio.is_some() { Room::Everywhere } else { Room::Wide };
        let fails = wrong(by_class) > 0;
        grid.row_with_room(row.chain([error, ratio, where_, again]), fails, room);
    }
    grid
}

/// The terrains with the most rays that do not simply agree.
fn hardest(merged: &Merged) -> Grid {
    let numbers = ["faces", "compared", "wrong", "rounding", "tie", "approximation", "worst error / bound"];
    let columns = [Column::text("terrain")].into_iter().chain(numbers.map(Column::number));
    let mut grid = Grid::new(columns.chain([Column::code("again")]));
    let mut terrains: Vec<(&TerrainRecord, [u64; Class::COUNT])> =
        merged.terrains.iter().map(|terrain| (terrain, sums(terrain))).collect();
    let of = |sums: &[u64; Class::COUNT], class: Class| sums[class as usize];
    // Stable: of equals the first terrain stays first.
    terrains.sort_by_key(|(_, sums)| {
        std::cmp::Reverse([wrong(sums), of(sums, Class::Rounding), of(sums, Class::Tie)])
    });
    for (terrain, sums) in terrains.into_iter().take(MAX_LISTED_TERRAINS) {
        let replay = merged.replay_command(terrain.terrain, hardest_part(terrain));
        let ratios = terrain
            .parts
            .iter()
            .flat_map(|part| &part.quantities)
            .filter_map(|quantity| Some(quantity.worst_ratio.as_ref()?.value.unwrap_or(f64::INFINITY)));
        let row = [
            terrain.terrain.to_string(),
            count(terrain.faces),
            count(terrain.parts.iter().map(|part| part.compared).sum()),
            count(wrong(&sums)),
            count(of(&sums, Class::Rounding)),
            count(of(&sums, Class::Tie)),
            count(of(&sums, Class::Approximation)),
            ratios.reduce(f64::max).map_or(String::new(), number),
            replay,
        ];
        grid.row_with_room(row, wrong(&sums) > 0, Room::Wide);
    }
    grid
}

/// What the terrains are sorted by.
fn sums(terrain: &TerrainRecord) -> [u64; Class::COUNT] {
    std::array::from_fn(|class| terrain.parts.iter().map(|part| part.by_class[class]).sum())
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

/// Test results of the whole: cases that pass because nothing is compared or hit would look like a pass.
fn whole(all: &CampaignTotal<'_>) -> JunitSuite {
    let mut suite = JunitSuite::new("campaign");
    let (compared, hit) = ("something is compared", "something is hit");
    suite.push(match all.compared {
        0 => JunitCase::failed(compared, "nothing_compared", "nothing was compared"),
        _ => JunitCase::passed(compared),
    });
    suite.push(match all.hits {
        0 => JunitCase::failed(hit, "nothing_hit", "no ray hits the terrain"),
        _ => JunitCase::passed(hit),
    });
    suite
}

/// Test results: a suite for each kind of scene, a case for each terrain.
fn suite(merged: &Merged, name: PartName) -> JunitSuite {
    let mut suite = JunitSuite::new(format!("campaign of seed {}: {}", merged.campaign.seed, name.word()));
    let parts = merged.terrains.iter().flat_map(|terrain| {
        terrain.parts.iter().filter(|part| part.part == name).map(move |part| (terrain.terrain, part))
    });
    for (terrain, part) in parts {
        let case = format!("terrain {terrain}");
        let bad = wrong(&part.by_class);
        suite.push(match &part.failed {
            Some(why) => JunitCase::failed(case, "no_answer", why),
            None if bad > 0 => {
                let message =
                    format!("{} of {} rays are wrong or undecided", count(bad), count(part.compared));
                let lines: Vec<String> = part
                    .wrong
                    .iter()
                    .map(|ray| format!("{} {},{}, {}: {}", ray.sensor, ray.i, ray.j, ray.quantity, ray.what))
                    .collect();
                JunitCase::failed(case, "defect", message).with_text(lines.join("\n"))
            }
            None if part.compared == 0 => JunitCase::skipped(case, "nothing was compared"),
            None => JunitCase::passed(case),
        });
    }
    suite
}
