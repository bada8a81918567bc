//! Requests: the quantities asked for are rendered, unsupported ones are left out, and the number of threads changes no
//! bit.

use raypencil_scanline::{Scanline, ScanlineOptions, Switches};
use raypencil_scene::{Filter, Lens, Quantities, Renderer, Request, Returns, Sampling};
use raypencil_terrain::{RandomGround, builtin};

use super::rig::{Rig, render, rig_on};

#[test]
fn returns_do_not_depend_on_what_else_is_asked_for() {
    let scene = rig_on(builtin("pyramids", 0.25).unwrap(), 5e-3);
    let all = Scanline::exact().render(&scene, &Request::EVERYTHING);
    assert_eq!((all.returns.len(), all.flux.len(), all.beams.len()), (2, 2, 2));
    let alone = Request { camera: false, beams: false, ..Request::EVERYTHING };
    let alone = Scanline::exact().render(&scene, &alone);
    assert!(alone.camera.is_none() && alone.beams.is_empty());
    assert_eq!((&alone.returns, &alone.flux), (&all.returns, &all.flux));
    let range = Quantities { face: false, ..Quantities::RANGE_MAP };
    let ranges = Scanline::exact().render(&scene, &Request { quantities: range, ..Request::EVERYTHING });
    assert_eq!(ranges.returns, all.returns);
    assert!(ranges.beams.iter().all(|map| map.face.is_none() && map.range.is_some()));
    let maps = Scanline::exact().render(&scene, &Request::MAPS);
    assert!(maps.returns.is_empty() && maps.flux.is_empty());
    assert_eq!(maps.beams, all.beams);
}

#[test]
fn a_quantity_does_not_depend_on_what_else_is_asked_for() {
    let scene = rig_on(builtin("pyramids", 0.25).unwrap(), 5e-3);
    let all = Scanline::exact().render(&scene, &Request::MAPS);
    let none = Quantities::NONE;
    for quantities in [
        Quantities { range: true, ..none },
        Quantities { depth: true, ..none },
        Quantities { face: true, ..none },
        Quantities { point: true, ..none },
        Quantities { normal: true, ..none },
        Quantities { cos_incidence: true, ..none },
    ] {
        let alone = Scanline::exact().render(&scene, &Request { quantities, ..Request::MAPS });
        for (alone, all) in alone.maps().zip(all.maps()) {
            assert!(!quantities.range || alone.range == all.range);
            assert!(!quantities.depth || alone.depth == all.depth);
            assert!(!quantities.face || alone.face == all.face);
            assert!(!quantities.point || alone.point == all.point);
            assert!(!quantities.normal || alone.normal == all.normal);
            assert!(!quantities.cos_incidence || alone.cos_incidence == all.cos_incidence);
        }
    }
}

#[test]
fn jittered_pencils_are_unsupported() {
    let scene = rig_on(builtin("pyramids", 0.25).unwrap(), 5e-3);
    let jittered = Request { sampling: Sampling::Jittered { seed: 1 }, ..Request::EVERYTHING };
    let frame = Scanline::exact().render(&scene, &jittered);
    // Sampling does not concern the camera's own map.
    assert_eq!(frame.camera, Scanline::exact().render(&scene, &Request::MAPS).camera);
    assert_eq!(frame.returns, [Returns::unsupported(256, 4), Returns::unsupported(256, 4)]);
    assert!(frame.flux.is_empty());
    assert_eq!(frame.beams.len(), 2);
    for map in frame.beams {
        assert_eq!((map.width, map.height), (256, 4));
        assert!(map.range.is_none() && map.depth.is_none() && map.face.is_none());
        assert!(map.point.is_none() && map.normal.is_none() && map.cos_incidence.is_none());
    }
    let nothing = Request { beams: false, returns: false, ..jittered };
    let frame = Scanline::exact().render(&scene, &nothing);
    assert!(frame.beams.is_empty() && frame.returns.is_empty());
}

#[test]
fn one_thread_and_two_give_the_same_bits() {
    let on = |threads: usize| rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    let scene = rig_on(RandomGround::nasty(3, 30_000).build(), 0.02);
    for switches in [Switches::EXACT, Switches::PAPER] {
        let options = ScanlineOptions { switches, ..ScanlineOptions::EXACT };
        let [one, two] = [1, 2].map(|threads| on(threads).install(|| render(&scene, options)));
        assert!(one.returns == two.returns && one.flux == two.flux);
    }
}

#[test]
fn cached_tables_are_those_of_the_scene() {
    // One renderer for a series of scenes, each of which differs from the last in one number, against a new renderer for
    // each.
    let caching = Scanline::exact();
    let mut rig = Rig { model: raypencil_scene::FluxModel::Eq1, ..Rig::new() };
    let check = |rig: &Rig| {
        let (cached, new) = (caching.render(&rig.scene(), &Request::EVERYTHING), rig.render());
        assert!(cached.returns == new.returns && cached.flux == new.flux);
        new.returns[0].flux.clone().unwrap().at(3, 0)
    };
    let clear = check(&rig);
    let filter = Filter::Interference { centre: 820e-9, width: 30e-9, index: 2.0 };
    rig.camera.lens = Lens { filter, ..rig.camera.lens };
    let filtered = check(&rig);
    assert!(filtered < clear);
    rig.beams[0].sensor.wavelength = 800e-9;
    assert_ne!(check(&rig), filtered);
    rig.beams.push(rig.beams[0]);
    rig.beams[1].sensor.wavelength = 700e-9;
    rig.beams[1].sensor.power = 9.0;
    check(&rig);
    rig.beams.swap(0, 1);
    check(&rig);
    rig.camera.width = 200;
    check(&rig);
}

#[test]
fn cached_clusters_are_those_of_the_terrain() {
    // One renderer for two grounds in turn.
    let caching = Scanline::exact();
    let scenes = ["pyramids", "facets"].map(|name| rig_on(builtin(name, 0.25).unwrap(), 5e-3));
    for scene in [&scenes[0], &scenes[1], &scenes[0]] {
        let (cached, new) =
            (caching.render(scene, &Request::MAPS), Scanline::exact().render(scene, &Request::MAPS));
        assert!(cached.camera == new.camera && cached.beams == new.beams);
    }
}

#[test]
fn each_beam_has_the_filter_of_its_own_wavelength() {
    // Two beams that differ in their wavelength alone: each has the flux that it has by itself.
    let mut rig = Rig { model: raypencil_scene::FluxModel::Eq1, ..Rig::new() };
    let filter = Filter::Interference { centre: 820e-9, width: 30e-9, index: 2.0 };
    rig.camera.lens = Lens { filter, ..rig.camera.lens };
    rig.beams.push(rig.beams[0]);
    rig.beams[1].sensor.wavelength = 800e-9;
    let both = rig.render();
    for beam in [0, 1] {
        let alone = Rig { beams: vec![rig.beams[beam]], ..rig.clone() };
        assert_eq!(alone.render().returns[0], both.returns[beam], "{beam}");
    }
    assert_ne!(both.returns[0].flux, both.returns[1].flux);
}
