//! Any rays on any triangles, answered exactly.
//!
//! The contract of a ray that belongs to no sensor: it is the set of the points o + t d with t_min <= t <= t_max. It
//! meets a face in the one point that it shares with the closed triangle; a face whose plane is parallel to the ray is
//! never met. With n = (b - a) x (c - a), a' = a - o and so on, all questions are signs of polynomials of stored
//! numbers:
//!
//! * E_ab = d.(a' x (b - a)), for each edge: the ray passes inside the triangle, or on its border, if none of the three
//!   has the sign of n.d
//! * the front is met if n.d < 0, the back if n.d > 0
//! * t = n.a' / n.d, so t >= t_min if n.a' - t_min n.d is 0 or has the sign of n.d
//! * t < t' if (n.a' n'.d - n'.a'' n.d) has the opposite sign of n.d n'.d
//!
//! A sensor that is blind before t_blind is no other ray: its nearest hit decides, and it is too near if t < t_blind. That is the
//! sign of n.a' - t_blind n.d.
//!
//! The files:
//!
//! ```text
//! query_ray   one ray in both numbers: intervals, and exactly where these are in doubt
//! triangle    one face, and the conditions above
//! wide_tree   which faces a ray may meet, four at once
//! first       the nearest hit with its ties, what a sensor reads of it, and whether anything is hit
//! all         all hits in exact order, and how often the surface is crossed
//! values      the values of a hit, correctly rounded
//! margin      how far the ray may be moved sideways before its answer changes
//! obliqueness by how much rounding changes where a thin face is met
//! ruling      whether the rounding of another program excuses its answer
//! square      what holds wherever the ray is moved within a square
//! ```
//!
//! The kernels of the sensors' rays (`face`, `intersection`) are apart from these: there a vertex is an `f32` number and
//! a ray a polynomial of its cell; here both are stored `f64` numbers.

mod all;
mod first;
mod margin;
mod obliqueness;
mod query_ray;
mod ruling;
mod square;
mod triangle;
mod values;
mod wide_tree;

use std::sync::{Arc, OnceLock};

use glam::DVec3;
use rayon::prelude::*;
use raypencil_scene::{CastRay, FaceId, Triangles};

use crate::trees::bvh::{Bvh, RayBundle};
use margin::Seams;
use query_ray::QueryRay;
use triangle::Triangle;
use wide_tree::{Next, WideTree};

pub use all::{HitGroup, SidedFace};
pub use query_ray::DecidedBy;
pub use values::{CastHit, CastMeeting};

/// The exact answers to any rays on a mesh.
///
/// ```
/// use glam::DVec3;
/// use raypencil_referee::ExactCast;
/// use raypencil_scene::{CastRay, FaceId, Sides, Triangles};
///
/// // A square of two triangles at z = 1, its front up. A ray from above meets both on their common edge.
/// let corners = vec![[0.0, 0.0, 1.0], [1.0, 0.0, 1.0], [1.0, 1.0, 1.0], [0.0, 1.0, 1.0]];
/// let square = Triangles::new(corners, vec![[0, 1, 2], [0, 2, 3]])?;
/// let cast = ExactCast::new(&square);
/// let ray = CastRay::new(DVec3::new(0.5, 0.5, 3.0), DVec3::new(0.0, 0.0, -1.0));
/// assert_eq!(cast.first(&ray, Sides::Both), [FaceId(0), FaceId(1)]);
/// let hit = cast.values(&ray, FaceId(0)).unwrap();
/// assert_eq!((hit.t.double, hit.barycentric.map(|weight| weight.double)), (2.0, [0.5, 0.0, 0.5]));
/// // Together they are one crossing of the surface, to its inside.
/// assert_eq!(cast.all(&ray, Sides::Both)[0].crossing, 1);
/// # Ok::<(), raypencil_scene::SceneError>(())
/// ```
///
/// All methods take rays that [`CastRay::validate`] accepts; others have no meaning.
#[derive(Debug)]
pub struct ExactCast<'t> {
    mesh: &'t Triangles,
    tree: Arc<Tree>,
}

/// A mesh with the hierarchy of its faces, kept for many questions. A clone is the same one.
///
/// ```
/// use std::sync::Arc;
///
/// use glam::DVec3;
/// use raypencil_referee::CastTree;
/// use raypencil_scene::{CastRay, FaceId, Sides, Triangles};
///
/// let mesh = Triangles::new(vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], vec![[0, 1, 2]])?;
/// let tree = CastTree::new(&Arc::new(mesh));
/// // Asking builds nothing.
/// let ray = CastRay::new(DVec3::new(0.25, 0.25, 1.0), DVec3::NEG_Z);
/// assert_eq!(tree.cast().first(&ray, Sides::Both), [FaceId(0)]);
/// # Ok::<(), raypencil_scene::SceneError>(())
/// ```
#[derive(Debug, Clone)]
pub struct CastTree {
    mesh: Arc<Triangles>,
    tree: Arc<Tree>,
}

impl CastTree {
    /// Builds the hierarchy, on all threads.
    pub fn new(mesh: &Arc<Triangles>) -> Self {
        Self { mesh: Arc::clone(mesh), tree: Arc::new(Tree::of(mesh)) }
    }

    /// The exact answers to any rays on the mesh.
    pub fn cast(&self) -> ExactCast<'_> {
        ExactCast { mesh: &self.mesh, tree: Arc::clone(&self.tree) }
    }
}

/// What is made of a mesh once.
#[derive(Debug)]
struct Tree {
    /// For rays that are not moved.
    wide: WideTree,
    /// For moved rays, and those that start too far away for `wide`. Made when one is first asked for.
    bvh: OnceLock<Bvh<Triangle>>,
    /// The diagonal of the mesh's bounding box, to which margins are capped.
    diagonal: f64,
    /// The largest coordinate of a vertex.
    largest_coordinate: f64,
    /// Made when a margin is first asked for.
    seams: OnceLock<Seams>,
}

impl Tree {
    fn of(mesh: &Triangles) -> Self {
        let [low, high] = mesh.bounds().unwrap_or_default();
        Self {
            wide: WideTree::of(mesh),
            bvh: OnceLock::new(),
            diagonal: length(high - low),
            largest_coordinate: low.abs().max(high.abs()).max_element(),
            seams: OnceLock::new(),
        }
    }
}

impl<'t> ExactCast<'t> {
    /// Builds the hierarchy of a mesh's faces, on all threads.
    pub fn new(mesh: &'t Triangles) -> Self {
        Self { mesh, tree: Arc::new(Tree::of(mesh)) }
    }

    fn bvh(&self) -> &Bvh<Triangle> {
        self.tree.bvh.get_or_init(|| aside(|| Bvh::build(faces_with_area(self.mesh).collect())))
    }

    fn seams(&self) -> &Seams {
        self.tree.seams.get_or_init(|| {
            let bvh = self.bvh();
            aside(|| Seams::of(self.mesh, bvh))
        })
    }

    /// The hierarchy with one face in each place.
    fn places(&self) -> &Bvh<Triangle> {
        self.seams().without_copies().unwrap_or_else(|| self.bvh())
    }

    /// [`walk`](Self::walk) with one face in each place.
    fn walk_places(&self, ray: &CastRay, visit: impl FnMut(&Triangle) -> Next) {
        match self.seams().without_copies() {
            Some(bvh) => walk_bundle(bvh, &bundle(ray), ray, visit),
            None => self.walk(ray, visit),
        }
    }

    /// Shows the faces that the ray may meet, and others, nearer ones first, until it is enough.
    #[inline]
    fn walk(&self, ray: &CastRay, visit: impl FnMut(&Triangle) -> Next) {
        let wide = &self.tree.wide;
        match wide.ray(ray) {
            Some(in_frame) => wide.walk(self.mesh.vertices(), &in_frame, visit),
            None => walk_bundle(self.bvh(), &bundle(ray), ray, visit),
        }
    }

    /// A face of the mesh, if the mesh has it.
    fn triangle(&self, face: FaceId) -> Option<Triangle> {
        ((face.0 as usize) < self.mesh.faces().len()).then(|| Triangle::of(self.mesh, face))
    }
}

/// The faces of a mesh that have an area.
fn faces_with_area(mesh: &Triangles) -> impl ParallelIterator<Item = Triangle> + '_ {
    let indices = (0..mesh.faces().len() as u32).into_par_iter();
    indices.map(|index| Triangle::of(mesh, FaceId(index))).filter(Triangle::has_area)
}

/// Does work for which other threads wait, on a thread and a pool of its own. A thread of the common pool would take other tasks
/// while it waits for a part of the work, and one of these could wait for the whole.
fn aside<T: Send>(work: impl FnOnce() -> T + Send) -> T {
    let threads = rayon::current_num_threads();
    std::thread::scope(|scope| {
        let in_pool = move || match rayon::ThreadPoolBuilder::new().num_threads(threads).build() {
            Ok(pool) => pool.install(work),
            // No more threads are to be had: on this one alone.
            Err(_) => {
                let alone = rayon::ThreadPoolBuilder::new().num_threads(1).use_current_thread().build();
                alone.expect("a pool of this thread").install(work)
            }
        };
        match scope.spawn(in_pool).join() {
            Ok(made) => made,
            Err(panic) => std::panic::resume_unwind(panic),
        }
    })
}

/// [`ExactCast::walk`] for rays of any size, and moved ones.
#[inline(never)]
fn walk_bundle(
    bvh: &Bvh<Triangle>,
    bundle: &RayBundle,
    ray: &CastRay,
    mut visit: impl FnMut(&Triangle) -> Next,
) {
    let length = QueryRay::length(ray);
    let mut farthest = bundle.max_range;
    bvh.visit(bundle, |face| {
        match visit(face) {
            Next::On => {}
            Next::UpTo(t) => farthest = (t * length * RANGE_SLACK).min(farthest),
            // Nothing is entered so early.
            Next::Stop => farthest = -1.0,
        }
        farthest
    });
}

/// The ray for the hierarchy.
fn bundle(ray: &CastRay) -> RayBundle {
    // By the largest part first: the square of a small one may be 0. Parts that are nothing beside it are left out, so
    // that no reciprocal is infinite; the hierarchy's slack is far wider.
    let scaled = ray.direction / ray.direction.abs().max_element();
    let part = |x: f64| if x.abs() < 1e-100 { 0.0 } else { x };
    let direction = DVec3::from_array(scaled.to_array().map(part)).normalize();
    let length = QueryRay::length(ray);
    RayBundle {
        origin: ray.origin,
        direction,
        max_range: if ray.t_max == f64::INFINITY { f64::INFINITY } else { ray.t_max * length * RANGE_SLACK },
        start_radius: 0.0,
        spread: 0.0,
    }
}

/// The ray moved sideways, for the hierarchy: its origin is rounded, which `start_radius` makes good.
fn moved_bundle(ray: &CastRay, by: [f64; 2]) -> RayBundle {
    let [u, v] = ray.across();
    let (moved, bundle) = (u * by[0] + v * by[1], bundle(ray));
    let rounding = 8.0 * f64::EPSILON * (moved.length() + ray.origin.length());
    RayBundle {
        origin: ray.origin + moved,
        max_range: bundle.max_range + rounding,
        start_radius: rounding,
        ..bundle
    }
}

/// Far more than the roundings of a range.
const RANGE_SLACK: f64 = 1.0 + 64.0 * f64::EPSILON;

/// The length of a vector whose squares may be too small for f64: a mesh of 1e-170 has a diagonal, too.
fn length(v: DVec3) -> f64 {
    match v.abs().max_element() {
        largest if 0.0 < largest && largest < 1e-140 => (v / largest).length() * largest,
        _ => v.length(),
    }
}

#[cfg(test)]
#[path = "../../tests/unit/moved_rays.rs"]
mod tests;
