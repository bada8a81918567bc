//! What may be wrong with a mesh that rays are cast at.
//!
//! Sorting finds what belongs together: vertices by position, faces by their corners, sides of faces by their
//! ends. Everything takes O(n log n), and some 70 bytes a face. Whether faces run through each other is not asked:
//! that is a search of its own, and no ray minds it.

mod disjoint_sets;
mod duplicates;
mod edges;
mod faces;
mod geometry;
mod patches;
mod report;
mod status;
#[cfg(test)]
#[path = "../../tests/unit/inspect.rs"]
mod tests;
mod weld;

use raypencil_scene::Mesh;

pub use report::{Example, Found, Inspection, Item, OpenEdges, OpenPiece, ZeroAreaKinds};
pub(crate) use status::FaceStatus;

use geometry::MeshGeometry;

/// Looks for everything that an [`Inspection`] tells.
///
/// Vertices in one place count as one, with 0 = -0: so renderers see shared edges. Faces of zero area, which no
/// ray hits, and copies of other faces are counted and then set aside: edges, components, areas and volumes are
/// those of the surface that is left. (CHOICE: else one copy would make its three edges crowded, and hide what else is
/// wrong there. A face without area that filled a crack leaves open edges, as it does for a ray.)
///
/// # Panics
/// If the mesh has 2^32 vertices or more, which no face could use.
pub fn inspect(mesh: &Mesh) -> Inspection {
    analyse(mesh).inspection
}

/// An inspection, and what a repair needs to know of each vertex and face.
pub(crate) struct MeshAnalysis {
    pub(crate) inspection: Inspection,
    /// The first vertex in the place of each vertex.
    pub(crate) welded: Vec<u32>,
    pub(crate) statuses: Vec<FaceStatus>,
}

pub(crate) fn analyse(mesh: &Mesh) -> MeshAnalysis {
    let geometry = MeshGeometry { mesh };
    let mut inspection =
        Inspection { faces: mesh.faces().len(), vertices: mesh.vertices().len(), ..Inspection::default() };
    let welded = weld::weld(&geometry, &mut inspection);
    let mut statuses = faces::find_zero_area(&geometry, &welded, &mut inspection);
    duplicates::find_duplicates(&geometry, &welded, &mut statuses, &mut inspection);
    faces::measure(&geometry, &statuses, &mut inspection);
    let connectivity = edges::connect(&geometry, &welded, &statuses, &mut inspection);
    patches::find_inverted(&geometry, connectivity, &mut statuses, &mut inspection);
    MeshAnalysis { inspection, welded, statuses }
}
