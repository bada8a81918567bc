//! Every planted fault: which scene catches it first, by what, after how many rays, and how small a scene still does.
//! Writes the page `docs/evidence/injected-faults.md` to standard output; times go to standard error. Given a folder, it leaves the
//! smallest scenes there as well.
//!
//! ```sh
//! cargo run --release -p raypencil-tests --example planted_faults > docs/evidence/injected-faults.md
//! ```

use std::path::Path;
use std::time::Instant;

use raypencil::harness::{Reproducer, write_reproducer};
use raypencil::io::FileError;
use raypencil_tests::files::FileFault;
use raypencil_tests::naive::{Fault, Kind};
use raypencil_tests::plants::hunt::{Catch, hunt, hunt_file};

const HEAD: &str = "\
# Planted faults

Does a comparison find what is wrong? Each of these faults is planted in a third, naive renderer, or in the files of a
right one, and looked for: on the scenes of its kind, one after the other, until a ray shows it. `just planted-faults`
makes this page again.

*Caught by* is that scene, its first ray that is wrong, the quantity and the class; *rays* is how many rays were compared
until then, those of scenes that did not show it among them. *Faces* is what the smallest scene has in which the same
fault still shows, and nothing without it, out of how many: found by delta debugging, so that no one can be left out.
";

/// A row of the table.
struct Row {
    kind: Kind,
    name: String,
    imitates: &'static str,
    catch: Option<Catch>,
}

fn main() -> Result<(), FileError> {
    let mut rows = Vec::new();
    let mut slowest = (0.0, String::new());
    let mut time = |name: &str, hunt: &dyn Fn() -> Option<Catch>| {
        let start = Instant::now();
        let catch = hunt();
        let seconds = start.elapsed().as_secs_f64();
        let calls = catch.as_ref().map_or(0, |catch| catch.smallest.calls);
        eprintln!("{name}: {seconds:.2} s, {calls} trials");
        if seconds > slowest.0 {
            slowest = (seconds, name.into());
        }
        catch
    };
    for &fault in Fault::ALL {
        let name = format!("{fault:?}");
        let catch = time(&name, &|| hunt(fault));
        rows.push(Row { kind: fault.kind(), name, imitates: fault.imitates(), catch });
    }
    for fault in FileFault::ALL {
        let name = format!("{fault:?}");
        let catch = time(&name, &|| hunt_file(fault));
        rows.push(Row { kind: Kind::Files, name, imitates: fault.imitates(), catch });
    }
    eprintln!("slowest: {}, {:.2} s", slowest.1, slowest.0);
    print!("{}", page(&rows));
    match std::env::args_os().nth(1) {
        Some(folder) => rows.iter().try_for_each(|row| write(row, Path::new(&folder))),
        None => Ok(()),
    }
}

/// Leaves the smallest scene in a folder.
fn write(row: &Row, folder: &Path) -> Result<(), FileError> {
    let Some(catch) = &row.catch else { return Ok(()) };
    let name = format!("{}-{}", row.kind.to_string().replace(' ', "-"), row.name);
    let what = format!("A planted fault, {}.", row.imitates);
    // No renderer of the command line has the fault: its own show what is right.
    write_reproducer(folder, &catch.smallest, Reproducer { name: &name, what: &what, with: "" }).map(drop)
}

fn page(rows: &[Row]) -> String {
    let mut text = String::from(HEAD);
    for kind in Kind::ALL {
        text += &format!("\n## {}\n\n", capitalised(&kind.to_string()));
        text += "| fault | imitates | caught by | rays | faces |\n| --- | --- | --- | ---: | ---: |\n";
        for row in rows.iter().filter(|row| row.kind == kind) {
            text += &row_of(row);
        }
    }
    text += "\n## Totals\n\n| kind | faults | caught | median rays | median faces |\n| --- | ---: | ---: | ---: | ---: |\n";
    for kind in Kind::ALL {
        let of_kind: Vec<&Row> = rows.iter().filter(|row| row.kind == kind).collect();
        text += &totals(&kind.to_string(), &of_kind);
    }
    text += &totals("all", &rows.iter().collect::<Vec<_>>());
    let caught = rows.iter().filter(|row| row.catch.is_some()).count();
    text += &format!("\nCaught: {caught} of {}.\n", rows.len());
    text
}

fn row_of(Row { name, imitates, catch, .. }: &Row) -> String {
    let Some(Catch { scene, quantity, place, compared, smallest }) = catch else {
        return format!("| `{name}` | {imitates} | **not caught** | | |\n");
    };
    let how = match (quantity, place) {
        (Some(quantity), Some(place)) => format!("{scene}, {place}: {quantity}, defect"),
        _ => format!("{scene}: refused unread"),
    };
    let ended = if smallest.is_finished { "" } else { " at most" };
    let (after, before) = (smallest.faces_after, smallest.faces_before);
    format!("| `{name}` | {imitates} | {how} | {compared} | {after}{ended} of {before} |\n")
}

fn totals(name: &str, rows: &[&Row]) -> String {
    let catches: Vec<&Catch> = rows.iter().filter_map(|row| row.catch.as_ref()).collect();
    let rays = median(catches.iter().map(|catch| catch.compared).collect());
    let faces = median(catches.iter().map(|catch| catch.smallest.faces_after as u64).collect());
    format!("| {name} | {} | {} | {rays} | {faces} |\n", rows.len(), catches.len())
}

/// The middle one, or the mean of the two in the middle; 0 of none.
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
