//! Each bound beside its derivation, in numbers. A roundoff of 2^-10 makes every term count.

use std::f64::consts::{FRAC_PI_8, LN_2};
use std::sync::Arc;

use super::*;
use raypencil_scene::{Atmosphere, Camera, Lens, Material, Mounted, Pose, rig};

const U: f64 = 1.0 / 1024.0;
const COARSE: Precision = Precision { unit_roundoff: U };

/// Equal to a few roundings of the bound itself.
#[track_caller]
fn assert_close(bound: f64, derived: f64) {
    assert!((bound / derived - 1.0).abs() < 1e-14, "{bound} is not {derived}");
}

fn mesh_of(corners: [[f32; 3]; 3]) -> Mesh {
    let ground = Material { name: "ground".into(), reflectivity: 0.25 };
    Mesh::new(DVec3::ZERO, corners.to_vec(), vec![[0, 1, 2]], vec![0], vec![ground]).unwrap()
}

#[test]
fn the_bound_of_a_right_triangle_seen_head_on() {
    // Legs of 1 m: kappa = L = sqrt 2. From 3 m above its corner at the origin, straight down:
    // R = 3, |o| = 3, c = 1, so |dR| <= 36 kappa u (6 + sqrt 2), u = 2^-53.
    let mesh = mesh_of([[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
    let ray = Ray { origin: DVec3::new(0.0, 0.0, 3.0), direction: DVec3::new(0.0, 0.0, -0.5) };
    let bounds = HitBounds::of(&mesh, FaceId(0), &ray, 3.0, Precision::F64);
    let u = 2.0_f64.recip() * f64::EPSILON;
    let kappa = 2.0_f64.sqrt();
    let scale = 6.0 + kappa;
    assert_close(bounds.range, 36.0 * kappa * u * scale);
    assert_close(bounds.point, (36.0 * kappa + 18.0) * u * scale);
    assert_close(bounds.normal, 13.0 * kappa * u);
}

#[test]
fn the_bound_of_an_oblique_face_from_anywhere() {
    // Sides of 3, 4 and 5 m and an area of 6 m^2, |n| = 12 m^2. |e1| |e2| / |n| is 3 * 5 / 12, 3 * 4 / 12 or
    // 4 * 5 / 12, by the corner at which a renderer begins; kappa is the largest, wherever the file begins. L = 5 m.
    let (p, q, r) = ([1.0, 1.0, 0.0], [4.0, 1.0, 0.0], [4.0, 5.0, 0.0]);
    // |o| = 5 m, |q| = 2 m, cos(psi) = 1.6 / 2, R = 6 m: S = 6 + 5 + 5 m.
    let ray = Ray { origin: DVec3::new(3.0, 0.0, 4.0), direction: DVec3::new(0.0, 1.2, -1.6) };
    let kappa = 5.0 / 3.0;
    for corners in [[p, q, r], [q, r, p], [r, p, q]] {
        let bounds = HitBounds::of(&mesh_of(corners), FaceId(0), &ray, 6.0, COARSE);
        let range = 36.0 * kappa * U * 16.0 / 0.8;
        assert_close(bounds.range, range);
        assert_close(bounds.point, range + 18.0 * U * 16.0);
        assert_close(bounds.normal, 13.0 * kappa * U);
        assert_close(bounds.cos_incidence, 48.0 * kappa * U * 16.0 / 6.0);
    }
}

const HIT: HitBounds = HitBounds { range: 0.25, point: 0.5, normal: 0.125, cos_incidence: 0.0625 };

#[test]
fn two_renderers_may_differ_by_the_sum_of_their_bounds() {
    let other = HitBounds { range: 1.0, point: 2.0, normal: 3.0, cos_incidence: 4.0 };
    let both = HitBounds { range: 1.25, point: 2.5, normal: 3.125, cos_incidence: 4.0625 };
    assert_eq!(HIT.plus(&other), both);
    let of_each = HitQuantity::ALL.map(|quantity| both.of_quantity(quantity));
    // Range, depth, point, normal, cosine.
    assert_eq!(of_each, [1.25, 1.25, 2.5, 3.125, 4.0625]);

    let returns = |k: f64| ReturnBounds {
        depth: k,
        cos_off_axis: 2.0 * k,
        cos_view: 3.0 * k,
        flux: 5.0 * k,
        subnormal_flux: k,
    };
    let both = returns(1.0).plus(&returns(0.5));
    assert_eq!(both, returns(1.5));
    // Relative 7.5 of a flux of 2, and 1.5 whatever the flux.
    assert_eq!(both.of_flux(2.0), 16.5);
}

/// sigma = 1/2 per metre; the camera 5 m from the origin, with these losses; one beam of this profile.
fn scene(model: FluxModel, filter: Filter, profile: Profile) -> Scene {
    let sensor = Camera {
        pixel_pitch: [0.0625, 0.03125],
        aperture: 4.0,
        lens: Lens { transmission: 1.0, filter },
        ..rig::camera(4, 2, 0.0625, 0.5)
    };
    let at = Pose::from_position(DVec3::new(0.0, 3.0, 4.0));
    let beam = Beam {
        half_width: 0.2,
        power: 3.0,
        wavelength: 5.8e-4,
        profile,
        ..rig::beam(8, 2, [0.0625, 0.25], 0.125)
    };
    let mesh = Arc::new(mesh_of([[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]));
    let mounted = Mounted { scene_from_sensor: Pose::IDENTITY, sensor: beam };
    let camera = Mounted { scene_from_sensor: at, sensor };
    Scene::new(mesh, camera, vec![mounted], Atmosphere { attenuation: 0.5 }, model).unwrap()
}

/// Column 6 of 8: x / g = 0.2 * 5 / (8 * 0.125) = 1, so alpha = pi / 4.
fn bounds_of(scene: &Scene) -> ReturnBounds {
    let values = ReturnValues {
        range: 4.0,
        cos_incidence: 0.5,
        depth: 2.0,
        cos_off_axis: 0.8,
        cos_view: 0.25,
        distance: 2.5,
    };
    ReturnBounds::of(scene, (0, 6), &HIT, values, COARSE, scene.flux_model())
}

/// dP = 0.5 + 18 u S' with S' = 2 * 5 + 2 * 2.5 m.
const POINT: f64 = 0.5 + 18.0 * U * 15.0;
/// The angle dP / d, and 8 roundings of the cosine.
const OFF_AXIS: f64 = POINT / 2.5 + 8.0 * U;
/// The same, and the error of the normal.
const VIEW: f64 = POINT / 2.5 + 0.125 + 8.0 * U;
/// Relative error of r^-2 cos(theta), and the roundings of the product.
const SHARED: f64 = 2.0 * POINT / 2.0 + VIEW / 0.25 + 64.0 * U;
/// Relative error of the attenuation: sigma (dR + dP), and four roundings of sigma (R + d).
const AIR: f64 = 0.5 * (0.25 + POINT) + 0.5 * 6.5 * 4.0 * U;

#[test]
fn the_bounds_of_a_return() {
    let bounds = bounds_of(&scene(FluxModel::Radiometric, Filter::None, Profile::Paper));
    assert_close(bounds.depth, POINT);
    assert_close(bounds.cos_off_axis, OFF_AXIS);
    assert_close(bounds.cos_view, VIEW);
    // cos^3(phi) of the radiometric flux.
    assert_close(bounds.flux, SHARED + AIR + 3.0 * OFF_AXIS / 0.8);
    // The smallest normal f32, times 1 + 3 W, times 1 + D^2 / r^2.
    assert_close(bounds.subnormal_flux, f64::from(f32::MIN_POSITIVE) * 4.0 * 5.0);

    // Equation (1) has cos(psi) / R, and D^2 / r^2 times the pixel's area / (f^2 R).
    let bounds = bounds_of(&scene(FluxModel::Eq1, Filter::None, Profile::Paper));
    assert_close(bounds.flux, SHARED + AIR + 0.25 / 4.0 + 0.0625 / 0.5);
    let gain = 4.0 * (0.0625 * 0.03125) / (0.5 * 0.5 * 4.0);
    assert_close(bounds.subnormal_flux, f64::from(f32::MIN_POSITIVE) * 4.0 * (1.0 + gain));
}

#[test]
fn a_profile_adds_the_roundings_of_its_sum() {
    let plain = SHARED + AIR + 3.0 * OFF_AXIS / 0.8;
    let of = |profile| bounds_of(&scene(FluxModel::Radiometric, Filter::None, profile)).flux;
    assert_close(of(Profile::UniformAngle), plain + 16.0 * U);
    // alpha / w = 2: the exponent 2 * 2^2 is good to 20 u of it.
    assert_close(of(Profile::Gaussian { half_width: FRAC_PI_8 }), plain + 16.0 * U + 2.0 * 4.0 * 20.0 * U);
}

#[test]
fn a_filter_adds_the_shift_of_its_pass_band() {
    // sin(phi) = 0.6 and n = 15/7: c' = c sqrt(1 - 0.28^2) = 0.96 c.
    let filter = Filter::Interference { centre: 5e-4, width: 2e-4, index: 15.0 / 7.0 };
    // dc' = c^2 / (c' n^2) d cos(phi) + 8 u c, and the wavelength is 5.8e-4 - 4.8e-4 m away.
    let bound = |off_axis: f64| {
        let shift = 5e-4 * (off_axis / (0.96 * 225.0 / 49.0) + 8.0 * U);
        let away = (1e-4 + shift) / 2e-4;
        4.0 * LN_2 * away * (2.0 * shift / 2e-4 + 10.0 * U * away)
    };
    let radiometric = bounds_of(&scene(FluxModel::Radiometric, filter, Profile::Paper)).flux;
    assert_close(radiometric, SHARED + AIR + 3.0 * OFF_AXIS / 0.8 + bound(OFF_AXIS));
    // Equation (1) takes phi of the pixel's centre: rounding only.
    let eq1 = bounds_of(&scene(FluxModel::Eq1, filter, Profile::Paper)).flux;
    assert_close(eq1, SHARED + AIR + 0.25 / 4.0 + 0.0625 / 0.5 + bound(8.0 * U));
}

#[test]
fn the_smallest_normal_number_is_that_of_the_arithmetic() {
    assert_eq!(min_normal(Precision::F64), f64::MIN_POSITIVE);
    assert_eq!(min_normal(Precision::F32), f64::from(f32::MIN_POSITIVE));
    let by_both = ReturnBounds::by_both_models;
    let scene = scene(FluxModel::Eq1, Filter::None, Profile::Paper);
    let values = ReturnValues {
        range: 4.0,
        cos_incidence: 0.5,
        depth: 2.0,
        cos_off_axis: 0.8,
        cos_view: 0.25,
        distance: 2.5,
    };
    // The scene's model comes first.
    let [first, second] = by_both(&scene, (0, 6), &HIT, values, COARSE);
    assert_eq!(first, bounds_of(&scene));
    assert_close(second.flux, SHARED + AIR + 3.0 * OFF_AXIS / 0.8);
}
