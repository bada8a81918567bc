//! The shortest range of a sensor: what is nearer is too near, and hides what stands behind it.

use glam::DVec3;
use raypencil_cast::{
    Answers, CandidateConventions, CastSource, PcdData, Questions, RayArray, RayPackChecked, Stated, cast,
    check_ray_pack, compare, comparison_text, counts_text, range_picture, ray_text, write_answers,
    write_ray_pack, write_set,
};
use raypencil_files::{read_npy_numbers, read_rays, write_npy_numbers};
use raypencil_scene::pattern::{Cone, GRID_PRESETS, Grid, PatternRays, SPINNING_PRESETS, Spinning};
use raypencil_scene::{CastRay, FaceId, NamedRaySet, Precision, Reading, Sides, Silent, Triangles};

/// Squares across x: place, half side.
fn walls(walls: &[(f64, f64)]) -> Triangles {
    let corners =
        |&(x, half): &(f64, f64)| [[x, -half, -half], [x, half, -half], [x, half, half], [x, -half, half]];
    let faces = |k: u32| [[4 * k, 4 * k + 2, 4 * k + 1], [4 * k, 4 * k + 3, 4 * k + 2]];
    let count = walls.len() as u32;
    Triangles::new(walls.iter().flat_map(corners).collect(), (0..count).flat_map(faces).collect()).unwrap()
}

/// Cubes around the origin: half sides.
fn rooms(halves: &[f64]) -> Triangles {
    let corner = |k: usize, half: f64| [0, 1, 2].map(|axis| if k >> axis & 1 == 1 { half } else { -half });
    let squares = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let vertices = halves.iter().flat_map(|&half| (0..8).map(move |k| corner(k, half))).collect();
    let faces = (0..halves.len() as u32).flat_map(|room| {
        squares.into_iter().flat_map(move |square| {
            let [a, b, c, d] = square.map(|k: u32| 8 * room + k);
            [[a, b, c], [a, c, d]]
        })
    });
    Triangles::new(vertices, faces.collect()).unwrap()
}

/// A pattern of every preset, with its shortest range. Presets whose figures name none get half a metre.
fn patterns() -> Vec<(String, f64, PatternRays)> {
    let shortest = |of_preset: f64| if of_preset > 0.0 { of_preset } else { 0.5 };
    let heads = SPINNING_PRESETS.map(|name| {
        let head = Spinning::preset(name).unwrap();
        // A few directions all around.
        let azimuth_step_deg = head.azimuth_step_deg.signum() * 120.0;
        let min_range_m = shortest(head.min_range_m);
        let head = Spinning { steps: 3, azimuth_step_deg, min_range_m, ..head };
        (name.to_string(), min_range_m, head.rays(name).unwrap())
    });
    let grids = GRID_PRESETS.map(|name| {
        let grid = Grid::preset(name).unwrap();
        let min_range_m = shortest(grid.min_range_m);
        (name.to_string(), min_range_m, Grid { columns: 4, rows: 3, min_range_m, ..grid }.rays(name).unwrap())
    });
    let mut patterns: Vec<_> = heads.into_iter().chain(grids).collect();
    // The rays of a footprint are the sensor's too.
    let cone = Cone { divergence_rad: 3e-3, rings: 1 };
    let (name, min, rays) = &patterns[0];
    patterns.push((format!("{name}, a cone"), *min, cone.spread(rays, name).unwrap()));
    patterns
}

#[test]
fn no_sensor_sees_through_what_stands_before_its_shortest_range() {
    for (name, shortest, pattern) in patterns() {
        let rays = &pattern.rays;
        let answered = |mesh: &Triangles| {
            let questions = Questions { any: true, all: true, margins: false };
            let answers = cast(mesh, rays, Sides::Both, questions, &Silent);
            // The tracer says the same.
            let stated = Stated::by_tracer(mesh, rays, Sides::Both);
            let compared = compare(mesh, rays, Sides::Both, &stated, Precision::F64, &Silent);
            assert!(compared.passes() && compared.counts().same == rays.len() as u64, "{name}");
            assert_eq!(Answers::by_tracer(mesh, rays, Sides::Both).too_near(), answers.too_near(), "{name}");
            answers
        };
        // A room so small that its corners are nearer than the shortest range, too: 1/2 times the root of 3. Behind it another.
        let near = answered(&rooms(&[0.5 * shortest, 3.0 * shortest]));
        assert_eq!((near.too_near(), near.counts().0, near.misses()), (rays.len(), 0, 0), "{name}");
        assert!(near.distances(|hit| hit.range).iter().all(|range| *range == f64::NEG_INFINITY), "{name}");
        // Where the rays meet the rooms is another question.
        assert!(near.any.unwrap().iter().all(|any| *any), "{name}");
        assert!(near.all.unwrap().iter().all(|groups| groups.len() == 2), "{name}");
        // Just beyond the shortest range, all of it is measured. (An emitter is a centimetre off its axis at most.)
        let beyond = answered(&rooms(&[1.001 * shortest, 3.0 * shortest]));
        assert_eq!((beyond.too_near(), beyond.counts().0), (0, rays.len()), "{name}");
        assert!(beyond.hits().all(|hit| hit.range >= shortest && hit.range < 1.8 * shortest), "{name}");
        // Nothing at all is a miss, and no ray is too near.
        let empty = cast(&rooms(&[]), rays, Sides::Both, Questions::default(), &Silent);
        assert_eq!((empty.too_near(), empty.misses()), (0, rays.len()), "{name}");
    }
}

#[test]
fn at_exactly_the_shortest_range_a_surface_is_measured() {
    // One ray along x, from the origin: t is the place of the wall.
    let at = |place: f64, t_blind: f64| {
        let ray = CastRay { t_blind, ..CastRay::new(DVec3::ZERO, DVec3::X) };
        let mesh = walls(&[(place, 1.0), (10.0, 1.0)]);
        let [exact, traced] = [
            cast(&mesh, &[ray], Sides::Both, Questions::default(), &Silent),
            Answers::by_tracer(&mesh, &[ray], Sides::Both),
        ];
        assert_eq!(exact.distances(|hit| hit.t), traced.distances(|hit| hit.t), "{place} {t_blind}");
        exact.distances(|hit| hit.t)[0]
    };
    for shortest in [0.8, 0.25, 0.5, 1.0 / 3.0] {
        assert_eq!(at(shortest, shortest), shortest);
        assert_eq!(at(f64::next_up(shortest), shortest), shortest.next_up());
        assert_eq!(at(f64::next_down(shortest), shortest), f64::NEG_INFINITY);
    }
    // A ray that starts on the wall is too near; t_min in place of t_blind looks through it.
    assert_eq!(at(0.0, 0.5), f64::NEG_INFINITY);
    let started = CastRay { t_min: 0.5, ..CastRay::new(DVec3::ZERO, DVec3::X) };
    let answers =
        cast(&walls(&[(0.0, 1.0), (10.0, 1.0)]), &[started], Sides::Both, Questions::default(), &Silent);
    assert_eq!(answers.first[0].hit().map(|hit| hit.t), Some(10.0));
}

/// A raster of 8 x 8 rays, blind before 0.8, of which the middle 4 x 4 meet a plate at 0.5, the outer ones a wall at 10, and those at
/// the border nothing. And one row more of rays of no sensor, with a start and an end.
fn plate_and_wall() -> (Triangles, RayArray) {
    let ray = |i: usize, j: usize| {
        let slope = |k: usize| (2.0 * k as f64 - 7.0) / 16.0;
        let along = DVec3::new(1.0, slope(i), slope(j)) * if i.is_multiple_of(2) { 1.0 } else { 0.5 };
        let ray = CastRay::new(DVec3::ZERO, along);
        match j {
            8 => CastRay { t_min: 0.6 * (i % 3) as f64, t_max: 25.0, ..ray },
            _ => CastRay { t_blind: 0.8 / along.length(), ..ray },
        }
    };
    let rays = (0..9).flat_map(|j| (0..8).map(move |i| (i, j))).map(|(i, j)| ray(i, j)).collect();
    (walls(&[(0.5, 0.1), (10.0, 4.0)]), RayArray { shape: vec![9, 8], rays })
}

fn source() -> CastSource {
    CastSource { mesh: "m".into(), rays: "r".into(), ..CastSource::default() }
}

/// The pack of the plate and the wall, and the answers to rays that are changed.
struct Folders {
    pack: tempfile::TempDir,
    candidate: tempfile::TempDir,
}

impl Folders {
    fn answering(change: impl Fn(&mut CastRay)) -> Self {
        let folders = Self { pack: tempfile::tempdir().unwrap(), candidate: tempfile::tempdir().unwrap() };
        let (mesh, rays) = plate_and_wall();
        let counts =
            write_ray_pack(folders.pack.path(), (&mesh, &rays, Sides::Both), &source(), &Silent).unwrap();
        assert_eq!((counts.rays, counts.blind, counts.too_near), (72, 64, 16), "{counts:?}");
        assert_eq!(counts.hits + counts.too_near + counts.misses, counts.rays, "{counts:?}");
        let mut changed = rays.clone();
        changed.rays.iter_mut().for_each(change);
        let answers = cast(&mesh, &changed.rays, Sides::Both, Questions::default(), &Silent);
        write_answers(folders.candidate.path(), &answers, (&mesh, &changed, Sides::Both), &source()).unwrap();
        folders
    }

    fn right() -> Self {
        Self::answering(|_| {})
    }

    /// The candidate has these arrays alone.
    fn with_only(self, names: &[&str]) -> Self {
        for entry in std::fs::read_dir(self.candidate.path()).unwrap() {
            let path = entry.unwrap().path();
            let is_kept = names.iter().any(|name| path.file_stem().unwrap() == *name);
            if !is_kept {
                std::fs::remove_file(path).unwrap();
            }
        }
        self
    }

    fn change(self, name: &str, by: impl Fn(f64) -> f64) -> Self {
        let path = self.candidate.path().join(format!("{name}.npy"));
        let array = read_npy_numbers(&path, &Default::default()).unwrap();
        let values: Vec<f64> = array.values.iter().map(|&value| by(value)).collect();
        write_npy_numbers(&path, &array.shape, &values).unwrap();
        self
    }

    fn check(&self) -> RayPackChecked {
        self.check_with(CandidateConventions::default())
    }

    fn check_with(&self, conventions: CandidateConventions<'_>) -> RayPackChecked {
        let (pack, candidate) = (self.pack.path(), self.candidate.path());
        check_ray_pack(pack, candidate, Precision::F64, conventions, &Silent).unwrap()
    }

    /// Number of wrong rays, what is said of them, and why they are wrong.
    #[track_caller]
    fn expect_wrong(&self, wrong: u64, words: &str, why: &str) {
        let checked = self.check();
        assert_eq!((checked.passes(), checked.comparison.counts().wrong), (false, wrong));
        let shown = checked.document().screen();
        assert!(shown.contains(words) && shown.contains(why), "{shown}");
    }
}

const EXACTLY: &str =
    "exactly what is hit is too near: its surface stands before the sensor's shortest range";

#[test]
fn a_candidate_says_what_is_too_near() {
    let right = Folders::right();
    let checked = right.check();
    assert!(checked.passes() && checked.comparison.counts().same == 72);
    // Any one of the arrays that say so is enough; a face alone does not tell too near from a miss.
    for name in ["t", "range", "face"] {
        assert!(Folders::right().with_only(&[name]).check().passes(), "{name}");
    }
    // The question has a ninth number.
    let rays = read_rays(&right.pack.path().join("rays.npy")).unwrap();
    assert_eq!(rays, plate_and_wall().1);
    let shape = read_npy_numbers(right.pack.path().join("rays.npy"), &Default::default()).unwrap().shape;
    assert_eq!(shape, [9, 8, 9]);
    assert!(checked.ray_command(26).contains(",0,inf,0.7"), "{}", checked.ray_command(26));
}

#[test]
fn a_candidate_that_sees_through_misses_or_measures_is_wrong() {
    // It takes the shortest range for the start of a ray.
    let through = Folders::answering(|ray| (ray.t_min, ray.t_blind) = (ray.t_min.max(ray.t_blind), 0.0));
    through.expect_wrong(
        16,
        &format!("face 2; {EXACTLY}"),
        "rays pass through what is nearer than the sensor's shortest range",
    );
    // It says +Inf, or NaN, of what is too near.
    let to = |miss: f64| move |t: f64| if t == f64::NEG_INFINITY { miss } else { t };
    let missed = Folders::right().change("t", to(f64::INFINITY)).change("range", to(f64::NAN));
    missed.expect_wrong(16, &format!("no hit; {EXACTLY}"), "what is too near is not told from a miss");
    // It measures what is too near.
    let measured = Folders::answering(|ray| ray.t_blind = 0.0);
    measured.expect_wrong(16, EXACTLY, "the sensor's shortest range is ignored");
}

#[test]
fn minus_infinity_is_no_miss_unless_it_is_declared() {
    let to_near = |distance: f64| if distance == f64::INFINITY { f64::NEG_INFINITY } else { distance };
    // Nor without a sensor in the question: nothing can be too near.
    let (mesh, rays) = plate_and_wall();
    let plain: Vec<CastRay> = rays.rays.iter().map(|ray| CastRay { t_blind: 0.0, ..*ray }).collect();
    for rays in [&rays.rays, &plain] {
        let answers = cast(&mesh, rays, Sides::Both, Questions::default(), &Silent);
        let mut stated = Stated::of(&answers);
        let compared = |stated: &Stated| compare(&mesh, rays, Sides::Both, stated, Precision::F64, &Silent);
        assert!(compared(&stated).passes());
        for lengths in [&mut stated.t, &mut stated.range] {
            lengths.as_mut().unwrap().iter_mut().for_each(|length| *length = to_near(*length));
        }
        let wrong = compared(&stated);
        assert_eq!(wrong.counts().wrong, answers.misses() as u64);
        let shown = comparison_text("swapped", &wrong, |_| String::new());
        assert!(shown.contains("too near; exactly it is no hit"), "{shown}");
    }
    // A program whose miss is -Inf says so; what is too near is then a miss to it.
    let swapped = Folders::right().change("t", to_near).change("range", to_near);
    let declared = CandidateConventions { miss: Some(f64::NEG_INFINITY), ..Default::default() };
    assert_eq!(swapped.check_with(declared).comparison.counts().wrong, 16);
    // Nothing stands behind the plate alone: who sees through it misses. One miss that says -Inf beside others that say +Inf is no
    // program that has this number for its misses, and who declared it would have 16 rays more wrong.
    let plate = Triangles::new(mesh.vertices().to_vec(), mesh.faces()[..2].to_vec()).unwrap();
    let pack = tempfile::tempdir().unwrap();
    write_ray_pack(pack.path(), (&plate, &rays, Sides::Both), &source(), &Silent).unwrap();
    let answers = cast(&plate, &rays.rays, Sides::Both, Questions::default(), &Silent);
    let single = tempfile::tempdir().unwrap();
    write_answers(single.path(), &answers, (&plate, &rays, Sides::Both), &source()).unwrap();
    let miss = answers.first.iter().position(|read| *read == Reading::Miss).unwrap();
    for name in ["t", "range"] {
        let path = single.path().join(format!("{name}.npy"));
        let mut array = read_npy_numbers(&path, &Default::default()).unwrap();
        array.values[miss] = f64::NEG_INFINITY;
        write_npy_numbers(&path, &array.shape, &array.values).unwrap();
    }
    let conventions = CandidateConventions::default();
    let checked = check_ray_pack(pack.path(), single.path(), Precision::F64, conventions, &Silent).unwrap();
    assert_eq!((answers.too_near(), checked.comparison.counts().wrong), (16, 1));
    assert_eq!(checked.why, None);
    // One of two arrays that say it is a contradiction.
    let half = Folders::right().change("t", |t| if t == f64::NEG_INFINITY { f64::INFINITY } else { t });
    half.expect_wrong(16, "one of t and range is -Inf, too near, and the other is not", "");
}

#[test]
fn near_the_shortest_range_rounding_may_take_either_side() {
    // A slanted plate that is met at t = 4/5 exactly, a little less than the double 0.8.
    let corners = vec![[1.0, -4.0, -4.0], [3.0, 4.0, -4.0], [3.0, 4.0, 4.0], [1.0, -4.0, 4.0]];
    let behind = walls(&[(10.0, 9.0)]);
    let vertices = [corners, behind.vertices().to_vec()].concat();
    let mesh = Triangles::new(vertices, vec![[0, 1, 2], [0, 2, 3], [4, 6, 5], [4, 7, 6]]).unwrap();
    let t = 0.8_f64;
    let ray = |t_blind: f64| CastRay { t_blind, ..CastRay::new(DVec3::new(0.0, 0.0, 0.25), DVec3::X * 2.5) };
    let verdict = |t_blind: f64, stated: f64, precision: Precision| {
        let stated = Stated { t: Some(vec![stated]), ..Stated::default() };
        let counts = compare(&mesh, &[ray(t_blind)], Sides::Both, &stated, precision, &Silent).counts();
        (counts.same, counts.rounding, counts.wrong)
    };
    let (same, rounding, wrong) = ((1, 0, 0), (0, 1, 0), (0, 0, 1));
    let near = f64::NEG_INFINITY;
    // For a sensor that measures from that double on it is too near, though its t would be rounded to it.
    assert_eq!(verdict(t, near, Precision::F64), same);
    assert_eq!(verdict(t, t, Precision::F64), rounding);
    assert_eq!(verdict(t.next_down(), t, Precision::F64), same);
    assert_eq!(verdict(t.next_down(), near, Precision::F64), rounding);
    // A ten millionth beside it, only single precision is excused, and a thousandth beside it nothing is.
    for beside in [1e-7, -1e-7] {
        let (limit, exact, other) = if beside > 0.0 { (t + beside, near, t) } else { (t + beside, t, near) };
        assert_eq!(verdict(limit, exact, Precision::F64), same);
        assert_eq!(verdict(limit, other, Precision::F64), wrong);
        assert_eq!(verdict(limit, f64::from(other as f32), Precision::F32), rounding);
        let far = t + 1e4 * beside;
        assert_eq!(verdict(far, f64::from(other as f32), Precision::F32), wrong);
    }
    // At the limit too, nothing excuses a miss or the wall behind.
    for other in [f64::INFINITY, 4.0] {
        for precision in [Precision::F64, Precision::F32] {
            assert_eq!(verdict(t, other, precision), wrong);
            assert_eq!(verdict(t.next_down(), other, precision), wrong);
        }
    }
    // Faces alone: none is right for too near, and within rounding of it.
    let none = Stated { face: Some(vec![None]), ..Stated::default() };
    let of = |t_blind: f64| {
        let compared = compare(&mesh, &[ray(t_blind)], Sides::Both, &none, Precision::F64, &Silent);
        let counts = compared.counts();
        (counts.same, counts.rounding, counts.wrong)
    };
    assert_eq!((of(t), of(t.next_down()), of(0.5)), (same, rounding, wrong));
}

#[test]
fn clouds_pictures_and_words_tell_too_near_from_a_miss() {
    // Three columns, blind before 0.8: a plate at 0.5 on the left, a wall in the middle, nothing on the right.
    let grid =
        Grid { columns: 3, rows: 1, width_deg: 90.0, height_deg: 0.0, ..Grid::preset("l515").unwrap() };
    let grid = Grid { min_range_m: 0.8, max_range_m: 20.0, ..grid };
    let set = NamedRaySet::new("front", grid.rays("rays").unwrap(), Sides::Both).unwrap();
    let plate = [[0.5, 0.1, -1.0], [0.5, 2.0, -1.0], [0.5, 2.0, 1.0], [0.5, 0.1, 1.0]];
    let wall = walls(&[(10.0, 4.0)]);
    let vertices = [plate.to_vec(), wall.vertices().to_vec()].concat();
    let mesh = Triangles::new(vertices, vec![[0, 1, 2], [0, 2, 3], [4, 6, 5], [4, 7, 6]]).unwrap();
    let answers = cast(&mesh, set.set.rays(), Sides::Both, Questions::default(), &Silent);
    assert_eq!(answers.first[0], Reading::TooNear);
    assert_eq!(answers.first[1].hit().map(|hit| hit.range), Some(10.0));
    assert_eq!(answers.first[2], Reading::Miss);
    assert_eq!(counts_text(&answers), "3 rays: 1 hit, 1 of them at a tie; 1 too near; 1 miss");
    let shown = ray_text(&set.set.rays()[0], &answers, 0);
    assert!(
        shown.contains("blind before t 0.8\n  too near     the nearest surface is met before t 0.8"),
        "{shown}"
    );

    let folder = tempfile::tempdir().unwrap();
    write_set(folder.path(), &answers, (&mesh, &set, Sides::Both), &source(), PcdData::Binary).unwrap();
    let of = |name: &str| read_npy_numbers(folder.path().join(name), &Default::default()).unwrap().values;
    assert_eq!(of("range.npy"), [f64::NEG_INFINITY, 10.0, f64::INFINITY]);
    assert_eq!(of("face.npy")[0], f64::from(u32::MAX));
    assert!(of("point.npy")[..3].iter().all(|part| part.is_nan()) && of("cos_incidence.npy")[0].is_nan());
    let summary = std::fs::read_to_string(folder.path().join("summary.json")).unwrap();
    let summary: serde_json::Value = serde_json::from_str(&summary).unwrap();
    let counts = serde_json::json!({ "hits": 1, "tooNear": 1, "misses": 1, "ties": 1 });
    assert_eq!(summary["counts"], counts);
    // One point in the list of points; in the organised cloud a place for each ray.
    let ply = std::fs::read(folder.path().join("cloud.ply")).unwrap();
    assert!(String::from_utf8_lossy(&ply).contains("element vertex 1\n"));
    let pcd = std::fs::read(folder.path().join("cloud.pcd")).unwrap();
    let body = &pcd[pcd.len() - 3 * 40..];
    let single = |at: usize| f32::from_le_bytes(body[at..at + 4].try_into().unwrap());
    assert!([0, 4, 8, 12].iter().all(|&at| single(at).is_nan()) && single(32) == f32::NEG_INFINITY);
    assert_eq!((single(40), single(40 + 32)), (10.0, 10.0));
    assert!(single(2 * 40).is_nan() && single(2 * 40 + 32).is_nan());

    let picture = range_picture(&answers, &set).unwrap().svg();
    assert!(picture.contains("too near") && picture.contains("nothing is hit"));
    // A set without one does not explain the colour.
    let far = Grid { min_range_m: 0.0, ..grid }.rays("rays").unwrap();
    let far = NamedRaySet::new("front", far, Sides::Both).unwrap();
    let answers = cast(&mesh, far.set.rays(), Sides::Both, Questions::default(), &Silent);
    assert!(!range_picture(&answers, &far).unwrap().svg().contains("too near"));
}

#[test]
fn rays_that_are_all_too_near_are_an_answer() {
    let (mesh, rays) = plate_and_wall();
    let near: Vec<CastRay> = rays.rays[27..29].to_vec();
    let compared = |stated: &Stated| compare(&mesh, &near, Sides::Both, stated, Precision::F64, &Silent);
    let right = compared(&Stated::by_tracer(&mesh, &near, Sides::Both));
    assert!(right.passes() && right.met == 2);
    let shown = comparison_text("tracer", &right, |_| String::new());
    assert!(shown.contains("All 2 rays agree.") && !shown.contains("miss"), "{shown}");
    let through = Stated { face: Some(vec![Some(FaceId(3)); 2]), ..Stated::default() };
    let shown = comparison_text("through", &compared(&through), |_| String::new());
    assert!(shown.contains(&format!("face 3; {EXACTLY}")), "{shown}");
}
