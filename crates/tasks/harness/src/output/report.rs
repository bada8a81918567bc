//! `report.html`: the validation for people, as one file that links to nothing.

use askama::Template;
use raypencil_cast::{range_picture, top_picture};
use raypencil_judge::{Class, SensorResult, name_of};
use raypencil_report::{
    DefectGroup, DefectLine, MapPair, SensorPlots, VERSION, count, counted, defect_list, list, page_head,
    time,
};
use raypencil_scene::SensorId;
use raypencil_scene_io::{Subject, probe_command, scene_sha256};
use raypencil_survey::{Whereabouts, plan};

use crate::output::candidates::{CandidatesSection, all_misses, candidates_section, typed};
use crate::output::explorer::explorer;
use crate::output::light::{Light, light};
use crate::output::plots::{max_columns, plots};
use crate::output::table::{CauseRow, Row, causes, hits, rows};
use crate::output::verdict::{CAVEAT, Verdict, explanation, headline};
use crate::ray_sets::RaySetResult;
use crate::scoreboard::{CandidateReport, Scoreboard};
use crate::validation::{Pair, Validation};

/// Maximum listed defects per sensor.
const MAX_LISTED: usize = 10;

#[derive(Template)]
#[template(path = "report.html")]
struct Page<'a> {
    /// The head of the page, as HTML.
    head: String,
    verdict: &'static str,
    sign: &'static str,
    headline: String,
    explanation: String,
    caveat: &'static str,
    warnings: Vec<String>,
    scene: &'a str,
    sha256: String,
    source_sha256: &'a str,
    version: &'static str,
    command: String,
    renderers: String,
    /// Lines on the vehicle, the sensors and the terrain.
    stands: Vec<String>,
    /// The plan from above, as SVG.
    plan: String,
    tiles: Vec<Tile>,
    comparisons: Vec<Comparison>,
    causes: Vec<CauseRow>,
    sensors: Vec<Sensor>,
    ray_sets: Vec<RaySet>,
    light: Light,
    candidates: CandidatesSection,
    candidate_plots: Vec<CandidatePlots>,
    /// The lists of defects as HTML.
    defects: String,
    stages: Vec<Timed>,
    /// Data, style and script of the part that answers when asked, as HTML.
    explorer: String,
}

/// A large number with its name.
struct Tile {
    number: String,
    name: &'static str,
    meaning: &'static str,
    bad: bool,
}

/// The tables of a pair of renderers.
struct Comparison {
    title: String,
    all: Vec<Row>,
    sensors: Vec<SensorTable>,
}

struct SensorTable {
    title: String,
    rows: Vec<Row>,
}

/// The pictures and numbers of a sensor.
struct Sensor {
    name: String,
    size: String,
    numbers: Vec<String>,
    note: String,
    /// The pictures as HTML.
    pictures: String,
}

/// A set of rays: what became of them, and its pictures as addresses that hold them.
struct RaySet {
    name: String,
    words: String,
    pictures: Vec<String>,
}

/// The pictures of a candidate, sensor by sensor.
struct CandidatePlots {
    name: String,
    sensors: Vec<Sensor>,
}

/// A stage and its time, also as a percentage of the longest.
struct Timed {
    name: String,
    time: String,
    percent: f64,
}

/// The contents of `report.html`.
pub fn html(validation: &Validation) -> Result<String, askama::Error> {
    let Validation { subject, rendered, pairs, scoreboard, stages, .. } = validation;
    let verdict = Verdict::of(validation);
    let names: Vec<&str> = rendered.iter().map(|rendered| rendered.name.as_str()).collect();
    let longest = stages.iter().map(|stage| stage.time).max().unwrap_or_default().as_secs_f64();
    let max_columns = max_columns(validation);
    let headline = headline(validation);
    let head = page_head(&format!("{} {headline}: {}", verdict.sign(), subject.name), "");
    let mut groups: Vec<DefectGroup> = pairs.iter().flat_map(|pair| defects(validation, pair)).collect();
    groups.extend(all_misses(validation));
    let page = Page {
        head,
        verdict: match verdict {
            Verdict::Agree => "agree",
            Verdict::Defects | Verdict::CandidatesWrong => "defects",
            Verdict::NothingHit | Verdict::NothingCompared => "nothing",
        },
        sign: verdict.sign(),
        headline,
        explanation: explanation(validation),
        caveat: if verdict == Verdict::Agree { CAVEAT } else { "" },
        warnings: validation.warnings.iter().map(ToString::to_string).collect(),
        scene: &subject.name,
        sha256: scene_sha256(&subject.scene),
        source_sha256: &subject.sha256,
        version: VERSION,
        command: format!("raypencil validate {}{}", subject.arguments, typed(validation)),
        renderers: list(&names),
        stands: stands(subject),
        // Within a page SVG needs no name of its namespace, and a page holds no address.
        plan: plan(&subject.scene, subject.vehicle.as_ref())
            .svg()
            .replace(" xmlns=\"http://www.w3.org/2000/svg\"", ""),
        tiles: tiles(validation),
        comparisons: pairs.iter().map(|pair| comparison(validation, pair)).collect(),
        causes: causes(subject, &validation.approximations()),
        sensors: subject
            .scene
            .sensors()
            .map(|id| sensor(validation, id, numbers(validation, id), &plots(validation, id, max_columns)))
            .collect::<Result<_, _>>()?,
        ray_sets: validation.ray_sets.iter().map(|set| ray_set(subject, set)).collect(),
        light: light(validation, max_columns),
        candidates: candidates_section(validation),
        candidate_plots: scoreboard
            .iter()
            .flat_map(|scoreboard| scoreboard.candidates.iter().map(move |report| (scoreboard, report)))
            .map(|(scoreboard, report)| candidate_plots(validation, scoreboard, report, max_columns))
            .collect::<Result<_, _>>()?,
        defects: defect_list(&groups)?,
        stages: stages
            .iter()
            .map(|stage| Timed {
                name: stage.name.clone(),
                time: time(stage.time),
                percent: if longest > 0.0 { 100.0 * stage.time.as_secs_f64() / longest } else { 0.0 },
            })
            .collect(),
        explorer: explorer(validation),
    };
    page.render()
}

fn ray_set(subject: &Subject, result: &RaySetResult) -> RaySet {
    let set = &subject.scene.ray_sets()[result.index];
    let pictures = [range_picture(&result.answers, set), top_picture(&result.answers, set)];
    RaySet {
        name: result.name.clone(),
        words: result.words(),
        pictures: pictures.into_iter().flatten().map(|picture| picture.data_uri()).collect(),
    }
}

fn sensor(
    validation: &Validation,
    id: SensorId,
    numbers: Vec<String>,
    plots: &SensorPlots,
) -> Result<Sensor, askama::Error> {
    let (width, height) = validation.subject.scene.size(id).expect("a sensor of this scene");
    let size = format!("{width} × {height}");
    Ok(Sensor { name: id.to_string(), size, numbers, note: plots.note.clone(), pictures: plots.html()? })
}

/// A candidate's range map of each sensor beside the exact one, and their difference.
fn candidate_plots(
    validation: &Validation,
    scoreboard: &Scoreboard,
    report: &CandidateReport,
    max_columns: u32,
) -> Result<CandidatePlots, askama::Error> {
    let name = report.candidate.name.as_str();
    let scene = &validation.subject.scene;
    let mut sensors = Vec::new();
    for id in scene.sensors() {
        let exact = scoreboard.exact.map(id).range.as_ref().expect("the referee knows every range");
        let mut plots = SensorPlots::new(id, scene.size(id).expect("a sensor of this scene"), max_columns);
        let checked = report.check.sensors.iter().find(|checked| checked.sensor == id);
        let mut numbers: Vec<String> = checked
            .iter()
            .map(|checked| match checked.compared() {
                0 => "not given".into(),
                rays => format!(
                    "{} wrong of {}",
                    count(checked.of(Class::Defect) + checked.of(Class::Undecided)),
                    counted(rays, "ray", "rays")
                ),
            })
            .collect();
        if let Some(range) = &report.candidate.recorded.answers.map(id).range {
            let defects = checked.iter().flat_map(|checked| &checked.defects).map(|defect| defect.place);
            plots.add_ranges(&[("exact", exact), (name, range)]);
            plots.add_difference(MapPair { a: ("exact", exact), b: (name, range) }, None, defects);
        } else {
            numbers.push("range: not given".into());
            plots.add_ranges(&[("exact", exact)]);
        }
        sensors.push(sensor(validation, id, numbers, &plots)?);
    }
    Ok(CandidatePlots { name: name.into(), sensors })
}

/// Where everything stands, a line each.
fn stands(subject: &Subject) -> Vec<String> {
    let found = Whereabouts::of(&subject.scene, subject.vehicle.as_ref());
    let terrain = [found.terrain_line(), found.rounding_line()];
    let file = subject.file_facts.units.as_ref().map(|units| format!("Its file: {}", units.words()));
    [found.vehicle_line()].into_iter().chain(found.lines()).chain(terrain).chain(file).collect()
}

fn tiles(validation: &Validation) -> Vec<Tile> {
    let counts = validation.counts();
    let tile = |number, name, meaning, bad| Tile { number: count(number), name, meaning, bad };
    let mut tiles = vec![
        tile(counts.compared, "compared", "rays: pencils and pixels", counts.compared == 0),
        tile(counts.agree, "agree", "same face or none, values within the bound", false),
        tile(counts.tie, "tie", "several faces at exactly one point", false),
        tile(counts.rounding, "rounding", "exact for a ray displaced within the renderer's precision", false),
        tile(counts.approximation, "approximation", "an error of the paper, its cause confirmed", false),
        tile(counts.defects, "defects", "anything else", counts.defects > 0),
        tile(counts.judged, "judged", "ruled on in exact arithmetic", false),
    ];
    let candidates = validation.candidates();
    if !candidates.is_empty() {
        let wrong = candidates.iter().filter(|report| !report.passes()).count() as u64;
        tiles.push(tile(wrong, "wrong candidates", "of those compared with the exact answers", wrong > 0));
    }
    if counts.not_compared > 0 {
        tiles.push(tile(counts.not_compared, "not compared", "one side has no maps", false));
    }
    tiles
}

fn comparison(validation: &Validation, pair: &Pair) -> Comparison {
    let subject = &validation.subject;
    let sensor_table = |sensor: &SensorResult| SensorTable {
        title: sensor.sensor.to_string(),
        rows: rows(subject, [sensor]),
    };
    Comparison {
        title: title(validation, pair),
        all: rows(subject, &pair.sensors),
        sensors: pair.sensors.iter().map(sensor_table).collect(),
    }
}

fn title(validation: &Validation, pair: &Pair) -> String {
    format!("{} against {}", validation.rendered[pair.a].name, validation.rendered[pair.b].name)
}

/// Hits of each renderer and classes of each pair, for one sensor.
fn numbers(validation: &Validation, sensor: SensorId) -> Vec<String> {
    let mut numbers: Vec<String> = Vec::new();
    for rendered in &validation.rendered {
        numbers.push(match rendered.output.map(sensor).and_then(hits) {
            Some(hits) => format!("{}: {}", rendered.name, counted(hits, "hit", "hits")),
            None => format!("{}: no map", rendered.name),
        });
    }
    for pair in &validation.pairs {
        let Some(found) = pair.sensors.iter().find(|found| found.sensor == sensor) else { continue };
        let of = |class| count(found.of(class));
        numbers.push(format!(
            "{}: {} agree, {} tie, {} rounding, {} approximation, {} defect{}",
            title(validation, pair),
            of(Class::Agree),
            of(Class::Tie),
            of(Class::Rounding),
            of(Class::Approximation),
            of(Class::Defect),
            match found.not_compared {
                0 => String::new(),
                some => format!(", {} not compared", count(some)),
            }
        ));
    }
    numbers
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
