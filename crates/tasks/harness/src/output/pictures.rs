//! The pictures of a validation's page, as HTML.

use raypencil_cast::{range_picture, top_picture};
use raypencil_judge::Class;
use raypencil_report::{MapPair, SensorPlots, count, counted, escaped};
use raypencil_scene::SensorId;
use raypencil_survey::plan;

use crate::output::light::light_section;
use crate::output::plots::{max_columns, plots};
use crate::output::table::{hits, title};
use crate::ray_sets::RaySetResult;
use crate::scoreboard::{CandidateReport, Scoreboard};
use crate::validation::Validation;

/// The sections of a page that show pictures; an empty one is not shown.
#[derive(Debug, Default)]
pub(super) struct Pictures {
    /// The plan from above.
    pub(super) plan: String,
    /// Each candidate's range maps beside the exact ones.
    pub(super) candidates: String,
    /// The renderers' range maps, sensor by sensor.
    pub(super) sensors: String,
    pub(super) ray_sets: String,
    pub(super) light: String,
}

pub(super) fn pictures(validation: &Validation) -> Result<Pictures, askama::Error> {
    let subject = &validation.subject;
    let max_columns = max_columns(validation);
    // Within a page SVG needs no name of its namespace, and a page holds no address.
    let plan = plan(&subject.scene, subject.vehicle.as_ref()).svg();
    let plan = plan.replace(" xmlns=\"http://www.w3.org/2000/svg\"", "");
    let mut sensors = String::new();
    for id in subject.scene.sensors() {
        sensors += &section(validation, id, &numbers(validation, id), &plots(validation, id, max_columns))?;
    }
    let mut candidates = String::new();
    if let Some(scoreboard) = &validation.scoreboard {
        for report in &scoreboard.candidates {
            candidates += &candidate(validation, scoreboard, report, max_columns)?;
        }
    }
    Ok(Pictures {
        plan: format!(
            "<figure class=\"plan\">{plan}<figcaption>The terrain's bounds, the vehicle as an arrow, and what each sensor \
             sees up to its maximum range.</figcaption></figure>\n"
        ),
        candidates,
        sensors,
        ray_sets: validation.ray_sets.iter().map(|set| ray_set(validation, set)).collect(),
        light: light_section(validation, max_columns)?,
    })
}

fn section(
    validation: &Validation,
    id: SensorId,
    numbers: &[String],
    plots: &SensorPlots,
) -> Result<String, askama::Error> {
    let (width, height) = validation.subject.scene.size(id).expect("a sensor of this scene");
    plots.section(&id.to_string(), &format!("{width} × {height}"), &numbers.join(" · "))
}

fn ray_set(validation: &Validation, result: &RaySetResult) -> String {
    let set = &validation.subject.scene.ray_sets()[result.index];
    let name = escaped(&result.name);
    let pictures = [range_picture(&result.answers, set), top_picture(&result.answers, set)];
    let pictures: String = pictures
        .into_iter()
        .flatten()
        .map(|picture| {
            let source = picture.data_uri();
            format!("<figure><img src=\"{source}\" style=\"max-width:100%\" alt=\"rays {name}\"></figure>\n")
        })
        .collect();
    format!("<section class=\"sensor\">\n<h3>{name}</h3>\n{pictures}</section>\n")
}

/// A candidate's range map of each sensor beside the exact one, and their difference.
fn candidate(
    validation: &Validation,
    scoreboard: &Scoreboard,
    report: &CandidateReport,
    max_columns: u32,
) -> Result<String, askama::Error> {
    let name = report.candidate.name.as_str();
    let scene = &validation.subject.scene;
    let mut html = format!("<h3>{}</h3>\n", escaped(name));
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
        html += &section(validation, id, &numbers, &plots)?;
    }
    Ok(html)
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
