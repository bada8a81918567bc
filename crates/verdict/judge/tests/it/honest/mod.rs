//! No honest renderer is called wrong: four programs in both arithmetics, over scenes that are hard for them. What is no rounding
//! is noticed all the same.

mod program;
mod real;
mod scenes;

use std::fmt::Debug;

use raypencil_judge::{Judge, JudgeShare};
use raypencil_referee::Ruling;
use raypencil_scene::{Place, Precision, Scene, SensorId};

use program::{Method, Program};
use real::Real;
use scenes::{Draws, Kind, PENCIL, PIXEL, beside_a_needle, beside_an_occluder, drawn};

fn precision<T: Real>() -> Precision {
    Precision { unit_roundoff: T::UNIT_ROUNDOFF }
}

/// How many answers are right, how many only within rounding, and how many wrong.
#[derive(Debug, Default, Clone, Copy, PartialEq, Eq)]
struct Count {
    right: usize,
    rounded: usize,
    wrong: usize,
}

impl Count {
    fn add(&mut self, ruling: Ruling, what: &dyn Debug) {
        match ruling {
            Ruling::Exact | Ruling::Tie => self.right += 1,
            Ruling::Rounding(_) => self.rounded += 1,
            Ruling::Wrong => {
                self.wrong += 1;
                eprintln!("wrong: {what:?}");
            }
        }
    }
}

/// Rulings on all that a program says about a scene's pencils: the face, whether the camera sees it, and the pixel.
fn pencils<T: Real>(scene: &Scene, method: Method, slack: f64) -> [Count; 3] {
    let (judge, program) = (Judge::new(scene, JudgeShare::All), Program::<T>::new(scene, method, slack));
    let mut counts = [Count::default(); 3];
    for sensor in (0..scene.beams().len()).map(SensorId::Beam) {
        let (columns, rows) = scene.size(sensor).expect("a beam");
        for place in (0..rows).flat_map(|j| (0..columns).map(move |i| Place { sensor, i, j })) {
            let answer = program.answer(scene, place);
            let (face, range) = (answer.map(|answer| answer.face), answer.map(|answer| answer.range));
            let what = (method, place, answer);
            counts[0].add(judge.rule(place, face, range, precision::<T>()), &what);
            let Some(answer) = answer else { continue };
            let (visible, pixel) = (answer.visible, answer.pixel);
            let ruling = judge
                .rule_visibility(place, answer.face, range, visible, pixel, precision::<T>())
                .expect("a pencil");
            counts[1].add(ruling.visible, &what);
            counts[2].add(ruling.pixel, &what);
        }
    }
    counts
}

#[test]
fn honest_programs_are_right_within_rounding() {
    let kinds = [
        (Kind::Soup, 0.0),
        (Kind::Needles, 0.0),
        (Kind::Planks, 0.0),
        (Kind::Shells, 0.0),
        (Kind::Soup, 1e4),
        (Kind::Needles, 1e3),
    ];
    for (kind, far) in kinds {
        for seed in 0..2 {
            let scene = drawn(kind, far, &mut Draws(seed));
            for method in Method::ALL {
                for counts in [pencils::<f32>(&scene, method, 1.0), pencils::<f64>(&scene, method, 1.0)] {
                    let wrong = counts.map(|count| count.wrong);
                    assert_eq!(wrong, [0; 3], "{kind:?} at {far} m, seed {seed}: {method:?}");
                }
            }
        }
    }
}

fn needles<T: Real>(draws: u64) {
    for method in Method::ALL {
        let mut count = Count::default();
        let mut seeds = Draws(1);
        for _ in 0..draws {
            let scene = beside_a_needle(T::UNIT_ROUNDOFF, &mut seeds);
            let judge = Judge::new(&scene, JudgeShare::All);
            let hit = Program::<T>::new(&scene, method, 1.0).hit(&scene, PIXEL);
            let (face, range) = (hit.map(|(face, _)| face), hit.map(|(_, range)| range));
            count.add(judge.rule(PIXEL, face, range, precision::<T>()), &(method, hit));
        }
        assert_eq!(count.wrong, 0, "{method:?}: {count:?}");
        assert!(count.rounded > draws as usize / 20, "{method:?}: {count:?}");
    }
}

#[test]
fn honest_programs_may_take_a_needle_to_end_elsewhere() {
    needles::<f32>(3000);
    needles::<f64>(3000);
}

fn occluders<T: Real>(draws: u64) {
    for method in Method::ALL {
        let mut count = Count::default();
        let mut seeds = Draws(2);
        for _ in 0..draws {
            let scene = beside_an_occluder(T::UNIT_ROUNDOFF, &mut seeds);
            let judge = Judge::new(&scene, JudgeShare::All);
            let Some(answer) = Program::<T>::new(&scene, method, 1.0).answer(&scene, PENCIL) else {
                continue;
            };
            let (range, pixel) = (Some(answer.range), answer.pixel);
            let ruling =
                judge.rule_visibility(PENCIL, answer.face, range, answer.visible, pixel, precision::<T>());
            count.add(ruling.expect("a pencil").visible, &(method, answer));
        }
        assert_eq!(count.wrong, 0, "{method:?}: {count:?}");
        assert!(count.rounded > draws as usize / 50, "{method:?}: {count:?}");
    }
}

#[test]
fn honest_programs_may_take_an_occluder_to_end_elsewhere() {
    occluders::<f32>(2000);
    occluders::<f64>(2000);
}

/// A face through the point does not hide it, however the point is rounded: the contract says so, and a program that keeps the slack
/// that its rounding asks for never breaks it. One that keeps none hides points by the backs of their planks.
#[test]
fn rounding_is_no_excuse_for_the_shadow_of_a_doubled_face() {
    for method in Method::ALL {
        let mut wrong = 0;
        for seed in 0..4 {
            let scene = drawn(Kind::Planks, 0.0, &mut Draws(seed));
            let [hits, visible, pixels] = pencils::<f64>(&scene, method, 0.0);
            assert_eq!((hits.wrong, pixels.wrong), (0, 0));
            wrong += visible.wrong;
        }
        assert!(wrong > 10, "{method:?}: {wrong}");
    }
}
