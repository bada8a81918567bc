//! Faces that are so thin that f64 cannot form their normals: what rounding explains is no mistake, and what it does not is one.

use glam::DVec3;
use raypencil_cast::{
    CandidateConventions, CastValue, RayArray, RayVerdict, Stated, check_ray_pack, compare, comparison_text,
    write_ray_pack,
};
use raypencil_files::write_npy_numbers;
use raypencil_referee::ExactCast;
use raypencil_scene::{CastRay, Precision, Sides, Silent, Triangles};

use super::pack_trial::source;

/// Numbers from -1 to 1. (S. Vigna, splitmix64.c)
fn numbers(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed;
    move || {
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 * libm::scalbn(1.0, -52) - 1.0
    }
}

/// Needles some 10 long and as thin as rounding leaves them: the third corner lies between the two others, but for its rounding.
/// Three rays at each: at a corner, at the middle of an edge, and inside.
fn needles(count: usize) -> (Triangles, Vec<CastRay>) {
    let mut next = numbers(17);
    let mut place = || DVec3::new(10.0 * next(), 10.0 * next(), 10.0 * next());
    let (mut corners, mut faces, mut rays) = (Vec::new(), Vec::new(), Vec::new());
    for face in 0..count as u32 {
        let [a, b, from] = [place(), place(), place()];
        let c = a + 0.375 * (b - a);
        corners.extend([a, b, c].map(|corner| corner.to_array()));
        faces.push([0, 1, 2].map(|k| 3 * face + k));
        for weights in [DVec3::X, DVec3::new(0.5, 0.5, 0.0), DVec3::new(0.25, 0.375, 0.375)] {
            let target = a * weights.x + b * weights.y + c * weights.z;
            rays.push(CastRay::new(from, target - from));
        }
    }
    (Triangles::new(corners, faces).expect("triangles"), rays)
}

/// What another program answers to rays that hit their needles exactly, and nothing before.
fn exact_hits() -> (Triangles, Vec<CastRay>, Stated) {
    let (mesh, rays) = needles(400);
    let exact = ExactCast::new(&mesh);
    let hits = |ray: &CastRay| !exact.first(ray, Sides::Both).is_empty();
    let rays: Vec<CastRay> = rays.into_iter().filter(hits).collect();
    let answers = raypencil_cast::cast(&mesh, &rays, Sides::Both, Default::default(), &Silent);
    (mesh, rays, Stated::of(&answers))
}

#[test]
fn a_right_program_is_not_wrong_on_needles() {
    let (mesh, rays) = needles(400);
    let stated = Stated::by_tracer(&mesh, &rays, Sides::Both);
    let compared = compare(&mesh, &rays, Sides::Both, &stated, Precision::F64, &Silent);
    assert_eq!(compared.wrong().next(), None);
    // Both kinds are there: many a ray misses its needle by less than rounding, and each program decides as it rounds.
    let counts = compared.counts();
    assert!(counts.rounding > 20 && counts.same > 200, "{counts:?}");
    // A witness is a displacement at which the ray meets what is stated, or which brings it to a corner, exactly but for the rounding
    // of the displacement.
    let exact = ExactCast::new(&mesh);
    let faces = stated.face.expect("faces");
    for (index, verdict) in compared.verdicts.iter().enumerate() {
        let (RayVerdict::Rounding { moved: [dx, dy] }, Some(face)) = (verdict, faces[index]) else {
            continue;
        };
        let ray = &rays[index];
        let met = exact.first_moved(ray, Sides::Both, [*dx, *dy]);
        let [across, down] = ray.across();
        let origin = ray.origin + across * *dx + down * *dy;
        let off = |corner: DVec3| (corner - origin).cross(ray.direction).length() / ray.direction.length();
        let is_at_corner = mesh.corners(face).into_iter().any(|corner| off(corner) < 4e-15);
        assert!(met.contains(&face) || is_at_corner, "ray {index}: {met:?} at {dx:e}, {dy:e}");
    }
}

#[test]
fn a_wrong_distance_is_seen_on_every_needle() {
    let (mesh, rays, mut stated) = exact_hits();
    assert!(rays.len() > 30, "{} rays", rays.len());
    let right = compare(&mesh, &rays, Sides::Both, &stated, Precision::F64, &Silent);
    assert_eq!(right.counts().same, rays.len() as u64);
    // Beyond all that rounding may do to a needle 10 long with an aspect of 2^53.
    stated.t.iter_mut().flatten().for_each(|t| *t += 1e6);
    let wrong = compare(&mesh, &rays, Sides::Both, &stated, Precision::F64, &Silent);
    assert_eq!(wrong.counts().wrong, rays.len() as u64);
}

#[test]
fn a_normal_of_which_rounding_may_make_anything_is_counted_as_not_compared() {
    let (mesh, rays, mut stated) = exact_hits();
    stated.normal.iter_mut().flatten().for_each(|normal| *normal = -*normal);
    let turned = compare(&mesh, &rays, Sides::Both, &stated, Precision::F64, &Silent);
    let of = |value: CastValue| *turned.values.iter().find(|tally| tally.value == value).expect("a tally");
    let normals = of(CastValue::Normal);
    assert_eq!(normals.compared + normals.not_compared, rays.len() as u64);
    assert!(normals.not_compared > 20, "{normals:?}");
    let said = comparison_text("turned", &turned, |_| String::new());
    assert!(said.contains("were not compared: rounding may make anything of them"), "{said}");
    // Those that are compared are wrong, all of them.
    assert_eq!(normals.wrong, normals.compared);
    let lengths = of(CastValue::T);
    assert_eq!((lengths.compared, lengths.wrong, lengths.not_compared), (rays.len() as u64, 0, 0));
}

#[test]
fn tiny_needles_have_the_bounds_of_large_ones() {
    let unit = libm::scalbn(1.0, -600);
    let corner = |x: f64, y: f64| (unit * DVec3::new(x, y, 0.0)).to_array();
    let mesh = Triangles::new(vec![corner(0.0, 0.0), corner(1.0, 0.0), corner(0.0, 1.0)], vec![[0, 1, 2]])
        .expect("a triangle");
    let ray = CastRay::new(unit * DVec3::new(0.25, 0.25, 1.0), DVec3::NEG_Z);
    let answers = raypencil_cast::cast(&mesh, &[ray], Sides::Both, Default::default(), &Silent);
    let mut stated = Stated::of(&answers);
    let counts = |stated: &Stated| {
        let compared = compare(&mesh, &[ray], Sides::Both, stated, Precision::F64, &Silent);
        assert!(compared.values.iter().all(|tally| (tally.compared, tally.not_compared) == (1, 0)));
        (compared.counts().same, compared.counts().wrong)
    };
    assert_eq!(counts(&stated), (1, 0));
    // A weight off by a rounding or two is right; by a thousandth it is not.
    let weights = stated.barycentric.clone().expect("weights")[0];
    stated.barycentric = Some(vec![weights + DVec3::new(f64::EPSILON, 0.0, 0.0)]);
    assert_eq!(counts(&stated), (1, 0));
    stated.barycentric = Some(vec![weights + DVec3::new(1e-3, 0.0, 0.0)]);
    assert_eq!(counts(&stated), (0, 1));
}

#[test]
fn no_reason_is_given_where_only_lengths_on_needles_are_wrong() {
    let why = |mesh: &Triangles, rays: &[CastRay], by: f64| {
        let (pack, candidate) =
            (tempfile::tempdir().expect("a folder"), tempfile::tempdir().expect("a folder"));
        let count = rays.len() as u64;
        let array = RayArray { shape: vec![count], rays: rays.to_vec() };
        write_ray_pack(pack.path(), (mesh, &array, Sides::Both), &source(), &Silent).expect("a pack");
        let exact = ExactCast::new(mesh);
        let met: Vec<_> = rays.iter().map(|ray| exact.first(ray, Sides::Both)[0]).collect();
        let t =
            rays.iter().zip(&met).map(|(ray, face)| by * exact.values(ray, *face).expect("a hit").t.double);
        let faces: Vec<f64> = met.iter().map(|face| f64::from(face.0)).collect();
        write_npy_numbers(candidate.path().join("t.npy"), &[count], &t.collect::<Vec<_>>()).expect("t");
        write_npy_numbers(candidate.path().join("face.npy"), &[count], &faces).expect("faces");
        let conventions = CandidateConventions::default();
        let checked = check_ray_pack(pack.path(), candidate.path(), Precision::F64, conventions, &Silent);
        let checked = checked.expect("a check");
        assert!(checked.comparison.counts().wrong > 0);
        checked.why
    };
    // Far beyond all bounds; a thousandth of it, and much else, is within them.
    let (mesh, rays, _) = exact_hits();
    assert_eq!(why(&mesh, &rays, 1e6), None);
    // The same on faces of ordinary shape has its reason.
    let square = vec![[-9.0, -9.0, 0.0], [9.0, -9.0, 0.0], [0.0, 9.0, 0.0]];
    let mesh = Triangles::new(square, vec![[0, 1, 2]]).expect("a triangle");
    let rays: Vec<CastRay> =
        (1..20).map(|k| CastRay::new(DVec3::new(0.1, 0.2, f64::from(k)), DVec3::NEG_Z)).collect();
    assert!(why(&mesh, &rays, 1e3).expect("a reason").contains("thousandths"));
}
