//! The bounds of stated values from both sides: at 0.9 of each a value is right, at 1.1 it is wrong, up and down, component by
//! component, in both arithmetics. The bounds are derived here once more.

use glam::DVec3;
use raypencil_cast::{CastValue, RayVerdict, Stated, Wrong, compare};
use raypencil_referee::ExactCast;
use raypencil_scene::{CastRay, FaceId, Precision, Reading, Sides, Silent, Triangles};

/// A right triangle with edges of 3, 4 and 5 in the plane z = 2: kappa = 4 * 5 / 12, the least height 12 / 5.
fn triangle() -> Triangles {
    let corners = vec![[1.0, 1.0, 2.0], [1.0, 5.0, 2.0], [4.0, 1.0, 2.0]];
    Triangles::new(corners, vec![[0, 1, 2]]).expect("a triangle")
}

/// A ray that meets its inside under the cosine 0.8; its direction is 2.5 long.
fn ray() -> CastRay {
    CastRay::new(DVec3::new(-3.25, 2.0, 9.0), DVec3::new(1.5, 0.0, -2.0))
}

/// The bound of a value, by its derivation: 72 kappa u S / c along the ray and 16 u S across it; S is the largest coordinate of the
/// mesh, 5, and of the ray's start, 9, together.
fn bound(value: CastValue, u: f64) -> f64 {
    let (kappa, size, cosine, length) = (5.0 / 3.0, 5.0 + 9.0, 0.8, 2.5);
    let (range, across) = (72.0 * kappa * u * size / cosine, 16.0 * u * size);
    // Two edges, each within 2 u S if vertices are rounded; the shortest is 3.
    let normal = 16.0 * kappa * u * (1.0 + size / 3.0);
    match value {
        CastValue::T => range / length,
        CastValue::Range => range,
        CastValue::Side => 0.0,
        CastValue::Point => range + across,
        CastValue::Normal => normal,
        CastValue::Barycentric => across / cosine / (12.0 / 5.0) + 16.0 * u,
        CastValue::CosIncidence => normal + 8.0 * u,
    }
}

/// What is true of the ray.
fn exact() -> Stated {
    let (mesh, ray) = (triangle(), ray());
    let hit = ExactCast::new(&mesh).values(&ray, FaceId(0)).expect("a hit");
    let three =
        |parts: [raypencil_referee::Rounded; 3]| Some(vec![DVec3::from_array(parts.map(|one| one.double))]);
    Stated {
        face: Some(vec![Some(FaceId(0))]),
        t: Some(vec![hit.t.double]),
        range: Some(vec![hit.range.double]),
        point: three(hit.point),
        normal: three(hit.normal),
        barycentric: three(hit.barycentric),
        cos_incidence: Some(vec![hit.cos_incidence.double]),
        ..Stated::default()
    }
}

/// What is true, with one component of one value changed; `None` if the value has no such component.
fn changed(value: CastValue, component: usize, change: impl Fn(f64) -> f64) -> Option<Stated> {
    let mut stated = exact();
    let number = match value {
        CastValue::T => &mut stated.t,
        CastValue::Range => &mut stated.range,
        CastValue::CosIncidence => &mut stated.cos_incidence,
        CastValue::Point | CastValue::Normal | CastValue::Barycentric => {
            let vectors = match value {
                CastValue::Point => &mut stated.point,
                CastValue::Normal => &mut stated.normal,
                _ => &mut stated.barycentric,
            };
            let part = &mut vectors.as_mut()?[0][component];
            *part = change(*part);
            return Some(stated);
        }
        CastValue::Side => return None,
    };
    if component > 0 {
        return None;
    }
    let number = &mut number.as_mut()?[0];
    *number = change(*number);
    Some(stated)
}

/// The value that is wrong, if any is.
fn wrong(stated: &Stated, precision: Precision) -> Option<CastValue> {
    let verdicts = compare(&triangle(), &[ray()], Sides::Both, stated, precision, &Silent).verdicts;
    match verdicts[0] {
        RayVerdict::Same { .. } => None,
        RayVerdict::Wrong(Wrong::Value { value, .. }) => Some(value),
        // A distance that is no number says that nothing is hit.
        RayVerdict::Wrong(Wrong::Disagreement { is_hit: true, of, .. }) => {
            CastValue::ALL.into_iter().find(|value| value.name() == of)
        }
        ref other => panic!("{other:?}"),
    }
}

/// Every component of every value.
fn components() -> impl Iterator<Item = (CastValue, usize)> {
    CastValue::ALL.into_iter().flat_map(|value| (0..3).map(move |component| (value, component)))
}

#[test]
fn a_value_is_right_up_to_its_bound_and_wrong_beyond() {
    let mut tried = 0;
    for precision in [Precision::F64, Precision::F32] {
        assert_eq!(wrong(&exact(), precision), None);
        for (value, component) in components() {
            for sign in [1.0, -1.0] {
                let by = |share: f64| {
                    let error = sign * share * bound(value, precision.unit_roundoff);
                    changed(value, component, |exact| exact + error)
                };
                let (Some(near), Some(far)) = (by(0.9), by(1.1)) else { continue };
                let what = format!("{value:?} {component} {sign} {precision:?}");
                assert_eq!(wrong(&near, precision), None, "{what}");
                assert_eq!(wrong(&far, precision), Some(value), "{what}");
                tried += 1;
            }
        }
    }
    // Three numbers and three vectors.
    assert_eq!(tried, 2 * 2 * (3 + 9));
}

#[test]
fn one_component_that_is_no_number_is_wrong() {
    for (value, component) in components() {
        for wild in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let Some(stated) = changed(value, component, |_| wild) else { continue };
            assert_eq!(wrong(&stated, Precision::F32), Some(value), "{value:?} {component} {wild}");
        }
    }
}

/// A program that says only whether anything is hit: right, wrong, and within rounding of an edge and of an end.
#[test]
fn hits_alone_are_judged() {
    let mesh = triangle();
    let down = |x: f64, y: f64| CastRay::new(DVec3::new(x, y, 9.0), DVec3::new(0.0, 0.0, -1.0));
    let verdict = |ray: CastRay, hit: bool, precision: Precision| {
        let stated = Stated { hit: Some(vec![hit]), ..Stated::default() };
        compare(&mesh, &[ray], Sides::Both, &stated, precision, &Silent).verdicts[0]
    };
    let is_same = |verdict| matches!(verdict, RayVerdict::Same { .. });
    let is_rounding = |verdict| matches!(verdict, RayVerdict::Rounding { .. });
    let is_wrong = |verdict| matches!(verdict, RayVerdict::Wrong(_));
    let ends = |t_max: f64| CastRay { t_max, ..down(2.0, 2.0) };
    // The face is at x from 1 on, and at t = 7.
    let pairs =
        [(down(2.0, 2.0), down(0.0, 2.0)), (down(1.0, 2.0), down(0.999, 2.0)), (ends(7.0), ends(6.99))];
    for (met, missed) in pairs {
        for precision in [Precision::F64, Precision::F32] {
            assert!(is_same(verdict(met, true, precision)), "{met:?}");
            assert!(is_same(verdict(missed, false, precision)), "{missed:?}");
            assert!(is_wrong(verdict(missed, true, precision)), "{missed:?}");
        }
    }
    assert!(is_wrong(verdict(down(2.0, 2.0), false, Precision::F32)));
    // Beside the edge, and before the face, by less than f32 rounds and more than f64 does.
    let off = 1e-6;
    let beside = [
        (down(1.0 - off, 2.0), false),
        (down(1.0 + off, 2.0), true),
        (ends(7.0 - off), false),
        (ends(7.0 + off), true),
    ];
    for (ray, is_met) in beside {
        assert!(is_same(verdict(ray, is_met, Precision::F64)), "{ray:?}");
        assert!(is_wrong(verdict(ray, !is_met, Precision::F64)), "{ray:?}");
        assert!(is_rounding(verdict(ray, !is_met, Precision::F32)), "{ray:?}");
    }
    // What is too near is no hit.
    let blind = CastRay { t_blind: 8.0, ..down(2.0, 2.0) };
    assert!(is_same(verdict(blind, false, Precision::F64)));
    let exact = Reading::TooNear;
    assert_eq!(verdict(blind, true, Precision::F64), RayVerdict::Wrong(Wrong::Something { exact }));
}
