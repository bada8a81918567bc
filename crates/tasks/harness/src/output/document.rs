//! A validation as the document that every report prints.

use std::path::Path;

use raypencil_judge::{Class, SensorResult, name_of};
use raypencil_report::{
    Block, Count, DefectGroup, DefectLine, Document, Outcome, Room, count, counted, list,
};
use raypencil_scene_io::{Subject, probe_command, scene_sha256};
use raypencil_survey::Whereabouts;

use crate::output::candidates::{all_misses, grids as candidate_grids, typed};
use crate::output::explorer::explorer;
use crate::output::junit::suites;
use crate::output::pictures::{Pictures, pictures};
use crate::output::reading::HOW_TO_READ;
use crate::output::screen::{Extent, MAX_COLUMNS, ScreenBlocks, screen_blocks};
use crate::output::summary::{FORMAT, summary_keys};
use crate::output::table::{causes, quantities, sensor_by_sensor, sensors, times, title};
use crate::output::verdict::{CAVEAT, Ruled, Verdict};
use crate::validation::{Pair, Validation};

/// Maximum listed defects per sensor.
const MAX_LISTED: usize = 10;

impl Validation {
    /// What was found, as the document that every report prints: without the pictures of its page.
    pub fn document(&self) -> Document {
        document(self, Extent::Whole, Pictures::default(), String::new())
    }

    /// The same with the pictures of its page, and the part that answers when asked. They take seconds.
    ///
    /// # Errors
    /// An error of a template of pictures.
    pub fn document_with_pictures(&self) -> Result<Document, askama::Error> {
        Ok(document(self, Extent::Whole, pictures(self)?, explorer(self)))
    }
}

/// The validation on one terminal screen. `folder` is the folder that [`crate::write_validation`] wrote.
///
/// ```
/// # use std::sync::Arc;
/// # use glam::DVec3;
/// use raypencil_harness::{contender, one_screen, validate};
/// # use raypencil_judge::JudgeShare;
/// # use raypencil_scene::{Atmosphere, FluxModel, Scene, Silent, rig};
/// # use raypencil_scene_io::Subject;
///
/// # let mesh = raypencil_terrain::builtin("pyramids", 0.25).expect("a built-in name").into_mesh()?;
/// # let (camera, beams) = rig::default_rig(64, DVec3::ZERO, 0.0);
/// # let air = Atmosphere { attenuation: 0.0 };
/// # let scene = Scene::new(Arc::new(mesh), camera, beams, air, FluxModel::Radiometric)?;
/// # let subject = Subject {
/// #     scene,
/// #     name: "small".into(),
/// #     arguments: "small.toml".into(),
/// #     sha256: "0".repeat(64),
/// #     vehicle: None,
/// #     file_facts: Default::default(),
/// # };
/// // One renderer alone is no comparison: the screen says so, and it is no pass.
/// let alone = validate(subject, &[contender("tracer").expect("a name")], JudgeShare::Sample, &Silent);
/// let screen = one_screen(&alone, None);
/// assert!(screen.contains("Nothing was compared.") && !alone.passes());
/// // It is one screen of a terminal.
/// assert!(screen.lines().count() <= 40 && screen.lines().all(|line| line.len() <= 80));
/// # Ok::<(), raypencil_scene::SceneError>(())
/// ```
pub fn one_screen(validation: &Validation, folder: Option<&Path>) -> String {
    let extent = Extent::Terminal(folder);
    document(validation, extent, Pictures::default(), String::new()).screen_of_width(MAX_COLUMNS)
}

/// The same text for a file or another program: no line and no list is cut, whatever its length.
pub fn whole_screen(validation: &Validation, folder: Option<&Path>) -> String {
    let extent = folder.map_or(Extent::Whole, Extent::WholeOf);
    document(validation, extent, Pictures::default(), String::new()).screen()
}

/// The document whose screen has that extent.
fn document(validation: &Validation, extent: Extent<'_>, pictures: Pictures, explorer: String) -> Document {
    let Validation { subject, rendered, pairs, stages, .. } = validation;
    let ruled = Ruled::of(validation);
    let names: Vec<&str> = rendered.iter().map(|rendered| rendered.name.as_str()).collect();
    let ScreenBlocks { question, blocks, remarks, worst } = screen_blocks(&ruled, extent);

    let mut groups: Vec<DefectGroup> = pairs.iter().flat_map(|pair| defects(validation, pair)).collect();
    groups.extend(all_misses(validation));
    let page = |title, lines| Block::Text { title, lines, room: Room::Page };
    let wide = |title, lines| Block::Text { title, lines, room: Room::Wide };
    let drawn = |title, html| Block::Pictures { title, html, stays: true };
    let ray_sets = validation.ray_sets.iter().map(|set| format!("Rays {}: {}.", set.name, set.words()));

    let mut blocks = blocks;
    blocks.push(Block::Findings { title: "Defects", groups, worst });
    blocks.push(wide("Warnings", validation.warnings.iter().map(ToString::to_string).collect()));
    blocks.push(page("Where everything stands", stands(subject)));
    blocks.push(drawn("From above", pictures.plan));
    blocks.push(Block::Table { title: "Every quantity", grid: quantities(validation) });
    blocks.push(Block::Folded { title: "Sensor by sensor", grid: sensor_by_sensor(validation) });
    blocks.push(Block::Table { title: "Sensors", grid: sensors(validation) });
    blocks.push(Block::Table { title: "The paper's approximations", grid: causes(validation) });
    blocks.extend(candidate_grids(validation));
    blocks.push(drawn("Candidates beside the exact ranges", pictures.candidates));
    blocks.push(Block::Pictures {
        title: "Range maps and their difference",
        html: pictures.sensors,
        stays: false,
    });
    blocks.push(wide("Sets of rays", ray_sets.collect()));
    blocks.push(drawn("Sets of rays in pictures", pictures.ray_sets));
    blocks.push(drawn("Light", pictures.light));
    blocks.push(Block::Table { title: "Stage times", grid: times(stages) });
    blocks.push(page("How to read this page", HOW_TO_READ.iter().map(ToString::to_string).collect()));

    // A screen has room for the reasons of a verdict that is none.
    let is_open = ruled.verdict.outcome() == Outcome::Open;
    let reasons = if is_open { Vec::new() } else { vec![ruled.explanation.clone()] };
    let caveat = (ruled.verdict == Verdict::Agree).then(|| CAVEAT.to_string());
    Document {
        run: format!("raypencil validate {}", subject.arguments),
        question,
        outcome: ruled.verdict.outcome(),
        headline: format!("{}.", ruled.headline),
        remarks,
        explanation: reasons.into_iter().chain(caveat).collect(),
        counts: counts(&ruled),
        facts: vec![
            ("Scene", subject.name.clone()),
            ("Rendered by", list(&names)),
            ("Scene SHA-256", scene_sha256(&subject.scene)),
            ("Source SHA-256", subject.sha256.clone()),
            ("To run again", format!("raypencil validate {}{}", subject.arguments, typed(validation))),
        ],
        blocks,
        suites: suites(&ruled),
        format: FORMAT,
        verdict: ruled.verdict.key(),
        data: summary_keys(&ruled),
        explorer,
    }
}

/// Where everything stands, a line each.
fn stands(subject: &Subject) -> Vec<String> {
    let found = Whereabouts::of(&subject.scene, subject.vehicle.as_ref());
    let frame =
        "In the global frame: x forward at heading 0, y to the left, z up. Headings turn to the left.";
    let terrain = [found.terrain_line(), found.rounding_line()];
    let file = subject.file_facts.units.as_ref().map(|units| format!("Its file: {}", units.words()));
    let sensors = found.lines();
    [frame.into(), found.vehicle_line()].into_iter().chain(sensors).chain(terrain).chain(file).collect()
}

fn counts(Ruled { validation, counts, .. }: &Ruled<'_>) -> Vec<Count> {
    let one = |number, name, meaning, is_bad| Count { number: count(number), name, meaning, is_bad };
    let mut all = vec![
        one(counts.compared, "compared", "rays: pencils and pixels", counts.compared == 0),
        one(counts.agree, "agree", "same face or none, values within the bound", false),
        one(counts.tie, "tie", "several faces at exactly one point", false),
        one(counts.rounding, "rounding", "exact for a ray displaced within the renderer's precision", false),
        one(counts.approximation, "approximation", "an error of the paper, its cause confirmed", false),
        one(counts.defects, "defects", "anything else", counts.defects > 0),
        one(counts.judged, "judged", "ruled on in exact arithmetic", false),
    ];
    let candidates = validation.candidates();
    if !candidates.is_empty() {
        let wrong = candidates.iter().filter(|report| !report.passes()).count() as u64;
        let name = if wrong == 1 { "wrong candidate" } else { "wrong candidates" };
        all.push(one(wrong, name, "of those compared with the exact answers", wrong > 0));
    }
    if counts.not_compared > 0 {
        all.push(one(counts.not_compared, "not compared", "one side has no maps", false));
    }
    all
}

/// The listed defects of a pair of renderers.
fn defects(validation: &Validation, pair: &Pair) -> Vec<DefectGroup> {
    let of_sensor = |sensor: &SensorResult| {
        let total = sensor.of(Class::Defect);
        let lines: Vec<DefectLine> = sensor
            .listed
            .iter()
            .take(MAX_LISTED)
            .map(|defect| DefectLine {
                place: defect.place.to_string(),
                quantity: name_of(defect.item),
                words: defect.words(),
                what: defect.what.clone(),
                command: probe_command(&validation.subject, defect.place),
                ..DefectLine::default()
            })
            .collect();
        let more = match total - total.min(lines.len() as u64) {
            0 => String::new(),
            more => format!("{} of this sensor not listed here.", counted(more, "more ray", "more rays")),
        };
        let defects = counted(total, "defect", "defects");
        let title = format!("{}, {}: {defects}", sensor.sensor, title(validation, pair));
        (total > 0).then_some(DefectGroup { title, lines, more })
    };
    pair.sensors.iter().filter_map(of_sensor).collect()
}
