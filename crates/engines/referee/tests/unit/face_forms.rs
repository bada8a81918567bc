//! Forms against exact arithmetic where they vanish, and the bounds of where a face may be met.

use super::*;
use crate::hits::face::ExactRay;
use crate::numbers::number::{Dyadic, Number};
use crate::numbers::vector::Vector;
use crate::rays::displacement::max_norm;
use crate::rays::ray::{Aim, MountedSensor, ScaledRay};
use crate::splitmix::SplitMix64;
use glam::DQuat;
use raypencil_scene::{Beam, Camera, FaceId, Mounted, Pose, Profile};
use std::cmp::Ordering;

fn direction(random: &mut SplitMix64) -> DVec3 {
    DVec3::new(random.part(), random.part(), random.part())
}

fn sensor(random: &mut SplitMix64) -> MountedSensor {
    let rotation = DQuat::from_xyzw(random.part(), random.part(), random.part(), random.part() + 0.1);
    let far = if random.part() > 0.0 { 10.0 } else { 3000.0 };
    let scene_from_sensor = Pose { position: far * direction(random), rotation };
    if random.part() > 0.0 {
        let pitch = if random.part() > 0.0 { 1.1e-3 } else { 9e-6 };
        let sensor = Camera {
            width: 64,
            height: 48,
            pixel_pitch: [pitch, 0.9 * pitch],
            focal_length: 8e-3,
            principal_point: [31.3, 24.9],
            aperture: 2e-3,
            lens: raypencil_scene::Lens::CLEAR,
            max_range: 20.0,
        };
        return MountedSensor::camera(Mounted { scene_from_sensor, sensor });
    }
    let sensor = Beam {
        columns: 65,
        rows: 7,
        thickness: if random.part() > 0.0 { 0.01 } else { 2.0 },
        grid_distance: 0.1,
        half_width: 0.09,
        max_range: 20.0,
        power: 1.0,
        wavelength: 8e-7,
        profile: Profile::Paper,
    };
    MountedSensor::beam(Mounted { scene_from_sensor, sensor })
}

/// A point on a ray: anywhere, at the end of the range, or on the SPP.
fn point(ray: &MovingRay, random: &mut SplitMix64) -> DVec3 {
    let (origin, q) = ray.line();
    match random.part() {
        x if x < 0.0 => origin + q.normalize() * (10.5 + 10.0 * random.part()),
        x if x < 0.5 => origin + q.normalize() * 20.0,
        _ => origin + q * ray.plane,
    }
}

/// A triangle around a point of a ray: well shaped or thin, large or small, or with the ray in its plane up to a
/// cell's width.
fn face(ray: &MovingRay, at: DVec3, random: &mut SplitMix64) -> Face {
    let (origin, q) = ray.line();
    let scale = (at - origin).length() / 10.0;
    let size = scale * [2.0, 0.1, 1e-3][(random.part().abs() * 3.0) as usize % 3];
    let thin = [1.0, 1e-3, 1e-6][(random.part().abs() * 3.0) as usize % 3];
    let (long, wide) = (size * direction(random), size * thin * direction(random));
    let grazing = size * (q.normalize() + ray.step[0] * direction(random));
    let long = if random.part() > 0.0 { grazing } else { long };
    let corners = [at - long + wide * random.part(), at + long, at + wide + long * random.part()];
    Face { id: FaceId(0), corners: corners.map(|v| v.as_vec3().to_array()) }
}

/// The exact (n.a', n.D), and D.(a' x (b - a)) of the three edges.
fn exact(ray: &ScaledRay<Dyadic>, face: &Face) -> ([Dyadic; 2], [Dyadic; 3]) {
    let v = face.corners.map(Vector::<Dyadic>::of_f32);
    let relative = |k: usize| v[k].scaled(&ray.origin_scale).sub(&ray.origin);
    let along = |k: usize| v[(k + 1) % 3].sub(&v[k]);
    let normal = along(0).cross(&v[2].sub(&v[0]));
    let edge = |k: usize| ray.direction.dot(&relative(k).cross(&along(k)));
    ([normal.dot(&relative(0)), normal.dot(&ray.direction)], [edge(0), edge(1), edge(2)])
}

/// No form is ever certain of a wrong sign: neither near its zero, within three times its error, nor elsewhere.
#[test]
fn what_a_form_is_certain_of_is_exact() {
    let (mut random, mut certain, mut asked, mut close) = (SplitMix64(11), 0, 0, [0; 8]);
    for _ in 0..12_000 {
        let sensor = sensor(&mut random);
        let (width, height) = sensor.size();
        let index = |count: u32, by: f64| ((0.5 * by + 0.5) * f64::from(count)) as u32 % count;
        let aim = Aim { i: index(width, random.part()), j: index(height, random.part()), dx: 0.0, dy: 0.0 };
        let ray = MovingRay::new(&sensor, aim);
        let at = point(&ray, &mut random);
        let faces = [face(&ray, at, &mut random), face(&ray, at, &mut random)];
        if !faces.iter().all(Face::has_area) {
            continue;
        }
        let [one, other] = [&faces[0], &faces[1]].map(|face| FaceForms::new(&ray, face));
        let limit = other.closest(&ray).clamp(0.1, 20.0);
        let mut forms = one.conditions().to_vec();
        forms.extend([one.at_or_before(&other), one.within(&ray, limit)]);
        for (kind, form) in forms.iter().enumerate() {
            let centre = [random.part(), random.part()];
            let (dy, by) = (random.part(), 3.0 * random.part());
            let slope = form.x + form.xy * dy;
            let root = -(form.constant + form.y * dy) / slope + by * form.error / slope;
            let is_close = root.abs() <= 1.0;
            let dx = if is_close { root } else { random.part() };
            let scaled = sensor.ray::<Dyadic>(Aim { dx, dy, ..aim });
            let ([h, p], edges) = exact(&scaled, &faces[0]);
            let ([g, q], _) = exact(&scaled, &faces[1]);
            let (s, sigma) = (&scaled.origin_scale, &scaled.direction_scale);
            let zero = Dyadic::of(0.0);
            let value = match kind {
                0..=2 => zero.sub(&edges[kind]),
                3 => zero.sub(&p),
                4 => p.mul(s).sub(&h.mul(sigma)),
                6 => g.mul(&p).sub(&h.mul(&q)),
                _ => {
                    // The squared condition is equivalent only before the sensor and from the front.
                    if h.sign() != Some(Ordering::Less) || p.sign() != Some(Ordering::Less) {
                        continue;
                    }
                    let limit = if kind == 5 { sensor.max_range() } else { limit };
                    let length = scaled.direction.length_squared();
                    Dyadic::of(limit).mul(s).mul(&p).square().sub(&h.square().mul(&length))
                }
            };
            let sign = value.sign().expect("exact");
            close[kind] += u32::from(is_close);
            let near = [dx, dy];
            let about = form.about(centre).is_positive_at([dx - centre[0], dy - centre[1]]);
            for answer in [form.is_positive_at(near), about] {
                asked += 1;
                if let Some(positive) = answer {
                    certain += 1;
                    let says = if positive { Ordering::Greater } else { Ordering::Less };
                    assert_eq!(says, sign, "{kind} {form:?} {near:?} {centre:?} {sensor:?} {aim:?}");
                }
            }
        }
    }
    assert!(asked > 100_000 && certain > asked / 2, "{certain} of {asked}");
    assert!(close.iter().all(|&count| count > 300), "{close:?}");
}

/// Rays meet a face neither nearer nor farther than its bounds, and not where it is beside them.
#[test]
fn a_face_is_met_where_it_says_it_may_be() {
    let (mut random, mut met) = (SplitMix64(5), 0);
    for _ in 0..30_000 {
        let sensor = sensor(&mut random);
        let aim = Aim { i: 40, j: 3, dx: 0.0, dy: 0.0 };
        let ray = MovingRay::new(&sensor, aim);
        let at = point(&ray, &mut random);
        let face = face(&ray, at, &mut random);
        if !face.has_area() {
            continue;
        }
        let place = FaceForms::in_square(&ray, &face);
        let forms = FaceForms::new(&ray, &face);
        let centre = [0.5 * random.part(), 0.5 * random.part()];
        let [a, b, c] = &forms.corners;
        let clear = beside([a, b, c], centre).max(beside([a, b, c], [0.0; 2]) - max_norm(centre));
        for _ in 0..4 {
            let weights = [random.part(), random.part(), random.part()].map(f64::abs);
            let sum: f64 = weights.iter().sum();
            let at = forms.point(&ray, weights.map(|weight| weight / sum));
            if !(max_norm(at) <= 1.0) {
                continue;
            }
            let exact = ExactRay::new(&sensor, Aim { dx: at[0], dy: at[1], ..aim });
            if !face.is_met_by(&exact, sensor.max_range()) {
                continue;
            }
            met += 1;
            assert!(place.is_ok(), "{face:?}");
            let range = face.range(&exact);
            // The range itself is rounded, by more where the ray is almost in the face's plane.
            let (_, doubt) = forms.range_at(&ray, at);
            let slack = range * (doubt + 1e-14);
            assert!(forms.closest(&ray) <= range + slack && range <= forms.farthest + slack, "{face:?}");
            assert!(max_norm([at[0] - centre[0], at[1] - centre[1]]) >= clear, "{face:?} {at:?}");
        }
    }
    assert!(met > 10_000, "{met}");
    // A corner in the plane of the sensor bounds nothing.
    let corner = Corner { at: [0.0; 2], error: [f64::INFINITY; 2] };
    assert_eq!(beside([&corner], [0.0; 2]), 0.0);
}
