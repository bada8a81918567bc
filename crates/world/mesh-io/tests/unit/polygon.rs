//! Polygons are covered by their triangles, each point once, whatever their shape, plane, first corner and direction.
//!
//! The corners are whole numbers, so that the tests decide exactly without the signs that the code uses.

use std::collections::{BTreeMap, BTreeSet};

use super::{Cut, cut, off_its_plane};

type Point = [i64; 2];

/// A plane: its origin, and where a step along either axis of a polygon leads.
type Plane = [[i64; 3]; 3];

const FLAT: Plane = [[0; 3], [1, 0, 0], [0, 1, 0]];

/// Numbers that look random. (Knuth, "The Art of Computer Programming", volume 2: MMIX)
struct Draws(u64);

impl Draws {
    fn below(&mut self, end: i64) -> i64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 33) as i64) % end
    }
}

/// Twice the area of a triangle, above zero if it runs counter-clockwise.
fn area(a: Point, b: Point, c: Point) -> i64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// The sides of a polygon.
fn sides(points: &[Point]) -> impl Iterator<Item = (Point, Point)> {
    points.iter().copied().zip(points.iter().copied().cycle().skip(1))
}

/// A polygon around the origin: corners at any distance, in the order of their directions.
fn star(draws: &mut Draws) -> Vec<Point> {
    // Three corners that surround the origin, so that no turn is half a circle.
    let mut points: Vec<Point> = vec![[25, 1], [-20, 21], [-14, -23]];
    while points.len() < 24 {
        let p = [draws.below(61) - 30, draws.below(61) - 30];
        let is_apart = |q: &Point| area([0; 2], p, *q) != 0 || p[0] * q[0] + p[1] * q[1] < 0;
        if p != [0; 2] && points.iter().all(is_apart) {
            points.push(p);
        }
    }
    let lower_half = |p: Point| p[1] < 0 || (p[1] == 0 && p[0] < 0);
    points.sort_by(|&a, &b| lower_half(a).cmp(&lower_half(b)).then(0.cmp(&area([0; 2], a, b))));
    points
}

/// A comb: teeth of any length on a back, with corners along the straight back.
fn comb(draws: &mut Draws) -> Vec<Point> {
    let teeth = 2 + draws.below(8);
    let mut points: Vec<Point> = (0..2 * teeth).map(|x| [x, 0]).collect();
    for tooth in (0..teeth).rev() {
        let (x, top) = (2 * tooth, 3 + draws.below(20));
        points.extend([[x + 1, top], [x, top]]);
        if tooth > 0 {
            points.extend([[x, 2], [x - 1, 2]]);
        }
    }
    points
}

/// A corridor one wide that winds inwards, with a wall one thick.
fn spiral(draws: &mut Draws) -> Vec<Point> {
    const DIRECTIONS: [Point; 4] = [[1, 0], [0, 1], [-1, 0], [0, -1]];
    let left_of = |[x, y]: Point| [-y, x];
    let longest = 8 + 2 * draws.below(7);
    let mut outer = vec![[0, 0]];
    let mut length = longest;
    for side in 0.. {
        // Three sides of the first length, then two of each.
        if side >= 3 && side % 2 == 1 {
            length -= 2;
        }
        if length < 2 {
            break;
        }
        let [x, y] = outer[outer.len() - 1];
        let [dx, dy] = DIRECTIONS[side % 4];
        outer.push([x + length * dx, y + length * dy]);
    }
    // The other wall: each corner moved to the left of both of its sides.
    let last = outer.len() - 1;
    let inner = (0..=last).rev().map(|k| {
        let around = [k.checked_sub(1), (k < last).then_some(k)];
        let moves = around.into_iter().flatten().map(|side| left_of(DIRECTIONS[side % 4]));
        moves.fold(outer[k], |[x, y], [dx, dy]| [x + dx, y + dy])
    });
    outer.iter().copied().chain(inner.collect::<Vec<_>>()).collect()
}

/// A square with a hole, joined by a bridge, whose ends are there twice.
fn ring(draws: &mut Draws) -> Vec<Point> {
    let [x, y] = [2 + draws.below(10), 2 + draws.below(10)];
    let [w, h] = [1 + draws.below(5), 1 + draws.below(5)];
    let outside = [[0, 0], [20, 0], [20, 20], [0, 20], [0, 0]];
    // The hole runs the other way round.
    let hole = [[x, y], [x, y + h], [x + w, y + h], [x + w, y], [x, y]];
    outside.into_iter().chain(hole).collect()
}

/// Whether two sides of a polygon cross.
fn crosses_itself(points: &[Point]) -> bool {
    let are_apart = |p: i64, q: i64| p.signum() * q.signum() < 0;
    let cross = |(a, b): (Point, Point), (c, d): (Point, Point)| {
        are_apart(area(a, b, c), area(a, b, d)) && are_apart(area(c, d, a), area(c, d, b))
    };
    sides(points)
        .enumerate()
        .any(|(k, one)| sides(points).skip(k + 1).take(points.len() - k - 1).any(|other| cross(one, other)))
}

/// How often a polygon runs around a point that is on none of its sides. (Sunday, 2001)
fn winding(points: &[Point], at: Point) -> i64 {
    sides(points)
        .map(|(a, b)| {
            let is_left = area(a, b, at) > 0;
            match (a[1] <= at[1], b[1] <= at[1]) {
                (true, false) if is_left => 1,
                (false, true) if !is_left => -1,
                _ => 0,
            }
        })
        .sum()
}

/// The polygon in a plane: whole numbers again.
fn placed(points: &[Point], [origin, along, across]: Plane) -> Vec<[f64; 3]> {
    let place =
        |p: &Point| [0, 1, 2].map(|axis| (origin[axis] + p[0] * along[axis] + p[1] * across[axis]) as f64);
    points.iter().map(place).collect()
}

/// The triangles; those of a fan if the polygon is not cut.
fn triangles(points: &[Point], plane: Plane) -> Vec<[Point; 3]> {
    let places = match cut(&placed(points, plane)) {
        Cut::Ears(triangles) => triangles,
        Cut::Fan | Cut::CrossesItself => (2..points.len()).map(|k| [0, k - 1, k]).collect(),
    };
    places.into_iter().map(|triangle| triangle.map(|k| points[k])).collect()
}

/// The triangles cover the polygon, each point once.
///
/// No triangle runs the other way round, and their sides without those that cancel are the sides of the polygon. So the number
/// of triangles around a point is the number of times that the polygon runs around it: one inside, none outside.
fn assert_covered(points: &[Point], plane: Plane) {
    let found = triangles(points, plane);
    assert_eq!(found.len(), points.len() - 2, "{points:?}");
    let mut left_over: BTreeMap<(Point, Point), i32> = BTreeMap::new();
    let mut count = |a: Point, b: Point, by: i32| {
        let (key, by) = if a < b { ((a, b), by) } else { ((b, a), -by) };
        *left_over.entry(key).or_default() += if a == b { 0 } else { by };
    };
    for &[a, b, c] in &found {
        assert!(area(a, b, c) >= 0, "{:?} of {points:?}", [a, b, c]);
        sides(&[a, b, c]).take(3).for_each(|(from, to)| count(from, to, 1));
    }
    sides(points).take(points.len()).for_each(|(from, to)| count(from, to, -1));
    assert!(left_over.values().all(|&left| left == 0), "{points:?}: {found:?}");
    // And by looking: at points of a lattice that lie on no side of a triangle. Tripled, no corner is among them.
    let tripled = |points: &[Point]| points.iter().map(|p| p.map(|x| 3 * x)).collect::<Vec<Point>>();
    let (whole, parts) =
        (tripled(points), found.iter().map(|triangle| tripled(triangle)).collect::<Vec<_>>());
    for x in (-92..92).step_by(9) {
        for y in (-91..92).step_by(9) {
            let on_a_side =
                parts.iter().flat_map(|part| sides(part).take(3)).any(|(a, b)| area(a, b, [x, y]) == 0);
            if !on_a_side {
                let around: i64 = parts.iter().map(|part| winding(part, [x, y])).sum();
                assert_eq!(around, winding(&whole, [x, y]), "{x}/3, {y}/3 in {points:?}");
            }
        }
    }
}

/// The triangles in any order, each with its corners in any order.
fn as_set(triangles: Vec<[Point; 3]>) -> BTreeSet<[Point; 3]> {
    let sorted = |mut triangle: [Point; 3]| {
        triangle.sort();
        triangle
    };
    triangles.into_iter().map(sorted).collect()
}

#[test]
fn two_thousand_polygons_are_covered_in_any_plane() {
    let mut draws = Draws(1);
    let (mut cut_truly, mut corners) = (0, 0);
    for number in 0..2000 {
        let points = match number % 4 {
            0 => star(&mut draws),
            1 => comb(&mut draws),
            2 => spiral(&mut draws),
            _ => ring(&mut draws),
        };
        assert!(!crosses_itself(&points), "the test draws polygons that do not cross themselves: {points:?}");
        let vector = |draws: &mut Draws| [0; 3].map(|_| draws.below(19) - 9);
        let plane = [vector(&mut draws).map(|x| 1000 * x), vector(&mut draws), vector(&mut draws)];
        let [_, a, b] = plane;
        let normal =
            [0, 1, 2].map(|k: usize| a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3]);
        let plane = if normal == [0; 3] || number % 3 == 0 { FLAT } else { plane };
        assert_covered(&points, plane);
        // A corner on a straight side is no ear: a triangle without an area would leave a crack where rounding bends the side.
        if number % 4 == 1 {
            assert!(triangles(&points, plane).iter().all(|&[a, b, c]| area(a, b, c) > 0), "{points:?}");
        }
        cut_truly += usize::from(matches!(cut(&placed(&points, plane)), Cut::Ears(_)));
        corners += points.len();
        // The same triangles, whichever corner the file begins with, and in whichever direction it goes.
        let expected = as_set(triangles(&points, plane));
        let mut turned = points.clone();
        turned.rotate_left(1 + draws.below(points.len() as i64 - 1) as usize);
        assert_eq!(as_set(triangles(&turned, plane)), expected, "{points:?}");
        turned.reverse();
        assert_eq!(as_set(triangles(&turned, plane)), expected, "{points:?}");
    }
    assert!(cut_truly == 2000 && corners > 30_000, "{cut_truly} polygons were cut, {corners} corners");
}

#[test]
fn convex_polygons_stay_fans() {
    let of = |points: &[Point]| cut(&placed(points, FLAT));
    // A square with a corner on a side, a rhombus, a triangle with a corner that is there twice.
    assert_eq!(of(&[[0, 0], [2, 0], [4, 0], [4, 4], [0, 4]]), Cut::Fan);
    assert_eq!(of(&[[0, -3], [2, 0], [0, 3], [-2, 0]]), Cut::Fan);
    assert_eq!(of(&[[0, 0], [3, 0], [3, 0], [0, 3]]), Cut::Fan);
    // On a line, in a plane and across the axes, or all at one point.
    assert_eq!(of(&[[0, 0], [1, 1], [3, 3], [2, 2]]), Cut::Fan);
    let slanted = placed(&[[0, 0], [1, 1], [3, 3], [2, 2]], [[5, 6, 7], [3, -1, 2], [4, 4, -9]]);
    assert_eq!(cut(&slanted), Cut::Fan);
    assert_eq!(of(&[[2, 2]; 5]), Cut::Fan);
}

#[test]
fn corners_that_are_there_twice_hide_no_turn() {
    // A dart whose notch is there two or three times, and one whose first corner is its last.
    for points in [
        &[[0, 0], [2, 1], [2, 1], [4, 0], [2, 6]][..],
        &[[0, 0], [2, 1], [2, 1], [2, 1], [4, 0], [2, 6]],
        &[[2, 1], [4, 0], [2, 6], [0, 0], [2, 1]],
        &[[0, 0], [2, 1], [4, 0], [2, 6], [0, 0]],
    ] {
        assert!(matches!(cut(&placed(points, FLAT)), Cut::Ears(_)), "{points:?}");
        assert_covered(points, FLAT);
    }
}

#[test]
fn polygons_that_cross_themselves_are_told_apart() {
    let mut draws = Draws(2);
    let (mut crossing, mut covered) = (0, 0);
    for number in 0..2000 {
        // Corners as they come: most such polygons cross themselves, and some touch themselves at a corner.
        let mut points: Vec<Point> = (0..4 + number % 4).map(|_| [draws.below(9), draws.below(9)]).collect();
        let twice: i64 = sides(&points).take(points.len()).map(|(a, b)| a[0] * b[1] - a[1] * b[0]).sum();
        if twice < 0 {
            points.reverse();
        }
        let found = cut(&placed(&points, FLAT));
        if crosses_itself(&points) {
            assert_eq!(found, Cut::CrossesItself, "{points:?}");
            crossing += 1;
        } else if found != Cut::CrossesItself {
            assert_covered(&points, FLAT);
            covered += 1;
        }
    }
    assert!(crossing > 500 && covered > 500, "{crossing} cross themselves, {covered} were covered");
    // An hourglass, whose halves cancel; the same through a corner in its middle; a star of five points.
    for points in [
        &[[0, 0], [4, 4], [4, 0], [0, 4]][..],
        &[[0, 0], [2, 2], [4, 4], [4, 0], [2, 2], [0, 4]],
        &[[0, 10], [6, -8], [-9, 3], [9, 3], [-6, -8]],
    ] {
        let tilted = [[1, 2, 3], [3, 1, -2], [-1, 5, 4]];
        assert_eq!(cut(&placed(points, FLAT)), Cut::CrossesItself, "{points:?}");
        assert_eq!(cut(&placed(points, tilted)), Cut::CrossesItself, "{points:?}");
    }
}

#[test]
fn a_corner_off_the_plane_is_told_beyond_rounding() {
    let with_corner = |height: f64| [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 2.0, height], [0.0, 2.0, 0.0]];
    // Each corner is a quarter of the height away from the plane between them.
    let distance = off_its_plane(&with_corner(0.4)).expect("bent");
    assert!((distance - 0.1).abs() < 0.005, "{distance}");
    assert_eq!(off_its_plane(&with_corner(0.0)), None);
    // Six decimals; single precision at map coordinates.
    assert_eq!(off_its_plane(&with_corner(1e-6)), None);
    assert!(off_its_plane(&with_corner(2e-5)).is_some());
    let on_a_slope = [[0.0, 0.0], [7.0, 0.1], [8.0, 9.0], [0.3, 8.0]].map(|[x, y]| {
        let (x, y) = (x + 300_000.0, y + 4_000_000.0);
        [x, y, 0.3 * x + 0.1 * y]
    });
    let single = on_a_slope.map(|corner| corner.map(|part| f64::from(part as f32)));
    assert_ne!(single, on_a_slope);
    assert_eq!(off_its_plane(&single), None);
    // What has no plane is not bent.
    assert_eq!(off_its_plane(&[[1.0; 3]; 4]), None);
    // A square of a millimetre that was printed with six decimals, one of which is off.
    let small = |off: f64| [[0.0, 0.0, 0.0], [1e-3, 0.0, 0.0], [1e-3, 1e-3, off], [0.0, 1e-3, 0.0]];
    assert_eq!(off_its_plane(&small(1e-6)), None);
    assert!(off_its_plane(&small(2e-5)).is_some());
}

#[test]
fn a_shallow_notch_at_map_coordinates_is_seen() {
    // Ten million metres away, a corner 2^-20 m inside of the lower side: exact as f64, lost in the product of coordinates.
    let (far, deep) = (10_485_760.0, 1.0 / 1_048_576.0);
    let notched = [[0.0, 0.0], [1.0, deep], [2.0, 0.0], [1.0, 1.0]].map(|[x, y]| [x + far, y + far, 7.0]);
    let Cut::Ears(triangles) = cut(&notched) else { panic!("a notch") };
    // Of four corners with a notch there is one cut: from the notch to the corner across.
    assert!(triangles.iter().all(|triangle| triangle.contains(&1) && triangle.contains(&3)), "{triangles:?}");
    let bulged = [[0.0, 0.0], [1.0, -deep], [2.0, 0.0], [1.0, 1.0]].map(|[x, y]| [x + far, y + far, 7.0]);
    assert_eq!(cut(&bulged), Cut::Fan);
}
