//! Crater profiles by hand, and the law of their numbers.

use super::*;

fn crater(degradation: f64) -> Crater {
    Crater { centre: DVec2::new(0.3, -0.2), diameter: 10.0, degradation }
}

#[test]
fn a_fresh_crater_by_hand() {
    // 10 m across: the rim at 5 m is 0.4 m high, and the floor is 2 m below it. Half way out the bowl is at 0.4 -
    // 2 (1 - 1/4) = -1.1 m. At 10 m (two radii) the ejecta are 0.4 (1/8 - 1/27) / (26/27) m high.
    let fresh = crater(0.0);
    assert!((fresh.depth() - 2.0).abs() < 1e-12 && (fresh.rim_height() - 0.4).abs() < 1e-12);
    assert!((fresh.profile(5.0) - 0.4).abs() < 1e-12);
    assert!((fresh.profile(0.0) + 1.6).abs() < 1e-12);
    assert!((fresh.profile(2.5) + 1.1).abs() < 1e-12);
    assert!((fresh.profile(10.0) - 0.4 * (19.0 / 216.0) * (27.0 / 26.0)).abs() < 1e-12);
    assert_eq!(fresh.profile(15.0), 0.0);
}

#[test]
fn a_degraded_crater_is_shallow_with_a_level_floor_and_a_round_rim() {
    let old = crater(1.0);
    assert!((old.profile(0.0) - (0.04 - 0.3)).abs() < 1e-12);
    assert_eq!(old.profile(0.0), old.profile(4.0));
    // No kink: the slopes on both sides of the crest differ by little. The fresh crater falls at 0.8 inside.
    let slope = |a: f64, b: f64| (old.profile(b) - old.profile(a)) / (b - a);
    assert!((slope(4.99, 5.0) - slope(5.0, 5.01)).abs() < 0.05);
    assert!(crater(0.0).profile(5.0) - crater(0.0).profile(4.99) > 0.007);
}

#[test]
fn rims_are_as_high_as_they_say() {
    // Steps of 1 mm from half way out to two radii. The crest of a fresh crater is a corner at 5 m. A rounded
    // crest has the right height but for the curvature of bowl and blanket within the rounding: the 2 % is tuned.
    for degradation in [0.0, 0.1, 0.3, 0.5, 0.8, 1.0] {
        let crater = crater(degradation);
        let crest = (2_500..10_000).map(|mm| crater.profile(f64::from(mm) * 1e-3)).fold(0.0, f64::max);
        let ratio = crest / crater.rim_height();
        assert!((ratio - 1.0).abs() < 0.02, "{ratio} at {degradation}");
    }
}

#[test]
fn posts_are_carved_within_reach_only() {
    let flat = HeightGrid {
        columns: 41,
        rows: 31,
        corner: DVec2::new(-20.0, -15.0),
        spacing: DVec2::ONE,
        heights: vec![0.0; 41 * 31],
    };
    let mut carved = flat;
    crater(0.2).carve(&mut carved);
    for row in 0..31 {
        for column in 0..41 {
            let p = carved.at(column, row);
            let expected = crater(0.2).profile((p.truncate() - crater(0.2).centre).length());
            assert_eq!(p.z, expected);
        }
    }
    // A crater far away changes nothing.
    let before = carved.clone();
    Crater { centre: DVec2::new(-1e6, 1e6), ..crater(0.0) }.carve(&mut carved);
    assert_eq!(carved, before);
}

#[test]
fn numbers_follow_the_power_law() {
    let law = Craters { density: 0.05, smallest: 1.0, largest: 20.0 };
    let seeds = 60;
    let all: Vec<Crater> = (0..seeds).flat_map(|seed| law.draw(DVec2::ZERO, 40.0, seed)).collect();
    for diameter in [1.0, 2.0, 4.0] {
        let count = all.iter().filter(|crater| crater.diameter >= diameter).count() as f64;
        // A Poisson number: z is (count - mean) / sqrt(mean).
        let mean = f64::from(seeds as u32) * Craters { smallest: diameter, ..law }.expected(40.0);
        let z = (count - mean) / mean.sqrt();
        assert!(z.abs() < 4.0, "{count} of {mean} above {diameter} m: {z}");
    }
    assert!(all.iter().all(|crater| (1.0..=20.0).contains(&crater.diameter)));
}
