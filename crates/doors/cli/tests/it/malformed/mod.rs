//! Malformed inputs: the command refuses each, in its own process with limited memory and processor time.
#![cfg(unix)]
// CHOICE: Unix only, because a shell sets the limits. The readers are the same on other systems.

mod hostile;

use std::collections::BTreeSet;
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process::{Command, ExitStatus, Stdio};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use raypencil_tests::malformed::{Case, all, good, table, tiffs};

/// Shell command that runs its arguments with at most 512 MB of data and 2 s of processor time. The limit is on
/// writable memory (`-d`): address space (`-v`) would include the 64 MB that the allocator reserves for each thread.
const RUN_WITH_LIMITS: &str = "ulimit -d 524288 && ulimit -t 2 && exec \"$@\"";
/// Time after which a process is stopped. A process that waits, for example for the writer of a pipe, uses no processor
/// time. The deadline is long because the machine may be busy.
const DEADLINE: Duration = Duration::from_secs(20);
/// Maximum length of a message in bytes: about one screen of text.
const MAX_MESSAGE_BYTES: usize = 4096;

/// The result of a run.
struct Run {
    status: Option<ExitStatus>,
    printed: String,
    message: String,
    /// Files that the run created or deleted.
    changed: Vec<String>,
}

fn packs() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../../../data/packs")
        .canonicalize()
        .expect("the committed packs")
}

/// Every path below a folder; links are not followed.
fn listing(folder: &Path, all: &mut BTreeSet<PathBuf>) {
    for entry in fs::read_dir(folder).expect("a folder") {
        let entry = entry.expect("an entry");
        if entry.file_type().expect("its type").is_dir() {
            listing(&entry.path(), all);
        }
        all.insert(entry.path());
    }
}

fn run(case: &Case) -> Run {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let home = folder.path().join("case");
    fs::create_dir(&home).expect("a folder");
    case.make(&home, &packs()).expect("the case is made");
    let printed = folder.path().join("stdout");
    let message = folder.path().join("stderr");
    let create = |path: &Path| Stdio::from(File::create(path).expect("a file"));
    let pack = packs().join("facets").display().to_string();
    let arguments = case.command.iter().map(|word| if word == "PACK" { &pack } else { word });
    let mut command = Command::new("sh");
    command
        .args(["-c", RUN_WITH_LIMITS, "sh", env!("CARGO_BIN_EXE_raypencil")])
        .args(arguments)
        .current_dir(&home)
        .env("NO_COLOR", "1")
        .stdin(Stdio::null())
        .stdout(create(&printed))
        .stderr(create(&message));
    let mut before = BTreeSet::new();
    listing(folder.path(), &mut before);
    let mut process = command.spawn().expect("the binary runs");
    let start = Instant::now();
    let status = loop {
        match process.try_wait().expect("a status") {
            Some(status) => break Some(status),
            None if start.elapsed() > DEADLINE => {
                process.kill().and_then(|()| process.wait()).expect("it can be ended");
                break None;
            }
            None => std::thread::sleep(Duration::from_millis(2)),
        }
    };
    let mut after = BTreeSet::new();
    listing(folder.path(), &mut after);
    let text = |path: &Path| String::from_utf8_lossy(&fs::read(path).expect("what was printed")).into_owned();
    let changed = before.symmetric_difference(&after).map(|path| path.display().to_string()).collect();
    Run { status, printed: text(&printed), message: text(&message), changed }
}

/// The defects of a refusal.
fn faults(case: &Case) -> Vec<String> {
    let run = run(case);
    let mut faults = Vec::new();
    let mut hold = |is_right: bool, fault: String| {
        if !is_right {
            faults.push(fault);
        }
    };
    match run.status {
        None => hold(false, format!("still running after {} s", DEADLINE.as_secs())),
        Some(status) => hold(status.code() == Some(2), format!("{status}, not exit code 2")),
    }
    hold(run.printed.is_empty(), format!("printed {:?}", short(&run.printed)));
    hold(run.changed.is_empty(), format!("created or deleted {:?}", run.changed));
    // An option that cannot be read has a message of clap's.
    let messages = run.message.matches('×').count() + usize::from(run.message.starts_with("error: "));
    hold(messages == 1, "not exactly one message".into());
    hold(!run.message.contains("panicked"), "a panic".into());
    hold(run.message.len() <= MAX_MESSAGE_BYTES, format!("a message of {} bytes", run.message.len()));
    let is_control = |letter: char| letter.is_control() && letter != '\n';
    hold(!run.message.contains(is_control), "control characters in the message".into());
    // The message may be wrapped, even within long words, with a bar at the start of each line.
    let bare = |text: &str| {
        text.chars().filter(|letter| !letter.is_whitespace() && *letter != '│').collect::<String>()
    };
    let message = bare(&run.message);
    for word in &case.words {
        hold(message.contains(&bare(word)), format!("no {word:?} in the message"));
    }
    if !faults.is_empty() {
        faults.push(short(&run.message));
    }
    faults
}

fn short(text: &str) -> String {
    text.chars().take(600).collect()
}

/// Runs all cases in parallel, and reports all defects together.
fn assert_all(cases: &[Case], faults: impl Fn(&Case) -> Vec<String> + Sync) {
    let next = AtomicUsize::new(0);
    let found = Mutex::new(Vec::new());
    std::thread::scope(|scope| {
        for _ in 0..std::thread::available_parallelism().map_or(2, usize::from).min(8) {
            scope.spawn(|| {
                while let Some(case) = cases.get(next.fetch_add(1, Ordering::Relaxed)) {
                    let faults = faults(case);
                    if !faults.is_empty() {
                        let text = format!("{} ({}):\n  {}", case.name, case.what, faults.join("\n  "));
                        found.lock().expect("the list").push(text);
                    }
                }
            });
        }
    });
    let mut found = found.into_inner().expect("the list");
    found.sort();
    assert!(found.is_empty(), "{} of {} cases:\n\n{}", found.len(), cases.len(), found.join("\n\n"));
}

#[test]
fn every_malformed_file_is_refused() {
    let cases = all();
    let names: BTreeSet<&str> = cases.iter().map(|case| case.name.as_str()).collect();
    assert_eq!(names.len(), cases.len(), "each name once");
    assert!(cases.len() >= 100, "{} cases", cases.len());
    assert_all(&cases, faults);
}

#[test]
fn every_malformed_tiff_is_refused() {
    assert_all(&tiffs(), faults);
}

#[test]
fn good_files_pass_under_the_same_limits() {
    assert_all(&good(), |case| {
        let run = run(case);
        match run.status.and_then(|status| status.code()) {
            // Exit code 1 means that a difference was found.
            Some(0 | 1) if run.message.is_empty() => Vec::new(),
            other => vec![format!("exit code {other:?}"), short(&run.message)],
        }
    });
}

#[test]
fn the_document_lists_every_case() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../docs/evidence/malformed-inputs.md");
    let written = fs::read_to_string(path).unwrap_or_default();
    assert!(
        written == table(),
        "docs/evidence/malformed-inputs.md is not what `just malformed-inputs` writes"
    );
}
