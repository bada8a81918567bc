//! Inspection of a mesh for faults that matter to ray casting.
//!
//! Sorting brings together vertices by position, faces by their corners, and half-edges by their ends. The time
//! is O(n log n), the memory some 70 bytes a face. Intersections between faces are not searched for: rays are not
//! affected by them.
//!
//! ```text
//! geometry       vertices, corners, normals in f64
//! weld           vertices in one place
//! faces          faces one by one: area, slenderness, direction
//! duplicates     faces on the same three places
//! edges          faces along each edge; disjoint_sets joins them to patches and components
//! patches        orientation of each patch
//! report         the result; status: what becomes of each face
//! ```

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

pub use report::{Inspection, MeshElement, Occurrence, Occurrences, OpenEdgePiece, OpenEdges, ZeroAreaKinds};
pub(crate) use status::FaceStatus;

use geometry::MeshGeometry;

/// Inspects a mesh; [`Inspection`] lists what is looked for.
///
/// Vertices in one place count as one, with 0 = -0: this is how renderers see shared edges. Faces without area,
/// which no ray hits, and duplicate faces are counted and then set aside. Edges, components, areas and volumes
/// describe the remaining surface. (CHOICE: otherwise one duplicate would make its three edges non-manifold and
/// hide other faults there. A face without area that filled a crack leaves open edges, as it does for a ray.)
///
/// # Panics
/// If the mesh has 2^32 vertices or more, which no face could use.
///
/// # Example
///
/// ```
/// use raypencil_terrain::{RandomGround, inspect};
///
/// // 800 faces are 20 x 20 cells. The border, four times 20 open edges, is one loop.
/// let found = inspect(&RandomGround::plain(1, 800, 20.0).build().into_mesh()?);
/// assert!(found.passes());
/// assert_eq!((found.open_edges.count, found.open_edges.loops), (80, 1));
/// # Ok::<(), raypencil_scene::SceneError>(())
/// ```
pub fn inspect(mesh: &Mesh) -> Inspection {
    analyse(mesh).inspection
}

/// Inspection, with the data about each vertex and face that a repair needs.
pub(crate) struct MeshAnalysis {
    pub(crate) inspection: Inspection,
    /// First vertex in the place of each vertex.
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
