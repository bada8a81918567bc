//! Unit tests of `cast`: the tree loses no hit that an exhaustive search has, at any scale and from any distance.

use glam::DVec3;
use proptest::prelude::*;
use raypencil_scene::Side;

use super::*;

/// All crossings of a ray by asking every face.
fn exhaustive(cast: &TracerCast, ray: &CastRay, sides: Sides) -> Vec<Crossing> {
    let scaled = cast.frame.ray(ray);
    let mut met: Vec<Crossing> =
        cast.faces.iter().filter_map(|face| face.crossing(ray, &scaled, sides)).collect();
    met.sort_by(|a, b| a.t.total_cmp(&b.t).then(a.face.id.cmp(&b.face.id)));
    met
}

/// Three numbers from -1 to 1.
fn within_one() -> impl Strategy<Value = DVec3> {
    [-1.0_f64..=1.0, -1.0_f64..=1.0, -1.0_f64..=1.0].prop_map(DVec3::from_array)
}

/// What the walks of a case were, so that none of the three stays untried.
#[derive(Debug, Default)]
struct Walks {
    nothing: u32,
    tree: u32,
    all_faces: u32,
    hits: u32,
}

impl Walks {
    fn count(&mut self, walk: Walk) {
        match walk {
            Walk::Nothing => self.nothing += 1,
            Walk::Tree { .. } => self.tree += 1,
            Walk::AllFaces => self.all_faces += 1,
        }
    }
}

/// Aims rays at corners, edges and points of faces of a mesh of this size at this place, from far and near.
fn compare_with_exhaustive(
    size: f64,
    place: DVec3,
    corners: &[[DVec3; 3]],
    aims: &[(DVec3, DVec3, i32, f64)],
    walks: &mut Walks,
) -> Result<(), TestCaseError> {
    let vertices: Vec<[f64; 3]> =
        corners.iter().flatten().map(|&corner| (place + corner * size).to_array()).collect();
    let faces: Vec<[u32; 3]> = (0..corners.len() as u32).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
    let mesh = Triangles::new(vertices, faces).unwrap();
    let cast = TracerCast::new(&mesh);
    let mut traverser = cast.traverser();
    for (k, &(from, weights, exponent, length)) in aims.iter().enumerate() {
        let [a, b, c] = mesh.corners(FaceId((k % corners.len()) as u32));
        // A corner, a point of an edge, a point of the face.
        let at = match k % 3 {
            0 => a,
            1 => a + (b - a) * weights.x.abs(),
            _ => a + (b - a) * (0.5 * weights.x.abs()) + (c - a) * (0.5 * weights.y.abs()),
        };
        // From 2^exponent sizes away.
        let origin = place + from * size * libm::scalbn(1.0, exponent);
        let direction = (at - origin) * length;
        let mut ray = CastRay::new(origin, direction);
        if ray.validate("ray").is_err() {
            continue;
        }
        if k % 4 == 3 {
            (ray.t_min, ray.t_max) = (0.5 / length, 1.5 / length);
        }
        walks.count(cast.frame.ray(&ray).walk);
        for sides in [Sides::Both, Sides::Fronts] {
            let expected = exhaustive(&cast, &ray, sides);
            let scaled = cast.frame.ray(&ray);
            let all: Vec<TracedHit> = expected.iter().map(|crossing| crossing.hit(&ray, &scaled)).collect();
            prop_assert_eq!(traverser.all(&ray, sides), all.clone());
            prop_assert_eq!(traverser.first(&ray, sides), all.first().copied());
            prop_assert_eq!(traverser.any(&ray, sides), !all.is_empty());
            walks.hits += u32::from(!all.is_empty());
            if sides == Sides::Fronts {
                prop_assert!(all.iter().all(|hit| hit.side == Side::Front));
            }
        }
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, ..ProptestConfig::default() })]

    #[test]
    fn the_tree_loses_no_hit(
        exponent in -60_i32..60,
        moved in prop_oneof![Just(0.0), Just(1.0), Just(1e6), Just(1e12)],
        direction in within_one(),
        corners in prop::collection::vec([within_one(), within_one(), within_one()], 1..40),
        aims in prop::collection::vec(
            (within_one(), within_one(), -3_i32..40, prop_oneof![Just(1.0), Just(1e-9), Just(1e9)]),
            60,
        ),
    ) {
        let size = libm::scalbn(1.0, exponent);
        compare_with_exhaustive(size, direction * moved * size, &corners, &aims, &mut Walks::default())?;
    }
}

#[test]
fn every_kind_of_walk_is_taken() {
    let triangle = |z: f64| [[-1.0, -1.0, z], [1.0, -1.0, z], [0.0, 1.0, z]].map(DVec3::from_array);
    let corners: Vec<[DVec3; 3]> = (0..20).map(|k| triangle(f64::from(k) / 20.0)).collect();
    let aims: Vec<_> =
        (-2..40).map(|exponent| (DVec3::new(0.3, 0.1, 1.0), DVec3::splat(0.25), exponent, 1.0)).collect();
    let mut walks = Walks::default();
    compare_with_exhaustive(1.0, DVec3::ZERO, &corners, &aims, &mut walks).unwrap();
    assert!(walks.tree > 20 && walks.all_faces > 5 && walks.hits > 50, "{walks:?}");
    let cast = TracerCast::new(
        &Triangles::new(vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], vec![[0, 1, 2]]).unwrap(),
    );
    let beside = CastRay::new(DVec3::new(5.0, 5.0, 5.0), DVec3::X);
    assert!(matches!(cast.frame.ray(&beside).walk, Walk::Nothing));
    // A mesh without faces is missed.
    let empty = TracerCast::new(&Triangles::new(vec![], vec![]).unwrap());
    assert_eq!(empty.traverser().first(&beside, Sides::Both), None);
}

#[test]
fn a_hit_has_the_values_of_its_face_as_it_is_in_the_file() {
    // The lexicographically lowest corner is the third: weights must come back in the file's order.
    let vertices = vec![[4.0, 0.0, 0.0], [0.0, 4.0, 0.0], [0.0, 0.0, 0.0]];
    let mesh = Triangles::new(vertices, vec![[0, 1, 2]]).unwrap();
    let cast = TracerCast::new(&mesh);
    // (1, 2, 0) = 1/4 a + 1/2 b + 1/4 c, from 4 above in steps of 1/2, from in front.
    let ray = CastRay::new(DVec3::new(1.0, 2.0, 4.0), DVec3::new(0.0, 0.0, -0.5));
    let hit = cast.traverser().first(&ray, Sides::Both).unwrap();
    assert_eq!((hit.face, hit.side, hit.t, hit.range), (FaceId(0), Side::Front, 8.0, 4.0));
    assert_eq!((hit.point, hit.normal), (DVec3::new(1.0, 2.0, 0.0), DVec3::Z));
    assert_eq!((hit.barycentric, hit.cos_incidence), ([0.25, 0.5, 0.25], 1.0));
    // From behind.
    let ray = CastRay::new(DVec3::new(1.0, 2.0, -4.0), DVec3::new(0.0, 0.0, 0.5));
    let hit = cast.traverser().first(&ray, Sides::Both).unwrap();
    assert_eq!((hit.side, hit.normal, hit.cos_incidence), (Side::Back, DVec3::Z, -1.0));
    assert_eq!(cast.traverser().first(&ray, Sides::Fronts), None);
}

#[test]
fn the_shortest_and_the_longest_direction_meet_the_largest_and_a_small_mesh() {
    for size in [1e30, 1.0, 1e-30] {
        let corners =
            [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [-1.0, -1.0, 0.0]].map(|corner| corner.map(|x| x * size));
        let mesh = Triangles::new(corners.to_vec(), vec![[0, 1, 2]]).unwrap();
        let cast = TracerCast::new(&mesh);
        for length in [1e-270, 1e-245, 1e-200, 1.0, 1e30] {
            let ray = CastRay::new(DVec3::new(0.0, 0.0, size), DVec3::new(0.0, 0.0, -length));
            let hit = cast.traverser().first(&ray, Sides::Both).map(|hit| (hit.face, hit.t));
            let Some((FaceId(0), t)) = hit else { panic!("{size:e} {length:e}: {hit:?}") };
            assert!((t / (size / length) - 1.0).abs() < 1e-12, "{size:e} {length:e}: {t:e}");
        }
    }
}
