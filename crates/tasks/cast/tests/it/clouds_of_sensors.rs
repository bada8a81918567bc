//! Mistakes of clouds that come from how sensors count, limit and number: steps of ranges, ends of ranges, clocks, channels. Each is told with its
//! true size, and what is not it is not told.

use glam::DVec3;
use raypencil_cast::{CandidateConventions, CloudFrame};
use raypencil_scene::pattern::{Channel, Spinning};
use raypencil_scene::{CastRay, Precision};

use super::cloud_trial::{Fields, Point, Trial, bend, expect, head, of_frame, points, set_of, still};

const SENSOR: CloudFrame = CloudFrame::Sensor;

/// The points of rays that have other lengths, and none where the length is none.
fn with_lengths(trial: &Trial, length: &dyn Fn(f64) -> f64) -> Vec<Point> {
    let asked = head().rays("rays").expect("rays").rays;
    let along = |(one, ray): (&Point, &CastRay)| {
        let range = length(one.range);
        Point { place: ray.origin + ray.direction * range, range, ..*one }
    };
    points(&trial.set, SENSOR).iter().zip(&asked).map(along).collect()
}

/// A number between -1 and 1 that follows from another one's bits.
fn noise(of: f64) -> f64 {
    let bits = of.to_bits().wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 11;
    2.0 * (bits as f64 / (1_u64 << 53) as f64) - 1.0
}

fn rounded_to(step: f64) -> impl Fn(f64) -> f64 {
    move |length| (length / step).round() * step
}

#[test]
fn steps_of_ranges_are_told_with_their_size() {
    for mounting in [still(), bend()] {
        let trial = Trial::new(&head(), &mounting);
        for (step, words) in [
            (0.002, "if ranges are rounded to multiples of 0.002"),
            (0.004, "if ranges are rounded to multiples of 0.004"),
            (0.05, "if ranges are rounded to multiples of 0.05"),
            (1.0 / 256.0, "if ranges are rounded to multiples of 0.00390625"),
        ] {
            trial.expect_why(&with_lengths(&trial, &rounded_to(step)), Fields::None, SENSOR, words);
            // The field has the same numbers.
            trial.expect_why(&with_lengths(&trial, &rounded_to(step)), Fields::Range, SENSOR, words);
        }
        let cut = with_lengths(&trial, &|length| libm::floor(length / 0.002) * 0.002);
        trial.expect_why(&cut, Fields::None, SENSOR, "if ranges are cut to multiples of 0.002");
    }
    let trial = Trial::new(&head(), &still());
    let right = points(&trial.set, SENSOR);
    let of_coordinates: Vec<Point> = right
        .iter()
        .map(|one| Point { place: DVec3::from_array(one.place.to_array().map(rounded_to(0.001))), ..*one })
        .collect();
    trial.expect_why(
        &of_coordinates,
        Fields::None,
        SENSOR,
        "if x, y and z are rounded to multiples of 0.001",
    );
    let of_field: Vec<Point> =
        right.iter().map(|one| Point { range: rounded_to(0.004)(one.range), ..*one }).collect();
    trial.expect_why(&of_field, Fields::Range, SENSOR, "if the field range is rounded to multiples of 0.004");
}

#[test]
fn noise_of_the_size_of_a_step_is_no_step() {
    let trial = Trial::new(&head(), &still());
    let noisy = with_lengths(&trial, &|length| length + 0.001 * noise(length));
    let checked = trial.judge(&noisy, Fields::None, SENSOR);
    assert!(!checked.passes());
    assert_eq!(checked.why, None);
    // A step of 2 mm, and ranges that are wrong by one in a thousand beside it.
    let both = with_lengths(&trial, &|length| rounded_to(0.002)(length * 1.003));
    assert_eq!(trial.judge(&both, Fields::None, SENSOR).why, None);
}

#[test]
fn a_range_without_a_point_is_wrong_unless_it_is_none() {
    let trial = Trial::new(&head(), &still());
    let right = points(&trial.set, SENSOR);
    let is_miss = |one: &Point| !one.place.is_finite();
    let with = |range: f64| -> Vec<Point> {
        right
            .iter()
            .map(|one| Point { range: if is_miss(one) { range } else { one.range }, ..*one })
            .collect()
    };
    let misses = right.iter().filter(|one| is_miss(one)).count() as u64;
    assert!(misses > 10);
    for none in [f64::NAN, f64::INFINITY] {
        assert!(trial.judge(&with(none), Fields::Range, SENSOR).passes());
    }
    for range in [0.0, 5.0] {
        let checked = trial.judge(&with(range), Fields::Range, SENSOR);
        assert_eq!((checked.passes(), checked.comparison.counts().wrong), (false, misses));
        let words = format!("if {range} in the field range means no hit: declare --miss {range}");
        expect(&checked, &words);
    }
}

/// Rays of the head in the pattern's frame, with the point of each where it meets something.
fn with_misses_at(trial: &Trial, distance: f64, farthest: f64) -> Vec<Point> {
    let asked = head().rays("rays").expect("rays").rays;
    let along = |(one, ray): (&Point, &CastRay)| {
        let is_there = one.range <= farthest;
        if is_there {
            *one
        } else {
            Point { place: ray.origin + ray.direction * distance, range: distance, ..*one }
        }
    };
    points(&trial.set, SENSOR).iter().zip(&asked).map(along).collect()
}

#[test]
fn misses_with_a_point_are_told() {
    // The longest range of the head is 100 m.
    for mounting in [still(), bend()] {
        let trial = Trial::new(&head(), &mounting);
        for fields in [Fields::None, Fields::Keys, Fields::Range] {
            let of = |distance, farthest| with_misses_at(&trial, distance, farthest);
            trial.expect_why(
                &of(100.0, 100.0),
                fields,
                SENSOR,
                "if rays that meet nothing have a point at the longest range, 100: they have none",
            );
            trial.expect_why(&of(130.0, 100.0), fields, SENSOR, "have a point at 130: they have none");
            trial.expect_why(
                &of(9.5, 9.5),
                fields,
                SENSOR,
                "if rays that meet nothing before 9.5 have a point there: they have none, and the sensor's longest range is 100",
            );
        }
    }
}

#[test]
fn other_ends_of_ranges_are_told() {
    for mounting in [still(), bend()] {
        let trial = Trial::new(&head(), &mounting);
        let right = points(&trial.set, SENSOR);
        let kept = |is_kept: &dyn Fn(f64) -> bool| -> Vec<Point> {
            let of = |one: &Point| match is_kept(one.range) {
                true => *one,
                false => Point { place: DVec3::NAN, range: f64::NAN, ..*one },
            };
            right.iter().map(of).collect()
        };
        trial.expect_why(&kept(&|range| range <= 9.0), Fields::None, SENSOR, "if points end at 9, or at any");
        trial.expect_why(
            &kept(&|range| range >= 4.0),
            Fields::None,
            SENSOR,
            "if points begin at 4, or at any",
        );
    }
    // Points that are missing here and there are not beyond any range.
    let trial = Trial::new(&head(), &still());
    let mut some = points(&trial.set, SENSOR);
    some.iter_mut().filter(|one| noise(one.range) > 0.5).for_each(|one| one.place = DVec3::NAN);
    assert_eq!(trial.judge(&some, Fields::None, SENSOR).why, None);
    // A head that looks 8 m far, and a simulator that looks on to 10 m.
    let short = Spinning { max_range_m: 8.0, ..head() };
    let trial = Trial::new(&short, &still());
    let longer = points(&set_of(&Spinning { max_range_m: 10.0, ..head() }, &still()), SENSOR);
    trial.expect_why(&longer, Fields::None, SENSOR, "if points end at 10, or at any");
    // The end is told with its true size: 10 lies between what is seen and what is not.
    let why = trial.judge(&longer, Fields::None, SENSOR).why.expect("a reason");
    let between: Vec<f64> = why.split([' ', ':']).filter_map(|word| word.parse().ok()).collect();
    assert!(why.contains("the sensor's longest range is 8"), "{why}");
    assert!(between.iter().any(|low| (9.5..=10.0001).contains(low)), "{why}");
}

#[test]
fn a_sensor_without_a_longest_range_is_told_as_such() {
    let endless = Spinning { max_range_m: f64::INFINITY, ..head() };
    let trial = Trial::new(&endless, &still());
    let of_misses = with_misses_at(&trial, 120.0, 120.0);
    let words = "if rays that meet nothing before 120 have a point there: they have none, and the sensor has no longest range";
    trial.expect_why(&of_misses, Fields::None, SENSOR, words);
}

#[track_caller]
fn dense_and_organised(trial: &Trial, points: &[Point], words: &str) {
    for checked in
        [trial.judge(points, Fields::Keys, SENSOR), trial.judge_dense(points, Fields::Keys, SENSOR)]
    {
        expect(&checked, words);
    }
}

#[test]
fn clocks_of_other_units_and_of_whole_sequences_are_told() {
    let trial = Trial::new(&head(), &bend());
    let right = points(&trial.set, SENSOR);
    let with = |time: &dyn Fn(usize, f64) -> f64| -> Vec<Point> {
        right.iter().enumerate().map(|(k, one)| Point { time: time(k, one.time), ..*one }).collect()
    };
    for (factor, words) in [
        (1e9, "if the field time is in nanoseconds: it counts seconds"),
        (1e6, "if the field time is in microseconds: it counts seconds"),
        (1e3, "if the field time is in milliseconds: it counts seconds"),
    ] {
        dense_and_organised(&trial, &with(&|_, time| time * factor), words);
    }
    // From the last ray of the scan on, in nanoseconds.
    let last = right.iter().map(|one| one.time).fold(0.0, f64::max);
    let both = "the field time is in nanoseconds: it counts seconds, and the times of the points are 0.0956 s too early";
    dense_and_organised(&trial, &with(&|_, time| (time - last) * 1e9), both);
    let of_sequence = |k: usize, _: f64| right[k / 16 * 16].time;
    dense_and_organised(
        &trial,
        &with(&of_sequence),
        "if all points of a firing sequence have the time of its first ray: each has that of its own firing",
    );
    dense_and_organised(
        &trial,
        &with(&|_, _| 0.0),
        "if all points have the same time, 0: each has that of its own firing",
    );
    // In the mesh's frame nothing tells the rays of a moving sensor: the refusal says what the times are.
    let of_mesh: Vec<Point> = points(&trial.set, CloudFrame::Mesh)
        .into_iter()
        .filter(|one| one.place.is_finite())
        .map(|one| Point { time: 0.25, ..one })
        .collect();
    let file = trial.write(&of_mesh, Fields::Keys, [of_mesh.len(), 1]);
    let refused = trial.check(&file, CandidateConventions::default()).expect_err("a refusal");
    assert!(refused.contains("or share one; all have the same time, 0.25; expected the fields"), "{refused}");
}

#[test]
fn two_channels_that_are_exchanged_are_told() {
    // Channels 3 and 10 of a VLP-16 look 3 degrees up and 5 degrees down: rings 9 and 5.
    for mounting in [still(), bend()] {
        let trial = Trial::new(&head(), &mounting);
        let right = points(&trial.set, SENSOR);
        let other = |ring: u16| {
            if ring == 9 {
                5
            } else if ring == 5 {
                9
            } else {
                ring
            }
        };
        let of_rings: Vec<Point> = right.iter().map(|one| Point { ring: other(one.ring), ..*one }).collect();
        dense_and_organised(
            &trial,
            &of_rings,
            "if channels 3 and 10, counted from 0 in the order of the manual, have each other's number",
        );
        let exchanged = |k: usize| match k % 16 {
            3 => k - 3 + 10,
            10 => k - 10 + 3,
            _ => k,
        };
        let of_points: Vec<Point> = (0..right.len()).map(|k| right[exchanged(k)]).collect();
        trial.expect_why(
            &of_points,
            Fields::None,
            SENSOR,
            "if the points of channels 3 and 10, counted from 0",
        );
        let mut wrong = head();
        let (a, b) = (wrong.channels[3], wrong.channels[10]);
        wrong.channels[3] = Channel { firing_s: a.firing_s, ..b };
        wrong.channels[10] = Channel { firing_s: b.firing_s, ..a };
        let of_angles = points(&set_of(&wrong, &mounting), SENSOR);
        let of_angles: Vec<Point> =
            of_angles.iter().zip(&right).map(|(one, right)| Point { ring: right.ring, ..*one }).collect();
        let words =
            "if channels 3 and 10, counted from 0 in the order of the manual, look where the other should";
        trial.expect_why(&of_angles, Fields::None, SENSOR, words);
        trial.expect_why(&of_angles, Fields::Keys, SENSOR, words);
    }
}

/// What a program in single precision computes: nothing but its precision is told of it.
#[test]
fn honest_arithmetic_of_single_precision_is_told_as_nothing_else() {
    for mounting in [still(), bend()] {
        let trial = Trial::new(&head(), &mounting);
        let right = points(&trial.set, SENSOR);
        let asked = head().rays("rays").expect("rays").rays;
        let single = |v: DVec3| v.to_array().map(|part| part as f32);
        let computed = |(one, ray): (&Point, &CastRay)| {
            let (origin, direction, range) = (single(ray.origin), single(ray.direction), one.range as f32);
            let place = [0, 1, 2].map(|k| f64::from(origin[k] + direction[k] * range));
            Point { place: DVec3::from_array(place), range: f64::from(range), ..*one }
        };
        let points: Vec<Point> = right.iter().zip(&asked).map(computed).collect();
        for fields in [Fields::None, Fields::Keys, Fields::Range] {
            let checked = trial.judge(&points, fields, SENSOR);
            assert!(!checked.passes());
            let why = checked.why.as_deref().unwrap_or("no reason");
            assert!(why.ends_with("if arithmetic is of single precision: declare --arithmetic f32"), "{why}");
            let file = trial.write(&points, fields, [16, points.len() / 16]);
            let single = trial.check_of(&file, Precision::F32, of_frame(SENSOR)).expect("a check");
            assert!(single.passes() && single.why.is_none(), "{:?}", single.why);
        }
    }
}
