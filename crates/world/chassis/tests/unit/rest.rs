//! The two ways of solving a stance, and the search for a change of sign.

use raypencil_scene::{Material, Mesh};

use super::*;

/// Smooth rolling ground, 0.25 m from post to post: 0.2 sin x + 0.15 cos 1.3 y.
fn rolling() -> GroundFaces {
    let posts = (0..41 * 41).map(|post| {
        let (x, y) = (0.25 * f64::from(post % 41) - 5.0, 0.25 * f64::from(post / 41) - 5.0);
        DVec3::new(x, y, 0.2 * libm::sin(x) + 0.15 * libm::cos(1.3 * y))
    });
    let squares = (0..40).flat_map(|row| (0..40).map(move |column| 41 * row + column));
    let faces: Vec<[u32; 3]> = squares.flat_map(|a| [[a, a + 1, a + 42], [a, a + 42, a + 41]]).collect();
    let sand = Material { name: "sand".into(), reflectivity: 0.25 };
    let materials = vec![0; faces.len()];
    GroundFaces::new(&Mesh::from_global(&posts.collect::<Vec<_>>(), faces, materials, vec![sand]).unwrap())
}

#[test]
fn bisection_finds_what_fixed_point_steps_find() {
    // Both leave at most 1e-13 m; the sines of the angles then agree within 1e-13 m / (T / 2), and the solution of the
    // pair is at most a few times as sensitive.
    let (chassis, ground) = (Chassis::default(), rolling());
    for step in 0..20 {
        let (sin, cos) = libm::sincos(0.3 * f64::from(step));
        let place = DVec2::new(0.15 * f64::from(step) - 1.5, 0.5);
        let standing = Standing { chassis: &chassis, ground: &ground, place, forward: DVec2::new(cos, sin) };
        let fixed = standing.by_fixed_point().unwrap().expect("gentle ground");
        let bisected = standing.by_bisection().unwrap();
        assert!((fixed.pitch_down - bisected.pitch_down).abs() < 1e-11, "{step}");
        assert!((fixed.roll_right - bisected.roll_right).abs() < 1e-11, "{step}");
        assert!((fixed.height - bisected.height).abs() < 1e-11, "{step}");
    }
}

/// The end of a search, and the number of its evaluations.
fn search(value: impl Fn(f64) -> f64) -> (f64, u32) {
    let mut count = 0;
    let angle = sign_change(|angle| {
        count += 1;
        Some((value(angle), 1e-14, angle))
    });
    (angle.expect("every angle has a value"), count)
}

#[test]
fn a_change_of_sign_is_found_smooth_or_not() {
    let (angle, count) = search(|angle| libm::sin(angle) - 0.3);
    assert!((angle - libm::asin(0.3)).abs() < 2e-14 && count <= 16, "{angle} {count}");
    // A jump at 0.7: the side with the smaller value, -1, right below it. pi to 1e-15 takes 52 halvings.
    let (angle, count) = search(|angle| if angle < 0.7 { -1.0 } else { 2.0 });
    assert!(angle < 0.7 && 0.7 - angle <= 1e-15 && count <= 104, "{angle} {count}");
    // A step so flat that secants alone would creep.
    let (angle, count) = search(|angle| libm::tanh(1e9 * (angle - 1.2)) + 1e-3 * (angle - 1.2));
    assert!((angle - 1.2).abs() < 1e-14 && count <= 104, "{angle} {count}");
    // No change at all: the end of the range where it should have been.
    let (angle, count) = search(|_| -1.0);
    assert!(FRAC_PI_2 - angle < 1e-14 && count <= 104, "{angle} {count}");
    // No value.
    assert!(sign_change(|_| None::<(f64, f64, ())>).is_none());
}
