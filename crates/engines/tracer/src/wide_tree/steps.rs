//! The walk of one ray, a step at a time, so that many rays can take turns.

use std::ops::Range;

use obvhs::ray::Ray;

use super::{LEAF, Waiting, WideTree, entered, joined};
use crate::lanes::fetch;

/// A ray on its way through the boxes: the same boxes as of [`WideTree::walk_ray`], in the same order.
#[derive(Debug, Clone, Default)]
pub(crate) struct Steps {
    origin: [f32; 3],
    inverse: [f32; 3],
    /// Which bounds of a node are entered first.
    entered: [usize; 3],
    far: f32,
    at: Option<Waiting>,
    waiting: Vec<Waiting>,
}

/// Where a ray is.
pub(crate) enum At {
    Node,
    /// The entries of a leaf.
    Leaf(Range<usize>),
    /// Nothing is left.
    End,
}

impl Steps {
    /// Puts a ray before the root.
    pub(crate) fn begin(&mut self, tree: &WideTree, ray: &Ray) {
        (self.origin, self.inverse) = (ray.origin.to_array(), ray.inv_direction.to_array());
        self.entered = entered(&self.inverse);
        self.far = ray.tmax;
        self.waiting.clear();
        self.waiting.reserve(tree.stack_size);
        self.at = (!tree.nodes.is_empty()).then_some(Waiting { near: 0.0, child: 0, end: 0 });
    }

    /// Puts a ray where nothing is left.
    pub(crate) fn begin_nowhere(&mut self) {
        self.at = None;
    }

    #[inline(always)]
    pub(crate) fn at(&self) -> At {
        match self.at {
            None => At::End,
            Some(Waiting { child, .. }) if child & LEAF == 0 => At::Node,
            Some(Waiting { child, end, .. }) => At::Leaf((child & !LEAF) as usize..end as usize),
        }
    }

    /// Looks into the node where the ray is, and goes on to the nearest box that waits.
    #[inline(always)]
    pub(crate) fn enter(&mut self, tree: &WideTree) {
        let Some(Waiting { child, .. }) = self.at else { return };
        let node = &tree.nodes[child as usize];
        let (enter, leave) = node.passed(&self.origin, &self.inverse, &self.entered, self.far);
        let [lower, upper] = [0, 1].map(|half: usize| enter[half].cmple(leave[half]).bitmask());
        let mut lanes = lower | upper << 4;
        let enter = joined(enter);
        let bottom = self.waiting.len();
        // Only the boxes that are met, unlike `wait`: of rays that share nothing a processor cannot foresee which these are.
        while lanes != 0 {
            let lane = lanes.trailing_zeros() as usize;
            lanes &= lanes - 1;
            let near = enter[lane];
            let waiting = Waiting { near, child: node.child[lane], end: node.end[lane] };
            self.waiting.push(waiting);
            let mut at = self.waiting.len() - 1;
            // The nearest on top.
            while at > bottom && self.waiting[at - 1].near < near {
                self.waiting[at] = self.waiting[at - 1];
                at -= 1;
            }
            self.waiting[at] = waiting;
        }
        self.go_on();
    }

    /// Goes on to the nearest box that waits.
    #[inline(always)]
    pub(crate) fn go_on(&mut self) {
        self.at = loop {
            match self.waiting.pop() {
                Some(next) if next.near > self.far => {}
                next => break next,
            }
        };
    }

    /// Goes no farther than this.
    #[inline(always)]
    pub(crate) fn end_at(&mut self, far: f32) {
        self.far = far;
    }

    /// Asks memory for the node where the ray is, if it is at one.
    #[inline(always)]
    pub(crate) fn look_ahead(&self, tree: &WideTree) {
        if let Some(Waiting { child, .. }) = self.at
            && child & LEAF == 0
        {
            fetch(&tree.nodes[child as usize]);
        }
    }
}
