//! Unit tests of `cast`: the tree loses no hit that an exhaustive search has, at any scale and from any distance.

use std::cell::Cell;

use glam::DVec3;
use proptest::prelude::*;
use proptest::test_runner::TestRunner;
use raypencil_scene::{FaceId, Side};

use super::*;

#[path = "cast_bounds.rs"]
mod bounds;

/// All crossings of a ray by asking every face.
fn exhaustive<'t>(cast: &'t TracerCast, ray: &CastRay, sides: Sides) -> Vec<Crossing<'t>> {
    let scaled = cast.tree.frame.ray(ray);
    let mut met: Vec<Crossing<'t>> =
        cast.tree.faces.iter().filter_map(|face| face.crossing(ray, &scaled, sides)).collect();
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
    let mut rays = Vec::new();
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
        walks.count(cast.tree.frame.walk(&ray, &cast.tree.frame.ray(&ray)));
        for sides in [Sides::Both, Sides::Fronts] {
            let expected = exhaustive(&cast, &ray, sides);
            let scaled = cast.tree.frame.ray(&ray);
            let all: Vec<TracedHit> = expected.iter().map(|crossing| crossing.hit(&ray, &scaled)).collect();
            prop_assert_eq!(traverser.all(&ray, sides), all.clone());
            prop_assert_eq!(traverser.first(&ray, sides), all.first().copied());
            prop_assert_eq!(traverser.any(&ray, sides), !all.is_empty());
            walks.hits += u32::from(!all.is_empty());
            if sides == Sides::Fronts {
                prop_assert!(all.iter().all(|hit| hit.side == Side::Front));
            }
        }
        rays.push(ray);
    }
    compare_many(&cast, &rays)
}

/// Asks many rays at once, and each against every face.
fn compare_many(cast: &TracerCast, rays: &[CastRay]) -> Result<(), TestCaseError> {
    for sides in [Sides::Both, Sides::Fronts] {
        let first = |ray: &CastRay| {
            exhaustive(cast, ray, sides)
                .first()
                .map(|met| *TracedMeeting::new(met.met(), ray, &cast.tree.frame).hit())
        };
        let expected: Vec<Option<TracedHit>> = rays.iter().map(first).collect();
        let mut told = vec![None; rays.len()];
        cast.traverser().first_of_each(rays, sides, |index, met| {
            assert!(told[index].is_none());
            told[index] = Some(met.map(|met| (met.face(), met.side(), met.t(), *met.hit())));
        });
        let expected_told = expected
            .iter()
            .map(|hit| Some(hit.map(|hit| (hit.face, hit.side, hit.t, hit))))
            .collect::<Vec<_>>();
        prop_assert_eq!(told, expected_told);
        let any: Vec<bool> = expected.iter().map(Option::is_some).collect();
        prop_assert_eq!(cast.traverser().any_of_each(rays, sides), any);
    }
    Ok(())
}

/// A sheet of bumps of 2 x 2 sizes around `place`, each third face twice, of so many squares along a side.
fn sheet(size: f64, place: DVec3, side: u32) -> Triangles {
    let bump = |i: u32, j: u32| f64::from((i * 7 + j * 13) % 5) / 40.0;
    let part = |i: u32| 2.0 * f64::from(i) / f64::from(side) - 1.0;
    let vertex = |k: u32| {
        let (i, j) = (k / (side + 1), k % (side + 1));
        (place + size * DVec3::new(part(i), part(j), bump(i, j))).to_array()
    };
    let faces = |k: u32| {
        let at = k / side * (side + 1) + k % side;
        let [a, b, c, d] = [at, at + side + 1, at + side + 2, at + 1];
        let mut faces = vec![[a, b, c], [a, c, d]];
        if k.is_multiple_of(3) {
            faces.push([c, a, b]);
        }
        faces
    };
    Triangles::new((0..(side + 1).pow(2)).map(vertex).collect(), (0..side * side).flat_map(faces).collect())
        .unwrap()
}

/// Rays from `eye` sizes above the middle, so many in a row, that aim along a line of the sheet between these two points; every
/// fifth one ends or begins halfway.
fn fan(size: f64, place: DVec3, eye: DVec3, [from, to]: [DVec3; 2], count: u32, length: f64) -> Vec<CastRay> {
    let ray = |k: u32| {
        let aim = from + (to - from) * (f64::from(k) / f64::from(count));
        let direction = (DVec3::new(aim.x, aim.y, 0.05) - eye) * size * length;
        let mut ray = CastRay::new(place + eye * size, direction);
        match k % 10 {
            3 => ray.t_max = 0.5 / length,
            8 => ray.t_min = 0.5 / length,
            _ => {}
        }
        ray
    };
    (0..count).map(ray).collect()
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

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, ..ProptestConfig::default() })]

    #[test]
    fn a_packet_has_the_bits_of_its_rays(
        exponent in -60_i32..60,
        moved in prop_oneof![Just(0.0), Just(1.0), Just(1e6)],
        direction in within_one(),
        side in 1_u32..16,
        eye in (within_one(), 0.01_f64..4.0),
        row in [within_one(), within_one()],
        count in 1_u32..150,
        length in prop_oneof![Just(1.0), Just(1e-9), Just(1e9)],
    ) {
        let size = libm::scalbn(1.0, exponent);
        let place = direction * moved * size;
        let cast = TracerCast::new(&sheet(size, place, side));
        let eye = DVec3::new(eye.0.x, eye.0.y, eye.1);
        compare_many(&cast, &fan(size, place, eye, row, count, length))?;
    }
}

#[test]
fn a_packet_of_rays_with_ends_has_their_hits_at_any_size() {
    let (place, eye) = (DVec3::ZERO, DVec3::new(0.1, 0.2, 2.0));
    let row = [DVec3::new(-0.1, -0.9, 0.0), DVec3::new(0.1, -0.6, 0.0)];
    for size in [-40, 0, 40].map(|exponent| libm::scalbn(1.0, exponent)) {
        let cast = TracerCast::new(&sheet(size, place, 8));
        // Directions of the same length at each size, and ends a little beyond the sheet.
        let length = 1.0 / size;
        let rays = fan(size, place, eye, row, 64, length);
        let rays: Vec<_> =
            rays.iter().map(|ray| CastRay { t_min: 0.0, t_max: 1.25 / length, ..*ray }).collect();
        assert_eq!(how_many_together(&rays), 64);
        compare_many(&cast, &rays).unwrap();
        assert!(rays.iter().filter(|ray| cast.traverser().any(ray, Sides::Both)).count() > 50, "{size}");
    }
}

#[test]
fn rays_go_as_packets_while_that_pays() {
    // Few large faces, from above: a packet. Rays over corners too, where a packet meets several faces.
    let rays = fan(
        1.0,
        DVec3::ZERO,
        DVec3::new(0.1, 0.2, 2.0),
        [DVec3::new(-0.1, -0.9, 0.0), DVec3::new(0.1, -0.6, 0.0)],
        64,
        1.0,
    );
    assert_eq!(how_many_together(&rays), 64);
    let (coarse, fine) =
        (TracerCast::new(&sheet(1.0, DVec3::ZERO, 8)), TracerCast::new(&sheet(1.0, DVec3::ZERO, 300)));
    for (cast, pays) in [(&coarse, true), (&fine, false)] {
        let mut packet = Packet::EMPTY;
        assert!(packet.seek(&cast.tree, &mut cast.tree.boxes.stack(), &rays, Sides::Both));
        assert_eq!(packet.was_worth_it(), pays);
        let hits = (0..64).filter(|&lane| packet.nearest(lane, &cast.tree).is_some()).count();
        assert!(hits > 50, "{hits}");
        compare_many(cast, &rays[..8]).unwrap();
    }
    // Too wide together, too far away, too few, from two points, and with a sharp turn.
    let wide =
        fan(1.0, DVec3::ZERO, DVec3::new(0.0, 0.0, 1.0), [DVec3::splat(-0.9), DVec3::splat(0.9)], 64, 1.0);
    assert_eq!(how_many_together(&wide), 64);
    let mut packet = Packet::EMPTY;
    assert!(!packet.seek(&coarse.tree, &mut coarse.tree.boxes.stack(), &wide, Sides::Both));
    let far = fan(1.0, DVec3::ZERO, DVec3::new(0.0, 0.0, 12.0), [DVec3::ZERO, DVec3::X], 64, 1.0);
    assert!(!packet.seek(&coarse.tree, &mut coarse.tree.boxes.stack(), &far, Sides::Both));
    assert_eq!(how_many_together(&rays[..7]), 0);
    let mut two = rays.clone();
    two[20].origin.x += 1e-12;
    assert_eq!(how_many_together(&two), 20);
    two[10].direction = -two[10].direction;
    assert_eq!(how_many_together(&two), 10);
    for rays in [&wide, &far, &two] {
        compare_many(&coarse, rays).unwrap();
    }
}

/// Squares in a plane, and as many rays from one point of it to others: f64 sees both only nearly in one plane.
fn rays_in_the_plane_of_a_sheet(
    along: [DVec3; 2],
    eye: DVec3,
    size: f64,
    side: u32,
) -> (Triangles, Vec<CastRay>) {
    let at = |x: f64, y: f64| (along[0] * x + along[1] * y) * size;
    let vertex = |k: u32| at(f64::from(k / (side + 1)), f64::from(k % (side + 1))).to_array();
    let square = |k: u32| {
        let at = k / side * (side + 1) + k % side;
        [[at, at + side + 1, at + side + 2], [at, at + side + 2, at + 1]]
    };
    let vertices = (0..(side + 1).pow(2)).map(vertex).collect();
    let mesh = Triangles::new(vertices, (0..side * side).flat_map(square).collect()).unwrap();
    let origin = at(-eye.x.abs(), 4.0 * eye.y);
    let ray = |k: u32| {
        let to = at(f64::from(side) * eye.z.abs(), f64::from(side) * f64::from(k) / 64.0);
        CastRay::new(origin, to - origin)
    };
    (mesh, (0..64).map(ray).collect())
}

/// Rays in a plane in all ways of asking: what is met must not depend on what else is asked, nor lie outside the face's box.
#[test]
fn a_ray_in_a_faces_plane_meets_it_within_its_box() {
    let met = Cell::new(0);
    let mut ran = TestRunner::deterministic();
    let given = ([within_one(), within_one()], within_one(), -40_i32..40, 1_u32..12);
    ran.run(&given, |(along, eye, exponent, side)| {
        let (mesh, rays) = rays_in_the_plane_of_a_sheet(along, eye, libm::scalbn(1.0, exponent), side);
        if rays.iter().any(|ray| ray.validate("ray").is_err()) {
            return Ok(());
        }
        let cast = TracerCast::new(&mesh);
        for ray in &rays {
            let all = exhaustive(&cast, ray, Sides::Both);
            let first = cast.traverser().first(ray, Sides::Both);
            prop_assert_eq!(first.map(|hit| (hit.face, hit.t)), all.first().map(|hit| (hit.face.id, hit.t)));
            if let Some(hit) = first {
                let corners = mesh.corners(hit.face);
                let low = corners[0].min(corners[1]).min(corners[2]);
                let high = corners[0].max(corners[1]).max(corners[2]);
                let beside = (low - hit.point).max(hit.point - high).max_element();
                let largest = high.abs().max(low.abs()).max(ray.origin.abs()).max_element();
                prop_assert!(beside <= 80.0 * f64::EPSILON * largest, "{beside} of {largest}");
            }
        }
        compare_many(&cast, &rays)?;
        let any = rays.iter().filter(|ray| cast.traverser().any(ray, Sides::Both)).count();
        met.set(met.get() + any);
        Ok(())
    })
    .unwrap();
    assert!(met.get() > 500, "{met:?} rays met the sheet in their plane");
}

#[test]
fn a_packet_that_starts_on_a_face_meets_it_at_plain_zero() {
    let mesh = Triangles::new(vec![[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [0.0, 1.0, 0.0]], vec![[0, 1, 2]]);
    let cast = TracerCast::new(&mesh.unwrap());
    for z in [1.0, -1.0] {
        let ray = |k: u32| CastRay::new(DVec3::ZERO, DVec3::new(0.001 * f64::from(k), 0.0, z));
        let rays: Vec<CastRay> = (0..16).map(ray).collect();
        let mut packet = Packet::EMPTY;
        assert!(packet.seek(&cast.tree, &mut cast.tree.boxes.stack(), &rays, Sides::Both));
        let mut bits = Vec::new();
        cast.traverser()
            .first_of_each(&rays, Sides::Both, |_, met| bits.extend(met.map(|met| met.t().to_bits())));
        assert_eq!(bits, [0; 16]);
    }
}

#[test]
fn a_quad_refuses_no_face_that_is_met_and_nearly_all_others() {
    let cast = TracerCast::new(&sheet(1.0, DVec3::new(3.0, -2.0, 1.0), 40));
    let (mut kept, mut met) = (0, 0);
    for k in 0..500_u32 {
        // Through vertices and edges, aslant.
        let at = |step: u32| f64::from(k * step % 41) / 20.0 - 1.0;
        let aim = DVec3::new(3.0 + at(3), -2.0 + if k % 2 == 0 { at(5) } else { at(5) + 0.013 }, 1.0);
        let origin = DVec3::new(2.3, -1.6, 3.0);
        let ray = CastRay::new(origin, aim - origin);
        let scaled = cast.tree.frame.ray(&ray);
        let Walk::Tree { box_ray, .. } = cast.tree.frame.walk(&ray, &scaled) else { continue };
        let sheared = Sheared::new(&scaled.ray, &box_ray);
        for quad in &cast.tree.quads {
            let may_meet = quad.may_meet(&sheared);
            kept += may_meet.count_ones();
            for lane in 0..quad.count {
                let is_met = cast.tree.faces[(quad.first + lane) as usize]
                    .crossing(&ray, &scaled, Sides::Both)
                    .is_some();
                assert!(!is_met || may_meet >> lane & 1 == 1);
                met += u32::from(is_met);
            }
        }
    }
    assert!(met > 400 && kept < 2 * met, "{kept} kept, {met} met");
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
    assert!(matches!(cast.tree.frame.walk(&beside, &cast.tree.frame.ray(&beside)), Walk::Nothing));
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

/// A mesh of these faces, each with corners of its own.
fn mesh_of(corners: &[[[f64; 3]; 3]]) -> Triangles {
    let faces = (0..corners.len() as u32).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
    Triangles::new(corners.concat(), faces).unwrap()
}

#[test]
fn the_ends_of_a_ray_belong_to_it() {
    let cast = TracerCast::new(&mesh_of(&[[[-4.0, -4.0, 0.0], [4.0, -4.0, 0.0], [0.0, 4.0, 0.0]]]));
    let ray = CastRay::new(DVec3::new(0.0, 0.0, 4.0), DVec3::NEG_Z);
    let is_met = |t_min: f64, t_max: f64| cast.traverser().any(&CastRay { t_min, t_max, ..ray }, Sides::Both);
    assert!(is_met(4.0, f64::INFINITY) && is_met(0.0, 4.0) && is_met(4.0, 4.0));
    assert!(!is_met(4.0_f64.next_up(), f64::INFINITY) && !is_met(0.0, 4.0_f64.next_down()));
}

#[test]
fn a_face_has_the_same_hit_wherever_its_cycle_begins() {
    let corners = [[0.1, 0.7, 0.3], [-0.9, -0.2, 0.15], [0.8, -0.6, -0.45]];
    let begun_at = |k: usize| [0, 1, 2].map(|corner| corners[(corner + k) % 3]);
    let casts = [0, 1, 2].map(|k| TracerCast::new(&mesh_of(&[begun_at(k)])));
    let mut hits = 0;
    for k in 0..200 {
        let aim = DVec3::new(0.31 - 0.003 * f64::from(k), 0.2 - 0.0017 * f64::from(k), 0.1);
        let origin = DVec3::new(0.17, -0.23, 1.9);
        let ray = CastRay::new(origin, aim - origin);
        let of = casts.each_ref().map(|cast| cast.traverser().first(&ray, Sides::Both));
        let bits =
            of.map(|hit| hit.map(|hit| [hit.t, hit.normal.x, hit.normal.y, hit.normal.z].map(f64::to_bits)));
        assert!(bits[0] == bits[1] && bits[0] == bits[2], "{of:?}");
        let Some(weights) = of[0].map(|hit| hit.barycentric) else { continue };
        for k in 1..3 {
            let turned = of[k].unwrap().barycentric;
            assert_eq!(
                [0, 1, 2].map(|corner| turned[corner].to_bits()),
                [0, 1, 2].map(|corner| weights[(corner + k) % 3].to_bits())
            );
        }
        hits += 1;
    }
    assert!(hits > 50, "{hits}");
}

#[test]
fn faces_that_look_alike_in_sums_and_quotients_have_an_area() {
    // Corners that add up to 0, and edges along the quotient of two corners.
    let opposite = [[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let alike = [[1.0, 1.0, 1.0], [3.0, 1.0, 1.0], [2.0, 0.0, 0.0]];
    for corners in [opposite, alike] {
        let [a, b, c] = corners.map(DVec3::from_array);
        let middle = (a + b + c) / 3.0;
        let cast = TracerCast::new(&mesh_of(&[corners]));
        let normal = (b - a).cross(c - a);
        assert!(cast.traverser().any(&CastRay::new(middle + normal, -normal), Sides::Fronts), "{corners:?}");
    }
}

#[test]
fn a_weight_of_nothing_is_written_as_plain_zero() {
    let cast = TracerCast::new(&mesh_of(&[[[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]]]));
    for at in [[0.0, 0.0], [4.0, 0.0], [0.0, 4.0], [1.0, 0.0], [0.0, 1.0], [3.0, 1.0]] {
        for z in [1.0, -1.0] {
            let ray = CastRay::new(DVec3::new(at[0], at[1], 4.0 * z), DVec3::new(0.0, 0.0, -z));
            let hit = cast.traverser().first(&ray, Sides::Both).unwrap();
            let expected = [4.0 - at[0] - at[1], at[0], at[1]].map(|weight| weight / 4.0);
            assert_eq!(hit.barycentric.map(f64::to_bits), expected.map(f64::to_bits), "{at:?} from {z}");
        }
    }
}

#[test]
fn the_first_hits_of_a_set_are_those_of_its_rays() {
    let place = DVec3::new(1.0, 2.0, 3.0);
    let mesh = sheet(1.0, place, 6);
    let row = [DVec3::new(-1.3, -0.9, 0.0), DVec3::new(1.1, 0.8, 0.0)];
    let rays = fan(1.0, place, DVec3::new(0.1, 0.2, 2.0), row, 5000, 1.0);
    let cast = TracerCast::new(&mesh);
    for sides in [Sides::Both, Sides::Fronts] {
        let mut traverser = cast.traverser();
        let expected: Vec<_> = rays.iter().map(|ray| traverser.first(ray, sides)).collect();
        let set = RaySet::new(rays.clone(), sides).unwrap();
        assert_eq!(cast.first_of(&set), expected);
        assert!(expected.iter().filter(|hit| hit.is_some()).count() > 3000);
    }
}
