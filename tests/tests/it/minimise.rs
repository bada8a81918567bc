//! Minimisation with complete renderers: injected faults and ties, from grounds of thousands of faces to the few that
//! matter.

use std::sync::Arc;

use glam::DVec3;
use raypencil::harness::{
    Contender, Reproducer, contender, first_interesting_ray, is_interesting_in_class, typed_contenders,
    write_reproducer,
};
use raypencil::io::{Overrides, load};
use raypencil::judge::{Class, JudgeShare};
use raypencil::minimise::{MINIMISE_BUDGET, Minimised, NotInteresting, minimise};
use raypencil::terrain::RandomGround;
use raypencil::{FaceId, Mesh, Place, Precision, RenderOutput, Renderer, Request, Scene, SensorId, Silent};
use raypencil_tests::injected_faults::detection::shows_fault;
use raypencil_tests::injected_faults::geometry::{lattice, ridge, small_rig};
use raypencil_tests::naive::{Fault, Naive};

/// Rough ground of at least 2,000 faces, with slivers, walls and overhangs, before the small rig.
fn rough() -> Scene {
    let mesh = RandomGround::nasty(2, 2100).build().into_mesh().expect("a mesh");
    assert!(mesh.faces().len() >= 2000, "{}", mesh.faces().len());
    small_rig(Arc::new(mesh), DVec3::ZERO, 0.3, 1.0)
}

/// The first ray of a class between two renderers.
fn first_place(contenders: [&Contender; 2], scene: &Scene, class: Class) -> Option<Place> {
    first_interesting_ray(contenders, scene, class, JudgeShare::All).map(|first| first.place)
}

fn tracer() -> Contender {
    contender("tracer").expect("a renderer of this house")
}

fn faulty(fault: Fault) -> Contender {
    Naive { fault: Some(fault) }.into()
}

#[test]
fn a_fault_on_two_thousand_faces_shrinks_to_those_that_matter() {
    let scene = rough();
    // A wrong range needs one face that is hit; a wrong choice between faces needs two.
    for (fault, faces) in [(Fault::DepthForRange, 1), (Fault::FarthestWins, 2), (Fault::ViewCosineOmitted, 1)]
    {
        let contenders = [tracer(), faulty(fault)];
        let [a, b] = &contenders;
        let place = first_place([a, b], &scene, Class::Defect);
        assert!(place.is_some(), "{fault:?} shows somewhere");
        let shows = shows_fault(fault);
        let found = minimise(&scene, place, &shows, MINIMISE_BUDGET, &Silent).expect("it shows");
        assert_eq!((found.faces_after, found.is_finished), (faces, true), "{fault:?}");
        assert!(found.scene.mesh().vertices().len() <= 3 * faces, "{fault:?}");
        assert!(shows(&found.scene, found.place), "{fault:?}");
    }
}

#[test]
fn without_a_place_any_ray_will_do() {
    let scene = lattice();
    let [a, b] = [tracer(), faulty(Fault::EdgesExcluded)];
    let shows = is_interesting_in_class([&a, &b], Class::Defect);
    let found = minimise(&scene, None, &shows, MINIMISE_BUDGET, &Silent).expect("it shows");
    // An inner edge has two faces. A miss at the border is rounding.
    assert_eq!((found.faces_before, found.faces_after), (32, 2));
    assert_eq!(found.place, None);
    let camera = &found.scene.camera().sensor;
    assert_eq!(u64::from(camera.width) * u64::from(camera.height), 1);
    assert!(found.scene.beams().is_empty());
}

#[test]
fn a_tie_needs_two_faces() {
    // One renderer reports the last of two faces, the tracer the first. Neither is a defect.
    let scene = ridge();
    let [a, b] = [tracer(), Contender::from(LastOfTies)];
    let place = first_place([&a, &b], &scene, Class::Tie);
    let shows = is_interesting_in_class([&a, &b], Class::Tie);
    let found = minimise(&scene, place, &shows, MINIMISE_BUDGET, &Silent).expect("it shows");
    assert_eq!((found.faces_before, found.faces_after), (4, 2));
}

/// The tracer on the mesh with its faces in reverse order: among faces met at the same point the last one wins.
struct LastOfTies;

impl Renderer for LastOfTies {
    fn name(&self) -> &str {
        "last-of-ties"
    }

    fn precision(&self) -> Precision {
        Precision::F64
    }

    fn render(&self, scene: &Scene, request: &Request) -> RenderOutput {
        let mesh = scene.mesh();
        let count = mesh.faces().len() as u32;
        let reversed = mesh.faces().iter().rev().copied().collect();
        let kinds = mesh.face_materials().iter().rev().copied().collect();
        let materials = mesh.materials().to_vec();
        let vertices = mesh.vertices().to_vec();
        let mesh = Mesh::new(mesh.origin(), vertices, reversed, kinds, materials).unwrap();
        let (camera, beams) = (*scene.camera(), scene.beams().to_vec());
        let other =
            Scene::new(Arc::new(mesh), camera, beams, scene.atmosphere(), scene.flux_model()).unwrap();
        let mut output = tracer().renderer.render(&other, request);
        let maps = output.camera.iter_mut().chain(&mut output.beams);
        for faces in maps.filter_map(|map| map.face.as_mut()) {
            for face in faces.cells_mut() {
                *face = face.get().map(|face| FaceId(count - 1 - face.0)).into();
            }
        }
        output
    }
}

#[test]
fn renderers_that_agree_show_nothing() {
    let scene = rough();
    let [a, b] = [tracer(), contender("scanline").expect("a renderer of this house")];
    let place = Some(Place { sensor: SensorId::Beam(0), i: 40, j: 1 });
    let refused = minimise(&scene, place, &is_interesting_in_class([&a, &b], Class::Defect), 100, &Silent);
    assert_eq!(refused.unwrap_err(), NotInteresting);
}

#[test]
fn the_papers_errors_are_minimised_by_their_cause() {
    let scene = rough();
    let [a, b] = [contender("scanline-paper").expect("a renderer of this house"), tracer()];
    let place = first_place([&a, &b], &scene, Class::Approximation);
    assert!(place.is_some(), "the paper errs somewhere");
    let shows = is_interesting_in_class([&a, &b], Class::Approximation);
    let found = minimise(&scene, place, &shows, MINIMISE_BUDGET, &Silent).expect("it shows");
    assert!(found.faces_after <= 3, "{} faces", found.faces_after);
}

#[test]
fn a_written_reproducer_shows_the_fault_and_is_deterministic() {
    let scene = rough();
    let fault = Fault::FarthestWins;
    let [a, b] = [tracer(), faulty(fault)];
    let place = first_place([&a, &b], &scene, Class::Defect);
    let shows = shows_fault(fault);
    let search = || minimise(&scene, place, &shows, MINIMISE_BUDGET, &Silent).expect("it shows");
    let [once, twice]: [Minimised; 2] = [search(), search()];
    assert_eq!((&once.scene, once.place, once.calls), (&twice.scene, twice.place, twice.calls));

    let folder = tempfile::tempdir().expect("a folder");
    let files = [&once, &twice].map(|found| {
        let reproducer = Reproducer {
            name: "farthest",
            what: "The farthest face wins.",
            with: &typed_contenders(&[&a, &b]),
        };
        let files = write_reproducer(folder.path(), found, reproducer).expect("files");
        files.map(|file| std::fs::read(file).expect("a file"))
    });
    assert_eq!(files[0], files[1]);
    let words = String::from_utf8(files[0][2].clone()).expect("a text");
    let Place { i, j, .. } = once.place.expect("a place");
    for line in [
        "# farthest".to_string(),
        "raypencil validate farthest.toml --with tracer,naive --judge all".into(),
        format!("raypencil probe farthest.toml --with tracer,naive --beam 0 --pencil {i},{j}"),
        format!("2 faces of {} are left. If one is left out, it does not show any more.", once.faces_before),
    ] {
        assert!(words.lines().any(|found| found == line), "{line}\n{words}");
    }
    let file = folder.path().join("farthest.toml");
    let loaded = load(&file.to_string_lossy(), &Overrides::default()).expect("the scene").scene;
    assert_eq!(loaded, once.scene);
    assert!(shows(&loaded, once.place));
}
