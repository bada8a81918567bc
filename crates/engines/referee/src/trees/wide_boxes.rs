//! Boxes of a hierarchy, four a node, in f32, as rays walk through them.
//!
//! # Why no ray loses a box
//!
//! A ray of the bundle meets a point P of the box at its own range R. The ray starts at most `start_radius` from the
//! bundle's origin o, and its direction is at most `spread` from the bundle's d. So the middle ray's point at R lies within
//! `start_radius + spread R` of P, and R is at most the distance of P plus `start_radius`. Widened by that, the box contains
//! this point, hence it is entered at R or before, and left at R or later.
//!
//! In f32, with u = 2^-24, l a bound of the box less o, and f the sum of the largest |l| of the three axes:
//!
//! * o is rounded by u |o|, and l by u |l|, which is at most u f;
//! * the widened bound by u (f + widening), its product with 1/d by 3 u: as if it lay 4 u (f + widening) elsewhere.
//!
//! All that is below 8 u (f + |o| + widening). The slack is 32 u of f and of the sum of |o|'s parts, and the widening itself
//! is 32 u larger.

use glam::DVec3;

/// Boxes of a node.
const WIDTH: usize = 4;

/// 32 u, derived above.
const SLACK: f32 = 1.0 / (1 << 19) as f32;

/// Largest inverse of a direction's component. A ray at right angles to an axis stays where it is along that: between low <
/// 0 < high the products are beyond the distance of any point of the box.
const MAX_INVERSE: f64 = 1e30;

/// Count of what is in a box that does not exist.
const NONE: u32 = u32::MAX;

/// A node of the hierarchy with two children a node.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Node {
    pub(crate) low: DVec3,
    pub(crate) high: DVec3,
    /// Leaf: index of its first face. Inner node: its children are the nodes `first` and `first + 1`.
    pub(crate) first: u32,
    /// Number of faces; 0 for an inner node.
    pub(crate) count: u32,
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

/// Four boxes, and what is in each.
#[derive(Debug, Clone, Copy)]
struct Boxes {
    low: [[f32; WIDTH]; 3],
    high: [[f32; WIDTH]; 3],
    /// Leaf: index of its first face. Else: the node of the boxes inside.
    first: [u32; WIDTH],
    /// Number of faces; 0 if it is no leaf, [`NONE`] if there is no box.
    count: [u32; WIDTH],
}

const NO_BOXES: Boxes =
    Boxes { low: [[0.0; WIDTH]; 3], high: [[0.0; WIDTH]; 3], first: [0; WIDTH], count: [NONE; WIDTH] };

/// The hierarchy.
#[derive(Debug)]
pub(crate) struct WideBoxes {
    nodes: Vec<Boxes>,
    /// What f32 coordinates are relative to, scene frame, metres.
    middle: DVec3,
}

/// A bundle as the boxes are asked for it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct BoxRays {
    origin: [f32; 3],
    inverse: [f32; 3],
    max_range: f32,
    /// Widening of every box, metres, wherever it lies.
    widened: f32,
    /// Widening per metre of distance.
    spread: f32,
}

/// A box that waits, and where the bundle enters it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Waiting {
    pub(crate) entry: f32,
    /// As in [`Boxes`].
    pub(crate) first: u32,
    pub(crate) count: u32,
}

impl WideBoxes {
    /// The hierarchy of `nodes`, of which the first is the root.
    pub(crate) fn of(nodes: &[Node]) -> Self {
        let middle = nodes.first().map_or(DVec3::ZERO, |root| 0.5 * root.low + 0.5 * root.high);
        Self::around(nodes, middle)
    }

    /// The same with coordinates relative to `middle`.
    pub(crate) fn around(nodes: &[Node], middle: DVec3) -> Self {
        let mut wide = Vec::new();
        if !nodes.is_empty() {
            wide.push(NO_BOXES);
            let mut to_fill = vec![(0_usize, 0_u32)];
            while let Some((at, node)) = to_fill.pop() {
                for (lane, node) in inside(nodes, node).enumerate() {
                    let Node { low, high, first, count } = nodes[node as usize];
                    let first = if count > 0 {
                        first
                    } else {
                        to_fill.push((wide.len(), node));
                        wide.push(NO_BOXES);
                        wide.len() as u32 - 1
                    };
                    let boxes = &mut wide[at];
                    for axis in 0..3 {
                        // Two steps outward: the difference is rounded, and then its conversion.
                        boxes.low[axis][lane] = ((low - middle)[axis] as f32).next_down().next_down();
                        boxes.high[axis][lane] = ((high - middle)[axis] as f32).next_up().next_up();
                    }
                    (boxes.first[lane], boxes.count[lane]) = (first, count);
                }
            }
        }
        wide.shrink_to_fit();
        Self { nodes: wide, middle }
    }

    /// One hierarchy of `pieces`, whose coordinates are relative to `middle` too. A leaf of `upper` is a piece.
    pub(crate) fn joined(upper: &[Node], pieces: Vec<Self>, middle: DVec3) -> Self {
        let Self { nodes: mut above, .. } = Self::around(upper, middle);
        let mut nodes =
            Vec::with_capacity(above.len() + pieces.iter().map(|piece| piece.nodes.len()).sum::<usize>());
        let mut end = above.len() as u32;
        let firsts: Vec<u32> = pieces
            .iter()
            .map(|piece| {
                let first = end;
                end += piece.nodes.len() as u32;
                first
            })
            .collect();
        for boxes in &mut above {
            for lane in 0..WIDTH {
                if boxes.count[lane] == 1 {
                    (boxes.first[lane], boxes.count[lane]) = (firsts[boxes.first[lane] as usize], 0);
                }
            }
        }
        nodes.extend(above);
        for (piece, first) in pieces.into_iter().zip(firsts) {
            nodes.extend(piece.nodes.into_iter().map(|mut boxes| {
                for lane in 0..WIDTH {
                    if boxes.count[lane] == 0 {
                        boxes.first[lane] += first;
                    }
                }
                boxes
            }));
        }
        Self { nodes, middle }
    }

    /// The node that a walk begins with, if there is any.
    pub(crate) fn root(&self) -> Option<Waiting> {
        (!self.nodes.is_empty()).then_some(Waiting { entry: 0.0, first: 0, count: 0 })
    }

    /// A bundle as these boxes are asked for it.
    pub(crate) fn rays(&self, bundle: &RayBundle) -> BoxRays {
        let origin = bundle.origin - self.middle;
        let up = |x: f64| (x as f32 * (1.0 + SLACK)).next_up();
        BoxRays {
            origin: origin.to_array().map(|part| part as f32),
            inverse: bundle
                .direction
                .to_array()
                .map(|part| part.recip().clamp(-MAX_INVERSE, MAX_INVERSE) as f32),
            max_range: up(bundle.max_range),
            widened: up(
                bundle.start_radius * (1.0 + bundle.spread) + f64::from(SLACK) * origin.abs().element_sum()
            ),
            spread: if bundle.spread == 0.0 { 0.0 } else { up(bundle.spread) },
        }
    }

    /// Puts the boxes of a node that the bundle enters on the stack, the nearest on top.
    #[inline]
    pub(crate) fn enter(&self, node: u32, rays: &BoxRays, waiting: &mut Vec<Waiting>) {
        let boxes = &self.nodes[node as usize];
        // Comparisons are one instruction each; `min` and `max` take several, for the sake of NaN.
        let less = |x: f32, y: f32| if x < y { x } else { y };
        let more = |x: f32, y: f32| if x > y { x } else { y };
        let (mut low, mut high) = (boxes.low, boxes.high);
        let (mut sums, mut squares) = ([0.0_f32; WIDTH], [0.0_f32; WIDTH]);
        for axis in 0..3 {
            for lane in 0..WIDTH {
                low[axis][lane] -= rays.origin[axis];
                high[axis][lane] -= rays.origin[axis];
                let far = more(low[axis][lane].abs(), high[axis][lane].abs());
                sums[lane] += far;
                squares[lane] += far * far;
            }
        }
        let mut margins = [rays.widened; WIDTH];
        for lane in 0..WIDTH {
            margins[lane] += SLACK * sums[lane];
        }
        if rays.spread > 0.0 {
            for lane in 0..WIDTH {
                margins[lane] += rays.spread * (squares[lane].sqrt() * (1.0 + SLACK));
            }
        }
        let (mut enter, mut leave) = ([0.0_f32; WIDTH], [rays.max_range; WIDTH]);
        for axis in 0..3 {
            let inverse = rays.inverse[axis];
            for lane in 0..WIDTH {
                let a = (low[axis][lane] - margins[lane]) * inverse;
                let b = (high[axis][lane] + margins[lane]) * inverse;
                enter[lane] = more(less(a, b), enter[lane]);
                leave[lane] = less(more(a, b), leave[lane]);
            }
        }
        let bottom = waiting.len();
        for lane in 0..WIDTH {
            if enter[lane] <= leave[lane] && boxes.count[lane] != NONE {
                let entered =
                    Waiting { entry: enter[lane], first: boxes.first[lane], count: boxes.count[lane] };
                let mut at = waiting.len();
                waiting.push(entered);
                while at > bottom && waiting[at - 1].entry < entered.entry {
                    waiting[at] = waiting[at - 1];
                    at -= 1;
                }
                waiting[at] = entered;
            }
        }
    }
}

/// The up to four nodes in a node: its children's children, or a child that is a leaf. A root that is a leaf is in itself.
fn inside(nodes: &[Node], node: u32) -> impl Iterator<Item = u32> {
    let children = |node: u32| match nodes[node as usize] {
        Node { count: 0, first, .. } => first..first + 2,
        _ => node..node + 1,
    };
    children(node).flat_map(children)
}

#[cfg(test)]
#[path = "../../tests/unit/wide_boxes.rs"]
mod tests;
