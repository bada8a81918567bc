//! `report.html` of a drive: one file that links to nothing.

use askama::Template;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;

use crate::figures::Figure;
use crate::job::DriveJob;
use crate::run::DriveRun;
use crate::screen::{facts, headline};
use raypencil_report::{VERSION, page_head, time};

/// What this page alone needs.
const STYLE: &str = "\
.drawings { display: grid; gap: 20px; grid-template-columns: repeat(auto-fit, minmax(min(100%, 480px), 1fr)); margin-top: 12px; }\n\
.drawings svg, .drawings img { display: block; width: 100%; height: auto; background: #ffffff; border-radius: 6px; }\n\
.drawings figcaption { margin: 6px 0 0; font-weight: 400; }\n\
.moving { image-rendering: pixelated; }\n\
";

#[derive(Template)]
#[template(path = "drive.html")]
struct Page {
    /// The start of the page.
    head: String,
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
    let title = format!("Drive over {}", job.name);
    let page = Page {
        head: page_head(&title, STYLE),
        passes: run.passes(),
        compared: run.trace.is_some(),
        title,
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
