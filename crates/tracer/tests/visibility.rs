//! What the camera sees of a pencil's point, and what hides it.

mod common;

use common::{Bench, Corners, back, looking_back, reversed, screen};
use glam::DVec3;
use raypencil_scene::{FaceId, Pose, Renderer, Request, Returns, Sampling};
use raypencil_terrain::{RandomGround, height_at};
use raypencil_tracer::Tracer;

// Pencil 0 runs from (3, 0, 0) to P = (1.5, 0, 2); the camera stands at the origin. At depth z the pencil is at
// x = 3 - 3/4 z, the line of sight at x = 3/4 z.

#[test]
fn a_lid_just_above_the_ground_hides_it() {
    // 0.1 mm above it the pencil is still at x = 1.500075, the line of sight at 1.499925: a lid that ends at 1.5
    // takes one and leaves the other. Either side of it.
    let lid = screen(1.9999, [1.4, 1.5], [-0.1, 0.1]);
    for lid in [lid, reversed(lid)] {
        let bench = Bench::new().with(lid);
        let hidden = bench.back(0);
        assert_eq!(hidden.depth, 2.0);
        assert!(!hidden.visible && hidden.flux == 0.0);
        // It still lands, and its neighbour is seen.
        assert_eq!(hidden.pixel, Bench::new().back(0).pixel);
        assert!(bench.back(1).visible);
        assert_eq!(bench.frame().flux[0].at(44, 32), 0.0);
    }
    // One step of f32 above the ground, 2.4e-7 m; there the line is at x = 1.5 - 9e-8, within the last step before 1.5.
    let lid = screen(2.0_f32.next_down(), [1.4, 1.5], [-0.1, 0.1]);
    assert!(!Bench::new().with(lid).back(0).visible);
    // The same below the ground hides nothing.
    let lid = screen(2.0001, [1.4, 1.6], [-0.1, 0.1]);
    assert!(Bench::new().with(lid).with(reversed(lid)).back(0).visible);
}

#[test]
fn an_edge_that_the_line_of_sight_touches_hides() {
    // At z = 1 the line is at x = 0.75, y = 0: a blade's edge, and another's corner.
    let edge = screen(1.0, [0.75, 1.0], [-1.0, 1.0]);
    let corner = [[[0.75, 0.0, 1.0], [1.0, 0.5, 1.0], [1.0, -0.5, 1.0]]];
    assert!(!Bench::new().with(edge).back(0).visible);
    assert!(!Bench::new().with(corner).back(0).visible);
    assert!(!Bench::new().with(reversed(corner)).back(0).visible);
    // One step of f32 further it does not.
    let beside = screen(1.0, [0.75_f32.next_up(), 1.0], [-1.0, 1.0]);
    assert!(Bench::new().with(beside).back(0).visible);
}

#[test]
fn a_face_parallel_to_the_line_of_sight_does_not_hide() {
    // The plane y = 0 has the line in it.
    let edge_on: Corners = [[0.5, 0.0, 1.0], [1.0, 0.0, 1.5], [1.0, 0.0, 1.0]];
    assert!(Bench::new().with([edge_on]).with(reversed([edge_on])).back(0).visible);
}

#[test]
fn a_face_without_area_does_not_hide() {
    let point = [0.75, 0.0, 1.0];
    let line: Corners = [[0.75, -1.0, 1.0], point, [0.75, 1.0, 1.0]];
    assert!(Bench::new().with([line, [point; 3]]).back(0).visible);
}

#[test]
fn what_stands_between_the_centre_and_the_image_plane_does_not_hide() {
    // f_c = 1/64 m. A blade at half of it does not, one on the image plane does (it is met at the very end).
    let blade = |z| screen(z, [-0.1, 0.1], [-0.1, 0.1]);
    assert!(Bench::new().with(blade(1.0 / 128.0)).back(0).visible);
    assert!(Bench::new().with(blade(f32::next_down(1.0 / 64.0))).back(0).visible);
    assert!(!Bench::new().with(blade(1.0 / 64.0)).back(0).visible);
    // Nor does one behind the camera.
    assert!(Bench::new().with(blade(-1.0)).back(0).visible);
}

#[test]
fn a_blade_before_the_laser_takes_the_light() {
    // The grid plane is at z = 1/4 m; a blade 1 mm beyond it is hit there, one 1 mm before it is not there at all.
    let blade = |z| screen(z, [2.5, 3.5], [-0.1, 0.1]);
    let face = |bench: &Bench| bench.frame().beams[0].face.as_ref().unwrap().at(0, 0).get();
    let bench = Bench::new().with(blade(0.251));
    assert!(face(&bench) >= Some(FaceId(2)));
    assert_eq!(bench.back(0).depth, f64::from(0.251_f32));
    // x = 3 - 3/4 0.251 = 2.81: 16 * 2.81 / 0.251 = 179 pixels to the right is off the image.
    assert_eq!(bench.back(0).pixel, None);
    assert!(!bench.back(0).visible);
    let bench = Bench::new().with(blade(0.249));
    assert!(face(&bench) < Some(FaceId(2)));
    assert!(bench.back(0).visible);
}

#[test]
fn a_camera_behind_the_face_sees_nothing() {
    // The screen turns its front away, to a beam at (1.5, 0, 4) that looks back.
    let mut bench = Bench { pose: looking_back(DVec3::new(1.5, 0.0, 4.0)), ..Bench::new() };
    bench.faces = reversed(screen(2.0, [-16.0, 16.0], [-16.0, 16.0])).to_vec();
    let back = bench.back(1);
    assert_eq!((back.depth, back.cos_view, back.visible, back.flux), (2.0, -0.8, false, 0.0));
    assert!(back.pixel.is_some());
}

#[test]
fn a_camera_in_the_plane_of_the_face_sees_nothing() {
    // The plane 2 x = z goes through the origin, its normal (2, 0, -1) looks to the beam.
    let bench =
        Bench { faces: vec![[[-1.0, -8.0, -2.0], [-1.0, 8.0, -2.0], [8.0, 0.0, 16.0]]], ..Bench::new() };
    // x = 3 - 3/4 z and z = 2 x: x = 1.2.
    let back = bench.back(0);
    assert!((back.depth - 2.4).abs() < 1e-14 && back.pixel.is_some());
    assert_eq!((back.cos_view, back.visible), (0.0, false));
}

#[test]
fn a_point_that_is_not_beyond_the_image_plane_lands_nowhere() {
    let mut bench = Bench::new();
    // Before it and on it: f_c = 2.5 m and 2 m. (Pixels of 1/8 m: 1.5 m fit on the image.)
    bench.camera.pixel_pitch = [1.0 / 16.0; 2];
    for (focal_length, lands) in [(2.5, false), (2.0, false), (1.99, true)] {
        bench.camera.focal_length = focal_length;
        let back = bench.back(0);
        assert_eq!((back.depth, back.pixel.is_some(), back.visible), (2.0, lands, lands));
    }
    // Behind the camera: a beam that looks back at a screen at z = -2, whose front looks along +z. cos(phi) < 0.
    let mut bench = Bench { pose: looking_back(DVec3::new(1.5, 0.0, 0.0)), ..Bench::new() };
    bench.faces = reversed(screen(-2.0, [-16.0, 16.0], [-16.0, 16.0])).to_vec();
    let back = bench.back(1);
    assert_eq!((back.depth, back.cos_off_axis, back.cos_view), (-2.0, -0.8, 0.8));
    assert_eq!((back.pixel, back.visible), (None, false));
}

#[test]
fn a_point_in_the_projection_centre_is_not_seen() {
    // A screen through the camera's centre: pencil 1 of a beam behind it hits the centre itself.
    let mut bench = Bench { pose: Pose::from_position(DVec3::new(0.0, 0.0, -2.0)), ..Bench::new() };
    bench.faces = screen(0.0, [-16.0, 16.0], [-16.0, 16.0]).to_vec();
    let back = bench.back(1);
    assert_eq!((back.depth, back.cos_off_axis, back.cos_view, back.visible), (0.0, 0.0, 0.0, false));
}

#[test]
fn faces_in_the_plane_of_the_one_that_is_hit_do_not_hide() {
    // A plane at a depth that is no binary number, covered by triangles of sizes that are none either, three deep
    // and of both senses, and lit aslant: t differs among them by rounding, so that the point comes to lie before
    // some and behind others. (Which one is hit may change, by rounding; what is seen does not.)
    let mut bench = Bench::new();
    (bench.beam.columns, bench.beam.rows) = (256, 4);
    let position = DVec3::new(3.0, 0.1, 0.0);
    bench.pose = Pose { position, ..Pose::from_axis_angle(DVec3::new(0.6, 0.8, 0.0), -0.3) };
    bench.faces = screen(2.3, [-16.1, 15.7], [-15.3, 16.9]).to_vec();
    let plain = bench.frame();
    for k in 0..40 {
        let x = -2.0 + 0.213 * k as f32;
        bench = bench.with(screen(2.3, [x, x + 0.619], [-1.7 - 0.1 * x, 2.331 + x.abs()]));
        bench = bench.with(reversed(screen(2.3, [x - 0.107, x + 0.713], [-1.37, 2.111])));
    }
    let (covered, plain) = (&bench.frame().returns[0], &plain.returns[0]);
    assert_eq!((&covered.visible, &covered.pixel), (&plain.visible, &plain.pixel));
    assert!(plain.visible.as_ref().unwrap().cells().iter().all(|&visible| visible));
}

#[test]
fn duplicates_in_either_sense_do_not_hide() {
    // Every face of a random ground once more, its corners turned about, and once more reversed: not a bit of the
    // returns changes.
    let mesh = RandomGround::plain(3, 3000, 24.0).build().into_mesh().unwrap();
    let z = height_at(&mesh, 0.0, 0.0).unwrap();
    let corners = mesh.faces().iter().map(|face| face.map(|v| mesh.vertices()[v as usize]));
    // Seen from above: x right, y (north) up is -y down, and z down.
    let view = |[x, y, height]: [f32; 3]| [x, -y, 4.0 + z as f32 - height];
    let faces: Vec<Corners> = corners.map(|corners| corners.map(view)).collect();
    let turned = faces.iter().map(|&[a, b, c]| [b, c, a]);
    let reversed = faces.iter().map(|&[a, b, c]| [c, b, a]);
    let mut bench = Bench { faces: faces.clone(), ..Bench::new() };
    (bench.beam.columns, bench.beam.rows) = (512, 8);
    let frame = bench.frame();
    let seen = |returns: &Returns| {
        returns.visible.as_ref().unwrap().cells().iter().filter(|visible| **visible).count()
    };
    assert!(seen(&frame.returns[0]) > 3000, "{} seen", seen(&frame.returns[0]));
    assert_eq!(bench.with(turned).with(reversed).frame().returns, frame.returns);
}

#[test]
fn returns_are_served_without_maps_and_maps_without_returns() {
    let scene = Bench::new().scene();
    let render = |request: Request| Tracer::new().render(&scene, &request);
    let all = render(Request::EVERYTHING);
    let returns = render(Request { camera: false, beams: false, ..Request::EVERYTHING });
    assert!(returns.camera.is_none() && returns.beams.is_empty());
    assert_eq!((&returns.returns, &returns.flux), (&all.returns, &all.flux));
    let maps = render(Request::MAPS);
    assert!(maps.returns.is_empty() && maps.flux.is_empty());
    assert_eq!((&maps.camera, &maps.beams), (&all.camera, &all.beams));
    let names: Vec<&str> = all.stages.iter().map(|stage| stage.name.as_str()).collect();
    assert_eq!(names, ["hierarchy", "camera", "beam-0", "beam-0 returns"]);
}

#[test]
fn a_pencil_that_hits_nothing_returns_nothing() {
    let bench = Bench { faces: screen(2.0, [1.0, 2.0], [-1.0, 1.0]).to_vec(), ..Bench::new() };
    let frame = bench.frame();
    assert!(back(&frame.returns[0], 0, 0).visible);
    let returns = &frame.returns[0];
    assert_eq!(returns.depth.as_ref().unwrap().at(1, 0).get(), None);
    assert_eq!(returns.pixel.as_ref().unwrap().at(1, 0).get(), None);
    assert!(!returns.visible.as_ref().unwrap().at(1, 0));
    assert_eq!(returns.flux.as_ref().unwrap().at(1, 0), 0.0);
}

#[test]
fn threads_do_not_change_a_bit() {
    let mut bench = Bench::new();
    bench.faces = screen(2.3, [-16.1, 15.7], [-15.3, 16.9]).to_vec();
    for k in 0..30 {
        let (x, z) = (0.11 * k as f32, 1.1 + 0.03 * k as f32);
        bench = bench.with(screen(z, [x, x + 0.05], [-1.0, 1.0]));
    }
    (bench.beam.columns, bench.beam.rows) = (700, 9);
    let scene = bench.scene();
    for sampling in [Sampling::Centres, Sampling::Jittered { seed: 2 }] {
        let bits = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            let request = Request { sampling, ..Request::EVERYTHING };
            let frame = pool.install(|| Tracer::new().render(&scene, &request));
            let of_pencils = frame.returns[0].flux.as_ref().unwrap().cells().iter();
            let flux: Vec<u64> = of_pencils.chain(frame.flux[0].cells()).map(|flux| flux.to_bits()).collect();
            (frame.beams, frame.returns, flux)
        };
        assert!(bits(1) == bits(2));
        let visible = bits(1).1[0].visible.clone().unwrap();
        assert!(visible.cells().contains(&true) && visible.cells().contains(&false));
    }
}
