//! Clouds of several returns against a pack of beams with a width: right ones pass, exchanged, other and missing returns are told.

use glam::DVec3;
use raypencil_cast::{BeamReturns, CastSource, PcdData, Questions, cast, write_set};
use raypencil_scene::pattern::{Cone, EchoLight, Keep, Mounting, PatternRays, Returns};
use raypencil_scene::{CastRay, NamedRaySet, Precision, Sides, Silent, Triangles};

use super::beam_trial::{Fields, Point, RULES, Trial, set_of, turn_of};
use super::cloud_trial::{bend, expect, room, still};

#[test]
fn right_returns_pass_by_order_by_keys_and_by_numbers() {
    for keep in RULES {
        for mounting in [still(), bend()].into_iter().skip(usize::from(keep != Keep::UpTo(2))) {
            let trial = Trial::of_room(&mounting, keep);
            let mixed = trial.returns.footprints().iter().filter(|beam| beam.is_mixed()).count();
            assert!(mixed >= 6, "{mixed} beams are mixed");
            for checked in trial.judge_all(&trial.right()) {
                assert!(checked.passes(), "{keep:?}: {:?}", checked.why);
                let told = trial.returns.told().iter().flatten().count();
                assert_eq!(checked.comparison.met, told as u64);
            }
        }
    }
    // The clouds that `cast` writes.
    let trial = Trial::of_room(&bend(), Keep::UpTo(2));
    let answers = cast(&trial.mesh, trial.set.set.rays(), Sides::Both, Questions::default(), &Silent);
    let folder = trial.folder.path().join("own");
    write_set(
        &folder,
        &answers,
        (&trial.mesh, &trial.set, Sides::Both),
        &CastSource::default(),
        PcdData::Binary,
    )
    .expect("files");
    let checked = trial.check(&folder.join("cloud-sensor.pcd"), Precision::F64).expect("a check");
    assert!(checked.passes(), "{:?}", checked.why);
    let text = checked.document().screen();
    assert!(
        text.contains("A ray is the leading ray of a return of 320 beams, up to 2 each; without a return"),
        "{text}"
    );
    let cloud = checked.cloud.expect("a cloud");
    assert!(cloud.has_range);
    assert_eq!(cloud.assigned, "by ring and time");
}

#[test]
fn in_thick_air_other_returns_are_the_strongest() {
    let echo = EchoLight { reflectivity: 0.5, extinction_per_m: 0.5 };
    let trial = |echo| Trial::new(room(), NamedRaySet { echo, ..set_of(&still(), Keep::Strongest) });
    let [clear, thick] = [EchoLight::default(), echo].map(trial);
    let leading = |trial: &Trial| -> Vec<Option<usize>> {
        trial.returns.told().iter().map(|told| told.map(|told| told.ray)).collect()
    };
    let other = leading(&clear).iter().zip(&leading(&thick)).filter(|(a, b)| a != b).count();
    assert!(other > 0);
    for checked in thick.judge_all(&thick.right()) {
        assert!(checked.passes(), "{:?}", checked.why);
    }
    let checked = thick.check(&thick.write(&clear.right(), Fields::Keys), Precision::F64).expect("a check");
    assert_eq!(checked.comparison.counts().wrong, other as u64);
    // The pack says so, and one of no air says nothing of it.
    let list = |trial: &Trial| {
        let text = std::fs::read(trial.folder.path().join("pack/raypack.json")).expect("a list");
        serde_json::from_slice::<serde_json::Value>(&text).expect("JSON")
    };
    let light = serde_json::json!({ "reflectivity": 0.5, "extinctionPerM": 0.5 });
    assert_eq!(list(&thick)["scan"]["light"], light);
    assert!(list(&clear)["scan"].get("light").is_none());
}

#[test]
fn returns_of_another_rule_are_told() {
    let trial = |keep| Trial::of_room(&bend(), keep);
    let of_first = trial(Keep::First);
    of_first
        .expect_why(&of_first.by(Keep::Last), "if points are the last returns: the first ones are asked for");
    let of_last = trial(Keep::Last);
    of_last
        .expect_why(&of_last.by(Keep::First), "if points are the first returns: the last ones are asked for");
    let of_strongest = trial(Keep::Strongest);
    let words = "if points are the last returns: the strongest ones are asked for";
    of_strongest.expect_why(&of_strongest.by(Keep::Last), words);
    let of_two = trial(Keep::UpTo(2));
    for (name, keep) in [("first", Keep::First), ("last", Keep::Last), ("strongest", Keep::Strongest)] {
        let places = |one: Point| [one, Point { place: DVec3::NAN, number: 0, ..one }];
        let alone: Vec<Point> = of_two.by(keep).into_iter().flat_map(places).collect();
        let words = format!("if each beam has its {name} return alone: the 2 strongest ones are asked for");
        of_two.expect_why(&alone, &words);
    }
}

#[test]
fn returns_in_another_order_and_repeated_ones_are_told() {
    let trial = Trial::of_room(&still(), Keep::UpTo(2));
    let right = trial.right();
    let is_double = |k: usize| right[k / 2 * 2 + 1].place.is_finite();
    let exchanged: Vec<Point> =
        (0..right.len()).map(|k| if is_double(k) { right[k ^ 1] } else { right[k] }).collect();
    let [by_order, by_keys, by_numbers] = trial.judge_all(&exchanged);
    expect(&by_order, "if the returns of a beam run from the farthest to the nearest");
    expect(&by_keys, "if the returns of a beam run from the farthest to the nearest");
    // With its own number a point is right wherever it stands.
    assert!(by_numbers.passes(), "{:?}", by_numbers.why);
    let numbers: Vec<Point> = (0..right.len())
        .map(|k| Point {
            number: if is_double(k) { right[k ^ 1].number } else { right[k].number },
            ..right[k]
        })
        .collect();
    let [by_order, by_keys, by_numbers] = trial.judge_all(&numbers);
    assert!(by_order.passes() && by_keys.passes());
    // Of three returns two are told: from the farthest 1 and 2 would be 3 and 2.
    expect(
        &by_numbers,
        "if the numbers of the told returns of a beam are exchanged: the nearest has the least",
    );
    let again: Vec<Point> = (0..right.len())
        .map(|k| if right[k].place.is_finite() || k % 2 == 0 { right[k] } else { right[k - 1] })
        .collect();
    let words = "a beam with fewer returns has one of them again: its other places are empty";
    trial.expect_why(&again, &format!("if {words}"));
    // Two beams that have one again, among many that have not, follow no such rule.
    let fewer: Vec<usize> = (0..right.len())
        .filter(|k| k % 2 == 1 && right[*k].place.is_nan() && right[k - 1].place.is_finite())
        .collect();
    assert!(fewer.len() > 100, "{}", fewer.len());
    let mut two = right.clone();
    for k in &fewer[7..9] {
        two[*k] = right[k - 1];
    }
    for checked in trial.judge_all(&two) {
        assert_eq!(checked.comparison.counts().wrong, 2);
        assert!(checked.why.is_none_or(|why| !why.contains(words)));
    }
}

#[test]
fn more_points_than_returns_are_told_as_such() {
    let trial = Trial::of_room(&still(), Keep::First);
    let refused = |points: &[Point]| {
        trial.check(&trial.write(points, Fields::Keys), Precision::F64).expect_err("a refusal")
    };
    let dense = |points: Vec<Point>| -> Vec<Point> {
        points.into_iter().filter(|point| point.place.is_finite()).collect()
    };
    let right = dense(trial.right());
    let (count, twice) = (right.len(), [right.clone(), right.clone()].concat());
    let words = |more: usize, all: usize| {
        format!(
            "points: {more} of {all} points are of a ray that has a point already, up to 2 points for one, by ring and time; \
             expected one point for each ray: this pack asks for one return"
        )
    };
    assert!(refused(&twice).ends_with(&words(count, 2 * count)), "{}", refused(&twice));
    let dual = dense(trial.by(Keep::UpTo(2)));
    assert!(dual.len() > count + count / 50, "{} and {count}", dual.len());
    assert!(refused(&dual).ends_with(&words(dual.len() - count, dual.len())), "{}", refused(&dual));
    // Of a pack of two returns, three times the points.
    let trial = Trial::of_room(&still(), Keep::UpTo(2));
    let right = dense(trial.right());
    let thrice = [right.clone(), right.clone(), right].concat();
    let told = trial.check(&trial.write(&thrice, Fields::Keys), Precision::F64).expect_err("a refusal");
    assert!(
        told.contains("points are of a beam that has its points already, up to 6 points for one"),
        "{told}"
    );
    assert!(
        told.ends_with("expected at most 2 points for each beam: this pack asks for so many returns"),
        "{told}"
    );
}

#[test]
fn what_right_beams_contradict_is_not_told() {
    // A plate before a wall: no beam has three returns.
    let square = |x: f64, [y, z]: [f64; 2], half: f64| {
        [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]
            .map(|[across, up]| [x, y + half * across, z + half * up])
    };
    let [wall, plate] = [square(12.0, [0.5, 1.5], 9.0), square(4.0, [0.5, 1.5], 1.0)];
    let faces = vec![[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]];
    let mesh = Triangles::new([wall, plate].concat(), faces).expect("two squares");
    // 1920 places, of which every second one is a second return: a sample of each other place would see none of them.
    let trial = Trial::new(mesh, turn_of(60, &still(), Keep::UpTo(2)));
    let right = trial.right();
    let seconds: Vec<usize> =
        (0..right.len()).filter(|k| k % 2 == 1 && right[*k].place.is_finite()).collect();
    assert!(seconds.len() > 5, "{}", seconds.len());
    let mut points = right.clone();
    points[seconds[3]].place = DVec3::NAN;
    for checked in trial.judge_all(&points) {
        assert_eq!((checked.comparison.counts().wrong, checked.why), (1, None));
    }
}

#[test]
fn the_middle_of_the_beam_and_mean_ranges_are_told() {
    let trial = Trial::of_room(&bend(), Keep::UpTo(2));
    let rays = trial.set.set.rays();
    let middle = |ray: &CastRay| {
        let index = rays.iter().position(|other| other == ray).expect("a ray");
        rays[index / 7 * 7].direction
    };
    let of_middle = trial.points(&trial.returns, &|ray, range, _| ray.origin + middle(ray) * range);
    let words = "if points stand on the middle of their beam, at the range of the return";
    trial.expect_why(&of_middle, words);
    let of_mean = trial.points(&trial.returns, &|ray, _, mean| ray.origin + ray.direction * mean);
    trial.expect_why(&of_mean, "if points stand at the mean range of their return");
    // As a device has them.
    let both = trial.points(&trial.returns, &|ray, _, mean| ray.origin + middle(ray) * mean);
    for checked in trial.judge_all(&both) {
        expect(&checked, words);
        expect(&checked, ", and points stand at the mean range of their return");
    }
}

#[test]
fn a_return_too_many_or_too_few_is_wrong() {
    let trial = Trial::of_room(&still(), Keep::UpTo(2));
    let right = trial.right();
    let double = right.iter().position(|one| one.number == 2).expect("a beam of two returns");
    let single = (0..right.len())
        .find(|k| k % 2 == 1 && right[*k].place.is_nan() && right[k - 1].place.is_finite())
        .expect("a beam of one return");
    let mut fewer = right.clone();
    fewer[double].place = DVec3::NAN;
    for checked in trial.judge_all(&fewer) {
        assert_eq!(checked.comparison.wrong().map(|(place, _)| place).collect::<Vec<_>>(), [double]);
    }
    let mut more = right.clone();
    more[single] = Point { place: right[single - 1].place * 1.25, number: 2, ..right[single - 1] };
    for checked in trial.judge_all(&more) {
        assert_eq!(checked.comparison.wrong().map(|(place, _)| place).collect::<Vec<_>>(), [single]);
    }
    // A third point of a beam has no place.
    let third = [right[double - 1], right[double], right[double]].map(|one| Point { number: 9, ..one });
    let most = right.iter().copied().filter(|one| one.place.is_finite() && one.time != third[0].time);
    let more: Vec<Point> = most.chain(third).collect();
    let checked = trial.check(&trial.write(&more, Fields::Keys), Precision::F64).expect("a check");
    assert!(!checked.passes());
    assert_eq!(checked.cloud.expect("a cloud").strays, [more.len() - 1]);
    // A pack whose returns are not the exact ones is refused, although its list has the digest.
    let pack = trial.folder.path().join("pack");
    let path = pack.join("return.number.npy");
    let mut bytes = std::fs::read(&path).expect("returns");
    let last = bytes.len() - 4;
    bytes[last] ^= 3;
    let digest = |bytes: &[u8]| raypencil_files::hex_digits(&raypencil_files::sha256(bytes));
    let list = std::fs::read_to_string(pack.join("raypack.json")).expect("a list");
    let old = digest(&std::fs::read(&path).expect("returns"));
    std::fs::write(&path, &bytes).expect("returns");
    std::fs::write(pack.join("raypack.json"), list.replace(&old, &digest(&bytes))).expect("a list");
    let refused = trial.check(&trial.write(&right, Fields::None), Precision::F64).expect_err("a refusal");
    assert!(refused.contains("others than the exact ones; expected the returns that"), "{refused}");
}

/// A beam whose first ring has a ray that runs along the edge of a near wall: rounding decides whether the wall is a return.
#[test]
fn rounding_may_change_the_returns_of_a_beam() {
    let cone = Cone { divergence_rad: 0.02, rings: 1 };
    let pattern = |keep| {
        let axes = (0..40).map(|k| {
            let angle = 0.1 * f64::from(k);
            CastRay::new(DVec3::ZERO, DVec3::new(libm::cos(angle), libm::sin(angle), 0.0))
        });
        let axes = PatternRays {
            shape: vec![40, 1],
            rays: axes.collect(),
            times: Some((0..40).map(|k| 0.01 * f64::from(k)).collect()),
            weights: None,
            returns: None,
            elevations_deg: Some(vec![0.0]),
            mounting: Mounting::HERE,
        };
        let beams = cone.spread(&axes, "cone").expect("a cone");
        PatternRays { returns: Some(Returns { keep, separation_m: 0.5 }), ..beams }
    };
    // Before each beam a triangle at 2 m, with an edge through the ray of the ring that is farthest to the left; all round a wall.
    let rays = pattern(Keep::First).rays;
    let (mut vertices, mut faces) = (Vec::new(), Vec::new());
    for beam in rays.chunks(7) {
        let left = beam[1..]
            .iter()
            .max_by(|a, b| {
                let off = |ray: &CastRay| beam[0].direction.cross(ray.direction).z;
                off(a).total_cmp(&off(b))
            })
            .expect("rays");
        let (edge, side) = (left.direction * 2.0, DVec3::Z.cross(beam[0].direction));
        // 30 nm beside the ray: rounding of single precision, which is 14 micrometres here, and none of double precision.
        let edge = edge + side * 3e-8;
        let corners = [edge - DVec3::Z * 0.3, edge + DVec3::Z * 0.3, edge + side * 0.05];
        faces.push([0, 1, 2].map(|k| vertices.len() as u32 + k));
        vertices.extend(corners.map(|corner| corner.to_array()));
    }
    let first = vertices.len() as u32;
    vertices.extend([[-9.0, -9.0, -9.0], [9.0, -9.0, -9.0], [9.0, 9.0, -9.0], [-9.0, 9.0, -9.0]]);
    vertices.extend([[-9.0, -9.0, 9.0], [9.0, -9.0, 9.0], [9.0, 9.0, 9.0], [-9.0, 9.0, 9.0]]);
    for k in 0..4 {
        let next = (k + 1) % 4;
        faces.push([first + k, first + next, first + 4 + next]);
        faces.push([first + k, first + 4 + next, first + 4 + k]);
    }
    let mesh = Triangles::new(vertices, faces).expect("a mesh");
    // What two programs tell whose walls are a little to either side.
    let moved = |by: f64| {
        let moved = mesh.vertices().iter().enumerate().map(|(k, vertex)| {
            let side = DVec3::Z.cross(rays[(k / 3).min(39) * 7].direction);
            let is_wall = k >= first as usize;
            if is_wall { *vertex } else { (DVec3::from_array(*vertex) + side * by).to_array() }
        });
        Triangles::new(moved.collect(), mesh.faces().to_vec()).expect("a mesh")
    };
    for keep in [Keep::First, Keep::UpTo(2)] {
        let set = NamedRaySet::new("beams", pattern(keep), Sides::Both).expect("a set");
        let trial = Trial::new(mesh.clone(), set.clone());
        let mut told = Vec::new();
        for (by, is_near) in [(1e-6, false), (-1e-6, true)] {
            let answers = cast(&moved(by), set.set.rays(), Sides::Both, Questions::default(), &Silent);
            let returns = BeamReturns::of(&answers, &set).expect("returns");
            let mixed = returns.footprints().iter().filter(|beam| beam.is_mixed()).count();
            assert_eq!(mixed, if is_near { 40 } else { 0 });
            let points = trial.points(&returns, &|ray, range, _| ray.origin + ray.direction * range);
            for fields in [Fields::None, Fields::Keys] {
                let checked = trial.check(&trial.write(&points, fields), Precision::F32).expect("a check");
                assert!(checked.passes(), "{keep:?} {by} {fields:?}: {}", checked.document().screen());
            }
            told.push(points);
        }
        // In double precision the wall is there or it is not; and no rounding excuses a point that is on none of its rays.
        let wrong = |points: &[Point], precision| {
            let checked = trial.check(&trial.write(points, Fields::None), precision).expect("a check");
            checked.comparison.counts().wrong
        };
        assert_eq!(wrong(&told[0], Precision::F64), 0);
        assert!(wrong(&told[1], Precision::F64) >= 40);
        let shorter: Vec<Point> =
            told[1].iter().map(|one| Point { place: one.place * 0.99, ..*one }).collect();
        let there = shorter.iter().filter(|one| one.place.is_finite()).count();
        assert_eq!(wrong(&shorter, Precision::F32), there as u64);
    }
}
