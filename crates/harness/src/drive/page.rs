//! `report.html` of a drive: one file that links to nothing.

use askama::Template;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;

use super::figures::Figure;
use super::job::DriveJob;
use super::run::DriveRun;
use super::screen::{facts, headline};
use crate::output::VERSION;
use crate::output::text::time;

#[derive(Template)]
#[template(path = "drive.html")]
struct Page {
    passes: bool,
    compared: bool,
    title: String,
    headline: String,
    facts: Vec<(&'static str, String)>,
    warnings: Vec<String>,
    trace: Vec<String>,
    figures: Vec<(String, String)>,
    moving: String,
    stages: Vec<(String, String)>,
    command: String,
    version: &'static str,
}

pub(super) fn html(
    job: &DriveJob,
    run: &DriveRun,
    figures: &[Figure],
    moving: &[u8],
) -> Result<String, askama::Error> {
    let page = Page {
        passes: run.passes(),
        compared: run.trace.is_some(),
        title: format!("Drive over {}", job.name),
        headline: headline(run),
        facts: facts(job, run),
        warnings: job.warnings.clone(),
        trace: run.trace_lines(),
        figures: figures.iter().map(|figure| (figure.caption.clone(), figure.drawing.svg())).collect(),
        moving: format!("data:image/png;base64,{}", STANDARD.encode(moving)),
        stages: run.stages.iter().map(|stage| (stage.name.clone(), time(stage.time))).collect(),
        command: format!("raypencil drive {}", job.arguments),
        version: VERSION,
    };
    page.render()
}
