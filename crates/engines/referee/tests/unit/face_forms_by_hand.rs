//! Forms of numbers that can be followed on paper, and the errors that the page derives, in its letters.

use super::*;
use crate::rays::ray::{Aim, MountedSensor};
use glam::DQuat;
use raypencil_scene::{Beam, Camera, FaceId, Lens, Mounted, Pose, Profile};

/// As near as a few roundings of `expected`.
#[track_caller]
fn near(found: f64, expected: f64) {
    assert!((found - expected).abs() <= 4.0 * U * expected.abs(), "{found:e} {expected:e}");
}

fn aim(i: u32, j: u32) -> Aim {
    Aim { i, j, dx: 0.0, dy: 0.0 }
}

/// f = 2 m, p = (1/4, 1/2), looking along z from `position`. Pixel (2, 1) has q = (1/4, -1/4, 1).
fn camera(position: DVec3) -> MountedSensor {
    let sensor = Camera {
        width: 16,
        height: 4,
        pixel_pitch: [0.5, 1.0],
        focal_length: 2.0,
        principal_point: [1.5, 2.0],
        aperture: 2e-3,
        lens: Lens::CLEAR,
        max_range: 16.0,
    };
    MountedSensor::camera(Mounted { scene_from_sensor: Pose { position, rotation: DQuat::IDENTITY }, sensor })
}

/// g = 1/2 m, p = (1/4, 0), rows 1/2 m apart, looking along z from `position`. Pencil (2, 3) has q = (1/8, 0, 1) and
/// starts 1/2 + 1/4 m below the axis.
fn beam(position: DVec3) -> MountedSensor {
    let sensor = Beam {
        columns: 4,
        rows: 4,
        thickness: 2.0,
        grid_distance: 0.5,
        half_width: 0.25,
        max_range: 16.0,
        power: 1.0,
        wavelength: 8e-7,
        profile: Profile::Paper,
    };
    MountedSensor::beam(Mounted { scene_from_sensor: Pose { position, rotation: DQuat::IDENTITY }, sensor })
}

/// A triangle 4 to 6 m ahead that shows its front.
fn triangle(id: u32, far: f32) -> Face {
    let corners = [[-1.0, -2.0, 4.0 + far], [0.5, 3.0, 5.0 + far], [2.0, -1.0, 6.0 + far]];
    Face { id: FaceId(id), corners }
}

fn sum(v: DVec3) -> f64 {
    v.abs().element_sum()
}

#[test]
fn corners_on_one_side_are_beside() {
    let corner = |x: f64, y: f64| Corner { at: [x, y], error: [0.125, 0.25] };
    let [right, far] = [corner(1.0, 0.0), corner(3.0, 0.5)];
    // 1 - 1/8 to the right; about another centre, which is nearer.
    assert_eq!(beside([&right, &far], [0.0, 0.0]), 0.875);
    assert_eq!(beside([&right, &far], [0.5, 0.0]), 0.375);
    assert_eq!(beside([&right, &far], [-0.5, 0.0]), 1.0, "never more than the square");
    // Below, above and to the left.
    assert_eq!(beside([&corner(0.0, 0.75), &corner(0.0, 1.0)], [0.0, 0.0]), 0.5);
    assert_eq!(beside([&corner(0.0, -0.75), &corner(0.0, -1.0)], [0.0, 0.0]), 0.5);
    assert_eq!(beside([&corner(0.0, -0.75), &corner(0.0, -1.0)], [0.0, -0.25]), 0.25);
    assert_eq!(beside([&corner(-1.0, 0.0), &corner(-0.5, 0.0)], [0.0, 0.0]), 0.375);
    // On both sides: nothing.
    assert_eq!(beside([&corner(-1.0, -1.0), &corner(1.0, 1.0)], [0.0, 0.0]), 0.0);
}

#[test]
fn a_ray_moves_as_its_cells_do() {
    let ray = MovingRay::new(&camera(DVec3::ZERO), aim(2, 1));
    assert_eq!(
        (ray.q, ray.step, ray.height, ray.height_step, ray.plane),
        ([0.25, -0.25], [0.25, 0.5], 0.0, 0.0, 2.0)
    );
    near(ray.q_size, 2.25 * (1.0 + 16.0 * U));
    let length = 1.125_f64.sqrt();
    near(ray.length[0], length);
    near(ray.length[1], 0.0625 / length);
    near(ray.length[2], -0.125 / length);
    // (1/4 + 1/2)^2 / 2, for |q| >= 1 however it is displaced.
    near(ray.length_bend, 0.28125 * (1.0 + 64.0 * U));
    near(ray.length_at([1.0, -1.0]), (0.25_f64 + 0.5625 + 1.0).sqrt());
    let (start, spread) = ray.spread(0.5);
    assert_eq!(start, 0.0);
    near(spread, 0.5 * 0.3125_f64.sqrt());
    // Pixel (13, 1): q_x = 3, and |q| at least sqrt(10.0625) - 3/4.
    let ray = MovingRay::new(&camera(DVec3::ZERO), aim(13, 1));
    let length = 10.0625_f64.sqrt();
    near(ray.length_bend, 0.5625 / (2.0 * (length - 0.75)) * (1.0 + 64.0 * U));
    let moved = 0.3125_f64.sqrt();
    near(ray.spread(1.0).1, moved / (length - moved));

    let ray = MovingRay::new(&beam(DVec3::new(7.0, 8.0, 9.0)), aim(2, 3));
    assert_eq!(
        (ray.q, ray.step, ray.height, ray.height_step, ray.plane),
        ([0.125, 0.0], [0.25, 0.0], 0.75, 0.5, 0.5)
    );
    assert_eq!(ray.line(), (DVec3::new(7.0, 8.75, 9.0), DVec3::new(0.125, 0.0, 1.0)));
    assert_eq!(ray.spread(0.5).0, 0.25);
    near(ray.spread(0.5).1, 0.125);
    // Half a cell to the right and a quarter down.
    let moved = MovingRay::new(&beam(DVec3::ZERO), Aim { i: 2, j: 3, dx: 0.5, dy: 0.25 });
    assert_eq!((moved.q, moved.height), ([0.25, 0.0], 0.875));
    let moved = MovingRay::new(&camera(DVec3::ZERO), Aim { i: 2, j: 1, dx: 0.5, dy: 0.25 });
    assert_eq!(moved.q, [0.375, -0.125]);
}

#[test]
fn errors_and_bends_are_those_of_the_page() {
    for sensor in [camera(DVec3::ZERO), beam(DVec3::ZERO)] {
        let at = match sensor {
            MountedSensor::Camera(..) => aim(2, 1),
            MountedSensor::Beam(..) => aim(2, 3),
        };
        let ray = MovingRay::new(&sensor, at);
        let (height, h) = (ray.height, ray.height_step);
        let q = DVec3::new(ray.q[0], ray.q[1], 1.0);
        let big_q = sum(q) + ray.step[0] + ray.step[1];
        let of = |face: &Face| {
            let from = face.corners.map(|corner| glam::Vec3::from_array(corner).as_dvec3());
            let v = from.map(|d| d - DVec3::new(0.0, height, 0.0));
            let s = from.map(|d| sum(d) + height + h);
            let e = [from[1] - from[0], from[2] - from[1], from[0] - from[2]];
            (v, s, e)
        };
        let (faces, eps) = ([triangle(0, 0.0), triangle(1, 2.0)], f64::EPSILON);
        let [one, other] = [&faces[0], &faces[1]].map(|face| FaceForms::new(&ray, face));
        let (v, s, e) = of(&faces[0]);
        let normal = e[2].cross(e[0]);
        for k in 0..3 {
            let moment = v[k].cross(e[k]);
            let edge = one.conditions()[k];
            near(edge.constant, -q.dot(moment));
            near(edge.x, -ray.step[0] * moment.x);
            // The start moves by h along y: V by -h, V x E by -h (E_z, 0, -E_x).
            near(edge.y, h * (q.x * e[k].z - e[k].x) - ray.step[1] * moment.y);
            near(edge.xy, h * ray.step[0] * e[k].z);
            near(edge.error, 128.0 * U * big_q * s[k] * sum(e[k]) * (1.0 + 16.0 * eps));
        }
        // K, S, and n.V, n.q with their slopes.
        let (k, s0) = (sum(e[2]) * sum(e[0]), s[0]);
        let (nv, nv_y) = (normal.dot(v[0]), -normal.y * h);
        let (nq, nq_x, nq_y) = (normal.dot(q), normal.x * ray.step[0], normal.y * ray.step[1]);
        let [_, _, _, front, plane, range] = *one.conditions();
        assert_eq!([front.constant, front.x, front.y, front.xy], [-nq, -nq_x, -nq_y, 0.0]);
        let f = ray.plane;
        near(plane.constant, f * nq - nv);
        near(plane.x, f * nq_x);
        near(plane.y, f * nq_y - nv_y);
        let m = ray.max_range;
        let [l, l_x, l_y] = ray.length;
        near(range.constant, nv * l - m * nq);
        near(range.x, nv * l_x - m * nq_x);
        near(range.y, nv * l_y + nv_y * l - m * nq_y);
        near(range.xy, nv_y * l_x);
        let loose = |found: f64, expected: f64| {
            // Some factors of (1 + 8 eps) to spare, and no more.
            let by = found / expected - 1.0;
            assert!((0.0..64.0 * eps).contains(&by), "{found:e} {expected:e} {by:e}");
        };
        loose(front.error, 128.0 * U * k * big_q);
        loose(plane.error, 256.0 * U * k * (f * big_q + s0));
        loose(range.error, 256.0 * U * k * big_q * (m + s0));
        loose(range.bend, (nv.abs() + nv_y.abs() + 256.0 * U * k * s0) * ray.length_bend);
        assert_eq!([front.bend, plane.bend, one.conditions()[0].bend], [0.0; 3]);
        assert_eq!(one.within(&ray, m).constant, range.constant);
        near(one.within(&ray, 5.0).constant, nv * l - 5.0 * nq);

        // Order: n'.V' n.q - n.V n'.q.
        let (w, t, g) = of(&faces[1]);
        let their = g[2].cross(g[0]);
        let (k2, s2) = (sum(g[2]) * sum(g[0]), t[0]);
        let (mv, mv_y, mq) = (their.dot(w[0]), -their.y * h, their.dot(q));
        let (mq_x, mq_y) = (their.x * ray.step[0], their.y * ray.step[1]);
        let order = one.at_or_before(&other);
        near(order.constant, mv * nq - nv * mq);
        near(order.x, mv * nq_x - nv * mq_x);
        near(order.y, mv * nq_y + mv_y * nq - nv * mq_y - nv_y * mq);
        near(order.xy, mv_y * nq_x - nv_y * mq_x);
        // Four factors of 1 + 8 eps: of Q, K, K' and of all.
        near(order.error, 256.0 * U * k * k2 * big_q * (s0 + s2) * (1.0 + 32.0 * eps));
        assert!(order.constant > 0.0, "the one behind is no nearer");

        // The range at a displacement, t |q| with t = n.V / n.q.
        let (range_at, doubt) = one.range_at(&ray, [0.5, -0.25]);
        let (height_there, approach) = (nv - 0.25 * nv_y, nq + 0.5 * nq_x - 0.25 * nq_y);
        near(range_at, height_there / approach * ray.length_at([0.5, -0.25]));
        loose(doubt, 256.0 * U * k * s0 / height_there.abs() + 256.0 * U * k * big_q / approach.abs());

        // Corners: no farther than the farthest of them, nor than the plane where it is met most aslant.
        let off = 128.0 * U * s.into_iter().fold(0.0, f64::max);
        let by_corners = v.map(DVec3::length).into_iter().fold(0.0, f64::max) + h + off;
        let slowest = (-nq - (nq_x.abs() + nq_y.abs())) - 128.0 * U * k * big_q;
        let longest = l + l_x.abs() + l_y.abs() + ray.length_bend;
        let on_plane = (nv.abs() + nv_y.abs() + 256.0 * U * k * s0) * longest / slowest;
        let on_plane = if slowest > 0.0 { on_plane } else { f64::INFINITY };
        let farthest = by_corners.min(on_plane).min(m);
        assert!((0.0..256.0 * eps).contains(&(one.farthest / farthest - 1.0)), "{} {farthest}", one.farthest);
        let least = v.into_iter().map(|v| v.dot(q / l)).fold(f64::INFINITY, f64::min);
        near(one.closest(&ray), least - h - off - 64.0 * eps * least);

        for (k, corner) in one.corners.iter().enumerate() {
            let x = (v[k].x - q.x * v[k].z) / (ray.step[0] * v[k].z);
            let y = if h > 0.0 { v[k].y / h } else { (v[k].y - q.y * v[k].z) / (ray.step[1] * v[k].z) };
            near(corner.at[0], x);
            near(corner.at[1], y);
            let (doubt, off) = (32.0 * U * s[k] / v[k].z, 32.0 * U * s[k] * big_q);
            let of = |at: f64, step: f64| {
                (off / (step * v[k].z) + at.abs() * (doubt + 16.0 * U)) * (257.0 / 256.0)
            };
            let down = if h > 0.0 { 32.0 * U * s[k] / h + y.abs() * 16.0 * U } else { of(y, ray.step[1]) };
            let centred = |error: f64| error + 4.0 * U * (1.0 + error);
            let expected = [centred(of(x, ray.step[0])), centred(down) + 4.0 * U * y.abs()];
            for axis in 0..2 {
                let by = corner.error[axis] / expected[axis] - 1.0;
                assert!(by.abs() < 64.0 * eps, "{by:e}");
            }
        }
        assert!(one.is_before());
        let [low, high] = one.bounds();
        for axis in 0..2 {
            let ends = one
                .corners
                .map(|corner| [corner.at[axis] - corner.error[axis], corner.at[axis] + corner.error[axis]]);
            assert_eq!(low[axis], ends.iter().map(|end| end[0]).fold(f64::INFINITY, f64::min));
            assert_eq!(high[axis], ends.iter().map(|end| end[1]).fold(f64::NEG_INFINITY, f64::max));
        }
        // Half way along an edge, and the middle of gravity.
        let through = |v: DVec3| {
            let y = if h > 0.0 { v.y / h } else { (v.y - q.y * v.z) / (ray.step[1] * v.z) };
            [(v.x - q.x * v.z) / (ray.step[0] * v.z), y]
        };
        for k in 0..3 {
            let expected = through(v[k] + 0.25 * e[k]);
            let found = one.edge_point(&ray, k, 0.25);
            assert!((0..2).all(|axis| (found[axis] - expected[axis]).abs() < 1e-14));
        }
        let found = one.point(&ray, [0.5, 0.25, 0.25]);
        let expected = through(0.5 * v[0] + 0.25 * v[1] + 0.25 * v[2]);
        assert!((0..2).all(|axis| (found[axis] - expected[axis]).abs() < 1e-14));
    }
}

#[test]
fn a_corner_that_is_not_certainly_before_the_sensor_may_lie_anywhere() {
    let behind =
        |z: f32| Face { id: FaceId(0), corners: [[-1.0, -2.0, z], [0.5, 3.0, 5.0], [2.0, -1.0, 6.0]] };
    for z in [-1.0, 0.0] {
        let face = behind(z);
        let ray = MovingRay::new(&camera(DVec3::ZERO), aim(2, 1));
        let forms = FaceForms::new(&ray, &face);
        assert_eq!((forms.corners[0].at, forms.corners[0].error), ([0.0; 2], [f64::INFINITY; 2]));
        assert!(!forms.is_before());
        // The rows of a beam are parallel planes: the height is known all the same.
        let ray = MovingRay::new(&beam(DVec3::ZERO), aim(2, 3));
        let forms = FaceForms::new(&ray, &face);
        assert_eq!((forms.corners[0].at, forms.corners[0].error[0]), ([0.0, -5.5], f64::INFINITY));
        assert!(forms.corners[0].error[1] < 1e-13 && !forms.is_before());
    }
    // z of 2^-40: 32 u S / z is 2^-48 3.x / 2^-40, more than a thousandth.
    let face = behind(1.0 / (1_u64 << 40) as f32);
    let ray = MovingRay::new(&camera(DVec3::ZERO), aim(2, 1));
    assert!(!FaceForms::new(&ray, &face).is_before());
    assert!(FaceForms::new(&ray, &behind(1.0 / (1_u64 << 36) as f32)).is_before());
}

/// A triangle slightly inside or outside of each side of the square: only one that is certainly outside is excluded.
/// The offset is too small for f32 corners, so the sensor is moved by it.
#[test]
fn a_face_is_beside_if_it_is_by_more_than_the_errors() {
    // At z = 4: x from q_x - p_x = 0 to q_x + p_x = 1/2 times 4, y from -3/4 to 1/4 times 4.
    let tip = |x: f32, y: f32, dx: f32, dy: f32| Face {
        id: FaceId(0),
        corners: [
            [x, y, 4.0],
            [x + 2.0 * dx + dy, y + 2.0 * dy + dx, 4.0],
            [x + 2.0 * dx - dy, y + 2.0 * dy - dx, 4.0],
        ],
    };
    let sides = [(2.0, -1.0, 1.0, 0.0), (0.0, -1.0, -1.0, 0.0), (1.0, 1.0, 0.0, 1.0), (1.0, -3.0, 0.0, -1.0)];
    for (x, y, dx, dy) in sides {
        let face = tip(x, y, dx, dy);
        // The errors are some 32 u S Q = 2.5e-15 S.
        let s = f64::from(x.abs() + y.abs() + 4.0);
        let error = 32.0 * U * s * 2.25;
        let is_beside = |hair: f64| {
            let position = DVec3::new(-hair * f64::from(dx), -hair * f64::from(dy), 0.0);
            let ray = MovingRay::new(&camera(position), aim(2, 1));
            FaceInSensorFrame::of(&ray, &face).is_beside(&ray)
        };
        assert!(!is_beside(-10.0 * error) && !is_beside(0.0) && !is_beside(0.8 * error), "{x} {y}");
        assert!(is_beside(1.2 * error) && is_beside(1.0), "{x} {y}");
    }
    // A beam's rows: from 1/4 to 5/4 m below the axis; its columns from -1/8 to 3/8 times 4.
    for (x, y, dx, dy) in
        [(1.5, 0.5, 1.0, 0.0), (-0.5, 0.5, -1.0, 0.0), (0.5, 1.25, 0.0, 1.0), (0.5, 0.25, 0.0, -1.0)]
    {
        let face = tip(x, y, dx, dy);
        let s = f64::from(x.abs() + y.abs() + 4.0) + 0.75 + 0.5;
        let error = 32.0 * U * s * if dy == 0.0 { 1.375 } else { 1.0 };
        let is_beside = |hair: f64| {
            let position = DVec3::new(-hair * f64::from(dx), -hair * f64::from(dy), 0.0);
            let ray = MovingRay::new(&beam(position), aim(2, 3));
            FaceInSensorFrame::of(&ray, &face).is_beside(&ray)
        };
        assert!(!is_beside(-10.0 * error) && !is_beside(0.0) && !is_beside(0.8 * error), "{x} {y}");
        assert!(is_beside(1.2 * error) && is_beside(1.0), "{x} {y}");
    }
    // Before the SPP at z = 2, wherever it lies: all of it, by 32 u (S + 2).
    let face = Face { id: FaceId(0), corners: [[0.5, -0.5, 2.0], [1.0, -0.5, 1.0], [0.5, 0.0, 1.0]] };
    let error = 32.0 * U * (3.0 + 2.0);
    let is_beside = |hair: f64| {
        let ray = MovingRay::new(&camera(DVec3::new(0.0, 0.0, hair)), aim(2, 1));
        FaceInSensorFrame::of(&ray, &face).is_beside(&ray)
    };
    assert!(!is_beside(0.0) && !is_beside(0.8 * error) && is_beside(1.2 * error));
}
