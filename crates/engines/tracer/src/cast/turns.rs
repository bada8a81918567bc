//! Many rays that share nothing: they take turns at the tree, so that while one waits for memory others go on.

use raypencil_scene::{CastRay, Sides};

use super::frame::{ScaledRay, Walk, way_to};
use super::quad::Sheared;
use super::traced::Crossing;
use super::tree::CastTree;
use crate::lanes::fetch;
use crate::wide_tree::{At, Steps};

/// Rays that take turns. Tuned.
const TOGETHER: usize = 8;

/// A ray on its way.
struct Turn<'t, 'r> {
    /// Its index among all.
    index: usize,
    given: &'r CastRay,
    scaled: ScaledRay,
    sheared: Sheared,
    /// How far from its origin it is traced.
    entry: f64,
    steps: Steps,
    /// The quad of this leaf in which it looks at faces, and a bit for each of these.
    quad: usize,
    faces: u32,
    nearest: Option<Crossing<'t>>,
}

/// Whether the ray has more turns.
#[derive(PartialEq, Eq)]
enum Next {
    Turn,
    End,
}

/// The nearest crossing of each of many rays, or if `any` is enough any crossing. `each` gets the index of every ray, in no
/// particular order.
pub(super) fn nearest_of_each<'t>(
    tree: &'t CastTree,
    rays: &[CastRay],
    (sides, any): (Sides, bool),
    each: &mut dyn FnMut(usize, Option<Crossing<'t>>),
) {
    let mut left = rays.iter().enumerate();
    let mut turns: Vec<Turn<'t, '_>> = Vec::with_capacity(TOGETHER);
    while turns.len() < TOGETHER
        && let Some((index, given)) = left.next()
    {
        turns.push(Turn::new(tree, index, given, sides));
    }
    let mut at = 0;
    while !turns.is_empty() {
        at = if at < turns.len() { at } else { 0 };
        let turn = &mut turns[at];
        if turn.take(tree, sides, any) == Next::Turn {
            at += 1;
            continue;
        }
        each(turn.index, turn.nearest);
        match left.next() {
            Some((index, given)) => {
                turn.begin(tree, index, given, sides);
                at += 1;
            }
            None => {
                turns.swap_remove(at);
            }
        }
    }
}

impl<'t, 'r> Turn<'t, 'r> {
    fn new(tree: &'t CastTree, index: usize, given: &'r CastRay, sides: Sides) -> Self {
        let mut turn = Self {
            index,
            given,
            scaled: tree.frame.ray(given),
            sheared: Sheared::NONE,
            entry: 0.0,
            steps: Steps::default(),
            quad: 0,
            faces: 0,
            nearest: None,
        };
        turn.begin(tree, index, given, sides);
        turn
    }

    /// Puts a ray before the root.
    fn begin(&mut self, tree: &'t CastTree, index: usize, given: &'r CastRay, sides: Sides) {
        (self.index, self.given, self.scaled) = (index, given, tree.frame.ray(given));
        (self.faces, self.nearest) = (0, None);
        match tree.frame.walk(given, &self.scaled) {
            Walk::Nothing => self.steps.begin_nowhere(),
            Walk::AllFaces => {
                self.steps.begin_nowhere();
                for face in &tree.faces {
                    if let Some(crossing) = face.crossing(given, &self.scaled, sides) {
                        self.keep(crossing);
                    }
                }
            }
            Walk::Tree { box_ray, entry } => {
                self.entry = entry;
                self.sheared = Sheared::new(&self.scaled.ray, &box_ray);
                self.steps.begin(&tree.boxes, &box_ray);
            }
        }
    }

    /// Keeps the nearer crossing, and says whether that is the new one.
    #[inline(always)]
    fn keep(&mut self, crossing: Crossing<'t>) -> bool {
        let is_new = self.nearest.as_ref().is_none_or(|nearest| crossing.is_before(nearest));
        if is_new {
            self.nearest = Some(crossing);
        }
        is_new
    }

    /// Enters a node or a leaf, or looks at faces.
    #[inline(always)]
    fn take(&mut self, tree: &'t CastTree, sides: Sides, any: bool) -> Next {
        if self.faces != 0 {
            let first = tree.quads[self.quad].first as usize;
            while self.faces != 0 {
                let face = &tree.faces[first + self.faces.trailing_zeros() as usize];
                self.faces &= self.faces - 1;
                let Some(crossing) = face.crossing(self.given, &self.scaled, sides) else { continue };
                if self.keep(crossing) {
                    self.steps.end_at(way_to(crossing.scaled_t * self.scaled.ray.metres_per_t, self.entry));
                }
                if any {
                    return Next::End;
                }
            }
            self.quad += 1;
        }
        match self.steps.at() {
            At::End => return Next::End,
            At::Node => self.steps.enter(&tree.boxes),
            At::Leaf(quads) => {
                while self.quad < quads.end {
                    self.faces = tree.quads[self.quad].may_meet(&self.sheared);
                    if self.faces != 0 {
                        let first = tree.quads[self.quad].first + self.faces.trailing_zeros();
                        fetch(&tree.faces[first as usize]);
                        return Next::Turn;
                    }
                    self.quad += 1;
                }
                self.steps.go_on();
            }
        }
        self.look_ahead(tree);
        Next::Turn
    }

    /// Asks memory for what the next turn needs.
    #[inline(always)]
    fn look_ahead(&mut self, tree: &CastTree) {
        match self.steps.at() {
            At::Leaf(quads) => {
                self.quad = quads.start;
                fetch(&tree.quads[quads.start]);
            }
            _ => self.steps.look_ahead(&tree.boxes),
        }
    }
}
