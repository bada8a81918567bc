//! `summary.md`: the validation as a comment on a pull request.

use askama::Template;
use raypencil_judge::{Class, ListedDefect};
use raypencil_report::{VERSION, count, counted, markdown_code as code, markdown_text as escaped, time};
use raypencil_scene_io::{probe_command, scene_sha256};

use crate::output::candidates::{self, Cell, candidates_section};
use crate::output::table::{CauseRow, Row, causes, hits, rows};
use crate::output::verdict::{CAVEAT, Verdict, defects, explanation, headline, told};
use crate::rendered::Rendered;
use crate::validation::Validation;

/// Maximum listed defects.
const MAX_LISTED: usize = 10;

#[derive(Template)]
#[template(path = "summary.md")]
struct Page {
    sign: &'static str,
    headline: String,
    explanation: String,
    caveat: &'static str,
    warnings: Vec<String>,
    scene: String,
    sha256: String,
    version: &'static str,
    command: String,
    rows: Vec<Row>,
    sensors: Vec<Sensor>,
    ray_sets: Vec<String>,
    causes: Vec<CauseRow>,
    candidates: Vec<String>,
    panel_names: Vec<String>,
    panel: Vec<PanelRow>,
    defects: Vec<Listed>,
    misses: Vec<Listed>,
    more_defects: String,
    stages: Vec<String>,
}

struct Sensor {
    name: String,
    pair: String,
    compared: String,
    hits: String,
    agree: String,
    tie: String,
    rounding: String,
    approximation: String,
    defects: String,
}

/// One quantity: a cell for each renderer and candidate.
struct PanelRow {
    quantity: String,
    cells: Vec<String>,
}

struct Listed {
    text: String,
    command: String,
}

/// The contents of `summary.md`.
pub fn markdown(validation: &Validation) -> Result<String, askama::Error> {
    let subject = &validation.subject;
    let verdict = Verdict::of(validation);
    let mut sensors = Vec::new();
    for pair in &validation.pairs {
        let [a, b] = [pair.a, pair.b].map(|index| &validation.rendered[index]);
        for sensor in &pair.sensors {
            let of = |side: &Rendered| {
                side.output.map(sensor.sensor).and_then(hits).map_or("unknown".into(), count)
            };
            sensors.push(Sensor {
                name: sensor.sensor.to_string(),
                pair: format!("{} against {}", a.name, b.name),
                compared: count(sensor.compared()),
                hits: format!("{} / {}", of(a), of(b)),
                agree: count(sensor.of(Class::Agree)),
                tie: count(sensor.of(Class::Tie)),
                rounding: count(sensor.of(Class::Rounding)),
                approximation: count(sensor.of(Class::Approximation)),
                defects: count(sensor.of(Class::Defect)),
            });
        }
    }
    let total = validation.counts().defects;
    let listed_as = |who: String, defect: &ListedDefect| Listed {
        text: escaped(&format!("{who}{}", told(defect))),
        command: code(&probe_command(subject, defect.place)),
    };
    let listed: Vec<Listed> = defects(validation)
        .into_iter()
        .take(MAX_LISTED)
        .map(|defect| listed_as(String::new(), defect))
        .collect();
    let misses = validation.candidates().iter().flat_map(|report| {
        let name = format!("{}: ", report.candidate.name);
        report.misses().take(MAX_LISTED).map(move |miss| listed_as(name.clone(), miss))
    });
    let section = candidates_section(validation);
    let panel = section.rows.iter().map(|row| PanelRow {
        quantity: row.quantity.clone(),
        cells: row.cells.iter().map(Cell::words).collect(),
    });
    let more = total - total.min(listed.len() as u64);
    let page = Page {
        sign: match verdict {
            Verdict::Agree => "✅",
            Verdict::Defects | Verdict::CandidatesWrong => "❌",
            Verdict::NothingHit | Verdict::NothingCompared => "❔",
        },
        headline: escaped(&headline(validation)),
        explanation: escaped(&explanation(validation)),
        caveat: if verdict == Verdict::Agree { CAVEAT } else { "" },
        warnings: validation.warnings.iter().map(|warning| escaped(&warning.to_string())).collect(),
        scene: code(&subject.name),
        sha256: code(&scene_sha256(&subject.scene)),
        version: VERSION,
        command: code(&format!("raypencil validate {}{}", subject.arguments, candidates::typed(validation))),
        rows: rows(subject, validation.pairs.iter().flat_map(|pair| &pair.sensors)),
        sensors,
        ray_sets: validation
            .ray_sets
            .iter()
            .map(|set| format!("Rays {}: {}.", set.name, set.words()))
            .collect(),
        causes: causes(subject, &validation.approximations()),
        candidates: validation.candidates().iter().map(|report| escaped(&candidates::line(report))).collect(),
        panel_names: section.names.iter().map(|name| escaped(name)).collect(),
        panel: panel.collect(),
        defects: listed,
        misses: misses.collect(),
        more_defects: if more > 0 { counted(more, "more is", "more are") } else { String::new() },
        stages: validation
            .stages
            .iter()
            .map(|stage| format!("{} {}", stage.name, time(stage.time)))
            .collect(),
    };
    let mut text = page.render()?;
    text.push('\n');
    Ok(text)
}
