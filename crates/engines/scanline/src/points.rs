//! The points of a stripe: where a beam's pencils hit, and where those points lie on the camera's image. (§3, steps 2
//! and 3; figure 10)
//!
//! The hidden-surface algorithm gives the face that a pencil hits; the rest follows from that face's plane. "The
//! distances R and r are computed without using square roots by taking advantage of the special properties of
//! triangles" (§5): R = |q| / (1/t), with |q| from a table; r is the third coordinate of the point in the camera's
//! frame; the cosines follow from the offsets of the plane from the laser and from the camera.

use glam::DVec3;
use rayon::prelude::*;
use raypencil_scene::{Camera, FaceId, Image, Maybe, Mesh, Pixel};

use crate::cylindrical::Cylindrical;
use crate::perspective::Perspective;
use crate::plane::{Plane, plane_in_scene};
use crate::rounding::{PointError, RELATIVE_ROUNDING, longest_edges_product, max_vertex_distance};
use crate::spp::SppPoint;
use crate::spp::widen;
use crate::transformation::Transformation;

/// The point that one pencil hits, with its geometry towards the laser and towards the camera.
#[derive(Debug, Clone, Copy)]
pub(crate) struct StripePoint {
    /// The face hit.
    pub(crate) face: FaceId,
    /// R, metres.
    pub(crate) range: f64,
    /// cos(psi). Negative on a back that rule 1b as printed adds.
    pub(crate) cos_psi: f64,
    /// cos(theta), with the face's own normal. Negative where the camera is behind the face.
    pub(crate) cos_theta: f64,
    /// r: distance along the camera's axis, metres.
    pub(crate) depth: f64,
    /// d: distance from the projection centre, metres.
    pub(crate) distance: f64,
    /// cos(phi) of the point itself.
    pub(crate) cos_phi: f64,
    /// sin^2(phi) of the point itself.
    pub(crate) sin_squared_phi: f64,
    /// The point on the camera's image; `None` if it is off the image or at most f_c deep.
    pub(crate) image: Option<ImagePoint>,
    /// Displacement of the point by rounding.
    pub(crate) error: PointError,
}

/// A point on the camera's image.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ImagePoint {
    pub(crate) pixel: Pixel,
    pub(crate) on_spp: SppPoint,
    /// 1/t of the point: f_c / r.
    pub(crate) inverse_t: f64,
}

/// The pixels of a camera as half-open cells of the SPP.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PixelGrid {
    /// Columns and rows.
    size: [u32; 2],
    /// Metres.
    pitch: [f64; 2],
    /// Pixels.
    principal_point: [f64; 2],
}

impl PixelGrid {
    pub(crate) fn new(camera: &Camera) -> Self {
        Self {
            size: [camera.width, camera.height],
            pitch: camera.pixel_pitch,
            principal_point: camera.principal_point,
        }
    }

    /// Column and row of a point, also beyond the image. Every step is monotonic as computed, rounding included: of
    /// two points, the one to the right is never in a column to the left.
    #[inline]
    pub(crate) fn cell(&self, p: SppPoint) -> [i64; 2] {
        // `as` saturates.
        [p.x / self.pitch[0] + self.principal_point[0], p.y / self.pitch[1] + self.principal_point[1]]
            .map(|pixels| pixels.floor() as i64)
    }

    /// The pixel that contains a point, if it is within the image.
    fn pixel(&self, p: SppPoint) -> Option<Pixel> {
        let [i, j] = self.cell(p);
        let within = |index: i64, size: u32| u32::try_from(index).ok().filter(|index| *index < size);
        Some(Pixel { i: within(i, self.size[0])?, j: within(j, self.size[1])? })
    }
}

/// The points of all pencils of a beam, row by row. `hits` are the faces that they hit.
pub(crate) fn stripe_points(
    mesh: &Mesh,
    beam: &Cylindrical,
    camera: &Perspective<'_>,
    pixels: PixelGrid,
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
    pixels: PixelGrid,
    face: FaceId,
    (i, j): (u32, u32),
) -> Option<StripePoint> {
    let vertices = mesh.faces()[face.0 as usize].map(|v| widen(mesh.vertices()[v as usize]));
    let (beam_from_scene, camera_from_scene) = (beam.sensor_from_scene(), camera.sensor_from_scene());

    // The range map's own 1/t, bit for bit.
    let plane = Plane::new(&vertices, beam_from_scene);
    let (x, y) = (beam.columns().centre(i), beam.rows().centre(j));
    let row_inverse_t = beam.row_inverse_t(&plane, y)?;
    let inverse_t = row_inverse_t.slope * x + row_inverse_t.start;
    let q_length = beam.q_lengths(j)[i as usize];
    let range = q_length / inverse_t;

    let n_length = plane.normal.length();
    // n.q = d / t, so cos(psi) = -n.q / (|n| |q|) needs no direction.
    let laser_offset = beam.row_offset(&plane, y);
    let cos_psi = -laser_offset * inverse_t / (n_length * q_length);

    // Step 3: the point in the camera's frame, and on its image.
    let in_beam = beam.row_origin(y) + beam.q(x, y) / inverse_t;
    let p = camera_from_scene.point_of_sensor(beam_from_scene, in_beam);
    let across = p.x * p.x + p.y * p.y;
    let distance_squared = across + p.z * p.z;
    let distance = distance_squared.sqrt();
    // n.(c - P) = n.(c - a): the offset of the camera from the plane is the same for every point of the plane.
    let (_, camera_offset) = plane_in_scene(&vertices, camera_from_scene);
    // CHOICE: a point *in* the projection centre has no direction; its cosines are 0.
    let cosine = |component: f64, length: f64| if length > 0.0 { component / length } else { 0.0 };

    let image = (p.z > camera.spp_distance())
        .then(|| {
            let on_spp = camera.project(p);
            let inverse_t = camera.spp_distance() / p.z;
            pixels.pixel(on_spp).map(|pixel| ImagePoint { pixel, on_spp, inverse_t })
        })
        .flatten();

    Some(StripePoint {
        face,
        range,
        cos_psi,
        cos_theta: cosine(-camera_offset, n_length * distance),
        depth: p.z,
        distance,
        cos_phi: cosine(p.z, distance),
        sin_squared_phi: cosine(across, distance_squared),
        image,
        error: point_error(&vertices, n_length, cos_psi.abs(), range, in_beam, distance, beam, camera),
    })
}

/// Bounds on the displacement of a point by rounding.
///
/// Along its pencil: the errors of n.(a - o) and n.q, both of which carry that of n, divided by |n| cos(psi). In any
/// direction: the error of the motion into the camera's frame.
fn point_error(
    vertices: &[DVec3; 3],
    n_length: f64,
    cos_psi: f64,
    range: f64,
    in_beam: DVec3,
    distance: f64,
    beam: &Cylindrical,
    camera: &Perspective<'_>,
) -> PointError {
    let lengths = max_vertex_distance(vertices, beam.sensor_from_scene()) + range + in_beam.y.abs();
    let along_pencil = RELATIVE_ROUNDING * lengths * longest_edges_product(vertices) / (n_length * cos_psi);
    let pencil = DVec3::new(in_beam.x, 0.0, in_beam.z) / range;
    PointError {
        along_pencil: camera.sensor_from_scene().vector_of_sensor(beam.sensor_from_scene(), pencil)
            * along_pencil,
        // The sensors are at most R + d + |y| apart.
        any_direction: RELATIVE_ROUNDING * (range + distance + in_beam.y.abs()),
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
        let tables = CameraTables::new(&camera);
        let camera = Mounted { scene_from_sensor: at(DVec3::new(9.0, 9.0, 9.0)), sensor: camera };
        let beam = Mounted { scene_from_sensor: at(DVec3::new(0.0, 0.0, -1.0)), sensor: beam };
        let beam = Cylindrical::new(&beam, Switches::EXACT);
        // Edges of 3, 4 and 5 m: the two longest give 20 m^2. The vertices are 1 m, sqrt 10 m and sqrt 17 m from the
        // beam.
        let vertices = [DVec3::ZERO, DVec3::new(3.0, 0.0, 0.0), DVec3::new(0.0, 4.0, 0.0)];
        let error = point_error(
            &vertices,
            12.0,
            0.5,
            2.0,
            DVec3::new(1.2, -0.01, 1.6),
            7.0,
            &beam,
            &Perspective::new(&camera, &tables),
        );
        // Along (0.6, 0, 0.8) by 64 u (sqrt 17 + 2 + 0.01) 20 / (12 * 0.5); in any direction by 64 u (2 + 7 + 0.01).
        let along = RELATIVE_ROUNDING * (17_f64.sqrt() + 2.01) * 20.0 / 6.0;
        let difference = error.along_pencil - DVec3::new(0.6 * along, 0.0, 0.8 * along);
        assert!(difference.length() < 1e-14 * along, "{error:?}");
        assert!((error.any_direction / (RELATIVE_ROUNDING * 9.01) - 1.0).abs() < 1e-14, "{error:?}");
    }
}
