//! Signs by intervals against signs by exact arithmetic.

use super::*;
use crate::splitmix::SplitMix64;
use glam::{DQuat, DVec3};
use raypencil_scene::{Beam, Camera, Lens, Mounted, Pose, Profile};

fn sensors(random: &mut SplitMix64) -> [MountedSensor; 2] {
    let mut part = |scale: f64| scale * (random.unit() - 0.5);
    let pose = Pose {
        position: DVec3::new(part(10.0), part(10.0), part(10.0)),
        rotation: DQuat::from_xyzw(part(2.0), part(2.0), part(2.0), part(2.0) + 1.5),
    };
    let camera = Camera {
        width: 64,
        height: 48,
        pixel_pitch: [1.1e-4, 0.9e-4],
        focal_length: 8e-3,
        principal_point: [31.3, 24.9],
        aperture: 2e-3,
        lens: Lens::CLEAR,
        max_range: 20.0,
    };
    let beam = Beam {
        columns: 65,
        rows: 7,
        thickness: 0.01,
        grid_distance: 0.1,
        half_width: 0.09,
        max_range: 20.0,
        power: 1.0,
        wavelength: 8e-7,
        profile: Profile::Paper,
    };
    [
        MountedSensor::camera(Mounted { scene_from_sensor: pose, sensor: camera }),
        MountedSensor::beam(Mounted { scene_from_sensor: pose, sensor: beam }),
    ]
}

/// The interval is never wrong about a sign. A million edges pass through points of rays, rounded to f32: every ray
/// passes within rounding of an edge, so some need exact arithmetic.
#[test]
fn the_filter_agrees_with_exact_arithmetic_on_a_million_edges() {
    let mut random = SplitMix64(7);
    let (mut certain, mut uncertain) = (0u32, 0u32);
    while certain + uncertain < 1_000_000 {
        for sensor in sensors(&mut random) {
            let (width, height) = sensor.size();
            for _ in 0..50 {
                let cell = |count: u32, by: f64| ((by * f64::from(count)) as u32).min(count - 1);
                let (i, j) = (cell(width, random.unit()), cell(height, random.unit()));
                let ray = ExactRay::new(&sensor, Aim { i, j, dx: 0.0, dy: 0.0 });
                let middle = |v: &Vector<Interval>, scale: &Interval| {
                    DVec3::new(v.0[0].middle(), v.0[1].middle(), v.0[2].middle()) / scale.middle()
                };
                let origin = middle(&ray.fast.origin, &ray.fast.origin_scale);
                let q = middle(&ray.fast.direction, &ray.fast.direction_scale);
                for _ in 0..20 {
                    // Two ends with a point of the ray half-way between them.
                    let point = origin + q * (10.0 + 100.0 * random.unit());
                    let part = |random: &mut SplitMix64| random.unit() - 0.5;
                    let half = DVec3::new(part(&mut random), part(&mut random), part(&mut random));
                    let narrow = |v: DVec3| v.as_vec3().to_array();
                    let corners = [narrow(point - half), narrow(point + half), narrow(point)];
                    let face = Face { id: FaceId(0), corners };
                    let edge = EdgeSide { face: &face, k: 0 };
                    let exact = ray.exact_sign(&edge);
                    match edge.value(&ray.fast).sign() {
                        Some(sign) => {
                            certain += 1;
                            assert_eq!(sign, exact, "{sensor:?} {i},{j} {corners:?}");
                        }
                        None => uncertain += 1,
                    }
                }
            }
        }
    }
    assert!(certain > 900_000, "the filter decides most: {certain}");
}

/// A corner that is 2^-80 off a plane is off it, though intervals cannot tell.
#[test]
fn a_face_is_in_the_plane_of_another_only_exactly() {
    let face = |corners: [[f32; 3]; 3]| Face { id: FaceId(0), corners };
    // The plane z = x + y.
    let plane = face([[0.0, 0.0, 0.0], [1.0, 0.0, 1.0], [0.0, 1.0, 1.0]]);
    let off = |y: f32| face([[0.0, 0.0, 0.0], [1.0, y, 1.0], [0.0, 1.0, 1.0]]);
    let tiny = 1.0 / (1_u128 << 80) as f32;
    assert_eq!(off(tiny).sides_of_plane::<Interval>(&plane)[1], None);
    for (y, expected) in [(0.0, true), (tiny, false), (-tiny, false), (0.5, false)] {
        assert_eq!(off(y).is_in_plane_of(&plane), expected, "{y}");
    }
    // Whichever way it faces.
    assert!(face([[1.0, 1.0, 2.0], [0.0, 0.0, 0.0], [1.0, 0.0, 1.0]]).is_in_plane_of(&plane));
}

/// Where n.D may be 0, of either sign, the range has no bound but the sensor's.
#[test]
fn the_farthest_range_is_bounded_where_the_approach_is_not() {
    let [camera, _] = sensors(&mut SplitMix64(8));
    let ray = ExactRay::new(&camera, Aim { i: 3, j: 4, dx: 0.0, dy: 0.0 });
    let of = |low: f64, high: f64| {
        let approach = Interval { low, high };
        Crossing { normal: Vector::of(DVec3::Z), height: Interval::of(-1.0), approach }
            .farthest_range(&ray, 20.0)
    };
    for high in [0.0, -0.0, 1.0, f64::NAN, -1e-300] {
        assert_eq!(of(-2.0, high), 20.0, "{high}");
    }
    // R = n.a' |D| / (s n.D), by its bounds.
    let (length, scale) =
        (ray.fast.direction.length_squared().middle().sqrt(), ray.fast.origin_scale.middle());
    let range = length / (1e6 * scale);
    assert!(range <= of(-2e6, -1e6) && of(-2e6, -1e6) < range * (1.0 + 1e-12));
}
