//! The fast path against exact arithmetic, sign by sign, on rays that are hard for it. Counters prove that each path was taken.

use std::cmp::Ordering;

use glam::DVec3;
use raypencil_scene::CastRay;

use super::super::query_ray::PATHS;
use super::*;
use crate::splitmix::SplitMix64;

/// A ray and the corners of a face.
type Case = (CastRay, [DVec3; 3]);

/// What draws a case.
type Family = fn(&mut SplitMix64) -> Case;

fn point(random: &mut SplitMix64) -> DVec3 {
    DVec3::new(random.part(), random.part(), random.part())
}

/// Anywhere.
fn anywhere(random: &mut SplitMix64) -> Case {
    let (from, to) = (4.0 * point(random), point(random));
    (CastRay::new(from, to - from), [point(random), point(random), point(random)])
}

/// Small whole numbers: rays through edges and corners, parallel faces, ends on faces.
fn lattice(random: &mut SplitMix64) -> Case {
    let mut whole =
        |size: u32| DVec3::from_array([0; 3].map(|_| f64::from(random.below(size)) - f64::from(size / 2)));
    let (origin, direction) = (whole(7), whole(5));
    let direction = if direction == DVec3::ZERO { DVec3::X } else { direction };
    let corners = [whole(5), whole(5), whole(5)];
    let ray = CastRay::new(origin, direction);
    (CastRay { t_min: f64::from(random.below(3)), t_max: 2.0 + f64::from(random.below(3)), ..ray }, corners)
}

/// Aimed at a point of an edge, and rounded: beside it by some last digits.
fn at_an_edge(random: &mut SplitMix64) -> Case {
    let corners = [point(random), point(random), point(random)];
    let along = 0.5 + 0.5 * random.part();
    let (from, to) = (4.0 * point(random), corners[0] + (corners[1] - corners[0]) * along);
    (CastRay::new(from, to - from), corners)
}

/// The same, with numbers that nearly over- or underflow.
fn huge_and_tiny(random: &mut SplitMix64) -> Case {
    let (ray, corners) = at_an_edge(random);
    let size = [1e28, 1e-60, 1e-100, 1e-140][random.below(4) as usize];
    let long = [1e28, 1.0, 1e-120, 1e-290][random.below(4) as usize];
    let ray = CastRay { origin: ray.origin * size, direction: ray.direction * long, ..ray };
    (ray, corners.map(|corner| corner * size))
}

/// Slender faces, which rounding tips over.
fn slender(random: &mut SplitMix64) -> Case {
    let (ray, [a, b, _]) = at_an_edge(random);
    let width = [1e-6, 1e-9, 1e-12, 1e-15][random.below(4) as usize];
    (ray, [a, b, a + (b - a) * 0.3 + width * point(random)])
}

/// Ends where the face is, but for the last digits of t.
fn ends_at_a_face(random: &mut SplitMix64) -> Case {
    let (ray, corners) = anywhere(random);
    let [a, b, c] = corners;
    let target = (a + b + c) / 3.0 + 0.1 * (b - a) * random.part();
    let ray = CastRay { direction: target - ray.origin, ..ray };
    let normal = (b - a).cross(c - a);
    let t = normal.dot(a - ray.origin) / normal.dot(ray.direction);
    let t = t * (1.0 + f64::EPSILON * f64::from(random.below(5)) - 2.0 * f64::EPSILON);
    let ray = if random.below(2) == 0 { CastRay { t_min: t, ..ray } } else { CastRay { t_max: t, ..ray } };
    (ray, corners)
}

/// How a ray meets a face, by exact arithmetic alone.
fn met_exactly(ray: &CastRay, face: &Triangle, sides: Sides) -> Option<Side> {
    let numbers = RayNumbers::<Dyadic>::of(ray);
    let sign = |number: Dyadic| number.sign().expect("an exact sign");
    let edges = [0, 1, 2].map(|k| sign(face.edge(k, &numbers)));
    let approach = sign(face.approach(&numbers));
    let towards = match approach {
        Ordering::Equal => return None,
        other => other,
    };
    let beyond = |t: f64| sign(face.height(&numbers).sub(&face.approach(&numbers).mul(&Dyadic::of(t))));
    let side = if towards == Ordering::Less { Side::Front } else { Side::Back };
    let is_inside = edges.iter().all(|&edge| edge == Ordering::Equal || edge == towards);
    let is_after = beyond(ray.t_min) != towards.reverse();
    let is_before = ray.t_max == f64::INFINITY || beyond(ray.t_max) != towards;
    (sides.include(side) && is_inside && is_after && is_before).then_some(side)
}

/// Cases of each family; `just paths` asks for more.
fn cases() -> u64 {
    std::env::var("RAYPENCIL_PATH_CASES").map_or(20_000, |text| text.parse().expect("a number of cases"))
}

#[test]
fn every_sign_and_every_hit_is_that_of_exact_arithmetic() {
    let families: [(&str, Family); 6] = [
        ("anywhere", anywhere),
        ("lattice", lattice),
        ("at an edge", at_an_edge),
        ("huge and tiny", huge_and_tiny),
        ("slender", slender),
        ("ends at a face", ends_at_a_face),
    ];
    let mut random = SplitMix64(45);
    let (mut ways, cases) = (Vec::new(), cases());
    assert!(cases >= 20_000, "too few cases to tell");
    for (name, family) in families {
        PATHS.set([0; 4]);
        let mut hits = 0;
        for _ in 0..cases {
            let (ray, corners) = family(&mut random);
            let face = Triangle { id: FaceId(0), corners };
            let query = QueryRay::new(&ray);
            for k in 0..3 {
                let exactly = face.edge(k, query.exact()).sign().expect("an exact sign");
                assert_eq!(face.edge_sign(k, &query), exactly, "{name}: edge {k} of {corners:?} by {ray:?}");
            }
            for sides in [Sides::Both, Sides::Fronts] {
                let met = face.met(&query, sides);
                let side = met_exactly(&ray, &face, sides);
                assert_eq!(met.map(|met| met.side), side, "{name}: {corners:?} by {ray:?}");
                hits += usize::from(side.is_some());
                // (h - t g) g is not negative up to the exact t, and not positive from there on.
                let exact = query.exact();
                let (height, approach) = (face.height(exact), face.approach(exact));
                let off = |t: f64| match t.is_finite() {
                    true => height
                        .sub(&approach.mul(&Dyadic::of(t)))
                        .mul(&approach)
                        .sign()
                        .expect("an exact sign"),
                    false => 0.0_f64.total_cmp(&t),
                };
                if let Some(Met { t, .. }) = met {
                    assert!(
                        off(t.low) != Ordering::Less && off(t.high) != Ordering::Greater,
                        "{name}: {t:?}"
                    );
                }
            }
        }
        assert!(hits > 100, "{name}: {hits} hits are too few to tell");
        println!("{name}: {cases} cases, {hits} hits; filter, plane, interval, exact: {:?}", PATHS.get());
        ways.push((name, PATHS.get()));
    }
    let of = |name: &str| ways.iter().find(|(of, _)| *of == name).expect("a family").1;
    // Where rays go anywhere, the first path does nearly all; what is hard takes the others.
    let [filter, plane, interval, exact] = of("anywhere");
    assert!(filter > 5 * cases && plane > cases / 20, "{:?}", of("anywhere"));
    assert!(2000 * interval < cases && 2000 * exact < cases, "{:?}", of("anywhere"));
    for name in ["at an edge", "huge and tiny", "slender"] {
        let [filter, plane, _, exact] = of(name);
        assert!(filter > 1000 && plane > 1000 && exact > 1000, "{name}: {:?}", of(name));
    }
    // Where plain f64 underflows, and at the ends of rays.
    for name in ["huge and tiny", "lattice", "ends at a face"] {
        let [_, _, interval, exact] = of(name);
        assert!(interval > 100 && exact > 1000, "{name}: {:?}", of(name));
    }
}

#[test]
fn a_moved_ray_has_the_signs_of_exact_arithmetic() {
    let mut random = SplitMix64(46);
    PATHS.set([0; 4]);
    for _ in 0..5000 {
        let (ray, corners) = at_an_edge(&mut random);
        let face = Triangle { id: FaceId(0), corners };
        let far = [1e-17, 1e-15, 3e-15, 1e-14, 1e-13][random.below(5) as usize];
        let by = [0, 1].map(|_| far * random.part());
        let query = QueryRay::moved(&ray, by);
        for k in 0..3 {
            let exactly = face.edge(k, query.exact()).sign().expect("an exact sign");
            assert_eq!(
                face.edge_sign(k, &query),
                exactly,
                "edge {k} of {corners:?} by {ray:?} moved by {by:?}"
            );
        }
    }
    let [filter, _, interval, exact] = PATHS.get();
    assert!(filter > 20 && interval > 20 && exact > 20, "{filter} {interval} {exact}");
}
