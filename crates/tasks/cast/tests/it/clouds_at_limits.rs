//! Clouds of rays that run side by side along x, each before a wall of its own: where points end, begin or stand in the place of none, and
//! the steps of their numbers, follow from the distances that are given.

use glam::DVec3;
use raypencil_cast::{
    CandidateConventions, CastSource, RayArray, RayPackChecked, check_ray_pack, write_ray_pack,
};
use raypencil_scene::{CastRay, Precision, Sides, Silent, Triangles};

/// A ray, its wall and the point that a program tells of it; all are distances.
#[derive(Debug, Clone, Copy)]
struct Lane {
    /// Distance of the wall; infinite: there is none.
    wall: f64,
    /// Distance of the point that is told; NaN: none.
    told: f64,
    /// The field `range`.
    range: f64,
    /// The sensor's longest range.
    reach: f64,
    /// The sensor's shortest range.
    blind: f64,
    /// Length of the ray's direction.
    speed: f64,
}

const LANE: Lane =
    Lane { wall: f64::INFINITY, told: f64::NAN, range: f64::NAN, reach: 100.0, blind: 0.0, speed: 1.0 };

/// A wall whose point is told where it is.
fn seen(wall: f64) -> Lane {
    Lane { wall, told: wall, range: wall, ..LANE }
}

/// A wall of which nothing is told.
fn unseen(wall: f64) -> Lane {
    Lane { wall, ..LANE }
}

/// No wall, and a point.
fn invented(told: f64) -> Lane {
    Lane { told, ..LANE }
}

fn some(count: usize, lane: impl Fn(f64) -> Lane) -> Vec<Lane> {
    (0..count).map(|k| lane(k as f64)).collect()
}

/// What a check finds of the points of these lanes.
fn check(lanes: &[Lane], has_range: bool, precision: Precision) -> RayPackChecked {
    let (mut vertices, mut faces, mut rays) = (Vec::new(), Vec::new(), Vec::new());
    let mut cloud = format!("ply\nformat binary_little_endian 1.0\nelement vertex {}\n", lanes.len());
    cloud += "property double x\nproperty double y\nproperty double z\n";
    cloud += if has_range { "property double range\nend_header\n" } else { "end_header\n" };
    let mut cloud = cloud.into_bytes();
    for (k, lane) in lanes.iter().enumerate() {
        let y = 3.0 * k as f64;
        if lane.wall.is_finite() {
            let first = vertices.len() as u32;
            let corner = |(side, up): (f64, f64)| [lane.wall, y + side, up];
            vertices.extend([(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(corner));
            faces.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
        }
        let ray = CastRay::new(DVec3::Y * y, DVec3::X * lane.speed);
        let (t_max, t_blind) = (lane.reach / lane.speed, lane.blind / lane.speed);
        rays.push(CastRay { t_max, t_blind, ..ray });
        let point = if lane.told.is_nan() { [f64::NAN; 3] } else { [lane.told, y, 0.0] };
        point.iter().chain(has_range.then_some(&lane.range)).for_each(|n| cloud.extend(n.to_le_bytes()));
    }
    let mesh = Triangles::new(vertices, faces).expect("walls");
    let folder = tempfile::tempdir().expect("a folder");
    let (pack, file) = (folder.path().join("pack"), folder.path().join("theirs.ply"));
    let rays = RayArray { shape: vec![rays.len() as u64], rays };
    write_ray_pack(&pack, (&mesh, &rays, Sides::Both), &CastSource::default(), &Silent).expect("a pack");
    std::fs::write(&file, cloud).expect("a file");
    check_ray_pack(&pack, &file, precision, CandidateConventions::default(), &Silent).expect("a check")
}

/// The reason of wrong points without a field `range`; empty: none is found.
#[track_caller]
fn why(lanes: &[Lane]) -> String {
    let checked = check(lanes, false, Precision::F64);
    assert!(!checked.passes());
    checked.why.unwrap_or_default()
}

/// The reason of wrong points with a field `range`.
#[track_caller]
fn why_with_range(lanes: &[Lane]) -> String {
    let checked = check(lanes, true, Precision::F64);
    assert!(!checked.passes());
    checked.why.unwrap_or_default()
}

fn all_agree(words: &str) -> String {
    format!("100.0000 % agree if {words}")
}

#[test]
fn points_end_at_the_number_of_fewest_decimals_between_what_is_seen_and_what_is_not() {
    let ending = |seen_to: f64, unseen_from: f64| {
        let ending = some(12, |k| seen(seen_to - 0.5 * k));
        [ending, some(12, |k| unseen(unseen_from + 0.5 * k))].concat()
    };
    let words = |by: &str, low: &str, high: &str| {
        all_agree(&format!(
            "points end at {by}, or at any distance from {low} to {high}: the sensor's longest range is 100"
        ))
    };
    // The last point that is seen may be the end, the first one that is not may not.
    assert_eq!(why(&ending(8.43, 9.2)), words("9", "8.4300", "9.2000"));
    assert_eq!(why(&ending(9.0, 9.2)), words("9", "9.0000", "9.2000"));
    assert_eq!(why(&ending(8.43, 9.0)), words("8.5", "8.4300", "9.0000"));
    // Fewer points than twelve tell nothing.
    assert_eq!(why(&ending(8.43, 9.2)[1..]), "");
    // Distances are not parameters of rays, and each ray has its own end.
    let mut lanes = ending(8.43, 9.2);
    lanes.iter_mut().for_each(|lane| lane.speed = 2.0);
    assert_eq!(why(&lanes), words("9", "8.4300", "9.2000"));
    let mut lanes = ending(8.43, 9.2);
    // The first ray of all, and the first that has no point, look less far.
    lanes.iter_mut().enumerate().for_each(|(k, lane)| lane.reach = if k % 12 == 0 { 100.0 } else { 100.125 });
    assert!(why(&lanes).ends_with(": the sensor's longest range is 100.125"), "{}", why(&lanes));
    // One that is missing as far away as the last that is seen is another matter.
    let lanes = [ending(8.43, 9.2), some(200, |k| unseen(15.0 + 0.1 * k)), vec![unseen(8.43)]].concat();
    let of_most = why(&lanes);
    assert!(of_most.contains(" % agree if points end at 9, or"), "{of_most}");
    assert!(!of_most.starts_with("100"), "{of_most}");
}

#[test]
fn points_begin_at_the_number_of_fewest_decimals_between_what_is_not_seen_and_what_is() {
    let beginning = |unseen_to: f64, seen_from: f64| {
        let beginning = some(12, |k| unseen(unseen_to - 0.25 * k));
        [beginning, some(12, |k| seen(seen_from + 0.5 * k))].concat()
    };
    let words = |by: &str, low: &str, high: &str, shortest: &str| {
        all_agree(&format!(
            "points begin at {by}, or at any distance from {low} to {high}: the sensor's shortest range is {shortest}"
        ))
    };
    assert_eq!(why(&beginning(3.62, 4.31)), words("4", "3.6200", "4.3100", "0"));
    // The last that is not seen lies before the beginning.
    assert_eq!(why(&beginning(4.0, 4.31)), words("4.1", "4.0000", "4.3100", "0"));
    assert_eq!(why(&beginning(3.62, 4.31)[1..]), "");
    let mut lanes = beginning(3.62, 4.31);
    lanes.iter_mut().for_each(|lane| lane.speed = 2.0);
    assert_eq!(why(&lanes), words("4", "3.6200", "4.3100", "0"));
    let mut lanes = beginning(3.62, 4.31);
    lanes.iter_mut().enumerate().for_each(|(k, lane)| lane.blind = if k == 0 { 0.0625 } else { 0.125 });
    assert_eq!(why(&lanes), words("4", "3.6200", "4.3100", "0.125"));
    let lanes = [beginning(3.62, 4.31), some(200, |k| unseen(3.0 - 0.01 * k)), vec![unseen(4.31)]].concat();
    let of_most = why(&lanes);
    assert!(of_most.contains(" % agree if points begin at 4, or"), "{of_most}");
    assert!(!of_most.starts_with("100"), "{of_most}");
}

#[test]
fn points_of_misses_are_told_from_twelve_on_and_by_the_longest_range() {
    let at = |told: f64| [some(12, |_| invented(told)), some(12, |k| seen(2.0 + 0.7 * k))].concat();
    let words_of = |by: &str| format!("rays that meet nothing {by}: they have none");
    let at_longest = all_agree(&words_of("have a point at the longest range, 100"));
    assert_eq!(why(&at(100.0)), at_longest);
    assert_eq!(why(&at(100.0)[1..]), "");
    // A range is the parameter of a ray times the length of its direction, both of which are rounded.
    let mut lanes = at(100.0);
    for (speed, reach) in [(2.0, 100.0), (1.0, 100.0_f64.next_up()), (1.0, 100.0_f64.next_down())] {
        lanes.iter_mut().for_each(|lane| (lane.speed, lane.reach) = (speed, reach));
        assert_eq!(why(&lanes), at_longest, "{speed} {reach}");
    }
    // So are points, to either side.
    let mut lanes = at(100.0);
    let ulp = 100.0_f64.next_up() - 100.0;
    lanes.iter_mut().take(12).enumerate().for_each(|(k, lane)| lane.told += ulp * (k as f64 - 6.0));
    assert_eq!(why(&lanes), at_longest);
    let mut lanes = at(100.0);
    lanes.iter_mut().take(12).enumerate().for_each(|(k, lane)| lane.told *= 1.0 + 4e-8 * (k as f64 - 6.0));
    assert_eq!(check(&lanes, false, Precision::F32).why.unwrap_or_default(), at_longest);
    // Rays that look less far do so still.
    let mut lanes = at(30.0);
    lanes.extend(some(12, |k| Lane { reach: 5.0, ..unseen(7.0 + k) }));
    let words = "rays that meet nothing before 30 have a point there: they have none, and the sensor's longest range is 100";
    assert_eq!(why(&lanes), all_agree(words));
    // What is too near by the last bit may have a point, and is no miss.
    let mut lanes = at(100.0);
    lanes.extend(some(20, |_| seen(1.0_f64.next_down())));
    lanes.iter_mut().for_each(|lane| lane.blind = 1.0);
    assert_eq!(why(&lanes), at_longest);
    // Nor is what is nearer; but it has no point.
    let mut lanes = at(100.0);
    lanes.extend(some(20, |k| seen(0.3 + 0.01 * k)));
    lanes.iter_mut().for_each(|lane| lane.blind = 1.0);
    let found = why(&lanes);
    assert!(found.starts_with("100.0000 %"), "{found}");
    assert!(found.contains("rays that meet nothing have a point at the longest range, 100"), "{found}");
    assert!(found.contains("the sensor's shortest range is ignored"), "{found}");
}

/// A distance whose digits do not end.
fn odd(k: f64) -> f64 {
    2.0 + libm::sqrt(2.0 + k)
}

fn to_step(number: f64, step: f64) -> f64 {
    (number / step).round() * step
}

#[test]
fn a_step_is_told_from_twelve_numbers_on_and_with_its_size() {
    let of_step =
        |count: usize, step: f64| some(count, |k| Lane { told: to_step(odd(k), step), ..seen(odd(k)) });
    let steps = [
        (1.0, "1"),
        (0.6, "0.6"),
        (0.5, "0.5"),
        (0.025, "0.025"),
        (1.0 / 16384.0, "0.00006103515625"),
        (3e-8, "0.00000003"),
    ];
    for (step, words) in steps {
        let expected = all_agree(&format!("ranges are rounded to multiples of {words}"));
        assert_eq!(why(&of_step(12, step)), expected, "{step}");
    }
    // A multiple that is not the nearest one is wrong, too: nearly a step away, beyond what rounded coordinates would excuse.
    let mut lanes = of_step(12, 0.025);
    lanes[4].told += 0.025_f64.copysign(lanes[4].wall - lanes[4].told);
    assert_eq!(why(&lanes), "");
    // One number in a hundred may be none: it stays wrong.
    let mut lanes = of_step(200, 0.025);
    lanes[77].told = lanes[77].wall + 0.007;
    assert_eq!(why(&lanes), "99.5000 % agree if ranges are rounded to multiples of 0.025");
}

#[test]
fn a_step_of_the_field_range_alone_is_told_as_rounded_or_cut() {
    let of_field = |count: usize, of: fn(f64) -> f64| {
        some(count, |k| Lane { range: of(odd(k) / 0.025) * 0.025, ..seen(odd(k)) })
    };
    let cut = all_agree("the field range is cut to multiples of 0.025");
    let rounded = all_agree("the field range is rounded to multiples of 0.025");
    assert_eq!(why_with_range(&of_field(12, f64::floor)), cut);
    assert_eq!(why_with_range(&of_field(12, f64::round)), rounded);
    let mut lanes = of_field(12, f64::round);
    lanes[5].range += 0.025_f64.copysign(lanes[5].wall - lanes[5].range);
    assert_eq!(why_with_range(&lanes), "");
    for of in [f64::floor, f64::round] {
        let mut lanes = of_field(200, of);
        lanes[77].range = lanes[77].wall - 0.007;
        let found = why_with_range(&lanes);
        assert!(found.starts_with("99.5000 % agree if the field range is "), "{found}");
    }
    // Points and their field.
    let both = some(12, |k| {
        let told = libm::floor(odd(k) / 0.025) * 0.025;
        Lane { told, range: told, ..seen(odd(k)) }
    });
    assert_eq!(why_with_range(&both), all_agree("ranges are cut to multiples of 0.025"));
}
