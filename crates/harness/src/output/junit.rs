//! `junit.xml`: one test case per pair, sensor and quantity, for CI that reads JUnit.

use quick_junit::{NonSuccessKind, Report, TestCase, TestCaseStatus, TestSuite};

use crate::output::verdict::{Verdict, explanation, headline};
use crate::validation::Validation;
use raypencil_judge::{Class, Defect, ItemTally, Quantity, SensorResult};
use raypencil_report::{count, counted};
use raypencil_scene_io::{Subject, probe_command};

/// How many defects a failure lists.
const LISTED: usize = 5;

/// The whole document.
pub fn junit(validation: &Validation) -> Result<String, quick_junit::SerializeError> {
    let subject = &validation.subject;
    let mut report = Report::new(format!("raypencil validate {}", subject.arguments));
    for pair in &validation.pairs {
        let (a, b) = (&validation.rendered[pair.a].name, &validation.rendered[pair.b].name);
        let mut suite = TestSuite::new(format!("{}: {a} against {b}", subject.name));
        for sensor in &pair.sensors {
            let items = sensor.items.iter().map(|(item, tally)| (&item.quantity, tally));
            for (quantity, tally) in items.filter(|(one, _)| one.is_of(sensor.sensor)) {
                let mut case = TestCase::new(quantity.to_string(), status(subject, sensor, *quantity, tally));
                case.set_classname(format!("{}.{a}-{b}.{}", subject.name, sensor.sensor));
                suite.add_test_case(case);
            }
        }
        report.add_test_suite(suite);
    }
    // Skipped cases alone would look like a pass.
    if Verdict::of(validation) == Verdict::NothingCompared {
        let mut status = TestCaseStatus::non_success(NonSuccessKind::Failure);
        status.set_message(headline(validation)).set_type("nothing_compared");
        status.set_description(explanation(validation));
        let mut suite = TestSuite::new(subject.name.as_str());
        suite.add_test_case(TestCase::new("something is compared", status));
        report.add_test_suite(suite);
    }
    report.to_string()
}

/// What became of one quantity of one sensor.
fn status(subject: &Subject, sensor: &SensorResult, quantity: Quantity, tally: &ItemTally) -> TestCaseStatus {
    let defects = tally.of(Class::Defect);
    if defects == 0 {
        return if tally.compared() == 0 && tally.not_compared > 0 {
            let mut status = TestCaseStatus::skipped();
            status.set_message("not compared: one side does not provide it");
            status
        } else {
            TestCaseStatus::success()
        };
    }

    let mut status = TestCaseStatus::non_success(NonSuccessKind::Failure);
    let compared = counted(sensor.compared(), "ray", "rays");
    status.set_message(format!("{}: {quantity} differs on {} of {compared}", sensor.sensor, count(defects)));
    status.set_type("defect");
    let mut lines = Vec::new();
    // A ray is described under the worst of its quantities, which may be another one than this.
    let (own, other): (Vec<&Defect>, Vec<&Defect>) =
        sensor.defects.iter().partition(|defect| defect.item.quantity == quantity);
    let listed = if own.is_empty() { other } else { own };
    for defect in listed.into_iter().take(LISTED) {
        lines.push(format!("{}, {}: {}", defect.place, defect.item.quantity, defect.what));
        lines.push(format!("    {}", probe_command(subject, defect.place)));
    }
    if let Some(worst) = &tally.worst_error {
        let value = raypencil_report::quantity(worst.value, quantity.unit(subject.scene.flux_model()));
        lines.push(format!("Worst error: {value} at {}", worst.place));
        lines.push(format!("    {}", probe_command(subject, worst.place)));
    }
    status.set_description(lines.join("\n"));
    status
}
