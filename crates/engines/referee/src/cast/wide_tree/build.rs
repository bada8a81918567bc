//! The hierarchy from the faces: each node's faces are cut across the longest side again and again, so that all its children have
//! as many leaves, or one more.

use glam::{DVec3, Vec3};
use rayon::prelude::*;
use raypencil_scene::{FaceId, Triangles};

use super::{EMPTY, Frame, LEAF, LEAF_WIDTH, Leaf, NO_FACES, Node, Triangle, WIDTH, WideTree, down, up};

/// A face as the build orders it.
#[derive(Debug, Clone, Copy)]
struct Item {
    /// Three times the middle, in the frame.
    middle: [f32; 3],
    /// Which face of the mesh it is.
    place: u32,
}

impl Item {
    fn of(frame: &Frame, place: u32, face: &Triangle) -> Self {
        let corners = face.corners.map(|corner| frame.of_point(corner).as_vec3());
        Self { middle: corners.into_iter().sum::<Vec3>().to_array(), place }
    }
}

/// Faces of which a part of the nodes and leaves is made, and the indices of the first of these.
struct Part<'p> {
    items: &'p mut [Item],
    nodes: &'p mut [Node],
    leaves: &'p mut [Leaf],
    node: u32,
    leaf: u32,
}

/// A box in the frame.
type Bounds = [[f32; 3]; 2];

/// Faces of which one thread builds the hierarchy by itself.
const FACES_PER_PIECE: usize = 4096;

/// What all parts are made of.
struct Source<'s> {
    mesh: &'s Triangles,
    frame: &'s Frame,
}

impl WideTree {
    /// The hierarchy of the faces of a mesh that have an area, built on all threads. It does not depend on their number.
    pub(in super::super) fn of(mesh: &Triangles) -> Self {
        let frame = Frame::of(mesh);
        let item = |place: u32| {
            let face = Triangle::of(mesh, FaceId(place));
            face.has_area().then(|| Item::of(&frame, place, &face))
        };
        let mut items: Vec<Item> = (0..mesh.faces().len() as u32).into_par_iter().filter_map(item).collect();
        if items.is_empty() {
            return Self { nodes: Vec::new(), leaves: Vec::new(), frame };
        }
        let count = items.len().div_ceil(LEAF_WIDTH);
        // A root has a node in any case.
        let mut nodes = vec![EMPTY; nodes_of(count).max(1)];
        let mut leaves = vec![NO_FACES; count];
        let whole = Part { items: &mut items, nodes: &mut nodes, leaves: &mut leaves, node: 0, leaf: 0 };
        whole.fill(&Source { mesh, frame: &frame });
        Self { nodes, leaves, frame }
    }
}

/// How many leaves each child of a node of `leaves` leaves has: as few children as can have hierarchies one node less deep, for their
/// last nodes are then full.
fn children_of(leaves: usize) -> Vec<usize> {
    let mut most = 1;
    while most * WIDTH < leaves {
        most *= WIDTH;
    }
    let count = leaves.div_ceil(most);
    (0..count).map(|k| (k + 1) * leaves / count - k * leaves / count).collect()
}

/// How many nodes a hierarchy of `leaves` leaves has: none for one leaf, which is a child.
fn nodes_of(leaves: usize) -> usize {
    if leaves < 2 {
        return 0;
    }
    let children = children_of(leaves);
    let (least, more) =
        (children[0].min(children[1]), children.iter().filter(|of| **of > leaves / children.len()).count());
    let of_more = if more > 0 { more * nodes_of(least + 1) } else { 0 };
    1 + (children.len() - more) * nodes_of(least) + of_more
}

impl<'p> Part<'p> {
    /// Fills the first node, and all below it. Gives the box.
    fn fill(self, source: &Source<'_>) -> Bounds {
        let Part { items, nodes, leaves, node: first, leaf } = self;
        let is_large = items.len() > FACES_PER_PIECE;
        let (node, nodes) = nodes.split_first_mut().expect("a node of a part");
        let sizes = children_of(leaves.len());
        let mut children = Vec::with_capacity(WIDTH);
        Part { items, nodes, leaves, node: first + 1, leaf }.divide(&sizes, &mut children);
        let what: Vec<u32> = children
            .iter()
            .map(|part| if part.leaves.len() == 1 { LEAF | part.leaf } else { part.node })
            .collect();
        let fill =
            |part: Part<'_>| if part.leaves.len() == 1 { part.fill_leaf(source) } else { part.fill(source) };
        let boxes: Vec<Bounds> = if is_large {
            children.into_par_iter().map(fill).collect()
        } else {
            children.into_iter().map(fill).collect()
        };
        let mut all = [[f32::INFINITY; 3], [f32::NEG_INFINITY; 3]];
        for (lane, ([low, high], child)) in boxes.iter().zip(what).enumerate() {
            for axis in 0..3 {
                node.planes[axis][lane / 4][lane % 4] = low[axis];
                node.planes[axis + 3][lane / 4][lane % 4] = high[axis];
                all[0][axis] = all[0][axis].min(low[axis]);
                all[1][axis] = all[1][axis].max(high[axis]);
            }
            node.children[lane] = child;
        }
        all
    }

    /// Cuts the part into parts of so many leaves, across the longest side of the middles of its faces. All leaves but the last are full.
    fn divide(self, sizes: &[usize], parts: &mut Vec<Self>) {
        if sizes.len() == 1 {
            parts.push(self);
            return;
        }
        let (of_first, of_second) = sizes.split_at(sizes.len() / 2);
        let (leaves_of_first, nodes_of_first): (usize, usize) =
            (of_first.iter().sum(), of_first.iter().map(|&leaves| nodes_of(leaves)).sum());
        let Part { items, nodes, leaves, node, leaf } = self;
        let middle = LEAF_WIDTH * leaves_of_first;
        let mut bounds = (Vec3::INFINITY, Vec3::NEG_INFINITY);
        for item in &*items {
            let middle = Vec3::from_array(item.middle);
            bounds = (bounds.0.min(middle), bounds.1.max(middle));
        }
        let axis = (bounds.1 - bounds.0).max_position();
        items.select_nth_unstable_by(middle, |a, b| {
            a.middle[axis].total_cmp(&b.middle[axis]).then(a.place.cmp(&b.place))
        });
        let (items, other_items) = items.split_at_mut(middle);
        let (leaves, other_leaves) = leaves.split_at_mut(leaves_of_first);
        let (nodes, other_nodes) = nodes.split_at_mut(nodes_of_first);
        Part { items, nodes, leaves, node, leaf }.divide(of_first, parts);
        let other = Part {
            items: other_items,
            nodes: other_nodes,
            leaves: other_leaves,
            node: node + nodes_of_first as u32,
            leaf: leaf + leaves_of_first as u32,
        };
        other.divide(of_second, parts);
    }

    /// Fills the only leaf. Gives the box.
    fn fill_leaf(self, source: &Source<'_>) -> Bounds {
        let leaf = &mut self.leaves[0];
        let mut bounds = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        // What belongs together, whatever the order of the split.
        self.items.sort_unstable_by_key(|item| item.place);
        for (lane, item) in self.items.iter().enumerate() {
            let face = Triangle::of(source.mesh, FaceId(item.place));
            leaf.ids[lane] = face.id;
            leaf.vertices[lane] = source.mesh.faces()[item.place as usize];
            let framed = face.corners.map(|corner| source.frame.of_point(corner));
            let corners = framed.map(|corner| corner.as_vec3());
            for k in 0..3 {
                bounds = (bounds.0.min(framed[k]), bounds.1.max(framed[k]));
                for axis in 0..3 {
                    leaf.corners[k][axis][lane] = corners[k][axis];
                }
                // The very difference that walks form.
                let edge = corners[(k + 1) % 3] - corners[k];
                leaf.longest = leaf.longest.max(edge.abs().max_element());
            }
            leaf.present |= 1 << lane;
        }
        [bounds.0.to_array().map(down), bounds.1.to_array().map(up)]
    }
}
