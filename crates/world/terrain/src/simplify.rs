//! Ground with fewer faces within a vertical distance of every post: right-triangulated irregular networks.
//!
//! Source: Evans, Kirkpatrick and Townsend, "Right-Triangulated Irregular Networks", Algorithmica 30 (2001),
//! first 1997. Squares of cells are halved into right triangles. These are halved again at the midpoint of their
//! hypotenuse, down to half a cell, wherever the bound requires it. The midpoint is marked once for both
//! triangles that share it, and a mark propagates to the larger triangles: hence there are no cracks.
//!
//! DIFFERENCE: the paper (and programs after it, such as martini) bounds the error at a triangle's midpoint by
//! those below it. Here every post inside a triangle is compared with the triangle's own plane, so that the bound
//! holds for the final ground and not for the steps to it. A triangle that is partly a hole must be cut, so that
//! the ground ends exactly where the ground of all posts ends.

use raypencil_scene::Material;

use crate::{Ground, HeightGrid};

/// Side of the largest squares, cells. CHOICE: two faces for 65536 cells are few enough, and small squares fit a
/// grid of any shape.
const MAX_SQUARE_CELLS: u32 = 256;

/// Bound on the rounding of a plane's height above a post, relative to the largest height involved. With u =
/// 2^-53, corner differences, their products with cell counts, their quotient (by a power of two, exact) and the
/// sum are off by at most 55 u times the largest height; the post's own difference adds u. 128 u is larger.
const RELATIVE_ROUNDING: f64 = 128.0 / 9_007_199_254_740_992.0;

/// Ground of [`HeightGrid::ground`] with fewer faces: it covers the same cells, and its vertices are posts.
///
/// Every post of a covered cell lies within `max_error` metres of the ground, measured along z. The bound holds
/// for the `f64` vertices. The same posts give the same ground on any machine. ([`HeightGrid`] has an example.)
///
/// # Panics
/// If the number of `heights` differs from `columns * rows` or is 2^31 or more; if `max_error` is not above zero.
pub fn simplify(posts: &HeightGrid, max_error: f64, material: Material) -> Ground {
    assert!(max_error > 0.0, "max_error must be above 0 m");
    assert!(posts.heights.len() < 1 << 31, "the number of posts must be below 2^31");
    let faces = match TriangleNetwork::new(posts, max_error) {
        Some(mut network) => {
            network.mark_cuts();
            network.faces()
        }
        None => Vec::new(),
    };
    posts.ground_from_faces(faces, material)
}

/// Column and row of a grid point; it may lie beyond the far borders of the posts.
type GridPoint = [u32; 2];

/// Right triangle: the corner of the right angle, and the ends of the hypotenuse.
#[derive(Clone, Copy)]
struct Triangle {
    apex: GridPoint,
    hypotenuse: [GridPoint; 2],
}

impl Triangle {
    /// Midpoint of the hypotenuse, if it is a grid point.
    fn middle(&self) -> Option<GridPoint> {
        let [[a, b], [c, d]] = self.hypotenuse;
        ((a + c) % 2 == 0 && (b + d) % 2 == 0).then(|| [(a + c) / 2, (b + d) / 2])
    }

    /// The two halves, given the midpoint of the hypotenuse.
    fn halves(&self, middle: GridPoint) -> [Self; 2] {
        self.hypotenuse.map(|end| Self { apex: middle, hypotenuse: [self.apex, end] })
    }

    /// A cell that the triangle covers in part: the cell of its centroid, or the one beside it if the centroid is
    /// on a border.
    fn covered_cell(&self) -> GridPoint {
        let [a, b] = self.hypotenuse;
        [0, 1].map(|axis| (self.apex[axis] + a[axis] + b[axis]) / 3)
    }

    /// Corners counter-clockwise from above, if columns run to the right and rows away.
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
    posts: &'a HeightGrid,
    max_error: f64,
    /// Whether each cell has four known corners, row by row.
    complete: Vec<bool>,
    /// Side of the largest squares, cells: a power of two.
    square: u32,
    /// Number of these squares along x and y that cover the grid.
    squares: [u32; 2],
    /// Points along x of the grid that the squares cover.
    stride: usize,
    /// Whether the triangles with this midpoint must be cut.
    cut: Vec<bool>,
}

impl<'a> TriangleNetwork<'a> {
    /// Network before any cut; `None` if the grid has no cell.
    fn new(posts: &'a HeightGrid, max_error: f64) -> Option<Self> {
        let cells = [posts.columns.checked_sub(1)?, posts.rows.checked_sub(1)?];
        let least = cells[0].min(cells[1]);
        // The largest power of two within the shorter side: the squares cover less than twice the grid each way.
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

    /// Whether a cell, named by its near left corner, is ground. Beyond the grid there is none.
    fn is_ground(&self, [column, row]: GridPoint) -> bool {
        let cells = self.posts.columns - 1;
        column < cells
            && row < self.posts.rows - 1
            && self.complete[row as usize * cells as usize + column as usize]
    }

    /// Marks every midpoint that must be cut, from the smallest triangles to the largest, so that a mark below is
    /// known above.
    fn mark_cuts(&mut self) {
        let [across, away] = self.squares.map(|count| count * self.square);
        let mut side = 2;
        while side <= self.square {
            let corners = |side: u32| {
                (0..away / side)
                    .flat_map(move |q| (0..across / side).map(move |p| [p, q, p * side, q * side]))
            };
            // Quarters of a square, whose hypotenuses are its sides; then halves, whose hypotenuse is a diagonal.
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

    /// Marks the midpoint of a triangle if it must be cut.
    fn mark_triangle(&mut self, triangle: Triangle) {
        let Some(middle) = triangle.middle() else { return };
        let at = self.index(middle);
        if self.cut[at] {
            return;
        }
        let halves = triangle.halves(middle);
        let is_cut = |half: &Triangle| half.middle().is_some_and(|middle| self.cut[self.index(middle)]);
        // An uncut half is all ground or all hole: any of its cells tells which.
        let [near, far] = halves.map(|half| self.is_ground(half.covered_cell()));
        self.cut[at] = halves.iter().any(is_cut) || near != far || near && !self.is_within_bound(triangle);
    }

    /// Whether every post of a triangle that is all ground lies within the bound of its plane.
    fn is_within_bound(&self, triangle: Triangle) -> bool {
        let Triangle { apex, hypotenuse: [a, b] } = triangle;
        let height = |[column, row]: GridPoint| self.posts.height(column, row);
        let away = |p: GridPoint| [0, 1].map(|axis| f64::from(p[axis]) - f64::from(apex[axis]));
        let (origin, [ax, ay], [bx, by]) = (height(apex), away(a), away(b));
        let (rise_a, rise_b) = (height(a) - origin, height(b) - origin);
        // The plane's rise per column and per row. The determinant is a power of two.
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

    /// Faces: the triangles that are ground and need no cut, as post numbers, square by square.
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

/// Halves of square (p, q) of this size, whose near left corner is (x, y). Diagonals alternate, like those of the
/// four squares in a larger one: they meet in its centre.
fn halves_of_square(p: u32, q: u32, x: u32, y: u32, side: u32) -> [Triangle; 2] {
    let [a, b, c, d] = [[x, y], [x + side, y], [x + side, y + side], [x, y + side]];
    match (p + q).is_multiple_of(2) {
        true => [Triangle { apex: b, hypotenuse: [a, c] }, Triangle { apex: d, hypotenuse: [c, a] }],
        false => [Triangle { apex: a, hypotenuse: [d, b] }, Triangle { apex: c, hypotenuse: [b, d] }],
    }
}

/// First and last column of a triangle in a row that it reaches. Its sides run along the axes or at 45 degrees,
/// so they cross rows at whole columns.
fn column_range(corners: [GridPoint; 3], row: u32) -> (u32, u32) {
    let (mut first, mut last) = (u32::MAX, 0);
    for k in 0..3 {
        let ([ax, ay], [bx, by]) = (corners[k], corners[(k + 1) % 3]);
        if row < ay.min(by) || row > ay.max(by) {
            continue;
        }
        // A side along the row has both its ends in it; they are ends of the other two sides as well.
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
