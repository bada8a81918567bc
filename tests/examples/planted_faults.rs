//! Plants the faults of `tests/planted` one after the other, and asks the tests of the named crates.
//!
//! Run it in the root of the workspace. It works on a clone of the last commit in `out/planted-faults`, and writes the
//! page `docs/evidence/shared-faults.md`. Outcomes are recorded there: a second run repeats only what was not caught,
//! and only after a new commit. Names of faults as arguments are repeated in any case.
//!
//! With cargo-nextest the slow tests are left out, and a test that does not end is stopped
//! (`tests/planted/.nextest.toml`). Without it all tests of a crate run.
//!
//! ```sh
//! cargo run -p raypencil-tests --features examples --example planted_faults
//! ```

use std::error::Error;
use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use raypencil_tests::planted::{Outcome, Outcomes, PlantedFault, Recorded, page, planted_faults};

type Result<T> = std::result::Result<T, Box<dyn Error>>;

fn main() -> Result<()> {
    let faults = planted_faults(Path::new("tests/planted"));
    let again: Vec<String> = std::env::args().skip(1).collect();
    let run = Run::new(Path::new("out/planted-faults"))?;
    let record = run.folder.join("outcomes.json");
    let mut outcomes: Outcomes = match fs::read(&record) {
        Ok(text) => serde_json::from_slice(&text)?,
        Err(_) => Outcomes::default(),
    };
    let due: Vec<&PlantedFault> = faults
        .iter()
        .map(|(_, fault)| fault)
        .filter(|fault| again.contains(&fault.name) || outcomes.holds(fault, &run.commit).is_none())
        .collect();
    println!("{} of {} faults are due", due.len(), faults.len());

    for fault in due {
        // A test that fails without any fault would seem to catch every one.
        for of in &fault.ask {
            if outcomes.passed_without.get(of) != Some(&run.commit) {
                match run.ask(of)? {
                    Outcome::NotCaught => println!("{of}: all tests pass without a fault"),
                    other => return Err(format!("without a fault the tests of {of} fail: {other:?}").into()),
                }
                outcomes.passed_without.insert(of.clone(), run.commit.clone());
            }
        }
        let outcome = run.plant(fault)?;
        println!("{}: {outcome:?}", fault.name);
        let recorded = Recorded { fault: fault.clone(), commit: run.commit.clone(), outcome };
        outcomes.of.insert(fault.name.clone(), recorded);
        fs::write(&record, serde_json::to_vec_pretty(&outcomes)?)?;
    }

    let caught = |fault: &PlantedFault| matches!(outcomes.of[&fault.name].outcome, Outcome::Caught { .. });
    if let Some((_, control)) = faults.iter().find(|(_, fault)| fault.control && caught(fault)) {
        return Err(format!("the control {} is caught: the other outcomes mean nothing", control.name).into());
    }
    fs::write("docs/evidence/shared-faults.md", page(&faults, &outcomes))?;
    Ok(())
}

/// A clone of the last commit, in which faults are planted.
struct Run {
    folder: PathBuf,
    clone: PathBuf,
    commit: String,
    target: PathBuf,
    has_nextest: bool,
}

impl Run {
    fn new(folder: &Path) -> Result<Self> {
        fs::create_dir_all(folder)?;
        let folder = folder.canonicalize()?;
        let clone = folder.join("clone");
        if !clone.exists() {
            git(Path::new("."), ["clone".as_ref(), "--quiet".as_ref(), ".".as_ref(), clone.as_os_str()])?;
        }
        let commit = git(Path::new("."), ["rev-parse", "HEAD"].map(OsStr::new))?;
        git(&clone, ["fetch", "--quiet", "origin"].map(OsStr::new))?;
        // A run that was broken off has left a fault behind.
        git(&clone, ["checkout", "--quiet", "--force", "--detach", &commit].map(OsStr::new))?;
        let target = std::env::var_os("CARGO_TARGET_DIR").map_or(folder.join("target"), PathBuf::from);
        let nextest = Command::new("cargo").args(["nextest", "--version"]).output();
        let has_nextest = nextest.is_ok_and(|output| output.status.success());
        Ok(Self { folder, clone, commit, target, has_nextest })
    }

    /// Plants one fault, asks the tests of its crates, and takes the fault out again.
    fn plant(&self, fault: &PlantedFault) -> Result<Outcome> {
        let path = self.clone.join(&fault.file);
        let source = fs::read_to_string(&path)?;
        let wrong = fault.plant(&source).ok_or_else(|| {
            format!("{}: `find` does not occur exactly once in the committed {}", fault.name, fault.file)
        })?;
        fs::write(&path, wrong)?;
        let asked = fault.ask.iter().try_fold(Outcome::NotCaught, |before, of| match before {
            Outcome::NotCaught => self.ask(of),
            _ => Ok(before),
        });
        fs::write(&path, source)?;
        asked
    }

    /// Builds and runs the tests of a crate.
    fn ask(&self, of: &str) -> Result<Outcome> {
        if of == "python" {
            return self.ask_python();
        }
        let built = self.cargo(of, &["--no-run"])?;
        if !built.status.success() {
            let text = String::from_utf8_lossy(&built.stderr);
            let error = text.lines().find(|line| line.starts_with("error")).unwrap_or("an unknown error");
            return Ok(Outcome::DoesNotCompile(error.to_string()));
        }
        let ran = match self.has_nextest {
            true => self.cargo(of, &["--no-fail-fast", "--color=never", "--failure-output=never"])?,
            false => self.cargo(of, &["--no-fail-fast", "--color=never"])?,
        };
        if ran.status.success() {
            return Ok(Outcome::NotCaught);
        }
        let text = [ran.stdout, ran.stderr].concat();
        let mut tests: Vec<String> =
            String::from_utf8_lossy(&text).lines().filter_map(|line| self.failed(of, line)).collect();
        tests.sort();
        tests.dedup();
        match tests.is_empty() {
            true => Err(format!("the tests of {of} fail, and none is named").into()),
            false => Ok(Outcome::Caught { asked: of.to_string(), tests }),
        }
    }

    /// Builds the Python package and runs its tests, which are no Rust.
    fn ask_python(&self) -> Result<Outcome> {
        let mut command = Command::new(self.clone.join("crates/doors/python/run_tests.sh"));
        command.args(["-q", "-rf"]).current_dir(&self.clone).env("CARGO_TARGET_DIR", &self.target);
        let ran = command.output()?;
        if ran.status.success() {
            return Ok(Outcome::NotCaught);
        }
        // `FAILED crates/doors/python/tests/test_judge.py::test_it[one] - AssertionError`
        let failed = |line: &str| {
            let test = line.strip_prefix("FAILED ")?.split([' ', '[']).next()?;
            Some(test.rsplit('/').next()?.replace(".py::", "::"))
        };
        let mut tests: Vec<String> =
            String::from_utf8_lossy(&ran.stdout).lines().filter_map(failed).collect();
        tests.sort();
        tests.dedup();
        Ok(match tests.is_empty() {
            true => Outcome::DoesNotCompile("the package cannot be built, or its types are wrong".into()),
            false => Outcome::Caught { asked: "python".into(), tests },
        })
    }

    /// The test that a line of the output names as failed.
    fn failed(&self, of: &str, line: &str) -> Option<String> {
        if !self.has_nextest {
            return line.strip_prefix("test ")?.strip_suffix(" ... FAILED").map(str::to_string);
        }
        // `FAIL [   0.013s] (2/9) raypencil-sensor::optics a_test`: the state, the time, the binary and the name.
        let (state, rest) = line.trim().split_once(" [")?;
        let stopped = ["FAIL", "TIMEOUT", "ABORT"].contains(&state) || state.starts_with("SIG");
        let (_, rest) = rest.split_once(']').filter(|_| stopped)?;
        let mut words = rest.split_whitespace().skip_while(|word| !word.starts_with("raypencil-"));
        let (binary, test) = (words.next()?, words.next()?);
        let binary = binary.strip_prefix("raypencil-")?.strip_prefix(of)?.trim_start_matches("::");
        Some(if binary.is_empty() { test.to_string() } else { format!("{binary}::{test}") })
    }

    /// Cargo on the unit tests and integration tests of a crate.
    fn cargo(&self, of: &str, arguments: &[&str]) -> Result<Output> {
        let mut command = Command::new("cargo");
        match self.has_nextest {
            true => command
                .args(["nextest", "run", "--cargo-profile=planted", "--no-tests=pass", "--config-file"])
                .arg(self.clone.join("tests/planted/.nextest.toml")),
            false => command.args(["test", "--profile=planted"]),
        };
        command.arg(format!("--package=raypencil-{of}")).args(["--lib", "--tests"]).args(arguments);
        command.current_dir(&self.clone).env("CARGO_TARGET_DIR", &self.target);
        // Larger scenes are not part of the project: with them, outcomes would differ from machine to machine.
        command.env_remove("RAYPENCIL_EXTRA_DATA");
        Ok(command.output()?)
    }
}

/// Runs git in a folder, and returns its output.
fn git<const N: usize>(folder: &Path, arguments: [&OsStr; N]) -> Result<String> {
    let output = Command::new("git").current_dir(folder).args(arguments).output()?;
    match output.status.success() {
        true => Ok(String::from_utf8(output.stdout)?.trim().to_string()),
        false => Err(format!("git: {}", String::from_utf8_lossy(&output.stderr)).into()),
    }
}
