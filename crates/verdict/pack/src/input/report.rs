//! The report on a loader's triangles: for the screen, and as JSON and JUnit.

use std::io;
use std::path::{Path, PathBuf};

use raypencil_files::{FileError, FolderError, begin_output_folder, write_atomically};
use raypencil_report::{Align, JunitCase, JunitReport, JunitSuite, Table, counted};
use serde_json::{Value, json};

use crate::input::check::{InputChecked, WrongFace};
use crate::input::clause::LoadingClause;

/// The report for a screen: a row for each clause, the first wrong face, and the verdict.
pub fn input_screen(checked: &InputChecked) -> String {
    let version = env!("CARGO_PKG_VERSION");
    let mut table = Table::new([Align::Left, Align::Right, Align::Right]);
    table.row(["clause", "faces", "wrong"]);
    for clause in LoadingClause::ALL {
        let (faces, wrong) = checked.of(*clause);
        let tested = if faces == 0 { "-".into() } else { faces.to_string() };
        table.row([clause.key().to_string(), tested, wrong.to_string()]);
    }
    let mut text =
        format!("raypencil {version}: {} against the triangles of the input pack\n\n{table}\n", checked.name);
    if let Some(first) = checked.wrong.first() {
        text += &format!("{}\n", of_face(first));
    }
    text += &match checked.has_reflectivity {
        true => String::new(),
        false => "Reflectivities are not given.\n".to_string(),
    };
    text += &verdict(checked);
    text.push('\n');
    text
}

/// What is wrong with a face, in one sentence.
fn of_face(wrong: &WrongFace) -> String {
    let WrongFace { face, truth, corners, reflectivity } = wrong;
    let clause = format!("face {face}, `{}` ({})", truth.clause.key(), truth.clause.sentence());
    match (corners, reflectivity) {
        (None, _) => format!("{clause} is missing, true is {:?}", truth.corners),
        (Some(_), Some(said)) => {
            format!("{clause} has the reflectivity {said}, true is {}", truth.reflectivity)
        }
        (Some(said), None) => format!("{clause} has the corners {said:?}, true are {:?}", truth.corners),
    }
}

/// The verdict in one line.
fn verdict(checked: &InputChecked) -> String {
    let faces = counted(checked.faces as u64, "face", "faces");
    match (checked.wrong.len(), checked.given == checked.faces) {
        (0, true) => format!("✓ {faces}: all are right."),
        (0, false) => format!("✗ {faces} are right, and there are {} in all.", checked.given),
        (wrong, _) => format!("✗ {wrong} of {faces} are wrong; {} are given.", checked.given),
    }
}

/// The report as JSON.
pub fn input_json(checked: &InputChecked) -> String {
    let wrong = |wrong: &WrongFace| {
        json!({
            "face": wrong.face,
            "clause": wrong.truth.clause.key(),
            "said": wrong.corners,
            "said_reflectivity": wrong.reflectivity,
            "true": wrong.truth.corners,
            "true_reflectivity": wrong.truth.reflectivity,
        })
    };
    let document: Value = json!({
        "format": 1,
        "kind": "input",
        "raypencil_version": env!("CARGO_PKG_VERSION"),
        "candidate": checked.name,
        "faces": checked.faces,
        "given": checked.given,
        "reflectivity_given": checked.has_reflectivity,
        "passes": checked.passes(),
        "wrong": checked.wrong.iter().map(wrong).collect::<Vec<_>>(),
    });
    format!("{document:#}\n")
}

/// The report as JUnit: a case for each clause.
fn junit(checked: &InputChecked) -> io::Result<String> {
    let mut suite = JunitSuite::new(format!("input pack: {}", checked.name));
    for clause in LoadingClause::ALL {
        let first = checked.wrong.iter().find(|wrong| wrong.truth.clause == *clause);
        suite.push(match (first, checked.of(*clause)) {
            (Some(first), _) => JunitCase::failed(clause.key(), "defect", of_face(first)),
            (None, (_, 0)) => JunitCase::passed(clause.key()),
            (None, (_, extra)) => JunitCase::failed(
                clause.key(),
                "defect",
                format!("{extra} faces more than {}", checked.faces),
            ),
        });
    }
    let mut report = JunitReport::new(format!("raypencil check {}", checked.name));
    report.push(suite);
    report.to_xml()
}

/// Writes `junit.xml` and then `check.json` into a folder, and returns their paths.
///
/// # Errors
/// Names the file or folder that could not be written, and why.
pub fn write_input_check(checked: &InputChecked, folder: &Path) -> Result<Vec<PathBuf>, FolderError> {
    let last = begin_output_folder(folder, "check.json")?;
    let path = folder.join("junit.xml");
    let document =
        junit(checked).map_err(|source| FileError::Io { path: path.clone(), action: "write", source })?;
    write_atomically(&path, |file| file.write_all(document.as_bytes()))?;
    write_atomically(&last, |file| file.write_all(input_json(checked).as_bytes()))?;
    Ok(vec![path, last])
}
