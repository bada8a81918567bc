//! Sizes of rocks against their law.

use super::*;

const PATHFINDER: Rocks = Rocks { coverage: 0.19, smallest: 0.05, largest: 3.0 };

#[test]
fn the_law_by_hand() {
    // k = 0.19: q = 1.79 + 0.8 = 2.59 per metre. F(1 m) = 0.19 e^-2.59 = 0.19 * 0.07502 = 0.014254, minus F(3 m)
    // = 0.19 e^-7.77 = 0.0000802.
    assert!((PATHFINDER.decay() - 2.59).abs() < 1e-12);
    assert!((PATHFINDER.cumulative_area(1.0) - 0.014_174).abs() < 2e-6);
}

#[test]
fn covered_areas_follow_the_law() {
    // Compound Poisson: the sum of the areas a of all rocks from D on has the variance of the sum of a^2, and
    // that sum estimates it. The number of seeds makes 3 standard errors at most 5 %.
    for (coverage, seeds) in [(0.069, 320), (0.19, 100), (0.35, 60)] {
        let rocks = Rocks { coverage, ..PATHFINDER };
        let area = 120.0 * 120.0;
        let mut sums = [(0.1, 0.0, 0.0), (0.2, 0.0, 0.0), (0.5, 0.0, 0.0), (1.0, 0.0, 0.0)];
        for seed in 0..seeds {
            let tracked = Rocks { smallest: 0.1, ..rocks };
            for diameter in tracked.diameters(area, seed) {
                let covered = std::f64::consts::FRAC_PI_4 * diameter * diameter;
                for (least, sum, squares) in &mut sums {
                    if diameter >= *least {
                        *sum += covered;
                        *squares += covered * covered;
                    }
                }
            }
        }
        for (least, sum, squares) in sums {
            let expected = rocks.cumulative_area(least) * area * seeds as f64;
            let error = f64::sqrt(squares);
            let z = (sum - expected) / error;
            println!(
                "k {coverage}, D {least}: {:.4} of the law, 3 errors {:.4}, z {z:.2}",
                sum / expected,
                3.0 * error / expected
            );
            assert!(3.0 * error / expected <= 0.05, "too few rocks above {least} m to tell");
            assert!(z.abs() < 4.0, "k {coverage}: {sum} m2 above {least} m for {expected}: {z}");
        }
    }
}

#[test]
fn smaller_rocks_are_added_at_the_end() {
    let coarse = Rocks { smallest: 0.2, ..PATHFINDER }.diameters(400.0, 3);
    let fine = PATHFINDER.diameters(400.0, 3);
    assert!(fine.len() > 2 * coarse.len());
    assert_eq!(fine[..coarse.len()], coarse);
    assert!(fine.is_sorted_by(|a, b| a >= b));
    assert!(Rocks { coverage: 0.0, ..PATHFINDER }.diameters(400.0, 3).is_empty());
}
