//! Faces in the order of the displacement that they need at least, by the boxes that they are in.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use super::frame::{Frame, least_size};
use crate::trees::bvh::{Bvh, InBox, NodeContent};

/// A node that is to be looked at, and the least displacement to its box.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct WaitingNode {
    /// The bits of an f64 that is not negative are in the order of the numbers.
    size: u64,
    node: u32,
}

/// The nodes of a hierarchy that displaced rays may meet, the nearest first.
pub(super) struct Nearby<'b, F> {
    bvh: &'b Bvh<F>,
    waiting: BinaryHeap<Reverse<WaitingNode>>,
}

impl<'b, F: InBox> Nearby<'b, F> {
    pub(super) fn new(bvh: &'b Bvh<F>) -> Self {
        let root = (!bvh.is_empty()).then_some(Reverse(WaitingNode { size: 0, node: 0 }));
        Self { bvh, waiting: root.into_iter().collect() }
    }

    /// The least size that what is waiting needs; infinite if nothing is.
    pub(super) fn size(&self) -> f64 {
        self.waiting.peek().map_or(f64::INFINITY, |Reverse(node)| f64::from_bits(node.size))
    }

    /// Opens the nearest node: gives its faces, or none if it has children. `wants` says, by the node and the
    /// intervals of a, b and range that it spans, whether a child is worth a look.
    pub(super) fn open(
        &mut self,
        frame: &Frame<'_>,
        mut wants: impl FnMut(u32, &[[f64; 2]; 3]) -> bool,
    ) -> &'b [F] {
        let Some(Reverse(WaitingNode { node, .. })) = self.waiting.pop() else { return &[] };
        match self.bvh.content(node) {
            NodeContent::Faces(faces) => faces,
            NodeContent::Children(children) => {
                for child in children {
                    let [low, high] = self.bvh.bounds(child);
                    let span = frame.span(low, high);
                    if wants(child, &span) {
                        let size = least_size(&span).to_bits();
                        self.waiting.push(Reverse(WaitingNode { size, node: child }));
                    }
                }
                &[]
            }
        }
    }
}
