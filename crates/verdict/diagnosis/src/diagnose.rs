//! The diagnosis of a recording: a search for each sensor by itself, and then for those together that have no reason yet.

use crate::agree::tolerance_of;
use crate::correction::Case;
use crate::diagnosis::{Diagnosis, Reason};
use crate::sample::WrongRays;
use crate::search::{Finding, Search};
use raypencil_judge::{Check, Class, GroundTruth, Recorded};
use raypencil_scene::SensorId;

/// Looks for the mistake that explains why rays are wrong, or for two: of each sensor by itself, and then of those
/// together whose rays are too few.
///
/// `check` is the judge's result for the same recording. `None`: no mistake that is known here explains the wrong rays
/// of any sensor, or they are too few to tell. The same arguments give the same answer.
pub fn diagnose(truth: &GroundTruth<'_>, recorded: &Recorded, check: &Check) -> Option<Diagnosis> {
    let with_search = |sensors: &[SensorId], of: &dyn Fn(&Search<'_>) -> Option<Finding>| {
        let wrong = WrongRays::of(check, sensors);
        let tolerance = tolerance_of(truth, recorded, &wrong.values);
        of(&Search::new(Case { truth, recorded, sensors, tolerance }, &wrong))
    };
    let is_wrong = |result: &&raypencil_judge::SensorResult| {
        result.of(Class::Defect) + result.of(Class::Undecided) > 0
    };
    let compared = check.sensors.iter().filter(|result| result.compared() > 0).count();
    let mut found: Vec<(Vec<SensorId>, Finding)> = Vec::new();
    let mut open = Vec::new();
    for result in check.sensors.iter().filter(is_wrong) {
        let sensors = vec![result.sensor];
        match with_search(&sensors, &|search| search.find()) {
            Some(finding) => found.push((sensors, finding)),
            None => open.push(result.sensor),
        }
    }
    // Few rays confirm what others say.
    let others: Vec<Finding> = found.iter().map(|(_, finding)| finding.clone()).collect();
    open.retain(|sensor| {
        let sensors = vec![*sensor];
        let same = with_search(&sensors, &|search| others.iter().find_map(|one| search.confirm(one)));
        let is_open = same.is_none();
        found.extend(same.map(|finding| (sensors, finding)));
        is_open
    });
    // Rays of several sensors together say what those of each do not. A pair of mistakes might be one of each.
    if open.len() > 1
        && let Some(finding) = with_search(&open, &|search| search.find()).filter(|finding| finding.mistakes.len() == 1)
    {
        found.push((std::mem::take(&mut open), finding));
    }
    let reasons = together(found, compared);
    (!reasons.is_empty()).then_some(Diagnosis { reasons, unexplained: open })
}

/// Sensors with the same reason, in the same words, are told together.
fn together(found: Vec<(Vec<SensorId>, Finding)>, compared: usize) -> Vec<Reason> {
    let mut reasons: Vec<Reason> = Vec::new();
    for (sensors, Finding { mistakes, tally, .. }) in found {
        let words = |mistakes: &[crate::mistake::Mistake]| -> Vec<String> {
            mistakes.iter().map(ToString::to_string).collect()
        };
        match reasons.iter_mut().find(|reason| words(&reason.mistakes) == words(&mistakes)) {
            Some(reason) => {
                reason.sensors.extend(sensors);
                reason.wrong += tally.wrong;
                reason.explained += tally.explained;
                reason.right += tally.right;
                reason.broken += tally.broken;
            }
            None => reasons.push(Reason {
                sensors,
                is_everywhere: false,
                mistakes,
                wrong: tally.wrong,
                explained: tally.explained,
                right: tally.right,
                broken: tally.broken,
            }),
        }
    }
    for reason in &mut reasons {
        reason.sensors.sort_unstable();
        reason.is_everywhere = reason.sensors.len() == compared;
    }
    reasons.sort_by(|a, b| a.sensors.cmp(&b.sensors));
    reasons
}
