//! Every malformed input, those that were written one by one and those by rule, each in a process of its own: `just hostile-inputs`
//! writes `docs/evidence/hostile-inputs.md`. The program `raypencil` beside this one is asked. Words choose kinds whose names have them.

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;

use raypencil::campaign::Campaign;
use raypencil_tests::malformed::hostile::{Family, families};
use raypencil_tests::malformed::{all, tiffs};

#[path = "../tests/it/malformed/runner.rs"]
mod runner;

/// Inputs that are tried at once.
const THREADS: usize = 2;

/// What became of the inputs of a kind.
#[derive(Debug, Default)]
struct Figures {
    inputs: usize,
    refused: usize,
    /// Good files by the rule of their kind.
    accepted: usize,
    /// Accepted where the rule cannot tell.
    open: usize,
    broken: Vec<String>,
    panics: usize,
    /// Most memory of a process, bytes.
    peak: u64,
    /// Most processor time.
    slowest: Duration,
}

impl Figures {
    fn add(&mut self, other: &Self) {
        self.inputs += other.inputs;
        self.refused += other.refused;
        self.accepted += other.accepted;
        self.open += other.open;
        self.panics += other.panics;
        self.peak = self.peak.max(other.peak);
        self.slowest = self.slowest.max(other.slowest);
        self.broken.extend(other.broken.iter().cloned());
    }

    fn row(&self, kind: &str) -> String {
        let Self { inputs, refused, accepted, open, panics, .. } = self;
        let (broken, peak, slowest) = (self.broken.len(), self.peak >> 20, self.slowest.as_secs_f64());
        format!(
            "| {kind} | {inputs} | {refused} | {accepted} | {open} | {broken} | {panics} | {peak} | {slowest:.2} |"
        )
    }
}

fn tried(family: &Family, program: &Path) -> Figures {
    let (next, figures) = (AtomicUsize::new(0), Mutex::new(Figures::default()));
    std::thread::scope(|scope| {
        for _ in 0..THREADS {
            scope.spawn(|| {
                while let Some(case) = family.cases.get(next.fetch_add(1, Ordering::Relaxed)) {
                    let run = runner::run(case, program);
                    let (faults, is_accepted) = runner::verdict(family, case, &run);
                    let is_good = (family.is_good)(&case.name);
                    let mut figures = figures.lock().expect("figures");
                    figures.inputs += 1;
                    figures.accepted += usize::from(is_accepted && is_good);
                    figures.open += usize::from(is_accepted && !is_good);
                    figures.refused += usize::from(!is_accepted && faults.is_empty());
                    figures.panics += usize::from(run.message.contains("panicked"));
                    if !faults.is_empty() {
                        figures.broken.push(format!("{}: {}", case.name, faults.join("; ")));
                    }
                    let used = &run.used.rusage;
                    figures.peak = figures.peak.max(used.maxrss);
                    figures.slowest = figures.slowest.max(used.utime + used.stime);
                }
            });
        }
    });
    figures.into_inner().expect("figures")
}

fn main() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let own = std::env::current_exe().expect("this program");
    let beside = own.ancestors().nth(2).expect("the folder of programs");
    let program: PathBuf = beside.join(format!("raypencil{}", std::env::consts::EXE_SUFFIX));
    assert!(program.is_file(), "{} is built first", program.display());
    let campaign = Campaign::new(5, 2).of_commit(raypencil_cli::commit());
    let campaign = serde_json::to_value(campaign).expect("JSON of numbers and texts");
    let is_asked = |kind: &str| words.is_empty() || words.iter().any(|word| kind.contains(word.as_str()));
    let mut whole = Figures::default();
    let mut rows = Vec::new();
    let mut add = |kind: &str, family: &Family| {
        let figures = tried(family, &program);
        eprintln!("{}", figures.row(kind));
        rows.push(figures.row(kind));
        whole.add(&figures);
    };
    let written = "written one by one";
    if is_asked(written) {
        add(written, &Family::of([all(), tiffs()].concat()));
    }
    for (kind, family) in families().into_iter().filter(|(kind, _)| is_asked(kind)) {
        add(kind, &family(&campaign));
    }
    for line in &whole.broken {
        eprintln!("{line}");
    }
    println!("{}\n{}\n{}", PAGE.trim_end(), rows.join("\n"), whole.row("**all**"));
    if whole.broken.is_empty() { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

/// The page before the rows of its table.
const PAGE: &str = "\
# Hostile inputs

<!-- stands on
made_by = \"just hostile-inputs\"
measured = \"how the processes of one build ended\"
-->

The command is run on each of these inputs in a process of its own, with at most 512 MB of memory and 2 s of processor time. An input is
*refused* if the exit code is 2 with one short message, nothing on standard output and no file written. Inputs by rule are a good
file in which one place after the other is changed; of most of them the rule itself says whether they still are a good file
(*accepted*): a record must say the same in its JSON as before, a value must lie in the range that [the guide](../guide/scene.md) has.
*Open* are those that the program accepted where the rule cannot tell, such as another digit of a position. A changed manifest is among
them: it is refused, or the right answers pass; they are never called wrong. Every other end is *broken*.

`tests/src/malformed` makes the inputs ([those written one by one](malformed-inputs.md)), and `just hostile-inputs` runs them and writes
this page. The tests run some of each kind. Memory is the most of any process in MiB, and at least what the program that starts them
has taken itself; time is processor time in seconds.

| kind | inputs | refused | accepted | open | broken | panics | memory | time |
| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |
";
