//! The levels of a relief: shared posts, their radii, and craters on all of them.

use super::*;
use crate::mars::craters::Craters;

fn rough(hurst: f64, rms_at_1_m: f64) -> Roughness {
    Roughness { hurst, rms_at_1_m, octave_gains: Vec::new() }
}

/// Posts 0.2 m apart on 12 x 8 m, about (100, -50).
fn posts(height: impl Fn(f64, f64) -> f64) -> HeightGrid {
    let (columns, rows) = (61, 41);
    let place = |k: u32| (0.2 * f64::from(k % columns), 0.2 * f64::from(k / columns));
    let heights = (0..columns * rows).map(place).map(|(x, y)| height(x, y)).collect();
    HeightGrid { columns, rows, corner: DVec2::new(94.0, -54.0), spacing: DVec2::splat(0.2), heights }
}

fn craters() -> Vec<Crater> {
    Craters { density: 0.1, smallest: 1.0, largest: 4.0 }.draw(DVec2::new(100.0, -50.0), 12.0, 3)
}

#[test]
fn heights_between_posts_are_bilinear() {
    // Posts 2 m apart along x and 4 m along y, with the heights 0 and 1 in the near row, 10 and 21 in the far one. A
    // quarter of the way along x the rows are at 1/4 and 10 + 11/4; half way between these it is 13/2.
    let posts = HeightGrid {
        columns: 2,
        rows: 2,
        corner: DVec2::new(10.0, 20.0),
        spacing: DVec2::new(2.0, 4.0),
        heights: vec![0.0, 1.0, 10.0, 21.0],
    };
    assert_eq!(posts.bilinear(DVec2::new(10.5, 22.0)), 6.5);
    // Outside, the height at the nearest border: 1 at the near right post.
    assert_eq!(posts.bilinear(DVec2::new(99.0, -99.0)), 1.0);
}

#[test]
fn levels_share_their_posts_and_lie_where_they_say() {
    let height = |x: f64, y: f64| 0.3 * x - 0.1 * y * y + 0.02 * x * y;
    let craters = craters();
    assert!(craters.len() > 10);
    let relief = Relief::new(posts(height), 1.0, &rough(0.7, 0.05), 5, &craters, 4);
    let (mut shared, mut own) = (0, 0);
    for level in &relief.fine {
        let first = DVec2::new(f64::from(level.first[0]), f64::from(level.first[1]));
        assert!((relief.posts.corner + level.posts.spacing * first - level.posts.corner).length() < 1e-9);
        for row in 0..level.posts.rows {
            for column in 0..level.posts.columns {
                let post = level.posts.at(column, row);
                let place = (post.truncate() - relief.posts.corner) / relief.posts.spacing;
                let nearest = place.round();
                if (place - nearest).length() > 1e-6 {
                    own += 1;
                    continue;
                }
                // The same ground, whichever level is asked: craters were made in both.
                let coarse = relief.posts.at(nearest.x as u32, nearest.y as u32);
                assert!((coarse - post).length() < 1e-9, "{coarse} and {post}");
                shared += 1;
            }
        }
    }
    // Level 1 of 2.5 m: 2 x (12.5 + 4) posts of level 0 along x, and level 2 of 1 m a half of its posts.
    assert!(shared > 900 && own > 3 * shared, "{shared} shared posts and {own} of their own");
    // By number: (x, y) = 12 * (100, -50) about the corner, the finest posts are 5 cm apart.
    for fine in [[120, 80], [121, 80], [122, 82], [118, 83], [0, 0], [240, 160]] {
        let place = relief.posts.corner + 0.05 * DVec2::new(f64::from(fine[0]), f64::from(fine[1]));
        assert!((relief.at(fine).truncate() - place).length() < 1e-9, "{fine:?}");
        assert!((relief.at(fine).z - relief.height(place)).abs() < 1e-9, "{fine:?}");
    }
}

#[test]
fn cells_are_fine_within_their_radii() {
    let relief = Relief::new(posts(|_, _| 0.0), 1.0, &rough(0.7, 0.0), 5, &[], 4);
    // The middle is (6, 4) m from the corner. Cell (30, 20) has its centre 0.14 m from it; (34, 20) at 0.906 m;
    // (35, 20) at 1.105 m; (42, 20) at 2.502 m.
    let levels = [[30, 20], [34, 20], [35, 20], [41, 20], [42, 20], [0, 0]].map(|cell| relief.level(cell));
    assert_eq!(levels, [2, 2, 1, 1, 0, 0]);
    let plain = Relief::new(posts(|_, _| 0.0), 0.0, &rough(0.7, 0.0), 5, &[], 4);
    assert_eq!((plain.level([30, 20]), plain.fine_window()), (0, [[0; 2]; 2]));
}

#[test]
fn fine_posts_are_smoother_than_the_law_by_the_gain() {
    // On a plane the new posts of level 1 deviate by gain x roughness s^H sqrt(1 - 2^(2H - 2)), s = 0.1 m. With H = 0.5
    // and 0.1 m: 0.25 * 0.1 * 0.31623 * 0.70711 = 5.590e-3 m.
    let relief = Relief::new(posts(|x, _| 0.1 * x), 2.0, &rough(0.5, 0.1), 5, &[], 4);
    let level = &relief.fine[0].posts;
    let mut deviations = Vec::new();
    for row in 0..level.rows {
        for column in 0..level.columns {
            if column % 2 == 1 || row % 2 == 1 {
                let post = level.at(column, row);
                deviations.push(post.z - 0.1 * (post.x - relief.posts.corner.x));
            }
        }
    }
    let count = deviations.len() as f64;
    let rms = (deviations.iter().map(|d| d * d).sum::<f64>() / count).sqrt();
    // The rms of n Gaussian numbers has the relative error 1 / sqrt(2 n): 1.2 % here, of which four are allowed.
    assert!(count > 3500.0 && (rms / 5.590e-3 - 1.0).abs() < 0.05, "{rms} of {count}");
}

#[test]
fn a_young_crater_cuts_an_old_one_in_whatever_order_they_are_listed() {
    let one = |x: f64, diameter: f64, degradation: f64| Crater {
        centre: DVec2::new(x, -50.0),
        diameter,
        degradation,
        ..craters()[0]
    };
    let (old, young) = (one(99.0, 4.0, 0.8), one(101.0, 3.0, 0.1));
    // The old one first, and then the young one, measured from the plane of its rim.
    let mut expected = posts(|_, _| 0.0);
    for crater in [old, young] {
        let plane = crater.plane(&expected);
        crater.carve(&mut expected, plane);
    }
    for listed in [[old, young], [young, old]] {
        let relief = Relief::new(posts(|_, _| 0.0), 0.0, &rough(0.7, 0.05), 5, &listed, 4);
        assert_eq!(relief.posts.heights, expected.heights);
    }
}
