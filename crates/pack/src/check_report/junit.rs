//! `junit.xml`: a check for CI.

use std::io;

use raypencil_judge::{Class, Item, ItemTally, SensorResult, name_of};
use raypencil_report::{JunitCase, JunitReport, JunitSuite, count, number};

use crate::check::Checked;
use crate::check_report::verdict::MAX_SHOWN_DEFECTS;

/// One test case per sensor and quantity.
pub(crate) fn junit(checked: &Checked) -> io::Result<String> {
    let Checked { subject, recorded, check, .. } = checked;
    let mut report = JunitReport::new(format!("raypencil check {} {}", subject.name, recorded.name));
    let mut suite = JunitSuite::new(format!("{}: {}", subject.name, recorded.name));
    for sensor in &check.sensors {
        for (item, tally) in sensor.items.iter() {
            let class = format!("{}.{}.{}", subject.name, recorded.name, sensor.sensor);
            suite.push(case(checked, sensor, item, tally).with_class(class));
        }
    }
    // Without this, a report of skipped cases alone would look like a pass.
    if check.compared() == 0 {
        suite.push(JunitCase::failed("something is compared", "nothing_compared", "nothing was compared"));
    }
    report.push(suite);
    report.to_xml()
}

/// The outcome of one quantity of one sensor.
fn case(checked: &Checked, sensor: &SensorResult, item: Item, tally: &ItemTally) -> JunitCase {
    let name = name_of(item);
    let bad = tally.of(Class::Defect) + tally.of(Class::Undecided);
    if bad == 0 {
        return if tally.compared() == 0 {
            JunitCase::skipped(name, "not compared: absent, or stored in a type that cannot hold it")
        } else {
            JunitCase::passed(name)
        };
    }
    let [wrong, rays] = [bad, tally.compared()].map(count);
    let message = format!("{}: {name} is wrong on {wrong} of {rays} rays", sensor.sensor);
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
    if let Some(why) = checked.why() {
        lines.push(format!("Why: {why}."));
    }
    JunitCase::failed(name, "defect", message).with_text(lines.join("\n"))
}
