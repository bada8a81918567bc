//! Sun behind the stripes: the light that sun and sky put on the camera's pixels. (Paper, §5)
//!
//! Both sides of a drive get the same background, which is not compared: `tracer` computes the visible ground for both.

use std::sync::Arc;

use glam::DVec3;
use raypencil_scene::{Camera, Image, Mounted, Quantities, Renderer, Request, Scene, SceneError};
use raypencil_sensor::{Sunlight, VisibleSurface};
use raypencil_tracer::Tracer;

use crate::job::DriveJob;
use crate::shadow_map::ShadowMap;

/// Range up to which the ground is visible in the background, metres. The camera's own maximum range limits its range
/// map only.
const BACKGROUND_MAX_RANGE_M: f64 = 1e4;

pub(crate) struct Sun {
    light: Sunlight,
    tracer: Tracer,
    /// `None`: no ground is in shadow.
    shadows: Option<ShadowMap>,
}

impl Sun {
    /// Sun of a job, if it has one.
    ///
    /// # Errors
    /// A shadow camera that `scene` refuses.
    pub(crate) fn of(job: &DriveJob) -> Result<Option<Self>, SceneError> {
        let Some(light) = job.sunlight else { return Ok(None) };
        let shadows = match ball(job) {
            Some(ball) => ShadowMap::of_ball(&job.mesh, &light, ball)?,
            None => None,
        };
        Ok(Some(Self { light, tracer: Tracer::new(), shadows }))
    }

    /// Flux of sun and sky on each pixel of a scene's camera, watts, through the dust of the job's optics.
    pub(crate) fn background(&self, job: &DriveJob, scene: &Scene) -> Image<f64> {
        let mounted = *scene.camera();
        let camera = Camera { max_range: BACKGROUND_MAX_RANGE_M, ..mounted.sensor };
        let far = Scene::new(
            Arc::clone(scene.mesh()),
            Mounted { sensor: camera, ..mounted },
            Vec::new(),
            scene.atmosphere(),
            scene.flux_model(),
        )
        .expect("the scene is valid with any maximum range");
        let quantities = Quantities { normal: true, point: true, ..Quantities::RANGE_MAP };
        let request = Request { beams: false, returns: false, quantities, ..Request::EVERYTHING };
        let map = self.tracer.render(&far, &request).camera.expect("the camera's map was requested");
        let (range, face) = (map.range.expect("was requested"), map.face.expect("was requested"));
        let (normal, point) = (map.normal.expect("was requested"), map.point.expect("was requested"));

        let mesh = scene.mesh();
        let (face_materials, materials) = (mesh.face_materials(), mesh.materials());
        let reflectivity = face.cells().iter().map(|face| {
            face.get().map_or(0.0, |face| {
                let material = face_materials.get(face.0 as usize).copied().unwrap_or(0);
                materials[usize::from(material)].reflectivity
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

/// Centre and radius, metres, of a ball in the scene frame around everything that the camera's range reaches from the
/// route, or around the whole ground if that ball is smaller. `None` if a vertex is not finite or there is none.
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
    use raypencil_scene::Pose;

    use super::*;
    use crate::common::{FLAT, SHORT, job, mesh};

    #[test]
    fn ground_in_shadow_is_darker() {
        // The camera is at x = 0.3 m, 1.5 m up, and looks 20 degrees down. The sun is behind it, 10 degrees high. A
        // wall of 0.5 m at x = 3 m casts a shadow up to 3 + 0.5 / tan 10 = 5.84 m.
        let mut job = job(
            FLAT,
            &format!("{SHORT}\nsun = {{ elevation_deg = 10, azimuth_deg = 180, optical_depth = 0.1 }}"),
        );
        let p = DVec3::new;
        let ground = [p(-30.0, -30.0, 0.0), p(30.0, -30.0, 0.0), p(30.0, 30.0, 0.0), p(-30.0, 30.0, 0.0)];
        let wall = [p(3.0, -9.0, 0.0), p(3.0, 9.0, 0.0), p(3.0, 9.0, 0.5), p(3.0, -9.0, 0.5)];
        job.mesh = mesh(&[ground, wall].concat(), vec![[0, 1, 2], [0, 2, 3], [4, 6, 5], [4, 7, 6]]);
        let sun = Sun::of(&job).unwrap().unwrap();
        let (rig, mesh) = (&job.plan.rig, Arc::clone(&job.mesh));
        let scene = rig.scene(mesh, Pose::IDENTITY, job.plan.atmosphere, job.plan.flux_model).unwrap();
        let background = sun.background(&job, &scene);
        // x = 5 m is atan(1.5 / 4.7) = 17.7 degrees down, 4.5 rows of 72 um above the middle at 8 mm. x = 8 m is 11
        // degrees down, 17.6 rows above the middle.
        let (shadow, lit) = (background.at(64, 59), background.at(64, 46));
        // The sky alone gives 0.35 of the light of sun and sky.
        assert!(shadow > 0.0 && (0.25..0.45).contains(&(shadow / lit)), "{shadow} and {lit}");
    }
}
