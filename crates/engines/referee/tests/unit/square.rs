//! What is told of a whole square, against displacements tried one by one and against margins.

use std::ops::AddAssign;

use glam::DVec3;
use raypencil_scene::{CastRay, FaceId, Precision, Reading, Sides, Triangles};

use super::super::margin::Frame;
use super::*;
use crate::cast::ExactCast;
use crate::hits::ruling::Ruling;
use crate::splitmix::SplitMix64;

/// Faces of any size, some of them in one plane or beside each other.
fn soup(random: &mut SplitMix64) -> Triangles {
    let mut point = |size: f64| [0; 3].map(|_| size * random.part());
    let mut corners = Vec::new();
    for k in 0..12 {
        let size = [1.0, 0.3, 0.05][k % 3];
        let middle = point(1.0 - size);
        corners.extend([0; 3].map(|_| {
            let [x, y, z] = point(size);
            [middle[0] + x, middle[1] + y, middle[2] + z]
        }));
    }
    let mut faces: Vec<[u32; 3]> = (0..12).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
    faces.extend((0..6).map(|k| [3 * k + 1, 3 * k, 3 * k + 5]));
    Triangles::new(corners, faces).expect("a mesh")
}

/// How many of the wrong answers are told at once, and how many not.
fn told(precision: Precision, sides: Sides, seed: u64) -> [usize; 2] {
    let mut random = SplitMix64(seed);
    let mut counts = [0, 0];
    for _ in 0..25 {
        let mesh = soup(&mut random);
        let cast = ExactCast::new(&mesh);
        for _ in 0..8 {
            let (from, to) = (DVec3::from_array([0; 3].map(|_| 3.0 * random.part())), {
                let face = mesh.corners(FaceId(random.below(18)));
                // Within a face, or on its outline or beyond it by what is charged.
                let weight = 0.5 + 0.6 * random.part();
                face[0]
                    + (face[1] - face[0]) * weight
                    + (face[2] - face[0]) * (0.5 * random.part() * (1.0 - weight))
            });
            let whole = CastRay::new(from, to - from);
            let ray = match random.below(3) {
                0 => whole,
                1 => CastRay { t_max: 1.0 + 0.1 * random.part(), ..whole },
                _ => CastRay { t_min: 1.0 + 0.1 * random.part(), ..whole },
            };
            for stated in (0..18).map(Some).chain([None]) {
                let stated = stated.map_or(Reading::Miss, |face| Reading::Hit(FaceId(face)));
                let Some(told) = is_told_at_once(&cast, &ray, sides, stated, precision) else { continue };
                counts[usize::from(!told)] += 1;
            }
        }
    }
    counts
}

/// Whether an answer that no displacement excuses is told at once; `None` if one excuses it, or it is right.
fn is_told_at_once(
    cast: &ExactCast<'_>,
    ray: &CastRay,
    sides: Sides,
    stated: Reading<FaceId>,
    precision: Precision,
) -> Option<bool> {
    let first = cast.nearest(ray, sides);
    let ruling = cast.rule(ray, sides, stated, precision);
    if matches!(ruling, Ruling::Exact | Ruling::Tie) {
        return None;
    }
    let stated = match stated {
        Reading::Hit(face) => Reading::Hit(cast.triangle(face).filter(Triangle::has_area)?),
        _ => Reading::Miss,
    };
    let trial = Trial { cast, ray, sides, precision, frame: Frame::new(ray), stated };
    let most = cast.lateral_error(ray, precision);
    let is_excused = trial.displacements(&first, most).into_iter().any(|by| trial.excuses(by));
    let is_told = trial.is_out_of_reach(&first, most);
    assert!(!(is_excused && is_told), "{ray:?} {:?}", trial.stated);
    assert_eq!(is_excused, matches!(ruling, Ruling::Rounding(_)));
    (!is_excused).then_some(is_told)
}

/// With errors as large as parts of the faces, a square that is a little too small would deny what a displacement excuses.
#[test]
fn what_is_out_of_reach_is_excused_by_no_displacement() {
    for (seed, unit_roundoff) in [(1, 1e-3), (2, 1e-4), (3, 1e-5), (4, Precision::F32.unit_roundoff)] {
        for sides in [Sides::Both, Sides::Fronts] {
            let [told, untold] = told(Precision { unit_roundoff }, sides, seed);
            assert!(told > 400 && untold > 4, "{unit_roundoff}: {told} {untold}");
        }
    }
}

/// Of a soup whose faces are aimed at beside their outlines, 98 of 100 wrong answers.
#[test]
fn most_wrong_answers_are_told_at_once() {
    let [told, untold] = told(Precision::F64, Sides::Both, 5);
    assert!(told > 19 * untold, "{told} {untold}");
}

/// A ray to a place of one of the faces, or beside it.
fn ray_at(mesh: &Triangles, random: &mut SplitMix64) -> CastRay {
    let from = DVec3::from_array([0; 3].map(|_| 3.0 * random.part()));
    let face = mesh.corners(FaceId(random.below(18)));
    let weight = 0.5 + 0.6 * random.part();
    let to = face[0] + (face[1] - face[0]) * weight + (face[2] - face[0]) * (0.5 * (1.0 - weight));
    CastRay::new(from, to - from)
}

#[test]
fn a_square_is_steady_up_to_the_margin_and_no_farther() {
    let mut random = SplitMix64(6);
    let (mut hits, mut misses, mut far_less) = (0, 0, 0);
    for _ in 0..100 {
        let mesh = soup(&mut random);
        let cast = ExactCast::new(&mesh);
        for sides in [Sides::Both, Sides::Fronts] {
            let endless = ray_at(&mesh, &mut random);
            let ray = match random.below(3) {
                0 => endless,
                1 => CastRay { t_max: 1.0 + 0.5 * random.part(), ..endless },
                _ => CastRay { t_blind: 1.0 + 0.5 * random.part(), ..endless },
            };
            let margin = cast.margins(&ray, sides).face;
            // The margin's own displacement lies in this square.
            let past_it = (1.0 + 1e-9) * margin.hi;
            assert!(past_it > 1e9 || !cast.is_steady(&ray, sides, past_it), "{ray:?} {margin:?}");
            if margin.lo > 1e-9 && cast.is_steady(&ray, sides, 0.1 * margin.lo) {
                let is_hit = !cast.first(&ray, sides).is_empty();
                (if is_hit { &mut hits } else { &mut misses }).add_assign(1);
            } else {
                far_less += 1;
            }
        }
    }
    assert!(hits > 60 && misses > 20 && far_less < 20, "{hits} {misses} {far_less}");
}
