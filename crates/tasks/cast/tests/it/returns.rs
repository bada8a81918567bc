//! Returns of beams with a width, of worlds whose ranges and shares follow by hand.

use glam::DVec3;
use raypencil_cast::{
    Answers, BeamReturn, BeamReturns, CastSource, CloudFrame, CloudMap, PcdData, Questions, cast, write_pcd,
    write_set,
};
use raypencil_files::{Limits, read_npy_numbers};
use raypencil_scene::pattern::{Cone, EchoLight, Keep, Mounting, PatternRays, Returns};
use raypencil_scene::{CastRay, NamedRaySet, Sides, Silent, Triangles};

/// Half angle of the cone, radians, and its rays: 1 + 6 + 12.
const HALF_RAD: f64 = 0.01;
const RAYS: usize = 19;

/// A beam from the origin along x, blind before some t, of which these returns are told.
fn beam(direction: DVec3, t_blind: f64, keep: Keep, separation_m: f64) -> NamedRaySet {
    let axis = PatternRays {
        shape: vec![1],
        rays: vec![CastRay { t_blind, ..CastRay::new(DVec3::ZERO, direction) }],
        times: None,
        weights: None,
        returns: None,
        elevations_deg: None,
        mounting: Mounting::HERE,
    };
    let cone = Cone { divergence_rad: 2.0 * HALF_RAD, rings: 2 };
    let rays = cone.spread(&axis, "cone").expect("a cone");
    let rays = PatternRays { returns: Some(Returns { keep, separation_m }), ..rays };
    NamedRaySet::new("beam", rays, Sides::Both).expect("a set")
}

/// A part of the plane at this x: y from `low` to `high` where the beam is 1 m from the origin, and so twice as far at x = 2.
fn wall(x: f64, low: f64, high: f64) -> [[f64; 3]; 4] {
    [[x, low * x, -x], [x, high * x, -x], [x, high * x, x], [x, low * x, x]]
}

fn mesh(walls: &[[[f64; 3]; 4]]) -> Triangles {
    let faces =
        (0..walls.len() as u32).flat_map(|k| [[4 * k, 4 * k + 1, 4 * k + 2], [4 * k, 4 * k + 2, 4 * k + 3]]);
    Triangles::new(walls.concat(), faces.collect()).expect("walls")
}

fn asked(mesh: &Triangles, set: &NamedRaySet) -> (Answers, BeamReturns) {
    let answers = cast(mesh, set.set.rays(), Sides::Both, Questions::default(), &Silent);
    let returns = BeamReturns::of(&answers, set).expect("returns");
    assert_eq!((returns.rays_of_beam(), returns.footprints().len()), (RAYS, 1));
    (answers, returns)
}

fn told(returns: &BeamReturns) -> Vec<BeamReturn> {
    returns.told().iter().flatten().copied().collect()
}

/// The light of the rays of a beam that lie so on a wall across x, ray by ray: cos psi = d.x, R = x / d.x.
fn light(set: &NamedRaySet, x: f64, is_on: impl Fn(DVec3) -> bool) -> f64 {
    let weights = set.weights.as_ref().expect("weights");
    let each = set.set.rays().iter().zip(weights).filter(|(ray, _)| is_on(ray.direction));
    each.map(|(ray, weight)| weight * ray.direction.x * ray.direction.x * ray.direction.x / (x * x)).sum()
}

/// Rays that run to the near wall: those whose y at 1 m is above a thousandth of a milliradian below the middle.
fn is_left(direction: DVec3) -> bool {
    direction.y / direction.x > -1e-6
}

#[test]
fn half_of_a_footprint_is_on_a_near_wall_and_half_on_a_far_one() {
    let walls = mesh(&[wall(10.0, -1e-6, 1.0), wall(20.0, -1.0, 1.0)]);
    let set = beam(DVec3::X, 0.0, Keep::UpTo(2), 0.5);
    let (answers, returns) = asked(&walls, &set);
    let left = set.set.rays().iter().filter(|ray| is_left(ray.direction)).count();
    // The middle, half of each ring, and of a ring either one or both of the rays that lie on the border.
    assert_eq!(left, 12);
    let found = told(&returns);
    let [near, far] = [found[0], found[1]];
    assert_eq!((found.len(), near.number, far.number, near.rays, far.rays), (2, 1, 2, 12, 7));
    // The middle of the beam is exactly x: 10 m. The far return's leading ray is on the inner ring, half of the angle out.
    assert_eq!((near.ray, near.range), (0, 10.0));
    assert!((1..7).contains(&far.ray) && !is_left(set.set.rays()[far.ray].direction));
    assert!((far.range - 20.0 / libm::cos(HALF_RAD / 2.0)).abs() < 1e-13);
    assert_eq!(far.range, answers.first[far.ray].hit().expect("a hit").range);
    for (one, x, side) in [(near, 10.0, true), (far, 20.0, false)] {
        let exact = light(&set, x, |direction| is_left(direction) == side);
        assert!((one.strength / exact - 1.0).abs() < 1e-13, "{one:?}");
        assert!(one.mean_range > x && one.mean_range < x / libm::cos(HALF_RAD));
    }
    let footprint = returns.footprints()[0];
    assert_eq!((footprint.returns, footprint.hits, footprint.too_near), (2, 19, 0));
    assert!(footprint.is_mixed());
    assert_eq!((returns.share(near.rays), returns.missed(&footprint)), (12.0 / 19.0, 0.0));
    for (ray, of_ray) in set.set.rays().iter().zip(returns.of_rays()) {
        assert_eq!(*of_ray, if is_left(ray.direction) { 1 } else { 2 });
    }
    // What is told follows the mode; number, strength and range stay.
    for (keep, one) in
        [(Keep::First, near), (Keep::Strongest, near), (Keep::Last, far), (Keep::UpTo(1), near)]
    {
        assert_eq!(told(&asked(&walls, &beam(DVec3::X, 0.0, keep, 0.5)).1), [one], "{keep:?}");
    }
    // Walls that are less than the separation apart are one surface: one return over all rays.
    let (_, joined) = asked(&walls, &beam(DVec3::X, 0.0, Keep::UpTo(2), 10.1));
    assert_eq!((told(&joined)[0].rays, joined.footprints()[0].is_mixed()), (19, false));
    assert_eq!(joined.told()[1], None);
}

#[test]
fn in_thick_air_the_near_wall_is_the_strongest() {
    // The near wall has the seven rays on one side; the far one the middle and the others, and more light without air.
    let walls = mesh(&[wall(10.0, -1.0, -1e-6), wall(12.0, -1.0, 1.0)]);
    let clear = beam(DVec3::X, 0.0, Keep::UpTo(2), 0.5);
    // 0.2 1/m on 2 m more, there and back: e^-0.8, more than the walls differ by.
    let echo = EchoLight { reflectivity: 0.5, extinction_per_m: 0.2 };
    let thick = NamedRaySet { echo, ..clear.clone() };
    let both = |set: &NamedRaySet| {
        let found = told(&asked(&walls, set).1);
        [found[0], found[1]]
    };
    let ([near, far], [near_left, far_left]) = (both(&clear), both(&thick));
    assert!(
        near.strength < far.strength && near_left.strength > far_left.strength,
        "{near_left:?} {far_left:?}"
    );
    for (clear, left) in [(near, near_left), (far, far_left)] {
        // Rays of a wall differ by 0.6 mm at most: by 2.4e-4 of the light that the air leaves.
        let expected = 0.5 * clear.strength * libm::exp(-0.4 * clear.range);
        assert!((left.strength / expected - 1.0).abs() < 5e-4, "{clear:?} {left:?}");
        assert_eq!((left.range, left.ray, left.rays), (clear.range, clear.ray, clear.rays));
    }
    for (echo, number) in [(EchoLight::default(), 2), (echo, 1)] {
        let set = NamedRaySet { echo, ..beam(DVec3::X, 0.0, Keep::Strongest, 0.5) };
        assert_eq!(told(&asked(&walls, &set).1)[0].number, number);
    }
}

#[test]
fn a_plane_across_the_beam_is_one_return_whose_light_is_summed_in_order() {
    let set = beam(DVec3::X, 0.0, Keep::Strongest, 1e-2);
    let (answers, returns) = asked(&mesh(&[wall(30.0, -1.0, 1.0)]), &set);
    let [one] = told(&returns)[..] else { panic!("one return") };
    assert_eq!((one.number, one.ray, one.range, one.rays), (1, 0, 30.0, 19));
    assert!(!returns.footprints()[0].is_mixed());
    // Bit for bit: from the first ray to the last.
    let mut sum = 0.0;
    for (read, weight) in answers.first.iter().zip(set.weights.as_ref().expect("weights")) {
        let hit = read.hit().expect("a hit");
        sum += weight * (hit.cos_incidence.abs() / (hit.range * hit.range));
    }
    assert_eq!(one.strength, sum);
}

#[test]
fn a_grazing_plane_is_one_return_until_its_rays_are_further_apart_than_the_separation() {
    // A floor 1 m below, seen 2 degrees below the horizon: ranges from 22 to 40 m.
    let corner = |x: f64, y: f64| [x, y, -1.0];
    let floor = Triangles::new(
        vec![corner(1.0, -50.0), corner(99.0, -50.0), corner(99.0, 50.0), corner(1.0, 50.0)],
        vec![[0, 1, 2], [0, 2, 3]],
    )
    .expect("a floor");
    let down = libm::sincos(2_f64.to_radians());
    let direction = DVec3::new(down.1, 0.0, -down.0);
    for separation in [30.0, 3.0, 1.0] {
        let set = beam(direction, 0.0, Keep::UpTo(16), separation);
        let (_, returns) = asked(&floor, &set);
        // The range is the height over the sine.
        let mut ranges: Vec<f64> =
            set.set.rays().iter().map(|ray| -ray.direction.length() / ray.direction.z).collect();
        ranges.sort_by(f64::total_cmp);
        let gaps: Vec<f64> = ranges.windows(2).map(|pair| pair[1] - pair[0]).collect();
        assert!(gaps.iter().all(|gap| (gap - separation).abs() > 1e-6), "no gap is in doubt: {gaps:?}");
        let expected = 1 + gaps.iter().filter(|gap| **gap > separation).count();
        assert_eq!(told(&returns).len(), expected);
        assert_eq!(expected == 1, separation > 5.0, "{gaps:?}");
        let middle = told(&returns).iter().find(|one| one.ray == 0).expect("that of the middle").range;
        assert!((middle * down.0 - 1.0).abs() < 1e-13);
    }
}

#[test]
fn of_three_layers_the_two_strongest_are_told_by_range() {
    // A strip in the middle of the far wall's view is hidden by a second, narrower wall; the outer ring's left by a near one.
    let [near, middle] = [0.0075, 0.0035];
    let walls = mesh(&[wall(10.0, near, 1.0), wall(20.0, middle, near), wall(25.0, -1.0, middle)]);
    let layer = |direction: DVec3| {
        let y = direction.y / direction.x;
        if y > near {
            10.0
        } else if y > middle {
            20.0
        } else {
            25.0
        }
    };
    let set = beam(DVec3::X, 0.0, Keep::UpTo(2), 1.0);
    let (_, returns) = asked(&walls, &set);
    let lights = [10.0, 20.0, 25.0].map(|x| light(&set, x, |direction| layer(direction) == x));
    let counts =
        [10.0, 20.0, 25.0].map(|x| set.set.rays().iter().filter(|ray| layer(ray.direction) == x).count());
    assert_eq!((counts, lights[1] < lights[0].min(lights[2])), ([3, 4, 12], false));
    let weakest = (0..3).min_by(|&a, &b| lights[a].total_cmp(&lights[b])).expect("three");
    let expected: Vec<u32> = (0..3).filter(|layer| *layer != weakest).map(|layer| layer as u32 + 1).collect();
    let found = told(&returns);
    assert_eq!(found.iter().map(|one| one.number).collect::<Vec<_>>(), expected);
    for one in &found {
        let layer = one.number as usize - 1;
        assert!((one.strength / lights[layer] - 1.0).abs() < 1e-13);
        assert_eq!(one.rays as usize, counts[layer]);
    }
    assert_eq!((returns.footprints()[0].returns, returns.footprints()[0].hits), (3, 19));
    let numbers = |keep| told(&asked(&walls, &beam(DVec3::X, 0.0, keep, 1.0)).1)[0].number;
    let strongest = (0..3).max_by(|&a, &b| lights[a].total_cmp(&lights[b])).expect("three") as u32 + 1;
    assert_eq!([Keep::First, Keep::Last, Keep::Strongest].map(numbers), [1, 3, strongest]);
}

#[test]
fn rays_that_miss_or_are_too_near_are_counted_apart() {
    let near = wall(10.0, -1e-6, 1.0);
    let (_, returns) = asked(&mesh(&[near]), &beam(DVec3::X, 0.0, Keep::UpTo(3), 0.5));
    let footprint = returns.footprints()[0];
    assert_eq!((footprint.returns, returns.missed(&footprint)), (1, 7.0 / 19.0));
    // Its edge against the sky is no second surface.
    assert!(!footprint.is_mixed());
    assert_eq!(returns.of_rays().iter().filter(|number| **number == 0).count(), 7);
    // A sensor that measures from 15 m on: what is nearer hides what is behind it.
    let walls = mesh(&[near, wall(20.0, -1.0, 1.0)]);
    let (_, returns) = asked(&walls, &beam(DVec3::X, 15.0, Keep::UpTo(3), 0.5));
    let footprint = returns.footprints()[0];
    assert_eq!((footprint.returns, footprint.hits, footprint.too_near), (1, 7, 12));
    assert_eq!((told(&returns)[0].number, returns.missed(&footprint)), (1, 0.0));
}

#[test]
fn in_a_cloud_a_beam_is_too_near_once_and_a_beam_that_misses_never() {
    let walls = mesh(&[wall(10.0, -1.0, 1.0)]);
    let folder = tempfile::tempdir().expect("a folder");
    for (direction, t_blind, first) in [(DVec3::X, 15.0, f32::NEG_INFINITY), (DVec3::NEG_X, 15.0, f32::NAN)] {
        let set = beam(direction, t_blind, Keep::UpTo(3), 0.5);
        let (answers, returns) = asked(&walls, &set);
        let path = folder.path().join("cloud.pcd");
        let form = (CloudFrame::Mesh, PcdData::Binary);
        write_pcd(&path, &answers, (&set, Some(&returns)), form, &CloudMap::default()).expect("a cloud");
        let cloud = std::fs::read(&path).expect("a file");
        // Three points of 61 bytes; the range of each stands at 32.
        let points = cloud[cloud.len() - 3 * 61..].chunks_exact(61);
        let ranges: Vec<u32> = points
            .map(|point| f32::from_le_bytes(point[32..36].try_into().expect("four")).to_bits())
            .collect();
        assert_eq!(ranges, [first, f32::NAN, f32::NAN].map(f32::to_bits), "{direction}");
    }
}

#[test]
fn arrays_and_clouds_have_a_place_for_each_return() {
    let folder = tempfile::tempdir().expect("a folder");
    let walls = mesh(&[wall(10.0, -1e-6, 1.0), wall(20.0, -1.0, 1.0)]);
    let set = beam(DVec3::X, 0.0, Keep::UpTo(3), 0.5);
    let (answers, returns) = asked(&walls, &set);
    let source = CastSource { mesh: "m".into(), rays: "r".into(), ..CastSource::default() };
    write_set(folder.path(), &answers, (&walls, &set, Sides::Both), &source, PcdData::Binary)
        .expect("a folder");
    let read = |name: &str| {
        let path = folder.path().join(format!("return.{name}.npy"));
        let array = read_npy_numbers(path, &Limits::default()).expect("an array");
        (array.shape, array.values)
    };
    let [near, far] = [told(&returns)[0], told(&returns)[1]];
    assert_eq!(read("count"), (vec![1], vec![2.0]));
    assert_eq!(read("mixed"), (vec![1], vec![1.0]));
    assert_eq!(read("share_missed"), (vec![1], vec![0.0]));
    assert_eq!(read("number"), (vec![1, 3], vec![1.0, 2.0, 0.0]));
    assert_eq!(read("ray").1, [0.0, far.ray as f64, f64::from(u32::MAX)]);
    assert_eq!(read("range").1, [10.0, far.range, f64::INFINITY]);
    assert_eq!(read("mean_range").1, [near.mean_range, far.mean_range, f64::INFINITY]);
    assert_eq!(read("strength").1, [near.strength, far.strength, 0.0]);
    assert_eq!(read("share").1, [12.0 / 19.0, 7.0 / 19.0, 0.0]);
    assert_eq!(read("share_other").1, [7.0 / 19.0, 12.0 / 19.0, 1.0]);
    assert_eq!(read("of_ray").0, [1, 19]);

    let text = |bytes: &[u8], end: &str| {
        let at = bytes.windows(end.len()).position(|at| at == end.as_bytes()).expect("a header") + end.len();
        (String::from_utf8(bytes[..at].to_vec()).expect("text"), bytes[at..].to_vec())
    };
    let single = |bytes: &[u8], at: usize| f32::from_le_bytes(bytes[at..at + 4].try_into().expect("four"));
    let double = |bytes: &[u8], at: usize| f64::from_le_bytes(bytes[at..at + 8].try_into().expect("eight"));
    let (header, body) =
        text(&std::fs::read(folder.path().join("cloud.pcd")).expect("a file"), "DATA binary\n");
    for line in [
        "FIELDS x y z intensity ring time timestamp channel range face mean_range share share_other share_missed return returns mixed",
        "SIZE 4 4 4 4 2 4 8 2 4 4 4 4 4 4 2 2 1",
        "WIDTH 3\nHEIGHT 1",
        "POINTS 3",
    ] {
        assert!(header.contains(line), "{header}");
    }
    assert_eq!(body.len(), 3 * 61);
    for (point, one) in body.chunks_exact(61).zip([Some(near), Some(far), None]) {
        let (number, returns, mixed) = (point[56], point[58], point[60]);
        assert_eq!((number, returns, mixed), (one.map_or(0, |one| one.number as u8), 2, 1));
        let Some(one) = one else {
            assert!(single(point, 0).is_nan() && single(point, 12).is_nan() && single(point, 40).is_nan());
            continue;
        };
        let hit = answers.first[one.ray].hit().expect("a hit");
        assert_eq!([single(point, 0), single(point, 4)], [hit.point.x as f32, hit.point.y as f32]);
        assert_eq!([single(point, 12), single(point, 32)], [one.strength as f32, one.range as f32]);
        assert_eq!(single(point, 40), one.mean_range as f32);
        assert_eq!(single(point, 44), (f64::from(one.rays) / 19.0) as f32);
    }
    let (header, body) =
        text(&std::fs::read(folder.path().join("cloud.ply")).expect("a file"), "end_header\n");
    assert!(header.contains("element vertex 2\n") && header.contains("property uchar mixed\n"), "{header}");
    assert_eq!(body.len(), 2 * 77);
    for (point, one) in body.chunks_exact(77).zip([near, far]) {
        assert_eq!([36, 44, 52].map(|at| double(point, at)), [one.range, one.mean_range, one.strength]);
        assert_eq!(
            (single(point, 60), point[72], point[74], point[76]),
            ((f64::from(one.rays) / 19.0) as f32, one.number as u8, 2, 1)
        );
    }
    let summary = std::fs::read_to_string(folder.path().join("summary.json")).expect("a summary");
    let summary: serde_json::Value = serde_json::from_str(&summary).expect("JSON");
    let expected = serde_json::json!({
        "keep": 3, "separationM": 0.5, "raysOfFootprint": 19, "footprints": 1, "withReturn": 1, "mixed": 1, "told": 2
    });
    assert_eq!(summary["returns"], expected);
    assert_eq!(returns.text(), "1 footprint: 1 have a return, 1 are mixed; 2 returns told");
}
