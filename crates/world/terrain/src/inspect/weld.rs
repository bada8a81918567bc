//! Welding: vertices in one place, and unused vertices.

use super::geometry::MeshGeometry;
use super::report::{Inspection, MeshElement, Occurrence};

/// First vertex in the place of each vertex; counts unused and split vertices, and measures the bounds.
pub(super) fn weld(geometry: &MeshGeometry, inspection: &mut Inspection) -> Vec<u32> {
    let vertices = geometry.mesh.vertices();
    let mut used = vec![false; vertices.len()];
    for &vertex in geometry.mesh.faces().as_flattened() {
        used[vertex as usize] = true;
    }
    let index = |index: usize| u32::try_from(index).expect("a mesh has fewer than 2^32 vertices");
    // -0 + 0 = 0; all other numbers are unchanged.
    let bits = |vertex: &[f32; 3]| vertex.map(|coordinate| (coordinate + 0.0).to_bits());
    let mut places: Vec<([u32; 3], u32)> =
        vertices.iter().enumerate().map(|(number, vertex)| (bits(vertex), index(number))).collect();
    places.sort_unstable();
    let mut welded = vec![0; vertices.len()];
    for place in places.chunk_by(|a, b| a.0 == b.0) {
        place.iter().for_each(|&(_, vertex)| welded[vertex as usize] = place[0].1);
    }
    drop(places);
    for (number, (&first, &used)) in welded.iter().zip(&used).enumerate() {
        let vertex = index(number);
        let example = || Occurrence {
            item: MeshElement::Vertex(vertex),
            place: geometry.global(geometry.vertex(vertex)),
        };
        if first != vertex {
            inspection.split_vertices.add(example);
        }
        if used {
            let place = geometry.global(geometry.vertex(vertex));
            let [low, high] = inspection.bounds.unwrap_or([place, place]);
            inspection.bounds = Some([low.min(place), high.max(place)]);
        } else {
            inspection.unused_vertices.add(example);
        }
    }
    welded
}
