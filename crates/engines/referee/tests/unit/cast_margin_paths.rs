//! The fast ways to a margin against the slow ones: the same bits on meshes that are hard for them, and counts that prove that the
//! fast ways are taken.

use std::cmp::Ordering;
use std::rc::Rc;

use glam::DVec3;
use raypencil_scene::{FaceId, Side, Triangles};

use super::super::query_ray::QueryRay;
use super::super::triangle::Triangle;
use super::flat::{FlatFace, Linear, corner_of};
use super::frame::is_cut;
use super::hidden::{Hidden, WalkedFace};
use super::looks::LOOKS;
use super::region::{LazyLinear, least_size, triples};
use super::segment::{AtPlace, Border, Piece, Place, Segment};
use super::*;
use crate::numbers::number::{Dyadic, Interval, Number};
use crate::numbers::vector::Vector;
use crate::splitmix::SplitMix64;

type Corners = Vec<[DVec3; 3]>;

fn point(random: &mut SplitMix64) -> DVec3 {
    DVec3::new(random.part(), random.part(), random.part())
}

/// A square from -1 to 1 of 2 n n faces, each vertex where `at` moves it.
fn sheet(n: usize, mut at: impl FnMut(DVec3) -> DVec3) -> Corners {
    let part = |k: usize| 2.0 * k as f64 / n as f64 - 1.0;
    let vertices: Vec<DVec3> =
        (0..=n * (n + 2)).map(|k| at(DVec3::new(part(k % (n + 1)), part(k / (n + 1)), 0.0))).collect();
    let corner = |x: usize, y: usize| vertices[y * (n + 1) + x];
    (0..n * n)
        .flat_map(|k| {
            let (x, y) = (k % n, k / n);
            let [a, b, c, d] = [corner(x, y), corner(x + 1, y), corner(x + 1, y + 1), corner(x, y + 1)];
            [[a, b, c], [a, c, d]]
        })
        .collect()
}

/// Hills that hide one another from the side.
fn hills(random: &mut SplitMix64) -> Corners {
    sheet(14, |at| at + 0.25 * DVec3::Z * random.part())
}

/// A sheet that is folded over itself, many times.
fn folded(random: &mut SplitMix64) -> Corners {
    sheet(14, |at| DVec3::new(at.x + 0.4 * random.part(), at.y + 0.4 * random.part(), 0.2 * random.part()))
}

/// Steps of whole eighths: edges through edges, upright faces.
fn steps(random: &mut SplitMix64) -> Corners {
    sheet(8, |at| DVec3::new(at.x, at.y, f64::from(random.below(3)) / 8.0))
}

/// Faces that share nothing.
fn scattered(random: &mut SplitMix64) -> Corners {
    (0..200)
        .map(|_| {
            let at = point(random);
            [0; 3].map(|_| at + 0.3 * point(random))
        })
        .collect()
}

/// Hills so narrow that rounding tips them over.
fn slender(random: &mut SplitMix64) -> Corners {
    sheet(10, |at| DVec3::new(at.x, 1e-13 * at.y, 0.2 * random.part()))
}

fn mesh(corners: &Corners, size: f64, place: DVec3) -> Triangles {
    let vertices = corners.iter().flatten().map(|&corner| (size * corner + place).to_array()).collect();
    let faces = (0..corners.len() as u32).map(|face| [3 * face, 3 * face + 1, 3 * face + 2]).collect();
    Triangles::new(vertices, faces).unwrap()
}

/// From above or from the side, now and then with ends, and through a vertex.
fn ray(random: &mut SplitMix64, corners: &Corners, size: f64, place: DVec3) -> CastRay {
    let lift = [0.05, 0.3, 2.0][random.below(3) as usize];
    let from = DVec3::new(1.5 * random.part(), 1.5 * random.part(), lift);
    let to = match random.below(4) {
        0 => corners[random.below(corners.len() as u32) as usize][0],
        1 => DVec3::new(from.x, from.y, -1.0),
        _ => DVec3::new(random.part(), random.part(), 0.1 * random.part()),
    };
    let ray = CastRay::new(size * from + place, size * (to - from));
    match random.below(6) {
        0 => CastRay { t_max: 0.5 + random.unit(), ..ray },
        1 => CastRay { t_min: random.unit(), ..ray },
        _ => ray,
    }
}

/// What draws a mesh.
type Family = fn(&mut SplitMix64) -> Corners;

const FAMILIES: [(&str, Family); 5] =
    [("hills", hills), ("folded", folded), ("steps", steps), ("scattered", scattered), ("slender", slender)];

/// A size of the mesh, and where it is.
const FRAMES: [(f64, DVec3); 4] =
    [(1.0, DVec3::ZERO), (1.0, DVec3::new(1e7, -3e6, 1e5)), (1e20, DVec3::ZERO), (1e-150, DVec3::ZERO)];

fn bits(margin: &Margin) -> [u64; 4] {
    let by = margin.witness.as_ref().map_or([f64::NAN; 2], |by| by.to_array());
    [margin.lo, margin.hi, by[0], by[1]].map(f64::to_bits)
}

#[test]
fn what_the_screen_leaves_out_changes_no_margin() {
    let mut random = SplitMix64(45);
    for (name, family) in FAMILIES {
        let mut compared = 0;
        for (size, place) in FRAMES {
            let corners = family(&mut random);
            let mesh = mesh(&corners, size, place);
            let cast = ExactCast::new(&mesh);
            for _ in 0..150 {
                let ray = ray(&mut random, &corners, size, place);
                let sides = if random.below(3) == 0 { Sides::Fronts } else { Sides::Both };
                if cast.nearest(&ray, sides).is_empty() {
                    continue;
                }
                let frame = Frame::new(&ray);
                let view = View::new(&mesh, cast.seams(), &ray, sides);
                let screen = Screen::new(&frame, cast.tree.largest_coordinate);
                let [with, without] =
                    [screen.as_ref(), None].map(|screen| cast.surface_margin(&frame, 0.0, &view, screen));
                assert_eq!(bits(&with), bits(&without), "{name}: {ray:?}: {with:?} and {without:?}");
                compared += 1;
            }
        }
        assert!(compared > 100, "{name}: {compared} rays hit something");
    }
}

/// Every edge that is called hidden is met behind a face in each of many places, exactly; and of those of hills, which are behind
/// one surface, a third is called so.
#[test]
fn edges_that_the_screen_hides_are_hidden() {
    let mut random = SplitMix64(46);
    let (mut called, mut hidden) = (0, 0);
    for (name, family) in FAMILIES {
        for (size, place) in FRAMES {
            let corners = family(&mut random);
            let mesh = mesh(&corners, size, place);
            let cast = ExactCast::new(&mesh);
            let ray = ray(&mut random, &corners, size, place);
            let frame = Frame::new(&ray);
            let view = View::new(&mesh, cast.seams(), &ray, Sides::Both);
            let Some(screen) = Screen::new(&frame, cast.tree.largest_coordinate) else {
                assert!(size < 1e-100, "{name}");
                continue;
            };
            for (face, k) in (0..corners.len() as u32).flat_map(|face| [0, 1, 2].map(|k| (FaceId(face), k))) {
                let Some(side) = view.side(&Triangle::of(&mesh, face)) else { continue };
                let is_called = cast.is_edge_hidden(&screen, (face, side, k), Sides::Both);
                let own = mesh.corners(face);
                let [p, q] = [k, k + 1].map(|k| own[corner_of(side, k)]);
                // A place of the edge to the last digit is not needed: what hides is far before it.
                let is_hidden_at = |part: f64| {
                    let place = p + (q - p) * part;
                    let t = (place - ray.origin).dot(ray.direction) / ray.direction.length_squared();
                    let t_max = t - 1e-12 * (t.abs() + place.length() / ray.direction.length());
                    let through = CastRay { origin: place - ray.direction * t, t_max, ..ray };
                    t_max > ray.t_min && cast.any(&through, Sides::Both)
                };
                let is_hidden = [0.01, 0.3, 0.5, 0.77, 0.99].into_iter().all(is_hidden_at);
                assert!(
                    is_hidden || !is_called,
                    "{name} of {size}: edge {k} of {face:?}, {p} to {q}, {ray:?}"
                );
                if name == "hills" {
                    called += usize::from(is_called);
                    hidden += usize::from(is_hidden);
                }
            }
        }
    }
    assert!(called > 300 && 3 * called > hidden, "{called} of {hidden} hidden edges");
}

#[test]
fn sides_by_normals_are_the_exact_ones() {
    let mut random = SplitMix64(47);
    let mut certain = 0;
    for (name, family) in FAMILIES {
        let corners = family(&mut random);
        let mesh = mesh(&corners, 1.0, DVec3::ZERO);
        let cast = ExactCast::new(&mesh);
        for index in 0..mesh.faces().len() as u32 {
            let face = Triangle::of(&mesh, FaceId(index));
            let [a, b, c] = face.corners;
            // Along the face, but for some part of its normal.
            let normal = (b - a).cross(c - a).normalize_or(DVec3::Z);
            for part in [0.0, 1e-17, 1e-9, 1e-7, 3e-7, 1e-6, 0.1] {
                for sign in [1.0, -1.0] {
                    let ray = CastRay::new(a, (b - a).normalize() + sign * part * normal);
                    let view = View::new(&mesh, cast.seams(), &ray, Sides::Both);
                    let exactly = face.seen_side(&QueryRay::new(&ray));
                    assert_eq!(view.side(&face), exactly, "{name}: {face:?} by {ray:?}");
                    for side in [Side::Front, Side::Back] {
                        assert_eq!(view.shows(face.id, side), exactly == Some(side), "{name}");
                    }
                    certain +=
                        usize::from(cast.seams().certain_side(face.id, ray.direction.normalize()).is_some());
                }
            }
        }
    }
    assert!(certain > 1000, "{certain}");
}

/// The least size by intervals first is that of exact arithmetic alone, whatever intervals leave open.
#[test]
fn the_least_size_is_that_of_all_weights_looked_at_exactly() {
    let mut random = SplitMix64(48);
    let (mut sizes, mut empty) = (0, 0);
    for round in 0..4000 {
        let mut number = || match round % 3 {
            0 => f64::from(random.below(5)) - 2.0,
            1 => random.part(),
            _ => (f64::from(random.below(5)) - 2.0) * (1.0 + f64::EPSILON * f64::from(random.below(3))),
        };
        let given: Vec<[f64; 3]> = (0..4 + round % 3).map(|_| [number(), number(), number()]).collect();
        // A product makes intervals as wide as they are in a mesh.
        let third = 1.0 / 3.0;
        let linear = |[c, x, y]: [f64; 3]| {
            fn of<T: Number>(value: f64, third: f64) -> T {
                T::of(value).mul(&T::of(third))
            }
            let exact = Linear::<Dyadic> { c: of(c, third), x: of(x, third), y: of(y, third) };
            (Linear::<Interval> { c: of(c, third), x: of(x, third), y: of(y, third) }, exact)
        };
        let (fast, exact): (Vec<_>, Vec<_>) = given.iter().map(|&given| linear(given)).unzip();
        let anything = Interval::between(f64::NEG_INFINITY, f64::INFINITY);
        let nothing_known = vec![Linear { c: anything, x: anything, y: anything }; given.len()];
        let [quickly, slowly] = [fast, nothing_known].map(|fast| {
            let conditions: Vec<LazyLinear> = fast.into_iter().map(LazyLinear::new).collect();
            least_size(&conditions, |index| exact[index].clone(), |_| false)
        });
        assert_eq!(quickly, slowly, "{given:?}");
        match quickly {
            Some(size) => sizes += usize::from(size[0] > 0.0),
            None => empty += 1,
        }
    }
    assert!(sizes > 500 && empty > 500, "{sizes} sizes, {empty} without any");
}

/// Faces that were looked at for the margins of a ray at the middle of the corners of the first face, from above.
fn looks(corners: &Corners) -> (u64, Margins) {
    let mesh = mesh(corners, 1.0, DVec3::ZERO);
    let at = corners[0].iter().sum::<DVec3>() / 4.0;
    let ray = CastRay::new(at + 4.0 * DVec3::Z, DVec3::NEG_Z);
    LOOKS.set(0);
    let margins = ExactCast::new(&mesh).margins(&ray, Sides::Both);
    (LOOKS.get(), margins)
}

/// A triangle whose right angle is at the place.
fn right_triangle(at: DVec3, size: f64) -> [DVec3; 3] {
    [at, at + size * DVec3::X, at + size * DVec3::Y]
}

/// Faces that lie in or on one another are looked at a number of times that grows with their number and not with its square.
#[test]
fn faces_in_one_place_are_not_looked_at_for_each_of_them() {
    type Stack = fn(usize, usize) -> [DVec3; 3];
    let stacks: [(&str, u64, Stack); 5] = [
        // Of copies one is looked at, however many there are.
        ("copies", 0, |k, _| {
            let mut face = right_triangle(DVec3::ZERO, 1.0);
            face.rotate_left(k % 3);
            face
        }),
        // Copies in two planes, one of which hides a part of the other.
        ("two places", 0, |k, _| right_triangle(DVec3::NEG_Z * (k % 2) as f64, 1.0 + (k % 2) as f64)),
        // They share the nearest edge.
        ("fan", 12, |k, n| {
            let part = k as f64 / n as f64;
            [8.0 * DVec3::NEG_Y, DVec3::new(2.0 + part, 0.0, -part), 8.0 * DVec3::Y]
        }),
        // Each lies within the next, in one plane.
        ("nested", 320, |k, n| {
            let part = k as f64 / n as f64;
            right_triangle(DVec3::new(-1.0 - part, -1.0 - part, 0.0), 4.0 + 4.0 * part)
        }),
        // One below the other.
        ("layers", 320, |k, n| right_triangle(DVec3::NEG_Z * (k as f64 / n as f64), 1.0)),
    ];
    for (name, for_each_face, stack) in stacks {
        let [(few, _), (many, margins)] = [128, 1024].map(|n| looks(&(0..n).map(|k| stack(k, n)).collect()));
        assert!(many <= few.max(for_each_face * 1024), "{name}: {few} for 128 faces, {many} for 1024");
        assert!(margins.surface.lo > 0.0, "{name}: {margins:?}");
    }
}

/// A face hides a piece of an edge wholly if its picture contains the far end, and it is met before that and after the start of the ray.
#[test]
fn a_piece_is_hidden_wholly_by_a_face_that_ends_behind_it() {
    let edge_of = right_triangle(DVec3::new(3.0, 3.0, 0.0), 1.0);
    let roof = |size: f64, z: f64| right_triangle(DVec3::new(2.5, 2.5, z), size);
    let down = CastRay::new(DVec3::new(0.5, 0.5, 4.0), DVec3::NEG_Z);
    let cut = CastRay { t_min: 3.5, ..down };
    let cases = [
        ("wide", roof(4.0, 1.0), down, true),
        ("narrow", roof(1.2, 1.0), down, false),
        ("behind", roof(4.0, -1.0), down, false),
        ("before the start", roof(4.0, 1.0), cut, false),
    ];
    for (name, roof, ray, expected) in cases {
        let frame = Frame::new(&ray);
        let segment_in = |k: usize| Segment::of_edge(&edge_of, Side::Front, k, frame.exact());
        // The edge from (3, 3) to (4, 3), which is nearest to the ray at its first end.
        let k = (0..3)
            .find(|&k| corner_of(Side::Front, k) + corner_of(Side::Front, k + 1) == 1)
            .expect("an edge");
        let segment = Rc::new(segment_in(k));
        let fast = Segment::of_edge(&edge_of, Side::Front, k, &frame.fast);
        let pieces =
            segment.pieces(frame.exact()).expect("an edge after the start").map(|[near, far]| Piece {
                face: FaceId(1),
                side: Side::Front,
                border: Border::Edge(k),
                segment: Rc::clone(&segment),
                near,
                far,
            });
        let piece = pieces.into_iter().find(|piece| !piece.is_empty()).expect("a piece");
        let flat = FlatFace::new(&frame.fast, &roof, Side::Front);
        let first = WalkedFace { face: FaceId(0), flat };
        let hidden = piece.hidden_by_surface(first, &fast, &frame.fast, |_, _| None);
        assert_eq!(matches!(hidden, Hidden::Wholly), expected, "{name}");
    }
}

/// A mesh with copies of its faces, begun at another corner, has the margins of the mesh, to the last bit; and a face that is turned over is
/// no copy.
#[test]
fn copies_of_faces_change_no_margin() {
    let mut random = SplitMix64(49);
    for (name, family) in FAMILIES {
        for (size, place) in FRAMES {
            let corners = family(&mut random);
            let twice: Corners = corners
                .iter()
                .copied()
                .chain(corners.iter().step_by(2).map(|&[a, b, c]| [b, c, a]))
                .collect();
            let [once, twice] = [&corners, &twice].map(|corners| mesh(corners, size, place));
            let [once, twice] = [&once, &twice].map(ExactCast::new);
            for _ in 0..60 {
                let ray = ray(&mut random, &corners, size, place);
                let sides = if random.below(3) == 0 { Sides::Fronts } else { Sides::Both };
                let [alone, among] = [&once, &twice].map(|cast| cast.margins(&ray, sides));
                let [face, surface] = [(&alone.face, &among.face), (&alone.surface, &among.surface)]
                    .map(|(alone, among)| (bits(alone), bits(among)));
                assert_eq!(face.0, face.1, "{name}: {ray:?}: {alone:?} and {among:?}");
                assert_eq!(surface.0, surface.1, "{name}: {ray:?}: {alone:?} and {among:?}");
            }
        }
    }
    // Of a square one half is there first with its back up: rays that pass through backs do not meet it.
    let [a, b, c, d] = [DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::Y];
    let square = mesh(&vec![[a, c, b], [a, b, c], [a, c, d]], 1.0, DVec3::ZERO);
    let ray = CastRay::new(DVec3::new(0.5, 0.25, 4.0), DVec3::NEG_Z);
    let margin = ExactCast::new(&square).margins(&ray, Sides::Fronts).surface;
    assert!(margin.lo <= 0.25 && margin.lo > 0.2499, "{margin:?}");
}

/// Ranges of the ray's ends, on the far sides of what their roundings come to.
#[test]
fn the_ranges_of_the_ends_of_a_ray_have_room_for_rounding() {
    let mut random = SplitMix64(12);
    for _ in 0..1000 {
        let mut point = || point(&mut random);
        let (direction, [from, long, _]) = (point(), point().to_array());
        let t_min = from.abs();
        let ray = CastRay { t_min, t_max: t_min + long.abs(), ..CastRay::new(DVec3::ZERO, direction) };
        let frame = Frame::new(&ray);
        let square = |x: f64| Dyadic::of(x).square();
        let length = Vector::<Dyadic>::of(direction).length_squared();
        // The signs of s (1 + m 2^-50) - t |d|, by their squares: both are positive.
        let sign = |s: f64, m: f64, t: f64| {
            let factor = Dyadic::of(1.0 + m * 4.0 * f64::EPSILON);
            square(s).mul(&factor.square()).sub(&square(t).mul(&length)).sign().expect("an exact sign")
        };
        let [least, greatest] = frame.ranges();
        assert!(sign(frame.range_after_start(), -1.0, ray.t_min).is_gt(), "{ray:?}");
        assert!(sign(least, 1.0, ray.t_min).is_lt(), "{ray:?}");
        assert!(sign(greatest, -1.0, ray.t_max).is_gt(), "{ray:?}");
    }
}

/// A vertex is shown where it is, whatever its coordinates are rounded to.
#[test]
fn what_may_be_shown_has_room_for_rounding() {
    let mut random = SplitMix64(13);
    for _ in 0..1000 {
        let origin = point(&mut random);
        let mut size = [1e-3; 3];
        size[random.below(3) as usize] = 1e3;
        let vertex = point(&mut random) * DVec3::from_array(size);
        let ray = CastRay::new(origin, point(&mut random));
        let frame = Frame::new(&ray);
        let at = frame.displacement_to(vertex).to_array();
        assert!(frame.may_show(&[vertex; 3], at, 0.0), "{vertex} by {ray:?}");
        // And hardly beside it.
        assert!(!frame.may_show(&[vertex; 3], [at[0] + 1e-9, at[1]], 0.0), "{vertex} by {ray:?}");
    }
}

#[test]
fn three_of_four_conditions_are_one_of_four_sets() {
    assert_eq!(triples(4).collect::<Vec<_>>(), [[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]]);
    assert_eq!(triples(6).count(), 20);
}

/// At an end of a segment the value is that of the end: an exact 0 stays one.
#[test]
fn intervals_tell_a_zero_at_an_end() {
    let [zero, one] = [0.0, 1.0].map(Interval::of);
    for (values, place) in [([zero, one], Place::start()), ([one, zero], Place::end())] {
        assert_eq!(Interval::at(&place, &values).sign(), Some(Ordering::Equal));
    }
}

/// What touches an end of the ray may be cut by it: ends and faces have room for rounding.
#[test]
fn what_touches_an_end_is_cut() {
    let ray = CastRay { t_min: 1.0, t_max: 4.0, ..CastRay::new(DVec3::ZERO, DVec3::Z) };
    let frame = Frame::new(&ray);
    let [first, last] = frame.ranges();
    let is_cut = |near: f64, far: f64| is_cut([near, far], frame.ranges());
    assert!(is_cut(first, 2.0) && is_cut(2.0, last) && is_cut(0.0, 9.0));
    assert!(!is_cut(first.next_up(), last.next_down()));
}

/// Sizes that intervals tell are not formed without rounding. Where the ray passes an edge itself, intervals do not tell.
#[test]
fn a_face_margin_that_intervals_tell_has_no_exact_numbers() {
    // In the plane z = x / 3 + y / 5, up to x = y.
    let at = |x: f64, y: f64| DVec3::new(x, y, x / 3.0 + y / 5.0);
    let mesh = mesh(&vec![[at(0.0, 0.0), at(1.0, 0.0), at(1.0, 1.0)]], 1.0, DVec3::ZERO);
    let cast = ExactCast::new(&mesh);
    for (x, y, is_exact) in [(0.5, 0.375, false), (0.5, 0.4375, false), (0.5, 0.5, true)] {
        let ray = CastRay::new(DVec3::new(x, y, 4.0), DVec3::NEG_Z);
        let frame = Frame::new(&ray);
        let view = View::new(&mesh, cast.seams(), &ray, Sides::Both);
        let margin = cast.face_margin(&frame, &cast.nearest(&ray, Sides::Both), &view);
        assert!((margin.lo - 0.5 * (x - y)).abs() < 1e-12, "{margin:?}");
        assert_eq!(frame.has_exact(), is_exact, "{x}, {y}");
    }
}

/// An edge whose middle is before the start of the ray, or at it, is hidden by nothing: no face is looked at.
#[test]
fn nothing_is_asked_whether_it_hides_an_edge_before_the_start() {
    let corners = vec![right_triangle(DVec3::ZERO, 1.0), right_triangle(DVec3::new(-1.0, -1.0, 1.0), 4.0)];
    let mesh = mesh(&corners, 1.0, DVec3::ZERO);
    let cast = ExactCast::new(&mesh);
    // The lower face is met at t = 3, the upper one at 2.
    for (t_min, is_asked) in [(0.0, true), (3.0, false), (3.5, false)] {
        let ray = CastRay { t_min, ..CastRay::new(DVec3::new(0.25, 0.25, 3.0), DVec3::NEG_Z) };
        let frame = Frame::new(&ray);
        let screen = Screen::new(&frame, 3.0).expect("a frame of this size");
        LOOKS.set(0);
        assert_eq!(
            cast.is_edge_hidden(&screen, (FaceId(0), Side::Front, 0), Sides::Both),
            is_asked,
            "{t_min}"
        );
        assert_eq!(LOOKS.get() > 0, is_asked, "{t_min}");
    }
}
