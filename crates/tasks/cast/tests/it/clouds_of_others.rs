//! Point clouds of other simulators against a pack of a scan: honest ones pass, wrong ones are told their mistake.

use std::path::Path;

use glam::DVec3;
use raypencil_cast::{
    CandidateConventions, CastSource, CloudChoice, CloudConventions, CloudFrame, Questions, cast,
    check_ray_pack, stated_points, write_scan_pack,
};
use raypencil_rosbag::{BagWriter, PointCloud2, PointField, Stamp, Topic};
use raypencil_scene::pattern::{Mounting, Spinning};
use raypencil_scene::{CastRay, NamedRaySet, Pose, Precision, RaySet, Sides, Silent, Triangles};

use super::cloud_trial::{Fields, Point, Trial, bend, expect, head, points, room, set_of, still};

/// The rays of another head or mounting, in the place of those of a set.
fn fired(set: &NamedRaySet, ray: impl Fn(usize, &CastRay) -> CastRay) -> NamedRaySet {
    let rays = set.set.rays().iter().enumerate().map(|(index, asked)| ray(index, asked)).collect();
    NamedRaySet { set: RaySet::new(rays, Sides::Both).expect("rays"), ..set.clone() }
}

#[test]
fn an_honest_simulator_of_single_precision_storage_passes_in_each_frame_and_by_each_key() {
    for mounting in [still(), bend()] {
        let trial = Trial::new(&head(), &mounting);
        for frame in CloudFrame::ALL {
            let points = points(&trial.set, frame);
            assert!(points.iter().any(|point| point.place.is_nan()), "some rays miss");
            for (fields, by) in [
                (Fields::None, "by the order of the points"),
                (Fields::Range, "by the order of the points"),
                (Fields::Keys, "by ring and time"),
            ] {
                let checked = trial.judge(&points, fields, frame);
                assert!(checked.passes(), "{frame:?} {fields:?}: {:?}", checked.why);
                assert_eq!(checked.cloud.expect("a cloud").assigned, by);
            }
            assert!(trial.judge_dense(&points, Fields::Keys, frame).passes());
        }
        let of_sensor = points(&trial.set, CloudFrame::Sensor);
        let checked = trial.judge_dense(&of_sensor, Fields::None, CloudFrame::Sensor);
        assert!(checked.passes());
        assert_eq!(checked.cloud.expect("a cloud").assigned, "by direction");
    }
}

#[test]
fn storage_is_excused_by_half_a_unit_and_no_more() {
    let trial = Trial::new(&head(), &still());
    let right = points(&trial.set, CloudFrame::Sensor);
    // One unit of single precision along x is twice what rounding does: 2^-20 m from 8 m on.
    let far = right.iter().position(|point| point.place.x > 8.0).expect("a far point");
    let mut moved = right.clone();
    moved[far].place.x = f64::from((right[far].place.x as f32).next_up().next_up());
    let checked = trial.judge(&moved, Fields::None, CloudFrame::Sensor);
    assert_eq!(checked.comparison.wrong().map(|(index, _)| index).collect::<Vec<_>>(), [far]);
}

#[test]
fn on_a_plane_points_are_those_of_the_closed_form() {
    // A floor at z = 0, and a head 2 m above it: a channel of elevation -e meets it at the level distance 2 / tan e.
    let corners = [[-500.0, -500.0, 0.0], [500.0, -500.0, 0.0], [500.0, 500.0, 0.0], [-500.0, 500.0, 0.0]];
    let floor = Triangles::new(corners.to_vec(), vec![[0, 1, 2], [0, 2, 3]]).expect("a floor");
    let mut head = head();
    head.channels.iter_mut().for_each(|channel| channel.vertical_m = 0.0);
    head.max_range_m = 400.0;
    let set = set_of(&head, &Mounting::Fixed(Pose::from_position(DVec3::Z * 2.0)));
    let folder = tempfile::tempdir().expect("a folder");
    let pack = folder.path().join("pack");
    write_scan_pack(&pack, (&floor, &set, Sides::Both), &CastSource::default(), &Silent).expect("a pack");
    let mut text = String::from("ply\nformat ascii 1.0\nelement vertex 1920\n");
    text += "property double x\nproperty double y\nproperty double z\nend_header\n";
    for step in 0..head.steps {
        for channel in &head.channels {
            let azimuth = (25.0 - 3.0 * (step as f64 + channel.firing_s / 8e-4)).to_radians();
            let level = 2.0 / libm::tan(-channel.elevation_deg.to_radians());
            if channel.elevation_deg < 0.0 && level < 390.0 {
                text += &format!("{:.6} {:.6} 0.0\n", level * libm::cos(azimuth), level * libm::sin(azimuth));
            } else {
                text += "nan nan nan\n";
            }
        }
    }
    let check = |text: &str| {
        let file = folder.path().join("closed.ply");
        std::fs::write(&file, text).expect("a file");
        check_ray_pack(&pack, &file, Precision::F64, CandidateConventions::default(), &Silent)
            .expect("a check")
    };
    let checked = check(&text);
    assert!(checked.passes(), "{:?}", checked.why);
    assert_eq!(checked.comparison.met, 960);
    // z has one decimal: 0.2 is beyond its half unit, 0.0 is not.
    let wrong = check(&text.replacen(" 0.0\n", " 0.2\n", 1)).comparison;
    assert_eq!(wrong.counts().wrong, 1);
}

#[test]
fn frames_and_axes_are_told() {
    let trial = Trial::new(&head(), &bend());
    let of = |frame| points(&trial.set, frame);
    let mesh = CloudFrame::Mesh;
    trial.expect_why(
        &of(CloudFrame::Sensor),
        Fields::None,
        mesh,
        "the sensor, at the time of each ray: declare --frame sensor",
    );
    let [start, end] = [CloudFrame::SensorAtStart, CloudFrame::SensorAtEnd];
    trial.expect_why(&of(start), Fields::None, mesh, "declare --frame start");
    trial.expect_why(&of(end), Fields::None, mesh, "declare --frame end");
    trial.expect_why(
        &of(end),
        Fields::Keys,
        start,
        "the sensor, at the time of the last ray: declare --frame end",
    );
    trial.expect_why(&of(start), Fields::Keys, end, "at the time of the first ray: declare --frame start");
    trial.expect_why(
        &of(mesh),
        Fields::None,
        CloudFrame::Sensor,
        "the frame of the mesh: declare --frame mesh",
    );
    let turned = |change: fn(DVec3) -> DVec3| -> Vec<Point> {
        of(CloudFrame::Sensor).into_iter().map(|one| Point { place: change(one.place), ..one }).collect()
    };
    let sensor = CloudFrame::Sensor;
    trial.expect_why(&turned(|p| DVec3::new(p.y, p.x, p.z)), Fields::None, sensor, "hold y, x, z");
    trial.expect_why(&turned(|p| DVec3::new(-p.y, -p.z, p.x)), Fields::None, sensor, "hold -y, -z, x");
    trial.expect_why(&turned(|p| p * 1000.0), Fields::None, sensor, "thousandths");
    // Both at once.
    trial.expect_why(&turned(|p| DVec3::new(p.x, -p.y, p.z)), Fields::None, mesh, "hold x, -y, z");
    // Only x, y and z are placed, by the pose of the start or of the end.
    let poses = trial.set.mounting.ends(trial.set.times.as_deref());
    for (pose, which) in poses.into_iter().zip(["start", "end"]) {
        let placed =
            of(sensor).into_iter().map(|one| Point { place: pose * one.place, ..one }).collect::<Vec<_>>();
        let words = format!("by the sensor's pose at the {which} of the scan");
        trial.expect_why(&placed, Fields::None, mesh, &words);
    }
}

#[test]
fn rings_and_orders_are_told() {
    let trial = Trial::new(&head(), &still());
    let right = points(&trial.set, CloudFrame::Mesh);
    let with = |ring: fn(usize, u16) -> u16| -> Vec<Point> {
        right.iter().enumerate().map(|(k, one)| Point { ring: ring(k, one.ring), ..*one }).collect()
    };
    let mesh = CloudFrame::Mesh;
    trial.expect_why(&with(|_, ring| 15 - ring), Fields::Keys, mesh, "ring counts channels from above");
    trial.expect_why(
        &with(|k, _| (k % 16) as u16),
        Fields::Keys,
        mesh,
        "ring is the channel in the order of the manual",
    );
    // Times that count back from the end, with order and without it.
    let times = trial.set.times.as_ref().expect("times");
    let end = times[times.len() - 1];
    let back: Vec<Point> = right.iter().map(|one| Point { time: one.time - end, ..*one }).collect();
    // 0.09561472 s, to within a quarter of the 0.8 ms from one firing to the next.
    let early = "the times of the points are 0.0956 s too early";
    trial.expect_why(&back, Fields::Keys, mesh, early);
    let checked = trial.judge_dense(&back, Fields::Keys, mesh);
    assert_eq!((checked.passes(), checked.comparison.counts().wrong), (false, 0));
    assert!(checked.why.as_deref().is_some_and(|why| why.contains(early)), "{:?}", checked.why);
    let reversed: Vec<Point> = (0..right.len()).map(|k| right[k / 16 * 16 + 15 - k % 16]).collect();
    trial.expect_why(&reversed, Fields::None, mesh, "in the opposite order");
    // Of a head that stands still a late point cannot be told from a late head.
    let moving = Trial::new(&head(), &bend());
    let of_bend = points(&moving.set, mesh);
    let none = Point { place: DVec3::NAN, ..of_bend[0] };
    let late: Vec<Point> =
        (0..right.len()).map(|k| k.checked_sub(16).map_or(none, |before| of_bend[before])).collect();
    let checked = moving.judge(&late, Fields::None, mesh);
    assert!(
        checked.why.as_deref().is_some_and(|why| why.contains("one firing sequence late")),
        "{:?}",
        checked.why
    );
    let rows: Vec<Point> = (0..right.len()).map(|k| right[k % 120 * 16 + k / 120]).collect();
    let file = trial.write(&rows, Fields::None, [120, 16]);
    let checked = trial.check(&file, CandidateConventions::default()).expect("a check");
    assert!(checked.passes(), "{:?}", checked.why);
    // Rows and points of a row from the last to the first.
    for (words, ray) in [
        (
            "rows of points run from the last to the first",
            (|k| (119 - k / 16) * 16 + k % 16) as fn(usize) -> usize,
        ),
        ("all points run from the last to the first", |k| 1919 - k),
    ] {
        let other: Vec<Point> = (0..right.len()).map(|k| right[ray(k)]).collect();
        trial.expect_why(&other, Fields::None, mesh, words);
    }
    // The same rows in a file that claims no order.
    let file = trial.write(&rows, Fields::None, [right.len(), 1]);
    let why = trial.check(&file, CandidateConventions::default()).expect("a check").why;
    assert!(why.as_deref().is_some_and(|why| why.contains("rows of one channel")), "{why:?}");
}

#[test]
fn a_head_that_turns_otherwise_is_told() {
    let other = |change: fn(&mut Spinning)| {
        let mut head = head();
        change(&mut head);
        head
    };
    for (mounting, frame) in [(still(), CloudFrame::Mesh), (bend(), CloudFrame::Sensor)] {
        let trial = Trial::new(&head(), &mounting);
        let of = |head: &Spinning| points(&set_of(head, &mounting), frame);
        let expect = |change: fn(&mut Spinning), words: &str| {
            trial.expect_why(&of(&other(change)), Fields::None, frame, words);
        };
        expect(|head| head.azimuth_step_deg = 3.0, "turns the other way: it turns to the right, clockwise");
        expect(|head| head.azimuth_start_deg = -65.0, "begins 90 degrees to the right");
        expect(|head| head.azimuth_start_deg = 25.75, "begins 0.75 degrees to the left");
        expect(|head| head.azimuth_start_deg = 28.0, "one azimuth step late");
        expect(
            |head| head.channels.iter_mut().for_each(|one| one.vertical_m = 0.0),
            "offsets of the emitters are left out",
        );
    }
    // The range of the ray that is fired, laid on from the middle of the head.
    for mounting in [still(), bend()] {
        let trial = Trial::new(&head(), &mounting);
        let times = trial.set.times.as_ref().expect("times");
        let mut points = points(&trial.set, CloudFrame::Sensor);
        for ((point, ray), time) in points.iter_mut().zip(trial.set.set.rays()).zip(times) {
            point.place -= mounting.at(*time).expect("a pose").inverse() * ray.origin;
        }
        let words = "if points are the range along their ray from the sensor's origin: the offsets of the emitters are left out";
        trial.expect_why(&points, Fields::Keys, CloudFrame::Sensor, words);
        // Half of them have no words: a unit and a factor that take each other back move points by the rest of the offset.
        for ((point, ray), time) in points.iter_mut().zip(trial.set.set.rays()).zip(times) {
            point.place += 0.5 * (mounting.at(*time).expect("a pose").inverse() * ray.origin);
        }
        let checked = trial.judge(&points, Fields::Keys, CloudFrame::Sensor);
        assert!(!checked.passes() && checked.why.is_none(), "{:?}", checked.why);
    }
    // A head that fires all at once: the sensor stands still, so that its times tell nothing else.
    let mounting = still();
    let trial = Trial::new(&head(), &mounting);
    let at_once = other(|head| head.channels.iter_mut().for_each(|one| one.firing_s = 0.0));
    trial.expect_why(
        &points(&set_of(&at_once, &mounting), CloudFrame::Mesh),
        Fields::None,
        CloudFrame::Mesh,
        "stands still during a firing",
    );
}

#[test]
fn poses_of_other_times_are_told() {
    let mounting = bend();
    let trial = Trial::new(&head(), &mounting);
    let asked = head().rays("rays").expect("rays");
    let times = asked.times.clone().expect("times");
    let at = |time: f64| mounting.at(time).expect("a pose");
    let with = |pose: &dyn Fn(usize) -> Pose| {
        let set = fired(&trial.set, |index, _| {
            let (pose, ray) = (pose(index), asked.rays[index]);
            CastRay { origin: pose * ray.origin, direction: pose.rotate(ray.direction), ..ray }
        });
        let placed = points(&set, CloudFrame::Mesh);
        let sensor: Vec<Point> = placed
            .iter()
            .enumerate()
            .map(|(k, one)| Point { place: pose(k).inverse() * one.place, ..*one })
            .collect();
        [(placed, CloudFrame::Mesh), (sensor, CloudFrame::Sensor)]
    };
    for (points, frame) in with(&|_| at(0.0)) {
        trial.expect_why(&points, Fields::None, frame, "the pose of the scan's start is taken for all rays");
    }
    for (points, frame) in with(&|index| at(times[index] + 0.005)) {
        trial.expect_why(&points, Fields::None, frame, "poses are those of 0.005 s later");
    }
    for (points, frame) in with(&|index| at(libm::floor(times[index] / 0.025) * 0.025)) {
        trial.expect_why(&points, Fields::None, frame, "poses are held until the next one");
    }
}

#[test]
fn lengths_that_are_no_ranges_are_told() {
    let trial = Trial::new(&head(), &still());
    let sensor = CloudFrame::Sensor;
    let right = points(&trial.set, sensor);
    let asked = head().rays("rays").expect("rays").rays;
    let with = |length: &dyn Fn(f64, DVec3) -> f64| -> Vec<Point> {
        let along = |(one, ray): (&Point, &CastRay)| Point {
            place: ray.origin + ray.direction * length(one.range, ray.direction),
            ..*one
        };
        right.iter().zip(&asked).map(along).collect()
    };
    let level = |direction: DVec3| libm::hypot(direction.x, direction.y);
    trial.expect_why(
        &with(&|range, d| range * level(d)),
        Fields::None,
        sensor,
        "points stand at the level distance",
    );
    trial.expect_why(
        &with(&|range, d| range / level(d)),
        Fields::None,
        sensor,
        "range is taken for the level distance",
    );
    trial.expect_why(&with(&|range, _| range + 0.03), Fields::None, sensor, "ranges are 0.03 too long");
    trial.expect_why(
        &with(&|range, _| range * 1.002),
        Fields::None,
        sensor,
        "ranges are 1.002 times what they are",
    );
    let in_field: Vec<Point> = right
        .iter()
        .zip(&asked)
        .map(|(one, ray)| Point { range: one.range * level(ray.direction), ..*one })
        .collect();
    trial.expect_why(&in_field, Fields::Range, sensor, "the field range holds the level distance");
    // The field alone, beside points that are right.
    let field = |change: fn(f64) -> f64| -> Vec<Point> {
        right.iter().map(|one| Point { range: change(one.range), ..*one }).collect()
    };
    for (change, words) in [
        (
            (|range| range * 1000.0) as fn(f64) -> f64,
            "agree if the field range is in thousandths of the mesh's unit",
        ),
        (|range| range / 0.3048, "agree if the field range is in feet"),
        (|range| range * 1.01, "agree if the field range is 1.01 times what it is"),
        (|range| range + 0.5, "agree if the field range is 0.5 too long"),
    ] {
        trial.expect_why(&field(change), Fields::Range, sensor, words);
    }
}

#[test]
fn depth_in_place_of_range_is_told_of_a_grid() {
    use raypencil_scene::pattern::{Grid, Spacing};
    let grid = Grid {
        columns: 32,
        rows: 24,
        width_deg: 70.0,
        height_deg: 50.0,
        spacing: Spacing::Tangent,
        min_range_m: 0.0,
        max_range_m: f64::INFINITY,
    };
    let mounting = still();
    let rays = mounting.place(grid.rays("grid").expect("rays"), "grid").expect("a pose");
    let set = NamedRaySet::new("grid", rays, Sides::Both).expect("a set");
    let folder = tempfile::tempdir().expect("a folder");
    let source = CastSource::default();
    write_scan_pack(&folder.path().join("pack"), (&room(), &set, Sides::Both), &source, &Silent)
        .expect("a pack");
    let trial = Trial { folder, set };
    let answers = cast(&room(), trial.set.set.rays(), Sides::Both, Questions::default(), &Silent);
    let pattern = grid.rays("grid").expect("rays").rays;
    let points = |length: &dyn Fn(f64, f64) -> f64| -> Vec<Point> {
        let one = |(read, ray): (&raypencil_scene::Reading<raypencil_cast::FirstHit>, &CastRay)| {
            let range = read.hit().map_or(f64::NAN, |hit| hit.range);
            let place = ray.direction * length(range, ray.direction.x);
            Point { place, ring: 0, time: 0.0, range }
        };
        answers.first.iter().zip(&pattern).map(one).collect()
    };
    assert!(trial.judge(&points(&|range, _| range), Fields::None, CloudFrame::Sensor).passes());
    trial.expect_why(
        &points(&|range, cos| range * cos),
        Fields::None,
        CloudFrame::Sensor,
        "points stand at the depth",
    );
}

#[test]
fn missing_invented_and_stray_points_are_counted() {
    let trial = Trial::new(&head(), &still());
    let right = points(&trial.set, CloudFrame::Mesh);
    let hit = right.iter().position(|one| one.place.is_finite()).expect("a hit");
    let miss = right.iter().position(|one| one.place.is_nan()).expect("a miss");
    let mut changed = right.clone();
    changed[hit].place = DVec3::NAN;
    changed[miss].place = DVec3::new(3.0, -20.0, 1.0);
    let checked = trial.judge(&changed, Fields::Keys, CloudFrame::Mesh);
    assert_eq!(checked.comparison.counts().wrong, 2);
    let text = checked.document().screen();
    assert!(
        text.contains("1 ray without a point that should have one; 1 point where nothing is measured"),
        "{text}"
    );
    // A point twice, and one of a channel that is none: right rays, and two points too many.
    let mut more: Vec<Point> = right.iter().copied().filter(|one| one.place.is_finite()).collect();
    let first = more[0];
    more.extend([first, Point { ring: 77, ..first }]);
    let checked = trial.judge_dense(&more, Fields::Keys, CloudFrame::Mesh);
    assert_eq!(checked.comparison.counts().wrong, 0);
    assert!(!checked.passes());
    assert_eq!(checked.cloud.as_ref().expect("a cloud").strays.len(), 2);
    let document = checked.document();
    assert!(
        document.screen().contains("✗ 2 points are of no ray, or of one that has another."),
        "{}",
        document.screen()
    );
    assert_eq!(document.verdict, "defects");
    let junit = document.junit().expect("test results");
    assert!(
        junit.contains("failures=\"1\"") && junit.contains("points of one ray each is wrong on 2 of"),
        "{junit}"
    );
    // Rings of other rays are no pass either, on the screen and for programs.
    let rings: Vec<Point> = right.iter().map(|one| Point { ring: (one.ring + 1) % 16, ..*one }).collect();
    let document = trial.judge(&rings, Fields::Keys, CloudFrame::Mesh).document();
    assert_eq!(document.verdict, "defects");
    // Zeros for misses.
    let zeros: Vec<Point> = right
        .iter()
        .map(|one| if one.place.is_nan() { Point { place: DVec3::ZERO, ..*one } } else { *one })
        .collect();
    trial.expect_why(&zeros, Fields::None, CloudFrame::Mesh, "declare --miss 0");
    let file = trial.write(&zeros, Fields::None, [16, 120]);
    assert!(
        trial
            .check(&file, CandidateConventions { miss: Some(0.0), ..Default::default() })
            .expect("a check")
            .passes()
    );
}

/// A grid that hits everywhere: a plain list of its points has no order that could be wrong.
#[test]
fn a_list_without_an_order_is_held_to_none_and_an_image_is() {
    let few = Spinning { steps: 16, azimuth_start_deg: 60.0, azimuth_step_deg: 2.0, ..head() };
    let level = Pose { position: DVec3::new(1.0, 0.5, 1.5), ..Pose::IDENTITY };
    let trial = Trial::new(&few, &Mounting::Fixed(level));
    let right = points(&trial.set, CloudFrame::Mesh);
    assert!(right.iter().all(|one| one.place.is_finite()));
    let count = right.len();
    let moved = |by: fn(usize) -> usize| -> Vec<Point> { (0..count).map(|k| right[by(k)]).collect() };
    let judged = |points: &[Point], size| {
        let file = trial.write(points, Fields::None, size);
        trial.check(&file, CandidateConventions::default()).expect("a check")
    };
    // 37 and 256 have no common divisor.
    let shuffled = moved(|k| k * 37 % 256);
    let checked = judged(&shuffled, [count, 1]);
    assert!(checked.passes());
    assert_eq!(checked.cloud.as_ref().expect("a cloud").assigned, "by direction");
    assert_eq!(judged(&right, [count, 1]).cloud.expect("a cloud").assigned, "by the order of the points");
    let checked = judged(&shuffled, [16, 16]);
    assert!(!checked.passes());
    let why = checked.why.expect("a reason");
    assert!(why.contains("points are not in the order of the rays"), "{why}");
    // 16 channels and 16 sequences: rows of either are right.
    assert!(judged(&right, [16, 16]).passes());
    let by_channel = judged(&moved(|k| k % 16 * 16 + k / 16), [16, 16]);
    assert!(by_channel.passes(), "{:?}", by_channel.why);
    let why = judged(&moved(|k| (15 - k / 16) * 16 + k % 16), [16, 16]).why.expect("a reason");
    assert!(why.contains("from the last to the first"), "{why}");
    // A mistake of the points themselves is no question of their order.
    let longer: Vec<Point> = right.iter().map(|one| Point { place: one.place + DVec3::Z, ..*one }).collect();
    let checked = judged(&longer, [count, 1]);
    assert!(!checked.passes());
}

#[test]
fn fields_of_other_drivers_are_read_as_they_mean_them() {
    let trial = Trial::new(&head(), &still());
    let right = points(&trial.set, CloudFrame::Mesh);
    let right: Vec<Point> = right.into_iter().filter(|one| one.place.is_finite()).collect();
    let judged = |fields: &str, of: &dyn Fn(&Point) -> String| {
        let mut text = format!(
            "VERSION 0.7\nFIELDS x y z {fields}\nSIZE 8 8 8{}\nTYPE F F F{}\nWIDTH {count}\nHEIGHT 1\nPOINTS {count}\nDATA ascii\n",
            " 8".repeat(fields.split(' ').count()),
            " F".repeat(fields.split(' ').count()),
            count = right.len(),
        );
        for (k, point) in right.iter().enumerate() {
            let [x, y, z] = right[(k + 7) % right.len()].place.to_array();
            let _ = point;
            text += &format!("{x} {y} {z} {}\n", of(&right[(k + 7) % right.len()]));
        }
        let file = trial.folder.path().join("driver.pcd");
        std::fs::write(&file, text).expect("a file");
        trial.check(&file, CandidateConventions::default()).expect("a check")
    };
    let start = trial.set.times.as_ref().expect("times").iter().copied().fold(f64::INFINITY, f64::min);
    let channel = |point: &Point| {
        let elevations = trial.set.elevations_deg.as_ref().expect("a head");
        let rank = |channel: usize| elevations.iter().filter(|other| **other < elevations[channel]).count();
        (0..16).find(|channel| rank(*channel) == usize::from(point.ring)).expect("a channel")
    };
    // Ouster: rings from above, whole nanoseconds of the scan.
    let ouster = judged("ring t", &|one| format!("{} {}", 15 - one.ring, ((one.time - start) * 1e9).round()));
    assert!(ouster.passes(), "{:?}", ouster.document().screen());
    let from_below = judged("ring t", &|one| format!("{} {}", one.ring, ((one.time - start) * 1e9).round()));
    let why = from_below.why.expect("a reason");
    assert!(why.contains("beside Ouster's field t"), "{why}");
    // Livox: the channel as its line, nanoseconds of the clock.
    let livox = judged("tag line timestamp", &|one| format!("16 {} {}", channel(one), one.time * 1e9));
    assert!(livox.passes(), "{:?}", livox.document().screen());
    // Others: seconds of the clock.
    let others = judged("ring timestamp", &|one| format!("{} {}", one.ring, one.time));
    assert!(others.passes(), "{:?}", others.document().screen());
}

#[test]
fn channels_that_are_counted_from_another_number_are_told() {
    for mounting in [still(), bend()] {
        let trial = Trial::new(&head(), &mounting);
        let right = points(&trial.set, CloudFrame::Mesh);
        for from in [1, 100] {
            let words = format!("if the numbers of channels count from {from}: they count from 0");
            let counted: Vec<Point> =
                right.iter().map(|one| Point { ring: one.ring + from, ..*one }).collect();
            for checked in [
                trial.judge_dense(&counted, Fields::Keys, CloudFrame::Mesh),
                trial.judge(&counted, Fields::Keys, CloudFrame::Mesh),
            ] {
                expect(&checked, &words);
                assert_eq!(checked.comparison.counts().wrong, 0);
            }
        }
    }
}

#[test]
fn a_doubled_cloud_is_told_as_such() {
    let trial = Trial::new(&head(), &bend());
    let dense: Vec<Point> =
        points(&trial.set, CloudFrame::Mesh).into_iter().filter(|one| one.place.is_finite()).collect();
    let (count, twice) = (dense.len(), [dense.clone(), dense].concat());
    let file = trial.write(&twice, Fields::Keys, [twice.len(), 1]);
    let message = trial.check(&file, CandidateConventions::default()).expect_err("a refusal");
    let told = format!(
        "{count} of {} points are of a ray that has a point already, up to 2 points for one",
        2 * count
    );
    assert!(message.contains(&told) && message.ends_with("this pack asks for one return"), "{message}");
}

#[test]
fn points_that_no_rule_lays_on_rays_are_refused_with_the_remedy() {
    let trial = Trial::new(&head(), &bend());
    let dense: Vec<Point> =
        points(&trial.set, CloudFrame::Mesh).into_iter().filter(|one| one.place.is_finite()).collect();
    let file = trial.write(&dense, Fields::None, [dense.len(), 1]);
    let message = trial.check(&file, CandidateConventions::default()).expect_err("a refusal");
    assert!(
        message.contains("belong to no ray that is known")
            && message
                .contains("expected the fields `ring` (or `channel`) and `time`, or one point for each ray"),
        "{message}"
    );
    // The fields are there, of other rays: to add them is no remedy.
    let others: Vec<Point> = dense
        .iter()
        .enumerate()
        .map(|(k, one)| Point { time: (k / 7) as f64 * 1e-3, ring: (k % 3) as u16, ..*one })
        .collect();
    let file = trial.write(&others, Fields::Keys, [others.len(), 1]);
    let message = trial.check(&file, CandidateConventions::default()).expect_err("a refusal");
    let expected =
        "expected the fields `ring` (or `channel`) and `time` to be those of the pack's rays, or one point";
    assert!(message.contains(expected), "{message}");
}

/// The pack of plain rays has no times: whatever fields the points have, only their order tells.
#[test]
fn fields_are_no_remedy_where_the_pack_has_no_times() {
    use raypencil_cast::{CastSource, RayArray, write_ray_pack};
    use raypencil_scene::{Sides, Silent};

    let trial = Trial::new(&head(), &still());
    let all = points(&trial.set, CloudFrame::Mesh);
    // Each ray twice: no direction tells them apart.
    let once = trial.set.set.rays().to_vec();
    let rays = RayArray { shape: vec![2 * once.len() as u64], rays: [once.clone(), once].concat() };
    let pack = trial.folder.path().join("plain");
    write_ray_pack(&pack, (&room(), &rays, Sides::Both), &CastSource::default(), &Silent).expect("a pack");
    let dense: Vec<Point> = all.into_iter().filter(|one| one.place.is_finite()).collect();
    let file = trial.write(&dense, Fields::Keys, [dense.len(), 1]);
    let conventions = CandidateConventions::default();
    let refused = check_ray_pack(&pack, &file, Precision::F32, conventions, &Silent).expect_err("a refusal");
    let message = refused.to_string();
    let expected =
        "expected one point for each ray in their order, NaN where there is none: this pack has no times";
    assert!(message.contains(expected), "{message}");
}

/// Points that are printed in whole metres are off by up to half of one: a pass says so, and how many points agree by that alone.
#[test]
fn a_pass_says_in_which_steps_its_points_are_printed() {
    let trial = Trial::new(&head(), &still());
    let all = points(&trial.set, CloudFrame::Mesh);
    let judged = |print: &dyn Fn(f64) -> String| {
        let lines = all.iter().map(|one| one.place.to_array().map(print).join(" ") + "\n");
        let text: String = lines.collect();
        let count = all.len();
        let header = format!(
            "VERSION 0.7\nFIELDS x y z\nSIZE 8 8 8\nTYPE F F F\nWIDTH 16\nHEIGHT {}\nPOINTS {count}\nDATA ascii\n",
            count / 16
        );
        let file = trial.folder.path().join("text.pcd");
        std::fs::write(&file, header + &text).expect("a file");
        let checked = trial.check(&file, CandidateConventions::default()).expect("a check");
        assert!(checked.passes(), "{:?}", checked.why);
        checked.document().screen()
    };
    let metres = judged(&|part| format!("{part:.0}"));
    assert!(metres.contains("1,920 rays agree to steps of 1 m: "), "{metres}");
    assert!(
        metres
            .contains("Its numbers are printed in steps of 1 m and judged as such: errors below half a step"),
        "{metres}"
    );
    assert!(
        metres.contains(" points are further off than arithmetic alone explains, and agree by that."),
        "{metres}"
    );
    let millimetres = judged(&|part| format!("{part:.3}"));
    assert!(millimetres.contains("1,920 rays agree to steps of 0.001 m: "), "{millimetres}");
    // All digits of a double: nothing is excused, and nothing said.
    let full = judged(&|part| format!("{part:?}"));
    assert!(full.contains("agree with the exact answers") && !full.contains("printed"), "{full}");
}

/// A cloud as robots send it, in big endian, with 5 bytes behind each row.
fn message(points: &[Point], width: usize) -> PointCloud2 {
    let field = |(name, offset, datatype): (&str, u32, u8)| PointField {
        name: name.into(),
        offset,
        datatype,
        count: 1,
    };
    let fields = [
        ("ring", 0, PointField::UINT16),
        ("x", 2, PointField::FLOAT32),
        ("y", 6, PointField::FLOAT32),
        ("z", 10, PointField::FLOAT64),
        ("time", 18, PointField::FLOAT32),
    ];
    let bytes = |point: &Point| -> Vec<u8> {
        let [x, y, z] = point.place.to_array();
        let parts = [x, y, point.time].map(|part| (part as f32).to_be_bytes());
        [&point.ring.to_be_bytes()[..], &parts[0], &parts[1], &z.to_be_bytes(), &parts[2]].concat()
    };
    let row = |row: &[Point]| [row.iter().flat_map(bytes).collect::<Vec<u8>>(), vec![0xee; 5]].concat();
    PointCloud2 {
        height: (points.len() / width) as u32,
        width: width as u32,
        fields: fields.map(field).into(),
        is_bigendian: true,
        point_step: 22,
        row_step: 22 * width as u32 + 5,
        data: points.chunks(width).flat_map(row).collect::<Vec<u8>>().into(),
        ..PointCloud2::default()
    }
}

#[test]
fn a_cloud_of_a_bag_is_judged_as_that_of_a_file() {
    let trial = Trial::new(&head(), &bend());
    let right = points(&trial.set, CloudFrame::Sensor);
    let mut wrong = right.clone();
    let far = right.iter().position(|point| point.place.x > 4.0).expect("a far point");
    wrong[far].place.x += 0.001;
    let (right, wrong) = (message(&right, 16), message(&wrong, 16));
    let bag = |name: &str, clouds: &[&PointCloud2]| {
        let folder = trial.folder.path().join(name);
        let mut writer = BagWriter::create(&folder).expect("a bag");
        for cloud in clouds {
            writer.write(&Topic::new("/points"), Stamp::from_nanoseconds(1), *cloud).expect("a message");
        }
        writer.finish().expect("a bag");
        folder.join(format!("{name}_0.mcap"))
    };
    let check = |bag: &Path, choice: CloudChoice<'_>| {
        let cloud = CloudConventions { frame: CloudFrame::Sensor, choice };
        trial.check(bag, CandidateConventions { cloud, ..CandidateConventions::default() })
    };
    let alone = bag("alone", &[&right]);
    assert_eq!(stated_points(&alone), Some(1920));
    let checked = check(&alone, CloudChoice::default()).expect("a check");
    assert!(checked.passes(), "{:?}", checked.why);
    let facts = checked.cloud.as_ref().expect("a cloud");
    assert_eq!((facts.assigned, facts.source.as_deref()), ("by ring and time", Some("message 1 of /points")));
    assert!(
        checked.document().screen().contains(" points of message 1 of /points in the frame of the sensor")
    );

    let both = bag("both", &[&right, &wrong]);
    let choice = |message| CloudChoice { message: Some(message), ..CloudChoice::default() };
    assert!(check(&both, choice(1)).expect("a check").passes());
    let of_second = check(&both, choice(2)).expect("a check");
    assert_eq!(of_second.comparison.wrong().map(|(index, _)| index).collect::<Vec<_>>(), [far]);
    let refused = check(&both, CloudChoice::default()).expect_err("two clouds");
    assert!(
        refused.ends_with("topic /points: 2 clouds; expected one: `--message` 1 to 2 chooses it"),
        "{refused}"
    );

    // The folder that `ros2 bag record` leaves is no folder of arrays.
    let refused = check(&trial.folder.path().join("both"), CloudChoice::default()).expect_err("a folder");
    assert!(refused.contains("none of them, but a bag: give both_0.mcap"), "{refused}");

    type Change = fn(&mut PointCloud2);
    let changes: [(Change, &str); 7] = [
        (
            |cloud| cloud.fields[1].datatype = 9,
            "message 1 of /points, field `x`: datatype 9; expected 1 to 8",
        ),
        (|cloud| cloud.fields[1].count = 2, "field `x`: COUNT 2; expected a single number"),
        (|cloud| cloud.fields[2].name = "ring".into(), "fields: no y; expected x, y and z"),
        (
            |cloud| cloud.fields[3].offset = 15,
            "field `z`: 1 x 8 bytes at 15; expected an end within the 22 bytes",
        ),
        (|cloud| cloud.row_step = 351, "row_step: 351 bytes; expected 16 points of 22 bytes, or more"),
        (|cloud| cloud.data.0.truncate(42_839), "data: 42839 bytes; expected 120 rows of 357 bytes"),
        (
            |cloud| cloud.width = u32::MAX,
            "row_step: 357 bytes; expected 4294967295 points of 22 bytes, or more",
        ),
    ];
    for (index, (change, words)) in changes.into_iter().enumerate() {
        let mut broken = right.clone();
        change(&mut broken);
        let refused = check(&bag(&format!("broken{index}"), &[&broken]), CloudChoice::default());
        let refused = refused.expect_err(words);
        assert!(refused.contains(words), "{refused}: {words}");
    }
}
