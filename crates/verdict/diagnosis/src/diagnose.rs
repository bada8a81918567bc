//! The diagnosis of a recording: a search for each sensor by itself, and then for those together that have no reason yet.

use crate::agree::tolerance_of;
use crate::case::Case;
use crate::diagnosis::{Diagnosis, Reason};
use crate::image::explained_by_pencils;
use crate::landing::explained_by_camera;
use crate::mistake::Mistake;
use crate::rules::Numbers;
use crate::sample::WrongRays;
use crate::search::{Finding, Search};
use raypencil_judge::{Check, Class, GroundTruth, Recorded, check_rays};
use raypencil_scene::{Place, Precision, SensorId, Silent};

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
    let is_wrong =
        |result: &&raypencil_judge::SensorResult| result.of(Class::Defect) + result.of(Class::Undecided) > 0;
    let compared = check.sensors.iter().filter(|result| result.compared() > 0).count();
    let mut found: Vec<(Vec<SensorId>, Finding)> = Vec::new();
    let mut open = Vec::new();
    for result in check.sensors.iter().filter(is_wrong) {
        let sensors = vec![result.sensor];
        let finding = with_search(&sensors, &|search| search.find())
            .or_else(|| beside_single_precision(truth, recorded, check, &sensors));
        match finding {
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
    // What several sensors say is tried on one that says something else: both may fit it, and one mistake is likelier.
    let alone: Vec<Finding> = found.iter().map(|(_, finding)| finding.clone()).collect();
    let count = |words: &[String]| alone.iter().filter(|one| words_of(&one.mistakes) == words).count();
    for (sensors, finding) in &mut found {
        let own = words_of(&finding.mistakes);
        let is_commoner = |one: &&Finding| {
            let words = words_of(&one.mistakes);
            words != own && count(&words) > count(&own)
        };
        let tried = alone.iter().filter(is_commoner).max_by_key(|one| count(&words_of(&one.mistakes)));
        let same = tried.and_then(|one| with_search(sensors, &|search| search.confirm(one)));
        if let Some(same) = same.filter(|same| same.tally.off() <= finding.tally.off()) {
            *finding = same;
        }
    }
    // Another camera has the light of right pencils land elsewhere.
    if let Some((_, of_camera)) = found.iter_mut().find(|(sensors, _)| *sensors == [SensorId::Camera])
        && let Some((mistake, numbers)) = other_camera(truth, of_camera)
    {
        let beams = explained_by_camera(truth, recorded, check, &open, &numbers);
        // Shifted cells of the image change no light: where the light is another's, the camera is another.
        if !beams.is_empty() {
            of_camera.mistakes = vec![mistake];
        }
        let of_camera = of_camera.clone();
        for (beam, tally) in beams {
            open.retain(|sensor| *sensor != beam);
            found.push((vec![beam], Finding { tally, ..of_camera.clone() }));
        }
    }
    // An image is as wrong as the pencils that it is the sum of.
    if open.contains(&SensorId::Camera)
        && let Some(tally) = explained_by_pencils(truth, recorded, check)
    {
        open.retain(|sensor| *sensor != SensorId::Camera);
        let mistakes = vec![Mistake::FluxOfWrongPencils];
        found.push((
            vec![SensorId::Camera],
            Finding { mistakes, corrections: Vec::new(), rules: None, tally },
        ));
    }
    // Rays of several sensors together say what those of each do not. A pair of mistakes might be one of each.
    if open.len() > 1
        && let Some(finding) =
            with_search(&open, &|search| search.find()).filter(|finding| finding.mistakes.len() == 1)
    {
        found.push((std::mem::take(&mut open), finding));
    }
    let reasons = together(found, compared);
    (!reasons.is_empty()).then_some(Diagnosis { reasons, unexplained: open })
}

/// The camera by whose rays a finding explains what is wrong, and the mistake that it is. Cells that are shifted hold the rays of a camera
/// with another principal point.
fn other_camera(truth: &GroundTruth<'_>, found: &Finding) -> Option<(Mistake, Numbers)> {
    let [mistake] = *found.mistakes.as_slice() else { return None };
    let Mistake::Shifted { columns, rows } = mistake else { return Some((mistake, found.rules?.numbers)) };
    let [cx, cy] = truth.scene().camera().sensor.principal_point;
    let [columns, rows] = [f64::from(columns), f64::from(rows)];
    let mistake = Mistake::PrincipalPoint { stated: [cx + columns, cy + rows], truth: [cx, cy] };
    Some((mistake, Numbers { offset: [-columns, -rows], ..Numbers::SCENE }))
}

/// A reason for what is wrong even for arithmetic of single precision, where most rays are wrong for its sake.
fn beside_single_precision(
    truth: &GroundTruth<'_>,
    recorded: &Recorded,
    check: &Check,
    sensors: &[SensorId],
) -> Option<Finding> {
    let wrong = WrongRays::of(check, sensors);
    let tolerance = tolerance_of(truth, recorded, &wrong.values);
    if !Search::new(Case { truth, recorded, sensors, tolerance }, &wrong).is_secretly_single() {
        return None;
    }
    let single = Recorded { precision: Precision::F32, ..recorded.clone() };
    let is_asked = |place: Place| sensors.contains(&place.sensor);
    let check = check_rays(truth, &single, &is_asked, &Silent);
    let left = WrongRays::of(&check, sensors);
    if 2 * left.all.len() > wrong.all.len() {
        return None;
    }
    let tolerance = tolerance_of(truth, &single, &left.values);
    let search = Search::new(Case { truth, recorded: &single, sensors, tolerance }, &left);
    // Two at once are enough.
    let mut found = search.find().filter(|found| found.mistakes.len() == 1)?;
    found.mistakes.push(Mistake::SinglePrecision);
    found.tally.explained += (wrong.all.len() - left.all.len()) as u64;
    found.tally.wrong += (wrong.all.len() - left.all.len()) as u64;
    found.tally.right = found.tally.right.min(wrong.right());
    Some(found)
}

fn words_of(mistakes: &[Mistake]) -> Vec<String> {
    mistakes.iter().map(ToString::to_string).collect()
}

/// Sensors with the same reason, in the same words, are told together.
fn together(found: Vec<(Vec<SensorId>, Finding)>, compared: usize) -> Vec<Reason> {
    let mut reasons: Vec<Reason> = Vec::new();
    for (sensors, Finding { mistakes, tally, .. }) in found {
        match reasons.iter_mut().find(|reason| words_of(&reason.mistakes) == words_of(&mistakes)) {
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tally::Tally;

    #[test]
    fn one_mistake_of_several_sensors_is_one_reason_with_the_sums_of_its_counts() {
        let found = |sensor, mistake, base: u64| {
            let tally = Tally { wrong: base, explained: base + 1, right: base + 2, broken: base + 3 };
            let finding = Finding { mistakes: vec![mistake], corrections: Vec::new(), rules: None, tally };
            (vec![sensor], finding)
        };
        let [beam, other] = [0, 1].map(SensorId::Beam);
        let all = vec![
            found(beam, Mistake::RowsReversed, 100),
            found(SensorId::Camera, Mistake::NormalsReversed, 10),
            found(other, Mistake::RowsReversed, 1000),
        ];
        let reasons = together(all, 3);
        let told: Vec<_> = reasons
            .iter()
            .map(|reason| {
                (reason.sensors.clone(), [reason.wrong, reason.explained, reason.right, reason.broken])
            })
            .collect();
        assert_eq!(
            told,
            [(vec![SensorId::Camera], [10, 11, 12, 13]), (vec![beam, other], [1100, 1102, 1104, 1106])]
        );
        assert!(reasons.iter().all(|reason| !reason.is_everywhere));
        let all = vec![found(beam, Mistake::RowsReversed, 1), found(other, Mistake::RowsReversed, 1)];
        assert!(together(all.clone(), 2)[0].is_everywhere && !together(all, 3)[0].is_everywhere);
    }
}
