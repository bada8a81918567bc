//! Rocks against the law of their sizes, their places and their bodies.

use super::*;
use crate::ground::tests::assert_closed_and_outward;

/// Number of faces of a rock of that diameter.
pub(in crate::mars) fn faces(diameter: f64) -> usize {
    32 << (2 * (subdivisions(diameter) - 1))
}

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

#[test]
fn rocks_keep_apart_and_out_of_what_is_not_free() {
    let diameters = PATHFINDER.diameters(900.0, 8);
    let free = |place: DVec2, diameter: f64| place.length() > 2.0 + 0.5 * diameter;
    let sites = place_rocks(&diameters, DVec2::ZERO, 30.0, 8, free);
    assert_eq!(sites.len(), diameters.len());
    let touching = |k: usize| {
        let rock = sites[k];
        sites[..k]
            .iter()
            .any(|other| rock.place.distance(other.place) <= 0.5 * (rock.diameter + other.diameter))
    };
    let count = (0..sites.len()).filter(|&k| touching(k)).count();
    // 24 failures in a row need a very full ground: with a fifth covered, they never happen.
    assert_eq!(count, 0);
    assert!(sites.iter().all(|site| free(site.place, site.diameter)));
    assert!(place_rocks(&diameters, DVec2::ZERO, 30.0, 8, |_, _| false).is_empty());
}

#[test]
fn bodies_are_closed_outward_and_as_wide_and_high_as_asked_for() {
    let mut bodies = RockBodies::new(5);
    for k in 0..200 {
        let diameter = 0.05 + 0.01 * f64::from(k);
        let mut ground = Ground::default();
        let centre = DVec3::new(3.0, -2.0, 0.7);
        bodies.add(&mut ground, centre, diameter, 0);
        assert_eq!(ground.faces.len(), faces(diameter));
        assert_closed_and_outward(&ground, 0..ground.faces.len());
        let plan = plan_area(&ground.vertices, &ground.faces);
        let circle = std::f64::consts::FRAC_PI_4 * diameter * diameter;
        assert!((plan / circle - 1.0).abs() < 1e-9, "{plan} for {circle}");
        let heights = ground.vertices.iter().map(|v| (v.z - centre.z) / diameter);
        let (low, high) = heights.fold((0.0_f64, 0.0_f64), |(low, high), z| (low.min(z), high.max(z)));
        assert!((low + 0.35).abs() < 1e-9 && (0.3..0.7001).contains(&high), "{low} to {high}");
    }
}

#[test]
fn the_outline_is_as_large_as_the_faces_say() {
    // The upper side hardly ever folds over itself. The outline, counted on a raster of 2 % of the diameter,
    // therefore equals the sum of the projected faces within 1 %, on the mean of 40 rocks.
    let mut bodies = RockBodies::new(6);
    let mut ratio = 0.0;
    for _ in 0..40 {
        let mut ground = Ground::default();
        bodies.add(&mut ground, DVec3::ZERO, 1.0, 0);
        let triangles: Vec<[DVec2; 3]> =
            ground.faces.iter().map(|f| f.map(|v| ground.vertices[v as usize].truncate())).collect();
        let inside = |p: DVec2| {
            triangles.iter().any(|[a, b, c]| {
                let side = |a: &DVec2, b: &DVec2| (*b - *a).perp_dot(p - *a) >= 0.0;
                side(a, b) && side(b, c) && side(c, a)
            })
        };
        let step = 0.02;
        let raster = (-50..50).flat_map(|i| (-50..50).map(move |j| DVec2::new(f64::from(i), f64::from(j))));
        let count = raster.filter(|&p| inside((p + 0.5) * step)).count();
        ratio += count as f64 * step * step / std::f64::consts::FRAC_PI_4 / 40.0;
    }
    assert!((ratio - 1.0).abs() < 0.01, "{ratio}");
}
