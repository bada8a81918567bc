//! Camera's view of the ground as a picture: shaded faces, their borders, and the stripes in the beams' colours. The
//! paper's figures 11 and 14 draw faces by their edges.

use std::sync::Arc;

use glam::DVec3;
use raypencil_rover::{MeasuredPoint, OnVehicle, Rig};
use raypencil_scene::{Camera, Image, Pose, Quantities, Renderer, Request, SceneError};
use raypencil_sensor::PointSource;

use crate::error::DriveError;
use crate::job::DriveJob;

/// Colours of the beams' stripes. With more than four beams they repeat.
pub(crate) const BEAM_COLOURS: [[u8; 3]; 4] = [[226, 35, 26], [0, 104, 201], [0, 140, 60], [170, 60, 190]];

/// Colour of pixels without ground.
const SKY_COLOUR: [u8; 3] = [233, 231, 226];

/// Fraction by which a full border darkens a face.
const BORDER_DARKENING: f64 = 0.45;

/// Side of the window around a border pixel, pixels. The pixels of its own face in it are counted: where faces are only
/// a few pixels large, as at a distance, full borders would darken all of the ground.
const BORDER_WINDOW_PX: u32 = 5;

/// Same-face pixels in the window: up to 3, no border; from 10, the full border; linear between.
const BORDER_OWN_PX: [f64; 2] = [3.0, 10.0];

/// Largest pixel pitch of a camera, metres, enforced by `scene`.
const MAX_PIXEL_PITCH_M: f64 = 0.1;

/// Picture of the camera's view, at a reduced size.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct CameraView {
    /// Columns of the picture.
    pub width: u32,
    /// Rows of the picture.
    pub height: u32,
    /// Red, green, blue, row by row from the top.
    pub pixels: Vec<[u8; 3]>,
    /// Pixels of the camera per pixel of the picture, along either side.
    pub reduction: u32,
    /// Columns and rows of the camera itself.
    pub camera_size: [u32; 2],
}

impl CameraView {
    /// Paints a pixel of the camera in a beam's colour.
    fn paint(&mut self, i: u32, j: u32, beam: usize) {
        let (i, j) = (i / self.reduction, j / self.reduction);
        if i < self.width && j < self.height {
            self.pixels[(j * self.width + i) as usize] = BEAM_COLOURS[beam % BEAM_COLOURS.len()];
        }
    }

    /// View with the measured points of the stripes, where the camera sees them as it is mounted. (In a scan the camera
    /// is panned.)
    pub(crate) fn with_edges(mut self, rig: &Rig, measured: &[MeasuredPoint]) -> Self {
        let OnVehicle { vehicle_from_sensor, sensor } = rig.camera;
        let camera_from_vehicle = vehicle_from_sensor.inverse();
        for MeasuredPoint { beam, point, .. } in measured {
            let in_camera = camera_from_vehicle * *point;
            if in_camera.z > 0.0 {
                let image = PointSource::project(&sensor, in_camera, 0.0);
                if image.x >= 0.0 && image.y >= 0.0 {
                    self.paint(image.x as u32, image.y as u32, *beam);
                }
            }
        }
        self
    }

    /// View with every pixel whose digital number reaches the extraction's threshold, at least 1 DN, in the colour of
    /// the image's beam.
    pub(crate) fn with_lit_pixels(mut self, images: &[(Option<usize>, Image<i32>)], threshold: f64) -> Self {
        for (beam, image) in images {
            for j in 0..image.height() {
                for i in 0..image.width() {
                    if f64::from(image.at(i, j)) >= threshold.max(1.0) {
                        self.paint(i, j, beam.unwrap_or(0));
                    }
                }
            }
        }
        self
    }
}

/// Camera with the same view in at most `max_side` columns and rows, and the reduction along either side.
fn reduced(camera: &Camera, max_side: u32) -> (Camera, u32) {
    let reduction = camera.width.max(camera.height).div_ceil(max_side);
    let [width, height] = [camera.width, camera.height].map(|side| (side / reduction).max(1));
    let factor = f64::from(reduction);
    // Larger pixels, or a shorter focal length where a camera may not have pixels that large.
    let larger = camera.pixel_pitch.map(|pitch| pitch * factor);
    let (pixel_pitch, focal_length) = if larger[0].max(larger[1]) <= MAX_PIXEL_PITCH_M {
        (larger, camera.focal_length)
    } else {
        (camera.pixel_pitch, camera.focal_length / factor)
    };
    let camera = Camera {
        width,
        height,
        pixel_pitch,
        focal_length,
        principal_point: camera.principal_point.map(|point| point / factor),
        ..*camera
    };
    (camera, reduction)
}

/// View of the job's camera on a vehicle at `global_from_vehicle`, without stripes, in at most `max_side` columns and
/// rows.
///
/// # Errors
/// A scene that `scene` refuses; a renderer that returns no faces or normals of the camera.
pub(crate) fn camera_view(
    job: &DriveJob,
    renderer: &dyn Renderer,
    global_from_vehicle: &Pose,
    max_side: u32,
) -> Result<CameraView, DriveError> {
    let (camera, reduction) = reduced(&job.plan.rig.camera.sensor, max_side);
    let rig = Rig { camera: OnVehicle { sensor: camera, ..job.plan.rig.camera }, beams: Vec::new() };
    let scene =
        rig.scene(Arc::clone(&job.mesh), *global_from_vehicle, job.plan.atmosphere, job.plan.flux_model)?;
    let quantities = Quantities { normal: true, point: false, ..Quantities::RANGE_MAP };
    let request = Request { beams: false, returns: false, quantities, ..Request::EVERYTHING };
    let output = renderer.render(&scene, &request);
    let map = output.camera.and_then(|map| map.face.zip(map.normal));
    let Some((faces, normals)) = map else {
        return Err(SceneError::new(renderer.name(), "no camera map", "faces and normals").into());
    };
    // Light of the picture, not of the sun: from the left, from behind and from above.
    let light = (global_from_vehicle.rotate(DVec3::new(-0.4, 0.5, 0.0)) + DVec3::Z).normalize();
    let shade = |i: u32, j: u32| -> [u8; 3] {
        let Some(normal) = normals.at(i, j).get() else { return SKY_COLOUR };
        let grey = 0.35 + 0.6 * normal.normalize_or_zero().dot(light).max(0.0);
        let face = |i: u32, j: u32| faces.at(i.min(camera.width - 1), j.min(camera.height - 1)).get();
        let inside = face(i + 1, j) == face(i, j) && face(i, j + 1) == face(i, j);
        let border = if inside {
            0.0
        } else {
            let (side, [none, full]) = (BORDER_WINDOW_PX, BORDER_OWN_PX);
            let window = (0..side).flat_map(|dj| (0..side).map(move |di| (di, dj)));
            let own = window.filter(|&(di, dj)| {
                face((i + di).saturating_sub(side / 2), (j + dj).saturating_sub(side / 2)) == face(i, j)
            });
            BORDER_DARKENING * ((own.count() as f64 - none) / (full - none)).clamp(0.0, 1.0)
        };
        let grey = grey * (1.0 - border);
        [0.98, 0.9, 0.82].map(|part| (255.0 * (grey * part).clamp(0.0, 1.0)) as u8)
    };
    let pixels = (0..camera.height).flat_map(|j| (0..camera.width).map(move |i| (i, j)));
    Ok(CameraView {
        width: camera.width,
        height: camera.height,
        pixels: pixels.map(|(i, j)| shade(i, j)).collect(),
        reduction,
        camera_size: [job.plan.rig.camera.sensor.width, job.plan.rig.camera.sensor.height],
    })
}

#[cfg(test)]
mod tests {
    use raypencil_rover::EdgePoint;

    use super::*;
    use crate::common::{FLAT, SHORT, job};

    #[test]
    fn points_of_a_scan_are_drawn_where_the_camera_sees_them() {
        // A point 4 m along the axis of the camera as it is mounted, measured by the panned camera: the middle of the
        // view.
        let job = job(FLAT, SHORT);
        let mount = job.plan.rig.camera.vehicle_from_sensor;
        let edge = EdgePoint { i: 3, j: 5, row: 5.5 };
        let measured = MeasuredPoint {
            step: Some(7),
            beam: 1,
            edge,
            point: mount * DVec3::new(1e-6, 1e-6, 4.0),
            standard_error: 0.0,
        };
        let behind = MeasuredPoint { point: mount * DVec3::new(0.0, 0.0, -1.0), ..measured };
        let blank = [9; 3];
        let view = CameraView {
            width: 128,
            height: 128,
            pixels: vec![blank; 128 * 128],
            reduction: 1,
            camera_size: [128, 128],
        };
        let view = view.with_edges(&job.plan.rig, &[measured, behind]);
        let painted: Vec<usize> = (0..128 * 128).filter(|&index| view.pixels[index] != blank).collect();
        assert_eq!(painted, [64 * 128 + 64]);
    }
}
