//! The displacement whose ray goes through a given point, correctly rounded; and displacements just inside the
//! corners of a face.
//!
//! The forms of a face are linear in f64: near a corner that the ray all but meets, they are as uncertain as the
//! ray is far from it, and where the face is thin there as well, they cannot say where it is. The corner itself is
//! known without rounding. With N the square of the pose's quaternion and (X, Y, Z) the point in the sensor's
//! frame times N,
//!
//! ```text
//! camera   dx = (f_c X - (i + 1/2 - c_x) p_x Z) / (p_x Z)        dy likewise
//! beam     dx = (columns g X - (2i + 1 - columns) w Z) / (2 w Z)
//!          dy = (2 rows Y - (2j + 1 - rows) N T) / (2 N T)
//! ```
//!
//! so that a displacement of 1e-12 cells is known to sixteen places like any other.

use std::cmp::Ordering;

use raypencil_scene::Mounted;

use crate::face::Face;
use crate::number::{Dyadic, Number};
use crate::pencil::{Aim, Sensor};
use crate::region::size;
use crate::rounding::quotient;
use crate::vector::{ScaledRotation, Vector};

impl Sensor {
    /// The displacement of the ray of cell (i, j) that goes through a point, in cells; `None` if the point lies in
    /// the plane through the sensor. Correctly rounded; infinite where f64 ends.
    fn displacement_through(&self, aim: Aim, point: &Vector<Dyadic>) -> Option<[f64; 2]> {
        let pose = self.pose();
        let rotation = ScaledRotation::<Dyadic>::of(pose.rotation);
        let Vector([x, y, z]) = rotation.apply_inverse(&point.sub(&Vector::of(pose.position)));
        if z.sign() == Some(Ordering::Equal) {
            return None;
        }
        let of = Dyadic::of;
        Some(match self {
            Self::Camera(Mounted { sensor, .. }) => {
                let along = |part: &Dyadic, index: u32, centre: f64, pitch: f64| {
                    let from_centre = Dyadic::of_integer(index).add(&of(0.5)).sub(&of(centre));
                    let wide = of(pitch).mul(&z);
                    let here = part.mul(&of(sensor.focal_length));
                    quotient(&here.sub(&from_centre.mul(&wide)), &wide).double
                };
                let ([cx, cy], [px, py]) = (sensor.principal_point, sensor.pixel_pitch);
                [along(&x, aim.i, cx, px), along(&y, aim.j, cy, py)]
            }
            Self::Beam(Mounted { sensor, .. }) => {
                let half_cells = |index: u32, count: u32| of(2.0 * f64::from(index) + 1.0 - f64::from(count));
                let (columns, rows) = (Dyadic::of_integer(sensor.columns), Dyadic::of_integer(sensor.rows));
                let wide = of(sensor.half_width).mul(&z);
                let across = columns.mul(&of(sensor.grid_distance)).mul(&x);
                let across = across.sub(&half_cells(aim.i, sensor.columns).mul(&wide));
                let high = of(sensor.thickness).mul(&rotation.norm_squared);
                let down = rows.doubled().mul(&y).sub(&half_cells(aim.j, sensor.rows).mul(&high));
                [quotient(&across, &wide.doubled()).double, quotient(&down, &high.doubled()).double]
            }
        })
    }
}

/// Displacements whose rays go through points of a face near those of its corners that are within `reach`: at the corner
/// itself, and ever farther into the face, about as far as `reach` allows.
///
/// The points are those of the face, not of the square of displacements: a beam bends straight lines, and a point on the
/// straight way to the middle of a thin face may lie beside it.
pub(crate) fn inside_corners(sensor: &Sensor, aim: Aim, face: &Face, reach: f64) -> Vec<[f64; 2]> {
    let corners: [Vector<Dyadic>; 3] = std::array::from_fn(|k| face.corner(k));
    let mut inside = Vec::new();
    for k in 0..3 {
        let [a, b, c] = [0, 1, 2].map(|turn| &corners[(k + turn) % 3]);
        let both = b.sub(a).add(&c.sub(a));
        // In the face for shares of up to a half.
        let within = |share: f64| {
            sensor
                .displacement_through(aim, &a.add(&both.scaled(&Dyadic::of(share))))
                .filter(|at| size(*at) <= reach)
        };
        let Some(corner) = sensor.displacement_through(aim, a).filter(|at| size(*at) <= reach) else {
            continue;
        };
        let Some(quarter) = sensor.displacement_through(aim, &a.add(&both.scaled(&Dyadic::of(0.25)))) else {
            continue;
        };
        let length = size([quarter[0] - corner[0], quarter[1] - corner[1]]);
        inside.push(corner);
        if length > 0.0 && length.is_finite() {
            let room = ((reach - size(corner)) / length).min(1.0);
            let shares = [1e-9, 1e-6, 1e-3, 0.03, 0.3, 0.9];
            inside.extend(shares.into_iter().filter_map(|share| within(0.25 * share * room)));
        }
    }
    inside
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use glam::{DQuat, DVec3};
    use raypencil_scene::{
        Atmosphere, Beam, Camera, FaceId, FluxModel, Lens, Material, Mesh, Pose, Profile, Scene, SensorId,
    };

    use super::*;
    use crate::{Referee, Ruling, Tolerance};

    /// A camera that looks along z of the scene from (1, 2, 3): pixels of 1/64, focal length 1/16, the middle at pixel (2, 2).
    fn camera() -> Mounted<Camera> {
        let sensor = Camera {
            width: 4,
            height: 4,
            pixel_pitch: [1.0 / 64.0; 2],
            focal_length: 1.0 / 16.0,
            principal_point: [2.0; 2],
            aperture: 2e-3,
            lens: Lens::CLEAR,
            max_range: 1e3,
        };
        Mounted { scene_from_sensor: Pose::from_position(DVec3::new(1.0, 2.0, 3.0)), sensor }
    }

    fn beam(pose: Pose, half_width: f64, thickness: f64, grid_distance: f64) -> Mounted<Beam> {
        let sensor = Beam {
            columns: 1,
            rows: 1,
            thickness,
            grid_distance,
            half_width,
            max_range: 1024.0,
            power: 1.0,
            wavelength: 810e-9,
            profile: Profile::Paper,
        };
        Mounted { scene_from_sensor: pose, sensor }
    }

    fn exactly(x: f64, y: f64, z: f64) -> Vector<Dyadic> {
        Vector::of(DVec3::new(x, y, z))
    }

    #[test]
    fn through_a_point_by_hand() {
        // (2, 1.5, 7) is (1, -1/2, 4) before the camera: x/z = 1/4, y/z = -1/8, that is pixels 3 and 1.5; the middle of
        // pixel (2, 2) is (2.5, 2.5).
        let aim = Aim { i: 2, j: 2, dx: 0.0, dy: 0.0 };
        let sensor = Sensor::Camera(camera());
        assert_eq!(sensor.displacement_through(aim, &exactly(2.0, 1.5, 7.0)), Some([0.5, -1.0]));
        assert_eq!(sensor.displacement_through(aim, &exactly(2.0, 1.5, 3.0)), None);
        // A beam of one cell, 2 w = 1/2 wide at g = 1 and T = 1/8 thick, at the same place: x/z = 1/4 is half a cell, y = -1/2
        // is 4 cells up.
        let beam = Sensor::Beam(beam(camera().scene_from_sensor, 0.25, 0.125, 1.0));
        let aim = Aim { i: 0, j: 0, dx: 0.0, dy: 0.0 };
        assert_eq!(beam.displacement_through(aim, &exactly(2.0, 1.5, 7.0)), Some([0.5, -4.0]));
    }

    /// A pencil of 5e-5 radians that is aimed at the tip of a thin triangle, as nearly as an f64 can say. It misses
    /// the tip by some 1e-12 cells, and the linear forms of the triangle's sides cross before they are in the triangle.
    #[allow(clippy::excessive_precision, reason = "these are exact: parts of 1024 and 512")]
    fn needle() -> Scene {
        let vertices = vec![
            [10.794921875, 3.29296875, 0.03125],
            [9.750_529, 4.189_095, 0.367_478_55],
            [10.486328125, 3.55859375, 0.125],
        ];
        let ground = Material { name: "ground".into(), reflectivity: 0.25 };
        let mesh = Mesh::new(DVec3::ZERO, vertices, vec![[0, 1, 2]], vec![0], vec![ground]).expect("a mesh");
        let pose = Pose {
            position: DVec3::new(11.312596292665075, -1.7929520999900985, 8.320111742053232),
            rotation: DQuat::from_xyzw(
                -0.3466432207384321,
                0.8801026685797992,
                0.32210972931112314,
                0.03876973765603294,
            ),
        };
        let beam = beam(pose, 4.76837158203125e-7, 0.00048828125, 0.019999980926513672);
        let air = Atmosphere { attenuation: 0.0 };
        Scene::new(Arc::new(mesh), camera(), vec![beam], air, FluxModel::Radiometric).expect("a scene")
    }

    #[test]
    fn the_tip_of_a_needle_is_met_by_a_ray_next_to_it() {
        let scene = needle();
        let referee = Referee::new(&scene);
        let beam = SensorId::Beam(0);
        assert!(!referee.verdict(beam, 0, 0).expect("a pencil").is_hit());
        // Whoever says that it is met is wrong by no more than the rounding of an f64.
        let tolerance = Tolerance { lateral: 1e-9, depth: 1e-9, position: 0.0 };
        let ruling = referee.rule(beam, 0, 0, Some(FaceId(0)), tolerance);
        let Some(Ruling::Rounding(witness)) = ruling else { panic!("{ruling:?}") };
        assert!(witness.size() <= 1e-9, "{witness:?}");
        // Not so for one who tells rays apart more finely.
        let finer = Tolerance { lateral: 1e-16, ..tolerance };
        assert_eq!(referee.rule(beam, 0, 0, Some(FaceId(0)), finer), Some(Ruling::Wrong));
        // The margins know of it.
        let margins = referee.margins(beam, 0, 0).expect("a pencil");
        assert!(margins.face.hi <= 1e-9, "{:?}", margins.face);
        assert!(margins.surface.hi <= 1e-9, "{:?}", margins.surface);
    }
}
