//! Bounding volume hierarchy of the referee's own: the faces that a ray may meet.
//!
//! It only has to be complete. Faces are split at the median of their centres. Walks go through a copy with four boxes a node
//! in f32, relative to the middle of all, and rounded outward. Their slab test is widened by far more than its rounding, and by
//! the displacement that is asked about.

use glam::DVec3;
use rayon::prelude::*;
use raypencil_scene::FaceId;

pub(crate) use crate::trees::wide_boxes::RayBundle;
use crate::trees::wide_boxes::{BoxRays, Node, Waiting, WideBoxes};

/// Maximum faces in a leaf.
const MAX_LEAF_FACES: usize = 4;

/// A face that boxes can be drawn around.
pub(crate) trait InBox: Copy {
    /// The face's index in its mesh.
    fn id(&self) -> FaceId;
    /// The corners, unrounded.
    fn corners(&self) -> [DVec3; 3];
    /// Three times the coordinate of the middle along an axis. The build compares nothing else.
    fn middle(&self, axis: usize) -> f64;
}

/// Faces in a hierarchy of boxes.
#[derive(Debug)]
pub(crate) struct Bvh<F> {
    /// The root first; none if it is built [for walks](Self::for_walks) alone.
    nodes: Vec<Node>,
    wide: WideBoxes,
    faces: Vec<F>,
}

/// What is in a node.
pub(crate) enum NodeContent<'b, F> {
    /// The indices of two nodes.
    Children([u32; 2]),
    Faces(&'b [F]),
}

/// Faces of which one thread builds the hierarchy by itself.
const FACES_PER_PIECE: usize = 4096;

impl<F: InBox + Send> Bvh<F> {
    /// Builds the hierarchy, on all threads. The result does not depend on their number.
    pub(crate) fn build(mut faces: Vec<F>) -> Self {
        let nodes = if faces.is_empty() { Vec::new() } else { build_nodes(&mut faces, 0) };
        Self { wide: WideBoxes::of(&nodes), nodes, faces }
    }

    /// The same for walks alone, without nodes: it takes a third of the memory.
    pub(crate) fn for_walks(mut faces: Vec<F>) -> Self {
        if faces.is_empty() {
            return Self::build(faces);
        }
        let (low, high) = bounds(&faces);
        let middle = 0.5 * low + 0.5 * high;
        let mut pieces = Vec::new();
        into_pieces(&mut faces, 0, &mut pieces);
        let pieces: Vec<(Node, WideBoxes)> = pieces
            .into_par_iter()
            .map(|(first_face, faces)| {
                let nodes = build_nodes(faces, first_face);
                (nodes[0], WideBoxes::around(&nodes, middle))
            })
            .collect();
        let (roots, pieces): (Vec<Node>, Vec<WideBoxes>) = pieces.into_iter().unzip();
        let mut upper = vec![roots[0]];
        join(&mut upper, 0, faces.len(), &mut roots.into_iter().enumerate());
        Self { wide: WideBoxes::joined(&upper, pieces, middle), nodes: Vec::new(), faces }
    }
}

/// Splits faces, of which the first has the index `first_face`, until the pieces are small; the halves on two threads.
fn into_pieces<'f, F: InBox + Send>(
    faces: &'f mut [F],
    first_face: u32,
    pieces: &mut Vec<(u32, &'f mut [F])>,
) {
    if faces.len() <= FACES_PER_PIECE {
        pieces.push((first_face, faces));
        return;
    }
    let (low, high) = bounds(faces);
    let middle = split(faces, low, high);
    let (lower, upper) = faces.split_at_mut(middle);
    let mut others = Vec::new();
    rayon::join(
        || into_pieces(lower, first_face, pieces),
        || into_pieces(upper, first_face + middle as u32, &mut others),
    );
    pieces.append(&mut others);
}

/// Makes node `at` the root of the hierarchy over the pieces of `faces` faces, which have the next of `roots`; a leaf is one
/// piece, by its index. Halves as [`into_pieces`] does.
fn join(nodes: &mut Vec<Node>, at: usize, faces: usize, roots: &mut impl Iterator<Item = (usize, Node)>) {
    if faces <= FACES_PER_PIECE {
        if let Some((piece, root)) = roots.next() {
            nodes[at] = Node { first: piece as u32, count: 1, ..root };
        }
        return;
    }
    let first = nodes.len();
    nodes.extend([nodes[at]; 2]);
    join(nodes, first, faces / 2, roots);
    join(nodes, first + 1, faces - faces / 2, roots);
    let [a, b] = [nodes[first], nodes[first + 1]];
    nodes[at] = Node { low: a.low.min(b.low), high: a.high.max(b.high), first: first as u32, count: 0 };
}

/// The nodes of a hierarchy of `faces`, the root first, of which the first has the index `first_face`. Children come after
/// their node, and side by side.
fn build_nodes<F: InBox + Send>(faces: &mut [F], first_face: u32) -> Vec<Node> {
    let (low, high) = bounds(faces);
    let mut nodes = Vec::with_capacity(faces.len());
    nodes.push(Node { low, high, first: first_face, count: faces.len() as u32 });
    let middle = faces.len() / 2;
    if faces.len() > FACES_PER_PIECE {
        split(faces, low, high);
        let (lower, upper) = faces.split_at_mut(middle);
        let (lower, upper) =
            rayon::join(|| build_nodes(lower, first_face), || build_nodes(upper, first_face + middle as u32));
        // Both roots first, then what is below the lower, then what is below the upper.
        let of_lower = lower.len() as u32;
        nodes[0] = Node { low, high, first: 1, count: 0 };
        nodes.extend([moved(lower[0], 2), moved(upper[0], 1 + of_lower)]);
        nodes.extend(lower[1..].iter().map(|&node| moved(node, 2)));
        nodes.extend(upper[1..].iter().map(|&node| moved(node, 1 + of_lower)));
        return nodes;
    }
    let mut waiting = vec![0_usize];
    while let Some(index) = waiting.pop() {
        let Node { low, high, first, count } = nodes[index];
        if count as usize <= MAX_LEAF_FACES {
            continue;
        }
        let start = (first - first_face) as usize;
        let range = &mut faces[start..start + count as usize];
        let middle = split(range, low, high);
        let children = nodes.len();
        for (start, end) in [(0, middle), (middle, range.len())] {
            let (low, high) = bounds(&range[start..end]);
            nodes.push(Node { low, high, first: first + start as u32, count: (end - start) as u32 });
        }
        nodes[index].first = children as u32;
        nodes[index].count = 0;
        waiting.extend([children, children + 1]);
    }
    nodes
}

/// A node of a part with the indices of the whole: nodes below the part's root begin `by` nodes later.
fn moved(node: Node, by: u32) -> Node {
    if node.count == 0 { Node { first: node.first + by, ..node } } else { node }
}

/// Parts faces into halves of equal number along the longest side of their box: the depth is logarithmic for any input.
/// Returns where the second half begins.
fn split<F: InBox>(faces: &mut [F], low: DVec3, high: DVec3) -> usize {
    let axis = (high - low).max_position();
    let middle = faces.len() / 2;
    faces.select_nth_unstable_by(middle, |a, b| {
        a.middle(axis).total_cmp(&b.middle(axis)).then(a.id().cmp(&b.id()))
    });
    middle
}

impl<F> Bvh<F> {
    pub(crate) fn is_empty(&self) -> bool {
        self.faces.is_empty()
    }

    /// Number of nodes; the root, if there is one, is node 0.
    pub(crate) fn node_count(&self) -> usize {
        self.nodes.len()
    }

    /// The corners of a node's box.
    pub(crate) fn bounds(&self, node: u32) -> [DVec3; 2] {
        let Node { low, high, .. } = self.nodes[node as usize];
        [low, high]
    }

    /// What is in a node. Children have greater indices than their node.
    pub(crate) fn content(&self, node: u32) -> NodeContent<'_, F> {
        let Node { first, count, .. } = self.nodes[node as usize];
        match count {
            0 => NodeContent::Children([first, first + 1]),
            _ => NodeContent::Faces(&self.faces[first as usize..(first + count) as usize]),
        }
    }

    /// All faces in a node and the nodes below it.
    pub(crate) fn faces_below(&self, node: u32) -> &[F] {
        let end = |last: bool| {
            let mut node = self.nodes[node as usize];
            while node.count == 0 {
                node = self.nodes[node.first as usize + usize::from(last)];
            }
            (node.first + if last { node.count } else { 0 }) as usize
        };
        &self.faces[end(false)..end(true)]
    }

    /// Calls `visit` with every face that a ray of the bundle may meet within its range, and possibly with others.
    /// `visit` returns the range to search from then on. Nearer leaves come first.
    pub(crate) fn visit<'t>(&'t self, bundle: &RayBundle, mut visit: impl FnMut(&'t F) -> f64) {
        let mut walk = Traversal::new(self, bundle);
        let mut max_range = bundle.max_range;
        while let Some(leaf) = walk.next_leaf(max_range) {
            for face in leaf {
                max_range = visit(face).min(max_range);
            }
        }
    }
}

/// A traversal of the hierarchy along a bundle, leaf by leaf, roughly from near to far. Nodes beyond the range are
/// kept, in case the range grows again.
#[derive(Debug)]
pub(crate) struct Traversal<'t, F> {
    bvh: &'t Bvh<F>,
    rays: BoxRays,
    /// Nodes to visit.
    waiting: Vec<Waiting>,
    /// Nodes entered beyond the range.
    beyond: Vec<Waiting>,
}

impl<'t, F> Traversal<'t, F> {
    pub(crate) fn new(bvh: &'t Bvh<F>, bundle: &RayBundle) -> Self {
        let mut waiting = Vec::with_capacity(64);
        waiting.extend(bvh.wide.root());
        Self { bvh, rays: bvh.wide.rays(bundle), waiting, beyond: Vec::new() }
    }

    /// The faces of the next leaf that the bundle enters within `max_range`; `None` if there is none.
    #[inline]
    pub(crate) fn next_leaf(&mut self, max_range: f64) -> Option<&'t [F]> {
        while let Some(node) = self.waiting.pop() {
            if f64::from(node.entry) > max_range {
                self.beyond.push(node);
            } else if node.count > 0 {
                return Some(&self.bvh.faces[node.first as usize..(node.first + node.count) as usize]);
            } else {
                self.bvh.wide.enter(node.first, &self.rays, &mut self.waiting);
            }
        }
        None
    }

    /// Puts the nodes that were beyond the range back on the stack.
    pub(crate) fn resume(&mut self) {
        self.waiting.append(&mut self.beyond);
    }
}

/// The bounding box of some faces.
fn bounds(faces: &[impl InBox]) -> (DVec3, DVec3) {
    let mut bounds = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for face in faces {
        for corner in face.corners() {
            bounds = (bounds.0.min(corner), bounds.1.max(corner));
        }
    }
    bounds
}
