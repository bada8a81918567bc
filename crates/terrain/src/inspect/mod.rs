//! What may be wrong with a mesh that rays are cast at.
//!
//! Sorting finds what belongs together: vertices by position, faces by their corners, sides of faces by their
//! ends. Everything takes O(n log n), and some 70 bytes a face. Whether faces run through each other is not asked:
//! that is a search of its own, and no ray minds it.

mod copies;
mod edges;
mod forest;
mod patches;
mod report;
mod shape;
#[cfg(test)]
#[path = "../../tests/unit/inspect.rs"]
mod tests;
mod weld;

use glam::DVec3;
use raypencil_scene::{FaceId, Mesh};

pub use report::{Example, Found, Inspection, Item, OpenEdges, OpenPiece, ZeroAreaKinds};
pub(crate) use shape::Shapes;

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
    study(mesh).inspection
}

/// What becomes of a face.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Fate {
    /// It stays.
    Sound,
    /// It stays, the other way round.
    Inverted,
    /// It has no area.
    ZeroArea,
    /// A face of lower number has the same corners in the same sense.
    Copy,
    /// The same, and that face is of another material.
    CopyOfOtherMaterial,
}

impl Fate {
    /// Whether the face belongs to the surface that rays meet.
    pub(crate) fn stays(self) -> bool {
        matches!(self, Self::Sound | Self::Inverted)
    }
}

/// An inspection, and what a repair needs to know of each vertex and face.
pub(crate) struct Study {
    pub(crate) inspection: Inspection,
    /// The first vertex in the place of each vertex.
    pub(crate) welded: Vec<u32>,
    pub(crate) fates: Vec<Fate>,
}

pub(crate) fn study(mesh: &Mesh) -> Study {
    let shapes = Shapes { mesh };
    let mut inspection =
        Inspection { faces: mesh.faces().len(), vertices: mesh.vertices().len(), ..Inspection::default() };
    let welded = weld::weld(&shapes, &mut inspection);
    let mut fates = shape::find_zero_area(&shapes, &welded, &mut inspection);
    copies::find_copies(&shapes, &welded, &mut fates, &mut inspection);
    shape::measure(&shapes, &fates, &mut inspection);
    let joints = edges::join(&shapes, &welded, &fates, &mut inspection);
    patches::find_inverted(&shapes, joints, &mut fates, &mut inspection);
    Study { inspection, welded, fates }
}

/// A face and a place on it.
fn at_face(face: u32, place: DVec3) -> Example {
    Example { item: Item::Face(FaceId(face)), place }
}
