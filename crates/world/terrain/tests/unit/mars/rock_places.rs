//! Places of rocks: apart from each other, where it is free, and in clusters.

use super::*;
use crate::Rocks;

const PATHFINDER: Rocks = Rocks { coverage: 0.19, smallest: 0.05, largest: 3.0 };

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

/// Variance of the numbers of rocks in squares of 2 m, over their mean; 1 for rocks that lie anywhere.
fn dispersion(sites: &[RockSite], extent: f64) -> f64 {
    let side = (extent / 2.0) as usize;
    let mut counts = vec![0.0; side * side];
    for site in sites {
        let [i, j] = ((site.place + 0.5 * extent) / 2.0).to_array().map(|at| (at as usize).min(side - 1));
        counts[j * side + i] += 1.0;
    }
    let mean = counts.iter().sum::<f64>() / counts.len() as f64;
    counts.iter().map(|count| (count - mean) * (count - mean)).sum::<f64>()
        / (counts.len() as f64 - 1.0)
        / mean
}

#[test]
fn small_rocks_lie_in_clusters_about_large_ones() {
    // For rocks that lie anywhere the index has the standard deviation sqrt(2 / 399) = 0.07 on 400 squares; the limit
    // of 2 is fourteen of them away.
    for seed in 0..5 {
        let diameters = Rocks { coverage: 0.069, ..PATHFINDER }.diameters(1600.0, seed);
        let sites =
            place_rocks(&diameters, DVec2::ZERO, 40.0, seed, |place, _| place.abs().max_element() < 20.0);
        // The largest 64 are the centres: 0.04 on each of 1600 square metres.
        let (centres, others) = sites.split_at(64);
        let found = dispersion(others, 40.0);
        assert!(found > 2.0, "{found}");
        let around = dispersion(centres, 40.0);
        assert!((0.6..1.6).contains(&around), "the centres lie anywhere: {around}");
        // Within 1.5 m of a centre, on 64 pi 1.5^2 / 1600 = 28 % of the ground, lie more than 45 % of the others.
        let near = |site: &&RockSite| centres.iter().any(|centre| centre.place.distance(site.place) < 1.5);
        let share = others.iter().filter(near).count() as f64 / others.len() as f64;
        assert!(share > 0.45, "{share}");
    }
}

#[test]
fn more_rocks_leave_the_larger_ones_where_they_are() {
    let all = |_: DVec2, _: f64| true;
    let few = Rocks { smallest: 0.2, ..PATHFINDER }.diameters(400.0, 3);
    let many = PATHFINDER.diameters(400.0, 3);
    let [few, many] = [few, many].map(|diameters| place_rocks(&diameters, DVec2::ZERO, 20.0, 3, all));
    assert!(many.len() > 2 * few.len());
    assert_eq!(many[..few.len()], few);
}
