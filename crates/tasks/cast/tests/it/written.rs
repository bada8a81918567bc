//! What is written of answers and of comparisons, number by number, and counts of rays at their limits.

use std::path::Path;

use glam::DVec3;
use raypencil_cast::{
    Answers, CandidateConventions, CastSource, CastValue, Comparison, MeshHome, Questions, RayArray,
    RayVerdict, Stated, StoredErrors, Wrong, cast, cast_warnings, check_ray_pack, compare, counts_text,
    open_edges, rays_from_bytes, read_stated, write_answers, write_comparison, write_ray_pack,
};
use raypencil_files::{read_npy_numbers, write_npy_numbers};
use raypencil_scene::{CastRay, FaceId, Precision, Reading, Side, Sides, Silent, Triangles};

/// A square from (0, 0) to (4, 4) in the plane z = 1 with its front up, of two faces.
fn square() -> Triangles {
    let corners = vec![[0.0, 0.0, 1.0], [4.0, 0.0, 1.0], [4.0, 4.0, 1.0], [0.0, 4.0, 1.0]];
    Triangles::new(corners, vec![[0, 1, 2], [0, 2, 3]]).unwrap()
}

/// A hit under a slope, a tie, a back, one that is too near, and two misses. Directions have lengths other than 1.
fn rays() -> RayArray {
    let text = "3,1,3,1,0,-4,0,inf,0\n2,2,3,0,0,-2,0,inf,0\n1,3,-1,0,0.5,4,0,inf,0\n3,1,1.5,0,0,-2,0,inf,1\n9,9,3,0,0,-2,0,inf,0\n9,8,3,0,0,-2,0,inf,0";
    RayArray { shape: vec![6], rays: rays_from_bytes(text.as_bytes(), "here".as_ref()).unwrap().rays }
}

fn answers(sides: Sides) -> Answers {
    cast(&square(), &rays().rays, sides, Questions::default(), &Silent)
}

fn source() -> CastSource {
    CastSource { mesh: "square".into(), rays: "rays".into(), ..CastSource::default() }
}

fn numbers(folder: &Path, name: &str) -> (Vec<u64>, Vec<f64>) {
    let array = read_npy_numbers(folder.join(format!("{name}.npy")), &Default::default()).unwrap();
    (array.shape, array.values)
}

fn same(a: &[f64], b: &[f64]) -> bool {
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| a == b || a.is_nan() && b.is_nan())
}

#[test]
fn each_array_has_its_own_value_and_the_summary_its_own_counts() {
    let folder = tempfile::tempdir().unwrap();
    let (answers, none) = (answers(Sides::Both), f64::NAN);
    write_answers(folder.path(), &answers, (&square(), &rays(), Sides::Both), &source()).unwrap();
    let reads: Vec<&str> = answers
        .first
        .iter()
        .map(|read| match read {
            Reading::Hit(hit) if hit.side == Side::Back => "back",
            Reading::Hit(_) => "front",
            Reading::TooNear => "too near",
            Reading::Miss => "miss",
        })
        .collect();
    assert_eq!(reads, ["front", "front", "back", "too near", "miss", "miss"]);
    let by = |of: &dyn Fn(&raypencil_cast::FirstHit) -> f64, too_near: f64, miss: f64| -> Vec<f64> {
        let number = |read: &Reading<raypencil_cast::FirstHit>| match read {
            Reading::Hit(hit) => of(hit),
            Reading::TooNear => too_near,
            Reading::Miss => miss,
        };
        answers.first.iter().map(number).collect()
    };
    let no_face = f64::from(u32::MAX);
    let lengths = (f64::NEG_INFINITY, f64::INFINITY);
    for (name, expected) in [
        ("face", by(&|hit| f64::from(hit.face.0), no_face, no_face)),
        ("side", by(&|hit| if hit.side == Side::Front { 1.0 } else { -1.0 }, 0.0, 0.0)),
        ("ties", by(&|hit| f64::from(hit.ties), 0.0, 0.0)),
        ("t", by(&|hit| hit.t, lengths.0, lengths.1)),
        ("range", by(&|hit| hit.range, lengths.0, lengths.1)),
        ("cos_incidence", by(&|hit| hit.cos_incidence, none, none)),
    ] {
        let (shape, found) = numbers(folder.path(), name);
        assert_eq!(shape, [6], "{name}");
        assert!(same(&found, &expected), "{name}: {found:?}, not {expected:?}");
    }
    type Vector = fn(&raypencil_cast::FirstHit) -> [f64; 3];
    let vectors: [(&str, Vector); 3] = [
        ("point", |hit| hit.point.to_array()),
        ("normal", |hit| hit.normal.to_array()),
        ("barycentric", |hit| hit.barycentric),
    ];
    for (name, of) in vectors {
        let (shape, found) = numbers(folder.path(), name);
        let expected: Vec<f64> = (0..6).flat_map(|k| answers.first[k].hit().map_or([none; 3], of)).collect();
        assert_eq!(shape, [6, 3], "{name}");
        assert!(same(&found, &expected), "{name}: {found:?}, not {expected:?}");
    }
    let text = std::fs::read_to_string(folder.path().join("summary.json")).unwrap();
    let summary: serde_json::Value = serde_json::from_str(&text).unwrap();
    assert_eq!(summary["counts"], serde_json::json!({ "hits": 3, "tooNear": 1, "misses": 2, "ties": 1 }));
    assert_eq!(counts_text(&answers), "6 rays: 3 hit, 1 of them at a tie; 1 too near; 2 miss");
    // What was written is read as what it says.
    let stated = read_stated(folder.path(), &[6], CandidateConventions::default()).unwrap();
    let own = Stated::of(&answers);
    assert_eq!((&stated.face, &stated.side), (&own.face, &own.side));
    for (read, own) in [(&stated.t, &own.t), (&stated.range, &own.range)] {
        assert!(same(read.as_ref().unwrap(), own.as_ref().unwrap()));
    }
}

#[test]
fn a_number_for_a_miss_is_one_in_each_array_and_means_nothing_else() {
    let folder = tempfile::tempdir().unwrap();
    let distances = [2.0, -7.0, f64::INFINITY, f64::NEG_INFINITY, f64::NAN];
    for name in ["t", "range"] {
        write_npy_numbers(folder.path().join(format!("{name}.npy")), &[5], &distances).unwrap();
    }
    write_npy_numbers(folder.path().join("face.npy"), &[5], &[0.0, -7.0, -1.0, 4_294_967_295.0, 1.0])
        .unwrap();
    write_npy_numbers(folder.path().join("side.npy"), &[5], &[1.0, -1.0, 0.0, 1.0, -1.0]).unwrap();
    let conventions = CandidateConventions { miss: Some(-7.0), ..CandidateConventions::default() };
    let stated = read_stated(folder.path(), &[5], conventions).unwrap();
    let (inf, near) = (f64::INFINITY, f64::NEG_INFINITY);
    assert_eq!(
        (stated.t, stated.range),
        (Some(vec![2.0, inf, inf, near, inf]), Some(vec![2.0, inf, inf, near, inf]))
    );
    assert_eq!(stated.face, Some(vec![Some(FaceId(0)), None, None, None, Some(FaceId(1))]));
    let sides = [Some(Side::Front), Some(Side::Back), None, Some(Side::Front), Some(Side::Back)];
    assert_eq!(stated.side, Some(sides.to_vec()));
}

#[test]
fn each_verdict_has_its_number_and_only_an_excuse_a_displacement() {
    let folder = tempfile::tempdir().unwrap();
    let verdicts = vec![
        RayVerdict::Same { is_tie: false },
        RayVerdict::Same { is_tie: true },
        RayVerdict::Rounding { moved: [0.25, -0.5] },
        RayVerdict::Wrong(Wrong::Contradiction),
    ];
    let comparison = Comparison { verdicts, values: Vec::new(), met: 4, precision: Precision::F64 };
    let counts = comparison.counts();
    assert_eq!((counts.same, counts.ties, counts.rounding, counts.wrong, counts.all()), (2, 1, 1, 1, 4));
    let stated =
        Stated { face: Some(vec![Some(FaceId(3)), None, Some(FaceId(0)), None]), ..Stated::default() };
    let names = write_comparison(folder.path(), "mine", &[2, 2], &stated, &comparison).unwrap();
    assert_eq!(names, ["mine.verdict.npy", "mine.moved.npy", "mine.face.npy"]);
    assert_eq!(numbers(folder.path(), "mine.verdict"), (vec![2, 2], vec![0.0, 1.0, 2.0, 3.0]));
    let (shape, moved) = numbers(folder.path(), "mine.moved");
    assert_eq!(shape, [2, 2, 2]);
    let nan = f64::NAN;
    assert!(same(&moved, &[nan, nan, nan, nan, 0.25, -0.5, nan, nan]), "{moved:?}");
    let none = f64::from(u32::MAX);
    assert_eq!(numbers(folder.path(), "mine.face"), (vec![2, 2], vec![3.0, none, 0.0, none]));
}

#[test]
fn of_equal_errors_the_first_ray_is_told_and_of_no_ray_that_meets_something_nothing_passes() {
    let mesh = square();
    let ray = |x: f64| CastRay::new(DVec3::new(x, 1.0, 3.0), DVec3::new(0.0, 0.0, -2.0));
    // Of equal rays the bounds are equal, too.
    let rays = [ray(2.0), ray(2.5), ray(3.0), ray(2.5)];
    let mut stated = Stated::of(&cast(&mesh, &rays, Sides::Both, Questions::default(), &Silent));
    for index in [1, 3] {
        stated.t.as_mut().unwrap()[index] += 1e-14;
    }
    let compared = compare(&mesh, &rays, Sides::Both, &stated, Precision::F64, &Silent);
    let worst =
        |value: CastValue| compared.values.iter().find(|tally| tally.value == value).unwrap().worst.unwrap();
    assert_eq!((worst(CastValue::T).1, worst(CastValue::Range)), (1, (0.0, 0)));
    assert!(compared.passes());
    // All right, and all miss.
    let away = [ray(9.0), ray(10.0)];
    let stated = Stated::of(&cast(&mesh, &away, Sides::Both, Questions::default(), &Silent));
    let compared = compare(&mesh, &away, Sides::Both, &stated, Precision::F64, &Silent);
    assert_eq!((compared.counts().wrong, compared.met, compared.passes()), (0, 0, false));
}

#[test]
fn rays_that_are_compared_piece_by_piece_are_counted_as_all_at_once() {
    // The rays twice over; two hits of the first half and two of the second are wrong, by the same error and by a larger one.
    let rays = [rays().rays, rays().rays].concat();
    let mut stated = Stated::of(&cast(&square(), &rays, Sides::Both, Questions::default(), &Silent));
    let t = stated.t.as_mut().unwrap();
    for (ray, more) in [(0, 0.25), (2, 0.125), (6, 0.25), (8, 0.5)] {
        t[ray] += more;
    }
    let compared = |from: usize, to: usize| {
        fn some<T: Copy>(all: &Option<Vec<T>>, from: usize, to: usize) -> Option<Vec<T>> {
            all.as_ref().map(|all| all[from..to].to_vec())
        }
        // Of a piece the t alone, as of all.
        let piece =
            Stated { face: some(&stated.face, from, to), t: some(&stated.t, from, to), ..Stated::default() };
        compare(&square(), &rays[from..to], Sides::Both, &piece, Precision::F64, &Silent)
    };
    let whole = compared(0, rays.len());
    assert_eq!((whole.counts().wrong, whole.values[0].wrong), (4, 4));
    assert_eq!(whole.values[0].worst.map(|(_, ray)| ray), Some(8));
    for cut in 1..rays.len() {
        let mut pieces = compared(0, cut);
        pieces.append(compared(cut, rays.len()));
        assert_eq!(pieces, whole, "cut before ray {cut}");
    }
    // Of equal errors in two pieces the first is told.
    let mut twice = compared(0, 2);
    twice.append(compared(6, 8));
    assert_eq!(twice.values[0].worst.map(|(_, ray)| ray), Some(0));
}

#[test]
fn storing_a_value_widens_its_own_bound_and_no_other() {
    let mesh = square();
    let rays = [CastRay::new(DVec3::new(3.0, 1.0, 3.0), DVec3::new(0.0, 0.0, -2.0))];
    let right = Stated::of(&cast(&mesh, &rays, Sides::Both, Questions::default(), &Silent));
    type Change = fn(&mut Stated);
    type Errors = fn(&mut StoredErrors) -> &mut Option<Vec<f64>>;
    let values: [(Change, Errors); 6] = [
        (|stated| stated.t.as_mut().unwrap()[0] += 1e-3, |stored| &mut stored.t),
        (|stated| stated.range.as_mut().unwrap()[0] += 1e-3, |stored| &mut stored.range),
        (|stated| stated.point.as_mut().unwrap()[0].x += 1e-3, |stored| &mut stored.point),
        (|stated| stated.normal.as_mut().unwrap()[0].y += 1e-3, |stored| &mut stored.normal),
        (|stated| stated.barycentric.as_mut().unwrap()[0].z += 1e-3, |stored| &mut stored.barycentric),
        (|stated| stated.cos_incidence.as_mut().unwrap()[0] -= 1e-3, |stored| &mut stored.cos_incidence),
    ];
    for (k, (change, _)) in values.iter().enumerate() {
        for (other, (_, errors)) in values.iter().enumerate() {
            for size in [0.999e-3, 1.001e-3] {
                let mut stated = right.clone();
                change(&mut stated);
                *errors(&mut stated.stored) = Some(vec![size]);
                let counts = compare(&mesh, &rays, Sides::Both, &stated, Precision::F64, &Silent).counts();
                assert_eq!(counts.wrong == 0, k == other && size > 1e-3, "value {k}, stored {other}, {size}");
            }
        }
    }
}

#[test]
fn half_of_the_hits_may_be_backs() {
    let ray = |z: f64, down: f64| CastRay::new(DVec3::new(3.0, 1.0, z), DVec3::new(0.0, 0.0, down));
    let warned = |fronts: usize, backs: usize| {
        let rays: Vec<CastRay> =
            (0..fronts).map(|_| ray(3.0, -1.0)).chain((0..backs).map(|_| ray(-1.0, 1.0))).collect();
        let answers = cast(&square(), &rays, Sides::Both, Questions::default(), &Silent);
        !cast_warnings((&square(), MeshHome::default()), &rays, Sides::Both, None, &answers).is_empty()
    };
    assert!(!warned(4, 0) && !warned(4, 3) && !warned(4, 4));
    assert!(warned(4, 5) && warned(0, 4));
}

#[test]
fn zeros_of_both_signs_are_one_place() {
    // A tetrahedron whose vertices stand thrice, once for each face, with zeros of either sign.
    let (a, b, c, d) = ([0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]);
    let faces = [[a, c, b], [a, b, d], [a, d, c], [b, c, d]];
    for signs in 0..2_usize {
        let vertices: Vec<[f64; 3]> = faces
            .iter()
            .enumerate()
            .flat_map(|(k, face)| {
                face.map(|corner| corner.map(|x| if x == 0.0 && (k + signs) % 2 == 0 { -0.0 } else { x }))
            })
            .collect();
        let indices = (0..4).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
        assert_eq!(open_edges(&Triangles::new(vertices, indices).unwrap()), 0);
    }
}

#[test]
fn every_digit_of_a_pack_s_digests_and_every_one_of_its_first_hits_counts() {
    let folder = tempfile::tempdir().unwrap();
    write_ray_pack(folder.path(), (&square(), &rays(), Sides::Both), &source(), &Silent).unwrap();
    let listing = folder.path().join("raypack.json");
    let clean = std::fs::read_to_string(&listing).unwrap();
    let check = || {
        let conventions = CandidateConventions::default();
        check_ray_pack(folder.path(), folder.path(), Precision::F64, conventions, &Silent)
            .map(|checked| checked.passes())
    };
    assert!(check().unwrap());
    let document: serde_json::Value = serde_json::from_str(&clean).unwrap();
    let digest = |name: &str| {
        let files = document["files"].as_array().unwrap();
        files.iter().find(|file| file["path"] == name).unwrap()["sha256"].as_str().unwrap().to_string()
    };
    let own = digest("t.npy");
    for digit in 0..64 {
        let mut digits: Vec<char> = own.chars().collect();
        digits[digit] = if digits[digit] == '0' { '1' } else { '0' };
        std::fs::write(&listing, clean.replace(&own, &digits.into_iter().collect::<String>())).unwrap();
        let message = check().unwrap_err().to_string();
        assert!(message.contains("t.npy: SHA-256"), "digit {digit}: {message}");
    }
    // Who changes an answer writes its digest anew.
    for name in ["face", "t", "range"] {
        let file = folder.path().join(format!("{name}.npy"));
        let before = std::fs::read(&file).unwrap();
        let (shape, mut values) = numbers(folder.path(), name);
        values[0] = if name == "face" { 1.0 - values[0] } else { values[0].next_up() };
        match name {
            "face" => {
                let faces: Vec<u32> = values.iter().map(|face| *face as u32).collect();
                write_npy_numbers(&file, &shape, &faces).unwrap();
            }
            _ => write_npy_numbers(&file, &shape, &values).unwrap(),
        }
        let (_, new) = raypencil_files::file_sha256_hex(&file).unwrap();
        std::fs::write(&listing, clean.replace(&digest(&format!("{name}.npy")), &new)).unwrap();
        let message = check().unwrap_err().to_string();
        assert!(
            message.contains(&format!("{name}.npy: ray 0: another answer than the exact one")),
            "{message}"
        );
        std::fs::write(&file, before).unwrap();
    }
    std::fs::write(&listing, &clean).unwrap();
    assert!(check().unwrap());
}

/// Each number of each array that a pack keeps of its answers, and a file that is listed twice.
#[test]
fn every_answer_that_a_pack_keeps_has_to_be_the_exact_one() {
    let folder = tempfile::tempdir().unwrap();
    write_ray_pack(folder.path(), (&square(), &rays(), Sides::Both), &source(), &Silent).unwrap();
    let listing = folder.path().join("raypack.json");
    let clean = std::fs::read_to_string(&listing).unwrap();
    let document: serde_json::Value = serde_json::from_str(&clean).unwrap();
    let check = || {
        let conventions = CandidateConventions::default();
        let checked = check_ray_pack(folder.path(), folder.path(), Precision::F64, conventions, &Silent);
        checked.map(|checked| checked.passes()).map_err(|error| error.to_string())
    };
    let (mut changed, mut excused) = (0, 0);
    for listed in document["files"].as_array().unwrap() {
        let name = listed["path"].as_str().unwrap();
        let question = ["vertices.npy", "faces.npy", "rays.npy"].contains(&name);
        let Some(array) = name.strip_suffix(".npy").filter(|_| !question) else { continue };
        let file = folder.path().join(name);
        let before = std::fs::read(&file).unwrap();
        let (shape, values) = numbers(folder.path(), array);
        for at in 0..values.len() {
            let mut others = values.clone();
            let margin = array.starts_with("margin");
            others[at] = match values[at] {
                // An interval may be wider or narrower, but must hold what is true.
                value if margin && at % 2 == 0 => 4.0 * value + 1.0,
                value if margin => 0.25 * value,
                value if value.is_finite() => value + 1.0,
                _ => 1.0,
            };
            write_npy_numbers(&file, &shape, &others).unwrap();
            let (_, new) = raypencil_files::file_sha256_hex(&file).unwrap();
            std::fs::write(&listing, clean.replace(listed["sha256"].as_str().unwrap(), &new)).unwrap();
            changed += 1;
            match check() {
                // A quarter of 0, or of an infinite margin, still meets the interval.
                Ok(passes) => {
                    assert!(passes && margin, "{array} {at}: {} to {}", values[at], others[at]);
                    excused += 1;
                }
                Err(message) => assert!(message.contains(name), "{array} {at}: {message}"),
            }
            std::fs::write(&file, &before).unwrap();
        }
    }
    assert!(changed > 150 && excused * 20 < changed, "{changed} changed, {excused} excused");
    let mut twice = document.clone();
    let files = twice["files"].as_array_mut().unwrap();
    files.push(files[0].clone());
    std::fs::write(&listing, twice.to_string()).unwrap();
    assert!(check().unwrap_err().contains("twice; expected each file once"));
    std::fs::write(&listing, &clean).unwrap();
    assert!(check().unwrap());
}
