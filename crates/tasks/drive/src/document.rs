//! A drive as the document that every report prints.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use raypencil_report::{Block, Column, Document, Grid, JunitCase, JunitSuite, Outcome, Room, escaped, time};

use crate::explorer::explorer;
use crate::facts::{difference_lines, facts, headline};
use crate::figures::Figure;
use crate::job::DriveJob;
use crate::run::DriveRun;
use crate::summary::drive_data;

/// Caption of the plan.
const PLAN: &str = "The start from above: the terrain's bounds, the vehicle as an arrow, and what each sensor sees up to its maximum range.";

/// Caption of the animation.
const ANIMATION: &str = "The drive. Left: the camera's view with the edge points of the stripes. Right: the local terrain map from \
                         above, x to the right, y upwards, with the vehicle in the middle; dark is low, bright is high.";

/// What lies beside the page.
const BESIDE: &str = "Lengths are metres of the global frame, z up. Beside this page: the figures as SVG and PNG, the local map as NPY \
                      and GeoTIFF, the obstacle map for Nav2, the navigator map as GeoJSON and CSV, the edge points as PLY, the \
                      camera's calibration for ROS, and summary.json for programs.";

/// The drive for a screen and for programs.
pub fn drive_document(job: &DriveJob, run: &DriveRun) -> Document {
    let mut told = Grid::new([Column::text(""), Column::text("")]);
    facts(job, run).into_iter().for_each(|(name, words)| told.row([name.to_string(), words], false));
    let mut stages = Grid::new([Column::text("time"), Column::number("")]);
    run.stages.iter().for_each(|stage| stages.row([stage.name.clone(), time(stage.time)], false));
    let warnings = job.warnings.iter().chain(&run.warnings).map(|warning| format!("Warning: {warning}"));
    let text = |title, lines, room| Block::Text { title, lines, room };
    Document {
        run: format!("raypencil drive {}", job.arguments),
        question: format!("drive over {}", job.name),
        outcome: match (&run.differences, run.passes()) {
            (None, _) => Outcome::Told,
            (Some(_), true) => Outcome::Agrees,
            (Some(_), false) => Outcome::Fails,
        },
        headline: headline(run),
        remarks: Vec::new(),
        explanation: Vec::new(),
        counts: Vec::new(),
        facts: vec![("Command", format!("raypencil drive {}", job.arguments))],
        blocks: vec![
            Block::Table { title: "The drive", grid: told },
            text("", warnings.collect(), Room::Everywhere),
            Block::Table { title: "Time", grid: stages },
            text("Two sides", two_sides(run), Room::Everywhere),
            text("Where everything stands at the start", run.whereabouts.lines(), Room::Wide),
        ],
        suites: vec![suite(job, run)],
        format: 3,
        verdict: match (&run.differences, run.passes()) {
            (None, _) => "driven",
            (Some(_), true) => "identical",
            (Some(_), false) => "differs",
        },
        data: drive_data(job, run),
        explorer: String::new(),
    }
}

/// Summary of a drive as JSON text. The keys tell the units.
///
/// ```
/// use raypencil_drive::{DriveJob, drive, drive_json};
/// use raypencil_scanline::Scanline;
/// use raypencil_scene::Silent;
/// use raypencil_scene_io::load_text;
///
/// let scene = "version = 1
///     camera = { width_px = 96, height_px = 96, pixel_pitch_um = 96 }
///     beam = [{ rows = 2 }]
///     terrain = { builtin = 'pyramids' }
///     drive = { waypoints_m = [[0.2, 0]], frames_per_s = 3, scans = false }";
/// let job = DriveJob::new(&load_text(scene, "small")?, None, "small.toml".into())?;
/// let run = drive(&job, &[&Scanline::default()], &Silent)?;
/// let summary: serde_json::Value = serde_json::from_str(&drive_json(&job, &run))?;
/// // 0.2 m at 0.3 m/s take 2/3 s: 3 frames at 3 per second. With one renderer there is nothing to differ from.
/// assert_eq!(summary["frames"], 3);
/// assert_eq!(summary["differences"], serde_json::Value::Null);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn drive_json(job: &DriveJob, run: &DriveRun) -> String {
    drive_document(job, run).json()
}

/// The same with the figures of its page, the bytes of the animation (APNG), and the part that answers when asked.
pub(crate) fn drive_document_with_pictures(
    job: &DriveJob,
    run: &DriveRun,
    figures: &[Figure],
    animation: &[u8],
) -> Document {
    let mut document = drive_document(job, run);
    let figure = |drawing: &str, caption: &str| {
        format!("<figure>{drawing}<figcaption>{caption}</figcaption></figure>\n")
    };
    let mut html = figure(&run.plan.svg(), PLAN);
    figures.iter().for_each(|one| html += &figure(&one.drawing.svg(), &escaped(&one.caption)));
    let animation = STANDARD.encode(animation);
    let moving = format!(
        "<img class=\"moving\" src=\"data:image/png;base64,{animation}\" width=\"512\" height=\"256\" alt=\"The drive as an animation\">"
    );
    html += &figure(&moving, ANIMATION);
    let html = format!("<div class=\"drawings\">\n{html}</div>\n");
    document.blocks.push(Block::Pictures { title: "Figures", html, stays: true });
    document.blocks.push(Block::Text { title: "", lines: vec![BESIDE.into()], room: Room::Wide });
    document.explorer = explorer(job, run);
    document
}

/// The differences of two sides, below a line that says so.
fn two_sides(run: &DriveRun) -> Vec<String> {
    let lines = difference_lines(run);
    let head = (!lines.is_empty()).then(|| "Both sides:".to_string());
    head.into_iter().chain(lines).collect()
}

/// Test results: a case for each stage of two sides; of one side that it was driven.
fn suite(job: &DriveJob, run: &DriveRun) -> JunitSuite {
    let mut suite = JunitSuite::new(format!("drive over {}", job.name));
    match &run.differences {
        None => suite.push(JunitCase::passed("driven")),
        Some(differences) => {
            for (name, stage) in differences.stages() {
                let first = stage.first.as_deref().unwrap_or_default();
                suite.push(match stage.differ {
                    0 => JunitCase::passed(name),
                    differ => JunitCase::failed(
                        name,
                        "difference",
                        format!("{differ} of {} differ", stage.compared),
                    )
                    .with_text(first),
                });
            }
        }
    }
    suite
}
