//! All rules on one scene.

pub(crate) mod file;
pub(crate) mod hits;
pub(crate) mod image;
pub(crate) mod terrain;
pub(crate) mod vehicle;

use std::sync::Arc;

use raypencil_scene::{Mesh, Pose, Scene, SensorId};

use crate::facing::BothSides;
use crate::warning::Warning;
use hits::{SensorHits, few_hits, mostly_backs, no_hits};
use image::{principal_point_off_centre, principal_point_outside};
use terrain::{TerrainShape, terrain_on_its_side, terrain_too_large};
use vehicle::{height_above_ground, too_high, too_low};

/// Warnings about a scene: first those of the sensors in their order, then those of the terrain and of the vehicle.
///
/// `vehicle` is the vehicle's pose in the global frame; a resolved scene has none. `hits` are those of a render of this
/// scene; without them every ray is traced here.
pub fn warnings(scene: &Scene, vehicle: Option<&Pose>, hits: Option<&[SensorHits]>) -> Vec<Warning> {
    Surveyor::default().warnings(scene, vehicle, hits)
}

/// Looks at scene after scene, and keeps what it knows of their terrain as long as that is the same one in memory.
#[derive(Debug, Default)]
pub struct Surveyor {
    both_sides: BothSides,
    shape: Option<(Arc<Mesh>, Option<TerrainShape>)>,
}

impl Surveyor {
    /// Warnings about a scene, as [`warnings`] gives them.
    pub fn warnings(
        &mut self,
        scene: &Scene,
        vehicle: Option<&Pose>,
        hits: Option<&[SensorHits]>,
    ) -> Vec<Warning> {
        let traced;
        let hits = match hits {
            Some(hits) => hits,
            None => {
                traced = SensorHits::of_scene(scene);
                &traced
            }
        };
        let facings = self.both_sides.facings(scene);
        let mut found = Vec::new();
        for sensor in scene.sensors() {
            for of in hits.iter().filter(|of| of.sensor == sensor) {
                found.extend(no_hits(*of).or_else(|| few_hits(*of)));
            }
            found.extend(facings.iter().filter(|of| of.sensor == sensor).find_map(|of| mostly_backs(*of)));
            if sensor == SensorId::Camera {
                let camera = &scene.camera().sensor;
                found.extend(principal_point_outside(camera).or_else(|| principal_point_off_centre(camera)));
            }
        }
        if let Some(shape) = self.shape_of(scene.mesh()) {
            let ranges = scene.sensors().filter_map(|sensor| scene.max_range(sensor));
            found.extend(terrain_on_its_side(&shape));
            found.extend(terrain_too_large(&shape, ranges.fold(0.0, f64::max)));
        }
        if let Some(height) = vehicle.and_then(|vehicle| height_above_ground(scene.mesh(), vehicle)) {
            found.extend(too_high(height).or_else(|| too_low(height)));
        }
        found
    }

    fn shape_of(&mut self, mesh: &Arc<Mesh>) -> Option<TerrainShape> {
        match &self.shape {
            Some((of, shape)) if Arc::ptr_eq(of, mesh) => *shape,
            _ => {
                let shape = TerrainShape::of(mesh);
                self.shape = Some((Arc::clone(mesh), shape));
                shape
            }
        }
    }
}
