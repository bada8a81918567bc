//! The referee as a renderer: slow, and right about every face.
//!
//! Which face is nearest is exact. The values are formed in f64 from the middles of the intervals that
//! contain them, a third evaluation beside the two renderers'; they are rounded, not yet correctly rounded.

use std::time::Instant;

use glam::DVec3;
use rayon::prelude::*;
use raypencil_scene::{
    FaceId, Frame, Hit, Image, Mounted, Pixel, Renderer, Request, Resolution, Return, Returns, Scene,
    SensorId, SensorMap, Stage,
};

use crate::face::{ExactRay, Face};
use crate::light::Light;
use crate::number::Interval;
use crate::pencil::{Aim, Sensor};
use crate::vector::Vector;
use crate::verdict::Referee;

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
            let map = referee.map(id, request);
            stages.push(Stage { name: id.to_string(), time: start.elapsed() });
            map
        };
        let camera = if request.camera { timed(SensorId::Camera) } else { None };
        let beams = if request.beams { scene.beams().len() } else { 0 };
        let beams = (0..beams).filter_map(|index| timed(SensorId::Beam(index))).collect();
        let (mut returns, mut flux) = (Vec::new(), Vec::new());
        for index in 0..if request.returns { scene.beams().len() } else { 0 } {
            let start = Instant::now();
            if let Some(light) = referee.light(index, request.sampling) {
                let (of_beam, image) = all_returns(scene, &light, index);
                returns.push(of_beam);
                flux.push(image);
            }
            stages.push(Stage { name: format!("{} returns", SensorId::Beam(index)), time: start.elapsed() });
        }
        Frame { camera, beams, returns, flux, stages }
    }
}

/// The returns of a beam, and the flux that they add up to on the camera's image.
fn all_returns(scene: &Scene, light: &Light<'_, '_>, index: usize) -> (Returns, Image<f64>) {
    let beam = &scene.beams()[index].sensor;
    let camera = &scene.camera().sensor;
    let mut returns = Returns::empty(beam.columns, beam.rows);
    let mut image = Image::filled(camera.width, camera.height, 0.0);
    let rows: Vec<Vec<Option<Return>>> = (0..beam.rows)
        .into_par_iter()
        .map(|j| (0..beam.columns).map(|i| light.returned(i, j)).collect())
        .collect();
    // In row-major order, whatever thread it came from.
    for (j, row) in (0..).zip(&rows) {
        for (i, back) in (0..).zip(row) {
            let Some(back) = back else { continue };
            returns.put(i, j, back);
            if let (true, Some(Pixel { i, j })) = (back.visible, back.pixel) {
                image.set(i, j, image.at(i, j) + back.flux);
            }
        }
    }
    (returns, image)
}

impl Referee<'_> {
    /// The values of the hit of `face` by the ray of cell (i, j), in f64; `None` if there is no such cell or face,
    /// or the ray does not meet it.
    pub fn hit(&self, id: SensorId, i: u32, j: u32, face: FaceId) -> Option<Hit> {
        let sensor = Sensor::of(self.scene, id)?;
        let (width, height) = sensor.size();
        let mesh = self.scene.mesh();
        if i >= width || j >= height || face.0 as usize >= mesh.faces().len() {
            return None;
        }
        let aim = Aim { i, j, dx: 0.0, dy: 0.0 };
        let face = Face::of(mesh, face);
        let is_met = face.is_met_by(&ExactRay::new(&sensor, aim), sensor.max_range());
        is_met.then(|| hit(&sensor, aim, &face))
    }

    /// The values of where the ray of cell (i, j) meets the plane of `face`, in f64, whether or not it passes between its
    /// sides; `None` if there is no such cell or face. Not finite where they are parallel.
    pub fn plane_hit(&self, id: SensorId, i: u32, j: u32, face: FaceId) -> Option<Hit> {
        let sensor = Sensor::of(self.scene, id)?;
        let (width, height) = sensor.size();
        let mesh = self.scene.mesh();
        let is_there = i < width && j < height && (face.0 as usize) < mesh.faces().len();
        is_there.then(|| hit(&sensor, Aim { i, j, dx: 0.0, dy: 0.0 }, &Face::of(mesh, face)))
    }

    /// The maps of one sensor, or `None` if the scene has no such sensor.
    fn map(&self, id: SensorId, request: &Request) -> Option<SensorMap> {
        let sensor = Sensor::of(self.scene, id)?;
        let (width, height) = sensor.size();
        let mut map = SensorMap::empty(id, width, height, request.quantities);
        map.rows_mut().into_par_iter().for_each(|mut row| {
            for i in 0..width {
                let [dx, dy] = match id {
                    SensorId::Camera => [0.0; 2],
                    SensorId::Beam(index) => request.sampling.offset(index, i, row.j),
                };
                let aim = Aim { i, j: row.j, dx, dy };
                if let Some(face) = self.nearest(&sensor, aim).first() {
                    row.put(i, &hit(&sensor, aim, face));
                }
            }
        });
        Some(map)
    }
}

/// The hit of `face` by the ray of an aim that meets it.
fn hit(sensor: &Sensor, aim: Aim, face: &Face) -> Hit {
    let ray = sensor.ray::<Interval>(aim);
    let middle = |v: &Vector<Interval>| {
        let [x, y, z] = &v.0;
        DVec3::new(x.middle(), y.middle(), z.middle())
    };
    let [a, b, c] = face.corners.map(Vector::<Interval>::of_f32);
    let normal = b.sub(&a).cross(&c.sub(&a));
    let height = normal.dot(&a.scaled(&ray.origin_scale).sub(&ray.origin)).middle();
    let approach = normal.dot(&ray.direction).middle();
    let direction_length = ray.direction.length_squared().middle().sqrt();
    let normal_length = normal.length_squared().middle().sqrt();
    let (s, sigma) = (ray.origin_scale.middle(), ray.direction_scale.middle());
    // t along D: P = O / s + t D.
    let t = height / (s * approach);
    let depth_per_t = match sensor {
        Sensor::Camera(Mounted { sensor, .. }) => sensor.focal_length,
        Sensor::Beam(Mounted { sensor, .. }) => sensor.grid_distance,
    };
    Hit {
        face: face.id,
        range: t * direction_length,
        point: middle(&ray.origin) / s + middle(&ray.direction) * t,
        normal: middle(&normal) / normal_length,
        depth: t * sigma * depth_per_t,
        incidence: -approach / (normal_length * direction_length),
    }
}
