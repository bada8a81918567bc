//! Points of a stripe: where a beam's pencils hit, and where on the camera's image their reflected rays land.
//! (§3, steps 2 and 3; figure 10)
//!
//! The hidden-surface algorithm says which face a pencil hits; all else follows from that face's plane. "The
//! distances R and r are computed without using square roots by taking advantage of the special properties of
//! triangles" (§5): R = |q| / (1/t) with |q| from a table, r is the third coordinate of the point in the camera's
//! frame, and the cosines follow from the distances of the plane from the laser and from the camera.

use glam::DVec3;
use rayon::prelude::*;
use raypencil_scene::{Camera, FaceId, Image, Maybe, Mesh, Pixel};

use crate::cylindrical::Cylindrical;
use crate::perspective::Perspective;
use crate::raster::{Plane, Transformation, scene_plane};
use crate::rounding::{PointError, ROUNDING, farthest_corner, largest_product_of_sides};
use crate::scan::Corner;
use crate::vertices::widen;

/// The point that one pencil hits, as the camera stands to it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct StripePoint {
    /// The face hit.
    pub(crate) face: FaceId,
    /// R, metres.
    pub(crate) range: f64,
    /// cos(psi). Negative on a back that rule 1b as printed lets a beam hit.
    pub(crate) cos_incidence: f64,
    /// cos(theta), by the face's own normal: negative where the camera is behind the face.
    pub(crate) cos_view: f64,
    /// r: along the camera's axis, metres.
    pub(crate) depth: f64,
    /// d: from the projection centre, metres.
    pub(crate) distance: f64,
    /// cos(phi) of the point itself.
    pub(crate) cos_off_axis: f64,
    /// sin^2(phi) of the point itself.
    pub(crate) sin_squared: f64,
    /// Where it lands, if it does.
    pub(crate) landing: Option<Landing>,
    /// How far rounding may have moved it.
    pub(crate) error: PointError,
}

/// A place on the camera's image.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Landing {
    pub(crate) pixel: Pixel,
    /// On the SPP, metres.
    pub(crate) at: Corner,
    /// 1/t of the point: f_c / r.
    pub(crate) inverse_t: f64,
}

/// The pixels of a camera as half-open cells of the SPP.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Pixels {
    size: [u32; 2],
    pitch: [f64; 2],
    principal_point: [f64; 2],
}

impl Pixels {
    pub(crate) fn of(camera: &Camera) -> Self {
        Self {
            size: [camera.width, camera.height],
            pitch: camera.pixel_pitch,
            principal_point: camera.principal_point,
        }
    }

    /// Column and row of a place, also beyond the image. Every step is monotonic as it is computed, rounding
    /// included: of two places the one more to the right is never in a column more to the left.
    #[inline]
    pub(crate) fn cell(&self, at: Corner) -> [i64; 2] {
        // `as` saturates.
        [at.x / self.pitch[0] + self.principal_point[0], at.y / self.pitch[1] + self.principal_point[1]]
            .map(|pixels| pixels.floor() as i64)
    }

    /// The pixel that holds a place, if it is within the image.
    fn holding(&self, at: Corner) -> Option<Pixel> {
        let [i, j] = self.cell(at);
        let within = |index: i64, size: u32| u32::try_from(index).ok().filter(|index| *index < size);
        Some(Pixel { i: within(i, self.size[0])?, j: within(j, self.size[1])? })
    }
}

/// The points of all pencils of a beam, row by row; `hits` is the faces that they hit.
pub(crate) fn of_beam(
    mesh: &Mesh,
    beam: &Cylindrical,
    camera: &Perspective<'_>,
    pixels: Pixels,
    hits: &Image<Maybe<FaceId>>,
) -> Vec<Option<StripePoint>> {
    let columns = hits.width() as usize;
    let mut points = vec![None; hits.cells().len()];
    points.par_chunks_mut(columns).zip(hits.cells().par_chunks(columns)).enumerate().for_each(
        |(j, (points, hits))| {
            for (i, (point, hit)) in points.iter_mut().zip(hits).enumerate() {
                *point = hit
                    .get()
                    .and_then(|face| stripe_point(mesh, beam, camera, pixels, face, (i as u32, j as u32)));
            }
        },
    );
    points
}

fn stripe_point(
    mesh: &Mesh,
    beam: &Cylindrical,
    camera: &Perspective<'_>,
    pixels: Pixels,
    face: FaceId,
    (i, j): (u32, u32),
) -> Option<StripePoint> {
    let corners = mesh.faces()[face.0 as usize].map(|v| widen(mesh.vertices()[v as usize]));
    let (beam_from_scene, camera_from_scene) = (beam.sensor_from_scene(), camera.sensor_from_scene());

    // The range map's own 1/t, bit for bit.
    let plane = Plane::of(&corners, beam_from_scene);
    let (x, y) = (beam.columns().centre(i), beam.rows().centre(j));
    let affine = beam.inverse_t(&plane, y)?;
    let inverse_t = affine.slope * x + affine.start;
    let q_length = beam.q_lengths(j)[i as usize];
    let range = q_length / inverse_t;

    let n_length = plane.normal.length();
    // n.q = d / t, so cos(psi) = -n.q / (|n| |q|) needs no direction.
    let laser_distance = beam.row_distance(&plane, y);
    let cos_incidence = -laser_distance * inverse_t / (n_length * q_length);

    // Step 3: the point in the camera's frame, and its image.
    let in_beam = beam.row_origin(y) + beam.q(x, y) / inverse_t;
    let p = camera_from_scene.point_of(beam_from_scene, in_beam);
    let across = p.x * p.x + p.y * p.y;
    let distance_squared = across + p.z * p.z;
    let distance = distance_squared.sqrt();
    // n.(c - P) = n.(c - a): the camera's distance from the plane, which is the same for every point of it.
    let (_, camera_distance) = scene_plane(&corners, camera_from_scene);
    // CHOICE: a point that *is* the projection centre has no direction; its cosines are 0.
    let cosine = |of: f64, length: f64| if length > 0.0 { of / length } else { 0.0 };

    let landing = (p.z > camera.plane_distance())
        .then(|| {
            let at = camera.project(p);
            let inverse_t = camera.plane_distance() / p.z;
            pixels.holding(at).map(|pixel| Landing { pixel, at, inverse_t })
        })
        .flatten();

    Some(StripePoint {
        face,
        range,
        cos_incidence,
        cos_view: cosine(-camera_distance, n_length * distance),
        depth: p.z,
        distance,
        cos_off_axis: cosine(p.z, distance),
        sin_squared: cosine(across, distance_squared),
        landing,
        error: error(&corners, n_length, cos_incidence.abs(), range, in_beam, distance, beam, camera),
    })
}

/// How far rounding may have moved a point: along its pencil by the errors in n.(a - o) and n.q, both of which
/// carry that of n, over |n| cos(psi); and anywhere by the motion into the camera's frame.
fn error(
    corners: &[DVec3; 3],
    n_length: f64,
    cos_psi: f64,
    range: f64,
    in_beam: DVec3,
    distance: f64,
    beam: &Cylindrical,
    camera: &Perspective<'_>,
) -> PointError {
    let reach = farthest_corner(corners, beam.sensor_from_scene()) + range + in_beam.y.abs();
    let along = ROUNDING * reach * largest_product_of_sides(corners) / (n_length * cos_psi);
    let pencil = DVec3::new(in_beam.x, 0.0, in_beam.z) / range;
    PointError {
        along: camera.sensor_from_scene().vector_of(beam.sensor_from_scene(), pencil) * along,
        // The sensors are at most R + d + |y| apart.
        anywhere: ROUNDING * (range + distance + in_beam.y.abs()),
    }
}

#[cfg(test)]
mod tests {
    use raypencil_scene::{Mounted, Pose};

    use super::*;
    use crate::Switches;
    use crate::fixtures::{beam, camera};
    use crate::tables::CameraTables;

    #[test]
    fn the_error_of_a_point_by_hand() {
        let (camera, beam) = (camera(), beam());
        let at = |position: DVec3| Pose::from_position(position);
        let tables = CameraTables::of(&camera);
        let camera = Mounted { scene_from_sensor: at(DVec3::new(9.0, 9.0, 9.0)), sensor: camera };
        let beam = Mounted { scene_from_sensor: at(DVec3::new(0.0, 0.0, -1.0)), sensor: beam };
        let beam = Cylindrical::new(&beam, Switches::EXACT);
        // Sides of 3, 4 and 5 m, the two longest 20 m^2; the corners 1 m, sqrt 10 m and sqrt 17 m from the beam.
        let corners = [DVec3::ZERO, DVec3::new(3.0, 0.0, 0.0), DVec3::new(0.0, 4.0, 0.0)];
        let found = error(
            &corners,
            12.0,
            0.5,
            2.0,
            DVec3::new(1.2, -0.01, 1.6),
            7.0,
            &beam,
            &Perspective::new(&camera, &tables),
        );
        // Along (0.6, 0, 0.8) by 64 u (sqrt 17 + 2 + 0.01) 20 / (12 * 0.5); anywhere by 64 u (2 + 7 + 0.01).
        let along = ROUNDING * (17_f64.sqrt() + 2.01) * 20.0 / 6.0;
        let off = found.along - DVec3::new(0.6 * along, 0.0, 0.8 * along);
        assert!(off.length() < 1e-14 * along, "{found:?}");
        assert!((found.anywhere / (ROUNDING * 9.01) - 1.0).abs() < 1e-14, "{found:?}");
    }
}
