//! Screen of a drive: what `raypencil drive` prints.

use std::path::Path;

use raypencil_report::time;

use crate::facts::{difference_lines, facts, headline};
use crate::job::DriveJob;
use crate::run::DriveRun;

/// Text of the screen: facts, warnings, times, differences and the verdict. `folder`: where [`crate::write_drive`]
/// wrote the results, if it did.
pub fn drive_screen(job: &DriveJob, run: &DriveRun, folder: Option<&Path>) -> String {
    let mut out =
        facts(job, run).iter().map(|(name, words)| format!("{name:10}{words}\n")).collect::<String>();
    for warning in job.warnings.iter().chain(&run.warnings) {
        out += &format!("\nwarning: {warning}\n");
    }
    out += "\ntime\n";
    for stage in &run.stages {
        out += &format!("  {:44} {:>8}\n", stage.name, time(stage.time));
    }
    let differences = difference_lines(run);
    if !differences.is_empty() {
        out += "\nboth sides\n";
        for line in differences {
            out += &format!("  {line}\n");
        }
    }
    if let Some(folder) = folder {
        out += &format!("\n{}\n", folder.join("report.html").display());
        out += "  beside it: figures (svg, png), drive.png, maps (npy, tif, ply, geojson, csv, nav2), summary.json\n";
    }
    out += &format!("\n{}\n", headline(run));
    out
}
