//! Wrong renderers drawn at random: what is told is true, or nothing is told.

use super::candidates::*;
use super::wrong_renderers::{Random, Wrong, MISTAKES, draw};
use raypencil_scene::SensorId;

/// What is told of a wrong renderer; panics with all that is false.
fn told(bench: &Bench, wrong: &Wrong, all_false: &mut Vec<String>) -> String {
    let found = bench.diagnosis(&wrong.candidate);
    all_false.extend(wrong.false_reason(found.as_ref()));
    found.map_or("nothing".into(), |found| found.sentence())
}

#[test]
fn each_mistake_in_the_camera_alone_is_told_truly_or_not_at_all() {
    let (mut lines, mut all_false) = (String::new(), Vec::new());
    for make in MISTAKES {
        let mut wrong = Wrong::right(pyramids());
        wrong.make(pyramids(), *make, SensorId::Camera, &mut Random(7));
        lines += &format!("{}: {}\n", make.0, told(pyramids(), &wrong, &mut all_false));
    }
    println!("{lines}");
    assert!(all_false.is_empty(), "{all_false:#?}");
}

#[test]
fn some_random_wrong_renderers_are_told_truly_or_not_at_all() {
    let mut all_false = Vec::new();
    for seed in 0..12 {
        let bench = if seed % 3 == 0 { walls() } else { pyramids() };
        told(bench, &draw(bench, seed), &mut all_false);
    }
    assert!(all_false.is_empty(), "{all_false:#?}");
}
