//! Fluxes by three ways of evaluation, and the factor of narrow Gaussians.

use super::*;
use glam::DVec3;
use raypencil_scene::{Atmosphere, Beam, Camera, Lens, Mounted, Pose, Profile, Scene};
use raypencil_terrain::builtin;

/// The pyramids before a small rig like the default one.
fn scene(profile: Profile) -> Scene {
    let mesh = builtin("pyramids", 0.25).expect("a built-in ground").into_mesh().expect("a mesh");
    let at = |height: f64, pitch_deg: f64| Pose {
        position: DVec3::new(0.3, 0.0, height),
        ..Pose::from_axis_angle(DVec3::Y, pitch_deg.to_radians()) * Pose::VEHICLE_FROM_FORWARD_SENSOR
    };
    let camera = Camera {
        width: 64,
        height: 64,
        pixel_pitch: [144e-6; 2],
        focal_length: 8e-3,
        principal_point: [32.0; 2],
        aperture: 2e-3,
        lens: Lens::CLEAR,
        max_range: 20.0,
    };
    let beam = Beam {
        columns: 48,
        rows: 3,
        thickness: 5e-3,
        grid_distance: 0.1,
        half_width: 0.0577,
        max_range: 20.0,
        power: 1.0,
        wavelength: 810e-9,
        profile,
    };
    Scene::new(
        Arc::new(mesh),
        Mounted { scene_from_sensor: at(1.5, 20.0), sensor: camera },
        vec![Mounted { scene_from_sensor: at(1.8, 31.0), sensor: beam }],
        Atmosphere { attenuation: 0.0 },
        FluxModel::Radiometric,
    )
    .expect("a scene")
}

/// Pairs of f64, enclosures and, where it is one, the exact root: three ways to the same number.
#[test]
fn all_ways_to_a_flux_agree() {
    for profile in [Profile::Paper, Profile::UniformAngle] {
        let scene = scene(profile);
        let referee = Referee::new(&scene);
        let light = referee.light(0, Sampling::Centres).expect("a beam");
        let mut seen = 0;
        for (i, j) in (0..3).flat_map(|j| (0..48).map(move |i| (i, j))) {
            let Some((face, back)) = light.returned_of_face(i, j) else { continue };
            let (true, Some(pixel)) = (back.visible, back.pixel) else { continue };
            seen += 1;
            let (sensor, face) = (light.beam_with(i, j).unwrap(), referee.face(face).unwrap());
            let point = light.lit_point(&sensor, light.shares.aim(i, j), &face);
            let exact = point.exact();
            for model in [FluxModel::Radiometric, FluxModel::Eq1] {
                let fast = light.formula().flux(&Fast, &point.fast(), point.aim, &face, model, pixel);
                let enclosed = decide_rounding(DoubleDouble::UNKNOWN, |precision| {
                    light.formula().flux(precision, &exact, point.aim, &face, model, pixel)
                });
                assert_eq!(fast.rounded(), enclosed.ok(), "{i},{j} {model:?}");
                assert_eq!(back.flux(model), enclosed);
                if light.formula().is_root(model) {
                    assert_eq!(Ok(light.formula().root_of(&exact, point.aim, &face)), enclosed, "{i},{j}");
                }
            }
            let CameraTerms { towards, direction_squared, axial, squared, scale, frame_scale } =
                &exact.camera;
            assert_eq!(back.depth, quotient(axial, &frame_scale.mul(scale)));
            assert_eq!(back.cos_off_axis, cosine(axial, squared));
            let lengths = direction_squared.mul(&exact.intersection.normal_squared);
            assert_eq!(back.cos_view, cosine(towards, &lengths));
        }
        assert!(seen > 60, "{seen} of 144 pencils are seen");
    }
}

#[test]
fn the_least_exponent_is_that_of_the_pencil_nearest_the_axis() {
    // g = 1/10, w = 0.0577...: 30 degrees to either side.
    let of = |columns: u32, half_width: f64| {
        let scene = scene(Profile::Gaussian { half_width });
        let mut beam = scene.beams()[0];
        beam.sensor.columns = columns;
        let (mesh, model) = (Arc::clone(scene.mesh()), scene.flux_model());
        let scene =
            Scene::new(mesh, *scene.camera(), vec![beam], scene.atmosphere(), model).expect("a scene");
        let exponent = |sampling: Sampling| {
            let referee = Referee::new(&scene);
            referee.light(0, sampling).expect("a beam").shares.least_exponent(half_width)
        };
        let Beam { half_width: w, grid_distance, rows, .. } = beam.sensor;
        let offset = Sampling::Jittered { seed: 5 };
        // By hand: half cells from the axis.
        let by_hand = |nearest: f64| {
            let relative = libm::atan(w * nearest / (f64::from(columns) * grid_distance)) / half_width;
            relative * relative
        };
        let jittered = (0..rows)
            .flat_map(|j| (0..columns).map(move |i| (i, j)))
            .map(|(i, j)| (f64::from(2 * i + 1) - f64::from(columns) + 2.0 * offset.offset(0, i, j)[0]).abs())
            .fold(f64::INFINITY, f64::min);
        (exponent(Sampling::Centres), by_hand(1.0), exponent(offset), by_hand(jittered))
    };
    // Of an even number of columns the nearest is half a cell off: here by more than ten half widths.
    let (centres, by_hand, jittered, jittered_by_hand) = of(6, 5e-3);
    assert!(by_hand > 100.0, "{by_hand}");
    assert!((centres / by_hand - (1.0 - 1e-9)).abs() < 1e-12, "{centres} {by_hand}");
    let expected = if jittered_by_hand < 100.0 { 0.0 } else { jittered_by_hand * (1.0 - 1e-9) };
    assert!((jittered - expected).abs() <= 1e-12 * expected, "{jittered} {expected}");
    // Of an odd number one is on the axis; and a wide profile needs none.
    assert_eq!(of(7, 5e-3).0, 0.0);
    assert_eq!(of(1, 5e-3).0, 0.0);
    assert_eq!(of(6, 0.5).0, 0.0);
}
