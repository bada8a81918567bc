//! The flux of single pencils against numbers derived by hand, for every model and profile.

use super::common;

use common::{SceneBuilder, close, return_at, screen};
use glam::DVec3;
use raypencil_scene::{Filter, FluxModel, Lens, Pixel, Pose, Profile, Renderer, Request, Sampling};
use raypencil_tracer::Tracer;

/// Relative tolerance: some 50 roundings of 2^-53 each, and as many again for the decimals of the numbers below.
const RELATIVE_TOLERANCE: f64 = 1e-14;

/// An interference filter whose pass band, seen at sin(phi) = 0.6, lies 10 nm from the laser's 810 nm. There
/// sin(phi) / index = 1/2, so the centre of the band shifts to 800 nm.
fn filtered() -> Lens {
    let centre = 800e-9 / 0.75_f64.sqrt();
    Lens { transmission: 0.5, filter: Filter::Interference { centre, width: 20e-9, index: 1.2 } }
}

// Pencil 0 hits P = (1.5, 0, 2): R = 2 * 5/4 = 2.5 m, cos(alpha) = cos(psi) = 4/5, r = 2 m, d = 2.5 m,
// cos(phi) = cos(theta) = 4/5, sin(phi) = 3/5.

#[test]
fn the_geometry_of_one_pencil() {
    let returned = SceneBuilder::new().pencil_return(0);
    assert!(returned.visible);
    assert_eq!((returned.depth, returned.cos_off_axis, returned.cos_view), (2.0, 0.8, 0.8));
    // 16 * 3/4 + 32.25 = 44.25 across, 32.5 down.
    assert_eq!(returned.pixel, Some(Pixel { i: 44, j: 32 }));
}

#[test]
fn a_pencil_below_the_axis_is_seen_in_its_own_row() {
    let mut builder = SceneBuilder::new();
    builder.pose = Pose::from_position(DVec3::new(3.0, 0.5, 0.0));
    // y / z = 1/4: 16 / 4 + 32.5 = 36.5 down.
    assert_eq!(builder.pencil_return(0).pixel, Some(Pixel { i: 44, j: 36 }));
}

#[test]
fn radiometric() {
    // P_k = 3 W * 0.8 / 3 = 0.8 W, r_d = 1/4, D^2 / 4 = 1/16 m^2:
    // 0.8 * 0.25 * 0.0625 * 0.8 * 0.512 / 4 = 1.28e-3 W.
    let mut builder = SceneBuilder::new();
    assert!(close(builder.pencil_return(0).flux, 1.28e-3, RELATIVE_TOLERANCE));
    // C_loss = 1/2 and F = exp(-4 ln 2 (10 / 20)^2) = 1/2: a quarter. The centre of 800 nm is rounded: an error of
    // 1e-16 of 800 nm in 10 nm, doubled by the square, times 0.7.
    builder.camera.lens = filtered();
    assert!(close(builder.pencil_return(0).flux, 0.32e-3, 1e-13));
    // sigma = 0.3 per metre over R + d = 5 m.
    builder.attenuation = 0.3;
    assert!(close(builder.pencil_return(0).flux, 0.32e-3 * libm::exp(-1.5), 1e-13));
}

#[test]
fn equation_1() {
    // P_k r_d = 0.2 W, (D / f_c)^2 A_cp = 32^2 * 2^-20 = 2^-10 m^2, cos(theta) cos(psi) / (R r^2) = 0.64 / 10.
    // The pixel's centre is 12.25 pixels to the right: tan(phi) = 0.765625 (the pencil's own is 0.75),
    // cos^4(phi) = 1 / 1.586181640625^2 = 0.3974606719303962.
    // 0.2 * (pi / 4) / 1024 * 0.064 * 0.3974606719303962 = 3.902061021960611e-6 W/m.
    let mut builder = SceneBuilder { model: FluxModel::Eq1, ..SceneBuilder::new() };
    assert!(close(builder.pencil_return(0).flux, 3.902_061_021_960_611e-6, RELATIVE_TOLERANCE));
    // The filter uses the pixel's centre too: sin^2(phi) = 0.3695551793135293, the pass band is at
    // 923.76 nm sqrt(1 - 0.36956 / 1.44) = 796.453182251103 nm, F = exp(-4 ln 2 0.6773408874448478^2) =
    // 0.2802599092210986; and C_loss = 1/2.
    builder.camera.lens = filtered();
    let expected = 3.902_061_021_960_611e-6 * 0.5 * 0.280_259_909_221_098_6;
    assert!(close(builder.pencil_return(0).flux, expected, 1e-13));
    // e^(-sigma r) e^(-sigma R): 0.3 * (2 + 2.5) = 1.35. (Not R + d.)
    builder.attenuation = 0.3;
    assert!(close(builder.pencil_return(0).flux, expected * libm::exp(-1.35), 1e-13));
}

#[test]
fn profiles() {
    // cos(alpha) = 4/5, 1, 4/5. `paper`: cos(alpha) / 3 for each. `uniform_angle`: 0.64, 1, 0.64, divided by their
    // sum 2.28. `gaussian` with half width atan(3/4): e^-2, 1, e^-2, divided by 1 + 2 e^-2; 0.1065069789192008 for
    // the outer ones.
    let power_of = |profile| {
        let mut builder = SceneBuilder::new();
        builder.beam.profile = profile;
        // 0.8 W in the pencil give 1.28e-3 W in the pixel: see `radiometric`.
        builder.pencil_return(0).flux / 1.28e-3 * 0.8
    };
    assert!(close(power_of(Profile::Paper), 0.8, RELATIVE_TOLERANCE));
    assert!(close(power_of(Profile::UniformAngle), 3.0 * 0.64 / 2.28, RELATIVE_TOLERANCE));
    let half_width = libm::atan(0.75);
    assert!(close(
        power_of(Profile::Gaussian { half_width }),
        3.0 * 0.106_506_978_919_200_8,
        RELATIVE_TOLERANCE
    ));
}

#[test]
fn flux_falls_with_the_square_of_the_distance() {
    // Twice as far with the same angles. Doubling is exact in binary.
    let near = SceneBuilder::new().pencil_return(0).flux;
    let mut builder =
        SceneBuilder { pose: Pose::from_position(DVec3::new(6.0, 0.0, 0.0)), ..SceneBuilder::new() };
    builder.faces = screen(4.0, [-16.0, 16.0], [-16.0, 16.0]).to_vec();
    assert_eq!(builder.pencil_return(0).flux, near / 4.0);
    // `eq1` falls with R r^2.
    builder.model = FluxModel::Eq1;
    assert_eq!(
        builder.pencil_return(0).flux,
        SceneBuilder { model: FluxModel::Eq1, ..SceneBuilder::new() }.pencil_return(0).flux / 8.0
    );
}

#[test]
fn a_black_screen_is_visible_and_returns_no_flux() {
    for model in [FluxModel::Radiometric, FluxModel::Eq1] {
        let returned = SceneBuilder { reflectivity: 0.0, model, ..SceneBuilder::new() }.pencil_return(0);
        assert!(returned.visible);
        assert_eq!(returned.flux, 0.0);
    }
}

#[test]
fn the_air_attenuates_by_the_length_of_the_path() {
    // Pencil 1 hits (3, 0, 2): R + d = 2 + sqrt 13. The reference is the flux with sigma = 0.
    for sigma in [1e-3, 0.1, 7.0] {
        let lit = SceneBuilder { attenuation: sigma, ..SceneBuilder::new() }.pencil_return(1).flux;
        let share = libm::exp(-sigma * (2.0 + 13f64.sqrt()));
        assert!(close(lit, SceneBuilder::new().pencil_return(1).flux * share, 1e-14 * (1.0 + 10.0 * sigma)));
    }
}

#[test]
fn every_face_has_its_own_reflectivity() {
    use raypencil_scene::{Material, Mesh, Scene};
    // The screen in two halves, split at x = 2 m: pencil 0 hits the left one, pencils 1 and 2 the right one.
    let mut builder = SceneBuilder::new();
    builder.faces = screen(2.0, [-16.0, 2.0], [-16.0, 16.0]).to_vec();
    builder.faces.extend(screen(2.0, [2.0, 16.0], [-16.0, 16.0]));
    let plain = builder.render();
    let scene = builder.scene();
    let kinds = [0.75, 0.5].map(|reflectivity| Material { name: "half".into(), reflectivity });
    let mesh = scene.mesh();
    let mesh = Mesh::new(
        mesh.origin(),
        mesh.vertices().to_vec(),
        mesh.faces().to_vec(),
        vec![0, 0, 1, 1],
        kinds.to_vec(),
    );
    let (camera, beams) = (*scene.camera(), scene.beams().to_vec());
    let two =
        Scene::new(mesh.unwrap().into(), camera, beams, scene.atmosphere(), scene.flux_model()).unwrap();
    let frame = Tracer::new().render(&two, &Request::EVERYTHING);
    for (i, times) in [(0, 3.0), (1, 2.0), (2, 2.0)] {
        let (flux, at_a_quarter) =
            (return_at(&frame.returns[0], i, 0).flux, return_at(&plain.returns[0], i, 0).flux);
        assert!(flux > 0.0 && close(flux, times * at_a_quarter, RELATIVE_TOLERANCE));
    }
}

#[test]
fn the_flux_of_a_pixel_is_the_sum_over_its_pencils() {
    // 64 x 8 pencils on some 48 pixels across and one down: about ten in each.
    let mut builder = SceneBuilder::new();
    (builder.beam.columns, builder.beam.rows) = (64, 8);
    let frame = builder.render();
    let camera = &builder.camera;
    let mut image = vec![0.0; (camera.width * camera.height) as usize];
    for j in 0..8 {
        for i in 0..64 {
            let returned = return_at(&frame.returns[0], i, j);
            let pixel = returned.pixel.unwrap();
            assert!(returned.visible && returned.flux > 0.0);
            image[(pixel.j * camera.width + pixel.i) as usize] += returned.flux;
        }
    }
    assert_eq!(frame.flux[0].cells(), image);
    assert!(image.iter().filter(|&&flux| flux > 0.0).count() < 100);
}

#[test]
fn jittered_rays_are_displaced_by_their_offsets() {
    let mut builder = SceneBuilder::new();
    (builder.beam.columns, builder.beam.rows) = (8, 4);
    let sampling = Sampling::Jittered { seed: 11 };
    let scene = builder.scene();
    let centres = Tracer::new().render(&scene, &Request::EVERYTHING);
    let frame = Tracer::new().render(&scene, &Request { sampling, ..Request::EVERYTHING });
    assert_eq!(frame.camera, centres.camera, "sampling does not concern the camera's own map");
    assert_ne!(frame.beams, centres.beams);
    for j in 0..4 {
        for i in 0..8 {
            // w / g = 9/8, so a cell of one of 8 columns is 9/32 m wide at 2 m; one of 4 rows is T / 4 = 1/1024 m.
            let [dx, dy] = sampling.offset(0, i, j);
            let x = 3.0 + (f64::from(i) + 0.5 - 4.0 + dx) * 9.0 / 16.0;
            let y = (f64::from(j) + 0.5 - 2.0 + dy) / 1024.0;
            let point = frame.beams[0].point.as_ref().unwrap().at(i, j).get().unwrap();
            assert!((point - DVec3::new(x, y, 2.0)).length() < 1e-14, "{point} for ({x}, {y}, 2)");
            // The return belongs to the displaced ray: d^2 = x^2 + y^2 + 4, and its share has its own alpha,
            // tan(alpha) = (x - 3) / 2.
            let returned = return_at(&frame.returns[0], i, j);
            let (cos_phi, slope) = (2.0 / (x * x + y * y + 4.0).sqrt(), (x - 3.0) / 2.0);
            assert!(close(returned.cos_off_axis, cos_phi, RELATIVE_TOLERANCE));
            let power = 3.0 / 32.0 / (1.0 + slope * slope).sqrt();
            let flux = power * 0.25 / 16.0 * cos_phi * cos_phi * cos_phi * cos_phi / 4.0;
            assert!(close(returned.flux, flux, RELATIVE_TOLERANCE));
        }
    }
}

#[test]
fn the_mean_flux_of_jittered_rays_is_that_of_the_central_ray() {
    // One pencil of x / g = +-0.01 runs straight to (1.5, 0, 2). Its jittered points are uniform in +-0.02 m along x.
    // ln(flux) = -2 ln(x^2 + 4) + ... has the slope -4 x / (x^2 + 4) = -0.96 per metre. So one draw has a standard
    // deviation of 0.96 * 0.02 / sqrt 3 = 1.11 %, and the mean of 2000 draws one of 0.0248 %. Tolerance: five of
    // these, plus 0.02^2 / 6 * 2 = 0.013 % for the curvature, which is below 2 per square metre.
    let mut builder = SceneBuilder::new();
    builder.pose = Pose::from_position(DVec3::new(1.5, 0.0, 0.0));
    builder.beam.columns = 1;
    builder.beam.half_width = 0.01 * builder.beam.grid_distance;
    let scene = builder.scene();
    let tracer = Tracer::new();
    let flux = |sampling| {
        let request = Request { camera: false, beams: false, sampling, ..Request::EVERYTHING };
        return_at(&tracer.render(&scene, &request).returns[0], 0, 0).flux
    };
    let centre = flux(Sampling::Centres);
    let draws: Vec<f64> = (0..2000).map(|seed| flux(Sampling::Jittered { seed }) / centre - 1.0).collect();
    let mean = draws.iter().sum::<f64>() / 2000.0;
    let deviation = (draws.iter().map(|draw| draw * draw).sum::<f64>() / 2000.0).sqrt();
    assert!(mean.abs() < 5.0 * 2.48e-4 + 1.3e-4, "mean {mean}");
    assert!((deviation - 0.0111).abs() < 0.001, "standard deviation {deviation}");
}
