//! A finished sweep as the document that every report prints.

use std::path::PathBuf;

use raypencil_report::{
    Block, Column, Document, Grid, JunitCase, JunitSuite, Outcome as Verdict, Room, counted, escaped, number,
};
use serde_json::{Map, Value, json};

use crate::plan::Sweep;
use crate::record::Outcome;
use crate::results::main_results;
use crate::run::Finished;
use crate::table::{Cells, Column as TableColumn, SweepTable};
use crate::work::arguments;

/// Number of the format of what is printed for programs. It grows when a key changes its meaning or goes away.
const FORMAT: u32 = 1;

/// Maximum number of runs that a screen shows.
const MAX_RUNS_ON_SCREEN: usize = 30;

/// Maximum number of runs that a page shows; the table has all.
const MAX_RUNS_ON_PAGE: usize = 500;

/// Maximum number of refused runs that are told with their reason.
const MAX_REFUSED: usize = 5;

/// Files of a sweep.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Written {
    /// The table as CSV and as Parquet.
    pub tables: [PathBuf; 2],
    /// Each chart as SVG and as PNG.
    pub charts: Vec<PathBuf>,
}

/// A chart of a page.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Drawn {
    /// Its name.
    pub name: String,
    /// The picture as a data URI.
    pub source: String,
}

/// A finished sweep: the main results of its runs, what was refused, its charts.
pub fn sweep_document(
    finished: &Finished,
    table: &SweepTable,
    written: &Written,
    drawn: &[Drawn],
) -> Document {
    let Sweep { scene, task, renderers, .. } = &finished.sweep;
    let refused: Vec<(u64, &str)> = finished.refused().collect();
    let runs = counted(table.runs() as u64, "run", "runs");
    let is_other = |outcome: &&Outcome| matches!(outcome, Outcome::Results(_)) && !outcome.passes();
    let disagree = finished.outcomes.iter().filter(is_other).count();
    let (headline, verdict) = match (refused.len(), disagree) {
        (0, 0) => (format!("{runs}, all made."), "made"),
        (0, some) => (format!("{runs}; in {some} of them the renderers disagree."), "defects"),
        (some, 0) => (format!("{some} of {runs} could not be made."), "not_all_made"),
        (some, others) => (
            format!("{some} of {runs} could not be made; in {others} of the others the renderers disagree."),
            "defects",
        ),
    };
    let mut told: Vec<String> = refused
        .iter()
        .take(MAX_REFUSED)
        .map(|(run, why)| format!("run {run} could not be made: {why}"))
        .collect();
    if refused.len() > MAX_REFUSED {
        told.push("... the column `refused` has them all".into());
    }
    let charts = counted(written.charts.len() as u64 / 2, "chart", "charts");
    let files = vec![
        written.tables[0].display().to_string(),
        format!("  beside it: table.parquet, {charts}, report.html, a record of each run"),
    ];
    let more = match table.runs().checked_sub(MAX_RUNS_ON_SCREEN) {
        Some(more @ 1..) => vec![format!("... and {more} more in the table")],
        _ => Vec::new(),
    };
    let more_of_page = match table.runs().checked_sub(MAX_RUNS_ON_PAGE) {
        Some(more @ 1..) => vec![format!("{more} more runs are in the table.")],
        _ => Vec::new(),
    };
    let picture = |chart: &Drawn| {
        let Drawn { name, source } = chart;
        let name = escaped(name);
        format!(
            "<figure><img src=\"{source}\" alt=\"{name}\" style=\"max-width:100%;height:auto\"></figure>\n"
        )
    };
    let text = |lines, room| Block::Text { title: "", lines, room };
    Document {
        run: format!("raypencil sweep {scene}"),
        question: format!("{} of {scene} with {}: {runs}", task.word(), renderers.join(", ")),
        outcome: if finished.passes() { Verdict::Agrees } else { Verdict::Fails },
        headline,
        remarks: Vec::new(),
        explanation: Vec::new(),
        counts: Vec::new(),
        facts: vec![
            ("Scene", scene.clone()),
            ("Task", task.word().to_string()),
            ("Renderers", renderers.join(", ")),
        ],
        blocks: vec![
            Block::Pictures { title: "Charts", html: drawn.iter().map(picture).collect(), stays: true },
            Block::Table { title: "Runs", grid: grid(finished, table) },
            text(more, Room::Screen),
            text(more_of_page, Room::Wide),
            text(told, Room::Everywhere),
            text(files, Room::Screen),
        ],
        suites: vec![suite(finished)],
        format: FORMAT,
        verdict,
        data: data(finished, table, written),
        explorer: String::new(),
    }
}

/// The parameters and the main results of the runs.
fn grid(finished: &Finished, table: &SweepTable) -> Grid {
    let results = main_results(finished.sweep.task).iter().filter_map(|name| table.column(name));
    let shown: Vec<&TableColumn> = table.columns[..=table.parameters].iter().chain(results).collect();
    let mut grid = Grid::new(shown.iter().map(|column| match column.cells {
        Cells::Texts(_) => Column::text(column.name.clone()),
        _ => Column::number(column.name.clone()),
    }));
    for (run, outcome) in finished.outcomes.iter().enumerate().take(MAX_RUNS_ON_PAGE) {
        let cell = |(place, column): (usize, &&TableColumn)| match column.cells.number(run) {
            // Parameters stand as they were given.
            Some(value) if place > table.parameters && value.fract() != 0.0 => number(value),
            _ => column.cells.text(run),
        };
        let room = if run < MAX_RUNS_ON_SCREEN { Room::Everywhere } else { Room::Wide };
        grid.row_with_room(shown.iter().enumerate().map(cell), !outcome.passes(), room);
    }
    grid
}

/// Test results: a case for each run.
fn suite(finished: &Finished) -> JunitSuite {
    let mut suite = JunitSuite::new(format!("sweep of {}", finished.sweep.scene));
    for (run, outcome) in finished.outcomes.iter().enumerate() {
        let settings = finished.sweep.settings(run as u64).unwrap_or_default();
        let settings: Vec<String> = settings.iter().map(ToString::to_string).collect();
        let name = format!("run {run}: {}", settings.join(", "));
        suite.push(match outcome {
            Outcome::Refused(why) => JunitCase::failed(name, "refused", why),
            Outcome::Results(_) if outcome.passes() => JunitCase::passed(name),
            Outcome::Results(_) => JunitCase::failed(name, "defect", "the renderers disagree"),
        });
    }
    suite
}

/// What is printed for programs.
fn data(finished: &Finished, table: &SweepTable, written: &Written) -> Map<String, Value> {
    let runs: Vec<Value> = (0..table.runs())
        .map(|run| {
            let settings = finished.sweep.settings(run as u64).unwrap_or_default();
            json!({ "run": run, "arguments": arguments(&finished.sweep.scene, &settings) })
        })
        .collect();
    let refused: Vec<Value> =
        finished.refused().map(|(run, why)| json!({ "run": run, "message": why })).collect();
    let keys = json!({
        "task": finished.sweep.task.word(),
        "renderers": finished.sweep.renderers,
        "passes": finished.passes(),
        "runs": runs,
        "refused": refused,
        "tables": written.tables.iter().map(|path| path.display().to_string()).collect::<Vec<_>>(),
        "charts": written.charts.iter().map(|path| path.display().to_string()).collect::<Vec<_>>(),
    });
    match keys {
        Value::Object(keys) => keys,
        _ => Map::new(),
    }
}
