//! Height of the terrain at many points: faces sorted into the cells of a grid over the plane.

use glam::{DVec2, DVec3};
use raypencil_scene::Mesh;

use crate::height::{height_on_triangle, looks_up};

/// Index of a mesh for many height queries. Each query visits the faces of one cell and returns exactly what
/// [`crate::height_at`] returns.
///
/// Memory: 76 bytes for each face that looks up, including its grid entries.
///
/// ```
/// use raypencil_terrain::{HeightIndex, builtin, height_at};
///
/// let mesh = builtin("facets", 0.25).expect("a built-in name").into_mesh()?;
/// let index = HeightIndex::new(&mesh);
/// // The same bits as the search through all faces.
/// assert_eq!(index.height_at(1.25, -2.5), height_at(&mesh, 1.25, -2.5));
/// // The facets end before x = 14.2 m.
/// assert_eq!(index.height_at(15.0, 0.0), None);
/// # Ok::<(), raypencil_scene::SceneError>(())
/// ```
#[derive(Debug, Clone)]
pub struct HeightIndex {
    origin: DVec3,
    /// Lower left corner of the grid, scene frame.
    low: DVec2,
    /// Side of a cell, metres.
    cell: f64,
    columns: usize,
    rows: usize,
    /// Start of each cell's list in `faces`, and the end of the last list.
    starts: Vec<u32>,
    /// Indices into `corners`, cell by cell, in the order of the mesh.
    faces: Vec<u32>,
    corners: Vec<[DVec3; 3]>,
}

/// Margin around the bounding box of a face, metres. Rounding may put a point on a face whose box it misses by
/// less. (f64 at 1e7 m has an ulp of 2e-9 m)
const PADDING_M: f64 = 1e-6;

/// Maximum number of cells along a side: keeps the grid within 64 MiB.
const MAX_CELLS_PER_SIDE: f64 = 4096.0;

/// Maximum number of cells per face, on average. (A face that fits into one cell may touch four, and counts as
/// four)
const MAX_MEAN_CELLS_PER_FACE: f64 = 32.0;

impl HeightIndex {
    /// Builds the index, with about one cell for each face that looks up.
    pub fn new(mesh: &Mesh) -> Self {
        let corner = |v: u32| {
            let [x, y, z] = mesh.vertices()[v as usize];
            DVec3::new(f64::from(x), f64::from(y), f64::from(z))
        };
        let corners: Vec<[DVec3; 3]> =
            mesh.faces().iter().map(|face| face.map(corner)).filter(looks_up).collect();
        let boxes = |corners: &[DVec3; 3]| {
            let [a, b, c] = corners.map(DVec3::truncate);
            (a.min(b).min(c) - PADDING_M, a.max(b).max(c) + PADDING_M)
        };
        let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        for (from, to) in corners.iter().map(boxes) {
            (low, high) = (low.min(from), high.max(to));
        }
        if corners.is_empty() {
            (low, high) = (DVec2::ZERO, DVec2::ZERO);
        }
        let extent = high - low;
        let one_face_each = (extent.x * extent.y / corners.len().max(1) as f64).sqrt();
        let mut cell = one_face_each.max(extent.max_element() / MAX_CELLS_PER_SIDE).max(PADDING_M);
        // Many large faces over one another would each enter many cells: the cells grow instead.
        let entries = |cell: f64| {
            let cells = |(from, to): (DVec2, DVec2)| {
                let span = ((to - from) / cell).floor() + 2.0;
                span.x * span.y
            };
            corners.iter().map(boxes).map(cells).sum::<f64>()
        };
        while entries(cell) > MAX_MEAN_CELLS_PER_FACE * corners.len() as f64 {
            cell *= 2.0;
        }
        let count = |length: f64| (length / cell) as usize + 1;
        let (columns, rows) = (count(extent.x), count(extent.y));
        let mut index = Self {
            origin: mesh.origin(),
            low,
            cell,
            columns,
            rows,
            starts: vec![0; columns * rows + 1],
            faces: Vec::new(),
            corners,
        };
        // A counting sort: count, sum up, fill in. Two passes over the faces, in their order.
        let cells_of = |index: &Self, (from, to): (DVec2, DVec2)| {
            let (left, bottom) = index.cell_at(from);
            let (right, top) = index.cell_at(to);
            (bottom..=top)
                .flat_map(move |row| (left..=right).map(move |column| row * columns + column))
                .collect::<Vec<usize>>()
        };
        for corners in &index.corners {
            for cell in cells_of(&index, boxes(corners)) {
                index.starts[cell + 1] += 1;
            }
        }
        for cell in 0..columns * rows {
            index.starts[cell + 1] += index.starts[cell];
        }
        let mut next = index.starts.clone();
        let mut faces = vec![0; index.starts[columns * rows] as usize];
        for (face, corners) in index.corners.iter().enumerate() {
            for cell in cells_of(&index, boxes(corners)) {
                faces[next[cell] as usize] = face as u32;
                next[cell] += 1;
            }
        }
        index.faces = faces;
        index
    }

    /// Column and row of a point of the scene frame; outside the grid, the nearest ones.
    fn cell_at(&self, point: DVec2) -> (usize, usize) {
        // The conversion takes a negative number to 0.
        let along = |from: f64, count: usize| ((from / self.cell) as usize).min(count - 1);
        (along(point.x - self.low.x, self.columns), along(point.y - self.low.y, self.rows))
    }

    /// Highest terrain point above the global point (x, y): global z in metres, equal to [`crate::height_at`];
    /// `None` where no face looks up.
    pub fn height_at(&self, x: f64, y: f64) -> Option<f64> {
        let point = DVec2::new(x - self.origin.x, y - self.origin.y);
        if !point.is_finite() {
            return None;
        }
        let (column, row) = self.cell_at(point);
        let cell = row * self.columns + column;
        let mut highest: Option<f64> = None;
        for &face in &self.faces[self.starts[cell] as usize..self.starts[cell + 1] as usize] {
            if let Some(z) = height_on_triangle(self.corners[face as usize], point) {
                highest = Some(highest.map_or(z, |top| top.max(z)));
            }
        }
        highest.map(|z| self.origin.z + z)
    }
}

#[cfg(test)]
#[path = "../tests/unit/height_index.rs"]
mod tests;
