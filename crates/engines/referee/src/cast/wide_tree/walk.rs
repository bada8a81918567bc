//! How rays go through the hierarchy.

use glam::{DVec3, Vec4};
use raypencil_scene::CastRay;

use super::super::triangle::Triangle;
use super::{GROWN, LEAF, LEAST_PART, MAX_ORIGIN, U, WIDENED, WideTree, down, up};
use crate::lanes::fetch;

/// Entries that can wait: a hierarchy of 2^30 leaves has 10 nodes one below the other, each of which leaves 7 that wait.
/// A power of two, so that
/// an index is in it by its last bits.
const STACK: usize = 128;

/// Most rays that walk together.
pub(in super::super) const TOGETHER: usize = 8;

/// How many of these rays should walk together: one by one, if most start where the ray before them does and go nearly the same way, for
/// then the memory that they need is at hand.
pub(in super::super) fn how_many_together(rays: &[CastRay]) -> usize {
    const ASKED: usize = 64;
    let pairs = rays.windows(2).take(ASKED);
    let count = pairs.len();
    let is_near = |pair: &&[CastRay]| {
        let turn = (pair[1].direction - pair[0].direction).abs().max_element();
        pair[0].origin == pair[1].origin && turn < pair[0].direction.abs().max_element() / 16.0
    };
    if 4 * pairs.filter(is_near).count() > 3 * count { 1 } else { TOGETHER }
}

/// A ray in the frame.
#[derive(Debug, Clone, Copy)]
pub(in super::super) struct FrameRay {
    pub(super) origin: [f32; 3],
    pub(super) direction: [f32; 3],
    /// With which origin the entered plane of each axis is asked, and with which the left one.
    origins: [[f32; 3]; 2],
    inverse: [f32; 3],
    /// Whether the upper plane of an axis is entered.
    is_down: [bool; 3],
    /// 48 u A and 32 u A.
    pub(super) reach: [f32; 2],
    pub(super) near: f32,
    pub(super) far: f32,
    /// tau per t.
    per_t: f64,
}

impl FrameRay {
    const NONE: Self = Self {
        origin: [0.0; 3],
        direction: [0.0; 3],
        origins: [[0.0; 3]; 2],
        inverse: [0.0; 3],
        is_down: [false; 3],
        reach: [0.0; 2],
        near: 0.0,
        far: 0.0,
        per_t: 0.0,
    };
}

/// What a face makes of a walk.
pub(in super::super) enum Next {
    On,
    /// Nothing beyond this t matters.
    UpTo(f64),
    Stop,
}

/// Rays that walk together, at most [`TOGETHER`] at a time, each in a place of its own. Where one ends, the next one begins.
pub(in super::super) trait Rays {
    /// The next ray, which takes this place; `None` if there is no other.
    fn begin(&mut self, place: usize) -> Option<FrameRay>;

    /// Looks at a face that the ray of this place may meet.
    fn see(&mut self, place: usize, face: &Triangle) -> Next;

    /// The ray of this place has seen all that it may meet.
    fn end(&mut self, place: usize);
}

impl WideTree {
    /// A ray in the frame; `None` if it is too far away for it.
    #[inline]
    pub(in super::super) fn ray(&self, ray: &CastRay) -> Option<FrameRay> {
        let origin = self.frame.of_point(ray.origin);
        let size = origin.abs().max_element();
        let longest = ray.direction.abs().max_element();
        let per_t = longest * self.frame.scale;
        // !(a <= b) also holds for NaN.
        if !(size <= MAX_ORIGIN) || !(1e-250..1e250).contains(&per_t) || longest < 1e-250 {
            return None;
        }
        let direction = ray.direction / longest;
        let inverse = direction.to_array().map(|part| {
            let part = if part.abs() < LEAST_PART { LEAST_PART.copysign(part) } else { part };
            (1.0 / part) as f32
        });
        let is_down = inverse.map(|inverse| inverse < 0.0);
        let [lower, upper] = [origin.to_array().map(down), origin.to_array().map(up)];
        let either = |down: &[f32; 3], up: &[f32; 3]| {
            [0, 1, 2].map(|k: usize| if is_down[k] { down[k] } else { up[k] })
        };
        let reach = size as f32 + 1.001;
        Some(FrameRay {
            origin: origin.as_vec3().to_array(),
            direction: direction.as_vec3().to_array(),
            origins: [either(&lower, &upper), either(&upper, &lower)],
            inverse,
            is_down,
            reach: [48.0 * U * reach, 32.0 * U * reach],
            near: (ray.t_min * per_t) as f32 * (1.0 - 16.0 * U),
            far: self.way(ray.t_max, per_t),
            per_t,
        })
    }

    /// At least the way to what is met at `t`.
    #[inline]
    fn way(&self, t: f64, per_t: f64) -> f32 {
        (t * per_t) as f32 * GROWN + WIDENED
    }

    /// Shows each face that the ray may meet, nearer leaves first, until it is enough.
    #[inline]
    pub(in super::super) fn walk(
        &self,
        vertices: &[[f64; 3]],
        ray: &FrameRay,
        mut visit: impl FnMut(&Triangle) -> Next,
    ) {
        if self.nodes.is_empty() {
            return;
        }
        let mut walk = Walk::EMPTY;
        walk.begin(*ray);
        while walk.step(self, vertices, &mut visit) {}
    }

    /// The same for many rays, of which so many take steps in turns: while one waits for memory, others go on.
    #[inline]
    pub(in super::super) fn walk_together(
        &self,
        vertices: &[[f64; 3]],
        rays: &mut impl Rays,
        together: usize,
    ) {
        let mut walks = [const { Walk::EMPTY }; TOGETHER];
        let (mut places, mut count) = ([0; TOGETHER], 0);
        for place in 0..together.min(TOGETHER) {
            let Some(ray) = rays.begin(place) else { break };
            walks[place].begin(ray);
            places[count] = place;
            count += 1;
        }
        while count > 0 {
            let mut k = 0;
            while k < count {
                let place = places[k];
                let walk = &mut walks[place];
                if !self.nodes.is_empty()
                    && walk.step(self, vertices, &mut |face: &Triangle| rays.see(place, face))
                {
                    walk.look_ahead(self, vertices);
                    k += 1;
                    continue;
                }
                rays.end(place);
                match rays.begin(place) {
                    Some(ray) => {
                        walk.begin(ray);
                        k += 1;
                    }
                    None => {
                        count -= 1;
                        places[k] = places[count];
                    }
                }
            }
        }
    }
}

/// A ray on its way.
struct Walk {
    ray: FrameRay,
    far: f32,
    /// Which plane of each axis is entered.
    entered: [usize; 3],
    /// Where it is, or goes next.
    next: u32,
    /// A bit for each face of this leaf that it has to look at.
    faces: u32,
    /// What waits, the nearest on top, and how many do.
    stack: [(f32, u32); STACK],
    waiting: usize,
}

impl Walk {
    const EMPTY: Self = Self {
        ray: FrameRay::NONE,
        far: 0.0,
        entered: [0; 3],
        next: 0,
        faces: 0,
        stack: [(0.0, 0); STACK],
        waiting: 0,
    };

    /// Puts the ray before the root.
    #[inline(always)]
    fn begin(&mut self, ray: FrameRay) {
        self.entered = [0, 1, 2].map(|axis: usize| if ray.is_down[axis] { axis + 3 } else { axis });
        (self.far, self.ray, self.next, self.faces, self.waiting) = (ray.far, ray, 0, 0, 0);
    }

    /// Enters the next node or leaf, or looks at the faces of its leaf; says whether there is another step.
    #[inline(always)]
    fn step(
        &mut self,
        tree: &WideTree,
        vertices: &[[f64; 3]],
        visit: &mut impl FnMut(&Triangle) -> Next,
    ) -> bool {
        let Self { ray, far, entered, next, faces, stack, waiting } = self;
        if *faces != 0 {
            let leaf = &tree.leaves[(*next & !LEAF) as usize];
            while *faces != 0 {
                let lane = faces.trailing_zeros() as usize;
                *faces &= *faces - 1;
                let corners = leaf.vertices[lane].map(|vertex| DVec3::from_array(vertices[vertex as usize]));
                match visit(&Triangle { id: leaf.ids[lane], corners }) {
                    Next::On => {}
                    Next::UpTo(t) => *far = tree.way(t, ray.per_t).min(*far),
                    Next::Stop => return false,
                }
            }
        } else if *next & LEAF == 0 {
            let node = &tree.nodes[*next as usize];
            let mut enter = [Vec4::splat(ray.near); 2];
            let mut leave = [Vec4::splat(*far); 2];
            for axis in 0..3 {
                let inverse = Vec4::splat(ray.inverse[axis]);
                let first = &node.planes[entered[axis]];
                let last = &node.planes[(entered[axis] + 3) % 6];
                let [of_first, of_last] =
                    [Vec4::splat(ray.origins[0][axis]), Vec4::splat(ray.origins[1][axis])];
                for half in 0..2 {
                    enter[half] = enter[half].max((first[half] - of_first) * inverse);
                    leave[half] = leave[half].min((last[half] - of_last) * inverse);
                }
            }
            let [lower, upper] = [0, 1].map(|half: usize| enter[half].cmple(leave[half] * GROWN).bitmask());
            let mut lanes = lower | upper << 4;
            let enter = enter.map(|half| half.to_array());
            let bottom = *waiting;
            while lanes != 0 {
                let lane = lanes.trailing_zeros() as usize;
                lanes &= lanes - 1;
                let enter = enter[lane / 4][lane % 4];
                // The nearest on top.
                let mut at = *waiting;
                while at > bottom && stack[(at - 1) % STACK].0 < enter {
                    stack[at % STACK] = stack[(at - 1) % STACK];
                    at -= 1;
                }
                stack[at % STACK] = (enter, node.children[lane]);
                *waiting += 1;
            }
        } else {
            *faces = tree.leaves[(*next & !LEAF) as usize].may_meet(ray);
            if *faces != 0 {
                return true;
            }
        }
        while *waiting > 0 {
            *waiting -= 1;
            let (enter, child) = stack[*waiting % STACK];
            if enter <= *far * GROWN {
                *next = child;
                return true;
            }
        }
        false
    }

    /// Asks memory for what the next step needs.
    #[inline(always)]
    fn look_ahead(&self, tree: &WideTree, vertices: &[[f64; 3]]) {
        if self.next & LEAF == 0 {
            fetch(&tree.nodes[self.next as usize]);
            return;
        }
        let leaf = &tree.leaves[(self.next & !LEAF) as usize];
        if self.faces == 0 {
            fetch(leaf);
            return;
        }
        for vertex in leaf.vertices[self.faces.trailing_zeros() as usize] {
            fetch(&vertices[vertex as usize]);
        }
    }
}
