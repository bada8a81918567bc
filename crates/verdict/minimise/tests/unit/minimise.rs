//! Searches with simple interestingness tests, whose minimum is known.

use std::cell::{Cell, RefCell};
use std::sync::{Arc, Mutex};

use glam::DVec3;
use raypencil_scene::{
    Beam, Filter, FluxModel, Lens, Material, Mesh, Mounted, Place, Pose, Profile, Progress, Scene, SensorId,
    Silent,
};
use raypencil_tests::fixtures::subject;

use crate::nearest_faces::faces_by_distance;
use crate::reducer::Reducer;
use crate::reduction::Reduction;
use crate::short_numbers::shorten_numbers;
use crate::simplest_values::simplify_values;
use crate::{MINIMISE_BUDGET, Minimised, NotInteresting, minimise};

fn search(
    scene: &Scene,
    place: Option<Place>,
    is_interesting: impl Fn(&Scene, Option<Place>) -> bool,
) -> Result<Minimised, NotInteresting> {
    minimise(scene, place, &is_interesting, MINIMISE_BUDGET, &Silent)
}

/// The corners of a scene's faces.
fn triangles(scene: &Scene) -> Vec<[[f32; 3]; 3]> {
    let mesh = scene.mesh();
    mesh.faces().iter().map(|face| face.map(|v| mesh.vertices()[v as usize])).collect()
}

/// A wall of 60 x 40 squares of two faces each.
fn wall() -> Scene {
    let vertices = (0..=40).flat_map(|v| (0..=60).map(move |u| [u as f32, v as f32, 9.0])).collect();
    let squares = (0..40).flat_map(|v| (0..60).map(move |u| v * 61 + u));
    let faces: Vec<[u32; 3]> = squares.flat_map(|a| [[a, a + 61, a + 62], [a, a + 62, a + 1]]).collect();
    let materials = subject().scene.mesh().materials().to_vec();
    let kinds = vec![0; faces.len()];
    let mesh = Mesh::new(DVec3::ZERO, vertices, faces, kinds, materials).unwrap();
    Scene::new(
        Arc::new(mesh),
        *subject().scene.camera(),
        Vec::new(),
        subject().scene.atmosphere(),
        FluxModel::Eq1,
    )
    .unwrap()
}

/// A mesh of these faces, with three vertices each.
fn mesh_of(triangles: &[[[f32; 3]; 3]], kinds: &[u16], reflectivities: &[f64]) -> Arc<Mesh> {
    let named = |(k, &reflectivity): (usize, &f64)| Material { name: format!("kind {k}"), reflectivity };
    let faces = (0..triangles.len() as u32).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
    let materials = reflectivities.iter().enumerate().map(named).collect();
    Arc::new(Mesh::new(DVec3::ZERO, triangles.concat(), faces, kinds.to_vec(), materials).unwrap())
}

/// A small triangle about a place.
fn spot([x, y, z]: [f32; 3]) -> [[f32; 3]; 3] {
    [[x, y, z], [x, y + 0.01, z], [x + 0.01, y, z]]
}

#[test]
fn faces_near_the_line_of_sight_come_before_those_beside_the_ray() {
    // The pencil runs along z from the origin to a wall 10 m ahead, which the camera sees from 10 m to the right.
    let mut reduction =
        Reduction::of(&subject().scene, Some(Place { sensor: SensorId::Beam(0), i: 32, j: 2 }));
    reduction.beams[0].scene_from_sensor = Pose::IDENTITY;
    reduction.camera.scene_from_sensor = Pose::from_position(DVec3::new(10.0, 0.0, 0.0));
    let wall = [[-5.0, -5.0, 10.0], [-5.0, 9.0, 10.0], [9.0, -5.0, 10.0]];
    // Beside the ray at 6 and 3 m; between the wall and the camera; and twice at one place.
    let spots =
        [[-6.0, 0.0, 5.0], [-3.0, 0.0, 5.0], [5.0, 0.0, 5.0], [-4.0, 0.0, 5.0], [-4.0, 0.0, 5.0]].map(spot);
    let triangles = [[spots[0], spots[1], spots[2], spots[3]], [spots[4], wall, spots[2], spots[0]]].concat();
    reduction.mesh = mesh_of(&triangles, &[0; 8], &[0.5]);
    let order = faces_by_distance(&reduction).unwrap();
    // What the pencil meets, what might hide it, then by the distance from the ray; of equals the lower one first.
    assert_eq!(order, [5, 2, 6, 1, 3, 4, 0, 7]);
    // For a pixel nothing but its ray counts.
    reduction.place = Some(Place { sensor: SensorId::Camera, i: 0, j: 0 });
    reduction.camera.sensor.principal_point = [0.5, 0.5];
    reduction.camera.scene_from_sensor = Pose::IDENTITY;
    assert_eq!(faces_by_distance(&reduction).unwrap(), [5, 1, 3, 4, 2, 6, 0, 7]);
}

#[test]
fn a_cell_of_a_grid_gets_a_short_size() {
    // Three columns and five rows: halves and thicknesses of short cells are no short numbers themselves.
    let mut reduction = Reduction::of(&subject().scene, None);
    let beam = &mut reduction.beams[0].sensor;
    (beam.columns, beam.rows, beam.half_width, beam.thickness) = (3, 5, 0.07, 0.0123);
    let is_near = |a: f64, b: f64| (a / b - 1.0).abs() < 0.02;
    let is_interesting = |scene: &Scene, _: Option<Place>| {
        let beam = &scene.beams()[0].sensor;
        is_near(beam.half_width, 0.07) && is_near(beam.thickness, 0.0123)
    };
    let mut reducer = Reducer::begin(reduction, &is_interesting, MINIMISE_BUDGET, &Silent).unwrap();
    shorten_numbers(&mut reducer);
    let beam = reducer.best().beams[0].sensor;
    for cell in [beam.half_width / 3.0, beam.thickness / 5.0] {
        assert!(cell.to_bits().trailing_zeros() >= 52 - 8, "{cell} has more than eight digits");
    }
}

#[test]
fn vertices_are_shortened_one_by_one_while_there_are_few() {
    for (faces, is_shortened) in [(8, true), (9, false)] {
        let mut triangles: Vec<_> = (0..faces).map(|k| spot([0.7, 0.3, 5.0 + k as f32])).collect();
        triangles[0][0][0] = 1.0 / 3.0;
        let mut reduction = Reduction::of(&subject().scene, None);
        reduction.mesh = mesh_of(&triangles, &vec![0; faces], &[0.5]);
        // One vertex must keep all its digits, so that all together cannot be shortened.
        let is_interesting = |scene: &Scene, _: Option<Place>| scene.mesh().vertices()[0][0] == 1.0 / 3.0;
        let mut reducer = Reducer::begin(reduction, &is_interesting, MINIMISE_BUDGET, &Silent).unwrap();
        shorten_numbers(&mut reducer);
        let last = reducer.best().mesh.vertices()[3 * faces - 1];
        assert_eq!(last == [0.0; 3], is_shortened, "{faces} faces: {last:?}");
    }
}

#[test]
fn faces_keep_their_material_when_unused_ones_are_left_out() {
    let mut reduction = Reduction::of(&subject().scene, None);
    let triangles: Vec<_> = (0..4).map(|k| spot([0.0, 0.0, 5.0 + k as f32])).collect();
    reduction.mesh = mesh_of(&triangles, &[3, 1, 3, 4], &[0.1, 0.2, 0.3, 0.4, 0.5]);
    let reflectivities = |mesh: &Mesh| -> Vec<f64> {
        let kinds = mesh.face_materials().iter();
        kinds.map(|kind| mesh.materials()[usize::from(*kind)].reflectivity).collect()
    };
    let is_interesting = |scene: &Scene, _: Option<Place>| {
        // All of one material is another change, which this refuses.
        let found = reflectivities(scene.mesh());
        found == [0.4, 0.2, 0.4, 0.5]
    };
    let mut reducer = Reducer::begin(reduction, &is_interesting, MINIMISE_BUDGET, &Silent).unwrap();
    simplify_values(&mut reducer);
    let mesh = &reducer.best().mesh;
    assert_eq!((mesh.materials().len(), reflectivities(mesh)), (3, vec![0.4, 0.2, 0.4, 0.5]));
}

#[test]
fn a_scene_that_is_not_interesting_is_refused() {
    assert_eq!(search(&subject().scene, None, |_, _| false).unwrap_err(), NotInteresting);
}

#[test]
fn the_faces_that_matter_are_found_wherever_they_are() {
    let scene = wall();
    for wanted in [vec![0], vec![4799], vec![17, 18], vec![3, 1900, 4711]] {
        let corners: Vec<_> = wanted.iter().map(|&face: &usize| triangles(&scene)[face]).collect();
        let is_interesting = |scene: &Scene, _: Option<Place>| {
            let there = triangles(scene);
            corners.iter().all(|face| there.contains(face))
        };
        let Minimised { scene: found, faces_before, faces_after, is_finished, calls, .. } =
            search(&scene, None, is_interesting).unwrap();
        assert_eq!((faces_before, faces_after, is_finished), (4800, wanted.len(), true), "{wanted:?}");
        // In the order of the ground, without unused vertices.
        assert_eq!(triangles(&found), corners);
        assert!(found.mesh().vertices().len() <= 3 * wanted.len());
        // 2 log2(4800) = 25 for one face; each further one adds a few times that.
        assert!(calls < 150 + 150 * wanted.len() as u64, "{wanted:?}: {calls} calls");
    }
}

#[test]
fn where_the_ray_is_known_its_faces_come_first() {
    let scene = wall();
    // The camera's ray meets the wall at (30.2, 20.1): face 2 (20 * 60 + 30) + 1, since 0.2 > 0.1.
    let mut reduction = Reduction::of(&scene, Some(Place { sensor: SensorId::Camera, i: 24, j: 20 }));
    reduction.camera.scene_from_sensor = Pose::from_position(DVec3::new(30.2, 20.1, 0.0));
    reduction.camera.sensor.principal_point = [24.5, 20.5];
    let scene = reduction.scene().unwrap();
    let face = triangles(&scene)[2 * (20 * 60 + 30) + 1];
    let sizes = RefCell::new(Vec::new());
    let is_interesting = |scene: &Scene, _: Option<Place>| {
        sizes.borrow_mut().push(scene.mesh().faces().len());
        triangles(scene).contains(&face)
    };
    let found = search(&scene, reduction.place, is_interesting).unwrap();
    assert_eq!(triangles(&found.scene), [face]);
    // One face is left once faces are removed. The whole ground was tested only while the sensor was cut.
    let sizes = sizes.into_inner();
    assert!(sizes.iter().all(|size| [1, 4800].contains(size)), "{sizes:?}");
}

#[test]
fn if_every_scene_is_interesting_the_simplest_one_is_left() {
    let subject = subject();
    let mut reduction = Reduction::of(&subject.scene, None);
    reduction.atmosphere.attenuation = 0.1;
    reduction.flux_model = FluxModel::Eq1;
    let filter = Filter::Interference { centre: 8e-7, width: 1e-8, index: 2.0 };
    reduction.camera.sensor.lens = Lens { transmission: 0.5, filter };
    let found = search(&reduction.scene().unwrap(), None, |_, _| true).unwrap();
    let (scene, camera) = (&found.scene, found.scene.camera());
    assert_eq!((scene.mesh().faces().len(), scene.mesh().vertices().len(), scene.beams().len()), (1, 3, 0));
    assert_eq!((camera.sensor.width, camera.sensor.height, camera.sensor.lens), (1, 1, Lens::CLEAR));
    assert_eq!((scene.atmosphere().attenuation, scene.flux_model()), (0.0, FluxModel::Radiometric));
    assert_eq!(camera.scene_from_sensor, Pose::IDENTITY);
    assert!(triangles(scene)[0].as_flattened().iter().all(|x| *x == 0.0));
}

#[test]
fn the_budget_is_kept_and_the_result_is_interesting() {
    for budget in [0, 1, 7, 100] {
        let calls = Cell::new(0);
        let is_interesting = |scene: &Scene, _: Option<Place>| {
            calls.set(calls.get() + 1);
            let faces = scene.mesh().faces().len();
            faces.is_multiple_of(2) && faces > 8
        };
        let found = minimise(&wall(), None, &is_interesting, budget, &Silent).unwrap();
        assert_eq!((found.calls, found.is_finished), (calls.get(), false), "{budget}");
        assert!(found.calls <= budget.max(1), "{budget}: {}", found.calls);
        assert!(is_interesting(&found.scene, None));
    }
}

#[test]
fn a_pixel_keeps_exactly_its_ray_when_the_image_shrinks_to_it() {
    let scene = subject().scene;
    let place = Place { sensor: SensorId::Camera, i: 17, j: 23 };
    let ray = scene.ray(place.sensor, place.i, place.j);
    let is_interesting = |scene: &Scene, place: Option<Place>| {
        place.is_some_and(|Place { sensor, i, j }| scene.ray(sensor, i, j) == ray)
    };
    let found = search(&scene, Some(place), is_interesting).unwrap();
    assert!(is_interesting(&found.scene, found.place));
    let camera = &found.scene.camera().sensor;
    // 24 - 17 and 20 - 23.
    assert_eq!((camera.width, camera.height, camera.principal_point), (1, 1, [7.0, -3.0]));
    assert_eq!(found.place, Some(Place { i: 0, j: 0, ..place }));
    assert!(found.scene.beams().is_empty());
}

#[test]
fn a_pencil_keeps_exactly_its_ray_and_its_beam() {
    // The last of three beams; half widths of 1/16 m are exact over 64 columns, 0.0577 m are not.
    let base = subject().scene;
    let Mounted { scene_from_sensor, sensor } = base.beams()[0];
    for (half_width, columns) in [(0.0625, 2), (Beam::half_width_of(0.1, 1.0471975511965976), 64)] {
        let mut reduction = Reduction::of(&base, Some(Place { sensor: SensorId::Beam(2), i: 41, j: 0 }));
        let own = Beam { half_width, thickness: 0.0078125, profile: Profile::UniformAngle, ..sensor };
        reduction.beams = vec![reduction.beams[0]; 2];
        reduction.beams.push(Mounted { scene_from_sensor, sensor: own });
        let scene = reduction.scene().unwrap();
        let ray = scene.ray(SensorId::Beam(2), 41, 0);
        let is_interesting = |scene: &Scene, place: Option<Place>| {
            place.is_some_and(|Place { sensor, i, j }| scene.ray(sensor, i, j) == ray)
        };
        let found = search(&scene, reduction.place, is_interesting).unwrap();
        assert!(is_interesting(&found.scene, found.place), "{:?}", found.place);
        assert_eq!(found.place.map(|place| place.sensor), Some(SensorId::Beam(0)));
        let beam = &found.scene.beams()[0].sensor;
        assert_eq!((beam.columns, beam.rows, beam.profile), (columns, 2, Profile::Paper));
        assert_eq!(found.scene.beams().len(), 1);
    }
}

#[test]
fn the_same_search_gives_the_same_scene() {
    let scene = subject().scene;
    let place = Some(Place { sensor: SensorId::Beam(0), i: 30, j: 2 });
    let is_interesting = |scene: &Scene, place: Option<Place>| {
        let Some(Place { sensor, i, j }) = place else { return false };
        let Some(ray) = scene.ray(sensor, i, j) else { return false };
        ray.direction.x > 0.05 && scene.mesh().faces().len() >= 5
    };
    let [a, b] = [(); 2].map(|()| search(&scene, place, is_interesting).unwrap());
    assert_eq!((a.scene, a.place, a.calls), (b.scene, b.place, b.calls));
    assert_eq!(a.faces_after, 5);
}

#[test]
fn progress_reports_faces_and_trials() {
    struct Heard(Mutex<Vec<String>>);
    impl Progress for Heard {
        fn stage(&self, what: &str) {
            self.0.lock().unwrap().push(what.into());
        }
    }
    let heard = Heard(Mutex::new(Vec::new()));
    minimise(&wall(), None, &|_, _| true, MINIMISE_BUDGET, &heard).unwrap();
    let heard = heard.0.into_inner().unwrap();
    assert!(heard[0].starts_with("minimising, 4800 faces after 1 trials: "), "{heard:?}");
    assert!(heard.iter().any(|what| what.contains(" 1 faces after ") && what.ends_with("shorter numbers")));
}
