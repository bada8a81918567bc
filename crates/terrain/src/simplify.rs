//! A ground with fewer faces, within a vertical distance of every post: right-triangulated irregular networks.
//!
//! Evans, Kirkpatrick and Townsend, "Right-Triangulated Irregular Networks", Algorithmica 30 (2001), first 1997.
//! Squares of cells are halved into right triangles, those again and again at the middle of their hypotenuse,
//! down to half a cell; a triangle is cut where it must be. A middle point that must be cut is marked once for
//! both triangles that share it, and marks those above it: hence no cracks.
//!
//! DIFFERENCE: the paper (and programs after it, such as martini) bounds the error at a triangle's middle point
//! by those below it. Here every post inside a triangle is held to the triangle's own plane, so that the bound
//! is one on the ground and not on the steps to it; and a triangle that is partly a hole must be cut, so that
//! the ground ends exactly where that of all posts does.

use raypencil_scene::Material;

use crate::{Ground, Posts};

/// Cells along the side of the largest squares. CHOICE: two faces for 65536 cells are few enough, and small
/// squares fit a grid of any shape.
const MAX_SQUARE_CELLS: u32 = 256;

/// Rounding of the height of a plane above a post, relative to the largest height in it: with u = 2^-53, corner
/// differences, their products with cell counts, their quotient (by a power of two, exact) and the sum are off by
/// at most 55 u times the largest height, and the post's own difference by u more. 128 u is more than that.
const RELATIVE_ROUNDING: f64 = 128.0 / 9_007_199_254_740_992.0;

/// The ground of [`Posts::ground`] with fewer faces. It covers the same cells; above and below it every post
/// that belongs to such a cell is at most `max_error` metres away, measured along z. Vertices are posts.
///
/// The bound holds for the `f64` vertices. The same posts give the same ground on any machine.
///
/// # Panics
/// If `heights` are not as many as `columns` and `rows` say, or 2^31 or more; if `max_error` is not above zero.
pub fn simplify(posts: &Posts, max_error: f64, material: Material) -> Ground {
    assert!(max_error > 0.0, "a bound above zero");
    assert!(posts.heights.len() < 1 << 31, "fewer than 2^31 posts");
    let faces = match TriangleNetwork::new(posts, max_error) {
        Some(mut network) => {
            network.mark_cuts();
            network.faces()
        }
        None => Vec::new(),
    };
    posts.ground_from_faces(faces, material)
}

/// A point of the grid of posts, or beyond its far borders: column and row.
type GridPoint = [u32; 2];

/// A right triangle: the corner of the right angle, and the ends of the hypotenuse.
#[derive(Clone, Copy)]
struct Triangle {
    apex: GridPoint,
    hypotenuse: [GridPoint; 2],
}

impl Triangle {
    /// The middle of the hypotenuse, if it is a point of the grid.
    fn middle(&self) -> Option<GridPoint> {
        let [[a, b], [c, d]] = self.hypotenuse;
        ((a + c) % 2 == 0 && (b + d) % 2 == 0).then(|| [(a + c) / 2, (b + d) / 2])
    }

    /// The two halves, given the middle of the hypotenuse.
    fn halves(&self, middle: GridPoint) -> [Self; 2] {
        self.hypotenuse.map(|end| Self { apex: middle, hypotenuse: [self.apex, end] })
    }

    /// A cell that the triangle covers some of: the one of its centroid, or beside it if that is on a border.
    fn covered_cell(&self) -> GridPoint {
        let [a, b] = self.hypotenuse;
        [0, 1].map(|axis| (self.apex[axis] + a[axis] + b[axis]) / 3)
    }

    /// The corners counter-clockwise seen from above, if columns run to the right and rows away.
    fn counter_clockwise(&self) -> [GridPoint; 3] {
        let [a, b] = self.hypotenuse;
        match area(self.apex, a, b) > 0 {
            true => [self.apex, a, b],
            false => [self.apex, b, a],
        }
    }
}

/// Twice the signed area, cells.
fn area(a: GridPoint, b: GridPoint, c: GridPoint) -> i64 {
    let from_a = |p: GridPoint| [i64::from(p[0]) - i64::from(a[0]), i64::from(p[1]) - i64::from(a[1])];
    let ([bx, by], [cx, cy]) = (from_a(b), from_a(c));
    bx * cy - by * cx
}

struct TriangleNetwork<'a> {
    posts: &'a Posts,
    max_error: f64,
    /// Whether each cell has four known corners, row by row.
    complete: Vec<bool>,
    /// Cells along the side of the largest squares: a power of two.
    square: u32,
    /// How many of those cover the grid, along x and y.
    squares: [u32; 2],
    /// Points along x of the grid that the squares cover.
    stride: usize,
    /// Whether triangles with their middle at that point must be cut.
    cut: Vec<bool>,
}

impl<'a> TriangleNetwork<'a> {
    /// `None` if there is no cell.
    fn new(posts: &'a Posts, max_error: f64) -> Option<Self> {
        let cells = [posts.columns.checked_sub(1)?, posts.rows.checked_sub(1)?];
        let least = cells[0].min(cells[1]);
        // The power of two at or below the shorter side: beyond the grid there is never more than within.
        let square = (1 << least.checked_ilog2()?).min(MAX_SQUARE_CELLS);
        let squares = cells.map(|count| count.div_ceil(square));
        let [width, height] = squares.map(|count| (count * square) as usize + 1);
        let complete = (0..cells[1])
            .flat_map(|row| (0..cells[0]).map(move |column| posts.is_complete(column, row)))
            .collect();
        let cut = vec![false; width * height];
        Some(Self { posts, max_error, complete, square, squares, stride: width, cut })
    }

    fn index(&self, [column, row]: GridPoint) -> usize {
        row as usize * self.stride + column as usize
    }

    /// Whether the cell with that near left corner is ground. Beyond the grid there is none.
    fn is_ground(&self, [column, row]: GridPoint) -> bool {
        let cells = self.posts.columns - 1;
        column < cells
            && row < self.posts.rows - 1
            && self.complete[row as usize * cells as usize + column as usize]
    }

    /// Marks every middle point that must be cut, from the smallest triangles to the largest, so that what is
    /// marked below is known above.
    fn mark_cuts(&mut self) {
        let [across, away] = self.squares.map(|count| count * self.square);
        let mut side = 2;
        while side <= self.square {
            let corners = |side: u32| {
                (0..away / side)
                    .flat_map(move |q| (0..across / side).map(move |p| [p, q, p * side, q * side]))
            };
            // Quarters of a square, with its sides for hypotenuses; then halves, with a diagonal.
            for [_, _, x, y] in corners(side) {
                let apex = [x + side / 2, y + side / 2];
                let around = [[x, y], [x + side, y], [x + side, y + side], [x, y + side]];
                for k in 0..4 {
                    self.mark_triangle(Triangle { apex, hypotenuse: [around[k], around[(k + 1) % 4]] });
                }
            }
            for [p, q, x, y] in corners(side) {
                halves_of_square(p, q, x, y, side).into_iter().for_each(|half| self.mark_triangle(half));
            }
            side *= 2;
        }
    }

    /// Marks the middle of a triangle if it must be cut.
    fn mark_triangle(&mut self, triangle: Triangle) {
        let Some(middle) = triangle.middle() else { return };
        let at = self.index(middle);
        if self.cut[at] {
            return;
        }
        let halves = triangle.halves(middle);
        let is_cut = |half: &Triangle| half.middle().is_some_and(|middle| self.cut[self.index(middle)]);
        // A half that is not cut is all ground or all hole: any of its cells tells which.
        let [near, far] = halves.map(|half| self.is_ground(half.covered_cell()));
        self.cut[at] = halves.iter().any(is_cut) || near != far || near && !self.is_within_bound(triangle);
    }

    /// Whether every post of a triangle that is all ground lies near enough to its plane.
    fn is_within_bound(&self, triangle: Triangle) -> bool {
        let Triangle { apex, hypotenuse: [a, b] } = triangle;
        let height = |[column, row]: GridPoint| self.posts.height(column, row);
        let away = |p: GridPoint| [0, 1].map(|axis| f64::from(p[axis]) - f64::from(apex[axis]));
        let (origin, [ax, ay], [bx, by]) = (height(apex), away(a), away(b));
        let (rise_a, rise_b) = (height(a) - origin, height(b) - origin);
        // The plane's rise for a column and for a row. The determinant is a power of two.
        let determinant = ax * by - ay * bx;
        let for_column = (rise_a * by - rise_b * ay) / determinant;
        let for_row = (rise_b * ax - rise_a * bx) / determinant;
        let largest = origin.abs().max(height(a).abs()).max(height(b).abs());

        let corners = [apex, a, b];
        let [low, high] = [corners.map(|p| p[1]).into_iter().min(), corners.map(|p| p[1]).into_iter().max()]
            .map(Option::unwrap_or_default);
        (low..=high).all(|row| {
            let (first, last) = column_range(corners, row);
            let start = row as usize * self.posts.columns as usize;
            let heights = &self.posts.heights[start + first as usize..=start + last as usize];
            let on_row = origin + for_row * (f64::from(row) - f64::from(apex[1]));
            let from = f64::from(first) - f64::from(apex[0]);
            heights.iter().enumerate().all(|(step, &post)| {
                let plane = on_row + for_column * (from + step as f64);
                let allowance = RELATIVE_ROUNDING * largest.max(post.abs());
                (plane - post).abs() + allowance <= self.max_error
            })
        })
    }

    /// The triangles that are ground and need not be cut, as posts, square by square.
    fn faces(&self) -> Vec<[u32; 3]> {
        let mut faces = Vec::new();
        for q in 0..self.squares[1] {
            for p in 0..self.squares[0] {
                let halves = halves_of_square(p, q, p * self.square, q * self.square, self.square);
                let mut stack = vec![halves[1], halves[0]];
                while let Some(triangle) = stack.pop() {
                    match triangle.middle() {
                        Some(middle) if self.cut[self.index(middle)] => {
                            let [first, second] = triangle.halves(middle);
                            stack.extend([second, first]);
                        }
                        _ if self.is_ground(triangle.covered_cell()) => {
                            let post = |[column, row]: GridPoint| row * self.posts.columns + column;
                            faces.push(triangle.counter_clockwise().map(post));
                        }
                        _ => {}
                    }
                }
            }
        }
        faces
    }
}

/// The halves of square (p, q) of its size, whose near left corner is (x, y). Diagonals alternate, as those of
/// the four squares in a larger one do: they meet in its centre.
fn halves_of_square(p: u32, q: u32, x: u32, y: u32, side: u32) -> [Triangle; 2] {
    let [a, b, c, d] = [[x, y], [x + side, y], [x + side, y + side], [x, y + side]];
    match (p + q).is_multiple_of(2) {
        true => [Triangle { apex: b, hypotenuse: [a, c] }, Triangle { apex: d, hypotenuse: [c, a] }],
        false => [Triangle { apex: a, hypotenuse: [d, b] }, Triangle { apex: c, hypotenuse: [b, d] }],
    }
}

/// The first and last column of a triangle in a row that it reaches. Its sides run along the axes or at 45
/// degrees, so that they cross rows at whole columns.
fn column_range(corners: [GridPoint; 3], row: u32) -> (u32, u32) {
    let (mut first, mut last) = (u32::MAX, 0);
    for k in 0..3 {
        let ([ax, ay], [bx, by]) = (corners[k], corners[(k + 1) % 3]);
        if row < ay.min(by) || row > ay.max(by) {
            continue;
        }
        // A side along the row has both its ends in it; they are ends of the other two sides.
        let column = match (ay == by, (bx > ax) == (by > ay)) {
            (true, _) => continue,
            _ if ax == bx => ax,
            (_, true) => ax.min(bx) + (row - ay.min(by)),
            (_, false) => ax.max(bx) - (row - ay.min(by)),
        };
        (first, last) = (first.min(column), last.max(column));
    }
    (first, last)
}

#[cfg(test)]
#[path = "../tests/unit/simplify.rs"]
mod tests;
