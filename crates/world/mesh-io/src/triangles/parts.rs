//! Vertices and faces while a file is read, and the limits of both.

use raypencil_files::Fault;

use crate::triangles::polygon::{self, Cut};
use crate::triangles::polygon_facts::PolygonFacts;

/// Maximum number of corners of a polygon that is not convex: the time to cut it grows with their square.
const MAX_CONCAVE_CORNERS: usize = 10_000;

/// Maximum magnitude of a coordinate: that of [`raypencil_scene::Triangles`].
pub(crate) const MAX_COORDINATE: f64 = 1e30;

/// Vertices, and faces from polygons.
#[derive(Default)]
pub(super) struct Parts {
    pub(super) vertices: Vec<[f64; 3]>,
    pub(super) faces: Vec<[u32; 3]>,
    /// Polygon of each face; `None` as long as every polygon is one triangle.
    pub(super) polygons: Option<Vec<u32>>,
    /// What a file without polygons holds beside its vertices, in words; empty: nothing is known of it.
    pub(super) others: String,
    /// Number of polygons.
    count: u32,
}

impl Parts {
    /// Vertices and faces of a file that has triangles only.
    pub(super) fn of_triangles(vertices: Vec<[f64; 3]>, faces: Vec<[u32; 3]>) -> Self {
        let count = faces.len() as u32;
        Self { vertices, faces, polygons: None, others: String::new(), count }
    }

    /// Adds a polygon of three or more corners as a fan around its first. Its vertices may follow.
    pub(super) fn add_polygon(&mut self, corners: &[u32]) {
        let &[first, ref others @ ..] = corners else { return };
        if corners.len() > 3 && self.polygons.is_none() {
            self.polygons = Some((0..self.count).collect());
        }
        for side in others.windows(2) {
            self.faces.push([first, side[0], side[1]]);
            if let Some(polygons) = &mut self.polygons {
                polygons.push(self.count);
            }
        }
        self.count += 1;
    }

    /// Cuts the polygons that are not convex truly, once all vertices are known. Their fans may lie outside of them. Returns what
    /// was found out about the polygons.
    ///
    /// # Errors
    /// The polygon that has too many corners.
    pub(super) fn cut_concave_polygons(&mut self) -> Result<PolygonFacts, Fault> {
        let mut facts = PolygonFacts::default();
        let Some(polygons) = &self.polygons else { return Ok(facts) };
        let mut corners: Vec<u32> = Vec::new();
        let mut first = 0;
        while let Some(&polygon) = polygons.get(first) {
            let count = polygons[first..].iter().take_while(|&&other| other == polygon).count();
            let faces = &mut self.faces[first..first + count];
            first += count;
            if count == 1 {
                continue;
            }
            // A fan has its polygon's corners in order.
            corners.clear();
            corners.extend(&faces[0][..2]);
            corners.extend(faces.iter().map(|face| face[2]));
            let points: Vec<[f64; 3]> = corners.iter().map(|&k| self.vertices[k as usize]).collect();
            if points.len() > MAX_CONCAVE_CORNERS && !polygon::is_convex_or_flat(&points) {
                let found = format!("{} corners, and it is not convex", points.len());
                let expected =
                    format!("at most {MAX_CONCAVE_CORNERS}; triangulate it in the program that wrote it");
                return Err(Fault::new(format!("polygon {polygon}"), found, expected));
            }
            facts.count += 1;
            match polygon::cut(&points) {
                Cut::Fan => {}
                Cut::Ears(triangles) => {
                    facts.cut += 1;
                    for (face, triangle) in faces.iter_mut().zip(triangles) {
                        *face = triangle.map(|k| corners[k]);
                    }
                }
                Cut::CrossesItself => facts.add_crossing(polygon),
            }
            if let Some(distance) = polygon::off_its_plane(&points) {
                facts.add_bent(polygon, distance);
            }
        }
        Ok(facts)
    }

    /// Number of polygons so far.
    pub(super) fn polygon_count(&self) -> u32 {
        self.count
    }
}

/// A coordinate as it is, if [`raypencil_scene::Triangles`] takes it.
pub(super) fn coordinate(number: f64, place: impl FnOnce() -> String) -> Result<f64, Fault> {
    match number.abs() <= MAX_COORDINATE {
        true => Ok(number),
        false => Err(Fault::new(place(), format!("{number:?}"), "a finite number within 1e30")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn faces_know_their_polygons_once_there_is_a_larger_one() {
        let mut parts = Parts::default();
        parts.add_polygon(&[4, 5, 6]);
        assert_eq!(parts.polygons, None);
        parts.add_polygon(&[0, 1, 2, 3]);
        parts.add_polygon(&[7, 8, 9]);
        assert_eq!(parts.faces, [[4, 5, 6], [0, 1, 2], [0, 2, 3], [7, 8, 9]]);
        assert_eq!(parts.polygons, Some(vec![0, 1, 1, 2]));
        assert_eq!(parts.polygon_count(), 3);
    }
}
