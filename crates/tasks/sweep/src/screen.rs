//! A finished sweep as files, as text for a screen, and as JSON.

use std::path::{Path, PathBuf};

use raypencil_files::{create_folder, write_atomically};
use raypencil_report::{Align, Table, counted, number};
use serde_json::{Value, json};

use crate::chart::Chart;
use crate::error::SweepError;
use crate::plan::{Sweep, Task};
use crate::run::Finished;
use crate::table::SweepTable;
use crate::work::arguments;

/// Maximum number of runs that a screen shows.
const MAX_SHOWN_RUNS: usize = 30;

/// Results that a screen and the default charts show.
fn main_results(task: Task) -> &'static [&'static str] {
    match task {
        Task::Validate => &["compared", "tie", "rounding", "approximation", "undecided", "defects"],
        Task::Render => &["camera.hits", "beam-0.visible_share", "beam-0.lit_pixels", "beam-0.flux_w"],
        Task::Drive => &[
            "truth.found_share",
            "truth.missed_share",
            "truth.false_share",
            "truth.clear_way_mean_m",
            "driven_m",
        ],
    }
}

/// The charts that are drawn without being asked for: the main results against each parameter that has several numbers.
pub fn default_charts(table: &SweepTable, task: Task) -> Vec<Chart> {
    let mut charts = Vec::new();
    // Of a validation there is nothing to draw: it agrees, or its report says where not.
    if task == Task::Validate {
        return charts;
    }
    for parameter in &table.columns[1..=table.parameters] {
        let given = (0..table.runs()).filter(|&run| !parameter.cells.text(run).is_empty());
        let mut values: Vec<Option<f64>> = given.map(|run| parameter.cells.number(run)).collect();
        values.dedup();
        if values.len() < 2 || values.contains(&None) {
            continue;
        }
        for result in main_results(task).iter().take(3) {
            let is_number = |column: &crate::table::Column| {
                (0..table.runs()).any(|run| column.cells.number(run).is_some())
            };
            if table.column(result).is_some_and(is_number) {
                charts.push(Chart {
                    result: result.to_string(),
                    parameter: parameter.name.clone(),
                    lines: None,
                });
            }
        }
    }
    charts
}

/// Files of a sweep.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Written {
    /// The table as CSV and as Parquet.
    pub tables: [PathBuf; 2],
    /// Each chart as SVG and as PNG.
    pub charts: Vec<PathBuf>,
}

/// Writes the table and the charts.
///
/// # Errors
/// A folder or a file that cannot be written; a chart of names that the table does not have.
pub fn write_sweep(table: &SweepTable, charts: &[Chart], folder: &Path) -> Result<Written, SweepError> {
    create_folder(folder)?;
    let tables = [folder.join("table.csv"), folder.join("table.parquet")];
    table.write_csv(&tables[0])?;
    table.write_parquet(&tables[1])?;
    let mut written = Vec::new();
    if !charts.is_empty() {
        create_folder(&folder.join("charts"))?;
    }
    for chart in charts {
        let drawing = chart.draw(table)?;
        let file = |ending: &str| folder.join("charts").join(format!("{}.{ending}", chart.file_stem()));
        write_atomically(file("svg"), |out| out.write_all(drawing.svg().as_bytes()))?;
        write_atomically(file("png"), |out| out.write_all(&drawing.png()))?;
        written.extend([file("svg"), file("png")]);
    }
    Ok(Written { tables, charts: written })
}

/// A finished sweep as text: the main results of the first runs, and what was refused.
pub fn sweep_screen(finished: &Finished, table: &SweepTable, written: &Written) -> String {
    let Sweep { scene, task, renderers, .. } = &finished.sweep;
    let runs = counted(table.runs() as u64, "run", "runs");
    let mut text = format!("{} of {scene} with {}: {runs}\n\n", task.word(), renderers.join(", "));
    let mut shown: Vec<&crate::table::Column> = table.columns[..=table.parameters].iter().collect();
    shown.extend(main_results(*task).iter().filter_map(|name| table.column(name)));
    let mut lines = Table::new(std::iter::repeat_n(Align::Right, shown.len()));
    lines.row(shown.iter().map(|column| column.name.clone()));
    for run in 0..table.runs().min(MAX_SHOWN_RUNS) {
        lines.row(shown.iter().enumerate().map(|(place, column)| match column.cells.number(run) {
            // Parameters stand as they were given.
            Some(value) if place > table.parameters && value.fract() != 0.0 => number(value),
            _ => column.cells.text(run),
        }));
    }
    for line in lines.lines() {
        text += &format!("{line}\n");
    }
    if table.runs() > MAX_SHOWN_RUNS {
        text += &format!("... and {} more in the table\n", table.runs() - MAX_SHOWN_RUNS);
    }
    let refused: Vec<(u64, &str)> = finished.refused().collect();
    if !refused.is_empty() {
        text += &format!("\n{} could not be made:\n", counted(refused.len() as u64, "run", "runs"));
        for (run, why) in refused.iter().take(5) {
            text += &format!("  run {run}: {why}\n");
        }
        if refused.len() > 5 {
            text += "  ... the column `refused` has them all\n";
        }
    }
    text += &format!("\n{}\n", written.tables[0].display());
    let charts = counted(written.charts.len() as u64 / 2, "chart", "charts");
    text += &format!("  beside it: table.parquet, {charts}, a record of each run\n");
    text
}

/// A finished sweep as JSON.
pub fn sweep_json(finished: &Finished, table: &SweepTable, written: &Written) -> String {
    let runs: Vec<Value> = (0..table.runs())
        .map(|run| {
            let settings = finished.sweep.settings(run as u64).unwrap_or_default();
            json!({ "run": run, "arguments": arguments(&finished.sweep.scene, &settings) })
        })
        .collect();
    let refused: Vec<Value> =
        finished.refused().map(|(run, why)| json!({ "run": run, "message": why })).collect();
    let document = json!({
        "task": finished.sweep.task.word(),
        "renderers": finished.sweep.renderers,
        "passes": finished.passes(),
        "runs": runs,
        "refused": refused,
        "tables": written.tables.iter().map(|path| path.display().to_string()).collect::<Vec<_>>(),
        "charts": written.charts.iter().map(|path| path.display().to_string()).collect::<Vec<_>>(),
    });
    format!("{document:#}\n")
}
