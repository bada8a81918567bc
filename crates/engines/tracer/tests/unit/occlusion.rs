//! Unit tests of `occlusion`, against an exhaustive search and against integer arithmetic.

use std::sync::Arc;

use proptest::prelude::*;
use raypencil_scene::{
    Atmosphere, Beam, Camera, FaceId, FluxModel, Lens, Material, Mesh, Mounted, Pose, Profile, Renderer,
    Request, Sampling, Scene,
};
use raypencil_terrain::{RandomGround, height_at};

use super::*;
use crate::camera::PosedCamera;
use crate::closest_hit::ClosestHitTraverser;
use crate::rays::{PencilGrid, SensorRays};

fn triangles(mesh: &Mesh) -> Vec<Triangle> {
    let corners = |face: &[u32; 3]| face.map(|v| mesh.vertices()[v as usize]);
    (0..).zip(mesh.faces()).map(|(k, face)| Triangle::new(corners(face), FaceId(k))).collect()
}

/// The answer for one line of sight, the same in the first lane and in the last.
fn is_occluded(traverser: &mut OcclusionTraverser, line_of_sight: LineOfSight) -> bool {
    let mut lines = [None; 64];
    lines[0] = Some(line_of_sight);
    let first = traverser.occluded(&lines);
    lines.swap(0, 63);
    assert_eq!(traverser.occluded(&lines), first << 63);
    first == 1
}

/// The same answer by testing every face, without a tree.
fn exhaustive(triangles: &[Triangle], line_of_sight: &LineOfSight) -> bool {
    triangles.iter().any(|triangle| line_of_sight.is_blocked_by(triangle))
}

fn translated(mesh: &Mesh, offset: f32) -> Mesh {
    let vertices = mesh.vertices().iter().map(|[x, y, z]| [x + offset, *y, *z]).collect();
    let (faces, of_faces) = (mesh.faces().to_vec(), mesh.face_materials().to_vec());
    Mesh::new(mesh.origin(), vertices, faces, of_faces, mesh.materials().to_vec()).unwrap()
}

/// A rig on the middle of a ground, translated by `offset` metres along x. Its beams have 128 x 4 pencils. The camera
/// is low, so that much is hidden from it.
fn rig_on(mesh: Mesh, offset: f32) -> Scene {
    let z = height_at(&mesh, 0.0, 0.0).unwrap();
    let mesh = translated(&mesh, offset);
    let scene_from_vehicle = Pose::from_position(DVec3::new(f64::from(offset), 0.0, z));
    let mount = |height: f64, down: f64| {
        scene_from_vehicle
            * Pose::from_position(DVec3::new(0.3, 0.0, height))
            * Pose::from_axis_angle(DVec3::Y, down.to_radians())
            * Pose::VEHICLE_FROM_FORWARD_SENSOR
    };
    let camera = Camera {
        width: 1024,
        height: 1024,
        pixel_pitch: [9e-6; 2],
        focal_length: 8e-3,
        principal_point: [512.0; 2],
        aperture: 2e-3,
        lens: Lens::CLEAR,
        max_range: 20.0,
    };
    let beam = Beam {
        columns: 128,
        rows: 4,
        thickness: 5e-3,
        grid_distance: 0.1,
        half_width: 0.0577,
        max_range: 20.0,
        power: 1.0,
        wavelength: 810e-9,
        profile: Profile::Paper,
    };
    let beams = [(1.8, 31.0), (2.0, 22.0)]
        .map(|(height, down)| Mounted { scene_from_sensor: mount(height, down), sensor: beam });
    let camera = Mounted { scene_from_sensor: mount(0.5, 5.0), sensor: camera };
    let air = Atmosphere { attenuation: 0.0 };
    Scene::new(Arc::new(mesh), camera, beams.to_vec(), air, FluxModel::Radiometric).unwrap()
}

#[test]
fn returns_on_nasty_grounds_agree_with_an_exhaustive_search_on_every_pencil() {
    let mut counts = [0; 2];
    for (seed, offset) in [(1, 0.0), (2, 0.0), (3, 0.0), (4, 3e4), (5, 0.0), (6, 2e6), (7, 0.0), (8, 0.0)] {
        let scene = rig_on(RandomGround::nasty(seed, 2500).build().into_mesh().unwrap(), offset);
        let (all_triangles, camera) = (triangles(scene.mesh()), PosedCamera::new(scene.camera()));
        let sampling = if seed % 2 == 0 { Sampling::Centres } else { Sampling::Jittered { seed } };
        let frame = crate::Tracer::new().render(&scene, &Request { sampling, ..Request::EVERYTHING });
        let hierarchy = Hierarchy::build(scene.mesh(), crate::hierarchy::max_trace_distance(&scene));
        for (index, beam) in scene.beams().iter().enumerate() {
            let rays = SensorRays::of_beam(beam, PencilGrid::new(beam.sensor, index, sampling));
            let visible = frame.returns[index].visible.as_ref().unwrap();
            let cos_view = frame.returns[index].cos_view.as_ref().unwrap();
            for (i, j) in (0..4).flat_map(|j| (0..128).map(move |i| (i, j))) {
                let pencil = rays.ray(i, j);
                let hit = ClosestHitTraverser::new(&hierarchy).closest_hit(&pencil, rays.max_range());
                let expected = hit.is_some_and(|hit| {
                    let point = hit.hit(&pencil, 0.1).point;
                    let observed = camera.observe(point);
                    let depth = observed.in_camera.z;
                    let line_of_sight = LineOfSight::new(camera.centre, 8e-3, point, depth, pencil, hit);
                    let faces_camera = cos_view.at(i, j).get().unwrap() > 0.0;
                    faces_camera && observed.pixel.is_some() && !exhaustive(&all_triangles, &line_of_sight)
                });
                assert_eq!(visible.at(i, j), expected, "beam {index}, pencil ({i}, {j}) of seed {seed}");
                counts[usize::from(expected)] += 1;
            }
        }
    }
    // Neither answer is rare.
    assert!(counts.iter().all(|&count| count > 500), "{counts:?} invisible and visible");
}

proptest! {
    #![proptest_config(ProptestConfig { max_shrink_iters: 200, ..ProptestConfig::default() })]

    // Pencils from anywhere, aimed at vertices, edges and insides of faces. The camera stands where its line of sight
    // runs through a vertex, an edge or the inside of another face, or along an axis.
    #[test]
    fn the_tree_hides_what_an_exhaustive_search_hides(
        seed in any::<u64>(),
        faces in 200usize..2000,
        offset in prop_oneof![Just(0.0f32), Just(3e4), Just(2e6)],
        aims in prop::collection::vec(
            (
                any::<prop::sample::Index>(),
                any::<prop::sample::Index>(),
                0u8..4,
                0.0f64..1.0,
                0.0f64..1.0,
                0.1f64..10.0,
            ),
            40,
        ),
    ) {
        let mesh = translated(&RandomGround::nasty(seed, faces).build().into_mesh().unwrap(), offset);
        let all_triangles = triangles(&mesh);
        let hierarchy = Hierarchy::build(&mesh, 60.0);
        let mut occlusion = OcclusionTraverser::new(&hierarchy);
        let mut traverser = ClosestHitTraverser::new(&hierarchy);
        let place = |face: prop::sample::Index, kind: u8, u: f64, v: f64| {
            let [a, b, c] = all_triangles[face.index(all_triangles.len())].vertices.map(widen);
            match kind {
                0 => a,
                1 => a + (b - a) * u,
                _ => a + ((b - a) * u).lerp((c - a) * u, v),
            }
        };
        for (target, between, kind, u, v, far) in aims {
            let target = place(target, kind, u, v);
            let from = target + DVec3::new(v - 0.5, u - 0.5, 1.0) * far;
            let pencil = TracedRay::new(from, (target - from).normalize() * 0.01);
            let Some(hit) = traverser.closest_hit(&pencil, 20.0) else { continue };
            let point = hit.hit(&pencil, 0.01).point;
            let centre = if kind == 3 {
                point + [DVec3::X, DVec3::NEG_Y, DVec3::Z][between.index(3)] * far
            } else {
                let through = place(between, 2 - kind, v, u);
                // A fifth farther away than the possible occluder, and within the trace distance of the boxes.
                point + ((through - point) * 1.2).clamp_length_max(50.0)
            };
            if centre == point {
                continue;
            }
            let depth = 0.8 * (point - centre).length();
            let line_of_sight = LineOfSight::new(centre, 0.008, point, depth, pencil, hit);
            prop_assert_eq!(
                is_occluded(&mut occlusion, line_of_sight),
                exhaustive(&all_triangles, &line_of_sight),
                "seed {}", seed
            );
        }
    }
}

/// Pseudo-random numbers from 0 to 1: the upper bits of Knuth's MMIX linear congruential generator.
struct RandomNumbers(u64);

impl RandomNumbers {
    fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    fn below(&mut self, count: u32) -> u32 {
        (self.unit() * f64::from(count)) as u32
    }
}

/// A pencil that ends at `point`, and its hit. The face of that hit is far away from any occluder and slanting, so that
/// the occluder alone decides.
fn pencil_to(point: DVec3) -> (TracedRay, Intersection) {
    let corners = [[0.0, 0.0, -900.0], [1.0, 0.0, -901.0], [0.0, 1.0, -903.0]];
    let hit = Intersection { triangle: Triangle::new(corners, FaceId(u32::MAX - 1)), t: 1.0 };
    (TracedRay::new(point - DVec3::new(0.0, 0.3, 1.0), DVec3::new(0.0, 0.3, 1.0)), hit)
}

#[test]
fn no_line_of_sight_slips_through_a_shared_edge_or_corner() {
    // A crumpled sheet of 24 x 24 cells, so steep that a line from above meets fronts and backs. The sheet is a
    // continuous surface: every line from a point above it to a point below it crosses it.
    const CELLS: u32 = 24;
    let mut random = RandomNumbers(7);
    let mut vertices = Vec::new();
    for (column, row) in (0..=CELLS).flat_map(|row| (0..=CELLS).map(move |column| (column, row))) {
        let mut shaken = |index: u32| 0.3 * f64::from(index) + 0.2 * random.unit();
        let (x, y) = (shaken(column) as f32, shaken(row) as f32);
        vertices.push([x, y, (2.0 * random.unit() - 1.0) as f32]);
    }
    let mut faces = Vec::new();
    for (column, row) in (0..CELLS).flat_map(|row| (0..CELLS).map(move |column| (column, row))) {
        let at = |x: u32, y: u32| (row + y) * (CELLS + 1) + column + x;
        let (a, b, c, d) = (at(0, 0), at(1, 0), at(1, 1), at(0, 1));
        faces.extend(if random.unit() < 0.5 { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] });
    }
    let kinds = vec![Material { name: "sheet".into(), reflectivity: 0.5 }];
    let mesh = Mesh::new(DVec3::ZERO, vertices, faces.clone(), vec![0; faces.len()], kinds).unwrap();
    let hierarchy = Hierarchy::build(&mesh, 60.0);
    let mut occlusion = OcclusionTraverser::new(&hierarchy);
    for _ in 0..200_000 {
        // Through a vertex, an edge, or the inside of a face at least five cells from the border. The lines lean by
        // less than 0.5, so they cross the heights -1 to 1 inside the sheet.
        let (column, row) = (5 + random.below(CELLS - 10), 5 + random.below(CELLS - 10));
        let face = faces[(2 * (row * CELLS + column) + random.below(2)) as usize];
        let [a, b, c] = face.map(|v| widen(mesh.vertices()[v as usize]));
        let target = match random.below(3) {
            0 => a,
            1 => a.lerp(b, random.unit()),
            _ => a.lerp(b, random.unit()).lerp(c, random.unit()),
        };
        let mut lean = || if random.below(4) == 0 { 0.0 } else { random.unit() - 0.5 };
        let along = DVec3::new(lean(), lean(), 1.0);
        let centre = target + along * (3.0 + random.unit());
        let point = target - along * (3.0 + random.unit());
        let (pencil, hit) = pencil_to(point);
        let line_of_sight = LineOfSight::new(centre, 1e-3, point, (point - centre).length(), pencil, hit);
        assert!(is_occluded(&mut occlusion, line_of_sight), "from {centre} to {point}");
    }
}

#[test]
fn on_whole_numbers_the_answer_is_that_of_integer_arithmetic() {
    // Vertices, centre and point lie on a lattice, where f64 is exact. Lines that touch a face, run along an edge or
    // end on a face are frequent there. Expected: the definition in i64, by volumes of tetrahedra.
    let mut random = RandomNumbers(3);
    let mut counts = [0; 2];
    for _ in 0..300_000 {
        let mut whole = || [0; 3].map(|_: i64| i64::from(random.below(7)) - 3);
        let [a, b, c, o, p] = [whole(), whole(), whole(), whole(), whole()];
        let minus = |a: [i64; 3], b: [i64; 3]| [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
        let volume = |u: [i64; 3], v: [i64; 3], w: [i64; 3]| {
            u[0] * (v[1] * w[2] - v[2] * w[1])
                + u[1] * (v[2] * w[0] - v[0] * w[2])
                + u[2] * (v[0] * w[1] - v[1] * w[0])
        };
        let (d, [ao, bo, co]) = (minus(p, o), [a, b, c].map(|v| minus(v, o)));
        if d == [0; 3] {
            continue;
        }
        // The line passes on one side of all three edges; u = n.(a - o) / n.d from 1/4 to below 1.
        let sides = [volume(d, ao, bo), volume(d, bo, co), volume(d, co, ao)];
        let within = sides.iter().all(|&side| side >= 0) || sides.iter().all(|&side| side <= 0);
        let along = volume(d, minus(b, a), minus(c, a));
        let to_plane = volume(ao, minus(b, a), minus(c, a));
        let (to_plane, along) = (to_plane * along.signum(), along.abs());
        let expected = within && along != 0 && 4 * to_plane >= along && to_plane < along;

        let float = |v: [i64; 3]| DVec3::new(v[0] as f64, v[1] as f64, v[2] as f64);
        let corners = [a, b, c].map(|v| v.map(|x| x as f32));
        let triangle = Triangle::new(corners, FaceId(0));
        let (pencil, hit) = pencil_to(float(p));
        let line_of_sight = LineOfSight::new(float(o), 1.0, float(p), 4.0, pencil, hit);
        assert_eq!(line_of_sight.is_blocked_by(&triangle), expected, "{a:?} {b:?} {c:?} from {o:?} to {p:?}");
        counts[usize::from(expected)] += 1;
    }
    assert!(counts[1] > 5000, "{counts:?} free and blocked");
}
