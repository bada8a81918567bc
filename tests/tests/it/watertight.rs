//! Watertightness: over a million rays exactly through edges and vertices, and as many within rounding of them, all
//! hit the mesh.

use std::sync::Arc;

use glam::{DQuat, DVec3};
use raypencil::{Beam, Camera, Mesh, Mounted, Pose, Quantities, Renderer, Request, SensorId, SensorMap};
use raypencil_tests::lattice::{ExpectedHit, Lattice, Sensor, hash, hash_unit};
use raypencil_tests::{at_origin, cells_missed, mesh, renderers, rig, scene, unindexed};

/// Parameter t of the vertices: a single one, so that the mesh is flat.
const FLAT: &[f64] = &[4.0];

/// Hills: neighbours differ by up to 7/256 of the range, several cells.
const HILLS: &[f64] = &[4.0, 4.015625, 4.03125, 4.046875, 4.0625, 4.078125, 4.09375, 4.109375];

/// Spikes: neighbours are up to three times as far, so that faces are needles along the rays. (On large sensors the
/// boxes of hundreds of such needles overlap.)
const SPIKES: &[f64] = &[2.0, 2.25, 2.5, 3.0, 4.0, 6.0];

/// Hills that the SPP cuts. A ray between two vertices hits unless both are nearer than the SPP: the mean of 7/8 and
/// any other, arithmetic or harmonic, is at least 1.029 (7/8 and 5/4).
const CUT: &[f64] = &[0.875, 1.25, 1.5];

/// Maximum range of these sensors, metres. No hit is farther than 6 * 0.62 m. The tracer pads its boxes by a few ulp
/// (of f32) of this range: with a longer one every ray would test hundreds of these small faces.
const MAX_RANGE_M: f64 = 8.0;

/// A camera whose rays are dyadic: pixels of 2^-11 m, f = 1/2 m.
fn camera(width: u32, height: u32) -> Sensor {
    Sensor::Camera(Camera { max_range: MAX_RANGE_M, ..rig::camera(width, height, 1.0 / 2048.0, 0.5) })
}

/// A beam whose rays are dyadic: cells of 2^-11 m across, rows 2^-7 m apart.
fn beam(columns: u32, rows: u32, grid_distance: f64) -> Sensor {
    let cell = [1.0 / 2048.0, 1.0 / 128.0];
    Sensor::Beam(Beam { max_range: MAX_RANGE_M, ..rig::beam(columns, rows, cell, grid_distance) })
}

/// Each renderer's range map of `sensor` before a mesh.
fn maps(sensor: &Sensor, scene_from_sensor: Pose, mesh: Arc<Mesh>) -> Vec<(String, SensorMap)> {
    let only =
        |camera| Request { camera, beams: !camera, quantities: Quantities::RANGE_MAP, ..Request::MAPS };
    let (scene, request) = match *sensor {
        Sensor::Camera(sensor) => {
            (scene(mesh, Mounted { scene_from_sensor, sensor }, Vec::new()), only(true))
        }
        Sensor::Beam(sensor) => {
            let idle = at_origin(rig::camera(1, 1, 0.01, 0.01));
            (scene(mesh, idle, vec![Mounted { scene_from_sensor, sensor }]), only(false))
        }
    };
    let id = if request.camera { SensorId::Camera } else { SensorId::Beam(0) };
    let render = |renderer: Box<dyn Renderer>| {
        let map = renderer.render(&scene, &request).map(id).expect("it was asked for").clone();
        (renderer.name().to_string(), map)
    };
    renderers().into_iter().map(render).collect()
}

/// Asserts that every ray hits or misses as the lattice predicts, and that a ray through a vertex has its range.
/// `max_relative_error` is the maximum error of such a range, relative to it.
fn assert_watertight(
    what: &str,
    lattice: &Lattice,
    sensor: &Sensor,
    maps: &[(String, SensorMap)],
    max_relative_error: f64,
) {
    for (name, map) in maps {
        let range = map.range.as_ref().unwrap();
        let mut wrong = Vec::new();
        for j in 0..map.height {
            for i in 0..map.width {
                let range = range.at(i, j).get();
                let fate = lattice.fate(i, j);
                if fate != ExpectedHit::Unknown && (fate == ExpectedHit::Hit) != range.is_some() {
                    wrong.push((i, j, range));
                }
                if let (Some(t), Some(range)) = (lattice.t_at(i, j), range) {
                    let [_, q] = sensor.ray(i64::from(i), i64::from(j));
                    let exact = t * q.length();
                    // No face hides a vertex: the mesh is a graph over the rays.
                    let error = (range - exact).abs();
                    assert!(
                        error <= max_relative_error * exact,
                        "{what}, {name}: vertex {i},{j} at {range} m, not {exact} m"
                    );
                }
            }
        }
        let first: Vec<_> = wrong.iter().take(5).collect();
        assert!(wrong.is_empty(), "{what}, {name}: {} rays, the first at {first:?}", wrong.len());
    }
    // On rays without a prediction the renderers must agree.
    let missed = maps.iter().map(|(_, map)| cells_missed(map)).collect::<Vec<_>>();
    assert!(
        missed[0] == missed[1],
        "{what}: the renderers miss {} and {} rays",
        missed[0].len(),
        missed[1].len()
    );
}

/// Maximum relative error of a range at a vertex: the bound 36 kappa u S / c of the comparison, with S below three
/// ranges and kappa / c below 2000 even on the spikes, which are cells wide and metres long.
const MAX_VERTEX_ERROR: f64 = 36.0 * 2000.0 * 1.2e-16 * 3.0;

#[test]
fn a_million_rays_exactly_on_edges_and_vertices_hit() {
    // The lattice ends exactly at the outermost rays, so that they pass through border edges and corners.
    let sensors = [
        ("camera, flat", camera(1025, 1025), FLAT),
        ("camera, hills", camera(1025, 1025), HILLS),
        ("camera, spikes", camera(129, 129), SPIKES),
        ("camera, cut by the SPP", camera(513, 513), CUT),
        ("beam, flat", beam(1025, 257, 0.5), FLAT),
        ("beam, hills", beam(1025, 257, 0.5), HILLS),
        ("beam, spikes", beam(257, 65, 0.5), SPIKES),
        ("beam, cut by the SPP", beam(513, 129, 0.5), CUT),
        // w / g = 4.004: a fan of 152 degrees.
        ("wide beam, hills", beam(1025, 129, 0.0625), HILLS),
    ];
    let (mut on_edges, mut exact_cameras) = (0, 0);
    for (seed, (what, sensor, ts)) in sensors.iter().enumerate() {
        let lattice = Lattice::before(*sensor, 0, seed as u64, ts);
        let (mesh, moved) = lattice.mesh(&Pose::IDENTITY);
        assert_eq!(moved, 0.0, "{what}: vertices are exact in f32");

        let (width, height) = sensor.size();
        let rays = u64::from(width) * u64::from(height);
        let count = lattice.count_rays_on_edges();
        match sensor {
            // All rays, by construction: see `lattice`.
            Sensor::Camera(_) => {
                assert_eq!(count, rays, "{what}");
                exact_cameras += count;
            }
            // All rays except some of those through diagonals, which are a quarter.
            Sensor::Beam(_) => assert!(4 * count >= 3 * rays, "{what}: {count} of {rays}"),
        }
        on_edges += count;
        assert_watertight(what, &lattice, sensor, &maps(sensor, Pose::IDENTITY, mesh), MAX_VERTEX_ERROR);
    }
    assert!(
        exact_cameras >= 1_000_000 && on_edges >= 2_900_000,
        "{on_edges}, {exact_cameras} of them pixels"
    );
}

/// The 24 rotations that permute the axes, as quaternions of small integers: (q p q*) / (q . q) is exact in floating
/// point.
fn axis_permutations() -> Vec<DQuat> {
    let mut rotations = Vec::new();
    for code in 0..81 {
        let digit = |place: i32| f64::from(code / 3_i32.pow(place as u32) % 3 - 1);
        let q = [digit(0), digit(1), digit(2), digit(3)];
        let nonzero = q.iter().filter(|x| **x != 0.0).count();
        // Quaternions with one, two or four entries of +-1. Of q and -q, the one with a positive first entry.
        let first = q.iter().find(|x| **x != 0.0);
        if [1, 2, 4].contains(&nonzero) && first.is_some_and(|x| *x > 0.0) {
            rotations.push(DQuat::from_xyzw(q[0], q[1], q[2], q[3]));
        }
    }
    assert_eq!(rotations.len(), 24);
    rotations
}

/// The sensors of the tests with many poses.
fn small_sensors() -> [(&'static str, Sensor, &'static [f64]); 7] {
    [
        ("camera, flat", camera(129, 129), FLAT),
        ("camera, hills", camera(129, 129), HILLS),
        ("camera, spikes", camera(33, 33), SPIKES),
        ("camera, cut by the SPP", camera(129, 129), CUT),
        ("beam, hills", beam(129, 65, 0.5), HILLS),
        ("beam, spikes", beam(33, 33, 0.5), SPIKES),
        ("beam, cut by the SPP", beam(129, 65, 0.125), CUT),
    ]
}

#[test]
fn rays_on_edges_hit_along_every_axis() {
    // Exact rotations and dyadic positions: the border is included.
    for (index, rotation) in axis_permutations().into_iter().enumerate() {
        for (what, sensor, ts) in small_sensors() {
            let pose = Pose { position: DVec3::new(1.25, -3.5, 0.125), rotation };
            let lattice = Lattice::before(sensor, 0, index as u64, ts);
            let (mesh, moved) = lattice.mesh(&pose);
            assert_eq!(moved, 0.0, "{what}: vertices are exact in f32");
            let what = format!("{what}, rotated by {rotation}");
            assert_watertight(&what, &lattice, &sensor, &maps(&sensor, pose, mesh), MAX_VERTEX_ERROR);
        }
    }
}

/// A sensor with the same rays, but with numbers that are rounded. Where the SPP cuts the lattice the sensor is not
/// changed, because its SPP would move.
fn a_third_as_large(sensor: Sensor, ts: &[f64]) -> Sensor {
    match sensor {
        _ if ts == CUT => sensor,
        Sensor::Camera(camera) => Sensor::Camera(Camera {
            pixel_pitch: camera.pixel_pitch.map(|pitch| pitch / 3.0),
            focal_length: camera.focal_length / 3.0,
            ..camera
        }),
        Sensor::Beam(beam) => Sensor::Beam(Beam {
            grid_distance: beam.grid_distance / 3.0,
            half_width: beam.half_width / 3.0,
            ..beam
        }),
    }
}

#[test]
fn rays_within_rounding_of_edges_hit() {
    // The same rotations and rays with numbers that are rounded: quaternions times 0.7, 0.3 and so on; sensors a third
    // as large. Every ray then misses its edge by about 1e-16 m. The lattice has one more ring of cells, because rays
    // at the border may miss.
    for (index, rotation) in axis_permutations().into_iter().enumerate() {
        for (what, sensor, ts) in small_sensors() {
            let lattice = Lattice::before(sensor, 1, 100 + index as u64, ts);
            let pose = Pose { position: DVec3::new(1.25, -3.5, 0.125), rotation };
            let (mesh, moved) = lattice.mesh(&pose);
            assert_eq!(moved, 0.0, "{what}: vertices are exact in f32");
            let scale = [0.7, 0.3, 1.9, 0.011][index % 4];
            let [x, y, z, w] = rotation.to_array().map(|entry| scale * entry);
            let pose = Pose { rotation: DQuat::from_xyzw(x, y, z, w), ..pose };
            let what = format!("{what}, rotated by {rotation} times {scale}");
            assert_watertight(
                &what,
                &lattice,
                &sensor,
                &maps(&sensor, pose, Arc::clone(&mesh)),
                MAX_VERTEX_ERROR,
            );

            let third = a_third_as_large(sensor, ts);
            let what = format!("{what}, a third as large");
            assert_watertight(&what, &lattice, &sensor, &maps(&third, pose, mesh), MAX_VERTEX_ERROR);
        }
    }
}

/// Rotations by integer quaternions at general angles, and positions of the sensor. With D = q . q the entries of the
/// matrix of (q p q*) / (q . q) are integer multiples of 1 / D.
const RATIONAL_POSES: &[([f64; 4], [f64; 3])] = &[
    // The scene's x of (x, y, z) is -2.5 - 0.6 x + 0.8 z, whatever y: on the flat lattice, z = 2 D / 32 = 3.125,
    // the whole middle column has x = 0, or -0, in which the order of an edge's ends must not differ.
    ([1.0, 6.0, 2.0, 3.0], [-2.5, -0.75, 0.5]),
    ([0.0, 0.0, 1.0, 2.0], [0.25, -0.75, 0.5]),
    ([1.0, 2.0, 3.0, 4.0], [0.25, -0.75, 0.5]),
    ([1.0, 1.0, 1.0, 2.0], [0.25, -0.75, 0.5]),
    ([0.0, 1.0, 1.0, 1.0], [0.0, 0.0, 0.0]),
    ([2.0, -1.0, 1.0, 0.0], [0.25, -0.75, 0.5]),
    ([-3.0, 1.0, 0.0, 1.0], [0.25, -0.75, 0.5]),
];

/// A sensor with the same rays, `factor` times as large.
fn enlarged(sensor: Sensor, factor: f64) -> Sensor {
    match sensor {
        Sensor::Camera(camera) => Sensor::Camera(Camera {
            pixel_pitch: camera.pixel_pitch.map(|pitch| pitch * factor),
            focal_length: camera.focal_length * factor,
            max_range: camera.max_range * factor,
            ..camera
        }),
        Sensor::Beam(beam) => Sensor::Beam(Beam {
            grid_distance: beam.grid_distance * factor,
            half_width: beam.half_width * factor,
            thickness: beam.thickness * factor,
            max_range: beam.max_range * factor,
            ..beam
        }),
    }
}

#[test]
fn rays_on_edges_hit_at_rational_rotations() {
    // Sensors D / 32 times as large: D cancels, and the lattice's vertices are dyadic in the scene. So the contract's
    // rays pass exactly through vertices and edges, while a renderer rounds every vertex or ray that it rotates. A
    // value that is computed differently for two neighbours opens a gap here.
    for (index, &([x, y, z, w], position)) in RATIONAL_POSES.iter().enumerate() {
        let pose = Pose { position: DVec3::from_array(position), rotation: DQuat::from_xyzw(x, y, z, w) };
        let factor = (x * x + y * y + z * z + w * w) / 32.0;
        for (what, sensor, ts) in small_sensors() {
            let sensor = enlarged(sensor, factor);
            let lattice = Lattice::before(sensor, 1, 700 + index as u64, ts);
            let (mesh, moved) = lattice.mesh(&pose);
            // The rotation is rounded by at most an ulp of 8 m. Rounding to f32 would add 1e-8 m.
            assert!(moved <= 1e-14, "{what}: vertices are exact in f32, not {moved} m off");
            let what = format!("{what}, quaternion {x}, {y}, {z}, {w}");
            let apart = taken_apart(&mesh);
            assert_watertight(&what, &lattice, &sensor, &maps(&sensor, pose, mesh), MAX_VERTEX_ERROR);
            assert_watertight(&what, &lattice, &sensor, &maps(&sensor, pose, apart), MAX_VERTEX_ERROR);
        }
    }
}

#[test]
fn rays_near_edges_hit_at_any_pose() {
    // Any rotation, up to 170 m from the origin. Vertices are rounded to f32, by up to 1e-5 m; cells are 2^-10 t m
    // wide, at least 8e-4 m, so that none folds over. The lattice has one more ring of cells, because rays at the
    // border may miss.
    for seed in 0..30 {
        let number = |index| hash_unit(1000 + seed, index);
        let far = [0.0, 10.0, 100.0][seed as usize % 3];
        let position = DVec3::new(number(0), number(1), number(2)) * far;
        let q = [number(3), number(4), number(5), number(6)];
        if q.iter().map(|x| x * x).sum::<f64>() < 0.01 {
            continue;
        }
        let pose = Pose { position, rotation: DQuat::from_xyzw(q[0], q[1], q[2], q[3]) };
        for (what, sensor, ts) in small_sensors() {
            let lattice = Lattice::before(sensor, 1, seed, ts);
            let (mesh, moved) = lattice.mesh(&pose);
            assert!(moved <= 2e-5, "{moved} m");
            // A vertex that moves sideways changes the range by its slope, which has no bound.
            let what = format!("{what}, pose {pose:?}");
            assert_watertight(&what, &lattice, &sensor, &maps(&sensor, pose, mesh), f64::INFINITY);
        }
    }
}

/// The mesh with every face on vertices of its own, in another order and with another first corner. Half of the zero
/// coordinates become -0.
fn taken_apart(indexed: &Mesh) -> Arc<Mesh> {
    let split = unindexed(indexed);
    let mut vertices = split.vertices().to_vec();
    for (index, vertex) in vertices.iter_mut().enumerate() {
        if hash(9, index as u64).is_multiple_of(2) {
            for coordinate in vertex.iter_mut().filter(|coordinate| **coordinate == 0.0) {
                *coordinate = -0.0;
            }
        }
    }
    let mut faces = split.faces().to_vec();
    faces.sort_by_key(|face| hash(7, u64::from(face[0])));
    for face in &mut faces {
        let by = hash(8, u64::from(face[0])) as usize % 3;
        face.rotate_left(by);
    }
    mesh(vertices, faces)
}

#[test]
fn edges_are_shared_by_position_not_by_index() {
    for (index, (what, sensor, ts)) in small_sensors().into_iter().enumerate() {
        // Exact rays, with the border. (Rays within rounding: `rays_on_edges_hit_at_rational_rotations`.)
        let lattice = Lattice::before(sensor, 0, 500 + index as u64, ts);
        let (indexed, _) = lattice.mesh(&Pose::IDENTITY);
        let apart = taken_apart(&indexed);
        let zero = |x: &f32| *x == 0.0 && x.is_sign_negative();
        assert!(apart.vertices().iter().flatten().any(zero), "{what}: expected a coordinate of -0");
        assert_watertight(what, &lattice, &sensor, &maps(&sensor, Pose::IDENTITY, apart), MAX_VERTEX_ERROR);
    }
}
