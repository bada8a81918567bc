//! The maps of a scene whose numbers are derived by hand.

use glam::DVec3;
use raypencil_scene::{Renderer, Request};
use raypencil_tracer::Tracer;

use super::common::{SceneBuilder, close, screen};

#[path = "../doc/scene.rs"]
mod scene;

/// Relative tolerance: some 50 roundings of 2^-53 each.
const RELATIVE_TOLERANCE: f64 = 1e-14;

/// The pixels look along x/z = -3/4, 0 and 3/4, the pencil straight down, all from 10 m above the ground.
#[test]
fn depth_and_range_are_those_of_camera_and_beam() {
    let scene = scene::scene_above([[-40.0, -40.0, 0.0], [40.0, -40.0, 0.0], [0.0, 40.0, 0.0]]);
    let frame = Tracer::new().render(&scene, &Request::MAPS);
    let maps = frame.camera.unwrap();
    let (depth, range) = (maps.depth.unwrap(), maps.range.unwrap());
    assert_eq!([0, 1, 2].map(|i| depth.at(i, 0).get()), [Some(10.0); 3]);
    assert_eq!([0, 1, 2].map(|i| range.at(i, 0).get()), [Some(12.5), Some(10.0), Some(12.5)]);
    let maps = &frame.beams[0];
    let of_pencil = [&maps.depth, &maps.range].map(|map| map.as_ref().unwrap().at(0, 0).get());
    assert_eq!(of_pencil, [Some(10.0); 2]);
}

/// Every cell of a camera of many tiles, the last ones of which are cut: what is at (x, y, 2) on the screen.
#[test]
fn each_pixel_has_the_values_of_its_own_ray() {
    let mut builder = SceneBuilder::new();
    (builder.camera.width, builder.camera.height) = (101, 59);
    let maps = builder.render().camera.unwrap();
    let (point, normal) = (maps.point.unwrap(), maps.normal.unwrap());
    let [range, depth, cos] = [maps.range, maps.depth, maps.cos_incidence].map(Option::unwrap);
    for (i, j) in (0..59).flat_map(|j| (0..101).map(move |i| (i, j))) {
        let [across, down] = [(f64::from(i) + 0.5 - 32.25) / 16.0, (f64::from(j) + 0.5 - 32.5) / 16.0];
        let per_depth = (1.0 + across * across + down * down).sqrt();
        assert_eq!(depth.at(i, j).get(), Some(2.0), "{i}, {j}");
        assert!(close(range.at(i, j).get().unwrap(), 2.0 * per_depth, RELATIVE_TOLERANCE), "{i}, {j}");
        assert!(close(cos.at(i, j).get().unwrap(), 1.0 / per_depth, RELATIVE_TOLERANCE), "{i}, {j}");
        assert_eq!(point.at(i, j).get(), Some(DVec3::new(2.0 * across, 2.0 * down, 2.0)), "{i}, {j}");
        assert_eq!(normal.at(i, j).get(), Some(DVec3::NEG_Z), "{i}, {j}");
    }
}

/// Neighbours share a normal only where they share a face: the screen is bent along x = 0.
#[test]
fn each_pixel_has_the_normal_of_its_own_face() {
    let mut builder = SceneBuilder::new();
    let [a, b, c, d] = [[0.0, -99.0, 2.0], [0.0, 99.0, 2.0], [64.0, 99.0, 34.0], [64.0, -99.0, 34.0]];
    builder.faces = screen(2.0, [-16.0, 0.0], [-16.0, 16.0]).to_vec();
    builder = builder.with([[a, b, c], [a, c, d]]);
    let normal = builder.render().camera.unwrap().normal.unwrap();
    // The plane z = 2 + x/2, from in front.
    let bent = DVec3::new(0.5, 0.0, -1.0).normalize();
    // x is 0 at column 31.75.
    for (i, expected) in (0..40).map(|i| (i, if i < 32 { DVec3::NEG_Z } else { bent })) {
        for j in 16..48 {
            let normal = normal.at(i, j).get().unwrap();
            assert!((normal - expected).length() < RELATIVE_TOLERANCE, "{i}, {j}: {normal}");
        }
    }
}
