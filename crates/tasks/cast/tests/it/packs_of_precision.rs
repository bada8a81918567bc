//! Which answers to a pack of rays look like single precision: those of a program that computes so, and not those of a mesh that is a little
//! elsewhere, or of lengths in steps.

use glam::DVec3;
use raypencil_cast::{
    CandidateConventions, Questions, RayPackChecked, cast, check_ray_pack, write_answers, write_ray_pack,
};
use raypencil_files::write_npy_numbers;
use raypencil_scene::{CastRay, Precision, Sides, Silent, Triangles};

use super::pack_trial::{Folders, cube, rays, source};

/// A number from -1 to 1 that is drawn by its index. (S. Vigna, splitmix64.c)
fn drawn(k: usize) -> f64 {
    let mixed = (k as u64 + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    let mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((mixed ^ (mixed >> 31)) >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
}

/// The cube, turned and moved: its corners have no short decimals.
fn turned() -> Triangles {
    moved(&cube(), |_, corner| {
        let turn = glam::DQuat::from_axis_angle(DVec3::new(0.6, 0.0, 0.8), 0.7);
        turn * corner * 1.1 + DVec3::new(0.123_456_789, 0.2, -0.1)
    })
}

fn moved(mesh: &Triangles, to: impl Fn(usize, DVec3) -> DVec3) -> Triangles {
    let corners = mesh.vertices().iter().enumerate().map(|(k, corner)| to(k, (*corner).into()).to_array());
    Triangles::new(corners.collect(), mesh.faces().to_vec()).expect("a mesh")
}

/// A pack upon a mesh, and what `check` says of the exact answers upon another one.
fn judged(mesh: &Triangles, other: &Triangles, change: impl Fn(&mut CastRay)) -> RayPackChecked {
    judged_without(&["point", "normal", "barycentric", "cos_incidence"], mesh, other, change)
}

/// The same, where the answers lack these arrays.
fn judged_without(
    lacking: &[&str],
    mesh: &Triangles,
    other: &Triangles,
    change: impl Fn(&mut CastRay),
) -> RayPackChecked {
    let [pack, candidate] = [(); 2].map(|()| tempfile::tempdir().expect("a folder"));
    let asked = rays();
    write_ray_pack(pack.path(), (mesh, &asked, Sides::Both), &source(), &Silent).expect("a pack");
    let mut changed = asked.clone();
    changed.rays.iter_mut().for_each(change);
    let answers = cast(other, &changed.rays, Sides::Both, Questions::default(), &Silent);
    write_answers(candidate.path(), &answers, (other, &changed, Sides::Both), &source()).expect("answers");
    for name in lacking {
        std::fs::remove_file(candidate.path().join(format!("{name}.npy"))).expect("a file");
    }
    let conventions = CandidateConventions::default();
    let checked = check_ray_pack(pack.path(), candidate.path(), Precision::F64, conventions, &Silent);
    checked.expect("a check")
}

/// Corners that are rounded or moved by as little as single precision rounds, or by a little more.
#[test]
fn a_mesh_that_is_a_little_elsewhere_is_no_single_precision() {
    let mesh = turned();
    for decimals in 4..=6 {
        let ten = libm::pow(10.0, f64::from(decimals));
        let rounded = moved(&mesh, |_, corner| (corner * ten).round() / ten);
        let checked = judged(&mesh, &rounded, |_| {});
        assert!(!checked.passes() && checked.why.is_none(), "{decimals} decimals: {:?}", checked.why);
    }
    for size in [1e-7, 1e-6, 3e-5] {
        let part = |k: usize| size * drawn(k);
        let noisy =
            moved(&mesh, |k, corner| corner + DVec3::new(part(3 * k), part(3 * k + 1), part(3 * k + 2)));
        let checked = judged(&mesh, &noisy, |_| {});
        assert!(!checked.passes() && checked.why.is_none(), "{size}: {:?}", checked.why);
    }
}

#[test]
fn a_shift_is_told_as_itself() {
    let mesh = turned();
    for (shift, words) in [
        (DVec3::splat(1e-5), "(0.00001, 0.00001, 0.00001)"),
        (DVec3::new(0.0, 0.0, 3e-5), "(0, 0, 0.00003)"),
        (DVec3::new(0.25, 0.0, -0.125), "(0.25, 0, -0.125)"),
    ] {
        let of_mesh = judged(&mesh, &moved(&mesh, |_, corner| corner + shift), |_| {});
        let of_origins = judged(&mesh, &mesh, |ray| ray.origin -= shift);
        for checked in [of_mesh, of_origins] {
            assert!(!checked.passes());
            let told = format!("if the mesh is shifted by {words} against the rays");
            assert!(checked.why.as_ref().is_some_and(|why| why.contains(&told)), "{:?}", checked.why);
        }
    }
}

#[test]
fn points_tell_a_shift_of_the_mesh_from_one_of_the_origins() {
    let (mesh, shift) = (turned(), DVec3::new(0.25, 0.0, -0.125));
    for lacking in [&["normal"][..], &["t"], &["range", "barycentric"]] {
        let of_mesh = judged_without(lacking, &mesh, &moved(&mesh, |_, corner| corner + shift), |_| {});
        let of_origins = judged_without(lacking, &mesh, &mesh, |ray| ray.origin -= shift);
        for (checked, words) in [
            (of_mesh, "agree if the mesh is shifted by (0.25, 0, -0.125) against the rays"),
            (
                of_origins,
                "agree if the origins of the rays are shifted by (-0.25, 0, 0.125) against the mesh",
            ),
        ] {
            assert!(!checked.passes());
            assert!(checked.why.as_ref().is_some_and(|why| why.ends_with(words)), "{:?}", checked.why);
        }
    }
}

#[test]
fn steps_and_noise_of_lengths_are_no_single_precision() {
    let right = || Folders::right().without(&["point"]);
    let steps = [(libm::ldexp(1.0, -16), "0.0000152587890625"), (7e-6, "0.000007"), (25e-6, "0.000025")];
    for (step, words) in steps {
        let rounded =
            move |_: usize, range: f64| if range.is_finite() { (range / step).round() * step } else { range };
        right()
            .change("range", rounded)
            .expect_why(&[&format!("if the range is rounded to multiples of {words}")]);
    }
    for size in [3e-5, 1e-5] {
        let checked = right().change("range", |k, range| range + size * drawn(k)).check();
        assert!(!checked.passes() && checked.why.is_none(), "{size}: {:?}", checked.why);
    }
}

/// t of the nearest face, in single precision from the first number on. (T. Moeller and B. Trumbore, 1997)
fn single_t(mesh: &Triangles, ray: &CastRay) -> Option<(usize, f32)> {
    let of = |v: DVec3| v.as_vec3();
    let (origin, along) = (of(ray.origin), of(ray.direction));
    let met = mesh.faces().iter().enumerate().filter_map(|(face, corners)| {
        let [a, b, c] = corners.map(|corner| of(mesh.vertices()[corner as usize].into()));
        let (one, two, from) = (b - a, c - a, origin - a);
        let (across, beside) = (along.cross(two), from.cross(one));
        let area = one.dot(across);
        let [u, v, t] = [from.dot(across), along.dot(beside), two.dot(beside)].map(|part| part / area);
        let is_met = u >= 0.0 && v >= 0.0 && u + v <= 1.0;
        let is_within = f64::from(t) >= ray.t_min && f64::from(t) <= ray.t_max;
        (is_met && is_within).then_some((face, t))
    });
    met.min_by(|a, b| a.1.total_cmp(&b.1))
}

/// A program that computes t in single precision, and the range from it in double.
#[test]
fn a_program_of_single_precision_is_told_so() {
    let mesh = turned();
    let asked = rays();
    let [pack, candidate] = [(); 2].map(|()| tempfile::tempdir().expect("a folder"));
    write_ray_pack(pack.path(), (&mesh, &asked, Sides::Both), &source(), &Silent).expect("a pack");
    let met: Vec<_> = asked.rays.iter().map(|ray| single_t(&mesh, ray)).collect();
    let t = |k: usize| met[k].map_or(f64::INFINITY, |(_, t)| f64::from(t));
    let write = |name: &str, number: &dyn Fn(usize) -> f64| {
        let numbers: Vec<f64> = (0..met.len()).map(number).collect();
        write_npy_numbers(candidate.path().join(name), &[10, 20], &numbers).expect("a file");
    };
    write("face.npy", &|k| met[k].map_or(-1.0, |(face, _)| face as f64));
    for has_t in [true, false] {
        match has_t {
            true => write("t.npy", &t),
            false => std::fs::remove_file(candidate.path().join("t.npy")).expect("a file"),
        }
        write("range.npy", &|k| t(k) * asked.rays[k].direction.length());
        let conventions = CandidateConventions::default();
        let check =
            |precision| check_ray_pack(pack.path(), candidate.path(), precision, conventions, &Silent);
        let checked = check(Precision::F64).expect("a check");
        let why = checked.why.as_deref().unwrap_or("no reason");
        assert!(why.ends_with("if arithmetic is of single precision: declare --arithmetic f32"), "{why}");
        assert!(check(Precision::F32).expect("a check").passes());
    }
}
