//! Constants that can hardly be heights, and models that must pass.

use super::*;

/// 24 x 24 posts 1 m apart. The diagonal, 32.5 m, is the smallest step that is no ground.
const SIDE: usize = 24;

/// Numbers that look random, from 0 to 1. (Knuth, "The Art of Computer Programming", volume 2: MMIX)
struct Draws(u64);

impl Draws {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 40) as f64 / (1 << 24) as f64
    }
}

fn grid(height: impl Fn(f64, f64) -> f64) -> Vec<f64> {
    let at = |place: usize| height((place % SIDE) as f64, (place / SIDE) as f64);
    (0..SIDE * SIDE).map(at).collect()
}

/// Ground between 100 m and 112 m, all of its heights different.
fn ground() -> Vec<f64> {
    grid(|x, y| 106.0 + 3.0 * wave(x / 4.0) + 3.0 * wave(y / 5.0) + 1e-4 * x + 1e-3 * y)
}

/// The sine between -1 and 1, near enough for hills: a parabola for each half wave.
fn wave(angle: f64) -> f64 {
    let turns = angle / std::f64::consts::TAU;
    let part = 2.0 * (turns - turns.floor());
    if part < 1.0 { 4.0 * part * (1.0 - part) } else { -4.0 * (part - 1.0) * (2.0 - part) }
}

fn posts(heights: &[f64]) -> Posts<'_> {
    Posts { heights, columns: SIDE, spacing: DVec2::ONE, metre: 1.0 }
}

/// Replaces the posts of a block of columns and rows.
fn put(heights: &mut [f64], columns: std::ops::Range<usize>, rows: std::ops::Range<usize>, value: f64) {
    for row in rows {
        heights[row * SIDE..][columns.clone()].fill(value);
    }
}

/// As a program does that moves a model by half a post without knowing of unknown heights: the mean of four.
fn resampled(heights: &[f64]) -> Vec<f64> {
    let at = |column: usize, row: usize| heights[row.min(SIDE - 1) * SIDE + column.min(SIDE - 1)];
    let mean = |(c, r): (usize, usize)| (at(c, r) + at(c + 1, r) + at(c, r + 1) + at(c + 1, r + 1)) / 4.0;
    (0..SIDE * SIDE).map(|place| mean((place % SIDE, place / SIDE))).collect()
}

/// What programs write for unknown heights.
const USUAL: [f64; 12] =
    [-9999.0, -32768.0, 32767.0, 0.0, -999.0, 9999.0, -99999.0, 65535.0, -1.0, -3000.0, 1e6, -123_456.789];

#[test]
fn usual_constants_are_found_with_and_without_noise() {
    for value in USUAL {
        let mut few = ground();
        put(&mut few, 5..9, 5..9, value);
        let mut scattered = ground();
        for place in [17, 200, 341, 342, 570] {
            scattered[place] = value;
        }
        let mut border = ground();
        put(&mut border, 0..24, 0..20, value);
        let mut noisy = ground();
        let mut draws = Draws(7);
        noisy.iter_mut().for_each(|height| *height += 4.0 * draws.next());
        put(&mut noisy, 0..3, 0..24, value);
        for (name, heights) in [("few", few), ("scattered", scattered), ("border", border), ("noisy", noisy)]
        {
            let count = heights.iter().filter(|&&height| height == value).count();
            let found = posts(&heights).constant().unwrap_or_else(|| panic!("{name} {value}"));
            assert_eq!((found.height, found.count), (value, count), "{name}");
            assert_eq!(found.is_below, value < 100.0, "{name} {value}");
            assert!(found.gap > found.span, "{name} {value}: {found:?}");
            if name == "few" || name == "scattered" {
                continue;
            }
            // With mixtures of it and the ground between them.
            let mixed = resampled(&heights);
            let found = posts(&mixed).constant().unwrap_or_else(|| panic!("{name} {value}, resampled"));
            assert_eq!(found.height, value, "{name}");
        }
    }
}

#[test]
fn mixtures_by_resampling_hide_no_constant() {
    for value in USUAL {
        let mut hole = ground();
        put(&mut hole, 5..12, 5..12, value);
        let once = resampled(&hole);
        for heights in [once.clone(), resampled(&once)] {
            let found = posts(&heights).constant().unwrap_or_else(|| panic!("{value}"));
            assert_eq!(found.height, value);
        }
    }
    // So many mixtures that no gap is left: a wide border along a diagonal.
    let wide = 600;
    let heights: Vec<f64> = (0..wide * wide)
        .map(|place| {
            let (x, y) = ((place % wide) as f64, (place / wide) as f64);
            let ground = 100.0 + 10.0 * wave(x / 40.0) + 1e-3 * y;
            let share = ((x - y + 0.37 * wave(1.7 * y)) / 2.0).clamp(0.0, 1.0);
            share * ground + (1.0 - share) * -9999.0
        })
        .collect();
    let posts = Posts { heights: &heights, columns: wide, spacing: DVec2::ONE, metre: 1.0 };
    assert_eq!(posts.constant().map(|found| found.height), Some(-9999.0));
}

#[test]
fn two_constants_are_found_one_after_the_other() {
    let mut heights = ground();
    put(&mut heights, 0..4, 0..24, -32768.0);
    put(&mut heights, 20..24, 0..24, 32767.0);
    let first = posts(&heights).constant().unwrap().height;
    heights.iter_mut().filter(|height| **height == first).for_each(|height| *height = f64::NAN);
    let second = posts(&heights).constant().unwrap().height;
    assert_eq!(first.abs() + second.abs(), 32768.0 + 32767.0);
    heights.iter_mut().filter(|height| **height == second).for_each(|height| *height = f64::NAN);
    assert_eq!(posts(&heights).constant(), None);
}

#[test]
fn what_can_be_ground_passes() {
    let hill = |x: f64, y: f64, high: f64| {
        let far = ((x - 12.0) * (x - 12.0) + (y - 12.0) * (y - 12.0)) / 50.0;
        high / (1.0 + far)
    };
    for (name, heights) in [
        ("a plane", grid(|_, _| 5.0)),
        ("a slope", grid(|x, y| x + 0.3 * y)),
        ("a lake in hills", ground().iter().map(|height| height.max(104.0)).collect()),
        ("a sea of level 0 under hills", grid(|x, y| (hill(x, y, 60.0) - 20.0).max(0.0))),
        ("a sea of level 0 under a steep hill", grid(|x, y| (hill(x, y, 100.0) - 30.0).max(0.0))),
        ("a cliff of 20 m", grid(|x, y| if x < 12.0 { 0.0 } else { 20.0 + 0.1 * y })),
        ("a cliff of 30 m between planes", grid(|x, _| if x < 12.0 { 0.0 } else { 30.0 })),
        ("a terrace of two levels", grid(|x, _| if x < 17.0 { 1.0 } else { 3.0 })),
        ("a terrace of two levels, 100 m", grid(|x, _| if x < 17.0 { 0.0 } else { 100.0 })),
        (
            "a cliff of 60 m in whole metres",
            grid(|x, y| ((x * 7.0 + y * 3.0) % 5.0).floor() + if x < 9.0 { 0.0 } else { 60.0 }),
        ),
        ("a crater with a floor", grid(|x, y| (20.0 - hill(x, y, 45.0)).max(-15.0))),
        ("one post of -9999", {
            let mut one = ground();
            one[77] = -9999.0;
            one
        }),
        ("whole metres", grid(|x, y| (100.0 + 30.0 * wave(x / 9.0) + y).floor())),
        ("nothing known", grid(|_, _| f64::NAN)),
        ("one post known", grid(|x, y| if x + y == 0.0 { 1.0 } else { f64::NAN })),
    ] {
        assert_eq!(posts(&heights).constant(), None, "{name}");
    }
    // Slopes of 232 m with two posts 168 m above them: less than the rest is high. At 500 m they stand out.
    let mut towers = grid(|x, y| 10.0 * x + 0.1 * y);
    put(&mut towers, 3..5, 7..8, 400.0);
    assert_eq!((posts(&towers).constant(), posts(&towers).spikes()), (None, None));
    put(&mut towers, 3..5, 7..8, 500.0);
    assert_eq!(posts(&towers).constant().map(|found| found.height), Some(500.0));
    // A yard of 10 m, 1 cm apart, with a box of 2 m on a floor: steep, but no leap.
    let floor: Vec<f64> =
        (0..1000 * 100).map(|place| if (300..360).contains(&(place % 1000)) { 2.0 } else { 0.0 }).collect();
    let yard = Posts { heights: &floor, columns: 1000, spacing: DVec2::splat(0.01), metre: 1.0 };
    assert_eq!(yard.constant(), None);
    assert_eq!(yard.spikes(), None);
}

#[test]
fn the_unit_of_the_heights_does_not_matter() {
    // In feet all of it is larger, and so is the metre: 3.28 units.
    let metre = 1.0 / 0.3048;
    let mut heights: Vec<f64> = ground().iter().map(|height| height * metre).collect();
    put(&mut heights, 5..9, 5..9, 0.0);
    let in_feet = |heights| Posts { heights, columns: SIDE, spacing: DVec2::splat(metre), metre };
    assert_eq!(in_feet(&heights).constant().map(|found| found.height), Some(0.0));
    // A cliff of 30 m, which is 98 ft.
    let cliff = grid(|x, y| if x < 12.0 { 0.0 } else { 30.0 * metre + 0.1 * y });
    assert_eq!(in_feet(&cliff).constant(), None);
    assert!(posts(&cliff).constant().is_some());
}

#[test]
fn spikes_are_counted_and_the_worst_is_placed() {
    let mut heights = ground();
    assert_eq!(posts(&heights).spikes(), None);
    (heights[77], heights[300], heights[301]) = (-9999.0, 9000.0, 800.0);
    let spikes = posts(&heights).spikes().unwrap();
    assert_eq!((spikes.count, spikes.worst), (3, 77));
    let rest: Vec<f64> = ground()
        .iter()
        .enumerate()
        .filter(|(at, _)| ![77, 300, 301].contains(at))
        .map(|(_, &height)| height)
        .collect();
    let (low, high) =
        (rest.iter().copied().fold(f64::MAX, f64::min), rest.iter().copied().fold(f64::MIN, f64::max));
    assert_eq!((spikes.rest, spikes.stands_out), (high - low, -9999.0 - low));
    // The same from unknown posts on, and above.
    (heights[0], heights[77]) = (f64::NAN, f64::NAN);
    let spikes = posts(&heights).spikes().unwrap();
    assert_eq!((spikes.count, spikes.worst), (2, 300));
    assert!(spikes.stands_out > 8880.0);
    // A hole of the same depth as a tower is high hides neither.
    (heights[77], heights[300], heights[301]) = (-900.0, 1100.0, 105.0);
    assert_eq!(posts(&heights).spikes().map(|spikes| spikes.count), Some(2));
}

#[test]
fn of_equals_the_lowest_and_the_first_is_told() {
    assert_eq!(most_frequent(&[1.0, 1.0, 2.0, 3.0, 3.0]), Some((1.0, 2)));
    // As many heights below as above: the constant is below those that are above.
    let found = Constant::new(0.0, 3, &[-5.0, 7.0]);
    assert_eq!((found.is_below, found.gap, found.span), (true, 7.0, 0.0));
    let mut heights = ground();
    let [low, high] = posts(&heights).range().unwrap();
    (heights[77], heights[300]) = (high + 500.0, high + 500.0);
    let spikes = posts(&heights).spikes().unwrap();
    assert_eq!((spikes.count, spikes.worst), (2, 77));
    assert!((spikes.stands_out - 500.0).abs() < high - low, "{spikes:?}");
}

#[test]
fn a_step_that_is_no_ground_is_so_in_any_unit() {
    // 101 x 2 posts 10 m apart, in feet: the model is 1000 m long, so that 500 m are the smallest step.
    let metre = 1.0 / 0.3048;
    let heights = vec![0.0; 202];
    let spacing = DVec2::splat(10.0 * metre);
    let in_feet = Posts { heights: &heights, columns: 101, spacing, metre };
    assert_eq!(in_feet.smallest_leap(), 500.0 * metre);
    // Two levels, 300 m apart, are a terrace: in feet too, of which they are 984. The model is 40 m long.
    let step = 300.0 * metre;
    let levels: Vec<f64> = (0..25).map(|at| if at < 15 { 0.0 } else { step }).collect();
    let spacing = DVec2::splat(7.0 * metre);
    assert_eq!(Posts { heights: &levels, columns: 5, spacing, metre }.constant(), None);
    let levels: Vec<f64> = levels.iter().map(|height| 2.0 * height).collect();
    let found = Posts { heights: &levels, columns: 5, spacing, metre }.constant().unwrap();
    assert_eq!((found.height, found.count), (2.0 * step, 10));
}

#[test]
fn shares_and_counts_hold_at_their_limits() {
    // Two rows 1 m apart: a step of some 11 m is no ground.
    let of = |heights: &[f64]| {
        Posts { heights, columns: heights.len() / 2, spacing: DVec2::ONE, metre: 1.0 }.constant()
    };
    // 18 of 20 posts at one height are a level, and two posts 100 m above them another one: a terrace.
    let mut terrace = vec![0.0; 18];
    terrace.extend([0.5, 1.0, 100.0, 100.0]);
    assert_eq!(of(&terrace), None);
    // 17 of 20 are none.
    terrace[17] = 1.5;
    assert_eq!(of(&terrace).map(|found| (found.height, found.count)), Some((100.0, 2)));
    // As many posts near a height as three times its own are heights like it; one less are not.
    let mut few: Vec<f64> = (0..20).map(|at| f64::from(at) / 10.0).collect();
    few.extend([100.0, 100.0, 103.0, 104.0, 105.0, 106.0]);
    assert_eq!(of(&few), None);
    few[25] = 20.0;
    assert_eq!(of(&few).map(|found| (found.height, found.count)), Some((100.0, 2)));
}

#[test]
fn mixtures_reach_three_posts_from_their_constant() {
    let near = |columns: usize, at: usize, constant: usize| {
        let mut heights = vec![10.0; columns * 2];
        heights[at] = -7.0;
        heights[constant] = -9.0;
        let found = Posts { heights: &heights, columns, spacing: DVec2::ONE, metre: 1.0 };
        found.others_are_near(-9.0, |height| height < 0.0)
    };
    for (at, constant, is_near) in [(0, 3, true), (0, 4, false), (5, 2, true), (5, 1, false)] {
        assert_eq!(near(8, at, constant), is_near, "{at} {constant}");
    }
    // Along the columns: 2 columns would be 2 posts wide, so rows are tried by a single wide row below another.
    let down = |row: usize, constant: usize| {
        let mut heights = vec![10.0; 2 * 8];
        heights[2 * row] = -7.0;
        heights[2 * constant] = -9.0;
        let found = Posts { heights: &heights, columns: 2, spacing: DVec2::ONE, metre: 1.0 };
        found.others_are_near(-9.0, |height| height < 0.0)
    };
    for (row, constant, is_near) in [(0, 3, true), (0, 4, false), (7, 4, true), (7, 3, false)] {
        assert_eq!(down(row, constant), is_near, "{row} {constant}");
    }
}

#[test]
fn the_half_beside_a_constant_has_a_cell_or_is_no_ground() {
    // A row of -60 with mixtures of it and the ground, and rows of ground, half a metre or a metre from post to post.
    let of = |rows: usize| {
        let mut heights = vec![-60.0; 30];
        heights[10..13].copy_from_slice(&[-50.0, -40.0, -20.0]);
        heights.extend((0..30 * rows).map(|at| at as f64 / rows as f64));
        Posts { heights: &heights, columns: 30, spacing: DVec2::ONE, metre: 1.0 }.constant()
    };
    assert_eq!(of(2).map(|found| (found.height, found.count, found.is_below)), Some((-60.0, 27, true)));
    // One row of either: as well a wall as a constant.
    assert_eq!(of(1), None);
}
