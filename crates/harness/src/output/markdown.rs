//! `summary.md`: the validation in a comment on a change.

use crate::output::panel;
use askama::Template;

use crate::output::VERSION;
use crate::output::table::{CauseRow, Row, causes, hits, rows};
use crate::output::verdict::{CAVEAT, Verdict, defects, explanation, headline};
use crate::validation::Validation;
use raypencil_judge::Class;
use raypencil_report as text;
use raypencil_report::count;
use raypencil_scene_io::probe_command;

/// How many defects are listed.
const LISTED: usize = 10;

#[derive(Template)]
#[template(path = "summary.md")]
struct Page {
    sign: &'static str,
    headline: String,
    explanation: String,
    caveat: &'static str,
    scene: String,
    sha256: String,
    version: &'static str,
    command: String,
    rows: Vec<Row>,
    sensors: Vec<Sensor>,
    causes: Vec<CauseRow>,
    outsiders: Vec<String>,
    defects: Vec<Listed>,
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

struct Listed {
    text: String,
    command: String,
}

/// The whole text.
pub fn markdown(validation: &Validation) -> Result<String, askama::Error> {
    let subject = &validation.subject;
    let verdict = Verdict::of(validation);
    let mut sensors = Vec::new();
    for pair in &validation.pairs {
        let [a, b] = [pair.a, pair.b].map(|index| &validation.rendered[index]);
        for sensor in &pair.sensors {
            let of = |side: &crate::rendered::Rendered| {
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
    let listed: Vec<Listed> = defects(validation)
        .take(LISTED)
        .map(|defect| Listed {
            text: format!("{}, {}: {}", defect.place, defect.item.quantity, defect.what),
            command: code(&probe_command(subject, defect.place)),
        })
        .collect();
    let more = total - total.min(listed.len() as u64);
    let page = Page {
        sign: match verdict {
            Verdict::Agree => "✅",
            Verdict::Defects => "❌",
            Verdict::NothingCompared => "❔",
        },
        headline: headline(validation),
        explanation: explanation(validation),
        caveat: if verdict == Verdict::Agree { CAVEAT } else { "" },
        scene: code(&subject.name),
        sha256: code(&subject.sha256),
        version: VERSION,
        command: code(&format!("raypencil validate {}{}", subject.arguments, panel::typed(validation))),
        rows: rows(subject, validation.pairs.iter().flat_map(|pair| &pair.sensors)),
        sensors,
        causes: causes(subject, &validation.approximations()),
        outsiders: validation.panel.iter().flat_map(panel::lines).map(|line| escaped(&line)).collect(),
        defects: listed,
        more_defects: if more > 0 { text::counted(more, "more is", "more are") } else { String::new() },
        stages: validation
            .stages
            .iter()
            .map(|stage| format!("{} {}", stage.name, text::time(stage.time)))
            .collect(),
    };
    let mut text = page.render()?;
    text.push('\n');
    Ok(text)
}

/// Text that holds no markup: names of programs are anybody's.
fn escaped(text: &str) -> String {
    text.chars()
        .flat_map(|c| {
            let is_markup = c.is_ascii_punctuation() && !",.:;-".contains(c);
            is_markup.then_some('\\').into_iter().chain([if c.is_control() { ' ' } else { c }])
        })
        .collect()
}

/// A code span, fenced wider than any backtick in it.
fn code(text: &str) -> String {
    let longest = text.split(|character| character != '`').map(str::len).max().unwrap_or(0);
    let fence = "`".repeat(longest + 1);
    let pad = if longest > 0 { " " } else { "" };
    format!("{fence}{pad}{}{pad}{fence}", text.replace(['\n', '\r'], " "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn code_spans_hold_backticks() {
        assert_eq!(code("pyramids"), "`pyramids`");
        assert_eq!(code("a`b"), "`` a`b ``");
    }
}
