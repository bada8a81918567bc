//! A program under test: it gets the rays of a scene as a pack without answers, and its answers are checked.

use std::io::{Read, Seek, SeekFrom};
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use raypencil_files::shortened;
use raypencil_harness::{Candidate, judge_candidate};
use raypencil_pack::write_questions;
use raypencil_scene::Silent;
use raypencil_scene_io::{Subject, quoted};

use crate::error::CampaignError;
use crate::record::{PartName, PartRecord};

/// Maximum time of a candidate for one scene.
const MAX_TIME: Duration = Duration::from_secs(1800);

/// Time between two looks at whether the command has ended.
const POLL: Duration = Duration::from_millis(20);

/// Misses of one scene that are written as packs.
const MAX_MISSES: usize = 2;

/// Bytes of a failed command's messages that are kept.
const MAX_MESSAGE_BYTES: u64 = 2000;

/// Exit codes by which a shell says that there is no such program, or that it cannot be run.
const NO_PROGRAM: [i32; 2] = [126, 127];

/// Asks the program for the rays of a scene, and checks its answers.
///
/// A program that fails, or whose answers cannot be read, is what the campaign looks for: the record says so.
///
/// # Errors
/// A command that is no program; a file that cannot be written.
pub(crate) fn hunt(
    command: &str,
    part: PartName,
    subject: &Subject,
    misses: Option<&Path>,
) -> Result<PartRecord, CampaignError> {
    let folder = tempfile::tempdir().map_err(|source| raypencil_files::FileError::Io {
        path: std::env::temp_dir(),
        action: "write",
        source,
    })?;
    let (pack, out) = (folder.path().join("pack"), folder.path().join("out"));
    raypencil_files::create_folder(&out)?;
    // No answers: the program cannot copy what it does not get.
    write_questions(subject, &pack, &Silent).map_err(Box::new)?;
    let failed = |why: String| PartRecord { failed: Some(why), ..PartRecord::of(part, 0, &[]) };
    if let Some(why) = run(command, &pack, &out, folder.path())? {
        return Ok(failed(why));
    }
    let candidate = match Candidate::read(&out, &subject.scene) {
        Ok(candidate) => candidate,
        // The folder has another name each time.
        Err(error) => return Ok(failed(error.to_string().replace(&out.display().to_string(), "{out}"))),
    };
    let judged = judge_candidate(subject, candidate, misses.map(|folder| (folder, MAX_MISSES)), &Silent)
        .map_err(Box::new)?;
    let sensors = &judged.report.check.sensors;
    let record = PartRecord::of(part, judged.hits, sensors);
    // Who answers nothing is wrong nowhere, and right nowhere either.
    let silent: Vec<String> = sensors
        .iter()
        .filter(|sensor| sensor.compared() == 0 && sensor.not_compared > 0)
        .map(|sensor| sensor.sensor.to_string())
        .collect();
    let failed = (!silent.is_empty())
        .then(|| format!("it answers no ray of {}, or none that can be compared", silent.join(", ")));
    Ok(PartRecord { failed, candidate: Some(shortened(judged.report.candidate.name)), ..record })
}

/// Runs the command; `Some`: why it failed.
fn run(command: &str, pack: &Path, out: &Path, folder: &Path) -> Result<Option<String>, CampaignError> {
    let io = |source| raypencil_files::FileError::Io { path: folder.to_path_buf(), action: "write", source };
    let word = |path: &Path| quoted(&path.to_string_lossy());
    let line = command.replace("{pack}", &word(pack)).replace("{out}", &word(out));
    let mut messages = tempfile::tempfile().map_err(io)?;
    let (shell, flag) = if cfg!(windows) { ("cmd", "/C") } else { ("sh", "-c") };
    let mut child = Command::new(shell)
        .args([flag, &line])
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(messages.try_clone().map_err(io)?)
        .spawn()
        .map_err(|error| CampaignError::Candidate {
            command: command.into(),
            found: format!("{shell} cannot be run: {error}"),
            expected: "a shell".into(),
        })?;
    let start = Instant::now();
    let status = loop {
        if let Some(status) = child.try_wait().map_err(io)? {
            break status;
        }
        if start.elapsed() > MAX_TIME {
            // It may have ended in between.
            let _ = child.kill();
            let _ = child.wait();
            return Ok(Some(format!("it ran for more than {} s", MAX_TIME.as_secs())));
        }
        std::thread::sleep(POLL);
    };
    if status.success() {
        return Ok(None);
    }
    let length = messages.seek(SeekFrom::End(0)).map_err(io)?;
    messages.seek(SeekFrom::Start(length.saturating_sub(MAX_MESSAGE_BYTES))).map_err(io)?;
    let mut tail = Vec::new();
    messages.read_to_end(&mut tail).map_err(io)?;
    let tail = String::from_utf8_lossy(&tail).replace(&folder.display().to_string(), "...");
    let last = tail.lines().rev().find(|line| !line.trim().is_empty()).unwrap_or("it says nothing");
    if status.code().is_some_and(|code| NO_PROGRAM.contains(&code)) {
        return Err(CampaignError::Candidate {
            command: command.into(),
            found: last.trim().to_string(),
            expected: "a program that can be run".into(),
        });
    }
    Ok(Some(format!("it ended with {status}: {}", last.trim())))
}
