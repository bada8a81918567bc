//! Any rays on any triangles: closed forms by hand, and a second evaluation in integers by another formula.

use std::cmp::Ordering;

use glam::DVec3;
use proptest::prelude::*;
use raypencil_referee::{DecidedBy, ExactCast, HitGroup, Referee, SidedFace};
use raypencil_scene::{
    Atmosphere, CastRay, FaceId, FluxModel, Mesh, Mounted, Pose, Reading, Scene, SensorId, Side, Sides,
    Triangles, rig,
};

/// A ray from whole numbers.
fn ray(origin: [i32; 3], direction: [i32; 3]) -> CastRay {
    CastRay::new(DVec3::from(origin.map(f64::from)), DVec3::from(direction.map(f64::from)))
}

/// The cube from 0 to 2 in each coordinate, two faces on each side, fronts outside.
fn cube() -> Triangles {
    let corner = |k: u32| [k & 1, k >> 1 & 1, k >> 2].map(|bit| 2.0 * f64::from(bit));
    // Each side by its corners, counter-clockwise from outside: -x +x -y +y -z +z.
    let sides = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    let faces = sides.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    Triangles::new((0..8).map(corner).collect(), faces).unwrap()
}

fn faces(group: &HitGroup) -> Vec<(u32, Side)> {
    group.faces.iter().map(|met| (met.face.0, met.side)).collect()
}

#[test]
fn exact_numbers_decide_on_an_edge_and_the_filter_within() {
    let cube = cube();
    let beside = |y: f64| CastRay::new(DVec3::new(0.5, y, 5.0), DVec3::NEG_Z);
    // The top is cut from (0, 0) to (2, 2).
    let rays = [beside(0.25), beside(0.5), beside(3.0)];
    let mut decided = [None; 3];
    ExactCast::new(&cube).first_meetings(&rays, Sides::Fronts, |k, _, by| decided[k] = Some(by));
    assert_eq!(decided, [DecidedBy::Filter, DecidedBy::Exact, DecidedBy::Filter].map(Some));
}

#[test]
fn a_ray_through_a_cube_enters_and_leaves() {
    let cube = cube();
    let cast = ExactCast::new(&cube);
    // y < z: on side -x, the face (0,0,0) (0,0,2) (0,2,2) has z >= y; on side +x (2,0,0) (2,2,2) (2,0,2) has.
    let through = ray([-3, 1, 0], [2, 0, 0]);
    let through = CastRay { origin: through.origin + DVec3::new(0.0, -0.5, 1.25), ..through };
    let all = cast.all(&through, Sides::Both);
    assert_eq!(all.iter().map(faces).collect::<Vec<_>>(), [[(0, Side::Front)], [(3, Side::Back)]]);
    assert_eq!(all.iter().map(|group| group.crossing).collect::<Vec<_>>(), [1, -1]);
    assert_eq!(cast.first(&through, Sides::Both), [FaceId(0)]);
    let hit = cast.first_values(&through, Sides::Both).unwrap();
    // From x = -3 to x = 0 in steps of 2. The point is at (y, z) = (1/2, 5/4): a + (y/2)(c - b) + (z/2)(b - a).
    assert_eq!((hit.t.double, hit.range.double), (1.5, 3.0));
    assert_eq!(hit.point.map(|part| part.double), [0.0, 0.5, 1.25]);
    assert_eq!(hit.normal.map(|part| part.double), [-1.0, 0.0, 0.0]);
    assert_eq!(hit.barycentric.map(|weight| weight.double), [0.375, 0.375, 0.25]);
    assert_eq!(hit.cos_incidence.double, 1.0);
    // Its far side is met from behind.
    let hit = cast.values(&through, FaceId(3)).unwrap();
    assert_eq!((hit.t.double, hit.side, hit.cos_incidence.double), (2.5, Side::Back, -1.0));
    // A face that the ray passes beside has no values, nor has one that is not there.
    assert_eq!(cast.values(&through, FaceId(1)), None);
    assert_eq!(cast.values(&through, FaceId(12)), None);
    // Fronts only: the back is not there.
    assert_eq!(cast.all(&through, Sides::Fronts).len(), 1);
    let inside = CastRay { origin: DVec3::new(1.0, 0.5, 1.25), ..through };
    assert!(cast.any(&inside, Sides::Both) && !cast.any(&inside, Sides::Fronts));
}

#[test]
fn an_edge_a_vertex_and_a_touch_are_crossed_as_often_as_the_surface_is() {
    let cube = cube();
    let cast = ExactCast::new(&cube);
    let groups = |origin, direction| cast.all(&ray(origin, direction), Sides::Both);
    let crossings =
        |all: &[HitGroup]| all.iter().map(|group| (group.faces.len(), group.crossing)).collect::<Vec<_>>();
    // Through the diagonal edge of two sides: two faces each, one crossing each.
    assert_eq!(crossings(&groups([-1, 1, 1], [1, 0, 0])), [(2, 1), (2, -1)]);
    // Through an edge between two sides, and out through the opposite edge.
    assert_eq!(crossings(&groups([-1, -1, 1], [1, 1, 0])), [(2, 1), (2, -1)]);
    // From corner to corner. At (0,0,0) side -x has two faces, -y two, -z two.
    assert_eq!(crossings(&groups([-1, -1, -1], [1, 1, 1])), [(6, 1), (6, -1)]);
    // Along the edge x = y = 0 nothing is crossed on balance, whichever way the displaced ray passes.
    let along: i32 = groups([0, 0, -1], [0, 0, 1]).iter().map(|group| group.crossing).sum();
    assert_eq!(along, 0);
    // Past an edge that is only touched: a front and a back at one t, or none of the displaced ray's.
    let touch = groups([-1, 1, 1], [1, -1, 0]);
    assert_eq!(touch.len(), 1);
    assert_eq!((touch[0].faces.len(), touch[0].crossing), (2, 0));
    assert!(touch[0].faces.iter().any(|met| met.side == Side::Front));
    assert!(touch[0].faces.iter().any(|met| met.side == Side::Back));
}

#[test]
fn too_near_is_decided_exactly_and_is_no_end_of_the_ray() {
    let cube = cube();
    let cast = ExactCast::new(&cube);
    // From x = -4 by 5 for each t, the side x = 0 is met at t = 4/5, that at x = 2 at t = 6/5.
    let blind = |t_blind: f64| CastRay { t_blind, ..ray([-4, 1, 1], [5, 0, 0]) };
    // The double 0.8 is a little more than 4/5: a sensor that measures from there on finds the side too near, though its t is
    // rounded to that very double. One step less, and it is measured.
    let measured = cast.first(&blind(0.0), Sides::Both);
    assert_eq!(cast.values(&blind(0.0), measured[0]).unwrap().t.double, 0.8);
    assert_eq!(cast.reading(&blind(0.8), Sides::Both), Reading::TooNear);
    assert_eq!(cast.reading(&blind(0.8_f64.next_down()), Sides::Both), Reading::Hit(measured));
    // The other side is met all the same, and is not what is read.
    let all = cast.all(&blind(1.0), Sides::Both);
    assert_eq!(all.iter().map(|group| group.crossing).collect::<Vec<_>>(), [1, -1]);
    assert!(cast.any(&blind(1.0), Sides::Both));
    assert_eq!(cast.reading(&blind(1.0), Sides::Both), Reading::TooNear);
    // A ray with a start is another ray: from t = 1 on, the far side is read.
    let started = CastRay { t_min: 1.0, ..blind(0.0) };
    assert_eq!(cast.reading(&started, Sides::Both), Reading::Hit(cast.first(&started, Sides::Both)));
    // From within, fronts only: the back that is passed is not too near.
    let from_within = CastRay { t_blind: 0.5, ..ray([1, 1, 1], [5, 0, 0]) };
    assert_eq!(cast.reading(&from_within, Sides::Fronts), Reading::Miss);
    assert_eq!(cast.reading(&from_within, Sides::Both), Reading::TooNear);
}

#[test]
fn both_ends_of_a_ray_belong_to_it() {
    let cube = cube();
    let cast = ExactCast::new(&cube);
    let through = ray([-3, 1, 1], [1, 0, 0]);
    let within = |t_min, t_max| cast.all(&CastRay { t_min, t_max, ..through }, Sides::Both).len();
    // The cube is met at t = 3 and t = 5.
    assert_eq!(within(3.0, 5.0), 2);
    assert_eq!(within(3.0_f64.next_up(), 5.0), 1);
    assert_eq!(within(3.0, 5.0_f64.next_down()), 1);
    assert_eq!(within(3.0, 3.0), 1);
    assert_eq!(within(3.5, 4.5), 0);
    assert_eq!(within(0.0, 3.0_f64.next_down()), 0);
    // A ray that starts on a face meets it at t = 0, whichever way it goes.
    for x in [-1, 1] {
        let leaves = cast.all(&ray([0, 1, 1], [x, 0, 0]), Sides::Both);
        assert_eq!(leaves[0].faces.len(), 2);
        let t = cast.values(&ray([0, 1, 1], [x, 0, 0]), leaves[0].faces[0].face).unwrap().t;
        assert_eq!(t.double, 0.0);
    }
    // At a corner the six faces around it are met, but those that are parallel to the ray.
    assert_eq!(cast.first(&ray([0, 0, 0], [1, 2, 3]), Sides::Both).len(), 6);
    assert_eq!(cast.first(&ray([0, 0, 0], [1, 2, 0]), Sides::Both).len(), 4);
    // In the plane of a side the ray meets its neighbours only, edge on.
    let in_plane = cast.all(&ray([-1, 0, 1], [1, 0, 0]), Sides::Both);
    assert_eq!(in_plane.iter().map(faces).collect::<Vec<_>>(), [[(0, Side::Front)], [(3, Side::Back)]]);
}

#[test]
fn duplicate_and_crossing_faces_are_one_group() {
    // Twice the same face, once turned over, and one that crosses them along x = 1.
    let vertices = [[0, 0, 0], [4, 0, 0], [0, 4, 0], [1, 0, -1], [1, 0, 1], [1, 4, 0]];
    let mesh = Triangles::new(
        vertices.map(|v: [i32; 3]| v.map(f64::from)).to_vec(),
        vec![[0, 1, 2], [1, 2, 0], [0, 2, 1], [3, 4, 5]],
    )
    .unwrap();
    let cast = ExactCast::new(&mesh);
    let down = cast.all(&ray([1, 1, 3], [0, 0, -1]), Sides::Both);
    // The fourth face is parallel to the ray. The three others are one place: two to the inside, one to the outside.
    assert_eq!(down.len(), 1);
    assert_eq!(faces(&down[0]), [(0, Side::Front), (1, Side::Front), (2, Side::Back)]);
    assert_eq!(down[0].crossing, 1);
    // Slanted, it meets the fourth face at the very same point.
    let slanted = cast.first(&ray([0, 1, 1], [1, 0, -1]), Sides::Both);
    assert_eq!(slanted, [FaceId(0), FaceId(1), FaceId(2), FaceId(3)]);
    // Fronts only: the tie is among fronts.
    let fronts = cast.first(&ray([0, 1, 1], [1, 0, -1]), Sides::Fronts);
    assert!(!fronts.contains(&FaceId(2)) && fronts.len() >= 2);
}

#[test]
fn vertices_that_are_no_f32_numbers_are_taken_as_they_are() {
    // As f32 numbers both heights were 0.1: the second face is nearer by 1e-16 only.
    let heights = [0.1, 0.1_f64.next_up()];
    let vertices = heights.iter().flat_map(|&z| [[0.0, 0.0, z], [1.0, 0.0, z], [0.0, 1.0, z]]).collect();
    let mesh = Triangles::new(vertices, vec![[0, 1, 2], [3, 4, 5]]).unwrap();
    let cast = ExactCast::new(&mesh);
    let down = CastRay::new(DVec3::new(0.25, 0.25, 1.0), DVec3::new(0.0, 0.0, -1.0));
    assert_eq!(cast.first(&down, Sides::Both), [FaceId(1)]);
    assert_eq!(cast.values(&down, FaceId(0)).unwrap().t.double, 0.9);
    // Faces so thin that f64 loses their area are met all the same.
    let needle = vec![[0.0, 0.0, 0.0], [1e-170, 0.0, 0.0], [0.0, 1e-170, 0.0]];
    let mesh = Triangles::new(needle, vec![[0, 1, 2]]).unwrap();
    assert_eq!(mesh.zero_area_faces(), 1);
    let down = CastRay::new(DVec3::new(1e-171, 1e-171, 1e30), DVec3::new(0.0, 0.0, -1e30));
    let hit = ExactCast::new(&mesh).first_values(&down, Sides::Fronts).unwrap();
    assert_eq!((hit.t.double, hit.normal.map(|part| part.double)), (1.0, [0.0, 0.0, 1.0]));
}

#[test]
fn a_cameras_rays_written_as_numbers_get_the_same_answers() {
    // Dyadic pitches and an exact pose: the rays are exactly the stored numbers.
    let scene = dyadic_scene();
    let (referee, triangles) = (Referee::new(&scene), Triangles::from(scene.mesh().as_ref()));
    let cast = ExactCast::new(&triangles);
    let (mut hits, mut misses, mut ties) = (0, 0, 0);
    for sensor in scene.sensors() {
        let (width, height) = scene.size(sensor).unwrap();
        for (i, j) in (0..height).flat_map(|j| (0..width).map(move |i| (i, j))) {
            let ray = scene.ray(sensor, i, j).unwrap();
            let ray = CastRay { t_min: 1.0, ..CastRay::new(ray.origin, ray.direction) };
            let verdict = referee.verdict(sensor, i, j).unwrap();
            assert_eq!(cast.first(&ray, Sides::Fronts), verdict.faces, "{sensor} {i},{j}");
            match (referee.values(sensor, i, j), cast.first_values(&ray, Sides::Fronts)) {
                (Some(by_sensor), Some(by_number)) => {
                    assert_eq!(by_sensor.range, by_number.range);
                    assert_eq!(by_sensor.point, by_number.point);
                    assert_eq!(by_sensor.normal, by_number.normal);
                    assert_eq!(by_sensor.cos_incidence, by_number.cos_incidence);
                    hits += 1;
                }
                (None, None) => misses += 1,
                _ => panic!("hit and miss differ"),
            }
            ties += usize::from(verdict.faces.len() > 1);
        }
    }
    assert!(hits > 200 && misses > 100 && ties > 10, "{hits} hits, {misses} misses, {ties} ties");
}

/// A pyramid before a camera and a beam that look along z; all numbers are small multiples of powers of two.
fn dyadic_scene() -> Scene {
    let vertices =
        vec![[-1.0, -1.0, 4.0], [1.0, -1.0, 4.0], [1.0, 1.0, 4.0], [-1.0, 1.0, 4.0], [0.0, 0.0, 2.0]];
    let faces = vec![[1, 0, 4], [2, 1, 4], [3, 2, 4], [0, 3, 4]];
    let material = raypencil_scene::Material { name: "chalk".into(), reflectivity: 0.5 };
    let mesh = Mesh::new(DVec3::ZERO, vertices, faces, vec![0; 4], vec![material]).unwrap();
    let camera = Mounted { scene_from_sensor: Pose::IDENTITY, sensor: rig::camera(32, 32, 0.015625, 0.5) };
    // Four columns of a width of 1/4, the grid at 1/2: x_i = (2 i + 1 - 4) / 16.
    let beam = Mounted { scene_from_sensor: Pose::IDENTITY, sensor: rig::beam(4, 4, [0.25, 0.5], 0.5) };
    let air = Atmosphere { attenuation: 0.0 };
    Scene::new(mesh.into(), camera, vec![beam], air, FluxModel::Radiometric).unwrap()
}

// ---- The second evaluation: integers, Cramer's rule, every face asked. ----

type Int3 = [i128; 3];

fn minus(a: Int3, b: Int3) -> Int3 {
    std::array::from_fn(|k| a[k] - b[k])
}

fn determinant([a, b, c]: [Int3; 3]) -> i128 {
    a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0])
        + a[2] * (b[0] * c[1] - b[1] * c[0])
}

/// A hit as fractions with one positive divisor: t = numerator / divisor, and the weights of b and c.
#[derive(Debug, Clone, Copy)]
struct WholeHit {
    face: u32,
    side: Side,
    t: i128,
    weights: [i128; 2],
    divisor: i128,
}

/// Solves o + t d = a + u (b - a) + v (c - a) by Cramer's rule: t d - u e1 - v e2 = a - o.
fn solve(face: u32, [a, b, c]: [Int3; 3], origin: Int3, direction: Int3) -> Option<WholeHit> {
    let (e1, e2, s) = (minus(b, a), minus(c, a), minus(a, origin));
    let negative = |v: Int3| v.map(|x| -x);
    let columns = [direction, negative(e1), negative(e2)];
    let mut divisor = determinant(columns);
    let [t, u, v] = [0, 1, 2].map(|k: usize| {
        let mut replaced = columns;
        replaced[k] = s;
        determinant(replaced)
    });
    // det(d, -e1, -e2) = d . (e1 x e2) = n . d.
    let side = match divisor.cmp(&0) {
        Ordering::Less => Side::Front,
        Ordering::Greater => Side::Back,
        Ordering::Equal => return None,
    };
    let sign = divisor.signum();
    divisor *= sign;
    Some(WholeHit { face, side, t: t * sign, weights: [u * sign, v * sign], divisor })
}

impl WholeHit {
    fn is_in_triangle(&self) -> bool {
        let [u, v] = self.weights;
        u >= 0 && v >= 0 && u + v <= self.divisor
    }

    fn is_strictly_in_triangle(&self) -> bool {
        let [u, v] = self.weights;
        u > 0 && v > 0 && u + v < self.divisor
    }

    fn order(&self, other: &Self) -> Ordering {
        (self.t * other.divisor).cmp(&(other.t * self.divisor))
    }
}

/// The displacement of the rule is a thousandth, and its square, in whole numbers of a millionth. Directions are at most 3
/// and edges at most 6 long in each coordinate: E is a whole number and changes by at most 36 of these.
const ONE: i128 = 1_000_000;

/// All hits of a ray by brute force.
fn by_brute_force(vertices: &[Int3], faces: &[[u32; 3]], origin: Int3, direction: Int3) -> Vec<HitGroup> {
    let met = |scale: i128, shift: Int3| {
        let origin: Int3 = std::array::from_fn(|k| origin[k] * scale + shift[k]);
        faces.iter().enumerate().filter_map(move |(index, face)| {
            let corners = face.map(|v| vertices[v as usize].map(|x| x * scale));
            solve(index as u32, corners, origin, direction)
        })
    };
    let mut hits: Vec<WholeHit> = met(1, [0; 3]).filter(|hit| hit.is_in_triangle() && hit.t >= 0).collect();
    hits.sort_by(|a, b| a.order(b).then(a.face.cmp(&b.face)));
    // The first of the largest parts, as in the rule that is checked.
    let largest = (0..3).rev().max_by_key(|&k| direction[k].abs()).unwrap();
    let mut shift = [0; 3];
    (shift[(largest + 1) % 3], shift[(largest + 2) % 3]) = (ONE / 1_000, 1);
    let displaced: Vec<WholeHit> = met(ONE, shift).filter(WholeHit::is_strictly_in_triangle).collect();
    let crossing = |group: &[WholeHit]| {
        let passes = |hit: &&WholeHit| displaced.iter().any(|other| other.face == hit.face);
        group.iter().filter(passes).map(|hit| if hit.side == Side::Front { 1 } else { -1 }).sum()
    };
    hits.chunk_by(|a, b| a.order(b).is_eq())
        .map(|group| HitGroup {
            faces: group.iter().map(|hit| SidedFace { face: FaceId(hit.face), side: hit.side }).collect(),
            crossing: crossing(group),
        })
        .collect()
}

/// Three whole numbers from -`size` to `size`.
fn whole(size: i32) -> impl Strategy<Value = [i32; 3]> {
    [-size..=size, -size..=size, -size..=size]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 3_000, ..ProptestConfig::default() })]

    /// On a lattice of few points edges, vertices, planes and starts coincide all the time. Scaled by a power of two and
    /// moved by whole numbers, the answers stay.
    #[test]
    fn all_answers_are_those_of_integers(
        vertices in prop::collection::vec(whole(3), 3..9),
        corners in prop::collection::vec([0_usize..9, 0_usize..9, 0_usize..9], 1..14),
        rays in prop::collection::vec((whole(4), whole(3)), 24),
        exponent in -300_i32..60,
        moved in prop_oneof![Just([0; 3]), whole(1_000_000_000)],
    ) {
        let faces: Vec<[u32; 3]> =
            corners.iter().map(|corners| corners.map(|k| (k % vertices.len()) as u32)).collect();
        // Far from 0, a scale of 1 keeps all digits.
        let scale = libm::scalbn(1.0, exponent);
        let place = |v: [i32; 3]| -> [f64; 3] {
            std::array::from_fn(|k| (f64::from(v[k]) + f64::from(moved[k])) * scale)
        };
        let mesh = Triangles::new(vertices.iter().map(|&v| place(v)).collect(), faces.clone()).unwrap();
        let cast = ExactCast::new(&mesh);
        let lattice: Vec<Int3> = vertices.iter().map(|v| v.map(i128::from)).collect();
        for (origin, direction) in rays {
            if direction == [0; 3] {
                continue;
            }
            let expected =
                by_brute_force(&lattice, &faces, origin.map(i128::from), direction.map(i128::from));
            let ray = CastRay::new(DVec3::from(place(origin)), DVec3::from(direction.map(f64::from)));
            let found = cast.all(&ray, Sides::Both);
            prop_assert_eq!(&found, &expected);
            prop_assert_eq!(cast.any(&ray, Sides::Both), !expected.is_empty());
            let first: Vec<FaceId> =
                expected.first().map_or(vec![], |group| group.faces.iter().map(|met| met.face).collect());
            prop_assert_eq!(cast.first(&ray, Sides::Both), first);
            // Fronts only: the same without backs.
            let fronts: Vec<Vec<SidedFace>> = expected
                .iter()
                .map(|group| group.faces.iter().copied().filter(|met| met.side == Side::Front).collect())
                .filter(|group: &Vec<_>| !group.is_empty())
                .collect();
            let found: Vec<_> = cast.all(&ray, Sides::Fronts).into_iter().map(|group| group.faces).collect();
            prop_assert_eq!(&found, &fronts);
            prop_assert_eq!(cast.any(&ray, Sides::Fronts), !fronts.is_empty());
            let first: Vec<FaceId> = fronts.first().map_or(vec![], |group| group.iter().map(|met| met.face).collect());
            prop_assert_eq!(cast.first(&ray, Sides::Fronts), first);
        }
    }

    /// The quotients of whole numbers below 2^53 are rounded correctly by the machine's own division.
    #[test]
    fn values_are_the_nearest_numbers(
        corners in [whole(100), whole(100), whole(100)],
        origin in whole(100),
        weights in (1_i32..50, 1_i32..50),
        direction in whole(100),
    ) {
        // Towards a point of the face's plane that lies in it for most draws.
        let mesh = Triangles::new(corners.map(|v| v.map(f64::from)).to_vec(), vec![[0, 1, 2]]).unwrap();
        let at: [i32; 3] = std::array::from_fn(|k| {
            100 * corners[0][k]
                + weights.0 * (corners[1][k] - corners[0][k])
                + weights.1 * (corners[2][k] - corners[0][k])
                - 100 * origin[k]
        });
        let cast = ExactCast::new(&mesh);
        for direction in [at, direction] {
            if direction == [0; 3] {
                continue;
            }
            let whole = |v: [i32; 3]| v.map(i128::from);
            let solved = solve(0, corners.map(whole), whole(origin), whole(direction));
            let solved = solved.filter(|hit| hit.is_in_triangle() && hit.t >= 0);
            let ray = CastRay::new(DVec3::from(origin.map(f64::from)), DVec3::from(direction.map(f64::from)));
            let found = cast.values(&ray, FaceId(0));
            prop_assert_eq!(found.is_some(), solved.is_some());
            let (Some(found), Some(solved)) = (found, solved) else { continue };
            let over = |numerator: i128| numerator as f64 / solved.divisor as f64;
            let [u, v] = solved.weights;
            prop_assert_eq!(found.side, solved.side);
            prop_assert_eq!(found.t.double, over(solved.t));
            prop_assert_eq!(found.barycentric.map(|weight| weight.double), [over(solved.divisor - u - v), over(u), over(v)]);
            for k in 0..3 {
                let numerator = i128::from(origin[k]) * solved.divisor + i128::from(direction[k]) * solved.t;
                prop_assert_eq!(found.point[k].double, over(numerator));
            }
            let length = direction.map(f64::from).iter().map(|x| x * x).sum::<f64>().sqrt();
            prop_assert!((found.range.double - over(solved.t) * length).abs() <= 4e-16 * found.range.double);
            let n = (mesh.corners(FaceId(0))[1] - mesh.corners(FaceId(0))[0])
                .cross(mesh.corners(FaceId(0))[2] - mesh.corners(FaceId(0))[0]);
            let d = ray.direction;
            for k in 0..3 {
                prop_assert!((found.normal[k].double - n[k] / n.length()).abs() <= 4e-16);
            }
            prop_assert!((found.cos_incidence.double + n.dot(d) / (n.length() * d.length())).abs() <= 8e-16);
        }
    }
}

/// The beam and the camera of the scene above are asked for.
#[test]
fn the_dyadic_scene_has_both_sensors() {
    let sensors: Vec<SensorId> = dyadic_scene().sensors().collect();
    assert_eq!(sensors, [SensorId::Camera, SensorId::Beam(0)]);
}

/// A ridge that the ray touches: it meets the front of one face and the back of the other at one t, and crosses the surface not at all.
/// Whoever asks for fronts alone gets the same number.
#[test]
fn a_touched_ridge_is_no_crossing_whichever_sides_are_asked_for() {
    let wedge = |x: f64| {
        let corners = vec![[0.0, -1.0, 0.0], [0.0, 1.0, 0.0], [x, 0.0, 0.25], [x, 0.0, -0.25]];
        let faces = if x > 0.0 { vec![[0, 2, 1], [0, 1, 3]] } else { vec![[0, 1, 2], [0, 3, 1]] };
        Triangles::new(corners, faces).unwrap()
    };
    for x in [1.0, -1.0] {
        let mesh = wedge(x);
        let cast = ExactCast::new(&mesh);
        for (start, along) in [([0, 0, 3], [0, 0, -1]), ([0, 0, -3], [0, 0, 1])] {
            let touching = ray(start, along);
            let [both, fronts] = [Sides::Both, Sides::Fronts].map(|sides| cast.all(&touching, sides));
            assert_eq!((both.len(), both[0].faces.len(), both[0].crossing), (1, 2, 0));
            assert_eq!((fronts.len(), fronts[0].faces.len(), fronts[0].crossing), (1, 1, 0));
        }
    }
}

/// Rays from the exact middle of a room to its vertices: all their coordinates are as small as those of the ray's start, so that no
/// other slack widens a box. Each ray meets exactly the faces that have the vertex, at t = 1.
#[test]
fn rays_from_the_middle_of_a_room_meet_all_faces_of_a_corner() {
    const N: u32 = 12;
    let mut vertices: Vec<[f64; 3]> = Vec::new();
    let mut faces: Vec<[u32; 3]> = Vec::new();
    let mut index = |vertex: [f64; 3]| {
        let found = vertices.iter().position(|other| *other == vertex);
        found.unwrap_or_else(|| {
            vertices.push(vertex);
            vertices.len() - 1
        }) as u32
    };
    let scale = [1.0 / 3.0, 1.3 / 3.0, 0.7 / 3.0];
    for (axis, side) in (0..3).flat_map(|axis| [(axis, -1.0), (axis, 1.0)]) {
        let at = |i: u32, j: u32| {
            let part = |k: u32| (f64::from(k) - f64::from(N / 2)) / f64::from(N / 2);
            let mut vertex = [0.0; 3];
            (vertex[axis], vertex[(axis + 1) % 3], vertex[(axis + 2) % 3]) = (side, part(i), part(j));
            [0, 1, 2].map(|k| vertex[k] * scale[k])
        };
        for (i, j) in (0..N).flat_map(|i| (0..N).map(move |j| (i, j))) {
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)].map(&mut index);
            faces.extend([[a, b, c], [a, c, d]]);
        }
    }
    assert_eq!(vertices.len(), 6 * 12 * 12 + 2);
    let mesh = Triangles::new(vertices.clone(), faces.clone()).unwrap();
    let cast = ExactCast::new(&mesh);
    for (index, vertex) in vertices.iter().enumerate() {
        let ray = CastRay::new(DVec3::ZERO, DVec3::from_array(*vertex));
        let of_vertex = (0..faces.len()).filter(|&face| faces[face].contains(&(index as u32)));
        let expected: Vec<FaceId> = of_vertex.map(|face| FaceId(face as u32)).collect();
        assert_eq!(cast.first(&ray, Sides::Both), expected, "{vertex:?}");
        assert_eq!(cast.first_values(&ray, Sides::Both).unwrap().t.double, 1.0);
    }
}

/// A t below every double, of a range that is a common one: each is rounded by itself.
#[test]
fn a_range_is_right_where_its_t_is_too_small_for_a_double() {
    let corners = vec![[-1.0, -1.0, 1e-300], [1.0, -1.0, 1e-300], [0.0, 1.0, 1e-300]];
    let mesh = Triangles::new(corners, vec![[0, 1, 2]]).unwrap();
    let exact = ExactCast::new(&mesh);
    for size in [1.0, 1e10, 1e23, 1e24, 1e30] {
        let ray = CastRay::new(DVec3::ZERO, DVec3::new(0.0, 0.0, size));
        let hit = exact.values(&ray, FaceId(0)).expect("a hit");
        assert_eq!(hit.t.double, if size > 1e23 { 0.0 } else { 1e-300 / size }, "{size}");
        // 1e-300 / size times size, which is 1e-300.
        assert_eq!((hit.range.double, hit.point[2].double), (1e-300, 1e-300), "{size}");
    }
}
