//! Visibility of the pencils' points for the camera, and the faces that hide them.

use super::common;

use common::{Corners, SceneBuilder, looking_back, return_at, reversed, screen};
use glam::DVec3;
use raypencil_scene::{FaceId, Pose, Renderer, Request, Returns, Sampling};
use raypencil_terrain::{RandomGround, height_at};
use raypencil_tracer::Tracer;

// Pencil 0 runs from (3, 0, 0) to P = (1.5, 0, 2); the camera stands at the origin. At depth z the pencil is at
// x = 3 - 3/4 z, the line of sight at x = 3/4 z.

#[test]
fn a_lid_just_above_the_ground_hides_it() {
    // 0.1 mm above the ground the pencil is at x = 1.500075 and the line of sight at x = 1.499925. A lid that ends at
    // x = 1.5 blocks the second and not the first. It does so with either side.
    let lid = screen(1.9999, [1.4, 1.5], [-0.1, 0.1]);
    for lid in [lid, reversed(lid)] {
        let builder = SceneBuilder::new().with(lid);
        let hidden = builder.pencil_return(0);
        assert_eq!(hidden.depth, 2.0);
        assert!(!hidden.visible && hidden.flux == 0.0);
        // It still has its pixel, and its neighbour is visible.
        assert_eq!(hidden.pixel, SceneBuilder::new().pencil_return(0).pixel);
        assert!(builder.pencil_return(1).visible);
        assert_eq!(builder.render().flux[0].at(44, 32), 0.0);
    }
    // One f32 step above the ground, 2.4e-7 m. There the line is at x = 1.5 - 9e-8, within the last step before 1.5.
    let lid = screen(2.0_f32.next_down(), [1.4, 1.5], [-0.1, 0.1]);
    assert!(!SceneBuilder::new().with(lid).pencil_return(0).visible);
    // The same below the ground hides nothing.
    let lid = screen(2.0001, [1.4, 1.6], [-0.1, 0.1]);
    assert!(SceneBuilder::new().with(lid).with(reversed(lid)).pencil_return(0).visible);
}

#[test]
fn an_edge_that_the_line_of_sight_touches_hides() {
    // At z = 1 the line is at x = 0.75, y = 0: a blade's edge, and another's corner.
    let edge = screen(1.0, [0.75, 1.0], [-1.0, 1.0]);
    let corner = [[[0.75, 0.0, 1.0], [1.0, 0.5, 1.0], [1.0, -0.5, 1.0]]];
    assert!(!SceneBuilder::new().with(edge).pencil_return(0).visible);
    assert!(!SceneBuilder::new().with(corner).pencil_return(0).visible);
    assert!(!SceneBuilder::new().with(reversed(corner)).pencil_return(0).visible);
    // One f32 step to the side it does not.
    let beside = screen(1.0, [0.75_f32.next_up(), 1.0], [-1.0, 1.0]);
    assert!(SceneBuilder::new().with(beside).pencil_return(0).visible);
}

#[test]
fn a_face_parallel_to_the_line_of_sight_does_not_hide() {
    // The face is in the plane y = 0, which contains the line of sight.
    let edge_on: Corners = [[0.5, 0.0, 1.0], [1.0, 0.0, 1.5], [1.0, 0.0, 1.0]];
    assert!(SceneBuilder::new().with([edge_on]).with(reversed([edge_on])).pencil_return(0).visible);
}

#[test]
fn a_face_without_area_does_not_hide() {
    let point = [0.75, 0.0, 1.0];
    let line: Corners = [[0.75, -1.0, 1.0], point, [0.75, 1.0, 1.0]];
    assert!(SceneBuilder::new().with([line, [point; 3]]).pencil_return(0).visible);
}

#[test]
fn a_face_between_the_centre_and_the_image_plane_does_not_hide() {
    // f_c = 1/64 m. A blade at half of it does not hide; one on the image plane does: it touches the segment's end.
    let blade = |z| screen(z, [-0.1, 0.1], [-0.1, 0.1]);
    assert!(SceneBuilder::new().with(blade(1.0 / 128.0)).pencil_return(0).visible);
    assert!(SceneBuilder::new().with(blade(f32::next_down(1.0 / 64.0))).pencil_return(0).visible);
    assert!(!SceneBuilder::new().with(blade(1.0 / 64.0)).pencil_return(0).visible);
    // Nor does one behind the camera.
    assert!(SceneBuilder::new().with(blade(-1.0)).pencil_return(0).visible);
}

#[test]
fn a_blade_blocks_the_laser_from_the_grid_plane_on() {
    // The grid plane is at z = 1/4 m. A blade 1 mm beyond it is hit; for one 1 mm before it there is no hit.
    let blade = |z| screen(z, [2.5, 3.5], [-0.1, 0.1]);
    let face = |builder: &SceneBuilder| builder.render().beams[0].face.as_ref().unwrap().at(0, 0).get();
    let builder = SceneBuilder::new().with(blade(0.251));
    assert!(face(&builder) >= Some(FaceId(2)));
    assert_eq!(builder.pencil_return(0).depth, f64::from(0.251_f32));
    // x = 3 - 3/4 0.251 = 2.81: 16 * 2.81 / 0.251 = 179 pixels to the right is off the image.
    assert_eq!(builder.pencil_return(0).pixel, None);
    assert!(!builder.pencil_return(0).visible);
    let builder = SceneBuilder::new().with(blade(0.249));
    assert!(face(&builder) < Some(FaceId(2)));
    assert!(builder.pencil_return(0).visible);
}

#[test]
fn a_camera_behind_the_face_sees_nothing() {
    // The front of the screen looks away from the camera, towards a beam at (1.5, 0, 4) that looks back.
    let mut builder = SceneBuilder { pose: looking_back(DVec3::new(1.5, 0.0, 4.0)), ..SceneBuilder::new() };
    builder.faces = reversed(screen(2.0, [-16.0, 16.0], [-16.0, 16.0])).to_vec();
    let returned = builder.pencil_return(1);
    assert_eq!((returned.depth, returned.cos_view, returned.visible, returned.flux), (2.0, -0.8, false, 0.0));
    assert!(returned.pixel.is_some());
}

#[test]
fn a_camera_in_the_plane_of_the_face_sees_nothing() {
    // The plane 2 x = z contains the origin. Its normal (2, 0, -1) points towards the beam.
    let builder = SceneBuilder {
        faces: vec![[[-1.0, -8.0, -2.0], [-1.0, 8.0, -2.0], [8.0, 0.0, 16.0]]],
        ..SceneBuilder::new()
    };
    // x = 3 - 3/4 z and z = 2 x: x = 1.2.
    let returned = builder.pencil_return(0);
    assert!((returned.depth - 2.4).abs() < 1e-14 && returned.pixel.is_some());
    assert_eq!((returned.cos_view, returned.visible), (0.0, false));
}

#[test]
fn a_point_that_is_not_beyond_the_image_plane_has_no_pixel() {
    let mut builder = SceneBuilder::new();
    // Before it and on it: f_c = 2.5 m and 2 m. The pixels are 1/16 m wide, so x = 1.5 m is on the image.
    builder.camera.pixel_pitch = [1.0 / 16.0; 2];
    for (focal_length, is_beyond) in [(2.5, false), (2.0, false), (1.99, true)] {
        builder.camera.focal_length = focal_length;
        let returned = builder.pencil_return(0);
        assert_eq!((returned.depth, returned.pixel.is_some(), returned.visible), (2.0, is_beyond, is_beyond));
    }
    // Behind the camera: a beam looks back at a screen at z = -2, whose front looks along +z. cos(phi) < 0.
    let mut builder = SceneBuilder { pose: looking_back(DVec3::new(1.5, 0.0, 0.0)), ..SceneBuilder::new() };
    builder.faces = reversed(screen(-2.0, [-16.0, 16.0], [-16.0, 16.0])).to_vec();
    let returned = builder.pencil_return(1);
    assert_eq!((returned.depth, returned.cos_off_axis, returned.cos_view), (-2.0, -0.8, 0.8));
    assert_eq!((returned.pixel, returned.visible), (None, false));
}

#[test]
fn a_point_in_the_projection_centre_is_not_visible() {
    // A screen through the projection centre. Pencil 1 of a beam behind the camera hits the centre itself.
    let mut builder =
        SceneBuilder { pose: Pose::from_position(DVec3::new(0.0, 0.0, -2.0)), ..SceneBuilder::new() };
    builder.faces = screen(0.0, [-16.0, 16.0], [-16.0, 16.0]).to_vec();
    let returned = builder.pencil_return(1);
    assert_eq!(
        (returned.depth, returned.cos_off_axis, returned.cos_view, returned.visible),
        (0.0, 0.0, 0.0, false)
    );
}

#[test]
fn faces_in_the_plane_of_the_hit_face_do_not_hide() {
    // A plane at a depth that is not dyadic, covered three deep by triangles of sizes that are not dyadic either, of
    // both orientations, and lit aslant. Their t differ by rounding, so the point lies before some of them and behind
    // others. (Rounding may change which one is hit. It does not change what is visible.)
    let mut builder = SceneBuilder::new();
    (builder.beam.columns, builder.beam.rows) = (256, 4);
    let position = DVec3::new(3.0, 0.1, 0.0);
    builder.pose = Pose { position, ..Pose::from_axis_angle(DVec3::new(0.6, 0.8, 0.0), -0.3) };
    builder.faces = screen(2.3, [-16.1, 15.7], [-15.3, 16.9]).to_vec();
    let plain = builder.render();
    for k in 0..40 {
        let x = -2.0 + 0.213 * k as f32;
        builder = builder.with(screen(2.3, [x, x + 0.619], [-1.7 - 0.1 * x, 2.331 + x.abs()]));
        builder = builder.with(reversed(screen(2.3, [x - 0.107, x + 0.713], [-1.37, 2.111])));
    }
    let (covered, plain) = (&builder.render().returns[0], &plain.returns[0]);
    assert_eq!((&covered.visible, &covered.pixel), (&plain.visible, &plain.pixel));
    assert!(plain.visible.as_ref().unwrap().cells().iter().all(|&visible| visible));
}

#[test]
fn duplicates_of_either_orientation_do_not_hide() {
    // Every face of a random ground once more with its vertices cycled, and once more reversed: not a bit of the
    // returns changes.
    let mesh = RandomGround::plain(3, 3000, 24.0).build().into_mesh().unwrap();
    let z = height_at(&mesh, 0.0, 0.0).unwrap();
    let corners = mesh.faces().iter().map(|face| face.map(|v| mesh.vertices()[v as usize]));
    // Seen from above: x right, y down (south), z down.
    let from_above = |[x, y, height]: [f32; 3]| [x, -y, 4.0 + z as f32 - height];
    let faces: Vec<Corners> = corners.map(|corners| corners.map(from_above)).collect();
    let cycled = faces.iter().map(|&[a, b, c]| [b, c, a]);
    let reversed = faces.iter().map(|&[a, b, c]| [c, b, a]);
    let mut builder = SceneBuilder { faces: faces.clone(), ..SceneBuilder::new() };
    (builder.beam.columns, builder.beam.rows) = (512, 8);
    let frame = builder.render();
    let visible_count = |returns: &Returns| {
        returns.visible.as_ref().unwrap().cells().iter().filter(|visible| **visible).count()
    };
    let count = visible_count(&frame.returns[0]);
    assert!(count > 3000, "{count} visible");
    assert_eq!(builder.with(cycled).with(reversed).render().returns, frame.returns);
}

#[test]
fn returns_are_rendered_without_maps_and_maps_without_returns() {
    let scene = SceneBuilder::new().scene();
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
    let builder =
        SceneBuilder { faces: screen(2.0, [1.0, 2.0], [-1.0, 1.0]).to_vec(), ..SceneBuilder::new() };
    let frame = builder.render();
    assert!(return_at(&frame.returns[0], 0, 0).visible);
    let returns = &frame.returns[0];
    assert_eq!(returns.depth.as_ref().unwrap().at(1, 0).get(), None);
    assert_eq!(returns.pixel.as_ref().unwrap().at(1, 0).get(), None);
    assert!(!returns.visible.as_ref().unwrap().at(1, 0));
    assert_eq!(returns.flux.as_ref().unwrap().at(1, 0), 0.0);
}

#[test]
fn the_number_of_threads_changes_no_bit() {
    let mut builder = SceneBuilder::new();
    builder.faces = screen(2.3, [-16.1, 15.7], [-15.3, 16.9]).to_vec();
    for k in 0..30 {
        let (x, z) = (0.11 * k as f32, 1.1 + 0.03 * k as f32);
        builder = builder.with(screen(z, [x, x + 0.05], [-1.0, 1.0]));
    }
    (builder.beam.columns, builder.beam.rows) = (700, 9);
    let scene = builder.scene();
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
