//! Hand-made exact cases, and properties of verdicts, margins and rulings.

use std::sync::Arc;

use glam::{DQuat, DVec3};
use proptest::prelude::*;
use raypencil_referee::{Displacement, Referee, Ruling, Tolerance};
use raypencil_scene::{
    Atmosphere, Beam, Camera, FaceId, FluxModel, Lens, Material, Mesh, Mounted, Pose, Profile, Scene,
    SensorId,
};
use raypencil_terrain::RandomGround;

const CAMERA: SensorId = SensorId::Camera;

/// Pixel (4, 4) of this camera looks exactly along +z; neighbouring rays are 1/8 m apart per metre of depth.
fn camera(max_range: f64) -> Camera {
    Camera {
        width: 9,
        height: 9,
        pixel_pitch: [0.0625; 2],
        focal_length: 0.5,
        principal_point: [4.5; 2],
        aperture: 0.01,
        lens: Lens::CLEAR,
        max_range,
    }
}

fn mesh(vertices: Vec<[f32; 3]>, faces: Vec<[u32; 3]>) -> Arc<Mesh> {
    let materials = vec![Material { name: "ground".into(), reflectivity: 0.25 }];
    let of_faces = vec![0; faces.len()];
    Arc::new(Mesh::new(DVec3::ZERO, vertices, faces, of_faces, materials).expect("a valid mesh"))
}

fn scene(mesh: Arc<Mesh>, camera: Camera, pose: Pose, beams: Vec<Mounted<Beam>>) -> Scene {
    let camera = Mounted { scene_from_sensor: pose, sensor: camera };
    Scene::new(mesh, camera, beams, Atmosphere { attenuation: 0.0 }, FluxModel::Radiometric)
        .expect("a valid scene")
}

fn looking_along_z(vertices: Vec<[f32; 3]>, faces: Vec<[u32; 3]>, max_range: f64) -> Scene {
    scene(mesh(vertices, faces), camera(max_range), Pose::IDENTITY, Vec::new())
}

fn faces(scene: &Scene, i: u32, j: u32) -> Vec<u32> {
    let verdict = Referee::new(scene).verdict(CAMERA, i, j).expect("a pixel");
    verdict.faces.iter().map(|face| face.0).collect()
}

/// Six faces around (0, 0, 2), their fronts to the camera. x is right and y down, so seen from the origin
/// along +z a front runs the way in which y turns into x.
fn hexagon() -> (Vec<[f32; 3]>, Vec<[u32; 3]>) {
    let around = [[1.0, 0.0], [0.5, 1.0], [-0.5, 1.0], [-1.0, 0.0], [-0.5, -1.0], [0.5, -1.0]];
    let mut vertices = vec![[0.0, 0.0, 2.0]];
    vertices.extend(around.map(|[x, y]| [x, y, 2.0]));
    (vertices, (0..6).map(|k| [0, 1 + (k + 1) % 6, 1 + k]).collect())
}

#[test]
fn a_vertex_of_six_faces_is_a_tie_of_six() {
    let (vertices, six) = hexagon();
    let scene = looking_along_z(vertices, six, 100.0);
    assert_eq!(faces(&scene, 4, 4), [0, 1, 2, 3, 4, 5]);
    // Any displacement leaves some of them.
    let margin = Referee::new(&scene).face_margin(CAMERA, 4, 4).unwrap();
    assert_eq!(margin.lo, 0.0);
    assert!(margin.hi <= 1e-9 && margin.witness.is_some(), "{margin:?}");
    // But the surface goes on: at depth 2 a cell is 1/4 m wide, the hexagon ends 1 m away.
    assert_eq!(Referee::new(&scene).surface_margin(CAMERA, 4, 4).unwrap().lo, 1.0);
}

#[test]
fn along_an_edge_two_faces_tie() {
    let (vertices, six) = hexagon();
    let scene = looking_along_z(vertices, six, 100.0);
    // Pixel (5, 4): q = (1/16, 0, 1/2), at depth 2 the point (1/4, 0, 2) on the edge to (1, 0, 2).
    assert_eq!(faces(&scene, 5, 4), [0, 5]);
}

#[test]
fn coplanar_duplicates_tie_and_stay_together() {
    // The same triangle twice, begun at another corner, and a third time turned over.
    let vertices = vec![[-1.0, -1.0, 2.0], [1.0, -1.0, 2.0], [0.0, 1.5, 2.0]];
    let scene = looking_along_z(vertices, vec![[0, 2, 1], [2, 1, 0], [0, 1, 2]], 100.0);
    assert_eq!(faces(&scene, 4, 4), [0, 1]);
    // Its sides are more than a cell (1/4 m) away, and displacement parts none of the two.
    let margin = Referee::new(&scene).face_margin(CAMERA, 4, 4).unwrap();
    assert_eq!(margin.lo, 1.0);
}

#[test]
fn a_vertex_exactly_on_the_near_plane_is_met() {
    // t = 1 at (0, 0, 1/2); the rest of the face lies behind the plane and beside the ray.
    let at = |z: f32| {
        let vertices = vec![[0.0, 0.0, z], [-1.0, -1.0, 0.25], [1.0, -1.0, 0.25]];
        faces(&looking_along_z(vertices, vec![[0, 2, 1], [0, 1, 2]], 100.0), 4, 4)
    };
    assert_eq!(at(0.5).len(), 1);
    assert_eq!(at(0.5_f32.next_up()).len(), 1);
    assert_eq!(at(0.5_f32.next_down()), []);
}

#[test]
fn the_longest_range_is_included_exactly() {
    // Pixel (8, 4): q = (1/4, 0, 1/2), |q|^2 = 5/16. A wall at depth 8 is met at t = 16, R^2 = 256 5/16 = 80: no
    // f64 is its root. Pixel (4, 4) meets it at R = 8 exactly.
    let wall = || vec![[-90.0, -90.0, 8.0], [90.0, -90.0, 8.0], [0.0, 90.0, 8.0]];
    let at = |max_range: f64, i: u32| faces(&looking_along_z(wall(), vec![[0, 2, 1]], max_range), i, 4);
    assert_eq!((at(8.0, 4), at(8.0_f64.next_down(), 4)), (vec![0], vec![]));
    // sqrt(80) rounds to a number below or above the root: one of the two neighbours admits the hit.
    let root = 80.0_f64.sqrt();
    let admitted = [root.next_down(), root.next_up()].map(|max_range| at(max_range, 8).len());
    assert_eq!(admitted, [0, 1]);
}

#[test]
fn a_back_and_a_face_without_area_are_never_met() {
    let vertices = vec![[-1.0, -1.0, 2.0], [1.0, -1.0, 2.0], [0.0, 1.5, 2.0], [0.0, 0.0, 1.5]];
    assert_eq!(faces(&looking_along_z(vertices, vec![[0, 1, 2], [3, 3, 3], [0, 3, 0]], 100.0), 4, 4), []);
}

#[test]
fn rulings_tell_rounding_from_wrong() {
    let (vertices, six) = hexagon();
    let scene = looking_along_z(vertices, six, 100.0);
    let referee = Referee::new(&scene);
    let rule = |i, answer: Option<u32>, lateral| {
        referee
            .rule(
                CAMERA,
                i,
                4,
                answer.map(FaceId),
                Tolerance { lateral, depth: 1e-12, position: 0.0, unit_roundoff: 0.0 },
            )
            .unwrap()
    };
    // On the edge of faces 0 and 5: both tie. A miss there is never admissible, however coarse.
    assert_eq!(rule(5, Some(0), 1e-9), Ruling::Tie);
    assert_eq!(rule(5, Some(5), 1e-9), Ruling::Tie);
    assert_eq!(rule(5, None, 1e-3), Ruling::Wrong);
    // Face 1 begins half a metre away, two cells: out of reach of 1e-9 cells.
    assert_eq!(rule(5, Some(1), 1e-9), Ruling::Wrong);
    // Through the middle vertex all are right; outside of everything a miss is.
    assert_eq!(rule(4, Some(3), 1e-9), Ruling::Tie);
    assert_eq!(rule(4, None, 1e-3), Ruling::Wrong);
    // An index that the mesh does not have.
    let none = referee.rule(
        CAMERA,
        4,
        4,
        Some(FaceId(6)),
        Tolerance { lateral: 1e-9, depth: 0.0, position: 0.0, unit_roundoff: 0.0 },
    );
    assert_eq!(none, None);
}

#[test]
fn an_answer_just_beyond_an_edge_is_rounding_with_its_witness() {
    // A wall whose right edge stands at x = 2^-30 at depth 2: 2^-28 cells to the right of pixel (4, 4).
    let x = 1.0 / (1u32 << 30) as f32;
    let vertices = vec![[-9.0, -9.0, 2.0], [x, -9.0, 2.0], [x, 9.0, 2.0]];
    let scene = looking_along_z(vertices, vec![[0, 2, 1]], 100.0);
    let referee = Referee::new(&scene);
    assert_eq!(faces(&scene, 4, 4), [0]);
    let rule = |lateral| {
        referee
            .rule(CAMERA, 4, 4, None, Tolerance { lateral, depth: 0.0, position: 0.0, unit_roundoff: 0.0 })
            .unwrap()
    };
    assert_eq!(rule(1e-9), Ruling::Wrong);
    let Ruling::Rounding(by) = rule(1e-8) else { panic!("{:?}", rule(1e-8)) };
    assert!(by.max_norm() <= 1e-8);
    assert!(!referee.verdict_beside(CAMERA, 4, 4, by).unwrap().is_hit());
    // The margin says the same: 2^-28 cells.
    let margin = referee.face_margin(CAMERA, 4, 4).unwrap();
    let exact = 1.0 / (1u32 << 28) as f64;
    assert!(margin.lo <= exact && exact <= margin.hi && margin.hi <= 1.001 * margin.lo, "{margin:?}");
}

/// Two walls at depth 2 and one f32 step behind it: naming the farther one is 2.4e-7 m wrong.
fn walls_one_ulp_apart() -> Scene {
    let depths = [2.0, 2.0_f32.next_up()];
    let vertices = depths.iter().flat_map(|&z| [[-9.0, -9.0, z], [9.0, -9.0, z], [0.0, 9.0, z]]).collect();
    let scene = looking_along_z(vertices, vec![[0, 2, 1], [3, 5, 4]], 100.0);
    assert_eq!(faces(&scene, 4, 4), [0]);
    scene
}

#[test]
fn faces_one_ulp_apart_are_rounding_in_depth() {
    let scene = walls_one_ulp_apart();
    let rule = |depth| {
        let tolerance = Tolerance { lateral: 1e-9, depth, position: 0.0, unit_roundoff: 0.0 };
        Referee::new(&scene).rule(CAMERA, 4, 4, Some(FaceId(1)), tolerance).unwrap()
    };
    assert_eq!(rule(1e-12), Ruling::Wrong);
    assert_eq!(rule(3e-7), Ruling::Rounding(Displacement::ZERO));
}

/// The range of a face in the way has an error too: (10 kappa + 27) u S / c.
#[test]
fn a_face_in_the_way_has_an_error_of_its_own() {
    let scene = walls_one_ulp_apart();
    // Edges of 18 m and twice sqrt(405) m, |n| = 324 m^2: kappa = 405/324. R = 2 m, c = 1.
    let gap = f64::from(2.0_f32.next_up()) - 2.0;
    let least = gap / ((10.0 * (405.0 / 324.0) + 27.0) * (2.0 + 405.0_f64.sqrt()));
    let rule = |unit_roundoff: f64| {
        let tolerance = Tolerance { lateral: 0.0, depth: 0.0, position: 0.0, unit_roundoff };
        Referee::new(&scene).rule(CAMERA, 4, 4, Some(FaceId(1)), tolerance).unwrap()
    };
    assert_eq!(rule(0.99 * least), Ruling::Wrong);
    assert_eq!(rule(1.01 * least), Ruling::Rounding(Displacement::ZERO));
}

/// A ray begins at t = 1 and ends at its longest range. A renderer knows on which side of an end a face lies as well as it
/// knows its range.
#[test]
fn the_ends_of_a_ray_are_as_sharp_as_ranges_are() {
    let off = 1.0 / f64::from(1 << 20);
    // Pixel (4, 4): |q| = 1/2 m.
    for (end, inwards) in [(0.5, 1.0), (8.0, -1.0)] {
        let scene = |z: f64| {
            let wall = vec![[-90.0, -90.0, z as f32], [90.0, -90.0, z as f32], [0.0, 90.0, z as f32]];
            looking_along_z(wall, vec![[0, 2, 1]], 8.0)
        };
        // Beyond the end, and named.
        let outside = scene(end - inwards * off);
        assert_eq!(faces(&outside, 4, 4), []);
        let rule = |depth: f64| {
            let tolerance = Tolerance { lateral: 0.0, depth, position: 0.0, unit_roundoff: 0.0 };
            Referee::new(&outside).rule(CAMERA, 4, 4, Some(FaceId(0)), tolerance).unwrap()
        };
        assert_eq!(rule(0.99 * off), Ruling::Wrong, "{end}");
        assert_eq!(rule(1.01 * off), Ruling::Rounding(Displacement::ZERO), "{end}");
        // Exactly at the end it is met, as the contract says.
        let at_end = scene(end);
        let tolerance = Tolerance { lateral: 0.0, depth: 0.0, position: 0.0, unit_roundoff: 1e-6 };
        assert_eq!(Referee::new(&at_end).rule(CAMERA, 4, 4, None, tolerance), Some(Ruling::Wrong), "{end}");
        // Before the end, and lost: edges of 180 m and twice sqrt(40500) m, |n| = 180^2 m^2.
        let inside = scene(end + inwards * off);
        assert_eq!(faces(&inside, 4, 4), [0]);
        let least = off / ((10.0 * (40500.0 / 32400.0) + 27.0) * (end + 40500.0_f64.sqrt()));
        let rule = |unit_roundoff: f64| {
            let tolerance = Tolerance { lateral: 0.0, depth: 0.0, position: 0.0, unit_roundoff };
            Referee::new(&inside).rule(CAMERA, 4, 4, None, tolerance).unwrap()
        };
        assert_eq!(rule(0.99 * least), Ruling::Wrong, "{end}");
        assert_eq!(rule(1.01 * least), Ruling::Rounding(Displacement::ZERO), "{end}");
    }
}

/// Who takes a face to lie before the ray's start sees what is behind it.
#[test]
fn a_face_at_the_start_of_a_ray_may_be_seen_through() {
    let off = 1.0 / f64::from(1 << 20);
    let wall = |z: f32| [[-90.0, -90.0, z], [90.0, -90.0, z], [0.0, 90.0, z]];
    let vertices = [wall(0.5 + off as f32), wall(7.0)].concat();
    let scene = looking_along_z(vertices, vec![[0, 2, 1], [3, 5, 4]], 8.0);
    assert_eq!(faces(&scene, 4, 4), [0]);
    let least = off / ((10.0 * (40500.0 / 32400.0) + 27.0) * (0.5 + 40500.0_f64.sqrt()));
    let rule = |unit_roundoff: f64| {
        let tolerance = Tolerance { lateral: 1e-9, depth: 0.0, position: 0.0, unit_roundoff };
        Referee::new(&scene).rule(CAMERA, 4, 4, Some(FaceId(1)), tolerance).unwrap()
    };
    assert_eq!(rule(0.99 * least), Ruling::Wrong);
    assert_eq!(rule(1.01 * least), Ruling::Rounding(Displacement::ZERO));
}

/// Up to a cosine of (5 kappa + 15) u the front of a face is not told from its back. A face that is seen so is not in the way
/// either, because the error of its range is larger than the range.
#[test]
fn an_edge_on_face_may_be_met_from_behind_or_not_at_all() {
    // From (-+1, -d/2, 1) to (0, d/2, 3): n = (0, -4, 2 d) m^2, the cosine is d/2, and kappa = sqrt 5 sqrt 5 / 4. A wall far
    // behind it.
    let scene = |d: f32| {
        let vertices = vec![
            [-1.0, -d / 2.0, 1.0],
            [1.0, -d / 2.0, 1.0],
            [0.0, d / 2.0, 3.0],
            [-90.0, -90.0, 90.0],
            [90.0, -90.0, 90.0],
            [0.0, 90.0, 90.0],
        ];
        looking_along_z(vertices, vec![[0, 1, 2], [3, 5, 4]], 100.0)
    };
    let cosine = 0.5 / 1024.0;
    // From behind; and before the wall: R = 2 m, of which the ray has its first half metre before t = 1, and L = sqrt 5 m.
    let of_back = cosine / (5.0 * 1.25 + 15.0);
    let in_the_way = 1.5 * cosine / ((10.0 * 1.25 + 27.0) * (2.0 + 5.0_f64.sqrt()));
    let rule = |scene: &Scene, answer: u32, unit_roundoff: f64| {
        let tolerance = Tolerance { lateral: 0.0, depth: 0.0, position: 0.0, unit_roundoff };
        Referee::new(scene).rule(CAMERA, 4, 4, Some(FaceId(answer)), tolerance).unwrap()
    };
    let [behind, before] = [scene(1.0 / 1024.0), scene(-1.0 / 1024.0)];
    assert_eq!((faces(&behind, 4, 4), faces(&before, 4, 4)), (vec![1], vec![0]));
    for (scene, wrong_answer, least) in [(&behind, 0, of_back), (&before, 1, in_the_way)] {
        assert_eq!(rule(scene, wrong_answer, 0.99 * least), Ruling::Wrong, "{wrong_answer}");
        assert_eq!(rule(scene, wrong_answer, 1.01 * least), Ruling::Rounding(Displacement::ZERO));
    }
    // Without the wall it may be missed, and no other ray need be sought.
    let corners = vec![[-1.0, 1.0 / 2048.0, 1.0], [1.0, 1.0 / 2048.0, 1.0], [0.0, -1.0 / 2048.0, 3.0]];
    let alone = looking_along_z(corners, vec![[0, 1, 2]], 100.0);
    let tolerance = Tolerance { lateral: 1e-3, depth: 0.0, position: 0.0, unit_roundoff: 1.01 * in_the_way };
    let missed = Referee::new(&alone).rule(CAMERA, 4, 4, None, tolerance);
    assert_eq!(missed, Some(Ruling::Rounding(Displacement::ZERO)));
    // Seen exactly along its plane it is never met, however coarse the arithmetic.
    assert_eq!(rule(&scene(0.0), 0, 1e-3), Ruling::Wrong);
}

/// No ray is displaced by more than a cell, however coarse a renderer's arithmetic is.
#[test]
fn a_tolerance_is_a_cell_at_most() {
    // At depth 2 a cell is 1/4 m. The first face ends 1/8 m, half a cell, to the right of pixel (4, 4); the second
    // begins 3/8 m, one and a half cells, to the right of it.
    let vertices = vec![
        [-1.0, -1.0, 2.0],
        [0.125, -1.0, 2.0],
        [0.125, 1.0, 2.0],
        [-1.0, 1.0, 2.0],
        [0.375, -1.0, 2.0],
        [1.5, -1.0, 2.0],
        [0.375, 1.0, 2.0],
    ];
    let scene = looking_along_z(vertices, vec![[0, 2, 1], [0, 3, 2], [4, 6, 5]], 100.0);
    let referee = Referee::new(&scene);
    let rule = |answer: Option<FaceId>, lateral: f64| {
        let tolerance = Tolerance { lateral, depth: 0.0, position: 0.0, unit_roundoff: 0.0 };
        referee.rule(CAMERA, 4, 4, answer, tolerance).expect("a pixel")
    };
    assert_eq!(faces(&scene, 4, 4), [0]);
    for lateral in [0.75, 1.0, 2.0, 1e9] {
        assert!(matches!(rule(None, lateral), Ruling::Rounding(_)), "the gap is near: {lateral}");
        assert_eq!(rule(Some(FaceId(2)), lateral), Ruling::Wrong, "{lateral}");
    }
    assert_eq!(rule(None, 0.25), Ruling::Wrong);
    assert_eq!(rule(None, -1.0), Ruling::Wrong);
}

#[test]
fn faces_near_a_ray_are_all_that_it_may_meet() {
    let (vertices, six) = hexagon();
    let scene = looking_along_z(vertices, six, 100.0);
    let referee = Referee::new(&scene);
    let near = |i: u32, j: u32, radius: f64| {
        let faces = referee.candidate_faces(CAMERA, i, j, radius)?;
        Some(faces.into_iter().map(|face| face.0).collect::<Vec<_>>())
    };
    assert_eq!(near(4, 4, 0.5), Some(vec![0, 1, 2, 3, 4, 5]));
    assert_eq!(near(9, 0, 0.5), None, "no such pixel");
}

/// A camera and a beam with few cells, both at one pose over a random ground.
fn random_scene(seed: u64, size: usize, turn: [f64; 4], at: [f64; 3]) -> Scene {
    let mesh = Arc::new(RandomGround::nasty(seed, size).build().into_mesh().expect("a valid ground"));
    let pose = Pose {
        position: DVec3::from_array(at),
        rotation: DQuat::from_xyzw(turn[0], turn[1], turn[2], turn[3]),
    };
    let camera = Camera {
        width: 40,
        height: 30,
        pixel_pitch: [2.3e-4, 2.1e-4],
        focal_length: 8e-3,
        principal_point: [20.3, 14.8],
        aperture: 2e-3,
        lens: Lens::CLEAR,
        max_range: 20.0,
    };
    let beam = Beam {
        columns: 64,
        rows: 4,
        thickness: 0.02,
        grid_distance: 0.1,
        half_width: 0.15,
        max_range: 20.0,
        power: 1.0,
        wavelength: 8e-7,
        profile: Profile::Paper,
    };
    scene(mesh, camera, pose, vec![Mounted { scene_from_sensor: pose, sensor: beam }])
}

fn quaternion() -> impl Strategy<Value = [f64; 4]> {
    proptest::array::uniform4(-1.0f64..1.0)
        .prop_filter("long enough", |q| q.iter().map(|x| x * x).sum::<f64>() > 0.01)
}

proptest! {
    #![proptest_config(ProptestConfig { max_shrink_iters: 100, ..ProptestConfig::with_cases(40) })]

    // 40 scenes x 50 rays x 50 displacements: 1e5 displaced rays, judged exactly.
    #[test]
    fn no_displacement_within_lo_changes_a_verdict_and_hi_does(
        seed in any::<u64>(),
        turn in quaternion(),
        at in [-4.0f64..4.0, -4.0..4.0, 0.5..4.0],
        cells in prop::collection::vec((0u32..40, 0u32..4, any::<bool>()), 50),
        moves in prop::collection::vec((-1.0f64..1.0, -1.0f64..1.0), 50),
    ) {
        let scene = random_scene(seed, 400, turn, at);
        let referee = Referee::new(&scene);
        for (i, j, beam) in cells {
            let sensor = if beam { SensorId::Beam(0) } else { CAMERA };
            let verdict = referee.verdict(sensor, i, j).unwrap();
            let margin = referee.face_margin(sensor, i, j).unwrap();
            prop_assert!(margin.lo <= margin.hi);
            for (dx, dy) in &moves {
                // Most of them at the border of what is proven.
                let scale = margin.lo / dx.abs().max(dy.abs()).max(1e-3);
                let by = Displacement { dx: dx * scale.min(margin.lo), dy: dy * scale.min(margin.lo) };
                prop_assert!(by.max_norm() <= margin.lo);
                prop_assert_eq!(&referee.verdict_beside(sensor, i, j, by).unwrap(), &verdict, "{:?}", by);
            }
            if let Some(by) = margin.witness {
                prop_assert!(by.max_norm() <= margin.hi);
                prop_assert_ne!(&referee.verdict_beside(sensor, i, j, by).unwrap(), &verdict);
                prop_assert!(margin.hi <= 2.0 * margin.lo || margin.hi <= 1e-9, "{:?} at {} {},{}", margin, sensor, i, j);
            } else {
                // Only where the cap of one cell stands in for a witness.
                prop_assert!(margin.lo >= 0.5, "{:?} without a witness: {} {},{}", margin, sensor, i, j);
            }
        }
    }

    // Indices carry no meaning: the same faces are met whatever their indices and first corners.
    #[test]
    fn relabelling_changes_nothing(
        seed in any::<u64>(),
        turn in quaternion(),
        at in [-4.0f64..4.0, -4.0..4.0, 0.5..4.0],
        shift in 1usize..200,
    ) {
        let scene = random_scene(seed, 200, turn, at);
        let mesh = scene.mesh();
        let count = mesh.faces().len();
        // Vertices reversed, faces shifted around, every cycle begun one corner later.
        let last = mesh.vertices().len() as u32 - 1;
        let vertices: Vec<_> = mesh.vertices().iter().rev().copied().collect();
        let faces: Vec<[u32; 3]> = (0..count)
            .map(|k| mesh.faces()[(k + shift) % count].map(|v| last - v))
            .map(|[a, b, c]| [b, c, a])
            .collect();
        let materials = vec![0; count];
        let other = Mesh::new(mesh.origin(), vertices, faces, materials, mesh.materials().to_vec()).unwrap();
        let camera = *scene.camera();
        let other = Scene::new(Arc::new(other), camera, scene.beams().to_vec(), scene.atmosphere(), scene.flux_model()).unwrap();
        let (one, two) = (Referee::new(&scene), Referee::new(&other));
        for sensor in [CAMERA, SensorId::Beam(0)] {
            for (i, j) in (0..40).flat_map(|i| (0..4).map(move |j| (i, j))) {
                let mut renamed: Vec<u32> = two
                    .verdict(sensor, i, j)
                    .unwrap()
                    .faces
                    .iter()
                    .map(|face| ((face.0 as usize + shift) % count) as u32)
                    .collect();
                renamed.sort_unstable();
                let first: Vec<u32> = one.verdict(sensor, i, j).unwrap().faces.iter().map(|face| face.0).collect();
                prop_assert_eq!(first, renamed);
            }
        }
    }
}
