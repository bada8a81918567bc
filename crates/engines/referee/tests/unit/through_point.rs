//! Displacements through points, by hand, and the tip of a thin triangle.

use std::sync::Arc;

use glam::{DQuat, DVec3};
use raypencil_scene::{
    Atmosphere, Beam, Camera, FaceId, FluxModel, Lens, Material, Mesh, Pose, Profile, Scene, SensorId,
};

use super::*;
use crate::{Referee, Ruling, Tolerance};

/// A camera at (1, 2, 3) that looks along z: pixels of 1/64, focal length 1/16, principal point (2, 2).
fn camera() -> Mounted<Camera> {
    let sensor = Camera {
        width: 4,
        height: 4,
        pixel_pitch: [1.0 / 64.0; 2],
        focal_length: 1.0 / 16.0,
        principal_point: [2.0; 2],
        aperture: 2e-3,
        lens: Lens::CLEAR,
        max_range: 1e3,
    };
    Mounted { scene_from_sensor: Pose::from_position(DVec3::new(1.0, 2.0, 3.0)), sensor }
}

fn beam(pose: Pose, half_width: f64, thickness: f64, grid_distance: f64) -> Mounted<Beam> {
    let sensor = Beam {
        columns: 1,
        rows: 1,
        thickness,
        grid_distance,
        half_width,
        max_range: 1024.0,
        power: 1.0,
        wavelength: 810e-9,
        profile: Profile::Paper,
    };
    Mounted { scene_from_sensor: pose, sensor }
}

/// A scene of one face, under one beam.
fn one_face(vertices: Vec<[f32; 3]>, beam: Mounted<Beam>) -> Scene {
    let ground = Material { name: "ground".into(), reflectivity: 0.25 };
    let mesh = Mesh::new(DVec3::ZERO, vertices, vec![[0, 1, 2]], vec![0], vec![ground]).expect("a mesh");
    let air = Atmosphere { attenuation: 0.0 };
    Scene::new(Arc::new(mesh), camera(), vec![beam], air, FluxModel::Radiometric).expect("a scene")
}

fn exactly(x: f64, y: f64, z: f64) -> Vector<Dyadic> {
    Vector::of(DVec3::new(x, y, z))
}

#[test]
fn through_a_point_by_hand() {
    // (2, 1.5, 7) is (1, -1/2, 4) before the camera: x/z = 1/4, y/z = -1/8, that is pixels 3 and 1.5; the middle of
    // pixel (2, 2) is (2.5, 2.5).
    let aim = Aim { i: 2, j: 2, dx: 0.0, dy: 0.0 };
    let sensor = MountedSensor::camera(camera());
    assert_eq!(CellRay::of(&sensor, aim).displacement_through(&exactly(2.0, 1.5, 7.0)), Some([0.5, -1.0]));
    assert_eq!(CellRay::of(&sensor, aim).displacement_through(&exactly(2.0, 1.5, 3.0)), None);
    // A beam of one cell at the same place, 2 w = 1/2 wide at g = 1 and T = 1/8 thick: x/z = 1/4 is half a cell, y =
    // -1/2 is 4 cells up.
    let beam = MountedSensor::beam(beam(camera().scene_from_sensor, 0.25, 0.125, 1.0));
    let aim = Aim { i: 0, j: 0, dx: 0.0, dy: 0.0 };
    assert_eq!(CellRay::of(&beam, aim).displacement_through(&exactly(2.0, 1.5, 7.0)), Some([0.5, -4.0]));
}

#[test]
fn what_intervals_call_beyond_is_beyond_and_little_else_is_kept() {
    let aim = Aim { i: 2, j: 2, dx: 0.0, dy: 0.0 };
    let camera = MountedSensor::camera(camera());
    let beam = MountedSensor::beam(beam(self::camera().scene_from_sensor, 0.25, 0.125, 1.0));
    let thirds = |n: i32| f64::from(n) / 3.0;
    let mut compared = 0;
    for (sensor, x, y, z) in [&camera, &beam].into_iter().flat_map(|sensor| {
        let numbers = (-4..5).flat_map(move |x| (-4..5).map(move |y| (x, y)));
        numbers.map(move |(x, y)| (sensor, 2.0 + thirds(x), 1.5 + thirds(y), 7.1))
    }) {
        let at = CellRay::of(sensor, aim).displacement_through(&exactly(x, y, z)).expect("before the sensor");
        let fast = CellRay::<Interval>::of(sensor, aim);
        let is_beyond = |cells: f64| fast.is_certainly_beyond(&Vector::of(DVec3::new(x, y, z)), cells);
        let [low, high] = [-1e-12, 1e-12].map(|part| max_norm(at) * (1.0 + part));
        assert!(!is_beyond(max_norm(at)) && !is_beyond(high), "{at:?}");
        assert!(low == 0.0 || is_beyond(low), "{at:?}");
        compared += usize::from(low > 0.0);
    }
    assert!(compared > 150, "{compared}");
    // In the plane through the sensor nothing is certain.
    let in_plane = Vector::of(DVec3::new(2.0, 1.5, 3.0));
    assert!(!CellRay::<Interval>::of(&camera, aim).is_certainly_beyond(&in_plane, 1e9));
}

/// A pencil of 5e-5 radians aimed at the tip of a thin triangle as exactly as f64 allows. It misses the tip by some
/// 1e-12 cells, and the linear forms of the triangle's sides cross before they reach the triangle.
#[allow(clippy::excessive_precision, reason = "these are exact: parts of 1024 and 512")]
fn needle() -> Scene {
    let vertices = vec![
        [10.794921875, 3.29296875, 0.03125],
        [9.750_529, 4.189_095, 0.367_478_55],
        [10.486328125, 3.55859375, 0.125],
    ];
    let pose = Pose {
        position: DVec3::new(11.312596292665075, -1.7929520999900985, 8.320111742053232),
        rotation: DQuat::from_xyzw(
            -0.3466432207384321,
            0.8801026685797992,
            0.32210972931112314,
            0.03876973765603294,
        ),
    };
    let beam = beam(pose, 4.76837158203125e-7, 0.00048828125, 0.019999980926513672);
    one_face(vertices, beam)
}

#[test]
fn the_tip_of_a_needle_is_met_by_a_ray_next_to_it() {
    let scene = needle();
    let referee = Referee::new(&scene);
    let beam = SensorId::Beam(0);
    assert!(!referee.verdict(beam, 0, 0).expect("a pencil").is_hit());
    // An answer that it is met is wrong by no more than the rounding of f64.
    let tolerance = Tolerance { lateral: 1e-9, depth: 1e-9, position: 0.0, unit_roundoff: 0.0 };
    let ruling = referee.rule(beam, 0, 0, Some(FaceId(0)), tolerance);
    let Some(Ruling::Rounding(witness)) = ruling else { panic!("{ruling:?}") };
    assert!(witness.max_norm() <= 1e-9, "{witness:?}");
    // It is wrong for a renderer with a finer tolerance.
    let finer = Tolerance { lateral: 1e-16, ..tolerance };
    assert_eq!(referee.rule(beam, 0, 0, Some(FaceId(0)), finer), Some(Ruling::Wrong));
    // The margins show it too.
    let margins = referee.margins(beam, 0, 0).expect("a pencil");
    assert!(margins.face.hi <= 1e-9, "{:?}", margins.face);
    assert!(margins.surface.hi <= 1e-9, "{:?}", margins.surface);
}

/// A needle 1.6 m long across the ray, whose plane the ray misses by 6e-12 radians: across the ray it is 1e-16 m thin, and
/// the ray passes 2e-16 m beside it, far from its corners. Found by a campaign.
#[allow(clippy::excessive_precision, reason = "the numbers of a campaign, to the last digit")]
fn needle_across() -> Scene {
    let vertices = vec![
        [11.54992389678955, 5.256635665893555, -0.05701039731502533],
        [10.358511924743652, 4.227706432342529, 0.2043776661157608],
        [11.199811935424805, 4.954240798950195, 0.019805200397968292],
    ];
    let pose = Pose {
        position: DVec3::new(9.061130115169984, 6.2015420129665735, 0.15479333817261343),
        rotation: DQuat::from_xyzw(
            0.7073199381509535,
            0.005473023423473111,
            0.4578088300430579,
            0.5385904067501984,
        ),
    };
    let mut beam = beam(pose, 4e-8, 6.158109287186978e-6, 0.02);
    (beam.sensor.columns, beam.sensor.rows) = (17, 3);
    one_face(vertices, beam)
}

#[test]
fn a_needle_across_the_ray_is_met_by_a_ray_next_to_it() {
    let scene = needle_across();
    let referee = Referee::new(&scene);
    let beam = SensorId::Beam(0);
    assert!(!referee.verdict(beam, 8, 1).expect("a pencil").is_hit());
    let rule = |lateral| {
        let tolerance = Tolerance { lateral, depth: 1e-9, position: 0.0, unit_roundoff: 0.0 };
        referee.rule(beam, 8, 1, Some(FaceId(0)), tolerance).expect("a pencil")
    };
    // 1e-9 cells are 5e-16 m. That the needle is met is no more wrong than that.
    let Ruling::Rounding(witness) = rule(1e-9) else { panic!("{:?}", rule(1e-9)) };
    assert!(witness.max_norm() <= 1e-9, "{witness:?}");
    assert_eq!(rule(1e-12), Ruling::Wrong);
    let margins = referee.margins(beam, 8, 1).expect("a pencil");
    assert!(margins.face.hi <= 1e-9 && margins.surface.hi <= 1e-9, "{margins:?}");
}
