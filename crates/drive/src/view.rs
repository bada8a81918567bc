//! What the camera sees of the ground, for people: faces shaded, their borders drawn, stripes in the beams' colours.
//! The paper's figures 11 and 14 draw faces by their edges.

use glam::DVec3;
use std::sync::Arc;

use crate::job::{DriveError, DriveJob};
use raypencil_rover::{MeasuredPoint, OnVehicle, Rig};
use raypencil_scene::{Camera, Image, Pose, Quantities, Renderer, Request, SceneError};
use raypencil_sensor::PointSource;

/// Colours of the beams' stripes; more beams begin again.
pub(crate) const BEAM_COLOURS: [[u8; 3]; 4] = [[226, 35, 26], [0, 104, 201], [0, 140, 60], [170, 60, 190]];

/// Where there is no ground.
const SKY: [u8; 3] = [233, 231, 226];

/// How dark borders of faces are.
const BORDER: f64 = 0.45;

/// Pixels about one on a border, along either side, of which some have to be of its own face: where faces are no larger than
/// a few pixels, as far away, borders would darken all of the ground.
const ABOUT: u32 = 5;

/// With so many no border is drawn, and with so many all of it.
const OWN: [f64; 2] = [3.0, 10.0];

/// A picture of what the camera sees: some of its pixels become one.
#[derive(Debug, Clone, PartialEq)]
pub struct View {
    pub width: u32,
    pub height: u32,
    /// Red, green, blue, row by row from the top.
    pub pixels: Vec<[u8; 3]>,
    /// Pixels of the camera to one of the picture, along either side.
    pub reduction: u32,
    /// The camera's own size.
    pub camera: [u32; 2],
}

impl View {
    fn paint(&mut self, i: u32, j: u32, beam: usize) {
        let (i, j) = (i / self.reduction, j / self.reduction);
        if i < self.width && j < self.height {
            self.pixels[(j * self.width + i) as usize] = BEAM_COLOURS[beam % BEAM_COLOURS.len()];
        }
    }

    /// With the points of stripes, where the camera as it is mounted sees them: that of a scan is panned.
    pub(super) fn with_edges(mut self, rig: &Rig, measured: &[MeasuredPoint]) -> Self {
        let OnVehicle { vehicle_from_sensor, sensor } = rig.camera;
        let camera_from_vehicle = vehicle_from_sensor.inverse();
        for MeasuredPoint { beam, point, .. } in measured {
            let seen = camera_from_vehicle * *point;
            if seen.z > 0.0 {
                let place = PointSource::project(&sensor, seen, 0.0);
                if place.x >= 0.0 && place.y >= 0.0 {
                    self.paint(place.x as u32, place.y as u32, *beam);
                }
            }
        }
        self
    }

    /// With the light itself: every pixel that the extraction's level lets pass.
    pub(super) fn with_light(mut self, images: &[(Option<usize>, Image<i32>)], level: f64) -> Self {
        for (beam, image) in images {
            for j in 0..image.height() {
                for i in 0..image.width() {
                    if f64::from(image.at(i, j)) >= level.max(1.0) {
                        self.paint(i, j, beam.unwrap_or(0));
                    }
                }
            }
        }
        self
    }
}

/// A camera with fewer, larger pixels: the same view in at most `most` columns and rows.
fn reduced(camera: &Camera, most: u32) -> (Camera, u32) {
    let k = camera.width.max(camera.height).div_ceil(most);
    let [width, height] = [camera.width, camera.height].map(|side| (side / k).max(1));
    let share = f64::from(k);
    // The same view by larger pixels, or where a camera may have none as large (0.1 m) by a shorter focal length.
    let larger = camera.pixel_pitch.map(|pitch| pitch * share);
    let (pixel_pitch, focal_length) = if larger[0].max(larger[1]) <= 0.1 {
        (larger, camera.focal_length)
    } else {
        (camera.pixel_pitch, camera.focal_length / share)
    };
    let camera = Camera {
        width,
        height,
        pixel_pitch,
        focal_length,
        principal_point: camera.principal_point.map(|point| point / share),
        ..*camera
    };
    (camera, k)
}

/// What the camera of a vehicle at `global_from_vehicle` sees, without stripes.
pub(crate) fn view(
    job: &DriveJob,
    renderer: &dyn Renderer,
    global_from_vehicle: &Pose,
    most: u32,
) -> Result<View, DriveError> {
    let (camera, reduction) = reduced(&job.plan.rig.camera.sensor, most);
    let rig = Rig { camera: OnVehicle { sensor: camera, ..job.plan.rig.camera }, beams: Vec::new() };
    let scene =
        rig.scene(Arc::clone(&job.mesh), *global_from_vehicle, job.plan.atmosphere, job.plan.flux_model)?;
    let quantities = Quantities { normal: true, point: false, ..Quantities::RANGE_MAP };
    let request = Request { beams: false, returns: false, quantities, ..Request::EVERYTHING };
    let frame = renderer.render(&scene, &request);
    let map = frame.camera.and_then(|map| map.face.zip(map.normal));
    let Some((faces, normals)) = map else {
        return Err(SceneError::new(renderer.name(), "no camera map", "faces and normals").into());
    };
    // Light for people, not the sun's: from the left, behind and above.
    let light = (global_from_vehicle.rotate(DVec3::new(-0.4, 0.5, 0.0)) + DVec3::Z).normalize();
    let shade = |i: u32, j: u32| -> [u8; 3] {
        let Some(normal) = normals.at(i, j).get() else { return SKY };
        let grey = 0.35 + 0.6 * normal.normalize_or_zero().dot(light).max(0.0);
        let face = |i: u32, j: u32| faces.at(i.min(camera.width - 1), j.min(camera.height - 1)).get();
        let inside = face(i + 1, j) == face(i, j) && face(i, j + 1) == face(i, j);
        let border = if inside {
            0.0
        } else {
            let about = (0..ABOUT).flat_map(|dj| (0..ABOUT).map(move |di| (di, dj)));
            let own = about.filter(|&(di, dj)| {
                face((i + di).saturating_sub(ABOUT / 2), (j + dj).saturating_sub(ABOUT / 2)) == face(i, j)
            });
            BORDER * ((own.count() as f64 - OWN[0]) / (OWN[1] - OWN[0])).clamp(0.0, 1.0)
        };
        let grey = grey * (1.0 - border);
        [0.98, 0.9, 0.82].map(|part| (255.0 * (grey * part).clamp(0.0, 1.0)) as u8)
    };
    let pixels = (0..camera.height).flat_map(|j| (0..camera.width).map(move |i| (i, j)));
    Ok(View {
        width: camera.width,
        height: camera.height,
        pixels: pixels.map(|(i, j)| shade(i, j)).collect(),
        reduction,
        camera: [job.plan.rig.camera.sensor.width, job.plan.rig.camera.sensor.height],
    })
}
