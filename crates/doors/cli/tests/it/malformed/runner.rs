//! Runs a command on a malformed input, in a process of its own with limited memory and processor time, and says what is wrong with how
//! it ended. The tests use it, and the example `hostile_inputs`.

use std::collections::BTreeSet;
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process::{Command, ExitStatus, Stdio};
use std::time::Duration;

use raypencil_tests::malformed::Case;
use raypencil_tests::malformed::hostile::Family;
use wait4::{ResUse, Wait4};

/// Shell command that runs its arguments with at most 512 MB of data and 2 s of processor time. The limit is on
/// writable memory (`-d`): address space (`-v`) would include the 64 MB that the allocator reserves for each thread.
const RUN_WITH_LIMITS: &str = "ulimit -d 524288 && ulimit -t 2 && exec \"$@\"";
/// Time after which a process is stopped. A process that waits, for example for the writer of a pipe, uses no processor
/// time. The deadline is long because the machine may be busy.
const DEADLINE: Duration = Duration::from_secs(20);
/// Maximum length of a message in bytes: about one screen of text.
const MAX_MESSAGE_BYTES: usize = 4096;

/// The result of a run.
pub struct Run {
    /// `None`: it was stopped.
    pub status: Option<ExitStatus>,
    /// On standard output.
    pub printed: String,
    /// On standard error.
    pub message: String,
    /// Files that the run created or deleted.
    pub changed: Vec<String>,
    /// Processor time and memory.
    #[allow(dead_code, reason = "the example `hostile_inputs` reads it")]
    pub used: ResUse,
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

/// Runs the program `raypencil` at `program`.
pub fn run(case: &Case, program: &Path) -> Run {
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
        .args(["-c", RUN_WITH_LIMITS, "sh"])
        .arg(program)
        .args(arguments)
        .current_dir(&home)
        .env("NO_COLOR", "1")
        .stdin(Stdio::null())
        .stdout(create(&printed))
        .stderr(create(&message));
    let mut before = BTreeSet::new();
    listing(folder.path(), &mut before);
    let mut process = command.spawn().expect("the binary runs");
    // Whoever waits for the end learns what was used, and cannot be stopped meanwhile.
    let (ended, end) = std::sync::mpsc::channel();
    let id = process.id();
    let waiting = std::thread::spawn(move || {
        let used = process.wait4().expect("a status");
        // Nobody listens any more if it took too long.
        let _ = ended.send(());
        used
    });
    let is_late = end.recv_timeout(DEADLINE).is_err();
    if is_late {
        // Its number is nobody else's as long as nobody has heard of its end.
        Command::new("kill").args(["-KILL", &id.to_string()]).status().expect("it can be ended");
    }
    let used = waiting.join().expect("a thread that does not panic");
    let status = (!is_late).then_some(used.status);
    let mut after = BTreeSet::new();
    listing(folder.path(), &mut after);
    let text = |path: &Path| String::from_utf8_lossy(&fs::read(path).expect("what was printed")).into_owned();
    let changed = before.symmetric_difference(&after).map(|path| path.display().to_string()).collect();
    Run { status, printed: text(&printed), message: text(&message), changed, used }
}

/// The defects of a refusal.
pub fn faults(case: &Case, run: &Run) -> Vec<String> {
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

/// The beginning of a text.
pub fn short(text: &str) -> String {
    text.chars().take(600).collect()
}

/// What is wrong with how a case of a family ended, and whether it was accepted.
pub fn verdict(family: &Family, case: &Case, run: &Run) -> (Vec<String>, bool) {
    let code = run.status.and_then(|status| status.code());
    let is_good = (family.is_good)(&case.name);
    let is_open = !is_good && !family.open.is_empty();
    // Exit code 1 means that a difference or a fault of a mesh was found.
    let is_accepted = match code {
        Some(code @ (0 | 1)) => is_good || is_open && family.open.contains(&code),
        _ => false,
    };
    if is_accepted && !run.message.contains("panicked") {
        return (Vec::new(), true);
    }
    if is_good {
        return (vec![format!("a good file: exit code {code:?}"), short(&run.message)], false);
    }
    (faults(case, run), false)
}
