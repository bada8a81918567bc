//! A polygon of a file as triangles: a fan where it is convex, else ears, by exact signs.
//!
//! An ear is a triangle of three neighbouring corners that lies inside the polygon and holds no other corner. Every polygon
//! that does not cross itself has one; what is left when it is cut off is a smaller such polygon. (Meisters, "Polygons have
//! ears", 1975, doi:10.2307/2319703) Signs are those of the coordinates as they are: the polygon is seen along the axis that is
//! nearest to its normal, so that a point loses a coordinate and nothing is rounded. (Shewchuk's `orient2d`, by `robust`)

use std::cmp::Ordering;

use robust::{Coord, orient2d};

/// A corner as it is seen along an axis.
type Corner = Coord<f64>;

/// How a polygon becomes triangles.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Cut {
    /// It is convex, or has no area: a fan around its first corner is as good as any cut.
    Fan,
    /// It is not convex: its triangles, each as the places of its three corners in the polygon, in its direction.
    Ears(Vec<[usize; 3]>),
    /// It crosses itself: nobody can say what is inside of it.
    CrossesItself,
}

/// Cuts a polygon into triangles.
pub(super) fn cut(corners: &[[f64; 3]]) -> Cut {
    let Some(seen) = Seen::along_its_normal(corners) else {
        // Corners on a line enclose nothing. Else there are areas that cancel, like the halves of an hourglass.
        return if is_on_a_line(corners) { Cut::Fan } else { Cut::CrossesItself };
    };
    if seen.is_convex() {
        return Cut::Fan;
    }
    if seen.crosses_itself() {
        return Cut::CrossesItself;
    }
    // Without an ear it crosses itself at a corner. With ears all triangles run the same way, so that no part is covered that the
    // polygon does not run around.
    let Some(mut triangles) = Ears::of(&seen.corners, seen.order_from_smallest()).cut() else {
        return Cut::CrossesItself;
    };
    if seen.is_turned {
        triangles.iter_mut().for_each(|triangle| triangle.reverse());
    }
    Cut::Ears(triangles)
}

/// Whether [`cut`] does not look for ears.
pub(super) fn is_convex_or_flat(corners: &[[f64; 3]]) -> bool {
    Seen::along_its_normal(corners).is_none_or(|seen| seen.is_convex())
}

/// Largest distance of a corner from the polygon's plane that rounding explains, as a share of the largest coordinate. Three
/// coordinates in single precision are off by 2^-24 each, and the plane by as much: 2^-22 for a polygon that is not slender.
/// Tuned above it.
const PLANE_SHARE: f64 = 1.0 / 1_048_576.0;

/// The same for the numbers of a text, which have six decimals as a rule: 0.5e-6 for each of three coordinates, and as much for the
/// plane. In the unit of the file.
const PLANE_OF_SIX_DECIMALS: f64 = 2e-6;

/// The largest distance of a corner from the plane of the polygon, if rounding does not explain it. The plane lies in the middle
/// of the corners, across Newell's normal.
pub(super) fn off_its_plane(corners: &[[f64; 3]]) -> Option<f64> {
    let normal = newell(corners)?;
    let length = normal.iter().map(|part| part * part).sum::<f64>().sqrt();
    let origin = corners.first()?;
    let dot =
        |corner: &[f64; 3]| -> f64 { (0..3).map(|axis| normal[axis] * (corner[axis] - origin[axis])).sum() };
    let middle = corners.iter().map(dot).sum::<f64>() / corners.len() as f64;
    let distance = corners.iter().map(|corner| (dot(corner) - middle).abs()).fold(0.0, f64::max) / length;
    let largest = corners.as_flattened().iter().fold(0.0, |largest: f64, part| largest.max(part.abs()));
    (distance > PLANE_SHARE * largest + PLANE_OF_SIX_DECIMALS).then_some(distance)
}

/// Newell's normal: twice the areas of the polygon's shadows along the three axes. `None` if all are zero, or beyond a number's
/// range.
fn newell(corners: &[[f64; 3]]) -> Option<[f64; 3]> {
    let mut normal = [0.0; 3];
    // From one corner, so that ground at map coordinates keeps its digits.
    let origin = corners.first()?;
    let from_origin = |corner: &[f64; 3]| [0, 1, 2].map(|axis| corner[axis] - origin[axis]);
    for (a, b) in corners.iter().zip(corners.iter().cycle().skip(1)) {
        let (a, b) = (from_origin(a), from_origin(b));
        for axis in 0..3 {
            let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
            normal[axis] += a[u] * b[v] - a[v] * b[u];
        }
    }
    let largest = normal.iter().fold(0.0, |largest: f64, part| largest.max(part.abs()));
    (largest > 0.0 && normal.iter().all(|part| part.is_finite())).then_some(normal)
}

/// Whether all corners lie on one line, exactly.
fn is_on_a_line(corners: &[[f64; 3]]) -> bool {
    let Some(first) = corners.first() else { return true };
    let Some(second) = corners.iter().find(|corner| *corner != first) else { return true };
    let seen =
        |corner: &[f64; 3], axis: usize| Coord { x: corner[(axis + 1) % 3], y: corner[(axis + 2) % 3] };
    let is_on = |corner, axis| orient2d(seen(first, axis), seen(second, axis), seen(corner, axis)) == 0.0;
    corners.iter().all(|corner| (0..3).all(|axis| is_on(corner, axis)))
}

/// A polygon as it is seen along an axis.
struct Seen {
    /// The corners, in the order of the file, without the coordinate along the axis.
    corners: Vec<Corner>,
    /// Their places, so that the polygon runs counter-clockwise.
    order: Vec<usize>,
    /// Whether this order is against that of the file.
    is_turned: bool,
}

impl Seen {
    /// Seen along the axis that is nearest to its normal; `None` if it has none.
    fn along_its_normal(corners: &[[f64; 3]]) -> Option<Self> {
        let normal = newell(corners)?;
        let axis = (0..3).max_by(|&a, &b| normal[a].abs().total_cmp(&normal[b].abs()))?;
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        // -0 is 0, so that equal corners are ordered alike.
        let corners: Vec<Corner> =
            corners.iter().map(|corner| Coord { x: corner[u] + 0.0, y: corner[v] + 0.0 }).collect();
        let is_turned = normal[axis] < 0.0;
        let mut order: Vec<usize> = (0..corners.len()).collect();
        if is_turned {
            order.reverse();
        }
        Some(Self { corners, order, is_turned })
    }

    /// The order, from the smallest corner on: one polygon has one such order, whichever corner and direction its file begins with.
    fn order_from_smallest(&self) -> Vec<usize> {
        let count = self.order.len();
        let corners_from = |first: usize| (0..count).map(move |step| self.at(first + step));
        // Where two corners are at one point, those that follow decide.
        let compare = |a: usize, b: usize| {
            let pairs = corners_from(a).zip(corners_from(b));
            let mut orders = pairs.map(|(a, b)| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
            orders.find(|order| order.is_ne()).unwrap_or(Ordering::Equal)
        };
        let first = (0..count).min_by(|&a, &b| compare(a, b)).unwrap_or(0);
        let mut order = self.order.clone();
        order.rotate_left(first);
        order
    }

    /// The corner at a place of the order, which goes round and round.
    fn at(&self, place: usize) -> Corner {
        self.corners[self.order[place % self.order.len()]]
    }

    /// Whether it turns to the left at each corner, or goes straight on, and once around.
    fn is_convex(&self) -> bool {
        // A side without length has no direction: a turn may hide between two corners at one point.
        let position = |corner: &Corner| (corner.x, corner.y);
        let mut ring: Vec<Corner> = (0..self.order.len()).map(|place| self.at(place)).collect();
        ring.dedup_by_key(|corner| position(corner));
        while ring.len() > 1 && position(&ring[0]) == position(&ring[ring.len() - 1]) {
            ring.pop();
        }
        let at = |k: usize| ring[k % ring.len()];
        let turns_right = (0..ring.len()).any(|k| orient2d(at(k), at(k + 1), at(k + 2)) < 0.0);
        // A star turns to the left too; its sides change between rightwards and leftwards more than twice.
        let rightwards = |k: usize| position(&at(k + 1)) > position(&at(k));
        let changes = (0..ring.len()).filter(|&k| rightwards(k) != rightwards(k + 1)).count();
        !turns_right && changes <= 2
    }

    /// Whether two of its sides cross, each beyond the line of the other.
    fn crosses_itself(&self) -> bool {
        let mut sides: Vec<[Corner; 2]> = (0..self.order.len())
            .map(|place| [self.at(place), self.at(place + 1)])
            .map(|[a, b]| if a.x <= b.x { [a, b] } else { [b, a] })
            .collect();
        // From left to right, so that a side is compared with those alone that begin before it ends.
        sides.sort_by(|[a, _], [b, _]| a.x.total_cmp(&b.x));
        let are_apart = |p: f64, q: f64| (p < 0.0 && q > 0.0) || (p > 0.0 && q < 0.0);
        let is_across =
            |[a, b]: [Corner; 2], [c, d]: [Corner; 2]| are_apart(orient2d(a, b, c), orient2d(a, b, d));
        sides.iter().enumerate().any(|(k, &one)| {
            let others = sides[k + 1..].iter().take_while(|other| other[0].x <= one[1].x);
            others.into_iter().any(|&other| {
                let [low, high] = [one[0].y.min(one[1].y), one[0].y.max(one[1].y)];
                let is_beside = other.iter().all(|end| end.y < low) || other.iter().all(|end| end.y > high);
                !is_beside && is_across(one, other) && is_across(other, one)
            })
        })
    }
}

/// A polygon of which ears are cut off.
struct Ears<'a> {
    corners: &'a [Corner],
    /// Corners that are left, in order.
    left: Vec<usize>,
    /// Of each, whether it is known to be the tip of an ear. It stays one until a neighbour is cut off.
    is_ear: Vec<bool>,
}

impl<'a> Ears<'a> {
    fn of(corners: &'a [Corner], order: Vec<usize>) -> Self {
        let is_ear = vec![false; order.len()];
        Self { corners, left: order, is_ear }
    }

    /// The neighbours of the corner at a place, and itself in the middle.
    fn triangle(&self, place: usize) -> [usize; 3] {
        let count = self.left.len();
        [self.left[(place + count - 1) % count], self.left[place], self.left[(place + 1) % count]]
    }

    /// Above zero if the polygon turns to the left at the corner at a place, zero if it goes straight on or back.
    fn turn(&self, place: usize) -> f64 {
        let [a, b, c] = self.triangle(place).map(|k| self.corners[k]);
        orient2d(a, b, c)
    }

    /// Whether the corner at a place is the tip of an ear: the polygon turns to the left there, and no other corner lies in the
    /// triangle or on its border. A corner at the same point as one of the three is the other end of a bridge to a hole.
    fn is_tip(&self, place: usize) -> bool {
        if self.turn(place) <= 0.0 {
            return false;
        }
        let [a, b, c] = self.triangle(place).map(|k| self.corners[k]);
        !self.left.iter().any(|&k| {
            let p = self.corners[k];
            let is_corner = [a, b, c].iter().any(|corner| corner.x == p.x && corner.y == p.y);
            !is_corner && orient2d(a, b, p) >= 0.0 && orient2d(b, c, p) >= 0.0 && orient2d(c, a, p) >= 0.0
        })
    }

    fn look_at(&mut self, places: impl Iterator<Item = usize>) {
        for place in places {
            self.is_ear[place] = self.is_tip(place);
        }
    }

    /// The corner to be cut off next: the tip of an ear; where the rest lies on a line, the tip of a triangle without an area,
    /// which is never hit.
    fn tip(&mut self) -> Option<usize> {
        let known = |ears: &Self| ears.is_ear.iter().position(|&is_ear| is_ear);
        known(self).or_else(|| {
            self.look_at(0..self.left.len());
            known(self).or_else(|| (0..self.left.len()).find(|&place| self.turn(place) == 0.0))
        })
    }

    /// All triangles; `None` if no ear is left, as of a polygon that crosses itself.
    fn cut(mut self) -> Option<Vec<[usize; 3]>> {
        let mut triangles = Vec::with_capacity(self.left.len().saturating_sub(2));
        while self.left.len() > 3 {
            let tip = self.tip()?;
            triangles.push(self.triangle(tip));
            self.left.remove(tip);
            self.is_ear.remove(tip);
            let count = self.left.len();
            self.look_at([(tip + count - 1) % count, tip % count].into_iter());
        }
        triangles.push(self.triangle(1));
        // Turning to the right, the last one would be outside.
        (self.turn(1) >= 0.0).then_some(triangles)
    }
}

#[cfg(test)]
#[path = "../../tests/unit/polygon.rs"]
mod tests;
