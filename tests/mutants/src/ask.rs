//! One run of an executable of tests, stopped at the first test that fails.

use std::collections::{BTreeMap, BTreeSet};
use std::io::{BufRead, BufReader};
use std::os::unix::process::CommandExt;
use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::mpsc;
use std::time::{Duration, Instant};

use serde_json::Value;

use crate::Result;
use crate::build::Executable;

/// Most memory of a run, in KiB: a mutant may ask for any amount.
const MAX_MEMORY_KIB: u64 = 8 << 20;

/// Largest file of a run, in KiB. Tests make files with holes of up to 4 GiB, which take no room.
const MAX_FILE_KIB: u64 = 5 << 20;

/// The clock of a run looks this often.
const LOOK: Duration = Duration::from_millis(100);

/// The time of a run. If a user stops this program together with the tests (SIGSTOP), the time of the stop does not count: of
/// the time between two looks at the clock at most twice the usual is taken.
struct Clock {
    looked: Instant,
    passed: Duration,
}

impl Clock {
    fn start() -> Self {
        Self { looked: Instant::now(), passed: Duration::ZERO }
    }

    /// The time so far. To be asked about every [`LOOK`].
    fn passed(&mut self) -> Duration {
        let now = Instant::now();
        self.passed += now.duration_since(self.looked).min(2 * LOOK);
        self.looked = now;
        self.passed
    }
}

/// How a run ended.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Ended {
    /// All tests passed.
    Passed,
    /// This test failed, or ended the process.
    Failed(String),
    /// It took too long; this test had begun.
    TooLong(String),
}

/// A run and what it took.
pub(crate) struct Run {
    pub(crate) ended: Ended,
    /// The seconds of each test.
    pub(crate) seconds: BTreeMap<String, f64>,
}

/// What the tests of a run are given.
pub(crate) struct Setting<'a> {
    pub(crate) clone: &'a Path,
    /// Where they write what they write.
    pub(crate) scratch: &'a Path,
    /// Variables that cargo would set.
    pub(crate) variables: &'a [(String, String)],
}

impl Setting<'_> {
    /// Runs an executable with the mutant of a number; 0 is none.
    pub(crate) fn run(
        &self,
        executable: &Executable,
        arguments: &[String],
        mutant: u32,
        limit: Duration,
    ) -> Result<Run> {
        let folder = self.clone.join(&executable.folder);
        let limits =
            format!("ulimit -c 0; ulimit -v {MAX_MEMORY_KIB}; ulimit -f {MAX_FILE_KIB}; exec \"$0\" \"$@\"");
        let mut child = Command::new("bash")
            .args(["-c", &limits])
            .arg(&executable.path)
            .args(["-Z", "unstable-options", "--format=json", "--report-time"])
            .args(arguments)
            .current_dir(&folder)
            // The format is not stable; the variable lets a stable toolchain take it.
            .env("RUSTC_BOOTSTRAP", "1")
            .env("MUTANT", mutant.to_string())
            .env("CARGO_MANIFEST_DIR", &folder)
            .env("CARGO_PKG_NAME", &executable.package)
            .env("INSTA_UPDATE", "no")
            .env("INSTA_WORKSPACE_ROOT", self.clone)
            // The first case that fails is enough.
            .env("PROPTEST_MAX_SHRINK_ITERS", "0")
            .env("TMPDIR", self.scratch)
            .envs(self.variables.iter().map(|(name, value)| (name, value)))
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .process_group(0)
            .spawn()?;
        let out = child.stdout.take().ok_or("no output")?;
        let (send, lines) = mpsc::channel();
        std::thread::spawn(move || {
            for line in BufReader::new(out).lines() {
                let Ok(line) = line else { break };
                if send.send(line).is_err() {
                    break;
                }
            }
        });

        let mut clock = Clock::start();
        let mut seconds = BTreeMap::new();
        let mut begun: BTreeSet<String> = BTreeSet::new();
        let in_flight = |begun: &BTreeSet<String>| begun.first().cloned().unwrap_or_else(|| "no test".into());
        let ended = loop {
            if clock.passed() > limit {
                break Ended::TooLong(in_flight(&begun));
            }
            let line = match lines.recv_timeout(LOOK) {
                Ok(line) => line,
                Err(mpsc::RecvTimeoutError::Timeout) => continue,
                Err(mpsc::RecvTimeoutError::Disconnected) => match child.try_wait()? {
                    Some(status) if status.success() => break Ended::Passed,
                    Some(_) => break Ended::Failed(in_flight(&begun)),
                    // It has closed its output, and has not ended yet.
                    None => {
                        std::thread::sleep(Duration::from_millis(5));
                        continue;
                    }
                },
            };
            // A line may also be the words of a test.
            let Ok(event) = serde_json::from_str::<Value>(&line) else { continue };
            let (Some("test"), Some(name), Some(what)) =
                (event["type"].as_str(), event["name"].as_str(), event["event"].as_str())
            else {
                continue;
            };
            match what {
                "started" => drop(begun.insert(name.to_string())),
                "failed" => break Ended::Failed(name.to_string()),
                "ok" => {
                    begun.remove(name);
                    seconds.insert(name.to_string(), event["exec_time"].as_f64().unwrap_or(0.0));
                }
                "ignored" => drop(begun.remove(name)),
                _ => {}
            }
        };
        if ended != Ended::Passed {
            // With what the tests have started.
            let group = format!("-{}", child.id());
            Command::new("kill").args(["-KILL", "--", &group]).stderr(Stdio::null()).status()?;
        }
        child.wait()?;
        Ok(Run { ended, seconds })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stop_does_not_count() {
        let mut clock = Clock { looked: Instant::now() - 50 * LOOK, passed: 3 * LOOK };
        assert_eq!(clock.passed(), 5 * LOOK);
        // Between two looks at the usual time all counts.
        clock.looked = Instant::now() - LOOK;
        let passed = clock.passed();
        assert!((6 * LOOK..7 * LOOK).contains(&passed), "{passed:?}");
    }
}
