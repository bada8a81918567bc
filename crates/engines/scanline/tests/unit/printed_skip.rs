//! Unit tests of `printed_skip`: rules 3a, 3b and 3c on projected triangles.

use super::*;

/// A screen from -1 to 1 in x and y.
fn screen() -> SensorScreen {
    SensorScreen::new(&Axis::grid_columns(4, 1.0), &Axis::grid_columns(4, 1.0))
}

fn corners(points: [[f64; 2]; 3]) -> [SppPoint; 3] {
    points.map(|[x, y]| SppPoint { x, y })
}

#[test]
fn rule_3a_needs_all_vertices_beyond_one_side() {
    // All left of x = -1; all above y = -1.
    assert!(screen().skips_by_3a(&corners([[-2.0, 0.0], [-1.1, 5.0], [-9.0, -5.0]])));
    assert!(screen().skips_by_3a(&corners([[-2.0, -1.1], [0.0, -3.0], [5.0, -2.0]])));
    // None in the screen, but not all beyond *one* side. A vertex on the border is not beyond it.
    assert!(!screen().skips_by_3a(&corners([[-2.0, 0.0], [0.0, -2.0], [-2.0, -2.0]])));
    assert!(!screen().skips_by_3a(&corners([[-2.0, 0.0], [-1.0, 5.0], [-9.0, -5.0]])));
}

/// A screen from -1 to 3 in x and from -2 to 4 in y, its centre at (1, 1).
fn oblong() -> SensorScreen {
    SensorScreen::new(&Axis::pixels(4, 1.0, 1.0), &Axis::pixels(6, 2.0, 1.0))
}

#[test]
fn every_side_of_the_screen_counts_and_borders_belong_to_it() {
    // A triangle beside the middle of each side. Its nearest vertex is beyond the border, on it, and within.
    for (step, beside) in [(1e-9, true), (0.0, false), (-1e-9, false)] {
        let left = [[-1.0 - step, 1.0], [-2.0, 0.0], [-2.0, 2.0]];
        let right = [[3.0 + step, 1.0], [4.0, 0.0], [4.0, 2.0]];
        let above = [[1.0, -2.0 - step], [0.0, -3.0], [2.0, -3.0]];
        let below = [[1.0, 4.0 + step], [0.0, 5.0], [2.0, 5.0]];
        for triangle in [left, right, above, below] {
            assert_eq!(oblong().skips_by_3a(&corners(triangle)), beside, "{triangle:?}");
            assert_eq!(oblong().skips_by_3c(&corners(triangle)), beside, "{triangle:?}");
        }
    }
}

#[test]
fn a_side_that_ends_before_the_screen_does_not_intersect_it() {
    let meets = |from: [f64; 2], to: [f64; 2]| {
        let [from, to] = [from, to].map(|[x, y]| SppPoint { x, y });
        (oblong().intersects_side(&from, &to), oblong().intersects_side(&to, &from))
    };
    for (from, to) in [
        ([0.9, -9.0], [1.0, -2.1]),
        ([1.0, 4.1], [0.9, 9.0]),
        ([-9.0, 0.9], [-1.1, 1.0]),
        ([3.1, 1.0], [9.0, 0.9]),
    ] {
        assert_eq!(meets(from, to), (false, false), "{from:?} {to:?}");
    }
    // The same sides, extended to the border and beyond.
    for (from, to) in [
        ([0.9, -9.0], [1.0, -2.0]),
        ([1.0, 4.0], [0.9, 9.0]),
        ([-9.0, 0.9], [9.0, 1.0]),
        ([-2.0, 3.0], [1.0, 5.0]),
    ] {
        assert_eq!(meets(from, to), (true, true), "{from:?} {to:?}");
    }
    // A side that passes the corner (-1, 4) on the outer side: at x = -1 it is at y = 3.9 + 1.5 = 5.4.
    assert_eq!(meets([-2.0, 3.9], [1.0, 8.4]), (false, false));
}

#[test]
fn rule_3c_uses_the_centre_of_the_screen() {
    // Each triangle contains the screen, and little to its left or above it.
    assert!(!oblong().skips_by_3c(&corners([[-1.2, -20.0], [-1.2, 20.0], [30.0, 0.0]])));
    assert!(!oblong().skips_by_3c(&corners([[-20.0, -2.5], [20.0, -2.5], [0.0, 40.0]])));
}

#[test]
fn rule_3b_needs_all_vertices_in_the_screen_and_all_too_far() {
    let in_row = corners([[-1.0, -1.0], [1.0, 0.0], [0.0, 0.5]]);
    assert!(screen().skips_by_3b(&in_row, |_| true));
    assert!(!screen().skips_by_3b(&in_row, |k| k != 1));
    let across = corners([[-1.0, -1.0], [1.1, 0.0], [0.0, 0.5]]);
    assert!(!screen().skips_by_3b(&across, |_| true));
}

#[test]
fn rule_3c_skips_triangles_apart_from_the_screen() {
    // Beyond the corner (1, 1): the side from (3, 0) to (0, 3) is at x + y = 3, and the corner at x + y = 2.
    assert!(screen().skips_by_3c(&corners([[3.0, 0.0], [0.0, 3.0], [3.0, 3.0]])));
    // A side at x + y = 1.9 cuts the corner off.
    assert!(!screen().skips_by_3c(&corners([[1.9, 0.0], [0.0, 1.9], [3.0, 3.0]])));
    let cut = corners([[3.0, -1.1], [-1.1, 3.0], [3.0, 3.0]]);
    assert!(!cut.iter().any(|corner| screen().contains(corner)));
    assert!(!screen().skips_by_3c(&cut));
    // Around the whole screen, in either orientation: no vertex or side meets it, so its centre decides.
    let around = [[-9.0, -3.0], [9.0, -3.0], [0.0, 9.0]];
    assert!(!screen().skips_by_3c(&corners(around)));
    assert!(!screen().skips_by_3c(&corners([around[1], around[0], around[2]])));
}
