//! What is told to be wrong at once, against all displacements that would be tried.

use glam::DVec3;

use super::*;
use crate::soup::soup;
use crate::splitmix::SplitMix64;

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
