//! A check of a pack of rays on a screen, for programs and for continuous integration.

use std::path::Path;

use raypencil_files::{FolderError, begin_output_folder, write_atomically};
use raypencil_report::{JunitCase, JunitReport, JunitSuite, VERSION};
use serde_json::{Value, json};

use super::check::RayPackChecked;
use crate::comparison::{comparison_headline, comparison_json, comparison_text};
use crate::page::{CastPage, ComparedHits, write_cast_page};

/// The check on one screen.
pub fn ray_check_text(checked: &RayPackChecked) -> String {
    let RayPackChecked { name, comparison, why, .. } = checked;
    let mut text = comparison_text(name, comparison, |index| checked.ray_command(index));
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

/// Writes `junit.xml`, `report.html` and last `check.json`.
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
    let title = format!("{} on {}", checked.name, checked.pack);
    let mut facts = vec![("pack", checked.pack.clone()), ("candidate", checked.name.clone())];
    facts.extend(checked.why.iter().map(|why| ("why", why.clone())));
    let page = CastPage {
        title: &title,
        facts: &facts,
        shape: &checked.rays.shape,
        rays: &checked.rays.rays,
        answers: &checked.answers,
        set: None,
        compared: Some(ComparedHits {
            name: &checked.name,
            stated: &checked.stated,
            comparison: &checked.comparison,
            ray_command: &|index| checked.ray_command(index),
        }),
    };
    write_cast_page(folder, &page)?;
    let document = ray_check_json(checked);
    Ok(write_atomically(&last, |file| file.write_all(format!("{document:#}\n").as_bytes()))?)
}
