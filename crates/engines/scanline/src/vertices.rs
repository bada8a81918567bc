//! Step 2: the vertices in the sensor's frame and on the SPP. (§4, 2; figure 7)

use glam::DVec3;
use raypencil_scene::{FaceId, Mesh};

use crate::clusters::{ClusterFace, Clusters};
use crate::spp::SppPoint;

/// A vertex in the sensor's frame.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SensorVertex {
    /// Position in the scene's frame, metres, as the mesh has it.
    pub(crate) in_scene: [f32; 3],
    /// Position in the sensor's frame, metres.
    pub(crate) position: DVec3,
    /// Projection onto the SPP. Meaningful only for a vertex at or beyond the SPP.
    pub(crate) projection: SppPoint,
    /// The sides of the screen that the vertex is outside of: bits of `skip`.
    pub(crate) outside: u8,
}

/// A face with its vertices' places among the vertices that were transformed together with them.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PlacedFace {
    pub(crate) id: FaceId,
    pub(crate) corners: [u32; 3],
}

/// Some clusters of a mesh in a sensor's frame.
#[derive(Debug, Default)]
pub(crate) struct TransformedClusters {
    pub(crate) vertices: Vec<SensorVertex>,
    pub(crate) faces: Vec<PlacedFace>,
}

impl TransformedClusters {
    /// Transforms the vertices of some clusters, each cluster by itself: a vertex of two clusters twice, to the same bits.
    /// With `turned_over` the corners of each face come in the opposite order.
    pub(crate) fn new(
        mesh: &Mesh,
        clusters: &Clusters,
        which: &[u32],
        turned_over: bool,
        transform_one: impl Fn([f32; 3]) -> SensorVertex,
    ) -> Self {
        let mut transformed = Self::default();
        for &cluster in which {
            let content = clusters.content(cluster);
            let first = transformed.vertices.len() as u32;
            let of_vertex = |&v: &u32| transform_one(mesh.vertices()[v as usize]);
            transformed.vertices.extend(content.vertices.iter().map(of_vertex));
            let placed = |face: &ClusterFace| {
                let [a, b, c] = face.corners.map(|place| first + u32::from(place));
                PlacedFace { id: face.id, corners: if turned_over { [a, c, b] } else { [a, b, c] } }
            };
            transformed.faces.extend(content.faces.iter().map(placed));
        }
        transformed
    }

    /// The vertices of a face.
    #[inline]
    pub(crate) fn vertices_of(&self, face: PlacedFace) -> [&SensorVertex; 3] {
        face.corners.map(|place| &self.vertices[place as usize])
    }
}
