//! The tree of a mesh for any rays, and its traversals.

use std::ops::Range;

use obvhs::ray::Ray as BoxRay;
use rayon::prelude::*;
use raypencil_scene::{CastRay, FaceId, RaySet, Sides, Triangles};

use super::frame::{Frame, ScaledRay, Walk, way_to};
use super::traced::{CastFace, Crossing, TracedHit};
use crate::grouped_build::Forest;
use crate::lanes::{self, Instructions, Work};
use crate::wide_tree::{self, Visitor, Waiting, WideTree};

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
    frame: Frame,
    boxes: WideTree,
    /// In the order of the boxes' entries.
    faces: Vec<CastFace>,
}

impl TracerCast {
    /// Builds the tree.
    pub fn new(mesh: &Triangles) -> Self {
        let frame = Frame::of(mesh);
        let face = |index| CastFace::of(mesh, FaceId(index), frame.scale);
        let box_of = |index| {
            let face = face(index);
            face.has_area().then(|| frame.padded_box(face.corners))
        };
        let forest = Forest::build(mesh.faces().len(), box_of);
        let (order, first_faces) = forest.faces();
        let boxes = WideTree::collapse(&forest, &first_faces);
        Self { boxes, faces: order.into_par_iter().map(face).collect(), frame }
    }

    /// A traversal with its own stack, for many rays on one thread.
    pub fn traverser(&self) -> CastTraverser<'_> {
        CastTraverser { cast: self, stack: self.boxes.stack() }
    }

    /// The first hit of each ray of a set, on all threads; also one that is [too near](CastRay::is_too_near) for a sensor.
    pub fn first_of(&self, set: &RaySet) -> Vec<Option<TracedHit>> {
        let first = |traverser: &mut CastTraverser<'_>, ray| traverser.first(ray, set.sides());
        set.rays().par_iter().map_init(|| self.traverser(), first).collect()
    }
}

/// A traversal with its own stack.
pub struct CastTraverser<'t> {
    cast: &'t TracerCast,
    stack: Vec<Waiting>,
}

impl std::fmt::Debug for CastTraverser<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("CastTraverser").field("cast", self.cast).finish_non_exhaustive()
    }
}

/// What a face makes of a walk.
enum Next {
    /// Go on as before.
    On,
    /// Go no farther than to this scaled t.
    UpTo(f64),
    /// It is enough.
    Stop,
}

impl CastTraverser<'_> {
    /// The nearest hit, also one that is [too near](CastRay::is_too_near) for a sensor; of several at the same t, that of the
    /// lowest face.
    pub fn first(&mut self, ray: &CastRay, sides: Sides) -> Option<TracedHit> {
        let scaled = self.cast.frame.ray(ray);
        let mut nearest: Option<Crossing> = None;
        self.walk(
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
        nearest.map(|crossing| crossing.hit(ray, &scaled))
    }

    /// Whether the ray meets anything.
    pub fn any(&mut self, ray: &CastRay, sides: Sides) -> bool {
        let scaled = self.cast.frame.ray(ray);
        let mut is_met = false;
        self.walk(
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
        let scaled = self.cast.frame.ray(ray);
        let mut met = Vec::new();
        self.walk(
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
    fn walk(&mut self, scaled: &ScaledRay, mut visit: impl FnMut(&CastFace) -> Next) {
        let TracerCast { boxes, faces, .. } = self.cast;
        match scaled.walk {
            Walk::Nothing => {}
            Walk::AllFaces => {
                for face in faces {
                    if matches!(visit(face), Next::Stop) {
                        return;
                    }
                }
            }
            Walk::Tree { box_ray, entry } => {
                let seeker = Seeker { faces, entry, range_per_t: scaled.ray.metres_per_t, visit };
                let walk = TreeWalk { boxes, stack: &mut self.stack, box_ray, seeker };
                lanes::run(Instructions::Detected, walk);
            }
        }
    }
}

/// Shows the faces in leaves.
struct Seeker<'a, V> {
    faces: &'a [CastFace],
    entry: f64,
    /// Scaled.
    range_per_t: f64,
    visit: V,
}

impl<V: FnMut(&CastFace) -> Next> Visitor for Seeker<'_, V> {
    #[inline(always)]
    fn leaf(&mut self, entries: Range<usize>, far: &mut f32) -> wide_tree::Next {
        for face in &self.faces[entries] {
            match (self.visit)(face) {
                Next::On => {}
                Next::UpTo(t) => *far = way_to(t * self.range_per_t, self.entry),
                Next::Stop => return wide_tree::Next::Stop,
            }
        }
        wide_tree::Next::On
    }
}

/// A walk of one ray.
struct TreeWalk<'a, V> {
    boxes: &'a WideTree,
    stack: &'a mut Vec<Waiting>,
    box_ray: BoxRay,
    seeker: Seeker<'a, V>,
}

impl<V: FnMut(&CastFace) -> Next> Work for TreeWalk<'_, V> {
    type Output = ();

    #[inline(always)]
    fn run(mut self) {
        self.boxes.walk_ray(self.stack, &self.box_ray, &mut self.seeker);
    }
}

#[cfg(test)]
#[path = "../../tests/unit/cast.rs"]
mod tests;
