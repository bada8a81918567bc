//! Any rays on a mesh: one, and many.

use std::ops::Range;

use rayon::prelude::*;
use raypencil_scene::{CastRay, RaySet, Sides, Triangles};

use super::frame::{ScaledRay, Walk, way_to};
use super::packet::{Packet, how_many_together};
use super::quad::Sheared;
use super::traced::{CastFace, Crossing, FirstMet, TracedHit, TracedMeeting};
use super::tree::CastTree;
use super::turns;
use crate::wide_tree::{self, Visitor, Waiting};

/// Any rays on a mesh, traced in `f64`.
///
/// ```
/// use glam::DVec3;
/// use raypencil_scene::{CastRay, FaceId, Sides, Triangles};
/// use raypencil_tracer::TracerCast;
///
/// // A triangle at z = 1, its front up.
/// let corners = vec![[0.0, 0.0, 1.0], [4.0, 0.0, 1.0], [0.0, 4.0, 1.0]];
/// let mesh = Triangles::new(corners, vec![[0, 1, 2]])?;
/// let cast = TracerCast::new(&mesh);
/// let down = CastRay::new(DVec3::new(1.0, 2.0, 3.0), DVec3::new(0.0, 0.0, -1.0));
/// let hit = cast.traverser().first(&down, Sides::Fronts).unwrap();
/// assert_eq!((hit.face, hit.t, hit.barycentric), (FaceId(0), 2.0, [0.25, 0.25, 0.5]));
/// # Ok::<(), raypencil_scene::SceneError>(())
/// ```
#[derive(Debug)]
pub struct TracerCast {
    tree: CastTree,
}

impl TracerCast {
    /// Builds the tree.
    pub fn new(mesh: &Triangles) -> Self {
        Self { tree: CastTree::new(mesh) }
    }

    /// A traversal with its own stack, for many rays on one thread.
    pub fn traverser(&self) -> CastTraverser<'_> {
        CastTraverser { tree: &self.tree, stack: self.tree.boxes.stack(), packet: None }
    }

    /// The first hit of each ray of a set, on all threads; also one that is [too near](CastRay::is_too_near) for a sensor.
    pub fn first_of(&self, set: &RaySet) -> Vec<Option<TracedHit>> {
        let of_part = |part: &[CastRay]| {
            let mut first = vec![None; part.len()];
            let each =
                |index: usize, met: Option<TracedMeeting<'_, '_>>| first[index] = met.map(|met| *met.hit());
            self.traverser().first_of_each(part, set.sides(), each);
            first
        };
        set.rays().par_chunks(RAYS_A_PART).flat_map_iter(of_part).collect()
    }
}

/// A traversal with its own stack.
pub struct CastTraverser<'t> {
    tree: &'t CastTree,
    stack: Vec<Waiting>,
    /// There once many rays were asked about.
    packet: Option<Box<Packet>>,
}

impl std::fmt::Debug for CastTraverser<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("CastTraverser").field("tree", self.tree).finish_non_exhaustive()
    }
}

/// Rays of a set that one thread asks about by itself.
const RAYS_A_PART: usize = 2048;

/// So many packets are not formed after one that did not pay. Tuned.
const PACKETS_LEFT_OUT: u32 = 31;

/// What a face makes of a walk.
enum Next {
    /// Go on as before.
    On,
    /// Go no farther than to this scaled t.
    UpTo(f64),
    /// It is enough.
    Stop,
}

impl<'t> CastTraverser<'t> {
    /// The first hits of many rays, which is quicker than one after the other, above all where they start in one point: `each`
    /// gets the index of every ray, in no particular order, and what [`first`](Self::first) would give.
    ///
    /// ```
    /// use glam::DVec3;
    /// use raypencil_scene::{CastRay, Sides, Triangles};
    /// use raypencil_tracer::TracerCast;
    ///
    /// let corners = vec![[0.0, 0.0, 1.0], [4.0, 0.0, 1.0], [0.0, 4.0, 1.0]];
    /// let cast = TracerCast::new(&Triangles::new(corners, vec![[0, 1, 2]])?);
    /// let rays = [1.0, 5.0].map(|x| CastRay::new(DVec3::new(x, 2.0, 3.0), DVec3::NEG_Z));
    /// let mut hits = [None; 2];
    /// cast.traverser().first_of_each(&rays, Sides::Both, |k, met| hits[k] = met.map(|met| met.t()));
    /// assert_eq!(hits, [Some(2.0), None]);
    /// # Ok::<(), raypencil_scene::SceneError>(())
    /// ```
    pub fn first_of_each<'r>(
        &mut self,
        rays: &'r [CastRay],
        sides: Sides,
        mut each: impl FnMut(usize, Option<TracedMeeting<'t, 'r>>),
    ) {
        self.seek_each(rays, (sides, false), &mut |index, met| {
            each(index, met.map(|met| TracedMeeting::new(met, &rays[index], &self.tree.frame)));
        });
    }

    /// Whether each of many rays meets anything.
    pub fn any_of_each(&mut self, rays: &[CastRay], sides: Sides) -> Vec<bool> {
        let mut any = vec![false; rays.len()];
        self.seek_each(rays, (sides, true), &mut |index, met| any[index] = met.is_some());
        any
    }

    /// The nearest hit of each ray, or if `any` is enough any hit. Rays that go together are asked as a packet as long as that pays;
    /// all others take turns.
    fn seek_each(
        &mut self,
        rays: &[CastRay],
        (sides, any): (Sides, bool),
        each: &mut dyn FnMut(usize, Option<FirstMet<'t>>),
    ) {
        let tree = self.tree;
        let in_turns = |range: Range<usize>, each: &mut dyn FnMut(usize, Option<FirstMet<'t>>)| {
            turns::nearest_of_each(tree, &rays[range.clone()], (sides, any), &mut |index, met| {
                each(range.start + index, met.map(|met| met.met()));
            });
        };
        let (mut alone, mut left_out) = (0..0, 0);
        while alone.end < rays.len() {
            let at = alone.end;
            let count = how_many_together(&rays[at..]);
            if count == 0 || left_out > 0 {
                left_out -= u32::from(count > 0);
                alone.end += count.max(1);
                continue;
            }
            let packet = self.packet.get_or_insert_with(|| Box::new(Packet::EMPTY));
            if !packet.seek(tree, &mut self.stack, &rays[at..at + count], sides) {
                alone.end += count;
                continue;
            }
            left_out = if packet.was_worth_it() { 0 } else { PACKETS_LEFT_OUT };
            in_turns(alone, each);
            for lane in 0..count {
                each(at + lane, packet.nearest(lane, tree));
            }
            alone = at + count..at + count;
        }
        in_turns(alone, each);
    }

    /// The nearest hit, also one that is [too near](CastRay::is_too_near) for a sensor; of several at the same t, that of the
    /// lowest face.
    pub fn first(&mut self, ray: &CastRay, sides: Sides) -> Option<TracedHit> {
        let scaled = self.tree.frame.ray(ray);
        self.nearest(ray, sides).map(|crossing| crossing.hit(ray, &scaled))
    }

    fn nearest(&mut self, ray: &CastRay, sides: Sides) -> Option<Crossing<'t>> {
        let scaled = self.tree.frame.ray(ray);
        let mut nearest: Option<Crossing<'t>> = None;
        self.walk(
            ray,
            &scaled,
            #[inline(always)]
            |face| {
                let Some(crossing) = face.crossing(ray, &scaled, sides) else { return Next::On };
                if nearest.as_ref().is_some_and(|nearest| !crossing.is_before(nearest)) {
                    return Next::On;
                }
                nearest = Some(crossing);
                Next::UpTo(crossing.scaled_t)
            },
        );
        nearest
    }

    /// Whether the ray meets anything.
    pub fn any(&mut self, ray: &CastRay, sides: Sides) -> bool {
        let scaled = self.tree.frame.ray(ray);
        let mut is_met = false;
        self.walk(
            ray,
            &scaled,
            #[inline(always)]
            |face| {
                is_met = face.crossing(ray, &scaled, sides).is_some();
                if is_met { Next::Stop } else { Next::On }
            },
        );
        is_met
    }

    /// All hits in the order of t, and at the same t in that of the faces.
    pub fn all(&mut self, ray: &CastRay, sides: Sides) -> Vec<TracedHit> {
        let scaled = self.tree.frame.ray(ray);
        let mut met = Vec::new();
        self.walk(
            ray,
            &scaled,
            #[inline(always)]
            |face| {
                met.extend(face.crossing(ray, &scaled, sides));
                Next::On
            },
        );
        met.sort_by(|a, b| a.t.total_cmp(&b.t).then(a.face.id.cmp(&b.face.id)));
        met.iter().map(|crossing| crossing.hit(ray, &scaled)).collect()
    }

    /// Shows the faces that the ray may meet, until one says that it is enough.
    #[inline]
    fn walk(&mut self, given: &CastRay, scaled: &ScaledRay, mut visit: impl FnMut(&'t CastFace) -> Next) {
        let CastTree { boxes, faces, .. } = self.tree;
        match self.tree.frame.walk(given, scaled) {
            Walk::Nothing => {}
            Walk::AllFaces => {
                for face in faces {
                    if matches!(visit(face), Next::Stop) {
                        return;
                    }
                }
            }
            Walk::Tree { box_ray, entry } => {
                let sheared = Sheared::new(&scaled.ray, &box_ray);
                let mut seeker =
                    Seeker { tree: self.tree, sheared, entry, range_per_t: scaled.ray.metres_per_t, visit };
                boxes.walk_ray(&mut self.stack, &box_ray, &mut seeker);
            }
        }
    }
}

/// Shows the faces in leaves.
struct Seeker<'t, V> {
    tree: &'t CastTree,
    sheared: Sheared,
    entry: f64,
    /// Scaled.
    range_per_t: f64,
    visit: V,
}

impl<'t, V: FnMut(&'t CastFace) -> Next> Visitor for Seeker<'t, V> {
    #[inline(always)]
    fn leaf(&mut self, entries: Range<usize>, far: &mut f32) -> wide_tree::Next {
        for quad in &self.tree.quads[entries] {
            let mut left = quad.may_meet(&self.sheared);
            while left != 0 {
                let face = &self.tree.faces[quad.first as usize + left.trailing_zeros() as usize];
                left &= left - 1;
                match (self.visit)(face) {
                    Next::On => {}
                    Next::UpTo(t) => *far = way_to(t * self.range_per_t, self.entry),
                    Next::Stop => return wide_tree::Next::Stop,
                }
            }
        }
        wide_tree::Next::On
    }
}

#[cfg(test)]
#[path = "../../tests/unit/cast.rs"]
mod tests;
