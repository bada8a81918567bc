//! Packs of rays: wrong programs fail them, and are told what they do otherwise.

use raypencil_cast::{
    CandidateConventions, Questions, cast, check_ray_pack, rays_from_bytes, write_ray_pack,
};
use raypencil_files::{read_npy_numbers, write_npy_numbers};
use raypencil_scene::{Precision, Sides, Silent, Triangles};

use super::pack_trial::{Folders, VALUES, cube, rays, single, source};

#[test]
fn mistakes_are_found_in_arrays_of_fewer_digits() {
    for is_half in [false, true] {
        let scaled = Folders::right().change("t", |_, t| t * 1.25).change("range", |_, range| range * 1.25);
        let checked = scaled.store(is_half, 0, &VALUES).check();
        let why = checked.why.expect("an explanation");
        assert!(why.contains("1.25"), "half {is_half}: {why}");
    }
    let millimetres = Folders::right().change("t", |_, t| t * 1e3).change("range", |_, range| range * 1e3);
    millimetres.change("point", |_, part| part * 1e3).store(false, 0, &VALUES).expect_why(&["thousandths"]);
    let length = Folders::right().change("normal", |_, part| part * 3.0).store(false, 0, &VALUES);
    length.expect_why(&["normals are not 1 long"]);
    let turned = Folders::right().change("cos_incidence", |_, cos| libm::acos(cos).to_degrees());
    turned.store(false, 0, &VALUES).expect_why(&["angles in degrees"]);
}

#[test]
fn answers_in_another_order_are_named() {
    // 10 rows of 20.
    type From = fn(usize) -> usize;
    let orders: [(From, &str); 4] = [
        (|k| (9 - k / 20) * 20 + k % 20, "if rows of answers run from the last to the first"),
        (|k| k / 20 * 20 + 19 - k % 20, "if the answers of each row run from the last to the first"),
        (|k| 199 - k, "if all answers run from the last ray to the first"),
        // In memory the first index runs fastest: place k has the answer of row k % 10 and column k / 10.
        (|k| k % 10 * 20 + k / 10, "if answers are in column order (F): the last dimension runs fastest (C)"),
    ];
    for (from, words) in orders {
        Folders::right().lay(from).expect_why(&["100.0000 %", words]);
    }
    // One answer on another ray is no order.
    let checked = Folders::right().lay(|k| if k == 57 { 58 } else { k }).check();
    assert!(!checked.passes() && checked.why.is_none(), "{:?}", checked.why);
}

/// What a program is told that gives t of rays from these heights above a face, in another order.
fn laid_otherwise(heights: &[f64], from: impl Fn(usize) -> usize) -> Option<String> {
    let text: String = heights
        .iter()
        .enumerate()
        .map(|(k, up)| format!("{},0.125,{up},0,0,-1\n", k as f64 * 0.01))
        .collect();
    let rays = rays_from_bytes(text.as_bytes(), "here".as_ref()).unwrap();
    let [pack, candidate] = [(); 2].map(|()| tempfile::tempdir().unwrap());
    write_ray_pack(pack.path(), (&cube(), &rays, Sides::Both), &source(), &Silent).unwrap();
    let t: Vec<f64> = (0..heights.len()).map(|k| heights[from(k)] - 1.0).collect();
    write_npy_numbers(candidate.path().join("t.npy"), &[t.len() as u64], &t).unwrap();
    let conventions = CandidateConventions::default();
    let checked =
        check_ray_pack(pack.path(), candidate.path(), Precision::F64, conventions, &Silent).unwrap();
    assert!(!checked.passes());
    checked.why
}

#[test]
fn answers_that_are_exchanged_are_no_order() {
    let reversed = "100.0000 % agree if answers run from the last ray to the first";
    let all = 40;
    let distinct: Vec<f64> = (0..all).map(|k| 3.0 + 0.25 * ((k * 7) % all) as f64).collect();
    assert_eq!(laid_otherwise(&distinct, |k| all - 1 - k).as_deref(), Some(reversed));
    assert_eq!(laid_otherwise(&distinct, |k| (k + all / 2) % all), None);
    // Two answers among equal ones: as a whole they are also the reverse.
    let exchange = |k: usize| if [5, all - 6].contains(&k) { all - 1 - k } else { k };
    let mut equal = vec![3.0; all];
    (equal[5], equal[all - 6]) = (4.25, 6.5);
    assert_eq!(laid_otherwise(&equal, exchange), None);
    assert_eq!(laid_otherwise(&equal, |k| all - 1 - k), None);
    // Halves of equal answers.
    let halves: Vec<f64> = (0..all).map(|k| if k < all / 2 { 3.25 } else { 7.5 }).collect();
    assert_eq!(laid_otherwise(&halves, |k| (k + all / 2) % all), None);
    // Three different answers that move are enough.
    let three: Vec<f64> = (0..all).map(|k| [3.25, 4.5, 7.75][(k * k + k / 3) % 3]).collect();
    assert_eq!(laid_otherwise(&three, |k| all - 1 - k).as_deref(), Some(reversed));
}

#[test]
fn all_axes_are_named() {
    let turned = |folders: Folders, name: &str, order: [usize; 3], signs: [f64; 3]| {
        let right = folders.of(name);
        folders.change(name, |k, _| signs[k % 3] * right[k / 3 * 3 + order[k % 3]])
    };
    let both = |order, signs| {
        let points = turned(Folders::right(), "point", order, signs);
        turned(points, "normal", order, signs)
    };
    both([2, 0, 1], [1.0; 3]).expect_why(&["if points and normals are (z, x, y) of the mesh's (x, y, z)"]);
    both([1, 0, 2], [-1.0, 1.0, -1.0])
        .expect_why(&["if points and normals are (-y, x, -z) of the mesh's (x, y, z)"]);
    turned(Folders::right(), "point", [0, 1, 2], [1.0, 1.0, -1.0])
        .expect_why(&["if points are (x, y, -z) of the mesh's (x, y, z)"]);
    turned(Folders::right(), "normal", [0, 2, 1], [1.0, -1.0, 1.0])
        .expect_why(&["if normals are (x, -z, y) of the mesh's (x, y, z)"]);
    let points = turned(Folders::right().without(&["normal"]), "point", [2, 1, 0], [1.0, 1.0, 1.0]);
    points.expect_why(&["if points are (z, y, x) of the mesh's (x, y, z)"]);
}

#[test]
fn constants_for_misses_are_named() {
    let constant = |number: f64| {
        let of = move |_: usize, length: f64| if length.is_finite() { length } else { number };
        Folders::right().change("t", of).change("range", of).without(&["face"])
    };
    constant(9999.5).expect_why(&["100.0000 %", "if 9999.5 means no hit: declare --miss 9999.5"]);
    constant(1e30).expect_why(&["if 1e30 means no hit: declare --miss 1e30"]);
    let declared = CandidateConventions { miss: Some(9999.5), ..CandidateConventions::default() };
    assert!(constant(9999.5).check_by(Precision::F64, declared).passes());
    let none = f64::from(u32::MAX);
    let of_faces =
        |to: f64| Folders::right().change("face", move |_, face| if face == none { to } else { face });
    of_faces(12.0).expect_why(&["if 12 means no hit: declare --miss 12"]);
    let of_points = |_: usize, part: f64| if part.is_nan() { 1000.0 } else { part };
    Folders::right()
        .change("point", of_points)
        .expect_why(&["100.0000 %", "if 1000 means no hit: declare --miss 1000"]);
    // What differs from miss to miss is no constant.
    let checked = Folders::right()
        .change("t", |k, t| if t.is_finite() { t } else { 50.0 + (k % 3) as f64 })
        .without(&["face"])
        .check();
    assert!(!checked.passes() && checked.why.is_none(), "{:?}", checked.why);
    // 4294967295 in single precision.
    assert!(Folders::right().store(false, 0, &["face"]).check().passes());
}

#[test]
fn exchanged_arguments_are_named() {
    let to_point = Folders::new(Sides::Both, Sides::Both, |ray| ray.direction -= ray.origin);
    to_point.expect_why(&["100.0000 %", "if the direction of a ray is taken for a point that it goes to"]);
    let exchanged = Folders::new(Sides::Both, Sides::Both, |ray| {
        (ray.origin, ray.direction) = (ray.direction, ray.origin);
    });
    exchanged.expect_why(&["if the origin and the direction of a ray are taken for each other"]);
}

#[test]
fn numbers_of_another_convention_are_named() {
    let no_hit = f64::from(u32::MAX);
    let right = Folders::right;
    right()
        .change("face", |_, face| if face == no_hit { -1.0 } else { face + 1.0 })
        .expect_why(&["1 too large"]);
    let ranges = right().of("range");
    right().change("t", |index, _| ranges[index]).expect_why(&["t.npy holds the range"]);
    let t = right().of("t");
    right().change("range", |index, _| t[index]).expect_why(&["range.npy holds t"]);
    let thousandths = |_: usize, length: f64| length * 1e3;
    right()
        .change("t", thousandths)
        .change("range", thousandths)
        .change("point", thousandths)
        .expect_why(&["thousandths"]);
    right().change("normal", |_, part| -part).expect_why(&["normals point inward"]);
    right().change("cos_incidence", |_, cos| cos.abs()).expect_why(&["without sign"]);
    right().change("cos_incidence", |_, cos| libm::acos(cos)).expect_why(&["angles in radians"]);
    let weights = right().of("barycentric");
    right()
        .change("barycentric", |index, _| weights[index / 3 * 3 + (index + 1) % 3])
        .expect_why(&["order (b, c, a)"]);
    right().change("side", |_, side| -side).expect_why(&["taken for each other"]);
}

#[test]
fn lengths_that_are_off_by_one_number_are_named() {
    let rays = rays().rays;
    let size = |index: usize| rays[index].direction.length();
    let lengths = |factor: f64, offset: f64| {
        let folders = Folders::right()
            .change("t", |index, t| factor * t + offset / size(index))
            .change("range", |_, range| factor * range + offset);
        let points = folders.of("point");
        let rays = rays.clone();
        let point = move |index: usize, part: f64| {
            let (ray, at) = (&rays[index / 3], glam::DVec3::from_slice(&points[index / 3 * 3..]));
            let way = at - ray.origin;
            if part.is_finite() {
                (ray.origin + way * (factor + offset / way.length()))[index % 3]
            } else {
                part
            }
        };
        (folders, point)
    };
    // Right points, and points that follow.
    lengths(1.0001, 0.0).0.expect_why(&["100.0000 %", "lengths are 1.0001 times what they are"]);
    let (folders, point) = lengths(0.998, 0.0);
    folders.change("point", point).expect_why(&["100.0000 %", "lengths are 0.998 times what they are"]);
    let (folders, point) = lengths(1.0, 0.025);
    folders.change("point", point).expect_why(&["100.0000 %", "lengths are 0.025 too long"]);
    lengths(1.0, -1e-6).0.without(&["point"]).expect_why(&["lengths are 0.000001 too short"]);
    // Both at once, and an error that grows, are no single number.
    assert_eq!(lengths(1.01, 0.25).0.check().why, None);
    let grown = Folders::right().change("t", |_, t| t * (1.0 + 1e-3 * t)).without(&["range"]);
    assert_eq!(grown.check().why, None);
    // One ray of many is no number of all.
    assert_eq!(
        Folders::right().change("t", |index, t| if index == 7 { 1.01 * t } else { t }).check().why,
        None
    );
}

#[test]
fn two_mistakes_are_both_named() {
    let no_hit = f64::from(u32::MAX);
    let two = Folders::right().change("face", |_, face| if face == no_hit { face } else { face + 1.0 });
    two.change("normal", |_, part| -part).expect_why(&["1 too large", "normals point inward"]);
}

#[test]
fn answers_to_another_question_are_named() {
    Folders::new(Sides::Both, Sides::Both, |ray| ray.t_min = 0.0).expect_why(&["t_min is ignored"]);
    Folders::new(Sides::Both, Sides::Both, |ray| ray.t_max = f64::INFINITY).expect_why(&["t_max is ignored"]);
    Folders::new(Sides::Both, Sides::Fronts, |_| {}).expect_why(&["pass through the backs"]);
    Folders::new(Sides::Fronts, Sides::Both, |_| {}).expect_why(&["hit the backs"]);
}

#[test]
fn single_precision_must_be_declared() {
    let values = ["face", "t", "range", "point", "normal", "barycentric", "cos_incidence"];
    let folders = values.iter().fold(Folders::right(), |folders, name| folders.change(name, single));
    assert!(folders.check_by(Precision::F32, CandidateConventions::default()).passes());
    folders.expect_why(&["declare --arithmetic f32"]);
    // What is right says nothing of what is wrong: lengths alone.
    let lengths = Folders::right().change("t", single).change("range", single);
    lengths.expect_why(&["100.0000 %", "declare --arithmetic f32"]);
}

#[test]
fn a_number_for_no_hit_must_be_declared() {
    let to_zero = |_: usize, distance: f64| if distance.is_finite() { distance } else { 0.0 };
    let folders = Folders::right().without(&["face"]).change("t", to_zero).change("range", to_zero);
    let declared = CandidateConventions { miss: Some(0.0), ..CandidateConventions::default() };
    assert!(folders.check_by(Precision::F64, declared).passes());
    folders.expect_why(&["declare --miss 0"]);
    // Faces alone, of which the first is hit by no ray.
    let mut corners = vec![[100.0, 0.0, 0.0], [101.0, 0.0, 0.0], [100.0, 1.0, 0.0]];
    corners.extend([[0.0, 0.0, 0.0], [8.0, 0.0, 0.0], [0.0, 8.0, 0.0]]);
    let mesh = Triangles::new(corners, vec![[0, 1, 2], [3, 4, 5]]).unwrap();
    let text: String = (0..64).map(|k| format!("{}.5,{}.5,1,0,0,-1\n", k % 8, k / 8)).collect();
    let rays = rays_from_bytes(text.as_bytes(), "here".as_ref()).unwrap();
    let [pack, candidate] = [(); 2].map(|()| tempfile::tempdir().unwrap());
    write_ray_pack(pack.path(), (&mesh, &rays, Sides::Both), &source(), &Silent).unwrap();
    let first = cast(&mesh, &rays.rays, Sides::Both, Questions::default(), &Silent).first;
    let faces: Vec<f64> = first.iter().map(|read| f64::from(u8::from(read.hit().is_some()))).collect();
    write_npy_numbers(candidate.path().join("face.npy"), &[64], &faces).unwrap();
    let conventions = CandidateConventions::default();
    let checked =
        check_ray_pack(pack.path(), candidate.path(), Precision::F64, conventions, &Silent).unwrap();
    let why = checked.why.expect("a reason");
    assert!(why.ends_with("if 0 means no hit: declare --miss 0"), "{why}");
}

/// What makes every ray a miss explains a program that hits nothing, as much as anything does.
#[test]
fn a_program_that_hits_nothing_is_told_so() {
    let nothing = "every ray is a miss: nothing at all is hit";
    let none = || {
        let silent = Folders::right().change("face", |_, _| -1.0);
        ["t", "range"].iter().fold(silent, |folders, name| folders.change(name, |_, _| f64::INFINITY))
    };
    let all = ["side", "point", "normal", "barycentric", "cos_incidence"];
    assert_eq!(none().without(&all).check().why.as_deref(), Some(nothing));
    assert_eq!(none().without(&all).without(&["face", "t"]).check().why.as_deref(), Some(nothing));
    // Few rays hit, and these are wrong.
    let text: String = (0..64).map(|k| format!("{k},0.25,3,0.125,0,-1\n")).collect();
    let rays = rays_from_bytes(text.as_bytes(), "here".as_ref()).unwrap();
    let [pack, candidate] = [(); 2].map(|()| tempfile::tempdir().unwrap());
    write_ray_pack(pack.path(), (&cube(), &rays, Sides::Both), &source(), &Silent).unwrap();
    write_npy_numbers(candidate.path().join("face.npy"), &[64], &[-1.0; 64]).unwrap();
    let conventions = CandidateConventions::default();
    let checked =
        check_ray_pack(pack.path(), candidate.path(), Precision::F64, conventions, &Silent).unwrap();
    assert_eq!((checked.comparison.counts().wrong, checked.why.as_deref()), (1, Some(nothing)));
    // That nothing is hit may be right, and something else wrong.
    let points = none().change("point", |_, value| if value.is_nan() { 0.0 } else { value });
    let why = points.check().why;
    assert!(why.as_deref() != Some(nothing), "{why:?}");
}

/// What a program is told that answers rays upon a plane, each so far from it, with another t.
fn walls_at(distance: f64) -> impl Fn(f64) -> String {
    move |t: f64| {
        let text: String = (0..49)
            .map(|k| {
                format!(
                    "{},{},{},0,0,-1\n",
                    f64::from(k % 7) * 0.25 - 0.8,
                    f64::from(k / 7) * 0.25 - 0.8,
                    1.0 + distance
                )
            })
            .collect();
        let rays = rays_from_bytes(text.as_bytes(), "here".as_ref()).unwrap();
        let [pack, candidate] = [(); 2].map(|()| tempfile::tempdir().unwrap());
        write_ray_pack(pack.path(), (&cube(), &rays, Sides::Both), &source(), &Silent).unwrap();
        write_npy_numbers(candidate.path().join("t.npy"), &[49], &[t; 49]).unwrap();
        let conventions = CandidateConventions::default();
        let checked = check_ray_pack(pack.path(), candidate.path(), Precision::F64, conventions, &Silent);
        checked.unwrap().why.expect("a reason")
    }
}

/// Single precision has bounds that also excuse what is no rounding.
#[test]
fn small_errors_are_told_as_what_they_are() {
    let right = || Folders::right().without(&["side", "point", "normal", "barycentric", "cos_incidence"]);
    let rays = rays().rays;
    let size = |index: usize| rays[index].direction.length();
    let lengths = |factor: f64, offset: f64| {
        right()
            .change("t", |index, t| factor * t + offset / size(index))
            .change("range", |_, range| factor * range + offset)
    };
    lengths(1.0, 1e-8).expect_why(&["100.0000 %", "if lengths are 0.00000001 too long"]);
    lengths(1.0, -3e-9).expect_why(&["100.0000 %", "if lengths are 0.000000003 too short"]);
    lengths(1.000_000_02, 0.0).expect_why(&["100.0000 %", "if lengths are 1.00000002 times what they are"]);
    lengths(1.047_297_551_2, 0.0)
        .expect_why(&["100.0000 %", "if lengths are 1.0472975512 times what they are"]);
    let third = core::f64::consts::PI / 3.0;
    lengths(third, 0.0).expect_why(&["100.0000 %", "if lengths are 1.04719755119"]);
    // Where all lengths are equal, the number of few decimals is told, and of two the factor.
    let plate = walls_at(2.0);
    for (length, words) in [
        (6.0, "lengths are 3 times what they are"),
        (2.03, "lengths are 0.03 too long"),
        (3.0, "lengths are 1 too long"),
    ] {
        assert_eq!(plate(length), format!("100.0000 % agree if {words}"));
    }
    // One of both.
    right().change("t", |_, t| t + 0.125).expect_why(&["100.0000 %", "if t is 0.125 too large"]);
    right().without(&["range"]).change("t", |_, t| t + 1e-8).expect_why(&["if t is 0.00000001 too large"]);
    right().change("t", |_, t| t * 1.25).expect_why(&["100.0000 %", "if t is 1.25 times what it is"]);
    right().change("range", |_, range| range - 0.5).expect_why(&["if the range is 0.5 too short"]);
    right().change("range", |_, range| range * 0.75).expect_why(&["if the range is 0.75 times what it is"]);
    // Mesh and rays in another unit both: t is the same.
    for (by, unit) in [
        (1e3, "thousandths of the mesh's unit"),
        (100.0, "hundredths of"),
        (1e-3, "thousands of"),
        (1.0 / 0.3048, "feet"),
    ] {
        let points = || Folders::right().change("point", |_, part| part * by);
        points().change("range", |_, range| range * by).expect_why(&[
            "100.0000 %",
            &format!("if ranges and points are in {unit}"),
            "and t is right",
        ]);
        points().expect_why(&["100.0000 %", &format!("if points are in {unit}")]);
        points().without(&["range"]).expect_why(&["100.0000 %", &format!("if points are in {unit}")]);
    }
    // Decimals.
    for decimals in [4, 6, 7, 8] {
        let ten = libm::pow(10.0, f64::from(decimals));
        let rounded = move |_: usize, number: f64| {
            if number.is_finite() { (number * ten).round() / ten } else { number }
        };
        let both = right().change("t", rounded).change("range", rounded);
        both.expect_why(&["100.0000 %", &format!("if all values are rounded to {decimals} decimals")]);
        let one = right().change("t", rounded);
        one.expect_why(&["100.0000 %", &format!("if t is rounded to {decimals} decimals")]);
        let normals = Folders::right().change("barycentric", rounded);
        normals.expect_why(&[&format!("if barycentric weights are rounded to {decimals} decimals")]);
    }
    // A multiple that is not the nearest one is no rounding: one ray of 200 stays wrong.
    let hit = right().of("t").iter().position(|t| t.is_finite()).unwrap();
    let other = move |k: usize, t: f64| ((t * 1e4).round() + if k == hit { 3.0 } else { 0.0 }) / 1e4;
    right()
        .change("t", move |k, t| if t.is_finite() { other(k, t) } else { t })
        .expect_why(&["99.5000 %", "if t is rounded to 4 decimals"]);
    // Too long by no number, and always too long: no rounding does that.
    let grown = right().without(&["range"]).change("t", |k, t| t + 1e-8 * (1 + k % 7) as f64);
    assert!(grown.check_by(Precision::F32, CandidateConventions::default()).passes());
    assert_eq!(grown.check().why, None);
    // Errors of the size of rounding, to both sides. (S. Vigna, splitmix64.c)
    let noise = |k: usize| {
        let mixed = (k as u64 + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        let mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((mixed ^ (mixed >> 31)) >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    };
    let computed = right().without(&["range"]).change("t", |k, t| t * (1.0 + 1e-7 * noise(k)));
    computed.expect_why(&["if arithmetic is of single precision"]);
    // The same sizes in an order, along the rays or by channels, are no rounding.
    for period in [150, 16, 2] {
        let wave = move |k: usize| if k % period < period / 2 { 1.0 } else { -1.0 };
        let ordered =
            right().without(&["range"]).change("t", |k, t| t * (1.0 + 1e-7 * wave(k) * noise(k).abs()));
        assert_eq!(ordered.check().why, None, "period {period}");
    }
    // A few wrong numbers of double precision are none of single precision, however small their errors are.
    for size in [1e-8, 1e-9, 1e-11] {
        let few =
            right().without(&["range"]).change("t", |k, t| if k % 71 == 5 { t * (1.0 + size) } else { t });
        assert!(!few.check().passes());
        assert_eq!(few.check().why, None, "{size}");
    }
    let single =
        right().without(&["range"]).change("t", |k, t| if k % 71 == 5 { f64::from(t as f32) } else { t });
    single.expect_why(&["if arithmetic is of single precision"]);
    let finer = right().without(&["range"]).change("t", |k, t| t * (1.0 + 1e-10 * noise(k)));
    assert_eq!(finer.check().why, None);
}

#[test]
fn single_precision_and_orders_are_told_with_another_mistake() {
    let values = ["face", "t", "range", "point", "normal", "barycentric", "cos_incidence"];
    let rounded = || values.iter().fold(Folders::right(), |folders, name| folders.change(name, single));
    let f32 = "arithmetic is of single precision: declare --arithmetic f32";
    rounded().change("normal", |_, part| -part).expect_why(&["normals point inward, ", f32]);
    let mm = |_: usize, length: f64| length * 1e3;
    let three = ["t", "range", "point"].iter().fold(rounded(), |folders, name| folders.change(name, mm));
    three.expect_why(&["lengths are in thousandths of the mesh's unit, ", f32]);
    // Rows from the last to the first.
    let reversed = |folders: Folders| {
        let arrays = values.iter().chain(&["side"]);
        arrays.fold(folders, |folders, name| {
            let path = folders.candidate.path().join(format!("{name}.npy"));
            let array = read_npy_numbers(path, &Default::default()).unwrap().values;
            let row = array.len() / 10;
            folders.change(name, |index, _| array[(9 - index / row) * row + index % row])
        })
    };
    let rows = "rows of answers run from the last to the first, ";
    reversed(rounded()).expect_why(&[rows, f32]);
    reversed(Folders::right().change("normal", |_, part| -part)).expect_why(&[rows, "normals point inward"]);
    reversed(Folders::right().change("t", |_, t| t + 0.125)).expect_why(&[rows, "t is 0.125 too large"]);
}

/// A sensor that stands a little elsewhere, or turns a little further, changes lengths to one side and coordinates to both.
#[test]
fn small_errors_of_one_sign_are_not_told_as_single_precision() {
    let share = |ray: usize| 2.5e-7 * (1.0 + (ray % 5) as f64 / 10.0);
    let longer = |index: usize, length: f64| length * (1.0 + share(index));
    let lengths = || Folders::right().change("t", longer).change("range", longer);
    let moved = lengths().change("point", |index, part| part * (1.0 + share(index / 3)));
    let turned = lengths()
        .change("point", |index, part| part * (1.0 + share(index / 3) * [1.0, -1.0, 1.0][index % 3]));
    for folders in [moved, turned] {
        let checked = folders.check();
        assert!(!checked.passes());
        let why = checked.why.unwrap_or_default();
        assert!(!why.contains("single precision"), "{why}");
    }
}

#[test]
fn errors_without_a_rule_are_not_explained() {
    let checked = Folders::right().change("t", |index, t| t + 1e-3 * (index % 7) as f64).check();
    assert!(!checked.passes() && checked.why.is_none());
    // One wrong ray in six hundred is enough.
    let hit = Folders::right().of("t").iter().position(|t| t.is_finite()).unwrap();
    let checked =
        Folders::right().change("t", |index, t| if index == hit { t * (1.0 + 1e-9) } else { t }).check();
    assert_eq!(checked.comparison.counts().wrong, 1);
}

/// Of many wrong rays those are listed that tell most: wrong hits and wrong values by turns, the worst of each first.
#[test]
fn the_worst_and_the_most_telling_rays_are_listed() {
    let right = Folders::right();
    let faces = read_npy_numbers(right.candidate.path().join("face.npy"), &Default::default());
    let hit: Vec<bool> = faces.unwrap().values.iter().map(|face| *face < 12.0).collect();
    let hits: Vec<usize> = (0..200).filter(|&ray| hit[ray]).collect();
    // Forty lengths, each a little worse than the one before it; then normals; and last of all two wrong faces.
    let (lengths, normals, wrong) =
        (hits[..40].to_vec(), hits[40..45].to_vec(), hits[hits.len() - 2..].to_vec());
    let of = lengths.clone();
    let changed = right
        .change("t", move |ray, t| {
            of.iter().position(|&one| one == ray).map_or(t, |k| t * (1.0 + 1e-6 * (k + 1) as f64))
        })
        .without(&["range", "point"])
        .change("normal", move |at, part| if normals.contains(&(at / 3)) { 2.0 * part } else { part })
        .change("face", {
            let wrong = wrong.clone();
            move |ray, face| if wrong.contains(&ray) { 11.0 - face } else { face }
        });
    let bundle = changed.check().bundle("rays");
    let listed = &bundle.listed;
    let quantities: Vec<&str> = listed.iter().map(|ray| ray.line.quantity.as_str()).collect();
    assert_eq!(&quantities[..6], ["first hit", "t", "normal", "first hit", "t", "normal"], "{quantities:?}");
    assert_eq!(listed.len(), 12);
    // The first length is the worst of the table.
    let worst = bundle.items.iter().find(|item| item.key == "t").unwrap().worst_ratio.as_ref().unwrap();
    assert_eq!(listed[1].line.place, worst.place);
    assert_ne!(listed[1].line.place, format!("rays {}", lengths[0]), "the first one is not the worst");
}
