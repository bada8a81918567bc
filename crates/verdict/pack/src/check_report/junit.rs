//! `junit.xml`: a check for CI.

use std::io;

use raypencil_judge::{Check, Class, Item, ItemTally, SensorResult, name_of};
use raypencil_report::{JunitCase, JunitReport, JunitSuite, count, number};
use raypencil_scene_io::{Subject, probe_command};

use crate::check::Checked;
use crate::check_report::verdict::{MAX_SHOWN_DEFECTS, not_given};

/// One test case per sensor and quantity.
pub(crate) fn junit(checked: &Checked) -> io::Result<String> {
    let Checked { subject, recorded, check, .. } = checked;
    let mut report = JunitReport::new(format!("raypencil check {} {}", subject.name, recorded.name));
    let mut suite = check_suite(subject, &recorded.name, check, checked.why().as_deref());
    if !checked.hits_anything() {
        suite.push(JunitCase::failed("something is hit", "nothing_hit", "no ray of this pack hits anything"));
    }
    for set in &checked.ray_sets {
        let name = format!("rays {}", set.name);
        suite.push(match set.passes {
            Some(true) => JunitCase::passed(name),
            Some(false) => JunitCase::failed(name, "wrong", &set.words),
            None => JunitCase::skipped(name, &set.words),
        });
    }
    report.push(suite);
    report.to_xml()
}

/// The suite of one check: a test case per sensor and quantity. What the candidate does not give is skipped. `why`: the
/// mistake that explains its failures, if one does.
pub fn check_suite(subject: &Subject, candidate: &str, check: &Check, why: Option<&str>) -> JunitSuite {
    let mut suite = JunitSuite::new(format!("{}: {candidate}", subject.name));
    for sensor in &check.sensors {
        for (item, tally) in sensor.items.iter() {
            let class = format!("{}.{candidate}.{}", subject.name, sensor.sensor);
            suite.push(case(subject, sensor, item, tally, why).with_class(class));
        }
    }
    // Without this, a report of skipped cases alone would look like a pass.
    if check.compared() == 0 {
        suite.push(JunitCase::failed("something is compared", "nothing_compared", "nothing was compared"));
    }
    suite
}

/// The outcome of one quantity of one sensor.
fn case(
    subject: &Subject,
    sensor: &SensorResult,
    item: Item,
    tally: &ItemTally,
    why: Option<&str>,
) -> JunitCase {
    let name = name_of(item);
    let bad = tally.of(Class::Defect) + tally.of(Class::Undecided);
    if bad == 0 {
        return match not_given(tally) {
            Some(why) => JunitCase::skipped(name, why),
            None if tally.compared() == 0 => JunitCase::skipped(name, "no ray has it"),
            None => JunitCase::passed(name),
        };
    }
    let [wrong, rays] = [bad, tally.compared()].map(count);
    let message = format!("{}: {name} is wrong on {wrong} of {rays} rays", sensor.sensor);
    let mut lines: Vec<String> = sensor
        .listed
        .iter()
        .filter(|one| one.item == item)
        .take(MAX_SHOWN_DEFECTS)
        .flat_map(|one| {
            let probe = format!("    {}", probe_command(subject, one.place));
            [format!("{}: {}", one.place, one.words()), format!("    {}", one.what), probe]
        })
        .collect();
    if let Some(largest) = &tally.worst_ulps {
        let value = number(largest.value);
        let ruling = largest.ruling.as_deref().map_or(String::new(), |ruling| format!(" ({ruling})"));
        lines.push(format!("Largest error: {value} ulp at {}{ruling}", largest.place));
        lines.push(format!("    {}", probe_command(subject, largest.place)));
    }
    if let Some(why) = why {
        lines.push(format!("Why: {why}."));
    }
    JunitCase::failed(name, "defect", message).with_text(lines.join("\n"))
}
