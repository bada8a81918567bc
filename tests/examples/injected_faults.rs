//! Detects every injected fault, and minimises the scene that reveals it.
//!
//! Writes the page `docs/evidence/injected-faults.md` to standard output, and times to standard error. With a folder as
//! its argument it also writes the smallest scenes there.
//!
//! ```sh
//! cargo run --release -p raypencil-tests --features examples --example injected_faults > docs/evidence/injected-faults.md
//! ```

use std::path::Path;
use std::time::Instant;

use raypencil::harness::{Reproducer, write_reproducer};
use raypencil::io::FileError;
use raypencil_tests::injected_faults::detection::{Detection, detect, detect_file};
use raypencil_tests::injected_faults::files::FileFault;
use raypencil_tests::naive::{Fault, FaultKind};

const HEAD: &str = "\
# Injected faults

This page measures whether a comparison finds an error. Each fault is injected into a third, naive renderer
([`crates/engines/naive`](../../crates/engines/naive/src/lib.rs)), or into the files of a correct one
([`tests/src/injected_faults`](../../tests/src/injected_faults/mod.rs)). The scenes of its kind are compared one after
the other until a ray reveals the fault. `just injected-faults` writes this page.

* *Imitates* is the real mistake behind the fault.
* *Caught by* is the first scene that reveals it, the first wrong ray, the quantity with the largest error, and its
  class.
* *Rays* is the number of rays compared up to that ray, those of earlier scenes included.
* *Faces* is the number of faces of the smallest scene that still reveals the fault, out of the faces of the first one.
  Without the fault this scene shows no defect. The search is delta debugging: it ends when no face can be left out.
";

/// A row of the table.
struct Row {
    kind: FaultKind,
    name: String,
    imitates: &'static str,
    detection: Option<Detection>,
}

fn main() -> Result<(), FileError> {
    let mut rows = Vec::new();
    let mut slowest = (0.0, String::new());
    let mut time = |name: &str, detect: &dyn Fn() -> Option<Detection>| {
        let start = Instant::now();
        let detection = detect();
        let seconds = start.elapsed().as_secs_f64();
        let calls = detection.as_ref().map_or(0, |detection| detection.smallest.calls);
        eprintln!("{name}: {seconds:.2} s, {calls} trials");
        if seconds > slowest.0 {
            slowest = (seconds, name.into());
        }
        detection
    };
    for &fault in Fault::ALL {
        let name = format!("{fault:?}");
        let detection = time(&name, &|| detect(fault));
        rows.push(Row { kind: fault.kind(), name, imitates: fault.imitates(), detection });
    }
    for fault in FileFault::ALL {
        let name = format!("{fault:?}");
        let detection = time(&name, &|| detect_file(fault));
        rows.push(Row { kind: FaultKind::Files, name, imitates: fault.imitates(), detection });
    }
    eprintln!("slowest: {}, {:.2} s", slowest.1, slowest.0);
    print!("{}", page(&rows));
    match std::env::args_os().nth(1) {
        Some(folder) => rows.iter().try_for_each(|row| write(row, Path::new(&folder))),
        None => Ok(()),
    }
}

/// Writes the smallest scene to a folder.
fn write(row: &Row, folder: &Path) -> Result<(), FileError> {
    let Some(detection) = &row.detection else { return Ok(()) };
    let name = format!("{}-{}", row.kind.to_string().replace(' ', "-"), row.name);
    let what = format!("An injected fault, {}.", row.imitates);
    // No renderer of the command line has the fault: they show the correct result.
    write_reproducer(folder, &detection.smallest, Reproducer { name: &name, what: &what, with: "" }).map(drop)
}

fn page(rows: &[Row]) -> String {
    let mut text = String::from(HEAD);
    for kind in FaultKind::ALL {
        text += &format!("\n## {}\n\n", capitalised(&kind.to_string()));
        text += "| fault | imitates | caught by | rays | faces |\n| --- | --- | --- | ---: | ---: |\n";
        for row in rows.iter().filter(|row| row.kind == kind) {
            text += &row_of(row);
        }
    }
    text += "\n## Totals\n\n| kind | faults | caught | median rays | median faces |\n| --- | ---: | ---: | ---: | ---: |\n";
    for kind in FaultKind::ALL {
        let of_kind: Vec<&Row> = rows.iter().filter(|row| row.kind == kind).collect();
        text += &totals(&kind.to_string(), &of_kind);
    }
    text += &totals("all", &rows.iter().collect::<Vec<_>>());
    let caught = rows.iter().filter(|row| row.detection.is_some()).count();
    text += &format!("\nCaught: {caught} of {}.\n", rows.len());
    text
}

fn row_of(Row { name, imitates, detection, .. }: &Row) -> String {
    let Some(Detection { scene, quantity, place, compared, smallest }) = detection else {
        return format!("| `{name}` | {imitates} | **not caught** | | |\n");
    };
    let how = match (quantity, place) {
        (Some(quantity), Some(place)) => format!("{scene}, {place}: {quantity}, defect"),
        _ => format!("{scene}: refused by the reader"),
    };
    let ended = if smallest.is_finished { "" } else { " at most" };
    let (after, before) = (smallest.faces_after, smallest.faces_before);
    format!("| `{name}` | {imitates} | {how} | {compared} | {after}{ended} of {before} |\n")
}

fn totals(name: &str, rows: &[&Row]) -> String {
    let detections: Vec<&Detection> = rows.iter().filter_map(|row| row.detection.as_ref()).collect();
    let rays = median(detections.iter().map(|detection| detection.compared).collect());
    let faces = median(detections.iter().map(|detection| detection.smallest.faces_after as u64).collect());
    format!("| {name} | {} | {} | {rays} | {faces} |\n", rows.len(), detections.len())
}

/// The median: the middle value, or the mean of the two in the middle. 0 if there is no value.
fn median(mut values: Vec<u64>) -> f64 {
    values.sort_unstable();
    match values.len() {
        0 => 0.0,
        odd if odd % 2 == 1 => values[odd / 2] as f64,
        even => 0.5 * (values[even / 2 - 1] + values[even / 2]) as f64,
    }
}

fn capitalised(word: &str) -> String {
    let (first, rest) = word.split_at(1);
    first.to_uppercase() + rest
}
