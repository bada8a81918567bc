//! A program under test: it gets the rays of a scene as a pack without answers, and its answers are checked.

use std::path::Path;

use raypencil_diagnosis::{Diagnosis, Reason};
use raypencil_files::shortened;
use raypencil_harness::{Candidate, judge_candidate};
use raypencil_judge::{Item, Quantity};
use raypencil_pack::{Declarations, precision_of, write_questions};
use raypencil_scene::{SensorId, Silent};
use raypencil_scene_io::{Subject, quoted};

use crate::candidate_process::{self, Ended};
use crate::error::CampaignError;
use crate::plan::Campaign;
use crate::record::{PartName, PartRecord, ReasonRecord};

/// Misses of one scene that are written as packs.
const MAX_MISSES: usize = 2;

/// Exit codes by which a shell says that there is no such program, or that it cannot be run.
const NO_PROGRAM: [i32; 2] = [126, 127];

/// Asks the program for the rays of a scene, and checks its answers.
///
/// A program that fails, or whose answers cannot be read, is what the campaign looks for: the record says so.
///
/// # Errors
/// A command that is no program; a file that cannot be written.
pub(crate) fn hunt(
    campaign: &Campaign,
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
    if let Some(why) = run(campaign, command, [&pack, &out], folder.path())? {
        return Ok(failed(why));
    }
    let precision = campaign.arithmetic.map(precision_of);
    let declared = Declarations { precision, ..Declarations::default() };
    let candidate = match Candidate::read_as(&out, &subject.scene, &declared) {
        Ok(candidate) => candidate,
        // The folder has another name each time.
        Err(error) => return Ok(failed(error.to_string().replace(&out.display().to_string(), "{out}"))),
    };
    // A value alone, such as an incidence, may be right wherever it is: what is hit is said by faces and by distances.
    let undecided: Vec<SensorId> =
        subject.scene.sensors().filter(|sensor| !gives_any(&candidate, *sensor, &DECIDING)).collect();
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
    let undecided: Vec<String> = undecided.iter().map(ToString::to_string).collect();
    let failed = if !silent.is_empty() {
        Some(format!("it answers no ray of {}, or none that can be compared", silent.join(", ")))
    } else if !undecided.is_empty() && !campaign.partial {
        let sensors = undecided.join(", ");
        Some(format!(
            "it says of no ray of {sensors} what it hits, by a face or a distance (--partial takes that)"
        ))
    } else {
        None
    };
    let reasons = judged.report.diagnosis.as_ref().map_or_else(Vec::new, reason_records);
    Ok(PartRecord { failed, reasons, candidate: Some(shortened(judged.report.candidate.name)), ..record })
}

/// The reasons of a diagnosis.
fn reason_records(diagnosis: &Diagnosis) -> Vec<ReasonRecord> {
    let record = |reason: &Reason| ReasonRecord {
        mistakes: reason.mistakes.iter().map(|mistake| mistake.key().to_string()).collect(),
        clause: reason.clause(),
        wrong: reason.wrong,
        explained: reason.explained,
        right: reason.right,
        broken: reason.broken,
    };
    diagnosis.reasons.iter().map(record).collect()
}

/// Quantities of which one at least says what a ray hits.
const DECIDING: [Quantity; 4] = [Quantity::Face, Quantity::Range, Quantity::Depth, Quantity::Point];

/// Whether a candidate has one of these quantities of a sensor.
fn gives_any(candidate: &Candidate, sensor: SensorId, quantities: &[Quantity]) -> bool {
    let storage = &candidate.recorded.storage;
    quantities.iter().any(|quantity| storage.contains_key(&(sensor, Item::from(*quantity))))
}

/// Runs the command; `Some`: why it failed.
fn run(
    campaign: &Campaign,
    command: &str,
    [pack, out]: [&Path; 2],
    folder: &Path,
) -> Result<Option<String>, CampaignError> {
    let word = |path: &Path| quoted(&path.to_string_lossy());
    let line = command.replace("{pack}", &word(pack)).replace("{out}", &word(out));
    let most = campaign.candidate_time();
    let refused = |found: String, expected: &str| CampaignError::Candidate {
        command: command.into(),
        found,
        expected: expected.into(),
    };
    let (ended, said) = candidate_process::run(&line, most, folder)
        .map_err(|error| refused(format!("no shell can be run: {error}"), "a shell"))?;
    let status = match ended {
        Ended::TooLate => return Ok(Some(format!("it ran for more than {} s", most.as_secs_f64()))),
        Ended::With(status) if status.success() => return Ok(None),
        Ended::With(status) => status,
    };
    let said = said.replace(&folder.display().to_string(), "...");
    let last = said.lines().rev().find(|line| !line.trim().is_empty()).unwrap_or("it says nothing").trim();
    if status.code().is_some_and(|code| NO_PROGRAM.contains(&code)) {
        return Err(refused(last.to_string(), "a program that can be run"));
    }
    Ok(Some(format!("it ended with {status}: {last}")))
}

#[cfg(all(test, unix))]
#[path = "../tests/unit/candidate.rs"]
mod tests;
