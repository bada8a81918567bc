//! Clouds of beams that have more returns than are told: which of them a simulator tells, in which order, and how it counts them.

use raypencil_cast::{BeamReturn, BeamReturns, Questions, cast};
use raypencil_scene::pattern::{Keep, Mounting};
use raypencil_scene::{Sides, Silent, Triangles};

use super::beam_trial::{Fields, Point, Trial, set_of};
use super::cloud_trial::{expect, still};

/// Two fences round the head, of strips that are narrower than a beam, before a wall: at 3, 3.7 and 4.4 m, so that each of them may be the strongest.
fn fences() -> Triangles {
    let (mut vertices, mut faces) = (Vec::new(), Vec::new());
    let mut strip = |from: f64, to: f64, distance: f64| {
        let first = vertices.len() as u32;
        for (angle, up) in [(from, -9.0), (to, -9.0), (to, 9.0), (from, 9.0)] {
            vertices.push([1.0 + distance * libm::cos(angle), 0.5 + distance * libm::sin(angle), up]);
        }
        faces.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
    };
    for (count, share, distance) in [(131, 0.2, 3.0), (117, 0.4, 3.7), (40, 1.0, 4.4)] {
        for k in 0..count {
            let angle = |turns: f64| core::f64::consts::TAU * turns / f64::from(count);
            strip(angle(f64::from(k)), angle(f64::from(k) + share), distance);
        }
    }
    Triangles::new(vertices, faces).expect("fences")
}

/// A pack that asks for the two strongest returns, and all returns of each beam by range.
fn trial() -> (Trial, Vec<Vec<BeamReturn>>) {
    let at = |mounting: &Mounting| Trial::new(fences(), set_of(mounting, Keep::UpTo(2)));
    let trial = at(&still());
    let set = set_of(&still(), Keep::UpTo(7));
    let answers = cast(&trial.mesh, set.set.rays(), Sides::Both, Questions::default(), &Silent);
    let returns = BeamReturns::of(&answers, &set).expect("returns");
    let all: Vec<Vec<BeamReturn>> =
        returns.told().chunks(7).map(|told| told.iter().flatten().copied().collect()).collect();
    // Beams with three returns, and each choice of two of them.
    let told = |beam: usize| -> Vec<u32> {
        trial.returns.told()[2 * beam..2 * beam + 2].iter().flatten().map(|told| told.number).collect()
    };
    for numbers in [[1, 2], [1, 3], [2, 3]] {
        let of = |beam: &usize| all[*beam].len() == 3 && told(*beam) == numbers;
        let count = (0..all.len()).filter(of).count();
        assert!(count >= 10, "{numbers:?}: {count}");
    }
    (trial, all)
}

/// The points of other returns of each beam, with the numbers by which they are counted.
fn points(trial: &Trial, told: impl Fn(usize) -> Vec<(BeamReturn, u32)>) -> Vec<Point> {
    let right = trial.right();
    let rays = trial.set.set.rays();
    let of_beam = |beam: usize| {
        let empty = Point { place: glam::DVec3::NAN, number: 0, ..right[2 * beam] };
        let pose = trial.set.mounting.at(empty.time).expect("a pose").inverse();
        let of = |(told, number): (BeamReturn, u32)| {
            let ray = &rays[told.ray];
            Point { place: pose * (ray.origin + ray.direction * told.range), number, ..empty }
        };
        let mut points: Vec<Point> = told(beam).into_iter().map(of).collect();
        points.resize(2, empty);
        points
    };
    (0..right.len() / 2).flat_map(of_beam).collect()
}

/// What is told of a cloud with numbers of returns.
fn of_numbers(trial: &Trial, points: &[Point]) -> raypencil_cast::RayPackChecked {
    let dense: Vec<Point> = points.iter().copied().filter(|point| point.place.is_finite()).collect();
    trial.check(&trial.write(&dense, Fields::Numbers), raypencil_scene::Precision::F64).expect("a check")
}

#[test]
fn the_first_and_the_last_ones_in_place_of_the_strongest_are_told() {
    let (trial, all) = trial();
    let with_numbers = |told: &[BeamReturn]| -> Vec<(BeamReturn, u32)> {
        told.iter().map(|told| (*told, told.number)).collect()
    };
    let first = points(&trial, |beam| with_numbers(&all[beam][..all[beam].len().min(2)]));
    trial.expect_why(&first, "if each beam has its 2 first returns: the 2 strongest ones are asked for");
    let last = points(&trial, |beam| with_numbers(&all[beam][all[beam].len().saturating_sub(2)..]));
    trial.expect_why(&last, "if each beam has its 2 last returns: the 2 strongest ones are asked for");
    // Nearer beams tell the first, farther ones the last: that is no rule.
    let mixed: Vec<Point> =
        (0..first.len()).map(|k| if k / 2 % 2 == 0 { first[k] } else { last[k] }).collect();
    for checked in trial.judge_all(&mixed) {
        assert!(!checked.passes() && checked.why.is_none(), "{:?}", checked.why);
    }
}

#[test]
fn numbers_of_some_of_many_returns_are_told_as_they_are_counted() {
    let (trial, all) = trial();
    let told = |beam: usize| -> Vec<BeamReturn> {
        trial.returns.told()[2 * beam..2 * beam + 2].iter().flatten().copied().collect()
    };
    let numbered = |number: &dyn Fn(&[BeamReturn], usize, u32) -> u32| {
        points(&trial, |beam| {
            let (told, most) = (told(beam), all[beam].len() as u32);
            told.iter().enumerate().map(|(at, one)| (*one, number(&told, at, most))).collect()
        })
    };
    let why = |points: &[Point], words: &str| {
        let checked = of_numbers(&trial, points);
        expect(&checked, words);
        let why = checked.why.expect("a reason");
        assert!(why.ends_with(words), "{why}");
    };
    assert!(of_numbers(&trial, &numbered(&|told, at, _| told[at].number)).passes());
    let from_farthest = numbered(&|told, at, most| most + 1 - told[at].number);
    why(&from_farthest, "if the numbers of returns count from the farthest: the nearest is 1");
    let from_zero = numbered(&|told, at, _| told[at].number - 1);
    why(&from_zero, "if the numbers of returns count from 0: the nearest is 1");
    let of_told = numbered(&|_, at, _| at as u32 + 1);
    why(&of_told, "if the numbers count the returns that are told: they count all of the footprint");
    let exchanged = numbered(&|told, at, _| told[told.len() - 1 - at].number);
    why(&exchanged, "if the numbers of the told returns of a beam are exchanged: the nearest has the least");
    // Points in another order in the file are laid by their numbers, whatever these count.
    for right in [&from_farthest, &from_zero, &of_told] {
        let pairs = right.chunks(2);
        let turned: Vec<Point> = pairs.flat_map(|pair| [pair[1], pair[0]]).collect();
        let checked = of_numbers(&trial, &turned);
        let plain = of_numbers(&trial, right);
        assert!(!checked.passes());
        assert_eq!(checked.why, plain.why);
    }
    // Every second beam otherwise is no rule.
    let mixed: Vec<Point> =
        (0..exchanged.len()).map(|k| if k / 2 % 2 == 0 { exchanged[k] } else { from_farthest[k] }).collect();
    let checked = of_numbers(&trial, &mixed);
    assert!(!checked.passes() && checked.why.is_none(), "{:?}", checked.why);
    // Without numbers the order of the points is what is wrong.
    let order: Vec<Point> =
        points(&trial, |beam| told(beam).into_iter().rev().map(|one| (one, one.number)).collect());
    let [by_order, by_keys, by_numbers] = trial.judge_all(&order);
    for checked in [by_order, by_keys] {
        expect(&checked, "if the returns of a beam run from the farthest to the nearest");
    }
    assert!(by_numbers.passes());
}
