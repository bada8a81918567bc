//! Crevasses: in all directions, apart from each other, open between their closed ends.

use super::*;

const SETTINGS: Crevasses = Crevasses { count: 3, width: 0.6, depth: 1.0, overhang: 0.2 };

fn field(extent: f64) -> Field {
    Field { extent: DVec2::splat(extent), spacing: DVec2::splat(0.2), free_radius: 1.5 }
}

/// Outline of the opening, counter-clockwise: along the right edge, and back along the left one.
fn outline(crevasse: &Crevasse) -> Vec<DVec2> {
    let right = (0..=crevasse.last()).map(|node| crevasse.wall(node, -1.0, 0.0));
    let left = (1..crevasse.last()).rev().map(|node| crevasse.wall(node, 1.0, 0.0));
    right.chain(left).collect()
}

/// Whether two line segments cross or touch.
fn meet([a, b]: [DVec2; 2], [c, d]: [DVec2; 2]) -> bool {
    let side = |p: DVec2, q: DVec2, r: DVec2| (q - p).perp_dot(r - p);
    side(a, b, c) * side(a, b, d) <= 0.0 && side(c, d, a) * side(c, d, b) <= 0.0
}

#[test]
fn no_opening_meets_itself_or_another() {
    for (width, overhang) in [(0.1, 0.0), (0.6, 0.2), (1.5, 0.5)] {
        for seed in 0..12 {
            let settings = Crevasses { width, overhang, ..SETTINGS };
            let found = settings.draw(&field(40.0), seed);
            assert_eq!(found.len(), 3);
            let outlines: Vec<Vec<DVec2>> = found.iter().map(outline).collect();
            let sides: Vec<(usize, usize, [DVec2; 2])> = (0..outlines.len())
                .flat_map(|k| {
                    let line = &outlines[k];
                    (0..line.len()).map(move |i| (k, i, [line[i], line[(i + 1) % line.len()]]))
                })
                .collect();
            for (n, (k, i, one)) in sides.iter().enumerate() {
                for (other, j, two) in &sides[n + 1..] {
                    let far = one[0].distance(two[0]) > 1.0;
                    let count = outlines[*k].len();
                    let follows = k == other && (i.abs_diff(*j) <= 1 || i.abs_diff(*j) + 1 == count);
                    assert!(
                        far || follows || !meet(*one, *two),
                        "width {width}, seed {seed}: {one:?}, {two:?}"
                    );
                }
            }
        }
    }
}

#[test]
fn they_run_in_all_directions() {
    // The direction from end to end, in twelve sectors of 15 degrees: of 60 crevasses each sector has some.
    let mut sectors = [0; 12];
    for seed in 0..20 {
        for crevasse in SETTINGS.draw(&field(40.0), seed) {
            let along = crevasse.nodes[crevasse.last()] - crevasse.nodes[0];
            // Both ways are one direction.
            let angle = libm::atan2(along.y, along.x).to_degrees().rem_euclid(180.0);
            sectors[(angle / 15.0) as usize % 12] += 1;
        }
    }
    assert!(sectors.iter().all(|&count| count >= 1), "{sectors:?}");
}

#[test]
fn they_stay_on_the_ground_and_off_its_middle() {
    for seed in 0..20 {
        for count in 1..6 {
            for crevasse in (Crevasses { count, ..SETTINGS }).draw(&field(30.0), seed) {
                assert!(!crevasse.overlaps_disc(DVec2::ZERO, 1.5), "{count} crevasses, seed {seed}");
                for place in outline(&crevasse) {
                    assert!(place.abs().max_element() < 15.0 - 0.2 && place.length() > 1.5);
                }
                // A disc that the opening enters, and one that it does not reach: half of 0.6 m, and 0.2 m overhang.
                let node = crevasse.last() / 2;
                let beside = crevasse.nodes[node] + crevasse.left[node] * 0.9;
                assert!(crevasse.overlaps_disc(beside, 0.5) && !crevasse.overlaps_disc(beside, 0.3));
            }
        }
    }
}

#[test]
fn it_is_closed_at_its_ends_and_open_between() {
    for crevasse in SETTINGS.draw(&field(40.0), 4) {
        for (node, open) in [(0, false), (crevasse.last() / 2, true), (crevasse.last(), false)] {
            let [right, left] = [-1.0, 1.0].map(|side| crevasse.wall(node, side, 0.0));
            let depth = crevasse.depth(node);
            let width = (left - right).dot(crevasse.left[node]);
            assert_eq!(open, width > 0.4 && depth > 0.6, "{width} {depth}");
            assert!(open || (width.abs() < 1e-12 && depth.abs() < 1e-12));
        }
        // Never wider than asked for.
        let width = |node| crevasse.wall(node, -1.0, 0.0).distance(crevasse.wall(node, 1.0, 0.0));
        assert!((0..=crevasse.last()).all(|node| width(node) <= 0.6 + 1e-12));
        assert!((0..=crevasse.last()).all(|node| crevasse.depth(node) <= 1.0));
    }
}

#[test]
fn a_full_ground_has_fewer_than_asked_for() {
    let many = Crevasses { count: 1000, width: 2.0, ..SETTINGS }.draw(&field(20.0), 1);
    assert!((1..100).contains(&many.len()), "{}", many.len());
    assert!(Crevasses { width: 50.0, ..SETTINGS }.draw(&field(20.0), 1).is_empty());
}
