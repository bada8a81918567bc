//! Values in pairs of f64 against exact arithmetic, and by hand.

use super::*;
use glam::DQuat;
use proptest::prelude::*;
use raypencil_scene::{Camera, Lens, Pose};

fn camera(position: [f64; 3], rotation: [f64; 4], centre: f64) -> MountedSensor {
    MountedSensor::camera(Mounted {
        scene_from_sensor: Pose {
            position: DVec3::from_array(position),
            rotation: DQuat::from_array(rotation),
        },
        sensor: Camera {
            width: 64,
            height: 48,
            pixel_pitch: [9e-6, 11e-6],
            focal_length: 8e-3,
            principal_point: [centre, 24.25],
            aperture: 2e-3,
            lens: Lens::CLEAR,
            max_range: 20.0,
        },
    })
}

/// By exact arithmetic alone.
fn exactly(sensor: &MountedSensor, aim: Aim, face: &Face, focal_length: f64) -> RoundedHit {
    let exact = Intersection::new(sensor.ray::<Dyadic>(aim), face);
    let point = exact.point();
    RoundedHit {
        face: face.id,
        range: exact.range(),
        point: [0, 1, 2].map(|k: usize| quotient(&point.0[k], &exact.scale)),
        normal: [0, 1, 2].map(|k: usize| exact.normal_part(k)),
        depth: exact.depth(focal_length),
        cos_incidence: exact.cos_incidence(),
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    /// The fast way never differs from the exact one, on grounds near and far, flat and askew.
    #[test]
    fn values_are_those_of_exact_arithmetic(
        position in prop::array::uniform3(-3.0f64..3.0),
        rotation in prop::array::uniform4(-1.0f64..1.0),
        corners in prop::array::uniform3(prop::array::uniform3(-20.0f32..20.0)),
        is_flat in any::<bool>(),
        far in prop::sample::select(vec![0.0, 1e3, 1e6]),
        i in 0u32..64,
        j in 0u32..48,
    ) {
        prop_assume!(rotation.iter().map(|x| x * x).sum::<f64>() > 0.01);
        let mut corners = corners;
        if is_flat {
            // Heights of 0 and right angles: exact zeros and cancellations.
            corners = corners.map(|[x, y, _]| [x.round(), y.round(), 0.0]);
        }
        corners.iter_mut().for_each(|corner| corner[0] += far as f32);
        let sensor = camera([position[0] + far, position[1], position[2]], rotation, 31.5);
        let (aim, face) = (Aim { i, j, dx: 0.0, dy: 0.0 }, Face { id: FaceId(3), corners });
        if let Some(found) = values(&sensor, aim, &face) {
            prop_assert_eq!(found, exactly(&sensor, aim, &face, 8e-3));
        }
    }
}

#[test]
fn a_plane_square_to_the_axis_has_exact_values() {
    // From (1, 2, 0) along +z, pixel (31, 24): (i + 1/2 - 31.5) = 0 and (24.5 - 24.25) 11e-6 m to the side.
    let sensor = camera([1.0, 2.0, 0.0], [0.0, 0.0, 0.0, 1.0], 31.5);
    let corners = [[-9.0, -9.0, 4.0], [0.0, 9.0, 4.0], [9.0, -9.0, 4.0]];
    let face = Face { id: FaceId(0), corners };
    let found = values(&sensor, Aim { i: 31, j: 24, dx: 0.0, dy: 0.0 }, &face).expect("it is met");
    assert_eq!(found.depth.double, 4.0);
    assert_eq!(found.normal.map(|part| part.double), [0.0, 0.0, -1.0]);
    assert_eq!(found.point[0].double, 1.0);
    assert_eq!(found.point[2], Rounded { double: 4.0, single: 4.0 });
    // t = 4 / 8e-3 in y: 2 + 0.25 11e-6 500 = 2.001375, but for the rounding of 11e-6 and 8e-3.
    assert!((found.point[1].double - 2.001375).abs() < 1e-15);
    // R^2 = 16 + 0.001375^2.
    assert!((found.range.double - (16.0f64 + 0.001375 * 0.001375).sqrt()).abs() < 2e-15);
    // Parallel to a ray: no point.
    let edge_on = Face { id: FaceId(0), corners: [[1.0, 0.0, 0.0], [1.0, 9.0, 4.0], [1.0, -9.0, 4.0]] };
    assert_eq!(values(&sensor, Aim { i: 31, j: 24, dx: 0.0, dy: 0.0 }, &edge_on), None);
}
