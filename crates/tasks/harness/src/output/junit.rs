//! The test cases of `junit.xml`: one per pair, sensor and quantity, for CI that reads JUnit.

use crate::monte_carlo::Z_TEST_LIMITS;
use crate::output::candidates::line;
use crate::output::verdict::{Ruled, Verdict, told};
use crate::scoreboard::CandidateReport;
use crate::validation::Validation;
use raypencil_judge::{Class, ItemTally, ListedDefect, Quantity, SensorResult};
use raypencil_pack::check_suite;
use raypencil_report::{JunitCase, JunitSuite, count, counted};
use raypencil_scene_io::{Subject, probe_command};

/// How many defects a failure lists.
const LISTED: usize = 5;

/// All suites.
pub(super) fn suites(
    Ruled { validation, verdict, headline, explanation, .. }: &Ruled<'_>,
) -> Vec<JunitSuite> {
    let subject = &validation.subject;
    let mut suites = Vec::new();
    for pair in &validation.pairs {
        let (a, b) = (&validation.rendered[pair.a].name, &validation.rendered[pair.b].name);
        let mut suite = JunitSuite::new(format!("{}: {a} against {b}", subject.name));
        for sensor in &pair.sensors {
            let items = sensor.items.iter().map(|(item, tally)| (item.quantity, tally));
            for (quantity, tally) in items.filter(|(one, _)| one.is_of(sensor.sensor)) {
                let class = format!("{}.{a}-{b}.{}", subject.name, sensor.sensor);
                suite.push(case(subject, sensor, quantity, tally).with_class(class));
            }
        }
        suites.push(suite);
    }
    for set in &validation.ray_sets {
        let mut suite = JunitSuite::new(format!("{}: rays {}", subject.name, set.name));
        suite.push(match &set.comparison {
            None => JunitCase::skipped("first hits", set.words()),
            Some(comparison) if comparison.counts().wrong > 0 => {
                JunitCase::failed("first hits", "defect", set.words())
            }
            Some(_) => JunitCase::passed("first hits"),
        });
        suites.push(suite);
    }
    for candidate in validation.candidates() {
        suites.push(candidate_suite(validation, candidate));
    }
    // Skipped cases alone would look like a pass.
    if *verdict == Verdict::NothingCompared {
        let case = JunitCase::failed("something is compared", "nothing_compared", headline.as_str());
        let mut suite = JunitSuite::new(subject.name.as_str());
        suite.push(case.with_text(explanation.as_str()));
        suites.push(suite);
    }
    // So would cases that pass because all renderers see nothing.
    if *verdict == Verdict::NothingHit {
        let case = match validation.allow_empty {
            true => JunitCase::skipped("something is hit", headline.as_str()),
            false => JunitCase::failed("something is hit", "nothing_hit", headline.as_str())
                .with_text(explanation.as_str()),
        };
        let mut suite = JunitSuite::new(subject.name.as_str());
        suite.push(case);
        suites.push(suite);
    }
    suites
}

/// A candidate: a case for each sensor and quantity, for each image and for each radiance map. If candidates may fail,
/// one case says so in place of all, and is skipped if the candidate is wrong.
fn candidate_suite(validation: &Validation, report: &CandidateReport) -> JunitSuite {
    let (subject, name) = (&validation.subject, &report.candidate.name);
    if validation.candidates_may_fail && !report.passes() {
        let mut suite = JunitSuite::new(format!("{}: {name}", subject.name));
        let message = format!("wrong, which --candidates-must-pass=false allows: {}", line(report));
        suite.push(JunitCase::skipped("candidate", message));
        return suite;
    }
    let mut suite = check_suite(subject, name, &report.check);
    let images = report.images.iter().map(|image| {
        let name = format!("image {}, beam {}", image.integrator, image.beam);
        (name, image.is_within(&Z_TEST_LIMITS), "random errors do not explain the difference")
    });
    let radiance = report.radiance.iter().map(|map| {
        (format!("radiance of {} rays, beam {}", map.sensor, map.beam), map.wrong == 0, "radiance is wrong")
    });
    let sets = report.given_sets().map(|(name, set)| {
        (format!("rays {name}"), set.passes(), "rays are answered wrongly, or none hits anything")
    });
    for (case, fits, message) in images.chain(radiance).chain(sets) {
        let class = format!("{}.{name}", subject.name);
        let case = if fits { JunitCase::passed(case) } else { JunitCase::failed(case, "defect", message) };
        suite.push(case.with_class(class));
    }
    suite
}

/// What became of one quantity of one sensor.
fn case(subject: &Subject, sensor: &SensorResult, quantity: Quantity, tally: &ItemTally) -> JunitCase {
    let name = quantity.to_string();
    let defects = tally.of(Class::Defect);
    if defects == 0 {
        return if tally.compared() == 0 && tally.not_compared > 0 {
            JunitCase::skipped(name, "not compared: one side does not provide it")
        } else {
            JunitCase::passed(name)
        };
    }

    let compared = counted(sensor.compared(), "ray", "rays");
    let message = format!("{}: {quantity} differs on {} of {compared}", sensor.sensor, count(defects));
    let mut lines = Vec::new();
    // A ray is described under the worst of its quantities, which may be another one than this.
    let (own, other): (Vec<&ListedDefect>, Vec<&ListedDefect>) =
        sensor.listed.iter().partition(|defect| defect.item.quantity == quantity);
    let listed = if own.is_empty() { other } else { own };
    for defect in listed.into_iter().take(LISTED) {
        lines.push(told(defect));
        lines.push(format!("    {}", defect.what));
        lines.push(format!("    {}", probe_command(subject, defect.place)));
    }
    if let Some(worst) = &tally.worst_error {
        let value = raypencil_report::quantity(worst.value, quantity.unit(subject.scene.flux_model()));
        lines.push(format!("Worst error: {value} at {}", worst.place));
        lines.push(format!("    {}", probe_command(subject, worst.place)));
    }
    JunitCase::failed(name, "defect", message).with_text(lines.join("\n"))
}
