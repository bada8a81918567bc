//! Packs of rays: wrong programs fail them, and are told what they do otherwise.

use std::path::Path;

use raypencil_cast::{
    CandidateConventions, CastSource, Questions, RayArray, RayPackChecked, cast, check_ray_pack, compare,
    comparison_text, rays_from_bytes, read_stated, write_answers, write_ray_pack,
};
use raypencil_files::{read_npy_numbers, write_npy_numbers};
use raypencil_referee::ExactCast;
use raypencil_scene::{CastRay, Precision, Sides, Silent, Triangles};

/// The cube from -1 to 1, its fronts outside.
fn cube() -> Triangles {
    let corner = |k: u32| [0, 1, 2].map(|axis| if k >> axis & 1 == 1 { 1.0 } else { -1.0 });
    let squares = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let faces = squares.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]);
    Triangles::new((0..8).map(corner).collect(), faces.collect()).unwrap()
}

/// Rays from outside and inside at all lengths, with and without ends, some exactly through corners.
fn rays() -> RayArray {
    let mut text = String::new();
    let mut state = 1_u64;
    let mut draw = |low: f64, high: f64| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        low + (high - low) * ((state >> 11) as f64 / (1_u64 << 53) as f64)
    };
    for k in 0..200 {
        let from = [0; 3].map(|_| draw(-3.0, 3.0));
        let to = if k % 20 == 0 { [1.0; 3] } else { [0; 3].map(|_| draw(-1.0, 1.0)) };
        let length = draw(0.2, 3.0);
        let along =
            [0, 1, 2].map(
                |axis: usize| {
                    if k % 20 == 0 { to[axis] - from[axis] } else { (to[axis] - from[axis]) * length }
                },
            );
        let ends = match k % 4 {
            1 => [draw(0.0, 2.0), f64::INFINITY],
            2 => [0.0, draw(0.0, 2.0)],
            _ => [0.0, f64::INFINITY],
        };
        let numbers = from.into_iter().chain(along).chain(ends).map(|number| number.to_string());
        text += &(numbers.collect::<Vec<_>>().join(",") + "\n");
    }
    let rays = rays_from_bytes(text.as_bytes(), "rays".as_ref()).unwrap().rays;
    RayArray { shape: vec![10, 20], rays }
}

fn source() -> CastSource {
    CastSource { mesh: "cube".into(), rays: "rays".into(), ..CastSource::default() }
}

/// The pack, and a folder with the answers to a question that may be another.
struct Folders {
    pack: tempfile::TempDir,
    candidate: tempfile::TempDir,
}

impl Folders {
    fn new(sides: Sides, answered: Sides, change: impl Fn(&mut CastRay)) -> Self {
        let folders = Self { pack: tempfile::tempdir().unwrap(), candidate: tempfile::tempdir().unwrap() };
        let (mesh, rays) = (cube(), rays());
        let counts = write_ray_pack(folders.pack.path(), (&mesh, &rays, sides), &source(), &Silent).unwrap();
        assert_eq!(counts.untested(), [""; 0], "{counts:?}");
        let mut changed = rays.clone();
        changed.rays.iter_mut().for_each(change);
        let answers = cast(&mesh, &changed.rays, answered, Questions::default(), &Silent);
        write_answers(folders.candidate.path(), &answers, (&mesh, &changed, answered), &source()).unwrap();
        folders
    }

    fn right() -> Self {
        Self::new(Sides::Both, Sides::Both, |_| {})
    }

    /// Changes an array of the candidate, number by number; its index goes with it.
    fn change(self, name: &str, by: impl Fn(usize, f64) -> f64) -> Self {
        let path = self.candidate.path().join(format!("{name}.npy"));
        let array = read_npy_numbers(&path, &Default::default()).unwrap();
        let values: Vec<f64> =
            array.values.iter().enumerate().map(|(index, &value)| by(index, value)).collect();
        write_npy_numbers(&path, &array.shape, &values).unwrap();
        self
    }

    /// Stores arrays of the candidate in single or half precision, each number moved by so many units in its last place.
    fn store(self, is_half: bool, units: i16, names: &[&str]) -> Self {
        for name in names {
            let path = self.candidate.path().join(format!("{name}.npy"));
            let array = read_npy_numbers(&path, &Default::default()).unwrap();
            let single = |value: f64| {
                let bits = (value as f32).to_bits();
                if value.is_finite() && value != 0.0 { bits.wrapping_add_signed(units.into()) } else { bits }
            };
            let half = |value: f64| {
                let bits = half_bits(value);
                if value.is_finite() && value != 0.0 { bits.wrapping_add_signed(units) } else { bits }
            };
            let bytes: Vec<u8> = match is_half {
                true => array.values.iter().flat_map(|&value| half(value).to_le_bytes()).collect(),
                false => array.values.iter().flat_map(|&value| single(value).to_le_bytes()).collect(),
            };
            let shape: Vec<String> = array.shape.iter().map(u64::to_string).collect();
            let header = format!(
                "{{'descr': '<f{}', 'fortran_order': False, 'shape': ({}), }}\n",
                if is_half { 2 } else { 4 },
                shape.join(", ")
            );
            let mut file = b"\x93NUMPY\x01\x00".to_vec();
            file.extend((header.len() as u16).to_le_bytes());
            file.extend(header.as_bytes());
            file.extend(bytes);
            std::fs::write(&path, file).unwrap();
        }
        self
    }

    /// Lays the answers to the 200 rays otherwise: `from` gives the ray whose answer is in the place of another.
    fn lay(self, from: impl Fn(usize) -> usize) -> Self {
        for name in [&VALUES[..], &["face", "side"]].concat() {
            let path = self.candidate.path().join(format!("{name}.npy"));
            let array = read_npy_numbers(&path, &Default::default()).unwrap();
            let parts = array.values.len() / 200;
            let values: Vec<f64> =
                (0..array.values.len()).map(|k| array.values[from(k / parts) * parts + k % parts]).collect();
            write_npy_numbers(&path, &array.shape, &values).unwrap();
        }
        self
    }

    fn without(self, names: &[&str]) -> Self {
        for name in names {
            std::fs::remove_file(self.candidate.path().join(format!("{name}.npy"))).unwrap();
        }
        self
    }

    fn of(&self, name: &str) -> Vec<f64> {
        let path = self.pack.path().join(format!("{name}.npy"));
        read_npy_numbers(path, &Default::default()).unwrap().values
    }

    fn check(&self) -> RayPackChecked {
        self.check_by(Precision::F64, CandidateConventions::default())
    }

    fn check_by(&self, precision: Precision, conventions: CandidateConventions<'_>) -> RayPackChecked {
        check_ray_pack(self.pack.path(), self.candidate.path(), precision, conventions, &Silent).unwrap()
    }

    /// The candidate fails, and this explains it.
    #[track_caller]
    fn expect_why(self, words: &[&str]) {
        let checked = self.check();
        assert!(!checked.passes());
        let why = checked.why.expect("an explanation");
        for words in words {
            assert!(why.contains(words), "{why}");
        }
    }
}

/// The number of half precision that is nearest, as its bits. (IEEE 754, 3.4)
fn half_bits(value: f64) -> u16 {
    let sign = if value.is_sign_negative() { 0x8000 } else { 0 };
    let size = value.abs();
    if size.is_nan() {
        return 0x7e00;
    }
    // Units of the last place are 2^-24 below the smallest normal number, 2^-14.
    let exponent = libm::ilogb(size).clamp(-14, 16);
    let units = libm::scalbn(size, 10 - exponent).round_ties_even();
    let bits = if size.is_infinite() { 31.0 * 1024.0 } else { units + f64::from(exponent + 14) * 1024.0 };
    sign | bits as u16
}

const VALUES: [&str; 6] = ["t", "range", "point", "normal", "barycentric", "cos_incidence"];

#[test]
fn exact_answers_in_fewer_digits_are_right() {
    for is_half in [false, true] {
        let checked = Folders::right().store(is_half, 0, &VALUES).check();
        assert!(checked.passes(), "half {is_half}: {:?}", checked.comparison.wrong().next());
        // Without faces the distance tells which one is met.
        assert!(Folders::right().store(is_half, 0, &VALUES).without(&["face"]).check().passes());
        // Half a unit is allowed, a whole one is not.
        for name in VALUES {
            let checked = Folders::right().store(is_half, 1, &[name]).check();
            let of = checked.comparison.values.iter().find(|tally| tally.value.name() == name).unwrap();
            assert!(
                10 * of.wrong > 8 * of.compared,
                "half {is_half}: {} of {} {name}",
                of.wrong,
                of.compared
            );
        }
    }
}

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

/// What a single-precision program has of a number.
fn single(_: usize, value: f64) -> f64 {
    if value == f64::from(u32::MAX) { -1.0 } else { f64::from(value as f32) }
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
    assert!(error.unwrap_err().to_string().contains("expected face.npy, t.npy or range.npy"));
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

/// One array says that a ray hits, another that it does not.
#[test]
fn answers_that_disagree_with_themselves_are_wrong_whatever_is_right() {
    let right = Folders::right;
    let t = right().of("t");
    let misses: Vec<usize> = (0..t.len()).filter(|&ray| t[ray].is_infinite()).collect();
    let hits: Vec<usize> = (0..t.len()).filter(|&ray| t[ray].is_finite()).collect();
    let (miss, hit) = (misses[2], hits[5]);
    let at = |name: &str, ray: usize, parts: usize, number: f64| {
        right().change(name, move |index, value| if index / parts == ray { number } else { value })
    };
    let (mesh, asked) = (cube(), rays());
    let wrong = |folders: &Folders, ray: usize, words: &str| {
        let path = folders.candidate.path();
        let stated = read_stated(path, &asked.shape, CandidateConventions::default()).unwrap();
        let compared = compare(&mesh, &asked.rays, Sides::Both, &stated, Precision::F64, &Silent);
        let found: Vec<_> = compared.wrong().collect();
        assert!(!compared.passes() && found.len() == 1 && found[0].0 == ray, "{words}: {found:?}");
        let text = comparison_text("mine", &compared, |_| String::new());
        assert!(text.contains(words), "{words}: {text}");
    };
    // A value where the face, or else the first distance, says that nothing is hit.
    for (name, parts, number) in [
        ("t", 1, 5.0),
        ("range", 1, 5.0),
        ("side", 1, -1.0),
        ("point", 3, 0.0),
        ("normal", 3, 0.5),
        ("barycentric", 3, 0.25),
        ("cos_incidence", 1, 0.5),
    ] {
        let words = format!("face says that nothing is hit, and {name} is {number}");
        wrong(&at(name, miss, parts, number), miss, &words);
        // `t` leads where there is no face.
        if name != "t" {
            let words = format!("t says that nothing is hit, and {name} is {number}");
            wrong(&at(name, miss, parts, number).without(&["face"]), miss, &words);
        }
        // Of two arrays too.
        let two = at(name, miss, parts, number);
        let all = ["t", "range", "side", "point", "normal", "barycentric", "cos_incidence"];
        let others: Vec<&str> = all.into_iter().filter(|other| *other != name).collect();
        wrong(&two.without(&others), miss, "face says that nothing is hit");
    }
    // A face whose distance says that nothing is hit.
    for (name, number) in [("t", f64::INFINITY), ("range", f64::NAN), ("t", f64::NEG_INFINITY)] {
        let said = if number.is_nan() { f64::INFINITY } else { number };
        wrong(
            &at(name, hit, 1, number),
            hit,
            &format!("face says that something is hit, and {name} is {said}"),
        );
    }
    // No normal and no weights are (0, 0, 0).
    let none = at("normal", miss, 3, 0.0);
    let weights = at("barycentric", miss, 3, 0.0).of("barycentric");
    let none = none.change("barycentric", move |index, _| weights[index]);
    assert!(
        none.change("cos_incidence", move |index, cos| if index == miss { 0.0 } else { cos })
            .check()
            .passes()
    );
    // Nor do the weights of u = v = 0, or a t that is the ray's end beside a face, say that something is hit.
    let of_corner = at("barycentric", miss, 3, 0.0);
    assert!(
        of_corner
            .change("barycentric", move |index, w| if index == 3 * miss { 1.0 } else { w })
            .check()
            .passes()
    );
    let of_edge = at("barycentric", miss, 3, 0.0).change("barycentric", move |index, w| match index {
        index if index / 3 == miss && index % 3 < 2 => 0.5,
        _ => w,
    });
    wrong(&of_edge, miss, "barycentric is 0.5");
    // A number that is declared is none, as it is stored; another one is.
    let all = ["t", "range", "point", "normal", "barycentric", "cos_incidence"];
    for (number, is_single) in [(7.5, false), (0.1, true), (0.0, false)] {
        let filled = all.iter().fold(right(), |folders, name| {
            folders.change(name, move |_, value| if value.is_finite() { value } else { number })
        });
        let filled = if is_single { filled.store(false, 0, &all) } else { filled };
        let declared = |miss| CandidateConventions { miss: Some(miss), ..CandidateConventions::default() };
        let checked = filled.check_by(Precision::F64, declared(number));
        assert!(checked.passes(), "{number}: {:?}", checked.comparison.wrong().next());
        assert!(!filled.check_by(Precision::F64, declared(8.5)).passes());
        let words = format!("if {number} means no hit: declare --miss {number}");
        // Single precision has another number, which is not 0.1.
        if !is_single {
            filled.expect_why(&["100.0000 %", &words]);
        }
    }
}

#[test]
fn an_array_of_another_name_is_named() {
    let renamed = |from: &str, to: &str| {
        let folders = Folders::right();
        let path = folders.candidate.path();
        // What this program wrote is known to be its own.
        std::fs::remove_file(path.join("summary.json")).unwrap();
        for own in ["ties", "origin", "direction"] {
            let _ = std::fs::remove_file(path.join(format!("{own}.npy")));
        }
        std::fs::rename(path.join(from), path.join(to)).unwrap();
        folders
    };
    for (from, to, words) in [
        ("face.npy", "faces.npy", "faces.npy (meant as face.npy?)"),
        ("normal.npy", "Normals.npy", "Normals.npy (meant as normal.npy?)"),
        ("t.npy", "distance.npy", "distance.npy (meant as t.npy?)"),
        ("point.npy", "Point.npy", "Point.npy (meant as point.npy?)"),
        ("side.npy", "temperature.npy", "temperature.npy"),
        ("barycentric.npy", "barycentrics.npz", "barycentrics.npz (meant as barycentric.npy?)"),
    ] {
        let checked = renamed(from, to).check();
        assert!(checked.passes());
        assert_eq!(checked.unread, [words]);
        let text = checked.document().screen();
        assert!(text.contains(&format!("Not read, for no array has that name: {words}.")), "{text}");
    }
    assert_eq!(Folders::right().check().unread, [""; 0]);
    let only = renamed("face.npy", "faces.npy").without(&["t", "range"]);
    let conventions = CandidateConventions::default();
    let refused =
        check_ray_pack(only.pack.path(), only.candidate.path(), Precision::F64, conventions, &Silent);
    let message = refused.unwrap_err().to_string();
    assert!(
        message.contains("folder: none of them, but faces.npy (meant as face.npy?); expected"),
        "{message}"
    );
}

/// Rays that end before anything is there, and just upon it.
#[test]
fn the_end_of_a_ray_beside_a_face_is_no_hit() {
    let text: String =
        (0..40).map(|k| format!("0.25,0.125,3,0,0,-1,0,{}\n", 1.0 + f64::from(k) / 20.0)).collect();
    let rays = rays_from_bytes(text.as_bytes(), "here".as_ref()).unwrap();
    let mesh = cube();
    let exact = ExactCast::new(&mesh);
    let passes = |faces: bool, moved: f64| {
        let [pack, candidate] = [(); 2].map(|()| tempfile::tempdir().unwrap());
        write_ray_pack(pack.path(), (&cube(), &rays, Sides::Both), &source(), &Silent).unwrap();
        let met: Vec<_> =
            rays.rays.iter().map(|ray| exact.first(ray, Sides::Both).first().copied()).collect();
        assert!(met.iter().flatten().count() > 5 && met.iter().any(Option::is_none));
        let face: Vec<f64> = met.iter().map(|face| face.map_or(-1.0, |face| f64::from(face.0))).collect();
        let t = rays.rays.iter().zip(&met).map(|(ray, face)| match face {
            Some(face) => exact.values(ray, *face).unwrap().t.double,
            None => ray.t_max + moved,
        });
        let folder = candidate.path();
        write_npy_numbers(folder.join("t.npy"), &[40], &t.collect::<Vec<_>>()).unwrap();
        if faces {
            write_npy_numbers(folder.join("face.npy"), &[40], &face).unwrap();
        }
        let conventions = CandidateConventions::default();
        check_ray_pack(pack.path(), folder, Precision::F64, conventions, &Silent).unwrap().comparison.passes()
    };
    assert!(passes(true, 0.0));
    // Without faces it is a hit, and another number is none of the ray's.
    assert!(!passes(false, 0.0) && !passes(true, 0.001));
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
    // Too long by no number, and always too long: no rounding does that.
    let grown = right().without(&["range"]).change("t", |k, t| t + 1e-8 * (1 + k % 7) as f64);
    assert!(grown.check_by(Precision::F32, CandidateConventions::default()).passes());
    assert_eq!(grown.check().why, None);
    // Errors of the size of rounding, to both sides.
    let noise = |k: usize| ((k * 7_919) % 1_000) as f64 / 500.0 - 1.0;
    let computed = right().without(&["range"]).change("t", |k, t| t * (1.0 + 1e-7 * noise(k)));
    computed.expect_why(&["if arithmetic is of single precision"]);
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

#[test]
fn a_changed_pack_and_arrays_of_another_shape_are_refused() {
    let refused = |folders: &Folders| -> String {
        let (pack, candidate): (&Path, &Path) = (folders.pack.path(), folders.candidate.path());
        let conventions = CandidateConventions::default();
        check_ray_pack(pack, candidate, Precision::F64, conventions, &Silent).unwrap_err().to_string()
    };
    let folders = Folders::right();
    write_npy_numbers(folders.candidate.path().join("t.npy"), &[20, 10], &[0.0; 200]).unwrap();
    assert!(
        refused(&folders).contains("shape: [20, 10]; expected [10, 20], or flat [200]"),
        "{}",
        refused(&folders)
    );
    let folders = Folders::right().change("face", |_, _| 5.5);
    assert!(refused(&folders).contains("cell 0: 5.5"), "{}", refused(&folders));
    let folders = Folders::right();
    write_npy_numbers(folders.pack.path().join("rays.npy"), &[1, 8], &[1.0; 8]).unwrap();
    assert!(refused(&folders).contains("SHA-256"), "{}", refused(&folders));
    // How many rays test what follows from the pack.
    let folders = Folders::right();
    let listing = folders.pack.path().join("raypack.json");
    let written: serde_json::Value = serde_json::from_slice(&std::fs::read(&listing).unwrap()).unwrap();
    for (key, count) in written["counts"].as_object().unwrap() {
        let mut document = written.clone();
        document["counts"][key] = (count.as_u64().unwrap() + 1).into();
        std::fs::write(&listing, document.to_string()).unwrap();
        let message = refused(&folders);
        assert!(message.contains(&format!("counts.{key}: ")), "{message}");
    }
    let mut document = written;
    document["counts"]["rounded"] = 3.into();
    std::fs::write(&listing, document.to_string()).unwrap();
    assert!(refused(&folders).contains("counts.rounded: 3; expected no such count"), "{}", refused(&folders));
    // An answer is changed; then its digest is too.
    let folders = Folders::right();
    let t = folders.pack.path().join("t.npy");
    let array = read_npy_numbers(&t, &Default::default()).unwrap();
    let mut changed = array.values.clone();
    let hit = changed.iter().position(|t| t.is_finite()).unwrap();
    changed[hit] = changed[hit].next_up();
    write_npy_numbers(&t, &array.shape, &changed).unwrap();
    let message = refused(&folders);
    assert!(message.contains("t.npy") && message.contains("SHA-256"), "{message}");
    let listing = folders.pack.path().join("raypack.json");
    let (old, new) = message
        .split_once("expected ")
        .map(|(found, expected)| {
            let digest = |text: &str| {
                text.split(|c: char| !c.is_ascii_hexdigit())
                    .find(|word| word.len() == 64)
                    .unwrap()
                    .to_string()
            };
            (digest(expected), digest(found))
        })
        .unwrap();
    let text = std::fs::read_to_string(&listing).unwrap().replace(&old, &new);
    std::fs::write(&listing, text).unwrap();
    let message = refused(&folders);
    assert!(message.contains(&format!("ray {hit}: another answer than the exact one")), "{message}");
    std::fs::remove_file(&t).unwrap();
    assert!(refused(&folders).contains("t.npy"), "{}", refused(&folders));
    for (document, expected) in
        [("{", "document"), (r#"{"format":1,"kind":"x","sides":"both","files":[]}"#, "kind")]
    {
        std::fs::write(folders.pack.path().join("raypack.json"), document).unwrap();
        assert!(refused(&folders).contains(expected), "{}", refused(&folders));
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
