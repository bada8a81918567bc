//! Numbers of returns in clouds of beams with a width: which returns they are, and by which rule a simulator counts them otherwise.

use raypencil_scene::Precision;
use raypencil_scene::pattern::Keep;

use super::beam_trial::{Fields, Point, RULES, Trial};
use super::cloud_trial::{expect, still};

#[test]
fn wrong_numbers_of_returns_are_wrong() {
    let numbered = |keep: Keep, number: &dyn Fn(usize, u32) -> u32| {
        let trial = Trial::of_room(&still(), keep);
        let right: Vec<Point> = trial.right().into_iter().filter(|one| one.place.is_finite()).collect();
        let of = |(k, one): (usize, &Point)| Point { number: number(k, one.number), ..*one };
        let points: Vec<Point> = right.iter().enumerate().map(of).collect();
        let others = right.iter().zip(&points).filter(|(a, b)| a.number != b.number).count();
        (trial.check(&trial.write(&points, Fields::Numbers), Precision::F64).expect("a check"), others)
    };
    for keep in RULES {
        for all in [0, 1, 7] {
            let (checked, others) = numbered(keep, &|_, _| all);
            assert_eq!(checked.comparison.counts().wrong, 0);
            assert_eq!(checked.passes(), others == 0, "{keep:?}, all {all}");
            let text = checked.document().screen();
            let cloud = checked.cloud.expect("a cloud");
            assert_eq!(cloud.wrong_numbers.len(), others, "{keep:?}, all {all}");
            if others == 0 {
                assert_eq!((keep, all), (Keep::First, 1));
                continue;
            }
            let why = checked.why.expect("a reason");
            assert!(
                why.contains(&format!("if all points have the number of return {all}: it counts")),
                "{why}"
            );
            let told = format!("number of return of {others} points is another");
            assert!(text.to_lowercase().contains(&told), "{text}");
        }
    }
    // One of them alone, and no reason.
    let (checked, _) = numbered(Keep::UpTo(2), &|k, number| if k == 9 { 3 } else { number });
    assert!(!checked.passes() && checked.why.is_none());
    assert_eq!(checked.cloud.expect("a cloud").wrong_numbers.len(), 1);
}

/// Points a hundredth too far, and numbers that are wrong beside them.
#[test]
fn wrong_numbers_of_returns_are_told_beside_wrong_points() {
    let why = |number: &dyn Fn(usize, u32) -> u32| {
        let trial = Trial::of_room(&still(), Keep::UpTo(2));
        let right: Vec<Point> = trial.right().into_iter().filter(|one| one.place.is_finite()).collect();
        let points = right.iter().enumerate();
        let of = |(k, one): (usize, &Point)| Point {
            place: one.place * 1000.0,
            number: number(k, one.number),
            ..*one
        };
        let points: Vec<Point> = points.map(of).collect();
        let checked = trial.check(&trial.write(&points, Fields::Numbers), Precision::F64).expect("a check");
        assert!(!checked.passes());
        checked.why.expect("a reason")
    };
    let lengths = "100.0000 % agree if lengths are in thousandths of the mesh's unit";
    assert_eq!(why(&|_, number| number), lengths);
    let numbers =
        "all points have the number of return 7: it counts the returns of a footprint, the nearest is 1";
    assert_eq!(why(&|_, _| 7), format!("{lengths}, and {numbers}"));
    let one = why(&|k, number| if k == 9 { 3 } else { number });
    assert_eq!(one, format!("{lengths}; something else is wrong, too"));
}

#[test]
fn numbers_of_returns_from_0_are_told() {
    for keep in [Keep::UpTo(2), Keep::UpTo(3)] {
        let trial = Trial::of_room(&still(), keep);
        // Of three returns two may be told, with the numbers 1 and 3: from 0 they are 0 and 2.
        let from = |by: i64| -> Vec<Point> {
            let of = |point: Point| Point { number: (i64::from(point.number) + by) as u32, ..point };
            trial.right().into_iter().filter(|point| point.place.is_finite()).map(of).collect()
        };
        let check = |points: &[Point]| {
            trial.check(&trial.write(points, Fields::Numbers), Precision::F64).expect("a check")
        };
        expect(&check(&from(-1)), "if the numbers of returns count from 0: the nearest is 1");
        let from_two = check(&from(1));
        assert!(!from_two.passes() && from_two.why.is_none(), "{:?}", from_two.why);
    }
}
