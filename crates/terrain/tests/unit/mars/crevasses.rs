//! Crevasses: rows stay in order, edges and ends meet the grid.

use super::*;

const SETTINGS: Crevasses = Crevasses { count: 3, width: 0.6, depth: 1.0, overhang: 0.2 };

#[test]
fn rows_keep_their_order_however_they_are_bent() {
    for seed in 0..20 {
        for crevasse in SETTINGS.draw([200; 2], DVec2::splat(0.2), seed) {
            for column in 0..=200 {
                let x = 0.2 * f64::from(column) - 20.0;
                let places: Vec<f64> = (0..=200)
                    .map(|row| 0.2 * f64::from(row) - 20.0)
                    .map(|y| y + crevasse.shift(x, y))
                    .collect();
                let least = places.windows(2).map(|pair| pair[1] - pair[0]).fold(1.0, f64::min);
                // At least a third of 0.2 m remains.
                assert!(least > 0.2 / 3.0 - 1e-9, "{least}");
            }
        }
    }
}

#[test]
fn edges_lie_between_the_neighbouring_rows() {
    for seed in 0..20 {
        for crevasse in SETTINGS.draw([200; 2], DVec2::splat(0.2), seed) {
            for column in 0..=200 {
                let x = 0.2 * f64::from(column) - 20.0;
                let [near, far] = [-1.0, 1.0].map(|side| crevasse.wall_y(column, x, side, 0.0));
                assert!(near <= far);
                let neighbour = |row: u32| {
                    let y = 0.2 * f64::from(row) - 20.0;
                    y + crevasse.shift(x, y)
                };
                assert!(neighbour(crevasse.row - 1) < near && far < neighbour(crevasse.row + 1));
            }
        }
    }
}

#[test]
fn it_is_closed_at_its_ends_and_open_between() {
    for crevasse in SETTINGS.draw([200; 2], DVec2::splat(0.2), 4) {
        for (column, open) in [(crevasse.columns.start, false), (100, true), (crevasse.columns.end, false)] {
            let x = 0.2 * f64::from(column) - 20.0;
            let [near, far] = [-1.0, 1.0].map(|side| crevasse.wall_y(column, x, side, 0.0));
            let depth = crevasse.depth(x);
            assert_eq!(open, far - near > 0.3 && depth > 0.5, "{near} {far} {depth}");
            assert!(open || (far - near < 1e-9 && depth < 1e-9));
        }
    }
}

#[test]
fn the_middle_of_the_ground_is_free() {
    for count in 1..6 {
        for seed in 0..20 {
            let settings = Crevasses { count, ..SETTINGS };
            for crevasse in settings.draw([200; 2], DVec2::splat(0.2), seed) {
                assert!(!crevasse.overlaps_disc(DVec2::ZERO, 0.3), "{count} crevasses, seed {seed}");
            }
        }
    }
}
