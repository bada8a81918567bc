//! What an inspection found.

use glam::DVec3;
use raypencil_scene::FaceId;

/// How many examples are kept of anything.
const MAX_EXAMPLES: usize = 5;

/// What there is in a mesh, and what may be wrong with it. Lengths are in metres, places in the global frame.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Inspection {
    /// All faces.
    pub faces: usize,
    /// All vertices.
    pub vertices: usize,
    /// The smallest and largest coordinates of vertices that a face uses.
    pub bounds: Option<[DVec3; 2]>,
    /// Area of the surface, both sides counted once, square metres.
    pub area: f64,
    /// What the closed components enclose together, whichever way round each is, cubic metres.
    pub volume: f64,

    /// Vertices that no face uses.
    pub unused_vertices: Found,
    /// Vertices in the place of an earlier one.
    pub split_vertices: Found,

    /// Faces that have no area, as [`raypencil_scene::Mesh::zero_area_faces`] counts them: no ray hits them.
    pub zero_area: Found,
    /// Why they have none.
    pub zero_area_kinds: ZeroAreaKinds,
    /// Faces with the corners of an earlier face in the same sense.
    pub duplicates: Found,
    /// How many of them are of another material than the first.
    pub duplicates_of_other_material: usize,
    /// Pairs of faces with the same corners in opposite senses: sheets that are seen from both sides.
    pub double_sided: Found,
    /// Faces longer than [`Inspection::SLENDER`] times their width.
    pub slender: Found,
    /// The largest ratio of a face's longest side to its height above that.
    pub worst_aspect: f64,
    /// Faces whose normal points downwards; the underside of an overhang does.
    pub down: Found,
    /// Their area, square metres.
    pub down_area: f64,
    /// Whether most of what the open components show to someone above is back faces.
    pub upside_down: bool,

    /// Edges of one face only.
    pub open_edges: OpenEdges,
    /// Edges of more than two faces.
    pub crowded_edges: Found,
    /// Edges of two faces that both run along it in the same direction: one of them has its front where
    /// the other has its back.
    pub mismatched_edges: Found,
    /// Faces that are proven to be the wrong way round.
    ///
    /// A *patch* is all faces that hang together over edges of two faces. If some of it can be turned so that no
    /// two neighbours contradict each other, there are two ways to do so. In a closed patch, that with a
    /// positive volume is right; in an open one (CHOICE) that which turns fewer faces.
    pub inverted: Found,
    /// Closed components that are inside out as a whole. CHOICE: terrain is looked at from outside, so a cavity
    /// that is modelled as a body of its own counts as well.
    pub inside_out: usize,
    /// Open patches of which exactly half contradicts the other half.
    pub undecided_patches: Found,
    /// Patches that have no two sides, such as a Moebius strip: no turning of faces helps.
    pub one_sided_patches: Found,

    /// Sets of faces that hang together over edges.
    pub components: usize,
    /// How many of them are closed: each edge has two faces.
    pub closed_components: usize,
}

impl Inspection {
    /// From this ratio of length to width on a face is called slender. CHOICE: at 1e4 a face of a metre is a tenth of
    /// a millimetre wide; it is a matter for people, since renderers take any.
    pub const MIN_SLENDER_ASPECT: f64 = 1e4;

    /// Loops of open edges beyond the one that is a ground's border: holes, and gaps between parts.
    pub fn excess_loops(&self) -> usize {
        self.open_edges.loops.saturating_sub(1)
    }

    /// How many kinds of things are wrong.
    ///
    /// CHOICE: what is usual and harms no ray is a fact and not wrong: one border, split vertices (files of glTF
    /// have them wherever normals differ), double-sided sheets, slender faces, faces that look down.
    pub fn kinds_wrong(&self) -> usize {
        let found = [
            &self.unused_vertices,
            &self.zero_area,
            &self.duplicates,
            &self.crowded_edges,
            &self.mismatched_edges,
            &self.inverted,
            &self.one_sided_patches,
        ];
        found.into_iter().filter(|found| found.count > 0).count()
            + usize::from(self.excess_loops() > 0)
            + usize::from(self.upside_down)
    }

    /// Whether nothing is wrong.
    pub fn passes(&self) -> bool {
        self.kinds_wrong() == 0
    }
}

/// A count, and the first few.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Found {
    /// How many there are.
    pub count: usize,
    /// The first five.
    pub examples: Vec<Example>,
}

impl Found {
    /// Counts one more; it is looked at only if it is among the first.
    pub(crate) fn add(&mut self, example: impl FnOnce() -> Example) {
        self.count += 1;
        if self.examples.len() < MAX_EXAMPLES {
            self.examples.push(example());
        }
    }
}

/// Something, and where to find it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Example {
    /// What it is.
    pub item: Item,
    /// A vertex, the middle of an edge or of a face; global frame, metres.
    pub place: DVec3,
}

impl Example {
    /// A face, and a place on it in the global frame, metres.
    pub(super) fn at_face(face: u32, place: DVec3) -> Self {
        Self { item: Item::Face(FaceId(face)), place }
    }
}

/// A part of a mesh.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Item {
    /// A face; of an edge the first of its faces.
    Face(FaceId),
    /// An index into [`raypencil_scene::Mesh::vertices`].
    Vertex(u32),
}

/// Faces without area by cause; each counts once, under the first that fits.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct ZeroAreaKinds {
    /// A vertex is used twice.
    pub repeated_vertex: usize,
    /// Two vertices are in one place.
    pub coincident_vertices: usize,
    /// Three vertices are on a line.
    pub collinear: usize,
}

/// Edges of one face only.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct OpenEdges {
    /// How many there are.
    pub count: usize,
    /// How long they are together, metres.
    pub length: f64,
    /// Loops of open edges. Where loops touch, it is the number of independent ones: edges - vertices + pieces.
    pub loops: usize,
    /// Sets of open edges that hang together at vertices.
    pub pieces: usize,
    /// The longest five of these, longest first.
    pub longest: Vec<OpenPiece>,
}

/// Open edges that hang together.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OpenPiece {
    /// How many edges.
    pub edges: usize,
    /// How long together, metres.
    pub length: f64,
    /// A face at one of the edges, and the middle of that edge.
    pub example: Example,
}

impl OpenEdges {
    /// Keeps a piece if it is one of the longest; of equally long ones the earlier.
    pub(crate) fn add_piece(&mut self, piece: OpenPiece) {
        self.pieces += 1;
        let at = self.longest.partition_point(|other| other.length >= piece.length);
        if at < MAX_EXAMPLES {
            self.longest.insert(at, piece);
            self.longest.truncate(MAX_EXAMPLES);
        }
    }
}
