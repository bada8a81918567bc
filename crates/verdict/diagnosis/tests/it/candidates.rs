//! Candidates made from the exact answers, each with a mistake. Nothing here is shared with the code under test.

use std::sync::{Arc, OnceLock};

use glam::DVec3;
use raypencil_diagnosis::{Diagnosis, Reason};
use raypencil_files::Storage;
use raypencil_judge::{GroundTruth, Item, Quantity, Recorded, check};
use raypencil_referee::ExactRenderer;
use raypencil_scene::{
    Atmosphere, Camera, FaceId, FluxModel, Image, Lens, Material, Maybe, Mesh, Mounted, Pose, Precision,
    Renderer, Request, Sample, Scene, SensorId, Silent, rig,
};
use raypencil_terrain::builtin;

/// A scene, its exact answers, and the recording that has them all.
pub struct Bench {
    pub scene: &'static Scene,
    pub truth: GroundTruth<'static>,
    pub exact: Recorded,
}

impl Bench {
    /// A scene with its exact answers.
    pub fn of(scene: Scene) -> Self {
        let scene: &'static Scene = Box::leak(Box::new(scene));
        let output = ExactRenderer.render(scene, &Request::EVERYTHING);
        let mut exact = Recorded::of_output("exact", scene, &output, Precision::F64);
        let truth = GroundTruth::certified(scene, &Silent);
        // A renderer's output has no flux by the other model; a recording may.
        exact.answers = truth.answers().clone();
        for beam in 0..scene.beams().len() {
            let image = Item { is_other_model: true, ..Item::of_image(beam) };
            let pencils = Item { is_other_model: true, ..Quantity::PencilFlux.into() };
            exact.storage.insert((SensorId::Camera, image), Storage::F64);
            exact.storage.insert((SensorId::Beam(beam), pencils), Storage::F64);
        }
        Self { scene, truth, exact }
    }

    /// Why a candidate is wrong.
    pub fn diagnosis(&self, candidate: &Recorded) -> Option<Diagnosis> {
        let found = check(&self.truth, candidate, &Silent);
        raypencil_diagnosis::diagnose(&self.truth, candidate, &found)
    }

    /// The keys of the mistakes that explain a candidate in all its sensors, and the share of wrong rays that agree then.
    /// Of several reasons, or a reason beside sensors without one, the words.
    #[track_caller]
    pub fn explanation(&self, candidate: &Recorded) -> Option<(Vec<&'static str>, f64)> {
        let diagnosis = self.diagnosis(candidate)?;
        let [reason] = diagnosis.reasons.as_slice() else { panic!("{}", diagnosis.sentence()) };
        assert!(diagnosis.unexplained.is_empty(), "{}", diagnosis.sentence());
        Some((reason.mistakes.iter().map(|one| one.key()).collect(), reason.share()))
    }

    /// The reasons, each as sensors and keys: `camera, beam 1: rows_reversed`.
    pub fn reasons(&self, candidate: &Recorded) -> Vec<String> {
        let one = |reason: &Reason| {
            let sensors: Vec<String> = reason.sensors.iter().map(ToString::to_string).collect();
            let keys: Vec<&str> = reason.mistakes.iter().map(|one| one.key()).collect();
            format!("{}: {}", sensors.join(", "), keys.join(" + "))
        };
        self.diagnosis(candidate).map_or(Vec::new(), |found| found.reasons.iter().map(one).collect())
    }
}

/// The pyramids through a small camera and two small beams, in air that attenuates: 48 x 36 pixels, 2 x 48 x 4 pencils.
pub fn pyramids() -> &'static Bench {
    static BENCH: OnceLock<Bench> = OnceLock::new();
    BENCH.get_or_init(|| pyramids_with_pencils(48, 36, 48, 4))
}

/// The same, quicker to judge: 40 x 32 pixels, 2 x 32 x 4 pencils.
pub fn few_pyramids() -> &'static Bench {
    static BENCH: OnceLock<Bench> = OnceLock::new();
    BENCH.get_or_init(|| pyramids_with_pencils(40, 32, 32, 4))
}

/// The pyramids through a camera of another size.
pub fn pyramids_of(width: u32, height: u32) -> Bench {
    pyramids_with_pencils(width, height, 64, 4)
}

/// The same with beams of so many pencils.
pub fn pyramids_with_pencils(width: u32, height: u32, columns: u32, rows: u32) -> Bench {
    let mesh = builtin("pyramids", 0.25).unwrap().into_mesh().unwrap();
    let (mut camera, mut beams) = rig::default_rig(16, DVec3::ZERO, 0.0);
    // The same view in fewer pixels.
    let pitch = camera.sensor.pixel_pitch.map(|pitch| pitch * 72.0 / f64::from(width.max(1)));
    camera.sensor = Camera {
        width,
        height,
        pixel_pitch: if width == height { camera.sensor.pixel_pitch } else { pitch },
        principal_point: [0.5 * f64::from(width), 0.5 * f64::from(height)],
        ..camera.sensor
    };
    beams.iter_mut().for_each(|beam| (beam.sensor.columns, beam.sensor.rows) = (columns, rows));
    let air = Atmosphere { attenuation: 0.05 };
    Bench::of(Scene::new(Arc::new(mesh), camera, beams, air, FluxModel::Radiometric).unwrap())
}

/// Walls before one camera at the origin, which looks along z from behind an image plane at 2 m: a slanted one from 20
/// to 60 m, a maximum range of 40 m, the back of a wall at 7 to 9 m on the left, and a panel at 1.4 to 1.7 m on
/// the right.
pub fn walls() -> &'static Bench {
    static BENCH: OnceLock<Bench> = OnceLock::new();
    BENCH.get_or_init(|| walls_at(DVec3::ZERO))
}

/// The walls in a scene frame that starts at `origin`.
pub fn walls_at(origin: DVec3) -> Bench {
    // Corners in the order that turns the front to the camera: the normal is (0, 0, -1) or nearly so.
    let corners = [
        [-90.0, -90.0, 20.0],
        [90.0, -90.0, 30.0],
        [90.0, 90.0, 60.0],
        [-90.0, 90.0, 50.0],
        [-8.0, -9.0, 7.0],
        [-2.0, -9.0, 7.0],
        [-2.0, 9.0, 9.0],
        [-8.0, 9.0, 9.0],
        [0.6, -2.0, 1.4],
        [1.4, -2.0, 1.4],
        [1.4, 2.0, 1.7],
        [0.6, 2.0, 1.7],
    ];
    let front = |a: u32| [[a, a + 2, a + 1], [a, a + 3, a + 2]];
    let back = |a: u32| [[a, a + 1, a + 2], [a, a + 2, a + 3]];
    let faces = [front(0), back(4), front(8)].concat();
    let plaster = Material { name: "plaster".into(), reflectivity: 0.5 };
    let materials = vec![0; faces.len()];
    let mesh = Mesh::new(origin, corners.to_vec(), faces, materials, vec![plaster]).unwrap();
    let camera = Camera {
        width: 64,
        height: 48,
        pixel_pitch: [0.0625; 2],
        focal_length: 2.0,
        principal_point: [32.0, 24.0],
        aperture: 0.01,
        lens: Lens::CLEAR,
        max_range: 40.0,
    };
    let camera = Mounted { scene_from_sensor: Pose::IDENTITY, sensor: camera };
    let air = Atmosphere { attenuation: 0.0 };
    Bench::of(Scene::new(Arc::new(mesh), camera, vec![], air, FluxModel::Radiometric).unwrap())
}

/// Two walls that face a camera of 32 x 24 pixels, which looks along z: on the left one at 5 m, on the right one at 20 m.
pub fn two_walls() -> Bench {
    let wall =
        |left: f32, right: f32, z: f32| [[left, -9.0, z], [right, -9.0, z], [right, 9.0, z], [left, 9.0, z]];
    let corners = [wall(-9.0, 0.0, 5.0), wall(0.0, 9.0, 20.0)].concat();
    let front = |a: u32| [[a, a + 2, a + 1], [a, a + 3, a + 2]];
    let faces = [front(0), front(4)].concat();
    let plaster = Material { name: "plaster".into(), reflectivity: 0.5 };
    let mesh = Mesh::new(DVec3::ZERO, corners, faces, vec![0; 4], vec![plaster]).unwrap();
    let camera = Mounted { scene_from_sensor: Pose::IDENTITY, sensor: rig::camera(32, 24, 0.03125, 1.0) };
    let air = Atmosphere { attenuation: 0.0 };
    Bench::of(Scene::new(Arc::new(mesh), camera, vec![], air, FluxModel::Radiometric).unwrap())
}

/// One wall of these slopes that fills the view of a camera of 32 x 24 pixels, which looks along z.
pub fn one_wall([across, down]: [f32; 2]) -> Bench {
    let at = |x: f32, y: f32| [x, y, 8.0 + across * x + down * y];
    let corners = vec![at(-15.0, -15.0), at(15.0, -15.0), at(15.0, 15.0), at(-15.0, 15.0)];
    let plaster = Material { name: "plaster".into(), reflectivity: 0.5 };
    let faces = vec![[0, 2, 1], [0, 3, 2]];
    let mesh = Mesh::new(DVec3::ZERO, corners, faces, vec![0; 2], vec![plaster]).unwrap();
    let camera = Mounted { scene_from_sensor: Pose::IDENTITY, sensor: rig::camera(32, 24, 0.03125, 1.0) };
    let air = Atmosphere { attenuation: 0.0 };
    Bench::of(Scene::new(Arc::new(mesh), camera, vec![], air, FluxModel::Radiometric).unwrap())
}

/// The camera's answers of some quantities alone.
pub fn only(exact: &Recorded, quantities: &[Quantity]) -> Recorded {
    only_of(exact, SensorId::Camera, quantities)
}

/// A candidate that gives these quantities of one sensor alone.
pub fn only_of(exact: &Recorded, sensor: SensorId, quantities: &[Quantity]) -> Recorded {
    let mut candidate = exact.clone();
    candidate.storage.retain(|(own, item), _| {
        *own == sensor && item.beam.is_none() && quantities.contains(&item.quantity)
    });
    for map in &mut candidate.answers.maps {
        let is_own = map.sensor == sensor;
        let has = |quantity: Quantity| is_own && quantities.contains(&quantity);
        map.face = map.face.take().filter(|_| has(Quantity::Face));
        map.range = map.range.take().filter(|_| has(Quantity::Range));
        map.depth = map.depth.take().filter(|_| has(Quantity::Depth));
        map.point = map.point.take().filter(|_| has(Quantity::Point));
        map.normal = map.normal.take().filter(|_| has(Quantity::Normal));
        map.cos_incidence = map.cos_incidence.take().filter(|_| has(Quantity::CosIncidence));
    }
    for light in &mut candidate.answers.light {
        light.image = None;
        light.other_image = None;
        light.other_flux = None;
        let (columns, rows) = (light.returns.columns, light.returns.rows);
        light.returns = raypencil_scene::Returns::unsupported(columns, rows);
    }
    candidate
}

/// The candidate as a program stores it in single precision.
pub fn stored_single(candidate: &Recorded) -> Recorded {
    let mut stored = candidate.clone();
    for storage in stored.storage.values_mut().filter(|storage| **storage == Storage::F64) {
        *storage = Storage::F32;
    }
    let single = |x: f64| f64::from(x as f32);
    numbers(&mut stored, |_, x| single(x));
    points(&mut stored, |_, p| DVec3::from_array(p.to_array().map(single)));
    normals(&mut stored, |_, p| DVec3::from_array(p.to_array().map(single)));
    for light in &mut stored.answers.light {
        let images =
            [&mut light.image, &mut light.other_image, &mut light.other_flux, &mut light.returns.flux];
        for image in images.into_iter().flatten() {
            image.cells_mut().iter_mut().for_each(|flux| *flux = single(*flux));
        }
    }
    stored
}

/// Moves the cells of all channels: cell (i, j) gets what stood in `from(width, height, i, j)`.
pub fn moved(candidate: &mut Recorded, from: impl Fn(u32, u32, u32, u32) -> (u32, u32)) {
    fn one<T: Copy>(image: &mut Option<Image<T>>, from: &impl Fn(u32, u32, u32, u32) -> (u32, u32)) {
        if let Some(image) = image {
            let old = image.clone();
            let (width, height) = (old.width(), old.height());
            for j in 0..height {
                for i in 0..width {
                    let (a, b) = from(width, height, i, j);
                    image.set(i, j, old.at(a, b));
                }
            }
        }
    }
    for map in &mut candidate.answers.maps {
        one(&mut map.face, &from);
        one(&mut map.range, &from);
        one(&mut map.depth, &from);
        one(&mut map.point, &from);
        one(&mut map.normal, &from);
        one(&mut map.cos_incidence, &from);
    }
    for light in &mut candidate.answers.light {
        one(&mut light.image, &from);
        one(&mut light.other_image, &from);
        one(&mut light.other_flux, &from);
        one(&mut light.returns.visible, &from);
        one(&mut light.returns.pixel, &from);
        one(&mut light.returns.depth, &from);
        one(&mut light.returns.cos_off_axis, &from);
        one(&mut light.returns.cos_view, &from);
        one(&mut light.returns.flux, &from);
    }
}

/// Which number of a hit or of a return.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Number {
    Range,
    Depth,
    Incidence,
    View,
    OffAxis,
    Emission,
}

fn each<T: Sample>(image: &mut Option<Image<Maybe<T>>>, mut change: impl FnMut(usize, T) -> T) {
    for (index, cell) in image.iter_mut().flat_map(|image| image.cells_mut()).enumerate() {
        *cell = Maybe::from(cell.get().map(|value| change(index, value)));
    }
}

/// Changes all numbers except flux.
pub fn numbers(candidate: &mut Recorded, mut change: impl FnMut(Number, f64) -> f64) {
    for map in &mut candidate.answers.maps {
        each(&mut map.range, |_, x| change(Number::Range, x));
        each(&mut map.depth, |_, x| change(Number::Depth, x));
        each(&mut map.cos_incidence, |_, x| change(Number::Incidence, x));
    }
    for light in &mut candidate.answers.light {
        each(&mut light.returns.depth, |_, x| change(Number::View, x));
        each(&mut light.returns.cos_off_axis, |_, x| change(Number::OffAxis, x));
        each(&mut light.returns.cos_view, |_, x| change(Number::Emission, x));
    }
}

/// Changes all points.
pub fn points(candidate: &mut Recorded, mut change: impl FnMut(usize, DVec3) -> DVec3) {
    candidate.answers.maps.iter_mut().for_each(|map| each(&mut map.point, &mut change));
}

/// Changes all normals.
pub fn normals(candidate: &mut Recorded, mut change: impl FnMut(usize, DVec3) -> DVec3) {
    candidate.answers.maps.iter_mut().for_each(|map| each(&mut map.normal, &mut change));
}

/// Changes all faces.
pub fn faces(candidate: &mut Recorded, mut change: impl FnMut(u32) -> u32) {
    candidate.answers.maps.iter_mut().for_each(|map| each(&mut map.face, |_, face| FaceId(change(face.0))));
}

/// Changes the ranges, each by the index of its cell.
pub fn ranges(candidate: &mut Recorded, mut change: impl FnMut(usize, f64) -> f64) {
    candidate.answers.maps.iter_mut().for_each(|map| each(&mut map.range, &mut change));
}

/// Changes all flux by the scene's model.
pub fn flux(candidate: &mut Recorded, change: impl Fn(f64) -> f64) {
    for light in &mut candidate.answers.light {
        for image in [&mut light.image, &mut light.returns.flux].into_iter().flatten() {
            image.cells_mut().iter_mut().for_each(|flux| *flux = change(*flux));
        }
    }
}

/// Writes a number where nothing is hit.
pub fn missed(candidate: &mut Recorded, number: f64) {
    for map in &mut candidate.answers.maps {
        for image in [&mut map.range, &mut map.depth].into_iter().flatten() {
            for cell in image.cells_mut() {
                *cell = Maybe::some(cell.get().unwrap_or(number));
            }
        }
    }
}

/// A small face 2 m before the middle of each of 8 x 8 pixels: rays through other places of the cells meet nothing.
pub fn dots() -> Bench {
    let place = |cell: u32| 0.25 * (f64::from(cell) - 3.5);
    let cells = (0..8).flat_map(|j| (0..8).map(move |i| [place(i), place(j)]));
    let face =
        |[x, y]: [f64; 2]| [[0.0, -0.01], [-0.01, 0.01], [0.01, 0.01]].map(|[dx, dy]| [x + dx, y + dy, 2.0]);
    let corners: Vec<[f32; 3]> = cells.flat_map(face).map(|corner| corner.map(|x| x as f32)).collect();
    let faces: Vec<[u32; 3]> = (0..64).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
    let plaster = Material { name: "plaster".into(), reflectivity: 0.5 };
    let mesh = Mesh::new(DVec3::ZERO, corners, faces, vec![0; 64], vec![plaster]).unwrap();
    let camera = Mounted { scene_from_sensor: Pose::IDENTITY, sensor: rig::camera(8, 8, 0.0625, 0.5) };
    let air = Atmosphere { attenuation: 0.0 };
    Bench::of(Scene::new(Arc::new(mesh), camera, vec![], air, FluxModel::Radiometric).unwrap())
}
