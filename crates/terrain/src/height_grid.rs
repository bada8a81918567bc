//! A regular grid of heights: what elevation models are, and what generated relief starts from.

use std::ops::RangeInclusive;

use glam::{DVec2, DVec3};
use raypencil_scene::Material;

use crate::Ground;

/// Heights on a regular grid of points ("posts"), global frame.
#[derive(Debug, Clone, PartialEq)]
pub struct Posts {
    /// Posts along x.
    pub columns: u32,
    /// Posts along y.
    pub rows: u32,
    /// Global x and y of post (0, 0), the one with the least of both, metres.
    pub corner: DVec2,
    /// From a post to the next along x, and along y, metres; both are positive.
    pub spacing: DVec2,
    /// Global z, metres, `columns` of them for each row, the row of least y first; NaN where it is not known.
    pub heights: Vec<f64>,
}

impl Posts {
    /// Where the post of that column and row stands.
    ///
    /// # Panics
    /// If there is no such post.
    pub fn at(&self, column: u32, row: u32) -> DVec3 {
        let place = self.corner + self.spacing * DVec2::new(f64::from(column), f64::from(row));
        place.extend(self.height(column, row))
    }

    /// From the first post to the last along x and along y, metres.
    pub fn extent(&self) -> DVec2 {
        let steps = |count: u32| f64::from(count.saturating_sub(1));
        self.spacing * DVec2::new(steps(self.columns), steps(self.rows))
    }

    /// The posts from `low` to `high` in x and y, global frame, both included; `None` if there are none.
    ///
    /// # Panics
    /// If `heights` are not as many as `columns` and `rows` say.
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

    /// The ground through all posts, all of one material: two faces for each cell between four posts, both
    /// looking up. A cell with a corner that is not known has none, so that what is not known is a hole and
    /// never a cliff; posts that no face uses are left out.
    ///
    /// The ground is empty if no cell has four known corners.
    ///
    /// # Panics
    /// If `heights` are not as many as `columns` and `rows` say, or 2^32 or more.
    pub fn ground(&self, material: Material) -> Ground {
        self.checked_len();
        // CHOICE: three known corners give no face. One triangle would fill half a cell by a diagonal that the
        // missing corner chose; without it the ground ends at whole cells, simplified or not.
        let complete_cells = || {
            let [columns, rows] = [self.columns, self.rows].map(|count| count.saturating_sub(1));
            let cells = (0..rows).flat_map(move |row| (0..columns).map(move |column| (column, row)));
            cells.filter(|&(column, row)| self.is_complete(column, row))
        };
        // Counted first: a list that grows takes up to three times the memory.
        let mut faces = Vec::with_capacity(2 * complete_cells().count());
        for (column, row) in complete_cells() {
            // Counter-clockwise from the near left corner: a b c d.
            let a = row * self.columns + column;
            let (b, c, d) = (a + 1, a + self.columns + 1, a + self.columns);
            let [za, zb, zc, zd] = [a, b, c, d].map(|post| self.heights[post as usize]);
            // CHOICE: the diagonal between the corners that differ less in height, which follows ridges and
            // valleys; of two alike the one from a to c.
            let halves = match (zb - zd).abs() < (za - zc).abs() {
                true => [[a, b, d], [b, c, d]],
                false => [[a, b, c], [a, c, d]],
            };
            faces.extend(halves);
        }
        self.ground_from_faces(faces, material)
    }

    /// The height of a post, NaN if it is not known.
    pub(crate) fn height(&self, column: u32, row: u32) -> f64 {
        self.heights[row as usize * self.columns as usize + column as usize]
    }

    /// Whether the cell whose near left corner is that post has four known corners.
    pub(crate) fn is_complete(&self, column: u32, row: u32) -> bool {
        [(column, row), (column + 1, row), (column, row + 1), (column + 1, row + 1)]
            .into_iter()
            .all(|(column, row)| self.height(column, row).is_finite())
    }

    /// A ground of faces that name posts, counted row by row. Vertices are those posts that a face uses, in the
    /// order of posts.
    pub(crate) fn ground_from_faces(&self, mut faces: Vec<[u32; 3]>, material: Material) -> Ground {
        let count = self.checked_len();
        // First whether a post is used, then its number among those that are.
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

    /// How many posts there are.
    fn checked_len(&self) -> usize {
        let count = u64::from(self.columns) * u64::from(self.rows);
        assert_eq!(self.heights.len() as u64, count, "one height for each post");
        assert!(count <= u64::from(u32::MAX), "a post's number is below 2^32");
        self.heights.len()
    }
}

/// Which of `count` posts along one axis lie from `low` to `high`, both included, if any do: post `k` is at
/// `corner + spacing * k`, evaluated as [`Posts::at`] does it.
pub fn indices_within(
    corner: f64,
    spacing: f64,
    count: u32,
    low: f64,
    high: f64,
) -> Option<RangeInclusive<u32>> {
    let at = |index: u32| corner + spacing * f64::from(index);
    // Places do not fall with the index, so that both ends are found by halving.
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

    fn posts(columns: u32, rows: u32, heights: &[f64]) -> Posts {
        let (corner, spacing) = (DVec2::new(10.0, -5.0), DVec2::new(0.5, 2.0));
        Posts { columns, rows, corner, spacing, heights: heights.to_vec() }
    }

    #[test]
    fn a_cell_is_cut_along_the_flatter_diagonal() {
        // Corners by row: near 0 and 1, far 3 and 0.5. The diagonal near left to far right differs by 0.5 m,
        // the other by 2 m: the first is taken, a-b-c and a-c-d with the vertices numbered by rows.
        let ground = posts(2, 2, &[0.0, 1.0, 3.0, 0.5]).ground(plain());
        assert_eq!(ground.faces, [[0, 1, 3], [0, 3, 2]]);
        assert_eq!(ground.vertices[3], DVec3::new(10.5, -3.0, 0.5));
        // The other way round; and a tie.
        assert_eq!(posts(2, 2, &[1.0, 0.0, 0.5, 3.0]).ground(plain()).faces, [[0, 1, 2], [1, 3, 2]]);
        assert_eq!(posts(2, 2, &[1.0, 0.0, 0.0, 1.0]).ground(plain()).faces, [[0, 1, 3], [0, 3, 2]]);
        assert_eq!(posts(2, 2, &[0.0, 1.0, 2.0, 3.0]).ground(plain()).faces, [[0, 1, 2], [1, 3, 2]]);
    }

    #[test]
    fn the_unknown_is_a_hole() {
        // 4 x 3 posts, the second of the middle row not known: of six cells the four around it go, the two on
        // the right stay, with their six posts.
        let mut heights = [0.0; 12];
        heights[5] = f64::NAN;
        let ground = posts(4, 3, &heights).ground(plain());
        assert_eq!((ground.vertices.len(), ground.faces.len()), (6, 4));
        assert!(ground.vertices.iter().all(|v| v.is_finite() && v.x >= 11.0));
        assert!(ground.faces.iter().all(|&face| normal(&ground, face).z > 0.0));
        // Nothing at all is a ground without faces, and so is a single row.
        assert_eq!(posts(2, 2, &[f64::NAN; 4]).ground(plain()).faces, [[0; 3]; 0]);
        assert_eq!(posts(3, 1, &[0.0; 3]).ground(plain()).vertices, []);
    }

    #[test]
    fn a_window_is_closed() {
        let heights: Vec<f64> = (0..12).map(f64::from).collect();
        let all = posts(4, 3, &heights);
        // x of the posts: 10, 10.5, 11, 11.5; y: -5, -3, -1. From 10.5 to 11.4 there are two columns, from -5 to
        // -3 two rows: posts 1, 2, 5, 6.
        let part = all.crop(DVec2::new(10.5, -5.0), DVec2::new(11.4, -3.0)).unwrap();
        assert_eq!((part.columns, part.rows, part.corner), (2, 2, DVec2::new(10.5, -5.0)));
        assert_eq!(part.heights, [1.0, 2.0, 5.0, 6.0]);
        assert_eq!(all.crop(DVec2::splat(-1e9), DVec2::splat(1e9)).unwrap(), all);
        // Between two posts, beside them, and the wrong way round.
        assert_eq!(all.crop(DVec2::new(10.1, -5.0), DVec2::new(10.4, -3.0)), None);
        assert_eq!(all.crop(DVec2::new(12.0, -5.0), DVec2::new(13.0, -3.0)), None);
        assert_eq!(all.crop(DVec2::new(11.0, -3.0), DVec2::new(10.0, -5.0)), None);
        assert_eq!(all.crop(DVec2::splat(f64::NAN), DVec2::splat(1e9)), None);
    }
}
