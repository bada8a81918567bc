//! Columns have the numbers of answers, bit for bit, and only those that are asked for.

use std::path::Path;

use glam::DVec3;
use raypencil_cast::{
    Answers, Caster, DecidedCounts, FirstColumns, Questions, ReadingCounts, Values, cast, cast_with,
    read_rays,
};
use raypencil_mesh_io::read_triangles;
use raypencil_referee::ExactCast;
use raypencil_scene::{CastRay, Side, Sides, Silent, Triangles};
use raypencil_tracer::TracerCast;

/// A lattice of heights: rays through posts and edges tie.
fn ground() -> Triangles {
    let at = |x: u32, y: u32| [f64::from(x), f64::from(y), f64::from((x * 7 + y * 5) % 4) * 0.5];
    let vertices = (0..9).flat_map(|y| (0..9).map(move |x| at(x, y))).collect();
    let cell = |k: u32| {
        let a = k / 8 * 9 + k % 8;
        [[a, a + 1, a + 10], [a, a + 10, a + 9]]
    };
    Triangles::new(vertices, (0..64).flat_map(cell).collect()).expect("a mesh")
}

/// More rays than one thread takes by itself; some miss, some are too near, some meet backs.
fn rays() -> Vec<CastRay> {
    let ray = |k: u32| {
        let (x, y) = (f64::from(k % 41) * 0.25 - 1.0, f64::from(k / 41 % 41) * 0.25 - 1.0);
        let up = if k.is_multiple_of(5) { -1.0 } else { 1.0 };
        let ray =
            CastRay::new(DVec3::new(x, y, 5.0 * up), DVec3::new(0.1 * f64::from(k % 3), 0.0, -2.0 * up));
        CastRay { t_blind: if k.is_multiple_of(7) { 2.4 } else { 0.0 }, ..ray }
    };
    (0..1700).map(ray).collect()
}

fn counts_of(answers: &Answers) -> ReadingCounts {
    ReadingCounts {
        hits: answers.counts().0 as u64,
        too_near: answers.too_near() as u64,
        backs: answers.hits().filter(|hit| hit.side == Side::Back).count() as u64,
        decided: answers.decided.unwrap_or_default(),
    }
}

fn bits(numbers: impl IntoIterator<Item = f64>) -> Vec<u64> {
    numbers.into_iter().map(f64::to_bits).collect()
}

#[test]
fn every_column_is_that_of_the_answers() {
    let (mesh, rays) = (ground(), rays());
    let (exact, tracer) = (ExactCast::new(&mesh), TracerCast::new(&mesh));
    for sides in [Sides::Both, Sides::Fronts] {
        let by_referee = cast_with(&exact, &rays, sides, Questions::default(), &Silent);
        let by_tracer = Answers::traced(&tracer, &rays, sides);
        for (caster, answers) in [(Caster::Referee(&exact), by_referee), (Caster::Tracer(&tracer), by_tracer)]
        {
            let mut columns = FirstColumns::new(rays.len(), Values::ALL);
            let counts = columns.part(0..rays.len()).ask(caster, &rays, sides);
            assert_eq!(counts, counts_of(&answers));
            let seen = counts.hits + counts.too_near;
            assert!(counts.hits > 400 && counts.too_near > 10 && seen < 1700, "{counts:?}");
            let none = [f64::NAN; 3];
            let FirstColumns { face, side, ties, t, range, cos_incidence, point, normal, barycentric } =
                columns;
            assert_eq!(face.unwrap(), answers.values(|hit| hit.face.0, u32::MAX));
            let of_side = |side| if side == Side::Front { 1 } else { -1 };
            assert_eq!(side.unwrap(), answers.values(|hit| of_side(hit.side), 0));
            assert_eq!(ties.unwrap(), answers.values(|hit| hit.ties, 0));
            assert_eq!(bits(t.unwrap()), bits(answers.distances(|hit| hit.t)));
            assert_eq!(bits(range.unwrap()), bits(answers.distances(|hit| hit.range)));
            assert_eq!(bits(cos_incidence.unwrap()), bits(answers.values(|hit| hit.cos_incidence, f64::NAN)));
            let vectors = |value: Vec<[f64; 3]>| bits(value.concat());
            assert_eq!(vectors(point.unwrap()), vectors(answers.values(|hit| hit.point.to_array(), none)));
            assert_eq!(vectors(normal.unwrap()), vectors(answers.values(|hit| hit.normal.to_array(), none)));
            assert_eq!(vectors(barycentric.unwrap()), vectors(answers.values(|hit| hit.barycentric, none)));
        }
    }
}

#[test]
fn parts_one_after_the_other_are_the_whole_and_only_what_is_asked_is_there() {
    let (mesh, rays) = (ground(), rays());
    let exact = ExactCast::new(&mesh);
    let asked = Values::named(["face", "point"]).expect("names");
    let mut whole = FirstColumns::new(rays.len(), asked);
    whole.part(0..rays.len()).ask(Caster::Referee(&exact), &rays, Sides::Both);
    let mut parts = FirstColumns::new(rays.len(), asked);
    for from in (0..rays.len()).step_by(300) {
        let to = (from + 300).min(rays.len());
        parts.part(from..to).ask(Caster::Referee(&exact), &rays[from..to], Sides::Both);
    }
    let points = |columns: &FirstColumns| bits(columns.point.as_ref().unwrap().concat());
    assert_eq!((whole.face.as_ref(), points(&whole)), (parts.face.as_ref(), points(&parts)));
    assert!(whole.t.is_none() && whole.normal.is_none() && whole.ties.is_none());
}

/// Every ray counts once, and each path is taken: rays anywhere need no intervals, hard ones do, and exact arithmetic.
#[test]
fn the_hard_rays_take_each_path() {
    let hard = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../data/rays/hard");
    let of = |family: &str| {
        let folder = hard.join(family);
        let mesh = read_triangles(&folder.join("mesh.obj")).unwrap().triangles;
        let rays = read_rays(&folder.join("rays.npy")).unwrap().rays;
        let answers = cast(&mesh, &rays, Sides::Both, Questions::default(), &Silent);
        let decided = answers.decided.expect("the referee's answers");
        assert_eq!(decided.filter + decided.intervals + decided.exact, rays.len() as u64, "{family}");
        // The same by columns, whatever they are asked for.
        let exact = ExactCast::new(&mesh);
        let mut columns = FirstColumns::new(rays.len(), Values::named(["face"]).unwrap());
        let counts = columns.part(0..rays.len()).ask(Caster::Referee(&exact), &rays, Sides::Both);
        assert_eq!(counts.decided, decided, "{family}");
        decided
    };
    let counts =
        ["grazing", "edges", "vertices", "one-ulp-beside", "tiny", "huge", "needles", "just-before"].map(of);
    let all = counts.into_iter().fold(DecidedCounts::default(), DecidedCounts::and);
    assert!(all.filter > 100 && all.exact > 1000, "{all:?} of {counts:?}");
    // Whatever is so near an edge is too near for intervals. These tell a ray that is beside it by a few hundred roundings.
    let beside =
        |k: u32| CastRay::new(DVec3::new(3.0 + 2e-15 * f64::from(k), 4.3, 5.0), DVec3::new(0.0, 0.0, -2.0));
    let near: Vec<CastRay> = (0..400).map(beside).collect();
    let beside = cast(&ground(), &near, Sides::Both, Questions::default(), &Silent).decided.unwrap();
    assert!(beside.filter > 100 && beside.intervals > 10 && beside.exact > 0, "{beside:?}");
    // Through vertices, it is exact; rays that meet nothing but faces' insides need none of it.
    let [_, edges, vertices, ..] = counts;
    assert!(edges.exact > 0 && vertices.exact > 0, "{edges:?} {vertices:?}");
    let rays: Vec<CastRay> =
        rays().iter().map(|ray| CastRay { t_blind: 0.0, origin: ray.origin + 0.01, ..*ray }).collect();
    let easy = cast(&ground(), &rays, Sides::Both, Questions::default(), &Silent).decided.unwrap();
    assert!(easy.filter > 1600, "{easy:?}");
    // The tracer decides nothing exactly.
    let tracer = TracerCast::new(&ground());
    assert_eq!(Answers::traced(&tracer, &rays, Sides::Both).decided, None);
}
