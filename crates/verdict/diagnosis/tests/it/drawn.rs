//! Wrong renderers drawn at random: what is told is true, or nothing is told. The example `wrong_renderers` draws hundreds.

use super::candidates::*;
use super::wrong_renderers::wrong::{Wrong, draw};

#[test]
fn some_random_wrong_renderers_are_told_truly_or_not_at_all() {
    let mut all_false = Vec::new();
    // The last two once had false reasons: two pitches for one focal length, and columns beside a turned sensor for rows.
    for seed in (0..12).chain([348, 1131]) {
        let bench = if seed % 3 == 0 { walls() } else { few_pyramids() };
        let wrong: Wrong = draw(bench, seed);
        all_false.extend(wrong.false_reason(bench.diagnosis(&wrong.candidate).as_ref()));
    }
    assert!(all_false.is_empty(), "{all_false:#?}");
}
