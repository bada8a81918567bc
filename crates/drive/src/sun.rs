//! The sun behind the stripes: what it and the sky put on the camera's pixels, and where its shadows fall. (Paper, §5)
//!
//! Both sides of a drive get the same background. It is not what they are compared in: `tracer` sees the ground for both.

use glam::DVec3;
use std::sync::Arc;

use crate::job::DriveJob;
use raypencil_scene::{
    Atmosphere, Camera, FluxModel, Image, Lens, Maybe, Mesh, Mounted, Pose, Quantities, Renderer, Request,
    Scene, SceneError,
};
use raypencil_sensor::{PointSource, Sunlight, VisibleSurface};
use raypencil_tracer::Tracer;

/// Cells of the map of shadows, along either side. CHOICE: 2.4 cm on 50 m.
const CELLS: u32 = 2048;

/// How far off the eye of that map stands, in radii of what it sees: its rays part from the sun's by a 400th, 2.5 mrad, less
/// than half of the sun's own disc on Mars (6 mrad).
const AWAY: f64 = 400.0;

/// A camera sees no farther, metres. (`scene`)
const FARTHEST: f64 = 1e7;

/// On more ground than this, metres about its middle, no shadow is looked for: a cell would be a kilometre.
const LARGEST: f64 = 1e6;

/// A point is in shadow if something is nearer to the sun by more than two cells' worth of its own slope, no more than this
/// many cells...
const STEEPEST: f64 = 20.0;

/// ... and by more than this, metres: of rounding.
const LEAST: f64 = 1e-3;

/// The camera sees the ground up to here, metres, whatever the range of its range map.
const SIGHT: f64 = 1e4;

/// Where the sun shines: ranges from far off in its direction.
struct Shadows {
    scene_from_eye: Pose,
    eye_from_scene: Pose,
    camera: Camera,
    ranges: Image<Maybe<f64>>,
    /// Side of a cell, metres.
    cell: f64,
}

impl Shadows {
    /// Of everything in a ball of the scene frame.
    fn new(mesh: &Arc<Mesh>, light: &Sunlight, centre: DVec3, radius: f64) -> Result<Self, SceneError> {
        let distance = (AWAY * radius).min(FARTHEST - radius);
        let towards = Pose::from_axis_angle(DVec3::Z, light.azimuth + std::f64::consts::PI)
            * Pose::from_axis_angle(DVec3::Y, light.elevation)
            * Pose::VEHICLE_FROM_FORWARD_SENSOR;
        let scene_from_eye = Pose { position: centre + light.direction() * distance, ..towards };
        let pitch = 1e-5;
        let camera = Camera {
            width: CELLS,
            height: CELLS,
            pixel_pitch: [pitch; 2],
            // The ball fills the image.
            focal_length: 0.5 * f64::from(CELLS) * pitch * (distance - radius) / radius,
            principal_point: [0.5 * f64::from(CELLS); 2],
            aperture: 1e-3,
            lens: Lens::CLEAR,
            max_range: distance + radius,
        };
        let frame = see(mesh, camera, scene_from_eye, Quantities::RANGE_MAP)?;
        Ok(Self {
            scene_from_eye,
            eye_from_scene: scene_from_eye.inverse(),
            camera,
            ranges: frame.range.expect("what was asked for"),
            cell: 2.0 * radius / f64::from(CELLS),
        })
    }

    /// Whether nothing stands between a point of a face and the sun; beyond the ball nothing does.
    fn is_sunlit(&self, point: DVec3, normal: DVec3) -> bool {
        let seen = PointSource::project(&self.camera, self.eye_from_scene * point, 0.0);
        let inside = |at: f64| (0.0..f64::from(CELLS)).contains(&at);
        if !(inside(seen.x) && inside(seen.y)) {
            return true;
        }
        let to_sun = self.scene_from_eye.position - point;
        let range = to_sun.length();
        let facing = normal.dot(to_sun) / range;
        let slope = ((1.0 - facing * facing).max(0.0).sqrt() / facing.abs().max(1e-9)).min(STEEPEST);
        let nearest = self.ranges.at(seen.x as u32, seen.y as u32).get();
        nearest.is_none_or(|nearest| nearest >= range - (2.0 * self.cell * slope + LEAST))
    }
}

/// One sensor's map of the ground.
fn see(
    mesh: &Arc<Mesh>,
    camera: Camera,
    scene_from_sensor: Pose,
    quantities: Quantities,
) -> Result<raypencil_scene::SensorMap, SceneError> {
    let mounted = Mounted { scene_from_sensor, sensor: camera };
    let scene = Scene::new(
        Arc::clone(mesh),
        mounted,
        Vec::new(),
        Atmosphere { attenuation: 0.0 },
        FluxModel::Radiometric,
    )?;
    let request = Request { beams: false, returns: false, quantities, ..Request::EVERYTHING };
    Ok(Tracer::new().render(&scene, &request).camera.expect("what was asked for"))
}

/// The sun of a drive.
pub struct Sun {
    light: Sunlight,
    tracer: Tracer,
    shadows: Option<Shadows>,
}

impl Sun {
    /// That of a job, if it has one.
    pub(super) fn of(job: &DriveJob) -> Result<Option<Self>, SceneError> {
        let Some(light) = job.sunlight else { return Ok(None) };
        let shadows = match ball(job) {
            Some((centre, radius)) if light.direct > 0.0 && radius <= LARGEST => {
                Some(Shadows::new(&job.mesh, &light, centre, radius)?)
            }
            _ => None,
        };
        Ok(Some(Self { light, tracer: Tracer::new(), shadows }))
    }

    /// What sun and sky put on each pixel of a scene's camera, watts, through the job's dust.
    pub(super) fn background(&self, job: &DriveJob, scene: &Scene) -> Image<f64> {
        let mounted = *scene.camera();
        let camera = Camera { max_range: SIGHT, ..mounted.sensor };
        let far = Scene::new(
            Arc::clone(scene.mesh()),
            Mounted { sensor: camera, ..mounted },
            Vec::new(),
            scene.atmosphere(),
            scene.flux_model(),
        )
        .expect("a scene that was one already");
        let quantities = Quantities { normal: true, point: true, ..Quantities::RANGE_MAP };
        let request = Request { beams: false, returns: false, quantities, ..Request::EVERYTHING };
        let map = self.tracer.render(&far, &request).camera.expect("what was asked for");
        let (range, face) = (map.range.expect("asked for"), map.face.expect("asked for"));
        let (normal, point) = (map.normal.expect("asked for"), map.point.expect("asked for"));

        let mesh = scene.mesh();
        let materials = (mesh.face_materials(), mesh.materials());
        let reflectivity = face.cells().iter().map(|face| {
            face.get().map_or(0.0, |face| {
                let of_face = materials.0.get(face.0 as usize).copied().unwrap_or(0);
                materials.1[usize::from(of_face)].reflectivity
            })
        });
        let reflectivity = Image::from_cells(camera.width, camera.height, reflectivity.collect());
        let sunlit = point.cells().iter().zip(normal.cells()).map(|(point, normal)| {
            match (&self.shadows, point.get(), normal.get()) {
                (Some(shadows), Some(point), Some(normal)) => shadows.is_sunlit(point, normal),
                _ => true,
            }
        });
        let sunlit = Image::from_cells(camera.width, camera.height, sunlit.collect());
        let ground =
            VisibleSurface { normal: &normal, range: &range, reflectivity: &reflectivity, sunlit: &sunlit };
        let flux = self.light.flux(&camera, scene.atmosphere().attenuation, &ground);
        job.optics.filter_pixels(&camera, &flux)
    }
}

/// A ball of the scene frame about all that the camera's range reaches from the route, or about the whole ground if that is
/// less.
fn ball(job: &DriveJob) -> Option<(DVec3, f64)> {
    let vertices = job.mesh.vertices().iter().map(|vertex| DVec3::from(vertex.map(f64::from)));
    let bounds = |(low, high): (DVec3, DVec3), place: DVec3| (low.min(place), high.max(place));
    let none = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    let (low, high) = vertices.fold(none, bounds);
    if !(low.is_finite() && high.is_finite()) {
        return None;
    }
    let whole = (0.5 * (low + high), 0.5 * (high - low).length());
    let middle = whole.0.z;
    let route = &job.plan.route;
    let places = std::iter::once(route.start).chain(route.waypoints.iter().copied());
    let (from, to) =
        places.map(|place| (place.extend(0.0) - job.mesh.origin()).with_z(middle)).fold(none, bounds);
    let reach = 0.5 * (to - from).length() + job.plan.rig.camera.sensor.max_range + 0.5 * (high.z - low.z);
    let near = (0.5 * (from + to), reach);
    Some(if near.1 < whole.1 { near } else { (whole.0, whole.1.max(1.0)) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wall_has_its_shadow_behind_it() {
        // 100 m of flat ground, and a wall 1 m high on x = 0 from y = -5 to y = 5; it faces the sun.
        let place = |x: f64, y: f64, z: f64| DVec3::new(x, y, z);
        let ground = [
            place(-50.0, -50.0, 0.0),
            place(50.0, -50.0, 0.0),
            place(50.0, 50.0, 0.0),
            place(-50.0, 50.0, 0.0),
        ];
        let wall = [place(0.0, -5.0, 0.0), place(0.0, 5.0, 0.0), place(0.0, 5.0, 1.0), place(0.0, -5.0, 1.0)];
        let vertices = [ground, wall].concat();
        let faces = vec![[0, 1, 2], [0, 2, 3], [4, 6, 5], [4, 7, 6]];
        let mesh = super::super::tests::mesh(&vertices, faces);
        // The sun is behind, 45 degrees high: the shadow is 1 m long.
        let light = Sunlight::mars(45.0_f64.to_radians(), 180.0_f64.to_radians(), 0.5);
        let centre = -mesh.origin();
        let shadows = Shadows::new(&mesh, &light, centre, 30.0).unwrap();
        let lit = |x: f64, y: f64, z: f64| shadows.is_sunlit(place(x, y, z) - mesh.origin(), DVec3::Z);
        assert!(!lit(0.2, 0.0, 0.0) && !lit(0.9, 4.8, 0.0), "behind the wall");
        assert!(lit(1.1, 0.0, 0.0) && lit(0.5, 5.2, 0.0) && lit(-0.3, 0.0, 0.0), "beside it");
        // The wall's own face towards the sun.
        assert!(shadows.is_sunlit(place(0.0, 0.0, 0.5) - mesh.origin(), -DVec3::X));
        // Nothing is known beyond.
        assert!(lit(45.0, 0.0, 0.0));
    }
}
