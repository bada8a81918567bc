//! A finished sweep as files.

use std::path::Path;

use raypencil_files::{FileError, create_folder, write_atomically, write_texts};

use crate::chart::Chart;
use crate::document::{Drawn, Written, sweep_document};
use crate::error::SweepError;
use crate::plan::Task;
use crate::results::main_results;
use crate::run::Finished;
use crate::table::SweepTable;

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

/// Name of what is printed for programs; it is not written.
const DATA: &str = "summary.json";

/// Writes the table, the charts, and the reports `report.html`, `junit.xml` and `summary.md`.
///
/// # Errors
/// A folder or a file that cannot be written; a chart of names that the table does not have.
pub fn write_sweep(
    finished: &Finished,
    table: &SweepTable,
    charts: &[Chart],
    folder: &Path,
) -> Result<Written, SweepError> {
    // Before anything is written: a chart may be of a name that there is not.
    let drawings: Vec<_> =
        charts.iter().map(|chart| Ok((chart, chart.draw(table)?))).collect::<Result<_, SweepError>>()?;
    create_folder(folder)?;
    let tables = [folder.join("table.csv"), folder.join("table.parquet")];
    table.write_csv(&tables[0])?;
    table.write_parquet(&tables[1])?;
    let mut written = Written { tables, charts: Vec::new() };
    let mut drawn = Vec::new();
    if !charts.is_empty() {
        create_folder(&folder.join("charts"))?;
    }
    for (chart, drawing) in drawings {
        let file = |ending: &str| folder.join("charts").join(format!("{}.{ending}", chart.file_stem()));
        write_atomically(file("svg"), |out| out.write_all(drawing.svg().as_bytes()))?;
        write_atomically(file("png"), |out| out.write_all(&drawing.png()))?;
        written.charts.extend([file("svg"), file("png")]);
        drawn.push(Drawn { name: chart.file_stem(), source: drawing.data_uri() });
    }
    let texts = sweep_document(finished, table, &written, &drawn).files(DATA);
    let texts = texts.map_err(|(name, source)| FileError::io(&folder.join(name), "write", source))?;
    // What programs read is the table; the summary is printed.
    let is_report = |(name, _): &(&str, String)| *name != DATA;
    write_texts(folder, &texts.into_iter().filter(is_report).collect::<Vec<_>>())?;
    Ok(written)
}
