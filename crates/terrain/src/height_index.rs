//! The height of the terrain at many points: faces sorted into the cells of a grid over the plane.

use glam::{DVec2, DVec3};
use raypencil_scene::Mesh;

use crate::height::height_on_triangle;

/// What [`crate::height_at`] says of a mesh, for many points: each query looks at the faces of one cell.
///
/// The faces that look up are copied, 76 bytes each with their place in the grid.
#[derive(Debug, Clone)]
pub struct HeightIndex {
    origin: DVec3,
    /// Lower left corner of the grid, scene frame.
    low: DVec2,
    /// Side of a cell, metres.
    cell: f64,
    columns: usize,
    rows: usize,
    /// Where each cell's faces begin in `faces`, and where the last ends.
    starts: Vec<u32>,
    /// Indices into `corners`, cell by cell, in the order of the mesh.
    faces: Vec<u32>,
    corners: Vec<[DVec3; 3]>,
}

/// Faces are entered this far, metres, beyond their bounding boxes: rounding may put a point on a face that it
/// misses by less. (f64 at 1e7 m is good to 2e-9 m.)
const PADDING_M: f64 = 1e-6;

/// At most this many cells along a side, so that the grid stays within 64 MiB.
const MAX_CELLS_PER_SIDE: f64 = 4096.0;

/// At most this many cells for a face, on average. (One that fits a cell may touch four, and counts as four.)
const MAX_MEAN_CELLS_PER_FACE: f64 = 32.0;

impl HeightIndex {
    /// Sorts the faces of a mesh that look up: about one cell for each.
    pub fn new(mesh: &Mesh) -> Self {
        let corner = |v: u32| {
            let [x, y, z] = mesh.vertices()[v as usize];
            DVec3::new(f64::from(x), f64::from(y), f64::from(z))
        };
        let looks_up = |[a, b, c]: &[DVec3; 3]| (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x) > 0.0;
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
        let one_each = (extent.x * extent.y / corners.len().max(1) as f64).sqrt();
        let mut cell = one_each.max(extent.max_element() / MAX_CELLS_PER_SIDE).max(PADDING_M);
        // Many large faces over one another would be entered in many cells each: then larger cells will do.
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
        // Count, sum up, fill in: two passes over the faces, in their order.
        let cells_of = |index: &Self, (from, to): (DVec2, DVec2)| {
            let (left, bottom) = index.place(from);
            let (right, top) = index.place(to);
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

    /// Column and row of a point of the scene frame, the nearest ones if it is outside.
    fn place(&self, point: DVec2) -> (usize, usize) {
        // A negative number becomes 0.
        let along = |from: f64, count: usize| ((from / self.cell) as usize).min(count - 1);
        (along(point.x - self.low.x, self.columns), along(point.y - self.low.y, self.rows))
    }

    /// Highest point of the terrain above the global point (x, y), global z in metres, as
    /// [`crate::height_at`] gives it; `None` where there is none.
    pub fn height_at(&self, x: f64, y: f64) -> Option<f64> {
        let point = DVec2::new(x - self.origin.x, y - self.origin.y);
        if !point.is_finite() {
            return None;
        }
        let (column, row) = self.place(point);
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
