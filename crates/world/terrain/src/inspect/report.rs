//! Result of an inspection.

use glam::DVec3;
use raypencil_scene::FaceId;

/// Maximum number of examples for each kind.
const MAX_EXAMPLES: usize = 5;

/// Contents and faults of a mesh. Lengths are in metres, places in the global frame.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Inspection {
    /// Number of faces.
    pub faces: usize,
    /// Number of vertices.
    pub vertices: usize,
    /// Smallest and largest coordinates of the used vertices.
    pub bounds: Option<[DVec3; 2]>,
    /// Area of the surface, square metres; a double-sided sheet counts twice.
    pub area: f64,
    /// Volume of the closed components, cubic metres, whatever their orientation.
    pub volume: f64,

    /// Vertices that no face uses.
    pub unused_vertices: Occurrences,
    /// Vertices in the place of an earlier vertex.
    pub split_vertices: Occurrences,

    /// Faces without area, as [`raypencil_scene::Mesh::zero_area_faces`] counts them: no ray hits them.
    pub zero_area: Occurrences,
    /// Their number by cause.
    pub zero_area_kinds: ZeroAreaKinds,
    /// Faces with the same corners as an earlier face, in the same sense.
    pub duplicates: Occurrences,
    /// Number of these whose material differs from that of the first.
    pub duplicate_faces_of_other_material: usize,
    /// Pairs of faces with the same corners in opposite senses: sheets that are visible from both sides.
    pub double_sided_sheets: Occurrences,
    /// Faces longer than [`Inspection::MIN_SLENDER_ASPECT`] times their width.
    pub slender: Occurrences,
    /// Largest ratio of a face's longest side to the height above that side.
    pub worst_aspect: f64,
    /// Faces whose normal points down, such as the underside of an overhang.
    pub down: Occurrences,
    /// Area of these faces, square metres.
    pub downward_area: f64,
    /// Whether the open components show more back faces than front faces from above, by area.
    pub upside_down: bool,

    /// Edges of one face only.
    pub open_edges: OpenEdges,
    /// Edges of more than two faces (non-manifold).
    pub non_manifold_edges: Occurrences,
    /// Edges along which both of their two faces run in the same direction: the faces have opposite orientations.
    pub inconsistent_edges: Occurrences,
    /// Faces with a proven wrong orientation.
    ///
    /// A *patch* is all faces connected over edges of two faces. If its faces can be turned so that no two
    /// neighbours contradict each other, there are two ways to do so. In a closed patch the way with a positive
    /// volume is right; in an open one (CHOICE) the way that turns fewer faces.
    pub inverted: Occurrences,
    /// Closed components with all faces inverted. CHOICE: terrain is viewed from outside, so a cavity that is
    /// modelled as a separate body counts as well.
    pub inside_out_components: usize,
    /// Open patches in which exactly half of the faces contradict the other half.
    pub undecided_patches: Occurrences,
    /// Non-orientable patches, such as a Moebius strip: no turning of faces helps.
    pub non_orientable_patches: Occurrences,

    /// Connected components: sets of faces connected over edges.
    pub components: usize,
    /// Number of closed components: each edge has two faces.
    pub closed_components: usize,
}

impl Inspection {
    /// Ratio of length to width from which a face is called slender. CHOICE: at 1e4 a face of 1 m is 0.1 mm wide.
    /// It is a hint to people; renderers accept any face.
    pub const MIN_SLENDER_ASPECT: f64 = 1e4;

    /// Number of open loops beyond the one border of a ground: holes, and gaps between parts.
    pub fn excess_loops(&self) -> usize {
        self.open_edges.loops.saturating_sub(1)
    }

    /// Number of kinds of faults.
    ///
    /// CHOICE: what is usual and harms no ray is no fault: one border, split vertices (glTF files have them
    /// wherever normals differ), double-sided sheets, slender faces, faces that look down.
    pub fn fault_kinds(&self) -> usize {
        let found = [
            &self.unused_vertices,
            &self.zero_area,
            &self.duplicates,
            &self.non_manifold_edges,
            &self.inconsistent_edges,
            &self.inverted,
            &self.non_orientable_patches,
        ];
        found.into_iter().filter(|found| found.count > 0).count()
            + usize::from(self.excess_loops() > 0)
            + usize::from(self.upside_down)
    }

    /// Whether the mesh has no fault.
    pub fn passes(&self) -> bool {
        self.fault_kinds() == 0
    }
}

/// Number of occurrences of one kind, and the first few of them.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Occurrences {
    /// Number of occurrences.
    pub count: usize,
    /// The first five occurrences.
    pub examples: Vec<Occurrence>,
}

impl Occurrences {
    /// Counts one more occurrence. `example` is evaluated for the first few only.
    pub(crate) fn add(&mut self, example: impl FnOnce() -> Occurrence) {
        self.count += 1;
        if self.examples.len() < MAX_EXAMPLES {
            self.examples.push(example());
        }
    }
}

/// One occurrence, and where it is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Occurrence {
    /// The face or vertex.
    pub item: MeshElement,
    /// Position of a vertex, midpoint of an edge, or centroid of a face; global frame, metres.
    pub place: DVec3,
}

impl Occurrence {
    /// A face, and a place on it in the global frame, metres.
    pub(super) fn at_face(face: u32, place: DVec3) -> Self {
        Self { item: MeshElement::Face(FaceId(face)), place }
    }
}

/// Face or vertex of a mesh.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MeshElement {
    /// Face; for an edge, the first of its faces.
    Face(FaceId),
    /// Index into [`raypencil_scene::Mesh::vertices`].
    Vertex(u32),
}

/// Number of faces without area by cause; each counts once, under the first cause that applies.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct ZeroAreaKinds {
    /// One vertex is used twice.
    pub repeated_vertex: usize,
    /// Two vertices are in one place.
    pub coincident_vertices: usize,
    /// Three vertices are on a line.
    pub collinear: usize,
}

/// Edges of one face only.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct OpenEdges {
    /// Number of open edges.
    pub count: usize,
    /// Total length, metres.
    pub length: f64,
    /// Number of loops. Where loops touch, this is the number of independent ones: edges - vertices + pieces.
    pub loops: usize,
    /// Number of pieces: sets of open edges connected at vertices.
    pub pieces: usize,
    /// The five longest pieces, the longest first.
    pub longest: Vec<OpenEdgePiece>,
}

/// Piece: a set of connected open edges.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OpenEdgePiece {
    /// Number of edges.
    pub edges: usize,
    /// Total length, metres.
    pub length: f64,
    /// Face at one of the edges, and the midpoint of that edge.
    pub example: Occurrence,
}

impl OpenEdges {
    /// Counts a piece, and keeps it if it is among the longest; in a tie the earlier stays.
    pub(crate) fn add_piece(&mut self, piece: OpenEdgePiece) {
        self.pieces += 1;
        let at = self.longest.partition_point(|other| other.length >= piece.length);
        if at < MAX_EXAMPLES {
            self.longest.insert(at, piece);
            self.longest.truncate(MAX_EXAMPLES);
        }
    }
}
