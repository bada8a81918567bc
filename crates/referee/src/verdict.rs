//! The exact answer for one ray: which faces are nearest, or that there is none.

use std::cmp::Ordering;
use std::sync::Arc;

use raypencil_scene::{FaceId, Scene, SensorId};

use crate::arithmetic::Whole;
use crate::cull::{Bundle, Tree};
use crate::face::{ExactRay, Face};
use crate::forms::MovingRay;
use crate::pencil::{Aim, Sensor};

/// What the contract says of a ray, without rounding.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Verdict {
    /// The faces met at the smallest t, in ascending order: several if they are met at exactly the same
    /// point, none if the ray meets no front within its range.
    pub faces: Vec<FaceId>,
}

impl Verdict {
    /// Whether there is a hit.
    pub fn is_hit(&self) -> bool {
        !self.faces.is_empty()
    }
}

/// A ray beside a cell's own.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Displacement {
    /// To the right, in cells of the sensor.
    pub dx: f64,
    /// Downwards, in cells of the sensor; in a beam this moves the ray's origin along the focal axis.
    pub dy: f64,
}

impl Displacement {
    /// None.
    pub const ZERO: Self = Self { dx: 0.0, dy: 0.0 };

    /// The larger of the two parts: the norm in which margins are measured.
    pub fn size(&self) -> f64 {
        self.dx.abs().max(self.dy.abs())
    }
}

/// Knows the true answer for every ray of a scene.
#[derive(Debug)]
pub struct Referee<'s> {
    pub(crate) scene: &'s Scene,
    pub(crate) tree: Tree,
    /// Of each beam's central pencils.
    pub(crate) wholes: Vec<Arc<Whole>>,
}

impl<'s> Referee<'s> {
    /// Prepares to judge the rays of `scene`.
    pub fn new(scene: &'s Scene) -> Self {
        let wholes = scene.beams().iter().map(|_| Arc::default()).collect();
        Self { scene, tree: Tree::build(scene.mesh()), wholes }
    }

    /// The exact verdict on the ray of cell (i, j), or `None` if there is no such cell.
    pub fn verdict(&self, sensor: SensorId, i: u32, j: u32) -> Option<Verdict> {
        self.verdict_beside(sensor, i, j, Displacement::ZERO)
    }

    /// The exact verdict on the ray that is displaced from cell (i, j) by any finite number of cells.
    pub fn verdict_beside(&self, sensor: SensorId, i: u32, j: u32, by: Displacement) -> Option<Verdict> {
        let sensor = Sensor::of(self.scene, sensor)?;
        let (width, height) = sensor.size();
        if i >= width || j >= height || !by.dx.is_finite() || !by.dy.is_finite() {
            return None;
        }
        let nearest = self.nearest(&sensor, Aim { i, j, dx: by.dx, dy: by.dy });
        Some(Verdict { faces: nearest.iter().map(|face| face.id).collect() })
    }

    /// The nearest faces of one aim, in ascending order.
    pub(crate) fn nearest(&self, sensor: &Sensor, aim: Aim) -> Vec<&Face> {
        let ray = ExactRay::new(sensor, aim);
        let max_range = sensor.max_range();
        let mut nearest: Vec<&Face> = Vec::new();
        self.tree.visit(&bundle(sensor, aim, 0.0), |face| {
            if face.is_met_by(&ray, max_range) {
                match nearest.first().map(|kept| face.compare(kept, &ray)) {
                    None | Some(Ordering::Less) => nearest = vec![face],
                    Some(Ordering::Equal) => nearest.push(face),
                    Some(Ordering::Greater) => {}
                }
            }
            // Nothing farther than the nearest matters from here on.
            nearest.first().map_or(max_range, |kept| kept.farthest_range(&ray, max_range))
        });
        nearest.sort_by_key(|face| face.id);
        nearest
    }
}

/// The rays that are displaced by at most `radius` cells from an aim, for the tree.
pub(crate) fn bundle(sensor: &Sensor, aim: Aim, radius: f64) -> Bundle {
    bundle_of(&MovingRay::new(sensor, aim), sensor.max_range(), radius)
}

/// The same for a ray in f64: good to a few 2^-53, and the tree's slack is far wider.
pub(crate) fn bundle_of(ray: &MovingRay, max_range: f64, radius: f64) -> Bundle {
    let (origin, direction) = ray.line();
    let (start_radius, spread) = ray.spread(radius);
    Bundle { origin, direction: direction.normalize(), reach: max_range, start_radius, spread }
}
