//! The bag of ROS 2, message by message, against the other files of the recording.

use std::collections::BTreeMap;

use super::driven::NOISY;
use super::geometry::{Pose, apart, length, minus, times};
use super::ground::{FRAME_RATE, SCAN, SIZE, frames, panned, sensors};
use super::maps::map_frames;
use super::obstacles::is_occupied;
use super::poses::{pose, rows};
use super::readers::{Cdr, csv, npy, number, numbers};

/// Messages of a topic with the frames of the drive that they belong to.
fn messages() -> BTreeMap<String, Vec<(u64, Vec<u8>)>> {
    let bytes = std::fs::read(NOISY.recorded("rosbag/rosbag_0.mcap")).unwrap();
    let mut topics = BTreeMap::<String, Vec<_>>::new();
    for message in mcap::MessageStream::new(&bytes).unwrap().map(Result::unwrap) {
        let frame = (message.log_time as f64 * 1e-9 - 1.0) * FRAME_RATE;
        assert!((frame - frame.round()).abs() < 1e-6, "{}", message.log_time);
        topics
            .entry(message.channel.topic.clone())
            .or_default()
            .push((frame.round() as u64, message.data.to_vec()));
    }
    topics
}

/// The header of a message of a frame: the drive begins at 1 s.
fn header(message: &mut Cdr, frame: u64, of: &str) {
    let (time, name) = message.header();
    assert!((time - 1.0 - frame as f64 / FRAME_RATE).abs() < 1e-8, "frame {frame}: {time}");
    assert_eq!(name, of);
}

/// Seven numbers of a pose or of a transform.
fn read_pose(message: &mut Cdr) -> Pose {
    Pose::of(&message.reals(7))
}

/// Transforms of a message: parent, child and pose.
fn transforms(message: &[u8], frame: u64) -> Vec<(String, String, Pose)> {
    let mut message = Cdr::new(message);
    let count = message.whole();
    let transforms = (0..count).map(|_| {
        let (time, parent) = message.header();
        assert!((time - 1.0 - frame as f64 / FRAME_RATE).abs() < 1e-8);
        (parent, message.text(), read_pose(&mut message))
    });
    let transforms = transforms.collect();
    assert!(message.is_at_the_end());
    transforms
}

#[test]
fn transforms_and_odometry_are_the_poses() {
    let (messages, rows) = (messages(), rows(&NOISY));
    let (_, fixed) = &messages["/tf_static"][0];
    let fixed = transforms(fixed, 0);
    let names: Vec<_> = fixed.iter().map(|(parent, child, _)| (parent.as_str(), child.as_str())).collect();
    let expected = [
        ("map", "odom"),
        ("base_link", "camera_optical"),
        ("base_link", "beam0_optical"),
        ("base_link", "beam1_optical"),
    ];
    assert_eq!(names[..4], expected);
    for ((.., pose), expected) in fixed[1..4].iter().zip(sensors()) {
        assert!(pose.apart(&expected) < 1e-12, "{pose:?}");
    }
    assert_eq!(names.len(), 4 + SCAN.1 as usize);
    for (step, (parent, child, pose)) in fixed[4..].iter().enumerate() {
        assert_eq!((parent.as_str(), child), ("base_link", &format!("camera_optical_scan{step:03}")));
        assert!(pose.apart(&panned(&sensors()[0], step as i64)) < 1e-12, "{step}: {pose:?}");
    }
    assert_eq!(messages["/tf"].len() as u64, frames());
    for (frame, message) in &messages["/tf"] {
        let row = &rows[*frame as usize];
        let of_frame = transforms(message, *frame);
        for ((parent, child, given), (names, kind)) in
            of_frame.iter().zip([(("map", "base_link_true"), "true"), (("odom", "base_link"), "believed")])
        {
            assert_eq!((parent.as_str(), child.as_str()), names);
            assert!(given.apart(&pose(row, kind)) < 1e-12, "frame {frame}: {given:?}");
        }
    }
    for (topic, kind, parent, child) in [
        ("/ground_truth/odometry", "true", "map", "base_link_true"),
        ("/odometry", "believed", "odom", "base_link"),
    ] {
        for (frame, message) in &messages[topic] {
            let mut message = Cdr::new(message);
            header(&mut message, *frame, parent);
            assert_eq!(message.text(), child);
            let now = pose(&rows[*frame as usize], kind);
            assert!(read_pose(&mut message).apart(&now) < 1e-12, "{topic} {frame}");
            let covariance = message.reals(36);
            let twist = message.reals(6);
            assert_eq!(message.reals(36), [0.0; 36]);
            assert!(message.is_at_the_end());
            let z = if kind == "true" { 0.0 } else { number(&rows[*frame as usize], "elevation_error_m") };
            assert!((covariance[14] - z * z).abs() < 1e-15, "{topic} {frame}: {covariance:?}");
            let Some(before) = frame.checked_sub(1).map(|before| pose(&rows[before as usize], kind)) else {
                assert_eq!(twist, [0.0; 6]);
                continue;
            };
            // Motion since the frame before, in the axes of now.
            let moved = times(minus(now.position, before.position), FRAME_RATE);
            let linear = Pose { position: [0.0; 3], ..now }.inverse().point(moved);
            assert!(
                length(minus([twist[0], twist[1], twist[2]], linear)) < 1e-9,
                "{topic} {frame}: {twist:?}"
            );
            // The turn v for one frame: by the formula of Rodrigues it leads from the one attitude to the other.
            let turn: [f64; 3] = std::array::from_fn(|axis| twist[3 + axis] / FRAME_RATE);
            let reached = super::geometry::product(&before.rotation, &turned(turn));
            assert!(apart(&reached, &now.rotation) < 1e-9, "{topic} {frame}: {twist:?}");
        }
    }
}

/// Matrix of a turn by the length of a vector about its direction.
fn turned(turn: [f64; 3]) -> [[f64; 3]; 3] {
    let angle = length(turn);
    if angle == 0.0 {
        return [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    }
    let [x, y, z] = times(turn, 1.0 / angle);
    let (sin, cos) = super::geometry::sin_cos(angle);
    let rest = 1.0 - cos;
    [
        [cos + x * x * rest, x * y * rest - z * sin, x * z * rest + y * sin],
        [y * x * rest + z * sin, cos + y * y * rest, y * z * rest - x * sin],
        [z * x * rest - y * sin, z * y * rest + x * sin, cos + z * z * rest],
    ]
}

#[test]
fn clouds_are_the_points_and_images_are_the_arrays() {
    let (messages, text) = (messages(), csv(&NOISY.recorded("points.csv"), "\n"));
    for (frame, message) in &messages["/points"] {
        let mut message = Cdr::new(message);
        header(&mut message, *frame, "base_link");
        assert_eq!(message.whole(), 1, "one row");
        let count = message.whole();
        let fields: Vec<_> = (0..message.whole())
            .map(|_| (message.text(), message.whole(), message.byte(), message.whole()))
            .collect();
        assert_eq!(message.byte(), 0, "little endian");
        let (point, row) = (message.whole(), message.whole());
        let data = message.sequence();
        assert_eq!((row, data.len()), (point * count, (point * count) as usize));
        assert_eq!(message.byte(), 1, "no point is missing");
        assert!(message.is_at_the_end());
        let of_frame = text.iter().filter(|row| number(row, "frame") == *frame as f64);
        let columns = ["x_m", "y_m", "z_m", "standard_error_m", "beam", "column", "row_px"];
        let names = ["x", "y", "z", "standard_error", "beam", "column", "row"];
        assert_eq!(fields.iter().map(|field| field.0.as_str()).collect::<Vec<_>>(), names);
        let mut seen = 0;
        for (point, row) in data.chunks_exact(point as usize).zip(of_frame) {
            for ((_, offset, kind, _), expected) in fields.iter().zip(numbers(row, columns)) {
                let bytes: [u8; 4] = point[*offset as usize..][..4].try_into().unwrap();
                // 5 is a whole number, 7 a real one.
                let given = match kind {
                    5 => f64::from(i32::from_le_bytes(bytes)),
                    7 => f64::from(f32::from_le_bytes(bytes)),
                    other => panic!("a field of type {other}"),
                };
                assert_eq!(given, f64::from(expected as f32), "frame {frame}: {row:?}");
            }
            seen += 1;
        }
        assert_eq!(seen, count);
    }
    for (beam, is_scan) in [(0, false), (1, false), (0, true), (1, true)] {
        let scan = if is_scan { "/scan" } else { "" };
        let images = &messages[&format!("/camera{scan}/beam{beam}/image_raw")];
        assert_eq!(images.len() as u64, if is_scan { SCAN.1.into() } else { frames() - 1 });
        for (step, (frame, message)) in images.iter().enumerate() {
            let mut message = Cdr::new(message);
            let (of, name) = match is_scan {
                true => {
                    (format!("camera_optical_scan{step:03}"), format!("{frame:06}-scan{step:03}-beam{beam}"))
                }
                false => ("camera_optical".into(), format!("{frame:06}-beam{beam}")),
            };
            header(&mut message, *frame, &of);
            let (rows, columns) = (message.whole() as usize, message.whole() as usize);
            assert_eq!(([columns, rows], message.text().as_str()), (SIZE, "mono16"));
            assert_eq!((message.byte(), message.whole() as usize), (0, 2 * columns));
            let data = message.sequence().chunks_exact(2);
            let given: Vec<f64> = data.map(|pair| u16::from_le_bytes([pair[0], pair[1]]).into()).collect();
            assert_eq!(given, npy(&NOISY.recorded(&format!("images/{name}.npy"))).values);
        }
    }
}

#[test]
fn obstacle_maps_are_those_of_their_frames() {
    let (messages, maps) = (messages(), csv(&NOISY.recorded("maps.csv"), "\n"));
    let grids = &messages["/obstacle_map"];
    assert_eq!(grids.iter().map(|(frame, _)| *frame).collect::<Vec<_>>(), map_frames());
    let mut all = 0;
    for ((frame, message), map) in grids.iter().zip(&maps) {
        let mut message = Cdr::new(message);
        header(&mut message, *frame, "odom");
        let _ = (message.whole(), message.whole());
        let resolution = f64::from(message.single());
        let (columns, rows) = (message.whole() as usize, message.whole() as usize);
        assert_eq!((columns, rows, resolution), (201, 201, f64::from(0.1_f32)));
        let origin = message.reals(7);
        let corner = numbers(map, ["west_m", "south_m"]).map(|first| first - 0.05);
        assert!((origin[0] - corner[0]).abs() < 1e-9 && (origin[1] - corner[1]).abs() < 1e-9, "{origin:?}");
        assert_eq!(origin[2..], [0.0, 0.0, 0.0, 0.0, 1.0]);
        let cells = message.sequence();
        assert!(message.is_at_the_end() && cells.len() == columns * rows);
        let expected = is_occupied(&NOISY, *frame);
        let mut occupied = 0;
        for (index, cell) in cells.iter().enumerate() {
            // Row by row, the southernmost first.
            let place = [
                corner[0] + 0.1 * ((index % columns) as f64 + 0.5),
                corner[1] + 0.1 * ((index / columns) as f64 + 0.5),
            ];
            if let Some(is_occupied) = expected(place) {
                assert_eq!(*cell == 100, is_occupied, "frame {frame}: {place:?}");
            }
            occupied += usize::from(*cell == 100);
        }
        all += occupied;
    }
    // A grid without any would be seen.
    assert!(all > 0, "no cell is occupied");
}
