//! Packs of rays: right programs pass, whatever they give and however they store it.

use glam::DVec3;
use raypencil_cast::{
    CandidateConventions, Questions, Stated, cast, check_ray_pack, compare, rays_from_bytes, read_stated,
    write_ray_pack,
};
use raypencil_files::write_npy_numbers;
use raypencil_referee::{CastHit, ExactCast, Rounded};
use raypencil_scene::{CastRay, FaceId, Precision, Sides, Silent, Triangles};

use super::pack_trial::{Folders, VALUES, cube, npy_of, rays, source};

#[test]
fn exact_answers_in_fewer_digits_are_right() {
    for is_half in [false, true] {
        let checked = Folders::right().store(is_half, 0, &VALUES).check();
        assert!(checked.passes(), "half {is_half}: {:?}", checked.comparison.wrong().next());
        // Without faces the distance tells which one is met.
        assert!(Folders::right().store(is_half, 0, &VALUES).without(&["face"]).check().passes());
        // Half a unit is allowed, a whole one is not; and each value has a count of its own: the others are right.
        for rest in [0, 1] {
            let off: Vec<&str> = VALUES.into_iter().skip(rest).step_by(2).collect();
            let checked = Folders::right().store(is_half, 0, &VALUES).store(is_half, 1, &off).check();
            for name in VALUES {
                let of = checked.comparison.values.iter().find(|tally| tally.value.name() == name).unwrap();
                let is_as_stored =
                    if off.contains(&name) { 10 * of.wrong > 8 * of.compared } else { of.wrong == 0 };
                assert!(is_as_stored, "half {is_half}, {off:?}: {} of {} {name}", of.wrong, of.compared);
            }
        }
    }
}

#[test]
fn a_right_program_passes_whatever_it_gives() {
    assert!(Folders::right().check().passes());
    let all = ["side", "point", "normal", "barycentric", "cos_incidence"];
    assert!(Folders::right().without(&all).without(&["face"]).check().passes());
    assert!(Folders::right().without(&all).without(&["face", "t"]).check().passes());
    let faces = Folders::right().without(&all).without(&["t", "range"]);
    assert!(faces.check().passes());
    // Nothing says which rays hit.
    let nothing = faces.without(&["face"]);
    let folders = [nothing.pack.path(), nothing.candidate.path()];
    let error =
        check_ray_pack(folders[0], folders[1], Precision::F64, CandidateConventions::default(), &Silent);
    assert!(error.unwrap_err().to_string().contains("expected face.npy, t.npy, range.npy or hit.npy"));
}

#[test]
fn a_declared_number_is_no_face_of_rays_that_hit_and_is_rounded_as_it_is_stored() {
    let declared = |miss| CandidateConventions { miss: Some(miss), ..CandidateConventions::default() };
    let with = |miss: f64| {
        let of = move |_: usize, length: f64| if length.is_finite() { length } else { miss };
        Folders::right().change("t", of).change("range", of)
    };
    let faces = Folders::right().of("face");
    for miss in [0.0, 3.0, 11.0] {
        assert!(faces.contains(&miss), "no ray hits face {miss}");
        let checked = with(miss).check_by(Precision::F64, declared(miss));
        assert!(checked.passes(), "{miss}: {:?}", checked.comparison.wrong().next());
        // Nor where a distance alone has the number.
        assert!(with(miss).without(&["range"]).check_by(Precision::F64, declared(miss)).passes());
    }
    // Each with a unit of its last place as it is stored. The last is nearly half a unit from what is stored of it.
    let ulp = |exponent: i32| libm::scalbn(1.0, exponent);
    for (miss, is_half, unit) in [
        (1e30, false, ulp(76)),
        (0.1, false, ulp(-27)),
        (-999.9, false, ulp(-14)),
        (0.1, true, ulp(-14)),
        (-999.9, true, ulp(-1)),
        (7.0 + 0.98 * ulp(-22), false, ulp(-21)),
    ] {
        // Distances alone say which rays hit.
        let passes = |stored: f64| {
            let folders = with(stored).store(is_half, 0, &["t", "range"]).without(&["face"]);
            folders.check_by(Precision::F64, declared(miss)).passes()
        };
        assert!(passes(miss), "{miss}, half {is_half}");
        assert!(!passes(miss + unit), "a unit beside {miss}, half {is_half}");
    }
}

/// A number for no hit that is also the distance of a hit.
#[test]
fn a_declared_number_is_a_distance_of_rays_that_hit() {
    let right = || Folders::right().without(&["side", "point", "normal", "barycentric", "cos_incidence"]);
    let [t, range] = ["t", "range"].map(|name| right().of(name));
    // Every twentieth ray goes through a corner, which rounding may miss.
    let hit = (0..t.len()).find(|&ray| ray % 20 != 0 && t[ray].is_finite() && t[ray] != range[ray]).unwrap();
    let hits: Vec<bool> = t.iter().map(|t| t.is_finite()).collect();
    for miss in [t[hit], range[hit]] {
        let with = || {
            let of = move |_: usize, length: f64| if length.is_finite() { length } else { miss };
            right().change("t", of).change("range", of)
        };
        let wrong = |folders: &Folders| -> Vec<usize> {
            let declared = CandidateConventions { miss: Some(miss), ..CandidateConventions::default() };
            folders.check_by(Precision::F64, declared).comparison.wrong().map(|(ray, _)| ray).collect()
        };
        // A face says that the ray hits, and so does the other distance.
        assert_eq!(wrong(&with()), [0; 0]);
        assert_eq!(wrong(&with().without(&["face"])), [0; 0]);
        let other = if miss == t[hit] { "range" } else { "t" };
        assert_eq!(wrong(&with().without(&[other])), [0; 0]);
        // Truth values say it as well; the distance alone says that nothing is hit.
        assert_eq!(wrong(&with().without(&["face", other]).with_hits(&hits)), [0; 0]);
        assert_eq!(wrong(&with().without(&["face", other])), [hit]);
        // A miss whose face says so.
        let none = with().change("face", |ray, face| if ray == hit { -1.0 } else { face });
        assert_eq!(wrong(&none), [hit]);
        // The number is told where it is not declared.
        let why = with().check().why.expect("a reason");
        assert_eq!(why, format!("100.0000 % agree if {miss} means no hit: declare --miss {miss}"));
    }
}

/// Truth values beside other arrays, and alone.
#[test]
fn hits_are_judged_alone_and_beside_others() {
    let all = ["side", "point", "normal", "barycentric", "cos_incidence"];
    let t = Folders::right().of("t");
    let hits: Vec<bool> = t.iter().map(|t| t.is_finite()).collect();
    let beside = || Folders::right().with_hits(&hits);
    let alone = || beside().without(&all).without(&["face", "t", "range"]);
    assert!(beside().check().passes() && alone().check().passes());
    assert_eq!(alone().check().unread, [""; 0]);
    // Numbers of any type, 0 and 1.
    assert!(alone().change("hit", |_, hit| hit).check().passes());
    assert!(alone().change("hit", |_, hit| hit).store(false, 0, &["hit"]).check().passes());
    for ray in [hits.iter().position(|hit| *hit).unwrap(), hits.iter().position(|hit| !*hit).unwrap()] {
        let mut other = hits.clone();
        other[ray] ^= true;
        for folders in [beside().with_hits(&other), alone().with_hits(&other)] {
            let checked = folders.check();
            let wrong: Vec<usize> = checked.comparison.wrong().map(|(ray, _)| ray).collect();
            assert_eq!((wrong, checked.why), (vec![ray], None));
        }
        let text = beside().with_hits(&other).check().document().screen();
        let words = match hits[ray] {
            true => "face says that something is hit, and hit is 0",
            false => "face says that nothing is hit, and hit is 1",
        };
        assert!(text.contains(words), "{text}");
    }
    // One truth value of a ray explains little: no mistake is told, but that nothing is hit.
    let inverted: Vec<bool> = hits.iter().map(|hit| !hit).collect();
    assert_eq!(alone().with_hits(&inverted).check().why, None);
    let why = alone().with_hits(&[false; 200]).check().why;
    assert_eq!(why.as_deref(), Some("every ray is a miss: nothing at all is hit"));
    // Face 0 is a face where the truth values say so, and no hit elsewhere.
    let zero = || {
        let faces = beside().without(&all).without(&["t", "range"]);
        faces.change("face", |ray, face| if hits[ray] { face } else { 0.0 })
    };
    assert!(zero().of("face").contains(&0.0));
    let declared = CandidateConventions { miss: Some(0.0), ..CandidateConventions::default() };
    assert!(zero().check_by(Precision::F64, declared).passes());
    zero().expect_why(&["100.0000 %", "if 0 means no hit: declare --miss 0"]);
}

/// Rays that end before anything is there, and just upon it.
#[test]
fn the_end_of_a_ray_beside_a_face_is_no_hit() {
    let text: String =
        (0..40).map(|k| format!("0.25,0.125,3,0,0,-1,0,{}\n", 1.0 + f64::from(k) / 20.0)).collect();
    let rays = rays_from_bytes(text.as_bytes(), "here".as_ref()).unwrap();
    let mesh = cube();
    let exact = ExactCast::new(&mesh);
    let passes = |faces: bool, end: &dyn Fn(f64) -> f64, (precision, is_stored_single)| {
        let [pack, candidate] = [(); 2].map(|()| tempfile::tempdir().unwrap());
        write_ray_pack(pack.path(), (&cube(), &rays, Sides::Both), &source(), &Silent).unwrap();
        let met: Vec<_> =
            rays.rays.iter().map(|ray| exact.first(ray, Sides::Both).first().copied()).collect();
        assert!(met.iter().flatten().count() > 5 && met.iter().any(Option::is_none));
        let face: Vec<f64> = met.iter().map(|face| face.map_or(-1.0, |face| f64::from(face.0))).collect();
        let t = rays.rays.iter().zip(&met).map(|(ray, face)| match face {
            Some(face) => exact.values(ray, *face).unwrap().t.double,
            None => end(ray.t_max),
        });
        let folder = candidate.path();
        let t: Vec<f64> = t.collect();
        match is_stored_single {
            true => {
                let bytes = t.iter().flat_map(|t| (*t as f32).to_le_bytes()).collect();
                std::fs::write(folder.join("t.npy"), npy_of("<f4", &[40], bytes)).unwrap();
            }
            false => write_npy_numbers(folder.join("t.npy"), &[40], &t).unwrap(),
        }
        if faces {
            write_npy_numbers(folder.join("face.npy"), &[40], &face).unwrap();
        }
        let conventions = CandidateConventions::default();
        check_ray_pack(pack.path(), folder, precision, conventions, &Silent).unwrap().comparison.passes()
    };
    let double = |faces, end: &dyn Fn(f64) -> f64| passes(faces, end, (Precision::F64, false));
    assert!(double(true, &|end| end));
    // Without faces it is a hit, and another number is none of the ray's.
    assert!(!double(false, &|end| end) && !double(true, &|end| end + 0.001));
    // Arithmetic of single precision has rounded the end; that of double precision has not.
    let rounded = |end: f64| f64::from(end as f32);
    assert!(rays.rays.iter().any(|ray| rounded(ray.t_max) != ray.t_max));
    assert!(passes(true, &rounded, (Precision::F32, false)) && !double(true, &rounded));
    // Storing has, whatever was computed. The neighbour is not the end.
    let next = |end: f64| f64::from((end as f32).next_up());
    for precision in [Precision::F64, Precision::F32] {
        assert!(passes(true, &|end| end, (precision, true)));
        assert!(!passes(true, &next, (precision, true)) && !passes(true, &next, (precision, false)));
    }
}

/// A pack that asks for fronts has answers of fronts, in the comparison and in what is drawn of it: rays from inside the cube meet
/// backs alone.
#[test]
fn a_pack_of_fronts_is_shown_with_answers_of_fronts() {
    let checked = |sides: Sides| {
        let folders = Folders::new(sides, sides, |_| {});
        let conventions = CandidateConventions::default();
        check_ray_pack(folders.pack.path(), folders.candidate.path(), Precision::F64, conventions, &Silent)
            .unwrap()
    };
    let [both, fronts] = [Sides::Both, Sides::Fronts].map(checked);
    assert!(both.passes() && fronts.passes());
    assert_eq!([both.fronts_only, fronts.fronts_only], [false, true]);
    for (checked, sides) in [(&both, Sides::Both), (&fronts, Sides::Fronts)] {
        assert_eq!(checked.answers, cast(&cube(), &rays().rays, sides, Questions::default(), &Silent));
        // What is shown of a candidate that passes is what it says.
        let stated = checked.stated.face.as_ref().expect("faces");
        assert_eq!(checked.answers.hits().count(), stated.iter().flatten().count());
    }
    assert!(fronts.answers.hits().count() < both.answers.hits().count());
}

/// The cube's edges and corners lie at exactly one t on two faces and more: each of them is right, also for a program that names none.
#[test]
fn at_a_tie_the_values_of_any_face_are_right_without_its_name() {
    let mesh = cube();
    let exact = ExactCast::new(&mesh);
    let rays = rays();
    let others: Vec<Option<CastHit>> = rays
        .rays
        .iter()
        .map(|ray| {
            let faces = exact.first(ray, Sides::Both);
            exact.values(ray, *faces.last()?)
        })
        .collect();
    let ties = rays.rays.iter().filter(|ray| exact.first(ray, Sides::Both).len() > 1).count();
    assert!(ties > 5, "{ties}");
    let three = |parts: [Rounded; 3]| parts.map(|part| part.double);
    let of = |value: &dyn Fn(&CastHit) -> [f64; 3]| -> Vec<DVec3> {
        others
            .iter()
            .map(|hit| hit.as_ref().map_or(DVec3::NAN, |hit| DVec3::from_array(value(hit))))
            .collect()
    };
    let t = others.iter().map(|hit| hit.as_ref().map_or(f64::INFINITY, |hit| hit.t.double)).collect();
    let stated = Stated {
        t: Some(t),
        normal: Some(of(&|hit| three(hit.normal))),
        barycentric: Some(of(&|hit| three(hit.barycentric))),
        side: Some(others.iter().map(|hit| hit.as_ref().map(|hit| hit.side)).collect()),
        ..Stated::default()
    };
    let counts =
        |stated: &Stated| compare(&mesh, &rays.rays, Sides::Both, stated, Precision::F64, &Silent).counts();
    let found = counts(&stated);
    assert_eq!((found.wrong, found.ties as usize), (0, ties), "{found:?}");
    // A normal of no face that is met, and one of a face with the weights of another, are wrong as before.
    let tied = rays.rays.iter().position(|ray| exact.first(ray, Sides::Both).len() > 1).expect("a tie");
    let mut tilted = stated.clone();
    tilted.normal.as_mut().expect("normals")[tied] = DVec3::splat(libm::sqrt(1.0 / 3.0));
    assert_eq!(counts(&tilted).wrong, 1);
    let mut mixed = stated.clone();
    mixed.barycentric.as_mut().expect("weights")[tied] = DVec3::new(0.25, 0.25, 0.5);
    assert_eq!(counts(&mixed).wrong, 1);
}

/// A ray beside an edge by less than single precision moves it: the values are those of the face beyond, which is not named.
#[test]
fn within_rounding_of_an_edge_the_normal_of_the_other_face_is_right() {
    let mesh = cube();
    // It meets the face x = 1 at y = 1 - off.
    let off = 1e-9;
    let ray = CastRay::new(DVec3::new(3.0, 3.0 - off, 0.5), DVec3::new(-1.0, -1.0, 0.0));
    let hits = |normal: DVec3, precision| {
        let stated = Stated { t: Some(vec![2.0]), normal: Some(vec![normal]), ..Stated::default() };
        let counts = compare(&mesh, &[ray], Sides::Both, &stated, precision, &Silent).counts();
        (counts.same, counts.rounding, counts.wrong)
    };
    assert_eq!(hits(DVec3::X, Precision::F32), (1, 0, 0));
    assert_eq!(hits(DVec3::Y, Precision::F32), (0, 1, 0));
    assert_eq!(hits(DVec3::Y, Precision::F64), (0, 0, 1));
    assert_eq!(hits(DVec3::Z, Precision::F32), (0, 0, 1));
    assert_eq!(hits(-DVec3::Y, Precision::F32), (0, 0, 1));
}

/// A needle beside the ray, in a direction between the eight of a compass: rounding lets a program take it, and its normal is right.
#[test]
fn within_rounding_of_a_needle_its_normal_is_right_in_any_direction() {
    // A ground of two faces, and above it a needle that begins 3e-9 beside the ray. It leans to one side, so that it has another normal.
    let near = 3e-9;
    for degrees in [0.0_f64, 11.0, 20.0, 33.0, 67.0, 100.0, 160.0, 200.0, 290.0, 340.0] {
        let (sin, cos) = libm::sincos(degrees.to_radians());
        let at =
            |along: f64, across: f64, z: f64| [along * cos - across * sin, along * sin + across * cos, z];
        let width = 1e-10;
        let corners = vec![
            [-2.0, -2.0, 0.0],
            [2.0, -2.0, 0.0],
            [2.0, 2.0, 0.0],
            [-2.0, 2.0, 0.0],
            at(near, -width, 1e-9),
            at(1.0, 0.0, 0.5),
            at(near, width, 1e-9),
        ];
        let mesh = Triangles::new(corners, vec![[0, 1, 2], [0, 2, 3], [4, 5, 6]]).unwrap();
        let ray = CastRay::new(DVec3::new(0.0, 0.0, 1.0), DVec3::NEG_Z);
        let [a, b, c] = mesh.corners(FaceId(2));
        let normal = (b - a).cross(c - a).normalize();
        let wrong = |normal, precision| {
            let stated = Stated { t: Some(vec![1.0]), normal: Some(vec![normal]), ..Stated::default() };
            compare(&mesh, &[ray], Sides::Both, &stated, precision, &Silent).counts().wrong
        };
        assert_eq!(wrong(normal, Precision::F32), 0, "{degrees}");
        assert_eq!(wrong(DVec3::Z, Precision::F32), 0, "{degrees}");
        assert_eq!(wrong(normal, Precision::F64), 1, "{degrees}");
    }
}

/// Half precision has no odd number beyond 2048, single none beyond 2^24.
#[test]
fn faces_of_a_type_that_does_not_tell_them_apart_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let read = |kind: &str, bytes: &[u8]| {
        std::fs::write(folder.path().join("face.npy"), npy_of(kind, &[1], bytes.to_vec())).unwrap();
        read_stated(folder.path(), &[1], CandidateConventions::default())
            .map(|stated| stated.face.unwrap()[0].map(|face| face.0))
            .map_err(|error| error.to_string())
    };
    // 2047 and 2048 are 1023 and 1024 halves of 2^11: sixteen bits 0x67ff and 0x6800; 2050 is 0x6801.
    assert_eq!(read("<f2", &0x67ff_u16.to_le_bytes()), Ok(Some(2047)));
    let message = read("<f2", &0x6801_u16.to_le_bytes()).unwrap_err();
    assert!(message.contains("face.npy: cell 0: 2050; expected a number that its type tells"), "{message}");
    assert_eq!(read("<f4", &16_777_215_f32.to_le_bytes()), Ok(Some(16_777_215)));
    assert!(read("<f4", &16_777_218_f32.to_le_bytes()).unwrap_err().contains("16777218"));
    // What stands for no face is none in each type.
    assert_eq!(read("<f4", &4_294_967_296_f32.to_le_bytes()), Ok(None));
    assert_eq!(read("<f8", &4_000_000_001_f64.to_le_bytes()), Ok(Some(4_000_000_001)));
}

/// Numbers of fewer digits are rounded: a verdict calls none of them exact, and half precision says what it cannot see.
#[test]
fn a_verdict_calls_exact_only_what_is() {
    let headline = |folders: &Folders| folders.check().document().headline;
    let right = Folders::right();
    assert!(headline(&right).contains(" exact, "), "{}", headline(&right));
    let single = Folders::right().store(false, 0, &VALUES);
    assert!(headline(&single).contains(" within rounding, "), "{}", headline(&single));
    // A double that is off by one unit in its last place agrees, and is not exact.
    let one = Folders::right().change("t", |_, t| t.next_up());
    assert!(headline(&one).contains(" within rounding, "), "{}", headline(&one));
    let half = Folders::right().without(&["point", "face"]).store(true, 0, &["t", "range"]);
    let screen = half.check().document().screen();
    assert!(screen.contains("200 rays agree to half precision: "), "{screen}");
    assert!(
        !screen.contains("exact, ") && screen.contains("judged as such: t, range. Errors below a 2048th"),
        "{screen}"
    );
    assert_eq!(half.check().bundle("rays").coarseness.as_deref(), Some("half precision"));
}

/// The page of a check stands beside no arrays; that of a cast does.
#[test]
fn the_page_of_a_check_speaks_of_no_arrays() {
    let checked = Folders::right().check();
    let page = checked.document_with_pictures().page().unwrap();
    assert!(page.contains("The numbers of this page are in single precision. Lengths are"));
    assert!(!page.contains("the arrays beside it"));
}
