//! A check of a pack of rays on a screen, for programs and for continuous integration.

use std::path::Path;

use raypencil_files::{FolderError, begin_output_folder, write_atomically};
use raypencil_report::{JunitCase, JunitReport, JunitSuite, VERSION};
use serde_json::{Value, json};

use super::check::RayPackChecked;
use crate::comparison::{comparison_headline, comparison_json, comparison_text};

/// The check on one screen.
pub fn ray_check_text(checked: &RayPackChecked) -> String {
    let RayPackChecked { name, pack, comparison, why, wrong_rays, fronts_only } = checked;
    let fronts = if *fronts_only { " --fronts-only" } else { "" };
    let command = |index: usize| {
        let numbers = wrong_rays.iter().find(|(wrong, _)| *wrong == index);
        let numbers = numbers.map_or("", |(_, numbers)| numbers.as_str());
        format!("raypencil cast {pack} --ray={numbers}{fronts} --all --margins")
    };
    let mut text = comparison_text(name, comparison, command);
    if let Some(why) = why {
        text += &format!("  Why: {why}.\n");
    }
    text
}

/// The check for programs.
pub fn ray_check_json(checked: &RayPackChecked) -> Value {
    json!({
        "format": 1,
        "kind": "rays",
        "raypencilVersion": VERSION,
        "pack": checked.pack,
        "candidate": comparison_json(&checked.name, &checked.comparison),
        "why": checked.why,
    })
}

/// Writes `junit.xml` and last `check.json`.
///
/// # Errors
/// The folder or a file cannot be written; the message names it.
pub fn write_ray_check(checked: &RayPackChecked, folder: &Path) -> Result<(), FolderError> {
    let last = begin_output_folder(folder, "check.json")?;
    let mut suite = JunitSuite::new(format!("{} against {}", checked.name, checked.pack));
    let headline = comparison_headline(&checked.comparison);
    suite.push(match checked.passes() {
        true => JunitCase::passed("first hits"),
        false => JunitCase::failed("first hits", "wrong", headline).with_text(ray_check_text(checked)),
    });
    let mut report = JunitReport::new(format!("raypencil check {}", checked.pack));
    report.push(suite);
    let path = folder.join("junit.xml");
    let xml = report.to_xml().map_err(|error| raypencil_files::FileError::io(&path, "write", error))?;
    write_atomically(&path, |file| file.write_all(xml.as_bytes()))?;
    let document = ray_check_json(checked);
    Ok(write_atomically(&last, |file| file.write_all(format!("{document:#}\n").as_bytes()))?)
}
