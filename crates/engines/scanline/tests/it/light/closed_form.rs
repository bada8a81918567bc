//! Equation (1) and the radiometric model on a plane wall, against numbers derived by hand.

use glam::DVec3;
use raypencil_scene::{Beam, Filter, FluxModel, Pixel, Profile};

use super::rig::{Rig, at, four_pencils, one_pencil, return_at, reversed, sum, wall};

/// The scene of `Rig::new`, in air of sigma = 0.1 / m.
///
/// From the camera the last pencil's point is (1, 2, 2): r = 2, d = 3, cos(phi) = 2/3, and, the wall being parallel
/// to the image, cos(theta) = 2/3. From the laser it is (3/2, 0, 2): R = 5/2, cos(psi) = 4/5. It lands at
/// 64 (1/2, 1) + 128.25 = (160.25, 192.25).
fn rig(model: FluxModel, profile: Profile) -> Rig {
    let mut rig = Rig { attenuation: 0.1, model, ..Rig::new() };
    rig.beams[0].sensor.profile = profile;
    rig
}

const PROFILES: [Profile; 3] = [Profile::Paper, Profile::UniformAngle, Profile::Gaussian { half_width: 0.5 }];

/// P_k of the last pencil. tan(alpha) = 3/4 and 1/4, so cos(alpha) = 4/5 and 4/sqrt(17); I_b = 4 W.
///
/// * paper: 4 (4/5) / 4
/// * uniform angle: 4 (16/25) / (2 (16/25 + 16/17)) = 17/21
/// * Gaussian of w = 0.5 rad: alpha = 0.6435011 and 0.2449787 rad, exp(-2 (alpha/w)^2) = 0.0364159 and 0.6187114,
///   of whose sum, twice, it is 0.02779301
const SHARES: [f64; 3] = [0.8, 17.0 / 21.0, 4.0 * 0.027_793_005_388_567_366];

/// A filter at 900 nm, 40 nm wide, n_eff = 2. For the last pencil's point sin^2(phi) = 5/9, so its centre shifts to
/// 900 sqrt(1 - 5/36) = 835.164654 nm. The wavelength is 20 nm above that: F(phi) = 1/2.
const FILTER: Filter = Filter::Interference { centre: 900e-9, width: 40e-9, index: 2.0 };
const WAVELENGTH: f64 = 855.164_654_424_503_3e-9;

#[track_caller]
fn assert_close(a: f64, b: f64) {
    assert!((a / b - 1.0).abs() < 1e-12, "{a} {b}");
}

#[test]
fn geometry_of_a_return() {
    let returned = rig(FluxModel::Radiometric, Profile::Paper).pencil_return(3);
    assert!(returned.visible);
    assert_eq!(returned.pixel, Some(Pixel { i: 160, j: 192 }));
    assert_close(returned.depth, 2.0);
    assert_close(returned.cos_off_axis, 2.0 / 3.0);
    assert_close(returned.cos_view, 2.0 / 3.0);
}

#[test]
fn the_point_and_the_normal_of_a_pixel() {
    // The ray through the middle of pixel (160, 192) runs at x/z = 32.25/64 and y/z = 64.25/64 from (0, -2, 0).
    let camera = Rig::new().render().camera.expect("asked for");
    let point = camera.point.expect("asked for").at(160, 192).get().expect("a hit");
    assert!((point - DVec3::new(1.007_812_5, 0.007_812_5, 2.0)).length() < 1e-14, "{point}");
    assert_eq!(camera.normal.expect("asked for").at(160, 192).get(), Some(DVec3::new(0.0, 0.0, -1.0)));
}

#[test]
fn a_hit_at_the_maximum_range_counts() {
    // The pencil along the axis meets the wall at 2 m exactly.
    let range_with = |max_range: f64| {
        let beam = at(0.0, 0.0, 0.0, Beam { max_range, ..one_pencil() });
        let frame = Rig { beams: vec![beam], ..Rig::new() }.render();
        frame.beams[0].range.as_ref().expect("asked for").at(0, 0).get()
    };
    assert_eq!((range_with(2.0), range_with(2.0_f64.next_down())), (Some(2.0), None));
}

#[test]
fn radiometric_flux() {
    // I = P r_d C_loss F (D^2/4) cos(theta) cos^3(phi) / r^2 e^(-sigma (R + d))
    //   = P 0.25 0.9 F 1e-6 (2/3)(2/3)^3 / 4 e^-0.55 = P F 1e-6 (1/90) e^-0.55.
    let of_one_watt = 1e-6 / 90.0 * 0.576_949_810_380_486_7;
    for (profile, share) in PROFILES.into_iter().zip(SHARES) {
        let mut rig = rig(FluxModel::Radiometric, profile);
        assert_close(rig.pencil_return(3).flux, share * of_one_watt);
        rig.camera.lens.filter = FILTER;
        rig.beams[0].sensor.wavelength = WAVELENGTH;
        assert_close(rig.pencil_return(3).flux, share * of_one_watt / 2.0);
    }
}

#[test]
fn flux_by_equation_1() {
    // phi is that of the centre of pixel (160, 192), tan^2(phi) = (32.25^2 + 64.25^2) / 64^2 = 1.261749, so
    // cos^4(phi) = 0.195483940 and sin^2(phi) = 0.557864342. F(phi): the filter's centre shifts to
    // 900 sqrt(1 - 0.139466) = 834.884705 nm, 20.279949 nm below the wavelength: exp(-4 ln 2 0.506999^2) = 0.490324628.
    // I = P r_d (pi/4)(D/f_c)^2 C_loss F A_cp cos^4(phi) cos(theta) cos(psi) / (R r^2) e^(-0.2) e^(-0.25)
    //   = P 0.25 (pi/4) 0.256^2 0.9 F 8192^-2 0.195483940 (2/3)(4/5) / 10 0.637628151.
    let d_over_f = 0.256_f64 * 0.256;
    let of_one_watt = 0.25 * std::f64::consts::FRAC_PI_4 * d_over_f * 0.9 / (8192.0 * 8192.0)
        * 0.195_483_939_820_31
        * (8.0 / 15.0)
        / 10.0
        * 0.637_628_151_621_773_3;
    for (profile, share) in PROFILES.into_iter().zip(SHARES) {
        let mut rig = rig(FluxModel::Eq1, profile);
        assert_close(rig.pencil_return(3).flux, share * of_one_watt);
        rig.camera.lens.filter = FILTER;
        rig.beams[0].sensor.wavelength = WAVELENGTH;
        assert_close(rig.pencil_return(3).flux, share * of_one_watt * 0.490_324_627_604_355_47);
    }
}

#[test]
fn flux_falls_with_the_square_of_depth_and_equation_1_with_range_too() {
    // Camera and laser are in one place, and the pencil runs along both axes: R = r = d, all cosines are 1.
    let flux = |model, z| {
        let beams = vec![at(0.0, -2.0, 0.0, one_pencil())];
        Rig { faces: vec![wall(z)], beams, model, ..Rig::new() }.pencil_return(0).flux
    };
    // 1 W 0.25 0.9 1e-6 / 4.
    assert_close(flux(FluxModel::Radiometric, 2.0), 0.225e-6 / 4.0);
    assert_close(flux(FluxModel::Radiometric, 2.0), 4.0 * flux(FluxModel::Radiometric, 4.0));
    assert_close(flux(FluxModel::Eq1, 2.0), 8.0 * flux(FluxModel::Eq1, 4.0));
}

#[test]
fn the_models_differ_by_a_factor_of_angles_and_range() {
    // Without air, without a filter and with one phi, equation (1) is the radiometric flux times
    // pi (A_cp / f_c^2) cos(phi) cos(psi) / R, with A_cp / f_c^2 = 1/64^2. cos^2(phi) of the pixel's centre is
    // 0.442135658, that of the point 4/9.
    let flux = |model| Rig { attenuation: 0.0, ..rig(model, Profile::Paper) }.pencil_return(3).flux;
    let cos_4_phi = (4.0_f64 / 9.0) * (4.0 / 9.0);
    let at_own_phi = flux(FluxModel::Eq1) * cos_4_phi / 0.195_483_939_820_31;
    let factor = std::f64::consts::PI / 4096.0 * (2.0 / 3.0) * 0.8 / 2.5;
    assert_close(at_own_phi, flux(FluxModel::Radiometric) * factor);
}

#[test]
fn a_face_reflects_by_its_own_material() {
    // The wall is split at x = 1/2 m. The last pencil hits the right face, which gets a darker material.
    let darker = [[0.5, -40.0, 2.0], [0.5, 40.0, 2.0], [40.0, 0.0, 2.0]];
    let mut rig = Rig::new().with(&[darker]);
    rig.faces[0] = [[0.5, -40.0, 2.0], [-40.0, 0.0, 2.0], [0.5, 40.0, 2.0]];
    let bright = rig.pencil_return(3).flux;
    rig.reflectivities = vec![0.25, 0.05];
    assert_close(rig.pencil_return(3).flux, bright / 5.0);
    assert_close(rig.pencil_return(0).flux, Rig::new().pencil_return(0).flux);
}

#[test]
fn the_flux_of_a_pixel_is_the_sum_over_its_pencils_in_their_order() {
    let mut rig = Rig::new();
    rig.beams[0].sensor = Beam { columns: 1024, rows: 16, ..four_pencils() };
    rig.beams.push(at(-0.4, 0.1, 0.0, four_pencils()));
    let frame = rig.render();
    for (beam, image) in frame.flux.iter().enumerate() {
        assert_eq!((image.width(), image.height()), (256, 256));
        let mut expected = vec![0.0; 256 * 256];
        let returns = &frame.returns[beam];
        for j in 0..returns.rows {
            for i in 0..returns.columns {
                let returned = return_at(&frame, beam, i, j).unwrap();
                let Some(pixel) = returned.pixel.filter(|_| returned.visible) else { continue };
                assert!(returned.flux > 0.0);
                expected[(pixel.j * 256 + pixel.i) as usize] += returned.flux;
            }
        }
        assert_eq!(image.cells(), expected);
        assert!(sum(image) > 0.0);
    }
}

#[test]
fn a_point_off_the_image_has_no_pixel_and_no_flux() {
    // With half the pitch the screen ends at x/z = 127.75/128. The point is at y/z = 1.
    let mut rig = Rig::new();
    rig.camera.pixel_pitch = [1.0 / 16384.0; 2];
    let returned = rig.pencil_return(3);
    assert_eq!((returned.pixel, returned.visible, returned.flux), (None, false, 0.0));
    assert_close(returned.depth, 2.0);
    assert_close(returned.cos_view, 2.0 / 3.0);
    // A point behind the camera has a negative depth: the camera is at (0, -2, 4), behind the wall, and looks away.
    let mut rig = Rig::new();
    rig.scene_from_camera.position.z = 4.0;
    let returned = rig.pencil_return(3);
    assert_eq!((returned.pixel, returned.visible, returned.flux), (None, false, 0.0));
    assert_close(returned.depth, -2.0);
    assert_close(returned.cos_off_axis, -2.0 / 3.0);
    assert_close(returned.cos_view, -2.0 / 3.0);
    // A point in front of the SPP: f_c = 1/128 m, and the wall is 1/256 m away.
    let mut rig = Rig::new();
    rig.scene_from_camera.position.z = 2.0 - 1.0 / 256.0;
    assert_eq!((rig.pencil_return(3).pixel, rig.pencil_return(3).visible), (None, false));
}

#[test]
fn a_point_on_a_back_is_not_visible_but_has_a_pixel() {
    // The camera is behind the wall, at z = 4, and looks back: half a turn about y.
    let mut rig = Rig::new();
    rig.scene_from_camera.position.z = 4.0;
    rig.scene_from_camera.rotation = glam::DQuat::from_xyzw(0.0, 1.0, 0.0, 0.0);
    let returned = rig.pencil_return(3);
    // Its x axis is reversed: the point is at (-1, 2, 2).
    assert_eq!(returned.pixel, Some(Pixel { i: 96, j: 192 }));
    assert_close(returned.cos_view, -2.0 / 3.0);
    assert_eq!((returned.visible, returned.flux), (false, 0.0));
    // A second wall in the same place, facing the camera, does not make the point visible.
    assert!(!rig.with(&[reversed(wall(2.0))]).pencil_return(3).visible);
}
