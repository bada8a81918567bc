//! `junit.xml`: a check for CI.

use quick_junit::{NonSuccessKind, Report, TestCase, TestCaseStatus, TestSuite};
use raypencil_judge::{Class, Item, ItemTally, SensorResult, name_of};
use raypencil_report::{count, number};

use crate::check::Checked;
use crate::check_report::verdict::MAX_SHOWN_DEFECTS;

/// One test case per sensor and quantity.
pub(crate) fn junit(checked: &Checked) -> Result<String, quick_junit::SerializeError> {
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
    // Without this, a report of skipped cases alone would look like a pass.
    if check.compared() == 0 {
        let mut status = TestCaseStatus::non_success(NonSuccessKind::Failure);
        status.set_message("nothing was compared").set_type("nothing_compared");
        suite.add_test_case(TestCase::new("something is compared", status));
    }
    report.add_test_suite(suite);
    report.to_string()
}

/// The outcome of one quantity of one sensor.
fn status(checked: &Checked, sensor: &SensorResult, item: Item, tally: &ItemTally) -> TestCaseStatus {
    let bad = tally.of(Class::Defect) + tally.of(Class::Undecided);
    if bad == 0 {
        return if tally.compared() == 0 {
            let mut status = TestCaseStatus::skipped();
            status.set_message("not compared: absent, or stored in a type that cannot hold it");
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
    let defects = || sensor.defects.iter().filter(|one| one.item == item);
    let mut lines: Vec<String> = defects()
        .take(MAX_SHOWN_DEFECTS)
        .flat_map(|one| [format!("{}: {}", one.place, one.what), format!("    {}", checked.repro(one.place))])
        .collect();
    if let Some(largest) = &tally.worst_ulps {
        let value = number(largest.value);
        lines.push(format!(
            "Largest error: {value} ulp at {} ({})",
            largest.place,
            largest.ruling.as_deref().unwrap_or("exact")
        ));
        lines.push(format!("    {}", checked.repro(largest.place)));
    }
    status.set_description(lines.join("\n"));
    status
}
