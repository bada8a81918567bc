//! What came of a check, for people and for programs.

use quick_junit::{NonSuccessKind, Report, TestCase, TestCaseStatus, TestSuite};
use serde_json::{Value, json};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use crate::check::Checked;
use raypencil_files::{FileError, FolderError, begin_output_folder, write_atomically};
use raypencil_judge::{Check, Class, Item, ItemTally, Largest, SensorCheck, Wrong, key_of, name_of, unit_of};
use raypencil_report::{count, number, quantity};
use raypencil_scene::Precision;

/// The number of the JSON's form; it grows when a key changes its meaning or goes away.
const FORMAT: u32 = 1;

/// Wrong rays that get their lines on the screen.
const SHOWN: usize = 5;

fn arithmetic(precision: Precision) -> &'static str {
    if precision == Precision::F32 { "f32" } else { "f64" }
}

fn verdict(check: &Check) -> &'static str {
    match (check.compared(), check.passes()) {
        (0, _) => "nothing_compared",
        (_, true) => "agrees",
        (_, false) => "defects",
    }
}

/// A check on one terminal screen.
pub fn check_screen(checked: &Checked) -> String {
    let Checked { subject, recorded, check, is_blind } = checked;
    let model = subject.scene.flux_model();
    let blind = if *is_blind { " (blind)" } else { "" };
    let mut text = format!(
        "raypencil {}: {} against the answers to {}{blind}, arithmetic {}\n\n",
        env!("CARGO_PKG_VERSION"),
        recorded.name,
        subject.name,
        arithmetic(recorded.precision)
    );
    let heads = [
        "",
        "compared",
        "agree",
        "tie",
        "rounding",
        "defect",
        "not compared",
        "ulp",
        "error",
        "/bound",
        "at",
    ];
    let mut lines = vec![heads.map(String::from).to_vec()];
    for (item, tally) in check.totals() {
        let largest = |largest: &Option<Largest>, unit: &str| {
            largest.as_ref().map_or("-".into(), |largest| quantity(largest.value, unit))
        };
        lines.push(vec![
            name_of(item),
            count(tally.compared()),
            count(tally.of(Class::Agree)),
            count(tally.of(Class::Tie)),
            count(tally.of(Class::Rounding)),
            count(tally.of(Class::Defect)),
            count(tally.not_compared),
            largest(&tally.ulps, ""),
            largest(&tally.error, unit_of(model, item)),
            largest(&tally.ratio, ""),
            tally.ratio.as_ref().map_or("-".into(), |largest| {
                let place = largest.place;
                format!("{} {},{}", place.sensor, place.i, place.j)
            }),
        ]);
    }
    text += &aligned(&lines);
    text.push('\n');
    for name in &recorded.unknown {
        let _ = writeln!(text, "Unknown channel, not compared: {name}");
    }
    let is_partial = check.totals().values().any(|tally| tally.not_compared > 0);
    let not_compared: Vec<String> = check
        .totals()
        .into_iter()
        .filter(|(_, tally)| tally.compared() == 0 && tally.not_compared > 0)
        .map(|(item, _)| name_of(item))
        .collect();
    if !not_compared.is_empty() {
        let _ = writeln!(
            text,
            "Not compared, because it is not there (or its type cannot hold it): {}",
            not_compared.join(", ")
        );
    }
    let wrong: Vec<&Wrong> = check.sensors.iter().flat_map(|sensor| &sensor.wrong).collect();
    for one in wrong.iter().take(SHOWN) {
        let _ = writeln!(text, "{}, {}: {}", one.place, name_of(one.item), one.what);
        let _ = writeln!(text, "    {}", checked.repro(one.place));
    }
    let rays = count(check.compared());
    let _ = match verdict(check) {
        "agrees" => writeln!(
            text,
            "✓ {rays} rays agree with the exact answers: {} exact, {} tie, {} rounding{}.",
            count(check.of(Class::Agree)),
            count(check.of(Class::Tie)),
            count(check.of(Class::Rounding)),
            if is_partial { "; of what was not compared nothing is known" } else { "" }
        ),
        "defects" => writeln!(
            text,
            "✗ {} of {rays} rays are wrong, {} undecided.",
            count(check.of(Class::Defect)),
            count(check.of(Class::Undecided))
        ),
        _ => writeln!(text, "? Nothing was compared."),
    };
    text
}

/// Columns of text, the first and the last to the left, the others to the right.
fn aligned(lines: &[Vec<String>]) -> String {
    let columns = lines.first().map_or(0, Vec::len);
    let width = |column: usize| lines.iter().map(|line| line[column].chars().count()).max().unwrap_or(0);
    let widths: Vec<usize> = (0..columns).map(width).collect();
    let mut text = String::new();
    for line in lines {
        let cells = line.iter().zip(&widths).enumerate().map(|(column, (cell, width))| {
            if column == 0 || column + 1 == columns {
                format!("{cell:<width$}")
            } else {
                format!("{cell:>width$}")
            }
        });
        let _ = writeln!(text, "{}", cells.collect::<Vec<_>>().join("  ").trim_end());
    }
    text
}

fn of_classes(by_class: &[u64; 6]) -> Value {
    json!({
        "agree": by_class[Class::Agree as usize],
        "tie": by_class[Class::Tie as usize],
        "rounding": by_class[Class::Rounding as usize],
        "undecided": by_class[Class::Undecided as usize],
        "defects": by_class[Class::Defect as usize],
    })
}

/// The check for programs. Its schema is `docs/formats/check.schema.json`.
pub fn check_json(checked: &Checked) -> String {
    let Checked { subject, recorded, check, is_blind } = checked;
    let model = subject.scene.flux_model();
    let largest = |largest: &Option<Largest>| {
        largest.as_ref().map(|Largest { value, place, ruling }| {
            json!({
                "value": value.is_finite().then_some(*value),
                "sensor": place.sensor.to_string(), "i": place.i, "j": place.j,
                "ruling": ruling,
                "probe": checked.repro(*place),
            })
        })
    };
    let of_item = |(item, tally): (&Item, &ItemTally)| {
        json!({
            "quantity": key_of(model, *item),
            "unit": unit_of(model, *item),
            "compared": tally.compared(),
            "classes": of_classes(&tally.by_class),
            "not_compared": tally.not_compared,
            "worst_ulp": largest(&tally.ulps),
            "worst_error": largest(&tally.error),
            "worst_ratio": largest(&tally.ratio),
        })
    };
    let of_sensor = |sensor: &SensorCheck| {
        let wrong = sensor.wrong.iter().map(|one| {
            json!({
                "i": one.place.i, "j": one.place.j,
                "quantity": key_of(model, one.item),
                "what": one.what,
                "probe": checked.repro(one.place),
            })
        });
        json!({
            "sensor": sensor.sensor.to_string(),
            "compared": sensor.compared(),
            "classes": of_classes(&sensor.by_class),
            "not_compared": sensor.not_compared,
            "ruled": sensor.ruled,
            "quantities": sensor.items.iter().map(of_item).collect::<Vec<_>>(),
            "first_defects": wrong.collect::<Vec<_>>(),
        })
    };
    let all: [u64; 6] = std::array::from_fn(|k| check.sensors.iter().map(|sensor| sensor.by_class[k]).sum());
    let document = json!({
        "format": FORMAT,
        "version": env!("CARGO_PKG_VERSION"),
        "verdict": verdict(check),
        "candidate": recorded.name,
        "arithmetic": arithmetic(recorded.precision),
        "scene": { "name": subject.name, "sha256": subject.sha256 },
        "blind": is_blind,
        "compared": check.compared(),
        "classes": of_classes(&all),
        "unknown_channels": recorded.unknown,
        "sensors": check.sensors.iter().map(of_sensor).collect::<Vec<_>>(),
    });
    format!("{document:#}\n")
}

/// One test case per sensor and quantity.
fn junit(checked: &Checked) -> Result<String, quick_junit::SerializeError> {
    let Checked { subject, recorded, check, .. } = checked;
    let mut report = Report::new(format!("raypencil check {} {}", subject.name, recorded.name));
    let mut suite = TestSuite::new(format!("{}: {}", subject.name, recorded.name));
    for sensor in &check.sensors {
        for (item, tally) in &sensor.items {
            let mut case = TestCase::new(name_of(*item), status(checked, sensor, *item, tally));
            case.set_classname(format!("{}.{}.{}", subject.name, recorded.name, sensor.sensor));
            suite.add_test_case(case);
        }
    }
    // Skipped cases alone would look like a pass.
    if check.compared() == 0 {
        let mut status = TestCaseStatus::non_success(NonSuccessKind::Failure);
        status.set_message("nothing was compared").set_type("nothing_compared");
        suite.add_test_case(TestCase::new("something is compared", status));
    }
    report.add_test_suite(suite);
    report.to_string()
}

fn status(checked: &Checked, sensor: &SensorCheck, item: Item, tally: &ItemTally) -> TestCaseStatus {
    let bad = tally.of(Class::Defect) + tally.of(Class::Undecided);
    if bad == 0 {
        return if tally.compared() == 0 {
            let mut status = TestCaseStatus::skipped();
            status.set_message("not compared: it is not there, or its type cannot hold it");
            status
        } else {
            TestCaseStatus::success()
        };
    }
    let mut status = TestCaseStatus::non_success(NonSuccessKind::Failure);
    status.set_type("defect");
    status.set_message(format!(
        "{}: {} is wrong on {} of {} rays",
        sensor.sensor,
        name_of(item),
        count(bad),
        count(tally.compared())
    ));
    let own = || sensor.wrong.iter().filter(|one| one.item == item);
    let mut lines: Vec<String> = own()
        .take(SHOWN)
        .flat_map(|one| [format!("{}: {}", one.place, one.what), format!("    {}", checked.repro(one.place))])
        .collect();
    if let Some(largest) = &tally.ulps {
        let value = number(largest.value);
        lines.push(format!("Largest error: {value} ulp at {} ({})", largest.place, largest.ruling));
        lines.push(format!("    {}", checked.repro(largest.place)));
    }
    status.set_description(lines.join("\n"));
    status
}

/// Writes `junit.xml`, and last `check.json`, into a folder.
///
/// # Errors
/// Names the file or folder that could not be written, and why.
pub fn write_check(checked: &Checked, folder: &Path) -> Result<Vec<PathBuf>, FolderError> {
    let last = begin_output_folder(folder, "check.json")?;
    let path = folder.join("junit.xml");
    let document = junit(checked).map_err(|error| FileError::Io {
        path: path.clone(),
        action: "write",
        source: std::io::Error::other(error),
    })?;
    write_atomically(&path, |file| file.write_all(document.as_bytes()))?;
    write_atomically(&last, |file| file.write_all(check_json(checked).as_bytes()))?;
    Ok(vec![path, last])
}
