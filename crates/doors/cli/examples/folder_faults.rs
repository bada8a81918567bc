//! Each operation of each command that writes a folder fails once, and once its process ends there: `just folder-faults` writes the
//! table of docs/evidence/folder-faults.md, of all commands or of those that are named, `just folder-faults drive 100..200` of some of
//! their operations. Each run is a process of its own.

use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode, Stdio};

use tempfile::TempDir;

#[path = "../tests/it/folder_walk.rs"]
mod folder_walk;

use folder_walk::{Fault, WALKED, run_until, walk};

/// Exit code of a process that is ended by its fault.
const DIED: u8 = 86;

fn main() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).collect();
    match words.first().map(String::as_str) {
        Some("run") => run(&words[1..]),
        _ => table(&words),
    }
}

/// A run: the kind of its fault, the number of the operation, the tree, where its operations are to be written, the words of the
/// command.
fn run(words: &[String]) -> ExitCode {
    let number = words[1].parse().expect("a number");
    let fault = match words[0].as_str() {
        "fails" => Fault::Fails(number),
        "dies" => Fault::Dies(number),
        _ => Fault::None,
    };
    let (code, seen) = run_until(Path::new(&words[2]), &words[4..], fault, &|| {
        // Without a word to anybody: no destructor runs, and nothing is flushed.
        std::process::exit(i32::from(DIED));
    });
    std::fs::write(&words[3], seen.join("\n")).expect("the list of operations");
    ExitCode::from(code.unwrap_or(DIED))
}

/// Runs a command in a process of its own.
fn run_elsewhere(report: &Path, tree: &Path, words: &[String], fault: Fault) -> (Option<u8>, Vec<String>) {
    let (kind, number) = match fault {
        Fault::None => ("none", 0),
        Fault::Fails(number) => ("fails", number),
        Fault::Dies(number) => ("dies", number),
    };
    let mut child = Command::new(std::env::current_exe().expect("this program"));
    child.args(["run", kind, &number.to_string()]).args([tree, report]).args(words);
    child.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    let code = child.status().expect("this program runs").code();
    let code = code.and_then(|code| u8::try_from(code).ok()).filter(|code| *code != DIED);
    let seen = std::fs::read_to_string(report).unwrap_or_default();
    (code, seen.lines().map(String::from).collect())
}

fn table(names: &[String]) -> ExitCode {
    let folder = TempDir::new().expect("a folder");
    let folder: PathBuf = folder.path().canonicalize().expect("its path");
    let (tree, report) = (folder.join("tree"), folder.join("operations"));
    let run = |tree: &Path, words: &[String], fault: Fault| run_elsewhere(&report, tree, words, fault);
    println!("| command | operations | runs with a fault | broken |\n| --- | ---: | ---: | ---: |");
    let mut is_whole = true;
    let range = |word: &String| {
        let (first, end) = word.split_once("..")?;
        Some(first.parse::<usize>().ok()?..end.parse::<usize>().ok()?)
    };
    let pieces: Vec<std::ops::Range<usize>> = names.iter().filter_map(range).collect();
    let names: Vec<&String> = names.iter().filter(|word| range(word).is_none()).collect();
    let is_asked = |name: &str| names.is_empty() || names.iter().any(|asked| *asked == name);
    let is_in_piece = |number: &usize| pieces.is_empty() || pieces.iter().any(|piece| piece.contains(number));
    for walked in WALKED.iter().filter(|walked| is_asked(walked.name)) {
        let start = std::time::Instant::now();
        let figures = walk(walked, &tree, &run, &|count| (0..count).filter(is_in_piece).collect());
        let words = format!("{} {}", walked.name, walked.words);
        eprintln!("{words}: {:.0} s", start.elapsed().as_secs_f64());
        println!("| `{words}` | {} | {} | {} |", figures.operations, figures.states, figures.broken.len());
        for line in &figures.broken {
            is_whole = false;
            eprintln!("{line}");
        }
    }
    if is_whole { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}
