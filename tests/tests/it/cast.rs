//! Any rays on any triangles: the tracer against the exact answer.

use glam::DVec3;
use proptest::prelude::*;
use raypencil::referee::{ExactCast, Ruling};
use raypencil::tracer::{CastTraverser, TracerCast};
use raypencil::{
    Atmosphere, Beam, Camera, CastRay, ExactRenderer, FaceId, FluxModel, Lens, Material, Mesh, Mounted, Pose,
    Precision, Reading, Renderer, Request, Scene, Sides, Triangles,
};

/// 2^-53.
const U: f64 = f64::EPSILON / 2.0;

/// What became of the rays of a test.
#[derive(Debug, Default)]
struct Tally {
    same: u64,
    ties: u64,
    rounding: u64,
    hits: u64,
}

/// Compares both sides of a ray with the exact answer; what differs must be excused by rounding, with a witness.
fn compare(
    exact: &ExactCast<'_>,
    tracer: &mut CastTraverser<'_>,
    ray: &CastRay,
    tally: &mut Tally,
) -> Result<(), TestCaseError> {
    for sides in [Sides::Both, Sides::Fronts] {
        let traced = tracer.first(ray, sides).map(|hit| hit.face);
        let first = exact.first(ray, sides);
        let stated = Reading::of(traced, |_| false);
        match exact.rule(ray, sides, stated, Precision::F64) {
            Ruling::Exact | Ruling::Tie => tally.same += 1,
            Ruling::Rounding(by) => {
                let most = exact.lateral_error(ray, Precision::F64);
                prop_assert!(by.max_norm() <= most, "{:?}", by);
                tally.rounding += 1;
            }
            Ruling::Wrong => {
                return Err(TestCaseError::fail(format!(
                    "{ray:?}, {sides:?}: traced {traced:?}, true {first:?}"
                )));
            }
        }
        tally.hits += u64::from(!first.is_empty());
        tally.ties += u64::from(first.len() > 1);
        // Any hit: a boolean that follows from the first.
        prop_assert_eq!(tracer.any(ray, sides), traced.is_some());
    }
    Ok(())
}

/// A ground of 2 (n - 1)^2 faces whose heights are no f32 numbers.
fn ground(n: u32, place: DVec3, heights: &[f64]) -> Triangles {
    let vertices = (0..n * n)
        .map(|k| {
            let height = heights[k as usize % heights.len()];
            (place + DVec3::new(f64::from(k % n) * 0.1, f64::from(k / n) * 0.1, height)).to_array()
        })
        .collect();
    let cells = (0..n - 1).flat_map(|j| (0..n - 1).map(move |i| j * n + i));
    let faces = cells.flat_map(|k| [[k, k + 1, k + n], [k + 1, k + n + 1, k + n]]).collect();
    Triangles::new(vertices, faces).unwrap()
}

/// Rays on a ground, aimed at its vertices, its edges and anywhere.
fn aimed(mesh: &Triangles, place: DVec3, draws: &[([f64; 3], [f64; 2], usize)]) -> Vec<CastRay> {
    draws
        .iter()
        .enumerate()
        .map(|(k, &(from, [u, v], face))| {
            let [a, b, c] = mesh.corners(FaceId((face % mesh.faces().len()) as u32));
            let at = match k % 3 {
                0 => a,
                1 => a + (b - a) * u,
                _ => a + (b - a) * (0.5 * u) + (c - a) * (0.5 * v),
            };
            let origin = place + DVec3::from_array(from);
            CastRay::new(origin, at - origin)
        })
        .collect()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 60, ..ProptestConfig::default() })]

    /// Near the origin and a thousand kilometres away, for vertices of f64 and of f32.
    #[test]
    fn the_tracer_is_right_or_within_rounding(
        heights in prop::collection::vec(-0.1_f64..0.1, 30..60),
        far in prop_oneof![Just(0.0), Just(1e6)],
        is_single in any::<bool>(),
        draws in prop::collection::vec(
            ([-2.0_f64..3.0, -2.0_f64..3.0, 0.2_f64..3.0], [0.0_f64..1.0, 0.0_f64..1.0], 0_usize..1000),
            120,
        ),
    ) {
        let place = DVec3::new(far, -0.5 * far, 0.0);
        let heights: Vec<f64> =
            if is_single { heights.iter().map(|&h| f64::from(h as f32)).collect() } else { heights };
        let mesh = ground(8, place, &heights);
        let (exact, tracer) = (ExactCast::new(&mesh), TracerCast::new(&mesh));
        let mut traverser = tracer.traverser();
        let mut tally = Tally::default();
        for ray in aimed(&mesh, place, &draws) {
            compare(&exact, &mut traverser, &ray, &mut tally)?;
        }
        // Most rays hit; what is aimed at exactly is met within rounding only.
        prop_assert!(tally.hits > 120 && tally.same > tally.rounding, "{tally:?}");
    }

    /// On a lattice all of the tracer's arithmetic is exact: its hits are all hits, at the very same t.
    #[test]
    fn on_a_lattice_the_tracer_is_exact(
        vertices in prop::collection::vec([-3_i32..=3, -3_i32..=3, -3_i32..=3], 3..9),
        corners in prop::collection::vec([0_usize..9, 0_usize..9, 0_usize..9], 1..14),
        rays in prop::collection::vec(([-4_i32..=4, -4_i32..=4, -4_i32..=4], [-3_i32..=3, -3_i32..=3, -3_i32..=3]), 40),
        exponent in -200_i32..60,
    ) {
        let scale = libm::scalbn(1.0, exponent);
        let place = |v: [i32; 3]| v.map(|x| f64::from(x) * scale);
        let faces = corners.iter().map(|corners| corners.map(|k| (k % vertices.len()) as u32)).collect();
        let mesh = Triangles::new(vertices.iter().map(|&v| place(v)).collect(), faces).unwrap();
        let (exact, tracer) = (ExactCast::new(&mesh), TracerCast::new(&mesh));
        let mut traverser = tracer.traverser();
        for (origin, direction) in rays.into_iter().filter(|(_, direction)| *direction != [0; 3]) {
            let ray = CastRay::new(DVec3::from_array(place(origin)), DVec3::from_array(direction.map(f64::from)));
            for sides in [Sides::Both, Sides::Fronts] {
                let groups = exact.all(&ray, sides);
                let expected: Vec<(FaceId, f64)> = groups
                    .iter()
                    .flat_map(|group| &group.faces)
                    .map(|met| (met.face, exact.values(&ray, met.face).unwrap().t.double))
                    .collect();
                let all = traverser.all(&ray, sides);
                let found: Vec<(FaceId, f64)> = all.iter().map(|hit| (hit.face, hit.t)).collect();
                prop_assert_eq!(&found, &expected);
                let first = traverser.first(&ray, sides);
                prop_assert_eq!(first.map(|hit| (hit.face, hit.t)), expected.first().copied());
                for hit in all {
                    let truth = exact.values(&ray, hit.face).unwrap();
                    prop_assert_eq!(hit.side, truth.side);
                    prop_assert_eq!(hit.barycentric, truth.barycentric.map(|weight| weight.double));
                    prop_assert!((hit.range - truth.range.double).abs() <= 4.0 * U * truth.range.double);
                    prop_assert!((hit.cos_incidence - truth.cos_incidence.double).abs() <= 16.0 * U);
                    let apart = hit.point - DVec3::from_array(truth.point.map(|part| part.double));
                    prop_assert!(apart.length() <= 16.0 * U * 16.0 * scale);
                    let apart = hit.normal - DVec3::from_array(truth.normal.map(|part| part.double));
                    prop_assert!(apart.length() <= 8.0 * U);
                }
            }
        }
    }
}

#[test]
fn rays_of_a_set_are_answered_in_their_order() {
    let mesh = ground(8, DVec3::ZERO, &[0.0]);
    let down = |x: f64| CastRay::new(DVec3::new(x, 0.05, 1.0), DVec3::new(0.0, 0.0, -1.0));
    let rays: Vec<CastRay> = (0..1000).map(|k| down(0.7 * f64::from(k) / 500.0 - 0.1)).collect();
    let set = raypencil::RaySet::new(rays.clone(), Sides::Both).unwrap();
    let tracer = TracerCast::new(&mesh);
    let found = tracer.first_of(&set);
    let one_by_one: Vec<_> = rays.iter().map(|ray| tracer.traverser().first(ray, Sides::Both)).collect();
    assert_eq!(found, one_by_one);
    assert!(found.iter().flatten().count() > 400 && found.iter().any(Option::is_none));
}

/// Two walls with gaps and a floor, in numbers of few bits, before sensors whose rays are exact in f64.
fn exact_scene() -> Scene {
    let corners = [
        [-0.5, -0.5, 2.0],
        [0.5, -0.5, 2.0],
        [0.5, 0.5, 2.0],
        [-0.5, 0.5, 2.0],
        [-2.0, -2.0, 4.0],
        [2.0, -2.0, 4.0],
        [2.0, 2.0, 4.0],
        [-2.0, 2.0, 4.0],
    ];
    // Fronts towards the sensors, which look along z; the last face is a back.
    let faces = vec![[0, 2, 1], [0, 3, 2], [4, 6, 5], [4, 7, 6], [0, 1, 5]];
    let plaster = Material { name: "plaster".into(), reflectivity: 0.5 };
    let mesh = Mesh::new(DVec3::ZERO, corners.to_vec(), faces, vec![0; 5], vec![plaster]).unwrap();
    let camera = Camera {
        width: 32,
        height: 24,
        pixel_pitch: [1.0 / 16.0; 2],
        focal_length: 1.0,
        principal_point: [16.0, 12.0],
        aperture: 0.0625,
        lens: Lens::CLEAR,
        max_range: 4.25,
    };
    let camera = Mounted { scene_from_sensor: Pose::IDENTITY, sensor: camera };
    let (_, beams) = raypencil::rig::default_rig(16, DVec3::ZERO, 0.0);
    let beam = Beam {
        half_width: 1.0,
        thickness: 0.25,
        grid_distance: 1.0,
        columns: 64,
        rows: 4,
        max_range: 4.25,
        ..beams[0].sensor
    };
    let beams = vec![Mounted { scene_from_sensor: Pose::IDENTITY, sensor: beam }];
    Scene::new(mesh.into(), camera, beams, Atmosphere { attenuation: 0.0 }, FluxModel::Radiometric).unwrap()
}

/// A sensor's rays, written as numbers, get the answers that the sensor gets, where these numbers are exact.
#[test]
fn rays_of_sensors_written_as_numbers_get_the_same_answers() {
    let scene = exact_scene();
    let mesh = Triangles::from(scene.mesh().as_ref());
    let exact = ExactCast::new(&mesh);
    let output = ExactRenderer.render(&scene, &Request::MAPS);
    let mut counts = [0; 3];
    for map in output.maps() {
        let (faces, ranges) = (map.face.as_ref().unwrap(), map.range.as_ref().unwrap());
        for j in 0..map.height {
            for i in 0..map.width {
                let ray = scene.ray(map.sensor, i, j).unwrap();
                // Numbers of few bits: nothing was rounded when they were formed.
                assert!(ray.direction.to_array().iter().all(|part| (part * 4096.0).fract() == 0.0));
                // The contract's ray begins on the plane of its grid or image, at t = 1, and ends at its range.
                let cast = CastRay { t_min: 1.0, ..CastRay::new(ray.origin, ray.direction) };
                let first = exact.first(&cast, Sides::Fronts);
                let hit = first.first().and_then(|face| exact.values(&cast, *face));
                let is_within = |range: f64| range <= scene.max_range(map.sensor).unwrap();
                let hit = hit.filter(|hit| is_within(hit.range.double));
                assert_eq!(faces.at(i, j).get(), hit.map(|hit| hit.face), "{} {i},{j}", map.sensor);
                assert_eq!(ranges.at(i, j).get(), hit.map(|hit| hit.range.double), "{} {i},{j}", map.sensor);
                counts[usize::from(hit.is_some())] += 1;
                counts[2] += usize::from(first.len() > 1);
            }
        }
    }
    let [misses, hits, ties] = counts;
    assert!(misses > 100 && hits > 200 && ties > 4, "{counts:?}");
}
