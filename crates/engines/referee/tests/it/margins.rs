//! Margins of many rays over malformed grounds: they hold, they have witnesses, and they are tight.

use super::wall;

use std::sync::Arc;

use crate::splitmix::SplitMix64;
use glam::{DQuat, DVec3};
use raypencil_referee::{Displacement, Margin, Referee};
use raypencil_scene::{Atmosphere, Beam, Camera, FluxModel, Mesh, Mounted, Pose, Profile, Scene, SensorId};
use raypencil_terrain::{BUILTIN_NAMES, RandomGround, builtin};

/// Scene number `number`: a built-in or a malformed random ground, seen by a rover's rig or from anywhere. Cells are
/// as fine as a camera's or so coarse that many faces fit in one; the beam is thin, thick, or half a metre thick.
fn scene(number: u64) -> Scene {
    let mut random = SplitMix64(number);
    let mesh: Mesh = match number % 4 {
        0 => builtin(BUILTIN_NAMES[number as usize / 4 % BUILTIN_NAMES.len()], 0.25)
            .expect("a built-in name")
            .into_mesh(),
        1 => RandomGround::nasty(number, 400).build().into_mesh(),
        2 => RandomGround::nasty(number, 4000).build().into_mesh(),
        _ => RandomGround::nasty(number, 1500).build().into_mesh(),
    }
    .expect("a valid ground");
    let mut part = || random.between(-1.0, 1.0);
    let mut rotation = DQuat::from_xyzw(part(), part(), part(), part() + 0.1);
    if number.is_multiple_of(2) {
        let turned = Pose::from_axis_angle(DVec3::Z, random.between(0.0, 6.3))
            * Pose::from_axis_angle(DVec3::Y, random.between(0.1, 0.6))
            * Pose::VEHICLE_FROM_FORWARD_SENSOR;
        rotation = turned.rotation;
    }
    let position = DVec3::new(random.between(-4.0, 4.0), random.between(-4.0, 4.0), random.between(0.5, 3.5));
    let scene_from_sensor = Pose { position, rotation };
    let fine = if number.is_multiple_of(3) { 1 } else { 25 };
    let camera = Camera {
        width: 40 * fine,
        height: 30 * fine,
        pixel_pitch: [2.3e-4 / f64::from(fine), 2.1e-4 / f64::from(fine)],
        focal_length: 8e-3,
        principal_point: [20.3 * f64::from(fine), 14.8 * f64::from(fine)],
        aperture: 2e-3,
        lens: raypencil_scene::Lens::CLEAR,
        max_range: 20.0,
    };
    let beam = Beam {
        columns: 64 * fine,
        rows: if number.is_multiple_of(5) { 16 } else { 4 },
        thickness: [0.005, 0.02, 0.5][number as usize / 3 % 3],
        grid_distance: 0.1,
        half_width: 0.15,
        max_range: 20.0,
        power: 1.0,
        wavelength: 8e-7,
        profile: Profile::Paper,
    };
    Scene::new(
        Arc::new(mesh),
        Mounted { scene_from_sensor, sensor: camera },
        vec![Mounted { scene_from_sensor, sensor: beam }],
        Atmosphere { attenuation: 0.0 },
        FluxModel::Radiometric,
    )
    .expect("a valid scene")
}

/// A cell of one of the two sensors.
fn cell(scene: &Scene, random: &mut SplitMix64) -> (SensorId, u32, u32) {
    let sensor = if random.unit() < 0.5 { SensorId::Camera } else { SensorId::Beam(0) };
    let (width, height) = scene.size(sensor).expect("a sensor");
    (sensor, random.below(width), random.below(height))
}

/// The range of a displaced ray in plain f64, from the face that the referee names.
fn range(scene: &Scene, referee: &Referee<'_>, cell: (SensorId, u32, u32), by: [f64; 2]) -> Option<f64> {
    let (sensor, i, j) = cell;
    let verdict = referee.verdict_beside(sensor, i, j, Displacement { dx: by[0], dy: by[1] });
    let face = *verdict.expect("a cell").faces.first()?;
    let (pose, start, q) = match sensor {
        SensorId::Camera => {
            let Mounted { scene_from_sensor, sensor } = *scene.camera();
            let along = |index: u32, axis: usize| {
                (f64::from(index) + 0.5 + by[axis] - sensor.principal_point[axis]) * sensor.pixel_pitch[axis]
            };
            (scene_from_sensor, DVec3::ZERO, DVec3::new(along(i, 0), along(j, 1), sensor.focal_length))
        }
        SensorId::Beam(index) => {
            let Mounted { scene_from_sensor, sensor } = scene.beams()[index];
            let part = |index: u32, by: f64, count: u32| {
                (2.0 * f64::from(index) + 1.0 + 2.0 * by - f64::from(count)) / f64::from(count)
            };
            let y = 0.5 * sensor.thickness * part(j, by[1], sensor.rows);
            let x = sensor.half_width * part(i, by[0], sensor.columns);
            (scene_from_sensor, DVec3::new(0.0, y, 0.0), DVec3::new(x, 0.0, sensor.grid_distance))
        }
    };
    let rotation = pose.rotation.normalize();
    let (origin, q) = (pose.position + rotation * start, rotation * q);
    let [a, b, c] = scene.mesh().faces()[face.0 as usize]
        .map(|v| glam::Vec3::from_array(scene.mesh().vertices()[v as usize]).as_dvec3());
    let normal = (b - a).cross(c - a);
    Some(normal.dot(a - origin) / normal.dot(q) * q.length())
}

/// The relative difference of two ranges; infinite if exactly one is a miss.
fn step(a: Option<f64>, b: Option<f64>) -> f64 {
    match (a, b) {
        (Some(a), Some(b)) => (a - b).abs() / a.min(b),
        (None, None) => 0.0,
        _ => f64::INFINITY,
    }
}

const JUMP: f64 = 1.0 / (1u32 << 20) as f64;

/// The step that remains when two displacements are brought together to 2^-42 cells, each time on the side of the
/// greater step; 0 if there is none.
fn step_between(range: impl Fn([f64; 2]) -> Option<f64>, a: [f64; 2], b: [f64; 2]) -> f64 {
    let (mut a, mut b) = (a, b);
    let (mut range_a, mut range_b) = (range(a), range(b));
    while step(range_a, range_b) > JUMP {
        if (a[0] - b[0]).abs().max((a[1] - b[1]).abs()) < 1.0 / (1u64 << 42) as f64 {
            return step(range_a, range_b);
        }
        let middle = [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])];
        let between = range(middle);
        if step(range_a, between) >= step(between, range_b) {
            (b, range_b) = (middle, between);
        } else {
            (a, range_a) = (middle, between);
        }
    }
    0.0
}

/// A random point of [-1, 1]^2, mostly on its border.
fn in_square(random: &mut SplitMix64) -> [f64; 2] {
    let at = [random.between(-1.0, 1.0), random.between(-1.0, 1.0)];
    let size = at[0].abs().max(at[1].abs());
    if random.unit() < 0.7 { at.map(|part| (part / size).clamp(-1.0, 1.0)) } else { at }
}

#[test]
fn no_pair_of_displacements_within_lo_has_a_jump_between_and_the_witness_has() {
    let (mut pairs, mut witnesses) = (0, 0);
    for number in 0..170 {
        let scene = scene(number);
        let referee = Referee::new(&scene);
        let mut random = SplitMix64(1000 + number);
        for _ in 0..60 {
            let cell = cell(&scene, &mut random);
            let (sensor, i, j) = cell;
            let (verdict, margins) = referee.verdict_with_margins(sensor, i, j).unwrap();
            let is_hit = verdict.is_hit();
            assert_eq!(Some(verdict), referee.verdict(sensor, i, j));
            let Margin { lo, hi, witness } = margins.surface;
            assert!(
                margins.face.lo <= lo && lo <= hi && hi <= 1.0,
                "{number} {cell:?} {:?}",
                margins.surface
            );
            let range = |at: [f64; 2]| range(&scene, &referee, cell, at);
            for _ in 0..10 {
                let [a, b] = [in_square(&mut random), in_square(&mut random)].map(|at| at.map(|x| x * lo));
                assert_eq!(step_between(range, a, b), 0.0, "{number} {cell:?} {lo} {a:?} {b:?}");
                pairs += 1;
            }
            if let Some(Displacement { dx, dy }) = witness {
                assert!(dx.abs().max(dy.abs()) <= hi, "{number} {cell:?}");
                // Either the witness hits where the ray misses, or it lies at a jump: at most 2^-29 cells away, in
                // some direction, the range differs.
                let around = (-38..=-29).flat_map(|exponent| {
                    let far = 1.0 / (1u64 << -exponent) as f64;
                    [[1, 0], [1, 1], [0, 1], [-1, 1], [-1, 0], [-1, -1], [0, -1], [1, -1]]
                        .map(|[x, y]| [dx + far * f64::from(x), dy + far * f64::from(y)])
                });
                let here = range([dx, dy]);
                let comes_to_hit = here.is_some() && margins.face.witness == witness && !is_hit;
                let jumps = around.map(|at| step(here, range(at))).any(|step| step > JUMP);
                assert!(comes_to_hit || jumps, "{number} {cell:?} {:?}", margins.surface);
                witnesses += 1;
            }
        }
    }
    assert!(pairs >= 100_000 && witnesses > 500, "{pairs} pairs, {witnesses} witnesses");
}

/// Whether hi is more than twice lo though it is more than 1e-9, or there is neither a witness nor the cap.
fn loose(margin: &Margin) -> bool {
    let capped = margin.lo >= 1.0;
    !capped && (margin.witness.is_none() || margin.hi > 1e-9 && margin.hi > 2.0 * margin.lo)
}

#[test]
fn both_margins_are_tight() {
    let mut found = Vec::new();
    let mut rays = 0;
    for number in 0..200 {
        let scene = scene(number);
        let referee = Referee::new(&scene);
        let mut random = SplitMix64(2000 + number);
        for _ in 0..100 {
            let (sensor, i, j) = cell(&scene, &mut random);
            let margins = referee.margins(sensor, i, j).unwrap();
            for (name, margin) in [("face", margins.face), ("surface", margins.surface)] {
                if loose(&margin) {
                    found.push(format!("{name} of scene {number}, {sensor} {i},{j}: {margin:?}"));
                }
            }
            rays += 1;
        }
    }
    assert_eq!(rays, 20_000);
    assert!(found.is_empty(), "{} of {rays}: {found:#?}", found.len());
}

#[test]
fn one_call_answers_as_three_do() {
    let scene = scene(1);
    let referee = Referee::new(&scene);
    let mut random = SplitMix64(5);
    for _ in 0..300 {
        let (sensor, i, j) = cell(&scene, &mut random);
        let (verdict, margins) = referee.verdict_with_margins(sensor, i, j).unwrap();
        assert_eq!(referee.margins(sensor, i, j), Some(margins));
        assert_eq!(Some(verdict), referee.verdict(sensor, i, j));
        assert_eq!(Some(margins.face), referee.face_margin(sensor, i, j));
        assert_eq!(Some(margins.surface), referee.surface_margin(sensor, i, j));
    }
    assert_eq!(referee.margins(SensorId::Camera, 100_000, 0), None);
    assert_eq!(referee.margins(SensorId::Beam(1), 0, 0), None);
}

/// Neighbours are found by the positions of their corners, not by indices, and -0 equals 0.
#[test]
fn faces_need_no_common_vertices_to_be_one_surface() {
    for number in [0, 5, 6] {
        let scene = scene(number);
        let mesh = scene.mesh();
        let corners = mesh.faces().iter().enumerate().flat_map(|(index, face)| {
            face.map(|v| {
                mesh.vertices()[v as usize].map(|x| if x == 0.0 && index % 2 == 0 { -0.0 } else { x })
            })
        });
        let count = mesh.faces().len();
        let faces = (0..count as u32).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
        let kinds = mesh.materials().to_vec();
        let apart = Mesh::new(mesh.origin(), corners.collect(), faces, vec![0; count], kinds).expect("valid");
        let (beams, air) = (scene.beams().to_vec(), scene.atmosphere());
        let apart =
            Scene::new(Arc::new(apart), *scene.camera(), beams, air, scene.flux_model()).expect("valid");
        let (one, other) = (Referee::new(&scene), Referee::new(&apart));
        let mut random = SplitMix64(7);
        for _ in 0..200 {
            let (sensor, i, j) = cell(&scene, &mut random);
            assert_eq!(one.margins(sensor, i, j), other.margins(sensor, i, j), "{number} {sensor} {i},{j}");
        }
    }
}

/// A hidden wall must not end the search for faces that hide the ground farther away.
#[test]
fn a_wall_under_the_ground_hides_no_post_behind_it() {
    // Pixel (4, 4) looks along +z, y is down, rays are 1/64 m apart per metre of depth. The ground y = 0.02 (2 - z) is
    // met at z = 2. Behind it a wall stands at z = 2.2 up to y = -0.003, under the ground, which is there at -0.004. A
    // post at z = 4 rises from y = -0.03, under the ground at -0.04: the ray that meets the ground at z = 4 is
    // displaced by -0.04 / 4 / (1/64) = -0.64 cells, and rays above it meet the post.
    let ground = |x: f32, z: f32| [x, 0.02 * (2.0 - z), z];
    let upright = |z: f32, low: f32, high: f32| [[-1.0, low, z], [1.0, low, z], [0.0, high, z]];
    let corners = [
        [ground(-8.0, 1.0), ground(8.0, 1.0), ground(0.0, 19.0)],
        upright(2.2, -0.003, 1.0),
        // Beside all rays: this puts the post in another leaf of the hierarchy than the wall.
        upright(4.1, -2.0, -2.1),
        upright(2.5, 2.0, 2.1),
        upright(4.0, -0.03, -1.0),
        upright(30.0, 5.0, 6.0),
        upright(31.0, 5.0, 6.0),
        upright(32.0, 5.0, 6.0),
    ];
    // Each triangle with both of its sides, so that a front faces the camera.
    let faces = (0..8).flat_map(|k| [[3 * k, 3 * k + 1, 3 * k + 2], [3 * k, 3 * k + 2, 3 * k + 1]]).collect();
    let materials = vec![raypencil_scene::Material { name: "ground".into(), reflectivity: 0.25 }];
    let mesh = Mesh::new(DVec3::ZERO, corners.concat(), faces, vec![0; 16], materials).expect("a valid mesh");
    let camera = Camera {
        width: 9,
        height: 9,
        pixel_pitch: [0.0078125; 2],
        focal_length: 0.5,
        principal_point: [4.5; 2],
        aperture: 0.01,
        lens: raypencil_scene::Lens::CLEAR,
        max_range: 200.0,
    };
    let camera = Mounted { scene_from_sensor: Pose::IDENTITY, sensor: camera };
    let air = Atmosphere { attenuation: 0.0 };
    let scene = Scene::new(Arc::new(mesh), camera, Vec::new(), air, FluxModel::Radiometric).expect("valid");
    let margins = Referee::new(&scene).margins(SensorId::Camera, 4, 4).expect("a pixel");
    // To the rounding of the corners to f32.
    let is_there = |x: f64| (x - 0.64).abs() < 1e-5;
    assert!(is_there(margins.face.lo) && is_there(margins.face.hi), "{:?}", margins.face);
    // Where the ground and the post intersect nothing jumps, and the post ends farther away.
    assert_eq!(margins.surface.lo, 1.0);
}

/// The wall, `copies` times at one place.
fn walls(copies: usize) -> Scene {
    let wall = wall::wall_scene();
    let mesh = wall.mesh();
    let faces = vec![mesh.faces()[0]; copies];
    let many =
        Mesh::new(mesh.origin(), mesh.vertices().to_vec(), faces, vec![0; copies], mesh.materials().to_vec());
    Scene::new(
        Arc::new(many.expect("a mesh")),
        *wall.camera(),
        wall.beams().to_vec(),
        wall.atmosphere(),
        wall.flux_model(),
    )
    .expect("a scene")
}

/// A triangle that is there forty times has the margins of one; work that grew with the square of their number would grow
/// with the cube of it here, and the test would not end.
#[test]
fn faces_at_one_place_have_the_margins_of_one() {
    const COPIES: usize = 40;
    let (one, many) = (walls(1), walls(COPIES));
    let (one, many) = (Referee::new(&one), Referee::new(&many));
    let mut ends = 0;
    for i in 0..9 {
        let [(of_a, a), (of_b, b)] =
            [&one, &many].map(|referee| referee.verdict_with_margins(SensorId::Camera, i, 4).unwrap());
        // The same change at the same place. The proven radius depends in its last digits on how many faces were looked at.
        for (a, b) in [(a.face, b.face), (a.surface, b.surface)] {
            assert_eq!((a.hi, a.witness), (b.hi, b.witness), "column {i}");
            assert!((a.lo - b.lo).abs() <= 1.0 / f64::from(1_u32 << 30), "column {i}: {} {}", a.lo, b.lo);
        }
        assert_eq!(of_a.faces.len() * COPIES, of_b.faces.len(), "column {i}");
        ends += usize::from(b.surface.lo < 1.0);
    }
    // The column whose ray ends half a cell beside the wall's side, and the next one.
    assert!(ends >= 2, "{ends}");
    let sight = |referee: &Referee<'_>| referee.visibility(0, 0, 0, Displacement::ZERO);
    assert_eq!(sight(&one), sight(&many));
    assert!(sight(&many).unwrap().visible, "copies of a face hide each other");
}
