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

#[test]
fn a_needle_is_excused_at_a_corner_that_no_displacement_in_f64_reaches() {
    let (a, b) = (
        DVec3::new(6.567361919894978, -7.279202159303928, 8.987128512933612),
        DVec3::new(3.3060175591361585, -2.447666912863473, -4.917474721786153),
    );
    // On the line from a to b, but for rounding.
    let c = DVec3::new(5.344357784610421, -5.467376441888757, 3.7729022999137003);
    let corners = [a, b, c].map(|corner| corner.to_array()).to_vec();
    let mesh = raypencil_scene::Triangles::new(corners, vec![[0, 1, 2]]).expect("a triangle");
    let cast = ExactCast::new(&mesh);
    let from = DVec3::new(1.6879251973925813, 7.512756417691557, 0.3141276702307172);
    let rule = |beside: f64, stated| {
        let ray = CastRay::new(from + DVec3::X * beside, a - from);
        assert!(cast.first(&ray, Sides::Both).is_empty());
        cast.rule(&ray, Sides::Both, stated, Precision::F64)
    };
    let needle = Reading::Hit(FaceId(0));
    // Aimed at the corner, the ray passes it by what rounding leaves. 16 u S is 3e-14 here, and decides along both axes.
    let Ruling::Rounding(by) = rule(0.0, needle) else { panic!("{:?}", rule(0.0, needle)) };
    assert!(by.max_norm() < 1e-15, "{by:?}");
    assert!(matches!(rule(1e-14, needle), Ruling::Rounding(_)));
    assert_eq!(rule(1e-13, needle), Ruling::Wrong);
}
