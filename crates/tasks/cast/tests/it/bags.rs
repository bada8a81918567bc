//! Bags of scans, decoded by hand: the bytes of CDR, the fields of each driver, the poses and the clock.

use std::path::Path;

use glam::{DQuat, DVec3};
use raypencil_cast::{Answers, BagFields, BagForm, Questions, cast, write_scan_bag};
use raypencil_scene::pattern::{Cone, Keep, Mounting, PatternRays, Returns, Spinning, TimedPose, TimedPoses};
use raypencil_scene::{NamedRaySet, Pose, Sides, Silent, Triangles};

/// CDR, little endian, after its first four bytes: each number stands at a multiple of its size.
struct Cdr<'a> {
    data: &'a [u8],
    at: usize,
}

impl<'a> Cdr<'a> {
    fn bytes(&mut self, count: usize) -> &'a [u8] {
        self.at += count;
        &self.data[self.at - count..self.at]
    }

    fn of<const N: usize>(&mut self) -> [u8; N] {
        self.at = self.at.next_multiple_of(N);
        self.bytes(N).try_into().expect("bytes")
    }

    fn word(&mut self) -> u32 {
        u32::from_le_bytes(self.of())
    }

    fn real(&mut self) -> f64 {
        f64::from_le_bytes(self.of())
    }

    fn text(&mut self) -> String {
        let length = self.word() as usize;
        let text = self.bytes(length);
        String::from_utf8(text[..length - 1].to_vec()).expect("text")
    }

    /// Nanoseconds.
    fn stamp(&mut self) -> u64 {
        let seconds = u64::from(self.word());
        seconds * 1_000_000_000 + u64::from(self.word())
    }
}

/// A cloud of a bag.
struct Cloud {
    stamp: u64,
    frame: String,
    size: [u32; 2],
    fields: Vec<(String, u32, u8)>,
    step: usize,
    data: Vec<u8>,
    is_dense: bool,
}

impl Cloud {
    fn read(data: &[u8]) -> Self {
        assert_eq!(data[..4], [0, 1, 0, 0]);
        let mut cdr = Cdr { data: &data[4..], at: 0 };
        let (stamp, frame) = (cdr.stamp(), cdr.text());
        let size = [cdr.word(), cdr.word()];
        let fields = (0..cdr.word()).map(|_| {
            let (name, offset, [kind]) = (cdr.text(), cdr.word(), cdr.of::<1>());
            assert_eq!(cdr.word(), 1);
            (name, offset, kind)
        });
        let fields = fields.collect();
        assert_eq!(cdr.of::<1>(), [0]);
        let (step, row) = (cdr.word(), cdr.word());
        assert_eq!(row, step * size[1]);
        let length = cdr.word();
        assert_eq!(length, row * size[0]);
        let data = cdr.bytes(length as usize).to_vec();
        let is_dense = cdr.of::<1>() == [1];
        assert_eq!(cdr.at, cdr.data.len());
        Self { stamp, frame, size, fields, step: step as usize, data, is_dense }
    }

    fn points(&self) -> impl Iterator<Item = &[u8]> {
        self.data.chunks_exact(self.step)
    }

    /// The number of a field of a point.
    fn number(&self, point: &[u8], name: &str) -> f64 {
        let (_, offset, kind) = self.fields.iter().find(|(other, ..)| other == name).expect("a field");
        let bytes = &point[*offset as usize..];
        let four = || [bytes[0], bytes[1], bytes[2], bytes[3]];
        match kind {
            2 => bytes[0].into(),
            4 => u16::from_le_bytes([bytes[0], bytes[1]]).into(),
            6 => u32::from_le_bytes(four()).into(),
            7 => f32::from_le_bytes(four()).into(),
            8 => f64::from_le_bytes(bytes[..8].try_into().expect("eight bytes")),
            _ => panic!("type {kind}"),
        }
    }

    fn place(&self, point: &[u8]) -> DVec3 {
        DVec3::from_array(["x", "y", "z"].map(|axis| self.number(point, axis)))
    }
}

/// A floor, and a head of three channels above it that drives along x from 5 s on: the uppermost channel hits nothing.
fn scan() -> (NamedRaySet, Answers) {
    let corners = [[-50.0, -50.0, 0.0], [50.0, -50.0, 0.0], [50.0, 50.0, 0.0], [-50.0, 50.0, 0.0]];
    let floor = Triangles::new(corners.to_vec(), vec![[0, 1, 2], [0, 2, 3]]).expect("a floor");
    let mut head = Spinning { steps: 5, ..Spinning::preset("vlp-16").expect("a preset") };
    head.channels.truncate(3);
    let at = |time_s: f64| TimedPose {
        time_s,
        pose: Pose { position: DVec3::new(time_s, 0.0, 2.0), ..Pose::from_axis_angle(DVec3::Z, time_s) },
    };
    let poses = TimedPoses::new(vec![at(4.5), at(5.0), at(5.5)], "poses").expect("poses");
    let rays = head.rays("rays").expect("rays").starting_at(5.0);
    let rays = Mounting::Moving(poses).place(rays, "rays").expect("poses");
    let set = NamedRaySet::new("head", rays, Sides::Both).expect("a set");
    let answers = cast(&floor, set.set.rays(), Sides::Both, Questions::default(), &Silent);
    (set, answers)
}

/// Topic, time and bytes of each message.
fn messages(bag: &Path) -> Vec<(String, u64, Vec<u8>)> {
    let bytes = std::fs::read(bag.join("rosbag_0.mcap")).expect("a file");
    let stream = mcap::MessageStream::new(&bytes).expect("MCAP").map(|message| message.expect("a message"));
    stream.map(|one| (one.channel.topic.clone(), one.log_time, one.data.to_vec())).collect()
}

fn written(
    set: &NamedRaySet,
    answers: &Answers,
    fields: BagFields,
    is_dense: bool,
) -> (Vec<(String, u64, Vec<u8>)>, Cloud) {
    let folder = tempfile::tempdir().expect("a folder");
    let bag = folder.path().join("rosbag");
    write_scan_bag(&bag, answers, set, BagForm { fields, is_dense }, [0.0; 3]).expect("a bag");
    let messages = messages(&bag);
    let cloud = messages.iter().find(|(topic, ..)| topic == "/points").expect("a cloud");
    let cloud = Cloud::read(&cloud.2);
    (messages, cloud)
}

/// The exact points in the sensor's frame, NaN for a miss, and their times after the first ray.
fn expected(set: &NamedRaySet, answers: &Answers) -> Vec<(DVec3, f64)> {
    let times = set.times.as_ref().expect("times");
    let point = |(read, &time): (&raypencil_scene::Reading<raypencil_cast::FirstHit>, &f64)| {
        let pose = set.mounting.at(time).expect("a pose").inverse();
        (read.hit().map_or(DVec3::NAN, |hit| pose * hit.point), time - 5.0)
    };
    answers.first.iter().zip(times).map(point).collect()
}

fn assert_near(found: DVec3, exact: DVec3) {
    assert!(found.is_nan() == exact.is_nan());
    // Half a unit of single precision below 16 m.
    assert!(found.is_nan() || (found - exact).abs().max_element() <= 1.0 / 2_097_152.0, "{found} {exact}");
}

#[test]
fn the_fields_of_velodyne_are_a_row_for_each_sequence() {
    let (set, answers) = scan();
    let (_, cloud) = written(&set, &answers, BagFields::Velodyne, false);
    let names: Vec<&str> = cloud.fields.iter().map(|(name, ..)| name.as_str()).collect();
    assert_eq!(names, ["x", "y", "z", "intensity", "ring", "time"]);
    assert_eq!((cloud.size, cloud.step, cloud.is_dense), ([5, 3], 22, false));
    assert_eq!((cloud.stamp, cloud.frame.as_str()), (5_000_000_000, "lidar"));
    let exact = expected(&set, &answers);
    // Elevations are -15, 1 and -13 degrees: rings 0, 2 and 1.
    for (cell, point) in cloud.points().enumerate() {
        let channel = [0, 2, 1][cell % 3];
        let (place, time) = exact[cell / 3 * 3 + channel];
        assert_near(cloud.place(point), place);
        assert_eq!(cloud.number(point, "ring"), (cell % 3) as f64);
        assert!((cloud.number(point, "time") - time).abs() < 1e-10);
        assert_eq!(place.is_nan(), channel == 1);
    }
    let (_, dense) = written(&set, &answers, BagFields::Velodyne, true);
    assert_eq!((dense.size, dense.is_dense), ([1, 10], true));
    for (point, (place, _)) in dense.points().zip(exact.iter().filter(|(place, _)| !place.is_nan())) {
        assert_near(dense.place(point), *place);
    }
}

#[test]
fn the_fields_of_ouster_are_a_row_for_each_channel_from_above() {
    let (set, answers) = scan();
    let (_, cloud) = written(&set, &answers, BagFields::Ouster, false);
    assert_eq!((cloud.size, cloud.step), ([3, 5], 48));
    let exact = expected(&set, &answers);
    for (cell, point) in cloud.points().enumerate() {
        let (row, column) = (cell / 5, cell % 5);
        let index = column * 3 + [1, 2, 0][row];
        let (place, time) = exact[index];
        assert_near(cloud.place(point), place);
        assert_eq!(
            (cloud.number(point, "ring"), cloud.number(point, "t")),
            (row as f64, (time * 1e9).round())
        );
        let range = answers.first[index].hit().map_or(0.0, |hit| (hit.range * 1e3).round());
        assert_eq!(cloud.number(point, "range"), range);
        let light = answers.first[index]
            .hit()
            .map_or(f64::NAN, |hit| hit.cos_incidence.abs() / (hit.range * hit.range));
        assert!((cloud.number(point, "intensity") - light).abs() < 1e-7 || light.is_nan());
    }
}

#[test]
fn the_fields_of_livox_are_a_list_with_whole_times() {
    let (set, answers) = scan();
    let (_, cloud) = written(&set, &answers, BagFields::Livox, false);
    assert_eq!((cloud.size, cloud.step, cloud.is_dense), ([1, 10], 26, true));
    let exact = expected(&set, &answers);
    let hits = exact.iter().enumerate().filter(|(_, (place, _))| !place.is_nan());
    for (point, (index, (place, time))) in cloud.points().zip(hits) {
        assert_near(cloud.place(point), *place);
        // The number of the laser, and not its rank by elevation, which is 0, 2, 1.
        assert_eq!(cloud.number(point, "line"), (index % 3) as f64);
        assert_eq!(cloud.number(point, "timestamp"), 5e9 + (time * 1e9).round());
    }
}

#[test]
fn poses_and_clock_are_told_in_the_order_of_time() {
    let (set, answers) = scan();
    let (messages, _) = written(&set, &answers, BagFields::Velodyne, false);
    assert!(messages.windows(2).all(|pair| pair[0].1 <= pair[1].1));
    let times: Vec<u64> = messages.iter().filter(|(topic, ..)| topic == "/clock").map(|one| one.1).collect();
    let last = set.times.as_ref().expect("times").iter().copied().fold(0.0, f64::max);
    assert_eq!(times, [4_500_000_000, 5_000_000_000, (last * 1e9).round() as u64, 5_500_000_000]);
    for (topic, time, data) in &messages {
        let mut cdr = Cdr { data: &data[4..], at: 0 };
        match topic.as_str() {
            "/clock" => assert_eq!(cdr.stamp(), *time),
            "/tf" => {
                assert_eq!(cdr.word(), 1);
                assert_eq!((cdr.stamp(), cdr.text(), cdr.text()), (*time, "map".into(), "lidar".into()));
                let [x, y, z, qx, qy, qz, qw] = [0; 7].map(|_| cdr.real());
                let pose = Pose { position: DVec3::new(x, y, z), rotation: DQuat::from_xyzw(qx, qy, qz, qw) };
                let exact = set.mounting.at(*time as f64 / 1e9).expect("a pose");
                // A nanosecond at 1 m/s and 1 rad/s.
                assert!((pose * DVec3::X - exact * DVec3::X).length() < 3e-9);
            }
            topic => assert_eq!((topic, *time), ("/points", (last * 1e9).round() as u64)),
        }
    }
    // A set that begins at 0 is told from 1 s on: 0 means "no time". One that stands still has one pose for all times.
    let head = Spinning { steps: 2, ..Spinning::preset("vlp-16").expect("a preset") };
    let rays = Mounting::HERE.place(head.rays("rays").expect("rays"), "rays").expect("a pose");
    let still = NamedRaySet::new("head", rays, Sides::Both).expect("a set");
    let none = Triangles::new(vec![[0.0, 0.0, 500.0], [1.0, 0.0, 500.0], [0.0, 1.0, 500.0]], vec![[0, 1, 2]])
        .expect("a mesh");
    let answers = cast(&none, still.set.rays(), Sides::Both, Questions::default(), &Silent);
    let (messages, cloud) = written(&still, &answers, BagFields::Velodyne, true);
    assert_eq!((cloud.stamp, cloud.size), (1_000_000_000, [1, 0]));
    let topics: Vec<&str> = messages.iter().map(|(topic, ..)| topic.as_str()).collect();
    assert_eq!(topics, ["/tf_static", "/clock", "/clock", "/points"]);
}

/// Three beams with a width, two firings, over a floor: two look down, one up.
#[test]
fn returns_of_a_beam_stand_side_by_side_behind_the_fields_of_the_driver() {
    let corners = [[-50.0, -50.0, -2.0], [50.0, -50.0, -2.0], [50.0, 50.0, -2.0], [-50.0, 50.0, -2.0]];
    let floor = Triangles::new(corners.to_vec(), vec![[0, 1, 2], [0, 2, 3]]).expect("a floor");
    let mut head = Spinning { steps: 2, ..Spinning::preset("vlp-16").expect("a preset") };
    head.channels.truncate(3);
    let cone = Cone { divergence_rad: 3e-3, rings: 1 };
    let rays = cone.spread(&head.rays("rays").expect("rays"), "cone").expect("a cone");
    let rays = PatternRays { returns: Some(Returns { keep: Keep::UpTo(2), separation_m: 1.0 }), ..rays };
    let set = NamedRaySet::new("head", rays, Sides::Both).expect("a set");
    let answers = cast(&floor, set.set.rays(), Sides::Both, Questions::default(), &Silent);
    for (fields, size, step) in
        [(BagFields::Velodyne, [2, 6], 38), (BagFields::Ouster, [3, 4], 64), (BagFields::Livox, [1, 4], 42)]
    {
        let (_, cloud) = written(&set, &answers, fields, false);
        assert_eq!((cloud.size, cloud.step), (size, step), "{fields:?}");
        for (cell, point) in cloud.points().enumerate() {
            // Elevations are -15, 1 and -13 degrees. The floor is one surface: the second place is empty.
            let (channel, firing, place) = match fields {
                BagFields::Velodyne => ([0, 2, 1][cell % 6 / 2], cell / 6, cell % 2),
                BagFields::Ouster => ([1, 2, 0][cell / 4], cell % 4 / 2, cell % 2),
                BagFields::Livox => ([0, 2][cell % 2], cell / 2, 0),
            };
            let hit = answers.first[(firing * 3 + channel) * 7].hit().filter(|_| place == 0);
            assert_near(cloud.place(point), hit.map_or(DVec3::NAN, |hit| hit.point));
            let told = f64::from(u8::from(hit.is_some()));
            assert_eq!(["return", "share"].map(|name| cloud.number(point, name)), [told; 2]);
            assert_eq!(cloud.number(point, "returns"), f64::from(u8::from(channel != 1)));
            assert_eq!(cloud.number(point, "share_missed"), f64::from(u8::from(channel == 1)));
            let other = f64::from(u8::from(channel != 1 && place == 1));
            assert_eq!(["share_other", "mixed"].map(|name| cloud.number(point, name)), [other, 0.0]);
            if fields != BagFields::Livox {
                let ring = [0.0, 2.0, 1.0][channel];
                let ring = if fields == BagFields::Ouster { 2.0 - ring } else { ring };
                assert_eq!(cloud.number(point, "ring"), ring);
            }
        }
    }
}

/// Of a mesh whose frame is moved in its map, `map` is the map, in double precision, and the numbers of clouds stay small.
#[test]
fn a_mesh_in_a_map_has_its_origin_as_a_fixed_transform() {
    let (set, answers) = scan();
    let form = BagForm { fields: BagFields::Velodyne, is_dense: false };
    let still = NamedRaySet { mounting: Mounting::HERE, ..set.clone() };
    for set in [&set, &still] {
        let folder = tempfile::tempdir().expect("a folder");
        let bag = folder.path().join("rosbag");
        write_scan_bag(&bag, &answers, set, form, [491_000.0, 5_540_123.0, 212.0]).expect("a bag");
        let messages = messages(&bag);
        let (topic, time, data) = &messages[0];
        let mut cdr = Cdr { data: &data[4..], at: 0 };
        let count = cdr.word();
        assert_eq!(
            (topic.as_str(), count),
            ("/tf_static", if set.mounting == Mounting::HERE { 2 } else { 1 })
        );
        assert_eq!((cdr.stamp(), cdr.text(), cdr.text()), (*time, "map".into(), "mesh".into()));
        assert_eq!([0; 7].map(|_| cdr.real()), [491_000.0, 5_540_123.0, 212.0, 0.0, 0.0, 0.0, 1.0]);
        // The sensor stands in the frame of the mesh, wherever it is told.
        if count == 2 {
            assert_eq!((cdr.stamp(), cdr.text(), cdr.text()), (*time, "mesh".into(), "lidar".into()));
        }
        for (_, time, data) in messages.iter().filter(|(topic, ..)| topic == "/tf") {
            let mut cdr = Cdr { data: &data[4..], at: 0 };
            assert_eq!(
                (cdr.word(), cdr.stamp(), cdr.text(), cdr.text()),
                (1, *time, "mesh".into(), "lidar".into())
            );
            assert!(cdr.real() < 6.0);
        }
        assert!(messages.iter().all(|(_, at, _)| at >= time));
    }
}
