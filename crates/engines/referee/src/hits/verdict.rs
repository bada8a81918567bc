//! The referee and its exact verdict on one ray: which faces are nearest, or that there is none.

use std::cmp::Ordering;
use std::sync::Arc;

use rayon::prelude::*;
use raypencil_scene::{FaceId, Mesh, Scene, SensorId};

use crate::hits::face::{Crossing, ExactRay, Face};
use crate::numbers::arithmetic::WeightSum;
use crate::numbers::number::{Interval, Number};
use crate::rays::displacement::Displacement;
use crate::rays::moving_ray::MovingRay;
use crate::rays::ray::{Aim, MountedSensor};
use crate::trees::bvh::{Bvh, RayBundle};

/// The contract's answer to a ray, without rounding.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Verdict {
    /// The faces met at the smallest t, in ascending order: several if they are met at exactly the same point, none
    /// if the ray meets no front within its range.
    pub faces: Vec<FaceId>,
}

impl Verdict {
    /// Whether there is a hit.
    pub fn is_hit(&self) -> bool {
        !self.faces.is_empty()
    }
}

/// The bounding volume hierarchy of a mesh, which the referees of many scenes may share.
///
/// ```
/// # mod wall { include!(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/common/wall.rs")); }
/// # use wall::wall_scene;
/// use raypencil_referee::{Referee, RefereeTree};
/// use raypencil_scene::{FaceId, SensorId};
///
/// let scene = wall_scene();
/// let tree = RefereeTree::new(scene.mesh());
/// let verdict = Referee::on(&scene, &tree).verdict(SensorId::Camera, 4, 4).unwrap();
/// assert_eq!(verdict.faces, [FaceId(0)]);
/// ```
#[derive(Debug, Clone)]
pub struct RefereeTree {
    mesh: Arc<Mesh>,
    bvh: Arc<Bvh<Face>>,
}

impl RefereeTree {
    /// Builds the hierarchy.
    pub fn new(mesh: &Arc<Mesh>) -> Self {
        let indices = (0..mesh.faces().len() as u32).into_par_iter();
        let mut faces: Vec<Face> = indices.map(|index| Face::of(mesh, FaceId(index))).collect();
        if !faces.par_iter().all(Face::has_area) {
            faces.retain(Face::has_area);
        }
        let bvh = Bvh::for_walks(faces);
        Self { mesh: Arc::clone(mesh), bvh: Arc::new(bvh) }
    }

    /// Whether this is the hierarchy of `mesh`: of the same one in memory.
    pub fn fits(&self, mesh: &Arc<Mesh>) -> bool {
        Arc::ptr_eq(&self.mesh, mesh)
    }
}

/// The exact answers to every ray of a scene.
///
/// ```
/// # mod wall { include!(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/common/wall.rs")); }
/// # use wall::wall_scene;
/// use raypencil_referee::Referee;
/// use raypencil_scene::{FaceId, SensorId};
///
/// // The wall of the crate's first page: face 0, at z = 2 m, ends at x = 1/8 m.
/// let scene = wall_scene();
/// let referee = Referee::new(&scene);
/// // Pixel (4, 4) looks exactly along z: it meets the wall at (0, 0, 2).
/// let verdict = referee.verdict(SensorId::Camera, 4, 4).unwrap();
/// assert_eq!(verdict.faces, [FaceId(0)]);
/// // There is no column 9.
/// assert_eq!(referee.verdict(SensorId::Camera, 9, 4), None);
/// ```
#[derive(Debug)]
pub struct Referee<'s> {
    pub(crate) scene: &'s Scene,
    pub(crate) bvh: Arc<Bvh<Face>>,
    /// The sum of the weights of each beam's central pencils.
    pub(crate) weight_sums: Vec<Arc<WeightSum>>,
}

impl<'s> Referee<'s> {
    /// A referee for `scene`; it builds a bounding volume hierarchy.
    pub fn new(scene: &'s Scene) -> Self {
        Self::on(scene, &RefereeTree::new(scene.mesh()))
    }

    /// A referee for `scene`, whose mesh `tree` was built for.
    ///
    /// # Panics
    /// If it was built for another mesh.
    pub fn on(scene: &'s Scene, tree: &RefereeTree) -> Self {
        assert!(tree.fits(scene.mesh()), "the tree of another mesh");
        let weight_sums = scene.beams().iter().map(|_| Arc::default()).collect();
        Self { scene, bvh: Arc::clone(&tree.bvh), weight_sums }
    }

    /// The exact verdict on the ray of cell (i, j), or `None` if there is no such cell.
    pub fn verdict(&self, sensor: SensorId, i: u32, j: u32) -> Option<Verdict> {
        self.verdict_beside(sensor, i, j, Displacement::ZERO)
    }

    /// The exact verdict on the ray of cell (i, j) displaced by any finite number of cells; `None` if there is no
    /// such cell.
    pub fn verdict_beside(&self, sensor: SensorId, i: u32, j: u32, by: Displacement) -> Option<Verdict> {
        let sensor = MountedSensor::of(self.scene, sensor)?;
        let (width, height) = sensor.size();
        if i >= width || j >= height || !by.dx.is_finite() || !by.dy.is_finite() {
            return None;
        }
        let nearest = self.nearest(&sensor, Aim { i, j, dx: by.dx, dy: by.dy });
        Some(Verdict { faces: nearest.iter().map(|face| face.id).collect() })
    }

    /// The faces that a ray displaced from cell (i, j) by at most `radius` cells may meet, and possibly others, in
    /// ascending order; `None` if there is no such cell.
    pub fn candidate_faces(&self, id: SensorId, i: u32, j: u32, radius: f64) -> Option<Vec<FaceId>> {
        let (sensor, aim) = self.sensor_and_aim(id, i, j)?;
        let mut near = Vec::new();
        let max_range = sensor.max_range();
        self.bvh.visit(&bundle(&sensor, aim, radius), |face| {
            near.push(face.id);
            max_range
        });
        near.sort_unstable();
        Some(near)
    }

    /// The sensor and the aim at the centre of its cell (i, j), if there is such a cell.
    pub(crate) fn sensor_and_aim(&self, id: SensorId, i: u32, j: u32) -> Option<(MountedSensor, Aim)> {
        let sensor = MountedSensor::of(self.scene, id)?;
        let (width, height) = sensor.size();
        (i < width && j < height).then_some((sensor, Aim { i, j, dx: 0.0, dy: 0.0 }))
    }

    /// A face of the mesh, if the mesh has it.
    pub(crate) fn face(&self, face: FaceId) -> Option<Face> {
        let mesh = self.scene.mesh();
        ((face.0 as usize) < mesh.faces().len()).then(|| Face::of(mesh, face))
    }

    /// The nearest faces of one aim, in ascending order.
    pub(crate) fn nearest(&self, sensor: &MountedSensor, aim: Aim) -> Vec<&Face> {
        let ray = ExactRay::new(sensor, aim);
        let max_range = sensor.max_range();
        let mut nearest: Vec<&Face> = Vec::new();
        // The crossing of the first of them, and the range up to which faces matter.
        let mut kept: Option<(Crossing<Interval>, f64)> = None;
        self.bvh.visit(&bundle(sensor, aim, 0.0), |face| {
            if let Some(crossing) = face.met_by(&ray, max_range) {
                let order = kept.as_ref().map(|(kept, _)| {
                    let fast = crossing.before(kept).sign();
                    fast.unwrap_or_else(|| face.compare(nearest[0], &ray))
                });
                match order {
                    None | Some(Ordering::Less) => {
                        nearest.clear();
                        nearest.push(face);
                        let farthest = crossing.farthest_range(&ray, max_range);
                        kept = Some((crossing, farthest));
                    }
                    Some(Ordering::Equal) => nearest.push(face),
                    Some(Ordering::Greater) => {}
                }
            }
            kept.as_ref().map_or(max_range, |(_, farthest)| *farthest)
        });
        nearest.sort_by_key(|face| face.id);
        nearest
    }
}

/// The rays displaced from an aim by at most `radius` cells.
pub(crate) fn bundle(sensor: &MountedSensor, aim: Aim, radius: f64) -> RayBundle {
    bundle_of(&MovingRay::new(sensor, aim), sensor.max_range(), radius)
}

/// The same for a ray in f64, whose error is a few 2^-53: the hierarchy's slack is far wider.
pub(crate) fn bundle_of(ray: &MovingRay, max_range: f64, radius: f64) -> RayBundle {
    let (origin, direction) = ray.line();
    let (start_radius, spread) = ray.spread(radius);
    RayBundle { origin, direction: direction.normalize(), max_range, start_radius, spread }
}
