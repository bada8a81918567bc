//! The referee as a renderer: slow, and right about every face.
//!
//! Which face is nearest is exact, and every value is correctly rounded.

use std::time::Instant;

use raypencil_scene::{FaceId, Frame, Renderer, Request, Resolution, Scene, SensorId, Stage};

use crate::face::{ExactRay, Face};
use crate::pencil::{Aim, Sensor};
use crate::rounding::Format;
use crate::values::{RoundedHit, values};
use crate::verdict::{Referee, bundle};

/// The exact verdict on every cell, as maps.
#[derive(Debug, Clone, Copy, Default)]
pub struct ExactRenderer;

impl Renderer for ExactRenderer {
    fn name(&self) -> &str {
        "referee"
    }

    fn resolution(&self) -> Resolution {
        Resolution::F64
    }

    fn render(&self, scene: &Scene, request: &Request) -> Frame {
        let start = Instant::now();
        let referee = Referee::new(scene);
        let mut stages = vec![Stage { name: "tree".into(), time: start.elapsed() }];
        let mut timed = |id: SensorId| {
            let start = Instant::now();
            let map = referee.certified_map(id, request.sampling);
            let map = map.map(|map| map.in_format(Format::Double, request.quantities));
            stages.push(Stage { name: id.to_string(), time: start.elapsed() });
            map
        };
        let camera = if request.camera { timed(SensorId::Camera) } else { None };
        let beams = if request.beams { scene.beams().len() } else { 0 };
        let beams = (0..beams).filter_map(|index| timed(SensorId::Beam(index))).collect();
        let (mut returns, mut flux) = (Vec::new(), Vec::new());
        for index in 0..if request.returns { scene.beams().len() } else { 0 } {
            let start = Instant::now();
            if let Some(light) = referee.certified_light(index, request.sampling) {
                let model = scene.flux_model();
                returns.push(light.returns_in(Format::Double, model));
                flux.push(light.image_in(Format::Double, model));
            }
            stages.push(Stage { name: format!("{} returns", SensorId::Beam(index)), time: start.elapsed() });
        }
        Frame { camera, beams, returns, flux, stages }
    }
}

impl Referee<'_> {
    /// The values of the hit of `face` by the ray of cell (i, j); `None` if there is no such cell or face, or the
    /// ray does not meet it.
    pub fn hit(&self, id: SensorId, i: u32, j: u32, face: FaceId) -> Option<RoundedHit> {
        let (sensor, aim) = self.aim_at(id, i, j)?;
        let face = self.face(face)?;
        let is_met = face.is_met_by(&ExactRay::new(&sensor, aim), sensor.max_range());
        is_met.then(|| values(&sensor, aim, &face)).flatten()
    }

    /// The values of where the ray of cell (i, j) meets the plane of `face`, whether or not it passes between its
    /// sides; `None` if there is no such cell or face, or they are parallel.
    pub fn plane_hit(&self, id: SensorId, i: u32, j: u32, face: FaceId) -> Option<RoundedHit> {
        let (sensor, aim) = self.aim_at(id, i, j)?;
        values(&sensor, aim, &self.face(face)?)
    }

    /// The faces that a ray displaced from cell (i, j) by at most `radius` cells may meet, and some more, in ascending
    /// order; `None` if there is no such cell.
    pub fn faces_near(&self, id: SensorId, i: u32, j: u32, radius: f64) -> Option<Vec<FaceId>> {
        let (sensor, aim) = self.aim_at(id, i, j)?;
        let mut near = Vec::new();
        let max_range = sensor.max_range();
        self.tree.visit(&bundle(&sensor, aim, radius), |face| {
            near.push(face.id);
            max_range
        });
        near.sort_unstable();
        Some(near)
    }

    /// A sensor and the aim at the middle of its cell (i, j), if there is such a cell.
    pub(crate) fn aim_at(&self, id: SensorId, i: u32, j: u32) -> Option<(Sensor, Aim)> {
        let sensor = Sensor::of(self.scene, id)?;
        let (width, height) = sensor.size();
        (i < width && j < height).then_some((sensor, Aim { i, j, dx: 0.0, dy: 0.0 }))
    }

    /// A face of the mesh.
    pub(crate) fn face(&self, face: FaceId) -> Option<Face> {
        let mesh = self.scene.mesh();
        ((face.0 as usize) < mesh.faces().len()).then(|| Face::of(mesh, face))
    }
}
