//! The ranges of backs against those of the fronts of the same terrain turned over.

use std::sync::Arc;

use glam::DVec3;
use raypencil_scanline::Scanline;
use raypencil_scene::{Atmosphere, FluxModel, Mesh, Renderer, Request, Scene, rig};
use raypencil_terrain::RandomGround;

#[test]
fn backs_are_the_fronts_of_a_terrain_that_is_turned_over() {
    let mut backs_met = 0;
    for seed in 0..4 {
        let mesh = RandomGround::nasty(seed, 3000).build().into_mesh().expect("a valid ground");
        let faces = mesh.faces().iter().map(|&[a, b, c]| [a, c, b]).collect();
        let (vertices, kinds) = (mesh.vertices().to_vec(), mesh.face_materials().to_vec());
        let turned =
            Mesh::new(mesh.origin(), vertices, faces, kinds, mesh.materials().to_vec()).expect("as before");
        // From below the ground and from above it.
        for height in [-3.0, 2.0] {
            let scene = |mesh: Mesh| {
                let (camera, beams) = rig::default_rig(8, DVec3::new(1.0, 2.0, height), 0.3);
                let air = Atmosphere { attenuation: 0.0 };
                Scene::new(Arc::new(mesh), camera, beams, air, FluxModel::Radiometric).expect("a valid scene")
            };
            let frame = Scanline::exact().render(&scene(turned.clone()), &Request::MAPS);
            let backs = Scanline::exact().ranges_of_backs(&scene(mesh.clone()));
            assert_eq!(backs.len(), 3);
            for (expected, found) in frame.maps().zip(&backs) {
                assert_eq!(found.sensor, expected.sensor);
                let [expected, found] =
                    [expected, found].map(|map| map.range.as_ref().expect("a range map").cells());
                assert_eq!(expected, found, "seed {seed}, {height} m");
                backs_met += found.iter().filter(|range| range.get().is_some()).count();
            }
        }
    }
    assert!(backs_met > 1000, "{backs_met}");
}
