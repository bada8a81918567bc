//! The maps of a scene whose numbers are derived by hand.

use raypencil_scene::{Renderer, Request};
use raypencil_tracer::Tracer;

#[path = "../doc/scene.rs"]
mod scene;

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
