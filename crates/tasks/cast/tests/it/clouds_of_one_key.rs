//! Clouds that have a channel or a time of each point, and not both: each is held to the ray of the point.

use raypencil_cast::{CloudFrame, RayPackChecked};

use super::cloud_trial::{Fields, Point, Trial, bend, expect, head, of_frame, points, still};

const FRAME: CloudFrame = CloudFrame::Sensor;

/// Points as they should be, with another number in each.
fn changed(trial: &Trial, change: impl Fn(usize, &mut Point)) -> Vec<Point> {
    let mut points = points(&trial.set, FRAME);
    points.iter_mut().enumerate().for_each(|(index, point)| change(index, point));
    points
}

/// The rays whose points have a channel or a time of another, and the fields that were compared.
fn told(checked: RayPackChecked) -> (Vec<usize>, Vec<String>) {
    let cloud = checked.cloud.expect("a cloud");
    (cloud.wrong_keys, cloud.keys)
}

#[test]
fn right_ones_pass_by_order_and_by_direction() {
    for mounting in [still(), bend()] {
        let trial = Trial::new(&head(), &mounting);
        let points = points(&trial.set, FRAME);
        for (fields, name) in [(Fields::Ring, "ring"), (Fields::Time, "time")] {
            // With a place more than rays the order says nothing, and places without a point are no points of no ray.
            let none = points.iter().find(|point| point.place.is_nan()).expect("a miss");
            let more = [points.as_slice(), &[*none]].concat();
            let of_more = trial.check(&trial.write(&more, fields, [more.len(), 1]), of_frame(FRAME));
            for checked in [
                of_more.expect("a check"),
                trial.judge(&points, fields, FRAME),
                trial.judge_dense(&points, fields, FRAME),
            ] {
                assert!(checked.passes(), "{fields:?}: {:?}", checked.why);
                assert_eq!(told(checked), (vec![], vec![name.to_string()]));
            }
        }
    }
}

#[test]
fn one_wrong_number_is_found_where_it_stands() {
    let trial = Trial::new(&head(), &bend());
    let right = points(&trial.set, FRAME);
    let hit = (500..).find(|&index| right[index].place.is_finite()).expect("a point");
    // A channel fires each 0.8 ms: times may be off by 0.2 ms.
    for (fields, off_s, is_wrong) in [
        (Fields::Ring, 0.0, true),
        (Fields::Time, 1.98e-4, false),
        (Fields::Time, 2.02e-4, true),
        (Fields::Time, -1.98e-4, false),
        (Fields::Time, -2.02e-4, true),
        (Fields::Time, f64::NAN, true),
        (Fields::Time, f64::INFINITY, true),
    ] {
        let points = changed(&trial, |index, point| {
            if index == hit {
                point.ring ^= 1;
                point.time += off_s;
            }
        });
        for checked in [trial.judge(&points, fields, FRAME), trial.judge_dense(&points, fields, FRAME)] {
            assert_eq!(checked.passes(), !is_wrong, "{fields:?} {off_s}");
            assert_eq!(checked.comparison.counts().wrong, 0);
            assert_eq!(told(checked).0, if is_wrong { vec![hit] } else { vec![] }, "{fields:?} {off_s}");
        }
    }
}

#[test]
fn what_is_wrong_with_all_of_them_is_told() {
    let trial = Trial::new(&head(), &still());
    let expect_why = |fields, change: &dyn Fn(usize, &mut Point), words: &str| {
        let points = changed(&trial, change);
        expect(&trial.judge(&points, fields, FRAME), words);
        expect(&trial.judge_dense(&points, fields, FRAME), words);
    };
    expect_why(
        Fields::Ring,
        &|_, point| point.ring = 15 - point.ring,
        "the field ring counts channels from above: its 0 is the lowest",
    );
    expect_why(
        Fields::Ring,
        &|index, point| point.ring = index as u16 % 16,
        "the field ring is the channel in the order of the manual",
    );
    expect_why(Fields::Ring, &|_, point| point.ring += 1, "the numbers of channels count from 1");
    expect_why(Fields::Time, &|_, point| point.time *= 1e3, "the field time is in milliseconds");
    expect_why(Fields::Time, &|_, point| point.time += 0.125, "the times of the points are 0.125 s too late");
    expect_why(
        Fields::Time,
        &|index, point| point.time = (index / 16) as f64 * 8e-4,
        "all points of a firing sequence have the time of its first ray",
    );
}
