//! Regular grid of heights ("posts"): the content of elevation models, and the start of generated relief.

use std::ops::RangeInclusive;

use glam::{DVec2, DVec3};
use raypencil_scene::Material;

use crate::Ground;

/// Heights on a regular grid of points ("posts"), global frame.
///
/// ```
/// use glam::{DVec2, DVec3};
/// use raypencil_scene::Material;
/// use raypencil_terrain::{HeightGrid, height_at, simplify};
///
/// // 9 x 9 posts, 0.5 m apart, on the plane z = x / 4.
/// let heights = (0..81).map(|post| 0.125 * f64::from(post % 9)).collect();
/// let posts =
///     HeightGrid { columns: 9, rows: 9, corner: DVec2::ZERO, spacing: DVec2::splat(0.5), heights };
/// // Column 4, row 2: x = 4 * 0.5 = 2, y = 2 * 0.5 = 1, z = 2 / 4.
/// assert_eq!(posts.at(4, 2), DVec3::new(2.0, 1.0, 0.5));
///
/// let sand = Material { name: "sand".into(), reflectivity: 0.25 };
/// // 8 x 8 cells of two faces; a plane needs only two faces in all.
/// assert_eq!(posts.ground(sand.clone()).faces.len(), 128);
/// let simple = simplify(&posts, 0.01, sand);
/// assert_eq!(simple.faces.len(), 2);
/// assert_eq!(height_at(&simple.into_mesh()?, 2.0, 1.0), Some(0.5));
/// # Ok::<(), raypencil_scene::SceneError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct HeightGrid {
    /// Number of posts along x.
    pub columns: u32,
    /// Number of posts along y.
    pub rows: u32,
    /// Global x and y of post (0, 0), the post of least x and y, metres.
    pub corner: DVec2,
    /// Distance between neighbouring posts along x and along y, metres; both are positive.
    pub spacing: DVec2,
    /// Global z of each post, metres, row by row, the row of least y first; NaN where it is unknown.
    pub heights: Vec<f64>,
}

impl HeightGrid {
    /// Position of a post, global frame, metres.
    ///
    /// # Panics
    /// If the grid has no such post.
    pub fn at(&self, column: u32, row: u32) -> DVec3 {
        let place = self.corner + self.spacing * DVec2::new(f64::from(column), f64::from(row));
        place.extend(self.height(column, row))
    }

    /// Extent of the grid along x and along y, from the first post to the last, metres.
    pub fn extent(&self) -> DVec2 {
        let steps = |count: u32| f64::from(count.saturating_sub(1));
        self.spacing * DVec2::new(steps(self.columns), steps(self.rows))
    }

    /// Posts from `low` to `high` in x and y (global frame, both inclusive); `None` if there are none.
    ///
    /// # Panics
    /// If the number of `heights` differs from `columns * rows`.
    pub fn crop(&self, low: DVec2, high: DVec2) -> Option<Self> {
        self.checked_len();
        let columns = indices_within(self.corner.x, self.spacing.x, self.columns, low.x, high.x)?;
        let rows = indices_within(self.corner.y, self.spacing.y, self.rows, low.y, high.y)?;
        let (column, row) = (*columns.start(), *rows.start());
        let row_of = |row: u32| {
            let first = row as usize * self.columns as usize;
            &self.heights[first + column as usize..=first + *columns.end() as usize]
        };
        Some(Self {
            columns: columns.end() - column + 1,
            rows: rows.end() - row + 1,
            corner: self.corner + self.spacing * DVec2::new(f64::from(column), f64::from(row)),
            spacing: self.spacing,
            heights: rows.clone().flat_map(row_of).copied().collect(),
        })
    }

    /// Ground through all posts, in one material: each cell between four posts has two faces, and both look up.
    ///
    /// A cell with an unknown corner has no faces, so that unknown ground is a hole and never a cliff. Posts that
    /// no face uses are left out. The ground is empty if no cell has four known corners.
    ///
    /// # Panics
    /// If the number of `heights` differs from `columns * rows`, or is 2^32 or more.
    pub fn ground(&self, material: Material) -> Ground {
        self.checked_len();
        // CHOICE: a cell with three known corners has no face. One triangle would fill half of the cell, and the
        // missing corner would choose which half. Without it the ground ends at cell borders, simplified or not.
        let complete_cells = || {
            let [columns, rows] = [self.columns, self.rows].map(|count| count.saturating_sub(1));
            let cells = (0..rows).flat_map(move |row| (0..columns).map(move |column| (column, row)));
            cells.filter(|&(column, row)| self.is_complete(column, row))
        };
        // Counted first: a growing list takes up to three times the memory.
        let mut faces = Vec::with_capacity(2 * complete_cells().count());
        for (column, row) in complete_cells() {
            // Corners a b c d of the cell, counter-clockwise from the near left one.
            let a = row * self.columns + column;
            let (b, c, d) = (a + 1, a + self.columns + 1, a + self.columns);
            let [za, zb, zc, zd] = [a, b, c, d].map(|post| self.heights[post as usize]);
            // CHOICE: the diagonal joins the corners that differ less in height: it follows ridges and valleys.
            // In a tie it runs from a to c.
            let halves = match (zb - zd).abs() < (za - zc).abs() {
                true => [[a, b, d], [b, c, d]],
                false => [[a, b, c], [a, c, d]],
            };
            faces.extend(halves);
        }
        self.ground_from_faces(faces, material)
    }

    /// Height of a post, metres; NaN if it is unknown.
    pub(crate) fn height(&self, column: u32, row: u32) -> f64 {
        self.heights[row as usize * self.columns as usize + column as usize]
    }

    /// Height of the posts' surface at a place, bilinear between the four posts around it; outside, the height at the
    /// nearest border.
    pub(crate) fn bilinear(&self, place: DVec2) -> f64 {
        let locate = |offset: f64, count: u32| {
            let at = offset.clamp(0.0, f64::from(count - 1));
            let cell = (at as u32).min(count.saturating_sub(2));
            (cell, at - f64::from(cell))
        };
        let offset = (place - self.corner) / self.spacing;
        let ((i, s), (j, t)) = (locate(offset.x, self.columns), locate(offset.y, self.rows));
        let post = |i: u32, j: u32| self.at(i, j).z;
        // At a post the result is the post's own height, even if its neighbours are unknown.
        let between = |a: f64, b: f64, share: f64| if share == 0.0 { a } else { a + (b - a) * share };
        let line = |j: u32| if s == 0.0 { post(i, j) } else { between(post(i, j), post(i + 1, j), s) };
        if t == 0.0 { line(j) } else { between(line(j), line(j + 1), t) }
    }

    /// Whether a cell, named by its near left post, has four known corners.
    pub(crate) fn is_complete(&self, column: u32, row: u32) -> bool {
        [(column, row), (column + 1, row), (column, row + 1), (column + 1, row + 1)]
            .into_iter()
            .all(|(column, row)| self.height(column, row).is_finite())
    }

    /// Ground from faces that name posts by number, row by row. Its vertices are the posts that a face uses, in
    /// the order of posts.
    pub(crate) fn ground_from_faces(&self, mut faces: Vec<[u32; 3]>, material: Material) -> Ground {
        let count = self.checked_len();
        // First 1 for each used post, then its vertex number.
        let mut number = vec![0_u32; count];
        faces.as_flattened().iter().for_each(|&post| number[post as usize] = 1);
        let mut vertices = Vec::with_capacity(number.iter().filter(|used| **used == 1).count());
        for row in 0..self.rows {
            for column in 0..self.columns {
                let post = row as usize * self.columns as usize + column as usize;
                if number[post] == 1 {
                    // There are fewer than 2^32 posts.
                    number[post] = vertices.len() as u32;
                    vertices.push(self.at(column, row));
                }
            }
        }
        faces.as_flattened_mut().iter_mut().for_each(|post| *post = number[*post as usize]);
        let face_materials = vec![0; faces.len()];
        Ground { vertices, faces, face_materials, materials: vec![material] }
    }

    /// Number of posts, after a check that it fits `columns`, `rows` and u32.
    fn checked_len(&self) -> usize {
        let count = u64::from(self.columns) * u64::from(self.rows);
        assert_eq!(self.heights.len() as u64, count, "the number of heights must be columns * rows");
        assert!(count <= u64::from(u32::MAX), "the number of posts must be below 2^32");
        self.heights.len()
    }
}

/// Indices of the posts along one axis that lie from `low` to `high`, both inclusive; `None` if there are none.
///
/// Post `k` of `count` stands at `corner + spacing * k`, evaluated as in [`HeightGrid::at`].
///
/// ```
/// use raypencil_terrain::indices_within;
///
/// // Posts at 10, 10.5, 11, 11.5: the second and third lie from 10.5 to 11.4.
/// assert_eq!(indices_within(10.0, 0.5, 4, 10.5, 11.4), Some(1..=2));
/// ```
pub fn indices_within(
    corner: f64,
    spacing: f64,
    count: u32,
    low: f64,
    high: f64,
) -> Option<RangeInclusive<u32>> {
    let at = |index: u32| corner + spacing * f64::from(index);
    // Positions never decrease with the index, so that bisection finds both ends.
    let first_where = |is_beyond: &dyn Fn(f64) -> bool| {
        let (mut from, mut to) = (0, count);
        while from < to {
            let middle = from + (to - from) / 2;
            if is_beyond(at(middle)) { to = middle } else { from = middle + 1 }
        }
        from
    };
    let first = first_where(&|place| place >= low);
    let end = first_where(&|place| place > high);
    (first < end && low <= high).then(|| first..=end - 1)
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::ground::tests::normal;

    pub(crate) fn plain() -> Material {
        Material { name: "ground".into(), reflectivity: 0.25 }
    }

    fn posts(columns: u32, rows: u32, heights: &[f64]) -> HeightGrid {
        let (corner, spacing) = (DVec2::new(10.0, -5.0), DVec2::new(0.5, 2.0));
        HeightGrid { columns, rows, corner, spacing, heights: heights.to_vec() }
    }

    #[test]
    fn a_cell_is_cut_along_the_flatter_diagonal() {
        // Corners by row: near 0 and 1, far 3 and 0.5. The diagonal from near left to far right differs by 0.5 m,
        // the other by 2 m. The first is taken: faces a-b-c and a-c-d, with the vertices numbered row by row.
        let ground = posts(2, 2, &[0.0, 1.0, 3.0, 0.5]).ground(plain());
        assert_eq!(ground.faces, [[0, 1, 3], [0, 3, 2]]);
        assert_eq!(ground.vertices[3], DVec3::new(10.5, -3.0, 0.5));
        // Mirrored, and a tie.
        assert_eq!(posts(2, 2, &[1.0, 0.0, 0.5, 3.0]).ground(plain()).faces, [[0, 1, 2], [1, 3, 2]]);
        assert_eq!(posts(2, 2, &[1.0, 0.0, 0.0, 1.0]).ground(plain()).faces, [[0, 1, 3], [0, 3, 2]]);
        assert_eq!(posts(2, 2, &[0.0, 1.0, 2.0, 3.0]).ground(plain()).faces, [[0, 1, 2], [1, 3, 2]]);
    }

    #[test]
    fn the_unknown_is_a_hole() {
        // 4 x 3 posts, and the second of the middle row is unknown. Four of the six cells touch it and go; the
        // two on the right stay, with their six posts.
        let mut heights = [0.0; 12];
        heights[5] = f64::NAN;
        let ground = posts(4, 3, &heights).ground(plain());
        assert_eq!((ground.vertices.len(), ground.faces.len()), (6, 4));
        assert!(ground.vertices.iter().all(|v| v.is_finite() && v.x >= 11.0));
        assert!(ground.faces.iter().all(|&face| normal(&ground, face).z > 0.0));
        // Unknown posts alone, or a single row, give a ground without faces.
        assert_eq!(posts(2, 2, &[f64::NAN; 4]).ground(plain()).faces, [[0; 3]; 0]);
        assert_eq!(posts(3, 1, &[0.0; 3]).ground(plain()).vertices, []);
    }

    #[test]
    fn a_window_is_closed() {
        let heights: Vec<f64> = (0..12).map(f64::from).collect();
        let all = posts(4, 3, &heights);
        // x of the posts: 10, 10.5, 11, 11.5; y: -5, -3, -1. Two columns lie from 10.5 to 11.4, two rows from -5
        // to -3: posts 1, 2, 5, 6.
        let part = all.crop(DVec2::new(10.5, -5.0), DVec2::new(11.4, -3.0)).unwrap();
        assert_eq!((part.columns, part.rows, part.corner), (2, 2, DVec2::new(10.5, -5.0)));
        assert_eq!(part.heights, [1.0, 2.0, 5.0, 6.0]);
        assert_eq!(all.crop(DVec2::splat(-1e9), DVec2::splat(1e9)).unwrap(), all);
        // Between two posts, beside all posts, and with the bounds exchanged.
        assert_eq!(all.crop(DVec2::new(10.1, -5.0), DVec2::new(10.4, -3.0)), None);
        assert_eq!(all.crop(DVec2::new(12.0, -5.0), DVec2::new(13.0, -3.0)), None);
        assert_eq!(all.crop(DVec2::new(11.0, -3.0), DVec2::new(10.0, -5.0)), None);
        assert_eq!(all.crop(DVec2::splat(f64::NAN), DVec2::splat(1e9)), None);
    }
}
