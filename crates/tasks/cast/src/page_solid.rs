//! The mesh of a page: what its points lie on in 3-D, made coarse if it is too large for a page.

use std::collections::HashMap;

use glam::DVec3;
use raypencil_explorer::RasterSolid;
use raypencil_report::count;
use raypencil_scene::Triangles;

use crate::layout::PageScan;
use crate::range_picture::View;

/// Maximum number of faces: it keeps their share of a page to some three megabytes.
const MAX_FACES: usize = 150_000;

/// Cells along the longest side of a mesh, for the first try to make it coarse.
const FIRST_CELLS: f64 = 400.0;

/// The mesh with the axis of it up that is nearest to the sensor's.
pub(crate) fn page_solid(mesh: &Triangles, scan: Option<&PageScan<'_>>) -> RasterSolid {
    let up = scan.map_or(DVec3::Z, |scan| scan.mounting.first().rotate(DVec3::Z));
    let [low, high] = mesh.bounds().unwrap_or_default();
    let origin = 0.5 * low + 0.5 * high;
    let (corners, faces, cell) = coarse(mesh, (high - low).max_element());
    let all = mesh.faces().len();
    let words = match cell {
        None => format!("The mesh has {} faces.", count(all as u64)),
        Some(cell) => format!(
            "The mesh has {} faces. Of these {} are drawn: corners nearer than some {cell:.2} m are one. Points are where they are.",
            count(all as u64),
            count(faces.len() as u64)
        ),
    };
    let vertices = corners.iter().map(|corner| (*corner - origin).as_vec3().to_array()).collect();
    RasterSolid { origin: origin.to_array(), axes: View::along(up).axes(), vertices, faces, words }
}

/// Corners and faces, at most [`MAX_FACES`], and the size of the cells whose corners were made one; `None`: the mesh as it is.
fn coarse(mesh: &Triangles, span: f64) -> (Vec<DVec3>, Vec<[u32; 3]>, Option<f64>) {
    let corners: Vec<DVec3> = mesh.vertices().iter().map(|&corner| DVec3::from_array(corner)).collect();
    if mesh.faces().len() <= MAX_FACES {
        return (corners, mesh.faces().to_vec(), None);
    }
    let mut cells = FIRST_CELLS;
    loop {
        let cell = span / cells;
        let mut kept: Vec<DVec3> = Vec::new();
        let mut of_cell: HashMap<[i64; 3], u32> = HashMap::new();
        let new: Vec<u32> = corners
            .iter()
            .map(|corner| {
                let place = (*corner / cell).floor().to_array().map(|along| along as i64);
                *of_cell.entry(place).or_insert_with(|| {
                    kept.push(*corner);
                    kept.len() as u32 - 1
                })
            })
            .collect();
        let faces = mesh.faces().iter().map(|face| face.map(|corner| new[corner as usize]));
        let faces: Vec<[u32; 3]> = faces.filter(|[a, b, c]| a != b && b != c && c != a).collect();
        if faces.len() <= MAX_FACES {
            return (kept, faces, Some(cell));
        }
        cells *= 0.8;
    }
}

#[cfg(test)]
#[path = "../tests/unit/page_solid.rs"]
mod tests;
