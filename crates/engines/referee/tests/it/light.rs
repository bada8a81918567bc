//! The camera's view of a pencil and its flux: closed forms derived by hand, and what hides a point.

use std::f64::consts::{FRAC_PI_4, LN_2};
use std::sync::Arc;

use glam::DVec3;
use raypencil_referee::{Displacement, ExactRenderer, Format, Referee, Ruling, Tolerance};
use raypencil_scene::{
    Atmosphere, Beam, Camera, FaceId, Filter, FluxModel, Lens, Material, Mesh, Mounted, Pixel, Pose, Profile,
    Renderer, Request, Return, Sampling, Scene,
};

/// One pencil that starts at the scene's origin, runs along z and hits a wall at z = 2 m; a camera 1 m to its right
/// that also looks along z. The point (0, 0, 2) is at (-1, 0, 2) from the camera: r = 2, d = sqrt 5, cos(phi) = 2 /
/// sqrt 5.
struct Setting {
    faces: Vec<[[f32; 3]; 3]>,
    reflectivity: f64,
    profile: Profile,
    model: FluxModel,
    attenuation: f64,
    lens: Lens,
}

/// The plane z = 2, its front towards the origin.
const WALL: [[f32; 3]; 3] = [[-8.0, -8.0, 2.0], [-8.0, 8.0, 2.0], [16.0, 0.0, 2.0]];

impl Setting {
    fn of(model: FluxModel) -> Self {
        Self {
            faces: vec![WALL],
            reflectivity: 0.5,
            profile: Profile::Paper,
            model,
            attenuation: 0.0,
            lens: Lens::CLEAR,
        }
    }

    fn scene(&self) -> Scene {
        let vertices = self.faces.iter().flatten().copied().collect();
        let count = self.faces.len();
        let faces = (0..count as u32).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
        let materials = vec![Material { name: "ground".into(), reflectivity: self.reflectivity }];
        let mesh = Mesh::new(DVec3::ZERO, vertices, faces, vec![0; count], materials).expect("a mesh");
        // 64 x 64 pixels of 1/64 f: x / z from -1/2 to 1/2. The point lands at x / z = -1/2, on the left border of
        // column 0; y / z = 0 is the upper border of row 32.
        let camera = Camera {
            width: 64,
            height: 64,
            pixel_pitch: [1.0 / 8192.0; 2],
            focal_length: 1.0 / 128.0,
            principal_point: [32.0; 2],
            aperture: 1.0 / 512.0,
            lens: self.lens,
            max_range: 20.0,
        };
        let beam = Beam {
            columns: 1,
            rows: 1,
            thickness: 0.005,
            grid_distance: 0.1,
            half_width: 0.05,
            max_range: 20.0,
            power: 4.0,
            wavelength: 810e-9,
            profile: self.profile,
        };
        let at = |x: f64| Pose::from_position(DVec3::new(x, 0.0, 0.0));
        Scene::new(
            Arc::new(mesh),
            Mounted { scene_from_sensor: at(1.0), sensor: camera },
            vec![Mounted { scene_from_sensor: at(0.0), sensor: beam }],
            Atmosphere { attenuation: self.attenuation },
            self.model,
        )
        .expect("a scene")
    }

    fn returned(&self) -> Return {
        let scene = self.scene();
        let referee = Referee::new(&scene);
        let light = referee.light(0, Sampling::Centres).expect("a beam");
        let back = light.returned(0, 0).expect("the wall is hit");
        back.in_format(Format::Double, self.model)
    }
}

fn close(found: f64, derived: f64) {
    // The result is rounded once, the derivation here a dozen times.
    assert!((found / derived - 1.0).abs() <= 12.0 * f64::EPSILON, "{found:e}, derived {derived:e}");
}

#[test]
fn one_pencil_on_a_wall_by_hand() {
    // cos(theta) = cos(phi) = 2 / sqrt 5, r = 2, P = 4 W (one pencil, cos(alpha) = 1), r_d = 1/2.
    let back = Setting::of(FluxModel::Radiometric).returned();
    assert!(back.visible);
    assert_eq!(back.pixel, Some(Pixel { i: 0, j: 32 }));
    assert_eq!(back.depth, 2.0);
    let cosine = 2.0 / 5.0_f64.sqrt();
    close(back.cos_off_axis, cosine);
    close(back.cos_view, cosine);
    // I = P r_d (D^2 / 4) cos(theta) cos^3(phi) / r^2 = 4 (1/2) (2^-18 / 4) (16/25) / 4 = 2^-21 16/25.
    assert_eq!(back.flux, 16.0 / 25.0 / f64::from(1 << 21));
    // Equation (1): phi of the centre of pixel (0, 32): x = -31.5/64, y = 1/128, so tan^2 = (63^2 + 1) / 128^2
    // = 3970 / 16384 and cos^2 = 16384 / 20354.
    let back = Setting::of(FluxModel::Eq1).returned();
    let cos_squared = 16384.0 / 20354.0;
    // P r_d (pi/4) (D/f)^2 A_cp cos^4(phi) cos(theta) / (R r^2), (D/f)^2 = 1/16, A_cp = 2^-26, R r^2 = 8, cos(psi) = 1.
    let derived = 2.0 * FRAC_PI_4 / 16.0 / f64::from(1 << 26) * cos_squared * cos_squared * cosine / 8.0;
    close(back.flux, derived);
}

#[test]
fn air_filter_and_lens_take_their_shares() {
    let mut setting = Setting::of(FluxModel::Radiometric);
    let clear = setting.returned().flux;
    setting.attenuation = 0.25;
    // exp(-sigma (R + d)), R = 2, d = sqrt 5; equation (1) has r = 2 for d.
    close(setting.returned().flux, clear * libm::exp(-0.25 * (2.0 + 5.0_f64.sqrt())));
    setting.attenuation = 0.0;
    setting.lens = Lens {
        transmission: 0.75,
        filter: Filter::Interference { centre: 820e-9, width: 20e-9, index: 2.0 },
    };
    // sin^2(phi) = 1/5: the centre moves to 820 sqrt(1 - 1/20) nm.
    let relative = (810e-9 - 820e-9 * 0.95_f64.sqrt()) / 20e-9;
    let loss = libm::exp(-4.0 * LN_2 * relative * relative);
    // Cancellation: 810 - 799 nm loses two digits.
    assert!((setting.returned().flux / (clear * 0.75 * loss) - 1.0).abs() < 1e-13);
    setting.reflectivity = 0.0;
    assert_eq!(setting.returned().flux, 0.0);
}

#[test]
fn what_meets_the_segment_hides_the_point() {
    let visible = |faces: &[[[f32; 3]; 3]]| {
        let setting = Setting { faces: [&[WALL], faces].concat(), ..Setting::of(FluxModel::Radiometric) };
        let scene = setting.scene();
        let referee = Referee::new(&scene);
        let sight = referee.visibility(0, 0, 0, Displacement::ZERO).expect("the wall is hit");
        assert_eq!(sight.visible, sight.hidden_by.is_none());
        sight.visible
    };
    assert!(visible(&[]));
    // Duplicates of the wall, facing either way, contain the point and do not hide it.
    assert!(visible(&[WALL, [WALL[0], WALL[2], WALL[1]]]));
    // The segment passes (1/2, 0, 1). A plate there hides the point, whichever line it faces, also if only its corner
    // or its edge is touched; a plate beside it does not.
    let plate = |x: f32| [[x, 0.0, 1.0], [x + 0.25, 0.25, 1.0], [x + 0.25, -0.25, 1.0]];
    for (face, seen) in
        [(plate(0.4375), false), (plate(0.5), false), (plate(0.53125), true), (plate(0.1875), true)]
    {
        assert_eq!(visible(&[face]), seen, "{face:?}");
        assert_eq!(visible(&[[face[0], face[2], face[1]]]), seen, "{face:?} turned");
    }
    // In the plane that holds the segment: parallel, so it does not count.
    assert!(visible(&[[[0.25, 0.0, 1.0], [0.75, 0.0, 1.0], [0.5, 0.0, 0.5]]]));
    // A face on the image plane itself, z = 1/128, where the segment ends: u = f / r counts. Before it none does.
    let screen = |z: f32| [[0.9375, -0.0625, z], [0.9375, 0.0625, z], [1.0625, 0.0, z]];
    assert!(!visible(&[screen(1.0 / 128.0)]));
    assert!(visible(&[screen(1.0 / 256.0)]));
}

#[test]
fn the_renderer_adds_up_its_returns() {
    let mut setting = Setting::of(FluxModel::Radiometric);
    setting.profile = Profile::UniformAngle;
    let scene = setting.scene();
    for sampling in [Sampling::Centres, Sampling::Jittered { seed: 5 }] {
        let frame = ExactRenderer.render(&scene, &Request { sampling, ..Request::EVERYTHING });
        let flux = frame.returns[0].flux.as_ref().unwrap().at(0, 0);
        let total: f64 = frame.flux[0].cells().iter().sum();
        // With jitter the point may land left of the image. Then it is not seen.
        let visible = frame.returns[0].visible.as_ref().unwrap().at(0, 0);
        assert_eq!(total, flux);
        assert_eq!(visible, flux > 0.0);
    }
}

#[test]
fn a_plane_met_from_behind_is_seen_where_it_is() {
    // The wall is turned round, so it is never hit. The point on its plane is the same, and the camera is behind the
    // plane.
    let mut setting = Setting::of(FluxModel::Radiometric);
    setting.faces = vec![[WALL[0], WALL[2], WALL[1]]];
    let scene = setting.scene();
    let referee = Referee::new(&scene);
    let light = referee.light(0, Sampling::Centres).expect("a beam");
    assert_eq!(light.returned(0, 0), None);
    let pixel = Some(Pixel { i: 0, j: 32 });
    let back = light.returned_as(0, 0, FaceId(0), false, pixel).expect("a plane");
    let back = back.in_format(Format::Double, FluxModel::Radiometric);
    let cosine = 2.0 / 5.0_f64.sqrt();
    assert_eq!((back.depth, back.flux), (2.0, 0.0));
    close(back.cos_off_axis, cosine);
    close(back.cos_view, -cosine);
}

#[test]
fn a_beam_narrower_than_its_pencils_has_shares_all_the_same() {
    // No pencil lies within hundreds of half widths of the middle: every weight alone underflows, even at 2^-1074.
    // The pencils nearest the middle share the light, and the others get none.
    let flux = |profile: Profile| -> Vec<f64> {
        let setting = Setting { profile, ..Setting::of(FluxModel::Radiometric) };
        let scene = setting.scene();
        let mut beams = scene.beams().to_vec();
        (beams[0].sensor.columns, beams[0].sensor.rows) = (4, 2);
        let (mesh, air) = (Arc::clone(scene.mesh()), scene.atmosphere());
        let scene = Scene::new(mesh, *scene.camera(), beams, air, scene.flux_model()).expect("a scene");
        let referee = Referee::new(&scene);
        let light = referee.certified_returns(0, Sampling::Centres).expect("a beam");
        assert_eq!(light.undecided(), 0);
        light.returns.iter().map(|back| back.expect("a hit").radiometric.expect("decided").double).collect()
    };
    let (narrow, even) = (flux(Profile::Gaussian { half_width: 1e-6 }), flux(Profile::UniformAngle));
    // tan(alpha) is 1/8 and 3/8. A quarter goes to each of the four near pencils; of cos^2(alpha), 64/65 of the sum
    // 4 (64/65 + 64/73) does.
    let ratio = 0.25 / (64.0 / 65.0 / (4.0 * (64.0 / 65.0 + 64.0 / 73.0)));
    let mut seen = 0;
    for (index, (narrow, even)) in narrow.into_iter().zip(even).enumerate() {
        if matches!(index % 4, 1 | 2) {
            assert!((narrow - ratio * even).abs() <= 1e-15 * narrow, "{index}: {narrow:e}, {even:e}");
            seen += usize::from(narrow > 0.0);
        } else {
            assert_eq!(narrow, 0.0, "{index}");
        }
    }
    assert!(seen > 0);
}

#[test]
fn there_is_no_view_of_what_is_no_pencil() {
    let scene = Setting::of(FluxModel::Radiometric).scene();
    let referee = Referee::new(&scene);
    let by = |dx: f64, dy: f64| Displacement { dx, dy };
    assert!(referee.visibility(0, 0, 0, by(0.25, -0.5)).is_some());
    assert_eq!(referee.visibility(1, 0, 0, Displacement::ZERO), None);
    assert_eq!(referee.visibility(0, 1, 0, Displacement::ZERO), None);
    assert_eq!(referee.visibility(0, 0, 1, Displacement::ZERO), None);
    for wild in [by(f64::NAN, 0.0), by(0.0, f64::NAN), by(f64::INFINITY, 0.0), by(0.0, f64::NEG_INFINITY)] {
        assert_eq!(referee.visibility(0, 0, 0, wild), None);
    }
}

/// The point lands exactly on the upper border of row 32 and on the left border of column 0, which is that of the
/// image. An error of its position moves the image by that over the depth, and by more where the line is oblique: x /
/// z = -1/2.
#[test]
fn a_landing_is_excused_as_far_as_the_position_explains_it() {
    let scene = Setting::of(FluxModel::Radiometric).scene();
    let referee = Referee::new(&scene);
    let rule = |pixel: Option<Pixel>, position: f64| {
        let tolerance = Tolerance { lateral: 0.0, depth: 0.0, position, unit_roundoff: 0.0 };
        let ruling = referee.rule_visibility(0, 0, 0, Displacement::ZERO, FaceId(0), true, pixel, tolerance);
        ruling.expect("a pencil").pixel
    };
    let at = |i: u32, j: u32| Some(Pixel { i, j });
    assert_eq!(rule(at(0, 32), 0.0), Ruling::Exact);
    // Rounding alone: the row above, or beside the image.
    for position in [0.0, 1e-9] {
        assert!(matches!(rule(at(0, 31), position), Ruling::Rounding(_)), "{position}");
        assert!(matches!(rule(None, position), Ruling::Rounding(_)), "{position}");
        for wrong in [at(1, 32), at(0, 30), at(0, 33), at(63, 32), at(0, 0)] {
            assert_eq!(rule(wrong, position), Ruling::Wrong, "{wrong:?} {position}");
        }
    }
    // 1/32 m is a pixel at depth 2: across 3/2 of the line of 1/40 m are 1.2 pixels, down 0.8.
    let position = 1.0 / 40.0;
    for near in [at(1, 32), at(0, 31), None] {
        assert!(matches!(rule(near, position), Ruling::Rounding(_)), "{near:?}");
    }
    for far in [at(2, 32), at(0, 33), at(0, 30)] {
        assert_eq!(rule(far, position), Ruling::Wrong, "{far:?}");
    }
    // Past the image there is no pixel, however near.
    assert_eq!(rule(at(64, 32), 10.0), Ruling::Wrong);
    assert_eq!(rule(at(0, 64), 10.0), Ruling::Wrong);
}

/// Pencils of a beam in the camera's own place that land exactly on borders between pixels. n columns span x / z from
/// -1 to 1 and n pixels span f, so pencil i lands 2 i + 1 - n pixels from the principal point. In f64 the quotients
/// come out on either side.
#[test]
fn a_landing_on_a_border_is_in_the_pixel_that_begins_there() {
    for n in (3..200_u32).step_by(2) {
        let mut scene = Setting::of(FluxModel::Radiometric).scene();
        let (mut camera, mut beam) = (*scene.camera(), scene.beams()[0]);
        camera.scene_from_sensor = beam.scene_from_sensor;
        camera.sensor.width = 2 * n + 2;
        camera.sensor.pixel_pitch = [1.0 / 8192.0; 2];
        camera.sensor.focal_length = f64::from(n) / 8192.0;
        camera.sensor.principal_point = [f64::from(n), 32.0];
        beam.sensor.columns = n;
        (beam.sensor.half_width, beam.sensor.grid_distance) = (0.1, 0.1);
        let (mesh, air, model) = (Arc::clone(scene.mesh()), scene.atmosphere(), scene.flux_model());
        scene = Scene::new(mesh, camera, vec![beam], air, model).expect("a scene");
        let referee = Referee::new(&scene);
        for i in 0..n {
            let Some(sight) = referee.visibility(0, i, 0, Displacement::ZERO) else { continue };
            assert_eq!(sight.pixel, Some(Pixel { i: 2 * i + 1, j: 32 }), "pencil {i} of {n}");
        }
    }
}

/// A renderer knows a plane no better than its normal: n.(p - a) is off by up to (5 kappa + 6) u |n| S. Up to there it may take
/// the point, or the camera, to be on either side of a face between them.
#[test]
fn a_face_is_told_from_the_point_as_well_as_its_plane_is_known() {
    let kappa = 2.0_f64.sqrt();
    // Legs of 3 m: kappa = 3 (3 sqrt 2) / 9. The camera is 1 m from the scene's origin and sqrt 5 m from the point.
    let per_roundoff = (5.0 * kappa + 6.0) * (1.0 + 5.0_f64.sqrt() + 3.0 * 2.0_f64.sqrt());
    let rule_with = |occluder: [[f32; 3]; 3], depth: f64, unit_roundoff: f64| {
        let scene = Setting { faces: vec![WALL, occluder], ..Setting::of(FluxModel::Radiometric) }.scene();
        let referee = Referee::new(&scene);
        let exact = referee.visibility(0, 0, 0, Displacement::ZERO).expect("a pencil");
        assert_eq!((exact.visible, exact.pixel), (false, Some(Pixel { i: 0, j: 32 })));
        let tolerance = Tolerance { lateral: 0.0, depth, position: 0.0, unit_roundoff };
        let pixel = exact.pixel;
        let ruling = referee.rule_visibility(0, 0, 0, Displacement::ZERO, FaceId(0), true, pixel, tolerance);
        ruling.expect("a pencil").visible
    };
    let rule = |occluder, unit_roundoff| rule_with(occluder, 0.0, unit_roundoff);
    let off = 1.0 / 128.0;
    // That far before the wall, its back to the pencil.
    let z = 2.0 - off as f32;
    let lid = [[-1.0, -1.0, z], [2.0, -1.0, z], [-1.0, 2.0, z]];
    // That far beside the camera, 1 m from the point. It crosses the way at z = 2 off, which must be beyond the lens: 1/128 m.
    let x = 1.0 - off as f32;
    let screen = [[x, -1.0, -1.0], [x, -1.0, 2.0], [x, 2.0, -1.0]];
    // It is told from the place where the way crosses the image plane, too, which is half as near: 1/128 m on a way that falls 2 m
    // for each metre aside.
    for (occluder, off) in [(lid, off), (screen, 0.5 * off)] {
        assert_eq!(rule(occluder, 0.0), Ruling::Wrong);
        assert_eq!(rule(occluder, 0.99 * off / per_roundoff), Ruling::Wrong);
        assert_eq!(rule(occluder, 1.01 * off / per_roundoff), Ruling::Rounding(Displacement::ZERO));
    }
    // An error of the point comes on top, but is none of the camera.
    assert_eq!(rule_with(lid, 1.01 * off, 0.0), Ruling::Rounding(Displacement::ZERO));
    assert_eq!(rule_with(screen, 1.01 * off, 0.0), Ruling::Wrong);
}

/// The way from the wall at (0, 0, 2) to the camera at (1, 0, 0) passes (1/2, 0, 1). An edge beside it there may seem to be on the other
/// side as far as the hit's error shows across the way: at half of it, half of the error times the sine between pencil and way.
#[test]
fn an_edge_beside_the_way_may_seem_to_be_on_it() {
    let plate = |y: f32, to: f32| [[0.25, y, 1.0], [0.75, y, 1.0], [0.5, to, 1.0]];
    let rule_with = |occluders: &[[[f32; 3]; 3]], depth: f64, visible: bool| {
        let faces = [&[WALL][..], occluders].concat();
        let scene = Setting { faces, ..Setting::of(FluxModel::Radiometric) }.scene();
        let tolerance = Tolerance { lateral: 0.0, depth, position: 0.0, unit_roundoff: 0.0 };
        let pixel = Some(Pixel { i: 0, j: 32 });
        let ruling = Referee::new(&scene).rule_visibility(
            0,
            0,
            0,
            Displacement::ZERO,
            FaceId(0),
            visible,
            pixel,
            tolerance,
        );
        ruling.expect("a pencil").visible
    };
    let off = 1.0 / 64.0;
    // The error of which the edge's distance is all that shows.
    let error = 2.0 * 5.0_f64.sqrt() * off;
    let excused = Ruling::Rounding(Displacement::ZERO);
    for (share, expected) in [(0.9, excused), (1.1, Ruling::Wrong)] {
        // Beside the plate the point is seen, behind its margin it is not.
        let beside = plate(off as f32, 0.25);
        assert_eq!(rule_with(&[beside], error / share, true), Ruling::Exact);
        assert_eq!(rule_with(&[beside], error / share, false), expected, "{share}");
        let around = plate(off as f32, -0.25);
        assert_eq!(rule_with(&[around], error / share, false), Ruling::Exact);
        assert_eq!(rule_with(&[around], error / share, true), expected, "{share}");
    }
    // Two plates that share the edge: past the one the way meets the other.
    let near = off as f32;
    let [left, right] = [plate(near, 0.25), plate(near, -0.25)];
    assert_eq!(rule_with(&[right], 1.1 * error, true), excused);
    assert_eq!(rule_with(&[left, right], 1.1 * error, true), Ruling::Wrong);
}
