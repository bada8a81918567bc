//! HTML report of a drive: one file without links to others.

use askama::Template;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use raypencil_report::{VERSION, page_head, time};

use crate::explorer::explorer;
use crate::facts::{difference_lines, facts, headline};
use crate::figures::Figure;
use crate::job::DriveJob;
use crate::run::DriveRun;

/// Style rules of this page, beside those of all pages.
const STYLE: &str = "\
.drawings { display: grid; gap: 20px; grid-template-columns: repeat(auto-fit, minmax(min(100%, 480px), 1fr)); \
margin-top: 12px; }\n\
.drawings svg, .drawings img { display: block; width: 100%; height: auto; background: #ffffff; border-radius: 6px; }\n\
.drawings figcaption { margin: 6px 0 0; font-weight: 400; }\n\
.moving { image-rendering: pixelated; }\n\
";

#[derive(Template)]
#[template(path = "drive.html")]
struct Page {
    /// HTML up to the page's first heading.
    head: String,
    passes: bool,
    compared: bool,
    title: String,
    headline: String,
    facts: Vec<(&'static str, String)>,
    warnings: Vec<String>,
    differences: Vec<String>,
    /// A line for each sensor at the start.
    stands: Vec<String>,
    /// The plan from above at the start, as SVG.
    plan: String,
    /// Captions and SVG texts.
    figures: Vec<(String, String)>,
    /// Data URL of the animation.
    animation: String,
    stages: Vec<(String, String)>,
    command: String,
    version: &'static str,
    /// Data, style and script of the part that answers when asked, as HTML.
    explorer: String,
}

/// HTML of the report. `animation` are the bytes of the APNG.
///
/// # Errors
/// A template that cannot be rendered.
pub(crate) fn html(
    job: &DriveJob,
    run: &DriveRun,
    figures: &[Figure],
    animation: &[u8],
) -> Result<String, askama::Error> {
    let title = format!("Drive over {}", job.name);
    let page = Page {
        head: page_head(&title, STYLE),
        passes: run.passes(),
        compared: run.differences.is_some(),
        title,
        headline: headline(run),
        facts: facts(job, run),
        warnings: job.warnings.iter().chain(&run.warnings).map(ToString::to_string).collect(),
        differences: difference_lines(run),
        stands: run.whereabouts.lines(),
        plan: run.plan.svg(),
        figures: figures.iter().map(|figure| (figure.caption.clone(), figure.drawing.svg())).collect(),
        animation: format!("data:image/png;base64,{}", STANDARD.encode(animation)),
        stages: run.stages.iter().map(|stage| (stage.name.clone(), time(stage.time))).collect(),
        command: format!("raypencil drive {}", job.arguments),
        version: VERSION,
        explorer: explorer(job, run),
    };
    page.render()
}
