use super::*;
use glam::{DQuat, DVec3};
use raypencil_scene::{Beam, Camera, Lens, Mounted, Pose, Profile};

/// A number from 0 to 1 that depends on the seed alone (splitmix64).
fn draw(seed: &mut u64) -> f64 {
    *seed = seed.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let mut x = *seed;
    x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    (x ^ (x >> 31)) as f64 / u64::MAX as f64
}

fn sensors(seed: &mut u64) -> [Sensor; 2] {
    let mut part = |scale: f64| scale * (draw(seed) - 0.5);
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
        Sensor::Camera(Mounted { scene_from_sensor: pose, sensor: camera }),
        Sensor::Beam(Mounted { scene_from_sensor: pose, sensor: beam }),
    ]
}

/// The interval is never wrong about a sign: a million edges through points of rays, rounded to f32, so
/// that every ray passes within rounding of an edge, and the exact arithmetic is needed now and then.
#[test]
fn the_filter_agrees_with_exact_arithmetic_on_a_million_edges() {
    let mut seed = 7;
    let (mut certain, mut uncertain) = (0u32, 0u32);
    while certain + uncertain < 1_000_000 {
        for sensor in sensors(&mut seed) {
            let (width, height) = sensor.size();
            for _ in 0..50 {
                let cell = |count: u32, by: f64| ((by * f64::from(count)) as u32).min(count - 1);
                let (i, j) = (cell(width, draw(&mut seed)), cell(height, draw(&mut seed)));
                let ray = ExactRay::new(&sensor, Aim { i, j, dx: 0.0, dy: 0.0 });
                let middle = |v: &Vector<Interval>, scale: &Interval| {
                    DVec3::new(v.0[0].middle(), v.0[1].middle(), v.0[2].middle()) / scale.middle()
                };
                let origin = middle(&ray.fast.origin, &ray.fast.origin_scale);
                let q = middle(&ray.fast.direction, &ray.fast.direction_scale);
                for _ in 0..20 {
                    // Two ends with a point of the ray half-way between them.
                    let point = origin + q * (10.0 + 100.0 * draw(&mut seed));
                    let part = |seed: &mut u64| draw(seed) - 0.5;
                    let half = DVec3::new(part(&mut seed), part(&mut seed), part(&mut seed));
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
