//! Bounding volume hierarchy of the referee's own: the faces that a ray may meet, in f64.
//!
//! It only has to be complete. Faces are split at the median of their centres, boxes are exact in f64, and the slab
//! test is widened by far more than its rounding, and by the displacement that is asked about.

use glam::DVec3;
use raypencil_scene::FaceId;

/// Maximum faces in a leaf.
const MAX_LEAF_FACES: usize = 4;

/// Relative slack of the slab test: 2^-40, where its rounding is a few 2^-53.
const RELATIVE_SLACK: f64 = 1.0 / (1u64 << 40) as f64;

/// Largest inverse of a direction's component. A ray at right angles to an axis stays where it is along that: between low <
/// 0 < high the products are beyond any range, and otherwise too, unless a bound is 0 but for 1e-290 m.
const MAX_INVERSE: f64 = 1e300;

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
    nodes: Vec<Node>,
    faces: Vec<F>,
}

#[derive(Debug, Clone, Copy)]
struct Node {
    low: DVec3,
    high: DVec3,
    /// Leaf: index of its first face. Inner node: its children are the nodes `first` and `first + 1`.
    first: u32,
    /// Number of faces; 0 for an inner node.
    count: u32,
}

/// What is in a node.
pub(crate) enum NodeContent<'b, F> {
    /// The indices of two nodes.
    Children([u32; 2]),
    Faces(&'b [F]),
}

/// A ray in f64 and all rays near it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct RayBundle {
    /// Start of the middle ray, scene frame, metres.
    pub(crate) origin: DVec3,
    /// Unit direction of the middle ray.
    pub(crate) direction: DVec3,
    /// Largest range of interest, metres.
    pub(crate) max_range: f64,
    /// Largest distance of a ray's start from `origin`, metres.
    pub(crate) start_radius: f64,
    /// Largest distance of a ray's unit direction from `direction`: metres per metre of range.
    pub(crate) spread: f64,
}

/// Faces of which one thread builds the hierarchy by itself.
const FACES_PER_TASK: usize = 4096;

impl<F: InBox + Send> Bvh<F> {
    /// Builds the hierarchy, on all threads. The result does not depend on their number.
    pub(crate) fn build(faces: impl Iterator<Item = F>) -> Self {
        let mut faces: Vec<F> = faces.collect();
        let nodes = if faces.is_empty() { Vec::new() } else { build_nodes(&mut faces, 0) };
        Self { nodes, faces }
    }
}

/// The nodes of a hierarchy of `faces`, the root first, of which the first has the index `first_face`. Children come after
/// their node, and side by side.
fn build_nodes<F: InBox + Send>(faces: &mut [F], first_face: u32) -> Vec<Node> {
    let (low, high) = bounds(faces);
    let mut nodes = Vec::with_capacity(faces.len());
    nodes.push(Node { low, high, first: first_face, count: faces.len() as u32 });
    let middle = faces.len() / 2;
    if faces.len() > FACES_PER_TASK {
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
        self.nodes.is_empty()
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
    bundle: RayBundle,
    inverse: DVec3,
    /// Widening of every box, metres, wherever it lies.
    widened: f64,
    /// Nodes to visit, with the range at which the bundle enters each.
    waiting: Vec<(f64, u32)>,
    /// Nodes entered beyond the range.
    beyond: Vec<(f64, u32)>,
}

impl<'t, F> Traversal<'t, F> {
    pub(crate) fn new(bvh: &'t Bvh<F>, bundle: &RayBundle) -> Self {
        let mut walk = Self {
            bvh,
            bundle: *bundle,
            inverse: bundle.direction.map(|part| part.recip().clamp(-MAX_INVERSE, MAX_INVERSE)),
            widened: bundle.start_radius * (1.0 + bundle.spread) + RELATIVE_SLACK * bundle.origin.length(),
            waiting: Vec::with_capacity(64),
            beyond: Vec::new(),
        };
        if let Some(entry) = bvh.nodes.first().and_then(|root| walk.entry(root)) {
            walk.waiting.push((entry, 0));
        }
        walk
    }

    /// The faces of the next leaf that the bundle enters within `max_range`; `None` if there is none.
    pub(crate) fn next_leaf(&mut self, max_range: f64) -> Option<&'t [F]> {
        while let Some((entry, index)) = self.waiting.pop() {
            if entry > max_range {
                self.beyond.push((entry, index));
                continue;
            }
            let node = &self.bvh.nodes[index as usize];
            if node.count > 0 {
                return Some(&self.bvh.faces[node.first as usize..(node.first + node.count) as usize]);
            }
            let child = |child: u32| (self.entry(&self.bvh.nodes[child as usize]), child);
            let mut children = [child(node.first), child(node.first + 1)];
            // The nearer child goes on top of the stack.
            if children[0].0 < children[1].0 {
                children.swap(0, 1);
            }
            self.waiting.extend(children.into_iter().filter_map(|(entry, child)| Some((entry?, child))));
        }
        None
    }

    /// Puts the nodes that were beyond the range back on the stack.
    pub(crate) fn resume(&mut self) {
        self.waiting.append(&mut self.beyond);
    }

    /// The range at which the bundle enters a node's widened box; `None` if it does not.
    ///
    /// A ray of the bundle meets a point P of the box at its own range R. The ray starts at most `start_radius` from
    /// the bundle's origin, and its direction is at most `spread` from the bundle's. So the middle ray's point at R
    /// lies within `start_radius + spread R` of P, and R is at most the distance of P plus `start_radius`. The
    /// widened box contains that point, hence it is entered at R or before.
    #[inline]
    fn entry(&self, node: &Node) -> Option<f64> {
        let bundle = &self.bundle;
        // Comparisons are one instruction each; `min` and `max` take several, for the sake of NaN, which is not here.
        let less = |x: f64, y: f64| if x < y { x } else { y };
        let more = |x: f64, y: f64| if x > y { x } else { y };
        let (mut low, mut high) = (node.low - bundle.origin, node.high - bundle.origin);
        let most = |low: DVec3, high: DVec3| [0, 1, 2].map(|k| more(low[k].abs(), high[k].abs()));
        let [x, y, z] = most(low, high);
        // The sum is an upper bound of the length, and enough where only roundings are to be covered.
        let far = if bundle.spread == 0.0 { x + y + z } else { (x * x + y * y + z * z).sqrt() };
        let [x, y, z] = most(node.low, node.high);
        let size = more(more(x, y), z);
        let margin = DVec3::splat(self.widened + bundle.spread * far + RELATIVE_SLACK * (far + size));
        (low, high) = (low - margin, high + margin);
        let (mut enter, mut leave) = (0.0_f64, bundle.max_range);
        for k in 0..3 {
            let (a, b) = (low[k] * self.inverse[k], high[k] * self.inverse[k]);
            enter = more(less(a, b), enter);
            leave = less(more(a, b), leave);
        }
        if enter <= leave { Some(enter) } else { None }
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
